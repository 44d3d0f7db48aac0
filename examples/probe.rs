use std::time::Instant;
use wheelrail::{parameters::*, signals::*, wheel_rail::*};
fn main() {
    for n in [61, 155] {
        let p = Parameters {
            slip_source: SlipSource::VehicleSpeed,
            contact_nodes: n,
            ..Default::default()
        };
        let t = Instant::now();
        let m = Model::new(p.clone()).unwrap();
        let mut w = m.workspace();
        let at = |t: f64| {
            let v = 20.0 - 0.9 * t;
            let slide = 0.02 + 0.15 * (-((t - 8.0) / 0.7f64).powi(2)).exp() + 0.004 * (3.0 * t).sin();
            Inputs {
                vehicle_speed: v,
                wheel_speed: v * (1.0 - slide) / 0.46,
                normal_load: 60e3 + 8e3 * (9.0 * t).sin() + 3e3 * (31.0 * t).sin(),
                ..Default::default()
            }
        };
        let mut s = m.initial_state(&mut w, &at(0.0)).unwrap();
        println!("init {:?}", t.elapsed());
        let (mut times, mut its) = (vec![], vec![]);
        for k in 0..20000 {
            let i = at(k as f64 * 1e-3);
            let t = Instant::now();
            m.step(&mut w, &mut s, &i, &Inputs::ZERO, 1e-3).unwrap();
            times.push(t.elapsed().as_secs_f64() * 1e6);
            its.push(s.convergence.iterations as f64);
        }
        times.sort_by(f64::total_cmp);
        println!(
            "n {n} contact {} median {} p99 {} p99.9 {} max {} iters {}",
            s.fields.pressure.iter().filter(|p| **p > 0.0).count(),
            times[10000],
            times[19800],
            times[19980],
            times[19999],
            its.iter().sum::<f64>() / 20000.0
        );
    }
}
