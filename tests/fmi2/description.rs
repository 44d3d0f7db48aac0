//! The model description: it is the one that is checked in, and it keeps the rules that no validator looks at.

use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};
use std::collections::{BTreeMap, HashMap, HashSet};
use wheelrail::fmi2::description::model_description;
use wheelrail::fmi2::{GUID, guid_of};
use wheelrail::parameters::Parameters;
use wheelrail::signals::Outputs;

type Attributes = BTreeMap<String, String>;

/// One element: its path, as `ModelVariables/ScalarVariable/Real`, and its attributes.
struct Element {
    path: String,
    attributes: Attributes,
}

fn attributes(tag: &BytesStart) -> Attributes {
    tag.attributes()
        .map(|attribute| {
            let attribute = attribute.expect("well-formed");
            (attribute.key.as_ref().to_owned(), attribute.value.into_owned())
        })
        .collect()
}

fn elements() -> Vec<Element> {
    let xml = model_description().expect("a description");
    let mut reader = Reader::from_str(&xml);
    let (mut path, mut elements) = (Vec::<String>::new(), Vec::new());
    loop {
        let event = reader.read_event().expect("well-formed");
        let (tag, empty) = match &event {
            Event::Start(tag) => (tag, false),
            Event::Empty(tag) => (tag, true),
            Event::End(_) => {
                path.pop();
                continue;
            }
            Event::Eof => return elements,
            _ => continue,
        };
        path.push(tag.name().as_ref().to_owned());
        elements.push(Element {
            path: path[1..].join("/"),
            attributes: attributes(tag),
        });
        if empty {
            path.pop();
        }
    }
}

/// Attributes of a scalar variable, joined with those of its type; `type` is the type.
fn scalar_variables() -> Vec<Attributes> {
    let mut variables = Vec::<Attributes>::new();
    for element in elements() {
        match element.path.strip_prefix("ModelVariables/ScalarVariable") {
            Some("") => variables.push(element.attributes),
            Some(kind) => {
                let variable = variables.last_mut().expect("a variable");
                variable.insert("type".to_owned(), kind.trim_start_matches('/').to_owned());
                variable.extend(element.attributes);
            }
            None => {}
        }
    }
    variables
}

fn number(attributes: &Attributes, name: &str) -> Option<f64> {
    attributes.get(name).map(|text| text.parse().expect("a number"))
}

/// Index and dependencies of each Unknown in a part of the model structure.
fn unknowns(part: &str) -> Vec<(usize, Vec<usize>)> {
    let path = format!("ModelStructure/{part}/Unknown");
    let parse = |text: &str| text.parse::<usize>().expect("an index");
    elements()
        .iter()
        .filter(|element| element.path == path)
        .map(|element| {
            let dependencies = element.attributes["dependencies"]
                .split_whitespace()
                .map(parse)
                .collect();
            (parse(&element.attributes["index"]), dependencies)
        })
        .collect()
}

#[test]
fn the_checked_in_description_is_the_generated_one() {
    let checked_in = include_str!("../../modelDescription/modelDescription.xml");
    let generated = model_description().expect("a description");
    assert!(
        checked_in == generated,
        "modelDescription/modelDescription.xml is stale: run `make description` and commit what it changes"
    );
    assert_eq!(guid_of(&generated), GUID);
}

#[test]
fn the_guid_is_well_formed_and_follows_the_content() {
    let digits: Vec<usize> = GUID.trim_matches(['{', '}']).split('-').map(str::len).collect();
    assert_eq!((digits, GUID.len()), (vec![8, 4, 4, 4, 12], 38));
    assert_eq!(model_description().unwrap(), model_description().unwrap());
}

#[test]
fn header_and_capability_flags_are_as_specified() {
    let elements = elements();
    let root = &elements[0].attributes;
    assert_eq!(
        (root["fmiVersion"].as_str(), root["modelName"].as_str()),
        ("2.0", "WheelRailContact")
    );
    assert_eq!(root["variableNamingConvention"], "structured");
    let flags = &elements
        .iter()
        .find(|element| element.path == "CoSimulation")
        .expect("CoSimulation")
        .attributes;
    assert_eq!(flags["modelIdentifier"], "wheelrail");
    for name in [
        "canHandleVariableCommunicationStepSize",
        "canInterpolateInputs",
        "canGetAndSetFMUstate",
        "canSerializeFMUstate",
        "providesDirectionalDerivative",
    ] {
        assert_eq!(flags[name], "true", "{name}");
    }
    assert_eq!(flags["maxOutputDerivativeOrder"], "1");
    for name in [
        "canBeInstantiatedOnlyOncePerProcess",
        "canRunAsynchronuously",
        "canNotUseMemoryManagementFunctions",
        "needsExecutionTool",
    ] {
        assert_eq!(flags[name], "false", "{name}");
    }
    assert!(
        elements
            .iter()
            .all(|element| !element.attributes.contains_key("canHandleMultipleSetPerTimeInstant"))
    );
    assert!(elements.iter().all(|element| element.path != "ModelExchange"));
}

