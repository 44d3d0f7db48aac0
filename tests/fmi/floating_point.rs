//! Hosts that are hostile to arithmetic: traps unmasked (`feenableexcept`, Fortran's `-ffpe-trap`), another rounding, subnormal
//! numbers set to zero. A call computes the same bits under all of them, raises nothing, and leaves registers and flags as they
//! were.

use super::importer::{
    Api, Client, ContactModel, DISCARD, ERROR, Handle, Line, OK, Patch, Profiles, Standard, coarse, sideways, with_each,
};
use super::own_process::in_own_process;
use super::{functions, probes};
use std::arch::asm;
use std::ffi::c_int;
use wheelrail::signals::{INPUTS, OUTPUTS};
use wheelrail::wheel_rail::PROFILE_POINTS;

/// Exceptions of the processor, as bits of MXCSR and of the control and status words of the x87 alike.
const INVALID: u32 = 1;
const DIVISION_BY_ZERO: u32 = 4;
const OVERFLOW: u32 = 8;
const INEXACT: u32 = 32;
const ALL: u32 = 63;

const USUAL_MXCSR: u32 = 0x1f80;
const USUAL_X87: u16 = 0x037f;

/// The registers that a host sees.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Registers {
    /// Control and flags of the vector unit.
    mxcsr: u32,
    x87_control: u16,
    /// Flags of the x87.
    x87_status: u16,
}

impl Registers {
    fn now() -> Registers {
        let (mut mxcsr, mut x87_control, mut x87_status) = (0, 0, 0);
        // SAFETY: each instruction stores its word at the place given.
        unsafe {
            asm!(
                "stmxcsr [{}]", "fnstcw [{}]", "fnstsw [{}]",
                in(reg) &raw mut mxcsr, in(reg) &raw mut x87_control, in(reg) &raw mut x87_status, options(nostack)
            );
        }
        Registers {
            mxcsr,
            x87_control,
            x87_status,
        }
    }
}

fn set(mxcsr: u32, x87_control: u16) {
    // SAFETY: valid control words, for this thread; `fnclex` clears the flags, which would trap when they are unmasked.
    unsafe {
        asm!(
            "fnclex", "fldcw [{}]", "ldmxcsr [{}]",
            in(reg) &raw const x87_control, in(reg) &raw const mxcsr, options(nostack)
        );
    }
}

/// A host with its own registers while this lives.
struct Host(Registers);

impl Host {
    fn with(mxcsr: u32, x87_control: u16) -> Host {
        set(mxcsr, x87_control);
        Host(Registers::now())
    }

    /// All is as it was.
    #[track_caller]
    fn check(&self, what: &str) {
        assert_eq!(Registers::now(), self.0, "{what}");
    }
}

impl Drop for Host {
    fn drop(&mut self) {
        set(USUAL_MXCSR, USUAL_X87);
    }
}

/// `feenableexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW)` of glibc.
fn enable_traps() {
    unsafe extern "C" {
        fn feenableexcept(exceptions: c_int) -> c_int;
    }
    // SAFETY: the function of the C library, for this thread.
    let before = unsafe { feenableexcept((INVALID | DIVISION_BY_ZERO | OVERFLOW) as c_int) };
    assert_ne!(before, -1);
    let unmasked = Registers::now();
    let masks = (INVALID | DIVISION_BY_ZERO | OVERFLOW) << 7;
    assert_eq!(
        (unmasked.mxcsr & masks, u32::from(unmasked.x87_control) & masks >> 7),
        (0, 0)
    );
}

