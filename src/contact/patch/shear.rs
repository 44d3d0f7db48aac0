//! Shear and slip for the pressure there is: Coulomb's bound of each cell, the slip that it has without its shear, and the shear that goes with
//! both by the law of friction.

use super::centroid;
use super::fields::PatchFields;
use super::memory;
use super::problem::PatchProblem;
use super::solvers::PatchSolvers;
use crate::body::grid::Grid;
use crate::body::influence::Window;
use crate::contact::interface::Interface;
use crate::contact::problem::Coupling;
use crate::error::Result;
use crate::friction::coulomb;
use crate::friction::path::{Passed, PathLaw};
use crate::mechanics::kinematics::SlipWeights;
use crate::mechanics::patch::contact::Contact;
use crate::mechanics::patch::friction::{FrictionProblem, PathOfCells};
use crate::numerics::dense::{self, add_multiple, largest};

/// (10), (30) for given pressure, and the slip that follows.
pub fn solve(
    problem: &PatchProblem,
    interface: &Interface,
    fields: &mut PatchFields,
    solvers: &mut PatchSolvers,
    tolerance: f64,
) -> Result<()> {
    let operators = problem.operators;
    let grid = &operators.grid;
    let weights = problem.slip_weights(problem.transient(fields.relaxation_length));
    let strips = solvers.contact.window(grid, 0).strips.len();
    if strips > solvers.strips {
        // The contact has become broader than it was at the start of the step.
        solvers.friction.start_contact();
        solvers.respond(problem, weights, strips);
    }
    let path_law = problem.path_law();
    match &path_law {
        Some(path_law) => prepare_memory(problem, path_law, interface, fields, solvers),
        None => fields.friction.fill(0.0),
    }
    bounds_and_edges(problem, interface, &weights, fields, solvers);
    keep_within_bounds(grid, &solvers.contact, &solvers.bound, fields, &mut solvers.nothing);
    let peak = largest(&fields.pressure);
    let tolerance = peak * tolerance.max(problem.settings.patch.least_tolerance);
    free_slip(problem, interface, &weights, fields, solvers);
    centroid::set_loads(grid, &fields.pressure, &mut solvers.loads);
    for run in solvers.contact.runs() {
        let centroid = centroid::centroid(&solvers.loads, run.strip);
        for (index, place) in run.indices().zip(run.places(grid)) {
            solvers.off_middle[index] = solvers.undeformed.slip_off_middle(grid, place, centroid);
        }
    }
    let diagonal = f64::from(solvers.response.strip_kernels[0][solvers.response.origin]);
    let path = path_law.map(|law| PathOfCells {
        law,
        nodes: &solvers.path.nodes,
        pressure: &solvers.path.pressure,
    });
    if diagonal == 0.0 {
        slide_on_the_spot(
            problem,
            path.as_ref(),
            &solvers.contact,
            &mut solvers.bound,
            &solvers.free_slip,
            fields,
        );
    } else {
        let friction_problem = FrictionProblem {
            grid,
            transform: operators.transform_for(solvers.strips).0,
            contact: &solvers.contact,
            response: &solvers.response,
            edge: &solvers.edge,
            off_middle: &solvers.off_middle,
            free_slip: [&solvers.free_slip[0], &solvers.free_slip[1]],
            bound: &solvers.bound,
            path,
            scale: 1.0 / diagonal,
            noise: problem.settings.patch.noise * diagonal * peak,
            regularisation: problem.parameters.slip_regularisation,
            tolerance,
            accepted: match problem.conditions.coupling {
                Coupling::Implicit => 0.0,
                Coupling::Staggered | Coupling::Held => peak * problem.settings.patch.staggered_residual,
            },
            work: problem.mechanics_budget(),
        };
        solvers.friction.solve(&friction_problem, &mut fields.shear)?;
        if path.is_some() {
            take_memory(grid, solvers, fields);
        }
    }
    mean_slip(problem, fields, solvers);
    Ok(())
}

/// Prepares what friction with a memory knows of each cell before its slip is known.
fn prepare_memory(
    problem: &PatchProblem,
    path_law: &PathLaw,
    interface: &Interface,
    fields: &mut PatchFields,
    solvers: &mut PatchSolvers,
) {
    let cells = problem.operators.grid.cells;
    let strips = fields.memory.now.static_friction.chunks_exact_mut(cells);
    for (strip, static_friction) in strips.enumerate() {
        let law = problem.friction_at(strip);
        for (cell, static_friction) in static_friction.iter_mut().enumerate() {
            *static_friction = law.coefficient(interface.temperature(strip * cells + cell)).0;
        }
    }
    memory::prepare(
        problem,
        path_law,
        &solvers.contact,
        &fields.pressure,
        fields,
        &mut solvers.path,
    );
}

