//! Reasons why a file does not serve as a scenario.

use crate::table;
use std::path::PathBuf;
use wheelrail::Error as ModelError;

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
    #[error(
        "{path}, line {line}, column {column:?}: {} s is not after {} s, the time of the row before",
        to_twelve_digits(*value),
        to_twelve_digits(*before)
    )]
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
    #[error("{path}, line {line}, column {column:?}: {source}; say --set {used_by}, or leave the column out")]
    NotUsed {
        /// The file.
        path: PathBuf,
        /// The line of the first value other than the start value.
        line: u64,
        /// The heading.
        column: String,
        /// Input that has no effect, and what uses it.
        source: Box<ModelError>,
        /// The choice that uses it: parameter=number.
        used_by: String,
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

/// A time to twelve digits, without those of round-off that a conversion of units leaves.
fn to_twelve_digits(time: f64) -> f64 {
    format!("{time:.11e}").parse().unwrap_or(time)
}
