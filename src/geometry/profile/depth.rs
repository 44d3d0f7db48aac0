//! Depth by which a profile has worn, as a contact collects it: means W_i over equal cells of the new profile's arc length, and
//! between them the cubic B-spline B whose coefficients they are,
//!
//! d(s) = Σ W_i B((s − s_i)/h).
//!
//! It is twice differentiable, as curvatures ask for, nowhere negative where no mean is, and holds as much as the cells do,
//! ∫ d ds = h Σ W_i. A peak of one cell becomes as broad as four.

/// Cells of a profile's arc length.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DepthGrid {
    /// Arc length at which the first cell begins, `m`.
    pub first: f64,
    /// Length h of a cell, `m`.
    pub spacing: f64,
    /// Number of cells.
    pub cells: usize,
}

impl DepthGrid {
    /// Grid of so many cells between two arc lengths, `m`.
    pub fn new([first, last]: [f64; 2], cells: usize) -> DepthGrid {
        DepthGrid {
            first,
            spacing: (last - first) / cells as f64,
            cells,
        }
    }

    /// Arc length s_i of the middle of a cell, `m`.
    pub fn middle(&self, cell: usize) -> f64 {
        self.first + (cell as f64 + 0.5) * self.spacing
    }

    /// Knots of the spline: arc lengths between which it is one polynomial each, `m`.
    pub fn knots(&self) -> Vec<f64> {
        (0..self.cells).map(|cell| self.middle(cell)).collect()
    }

    /// Depth d, `m`, with its first and second derivative at an arc length, `m`; beyond the cells there is none.
    pub fn at(&self, means: &[f64], arc: f64) -> [f64; 3] {
        let place = (arc - self.first) / self.spacing - 0.5;
        if !(-2.0..self.cells as f64 + 1.0).contains(&place) {
            return [0.0; 3];
        }
        let (before, t) = (place.floor(), place - place.floor());
        let mean = |next: isize| {
            let cell = before as isize + next;
            usize::try_from(cell)
                .ok()
                .and_then(|cell| means.get(cell))
                .copied()
                .unwrap_or(0.0)
        };
        let [a, b, c, d] = [mean(-1), mean(0), mean(1), mean(2)];
        let s = 1.0 - t;
        [
            (s * s * s * a + (4.0 - 3.0 * t * t * (1.0 + s)) * b + (4.0 - 3.0 * s * s * (1.0 + t)) * c + t * t * t * d)
                / 6.0,
            0.5 * (t * t * d - s * s * a + t * (3.0 * t - 4.0) * b + s * (4.0 - 3.0 * s) * c) / self.spacing,
            (s * a + (3.0 * t - 2.0) * b + (1.0 - 3.0 * t) * c + t * d) / (self.spacing * self.spacing),
        ]
    }

    /// Whether there is no depth between two arc lengths, `m`.
    pub fn is_zero(&self, means: &[f64], [from, to]: [f64; 2]) -> bool {
        let cell = |arc: f64| ((arc - self.first) / self.spacing).clamp(0.0, self.cells as f64) as usize;
        let cells = cell(from).saturating_sub(2)..(cell(to) + 3).min(self.cells);
        means[cells].iter().all(|&mean| mean == 0.0)
    }

    /// Arc lengths between which the spline changes where the means of some cells do, `m`.
    pub fn reach(&self, cells: std::ops::Range<usize>) -> [f64; 2] {
        [
            self.middle(cells.start) - 2.0 * self.spacing,
            self.middle(cells.end) + 1.0 * self.spacing,
        ]
    }

