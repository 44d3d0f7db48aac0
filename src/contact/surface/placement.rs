//! Placement of the windows at the beginning of a step: about the contacts of the step before, and those that begin.

use super::apart;
use super::contacts::{self, AHEAD, BESIDE, CONTACTS, Expected, Wanted};
use super::fields::SurfaceFields;
use super::operators::SurfaceOperators;
use super::problem::SurfaceProblem;
use super::seams::{self, CutOff};
use super::search::Search;
use super::solvers::SurfaceSolvers;
use super::transfer::Rail;
use super::windows::{EVERYWHERE, Place, Region, Sizes, WINDOWS};
use crate::contact::fields::Fields;
use crate::contact::patch::fields::PatchFields;
use crate::contact::problem::Coupling;
use crate::error::{BY_SMOOTHING, Error, ProfileError, Result};
use crate::geometry::profile::Profile;
use crate::geometry::unrolled::{PlacedWheel, WheelsetPosition};
use crate::mechanics::patch::normal::is_free;

/// Approach after a contact has outgrown its window, over the one of the step before, above which windows are placed for the overlap of the bodies.
const FAR_DEEPER: f64 = 3.0;
/// Approach over that of the step before above which the approach of ellipses under the load limits it.
const MUCH_DEEPER: f64 = 2.0;
/// Largest room about the contacts of the step before, and for the overlap of the bodies, whatever the room of the conditions.
const MOST_ROOM: f64 = 4.0;
/// Least approach under a load for which windows are placed by the overlap of the bodies, over that of Hertz's ellipses.
const LEAST_OVERLAP: f64 = 0.5;
/// Distance of two regions, over their mean breadth, below which they share a window that resolves both.
const NEAR: f64 = 0.5;
/// Distance, over the mean breadth, below which they share one in any case: regions are larger than their contacts, and those of contacts that
/// touch overlap.
const TOUCHES: f64 = -0.05;
/// Strips that the smaller of two regions must have left in a window of both.
const LEAST_STRIPS: f64 = 8.0;
/// Distance of the running circle from the rail's top in the middle of the track above which the dimensions of wheelset and track hardly belong together, `m`.
const FARTHEST_BESIDE: f64 = 15e-3;

/// Places the windows for the pose of the step, carries the fields before over to them, and sets what their cells see of wheel and rail.
/// Without fields before, the approach is the one that is known, `m`, at which the pressure of the fields has been solved, or that of
/// ellipses.
///
/// # Errors
/// A wheel that is not over the rail.
pub fn place(
    problem: &SurfaceProblem,
    before: Option<&SurfaceFields>,
    known: Option<f64>,
    now: &mut SurfaceFields,
    solvers: &mut SurfaceSolvers,
) -> Result<()> {
    let operators = problem.operators;
    let pose = problem.pose();
    let guess = if now.touch > 0.0 {
        now.touch
    } else {
        problem.parameters.wheel_radius
    };
    let bodies = solvers.worn.of(operators);
    now.touch = solvers.search.touch(bodies, &pose.position, guess);
    if problem.conditions.room <= 1.0 {
        solvers.outgrown = 0.0;
        solvers.found.clear();
        solvers.replaced = 0;
        solvers.is_unsettled = false;
        solvers.cut_off.clear();
        solvers.room_before = 1.0;
    }
    let mut approach =
        known.unwrap_or_else(|| expected_approach(problem, before, now.touch - pose.position.height, solvers));
    if approach > 0.0 && !problem.is_height_given() {
        approach = if solvers.found.is_empty() {
            // The windows that were too small were placed for an approach that was, too.
            approach.max(solvers.outgrown)
        } else {
            solvers.outgrown
        };
    }
    solvers.reference = approach;
    now.approach[0] = approach;
    if approach > 0.0 {
        check_on_rail(problem, solvers, &pose.at_height(now.touch))?;
    }
    let source = before.or(known.map(|_| &*now));
    if problem.conditions.coupling == Coupling::Held {
        solvers.moved = false;
        solvers.own = [EVERYWHERE; WINDOWS];
        see(problem, now, solvers);
        return Ok(());
    }
    want(problem, source, approach, solvers);
    if known.is_some() {
        forget(now);
    }
    let places = now.places;
    let mut wanted = merged(&operators.sizes, &solvers.wanted, &solvers.cut_off);
    let mut own = assign(problem, wanted.regions(), before, now);
    if approach > 0.0 && !holds_first(problem, solvers, now, &own) {
        // Of contacts far apart that were taken for one, a window may have left out the one that carries.
        want_overlaps(problem, approach, solvers);
        wanted = merged(&operators.sizes, &solvers.wanted, &solvers.cut_off);
        now.places = places;
        own = assign(problem, wanted.regions(), before, now);
    }
    solvers.crowded = wanted.crowded;
    solvers.moved = before.is_some_and(|before| before.places != now.places);
    if let Some(before) = before
        && solvers.moved
    {
        let SurfaceSolvers {
            before: carried,
            transfer,
            ..
        } = &mut *solvers;
        carried.places = now.places;
        let friction =
            |place: &Place, strip: usize, rise: f64| problem.of(place).friction_at(strip).coefficient(rise).0;
        let rail = Rail {
            operators,
            rise: problem.incoming_rise(),
            depth: problem.conditions.inputs.incoming_wear_depth,
            friction: &friction,
        };
        transfer.begin(&rail, before);
        for (window, place) in now.used() {
            transfer.fill(&rail, before, &place, &mut carried.windows[window], window);
            free_ends(operators, &place, &mut carried.windows[window]);
        }
        carried.approach[0] = now.approach[0];
        carried.touch = now.touch;
        carried.stiffness = before.stiffness;
        carried.load = before.load;
        carried.wheel_temperature = before.wheel_temperature;
        carried.worn.copy_from(&now.worn);
        now.guess_from(carried);
    }
    solvers.own = own;
    see(problem, now, solvers);
    Ok(())
}

