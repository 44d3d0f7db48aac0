//! `wheelrail pack`: the archive WheelRailContact.fmu, or that of FMI 3.0, from `modelDescription/` and the shared library.

mod error;

use crate::binary::{Binary, Platform};
use crate::files::Files;
use crate::profile;
use crate::standard::Standard;
use clap::Args;
use std::collections::{BTreeMap, BTreeSet};
use std::fs::{self, File};
use std::io::{self, BufWriter, Read, Write};
use std::path::{Path, PathBuf};
use wheelrail::Body;
use wheelrail::fmi3::terminals::terminals_and_icons;
use wheelrail::parameters::ProfileSource;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipArchive, ZipWriter};

pub use error::Error;

/// Options of `pack`.
#[derive(Args)]
pub struct Pack {
    /// The shared library of this platform; if not told, that beside this program or in the folder library beside its folder: the
    /// one that was built last.
    #[arg(long, value_name = "FILE")]
    library: Option<PathBuf>,
    /// The folder with modelDescription.xml, documentation/, licenses/ and model.png, which is among the sources.
    #[arg(long, value_name = "FOLDER", default_value = "modelDescription")]
    description: PathBuf,
    /// The version of FMI.
    #[arg(long, value_name = "VERSION", default_value = "2")]
    fmi: Standard,
    /// A library of another platform under its name in the standard, as win64=wheelrail.dll or aarch64-linux=libwheelrail.so.
    #[arg(long, value_name = "PLATFORM=FILE", value_parser = platform_and_file)]
    binary: Vec<(String, PathBuf)>,
    /// Another WheelRailContact.fmu of the same sources: its platforms are merged in.
    #[arg(long, value_name = "FMU")]
    merge: Vec<PathBuf>,
    /// A rail's profile to put among the resources, read before as the unit reads it: the file's name is then what rail_profile may be. Repeatable.
    #[arg(long, value_name = "FILE")]
    rail_profile: Vec<PathBuf>,
    /// A wheel's profile to put among the resources, read before as the unit reads it: the file's name is then what wheel_profile may be. Repeatable.
    #[arg(long, value_name = "FILE")]
    wheel_profile: Vec<PathBuf>,
    /// File of the archive; target/WheelRailContact.fmu, or -fmi3.fmu, if not told.
    #[arg(short, long, value_name = "FMU")]
    output: Option<PathBuf>,
}

/// Entry of the archive that says what compiled each library.
const BUILD: &str = "documentation/build.txt";
/// Name of the file that FMI 3.0 has beside the description.
const TERMINALS: &str = "terminalsAndIcons.xml";
const NOT_RECORDED: &str = "not recorded";

/// Name in the archive and content.
type Entries = BTreeMap<String, Vec<u8>>;

impl Pack {
    /// Runs the command.
    pub fn run(&self) -> Result<(), Error> {
        if !self.description.is_dir() {
            let path = self.description.clone();
            return Err(Error::NoDescription { path });
        }
        let library = self.library.clone().map_or_else(default_library, Ok)?;
        let path = self.output.clone().unwrap_or_else(|| self.fmi.default_output());
        self.check_files(&library, &path)?;
        let entries = self.entries(&library)?;
        if let Some(folder) = path.parent() {
            fs::create_dir_all(folder).map_err(|source| file_error(folder, source))?;
        }
        let output = File::create(&path).map_err(|source| file_error(&path, source))?;
        write_archive(BufWriter::new(output), &entries).map_err(|source| archive_error(&path, source))?;
        let platforms: Vec<_> = entries
            .keys()
            .filter_map(|name| name.strip_prefix("binaries/"))
            .collect();
        eprintln!("{}: {} files, {}", path.display(), entries.len(), platforms.join(", "));
        Ok(())
    }

