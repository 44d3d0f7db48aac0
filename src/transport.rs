//! The order in which rail material crosses the window: shared by the marches of heat and wear.

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
