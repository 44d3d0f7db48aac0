//! Nothing is declared in vain: every input and every parameter moves an output, and every output leaves 0, in one of a few
//! scenarios that switch everything on. What fails names the file in which something was forgotten.

use wheelrail::parameters::{
    ContactModel, Control, FrictionLaw, INTEGER_PARAMETERS, Parameters, PatchGeometry, ProfileWear, REAL_PARAMETERS,
    Side, SlipSource, TABLE_POINTS, WearLaw, Wheel, WheelHeating,
};
use wheelrail::signals::{INPUTS, Inputs, OUTPUTS, Outputs};
use wheelrail::simulation::Simulation;
use wheelrail::wheel_rail::Model;

/// Parameters, and inputs that are held under them.
type Scenario = (Parameters, Inputs);

/// Rolling with lateral slip and spin by the creepages and by the speeds, on a small patch; and one of given geometry and penetration.
fn patches() -> [Scenario; 3] {
    let creepages = Inputs {
        wheel_speed: 40.0,
        creepage: 2e-3,
        lateral_creepage: 1e-3,
        spin_creepage: 0.3,
        ..Inputs::default()
    };
    let parameters = Parameters {
        contact_model: ContactModel::Patch,
        patch_nodes: 12,
        patch_strips: 7,
        depth_nodes: 11,
        strip_half_length: 0.3,
        austenite_temperature: 300.0,
        ..Parameters::default()
    };
    let speeds = Parameters {
        slip_source: SlipSource::VehicleSpeed,
        ..parameters.clone()
    };
    let motion = creepages.motion(&parameters);
    let driven = Inputs {
        vehicle_speed: motion.rolling_speed,
        lateral_speed: motion.lateral_speed,
        spin_rate: motion.spin_rate,
        ..creepages
    };
    let pressed = Parameters {
        control: Control::Height,
        patch_geometry: PatchGeometry::Inputs,
        normal_damping: 0.5,
        ..parameters.clone()
    };
    let approaching = Inputs {
        contact_penetration: 6e-5,
        contact_penetration_speed: 0.2,
        contact_inclination: 0.1,
        ..creepages
    };
    [(parameters, creepages), (speeds, driven), (pressed, approaching)]
}

/// A wheel on a rail by their profiles, where it touches at the gauge corner and the flange, under a load and at a height, on small windows.
fn profiles() -> [Scenario; 4] {
    let parameters = Parameters {
        contact_model: ContactModel::Profiles,
        slip_source: SlipSource::VehicleSpeed,
        side: Side::Right,
        rail_profile: "UIC60".to_owned(),
        patch_nodes: 12,
        patch_strips: 9,
        depth_nodes: 11,
        strip_half_length: 0.3,
        austenite_temperature: 300.0,
        ..Parameters::default()
    };
    let loaded = Inputs {
        vehicle_speed: 20.0,
        wheel_speed: 20.1 / parameters.wheel_radius,
        lateral_displacement: -5.5e-3,
        yaw_angle: 5e-3,
        roll_angle: -1e-3,
        ..Inputs::default()
    };
    let lowered = Parameters {
        control: Control::Height,
        ..parameters.clone()
    };
    let at_height = Inputs {
        vertical_displacement: -0.12e-3,
        lateral_displacement: -2e-3,
        roll_angle: 0.0,
        ..loaded
    };
    // A wheel that is worn hollow, on a rail that wears.
    let wearing = Parameters {
        wheel_profile_wear: ProfileWear::On,
        rail_profile_wear: ProfileWear::On,
        rail_wear_length: 5.0,
        wheel_wear_coefficient: 1e-12,
        wear_acceleration: 3e4,
        ..parameters.clone()
    };
    let on_tread = Inputs {
        normal_load: 20e3,
        lateral_displacement: 0.0,
        roll_angle: 0.0,
        ..loaded
    };
    // Two contacts, and one on a lubricated flange.
    let both = Inputs {
        normal_load: 20e3,
        lateral_displacement: -5e-3,
        roll_angle: -3.5e-4,
        ..loaded
    };
    let lubricated = Parameters {
        gauge_face_friction_scale: 0.5,
        gauge_face_angle: 0.9,
        gauge_face_blend: 0.25,
        ..parameters.clone()
    };
    let on_flange = Inputs {
        lateral_displacement: -8e-3,
        roll_angle: -8e-3,
        yaw_angle: 0.02,
        ..loaded
    };
    [
        (parameters, both),
        (lowered, at_height),
        (lubricated, on_flange),
        (wearing, on_tread),
    ]
}

