//! Checks of the parameters, once, before a model is built.

use super::choices::{
    ContactModel, Control, FrictionLaw, MeshKind, NormalSolver, PatchGeometry, ProfileWear, SlipSource, WearLaw,
};
use super::source::ProfileSource;
use super::table::{INTEGER_PARAMETERS, Parameters, REAL_PARAMETERS, TEXT_PARAMETERS};
use crate::error::{Error, Result};
use crate::geometry::hertz::LARGEST_CURVATURE_RATIO;

/// Two values that cannot be together.
fn combination(first: (&'static str, f64), second: (&'static str, f64), requirement: &'static str) -> Result<()> {
    Err(Error::Combination {
        first: first.0,
        first_value: first.1,
        second: second.0,
        second_value: second.1,
        requirement,
    })
}

impl Parameters {
    /// Checks every value against its range, then the values against each other.
    ///
    /// # Errors
    /// [`Error::OutOfRange`], [`Error::Text`] or [`Error::Combination`].
    pub fn validate(&self) -> Result<()> {
        for entry in REAL_PARAMETERS {
            for (element, value) in (entry.get)(self).iter().enumerate() {
                entry.check(element, *value)?;
            }
        }
        for entry in INTEGER_PARAMETERS {
            entry.check((entry.get)(self))?;
        }
        for entry in TEXT_PARAMETERS {
            entry.check((entry.get)(self))?;
        }
        self.validate_friction()?;
        self.validate_control()?;
        self.validate_wear()?;
        self.validate_damage()?;
        if self.patch_geometry == PatchGeometry::Inputs && self.contact_model != ContactModel::Patch {
            return combination(
                ("patch_geometry", f64::from(self.patch_geometry as i32 + 1)),
                self.model(),
                "only contact_model = 2 (patch) takes its geometry from inputs; patch_geometry must be 1 (parameters) without it",
            );
        }
        match self.contact_model {
            ContactModel::Line => {
                let window = self.window_half_width();
                self.validate_window(window)?;
                if window > 0.5 * self.strip_height {
                    return combination(
                        ("largest_load", self.largest_load),
                        ("strip_height", self.strip_height),
                        "the contact window of the largest load must stay below half the strip's height",
                    );
                }
            }
            ContactModel::Patch => self.validate_patch()?,
            ContactModel::Profiles => self.validate_profiles()?,
        }
        self.validate_sizes()
    }

    /// A contact window of the given half-length along the rail, `m`.
    fn validate_window(&self, half_length: f64) -> Result<()> {
        let too_large = |second, second_value, requirement| {
            combination(("largest_load", self.largest_load), (second, second_value), requirement)
        };
        if half_length > 0.1 * self.wheel_radius {
            return too_large(
                "wheel_radius",
                self.wheel_radius,
                "the contact of the largest load must stay below a tenth of the wheel radius (small displacements)",
            );
        }
        if half_length > 0.1 * self.strip_half_length {
            return too_large(
                "strip_half_length",
                self.strip_half_length,
                "the contact window of the largest load must stay below a tenth of the strip's half-length",
            );
        }
        Ok(())
    }

    /// Checks the curvatures that a patch needs, and refuses what it does without.
    fn validate_patch(&self) -> Result<()> {
        let curvatures = |requirement| {
            combination(
                ("rail_transverse_curvature", self.rail_transverse_curvature),
                ("wheel_transverse_curvature", self.wheel_transverse_curvature),
                requirement,
            )
        };
        let (along, across) = self.gap_curvatures();
        if across <= 0.0 {
            return curvatures("their sum must be positive with contact_model = 2 (patch)");
        }
        let ratio = across / along;
        if !(1.0 / LARGEST_CURVATURE_RATIO..=LARGEST_CURVATURE_RATIO).contains(&ratio) {
            return curvatures("their sum must be 1e-4 to 1e4 times 1/wheel_radius with contact_model = 2 (patch)");
        }
        self.validate_grid()?;
        self.validate_window(self.patch_window().0)
    }

    /// Checks how the motion is given to profiles, and refuses what they do without.
    fn validate_profiles(&self) -> Result<()> {
        if self.slip_source != SlipSource::VehicleSpeed {
            return combination(
                self.model(),
                ("slip_source", f64::from(self.slip_source as i32 + 1)),
                "profiles take the motion of the wheelset; slip_source must be 2 (vehicle_speed) with contact_model = 3 (profiles)",
            );
        }
        if self.rail_profile_wear == ProfileWear::On && self.rail_wear_length <= 0.0 {
            return combination(
                ("rail_profile_wear", f64::from(self.rail_profile_wear as i32 + 1)),
                ("rail_wear_length", self.rail_wear_length),
                "what is worn off the rail is spread over a length; rail_wear_length must be positive with rail_profile_wear = 2 (on)",
            );
        }
        ProfileSource::of("rail_profile", &self.rail_profile)?;
        ProfileSource::of("wheel_profile", &self.wheel_profile)?;
        self.validate_grid()?;
        self.validate_window(self.patch_window().0)
    }

    /// The contact model as the first of two values that cannot be together.
    fn model(&self) -> (&'static str, f64) {
        ("contact_model", f64::from(self.contact_model as i32 + 1))
    }

