//! One implicit step of the patch by the operator split of section 4 of the paper: pressure, then friction for that pressure,
//! then wear and heat for those tractions, until temperature and wear rest.
//!
//! What wear and heat give is handed to the next iteration as one vector ([`Coupling`]), on which Anderson's method works. The
//! last iteration is followed by what acts on nothing any more within the step: the heat under the surface, the rail behind the
//! window, the displacement.

use super::expansion;
use super::fields::{PatchFields, PatchTrend};
use super::problem::{Problem, SlipWeights};
use super::rail::PatchRail;
use crate::body::influence::{self, Window};
use crate::contact::rest::Rest;
use crate::contact::rim::{self, ContactHeat};
use crate::contact::task::Convergence;
use crate::error::{Error, Result};
use crate::friction::coulomb;
use crate::heat::strips::StripHeatScratch;
use crate::heat::surface::SurfaceExchange;
use crate::mechanics::normal::problem::Constraint;
use crate::mechanics::patch::contact::Contact;
use crate::mechanics::patch::friction::{Friction, FrictionProblem, SlipResponse};
use crate::mechanics::patch::normal::{self, Normal, NormalProblem};
use crate::mechanics::sweep::Sweep;
use crate::numerics::anderson::Anderson;
use crate::numerics::dense::{add_multiple, largest, largest_change};
use crate::parameters::WheelHeating;
use crate::settings::Settings;
use crate::transport::CellStep;
use crate::wear::strips::StripWearSteps;

/// Temperature that counts as much as a displacement of one unit, `K`: a change that matters to the friction law.
const TEMPERATURE_UNIT: f64 = 100.0;

/// What wear and heat hand to the mechanics: of n cells the surface temperature in units of 100 K, the lift by heat and the wear
/// that is not in the normal problem, both scaled; then the wheel's temperature.
#[derive(Debug, Clone)]
pub struct Coupling {
    /// All values.
    pub values: Vec<f64>,
    cells: usize,
}

impl Coupling {
    /// All zero.
    pub fn new(rail: &PatchRail) -> Coupling {
        let cells = rail.grid.strips * rail.grid.cells;
        Coupling {
            values: vec![0.0; 3 * cells + 1],
            cells,
        }
    }

    /// Temperature rise of a cell, `K`.
    pub fn temperature(&self, cell: usize) -> f64 {
        TEMPERATURE_UNIT * self.values[cell]
    }

    /// Lift by heat.
    pub fn lift(&self) -> &[f64] {
        &self.values[self.cells..2 * self.cells]
    }

    /// Wear that is not in the normal problem.
    pub fn wear(&self) -> &[f64] {
        &self.values[2 * self.cells..3 * self.cells]
    }

    /// To change the wear that is not in the normal problem: whatever else acts on the gap alone may be handed over with it.
    pub fn wear_mut(&mut self) -> &mut [f64] {
        &mut self.values[2 * self.cells..3 * self.cells]
    }

    /// The wheel's temperature, `K`.
    pub fn wheel_temperature(&self) -> f64 {
        TEMPERATURE_UNIT * self.values[3 * self.cells]
    }

    /// From the fields, with the wear that is proportional to the pressure, `softness` times it, taken off.
    pub fn read(&mut self, rail: &PatchRail, fields: &PatchFields, softness: &[f64]) {
        let cells = self.cells;
        self.values[3 * cells] = fields.wheel_temperature / TEMPERATURE_UNIT;
        for strip in 0..rail.grid.strips {
            for cell in 0..rail.grid.cells {
                let index = strip * rail.grid.cells + cell;
                let place = rail.grid.place(strip, cell);
                self.values[index] = fields.heat.surface[index] / TEMPERATURE_UNIT;
                self.values[cells + index] = rail.expansion.bulge * fields.heat.content[index];
                self.values[2 * cells + index] =
                    fields.wear.depth[index] / rail.scales.displacement - softness[place] * fields.pressure[place];
            }
        }
    }

