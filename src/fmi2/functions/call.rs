//! The way into every call on an instance.

use crate::fmi::call;
use crate::fmi2::failures::Failure;
use crate::fmi2::instance::Instance;
use crate::fmi2::states::Function;
use crate::fmi2::types::{Component, Status};

/// Runs [`call::call`] with the types of this version.
///
/// # Safety
/// `component` must be null or an instance that fmi2Instantiate returned, not freed, and not used by another thread.
pub(super) unsafe fn call(
    component: Component,
    function: Function,
    body: impl FnOnce(&mut Instance) -> Result<(), Failure>,
) -> Status {
    // SAFETY: the caller's promise.
    unsafe { call::call(component, function, body) }
}

#[cfg(test)]
mod tests {
    use super::call;
    use crate::fmi2::GUID;
    use crate::fmi2::functions::*;
    use crate::fmi2::states::Function;
    use crate::fmi2::types::{CallbackFunctions, Component, FmiString, LoggerCallback, Status};
    use std::cell::RefCell;
    use std::ffi::{CStr, CString};
    use std::process::Command;
    use std::ptr::null_mut;

    const CHILD: &str = "WHEELRAIL_PANIC_CHILD";

    /// The texts of the messages of an instance.
    type Journal = RefCell<Vec<String>>;

    /// The logger is variadic in C. Where arguments are passed in registers, as on the machines of the tests, one that is
    /// declared with one more argument receives the first variadic one.
    unsafe extern "C" fn collect(
        journal: *mut std::ffi::c_void,
        _name: FmiString,
        _status: Status,
        _category: FmiString,
        _format: FmiString,
        text: FmiString,
    ) {
        // SAFETY: the journal of `running` outlives its instance, the text ends with zero.
        let (journal, text) = unsafe { (&*journal.cast::<Journal>(), CStr::from_ptr(text)) };
        journal.borrow_mut().push(text.to_string_lossy().into_owned());
    }

    /// An instance in *stepComplete*.
    fn running(journal: &Journal) -> Component {
        type Collector =
            unsafe extern "C" fn(*mut std::ffi::c_void, FmiString, Status, FmiString, FmiString, FmiString);
        let callbacks = CallbackFunctions {
            // SAFETY: see `collect`.
            logger: Some(unsafe { std::mem::transmute::<Collector, LoggerCallback>(collect as Collector) }),
            allocate_memory: None,
            free_memory: None,
            step_finished: None,
            component_environment: (&raw const *journal).cast_mut().cast(),
        };
        let guid = CString::new(GUID).unwrap();
        // SAFETY: valid strings and callbacks.
        let component = unsafe { fmi2Instantiate(c"wheel".as_ptr(), 1, guid.as_ptr(), c"".as_ptr(), &callbacks, 0, 0) };
        assert!(!component.is_null());
        // contact_nodes and depth_nodes, so that the test is quick.
        let (references, values) = ([3002, 3003], [25, 17]);
        // SAFETY: a live instance, two elements behind each pointer.
        let initialized = unsafe {
            [
                fmi2SetInteger(component, references.as_ptr(), 2, values.as_ptr()),
                fmi2SetupExperiment(component, 0, 0.0, 0.0, 0, 0.0),
                fmi2EnterInitializationMode(component),
                fmi2ExitInitializationMode(component),
            ]
        };
        assert_eq!(initialized, [Status::OK; 4], "{:?}", journal.borrow());
        component
    }

    fn panics(component: Component) -> Status {
        // SAFETY: a live instance.
        unsafe { call(component, Function::Terminate, |_| panic!("deliberate panic")) }
    }

    /// All outputs, as bits.
    fn outputs(component: Component) -> [u64; 24] {
        let references: [u32; 24] = std::array::from_fn(|row| 1000 + row as u32);
        let mut values = [f64::NAN; 24];
        // SAFETY: a live instance, 24 elements behind each pointer.
        let status = unsafe { fmi2GetReal(component, references.as_ptr(), 24, values.as_mut_ptr()) };
        assert_eq!(status, Status::OK);
        values.map(f64::to_bits)
    }

    #[test]
    fn a_panic_becomes_an_error_with_a_message() {
        let (journal, other) = (Journal::default(), Journal::default());
        let (component, bystander) = (running(&journal), running(&other));
        let mut saved = null_mut();
        // SAFETY: live instances, a variable for the state.
        unsafe {
            assert_eq!(fmi2GetFMUstate(component, &mut saved), Status::OK);
            assert_eq!(panics(component), Status::ERROR);
            let message = journal.take().pop().unwrap();
            assert!(
                message.starts_with("fmi2Terminate: internal error: deliberate panic;"),
                "{message}"
            );
            assert_eq!(fmi2DoStep(component, 0.0, 1e-3, 1), Status::ERROR);
            assert!(journal.take().pop().unwrap().contains("state error"));
            assert_eq!(fmi2DoStep(bystander, 0.0, 1e-3, 1), Status::OK);
            assert_eq!(fmi2SetFMUstate(component, saved), Status::OK);
            assert_eq!(fmi2DoStep(component, 0.0, 1e-3, 1), Status::OK);
            assert_eq!(outputs(component), outputs(bystander));
            assert_eq!(panics(component), Status::ERROR);
            assert_eq!(fmi2Reset(component), Status::OK);
            assert_eq!(fmi2SetupExperiment(component, 0, 0.0, 0.0, 0, 0.0), Status::OK);
            fmi2FreeInstance(component);
            fmi2FreeInstance(bystander);
        }
    }

    #[test]
    fn nothing_is_written_to_standard_error() {
        const NAME: &str = concat!(module_path!(), "::nothing_is_written_to_standard_error");
        if std::env::var_os(CHILD).is_some() {
            let journal = Journal::default();
            let component = running(&journal);
            assert_eq!(panics(component), Status::ERROR);
            // SAFETY: a live instance.
            unsafe { fmi2FreeInstance(component) };
            return;
        }
        // The name of a test is its path without the crate's.
        let (_, name) = NAME.split_once("::").unwrap();
        let output = Command::new(std::env::current_exe().unwrap())
            .args(["--exact", name, "--nocapture"])
            .env(CHILD, "1")
            .output()
            .unwrap();
        assert!(output.status.success());
        assert!(String::from_utf8_lossy(&output.stdout).contains("1 passed"));
        assert_eq!(String::from_utf8_lossy(&output.stderr), "");
    }
}
