//! Friction of all cells of a patch for given pressure: Newton's method on the law of the cells, its corrections by GMRES with
//! the strips' blocks as preconditioner.
//!
//! The slip is an affine function of the shear, S = S₀ + T τ: T is a product with tables, [`super::super::super::body::influence`], and
//! what the leading edge adds to its cells. Residuals are in double precision, corrections in single: a correction is needed
//! to a few digits only, because the next residual shows what it missed.

mod directions;
mod on_path;
mod tangent;

pub use on_path::PathOfCells;
pub use tangent::{FrictionChange, LEAST_CHANGE};

use super::blocks::{Blocks, StripResponse};
use super::contact::{Contact, work_of_product};
use super::law::{Scheme, Vector};
use super::law_arrays::{CellArrays, Components, LawArrays};
use super::linear_law::{Change, LinearLaw};
use crate::body::grid::Grid;
use crate::body::influence::{self, Tables, Transform, Window};
use crate::error::{Error, Result};
use crate::friction::path::NodeFriction;
use crate::numerics::dense;
use crate::numerics::gmres::{Gmres, Solved};
use crate::numerics::single::WIDTH;
use crate::settings::PatchSettings;
use directions::Directions;
use on_path::OnPath;
use std::ops::Range;

/// Response of the slip ahead of the cells to the shear.
#[derive(Debug, Clone)]
pub struct SlipResponse {
    /// Tables of the response in double precision.
    pub double: Tables<f64>,
    /// Tables of the response in single precision.
    pub single: Tables<f32>,
    /// Response of a strip to its own shear, along x and across, by the lag along x.
    pub strip_kernels: [Vec<f32>; 2],
    /// Place of lag 0 in the response of a strip.
    pub origin: usize,
    /// Whether the leading side is that of +x.
    pub forward: bool,
}

/// Data of one friction problem.
#[derive(Clone, Copy)]
pub struct FrictionProblem<'a> {
    /// The grid.
    pub grid: &'a Grid,
    /// The transform of the tables.
    pub transform: &'a Transform,
    /// The cells under pressure.
    pub contact: &'a Contact,
    /// T, without the leading edge.
    pub response: &'a SlipResponse,
    /// Slip per shear that the leading edge adds to a cell, along x and y, cells.
    pub edge: &'a [Vector],
    /// Slip at the centroid of a strip's load over that in the strip's middle, cells.
    pub off_middle: &'a [Vector],
    /// S₀ on the grid, x and y.
    pub free_slip: [&'a [f64]; 2],
    /// μp, cells.
    pub bound: &'a [f64],
    /// Law of μ in place of the bound, where μ depends on slip; none where it does not.
    pub path: Option<PathOfCells<'a>>,
    /// r, shear per slip.
    pub scale: f64,
    /// w.
    pub noise: f64,
    /// ε, `m/s`; 0 is Coulomb's law.
    pub regularisation: f64,
    /// Residual to be reached, in units of the shear.
    pub tolerance: f64,
    /// Residual that will do where none smaller is reached, and after it the solution for the least ε that has one; 0 accepts neither.
    pub accepted: f64,
    /// Multiplications and additions in a step after which the law is not solved any closer.
    pub work: u64,
}

