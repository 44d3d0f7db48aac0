//! `wheelrail pack`: the archive WheelRailContact.fmu from `modelDescription/` and the shared library.

use clap::Args;
use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::{self, BufWriter, Read, Write};
use std::path::{Path, PathBuf};
use wheelrail::fmi2::description::model_description;
use wheelrail::fmi2::guid_of;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipArchive, ZipWriter};

/// Options of `pack`.
#[derive(Args)]
pub struct Pack {
    /// The shared library of this platform.
    #[arg(long, value_name = "FILE", default_value_os_t = default_library())]
    library: PathBuf,
    /// The folder with modelDescription.xml, documentation/, licenses/ and model.png.
    #[arg(long, value_name = "FOLDER", default_value = "modelDescription")]
    description: PathBuf,
    /// A library of another platform, as win64=wheelrail.dll or darwin64=libwheelrail.dylib.
    #[arg(long, value_name = "PLATFORM=FILE", value_parser = platform_and_file)]
    binary: Vec<(String, PathBuf)>,
    /// Another WheelRailContact.fmu of the same sources: its platforms are merged in.
    #[arg(long, value_name = "FMU")]
    merge: Vec<PathBuf>,
    /// Where the archive goes.
    #[arg(short, long, value_name = "FMU", default_value = "target/WheelRailContact.fmu")]
    output: PathBuf,
}

/// Why there is no archive.
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
        /// What the system says.
        source: io::Error,
    },
    /// An archive that cannot be read or written.
    #[error("{path}: {source}")]
    Archive {
        /// The archive.
        path: PathBuf,
        /// What is wrong.
        source: zip::result::ZipError,
    },
    /// The checked-in description is not what the variable table says.
    #[error("{path} is stale: run `wheelrail describe --xml > {path}` and build the library again")]
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
        /// Where the second one came from.
        path: PathBuf,
    },
}

type Entries = BTreeMap<String, Vec<u8>>;

impl Pack {
    /// Runs the command.
    pub fn run(&self) -> Result<(), Error> {
        let entries = self.entries()?;
        if let Some(folder) = self.output.parent() {
            fs::create_dir_all(folder).map_err(|source| file_error(folder, source))?;
        }
        let output = File::create(&self.output).map_err(|source| file_error(&self.output, source))?;
        write_archive(BufWriter::new(output), &entries).map_err(|source| archive_error(&self.output, source))?;
        let platforms: Vec<_> = entries
            .keys()
            .filter_map(|name| name.strip_prefix("binaries/"))
            .collect();
        eprintln!(
            "{}: {} files, {}",
            self.output.display(),
            entries.len(),
            platforms.join(", ")
        );
        Ok(())
    }

    /// Name in the archive and content.
    fn entries(&self) -> Result<Entries, Error> {
        let description = self.description.join("modelDescription.xml");
        let xml = read(&description)?;
        let generated = model_description()?;
        if xml != generated.as_bytes() {
            return Err(Error::StaleDescription { path: description });
        }
        let guid = guid_of(&generated);
        let mut entries = Entries::new();
        add_folder(&mut entries, &self.description.join("documentation"), "documentation/")?;
        add_folder(
            &mut entries,
            &self.description.join("licenses"),
            "documentation/licenses/",
        )?;
        entries.insert("model.png".to_owned(), read(&self.description.join("model.png"))?);
        add_library(&mut entries, &platform(), &self.library, guid)?;
        for (platform, path) in &self.binary {
            add_library(&mut entries, platform, path, guid)?;
        }
        for path in &self.merge {
            merge(&mut entries, path, &xml)?;
        }
        entries.insert("modelDescription.xml".to_owned(), xml);
        Ok(entries)
    }
}

fn add_library(entries: &mut Entries, platform: &str, path: &Path, guid: &str) -> Result<(), Error> {
    let library = read(path)?;
    if !library.windows(guid.len()).any(|window| window == guid.as_bytes()) {
        return Err(Error::StaleLibrary {
            path: path.to_owned(),
            guid: guid.to_owned(),
        });
    }
    let extension = match platform {
        _ if platform.starts_with("win") => "dll",
        _ if platform.starts_with("darwin") => "dylib",
        _ => "so",
    };
    insert_library(
        entries,
        format!("binaries/{platform}/wheelrail.{extension}"),
        library,
        path,
    )
}

