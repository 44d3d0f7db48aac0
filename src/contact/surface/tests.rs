use super::totals::OnWheelset;
use crate::contact::ContactState;
use crate::parameters::{ContactModel, FrictionLaw, Parameters, SlipSource};
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
    parameters.profiles.rail_profile = "UIC60".into();
    parameters.profiles.right = right;
    parameters.profiles.height = height;
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
        let ContactState::Surface(s) = &state.contact else { panic!() };
        println!(
            "{:5} {:4.1} n{} FN {:7.0} {:+.4} FX {:+.4} FS {:+.4} p {:6.1} {:+.4} area {:6.2} {:+.4} size {:.2}x{:.2} dz {:+.4} places {:?} {:?}",
            cells[0], value("y_ws"), all.count, normal, normal / value("FN") - 1.0,
            (-fx - value("FX")) / bound, (fs - value("FS")) / bound,
            peak, peak / value("pmax") - 1.0, area, area / value("area") - 1.0,
            c[0].size[0] * 1e3, c[0].size[1] * 1e3,
            -(1e3 * (s.fields.touch - s.fields.approach[0]) - 460.0) - value("z_ws"),
            s.fields.used().map(|(_, p)| (p.length, p.breadth)).collect::<Vec<_>>(), time
        );
    }
}
