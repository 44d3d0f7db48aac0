//! Cubic splines through points or smoothed: natural ones, and those of Reinsch, *Numerische Mathematik* 10 (1967).
//!
//! Of the functions over an interval, the smoothing spline makes Σ wᵢ (f(xᵢ) − yᵢ)² + λ ∫ f″² dx least. With the points' spacing as weights
//! the sum is an integral, and a wave of length L is damped by 1/(1 + λ (2π/L)⁴): to a half where λ = (L/2π)⁴. Where λ = 0
//! the spline goes through the points.

use super::quintics::Jet;
use crate::numerics::band_cholesky::Band;
use crate::numerics::interpolation;
use std::f64::consts::TAU;

/// Returns the λ with which a wave of this length is damped to a half of it.
pub fn penalty(wavelength: f64) -> f64 {
    (wavelength / TAU).powi(4)
}

/// D natural cubic splines over common knots.
#[derive(Debug, Clone)]
pub struct CubicSpline<const D: usize> {
    knots: Vec<f64>,
    values: Vec<[f64; D]>,
    /// Second derivatives at the knots; 0 at the ends.
    seconds: Vec<[f64; D]>,
}

/// Differences Qᵀ y of the slopes on either side of each inner knot.
fn differences<const D: usize>(knots: &[f64], values: &[[f64; D]]) -> Vec<[f64; D]> {
    let rows = knots.windows(3).zip(values.windows(3));
    rows.map(|(x, y)| {
        std::array::from_fn(|k| (y[2][k] - y[1][k]) / (x[2] - x[1]) - (y[1][k] - y[0][k]) / (x[1] - x[0]))
    })
    .collect()
}

impl<const D: usize> CubicSpline<D> {
    /// Spline over ascending knots with a weight for each value; through the values where `penalty` is 0.
    ///
    /// The second derivatives γ at the inner knots solve (R + λ Qᵀ W⁻¹ Q) γ = Qᵀ y, and the values are y − λ W⁻¹ Q γ. `None` where there are
    /// fewer than two knots, or they are not ascending.
    pub fn new(knots: &[f64], values: &[[f64; D]], weights: &[f64], penalty: f64) -> Option<CubicSpline<D>> {
        let n = knots.len();
        if n < 2 || values.len() != n || weights.len() != n || !knots.windows(2).all(|pair| pair[0] < pair[1]) {
            return None;
        }
        let h: Vec<f64> = knots.windows(2).map(|pair| pair[1] - pair[0]).collect();
        // Column j of Q holds these at the rows j, j + 1, j + 2.
        let column = |j: usize| [1.0 / h[j], -1.0 / h[j] - 1.0 / h[j + 1], 1.0 / h[j + 1]];
        let spread: Vec<f64> = weights.iter().map(|weight| penalty / weight).collect();
        let mut band = Band::new(n - 2, 2);
        for j in 0..n - 2 {
            let own = column(j);
            band.add(
                j,
                j,
                (h[j] + h[j + 1]) / 3.0 + (0..3).map(|k| own[k] * own[k] * spread[j + k]).sum::<f64>(),
            );
            if j + 1 < n - 2 {
                let next = column(j + 1);
                let shared = own[1] * next[0] * spread[j + 1] + own[2] * next[1] * spread[j + 2];
                band.add(j + 1, j, h[j + 1] / 6.0 + shared);
            }
            if j + 2 < n - 2 {
                band.add(j + 2, j, own[2] * column(j + 2)[0] * spread[j + 2]);
            }
        }
        let mut inner = differences(knots, values);
        band.factorised()?.solve_in_place(&mut inner);
        let mut values = values.to_vec();
        for (j, second) in inner.iter().enumerate() {
            let own = column(j);
            for k in 0..3 {
                for (value, second) in values[j + k].iter_mut().zip(second) {
                    *value -= spread[j + k] * own[k] * second;
                }
            }
        }
        let mut seconds = vec![[0.0; D]; n];
        seconds[1..n - 1].copy_from_slice(&inner);
        Some(CubicSpline {
            knots: knots.to_vec(),
            values,
            seconds,
        })
    }

