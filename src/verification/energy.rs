//! The discrete heat balance of the rail: what friction puts into it and what comes in with it is stored, carried out of the
//! window, conducted through the bottom, given to the wheel or carried off by debris,
//! d/dt ∫ρc θ + |V| ∫ρc θ dz (outflow less inflow) + bottom = ᾱ b Σ Δx (|τ s| − k ρ c θ |s| p − (θ − θ_w) p/r),
//! to round-off of the sums, because the P1 test functions of a column add up to 1 and the march balances every mode in every
//! cell. What is stored is the sum of these balances over the step, each mode weighted at both ends of a cell as the march does.
//!
//! And that of rail, wheel and debris together: with C dT_w/dt + h A θ_w in place of the conduction, the sum is all of the
//! friction power, not ᾱ of it.

use super::row::{Row, larger};
use super::set_up;
use crate::contact::line::fields::LineFields;
use crate::contact::rim;
use crate::error::Result;
use crate::heat::step::{DecayRate, ModeStep, Transit};
use crate::numerics::dense::MultiplyAdd;
use crate::parameters::{FrictionLaw, Parameters, SlipSource, Wheel, WheelHeating};
use crate::signals::Inputs;
use crate::simulation::Simulation;
use crate::transport::Upwind;

const SOURCE: &str = "identity of the discrete equations";
/// Round-off of the sums: after the operator split, friction is evaluated anew at the final temperature, so that the split's own
/// tolerance is in the equilibrium and not in the heat.
const TOLERANCE: f64 = 1e-10;

/// Terms of the balance over one step, `W`.
#[derive(Debug, Clone, Copy, Default)]
struct Balance {
    stored: f64,
    carried_out: f64,
    carried_in: f64,
    bottom: f64,
    conduction: f64,
    debris: f64,
    /// ᾱ of the friction power.
    friction: f64,
    /// Stored in the rim and given to the ambient; of a wheel that stays cold, what flows into it.
    rim: f64,
    /// Friction power, all of it.
    power: f64,
}

impl Balance {
    /// Defect of the rail's balance, over the friction heat.
    fn defect(&self) -> f64 {
        let sum = self.rail() + self.conduction;
        ((sum - self.friction) / self.friction).abs()
    }

    /// Defect of the balance of rail, wheel and debris, over the friction power.
    fn total_defect(&self) -> f64 {
        let sum = self.rail() + self.rim;
        ((sum - self.power) / self.power).abs()
    }

    fn rail(&self) -> f64 {
        self.stored + self.carried_out - self.carried_in + self.bottom + self.debris
    }

    /// Larger share of the friction heat, term by term: that so far, or that of another step.
    fn largest(self, other: Balance) -> Balance {
        let share = |term: f64| (term / other.friction).abs();
        Balance {
            stored: self.stored.max(share(other.stored)),
            carried_out: self.carried_out.max(share(other.carried_out)),
            carried_in: self.carried_in.max(share(other.carried_in)),
            bottom: self.bottom.max(share(other.bottom)),
            conduction: self.conduction.max(share(other.conduction)),
            debris: self.debris.max(share(other.debris)),
            friction: 1.0,
            rim: self.rim.max(share(other.rim)),
            power: 1.0,
        }
    }
}

/// Inputs of one step; their changes stay below a fifth, so that the step is not divided.
#[derive(Clone, Copy)]
struct DrivenStep {
    /// Speed, `m/s`.
    speed: f64,
    /// Circumferential speed of the wheel, `m/s`.
    circumferential: f64,
    /// Normal load, `N`.
    load: f64,
}

