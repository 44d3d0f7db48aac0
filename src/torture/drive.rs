//! A random way of driving: stretches of some steps each, along which the inputs are held after a jump, or go to new values on
//! ramps or in stairs. Ramps through V = 0 reverse or stop the wheel; at V = 0 it stands or spins on the spot; without load it
//! is lifted.

use super::random::Random;
use crate::parameters::{ContactModel, Control, Parameters, SlipSource};
use crate::signals::{INPUTS, Inputs};

/// Largest rolling speed, `m/s`.
const LARGEST_SPEED: f64 = 80.0;
/// Largest share of `largest_load`.
const LARGEST_SHARE: f64 = 0.98;

/// One communication step.
#[derive(Debug, Clone, Copy)]
pub struct DriveStep {
    /// Inputs at its beginning.
    pub inputs: Inputs,
    /// Rates of the inputs, per second.
    pub rates: Inputs,
    /// Length of the step, `s`.
    pub duration: f64,
}

/// Course of the inputs to those of the next stretch.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Course {
    Jump,
    Ramp,
    Stairs,
}

/// The way of one wheel; it does not depend on what the wheel does.
pub struct Drive<'a> {
    random: Random,
    parameters: &'a Parameters,
    /// The largest load of the drive, `N`.
    largest_load: f64,
    now: Inputs,
    target: Inputs,
    course: Course,
    duration: f64,
    /// Steps left of the stretch.
    left: usize,
}

