//! Tables as CSV: what the commands write.

use crate::files;
use std::io::{self, Write};
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
        |source| {
            let path = path.to_owned();
            if !source.is_io_error() {
                return Error::Csv { path, source };
            }
            // An error of the system that is known as one: of output that nobody reads any more, for example.
            let source = match source.into_kind() {
                csv::ErrorKind::Io(source) => source,
                kind => io::Error::other(format!("{kind:?}")),
            };
            Error::File { path, source }
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
    writer: csv::Writer<Box<dyn Write>>,
}

impl Table {
    /// A new file with its headings.
    pub fn create(path: &Path, headings: impl Iterator<Item = String>) -> Result<Table, Error> {
        Table::open(Some(path), headings)
    }

    /// A new file, or the standard output, with its headings.
    pub fn open(path: Option<&Path>, headings: impl Iterator<Item = String>) -> Result<Table, Error> {
        let (path, out): (_, Box<dyn Write>) = match path {
            Some(path) => (path, Box::new(files::create(path).map_err(Error::file(path))?)),
            None => (Path::new("standard output"), Box::new(io::stdout().lock())),
        };
        let mut table = Table {
            path: path.to_owned(),
            writer: csv::Writer::from_writer(out),
        };
        table.record(headings)?;
        Ok(table)
    }

    /// One row in which cells may be empty.
    pub fn write_some(&mut self, values: impl Iterator<Item = Option<f64>>) -> Result<(), Error> {
        self.record(values.map(|value| value.map_or_else(String::new, shortest)))
    }

    /// One row with names in its first cells.
    pub fn write_named(&mut self, names: &[&str], values: impl Iterator<Item = f64>) -> Result<(), Error> {
        let names = names.iter().map(|&name| name.to_owned());
        self.record(names.chain(values.map(shortest)))
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
