//! The two methods for the normal problem, primal–dual active set and Pschenichnyj's linearisation, give the same
//! pressure to 1e-8 in the whole model: with friction, heat and wear, under load and under penetration. The second runs as
//! the reference: tight by itself, and started anew at each step, from no tractions and without extrapolation.

mod checks;

use checks::largest_difference;
use wheelrail::parameters::{Control, NormalSolver, Parameters, SlipSource};
use wheelrail::signals::Inputs;
use wheelrail::simulation::Simulation as Run;

/// Leaves temperature and wear, the state proper, and nothing that a step only starts its iteration from.
fn forget_the_start(run: &mut Run) {
    let fields = run.state.fields_mut();
    for start in [&mut fields.pressure, &mut fields.shear, &mut fields.slip] {
        start.fill(0.0);
    }
    let trend = &mut run.state.contact.line_mut().trend;
    for trend in [
        &mut trend.shear,
        &mut trend.surface_temperature,
        &mut trend.thermal_displacement,
        &mut trend.wear,
    ] {
        trend.fill(0.0);
    }
}

fn run(normal_solver: NormalSolver, control: Control) -> Run {
    let parameters = Parameters {
        normal_solver,
        control,
        slip_source: SlipSource::VehicleSpeed,
        // Both solvers must work in the model; the linearisation takes minutes on the default mesh.
        contact_nodes: 31,
        depth_nodes: 21,
        ..Parameters::default()
    };
    let inputs = |slide: f64, load: f64| Inputs {
        wheel_speed: 10.0 * (1.0 - slide) / parameters.wheel_radius,
        normal_load: load,
        ..Inputs::default()
    };
    let mut run = Run::new(&parameters, &inputs(0.0, 60e3)).unwrap();
    for (slide, load) in [(0.001, 60e3), (0.002, 55e3), (0.01, 50e3), (0.02, 70e3)] {
        for _ in 0..4 {
            if normal_solver == NormalSolver::Pschenichnyj {
                forget_the_start(&mut run);
            }
            run.hold(&inputs(slide, load), 5e-3, 1).unwrap();
        }
    }
    run
}

#[test]
fn active_set_and_linearisation_give_the_same_fields() {
    for control in [Control::Load, Control::Penetration] {
        let (active, linearised) = (
            run(NormalSolver::ActiveSet, control),
            run(NormalSolver::Pschenichnyj, control),
        );
        let (a, b) = (active.state.fields(), linearised.state.fields());
        for (name, a, b) in [
            ("pressure", &a.pressure, &b.pressure),
            ("shear", &a.shear, &b.shear),
            ("temperature", &a.surface_temperature, &b.surface_temperature),
            ("wear", &a.wear, &b.wear),
        ] {
            let difference = largest_difference(a, b);
            assert!(difference <= 1e-8, "{control:?} {name} {difference:e}");
        }
        assert!((a.penetration / b.penetration - 1.0).abs() <= 1e-8);
    }
}
