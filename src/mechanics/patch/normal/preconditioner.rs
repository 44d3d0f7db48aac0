//! The preconditioner of the pressure's conjugate gradients: each cell with its neighbours.
//!
//! A residual on a set of cells asks for a change of their pressures. A cell's own change is taken from its residual and those of the cells around it as if these alone were
//! there: with the middle row of the inverse of their influence. The influence of a pressure reaches far, its inverse does not, as pressures beside a
//! cell shield it from those farther away.

use super::super::contact::Contact;
use crate::body::grid::Grid;
use crate::numerics::dense;
use crate::numerics::single::{WIDTH, Wide, padded};
use nalgebra::{DMatrix, DVector};

/// Cells around a cell that count, in each direction.
const AROUND: usize = 2;
const BREADTH: usize = 2 * AROUND + 1;

/// Weights of the residuals around a cell.
#[derive(Debug, Clone)]
pub struct Neighbours {
    /// Row by row, from the strip with the least number to that with the largest.
    weights: [[f32; BREADTH]; BREADTH],
}

impl Neighbours {
    /// Weights for a grid from the influence as a function of the lag, which is known for lags within the grid.
    pub fn new(grid: &Grid, influence: impl Fn((isize, isize)) -> f64) -> Neighbours {
        let [along, across] = [grid.cells, grid.strips].map(|count| AROUND.min((count - 1) / 2));
        let (length, breadth) = (2 * along + 1, 2 * across + 1);
        let cells = length * breadth;
        let lag = |to: usize, from: usize| to as isize - from as isize;
        let block = DMatrix::from_fn(cells, cells, |i, j| {
            influence((lag(i % length, j % length), lag(i / length, j / length)))
        });
        let middle = cells / 2;
        let unit = DVector::from_fn(cells, |i, _| if i == middle { 1.0 } else { 0.0 });
        let row = block.cholesky().map(|factor| factor.solve(&unit));
        // Conjugate gradients need weights that make a positive definite matrix on any set of cells. They do if the middle one outweighs the others together; if it
        // does not, each cell counts alone.
        let outweighs = |row: &DVector<f64>| 2.0 * row[middle] > row.iter().map(|weight| weight.abs()).sum();
        let row = row.filter(outweighs).unwrap_or_else(|| unit / influence((0, 0)));
        // From one quarter of the block, so that mirror images have the same weights to the last bit.
        let mut weights = [[0.0; BREADTH]; BREADTH];
        for (strip, weights) in (-(AROUND as isize)..).zip(&mut weights) {
            for (cell, weight) in (-(AROUND as isize)..).zip(weights) {
                let (strip, cell) = (strip.unsigned_abs(), cell.unsigned_abs());
                if strip <= across && cell <= along {
                    *weight = row[middle + strip * length + cell] as f32;
                }
            }
        }
        Neighbours { weights }
    }

    /// Multiplications and additions of a product with the values of the contact's cells.
    pub fn work(&self, contact: &Contact) -> u64 {
        (BREADTH * BREADTH * contact.cells()) as u64
    }

    /// Multiplies the values of the contact's cells by the weights of their neighbours in contact, in place and in single precision.
    pub fn apply(&self, contact: &Contact, values: &mut [f64], field: &mut Field) {
        let Field { stride, values: around } = field;
        let stride = *stride;
        dense::vectorised(
            #[inline(always)]
            |arithmetic| {
                for run in contact.runs() {
                    let place = (run.strip + AROUND) * stride + run.first + AROUND;
                    for (single, value) in around[place..].iter_mut().zip(&values[run.indices()]) {
                        *single = *value as f32;
                    }
                }
                for run in contact.runs() {
                    let corner = run.strip * stride + run.first;
                    for (vector, own) in values[run.indices()].chunks_mut(WIDTH).enumerate() {
                        let mut sums = [[0.0_f32; WIDTH]; BREADTH];
                        for (row, (sum, weights)) in sums.iter_mut().zip(&self.weights).enumerate() {
                            let first = corner + row * stride + vector * WIDTH;
                            let values = &around[first..first + BREADTH - 1 + WIDTH];
                            for (values, &weight) in values.windows(WIDTH).zip(weights) {
                                for lane in 0..WIDTH {
                                    sum[lane] = arithmetic.multiply_add_single(values[lane], weight, sum[lane]);
                                }
                            }
                        }
                        let [a, b, c, d, e] = sums;
                        let sum: Wide =
                            std::array::from_fn(|lane| ((a[lane] + b[lane]) + (d[lane] + e[lane])) + c[lane]);
                        for (value, single) in own.iter_mut().zip(sum) {
                            *value = f64::from(single);
                        }
                    }
                }
            },
        );
    }
}

/// Values of the grid's cells in single precision with [`AROUND`] cells more on all sides, 0 where there is no contact.
pub struct Field {
    stride: usize,
    values: Vec<f32>,
}

impl Field {
    /// All zero, for a grid.
    pub fn new(grid: &Grid) -> Field {
        // Vectors that begin in a row may end beyond it.
        let stride = padded(grid.cells) + BREADTH - 1;
        Field {
            stride,
            values: vec![0.0; (grid.strips + BREADTH - 1) * stride + WIDTH],
        }
    }

