//! The operator split of section 4 of the paper: mechanics for given temperature and wear, wear and temperature for given
//! tractions, repeated until the temperature rests.

use super::coupling::Coupling;
use super::fields::Fields;
use super::operators::LineOperators;
use super::problem::{MechanicsData, Problem};
use crate::contact::rest::Rest;
use crate::contact::rim::{self, ContactHeat};
use crate::contact::task::Convergence;
use crate::error::{Error, Result};
use crate::friction::memory::Memory;
use crate::heat::factors::CellFactors;
use crate::heat::march::Heated;
use crate::heat::surface::SurfaceExchange;
use crate::mechanics::normal::problem::Constraint;
use crate::mechanics::softening::Softening;
use crate::mechanics::sweep::{Mechanics, Sweep};
use crate::numerics::anderson::Anderson;
use crate::numerics::dense::{largest, largest_change, relative};
use crate::parameters::WheelHeating;
use crate::settings::Settings;
use crate::transport::CellStep;
use crate::wear::WearSteps;

/// Buffers of a split.
pub struct Scratch {
    pub(super) softening: Softening,
    pub(super) mechanics: Mechanics,
    pub(super) data: MechanicsData,
    /// What the mechanics see of heat and wear in this iteration, and what heat and wear give for the next one.
    pub(super) iterate: Coupling,
    image: Coupling,
    exchange: Vec<SurfaceExchange>,
    wear_rate: Vec<f64>,
    wear_steps: WearSteps,
    /// Of the heat march.
    pub(super) cells: CellFactors,
    /// Of the thermal map.
    pub(super) moments: Vec<f64>,
    /// The heat flux that the thermal map was last applied to.
    mapped_flux: Vec<f64>,
    /// The surface temperature at the contact nodes then.
    mapped_temperature: Vec<f64>,
    anderson: Anderson,
}

impl Scratch {
    /// Buffers for the given rail.
    pub fn new(operators: &LineOperators, settings: &Settings) -> Scratch {
        let n = operators.mesh.contact_nodes;
        let iterate = Coupling::new(n);
        Scratch {
            softening: Softening::new(&operators.compliance.at_rest.normal_normal, settings.softening),
            mechanics: Mechanics::new(n, settings),
            data: MechanicsData::new(n),
            exchange: vec![SurfaceExchange::default(); n],
            wear_rate: vec![0.0; n],
            wear_steps: WearSteps::new(&operators.mesh.x),
            cells: CellFactors::new(&operators.heat.basis, &operators.mesh.x),
            moments: vec![0.0; operators.heat.displacement.scratch_len()],
            mapped_flux: vec![0.0; n],
            mapped_temperature: vec![0.0; n],
            anderson: Anderson::new(iterate.values().len()),
            image: iterate.clone(),
            iterate,
        }
    }

    /// Forgets what the step before has left: a step follows from the state alone.
    fn start_step(&mut self) {
        self.mechanics.start_step();
        self.softening.start_step();
        self.anderson.restart();
    }
}

/// Solves the step: `fields` holds the first guess and receives the solution; temperature and wear at its start are those of
/// `before`.
///
/// # Errors
/// The first solver that did not converge, or [`Error::ContactLeavesWindow`]; `fields` is then unspecified.
pub fn solve(problem: &Problem, before: &Fields, fields: &mut Fields, scratch: &mut Scratch) -> Result<Convergence> {
    let settings = problem.settings.split;
    fields.relaxation_length = problem.relaxation_length(before);
    scratch.data.start_from(before);
    remember(problem, before, fields);
    start(problem, fields, scratch);
    replace_inflow(problem, before, fields);
    let mut rest = Rest::new(settings);
    for iterations in 1..=settings.iterations {
        // Step 2: tractions for given temperature and wear.
        let sweep = solve_tractions(problem, fields, scratch, rest.mechanics_tolerance())?;
        // Step 3: wear and temperature for given tractions.
        march_wear(problem, before, fields, scratch);
        march_heat(problem, before, fields, scratch)?;
        soften(problem, fields, scratch);
        scratch.image.read(problem.operators, fields, &scratch.softening);
        // Step 4: at rest? Not after the first iteration: the mechanics have not seen yet what it changed.
        let unmapped = if iterations > 1 {
            unmapped_displacement(problem, fields, scratch)
        } else {
            f64::INFINITY
        };
        let change = scratch.iterate.change_to(&scratch.image, settings.least_temperature);
        if rest.is_reached(change.max(unmapped), &sweep) {
            let fills_window = fills_window(problem, fields, scratch)?;
            close_friction(problem, fields);
            close_memory(problem, fields);
            problem.close_displacement(&scratch.iterate, fields, &scratch.data);
            warm_wheel(problem, before, fields);
            return Ok(Convergence {
                iterations,
                residual: rest.change(),
                fills_window,
            });
        }
        if unmapped > settings.unfelt * settings.tolerance {
            map_displacement(problem, fields, scratch);
            rest.amend(scratch.iterate.change_to(&scratch.image, settings.least_temperature));
        }
        if iterations > settings.accelerate_after {
            scratch
                .anderson
                .next(scratch.iterate.values(), scratch.image.values_mut());
        }
        std::mem::swap(&mut scratch.iterate, &mut scratch.image);
    }
    Err(Error::SplitNotConverged {
        iterations: settings.iterations,
        residual: rest.change(),
        tolerance: settings.tolerance,
    })
}