/// Coulomb's bound, and the leading-edge correction: u jumps out of the contact as the gap does, in the ratio of the tractions.
fn bounds_and_edges(
    problem: &PatchProblem,
    interface: &Interface,
    weights: &SlipWeights,
    fields: &mut PatchFields,
    solvers: &mut PatchSolvers,
) {
    let operators = problem.operators;
    let grid = &operators.grid;
    let forward = problem.is_forward();
    let ahead: isize = if forward { 1 } else { -1 };
    let has_memory = problem.path_law().is_some();
    for run in solvers.contact.runs() {
        let law = problem.friction_at(run.strip);
        let leading = if forward { run.cells - 1 } else { 0 };
        for (k, place) in run.places(grid).enumerate() {
            let index = run.offset + k;
            let cell = run.first + k;
            let temperature = interface.temperature(run.strip * grid.cells + cell);
            let mut mu = law.coefficient(temperature).0;
            if has_memory {
                // The bound of the first guess. Rail that cools remembers a smaller μ than its static one, rail that warms a larger one.
                mu = mu.max(fields.friction[place]);
            }
            fields.friction[place] = mu;
            solvers.bound[index] = mu * fields.pressure[place];
            solvers.edge[index] = if k == leading {
                let gap = solvers.normal.separation[place.wrapping_add_signed(ahead)];
                let ratio = problem.separation_ratio(gap, fields.pressure[place]);
                operators
                    .edge_factors
                    .map(|factor| weights.strain_speed * factor * ratio)
            } else {
                [0.0; 2]
            };
        }
    }
}

/// Takes what friction with a memory has found for the slip of each cell.
fn take_memory(grid: &Grid, solvers: &PatchSolvers, fields: &mut PatchFields) {
    let (of_slip, speeds) = solvers.friction.of_slip();
    fields.friction.fill(0.0);
    fields.memory.now.speed.fill(0.0);
    fields.memory.now.flow.fill(0.0);
    for run in solvers.contact.runs() {
        for (k, (index, place)) in run.indices().zip(run.places(grid)).enumerate() {
            let cell = run.strip * grid.cells + run.first + k;
            fields.friction[place] = of_slip[index].coefficient;
            fields.memory.share[cell] = of_slip[index].share;
            fields.memory.layer_bound[cell] = of_slip[index].layer_bound();
            fields.memory.now.friction[cell] = of_slip[index].surfaces;
            fields.memory.now.speed[cell] = speeds[index];
            fields.memory.now.flow[cell] = of_slip[index].flow();
        }
    }
}

/// Scales the shear of the first guess back to Coulomb's bound, to nothing outside the contact.
fn keep_within_bounds(grid: &Grid, contact: &Contact, bound: &[f64], fields: &mut PatchFields, on_grid: &mut [f64]) {
    on_grid.fill(0.0);
    contact.scatter(grid, bound, on_grid);
    let [x, y] = &mut fields.shear;
    dense::vectorised(
        #[inline(always)]
        |_| {
            for ((x, y), &bound) in x.iter_mut().zip(y).zip(&*on_grid) {
                let length = coulomb::magnitude([*x, *y]);
                let ratio = if length > bound { bound / length } else { 1.0 };
                (*x, *y) = (ratio * *x, ratio * *y);
            }
        },
    );
    on_grid.fill(0.0);
}

/// Computes the slip ahead of the cells without the response to their shear.
fn free_slip(
    problem: &PatchProblem,
    interface: &Interface,
    weights: &SlipWeights,
    fields: &PatchFields,
    solvers: &mut PatchSolvers,
) {
    let operators = problem.operators;
    let grid = &operators.grid;
    given_displacement(problem, interface, fields, solvers);
    let ahead: isize = if problem.is_forward() { 1 } else { -1 };
    for component in 0..2 {
        let slip = &mut solvers.free_slip[component];
        let (given, before) = (&solvers.given[component], &solvers.before[component]);
        let rigid = &solvers.undeformed.rigid_slip[component];
        dense::vectorised(
            #[inline(always)]
            |_| {
                for strip in 0..grid.strips {
                    let cells = problem.cells_with_next();
                    let row = grid.place(strip, cells.start)..grid.place(strip, cells.end);
                    let next = row.start.wrapping_add_signed(ahead)..row.end.wrapping_add_signed(ahead);
                    let given = given[row.clone()].iter().zip(&given[next.clone()]);
                    let before = before[row.clone()].iter().zip(&before[next]);
                    let displaced = given.zip(before).zip(&rigid[row.clone()]);
                    for (slip, (((given, given_next), (before, before_next)), rigid)) in
                        slip[row].iter_mut().zip(displaced)
                    {
                        *slip = weights.slip(*rigid, [*given, *given_next], [*before, *before_next]);
                    }
                }
            },
        );
    }
}

