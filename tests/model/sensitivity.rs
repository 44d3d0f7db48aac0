//! The output sensitivities are the derivatives of a step: compared with central differences of the step itself, rolled
//! back to the same state, over operating points in stick, partial slip and sliding.

use proptest::prelude::*;
use wheelrail::Error;
use wheelrail::parameters::{ContactModel, FrictionLaw, Parameters, SlipSource, Wheel, WheelHeating};
use wheelrail::settings::Settings;
use wheelrail::signals::{INPUTS, Inputs, OUTPUTS, OutputKind, OutputSignal, Outputs};
use wheelrail::wheel_rail::{Model, State, Workspace};

/// Relative change of the inputs in the step that is differentiated. Without it the operator split would rest after two
/// iterations, and the difference quotient miss the derivative by the square of the contraction, up to 1e-3 whatever its step.
const MOVE: f64 = 0.02;
/// The same for load and temperatures: what comes in changes the tractions little, so it takes a larger move until the
/// split rests at the fourth iteration (measured: 3e-4 off at the third, 2e-7 at the fourth).
const LARGE_MOVE: f64 = -0.1;
const LONG: f64 = 0.05;
/// Derivatives that are compared at least, of the 232 and 348 that there are: the rest crosses a corner. Over 30 seeds of the property tests the
/// fewest were 87 and 145.
pub const LEAST_OF_A_LINE: usize = 64;
pub const LEAST_OF_A_PATCH: usize = 128;
/// Share of Coulomb's bound above which a node slides: 1 but for what the solvers leave.
const SLIDES: f64 = 1.0 - 1e-9;

fn settled(model: &Model, workspace: &mut Workspace, inputs: &Inputs, step: f64) -> State {
    try_settle(model, workspace, inputs, step).unwrap()
}

fn try_settle(model: &Model, workspace: &mut Workspace, inputs: &Inputs, step: f64) -> Result<State, Error> {
    let mut state = model.initial_state(workspace, inputs)?;
    for _ in 0..20 {
        let stepped = model.step(workspace, &mut state, inputs, &Inputs::ZERO, step);
        stepped.map_err(|interrupted| interrupted.error)?;
    }
    Ok(state)
}

/// What changes the contact appreciably.
fn nominal(model: &Model, input: usize) -> f64 {
    match INPUTS[input].name {
        "creepage" => 1e-3,
        "wheel_speed" | "vehicle_speed" if model.parameters().slip_source == SlipSource::VehicleSpeed => 1e-2,
        _ => INPUTS[input].nominal,
    }
}

/// Size of an output in a step, that deviations are measured by. A total is judged by what the step adds to it: of its nominal value, that of a
/// whole run, a step is so small a part that a corner of its rate would not show.
fn size(output: &OutputSignal, before: &State, after: &State) -> f64 {
    let value = (output.get)(&after.outputs);
    match output.kind {
        OutputKind::Total => (value - (output.get)(&before.outputs)).abs(),
        OutputKind::Instantaneous | OutputKind::Counted => output.nominal.max(value.abs()),
    }
}

