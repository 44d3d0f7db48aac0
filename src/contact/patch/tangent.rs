//! The change of the tractions with inputs, temperature and wear, at the solution of a step: pressure, then friction, each as the
//! linear system that its solver solves last.
//!
//! It has solvers and tables of its own, so that it starts from the fields alone, whatever a step has left in its solvers.

use super::expansion;
use super::fields::PatchFields;
use super::memory;
use super::operators::PatchOperators;
use super::problem::PatchProblem;
use super::response;
use super::solvers::{PatchSolvers, PathScratch};
use crate::body::influence::{self, Window};
use crate::contact::engine::{Along, Direction};
use crate::contact::interface::Interface;
use crate::contact::memory as path_memory;
use crate::error::Result;
use crate::friction::path::PathLaw;
use crate::heat::strips::StripHeatScratch;
use crate::heat::surface::{ExchangeTangent, SurfaceExchange};
use crate::mechanics::kinematics::{SlipWeights, rigid_slip};
use crate::mechanics::normal::normal_problem::Constraint;
use crate::mechanics::patch::contact::Contact;
use crate::mechanics::patch::friction::{
    Friction, FrictionChange, FrictionProblem, LEAST_CHANGE, PathOfCells, SlipResponse,
};
use crate::mechanics::patch::law::Vector;
use crate::mechanics::patch::normal::{Normal, PatchNormalProblem};
use crate::numerics::dense::{add_multiple, largest};
use crate::settings::Settings;

/// Linearised mechanics: solvers, the point at which they are linearised, and buffers.
pub struct PatchTangent {
    contact: Contact,
    normal: Normal,
    friction: Friction,
    response: SlipResponse,
    products: influence::ProductScratch<f64>,
    weights: SlipWeights,
    /// Constants r, w, ε of the friction law, the same for all cells.
    scheme: [f64; 3],
    /// Slip ahead of the cells without what the leading edge adds, on the grid, `m/s`.
    slip: [Vec<f64>; 2],
    /// Separation of the cells, on the grid, scaled.
    separation: Vec<f64>,
    /// Coulomb's bound μp of the cells under pressure, scaled.
    bound: Vec<f64>,
    /// Slip per shear that the leading edge adds to the cells under pressure, along x and y, `m/s`.
    edge: Vec<Vector>,
    /// Change of the gap, on the grid, scaled.
    gap: Vec<f64>,
    /// Change of the displacement u that does not come from shear, on the grid, scaled.
    given: [Vec<f64>; 2],
    /// Change of the slip ahead of the cells at an unchanged shear, without what the leading edge adds, on the grid, `m/s`.
    free_slip: [Vec<f64>; 2],
    /// Change of Coulomb's bound of the cells under pressure, scaled.
    bound_change: Vec<f64>,
    /// Change of the slip per shear that the leading edge adds to the cells under pressure, `m/s`.
    edge_change: Vec<Vector>,
    expansion: expansion::ExpansionBuffers,
    nothing: Vec<f64>,
    /// Law of friction along a path; none where friction does not depend on slip.
    path_law: Option<PathLaw>,
    /// Friction law of the cells under pressure where friction depends on slip.
    path: PathScratch,
    /// Change of μ of all cells at unchanged slip.
    friction_change: Vec<f64>,
    /// Heat march, change of the wear rate, surface exchange at the solution and its change.
    pub(super) heat: StripHeatScratch,
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
            contact: Contact::new(grid),
            normal: Normal::new(grid, transform, settings.patch),
            friction: Friction::new(grid, transform, settings.patch),
            response: response::none(operators),
            products: transform.scratch(),
            weights: SlipWeights::default(),
            scheme: [0.0; 3],
            slip: vectors(),
            separation: on_grid(),
            bound: on_grid(),
            edge: vec![[0.0; 2]; grid.len()],
            gap: on_grid(),
            given: vectors(),
            free_slip: vectors(),
            bound_change: on_grid(),
            edge_change: vec![[0.0; 2]; grid.len()],
            expansion: expansion::ExpansionBuffers::new(grid, transform),
            nothing: on_grid(),
            path_law: None,
            path: PathScratch::new(grid.strips * grid.cells),
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
    pub fn linearise(
        &mut self,
        problem: &PatchProblem,
        interface: &Interface,
        fields: &PatchFields,
        solvers: &PatchSolvers,
    ) -> Result<()> {
        let (operators, grid) = (problem.operators, &problem.operators.grid);
        self.contact.list(grid, |place| fields.pressure[place] > 0.0);
        self.weights = problem.slip_weights(problem.transient(fields.relaxation_length));
        response::adapt(
            problem,
            &self.weights,
            problem.operators.grid.strips,
            &mut self.response,
        );
        self.separate(problem, interface, fields, solvers);
        let ahead = leading(problem);
        for (component, slip) in self.slip.iter_mut().enumerate() {
            let now = &fields.displacement[component];
            let before = &solvers.before[component];
            for strip in 0..grid.strips {
                for cell in problem.cells_with_next() {
                    let place = grid.place(strip, cell);
                    let next = place.wrapping_add_signed(ahead);
                    let rigid = problem.rigid_slip(grid.x(cell) + 0.5 * ahead as f64 * grid.length, grid.y(strip));
                    let displaced = self
                        .weights
                        .displaced([now[place], now[next]], [before[place], before[next]]);
                    slip[place] = rigid[component] + displaced;
                }
            }
        }
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
        let own = f64::from(self.response.strip_kernels[0][self.response.origin]);
        // At rest without a step before there is the law for the slip ahead, and no response to it.
        self.scheme = if own == 0.0 {
            [1.0, f64::INFINITY, problem.parameters.slip_regularisation]
        } else {
            let noise = problem.settings.patch.noise * own * largest(&fields.pressure);
            [1.0 / own, noise, problem.parameters.slip_regularisation]
        };
        self.path_law = problem.path_law();
        if let Some(law) = &self.path_law {
            let contact = (&self.contact, &fields.pressure[..]);
            memory::prepare(problem, law, contact, fields, &mut self.path);
        }
        let law = friction_problem(
            problem,
            (&self.contact, &self.response, self.scheme),
            (&self.edge, &self.bound, path_of_cells(self.path_law, &self.path)),
            &self.slip,
        );
        self.friction.linearise(&law, &fields.shear)
    }

