//! Reasons why there is no archive.

use std::io;
use std::path::PathBuf;

/// Reason why there is no archive.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The XML serializer.
    #[error("the model description could not be written as XML: {0}")]
    Xml(#[from] quick_xml::SeError),
    /// An archive that is not to be written.
    #[error(transparent)]
    Files(#[from] crate::files::Error),
    /// A folder of the sources that is not there: with an installed command line it never is.
    #[error(
        "--description {path}: this folder is not there; an FMU is packed from wheelrail's sources: run this in a clone of them, or name its folder modelDescription. To put a profile into an FMU that is there, as the Python package's (wheelrail.fmu_path()), add its file to a copy's folder resources: `zip my.fmu resources/my.prr`"
    )]
    NoDescription {
        /// The folder.
        path: PathBuf,
    },
    /// A library that is not where it is looked for.
    #[error(
        "there is no shared library for the FMU, neither {beside} nor {made}: `make library` in a clone of wheelrail builds it, or name one with --library"
    )]
    LibraryNotFound {
        /// Path beside the program.
        beside: PathBuf,
        /// Path where `make` puts it.
        made: PathBuf,
    },
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
    /// A file that is no profile of the body that it is given for.
    #[error("{option} {path}: {source}")]
    NoProfile {
        /// Option that names it.
        option: &'static str,
        /// The file.
        path: PathBuf,
        /// Reason, as `wheelrail profile` has it.
        source: Box<crate::profile::Error>,
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
