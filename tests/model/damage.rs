//! Damage beside wear: derivatives of a step where there is austenite and fatigue, fatigue and index from the fields, and that damage changes nothing but its outputs.

use crate::derivatives::check;
use crate::setups::{line, patch, rolling, rolling_straight};
use wheelrail::Error;
use wheelrail::parameters::{ContactModel, Parameters, SlipSource, Wheel};
use wheelrail::signals::{Inputs, Outputs};
use wheelrail::simulation::Simulation;
use wheelrail::wheel_rail::Model;

/// Steel that becomes austenite at a share of the largest rise of the rail's surface.
fn soft(parameters: &Parameters, inputs: &Inputs, share: f64) -> Parameters {
    let ambient = inputs.ambient_temperature;
    let peak = held(parameters, inputs).outputs().peak_temperature;
    Parameters {
        austenite_temperature: ambient + share * (peak - ambient),
        ..parameters.clone()
    }
}

/// Two contacts of a wheel on the rail, of which the one at the flange slides most.
fn profiles() -> (Parameters, Inputs) {
    let parameters = Parameters {
        contact_model: ContactModel::Profiles,
        slip_source: SlipSource::VehicleSpeed,
        patch_nodes: 14,
        patch_strips: 11,
        depth_nodes: 17,
        strip_half_length: 0.3,
        ..Parameters::default()
    };
    let inputs = Inputs {
        vehicle_speed: 20.0,
        wheel_speed: 20.1 / parameters.wheel_radius,
        lateral_displacement: 5e-3,
        yaw_angle: 1e-3,
        incoming_wear_depth: 2e-7,
        ..Inputs::default()
    };
    (parameters, inputs)
}

fn held(parameters: &Parameters, inputs: &Inputs) -> Simulation {
    let mut run = Simulation::new(parameters, inputs).unwrap();
    run.hold(inputs, 1e-3, 5).unwrap();
    run
}

#[test]
fn a_step_with_austenite_has_derivatives() {
    let cases = [
        (
            line(SlipSource::VehicleSpeed, Wheel::Elastic),
            rolling_straight(15.0, 0.03),
        ),
        (
            patch(SlipSource::VehicleSpeed, Wheel::Elastic),
            rolling(15.0, [0.02, 4e-3, 0.3]),
        ),
        (
            patch(SlipSource::Creepage, Wheel::Elastic),
            rolling(15.0, [4e-3, 1e-3, 0.3]),
        ),
        profiles(),
    ];
    for (parameters, inputs) in cases {
        for share in [0.9, 0.7] {
            let parameters = soft(&parameters, &inputs, share);
            let outputs = *held(&parameters, &inputs).outputs();
            assert!(outputs.austenite_depth > 3e-6, "{}", outputs.austenite_depth);
            let compared = check(parameters, inputs, 1e-3).unwrap();
            assert!(compared >= 100, "{compared}");
        }
    }
}

#[test]
fn austenite_of_profiles_is_that_of_their_contacts() {
    let (parameters, inputs) = profiles();
    let outputs = *held(&soft(&parameters, &inputs, 0.6), &inputs).outputs();
    let largest = |value: fn(&wheelrail::ContactOutputs) -> f64| {
        outputs.contact[..outputs.contacts as usize]
            .iter()
            .map(value)
            .fold(f64::NEG_INFINITY, f64::max)
    };
    assert!(
        outputs.contacts >= 1.0 && outputs.austenite_depth > 10e-6,
        "{outputs:?}"
    );
    assert_eq!(outputs.austenite_depth, largest(|contact| contact.austenite_depth));
    assert_eq!(
        outputs.surface_fatigue_index,
        largest(|contact| contact.surface_fatigue_index)
    );
    assert_eq!(outputs.rcf_damage, largest(|contact| contact.rcf_damage));
}

