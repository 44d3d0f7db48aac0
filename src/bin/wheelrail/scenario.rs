//! A scenario: a table of inputs over time as CSV, its headings with or without units, read into a schedule.

mod error;

use crate::names;
use crate::table;
use std::fs::File;
use std::path::Path;
use wheelrail::fmi::units::{DisplayUnit, Unit};
use wheelrail::signals::InputSignal;
use wheelrail::simulation::{self, Point, Schedule};
use wheelrail::{Error as ModelError, INPUTS, Inputs, Parameters};

pub use error::Error;

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
                used_by: match source {
                    ModelError::NotUsed {
                        parameter,
                        other_number,
                        ..
                    } => format!("{parameter}={other_number}"),
                    _ => String::new(),
                },
                source: Box::new(source),
            })?;
        }
    }
    Ok(())
}
