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

use crate::friction::coulomb::Resisted;
use crate::numerics::number::Number;

/// Weight of |d|² in q.
const PASSING: f64 = 2.0;

/// Vector in the plane of the contact, of a cell or of the cells of a register.
pub type Vector<N = f64> = [N; 2];
/// Linear map of a [`Vector`], row by row.
pub type Matrix<N = f64> = [[N; 2]; 2];

/// Data of the law of one cell.
#[derive(Debug, Clone, Copy)]
pub struct Cell<N = f64> {
    /// τ.
    pub shear: Vector<N>,
    /// S, slip ahead of the cell, `m/s`.
    pub ahead: Vector<N>,
    /// B, slip behind it, `m/s`.
    pub behind: Vector<N>,
    /// c, slip at the centroid of the strip's load over that in the strip's middle, `m/s`.
    pub off_middle: Vector<N>,
    /// μp.
    pub bound: N,
}

/// Constants of the law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scheme<N = f64> {
    /// r, shear per slip, `s/m`.
    pub scale: N,
    /// w, `m/s`; infinite where all slip is taken ahead.
    pub noise: N,
    /// ε, `m/s`; 0 is Coulomb's law.
    pub regularisation: f64,
}

/// Slip of the law with its derivatives.
#[derive(Debug, Clone, Copy)]
pub struct LawSlip<N = f64> {
    /// s, `m/s`.
    pub slip: Vector<N>,
    /// Derivatives by S.
    pub by_ahead: Matrix<N>,
    /// Derivatives by B.
    pub by_behind: Matrix<N>,
    /// Derivatives by w.
    pub by_noise: Vector<N>,
}

/// Derivatives of the slip's magnitude |s|.
#[derive(Debug, Clone, Copy)]
pub struct SpeedChange<N = f64> {
    /// Derivatives by S.
    pub by_ahead: Vector<N>,
    /// Derivatives by B.
    pub by_behind: Vector<N>,
    /// Derivative by w.
    pub by_noise: N,
}

/// Residual of the law of one cell and its derivatives.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct CellLawRow<N = f64> {
    /// The residual, in units of the shear.
    pub residual: Vector<N>,
    /// Derivatives of the residual by the shear.
    pub by_shear: Matrix<N>,
    /// Derivatives of the residual by S.
    pub by_ahead: Matrix<N>,
    /// Derivatives of the residual by B.
    pub by_behind: Matrix<N>,
    /// Derivatives of the residual by the bound.
    pub by_bound: Vector<N>,
    /// Derivatives of the residual by w.
    pub by_noise: Vector<N>,
}

/// Residual of the law at a slip and its derivatives.
struct AtSlip<N> {
    residual: Vector<N>,
    by_shear: Matrix<N>,
    by_slip: Matrix<N>,
    by_bound: Vector<N>,
}

/// a bᵀ.
#[inline(always)]
pub fn outer<N: Number>(a: Vector<N>, b: Vector<N>) -> Matrix<N> {
    [[a[0] * b[0], a[0] * b[1]], [a[1] * b[0], a[1] * b[1]]]
}

#[inline(always)]
pub fn dot<N: Number>(a: Vector<N>, b: Vector<N>) -> N {
    a[0] * b[0] + a[1] * b[1]
}

#[inline(always)]
fn plus<N: Number>(a: Vector<N>, factor: N, b: Vector<N>) -> Vector<N> {
    [a[0] + factor * b[0], a[1] + factor * b[1]]
}

#[inline(always)]
fn times<N: Number>(factor: N, a: Vector<N>) -> Vector<N> {
    [factor * a[0], factor * a[1]]
}

/// `a` times the identity plus `b` times a matrix.
#[inline(always)]
fn shifted<N: Number>(a: N, b: N, m: Matrix<N>) -> Matrix<N> {
    [[a + b * m[0][0], b * m[0][1]], [b * m[1][0], a + b * m[1][1]]]
}

/// `a` times the identity less a matrix.
#[inline(always)]
fn less<N: Number>(a: N, m: Matrix<N>) -> Matrix<N> {
    [[a - m[0][0], -m[0][1]], [-m[1][0], a - m[1][1]]]
}