/// Solver of the friction problem and its buffers.
pub struct Friction {
    settings: PatchSettings,
    gmres: Gmres,
    directions: Directions,
    blocks: Blocks,
    inverted: bool,
    /// Shear on the grid that `response` belongs to.
    answered: [Vec<f64>; 2],
    response: [Vec<f64>; 2],
    correction_response: [Vec<f64>; 2],
    /// Shear for the least ε for which the law was solved.
    regularised: [Vec<f64>; 2],
    /// Correction of the shear, on the grid.
    correction: [Vec<f64>; 2],
    load_single: [Vec<f32>; 2],
    scratch: influence::ProductScratch<f64>,
    scratch_single: influence::ProductScratch<f32>,
    /// Data of the law of the cells.
    cells: CellArrays,
    /// Slip per shear that the leading edge adds to the cells.
    edge: Components,
    /// Slip between the cells of a strip.
    slips: Vec<f64>,
    /// Linearised law of the cells.
    rows: LawArrays,
    /// Linearised law in single precision, as it was when it was taken last.
    law: LinearLaw,
    step: Vec<f32>,
    /// Product of the linearised law, along x and y, with values for a vector register beyond.
    product: [Vec<f32>; 2],
    /// Change of the rows by the data in a linearised problem.
    given: Vec<Vector>,
    /// Law of the cells where μ depends on slip.
    on_path: OnPath,
    /// Multiplications and additions in this step.
    work: u64,
    /// Multiplications and additions after which Newton's method stops.
    work_limit: u64,
    /// Residual that the last solve has left of the law, 0 where it is within the tolerance.
    left: f64,
    /// Newton steps, Krylov iterations and inversions of the blocks since the solver was made.
    iterations: [u64; 3],
}

/// Least decimal digits of a correction that are counted, where it was asked for less.
const LEAST_DIGITS: f64 = 0.3;

/// Values at places after `length` times their change.
#[inline(always)]
fn move_along((values, change): (&[f64], &[f64]), places: Range<usize>, length: f64, out: &mut [f64]) {
    if length == 0.0 {
        out.copy_from_slice(&values[places]);
        return;
    }
    let changed = values[places.clone()].iter().zip(&change[places]);
    for (out, (value, change)) in out.iter_mut().zip(changed) {
        *out = value + length * change;
    }
}

/// Sum of a power of the unknowns of each run.
fn work_of_blocks(contact: &Contact, power: u32) -> u64 {
    contact.runs().iter().map(|run| (2 * run.cells as u64).pow(power)).sum()
}

impl Friction {
    /// Solver for a grid.
    pub fn new(grid: &Grid, transform: &Transform, settings: PatchSettings) -> Friction {
        let (cells, total) = (grid.cells, grid.cells * grid.strips);
        let double = || [vec![0.0; grid.len()], vec![0.0; grid.len()]];
        let single = || [vec![0.0; grid.len()], vec![0.0; grid.len()]];
        Friction {
            settings,
            gmres: Gmres::new(2 * total, settings.krylov_iterations),
            directions: Directions::new(grid, settings.krylov_iterations),
            blocks: Blocks::new(cells, total),
            inverted: false,
            answered: double(),
            response: double(),
            correction_response: double(),
            regularised: double(),
            correction: double(),
            load_single: single(),
            scratch: transform.scratch(),
            scratch_single: transform.scratch(),
            cells: CellArrays::new(total),
            edge: std::array::from_fn(|_| vec![0.0; total]),
            slips: vec![0.0; cells + 1],
            rows: LawArrays::new(total),
            law: LinearLaw::new(total),
            step: vec![0.0; 2 * total],
            product: std::array::from_fn(|_| vec![0.0; total + WIDTH]),
            given: Vec::with_capacity(total),
            on_path: OnPath::new(total),
            work: 0,
            work_limit: u64::MAX,
            left: 0.0,
            iterations: [0; 3],
        }
    }

    /// Forgets what was computed in another step: a step follows from its state alone.
    pub fn start_step(&mut self) {
        self.start_contact();
        (self.work, self.left) = (0, 0.0);
    }

    /// Multiplications and additions in this step, about: a measure of time that is the same on every machine.
    pub fn work(&self) -> u64 {
        self.work
    }

    /// Residual that the last solve has left of the law, in units of the shear: 0 where it is within the tolerance.
    pub fn left(&self) -> f64 {
        self.left
    }

    /// Newton steps, Krylov iterations and inversions of the blocks since the solver was made.
    pub fn iterations(&self) -> [u64; 3] {
        self.iterations
    }

    /// Forgets what was computed for another contact.
    pub fn start_contact(&mut self) {
        self.inverted = false;
        self.answered.iter_mut().for_each(|component| component.fill(f64::NAN));
    }

