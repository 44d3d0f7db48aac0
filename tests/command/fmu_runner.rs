//! The component in the Rust importer `fmu-runner` ("A high level Rust wrapper for executing FMU's that follow the FMI 2.0
//! standard"), which unpacks the archive, parses the description and loads the library by itself.

use fmu_runner::{Fmu, FmuInstance, FmuLibrary, fmi2Type};
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::process::Command;
use wheelrail::parameters::{ContactModel, Parameters};
use wheelrail::signals::{INPUTS, Inputs, OUTPUTS};
use wheelrail::simulation::Simulation as Run;

/// Exact in binary, so that no rounding of the time comes in.
const STEP: f64 = 1.0 / 512.0;
const STEPS: u32 = 64;

/// The archive with the library that `cargo test` has built beside the test.
fn archive() -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("fmu_runner.fmu");
    let output = Command::new(env!("CARGO_BIN_EXE_wheelrail"))
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .arg("pack")
        .arg("--library")
        .arg(super::library_path())
        .arg("--output")
        .arg(&path)
        .output()
        .expect("the command line runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    path
}

fn set(instance: &FmuInstance<&FmuLibrary>, values: &[(&str, f64)]) {
    let variables = instance.lib.variables();
    let values: HashMap<_, _> = values.iter().map(|(name, value)| (&variables[*name], *value)).collect();
    instance.set_reals(&values).expect("set");
}

fn outputs(instance: &FmuInstance<&FmuLibrary>) -> Vec<f64> {
    let variables = instance.lib.variables();
    let signals: Vec<_> = OUTPUTS.iter().map(|row| &variables[row.name]).collect();
    let values = instance.get_reals(&signals).expect("get");
    signals.iter().map(|signal| values[signal]).collect()
}

/// Integer parameters that make a coarse patch.
const PATCH: [(&str, i32); 3] = [("contact_model", 2), ("patch_nodes", 14), ("patch_strips", 7)];

#[test]
fn the_importer_gets_the_results_of_the_native_simulation() {
    let library = Fmu::unpack(archive())
        .expect("unpacked and parsed")
        .load(fmi2Type::fmi2CoSimulation)
        .expect("loaded");
    compare(&library, &[], Parameters::default(), Inputs::default());
    let patch = Parameters {
        contact_model: ContactModel::Patch,
        patch_nodes: 14,
        patch_strips: 7,
        ..Parameters::default()
    };
    let sideways = Inputs {
        lateral_creepage: -0.002,
        spin_creepage: 0.3,
        ..Inputs::default()
    };
    compare(&library, &PATCH, patch, sideways);
}

/// A run of the importer with the given Integer parameters against a native one with the same.
fn compare(library: &FmuLibrary, integers: &[(&str, i32)], parameters: Parameters, inputs: Inputs) {
    let inputs = Inputs {
        wheel_speed: 22.0,
        normal_load: 50e3,
        creepage: 0.01,
        vehicle_speed: 10.0,
        friction_scale: 0.9,
        ambient_temperature: 280.0,
        incoming_temperature: 285.0,
        incoming_wear_depth: 1e-7,
        ..inputs
    };
    let parameters = Parameters {
        friction_cold: 0.4,
        heat_partition: 0.45,
        ..parameters
    };
    let mut native = Run::new(&parameters, &inputs).expect("a model");

    let instance = FmuInstance::instantiate(library, true).expect("an instance");
    let chosen: HashMap<_, _> = integers
        .iter()
        .map(|(name, value)| (&library.variables()[*name], *value))
        .collect();
    instance.set_integers(&chosen).expect("set");
    assert_eq!(instance.get_types_platform(), "default");
    instance.setup_experiment(0.0, Some(1.0), None).expect("set up");
    set(&instance, &[("friction_cold", 0.4), ("heat_partition", 0.45)]);
    let start: Vec<_> = INPUTS.iter().map(|row| (row.name, (row.get)(&inputs))).collect();
    set(&instance, &start);
    instance.enter_initialization_mode().expect("entered");
    instance.exit_initialization_mode().expect("initialized");
    for step in 0..STEPS {
        instance.do_step(f64::from(step) * STEP, STEP, true).expect("a step");
        native.step(&inputs, STEP).expect("a native step");
    }
    for (row, value) in OUTPUTS.iter().zip(outputs(&instance)) {
        let expected = (row.get)(&native.state.outputs);
        assert!(
            (value - expected).abs() <= 1e-12 * expected.abs(),
            "{} = {value}, natively {expected}",
            row.name
        );
    }
    assert!(native.state.outputs.peak_temperature > 290.0, "the rail has warmed up");

    // Back to a saved and to a serialised state: the same bits.
    let time = f64::from(STEPS) * STEP;
    let states = instance.get_set_state_capability().expect("canGetAndSetFMUstate");
    let bytes = instance.serialize_state_capability().expect("canSerializeFMUstate");
    let saved = states.get_state().expect("saved");
    let copy = bytes
        .deserialize_state(&bytes.serialize_state(&saved).expect("serialised"))
        .expect("deserialised");
    instance.do_step(time, STEP, true).expect("a step");
    let expected = outputs(&instance);
    for state in [saved, copy] {
        states.set_state(state).expect("restored");
        instance.do_step(time, STEP, true).expect("a step");
        assert_eq!(outputs(&instance), expected);
    }

    // A value that cannot be, and a call that cannot be.
    let variables = library.variables();
    let negative = HashMap::from([(&variables["normal_load"], -1.0)]);
    let refusal = instance.set_reals(&negative).expect_err("refused");
    assert!(refusal.to_string().contains("fmi2Discard"), "{refusal}");
    let refusal = instance.do_step(0.0, f64::NAN, true).expect_err("refused");
    assert!(refusal.to_string().contains("fmi2Error"), "{refusal}");
}
