//! Parameters that the choices leave without effect, so that who has set one can be told.
//!
//! The descriptions of `table` say under which choice a parameter is used, as "used where contact_model is patch or profiles": they are read here.

use super::choices::{ContactModel, ProfileWear, WearLaw, WheelWearLaw};
use super::source::ProfileSource;
use super::table::{INTEGER_PARAMETERS, IntegerKind, IntegerParameter, Parameters, REAL_PARAMETERS, TEXT_PARAMETERS};
use std::fmt::Display;

/// Words of a description before the choice under which a parameter is used.
const USED_WHERE: &str = "used where ";

/// Choice under which a parameter is used, by its parameter and the numbers of the values that use it, from 1.
struct UsedWhere {
    choice: &'static IntegerParameter,
    values: Vec<usize>,
}

impl UsedWhere {
    /// Choice that a description names; `None` where it names no choice and values of it.
    fn of(description: &str) -> Option<UsedWhere> {
        let (_, condition) = description.split_once(USED_WHERE)?;
        let mut words = condition.split_whitespace();
        let name = words.next()?;
        let choice = INTEGER_PARAMETERS.iter().find(|row| row.name == name)?;
        if words.next() != Some("is") {
            return None;
        }
        let mut values = Vec::new();
        loop {
            let word = words.next()?;
            let value = word.trim_end_matches([',', ';', ':']);
            let number = names(choice)?.iter().position(|known| *known == value)?;
            values.push(number + 1);
            if value != word || words.next() != Some("or") {
                return Some(UsedWhere { choice, values });
            }
        }
    }

    /// Remark on a parameter and its value, where the choice that is made has no use for it.
    fn remark(&self, name: &str, value: &dyn Display, parameters: &Parameters) -> Option<String> {
        let (chosen, names) = ((self.choice.get)(parameters) as usize, names(self.choice)?);
        let choice = self.choice.name;
        let users: Vec<_> = self.values.iter().map(|&value| names[value - 1]).collect();
        (!self.values.contains(&chosen)).then(|| {
            format!(
                "{name} = {value} has no effect with {choice} = {chosen} ({}); it is used where {choice} is {}",
                names[chosen - 1],
                users.join(" or ")
            )
        })
    }
}

/// Names of the values of a choice.
fn names(choice: &IntegerParameter) -> Option<&'static [&'static str]> {
    match choice.kind {
        IntegerKind::Choice(names) => Some(names),
        IntegerKind::Switch => Some(&["off", "on"]),
        IntegerKind::Count | IntegerKind::Length => None,
    }
}

impl Parameters {
    /// Remarks on the parameters that have another value than at the start and no effect under the choices that are made.
    pub fn without_effect(&self) -> Vec<String> {
        let mut remarks = Vec::new();
        let mut look = |name: &str, description: &str, value: &dyn Display| {
            remarks.extend(UsedWhere::of(description).and_then(|used| used.remark(name, value, self)));
        };
        for row in REAL_PARAMETERS {
            let values = (row.get)(self).iter().zip(row.start).zip(row.elements);
            for ((value, _), element) in values.filter(|((value, start), _)| value != start) {
                look(element, row.description, value);
            }
        }
        for row in INTEGER_PARAMETERS.iter().filter(|row| (row.get)(self) != row.start) {
            look(row.name, row.description, &(row.get)(self));
        }
        for row in TEXT_PARAMETERS.iter().filter(|row| (row.get)(self) != row.start) {
            look(row.name, row.description, &(row.get)(self));
        }
        self.look_at_wear(&mut remarks);
        let is_built_in = |text: &str| matches!(ProfileSource::of("", text), Ok(ProfileSource::BuiltIn(_)));
        let profiles = [&self.rail_profile, &self.wheel_profile];
        if self.contact_model == ContactModel::Profiles
            && self.profile_smoothing != 0.0
            && profiles.iter().all(|profile| is_built_in(profile))
        {
            remarks.push(format!(
                "profile_smoothing = {} has no effect: rail_profile = {} and wheel_profile = {} are built in, and have no measured points",
                self.profile_smoothing, self.rail_profile, self.wheel_profile
            ));
        }
        remarks
    }