    /// Refuses an archive that would overwrite something that is packed into it.
    fn check_files(&self, library: &Path, output: &Path) -> Result<(), Error> {
        let mut files = Files::default();
        files.reads("--library", Some(library));
        for (_, path) in &self.binary {
            files.reads("--binary", Some(path));
        }
        for (option, paths) in [
            ("--merge", &self.merge),
            ("--rail-profile", &self.rail_profile),
            ("--wheel-profile", &self.wheel_profile),
        ] {
            for path in paths {
                files.reads(option, Some(path));
            }
        }
        let described = self.description.join(self.fmi.folder());
        for path in [
            self.description.join("model.png"),
            described.join("modelDescription.xml"),
            described.join(TERMINALS),
        ] {
            files.reads("--description", Some(&path));
        }
        for folder in ["documentation", "licenses"] {
            for (_, path) in files_of(&self.description.join(folder), "")? {
                files.reads("--description", Some(&path));
            }
        }
        files.writes("--output", Some(output));
        Ok(files.check_apart()?)
    }

    fn entries(&self, library: &Path) -> Result<Entries, Error> {
        let folder = self.description.join(self.fmi.folder());
        let generated = self.fmi.model_description()?;
        let xml = fresh(&folder.join("modelDescription.xml"), &generated)?;
        let mut entries = Entries::new();
        add_folder(&mut entries, &self.description.join("documentation"), "documentation/")?;
        add_folder(
            &mut entries,
            &self.description.join("licenses"),
            "documentation/licenses/",
        )?;
        let picture = read(&self.description.join("model.png"))?;
        match self.fmi {
            Standard::Fmi2 => {
                entries.insert("model.png".to_owned(), picture);
            }
            Standard::Fmi3 => {
                let terminals = fresh(&folder.join(TERMINALS), &terminals_and_icons()?)?;
                entries.insert(format!("terminalsAndIcons/{TERMINALS}"), terminals);
                entries.insert("terminalsAndIcons/icon.png".to_owned(), picture);
            }
        }
        for path in &self.rail_profile {
            add_profile(&mut entries, Body::Rail, path)?;
        }
        for path in &self.wheel_profile {
            add_profile(&mut entries, Body::Wheel, path)?;
        }
        let libraries = self.libraries(library, self.fmi.token_of(&generated), &xml)?;
        entries.insert(BUILD.to_owned(), libraries.build_lines().into_bytes());
        entries.extend(libraries.entries);
        entries.insert("modelDescription.xml".to_owned(), xml);
        Ok(entries)
    }

    fn libraries(&self, library: &Path, guid: &str, xml: &[u8]) -> Result<Libraries, Error> {
        let mut libraries = Libraries::new(self.fmi);
        let own = (self.fmi.own_platform(), library.to_owned());
        let named = std::iter::once(&own).chain(&self.binary);
        let named = named.map(|(platform, path)| Ok((libraries.platform(platform, path)?, path)));
        for (platform, path) in named.collect::<Result<Vec<_>, Error>>()? {
            let library = read(path)?;
            if !library.windows(guid.len()).any(|window| window == guid.as_bytes()) {
                return Err(Error::StaleLibrary {
                    path: path.to_owned(),
                    guid: guid.to_owned(),
                });
            }
            libraries.add(platform, library, path)?;
            libraries.builds.insert(platform.name.to_owned(), build_of(path)?);
        }
        for path in &self.merge {
            libraries.merge(path, xml)?;
        }
        Ok(libraries)
    }
}

/// The libraries of an archive.
struct Libraries {
    standard: Standard,
    entries: Entries,
    /// The functions that the first one exports, and every other has to.
    functions: BTreeSet<String>,
    /// Compiler of each library, by platform.
    builds: BTreeMap<String, String>,
}

impl Libraries {
    fn new(standard: Standard) -> Libraries {
        Libraries {
            standard,
            entries: Entries::new(),
            functions: BTreeSet::new(),
            builds: BTreeMap::new(),
        }
    }

