//! Derivatives of the outputs with respect to the inputs, from the linearised converged step.
//!
//! The step solves R(z, u) = 0 for the fields z (tractions, temperature, wear) under the inputs u. At its solution
//! dz/du follows from (∂R/∂z) dz = −(∂R/∂u) du, solved for one input at a time by the same split as the step: the
//! tangents of the tractions for given tangents of temperature and wear, then those of wear and temperature for given
//! tractions, repeated until they rest. Every part is linear and exact and stands beside what it is the tangent of; the active
//! set does not change under an infinitesimal change. Held fixed are the fields at the beginning of the sub-step and its
//! length.

use super::coupling::Coupling;
use super::fields::Fields;
use super::problem::Problem;
use super::readings::readings;
use super::split::{self, Scratch};
use crate::contact::rim::{self, ContactHeat};
use crate::error::{Error, Result};
use crate::friction::coulomb::Sliding;
use crate::heat::march::{Heated, MarchChange};
use crate::heat::surface::{CommonChange, ExchangeChange, ExchangeTangent, SurfaceExchange};
use crate::mechanics::normal::problem::Constraint;
use crate::mechanics::problem::{ProblemTangent, Tractions};
use crate::numerics::anderson::Anderson;
use crate::numerics::dense::{largest, largest_change, relative};
use crate::parameters::WheelHeating;
use crate::signals::{INPUTS, Inputs, Motion, OUTPUTS, OutputKind, Outputs};
use crate::wear::WearChange;

/// The linearised step.
pub struct Linearisation<'a> {
    problem: Problem<'a>,
    fields: &'a mut Fields,
    scratch: &'a mut Scratch,
    /// Whether heat and wear follow; not after initialisation, where no time has passed.
    marches: bool,
    lifted: bool,
}

/// Change of the inputs in one direction and of the motion that they make.
#[derive(Debug, Clone, Copy)]
struct Direction {
    inputs: Inputs,
    motion: Motion,
    /// d|V|, `m/s`.
    speed: f64,
    /// Least step along it of the difference of the outputs.
    least_step: f64,
}

