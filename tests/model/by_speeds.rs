//! A wheel whose motion is given by two speeds.

use wheelrail::parameters::{Parameters, SlipSource};
use wheelrail::signals::Inputs;

/// The default ones, with the vehicle's speed as an input.
pub fn parameters() -> Parameters {
    Parameters {
        slip_source: SlipSource::VehicleSpeed,
        ..Parameters::default()
    }
}

/// Vehicle speed, circumferential speed [m/s], load [N].
pub fn inputs(vehicle_speed: f64, circumferential: f64, normal_load: f64) -> Inputs {
    Inputs {
        vehicle_speed,
        wheel_speed: circumferential / parameters().wheel_radius,
        normal_load,
        ..Inputs::default()
    }
}
