//! Reasons why there is no archive.

use std::io;
use std::path::PathBuf;

/// Reason why there is no archive.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The XML serializer.
    #[error("the model description could not be written as XML: {0}")]
    Xml(#[from] quick_xml::SeError),
    /// A file that cannot be read or written.
    #[error("{path}: {source}")]
    File {
        /// The file.
        path: PathBuf,
        /// Error of the system.
        source: io::Error,
    },
    /// An archive that cannot be read or written.
    #[error("{path}: {source}")]
    Archive {
        /// The archive.
        path: PathBuf,
        /// Error of the archive.
        source: zip::result::ZipError,
    },
    /// A profile that cannot be among the resources.
    #[error("{path}: {reason}; give the file another name")]
    Profile {
        /// The file.
        path: PathBuf,
        /// Reason in words.
        reason: String,
    },
    /// The checked-in description is not what the variable table says.
    #[error("{path} is stale: run `make description` and build the library again")]
    StaleDescription {
        /// The description.
        path: PathBuf,
    },
    /// The library was built with another description.
    #[error(
        "{path} was not built with this model description (GUID {guid}): build it again with `cargo build --release --lib --no-default-features --features fmi`"
    )]
    StaleLibrary {
        /// The library.
        path: PathBuf,
        /// The description's GUID.
        guid: String,
    },
    /// A file that is no library of any platform.
    #[error("{path} cannot be read as a shared library: {source}")]
    NoLibrary {
        /// The file.
        path: PathBuf,
        /// Error of the reader.
        source: object::Error,
    },
    /// A library of another platform than it is given for.
    #[error("{path} is {found}, which is no library of {platform}")]
    OtherPlatform {
        /// The library.
        path: PathBuf,
        /// Format and processors of the library.
        found: String,
        /// The platform that it is given for.
        platform: &'static str,
    },
    /// A library without some of the functions.
    #[error("{path} does not export {}", .missing.join(", "))]
    MissingFunctions {
        /// The library.
        path: PathBuf,
        /// The functions' names.
        missing: Vec<String>,
    },
    /// A platform in an archive that the standard has no name for.
    #[error("{path}: {reason}")]
    UnknownPlatform {
        /// The archive.
        path: PathBuf,
        /// The name, and those that there are.
        reason: String,
    },
    /// An archive to merge that has another description.
    #[error("{path} has another modelDescription.xml: only archives of the same sources can be merged")]
    OtherDescription {
        /// The archive.
        path: PathBuf,
    },
    /// Two libraries for one platform.
    #[error("{name} is there twice with different content; the second is from {path}")]
    TwoLibraries {
        /// The name in the archive.
        name: String,
        /// Path of the second one.
        path: PathBuf,
    },
}
