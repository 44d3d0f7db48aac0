//! The exported functions of fmi2Functions.h: pointers become slices, the instance does the work.

use super::failure::Failure;
use super::fence;
use super::instance::{Instance, Instantiation};
use super::logging::Logger;
use super::modes::Function;
use super::pointers::{input, output, place, string, variable};
use super::types::{
    Boolean, Byte, CallbackFunctions, Component, FALSE, FmiString, FmuState, FmuType, Integer, Real, Status,
    StatusKind, TERMINATED, ValueReference,
};
use std::ffi::c_char;
use std::mem::MaybeUninit;

/// Every call on an instance: null check, state check, panic fence, status and messages.
///
/// # Safety
/// `component` must be null or an instance that fmi2Instantiate returned, not freed, and not used by another thread.
unsafe fn call(
    component: Component,
    function: Function,
    body: impl FnOnce(&mut Instance) -> Result<(), Failure>,
) -> Status {
    // SAFETY: null or a live instance that nobody else uses (the caller's promise).
    let Some(instance) = (unsafe { component.cast::<Instance>().as_mut() }) else {
        return Status::ERROR;
    };
    let status = match instance.call(function, body) {
        Ok(()) => Status::OK,
        Err(failure) => failure.status(),
    };
    // From here on the instance is not touched: the logger may call back into it, or free it.
    let (messages, logger) = instance.take_messages();
    for message in &messages {
        logger.send(message);
    }
    status
}

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
        Ok(Instance::new(&arguments))
    });
    match instance {
        Ok(Some(instance)) => Box::into_raw(Box::new(instance)).cast(),
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
        Ok(())
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
    let body = |instance: &mut Instance| {
        // SAFETY: as many strings as the caller says.
        let names = unsafe { input(categories, n_categories, "categories") }?;
        let categories = names.iter().map(|name| {
            // SAFETY: a valid string (the caller's promise).
            let name = unsafe { string(*name) };
            Logger::category(name.ok_or(Failure::NullPointer {
                argument: "categories[i]",
            })?)
        });
        let categories: Vec<_> = categories.collect::<Result<_, _>>()?;
        instance.set_debug_logging(logging_on != FALSE, &categories);
        Ok(())
    };
    // SAFETY: a live instance (the caller's promise).
    unsafe { call(component, Function::SetDebugLogging, body) }
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
            instance.setup_experiment(start_time, stop)
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
    // SAFETY: a live instance (the caller's promise).
    unsafe {
        call(
            component,
            Function::ExitInitializationMode,
            Instance::exit_initialization,
        )
    }
}

/// Ends the simulation.
///
/// # Safety
/// `component` must be null or a live instance.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2Terminate(component: Component) -> Status {
    // SAFETY: a live instance (the caller's promise).
    unsafe { call(component, Function::Terminate, Instance::terminate) }
}

/// Back to the start values.
///
/// # Safety
/// `component` must be null or a live instance.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2Reset(component: Component) -> Status {
    let body = |instance: &mut Instance| {
        instance.reset();
        Ok(())
    };
    // SAFETY: a live instance (the caller's promise).
    unsafe { call(component, Function::Reset, body) }
}

/// Reads Real variables.
///
/// # Safety
/// A live instance and `n` elements behind each pointer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetReal(
    component: Component,
    references: *const ValueReference,
    n: usize,
    values: *mut Real,
) -> Status {
    // SAFETY: `n` elements (the caller's promise).
    let body = |instance: &mut Instance| unsafe {
        instance.get_real(input(references, n, "vr")?, output(values, n, "value")?)
    };
    // SAFETY: a live instance (the caller's promise).
    unsafe { call(component, Function::GetReal, body) }
}

/// Reads Integer variables.
///
/// # Safety
/// As [`fmi2GetReal`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetInteger(
    component: Component,
    references: *const ValueReference,
    n: usize,
    values: *mut Integer,
) -> Status {
    // SAFETY: `n` elements (the caller's promise).
    let body = |instance: &mut Instance| unsafe {
        instance.get_integer(input(references, n, "vr")?, output(values, n, "value")?)
    };
    // SAFETY: a live instance (the caller's promise).
    unsafe { call(component, Function::GetInteger, body) }
}