/// Central difference of all outputs with respect to one input over a step from `state`, and whether the outputs are
/// smooth between the two ends: no node joined or left the contact and no corner of the friction law was crossed.
fn difference(
    model: &Model,
    workspace: &mut Workspace,
    state: &State,
    inputs: &Inputs,
    (input, step): (usize, f64),
) -> Result<(Vec<f64>, Vec<bool>), Error> {
    let (signal, nominal) = (&INPUTS[input], nominal(model, input));
    let mut run = |change: f64| {
        let mut moved = *inputs;
        (signal.set)(&mut moved, (signal.get)(inputs) + change);
        let mut state = state.clone();
        let stepped = model.step(workspace, &mut state, &moved, &Inputs::ZERO, step);
        stepped.map(|()| state).map_err(|interrupted| interrupted.error)
    };
    let share = match model.parameters().contact_model {
        ContactModel::Line => 4e-4,
        // Many more cells than nodes are close to joining or leaving the contact, or to sliding.
        ContactModel::Patch | ContactModel::Profiles => 1e-4,
    };
    let h = share * nominal;
    let (here, ahead, behind) = (run(0.0)?, run(h)?, run(-h)?);
    let (further_ahead, further_behind) = (run(2.0 * h)?, run(-2.0 * h)?);
    // Several nodes that begin to slide one after the other may hide their corners from the differences.
    let sets = |state: &State| -> Vec<(bool, bool)> {
        let nodes = model.contact_nodes(state);
        nodes
            .iter()
            .map(|node| (node.pressure > 0.0, node.utilisation.abs() > SLIDES))
            .collect()
    };
    let smooth_set = [&ahead, &behind, &further_ahead, &further_behind]
        .iter()
        .all(|state| sets(&here) == sets(state));
    let mut smooth = Vec::new();
    let mut derivative = Vec::new();
    for output in OUTPUTS {
        let (c, a, b) = (
            (output.get)(&here.outputs),
            (output.get)(&ahead.outputs),
            (output.get)(&behind.outputs),
        );
        let (forward, backward) = (a - c, c - b);
        let (further_ahead, further_behind) = (
            (output.get)(&further_ahead.outputs),
            (output.get)(&further_behind.outputs),
        );
        // A corner shows in the first or second differences over one and two steps, wherever it lies between.
        let further = further_ahead - further_behind;
        let further_curvature = further_ahead - 2.0 * c + further_behind;
        let allowed = 3e-5 * further.abs() + 1e-5 * share * size(output, state, &here);
        smooth.push(
            smooth_set
                && (further - 2.0 * (forward + backward)).abs() <= allowed
                && (further_curvature - 4.0 * (forward - backward)).abs() <= allowed,
        );
        // Richardson's extrapolation takes the curvature out.
        derivative.push((8.0 * (a - b) - further) / (12.0 * h));
    }
    Ok((derivative, smooth))
}