/// `a` times the identity.
#[inline(always)]
fn multiple<N: Number>(a: N) -> Matrix<N> {
    let zero = a.constant(0.0);
    [[a, zero], [zero, a]]
}

#[inline(always)]
fn product<N: Number>(a: Matrix<N>, b: Matrix<N>) -> Matrix<N> {
    [by_rows(a[0], b), by_rows(a[1], b)]
}

/// A row times a matrix.
#[inline(always)]
fn by_rows<N: Number>(a: Vector<N>, b: Matrix<N>) -> Vector<N> {
    [a[0] * b[0][0] + a[1] * b[1][0], a[0] * b[0][1] + a[1] * b[1][1]]
}

/// A matrix times a vector.
#[inline(always)]
pub fn multiply<N: Number>(m: Matrix<N>, v: Vector<N>) -> Vector<N> {
    [dot(m[0], v), dot(m[1], v)]
}

#[inline(always)]
fn choose<N: Number>(answer: N::Answer, yes: Vector<N>, no: Vector<N>) -> Vector<N> {
    [N::choose(answer, yes[0], no[0]), N::choose(answer, yes[1], no[1])]
}

#[inline(always)]
fn choose_matrix<N: Number>(answer: N::Answer, yes: Matrix<N>, no: Matrix<N>) -> Matrix<N> {
    [choose(answer, yes[0], no[0]), choose(answer, yes[1], no[1])]
}

impl<N: Number> Scheme<N> {
    /// The slip of the law.
    #[inline(always)]
    pub fn slip(&self, cell: &Cell<N>) -> LawSlip<N> {
        let noise = self.noise;
        let constant = |value: f64| noise.constant(value);
        // c acts as B + 2c in place of B.
        let half = [
            constant(0.5) * (cell.ahead[0] - cell.behind[0]) - cell.off_middle[0],
            constant(0.5) * (cell.ahead[1] - cell.behind[1]) - cell.off_middle[1],
        ];
        let square = dot(cell.ahead, cell.ahead);
        let difference = constant(PASSING) * dot(half, half) + noise * noise;
        let sum = square + difference;
        let share = square / sum;
        let slope = constant(2.0) / (sum * sum);
        // dq = by_ahead · dS + by_behind · dB.
        let by_behind = times(constant(0.5 * PASSING) * slope * square, half);
        let by_ahead = plus([-by_behind[0], -by_behind[1]], slope * difference, cell.ahead);
        let half_share = constant(0.5) * share;
        // Without slip ahead, or where w is infinite, all slip is taken ahead.
        let passes = N::both(
            constant(0.0).is_less(square),
            difference.is_less(constant(f64::INFINITY)),
        );
        let zero = [constant(0.0); 2];
        LawSlip {
            slip: choose(passes, plus(cell.ahead, -share, half), cell.ahead),
            by_ahead: choose_matrix(
                passes,
                less(constant(1.0) - half_share, outer(half, by_ahead)),
                multiple(constant(1.0)),
            ),
            by_behind: choose_matrix(passes, less(half_share, outer(half, by_behind)), [zero; 2]),
            by_noise: choose(passes, times(slope * square * noise, half), zero),
        }
    }

    /// Coulomb's law of a cell whose slip is that of [`Scheme::slip`].
    #[inline(always)]
    pub fn coulomb_row(&self, cell: &Cell<N>, slip: &LawSlip<N>) -> CellLawRow<N> {
        self.coulomb(cell, slip.slip).row(slip)
    }

