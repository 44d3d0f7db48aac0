//! No panic crosses the C boundary, and none writes to standard error. Nor does arithmetic: a call computes in an environment
//! of its own.

use super::arithmetic::HostEnvironment;
use std::cell::Cell;
use std::panic::{AssertUnwindSafe, PanicHookInfo, catch_unwind, set_hook, take_hook};
use std::sync::{Once, OnceLock};

type Hook = Box<dyn Fn(&PanicHookInfo<'_>) + Send + Sync>;

thread_local! {
    /// Whether this thread is inside a call. Without a destructor: the library is unloaded under people's feet.
    static INSIDE: Cell<bool> = const { Cell::new(false) };
}

/// Keeps the default message of a panic inside a call off standard error. In the shared library the standard library is its
/// own, so this touches nobody else's; in a Rust program all other panics still reach the hook that was there.
pub fn quiet_panics() {
    static ONCE: Once = Once::new();
    static PREVIOUS: OnceLock<Hook> = OnceLock::new();
    ONCE.call_once(|| {
        // Neither closure captures anything, so that unloading the library leaks nothing.
        let _ = PREVIOUS.set(take_hook());
        set_hook(Box::new(|info| {
            if let (false, Some(previous)) = (INSIDE.get(), PREVIOUS.get()) {
                previous(info);
            }
        }));
    });
}

/// A panic that was caught: a defect of this library.
#[derive(Debug)]
pub struct Panic {
    /// Message of the panic.
    pub message: String,
}

/// Runs the body of a call.
///
/// # Errors
/// [`Panic`]. What the body worked on may be half-done then: the caller must not use it.
pub fn fenced<T>(body: impl FnOnce() -> T) -> Result<T, Panic> {
    let outer = INSIDE.replace(true);
    let environment = HostEnvironment::put_aside();
    let result = catch_unwind(AssertUnwindSafe(|| apart(body)));
    drop(environment);
    INSIDE.set(outer);
    result.map_err(|payload| {
        let message = payload
            .downcast_ref::<&str>()
            .map(|text| (*text).to_owned())
            .or_else(|| payload.downcast_ref::<String>().cloned())
            .unwrap_or_default();
        Panic { message }
    })
}

/// Not inlined: the compiler, which knows nothing of floating-point environments, could move arithmetic out of its own.
#[inline(never)]
fn apart<T>(body: impl FnOnce() -> T) -> T {
    body()
}