    /// Computes the separation of the cells.
    fn separate(
        &mut self,
        problem: &PatchProblem,
        interface: &Interface,
        fields: &PatchFields,
        solvers: &PatchSolvers,
    ) {
        let (operators, grid) = (problem.operators, &problem.operators.grid);
        for strip in 0..grid.strips {
            for (cell, place) in grid.row(strip).enumerate() {
                let index = strip * grid.cells + cell;
                self.gap[place] = operators.gap[place] + interface.gap()[index] - interface.displacement()[index];
            }
        }
        let data = normal_problem(problem, &self.gap, &solvers.wear_compliance, problem.constraint(), 0.0);
        self.normal
            .separation_of(&data, &self.contact, &fields.pressure, fields.penetration);
        self.separation.copy_from_slice(&self.normal.separation);
    }

    /// Moves the change of tractions, friction coefficient and slip from the given one, a first guess, to that under the given change
    /// of the interface vector.
    ///
    /// # Errors
    /// [`crate::error::Error::NormalNotConverged`], [`crate::error::Error::TangentialNotConverged`].
    pub fn tractions(
        &mut self,
        problem: &PatchProblem,
        (interface, fields, solvers): (&Interface, &PatchFields, &PatchSolvers),
        along: &Along,
        tangent: &mut PatchFields,
        tolerance: f64,
    ) -> Result<()> {
        let (operators, grid, direction) = (problem.operators, &problem.operators.grid, along.direction);
        let iterate = along.interface;
        let law = problem.friction();
        for strip in 0..grid.strips {
            for (cell, place) in grid.row(strip).enumerate() {
                let index = strip * grid.cells + cell;
                self.gap[place] = iterate.gap()[index] - iterate.displacement()[index];
                let touches = fields.pressure[place] > 0.0;
                let static_friction = if touches || self.path_law.is_some() {
                    let changes = [
                        iterate.temperature(index),
                        direction.inputs.ambient_temperature,
                        direction.inputs.friction_scale,
                    ];
                    law.coefficient_tangent(interface.temperature(index), changes)
                } else {
                    0.0
                };
                tangent.memory.now.static_friction[index] = static_friction;
                tangent.friction[place] = if touches { static_friction } else { 0.0 };
            }
        }
        let total = direction.inputs.normal_load / problem.unit_force();
        let constraint = match problem.constraint() {
            Constraint::Total(_) => Constraint::Total(total),
            Constraint::Penetration(_) => Constraint::Penetration(0.0),
        };
        let size = [
            largest(&tangent.pressure),
            largest(&self.gap) / operators.normal_influence.diagonal,
            total.abs() / self.contact.cells() as f64,
        ];
        let size = size.into_iter().fold(LEAST_CHANGE, f64::max);
        let data = normal_problem(
            problem,
            &self.gap,
            &solvers.wear_compliance,
            constraint,
            tolerance * size,
        );
        tangent.penetration = self.normal.tangent(&data, &self.contact, &mut tangent.pressure)?;
        self.edges(problem, fields, direction, tangent);
        if let Some(path_law) = &self.path_law {
            path_memory::tangent(
                problem,
                path_law,
                fields,
                direction.speed,
                &tangent.memory.now.static_friction,
                Some(&tangent.pressure),
                &mut self.friction_change,
            );
            for run in self.contact.runs() {
                let first = run.strip * grid.cells + run.first;
                tangent.friction[run.places(grid)].copy_from_slice(&self.friction_change[first..first + run.cells]);
            }
        }
        for (index, place) in self.contact.places(grid).enumerate() {
            self.bound_change[index] =
                tangent.friction[place] * fields.pressure[place] + fields.friction[place] * tangent.pressure[place];
        }
        self.free_slip(problem, (fields, solvers), along, &tangent.pressure);
        let path = path_of_cells(self.path_law, &self.path);
        let law = friction_problem(
            problem,
            (&self.contact, &self.response, self.scheme),
            (&self.edge, &self.bound, path),
            &self.slip,
        );
        let change = FrictionChange {
            free_slip: [&self.free_slip[0], &self.free_slip[1]],
            edge: &self.edge_change,
            bound: &self.bound_change,
            noise: self.noise(problem, fields, direction, &tangent.pressure),
            tolerance,
        };
        self.friction
            .tangent(&law, &fields.shear, &change, &mut tangent.shear)?;
        if let Some(path) = &path {
            let places: Vec<usize> = self.contact.places(grid).collect();
            self.friction.friction_changes(path, places.len(), |index, friction| {
                tangent.friction[places[index]] += friction;
            });
        }
        self.mean_slip(problem, fields, tangent);
        Ok(())
    }

