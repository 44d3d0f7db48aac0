//! Stop and hold: a wheelset of 12 t brakes from 5 m/s on a gradient of 3 %, its locked wheels hold it for a minute, and it
//! drives off. For each of its two wheels
//!
//! ```text
//! m dV/dt = T − m g i,   J dω/dt = M + D + B,   |B| ≤ B_max, against ω; on a wheel that stands whatever keeps it standing
//! ```
//!
//! with the contact's forces T and M, a drive D and a brake B. Coulomb's contact at rest is a spring that slips at its edges, so that
//! the wheel creeps neither down the gradient nor off the spring. Contact and vehicle meet in implicit Euler's method, by Newton's
//! method with the derivatives that the contact gives of its forces, going back to the state before the step for each try.

use super::row::Row;
use super::set_up;
use crate::error::Result;
use crate::parameters::{Parameters, SlipSource};
use crate::signals::{INPUTS, Inputs};
use crate::simulation::Simulation;

const HOLD: &str = "a vehicle that is parked stays";
const SPRING: &str = "a swing on the contact's spring, damped by the method, ends at rest";
const NEWTON: &str = "Newton's law";
const ENERGY: &str = "conservation of energy";
/// Steps of the coupling, `s`.
const STEPS: [f64; 2] = [1e-3, 1e-2];
/// Half of the wheelset's, with its share of the vehicle, `kg` and `kg m²`.
const MASS: f64 = 6e3;
const INERTIA: f64 = 90.0;
const GRAVITY: f64 = 9.81;
const GRADIENT: f64 = 0.03;
/// Speed at which it begins to brake, `m/s`.
const SPEED: f64 = 5.0;
/// Torques, `N m`: half of what friction can carry, and enough to climb.
const BRAKE: f64 = 6e3;
const DRIVE: f64 = 3e3;
/// Time in which the torques rise and fall, `s`.
const RAMP: f64 = 0.3;
/// Time from standstill to where the brake lets go, the drive being on, and from there to the end, `s`.
const HELD: f64 = 60.0;
const AFTER: f64 = 2.0;
/// Time after which the swing on the spring is over, `s`: at 1 ms a step takes 1 − 1/√(1 + k h²/m), 2.4 %, off it.
const SETTLED: f64 = 1.0;
/// Tolerance of the speeds of a step, `m/s` (and rad/s): of the force of a mass of 6 t that is 6 mN at 1 ms.
const TOLERANCE: f64 = 1e-9;
/// Most tries of a step; four are enough.
const TRIES: usize = 10;

/// Angular speed of the wheel and speed of the vehicle, or torque on the wheel and force on the vehicle.
type Pair = [f64; 2];

/// A wheel with its share of the vehicle.
struct Wheelset {
    run: Simulation,
    time: f64,
    /// Place of the wheelset, `m`.
    place: f64,
    /// ω and V.
    speeds: Pair,
    /// Derivatives of M and of T with respect to ω and V.
    slopes: [Pair; 2],
    /// Work of drive, brake and gravity on it, and of it on the contact, `J`.
    work: f64,
    contact_work: f64,
    /// N e (ω − V/r₀) over time: what the offset of the pressure takes beside friction, `J`.
    rolling_loss: f64,
    /// Most tries of a step.
    tries: usize,
}

impl Wheelset {
    /// Rolling freely.
    fn new() -> Result<Wheelset> {
        let parameters = Parameters {
            slip_source: SlipSource::VehicleSpeed,
            ..Parameters::default()
        };
        let speeds = [SPEED / parameters.wheel_radius, SPEED];
        let mut wheelset = Wheelset {
            run: set_up::simulation(&parameters, &inputs(speeds))?,
            time: 0.0,
            place: 0.0,
            speeds,
            slopes: [[0.0; 2]; 2],
            work: 0.0,
            contact_work: 0.0,
            rolling_loss: 0.0,
            tries: 0,
        };
        wheelset.linearise()?;
        Ok(wheelset)
    }

    /// Derivatives at the contact's last step.
    fn linearise(&mut self) -> Result<()> {
        let row = |name| INPUTS.iter().position(|input| input.name == name);
        let rows = ["wheel_speed", "vehicle_speed"].into_iter().filter_map(row);
        let Simulation {
            model,
            workspace,
            state,
        } = &mut self.run;
        let columns = model.output_sensitivities(workspace, state, rows)?;
        for (column, outputs) in columns.iter().enumerate() {
            self.slopes[0][column] = outputs.friction_torque;
            self.slopes[1][column] = outputs.traction_force;
        }
        Ok(())
    }

    fn forces(&self) -> Pair {
        let outputs = self.run.outputs();
        [outputs.friction_torque, outputs.traction_force]
    }

