//! Values that cannot be: the error names the variable, the value and what is allowed, and nothing else changes.

use wheelrail::error::Error;
use wheelrail::parameters::{
    ContactModel, Control, FrictionLaw, INTEGER_PARAMETERS, MeshKind, NormalSolver, Parameters, PatchGeometry,
    REAL_PARAMETERS, SlipSource,
};
use wheelrail::signals::{INPUTS, InputSignal, Inputs};
use wheelrail::simulation::Simulation as Run;
use wheelrail::wheel_rail::Model;

/// NaN, both infinities, and the next representable values outside a range.
fn refused(minimum: f64, maximum: f64) -> [f64; 5] {
    [
        f64::NAN,
        f64::INFINITY,
        f64::NEG_INFINITY,
        minimum.next_down(),
        maximum.next_up(),
    ]
}

/// The error names `name`, holds `value` (NaN included) and the range.
fn assert_out_of_range(error: &Error, name: &str, value: f64, (minimum, maximum): (f64, f64)) {
    match error {
        Error::OutOfRange {
            name: named,
            value: held,
            minimum: lower,
            maximum: upper,
            ..
        } => {
            assert_eq!(*named, name);
            assert_eq!(held.to_bits(), value.to_bits(), "{name}");
            assert_eq!((*lower, *upper), (minimum, maximum), "{name}");
        }
        other => panic!("{name} = {value}: {other:?}"),
    }
    let message = error.to_string();
    for part in [
        name.to_owned(),
        value.to_string(),
        minimum.to_string(),
        maximum.to_string(),
    ] {
        assert!(message.contains(&part), "{message} lacks {part}");
    }
}

#[test]
fn every_input_out_of_its_range_is_refused_and_changes_nothing() {
    let parameters = Parameters {
        slip_source: SlipSource::VehicleSpeed,
        contact_nodes: 21,
        depth_nodes: 11,
        ..Parameters::default()
    };
    let mut run = Run::new(&parameters, &Inputs::default()).unwrap();
    run.hold(&Inputs::default(), 1e-3, 3).unwrap();
    let before = run.state.clone();
    for signal in INPUTS {
        let range = signal.range(&parameters);
        for value in refused(range.0, range.1) {
            let mut inputs = Inputs::default();
            (signal.set)(&mut inputs, value);
            let error = run.step(&inputs, 1e-3).unwrap_err();
            assert_out_of_range(&error, signal.name, value, range);
            assert_eq!(run.state, before);
            assert!(run.model.initial_state(&mut run.workspace, &inputs).is_err());

            // The same side left by a rate within the step, by more than the rounding of a ramp.
            let mut rates = Inputs::ZERO;
            let change = value - (signal.get)(&Inputs::default());
            (signal.set)(
                &mut rates,
                (change + 0.01 * change.signum() * (range.1 - range.0)) * 2e3,
            );
            let interrupted = run
                .model
                .step(&mut run.workspace, &mut run.state, &Inputs::default(), &rates, 1e-3)
                .unwrap_err();
            assert_eq!(interrupted.committed, 0.0);
            assert_eq!(run.state, before);
        }
    }
}

