//! Tests that look at their whole process, or that may end it, run in a child process with no other test beside them.

use std::env::{current_exe, var_os};
use std::process::Command;

/// Set in the child.
const CHILD: &str = "WHEELRAIL_OWN_PROCESS";

/// Runs the rest of a test in a process of its own. `name` is the name of the test that calls this.
#[track_caller]
pub fn in_own_process(name: &str, test: impl FnOnce()) {
    if var_os(CHILD).is_some() {
        return test();
    }
    let child = Command::new(current_exe().expect("a path"))
        .args(["--exact", name, "--nocapture"])
        .env(CHILD, name)
        .output()
        .expect("the child runs");
    let text = |bytes| String::from_utf8_lossy(bytes).into_owned();
    let (output, errors) = (text(&child.stdout), text(&child.stderr));
    print!("{output}");
    // A name that is misspelt would run no test and succeed.
    assert!(
        child.status.success() && output.contains("1 passed"),
        "{name}: {}\n{output}\n{errors}",
        child.status
    );
}
