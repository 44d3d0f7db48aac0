use crate::contact::ContactState;
use crate::contact::on_wheelset::OnWheelset;
use crate::parameters::{ContactModel, Control, FrictionLaw, Parameters, Side, SlipSource};
use crate::signals::Inputs;
use crate::wheel_rail::Model;
use std::time::Instant;

fn parameters(right: bool, height: bool) -> Parameters {
    let mut parameters = Parameters {
        contact_model: ContactModel::Profiles,
        slip_source: SlipSource::VehicleSpeed,
        shear_modulus: 82e9,
        lame_lambda: 2.0 * 82e9 * 0.28 / 0.44,
        wheel_shear_modulus: 82e9,
        wheel_lame_lambda: 2.0 * 82e9 * 0.28 / 0.44,
        friction_law: FrictionLaw::Constant,
        friction_cold: 0.3,
        wear_coefficient: 0.0,
        thermal_expansion: 0.0,
        ..Parameters::default()
    };
    parameters.rail_profile = "UIC60".into();
    parameters.side = if right { Side::Right } else { Side::Left };
    parameters.control = if height { Control::Height } else { Control::Load };
    parameters
}

fn on_wheelset(model: &Model, state: &crate::State, inputs: &Inputs) -> OnWheelset {
    model.integrals_for_tests(state, inputs).on_wheelset
}

#[test]
fn zz_manchester() {
    let path = std::env::var("MANCHESTER").unwrap();
    let text = std::fs::read_to_string(path).unwrap();
    let mut lines = text.lines().filter(|line| !line.starts_with('#'));
    let head: Vec<&str> = lines.next().unwrap().split(',').collect();
    let column = |name: &str| head.iter().position(|h| *h == name).unwrap();
    let models = [false, true].map(|right| Model::new(parameters(right, false)).unwrap());
    for line in lines {
        let cells: Vec<&str> = line.split(',').collect();
        let value = |name: &str| cells[column(name)].parse::<f64>().unwrap();
        let right = cells[0] == "right";
        let model = &models[usize::from(right)];
        let pitch = value("pitch_rate");
        let inputs = Inputs {
            normal_load: 10e3,
            wheel_speed: -pitch,
            vehicle_speed: if pitch < -30.0 { 20.0 } else { 2.0 },
            lateral_displacement: -1e-3 * value("y_ws"),
            roll_angle: value("roll"),
            yaw_angle: -value("yaw"),
            ..Inputs::default()
        };
        let mut workspace = model.workspace();
        let start = Instant::now();
        let state = match model.initial_state(&mut workspace, &inputs) {
            Ok(state) => state,
            Err(error) => {
                println!("{line:.20} {error}");
                continue;
            }
        };
        let time = start.elapsed();
        let all = on_wheelset(model, &state, &inputs);
        let normal: f64 = all.contacts.iter().map(|c| c.normal_force).sum();
        let c = &all.contacts;
        let fs: f64 = c.iter().map(|c| c.friction[1]).sum();
        let fx: f64 = c.iter().map(|c| c.friction[0]).sum();
        let peak = c.iter().map(|c| c.peak_pressure).fold(0.0, f64::max) * 1e-6;
        let area: f64 = c.iter().map(|c| c.area).sum::<f64>() * 1e6;
        let bound = 0.3 * value("FN");
        let ContactState::Surface(s) = &state.contact else {
            panic!()
        };
        println!(
            "{:5} {:4.1} n{} FN {:7.0} {:+.4} FX {:+.4} FS {:+.4} p {:6.1} {:+.4} area {:6.2} {:+.4} size {:.2}x{:.2} dz {:+.4} places {:?} {:?}",
            cells[0],
            value("y_ws"),
            all.count,
            normal,
            normal / value("FN") - 1.0,
            (-fx - value("FX")) / bound,
            (fs - value("FS")) / bound,
            peak,
            peak / value("pmax") - 1.0,
            area,
            area / value("area") - 1.0,
            c[0].size[0] * 1e3,
            c[0].size[1] * 1e3,
            -(1e3 * (s.fields.touch - s.fields.approach[0]) - 460.0) - value("z_ws"),
            s.fields.used().map(|(_, p)| (p.length, p.breadth)).collect::<Vec<_>>(),
            time
        );
    }
}