/// A hotter contact is austenite farther down, and none is where it stays colder.
#[test]
fn austenite_is_where_the_rail_is_hotter() {
    let (parameters, inputs) = profiles();
    let of = |austenite_temperature: f64| {
        let parameters = Parameters {
            austenite_temperature,
            ..parameters.clone()
        };
        *held(&parameters, &inputs).outputs()
    };
    let cold = of(5000.0);
    let hottest = cold.peak_temperature;
    let ambient = inputs.ambient_temperature;
    // The surface is summed over the modes in another order there.
    assert_eq!(of(hottest + 1e-9).austenite_depth, 0.0);
    let depths = [0.95, 0.7, 0.4].map(|share: f64| of(ambient + share * (hottest - ambient)).austenite_depth);
    assert!(
        0.0 < depths[0] && depths[0] < depths[1] && depths[1] < depths[2],
        "{depths:?}"
    );
    // Nothing else feels it.
    let warm = of(ambient + 0.5 * (hottest - ambient));
    let mut without = warm;
    without.austenite_depth = 0.0;
    without
        .contact
        .iter_mut()
        .for_each(|contact| contact.austenite_depth = 0.0);
    assert_eq!(without, cold);
}

/// The index of the fields, node by node: (|τ| − k)/p.
#[test]
fn the_surface_fatigue_index_is_that_of_the_worst_cell() {
    for parameters in [
        line(SlipSource::VehicleSpeed, Wheel::Elastic),
        patch(SlipSource::VehicleSpeed, Wheel::Elastic),
    ] {
        let inputs = match parameters.contact_model {
            ContactModel::Line => rolling_straight(15.0, 2e-3),
            _ => rolling(15.0, [2e-3, 1e-3, 0.2]),
        };
        let run = held(&parameters, &inputs);
        let nodes = run.contact_nodes();
        let loaded = nodes.iter().filter(|node| node.pressure > 0.0);
        let indices =
            loaded.map(|node| (node.shear.hypot(node.lateral_shear) - parameters.shear_yield_stress) / node.pressure);
        let worst = indices.fold(f64::NEG_INFINITY, f64::max);
        let found = run.outputs().surface_fatigue_index;
        assert!((found - worst).abs() < 1e-12, "{found} {worst}");
    }
}

#[test]
fn a_lifted_wheel_does_no_damage() {
    let parameters = patch(SlipSource::VehicleSpeed, Wheel::Elastic);
    let lifted = Inputs {
        normal_load: 0.0,
        ..rolling(15.0, [2e-3, 1e-3, 0.2])
    };
    let outputs: Outputs = *held(&parameters, &lifted).outputs();
    assert_eq!(
        [
            outputs.rcf_damage,
            outputs.surface_fatigue_index,
            outputs.austenite_depth
        ],
        [0.0; 3]
    );
}

#[test]
fn thresholds_of_fatigue_that_do_not_ascend_are_refused_where_they_count() {
    let parameters = |contact_model, rcf_peak, rcf_balance, rcf_peak_damage| Parameters {
        contact_model,
        rcf_peak,
        rcf_balance,
        rcf_peak_damage,
        ..Parameters::default()
    };
    for (peak, balance, first, second) in [
        (15.0, 175.0, "rcf_peak", "rcf_threshold"),
        (65.0, 65.0, "rcf_balance", "rcf_peak"),
        (0.0, 0.0, "rcf_peak", "rcf_threshold"),
    ] {
        let error = Model::new(parameters(ContactModel::Patch, peak, balance, 1e-5))
            .err()
            .unwrap();
        assert!(matches!(&error, Error::Combination { .. }), "{error:?}");
        let message = error.to_string();
        assert!(message.contains(first) && message.contains(second), "{message}");
        // A line contact has no wear number, and without damage there is nothing to ascend.
        assert!(parameters(ContactModel::Line, peak, balance, 1e-5).validate().is_ok());
        assert!(parameters(ContactModel::Patch, peak, balance, 0.0).validate().is_ok());
    }
}
