//! What a user expects who sets nothing: a wheel at creepage 0 rolls freely. The paper's rigid wheel does not.

use wheelrail::parameters::{Parameters, Wheel};
use wheelrail::signals::{Inputs, Outputs};
use wheelrail::simulation::Simulation;

/// Default inputs, creepage 0, held over ten passages of the strip; the outputs on the way and at the end.
fn rolled(parameters: &Parameters) -> (Outputs, Outputs) {
    let inputs = Inputs::default();
    assert_eq!(inputs.creepage, 0.0);
    let mut run = Simulation::new(parameters, &inputs).unwrap();
    let early = *run.hold(&inputs, 1e-2, 1).unwrap();
    (early, *run.hold(&inputs, 1e-2, 400).unwrap())
}

/// Like bodies under a pressure that is symmetric: no part of the surface slips, nothing warms or wears, and it stays so.
#[test]
fn at_creepage_0_the_default_wheel_neither_pulls_nor_warms_nor_wears() {
    let (early, late) = rolled(&Parameters::default());
    for outputs in [early, late] {
        // Of the friction bound μ N, and of the power that sliding at the regularisation's 1 mm/s under that bound would
        // take; the mixed compliances cancel to round-off, and the solvers are left with that.
        let bound = outputs.friction_coefficient * Inputs::default().normal_load;
        assert!(outputs.traction_force.abs() < 1e-6 * bound, "{outputs:?}");
        assert!(outputs.friction_torque.abs() < 1e-6 * bound * 0.46, "{outputs:?}");
        assert!(outputs.friction_power < 1e-6 * bound * 1e-3, "{outputs:?}");
        assert_eq!(outputs.stick_fraction, 1.0);
        assert!((outputs.peak_temperature - 293.15).abs() < 1e-6);
        assert!(outputs.wear_depth < 1e-15, "{outputs:?}");
    }
    assert!((late.penetration / early.penetration - 1.0).abs() < 1e-9);
}

/// T/(μN) = 0.58: the figure of an independent prototype is 0.59, as in the verification.
#[test]
fn at_creepage_0_the_rigid_wheel_pulls() {
    let (_, outputs) = rolled(&Parameters {
        wheel: Wheel::Rigid,
        ..Parameters::default()
    });
    let share = outputs.traction_coefficient / outputs.friction_coefficient;
    assert!((share - 0.585).abs() < 0.015, "{share}");
}

/// A wheel of the rail's material has its elastic constants and its density.
#[test]
fn the_default_wheel_is_of_the_rails_material() {
    let parameters = Parameters::default();
    assert_eq!(parameters.wheel, Wheel::Elastic);
    assert_eq!(parameters.wheel_lame_lambda, parameters.lame_lambda);
    assert_eq!(parameters.wheel_shear_modulus, parameters.shear_modulus);
    assert_eq!(parameters.wheel_density, parameters.density);
    assert_eq!(parameters.wheel_heat_capacity, parameters.heat_capacity);
}

/// Johnson, Contact Mechanics, 4.43 and 4.45: with E*/2 the half-length is √2 times that of the rigid wheel, the pressure
/// 1/√2 of it, and the contact window is as much wider.
#[test]
fn hertz_relations_are_those_of_the_pair() {
    let (elastic, rigid) = (
        Parameters::default(),
        Parameters {
            wheel: Wheel::Rigid,
            ..Parameters::default()
        },
    );
    let close = |value: f64, expected: f64| assert!((value / expected - 1.0).abs() < 1e-12, "{value} {expected}");
    close(elastic.contact_modulus(), 0.5 * rigid.contact_modulus());
    close(
        elastic.hertz_half_length(60e3),
        2.0_f64.sqrt() * rigid.hertz_half_length(60e3),
    );
    close(
        elastic.hertz_peak_pressure(60e3),
        0.5_f64.sqrt() * rigid.hertz_peak_pressure(60e3),
    );
    close(elastic.window_half_width(), 2.0_f64.sqrt() * rigid.window_half_width());
}
