//! Coulomb's law of one cell in two directions, and the scheme in which its slip is taken.
//!
//! A cell that sticks has no slip half a cell ahead of its centre, on the line to the next cell: there the difference of the
//! displacements of the two cells is centred, and a cell's own shear acts on it. A cell that slides has its shear against the slip
//! at its centre, the mean of that ahead and that behind. Taken ahead as well, it would turn with the spin half a cell too early:
//! the lateral force is then off by a few per cent of μN. Across the rail, too, its shear is against the slip where the pressure is: at the centroid of
//! the strip's load, not in the strip's middle. With S ahead, B behind, c the slip at that centroid over that in the middle, and
//! d = ½(S − B) − c the slip of the law is
//!
//! s = S − q d,  q = |S|²/(|S|² + 2|d|² + w²),
//!
//! that ahead where the cell nearly sticks and that at the centroid where it slides well. The 2 decides how fast it passes from one to the other: with 1 or 3
//! forces on 8 by 8 to 34 by 21 cells are up to a quarter farther off, with ½ Newton's method takes twice as many steps. w is a small slip that keeps the noise of cells that stick
//! from counting as slip.
//!
//! The law is τ = Π(τ − r s), where Π moves a vector that is longer than the bound μp back onto it, and r > 0 any scale
//! (Alart and Curnier 1991): it holds if the cell sticks within the bound, or slides with τ = −μp s/|s|. The regularised law (30) is
//! written in the same way, with another Π.

use crate::friction::coulomb::{Resisted, STICK_UTILISATION};

/// Weight of |d|² in q.
const PASSING: f64 = 2.0;

/// Vector in the plane of the contact.
pub type Vector = [f64; 2];
/// Linear map of a [`Vector`], row by row.
pub type Matrix = [[f64; 2]; 2];

/// Data of the law of one cell.
#[derive(Debug, Clone, Copy)]
pub struct Cell {
    /// τ.
    pub shear: Vector,
    /// S, slip ahead of the cell, `m/s`.
    pub ahead: Vector,
    /// B, slip behind it, `m/s`.
    pub behind: Vector,
    /// c, slip at the centroid of the strip's load over that in the strip's middle, `m/s`.
    pub off_middle: Vector,
    /// μp.
    pub bound: f64,
}

/// Constants of the law that all cells have in common.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scheme {
    /// r, shear per slip, `s/m`.
    pub scale: f64,
    /// w, `m/s`; infinite where all slip is taken ahead.
    pub noise: f64,
    /// ε, `m/s`; 0 is Coulomb's law.
    pub regularisation: f64,
}

/// Residual of the law of one cell and its derivatives.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct CellLawRow {
    /// The residual, in units of the shear.
    pub residual: Vector,
    /// Derivatives of the residual by the shear.
    pub by_shear: Matrix,
    /// Derivatives of the residual by S.
    pub by_ahead: Matrix,
    /// Derivatives of the residual by B.
    pub by_behind: Matrix,
    /// Derivatives of the residual by the bound.
    pub by_bound: Vector,
    /// Derivatives of the residual by w.
    pub by_noise: Vector,
    /// Whether it sticks.
    pub sticks: bool,
}

/// a bᵀ.
pub fn outer(a: Vector, b: Vector) -> Matrix {
    [[a[0] * b[0], a[0] * b[1]], [a[1] * b[0], a[1] * b[1]]]
}

pub fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

fn plus(a: Vector, factor: f64, b: Vector) -> Vector {
    [a[0] + factor * b[0], a[1] + factor * b[1]]
}

/// `a` times the identity plus `b` times a matrix.
fn shifted(a: f64, b: f64, m: Matrix) -> Matrix {
    [[a + b * m[0][0], b * m[0][1]], [b * m[1][0], a + b * m[1][1]]]
}

fn product(a: Matrix, b: Matrix) -> Matrix {
    let entry = |i: usize, j: usize| a[i][0] * b[0][j] + a[i][1] * b[1][j];
    [[entry(0, 0), entry(0, 1)], [entry(1, 0), entry(1, 1)]]
}

/// A matrix times a vector.
pub fn multiply(m: Matrix, v: Vector) -> Vector {
    [dot(m[0], v), dot(m[1], v)]
}

