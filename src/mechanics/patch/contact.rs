//! The cells under pressure, strip by strip.

use crate::body::grid::Grid;
use crate::body::influence::{Transform, Window};
use crate::numerics::dense;
use std::ops::Range;

/// Neighbouring cells of one strip, all under pressure.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CellRun {
    /// Strip of the cells.
    pub strip: usize,
    /// First cell of the run.
    pub first: usize,
    /// Number of cells.
    pub cells: usize,
    /// Number of cells in the runs before this one.
    pub offset: usize,
}

impl CellRun {
    /// Indices of the run's cells among all cells under pressure.
    pub fn indices(&self) -> Range<usize> {
        self.offset..self.offset + self.cells
    }

    /// Places of the run's cells on the grid.
    pub fn places(&self, grid: &Grid) -> Range<usize> {
        let start = grid.place(self.strip, self.first);
        start..start + self.cells
    }
}

/// Contact: all cells under pressure.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Contact {
    runs: Vec<CellRun>,
    cells: usize,
}

impl Contact {
    /// Contact without cells, with room for any number on a grid.
    pub fn new(grid: &Grid) -> Contact {
        Contact {
            runs: Vec::with_capacity(grid.strips * grid.cells.div_ceil(2)),
            cells: 0,
        }
    }

    /// Takes the cells of another one, without allocating.
    pub fn copy_from(&mut self, other: &Contact) {
        self.runs.clone_from(&other.runs);
        self.cells = other.cells;
    }

    /// Lists the cells for which `inside` holds, given their places.
    pub fn list(&mut self, grid: &Grid, inside: impl Fn(usize) -> bool) {
        self.runs.clear();
        self.cells = 0;
        for strip in 0..grid.strips {
            let row = grid.row(strip);
            let mut cell = 0;
            while cell < grid.cells {
                let cells = (cell..grid.cells).take_while(|&cell| inside(row.start + cell)).count();
                if cells > 0 {
                    self.runs.push(CellRun {
                        strip,
                        first: cell,
                        cells,
                        offset: self.cells,
                    });
                    self.cells += cells;
                }
                cell += cells + 1;
            }
        }
    }

    /// Runs of the contact, strip by strip.
    pub fn runs(&self) -> &[CellRun] {
        &self.runs
    }

    /// Number of cells.
    pub fn cells(&self) -> usize {
        self.cells
    }

    /// Smallest part of the grid that holds the cells, with `margin` cells more on either side to be read.
    pub fn window(&self, grid: &Grid, margin: usize) -> Window {
        let strips = self.runs.first().map_or(0, |run| run.strip)..self.runs.last().map_or(0, |run| run.strip + 1);
        let first = self.runs.iter().map(|run| run.first).min().unwrap_or(0);
        let end = self.runs.iter().map(|run| run.first + run.cells).max().unwrap_or(0);
        Window {
            strips,
            loaded: first..end,
            read: first.saturating_sub(margin)..(end + margin).min(grid.cells),
        }
    }

    /// Copies values on the grid to the cells.
    pub fn gather<T: Copy>(&self, grid: &Grid, values: &[T], out: &mut [T]) {
        for run in &self.runs {
            out[run.indices()].copy_from_slice(&values[run.places(grid)]);
        }
    }

    /// Copies values of the cells to the grid. Other places stay.
    pub fn scatter<T: Copy>(&self, grid: &Grid, values: &[T], out: &mut [T]) {
        for run in &self.runs {
            out[run.places(grid)].copy_from_slice(&values[run.indices()]);
        }
    }

    /// Copies values of the cells to the grid, rounded to single precision. Other places stay.
    pub fn scatter_single(&self, grid: &Grid, values: &[f64], out: &mut [f32]) {
        dense::vectorised(
            #[inline(always)]
            |_| {
                for run in &self.runs {
                    for (out, value) in out[run.places(grid)].iter_mut().zip(&values[run.indices()]) {
                        *out = *value as f32;
                    }
                }
            },
        );
    }

    /// Copies values on the grid in single precision to the cells.
    pub fn gather_single(&self, grid: &Grid, values: &[f32], out: &mut [f64]) {
        dense::vectorised(
            #[inline(always)]
            |_| {
                for run in &self.runs {
                    for (out, value) in out[run.indices()].iter_mut().zip(&values[run.places(grid)]) {
                        *out = f64::from(*value);
                    }
                }
            },
        );
    }

    /// Places of the cells on the grid, in their order.
    pub fn places<'a>(&'a self, grid: &'a Grid) -> impl Iterator<Item = usize> + 'a {
        self.runs.iter().flat_map(|run| run.places(grid))
    }
}

/// Multiplications and additions of a product of `components` with the tables from each to each, about: along x term by term, of complex
/// numbers and half of the harmonics, across by Fourier transforms, which take as much again.
pub fn work_of_product(transform: &Transform, window: &Window, components: usize) -> u64 {
    (4 * components * components * transform.strips() * window.loaded.len() * window.read.len()) as u64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_are_what_is_inside() {
        let grid = Grid::new(5, 3, 1.0, 1.0);
        let inside = ["01101", "00000", "11111"].concat();
        let inside =
            |place: usize| inside.as_bytes().get(place / grid.stride() * 5 + place % grid.stride()) == Some(&b'1');
        let mut contact = Contact::new(&grid);
        contact.list(&grid, inside);
        let runs: Vec<_> = contact
            .runs()
            .iter()
            .map(|run| (run.strip, run.first, run.cells, run.offset))
            .collect();
        assert_eq!(runs, [(0, 1, 2, 0), (0, 4, 1, 2), (2, 0, 5, 3)]);
        assert_eq!(contact.cells(), 8);
        assert!(contact.places(&grid).all(inside));
        let window = contact.window(&grid, 1);
        assert_eq!((window.strips, window.loaded, window.read), (0..3, 0..5, 0..5));
        let values: Vec<f64> = (0..grid.len()).map(|i| i as f64).collect();
        let (mut own, mut back) = (vec![0.0; 8], vec![0.0; grid.len()]);
        contact.gather(&grid, &values, &mut own);
        contact.scatter(&grid, &own, &mut back);
        for place in (0..3).flat_map(|strip| grid.row(strip)) {
            assert_eq!(back[place], if inside(place) { values[place] } else { 0.0 });
        }
    }
}
