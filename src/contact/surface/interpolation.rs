//! Interpolation of what a window's cells see of wheel and rail along its strips.

/// Number of places along each strip at which the wheel is looked at.
pub const NODES: usize = 9;

/// Interpolation along the strips of a window between the extrema of Chebyshev's polynomial: gap and slip are smooth along the rail about a
/// contact.
///
/// Over half a window of 34 mm, on a wheel of 460 mm, the pieces of degree five leave 3e-13 m of the gap of a circle.
#[derive(Debug, Clone)]
pub struct Interpolation {
    /// Places of the nodes, in halves of the window's length from its middle.
    pub nodes: [f64; NODES],
    /// Weights of the nodes for the middles of the cells.
    pub cells: Vec<[f64; NODES]>,
    /// Node before each cell, and the weights of value, slope and second derivative there and at the node after it; slopes in halves of the
    /// window's length.
    pub spans: Vec<(usize, [f64; 6])>,
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
            spans: (0..cells)
                .map(|cell| span(&nodes, (2 * cell + 1) as f64 / count - 1.0))
                .collect(),
            ends: (1..cells).map(|end| at(2.0 * end as f64 / count - 1.0)).collect(),
            nodes,
        }
    }
}

/// Node before a place, and the weights of the polynomial of degree five between it and the next one.
fn span(nodes: &[f64; NODES], place: f64) -> (usize, [f64; 6]) {
    let node = (nodes.partition_point(|&node| node <= place)).clamp(1, NODES - 1) - 1;
    let h = nodes[node + 1] - nodes[node];
    let t = (place - nodes[node]) / h;
    let (t3, s) = (t * t * t, 1.0 - t);
    let s3 = s * s * s;
    let weights = [
        s3 * (1.0 + 3.0 * t + 6.0 * t * t),
        h * s3 * t * (1.0 + 3.0 * t),
        0.5 * h * h * s3 * t * t,
        t3 * (1.0 + 3.0 * s + 6.0 * s * s),
        -h * t3 * s * (1.0 + 3.0 * s),
        0.5 * h * h * t3 * s * s,
    ];
    (node, weights)
}

/// Sum of the values at the nodes with their weights.
pub fn between(weights: &[f64; NODES], values: &[f64; NODES]) -> f64 {
    weights.iter().zip(values).map(|(weight, value)| weight * value).sum()
}