    /// Change from one set of values to another, each kind relative to its largest value, but at least to `least_temperature` `K` or
    /// a displacement of one unit.
    fn change_to(&self, after: &Coupling, least_temperature: f64) -> f64 {
        let cells = self.cells;
        let temperature = &after.values[..cells];
        let size = largest(temperature).max(least_temperature / TEMPERATURE_UNIT);
        (largest_change(temperature, &self.values[..cells]) / size)
            .max(largest_change(&after.values[cells..], &self.values[cells..]))
    }
}

/// Buffers of a split.
pub struct Scratch {
    contact: Contact,
    contact_before: Contact,
    normal: Normal,
    friction: Friction,
    response: SlipResponse,
    /// What the response is of: the weights, whether V ≥ 0, the strips that its transform serves.
    weights: Option<(SlipWeights, bool, usize)>,
    /// Strips that its transform serves.
    strips: usize,
    products: influence::Scratch<f64>,
    iterate: Coupling,
    image: Coupling,
    anderson: Anderson,
    exchange: Vec<SurfaceExchange>,
    heat: StripHeatScratch,
    wear_rate: Vec<f64>,
    wear_steps: StripWearSteps,
    /// On the grid: gap, softness by wear, lift by shear, u that does not come from shear, u before, slip without shear.
    gap: Vec<f64>,
    softness: Vec<f64>,
    lift: [Vec<f64>; 2],
    given: [Vec<f64>; 2],
    before: [Vec<f64>; 2],
    free_slip: [Vec<f64>; 2],
    expansion: expansion::Scratch,
    nothing: Vec<f64>,
    shear_before: [Vec<f64>; 2],
    /// Of the cells under pressure.
    bound: Vec<f64>,
    edge: Vec<[f64; 2]>,
}

impl Scratch {
    /// Buffers for the given rail.
    pub fn new(rail: &PatchRail, settings: &Settings) -> Scratch {
        let (grid, transform) = (&rail.grid, &rail.transform);
        let on_grid = || vec![0.0; grid.len()];
        let vectors = || [on_grid(), on_grid()];
        let iterate = Coupling::new(rail);
        let cells = grid.strips * grid.cells;
        Scratch {
            contact: Contact::new(grid),
            contact_before: Contact::new(grid),
            normal: Normal::new(grid, transform, settings.patch),
            friction: Friction::new(grid, transform, settings.patch),
            response: no_response(rail),
            weights: None,
            strips: grid.strips,
            products: transform.scratch(),
            anderson: Anderson::new(iterate.values.len()),
            image: iterate.clone(),
            iterate,
            exchange: vec![SurfaceExchange::default(); cells],
            heat: StripHeatScratch::new(&rail.basis, &rail.strips),
            wear_rate: vec![0.0; cells],
            wear_steps: StripWearSteps::new(&rail.strips),
            gap: on_grid(),
            softness: on_grid(),
            lift: vectors(),
            given: vectors(),
            before: vectors(),
            free_slip: vectors(),
            expansion: expansion::Scratch::new(grid, transform),
            nothing: on_grid(),
            shear_before: vectors(),
            bound: on_grid(),
            edge: vec![[0.0; 2]; grid.len()],
        }
    }
}