/// The largest defect of any step of a transient at speed, and of one where the strip is shallow, slow, and the heat
/// reaches its bottom.
///
/// # Errors
/// A solver that did not converge.
pub fn rows() -> Result<Vec<Row>> {
    let base = Parameters {
        wheel: Wheel::Rigid,
        slip_source: SlipSource::VehicleSpeed,
        friction_law: FrictionLaw::PiecewiseLinear,
        // More than the default, so that debris take a visible share.
        wear_coefficient: 5e-12,
        ..Parameters::default()
    };
    let fast: Vec<DrivenStep> = (0..40)
        .map(|i| {
            let wave = (0.7 * f64::from(i)).sin();
            DrivenStep {
                speed: 10.0 + wave,
                circumferential: (10.0 + wave) * 1.05,
                load: 60e3 * (1.0 + 0.08 * wave),
            }
        })
        .collect();
    let shallow = Parameters {
        strip_height: 0.05,
        strip_half_length: 0.1,
        contact_thermal_resistance: 1e6,
        ..base.clone()
    };
    let unworn = Parameters {
        wear_coefficient: 0.0,
        ..shallow.clone()
    };
    let slow: Vec<DrivenStep> = (0..12)
        .map(|i| {
            let wave = (0.7 * f64::from(i)).sin();
            let speed = -0.02 * (1.0 + 0.08 * wave);
            DrivenStep {
                speed,
                circumferential: 1.05 * speed,
                load: 30e3,
            }
        })
        .collect();
    let warm = Parameters {
        wheel: Wheel::Elastic,
        wheel_heating: WheelHeating::On,
        heat_partition: 0.6,
        contact_thermal_resistance: 10.0,
        // A thin rim: its temperature moves with every step.
        rim_depth: 1e-3,
        rim_width: 1e-3,
        ..base.clone()
    };
    let on_the_spot: Vec<DrivenStep> = vec![
        DrivenStep {
            speed: 0.0,
            circumferential: 1e-3,
            load: 30e3,
        };
        12
    ];

    let mut rows = Vec::new();
    for (name, parameters, steps, duration) in [
        ("10 m/s, speed and load changing", &base, &fast, 1e-2),
        ("10 m/s, thin warm rim, hot rail coming in", &warm, &fast, 1e-2),
        ("-0.02 m/s, shallow strip", &shallow, &slow, 5.0),
        (
            "sliding on the spot, shallow strip, no wear",
            &unworn,
            &on_the_spot,
            5.0,
        ),
    ] {
        rows.extend(case_rows(name, parameters, steps, duration)?);
    }
    Ok(rows)
}

/// Rows of one case: the defects of both balances, and the smallest share of a term.
fn case_rows(name: &str, parameters: &Parameters, steps: &[DrivenStep], duration: f64) -> Result<Vec<Row>> {
    let warm = parameters.wheel_heating == WheelHeating::On;
    let incoming = if warm {
        340.0
    } else {
        Inputs::default().incoming_temperature
    };
    let (defect, total_defect, shares) = largest_defect(parameters, steps, duration, incoming)?;
    // A balance that closes says nothing about a term that is 0 all the time.
    let shallow = parameters.strip_height < 0.1;
    let smallest = [
        (shares.stored, true),
        (shares.carried_out, steps[0].speed != 0.0),
        (shares.carried_in, warm),
        (shares.rim, true),
        (shares.bottom, shallow),
        (shares.conduction, true),
        (shares.debris, parameters.wear_coefficient > 0.0),
    ]
    .iter()
    .filter(|(_, expected)| *expected)
    .fold(f64::INFINITY, |m, (share, _)| share.min(m));
    Ok(vec![
        Row::absolute(
            format!("heat balance defect of rail, wheel and debris over friction power, {name}"),
            "1",
            0.0,
            total_defect,
            TOLERANCE,
            SOURCE,
        ),
        Row::absolute(
            format!("heat balance defect over friction heat, {name}"),
            "1",
            0.0,
            defect,
            TOLERANCE,
            SOURCE,
        ),
        Row::at_least(
            format!("smallest share of a term at its largest, {name}"),
            "1",
            1e-5,
            smallest,
            "each term takes part",
        ),
    ])
}

/// The largest defect over the steps, of the rail and of rail, wheel and debris, and the largest share of each term.
fn largest_defect(
    parameters: &Parameters,
    steps: &[DrivenStep],
    duration: f64,
    incoming_temperature: f64,
) -> Result<(f64, f64, Balance)> {
    let inputs = |step: &DrivenStep| Inputs {
        wheel_speed: step.circumferential / parameters.wheel_radius,
        vehicle_speed: step.speed,
        normal_load: step.load,
        incoming_temperature,
        ..Inputs::default()
    };
    let mut run = set_up::simulation(parameters, &inputs(&steps[0]))?;
    // The balance is one of implicit steps: of a step that was divided it would compare the wrong states, and is NaN.
    let (mut defect, mut total_defect, mut shares) = (0.0_f64, 0.0_f64, Balance::default());
    for step in steps {
        let before = run.state.fields()?.clone();
        let inputs = inputs(step);
        run.step(&inputs, duration)?;
        let balance = balance(&run, &before, step.speed, duration)?;
        let divided = run.state.duration != duration;
        let worse = |worst: f64, own: f64| larger(worst, if divided { f64::NAN } else { own });
        defect = worse(defect, balance.defect());
        total_defect = worse(total_defect, balance.total_defect());
        shares = shares.largest(balance);
    }
    Ok((defect, total_defect, shares))
}

