//! Derivatives of the outputs with respect to the inputs, from the linearised converged step.
//!
//! The step solves R(z, u) = 0 for the fields z (tractions, temperature, wear) under the inputs u. At its solution
//! dz/du follows from (∂R/∂z) dz = −(∂R/∂u) du, solved for one input at a time by the same split as the step: the
//! tangents of the tractions for given tangents of temperature and wear, then those of wear and temperature for given
//! tractions, repeated until they rest. Every part is linear and exact and stands beside what it is the tangent of; the cells
//! under pressure stay the same under an infinitesimal change. Held fixed are the fields at the beginning of the sub-step and its
//! length.

use super::coupling::Coupling;
use super::extent::extent;
use super::fields::PatchFields;
use super::operators::PatchOperators;
use super::problem::Problem;
use super::readings::readings;
use super::tangent::{Direction, Tangent};
use crate::contact::rim::{self, ContactHeat};
use crate::error::{Error, Result};
use crate::heat::strips::{CarriageChange, StripHeatChange, StripHeatScratch};
use crate::heat::surface::{CommonChange, ExchangeChange, ExchangeTangent, SurfaceExchange};
use crate::mechanics::normal::problem::Constraint;
use crate::numerics::anderson::Anderson;
use crate::numerics::dense::{largest, largest_change, relative};
use crate::parameters::WheelHeating;
use crate::settings::Settings;
use crate::signals::{INPUTS, Inputs, OUTPUTS, OutputKind, Outputs};
use crate::wear::WearChange;

/// Change of the wheel's temperature, relative to the largest of the rail's, that counts as none.
const LEAST_WHEEL_SHARE: f64 = 1e-4;
/// A ratio of two changes below this one is not believed.
const LEAST_CONTRACTION: f64 = 1e-3;

/// Solvers and buffers of linearisations. What one leaves in them changes no result of another one.
pub struct SensitivityScratch {
    mechanics: Tangent,
    heat: StripHeatScratch,
    anderson: Anderson,
    iterate: Coupling,
    image: Coupling,
    /// At the solution, and its change.
    exchange: Vec<SurfaceExchange>,
    exchange_change: Vec<ExchangeTangent>,
    wear_rate: Vec<f64>,
    /// A change of the fields, that of the iteration before, and fields that have moved along it.
    tangent: PatchFields,
    last: PatchFields,
    moved: PatchFields,
}

impl SensitivityScratch {
    /// For the given rail.
    pub fn new(operators: &PatchOperators, settings: &Settings) -> SensitivityScratch {
        let fields = PatchFields::new(operators);
        let iterate = Coupling::new(operators);
        let cells = operators.grid.strips * operators.grid.cells;
        SensitivityScratch {
            mechanics: Tangent::new(operators, settings),
            heat: StripHeatScratch::new(&operators.basis, &operators.strips),
            anderson: Anderson::new(iterate.values.len()),
            image: iterate.clone(),
            iterate,
            exchange: vec![SurfaceExchange::default(); cells],
            exchange_change: vec![ExchangeTangent::default(); cells],
            wear_rate: vec![0.0; cells],
            tangent: fields.clone(),
            last: fields.clone(),
            moved: fields,
        }
    }
}

/// The linearised step.
pub struct Linearisation<'a> {
    problem: Problem<'a>,
    fields: &'a PatchFields,
    scratch: &'a mut SensitivityScratch,
    /// Whether heat and wear follow; not after initialisation, where no time has passed.
    marches: bool,
    lifted: bool,
}

