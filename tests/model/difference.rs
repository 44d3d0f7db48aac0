//! How far apart two fields are.

/// Largest absolute difference of two slices over the largest absolute value of the first.
pub fn largest_difference(expected: &[f64], computed: &[f64]) -> f64 {
    assert_eq!(expected.len(), computed.len());
    let largest = expected.iter().fold(f64::MIN_POSITIVE, |m, v| v.abs().max(m));
    let differences = expected.iter().zip(computed).map(|(a, b)| (a - b).abs());
    // Not `f64::max`, which passes over NaN.
    differences.fold(0.0, |m, d| if d <= m { m } else { d }) / largest
}
