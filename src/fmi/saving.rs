//! Saving and restoring an instance.

use super::component::{Component, Plots};
use super::failures::Failure;
use super::logging::Category;
use super::saved_states::Handle;
use super::serialized::{self, Corruption};
use super::snapshot::Snapshot;
use crate::parameters::{REAL_PARAMETERS, TEXT_PARAMETERS};
use crate::signals::INPUTS;

impl Component {
    fn snapshot(&self) -> Snapshot {
        Snapshot {
            mode: self.mode,
            experiment: self.experiment,
            parameters: self.parameters.clone(),
            inputs: self.inputs,
            rates: self.rates,
            time: self.time,
            state: self.state.clone(),
            contents: self.contents.clone(),
        }
    }

    /// Saves the state, in the saved one that is handed in or in a new one where the handle is null.
    ///
    /// # Errors
    /// [`Failure::UnknownState`].
    pub fn get_state(&mut self, handle: &mut Handle) -> Result<(), Failure> {
        let snapshot = self.snapshot();
        self.saved.keep(handle, snapshot)
    }

    /// Restores a saved state, with the profiles that it was saved with. The model is built anew only where these or the fixed parameters have
    /// changed since.
    ///
    /// # Errors
    /// [`Failure::NullPointer`] or [`Failure::UnknownState`]; nothing is changed then.
    pub fn set_state(&mut self, handle: Handle) -> Result<(), Failure> {
        let snapshot = self.saved.find(handle)?.clone();
        if snapshot.state.is_some() {
            let contents = snapshot.contents.clone().unwrap_or_default();
            self.prepare_of(contents, &snapshot.parameters)
                .map_err(Failure::Model)?;
        }
        self.contents = snapshot.contents;
        self.mode = snapshot.mode;
        self.experiment = snapshot.experiment;
        self.parameters = snapshot.parameters;
        self.inputs = snapshot.inputs;
        self.rates = snapshot.rates;
        self.time = snapshot.time;
        self.state = snapshot.state;
        self.plots = Plots::default();
        self.inform(Category::Events, |component| {
            format!("restored the state of t = {} s", component.time)
        });
        Ok(())
    }

    /// Frees a saved state and sets the handle to null; a null handle has nothing to free.
    ///
    /// # Errors
    /// [`Failure::UnknownState`].
    pub fn free_state(&mut self, handle: &mut Handle) -> Result<(), Failure> {
        self.saved.free(handle)
    }

    /// The serialised form of a saved state.
    ///
    /// # Errors
    /// [`Failure::NullPointer`] or [`Failure::UnknownState`].
    pub fn serialized(&self, handle: Handle) -> Result<Vec<u8>, Failure> {
        Ok(serialized::serialize(self.saved.find(handle)?)?)
    }

    /// Makes a saved state of its serialised form. The bytes are checked first: checksum, sizes, and that every value is one
    /// that this instance could hold.
    ///
    /// # Errors
    /// [`Failure::Corrupt`], [`Failure::UnknownState`], and what the parameters of this instance do not make a model for.
    pub fn deserialize(&mut self, bytes: &[u8], handle: &mut Handle) -> Result<(), Failure> {
        let snapshot = serialized::deserialize(bytes, &self.parameters)?;
        for row in REAL_PARAMETERS {
            for (element, value) in (row.get)(&snapshot.parameters).iter().enumerate() {
                row.check(element, *value).map_err(|_| Corruption::Content)?;
            }
        }
        for row in TEXT_PARAMETERS {
            let text = (row.get)(&snapshot.parameters);
            row.check(text).map_err(|_| Corruption::Content)?;
        }
        for row in INPUTS {
            let finite = (row.get)(&snapshot.inputs).is_finite() && (row.get)(&snapshot.rates).is_finite();
            if !finite {
                return Err(Corruption::Content.into());
            }
        }
        if let Some(state) = &snapshot.state {
            let parameters = self.parameters.clone();
            let contents = snapshot.contents.clone().unwrap_or_default();
            // The simulation goes on with its own profiles until the state is restored: a model of others is made for the check alone.
            let own = self.built.take_if(|built| *built.model.profile_contents() != contents);
            let accepted = self
                .prepare_of(contents, &parameters)
                .map(|built| built.model.accepts(state))
                .map_err(Failure::Model);
            self.built = own.or(self.built.take());
            if !accepted? {
                return Err(Corruption::Content.into());
            }
        }
        self.saved.keep(handle, snapshot)
    }
}
