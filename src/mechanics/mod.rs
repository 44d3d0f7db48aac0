//! Mechanics: the tractions for given temperature and wear.
//!
//! [`problem`] is what is given and what is sought. [`normal`] finds the pressure for a given shear (37), [`tangential`] the
//! shear for a given pressure (30); [`sweep`] solves one after the other until both rest, with [`response`], by which the
//! pressure follows the shear. [`front`] and [`transient`] are parts of the slip: what the cells at the leading edge lack, and
//! ∂u₁/∂t. [`softening`] puts the wear of the step into the normal problem. [`tangent`] is the derivative of the solution with
//! respect to the data. [`patch`] has the same for a contact that is resolved across the rail as well.

pub mod front;
pub mod normal;
pub mod patch;
pub mod problem;
pub mod response;
pub mod softening;
pub mod sweep;
pub mod tangent;
pub mod tangential;
pub mod transient;
