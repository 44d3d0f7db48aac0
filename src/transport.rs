//! The order in which rail material crosses the window, and the step from one column to the next: shared by the marches of
//! heat and wear.
//!
//! What is carried along without decay and is fed by f, ∂a/∂t − V ∂a/∂x₁ = f, passes the cell of length Δ from the column upstream
//! (U) to the next one (O) in a step of Δt, with S = aⁿ + f Δt and the Courant number C = |V| Δt/Δ, by
//!
//! (C + 1 − ν) a_O = (C − ν) a_U + ν S_U + (1 − ν) S_O,  ν = min(½, C).
//!
//! With ν = ½ storage and f are linear over the cell: second order in Δ, and what is settled does not depend on Δt. Where
//! the rail moves by less than half a cell in a step, that would take more from upstream than arrives; with ν = C the step is then the
//! interpolation of S at the point that the material comes from. All weights are positive: nothing oscillates, and nothing falls
//! below 0 that is fed by what is not. The cell is balanced to round-off,
//!
//! Δ (ν (a − aⁿ)_U + (1 − ν) (a − aⁿ)_O)/Δt + |V| (a_O − a_U) = Δ (ν f_U + (1 − ν) f_O),
//!
//! and over cells of one length the weights of a column add up to 1, whatever V and Δt.

// The patch engine uses it.
#[allow(dead_code)]
pub mod strips;

/// Upwind differences −V ∂/∂x₁ over the columns, from the inflow side to the outflow side.
#[derive(Debug, Clone, Copy)]
pub struct Upwind<'a> {
    x: &'a [f64],
    speed: f64,
}

/// One column of a march.
#[derive(Debug, Clone, Copy)]
pub struct Column {
    /// Index of the column.
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

    /// Speed |V|, `m/s`.
    pub fn speed(&self) -> f64 {
        self.speed.abs()
    }

    /// Position of a column, `m`.
    pub fn position(&self, column: usize) -> f64 {
        self.x[column]
    }

    /// Positions of all columns, `m`.
    #[allow(dead_code)]
    pub fn positions(&self) -> &'a [f64] {
        self.x
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
    /// Index into `lengths` for the cell between each column and the next one.
    length_of: Vec<usize>,
    /// The different lengths, `m`.
    pub lengths: Vec<f64>,
}

impl Cells {
    /// Cells between columns at `x` `m`.
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

/// The step through one cell: factors on the value and on the sources S/Δt = aⁿ/Δt + f at its two ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CellStep {
    /// Weight (C − ν)/(C + 1 − ν) of the value upstream, C the Courant number.
    pub courant_weight: f64,
    /// Weight of the source upstream, `s`.
    pub upstream: f64,
    /// Weight of the column's own source, `s`: the diagonal of the recurrence.
    pub diagonal: f64,
}

/// Values, or sources, at the two ends of a cell.
#[derive(Debug, Clone, Copy)]
pub struct CellEnds {
    /// Value at the column upstream.
    pub upstream: f64,
    /// Value at the column itself.
    pub column: f64,
}

impl CellStep {
    /// Step through no cell at all: the value upstream arrives unchanged.
    pub const NONE: CellStep = CellStep {
        courant_weight: 1.0,
        upstream: 0.0,
        diagonal: 0.0,
    };

    /// Step with 1/Δt `storage` `1/s`, through a cell of length Δ `spacing` `m` at |V| `speed` `m/s`.
    pub fn new(storage: f64, spacing: f64, speed: f64) -> CellStep {
        let passages = speed / spacing;
        let nu = if CellStep::is_short(storage, passages) {
            passages / storage
        } else {
            0.5
        };
        let inverse = 1.0 / (passages + (1.0 - nu) * storage);
        CellStep {
            courant_weight: (passages - nu * storage).max(0.0) * inverse,
            upstream: nu * inverse,
            diagonal: (1.0 - nu) * inverse,
        }
    }

    /// Whether the rail moves by less than half a cell in a step.
    fn is_short(storage: f64, passages: f64) -> bool {
        2.0 * passages < storage
    }

    /// Mean ν a_U + (1 − ν) a_O over the cell: what it holds per length.
    #[cfg(any(test, feature = "verification"))]
    pub fn mean(&self, upstream: f64, own: f64) -> f64 {
        own + self.upstream / (self.upstream + self.diagonal) * (upstream - own)
    }

    /// Source at a column, from the values at both ends of the cell and the source upstream: the step solved backwards.
    pub fn source(&self, values: CellEnds, upstream_source: f64) -> f64 {
        (values.column - self.courant_weight * values.upstream - self.upstream * upstream_source) / self.diagonal
    }

    /// Change of the value at a column with |V| `speed`, from the values and the sources at both ends of the cell of length Δ
    /// `spacing`.
    pub fn speed_tangent(storage: f64, spacing: f64, speed: f64, values: CellEnds, sources: CellEnds) -> f64 {
        let passages = speed / spacing;
        if CellStep::is_short(storage, passages) {
            (sources.upstream - sources.column) / (spacing * storage * storage)
        } else {
            (values.upstream - values.column) / (spacing * (passages + 0.5 * storage))
        }
    }
}
