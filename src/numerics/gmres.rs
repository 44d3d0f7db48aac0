//! The generalised method of minimal residuals (Saad and Schultz 1986) with a preconditioner from the right, in single
//! precision: for the corrections of Newton's method, whose residual is computed in double precision.

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
    rhs: Vec<f32>,
    work: Vec<f32>,
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
            work: vec![0.0; unknowns],
        }
    }

    /// Solves to a residual of `tolerance` relative to `values`, the right-hand side, which becomes the solution. `multiply` writes the
    /// product with a vector, `precondition` solves approximately, in place.
    pub fn solve(
        &mut self,
        values: &mut [f32],
        tolerance: f32,
        mut multiply: impl FnMut(&[f32], &mut [f32]),
        mut precondition: impl FnMut(&mut [f32]),
    ) -> Solved {
        let n = values.len();
        let size = single::norm(values);
        if size == 0.0 || !size.is_finite() {
            return Solved {
                iterations: 0,
                residual: if size == 0.0 { 0.0 } else { f32::INFINITY },
            };
        }
        let limit = self.iterations;
        for (direction, value) in self.basis[..n].iter_mut().zip(values.iter()) {
            *direction = value / size;
        }
        self.rhs[0] = size;
        let (mut done, mut residual) = (0, size);
        while done < limit && residual > tolerance * size {
            let (known, new) = self.basis.split_at_mut((done + 1) * n);
            let new = &mut new[..n];
            let work = &mut self.work[..n];
            work.copy_from_slice(&known[done * n..]);
            precondition(work);
            multiply(work, new);
            let column = &mut self.triangle[done * limit..][..limit];
            for (entry, direction) in column.iter_mut().zip(known.chunks_exact(n)) {
                *entry = single::dot(direction, new);
                single::add_multiple(direction, -*entry, new);
            }
            let height = single::norm(new);
            if height > 0.0 {
                new.iter_mut().for_each(|value| *value /= height);
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
        // Back substitution; the solution is a sum of preconditioned directions, the preconditioner a linear map of their sum.
        for k in (0..done).rev() {
            let mut value = self.rhs[k];
            for later in k + 1..done {
                value -= self.triangle[later * limit + k] * self.rhs[later];
            }
            self.rhs[k] = value / self.triangle[k * limit + k];
        }
        values.fill(0.0);
        for (share, direction) in self.rhs[..done].iter().zip(self.basis.chunks_exact(n)) {
            single::add_multiple(direction, *share, values);
        }
        precondition(values);
        Solved {
            iterations: done,
            residual: residual / size,
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
            let mut x = rhs.clone();
            let solved = Gmres::new(n, 40).solve(&mut x, 1e-5, multiply, |values| {
                if preconditioned {
                    for (i, value) in values.iter_mut().enumerate() {
                        *value /= 2.0 + 0.1 * i as f32;
                    }
                }
            });
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
        let mut x = vec![1.0; 6];
        let rotate = |x: &[f32], out: &mut [f32]| (0..6).for_each(|i| out[(i + 1) % 6] = x[i] * (1.0 + i as f32));
        let solved = Gmres::new(6, 3).solve(&mut x, 1e-6, rotate, |_| {});
        assert_eq!(solved.iterations, 3);
        assert!(solved.residual > 1e-6);
        let mut zero = vec![0.0; 6];
        assert_eq!(Gmres::new(6, 3).solve(&mut zero, 1e-6, rotate, |_| {}).iterations, 0);
    }
}
