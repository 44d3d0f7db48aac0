//! Cattaneo's and Mindlin's contact at rest: under constant pressure the wheel is moved along the rail, forth, back, and forth
//! until it slides (Johnson, Contact Mechanics, 7.2 and 7.4). Like bodies, constant μ.
//!
//! Going forth, the shear is that of sliding less that of sliding on the part c of the half-length that sticks,
//! τ/(μ p₀) = √(1 − x²/a²) − (c/a) √(1 − x²/c²), T/(μN) = 1 − (c/a)². Back from T*, twice such a distribution of half the
//! force T* − T is taken off. The displacement of an elliptic shear of force Q per width on half-length a is
//! direct/π Q (ln(1/a) + a constant of the body), so that beside a spring, which gives its work back,
//! the displacement is f(T) = direct/(2π) (μN − T) ln(1 − T/(μN)) per width, and a cycle between ±T* takes the area of its loop.

use super::row::Row;
use super::set_up::{self, mechanics_alone};
use crate::body::half_plane::HalfPlanes;
use crate::error::Result;
use crate::parameters::{Parameters, SlipSource, Wheel};
use crate::signals::Inputs;
use crate::simulation::Simulation;
use std::f64::consts::PI;

const SOURCE: &str = "Cattaneo 1938, Mindlin 1949; Johnson, Contact Mechanics, 7.2, 7.4";
const LOAD: f64 = 60e3;
const STEP: f64 = 1e-3;
/// Displacement of the wheel a step, `m`: some 80 steps to sliding.
const STRIDE: f64 = 2.5e-7;
/// T*/(μN), where the motion turns back.
const TURN: f64 = 0.9;

fn parameters() -> Parameters {
    Parameters {
        wheel: Wheel::Elastic,
        slip_source: SlipSource::VehicleSpeed,
        ..mechanics_alone()
    }
}

/// A wheel that is moved along the rail without rolling.
struct Ramp {
    run: Simulation,
    /// T/(μN).
    share: f64,
    /// ∫ T dδ so far, `J`.
    work: f64,
}

impl Ramp {
    fn new() -> Result<Ramp> {
        Ok(Ramp {
            run: set_up::simulation(&parameters(), &Ramp::inputs(0.0))?,
            share: 0.0,
            work: 0.0,
        })
    }

    fn inputs(surface_speed: f64) -> Inputs {
        Inputs {
            wheel_speed: surface_speed / parameters().wheel_radius,
            vehicle_speed: 0.0,
            normal_load: LOAD,
            ..Inputs::default()
        }
    }

    /// Moves on by one stride, forth or back.
    fn stride(&mut self, sign: f64) -> Result<()> {
        let outputs = self.run.hold(&Ramp::inputs(sign * STRIDE / STEP), STEP, 1)?;
        let before = self.share;
        self.share = outputs.traction_coefficient / parameters().friction_cold;
        let mean = 0.5 * (before + self.share) * parameters().friction_cold * LOAD;
        self.work += mean * sign * STRIDE;
        Ok(())
    }

    /// Strides until T/(μN) has reached `share`.
    fn go_to(&mut self, share: f64) -> Result<()> {
        let sign = if share > self.share { 1.0 } else { -1.0 };
        // Sliding is reached after some hundred strides from one side to the other.
        for _ in 0..1000 {
            if sign * (share - self.share) <= 0.0 {
                break;
            }
            self.stride(sign)?;
        }
        Ok(())
    }

    /// Mean and largest difference of τ/(μ p₀) from `exact` of the positions over the half-length, at the nodes in contact.
    fn deviation(&self, exact: impl Fn(f64) -> f64) -> Result<[f64; 2]> {
        let parameters = parameters();
        let half_length = parameters.hertz_half_length(LOAD);
        let largest = parameters.friction_cold * parameters.hertz_peak_pressure(LOAD);
        let spacing = self.run.model.line_operators()?.mesh.contact_spacing() / half_length;
        let (mut sum, mut worst, mut count) = (0.0, 0.0_f64, 0.0);
        for node in self.run.contact_nodes().iter().filter(|node| node.pressure > 0.0) {
            let shear = -node.shear / largest;
            let difference = (shear - cell_mean(&exact, node.position / half_length, spacing)).abs();
            (sum, worst, count) = (sum + difference, worst.max(difference), count + 1.0);
        }
        Ok([sum / count, worst])
    }
}

