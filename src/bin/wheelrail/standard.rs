//! The versions of FMI, as the command line names them.

use clap::ValueEnum;
use quick_xml::SeError;
use std::path::PathBuf;
use wheelrail::{fmi2, fmi3};

/// A version of FMI.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Standard {
    /// FMI 2.0.
    #[value(name = "2")]
    Fmi2,
    /// FMI 3.0.
    #[value(name = "3")]
    Fmi3,
}

impl Standard {
    /// The text of modelDescription.xml.
    pub fn model_description(self) -> Result<String, SeError> {
        match self {
            Standard::Fmi2 => fmi2::description::model_description(),
            Standard::Fmi3 => fmi3::description::model_description(),
        }
    }

    /// The mark of a model description that the library of the same build carries.
    pub fn token_of(self, xml: &str) -> &str {
        match self {
            Standard::Fmi2 => fmi2::guid_of(xml),
            Standard::Fmi3 => fmi3::token_of(xml),
        }
    }

    /// The folder of the checked-in description, in that of all descriptions.
    pub fn folder(self) -> &'static str {
        match self {
            Standard::Fmi2 => "",
            Standard::Fmi3 => "fmi3",
        }
    }

    /// The function that any importer begins with.
    pub fn first_function(self) -> &'static str {
        match self {
            Standard::Fmi2 => "fmi2Instantiate",
            Standard::Fmi3 => "fmi3InstantiateCoSimulation",
        }
    }

    /// The name of this machine's platform.
    pub fn own_platform(self) -> String {
        match (self, std::env::consts::OS) {
            (Standard::Fmi2, "windows") => format!("win{}", usize::BITS),
            (Standard::Fmi2, "macos") => format!("darwin{}", usize::BITS),
            (Standard::Fmi2, _) => format!("linux{}", usize::BITS),
            (Standard::Fmi3, "macos") => format!("{}-darwin", std::env::consts::ARCH),
            (Standard::Fmi3, system) => format!("{}-{system}", std::env::consts::ARCH),
        }
    }

    /// Path of the archive if not told otherwise.
    pub fn default_output(self) -> PathBuf {
        PathBuf::from(match self {
            Standard::Fmi2 => "target/WheelRailContact.fmu",
            Standard::Fmi3 => "target/WheelRailContact-fmi3.fmu",
        })
    }
}