#[test]
fn zz_overlaps() {
    use super::geometry::Pose;
    use super::search::Search;
    let model = Model::new(parameters(true, false)).unwrap();
    let crate::contact::Operators::Surface(operators) = model.operators_for_tests() else {
        panic!()
    };
    for y in [5.0, 5.4, 5.5, 5.59, 5.605, 5.63, 6.0, 6.5] {
        let inputs = Inputs {
            normal_load: 60e3,
            wheel_speed: 20.0 / 0.46,
            vehicle_speed: 20.0,
            lateral_displacement: -1e-3 * y,
            roll_angle: -0.4e-3 * y,
            yaw_angle: -3e-3 * y,
            ..Inputs::default()
        };
        let mut workspace = model.workspace();
        let state = model.initial_state(&mut workspace, &inputs).unwrap();
        let ContactState::Surface(s) = &state.contact else {
            panic!()
        };
        let pose = Pose::new(operators, &inputs, 0.46);
        let mut search = Search::new(operators);
        let touch = search.touch(operators, &pose.position, 0.46);
        println!(
            "y {y} touch {:.6} {:.6} approach {:.1} {:?}",
            touch,
            s.fields.touch,
            1e6 * s.fields.approach[0],
            s.fields
                .used()
                .map(|(w, p)| (w, p.length, p.breadth, p.strip))
                .collect::<Vec<_>>()
        );
        for o in search.overlaps(s.fields.approach[0]) {
            println!(
                "   across {:.2?} along {:.1?} depth {:.1} rise {:.3} curv {:.1?}",
                o.region.across.map(|s| 1e3 * s),
                o.region.along.map(|s| 1e3 * s),
                1e6 * o.depth,
                o.rise,
                o.curvatures
            );
        }
        let place = s.fields.used().next().unwrap();
        let patch = operators.of(&place.1);
        let p = &s.fields.windows[place.0].pressure;
        println!(
            "   {:?}",
            (0..21)
                .map(
                    |strip| (1e-6 * patch.scales.pressure * crate::numerics::dense::largest(&p[patch.grid.row(strip)]))
                        as i64
                )
                .collect::<Vec<_>>()
        );
    }
}

