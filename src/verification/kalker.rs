//! Kalker's coefficients of the linear theory of rolling contact: the creep forces of an elliptic contact of like bodies at
//! creepages so small that nothing slips,
//! F_x = G ab C₁₁ ξ, F_y = −G ab (C₂₂ η + √(ab) C₂₃ φ), M_z = G (ab)^{3/2} C₂₃ η − G (ab)² C₃₃ φ,
//! with the semi-axes a along the rail and b across it.
//!
//! The table is that of J.J. Kalker, Three-Dimensional Elastic Bodies in Rolling Contact (1990), table E.3. C₁₁, C₂₂ and C₂₃ were
//! compared with two other prints; for C₃₃ there was none, its digits are from memory. All entries were compared with a numerical
//! solution of full adhesion: constant tractions on 80 × 80 and 160 × 160 elements over the ellipse, referred to the area of those
//! elements, which is not quite the ellipse's, and extrapolated to infinitely many. For a/b from 0.2 to 3.3 all four are within 0.8 %
//! of it, beyond within 1.2 %; the third digit of C₃₃ rounds by up to 0.5 %.

/// Poisson's ratios of the table.
const POISSON_RATIOS: [f64; 3] = [0.0, 0.25, 0.5];

/// C₁₁, C₂₂, C₂₃ and C₃₃, each at the three Poisson's ratios.
type CoefficientRow = [[f64; 3]; 4];

/// a/b = 0.1, 0.2 to 1.
#[allow(clippy::approx_constant)] // Entries of 3.14 are Kalker's.
const SHORT: [CoefficientRow; 10] = [
    [
        [2.51, 3.31, 4.85],
        [2.51, 2.52, 2.53],
        [0.334, 0.473, 0.731],
        [6.42, 8.28, 11.7],
    ],
    [
        [2.59, 3.37, 4.81],
        [2.59, 2.63, 2.66],
        [0.483, 0.603, 0.809],
        [3.46, 4.27, 5.66],
    ],
    [
        [2.68, 3.44, 4.80],
        [2.68, 2.75, 2.81],
        [0.607, 0.715, 0.889],
        [2.49, 2.96, 3.72],
    ],
    [
        [2.78, 3.53, 4.82],
        [2.78, 2.88, 2.98],
        [0.720, 0.823, 0.977],
        [2.02, 2.32, 2.77],
    ],
    [
        [2.88, 3.62, 4.83],
        [2.88, 3.01, 3.14],
        [0.827, 0.929, 1.07],
        [1.74, 1.93, 2.22],
    ],
    [
        [2.98, 3.72, 4.91],
        [2.98, 3.14, 3.31],
        [0.930, 1.03, 1.18],
        [1.56, 1.68, 1.86],
    ],
    [
        [3.09, 3.81, 4.97],
        [3.09, 3.28, 3.48],
        [1.03, 1.14, 1.29],
        [1.43, 1.50, 1.60],
    ],
    [
        [3.19, 3.91, 5.05],
        [3.19, 3.41, 3.65],
        [1.13, 1.25, 1.40],
        [1.34, 1.37, 1.42],
    ],
    [
        [3.29, 4.01, 5.12],
        [3.29, 3.54, 3.82],
        [1.23, 1.36, 1.51],
        [1.27, 1.27, 1.27],
    ],
    [
        [3.40, 4.12, 5.20],
        [3.40, 3.67, 3.98],
        [1.33, 1.47, 1.63],
        [1.21, 1.19, 1.16],
    ],
];

/// b/a = 0.1, 0.2 to 1.
const LONG: [CoefficientRow; 10] = [
    [
        [10.7, 11.7, 12.9],
        [10.7, 12.8, 16.0],
        [12.2, 14.6, 18.0],
        [0.795, 0.526, 0.228],
    ],
    [
        [6.96, 7.78, 8.82],
        [6.96, 8.14, 9.79],
        [5.72, 6.63, 7.89],
        [0.828, 0.601, 0.341],
    ],
    [
        [5.57, 6.34, 7.34],
        [5.57, 6.40, 7.51],
        [3.79, 4.32, 5.01],
        [0.868, 0.674, 0.446],
    ],
    [
        [4.84, 5.57, 6.57],
        [4.84, 5.48, 6.31],
        [2.88, 3.24, 3.70],
        [0.912, 0.747, 0.549],
    ],
    [
        [4.37, 5.10, 6.11],
        [4.37, 4.90, 5.56],
        [2.35, 2.62, 2.96],
        [0.958, 0.819, 0.650],
    ],
    [
        [4.06, 4.78, 5.80],
        [4.06, 4.50, 5.04],
        [2.01, 2.23, 2.50],
        [1.01, 0.892, 0.751],
    ],
    [
        [3.82, 4.54, 5.58],
        [3.82, 4.21, 4.67],
        [1.76, 1.95, 2.18],
        [1.05, 0.965, 0.852],
    ],
    [
        [3.65, 4.36, 5.42],
        [3.65, 3.99, 4.39],
        [1.58, 1.75, 1.94],
        [1.10, 1.04, 0.954],
    ],
    [
        [3.51, 4.22, 5.30],
        [3.51, 3.81, 4.16],
        [1.44, 1.59, 1.77],
        [1.16, 1.11, 1.06],
    ],
    [
        [3.40, 4.12, 5.20],
        [3.40, 3.67, 3.98],
        [1.33, 1.47, 1.63],
        [1.21, 1.19, 1.16],
    ],
];