/// Sets Real variables, all or none.
///
/// # Safety
/// As [`fmi2GetReal`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetReal(
    component: Component,
    references: *const ValueReference,
    n: usize,
    values: *const Real,
) -> Status {
    // SAFETY: `n` elements (the caller's promise).
    let body =
        |instance: &mut Instance| unsafe { instance.set_real(input(references, n, "vr")?, input(values, n, "value")?) };
    // SAFETY: a live instance (the caller's promise).
    unsafe { call(component, Function::SetReal, body) }
}

/// Sets Integer variables, all or none.
///
/// # Safety
/// As [`fmi2GetReal`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetInteger(
    component: Component,
    references: *const ValueReference,
    n: usize,
    values: *const Integer,
) -> Status {
    // SAFETY: `n` elements (the caller's promise).
    let body = |instance: &mut Instance| unsafe {
        instance.set_integer(input(references, n, "vr")?, input(values, n, "value")?)
    };
    // SAFETY: a live instance (the caller's promise).
    unsafe { call(component, Function::SetInteger, body) }
}

/// Boolean and String: there are no variables of these types, so that every value reference is unknown.
///
/// # Safety
/// As [`fmi2GetReal`].
unsafe fn no_variables<T>(
    component: Component,
    function: Function,
    references: *const ValueReference,
    n: usize,
    values: *const T,
    expected: &'static str,
) -> Status {
    let body = |_: &mut Instance| {
        // SAFETY: `n` elements (the caller's promise).
        let references = unsafe { input(references, n, "vr") }?;
        // SAFETY: as before; the values are not read.
        unsafe { input(values.cast::<MaybeUninit<T>>(), n, "value") }?;
        match references.first() {
            Some(reference) => Err(Failure::UnknownReference {
                reference: *reference,
                expected,
            }),
            None => Ok(()),
        }
    };
    // SAFETY: a live instance (the caller's promise).
    unsafe { call(component, function, body) }
}

/// Reads Boolean variables: there are none.
///
/// # Safety
/// As [`fmi2GetReal`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetBoolean(
    component: Component,
    references: *const ValueReference,
    n: usize,
    values: *mut Boolean,
) -> Status {
    // SAFETY: the caller's promise.
    unsafe {
        no_variables(
            component,
            Function::GetBoolean,
            references,
            n,
            values,
            "a Boolean variable: there are none",
        )
    }
}

/// Reads String variables: there are none.
///
/// # Safety
/// As [`fmi2GetReal`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetString(
    component: Component,
    references: *const ValueReference,
    n: usize,
    values: *mut FmiString,
) -> Status {
    // SAFETY: the caller's promise.
    unsafe {
        no_variables(
            component,
            Function::GetString,
            references,
            n,
            values,
            "a String variable: there are none",
        )
    }
}

/// Sets Boolean variables: there are none.
///
/// # Safety
/// As [`fmi2GetReal`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetBoolean(
    component: Component,
    references: *const ValueReference,
    n: usize,
    values: *const Boolean,
) -> Status {
    // SAFETY: the caller's promise.
    unsafe {
        no_variables(
            component,
            Function::SetBoolean,
            references,
            n,
            values,
            "a Boolean variable: there are none",
        )
    }
}

/// Sets String variables: there are none.
///
/// # Safety
/// As [`fmi2GetReal`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetString(
    component: Component,
    references: *const ValueReference,
    n: usize,
    values: *const FmiString,
) -> Status {
    // SAFETY: the caller's promise.
    unsafe {
        no_variables(
            component,
            Function::SetString,
            references,
            n,
            values,
            "a String variable: there are none",
        )
    }
}

/// Saves the state, in the one handed in where there is one.
///
/// # Safety
/// A live instance and a pointer to a variable.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetFMUstate(component: Component, state: *mut FmuState) -> Status {
    // SAFETY: a variable of the importer (the caller's promise).
    let body = |instance: &mut Instance| unsafe { instance.get_state(variable(state, "FMUstate")?) };
    // SAFETY: a live instance (the caller's promise).
    unsafe { call(component, Function::GetFmuState, body) }
}

/// Restores a saved state.
///
/// # Safety
/// `component` must be null or a live instance; `state` is never followed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetFMUstate(component: Component, state: FmuState) -> Status {
    // SAFETY: a live instance (the caller's promise).
    unsafe { call(component, Function::SetFmuState, |instance| instance.set_state(state)) }
}

