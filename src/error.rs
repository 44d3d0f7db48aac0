//! Errors of the model, one enum, each variant carrying the values that made it.

mod profile;
mod text;

pub use profile::ProfileError;
pub(crate) use profile::in_thousandths;
pub use text::{LONGEST_TEXT, TextProblem};
use thiserror::Error;

/// Errors of the physical model. Nothing is changed by a call that returns one.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum Error {
    /// A single value that is not finite or lies outside its range.
    #[error(
        "{name} = {value}: allowed is {minimum} to {maximum}{}{}",
        after(" ", if *unit == "1" { "" } else { unit }),
        after("; ", because)
    )]
    OutOfRange {
        /// Variable or parameter.
        name: &'static str,
        /// The refused value.
        value: f64,
        /// Smallest allowed value.
        minimum: f64,
        /// Largest allowed value.
        maximum: f64,
        /// Unit of all three; empty, or `1`, of a number without one.
        unit: &'static str,
        /// Parameters that set the limits, and how; empty where none does.
        because: &'static str,
    },
    /// Two values, each allowed by itself, that cannot stand together.
    #[error("{first} = {first_value} and {second} = {second_value}: {requirement}")]
    Combination {
        /// First variable.
        first: &'static str,
        /// Value of the first parameter.
        first_value: f64,
        /// Second variable.
        second: &'static str,
        /// Value of the second parameter.
        second_value: f64,
        /// Condition that must hold between the two.
        requirement: &'static str,
    },
    /// A text that cannot be a parameter's.
    #[error("{name} {problem}; allowed is {allowed}", allowed = problem.allowed())]
    Text {
        /// Parameter.
        name: &'static str,
        /// Problem of the text.
        problem: TextProblem,
    },
    /// An input other than 0 that the contact model knows nothing of.
    #[error("{name} = {value}: must be 0 with contact_model = {number} ({choice}); contact_model = {takers} it")]
    OtherModelOnly {
        /// The input.
        name: &'static str,
        /// The refused value.
        value: f64,
        /// Number of the chosen `contact_model`.
        number: i32,
        /// Name of the choice.
        choice: &'static str,
        /// Contact models that take the input, with the verb: "2 (patch) takes".
        takers: &'static str,
    },
    /// An input that has no effect under a choice.
    #[error(
        "{name} = {value} has no effect with {parameter} = {number} ({choice}); with {parameter} = {other_number} ({other}) it is used"
    )]
    NotUsed {
        /// The input.
        name: &'static str,
        /// Value of the input.
        value: f64,
        /// The parameter that chooses: `slip_source` or `control`.
        parameter: &'static str,
        /// The number of the choice.
        number: i32,
        /// Name of the choice.
        choice: &'static str,
        /// The number of the one that uses the input.
        other_number: i32,
        /// Name of that one.
        other: &'static str,
    },
    /// A profile of wheel or rail that does not serve.
    #[error("{0}{way}", way = way_to_say(.0))]
    Profile(ProfileError),
    /// A profile that a parameter names does not serve.
    #[error("{name} = {text:?}: {reason}{}", way_to_say(reason))]
    NamedProfile {
        /// Parameter.
        name: &'static str,
        /// Text that was given.
        text: String,
        /// Profile's own error.
        reason: Box<ProfileError>,
    },
    /// A contact has become larger than the window it was sought in; the step is tried again with a larger one.
    #[error("the contact has become larger than the window it was sought in")]
    ContactOutgrowsWindow,
    /// The wheel touches the rail with its flange's tip or beyond it, or where the rail is as steep as a wall, or at the rail's end, or nothing of it.
    #[error(
        "the wheel has left the rail: with lateral_displacement = {lateral} m and roll_angle = {roll} rad, relative to the rail, it would touch it \
         at its flange's tip, where the rail is steeper than 82 degrees, or not at all{}; the state before is kept",
        after("; ", because)
    )]
    WheelOffRail {
        /// Lateral displacement of the wheelset relative to the rail, `m`.
        lateral: f64,
        /// Roll of the wheelset relative to the rail, rad.
        roll: f64,
        /// Words on what may be the cause: the roughness of a profile, or dimensions that do not belong together; empty where neither is.
        because: String,
    },
    /// The surface of a body has folded onto itself where it is worn.
    #[error(
        "the {body}'s profile is worn by {depth} m at the lateral position {position} m, more than leaves a surface there: wear_acceleration may be too large; the state before is kept"
    )]
    WornAway {
        /// Body: wheel or rail.
        body: &'static str,
        /// Depth, `m`.
        depth: f64,
        /// Lateral position on the new profile, `m`.
        position: f64,
    },
    /// State or workspace come from a model with another `contact_model`.
    #[error("the state or the workspace is not one of this contact_model")]
    OtherContactModel,
    /// No parameter has this name.
    #[error("there is no parameter named {name:?}; `wheelrail describe` lists them")]
    UnknownParameter {
        /// The name that was looked up.
        name: String,
    },
    /// The text is not a number of the parameter's kind.
    #[error("{name} = {text:?} is not {expected}")]
    NotANumber {
        /// Parameter.
        name: &'static str,
        /// Text that was given.
        text: String,
        /// "a real number" or "an integer".
        expected: &'static str,
    },
    /// The text is none of the names that there are.
    #[error("{name} = {text:?}: allowed is {}", either(allowed))]
    UnknownChoice {
        /// Name of the choice.
        name: &'static str,
        /// Text that was given.
        text: String,
        /// Names that are allowed.
        allowed: &'static [&'static str],
    },
    /// The stiffness matrix has no Cholesky factor.
    #[error("the stiffness matrix could not be factorised ({unknowns} unknowns): it is not positive definite")]
    StiffnessNotPositiveDefinite {
        /// Number of unknowns.
        unknowns: usize,
    },
    /// A matrix between the nodes in contact has no inverse.
    #[error("the {matrix} matrix of the contact ({unknowns} nodes) is singular")]
    SingularContactMatrix {
        /// Name of the matrix.
        matrix: &'static str,
        /// Number of nodes in contact.
        unknowns: usize,
    },
    /// The eigenvalue iteration of the depth operator failed.
    #[error("the depth operator with {unknowns} unknowns could not be diagonalised")]
    DepthBasis {
        /// Number of unknowns.
        unknowns: usize,
    },
    /// The normal contact problem did not reach its tolerance.
    #[error(
        "the normal contact solver ({solver}) stopped after {iterations} iterations at a residual of {residual:e} (relative; {tolerance:e} is required)"
    )]
    NormalNotConverged {
        /// Name of the method.
        solver: &'static str,
        /// Iterations done.
        iterations: usize,
        /// Residual reached, relative to the peak pressure.
        residual: f64,
        /// Residual required.
        tolerance: f64,
    },
    /// The friction problem did not reach its tolerance.
    #[error(
        "the tangential Newton solver stopped after {iterations} iterations at a residual of {residual:e} (relative; {tolerance:e} is required)"
    )]
    TangentialNotConverged {
        /// Iterations done.
        iterations: usize,
        /// Residual reached, relative to the peak pressure.
        residual: f64,
        /// Residual required.
        tolerance: f64,
    },
    /// Normal and tangential problem did not come to rest.
    #[error(
        "the coupling of normal and tangential contact stopped after {iterations} sweeps at a change of {residual:e} (relative; {tolerance:e} is required)"
    )]
    MechanicsNotConverged {
        /// Iterations done.
        iterations: usize,
        /// Last relative change of the tractions.
        residual: f64,
        /// Change required.
        tolerance: f64,
    },
    /// The operator split between mechanics and heat did not come to rest.
    #[error(
        "the thermo-mechanical operator split stopped after {iterations} iterations at a change of {residual:e} (relative; {tolerance:e} is required)"
    )]
    SplitNotConverged {
        /// Iterations done.
        iterations: usize,
        /// Last relative change.
        residual: f64,
        /// Change required.
        tolerance: f64,
    },
    /// A step needs more work than it may take.
    #[error(
        "the step takes more than {limit:e} multiplications and additions, the budget of a step: its inputs change too fast for its length, or the contact has no solution nearby; a shorter step takes less"
    )]
    TooMuchWork {
        /// Multiplications and additions until it was given up, about.
        work: u64,
        /// The budget.
        limit: u64,
    },
    /// The linear split behind the derivatives did not come to rest.
    #[error(
        "the derivatives of the step stopped after {iterations} iterations at a change of {residual:e} (relative; {tolerance:e} is required)"
    )]
    SensitivityNotConverged {
        /// Iterations done.
        iterations: usize,
        /// Last relative change.
        residual: f64,
        /// Change required.
        tolerance: f64,
    },
    /// The scalar surface condition of one column has no bracketed root.
    #[error(
        "the surface heat condition at x = {position} m stopped after {iterations} Newton iterations at a residual of {residual:e} K"
    )]
    SurfaceHeatNotConverged {
        /// Position of the column, `m`.
        position: f64,
        /// Iterations done.
        iterations: usize,
        /// Residual reached, `K`.
        residual: f64,
    },
    /// Rail and wheel did not agree on the wheel's temperature.
    #[error("the temperature of the wheel stopped after {iterations} iterations at a change of {residual:e} K")]
    WheelHeatNotConverged {
        /// Iterations done.
        iterations: usize,
        /// Last change, `K`.
        residual: f64,
    },
    /// The contact reaches the end of the window that was sized for `largest_load`, under a larger load.
    #[error(
        "{name} = {value} {unit} is too much: the contact reaches the end of the contact window (half-width {} m) and carries {} N, more than \
         largest_load = {largest_load} N, which about {name} = {} {unit} takes",
        short(*half_width),
        short(*load),
        short(*about)
    )]
    ContactLeavesWindow {
        /// Variable that gives the penetration.
        name: &'static str,
        /// The refused value.
        value: f64,
        /// Unit of the value.
        unit: &'static str,
        /// Half-width of the window, `m`.
        half_width: f64,
        /// Value that takes `largest_load`, about.
        about: f64,
        /// The load, `N`.
        load: f64,
        /// The load that sized it, `N`.
        largest_load: f64,
    },
}

