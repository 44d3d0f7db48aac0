//! A scenario: a table of inputs over time as CSV, its headings with or without units, read into a schedule.

use crate::names;
use crate::table;
use std::fs::File;
use std::path::{Path, PathBuf};
use wheelrail::fmi::units::{DisplayUnit, Unit};
use wheelrail::signals::InputSignal;
use wheelrail::simulation::{self, Point, Schedule};
use wheelrail::{Error as ModelError, INPUTS, Inputs, Parameters};

/// Reason why a file does not serve as a scenario.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// A file that does not serve as a table.
    #[error(transparent)]
    Table(#[from] table::Error),
    /// No heading.
    #[error("{path}: the file is empty; a scenario has a heading, time and inputs, and rows of numbers")]
    Empty {
        /// The file.
        path: PathBuf,
    },
    /// Columns that are separated by something else.
    #[error(
        "{path}: one column {heading:?}: commas separate the columns of a scenario, and a point stands before decimals"
    )]
    Separator {
        /// The file.
        path: PathBuf,
        /// The heading.
        heading: String,
    },
    /// A column that is no input.
    #[error("{path}: column {column:?} is not an input{is}; a scenario has time and any of {allowed}{meant}")]
    UnknownColumn {
        /// The file.
        path: PathBuf,
        /// The heading.
        column: String,
        /// Kind of the column: what it is instead.
        is: String,
        /// Columns that are allowed.
        allowed: String,
        /// Columns that may be meant.
        meant: String,
    },
    /// A unit that is none of the column's.
    #[error("{path}: column {column:?}: {unit:?} is not a unit of {name}, which has {allowed}")]
    UnknownUnit {
        /// The file.
        path: PathBuf,
        /// The heading.
        column: String,
        /// The unit in it.
        unit: String,
        /// The name in it.
        name: String,
        /// Units that are allowed.
        allowed: String,
    },
    /// A heading that is there twice.
    #[error("{path}: column {column:?} is there twice")]
    TwoColumns {
        /// The file.
        path: PathBuf,
        /// The name in the heading.
        column: String,
    },
    /// No column `time`.
    #[error("{path}: there is no column \"time\"")]
    NoTime {
        /// The file.
        path: PathBuf,
    },
    /// A row with more or fewer cells than there are headings.
    #[error(
        "{path}, line {line}: {cells} cells under {columns} headings; commas separate cells, a point stands before decimals"
    )]
    Ragged {
        /// The file.
        path: PathBuf,
        /// The line.
        line: u64,
        /// Cells of the row.
        cells: usize,
        /// Headings.
        columns: usize,
    },
    /// A cell that is not a number.
    #[error("{path}, line {line}, column {column:?}: {text:?} is not a number")]
    NotANumber {
        /// The file.
        path: PathBuf,
        /// The line.
        line: u64,
        /// The heading.
        column: String,
        /// The cell.
        text: String,
    },
    /// A time that is not finite.
    #[error("{path}, line {line}, column {column:?}: {value} is not a time")]
    TimeNotFinite {
        /// The file.
        path: PathBuf,
        /// The line.
        line: u64,
        /// The heading.
        column: String,
        /// The time.
        value: f64,
    },
    /// A time that does not lie after the one before it.
    #[error("{path}, line {line}, column {column:?}: {value} s is not after {before} s, the time of the row before")]
    TimeNotAscending {
        /// The file.
        path: PathBuf,
        /// The line.
        line: u64,
        /// The heading.
        column: String,
        /// The time, `s`.
        value: f64,
        /// The time of the row before, `s`.
        before: f64,
    },
    /// A value that the model refuses.
    #[error("{path}, line {line}, column {column:?}: {source}")]
    Value {
        /// The file.
        path: PathBuf,
        /// The line.
        line: u64,
        /// The heading.
        column: String,
        /// Reason.
        source: Box<ModelError>,
    },
    /// Values that the model refuses together, or that of an input without a column.
    #[error("{path}, line {line}: {source}")]
    Row {
        /// The file.
        path: PathBuf,
        /// The line.
        line: u64,
        /// Inputs that are refused, and the reason.
        source: Box<ModelError>,
    },
    /// A column without effect.
    #[error(
        "{path}, line {line}, column {column:?}: {source}; say --set slip_source={number}, or leave the column out"
    )]
    NotUsed {
        /// The file.
        path: PathBuf,
        /// The line of the first value other than the start value.
        line: u64,
        /// The heading.
        column: String,
        /// Input that has no effect, and what uses it.
        source: Box<ModelError>,
        /// The choice that uses it.
        number: i32,
    },
    /// Fewer than two rows.
    #[error("{path}: a scenario needs at least two rows, this one has {rows}")]
    TooShort {
        /// The file.
        path: PathBuf,
        /// Number of rows in the file.
        rows: usize,
    },
}

