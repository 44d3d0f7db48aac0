//! The directions in which Krylov's iterations have changed the shear, each with the response of the slip to it.
//!
//! The correction of the shear is a sum of these directions, and the response to it the same sum of their responses. So neither takes
//! another solution with the preconditioner, nor another product.

use crate::body::grid::Grid;
use crate::body::influence::Window;
use crate::numerics::dense;
use crate::numerics::single::{self, WIDTH};

/// Directions for up to so many iterations, in single precision.
pub struct Directions {
    /// Number of values on the grid, and of those for a vector register beyond it.
    len: usize,
    /// Changes of the shear of n cells, along x and then along y, one direction after the other, 2n each.
    shears: Vec<f32>,
    /// Responses of the slip on the grid, x and y, one direction after the other.
    responses: Vec<f32>,
}

impl Directions {
    /// Buffers for a grid.
    pub fn new(grid: &Grid, iterations: usize) -> Directions {
        Directions {
            len: grid.len() + WIDTH,
            shears: vec![0.0; 2 * grid.cells * grid.strips * iterations + WIDTH],
            responses: vec![0.0; 2 * (grid.len() + WIDTH) * iterations],
        }
    }

    /// Places of direction `number`, to be written: its shear, of so many unknowns, and the response along x and y on the grid, each with
    /// values for a vector register beyond.
    pub fn at(&mut self, number: usize, unknowns: usize) -> (&mut [f32], [&mut [f32]; 2]) {
        let shear = &mut self.shears[number * unknowns..][..unknowns + WIDTH];
        let (x, y) = self.responses[2 * number * self.len..][..2 * self.len].split_at_mut(self.len);
        (shear, [x, y])
    }

    /// Writes the sum of the shears, each times its share.
    pub fn sum_shears(&self, shares: &[f32], sum: &mut [f32]) {
        sum.fill(0.0);
        for (share, shear) in shares.iter().zip(self.shears.chunks_exact(sum.len())) {
            single::add_multiple(shear, *share, sum);
        }
    }

    /// Writes the sum of the responses, each times its share, where the window is read.
    pub fn sum_responses(&self, shares: &[f32], grid: &Grid, window: &Window, sum: &mut [Vec<f64>; 2]) {
        dense::vectorised(
            #[inline(always)]
            |arithmetic| {
                for (component, sum) in sum.iter_mut().enumerate() {
                    for read in window.rows(grid) {
                        let sum = &mut sum[read.clone()];
                        sum.fill(0.0);
                        let responses = self.responses[component * self.len..].chunks(2 * self.len);
                        for (share, response) in shares.iter().zip(responses) {
                            arithmetic.add_multiple_of_single(&response[read.clone()], f64::from(*share), sum);
                        }
                    }
                }
            },
        );
    }
}