/// A contact model ignores no motion that it does not know of, whichever inputs define the motion: it refuses it, held and as a ramp.
#[test]
fn motion_that_a_contact_model_does_not_know_is_refused() {
    for (contact_model, slip_source) in [
        (ContactModel::Line, SlipSource::Creepage),
        (ContactModel::Line, SlipSource::VehicleSpeed),
        (ContactModel::Patch, SlipSource::VehicleSpeed),
    ] {
        let parameters = Parameters {
            contact_model,
            slip_source,
            contact_nodes: 21,
            depth_nodes: 11,
            patch_nodes: 12,
            patch_strips: 5,
            ..Parameters::default()
        };
        let mut run = Run::new(&parameters, &Inputs::default()).unwrap();
        run.hold(&Inputs::default(), 1e-3, 1).unwrap();
        let before = run.state.clone();
        let others: Vec<_> = INPUTS
            .iter()
            .filter(|signal| !signal.is_taken_by(contact_model))
            .collect();
        assert_eq!(others.len(), if contact_model == ContactModel::Line { 19 } else { 12 });
        for signal in others {
            let mut inputs = Inputs::default();
            (signal.set)(&mut inputs, 0.001);
            let error = run.step(&inputs, 1e-3).unwrap_err();
            assert_eq!(error.to_string(), refusal(signal, contact_model));
            assert_eq!(run.model.initial_state(&mut run.workspace, &inputs).unwrap_err(), error);
            let mut rates = Inputs::ZERO;
            (signal.set)(&mut rates, 1.0);
            let interrupted = run
                .model
                .step(&mut run.workspace, &mut run.state, &Inputs::default(), &rates, 1e-3)
                .unwrap_err();
            assert_eq!((interrupted.committed, interrupted.error), (0.0, error));
            assert_eq!(run.state, before);
            // What is 0 is nothing, whatever its sign; another contact model takes more.
            (signal.set)(&mut inputs, -0.0);
            assert!(inputs.check(&parameters).is_ok());
            (signal.set)(&mut inputs, 0.001);
            for contact_model in ContactModel::ALL {
                let other = Parameters {
                    contact_model: *contact_model,
                    ..parameters.clone()
                };
                assert_eq!(inputs.check(&other).is_ok(), signal.is_taken_by(*contact_model));
            }
        }
    }
    // Creepages and the patch's spin are not the wheelset's.
    for name in ["lateral_creepage", "spin_creepage", "spin_rate"] {
        let signal = INPUTS.iter().find(|signal| signal.name == name).unwrap();
        let refused = signal.check(0.001, &profiles()).unwrap_err().to_string();
        assert_eq!(refused, refusal(signal, ContactModel::Profiles));
    }
}

/// The words in which a contact model refuses an input.
fn refusal(signal: &InputSignal, contact_model: ContactModel) -> String {
    let (number, choice) = (contact_model as usize + 1, ContactModel::NAMES[contact_model as usize]);
    let takers = match signal.models {
        [ContactModel::Patch] => "2 (patch) takes",
        [ContactModel::Profiles] => "3 (profiles) takes",
        _ => "2 (patch) and 3 (profiles) take",
    };
    let name = signal.name;
    format!("{name} = 0.001: must be 0 with contact_model = {number} ({choice}); contact_model = {takers} it")
}

/// Parameters that profiles may have.
fn profiles() -> Parameters {
    Parameters {
        contact_model: ContactModel::Profiles,
        slip_source: SlipSource::VehicleSpeed,
        ..Parameters::default()
    }
}

#[test]
fn combinations_that_profiles_cannot_have_are_refused() {
    assert_eq!(profiles().validate(), Ok(()));
    // What a patch or a line needs is nothing to them.
    let hollow = Parameters {
        rail_transverse_curvature: -1.0,
        contact_width: 1e-4,
        ..profiles()
    };
    assert_eq!(hollow.validate(), Ok(()));
    let by_height = Parameters {
        control: Control::Height,
        ..profiles()
    };
    assert_eq!(by_height.validate(), Ok(()));
    for (changed, parts) in [
        (
            Parameters {
                slip_source: SlipSource::Creepage,
                ..profiles()
            },
            ["contact_model = 3", "slip_source = 1", "2 (vehicle_speed)"],
        ),
        (
            Parameters {
                control: Control::Penetration,
                ..profiles()
            },
            ["control = 2", "contact_model = 3", "1 (load) or 3 (height)"],
        ),
        (
            Parameters {
                mesh: MeshKind::Paper,
                ..profiles()
            },
            ["contact_model = 3", "mesh = 2", "1 (graded)"],
        ),
        (
            Parameters {
                normal_solver: NormalSolver::Pschenichnyj,
                ..profiles()
            },
            ["contact_model = 3", "normal_solver = 2", "1 (active_set)"],
        ),
        (
            Parameters {
                wheel_radius: 0.05,
                largest_load: 1e6,
                ..profiles()
            },
            ["largest_load", "wheel_radius = 0.05", "a tenth"],
        ),
        (
            Parameters {
                control: Control::Height,
                ..Parameters::default()
            },
            ["control = 3", "contact_model = 1", "1 (load) or 2 (penetration)"],
        ),
        (
            Parameters {
                patch_geometry: PatchGeometry::Inputs,
                ..profiles()
            },
            ["patch_geometry = 2", "contact_model = 3", "1 (parameters)"],
        ),
    ] {
        assert_combination(&changed, &parts);
    }
}

