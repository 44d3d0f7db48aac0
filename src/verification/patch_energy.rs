//! The discrete balances of heat and wear of a patch, to round-off of the sums: as for a line contact ([`super::energy`]), strip by strip.
//!
//! What the strips hold at a column of the window is S = B a_beside + Σ b (a_j − a_beside), B the breadth of the contact, b that of a
//! strip; the rail ahead of the window and behind it is as broad as the contact and holds B a (`transport::strips`). With it
//!
//! d/dt ∫ρc S + |V| ρc (B a) (outflow less inflow) + bottom = ᾱ b Σ Δx (|τ·s| − k ρ c θ |s| p − (θ − θ_w) p/r),
//!
//! each mode weighted at both ends of a cell as the march does. B is that of the end of the step: a contact that grows takes in rail
//! beside it. For wear, d/dt ∫ S + |V| B w (outflow less inflow) = k ∫ |s| p dA.

use super::row::{Row, larger};
use super::set_up;
use crate::contact::patch::fields::PatchFields;
use crate::contact::patch::operators::PatchOperators;
use crate::contact::rim;
use crate::error::Result;
use crate::heat::step::{DecayRate, ModeStep, Transit};
use crate::numerics::dense::MultiplyAdd;
use crate::parameters::{ContactModel, FrictionLaw, Parameters, SlipSource, WheelHeating};
use crate::signals::Inputs;
use crate::simulation::Simulation;
use crate::transport::strips::Side;
use crate::transport::{CellStep, Upwind};

const SOURCE: &str = "identity of the discrete equations";
/// Round-off of the sums.
const TOLERANCE: f64 = 1e-10;

/// Terms of the balances over one step, `W`, and of wear `m³/s`.
#[derive(Debug, Clone, Copy, Default)]
struct Balance {
    stored: f64,
    /// Carried out of the window and of what comes in.
    carried: [f64; 2],
    bottom: f64,
    conduction: f64,
    debris: f64,
    /// ᾱ of the friction power.
    friction: f64,
    /// Heat that flows into the wheel or is stored in the rim and given to the ambient.
    rim: f64,
    /// Friction power, all of it.
    power: f64,
    /// Wear that is stored, and that is carried away less what came in.
    worn: [f64; 2],
    wear_rate: f64,
}

impl Balance {
    fn rail(&self) -> f64 {
        self.stored + self.carried[0] - self.carried[1] + self.bottom + self.debris
    }

    /// Relative defects of the rail's heat, of that of rail, wheel and debris, and of the wear.
    fn defects(&self) -> [f64; 3] {
        [
            (self.rail() + self.conduction) / self.friction - 1.0,
            (self.rail() + self.rim) / self.power - 1.0,
            (self.worn[0] + self.worn[1]) / self.wear_rate - 1.0,
        ]
    }

    /// The terms over the friction heat, those of wear over its rate.
    fn shares(&self) -> [f64; 9] {
        let heat = [
            self.stored,
            self.carried[0],
            self.carried[1],
            self.bottom,
            self.conduction,
            self.debris,
            self.rim,
        ]
        .map(|term| (term / self.friction).abs());
        let [a, b, c, d, e, f, g] = heat;
        let [stored, carried] = self.worn.map(|term| (term / self.wear_rate).abs());
        [a, b, c, d, e, f, g, stored, carried]
    }
}

