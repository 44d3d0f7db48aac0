//! Heat and wear of the patch for given tractions: the marches along the strips, the wear compliance, the interface vector.

use super::fields::PatchFields;
use super::problem::PatchProblem;
use super::solvers::PatchSolvers;
use crate::body::influence::Window;
use crate::contact::interface::Interface;
use crate::error::Result;
use crate::friction::coulomb;
use crate::mechanics::patch::contact::Contact;
use crate::transport::CellStep;

/// Slip speed of a cell by its place on the grid, `m/s`.
fn slip_speed(fields: &PatchFields, place: usize) -> f64 {
    coulomb::magnitude([fields.slip[0][place], fields.slip[1][place]])
}

/// Wear of the step per wear rate of a cell, scaled.
fn wear_per_rate(problem: &PatchProblem) -> f64 {
    let (operators, speed) = (problem.operators, problem.conditions.motion.rolling_speed.abs());
    let own = CellStep::new(1.0 / problem.conditions.duration, operators.grid.length, speed).diagonal;
    own / operators.scales.displacement
}

/// Wear of the step per scaled pressure of a cell, by its place on the grid, scaled.
fn wear_compliance<'p>(problem: &'p PatchProblem, now: &'p PatchFields) -> impl Fn(usize) -> f64 + 'p {
    let (law, per_rate) = (problem.pointwise_wear(), wear_per_rate(problem));
    let per_slip = problem.wear_per_slip() * per_rate;
    let per_rate = problem.operators.scales.pressure * per_rate;
    move |place| match &law {
        Some(law) => per_rate * law.per_pressure(&problem.rubbing(now, place)),
        None => per_slip * slip_speed(now, place),
    }
}

/// Marches the wear (24).
pub fn march_wear(problem: &PatchProblem, before: &PatchFields, now: &mut PatchFields, solvers: &mut PatchSolvers) {
    let (grid, per_slip) = (&problem.operators.grid, problem.wear_per_slip());
    let law = problem.pointwise_wear();
    for (strip, rates) in solvers.wear_rate.chunks_exact_mut(grid.cells).enumerate() {
        for (rate, place) in rates.iter_mut().zip(grid.row(strip)) {
            *rate = match &law {
                Some(law) => law.rate(&problem.rubbing(now, place)),
                None => per_slip * slip_speed(now, place) * now.pressure[place],
            };
        }
    }
    problem.wear_march().advance(
        &solvers.wear_rate,
        problem.conditions.inputs.incoming_wear_depth,
        &before.wear,
        &mut now.wear,
        &mut solvers.wear_steps,
    );
}

/// Adapts the wear compliance to the slip of the fields: none where the wear of the step is small against the compliance of the
/// bodies.
pub fn update_wear_compliance(problem: &PatchProblem, now: &PatchFields, solvers: &mut PatchSolvers) {
    let grid = &problem.operators.grid;
    let compliance = wear_compliance(problem, now);
    let places = (0..grid.strips).flat_map(|strip| grid.row(strip));
    let largest = places.fold(0.0, |largest: f64, place| largest.max(compliance(place)));
    let patch = &problem.settings.patch;
    let least = patch.least_compliance * problem.operators.normal_influence.diagonal;
    if largest > problem.settings.wear_compliance.explicit * least {
        set_wear_compliance(problem, now, solvers);
    } else {
        solvers.wear_compliance.fill(0.0);
    }
}

/// Takes all wear of the step into the normal problem.
pub fn take_all_wear(problem: &PatchProblem, now: &PatchFields, solvers: &mut PatchSolvers) {
    if problem.conditions.duration > 0.0 {
        set_wear_compliance(problem, now, solvers);
    } else {
        solvers.wear_compliance.fill(0.0);
    }
}

fn set_wear_compliance(problem: &PatchProblem, now: &PatchFields, solvers: &mut PatchSolvers) {
    let compliance = wear_compliance(problem, now);
    for (place, wear_compliance) in solvers.wear_compliance.iter_mut().enumerate() {
        *wear_compliance = compliance(place);
    }
}

/// Marches the heat (19), (23) with the wheel at θ_w.
///
/// # Errors
/// [`crate::error::Error::SurfaceHeatNotConverged`].
pub fn march_heat(
    problem: &PatchProblem,
    wheel_rise: f64,
    now: &mut PatchFields,
    solvers: &mut PatchSolvers,
) -> Result<()> {
    problem.exchange(now, wheel_rise, &mut solvers.exchange);
    problem
        .heat_march()
        .heat(&solvers.exchange, &mut now.heat, &mut solvers.heat)
}

/// Writes the interface vector of the fields, or of a change of them.
pub fn read(problem: &PatchProblem, fields: &PatchFields, solvers: &mut PatchSolvers, interface: &mut Interface) {
    let (operators, grid) = (problem.operators, &problem.operators.grid);
    let mut parts = interface.parts();
    parts.set_temperatures(&fields.heat.surface, fields.wheel_temperature);
    for (upward, content) in parts.displacement.iter_mut().zip(&fields.heat.content) {
        *upward = operators.expansion.bulge * content;
    }
    for (strip, gap) in parts.gap.chunks_exact_mut(grid.cells).enumerate() {
        let depths = &fields.wear.depth[strip * grid.cells..];
        for ((gap, depth), place) in gap.iter_mut().zip(depths).zip(grid.row(strip)) {
            *gap = depth / operators.scales.displacement - solvers.wear_compliance[place] * fields.pressure[place];
        }
    }
    // Shear lifts unlike half-spaces off each other.
    if let Some(tables) = &operators.coupling {
        let [upward, ignored] = &mut solvers.shear_displacement;
        let load = [&fields.shear[0][..], &fields.shear[1][..]];
        let window = Window::whole(grid);
        operators
            .transform
            .apply(tables, &window, load, [upward, ignored], &mut solvers.products);
        for (strip, gap) in parts.gap.chunks_exact_mut(grid.cells).enumerate() {
            for (gap, upward) in gap.iter_mut().zip(&solvers.shear_displacement[0][grid.row(strip)]) {
                *gap -= upward;
            }
        }
    }
}

/// Sets friction coefficient and shear to those at temperature rises of the cells, `K`.
pub fn set_friction(
    problem: &PatchProblem,
    fields: &mut PatchFields,
    contact: &Contact,
    rise: impl Fn(&PatchFields, usize) -> f64,
) {
    let grid = &problem.operators.grid;
    let of_slip = problem.path_law().is_some();
    for run in contact.runs() {
        let law = problem.friction_at(run.strip);
        for (k, place) in run.places(grid).enumerate() {
            let index = run.strip * grid.cells + run.first + k;
            let static_friction = law.coefficient(rise(fields, index)).0;
            let mut mu = static_friction;
            if of_slip {
                mu = fields.memory.at_final_temperature(index, static_friction);
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

/// Sets friction coefficient and shear to those at the temperature of the fields.
pub fn finalise_friction(problem: &PatchProblem, fields: &mut PatchFields, contact: &Contact) {
    set_friction(problem, fields, contact, |fields, index| fields.heat.surface[index]);
}
