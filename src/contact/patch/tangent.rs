//! The change of the tractions with inputs, temperature and wear, at the solution of a step: pressure, then friction, each as the
//! linear system that its solver solves last.
//!
//! It has solvers and tables of its own, so that it starts from the fields alone, whatever a step has left in its solvers.

use super::centroid;
use super::expansion;
use super::fields::PatchFields;
use super::linearisation::{Linearisation, Solution, leading, leading_cell};
use super::operators::PatchOperators;
use super::problem::PatchProblem;
use super::solvers::PatchSolvers;
use super::undeformed::Undeformed;
use crate::body::influence::{self, Window};
use crate::contact::engine::{Along, Direction};
use crate::contact::memory as path_memory;
use crate::error::Result;
use crate::heat::strips::StripHeatScratch;
use crate::heat::surface::{ExchangeTangent, SurfaceExchange};
use crate::mechanics::normal::normal_problem::Constraint;
use crate::mechanics::patch::friction::{Friction, FrictionChange, LEAST_CHANGE};
use crate::mechanics::patch::law::Vector;
use crate::mechanics::patch::normal::{Normal, PatchNormalProblem};
use crate::numerics::dense::{add_multiple, largest};
use crate::settings::Settings;

/// Linearised mechanics: solvers, the point at which they are linearised, and buffers.
pub struct PatchTangent {
    /// Point at which the mechanics are linearised.
    point: Linearisation,
    normal: Normal,
    friction: Friction,
    products: influence::ProductScratch<f64>,
    /// Change of gap and rigid slip of the undeformed bodies along the direction.
    pub(in crate::contact) undeformed: Undeformed,
    /// Change of the gap with heat and wear, on the grid, scaled.
    gap: Vec<f64>,
    /// Change of the displacement u by the shear of contacts beside this one, on the grid, scaled.
    pub(in crate::contact) beside: [Vec<f64>; 2],
    /// Change of the displacement u that does not come from the shear of this contact, on the grid, scaled.
    given: [Vec<f64>; 2],
    /// Change of the slip ahead of the cells at an unchanged shear, without what the leading edge adds, on the grid, `m/s`.
    free_slip: [Vec<f64>; 2],
    /// Change of Coulomb's bound of the cells under pressure, scaled.
    bound_change: Vec<f64>,
    /// Change of the slip per shear that the leading edge adds to the cells under pressure, `m/s`.
    edge_change: Vec<Vector>,
    /// Change of the loads of the strips, scaled.
    load_change: Vec<f64>,
    /// Change of the slip at the centroid of a strip's load over that in the strip's middle, of the cells under pressure, `m/s`.
    off_middle_change: Vec<Vector>,
    expansion: expansion::ExpansionBuffers,
    nothing: Vec<f64>,
    /// Change of μ of all cells at unchanged slip.
    friction_change: Vec<f64>,
    /// Heat march, change of the wear rate, surface exchange at the solution and its change.
    pub(in crate::contact) heat: StripHeatScratch,
    pub(super) wear_rate: Vec<f64>,
    pub(super) exchange: Vec<SurfaceExchange>,
    pub(super) exchange_change: Vec<ExchangeTangent>,
}

impl PatchTangent {
    /// Solvers and buffers for the given operators.
    pub fn new(operators: &PatchOperators, settings: &Settings) -> PatchTangent {
        let (grid, transform) = (&operators.grid, &operators.transform);
        let on_grid = || vec![0.0; grid.len()];
        let vectors = || [on_grid(), on_grid()];
        PatchTangent {
            point: Linearisation::new(operators),
            normal: Normal::new(grid, transform, settings.patch),
            friction: Friction::new(grid, transform, settings.patch),
            products: transform.scratch(),
            undeformed: Undeformed::none(grid),
            gap: on_grid(),
            beside: vectors(),
            given: vectors(),
            free_slip: vectors(),
            bound_change: on_grid(),
            edge_change: vec![[0.0; 2]; grid.len()],
            load_change: vec![0.0; grid.strips],
            off_middle_change: vec![[0.0; 2]; grid.len()],
            expansion: expansion::ExpansionBuffers::new(grid, transform),
            nothing: on_grid(),
            friction_change: vec![0.0; grid.strips * grid.cells],
            heat: StripHeatScratch::new(&operators.basis, &operators.strips),
            wear_rate: vec![0.0; grid.strips * grid.cells],
            exchange: vec![SurfaceExchange::default(); grid.strips * grid.cells],
            exchange_change: vec![ExchangeTangent::default(); grid.strips * grid.cells],
        }
    }

    /// Linearises at the fields, the solution of the problem; they must have a contact.
    ///
    /// # Errors
    /// [`crate::error::Error::SingularContactMatrix`].
    pub fn linearise(&mut self, problem: &PatchProblem, solution: Solution) -> Result<()> {
        self.point.set(problem, solution, &mut self.normal, &mut self.gap);
        self.friction
            .linearise(&self.point.friction_problem(problem), &solution.fields.shear)
    }

