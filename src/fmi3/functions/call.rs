//! The way into every call on an instance.

use crate::fmi::call;
use crate::fmi3::failures::Failure;
use crate::fmi3::instance::Instance;
use crate::fmi3::states::Function;
use crate::fmi3::types::{self, Status};

/// Runs [`call::call`] with the types of this version.
///
/// # Safety
/// `instance` must be null or what fmi3InstantiateCoSimulation returned, not freed, and not used by another thread.
pub(super) unsafe fn call(
    instance: types::Instance,
    function: Function,
    body: impl FnOnce(&mut Instance) -> Result<(), Failure>,
) -> Status {
    // SAFETY: the caller's promise.
    unsafe { call::call(instance, function, body) }
}