/// Solves the step: `fields` holds the tractions to start from and receives the solution; temperature and wear at its start are those
/// of `before`, their guess at its end moves with the `trend` over `ahead` `s`.
///
/// # Errors
/// The first solver that did not converge, or [`Error::ContactLeavesWindow`]; `fields` is then unspecified.
pub fn solve(
    problem: &Problem,
    before: &PatchFields,
    (trend, ahead): (&PatchTrend, f64),
    fields: &mut PatchFields,
    scratch: &mut Scratch,
) -> Result<Convergence> {
    let settings = problem.settings;
    fields.relaxation_length = problem.relaxation_length(before);
    for component in 0..2 {
        scratch.before[component].copy_from_slice(&before.displacement[component]);
    }
    start(problem, fields, scratch);
    let inputs = &problem.conditions.inputs;
    let rise = inputs.incoming_temperature - inputs.ambient_temperature;
    problem
        .heat_march()
        .start(&before.heat, rise, &mut fields.heat, &mut scratch.heat)?;
    guess(before, (trend, ahead), fields);
    scratch.iterate.read(problem.rail, fields, &scratch.softness);
    let mut rest = Rest::new(settings.patch_split());
    for iterations in 1..=settings.split.iterations {
        let sweep = solve_tractions(problem, fields, scratch, rest.mechanics_tolerance())?;
        march_wear(problem, before, fields, scratch);
        march_heat(problem, before, fields, scratch)?;
        scratch.image.read(problem.rail, fields, &scratch.softness);
        let change = scratch
            .iterate
            .change_to(&scratch.image, settings.split.least_temperature);
        let late = iterations > settings.patch.late_after && change <= settings.patch.late_tolerance;
        if (rest.is_reached(change, &sweep) || late) && iterations > 1 {
            let fills_window = fills_window(problem, fields, scratch)?;
            finish(problem, before, fields, scratch)?;
            return Ok(Convergence {
                iterations,
                residual: rest.change(),
                fills_window,
            });
        }
        if iterations > settings.split.accelerate_after {
            scratch
                .anderson
                .next(&scratch.iterate.values, &mut scratch.image.values);
        }
        std::mem::swap(&mut scratch.iterate, &mut scratch.image);
    }
    Err(Error::SplitNotConverged {
        iterations: settings.split.iterations,
        residual: rest.change(),
        tolerance: settings.patch_split().tolerance,
    })
}

/// The mechanics alone, for given temperature and wear.
///
/// # Errors
/// As [`solve`].
pub fn solve_mechanics(problem: &Problem, fields: &mut PatchFields, scratch: &mut Scratch) -> Result<()> {
    start(problem, fields, scratch);
    for component in 0..2 {
        scratch.before[component].fill(0.0);
    }
    scratch.iterate.read(problem.rail, fields, &scratch.softness);
    let settings = problem.settings;
    let tolerance = settings.patch.tolerance;
    let mut residual = f64::INFINITY;
    for _ in 0..settings.split.iterations {
        let sweep = solve_tractions(problem, fields, scratch, tolerance)?;
        residual = sweep.shear_change;
        if sweep.rests(tolerance) {
            fills_window(problem, fields, scratch)?;
            close_displacement(problem, fields, scratch);
            for component in &mut fields.displacement_change {
                component.fill(0.0);
            }
            return Ok(());
        }
    }
    Err(Error::MechanicsNotConverged {
        iterations: settings.split.iterations,
        residual,
        tolerance,
    })
}

/// Begins a step: a step follows from its state alone.
fn start(problem: &Problem, fields: &PatchFields, scratch: &mut Scratch) {
    scratch.normal.start_step();
    scratch.friction.start_step();
    scratch.anderson.restart();
    scratch.softness.fill(0.0);
    let grid = &problem.rail.grid;
    scratch.contact.list(grid, |place| fields.pressure[place] > 0.0);
    let strips = scratch.contact.window(grid, 0).strips.len();
    respond(
        problem,
        problem.slip_weights(problem.transient(fields)),
        strips,
        scratch,
    );
}

/// Adapts the response of the slip to speed and step.
fn respond(problem: &Problem, weights: SlipWeights, strips: usize, scratch: &mut Scratch) {
    scratch.strips = problem.rail.transform_for(strips).0.strips();
    let conditions = (weights, problem.is_forward(), scratch.strips);
    if scratch.weights == Some(conditions) {
        return;
    }
    scratch.weights = Some(conditions);
    adapt(problem, &weights, strips, &mut scratch.response);
}