impl Scheme {
    /// The slip of the law, and its derivatives by S, by B and by w.
    pub fn slip(&self, cell: &Cell) -> (Vector, Matrix, Matrix, Vector) {
        // c acts as B + 2c in place of B.
        let half = [0, 1].map(|i: usize| 0.5 * (cell.ahead[i] - cell.behind[i]) - cell.off_middle[i]);
        let square = dot(cell.ahead, cell.ahead);
        let difference = PASSING * dot(half, half) + self.noise * self.noise;
        if square <= 0.0 || !difference.is_finite() {
            let unit = shifted(1.0, 0.0, Matrix::default());
            return (cell.ahead, unit, Matrix::default(), Vector::default());
        }
        let sum = square + difference;
        let share = square / sum;
        let slope = 2.0 / (sum * sum);
        // dq = by_ahead · dS + by_behind · dB.
        let by_behind = half.map(|half| 0.5 * PASSING * slope * square * half);
        let by_ahead = plus([-by_behind[0], -by_behind[1]], slope * difference, cell.ahead);
        (
            plus(cell.ahead, -share, half),
            shifted(1.0 - 0.5 * share, -1.0, outer(half, by_ahead)),
            shifted(0.5 * share, -1.0, outer(half, by_behind)),
            half.map(|half| slope * square * self.noise * half),
        )
    }

    /// Scheme of a cell to whose slip per shear the leading edge adds `edge`. The slip of a cell that has just joined responds a
    /// hundredfold to its own shear: under an r that ignores this its residual outweighs all others, and the line search shortens each
    /// step of Newton's method.
    pub fn at_edge(&self, edge: Vector) -> Scheme {
        Scheme {
            scale: self.scale / (1.0 + self.scale * edge[0].max(edge[1])),
            ..*self
        }
    }

    /// Law of a cell.
    #[inline(always)]
    pub fn row(&self, cell: &Cell) -> CellLawRow {
        self.row_at_slip(cell, self.slip(cell))
    }

    /// Law of a cell whose slip and derivatives are those of [`Scheme::slip`]. Inlined, it writes the row where it belongs: it is as long as
    /// three lines of the cache.
    #[inline(always)]
    pub fn row_at_slip(
        &self,
        cell: &Cell,
        (slip, slip_by_ahead, slip_by_behind, slip_by_noise): (Vector, Matrix, Matrix, Vector),
    ) -> CellLawRow {
        let (residual, by_shear, by_slip, by_bound, sticks) = if self.regularisation > 0.0 {
            self.regularised(cell, slip)
        } else {
            self.coulomb(cell, slip)
        };
        CellLawRow {
            residual,
            by_shear,
            by_ahead: product(by_slip, slip_by_ahead),
            by_behind: product(by_slip, slip_by_behind),
            by_bound,
            by_noise: multiply(by_slip, slip_by_noise),
            sticks,
        }
    }

    /// Residual τ − Π(τ − r s) of Coulomb's law.
    fn coulomb(&self, cell: &Cell, slip: Vector) -> (Vector, Matrix, Matrix, Vector, bool) {
        let r = self.scale;
        let pulled = plus(cell.shear, -r, slip);
        let length = dot(pulled, pulled).sqrt();
        if length <= cell.bound {
            let residual = [r * slip[0], r * slip[1]];
            return (
                residual,
                Matrix::default(),
                shifted(r, 0.0, Matrix::default()),
                Vector::default(),
                true,
            );
        }
        let direction = [pulled[0] / length, pulled[1] / length];
        let across = shifted(1.0, -1.0, outer(direction, direction));
        let share = cell.bound / length;
        (
            plus(cell.shear, -cell.bound, direction),
            shifted(1.0, -share, across),
            shifted(0.0, r * share, across),
            [-direction[0], -direction[1]],
            false,
        )
    }