    /// Solves for the shear on the grid, x and y, from the given one. Cells that are not under pressure must have none.
    ///
    /// # Errors
    /// [`Error::TangentialNotConverged`].
    pub fn solve(&mut self, problem: &FrictionProblem, shear: &mut [Vec<f64>; 2]) -> Result<()> {
        let scheme = Scheme {
            scale: problem.scale,
            noise: problem.noise,
            regularisation: problem.regularisation,
        };
        let slack = self.settings.slack;
        self.work_limit = problem.work;
        self.left = 0.0;
        if self.newton(problem, &scheme, shear, problem.tolerance, slack).is_ok() {
            self.remember(shear);
            return Ok(());
        }
        // From nothing, or after a jump: first with a law that is smooth on the scale of all the slip, then step by step with the law
        // of the problem.
        for component in shear.iter_mut() {
            component.fill(0.0);
        }
        self.start_contact();
        let largest = problem
            .contact
            .places(problem.grid)
            .map(|place| problem.free_slip[0][place].hypot(problem.free_slip[1][place]))
            .fold(0.0, f64::max);
        let bound = problem.bound[..problem.contact.cells()].iter();
        let rough = self.settings.continuation_tolerance * bound.fold(0.0, |m: f64, &bound| m.max(bound));
        // Least ε for which the law was solved.
        let mut regularised = None;
        let mut epsilon = largest;
        for _ in 0..self.settings.continuation {
            // Beyond the limit of work, one solution is sought where it will do.
            let sought = problem.accepted > 0.0 && regularised.is_none();
            self.work_limit = if sought { u64::MAX } else { problem.work };
            let least = problem.regularisation.max(self.settings.least_regularisation * largest);
            if self.work > self.work_limit || epsilon <= least {
                break;
            }
            let smooth = Scheme {
                noise: f64::INFINITY,
                regularisation: epsilon,
                ..scheme
            };
            self.inverted = false;
            // A smoother law that stalls still leads closer.
            if self.newton(problem, &smooth, shear, rough, 1.0).is_ok() && problem.accepted > 0.0 {
                regularised = Some(smooth);
                for (regularised, shear) in self.regularised.iter_mut().zip(&*shear) {
                    regularised.copy_from_slice(shear);
                }
            }
            epsilon *= self.settings.continuation_step;
        }
        self.work_limit = problem.work;
        let mut last = Ok(());
        for noise in [f64::INFINITY, 1e2 * problem.noise, problem.noise] {
            self.inverted = false;
            last = self.newton(problem, &Scheme { noise, ..scheme }, shear, problem.tolerance, 1.0);
        }
        self.remember(shear);
        let Err((iterations, residual)) = last else {
            return Ok(());
        };
        self.left = residual;
        if residual <= problem.accepted {
            // The law of the cells at the last iterate, not at the trial that came after it.
            self.start_rows(problem, &scheme, shear);
            return Ok(());
        }
        if let Some(smooth) = regularised {
            for (shear, regularised) in shear.iter_mut().zip(&self.regularised) {
                shear.copy_from_slice(regularised);
            }
            self.start_contact();
            // Response, slip and μ at that point, which is a solution.
            self.work_limit = u64::MAX;
            let _ = self.newton(problem, &smooth, shear, rough, 1.0);
            self.remember(shear);
            // What this solution leaves of the law itself.
            self.start_rows(problem, &scheme, shear);
            self.left = self.largest_residual(problem.contact.cells());
            self.start_rows(problem, &smooth, shear);
            return Ok(());
        }
        Err(Error::TangentialNotConverged {
            iterations,
            residual,
            tolerance: problem.tolerance,
        })
    }

    /// Notes that `response` is that of this shear.
    fn remember(&mut self, shear: &[Vec<f64>; 2]) {
        for (answered, shear) in self.answered.iter_mut().zip(shear) {
            answered.copy_from_slice(shear);
        }
    }