/// No response yet.
pub(super) fn no_response(rail: &PatchRail) -> SlipResponse {
    SlipResponse {
        double: rail.displacement.clone(),
        single: rail.displacement.single(),
        own: [vec![0.0; rail.own[0].len()], vec![0.0; rail.own[1].len()]],
        origin: rail.grid.stride(),
        forward: true,
    }
}

/// The response of the slip to the shear at these weights, for a contact on so many strips.
pub(super) fn adapt(problem: &Problem, weights: &SlipWeights, strips: usize, response: &mut SlipResponse) {
    let (rail, forward) = (problem.rail, problem.is_forward());
    response.forward = forward;
    // The displacement of the cell ahead is felt at one lag more towards it.
    let ahead = if forward { 1 } else { -1 };
    let (own, next) = (weights.strain + weights.change, -weights.strain);
    let (transform, displacement) = rail.transform_for(strips);
    displacement.combine(
        transform,
        (own, next, ahead),
        &mut response.double,
        &mut response.single,
    );
    for (table, kernel) in response.own.iter_mut().zip(&rail.own) {
        for (lag, value) in table.iter_mut().enumerate() {
            let shifted = lag.saturating_add_signed(ahead).min(kernel.len() - 1);
            *value = (own * kernel[lag] + next * kernel[shifted]) as f32;
        }
    }
}

/// First guess of temperature and wear of the cells.
fn guess(before: &PatchFields, (trend, ahead): (&PatchTrend, f64), fields: &mut PatchFields) {
    let guess = |own: &mut [f64], before: &[f64], trend: &[f64]| {
        for ((own, before), trend) in own.iter_mut().zip(before).zip(trend) {
            *own = before + ahead * trend;
        }
    };
    guess(&mut fields.heat.surface, &before.heat.surface, &trend.surface);
    guess(&mut fields.heat.content, &before.heat.content, &trend.content);
    guess(&mut fields.wear.depth, &before.wear.depth, &trend.depth);
    for component in 0..2 {
        guess(
            &mut fields.shear[component],
            &before.shear[component],
            &trend.shear[component],
        );
    }
    guess(&mut fields.pressure, &before.pressure, &trend.pressure);
    // What was not under pressure is not extrapolated into it.
    for (pressure, before) in fields.pressure.iter_mut().zip(&before.pressure) {
        *pressure = if *before > 0.0 { pressure.max(0.0) } else { 0.0 };
    }
}

