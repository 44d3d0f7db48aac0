//! The outputs, from the integrals over a contact.

use super::integrals::Integrals;
use super::problem::StepConditions;
use super::rim;
use crate::damage;
use crate::friction;
use crate::parameters::{ContactModel, Control, Parameters, WearLaw, WheelWearLaw};
use crate::signals::{ContactOutputs, Inputs, Motion, Outputs, Totals};

impl Integrals {
    /// Force of a scaled traction of 1 on a node, `N`.
    fn unit_force(&self) -> f64 {
        self.node_area * self.pressure_scale
    }

    /// ∫ |s| p dA, to which Archard's wear is proportional, `W`.
    fn sliding_power(&self) -> f64 {
        self.unit_force() * self.sums.sliding
    }

    /// Friction power ∫ |τ s| dA, `W`.
    fn friction_power(&self) -> f64 {
        self.unit_force() * self.sums.friction_power
    }

    /// Volume worn off the rail per time, `m³/s`.
    fn wear_rate(&self, parameters: &Parameters) -> f64 {
        match parameters.wear_law {
            WearLaw::Archard => parameters.wear_coefficient * self.sliding_power(),
            WearLaw::ArchardMap | WearLaw::Energy => self.node_area * self.sums.wear_rate,
        }
    }

    /// Volume worn off the wheel per time, `m³/s`.
    fn wheel_wear_rate(&self, parameters: &Parameters) -> f64 {
        match parameters.wheel_wear_law {
            WheelWearLaw::Coefficient => parameters.wheel_wear_coefficient * self.sliding_power(),
            WheelWearLaw::WearLaw => self.wear_rate(parameters),
        }
    }

    /// Width of the tread in contact, `m`.
    fn width(&self, parameters: &Parameters) -> f64 {
        match parameters.contact_model {
            ContactModel::Line => parameters.contact_width,
            ContactModel::Patch | ContactModel::Profiles => self.contact_breadth,
        }
    }

    /// Writes the outputs that a patch has and a line contact does not: forces across the rail and about its normal, and in the axes of the track, the
    /// contact's extent across.
    fn add_patch(&self, parameters: &Parameters, inputs: &Inputs, motion: &Motion, outputs: &mut Outputs) {
        outputs.normal_force *= damping(parameters, inputs.contact_penetration_speed);
        let force = self.unit_force();
        outputs.lateral_force = -force * self.sums.lateral_shear;
        outputs.spin_moment = -force * self.sums.spin_moment;
        outputs.contact_breadth = self.contact_breadth;
        outputs.contact_area = self.contact_area;
        let (sine, cosine) = inputs.contact_inclination.sin_cos();
        outputs.force_x = outputs.traction_force;
        outputs.force_y = cosine * outputs.lateral_force - sine * outputs.normal_force;
        outputs.force_z = sine * outputs.lateral_force + cosine * outputs.normal_force;
        // The signs are those of the forces on the wheel and of its motion; |V| makes it the work per distance either way.
        outputs.wear_number = (outputs.traction_force * motion.rigid_slip
            - outputs.lateral_force * motion.lateral_speed
            - outputs.spin_moment * motion.spin_rate)
            / creepage_speed(motion.rolling_speed).abs();
        outputs.rcf_damage = damage::rolling_contact_fatigue(parameters, outputs.wear_number);
    }

    /// Writes the outputs that profiles have: forces on the wheelset, the contacts one by one.
    fn add_profiles(&self, parameters: &Parameters, ambient: f64, outputs: &mut Outputs) {
        let all = &self.on_wheelset;
        outputs.normal_force = all.contacts[..all.count]
            .iter()
            .map(|contact| contact.normal_force)
            .sum();
        [outputs.force_x, outputs.force_y, outputs.force_z] = all.force;
        [outputs.moment_x, outputs.moment_y, outputs.moment_z] = all.moment;
        outputs.friction_torque = all.torque;
        outputs.contacts = all.count as f64;
        outputs.flange_height = all.measures.flange_height;
        outputs.flange_thickness = all.measures.flange_thickness;
        outputs.flange_gradient = all.measures.flange_gradient;
        outputs.hollow_depth = all.measures.hollow_depth;
        let contacts = &all.contacts[..all.count];
        outputs.lateral_force = contacts.iter().map(|contact| contact.friction[1]).sum();
        outputs.spin_moment = contacts.iter().map(|contact| contact.spin_moment).sum();
        outputs.contact_breadth = self.contact_breadth;
        outputs.contact_area = self.contact_area;
        outputs.wear_number = contacts.iter().map(|contact| contact.wear_number).sum();
        for (written, contact) in outputs.contact.iter_mut().zip(contacts) {
            *written = ContactOutputs {
                rail_position: contact.positions[0],
                wheel_position: contact.positions[1],
                position: contact.along,
                inclination: contact.inclination,
                normal_force: contact.normal_force,
                longitudinal_force: contact.friction[0],
                lateral_force: contact.friction[1],
                spin_moment: contact.spin_moment,
                longitudinal_creepage: contact.creepages[0],
                lateral_creepage: contact.creepages[1],
                spin_creepage: contact.creepages[2],
                length: contact.size[0],
                breadth: contact.size[1],
                area: contact.area,
                peak_pressure: contact.peak_pressure,
                peak_temperature: ambient + contact.peak_rise,
                friction_power: contact.friction_power,
                wear_number: contact.wear_number,
                rcf_damage: damage::rolling_contact_fatigue(parameters, contact.wear_number),
                surface_fatigue_index: contact.damage.surface_fatigue_index(),
                austenite_depth: contact.damage.austenite_depth,
            };
        }
        let damages = outputs.contact[..contacts.len()]
            .iter()
            .map(|contact| contact.rcf_damage);
        outputs.rcf_damage = damages.reduce(f64::max).unwrap_or(0.0);
    }

