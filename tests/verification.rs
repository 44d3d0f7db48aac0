//! What `wheelrail verify` prints, one test for each check, named by its heading: `cargo test --test verification Carter`.
//! `make test` leaves them out by the beginning of their names: it has run `wheelrail verify`.

use libtest_mimic::{Arguments, Failed, Trial, run};
use wheelrail::verification::{CHECKS, Check};

/// Every row passes, and there is at least one.
fn passes(check: &Check) -> Result<(), Failed> {
    let rows = (check.rows)()?;
    let failed: Vec<_> = rows.iter().filter(|row| !row.pass).collect();
    if rows.is_empty() || !failed.is_empty() {
        return Err(format!("{} of {} rows fail: {failed:#?}", failed.len(), rows.len()).into());
    }
    Ok(())
}

fn main() {
    let trials = CHECKS
        .iter()
        .map(|check| Trial::test(format!("verify: {}", check.name), || passes(check)));
    run(&Arguments::from_args(), trials.collect()).exit();
}
