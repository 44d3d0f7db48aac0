//! Finite differences that the tests of tangents share.

use std::fmt::Display;

/// Central difference of a function at 0, over 2 `h`.
pub fn slope(at: impl Fn(f64) -> f64, h: f64) -> f64 {
    (at(h) - at(-h)) / (2.0 * h)
}

/// Asserts that each entry of a tangent is the difference of the values ahead and behind, which are `width` apart, to `allowed`.
pub fn assert_tangent(place: impl Display, tangent: &[f64], ends: [&[f64]; 2], width: f64, allowed: f64) {
    assert_eq!(ends.map(<[f64]>::len), [tangent.len(); 2], "{place}");
    let [ahead, behind] = ends;
    for (k, ((exact, ahead), behind)) in tangent.iter().zip(ahead).zip(behind).enumerate() {
        let difference = (ahead - behind) / width;
        assert!(
            (exact - difference).abs() <= allowed,
            "{place} {k}: {exact} {difference} ± {allowed:e}"
        );
    }
}