/// Sets what the cells of the windows see of wheel and rail, at the reference approach; of the surface between the arc lengths that each has to itself.
fn see(problem: &SurfaceProblem, now: &SurfaceFields, solvers: &mut SurfaceSolvers) {
    let (operators, pose) = (problem.operators, problem.pose());
    let bodies = solvers.worn.of(operators);
    let wheel = PlacedWheel::new(&bodies.wheel, &pose.at_height(now.touch - solvers.reference));
    for (window, place) in now.used() {
        let own_solvers = &mut solvers.windows[window];
        own_solvers.prepare(place.length);
        own_solvers.geometry.set(
            operators,
            (&bodies.rail, &wheel),
            &place,
            &pose.motion,
            solvers.own[window],
            &mut own_solvers.patch.undeformed,
        );
        own_solvers.gap.copy_from_slice(&own_solvers.patch.undeformed.gap);
    }
}

/// Refuses a wheel that has climbed onto its flange's tip, or is not over the rail.
fn check_on_rail(problem: &SurfaceProblem, solvers: &SurfaceSolvers, position: &WheelsetPosition) -> Result<()> {
    let (operators, inputs) = (problem.operators, &problem.conditions.inputs);
    let bodies = solvers.worn.of(operators);
    let first = solvers.search.first().filter(|_| solvers.search.touches());
    let stands = first.is_some_and(|(number, along)| {
        let last = bodies.scan.len() - 1;
        let at = PlacedWheel::new(&bodies.wheel, position);
        let place = at.profile_position(&at.distance(along, &bodies.scan[number].1, 0.0));
        (1..last).contains(&number) && place > operators.flange_tip && place < bodies.wheel.profile.range()[1]
    });
    if stands {
        return Ok(());
    }
    Err(Error::WheelOffRail {
        lateral: inputs.lateral_displacement - inputs.rail_lateral_displacement,
        roll: inputs.roll_angle - inputs.rail_roll_angle,
        because: cause(problem),
    })
}

