//! The model descriptions as elements and attributes.

use super::importer::{Fmi2, Fmi3, Standard};
use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};
use std::collections::{BTreeMap, HashMap};

pub type Attributes = BTreeMap<String, String>;

/// One element: its path, as `ModelVariables/ScalarVariable/Real`, and its attributes.
pub struct Element {
    pub path: String,
    pub attributes: Attributes,
}

fn attributes(tag: &BytesStart) -> Attributes {
    tag.attributes()
        .map(|attribute| {
            let attribute = attribute.expect("well-formed");
            (attribute.key.as_ref().to_owned(), attribute.value.into_owned())
        })
        .collect()
}

/// The generated text.
pub fn generated(standard: Standard) -> String {
    let text = match standard {
        Fmi2 => wheelrail::fmi2::description::model_description(),
        Fmi3 => wheelrail::fmi3::description::model_description(),
    };
    text.expect("a description")
}

/// The elements of a description.
pub fn elements(standard: Standard) -> Vec<Element> {
    elements_of(&generated(standard))
}

pub fn elements_of(xml: &str) -> Vec<Element> {
    let mut reader = Reader::from_str(xml);
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

/// The only element of a path.
pub fn element(standard: Standard, path: &str) -> Attributes {
    let mut found = elements(standard).into_iter().filter(|element| element.path == path);
    let element = found.next().expect(path);
    assert!(found.next().is_none(), "{path} twice");
    element.attributes
}

/// Attributes of the variables, in FMI 2.0 joined with those of their types; `type` is the type, that of real numbers being
/// `Real`. `key` is what the model structure calls the variable: its index, or its value reference.
pub fn variables(standard: Standard) -> Vec<Attributes> {
    let mut variables = Vec::<Attributes>::new();
    for element in elements(standard) {
        let Some(path) = element.path.strip_prefix("ModelVariables/") else {
            continue;
        };
        match (standard, path.split_once('/')) {
            (_, None) => {
                let mut variable = element.attributes;
                let kind = if path == "Float64" { "Real" } else { path };
                let key = match standard {
                    Fmi2 => (variables.len() + 1).to_string(),
                    Fmi3 => variable["valueReference"].clone(),
                };
                variable.extend([("type".to_owned(), kind.to_owned()), ("key".to_owned(), key)]);
                variables.push(variable);
            }
            (Fmi2, Some((_, kind))) => {
                let variable = variables.last_mut().expect("a variable");
                variable.insert("type".to_owned(), kind.to_owned());
                variable.extend(element.attributes);
            }
            (Fmi3, Some((_, "Start"))) => {
                let variable = variables.last_mut().expect("a variable");
                let start = element.attributes["value"].clone();
                assert!(variable.insert("start".to_owned(), start).is_none());
            }
            // The dimensions of an array, one after another.
            (Fmi3, Some((_, "Dimension"))) => {
                let (name, value) = element.attributes.into_iter().next().expect("a length");
                let dimensions = variables.last_mut().expect("a variable").entry("dimensions".to_owned());
                *dimensions.or_default() += &format!("{name}={value} ");
            }
            (Fmi3, Some(other)) => panic!("{other:?}"),
        }
    }
    variables
}

pub fn number(attributes: &Attributes, name: &str) -> Option<f64> {
    attributes.get(name).map(|text| text.parse().expect("a number"))
}

/// The start values, one for each element.
pub fn starts(variable: &Attributes) -> Vec<f64> {
    let text = variable.get("start").map_or("", String::as_str);
    text.split_whitespace()
        .map(|value| value.parse().expect("a number"))
        .collect()
}

/// Variable and dependencies of each unknown in a part of the model structure, by their keys.
pub fn unknowns(standard: Standard, part: &str) -> Vec<(String, Vec<String>)> {
    let (path, key) = match standard {
        Fmi2 => (format!("ModelStructure/{part}s/Unknown"), "index"),
        Fmi3 => (format!("ModelStructure/{part}"), "valueReference"),
    };
    elements(standard)
        .iter()
        .filter(|element| element.path == path)
        .map(|element| {
            let dependencies = element.attributes["dependencies"].split_whitespace();
            (
                element.attributes[key].clone(),
                dependencies.map(str::to_owned).collect(),
            )
        })
        .collect()
}

/// The units with their display units, by name.
pub fn units(standard: Standard) -> HashMap<String, Vec<String>> {
    let mut units = HashMap::<String, Vec<String>>::new();
    let mut last = String::new();
    for element in elements(standard) {
        match element.path.as_str() {
            "UnitDefinitions/Unit" => {
                last.clone_from(&element.attributes["name"]);
                assert!(units.insert(last.clone(), Vec::new()).is_none(), "{last} twice");
            }
            "UnitDefinitions/Unit/DisplayUnit" => {
                let (displays, name) = (units.get_mut(&last).expect("a unit"), &element.attributes["name"]);
                assert!(!displays.contains(name), "{name} twice");
                displays.push(name.clone());
            }
            _ => {}
        }
    }
    units
}
