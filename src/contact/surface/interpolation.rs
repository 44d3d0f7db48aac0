//! Interpolation of what a window's cells see of wheel and rail along its strips: from few places, each time by those nearby. A steep rail far from
//! the contact, along which the wheel's distance bends sharply, so does not act on the contact.

/// Number of places along each strip at which the wheel is looked at.
pub const NODES: usize = 9;
/// Distance of these places, in halves of the window's length.
pub const SPACING: f64 = 2.0 / (NODES - 1) as f64;
/// Places that a value is interpolated between.
const NEAR: usize = 4;

/// Interpolation along the strips of a window between evenly spaced nodes.
///
/// Of a wheel of 460 mm, over half a window of 41 mm, it leaves 5e-14 m of the gap, and 2e-8 of the forward speed of the slip.
#[derive(Debug, Clone)]
pub struct Interpolation {
    /// Places of the nodes, in halves of the window's length from its middle.
    pub nodes: [f64; NODES],
    /// Weights for the middles of the cells.
    pub cells: Vec<Local>,
    /// Spans of the middles of the cells.
    pub spans: Vec<Span>,
    /// Weights for the ends between a cell and the next one.
    pub ends: Vec<Local>,
}

/// Weights of neighbouring nodes: the polynomial of degree three through them.
#[derive(Debug, Clone, Copy)]
pub struct Local {
    first: usize,
    weights: [f64; NEAR],
}

/// Weights of value, slope and second derivative at two neighbouring nodes: the polynomial of degree five between them. Slopes are in halves of
/// the window's length.
#[derive(Debug, Clone, Copy)]
pub struct Span {
    first: usize,
    weights: [f64; 6],
}

impl Interpolation {
    /// Interpolation for so many cells.
    pub fn new(cells: usize) -> Interpolation {
        let nodes: [f64; NODES] = std::array::from_fn(|node| SPACING * node as f64 - 1.0);
        let middle = |cell: usize| (2 * cell + 1) as f64 / cells as f64 - 1.0;
        let end = |end: usize| 2.0 * end as f64 / cells as f64 - 1.0;
        Interpolation {
            cells: (0..cells).map(|cell| Local::new(&nodes, middle(cell))).collect(),
            spans: (0..cells).map(|cell| Span::new(&nodes, middle(cell))).collect(),
            ends: (1..cells).map(|number| Local::new(&nodes, end(number))).collect(),
            nodes,
        }
    }
}

/// Node before a place, of those that have another one after them.
fn before(nodes: &[f64; NODES], place: f64) -> usize {
    nodes.partition_point(|&node| node <= place).clamp(1, NODES - 1) - 1
}

impl Local {
    fn new(nodes: &[f64; NODES], place: f64) -> Local {
        let first = before(nodes, place).saturating_sub(1).min(NODES - NEAR);
        let near = &nodes[first..first + NEAR];
        Local {
            first,
            weights: std::array::from_fn(|node| {
                let others = (0..NEAR).filter(|&other| other != node);
                others
                    .map(|other| (place - near[other]) / (near[node] - near[other]))
                    .product()
            }),
        }
    }

    /// Value from those at the nodes.
    pub fn of(&self, values: &[f64; NODES]) -> f64 {
        let [a, b, c, d] = std::array::from_fn(|node| self.weights[node] * values[self.first + node]);
        // In pairs, so that no sum waits for all the others.
        (a + b) + (c + d)
    }
}

impl Span {
    fn new(nodes: &[f64; NODES], place: f64) -> Span {
        let first = before(nodes, place);
        let h = nodes[first + 1] - nodes[first];
        let t = (place - nodes[first]) / h;
        let (t3, s) = (t * t * t, 1.0 - t);
        let s3 = s * s * s;
        Span {
            first,
            weights: [
                s3 * (1.0 + 3.0 * t + 6.0 * t * t),
                h * s3 * t * (1.0 + 3.0 * t),
                0.5 * h * h * s3 * t * t,
                t3 * (1.0 + 3.0 * s + 6.0 * s * s),
                -h * t3 * s * (1.0 + 3.0 * s),
                0.5 * h * h * t3 * s * s,
            ],
        }
    }

    /// Value from value, slope and second derivative at the nodes. It is at most by `bulge` less than the smaller one at both.
    pub fn of(&self, jets: &[[f64; 3]; NODES], bulge: f64) -> f64 {
        let [near, far] = [&jets[self.first], &jets[self.first + 1]];
        let [a, b, c, d, e, f] = self.weights;
        let value = (a * near[0] + b * near[1]) + (c * near[2] + d * far[0]) + (e * far[1] + f * far[2]);
        value.max(near[0].min(far[0]) - bulge)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Polynomials of degree three and five, and their derivatives, are met to round-off in every cell.
    #[test]
    fn polynomials_are_met() {
        let interpolation = Interpolation::new(34);
        let cubic = |x: f64| 0.3 - x + 2.0 * x * x - 0.7 * x * x * x;
        let quintic = |x: f64| {
            [
                cubic(x) + 0.4 * x.powi(4) - x.powi(5),
                -1.0 + 4.0 * x - 2.1 * x * x + 1.6 * x.powi(3) - 5.0 * x.powi(4),
                4.0 - 4.2 * x + 4.8 * x * x - 20.0 * x.powi(3),
            ]
        };
        let (values, jets) = (interpolation.nodes.map(cubic), interpolation.nodes.map(quintic));
        for cell in 0..34 {
            let place = (2 * cell + 1) as f64 / 34.0 - 1.0;
            assert!((interpolation.cells[cell].of(&values) - cubic(place)).abs() < 1e-14);
            assert!((interpolation.spans[cell].of(&jets, f64::INFINITY) - quintic(place)[0]).abs() < 1e-14);
        }
        for (number, local) in interpolation.ends.iter().enumerate() {
            let place = 2.0 * (number + 1) as f64 / 34.0 - 1.0;
            assert!((local.of(&values) - cubic(place)).abs() < 1e-14);
        }
    }
}
