//! The motion that the inputs define, its tangent beside it, and how fast it may be.

use super::Inputs;
use crate::error::Result;
use crate::parameters::{Parameters, PatchGeometry, SlipSource, check_range};

/// Reason why a speed is too large, as [`Parameters::largest_speed`] has it.
pub const LARGEST_SPEED: &str = "the limit is 5 % of the speed of Rayleigh waves, up to which the compliance of rail and \
     wheel holds: lame_lambda, shear_modulus and density set it, and where wheel is elastic wheel_lame_lambda, \
     wheel_shear_modulus and wheel_density";

/// Rolling of the wheel at one instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Motion {
    /// Speed V of the axle along the rail, `m/s`.
    pub rolling_speed: f64,
    /// Rigid slip ω r₀ − V, `m/s`.
    pub rigid_slip: f64,
    /// Lateral velocity v_y of the wheel relative to the rail, to the left, `m/s`.
    pub lateral_speed: f64,
    /// Angular velocity ω_z of the wheel relative to the rail about the upward normal, `rad/s`.
    pub spin_rate: f64,
}

impl Motion {
    /// Motion, or a change of it, all 0.
    pub const ZERO: Motion = Motion {
        rolling_speed: 0.0,
        rigid_slip: 0.0,
        lateral_speed: 0.0,
        spin_rate: 0.0,
    };
}

impl Inputs {
    /// Checks the rolling speed that the inputs make.
    ///
    /// # Errors
    /// [`crate::error::Error::OutOfRange`].
    pub fn check_motion(&self, parameters: &Parameters) -> Result<()> {
        let largest = parameters.largest_speed();
        let speed = self.motion(parameters).rolling_speed;
        check_range(
            "rolling speed V of wheel_speed and creepage",
            speed,
            -largest,
            largest,
            "m/s",
            LARGEST_SPEED,
        )
    }

    /// Rolling radius of the wheel, `m`: the parameter, or the input of a patch of given geometry.
    pub fn radius(&self, parameters: &Parameters) -> f64 {
        match parameters.patch_geometry {
            PatchGeometry::Parameters => parameters.wheel_radius,
            PatchGeometry::Inputs => self.rolling_radius,
        }
    }

    /// The motion that the inputs define: V, ω r₀ − V, v_y and ω_z.
    pub fn motion(&self, parameters: &Parameters) -> Motion {
        let circumferential = self.wheel_speed * self.radius(parameters);
        let rolling_speed = match parameters.slip_source {
            SlipSource::Creepage => circumferential / (1.0 + self.creepage),
            SlipSource::VehicleSpeed => self.vehicle_speed,
        };
        let rigid_slip = match parameters.slip_source {
            // Not the difference of two large numbers.
            SlipSource::Creepage => rolling_speed * self.creepage,
            SlipSource::VehicleSpeed => circumferential - rolling_speed,
        };
        let (lateral_speed, spin_rate) = match parameters.slip_source {
            SlipSource::Creepage => (
                rolling_speed * self.lateral_creepage,
                rolling_speed * self.spin_creepage,
            ),
            SlipSource::VehicleSpeed => (self.lateral_speed, self.spin_rate),
        };
        Motion {
            rolling_speed,
            rigid_slip,
            lateral_speed,
            spin_rate,
        }
    }

    /// The change of [`Inputs::motion`] with that of the inputs: dV, d(ω r₀ − V), dv_y and dω_z.
    pub fn motion_tangent(&self, change: &Inputs, parameters: &Parameters) -> Motion {
        let radius_change = match parameters.patch_geometry {
            PatchGeometry::Parameters => 0.0,
            PatchGeometry::Inputs => change.rolling_radius,
        };
        let circumferential = change.wheel_speed * self.radius(parameters) + self.wheel_speed * radius_change;
        let (rolling_speed, lateral_speed, spin_rate) = match parameters.slip_source {
            SlipSource::VehicleSpeed => (change.vehicle_speed, change.lateral_speed, change.spin_rate),
            SlipSource::Creepage => {
                let speed = self.motion(parameters).rolling_speed;
                let rolling_speed = (circumferential - speed * change.creepage) / (1.0 + self.creepage);
                (
                    rolling_speed,
                    rolling_speed * self.lateral_creepage + speed * change.lateral_creepage,
                    rolling_speed * self.spin_creepage + speed * change.spin_creepage,
                )
            }
        };
        Motion {
            rolling_speed,
            rigid_slip: circumferential - rolling_speed,
            lateral_speed,
            spin_rate,
        }
    }
}
