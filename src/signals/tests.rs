use super::{CONTACTS, INPUTS, Inputs, OUTPUTS, Outputs, UsedBy};
use crate::error::Error;
use crate::parameters::{ContactModel, Control, Parameters, PatchGeometry, REAL_PARAMETERS, SlipSource};

/// A parameter is named in the refusal of an input exactly where it narrows the input's range.
#[test]
fn a_refusal_names_the_parameters_that_narrow_the_range() {
    let parameters = Parameters {
        contact_model: ContactModel::Patch,
        patch_geometry: PatchGeometry::Inputs,
        ..Parameters::default()
    };
    for signal in INPUTS {
        let range = signal.range(&parameters);
        let narrowed = range != (signal.minimum, signal.maximum);
        assert_eq!(narrowed, !signal.narrowed_by.is_empty(), "{}", signal.name);
        let words: Vec<_> = signal
            .narrowed_by
            .split(|c: char| !c.is_alphanumeric() && c != '_')
            .collect();
        for row in REAL_PARAMETERS {
            let mut other = parameters.clone();
            (row.get_mut)(&mut other)[0] *= 0.9;
            let moves = signal.range(&other) != range;
            // Of two like bodies the slower one counts.
            let named = words.contains(&row.name);
            (row.get_mut)(&mut other)[0] /= 0.81;
            let moves = moves || signal.range(&other) != range;
            assert_eq!(moves, named, "{} in the refusal of {}", row.name, signal.name);
        }
        let refused = signal.check(range.1.next_up(), &parameters).unwrap_err().to_string();
        assert!(refused.ends_with(signal.narrowed_by), "{refused}");
    }
    let too_fast = Inputs {
        wheel_speed: 400.0,
        ..Inputs::default()
    };
    let refused = too_fast.check(&parameters).unwrap_err().to_string();
    assert!(
        refused.contains("allowed is -149.97") && refused.contains("wheel_density"),
        "{refused}"
    );
}

#[test]
fn a_number_without_a_unit_is_refused_without_one() {
    let parameters = Parameters::default();
    for signal in INPUTS.iter().filter(|signal| signal.unit == "1") {
        let (minimum, maximum) = signal.range(&parameters);
        let refused = signal.check(f64::NAN, &parameters).unwrap_err().to_string();
        assert_eq!(
            refused,
            format!("{} = NaN: allowed is {minimum} to {maximum}", signal.name)
        );
    }
}

/// The table says which slip_source uses an input: what it does not name moves nothing, what it names does.
#[test]
fn the_motion_follows_from_the_inputs_that_its_source_uses() {
    for source in SlipSource::ALL {
        let parameters = Parameters {
            slip_source: *source,
            ..Parameters::default()
        };
        let start = Inputs::default();
        for signal in INPUTS {
            let mut other = start;
            let value = signal.default + 0.5;
            (signal.set)(&mut other, value);
            let moves = other.motion(&parameters) != start.motion(&parameters);
            let refused = signal.check_used(value, &parameters);
            match signal.used_by {
                Some(UsedBy::SlipSource(user)) => {
                    assert_eq!(moves, user == *source, "{}", signal.name);
                    assert_eq!(refused.is_ok(), moves, "{}", signal.name);
                    let words = format!("used where slip_source is {}", SlipSource::NAMES[user as usize]);
                    assert!(signal.description.contains(&words), "{}", signal.description);
                }
                Some(UsedBy::Control(user)) => {
                    assert_eq!(
                        (moves, refused.is_ok()),
                        (false, user == Control::Load),
                        "{}",
                        signal.name
                    );
                    let words = format!("used where control is {}", Control::NAMES[user as usize]);
                    assert!(signal.description.contains(&words), "{}", signal.description);
                }
                Some(UsedBy::PatchGeometry(user)) => {
                    assert_eq!(
                        (user, moves, refused.is_ok()),
                        (PatchGeometry::Inputs, false, false),
                        "{}",
                        signal.name
                    );
                    assert!(
                        signal.description.contains("used where patch_geometry is inputs"),
                        "{}",
                        signal.description
                    );
                }
                None => {
                    assert!(
                        refused.is_ok() && !signal.description.contains("slip_source"),
                        "{}",
                        signal.name
                    );
                    assert!(!moves || signal.name == "wheel_speed", "{}", signal.name);
                }
            }
            assert_eq!(signal.check_used(signal.default, &parameters), Ok(()));
        }
    }
    let by_creepage = Parameters::default();
    let speed = INPUTS.iter().find(|signal| signal.name == "vehicle_speed");
    let refused = speed.map(|signal| signal.check_used(30.0, &by_creepage));
    let Some(Err(error @ Error::NotUsed { .. })) = refused else {
        panic!("{refused:?}");
    };
    assert_eq!(
        error.to_string(),
        "vehicle_speed = 30 has no effect with slip_source = 1 (creepage); with slip_source = 2 (vehicle_speed) it is used"
    );
    let height = INPUTS.iter().find(|signal| signal.name == "vertical_displacement");
    let refused = height.and_then(|signal| signal.check_used(1e-3, &by_creepage).err());
    assert_eq!(
        refused.expect("an error").to_string(),
        "vertical_displacement = 0.001 has no effect with control = 1 (load); with control = 3 (height) it is used"
    );
    let by_height = Parameters {
        control: Control::Height,
        ..by_creepage
    };
    assert!(height.is_some_and(|signal| signal.check_used(1e-3, &by_height).is_ok()));
}