/// Kalker's coefficients of one ellipse and one material, without a unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CreepCoefficients {
    /// C₁₁: longitudinal force by longitudinal creepage.
    pub longitudinal: f64,
    /// C₂₂: lateral force by lateral creepage.
    pub lateral: f64,
    /// C₂₃ = −C₃₂: lateral force by spin, spin moment by lateral creepage.
    pub lateral_spin: f64,
    /// C₃₃: spin moment by spin.
    pub spin: f64,
}

impl CreepCoefficients {
    /// The coefficients at a/b from 0.1 to 10 and Poisson's ratios from 0 to 0.5; none outside. Between the entries they are
    /// linear in a/b below 1 and in b/a above, and the parabola through the three Poisson's ratios.
    pub fn of(axis_ratio: f64, poisson_ratio: f64) -> Option<CreepCoefficients> {
        let (table, ratio) = if axis_ratio <= 1.0 {
            (&SHORT, axis_ratio)
        } else {
            (&LONG, axis_ratio.recip())
        };
        if !(0.1..=1.0).contains(&ratio) || !(0.0..=0.5).contains(&poisson_ratio) {
            return None;
        }
        // From 0.1 in tenths: the last interval ends at 1.
        let place = 10.0 * ratio - 1.0;
        let row = (place as usize).min(table.len() - 2);
        let share = place - row as f64;
        let value = |coefficient: usize| {
            let [below, above] =
                [row, row + 1].map(|row| through_poisson_ratios(&table[row][coefficient], poisson_ratio));
            below + share * (above - below)
        };
        Some(CreepCoefficients {
            longitudinal: value(0),
            lateral: value(1),
            lateral_spin: value(2),
            spin: value(3),
        })
    }
}

/// Lagrange's parabola through the values at the table's Poisson's ratios.
fn through_poisson_ratios(values: &[f64; 3], poisson_ratio: f64) -> f64 {
    let [zero, quarter, half] = POISSON_RATIOS.map(|node| poisson_ratio - node);
    8.0 * quarter * half * values[0] - 16.0 * zero * half * values[1] + 8.0 * zero * quarter * values[2]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn values(axis_ratio: f64, poisson_ratio: f64) -> [f64; 4] {
        let of = CreepCoefficients::of(axis_ratio, poisson_ratio).unwrap();
        [of.longitudinal, of.lateral, of.lateral_spin, of.spin]
    }

    fn assert_near(computed: [f64; 4], expected: [f64; 4], tolerance: f64) {
        for (computed, expected) in computed.into_iter().zip(expected) {
            assert!(
                (computed - expected).abs() <= tolerance * expected,
                "{computed} is not {expected}"
            );
        }
    }

    /// Interpolation at the entries of the table: it is the entry.
    #[test]
    fn table_at_its_entries() {
        for (tenths, (short, long)) in (1..).zip(SHORT.iter().zip(&LONG)) {
            for (at, poisson_ratio) in POISSON_RATIOS.into_iter().enumerate() {
                let ratio = 0.1 * f64::from(tenths);
                assert_near(values(ratio.min(1.0), poisson_ratio), short.map(|row| row[at]), 1e-12);
                assert_near(values(1.0 / ratio, poisson_ratio), long.map(|row| row[at]), 1e-12);
            }
        }
    }

    /// Half-way between two entries is their mean: in a/b below 1, in b/a above.
    #[test]
    fn linear_between_the_entries() {
        assert_near(values(0.55, 0.25), [3.67, 3.075, 0.9795, 1.805], 1e-12);
        assert_near(values(1.0 / 0.15, 0.5), [10.86, 12.895, 12.945, 0.2845], 1e-12);
    }

    /// Symmetry without Poisson's effect: the two directions are alike in their tangential compliance; the two halves
    /// meet in the circle.
    #[test]
    fn alike_where_theory_says_so() {
        for row in SHORT.iter().chain(&LONG) {
            assert_eq!(row[0][0], row[1][0]);
        }
        assert_eq!(SHORT[9], LONG[9]);
    }

    /// Coefficients grow with a/b, and C33 falls: a digit that was set wrong would break it.
    #[test]
    fn rising_along_the_table() {
        let upward: Vec<&CoefficientRow> = SHORT.iter().chain(LONG[..9].iter().rev()).collect();
        for pair in upward.windows(2) {
            assert!(pair[0][3].iter().zip(&pair[1][3]).all(|(before, after)| after < before));
            for (coefficient, at) in (0..3).flat_map(|coefficient| (0..3).map(move |at| (coefficient, at))) {
                let [before, after] = [pair[0][coefficient][at], pair[1][coefficient][at]];
                // C11 at Poisson's ratio 0.5 has its least value at a/b = 0.3.
                assert!(
                    after > before || (coefficient, at) == (0, 2) && before < 4.86,
                    "{before} before {after}"
                );
            }
        }
    }

    #[test]
    fn nothing_outside_of_the_table() {
        for (axis_ratio, poisson_ratio) in [(0.099, 0.25), (10.1, 0.25), (1.0, 0.51), (1.0, -0.1), (f64::NAN, 0.25)] {
            assert_eq!(CreepCoefficients::of(axis_ratio, poisson_ratio), None);
        }
    }
}
