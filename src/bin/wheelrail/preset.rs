//! Named sets of parameters, `presets/*.toml`: `wheelrail presets` lists them, `wheelrail simulate --preset` takes one.

use crate::names::{did_you_mean, hint};
use clap::Args;
use serde::Deserialize;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use toml::Value;
use wheelrail::{Error as ModelError, Parameters};

macro_rules! shipped {
    ($($name:literal)+) => {
        &[$(($name, include_str!(concat!("../../../presets/", $name, ".toml")))),+]
    };
}

/// Name and text of those that the command line knows.
const SHIPPED: &[(&str, &str)] = shipped! { "dry" "wet" "contaminated" "eurosprinter" };

/// Options of `presets`.
#[derive(Args)]
pub struct Presets {
    /// Print this one, with where each value comes from.
    name: Option<String>,
}

/// Reason why a set of parameters does not serve.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// Name of a preset that is neither known nor that of a file.
    #[error(
        "preset {name:?}: there is none of this name ({known}), and the name of a file ends with .toml{meant}",
        known = names().join(", "),
        meant = did_you_mean(name, names())
    )]
    Unknown {
        /// Name that was given.
        name: String,
    },
    /// A file that cannot be read.
    #[error("preset {path}: {source}", path = path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// The reason.
        source: io::Error,
    },
    /// A text that is no set of parameters.
    #[error("preset {name}: {source}")]
    Text {
        /// Name or file.
        name: String,
        /// Place in the file, and the reason.
        source: Box<toml::de::Error>,
    },
    /// A value that is neither a number nor the name of a choice.
    #[error("preset {name}: {parameter} is of the kind {kind}, neither a number nor the name of a choice")]
    Value {
        /// Name or file.
        name: String,
        /// The parameter.
        parameter: String,
        /// Kind of the value, as TOML calls it.
        kind: &'static str,
    },
    /// A parameter that cannot be.
    #[error("preset {name}: {source}{}", hint(source))]
    Parameter {
        /// Name or file.
        name: String,
        /// Parameter that is refused, and the reason.
        source: ModelError,
    },
    /// Standard output.
    #[error("standard output: {0}")]
    Output(#[from] io::Error),
}

/// One set.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Preset {
    title: String,
    source: String,
    parameters: toml::Table,
}

impl Preset {
    fn parse(name: &str, text: &str) -> Result<Preset, Error> {
        toml::from_str(text).map_err(|source| Error::Text {
            name: name.to_owned(),
            source: Box::new(source),
        })
    }
}

/// Sets what a set of parameters, by name or in a file, says; the others stay as they are. Returns its title.
pub fn set(parameters: &mut Parameters, name: &str) -> Result<String, Error> {
    let preset = Preset::parse(name, &text(name)?)?;
    for (parameter, value) in preset.parameters {
        let text = match &value {
            Value::String(text) => text.clone(),
            Value::Integer(number) => number.to_string(),
            // All its digits.
            Value::Float(number) => format!("{number:?}"),
            _ => {
                let (name, kind) = (name.to_owned(), value.type_str());
                return Err(Error::Value { name, parameter, kind });
            }
        };
        parameters
            .set_by_name(&parameter, &text)
            .map_err(|source| Error::Parameter {
                name: name.to_owned(),
                source,
            })?;
    }
    Ok(preset.title)
}

/// Path of the file that a name means, if it means one.
pub fn file(name: &str) -> Option<&Path> {
    let is_shipped = SHIPPED.iter().any(|(shipped, _)| *shipped == name);
    (!is_shipped && name.ends_with(".toml")).then(|| Path::new(name))
}

fn text(name: &str) -> Result<String, Error> {
    if let Some((_, text)) = SHIPPED.iter().find(|(shipped, _)| *shipped == name) {
        return Ok((*text).to_owned());
    }
    let path = file(name).ok_or_else(|| Error::Unknown { name: name.to_owned() })?;
    fs::read_to_string(path).map_err(|source| Error::File {
        path: path.to_owned(),
        source,
    })
}

fn names() -> Vec<&'static str> {
    SHIPPED.iter().map(|(name, _)| *name).collect()
}

impl Presets {
    /// Runs the command.
    pub fn run(&self) -> Result<(), Error> {
        let mut out = io::stdout().lock();
        if let Some(name) = &self.name {
            out.write_all(text(name)?.as_bytes())?;
            return Ok(());
        }
        for (name, text) in SHIPPED {
            let preset = Preset::parse(name, text)?;
            writeln!(out, "{name:<14}{}. {}", preset.title, preset.source)?;
        }
        Ok(())
    }
}
