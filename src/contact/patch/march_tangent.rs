//! The change of heat and wear of a patch with the inputs and the interface vector, at the point of a linearised step.

use super::extent::extent;
use super::fields::PatchFields;
use super::operators::PatchOperators;
use super::problem::PatchProblem;
use super::tangent::PatchTangent;
use crate::contact::engine::{Along, Direction, Linearised};
use crate::error::Result;
use crate::heat::strips::{CarriageChange, StripHeatChange};
use crate::heat::surface::{CommonChange, ExchangeChange, SurfaceExchange};
use crate::numerics::dense::largest;
use crate::parameters::WheelHeating;
use crate::wear::WearChange;

/// Begins a direction in fields without a change: sets that of the rail without a change of the heat flux.
pub fn begin(
    problem: &PatchProblem,
    fields: &PatchFields,
    direction: &Direction,
    change: &mut PatchFields,
    tangent: &mut PatchTangent,
) {
    if problem.conditions.duration > 0.0 {
        let carriage = carriage(direction, 0.0);
        problem
            .heat_march()
            .start_tangent(&fields.heat, &carriage, &mut change.heat, &mut tangent.heat);
    }
}

/// Computes the change of the wear (24).
pub fn wear(at: &mut Linearised<PatchOperators>, direction: &Direction, change: &mut PatchFields) {
    let (problem, fields) = (at.problem, &*at.fields);
    let wear_rate = &mut at.tangent.wear_rate;
    let (grid, per_slip) = (&problem.operators.grid, problem.wear_per_slip());
    let law = problem.pointwise_wear();
    for (strip, rates) in wear_rate.chunks_exact_mut(grid.cells).enumerate() {
        for (rate, place) in rates.iter_mut().zip(grid.row(strip)) {
            let speed = problem.sliding(fields, place).speed;
            let speed_change = problem.sliding_tangent(fields, change, place).speed;
            *rate = match &law {
                Some(law) => {
                    let point_change = problem.rubbing_tangent(fields, change, place);
                    law.rate_tangent(&problem.rubbing(fields, place), &point_change, direction.speed)
                }
                None => per_slip * (speed_change * fields.pressure[place] + speed * change.pressure[place]),
            };
        }
    }
    problem.wear_march().advance_tangent(
        WearChange {
            rate: wear_rate,
            speed: direction.speed,
        },
        direction.inputs.incoming_wear_depth,
        &fields.wear,
        &mut change.wear,
    );
}

/// Computes the change of the temperature (19), (23), for the change of the wheel's temperature in the interface vector.
///
/// # Errors
/// A surface condition that cannot be linearised.
pub fn heat(at: &mut Linearised<PatchOperators>, along: &Along, change: &mut PatchFields) -> Result<()> {
    let (problem, fields, direction) = (at.problem, &*at.fields, along.direction);
    let PatchTangent {
        exchange,
        exchange_change,
        heat,
        ..
    } = &mut *at.tangent;
    let (parameters, scale, grid) = (
        problem.parameters,
        problem.operators.scales.pressure,
        &problem.operators.grid,
    );
    let rise = problem.wheel_rise(at.interface.wheel_temperature());
    let rise_change = match parameters.wheel_heating {
        WheelHeating::Off => 0.0,
        WheelHeating::On => along.interface.wheel_temperature() - direction.inputs.ambient_temperature,
    };
    problem.exchange(fields, rise, exchange);
    let of_slip = problem.path_law().is_some();
    let (wear, capacity) = (problem.pointwise_wear(), parameters.volumetric_heat_capacity());
    for (strip, changes) in exchange_change.chunks_exact_mut(grid.cells).enumerate() {
        for (cell, (exchange_change, place)) in changes.iter_mut().zip(grid.row(strip)).enumerate() {
            let cell_change = ExchangeChange {
                pressure: change.pressure[place] * scale,
                sliding: problem.sliding_tangent(fields, change, place),
                wheel_rise: rise_change,
                coefficient: if of_slip && fields.pressure[place] > 0.0 {
                    let index = strip * grid.cells + cell;
                    change.friction[place] - fields.memory.share_at(index) * change.memory.now.static_friction[index]
                } else {
                    0.0
                },
            };
            let (pressure, sliding) = (fields.pressure[place] * scale, problem.sliding(fields, place));
            *exchange_change = SurfaceExchange::tangent(parameters, pressure, sliding, rise, &cell_change);
            if let Some(wear) = wear.filter(|_| pressure > 0.0) {
                let point_change = problem.rubbing_tangent(fields, change, place);
                let point = problem.rubbing(fields, place);
                exchange_change.debris = capacity * wear.rate_tangent(&point, &point_change, direction.speed);
            }
        }
    }
    let march_change = StripHeatChange {
        common: CommonChange {
            ambient: direction.inputs.ambient_temperature,
            friction_scale: direction.inputs.friction_scale,
        },
        exchange,
        exchange_tangent: exchange_change,
    };
    problem
        .heat_march()
        .heat_tangent(&fields.heat, &march_change, &mut change.heat, heat)
}

/// Computes the change of the heat under the surface and of the rail behind the window, on which no other equation of the step
/// depends.
pub fn finalise(at: &mut Linearised<PatchOperators>, direction: &Direction, change: &mut PatchFields) {
    let (problem, fields) = (at.problem, &*at.fields);
    let breadth = if at.touches {
        breadth_tangent(problem, &fields.pressure, &change.pressure)
    } else {
        0.0
    };
    let (heat, wear) = (problem.heat_march(), problem.wear_march());
    let carriage = carriage(direction, breadth);
    heat.finalise_tangent(&fields.heat, &carriage, &mut change.heat, &mut at.tangent.heat);
    wear.finalise_tangent(direction.speed, breadth, &fields.wear, &mut change.wear);
}

/// Change of what carries heat through the strips.
fn carriage(direction: &Direction, breadth: f64) -> CarriageChange {
    CarriageChange {
        speed: direction.speed,
        rise: direction.inputs.incoming_temperature - direction.inputs.ambient_temperature,
        breadth,
    }
}

/// The change of the contact's breadth, `m`, by a central difference.
fn breadth_tangent(problem: &PatchProblem, pressure: &[f64], change: &[f64]) -> f64 {
    let size = largest(change);
    if size == 0.0 {
        return 0.0;
    }
    let step = problem.settings.sensitivity.output_step * largest(pressure) / size;
    let at = |step: f64| {
        let moved: Vec<f64> = pressure
            .iter()
            .zip(change)
            .map(|(p, change)| p + step * change)
            .collect();
        extent(problem.operators, &moved).breadth
    };
    (at(step) - at(-step)) / (2.0 * step)
}
