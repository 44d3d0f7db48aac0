//! The model descriptions: they are those that are checked in, and they keep the rules that no validator looks at.

use super::document::{element, elements, elements_of, generated, number, starts, units, unknowns, variables};
use super::importer::{Fmi2, Fmi3, Standard};
use std::collections::HashSet;
use wheelrail::fmi3::terminals::terminals_and_icons;
use wheelrail::parameters::Parameters;
use wheelrail::signals::Outputs;

/// Takes a test once with each description. The last one that a failure prints is where it failed.
#[track_caller]
fn with_each_description(test: impl Fn(Standard)) {
    for standard in Standard::ALL {
        println!("{standard:?}");
        test(standard);
    }
}

#[test]
fn the_checked_in_descriptions_are_the_generated_ones() {
    let terminals = terminals_and_icons().expect("terminals");
    for (path, checked_in, generated) in [
        (
            "modelDescription.xml",
            include_str!("../../modelDescription/modelDescription.xml"),
            generated(Fmi2),
        ),
        (
            "fmi3/modelDescription.xml",
            include_str!("../../modelDescription/fmi3/modelDescription.xml"),
            generated(Fmi3),
        ),
        (
            "fmi3/terminalsAndIcons.xml",
            include_str!("../../modelDescription/fmi3/terminalsAndIcons.xml"),
            terminals,
        ),
    ] {
        assert!(
            checked_in == generated,
            "modelDescription/{path} is stale: run `make description` and commit what it changes"
        );
    }
    assert_eq!(wheelrail::fmi2::guid_of(&generated(Fmi2)), wheelrail::fmi2::GUID);
    let token = wheelrail::fmi3::INSTANTIATION_TOKEN;
    assert_eq!(wheelrail::fmi3::token_of(&generated(Fmi3)), token);
}

#[test]
fn the_token_is_well_formed_and_follows_the_content() {
    with_each_description(|standard| {
        let token = standard.token();
        let token = token.to_str().unwrap();
        let digits: Vec<usize> = token.trim_matches(['{', '}']).split('-').map(str::len).collect();
        assert_eq!((digits, token.len()), (vec![8, 4, 4, 4, 12], 38));
        assert_eq!(generated(standard), generated(standard));
    });
    assert_ne!(Fmi2.token(), Fmi3.token());
}

#[test]
fn header_and_capability_flags_are_as_specified() {
    with_each_description(|standard| {
        let elements = elements(standard);
        let root = &elements[0].attributes;
        let version = match standard {
            Fmi2 => "2.0",
            Fmi3 => "3.0",
        };
        assert_eq!(
            (root["fmiVersion"].as_str(), root["modelName"].as_str()),
            (version, "WheelRailContact")
        );
        assert_eq!(root["variableNamingConvention"], "structured");
        let flags = element(standard, "CoSimulation");
        assert_eq!(flags["modelIdentifier"], "wheelrail");
        assert_eq!(flags["maxOutputDerivativeOrder"], "1");
        let (on, off): (&[&str], &[&str]) = match standard {
            Fmi2 => (
                &[
                    "canHandleVariableCommunicationStepSize",
                    "canInterpolateInputs",
                    "canGetAndSetFMUstate",
                    "canSerializeFMUstate",
                    "providesDirectionalDerivative",
                ],
                &[
                    "canBeInstantiatedOnlyOncePerProcess",
                    "canRunAsynchronuously",
                    "canNotUseMemoryManagementFunctions",
                    "needsExecutionTool",
                ],
            ),
            Fmi3 => (
                &[
                    "canHandleVariableCommunicationStepSize",
                    "canGetAndSetFMUState",
                    "canSerializeFMUState",
                    "providesDirectionalDerivatives",
                    "providesAdjointDerivatives",
                    "mightReturnEarlyFromDoStep",
                ],
                &[
                    "canBeInstantiatedOnlyOncePerProcess",
                    "needsExecutionTool",
                    "hasEventMode",
                    "providesIntermediateUpdate",
                    "providesPerElementDependencies",
                    "canReturnEarlyAfterIntermediateUpdate",
                ],
            ),
        };
        assert!(on.iter().all(|name| flags[*name] == "true"), "{flags:?}");
        assert!(off.iter().all(|name| flags[*name] == "false"), "{flags:?}");
        assert!(
            elements
                .iter()
                .all(|element| !element.attributes.contains_key("canHandleMultipleSetPerTimeInstant"))
        );
        let others = ["ModelExchange", "ScheduledExecution"];
        assert!(elements.iter().all(|element| !others.contains(&element.path.as_str())));
    });
}