    /// Moves the change of tractions, friction coefficient and slip from the given one, a first guess, to that under the given change
    /// of the interface vector and of the load or the penetration.
    ///
    /// # Errors
    /// [`crate::error::Error::NormalNotConverged`], [`crate::error::Error::TangentialNotConverged`].
    pub fn tractions(
        &mut self,
        problem: &PatchProblem,
        solution: Solution,
        along: &Along,
        constraint: Constraint,
        tangent: &mut PatchFields,
        tolerance: f64,
    ) -> Result<()> {
        let Solution {
            interface,
            fields,
            solvers,
        } = solution;
        let (operators, grid, direction) = (problem.operators, &problem.operators.grid, along.direction);
        let iterate = along.interface;
        for strip in 0..grid.strips {
            let law = problem.friction_at(strip);
            let scale_change = direction.inputs.friction_scale * problem.gauge_face_factor(strip);
            for (cell, place) in grid.row(strip).enumerate() {
                let index = strip * grid.cells + cell;
                self.gap[place] = self.undeformed.gap[place] + iterate.gap()[index] - iterate.displacement()[index];
                let touches = fields.pressure[place] > 0.0;
                let static_friction = if touches || self.point.path_law.is_some() {
                    let changes = [
                        iterate.temperature(index),
                        direction.inputs.ambient_temperature,
                        scale_change,
                    ];
                    law.coefficient_tangent(interface.temperature(index), changes)
                } else {
                    0.0
                };
                tangent.memory.now.static_friction[index] = static_friction;
                tangent.friction[place] = if touches { static_friction } else { 0.0 };
            }
        }
        let given = match constraint {
            Constraint::Total(total) => total / self.point.contact.cells() as f64,
            Constraint::Penetration(penetration) => penetration / operators.normal_influence.diagonal,
        };
        let size = [
            largest(&tangent.pressure),
            largest(&self.gap) / operators.normal_influence.diagonal,
            given.abs(),
        ];
        let size = size.into_iter().fold(LEAST_CHANGE, f64::max);
        let data = PatchNormalProblem {
            tolerance: tolerance * size,
            ..problem.normal_problem(&self.gap, &solvers.wear_compliance, constraint)
        };
        tangent.penetration = self.normal.tangent(&data, &self.point.contact, &mut tangent.pressure)?;
        self.edges(problem, fields, direction, tangent);
        self.off_middle(problem, solvers, &tangent.pressure);
        if let Some(path_law) = &self.point.path_law {
            path_memory::tangent(
                problem,
                path_law,
                fields,
                direction.speed,
                &tangent.memory.now.static_friction,
                Some(&tangent.pressure),
                &mut self.friction_change,
            );
            for run in self.point.contact.runs() {
                let first = run.strip * grid.cells + run.first;
                tangent.friction[run.places(grid)].copy_from_slice(&self.friction_change[first..first + run.cells]);
            }
        }
        for (index, place) in self.point.contact.places(grid).enumerate() {
            self.bound_change[index] =
                tangent.friction[place] * fields.pressure[place] + fields.friction[place] * tangent.pressure[place];
        }
        self.free_slip(problem, solution, along, &tangent.pressure);
        let path = self.point.path();
        let law = self.point.friction_problem(problem);
        let change = FrictionChange {
            free_slip: [&self.free_slip[0], &self.free_slip[1]],
            edge: &self.edge_change,
            off_middle: &self.off_middle_change,
            bound: &self.bound_change,
            noise: self.noise(problem, fields, direction, &tangent.pressure),
            tolerance,
        };
        self.friction
            .tangent(&law, &fields.shear, &change, &mut tangent.shear)?;
        if let Some(path) = &path {
            // The change of the bound has been used: its buffer takes that of μ.
            let change = &mut self.bound_change;
            let contact = &self.point.contact;
            self.friction
                .friction_changes(path, contact.cells(), |index, friction| change[index] = friction);
            for (place, change) in contact.places(grid).zip(&*change) {
                tangent.friction[place] += change;
            }
        }
        self.mean_slip(problem, fields, tangent);
        Ok(())
    }

    /// Change of the slip w that does not count as slip: w follows the response of a cell to its own shear, and the peak pressure.
    fn noise(&self, problem: &PatchProblem, fields: &PatchFields, direction: &Direction, pressure: &[f64]) -> f64 {
        let [_, noise, _] = self.point.scheme;
        if !noise.is_finite() {
            return 0.0;
        }
        let (kernel, origin) = (&problem.operators.strip_kernels[0], self.point.response.origin);
        let weights = problem.slip_weights_tangent(fields, direction.speed);
        let next = kernel[origin.wrapping_add_signed(leading(problem))];
        let diagonal_change = weights.strain * (kernel[origin] - next) + weights.change * kernel[origin];
        let diagonal = self.point.diagonal();
        let places = self.point.contact.places(&problem.operators.grid);
        let peak = places.max_by(|a, b| fields.pressure[*a].total_cmp(&fields.pressure[*b]));
        let pressure = peak.map_or(0.0, |place| pressure[place] / fields.pressure[place]);
        noise * (diagonal_change / diagonal + pressure)
    }

