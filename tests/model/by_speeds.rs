//! A wheel whose motion is given by two speeds.

use wheelrail::parameters::{Parameters, SlipSource, Wheel};
use wheelrail::signals::Inputs;

/// The default ones, with the vehicle's speed as an input.
pub fn parameters() -> Parameters {
    Parameters {
        slip_source: SlipSource::VehicleSpeed,
        ..Parameters::default()
    }
}

/// The same with each wheel: the rigid one couples normal and tangential problem, the default one does not.
pub fn wheels() -> [Parameters; 2] {
    [Wheel::Rigid, Wheel::Elastic].map(|wheel| Parameters { wheel, ..parameters() })
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
