//! A wheel that spins on the spot digs a groove of its own radius. Of rigid bodies the groove takes the section 2L³/(3 r₀) off
//! the rail, L its half-length, and by Archard's law a slip of D takes off k N D/b:
//! L = (3 r₀ k N D/(2b))^⅓, with the depth L²/(2 r₀) in the middle.
//!
//! A groove that grows without changing its radius sinks evenly, so that the pressure is even too, and elastic bodies give way by the
//! displacement under it (Johnson, Contact Mechanics, 2.30a), of the section L a²/(2 r₀), a being Hertz's half-length:
//! that much less is worn off.

use super::row::Row;
use super::set_up::{self, mechanics_alone};
use crate::error::Result;
use crate::parameters::{Parameters, SlipSource, Wheel};
use crate::signals::Inputs;
use crate::simulation::Simulation;

const SOURCE: &str = "Archard's law and a groove of the wheel's radius";
/// Slip velocity of the wheel's surface, `m/s`.
const SLIP_VELOCITY: f64 = 1.0;
/// Slip in a step, `m`.
const STRIDE: f64 = 1e-3;
/// A load under which the contact is a tenth of the groove, `N`, and the slip that makes it, `m`, on a soft rail.
const LIGHT: f64 = 1e3;
const SLIP: f64 = 0.5;
const SOFT: f64 = 1e-11;

/// A wheel on the spot.
struct Spinning {
    run: Simulation,
    load: f64,
    /// Slip so far, `m`.
    slip: f64,
}

impl Spinning {
    fn new(parameters: Parameters, load: f64) -> Result<Spinning> {
        let parameters = Parameters {
            slip_source: SlipSource::VehicleSpeed,
            ..parameters
        };
        Ok(Spinning {
            run: set_up::simulation(&parameters, &inputs(&parameters, load))?,
            load,
            slip: 0.0,
        })
    }

    fn step(&mut self) -> Result<()> {
        let inputs = inputs(self.run.model.parameters(), self.load);
        self.run.step(&inputs, STRIDE / SLIP_VELOCITY)?;
        self.slip += STRIDE;
        Ok(())
    }

    /// Spins until the groove fills the window; no longer than rigid bodies would take. Returns the slip.
    fn fill(&mut self) -> Result<f64> {
        let longest = self.slip_of(self.run.model.parameters().window_half_width());
        while self.slip <= longest && !self.run.state.convergence.fills_window {
            self.step()?;
        }
        Ok(self.slip)
    }

    /// Slip in which elastic bodies do, `m`.
    fn elastic_slip_of(&self, half_length: f64) -> f64 {
        let hertz = self.run.model.parameters().hertz_half_length(self.load);
        self.slip_of(half_length) * (1.0 - 0.75 * (hertz / half_length).powi(2))
    }

    /// Slip in which rigid bodies make a groove of this half-length, `m`.
    fn slip_of(&self, half_length: f64) -> f64 {
        let parameters = self.run.model.parameters();
        let section = 2.0 * half_length.powi(3) / (3.0 * parameters.wheel_radius);
        parameters.contact_width * section / (parameters.wear_coefficient * self.load)
    }
}

fn inputs(parameters: &Parameters, normal_load: f64) -> Inputs {
    Inputs {
        vehicle_speed: 0.0,
        wheel_speed: SLIP_VELOCITY / parameters.wheel_radius,
        normal_load,
        ..Inputs::default()
    }
}

/// Length and depth of the groove under a light load; the slip that fills the default window under the default one.
///
/// # Errors
/// A solver that did not converge.
pub fn rows() -> Result<Vec<Row>> {
    let mut light = Spinning::new(
        Parameters {
            wear_coefficient: SOFT,
            ..mechanics_alone()
        },
        LIGHT,
    )?;
    for _ in 0..(SLIP / STRIDE).round() as usize {
        light.step()?;
    }
    let (parameters, outputs) = (light.run.model.parameters(), light.run.outputs());
    let half_length = (1.5 * parameters.wheel_radius * SOFT * LIGHT * light.slip / parameters.contact_width).cbrt();
    let mut rows = vec![
        Row::absolute(
            "half-length of the groove after 0.5 m, 1 kN, k = 1e-11 1/Pa",
            "m",
            half_length,
            0.5 * outputs.contact_length,
            // Its ends lie between nodes.
            light.run.model.line_operators()?.mesh.contact_spacing(),
            SOURCE,
        ),
        Row::relative(
            "depth of that groove",
            "m",
            half_length * half_length / (2.0 * parameters.wheel_radius),
            outputs.wear_depth,
            // Where the groove was not worn the bodies touch by their elasticity: (a/L)² of the depth with Hertz's a.
            (parameters.hertz_half_length(LIGHT) / half_length).powi(2),
            SOURCE,
        ),
    ];
    let mut alone = Spinning::new(
        Parameters {
            wear_coefficient: Parameters::default().wear_coefficient,
            ..mechanics_alone()
        },
        Inputs::default().normal_load,
    )?;
    // It fills the window somewhere between its last two nodes.
    let mesh = &alone.run.model.line_operators()?.mesh;
    let [inner, outer] = [1.0, 0.0].map(|cells| mesh.window_half_width() - cells * mesh.contact_spacing());
    let [least, most] = [inner, outer].map(|half_length| alone.elastic_slip_of(half_length));
    rows.push(Row::absolute(
        "slip on the spot until the groove fills the contact window, mechanics alone, 60 kN",
        "m",
        0.5 * (least + most),
        alone.fill()?,
        0.5 * (most - least),
        SOURCE,
    ));
    for (wheel, name) in [(Wheel::Elastic, "elastic wheel"), (Wheel::Rigid, "rigid wheel")] {
        let parameters = Parameters {
            wheel,
            ..Parameters::default()
        };
        let mut spinning = Spinning::new(parameters, Inputs::default().normal_load)?;
        rows.push(Row::at_most(
            format!("the same with heat, {name}, no more than of rigid bodies"),
            "m",
            spinning.slip_of(spinning.run.model.parameters().window_half_width()),
            spinning.fill()?,
            SOURCE,
        ));
    }
    Ok(rows)
}
