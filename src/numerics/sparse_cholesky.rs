//! The sparse Cholesky factor of the stiffness, and its solve for many right-hand sides at once.
//!
//! faer factorises. The solve, which takes far longer with two right-hand sides for each contact node, is written out here:
//! faer's own is slow without faer's feature `std`, and that feature's matrix product keeps a thread-local buffer with a
//! destructor, which a library that is unloaded at run time must not have.

use crate::numerics::dense::{self, Arithmetic};
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::LltRegularization;
use faer::sparse::SparseColMat;
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::supernodal::SupernodalLltRef;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering, factorize_symbolic_cholesky,
};
use faer::{Par, Side};

/// P A Pᵀ = L Lᵀ for the lower triangle of a symmetric positive definite A.
#[derive(Debug)]
pub struct SparseCholesky {
    symbolic: SymbolicCholesky<usize>,
    values: Vec<f64>,
}

impl SparseCholesky {
    /// Factorises; `None` where the matrix is not positive definite.
    pub fn new(matrix: &SparseColMat<usize, f64>) -> Option<SparseCholesky> {
        let parameters = CholeskySymbolicParams {
            supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SUPERNODAL,
            ..Default::default()
        };
        let symbolic =
            factorize_symbolic_cholesky(matrix.symbolic(), Side::Lower, SymmetricOrdering::Amd, parameters).ok()?;
        let mut values = vec![0.0; symbolic.len_val()];
        let scratch = symbolic.factorize_numeric_llt_scratch::<f64>(Par::Seq, Default::default());
        symbolic
            .factorize_numeric_llt(
                &mut values,
                matrix.as_ref(),
                Side::Lower,
                LltRegularization::default(),
                Par::Seq,
                MemStack::new(&mut MemBuffer::try_new(scratch).ok()?),
                Default::default(),
            )
            .ok()?;
        Some(SparseCholesky { symbolic, values })
    }

    /// The row of an unknown in what [`SparseCholesky::solve_in_place`] solves: the order of the factor.
    pub fn row_of(&self, unknown: usize) -> usize {
        self.symbolic
            .perm()
            .map_or(unknown, |permutation| permutation.arrays().1[unknown])
    }

    /// Solves A X = B in place, rows in the order of the factor: forward with L, backward with Lᵀ. Where there are many
    /// right-hand sides, 32 at a time are quickest: eight vector registers of AVX2. A supernode is a run of
    /// columns with one pattern: a dense triangle, and below it a dense block whose rows lie at the places of the pattern.
    pub fn solve_in_place<const WIDTH: usize>(&self, rows: &mut [[f64; WIDTH]]) {
        let SymbolicCholeskyRaw::Supernodal(symbolic) = self.symbolic.raw() else {
            unreachable!("a supernodal factorisation was asked for");
        };
        let factor = SupernodalLltRef::new(symbolic, &self.values);
        dense::vectorised(
            #[inline(always)]
            |arithmetic| {
                for node in 0..symbolic.n_supernodes() {
                    let node = factor.supernode(node);
                    let (start, block) = (node.start(), node.val());
                    let columns = block.ncols();
                    // A load at a few nodes leaves most rows zero; a supernode whose own rows are zero changes no others.
                    if rows[start..start + columns].iter().flatten().all(|value| *value == 0.0) {
                        continue;
                    }
                    for row in 0..block.nrows() {
                        let target = match row.checked_sub(columns) {
                            None => start + row,
                            Some(below) => node.pattern()[below],
                        };
                        let mut sum = rows[target];
                        for column in 0..row.min(columns) {
                            subtract(arithmetic, &mut sum, block[(row, column)], &rows[start + column]);
                        }
                        if row < columns {
                            divide(&mut sum, block[(row, row)]);
                        }
                        rows[target] = sum;
                    }
                }
                for node in (0..symbolic.n_supernodes()).rev() {
                    let node = factor.supernode(node);
                    let (start, block) = (node.start(), node.val());
                    let columns = block.ncols();
                    for column in (0..columns).rev() {
                        let mut sum = rows[start + column];
                        for row in column + 1..columns {
                            subtract(arithmetic, &mut sum, block[(row, column)], &rows[start + row]);
                        }
                        for (below, place) in node.pattern().iter().enumerate() {
                            subtract(arithmetic, &mut sum, block[(columns + below, column)], &rows[*place]);
                        }
                        divide(&mut sum, block[(column, column)]);
                        rows[start + column] = sum;
                    }
                }
            },
        );
    }
}

#[inline(always)]
fn subtract<const WIDTH: usize>(arithmetic: Arithmetic, sum: &mut [f64; WIDTH], factor: f64, row: &[f64; WIDTH]) {
    for (sum, value) in sum.iter_mut().zip(row) {
        *sum = arithmetic.multiply_add(-factor, *value, *sum);
    }
}

#[inline(always)]
fn divide<const WIDTH: usize>(row: &mut [f64; WIDTH], divisor: f64) {
    for value in row {
        *value /= divisor;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use faer::sparse::Triplet;

    /// The five-point Laplacian plus one on a grid.
    #[test]
    fn the_solution_satisfies_the_equations() {
        let side = 23;
        let n = side * side;
        let mut entries = Vec::new();
        for i in 0..n {
            entries.push(Triplet::new(i, i, 5.0));
            if (i + 1) % side != 0 {
                entries.push(Triplet::new(i + 1, i, -1.0));
            }
            if i + side < n {
                entries.push(Triplet::new(i + side, i, -1.0));
            }
        }
        let matrix = SparseColMat::<usize, f64>::try_new_from_triplets(n, n, &entries).unwrap();
        let factor = SparseCholesky::new(&matrix).unwrap();
        let right = |i: usize, field: usize| ((7 * i + 13 * field) % 11) as f64 - 5.0;
        let mut rows = vec![[0.0; 5]; n];
        for i in 0..n {
            rows[factor.row_of(i)] = std::array::from_fn(|field| right(i, field));
        }
        factor.solve_in_place(&mut rows);
        for field in 0..5 {
            let solution = |i: usize| rows[factor.row_of(i)].as_slice()[field];
            let mut residual: Vec<f64> = (0..n).map(|i| right(i, field)).collect();
            for entry in &entries {
                residual[entry.row] -= entry.val * solution(entry.col);
                if entry.row != entry.col {
                    residual[entry.col] -= entry.val * solution(entry.row);
                }
            }
            assert!(residual.iter().all(|r| r.abs() < 1e-12), "{field}");
        }
    }

    #[test]
    fn an_indefinite_matrix_is_refused() {
        let entries = [
            Triplet::new(0, 0, 1.0),
            Triplet::new(1, 0, 2.0),
            Triplet::new(1, 1, 1.0),
        ];
        let matrix = SparseColMat::<usize, f64>::try_new_from_triplets(2, 2, &entries).unwrap();
        assert!(SparseCholesky::new(&matrix).is_none());
    }
}
