//! The tractions of one iteration, temperature and wear as the iteration has them: pressure for the shear there is, then friction
//! for that pressure.

use super::fields::PatchFields;
use super::memory;
use super::problem::{Problem, SlipWeights};
use super::response;
use super::scratch::Scratch;
use crate::body::grid::Grid;
use crate::body::influence::Window;
use crate::error::Result;
use crate::friction::coulomb;
use crate::friction::path::Passed;
use crate::mechanics::normal::problem::Constraint;
use crate::mechanics::patch::contact::Contact;
use crate::mechanics::patch::friction::{FrictionProblem, PathOfCells};
use crate::mechanics::patch::normal::NormalProblem;
use crate::mechanics::sweep::Sweep;
use crate::numerics::dense::{add_multiple, largest, largest_change};

/// Adapts the response of the slip to speed and step.
pub fn respond(problem: &Problem, weights: SlipWeights, strips: usize, scratch: &mut Scratch) {
    scratch.strips = problem.operators.transform_for(strips).0.strips();
    let conditions = (weights, problem.is_forward(), scratch.strips);
    if scratch.weights == Some(conditions) {
        return;
    }
    scratch.weights = Some(conditions);
    response::adapt(problem, &weights, strips, &mut scratch.response);
}

/// (31): pressure for the shear there is, then friction for that pressure.
pub fn solve(problem: &Problem, fields: &mut PatchFields, scratch: &mut Scratch, tolerance: f64) -> Result<Sweep> {
    if problem.constraint() == Constraint::Total(0.0) {
        scratch.contact.list(&problem.operators.grid, |_| false);
        lift(problem, fields, scratch);
        return Ok(Sweep::NONE);
    }
    let set_changed = solve_normal(problem, fields, scratch, tolerance)?;
    if set_changed {
        scratch.friction.start_contact();
    }
    for component in 0..2 {
        scratch.shear_before[component].copy_from_slice(&fields.shear[component]);
    }
    if scratch.contact.cells() == 0 {
        lift(problem, fields, scratch);
        return Ok(Sweep {
            shear_change: 0.0,
            set_changed,
        });
    }
    solve_friction(problem, fields, scratch, tolerance)?;
    let change = (0..2)
        .map(|component| largest_change(&fields.shear[component], &scratch.shear_before[component]))
        .fold(0.0, f64::max);
    Ok(Sweep {
        shear_change: change / largest(&fields.pressure),
        set_changed,
    })
}

/// Without contact there are no tractions. The displacement that does not come from shear is that of this step all the same: what
/// the contact before has left would act on the next one.
fn lift(problem: &Problem, fields: &mut PatchFields, scratch: &mut Scratch) {
    fields.pressure.fill(0.0);
    fields.friction.fill(0.0);
    for vectors in [&mut fields.shear, &mut fields.slip] {
        vectors.iter_mut().for_each(|component| component.fill(0.0));
    }
    fields.memory.now.speed.fill(0.0);
    fields.memory.now.flow.fill(0.0);
    fields.penetration = 0.0;
    given_displacement(problem, fields, scratch);
}

/// (37). Returns whether other cells are under pressure than before.
fn solve_normal(problem: &Problem, fields: &mut PatchFields, scratch: &mut Scratch, tolerance: f64) -> Result<bool> {
    let operators = problem.operators;
    let grid = &operators.grid;
    let coupled = match &operators.coupling {
        Some(tables) => {
            let window = Window::whole(grid);
            let [lift, ignored] = &mut scratch.lift;
            let load = [&fields.shear[0][..], &fields.shear[1][..]];
            operators
                .transform
                .apply(tables, &window, load, [lift, ignored], &mut scratch.products);
            true
        }
        None => false,
    };
    for strip in 0..grid.strips {
        for cell in 0..grid.cells {
            let (place, index) = (grid.place(strip, cell), strip * grid.cells + cell);
            let lift = scratch.iterate.lift()[index] + if coupled { scratch.lift[0][place] } else { 0.0 };
            scratch.gap[place] = operators.gap[place] + scratch.iterate.wear()[index] - lift;
        }
    }
    std::mem::swap(&mut scratch.contact, &mut scratch.contact_before);
    let solved = scratch.normal.solve(
        &NormalProblem {
            grid,
            transform: &operators.transform,
            approach: &operators.approach,
            gap: &scratch.gap,
            softness: &scratch.softness,
            constraint: problem.constraint(),
            tolerance: tolerance.max(problem.settings.patch.least_tolerance),
        },
        &mut scratch.contact,
        &mut fields.pressure,
    );
    fields.penetration = solved?;
    Ok(scratch.contact != scratch.contact_before)
}