    /// Residual of the regularised law (30): the shear t and the slip σ against it that together are z = τ − r s, t + r σ = |z| with
    /// t = μp (2/π) arctan(σ/ε). For ε → 0 this is Coulomb's law to the limit, as well conditioned for a small ε as for a large one.
    fn regularised(&self, cell: &Cell, slip: Vector) -> (Vector, Matrix, Matrix, Vector, bool) {
        let (r, epsilon) = (self.scale, self.regularisation);
        let pulled = plus(cell.shear, -r, slip);
        let length = dot(pulled, pulled).sqrt();
        let Resisted {
            utilisation,
            shear,
            by_length: stays,
            by_bound: by_own_bound,
        } = Resisted::new(cell.bound, r, epsilon, length);
        let (residual, by_pulled, by_bound) = if length > 0.0 {
            let direction = [pulled[0] / length, pulled[1] / length];
            let share = shear / length;
            (
                plus(cell.shear, -shear, direction),
                shifted(share, stays - share, outer(direction, direction)),
                [0, 1].map(|i: usize| -by_own_bound * direction[i]),
            )
        } else {
            (cell.shear, shifted(stays, 0.0, Matrix::default()), Vector::default())
        };
        (
            residual,
            shifted(1.0, -1.0, by_pulled),
            shifted(0.0, r, by_pulled),
            by_bound,
            utilisation < STICK_UTILISATION,
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::f64::consts::FRAC_2_PI;

    fn vector() -> impl Strategy<Value = Vector> {
        prop::array::uniform2(-1.0..1.0_f64)
    }

    proptest! {
        #[test]
        fn derivatives_are_those_of_the_residual(
            shear in vector(), ahead in vector(), behind in vector(), off_middle in vector(), bound in 0.05..1.0_f64,
            noise in prop_oneof![Just(0.01), Just(f64::INFINITY)], regularisation in prop_oneof![Just(0.0), Just(0.1)],
            change in prop::array::uniform10(-1.0..1.0_f64),
        ) {
            let at = |h: f64| {
                let [a, b, c, d, e, f, g, w, k, l] = change.map(|change| h * change);
                let scheme = Scheme { scale: 0.7, noise: noise + w, regularisation };
                scheme.row(&Cell {
                    shear: [shear[0] + a, shear[1] + b],
                    ahead: [ahead[0] + c, ahead[1] + d],
                    behind: [behind[0] + e, behind[1] + f],
                    off_middle: [off_middle[0] + k, off_middle[1] + l],
                    bound: bound + g,
                })
            };
            let h = 1e-6;
            let (row, after, before) = (at(0.0), at(h), at(-h));
            // Not across the corner between stick and slip.
            prop_assume!(after.sticks == before.sticks);
            let [a, b, c, d, e, f, g, w, k, l] = change;
            for i in 0..2 {
                let exact = multiply(row.by_shear, [a, b])[i] + multiply(row.by_ahead, [c, d])[i]
                    + multiply(row.by_behind, [e + 2.0 * k, f + 2.0 * l])[i] + row.by_bound[i] * g + row.by_noise[i] * w;
                let difference = (after.residual[i] - before.residual[i]) / (2.0 * h);
                // Truncation: h² over the cube of the smallest slip that turns, which random numbers seldom make small.
                prop_assert!((exact - difference).abs() < 1e-4 * (1.0 + exact.abs()), "{exact} {difference}");
            }
        }

        /// A solution slides against the slip at the bound, or sticks within it.
        #[test]
        fn the_residual_vanishes_where_the_law_holds(direction in 0.0..6.2_f64, speed in 0.01..1.0_f64, bound in 0.05..1.0_f64, share in 0.0..1.0_f64) {
            let scheme = Scheme { scale: 3.0, noise: 1e-4, regularisation: 0.0 };
            let unit = [direction.cos(), direction.sin()];
            let slip = [speed * unit[0], speed * unit[1]];
            let slides = Cell { shear: [-bound * unit[0], -bound * unit[1]], ahead: slip, behind: slip, off_middle: [0.0; 2], bound };
            let row = scheme.row(&slides);
            prop_assert!(!row.sticks && row.residual.iter().all(|r| r.abs() < 1e-15));
            let sticks = Cell { shear: [share * bound * unit[0], share * bound * unit[1]], ahead: [0.0; 2], behind: slip, off_middle: [0.0; 2], bound };
            let row = scheme.row(&sticks);
            prop_assert!(row.sticks && row.residual == [0.0; 2]);
        }
    }

    /// The regularised law in its own words: τ = −μp (2/π) arctan(|s|/ε) s/|s|, for any ε however small.
    #[test]
    fn the_regularised_residual_vanishes_where_the_law_holds() {
        for exponent in -12..=2 {
            let epsilon = 10.0_f64.powi(exponent);
            for decade in -14..=3 {
                let slip = [0.6, -0.8].map(|part: f64| part * 10.0_f64.powi(decade));
                let bound = 0.3;
                let share = FRAC_2_PI * (10.0_f64.powi(decade) / epsilon).atan();
                let scheme = Scheme {
                    scale: 3.0,
                    noise: f64::INFINITY,
                    regularisation: epsilon,
                };
                let row = scheme.row(&Cell {
                    shear: [-0.6 * bound * share, 0.8 * bound * share],
                    ahead: slip,
                    behind: slip,
                    off_middle: [0.0; 2],
                    bound,
                });
                let size = bound + scheme.scale * 10.0_f64.powi(decade);
                let residual = row.residual[0].abs().max(row.residual[1].abs());
                assert!(residual < 1e-14 * size, "{epsilon:e} {slip:?}: {residual:e}");
            }
        }
        // A small regularisation is Coulomb's law.
        let cell = Cell {
            shear: [0.1, 0.05],
            ahead: [0.3, -0.2],
            behind: [0.3, -0.2],
            off_middle: [0.0; 2],
            bound: 0.3,
        };
        let [exact, close] = [0.0, 1e-13].map(|regularisation| {
            let scheme = Scheme {
                scale: 3.0,
                noise: f64::INFINITY,
                regularisation,
            };
            scheme.row(&cell)
        });
        for i in 0..2 {
            assert!((exact.residual[i] - close.residual[i]).abs() < 1e-11);
            for (exact, close) in exact.by_shear[i].iter().zip(close.by_shear[i]) {
                assert!((exact - close).abs() < 1e-11);
            }
        }
    }
}
