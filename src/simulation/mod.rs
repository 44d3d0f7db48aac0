//! A wheel's way through time: a model, its scratch and its state, stepped together.
//!
//! [`Schedule`] is a table of inputs over time, [`Schedule::steps`] its communication steps, [`Simulation::follow`] takes one;
//! after each, outputs, profiles and the fields at the contact nodes can be read. [`Simulation::step`] and
//! [`Simulation::hold`] do without a table.
//!
//! ```
//! use wheelrail::simulation::{Point, Schedule};
//! use wheelrail::{Inputs, Parameters, Simulation};
//!
//! let rolling = Inputs::default();
//! let sliding = Inputs { creepage: 0.01, ..rolling };
//! let schedule = Schedule::new(vec![
//!     Point { time: 0.0, inputs: rolling },
//!     Point { time: 0.01, inputs: sliding },
//! ])?;
//! let mut simulation = Simulation::new(&Parameters::default(), &rolling)?;
//! for step in schedule.steps(1e-3)? {
//!     simulation.follow(&step)?;
//!     println!("{} s: {} N", step.to.time, simulation.state.outputs.traction_force);
//! }
//! # Ok::<(), wheelrail::simulation::Error>(())
//! ```
//!
//! To save is to clone or serialise [`Simulation::state`]; [`Simulation::resume`] goes on from it with the same bits. Several
//! simulations, on several threads, may share one model.

mod error;
mod schedule;

use crate::error as model;
use crate::geometry::profile::Profile;
use crate::parameters::Parameters;
use crate::signals::{Inputs, Outputs};
use crate::wheel_rail::{ContactNode, Model, ProfileDepths, Profiles, State, SurfaceWindow, Workspace};
use std::sync::Arc;

pub use error::{Error, Result};
pub use schedule::{Point, Schedule, Step, Steps};

/// A model, its scratch and its state.
pub struct Simulation {
    /// The model.
    pub model: Arc<Model>,
    /// Scratch of its steps.
    pub workspace: Workspace,
    /// State that the simulation has reached: time, inputs, outputs and fields.
    pub state: State,
}

impl Simulation {
    /// Builds the model and solves the mechanics of the cold, unworn rail under `inputs`.
    ///
    /// # Errors
    /// Whatever [`Model::new`] and [`Model::initial_state`] return.
    pub fn new(parameters: &Parameters, inputs: &Inputs) -> model::Result<Simulation> {
        Simulation::of(Arc::new(Model::new(parameters.clone())?), inputs)
    }

    /// One more wheel of a model that is there.
    ///
    /// # Errors
    /// Whatever [`Model::initial_state`] returns.
    pub fn of(model: Arc<Model>, inputs: &Inputs) -> model::Result<Simulation> {
        let mut workspace = model.workspace();
        let state = model.initial_state(&mut workspace, inputs)?;
        Ok(Simulation {
            model,
            workspace,
            state,
        })
    }

    /// Goes on from a saved state as the simulation would have from which it comes.
    ///
    /// # Errors
    /// [`Error::ForeignState`].
    pub fn resume(model: Arc<Model>, state: State) -> Result<Simulation> {
        if !model.accepts(&state) {
            return Err(Error::ForeignState { time: state.time });
        }
        let workspace = model.workspace();
        Ok(Simulation {
            model,
            workspace,
            state,
        })
    }

    /// One communication step of a schedule, or a part of one.
    ///
    /// # Errors
    /// [`Error::Interrupted`].
    pub fn follow(&mut self, step: &Step) -> Result<()> {
        let duration = step.duration();
        self.model
            .step(
                &mut self.workspace,
                &mut self.state,
                &step.from.inputs,
                &step.rates(),
                duration,
            )
            .map_err(|interrupted| Error::Interrupted {
                time: step.from.time,
                step: duration,
                committed: interrupted.committed,
                source: interrupted.error,
            })
    }

