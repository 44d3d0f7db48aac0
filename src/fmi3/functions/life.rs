//! Identity of the library, and the life of an instance.

use super::call::call;
use crate::fmi::component::Component;
use crate::fmi::exported;
use crate::fmi::fence;
use crate::fmi::pointers::string;
use crate::fmi::resources::Resources;
use crate::fmi3::instance::{Instance, Instantiation, Messages, Refusal};
use crate::fmi3::states::Function;
use crate::fmi3::types::{
    self, Boolean, ClockUpdateCallback, FALSE, Float64, FmiString, InstanceEnvironment, IntermediateUpdateCallback,
    LogMessageCallback, PreemptionCallback, Status, ValueReference,
};
use std::ffi::{CStr, c_char};
use std::path::PathBuf;

/// The string "3.0".
#[unsafe(no_mangle)]
pub extern "C" fn fmi3GetVersion() -> *const c_char {
    c"3.0".as_ptr()
}

/// A new instance, or null after a logged reason.
///
/// # Safety
/// Strings must be null or valid during the call; the logger until fmi3FreeInstance.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3InstantiateCoSimulation(
    instance_name: FmiString,
    instantiation_token: FmiString,
    resource_path: FmiString,
    _visible: Boolean,
    logging_on: Boolean,
    event_mode_used: Boolean,
    early_return_allowed: Boolean,
    _required_intermediate_variables: *const ValueReference,
    n_required_intermediate_variables: usize,
    instance_environment: InstanceEnvironment,
    log_message: Option<LogMessageCallback>,
    _intermediate_update: Option<IntermediateUpdateCallback>,
) -> types::Instance {
    fence::quiet_panics();
    let instance = fence::fenced(|| {
        // SAFETY: null or valid during the call (the caller's promise).
        let arguments = unsafe {
            Instantiation {
                name: string(instance_name),
                token: string(instantiation_token),
                resources: resources(string(resource_path)),
                event_mode_used: event_mode_used != FALSE,
                early_return_allowed: early_return_allowed != FALSE,
                intermediate_variables: n_required_intermediate_variables,
                messages: Messages::new(instance_environment, log_message, logging_on != FALSE),
            }
        };
        Instance::new(arguments)
    });
    match instance {
        Ok(Some(instance)) => Box::into_raw(Box::new(instance)).cast(),
        _ => std::ptr::null_mut(),
    }
}

/// The resources of the archive in the folder of a path.
fn resources(path: Option<&CStr>) -> Resources {
    let path = path.and_then(|path| path.to_str().ok());
    Resources::new(path.filter(|path| !path.is_empty()).map(PathBuf::from))
}

/// No instance: there is no model exchange.
///
/// # Safety
/// The logger must be null or callable.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3InstantiateModelExchange(
    _instance_name: FmiString,
    _instantiation_token: FmiString,
    _resource_path: FmiString,
    _visible: Boolean,
    _logging_on: Boolean,
    instance_environment: InstanceEnvironment,
    log_message: Option<LogMessageCallback>,
) -> types::Instance {
    no_instance("fmi3InstantiateModelExchange", instance_environment, log_message)
}

/// No instance: there is no scheduled execution.
///
/// # Safety
/// The logger must be null or callable.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3InstantiateScheduledExecution(
    _instance_name: FmiString,
    _instantiation_token: FmiString,
    _resource_path: FmiString,
    _visible: Boolean,
    _logging_on: Boolean,
    instance_environment: InstanceEnvironment,
    log_message: Option<LogMessageCallback>,
    _clock_update: Option<ClockUpdateCallback>,
    _lock_preemption: Option<PreemptionCallback>,
    _unlock_preemption: Option<PreemptionCallback>,
) -> types::Instance {
    no_instance("fmi3InstantiateScheduledExecution", instance_environment, log_message)
}

fn no_instance(
    function: &str,
    environment: InstanceEnvironment,
    log_message: Option<LogMessageCallback>,
) -> types::Instance {
    fence::quiet_panics();
    // A panic here would be told nowhere: there is no instance.
    let _ = fence::fenced(|| Messages::new(environment, log_message, false).refuse(function, &Refusal::InterfaceType));
    std::ptr::null_mut()
}

/// Frees an instance and its saved states; null is ignored.
///
/// # Safety
/// `instance` must be null or a live instance; it is none afterwards.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3FreeInstance(instance: types::Instance) {
    if instance.is_null() {
        return;
    }
    let _ = fence::fenced(|| {
        // SAFETY: fmi3InstantiateCoSimulation made it with Box::into_raw, and it is freed once (the caller's promise).
        drop(unsafe { Box::from_raw(instance.cast::<Instance>()) });
    });
}

/// Switches log categories on or off.
///
/// # Safety
/// As the standard says: a live instance, valid strings.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetDebugLogging(
    instance: types::Instance,
    logging_on: Boolean,
    n_categories: usize,
    categories: *const FmiString,
) -> Status {
    let on = logging_on != FALSE;
    // SAFETY: the caller's promise.
    unsafe {
        exported::set_debug_logging::<Instance>(instance, Function::SetDebugLogging, on, n_categories, categories)
    }
}

/// Begins to change the lengths of arrays.
///
/// # Safety
/// `instance` must be null or a live instance.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3EnterConfigurationMode(instance: types::Instance) -> Status {
    // SAFETY: the caller's promise.
    unsafe {
        exported::simply::<Instance>(
            instance,
            Function::EnterConfigurationMode,
            Component::enter_configuration,
        )
    }
}

/// Ends it.
///
/// # Safety
/// `instance` must be null or a live instance.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3ExitConfigurationMode(instance: types::Instance) -> Status {
    // SAFETY: the caller's promise.
    unsafe { exported::simply::<Instance>(instance, Function::ExitConfigurationMode, Component::exit_configuration) }
}

/// Sets start and stop time and begins the initialisation; the tolerance is not used.
///
/// # Safety
/// `instance` must be null or a live instance.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3EnterInitializationMode(
    instance: types::Instance,
    _tolerance_defined: Boolean,
    _tolerance: Float64,
    start_time: Float64,
    stop_time_defined: Boolean,
    stop_time: Float64,
) -> Status {
    let stop = (stop_time_defined != FALSE).then_some(stop_time);
    let body = |instance: &mut Instance| {
        instance.component.set_experiment(start_time, stop)?;
        instance.component.enter_initialization();
        Ok(())
    };
    // SAFETY: a live instance (the caller's promise).
    unsafe { call(instance, Function::EnterInitializationMode, body) }
}

/// Ends the initialisation: builds the model and solves for the first contact.
///
/// # Safety
/// `instance` must be null or a live instance.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3ExitInitializationMode(instance: types::Instance) -> Status {
    // SAFETY: the caller's promise.
    unsafe { exported::exit_initialization::<Instance>(instance, Function::ExitInitializationMode) }
}

/// Ends the simulation.
///
/// # Safety
/// `instance` must be null or a live instance.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3Terminate(instance: types::Instance) -> Status {
    // SAFETY: the caller's promise.
    unsafe { exported::simply::<Instance>(instance, Function::Terminate, Component::terminate) }
}

/// Back to the start values.
///
/// # Safety
/// `instance` must be null or a live instance.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3Reset(instance: types::Instance) -> Status {
    // SAFETY: the caller's promise.
    unsafe { exported::simply::<Instance>(instance, Function::Reset, Component::reset) }
}
