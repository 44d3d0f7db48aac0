//! Point at which the mechanics of a patch are linearised: contact, slip and law of the cells at the solution of a step.

use super::centroid;
use super::fields::PatchFields;
use super::memory;
use super::operators::PatchOperators;
use super::problem::PatchProblem;
use super::response;
use super::solvers::{PatchSolvers, PathScratch};
use crate::contact::interface::Interface;
use crate::friction::path::PathLaw;
use crate::mechanics::kinematics::SlipWeights;
use crate::mechanics::patch::contact::{CellRun, Contact};
use crate::mechanics::patch::friction::{FrictionProblem, PathOfCells, SlipResponse};
use crate::mechanics::patch::law::Vector;
use crate::mechanics::patch::normal::Normal;
use crate::numerics::dense::largest;

/// Solution of a step at which its mechanics are linearised.
#[derive(Clone, Copy)]
pub struct Solution<'a> {
    /// Interface vector that the tractions were solved for.
    pub interface: &'a Interface,
    /// Fields at the end of the step.
    pub fields: &'a PatchFields,
    /// Solvers of the step, with the displacement before it and the wear compliance.
    pub solvers: &'a PatchSolvers,
}

/// Contact, slip and law of the cells at a solution.
pub struct Linearisation {
    pub(super) contact: Contact,
    pub(super) response: SlipResponse,
    pub(super) weights: SlipWeights,
    /// Constants r, w, ε of the friction law, the same for all cells.
    pub(super) scheme: [f64; 3],
    /// Slip ahead of the cells without what the leading edge adds, on the grid, `m/s`.
    slip: [Vec<f64>; 2],
    /// Separation of the cells, on the grid, scaled.
    pub(super) separation: Vec<f64>,
    /// Coulomb's bound μp of the cells under pressure, scaled.
    bound: Vec<f64>,
    /// Slip per shear that the leading edge adds to the cells under pressure, along x and y, `m/s`.
    pub(super) edge: Vec<Vector>,
    /// Loads of the strips, scaled.
    pub(super) loads: Vec<f64>,
    /// Slip at the centroid of a strip's load over that in the strip's middle, of the cells under pressure, `m/s`.
    off_middle: Vec<Vector>,
    /// Law of friction along a path; none where friction does not depend on slip.
    pub(super) path_law: Option<PathLaw>,
    /// Friction law of the cells under pressure where friction depends on slip.
    path: PathScratch,
}

impl Linearisation {
    /// Buffers for the given operators.
    pub fn new(operators: &PatchOperators) -> Linearisation {
        let grid = &operators.grid;
        let on_grid = || vec![0.0; grid.len()];
        Linearisation {
            contact: Contact::new(grid),
            response: response::none(operators),
            weights: SlipWeights::default(),
            scheme: [0.0; 3],
            slip: [on_grid(), on_grid()],
            separation: on_grid(),
            bound: on_grid(),
            edge: vec![[0.0; 2]; grid.len()],
            loads: vec![0.0; grid.strips],
            off_middle: vec![[0.0; 2]; grid.len()],
            path_law: None,
            path: PathScratch::new(grid.strips * grid.cells),
        }
    }

    /// Sets the point to a solution, which must have a contact. `normal` and `gap` are buffers.
    pub fn set(&mut self, problem: &PatchProblem, solution: Solution, normal: &mut Normal, gap: &mut [f64]) {
        let Solution { fields, solvers, .. } = solution;
        self.contact
            .list(&problem.operators.grid, |place| fields.pressure[place] > 0.0);
        self.weights = problem.slip_weights(problem.transient(fields.relaxation_length));
        response::adapt(
            problem,
            &self.weights,
            problem.operators.grid.strips,
            &mut self.response,
        );
        self.set_separation(problem, solution, normal, gap);
        self.set_slip(problem, fields, solvers);
        self.set_bounds(problem, fields);
        self.set_off_middle(problem, fields, solvers);
        self.set_scheme(problem, fields);
        self.path_law = problem.path_law();
        if let Some(law) = &self.path_law {
            memory::prepare(problem, law, &self.contact, &fields.pressure, fields, &mut self.path);
        }
    }

    /// Sets the separation of the cells.
    fn set_separation(&mut self, problem: &PatchProblem, solution: Solution, normal: &mut Normal, gap: &mut [f64]) {
        let Solution {
            interface,
            fields,
            solvers,
        } = solution;
        let grid = &problem.operators.grid;
        for strip in 0..grid.strips {
            for (cell, place) in grid.row(strip).enumerate() {
                let index = strip * grid.cells + cell;
                gap[place] = solvers.undeformed.gap[place] + interface.gap()[index] - interface.displacement()[index];
            }
        }
        let data = problem.normal_problem(gap, &solvers.wear_compliance, problem.constraint());
        normal.separation_of(&data, &self.contact, &fields.pressure, fields.penetration);
        self.separation.copy_from_slice(&normal.separation);
    }