#[test]
fn zz_sweep() {
    for (right, load) in [(true, 60e3), (true, 10e3), (true, 95e3)] {
        let mut parameters = parameters(right, false);
        parameters.wear_coefficient = 0.5e-12;
        parameters.thermal_expansion = 12e-6;
        parameters.friction_law = FrictionLaw::PiecewiseLinear;
        let model = Model::new(parameters).unwrap();
        let mut workspace = model.workspace();
        let mut inputs = Inputs {
            normal_load: load,
            wheel_speed: 20.0 / 0.46,
            vehicle_speed: 20.0,
            lateral_displacement: 0.0,
            ..Inputs::default()
        };
        let mut state = model.initial_state(&mut workspace, &inputs).unwrap();
        let mut times = Vec::new();
        let (mut moved, mut staggered) = (0, 0);
        let mut last: Option<[[f64; 3]; 2]> = None;
        let mut jumps = Vec::new();
        for step in 0..1600 {
            let rates = Inputs {
                lateral_displacement: -5e-3,
                yaw_angle: -1.5e-2,
                lateral_speed: 0.0,
                roll_angle: -0.2e-2,
                ..Inputs::ZERO
            };
            let before = state.clone();
            let start = Instant::now();
            let result = model.step(&mut workspace, &mut state, &inputs, &rates, 1e-3);
            times.push(start.elapsed().as_secs_f64() * 1e6);
            if let Err(error) = result {
                println!("step {step} {error}");
                break;
            }
            inputs = inputs.advanced(&rates, 1e-3);
            let (ContactState::Surface(a), ContactState::Surface(b)) = (&before.contact, &state.contact) else {
                panic!()
            };
            moved += usize::from(a.fields.places != b.fields.places);
            staggered += usize::from(state.convergence.staggered);
            let all = on_wheelset(&model, &state, &inputs);
            if let Some([before, twice]) = last {
                let jump = (0..3)
                    .map(|k| (all.force[k] - 2.0 * before[k] + twice[k]).abs())
                    .fold(0.0, f64::max)
                    / load;
                jumps.push((jump, step, a.fields.places != b.fields.places));
                last = Some([all.force, before]);
            } else {
                last = Some([all.force, all.force]);
            }
            if step % 100 == 0 || (1095..1120).contains(&step) || staggered > 0 && state.convergence.staggered {
                println!(
                    "{step} y {:.2} n {} F {:.0?} T {:.0} its {} {:?} {:?}",
                    -1e3 * inputs.lateral_displacement,
                    all.count,
                    all.force,
                    state.outputs.peak_temperature,
                    state.convergence.iterations,
                    b.fields
                        .used()
                        .map(|(w, p)| (w, p.length, p.breadth, p.strip))
                        .collect::<Vec<_>>(),
                    all.contacts[..all.count]
                        .iter()
                        .map(|c| (c.normal_force as i64, c.peak_pressure as i64 / 1000000))
                        .collect::<Vec<_>>()
                );
            }
        }
        times.sort_by(f64::total_cmp);
        jumps.sort_by(|a, b| b.0.total_cmp(&a.0));
        let n = times.len();
        println!(
            "load {load} moved {moved} staggered {staggered} median {:.0} 99 {:.0} max {:.0} us {:?}",
            times[n / 2],
            times[n * 99 / 100],
            times[n - 1],
            workspace.iterations()
        );
        println!("jumps {:?}", &jumps[..12]);
    }
}

/// Derivatives of the outputs with respect to each input against central differences of whole steps, with one contact and with two.
#[test]
fn zz_derivatives() {
    use crate::signals::{INPUTS, OUTPUTS};
    for (y, load, height) in [(1.0, 60e3, false), (5.0, 20e3, false), (2.0, 60e3, true)] {
        let mut parameters = parameters(true, height);
        parameters.wear_coefficient = 0.5e-12;
        parameters.thermal_expansion = 12e-6;
        parameters.friction_law = FrictionLaw::PiecewiseLinear;
        let model = Model::with_settings(parameters, tight()).unwrap();
        let mut workspace = model.workspace();
        let mut inputs = Inputs {
            normal_load: load,
            wheel_speed: 20.1 / 0.46,
            vehicle_speed: 20.0,
            lateral_displacement: -1e-3 * y,
            yaw_angle: 1e-3,
            ..Inputs::default()
        };
        if height {
            inputs.vertical_displacement = -0.15e-3;
        }
        let mut start = match model.initial_state(&mut workspace, &inputs) {
            Ok(s) => s,
            Err(e) => {
                println!("{e}");
                continue;
            }
        };
        for _ in 0..5 {
            model
                .step(&mut workspace, &mut start, &inputs, &Inputs::ZERO, 1e-3)
                .unwrap();
        }
        let run = |inputs: &Inputs| {
            let mut state = start.clone();
            model
                .step(&mut model.workspace(), &mut state, inputs, &Inputs::ZERO, 1e-3)
                .unwrap();
            state
        };
        let state = run(&inputs);
        let all = on_wheelset(&model, &state, &inputs);
        println!("y {y} n {} force {:.1?}", all.count, all.force);
        let derivatives = match model.output_sensitivities(&mut workspace, &state, 0..INPUTS.len()) {
            Ok(d) => d,
            Err(e) => {
                println!("{e}");
                continue;
            }
        };
        for (row, signal) in INPUTS.iter().enumerate() {
            if signal.name.starts_with("incoming")
                || (signal.get)(&inputs) == 0.0
                    && ["lateral_creepage", "spin_creepage", "creepage", "spin_rate"].contains(&signal.name)
            {
                continue;
            }
            let step = 2e-5 * signal.nominal;
            let mut ahead = inputs;
            let mut behind = inputs;
            (signal.set)(&mut ahead, (signal.get)(&inputs) + step);
            (signal.set)(&mut behind, (signal.get)(&inputs) - step);
            let (a, b) = (run(&ahead), run(&behind));
            for name in [
                "traction_force",
                "peak_pressure",
                "peak_temperature",
                "friction_power",
                "contact_area",
                "friction_torque",
            ] {
                let output = OUTPUTS.iter().find(|o| o.name == name).unwrap();
                let difference = ((output.get)(&a.outputs) - (output.get)(&b.outputs)) / (2.0 * step);
                let exact = (output.get)(&derivatives[row]);
                let scale = output.nominal / signal.nominal;
                if (exact - difference).abs() > 1e-3 * (difference.abs() + 0.01 * scale) {
                    println!("   {} by {}: {exact:.6e} {difference:.6e}", name, signal.name);
                }
            }
        }
    }
}