    /// Residual τ − Π(τ − r s) of Coulomb's law.
    #[inline(always)]
    fn coulomb(&self, cell: &Cell<N>, slip: Vector<N>) -> AtSlip<N> {
        let (r, bound) = (self.scale, cell.bound);
        let (zero, one) = (r.constant(0.0), r.constant(1.0));
        let pulled = plus(cell.shear, -r, slip);
        let length = dot(pulled, pulled).root();
        let sticks = length.is_at_most(bound);
        // Where it slides.
        let direction = [pulled[0] / length, pulled[1] / length];
        let across = less(one, outer(direction, direction));
        let share = bound / length;
        AtSlip {
            residual: choose(sticks, times(r, slip), plus(cell.shear, -bound, direction)),
            by_shear: choose_matrix(sticks, [[zero; 2]; 2], shifted(one, -share, across)),
            by_slip: choose_matrix(sticks, multiple(r), shifted(zero, r * share, across)),
            by_bound: choose(sticks, [zero; 2], [-direction[0], -direction[1]]),
        }
    }
}

impl Scheme {
    /// Scheme of a cell to whose slip per shear the leading edge adds `edge`. The slip of a cell that has just joined responds a
    /// hundredfold to its own shear: under an r that ignores this its residual outweighs all others, and the line search shortens each
    /// step of Newton's method.
    pub fn at_edge(&self, edge: Vector) -> Scheme {
        Scheme {
            scale: self.scale / (1.0 + self.scale * edge[0].max(edge[1])),
            ..*self
        }
    }

    /// Law of a cell whose slip is that of [`Scheme::slip`].
    pub fn row(&self, cell: &Cell, slip: &LawSlip) -> CellLawRow {
        if self.regularisation > 0.0 {
            self.regularised(cell, slip.slip).row(slip)
        } else {
            self.coulomb_row(cell, slip)
        }
    }

    /// Residual of the regularised law (30): the shear t and the slip σ against it that together are z = τ − r s, t + r σ = |z| with
    /// t = μp (2/π) arctan(σ/ε). For ε → 0 this is Coulomb's law to the limit, as well conditioned for a small ε as for a large one.
    fn regularised(&self, cell: &Cell, slip: Vector) -> AtSlip<f64> {
        let (r, epsilon) = (self.scale, self.regularisation);
        let pulled = plus(cell.shear, -r, slip);
        let length = dot(pulled, pulled).sqrt();
        let Resisted {
            shear,
            by_length: stays,
            by_bound: by_own_bound,
            ..
        } = Resisted::new(cell.bound, r, epsilon, length);
        let (residual, by_pulled, by_bound) = if length > 0.0 {
            let direction = [pulled[0] / length, pulled[1] / length];
            let share = shear / length;
            (
                plus(cell.shear, -shear, direction),
                shifted(share, stays - share, outer(direction, direction)),
                times(-by_own_bound, direction),
            )
        } else {
            (cell.shear, multiple(stays), Vector::default())
        };
        AtSlip {
            residual,
            by_shear: less(1.0, by_pulled),
            by_slip: shifted(0.0, r, by_pulled),
            by_bound,
        }
    }
}

impl<N: Number> AtSlip<N> {
    /// Row of the law with the slip's own derivatives.
    #[inline(always)]
    fn row(self, slip: &LawSlip<N>) -> CellLawRow<N> {
        CellLawRow {
            residual: self.residual,
            by_shear: self.by_shear,
            by_ahead: product(self.by_slip, slip.by_ahead),
            by_behind: product(self.by_slip, slip.by_behind),
            by_bound: self.by_bound,
            by_noise: multiply(self.by_slip, slip.by_noise),
        }
    }
}

impl<N: Number> LawSlip<N> {
    /// Magnitude of the slip, `m/s`.
    #[inline(always)]
    pub fn speed(&self) -> N {
        dot(self.slip, self.slip).root()
    }

    /// Derivatives of the magnitude, sᵀ/|s| times those of the slip; 0 without slip.
    #[inline(always)]
    pub fn speed_change(&self) -> SpeedChange<N> {
        let speed = self.speed();
        let zero = speed.constant(0.0);
        let (slides, none) = (zero.is_less(speed), [zero; 2]);
        let over_speed = |sum: Vector<N>| [sum[0] / speed, sum[1] / speed];
        SpeedChange {
            by_ahead: choose(slides, over_speed(by_rows(self.slip, self.by_ahead)), none),
            by_behind: choose(slides, over_speed(by_rows(self.slip, self.by_behind)), none),
            by_noise: N::choose(slides, dot(self.slip, self.by_noise) / speed, zero),
        }
    }
}