/// The mechanics alone, for given temperature and wear.
///
/// # Errors
/// As [`solve`].
pub fn solve_mechanics(problem: &Problem, fields: &mut Fields, scratch: &mut Scratch) -> Result<()> {
    let settings = problem.settings.split;
    let tolerance = settings.mechanics_alone_tolerance;
    fields.memory.start_steady();
    start(problem, fields, scratch);
    let mut residual = f64::INFINITY;
    for _ in 0..settings.iterations {
        let sweep = solve_tractions(problem, fields, scratch, tolerance)?;
        residual = sweep.shear_change;
        if sweep.rests(tolerance) {
            problem.close_displacement(&scratch.iterate, fields, &scratch.data);
            // There was no step before it.
            fields.displacement_change.fill(0.0);
            close_memory(problem, fields);
            return fills_window(problem, fields, scratch).map(|_| ());
        }
    }
    Err(Error::MechanicsNotConverged {
        iterations: settings.iterations,
        residual,
        tolerance,
    })
}

/// Factorises the mechanics at `fields`, which are at rest.
///
/// # Errors
/// Mechanics that are not at rest or singular.
pub fn linearise_mechanics(problem: &Problem, fields: &mut Fields, scratch: &mut Scratch) -> Result<()> {
    scratch.data.start_from_end(fields);
    start(problem, fields, scratch);
    problem.update_mechanics_data(&scratch.iterate, fields, &mut scratch.data);
    let (mechanics_problem, mut tractions) = problem.mechanics(fields, &scratch.data, &scratch.softening);
    scratch.mechanics.linearise(&mechanics_problem, &mut tractions)
}

/// Begins an iteration from `fields`.
fn start(problem: &Problem, fields: &Fields, scratch: &mut Scratch) {
    scratch.start_step();
    soften(problem, fields, scratch);
    scratch.iterate.read(problem.operators, fields, &scratch.softening);
}

/// Keeps what stands in the inflow column before something new enters there.
fn replace_inflow(problem: &Problem, before: &Fields, fields: &mut Fields) {
    let inflow = problem.upwind().inflow();
    let modes = problem.operators.heat.basis.len();
    fields.replaced_inflow[..modes].copy_from_slice(before.column(problem.operators, inflow));
    fields.replaced_inflow[modes] = before.wear[inflow];
}

/// (31): one sweep of the mechanics for given temperature and wear. Without load there is nothing to solve.
fn solve_tractions(problem: &Problem, fields: &mut Fields, scratch: &mut Scratch, tolerance: f64) -> Result<Sweep> {
    if problem.constraint() == Constraint::Total(0.0) {
        fields.pressure.fill(0.0);
        fields.shear.fill(0.0);
        fields.slip.fill(0.0);
        fields.saturation.fill(0.0);
        fields.penetration = 0.0;
        fields.memory.now.speed.fill(0.0);
        fields.memory.now.flow.fill(0.0);
        return Ok(Sweep::NONE);
    }
    problem.update_mechanics_data(&scratch.iterate, fields, &mut scratch.data);
    let (mechanics_problem, mut tractions) = problem.mechanics(fields, &scratch.data, &scratch.softening);
    let of_slip = mechanics_problem.path.is_some();
    let sweep = scratch.mechanics.sweep(&mechanics_problem, &mut tractions, tolerance)?;
    if of_slip {
        fields.memory.now.resting.copy_from_slice(scratch.data.friction());
    }
    Ok(sweep)
}

