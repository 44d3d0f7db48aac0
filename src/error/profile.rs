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
    /// A place that the profile does not reach.
    #[error(
        "{name}: {what} = {} mm: the profile reaches from {} to {} mm",
        1e3 * value,
        1e3 * minimum,
        1e3 * maximum
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
        "at the lateral displacement {} mm and the yaw {} mrad a wheel touches beside its rail, or with the edge of a profile",
        1e3 * lateral,
        1e3 * yaw
    )]
    WheelBesideRail {
        /// Lateral displacement of the wheelset, `m`.
        lateral: f64,
        /// Yaw of the wheelset, rad.
        yaw: f64,
    },
}