    /// Computes the change of the slip per shear that the leading edge adds.
    fn edges(&mut self, problem: &PatchProblem, fields: &PatchFields, direction: &Direction, tangent: &PatchFields) {
        let ahead = leading(problem);
        let strain_speed = problem.slip_weights_tangent(fields, direction.speed).strain_speed;
        self.edge_change[..self.point.contact.cells()].fill([0.0; 2]);
        for run in self.point.contact.runs() {
            let (index, place) = leading_cell(problem, run);
            let next = place.wrapping_add_signed(ahead);
            let (gap, pressure) = (self.point.separation[next], fields.pressure[place]);
            let (gap_change, pressure_change) = (self.normal.separation[next], tangent.pressure[place]);
            let change = strain_speed * problem.separation_ratio(gap, pressure)
                + self.point.weights.strain_speed
                    * problem.separation_ratio_tangent(gap, pressure, gap_change, pressure_change);
            self.edge_change[index] = problem.operators.edge_factors.map(|factor| factor * change);
        }
    }

    /// Computes the change of the slip at the centroids of the strips' loads over that in the strips' middles.
    fn off_middle(&mut self, problem: &PatchProblem, solvers: &PatchSolvers, pressure: &[f64]) {
        let grid = &problem.operators.grid;
        centroid::set_loads(grid, pressure, &mut self.load_change);
        for run in self.point.contact.runs() {
            let centroid = centroid::centroid(&self.point.loads, run.strip);
            let moves = centroid::centroid_tangent(&self.point.loads, &self.load_change, run.strip);
            // The slip changes linearly on the centroid's side of the middle.
            let side = if centroid == 0.0 { moves } else { centroid }.signum();
            for (index, place) in run.indices().zip(run.places(grid)) {
                let by_slip = self.undeformed.slip_off_middle(grid, place, centroid);
                self.off_middle_change[index] = by_slip;
                if moves != 0.0 {
                    let to_side = solvers.undeformed.slip_off_middle(grid, place, side);
                    self.off_middle_change[index] = [0, 1].map(|i: usize| by_slip[i] + side * moves * to_side[i]);
                }
            }
        }
    }

    /// Computes the change of the slip ahead of the cells at an unchanged shear, but for the leading edge.
    fn free_slip(&mut self, problem: &PatchProblem, solution: Solution, along: &Along, pressure: &[f64]) {
        let (direction, iterate) = (along.direction, along.interface);
        let Solution { fields, solvers, .. } = solution;
        let (operators, grid) = (problem.operators, &problem.operators.grid);
        for (given, beside) in self.given.iter_mut().zip(&self.beside) {
            given.copy_from_slice(beside);
        }
        if let Some(tables) = &operators.coupling {
            let [x, y] = &mut self.given;
            let load = [pressure, &self.nothing[..]];
            let window = Window::whole(grid);
            operators
                .transform
                .apply(tables, &window, load, [x, y], &mut self.products);
        }
        let heat = &mut self.expansion;
        if operators
            .expansion
            .displace(grid, &operators.transform, iterate.displacement(), heat)
        {
            for (given, by_heat) in self.given.iter_mut().zip(&heat.displacement) {
                add_multiple(by_heat, 1.0, given);
            }
        }
        let ahead = leading(problem);
        let weights_change = problem.slip_weights_tangent(fields, direction.speed);
        for component in 0..2 {
            let (now, before) = (&fields.displacement[component], &solvers.before[component]);
            let given = &self.given[component];
            for strip in 0..grid.strips {
                for cell in problem.cells_with_next() {
                    let place = grid.place(strip, cell);
                    let next = place.wrapping_add_signed(ahead);
                    self.free_slip[component][place] = self.undeformed.rigid_slip[component][place]
                        + self.point.weights.displaced([given[place], given[next]], [0.0; 2])
                        + weights_change.displaced([now[place], now[next]], [before[place], before[next]]);
                }
            }
        }
    }

    /// Computes the change of the slip at the centres of the cells.
    fn mean_slip(&self, problem: &PatchProblem, fields: &PatchFields, tangent: &mut PatchFields) {
        let grid = &problem.operators.grid;
        let behind = -leading(problem);
        for run in self.point.contact.runs() {
            for (index, place) in run.indices().zip(run.places(grid)) {
                let last = place.wrapping_add_signed(behind);
                for component in 0..2 {
                    let (free, response) = (&self.free_slip[component], &self.friction.response()[component]);
                    let edge = self.point.edge[index][component] * tangent.shear[component][place]
                        + self.edge_change[index][component] * fields.shear[component][place];
                    tangent.slip[component][place] =
                        0.5 * (free[place] + response[place] + edge + free[last] + response[last]);
                }
            }
        }
    }
}