#[test]
fn causality_variability_and_initial_go_together() {
    with_each_description(|standard| {
        for variable in variables(standard) {
            let initial = variable.get("initial").map(String::as_str);
            let key = (
                variable["causality"].as_str(),
                variable["variability"].as_str(),
                initial,
            );
            let common = [
                ("output", "continuous", Some("calculated")),
                ("parameter", "fixed", Some("exact")),
                ("parameter", "tunable", Some("exact")),
                ("local", "continuous", Some("calculated")),
                ("local", "discrete", Some("calculated")),
            ];
            // An input has its start value until it is set; FMI 2.0 has no word for that.
            let own: &[_] = match standard {
                Fmi2 => &[("input", "continuous", None)],
                Fmi3 => &[
                    ("input", "continuous", Some("exact")),
                    ("structuralParameter", "fixed", Some("exact")),
                    ("independent", "continuous", None),
                ],
            };
            assert!(common.iter().chain(own).any(|legal| *legal == key), "{variable:?}");
            let has_start = variable.contains_key("start");
            let is_set = matches!(key.0, "input" | "parameter" | "structuralParameter");
            assert_eq!(has_start, is_set, "{variable:?}");
            assert!(variable["type"] == "Real" || key.1 != "continuous", "{variable:?}");
        }
    });
}

#[test]
fn start_values_lie_within_their_range_and_nominals_are_positive() {
    with_each_description(|standard| {
        for variable in variables(standard) {
            let (minimum, maximum) = (number(&variable, "min"), number(&variable, "max"));
            if let (Some(minimum), Some(maximum)) = (minimum, maximum) {
                assert!(minimum < maximum, "{variable:?}");
            }
            if !["Boolean", "String"].contains(&variable["type"].as_str()) {
                for start in starts(&variable) {
                    assert!(minimum.is_none_or(|minimum| start >= minimum), "{variable:?}");
                    assert!(maximum.is_none_or(|maximum| start <= maximum), "{variable:?}");
                }
            }
            assert!(
                number(&variable, "nominal").is_none_or(|nominal| nominal > 0.0),
                "{variable:?}"
            );
        }
    });
}

#[test]
fn start_values_are_those_of_the_model() {
    with_each_description(|standard| {
        let variables = variables(standard);
        let start = |name: &str| {
            let variable = variables.iter().find(|variable| variable["name"] == name).expect(name);
            number(variable, "start").expect(name)
        };
        let parameters = Parameters::default();
        assert_eq!(start("lame_lambda"), parameters.lame_lambda);
        assert_eq!(start("wear_coefficient"), 0.5e-12);
        assert_eq!(start("friction_temperature_hot"), 423.15);
        assert_eq!(start("contact_nodes"), 51.0);
        assert_eq!(start("ambient_temperature"), 293.15);
        assert_eq!(start("friction_scale"), 1.0);
        assert_eq!(start("patch_strips"), 21.0);
        for (name, expected) in [("rail_profile", "60E1"), ("wheel_profile", "S1002")] {
            let variable = variables.iter().find(|variable| variable["name"] == name).expect(name);
            assert_eq!(
                (variable["type"].as_str(), variable["start"].as_str()),
                ("String", expected)
            );
        }
    });
}

#[test]
fn every_unit_and_display_unit_is_defined_and_every_real_has_a_unit() {
    with_each_description(|standard| {
        let units = units(standard);
        let mut used = HashSet::new();
        for variable in variables(standard).iter().filter(|variable| variable["type"] == "Real") {
            let displays = units
                .get(&variable["unit"])
                .unwrap_or_else(|| panic!("src/fmi/units.rs lacks the unit of {variable:?}"));
            used.insert(variable["unit"].clone());
            if let Some(display) = variable.get("displayUnit") {
                assert!(
                    displays.contains(display),
                    "src/fmi/units.rs lacks the display unit of {variable:?}"
                );
            }
        }
        // Time is no variable of FMI 2.0.
        used.insert("s".to_owned());
        assert_eq!(used.len(), units.len(), "every unit is used");
    });
}