/// Mean over one cell: a node's traction is that of its cell.
fn cell_mean(exact: &impl Fn(f64) -> f64, x: f64, spacing: f64) -> f64 {
    const POINTS: u32 = 64;
    let at = |k: u32| exact(x + spacing * ((f64::from(k) + 0.5) / f64::from(POINTS) - 0.5));
    (0..POINTS).map(at).sum::<f64>() / f64::from(POINTS)
}

/// τ/(μ p₀) of sliding on a share of the half-length, times that share.
fn ellipse(share: f64, x: f64) -> f64 {
    (share * share - x * x).max(0.0).sqrt()
}

/// τ/(μ p₀) at T/(μN) = `force`, on the way forth from no shear.
fn forth(force: f64, x: f64) -> f64 {
    ellipse(1.0, x) - ellipse((1.0 - force).max(0.0).sqrt(), x)
}

/// Shear over the peak of μp at `force` on the way back from `turn`.
fn back(turn: f64, force: f64, x: f64) -> f64 {
    forth(turn, x) - 2.0 * forth(0.5 * (turn - force), x)
}

/// Area of the loop between ±T*, `J`.
fn loop_area(parameters: &Parameters, turn: f64) -> f64 {
    let sliding = parameters.friction_cold * LOAD;
    // f over its unit, of forces over μN.
    let f = |force: f64| {
        if force < 1.0 {
            (1.0 - force) * (1.0 - force).ln()
        } else {
            0.0
        }
    };
    // Forth from −T*: f(−T*) + 2 f((T + T*)/2); back: the mirror image. The area is ∮ T dδ = −∮ δ dT.
    const POINTS: u32 = 20_000;
    let width = |k: u32| {
        let force = turn * (2.0 * (f64::from(k) + 0.5) / f64::from(POINTS) - 1.0);
        let up = 2.0 * f(0.5 * (force + turn)) - f(turn);
        let down = f(turn) - 2.0 * f(0.5 * (turn - force));
        down - up
    };
    let mean = (0..POINTS).map(width).sum::<f64>() / f64::from(POINTS);
    let unit = HalfPlanes::of_pair(parameters).direct / (2.0 * PI) * sliding / parameters.contact_width;
    2.0 * turn * sliding * unit * mean
}

/// Profiles forth, back and at sliding, and the work of one cycle.
///
/// # Errors
/// A solver that did not converge.
pub fn rows() -> Result<Vec<Row>> {
    let mut rows = Vec::new();
    let mut ramp = Ramp::new()?;
    let mut profile = |name: &str, [mean, worst]: [f64; 2]| {
        rows.push(Row::absolute(
            format!("mean difference of tau over mu p0 from the closed form, {name}"),
            "1",
            0.0,
            mean,
            0.01,
            SOURCE,
        ));
        // The cell in which the stick zone ends: the closed form has a corner there, which no cell resolves.
        rows.push(Row::absolute(
            format!("largest difference, {name}"),
            "1",
            0.0,
            worst,
            0.05,
            SOURCE,
        ));
    };
    ramp.go_to(0.5)?;
    profile("forth, T = 0.5 mu N", ramp.deviation(|x| forth(ramp.share, x))?);
    ramp.go_to(TURN)?;
    let turn = ramp.share;
    profile("forth, T = 0.9 mu N", ramp.deviation(|x| forth(turn, x))?);
    ramp.go_to(0.0)?;
    profile("back to T = 0", ramp.deviation(|x| back(turn, ramp.share, x))?);
    ramp.go_to(-turn)?;
    ramp.work = 0.0;
    let friction_energy = ramp.run.state.outputs.friction_energy;
    ramp.go_to(turn)?;
    ramp.go_to(-turn)?;
    let dissipated = ramp.run.state.outputs.friction_energy - friction_energy;
    let area = loop_area(&parameters(), turn);
    rows.push(Row::relative(
        "work of a cycle between -0.9 and 0.9 mu N",
        "J",
        area,
        ramp.work,
        0.02,
        SOURCE,
    ));
    rows.push(Row::relative(
        "friction energy of that cycle",
        "J",
        area,
        dissipated,
        0.02,
        SOURCE,
    ));
    ramp.go_to(1.0 - 1e-9)?;
    rows.push(Row::absolute(
        "T over mu N where it slides",
        "1",
        1.0,
        ramp.share,
        1e-9,
        "Coulomb's law",
    ));
    Ok(rows)
}