/// Compares all derivatives of a step of `step` `s` where the outputs are smooth. Returns their number; an error is that of a step.
pub fn check(parameters: Parameters, inputs: Inputs, step: f64) -> Result<usize, Error> {
    // Tighter than the default: a split that rests early would leave its own error in the difference quotient.
    let mut settings = Settings::default();
    // A step that is divided has the derivatives of its last part only.
    settings.step.retries = 0;
    settings.split.tolerance = 1e-11;
    settings.split.shear_tolerance = 1e-11;
    settings.patch.split_tolerance = 1e-11;
    settings.patch.shear_tolerance = 1e-11;
    settings.patch.least_tolerance = 1e-11;
    settings.patch.sensitivity_tolerance = 1e-9;
    // Else the mechanics of the last iteration may take what the one before left, 1e-5 of the pressure off, and nothing changes.
    settings.patch.first_mechanics_tolerance = 1e-10;
    let model = Model::with_settings(parameters, settings).unwrap();
    let mut workspace = model.workspace();
    let mut moved = inputs;
    for signal in INPUTS {
        let share = match signal.name {
            "normal_load" | "ambient_temperature" | "incoming_temperature" => LARGE_MOVE,
            _ => MOVE,
        };
        (signal.set)(&mut moved, (signal.get)(&inputs) * (1.0 + share));
    }
    let before = try_settle(&model, &mut workspace, &moved, step)?;
    let mut state = before.clone();
    model
        .step(&mut workspace, &mut state, &inputs, &Inputs::ZERO, step)
        .map_err(|interrupted| interrupted.error)?;
    assert_eq!(state.duration, step, "the step must not be divided");
    let sensitivities = model
        .output_sensitivities(&mut workspace, &state, 0..INPUTS.len())
        .unwrap();
    let mut compared = 0;
    for (row, input) in INPUTS.iter().enumerate() {
        // No difference can be taken of what a contact model refuses.
        if !input.is_taken_by(model.parameters().contact_model) {
            assert_eq!(sensitivities[row], Outputs::default(), "{}", input.name);
            continue;
        }
        // At V = 0 the derivative is that towards V > 0, within a speed at which the slowest mode of the heat decays over a cell.
        if input.name == "vehicle_speed" && inputs.vehicle_speed == 0.0 {
            continue;
        }
        let (differences, smooth) = difference(&model, &mut workspace, &before, &inputs, (row, step))?;
        for (index, output) in OUTPUTS.iter().enumerate() {
            let exact = (output.get)(&sensitivities[row]);
            let scale = size(output, &before, &state) / nominal(&model, row);
            if !smooth[index] {
                continue;
            }
            // 1e-4 of the derivative; below, the split's tolerance of 1e-9 over the relative step of a difference.
            let tolerance = 1e-4 * exact.abs() + 4e-6 * scale;
            compared += 1;
            let place = if output.kind == OutputKind::Counted {
                "src/signals.rs has the output as Counted, and it is not"
            } else {
                "A tangent stands beside its primal: where the input is used, or in tangent.rs of src/contact/line or \
                 src/contact/patch, which puts the tangents together"
            };
            assert!(
                (exact - differences[index]).abs() <= tolerance,
                "d {} / d {}: {exact} against {} by differences of the step, at {inputs:?}. {place}",
                output.name,
                input.name,
                differences[index]
            );
        }
    }
    Ok(compared)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 12, ..ProptestConfig::default() })]
    #[test]
    fn sensitivities_are_the_derivatives_of_a_step(
        creepage in prop_oneof![Just(0.0), -0.003..0.003, 0.005..0.2, -0.2..-0.005],
        speed in 2.0..40.0,
        load in 20e3..95e3,
        scale in 0.3..1.2,
        vehicle in any::<bool>(),
        reverse in any::<bool>(),
        wheel in prop_oneof![Just(Wheel::Rigid), Just(Wheel::Elastic)],
        // Softer than the rail, so that the pair is coupled, or the rail's.
        shear_modulus in prop_oneof![Just(4e10), Just(8.2e10)],
        heating in prop_oneof![Just(WheelHeating::Off), Just(WheelHeating::On)],
        incoming in 280.0..330.0,
        long in any::<bool>(),
        law in prop_oneof![Just(FrictionLaw::Constant), Just(FrictionLaw::PiecewiseLinear), Just(FrictionLaw::FlowStress)],
    ) {
        let parameters = Parameters {
            slip_source: if vehicle { SlipSource::VehicleSpeed } else { SlipSource::Creepage },
            friction_law: law,
            wheel,
            // Like bodies do not slip at creepage 0, where |s| has a corner.
            wheel_shear_modulus: if creepage == 0.0 { 4e10 } else { shear_modulus },
            wheel_heating: heating,
            wheel_wear_coefficient: 1e-12,
            // A thin ring in good contact with the rail.
            rim_depth: 1e-3,
            rim_width: 5e-3,
            contact_thermal_resistance: 200.0,
            strip_half_length: 0.3,
            ..Parameters::default()
        };
        let direction = if reverse { -1.0 } else { 1.0 };
        let inputs = Inputs {
            wheel_speed: direction * speed * (1.0 + creepage) / parameters.wheel_radius,
            vehicle_speed: direction * speed,
            creepage,
            normal_load: load,
            friction_scale: scale,
            incoming_temperature: incoming,
            incoming_wear_depth: 2e-7,
            ..Inputs::default()
        };
        // In a long step what comes in reaches the contact and the other end.
        let step = if long { LONG } else { 1e-3 };
        let compared = check(parameters, inputs, step).unwrap();
        prop_assert!(compared >= LEAST_OF_A_LINE, "{compared}");
    }
}

