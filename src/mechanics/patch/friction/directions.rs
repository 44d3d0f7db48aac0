//! Directions of a correction's Krylov iterations, each a change of the shear with the response of the slip to it. The correction is a sum of them, and its
//! response the same sum: neither costs a product or a solution with the preconditioner of its own.

use crate::body::grid::Grid;
use crate::body::influence::Window;
use crate::numerics::single;
use std::ops::Range;

/// Directions for up to so many iterations, in single precision.
pub struct Directions {
    /// Values of a grid.
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
            len: grid.len(),
            shears: vec![0.0; 2 * grid.cells * grid.strips * iterations],
            responses: vec![0.0; 2 * grid.len() * iterations],
        }
    }

    /// Shear of direction `number`, of so many unknowns, and its response along x and y, to be written.
    pub fn at(&mut self, number: usize, unknowns: usize) -> (&mut [f32], [&mut [f32]; 2]) {
        let shear = &mut self.shears[number * unknowns..][..unknowns];
        let (x, y) = self.responses[2 * number * self.len..][..2 * self.len].split_at_mut(self.len);
        (shear, [x, y])
    }

    /// Writes the sum of the shears with shares in it.
    pub fn sum_shears(&self, shares: &[f32], sum: &mut [f32]) {
        sum.fill(0.0);
        for (share, shear) in shares.iter().zip(self.shears.chunks_exact(sum.len())) {
            single::add_multiple(shear, *share, sum);
        }
    }

    /// Writes the sum of the responses, where the window reads them. Other values of its strips are of no use.
    pub fn sum_responses(&self, shares: &[f32], grid: &Grid, window: &Window, sum: &mut [Vec<f32>; 2]) {
        let rows: Range<usize> = window.strips.start * grid.stride()..window.strips.end * grid.stride();
        for (component, sum) in sum.iter_mut().enumerate() {
            let sum = &mut sum[rows.clone()];
            sum.fill(0.0);
            let responses = self.responses[component * self.len..].chunks(2 * self.len);
            for (share, response) in shares.iter().zip(responses) {
                single::add_multiple(&response[rows.clone()], *share, sum);
            }
        }
    }
}