/// What the rail brings along from the step before.
fn remember(problem: &Problem, before: &Fields, fields: &mut Fields) {
    let remembers = Memory::is_kept(problem.parameters);
    fields.memory.remembers = remembers;
    if remembers {
        let (law, first) = (problem.friction(), problem.operators.mesh.first_contact);
        let resting = |node: usize| law.coefficient(before.surface_temperature[first + node]).0;
        fields.memory.start_from(&before.memory, resting);
    }
}

/// What the rail takes along into the next step.
fn close_memory(problem: &Problem, fields: &mut Fields) {
    fields.memory.remembers = Memory::is_kept(problem.parameters);
    let (Some(path_law), true) = (problem.path_law(), fields.memory.remembers) else {
        return;
    };
    let (law, first) = (problem.friction(), problem.operators.mesh.first_contact);
    let nodes = fields.pressure.len();
    let Fields {
        memory,
        pressure,
        surface_temperature,
        ..
    } = fields;
    for (resting, temperature) in memory.now.resting.iter_mut().zip(&surface_temperature[first..]) {
        *resting = law.coefficient(*temperature).0;
    }
    let touches = |node: usize| pressure[node] > 0.0;
    let now = &mut memory.now;
    path_law.close(&memory.before.path(0..nodes), &now.resting, touches, &mut now.friction);
}

/// Adapts the normal compliance to the wear of the step.
fn soften(problem: &Problem, fields: &Fields, scratch: &mut Scratch) {
    let transport = problem.upwind();
    let changed = scratch.softening.update(
        &problem.operators.compliance.at_rest.normal_normal,
        &fields.slip,
        problem.operators.scales.compliance(problem.parameters.wear_coefficient),
        CellStep::new(
            1.0 / problem.conditions.duration,
            problem.operators.mesh.contact_spacing(),
            transport.speed(),
        ),
        transport.is_forward(),
    );
    if changed {
        scratch.mechanics.forget_normal_compliance();
    }
}

/// (24).
fn march_wear(problem: &Problem, before: &Fields, fields: &mut Fields, scratch: &mut Scratch) {
    let nodes = fields.pressure.iter().zip(&fields.slip);
    for (rate, (pressure, slip)) in scratch.wear_rate.iter_mut().zip(nodes) {
        *rate = problem.parameters.wear_coefficient * slip.abs() * pressure * problem.operators.scales.pressure;
    }
    let march = problem.wear_march();
    fields.wear[march.transport.inflow()] = problem.conditions.inputs.incoming_wear_depth;
    march.advance(
        &scratch.wear_rate,
        &before.wear,
        &mut fields.wear,
        &mut scratch.wear_steps,
    );
}

/// (19), (23) together with the rim's temperature: what the rail gives to the wheel and what the wheel takes is the same
/// heat. With a cold wheel this is one march.
fn march_heat(problem: &Problem, before: &Fields, fields: &mut Fields, scratch: &mut Scratch) -> Result<()> {
    let heating = problem.parameters.wheel_heating;
    let guess = match heating {
        WheelHeating::Off => problem.conditions.inputs.ambient_temperature,
        WheelHeating::On => scratch.iterate.wheel_temperature(),
    };
    let mut wheel = rim::FixedPoint::new(guess, problem.settings.heat);
    loop {
        march_rail(
            problem,
            before,
            fields,
            scratch,
            problem.wheel_rise(wheel.temperature()),
        )?;
        // The wheel takes the friction power at this temperature, not at that of the march before: so the heat balance
        // closes to round-off, whatever the tolerance of this iteration.
        if heating == WheelHeating::On {
            close_friction(problem, fields);
        }
        warm_wheel(problem, before, fields);
        if wheel.rests(fields.wheel_temperature)? {
            return Ok(());
        }
    }
}

