//! Reasons why a profile, or a file of one, is refused.

use thiserror::Error;

/// Errors of profiles. Lengths in messages are in `mm`, as profiles are drawn; in fields in `m`.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum ProfileError {
    /// No profile of this name is built in.
    #[error("there is no built-in profile named {name:?}; there are {known}")]
    Unknown {
        /// The name that was looked up.
        name: String,
        /// Names that there are.
        known: String,
    },
    /// A profile of a rail where a wheel is needed, or the other way round.
    #[error("{name} is the profile of a {found}; a {needed} is needed")]
    OtherBody {
        /// Profile.
        name: String,
        /// "rail" or "wheel".
        found: &'static str,
        /// "rail" or "wheel".
        needed: &'static str,
    },
    /// A name whose ending is that of the other body's files.
    #[error("{name}: a file of this ending holds a {other}, and the profile is that of a {body}")]
    OtherEnding {
        /// Name of the file.
        name: String,
        /// "rail" or "wheel".
        other: &'static str,
        /// "rail" or "wheel".
        body: &'static str,
    },
    /// A place that the profile does not reach.
    #[error(
        "{name}: {what} = {} mm: the profile reaches from {} to {} mm",
        in_thousandths(*value),
        in_thousandths(*minimum),
        in_thousandths(*maximum)
    )]
    NotReached {
        /// Profile.
        name: String,
        /// Quantity that was asked for.
        what: &'static str,
        /// The refused value, `m`.
        value: f64,
        /// Smallest value of the profile, `m`.
        minimum: f64,
        /// Largest value of the profile, `m`.
        maximum: f64,
    },
    /// Points that make no curve.
    #[error("{name}: {reason}")]
    NoCurve {
        /// Profile.
        name: String,
        /// Reason in words, with the values that made it.
        reason: String,
    },
    /// A profile without a running surface.
    #[error("{name}: it is nowhere a function of the lateral position{}", noise("its", *rough))]
    NowhereFlat {
        /// Profile.
        name: String,
        /// Whether the profile is rough, which may be the cause.
        rough: bool,
    },
    /// A wheel with a wall on the face of its flange.
    #[error(
        "{name}: the face of its flange is 84 degrees steep or more at y = {:.2} mm, z = {:.2} mm, above its tip at z = {:.2} mm: no contact can be \
         found beyond{}",
        1e3 * place[0],
        1e3 * place[1],
        1e3 * tip,
        noise("its", *rough)
    )]
    SteepFlange {
        /// Profile.
        name: String,
        /// Lateral position and height where the wall begins, `m`.
        place: [f64; 2],
        /// Height of the flange's tip, `m`.
        tip: f64,
        /// Whether the profile is rough, which may be the cause.
        rough: bool,
    },
    /// Wear that leaves no profile.
    #[error("{name} cannot wear so: {reason}")]
    NoWear {
        /// Profile.
        name: String,
        /// Reason in words, with the values that made it.
        reason: String,
    },
    /// A wheel without the places that its measures are taken at.
    #[error("{name} cannot be measured: {reason}")]
    NotMeasured {
        /// Profile.
        name: String,
        /// Reason in words, with the values that made it.
        reason: String,
    },
    /// A file that cannot be read or written.
    #[error("{path}: {reason}")]
    File {
        /// The file.
        path: String,
        /// Reason that the system gives.
        reason: String,
    },
    /// A file that a parameter names and that is not there.
    #[error("there is no file {path}{places}; built-in {body}s are {known}")]
    NotFound {
        /// The file.
        path: String,
        /// Folders that a relative path was looked for in, in words; empty of an absolute one.
        places: String,
        /// "rail" or "wheel".
        body: &'static str,
        /// Names of the body's profiles that need no file.
        known: String,
    },
    /// A file whose content is not that of its format.
    #[error("{name}, {format}{}: {reason}", at_line(*line))]
    Content {
        /// Profile.
        name: String,
        /// Format of the file.
        format: &'static str,
        /// Line, counted from 1; 0 where no single line is meant.
        line: usize,
        /// Reason in words, with the values that made it.
        reason: String,
    },
    /// A file that does not say what it must, and from which it cannot be told.
    #[error("{name}: {seen}; {option} has to say it")]
    NotSaid {
        /// Profile.
        name: String,
        /// Findings in the file.
        seen: String,
        /// Option of the reader.
        option: &'static str,
    },
    /// A rail or a wheel that is broader than any.
    #[error(
        "{name}: {part} is {:.1} mm broad: allowed is up to {:.0} mm; unit says in which unit the file is",
        1e3 * breadth,
        1e3 * most
    )]
    TooBroad {
        /// Profile.
        name: String,
        /// Part of it that is too broad, in words.
        part: &'static str,
        /// Breadth, `m`.
        breadth: f64,
        /// Largest breadth that is allowed, `m`.
        most: f64,
    },
    /// An option without a use for this profile.
    #[error("{name}: {option} has no use: {reason}")]
    NotUsed {
        /// Profile.
        name: String,
        /// Option of the reader.
        option: &'static str,
        /// Reason in words.
        reason: &'static str,
    },
    /// A profile that is not that of its body, as it is turned.
    #[error("{name}: this is no {body} with y to the field side and z upward: {seen}")]
    Orientation {
        /// Profile.
        name: String,
        /// "rail" or "wheel".
        body: &'static str,
        /// Findings in the file.
        seen: String,
    },
    /// A quantity outside its range.
    #[error("{name} = {value}: allowed is {minimum} to {maximum} {unit}")]
    OutOfRange {
        /// Quantity.
        name: &'static str,
        /// The refused value.
        value: f64,
        /// Smallest allowed value.
        minimum: f64,
        /// Largest allowed value.
        maximum: f64,
        /// Unit of all three.
        unit: &'static str,
    },
    /// A wheel that stands beside its rail, or on the edge of its profile.
    #[error(
        "at the lateral displacement {} mm and the yaw {} mrad a wheel touches beside its rail, or with the edge of a profile{}",
        in_thousandths(*lateral),
        in_thousandths(*yaw),
        noise("a profile's", *rough)
    )]
    WheelBesideRail {
        /// Lateral displacement of the wheelset, `m`.
        lateral: f64,
        /// Yaw of the wheelset, rad.
        yaw: f64,
        /// Whether a profile is rough, which may be the cause.
        rough: bool,
    },
    /// A wheel that stands on its flange.
    #[error(
        "at the lateral displacement {} mm and the yaw {} mrad the {side} wheel stands on its flange: it touches at {:.2} mm on its profile, and the tip \
         of the flange reaches to {:.2} mm{}",
        in_thousandths(*lateral),
        in_thousandths(*yaw),
        1e3 * on_wheel,
        1e3 * tip,
        noise("a profile's", *rough)
    )]
    WheelOnFlange {
        /// "left" or "right".
        side: &'static str,
        /// Lateral displacement of the wheelset, `m`.
        lateral: f64,
        /// Yaw of the wheelset, rad.
        yaw: f64,
        /// Place of the contact on the wheel's profile, from its running circle, `m`.
        on_wheel: f64,
        /// Place of the flange's tip there towards the tread, `m`.
        tip: f64,
        /// Whether a profile is rough, which may be the cause.
        rough: bool,
    },
}

impl ProfileError {
    /// Words on a rough profile, behind whose it is: "its", for example.
    pub const NOISE: &'static str = "direction turns to and fro, as noise does, which smoothing takes off";

    /// Whether noise of a profile may be the cause, which smoothing takes off.
    pub fn is_of_noise(&self) -> bool {
        match self {
            ProfileError::NowhereFlat { rough, .. }
            | ProfileError::SteepFlange { rough, .. }
            | ProfileError::WheelBesideRail { rough, .. }
            | ProfileError::WheelOnFlange { rough, .. } => *rough,
            _ => false,
        }
    }
}

/// Noise as the cause, as the end of a message; nothing where no profile is rough.
fn noise(whose: &str, rough: bool) -> String {
    if rough {
        format!("; {whose} {}", ProfileError::NOISE)
    } else {
        String::new()
    }
}

/// A value in thousandths of its unit, without digits of round-off.
pub(crate) fn in_thousandths(value: f64) -> f64 {
    (1e9 * value).round() / 1e6
}

/// Names a line of a file; nothing where none is meant.
fn at_line(line: usize) -> String {
    if line == 0 {
        String::new()
    } else {
        format!(", line {line}")
    }
}