    /// The outputs at one instant, with the totals until then.
    pub fn outputs(&self, parameters: &Parameters, inputs: &Inputs, totals: &Totals) -> Outputs {
        let motion = inputs.motion(parameters);
        let sums = &self.sums;
        let force = self.unit_force();
        let ambient = inputs.ambient_temperature;
        let load = force * sums.pressure;
        let traction_force = -force * sums.shear;
        let offset = sums.per_pressure(sums.moment);
        // Without contact the coefficient is that of the hottest spot.
        let free = friction::coefficient(parameters, ambient + self.peak_rise).0 * inputs.friction_scale;
        let mut outputs = Outputs {
            traction_force,
            normal_force: load,
            friction_torque: -(traction_force * inputs.radius(parameters) + load * offset),
            peak_temperature: ambient + self.peak_rise,
            traction_coefficient: -sums.per_pressure(sums.shear),
            slip_creepage: motion.rigid_slip / creepage_speed(motion.rolling_speed),
            penetration: self.penetration,
            contact_length: self.contact_length,
            contact_offset: offset,
            peak_pressure: sums.peak_pressure * self.pressure_scale,
            peak_shear: sums.peak_shear * self.pressure_scale,
            stick_fraction: if sums.nodes > 0.0 {
                sums.sticking / sums.nodes
            } else {
                0.0
            },
            friction_coefficient: if sums.pressure > 0.0 {
                sums.friction / sums.pressure
            } else {
                free
            },
            friction_power: self.friction_power(),
            rail_heat_flow: self.node_area * sums.heat_flux,
            wear_depth: self.wear_depth,
            wear_rate: self.wear_rate(parameters),
            wheel_temperature: self.wheel_temperature,
            wheel_heat_flow: self.wheel_heat.flow(self.wheel_temperature - ambient),
            leaving_temperature: ambient + self.leaving_rise,
            leaving_wear_depth: self.leaving_wear_depth,
            worn_volume: totals.worn_volume,
            friction_energy: totals.friction_energy,
            distance: totals.distance,
            wheel_wear_depth: totals.wheel_wear_depth,
            wheel_worn_volume: totals.wheel_worn_volume,
            wheel_worn_area: totals.wheel_worn_area,
            rail_worn_area: totals.rail_worn_area,
            surface_fatigue_index: self.damage.surface_fatigue_index(),
            austenite_depth: self.damage.austenite_depth,
            ..Outputs::default()
        };
        match parameters.contact_model {
            ContactModel::Line => {}
            ContactModel::Patch => self.add_patch(parameters, inputs, &motion, &mut outputs),
            ContactModel::Profiles => self.add_profiles(parameters, ambient, &mut outputs),
        }
        outputs
    }

    /// Rates of growth of the totals per second.
    pub fn total_rates(&self, parameters: &Parameters, inputs: &Inputs) -> Totals {
        let wheel = self.wheel_wear_rate(parameters);
        let [wheel_area, rail_area] = self.on_wheelset.worn_area_rates;
        Totals {
            worn_volume: self.wear_rate(parameters),
            friction_energy: self.friction_power(),
            distance: inputs.motion(parameters).rolling_speed.abs(),
            wheel_wear_depth: rim::wear_rate(parameters, wheel, self.width(parameters)),
            wheel_worn_volume: wheel,
            wheel_worn_area: wheel_area,
            rail_worn_area: rail_area,
        }
    }

    /// Totals at the end of a step that began with those of `before`.
    pub fn totals_after(&self, parameters: &Parameters, conditions: &StepConditions, before: &Totals) -> Totals {
        before.grown(&self.total_rates(parameters, &conditions.inputs), conditions.duration)
    }
}

/// Factor on the normal force of a contact at the speed of its approach, `m/s` (Hunt and Crossley, J. Appl. Mech. 42, 1975): the force is continuous where
/// the contact begins, and never pulls.
pub fn damping(parameters: &Parameters, speed: f64) -> f64 {
    match parameters.control {
        Control::Height => (1.0 + parameters.normal_damping * speed).max(0.0),
        Control::Load | Control::Penetration => 1.0,
    }
}

/// Speed that creepages are taken over: V, with its sign, held at a millimetre per second near rest, so that they stay finite, `m/s`.
pub fn creepage_speed(speed: f64) -> f64 {
    const LEAST: f64 = 1e-3;
    let direction = if speed < 0.0 { -1.0 } else { 1.0 };
    direction * speed.abs().max(LEAST)
}
