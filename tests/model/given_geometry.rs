//! A patch whose geometry is given at each instant, for vehicle codes that search the contacts themselves.

use crate::derivatives;
use wheelrail::parameters::{ContactModel, Control, FrictionLaw, Parameters, PatchGeometry};
use wheelrail::signals::{Inputs, Outputs};
use wheelrail::wheel_rail::{Model, State};

/// A small warm patch of the parameters' geometry.
fn parameters() -> Parameters {
    Parameters {
        contact_model: ContactModel::Patch,
        friction_law: FrictionLaw::PiecewiseLinear,
        patch_nodes: 18,
        patch_strips: 13,
        depth_nodes: 13,
        strip_half_length: 0.3,
        ..Parameters::default()
    }
}

fn given(control: Control) -> Parameters {
    Parameters {
        patch_geometry: PatchGeometry::Inputs,
        control,
        ..parameters()
    }
}

fn rolling() -> Inputs {
    Inputs {
        normal_load: 60e3,
        wheel_speed: 40.0,
        creepage: 3e-3,
        lateral_creepage: 2e-3,
        spin_creepage: 0.2,
        ..Inputs::default()
    }
}

fn after(parameters: &Parameters, inputs: &Inputs, steps: usize) -> State {
    let model = Model::new(parameters.clone()).unwrap();
    let mut workspace = model.workspace();
    let mut state = model.initial_state(&mut workspace, inputs).unwrap();
    for _ in 0..steps {
        model
            .step(&mut workspace, &mut state, inputs, &Inputs::ZERO, 1e-3)
            .unwrap();
    }
    state
}

/// Forces, extents and heat of a patch.
fn results(outputs: &Outputs) -> [f64; 10] {
    [
        outputs.force_x,
        outputs.force_y,
        outputs.force_z,
        outputs.spin_moment,
        outputs.friction_torque,
        outputs.penetration,
        outputs.peak_pressure,
        outputs.contact_length,
        outputs.peak_temperature,
        outputs.wear_rate,
    ]
}

/// The start values of the inputs are those of the parameters: the same patch, but for the relaxation of the shear, which is that of the contact's
/// extent on the cells; and a patch of another radius by inputs is one of that radius by parameters, on the same window.
#[test]
fn given_geometry_is_that_of_the_parameters() {
    let by_parameters = results(&after(&parameters(), &rolling(), 40).outputs);
    let by_inputs = results(&after(&given(Control::Load), &rolling(), 40).outputs);
    for (one, other) in by_inputs.iter().zip(by_parameters) {
        // After 40 steps, 0.7 m of rolling, no start is felt; what is left is the iterations' tolerance.
        assert!((one - other).abs() <= 1e-6 * other.abs(), "{one} {other}");
    }
    let radius = 0.42;
    let smaller = Parameters {
        wheel_radius: radius,
        wheel_transverse_curvature: 0.4,
        ..parameters()
    };
    let inputs = Inputs {
        rolling_radius: radius,
        longitudinal_curvature: 1.0 / radius,
        transverse_curvature: smaller.rail_transverse_curvature + 0.4,
        ..rolling()
    };
    let expected = results(&after(&smaller, &inputs, 40).outputs);
    let found = results(&after(&given(Control::Load), &inputs, 40).outputs);
    for (one, other) in found.iter().zip(expected) {
        // The window is a few per cent larger than its own: the mesh of 18 by 13 cells is off by a per cent, and changes by less.
        assert!((one - other).abs() <= 1e-2 * other.abs(), "{one} {other}");
    }
}

