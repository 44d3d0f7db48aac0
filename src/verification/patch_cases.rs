//! Parts that the checks of the patch share: steady rolling on the ellipses of [`super::contact_points`], like bodies, constant friction, no
//! heat and no wear.

use super::contact_points::{ELLIPSES, FRICTION, LAME_LAMBDA, LOAD, SHEAR_MODULUS, WHEEL_RADIUS};
use super::set_up;
use crate::error::Result;
use crate::parameters::{ContactModel, FrictionLaw, Parameters};
use crate::signals::{Inputs, Outputs};
use crate::simulation::Simulation;
use crate::wheel_rail::Model;
use std::sync::Arc;

/// V, `m/s`.
pub const SPEED: f64 = 20.0;

/// One of [`ELLIPSES`], with `refinement` times the default number of cells each way, strips to the next odd number: one is in the
/// middle. The window is that of the default parameters
/// over the contact of their load, so that as many cells are in contact as under that load.
pub fn parameters(ellipse: usize, refinement: usize) -> Parameters {
    let default = Parameters::default();
    Parameters {
        contact_model: ContactModel::Patch,
        friction_law: FrictionLaw::Constant,
        friction_cold: FRICTION,
        lame_lambda: LAME_LAMBDA,
        shear_modulus: SHEAR_MODULUS,
        wheel_lame_lambda: LAME_LAMBDA,
        wheel_shear_modulus: SHEAR_MODULUS,
        wheel_radius: WHEEL_RADIUS,
        rail_transverse_curvature: 2.0 * ELLIPSES[ellipse].transverse,
        wheel_transverse_curvature: 0.0,
        thermal_expansion: 0.0,
        wear_coefficient: 0.0,
        largest_load: LOAD * default.largest_load / Inputs::default().normal_load,
        patch_nodes: refinement * default.patch_nodes,
        patch_strips: (refinement * default.patch_strips) | 1,
        ..default
    }
}

/// ξ, η and φ at V and the load of the ellipses.
pub fn inputs(parameters: &Parameters, [longitudinal, lateral, spin]: [f64; 3]) -> Inputs {
    Inputs {
        wheel_speed: SPEED * (1.0 + longitudinal) / parameters.wheel_radius,
        normal_load: LOAD,
        creepage: longitudinal,
        lateral_creepage: lateral,
        spin_creepage: spin,
        ..Inputs::default()
    }
}

/// A patch in steady rolling.
pub struct Rolling {
    model: Arc<Model>,
}

impl Rolling {
    /// Rolling of a patch with the given parameters.
    ///
    /// # Errors
    /// Parameters that do not go together.
    pub fn new(parameters: Parameters) -> Result<Rolling> {
        Ok(Rolling {
            model: Arc::new(set_up::model(parameters)?),
        })
    }

    /// The model.
    pub fn model(&self) -> &Arc<Model> {
        &self.model
    }

    /// The parameters.
    pub fn parameters(&self) -> &Parameters {
        self.model.parameters()
    }

    /// Simulation under ξ, η and φ: the state at the start is steady rolling.
    ///
    /// # Errors
    /// A solver that did not converge.
    pub fn at(&self, creepages: [f64; 3]) -> Result<Simulation> {
        Simulation::of(self.model.clone(), &inputs(self.parameters(), creepages))
    }

    /// Outputs of steady rolling under ξ, η and φ.
    ///
    /// # Errors
    /// As of [`Rolling::at`].
    pub fn outputs(&self, creepages: [f64; 3]) -> Result<Outputs> {
        Ok(self.at(creepages)?.state.outputs)
    }

    /// F_x and F_y over μN, and M_z over μN √(ab) of Hertz's ellipse.
    ///
    /// # Errors
    /// As of [`Rolling::at`].
    pub fn shares(&self, creepages: [f64; 3]) -> Result<[f64; 3]> {
        let outputs = self.outputs(creepages)?;
        let bound = self.parameters().friction_cold * LOAD;
        let axis = mean_axis(self.parameters());
        Ok([
            outputs.traction_force / bound,
            outputs.lateral_force / bound,
            outputs.spin_moment / (bound * axis),
        ])
    }
}

/// √(ab) of Hertz's ellipse, `m`.
pub fn mean_axis(parameters: &Parameters) -> f64 {
    let ellipse = parameters.hertz_ellipse(LOAD);
    (ellipse.along * ellipse.across).sqrt()
}

/// a/b of [`ELLIPSES`] in words.
pub fn name(ellipse: usize) -> String {
    let ellipse = ELLIPSES[ellipse];
    format!("a/b = {:.1}", ellipse.along / ellipse.across)
}