    /// Solves by Newton's method, from a first guess that is far off to up to `slack` tolerances. The error, where it does not get there,
    /// is the iterations and the residual.
    fn newton(
        &mut self,
        problem: &FrictionProblem,
        scheme: &Scheme,
        shear: &mut [Vec<f64>; 2],
        tolerance: f64,
        slack: f64,
    ) -> std::result::Result<(), (usize, f64)> {
        let n = problem.contact.cells();
        let window = problem.contact.window(problem.grid, 1);
        // Nothing outside the contact is left over from another one.
        for changes in [&mut self.correction, &mut self.correction_response] {
            changes.iter_mut().for_each(|component| component.fill(0.0));
        }
        if !(0..2).all(|component| dense::same(&self.answered[component], &shear[component])) {
            self.work += work_of_product(problem.transform, &window, 2);
            let [x, y] = &mut self.response;
            let load = [&shear[0][..], &shear[1][..]];
            problem
                .transform
                .apply(&problem.response.double, &window, load, [x, y], &mut self.scratch);
        }
        let mut size = self.start_rows(problem, scheme, shear);
        let mut largest = self.largest_residual(n);
        let roughly = (self.settings.reduction * largest).min(slack * tolerance);
        let tolerance = tolerance.max(roughly);
        let mut forcing = f64::from(self.settings.largest_forcing);
        let limit = self.work_limit;
        for iterations in 0..self.settings.newton_steps {
            if largest <= tolerance {
                return Ok(());
            }
            if self.work > limit {
                return Err((iterations, largest));
            }
            self.take_law(problem);
            let fresh = !self.inverted;
            if fresh {
                self.inverted = self.invert_blocks(problem);
            }
            if !self.inverted {
                return Err((iterations, largest));
            }
            let needed = self.settings.forcing_margin * tolerance / largest;
            let solved = self.correct(problem, &window, needed.max(forcing) as f32);
            self.iterations[0] += 1;
            self.iterations[1] += solved.iterations as u64;
            // Kept blocks that no longer serve are inverted anew for the next correction.
            let digits = -f64::from(solved.residual).log10();
            if solved.iterations as f64 > self.settings.renewal * digits.max(LEAST_DIGITS) && !fresh {
                self.inverted = false;
            }
            let size_before = size;
            self.respond_to_correction(problem, &window, tolerance);
            let mut length = 1.0;
            let mut halvings = 0;
            loop {
                let moved = self.update_rows(problem, scheme, shear, length);
                if moved <= (1.0 - 1e-4 * length) * size {
                    size = moved;
                    break;
                }
                if halvings == self.settings.halvings {
                    return Err((iterations, largest));
                }
                halvings += 1;
                length *= 0.5;
            }
            for (component, shear) in shear.iter_mut().enumerate() {
                dense::add_multiple(&self.correction[component], length, shear);
                let change = &self.correction_response[component];
                dense::add_multiple(change, length, &mut self.response[component]);
            }
            if length < 1.0 {
                self.inverted = false;
            }
            largest = self.largest_residual(n);
            // No closer than the law's curvature lets the next step come.
            let ratio = size / size_before;
            forcing = self.settings.forcing * ratio * ratio;
        }
        if largest <= tolerance {
            Ok(())
        } else {
            Err((self.settings.newton_steps, largest))
        }
    }

    /// Computes the response to the last correction: as the sum of the responses to its directions where the error of their single
    /// precision, added to the response to the shear, is far below the tolerance, otherwise as a product in double precision.
    fn respond_to_correction(&mut self, problem: &FrictionProblem, window: &Window, tolerance: f64) {
        let [x, y] = &self.correction;
        let largest = dense::largest(x).max(dense::largest(y));
        if self.settings.single_round_off * largest > tolerance {
            self.work += work_of_product(problem.transform, window, 2);
            let [x, y] = &mut self.correction_response;
            let load = [&self.correction[0][..], &self.correction[1][..]];
            problem
                .transform
                .apply(&problem.response.double, window, load, [x, y], &mut self.scratch);
            return;
        }
        self.directions
            .sum_responses(self.gmres.shares(), problem.grid, window, &mut self.correction_response);
    }

