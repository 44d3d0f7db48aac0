//! The order in which rail material crosses the window, and the step from one column to the next: shared by the marches of
//! heat and wear.
//!
//! What is carried along, decays at a rate κλ and is fed by f, ∂a/∂t − V ∂a/∂x₁ + κλ a = f, is stepped in time by
//! ∂a/∂t ≈ (a − aⁿ)/Δt. On the way through the cell of length Δ from the column upstream (U) to the next one (O) this is an
//! ordinary differential equation with the rate r = 1/Δt + κλ and the source S = aⁿ/Δt + f. With S linear over the cell its
//! solution is exactly
//!
//! a_O = E a_U + g ω S_U + g (1 − ω) S_O,
//!
//! z = r Δ/|V|,  E = e⁻ᶻ,  g = (1 − E)/r,  ω = 1/z − 1/(eᶻ − 1),
//!
//! an exponential integrator (M. Hochbruck and A. Ostermann, *Exponential integrators*, Acta Numerica 19, 2010): of second
//! order in Δ, and exact for what decays without being fed, however long the cell. All weights are positive: nothing
//! oscillates, and nothing falls below 0 that is fed by what is not. Where material crosses less than a cell in a step, ω tends
//! to 0 and the scheme to the upwind difference; at V = 0 it is the implicit Euler step of each column.
//!
//! What the cell holds is balanced to round-off with a weighted by ω upstream and by 1 − ω at the column:
//!
//! Δ (ω (a − aⁿ)_U + (1 − ω) (a − aⁿ)_O)/Δt + |V| (a_O − a_U) + κλ Δ (ω a_U + (1 − ω) a_O) = Δ (ω f_U + (1 − ω) f_O).
//!
//! Over cells of one length the weights of a column add up to 1, whatever V, Δt and λ.

use crate::numerics::decay::{Decay, decay};
use crate::numerics::dense::Arithmetic;

/// Upwind differences −V ∂/∂x₁ over the columns, from the inflow side to the outflow side.
#[derive(Debug, Clone, Copy)]
pub struct Upwind<'a> {
    x: &'a [f64],
    speed: f64,
}

/// One column of a march.
#[derive(Debug, Clone, Copy)]
pub struct Column {
    /// Its index.
    pub index: usize,
    /// The column upstream of it.
    pub upstream: usize,
    /// Distance to the column upstream, `m`.
    pub spacing: f64,
}

impl<'a> Upwind<'a> {
    /// March over columns at positions `x` `m` for the speed V `m/s`; V = 0 counts as forward.
    pub fn new(x: &'a [f64], speed: f64) -> Upwind<'a> {
        Upwind { x, speed }
    }

    /// |V|, `m/s`.
    pub fn speed(&self) -> f64 {
        self.speed.abs()
    }

    /// Position of a column, `m`.
    pub fn position(&self, column: usize) -> f64 {
        self.x[column]
    }

    /// Whether material moves towards −x₁.
    pub fn is_forward(&self) -> bool {
        self.speed >= 0.0
    }

    /// The column where material enters: essential conditions, not part of the march.
    pub fn inflow(&self) -> usize {
        if self.speed >= 0.0 { self.x.len() - 1 } else { 0 }
    }

    /// The column where material leaves.
    pub fn outflow(&self) -> usize {
        self.x.len() - 1 - self.inflow()
    }

    /// All columns but the inflow one, each after the one upstream of it.
    pub fn columns(&self) -> impl Iterator<Item = Column> + 'a {
        let (x, forward) = (self.x, self.speed >= 0.0);
        (1..x.len()).map(move |k| {
            let (index, upstream) = if forward {
                (x.len() - 1 - k, x.len() - k)
            } else {
                (k, k - 1)
            };
            Column {
                index,
                upstream,
                spacing: (x[upstream] - x[index]).abs(),
            }
        })
    }
}

/// The cells between neighbouring columns, by their lengths: all those of the window are of one length, and those outside it are
/// mirror images.
#[derive(Debug, Clone)]
pub struct Cells {
    /// Of the cell between a column and the next one, the place of its length in `lengths`.
    length_of: Vec<usize>,
    /// The different lengths, `m`.
    pub lengths: Vec<f64>,
}