#[test]
fn a_rolling_speed_beyond_the_validity_is_refused() {
    let parameters = Parameters {
        contact_nodes: 21,
        depth_nodes: 11,
        ..Parameters::default()
    };
    let mut run = Run::new(&parameters, &Inputs::default()).unwrap();
    let before = run.state.clone();
    // Either input is allowed by itself; V = ω r₀/(1 + ξ) is not.
    let inputs = Inputs {
        wheel_speed: 100.0,
        creepage: -0.9,
        ..Inputs::default()
    };
    let error = run.step(&inputs, 1e-3).unwrap_err();
    let message = error.to_string();
    for part in ["rolling speed", "460", &parameters.largest_speed().to_string(), "m/s"] {
        assert!(message.contains(part), "{message} lacks {part}");
    }
    assert_eq!(run.state, before);
}

#[test]
fn every_parameter_out_of_its_range_is_refused() {
    for entry in REAL_PARAMETERS {
        let range = (entry.minimum, entry.maximum);
        for (element, name) in entry.elements.iter().enumerate() {
            for value in refused(entry.minimum, entry.maximum) {
                let mut parameters = Parameters::default();
                (entry.get_mut)(&mut parameters)[element] = value;
                assert_out_of_range(&parameters.validate().unwrap_err(), name, value, range);
                assert!(Model::new(parameters).is_err());

                let mut parameters = Parameters::default();
                let error = parameters.set_by_name(name, &format!("{value}")).unwrap_err();
                assert_out_of_range(&error, name, value, range);
                assert_eq!(parameters, Parameters::default());
            }
        }
    }
    for entry in INTEGER_PARAMETERS {
        for value in [entry.minimum - 1, entry.maximum + 1, i32::MIN, i32::MAX] {
            let mut parameters = Parameters::default();
            let error = parameters.set_by_name(entry.name, &value.to_string()).unwrap_err();
            let range = (f64::from(entry.minimum), f64::from(entry.maximum));
            assert_out_of_range(&error, entry.name, f64::from(value), range);
            assert_eq!(parameters, Parameters::default());
        }
    }
}

#[test]
fn names_and_numbers_that_are_none_are_refused() {
    let mut parameters = Parameters::default();
    let message = |result: Result<(), Error>| result.unwrap_err().to_string();
    assert!(message(parameters.set_by_name("mass", "1")).contains("\"mass\""));
    let text = message(parameters.set_by_name("density", "heavy"));
    assert!(text.contains("density") && text.contains("\"heavy\""), "{text}");
    assert!(message(parameters.set_by_name("contact_nodes", "61.5")).contains("an integer"));
    assert_eq!(parameters, Parameters::default());
    parameters.set_by_name("density", " 8e3 ").unwrap();
    assert_eq!(parameters.density, 8e3);
}

/// Both values and what must hold between them are in the message.
fn assert_combination(parameters: &Parameters, parts: &[&str]) {
    let error = parameters.validate().unwrap_err();
    assert!(matches!(error, Error::Combination { .. }), "{error:?}");
    let message = error.to_string();
    for part in parts {
        assert!(message.contains(part), "{message} lacks {part}");
    }
    assert!(Model::new(parameters.clone()).is_err());
}

