//! The versions of FMI, as the command line names them.

use clap::ValueEnum;
use quick_xml::SeError;
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
}
