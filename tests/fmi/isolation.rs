//! The library leaves its host as it was: floating-point control, signal handlers, working directory, environment, threads and
//! open files; and between instantiation and fmi2FreeInstance or fmi3FreeInstance it reads and writes nothing.

use super::importer::{Client, Component, ERROR, OK, sideways, with_each};
use super::own_process::in_own_process;
use std::collections::BTreeMap;
use std::ffi::{CStr, CString, OsString, c_int};
use std::fs::{File, read_dir};
use std::io::Read;
use std::path::PathBuf;

/// What a process shares with its libraries.
#[derive(Debug, PartialEq)]
struct Surroundings {
    /// Rounding, masks and flushing of the vector unit, without the flags of what has happened.
    vector_control: u32,
    /// The same of the x87 unit.
    x87_control: u16,
    signal_handlers: Vec<usize>,
    directory: PathBuf,
    environment: BTreeMap<OsString, OsString>,
    locale: CString,
    threads: usize,
    files: usize,
}

impl Surroundings {
    fn now() -> Surroundings {
        let (mut vector_control, mut x87_control) = (0_u32, 0_u16);
        // SAFETY: each instruction stores its control word at the place given.
        unsafe {
            std::arch::asm!("stmxcsr [{}]", in(reg) &mut vector_control, options(nostack));
            std::arch::asm!("fnstcw [{}]", in(reg) &mut x87_control, options(nostack));
        }
        let count = |folder: &str| read_dir(folder).expect(folder).count();
        // SAFETY: a null locale only asks; the answer is a string that stands until the next change.
        let locale = unsafe { CStr::from_ptr(libc::setlocale(libc::LC_ALL, std::ptr::null())) }.to_owned();
        Surroundings {
            vector_control: vector_control & !0x3f,
            x87_control,
            signal_handlers: (1..32).map(handler).collect(),
            directory: std::env::current_dir().expect("a directory"),
            environment: std::env::vars_os().collect(),
            locale,
            threads: count("/proc/self/task"),
            files: count("/proc/self/fd"),
        }
    }
}

fn handler(signal: c_int) -> usize {
    // SAFETY: all zeros is a value of the structure; a null action only asks.
    unsafe {
        let mut action: libc::sigaction = std::mem::zeroed();
        libc::sigaction(signal, std::ptr::null(), &mut action);
        action.sa_sigaction
    }
}

/// Calls of this process that read and wrote, those for this answer included.
fn reads_and_writes() -> [u64; 2] {
    // One call, however long the text is.
    let mut text = [0; 1024];
    let length = File::open("/proc/self/io").expect("io").read(&mut text).expect("io");
    let io = std::str::from_utf8(&text[..length]).expect("UTF-8");
    ["syscr: ", "syscw: "].map(|name| {
        let line = io.lines().find_map(|line| line.strip_prefix(name));
        line.expect(name).parse().expect("a number")
    })
}

/// A life with steps, states, derivatives, an error and a reset.
fn live(client: &Client) {
    let (api, component): (_, Component) = (client.api, client.component);
    for _ in 0..2 {
        client.make_coarse();
        client.expect(OK, client.begin(0.0, None));
        client.expect(OK, client.set(&[("creepage", 0.01)]));
        client.expect(OK, client.set(sideways(client.contact)));
        client.expect(OK, client.exit());
        let handle = client.save();
        for step in 0..10 {
            client.expect(OK, client.step(0.01 * f64::from(step), 0.01));
        }
        client.expect(OK, client.restore(handle));
        client.serialize(handle);
        let (force, creepage) = (api.reference("traction_force"), api.reference("creepage"));
        // SAFETY: one element behind each pointer.
        client.expect(OK, unsafe {
            client
                .api
                .directional_derivative(component, &force, 1, &creepage, 1, &1.0, &mut 0.0)
        });
        client.expect(ERROR, client.step(0.0, f64::NAN));
        client.expect(OK, client.reset());
    }
}

#[test]
fn the_host_is_left_as_it_was() {
    in_own_process("isolation::the_host_is_left_as_it_was", leave_the_host_as_it_was);
}

fn leave_the_host_as_it_was() {
    with_each(|api, contact| {
        let before = Surroundings::now();
        let mut client = Client::with_logging(api, true);
        client.contact = contact;
        // The C library looks up once how memory is lent out (/proc/sys/vm/overcommit_memory), before it gives some back.
        live(&client);
        // What two answers cost, with nothing in between.
        let (first, second) = (reads_and_writes(), reads_and_writes());
        live(&client);
        let third = reads_and_writes();
        for kind in [0, 1] {
            assert_eq!(third[kind] - second[kind], second[kind] - first[kind]);
        }
        drop(client);
        assert_eq!(Surroundings::now(), before);

        // A host that flushes subnormal numbers to zero keeps it so, and gets finite numbers.
        let usual: u32 = 0x1f80;
        let flushing = usual | 1 << 15 | 1 << 6;
        // SAFETY: a valid control word, for this thread.
        let control = |word: u32| unsafe { std::arch::asm!("ldmxcsr [{}]", in(reg) &word, options(nostack, readonly)) };
        control(flushing);
        let client = Client::running(api, contact, &[("creepage", 0.01)]);
        client.expect(OK, client.step(0.0, 0.01));
        assert!(
            client
                .outputs()
                .into_iter()
                .all(|bits| f64::from_bits(bits).is_finite())
        );
        assert_eq!(Surroundings::now().vector_control, flushing);
        control(usual);
    });
}
