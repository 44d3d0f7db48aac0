//! The step.

use super::component::{Built, Component, Plots};
use super::failures::{Blame, Failure};
use super::logging::Category;
use super::modes::Mode;
use crate::parameters::Parameters;
use crate::signals::{INPUTS, Inputs};
use crate::wheel_rail::{Convergence, State};

/// Depth that a step may wear off a profile without a remark, `m`: of the size of what the surfaces sink between two strips.
const LARGEST_PROFILE_CHANGE: f64 = 1e-6;
/// Room for rounding in times that a master adds up step by step: relative, some 10⁶ roundings.
const TIME_TOLERANCE: f64 = 1e-9;

impl Component {
    /// Advances the instance from the communication point `current` by `size`, both in `s`.
    ///
    /// # Errors
    /// [`Failure::StepSize`], [`Failure::CommunicationPoint`] or [`Failure::BeyondStop`] where the step cannot be;
    /// [`Failure::Interrupted`] where it came only part of its way, [`Failure::Step`] where it could not be begun. The last
    /// committed state stands.
    pub fn do_step(&mut self, current: f64, size: f64) -> Result<(), Failure> {
        let end = current + size;
        if size.is_nan() || size <= 0.0 || !size.is_finite() {
            return Err(Failure::StepSize { value: size });
        }
        let start = self.experiment.map_or(0.0, |experiment| experiment.start);
        let room = TIME_TOLERANCE * self.time.abs().max(start.abs()).max(size);
        // Not a number is not close either.
        if !((current - self.time).abs() <= room && end.is_finite()) {
            return Err(Failure::CommunicationPoint {
                value: current,
                expected: self.time,
            });
        }
        if let Some(stop) = self.experiment.and_then(|experiment| experiment.stop)
            && end > stop + TIME_TOLERANCE * stop.abs().max(start.abs()).max(size)
        {
            return Err(Failure::BeyondStop {
                time: current,
                size,
                stop,
            });
        }
        self.warn_of_inputs_without_effect();
        let (Some(Built { model, workspace }), Some(state)) = (&mut self.built, &mut self.state) else {
            return Err(Failure::NothingComputed);
        };
        let outcome = model.step(workspace, state, &self.inputs, &self.rates, size);
        self.plots = Plots::default();
        match outcome {
            Ok(()) => {
                self.time = end;
                // Derivatives hold from the beginning of one step to its end.
                self.rates = Inputs::ZERO;
                self.warn_of_staggered_step();
                self.warn_of_profile_change();
                self.warn_of_windows();
                self.inform_about_step();
                Ok(())
            }
            Err(interrupted) if interrupted.committed > 0.0 => {
                self.time = current + interrupted.committed;
                self.rates = Inputs::ZERO;
                self.mode = Mode::StepFailed;
                let (reached, committed) = (self.time, interrupted.committed);
                Err(Failure::Interrupted {
                    reached,
                    committed,
                    error: interrupted.error,
                })
            }
            Err(interrupted) => Err(Failure::Step {
                time: self.time,
                error: interrupted.error,
            }),
        }
    }

    /// Tells once of each input that slip_source leaves without effect and that has another value than at the start: the importer
    /// will have meant it, and nothing else would show that it does nothing. The status of the step is not touched.
    fn warn_of_inputs_without_effect(&mut self) {
        if !self.journal.hears(Category::StatusWarning) {
            return;
        }
        for (row, signal) in INPUTS.iter().enumerate() {
            let unused = signal.check_used((signal.get)(&self.inputs), &self.parameters);
            if let Err(unused) = unused
                && self.told & 1 << row == 0
            {
                self.told |= 1 << row;
                let time = self.time;
                self.journal
                    .failure(Blame::Remark, || format!("t = {time} s: {unused}"));
            }
        }
    }

    /// Tells that a part of the step was taken staggered. The status of the step is not touched.
    fn warn_of_staggered_step(&mut self) {
        let Some(state) = self.state.as_ref().filter(|state| state.convergence.staggered) else {
            return;
        };
        let (time, residual) = (self.time, state.convergence.residual);
        let held = if residual >= 1.0 {
            ", far from solved, perhaps with the pressure of the step before"
        } else {
            ""
        };
        self.journal.failure(Blame::Remark, || {
            format!(
                "t = {time} s: mechanics, heat and wear of the step were not solved together within its budget of work, but one after the other{held} (residual {residual:e}); a shorter step may be solved"
            )
        });
    }

    /// Tells that a profile has changed by much at once. The status of the step is not touched.
    fn warn_of_profile_change(&mut self) {
        let largest = |state: &&State| state.convergence.profile_change > LARGEST_PROFILE_CHANGE;
        let Some(state) = self.state.as_ref().filter(largest) else {
            return;
        };
        let (time, change) = (self.time, 1e6 * state.convergence.profile_change);
        self.journal.failure(Blame::Remark, || {
            format!(
                "t = {time} s: a profile was worn by {change:.3} micrometres at once, more than 1: the contact sees it after the step only; a shorter step or a smaller wear_acceleration follows it"
            )
        });
    }

    /// Tells, when any of them begins, that the contact is held within its window, that there are more contacts than windows, and that the load is
    /// above the largest. The status of the step is not touched.
    fn warn_of_windows(&mut self) {
        let Some(convergence) = self.state.as_ref().map(|state| state.convergence) else {
            return;
        };
        self.tell_when_it_begins(0, convergence.fills_window, Parameters::full_window_remark);
        self.tell_when_it_begins(1, convergence.crowded, |_| Convergence::CROWDED.to_owned());
        self.tell_when_it_begins(2, convergence.overloaded, Parameters::overload_remark);
    }