/// The largest defects of any step of two transients: at speed with a warm rail coming in and a thin rim; slow and backwards over a
/// shallow rail whose bottom the heat reaches.
///
/// # Errors
/// A solver that did not converge.
pub fn rows() -> Result<Vec<Row>> {
    let warm = Parameters {
        contact_model: ContactModel::Patch,
        slip_source: SlipSource::VehicleSpeed,
        friction_law: FrictionLaw::PiecewiseLinear,
        // More than the default, so that debris take a visible share.
        wear_coefficient: 5e-12,
        wheel_heating: WheelHeating::On,
        rim_depth: 2e-3,
        rim_width: 5e-3,
        ..Parameters::default()
    };
    let shallow = Parameters {
        strip_height: 0.05,
        strip_half_length: 0.1,
        contact_thermal_resistance: 1e6,
        wheel_heating: WheelHeating::Off,
        ..warm.clone()
    };
    let mut rows = Vec::new();
    for (name, parameters, speed, duration, incoming, bottom) in [
        (
            "10 m/s, speed and load changing",
            &warm,
            10.0,
            1e-2,
            (340.0, 1e-7),
            false,
        ),
        ("-0.02 m/s, shallow rail", &shallow, -0.02, 5.0, (340.0, 1e-7), true),
    ] {
        let (defects, shares) = largest(parameters, speed, duration, incoming.0, incoming.1)?;
        for (what, defect) in ["heat of the rail", "heat of rail, wheel and debris", "wear"]
            .into_iter()
            .zip(defects)
        {
            rows.push(Row::absolute(
                format!("largest relative defect of the balance of {what}, {name}"),
                "1",
                0.0,
                defect,
                TOLERANCE,
                SOURCE,
            ));
        }
        // A balance that closes says nothing about a term that is 0 all the time.
        let taking_part = shares.into_iter().enumerate().filter(|(term, _)| *term != 3 || bottom);
        rows.push(Row::at_least(
            format!("smallest share of a term at its largest, {name}"),
            "1",
            1e-5,
            taking_part.map(|(_, share)| share).fold(f64::INFINITY, f64::min),
            "each term takes part",
        ));
    }
    Ok(rows)
}

/// The largest defects over 30 steps at speeds and loads that change by less than a fifth, so that no step is divided, and the largest
/// share of each term.
fn largest(
    parameters: &Parameters,
    speed: f64,
    duration: f64,
    incoming_temperature: f64,
    incoming_wear_depth: f64,
) -> Result<([f64; 3], [f64; 9])> {
    let inputs = |step: u32| {
        let wave = (0.7 * f64::from(step)).sin();
        let vehicle_speed = speed * (1.0 + 0.1 * wave);
        Inputs {
            vehicle_speed,
            wheel_speed: 1.05 * vehicle_speed / parameters.wheel_radius,
            lateral_speed: 0.01 * speed,
            spin_rate: 0.5 * speed,
            normal_load: 60e3 * (1.0 + 0.08 * wave),
            incoming_temperature,
            incoming_wear_depth,
            ..Inputs::default()
        }
    };
    let mut run = set_up::simulation(parameters, &inputs(0))?;
    let (mut defects, mut shares) = ([0.0; 3], [0.0; 9]);
    for step in 0..30 {
        let before = run.state.patch_fields()?.clone();
        run.step(&inputs(step), duration)?;
        let balance = balance(&run, &before, duration)?;
        // The balance is one of implicit steps: of a step that was divided it would compare the wrong states, and is NaN.
        let divided = run.state.duration != duration;
        for (worst, own) in defects.iter_mut().zip(balance.defects()) {
            let own = if divided { f64::NAN } else { own.abs() };
            *worst = larger(*worst, own);
        }
        for (largest, own) in shares.iter_mut().zip(balance.shares()) {
            *largest = own.max(*largest);
        }
    }
    Ok((defects, shares))
}

/// Part of the rail: the window, or a side of it.
#[derive(Clone, Copy)]
enum Part {
    Window,
    Outer(Side),
}

impl Part {
    fn march<'r>(self, rail: &'r PatchOperators, speed: f64) -> Upwind<'r> {
        match self {
            Part::Window => rail.strips.window(speed),
            Part::Outer(side) => rail.strips.outer(side, speed),
        }
    }

    /// S or B a of a mode at a column.
    fn heat(self, rail: &PatchOperators, fields: &PatchFields, breadth: f64, column: usize, mode: usize) -> f64 {
        let heat = &fields.heat;
        breadth
            * match self {
                Part::Window => rail
                    .strips
                    .mean(breadth, |strip| heat.amplitude(&rail.strips, strip, column, mode)),
                Part::Outer(side) => heat.outer[side as usize][column * rail.basis.len() + mode],
            }
    }

    /// S or B w at a column.
    fn wear(self, rail: &PatchOperators, fields: &PatchFields, breadth: f64, column: usize) -> f64 {
        let wear = &fields.wear;
        breadth
            * match self {
                Part::Window => rail.strips.mean(breadth, |strip| wear.at(&rail.strips, strip, column)),
                Part::Outer(side) => wear.outer[side as usize][column],
            }
    }
}

