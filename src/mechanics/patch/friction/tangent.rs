//! The change of the shear with slip, bound and leading edge: the law's rows at the solution as one linear system, solved as a correction of
//! Newton's method is, and refined until the residual in double precision is small.

use super::{Friction, FrictionProblem, PathOfCells};
use crate::error::{Error, Result};
use crate::mechanics::patch::law::{CellLawRow, Matrix, Scheme, Vector, multiply};

/// Change of the data of a problem.
#[derive(Clone, Copy)]
pub struct FrictionChange<'a> {
    /// Change of S₀ on the grid, x and y: that of the slip at an unchanged shear, without the corrections at the leading edge.
    pub free_slip: [&'a [f64]; 2],
    /// Change of the slip per shear that the leading edge adds, cells.
    pub edge: &'a [Vector],
    /// Change of the slip at the centroid of a strip's load over that in the strip's middle, cells.
    pub off_middle: &'a [Vector],
    /// Change of μp, cells.
    pub bound: &'a [f64],
    /// Change of w.
    pub noise: f64,
    /// Residual to be reached, relative to the change or to what makes it.
    pub tolerance: f64,
}

/// Change of the tractions, scaled and per unit of an input, below which it counts as none: a change far ahead acts on the contact
/// exponentially little, down to where numbers lose their digits and their squares are 0.
pub const LEAST_CHANGE: f64 = 1e-100;

const UNIT: Matrix = [[1.0, 0.0], [0.0, 1.0]];

/// Change of the slip behind a cell that changes the law as that of the slip off a strip's middle does ([`Cell::off_middle`](super::super::law::Cell)).
fn twice(off_middle: Vector) -> Vector {
    off_middle.map(|part| 2.0 * part)
}

impl Friction {
    /// Changes of μ by those of the slip in the last [`Friction::tangent`], cell by cell.
    pub fn friction_changes(&self, path: &PathOfCells, n: usize, take: impl FnMut(usize, f64)) {
        self.on_path.changes(path, n, take);
    }

    /// Linearises at the solution `shear`. Here S₀ of the problem is the slip with the response to the shear, without the corrections at
    /// the leading edge.
    ///
    /// # Errors
    /// [`Error::SingularContactMatrix`].
    pub fn linearise(&mut self, problem: &FrictionProblem, shear: &[Vec<f64>; 2]) -> Result<()> {
        for component in self.response.iter_mut().chain(&mut self.correction_response) {
            component.fill(0.0);
        }
        self.correction.iter_mut().for_each(|component| component.fill(0.0));
        let scheme = Scheme {
            scale: problem.scale,
            noise: problem.noise,
            regularisation: problem.regularisation,
        };
        self.start_rows(problem, &scheme, shear);
        let n = problem.contact.cells();
        if problem.regularisation == 0.0 && problem.response.strip_kernels[0][problem.response.origin] == 0.0 {
            // Without a response of the slip nothing says what shear a cell without slip has: it keeps the one it has.
            let kept = CellLawRow {
                by_shear: UNIT,
                ..CellLawRow::default()
            };
            for index in 0..n {
                // A cell that sticks does not feel its bound.
                if self.rows.by_bound.iter().all(|by_bound| by_bound[index] == 0.0) {
                    self.rows.set(index, &kept);
                }
            }
        }
        self.take_law(problem);
        self.inverted = self.invert_blocks(problem);
        if self.inverted {
            Ok(())
        } else {
            Err(Error::SingularContactMatrix {
                matrix: "friction",
                unknowns: 2 * n,
            })
        }
    }