/// A penetration carries the load that has it, and its damping is what the formula says; a wheel apart from the rail gives nothing.
#[test]
fn a_given_penetration_carries_its_load() {
    let loaded = after(&given(Control::Load), &rolling(), 5).outputs;
    let inputs = Inputs {
        contact_penetration: loaded.penetration,
        ..rolling()
    };
    let pressed = after(&given(Control::Height), &inputs, 5).outputs;
    assert!(
        (pressed.normal_force / 60e3 - 1.0).abs() < 1e-6,
        "{}",
        pressed.normal_force
    );
    assert!((pressed.force_x / loaded.force_x - 1.0).abs() < 1e-5);
    let damped = Parameters {
        normal_damping: 0.4,
        ..given(Control::Height)
    };
    for (speed, factor) in [(0.5, 1.2), (-0.5, 0.8), (-4.0, 0.0)] {
        let inputs = Inputs {
            contact_penetration_speed: speed,
            ..inputs
        };
        let outputs = after(&damped, &inputs, 5).outputs;
        assert!((outputs.normal_force - factor * pressed.normal_force).abs() < 1e-6 * 60e3);
        assert_eq!(outputs.traction_force, pressed.traction_force);
    }
    let apart = Inputs {
        contact_penetration: -1e-4,
        ..inputs
    };
    let lifted = after(&given(Control::Height), &apart, 5).outputs;
    assert_eq!(
        [lifted.force_x, lifted.force_y, lifted.force_z, lifted.penetration],
        [0.0; 4]
    );
}

/// The forces in the axes of the track are those of the contact turned by its inclination.
#[test]
fn forces_are_turned_by_the_inclination() {
    let flat = after(&given(Control::Load), &rolling(), 3).outputs;
    let angle = 1.1_f64;
    let inputs = Inputs {
        contact_inclination: angle,
        ..rolling()
    };
    let inclined = after(&given(Control::Load), &inputs, 3).outputs;
    assert_eq!(
        [flat.force_x, flat.force_y, flat.force_z],
        [flat.traction_force, flat.lateral_force, flat.normal_force]
    );
    assert_eq!(inclined.force_x, flat.force_x);
    // Where the left side is higher the normal points to the right.
    let along_normal = inclined.force_z * angle.cos() - inclined.force_y * angle.sin();
    let across = inclined.force_y * angle.cos() + inclined.force_z * angle.sin();
    assert!((along_normal - flat.normal_force).abs() < 1e-9 * flat.normal_force);
    assert!((across - flat.lateral_force).abs() < 1e-9 * flat.normal_force);
    assert!(inclined.force_y < 0.0);
}

/// Derivatives of all outputs with respect to all inputs, the geometry among them.
#[test]
fn a_step_has_the_derivatives_of_its_differences() {
    for control in [Control::Load, Control::Height] {
        let parameters = Parameters {
            normal_damping: if control == Control::Height { 0.3 } else { 0.0 },
            ..given(control)
        };
        let pressed = f64::from(u8::from(control == Control::Height));
        let inputs = Inputs {
            rolling_radius: 0.45,
            longitudinal_curvature: 2.4,
            transverse_curvature: 4.1,
            contact_penetration: 7e-5 * pressed,
            contact_penetration_speed: 0.2 * pressed,
            contact_inclination: 0.2,
            incoming_temperature: 310.0,
            incoming_wear_depth: 2e-7,
            ..rolling()
        };
        let compared = derivatives::check(parameters, inputs, 1e-3).unwrap();
        assert!(compared > 100, "{compared}");
    }
}

/// A contact that grows out of the window of the parameters is held within it under a load, and refused at a penetration; the state stays.
#[test]
fn a_contact_that_outgrows_its_window_is_told() {
    let flatter = Inputs {
        transverse_curvature: 0.3,
        contact_penetration: 8e-5,
        ..rolling()
    };
    let held = after(
        &given(Control::Load),
        &Inputs {
            contact_penetration: 0.0,
            ..flatter
        },
        2,
    );
    assert!(held.convergence.fills_window);
    let model = Model::new(given(Control::Height)).unwrap();
    let mut workspace = model.workspace();
    let start = Inputs {
        contact_penetration: 5e-5,
        ..rolling()
    };
    let mut state = model.initial_state(&mut workspace, &start).unwrap();
    let before = state.clone();
    let refused = model.step(&mut workspace, &mut state, &flatter, &Inputs::ZERO, 1e-3);
    println!("{refused:?}");
    assert!(refused.is_err() || state.convergence.fills_window);
    if refused.is_err() {
        assert_eq!(state, before);
    }
}
