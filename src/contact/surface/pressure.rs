//! The pressure of all windows at the height of the wheel that carries the load.
//!
//! The search for the height evaluates the load at one approach after another. How the pressures answer a change of it is known from their
//! responses ([`super::approach_response`]): they move with the approach, and are then solved for what is left.

use super::approach_response::{advance, stiffness};
use super::approaches::{Approaches, LEAST_SIZE, SHOWS_STIFFNESS};
use super::contacts::{self, Expected, Wanted};
use super::fields::SurfaceFields;
use super::geometry::ELSEWHERE;
use super::operators::SurfaceOperators;
use super::problem::SurfaceProblem;
use super::seams::{self, CUTS};
use super::search::LEAST_RISE;
use super::solvers::SurfaceSolvers;
use super::windows::{Place, Region, WINDOWS};
use crate::contact::engine::Engine;
use crate::contact::patch::{extent, mechanics};
use crate::contact::problem::Coupling;
use crate::contact::step::MORE_ROOM;
use crate::error::{Error, Result};
use crate::mechanics::normal::normal_problem::Constraint;
use crate::numerics::dense;

/// Limit of the approaches that are tried for a load.
const APPROACHES: usize = 40;
/// Approaches after which the pressure is solved for better than to the tolerance.
const USUAL_APPROACHES: usize = 8;
/// Error of the load that is not worth another approach, relative: the pressure has more.
const LOAD_TOLERANCE: f64 = 1e-9;
/// Error of the load, relative, that is accepted where no approach has a smaller one: it is far below what the mesh resolves.
const ACCEPTED: f64 = 1e-6;
/// Cells whose mean pressure, under a load, the error of the pressure is measured by.
const FEW_CELLS: f64 = 10.0;
/// Error of the pressure at the first approach, relative.
const FIRST_TOLERANCE: f64 = 1e-3;
/// Error of the pressure at an approach over that of the load at the one before.
const TOLERANCE_SHARE: f64 = 0.03;
/// Excess of load, relative, below which the responses of the pressures tell the next approach.
pub const RESPONDS: f64 = 0.1;
/// Factor on that share where the responses tell the approach: so much less is left after it.
const RESPONSE_SHARE: f64 = 0.1;
/// Part of an excess of load that is left where the responses no longer tell what the pressure does.
const STALE: f64 = 0.2;
/// Limit of the approach in units of that under the largest load. A search that goes farther is given up: no height carries the load.
const FARTHEST: f64 = 50.0;
/// Least ratio of a window's vertical force by friction to that by pressure in a staggered step: the pressure carries four times the load at most.
const LEAST_FRICTION_SHARE: f64 = -0.75;
/// Limit of the rounds over windows that displace each other.
const ROUNDS: usize = 60;
/// Limit of these rounds in a staggered step, whose work is bounded.
const STAGGERED_ROUNDS: usize = 6;
/// Change of what the others do to a window, over the approach, that is left when the rounds end, over the error of the pressure.
const COUPLED_SHARE: f64 = 0.1;
/// Rounds in which windows that displace each other settle, if they do.
const SETTLING_ROUNDS: usize = 4;
/// Change of a displacement in the last of these rounds, over the approach, above which they do not.
const UNSETTLED: f64 = 0.1;
/// Work of the search for the height of the wheel in a staggered sub-step, in budgets of a step, after which it is given up. It is above a sub-step's own
/// budget: where no height is found, the pressure of the step before is held, which is worth avoiding.
const STAGGERED_SEARCH: u64 = 4;
/// Error of the load, relative, with which such a search ends rather than be given up: contacts that displace each other may spend all work on two or
/// three heights. The residual of the step shows it.
const LARGEST_MISSING: f64 = 0.1;
/// Load over that of the step before up to which its pressure may be held.
const LARGEST_GROWTH: f64 = 10.0;
/// Error of the pressure, relative, at which the cells under pressure are found.
const FINE_TOLERANCE: f64 = 1e-7;
/// Error of the load, relative, for the approach that windows are placed for.
const APPROACH_TOLERANCE: f64 = 1e-2;
/// Room for windows beyond which a contact is held within them.
const LARGEST_ROOM: f64 = 10.0;
/// Largest number of times in a step that windows that hold their contacts are placed anew, for finer strips.
const REPLACED: usize = 2;

