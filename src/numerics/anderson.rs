//! Anderson acceleration of a fixed-point iteration x ← G(x) (Anderson, J. ACM 12, 1965; Walker and Ni, SIAM J. Numer.
//! Anal. 49, 2011), on buffers that it owns.
//!
//! The next iterate is G(x) − Σ γ ΔG with γ = argmin ‖f − Σ γ ΔF‖, f = G(x) − x, over the last few differences. It brings
//! iterations to rest that diverge in a few directions.

use crate::numerics::dense;
use nalgebra::{SMatrix, SVector};

/// Differences that are kept.
const DEPTH: usize = 8;
/// Ridge of the least-squares problem, relative to its diagonal: differences that are parallel to round-off.
const RIDGE: f64 = 1e-12;

/// History of one iteration.
#[derive(Debug, Clone)]
pub struct Anderson {
    size: usize,
    stored: usize,
    iterates: usize,
    last_residual: Vec<f64>,
    last_image: Vec<f64>,
    residual: Vec<f64>,
    /// Differences ΔF and ΔG, one after the other, DEPTH × size.
    residual_changes: Vec<f64>,
    image_changes: Vec<f64>,
}

impl Anderson {
    /// Acceleration of vectors of the given size.
    pub fn new(size: usize) -> Anderson {
        Anderson {
            size,
            stored: 0,
            iterates: 0,
            last_residual: vec![0.0; size],
            last_image: vec![0.0; size],
            residual: vec![0.0; size],
            residual_changes: vec![0.0; DEPTH * size],
            image_changes: vec![0.0; DEPTH * size],
        }
    }

    /// Forgets the history.
    pub fn restart(&mut self) {
        self.stored = 0;
        self.iterates = 0;
    }

    /// Computes the next iterate, into `image`, from the iterate x and its image G(x).
    pub fn next(&mut self, iterate: &[f64], image: &mut [f64]) {
        let size = self.size;
        for ((residual, image), iterate) in self.residual.iter_mut().zip(&*image).zip(iterate) {
            *residual = image - iterate;
        }
        if self.iterates > 0 {
            let slot = (self.iterates - 1) % DEPTH * size;
            let subtract = |changes: &mut [f64], now: &[f64], last: &[f64]| {
                for ((change, now), last) in changes.iter_mut().zip(now).zip(last) {
                    *change = now - last;
                }
            };
            let range = slot..slot + size;
            subtract(
                &mut self.residual_changes[range.clone()],
                &self.residual,
                &self.last_residual,
            );
            subtract(&mut self.image_changes[range], image, &self.last_image);
            self.stored = (self.stored + 1).min(DEPTH);
        }
        self.iterates += 1;
        self.last_residual.copy_from_slice(&self.residual);
        self.last_image.copy_from_slice(image);

        let k = self.stored;
        let change = |j: usize| &self.residual_changes[j * size..(j + 1) * size];
        // Differences that are not stored yet have a row of the identity and no weight.
        let mut gram = SMatrix::<f64, DEPTH, DEPTH>::identity();
        let mut weights = SVector::<f64, DEPTH>::zeros();
        for j in 0..k {
            for i in j..k {
                gram[(i, j)] = dense::dot(change(i), change(j));
            }
            gram[(j, j)] *= 1.0 + RIDGE;
            weights[j] = dense::dot(change(j), &self.residual);
        }
        let Some(cholesky) = gram.cholesky() else {
            return;
        };
        cholesky.solve_mut(&mut weights);
        // Residuals so large that their squares overflow.
        if !weights.iter().all(|weight| weight.is_finite()) {
            return;
        }
        for (j, weight) in weights.iter().take(k).enumerate() {
            dense::add_multiple(&self.image_changes[j * size..(j + 1) * size], -weight, image);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// x ← A x + b with eigenvalues −3, 2, 0.5 and 0: plain iteration diverges, and as many differences as there are
    /// non-zero eigenvalues solve it.
    #[test]
    fn a_divergent_linear_iteration_comes_to_rest() {
        let eigenvalues = [-3.0, 2.0, 0.5, 0.0];
        let mut x = vec![1.0; 4];
        let mut anderson = Anderson::new(4);
        for _ in 0..6 {
            let mut image: Vec<f64> = eigenvalues.iter().zip(&x).map(|(a, x)| a * x + 1.0).collect();
            anderson.next(&x, &mut image);
            x = image;
        }
        for (a, x) in eigenvalues.iter().zip(&x) {
            assert!((x - 1.0 / (1.0 - a)).abs() < 1e-6, "{x}");
        }
    }
}
