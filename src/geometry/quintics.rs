//! Functions of one variable in cells, each a polynomial of degree five: what profiles are evaluated by.
//!
//! A cell takes value, slope and second derivative at both of its ends. Neighbours that share all three join twice
//! differentiably; where a profile's curvature jumps, or its direction, the cells on either side keep their own, so that a jump
//! stays sharp.

/// Values at an end of a cell, for each of the D functions: the value, its first and its second derivative.
pub type Jet<const D: usize> = [[f64; 3]; D];

/// A cell: where it begins and ends, and the functions at both ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Span<const D: usize> {
    /// First and last argument.
    pub ends: [f64; 2],
    /// Functions at the two ends, as they are within the cell.
    pub jets: [Jet<D>; 2],
}

/// D functions over a common range, in cells that are found in constant time.
#[derive(Debug, Clone, PartialEq)]
pub struct Quintics<const D: usize> {
    /// Ends of the cells, ascending, one more than cells.
    knots: Vec<f64>,
    /// Coefficients of each cell, in powers of the distance from its first knot.
    cells: Vec<[[f64; 6]; D]>,
    /// First cell that reaches into each of the equal boxes of the range.
    boxes: Vec<u32>,
    /// Boxes per unit of the argument.
    density: f64,
}

/// Returns the coefficients of the polynomial that has two jets a length apart.
fn coefficients([f0, d0, s0]: [f64; 3], [f1, d1, s1]: [f64; 3], length: f64) -> [f64; 6] {
    let h = length;
    let a = f1 - (f0 + h * (d0 + 0.5 * h * s0));
    let b = (d1 - (d0 + h * s0)) * h;
    let c = (s1 - s0) * h * h;
    let cube = h * h * h;
    [
        f0,
        d0,
        0.5 * s0,
        (10.0 * a - 4.0 * b + 0.5 * c) / cube,
        (-15.0 * a + 7.0 * b - c) / (cube * h),
        (6.0 * a - 3.0 * b + 0.5 * c) / (cube * h * h),
    ]
}

impl<const D: usize> Quintics<D> {
    /// Functions of cells that follow each other; `None` where there is none, or one has no length.
    pub fn new(spans: &[Span<D>]) -> Option<Quintics<D>> {
        let (first, last) = (spans.first()?.ends[0], spans.last()?.ends[1]);
        let mut knots = vec![first];
        knots.extend(spans.iter().map(|span| span.ends[1]));
        let ascending = knots.windows(2).all(|pair| pair[0] < pair[1] && pair[1].is_finite());
        if !ascending || !first.is_finite() {
            return None;
        }
        let cells = spans
            .iter()
            .map(|span| {
                let [before, after] = span.jets;
                std::array::from_fn(|which| coefficients(before[which], after[which], span.ends[1] - span.ends[0]))
            })
            .collect();
        // Two boxes for each cell: where cells are about equally long, the first guess is the cell or the one before it.
        let count = 2 * spans.len();
        let density = count as f64 / (last - first);
        let boxes = (0..=count)
            .map(|place| {
                let begin = first + place as f64 / density;
                (knots.partition_point(|&knot| knot <= begin).clamp(1, spans.len()) - 1) as u32
            })
            .collect();
        Some(Quintics {
            knots,
            cells,
            boxes,
            density,
        })
    }

    /// First and last argument.
    pub fn range(&self) -> [f64; 2] {
        [self.knots[0], self.knots[self.cells.len()]]
    }

    /// Ends of the cells.
    pub fn knots(&self) -> &[f64] {
        &self.knots
    }

    /// Replaces a cell with its ends, which stay between those of its neighbours; these have to be replaced where they do not meet it.
    pub fn replace(&mut self, cell: usize, span: &Span<D>) {
        let [begin, end] = span.ends;
        (self.knots[cell], self.knots[cell + 1]) = (begin, end);
        let [before, after] = span.jets;
        self.cells[cell] = std::array::from_fn(|which| coefficients(before[which], after[which], end - begin));
    }

    /// Cell that holds an argument; the first or the last one for an argument beyond the range.
    pub fn cell_of(&self, argument: f64) -> usize {
        let place = (argument - self.knots[0]) * self.density;
        // A conversion of a float saturates, and makes 0 of what is not a number.
        let mut cell = self.boxes[(place as usize).min(self.boxes.len() - 1)] as usize;
        // The box's begin is rounded.
        while cell > 0 && argument < self.knots[cell] {
            cell -= 1;
        }
        while cell + 1 < self.cells.len() && argument >= self.knots[cell + 1] {
            cell += 1;
        }
        cell
    }