/// (10), (30) for given pressure, and the slip that follows.
fn solve_friction(problem: &Problem, fields: &mut PatchFields, scratch: &mut Scratch, tolerance: f64) -> Result<()> {
    let operators = problem.operators;
    let grid = &operators.grid;
    let weights = problem.slip_weights(problem.transient(fields));
    let strips = scratch.contact.window(grid, 0).strips.len();
    if strips > scratch.strips {
        // The contact has become broader than it was at the start of the step.
        scratch.friction.start_contact();
        respond(problem, weights, strips, scratch);
    }
    let forward = problem.is_forward();
    let ahead: isize = if forward { 1 } else { -1 };
    let law = problem.friction();
    let path_law = problem.path_law();
    if let Some(path_law) = &path_law {
        for (index, resting) in fields.memory.now.resting.iter_mut().enumerate() {
            *resting = law.coefficient(scratch.iterate.temperature(index)).0;
        }
        let contact = (&scratch.contact, &fields.pressure[..]);
        memory::prepare(problem, path_law, contact, fields, &mut scratch.path);
    }
    // Coulomb's bound, and what the leading edge adds: the opening ahead is that of the gap in the ratio of the tractions.
    if path_law.is_none() {
        fields.friction.fill(0.0);
    }
    for run in scratch.contact.runs() {
        let leading = if forward { run.cells - 1 } else { 0 };
        for (k, place) in run.places(grid).enumerate() {
            let index = run.offset + k;
            let cell = run.first + k;
            let temperature = scratch.iterate.temperature(run.strip * grid.cells + cell);
            let mut mu = law.coefficient(temperature).0;
            if path_law.is_some() {
                // The bound of the first guess. Rail that cools remembers less than it would have at rest, rail that warms more.
                mu = mu.max(fields.friction[place]);
            }
            fields.friction[place] = mu;
            scratch.bound[index] = mu * fields.pressure[place];
            scratch.edge[index] = if k == leading {
                let gap = scratch.normal.separation[place.wrapping_add_signed(ahead)];
                let ratio = problem.opening(gap, fields.pressure[place]);
                operators.opening.map(|factor| weights.strain_speed * factor * ratio)
            } else {
                [0.0; 2]
            };
        }
    }
    keep_within_bounds(grid, &scratch.contact, &scratch.bound, fields, &mut scratch.nothing);
    free_slip(problem, &weights, fields, scratch);
    let own = f64::from(scratch.response.own[0][scratch.response.origin]);
    let peak = largest(&fields.pressure);
    let path = path_law.map(|law| PathOfCells {
        law,
        nodes: &scratch.path.nodes,
        pressure: &scratch.path.pressure,
    });
    if own == 0.0 {
        slide_on_the_spot(
            problem,
            path.as_ref(),
            (&scratch.contact, &mut scratch.bound, &scratch.free_slip),
            fields,
        );
    } else {
        let friction_problem = FrictionProblem {
            grid,
            transform: operators.transform_for(scratch.strips).0,
            contact: &scratch.contact,
            response: &scratch.response,
            edge: &scratch.edge,
            free_slip: [&scratch.free_slip[0], &scratch.free_slip[1]],
            bound: &scratch.bound,
            path,
            scale: 1.0 / own,
            noise: problem.settings.patch.noise * own * peak,
            regularisation: problem.parameters.slip_regularisation,
            tolerance: peak * tolerance.max(problem.settings.patch.least_tolerance),
        };
        scratch.friction.solve(&friction_problem, &mut fields.shear)?;
        if path.is_some() {
            let (of_slip, speeds) = scratch.friction.of_slip();
            fields.friction.fill(0.0);
            fields.memory.now.speed.fill(0.0);
            fields.memory.now.flow.fill(0.0);
            for run in scratch.contact.runs() {
                for (k, (index, place)) in run.own().zip(run.places(grid)).enumerate() {
                    let cell = run.strip * grid.cells + run.first + k;
                    fields.friction[place] = of_slip[index].coefficient;
                    fields.memory.share[cell] = of_slip[index].share;
                    fields.memory.cap[cell] = of_slip[index].cap();
                    fields.memory.now.friction[cell] = of_slip[index].surfaces;
                    fields.memory.now.speed[cell] = speeds[index];
                    fields.memory.now.flow[cell] = of_slip[index].flow();
                }
            }
        }
    }
    mean_slip(problem, fields, scratch);
    Ok(())
}

/// A first guess within Coulomb's bound, nothing outside the contact.
fn keep_within_bounds(grid: &Grid, contact: &Contact, bound: &[f64], fields: &mut PatchFields, on_grid: &mut [f64]) {
    on_grid.fill(0.0);
    contact.scatter(grid, bound, on_grid);
    let [x, y] = &mut fields.shear;
    for ((x, y), &bound) in x.iter_mut().zip(y).zip(&*on_grid) {
        let length = coulomb::magnitude([*x, *y]);
        if length > bound {
            let share = bound / length;
            (*x, *y) = (share * *x, share * *y);
        }
    }
    on_grid.fill(0.0);
}