    /// Tells the remark of a number in `told_of_windows` where its cause is there and was not at the step before.
    fn tell_when_it_begins(&mut self, number: usize, is_there: bool, remark: impl Fn(&Parameters) -> String) {
        let was_there = std::mem::replace(&mut self.told_of_windows[number], is_there);
        if is_there && !was_there {
            let time = self.time;
            self.journal
                .failure(Blame::Remark, || format!("t = {time} s: {}", remark(&self.parameters)));
        }
    }

    /// Goes on from where a step stopped half-way, as from any communication point.
    pub fn accept_part_of_step(&mut self) {
        if self.mode == Mode::StepFailed {
            self.mode = Mode::StepComplete;
        }
    }

    fn inform_about_step(&mut self) {
        self.inform(Category::Solver, |component| {
            let convergence = match (&component.built, &component.state) {
                (Some(built), Some(state)) => built.model.convergence(state),
                _ => Default::default(),
            };
            let (iterations, residual) = (convergence.iterations, convergence.residual);
            let time = component.time;
            format!("t = {time} s: {iterations} iterations, residual {residual:e}")
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fmi::logging::{Journal, Rules};
    use crate::fmi::resources::Resources;
    use crate::parameters::{ContactModel, ProfileContents, WheelHeating};
    use crate::settings::Settings;
    use crate::settings::limits::{LIMITS, Limit, PATCH_LIMITS};
    use crate::signals::Outputs;

    const RULES: Rules = Rules {
        at_first: &[],
        always: &[],
        adds: false,
    };

    fn initialize(component: &mut Component, contact_model: ContactModel) {
        component.parameters.contact_model = contact_model;
        component.parameters.patch_nodes = 14;
        component.parameters.patch_strips = 7;
        component.parameters.contact_nodes = 25;
        component.parameters.depth_nodes = 17;
        component.parameters.wheel_heating = WheelHeating::On;
        component.set_experiment(0.0, None).unwrap();
        component.enter_initialization();
        component.exit_initialization().unwrap();
    }

    fn limit(component: &mut Component, settings: Settings) {
        component.built = Some(Built::new(&component.parameters, settings, ProfileContents::default()).unwrap());
    }

    fn outputs(component: &mut Component) -> Outputs {
        component.solution().unwrap().outputs
    }

    /// A failure before anything was committed is an error, one after a committed sub-step leaves *stepFailed*. In both cases
    /// the last committed state stands, and a saved state or a reset leads on.
    #[test]
    fn a_step_that_fails_leaves_the_last_committed_state() {
        let mut component = Component::new(Journal::new(false, false, RULES), Resources::default());
        let (mut at_once, mut after_a_part) = ([0; 2], [0; 2]);
        // A step solves the mechanics together with the heat, never alone, and by the active set here.
        let of_a_step = |(words, _): &&Limit| !words.starts_with("coupling") && !words.contains("Pschenichnyj");
        let of_a_line = LIMITS.iter().filter(of_a_step);
        let of_a_line = of_a_line.map(|limit| (ContactModel::Line, limit));
        let of_a_patch = PATCH_LIMITS.iter().map(|limit| (ContactModel::Patch, limit));
        for (contact_model, (words, set_limit)) in of_a_line.chain(of_a_patch) {
            initialize(&mut component, contact_model);
            component.do_step(0.0, 1e-3).unwrap();
            let before = outputs(&mut component);
            let mut handle = std::ptr::null_mut();
            component.get_state(&mut handle).unwrap();
            // The ramp divides the step. Its end slides more than its beginning, and asks more of the solvers.
            component.rates.creepage = 25.0;
            component.do_step(1e-3, 2e-3).unwrap();
            let undisturbed = outputs(&mut component);
            for allowed in 0.. {
                let mut settings = Settings::strict();
                settings.step.retries = 0;
                set_limit(&mut settings, allowed);
                limit(&mut component, settings);
                component.set_state(handle).unwrap();
                component.rates.creepage = 25.0;
                let Err(failure) = component.do_step(1e-3, 2e-3) else {
                    let reached = outputs(&mut component);
                    // A step goes on where its tractions fall short for once, and may end with the closest iterate, as its residual
                    // says; the friction of a line is solved by another method then.
                    let residual = component.state.as_ref().unwrap().convergence.residual;
                    let tolerance = match contact_model {
                        ContactModel::Line => residual.max(1e-9),
                        ContactModel::Patch | ContactModel::Profiles => 1e-5,
                    };
                    let share = reached.traction_force / undisturbed.traction_force;
                    assert!((share - 1.0).abs() < tolerance, "{words}, limit {allowed}: {share}");
                    break;
                };
                assert!(failure.to_string().contains(words), "{failure}");
                component.fail(failure.blame());
                match failure.blame() {
                    Blame::Call => {
                        at_once[contact_model as usize] += 1;
                        assert_eq!(component.mode(), Mode::Error);
                        assert_eq!((component.time(), outputs(&mut component)), (1e-3, before));
                    }
                    Blame::PartOfStep => {
                        after_a_part[contact_model as usize] += 1;
                        assert_eq!(component.mode(), Mode::StepFailed);
                        assert!(
                            component.time() > 1e-3 && component.time() < 3e-3,
                            "{}",
                            component.time()
                        );
                        assert_ne!(outputs(&mut component), before);
                    }
                    other => panic!("{other:?}"),
                }
            }
            component.reset();
            component.built = None;
        }
        let some = |counts: [usize; 2]| counts.iter().all(|count| *count > 0);
        assert!(some(at_once) && some(after_a_part), "{at_once:?} {after_a_part:?}");
        initialize(&mut component, ContactModel::Line);
        component.do_step(0.0, 1e-3).unwrap();
    }
}