impl<'a> Linearisation<'a> {
    /// Linearises at `fields`, the solution of the problem.
    ///
    /// # Errors
    /// [`Error::SingularContactMatrix`].
    pub fn new(
        problem: Problem<'a>,
        fields: &'a PatchFields,
        scratch: &'a mut SensitivityScratch,
    ) -> Result<Linearisation<'a>> {
        let lifted = !fields.pressure.iter().any(|&p| p > 0.0);
        scratch.mechanics.softness.fill(0.0);
        if !lifted {
            scratch.mechanics.linearise(&problem, fields)?;
        }
        let rise = problem.wheel_rise(fields.wheel_temperature);
        problem.exchange(fields, rise, &mut scratch.exchange);
        let marches = problem.conditions.duration > 0.0;
        Ok(Linearisation {
            problem,
            fields,
            scratch,
            marches,
            lifted,
        })
    }

    /// Derivatives of all outputs with respect to the input in a row of [`INPUTS`].
    ///
    /// # Errors
    /// [`Error::SensitivityNotConverged`], or a linear system that could not be solved.
    pub fn output_sensitivity(&mut self, input: usize) -> Result<Outputs> {
        let mut inputs = Inputs::ZERO;
        (INPUTS[input].set)(&mut inputs, 1.0);
        let conditions = &self.problem.conditions;
        let motion = conditions.inputs.motion_tangent(&inputs, self.problem.parameters);
        let direction = Direction {
            inputs,
            motion,
            speed: if self.problem.is_forward() {
                motion.rolling_speed
            } else {
                -motion.rolling_speed
            },
            least_step: self.problem.settings.sensitivity.least_output_step * INPUTS[input].nominal,
        };
        self.fields_tangent(&direction)?;
        Ok(self.output_tangent(&direction))
    }

    /// dz along one direction of the inputs.
    fn fields_tangent(&mut self, direction: &Direction) -> Result<()> {
        let operators = self.problem.operators;
        let settings = self.problem.settings.patch_sensitivity();
        let rigid_slip = self.rigid_slip(direction);
        self.start(direction);
        let mut residual = f64::INFINITY;
        for iterations in 1..=settings.iterations {
            let SensitivityScratch {
                mechanics,
                iterate,
                tangent,
                ..
            } = &mut *self.scratch;
            if !self.lifted {
                mechanics.tractions(
                    &self.problem,
                    self.fields,
                    (direction, iterate),
                    tangent,
                    settings.tolerance,
                )?;
            }
            if self.marches {
                self.wear_tangent(direction);
                self.temperature_tangent(direction)?;
                self.wheel_tangent(direction);
            } else {
                tangent.wheel_temperature = direction.inputs.ambient_temperature;
            }
            let SensitivityScratch {
                mechanics,
                anderson,
                iterate,
                image,
                tangent,
                last,
                ..
            } = &mut *self.scratch;
            image.read(operators, tangent, &mechanics.softness);
            if !self.lifted && operators.coupling.is_some() {
                let lift = mechanics.lift_by_shear(&self.problem, &tangent.shear);
                let grid = &operators.grid;
                for (strip, wear) in image.wear_mut().chunks_exact_mut(grid.cells).enumerate() {
                    for (wear, lift) in wear.iter_mut().zip(&lift[grid.row(strip)]) {
                        *wear -= lift;
                    }
                }
            }
            let change = relative_change(tangent, last, rigid_slip);
            // What is left after a change is about the change times the ratio of the last two.
            let left = change * (change / residual).clamp(LEAST_CONTRACTION, 1.0);
            residual = change;
            if left <= settings.tolerance {
                self.finish(direction);
                return Ok(());
            }
            keep(tangent, last);
            if iterations > settings.accelerate_after {
                anderson.next(&iterate.values, &mut image.values);
            }
            std::mem::swap(iterate, image);
        }
        Err(Error::SensitivityNotConverged {
            iterations: settings.iterations,
            residual,
            tolerance: settings.tolerance,
        })
    }

    /// Size of the change of the rigid slip, `m/s`.
    fn rigid_slip(&self, direction: &Direction) -> f64 {
        let motion = &direction.motion;
        let spin = motion.spin_rate.abs() * self.problem.operators.grid.half_breadth();
        motion.rigid_slip.abs().max(motion.lateral_speed.abs()).max(spin)
    }

    /// Begins a direction: no change yet, and that of the rail without a change of the heat flux.
    fn start(&mut self, direction: &Direction) {
        let SensitivityScratch {
            anderson,
            iterate,
            heat,
            tangent,
            last,
            ..
        } = &mut *self.scratch;
        anderson.restart();
        iterate.values.fill(0.0);
        for fields in [&mut *tangent, last] {
            for values in fields.on_grid_mut() {
                values.fill(0.0);
            }
            for values in fields.heat.vectors_mut().into_iter().chain(fields.wear.vectors_mut()) {
                values.fill(0.0);
            }
            (fields.penetration, fields.wheel_temperature) = (0.0, 0.0);
        }
        if self.marches {
            let carriage = carriage(direction, 0.0);
            self.problem
                .heat_march()
                .start_tangent(&self.fields.heat, &carriage, &mut tangent.heat, heat);
        }
    }

    /// What acts on nothing any more within the step.
    fn finish(&mut self, direction: &Direction) {
        if !self.marches {
            return;
        }
        let SensitivityScratch { heat, tangent, .. } = &mut *self.scratch;
        let (problem, fields) = (&self.problem, self.fields);
        let breadth = if self.lifted {
            0.0
        } else {
            breadth_tangent(problem, &fields.pressure, &tangent.pressure)
        };
        let carriage = carriage(direction, breadth);
        problem
            .heat_march()
            .finish_tangent(&fields.heat, &carriage, &mut tangent.heat, heat);
        problem
            .wear_march()
            .finish_tangent(direction.speed, breadth, &fields.wear, &mut tangent.wear);
    }

    /// (24).
    fn wear_tangent(&mut self, direction: &Direction) {
        let SensitivityScratch { wear_rate, tangent, .. } = &mut *self.scratch;
        let (problem, fields) = (&self.problem, self.fields);
        let (grid, per_slip) = (&problem.operators.grid, problem.wear_per_slip());
        for (strip, rates) in wear_rate.chunks_exact_mut(grid.cells).enumerate() {
            for (rate, place) in rates.iter_mut().zip(grid.row(strip)) {
                let (speed, change) = (
                    problem.sliding(fields, place).speed,
                    problem.sliding_tangent(fields, tangent, place).speed,
                );
                *rate = per_slip * (change * fields.pressure[place] + speed * tangent.pressure[place]);
            }
        }
        problem.wear_march().advance_tangent(
            WearChange {
                rate: wear_rate,
                speed: direction.speed,
            },
            direction.inputs.incoming_wear_depth,
            &fields.wear,
            &mut tangent.wear,
        );
    }

    /// (19), (23), at the iterate's change of the wheel's temperature.
    fn temperature_tangent(&mut self, direction: &Direction) -> Result<()> {
        let SensitivityScratch {
            iterate,
            exchange,
            exchange_change,
            heat,
            tangent,
            ..
        } = &mut *self.scratch;
        let (problem, fields) = (&self.problem, self.fields);
        let (parameters, scale, grid) = (
            problem.parameters,
            problem.operators.scales.pressure,
            &problem.operators.grid,
        );
        let rise = problem.wheel_rise(fields.wheel_temperature);
        let rise_change = match parameters.wheel_heating {
            WheelHeating::Off => 0.0,
            WheelHeating::On => iterate.wheel_temperature() - direction.inputs.ambient_temperature,
        };
        let of_slip = problem.path_law().is_some();
        for (strip, changes) in exchange_change.chunks_exact_mut(grid.cells).enumerate() {
            for (cell, (exchange_change, place)) in changes.iter_mut().zip(grid.row(strip)).enumerate() {
                let change = ExchangeChange {
                    pressure: tangent.pressure[place] * scale,
                    sliding: problem.sliding_tangent(fields, tangent, place),
                    wheel_rise: rise_change,
                    coefficient: if of_slip && fields.pressure[place] > 0.0 {
                        let index = strip * grid.cells + cell;
                        tangent.friction[place] - fields.memory.share_at(index) * tangent.memory.now.resting[index]
                    } else {
                        0.0
                    },
                };
                let (pressure, sliding) = (fields.pressure[place] * scale, problem.sliding(fields, place));
                *exchange_change = SurfaceExchange::tangent(parameters, pressure, sliding, rise, &change);
            }
        }
        let change = StripHeatChange {
            common: CommonChange {
                ambient: direction.inputs.ambient_temperature,
                friction_scale: direction.inputs.friction_scale,
            },
            exchange,
            exchange_tangent: exchange_change,
        };
        problem
            .heat_march()
            .heat_tangent(&fields.heat, &change, &mut tangent.heat, heat)
    }

    /// The rim's temperature.
    fn wheel_tangent(&mut self, direction: &Direction) {
        let (problem, fields, tangent) = (&self.problem, self.fields, &mut self.scratch.tangent);
        let (parameters, force) = (problem.parameters, problem.operators.unit_force());
        let heat = ContactHeat::new(parameters, force, problem.heated_nodes(fields, fields));
        let changes = problem.heated_nodes(fields, tangent);
        let heat_tangent = ContactHeat::tangent(parameters, force, problem.heated_nodes(fields, fields).zip(changes));
        let ambient = problem.conditions.inputs.ambient_temperature;
        tangent.wheel_temperature = rim::temperature_tangent(
            parameters,
            fields.wheel_temperature,
            (ambient, direction.inputs.ambient_temperature),
            problem.conditions.duration,
            &heat,
            &heat_tangent,
        );
    }

    /// Derivatives of the outputs along the tangents of inputs and fields, by a central difference: the outputs are short
    /// expressions of the fields, and a step is known that suits all of them.
    fn output_tangent(&mut self, direction: &Direction) -> Outputs {
        let (problem, fields) = (&self.problem, self.fields);
        let SensitivityScratch { tangent, moved, .. } = &mut *self.scratch;
        let conditions = &problem.conditions;
        let step = self::output_step(problem, fields, tangent).max(direction.least_step);
        moved.relaxation_length = fields.relaxation_length;
        let mut outputs = |step: f64| {
            let own = fields.read_by_outputs().into_iter().zip(tangent.read_by_outputs());
            for (moved, (own, tangent)) in moved.read_by_outputs_mut().into_iter().zip(own) {
                for ((moved, own), tangent) in moved.iter_mut().zip(own).zip(tangent) {
                    *moved = own + step * tangent;
                }
            }
            moved.penetration = fields.penetration + step * tangent.penetration;
            moved.wheel_temperature = fields.wheel_temperature + step * tangent.wheel_temperature;
            let inputs = conditions.inputs.advanced(&direction.inputs, step);
            let problem = problem.under(inputs);
            // The totals before the step do not depend on the inputs of the step, so that the derivative is the same from 0.
            readings(&problem, moved).outputs_after(problem.parameters, &problem.conditions, &Outputs::default())
        };
        let (ahead, behind) = (outputs(step), outputs(-step));
        let mut derivative = Outputs::default();
        // What is counted is constant but for jumps.
        for signal in OUTPUTS.iter().filter(|signal| signal.kind != OutputKind::Counted) {
            let difference = (signal.get)(&ahead) - (signal.get)(&behind);
            (signal.set)(&mut derivative, difference / (2.0 * step));
        }
        // It follows from the motion alone, whose tangent is exact.
        derivative.distance = direction.speed * conditions.duration;
        if problem.constraint() == Constraint::Total(0.0) {
            derivative.penetration = 0.0;
        }
        derivative
    }
}

