//! The generalised method of minimal residuals (Saad and Schultz 1986) in single precision: for the corrections of Newton's method,
//! whose residual is computed in double precision.
//!
//! The method knows of no preconditioner. A caller that has one, M, applies it from the right: in place of A x = b it solves
//! A M⁻¹ y = b, where x = M⁻¹ y. As y is a sum of the method's directions v, with [`Gmres::shares`], x is the same sum of the M⁻¹ v.
//! The caller has computed these for its products, and may keep them.

use super::single;

/// Scratch for systems of up to so many unknowns and iterations.
#[derive(Debug, Clone)]
pub struct Gmres {
    /// Largest number of iterations.
    iterations: usize,
    /// Orthonormal directions, one after the other.
    basis: Vec<f32>,
    /// Upper triangle of the rotated Hessenberg matrix, column by column, `iterations` each.
    triangle: Vec<f32>,
    rotations: Vec<(f32, f32)>,
    /// Rotated right-hand side; after a solve the shares of the directions in the solution.
    rhs: Vec<f32>,
    /// Directions of the last solve.
    done: usize,
}

/// Result of a solve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Solved {
    /// Products with the matrix.
    pub iterations: usize,
    /// Residual relative to the right-hand side.
    pub residual: f32,
}

impl Gmres {
    /// Method for up to `unknowns` and `iterations`.
    pub fn new(unknowns: usize, iterations: usize) -> Gmres {
        Gmres {
            iterations,
            basis: vec![0.0; unknowns * (iterations + 1)],
            triangle: vec![0.0; iterations * iterations],
            rotations: vec![(1.0, 0.0); iterations],
            rhs: vec![0.0; iterations + 1],
            done: 0,
        }
    }

    /// Solves to a residual of `tolerance` relative to the right-hand side `rhs`. `multiply` writes the product with a vector.
    pub fn solve(&mut self, rhs: &[f32], tolerance: f32, mut multiply: impl FnMut(&[f32], &mut [f32])) -> Solved {
        let n = rhs.len();
        self.done = 0;
        let size = single::norm(rhs);
        if size == 0.0 || !size.is_finite() {
            return Solved {
                iterations: 0,
                residual: if size == 0.0 { 0.0 } else { f32::INFINITY },
            };
        }
        let limit = self.iterations;
        self.basis[..n].copy_from_slice(rhs);
        single::divide(&mut self.basis[..n], size);
        self.rhs[0] = size;
        let (mut done, mut residual) = (0, size);
        while done < limit && residual > tolerance * size {
            let (known, new) = self.basis.split_at_mut((done + 1) * n);
            let new = &mut new[..n];
            multiply(&known[done * n..], new);
            let column = &mut self.triangle[done * limit..][..limit];
            for (entry, direction) in column.iter_mut().zip(known.chunks_exact(n)) {
                *entry = single::dot(direction, new);
                single::add_multiple(direction, -*entry, new);
            }
            let height = single::norm(new);
            if height > 0.0 {
                single::divide(new, height);
            }
            for (k, (cosine, sine)) in self.rotations[..done].iter().enumerate() {
                let (upper, lower) = (column[k], column[k + 1]);
                column[k] = cosine * upper + sine * lower;
                column[k + 1] = cosine * lower - sine * upper;
            }
            let length = column[done].hypot(height);
            if length == 0.0 || !length.is_finite() {
                break;
            }
            let (cosine, sine) = (column[done] / length, height / length);
            self.rotations[done] = (cosine, sine);
            column[done] = length;
            self.rhs[done + 1] = -sine * self.rhs[done];
            self.rhs[done] *= cosine;
            done += 1;
            residual = self.rhs[done].abs();
            if height == 0.0 {
                break;
            }
        }
        for k in (0..done).rev() {
            let mut value = self.rhs[k];
            for later in k + 1..done {
                value -= self.triangle[later * limit + k] * self.rhs[later];
            }
            self.rhs[k] = value / self.triangle[k * limit + k];
        }
        self.done = done;
        Solved {
            iterations: done,
            residual: residual / size,
        }
    }

    /// Shares of the directions, in their order, in the solution of the last solve.
    pub fn shares(&self) -> &[f32] {
        &self.rhs[..self.done]
    }

    /// Writes the solution of the last solve, of as many unknowns.
    pub fn solution(&self, values: &mut [f32]) {
        values.fill(0.0);
        for (share, direction) in self.shares().iter().zip(self.basis.chunks_exact(values.len())) {
            single::add_multiple(direction, *share, values);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn matrix(n: usize) -> Vec<f32> {
        (0..n * n)
            .map(|k| {
                let (i, j) = (k % n, k / n);
                let off = 0.3 * ((3 * i + 7 * j) as f32).sin() / (1.0 + i.abs_diff(j) as f32);
                if i == j { 2.0 + 0.1 * i as f32 } else { off }
            })
            .collect()
    }

    #[test]
    fn the_solution_satisfies_the_system() {
        let n = 40;
        let a = matrix(n);
        let multiply = |x: &[f32], out: &mut [f32]| {
            out.fill(0.0);
            for (column, x) in a.chunks_exact(n).zip(x) {
                single::add_multiple(column, *x, out);
            }
        };
        let rhs: Vec<f32> = (0..n).map(|i| (i as f32).cos()).collect();
        let mut counts = Vec::new();
        for preconditioned in [false, true] {
            let mut x = vec![0.0; n];
            let mut gmres = Gmres::new(n, 40);
            let mut kept: Vec<Vec<f32>> = Vec::new();
            let solved = gmres.solve(&rhs, 1e-5, |direction, product| {
                let diagonal = |i: usize| if preconditioned { 2.0 + 0.1 * i as f32 } else { 1.0 };
                let corrected: Vec<f32> = direction
                    .iter()
                    .enumerate()
                    .map(|(i, value)| value / diagonal(i))
                    .collect();
                multiply(&corrected, product);
                kept.push(corrected);
            });
            for (kept, share) in kept.iter().zip(gmres.shares()) {
                single::add_multiple(kept, *share, &mut x);
            }
            if !preconditioned {
                let mut summed = vec![1.0; n];
                gmres.solution(&mut summed);
                assert_eq!(summed, x);
            }
            let mut product = vec![0.0; n];
            multiply(&x, &mut product);
            let error = product.iter().zip(&rhs).map(|(p, r)| (p - r).abs()).fold(0.0, f32::max);
            assert!(solved.residual <= 1e-5 && error < 1e-4, "{solved:?} {error:e}");
            counts.push(solved.iterations);
        }
        assert!(counts[1] < counts[0], "{counts:?}");
    }

    #[test]
    fn a_limit_ends_it() {
        let rotate = |x: &[f32], out: &mut [f32]| (0..6).for_each(|i| out[(i + 1) % 6] = x[i] * (1.0 + i as f32));
        let mut gmres = Gmres::new(6, 3);
        let solved = gmres.solve(&[1.0; 6], 1e-6, rotate);
        assert_eq!((solved.iterations, gmres.shares().len()), (3, 3));
        assert!(solved.residual > 1e-6);
        let mut x = [1.0; 6];
        assert_eq!(gmres.solve(&[0.0; 6], 1e-6, rotate).iterations, 0);
        gmres.solution(&mut x);
        assert_eq!(x, [0.0; 6]);
    }
}
