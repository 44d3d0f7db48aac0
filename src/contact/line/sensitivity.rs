//! Derivatives of the outputs with respect to the inputs, from the linearised converged step.
//!
//! The step solves R(z, u) = 0 for the fields z (tractions, temperature, wear) under the inputs u. At its solution
//! dz/du follows from (∂R/∂z) dz = −(∂R/∂u) du, solved for one input at a time by the same split as the step: the
//! tangents of the tractions for given tangents of temperature and wear, then those of wear and temperature for given
//! tractions, repeated until they rest. Every part is linear and exact; the active set does not change under an
//! infinitesimal change. Held fixed are the fields at the beginning of the sub-step and its length.

use crate::contact::line::fields::Fields;
use crate::contact::line::split::{Contact, Scratch, TEMPERATURE_SCALE, gathered};
use crate::contact::outputs;
use crate::contact::rim::{self, ContactHeat};
use crate::error::{Error, Result};
use crate::friction::{self, coulomb};
use crate::heat::march::SurfaceExchange;
use crate::mechanics::normal::Constraint;
use crate::mechanics::{ProblemTangent, Tractions};
use crate::numerics::anderson::Anderson;
use crate::numerics::dense::{largest, largest_change};
use crate::parameters::{SlipSource, WheelHeating};
use crate::signals::{INPUTS, Inputs, OUTPUTS, Outputs};

/// Iterations of the linear split.
const SPLITS: usize = 400;
/// Iterations after which a linear split that has not come to rest is accelerated.
const ACCELERATE_FROM: usize = 6;
/// Change of the tangents, relative to the largest, at which the linear split rests.
const TOLERANCE: f64 = 1e-9;
/// Relative step of the central difference of the outputs along the tangent. The outputs are sums, products and
/// ratios of the fields: truncation is 1e-14, round-off 1e-9.
const OUTPUT_STEP: f64 = 1e-7;
/// The same for fields of which the outputs are linear functions or the largest value: temperature, displacement, wear and
/// flux. Larger, so that a change of the rail that hardly moves the tractions is not lost in their round-off.
const LINEAR_OUTPUT_STEP: f64 = 1e-5;
/// Steps in the order of [`Fields::vectors`].
const OUTPUT_STEPS: [f64; 9] = {
    let (linear, other) = (LINEAR_OUTPUT_STEP, OUTPUT_STEP);
    [linear, linear, linear, linear, other, other, other, other, linear]
};

/// The linearised step.
pub struct Linearisation<'a> {
    contact: Contact<'a>,
    fields: &'a mut Fields,
    scratch: &'a mut Scratch,
    /// Whether heat and wear follow; not after initialisation, where no time has passed.
    marches: bool,
    lifted: bool,
}

/// Change of the inputs in one direction and of the motion that they make.
#[derive(Debug, Clone, Copy)]
struct InputTangent {
    inputs: Inputs,
    rolling_speed: f64,
    rigid_slip: f64,
}