    /// Moves `tangent`, the change of the shear on the grid, x and y, none outside the contact, from a first guess to the solution;
    /// `problem` and `shear` are those of [`Friction::linearise`]. The change of the slip by it is left for [`Friction::response_at`].
    ///
    /// # Errors
    /// [`Error::TangentialNotConverged`].
    pub fn tangent(
        &mut self,
        problem: &FrictionProblem,
        shear: &[Vec<f64>; 2],
        change: &FrictionChange,
        tangent: &mut [Vec<f64>; 2],
    ) -> Result<()> {
        let (grid, n) = (problem.grid, problem.contact.cells());
        let window = problem.contact.window(grid, 1);
        let behind = if problem.response.forward { -1 } else { 1 };
        let sum = |terms: [Vector; 6]| [0, 1].map(|i| terms.iter().map(|term| term[i]).sum::<f64>());
        let at = |values: &[Vec<f64>; 2], place: usize| [values[0][place], values[1][place]];
        self.given.clear();
        for run in problem.contact.runs() {
            for (index, place) in run.indices().zip(run.places(grid)) {
                let (row, edge, own) = (self.rows.row(index), change.edge[index], at(shear, place));
                let slip = |place: usize| [change.free_slip[0][place], change.free_slip[1][place]];
                let bound = change.bound[index];
                self.given.push(sum([
                    multiply(row.by_ahead, slip(place)),
                    multiply(row.by_ahead, [edge[0] * own[0], edge[1] * own[1]]),
                    multiply(row.by_behind, slip(place.wrapping_add_signed(behind))),
                    multiply(row.by_behind, twice(change.off_middle[index])),
                    row.by_bound.map(|by_bound| by_bound * bound),
                    row.by_noise.map(|by_noise| by_noise * change.noise),
                ]));
            }
        }
        let largest = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, |m: f64, v| v.abs().max(m));
        let cause = largest(&mut self.given.iter().flatten().copied()).max(LEAST_CHANGE);
        let (mut residual, mut size) = (f64::INFINITY, cause);
        for _ in 0..=self.settings.newton_steps {
            {
                let [x, y] = &mut self.response;
                let load = [&tangent[0][..], &tangent[1][..]];
                problem
                    .transform
                    .apply(&problem.response.double, &window, load, [x, y], &mut self.scratch);
            }
            for run in problem.contact.runs() {
                for (index, place) in run.indices().zip(run.places(grid)) {
                    let own = at(tangent, place);
                    let mut ahead = at(&self.response, place);
                    for component in 0..2 {
                        ahead[component] += problem.edge[index][component] * own[component];
                    }
                    let row = self.rows.row(index);
                    let residual = sum([
                        self.given[index],
                        multiply(row.by_shear, own),
                        multiply(row.by_ahead, ahead),
                        multiply(row.by_behind, at(&self.response, place.wrapping_add_signed(behind))),
                        [0.0; 2],
                        [0.0; 2],
                    ]);
                    for (all, own) in self.rows.residual.iter_mut().zip(residual) {
                        all[index] = own;
                    }
                    if problem.path.is_some() {
                        let (edge, shear) = (change.edge[index], at(shear, place));
                        let free = |place: usize, i: usize| change.free_slip[i][place];
                        let last = place.wrapping_add_signed(behind);
                        let after = at(&self.response, last);
                        let slip_ahead = [0, 1].map(|i: usize| free(place, i) + edge[i] * shear[i] + ahead[i]);
                        let slip_behind =
                            [0, 1].map(|i: usize| free(last, i) + after[i] + 2.0 * change.off_middle[index][i]);
                        self.on_path
                            .keep_slip_and_noise_change(index, slip_ahead, slip_behind, change.noise);
                    }
                }
            }
            if let Some(path) = &problem.path {
                let rows = &mut self.rows;
                self.on_path.follow(path, n, |index, friction| {
                    for (residual, by_bound) in rows.residual.iter_mut().zip(&rows.by_bound) {
                        residual[index] += by_bound[index] * path.pressure[index] * friction;
                    }
                });
            }
            residual = self.largest_residual(n);
            size = cause.max(largest(
                &mut problem.contact.places(grid).flat_map(|place| at(tangent, place)),
            ));
            if residual <= change.tolerance * size {
                return Ok(());
            }
            // In single precision a change of any size is of order 1.
            for own in &mut self.rows.residual {
                own[..n].iter_mut().for_each(|value| *value /= residual);
            }
            self.correct(problem, &window, (change.tolerance * size / residual) as f32);
            for (tangent, correction) in tangent.iter_mut().zip(&self.correction) {
                for place in problem.contact.places(grid) {
                    tangent[place] += residual * correction[place];
                }
            }
        }
        Err(Error::TangentialNotConverged {
            iterations: self.settings.newton_steps,
            residual: residual / size,
            tolerance: change.tolerance,
        })
    }
}
