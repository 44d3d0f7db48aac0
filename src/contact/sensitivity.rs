//! Derivatives of the outputs with respect to the inputs, from the linearised converged step.
//!
//! The step solves x = G(x, u) for the interface vector x under the inputs u, the fields z follow from it. At its solution dx/du
//! solves (1 − ∂G/∂x) dx = ∂G/∂u du, and dz is that of one more sweep. Every part is linear and exact and stands beside what it is
//! the tangent of; the nodes under pressure and those that slip stay the same under an infinitesimal change. Held fixed are the
//! fields at the beginning of the sub-step and its length.

use super::engine::{Direction, Engine, Linearised};
use super::fields::Fields;
use super::problem::Problem;
use super::step::StepWorkspace;
use crate::error::Result;
use crate::signals::{INPUTS, Inputs, OUTPUTS, OutputKind, OutputSignal, Outputs, Totals};

/// Computes the derivatives of all outputs with respect to each of the given rows of [`INPUTS`] at `fields`, the solution of the
/// problem.
///
/// # Errors
/// Mechanics that cannot be linearised, or a linear system that cannot be solved.
pub fn outputs<E: Engine>(
    problem: &Problem<E>,
    fields: &E::Fields,
    workspace: &mut StepWorkspace<E>,
    inputs: impl IntoIterator<Item = usize>,
) -> Result<Vec<Outputs>> {
    let StepWorkspace {
        solvers,
        trial,
        iterate,
        newton,
        ..
    } = workspace;
    trial.copy_from(fields);
    E::begin_linearisation(problem, trial, solvers);
    E::read(problem, trial, solvers, iterate);
    let tolerance = E::sensitivity_settings(problem.settings).tolerance;
    let austenite = E::integrals(problem, fields, solvers).damage.austenite_depth > 0.0;
    let mut at = Linearised::new(problem, iterate, trial, solvers, &mut newton.tangent, tolerance)?;
    inputs
        .into_iter()
        .map(|input| {
            let direction = direction(problem, input);
            newton.system.fields_tangent(&mut at, &direction, &mut newton.step)?;
            let difference = Difference {
                least_step: problem.settings.sensitivity.least_output_step * INPUTS[input].nominal,
                austenite,
            };
            let change = &newton.system.change;
            Ok(output_tangent(
                problem,
                fields,
                at.solvers,
                &direction,
                difference,
                change,
                &mut newton.moved,
            ))
        })
        .collect()
}

/// Direction of the input in a row of [`INPUTS`].
fn direction<E: Engine>(problem: &Problem<E>, input: usize) -> Direction {
    let mut inputs = Inputs::ZERO;
    (INPUTS[input].set)(&mut inputs, 1.0);
    let motion = problem.conditions.inputs.motion_tangent(&inputs, problem.parameters);
    let speed = motion.rolling_speed;
    Direction {
        inputs,
        motion,
        speed: if problem.is_forward() { speed } else { -speed },
    }
}

/// Difference of the outputs.
#[derive(Clone, Copy)]
struct Difference {
    /// Least step of it, in the unit of the input.
    least_step: f64,
    /// Whether there is austenite; without it its depth stays 0.
    austenite: bool,
}

/// Slope of an output by a central difference.
#[derive(Clone, Copy)]
struct Slope {
    value: f64,
    /// Half of what the slopes to both sides are apart: a bound of what a corner between the ends does to the value, and about what
    /// round-off does.
    bend: f64,
    /// Rounding of the output itself over the step.
    rounding: f64,
}

impl Slope {
    /// Slope by the values here and a step ahead and behind.
    fn new(here: f64, [ahead, behind]: [f64; 2], step: f64) -> Slope {
        Slope {
            value: (ahead - behind) / (2.0 * step),
            bend: ((ahead - here) - (here - behind)).abs() / (2.0 * step),
            rounding: f64::EPSILON * here.abs() / step,
        }
    }

    /// Value of the slope over the wider step where that is the straighter one, else of that over the narrower: curvature and corners bend the
    /// wider one more, round-off the narrower.
    fn better(narrow: Slope, wide: Slope) -> f64 {
        if wide.bend <= narrow.bend + narrow.rounding {
            wide.value
        } else {
            narrow.value
        }
    }
}

/// Derivatives of the outputs along a change of inputs and fields, by central differences: the outputs are short expressions of the
/// fields, and a step is known that suits all of them but for round-off. An output that hangs on fields which hardly move while others do is
/// nothing but round-off over that step, and is taken over a wider one ([`Slope::better`]).
fn output_tangent<E: Engine>(
    problem: &Problem<E>,
    fields: &E::Fields,
    solvers: &E::Solvers,
    direction: &Direction,
    difference: Difference,
    change: &E::Fields,
    moved: &mut E::Fields,
) -> Outputs {
    let conditions = &problem.conditions;
    let settings = &problem.settings.sensitivity;
    let step = fields.output_step(change, settings).max(difference.least_step);
    moved.copy_from(fields);
    let mut outputs = |step: f64| {
        moved.move_along(fields, change, step, difference.austenite);
        let problem = problem.under(conditions.inputs.advanced(&direction.inputs, step));
        let (parameters, conditions) = (problem.parameters, &problem.conditions);
        let integrals = E::integrals(&problem, moved, solvers);
        // The totals before the step do not depend on the inputs of the step, so that the derivative is the same from 0.
        let totals = integrals.totals_after(parameters, conditions, &Totals::default());
        integrals.outputs(parameters, &conditions.inputs, &totals)
    };
    let here = outputs(0.0);
    let mut sides = |step: f64| (step, [outputs(step), outputs(-step)]);
    let (narrow, wide) = (sides(step), sides(settings.wider_output_step * step));
    let mut derivative = Outputs::default();
    // What is counted is constant but for jumps, and what is kept does not see the step.
    let moves = |signal: &&OutputSignal| !matches!(signal.kind, OutputKind::Counted | OutputKind::Kept);
    for signal in OUTPUTS.iter().filter(moves) {
        let slope = |(step, sides): &(f64, [Outputs; 2])| {
            let [ahead, behind] = sides.each_ref().map(signal.get);
            Slope::new((signal.get)(&here), [ahead, behind], *step)
        };
        (signal.set)(&mut derivative, Slope::better(slope(&narrow), slope(&wide)));
    }
    if !difference.austenite {
        derivative.austenite_depth = 0.0;
        derivative
            .contact
            .iter_mut()
            .for_each(|contact| contact.austenite_depth = 0.0);
    }
    // The distance follows from the motion alone, whose tangent is exact.
    derivative.distance = direction.speed * conditions.duration;
    if problem.is_unloaded() {
        derivative.penetration = 0.0;
    }
    derivative
}