#[test]
fn zz_two() {
    for (y0, load) in [(5.44, 10e3)] {
        let mut parameters = parameters(true, false);
        parameters.wear_coefficient = 0.5e-12;
        parameters.thermal_expansion = 12e-6;
        parameters.friction_law = FrictionLaw::PiecewiseLinear;
        let model = Model::new(parameters).unwrap();
        let mut workspace = model.workspace();
        let mut inputs = Inputs {
            normal_load: load,
            wheel_speed: 20.0 / 0.46,
            vehicle_speed: 20.0,
            lateral_displacement: -1e-3 * y0,
            yaw_angle: -3e-3 * y0,
            roll_angle: -0.4e-3 * y0,
            ..Inputs::default()
        };
        let rates = Inputs {
            lateral_displacement: -5e-3,
            yaw_angle: -1.5e-2,
            roll_angle: -0.2e-2,
            ..Inputs::ZERO
        };
        let mut state = model.initial_state(&mut workspace, &inputs).unwrap();
        for step in 0..14 {
            let result = model.step(&mut workspace, &mut state, &inputs, &rates, 1e-3);
            inputs = inputs.advanced(&rates, 1e-3);
            let all = on_wheelset(&model, &state, &inputs);
            println!(
                "{step} {:?} y {:.3} n {} F {:.0?} its {} staggered {} res {:.1e}",
                result.is_ok(),
                -1e3 * inputs.lateral_displacement,
                all.count,
                all.force,
                state.convergence.iterations,
                state.convergence.staggered,
                state.convergence.residual
            );
        }
    }
}

fn tight() -> crate::Settings {
    let mut settings = crate::Settings::strict();
    settings.step.retries = 0;
    settings.patch.split_tolerance = 1e-11;
    settings.patch.shear_tolerance = 1e-9;
    settings.patch.least_tolerance = 1e-11;
    settings.patch.sensitivity_tolerance = 1e-9;
    settings.patch.first_mechanics_tolerance = 1e-10;
    settings
}

#[test]
fn zz_build() {
    use crate::contact::surface::operators::SurfaceOperators;
    for _ in 0..4 {
        let start = Instant::now();
        let operators = SurfaceOperators::build(&parameters(true, false)).unwrap();
        println!("build {:?} {}", start.elapsed(), operators.shapes.len());
        let start = Instant::now();
        let basis = crate::heat::basis::DepthBasis::new(&operators.shapes[0].depth).unwrap();
        println!("basis {:?} {}", start.elapsed(), basis.len());
        let start = Instant::now();
        let solvers = super::solvers::SurfaceSolvers::new(&operators, &crate::Settings::default());
        println!("solvers {:?} {}", start.elapsed(), solvers.windows.len());
    }
}

