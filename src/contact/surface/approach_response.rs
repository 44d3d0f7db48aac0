//! Responses of the windows' pressures to the approach: the changes of the pressures with it on the cells that carry anything, found once in a step. With them the pressures
//! move with the approach before they are solved for, and the change of the load with the approach is known.

use super::fields::SurfaceFields;
use super::problem::{SurfaceProblem, component, sum_over_strips};
use super::solvers::SurfaceSolvers;
use crate::mechanics::normal::normal_problem::Constraint;
use crate::mechanics::patch::normal::PatchNormalProblem;

/// Error of a response, relative: what is left of a change of the approach is solved for at the next one.
pub const RESPONSE_ERROR: f64 = 3e-2;
/// Rounds over windows that displace each other.
const RESPONSE_ROUNDS: usize = 2;

/// Change of the load with the approach, `N/m`, the friction in proportion: by the responses of the windows' pressures. None where they show none.
pub fn stiffness(problem: &SurfaceProblem, fields: &SurfaceFields, solvers: &mut SurfaceSolvers) -> Option<f64> {
    if !std::mem::replace(&mut solvers.responded, true) {
        respond(problem, fields, solvers);
    }
    let scale = problem.operators.shapes[0].scales.displacement;
    let vertical = problem.pose().vertical();
    let stiffnesses = fields.used().map(|(window, place)| {
        let own = &solvers.windows[window];
        let points = own.geometry.points();
        let upward = |strip: usize| component(points[strip].normal, vertical);
        let normal = sum_over_strips(problem.operators, &place, &own.response.pressure, upward);
        (1.0 + own.friction_share) * normal / scale
    });
    let stiffness: f64 = stiffnesses.sum();
    (stiffness.is_finite() && stiffness > 0.0).then_some(stiffness)
}

/// Finds the responses of the windows' pressures to the approach, their influence on one another included.
fn respond(problem: &SurfaceProblem, fields: &SurfaceFields, solvers: &mut SurfaceSolvers) {
    let operators = problem.operators;
    solvers.apart_response.clear(operators, fields.are_close);
    for (window, place) in fields.used() {
        let own = &mut solvers.windows[window];
        own.response.clear(&operators.of(&place).grid);
        solvers.apart_response.displacement[window][0].fill(0.0);
    }
    let coupled = solvers.apart.is_coupled();
    for _ in 0..if coupled { RESPONSE_ROUNDS } else { 1 } {
        for (window, place) in fields.used() {
            let patch = problem.of(&place);
            let own = &mut solvers.windows[window];
            let displaced = &solvers.apart_response.displacement[window][0];
            for ((gap, rise), displaced) in own.patch.gap.iter_mut().zip(&own.geometry.rise).zip(displaced) {
                *gap = displaced - rise;
            }
            let penetration = Constraint::Penetration(0.0);
            let error = RESPONSE_ERROR / patch.operators.normal_influence.diagonal;
            let change = PatchNormalProblem {
                tolerance: error.max(problem.settings.patch.least_tolerance),
                ..patch.normal_problem(&own.patch.gap, &own.patch.wear_compliance, penetration)
            };
            own.patch.normal.respond(&change, &own.patch.contact, &mut own.response);
            if !coupled {
                continue;
            }
            let pressure = &own.response.pressure;
            solvers
                .apart_response
                .take_traction(operators, [pressure], window, &place);
            for (other, place) in fields.used().filter(|(other, _)| *other != window) {
                solvers.apart_response.displace(operators, other, &place);
            }
        }
    }
}

/// Changes the pressures by their responses to a change of the approach, `m`.
pub fn advance(problem: &SurfaceProblem, change: f64, fields: &mut SurfaceFields, solvers: &mut SurfaceSolvers) {
    let operators = problem.operators;
    for (window, place) in fields.used() {
        let own = &mut solvers.windows[window];
        let patch = operators.of(&place);
        let change = change / patch.scales.displacement;
        let pressure = &mut fields.windows[window].pressure;
        own.patch.normal.advance(&patch.grid, &own.response, change, pressure);
        solvers.apart.take_for_others(operators, fields, window, &place);
        solvers.apart.add(&solvers.apart_response, change, window);
    }
}
