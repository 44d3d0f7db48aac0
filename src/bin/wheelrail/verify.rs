//! `wheelrail verify`: every check of the library as a table.

use std::fmt::Write as _;
use std::process::ExitCode;
use wheelrail::verification::{Row, CHECKS};

/// Prints the rows of each check as it ends. Failure where a row does not pass or a check cannot be computed.
pub fn run() -> ExitCode {
    println!("{}", heading());
    let (mut passed, mut failed) = (0, 0);
    for check in CHECKS {
        println!("\n{}", check.name);
        match (check.rows)() {
            Ok(rows) => {
                for row in &rows {
                    println!("{}", line(row));
                    if row.pass {
                        passed += 1;
                    } else {
                        failed += 1;
                    }
                }
            }
            Err(error) => {
                println!("  could not be computed: {error}");
                failed += 1;
            }
        }
    }
    println!("\n{passed} rows pass, {failed} fail");
    if failed == 0 {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    }
}

/// Width of the column of quantities.
const QUANTITY: usize = 88;

fn heading() -> String {
    format!(
        "{:QUANTITY$} {:>13} {:>13} {:4} {:>10} {:>10}  {:4}  reference from",
        "quantity", "reference", "computed", "unit", "deviation", "tolerance", "pass"
    )
}

fn line(row: &Row) -> String {
    let mut line = String::new();
    // Writing to a String does not fail.
    let _ = write!(
        line,
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
    );
    line
}

/// Six digits, with an exponent where the number is very small or large.
fn number(value: f64) -> String {
    let size = value.abs();
    if value == 0.0 || (1e-3..1e6).contains(&size) {
        format!("{value:.6}")
    } else {
        format!("{value:.5e}")
    }
}
