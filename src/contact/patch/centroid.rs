//! Place of the pressure within a strip, across it.
//!
//! Pressure and shear are uniform on a cell, but a strip's load falls towards the sides of the contact: more of it acts on the strip's
//! inner side, and the outermost strip is covered in part. With the loads l, P, r of three neighbouring strips to the left, in the
//! middle and to the right, and a load that is linear across them, the centroid of the middle one's lies (F(l/P) − F(r/P))/24 breadths to the left of its
//! middle. F(ρ) is ρ between strips that are covered. Of a strip that is covered in part, up to where the line comes to zero, it is what the line
//! would have at the strip's middle:
//!
//! F(ρ) = (w − ½)/(w + ½),  w = ρ + √(ρ² + ρ),  ρ < ⅓,
//!
//! with the covered part w of the breadth. Where it is the strip itself that is covered in part, its centroid is a third of the covered part away from its
//! inner side, F(ρ) = 11 − 8 (1/ρ + √(1/ρ² + 1/ρ)), ρ > 3; between 2 and 3 a cubic leads over, so that F is smooth.

use crate::body::grid::Grid;

/// Ratio of the loads of two strips below which the smaller one is covered in part.
const COVERED: f64 = 1.0 / 3.0;

/// F(ρ) and its derivative.
fn load_ratio(ratio: f64) -> (f64, f64) {
    if ratio < COVERED {
        let root = (ratio * ratio + ratio).sqrt();
        let covered = ratio + root;
        let slope = if root > 0.0 { 1.0 + (ratio + 0.5) / root } else { 0.0 };
        let value = (covered - 0.5) / (covered + 0.5);
        (value, slope / ((covered + 0.5) * (covered + 0.5)))
    } else if ratio <= 2.0 {
        (ratio, 1.0)
    } else if ratio * COVERED <= 1.0 {
        let (above, below) = (ratio - 2.0, ratio - 3.0);
        (ratio + above * above * below, 1.0 + above * (2.0 * below + above))
    } else {
        let inverse = 1.0 / ratio;
        let root = (inverse * inverse + inverse).sqrt();
        (
            11.0 - 8.0 * (inverse + root),
            8.0 * inverse * inverse * (1.0 + (inverse + 0.5) / root),
        )
    }
}

/// Sets the loads of the strips, or their changes: the sum of the pressure over each.
pub fn set_loads(grid: &Grid, pressure: &[f64], loads: &mut [f64]) {
    for (strip, load) in loads.iter_mut().enumerate() {
        *load = pressure[grid.row(strip)].iter().sum();
    }
}

/// Load of the strip so many to the left of a strip; 0 beyond the grid.
fn beside(loads: &[f64], strip: usize, left: isize) -> f64 {
    let strip = strip.checked_add_signed(left);
    strip.and_then(|strip| loads.get(strip)).copied().unwrap_or(0.0)
}

/// Distance of the centroid of a strip's load to the left of the strip's middle, in breadths of a strip; 0 without load.
pub fn centroid(loads: &[f64], strip: usize) -> f64 {
    let own = loads[strip];
    if own <= 0.0 {
        return 0.0;
    }
    let side = |left: isize| load_ratio(beside(loads, strip, left) / own).0;
    (side(1) - side(-1)) / 24.0
}

/// Change of [`centroid`] with the loads.
pub fn centroid_tangent(loads: &[f64], changes: &[f64], strip: usize) -> f64 {
    let own = loads[strip];
    if own <= 0.0 {
        return 0.0;
    }
    let side = |left: isize| {
        let ratio = beside(loads, strip, left) / own;
        load_ratio(ratio).1 * (beside(changes, strip, left) - ratio * changes[strip]) / own
    };
    (side(1) - side(-1)) / 24.0
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Loads of strips under a load that is linear between two places, by their breadths, and the centroids in closed form.
    fn linear(strips: usize, [zero, full]: [f64; 2]) -> (Vec<f64>, Vec<f64>) {
        let at = |y: f64| (y - zero) / (full - zero);
        let of = |strip: usize| {
            let (from, to) = ((strip as f64).max(zero), strip as f64 + 1.0);
            if from >= to {
                return (0.0, 0.0);
            }
            let (a, b, width) = (at(from), at(to), to - from);
            let load = 0.5 * (a + b) * width;
            let place = from + width * (a + 2.0 * b) / (3.0 * (a + b));
            (load, place - strip as f64 - 0.5)
        };
        (0..strips).map(of).unzip()
    }

    #[test]
    fn a_load_that_falls_to_zero_within_a_strip_has_the_centroid_of_a_triangle() {
        for part in 0..20 {
            let zero = 1.0 + 0.05 * f64::from(part) + 1e-9;
            let (loads, centroids) = linear(7, [zero, 9.0]);
            for strip in [1, 2, 4, 5] {
                let (found, exact) = (centroid(&loads, strip), centroids[strip]);
                // Where the next strip has two to three times as much, a cubic leads from one formula to the other.
                let cubic = matches!(loads[strip + 1] / loads[strip], 2.0..=3.0);
                let tolerance = if cubic { 0.15 / 24.0 } else { 1e-12 };
                assert!((found - exact).abs() < tolerance, "{zero} {strip}: {found} {exact}");
            }
        }
    }

    #[test]
    fn it_is_mirrored_and_stays_within_the_strip() {
        let mut state = 3_u64;
        for _ in 0..1000 {
            let loads: Vec<f64> = (0..5)
                .map(|_| {
                    state = state
                        .wrapping_mul(6_364_136_223_846_793_005)
                        .wrapping_add(1_442_695_040_888_963_407);
                    let unit = (state >> 11) as f64 / (1_u64 << 53) as f64;
                    (10.0_f64.powf(6.0 * unit) - 3.0).max(0.0)
                })
                .collect();
            let mirrored: Vec<f64> = loads.iter().rev().copied().collect();
            for strip in 0..5 {
                let found = centroid(&loads, strip);
                assert_eq!(found, -centroid(&mirrored, 4 - strip));
                assert!(found.abs() <= 0.5, "{loads:?} {strip}: {found}");
            }
        }
    }

    #[test]
    fn it_is_smooth_and_has_this_derivative() {
        for exponent in -60..60 {
            let loads = [0.4, 1.0, 10.0_f64.powf(0.05 * f64::from(exponent)), 0.1];
            let changes = [0.3, -0.2, 0.7 * loads[2], 0.05];
            let at = |step: f64| {
                let moved: Vec<f64> = loads
                    .iter()
                    .zip(changes)
                    .map(|(load, change)| load + step * change)
                    .collect();
                [1, 2].map(|strip| centroid(&moved, strip))
            };
            let step = 1e-6;
            let (after, before) = (at(step), at(-step));
            for (k, strip) in [1, 2].into_iter().enumerate() {
                let difference = (after[k] - before[k]) / (2.0 * step);
                let exact = centroid_tangent(&loads, &changes, strip);
                assert!(
                    (difference - exact).abs() < 1e-5 * (1.0 + exact.abs()),
                    "{loads:?}: {difference} {exact}"
                );
            }
        }
    }
}
