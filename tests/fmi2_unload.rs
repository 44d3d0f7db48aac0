//! The library is loaded and unloaded many times in one process, with an instance in between.

#![allow(unsafe_code)]
#![cfg(target_os = "linux")]

mod common;

use common::{library_path, Api, Client, ERROR, OK};
use std::fs::read_to_string;

fn resident_pages() -> usize {
    let statm = read_to_string("/proc/self/statm").expect("statm");
    statm.split(' ').nth(1).expect("resident").parse().expect("a number")
}

fn threads() -> usize {
    std::fs::read_dir("/proc/self/task").expect("tasks").count()
}

fn is_mapped() -> bool {
    let maps = read_to_string("/proc/self/maps").expect("maps");
    maps.lines()
        .any(|line| line.ends_with(&*library_path().to_string_lossy()))
}

/// A thread-local value with a destructor would keep the library in memory until its thread ends, or crash the thread then
/// where the system does not see to that (glibc before 2.18).
#[test]
fn a_hundred_loads_leave_nothing_behind() {
    let cycle = |contact_nodes: i32| {
        let api = Api::load();
        {
            let client = Client::new(&api);
            client.expect(OK, client.set_integers(&[("contact_nodes", contact_nodes)]));
            client.expect(OK, client.setup(0.0, None));
            client.expect(OK, client.enter());
            client.expect(OK, client.exit());
            client.expect(OK, client.set(&[("creepage", 0.01)]));
            client.expect(OK, client.step(0.0, 0.01));
            client.serialize(client.save());
            client.expect(ERROR, client.step(0.0, f64::NAN));
        }
        assert!(is_mapped());
        drop(api);
        assert!(!is_mapped(), "the library is gone");
    };
    // Larger matrices go other ways through the linear algebra.
    cycle(121);
    (0..10).for_each(|_| cycle(25));
    let (pages, tasks) = (resident_pages(), threads());
    (0..100).for_each(|_| cycle(25));
    // 4 MiB of slack for the allocator; one leaked library or instance would be several hundred.
    assert!(
        resident_pages() < pages + 1024,
        "{} pages before, {} after",
        pages,
        resident_pages()
    );
    assert_eq!(threads(), tasks, "the library has no threads");
}
