//! Wheels one behind the other, each a unit of its own, chained by what the rail carries from one to the next with the
//! transport delay (D − 2L)/V: incoming_… = leaving_… of the unit in front, so many steps before.
//!
//! Wear: the volume worn by both is on the rail and behind it. Heat: it passes through a unit whose wheel is lifted
//! undiminished, and where the skin depth is that of the wake's age, √(π κ (D − L)/V), the surface under the second axle has
//! the temperature Q/(ρ c √(π κ t)) of heat Q per area put in a time t = D/V before (Carslaw and Jaeger, Conduction of Heat in
//! Solids, 10.3).

use super::row::Row;
use super::set_up;
use crate::error::Result;
use crate::parameters::{FrictionLaw, Parameters};
use crate::signals::{Inputs, Outputs};
use crate::simulation::Simulation;
use crate::transport::{CellStep, Upwind};
use std::collections::VecDeque;
use std::f64::consts::PI;

const SPEED: f64 = 10.0;
/// L and D, `m`.
const HALF_LENGTH: f64 = 0.5;
const DISTANCE: f64 = 2.5;
const STEP: f64 = 5e-3;

fn parameters() -> Parameters {
    Parameters {
        friction_law: FrictionLaw::Constant,
        strip_half_length: HALF_LENGTH,
        ..Parameters::default()
    }
}

fn inputs() -> Inputs {
    let creepage = 0.02;
    Inputs {
        wheel_speed: SPEED * (1.0 + creepage) / Parameters::default().wheel_radius,
        creepage,
        ..Inputs::default()
    }
}

/// Two wheels and the rail between them.
struct Pair {
    front: Simulation,
    rear: Simulation,
    /// Leaving temperature and wear depth of the front wheel on their way to the rear one, the latest last.
    between: VecDeque<(f64, f64)>,
    /// Wear depth that has left the rear unit, summed over the steps.
    gone: f64,
}

impl Pair {
    fn new(parameters: &Parameters) -> Result<Pair> {
        let delay = ((DISTANCE - 2.0 * HALF_LENGTH) / SPEED / STEP).round() as usize;
        let ambient = inputs().ambient_temperature;
        Ok(Pair {
            front: set_up::simulation(parameters, &inputs())?,
            rear: set_up::simulation(parameters, &inputs())?,
            between: VecDeque::from(vec![(ambient, 0.0); delay]),
            gone: 0.0,
        })
    }

    /// One step of both at the given load of the rear wheel.
    fn step(&mut self, rear_load: f64) -> Result<()> {
        self.front.step(&inputs(), STEP)?;
        let left = &self.front.state.outputs;
        self.between
            .push_back((left.leaving_temperature, left.leaving_wear_depth));
        let arrived = self.between.pop_front();
        let (incoming_temperature, incoming_wear_depth) = arrived.unwrap_or_default();
        let rear = Inputs {
            normal_load: rear_load,
            incoming_temperature,
            incoming_wear_depth,
            ..inputs()
        };
        self.rear.step(&rear, STEP)?;
        self.gone += self.rear.state.outputs.leaving_wear_depth;
        Ok(())
    }

    fn outputs(&self) -> (&Outputs, &Outputs) {
        (&self.front.state.outputs, &self.rear.state.outputs)
    }
}

/// Wear and heat are conserved from wheel to wheel, and the second wheel meets the temperature that the first has left.
///
/// # Errors
/// A solver that did not converge.
pub fn rows() -> Result<Vec<Row>> {
    let parameters = parameters();
    let load = inputs().normal_load;
    let mut pair = Pair::new(&parameters)?;
    for _ in 0..200 {
        pair.step(load)?;
    }
    let mut rows = vec![volume(&pair)?];
    for _ in 0..200 {
        pair.step(load)?;
    }
    let (front, rear) = pair.outputs();
    let depth = |outputs: &Outputs| outputs.wear_rate / (SPEED * parameters.contact_width);
    rows.push(Row::relative(
        "wear depth behind two wheels over the sum of their volumes per distance and width, steady",
        "m",
        depth(front) + depth(rear),
        rear.leaving_wear_depth,
        1e-9,
        "W = k/V int |s| p dx of each",
    ));

    // The rail enters the second strip this long after it has left the first contact.
    let age = (DISTANCE - HALF_LENGTH) / SPEED;
    let aged = Parameters {
        skin_depth: (PI * parameters.thermal_diffusivity * age).sqrt(),
        wear_coefficient: 0.0,
        ..parameters
    };
    let mut pair = Pair::new(&aged)?;
    for _ in 0..400 {
        pair.step(0.0)?;
    }
    let (front, rear) = pair.outputs();
    let ambient = inputs().ambient_temperature;
    rows.push(Row::relative(
        "heat carried through a unit whose wheel is lifted, steady",
        "K",
        front.leaving_temperature - ambient,
        rear.leaving_temperature - ambient,
        1e-9,
        "conservation",
    ));
    rows.push(Row::relative(
        "heat carried away from a wheel over that put into the rail, steady",
        "W",
        front.rail_heat_flow,
        aged.volumetric_heat_capacity()
            * aged.skin_depth
            * aged.contact_width
            * SPEED
            * (front.leaving_temperature - ambient),
        1e-9,
        "conservation",
    ));
    let per_area = front.rail_heat_flow / (SPEED * aged.contact_width);
    let diffused = (PI * aged.thermal_diffusivity * DISTANCE / SPEED).sqrt();
    let mesh = &pair.rear.model.line_operators()?.mesh;
    let middle = mesh.contact_column(mesh.contact_nodes / 2);
    rows.push(Row::relative(
        "rail under the second axle over ambient, 0.25 s after the first",
        "K",
        per_area / (aged.volumetric_heat_capacity() * diffused),
        pair.rear.state.fields()?.surface_temperature[middle],
        // The wake that was handed on is not quite a Gaussian, and the rows in depth are a third apart from one to the next.
        0.02,
        "Q/(rho c sqrt(pi kappa t)), Carslaw and Jaeger 10.3",
    ));
    Ok(rows)
}

/// Volume worn by both wheels against the wear that lies on the rail: in both strips, between them and behind.
fn volume(pair: &Pair) -> Result<Row> {
    // As the march holds it, at the one speed and step.
    let on_the_rail = |run: &Simulation| -> Result<f64> {
        let wear = &run.state.fields()?.wear;
        let columns = Upwind::new(&run.model.line_operators()?.mesh.x, SPEED).columns();
        let cells = columns.map(|column| {
            let step = CellStep::new(1.0 / STEP, column.spacing, SPEED);
            column.spacing * step.mean(wear[column.upstream], wear[column.index])
        });
        Ok(cells.sum())
    };
    let per_step = SPEED * STEP;
    let between: f64 = pair.between.iter().map(|(_, depth)| depth * per_step).sum();
    let area = on_the_rail(&pair.front)? + between + on_the_rail(&pair.rear)? + pair.gone * per_step;
    let (front, rear) = pair.outputs();
    Ok(Row::relative(
        "volume of wear on the rail of two wheels, between and behind them",
        "m3",
        front.worn_volume + rear.worn_volume,
        pair.front.model.parameters().contact_width * area,
        1e-10,
        "conservation",
    ))
}
