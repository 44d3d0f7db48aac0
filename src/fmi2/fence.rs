//! No panic crosses the C boundary, and none writes to standard error.

use super::failure::Failure;
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

/// Runs the body of a call; a panic becomes [`Failure::Panic`].
pub fn fenced<T>(body: impl FnOnce() -> Result<T, Failure>) -> Result<T, Failure> {
    let outer = INSIDE.replace(true);
    // The instance is put into the error state after a panic, and its model dropped: nothing half-done is used.
    let result = catch_unwind(AssertUnwindSafe(body));
    INSIDE.set(outer);
    result.unwrap_or_else(|payload| {
        let message = payload
            .downcast_ref::<&str>()
            .map(|text| (*text).to_owned())
            .or_else(|| payload.downcast_ref::<String>().cloned())
            .unwrap_or_default();
        Err(Failure::Panic { message })
    })
}