    /// Values, first and second derivatives; beyond the range along the straight lines that begin at its ends.
    pub fn at(&self, argument: f64) -> Jet<D> {
        let [first, last] = self.range();
        let inside = argument.clamp(first, last);
        let mut jet = self.within(self.cell_of(inside), inside);
        if inside != argument {
            for [value, slope, second] in &mut jet {
                *value += *slope * (argument - inside);
                *second = 0.0;
            }
        }
        jet
    }

    /// Values and derivatives where a cell begins.
    pub fn beginning(&self, cell: usize) -> Jet<D> {
        self.cells[cell].map(|[a, b, c, ..]| [a, b, 2.0 * c])
    }

    /// Values and derivatives of a cell's own polynomials, at its ends as well: there, those of its side.
    pub fn within(&self, cell: usize, argument: f64) -> Jet<D> {
        let t = argument - self.knots[cell];
        self.cells[cell].map(|[a, b, c, d, e, f]| {
            [
                a + t * (b + t * (c + t * (d + t * (e + t * f)))),
                b + t * (2.0 * c + t * (3.0 * d + t * (4.0 * e + t * 5.0 * f))),
                2.0 * c + t * (6.0 * d + t * (12.0 * e + t * 20.0 * f)),
            ]
        })
    }

    /// Cells with their ends and jets, from the first to the last.
    pub fn spans(&self) -> impl DoubleEndedIterator<Item = Span<D>> + '_ {
        (0..self.cells.len()).map(|cell| {
            let ends = [self.knots[cell], self.knots[cell + 1]];
            Span {
                ends,
                jets: ends.map(|end| self.within(cell, end)),
            }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn jet(x: f64) -> [f64; 3] {
        [x.sin(), x.cos(), -x.sin()]
    }

    fn sine(knots: &[f64]) -> Quintics<1> {
        let spans: Vec<_> = knots
            .windows(2)
            .map(|pair| Span {
                ends: [pair[0], pair[1]],
                jets: [[jet(pair[0])], [jet(pair[1])]],
            })
            .collect();
        Quintics::new(&spans).unwrap()
    }

    /// Halving the cells divides the error of the value by 64, as the sixth order has it.
    #[test]
    fn a_sine_is_met_to_the_sixth_order() {
        let error = |cells: usize| {
            let knots: Vec<_> = (0..=cells).map(|knot| 3.0 * knot as f64 / cells as f64).collect();
            let function = sine(&knots);
            (0..1000)
                .map(|place| 3e-3 * place as f64)
                .map(|x| (function.at(x)[0][0] - x.sin()).abs())
                .fold(0.0, f64::max)
        };
        let (coarse, fine) = (error(8), error(16));
        let order = (coarse / fine).log2();
        assert!((5.8..6.2).contains(&order), "{order}");
    }

    /// Cells of very different lengths, arguments at the knots, beyond the ends and not a number.
    #[test]
    fn each_argument_finds_its_cell() {
        let knots = [-1.0, -0.999, -0.3, 0.0, 1e-9, 0.5, 2.0];
        let function = sine(&knots);
        for cell in 0..6 {
            for share in [0.0, 0.3, 0.999] {
                let argument = knots[cell] + share * (knots[cell + 1] - knots[cell]);
                assert_eq!(function.cell_of(argument), cell, "{argument}");
            }
        }
        let beyond = function.at(3.0)[0];
        assert!((beyond[0] - (2f64.sin() + 2f64.cos())).abs() < 1e-14 && beyond[2] == 0.0);
        assert!(function.at(f64::NAN)[0][0].is_nan());
    }

    #[test]
    fn cells_without_length_are_refused() {
        let span = |ends| Span {
            ends,
            jets: [[[0.0; 3]]; 2],
        };
        assert_eq!(Quintics::<1>::new(&[]), None);
        assert_eq!(Quintics::new(&[span([1.0, 1.0])]), None);
        assert_eq!(Quintics::new(&[span([0.0, f64::INFINITY])]), None);
        assert_eq!(Quintics::new(&[span([f64::NAN, 1.0])]), None);
    }
}
