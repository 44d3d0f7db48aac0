//! `wheelrail profile`: the profiles that are built in, and those of files, looked at or converted.

use crate::files::{self, Files};
use crate::names::did_you_mean;
use crate::table::{self, Table, heading};
use clap::{Args, ValueEnum};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use wheelrail::profile_files::{Lateral, LengthUnit, ReadOptions, read_depths};
use wheelrail::{Body, Profile, ProfileError, built_in_profiles};

/// Options of `profile`.
#[derive(Args)]
pub struct Options {
    /// A name that is built in, or a file: SIMPACK (.prr, .prw), MiniProf (.ban, .whl, .mpt), VAMPIRE, or columns y z. Without one the
    /// built-in ones are listed.
    #[arg(value_name = "NAME|FILE")]
    profile: Option<String>,
    /// Body that the profile is of, where the file does not say it.
    #[arg(long, requires = "profile")]
    body: Option<BodyName>,
    /// Unit of the file's coordinates: m, mm or in.
    #[arg(long, value_parser = unit, requires = "profile")]
    unit: Option<LengthUnit>,
    /// Direction of the file's y.
    #[arg(long, requires = "profile")]
    y_to: Option<Direction>,
    /// Direction of the file's z.
    #[arg(long, requires = "profile")]
    z: Option<Vertical>,
    /// Number of the profile in a file with more than one: of a section of .mpt; 1 left, 2 right of VAMPIRE.
    #[arg(long, requires = "profile")]
    part: Option<usize>,
    /// Distance of a wheel's running circle from the back of its flange, `m`, where the y of the file is not 0 on the running circle: moves the
    /// points, the outermost of which is the back. The option of this name of `wheelrail geometry` is another one.
    #[arg(long, value_name = "METRES", requires = "profile", allow_hyphen_values = true)]
    flange_back_position: Option<f64>,
    /// Wavelength of the smoothing, `m`: waves of this length are halved.
    #[arg(
        long,
        value_name = "METRES",
        default_value_t = 0.0,
        requires = "profile",
        allow_hyphen_values = true
    )]
    smoothing: f64,
    /// Inclination that a rail is given, as a slope.
    #[arg(long, value_name = "SLOPE", allow_hyphen_values = true, requires = "profile")]
    inclination: Option<f64>,
    /// Table of depths by which the profile is worn along its normal, `arc_length [mm],depth [mm]`: positive where material is gone.
    #[arg(long, value_name = "DEPTHS.csv", requires = "profile")]
    worn_by: Option<PathBuf>,
    /// Measures of a wheel by EN 15313, in mm: height, thickness and gradient of the flange, hollow of the tread. With `--output` as CSV.
    #[arg(long, requires = "profile")]
    measures: bool,
    /// Distance of the running circle from the back of the flange, `m`, from which the thickness of the flange is measured; without it
    /// `--flange-back-position`, or else 0.07 as of EN 15313.
    #[arg(long, value_name = "METRES", requires = "measures", allow_hyphen_values = true)]
    back: Option<f64>,
    /// New profile, by its name or file, that the worn area and depths are measured against.
    #[arg(long, value_name = "NAME|FILE", requires = "measures")]
    against: Option<String>,
    /// Arc lengths, `m`, between commas: the CSV has the profile there, in place of its points; beyond the ends it goes on straight.
    #[arg(
        long,
        value_name = "METRES",
        value_delimiter = ',',
        value_parser = arc_length,
        requires = "profile",
        conflicts_with = "measures",
        allow_hyphen_values = true
    )]
    at: Vec<f64>,
    /// File for the profile: SIMPACK's (.prr, .prw), MiniProf's (.ban, .whl, .mpt), VAMPIRE's (.rai, .whe), or CSV with arc length,
    /// inclination and curvature; without it the CSV goes to the standard output.
    #[arg(short, long, value_name = "OUT", requires = "profile")]
    output: Option<PathBuf>,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum BodyName {
    Rail,
    Wheel,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum Direction {
    Field,
    Gauge,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum Vertical {
    Up,
    Down,
}

/// Reason why there is no profile.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// A profile that does not serve.
    #[error("{0}{hint}", hint = hint(.0))]
    Profile(#[from] ProfileError),
    /// A profile that is neither built in nor a file.
    #[error("{name}: neither a file nor a built-in profile; these are {}{hint}", built_in_profiles::NAMES.join(", "))]
    Neither {
        /// Name that was given.
        name: String,
        /// Names that may be meant.
        hint: String,
    },
    /// Places that a file of a profile has no room for.
    #[error("{}: --at is of the CSV, a file with another ending or the standard output", .0.display())]
    PlacesOfFile(PathBuf),
    /// A file that is not to be written, or cannot be.
    #[error(transparent)]
    Files(#[from] files::Error),
    /// A table that cannot be written.
    #[error(transparent)]
    Table(#[from] table::Error),
    /// Standard output.
    #[error("standard output: {0}")]
    Output(#[from] io::Error),
}

/// Returns the option that takes noise off, or how a file is made readable that does not say all that it must.
pub fn hint(error: &ProfileError) -> String {
    if error.is_of_noise() {
        return " (--smoothing)".to_owned();
    }
    // The reader's names of what `wheelrail profile` has options for.
    let option = match error {
        ProfileError::NotSaid { option, .. } => *option,
        ProfileError::TooBroad { .. } => "unit",
        _ => return String::new(),
    };
    let option = match option {
        "body" => "--body rail|wheel",
        "unit" => "--unit m|mm|in",
        "y_to" => "--y-to field|gauge",
        "z_up" => "--z up|down",
        "flange_back_position" => "--flange-back-position METRES",
        _ => return String::new(),
    };
    format!(
        "; as an option: `wheelrail profile FILE {option}`, which with `-o NEW.prw` (a rail: NEW.prr) writes a file that says it itself"
    )
}

fn unit(text: &str) -> Result<LengthUnit, String> {
    LengthUnit::named(text).ok_or_else(|| "allowed is m, mm or in".to_owned())
}

fn arc_length(text: &str) -> Result<f64, String> {
    let arc = text.trim().parse::<f64>().ok().filter(|arc| arc.is_finite());
    arc.ok_or_else(|| "a finite number of metres is needed".to_owned())
}

/// Steepest inclination of a rail, as a slope: that of the parameter `rail_inclination`.
const STEEPEST: f64 = 0.2;

/// Inclination of a rail, rad, of an option that gives it as a slope.
pub fn angle(slope: f64) -> Result<f64, ProfileError> {
    if (-STEEPEST..=STEEPEST).contains(&slope) {
        return Ok(slope.atan());
    }
    Err(ProfileError::OutOfRange {
        name: "rail_inclination",
        value: slope,
        minimum: -STEEPEST,
        maximum: STEEPEST,
        unit: "as a slope",
    })
}

/// Profile that is built in or in a file, of a body; smoothed where it is in a file.
pub fn named(name: &str, body: Body, smoothing: f64) -> Result<Profile, Error> {
    let smoothing = if is_built_in(name) { 0.0 } else { smoothing };
    of_body(body, smoothing, |options| either(name, options))
}

/// Profile in a file, of a body, read as a component reads it with its default parameters.
pub fn in_file(path: &Path, body: Body) -> Result<Profile, Error> {
    of_body(body, 0.0, |options| Ok(Profile::read(path, options)?))
}

fn of_body(
    body: Body,
    smoothing: f64,
    read: impl FnOnce(&ReadOptions) -> Result<Profile, Error>,
) -> Result<Profile, Error> {
    let options = ReadOptions {
        body: Some(body),
        smoothing,
        ..ReadOptions::default()
    };
    let profile = read(&options)?;
    profile.require(body)?;
    Ok(profile)
}

/// Whether a profile of this name is built in.
pub fn is_built_in(name: &str) -> bool {
    built_in_profiles::NAMES
        .iter()
        .any(|known| known.eq_ignore_ascii_case(name))
}

/// Path of the file that a name means, if none is built in of this name.
pub fn file(name: &str) -> Option<&Path> {
    (!is_built_in(name)).then(|| Path::new(name))
}

fn either(name: &str, options: &ReadOptions) -> Result<Profile, Error> {
    if is_built_in(name) {
        let given = [
            ("unit", options.unit.is_some()),
            ("y_to", options.y_to.is_some()),
            ("z_up", options.z_up.is_some()),
            ("part", options.part.is_some()),
            ("flange_back_position", options.flange_back_position.is_some()),
            ("smoothing", options.smoothing != 0.0),
        ];
        if let Some((option, _)) = given.into_iter().find(|(_, is_given)| *is_given) {
            return Err(Error::Profile(ProfileError::NotUsed {
                name: name.to_owned(),
                option,
                reason: "the profile is built in",
            }));
        }
        return Ok(Profile::built_in(name)?);
    }
    let path = Path::new(name);
    if !path.exists() && path.extension().is_none() {
        return Err(Error::Neither {
            name: name.to_owned(),
            hint: did_you_mean(name, built_in_profiles::NAMES),
        });
    }
    Ok(Profile::read(path, options)?)
}

impl Options {
    /// Runs the command.
    pub fn run(&self) -> Result<(), Error> {
        let Some(name) = &self.profile else {
            let mut out = io::stdout().lock();
            for name in built_in_profiles::NAMES {
                let profile = Profile::built_in(name)?;
                writeln!(out, "{name:8}{:8}{}", profile.body().name(), profile.source())?;
            }
            return Ok(());
        };
        self.check_files(name)?;
        let body = self.body.map(|body| match body {
            BodyName::Rail => Body::Rail,
            BodyName::Wheel => Body::Wheel,
        });
        let options = ReadOptions {
            body,
            unit: self.unit,
            y_to: self.y_to.map(|y_to| match y_to {
                Direction::Field => Lateral::ToField,
                Direction::Gauge => Lateral::ToGauge,
            }),
            z_up: self.z.map(|z| matches!(z, Vertical::Up)),
            part: self.part,
            flange_back_position: self.flange_back_position,
            smoothing: self.smoothing,
        };
        let mut profile = either(name, &options)?;
        if let Some(body) = body {
            profile.require(body)?;
        }
        if let Some(slope) = self.inclination {
            profile.require(Body::Rail)?;
            profile = profile.inclined(angle(slope)?)?;
        }
        if let Some(path) = &self.worn_by {
            profile = profile.worn_by(&read_depths(path)?)?;
        }
        eprintln!("{}: {}, {}", profile.name(), profile.body().name(), profile.source());
        if self.measures {
            return self.write_measures(&profile);
        }
        let ending = self.output.as_deref().and_then(Path::extension);
        match (
            &self.output,
            ending.map(|ending| ending.to_string_lossy().to_ascii_lowercase()),
        ) {
            (Some(path), Some(ending))
                if ["prr", "prw", "ban", "whl", "mpt", "rai", "whe"].contains(&ending.as_str()) =>
            {
                if !self.at.is_empty() {
                    return Err(Error::PlacesOfFile(path.clone()));
                }
                Ok(profile.write(path)?)
            }
            (path, _) if self.at.is_empty() => write(path.as_deref(), &profile, profile.arc_lengths()),
            (path, _) => write(path.as_deref(), &profile, &self.at),
        }
    }

    /// Refuses an output that would overwrite what the command reads, or that cannot be written.
    fn check_files(&self, name: &str) -> Result<(), Error> {
        let mut files = Files::default();
        files.reads("the profile", file(name));
        files.reads("--worn-by", self.worn_by.as_deref());
        files.reads("--against", self.against.as_deref().and_then(file));
        files.writes("--output", self.output.as_deref());
        Ok(files.check()?)
    }

    /// Writes the measures of a wheel, and its wear where a new profile is given: to be read, or as CSV where a file is given.
    fn write_measures(&self, profile: &Profile) -> Result<(), Error> {
        let measures = match self.back.or(self.flange_back_position) {
            Some(back) => profile.measures_with_back(back)?,
            None => profile.measures()?,
        };
        let mut rows = vec![
            Measure::length("flange_height", "flange height Sh", measures.flange_height),
            Measure::length("flange_thickness", "flange thickness Sd", measures.flange_thickness),
            Measure::length("flange_gradient", "flange gradient qR", measures.flange_gradient),
            Measure::length("hollow_depth", "hollow of the tread", measures.hollow_depth),
        ];
        if let Some(new) = &self.against {
            let new = named(new, Body::Wheel, self.smoothing)?;
            let wear = profile.worn_against(&new)?;
            rows.extend([
                Measure {
                    name: "worn_area",
                    words: "worn area",
                    value: wear.area,
                    units: [("m2", 1.0), ("mm²", 1e6)],
                },
                Measure::length("tread_depth", "depth at the running circle", wear.tread_depth),
                Measure::length("largest_depth", "largest depth along the normal", wear.largest_depth),
                Measure::length(
                    "largest_depth_position",
                    "  at the lateral position",
                    wear.largest_depth_position,
                ),
            ]);
        }
        if let Some(path) = &self.output {
            let headings = rows.iter().map(|row| heading(row.name, row.units[0].0));
            let mut table = Table::open(Some(path), headings)?;
            table.write(rows.iter().map(|row| row.value))?;
            return Ok(table.finish()?);
        }
        let mut out = io::stdout().lock();
        for row in rows {
            let (unit, scale) = row.units[1];
            // No minus before a zero that is one by rounding.
            let value = (1e3 * scale * row.value).round() / 1e3 + 0.0;
            writeln!(out, "{:31}{value:9.3} {unit}", row.words)?;
        }
        Ok(())
    }
}

/// A measure of a wheel as it is written.
struct Measure {
    name: &'static str,
    words: &'static str,
    /// Value in the unit of tables.
    value: f64,
    /// Unit of tables and unit for reading, with what a value in the first is in it.
    units: [(&'static str, f64); 2],
}

impl Measure {
    fn length(name: &'static str, words: &'static str, value: f64) -> Measure {
        Measure {
            name,
            words,
            value,
            units: [("m", 1.0), ("mm", 1e3)],
        }
    }
}

/// Writes a table of a profile at arc lengths, of which the first two columns are read as a file of columns.
fn write(path: Option<&Path>, profile: &Profile, arcs: &[f64]) -> Result<(), Error> {
    let columns = [
        ("y", "m"),
        ("z", "m"),
        ("arc_length", "m"),
        ("inclination", "rad"),
        ("curvature", "1/m"),
    ];
    let mut table = Table::open(path, columns.into_iter().map(|(name, unit)| heading(name, unit)))?;
    for arc in arcs {
        let point = profile.at(*arc);
        let inclination = point.tangent[1].atan2(point.tangent[0]);
        let [y, z] = point.place;
        table.write([y, z, *arc, inclination, point.curvature].into_iter())?;
    }
    Ok(table.finish()?)
}