/// Computes the displacement that does not come from the contact's own shear: by that of contacts beside it, by pressure where the bodies differ, and by heat.
pub fn given_displacement(
    problem: &PatchProblem,
    interface: &Interface,
    fields: &PatchFields,
    solvers: &mut PatchSolvers,
) {
    let operators = problem.operators;
    let grid = &operators.grid;
    let window = Window::whole(grid);
    for (given, beside) in solvers.given.iter_mut().zip(&solvers.beside) {
        given.copy_from_slice(beside);
    }
    if let Some(tables) = &operators.coupling {
        let [x, y] = &mut solvers.given;
        operators.transform.apply(
            tables,
            &window,
            [&fields.pressure, &solvers.nothing],
            [x, y],
            &mut solvers.products,
        );
    }
    let heat = &mut solvers.expansion;
    if operators
        .expansion
        .displace(grid, &operators.transform, interface.displacement(), heat)
    {
        for (given, by_heat) in solvers.given.iter_mut().zip(&heat.displacement) {
            add_multiple(by_heat, 1.0, given);
        }
    }
}

/// Sets the shear of a wheel that stands on the spot, where the slip is the wheel's alone: the law gives the shear, and there is
/// none without slip.
fn slide_on_the_spot(
    problem: &PatchProblem,
    path: Option<&PathOfCells>,
    contact: &Contact,
    bound: &mut [f64],
    free_slip: &[Vec<f64>; 2],
    fields: &mut PatchFields,
) {
    let grid = &problem.operators.grid;
    let epsilon = problem.parameters.slip_regularisation;
    for run in contact.runs() {
        for (k, (index, place)) in run.indices().zip(run.places(grid)).enumerate() {
            let slip = [free_slip[0][place], free_slip[1][place]];
            let speed = coulomb::magnitude(slip);
            if let Some(path) = path {
                // At rest particles come from nowhere.
                let friction = path
                    .law
                    .friction(&path.nodes[index], &Passed::default(), speed, path.pressure[index]);
                let cell = run.strip * grid.cells + run.first + k;
                (fields.friction[place], fields.memory.share[cell]) = (friction.coefficient, friction.share);
                fields.memory.layer_bound[cell] = friction.layer_bound();
                fields.memory.now.friction[cell] = friction.surfaces;
                fields.memory.now.speed[cell] = speed;
                fields.memory.now.flow[cell] = friction.flow();
                bound[index] = friction.coefficient * path.pressure[index];
            }
            let utilisation = if epsilon > 0.0 {
                coulomb::utilisation(speed, epsilon)
            } else {
                1.0
            };
            for (slip, shear) in slip.into_iter().zip(&mut fields.shear) {
                shear[place] = if speed > 0.0 {
                    -bound[index] * utilisation * slip / speed
                } else {
                    0.0
                };
            }
        }
    }
}

/// Computes the slip at the centres of the cells, the mean of that ahead and that behind: it heats, wears and takes power.
fn mean_slip(problem: &PatchProblem, fields: &mut PatchFields, solvers: &mut PatchSolvers) {
    let grid = &problem.operators.grid;
    let moves = f64::from(solvers.response.strip_kernels[0][solvers.response.origin]) != 0.0;
    let behind: isize = if problem.is_forward() { -1 } else { 1 };
    for component in &mut fields.slip {
        component.fill(0.0);
    }
    for component in 0..2 {
        let free = &solvers.free_slip[component];
        let response = if moves {
            &solvers.friction.response()[component]
        } else {
            &solvers.nothing
        };
        let shear = &fields.shear[component];
        let slip = &mut fields.slip[component];
        for run in solvers.contact.runs() {
            let places = run.places(grid);
            let at_next = places.start.wrapping_add_signed(behind)..places.end.wrapping_add_signed(behind);
            let here = free[places.clone()].iter().zip(&response[places.clone()]);
            let next = free[at_next.clone()].iter().zip(&response[at_next]);
            let cells = here
                .zip(next)
                .zip(&shear[places.clone()])
                .zip(&solvers.edge[run.indices()]);
            for (slip, ((((free, response), (next, response_next)), shear), edge)) in slip[places].iter_mut().zip(cells)
            {
                let (ahead, behind) = (free + response, next + response_next);
                *slip = 0.5 * (ahead + edge[component] * shear + behind);
            }
        }
    }
}
