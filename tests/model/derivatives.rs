//! Comparison of the derivatives of a step with differences of the step itself, rolled back to the same state.
//!
//! Contact and friction make a step piecewise smooth. Where the pieces that its nodes are on stay the same between the ends of a difference, the
//! derivative has to be the difference; where they do not, the step has a corner there, and is not compared. Which piece a node is on follows from
//! its state alone ([`pieces`]). Few corners show in no state, and are told by the differences: they are counted by themselves.

use crate::setups::{settle, step_from};
use std::cmp::Ordering;
use wheelrail::Error;
use wheelrail::parameters::{ContactModel, FrictionLaw, Parameters, SlipSource};
use wheelrail::settings::Settings;
use wheelrail::signals::{INPUTS, Inputs, OUTPUTS, OutputKind, OutputSignal, Outputs};
use wheelrail::wheel_rail::{ContactNode, Model, State, Workspace};

/// Relative change of the inputs in the step that is differentiated. Without it the operator split would rest after two
/// iterations, and the difference quotient miss the derivative by the square of the contraction, up to 1e-3 whatever its step.
const MOVE: f64 = 0.02;
/// The same for load and temperatures: what comes in changes the tractions little, so it takes a larger move until the
/// split rests at the fourth iteration (measured: 3e-4 off at the third, 2e-7 at the fourth).
const LARGE_MOVE: f64 = -0.1;

/// Tolerances: 1e-4 of the derivative; below, the split's tolerance of 1e-9 over the relative step of a difference.
const TOLERANCES: [f64; 2] = [1e-4, 4e-6];
/// Share of Coulomb's bound above which a node slides: 1 but for what the solvers leave.
const SLIDES: f64 = 1.0 - 1e-9;
/// Share below which a node counts as sticking by the regularised law (docs/method.md).
const REGULARISED_STICKS: f64 = 0.9;
/// Rounding of an output, in units of it: of some sums of its parts.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// How well a step is solved, and how wide its differences are.
#[derive(Debug, Clone, Copy)]
struct Fineness {
    /// Factor on the tolerances of the solvers.
    tolerance: f64,
    /// Factor on the widths.
    width: f64,
}

impl Fineness {
    const USUAL: Fineness = Fineness {
        tolerance: 1.0,
        width: 1.0,
    };
    /// Where a derivative and a difference do not agree, the step may be the cause: an iteration that came to rest by chance leaves an error in
    /// both, which closer solutions do not have, and a corner beside the step is one that narrower differences do not see. A wrong derivative disagrees
    /// with them all.
    const FINER: [Fineness; 3] = [
        Fineness {
            tolerance: 0.1,
            width: 1.0,
        },
        Fineness {
            tolerance: 0.01,
            width: 1.0,
        },
        Fineness {
            tolerance: 1.0,
            width: 0.1,
        },
    ];
}

/// What came of the comparison of some steps.
#[derive(Debug, Clone, Copy, Default)]
pub struct Tally {
    /// Steps that were compared.
    pub steps: usize,
    /// Steps that do not rest at the settings of the comparison.
    pub refused: usize,
    /// Steps of those that are staggered at the default settings.
    pub staggered: usize,
    /// Derivatives that were compared.
    pub compared: usize,
    /// Derivatives of those that agree with finer differences only.
    pub finer: usize,
    /// Derivatives at a corner: the pieces are not the same at the ends of the difference.
    pub corners: usize,
    /// Derivatives at a corner that the pieces do not name, as those of the leading edge: the step is not smooth there by its differences.
    pub unnamed: usize,
}

impl Tally {
    /// Adds another one.
    pub fn add(&mut self, other: Tally) {
        self.steps += other.steps;
        self.refused += other.refused;
        self.staggered += other.staggered;
        self.compared += other.compared;
        self.finer += other.finer;
        self.corners += other.corners;
        self.unnamed += other.unnamed;
    }
}