    /// Sets the slip ahead of the cells.
    fn set_slip(&mut self, problem: &PatchProblem, fields: &PatchFields, solvers: &PatchSolvers) {
        let grid = &problem.operators.grid;
        let ahead = leading(problem);
        for (component, slip) in self.slip.iter_mut().enumerate() {
            let now = &fields.displacement[component];
            let before = &solvers.before[component];
            for strip in 0..grid.strips {
                for cell in problem.cells_with_next() {
                    let place = grid.place(strip, cell);
                    let next = place.wrapping_add_signed(ahead);
                    let displaced = self
                        .weights
                        .displaced([now[place], now[next]], [before[place], before[next]]);
                    slip[place] = solvers.undeformed.rigid_slip[component][place] + displaced;
                }
            }
        }
    }

    /// Sets Coulomb's bound of the cells, and the slip per shear that the leading edge adds.
    fn set_bounds(&mut self, problem: &PatchProblem, fields: &PatchFields) {
        let (operators, grid) = (problem.operators, &problem.operators.grid);
        let ahead = leading(problem);
        for run in self.contact.runs() {
            for (index, place) in run.indices().zip(run.places(grid)) {
                self.bound[index] = fields.friction[place] * fields.pressure[place];
                self.edge[index] = [0.0; 2];
            }
            let (index, place) = leading_cell(problem, run);
            let ratio = problem.separation_ratio(
                self.separation[place.wrapping_add_signed(ahead)],
                fields.pressure[place],
            );
            self.edge[index] = operators
                .edge_factors
                .map(|factor| self.weights.strain_speed * factor * ratio);
        }
    }

    /// Sets the loads of the strips, and the slip at their centroids over that in the strips' middles.
    fn set_off_middle(&mut self, problem: &PatchProblem, fields: &PatchFields, solvers: &PatchSolvers) {
        let grid = &problem.operators.grid;
        centroid::set_loads(grid, &fields.pressure, &mut self.loads);
        for run in self.contact.runs() {
            let centroid = centroid::centroid(&self.loads, run.strip);
            for (index, place) in run.indices().zip(run.places(grid)) {
                self.off_middle[index] = solvers.undeformed.slip_off_middle(grid, place, centroid);
            }
        }
    }

    /// Sets the constants of the law. At rest without a step before there is the law for the slip ahead, and no response to it.
    fn set_scheme(&mut self, problem: &PatchProblem, fields: &PatchFields) {
        let diagonal = self.diagonal();
        self.scheme = if diagonal == 0.0 {
            [1.0, f64::INFINITY, problem.parameters.slip_regularisation]
        } else {
            let noise = problem.settings.patch.noise * diagonal * largest(&fields.pressure);
            [1.0 / diagonal, noise, problem.parameters.slip_regularisation]
        };
    }

    /// Response of the slip of a cell to its own shear, `m/s`.
    pub fn diagonal(&self) -> f64 {
        f64::from(self.response.strip_kernels[0][self.response.origin])
    }

    /// Law of the cells where friction depends on slip.
    pub fn path(&self) -> Option<PathOfCells<'_>> {
        self.path_law.map(|law| PathOfCells {
            law,
            nodes: &self.path.nodes,
            pressure: &self.path.pressure,
        })
    }

    /// Friction problem at this point.
    pub fn friction_problem<'a>(&'a self, problem: &PatchProblem<'a>) -> FrictionProblem<'a> {
        let [scale, noise, regularisation] = self.scheme;
        FrictionProblem {
            grid: &problem.operators.grid,
            transform: &problem.operators.transform,
            contact: &self.contact,
            response: &self.response,
            edge: &self.edge,
            off_middle: &self.off_middle,
            free_slip: [&self.slip[0], &self.slip[1]],
            bound: &self.bound,
            path: self.path(),
            scale,
            noise,
            regularisation,
            tolerance: 0.0,
            accepted: 0.0,
            work: u64::MAX,
        }
    }
}

/// 1 where the leading side is that of +x, −1 else.
pub fn leading(problem: &PatchProblem) -> isize {
    if problem.is_forward() { 1 } else { -1 }
}

/// Leading cell of a run among all cells, and its place.
pub fn leading_cell(problem: &PatchProblem, run: &CellRun) -> (usize, usize) {
    let last = if problem.is_forward() { run.cells - 1 } else { 0 };
    (run.offset + last, run.places(&problem.operators.grid).start + last)
}