impl<N: Number> CellLawRow<N> {
    /// Adds what comes of a bound that changes with the slip's magnitude.
    #[inline(always)]
    pub fn add_bound_by_speed(&mut self, bound_by_speed: N, change: &SpeedChange<N>) {
        let own = times(bound_by_speed, self.by_bound);
        for (by_ahead, own) in self.by_ahead.iter_mut().zip(own) {
            *by_ahead = plus(*by_ahead, own, change.by_ahead);
        }
        for (by_behind, own) in self.by_behind.iter_mut().zip(own) {
            *by_behind = plus(*by_behind, own, change.by_behind);
        }
        self.by_noise = plus(self.by_noise, change.by_noise, own);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::f64::consts::FRAC_2_PI;

    fn row_of(scheme: &Scheme, cell: &Cell) -> CellLawRow {
        scheme.row(cell, &scheme.slip(cell))
    }

    /// Whether a cell sticks by Coulomb's law: it does not feel its bound then.
    fn sticks(row: &CellLawRow) -> bool {
        row.by_bound == [0.0; 2]
    }

    fn vector() -> impl Strategy<Value = Vector> {
        prop::array::uniform2(-1.0..1.0_f64)
    }

    proptest! {
        /// Some of the bounds follow the slip's magnitude.
        #[test]
        fn derivatives_are_those_of_the_residual(
            shear in vector(), ahead in vector(), behind in vector(), off_middle in vector(), bound in 0.05..1.0_f64,
            bound_by_speed in prop_oneof![Just(0.0), Just(-0.1), Just(0.2)],
            noise in prop_oneof![Just(0.01), Just(f64::INFINITY)], regularisation in prop_oneof![Just(0.0), Just(0.1)],
            change in prop::array::uniform10(-1.0..1.0_f64),
        ) {
            let at = |h: f64| {
                let [a, b, c, d, e, f, g, w, k, l] = change.map(|change| h * change);
                let scheme = Scheme { scale: 0.7, noise: noise + w, regularisation };
                let mut cell = Cell {
                    shear: [shear[0] + a, shear[1] + b],
                    ahead: [ahead[0] + c, ahead[1] + d],
                    behind: [behind[0] + e, behind[1] + f],
                    off_middle: [off_middle[0] + k, off_middle[1] + l],
                    bound: bound + g,
                };
                let slip = scheme.slip(&cell);
                cell.bound += bound_by_speed * slip.speed();
                let mut row = scheme.row(&cell, &slip);
                row.add_bound_by_speed(bound_by_speed, &slip.speed_change());
                (row, cell.bound)
            };
            let h = 1e-6;
            let ((row, all), (after, _), (before, _)) = (at(0.0), at(h), at(-h));
            // A bound that has fallen to nothing is no law of friction.
            prop_assume!(all > 0.01);
            // Not across the corner between stick and slip.
            prop_assume!(regularisation > 0.0 || sticks(&after) == sticks(&before));
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
            let row = row_of(&scheme, &slides);
            prop_assert!(!self::sticks(&row) && row.residual.iter().all(|r| r.abs() < 1e-15));
            let sticks = Cell { shear: [share * bound * unit[0], share * bound * unit[1]], ahead: [0.0; 2], behind: slip, off_middle: [0.0; 2], bound };
            let row = row_of(&scheme, &sticks);
            prop_assert!(self::sticks(&row) && row.residual == [0.0; 2]);
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
                let row = row_of(
                    &scheme,
                    &Cell {
                        shear: [-0.6 * bound * share, 0.8 * bound * share],
                        ahead: slip,
                        behind: slip,
                        off_middle: [0.0; 2],
                        bound,
                    },
                );
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
            row_of(&scheme, &cell)
        });
        for i in 0..2 {
            assert!((exact.residual[i] - close.residual[i]).abs() < 1e-11);
            for (exact, close) in exact.by_shear[i].iter().zip(close.by_shear[i]) {
                assert!((exact - close).abs() < 1e-11);
            }
        }
    }
}