    /// One communication step of `duration` `s` under constant inputs.
    ///
    /// # Errors
    /// Why the step could not reach its end. The state's time says how far it came.
    pub fn step(&mut self, inputs: &Inputs, duration: f64) -> model::Result<()> {
        self.model
            .step(&mut self.workspace, &mut self.state, inputs, &Inputs::ZERO, duration)
            .map_err(|interrupted| interrupted.error)
    }

    /// Constant inputs, held in `steps` communication steps of `duration` `s` each. Returns the outputs at the end.
    ///
    /// # Errors
    /// Those of [`Simulation::step`].
    pub fn hold(&mut self, inputs: &Inputs, duration: f64, steps: usize) -> model::Result<&Outputs> {
        for _ in 0..steps {
            self.step(inputs, duration)?;
        }
        Ok(&self.state.outputs)
    }

    /// The outputs at the last communication point.
    pub fn outputs(&self) -> &Outputs {
        &self.state.outputs
    }

    /// The profiles at the last communication point.
    pub fn profiles(&self) -> Profiles {
        self.model.profiles(&self.state)
    }

    /// Depths by which the profiles of wheel and rail are worn.
    ///
    /// # Errors
    /// Those of [`Model::profile_wear`].
    pub fn profile_wear(&self) -> model::Result<ProfileDepths> {
        self.model.profile_wear(&self.state)
    }

    /// Profiles of wheel and rail as they are worn.
    ///
    /// # Errors
    /// Those of [`Model::worn_profiles`].
    pub fn worn_profiles(&self) -> model::Result<[Profile; 2]> {
        self.model.worn_profiles(&self.state)
    }

    /// The fields at the nodes of the contact window, from the rear to the front for V > 0.
    pub fn contact_nodes(&self) -> Vec<ContactNode> {
        self.model.contact_nodes(&self.state)
    }

