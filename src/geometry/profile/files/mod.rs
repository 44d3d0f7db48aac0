//! Profiles in files: SIMPACK, MiniProf, VAMPIRE, and columns of numbers.
//!
//! A reader gives the points as the file has them, and what the file says of them: the body, the unit, the directions of y and z. What it
//! does not say is found out from the shape where that is possible (`orientation`), or has to be given; the profile's source names what
//! was found.

mod columns;
mod miniprof;
mod numbers;
mod orientation;
mod simpack;
mod size;
mod vampire;
mod write;

pub use write::{check_ending, written_endings};

use super::measured::{MOST_POINTS, Weighted};
use super::measures::check_flange_back;
use super::{Body, Profile};
use crate::error::ProfileError;
use std::borrow::Cow;
use std::path::Path;

/// Length of a file at most, bytes: 200 for each of the points that a profile may have.
const LONGEST: u64 = 200 * MOST_POINTS as u64;

/// Unit of lengths in a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LengthUnit {
    /// Metres.
    Metre,
    /// Millimetres.
    Millimetre,
    /// Inches of 25.4 mm.
    Inch,
}

impl LengthUnit {
    /// Unit in `m`.
    pub fn metres(self) -> f64 {
        match self {
            LengthUnit::Metre => 1.0,
            LengthUnit::Millimetre => 1e-3,
            LengthUnit::Inch => 25.4e-3,
        }
    }

    /// Unit of a name: `m`, `mm` or `in`.
    pub fn named(name: &str) -> Option<LengthUnit> {
        match name {
            "m" => Some(LengthUnit::Metre),
            "mm" => Some(LengthUnit::Millimetre),
            "in" | "inch" => Some(LengthUnit::Inch),
            _ => None,
        }
    }
}

/// Direction of the lateral coordinate in a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Lateral {
    /// y grows outwards from the track's middle.
    ToField,
    /// y grows towards the track's middle.
    ToGauge,
}

/// Options for reading a profile. What is `None` is taken from the file, found out from its shape, or asked for by an error.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct ReadOptions {
    /// Body that the profile must be of.
    pub body: Option<Body>,
    /// Unit of the coordinates.
    pub unit: Option<LengthUnit>,
    /// Direction of y.
    pub y_to: Option<Lateral>,
    /// Whether z points upward.
    pub z_up: Option<bool>,
    /// Number of the profile in a file with more than one: of MiniProf's `.mpt` that of its section, of VAMPIRE 1 for the left and 2 for the
    /// right one. `None` is the right one of VAMPIRE, and the only one of `.mpt`.
    pub part: Option<usize>,
    /// Distance of a wheel's running circle from the back of its flange, the outermost point, `m`: moves the origin there. `None` keeps the
    /// file's y. That of [`Dimensions`](crate::contact_geometry::Dimensions) says where the wheels stand, and moves no point.
    pub flange_back_position: Option<f64>,
    /// Wavelength of the smoothing, `m`; 0 goes through the points.
    pub smoothing: f64,
}

/// Format of a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// SIMPACK's `.prr` and `.prw`.
    Simpack,
    /// MiniProf's `.ban`, `.whl` and `.mpt`.
    MiniProf,
    /// VAMPIRE's `.rai` and `.whe`.
    Vampire,
    /// Two columns, y and z, of a table.
    Columns,
}

impl Format {
    /// Format of a file by the end of its name and its first lines.
    fn of(path: &Path, text: &str) -> Format {
        let first = text.trim_start_matches(MARK).trim_start();
        match ending_of(path).as_str() {
            _ if ["WHEELPROFILE", "RAILPROFILE"]
                .iter()
                .any(|title| first.starts_with(title)) =>
            {
                Format::Vampire
            }
            "prr" | "prw" => Format::Simpack,
            "ban" | "whl" | "mpt" => Format::MiniProf,
            _ => Format::Columns,
        }
    }

    /// Name of the format.
    pub fn name(self) -> &'static str {
        match self {
            Format::Simpack => "SIMPACK",
            Format::MiniProf => "MiniProf",
            Format::Vampire => "VAMPIRE",
            Format::Columns => "columns",
        }
    }
}

/// Points as a file has them, with what it says of them.
#[derive(Debug, Default)]
struct Raw {
    /// Coordinates y and z in the file's unit, with weights.
    points: Vec<Weighted>,
    body: Option<Body>,
    /// Length of the unit, `m`.
    unit: Option<f64>,
    y_to: Option<Lateral>,
    z_up: Option<bool>,
}

impl Profile {
    /// Profile from a file. The end of its name says the format: `.prr`, `.prw` (SIMPACK), `.ban`, `.whl`, `.mpt` (MiniProf); a VAMPIRE file is
    /// known by its first line; all else is a table of y and z, in columns.
    ///
    /// # Errors
    /// The file cannot be read, is not of its format, does not say what it must, or is no profile of the body that is needed.
    pub fn read(path: &Path, options: &ReadOptions) -> Result<Profile, ProfileError> {
        Profile::of_file(path, &text_of(path)?, options)
    }

    /// Profile from the text of a file, whose path says name and format.
    ///
    /// # Errors
    /// As [`Profile::parse`].
    pub(crate) fn of_file(path: &Path, text: &str, options: &ReadOptions) -> Result<Profile, ProfileError> {
        Profile::parse(text, &name_of(path), Format::of(path, text), options)
    }

