//! `wheelrail simulate`: a scenario from CSV through the model, without FMI.

use crate::table::{self, Table};
use crate::{fields, preset};
use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use wheelrail::signals::InputSignal;
use wheelrail::simulation::{self, Point, Schedule};
use wheelrail::{Error as ModelError, INPUTS, Inputs, Model, OUTPUTS, Outputs, Parameters, Simulation};

/// Options of `simulate`.
#[derive(Args)]
pub struct Simulate {
    /// The scenario: time and inputs, linear between the rows.
    #[arg(value_name = "SCENARIO.csv")]
    scenario: PathBuf,
    /// Where time, all inputs and all outputs go.
    #[arg(short, long, value_name = "OUT.csv")]
    output: PathBuf,
    /// Where the fields at the end go: a row for each node of a line contact or cell of a patch.
    #[arg(long, value_name = "FIELDS.csv")]
    fields: Option<PathBuf>,
    /// Communication step, `s`.
    #[arg(long, value_name = "SECONDS", default_value_t = 1e-3)]
    step: f64,
    /// Named parameters: one of `wheelrail presets`, or a file of that kind. Repeatable; a later one has precedence.
    #[arg(long, value_name = "NAME|FILE.toml")]
    preset: Vec<String>,
    /// A parameter, as thermal_expansion=0; `wheelrail describe` lists them. Repeatable, and before any preset.
    #[arg(long = "set", value_name = "NAME=VALUE")]
    set: Vec<String>,
}