impl Cells {
    /// Between columns at `x` `m`.
    pub fn new(x: &[f64]) -> Cells {
        let mut lengths: Vec<f64> = Vec::new();
        let length_of = x
            .windows(2)
            .map(|ends| {
                let length = ends[1] - ends[0];
                // The same but for round-off of the positions.
                let same = |other: &f64| (length - other).abs() <= 1e-9 * length;
                lengths.iter().position(same).unwrap_or_else(|| {
                    lengths.push(length);
                    lengths.len() - 1
                })
            })
            .collect();
        Cells { length_of, lengths }
    }

    /// The place in [`Cells::lengths`] of the cell upstream of a column.
    pub fn length_of(&self, column: &Column) -> usize {
        self.length_of[column.index.min(column.upstream)]
    }
}

/// The step through one cell: factors on the value and on the sources at its two ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CellStep {
    /// E: share of the value upstream that arrives.
    pub keep: f64,
    /// g ω: of the source upstream, `s`.
    pub upstream: f64,
    /// g (1 − ω): of the column's own source, `s`.
    pub own: f64,
}

/// Least rate r, `1/s`: stands for the 0 of what neither decays nor is stored, so that 1/r is finite.
const LEAST_RATE: f64 = 1e-200;

impl CellStep {
    /// Through no cell at all.
    pub const NONE: CellStep = CellStep {
        keep: 1.0,
        upstream: 0.0,
        own: 0.0,
    };

    /// At the rate r `1/s`, through a cell of length Δ `spacing` `m` at |V| `speed` `m/s`.
    pub fn new(rate: f64, spacing: f64, speed: f64) -> CellStep {
        let rate = rate.max(LEAST_RATE);
        CellStep::at(
            Arithmetic::SEPARATE,
            (rate, 1.0 / rate),
            (spacing / speed, speed / spacing),
        )
    }

    /// The same from r `1/s` and Δ/|V| `s`, each with its inverse, without branches: several at once vectorise.
    #[inline(always)]
    pub fn at(arithmetic: Arithmetic, (rate, duration): (f64, f64), (passage, passages): (f64, f64)) -> CellStep {
        let Decay { keep, upstream, own } = decay(arithmetic, rate * passage, duration * passages);
        CellStep {
            keep,
            upstream: upstream * duration,
            own: own * duration,
        }
    }

    /// ω.
    #[cfg(any(test, feature = "verification"))]
    pub fn upstream_share(&self) -> f64 {
        self.upstream / (self.upstream + self.own)
    }

    /// ω a_U + (1 − ω) a_O: what the cell holds per length.
    #[cfg(any(test, feature = "verification"))]
    pub fn mean(&self, upstream: f64, own: f64) -> f64 {
        own + self.upstream_share() * (upstream - own)
    }

    /// The source S_O at a column, from the values and the source upstream: what the step was made from.
    pub fn own_source(&self, (upstream, own): (f64, f64), upstream_source: f64) -> f64 {
        (own - self.keep * upstream - self.upstream * upstream_source) / self.own
    }

    /// Change of the value at a column with |V|, from the value upstream and the two sources (upstream, own).
    pub fn speed_tangent(
        &self,
        rate: f64,
        (spacing, speed): (f64, f64),
        upstream: f64,
        (upstream_source, own_source): (f64, f64),
    ) -> f64 {
        // dg ω/dV = (g ω − E Δ/V)/V and dg (1 − ω)/dV = −g ω/V. At V = 0 nothing arrives, and g ω/V is 1/(r² Δ).
        if self.keep == 0.0 {
            let per_speed = if speed > 0.0 {
                self.upstream / speed
            } else {
                1.0 / (rate * rate * spacing)
            };
            return per_speed * (upstream_source - own_source);
        }
        let passage = spacing / speed;
        let arriving = self.keep * passage * (rate * upstream - upstream_source);
        (arriving + self.upstream * (upstream_source - own_source)) / speed
    }
}