/// Words on what may be the cause of a wheel that does not stand on its rail; empty where nothing is known.
fn cause(problem: &SurfaceProblem) -> String {
    let (operators, parameters) = (problem.operators, problem.parameters);
    let beside = parameters.running_circle() - operators.bodies.rail.top();
    if operators.profiles.iter().any(Profile::is_rough) {
        format!("a profile's {}{BY_SMOOTHING}", ProfileError::NOISE)
    } else if beside.abs() > FARTHEST_BESIDE {
        format!(
            "gauge = {} m, flange_back_distance = {} m and flange_back_position = {} m put the running circle {:.1} mm to the {} side of the rail's top",
            parameters.gauge,
            parameters.flange_back_distance,
            parameters.flange_back_position,
            1e3 * beside.abs(),
            if beside > 0.0 { "field" } else { "gauge" }
        )
    } else {
        String::new()
    }
}

/// Approach to expect, `m`: the given one, or that of the step before under the load of this one, or that of ellipses.
fn expected_approach(
    problem: &SurfaceProblem,
    before: Option<&SurfaceFields>,
    given: f64,
    solvers: &mut SurfaceSolvers,
) -> f64 {
    if problem.is_height_given() {
        return given;
    }
    let load = problem.vertical_load();
    if load == 0.0 {
        return 0.0;
    }
    let mut of_ellipses = || solvers.search.approach(load, problem.parameters.contact_modulus());
    match before.filter(|before| before.load > 0.0 && before.approach[0] > 0.0) {
        Some(before) => {
            let last = before.approach[0];
            let scaled = last * (load / before.load).cbrt().powi(2);
            // A rough profile carries little until it is tens of micrometres below the height of the first touch, and that way does not grow with the load.
            if scaled <= MUCH_DEEPER * last {
                scaled
            } else {
                scaled.min(last + of_ellipses())
            }
        }
        None => of_ellipses(),
    }
}

/// Lists the regions to place windows for, from the gauge side to the field side: those that an earlier try of the step has found; in a first try the contacts of the source, and those
/// that begin beside them; the overlaps of the bodies where the source has none.
fn want(problem: &SurfaceProblem, source: Option<&SurfaceFields>, approach: f64, solvers: &mut SurfaceSolvers) {
    let SurfaceSolvers {
        search,
        apart,
        wanted,
        is_unsettled,
        room_before,
        found,
        ..
    } = solvers;
    wanted.clear();
    if approach <= 0.0 {
        return;
    }
    if !found.is_empty() {
        wanted.extend_from_slice(found);
        return;
    }
    let room = problem.conditions.room.min(MOST_ROOM);
    // Of a wheelset that has come to lie far deeper than in the step before, the contacts then say nothing of what carries now.
    let tells = |source: &&SurfaceFields| {
        let before = source.approach[0];
        before > 0.0 && (room == 1.0 || approach <= FAR_DEEPER * before)
    };
    if let Some(source) = source.filter(tells) {
        let load_ratio = (approach / source.approach[0]).powf(1.5);
        let expected = Expected {
            growth: load_ratio.cbrt().max(1.0),
            beside: BESIDE * room,
            load_ratio,
            approach: approach * AHEAD,
        };
        contacts::find(problem.operators, source, expected, search, apart, wanted);
        let more = room / *room_before;
        if *is_unsettled {
            // Those that are so large meet, and share a window.
            wanted.iter_mut().for_each(|own| own.region = own.region.grown(more));
        }
        // A wheelset that has jumped touches elsewhere: the contacts of the step before say nothing then.
        let covers = |place| {
            wanted
                .iter()
                .any(|wanted| wanted.region.grown(expected.beside).holds(place))
        };
        if !search.first_place().is_some_and(covers) {
            wanted.clear();
        }
    }
    if wanted.is_empty() {
        want_overlaps(problem, approach, solvers);
    }
}

/// Lists the overlaps of the bodies as the regions to place windows for. A hot rail may have carried the load at next to no approach; where the bodies touch
/// elsewhere now, they overlap by more.
fn want_overlaps(problem: &SurfaceProblem, approach: f64, solvers: &mut SurfaceSolvers) {
    let SurfaceSolvers { search, wanted, .. } = solvers;
    wanted.clear();
    let approach = if problem.is_height_given() {
        approach
    } else {
        let of_ellipses = search.approach(problem.vertical_load(), problem.parameters.contact_modulus());
        approach.max(LEAST_OVERLAP * of_ellipses)
    };
    let approach = approach * AHEAD * problem.conditions.room.min(MOST_ROOM);
    // The overlaps come from the field side to the gauge side.
    let overlaps = search.overlaps(approach).iter().rev();
    wanted.extend(overlaps.map(|overlap| Wanted::overlap(overlap.region)));
    want_first(search, approach, wanted);
    for own in wanted.iter_mut() {
        own.region.sharpest = search.sharpest(own.region.across, approach);
    }
}