    /// Refuses what only a line contact has: another mesh than its own, another solver than an active set.
    fn validate_grid(&self) -> Result<()> {
        if self.mesh != MeshKind::Graded {
            return combination(
                self.model(),
                ("mesh", f64::from(self.mesh as i32 + 1)),
                "patch and profiles have their own grid; mesh must be 1 (graded)",
            );
        }
        if self.normal_solver != NormalSolver::ActiveSet {
            return combination(
                self.model(),
                ("normal_solver", f64::from(self.normal_solver as i32 + 1)),
                "patch and profiles are solved by an active set; normal_solver must be 1 (active_set)",
            );
        }
        Ok(())
    }

    /// Refuses a height of a line contact, and a penetration where there are profiles.
    fn validate_control(&self) -> Result<()> {
        let control = ("control", f64::from(self.control as i32 + 1));
        match (self.control, self.contact_model) {
            (Control::Height, ContactModel::Line) => combination(
                control,
                self.model(),
                "a line contact has no height; control must be 1 (load) or 2 (penetration) with contact_model = 1 (line)",
            ),
            (Control::Penetration, ContactModel::Profiles) => combination(
                control,
                self.model(),
                "profiles have no penetration of one contact; control must be 1 (load) or 3 (height) with them",
            ),
            _ => Ok(()),
        }
    }

    /// Thresholds of the laws of wear, which must ascend.
    fn validate_wear(&self) -> Result<()> {
        match self.wear_law {
            WearLaw::ArchardMap if self.wear_map_slip_fast <= self.wear_map_slip_severe => combination(
                ("wear_map_slip_fast", self.wear_map_slip_fast),
                ("wear_map_slip_severe", self.wear_map_slip_severe),
                "the slip speed at which severe wear ends must be above the one at which it begins",
            ),
            WearLaw::Energy if self.wear_energy_threshold <= self.wear_energy_severe / self.wear_energy_mild => {
                combination(
                    ("wear_energy_threshold", self.wear_energy_threshold),
                    (
                        "wear_energy_severe/wear_energy_mild",
                        self.wear_energy_severe / self.wear_energy_mild,
                    ),
                    "catastrophic wear must begin above the work at which severe wear does",
                )
            }
            _ => Ok(()),
        }
    }

    /// Thresholds of damage by rolling contact fatigue, which must ascend where there is damage.
    fn validate_damage(&self) -> Result<()> {
        let threshold = ("rcf_threshold", self.rcf_threshold);
        let peak = ("rcf_peak", self.rcf_peak);
        let balance = ("rcf_balance", self.rcf_balance);
        if self.contact_model == ContactModel::Line || self.rcf_peak_damage == 0.0 {
            Ok(())
        } else if peak.1 <= threshold.1 {
            combination(
                peak,
                threshold,
                "fatigue must be largest at a larger wear number than that at which it begins",
            )
        } else if balance.1 <= peak.1 {
            combination(
                balance,
                peak,
                "wear must balance fatigue at a larger wear number than that at which fatigue is largest",
            )
        } else {
            Ok(())
        }
    }

    /// Lengths that must fit into others.
    fn validate_sizes(&self) -> Result<()> {
        let fits = |first, first_value, second, second_value, share: f64, requirement| {
            if first_value <= share * second_value {
                return Ok(());
            }
            combination((first, first_value), (second, second_value), requirement)
        };
        fits(
            "rim_depth",
            self.rim_depth,
            "wheel_radius",
            self.wheel_radius,
            1.0,
            "the rim must not be deeper than the wheel's radius",
        )?;
        fits(
            "skin_depth",
            self.skin_depth,
            "strip_height",
            self.strip_height,
            0.25,
            "the skin must not be deeper than a quarter of the strip",
        )
    }

    /// The part of [`Parameters::validate`] that tunable parameters can violate.
    ///
    /// # Errors
    /// [`Error::Combination`].
    pub fn validate_friction(&self) -> Result<()> {
        let falls = matches!(
            self.friction_law,
            FrictionLaw::PiecewiseLinear | FrictionLaw::FlowStress
        );
        if falls && self.friction_hot > self.friction_cold {
            return combination(
                ("friction_hot", self.friction_hot),
                ("friction_cold", self.friction_cold),
                "the hot contact's friction coefficient must not exceed the cold one's",
            );
        }
        if self.friction_law == FrictionLaw::PiecewiseLinear
            && self.friction_temperature_hot <= self.friction_temperature_cold
        {
            return combination(
                ("friction_temperature_hot", self.friction_temperature_hot),
                ("friction_temperature_cold", self.friction_temperature_cold),
                "the hot temperature must lie above the cold one",
            );
        }
        if self.friction_law == FrictionLaw::Table {
            let points = &self.friction_table_temperature[..self.friction_table_points];
            for pair in points.windows(2) {
                if pair[1] <= pair[0] {
                    return combination(
                        ("friction_table.temperature", pair[0]),
                        ("the next friction_table.temperature", pair[1]),
                        "the temperatures of the friction table must ascend",
                    );
                }
            }
        }
        Ok(())
    }
}
