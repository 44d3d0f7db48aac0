use super::{INPUTS, Inputs};
use crate::error::Error;
use crate::parameters::{Parameters, REAL_PARAMETERS, SlipSource};

/// A parameter is named in the refusal of an input exactly where it narrows the input's range.
#[test]
fn a_refusal_names_the_parameters_that_narrow_the_range() {
    let parameters = Parameters::default();
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
            match signal.slip_source {
                Some(user) => {
                    assert_eq!(moves, user == *source, "{}", signal.name);
                    assert_eq!(refused.is_ok(), moves, "{}", signal.name);
                    let words = format!("used where slip_source is {}", SlipSource::NAMES[user as usize]);
                    assert!(signal.description.contains(&words), "{}", signal.description);
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
}