#[test]
fn display_units_convert_as_a_person_expects() {
    with_each_description(|standard| {
        let elements = elements(standard);
        let convert = |name: &str, value: f64| {
            let display = elements
                .iter()
                .find(|element| element.path.ends_with("/DisplayUnit") && element.attributes["name"] == name);
            let display = &display.expect(name).attributes;
            number(display, "factor").unwrap() * value + number(display, "offset").unwrap_or(0.0)
        };
        for (name, value, expected) in [
            ("degC", 293.15, 20.0),
            ("km/h", 10.0, 36.0),
            ("rpm", std::f64::consts::TAU, 60.0),
            ("mm", 0.001, 1.0),
            ("µm", 1e-6, 1.0),
            ("MPa", 1e6, 1.0),
            ("kN", 6e4, 60.0),
            ("%", 0.01, 1.0),
            ("ms", 0.25, 250.0),
        ] {
            assert!((convert(name, value) - expected).abs() < 1e-12, "{name}");
        }
    });
}

#[test]
fn names_are_structured_and_descriptions_are_one_sentence() {
    with_each_description(|standard| {
        for variable in variables(standard) {
            let name = &variable["name"];
            let legal = |c: char| c.is_ascii_alphanumeric() || "_.[]".contains(c);
            assert!(
                name.chars().all(legal) && name.starts_with(|c: char| c.is_ascii_lowercase()),
                "{name}"
            );
            let description = &variable["description"];
            assert!(
                !description.is_empty() && !description.contains(". ") && !description.ends_with('.'),
                "{name}"
            );
        }
    });
}

#[test]
fn the_default_experiment_stops_after_its_start() {
    with_each_description(|standard| {
        let experiment = element(standard, "DefaultExperiment");
        let value = |name| number(&experiment, name).expect(name);
        assert!(value("stopTime") > value("startTime"));
        assert!(value("stepSize") > 0.0);
    });
}

#[test]
fn log_categories_are_the_specified_ones() {
    with_each_description(|standard| {
        let elements = elements(standard);
        let categories = elements
            .iter()
            .filter(|element| element.path == "LogCategories/Category");
        let names: Vec<_> = categories.map(|element| element.attributes["name"].as_str()).collect();
        assert_eq!(names, ["logStatusError", "logStatusWarning", "logSolver", "logEvents"]);
    });
}

#[test]
fn the_model_structure_is_complete_and_in_order() {
    with_each_description(|standard| {
        let variables = variables(standard);
        let keys = |causalities: &[&str]| -> Vec<String> {
            let wanted = variables
                .iter()
                .filter(|variable| causalities.contains(&variable["causality"].as_str()));
            wanted.map(|variable| variable["key"].clone()).collect()
        };
        // In the order of the variables.
        let position = |key: &String| variables.iter().position(|variable| variable["key"] == *key);
        let outputs = keys(&["output"]);
        for (part, allowed) in [
            ("Output", keys(&["input"])),
            ("InitialUnknown", keys(&["input", "parameter", "structuralParameter"])),
        ] {
            let unknowns = unknowns(standard, part);
            let listed: Vec<String> = unknowns.iter().map(|(key, _)| key.clone()).collect();
            assert_eq!(listed, outputs, "{part}: every output, ascending");
            for (key, dependencies) in unknowns {
                assert!(dependencies.iter().map(position).is_sorted(), "{part} {key}");
                assert!(
                    dependencies.iter().all(|dependency| allowed.contains(dependency)),
                    "{part} {key}"
                );
                // At a communication point a sum over the steps depends on no input.
                let variable = variables.iter().find(|variable| variable["key"] == key).unwrap();
                let name = variable["name"].as_str();
                let is_total = Outputs::totals().any(|total| total.name == name);
                assert_eq!(dependencies.is_empty(), is_total, "{part} {name}");
            }
        }
    });
}

/// FMI 3.0: arrays as one variable each.
#[test]
fn there_are_fewer_than_250_variables_each_under_a_name_and_a_reference_of_its_own() {
    let variables = variables(Fmi3);
    println!("{} variables", variables.len());
    assert!(variables.len() < 250, "{}", variables.len());
    for attribute in ["name", "valueReference"] {
        let values: HashSet<_> = variables.iter().map(|variable| &variable[attribute]).collect();
        assert_eq!(values.len(), variables.len(), "{attribute}");
    }
    let time = variables.iter().find(|variable| variable["causality"] == "independent");
    let time = time.expect("time");
    assert_eq!((time["name"].as_str(), time["unit"].as_str()), ("time", "s"));
}

