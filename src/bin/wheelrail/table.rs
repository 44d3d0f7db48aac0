//! Tables as CSV: what `wheelrail simulate` writes.

use crate::files;
use std::fs::File;
use std::io;
use std::path::{Path, PathBuf};

/// A file that does not serve as a table.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// A file that cannot be opened or written.
    #[error("{path}: {source}")]
    File {
        /// The file.
        path: PathBuf,
        /// Error of the system.
        source: io::Error,
    },
    /// A table that is not CSV.
    #[error("{path}: {source}")]
    Csv {
        /// The file.
        path: PathBuf,
        /// Error of the table.
        source: csv::Error,
    },
}

impl Error {
    /// Wraps an error of the file at the given path.
    pub fn file(path: &Path) -> impl FnOnce(io::Error) -> Error {
        |source| Error::File {
            path: path.to_owned(),
            source,
        }
    }

    /// Wraps an error of the content of the file at the given path.
    pub fn csv(path: &Path) -> impl Fn(csv::Error) -> Error {
        |source| Error::Csv {
            path: path.to_owned(),
            source,
        }
    }
}

/// A heading: `normal_load [N]`, `creepage [1]`.
pub fn heading(name: &str, unit: &str) -> String {
    format!("{name} [{unit}]")
}

/// A table that is written row by row.
pub struct Table {
    path: PathBuf,
    writer: csv::Writer<File>,
}

impl Table {
    /// A new file with its headings.
    pub fn create(path: &Path, headings: impl Iterator<Item = String>) -> Result<Table, Error> {
        let file = files::create(path).map_err(Error::file(path))?;
        let mut table = Table {
            path: path.to_owned(),
            writer: csv::Writer::from_writer(file),
        };
        table.record(headings)?;
        Ok(table)
    }

    /// One row. Numbers are the shortest that read back to the same value.
    pub fn write(&mut self, values: impl Iterator<Item = f64>) -> Result<(), Error> {
        self.record(values.map(shortest))
    }

    fn record(&mut self, cells: impl Iterator<Item = String>) -> Result<(), Error> {
        self.writer.write_record(cells).map_err(Error::csv(&self.path))
    }

    /// Finishes the table: what is left in the buffer is written. To be called at the end.
    pub fn finish(&mut self) -> Result<(), Error> {
        self.writer.flush().map_err(Error::file(&self.path))
    }
}

fn shortest(value: f64) -> String {
    if value == 0.0 || (1e-4..1e15).contains(&value.abs()) {
        format!("{value}")
    } else {
        format!("{value:e}")
    }
}