    fn largest_residual(&self, n: usize) -> f64 {
        let [x, y] = &self.rows.residual;
        dense::largest(&x[..n]).max(dense::largest(&y[..n]))
    }

    /// Takes the data of the law that stay while the shear changes, and finds the law of all cells at this shear. Returns the length of the residual.
    fn start_rows(&mut self, problem: &FrictionProblem, scheme: &Scheme, shear: &[Vec<f64>; 2]) -> f64 {
        let n = problem.contact.cells();
        let cells = &mut self.cells;
        cells.bound[..n].copy_from_slice(&problem.bound[..n]);
        for component in 0..2 {
            for index in 0..n {
                self.edge[component][index] = problem.edge[index][component];
                cells.off_middle[component][index] = problem.off_middle[index][component];
            }
        }
        for (scale, edge) in cells.scale.iter_mut().zip(&problem.edge[..n]) {
            *scale = scheme.at_edge(*edge).scale;
        }
        self.update_rows(problem, scheme, shear, 0.0)
    }

    /// Updates the law of all cells to that after `length` times the correction. Returns the length of the residual.
    fn update_rows(&mut self, problem: &FrictionProblem, scheme: &Scheme, shear: &[Vec<f64>; 2], length: f64) -> f64 {
        let n = problem.contact.cells();
        self.move_cells(problem, shear, length);
        let speeds = match &problem.path {
            None => None,
            Some(path) => {
                self.on_path.find_bounds(path, scheme, n, &mut self.cells);
                Some(&mut self.on_path.speeds)
            }
        };
        self.rows.take(&self.cells, scheme, n, speeds);
        let squares = self
            .rows
            .residual
            .iter()
            .map(|residual| dense::dot(&residual[..n], &residual[..n]));
        squares.sum::<f64>().sqrt()
    }

    /// Shear and slip of all cells after `length` times the correction.
    fn move_cells(&mut self, problem: &FrictionProblem, shear: &[Vec<f64>; 2], length: f64) {
        let Friction {
            cells,
            edge,
            correction,
            correction_response,
            response,
            slips,
            ..
        } = self;
        let (grid, n) = (problem.grid, problem.contact.cells());
        let forward = problem.response.forward;
        dense::vectorised(
            #[inline(always)]
            |_| {
                for component in 0..2 {
                    let shear = (&shear[component][..], &correction[component][..]);
                    let response = (&response[component][..], &correction_response[component][..]);
                    let free_slip = problem.free_slip[component];
                    for run in problem.contact.runs() {
                        let places = run.places(grid);
                        move_along(
                            shear,
                            places.clone(),
                            length,
                            &mut cells.shear[component][run.indices()],
                        );
                        // Slip between the cells and at either end: ahead of one cell it is that behind the next one.
                        let between = if forward {
                            places.start - 1..places.end
                        } else {
                            places.start..places.end + 1
                        };
                        let slips = &mut slips[..=run.cells];
                        move_along(response, between.clone(), length, slips);
                        for (slip, free) in slips.iter_mut().zip(&free_slip[between]) {
                            *slip += free;
                        }
                        let (to_rear, to_front) = (&slips[..run.cells], &slips[1..]);
                        let (ahead, behind) = if forward {
                            (to_front, to_rear)
                        } else {
                            (to_rear, to_front)
                        };
                        cells.ahead[component][run.indices()].copy_from_slice(ahead);
                        cells.behind[component][run.indices()].copy_from_slice(behind);
                    }
                    let shear = &cells.shear[component][..n];
                    for ((slip, edge), shear) in cells.ahead[component].iter_mut().zip(&edge[component]).zip(shear) {
                        *slip += edge * shear;
                    }
                }
            },
        );
    }

    /// Takes the linearised law of the cells in single precision, for the blocks and for corrections.
    fn take_law(&mut self, problem: &FrictionProblem) {
        let n = problem.contact.cells();
        self.law.take(&self.rows, &self.edge, n);
        if let Some(path) = &problem.path {
            self.on_path.take_links(path, &self.rows, &self.edge, n);
        }
    }

