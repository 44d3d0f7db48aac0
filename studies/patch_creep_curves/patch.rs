//! wheelrail's patch on CONTACT's ellipses.

use crate::fastsim::{Creepages, Forces};
use wheelrail::parameters::ContactModel;
use wheelrail::verification::contact_points::{Ellipse, FRICTION, LAME_LAMBDA, LOAD, SHEAR_MODULUS, WHEEL_RADIUS};
use wheelrail::{Error, FrictionLaw, Inputs, Model, Parameters, State, Workspace};

/// Speed V, m/s: without inertia and with constant friction it moves no force.
const SPEED: f64 = 20.0;
/// A step, s: many lengths of the contact, after which nothing is left of the transient.
const STEP: f64 = 0.01;

/// A wheel on the default grid, of CONTACT's material and with its friction; heat and wear act on nothing.
pub struct Wheel {
    model: Model,
    workspace: Workspace,
    state: Option<State>,
}

impl Wheel {
    /// With the ellipse under CONTACT's load.
    pub fn new(ellipse: &Ellipse) -> Result<Wheel, Error> {
        let model = Model::new(Parameters {
            contact_model: ContactModel::Patch,
            wheel_radius: WHEEL_RADIUS,
            rail_transverse_curvature: 2.0 * ellipse.transverse,
            wheel_transverse_curvature: 0.0,
            lame_lambda: LAME_LAMBDA,
            shear_modulus: SHEAR_MODULUS,
            wheel_lame_lambda: LAME_LAMBDA,
            wheel_shear_modulus: SHEAR_MODULUS,
            friction_law: FrictionLaw::Constant,
            friction_cold: FRICTION,
            thermal_expansion: 0.0,
            wear_coefficient: 0.0,
            ..Parameters::default()
        })?;
        let workspace = model.workspace();
        Ok(Wheel {
            model,
            workspace,
            state: None,
        })
    }

    /// Steady rolling, from nothing. None where it was not found, which is then said.
    pub fn steady(&mut self, creepages: &Creepages) -> Option<Forces> {
        let inputs = inputs(creepages);
        match self.model.initial_state(&mut self.workspace, &inputs) {
            Ok(state) => Some(forces(&state)),
            Err(error) => {
                eprintln!("{creepages:?}: {error}");
                None
            }
        }
    }

    /// A step from where the wheel stands, under the given creepages from its beginning on; the first call starts there.
    pub fn step(&mut self, creepages: &Creepages) -> Option<Forces> {
        let inputs = inputs(creepages);
        let Some(state) = &mut self.state else {
            let state = self.model.initial_state(&mut self.workspace, &inputs).ok()?;
            let forces = forces(&state);
            self.state = Some(state);
            return Some(forces);
        };
        let stepped = self
            .model
            .step(&mut self.workspace, state, &inputs, &Inputs::ZERO, STEP);
        match stepped {
            Ok(()) => Some(forces(state)),
            Err(error) => {
                eprintln!("{creepages:?}: {error}");
                None
            }
        }
    }
}

fn inputs(creepages: &Creepages) -> Inputs {
    Inputs {
        wheel_speed: SPEED * (1.0 + creepages.longitudinal) / WHEEL_RADIUS,
        creepage: creepages.longitudinal,
        lateral_creepage: creepages.lateral,
        spin_creepage: creepages.spin,
        normal_load: LOAD,
        ..Inputs::default()
    }
}

fn forces(state: &State) -> Forces {
    let outputs = &state.outputs;
    Forces {
        longitudinal: outputs.traction_force,
        lateral: outputs.lateral_force,
        spin_moment: outputs.spin_moment,
        dissipation: outputs.friction_power / SPEED,
    }
}