#[test]
fn zz_jumps() {
    for right in [true, false] {
        for load in [10e3, 60e3, 100e3] {
            let mut p = parameters(right, false);
            p.largest_load = 150e3;
            let model = Model::new(p).unwrap();
            let mut workspace = model.workspace();
            let mut at = |y: f64| {
                let inputs = Inputs {
                    normal_load: load,
                    wheel_speed: 20.0 / 0.46,
                    vehicle_speed: 20.0,
                    lateral_displacement: -1e-3 * y,
                    yaw_angle: -3e-3 * y,
                    roll_angle: -0.4e-3 * y,
                    ..Inputs::default()
                };
                let state = match model.initial_state(&mut workspace, &inputs) {
                    Ok(state) => state,
                    Err(error) => {
                        println!("{y} {error}");
                        return ([f64::NAN; 3], vec![], 0.0);
                    }
                };
                let o = &state.outputs;
                let ContactState::Surface(s) = &state.contact else {
                    panic!()
                };
                let p: Vec<_> = s
                    .fields
                    .used()
                    .map(|(_, p)| (p.length, p.breadth, p.strip, p.cell))
                    .collect();
                ([o.force_x / load, o.force_y / load, o.force_z / load], p, o.contacts)
            };
            let n = 400;
            let rows: Vec<_> = (0..=n).map(|i| at(4.0 + 0.01 * i as f64)).collect();
            let d = |i: usize, k: usize| rows[i + 1].0[k] - rows[i].0[k];
            let mut found = Vec::new();
            for i in 2..n - 2 {
                let beyond = (0..3)
                    .map(|k| {
                        let (a, b) = (d(i - 1, k), d(i + 1, k));
                        let (low, high) = (a.min(b), a.max(b));
                        (d(i, k) - high).max(low - d(i, k)).max(0.0)
                    })
                    .fold(0.0, f64::max);
                if beyond > 5e-4 {
                    // What is left of it when the interval is divided.
                    let (mut low, mut high) = (4.0 + 0.01 * i as f64, 4.01 + 0.01 * i as f64);
                    let (mut a, mut b) = (rows[i].clone(), rows[i + 1].clone());
                    for _ in 0..7 {
                        let middle = 0.5 * (low + high);
                        let m = at(middle);
                        let size = |a: &[f64; 3], b: &[f64; 3]| (0..3).map(|k| (a[k] - b[k]).abs()).fold(0.0, f64::max);
                        if size(&a.0, &m.0) > size(&m.0, &b.0) {
                            (high, b) = (middle, m);
                        } else {
                            (low, a) = (middle, m);
                        }
                    }
                    let left = (0..3).map(|k| (a.0[k] - b.0[k]).abs()).fold(0.0, f64::max);
                    found.push((beyond, left, low, a.1 == b.1, a.1, b.1, a.2, b.2));
                }
            }
            found.sort_by(|a, b| b.1.total_cmp(&a.1));
            println!("right {right} load {load} number {}", found.len());
            for f in found.iter().take(8) {
                println!("   {f:.5?}");
            }
        }
    }
}