/// The slip ahead of the cells without the response to their shear.
fn free_slip(problem: &Problem, weights: &SlipWeights, fields: &PatchFields, scratch: &mut Scratch) {
    let operators = problem.operators;
    let grid = &operators.grid;
    given_displacement(problem, fields, scratch);
    let ahead: isize = if problem.is_forward() { 1 } else { -1 };
    let half = 0.5 * ahead as f64 * grid.length;
    for strip in 0..grid.strips {
        let y = grid.y(strip);
        for cell in problem.cells_with_next() {
            let place = grid.place(strip, cell);
            let next = place.wrapping_add_signed(ahead);
            let rigid = problem.rigid_slip(grid.x(cell) + half, y);
            for (component, rigid) in rigid.into_iter().enumerate() {
                let (given, before) = (&scratch.given[component], &scratch.before[component]);
                scratch.free_slip[component][place] = rigid
                    + weights.strain * (given[place] - given[next])
                    + weights.strain_before * (before[place] - before[next])
                    + weights.change * (given[place] - before[place]);
            }
        }
    }
}

/// The displacement that does not come from shear: by pressure where the bodies differ, and by heat.
fn given_displacement(problem: &Problem, fields: &PatchFields, scratch: &mut Scratch) {
    let operators = problem.operators;
    let grid = &operators.grid;
    let window = Window::whole(grid);
    for component in &mut scratch.given {
        component.fill(0.0);
    }
    if let Some(tables) = &operators.coupling {
        let [x, y] = &mut scratch.given;
        operators.transform.apply(
            tables,
            &window,
            [&fields.pressure, &scratch.nothing],
            [x, y],
            &mut scratch.products,
        );
    }
    let heat = &mut scratch.expansion;
    if operators
        .expansion
        .displace(grid, &operators.transform, scratch.iterate.lift(), heat)
    {
        for (given, by_heat) in scratch.given.iter_mut().zip(&heat.displacement) {
            add_multiple(by_heat, 1.0, given);
        }
    }
}

/// At rest, where the slip is the wheel's alone: the law gives the shear, and there is none without slip.
fn slide_on_the_spot(
    problem: &Problem,
    path: Option<&PathOfCells>,
    (contact, bound, free_slip): (&Contact, &mut [f64], &[Vec<f64>; 2]),
    fields: &mut PatchFields,
) {
    let grid = &problem.operators.grid;
    let epsilon = problem.parameters.slip_regularisation;
    for run in contact.runs() {
        for (k, (index, place)) in run.own().zip(run.places(grid)).enumerate() {
            let slip = [free_slip[0][place], free_slip[1][place]];
            let speed = coulomb::magnitude(slip);
            if let Some(path) = path {
                // At rest particles come from nowhere.
                let friction = path
                    .law
                    .friction(&path.nodes[index], &Passed::default(), speed, path.pressure[index]);
                let cell = run.strip * grid.cells + run.first + k;
                (fields.friction[place], fields.memory.share[cell]) = (friction.coefficient, friction.share);
                fields.memory.cap[cell] = friction.cap();
                fields.memory.now.friction[cell] = friction.surfaces;
                fields.memory.now.speed[cell] = speed;
                fields.memory.now.flow[cell] = friction.flow();
                bound[index] = friction.coefficient * path.pressure[index];
            }
            let saturation = if epsilon > 0.0 {
                coulomb::saturation(speed, epsilon)
            } else {
                1.0
            };
            for (slip, shear) in slip.into_iter().zip(&mut fields.shear) {
                shear[place] = if speed > 0.0 {
                    -bound[index] * saturation * slip / speed
                } else {
                    0.0
                };
            }
        }
    }
}

/// The slip at the centres of the cells, the mean of that ahead and that behind: it heats, wears and takes power.
fn mean_slip(problem: &Problem, fields: &mut PatchFields, scratch: &mut Scratch) {
    let grid = &problem.operators.grid;
    let moves = f64::from(scratch.response.own[0][scratch.response.origin]) != 0.0;
    let behind: isize = if problem.is_forward() { -1 } else { 1 };
    for component in &mut fields.slip {
        component.fill(0.0);
    }
    let free = &scratch.free_slip;
    for run in scratch.contact.runs() {
        for (index, place) in run.own().zip(run.places(grid)) {
            let at = |place: usize| {
                let response = if moves {
                    scratch.friction.response_at(place)
                } else {
                    [0.0; 2]
                };
                [free[0][place] + response[0], free[1][place] + response[1]]
            };
            let (ahead, behind) = (at(place), at(place.wrapping_add_signed(behind)));
            for component in 0..2 {
                let edge = scratch.edge[index][component] * fields.shear[component][place];
                fields.slip[component][place] = 0.5 * (ahead[component] + edge + behind[component]);
            }
        }
    }
}