/// [`check`] where the step rests at its settings: how many derivatives were compared. Settings this tight are no promise of the solvers; what is
/// promised is that the same steps succeed at those that everybody has, and that is asserted where they fail at the tight ones. Not of a line on a
/// layer, which may refuse a step: docs/limits.md says where.
pub fn check_where_it_rests(parameters: Parameters, inputs: Inputs, step: f64) -> Option<usize> {
    match check(parameters.clone(), inputs, step) {
        Ok(compared) => Some(compared),
        Err(
            Error::TangentialNotConverged { .. }
            | Error::SplitNotConverged { .. }
            | Error::MechanicsNotConverged { .. },
        ) => {
            let on_a_layer = parameters.layer_compliance > 0.0 || parameters.layer_yield_stress > 0.0;
            if parameters.contact_model == ContactModel::Line && on_a_layer {
                return None;
            }
            let model = Model::new(parameters).unwrap();
            settled(&model, &mut model.workspace(), &inputs, step);
            None
        }
        Err(error) => panic!("{error}, at {inputs:?}"),
    }
}

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
    let before = settled(&model, &mut workspace, &rolling(free), 1e-3);
    let mut step = |wheel_speed: f64| {
        let mut state = before.clone();
        model
            .step(&mut workspace, &mut state, &rolling(wheel_speed), &Inputs::ZERO, 1e-3)
            .unwrap();
        state
    };
    // 1 − (1 − ξ/ξ_s)² with ξ_s = μ a/r₀ = 0.0054: over a creepage of 1e-6 the curve is 1e-4 less steep than at 0.
    let change = 1e-6 * free;
    let (behind, here, ahead) = (step(free - change), step(free), step(free + change));
    let row = INPUTS.iter().position(|input| input.name == "wheel_speed").unwrap();
    let slopes = model.output_sensitivities(&mut workspace, &here, row..row + 1).unwrap()[0];
    for name in ["traction_force", "traction_coefficient", "friction_torque"] {
        let output = OUTPUTS.iter().find(|output| output.name == name).unwrap();
        let difference = ((output.get)(&ahead.outputs) - (output.get)(&behind.outputs)) / (2.0 * change);
        let slope = (output.get)(&slopes);
        assert!((slope / difference - 1.0).abs() < 1e-3, "{name}: {slope} {difference}");
    }
    // d((ω r₀ − V)/V)/dω.
    let creepage = slopes.slip_creepage / (radius / speed);
    assert!((creepage - 1.0).abs() < 1e-6, "{creepage}");
}

/// A small patch that heats, wears and swells, under a thin rim in good contact with it.
pub fn patch(slip_source: SlipSource, wheel: Wheel) -> Parameters {
    Parameters {
        contact_model: ContactModel::Patch,
        slip_source,
        wheel,
        patch_nodes: 16,
        patch_strips: 9,
        depth_nodes: 17,
        wheel_heating: WheelHeating::On,
        wheel_wear_coefficient: 1e-12,
        rim_depth: 1e-3,
        rim_width: 5e-3,
        contact_thermal_resistance: 200.0,
        strip_half_length: 0.3,
        ..Parameters::default()
    }
}

/// A line under a warm wheel that is rigid or softer than the rail, so that pressure and shear are coupled, on a short piece of rail.
pub fn line(slip_source: SlipSource, wheel: Wheel) -> Parameters {
    Parameters {
        slip_source,
        wheel,
        wheel_shear_modulus: 6e10,
        wheel_heating: WheelHeating::On,
        rim_depth: 1e-3,
        rim_width: 5e-3,
        contact_thermal_resistance: 200.0,
        strip_half_length: 0.3,
        ..Parameters::default()
    }
}

/// Rolling at V with longitudinal creepage alone, as a line takes it.
pub fn rolling_straight(speed: f64, creepage: f64) -> Inputs {
    Inputs {
        lateral_creepage: 0.0,
        spin_creepage: 0.0,
        lateral_speed: 0.0,
        spin_rate: 0.0,
        ..rolling(speed, [creepage, 0.0, 0.0])
    }
}