    /// One step under a drive and a brake that holds up to a torque.
    fn step(&mut self, drive: f64, largest_brake: f64, step: f64) -> Result<()> {
        let before = self.run.state.clone();
        let old = self.speeds;
        let mut guess = old;
        let mut brake = 0.0;
        for tries in 1..=TRIES {
            self.tries = self.tries.max(tries);
            self.run.state.clone_from(&before);
            self.run.step(&inputs(guess), step)?;
            // The first try goes by the derivatives of the step before.
            if tries > 1 {
                self.linearise()?;
            }
            (self.speeds, brake) = self.balanced(old, guess, drive, largest_brake, step);
            let change = [0, 1].map(|i| (self.speeds[i] - guess[i]).abs());
            if change[0].max(change[1]) <= TOLERANCE {
                break;
            }
            guess = self.speeds;
        }
        self.time += step;
        self.account(old, drive, brake, step);
        Ok(())
    }

    /// The speeds at the end of the step, and the brake's torque, with contact forces that are linear about those of `guess`.
    fn balanced(&self, old: Pair, guess: Pair, drive: f64, largest_brake: f64, step: f64) -> (Pair, f64) {
        let inertia = [INERTIA / step, MASS / step];
        let acting = [drive, -MASS * GRAVITY * GRADIENT];
        let (slopes, forces) = (&self.slopes, self.forces());
        let matrix = [0, 1].map(|i| [0, 1].map(|j| if i == j { inertia[i] } else { 0.0 } - slopes[i][j]));
        let known = [0, 1].map(|i| {
            let linear = slopes[i][0] * guess[0] + slopes[i][1] * guess[1];
            inertia[i] * old[i] + forces[i] - linear + acting[i]
        });
        let determinant = matrix[0][0] * matrix[1][1] - matrix[0][1] * matrix[1][0];
        let solve = |right: Pair| {
            [
                (right[0] * matrix[1][1] - matrix[0][1] * right[1]) / determinant,
                (matrix[0][0] * right[1] - matrix[1][0] * right[0]) / determinant,
            ]
        };
        // The brake takes what stops the wheel within the step, as far as it can.
        let (free, of_torque) = (solve(known), solve([1.0, 0.0]));
        let brake = (-free[0] / of_torque[0]).clamp(-largest_brake, largest_brake);
        let speeds = solve([known[0] + brake, known[1]]);
        // On the dot, and not to the last digit, where the brake holds the wheel.
        let stands = brake.abs() < largest_brake;
        ([if stands { 0.0 } else { speeds[0] }, speeds[1]], brake)
    }

    /// Works and ways of a step: with the mean of the speeds before and after it, forces at its end change the kinetic energy
    /// by their work, and to the last digit.
    fn account(&mut self, old: Pair, drive: f64, brake: f64, step: f64) {
        let mean = [0, 1].map(|i| 0.5 * (old[i] + self.speeds[i]));
        let [torque, traction] = self.forces();
        let parameters = self.run.model.parameters();
        let (offset, load) = (self.run.outputs().contact_offset, self.run.state.inputs.normal_load);
        self.work += step * ((drive + brake) * mean[0] - MASS * GRAVITY * GRADIENT * mean[1]);
        self.contact_work -= step * (torque * mean[0] + traction * mean[1]);
        self.rolling_loss += step * load * offset * (mean[0] - mean[1] / parameters.wheel_radius);
        self.place += step * mean[1];
    }

    fn kinetic_energy(&self) -> f64 {
        0.5 * (INERTIA * self.speeds[0] * self.speeds[0] + MASS * self.speeds[1] * self.speeds[1])
    }
}

fn inputs([wheel_speed, vehicle_speed]: Pair) -> Inputs {
    Inputs {
        wheel_speed,
        vehicle_speed,
        normal_load: MASS * GRAVITY,
        ..Inputs::default()
    }
}

/// Ramp from 0 to 1.
fn ramp(since: f64) -> f64 {
    (since / RAMP).clamp(0.0, 1.0)
}

/// Measurements while the wheel is held.
struct Held {
    /// Least and largest place, of all the time and of what comes after the swing, `m`.
    places: [Pair; 2],
    /// Largest speed after the swing, `m/s`, and the traction farthest from what the gradient asks for, `N`.
    speed: f64,
    traction: f64,
    /// Stiffness of the contact under a step that sticks, `N/m`.
    stiffness: f64,
}

impl Held {
    fn range(&self, part: usize) -> f64 {
        self.places[part][1] - self.places[part][0]
    }

