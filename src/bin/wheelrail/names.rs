//! Names that are meant, where one is given that there is none of.

use wheelrail::parameters::{INTEGER_PARAMETERS, IntegerKind, PATCH_GRID, REAL_PARAMETERS, TEXT_PARAMETERS};
use wheelrail::{Error as ModelError, INPUTS, OUTPUTS};

/// Likeness from which on a name may be meant: of six letters two may be wrong.
const LIKE: f64 = 0.6;
/// Likeness of a name that has the given one as a part, as `normal_load` has `load`.
const PART: f64 = 0.7;
/// Letters that a part has at least.
const SHORTEST_PART: usize = 4;
/// Names that are this much less like than the best one are named beside it.
const CLOSE: f64 = 0.05;
/// Names that are named at most.
const MOST: usize = 3;

fn likeness(name: &str, known: &str) -> f64 {
    let name = name.to_lowercase().replace(['-', ' '], "_");
    let known = known.to_lowercase();
    let whole = strsim::normalized_damerau_levenshtein(&name, &known);
    if name.len() >= SHORTEST_PART && known.contains(&name) {
        whole.max(PART)
    } else {
        whole
    }
}

/// Suggests, as the end of a message, the known names that may be meant; empty where none is like the given one.
pub fn did_you_mean<'a>(name: &str, known: impl IntoIterator<Item = &'a str>) -> String {
    let mut near: Vec<_> = known.into_iter().map(|known| (likeness(name, known), known)).collect();
    near.sort_by(|a, b| b.0.total_cmp(&a.0));
    let best = near.first().map_or(0.0, |(likeness, _)| *likeness);
    let names: Vec<_> = near
        .iter()
        .filter(|(likeness, _)| *likeness >= LIKE.max(best - CLOSE))
        .map(|(_, known)| *known)
        .take(MOST)
        .collect();
    match names.as_slice() {
        [] => String::new(),
        [one] => format!("; did you mean {one}?"),
        [others @ .., last] => format!("; did you mean {} or {last}?", others.join(", ")),
    }
}

/// Whether an input has this name.
pub fn is_input(name: &str) -> bool {
    INPUTS.iter().any(|signal| signal.name == name)
}

/// Whether an output has this name.
pub fn is_output(name: &str) -> bool {
    OUTPUTS.iter().any(|signal| signal.name == name)
}

/// The names of all parameters, and that of the grids; of an array those of its elements.
pub fn parameters() -> impl Iterator<Item = &'static str> {
    let reals = REAL_PARAMETERS.iter().flat_map(|row| row.elements.iter().copied());
    let integers = INTEGER_PARAMETERS.iter().map(|row| row.name);
    let texts = TEXT_PARAMETERS.iter().map(|row| row.name);
    reals.chain(integers).chain(texts).chain([PATCH_GRID])
}

/// Returns what helps after a refusal of a parameter's name or value, as the end of the message; empty where the
/// refusal says all.
pub fn hint(error: &ModelError) -> String {
    match error {
        ModelError::UnknownParameter { name } if is_input(name) => {
            format!("; {name} is an input, a column of the scenario")
        }
        ModelError::UnknownParameter { name } if is_output(name) => format!("; {name} is an output, which is computed"),
        ModelError::UnknownParameter { name } => did_you_mean(name, parameters()),
        ModelError::UnknownChoice { text, allowed, .. } => did_you_mean(text, allowed.iter().copied()),
        ModelError::NotANumber { name, text, .. } => {
            let row = INTEGER_PARAMETERS.iter().find(|row| row.name == *name);
            let names: &[&str] = match row.map(|row| row.kind) {
                Some(IntegerKind::Choice(names)) => names,
                Some(IntegerKind::Switch) => &["off", "on"],
                _ => return String::new(),
            };
            let all: Vec<_> = (1..)
                .zip(names)
                .map(|(number, name)| format!("{number} ({name})"))
                .collect();
            let meant = did_you_mean(text.trim(), names.iter().copied());
            format!(" or the name of a choice: {}{meant}", all.join(", "))
        }
        _ => String::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::did_you_mean;

    #[test]
    fn names_that_may_be_meant_are_named_and_no_others() {
        let known = [
            "wheel_speed",
            "vehicle_speed",
            "normal_load",
            "creepage",
            "lateral_creepage",
        ];
        for (name, expected) in [
            ("creapage", "; did you mean creepage?"),
            ("Normal-Load", "; did you mean normal_load?"),
            ("load", "; did you mean normal_load?"),
            ("whele_speed", "; did you mean wheel_speed?"),
            ("speed", "; did you mean wheel_speed or vehicle_speed?"),
            ("mass", ""),
            ("", ""),
        ] {
            assert_eq!(did_you_mean(name, known), expected, "{name}");
        }
    }
}