/// Frees a saved state and sets the pointer to null.
///
/// # Safety
/// A live instance and a pointer to a variable.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2FreeFMUstate(component: Component, state: *mut FmuState) -> Status {
    // SAFETY: a variable of the importer (the caller's promise).
    let body = |instance: &mut Instance| unsafe { instance.free_state(variable(state, "FMUstate")?) };
    // SAFETY: a live instance (the caller's promise).
    unsafe { call(component, Function::FreeFmuState, body) }
}

/// The number of bytes of a serialised state.
///
/// # Safety
/// A live instance and a place for the size.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SerializedFMUstateSize(component: Component, state: FmuState, size: *mut usize) -> Status {
    let body = |instance: &mut Instance| {
        // SAFETY: a place for one value (the caller's promise).
        let size = unsafe { place(size, "size") }?;
        size.write(instance.serialized(state)?.len());
        Ok(())
    };
    // SAFETY: a live instance (the caller's promise).
    unsafe { call(component, Function::SerializedFmuStateSize, body) }
}

/// Writes a saved state as bytes.
///
/// # Safety
/// A live instance and room for `size` bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SerializeFMUstate(
    component: Component,
    state: FmuState,
    bytes: *mut Byte,
    size: usize,
) -> Status {
    let body = |instance: &mut Instance| {
        let serialized = instance.serialized(state)?;
        // SAFETY: room for `size` bytes (the caller's promise).
        let room = unsafe { output(bytes.cast::<u8>(), size, "serializedState") }?;
        if room.len() != serialized.len() {
            return Err(Failure::BufferSize {
                given: size,
                needed: serialized.len(),
            });
        }
        for (place, byte) in room.iter_mut().zip(serialized) {
            place.write(byte);
        }
        Ok(())
    };
    // SAFETY: a live instance (the caller's promise).
    unsafe { call(component, Function::SerializeFmuState, body) }
}

/// Makes a saved state of bytes.
///
/// # Safety
/// A live instance, `size` bytes and a pointer to a variable.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2DeSerializeFMUstate(
    component: Component,
    bytes: *const Byte,
    size: usize,
    state: *mut FmuState,
) -> Status {
    let body = |instance: &mut Instance| {
        // SAFETY: `size` bytes (the caller's promise).
        let bytes = unsafe { input(bytes.cast::<u8>(), size, "serializedState") }?;
        // SAFETY: a variable of the importer (the caller's promise).
        instance.deserialize(bytes, unsafe { variable(state, "FMUstate") }?)
    };
    // SAFETY: a live instance (the caller's promise).
    unsafe { call(component, Function::DeserializeFmuState, body) }
}

/// The derivative of outputs in a direction of the inputs, at the communication point.
///
/// # Safety
/// A live instance and as many elements as given behind each pointer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetDirectionalDerivative(
    component: Component,
    unknowns: *const ValueReference,
    n_unknowns: usize,
    knowns: *const ValueReference,
    n_knowns: usize,
    direction: *const Real,
    derivatives: *mut Real,
) -> Status {
    // SAFETY: as many elements as given (the caller's promise).
    let body = |instance: &mut Instance| unsafe {
        instance.get_directional_derivative(
            input(unknowns, n_unknowns, "vUnknown_ref")?,
            input(knowns, n_knowns, "vKnown_ref")?,
            input(direction, n_knowns, "dvKnown")?,
            output(derivatives, n_unknowns, "dvUnknown")?,
        )
    };
    // SAFETY: a live instance (the caller's promise).
    unsafe { call(component, Function::GetDirectionalDerivative, body) }
}

/// Sets rates of change of inputs for the next step.
///
/// # Safety
/// A live instance and `n` elements behind each pointer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetRealInputDerivatives(
    component: Component,
    references: *const ValueReference,
    n: usize,
    orders: *const Integer,
    values: *const Real,
) -> Status {
    // SAFETY: `n` elements (the caller's promise).
    let body = |instance: &mut Instance| unsafe {
        instance.set_input_derivatives(
            input(references, n, "vr")?,
            input(orders, n, "order")?,
            input(values, n, "value")?,
        )
    };
    // SAFETY: a live instance (the caller's promise).
    unsafe { call(component, Function::SetRealInputDerivatives, body) }
}