impl<'a> Linearisation<'a> {
    /// Linearises at `fields`, the solution of a step under the contact's conditions.
    ///
    /// # Errors
    /// Mechanics that are not at rest or singular.
    pub fn new(contact: Contact<'a>, fields: &'a mut Fields, scratch: &'a mut Scratch) -> Result<Linearisation<'a>> {
        let lifted = !fields.pressure.iter().any(|&p| p > 0.0);
        if !lifted {
            contact.linearise_mechanics(fields, scratch)?;
        }
        let marches = contact.conditions.duration > 0.0;
        Ok(Linearisation {
            contact,
            fields,
            scratch,
            marches,
            lifted,
        })
    }

    /// Derivatives of all outputs with respect to the input in a row of [`INPUTS`].
    ///
    /// # Errors
    /// [`Error::SplitNotConverged`].
    pub fn output_sensitivity(&mut self, input: usize) -> Result<Outputs> {
        let mut direction = Inputs::ZERO;
        (INPUTS[input].set)(&mut direction, 1.0);
        let change = self.input_tangent(&direction);
        let tangent = self.fields_tangent(&change)?;
        Ok(self.output_tangent(&change, &tangent))
    }

    /// dV and d(ω r₀ − V).
    fn input_tangent(&self, direction: &Inputs) -> InputTangent {
        let conditions = &self.contact.conditions;
        let parameters = self.contact.parameters;
        let circumferential = direction.wheel_speed * parameters.wheel_radius;
        let (rolling_speed, rigid_slip) = match parameters.slip_source {
            SlipSource::VehicleSpeed => (direction.vehicle_speed, circumferential - direction.vehicle_speed),
            SlipSource::Creepage => {
                let creepage = conditions.inputs.creepage;
                let speed = (circumferential - conditions.motion.rolling_speed * direction.creepage) / (1.0 + creepage);
                (speed, circumferential - speed)
            }
        };
        InputTangent {
            inputs: *direction,
            rolling_speed,
            rigid_slip,
        }
    }

    /// dz along one direction of the inputs.
    fn fields_tangent(&mut self, change: &InputTangent) -> Result<Fields> {
        let n = self.contact.rail.mesh.contact_nodes;
        let mut tangent = Fields::new(self.contact.rail);
        let mut last = tangent.clone();
        let size = gathered(n);
        let (mut iterate, mut image) = (vec![0.0; size], vec![0.0; size]);
        let mut anderson = Anderson::new(size);
        let mut residual = f64::INFINITY;
        for iteration in 0..SPLITS {
            if !self.lifted {
                self.tractions_tangent(change, &iterate, &mut tangent);
            }
            if self.marches {
                self.wear_tangent(change, &mut tangent);
                self.temperature_tangent(change, iterate[size - 1] * TEMPERATURE_SCALE, &mut tangent);
                self.contact.rail.thermal_map.apply(
                    &tangent.temperature,
                    &mut self.scratch.moments,
                    &mut tangent.thermal_displacement,
                );
                self.wheel_tangent(change, &mut tangent);
            } else {
                tangent.wheel_temperature = change.inputs.ambient_temperature;
            }
            self.contact.gather(&tangent, &self.scratch.softening, &mut image);
            residual = tangent
                .vectors()
                .iter()
                .zip(last.vectors())
                .map(|(now, last)| relative_change(now, last))
                .chain([relative_change(&[tangent.wheel_temperature], &[last.wheel_temperature])])
                .fold(0.0, f64::max);
            if residual <= TOLERANCE {
                return Ok(tangent);
            }
            last.copy_from(&tangent);
            if iteration >= ACCELERATE_FROM {
                anderson.next(&iterate, &mut image);
            }
            std::mem::swap(&mut iterate, &mut image);
        }
        Err(Error::SplitNotConverged {
            iterations: SPLITS,
            residual,
            tolerance: TOLERANCE,
        })
    }

    /// dμ at the contact nodes.
    fn friction_tangent(&self, change: &InputTangent, temperature: &[f64], tangent: &mut Fields) {
        let law = self.contact.friction_state();
        for (node, column) in self.contact.rail.mesh.window().enumerate() {
            let rise = self.fields.surface_temperature[column];
            let absolute = law.ambient + rise;
            let slope = law.coefficient(rise).1;
            tangent.friction[node] = slope
                * (temperature[node] * TEMPERATURE_SCALE + change.inputs.ambient_temperature)
                + change.inputs.friction_scale * friction::coefficient(law.parameters, absolute).0;
        }
    }

    /// (31), for the tangents of thermal displacement, temperature and wear of the iterate ([`Contact::gather`]).
    fn tractions_tangent(&mut self, change: &InputTangent, iterate: &[f64], tangent: &mut Fields) {
        let n = self.contact.rail.mesh.contact_nodes;
        let (displacement, rest) = iterate.split_at(2 * n);
        let (temperature, wear) = rest.split_at(n);
        self.friction_tangent(change, temperature, tangent);
        let (contact, rail) = (&self.contact, self.contact.rail);
        let motion = contact.conditions.motion;
        let mut along = displacement[..n].to_vec();
        let mut upward: Vec<f64> = displacement[n..].iter().zip(wear).map(|(u, w)| u - w).collect();
        // d(ρV² C₁ f) = 2ρV dV C₁ f + ρV² C₁ df.
        let density = contact.parameters.density;
        let fields = &*self.fields;
        contact.add_inertia(
            2.0 * density * motion.rolling_speed * change.rolling_speed,
            &fields.pressure,
            &fields.shear,
            &mut along,
            &mut upward,
        );
        contact.add_inertia(
            density * motion.rolling_speed.powi(2),
            &tangent.pressure,
            &tangent.shear,
            &mut along,
            &mut upward,
        );
        let problem = ProblemTangent {
            profile: &upward,
            displacement: &along,
            friction: &tangent.friction,
            total: rail.scaled_load(contact.parameters, change.inputs.normal_load),
            rigid_slip: change.rigid_slip,
            strain_speed: self.speed_tangent(change) * contact.strain_scale(),
        };
        let mut tractions = Tractions {
            pressure: &mut tangent.pressure,
            shear: &mut tangent.shear,
            slip: &mut tangent.slip,
            penetration: &mut tangent.penetration,
        };
        self.contact
            .mechanics_tangent(self.fields, self.scratch, &problem, &mut tractions);
    }

    /// d(1/Δt + |V|/Δx)/dV dV of a column of the given spacing.
    fn advection_tangent(&self, change: &InputTangent, spacing: f64) -> f64 {
        self.speed_tangent(change) / spacing
    }

    /// d|V|.
    fn speed_tangent(&self, change: &InputTangent) -> f64 {
        if self.contact.conditions.motion.rolling_speed >= 0.0 {
            change.rolling_speed
        } else {
            -change.rolling_speed
        }
    }

    /// (24).
    fn wear_tangent(&self, change: &InputTangent, tangent: &mut Fields) {
        let contact = &self.contact;
        let scale = contact.parameters.wear_coefficient * contact.rail.scales.pressure;
        let storage = 1.0 / contact.conditions.duration;
        let transport = contact.upwind();
        let first = contact.rail.mesh.first_contact;
        let fields = &*self.fields;
        tangent.wear[transport.inflow()] = change.inputs.incoming_wear_depth;
        for column in transport.columns() {
            let advection = transport.speed() / column.spacing;
            let node = column.index.wrapping_sub(first);
            let mut source = 0.0;
            if let (Some(p), Some(s)) = (fields.pressure.get(node), fields.slip.get(node)) {
                source = scale * (s.signum() * tangent.slip[node] * p + s.abs() * tangent.pressure[node]);
            }
            let carried = self.advection_tangent(change, column.spacing)
                * (fields.wear[column.upstream] - fields.wear[column.index]);
            tangent.wear[column.index] =
                (advection * tangent.wear[column.upstream] + carried + source) / (storage + advection);
        }
    }

    /// (19), (23), at the given change of the wheel's temperature, `K`.
    fn temperature_tangent(&self, change: &InputTangent, wheel_tangent: f64, tangent: &mut Fields) {
        let contact = &self.contact;
        let (parameters, basis) = (contact.parameters, &contact.rail.basis);
        let (m, capacity) = (basis.len(), parameters.volumetric_heat_capacity());
        let storage = 1.0 / contact.conditions.duration;
        let transport = contact.upwind();
        let first = contact.rail.mesh.first_contact;
        let fields = &*self.fields;
        let law = contact.friction_state();
        let inflow = transport.inflow();
        contact.rail.incoming.enter(
            change.inputs.incoming_temperature - change.inputs.ambient_temperature,
            &mut tangent.temperature[inflow * m..(inflow + 1) * m],
            &mut tangent.surface_temperature[inflow],
        );
        let wheel_rise = contact.wheel_rise(fields.wheel_temperature);
        let wheel_rise_tangent = match parameters.wheel_heating {
            WheelHeating::Off => 0.0,
            WheelHeating::On => wheel_tangent - change.inputs.ambient_temperature,
        };
        for column in transport.columns() {
            let advection = transport.speed() / column.spacing;
            let advection_tangent = self.advection_tangent(change, column.spacing);
            let (mut response, mut unheated) = (0.0, 0.0);
            for mode in 0..m {
                let inverse = 1.0 / (storage + advection + parameters.thermal_diffusivity * basis.eigenvalues[mode]);
                let (own, upstream) = (column.index * m + mode, column.upstream * m + mode);
                let carried = advection_tangent * (fields.temperature[upstream] - fields.temperature[own]);
                tangent.temperature[own] = (advection * tangent.temperature[upstream] + carried) * inverse;
                unheated += basis.surface[mode] * tangent.temperature[own];
                response += basis.surface[mode] * basis.surface[mode] * inverse / capacity;
            }
            let node = column.index.wrapping_sub(first);
            tangent.surface_temperature[column.index] = unheated;
            let Some(&pressure) = fields.pressure.get(node) else {
                continue;
            };
            if pressure <= 0.0 {
                continue;
            }
            let (pressure, slip) = (pressure * contact.rail.scales.pressure, fields.slip[node]);
            let pressure_tangent = tangent.pressure[node] * contact.rail.scales.pressure;
            let slip_tangent = tangent.slip[node];
            let exchange = SurfaceExchange::new(parameters, pressure, slip, wheel_rise);
            let loss = exchange.debris + exchange.conduction;
            let rise = fields.surface_temperature[column.index];
            let (mu, slope) = law.coefficient(rise);
            let scale_tangent = change.inputs.friction_scale * friction::coefficient(parameters, law.ambient + rise).0;
            // d(p φ s) and d(k ρ c_p |s| p + p/r).
            let regularisation = parameters.slip_regularisation;
            let (phi, phi_slope) = (
                coulomb::saturation(slip, regularisation),
                coulomb::saturation_slope(slip, regularisation),
            );
            let power_tangent = pressure_tangent * phi * slip + pressure * (phi_slope * slip + phi) * slip_tangent;
            let debris_factor = parameters.wear_coefficient * capacity;
            let loss_tangent = debris_factor
                * (slip.signum() * slip_tangent * pressure + slip.abs() * pressure_tangent)
                + pressure_tangent / parameters.contact_thermal_resistance;
            let partition = parameters.heat_partition;
            let source = slope * (unheated + change.inputs.ambient_temperature) * exchange.friction
                + scale_tangent * exchange.friction
                + mu * power_tangent
                - loss_tangent * rise
                - loss * unheated
                + pressure_tangent / parameters.contact_thermal_resistance * wheel_rise
                + exchange.conduction * wheel_rise_tangent;
            let flux = partition * source / (1.0 - partition * response * (slope * exchange.friction - loss));
            tangent.heat_flux[node] = flux;
            tangent.surface_temperature[column.index] += response * flux;
            for mode in 0..m {
                let inverse = 1.0 / (storage + advection + parameters.thermal_diffusivity * basis.eigenvalues[mode]);
                tangent.temperature[column.index * m + mode] += flux / capacity * basis.surface[mode] * inverse;
            }
        }
    }

    /// The rim's temperature.
    fn wheel_tangent(&self, change: &InputTangent, tangent: &mut Fields) {
        let contact = &self.contact;
        let (rail, parameters) = (contact.rail, contact.parameters);
        tangent.wheel_temperature = rim::temperature_tangent(
            parameters,
            self.fields.wheel_temperature,
            (
                contact.conditions.inputs.ambient_temperature,
                change.inputs.ambient_temperature,
            ),
            contact.conditions.duration,
            &ContactHeat::new(rail, parameters, self.fields),
            &ContactHeat::tangent(rail, parameters, self.fields, tangent),
        );
    }

    /// Derivatives of the outputs along the tangents of inputs and fields.
    fn output_tangent(&self, change: &InputTangent, tangent: &Fields) -> Outputs {
        let (contact, fields) = (&self.contact, &*self.fields);
        // A step that moves no field by more than its share of its largest value.
        let step = fields
            .vectors()
            .iter()
            .zip(tangent.vectors())
            .zip(OUTPUT_STEPS)
            .map(|((field, tangent), share)| share * largest(field) / largest(tangent))
            .filter(|step| step.is_finite() && *step > 0.0)
            .fold(f64::INFINITY, f64::min);
        let step = if step.is_finite() { step } else { OUTPUT_STEP };
        let duration = contact.conditions.duration;
        let moved = |step: f64| {
            let mut fields = fields.clone();
            fields.add_multiple(step, tangent);
            let inputs = contact.conditions.inputs.advanced(&change.inputs, step);
            let mut outputs = outputs::instantaneous(contact.rail, contact.parameters, &fields, &inputs);
            outputs.wheel_wear_depth = duration
                * rim::wear_rate(
                    contact.parameters,
                    outputs::sliding_power(contact.rail, contact.parameters, &fields),
                );
            outputs
        };
        let (ahead, behind) = (moved(step), moved(-step));
        let mut derivative = Outputs::default();
        for signal in OUTPUTS {
            (signal.set)(
                &mut derivative,
                ((signal.get)(&ahead) - (signal.get)(&behind)) / (2.0 * step),
            );
        }
        // Counted in nodes: constant but for jumps.
        derivative.stick_fraction = 0.0;
        derivative.worn_volume = derivative.wear_rate * duration;
        derivative.friction_energy = derivative.friction_power * duration;
        derivative.distance = self.speed_tangent(change) * duration;
        if let Constraint::Total(total) = contact.constraint() {
            if total == 0.0 {
                derivative.penetration = 0.0;
            }
        }
        derivative
    }
}

fn relative_change(now: &[f64], last: &[f64]) -> f64 {
    let change = largest_change(now, last);
    if change == 0.0 { 0.0 } else { change / largest(now) }
}