#[test]
fn causality_variability_and_initial_go_together() {
    for variable in scalar_variables() {
        let initial = variable.get("initial").map(String::as_str);
        let key = (
            variable["causality"].as_str(),
            variable["variability"].as_str(),
            initial,
        );
        let legal = [
            ("input", "continuous", None),
            ("output", "continuous", Some("calculated")),
            ("parameter", "fixed", Some("exact")),
            ("parameter", "tunable", Some("exact")),
            ("local", "continuous", Some("calculated")),
            ("local", "discrete", Some("calculated")),
        ];
        assert!(legal.contains(&key), "{variable:?}");
        let has_start = variable.contains_key("start");
        assert_eq!(has_start, matches!(key.0, "input" | "parameter"), "{variable:?}");
        assert!(variable["type"] == "Real" || key.1 != "continuous", "{variable:?}");
    }
}

#[test]
fn start_values_lie_within_their_range_and_nominals_are_positive() {
    for variable in scalar_variables() {
        let (minimum, maximum) = (number(&variable, "min"), number(&variable, "max"));
        if let (Some(minimum), Some(maximum)) = (minimum, maximum) {
            assert!(minimum < maximum, "{variable:?}");
        }
        if let Some(start) = number(&variable, "start") {
            assert!(minimum.is_none_or(|minimum| start >= minimum), "{variable:?}");
            assert!(maximum.is_none_or(|maximum| start <= maximum), "{variable:?}");
        }
        assert!(
            number(&variable, "nominal").is_none_or(|nominal| nominal > 0.0),
            "{variable:?}"
        );
    }
}

#[test]
fn start_values_are_those_of_the_model() {
    let variables = scalar_variables();
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
}

#[test]
fn every_unit_and_display_unit_is_defined_and_every_real_has_a_unit() {
    let mut units = HashMap::<String, HashSet<String>>::new();
    let mut last = String::new();
    for element in elements() {
        match element.path.as_str() {
            "UnitDefinitions/Unit" => {
                last.clone_from(&element.attributes["name"]);
                assert!(units.insert(last.clone(), HashSet::new()).is_none(), "{last} twice");
            }
            "UnitDefinitions/Unit/DisplayUnit" => {
                let displays = units.get_mut(&last).expect("a unit");
                assert!(displays.insert(element.attributes["name"].clone()));
            }
            _ => {}
        }
    }
    let mut used = HashSet::new();
    for variable in scalar_variables().iter().filter(|variable| variable["type"] == "Real") {
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
    assert_eq!(used.len(), units.len(), "every unit is used");
}

#[test]
fn display_units_convert_as_a_person_expects() {
    let elements = elements();
    let convert = |name: &str, value: f64| {
        let is_it = |e: &&Element| e.path.ends_with("/DisplayUnit") && e.attributes["name"] == name;
        let display = &elements.iter().find(is_it).expect(name).attributes;
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
    ] {
        assert!((convert(name, value) - expected).abs() < 1e-12, "{name}");
    }
}

#[test]
fn names_are_structured_and_descriptions_are_one_sentence() {
    for variable in scalar_variables() {
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
}

#[test]
fn the_default_experiment_stops_after_its_start() {
    let elements = elements();
    let experiment = elements
        .iter()
        .find(|element| element.path == "DefaultExperiment")
        .expect("an experiment");
    let value = |name| number(&experiment.attributes, name).expect(name);
    assert!(value("stopTime") > value("startTime"));
    assert!(value("stepSize") > 0.0);
}

#[test]
fn log_categories_are_the_specified_ones() {
    let elements = elements();
    let categories = elements
        .iter()
        .filter(|element| element.path == "LogCategories/Category");
    let names: Vec<_> = categories.map(|element| element.attributes["name"].as_str()).collect();
    assert_eq!(names, ["logStatusError", "logStatusWarning", "logSolver", "logEvents"]);
}

#[test]
fn the_model_structure_is_complete_and_in_order() {
    let variables = scalar_variables();
    let indices = |causalities: &[&str]| -> Vec<usize> {
        let wanted = |(_, variable): &(usize, &Attributes)| causalities.contains(&variable["causality"].as_str());
        (1..).zip(&variables).filter(wanted).map(|(index, _)| index).collect()
    };
    let outputs = indices(&["output"]);
    for (part, allowed) in [
        ("Outputs", indices(&["input"])),
        ("InitialUnknowns", indices(&["input", "parameter"])),
    ] {
        let unknowns = unknowns(part);
        let listed: Vec<usize> = unknowns.iter().map(|(index, _)| *index).collect();
        assert_eq!(listed, outputs, "{part}: every output, ascending");
        for (index, dependencies) in unknowns {
            assert!(dependencies.is_sorted(), "{part} {index}");
            assert!(
                dependencies.iter().all(|dependency| allowed.contains(dependency)),
                "{part} {index}"
            );
            // At a communication point a sum over the steps depends on no input.
            let name = variables[index - 1]["name"].as_str();
            let is_total = Outputs::totals().any(|total| total.name == name);
            assert_eq!(dependencies.is_empty(), is_total, "{part} {name}");
        }
    }
}
