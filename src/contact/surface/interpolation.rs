//! Interpolation of what a window's cells see of wheel and rail along its strips.

/// Number of places along each strip at which the wheel is looked at.
pub const NODES: usize = 9;

/// Interpolation along the strips of a window between the extrema of Chebyshev's polynomial: gap and slip are smooth along the rail.
///
/// Over half a window of 34 mm, on a wheel of 460 mm, a polynomial of this degree leaves 1e-15 m of the gap of a circle.
#[derive(Debug, Clone)]
pub struct Interpolation {
    /// Places of the nodes, in halves of the window's length from its middle.
    pub nodes: [f64; NODES],
    /// Weights of the nodes for the middles of the cells.
    pub cells: Vec<[f64; NODES]>,
    /// Weights of the nodes for the ends between a cell and the next one.
    pub ends: Vec<[f64; NODES]>,
}

impl Interpolation {
    /// Interpolation for so many cells.
    pub fn new(cells: usize) -> Interpolation {
        let last = (NODES - 1) as f64;
        let nodes: [f64; NODES] = std::array::from_fn(|node| -(std::f64::consts::PI * node as f64 / last).cos());
        let at = |place: f64| -> [f64; NODES] {
            std::array::from_fn(|node| {
                let others = (0..NODES).filter(|&other| other != node);
                others
                    .map(|other| (place - nodes[other]) / (nodes[node] - nodes[other]))
                    .product()
            })
        };
        let count = cells as f64;
        Interpolation {
            cells: (0..cells).map(|cell| at((2 * cell + 1) as f64 / count - 1.0)).collect(),
            ends: (1..cells).map(|end| at(2.0 * end as f64 / count - 1.0)).collect(),
            nodes,
        }
    }
}

/// Sum of the values at the nodes with their weights.
pub fn between(weights: &[f64; NODES], values: &[f64; NODES]) -> f64 {
    weights.iter().zip(values).map(|(weight, value)| weight * value).sum()
}