/// Sliding under each law of friction, stick under a prescribed penetration and the vehicle's speed, and patches.
fn scenarios() -> Vec<Scenario> {
    let inputs = Inputs {
        wheel_speed: 40.0,
        creepage: 0.02,
        incoming_temperature: 310.0,
        incoming_wear_depth: 1e-7,
        ..Inputs::default()
    };
    let parameters = |friction_law| Parameters {
        friction_law,
        contact_nodes: 21,
        depth_nodes: 11,
        // So short that what comes in leaves in the scenario.
        strip_half_length: 0.3,
        austenite_temperature: 315.0,
        // Points between the temperatures that the contact runs through.
        friction_table_points: TABLE_POINTS,
        friction_table_temperature: std::array::from_fn(|point| 300.0 + 10.0 * point as f64),
        friction_table_coefficient: std::array::from_fn(|point| 0.45 - 0.01 * point as f64),
        wheel: Wheel::Elastic,
        wheel_shear_modulus: 4e10,
        wheel_heating: WheelHeating::On,
        wheel_wear_coefficient: 1e-12,
        ..Parameters::default()
    };
    let mut scenarios: Vec<Scenario> = FrictionLaw::ALL.iter().map(|law| (parameters(*law), inputs)).collect();
    let stick = Parameters {
        control: Control::Penetration,
        slip_source: SlipSource::VehicleSpeed,
        ..parameters(FrictionLaw::PiecewiseLinear)
    };
    let rolling = Inputs {
        vehicle_speed: inputs.wheel_speed * stick.wheel_radius * (1.0 - 1e-4),
        ..inputs
    };
    scenarios.push((stick, rolling));
    scenarios.extend(patches());
    scenarios.extend(profiles());
    // Friction that falls with slip and remembers it, and a layer.
    let falling = Parameters {
        friction_slip_share: 0.5,
        friction_slip_decay: 0.7,
        friction_memory_distance: 3e-6,
        layer_compliance: 1e-13,
        ..parameters(FrictionLaw::PiecewiseLinear)
    };
    scenarios.push((falling.clone(), inputs));
    // One that flows, besides.
    let yielding = Parameters {
        layer_yield_stress: 1e8,
        layer_hardening: 1e12,
        ..falling
    };
    scenarios.push((yielding, inputs));
    // Laws of wear whose thresholds lie within the contact, blended over so much that all branches count.
    let creeping = Inputs {
        creepage: 0.05,
        ..inputs
    };
    let mapped = Parameters {
        wear_law: WearLaw::ArchardMap,
        wear_blend: 1.0,
        hardness: 1e9,
        wear_map_slip_severe: 0.8,
        wear_map_slip_fast: 1.0,
        ..parameters(FrictionLaw::PiecewiseLinear)
    };
    let by_energy = Parameters {
        wear_law: WearLaw::Energy,
        wear_blend: 1.0,
        wear_energy_threshold: 12e6,
        ..parameters(FrictionLaw::PiecewiseLinear)
    };
    scenarios.extend([(mapped, creeping), (by_energy, creeping)]);
    scenarios
}

/// The outputs after `inputs` have followed the scenario's for as long again.
fn outputs((parameters, held): &Scenario, inputs: &Inputs) -> Outputs {
    let mut run = Simulation::new(parameters, held).unwrap();
    run.hold(held, 5e-3, 4).unwrap();
    *run.hold(inputs, 5e-3, 4).unwrap()
}

/// Slightly more than a value, less than one at its end, or a small one for 0.
fn more(value: f64, maximum: f64) -> f64 {
    match value {
        0.0 => 1e-3 * maximum,
        value if 1.01 * value > maximum => 0.99 * value,
        value => 1.01 * value,
    }
}

#[test]
fn every_output_leaves_zero() {
    let seen: Vec<Outputs> = scenarios()
        .iter()
        .map(|scenario| outputs(scenario, &scenario.1))
        .collect();
    // Third and fourth contacts are rare.
    let common = |name: &str| !name.ends_with("[3]") && !name.ends_with("[4]");
    let idle = OUTPUTS
        .iter()
        .filter(|output| common(output.name))
        .filter(|output| seen.iter().all(|outputs| (output.get)(outputs) == 0.0));
    let idle: Vec<_> = idle.map(|output| output.name).collect();
    assert!(
        idle.is_empty(),
        "outputs that are always 0: {idle:?}. Give them values in src/contact/outputs.rs: in `total_rates` if \
         src/signals.rs has them as Total, in `outputs` if not"
    );
}