/// A derivative that is not the difference.
#[derive(Clone)]
pub struct Mismatch {
    output: &'static OutputSignal,
    input: &'static str,
    derivative: f64,
    difference: f64,
}

/// Derivative and difference, and whether they agree.
struct Comparison {
    mismatch: Mismatch,
    agrees: bool,
}

impl std::fmt::Display for Mismatch {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        let place = if self.output.kind == OutputKind::Counted {
            "src/signals.rs has the output as Counted, and it is not"
        } else {
            "A tangent stands beside its primal: where the input is used, or in tangent.rs of src/contact/line or \
             src/contact/patch, which puts the tangents together"
        };
        write!(
            f,
            "d {} / d {}: {} against {} by differences of the step. {place}",
            self.output.name, self.input, self.derivative, self.difference
        )
    }
}

/// What changes the contact appreciably.
pub fn nominal(model: &Model, inputs: &Inputs, input: usize) -> f64 {
    let signal = &INPUTS[input];
    match signal.name {
        "creepage" => 1e-3,
        "wheel_speed" | "vehicle_speed" if model.parameters().slip_source == SlipSource::VehicleSpeed => 1e-2,
        // A wheel that crawls crosses cells at another pace with a change that one at speed does not feel.
        "wheel_speed" if inputs.wheel_speed != 0.0 => signal.nominal.min(inputs.wheel_speed.abs()),
        _ => signal.nominal,
    }
}

/// Size of an output in a step, that deviations are measured by. A total is judged by what the step adds to it: of its nominal value, that of a
/// whole run, a step is so small a part that a corner of its rate would not show. Or by what it added at the rate of the step before: where the slip all but ends, what is left of it
/// is a difference of displacements, with their error.
fn size(output: &OutputSignal, before: &State, after: &State) -> f64 {
    let value = (output.get)(&after.outputs);
    match output.kind {
        OutputKind::Total => {
            let in_the_step_before = (output.get)(&before.output_rates) * after.duration;
            (value - (output.get)(&before.outputs))
                .abs()
                .max(in_the_step_before.abs())
        }
        OutputKind::Instantaneous | OutputKind::Counted | OutputKind::Kept => output.nominal.max(value.abs()),
    }
}

/// Piece of the law that a node is on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Piece {
    /// Whether it is under pressure.
    touches: bool,
    /// Whether it slides, and on a line to which side; none where it sticks.
    slides: Option<bool>,
    /// Side to which its slip is, on a line: |s| has a corner.
    forward: bool,
    /// Interval of the law of μ(θ) that its temperature is in.
    interval: usize,
}

/// Pieces that a state is on.
#[derive(Debug, Clone, PartialEq)]
struct Pieces {
    /// Those of the nodes.
    nodes: Vec<Piece>,
    /// Side of the corners of a layer's law, node by node.
    layer: Vec<Option<Ordering>>,
    /// Those of the ends of the strips, and of a patch of the ends across them: where the last node counts in full. The broadest place across them.
    ends: [Vec<Option<[bool; 2]>>; 2],
    broadest: Option<usize>,
    /// Whether a node counts as sticking, which outputs that count nodes have corners at. By the regularised law nothing else has.
    sticking: Vec<bool>,
    /// Where what an output is the largest of is largest: for [`PEAKS`].
    largest: [Option<usize>; PEAKS.len()],
}

/// Outputs that are the largest value of something.
const PEAKS: [&str; 6] = [
    "peak_pressure",
    "peak_shear",
    "peak_temperature",
    "wear_depth",
    "contact_length",
    "surface_fatigue_index",
];

/// Temperatures at which μ(θ) has corners, `K`.
fn corners(parameters: &Parameters) -> Vec<f64> {
    match parameters.friction_law {
        FrictionLaw::Constant => Vec::new(),
        FrictionLaw::PiecewiseLinear => vec![
            parameters.friction_temperature_cold,
            parameters.friction_temperature_hot,
        ],
        // The stress of flow falls from room temperature on.
        FrictionLaw::FlowStress => vec![293.15],
        FrictionLaw::Table => parameters.friction_table_temperature[..parameters.friction_table_points].to_vec(),
    }
}