    /// Profile from the text of a file.
    ///
    /// # Errors
    /// The text is not of its format, does not say what it must, or is no profile of the body that is needed.
    pub fn parse(text: &str, name: &str, format: Format, options: &ReadOptions) -> Result<Profile, ProfileError> {
        let text = &*plain(text);
        let raw = match format {
            Format::Simpack => simpack::read(text, name)?,
            Format::MiniProf => miniprof::read(text, name, options.part)?,
            Format::Vampire => vampire::read(text, name, options.part)?,
            Format::Columns => columns::read(text, name)?,
        };
        let body = match (raw.body.or(body_of(name)), options.body) {
            (Some(found), Some(needed)) if found != needed => {
                return Err(ProfileError::OtherBody {
                    name: name.to_owned(),
                    found: found.name(),
                    needed: needed.name(),
                });
            }
            (Some(body), _) | (None, Some(body)) => body,
            (None, None) => {
                return Err(ProfileError::NotSaid {
                    name: name.to_owned(),
                    seen: "the file does not say whether it is a rail or a wheel".to_owned(),
                    option: "body",
                });
            }
        };
        if raw.points.len() > MOST_POINTS {
            return Err(ProfileError::NoCurve {
                name: name.to_owned(),
                reason: format!("{} points, more than {MOST_POINTS}", raw.points.len()),
            });
        }
        let holds_one = match format {
            Format::Simpack | Format::Columns => true,
            Format::MiniProf => !miniprof::has_sections(text),
            Format::Vampire => false,
        };
        let not_used = |option, reason| ProfileError::NotUsed {
            name: name.to_owned(),
            option,
            reason,
        };
        if options.part.is_some() && holds_one {
            return Err(not_used("part", "the file holds one profile"));
        }
        if options.flange_back_position.is_some() && body == Body::Rail {
            return Err(not_used("flange_back_position", "a rail has no flange"));
        }
        options.flange_back_position.map_or(Ok(()), check_flange_back)?;
        let (points, found) = orientation::framed(name, body, raw, options)?;
        let source = format!("{} file {name}{found}", format.name());
        let profile = Profile::from_weighted(body, name, &source, points, options.smoothing)?;
        size::check(&profile)?;
        Ok(profile)
    }
}

/// Mark of Unicode that may stand before a text.
const MARK: char = '\u{feff}';
/// Bytes of that mark in UTF-16, in either order.
const MARKS_OF_UTF_16: [[u8; 2]; 2] = [[0xff, 0xfe], [0xfe, 0xff]];

/// Text without a mark before it, its lines ended as on Unix: those of old Macs end with a carriage return alone.
fn plain(text: &str) -> Cow<'_, str> {
    let text = text.trim_start_matches(MARK);
    if text.contains('\r') {
        Cow::Owned(text.replace("\r\n", "\n").replace('\r', "\n"))
    } else {
        Cow::Borrowed(text)
    }
}

/// Text of a file that holds a profile; letters that are no UTF-8 are replaced.
///
/// # Errors
/// [`ProfileError::File`].
pub(crate) fn text_of(path: &Path) -> Result<String, ProfileError> {
    let failed = |reason: String| ProfileError::File {
        path: path.display().to_string(),
        reason,
    };
    let length = std::fs::metadata(path)
        .map_err(|error| failed(error.to_string()))?
        .len();
    if length > LONGEST {
        return Err(failed(format!(
            "{length} bytes, more than {LONGEST}: no profile is as long"
        )));
    }
    let bytes = std::fs::read(path).map_err(|error| failed(error.to_string()))?;
    if MARKS_OF_UTF_16.iter().any(|mark| bytes.starts_with(mark)) {
        return Err(failed(
            "it is in UTF-16: allowed is UTF-8, in which an editor can save it".to_owned(),
        ));
    }
    // Titles of stations are in all kinds of alphabets; numbers are not.
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

/// Body that the end of a file's name stands for.
fn body_of(name: &str) -> Option<Body> {
    let ending = name.rsplit('.').next().unwrap_or_default().to_ascii_lowercase();
    match ending.as_str() {
        "prr" | "ban" | "rai" => Some(Body::Rail),
        "prw" | "whl" | "whe" => Some(Body::Wheel),
        _ => None,
    }
}

/// End of a file's name without the dot, in small letters; empty where there is none.
pub fn ending_of(path: &Path) -> String {
    path.extension()
        .map_or_else(String::new, |ending| ending.to_string_lossy().to_ascii_lowercase())
}

/// Name of a file without its folder.
fn name_of(path: &Path) -> String {
    path.file_name()
        .map_or_else(String::new, |name| name.to_string_lossy().into_owned())
}

/// Depths over the arc length, for [`Profile::worn_by`], from a table of two columns below headings with a unit, `arc_length [mm],depth [mm]`: rows of both, `m`.
///
/// # Errors
/// The file cannot be read, is no such table, or its headings have no unit.
pub fn read_depths(path: &Path) -> Result<Vec<[f64; 2]>, ProfileError> {
    let name = name_of(path);
    let table = columns::read(&plain(&text_of(path)?), &name)?;
    let unit = table.unit.ok_or_else(|| ProfileError::Content {
        name,
        format: "columns",
        line: 1,
        reason: "its headings have no unit: arc_length [mm],depth [mm]".to_owned(),
    })?;
    Ok(table
        .points
        .iter()
        .map(|row| row.place.map(|value| unit * value))
        .collect())
}

#[cfg(test)]
mod tests;