    /// Looks at a step, `since` standstill.
    fn look(&mut self, wheelset: &Wheelset, since: f64) {
        let weight = MASS * GRAVITY * GRADIENT;
        for range in &mut self.places[..if since > SETTLED { 2 } else { 1 }] {
            *range = [range[0].min(wheelset.place), range[1].max(wheelset.place)];
        }
        if since > SETTLED {
            self.speed = self.speed.max(wheelset.speeds[1].abs());
            let traction = wheelset.forces()[1];
            if (traction - weight).abs() > (self.traction - weight).abs() {
                self.traction = traction;
            }
        }
    }
}

/// Brakes, holds, drives off; returns the wheelset at the end and what was seen of it while it was held.
fn stop_and_hold(step: f64) -> Result<(Wheelset, Held)> {
    let mut wheelset = Wheelset::new()?;
    let mut held = Held {
        places: [[f64::INFINITY, f64::NEG_INFINITY]; 2],
        speed: 0.0,
        traction: MASS * GRAVITY * GRADIENT,
        stiffness: f64::NAN,
    };
    while wheelset.speeds[1] > 0.0 {
        wheelset.step(0.0, BRAKE * ramp(wheelset.time), step)?;
    }
    let steps = |time: f64| (time / step).round() as usize;
    for number in 0..steps(HELD + AFTER) {
        let since = step * (number + 1) as f64;
        let drive = DRIVE * ramp(since - (HELD - RAMP));
        wheelset.step(drive, BRAKE * (1.0 - ramp(since - HELD)), step)?;
        if number < steps(HELD) {
            held.look(&wheelset, since);
        }
        if number == steps(HELD - 1.0) {
            wheelset.linearise()?;
            held.stiffness = -wheelset.slopes[1][1] / step;
        }
    }
    Ok((wheelset, held))
}

/// Speed at the end, as of a wheel that rolls without creep, `m/s`: what the drive has over the gradient moves it as soon as the
/// brake is down to that.
fn driven_speed(wheel_radius: f64) -> f64 {
    let surplus = DRIVE - MASS * GRAVITY * GRADIENT * wheel_radius;
    let duration = AFTER - RAMP + 0.5 * RAMP * surplus / BRAKE;
    surplus / wheel_radius * duration / (MASS + INERTIA / (wheel_radius * wheel_radius))
}

/// Steps of 1 ms and of 10 ms.
///
/// # Errors
/// A solver that did not converge.
pub fn rows() -> Result<Vec<Row>> {
    let mut rows = Vec::new();
    for step in STEPS {
        let (wheelset, held) = stop_and_hold(step)?;
        let outputs = wheelset.run.outputs();
        let name = |what: &str| format!("{what}, steps of {} ms", 1e3 * step);
        rows.push(Row::at_most(
            name("way from first standstill to release, swing on the spring included"),
            "m",
            1e-4,
            held.range(0),
            HOLD,
        ));
        // 1e-9 m/s that a step may leave, if it were always of the same sign, for a minute.
        rows.push(Row::at_most(
            name("way while held, after the swing"),
            "m",
            TOLERANCE * HELD,
            held.range(1),
            HOLD,
        ));
        // Chatter would be a speed that stays.
        rows.push(Row::at_most(
            name("largest speed while held, after the swing"),
            "m/s",
            10.0 * TOLERANCE,
            held.speed,
            SPRING,
        ));
        // A speed that changes by the tolerance either way in a step.
        let weight = MASS * GRAVITY * GRADIENT;
        rows.push(Row::absolute(
            name("traction while held: m g i"),
            "N",
            weight,
            held.traction,
            2.0 * MASS * TOLERANCE / STEPS[0],
            NEWTON,
        ));
        let radius = wheelset.run.model.parameters().wheel_radius;
        // Torques are held over a step, so that each moment is known to half a step of the two seconds; creep is 0.05 %.
        rows.push(Row::relative(
            name("speed 2 s after the brake lets go"),
            "m/s",
            driven_speed(radius),
            wheelset.speeds[1],
            1e-3 + 0.5 * step / AFTER,
            NEWTON,
        ));
        let start = 0.5 * (INERTIA / (radius * radius) + MASS) * SPEED * SPEED;
        let elastic = 0.5 * outputs.traction_force * outputs.traction_force / held.stiffness;
        let missing = wheelset.work
            - (wheelset.kinetic_energy() - start)
            - outputs.friction_energy
            - wheelset.rolling_loss
            - elastic;
        // 0.3 % of the friction energy is what the power balance at small creepage closes to; an implicit step in which the spring is
        // let go, at the standstill, loses up to half its force squared over its stiffness: 0.3 J.
        rows.push(Row::absolute(
            name("energy missing, over friction energy"),
            "1",
            0.0,
            missing / outputs.friction_energy,
            5e-3,
            ENERGY,
        ));
        rows.push(Row::at_most(
            name("most tries of a step"),
            "1",
            5.0,
            wheelset.tries as f64,
            "Newton's method",
        ));
    }
    Ok(rows)
}