/// Row of nodes, by their places, and the pressure at a place.
fn ends(row: &[usize], pressure: impl Fn(usize) -> f64, line: bool) -> (Option<[bool; 2]>, f64) {
    let touching: Vec<usize> = row.iter().copied().filter(|&place| pressure(place) > 0.0).collect();
    let (Some(&first), Some(&last)) = (touching.first(), touching.last()) else {
        return (None, 0.0);
    };
    let inner = [touching.get(1), touching.iter().rev().nth(1)];
    let ratios = [first, last]
        .into_iter()
        .zip(inner)
        .map(|(end, inner)| inner.map_or(1.0, |&inner| pressure(end) / pressure(inner)));
    // The distance of an end beyond its node, in nodes, by the ratio of the pressures there: at most 1.
    let reach = |ratio: f64| match line {
        _ if ratio >= 1.0 => f64::INFINITY,
        true => ratio * ratio / (1.0 - ratio * ratio),
        false => ratio + 0.77 * ratio.powi(3),
    };
    let reaches: Vec<f64> = ratios.map(reach).collect();
    let length = touching.len() as f64 + reaches[0].min(1.0) + reaches[1].min(1.0);
    (Some([reaches[0] < 1.0, reaches[1] < 1.0]), length)
}

/// Place of the largest of some values.
fn place_of_largest(values: impl Iterator<Item = f64>) -> Option<usize> {
    values
        .enumerate()
        .max_by(|a, b| a.1.total_cmp(&b.1))
        .map(|(place, _)| place)
}

/// Pieces of a state.
fn pieces(model: &Model, state: &State) -> Pieces {
    let parameters = model.parameters();
    let (corners, line) = (corners(parameters), parameters.contact_model == ContactModel::Line);
    let nodes = model.contact_nodes(state);
    let piece = |node: &ContactNode| {
        let touches = node.pressure > 0.0;
        let temperature = state.inputs.ambient_temperature + node.temperature;
        Piece {
            touches,
            slides: (node.utilisation.abs() > SLIDES).then_some(line && node.utilisation > 0.0),
            forward: line && touches && node.slip > 0.0,
            interval: if touches {
                corners.iter().filter(|&&corner| corner < temperature).count()
            } else {
                0
            },
        }
    };
    let largest = |value: &dyn Fn(&ContactNode) -> f64| place_of_largest(nodes.iter().map(value));
    // None where the rail is hottest beside the window, which what enters or has left may be.
    let rise = state.outputs.peak_temperature - state.inputs.ambient_temperature;
    let hottest = largest(&|node| node.temperature).filter(|&node| nodes[node].temperature >= rise - 1e-12);
    // Strips along the rail, and rows across it.
    let cells = if line { nodes.len() } else { parameters.patch_nodes };
    let strips: Vec<Vec<usize>> = (0..nodes.len() / cells)
        .map(|strip| (strip * cells..(strip + 1) * cells).collect())
        .collect();
    let across: Vec<Vec<usize>> = (0..if line { 0 } else { cells })
        .map(|cell| strips.iter().map(|strip| strip[cell]).collect())
        .collect();
    let extents = |rows: &[Vec<usize>]| -> (Vec<Option<[bool; 2]>>, Option<usize>) {
        let found: Vec<_> = rows
            .iter()
            .map(|row| ends(row, |place| nodes[place].pressure, line))
            .collect();
        let longest = place_of_largest(found.iter().map(|(_, length)| *length));
        (found.into_iter().map(|(ends, _)| ends).collect(), longest)
    };
    let ((along, longest), (across, broadest)) = (extents(&strips), extents(&across));
    let rear = |strip: &Vec<usize>| {
        let ends = [strip[0], strip[cells - 1]];
        let depths = ends.map(|place| nodes[place].wear_depth);
        match state.outputs.distance {
            // At rest it is the deepest.
            0.0 => strip.iter().map(|&place| nodes[place].wear_depth).fold(0.0, f64::max),
            _ => depths[0].max(depths[1]),
        }
    };
    let sticks = match parameters.slip_regularisation {
        0.0 => SLIDES,
        _ => REGULARISED_STICKS,
    };
    Pieces {
        sticking: nodes.iter().map(|node| node.utilisation.abs() < sticks).collect(),
        layer: model.layer_sides(state),
        ends: [along, across],
        broadest,
        largest: [
            largest(&|node| node.pressure),
            largest(&|node| node.shear.hypot(node.lateral_shear)),
            hottest,
            place_of_largest(strips.iter().map(rear)),
            longest,
            largest(&|node| match node.pressure > 0.0 {
                true => (node.shear.hypot(node.lateral_shear) - parameters.shear_yield_stress) / node.pressure,
                false => f64::NEG_INFINITY,
            }),
        ],
        nodes: nodes.iter().map(piece).collect(),
    }
}