fn balance(run: &Simulation, before: &LineFields, speed: f64, duration: f64) -> Result<Balance> {
    let (rail, parameters) = (run.model.line_operators()?, run.model.parameters());
    let after = run.state.fields()?;
    let ambient = run.state.inputs.ambient_temperature;
    let capacity = parameters.volumetric_heat_capacity() * parameters.contact_width;
    let mut balance = Balance::default();

    let (transport, basis) = (Upwind::new(&rail.mesh.x, speed), &rail.heat.basis);
    let (speed, kappa) = (transport.speed(), parameters.thermal_diffusivity);
    let bottom_cell = rail.mesh.depth[rail.mesh.rows() - 1] - rail.mesh.depth[rail.mesh.rows() - 2];
    for column in transport.columns() {
        let amplitudes = |fields: &LineFields, index| fields.column(rail, index).to_vec();
        let [upstream, own] = [column.upstream, column.index].map(|index| amplitudes(after, index));
        let [old_upstream, old_own] = [column.upstream, column.index].map(|index| amplitudes(before, index));
        for mode in 0..basis.len() {
            let rate = kappa * basis.eigenvalues[mode];
            let transit = Transit::new(column.spacing, speed);
            let step = ModeStep::at(MultiplyAdd::SEPARATE, DecayRate::new(rate), 1.0 / duration, transit);
            let mean = |share: f64, upstream: f64, own: f64| own + share * (upstream - own);
            let growth = mean(
                step.storage_weight(),
                upstream[mode] - old_upstream[mode],
                own[mode] - old_own[mode],
            );
            let held = column.spacing * growth / duration;
            balance.stored += capacity * basis.integral[mode] * held;
            // Reaction of the bottom: conduction out of the last cell less what its share of the mass takes up.
            let lowest = basis.modes[(rail.mesh.rows() - 2, mode)];
            let taken_up = held + speed * (own[mode] - upstream[mode]);
            let lost = mean(step.source_weight(), upstream[mode], own[mode]);
            let conducted = kappa * basis.bottom_flux[mode] * column.spacing * lost;
            balance.bottom += capacity * (conducted - bottom_cell / 6.0 * lowest * taken_up);
        }
    }
    let outflow = rail
        .heat
        .basis
        .content(after.column(rail, transport.outflow()).iter().copied());
    balance.carried_out = capacity * transport.speed() * outflow;
    let inflow = rail
        .heat
        .basis
        .content(after.column(rail, transport.inflow()).iter().copied());
    balance.carried_in = capacity * transport.speed() * inflow;

    let area = parameters.heat_partition * parameters.contact_width * rail.mesh.contact_spacing();
    for node in run.contact_nodes() {
        let worn = parameters.wear_coefficient * node.slip.abs() * node.pressure;
        balance.friction += area * (node.shear * node.slip).abs();
        balance.debris += area * parameters.volumetric_heat_capacity() * worn * node.temperature;
        let above_wheel = node.temperature - (after.wheel_temperature - ambient);
        balance.conduction += area * above_wheel * node.pressure / parameters.contact_thermal_resistance;
    }
    balance.power = run.state.outputs.friction_power;
    balance.rim = match parameters.wheel_heating {
        WheelHeating::Off => (1.0 - parameters.heat_partition) * balance.power + balance.conduction,
        WheelHeating::On => {
            let rate = (after.wheel_temperature - before.wheel_temperature) / duration;
            rim::heat_capacity(parameters) * rate + rim::convection(parameters) * (after.wheel_temperature - ambient)
        }
    };
    Ok(balance)
}