/// Why a simulation stopped.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// A file that does not serve as a table.
    #[error(transparent)]
    Table(#[from] table::Error),
    /// Two results in one file.
    #[error("--fields {path}: this is where the outputs go")]
    OneFile {
        /// The file.
        path: PathBuf,
    },
    /// A column that is no input.
    #[error("{path}: column {column:?} is not an input; a scenario has time and any of {allowed}")]
    UnknownColumn {
        /// The file.
        path: PathBuf,
        /// The heading.
        column: String,
        /// What it may be.
        allowed: String,
    },
    /// A heading that is there twice.
    #[error("{path}: column {column:?} is there twice")]
    TwoColumns {
        /// The file.
        path: PathBuf,
        /// The heading.
        column: String,
    },
    /// No column `time`.
    #[error("{path}: there is no column \"time\"")]
    NoTime {
        /// The file.
        path: PathBuf,
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
    /// A time that is not finite or does not lie after the one before it.
    #[error("{path}, line {line}, column \"time\": {value} is not after {before}")]
    TimeNotAscending {
        /// The file.
        path: PathBuf,
        /// The line.
        line: u64,
        /// The time.
        value: f64,
        /// The time of the row before.
        before: f64,
    },
    /// A value that the model refuses.
    #[error("{path}, line {line}: {source}")]
    Refused {
        /// The file.
        path: PathBuf,
        /// The line.
        line: u64,
        /// Which input and why.
        source: ModelError,
    },
    /// Fewer than two rows.
    #[error("{path}: a scenario needs at least two rows, this one has {rows}")]
    TooShort {
        /// The file.
        path: PathBuf,
        /// Its rows.
        rows: usize,
    },
    /// A communication step that cannot be.
    #[error("--step {step}: the communication step is a positive, finite number of seconds")]
    Step {
        /// What was given.
        step: f64,
    },
    /// A `--set` without an equals sign.
    #[error("--set {text:?}: expected name=value")]
    NotAnAssignment {
        /// What was given.
        text: String,
    },
    /// A named set of parameters that does not serve.
    #[error("--preset: {0}")]
    Preset(#[from] preset::Error),
    /// A parameter that cannot be.
    #[error("{0}")]
    Parameter(ModelError),
    /// The model cannot start.
    #[error("at the start of the scenario: {0}")]
    Start(ModelError),
    /// The model cannot go on.
    #[error("{source}; {output} holds what was computed before")]
    Interrupted {
        /// The results.
        output: PathBuf,
        /// Which step, and why.
        source: simulation::Error,
    },
}

impl Simulate {
    /// Runs the command.
    pub fn run(&self) -> Result<(), Error> {
        let parameters = self.parameters()?;
        let schedule = read_schedule(&self.scenario, &parameters)?;
        let steps = schedule.steps(self.step).map_err(|_| Error::Step { step: self.step })?;
        let model = Arc::new(Model::new(parameters).map_err(Error::Parameter)?);
        let start = schedule.start();
        let mut simulation = Simulation::of(model, &start.inputs).map_err(Error::Start)?;
        // Only now that nothing can be refused any more, so that a refusal leaves no file behind.
        let (mut table, mut fields) = self.tables()?;
        write(&mut table, &start, simulation.outputs())?;

        let count = steps.len();
        let bar = progress(count as u64);
        let mut interrupted = None;
        for step in steps {
            if let Err(source) = simulation.follow(&step) {
                interrupted = Some(source);
                break;
            }
            write(&mut table, &step.to, simulation.outputs())?;
            bar.inc(1);
        }
        table.finish()?;
        if let Some(fields) = &mut fields {
            fields::write(fields, &simulation)?;
        }
        if let Some(source) = interrupted {
            bar.abandon();
            let output = self.output.clone();
            return Err(Error::Interrupted { output, source });
        }
        bar.finish_and_clear();
        let end = schedule.end().time;
        eprintln!("{count} steps to {end} s: {}", self.output.display());
        Ok(())
    }

    /// The tables of results, or neither of them.
    fn tables(&self) -> Result<(Table, Option<Table>), Error> {
        if let Some(path) = self.fields.as_ref().filter(|path| **path == self.output) {
            return Err(Error::OneFile { path: path.clone() });
        }
        let inputs = INPUTS.iter().map(|signal| signal.name);
        let outputs = OUTPUTS.iter().map(|signal| signal.name);
        let table = Table::create(&self.output, std::iter::once("time").chain(inputs).chain(outputs))?;
        match self.fields.as_deref().map(fields::create).transpose() {
            Ok(fields) => Ok((table, fields)),
            Err(error) => {
                // What cannot be removed either is left; the refusal is what matters.
                let _ = fs::remove_file(&self.output);
                Err(error.into())
            }
        }
    }

    fn parameters(&self) -> Result<Parameters, Error> {
        let mut parameters = Parameters::default();
        for name in &self.preset {
            let title = preset::set(&mut parameters, name)?;
            eprintln!("preset {name}: {title}");
        }
        for text in &self.set {
            let (name, value) = text
                .split_once('=')
                .ok_or_else(|| Error::NotAnAssignment { text: text.clone() })?;
            parameters.set_by_name(name.trim(), value).map_err(Error::Parameter)?;
        }
        parameters.validate().map_err(Error::Parameter)?;
        Ok(parameters)
    }
}

fn progress(steps: u64) -> ProgressBar {
    // The template is a constant: without it the bar would only look plainer.
    let style = ProgressStyle::with_template("{bar:40} {pos}/{len} steps, {eta} left")
        .unwrap_or_else(|_| ProgressStyle::default_bar());
    ProgressBar::new(steps).with_style(style)
}

/// Reads the table and checks each value against the parameters.
fn read_schedule(path: &Path, parameters: &Parameters) -> Result<Schedule, Error> {
    let csv_error = table::Error::csv(path);
    let file = File::open(path).map_err(table::Error::file(path))?;
    let mut reader = csv::ReaderBuilder::new()
        .trim(csv::Trim::All)
        .comment(Some(b'#'))
        .from_reader(file);
    let headings = reader.headers().map_err(&csv_error)?.clone();
    let columns = columns(path, &headings)?;

    let (mut points, mut lines) = (Vec::new(), Vec::new());
    for record in reader.records() {
        let record = record.map_err(&csv_error)?;
        let line = record.position().map_or(0, csv::Position::line);
        let mut inputs = Inputs::default();
        let mut time = f64::NAN;
        for ((heading, column), text) in headings.iter().zip(&columns).zip(&record) {
            let value: f64 = text.parse().map_err(|_| Error::NotANumber {
                path: path.to_owned(),
                line,
                column: heading.to_owned(),
                text: text.to_owned(),
            })?;
            match column {
                Column::Time => time = value,
                Column::Input(signal) => (signal.set)(&mut inputs, value),
            }
        }
        inputs.check(parameters).map_err(|source| Error::Refused {
            path: path.to_owned(),
            line,
            source,
        })?;
        points.push(Point { time, inputs });
        lines.push(line);
    }
    Schedule::new(points).map_err(|error| match error {
        simulation::Error::TimeNotAscending { row, time, before } => Error::TimeNotAscending {
            path: path.to_owned(),
            line: lines[row],
            value: time,
            before,
        },
        _ => Error::TooShort {
            path: path.to_owned(),
            rows: lines.len(),
        },
    })
}

/// What a column of the scenario holds.
enum Column {
    Time,
    Input(&'static InputSignal),
}

fn columns(path: &Path, headings: &csv::StringRecord) -> Result<Vec<Column>, Error> {
    let mut columns = Vec::with_capacity(headings.len());
    for (index, heading) in headings.iter().enumerate() {
        if headings.iter().take(index).any(|other| other == heading) {
            return Err(Error::TwoColumns {
                path: path.to_owned(),
                column: heading.to_owned(),
            });
        }
        let signal = INPUTS.iter().find(|signal| signal.name == heading);
        columns.push(match (heading, signal) {
            ("time", _) => Column::Time,
            (_, Some(signal)) => Column::Input(signal),
            _ => {
                return Err(Error::UnknownColumn {
                    path: path.to_owned(),
                    column: heading.to_owned(),
                    allowed: INPUTS.iter().map(|signal| signal.name).collect::<Vec<_>>().join(", "),
                });
            }
        });
    }
    if columns.iter().any(|column| matches!(column, Column::Time)) {
        Ok(columns)
    } else {
        Err(Error::NoTime { path: path.to_owned() })
    }
}

/// A row of the table of results.
fn write(table: &mut Table, point: &Point, outputs: &Outputs) -> Result<(), Error> {
    let inputs = INPUTS.iter().map(|signal| (signal.get)(&point.inputs));
    let outputs = OUTPUTS.iter().map(|signal| (signal.get)(outputs));
    table.write(std::iter::once(point.time).chain(inputs).chain(outputs))?;
    Ok(())
}