/// Solves the pressure alone in windows that were placed for the overlap of the bodies. Returns the approach, `m`; none where nothing is
/// carried or it is not found.
pub fn approach_of_pressure(
    problem: &SurfaceProblem,
    fields: &mut SurfaceFields,
    solvers: &mut SurfaceSolvers,
) -> Option<f64> {
    let carries = problem.is_height_given() || problem.vertical_load() > 0.0;
    if solvers.reference <= 0.0 || !carries {
        return None;
    }
    for (window, _) in fields.used() {
        let own = &mut solvers.windows[window];
        own.interface.values_mut().fill(0.0);
        own.friction_share = 0.0;
    }
    press(problem, fields, solvers, APPROACH_TOLERANCE).ok()?;
    Some(fields.approach[0])
}

/// Error of the load, relative, that the least error of a pressure makes: a negligible load is known by fewer digits.
pub fn least_load_error(problem: &SurfaceProblem, load: f64) -> f64 {
    let force = FEW_CELLS * FEW_CELLS * problem.operators.shapes[0].unit_force();
    problem.settings.patch.least_tolerance * force / load
}

/// Solves the pressure of all windows, with the friction in proportion to it, at the approach that carries the load or at the given one.
///
/// On a steep flank, friction may pull the wheel down by more than the pressure lifts it. In proportion to the pressure, no approach
/// carries the load then, although other shear may; a staggered step takes the friction for smaller, and its residual shows it.
pub fn press(
    problem: &SurfaceProblem,
    fields: &mut SurfaceFields,
    solvers: &mut SurfaceSolvers,
    tolerance: f64,
) -> Result<()> {
    if problem.conditions.coupling.is_staggered() {
        limit_friction(fields, solvers);
    }
    let scale = problem.operators.shapes[0].scales.displacement;
    let mut search = if problem.is_height_given() {
        Approaches::given(solvers.reference)
    } else {
        let guess = fields.approach[0].max(0.05 * solvers.reference);
        Approaches::of_load(problem.vertical_load(), guess, fields.stiffness, scale)
    };
    solvers.apart.begin(problem.operators, fields);
    let tolerance_of_load = tolerance
        .max(LOAD_TOLERANCE)
        .max(search.load.map_or(0.0, |load| least_load_error(problem, load)));
    let (mut left, mut last_left) = (f64::INFINITY, f64::INFINITY);
    let farthest = FARTHEST * scale;
    // The pressure need not be better than the approach is.
    let mut own_tolerance = match search.load {
        Some(_) => tolerance.max(FIRST_TOLERANCE),
        None => tolerance,
    };
    // Whether the responses told the approach by the excess at the one before.
    let mut foretold = false;
    if foresee(problem, &mut search, fields, solvers) {
        own_tolerance = tolerance;
    }
    let budget = problem.mechanics_budget();
    // Error of the load that is accepted; the work after which a search ends with it, and the work after which it is given up.
    let (accepted, enough, limit) = match problem.conditions.coupling {
        coupling if coupling.is_staggered() && budget < u64::MAX => (
            problem.settings.patch.staggered_residual,
            budget,
            STAGGERED_SEARCH * problem.settings.step.work,
        ),
        _ => (ACCEPTED, u64::MAX, budget),
    };
    for approaches in 0..APPROACHES {
        let force = press_at(problem, search.approach, fields, solvers, own_tolerance)?;
        let excess = search.load.map_or(0.0, |load| (force - load) / load);
        left = excess.abs();
        let error = own_tolerance;
        let solved_well = own_tolerance <= tolerance;
        // The errors of the cells may add up to more of the load.
        let finest = if approaches < USUAL_APPROACHES { 1.0 } else { 0.1 } * tolerance;
        own_tolerance = (TOLERANCE_SHARE * left).clamp(finest, own_tolerance.max(finest));
        let work = SurfaceOperators::mechanics_work(solvers);
        let will_do = work > enough && left <= accepted;
        if left <= tolerance_of_load && !solved_well && !will_do {
            own_tolerance = tolerance;
            continue;
        }
        if left <= tolerance_of_load || will_do {
            search.end(fields);
            return check_room(problem, fields, solvers);
        }
        if work > limit {
            if problem.conditions.coupling.is_staggered() && left <= LARGEST_MISSING {
                // In larger windows, as much work would be spent again.
                search.end(fields);
                return Ok(());
            }
            return Err(Error::TooMuchWork { work, limit });
        }
        // Other cells carry by now than those that the responses were found on.
        if foretold && left > STALE * last_left && left > SHOWS_STIFFNESS * error {
            solvers.responded = false;
        }
        last_left = left;
        foretold = move_on(problem, &mut search, [excess, error], fields, solvers);
        if foretold {
            own_tolerance = (RESPONSE_SHARE * TOLERANCE_SHARE * left).clamp(finest, error.max(finest));
        }
        if search.approach.abs() > farthest {
            break;
        }
    }
    if left <= accepted {
        search.end(fields);
        return check_room(problem, fields, solvers);
    }
    Err(Error::NormalNotConverged {
        solver: "height of the wheel",
        iterations: APPROACHES,
        residual: left,
        tolerance: tolerance_of_load,
    })
}

