//! The change of tractions, wear and heat of a line with the inputs and the interface vector, at the point of a linearised step.

use super::fields::LineFields;
use super::mechanics::{mechanics_problem, tractions};
use super::operators::LineOperators;
use crate::contact::engine::{Along, Linearised};
use crate::contact::memory;
use crate::friction::coulomb::Sliding;
use crate::heat::march::{Heated, MarchChange};
use crate::heat::surface::{CommonChange, ExchangeChange, ExchangeTangent, SurfaceExchange};
use crate::mechanics::traction_problem::{TractionProblemTangent, Tractions};
use crate::mechanics::transient::Transient;
use crate::parameters::WheelHeating;
use crate::wear::WearChange;

/// Buffers of a linearised step; n contact nodes.
pub struct LineTangent {
    /// Change of μ at unchanged slip, n.
    friction_of_slip: Vec<f64>,
    /// Change of the displacement that does not come from the tractions, along x₁ and upward, n.
    along: Vec<f64>,
    upward: Vec<f64>,
    /// Change of the wear rate, n.
    wear_rate: Vec<f64>,
    exchange: Vec<SurfaceExchange>,
    exchange_change: Vec<ExchangeTangent>,
}

impl LineTangent {
    /// Buffers for the given operators.
    pub fn new(operators: &LineOperators) -> LineTangent {
        let n = operators.mesh.contact_nodes;
        LineTangent {
            friction_of_slip: vec![0.0; n],
            along: vec![0.0; n],
            upward: vec![0.0; n],
            wear_rate: vec![0.0; n],
            exchange: vec![SurfaceExchange::default(); n],
            exchange_change: vec![ExchangeTangent::default(); n],
        }
    }
}

/// Computes the change of the tractions (31).
pub fn mechanics(at: &mut Linearised<LineOperators>, step: &Along, change: &mut LineFields) {
    let (problem, fields, direction) = (at.problem, &mut *at.fields, step.direction);
    let LineTangent {
        friction_of_slip,
        along,
        upward,
        ..
    } = &mut *at.tangent;
    let law = problem.friction();
    let common = [direction.inputs.ambient_temperature, direction.inputs.friction_scale];
    let static_friction = &mut change.memory.now.static_friction;
    let rises = at.interface.temperatures().zip(step.interface.temperatures());
    for (mu, (rise, change)) in static_friction.iter_mut().zip(rises) {
        *mu = law.coefficient_tangent(rise, [change, common[0], common[1]]);
    }
    match problem.path_law() {
        Some(path_law) => {
            memory::tangent(
                problem,
                &path_law,
                fields,
                direction.speed,
                static_friction,
                None,
                friction_of_slip,
            );
        }
        None => friction_of_slip.copy_from_slice(static_friction),
    }
    let (thermal_along, thermal_upward) = step.interface.displacement().split_at(along.len());
    along.copy_from_slice(thermal_along);
    for (upward, (thermal, worn)) in upward.iter_mut().zip(thermal_upward.iter().zip(step.interface.gap())) {
        *upward = thermal - worn;
    }
    // d(ρV² C₁ f) = 2ρV dV C₁ f + ρV² C₁ df; the second part is in the interface vector.
    let (density, speed) = (problem.parameters.density, problem.conditions.motion.rolling_speed);
    let rho_v2_change = 2.0 * density * speed * direction.motion.rolling_speed;
    problem.add_inertia(rho_v2_change, &fields.pressure, &fields.shear, along, upward);
    let per_speed = problem.transient_per_speed(fields.relaxation_length);
    let data = TractionProblemTangent {
        profile: upward,
        displacement: along,
        friction: &change.memory.now.static_friction,
        friction_of_slip,
        total: direction.inputs.normal_load / problem.unit_force(),
        rigid_slip: direction.motion.rigid_slip,
        strain_speed: direction.speed * problem.strain_scale(),
        transient: Transient {
            rate: direction.speed * per_speed.rate,
            centring: direction.speed * per_speed.centring,
        },
    };
    let mut tractions = tractions!(change);
    let solvers = &mut *at.solvers;
    let (mechanics, _) = mechanics_problem(problem, at.interface, fields, &solvers.data, &solvers.wear_compliance);
    solvers.mechanics.tangent(&mechanics, &data, &mut tractions);
}

