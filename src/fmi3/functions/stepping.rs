//! The step.

use super::call::call;
use crate::fmi::pointers::place;
use crate::fmi3::instance::Instance;
use crate::fmi3::states::Function;
use crate::fmi3::types::{self, Boolean, FALSE, Float64, Status};

/// Advances the instance by one communication step.
///
/// # Safety
/// A live instance and a place for one value behind each pointer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3DoStep(
    instance: types::Instance,
    current_communication_point: Float64,
    communication_step_size: Float64,
    _no_set_fmu_state_prior_to_current_point: Boolean,
    event_handling_needed: *mut Boolean,
    terminate_simulation: *mut Boolean,
    early_return: *mut Boolean,
    last_successful_time: *mut Float64,
) -> Status {
    let body = |instance: &mut Instance| {
        // SAFETY: places for one value each (the caller's promise).
        let (event, terminate, early, time) = unsafe {
            (
                place(event_handling_needed, "eventHandlingNeeded")?,
                place(terminate_simulation, "terminateSimulation")?,
                place(early_return, "earlyReturn")?,
                place(last_successful_time, "lastSuccessfulTime")?,
            )
        };
        let (step, result) = instance.do_step(current_communication_point, communication_step_size);
        event.write(FALSE);
        terminate.write(FALSE);
        early.write(step.early_return);
        time.write(step.last_successful_time);
        result
    };
    // SAFETY: a live instance (the caller's promise).
    unsafe { call(instance, Function::DoStep, body) }
}