/// Inputs, and the steps that are taken with them: time and size.
struct Manoeuvre {
    inputs: Vec<(&'static str, f64)>,
    steps: Vec<(f64, f64)>,
}

/// A wheel that lifts and comes back, one that stands, locks and turns on the spot. Computed in the usual environment: a host that
/// rounds otherwise would ask for something else.
fn plan(contact: ContactModel) -> (Vec<Manoeuvre>, f64) {
    let mut time = 0.0;
    // Load, speed of the vehicle, of the wheel, across, and spin.
    let rows = [
        [6e4, 10.0, 10.05, 0.01, 0.3],
        [0.0, 10.0, 10.0, 0.0, 0.0],
        [0.0, 0.0, 0.0, 0.0, 0.0],
        [6e4, 0.0, 0.0, 0.0, 0.0],
        [6e4, 0.0, 1.0, 0.01, 1.0],
        [6e4, 5e-324, 5e-324, 0.0, 0.0],
        [6e4, 20.0, 0.0, 0.0, 0.0],
        [1e-300, 20.0, 20.0, 0.0, 0.0],
        [6e4, -5.0, -5.1, -0.01, 0.0],
        [6e4, 20.0, 20.0, 0.0, 0.0],
    ];
    let manoeuvres = rows.map(|[load, vehicle, wheel, lateral, spin]| {
        let mut inputs = vec![
            ("normal_load", load),
            ("vehicle_speed", vehicle),
            ("wheel_speed", wheel / 0.46),
        ];
        if contact == Patch {
            inputs.extend([("lateral_speed", lateral), ("spin_rate", spin)]);
        }
        let steps = [1e-3, 5e-324, 1e-3].map(|size| {
            let begin = time;
            time += size;
            (begin, size)
        });
        Manoeuvre {
            inputs,
            steps: steps.to_vec(),
        }
    });
    (manoeuvres.into(), time)
}

/// A run through what divides by zero, overflows or has no number as its result where nobody looks: the plan, refused values, and
/// derivatives at all of it. The outputs on the way; `called` looks at the registers.
fn drive(api: &Api, contact: ContactModel, (plan, end): &(Vec<Manoeuvre>, f64), called: &dyn Fn(&str)) -> Vec<u64> {
    let mut bits = Vec::new();
    let client = Client::coarse(api, contact);
    called("coarse");
    client.expect(OK, client.set_integers(&[("slip_source", 2), ("wheel_heating", 2)]));
    called("set_integers");
    client.expect(OK, client.begin(0.0, None));
    called("begin");
    client.expect(OK, client.set(sideways(contact)));
    client.expect(OK, client.exit());
    called("exit");
    for Manoeuvre { inputs, steps } in plan {
        client.expect(OK, client.set(inputs));
        called("set");
        for (time, size) in steps {
            client.expect(OK, client.step(*time, *size));
            called("step");
        }
        bits.extend(client.outputs());
        called("get");
        bits.extend(derivatives(&client));
        called("derivatives");
        let profile = client.api.array("profile.temperature", PROFILE_POINTS);
        let mut values = [f64::NAN; PROFILE_POINTS];
        client.expect(OK, client.get_references(&profile, &mut values));
        called("profile");
        bits.extend(values.map(f64::to_bits));
        for value in [
            f64::NAN,
            f64::INFINITY,
            f64::from_bits(0x7ff0_0000_0000_0001),
            f64::MAX,
            -1.0,
        ] {
            client.expect(DISCARD, client.set(&[("normal_load", value)]));
            called("refused input");
        }
    }
    saved(&client, *end, &mut bits);
    called("saved states");
    bits
}

/// All outputs × inputs; where the equations have no derivative the call is an error, and a saved state leads on.
fn derivatives(client: &Client) -> Vec<u64> {
    let (api, c) = (client.api, client.component);
    let unknowns = api.standard.outputs();
    let mut handle: Handle = std::ptr::null_mut();
    let mut bits = Vec::new();
    let mut values = vec![0.0; OUTPUTS.len()];
    // SAFETY: as many elements as are counted, and a variable.
    unsafe {
        client.expect(OK, api.get_state(c, &mut handle));
        for row in INPUTS {
            let known = api.reference(row.name);
            let status = client.directional(&unknowns, &[known], &[1.0], &mut values);
            assert!([OK, ERROR].contains(&status));
            if status == ERROR {
                client.expect(OK, client.restore(handle));
            } else {
                bits.extend(values.iter().map(|value| value.to_bits()));
            }
        }
        bits.extend(client.output_rates().into_iter().map(f64::to_bits));
        client.expect(OK, api.free_state(c, &mut handle));
    }
    bits
}

/// Saves, serialises, refuses noise, fails a call, comes back and steps.
fn saved(client: &Client, time: f64, bits: &mut Vec<u64>) {
    let handle = client.save();
    let bytes = client.serialize(handle);
    let mut copy = std::ptr::null_mut();
    client.expect(OK, client.deserialize(&bytes, &mut copy));
    client.expect(ERROR, client.deserialize(&bytes[1..], &mut copy));
    client.expect(ERROR, client.step(time, f64::NAN));
    client.expect(OK, client.restore(copy));
    client.expect(OK, client.step(time, 1e-3));
    bits.extend(client.outputs());
    bits.push(u64::from(crc32fast::hash(&bytes)));
}

#[test]
fn a_host_that_unmasks_exceptions_survives_every_probe() {
    in_own_process(
        "floating_point::a_host_that_unmasks_exceptions_survives_every_probe",
        || {
            enable_traps();
            for probe in probes::all() {
                probes::run(probe);
                // Nothing has masked them again.
                assert_eq!(
                    Registers::now().mxcsr & (INVALID | DIVISION_BY_ZERO | OVERFLOW) << 7,
                    0,
                    "{}",
                    probe.name
                );
            }
            println!("{} probes", probes::all().count());
        },
    );
}

#[test]
fn a_host_that_unmasks_exceptions_survives_lift_off_standstill_and_derivatives() {
    const NAME: &str = "floating_point::a_host_that_unmasks_exceptions_survives_lift_off_standstill_and_derivatives";
    in_own_process(NAME, || {
        with_each(|api, contact| {
            let plan = plan(contact);
            let usual = drive(api, contact, &plan, &|_| {});
            enable_traps();
            let unmasked = drive(api, contact, &plan, &|_| {});
            set(USUAL_MXCSR, USUAL_X87);
            assert_eq!(unmasked, usual);
        });
    });
}

/// Nor does a call leave a flag of its own, by which a host would think that it has divided by zero itself.
#[test]
fn a_call_has_the_same_bits_in_every_environment_and_leaves_it_as_it_was() {
    const NAME: &str = "floating_point::a_call_has_the_same_bits_in_every_environment_and_leaves_it_as_it_was";
    in_own_process(NAME, || {
        // Rounding down, up, to zero; flushing of results and operands; traps; flags of the past; precision of the x87.
        let rounding = |mode: u32| (USUAL_MXCSR | mode << 13, USUAL_X87 | (mode as u16) << 10);
        let hosts = [
            ("usual", (USUAL_MXCSR, USUAL_X87)),
            ("rounding down", rounding(1)),
            ("rounding up", rounding(2)),
            ("rounding to zero", rounding(3)),
            ("subnormal numbers to zero", (USUAL_MXCSR | 1 << 15 | 1 << 6, USUAL_X87)),
            ("flags of the past", (USUAL_MXCSR | ALL, USUAL_X87)),
            ("single precision of the x87", (USUAL_MXCSR, USUAL_X87 & !0x300)),
            (
                "traps",
                (
                    USUAL_MXCSR & !((INVALID | DIVISION_BY_ZERO | OVERFLOW) << 7) | INEXACT,
                    USUAL_X87 & !(INVALID | DIVISION_BY_ZERO | OVERFLOW) as u16,
                ),
            ),
        ];
        with_each(|api, contact| {
            let plan = plan(contact);
            let expected = drive(api, contact, &plan, &|_| {});
            for (name, (mxcsr, x87_control)) in hosts {
                let host = Host::with(mxcsr, x87_control);
                // What the host computes between the calls raises flags of its own.
                let called = |what: &str| {
                    let control = Registers {
                        mxcsr: Registers::now().mxcsr & !ALL,
                        ..Registers::now()
                    };
                    let given = Registers {
                        mxcsr: host.0.mxcsr & !ALL,
                        ..host.0
                    };
                    assert_eq!(control, given, "{name}: {what}");
                };
                let bits = drive(api, contact, &plan, &called);
                drop(host);
                let differs = bits.iter().zip(&expected).position(|(a, b)| a != b);
                assert_eq!((differs, bits.len()), (None, expected.len()), "{name}");
            }
        });
    });
}

/// Every function by itself, in *Step Mode*: registers and flags to the bit.
#[test]
fn no_function_leaves_a_flag() {
    in_own_process("floating_point::no_function_leaves_a_flag", || {
        for standard in Standard::ALL {
            let api = &Api::load(standard);
            for contact in [Line, Patch] {
                let client = Client::running(api, contact, &[("creepage", 0.004)]);
                let begin = client.save();
                for function in functions::of_standard(standard) {
                    for (mxcsr, x87_control) in [
                        (USUAL_MXCSR, USUAL_X87),
                        (USUAL_MXCSR | 1 << 13 | INEXACT, USUAL_X87 | 1 << 10),
                        (
                            USUAL_MXCSR & !((INVALID | DIVISION_BY_ZERO) << 7),
                            USUAL_X87 & !(INVALID as u16),
                        ),
                    ] {
                        client.expect(OK, client.restore(begin));
                        let mut handle = client.save();
                        let host = Host::with(mxcsr, x87_control);
                        (function.call)(api, client.component, handle);
                        host.check(function.name);
                        drop(host);
                        // SAFETY: a state that has been freed, or not, is refused, or not.
                        unsafe { api.free_state(client.component, &mut handle) };
                    }
                }
            }
        }
    });
}

/// Nor does the reason of a refusal, in which metres become millimetres.
#[test]
fn a_reason_leaves_no_flag() {
    in_own_process("floating_point::a_reason_leaves_no_flag", || {
        for standard in Standard::ALL {
            let api = &Api::load(standard);
            let mut client = Client::new(api);
            client.contact = Profiles;
            client.hear_refusals();
            client.expect(OK, client.set_integers(coarse(Profiles)));
            client.expect(OK, client.set(&[("gauge_depth", 0.0437)]));
            client.expect(OK, client.begin(0.0, Some(10.0)));
            let host = Host::with(USUAL_MXCSR, USUAL_X87);
            let status = client.exit();
            host.check("the refusal of a gauge");
            drop(host);
            client.expect(ERROR, status);
            let message = client.last_message();
            assert!(message.contains("= 43.7 mm"), "{message}");
        }
    });
}