/// Computes the change of the wear (24).
pub fn wear(at: &mut Linearised<LineOperators>, along: &Along, change: &mut LineFields) {
    let (problem, fields, direction) = (at.problem, &*at.fields, along.direction);
    if let Some(law) = problem.pointwise_wear() {
        for (node, rate) in at.tangent.wear_rate.iter_mut().enumerate() {
            let point_change = problem.rubbing_tangent(fields, change, node);
            *rate = law.rate_tangent(&problem.rubbing(fields, node), &point_change, direction.speed);
        }
    } else {
        let scale = problem.wear_per_slip();
        let nodes = fields.pressure.iter().zip(&fields.slip);
        let changes = change.pressure.iter().zip(&change.slip);
        for (rate, ((p, s), (dp, ds))) in at.tangent.wear_rate.iter_mut().zip(nodes.zip(changes)) {
            *rate = scale * (s.signum() * ds * p + s.abs() * dp);
        }
    }
    let march = problem.wear_march();
    change.wear[march.transport.inflow()] = direction.inputs.incoming_wear_depth;
    let replaced = fields.replaced_inflow[problem.operators.heat.basis.len()];
    let rate = WearChange {
        rate: &at.tangent.wear_rate,
        speed: direction.speed,
    };
    march.advance_tangent(rate, replaced, &fields.wear, &mut change.wear);
}

/// Computes the change of the temperature (19), (23), and of the thermal displacement, for the change of the wheel's temperature in
/// the interface vector.
pub fn heat(at: &mut Linearised<LineOperators>, along: &Along, change: &mut LineFields) {
    let (problem, fields, direction) = (at.problem, &mut *at.fields, along.direction);
    let LineTangent {
        exchange,
        exchange_change,
        ..
    } = &mut *at.tangent;
    let (parameters, scale) = (problem.parameters, problem.operators.scales.pressure);
    let wheel_rise = problem.wheel_rise(at.interface.wheel_temperature());
    let wheel_rise_change = match parameters.wheel_heating {
        WheelHeating::Off => 0.0,
        WheelHeating::On => along.interface.wheel_temperature() - direction.inputs.ambient_temperature,
    };
    problem.exchange(fields, wheel_rise, exchange);
    let of_slip = problem.path_law().is_some();
    let (wear, capacity) = (problem.pointwise_wear(), parameters.volumetric_heat_capacity());
    for (node, exchange_change) in exchange_change.iter_mut().enumerate() {
        let (slip, utilisation) = (fields.slip[node], fields.utilisation[node]);
        let node_change = ExchangeChange {
            pressure: change.pressure[node] * scale,
            sliding: Sliding::tangent(slip, utilisation, change.slip[node], change.utilisation[node]),
            wheel_rise: wheel_rise_change,
            coefficient: if of_slip && fields.pressure[node] > 0.0 {
                change.friction[node] - fields.memory.share_at(node) * change.memory.now.static_friction[node]
            } else {
                0.0
            },
        };
        let (pressure, sliding) = (fields.pressure[node] * scale, Sliding::new(slip, utilisation));
        *exchange_change = SurfaceExchange::tangent(parameters, pressure, sliding, wheel_rise, &node_change);
        if let Some(wear) = wear.filter(|_| pressure > 0.0) {
            let point_change = problem.rubbing_tangent(fields, change, node);
            let point = problem.rubbing(fields, node);
            exchange_change.debris = capacity * wear.rate_tangent(&point, &point_change, direction.speed);
        }
    }
    let solution = Heated {
        amplitudes: &mut fields.temperature,
        surface: &mut fields.surface_temperature,
        flux: &mut fields.heat_flux,
    };
    let mut heated = Heated {
        amplitudes: &mut change.temperature,
        surface: &mut change.surface_temperature,
        flux: &mut change.heat_flux,
    };
    let march = problem.heat_march();
    let heat = &problem.operators.heat;
    let rise = direction.inputs.incoming_temperature - direction.inputs.ambient_temperature;
    heat.enter(rise, march.transport.inflow(), &mut heated);
    let data = MarchChange {
        speed: direction.speed,
        common: CommonChange {
            ambient: direction.inputs.ambient_temperature,
            friction_scale: direction.inputs.friction_scale,
        },
        exchange,
        exchange_tangent: exchange_change,
        replaced_inflow: &fields.replaced_inflow[..heat.basis.len()],
    };
    let solvers = &mut *at.solvers;
    march.advance_tangent(&solution, &data, &mut heated, &mut solvers.cells);
    let displacement = &mut change.thermal_displacement;
    heat.displacement
        .apply(&change.temperature, &mut solvers.moments, displacement);
}
