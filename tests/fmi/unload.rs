//! The library is loaded and unloaded many times in one process, with an instance in between.

use super::importer::{
    Api, Client, ContactModel, DISCARD, ERROR, Fmi2, Fmi3, Line, OK, Patch, Standard, coarse, is_mapped, sideways,
};
use super::own_process::in_own_process;
use std::ffi::c_int;
use std::fs::read_to_string;
use std::ptr::null;
use std::sync::Arc;
use std::sync::mpsc::channel;

fn resident_pages() -> usize {
    let statm = read_to_string("/proc/self/statm").expect("statm");
    statm.split(' ').nth(1).expect("resident").parse().expect("a number")
}

fn threads() -> usize {
    std::fs::read_dir("/proc/self/task").expect("tasks").count()
}

/// A contact model with Integer parameters.
type Grid = (ContactModel, &'static [(&'static str, c_int)]);

/// In sizes that go different ways through the linear algebra.
const LARGE: [Grid; 3] = [
    (Line, &[("contact_nodes", 121)]),
    (Line, &[("contact_nodes", 181)]),
    (Patch, &[("contact_model", 2)]),
];

/// Everything that an importer may do with an instance.
fn use_all(api: &Api, (contact, grid): Grid) {
    let client = Client::with_logging(api, true);
    let (c, n) = (client.component, null());
    client.expect(OK, client.set_integers(grid));
    client.start();
    client.expect(OK, client.set(&[("creepage", 0.01)]));
    client.expect(OK, client.set(sideways(contact)));
    if api.takes_rates() {
        client.expect(OK, client.set_rates(&[("normal_load", 1, 1e4)]));
    }
    client.expect(OK, client.step(0.0, 0.01));
    let mut handle = client.save();
    let bytes = client.serialize(handle);
    client.expect(OK, client.restore(handle));
    client.expect(OK, client.deserialize(&bytes, &mut handle));
    let (force, creepage) = (api.reference("traction_force"), api.reference("creepage"));
    // SAFETY: one element behind each pointer.
    unsafe {
        client.expect(OK, api.set_debug_logging(c, 1, 0, n));
        client.expect(
            OK,
            api.directional_derivative(c, &force, 1, &creepage, 1, &1.0, &mut 0.0),
        );
        client.expect(OK, api.get_output_derivatives(c, &force, 1, &1, &mut 0.0));
        if let Fmi2 = api.standard {
            client.expect(DISCARD, (api.fmi2.fmi2GetStatus)(c, 0, &mut 0));
        }
        if let Fmi3 = api.standard {
            let mut sensitivity = 0.0;
            client.expect(
                OK,
                (api.fmi3.fmi3GetAdjointDerivative)(c, &force, 1, &creepage, 1, &1.0, 1, &mut sensitivity, 1),
            );
        }
        client.expect(OK, api.free_state(c, &mut handle));
    }
    client.expect(ERROR, client.step(0.0, f64::NAN));
    client.expect(OK, client.reset());
}

#[test]
fn a_hundred_loads_leave_nothing_behind() {
    in_own_process("unload::a_hundred_loads_leave_nothing_behind", load_a_hundred_times);
}

fn load_a_hundred_times() {
    let cycle = |standard: Standard, grid: Grid| {
        let api = Api::load(standard);
        use_all(&api, grid);
        assert!(is_mapped());
        drop(api);
        assert!(!is_mapped(), "the library is gone");
    };
    let small = [Line, Patch].map(|contact| (contact, coarse(contact)));
    let large = LARGE.into_iter().zip([Fmi2, Fmi3, Fmi2]);
    large.for_each(|(grid, standard)| cycle(standard, grid));
    // Each grid by each standard in turn.
    let both = |cycles: usize| {
        for k in 0..2 * cycles {
            cycle(Standard::ALL[k / 2 % 2], small[k % 2]);
        }
    };
    both(6);
    let (pages, tasks) = (resident_pages(), threads());
    both(50);
    // 4 MiB of slack for the allocator; one leaked library or instance would be several hundred.
    assert!(
        resident_pages() < pages + 1024,
        "{} pages before, {} after",
        pages,
        resident_pages()
    );
    assert_eq!(threads(), tasks, "the library has no threads");
}

/// A thread that has called the library ends after the library is gone: a destructor of a thread-local value would be called
/// then, or have kept the library in memory.
#[test]
fn threads_outlive_the_library() {
    in_own_process("unload::threads_outlive_the_library", outlive_the_library);
}

fn outlive_the_library() {
    let small = [Line, Patch].map(|contact| (contact, coarse(contact)));
    for (k, grid) in small.into_iter().chain(small).chain(LARGE).enumerate() {
        let api = Arc::new(Api::load(Standard::ALL[k / 2 % 2]));
        let ((called, wait), (unloaded, go)) = (channel(), channel());
        let shared = Arc::clone(&api);
        let thread = std::thread::spawn(move || {
            use_all(&shared, grid);
            drop(shared);
            called.send(()).expect("the test waits");
            go.recv().expect("the test goes on");
        });
        wait.recv().expect("the thread has called");
        drop(api);
        assert!(!is_mapped(), "the library is gone, the thread is not");
        unloaded.send(()).expect("the thread waits");
        thread.join().expect("the thread ends");
    }
}