    /// The platform of a name; `path` is where the name comes from.
    fn platform(&self, name: &str, path: &Path) -> Result<&'static Platform, Error> {
        let path = path.to_owned();
        Platform::named(self.standard, name).map_err(|reason| Error::UnknownPlatform { path, reason })
    }

    /// Adds a library after a look at what it is.
    fn add(&mut self, platform: &Platform, library: Vec<u8>, path: &Path) -> Result<(), Error> {
        let binary = Binary::read(&library).map_err(|source| Error::NoLibrary {
            path: path.to_owned(),
            source,
        })?;
        if !binary.is_of(platform) {
            return Err(Error::OtherPlatform {
                path: path.to_owned(),
                found: binary.description(),
                platform: platform.name,
            });
        }
        let functions = binary.functions();
        if self.functions.is_empty() {
            self.functions = &functions | &BTreeSet::from([self.standard.first_function().to_owned()]);
        }
        let missing: Vec<_> = self.functions.difference(&functions).cloned().collect();
        if !missing.is_empty() {
            let path = path.to_owned();
            return Err(Error::MissingFunctions { path, missing });
        }
        let name = format!("binaries/{}/wheelrail.{}", platform.name, platform.extension());
        match self.entries.get(&name) {
            Some(present) if *present != library => Err(Error::TwoLibraries {
                name,
                path: path.to_owned(),
            }),
            _ => {
                self.entries.insert(name, library);
                Ok(())
            }
        }
    }

    /// Adds the libraries of another archive of the same sources, and what compiled them.
    fn merge(&mut self, path: &Path, xml: &[u8]) -> Result<(), Error> {
        let mut others = read_archive(path)?;
        if others.get("modelDescription.xml").map(Vec::as_slice) != Some(xml) {
            return Err(Error::OtherDescription { path: path.to_owned() });
        }
        let builds = others.remove(BUILD).unwrap_or_default();
        for (name, content) in others {
            let Some((folder, _)) = name.strip_prefix("binaries/").and_then(|rest| rest.split_once('/')) else {
                continue;
            };
            let platform = self.platform(folder, path)?;
            self.add(platform, content, path)?;
        }
        for (platform, build) in String::from_utf8_lossy(&builds)
            .lines()
            .filter_map(|line| line.split_once(": "))
        {
            let known = self.builds.entry(platform.to_owned()).or_default();
            if known.is_empty() || known == NOT_RECORDED {
                build.clone_into(known);
            }
        }
        Ok(())
    }

    /// A line for each platform.
    fn build_lines(&self) -> String {
        let lines = self
            .builds
            .iter()
            .map(|(platform, build)| format!("{platform}: {build}\n"));
        lines.collect()
    }
}

/// Returns what compiled a library, which the build writes beside it.
fn build_of(library: &Path) -> Result<String, Error> {
    let mut path = library.as_os_str().to_owned();
    path.push(".build.txt");
    let path = PathBuf::from(path);
    if !path.exists() {
        return Ok(NOT_RECORDED.to_owned());
    }
    let text = String::from_utf8_lossy(&read(&path)?).into_owned();
    Ok(text.split_whitespace().collect::<Vec<_>>().join(" "))
}

fn read_archive(path: &Path) -> Result<Entries, Error> {
    let archive = File::open(path).map_err(|source| file_error(path, source))?;
    let mut archive = ZipArchive::new(archive).map_err(|source| archive_error(path, source))?;
    let mut entries = Entries::new();
    for index in 0..archive.len() {
        let mut entry = archive.by_index(index).map_err(|source| archive_error(path, source))?;
        let name = entry.name().map_err(|source| archive_error(path, source))?.into_owned();
        if entry.is_file() {
            let mut content = Vec::new();
            entry
                .read_to_end(&mut content)
                .map_err(|source| file_error(path, source))?;
            entries.insert(name, content);
        }
    }
    Ok(entries)
}

/// Adds the files of a folder and of the folders in it.
fn add_folder(entries: &mut Entries, folder: &Path, prefix: &str) -> Result<(), Error> {
    for (name, path) in files_of(folder, prefix)? {
        entries.insert(name, read(&path)?);
    }
    Ok(())
}