/// Names of what smooths a profile, behind words on its noise.
pub(crate) const BY_SMOOTHING: &str = " (profile_smoothing; of a Profile in Python its smoothing)";

/// Way to a profile that serves: the parameter that smooths it, or a file that says of itself what no parameter does, as its unit.
fn way_to_say(reason: &ProfileError) -> &'static str {
    match reason {
        ProfileError::NotSaid { .. } | ProfileError::TooBroad { .. } => {
            "; `wheelrail profile`, or `Profile` in Python, can be told, and writes a file that says it itself"
        }
        _ if reason.is_of_noise() => BY_SMOOTHING,
        _ => "",
    }
}

/// A value to four digits, as a message tells it.
fn short(value: f64) -> f64 {
    format!("{value:.3e}").parse().unwrap_or(value)
}

/// A part of a message behind what separates it from the rest; nothing where the part is empty.
fn after(separator: &str, part: &str) -> String {
    if part.is_empty() {
        String::new()
    } else {
        format!("{separator}{part}")
    }
}

/// Names in a row: "one, two or three".
fn either(names: &[&str]) -> String {
    match names {
        [] => String::new(),
        [one] => (*one).to_owned(),
        [others @ .., last] => format!("{} or {last}", others.join(", ")),
    }
}

/// `Result` of the physical model.
pub type Result<T> = std::result::Result<T, Error>;