    /// Forgets the cells of another contact.
    pub fn clear(&mut self) {
        self.values.fill(0.0);
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::rail;
    use super::*;

    /// Influence that decays with the distance, and the weights it leads to on a grid.
    fn neighbours(cells: usize, strips: usize) -> Neighbours {
        let grid = Grid::new(cells, strips, 1.0, 1.0);
        Neighbours::new(&grid, |(along, across)| {
            assert!(along.unsigned_abs() < cells && across.unsigned_abs() < strips);
            1.0 / (0.3 + (along as f64).hypot(across as f64))
        })
    }

    /// The product with the weights as a matrix of some cells, from products with unit vectors.
    fn matrix(neighbours: &Neighbours, grid: &Grid, contact: &Contact) -> DMatrix<f64> {
        let mut field = Field::new(grid);
        let n = contact.cells();
        let columns: Vec<_> = (0..n)
            .map(|column| {
                let mut values = DVector::zeros(n);
                values[column] = 1.0;
                neighbours.apply(contact, values.as_mut_slice(), &mut field);
                values
            })
            .collect();
        DMatrix::from_columns(&columns)
    }

    /// The weights are those of the cells around a cell, on a set with gaps and more than one vector in a strip.
    #[test]
    fn each_cell_takes_its_neighbours_in_contact() {
        let grid = Grid::new(21, 9, 1.0, 1.0);
        let neighbours = neighbours(21, 9);
        let mut contact = Contact::new(&grid);
        contact.list(&grid, |place| place % 7 != 3 && place % 11 != 5);
        let places: Vec<_> = contact
            .places(&grid)
            .map(|at| (at / grid.stride(), at % grid.stride()))
            .collect();
        let product = matrix(&neighbours, &grid, &contact);
        for (i, own) in places.iter().enumerate() {
            for (j, other) in places.iter().enumerate() {
                let [strip, cell] = [other.0 + AROUND, other.1 + AROUND];
                let weight = match (strip.checked_sub(own.0), cell.checked_sub(own.1)) {
                    (Some(strip @ 0..BREADTH), Some(cell @ 0..BREADTH)) => neighbours.weights[strip][cell],
                    _ => 0.0,
                };
                assert_eq!(product[(i, j)], f64::from(weight), "{own:?} {other:?}");
            }
        }
    }

    /// The condition number on the contact of a default patch is 3.5.
    #[test]
    fn the_condition_is_that_of_few_iterations() {
        let rail = rail();
        let grid = &rail.grid;
        let mut contact = Contact::new(grid);
        let [x, y] = [0.7 * grid.half_length(), 0.35 * grid.breadth * grid.strips as f64];
        contact.list(grid, |place| {
            let (strip, cell) = (place / grid.stride(), place % grid.stride());
            (grid.x(cell) / x).powi(2) + (grid.y(strip) / y).powi(2) < 1.0
        });
        let n = contact.cells();
        assert!(n > 200, "{n}");
        let mut on_grid = vec![0.0; grid.len()];
        let mut scratch = rail.transform.scratch();
        let window = contact.window(grid, 0);
        let columns: Vec<_> = contact
            .places(grid)
            .map(|at| {
                let mut load = vec![0.0; grid.len()];
                load[at] = 1.0;
                let tables = &rail.normal_influence.tables;
                rail.transform.apply(tables, &window, &load, &mut on_grid, &mut scratch);
                let mut column = DVector::zeros(n);
                contact.gather(grid, &on_grid, column.as_mut_slice());
                column
            })
            .collect();
        let influence = DMatrix::from_columns(&columns);
        let weights = matrix(&rail.normal_influence.neighbours, grid, &contact);
        let half = weights.cholesky().expect("the weights are positive definite").l();
        let values = (half.transpose() * influence * half).symmetric_eigenvalues();
        let condition = values.max() / values.min();
        assert!(condition < 4.0, "{condition}");
    }

    /// A grid of few cells has fewer neighbours; the influence is asked for no lag beyond it.
    #[test]
    fn few_cells_have_fewer_neighbours() {
        let thin = neighbours(8, 3);
        assert!(
            thin.weights[0]
                .iter()
                .chain(&thin.weights[4])
                .all(|weight| *weight == 0.0)
        );
        assert!(
            thin.weights[1]
                .iter()
                .chain(&thin.weights[3])
                .all(|weight| *weight != 0.0)
        );
        let single = neighbours(1, 1);
        assert!((f64::from(single.weights[AROUND][AROUND]) - 0.3).abs() < 1e-7);
    }

    /// Weights that would not make a positive definite matrix are left out.
    #[test]
    fn an_influence_without_a_local_inverse_leaves_the_cell_alone() {
        let grid = Grid::new(9, 9, 1.0, 1.0);
        let flat = Neighbours::new(&grid, |lag| if lag == (0, 0) { 1.0 } else { 0.9 });
        let alone = Neighbours::new(&grid, |lag| if lag == (0, 0) { 2.0 } else { 3.0 });
        assert!(flat.weights[AROUND][AROUND] > 1.0 && flat.weights[0][0] < 0.0);
        let mut expected = [[0.0; BREADTH]; BREADTH];
        expected[AROUND][AROUND] = 0.5;
        assert_eq!(alone.weights, expected);
    }
}
