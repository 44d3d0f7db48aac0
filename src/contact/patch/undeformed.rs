//! Wheel and rail undeformed, as the cells of a patch see them: the gap between them and their rigid slip, or a change of these.

use super::operators::{PatchOperators, gap_of_curvatures};
use super::problem::PatchProblem;
use crate::body::grid::Grid;
use crate::mechanics::kinematics;
use crate::parameters::PatchGeometry;
use crate::signals::{Inputs, Motion};

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

    /// Rigid slip of a cell at so many breadths to the left of its strip's middle, over that in the middle, or its change, `m/s`. It changes
    /// linearly towards the strip on that side, which there must be.
    pub fn slip_off_middle(&self, grid: &Grid, place: usize, left: f64) -> [f64; 2] {
        if left == 0.0 {
            return [0.0; 2];
        }
        let beside = if left > 0.0 {
            place + grid.stride()
        } else {
            place - grid.stride()
        };
        [0, 1].map(|component: usize| {
            let slip = &self.rigid_slip[component];
            left.abs() * (slip[beside] - slip[place])
        })
    }

    /// Sets gap and slip to those of the inputs and the motion that they make, or to their changes.
    pub fn set(&mut self, problem: &PatchProblem, inputs: &Inputs, motion: &Motion) {
        self.set_gap(problem, inputs);
        self.set_slip(problem, motion);
    }

    /// Sets the gap to that of the curvatures among the inputs, or to its change with them. A patch whose geometry is not given by inputs keeps the gap
    /// of the parameters.
    fn set_gap(&mut self, problem: &PatchProblem, inputs: &Inputs) {
        if problem.parameters.patch_geometry == PatchGeometry::Inputs {
            let curvatures = (0.5 * inputs.longitudinal_curvature, 0.5 * inputs.transverse_curvature);
            let PatchOperators { grid, scales, .. } = problem.operators;
            gap_of_curvatures(grid, scales, curvatures, &mut self.gap);
        }
    }

    /// Sets the slip to that of one motion for all cells, or to its change with that of the motion.
    fn set_slip(&mut self, problem: &PatchProblem, motion: &Motion) {
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
