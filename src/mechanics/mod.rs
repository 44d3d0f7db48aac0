//! Mechanics: the tractions for given temperature and wear.
//!
//! [`traction_problem`] holds data and unknowns. [`normal`] finds the pressure for a given shear (37), [`tangential`] the
//! shear for a given pressure (30); [`normal_tangential`] iterates over both until they have converged, with [`response`], by which
//! the pressure follows the shear. [`kinematics`] is the slip by motion and displacements, with [`transient`], ∂u₁/∂t, and its correction at
//! the [`leading_edge`]. [`wear_compliance`] puts the wear of the step into the normal problem. [`tangent`] is the derivative of the solution with
//! respect to the data. [`patch`] has the same for a contact that is resolved across the rail as well.

pub mod kinematics;
pub mod leading_edge;
pub mod normal;
pub mod normal_tangential;
pub mod patch;
pub mod response;
pub mod tangent;
pub mod tangential;
pub mod traction_problem;
pub mod transient;
pub mod wear_compliance;