/// The change of what carries heat through the strips.
fn carriage(direction: &Direction, breadth: f64) -> CarriageChange {
    CarriageChange {
        speed: direction.speed,
        rise: direction.inputs.incoming_temperature - direction.inputs.ambient_temperature,
        breadth,
    }
}

/// The change of the contact's breadth, `m`, by a central difference.
fn breadth_tangent(problem: &Problem, pressure: &[f64], change: &[f64]) -> f64 {
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

/// The step of the central difference: it moves no field by more than its share of its largest value.
fn output_step(problem: &Problem, fields: &PatchFields, tangent: &PatchFields) -> f64 {
    let settings = problem.settings.sensitivity;
    let pairs = fields.read_by_outputs().into_iter().zip(tangent.read_by_outputs());
    let step = pairs
        .enumerate()
        .map(|(index, (field, tangent))| {
            let share = if index < PatchFields::OUTPUTS_ARE_NOT_LINEAR {
                settings.output_step
            } else {
                settings.linear_output_step
            };
            share * largest(field) / largest(tangent)
        })
        .filter(|step| step.is_finite() && *step > 0.0)
        .fold(f64::INFINITY, f64::min);
    if step.is_finite() { step } else { settings.output_step }
}

/// Keeps what [`relative_change`] compares.
fn keep(tangent: &PatchFields, last: &mut PatchFields) {
    last.copy_contact_from(tangent);
    last.heat.surface.copy_from_slice(&tangent.heat.surface);
    last.heat.content.copy_from_slice(&tangent.heat.content);
    last.heat.flux.copy_from_slice(&tangent.heat.flux);
    last.wear.depth.copy_from_slice(&tangent.wear.depth);
}

/// Largest change of a vector from `last` to `now`, relative to its largest value now; they are tangents, of a direction in
/// which the rigid slip changes by `rigid_slip`, `m/s`.
///
/// Where the contact sticks, the slip is what round-off leaves of the rigid slip and the surface's own motion, and with like
/// bodies heat is all that moves the pressure. So the pressure counts relative to both tractions, and slip, heat and wear
/// no more than the slip is of the rigid slip: they follow from the tractions, so that they rest where those do.
fn relative_change(now: &PatchFields, last: &PatchFields, rigid_slip: f64) -> f64 {
    let largest_of = |vectors: &[Vec<f64>; 2]| largest(&vectors[0]).max(largest(&vectors[1]));
    let slip = largest_of(&now.slip);
    let share = if slip < rigid_slip { slip / rigid_slip } else { 1.0 };
    let own = |of: fn(&PatchFields) -> &Vec<f64>| relative(largest_change(of(now), of(last)), largest(of(now)));
    let vectors = |of: fn(&PatchFields) -> &[Vec<f64>; 2]| {
        let change = (0..2)
            .map(|i| largest_change(&of(now)[i], &of(last)[i]))
            .fold(0.0, f64::max);
        relative(change, largest_of(of(now)))
    };
    let traction = largest(&now.pressure).max(largest_of(&now.shear));
    let pressure = relative(largest_change(&now.pressure, &last.pressure), traction);
    let following = [
        own(|fields| &fields.heat.surface),
        own(|fields| &fields.heat.content),
        own(|fields| &fields.heat.flux),
        own(|fields| &fields.wear.depth),
        own(|fields| &fields.friction),
        vectors(|fields| &fields.slip),
        relative(
            (now.wheel_temperature - last.wheel_temperature).abs(),
            // In a direction across a symmetric contact the wheel's temperature stays.
            now.wheel_temperature
                .abs()
                .max(LEAST_WHEEL_SHARE * largest(&now.heat.surface)),
        ),
    ];
    pressure
        .max(vectors(|fields| &fields.shear))
        .max(share * following.into_iter().fold(0.0, f64::max))
}
