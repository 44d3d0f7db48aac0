//! One implicit step of the patch by the operator split of section 4 of the paper: pressure, then friction for that pressure,
//! then wear and heat for those tractions, until temperature and wear rest.
//!
//! What wear and heat give is handed to the next iteration as one vector ([`super::coupling::Coupling`]), on which Anderson's method works. The
//! last iteration is followed by what acts on nothing any more within the step: the heat under the surface, the rail behind the
//! window, the displacement.

use super::fields::{PatchFields, PatchTrend};
use super::memory;
use super::problem::Problem;
use super::scratch::Scratch;
use super::tractions;
use crate::body::influence::Window;
use crate::contact::rest::Rest;
use crate::contact::rim::{self, ContactHeat};
use crate::contact::task::Convergence;
use crate::error::{Error, Result};
use crate::friction::coulomb;
use crate::mechanics::patch::contact::Contact;
use crate::mechanics::patch::normal;
use crate::parameters::WheelHeating;
use crate::transport::CellStep;

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
    memory::remember(problem, before, fields);
    start(problem, fields, scratch);
    let inputs = &problem.conditions.inputs;
    let rise = inputs.incoming_temperature - inputs.ambient_temperature;
    problem
        .heat_march()
        .start(&before.heat, rise, &mut fields.heat, &mut scratch.heat)?;
    guess(before, (trend, ahead), fields);
    scratch.iterate.read(problem.operators, fields, &scratch.softness);
    let mut rest = Rest::new(settings.patch_split());
    for iterations in 1..=settings.split.iterations {
        let sweep = tractions::solve(problem, fields, scratch, rest.mechanics_tolerance())?;
        march_wear(problem, before, fields, scratch);
        march_heat(problem, before, fields, scratch)?;
        scratch.image.read(problem.operators, fields, &scratch.softness);
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
    fields.memory.start_steady();
    start(problem, fields, scratch);
    for component in 0..2 {
        scratch.before[component].fill(0.0);
    }
    scratch.iterate.read(problem.operators, fields, &scratch.softness);
    let settings = problem.settings;
    let tolerance = settings.patch.tolerance;
    let mut residual = f64::INFINITY;
    for _ in 0..settings.split.iterations {
        let sweep = tractions::solve(problem, fields, scratch, tolerance)?;
        residual = sweep.shear_change;
        if sweep.rests(tolerance) {
            fills_window(problem, fields, scratch)?;
            close_displacement(problem, fields, scratch);
            memory::close(problem, fields);
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
    let grid = &problem.operators.grid;
    scratch.contact.list(grid, |place| fields.pressure[place] > 0.0);
    let strips = scratch.contact.window(grid, 0).strips.len();
    tractions::respond(
        problem,
        problem.slip_weights(problem.transient(fields)),
        strips,
        scratch,
    );
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

/// (24), and how much softer the contact is by the wear of the step.
fn march_wear(problem: &Problem, before: &PatchFields, fields: &mut PatchFields, scratch: &mut Scratch) {
    let operators = problem.operators;
    let grid = &operators.grid;
    let per_slip = problem.parameters.wear_coefficient * operators.scales.pressure;
    let speed = problem.conditions.motion.rolling_speed.abs();
    let own =
        CellStep::new(1.0 / problem.conditions.duration, grid.length, speed).diagonal / operators.scales.displacement;
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
        > problem.settings.softening.explicit * problem.settings.patch.least_compliance * operators.approach.own;
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
        // The wheel takes its share of the friction power, and the surface temperature that sets μ changes with every temperature of
        // the wheel that is tried: so do bound and shear, here and not only at the end, or the wheel would be warmed by another power
        // than that of the fields. Shear over bound, by which the rail is heated, stays. The heat balance closes to round-off.
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
        problem.operators.unit_force(),
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
    let grid = &problem.operators.grid;
    let law = problem.friction();
    let of_slip = problem.path_law().is_some();
    for run in contact.runs() {
        for (k, place) in run.places(grid).enumerate() {
            let index = run.strip * grid.cells + run.first + k;
            let resting = law.coefficient(fields.heat.surface[index]).0;
            let mut mu = resting;
            if of_slip {
                mu = fields.memory.close(index, resting);
            }
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
    memory::close(problem, fields);
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
    let operators = problem.operators;
    let window = Window::whole(&operators.grid);
    let [x, y] = &mut scratch.lift;
    let load = [&fields.shear[0][..], &fields.shear[1][..]];
    operators
        .transform
        .apply(&operators.displacement, &window, load, [x, y], &mut scratch.products);
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
    let grid = &problem.operators.grid;
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
    let load = problem.operators.unit_force() * fields.pressure.iter().sum::<f64>();
    if cut_off && load > problem.parameters.largest_load * (1.0 + 1e-9) {
        return Err(Error::ContactLeavesWindow {
            half_width: grid.half_length(),
            load,
            largest_load: problem.parameters.largest_load,
        });
    }
    Ok(cut_off)
}