    /// Adds the remarks on wear of profiles that wears nothing off.
    fn look_at_wear(&self, remarks: &mut Vec<String>) {
        if self.contact_model != ContactModel::Profiles {
            return;
        }
        let rail_law = match self.wear_law {
            WearLaw::Archard if self.wear_coefficient == 0.0 => Some("wear_law = 1 (archard) and wear_coefficient = 0"),
            _ => None,
        };
        let wheel_law = match self.wheel_wear_law {
            WheelWearLaw::Coefficient if self.wheel_wear_coefficient == 0.0 => {
                Some("wheel_wear_law = 1 (coefficient) and wheel_wear_coefficient = 0")
            }
            WheelWearLaw::Coefficient => None,
            WheelWearLaw::WearLaw => rail_law,
        };
        let wears = [self.wheel_profile_wear, self.rail_profile_wear].map(|wear| wear == ProfileWear::On);
        let switches = ["wheel_profile_wear", "rail_profile_wear"];
        for ((name, wears), law) in switches.iter().zip(wears).zip([wheel_law, rail_law]) {
            if let Some(law) = law.filter(|_| wears) {
                remarks.push(format!("{name} = 2 (on) has no effect with {law}"));
            }
        }
        if self.wear_acceleration != 1.0 && wears == [false; 2] {
            remarks.push(format!(
                "wear_acceleration = {} has no effect: wheel_profile_wear and rail_profile_wear are 1 (off)",
                self.wear_acceleration
            ));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parameters::{PatchGeometry, SlipSource};
    use crate::signals::Inputs;
    use crate::wheel_rail::Model;

    /// Descriptions that say which choice uses a parameter can be read, but for conditions that are no choices.
    #[test]
    fn descriptions_name_choices_and_their_values() {
        let numbers = REAL_PARAMETERS.iter().map(|row| (row.name, row.description));
        let integers = INTEGER_PARAMETERS.iter().map(|row| (row.name, row.description));
        let texts = TEXT_PARAMETERS.iter().map(|row| (row.name, row.description));
        let (mut read, mut others) = (0, Vec::new());
        for (name, description) in numbers.chain(integers).chain(texts) {
            match UsedWhere::of(description) {
                Some(_) => read += 1,
                None if description.contains(USED_WHERE) => others.push(name),
                None => {}
            }
        }
        assert!(read > 40, "{read}");
        // Of a distance and of a stress that is not 0.
        assert_eq!(others, ["friction_memory_speed", "layer_hardening"]);
    }

    /// A parameter of which it is said that it has no effect has none, to the last bit.
    #[test]
    fn what_has_no_effect_changes_no_output() {
        for contact_model in [ContactModel::Line, ContactModel::Patch, ContactModel::Profiles] {
            let parameters = Parameters {
                contact_model,
                slip_source: SlipSource::VehicleSpeed,
                patch_geometry: PatchGeometry::Parameters,
                ..Parameters::default()
            };
            assert_eq!(parameters.without_effect(), Vec::<String>::new());
            let inputs = Inputs {
                wheel_speed: 10.1 / 0.46,
                ..Inputs::default()
            };
            let outputs = |parameters: &Parameters| {
                let model = Model::new(parameters.clone()).unwrap();
                let mut workspace = model.workspace();
                let mut state = model.initial_state(&mut workspace, &inputs).unwrap();
                model
                    .step(&mut workspace, &mut state, &inputs, &Inputs::ZERO, 1e-3)
                    .unwrap();
                state.outputs
            };
            let usual = outputs(&parameters);
            let mut looked_at = 0;
            for row in REAL_PARAMETERS {
                let mut other = parameters.clone();
                for value in (row.get_mut)(&mut other) {
                    *value = if *value == 0.0 { 1e-3 } else { *value * (1.0 + 1e-3) };
                }
                if other.validate().is_ok() && !other.without_effect().is_empty() {
                    looked_at += 1;
                    assert_eq!(outputs(&other), usual, "{}", row.name);
                }
            }
            assert!(looked_at > 15, "{looked_at}");
        }
    }

    #[test]
    fn remarks_name_value_choice_and_user() {
        let parameters = Parameters {
            gauge: 1.5,
            rail_profile: "UIC60".to_owned(),
            ..Parameters::default()
        };
        let of_a_line = Parameters {
            contact_model: ContactModel::Patch,
            contact_width: 0.02,
            contact_nodes: 61,
            ..Parameters::default()
        };
        assert_eq!(
            of_a_line.without_effect(),
            [
                "contact_width = 0.02 has no effect with contact_model = 2 (patch); it is used where contact_model is line",
                "contact_nodes = 61 has no effect with contact_model = 2 (patch); it is used where contact_model is line",
            ]
        );
        assert_eq!(
            parameters.without_effect(),
            [
                "gauge = 1.5 has no effect with contact_model = 1 (line); it is used where contact_model is profiles",
                "rail_profile = UIC60 has no effect with contact_model = 1 (line); it is used where contact_model is profiles",
            ]
        );
        let smoothed = Parameters {
            contact_model: ContactModel::Profiles,
            profile_smoothing: 4e-3,
            ..Parameters::default()
        };
        let [remark] = &smoothed.without_effect()[..] else {
            panic!("one remark");
        };
        assert!(
            remark.starts_with("profile_smoothing = 0.004 has no effect: rail_profile = 60E1"),
            "{remark}"
        );
        let wearing = Parameters {
            wheel_profile_wear: ProfileWear::On,
            ..smoothed.clone()
        };
        let nothing = "wheel_profile_wear = 2 (on) has no effect with wheel_wear_law = 1 (coefficient) and wheel_wear_coefficient = 0";
        assert!(wearing.without_effect().contains(&nothing.to_owned()));
        let measured = Parameters {
            wheel_profile: "measured.prw".to_owned(),
            ..smoothed
        };
        assert!(measured.without_effect().is_empty());
    }
}
