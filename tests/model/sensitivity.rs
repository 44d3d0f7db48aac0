//! The output sensitivities are the derivatives of a step, in named cases: in stick, partial slip and sliding, at rest, lifted, and of the first
//! state. Random ones are in [`super::random_sensitivity`].

use crate::derivatives::{check, nominal};
use crate::setups::{patch, rolling, settle, slope, step_from};
use wheelrail::parameters::{ContactModel, Parameters, SlipSource, Wheel};
use wheelrail::settings::Settings;
use wheelrail::signals::{INPUTS, Inputs, OUTPUTS};
use wheelrail::wheel_rail::{Model, Workspace};

/// Where a wheel of default parameters starts: at creepage 0 like bodies neither slip nor shear nor warm, and the outputs that do
/// not hang on |s| are smooth all the same. Slopes by differences of a step, and that of the creepage in closed form.
#[test]
fn slopes_at_creepage_0_are_those_of_a_step() {
    let parameters = Parameters {
        slip_source: SlipSource::VehicleSpeed,
        ..Parameters::default()
    };
    let radius = parameters.wheel_radius;
    let model = Model::new(parameters).unwrap();
    let mut workspace = model.workspace();
    let speed = 10.0;
    let rolling = |wheel_speed| Inputs {
        wheel_speed,
        vehicle_speed: speed,
        ..Inputs::default()
    };
    // Not 0 but round-off, as a master computes it.
    let free = speed / radius * (1.0 + 1e-15);
    let before = settle(&model, &mut workspace, &rolling(free), 1e-3).unwrap();
    let mut step = |wheel_speed| step_from(&model, &mut workspace, &before, &rolling(wheel_speed), 1e-3).unwrap();
    // 1 − (1 − ξ/ξ_s)² with ξ_s = μ a/r₀ = 0.0054: over a creepage of 1e-6 the curve is 1e-4 less steep than at 0.
    let change = 1e-6 * free;
    let (behind, here, ahead) = (step(free - change), step(free), step(free + change));
    let row = INPUTS.iter().position(|input| input.name == "wheel_speed").unwrap();
    let slopes = model.output_sensitivities(&mut workspace, &here, row..row + 1).unwrap()[0];
    for name in ["traction_force", "traction_coefficient", "friction_torque"] {
        let output = OUTPUTS.iter().find(|output| output.name == name).unwrap();
        let difference = slope(output, [&ahead, &behind], 2.0 * change);
        let slope = (output.get)(&slopes);
        assert!((slope / difference - 1.0).abs() < 1e-3, "{name}: {slope} {difference}");
    }
    // d((ω r₀ − V)/V)/dω.
    let creepage = slopes.slip_creepage / (radius / speed);
    assert!((creepage - 1.0).abs() < 1e-6, "{creepage}");
}

/// The scenarios of every effect: creepages and speeds, and the rigid wheel, whose pressure and shear are coupled.
#[test]
fn sensitivities_of_a_patch_where_all_effects_act() {
    for (source, wheel) in [
        (SlipSource::Creepage, Wheel::Elastic),
        (SlipSource::VehicleSpeed, Wheel::Elastic),
        (SlipSource::VehicleSpeed, Wheel::Rigid),
    ] {
        let compared = check(patch(source, wheel), rolling(15.0, [4e-3, 1e-3, 0.3]), 1e-3).unwrap();
        assert!(compared >= 300, "{source:?} {wheel:?}: {compared}");
    }
}

/// At standstill all slip is the wheel's own, and what the surfaces move by within the step.
#[test]
fn sensitivities_of_a_patch_at_standstill() {
    for [lateral, spin] in [[0.0, 0.0], [0.02, 0.0], [0.01, 2.0]] {
        let inputs = Inputs {
            wheel_speed: 0.05 / Parameters::default().wheel_radius,
            lateral_speed: lateral,
            spin_rate: spin,
            ..rolling(0.0, [0.0; 3])
        };
        let parameters = patch(SlipSource::VehicleSpeed, Wheel::Elastic);
        let compared = check(parameters, inputs, 1e-3).unwrap();
        assert!(compared >= 200, "{lateral} {spin}: {compared}");
    }
}

/// About a standstill of a wheel that slides, and heats, slopes by the vehicle's speed are those of a change that can be told from it. The
/// slowest modes of heat pass from rest to motion within nanometres per second: their slope there had made 1.2e7 of 1.1e4 N s/m.
#[test]
fn slopes_by_the_vehicles_speed_about_a_standstill_are_those_of_a_slow_motion() {
    let line = Parameters {
        slip_source: SlipSource::VehicleSpeed,
        ..Parameters::default()
    };
    for parameters in [line, patch(SlipSource::VehicleSpeed, Wheel::Elastic)] {
        let contact = parameters.contact_model;
        let radius = parameters.wheel_radius;
        let model = Model::new(parameters).unwrap();
        let mut workspace = model.workspace();
        let sliding = |vehicle_speed: f64| Inputs {
            wheel_speed: 0.5 / radius,
            vehicle_speed,
            ..Inputs::default()
        };
        let before = settle(&model, &mut workspace, &sliding(0.0), 1e-3).unwrap();
        let mut others = model.workspace();
        let mut step = |speed| step_from(&model, &mut others, &before, &sliding(speed), 1e-3).unwrap();
        let row = INPUTS.iter().position(|input| input.name == "vehicle_speed").unwrap();
        // At a standstill, a mode's source moves by half a cell between rest and motion: a part of a cell over the contact's length. In motion the slope is
        // the derivative, to the tolerance of the steps over h.
        for (speed, h, allowed) in [
            (0.0, 1e-3, 0.03),
            (3e-4, 1e-5, 5e-3),
            (-1e-3, 1e-5, 5e-3),
            (3e-3, 1e-5, 5e-3),
        ] {
            let (behind, here, ahead) = (step(speed - h), step(speed), step(speed + h));
            let slopes = model.output_sensitivities(&mut workspace, &here, row..row + 1).unwrap()[0];
            for name in [
                "traction_force",
                "friction_torque",
                "friction_power",
                "peak_temperature",
            ] {
                let output = OUTPUTS.iter().find(|output| output.name == name).unwrap();
                let difference = slope(output, [&ahead, &behind], 2.0 * h);
                let slope = (output.get)(&slopes);
                assert!(
                    (slope / difference - 1.0).abs() < allowed,
                    "{contact:?} {name} at {speed} m/s: {slope} {difference}"
                );
            }
        }
    }
}