/// Place of an output in [`PEAKS`].
fn peak(output: &OutputSignal) -> Option<usize> {
    PEAKS.iter().position(|name| *name == output.name)
}

impl Pieces {
    /// What all outputs have their corners by.
    fn of_all(&self) -> Pieces {
        Pieces {
            largest: [None; PEAKS.len()],
            sticking: Vec::new(),
            ..self.clone()
        }
    }
}

/// Difference of an output.
struct Difference {
    value: f64,
    /// Error of the value by the rounding of the output.
    rounding: f64,
    /// Whether the pieces stay the same between its ends.
    same: bool,
    /// Whether the output is smooth between its ends, by differences over two widths.
    straight: bool,
}

/// Central differences of all outputs with respect to an input over a step of `duration` from `before`, and the state at its end.
fn differences(
    model: &Model,
    workspace: &mut Workspace,
    before: &State,
    inputs: &Inputs,
    input: usize,
    duration: f64,
    width: f64,
) -> Result<Vec<Difference>, Error> {
    let signal = &INPUTS[input];
    let mut run = |change: f64| {
        let mut moved = *inputs;
        (signal.set)(&mut moved, (signal.get)(inputs) + change);
        step_from(model, workspace, before, &moved, duration)
    };
    let share = match model.parameters().contact_model {
        ContactModel::Line => 4e-4,
        // Many more cells than nodes are close to joining or leaving the contact, or to sliding.
        ContactModel::Patch => 1e-4,
        // The load is found to 1e-9 by the height of the wheel.
        ContactModel::Profiles => 1e-3,
    };
    let share = width * share;
    let h = share * nominal(model, inputs, input);
    let (here, near, far) = (run(0.0)?, [run(h)?, run(-h)?], [run(2.0 * h)?, run(-2.0 * h)?]);
    let expected = pieces(model, &here);
    let all: Vec<Pieces> = near.iter().chain(&far).map(|state| pieces(model, state)).collect();
    let same_pieces = all.iter().all(|pieces| pieces.of_all() == expected.of_all());
    let same_count = all.iter().all(|pieces| pieces.sticking == expected.sticking);
    let difference = |output: &OutputSignal| {
        // A place that is not among the nodes may be any.
        let same_place = |place: usize| {
            let here = expected.largest[place];
            here.is_some() && all.iter().all(|pieces| pieces.largest[place] == here)
        };
        let value = |state: &State| (output.get)(&state.outputs);
        let [ahead, behind] = near.each_ref().map(value);
        let [further_ahead, further_behind] = far.each_ref().map(value);
        let (first, further) = (ahead - behind, further_ahead - further_behind);
        let second = |ahead: f64, behind: f64| ahead - 2.0 * value(&here) + behind;
        // A corner shows in the first or second differences over one and two steps, wherever it lies between.
        let allowed = 3e-5 * further.abs() + 1e-5 * share * size(output, before, &here);
        Difference {
            // Richardson's extrapolation takes the curvature out.
            value: (8.0 * first - further) / (12.0 * h),
            straight: (further - 2.0 * first).abs() <= allowed
                && (second(further_ahead, further_behind) - 4.0 * second(ahead, behind)).abs() <= allowed,
            rounding: ROUNDING * value(&here).abs() / h,
            same: same_pieces
                && peak(output).is_none_or(same_place)
                && (output.kind != OutputKind::Counted || same_count),
        }
    };
    Ok(OUTPUTS.iter().map(difference).collect())
}

