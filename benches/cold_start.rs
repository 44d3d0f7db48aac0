//! From nothing to the first output: mesh, compliance, thermal map, first contact; with an elastic wheel of the rail's material, a
//! rigid one, and an elastic one of another material; then with profiles.

mod braking;
mod calls;

use wheelrail::parameters::{ContactModel, SlipSource};
use wheelrail::signals::Inputs;
use wheelrail::{Model, Parameters, Wheel};

fn main() {
    let inputs = braking::manoeuvre()[0];
    let time = |name: &str, parameters: &Parameters, inputs: &Inputs| {
        calls::time(name, || {
            let model = Model::new(parameters.clone()).expect("a model");
            let mut workspace = model.workspace();
            model.initial_state(&mut workspace, inputs).expect("a state").outputs
        });
    };
    let start = |wheel: &str, parameters: &Parameters| {
        let name = format!("cold start, {wheel} wheel, {} nodes", parameters.contact_nodes);
        time(&name, parameters, &inputs);
    };
    for nodes in [25, 50, 61, 100, 200] {
        start("default", &braking::parameters(nodes));
    }
    let default = braking::parameters(61);
    let rigid = Parameters {
        wheel: Wheel::Rigid,
        ..default.clone()
    };
    start("rigid", &rigid);
    let softer = Parameters {
        wheel_shear_modulus: 0.5 * default.wheel_shear_modulus,
        ..default
    };
    start("softer", &softer);
    let profiles = Parameters {
        contact_model: ContactModel::Profiles,
        slip_source: SlipSource::VehicleSpeed,
        ..Parameters::default()
    };
    time("cold start, profiles, default cells", &profiles, &Inputs::default());
}