/// (19), (23) with the wheel at θ_w.
fn march_rail(
    problem: &Problem,
    before: &Fields,
    fields: &mut Fields,
    scratch: &mut Scratch,
    wheel_rise: f64,
) -> Result<()> {
    problem.exchange(fields, wheel_rise, &mut scratch.exchange);
    let inputs = &problem.conditions.inputs;
    let march = problem.heat_march();
    let mut after = Heated {
        amplitudes: &mut fields.temperature,
        surface: &mut fields.surface_temperature,
        flux: &mut fields.heat_flux,
    };
    let rise = inputs.incoming_temperature - inputs.ambient_temperature;
    problem.operators.heat.enter(rise, march.transport.inflow(), &mut after);
    march.advance(&before.temperature, &scratch.exchange, &mut after, &mut scratch.cells)
}

/// The rim's temperature under what the contact gives to it.
fn warm_wheel(problem: &Problem, before: &Fields, fields: &mut Fields) {
    fields.wheel_temperature = rim::temperature(
        problem.parameters,
        before.wheel_temperature,
        problem.conditions.inputs.ambient_temperature,
        problem.conditions.duration,
        &ContactHeat::new(problem.parameters, problem.unit_force(), problem.heated_nodes(fields)),
    );
}

/// Bound of the thermal displacement that the heat of this iteration would add if the thermal map were applied. The flux
/// has changed by some share since the map was applied last; the displacement changes by less than that share, because
/// most of the heat was there before; and the same holds of the share by which the surface temperature has changed, which tells
/// the noise of next to no flux from heat. The bound spares the last iteration of a step the map, the
/// largest part of its work: the fields keep the displacement that the tractions have felt.
fn unmapped_displacement(problem: &Problem, fields: &Fields, scratch: &Scratch) -> f64 {
    let share = |now: &[f64], mapped: &[f64]| relative(largest_change(now, mapped), largest(mapped));
    let temperature = &fields.surface_temperature[problem.operators.mesh.window()];
    let share = share(&fields.heat_flux, &scratch.mapped_flux).min(share(temperature, &scratch.mapped_temperature));
    if share.is_infinite() {
        share
    } else {
        share * largest(&fields.thermal_displacement)
    }
}

/// The thermal displacement of the temperature, for the fields and for the next iteration.
fn map_displacement(problem: &Problem, fields: &mut Fields, scratch: &mut Scratch) {
    problem.operators.heat.displacement.apply(
        &fields.temperature,
        &mut scratch.moments,
        &mut fields.thermal_displacement,
    );
    scratch.mapped_flux.copy_from_slice(&fields.heat_flux);
    let window = problem.operators.mesh.window();
    scratch
        .mapped_temperature
        .copy_from_slice(&fields.surface_temperature[window]);
    scratch.image.set_displacement(&fields.thermal_displacement);
}

/// Friction coefficient and shear at the final temperature. What is left of the split's tolerance goes into the equilibrium
/// of the tractions, and the friction power of the fields is, to round-off, the one that has heated rail and wheel.
fn close_friction(problem: &Problem, fields: &mut Fields) {
    let law = problem.friction();
    let first = problem.operators.mesh.first_contact;
    let of_slip = problem.path_law().is_some();
    for node in 0..fields.pressure.len() {
        let resting = law.coefficient(fields.surface_temperature[first + node]).0;
        let mut mu = resting;
        if of_slip && fields.pressure[node] > 0.0 {
            mu = fields.memory.close(node, resting);
        }
        fields.friction[node] = mu;
        if fields.pressure[node] > 0.0 {
            fields.shear[node] = -mu * fields.pressure[node] * fields.saturation[node];
        }
    }
}

/// Whether the contact is held within its window. Under a load that the window was made for it may be: a wheel that spins on the
/// spot digs a groove of its own radius, which no window holds, and the groove is as wide as the window then. A load beyond
/// that, by a penetration that is given, is an error.
fn fills_window(problem: &Problem, fields: &Fields, scratch: &Scratch) -> Result<bool> {
    let cut_off = scratch.mechanics.is_cut_off() && fields.pressure.iter().any(|&p| p > 0.0);
    let load = problem.unit_force() * fields.pressure.iter().sum::<f64>();
    if cut_off && load > problem.parameters.largest_load * (1.0 + 1e-9) {
        return Err(Error::ContactLeavesWindow {
            half_width: problem.operators.mesh.window_half_width(),
            load,
            largest_load: problem.parameters.largest_load,
        });
    }
    Ok(cut_off)
}