/// A lifted wheel leaves a rail that cools and moves on.
#[test]
fn sensitivities_of_a_lifted_patch() {
    let parameters = patch(SlipSource::Creepage, Wheel::Elastic);
    let model = Model::new(parameters).unwrap();
    let mut workspace = model.workspace();
    let down = rolling(15.0, [4e-3, 1e-3, 0.3]);
    let settled = settle(&model, &mut workspace, &down, 1e-3).unwrap();
    let lifted = Inputs {
        normal_load: 0.0,
        ..down
    };
    let before = step_from(&model, &mut workspace, &settled, &lifted, 1e-4).unwrap();
    let run = |workspace: &mut Workspace, inputs: &Inputs| step_from(&model, workspace, &before, inputs, 0.01).unwrap();
    let state = run(&mut workspace, &lifted);
    let slopes = model
        .output_sensitivities(&mut workspace, &state, 0..INPUTS.len())
        .unwrap();
    for (row, input) in INPUTS
        .iter()
        .enumerate()
        .filter(|(_, input)| input.name != "normal_load" && input.is_taken_by(model.parameters().contact_model))
    {
        let h = 1e-4 * nominal(&model, &lifted, row);
        let [ahead, behind] = [h, -h].map(|change| {
            let mut moved = lifted;
            (input.set)(&mut moved, (input.get)(&lifted) + change);
            run(&mut workspace, &moved)
        });
        for output in OUTPUTS {
            let difference = slope(output, [&ahead, &behind], 2.0 * h);
            let exact = (output.get)(&slopes[row]);
            let scale = output.nominal.max((output.get)(&state.outputs).abs()) / nominal(&model, &lifted, row);
            // Truncation h², round-off over h.
            let tolerance = 1e-4 * exact.abs() + 1e-8 * scale;
            assert!(
                (exact - difference).abs() <= tolerance,
                "d {} / d {}: {exact} {difference}",
                output.name,
                input.name
            );
        }
    }
}

/// After initialisation no time has passed: derivatives of the mechanics at given temperature and wear, those of an initial state.
#[test]
fn sensitivities_of_an_initial_patch() {
    for (source, wheel, speed) in [
        (SlipSource::Creepage, Wheel::Elastic, 15.0),
        (SlipSource::VehicleSpeed, Wheel::Rigid, -15.0),
        (SlipSource::VehicleSpeed, Wheel::Elastic, 0.0),
    ] {
        let mut settings = Settings::default();
        settings.patch.tolerance = 1e-11;
        settings.patch.least_tolerance = 1e-12;
        let model = Model::with_settings(patch(source, wheel), settings).unwrap();
        let mut workspace = model.workspace();
        let mut inputs = rolling(speed, [4e-3, 1e-3, 0.3]);
        if speed == 0.0 {
            (inputs.wheel_speed, inputs.lateral_speed, inputs.spin_rate) = (0.1, 0.01, 1.0);
        }
        let mut run = |inputs: &Inputs| model.initial_state(&mut workspace, inputs).unwrap();
        let state = run(&inputs);
        let forces = [
            "traction_force",
            "lateral_force",
            "spin_moment",
            "penetration",
            "peak_pressure",
        ];
        let mut differences = Vec::new();
        for (row, input) in INPUTS.iter().enumerate() {
            // At standstill |V| has a corner.
            let corner = speed == 0.0 && input.name == "vehicle_speed";
            if corner || !input.is_taken_by(ContactModel::Patch) {
                continue;
            }
            let h = 1e-5 * nominal(&model, &inputs, row);
            let [ahead, behind] = [h, -h].map(|change| {
                let mut moved = inputs;
                (input.set)(&mut moved, (input.get)(&inputs) + change);
                run(&moved)
            });
            for output in OUTPUTS.iter().filter(|output| forces.contains(&output.name)) {
                let difference = slope(output, [&ahead, &behind], 2.0 * h);
                differences.push((row, output, difference));
            }
        }
        let slopes = model
            .output_sensitivities(&mut workspace, &state, 0..INPUTS.len())
            .unwrap();
        for (row, output, difference) in differences {
            let exact = (output.get)(&slopes[row]);
            let scale = output.nominal.max((output.get)(&state.outputs).abs()) / nominal(&model, &inputs, row);
            // Truncation h², and the solvers' tolerance of 1e-11 over the relative step.
            let tolerance = 1e-4 * exact.abs() + 4e-6 * scale;
            assert!(
                (exact - difference).abs() <= tolerance,
                "{speed}: d {} / d {}: {exact} {difference}",
                output.name,
                INPUTS[row].name
            );
        }
    }
}