/// Sees to it that a region holds the place where the bodies touch first. On a rough profile they touch between points of the search, of which none need overlap.
fn want_first(search: &Search, approach: f64, wanted: &mut Vec<Wanted>) {
    let (Some(place), Some(region)) = (search.first_place(), search.about_first(approach)) else {
        return;
    };
    if wanted.iter().any(|wanted| wanted.region.holds(place)) {
        return;
    }
    if let Some(beside) = wanted.iter_mut().find(|wanted| wanted.region.meets(&region)) {
        // The contact in it may be narrower than the distance of the points, and counts as no broader for the place that is added.
        beside.region = Region {
            narrowest: beside.region.narrowest,
            ..beside.region.union(&region)
        };
    } else {
        let before = wanted.partition_point(|wanted| wanted.region.across[0] < region.across[0]);
        wanted.insert(before, Wanted::overlap(region));
    }
}

/// Whether a window that has a part of the surface to itself holds the place where the bodies touch first.
fn holds_first(
    problem: &SurfaceProblem,
    solvers: &SurfaceSolvers,
    now: &SurfaceFields,
    own: &[[f64; 2]; WINDOWS],
) -> bool {
    let Some(first) = solvers.search.first_place() else {
        return true;
    };
    let sizes = &problem.operators.sizes;
    let mut windows = now.used().filter(|(window, _)| {
        let [from, to] = own[*window];
        (from..to).contains(&first[1])
    });
    windows.any(|(_, place)| place.region(&sizes.grid(place.length, place.breadth)).holds(first))
}

/// Takes contacts off the fields that windows have been placed by.
fn forget(fields: &mut SurfaceFields) {
    for (window, _) in fields.used() {
        fields.windows[window].pressure.fill(0.0);
    }
    fields.places = [None; WINDOWS];
}

/// Regions for windows.
struct Merged {
    regions: [Wanted; CONTACTS],
    count: usize,
    /// Whether there were more than windows.
    crowded: bool,
}

impl Merged {
    /// The regions, as many as there are windows at most, and from the gauge side to the field side.
    fn regions(&self) -> &[Wanted] {
        &self.regions[..self.count]
    }
}

/// Regions for windows: each of those wanted that are near each other.
fn merged(sizes: &Sizes, wanted: &[Wanted], cut_off: &[CutOff]) -> Merged {
    let mut regions = [Wanted::default(); CONTACTS];
    let mut count = 0;
    for new in wanted {
        let mut new = *new;
        if count > 0 {
            let last = &mut regions[count - 1];
            if share_window(&last.region, &new.region, sizes)
                || last.goes_on_in(&new)
                || !seams::give_room(last, &mut new, cut_off)
            {
                last.join(&new);
                continue;
            }
        }
        regions[count] = new;
        count += 1;
    }
    // Where there are more than windows, two next to each other share one: those that are narrowest together.
    let crowded = count > WINDOWS;
    while count > WINDOWS {
        let breadth = |next: usize| regions[next].region.across[1] - regions[next - 1].region.across[0];
        let next = (1..count)
            .min_by(|&a, &b| breadth(a).total_cmp(&breadth(b)))
            .unwrap_or(1);
        let joined = regions[next];
        regions[next - 1].join(&joined);
        regions.copy_within(next + 1..count, next);
        count -= 1;
    }
    Merged {
        regions,
        count,
        crowded,
    }
}

/// Whether two regions share a window: those that touch, and those near each other that it resolves.
fn share_window(a: &Region, b: &Region, sizes: &Sizes) -> bool {
    let breadth = |region: &Region| region.across[1] - region.across[0];
    let both = a.union(b);
    let gap = (b.across[0] - a.across[1]) / (0.5 * (breadth(a) + breadth(b)));
    gap < TOUCHES || gap < NEAR && both.narrowest > LEAST_STRIPS * sizes.strip_for(&both)
}

