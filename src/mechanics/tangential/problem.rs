//! Data of a friction problem.

use crate::friction::path::{PathLaw, PathNode};
use crate::mechanics::leading_edge::{EdgeCorrection, EdgeValues, LeadingEdge};

/// Data of one problem on the m nodes under pressure.
#[derive(Debug, Clone, Copy)]
pub struct TangentialProblem<'a> {
    /// p at the shear the solve starts from, m.
    pub pressure: &'a [f64],
    /// Slip velocity at the shear the solve starts from, without what the leading edge adds, `m/s`, m.
    pub slip: &'a [f64],
    /// ∂p/∂τ, m × m.
    pub pressure_response: &'a [f64],
    /// ∂s/∂τ without the leading edge, `m/s`, m × m.
    pub slip_response: &'a [f64],
    /// μ, m; where it depends on slip, that without slip.
    pub friction: &'a [f64],
    /// Law by which μ depends on slip, m nodes; none where it does not.
    pub path: Option<(PathLaw, &'a [PathNode])>,
    /// Leading edge, with the rows that it corrects.
    pub leading: LeadingRows<'a>,
    /// ε, `m/s`; 0 is Coulomb's law.
    pub regularisation: f64,
    /// Whether a solution for a larger ε will do where the law has none that is found.
    pub accepts_regularised: bool,
    /// Newton step that may be left out, relative to the largest pressure.
    pub tolerance: f64,
}

/// Leading edge of a problem, with the rows of the nodes that it corrects.
#[derive(Debug, Clone, Copy)]
pub struct LeadingRows<'a> {
    /// Leading edge, which corrects the slip.
    pub edge: LeadingEdge,
    /// Rows of the three leading nodes, the first of them first; only the first counts where the edge is not resolved.
    pub rows: [usize; 3],
    /// Separation of the node ahead at the shear the solve starts from.
    pub gap: f64,
    /// Response of the separation ahead to the shear, m.
    pub gap_response: &'a [f64],
}

impl LeadingRows<'_> {
    /// Change of the corrections of the slip of the first two rows with the shear on node `column`.
    pub fn response(&self, corrections: &[EdgeCorrection; 2], pressure_response: &[f64], column: usize) -> [f64; 2] {
        let m = self.gap_response.len();
        let mut change = EdgeValues {
            pressure: self.rows.map(|row| pressure_response[column * m + row]),
            gap: self.gap_response[column],
            ..EdgeValues::default()
        };
        for (shear, row) in change.shear.iter_mut().zip(self.rows) {
            *shear = if row == column { 1.0 } else { 0.0 };
        }
        [corrections[0].change(&change), corrections[1].change(&change)]
    }
}