#[test]
fn zz_rough() {
    let rows: Vec<Inputs> = include_str!("../../../benches/rough_track.csv")
        .lines()
        .skip(1)
        .map(|line| {
            let c: Vec<f64> = line.split(',').map(|c| c.parse().unwrap()).collect();
            Inputs {
                wheel_speed: c[1],
                vehicle_speed: c[2],
                normal_load: c[3],
                lateral_speed: c[4],
                spin_rate: c[5],
                ..Inputs::default()
            }
        })
        .collect();
    let count = 1000;
    for case in 0..3 {
        let p = match case {
            0 => Parameters {
                contact_model: ContactModel::Patch,
                slip_source: SlipSource::VehicleSpeed,
                ..Parameters::default()
            },
            _ => Parameters {
                contact_model: ContactModel::Profiles,
                slip_source: SlipSource::VehicleSpeed,
                side: crate::parameters::Side::Right,
                ..Parameters::default()
            },
        };
        let y = if case == 2 { 5.6e-3 } else { 0.0 };
        let inputs = |k: usize| {
            let row = rows[k];
            if case == 0 {
                row
            } else {
                Inputs {
                    spin_rate: 0.0,
                    yaw_rate: row.spin_rate - 0.1 * row.vehicle_speed,
                    lateral_displacement: -y + 0.1e-3 * (0.05 * k as f64).sin(),
                    ..row
                }
            }
        };
        let model = Model::new(p).unwrap();
        let mut workspace = model.workspace();
        let mut state = model.initial_state(&mut workspace, &inputs(0)).unwrap();
        let mut times = Vec::new();
        let mut contacts = 0.0;
        let mut sweeps = 0;
        for k in 1..count {
            let start = Instant::now();
            let rates = Inputs::ZERO;
            model
                .step(&mut workspace, &mut state, &inputs(k), &rates, 1e-3)
                .unwrap();
            times.push(start.elapsed().as_secs_f64() * 1e6);
            contacts += state.outputs.contacts;
            sweeps += state.convergence.iterations;
        }
        times.sort_by(f64::total_cmp);
        let n = times.len();
        println!(
            "case {case} contacts {:.2} median {:.0} 99 {:.0} max {:.0} us sweeps {:.2} {:?}",
            contacts / n as f64,
            times[n / 2],
            times[n * 99 / 100],
            times[n - 1],
            sweeps as f64 / n as f64,
            workspace.iterations()
        );
    }
}

#[test]
fn zz_debug() {
    let at = |load: f64, y: f64, strips: usize, cells: usize| {
        let mut p = parameters(true, false);
        p.largest_load = 150e3;
        p.patch_strips = strips;
        p.patch_nodes = cells;
        let model = Model::new(p).unwrap();
        let inputs = Inputs {
            normal_load: load,
            wheel_speed: 20.0 / 0.46,
            vehicle_speed: 20.0,
            lateral_displacement: -1e-3 * y,
            yaw_angle: -3e-3 * y,
            roll_angle: -0.4e-3 * y,
            ..Inputs::default()
        };
        match model.initial_state(&mut model.workspace(), &inputs) {
            Ok(state) => {
                let o = &state.outputs;
                let ContactState::Surface(s) = &state.contact else {
                    panic!()
                };
                println!(
                    "{load} y {y:.3} strips {strips} cells {cells} F {:.5} {:.5} n {} p {:.0} {:?}",
                    o.force_x / load,
                    o.force_y / load,
                    o.contacts,
                    o.peak_pressure * 1e-6,
                    s.fields
                        .used()
                        .map(|(w, p)| {
                            let g = &model.operators_for_tests();
                            let crate::contact::Operators::Surface(ops) = g else {
                                panic!()
                            };
                            let patch = ops.of(&p);
                            let rows: Vec<i64> = (0..patch.grid.strips)
                                .map(|strip| {
                                    (1e-6
                                        * patch.scales.pressure
                                        * crate::numerics::dense::largest(
                                            &s.fields.windows[w].pressure[patch.grid.row(strip)],
                                        )) as i64
                                })
                                .collect();
                            (p.length, p.breadth, rows)
                        })
                        .collect::<Vec<_>>()
                );
            }
            Err(error) => println!("{load} {y} {error}"),
        }
    };
    for (strips, cells) in [(21, 34), (42, 34)] {
        at(60e3, 5.59, strips, cells);
        at(60e3, 5.605, strips, cells);
        at(60e3, 5.63, strips, cells);
    }
    at(10e3, 5.4837, 21, 34);
    at(10e3, 5.4838, 21, 34);
    println!("failures");
    at(10e3, 4.16, 21, 34);
    at(10e3, 4.19, 21, 34);
    at(100e3, 5.44, 21, 34);
    at(100e3, 5.4399999999999995, 21, 34);
}

