//! The library is loaded and unloaded many times in one process, with an instance in between.

#![allow(unsafe_code)]
#![cfg(target_os = "linux")]

mod common;

use common::{Api, Client, OK};
use std::fs::read_to_string;

fn resident_pages() -> usize {
    let statm = read_to_string("/proc/self/statm").expect("statm");
    statm.split(' ').nth(1).expect("resident").parse().expect("a number")
}

fn threads() -> usize {
    std::fs::read_dir("/proc/self/task").expect("tasks").count()
}

#[test]
fn a_hundred_loads_leave_nothing_behind() {
    let cycle = || {
        let api = Api::load();
        let client = Client::running(&api, &[("creepage", 0.01)]);
        client.expect(OK, client.step(0.0, 0.01));
        client.save();
    };
    (0..10).for_each(|_| cycle());
    let (pages, tasks) = (resident_pages(), threads());
    (0..100).for_each(|_| cycle());
    // 4 MiB of slack for the allocator; one leaked library or instance would be several hundred.
    assert!(
        resident_pages() < pages + 1024,
        "{} pages before, {} after",
        pages,
        resident_pages()
    );
    assert_eq!(threads(), tasks, "the library has no threads");
}