/// (31): pressure for the shear there is, then friction for that pressure.
fn solve_tractions(
    problem: &Problem,
    fields: &mut PatchFields,
    scratch: &mut Scratch,
    tolerance: f64,
) -> Result<Sweep> {
    if problem.constraint() == Constraint::Total(0.0) {
        lift(fields);
        scratch.contact.list(&problem.rail.grid, |_| false);
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
        lift(fields);
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

/// Without contact there are no tractions.
fn lift(fields: &mut PatchFields) {
    fields.pressure.fill(0.0);
    fields.friction.fill(0.0);
    for vectors in [&mut fields.shear, &mut fields.slip] {
        vectors.iter_mut().for_each(|component| component.fill(0.0));
    }
    fields.penetration = 0.0;
}

/// (37). Returns whether other cells are under pressure than before.
fn solve_normal(problem: &Problem, fields: &mut PatchFields, scratch: &mut Scratch, tolerance: f64) -> Result<bool> {
    let rail = problem.rail;
    let grid = &rail.grid;
    let coupled = match &rail.coupling {
        Some(tables) => {
            let window = Window::whole(grid);
            let [lift, ignored] = &mut scratch.lift;
            let load = [&fields.shear[0][..], &fields.shear[1][..]];
            rail.transform
                .apply(tables, &window, load, [lift, ignored], &mut scratch.products);
            true
        }
        None => false,
    };
    for strip in 0..grid.strips {
        for cell in 0..grid.cells {
            let (place, index) = (grid.place(strip, cell), strip * grid.cells + cell);
            let lift = scratch.iterate.lift()[index] + if coupled { scratch.lift[0][place] } else { 0.0 };
            scratch.gap[place] = rail.gap[place] + scratch.iterate.wear()[index] - lift;
        }
    }
    std::mem::swap(&mut scratch.contact, &mut scratch.contact_before);
    let solved = scratch.normal.solve(
        &NormalProblem {
            grid,
            transform: &rail.transform,
            approach: &rail.approach,
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
    let rail = problem.rail;
    let grid = &rail.grid;
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
    // Coulomb's bound, and what the leading edge adds: the opening ahead is that of the gap in the ratio of the tractions.
    fields.friction.fill(0.0);
    for run in scratch.contact.runs() {
        let leading = if forward { run.cells - 1 } else { 0 };
        for (k, place) in run.places(grid).enumerate() {
            let index = run.offset + k;
            let cell = run.first + k;
            let temperature = scratch.iterate.temperature(run.strip * grid.cells + cell);
            let mu = law.coefficient(temperature).0;
            fields.friction[place] = mu;
            scratch.bound[index] = mu * fields.pressure[place];
            scratch.edge[index] = if k == leading {
                let gap = scratch.normal.separation[place.wrapping_add_signed(ahead)];
                let ratio = problem.opening(gap, fields.pressure[place]);
                rail.opening.map(|factor| weights.strain_speed * factor * ratio)
            } else {
                [0.0; 2]
            };
        }
    }
    keep_within_bounds(grid, &scratch.contact, &scratch.bound, fields, &mut scratch.nothing);
    free_slip(problem, &weights, fields, scratch);
    let own = f64::from(scratch.response.own[0][scratch.response.origin]);
    let peak = largest(&fields.pressure);
    if own == 0.0 {
        slide_on_the_spot(problem, fields, scratch);
    } else {
        let friction_problem = FrictionProblem {
            grid,
            transform: rail.transform_for(scratch.strips).0,
            contact: &scratch.contact,
            response: &scratch.response,
            edge: &scratch.edge,
            free_slip: [&scratch.free_slip[0], &scratch.free_slip[1]],
            bound: &scratch.bound,
            scale: 1.0 / own,
            noise: problem.settings.patch.noise * own * peak,
            regularisation: problem.parameters.slip_regularisation,
            tolerance: peak * tolerance.max(problem.settings.patch.least_tolerance),
        };
        scratch.friction.solve(&friction_problem, &mut fields.shear)?;
    }
    mean_slip(problem, fields, scratch);
    Ok(())
}

/// A first guess within Coulomb's bound, nothing outside the contact.
fn keep_within_bounds(
    grid: &crate::body::grid::Grid,
    contact: &Contact,
    bound: &[f64],
    fields: &mut PatchFields,
    on_grid: &mut [f64],
) {
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
    let rail = problem.rail;
    let grid = &rail.grid;
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
    let rail = problem.rail;
    let grid = &rail.grid;
    let window = Window::whole(grid);
    for component in &mut scratch.given {
        component.fill(0.0);
    }
    if let Some(tables) = &rail.coupling {
        let [x, y] = &mut scratch.given;
        rail.transform.apply(
            tables,
            &window,
            [&fields.pressure, &scratch.nothing],
            [x, y],
            &mut scratch.products,
        );
    }
    let heat = &mut scratch.expansion;
    if rail
        .expansion
        .displace(grid, &rail.transform, scratch.iterate.lift(), heat)
    {
        for (given, by_heat) in scratch.given.iter_mut().zip(&heat.displacement) {
            add_multiple(by_heat, 1.0, given);
        }
    }
}

/// At rest, where the slip is the wheel's alone: the law gives the shear, and there is none without slip.
fn slide_on_the_spot(problem: &Problem, fields: &mut PatchFields, scratch: &mut Scratch) {
    let grid = &problem.rail.grid;
    let epsilon = problem.parameters.slip_regularisation;
    for run in scratch.contact.runs() {
        for (index, place) in run.own().zip(run.places(grid)) {
            let slip = [scratch.free_slip[0][place], scratch.free_slip[1][place]];
            let speed = coulomb::magnitude(slip);
            let saturation = if epsilon > 0.0 {
                coulomb::saturation(speed, epsilon)
            } else {
                1.0
            };
            for (slip, shear) in slip.into_iter().zip(&mut fields.shear) {
                shear[place] = if speed > 0.0 {
                    -scratch.bound[index] * saturation * slip / speed
                } else {
                    0.0
                };
            }
        }
    }
}

/// The slip at the centres of the cells, the mean of that ahead and that behind: it heats, wears and takes power.
fn mean_slip(problem: &Problem, fields: &mut PatchFields, scratch: &mut Scratch) {
    let grid = &problem.rail.grid;
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

/// (24), and how much softer the contact is by the wear of the step.
fn march_wear(problem: &Problem, before: &PatchFields, fields: &mut PatchFields, scratch: &mut Scratch) {
    let rail = problem.rail;
    let grid = &rail.grid;
    let per_slip = problem.parameters.wear_coefficient * rail.scales.pressure;
    let speed = problem.conditions.motion.rolling_speed.abs();
    let own = CellStep::new(1.0 / problem.conditions.duration, grid.length, speed).own / rail.scales.displacement;
    let mut fastest = 0.0_f64;
    for strip in 0..grid.strips {
        for cell in 0..grid.cells {
            let place = grid.place(strip, cell);
            let slip = coulomb::magnitude([fields.slip[0][place], fields.slip[1][place]]);
            fastest = fastest.max(slip);
            scratch.wear_rate[strip * grid.cells + cell] = per_slip * slip * fields.pressure[place];
        }
    }
    let soft = per_slip * own * fastest
        > problem.settings.softening.explicit * problem.settings.patch.least_compliance * rail.approach.own;
    for place in 0..grid.len() {
        let slip = coulomb::magnitude([fields.slip[0][place], fields.slip[1][place]]);
        scratch.softness[place] = if soft { per_slip * own * slip } else { 0.0 };
    }
    problem.wear_march().advance(
        &scratch.wear_rate,
        problem.conditions.inputs.incoming_wear_depth,
        &before.wear,
        &mut fields.wear,
        &mut scratch.wear_steps,
    );
}

/// (19), (23) together with the rim's temperature: what the rail gives to the wheel and what the wheel takes is the same heat.
fn march_heat(problem: &Problem, before: &PatchFields, fields: &mut PatchFields, scratch: &mut Scratch) -> Result<()> {
    let heating = problem.parameters.wheel_heating;
    let guess = match heating {
        WheelHeating::Off => problem.conditions.inputs.ambient_temperature,
        WheelHeating::On => scratch.iterate.wheel_temperature(),
    };
    let mut wheel = rim::FixedPoint::new(guess, problem.settings.heat);
    let march = problem.heat_march();
    loop {
        let rise = problem.wheel_rise(wheel.temperature());
        problem.exchange(fields, rise, &mut scratch.exchange);
        march.heat(&scratch.exchange, &mut fields.heat, &mut scratch.heat)?;
        // The wheel takes the friction power at this temperature: the heat balance closes to round-off.
        if heating == WheelHeating::On {
            close_friction(problem, fields, &scratch.contact);
        }
        warm_wheel(problem, before, fields);
        if wheel.rests(fields.wheel_temperature)? {
            return Ok(());
        }
    }
}

/// The rim's temperature under what the contact gives to it.
fn warm_wheel(problem: &Problem, before: &PatchFields, fields: &mut PatchFields) {
    let heat = ContactHeat::new(
        problem.parameters,
        problem.rail.unit_force(),
        problem.heated_nodes(fields, fields),
    );
    fields.wheel_temperature = rim::temperature(
        problem.parameters,
        before.wheel_temperature,
        problem.conditions.inputs.ambient_temperature,
        problem.conditions.duration,
        &heat,
    );
}

/// Friction coefficient and shear at the final temperature: the friction power of the fields is, to round-off, the one that
/// has heated rail and wheel.
fn close_friction(problem: &Problem, fields: &mut PatchFields, contact: &Contact) {
    let grid = &problem.rail.grid;
    let law = problem.friction();
    for run in contact.runs() {
        for (k, place) in run.places(grid).enumerate() {
            let mu = law
                .coefficient(fields.heat.surface[run.strip * grid.cells + run.first + k])
                .0;
            let ratio = if fields.friction[place] > 0.0 {
                mu / fields.friction[place]
            } else {
                1.0
            };
            fields.friction[place] = mu;
            for component in &mut fields.shear {
                component[place] *= ratio;
            }
        }
    }
}

/// What acts on nothing any more within the step.
fn finish(problem: &Problem, before: &PatchFields, fields: &mut PatchFields, scratch: &mut Scratch) -> Result<()> {
    close_friction(problem, fields, &scratch.contact);
    close_displacement(problem, fields, scratch);
    let breadth = problem.breadth(fields);
    problem
        .heat_march()
        .finish(&before.heat, breadth, &mut fields.heat, &mut scratch.heat)?;
    problem
        .wear_march()
        .finish(breadth, &before.wear, &mut fields.wear, &mut scratch.wear_steps);
    warm_wheel(problem, before, fields);
    Ok(())
}

/// The displacement of the fields at the end of the step, and its change.
fn close_displacement(problem: &Problem, fields: &mut PatchFields, scratch: &mut Scratch) {
    // The displacement that does not come from shear is that which the tractions have felt.
    let rail = problem.rail;
    let window = Window::whole(&rail.grid);
    let [x, y] = &mut scratch.lift;
    let load = [&fields.shear[0][..], &fields.shear[1][..]];
    rail.transform
        .apply(&rail.displacement, &window, load, [x, y], &mut scratch.products);
    for component in 0..2 {
        let parts = scratch.given[component]
            .iter()
            .zip(&scratch.lift[component])
            .zip(&scratch.before[component]);
        let own = fields.displacement[component]
            .iter_mut()
            .zip(&mut fields.displacement_change[component]);
        for ((now, change), ((given, by_shear), before)) in own.zip(parts) {
            *now = given + by_shear;
            *change = *now - before;
        }
    }
}

/// Whether the contact is held within its window. Under a load that the window was made for it may be: a wheel that spins on the
/// spot digs a groove that no window holds. A load beyond that, by a penetration that is given, is an error.
fn fills_window(problem: &Problem, fields: &PatchFields, scratch: &Scratch) -> Result<bool> {
    let grid = &problem.rail.grid;
    let places = (0..grid.strips).flat_map(|strip| grid.row(strip));
    let overlap = problem.settings.mechanics.overlap;
    let in_contact = scratch.contact.cells() > 0;
    let at_side = |place: usize| {
        let strip = place / grid.stride();
        (strip == 0 || strip + 1 == grid.strips) && fields.pressure[place] > 0.0
    };
    let cut_off = in_contact
        && places.into_iter().any(|place| {
            !normal::is_free(grid, place) && scratch.normal.separation[place] < -overlap || at_side(place)
        });
    let load = problem.rail.unit_force() * fields.pressure.iter().sum::<f64>();
    if cut_off && load > problem.parameters.largest_load * (1.0 + 1e-9) {
        return Err(Error::ContactLeavesWindow {
            half_width: grid.half_length(),
            load,
            largest_load: problem.parameters.largest_load,
        });
    }
    Ok(cut_off)
}
