//! Heat and wear of the line for given tractions: the marches across the columns, the thermal displacement, the wear compliance.

use super::fields::LineFields;
use super::mechanics::LineProblem;
use super::solvers::LineSolvers;
use crate::contact::interface::Interface;
use crate::contact::problem::Coupling;
use crate::error::Result;
use crate::friction::coulomb::{self, Sliding};
use crate::heat::march::{HeatMarch, Heated};
use crate::heat::surface::{SurfaceCondition, SurfaceExchange};
use crate::numerics::dense::{largest, largest_change, relative};
use crate::transport::{CellStep, Upwind};
use crate::wear::WearMarch;
use crate::wear::law::Rubbing;

impl<'a> LineProblem<'a> {
    /// Order in which material crosses the columns.
    pub fn upwind(&self) -> Upwind<'a> {
        Upwind::new(&self.operators.mesh.x, self.conditions.motion.rolling_speed)
    }

    /// Heat march of the step.
    pub fn heat_march(&self) -> HeatMarch<'a> {
        HeatMarch {
            basis: &self.operators.heat.basis,
            transport: self.upwind(),
            first_contact: self.operators.mesh.first_contact,
            duration: self.conditions.duration,
            surface: SurfaceCondition {
                friction: self.friction(),
                settings: self.settings.heat,
            },
        }
    }

    /// Wear march of the step.
    pub fn wear_march(&self) -> WearMarch<'a> {
        WearMarch {
            transport: self.upwind(),
            duration: self.conditions.duration,
            first_contact: self.operators.mesh.first_contact,
        }
    }

    /// State of a contact node that wears.
    pub fn rubbing(&self, fields: &LineFields, node: usize) -> Rubbing {
        let scale = self.operators.scales.pressure;
        Rubbing {
            pressure: scale * fields.pressure[node],
            speed: fields.slip[node].abs(),
            power: scale * coulomb::power(fields.shear[node], fields.slip[node]),
        }
    }

    /// Change of [`LineProblem::rubbing`] with that of the fields.
    pub fn rubbing_tangent(&self, fields: &LineFields, tangent: &LineFields, node: usize) -> Rubbing {
        let scale = self.operators.scales.pressure;
        let (shear, slip) = (fields.shear[node], fields.slip[node]);
        Rubbing {
            pressure: scale * tangent.pressure[node],
            speed: slip.signum() * tangent.slip[node],
            power: scale * coulomb::power_tangent(shear, slip, tangent.shear[node], tangent.slip[node]),
        }
    }

    /// Computes what heats and cools the surface at the contact nodes with the wheel at θ_w.
    pub fn exchange(&self, fields: &LineFields, wheel_rise: f64, exchange: &mut [SurfaceExchange]) {
        let of_slip = self.path_law().is_some();
        let (wear, capacity) = (self.pointwise_wear(), self.parameters.volumetric_heat_capacity());
        for (node, exchange) in exchange.iter_mut().enumerate() {
            let pressure = fields.pressure[node] * self.operators.scales.pressure;
            let sliding = Sliding::new(fields.slip[node], fields.utilisation[node]);
            *exchange = SurfaceExchange::new(self.parameters, pressure, sliding, wheel_rise);
            if of_slip && pressure > 0.0 {
                exchange.law = fields.memory.point_law(node);
            }
            if let Some(wear) = wear.filter(|_| pressure > 0.0) {
                exchange.debris = capacity * wear.rate(&self.rubbing(fields, node));
            }
        }
    }
}

/// Keeps the content of the inflow column before new rail enters there.
pub fn keep_inflow(problem: &LineProblem, before: &LineFields, now: &mut LineFields) {
    let inflow = problem.upwind().inflow();
    let modes = problem.operators.heat.basis.len();
    now.replaced_inflow[..modes].copy_from_slice(before.column(problem.operators, inflow));
    now.replaced_inflow[modes] = before.wear[inflow];
}

/// Marches the wear (24).
pub fn march_wear(problem: &LineProblem, before: &LineFields, now: &mut LineFields, solvers: &mut LineSolvers) {
    if let Some(law) = problem.pointwise_wear() {
        for (node, rate) in solvers.wear_rate.iter_mut().enumerate() {
            *rate = law.rate(&problem.rubbing(now, node));
        }
    } else {
        let nodes = now.pressure.iter().zip(&now.slip);
        for (rate, (pressure, slip)) in solvers.wear_rate.iter_mut().zip(nodes) {
            *rate = problem.parameters.wear_coefficient * slip.abs() * pressure * problem.operators.scales.pressure;
        }
    }
    let march = problem.wear_march();
    now.wear[march.transport.inflow()] = problem.conditions.inputs.incoming_wear_depth;
    march.advance(&solvers.wear_rate, &before.wear, &mut now.wear, &mut solvers.wear_steps);
}