/// Files of a folder and of the folders in it, with their names in the archive.
fn files_of(folder: &Path, prefix: &str) -> Result<Vec<(String, PathBuf)>, Error> {
    let mut files = Vec::new();
    for item in fs::read_dir(folder).map_err(|source| file_error(folder, source))? {
        let item = item.map_err(|source| file_error(folder, source))?;
        let (path, name) = (item.path(), item.file_name().to_string_lossy().into_owned());
        if path.is_dir() {
            files.extend(files_of(&path, &format!("{prefix}{name}/"))?);
        } else if !name.starts_with('.') {
            files.push((format!("{prefix}{name}"), path));
        }
    }
    Ok(files)
}

/// Adds a profile among the resources, under the name of its file; one that the unit could not read is refused.
fn add_profile(entries: &mut Entries, body: Body, path: &Path) -> Result<(), Error> {
    let (option, parameter) = match body {
        Body::Rail => ("--rail-profile", "rail_profile"),
        Body::Wheel => ("--wheel-profile", "wheel_profile"),
    };
    let content = read(path)?;
    let refused = |reason| Error::Profile {
        path: path.to_owned(),
        reason,
    };
    let name = path.file_name().and_then(|name| name.to_str());
    let name = name.ok_or_else(|| refused("its name is not UTF-8".to_owned()))?;
    match ProfileSource::of(parameter, name) {
        Ok(ProfileSource::File(found)) if found == Path::new(name) => {}
        Ok(ProfileSource::BuiltIn(known)) => {
            return Err(refused(format!(
                "the profile {known} that is built in would go before it"
            )));
        }
        _ => return Err(refused("its name would be taken as a URI".to_owned())),
    }
    profile::in_file(path, body).map_err(|source| Error::NoProfile {
        option,
        path: path.to_owned(),
        source: Box::new(source),
    })?;
    match entries.insert(format!("resources/{name}"), content.clone()) {
        Some(other) if other != content => Err(refused("another profile has a file of the same name".to_owned())),
        _ => Ok(()),
    }
}

/// Writes the archive; the same entries give the same bytes: sorted names, a fixed date, fixed permissions, one
/// compression.
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

/// A checked-in file, which must have the generated text.
fn fresh(path: &Path, generated: &str) -> Result<Vec<u8>, Error> {
    let text = read(path)?;
    if text == generated.as_bytes() {
        Ok(text)
    } else {
        Err(Error::StaleDescription { path: path.to_owned() })
    }
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

/// Path of the library that belongs to this program: beside it, where cargo leaves it, or in `../library`, where `make` does.
/// Where there are both, the one that was built last: the other one is of older sources.
fn default_library() -> Result<PathBuf, Error> {
    let name = format!(
        "{}wheelrail{}",
        std::env::consts::DLL_PREFIX,
        std::env::consts::DLL_SUFFIX
    );
    let program = std::env::current_exe().map_err(|source| file_error(Path::new("wheelrail"), source))?;
    let beside = program.with_file_name(&name);
    let folder = program.parent().and_then(Path::parent).unwrap_or(Path::new(""));
    let made = folder.join("library").join(&name);
    let built = |path: &&PathBuf| fs::metadata(path).and_then(|found| found.modified()).ok();
    let there = [&made, &beside].into_iter().filter(|path| path.is_file());
    match there.max_by_key(built) {
        Some(path) => Ok(path.clone()),
        None => Err(Error::LibraryNotFound { beside, made }),
    }
}

fn platform_and_file(text: &str) -> Result<(String, PathBuf), String> {
    match text.split_once('=') {
        Some((platform, file)) if !platform.is_empty() && !file.is_empty() => {
            Ok((platform.to_owned(), PathBuf::from(file)))
        }
        _ => Err("expected PLATFORM=FILE, for example win64=wheelrail.dll".to_owned()),
    }
}
