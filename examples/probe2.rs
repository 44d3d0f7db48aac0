//! random
use wheelrail::{parameters::*, signals::*, wheel_rail::*};
fn main() {
    let mut seed = 12345u64;
    let mut rnd = move || {
        seed ^= seed << 13;
        seed ^= seed >> 7;
        seed ^= seed << 17;
        (seed >> 11) as f64 / (1u64 << 53) as f64
    };
    let p = Parameters {
        slip_source: SlipSource::VehicleSpeed,
        contact_nodes: 61,
        ..Default::default()
    };
    let m = Model::new(p.clone()).unwrap();
    let mut fails = std::collections::BTreeMap::<String, (usize, String)>::new();
    let mut total = 0;
    for run in 0..400 {
        let mut w = m.workspace();
        let mut pick = || {
            let v: f64 = match (rnd() * 5.0) as i32 {
                0 => 0.0,
                1 => rnd() * 2.0 - 1.0,
                2 => 80.0 * (rnd() - 0.5),
                _ => 30.0 * rnd(),
            };
            let slip: f64 = match (rnd() * 5.0) as i32 {
                0 => -v,
                1 => 0.0,
                2 => v * 0.05 * (rnd() - 0.5),
                3 => 10.0 * (rnd() - 0.5),
                _ => 0.5 * (rnd() - 0.5),
            };
            Inputs {
                vehicle_speed: v,
                wheel_speed: (v + slip) / 0.46,
                normal_load: if rnd() < 0.1 { 0.0 } else { 90e3 * rnd() },
                friction_scale: if rnd() < 0.5 { 1.0 } else { 2.0 * rnd() },
                ..Default::default()
            }
        };
        let first = pick();
        let mut s = match m.initial_state(&mut w, &first) {
            Ok(s) => s,
            Err(e) => {
                println!("INIT {e} {first:?}");
                continue;
            }
        };
        for _ in 0..12 {
            let i = pick();
            let dt = [1e-4, 1e-3, 1e-3, 1e-2, 1e-1][(rnd2(&i) * 5.0) as usize % 5];
            total += 1;
            if let Err(e) = m.step(&mut w, &mut s, &i, &Inputs::ZERO, dt) {
                let k: String = format!("{:?}", e.error).chars().take(18).collect();
                let d = format!("run {run} dt {dt} committed {} {} {i:?}", e.committed, e.error);
                fails.entry(k).and_modify(|x| x.0 += 1).or_insert((1, d.clone()));
                if !d.contains("window") {
                    println!("{d}");
                }
                break;
            }
        }
    }
    println!("{total} steps {fails:#?}");
}
fn rnd2(i: &Inputs) -> f64 {
    (i.normal_load * 0.37 + i.wheel_speed.abs() * 11.0).fract()
}
