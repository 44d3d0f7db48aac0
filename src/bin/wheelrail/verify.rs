//! `wheelrail verify`: every check of the library as a table.

use clap::Args;
use std::collections::BTreeMap;
use std::fs;
use std::io::{self, Write};
use std::num::NonZero;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc;
use std::thread;
use wheelrail::error::Error as ModelError;
use wheelrail::verification::{CHECKS, CURVES, Check, Row};

/// Options of `verify`.
#[derive(Args)]
pub struct Verify {
    /// Run only the checks whose heading contains this text.
    #[arg(long, value_name = "TEXT", default_value = "")]
    only: String,
    /// Run no check; write the curves behind some of them to this folder as CSV, beside their closed forms.
    #[arg(long, value_name = "FOLDER", conflicts_with = "only")]
    curves: Option<PathBuf>,
}

/// Reason why the verification did not pass.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// Rows out of their tolerance, or checks that could not be computed.
    #[error("{failed} of {total} rows fail")]
    Failed {
        /// Rows that fail.
        failed: usize,
        /// All rows.
        total: usize,
    },
    /// No check's heading contains the text.
    #[error("no check is named {only:?}; there are: {names}")]
    NoSuchCheck {
        /// Text that was asked for.
        only: String,
        /// The headings.
        names: String,
    },
    /// Standard output.
    #[error("standard output: {0}")]
    Output(#[from] io::Error),
    /// A curve that cannot be written.
    #[error("{path}: {source}")]
    File {
        /// The file or folder.
        path: PathBuf,
        /// Error of the system.
        source: io::Error,
    },
    /// A curve that could not be computed.
    #[error("{name}: {source}")]
    Curve {
        /// Name of the check.
        name: &'static str,
        /// Error of the model.
        source: ModelError,
    },
}

impl Verify {
    /// Prints the rows of each check as it ends.
    pub fn run(&self) -> Result<(), Error> {
        if let Some(folder) = &self.curves {
            return write_curves(folder);
        }
        let only = self.only.to_lowercase();
        let chosen: Vec<_> = CHECKS
            .iter()
            .filter(|check| check.name.to_lowercase().contains(&only))
            .collect();
        if chosen.is_empty() {
            return Err(Error::NoSuchCheck {
                only: self.only.clone(),
                names: CHECKS.iter().map(|check| check.name).collect::<Vec<_>>().join(", "),
            });
        }
        let mut out = io::stdout().lock();
        writeln!(
            out,
            "{:QUANTITY$} {:>13} {:>13} {:4} {:>10} {:>10}  {:4}  reference",
            "quantity", "reference", "computed", "unit", "deviation", "tolerance", "pass"
        )?;
        let (mut total, mut failed) = (0, 0);
        compute(&chosen, |check, rows| {
            writeln!(out, "\n{}", check.name)?;
            match rows {
                Ok(rows) => {
                    total += rows.len();
                    failed += rows.iter().filter(|row| !row.pass).count();
                    for row in &rows {
                        print(&mut out, row)?;
                    }
                }
                Err(error) => {
                    writeln!(out, "  could not be computed: {error}")?;
                    total += 1;
                    failed += 1;
                }
            }
            out.flush()
        })?;
        writeln!(out, "\n{} of {total} rows pass", total - failed)?;
        if failed > 0 {
            return Err(Error::Failed { failed, total });
        }
        Ok(())
    }
}

/// Computes the checks on all cores, and hands on the rows of each in the order of the checks, as soon as they are there.
fn compute(
    checks: &[&Check],
    mut hand_on: impl FnMut(&Check, Result<Vec<Row>, ModelError>) -> io::Result<()>,
) -> io::Result<()> {
    let cores = thread::available_parallelism().map_or(1, NonZero::get);
    let next = AtomicUsize::new(0);
    let (sender, receiver) = mpsc::channel();
    thread::scope(|scope| {
        for _ in 0..cores.min(checks.len()) {
            let (sender, next) = (sender.clone(), &next);
            scope.spawn(move || {
                loop {
                    let number = next.fetch_add(1, Ordering::Relaxed);
                    let Some(check) = checks.get(number) else {
                        break;
                    };
                    // Nobody waits any more where the rows before could not be printed.
                    if sender.send((number, (check.rows)())).is_err() {
                        break;
                    }
                }
            });
        }
        drop(sender);
        let (mut computed, mut handed_on) = (BTreeMap::new(), 0);
        for (number, rows) in receiver {
            computed.insert(number, rows);
            while let Some(rows) = computed.remove(&handed_on) {
                hand_on(checks[handed_on], rows)?;
                handed_on += 1;
            }
        }
        Ok(())
    })
}

/// One file for each curve.
fn write_curves(folder: &Path) -> Result<(), Error> {
    let unwritable = |path: &Path| {
        let path = path.to_owned();
        move |source| Error::File { path, source }
    };
    fs::create_dir_all(folder).map_err(unwritable(folder))?;
    for curve in CURVES {
        let name = curve.name;
        let points = (curve.points)().map_err(|source| Error::Curve { name, source })?;
        let mut table = curve.columns.join(",") + "\n";
        for point in points {
            let cells: Vec<String> = point.iter().map(f64::to_string).collect();
            table += &(cells.join(",") + "\n");
        }
        let path = folder.join(name).with_extension("csv");
        fs::write(&path, table).map_err(unwritable(&path))?;
    }
    Ok(())
}

/// Width of the column of quantities.
const QUANTITY: usize = 84;

fn print(out: &mut impl Write, row: &Row) -> io::Result<()> {
    writeln!(
        out,
        "  {:width$} {:>13} {:>13} {:4} {:>10} {:>10}  {:4}  {}",
        row.quantity,
        number(row.reference),
        number(row.computed),
        row.unit,
        format!("{:.2e}", row.deviation),
        format!("{:.1e}", row.tolerance),
        if row.pass { "yes" } else { "NO" },
        row.source,
        width = QUANTITY - 2,
    )
}

/// Six decimals, or an exponent where the number is very small or large.
fn number(value: f64) -> String {
    if value == 0.0 || (1e-3..1e6).contains(&value.abs()) {
        format!("{value:.6}")
    } else {
        format!("{value:.5e}")
    }
}