#[test]
fn combinations_that_cannot_be_are_refused() {
    let parameters = || Parameters::default();
    assert_combination(
        &Parameters {
            friction_hot: 0.5,
            ..parameters()
        },
        &["friction_hot = 0.5", "friction_cold = 0.45", "must not exceed"],
    );
    assert_combination(
        &Parameters {
            friction_temperature_hot: 320.0,
            ..parameters()
        },
        &["friction_temperature_hot = 320", "friction_temperature_cold = 323.15"],
    );
    let mut table = Parameters {
        friction_law: FrictionLaw::Table,
        friction_table_points: 3,
        ..parameters()
    };
    table.friction_table_temperature[..3].copy_from_slice(&[300.0, 400.0, 400.0]);
    assert_combination(&table, &["friction_table.temperature = 400", "ascend"]);
    for (changed, part) in [
        (
            Parameters {
                wheel_radius: 0.05,
                largest_load: 1e6,
                ..parameters()
            },
            "wheel_radius = 0.05",
        ),
        (
            Parameters {
                strip_half_length: 0.1,
                largest_load: 1e6,
                ..parameters()
            },
            "strip_half_length = 0.1",
        ),
        (
            Parameters {
                largest_load: 5e6,
                wheel_radius: 5.0,
                strip_height: 0.05,
                strip_half_length: 20.0,
                ..parameters()
            },
            "strip_height = 0.05",
        ),
    ] {
        assert_combination(&changed, &["largest_load", part]);
    }
}

#[test]
fn combinations_that_a_patch_cannot_have_are_refused() {
    let patch = || Parameters {
        contact_model: ContactModel::Patch,
        ..Parameters::default()
    };
    assert!(patch().validate().is_ok());
    for (rail, wheel, part) in [
        (2.0, -2.0, "positive"),
        (1.0, -2.0, "positive"),
        (1e-5, 0.0, "1e-4 to 1e4"),
    ] {
        let curved = Parameters {
            rail_transverse_curvature: rail,
            wheel_transverse_curvature: wheel,
            ..patch()
        };
        assert_combination(
            &curved,
            &[
                &format!("rail_transverse_curvature = {rail}"),
                &format!("wheel_transverse_curvature = {wheel}"),
                part,
            ],
        );
        let line = Parameters {
            contact_model: ContactModel::Line,
            ..curved
        };
        assert!(line.validate().is_ok());
    }
    let other_mesh = Parameters {
        mesh: MeshKind::Paper,
        ..patch()
    };
    assert_combination(&other_mesh, &["contact_model = 2", "mesh = 2"]);
    let other_solver = Parameters {
        normal_solver: NormalSolver::Pschenichnyj,
        ..patch()
    };
    assert_combination(&other_solver, &["contact_model = 2", "normal_solver = 2"]);
    let small_wheel = Parameters {
        wheel_radius: 0.05,
        largest_load: 1e6,
        ..patch()
    };
    assert_combination(&small_wheel, &["largest_load", "wheel_radius = 0.05"]);
    let short_strip = Parameters {
        strip_half_length: 0.1,
        largest_load: 1e6,
        ..patch()
    };
    assert_combination(&short_strip, &["largest_load", "strip_half_length = 0.1"]);
    // A width that no line contact could have.
    let narrow = Parameters {
        contact_width: 1e-4,
        ..Parameters::default()
    };
    assert!(narrow.validate().is_err());
    assert!(
        Parameters {
            contact_model: ContactModel::Patch,
            ..narrow
        }
        .validate()
        .is_ok()
    );
}

#[test]
fn what_is_tuned_wrongly_is_refused_and_changes_nothing() {
    let mut model = Model::new(Parameters {
        contact_nodes: 21,
        depth_nodes: 11,
        ..Parameters::default()
    })
    .unwrap();
    let before = model.parameters().clone();
    for wrong in [
        Parameters {
            friction_cold: f64::NAN,
            ..before.clone()
        },
        Parameters {
            friction_hot: 0.46,
            ..before.clone()
        },
        Parameters {
            slip_regularisation: -1e-3,
            ..before.clone()
        },
    ] {
        assert!(model.retune(&wrong).is_err());
        assert_eq!(*model.parameters(), before);
    }
    // What is not tunable is passed over.
    model
        .retune(&Parameters {
            friction_cold: 0.3,
            density: 1e3,
            ..before.clone()
        })
        .unwrap();
    assert_eq!(
        (model.parameters().friction_cold, model.parameters().density),
        (0.3, before.density)
    );
}
