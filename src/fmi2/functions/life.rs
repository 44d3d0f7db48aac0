//! Identity of the library, and the life of an instance.

use super::call::call;
use crate::fmi::component;
use crate::fmi::exported;
use crate::fmi::failures::Failure;
use crate::fmi::fence;
use crate::fmi::pointers::string;
use crate::fmi2::instance::{Instance, Instantiation};
use crate::fmi2::states::Function;
use crate::fmi2::types::{Boolean, CallbackFunctions, Component, FALSE, FmiString, FmuType, Real, Status};
use std::ffi::c_char;

/// The string "default".
#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetTypesPlatform() -> *const c_char {
    c"default".as_ptr()
}

/// The string "2.0".
#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetVersion() -> *const c_char {
    c"2.0".as_ptr()
}

/// A new instance, or null after a logged reason.
///
/// # Safety
/// Strings and the callbacks must be null or valid during the call, as the standard says; the callback functions until
/// fmi2FreeInstance.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2Instantiate(
    instance_name: FmiString,
    fmu_type: FmuType,
    guid: FmiString,
    resource_location: FmiString,
    functions: *const CallbackFunctions,
    _visible: Boolean,
    logging_on: Boolean,
) -> Component {
    fence::quiet_panics();
    let instance = fence::fenced(|| {
        // SAFETY: null or valid during the call (the caller's promise).
        let arguments = unsafe {
            Instantiation {
                name: string(instance_name),
                fmu_type,
                guid: string(guid),
                resource_location: string(resource_location),
                callbacks: *functions
                    .as_ref()
                    .ok_or(Failure::NullPointer { argument: "functions" })?,
                logging_on: logging_on != FALSE,
            }
        };
        Ok::<_, Failure>(Instance::new(&arguments))
    });
    match instance {
        Ok(Ok(Some(instance))) => Box::into_raw(Box::new(instance)).cast(),
        _ => std::ptr::null_mut(),
    }
}

/// Frees an instance and its saved states; null is ignored.
///
/// # Safety
/// `component` must be null or a live instance; it is none afterwards.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2FreeInstance(component: Component) {
    if component.is_null() {
        return;
    }
    let _ = fence::fenced(|| {
        // SAFETY: fmi2Instantiate made it with Box::into_raw, and it is freed once (the caller's promise).
        drop(unsafe { Box::from_raw(component.cast::<Instance>()) });
    });
}

/// Switches log categories on or off.
///
/// # Safety
/// As the standard says: a live instance, valid strings.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetDebugLogging(
    component: Component,
    logging_on: Boolean,
    n_categories: usize,
    categories: *const FmiString,
) -> Status {
    let on = logging_on != FALSE;
    // SAFETY: the caller's promise.
    unsafe {
        exported::set_debug_logging::<Instance>(component, Function::SetDebugLogging, on, n_categories, categories)
    }
}

/// Sets start and stop time; the tolerance is not used.
///
/// # Safety
/// `component` must be null or a live instance.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetupExperiment(
    component: Component,
    _tolerance_defined: Boolean,
    _tolerance: Real,
    start_time: Real,
    stop_time_defined: Boolean,
    stop_time: Real,
) -> Status {
    let stop = (stop_time_defined != FALSE).then_some(stop_time);
    // SAFETY: a live instance (the caller's promise).
    unsafe {
        call(component, Function::SetupExperiment, |instance| {
            Ok(instance.component.set_experiment(start_time, stop)?)
        })
    }
}

/// Begins the initialisation.
///
/// # Safety
/// `component` must be null or a live instance.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2EnterInitializationMode(component: Component) -> Status {
    // SAFETY: a live instance (the caller's promise).
    unsafe {
        call(
            component,
            Function::EnterInitializationMode,
            Instance::enter_initialization,
        )
    }
}

/// Ends the initialisation: builds the model and solves for the first contact.
///
/// # Safety
/// `component` must be null or a live instance.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2ExitInitializationMode(component: Component) -> Status {
    // SAFETY: the caller's promise.
    unsafe { exported::exit_initialization::<Instance>(component, Function::ExitInitializationMode) }
}

/// Ends the simulation.
///
/// # Safety
/// `component` must be null or a live instance.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2Terminate(component: Component) -> Status {
    // SAFETY: the caller's promise.
    unsafe { exported::simply::<Instance>(component, Function::Terminate, component::Component::terminate) }
}

/// Back to the start values.
///
/// # Safety
/// `component` must be null or a live instance.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2Reset(component: Component) -> Status {
    // SAFETY: the caller's promise.
    unsafe { exported::simply::<Instance>(component, Function::Reset, component::Component::reset) }
}
