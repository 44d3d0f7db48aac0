//! The saved states of an instance: kept by the instance, named to the importer by an address that is never followed.

use super::failures::Failure;
use super::snapshot::Snapshot;
use std::collections::BTreeMap;
use std::ffi::c_void;

/// Address that the importer holds of a saved state; it is never followed.
pub type Handle = *mut c_void;

/// The saved states by the address of their memory. A pointer that is not in here is refused, whatever it points to.
#[derive(Default)]
pub struct SavedStates {
    states: BTreeMap<usize, Box<Snapshot>>,
}

impl SavedStates {
    /// The state that a handle names.
    ///
    /// # Errors
    /// [`Failure::NullPointer`] or [`Failure::UnknownState`].
    pub fn find(&self, handle: Handle) -> Result<&Snapshot, Failure> {
        if handle.is_null() {
            return Err(Failure::NullPointer { argument: "FMUstate" });
        }
        let address = handle.addr();
        self.states
            .get(&address)
            .map(Box::as_ref)
            .ok_or(Failure::UnknownState { address })
    }

    /// Keeps a snapshot in the state that is handed in, or in a new one where the handle is null.
    ///
    /// # Errors
    /// [`Failure::UnknownState`].
    pub fn keep(&mut self, handle: &mut Handle, snapshot: Snapshot) -> Result<(), Failure> {
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

    /// Frees a state and sets the handle to null; a null handle has nothing to free.
    ///
    /// # Errors
    /// [`Failure::UnknownState`].
    pub fn free(&mut self, handle: &mut Handle) -> Result<(), Failure> {
        if handle.is_null() {
            return Ok(());
        }
        let address = handle.addr();
        self.states.remove(&address).ok_or(Failure::UnknownState { address })?;
        *handle = std::ptr::null_mut();
        Ok(())
    }
}