/// Start values as FMPy interpolates them between two equal rows, 1 or 2 units of the last bit off, are no others; a change that
/// a user may mean is one.
#[test]
fn a_start_value_that_was_rounded_is_not_told_of() {
    let parameters = Parameters::default();
    for (name, interpolated) in [
        ("rolling_radius", 0.4600000000000001),
        ("transverse_curvature", 3.333333333333334),
    ] {
        let signal = INPUTS.iter().find(|signal| signal.name == name).expect("an input");
        assert_ne!(interpolated, signal.default);
        assert_eq!(signal.check_used(interpolated, &parameters), Ok(()), "{name}");
        for changed in [signal.default * (1.0 + 1e-12), f64::NAN] {
            assert!(signal.check_used(changed, &parameters).is_err(), "{name} = {changed}");
        }
    }
    // A start value of 0 has no last bits.
    let speed = INPUTS
        .iter()
        .find(|signal| signal.name == "spin_rate")
        .expect("an input");
    assert_eq!(speed.default, 0.0);
    assert!(speed.check_used(1e-300, &parameters).is_err());
}

/// The contact models without which an input or an output is 0.
#[test]
fn the_end_of_a_description_names_the_contact_models() {
    for signal in INPUTS {
        let names: Vec<_> = signal
            .models
            .iter()
            .map(|model| ContactModel::NAMES[*model as usize])
            .collect();
        let ending = format!("; 0 unless contact_model is {}", names.join(" or "));
        let is_for_all = signal.models == ContactModel::ALL;
        assert_eq!(
            signal.description.ends_with(&ending),
            !is_for_all,
            "{}",
            signal.description
        );
        assert_eq!(signal.takers.is_empty(), is_for_all, "{}", signal.name);
        // What is 0 by itself passes under every contact model.
        assert!(is_for_all || signal.default == 0.0, "{}", signal.name);
        let models = signal.models.iter().map(|model| {
            let number = *model as usize;
            format!("{} ({})", number + 1, ContactModel::NAMES[number])
        });
        let takers = models.collect::<Vec<_>>().join(" and ");
        assert!(is_for_all || signal.takers.starts_with(&takers), "{}", signal.takers);
    }
    for output in OUTPUTS.iter().filter(|output| output.array.is_none()) {
        let ending = "; 0 unless contact_model is profiles";
        assert_eq!(
            output.description.ends_with(ending),
            output.profiles_only,
            "{}",
            output.name
        );
    }
}

/// The elements of an array follow each other, alike but for name and place.
#[test]
fn the_contacts_have_arrays_of_outputs() {
    let mut outputs = Outputs::default();
    let firsts = OUTPUTS
        .iter()
        .enumerate()
        .filter(|(_, row)| matches!(row.array, Some((_, 0))));
    let mut arrays = 0;
    for (row, first) in firsts {
        let (name, _) = first.array.expect("an array");
        for (element, signal) in OUTPUTS[row..row + CONTACTS].iter().enumerate() {
            assert_eq!(signal.array, Some((name, element)));
            assert_eq!(signal.name, format!("{name}[{}]", element + 1));
            assert_eq!((signal.unit, signal.description), (first.unit, first.description));
            assert!(signal.profiles_only);
            let value = (CONTACTS * row + element) as f64;
            (signal.set)(&mut outputs, value);
            assert_eq!((signal.get)(&outputs), value);
        }
        arrays += 1;
    }
    assert_eq!(
        OUTPUTS.iter().filter(|row| row.array.is_some()).count(),
        CONTACTS * arrays
    );
    let values: Vec<_> = OUTPUTS
        .iter()
        .filter(|row| row.array.is_some())
        .map(|row| (row.get)(&outputs))
        .collect();
    assert!(values.windows(2).all(|pair| pair[0] < pair[1]));
    let position = OUTPUTS.iter().position(|row| row.name == "contact.normal_force[3]");
    assert_eq!(
        outputs.contact[2].normal_force,
        (CONTACTS * (position.expect("a row") - 2) + 2) as f64
    );
}