/// Rolling at V with all three creepages, by the creepages and by the speeds.
pub fn rolling(speed: f64, [creepage, lateral, spin]: [f64; 3]) -> Inputs {
    Inputs {
        wheel_speed: speed * (1.0 + creepage) / Parameters::default().wheel_radius,
        vehicle_speed: speed,
        creepage,
        lateral_creepage: lateral,
        spin_creepage: spin,
        lateral_speed: lateral * speed,
        spin_rate: spin * speed,
        incoming_temperature: 310.0,
        incoming_wear_depth: 2e-7,
        ..Inputs::default()
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 12, ..ProptestConfig::default() })]
    #[test]
    fn sensitivities_of_a_patch_are_the_derivatives_of_a_step(
        creepage in prop_oneof![-0.003..-0.0003, 0.0003..0.003, 0.005..0.05],
        lateral in -0.002..0.002,
        spin in -0.8..0.8,
        speed in 2.0..40.0,
        load in 20e3..95e3,
        vehicle in any::<bool>(),
        reverse in any::<bool>(),
        wheel in prop_oneof![Just(Wheel::Rigid), Just(Wheel::Elastic)],
        heating in prop_oneof![Just(WheelHeating::Off), Just(WheelHeating::On)],
        long in any::<bool>(),
        regularisation in prop_oneof![3 => Just(0.0), 1 => Just(1e-3)],
        law in prop_oneof![Just(FrictionLaw::Constant), Just(FrictionLaw::PiecewiseLinear), Just(FrictionLaw::FlowStress)],
    ) {
        let source = if vehicle { SlipSource::VehicleSpeed } else { SlipSource::Creepage };
        let parameters = Parameters {
            friction_law: law,
            wheel_heating: heating,
            slip_regularisation: regularisation,
            ..patch(source, wheel)
        };
        let direction = if reverse { -1.0 } else { 1.0 };
        let inputs = Inputs { normal_load: load, ..rolling(direction * speed, [creepage, lateral, spin]) };
        let step = if long { LONG } else { 1e-3 };
        if let Some(compared) = check_where_it_rests(parameters, inputs, step) {
            prop_assert!(compared >= LEAST_OF_A_PATCH, "{compared}");
        }
    }
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

/// A lifted wheel leaves a rail that cools and moves on.
#[test]
fn sensitivities_of_a_lifted_patch() {
    let parameters = patch(SlipSource::Creepage, Wheel::Elastic);
    let model = Model::new(parameters).unwrap();
    let mut workspace = model.workspace();
    let down = rolling(15.0, [4e-3, 1e-3, 0.3]);
    let mut before = settled(&model, &mut workspace, &down, 1e-3);
    let lifted = Inputs {
        normal_load: 0.0,
        ..down
    };
    model
        .step(&mut workspace, &mut before, &lifted, &Inputs::ZERO, 1e-4)
        .unwrap();
    let run = |workspace: &mut Workspace, inputs: &Inputs| {
        let mut state = before.clone();
        model.step(workspace, &mut state, inputs, &Inputs::ZERO, 0.01).unwrap();
        state
    };
    let state = run(&mut workspace, &lifted);
    let slopes = model
        .output_sensitivities(&mut workspace, &state, 0..INPUTS.len())
        .unwrap();
    for (row, input) in INPUTS
        .iter()
        .enumerate()
        .filter(|(_, input)| input.name != "normal_load" && input.is_taken_by(model.parameters().contact_model))
    {
        let h = 1e-4 * nominal(&model, row);
        let [ahead, behind] = [h, -h].map(|change| {
            let mut moved = lifted;
            (input.set)(&mut moved, (input.get)(&lifted) + change);
            run(&mut workspace, &moved)
        });
        for output in OUTPUTS {
            let difference = ((output.get)(&ahead.outputs) - (output.get)(&behind.outputs)) / (2.0 * h);
            let exact = (output.get)(&slopes[row]);
            let scale = output.nominal.max((output.get)(&state.outputs).abs()) / nominal(&model, row);
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
            let h = 1e-5 * nominal(&model, row);
            let [ahead, behind] = [h, -h].map(|change| {
                let mut moved = inputs;
                (input.set)(&mut moved, (input.get)(&inputs) + change);
                run(&moved)
            });
            for output in OUTPUTS.iter().filter(|output| forces.contains(&output.name)) {
                let difference = ((output.get)(&ahead.outputs) - (output.get)(&behind.outputs)) / (2.0 * h);
                differences.push((row, output, difference));
            }
        }
        let slopes = model
            .output_sensitivities(&mut workspace, &state, 0..INPUTS.len())
            .unwrap();
        for (row, output, difference) in differences {
            let exact = (output.get)(&slopes[row]);
            let scale = output.nominal.max((output.get)(&state.outputs).abs()) / nominal(&model, row);
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