/// Settings under which a step has derivatives that its differences can show, with a factor on their tolerances.
fn settings(factor: f64) -> Settings {
    // Tighter than the default: a split that rests early would leave its own error in the difference quotient.
    let mut settings = Settings::default();
    // A step that is divided has the derivatives of its last part only.
    settings.step.retries = 0;
    settings.step.staggered_substeps = 0;
    settings.split.tolerance = 1e-11 * factor;
    settings.split.shear_tolerance = 1e-11 * factor;
    settings.patch.split_tolerance = 1e-11 * factor;
    settings.patch.shear_tolerance = 1e-11 * factor;
    settings.patch.least_tolerance = 1e-11 * factor;
    settings.patch.sensitivity_tolerance = 1e-9 * factor;
    // Else the mechanics of the last iteration may take what the one before left, 1e-5 of the pressure off, and nothing changes.
    settings.patch.first_mechanics_tolerance = 1e-10 * factor;
    settings
}

/// Compares all derivatives of a step of `step` `s`. An error is that of a step.
pub fn compare(
    parameters: Parameters,
    inputs: &Inputs,
    step: f64,
    mismatches: &mut Vec<Mismatch>,
) -> Result<Tally, Error> {
    compare_within(parameters, inputs, step, TOLERANCES, mismatches)
}

/// Compares as [`compare`] does, to the given tolerances: relative to a derivative, and to the size of the output over that of the input. What does not
/// agree is compared again [finer](Fineness::FINER).
fn compare_within(
    parameters: Parameters,
    inputs: &Inputs,
    step: f64,
    tolerances: [f64; 2],
    mismatches: &mut Vec<Mismatch>,
) -> Result<Tally, Error> {
    let mut compared = Vec::new();
    let mut tally = compare_at(&parameters, inputs, step, tolerances, Fineness::USUAL, &mut compared)?;
    let disagrees = |comparison: Comparison| (!comparison.agrees).then_some(comparison.mismatch);
    let mut found: Vec<Mismatch> = compared.into_iter().filter_map(disagrees).collect();
    let first = found.len();
    for fineness in Fineness::FINER {
        let mut again = Vec::new();
        if found.is_empty() || compare_at(&parameters, inputs, step, tolerances, fineness, &mut again).is_err() {
            continue;
        }
        // Compared and found to agree: one that has a corner within the finer difference is not settled by it.
        let is_settled = |mismatch: &Mismatch| {
            let same = |other: &Mismatch| other.output.name == mismatch.output.name && other.input == mismatch.input;
            again.iter().any(|other| other.agrees && same(&other.mismatch))
        };
        for settled in found.iter().filter(|mismatch| is_settled(mismatch)) {
            println!("settled by {fineness:?}: {settled}");
        }
        found.retain(|mismatch| !is_settled(mismatch));
    }
    tally.finer = first - found.len();
    mismatches.append(&mut found);
    Ok(tally)
}

