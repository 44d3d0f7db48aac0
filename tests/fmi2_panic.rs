//! No panic crosses the C boundary, and none writes to standard error. Built with the feature `panic-injection`, where
//! fmi2Terminate panics.

#![allow(unsafe_code)]

mod common;

use common::{Api, Client, ERROR, OK};
use std::process::Command;

const CHILD: &str = "WHEELRAIL_PANIC_CHILD";

#[test]
fn a_panic_becomes_an_error_with_a_message() {
    let api = Api::load();
    let client = Client::running(&api, &[]);
    let bystander = Client::running(&api, &[]);
    let handle = client.save();
    client.expect(ERROR, client.terminate());
    let message = client.last_message();
    assert!(
        message.contains("fmi2Terminate: internal error: deliberate panic"),
        "{message}"
    );
    client.expect(ERROR, client.step(0.0, 1e-3));
    assert!(client.last_message().contains("state error"));
    bystander.expect(OK, bystander.step(0.0, 1e-3));
    client.expect(OK, client.restore(handle));
    client.expect(OK, client.step(0.0, 1e-3));
    assert_eq!(client.outputs(), bystander.outputs());
    client.expect(OK, client.reset());
    drop((client, bystander));
    drop(api);
    // Nothing of the panic is left in the thread that would have to be destroyed.
    #[cfg(target_os = "linux")]
    assert!(!common::is_mapped());
}

#[test]
fn nothing_is_written_to_standard_error() {
    if std::env::var_os(CHILD).is_some() {
        let api = Api::load();
        let client = Client::running(&api, &[]);
        client.expect(ERROR, client.terminate());
        return;
    }
    let test = std::env::current_exe().expect("a path");
    let output = Command::new(test)
        .args(["--exact", "nothing_is_written_to_standard_error", "--nocapture"])
        .env(CHILD, "1")
        .output()
        .expect("the child runs");
    assert!(output.status.success());
    assert_eq!(String::from_utf8_lossy(&output.stderr), "");
}