    /// Change of the slip w that does not count as slip: w follows the response of a cell to its own shear, and the peak pressure.
    fn noise(&self, problem: &PatchProblem, fields: &PatchFields, direction: &Direction, pressure: &[f64]) -> f64 {
        let [_, noise, _] = self.scheme;
        if !noise.is_finite() {
            return 0.0;
        }
        let (kernel, origin) = (&problem.operators.strip_kernels[0], self.response.origin);
        let weights = problem.slip_weights_tangent(fields, direction.speed);
        let next = kernel[origin.wrapping_add_signed(leading(problem))];
        let own_change = weights.strain * (kernel[origin] - next) + weights.change * kernel[origin];
        let own = f64::from(self.response.strip_kernels[0][origin]);
        let places = self.contact.places(&problem.operators.grid);
        let peak = places.max_by(|a, b| fields.pressure[*a].total_cmp(&fields.pressure[*b]));
        let pressure = peak.map_or(0.0, |place| pressure[place] / fields.pressure[place]);
        noise * (own_change / own + pressure)
    }

    /// Computes the change of the slip per shear that the leading edge adds.
    fn edges(&mut self, problem: &PatchProblem, fields: &PatchFields, direction: &Direction, tangent: &PatchFields) {
        let ahead = leading(problem);
        let strain_speed = problem.slip_weights_tangent(fields, direction.speed).strain_speed;
        self.edge_change[..self.contact.cells()].fill([0.0; 2]);
        for run in self.contact.runs() {
            let (index, place) = leading_cell(problem, run);
            let next = place.wrapping_add_signed(ahead);
            let (gap, pressure) = (self.separation[next], fields.pressure[place]);
            let (gap_change, pressure_change) = (self.normal.separation[next], tangent.pressure[place]);
            let change = strain_speed * problem.separation_ratio(gap, pressure)
                + self.weights.strain_speed
                    * problem.separation_ratio_tangent(gap, pressure, gap_change, pressure_change);
            self.edge_change[index] = problem.operators.edge_factors.map(|factor| factor * change);
        }
    }