/// Compares with differences of one fineness.
fn compare_at(
    parameters: &Parameters,
    inputs: &Inputs,
    step: f64,
    [relative, of_size]: [f64; 2],
    fineness: Fineness,
    compared: &mut Vec<Comparison>,
) -> Result<Tally, Error> {
    let model = Model::with_settings(parameters.clone(), settings(fineness.tolerance)).unwrap();
    let mut workspace = model.workspace();
    let mut moved = *inputs;
    for signal in INPUTS {
        let share = match signal.name {
            "normal_load" | "ambient_temperature" | "incoming_temperature" => LARGE_MOVE,
            _ => MOVE,
        };
        (signal.set)(&mut moved, (signal.get)(inputs) * (1.0 + share));
    }
    let before = settle(&model, &mut workspace, &moved, step)?;
    let state = step_from(&model, &mut workspace, &before, inputs, step)?;
    assert_eq!(state.duration, step, "the step must not be divided");
    let sensitivities = model
        .output_sensitivities(&mut workspace, &state, 0..INPUTS.len())
        .unwrap();
    let mut tally = Tally {
        steps: 1,
        ..Tally::default()
    };
    for (row, input) in INPUTS.iter().enumerate() {
        // No difference can be taken of what a line contact refuses.
        if !input.is_taken_by(model.parameters().contact_model) {
            assert_eq!(sensitivities[row], Outputs::default(), "{}", input.name);
            continue;
        }
        // At V = 0 the derivative is that towards V > 0, within a speed at which the slowest mode of the heat decays over a cell.
        if input.name == "vehicle_speed" && inputs.vehicle_speed == 0.0 {
            continue;
        }
        let differences = differences(&model, &mut workspace, &before, inputs, row, step, fineness.width)?;
        for (output, difference) in OUTPUTS.iter().zip(differences) {
            if !difference.same {
                tally.corners += 1;
                continue;
            }
            if !difference.straight {
                tally.unnamed += 1;
                continue;
            }
            let derivative = (output.get)(&sensitivities[row]);
            let scale = size(output, &before, &state) / nominal(&model, inputs, row);
            let tolerance = relative * derivative.abs() + of_size * scale + difference.rounding;
            tally.compared += 1;
            compared.push(Comparison {
                mismatch: Mismatch {
                    output,
                    input: input.name,
                    derivative,
                    difference: difference.value,
                },
                agrees: (derivative - difference.value).abs() <= tolerance,
            });
        }
    }
    Ok(tally)
}

/// Asserts all derivatives of a step of `step` `s`. Returns how many were compared; an error is that of a step.
pub fn check(parameters: Parameters, inputs: Inputs, step: f64) -> Result<usize, Error> {
    check_within(parameters, inputs, step, TOLERANCES, &[])
}

/// Asserts derivatives as [`check`] does, to the given tolerances: relative to a derivative, and to the size of the output over that of the input. Those
/// of some outputs by some inputs are left out.
pub fn check_within(
    parameters: Parameters,
    inputs: Inputs,
    step: f64,
    tolerances: [f64; 2],
    left_out: &[(&str, &str)],
) -> Result<usize, Error> {
    let mut mismatches = Vec::new();
    let tally = compare_within(parameters, &inputs, step, tolerances, &mut mismatches)?;
    mismatches.retain(|mismatch| !left_out.contains(&(mismatch.output.name, mismatch.input)));
    let words: Vec<String> = mismatches.iter().map(Mismatch::to_string).collect();
    assert!(words.is_empty(), "at {inputs:?}:\n{}", words.join("\n"));
    Ok(tally.compared)
}

/// Whether an error says that a step does not rest at the settings of the comparison. Settings this tight are no promise of the solvers; what is
/// promised is that the same steps succeed at those that everybody has.
pub fn does_not_rest(error: &Error) -> bool {
    matches!(
        error,
        Error::TangentialNotConverged { .. }
            | Error::SplitNotConverged { .. }
            | Error::MechanicsNotConverged { .. }
            | Error::TooMuchWork { .. }
    )
}
