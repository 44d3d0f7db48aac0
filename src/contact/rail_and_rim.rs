//! Heat of rail and rim: what the rail gives to the wheel and what the wheel takes is the same heat.

use super::engine::{Direction, Engine, Linearised};
use super::interface::Interface;
use super::problem::Problem;
use super::rim::{self, ContactHeat};
use crate::error::Result;
use crate::parameters::WheelHeating;

/// Marches heat (19), (23) together with the rim's temperature: what the rail gives to the wheel and what the wheel takes is the
/// same heat. With a cold wheel this is one march.
pub fn march_heat<E: Engine>(
    problem: &Problem<E>,
    before: &E::Fields,
    interface: &Interface,
    now: &mut E::Fields,
    solvers: &mut E::Solvers,
) -> Result<()> {
    let heating = problem.parameters.wheel_heating;
    let guess = match heating {
        WheelHeating::Off => problem.conditions.inputs.ambient_temperature,
        WheelHeating::On => interface.wheel_temperature(),
    };
    let mut wheel = rim::FixedPoint::new(guess, problem.settings.heat);
    problem.operators.set_surface_temperature(interface, now);
    loop {
        E::march_heat(problem, before, problem.wheel_rise(wheel.temperature()), now, solvers)?;
        // The wheel takes the friction power at the temperature of this march, not at that of the mechanics: so the heat balance
        // closes to round-off, whatever the tolerance of this iteration.
        if heating == WheelHeating::On {
            E::finalise_friction(problem, now, solvers);
        }
        warm_wheel(problem, before, now);
        if wheel.converges(E::wheel_temperature(now))? {
            return Ok(());
        }
    }
}

/// Sets the rim's temperature to that under the heat that the contact gives to it.
pub fn warm_wheel<E: Engine>(problem: &Problem<E>, before: &E::Fields, now: &mut E::Fields) {
    let heat = ContactHeat::new(
        problem.parameters,
        problem.unit_force(),
        E::heated_nodes(problem, now, now),
    );
    let temperature = rim::temperature(
        problem.parameters,
        E::wheel_temperature(before),
        problem.conditions.inputs.ambient_temperature,
        problem.conditions.duration,
        &heat,
    );
    E::set_wheel_temperature(now, temperature);
}

/// Sets the change of the rim's temperature.
pub fn wheel_tangent<E: Engine>(at: &Linearised<E>, direction: &Direction, change: &mut E::Fields) {
    let (problem, fields) = (at.problem, &*at.fields);
    let (parameters, force) = (problem.parameters, problem.unit_force());
    let nodes = || E::heated_nodes(problem, fields, fields);
    let heat = ContactHeat::new(parameters, force, nodes());
    let heat_tangent = ContactHeat::tangent(parameters, force, nodes().zip(E::heated_nodes(problem, fields, change)));
    let ambient = problem.conditions.inputs.ambient_temperature;
    let temperature = rim::temperature_tangent(
        parameters,
        E::wheel_temperature(fields),
        ambient,
        direction.inputs.ambient_temperature,
        problem.conditions.duration,
        &heat,
        &heat_tangent,
    );
    E::set_wheel_temperature(change, temperature);
}