    /// Values, first and second derivatives; beyond the ends by the cubics of the first and last interval.
    pub fn at(&self, x: f64) -> Jet<D> {
        let (cell, share) = interpolation::between(&self.knots, x);
        let h = self.knots[cell + 1] - self.knots[cell];
        let (a, b) = (1.0 - share, share);
        std::array::from_fn(|k| {
            let ([y0, y1], [s0, s1]) = (
                [self.values[cell][k], self.values[cell + 1][k]],
                [self.seconds[cell][k], self.seconds[cell + 1][k]],
            );
            [
                a * y0 + b * y1 + h * h / 6.0 * ((a * a * a - a) * s0 + (b * b * b - b) * s1),
                (y1 - y0) / h + h / 6.0 * ((1.0 - 3.0 * a * a) * s0 + (3.0 * b * b - 1.0) * s1),
                a * s0 + b * s1,
            ]
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn knots(count: usize, length: f64) -> Vec<f64> {
        // Unequal spacing, within a factor of two.
        let place = |k: usize| k as f64 + 0.3 * (2.3 * k as f64).sin();
        let scale = length / (place(count - 1) - place(0));
        (0..count).map(|k| scale * (place(k) - place(0))).collect()
    }

    /// Halving the spacing divides the error by 16, away from the ends, at which a natural spline has no curvature.
    #[test]
    fn an_interpolating_spline_is_of_the_fourth_order() {
        let error = |count: usize| {
            let knots = knots(count, 6.0);
            let values: Vec<_> = knots.iter().map(|x| [x.sin(), x.cos()]).collect();
            let spline = CubicSpline::new(&knots, &values, &vec![1.0; count], 0.0).unwrap();
            for (knot, value) in knots.iter().zip(&values) {
                let [[sine, ..], [cosine, ..]] = spline.at(*knot);
                assert!((sine - value[0]).abs() + (cosine - value[1]).abs() < 1e-14);
            }
            (0..200)
                .map(|place| 2.0 + 0.01 * f64::from(place))
                .map(|x| (spline.at(x)[0][0] - x.sin()).abs())
                .fold(0.0, f64::max)
        };
        let order = (error(41) / error(81)).log2();
        assert!((3.6..4.4).contains(&order), "{order}");
    }

    /// A wave as long as the wavelength is halved, one twice as long keeps 16/17, and one half as long 1/17: sixty waves, so that the ends
    /// do not matter, and forty points each.
    #[test]
    fn a_wave_is_damped_by_its_length() {
        let (count, length) = (2401, 60.0);
        let knots = knots(count, length);
        let spacing = length / (count - 1) as f64;
        for (waves, expected) in [(1.0, 0.5), (0.5, 16.0 / 17.0), (2.0, 1.0 / 17.0)] {
            let values: Vec<_> = knots.iter().map(|x| [(TAU * waves * x).sin()]).collect();
            let spline = CubicSpline::new(&knots, &values, &vec![spacing; count], penalty(1.0)).unwrap();
            let top = spline.at(30.0 + 0.25 / waves)[0][0];
            assert!((top / expected - 1.0).abs() < 0.02, "{waves}: {top} {expected}");
        }
    }

    /// Straight lines have no second derivative, and are left as they are by any smoothing.
    #[test]
    fn a_straight_line_stays_straight() {
        let knots = knots(30, 1.0);
        let values: Vec<_> = knots.iter().map(|x| [2.0 * x - 1.0]).collect();
        let spline = CubicSpline::new(&knots, &values, &[1.0; 30], 10.0).unwrap();
        for x in [0.0, 0.3, 1.0] {
            let [value, slope, second] = spline.at(x)[0];
            assert!((value - 2.0 * x + 1.0).abs() + (slope - 2.0).abs() + second.abs() < 1e-9);
        }
    }

    #[test]
    fn two_knots_make_a_line_and_one_makes_none() {
        let spline = CubicSpline::new(&[0.0, 2.0], &[[1.0], [5.0]], &[1.0; 2], 1.0).unwrap();
        assert_eq!(spline.at(1.0), [[3.0, 2.0, 0.0]]);
        assert!(CubicSpline::new(&[0.0], &[[1.0]], &[1.0], 0.0).is_none());
        assert!(CubicSpline::new(&[0.0, 0.0], &[[1.0]; 2], &[1.0; 2], 0.0).is_none());
    }
}
