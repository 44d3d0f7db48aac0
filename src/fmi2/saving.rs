//! Saved states of an instance: kept by the instance, named to the importer by an address that is never followed.

use super::failure::Failure;
use super::instance::Instance;
use super::logging::Category;
use super::state::{self, Corruption, Snapshot};
use super::types::FmuState;
use crate::parameters::REAL_PARAMETERS;
use crate::signals::INPUTS;
use std::collections::BTreeMap;

/// The saved states by the address of their memory. A pointer that is not in here is refused, whatever it points to.
#[derive(Default)]
pub struct SavedStates {
    states: BTreeMap<usize, Box<Snapshot>>,
}

impl SavedStates {
    fn find(&self, handle: FmuState) -> Result<&Snapshot, Failure> {
        let address = handle.addr();
        if handle.is_null() {
            return Err(Failure::NullPointer { argument: "FMUstate" });
        }
        self.states
            .get(&address)
            .map(Box::as_ref)
            .ok_or(Failure::UnknownState { address })
    }

    /// Keeps a snapshot in a state that is handed in, or in a new one where `handle` is null.
    fn keep(&mut self, handle: &mut FmuState, snapshot: Snapshot) -> Result<(), Failure> {
        let address = handle.addr();
        if handle.is_null() {
            let mut kept = Box::new(snapshot);
            *handle = (&raw mut *kept).cast();
            self.states.insert(handle.addr(), kept);
            return Ok(());
        }
        let kept = self.states.get_mut(&address).ok_or(Failure::UnknownState { address })?;
        **kept = snapshot;
        Ok(())
    }
}

impl Instance {
    fn snapshot(&self) -> Snapshot {
        Snapshot {
            mode: self.mode,
            experiment: self.experiment,
            parameters: self.parameters.clone(),
            inputs: self.inputs,
            rates: self.rates,
            time: self.time,
            state: self.state.clone(),
        }
    }

    /// fmi2GetFMUstate.
    pub(super) fn get_state(&mut self, handle: &mut FmuState) -> Result<(), Failure> {
        let snapshot = self.snapshot();
        self.saved.keep(handle, snapshot)
    }

    /// fmi2SetFMUstate. The model is built anew only where the fixed parameters have changed since.
    pub(super) fn set_state(&mut self, handle: FmuState) -> Result<(), Failure> {
        let snapshot = self.saved.find(handle)?.clone();
        if snapshot.state.is_some() {
            self.prepare(&snapshot.parameters).map_err(Failure::Model)?;
        }
        self.mode = snapshot.mode;
        self.experiment = snapshot.experiment;
        self.parameters = snapshot.parameters;
        self.inputs = snapshot.inputs;
        self.rates = snapshot.rates;
        self.time = snapshot.time;
        self.state = snapshot.state;
        self.profiles = None;
        self.inform(Category::Events, |instance| {
            format!("restored the state of t = {} s", instance.time)
        });
        Ok(())
    }

    /// fmi2FreeFMUstate; a null pointer has nothing to free.
    pub(super) fn free_state(&mut self, handle: &mut FmuState) -> Result<(), Failure> {
        if handle.is_null() {
            return Ok(());
        }
        let address = handle.addr();
        self.saved
            .states
            .remove(&address)
            .ok_or(Failure::UnknownState { address })?;
        *handle = std::ptr::null_mut();
        Ok(())
    }

    /// fmi2SerializedFMUstateSize and fmi2SerializeFMUstate.
    pub(super) fn serialized(&self, handle: FmuState) -> Result<Vec<u8>, Failure> {
        Ok(state::serialize(self.saved.find(handle)?)?)
    }

    /// fmi2DeSerializeFMUstate: the bytes are checked before they become a saved state.
    pub(super) fn deserialize(&mut self, bytes: &[u8], handle: &mut FmuState) -> Result<(), Failure> {
        let snapshot = state::deserialize(bytes, &self.parameters)?;
        for row in REAL_PARAMETERS {
            row.check((row.get)(&snapshot.parameters))
                .map_err(|_| Corruption::Content)?;
        }
        for row in INPUTS {
            let finite = (row.get)(&snapshot.inputs).is_finite() && (row.get)(&snapshot.rates).is_finite();
            if !finite {
                return Err(Corruption::Content.into());
            }
        }
        if let Some(state) = &snapshot.state {
            let parameters = self.parameters.clone();
            let built = self.prepare(&parameters).map_err(Failure::Model)?;
            if !built.model.accepts(state) {
                return Err(Corruption::Content.into());
            }
        }
        self.saved.keep(handle, snapshot)
    }
}