impl<'a> Drive<'a> {
    /// Begins a drive with loads up to 98 % of `largest_load`.
    pub fn new(mut random: Random, parameters: &'a Parameters, largest_load: f64) -> Drive<'a> {
        let ambient = random.between(250.0, 320.0);
        let calm = Inputs {
            normal_load: 0.5 * largest_load,
            ambient_temperature: ambient,
            incoming_temperature: ambient,
            ..Inputs::default()
        };
        let mut drive = Drive {
            random,
            parameters,
            largest_load: LARGEST_SHARE * largest_load,
            now: calm,
            target: calm,
            course: Course::Jump,
            duration: 1e-3,
            left: 0,
        };
        drive.now = drive.new_target();
        drive.target = drive.now;
        drive
    }

    /// The inputs at the present instant.
    pub fn inputs(&self) -> &Inputs {
        &self.now
    }

    /// A new target: what is not drawn anew stays.
    fn new_target(&mut self) -> Inputs {
        let random = &mut self.random;
        let mut inputs = self.now;
        let ambient = inputs.ambient_temperature;
        if random.chance(0.7) {
            set_motion(random, self.parameters, &mut inputs);
        }
        if self.parameters.contact_model == ContactModel::Patch && random.chance(0.7) {
            set_lateral_motion(random, self.parameters, &mut inputs);
        }
        if self.parameters.contact_model == ContactModel::Profiles && random.chance(0.8) {
            set_place(random, self.parameters, &mut inputs);
        }
        if random.chance(0.6) {
            inputs.normal_load = match random.count(0, 19) {
                0 | 1 => 0.0,
                // A wheel that hardly touches, and loads at which numbers lose their digits.
                2 if random.chance(0.3) => random.decades(f64::MIN_POSITIVE, 1e-6),
                2 => random.decades(1e-6, 1.0) * self.largest_load,
                3 | 4 => self.largest_load,
                _ => random.between(0.02, 1.0) * self.largest_load,
            };
        }
        if random.chance(0.2) {
            inputs.friction_scale = match random.count(0, 9) {
                0 => 0.0,
                1..=4 => random.between(0.2, 1.0),
                _ => 1.0,
            };
        }
        if random.chance(0.15) {
            inputs.incoming_temperature = if random.chance(0.5) {
                ambient
            } else {
                ambient + random.between(0.0, 300.0)
            };
        }
        if random.chance(0.15) {
            inputs.incoming_wear_depth = if random.chance(0.5) {
                0.0
            } else {
                random.decades(1e-9, 1e-5)
            };
        }
        inputs
    }

    fn new_stretch(&mut self) {
        self.now = self.target;
        self.target = self.new_target();
        self.course = self.random.one_of(&[Course::Jump, Course::Ramp, Course::Stairs]);
        self.duration = self.random.decades(10e-6, 30e-3);
        self.left = self.random.count(1, 40);
        if self.course == Course::Jump {
            self.now = self.target;
        }
    }

    /// The next step.
    pub fn step(&mut self) -> DriveStep {
        if self.left == 0 {
            self.new_stretch();
        }
        let mut rates = Inputs::ZERO;
        for signal in INPUTS {
            let change = (signal.get)(&self.target) - (signal.get)(&self.now);
            (signal.set)(&mut rates, change / (self.left as f64 * self.duration));
        }
        let end = if self.left == 1 {
            self.target
        } else {
            self.now.advanced(&rates, self.duration).snapped(self.parameters)
        };
        self.left -= 1;
        let inputs = if self.course == Course::Ramp { self.now } else { end };
        if self.course != Course::Ramp {
            rates = Inputs::ZERO;
        }
        self.now = end;
        DriveStep {
            inputs,
            rates,
            duration: self.duration,
        }
    }
}

/// Draws rolling speed and slip: ±80 m/s and standstill, slip between 1e-5 and 2, a locked wheel, and on the spot up to 10 m/s.
fn set_motion(random: &mut Random, parameters: &Parameters, inputs: &mut Inputs) {
    let speed = random.sign()
        * match random.count(0, 9) {
            0 | 1 => 0.0,
            2 => random.decades(1e-5, 0.1),
            3..=5 => random.decades(0.1, LARGEST_SPEED),
            _ => random.between(0.0, LARGEST_SPEED),
        };
    // A patch, whose pressure is higher, soon glows where it slides as fast as a line may.
    let calm = parameters.contact_model != ContactModel::Line && random.chance(0.8);
    let creepage = match random.count(0, 9) {
        0 => 0.0,
        1 if !calm => -1.0,
        _ => random.sign() * random.decades(1e-5, if calm { 0.03 } else { 2.0 }),
    };
    let on_the_spot = if random.chance(0.4) {
        0.0
    } else {
        random.sign() * random.decades(1e-4, 10.0)
    };
    match parameters.slip_source {
        SlipSource::VehicleSpeed => {
            let circumferential = if speed == 0.0 {
                on_the_spot
            } else {
                speed * (1.0 + creepage)
            };
            inputs.vehicle_speed = speed;
            inputs.wheel_speed = circumferential / parameters.wheel_radius;
        }
        // Nearly on the spot: the creepage has a limit.
        SlipSource::Creepage if speed == 0.0 => {
            inputs.creepage = 100.0;
            inputs.wheel_speed = on_the_spot / parameters.wheel_radius;
        }
        SlipSource::Creepage => {
            inputs.creepage = creepage.max(-0.99);
            inputs.wheel_speed = speed * (1.0 + inputs.creepage) / parameters.wheel_radius;
        }
    }
}

/// Draws place and motion of a wheelset over its track: hunting, flange climbing and now and then beyond the rail, yaw up to 60 mrad, irregularities of the
/// rail; at a given height from lifted to pressed into the rail.
fn set_place(random: &mut Random, parameters: &Parameters, inputs: &mut Inputs) {
    let signed = |random: &mut Random, low: f64, high: f64| random.sign() * random.decades(low, high);
    inputs.lateral_displacement = match random.count(0, 19) {
        0 => random.between(-0.03, 0.03),
        1..=5 => random.sign() * random.between(4e-3, 9e-3),
        _ => random.between(-5e-3, 5e-3),
    };
    inputs.yaw_angle = match random.count(0, 3) {
        0 => 0.0,
        1 => random.between(-0.06, 0.06),
        _ => signed(random, 1e-5, 0.02),
    };
    inputs.lateral_speed = signed(random, 1e-4, 0.3);
    inputs.yaw_rate = signed(random, 1e-4, 0.3);
    inputs.rail_lateral_displacement = random.one_of(&[0.0, 1e-3, -2e-3]);
    inputs.rail_lateral_speed = random.one_of(&[0.0, 0.02]);
    if parameters.control == Control::Height {
        // About the height at which tread and head touch: where the flange does, the load may be more than is carried, and refused.
        inputs.vertical_displacement = random.between(-3e-4, 2e-4);
        inputs.vertical_speed = signed(random, 1e-4, 0.1);
        inputs.roll_angle = 0.0;
    } else {
        inputs.roll_angle = random.one_of(&[0.0, 1.0]) * random.between(-0.01, 0.01);
        inputs.roll_rate = signed(random, 1e-4, 0.1);
        inputs.rail_roll_angle = random.one_of(&[0.0, 2e-3]);
    }
}

/// Draws what moves a patch besides: a lateral creepage up to 0.5 and a spin up to 10 1/m, or what they are at the present speed;
/// across and about the contact at standstill.
fn set_lateral_motion(random: &mut Random, parameters: &Parameters, inputs: &mut Inputs) {
    let largest = if random.chance(0.8) { 0.03 } else { 0.5 };
    let lateral = if random.chance(0.3) {
        0.0
    } else {
        random.sign() * random.decades(1e-5, largest)
    };
    let spin = if random.chance(0.3) {
        0.0
    } else {
        random.sign() * random.decades(1e-3, 10.0)
    };
    match parameters.slip_source {
        SlipSource::Creepage => (inputs.lateral_creepage, inputs.spin_creepage) = (lateral, spin),
        SlipSource::VehicleSpeed => {
            let speed = if inputs.vehicle_speed == 0.0 || random.chance(0.1) {
                1.0
            } else {
                inputs.vehicle_speed
            };
            (inputs.lateral_speed, inputs.spin_rate) = (speed * lateral, speed * spin);
        }
    }
}