/// Marches the heat (19), (23) with the wheel at θ_w.
///
/// # Errors
/// [`crate::error::Error::SurfaceHeatNotConverged`].
pub fn march_heat(
    problem: &LineProblem,
    before: &LineFields,
    wheel_rise: f64,
    now: &mut LineFields,
    solvers: &mut LineSolvers,
) -> Result<()> {
    problem.exchange(now, wheel_rise, &mut solvers.exchange);
    let march = problem.heat_march();
    let mut after = Heated {
        amplitudes: &mut now.temperature,
        surface: &mut now.surface_temperature,
        flux: &mut now.heat_flux,
    };
    let heat = &problem.operators.heat;
    heat.enter(problem.incoming_rise(), march.transport.inflow(), &mut after);
    march.advance(&before.temperature, &solvers.exchange, &mut after, &mut solvers.cells)
}

/// Adapts the normal compliance to the wear of the step; in a staggered one the wear follows the mechanics.
pub fn update_wear_compliance(problem: &LineProblem, now: &LineFields, solvers: &mut LineSolvers) {
    // Of a law with more than one coefficient the wear rate per pressure takes the place of the slip.
    let law = problem.pointwise_wear();
    if let Some(law) = &law {
        for (node, per_pressure) in solvers.wear_rate.iter_mut().enumerate() {
            *per_pressure = law.per_pressure(&problem.rubbing(now, node));
        }
    }
    let (wear_coefficient, slip) = match (problem.conditions.coupling, &law) {
        (Coupling::Implicit, None) => (problem.parameters.wear_coefficient, &now.slip),
        (Coupling::Implicit, Some(_)) => (1.0, &solvers.wear_rate),
        (Coupling::Staggered | Coupling::Held, _) => (0.0, &now.slip),
    };
    let (operators, transport) = (problem.operators, problem.upwind());
    let changed = solvers.wear_compliance.update(
        &operators.compliance.at_rest.normal_normal,
        slip,
        operators.scales.compliance(wear_coefficient),
        CellStep::new(
            1.0 / problem.conditions.duration,
            operators.mesh.contact_spacing(),
            transport.speed(),
        ),
        transport.is_forward(),
    );
    if changed {
        // That there is no wear compliance any more follows from the step before.
        let counts = solvers.wear_compliance.is_soft();
        solvers.mechanics.forget_normal_compliance(counts);
    }
}

/// Bound of the thermal displacement that the heat of this iteration would add if the thermal map were applied. Since the map
/// was applied last the flux has changed by some ratio; the displacement changes by a smaller one, because most of the heat was
/// there before. The ratio by which the surface temperature has changed is a bound as well, and the better one where the flux is
/// next to none and its changes are noise. The bound spares the last iteration of a step the map, the largest part of its work:
/// the fields keep the displacement that the tractions were solved for.
pub fn pending_displacement(problem: &LineProblem, now: &LineFields, solvers: &LineSolvers) -> f64 {
    let ratio = |now: &[f64], mapped: &[f64]| relative(largest_change(now, mapped), largest(mapped));
    let temperature = &now.surface_temperature[problem.operators.mesh.window()];
    // Without slip flux and temperature in the window may be nothing but round-off, which changes from iteration to iteration,
    // while the heat of the rail beside the window displaces it: a ratio to that is no measure.
    let settings = &problem.settings.split;
    let negligible = settings.negligible * settings.tolerance * settings.least_temperature;
    if largest_change(temperature, &solvers.mapped_temperature) <= negligible {
        return 0.0;
    }
    let ratio = ratio(&now.heat_flux, &solvers.mapped_flux).min(ratio(temperature, &solvers.mapped_temperature));
    if ratio.is_infinite() {
        ratio
    } else {
        ratio * largest(&now.thermal_displacement)
    }
}

/// Applies the thermal map.
pub fn map_displacement(problem: &LineProblem, now: &mut LineFields, solvers: &mut LineSolvers) {
    let displacement = &mut now.thermal_displacement;
    let map = &problem.operators.heat.displacement;
    map.apply(&now.temperature, &mut solvers.moments, displacement);
    solvers.mapped_flux.copy_from_slice(&now.heat_flux);
    let window = problem.operators.mesh.window();
    solvers
        .mapped_temperature
        .copy_from_slice(&now.surface_temperature[window]);
}

/// Writes the interface vector of the fields, or of a change of them.
pub fn read(problem: &LineProblem, fields: &LineFields, solvers: &LineSolvers, interface: &mut Interface) {
    let mut parts = interface.parts();
    let window = problem.operators.mesh.window();
    parts.set_temperatures(&fields.surface_temperature[window.clone()], fields.wheel_temperature);
    for (value, depth) in parts.gap.iter_mut().zip(&fields.wear[window]) {
        *value = depth / problem.operators.scales.displacement;
    }
    solvers
        .wear_compliance
        .subtract_proportional(&fields.pressure, parts.gap);
    // The displacement is that by heat and by the convective inertia of the tractions.
    parts.displacement.copy_from_slice(&fields.thermal_displacement);
    let (along, upward) = parts.displacement.split_at_mut(fields.pressure.len());
    problem.add_inertia(problem.rho_v2(), &fields.pressure, &fields.shear, along, upward);
}