    /// Inverts the strips' blocks of the law that was taken. False where one is singular.
    fn invert_blocks(&mut self, problem: &FrictionProblem) -> bool {
        let response = problem.response;
        let own = StripResponse {
            along: &response.strip_kernels[0],
            across: &response.strip_kernels[1],
            origin: response.origin,
            behind: if response.forward { -1 } else { 1 },
        };
        // The count of a factorisation, with which the budget of a step was chosen. An inversion has three times as many multiplications,
        // but takes no longer, and the count is a measure of time.
        self.work += work_of_blocks(problem.contact, 3) / 3;
        self.iterations[2] += 1;
        self.blocks.invert(problem.contact, &self.law, &own)
    }

    /// Computes the correction of the shear on the grid by the law that was taken.
    fn correct(&mut self, problem: &FrictionProblem, window: &Window, tolerance: f32) -> Solved {
        let n = problem.contact.cells();
        for (step, residual) in self.step.chunks_exact_mut(n.max(1)).zip(&self.rows.residual) {
            for (step, residual) in step.iter_mut().zip(residual) {
                *step = -residual as f32;
            }
        }
        let Friction {
            gmres,
            directions,
            blocks,
            law,
            step,
            product,
            load_single,
            scratch_single,
            settings,
            on_path,
            ..
        } = self;
        let tolerance = tolerance.clamp(settings.least_forcing, settings.largest_forcing);
        for component in load_single.iter_mut() {
            component.fill(0.0);
        }
        let behind = if problem.response.forward { -1 } else { 1 };
        let mut number = 0;
        let multiply = |direction: &[f32], out: &mut [f32]| {
            let (shear, mut response) = directions.at(number, 2 * n);
            number += 1;
            shear[..2 * n].copy_from_slice(direction);
            blocks.solve(&mut shear[..2 * n]);
            let (along, across) = (&shear[..n + WIDTH], &shear[n..]);
            problem.contact.scatter(problem.grid, along, &mut load_single[0]);
            problem.contact.scatter(problem.grid, across, &mut load_single[1]);
            {
                let [x, y] = &mut response;
                let load = [&load_single[0][..], &load_single[1][..]];
                problem
                    .transform
                    .apply(&problem.response.single, window, load, [x, y], scratch_single);
            }
            let change = Change {
                shear: [along, across],
                slip: [&*response[0], &*response[1]],
                behind,
            };
            let [product_along, product_across] = &mut *product;
            law.multiply(problem.contact, problem.grid, &change, [product_along, product_across]);
            let (out_along, out_across) = out.split_at_mut(n);
            out_along.copy_from_slice(&product_along[..n]);
            out_across.copy_from_slice(&product_across[..n]);
            if let Some(path) = &problem.path {
                on_path.add_linked(path, (problem.contact, problem.grid), &change, [out_along, out_across]);
            }
        };
        let step = &mut step[..2 * n];
        let solved = gmres.solve(step, tolerance, multiply);
        directions.sum_shears(gmres.shares(), step);
        let product = work_of_product(problem.transform, window, 2) + work_of_blocks(problem.contact, 2);
        let orthogonalisation = (2 * n * solved.iterations) as u64;
        self.work += solved.iterations as u64 * (product + orthogonalisation);
        for component in 0..2 {
            let values = self.step[component * n..(component + 1) * n].iter();
            for (place, value) in problem.contact.places(problem.grid).zip(values) {
                self.correction[component][place] = f64::from(*value);
            }
        }
        solved
    }

    /// Coefficients μ of the cells of the last solve, where μ depends on slip, and the magnitude of the law's slip velocity, `m/s`.
    pub fn of_slip(&self) -> (&[NodeFriction], &[f64]) {
        (&self.on_path.friction, &self.on_path.speeds.speed)
    }

    /// Response of the slip ahead of the cells on the grid, x and y, to the shear of the last solve, without the correction at the leading
    /// edge.
    pub fn response(&self) -> &[Vec<f64>; 2] {
        &self.response
    }
}

#[cfg(test)]
mod tests;