    /// Windows of a contact of profiles with the fields at their cells.
    ///
    /// # Errors
    /// Those of [`Model::surface_windows`].
    pub fn surface_windows(&self) -> model::Result<Vec<SurfaceWindow>> {
        self.model.surface_windows(&self.state)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parameters::ContactModel;

    fn coarse() -> Parameters {
        Parameters {
            contact_nodes: 25,
            depth_nodes: 21,
            ..Parameters::default()
        }
    }

    /// Schedule into a slide within 20 ms.
    fn schedule(creepage: f64) -> Schedule {
        let inputs = Inputs::default();
        let sliding = Inputs { creepage, ..inputs };
        let points = vec![
            Point { time: 2.0, inputs },
            Point {
                time: 2.02,
                inputs: sliding,
            },
        ];
        Schedule::new(points).unwrap()
    }

    fn simulated(simulation: &mut Simulation, schedule: &Schedule, skip: usize) {
        for step in schedule.steps(1e-3).unwrap().skip(skip) {
            simulation.follow(&step).unwrap();
        }
    }

    #[test]
    fn resumed_from_its_bytes_it_goes_on_with_the_same_bits() {
        let schedule = schedule(0.02);
        // Friction that remembers, on a layer that hardens.
        let with_laws = Parameters {
            friction_slip_share: 0.5,
            friction_slip_decay: 0.5,
            friction_memory_distance: 3e-6,
            layer_compliance: 1e-13,
            layer_yield_stress: 1e8,
            layer_hardening: 1e12,
            ..coarse()
        };
        let patch = Parameters {
            contact_model: ContactModel::Patch,
            patch_nodes: 14,
            patch_strips: 7,
            ..with_laws.clone()
        };
        for parameters in [coarse(), with_laws, patch] {
            let mut whole = Simulation::new(&parameters, &schedule.start().inputs).unwrap();
            let mut bytes = Vec::new();
            for (number, step) in schedule.steps(1e-3).unwrap().enumerate() {
                if number == 10 {
                    bytes = postcard::to_allocvec(&whole.state).unwrap();
                }
                whole.follow(&step).unwrap();
            }
            let saved = postcard::from_bytes(&bytes).unwrap();
            let mut resumed = Simulation::resume(whole.model.clone(), saved).unwrap();
            simulated(&mut resumed, &schedule, 10);
            assert_eq!(resumed.state, whole.state);
            assert_eq!(resumed.profiles(), whole.profiles());
        }
    }

    #[test]
    fn a_state_of_another_model_is_refused() {
        let simulation = Simulation::new(&coarse(), &Inputs::default()).unwrap();
        let finer = Model::new(Parameters {
            contact_nodes: 27,
            ..coarse()
        });
        let refused = Simulation::resume(Arc::new(finer.unwrap()), simulation.state.clone());
        assert_eq!(refused.err(), Some(Error::ForeignState { time: 0.0 }));
        let mut broken = simulation.state.clone();
        broken.outputs.distance = f64::NAN;
        assert!(Simulation::resume(simulation.model.clone(), broken).is_err());
    }

    /// The scheme is of first order in the step: with a quarter of it a quarter of the error is left, where the model does not
    /// divide the steps itself because the inputs change little.
    #[test]
    fn sub_steps_come_nearer_to_the_limit_of_short_steps() {
        let sliding = |creepage| Inputs {
            creepage,
            ..Inputs::default()
        };
        let point = |time, creepage| Point {
            time,
            inputs: sliding(creepage),
        };
        let schedule = Schedule::new(vec![point(0.0, 0.018), point(0.02, 0.02)]).unwrap();
        let mut energies = [1, 4, 32].map(|count| {
            let mut simulation = Simulation::new(&coarse(), &schedule.start().inputs).unwrap();
            for step in schedule.steps(5e-3).unwrap() {
                for part in step.parts(count) {
                    simulation.follow(&part).unwrap();
                }
            }
            simulation.outputs().friction_energy
        });
        let limit = energies[2];
        energies.iter_mut().for_each(|energy| *energy -= limit);
        let left = energies[1] / energies[0];
        assert!((0.1..0.35).contains(&left), "{left}");
    }

    #[test]
    fn an_interrupted_step_says_where_it_stopped() {
        let heavy = Inputs {
            normal_load: 2.0 * coarse().largest_load,
            ..Inputs::default()
        };
        let mut simulation = Simulation::new(&coarse(), &Inputs::default()).unwrap();
        let step = Step {
            from: Point {
                time: 3.0,
                inputs: Inputs::default(),
            },
            to: Point {
                time: 3.5,
                inputs: heavy,
            },
        };
        let before = simulation.state.clone();
        let error = simulation.follow(&step).unwrap_err();
        assert!(
            matches!(
                error,
                Error::Interrupted {
                    time: 3.0,
                    step: 0.5,
                    committed: 0.0,
                    source: model::Error::OutOfRange {
                        name: "normal_load",
                        ..
                    },
                }
            ),
            "{error:?}"
        );
        assert_eq!(simulation.state, before);
    }

    #[test]
    fn threads_share_a_model_and_give_the_bits_of_one_alone() {
        let model = Arc::new(Model::new(coarse()).unwrap());
        let run = |model: Arc<Model>, creepage| {
            let schedule = schedule(creepage);
            let mut simulation = Simulation::of(model, &schedule.start().inputs).unwrap();
            simulated(&mut simulation, &schedule, 0);
            simulation.state
        };
        let creepages = [0.005, 0.02];
        let together = std::thread::scope(|scope| {
            creepages
                .map(|creepage| {
                    let model = model.clone();
                    scope.spawn(move || run(model, creepage))
                })
                .map(|thread| thread.join().unwrap())
        });
        let alone = creepages.map(|creepage| run(Arc::new(Model::new(coarse()).unwrap()), creepage));
        assert_eq!(together, alone);
    }
}