/// Gives each region a window: the one that it had, or one that is free. Returns the arc lengths between which each window has the
/// surface to itself.
fn assign(
    problem: &SurfaceProblem,
    wanted: &[Wanted],
    before: Option<&SurfaceFields>,
    now: &mut SurfaceFields,
) -> [[f64; 2]; WINDOWS] {
    let sizes = &problem.operators.sizes;
    let mut window_of = [usize::MAX; WINDOWS];
    let mut taken = [false; WINDOWS];
    for (wanted, window_of) in wanted.iter().zip(&mut window_of) {
        let nearest = now
            .used()
            .filter(|(window, _)| !taken[*window])
            .filter(|(_, place)| {
                place
                    .region(&sizes.grid(place.length, place.breadth))
                    .meets(&wanted.region)
            })
            .min_by(|(_, a), (_, b)| {
                let distance = |place: &Place| {
                    let across = place.region(&sizes.grid(place.length, place.breadth)).across;
                    (across[0] + across[1] - wanted.region.across[0] - wanted.region.across[1]).abs()
                };
                distance(a).total_cmp(&distance(b))
            });
        if let Some((window, _)) = nearest {
            *window_of = window;
            taken[window] = true;
        }
    }
    let mut own = [[0.0; 2]; WINDOWS];
    for (number, wanted_here) in wanted.iter().enumerate() {
        if window_of[number] == usize::MAX {
            let free = |window: &usize| !taken[*window];
            let empty = (0..WINDOWS).filter(free).find(|&window| now.places[window].is_none());
            let window = empty.or_else(|| (0..WINDOWS).find(free)).unwrap_or(0);
            window_of[number] = window;
            taken[window] = true;
            now.places[window] = None;
        }
        let window = window_of[number];
        now.places[window] = Some(sizes.place(&wanted_here.region.with_room(wanted_here.room), now.places[window]));
        let low = number.checked_sub(1).map_or(f64::NEG_INFINITY, |last| {
            seams::between(&wanted[last].region, &wanted_here.region)
        });
        let high = wanted
            .get(number + 1)
            .map_or(f64::INFINITY, |next| seams::between(&wanted_here.region, &next.region));
        own[window] = [low, high];
    }
    now.are_close = (1..wanted.len()).any(|next| {
        let distance = wanted[next].region.across[0] - wanted[next - 1].region.across[1];
        let places = [next - 1, next]
            .into_iter()
            .filter_map(|number| now.places[window_of[number]]);
        places
            .map(|place| sizes.grid(place.length, place.breadth))
            .any(|grid| distance < apart::block_size(&grid))
    });
    // A window without a region stays while nothing else needs its place: rail that it has heated rolls out of it. Of the fields now, the heat is not known yet.
    let is_warm = |window, place| before.is_some_and(|before| is_warm(problem.operators, before, window, &place));
    for (window, taken) in taken.into_iter().enumerate() {
        if !taken && now.places[window].is_some_and(|place| !is_warm(window, place)) {
            now.places[window] = None;
        }
    }
    own
}

/// Takes the pressure off the outermost cells of a window, which stay free.
fn free_ends(operators: &SurfaceOperators, place: &Place, fields: &mut PatchFields) {
    let grid = &operators.of(place).grid;
    for strip in 0..grid.strips {
        for at in grid.row(strip).filter(|&at| !is_free(grid, at)) {
            fields.pressure[at] = 0.0;
            fields.shear.iter_mut().for_each(|shear| shear[at] = 0.0);
        }
    }
}

/// Whether the rail in a window is warmer or colder than the rail beside it.
fn is_warm(operators: &SurfaceOperators, fields: &SurfaceFields, window: usize, place: &Place) -> bool {
    /// Difference of temperature that counts, K.
    const APPRECIABLE: f64 = 0.1;
    let own = operators.of(place);
    let cells = own.grid.cells;
    let heat = &fields.windows[window].heat;
    (0..cells).any(|cell| {
        let beside = own
            .basis
            .surface_value(heat.amplitudes(&own.strips, own.grid.strips, cell));
        let column = heat.surface.iter().skip(cell).step_by(cells);
        column.into_iter().any(|rise| (rise - beside).abs() > APPRECIABLE)
    })
}
