//! After the first steps a step allocates nothing, natively and through the interface with logging off. The library is
//! linked here, not loaded, so that its allocations go through the counting allocator.

#![allow(unsafe_code)]

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::ffi::CString;
use std::ptr::{null, null_mut};
use wheelrail::fmi2::types::{self as fmi2, CallbackFunctions};
use wheelrail::fmi3::types as fmi3;
use wheelrail::parameters::{ContactModel, NormalSolver, Parameters, ProfileWear, SlipSource, Wheel, WheelHeating};
use wheelrail::signals::Inputs;
use wheelrail::wheel_rail::Model;

/// Counts what a thread takes from the system's allocator.
struct Counting;

thread_local! {
    static ALLOCATIONS: Cell<usize> = const { Cell::new(0) };
    /// Bytes that it holds of them.
    static HELD: Cell<isize> = const { Cell::new(0) };
}

fn hold(bytes: usize, sign: isize) {
    HELD.set(HELD.get() + sign * bytes as isize);
}

// SAFETY: the system's allocator does the work.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        ALLOCATIONS.set(ALLOCATIONS.get() + 1);
        hold(layout.size(), 1);
        // SAFETY: the caller's promise.
        unsafe { System.alloc(layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        ALLOCATIONS.set(ALLOCATIONS.get() + 1);
        hold(layout.size(), 1);
        // SAFETY: the caller's promise.
        unsafe { System.alloc_zeroed(layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        ALLOCATIONS.set(ALLOCATIONS.get() + 1);
        hold(size, 1);
        hold(layout.size(), -1);
        // SAFETY: the caller's promise.
        unsafe { System.realloc(pointer, layout, size) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        hold(layout.size(), -1);
        // SAFETY: the caller's promise.
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Allocations of this thread during a call.
fn allocations<T>(body: impl FnOnce() -> T) -> (usize, T) {
    let before = ALLOCATIONS.get();
    let result = body();
    (ALLOCATIONS.get() - before, result)
}

/// That of the default parameters, which have texts: making them allocates.
const WHEEL_RADIUS: f64 = 0.46;

/// A braking wheel whose load, slip and friction change from step to step, with a lift-off, a locked wheel and a standstill.
fn inputs(step: u32) -> Inputs {
    let phase = f64::from(step % 40);
    let vehicle_speed = (20.0 - 0.05 * f64::from(step)).max(0.0);
    let creepage = match step % 97 {
        0..=9 => -1.0,
        10..=40 => 1e-4 * phase,
        _ => -0.02,
    };
    Inputs {
        vehicle_speed,
        wheel_speed: vehicle_speed * (1.0 + creepage) / WHEEL_RADIUS,
        normal_load: if step.is_multiple_of(83) {
            0.0
        } else {
            40e3 + 1.5e3 * phase
        },
        friction_scale: 0.3 + 0.02 * phase,
        incoming_temperature: 293.15 + phase,
        incoming_wear_depth: 1e-8 * phase,
        ..Inputs::default()
    }
}

/// The same with motion across the rail, for a patch.
fn swaying(step: u32) -> Inputs {
    let phase = f64::from(step % 60) / 60.0 - 0.5;
    Inputs {
        lateral_speed: 0.1 * phase,
        spin_rate: -3.0 * phase,
        ..inputs(step)
    }
}

/// Friction that falls with slip and remembers, on a layer that is sheared, flows and hardens.
fn with_all_laws(parameters: Parameters) -> Parameters {
    Parameters {
        friction_slip_share: 0.5,
        friction_slip_decay: 0.5,
        friction_memory_distance: 3e-6,
        layer_compliance: 1e-13,
        layer_yield_stress: 1e8,
        layer_hardening: 1e12,
        ..parameters
    }
}

const STEPS: u32 = 500;
const WARM_UP: u32 = 1;

#[test]
fn a_step_of_the_model_allocates_nothing() {
    for (normal_solver, wheel_heating, laws, steps) in [
        (NormalSolver::ActiveSet, WheelHeating::Off, false, STEPS),
        (NormalSolver::ActiveSet, WheelHeating::On, false, STEPS),
        (NormalSolver::ActiveSet, WheelHeating::On, true, STEPS),
        (NormalSolver::Pschenichnyj, WheelHeating::Off, false, 20),
    ] {
        let parameters = Parameters {
            slip_source: SlipSource::VehicleSpeed,
            normal_solver,
            wheel: Wheel::Elastic,
            wheel_heating,
            // Good contact with a thin ring: rail and wheel iterate.
            contact_thermal_resistance: 10.0,
            rim_depth: 1e-3,
            rim_width: 1e-3,
            ..Parameters::default()
        };
        let model = Model::new(if laws { with_all_laws(parameters) } else { parameters }).unwrap();
        let mut workspace = model.workspace();
        let mut state = model.initial_state(&mut workspace, &inputs(1)).unwrap();
        for step in 1..steps {
            let (count, result) =
                allocations(|| model.step(&mut workspace, &mut state, &inputs(step), &Inputs::ZERO, 1e-3));
            result.unwrap();
            assert!(
                step <= WARM_UP || count == 0,
                "{normal_solver:?}, all laws {laws}, step {step}: {count} allocations"
            );
        }
    }
}

#[test]
fn a_step_of_a_patch_allocates_nothing() {
    for (wheel, wheel_heating, laws) in [
        (Wheel::Elastic, WheelHeating::Off, false),
        (Wheel::Elastic, WheelHeating::On, false),
        (Wheel::Elastic, WheelHeating::On, true),
        (Wheel::Rigid, WheelHeating::Off, false),
    ] {
        let parameters = Parameters {
            contact_model: ContactModel::Patch,
            slip_source: SlipSource::VehicleSpeed,
            wheel,
            wheel_heating,
            contact_thermal_resistance: 10.0,
            rim_depth: 1e-3,
            rim_width: 1e-3,
            patch_nodes: 20,
            patch_strips: 11,
            ..Parameters::default()
        };
        let model = Model::new(if laws { with_all_laws(parameters) } else { parameters }).unwrap();
        let mut workspace = model.workspace();
        let mut state = model.initial_state(&mut workspace, &swaying(1)).unwrap();
        for step in 1..STEPS {
            let (count, result) =
                allocations(|| model.step(&mut workspace, &mut state, &swaying(step), &Inputs::ZERO, 1e-3));
            result.unwrap();
            assert!(
                step <= WARM_UP || count == 0,
                "{wheel:?}, {wheel_heating:?}, all laws {laws}, step {step}: {count} allocations"
            );
        }
    }
}

/// A wheelset that hunts from flange to flange under a changing load, is lifted and stands, on profiles.
fn hunting(step: u32) -> Inputs {
    let phase = std::f64::consts::TAU * f64::from(step) / 250.0;
    Inputs {
        lateral_displacement: 7e-3 * phase.sin(),
        lateral_speed: 7e-3 * phase.cos() * std::f64::consts::TAU / 0.25,
        yaw_angle: 5e-3 * phase.cos(),
        roll_angle: 1e-3 * phase.sin(),
        ..inputs(step)
    }
}

#[test]
fn a_step_on_profiles_allocates_nothing() {
    for laws in [false, true] {
        let parameters = Parameters {
            contact_model: ContactModel::Profiles,
            slip_source: SlipSource::VehicleSpeed,
            wheel_heating: WheelHeating::On,
            patch_nodes: 14,
            patch_strips: 9,
            depth_nodes: 17,
            wheel_profile_wear: if laws { ProfileWear::On } else { ProfileWear::Off },
            rail_profile_wear: if laws { ProfileWear::On } else { ProfileWear::Off },
            wheel_wear_coefficient: 1e-12,
            ..Parameters::default()
        };
        let model = Model::new(if laws { with_all_laws(parameters) } else { parameters }).unwrap();
        let mut workspace = model.workspace();
        let mut state = model.initial_state(&mut workspace, &hunting(1)).unwrap();
        for step in 1..STEPS {
            let (count, result) =
                allocations(|| model.step(&mut workspace, &mut state, &hunting(step), &Inputs::ZERO, 1e-3));
            result.unwrap();
            assert!(
                step <= WARM_UP || count == 0,
                "all laws {laws}, step {step}: {count} allocations"
            );
        }
    }
}

#[test]
fn the_allocator_counts() {
    let before = HELD.get();
    let (count, held) = allocations(|| std::hint::black_box(vec![0_u8; 100]));
    assert_eq!((count, HELD.get() - before), (1, 100));
    drop(held);
    assert_eq!(HELD.get(), before);
}

/// Model, scratch and state of one instance at default settings hold at most 16 MiB, of a line and a patch with a rigid and an elastic wheel;
/// of profiles, which have operators for windows of all sizes and four windows, at most 112 MiB.
#[test]
fn an_instance_holds_at_most_so_much() {
    for (contact_model, wheel) in ContactModel::ALL
        .iter()
        .flat_map(|model| Wheel::ALL.iter().map(|wheel| (*model, *wheel)))
    {
        let before = HELD.get();
        let (slip_source, most) = match contact_model {
            ContactModel::Line | ContactModel::Patch => (SlipSource::Creepage, 16 << 20),
            ContactModel::Profiles => (SlipSource::VehicleSpeed, 112 << 20),
        };
        let parameters = Parameters {
            contact_model,
            slip_source,
            wheel,
            ..Parameters::default()
        };
        let model = Model::new(parameters).unwrap();
        let mut workspace = model.workspace();
        let state = model.initial_state(&mut workspace, &Inputs::default()).unwrap();
        let held = HELD.get() - before;
        drop((model, workspace, state));
        let left = HELD.get() - before;
        // Not before: the text itself is held until the test ends.
        println!(
            "{contact_model:?}, {wheel:?}: {:.2} MiB",
            held as f64 / f64::from(1 << 20)
        );
        assert!((1 << 18..=most).contains(&held), "{held} bytes");
        assert_eq!(left, 0, "bytes left behind");
    }
}

/// Inputs that change in a step through the interface.
const MOVED: [&str; 6] = [
    "wheel_speed",
    "normal_load",
    "vehicle_speed",
    "friction_scale",
    "lateral_speed",
    "spin_rate",
];

/// Steps that a standard's functions take, given the time and the values of [`MOVED`]; they return the statuses.
fn drive(inputs: fn(u32) -> Inputs, mut take: impl FnMut(f64, &[f64; 6]) -> [i32; 4]) {
    for step in 0..STEPS {
        let given = inputs(step + 1);
        let values = [
            given.wheel_speed,
            given.normal_load,
            given.vehicle_speed,
            given.friction_scale,
            given.lateral_speed,
            given.spin_rate,
        ];
        let (count, statuses) = allocations(|| take(f64::from(step) * 1e-3, &values));
        assert_eq!(statuses, [0; 4], "step {step}");
        assert!(step < WARM_UP || count == 0, "step {step}: {count} allocations");
    }
}

#[test]
fn a_step_through_the_interface_allocates_nothing() {
    for through in [through_fmi2, through_fmi3] {
        through(&[], inputs);
        through(&[("patch_nodes", 14), ("patch_strips", 7)], swaying);
    }
}

/// By vehicle speed; of a patch where it is given lengths.
fn through_fmi2(lengths: &[(&str, u64)], inputs: fn(u32) -> Inputs) {
    use wheelrail::fmi2::functions::*;
    let table = wheelrail::fmi2::variables::variables();
    let reference = |name: &str| table.iter().find(|row| row.name == name).unwrap().reference;
    let guid = CString::new(wheelrail::fmi2::GUID).unwrap();
    let callbacks = CallbackFunctions {
        logger: None,
        allocate_memory: None,
        free_memory: None,
        step_finished: None,
        component_environment: null_mut(),
    };
    let (references, output, load) = (
        MOVED.map(reference),
        reference("traction_force"),
        reference("normal_load"),
    );
    // SAFETY: valid pointers, a live instance, as many values as references.
    unsafe {
        let component = fmi2Instantiate(c"wheel".as_ptr(), 1, guid.as_ptr(), null(), &callbacks, 0, 0);
        assert!(!component.is_null());
        let ok = |status: fmi2::Status| assert_eq!(status, fmi2::Status::OK);
        let contact_model = 1 + i32::from(!lengths.is_empty());
        for (name, value) in [("slip_source", 2), ("contact_model", contact_model)] {
            ok(fmi2SetInteger(component, &reference(name), 1, &value));
        }
        for (name, value) in lengths {
            ok(fmi2SetInteger(component, &reference(name), 1, &(*value as i32)));
        }
        ok(fmi2SetupExperiment(component, 0, 0.0, 0.0, 0, 0.0));
        ok(fmi2EnterInitializationMode(component));
        ok(fmi2ExitInitializationMode(component));
        let mut value = 0.0;
        drive(inputs, |time, values| {
            let statuses = [
                fmi2SetReal(component, references.as_ptr(), values.len(), values.as_ptr()),
                fmi2SetRealInputDerivatives(component, &load, 1, &1, &10.0),
                fmi2DoStep(component, time, 1e-3, 1),
                fmi2GetReal(component, &output, 1, &mut value),
            ];
            statuses.map(|status| status.0)
        });
        fmi2FreeInstance(component);
    }
}

/// The same by FMI 3.0.
fn through_fmi3(lengths: &[(&str, u64)], inputs: fn(u32) -> Inputs) {
    use wheelrail::fmi3::functions::*;
    let table: Vec<_> = wheelrail::fmi3::references::table().collect();
    let reference = |name: &str| table.iter().find(|(_, row)| row.name == name).unwrap().0;
    let token = CString::new(wheelrail::fmi3::INSTANTIATION_TOKEN).unwrap();
    let (references, output) = (MOVED.map(reference), reference("traction_force"));
    let iterations = reference("solver.iterations");
    // SAFETY: valid pointers, a live instance, as many values as references.
    unsafe {
        let (name, token, none) = (c"wheel".as_ptr(), token.as_ptr(), null());
        let instance = fmi3InstantiateCoSimulation(name, token, none, 0, 0, 0, 1, null(), 0, null_mut(), None, None);
        assert!(!instance.is_null());
        let ok = |status: fmi3::Status| assert_eq!(status, fmi3::Status::OK);
        ok(fmi3EnterConfigurationMode(instance));
        for (name, value) in lengths {
            ok(fmi3SetUInt64(instance, &reference(name), 1, value, 1));
        }
        ok(fmi3ExitConfigurationMode(instance));
        let contact_model = 1 + i64::from(!lengths.is_empty());
        for (name, value) in [("slip_source", 2), ("contact_model", contact_model)] {
            ok(fmi3SetInt64(instance, &reference(name), 1, &value, 1));
        }
        ok(fmi3EnterInitializationMode(instance, 0, 0.0, 0.0, 0, 0.0));
        ok(fmi3ExitInitializationMode(instance));
        let (mut value, mut count, mut end) = (0.0, 0, 0.0);
        drive(inputs, |time, values| {
            let (n, [mut event, mut terminate, mut early]) = (values.len(), [0; 3]);
            let statuses = [
                fmi3SetFloat64(instance, references.as_ptr(), n, values.as_ptr(), n),
                fmi3DoStep(
                    instance,
                    time,
                    1e-3,
                    1,
                    &mut event,
                    &mut terminate,
                    &mut early,
                    &mut end,
                ),
                fmi3GetFloat64(instance, &output, 1, &mut value, 1),
                fmi3GetInt32(instance, &iterations, 1, &mut count, 1),
            ];
            statuses.map(|status| status.0)
        });
        fmi3FreeInstance(instance);
    }
}
