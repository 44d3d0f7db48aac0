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
    writer: csv::Writer<WholeLines<Box<dyn Write>>>,
}

/// Writer that hands on whole lines alone. The buffer of a table is handed on when it is full, wherever a row stands then: who
/// stops the program would find half a number at the end of the file, which reads as another number.
struct WholeLines<W> {
    out: W,
    /// Beginning of a line whose end has not come yet.
    begun: Vec<u8>,
}

impl<W: Write> Write for WholeLines<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.begun.extend_from_slice(bytes);
        if let Some(end) = self.begun.iter().rposition(|byte| *byte == b'\n') {
            self.out.write_all(&self.begun[..=end])?;
            self.begun.drain(..=end);
        }
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }
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
        let mut table = Table::of(path, out);
        table.record(headings)?;
        Ok(table)
    }

    fn of(path: &Path, out: Box<dyn Write>) -> Table {
        let begun = Vec::new();
        Table {
            path: path.to_owned(),
            writer: csv::Writer::from_writer(WholeLines { out, begun }),
        }
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

#[cfg(test)]
mod tests {
    use super::*;
    use std::cell::RefCell;
    use std::rc::Rc;

    /// Calls that a file would get, each with its bytes as text.
    struct Calls(Rc<RefCell<Vec<String>>>);

    impl Write for Calls {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            self.0.borrow_mut().push(String::from_utf8(bytes.to_vec()).unwrap());
            Ok(bytes.len())
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    /// Rows that fill the buffer many times: at no moment does the file end within one, and not every row is a call.
    #[test]
    fn a_file_is_given_whole_rows_alone() {
        let calls = Rc::new(RefCell::new(Vec::new()));
        let mut table = Table::of(Path::new("rows.csv"), Box::new(Calls(calls.clone())));
        let rows = 5000;
        for row in 0..rows {
            table
                .write([f64::from(row), 293.681_549_017, 1.0 / 3.0].into_iter())
                .unwrap();
        }
        table.finish().unwrap();
        let calls = calls.borrow();
        assert!(calls.iter().all(|call| call.ends_with('\n')));
        assert!((2..rows as usize / 100).contains(&calls.len()), "{}", calls.len());
        let text = calls.concat();
        assert_eq!(text.lines().count(), rows as usize);
        assert!(
            text.lines()
                .all(|line| line.ends_with(",293.681549017,0.3333333333333333"))
        );
    }
}