/// FMI 3.0: lengths are numbers or structural parameters, which are positive; an array has as many start values as elements.
#[test]
fn dimensions_are_numbers_or_structural_parameters() {
    let variables = variables(Fmi3);
    let (mut given, mut resized) = (0, 0);
    for variable in &variables {
        let Some(dimensions) = variable.get("dimensions") else {
            assert!(starts_count(variable) <= 1, "{variable:?}");
            continue;
        };
        let mut elements = 1;
        for dimension in dimensions.split_whitespace() {
            match dimension.split_once('=').expect("a length") {
                ("start", length) => {
                    given += 1;
                    elements *= length.parse::<usize>().expect("a number");
                }
                ("valueReference", reference) => {
                    resized += 1;
                    let length = variables
                        .iter()
                        .find(|variable| variable["valueReference"] == reference);
                    let length = length.expect("a variable");
                    assert_eq!(
                        (length["causality"].as_str(), length["type"].as_str()),
                        ("structuralParameter", "UInt64")
                    );
                    assert!(starts(length)[0] > 0.0 && number(length, "min").unwrap() > 0.0);
                }
                other => panic!("{other:?}"),
            }
        }
        let expected = if variable["causality"] == "parameter" {
            elements
        } else {
            0
        };
        assert_eq!(starts_count(variable), expected, "{variable:?}");
    }
    assert!(given >= 15 && resized >= 9, "{given} {resized}");
}

fn starts_count(variable: &super::document::Attributes) -> usize {
    let text = variable.get("start").map_or("", String::as_str);
    text.split_whitespace().count()
}

/// FMI 3.0: every choice has a type with the names of its values, from 1 on, that its range is.
#[test]
fn choices_have_types_with_names() {
    let mut items = Vec::<(String, Vec<f64>)>::new();
    for element in elements(Fmi3) {
        match element.path.as_str() {
            "TypeDefinitions/EnumerationType" => items.push((element.attributes["name"].clone(), Vec::new())),
            "TypeDefinitions/EnumerationType/Item" => {
                let (_, values) = items.last_mut().expect("a type");
                values.push(number(&element.attributes, "value").expect("a value"));
            }
            _ => {}
        }
    }
    let names: HashSet<_> = items.iter().map(|(name, _)| name).collect();
    assert_eq!(names.len(), items.len());
    let mut used = HashSet::new();
    for variable in variables(Fmi3) {
        if variable["type"] != "Enumeration" {
            assert!(!variable.contains_key("declaredType"));
            continue;
        }
        let (_, values) = items
            .iter()
            .find(|(name, _)| *name == variable["declaredType"])
            .expect("a type");
        let ascending: Vec<f64> = (1..=values.len()).map(|value| value as f64).collect();
        assert_eq!(*values, ascending);
        assert_eq!(
            (number(&variable, "min"), number(&variable, "max")),
            (Some(1.0), values.last().copied())
        );
        used.insert(variable["declaredType"].clone());
    }
    assert_eq!(used.len(), items.len(), "every type is used");
}

/// FMI 3.0: the members of terminals are inputs and outputs of the description; the rail behind a wheel has the members of the rail
/// before the next one.
#[test]
fn terminals_group_inputs_and_outputs() {
    let variables = variables(Fmi3);
    let mut terminals = Vec::<(String, Vec<(String, String)>)>::new();
    for element in elements_of(&terminals_and_icons().expect("terminals")) {
        let attribute = |name: &str| element.attributes[name].clone();
        match element.path.as_str() {
            "Terminals/Terminal" => terminals.push((attribute("name"), Vec::new())),
            "Terminals/Terminal/TerminalMemberVariable" => {
                let (_, members) = terminals.last_mut().expect("a terminal");
                members.push((attribute("memberName"), attribute("variableName")));
            }
            _ => {}
        }
    }
    let names: Vec<_> = terminals.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(names, ["wheel", "axle", "rail_before", "rail_behind"]);
    for (name, members) in &terminals {
        assert!(!members.is_empty(), "{name}");
        for (_, variable) in members {
            let found = variables.iter().find(|row| row["name"] == *variable).expect(variable);
            assert!(
                ["input", "output"].contains(&found["causality"].as_str()),
                "{name}: {variable}"
            );
        }
    }
    let members = |terminal: usize| {
        terminals[terminal]
            .1
            .iter()
            .map(|(member, _)| member)
            .collect::<Vec<_>>()
    };
    assert_eq!(members(2), members(3));
}
