//! `wheelrail describe`: the variable table for people, or as `modelDescription.xml`.

use crate::standard::Standard;
use clap::Args;
use std::io::{self, Write};
use wheelrail::fmi2::variables::{Causality, Kind, Variability, Variable, variables};
use wheelrail::fmi3::terminals::terminals_and_icons;

/// Options of `describe`.
#[derive(Args)]
pub struct Describe {
    /// Print modelDescription.xml instead.
    #[arg(long)]
    xml: bool,
    /// Print terminalsAndIcons.xml of FMI 3.0 instead.
    #[arg(long, conflicts_with = "xml")]
    terminals: bool,
    /// The version of FMI that the XML is of.
    #[arg(long, value_name = "VERSION", default_value = "2", requires = "xml")]
    fmi: Standard,
    /// Print the table in Markdown.
    #[arg(long, conflicts_with = "xml")]
    markdown: bool,
    /// List every point of the profiles and every contact.
    #[arg(long, conflicts_with = "xml")]
    all: bool,
}

/// Reason why nothing could be described.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The XML serializer.
    #[error("the model description could not be written as XML: {0}")]
    Xml(#[from] quick_xml::SeError),
    /// Standard output.
    #[error("standard output: {0}")]
    Output(#[from] io::Error),
}

impl Describe {
    /// Runs the command.
    pub fn run(&self) -> Result<(), Error> {
        let mut out = io::stdout().lock();
        if self.xml {
            out.write_all(self.fmi.model_description()?.as_bytes())?;
            return Ok(());
        }
        if self.terminals {
            out.write_all(terminals_and_icons()?.as_bytes())?;
            return Ok(());
        }
        let table: Vec<_> = variables()
            .into_iter()
            .filter(|variable| self.all || is_listed(variable))
            .collect();
        for (causality, title) in [
            (Causality::Input, "Inputs"),
            (Causality::Output, "Outputs"),
            (Causality::Parameter, "Parameters (t: tunable)"),
            (Causality::Local, "Locals"),
        ] {
            let rows: Vec<_> = table
                .iter()
                .filter(|variable| variable.causality == causality)
                .map(row)
                .collect();
            if self.markdown {
                markdown(&mut out, title, &rows)?;
            } else {
                text(&mut out, title, &rows)?;
            }
        }
        Ok(())
    }
}

const HEADINGS: [&str; 5] = ["name", "unit", "start", "range", "description"];
type DescriptionRow = [String; 5];

/// Returns whether a variable is listed: of a profile only the first point is, of the contacts the first one.
fn is_listed(variable: &Variable) -> bool {
    variable.causality == Causality::Parameter || !variable.name.contains('[') || variable.name.ends_with("[1]")
}

fn row(variable: &Variable) -> DescriptionRow {
    let tunable = if variable.variability == Variability::Tunable {
        " t"
    } else {
        ""
    };
    let (unit, start, range) = match &variable.kind {
        Kind::Real {
            unit,
            minimum,
            maximum,
            start,
            ..
        } => (
            *unit,
            start.map(number),
            range(minimum.map(number), maximum.map(number)),
        ),
        Kind::Integer {
            minimum,
            maximum,
            start,
        } => {
            let text = |value: &Option<i32>| value.map(|value| value.to_string());
            ("", text(start), range(text(minimum), text(maximum)))
        }
        Kind::Text { start } => ("", Some((*start).to_owned()), String::new()),
    };
    [
        format!("{}{tunable}", variable.name),
        unit.to_owned(),
        start.unwrap_or_default(),
        range,
        variable.description.clone(),
    ]
}

fn number(value: f64) -> String {
    if value == 0.0 || (1e-3..1e6).contains(&value.abs()) {
        format!("{}", (value * 1e6).round() / 1e6)
    } else {
        format!("{value:e}")
    }
}

fn range(minimum: Option<String>, maximum: Option<String>) -> String {
    match (minimum, maximum) {
        (None, None) => String::new(),
        (Some(minimum), None) => format!(">= {minimum}"),
        (None, Some(maximum)) => format!("<= {maximum}"),
        (Some(minimum), Some(maximum)) => format!("{minimum} to {maximum}"),
    }
}

fn text(out: &mut impl Write, title: &str, rows: &[DescriptionRow]) -> io::Result<()> {
    let width = |column: usize| {
        let cells = rows.iter().map(|row| row[column].chars().count());
        cells.chain([HEADINGS[column].len()]).max().unwrap_or_default()
    };
    let widths = [0, 1, 2, 3].map(width);
    writeln!(out, "{title}")?;
    for row in [HEADINGS.map(str::to_owned)].iter().chain(rows) {
        for (cell, width) in row.iter().zip(widths) {
            write!(out, "  {cell:width$}")?;
        }
        writeln!(out, "  {}", row[4])?;
    }
    writeln!(out)
}

fn markdown(out: &mut impl Write, title: &str, rows: &[DescriptionRow]) -> io::Result<()> {
    writeln!(
        out,
        "### {title}\n\n| {} |\n|---|---|---|---|---|",
        HEADINGS.join(" | ")
    )?;
    for row in rows {
        writeln!(out, "| `{}` | {} |", row[0], row[1..].join(" | "))?;
    }
    writeln!(out)
}