fn balance(run: &Simulation, before: &PatchFields, duration: f64) -> Result<Balance> {
    let (rail, parameters) = (run.model.patch_operators()?, run.model.parameters());
    let after = run.state.patch_fields()?;
    let (inputs, outputs) = (&run.state.inputs, &run.state.outputs);
    let speed = inputs.motion(parameters).rolling_speed;
    let capacity = parameters.volumetric_heat_capacity();
    let breadth = after.heat.breadth;
    let mut balance = Balance::default();

    let (basis, kappa, rows) = (&rail.basis, parameters.thermal_diffusivity, rail.depth.len());
    let bottom_cell = rail.depth[rows - 1] - rail.depth[rows - 2];
    let (ahead, behind) = rail.strips.ends(speed);
    for part in [Part::Outer(ahead), Part::Window, Part::Outer(behind)] {
        for column in part.march(rail, speed).columns() {
            let transit = Transit::new(column.spacing, speed.abs());
            for mode in 0..basis.len() {
                let at = |fields, index| part.heat(rail, fields, breadth, index, mode);
                let (upstream, own) = (at(after, column.upstream), at(after, column.index));
                let rate = kappa * basis.eigenvalues[mode];
                let step = ModeStep::at(MultiplyAdd::SEPARATE, DecayRate::new(rate), 1.0 / duration, transit);
                let mean = |share: f64, upstream: f64, own: f64| own + share * (upstream - own);
                let growth = mean(
                    step.storage_weight(),
                    upstream - at(before, column.upstream),
                    own - at(before, column.index),
                );
                let held = column.spacing * growth / duration;
                balance.stored += capacity * basis.integral[mode] * held;
                // Reaction of the bottom: conduction out of the last cell less what its share of the mass takes up.
                let lowest = basis.modes[(rows - 2, mode)];
                let taken_up = held + speed.abs() * (own - upstream);
                let lost = mean(step.source_weight(), upstream, own);
                let conducted = kappa * basis.bottom_flux[mode] * column.spacing * lost;
                balance.bottom += capacity * (conducted - bottom_cell / 6.0 * lowest * taken_up);
            }
            let step = CellStep::new(1.0 / duration, column.spacing, speed.abs());
            let growth = |index| part.wear(rail, after, breadth, index) - part.wear(rail, before, breadth, index);
            balance.worn[0] += column.spacing * step.mean(growth(column.upstream), growth(column.index)) / duration;
        }
    }
    let ends = [
        (Part::Outer(behind), rail.strips.outer(behind, speed).outflow()),
        (Part::Outer(ahead), rail.strips.outer(ahead, speed).inflow()),
    ];
    for (carried, (part, column)) in balance.carried.iter_mut().zip(ends) {
        let content: f64 = (0..basis.len())
            .map(|mode| basis.integral[mode] * part.heat(rail, after, breadth, column, mode))
            .sum();
        *carried = capacity * speed.abs() * content;
    }
    let [left, came] = ends.map(|(part, column)| speed.abs() * part.wear(rail, after, breadth, column));
    balance.worn[1] = left - came;

    let area = rail.grid.cell_area();
    let above_ambient = after.wheel_temperature - inputs.ambient_temperature;
    for node in run.contact_nodes() {
        let slip = node.slip.hypot(node.lateral_slip);
        let worn = parameters.wear_coefficient * slip * node.pressure;
        let power = (node.shear * node.slip + node.lateral_shear * node.lateral_slip).abs();
        balance.friction += parameters.heat_partition * area * power;
        balance.debris += parameters.heat_partition * area * capacity * worn * node.temperature;
        balance.conduction += parameters.heat_partition * area * (node.temperature - above_ambient) * node.pressure
            / parameters.contact_thermal_resistance;
        balance.wear_rate += area * worn;
    }
    balance.power = outputs.friction_power;
    balance.rim = match parameters.wheel_heating {
        WheelHeating::Off => (1.0 - parameters.heat_partition) * balance.power + balance.conduction,
        WheelHeating::On => {
            let rate = (after.wheel_temperature - before.wheel_temperature) / duration;
            rim::heat_capacity(parameters) * rate + rim::convection(parameters) * above_ambient
        }
    };
    Ok(balance)
}
