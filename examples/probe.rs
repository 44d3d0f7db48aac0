use std::time::Instant;
use wheelrail::{parameters::*, signals::*, wheel_rail::*};
fn run(p: &Parameters, i: &Inputs, dt: f64, steps: usize) -> (Model, State) {
    let t = Instant::now();
    let m = Model::new(p.clone()).unwrap();
    let t1 = t.elapsed();
    let mut w = m.workspace();
    let mut s = m.initial_state(&mut w, i).unwrap();
    let t2 = t.elapsed();
    let mut it = 0;
    let t3 = Instant::now();
    for _ in 0..steps {
        m.step(&mut w, &mut s, i, &Inputs::ZERO, dt).unwrap();
        it += s.convergence.iterations;
    }
    println!(
        "build {:?} init {:?} step {:?} iters/step {} moments {}",
        t1,
        t2,
        t3.elapsed() / steps as u32,
        it as f64 / steps as f64,
        m.rail().thermal_map.size().1
    );
    (m, s)
}
fn main() {
    let base = Parameters::default();
    let i = Inputs { ..Default::default() };
    let (_, s) = run(&base, &i, 1e-3, 1000);
    println!("default {:#?}", s.outputs);
    // paper cases
    for (name, law, hot) in [
        ("const", FrictionLaw::Constant, 423.15),
        ("a", FrictionLaw::PiecewiseLinear, 423.15),
        ("b", FrictionLaw::PiecewiseLinear, 398.15),
        ("c", FrictionLaw::PiecewiseLinear, 373.15),
    ] {
        for locked in [false, true] {
            let p = Parameters {
                control: Control::Penetration,
                friction_law: law,
                friction_temperature_hot: hot,
                slip_source: SlipSource::VehicleSpeed,
                ..Default::default()
            };
            let i = Inputs {
                wheel_speed: if locked { 0.0 } else { 10.0 * 1.04 / 0.46 },
                vehicle_speed: 10.0,
                ambient_temperature: 273.15,
                ..Default::default()
            };
            let (m, s) = run(&p, &i, 1e-2, 200);
            let o = s.outputs;
            println!(
                "{name} locked {locked}: T {} mu {} peak {} p {} len {} off {} wear {} iters {:?} N {}",
                o.traction_force,
                o.friction_coefficient,
                o.peak_temperature - 273.15,
                o.peak_pressure,
                o.contact_length,
                o.contact_offset,
                o.wear_depth,
                s.convergence,
                o.traction_force / o.traction_coefficient
            );
            let v: f64 = 10.0;
            let r0 = p.wheel_radius;
            let n = o.traction_force / o.traction_coefficient;
            println!(
                "   power {} balance {}",
                o.friction_power,
                o.traction_force * (i.wheel_speed * r0 - v) + v * n * o.contact_offset / r0
            );
            let _ = m;
        }
    }
    // Hertz
    for n in [12e3, 30e3, 60e3, 120e3] {
        let p = Parameters {
            thermal_expansion: 0.0,
            wear_coefficient: 0.0,
            friction_cold: 0.0,
            friction_law: FrictionLaw::Constant,
            ..Default::default()
        };
        let i = Inputs {
            normal_load: n,
            ..Default::default()
        };
        let (_, s) = run(&p, &i, 1e-2, 2);
        println!(
            "{n}: a {} p {} delta {}",
            s.outputs.contact_length / 2.0 / p.hertz_half_length(n) - 1.0,
            s.outputs.peak_pressure / p.hertz_peak_pressure(n) - 1.0,
            s.outputs.penetration
        );
    }
    // Carter
    for xi in [0.0, 0.0005, 0.001, 0.002, 0.003, 0.004, 0.006] {
        let p = Parameters {
            thermal_expansion: 0.0,
            wear_coefficient: 0.0,
            normal_tangential_coupling: false,
            slip_regularisation: 1e-4,
            friction_law: FrictionLaw::Constant,
            ..Default::default()
        };
        let i = Inputs {
            creepage: xi,
            ..Default::default()
        };
        let (_, s) = run(&p, &i, 1e-2, 100);
        let a = p.hertz_half_length(60e3);
        let k = (1.0 - xi * 0.46 / (0.45 * a)).max(0.0);
        println!(
            "xi {xi}: {} carter {} stick {} {}",
            s.outputs.traction_coefficient / 0.45,
            1.0 - k * k,
            s.outputs.stick_fraction,
            k
        );
    }
    // flash
    let p = Parameters {
        thermal_expansion: 0.0,
        wear_coefficient: 0.0,
        heat_partition: 1.0,
        contact_thermal_resistance: 1e12,
        slip_source: SlipSource::VehicleSpeed,
        friction_law: FrictionLaw::Constant,
        ..Default::default()
    };
    let i = Inputs {
        wheel_speed: 10.1 / 0.46,
        vehicle_speed: 10.0,
        ..Default::default()
    };
    let (_, s) = run(&p, &i, 1e-2, 100);
    println!("flash {}", s.outputs.peak_temperature - 293.15);
    for xi in [0.0, -0.0014, -0.0016, -0.0018] {
        let p = Parameters {
            friction_law: FrictionLaw::Constant,
            ..Default::default()
        };
        let i = Inputs {
            creepage: xi,
            ..Default::default()
        };
        let (_, s) = run(&p, &i, 1e-2, 100);
        println!("xi {xi} T/muN {}", s.outputs.traction_coefficient / 0.45);
    }
}