/// Quantity that a column holds.
enum Quantity {
    Time,
    Input(&'static InputSignal),
}

/// A column of the file.
struct Column {
    /// Heading as the file has it.
    heading: String,
    quantity: Quantity,
    /// The unit of its cells.
    unit: DisplayUnit,
}

/// A row of the file.
struct ScenarioRow {
    line: u64,
    time: f64,
    inputs: Inputs,
}

/// Factor of `largest_load` over the largest load of a scenario, where it follows them.
const HEADROOM: f64 = 1.05;
/// Largest load that `largest_load` follows, that of a wheel under an axle of 40 t, `N`: a larger one is more likely a
/// slip of the pen.
const HEAVIEST_WHEEL: f64 = 200e3;

/// Reads the table and checks each value against the parameters, whose `largest_load` follows the loads if asked for.
///
/// The start value of `largest_load` resolves the load of a passenger coach's wheel, which a window for a locomotive's would do
/// more coarsely.
pub fn read(path: &Path, parameters: &mut Parameters, load_follows: bool) -> Result<Schedule, Error> {
    let csv_error = table::Error::csv(path);
    let file = File::open(path).map_err(table::Error::file(path))?;
    let mut reader = csv::ReaderBuilder::new()
        .trim(csv::Trim::All)
        .comment(Some(b'#'))
        // Rows of another length are refused below, with a reason.
        .flexible(true)
        .from_reader(file);
    let headings = reader.headers().map_err(&csv_error)?.clone();
    let columns = columns(path, &headings)?;

    let mut rows: Vec<ScenarioRow> = Vec::new();
    for record in reader.records() {
        let record = record.map_err(&csv_error)?;
        let row = row(path, &columns, &record)?;
        if let Some(before) = rows.last().map(|row| row.time).filter(|before| row.time <= *before) {
            let time = columns.iter().find(|column| matches!(column.quantity, Quantity::Time));
            return Err(Error::TimeNotAscending {
                path: path.to_owned(),
                line: row.line,
                column: time.map(|column| column.heading.clone()).unwrap_or_default(),
                value: row.time,
                before,
            });
        }
        rows.push(row);
    }
    let largest = rows.iter().map(|row| row.inputs.normal_load).fold(0.0, f64::max);
    if load_follows && largest > parameters.largest_load && largest <= HEAVIEST_WHEEL {
        parameters.largest_load = HEADROOM * largest;
    }
    for row in &rows {
        check(path, &columns, row, parameters)?;
    }
    check_used(path, &columns, &rows, parameters)?;
    let points = rows.iter().map(|row| Point {
        time: row.time,
        inputs: row.inputs,
    });
    // The times ascend.
    Schedule::new(points.collect()).map_err(|_: simulation::Error| Error::TooShort {
        path: path.to_owned(),
        rows: rows.len(),
    })
}

/// Name and unit in a heading such as `normal_load [kN]`.
fn parts(heading: &str) -> (&str, Option<&str>) {
    match heading.strip_suffix(']').and_then(|heading| heading.split_once('[')) {
        Some((name, unit)) => (name.trim(), Some(unit.trim())),
        None => (heading, None),
    }
}

fn columns(path: &Path, headings: &csv::StringRecord) -> Result<Vec<Column>, Error> {
    let path = || path.to_owned();
    if headings.is_empty() {
        return Err(Error::Empty { path: path() });
    }
    if let (1, Some(heading)) = (headings.len(), headings.get(0))
        && heading.contains([';', '\t'])
    {
        let heading = heading.to_owned();
        return Err(Error::Separator { path: path(), heading });
    }
    let mut columns: Vec<Column> = Vec::with_capacity(headings.len());
    for (index, heading) in headings.iter().enumerate() {
        let (name, unit) = parts(heading);
        if headings.iter().take(index).any(|other| parts(other).0 == name) {
            return Err(Error::TwoColumns {
                path: path(),
                column: name.to_owned(),
            });
        }
        let signal = INPUTS.iter().find(|signal| signal.name == name);
        let (quantity, own) = match (name, signal) {
            ("time", _) => (Quantity::Time, "s"),
            (_, Some(signal)) => (Quantity::Input(signal), signal.unit),
            _ => {
                let (is, meant) = hints(name);
                return Err(Error::UnknownColumn {
                    path: path(),
                    column: heading.to_owned(),
                    is,
                    allowed: INPUTS.iter().map(|signal| signal.name).collect::<Vec<_>>().join(", "),
                    meant,
                });
            }
        };
        // Without a unit it is the variable's own.
        let spelled = unit.unwrap_or(own);
        let units = Unit::named(own);
        let unit = units
            .and_then(|units| units.spelled(spelled))
            .ok_or_else(|| Error::UnknownUnit {
                path: path(),
                column: heading.to_owned(),
                unit: spelled.to_owned(),
                name: name.to_owned(),
                allowed: units.map(Unit::names).unwrap_or_default(),
            })?;
        columns.push(Column {
            heading: heading.to_owned(),
            quantity,
            unit,
        });
    }
    if columns.iter().any(|column| matches!(column.quantity, Quantity::Time)) {
        Ok(columns)
    } else {
        Err(Error::NoTime { path: path() })
    }
}

/// Returns what a column that is no input is instead, and which one may be meant; either is empty where nothing is
/// known.
fn hints(name: &str) -> (String, String) {
    if names::is_output(name) {
        return (" but an output, which is computed".to_owned(), String::new());
    }
    if names::parameters().any(|parameter| parameter == name) {
        return (format!(" but a parameter, --set {name}=VALUE"), String::new());
    }
    let known = || std::iter::once("time").chain(INPUTS.iter().map(|signal| signal.name));
    // A unit in other brackets, or behind a stroke.
    let end = name.find(|c: char| !c.is_ascii_alphanumeric() && c != '_');
    match end.map(|end| (&name[..end], &name[end..])) {
        Some((start, rest)) if known().any(|known| known == start) => {
            let unit = rest.trim_matches(|c: char| c.is_whitespace() || "()/{}<>,:".contains(c));
            let meant = format!("; a unit stands in square brackets, {start} [{unit}]");
            (String::new(), meant)
        }
        _ => (String::new(), names::did_you_mean(name, known())),
    }
}

/// A row, each value in the unit of its variable.
fn row(path: &Path, columns: &[Column], record: &csv::StringRecord) -> Result<ScenarioRow, Error> {
    let path = || path.to_owned();
    let line = record.position().map_or(0, csv::Position::line);
    if record.len() != columns.len() {
        return Err(Error::Ragged {
            path: path(),
            line,
            cells: record.len(),
            columns: columns.len(),
        });
    }
    let mut inputs = Inputs::default();
    let mut time = f64::NAN;
    for (column, text) in columns.iter().zip(record) {
        let heading = || column.heading.clone();
        let shown: f64 = text.parse().map_err(|_| Error::NotANumber {
            path: path(),
            line,
            column: heading(),
            text: text.to_owned(),
        })?;
        let value = column.unit.to_unit(shown);
        match column.quantity {
            Quantity::Time if !value.is_finite() => {
                return Err(Error::TimeNotFinite {
                    path: path(),
                    line,
                    column: heading(),
                    value,
                });
            }
            Quantity::Time => time = value,
            Quantity::Input(signal) => (signal.set)(&mut inputs, value),
        }
    }
    Ok(ScenarioRow { line, time, inputs })
}

/// Refuses inputs that the model does not take under the parameters.
fn check(path: &Path, columns: &[Column], row: &ScenarioRow, parameters: &Parameters) -> Result<(), Error> {
    for column in columns {
        if let Quantity::Input(signal) = column.quantity {
            let checked = signal.check((signal.get)(&row.inputs), parameters);
            checked.map_err(|source| Error::Value {
                path: path.to_owned(),
                line: row.line,
                column: column.heading.clone(),
                source: Box::new(source),
            })?;
        }
    }
    row.inputs.check(parameters).map_err(|source| Error::Row {
        path: path.to_owned(),
        line: row.line,
        source: Box::new(source),
    })
}

/// Refuses a column without effect: a column that is given is meant. One that is everywhere at the input's start value says
/// nothing, and passes: tables that have a column for each input, as `wheelrail simulate` writes them, can be read.
fn check_used(path: &Path, columns: &[Column], rows: &[ScenarioRow], parameters: &Parameters) -> Result<(), Error> {
    for column in columns {
        let Quantity::Input(signal) = column.quantity else {
            continue;
        };
        for row in rows {
            let used = signal.check_used((signal.get)(&row.inputs), parameters);
            used.map_err(|source| Error::NotUsed {
                path: path.to_owned(),
                line: row.line,
                column: column.heading.clone(),
                number: match source {
                    ModelError::NotUsed { other_number, .. } => other_number,
                    _ => 0,
                },
                source: Box::new(source),
            })?;
        }
    }
    Ok(())
}