impl<'a> Linearisation<'a> {
    /// Linearises at `fields`, the solution of the problem.
    ///
    /// # Errors
    /// Mechanics that are not at rest or singular.
    pub fn new(problem: Problem<'a>, fields: &'a mut Fields, scratch: &'a mut Scratch) -> Result<Linearisation<'a>> {
        let lifted = !fields.pressure.iter().any(|&p| p > 0.0);
        if !lifted {
            split::linearise_mechanics(&problem, fields, scratch)?;
        }
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
    /// [`Error::SensitivityNotConverged`].
    pub fn output_sensitivity(&mut self, input: usize) -> Result<Outputs> {
        let mut inputs = Inputs::ZERO;
        (INPUTS[input].set)(&mut inputs, 1.0);
        let conditions = &self.problem.conditions;
        let motion = conditions.inputs.motion_tangent(&inputs, self.problem.parameters);
        let forward = conditions.motion.rolling_speed >= 0.0;
        let direction = Direction {
            inputs,
            motion,
            speed: if forward {
                motion.rolling_speed
            } else {
                -motion.rolling_speed
            },
            least_step: self.problem.settings.sensitivity.least_output_step * INPUTS[input].nominal,
        };
        let tangent = self.fields_tangent(&direction)?;
        Ok(self.output_tangent(&direction, &tangent))
    }

    /// dz along one direction of the inputs.
    fn fields_tangent(&mut self, direction: &Direction) -> Result<Fields> {
        let operators = self.problem.operators;
        let settings = self.problem.settings.sensitivity;
        let mut tangent = Fields::new(operators);
        let mut last = tangent.clone();
        let mut iterate = Coupling::new(operators.mesh.contact_nodes);
        let mut image = iterate.clone();
        let mut anderson = Anderson::new(iterate.values().len());
        let mut residual = f64::INFINITY;
        for iterations in 1..=settings.iterations {
            if !self.lifted {
                self.tractions_tangent(direction, &iterate, &mut tangent);
            }
            if self.marches {
                self.wear_tangent(direction, &mut tangent);
                self.temperature_tangent(direction, iterate.wheel_temperature(), &mut tangent);
                operators.heat.displacement.apply(
                    &tangent.temperature,
                    &mut self.scratch.moments,
                    &mut tangent.thermal_displacement,
                );
                self.wheel_tangent(direction, &mut tangent);
            } else {
                tangent.wheel_temperature = direction.inputs.ambient_temperature;
            }
            image.read(operators, &tangent, &self.scratch.softening);
            residual = tangent.relative_change(&last, direction.motion.rigid_slip);
            if residual <= settings.tolerance {
                return Ok(tangent);
            }
            last.copy_from(&tangent);
            if iterations > settings.accelerate_after {
                anderson.next(iterate.values(), image.values_mut());
            }
            std::mem::swap(&mut iterate, &mut image);
        }
        Err(Error::SensitivityNotConverged {
            iterations: settings.iterations,
            residual,
            tolerance: settings.tolerance,
        })
    }

    /// (31), for given tangents of thermal displacement, temperature and wear.
    fn tractions_tangent(&mut self, direction: &Direction, iterate: &Coupling, tangent: &mut Fields) {
        let (problem, fields) = (&self.problem, &mut *self.fields);
        let window = problem.operators.mesh.window();
        let law = problem.friction();
        let common = [direction.inputs.ambient_temperature, direction.inputs.friction_scale];
        let rises = &fields.surface_temperature[window];
        let resting = &mut tangent.memory.now.resting;
        for ((mu, &rise), change) in resting.iter_mut().zip(rises).zip(iterate.temperature()) {
            *mu = law.coefficient_tangent(rise, [change, common[0], common[1]]);
        }
        let mut friction_of_slip = resting.clone();
        if let Some(path_law) = problem.path_law() {
            let nodes = 0..fields.pressure.len();
            let (before, now) = (fields.memory.before.path(nodes.clone()), fields.memory.now.path(nodes));
            path_law.tangent(
                (&before, &now),
                (&fields.pressure, |_| 0.0),
                (direction.speed, resting),
                &mut friction_of_slip,
            );
        }
        let mut along = iterate.along().to_vec();
        let lifts = iterate.upward().iter().zip(iterate.wear());
        let mut upward: Vec<f64> = lifts.map(|(lift, wear)| lift - wear).collect();
        // d(ρV² C₁ f) = 2ρV dV C₁ f + ρV² C₁ df.
        let (density, speed) = (problem.parameters.density, problem.conditions.motion.rolling_speed);
        let rho_v2_tangent = 2.0 * density * speed * direction.motion.rolling_speed;
        problem.add_inertia(rho_v2_tangent, &fields.pressure, &fields.shear, &mut along, &mut upward);
        problem.add_inertia(
            problem.rho_v2(),
            &tangent.pressure,
            &tangent.shear,
            &mut along,
            &mut upward,
        );
        let change = ProblemTangent {
            profile: &upward,
            displacement: &along,
            friction: &tangent.memory.now.resting,
            friction_of_slip: &friction_of_slip,
            total: problem
                .operators
                .scaled_load(problem.parameters, direction.inputs.normal_load),
            rigid_slip: direction.motion.rigid_slip,
            strain_speed: direction.speed * problem.strain_scale(),
            transient: problem.transient_tangent(fields, direction.speed),
        };
        let mut tractions = Tractions {
            pressure: &mut tangent.pressure,
            shear: &mut tangent.shear,
            slip: &mut tangent.slip,
            saturation: &mut tangent.saturation,
            friction: &mut tangent.friction,
            surfaces: &mut tangent.memory.now.friction,
            flow: &mut tangent.memory.now.flow,
            speed: &mut tangent.memory.now.speed,
            share: &mut tangent.memory.share,
            cap: &mut tangent.memory.cap,
            penetration: &mut tangent.penetration,
        };
        let Scratch {
            mechanics,
            data,
            softening,
            ..
        } = &mut *self.scratch;
        let (mechanics_problem, _) = problem.mechanics(fields, data, softening);
        mechanics.tangent(&mechanics_problem, &change, &mut tractions);
    }

    /// (24).
    fn wear_tangent(&self, direction: &Direction, tangent: &mut Fields) {
        let (problem, fields) = (&self.problem, &*self.fields);
        let scale = problem.parameters.wear_coefficient * problem.operators.scales.pressure;
        let nodes = fields.pressure.iter().zip(&fields.slip);
        let changes = tangent.pressure.iter().zip(&tangent.slip);
        let rate: Vec<f64> = nodes
            .zip(changes)
            .map(|((p, s), (dp, ds))| scale * (s.signum() * ds * p + s.abs() * dp))
            .collect();
        let march = problem.wear_march();
        tangent.wear[march.transport.inflow()] = direction.inputs.incoming_wear_depth;
        let replaced = fields.replaced_inflow[problem.operators.heat.basis.len()];
        let change = WearChange {
            rate: &rate,
            speed: direction.speed,
        };
        march.advance_tangent(change, replaced, &fields.wear, &mut tangent.wear);
    }

    /// (19), (23), at the given change of the wheel's temperature, `K`.
    fn temperature_tangent(&mut self, direction: &Direction, wheel_tangent: f64, tangent: &mut Fields) {
        let (problem, fields) = (&self.problem, &mut *self.fields);
        let (parameters, scale) = (problem.parameters, problem.operators.scales.pressure);
        let wheel_rise = problem.wheel_rise(fields.wheel_temperature);
        let wheel_rise_tangent = match parameters.wheel_heating {
            WheelHeating::Off => 0.0,
            WheelHeating::On => wheel_tangent - direction.inputs.ambient_temperature,
        };
        let mut exchange = vec![SurfaceExchange::default(); fields.pressure.len()];
        problem.exchange(fields, wheel_rise, &mut exchange);
        let of_slip = problem.path_law().is_some();
        let exchange_tangent: Vec<ExchangeTangent> = (0..fields.pressure.len())
            .map(|node| {
                let (slip, saturation) = (fields.slip[node], fields.saturation[node]);
                let change = ExchangeChange {
                    pressure: tangent.pressure[node] * scale,
                    sliding: Sliding::tangent(slip, saturation, tangent.slip[node], tangent.saturation[node]),
                    wheel_rise: wheel_rise_tangent,
                    coefficient: if of_slip && fields.pressure[node] > 0.0 {
                        tangent.friction[node] - fields.memory.share_at(node) * tangent.memory.now.resting[node]
                    } else {
                        0.0
                    },
                };
                let pressure = fields.pressure[node] * scale;
                SurfaceExchange::tangent(
                    parameters,
                    pressure,
                    Sliding::new(slip, saturation),
                    wheel_rise,
                    &change,
                )
            })
            .collect();
        let solution = Heated {
            amplitudes: &mut fields.temperature,
            surface: &mut fields.surface_temperature,
            flux: &mut fields.heat_flux,
        };
        let mut change = Heated {
            amplitudes: &mut tangent.temperature,
            surface: &mut tangent.surface_temperature,
            flux: &mut tangent.heat_flux,
        };
        let march = problem.heat_march();
        let rise = direction.inputs.incoming_temperature - direction.inputs.ambient_temperature;
        problem
            .operators
            .heat
            .enter(rise, march.transport.inflow(), &mut change);
        let data = MarchChange {
            speed: direction.speed,
            common: CommonChange {
                ambient: direction.inputs.ambient_temperature,
                friction_scale: direction.inputs.friction_scale,
            },
            exchange: &exchange,
            exchange_tangent: &exchange_tangent,
            replaced_inflow: &fields.replaced_inflow[..problem.operators.heat.basis.len()],
        };
        march.advance_tangent(&solution, &data, &mut change, &mut self.scratch.cells);
    }

    /// The rim's temperature.
    fn wheel_tangent(&self, direction: &Direction, tangent: &mut Fields) {
        let (problem, fields) = (&self.problem, &*self.fields);
        let (parameters, force) = (problem.parameters, problem.unit_force());
        let changes = problem.heated_nodes(tangent);
        let heat = ContactHeat::new(parameters, force, problem.heated_nodes(fields));
        let heat_tangent = ContactHeat::tangent(parameters, force, problem.heated_nodes(fields).zip(changes));
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
    fn output_tangent(&self, direction: &Direction, tangent: &Fields) -> Outputs {
        let (problem, fields) = (&self.problem, &*self.fields);
        let conditions = &problem.conditions;
        let step = self.output_step(tangent).max(direction.least_step);
        let moved = |step: f64| {
            let mut fields = fields.clone();
            fields.add_multiple(step, tangent);
            let inputs = conditions.inputs.advanced(&direction.inputs, step);
            let problem = problem.under(inputs);
            // The totals before the step do not depend on the inputs of the step, so that the derivative is the same from 0.
            readings(&problem, &fields).outputs_after(problem.parameters, &problem.conditions, &Outputs::default())
        };
        let (ahead, behind) = (moved(step), moved(-step));
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

    /// The step of the central difference: it moves no field by more than its share of its largest value.
    fn output_step(&self, tangent: &Fields) -> f64 {
        let settings = self.problem.settings.sensitivity;
        let step = self
            .fields
            .vectors()
            .iter()
            .zip(tangent.vectors())
            .zip(Fields::OUTPUTS_ARE_LINEAR)
            .filter_map(|((field, tangent), linear)| {
                let share = if linear? {
                    settings.linear_output_step
                } else {
                    settings.output_step
                };
                Some(share * largest(field) / largest(tangent))
            })
            .filter(|step| step.is_finite() && *step > 0.0)
            .fold(f64::INFINITY, f64::min);
        if step.is_finite() { step } else { settings.output_step }
    }
}

impl Fields {
    /// Largest change of a vector from `last` to these fields, relative to its largest value now; these are tangents, of a
    /// direction in which the rigid slip changes by `rigid_slip`, `m/s`.
    ///
    /// Where the contact sticks, the slip is what round-off leaves of the rigid slip and the surface's own motion, and with like
    /// bodies heat is all that moves the pressure. So the pressure counts relative to both tractions, and slip, heat and wear
    /// no more than the slip is of the rigid slip: they follow from the tractions, so that they rest where those do.
    fn relative_change(&self, last: &Fields, rigid_slip: f64) -> f64 {
        let slip = largest(&self.slip);
        let share = if slip < rigid_slip.abs() {
            slip / rigid_slip.abs()
        } else {
            1.0
        };
        let own = |of: fn(&Fields) -> &Vec<f64>| relative(largest_change(of(self), of(last)), largest(of(self)));
        let traction = largest(&self.pressure).max(largest(&self.shear));
        let pressure = relative(largest_change(&self.pressure, &last.pressure), traction);
        let wheel = relative(
            (self.wheel_temperature - last.wheel_temperature).abs(),
            self.wheel_temperature.abs(),
        );
        let following = [
            own(|fields| &fields.temperature),
            own(|fields| &fields.surface_temperature),
            own(|fields| &fields.thermal_displacement),
            own(|fields| &fields.wear),
            own(|fields| &fields.slip),
            own(|fields| &fields.friction),
            own(|fields| &fields.heat_flux),
            wheel,
        ];
        pressure
            .max(own(|fields| &fields.shear))
            .max(own(|fields| &fields.saturation))
            .max(share * following.into_iter().fold(0.0, f64::max))
    }
}