#[test]
fn zz_geometry_change() {
    use super::geometry::{Pose, WindowGeometry};
    use crate::contact::patch::undeformed::Undeformed;
    use crate::geometry::unrolled::PlacedWheel;
    use crate::signals::INPUTS;
    let parameters = parameters(true, true);
    let model = Model::new(parameters.clone()).unwrap();
    let crate::contact::Operators::Surface(operators) = model.operators_for_tests() else {
        panic!()
    };
    for y in [1.0, 5.0] {
        let inputs = Inputs {
            wheel_speed: 20.1 / 0.46,
            vehicle_speed: 20.0,
            lateral_displacement: -1e-3 * y,
            yaw_angle: 1e-3,
            vertical_displacement: -0.15e-3,
            ..Inputs::default()
        };
        let mut workspace = model.workspace();
        let state = model.initial_state(&mut workspace, &inputs).unwrap();
        let ContactState::Surface(s) = &state.contact else {
            panic!()
        };
        for (_, place) in s.fields.used() {
            let grid = &operators.of(&place).grid;
            let mut geometry = WindowGeometry::new(operators);
            let mut set = |inputs: &Inputs| {
                let pose = Pose::new(operators, inputs, 0.46);
                let wheel = PlacedWheel::new(&operators.wheel, &pose.position);
                let mut undeformed = Undeformed::none(grid);
                geometry.set(
                    operators,
                    &place,
                    &wheel,
                    &pose.motion,
                    [f64::NEG_INFINITY, f64::INFINITY],
                    &mut undeformed,
                );
                undeformed
            };
            for (row, signal) in INPUTS.iter().enumerate() {
                let step = 1e-4 * signal.nominal;
                let mut ahead = inputs;
                let mut behind = inputs;
                (signal.set)(&mut ahead, (signal.get)(&inputs) + step);
                (signal.set)(&mut behind, (signal.get)(&inputs) - step);
                let (a, b) = (set(&ahead), set(&behind));
                set(&inputs);
                let pose = Pose::new(operators, &inputs, 0.46);
                let mut change = Inputs::ZERO;
                (signal.set)(&mut change, 1.0);
                let change = pose.change(operators, &inputs, &change, &parameters);
                let wheel = PlacedWheel::new(&operators.wheel, &pose.position);
                let mut tangent = Undeformed::none(grid);
                let mut own = WindowGeometry::new(operators);
                own.set(
                    operators,
                    &place,
                    &wheel,
                    &pose.motion,
                    [f64::NEG_INFINITY, f64::INFINITY],
                    &mut tangent,
                );
                own.set_change(operators, &place, &wheel, (&pose, &change), &mut tangent);
                let compare = |a: &[f64], b: &[f64], t: &[f64]| {
                    let size = t.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
                    let error = a
                        .iter()
                        .zip(b)
                        .zip(t)
                        .map(|((a, b), t)| ((a - b) / (2.0 * step) - t).abs())
                        .fold(0.0, f64::max);
                    (size, error / size.max(1e-300))
                };
                println!(
                    "{row} {:30} gap {:?} x {:?} y {:?}",
                    signal.name,
                    compare(&a.gap, &b.gap, &tangent.gap),
                    compare(&a.rigid_slip[0], &b.rigid_slip[0], &tangent.rigid_slip[0]),
                    compare(&a.rigid_slip[1], &b.rigid_slip[1], &tangent.rigid_slip[1])
                );
            }
        }
    }
}
