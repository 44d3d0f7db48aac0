//! Wheel and rail undeformed, as the cells of a patch see them: the gap between them and their rigid slip, or a change of these.

use super::operators::PatchOperators;
use super::problem::PatchProblem;
use crate::body::grid::Grid;
use crate::mechanics::kinematics;
use crate::signals::Motion;

/// Gap and rigid slip of the cells, or a change of them.
#[derive(Debug, Clone)]
pub struct Undeformed {
    /// Gap at no penetration, on the grid, scaled.
    pub gap: Vec<f64>,
    /// Rigid slip of the rail relative to the wheel along x and y, half way from a cell to the one ahead of it, on the grid, `m/s`.
    pub rigid_slip: [Vec<f64>; 2],
}

impl Undeformed {
    /// No gap and no slip.
    pub fn none(grid: &Grid) -> Undeformed {
        let on_grid = || vec![0.0; grid.len()];
        Undeformed {
            gap: on_grid(),
            rigid_slip: [on_grid(), on_grid()],
        }
    }

    /// Gap of the patch's bodies, of constant curvatures; no slip.
    pub fn of_curvatures(operators: &PatchOperators) -> Undeformed {
        Undeformed {
            gap: operators.gap.clone(),
            ..Undeformed::none(&operators.grid)
        }
    }

    /// Sets the slip to that of one motion for all cells, or to its change with that of the motion.
    pub fn set_slip(&mut self, problem: &PatchProblem, motion: &Motion) {
        let grid = &problem.operators.grid;
        let half = if problem.is_forward() { 0.5 } else { -0.5 } * grid.length;
        for strip in 0..grid.strips {
            let y = grid.y(strip);
            for cell in problem.cells_with_next() {
                let [along, across] = kinematics::rigid_slip(motion, grid.x(cell) + half, y);
                let place = grid.place(strip, cell);
                self.rigid_slip[0][place] = along;
                self.rigid_slip[1][place] = across;
            }
        }
    }
}