#[test]
fn every_input_moves_an_output() {
    let scenarios = scenarios();
    let before: Vec<Outputs> = scenarios
        .iter()
        .map(|scenario| outputs(scenario, &scenario.1))
        .collect();
    let moves = |set: fn(&mut Inputs, f64), value: f64, maximum: f64| {
        scenarios.iter().zip(&before).any(|(scenario, before)| {
            let mut inputs = scenario.1;
            set(&mut inputs, more(value, maximum));
            // A line contact refuses what only a patch takes.
            inputs.check(&scenario.0).is_ok() && outputs(scenario, &inputs) != *before
        })
    };
    let idle = INPUTS
        .iter()
        .filter(|input| !moves(input.set, (input.get)(&scenarios[0].1), input.maximum));
    let idle: Vec<_> = idle.map(|input| input.name).collect();
    assert!(
        idle.is_empty(),
        "inputs that move no output: {idle:?}. Use them where they act: `motion` of src/signals.rs, \
         src/contact/line/mechanics.rs for the mechanics, src/contact/line/heat_and_wear.rs for heat, wear and what \
         enters with the rail"
    );
}

#[test]
fn every_parameter_moves_an_output() {
    let scenarios = scenarios();
    let before: Vec<Outputs> = scenarios
        .iter()
        .map(|scenario| outputs(scenario, &scenario.1))
        .collect();
    let moves = |change: &dyn Fn(&mut Parameters)| {
        scenarios.iter().zip(&before).any(|(scenario, before)| {
            let mut changed = scenario.clone();
            change(&mut changed.0);
            let allowed = changed.0.validate().is_ok() && changed.1.check(&changed.0).is_ok();
            allowed && outputs(&changed, &changed.1) != *before
        })
    };
    let mut idle = Vec::new();
    // It acts on profiles that are read from files.
    for entry in REAL_PARAMETERS.iter().filter(|entry| entry.name != "profile_smoothing") {
        for (element, name) in entry.elements.iter().enumerate() {
            let change = |parameters: &mut Parameters| {
                let value = &mut (entry.get_mut)(parameters)[element];
                *value = more(*value, entry.maximum);
            };
            if !moves(&change) {
                idle.push(*name);
            }
        }
    }
    for entry in INTEGER_PARAMETERS {
        let change = |parameters: &mut Parameters| {
            let value = (entry.get)(parameters);
            let other = if value < entry.maximum { value + 1 } else { value - 1 };
            (entry.set)(parameters, other);
        };
        if !moves(&change) {
            idle.push(entry.name);
        }
    }
    assert!(
        idle.is_empty(),
        "parameters that move no output: {idle:?}. Either nothing reads these rows of src/parameters/table.rs, or no \
         scenario of tests/model/effects.rs switches on what does"
    );
}

/// A tunable parameter may change nothing that the model computes once.
#[test]
fn a_retuned_model_is_the_one_built_with_the_values() {
    let mut differ = Vec::new();
    for entry in REAL_PARAMETERS.iter().filter(|entry| entry.tunable) {
        let differs = scenarios().into_iter().any(|(parameters, inputs)| {
            let mut changed = parameters.clone();
            for value in (entry.get_mut)(&mut changed) {
                *value = more(*value, entry.maximum);
            }
            let outputs = |model: &Model| {
                let mut workspace = model.workspace();
                let mut state = model.initial_state(&mut workspace, &inputs).unwrap();
                model
                    .step(&mut workspace, &mut state, &inputs, &Inputs::ZERO, 5e-3)
                    .unwrap();
                state.outputs
            };
            let mut retuned = Model::new(parameters).unwrap();
            retuned.retune(&changed).unwrap();
            outputs(&retuned) != outputs(&Model::new(changed).unwrap())
        });
        if differs {
            differ.push(entry.name);
        }
    }
    assert!(
        differ.is_empty(),
        "parameters that act on what the model computes once: {differ:?}. Their rows of src/parameters/table.rs must \
         not say tunable"
    );
}