/// Takes the pressure that there is, of the step before, in proportion to the load that is carried with the friction.
///
/// # Errors
/// [`Error::NormalNotConverged`] where there is none to speak of, or friction pulls the wheel down by more than it lifts it.
pub fn hold(problem: &SurfaceProblem, fields: &mut SurfaceFields, solvers: &mut SurfaceSolvers) -> Result<()> {
    limit_friction(fields, solvers);
    let (load, carried) = (problem.vertical_load(), proportional_force(problem, fields, solvers));
    if load > LARGEST_GROWTH * carried {
        return Err(Error::NormalNotConverged {
            solver: "pressure of the step before",
            iterations: 0,
            residual: 1.0,
            tolerance: 0.0,
        });
    }
    let ratio = load / carried;
    for (window, place) in fields.used() {
        let grid = &problem.operators.of(&place).grid;
        let pressure = &mut fields.windows[window].pressure;
        pressure.iter_mut().for_each(|pressure| *pressure *= ratio);
        let own = &mut solvers.windows[window].patch;
        own.contact.list(grid, |at| pressure[at] > 0.0);
        // How far the surfaces are apart ahead of the cells is not known.
        own.normal.separation.fill(0.0);
    }
    Ok(())
}

/// Limits the friction of steep flanks in proportion to the pressure.
fn limit_friction(fields: &SurfaceFields, solvers: &mut SurfaceSolvers) {
    for (window, _) in fields.used() {
        let share = &mut solvers.windows[window].friction_share;
        *share = share.max(LEAST_FRICTION_SHARE);
    }
}

/// Moves approach and pressures before the first pressure of a sweep is solved, if the responses are known: the friction has become another one since the
/// last sweep, and by so much of the load the pressure must change. Returns whether it has moved them.
fn foresee(
    problem: &SurfaceProblem,
    search: &mut Approaches,
    fields: &mut SurfaceFields,
    solvers: &mut SurfaceSolvers,
) -> bool {
    let Some(load) = search.load.filter(|_| solvers.responded) else {
        return false;
    };
    let excess = (proportional_force(problem, fields, solvers) - load) / load;
    if excess.abs() >= RESPONDS {
        return false;
    }
    let Some(stiffness) = stiffness(problem, fields, solvers) else {
        return false;
    };
    let before = search.approach;
    search.foresee(excess, stiffness);
    advance(problem, search.approach - before, fields, solvers);
    true
}

/// Moves on to the next approach by an excess of load with an error, relative, and the pressures with it where their responses tell how. Whether they do.
fn move_on(
    problem: &SurfaceProblem,
    search: &mut Approaches,
    [excess, error]: [f64; 2],
    fields: &mut SurfaceFields,
    solvers: &mut SurfaceSolvers,
) -> bool {
    let before = search.approach;
    let stiffness = match search.load {
        Some(_) if excess.abs() < RESPONDS => stiffness(problem, fields, solvers),
        _ => None,
    };
    search.next(excess, error, stiffness);
    if stiffness.is_some() {
        advance(problem, search.approach - before, fields, solvers);
    }
    stiffness.is_some()
}