/// Reads rates of change of outputs at the communication point.
///
/// # Safety
/// A live instance and `n` elements behind each pointer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetRealOutputDerivatives(
    component: Component,
    references: *const ValueReference,
    n: usize,
    orders: *const Integer,
    values: *mut Real,
) -> Status {
    // SAFETY: `n` elements (the caller's promise).
    let body = |instance: &mut Instance| unsafe {
        instance.get_output_derivatives(
            input(references, n, "vr")?,
            input(orders, n, "order")?,
            output(values, n, "value")?,
        )
    };
    // SAFETY: a live instance (the caller's promise).
    unsafe { call(component, Function::GetRealOutputDerivatives, body) }
}

/// Advances the instance by one communication step.
///
/// # Safety
/// `component` must be null or a live instance.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2DoStep(
    component: Component,
    current_communication_point: Real,
    communication_step_size: Real,
    _no_set_fmu_state_prior_to_current_point: Boolean,
) -> Status {
    let body = |instance: &mut Instance| instance.do_step(current_communication_point, communication_step_size);
    // SAFETY: a live instance (the caller's promise).
    unsafe { call(component, Function::DoStep, body) }
}

/// Never allowed: steps are not asynchronous.
///
/// # Safety
/// `component` must be null or a live instance.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2CancelStep(component: Component) -> Status {
    // SAFETY: a live instance (the caller's promise).
    unsafe { call(component, Function::CancelStep, |_| Ok(())) }
}

/// A status query: writes what `answer` finds.
///
/// # Safety
/// A live instance and a place for one value.
unsafe fn status_query<T>(
    component: Component,
    function: Function,
    value: *mut T,
    answer: impl FnOnce(&Instance) -> Result<T, Failure>,
) -> Status {
    let body = |instance: &mut Instance| {
        // SAFETY: a place for one value (the caller's promise).
        let place = unsafe { place(value, "value") }?;
        place.write(answer(instance)?);
        Ok(())
    };
    // SAFETY: a live instance (the caller's promise).
    unsafe { call(component, function, body) }
}

/// No status of this type: steps are not asynchronous.
///
/// # Safety
/// A live instance and a place for one value.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetStatus(component: Component, kind: StatusKind, value: *mut Status) -> Status {
    let answer = |_: &Instance| Err(Failure::StatusKind { kind });
    // SAFETY: the caller's promise.
    unsafe { status_query(component, Function::GetStatus, value, answer) }
}

/// The time up to which the last step came.
///
/// # Safety
/// A live instance and a place for one value.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetRealStatus(component: Component, kind: StatusKind, value: *mut Real) -> Status {
    let answer = |instance: &Instance| instance.last_successful_time(kind);
    // SAFETY: the caller's promise.
    unsafe { status_query(component, Function::GetRealStatus, value, answer) }
}

/// No status of this type.
///
/// # Safety
/// A live instance and a place for one value.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetIntegerStatus(component: Component, kind: StatusKind, value: *mut Integer) -> Status {
    let answer = |_: &Instance| Err(Failure::StatusKind { kind });
    // SAFETY: the caller's promise.
    unsafe { status_query(component, Function::GetIntegerStatus, value, answer) }
}

/// Whether the component wants to end the simulation: never.
///
/// # Safety
/// A live instance and a place for one value.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetBooleanStatus(component: Component, kind: StatusKind, value: *mut Boolean) -> Status {
    let answer = |_: &Instance| {
        if kind == TERMINATED {
            Ok(FALSE)
        } else {
            Err(Failure::StatusKind { kind })
        }
    };
    // SAFETY: the caller's promise.
    unsafe { status_query(component, Function::GetBooleanStatus, value, answer) }
}

/// No status of this type: steps are not asynchronous.
///
/// # Safety
/// A live instance and a place for one value.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetStringStatus(component: Component, kind: StatusKind, value: *mut FmiString) -> Status {
    let answer = |_: &Instance| Err(Failure::StatusKind { kind });
    // SAFETY: the caller's promise.
    unsafe { status_query(component, Function::GetStringStatus, value, answer) }
}