    /// Spreads an amount over a stretch of arc length, `m`, with a density that is linear over it: `tilt` is half the difference of the
    /// densities at its ends over their mean, −1 to 1. Each cell that it meets is given its part; what lies beyond the cells goes to the
    /// first or the last one, so that the parts add up to the amount.
    pub fn spread(&self, [from, to]: [f64; 2], amount: f64, tilt: f64, mut give: impl FnMut(usize, f64)) {
        let length = to - from;
        let place = |arc: f64| ((arc - self.first) / self.spacing).clamp(0.0, self.cells as f64 - 1.0) as usize;
        let (first, last) = (place(from), place(to));
        // Part of the amount up to an arc length.
        let until = |arc: f64| {
            let t = ((arc - from) / length).clamp(0.0, 1.0);
            t * (1.0 + tilt * (t - 1.0))
        };
        let mut before = 0.0;
        for cell in first..last {
            let part = until(self.first + (cell + 1) as f64 * self.spacing);
            give(cell, amount * (part - before));
            before = part;
        }
        give(last, amount * (1.0 - before));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn means(cells: usize) -> Vec<f64> {
        (0..cells)
            .map(|cell| {
                if (5..cells - 5).contains(&cell) {
                    ((3 * cell) as f64).sin() + 1.5
                } else {
                    0.0
                }
            })
            .collect()
    }

    /// Slopes are those of differences, across the cells' joints as well, and constant means are met.
    #[test]
    fn the_spline_is_twice_differentiable() {
        let grid = DepthGrid::new([0.2, 0.9], 70);
        let means = means(70);
        let step = 1e-6;
        for place in 0..400 {
            let arc = 0.21 + 1.7e-3 * f64::from(place);
            let [low, here, high] = [-step, 0.0, step].map(|step| grid.at(&means, arc + step));
            let slope = (high[0] - low[0]) / (2.0 * step);
            let second = (high[1] - low[1]) / (2.0 * step);
            assert!(
                (slope - here[1]).abs() < 1e-4 * (1.0 + here[1].abs()),
                "{arc}: {slope} {}",
                here[1]
            );
            assert!(
                (second - here[2]).abs() < 1e-1 + 1e-4 * here[2].abs(),
                "{arc}: {second} {}",
                here[2]
            );
        }
        let [value, slope, second] = grid.at(&[2.0; 70], 0.5);
        assert!((value - 2.0).abs() < 1e-14 && slope.abs() < 1e-12 && second.abs() < 1e-9);
    }

    /// ∫ d ds = h Σ W_i.
    #[test]
    fn the_spline_holds_what_the_cells_do() {
        let grid = DepthGrid::new([0.2, 0.9], 70);
        let means = means(70);
        // Simpson's rule is exact for cubics.
        let integral: f64 = (0..70)
            .map(|cell| {
                let [from, middle, to] = [-0.5, 0.0, 0.5].map(|part| grid.middle(cell) + part * grid.spacing);
                let half = |a: f64, b: f64| {
                    let [low, half, high] = [a, 0.5 * (a + b), b].map(|arc| grid.at(&means, arc)[0]);
                    (b - a) / 6.0 * (low + 4.0 * half + high)
                };
                half(from, middle) + half(middle, to)
            })
            .sum();
        let sum = grid.spacing * means.iter().sum::<f64>();
        assert!((integral / sum - 1.0).abs() < 1e-13, "{integral} {sum}");
    }

    /// The parts add up, and have the first moment of a linear density; beyond the cells nothing is lost.
    #[test]
    fn what_is_spread_is_kept() {
        let grid = DepthGrid::new([0.0, 1.0], 1000);
        for tilt in [-1.0, 0.0, 0.4] {
            let (from, to) = (0.2113, 0.3478);
            let (mut sum, mut moment) = (0.0, 0.0);
            grid.spread([from, to], 3.0, tilt, |cell, part| {
                sum += part;
                moment += part * grid.middle(cell);
            });
            let middle = 0.5 * (from + to) + tilt * (to - from) / 6.0;
            assert!((sum - 3.0).abs() < 1e-14, "{sum}");
            // The middle of a cell stands for its place.
            assert!(
                (moment / 3.0 - middle).abs() < 1e-4 * (to - from),
                "{tilt}: {} {middle}",
                moment / 3.0
            );
        }
        let mut given = Vec::new();
        grid.spread([-0.2, 0.0005], 1.0, 0.0, |cell, part| given.push((cell, part)));
        assert_eq!(given, [(0, 1.0)]);
    }
}