/// Solves the pressure of all windows at an approach. Returns the vertical force with the friction in proportion, `N`.
///
/// # Errors
/// [`Error::ContactOutgrowsWindow`] where contacts that all but touch go on pushing each other away: with more room they share a window.
fn press_at(
    problem: &SurfaceProblem,
    approach: f64,
    fields: &mut SurfaceFields,
    solvers: &mut SurfaceSolvers,
    tolerance: f64,
) -> Result<f64> {
    let operators = problem.operators;
    let rounds = match problem.conditions.coupling {
        Coupling::Implicit => ROUNDS,
        _ => STAGGERED_ROUNDS,
    };
    let coupled = COUPLED_SHARE * tolerance;
    // Change of what the others do to a window since it was solved, over the approach.
    let mut pending = [f64::INFINITY; WINDOWS];
    for round in 0..rounds {
        for (window, place) in fields.used() {
            if pending[window] <= coupled {
                continue;
            }
            press_window(problem, approach, fields, solvers, (window, place), tolerance)?;
            pending[window] = 0.0;
            solvers.apart.take_for_others(operators, fields, window, &place);
            for (other, place) in fields.used().filter(|(other, _)| *other != window) {
                let scale = operators.of(&place).scales.displacement;
                let displaced = solvers.apart.displace(operators, other, &place);
                pending[other] += displaced * scale / approach.abs().max(LEAST_SIZE * scale);
            }
        }
        let change = fields
            .used()
            .fold(0.0, |most, (window, _)| f64::max(most, pending[window]));
        if change <= coupled {
            break;
        }
        if round + 1 >= SETTLING_ROUNDS && change > UNSETTLED && problem.conditions.room < LARGEST_ROOM {
            solvers.is_unsettled = true;
            solvers.found.clear();
            return Err(Error::ContactOutgrowsWindow);
        }
    }
    Ok(proportional_force(problem, fields, solvers))
}

/// Vertical force of all windows with the friction in proportion to the pressure, `N`.
fn proportional_force(problem: &SurfaceProblem, fields: &SurfaceFields, solvers: &SurfaceSolvers) -> f64 {
    let forces = fields.used().map(|(window, place)| {
        let [normal, _] = problem.vertical_forces(fields, solvers, window, &place);
        normal * (1.0 + solvers.windows[window].friction_share)
    });
    forces.sum()
}

/// Solves the pressure of one window at an approach, for what the others do to it.
fn press_window(
    problem: &SurfaceProblem,
    approach: f64,
    fields: &mut SurfaceFields,
    solvers: &mut SurfaceSolvers,
    (window, place): (usize, Place),
    tolerance: f64,
) -> Result<()> {
    let lowered = approach - solvers.reference;
    let own = &mut solvers.windows[window];
    let patch = problem.of(&place);
    let scale = patch.operators.scales.displacement;
    // The pressure under a small load is small.
    let tolerance = if problem.is_height_given() {
        tolerance
    } else {
        tolerance * (problem.vertical_load() / (FEW_CELLS * patch.operators.unit_force())).min(1.0)
    };
    let is_height_given = problem.is_height_given();
    let (elsewhere, lowered) = (ELSEWHERE / scale, lowered / scale);
    let displaced = &solvers.apart.displacement[window][0];
    dense::vectorised(
        #[inline(always)]
        |_| {
            let gaps = own.patch.undeformed.gap.iter_mut().zip(&own.gap).zip(displaced);
            for (((gap, reference), displaced), rise) in gaps.zip(&own.geometry.rise) {
                // A wall that no height of the wheel presses on carries nothing of a load.
                let carries = is_height_given || *rise > LEAST_RISE;
                let lowered = reference - lowered * rise + displaced;
                *gap = if carries { lowered } else { elsewhere };
            }
        },
    );
    let mut solve = |tolerance: f64| {
        let penetration = Constraint::Penetration(0.0);
        let fields = &mut fields.windows[window];
        mechanics::solve_normal(&patch, penetration, &own.interface, fields, &mut own.patch, tolerance)
    };
    // With a rough pressure the cells under pressure may not be found.
    match solve(tolerance) {
        Err(Error::NormalNotConverged { .. }) if tolerance > FINE_TOLERANCE => solve(FINE_TOLERANCE)?,
        other => other?,
    };
    Ok(())
}