/// Adds the binaries of another archive of the same sources.
fn merge(entries: &mut Entries, path: &Path, xml: &[u8]) -> Result<(), Error> {
    let archive = File::open(path).map_err(|source| file_error(path, source))?;
    let mut archive = ZipArchive::new(archive).map_err(|source| archive_error(path, source))?;
    let mut same_description = false;
    for index in 0..archive.len() {
        let mut entry = archive.by_index(index).map_err(|source| archive_error(path, source))?;
        let name = entry.name().map_err(|source| archive_error(path, source))?.into_owned();
        let mut content = Vec::new();
        entry
            .read_to_end(&mut content)
            .map_err(|source| file_error(path, source))?;
        if name == "modelDescription.xml" {
            same_description = content == xml;
        } else if name.starts_with("binaries/") && !name.contains("..") && entry.is_file() {
            insert_library(entries, name, content, path)?;
        }
    }
    if same_description {
        Ok(())
    } else {
        Err(Error::OtherDescription { path: path.to_owned() })
    }
}

fn insert_library(entries: &mut Entries, name: String, content: Vec<u8>, path: &Path) -> Result<(), Error> {
    match entries.get(&name) {
        Some(present) if *present != content => Err(Error::TwoLibraries {
            name,
            path: path.to_owned(),
        }),
        _ => {
            entries.insert(name, content);
            Ok(())
        }
    }
}

/// Adds the files of a folder and of the folders in it.
fn add_folder(entries: &mut Entries, folder: &Path, prefix: &str) -> Result<(), Error> {
    for item in fs::read_dir(folder).map_err(|source| file_error(folder, source))? {
        let item = item.map_err(|source| file_error(folder, source))?;
        let (path, name) = (item.path(), item.file_name().to_string_lossy().into_owned());
        if path.is_dir() {
            add_folder(entries, &path, &format!("{prefix}{name}/"))?;
        } else if !name.starts_with('.') {
            entries.insert(format!("{prefix}{name}"), read(&path)?);
        }
    }
    Ok(())
}

/// The same entries give the same bytes: sorted names, a fixed date, fixed permissions, one compression.
fn write_archive(output: impl Write + io::Seek, entries: &Entries) -> zip::result::ZipResult<()> {
    let mut archive = ZipWriter::new(output);
    let options = SimpleFileOptions::default()
        .compression_method(CompressionMethod::Deflated)
        .compression_level(Some(6))
        .last_modified_time(DateTime::default())
        .unix_permissions(0o644);
    for (name, content) in entries {
        let permissions = if name.starts_with("binaries/") { 0o755 } else { 0o644 };
        archive.start_file(name.as_str(), options.unix_permissions(permissions))?;
        archive.write_all(content)?;
    }
    archive.finish()?.flush()?;
    Ok(())
}

fn read(path: &Path) -> Result<Vec<u8>, Error> {
    fs::read(path).map_err(|source| file_error(path, source))
}

fn file_error(path: &Path, source: io::Error) -> Error {
    Error::File {
        path: path.to_owned(),
        source,
    }
}

fn archive_error(path: &Path, source: zip::result::ZipError) -> Error {
    Error::Archive {
        path: path.to_owned(),
        source,
    }
}

/// This platform's folder under binaries/.
fn platform() -> String {
    let system = match std::env::consts::OS {
        "windows" => "win",
        "macos" => "darwin",
        _ => "linux",
    };
    format!("{system}{}", usize::BITS)
}

/// Where `cargo build --release --lib --no-default-features --features fmi` leaves the library.
fn default_library() -> PathBuf {
    let name = format!(
        "{}wheelrail{}",
        std::env::consts::DLL_PREFIX,
        std::env::consts::DLL_SUFFIX
    );
    Path::new("target/release").join(name)
}

fn platform_and_file(text: &str) -> Result<(String, PathBuf), String> {
    match text.split_once('=') {
        Some((platform, file)) if !platform.is_empty() && platform.bytes().all(|byte| byte.is_ascii_alphanumeric()) => {
            Ok((platform.to_owned(), PathBuf::from(file)))
        }
        _ => Err("expected PLATFORM=FILE, for example win64=wheelrail.dll".to_owned()),
    }
}
