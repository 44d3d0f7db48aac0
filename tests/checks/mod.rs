//! What the tests share.

use wheelrail::error::Error;
use wheelrail::verification::Row;

/// Every row passes, and there is at least one.
#[allow(dead_code)]
pub fn assert_rows(rows: Result<Vec<Row>, Error>) {
    let rows = rows.unwrap();
    assert!(!rows.is_empty());
    for row in &rows {
        assert!(row.pass, "{row:#?}");
    }
}

/// Largest absolute difference of two slices over the largest absolute value of the first.
#[allow(dead_code)]
pub fn largest_difference(expected: &[f64], computed: &[f64]) -> f64 {
    assert_eq!(expected.len(), computed.len());
    let largest = expected.iter().fold(f64::MIN_POSITIVE, |m, v| v.abs().max(m));
    let differences = expected.iter().zip(computed).map(|(a, b)| (a - b).abs());
    // Not `f64::max`, which passes over NaN.
    differences.fold(0.0, |m, d| if d <= m { m } else { d }) / largest
}