/// Refuses a contact that has become larger than its window, as long as there are larger ones, or is cut off at a seam.
fn check_room(problem: &SurfaceProblem, fields: &SurfaceFields, solvers: &mut SurfaceSolvers) -> Result<()> {
    if problem.conditions.room >= LARGEST_ROOM {
        return Ok(());
    }
    let mut holds_all = true;
    let cuts = solvers.cut_off.len();
    let mut outgrown = [[false; 2]; WINDOWS];
    for (window, place) in fields.used() {
        let grid = &problem.operators.of(&place).grid;
        let (pressure, own) = (&fields.windows[window].pressure, &solvers.windows[window].patch);
        for cut in seams::cut_off(grid, &place, solvers.own[window], pressure)
            .into_iter()
            .flatten()
        {
            if solvers.cut_off.len() < CUTS {
                solvers.cut_off.push(cut);
                holds_all = false;
            }
        }
        let overlap = problem.settings.mechanics.overlap;
        let [along, across] = extent::is_cut_off(grid, pressure, &own.normal.separation, overlap);
        // The largest window has no larger one: with more room it would only have longer cells.
        let ways = [along && place.length > 0, across && place.breadth > 0];
        outgrown[window] = ways;
        if ways != [false; 2] {
            solvers.outgrown = fields.approach[0];
            holds_all = false;
        }
    }
    let is_cut_off = solvers.cut_off.len() > cuts;
    if !(is_cut_off || holds_all && solvers.compared) {
        let are_resolved = are_resolved(problem, fields, &outgrown, solvers);
        solvers.compared = true;
        if holds_all && !are_resolved && solvers.replaced < REPLACED {
            solvers.replaced += 1;
            // The seams will be those of other regions.
            solvers.cut_off.clear();
            holds_all = false;
        }
    }
    if holds_all {
        return Ok(());
    }
    if is_cut_off {
        solvers.room_before = problem.conditions.room * MORE_ROOM;
    }
    Err(Error::ContactOutgrowsWindow)
}

/// Whether the strips of the windows resolve the contacts in the pressure that has been found. The windows were placed for the pressure of the step before, and the wheelset may have moved by
/// much since. Lists the regions for the windows of another try, with more room where a contact has outgrown its window: `outgrown` says of each window whether along the rail and whether
/// across it.
fn are_resolved(
    problem: &SurfaceProblem,
    fields: &SurfaceFields,
    outgrown: &[[bool; 2]; WINDOWS],
    solvers: &mut SurfaceSolvers,
) -> bool {
    let SurfaceSolvers {
        search,
        apart,
        found,
        outgrown: outgrown_at,
        ..
    } = solvers;
    let sizes = &problem.operators.sizes;
    let approach = fields.approach[0];
    contacts::find(
        problem.operators,
        fields,
        Expected::unchanged(approach),
        search,
        apart,
        found,
    );
    *outgrown_at = approach;
    let mut are_resolved = true;
    for (window, place) in fields.used() {
        let covers = place.region(&sizes.grid(place.length, place.breadth));
        let is_here = |wanted: &&mut Wanted| wanted.reach.is_some() && covers.meets(&wanted.region);
        // Region of all contacts in the window.
        let mut all: Option<Region> = None;
        for wanted in found.iter_mut().filter(is_here) {
            all = Some(all.map_or(wanted.region, |all| all.union(&wanted.region)));
            wanted.room = outgrown[window].map(|is_outgrown| if is_outgrown { MORE_ROOM } else { 1.0 });
        }
        are_resolved &= all.is_none_or(|region| sizes.resolves(&region, &place));
    }
    are_resolved
}