    /// Computes the change of the slip ahead of the cells at an unchanged shear, but for the leading edge.
    fn free_slip(
        &mut self,
        problem: &PatchProblem,
        (fields, solvers): (&PatchFields, &PatchSolvers),
        along: &Along,
        pressure: &[f64],
    ) {
        let (direction, iterate) = (along.direction, along.interface);
        let (operators, grid) = (problem.operators, &problem.operators.grid);
        self.given.iter_mut().for_each(|component| component.fill(0.0));
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
                    let x = grid.x(cell) + 0.5 * ahead as f64 * grid.length;
                    self.free_slip[component][place] = rigid_slip(&direction.motion, x, grid.y(strip))[component]
                        + self.weights.displaced([given[place], given[next]], [0.0; 2])
                        + weights_change.displaced([now[place], now[next]], [before[place], before[next]]);
                }
            }
        }
    }

    /// Computes the change of the slip at the centres of the cells.
    fn mean_slip(&self, problem: &PatchProblem, fields: &PatchFields, tangent: &mut PatchFields) {
        let grid = &problem.operators.grid;
        let behind = -leading(problem);
        for run in self.contact.runs() {
            for (index, place) in run.indices().zip(run.places(grid)) {
                let last = place.wrapping_add_signed(behind);
                let (ahead, last_response) = (self.friction.response_at(place), self.friction.response_at(last));
                for component in 0..2 {
                    let free = &self.free_slip[component];
                    let edge = self.edge[index][component] * tangent.shear[component][place]
                        + self.edge_change[index][component] * fields.shear[component][place];
                    tangent.slip[component][place] =
                        0.5 * (free[place] + ahead[component] + edge + free[last] + last_response[component]);
                }
            }
        }
    }
}

/// 1 where the leading side is that of +x, −1 else.
fn leading(problem: &PatchProblem) -> isize {
    if problem.is_forward() { 1 } else { -1 }
}

/// The leading cell of a run among all cells, and its place.
fn leading_cell(problem: &PatchProblem, run: &crate::mechanics::patch::contact::CellRun) -> (usize, usize) {
    let last = if problem.is_forward() { run.cells - 1 } else { 0 };
    (run.offset + last, run.places(&problem.operators.grid).start + last)
}

fn normal_problem<'a>(
    problem: &PatchProblem<'a>,
    gap: &'a [f64],
    wear_compliance: &'a [f64],
    constraint: Constraint,
    tolerance: f64,
) -> PatchNormalProblem<'a> {
    PatchNormalProblem {
        grid: &problem.operators.grid,
        transform: &problem.operators.transform,
        normal_influence: &problem.operators.normal_influence,
        gap,
        wear_compliance,
        constraint,
        tolerance,
    }
}

fn path_of_cells(law: Option<PathLaw>, scratch: &PathScratch) -> Option<PathOfCells<'_>> {
    law.map(|law| PathOfCells {
        law,
        nodes: &scratch.nodes,
        pressure: &scratch.pressure,
    })
}

fn friction_problem<'a>(
    problem: &PatchProblem<'a>,
    (contact, response, [scale, noise, regularisation]): (&'a Contact, &'a SlipResponse, [f64; 3]),
    (edge, bound, path): (&'a [Vector], &'a [f64], Option<PathOfCells<'a>>),
    slip: &'a [Vec<f64>; 2],
) -> FrictionProblem<'a> {
    FrictionProblem {
        grid: &problem.operators.grid,
        transform: &problem.operators.transform,
        contact,
        response,
        edge,
        free_slip: [&slip[0], &slip[1]],
        bound,
        path,
        scale,
        noise,
        regularisation,
        tolerance: 0.0,
    }
}
