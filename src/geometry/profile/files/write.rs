//! Profiles into files, each as its reader reads it back.

use super::Format;
use crate::error::ProfileError;
use crate::geometry::profile::{Body, Profile};
use std::fmt::Write;
use std::path::Path;

impl Profile {
    /// Writes the profile's points to a file, by the end of its name as SIMPACK's (`.prr`, `.prw`), MiniProf's (`.ban`, `.whl`) or, with any
    /// other one, as a table of y and z in `mm`, y to the field side and z upward.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write(&self, path: &Path) -> Result<(), ProfileError> {
        let format = match path
            .extension()
            .map(|ending| ending.to_string_lossy().to_ascii_lowercase())
        {
            Some(ending) if ["prr", "prw"].contains(&ending.as_str()) => Format::Simpack,
            Some(ending) if ["ban", "whl"].contains(&ending.as_str()) => Format::MiniProf,
            _ => Format::Columns,
        };
        std::fs::write(path, self.text(format)).map_err(|error| ProfileError::File {
            path: path.display().to_string(),
            reason: error.to_string(),
        })
    }

    /// Text of a file with the profile's points; VAMPIRE's needs a second profile and dimensions of the track, and is written as columns.
    pub fn text(&self, format: Format) -> String {
        let mut rows = String::new();
        let (separator, up) = match format {
            Format::Simpack => ("  ", -1.0),
            Format::MiniProf => (" ", 1.0),
            Format::Vampire | Format::Columns => (",", 1.0),
        };
        for [y, z] in self.points() {
            // To a pm: less than the formulas of the standards are rounded.
            let _ = writeln!(rows, "{:.9}{separator}{:.9}", 1e3 * y, up * 1e3 * z);
        }
        let (name, source) = (self.name(), self.source());
        match format {
            Format::Simpack => {
                let kind = i32::from(self.body() == Body::Wheel);
                format!(
                    "! {name}: {source}\nheader.begin\n  version = 1\n  type    = {kind}    ! 0 rail, 1 wheel\nheader.end\nspline.begin\n  \
                     units.len.f = 1000\n  units.ang.f = 1\n  point.begin\n{rows}  point.end\nspline.end\n"
                )
            }
            Format::MiniProf => {
                let count = self.points().len();
                format!("ProgramName=wheelrail\nXYPoints={count}\nColumnDef=X,Y\n\n{rows}")
            }
            Format::Vampire | Format::Columns => format!("# {name}: {source}\ny [mm],z [mm]\n{rows}"),
        }
    }
}
