//! Profiles into files, each as its reader reads it back.

use super::{Format, body_of, ending_of, name_of};
use crate::error::ProfileError;
use crate::geometry::profile::{Body, Profile};
use std::fmt::Write;
use std::path::Path;

/// Distance of the running circle from the track's middle that VAMPIRE's file of a wheel has, `mm`: flange backs at 1360, and 70 from them.
const RUNNING_CIRCLE: f64 = 750.0;
/// Half the gauge that VAMPIRE's file of a rail has, `mm`, and the depth at which it is.
const GAUGE: [f64; 2] = [717.5, 14.0];

/// Refuses a path for the profile of a body that ends as files of the other body do, and could not be read again.
///
/// # Errors
/// [`ProfileError::OtherEnding`].
pub fn check_ending(path: &Path, body: Body) -> Result<(), ProfileError> {
    let name = name_of(path);
    match body_of(&name).filter(|other| *other != body) {
        Some(other) => Err(ProfileError::OtherEnding {
            name,
            other: other.name(),
            body: body.name(),
        }),
        None => Ok(()),
    }
}

/// Ends of the names, without the dot, that say what is written of a body: its three formats' and the table's.
pub fn written_endings(body: Body) -> &'static [&'static str] {
    match body {
        Body::Wheel => &["prw", "whl", "mpt", "whe", "csv"],
        Body::Rail => &["prr", "ban", "mpt", "rai", "csv"],
    }
}

impl Profile {
    /// Writes the profile's points to a file, by the end of its name as SIMPACK's (`.prr`, `.prw`), MiniProf's (`.ban`, `.whl`, `.mpt`),
    /// VAMPIRE's (`.rai`, `.whe`) or, with any other one, as a table of y and z in `mm`, y to the field side and z upward.
    ///
    /// # Errors
    /// The end of the name is that of the other body's files, which could not be read again; the file cannot be written.
    pub fn write(&self, path: &Path) -> Result<(), ProfileError> {
        check_ending(path, self.body())?;
        let text = match ending_of(path).as_str() {
            "prr" | "prw" => self.text(Format::Simpack),
            "ban" | "whl" => self.text(Format::MiniProf),
            "mpt" => format!(
                "[FileInfo]\nProgramName=wheelrail\n\n[Profile1Info]\nXYPoints={}\n\n[Profile1Points]\n{}",
                self.points().len(),
                self.rows(" ", 0.0, 1.0)
            ),
            "rai" | "whe" => self.text(Format::Vampire),
            _ => self.text(Format::Columns),
        };
        std::fs::write(path, text).map_err(|error| ProfileError::File {
            path: path.display().to_string(),
            reason: error.to_string(),
        })
    }

    /// Rows of the points in `mm`, moved outwards, with z upward or downward; to a pm: less than the formulas of the standards are rounded.
    fn rows(&self, separator: &str, outwards: f64, up: f64) -> String {
        let mut rows = String::new();
        for [y, z] in self.points() {
            let _ = writeln!(rows, "{:.9}{separator}{:.9}", 1e3 * y + outwards, up * 1e3 * z);
        }
        rows
    }

    /// Text of a file with the profile's points. VAMPIRE's has the profile on both sides of a track of standard gauge.
    pub fn text(&self, format: Format) -> String {
        let (name, source) = (self.name(), self.source());
        match format {
            Format::Simpack => {
                let kind = i32::from(self.body() == Body::Wheel);
                let rows = self.rows("  ", 0.0, -1.0);
                format!(
                    "! {name}: {source}\nheader.begin\n  version = 1\n  type    = {kind}    ! 0 rail, 1 wheel\nheader.end\nspline.begin\n  \
                     units.len.f = 1000\n  units.ang.f = 1\n  point.begin\n{rows}  point.end\nspline.end\n"
                )
            }
            Format::MiniProf => {
                let (count, rows) = (self.points().len(), self.rows(" ", 0.0, 1.0));
                format!("ProgramName=wheelrail\nXYPoints={count}\nColumnDef=X,Y\n\n{rows}")
            }
            Format::Vampire => self.vampire(),
            Format::Columns => format!("# {name}: {source}\ny [mm],z [mm]\n{}", self.rows(",", 0.0, 1.0)),
        }
    }

    fn vampire(&self) -> String {
        let (kind, dimensions, outwards, up) = match self.body() {
            Body::Wheel => ("WHEEL", "TREADDATUM EUROPEAN\nFLANGEBACK 1360.0", RUNNING_CIRCLE, -1.0),
            Body::Rail => {
                let [half, depth] = GAUGE;
                // A head that is not as deep stands with its highest point there.
                let face = self.gauge_point(1e-3 * depth).unwrap_or_default();
                ("RAIL", "GAUGEPOINT EUROPEAN\nGAUGE 1435.0", half - 1e3 * face, 1.0)
            }
        };
        let mut text = format!("{kind}PROFILE\n{}\n{dimensions}\n", self.name());
        for row in self.rows(" ", outwards, up).lines() {
            let _ = writeln!(text, "-{row} {row}");
        }
        text
    }
}
