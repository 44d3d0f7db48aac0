//! The sparse Cholesky factor of the stiffness, and its solve for many right-hand sides at once.
//!
//! faer orders the unknowns and finds the supernodes: runs of columns with one pattern, each a dense triangle and below it a
//! dense block whose rows lie at the places of the pattern. What is done with numbers is written out here: faer's matrix product
//! keeps its sizes of caches on the heap, and with faer's feature `std` a thread-local buffer with a destructor, and neither
//! may be left behind by a library that is unloaded at run time. Without that feature faer's solve is slow, too.

use crate::numerics::dense::{self, MultiplyAdd, QUAD};
use faer::Side;
use faer::sparse::SparseColMat;
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::supernodal::{SupernodalLltRef, SymbolicSupernodalCholesky};
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering, factorize_symbolic_cholesky,
};

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
        let mut factor = SparseCholesky {
            values: vec![0.0; symbolic.len_val()],
            symbolic,
        };
        factor.factorise(matrix)?;
        Some(factor)
    }

    fn supernodes(&self) -> &SymbolicSupernodalCholesky<usize> {
        let SymbolicCholeskyRaw::Supernodal(supernodes) = self.symbolic.raw() else {
            unreachable!("a supernodal factorisation was asked for");
        };
        supernodes
    }

    /// Supernode by supernode: its part of the matrix, minus the products of the supernodes before that have rows among its
    /// columns, divided by its own triangle (left-looking, as in T. A. Davis, *Direct Methods for Sparse Linear Systems*,
    /// section 4.8, with blocks for columns). `None` where a pivot is not positive.
    fn factorise(&mut self, matrix: &SparseColMat<usize, f64>) -> Option<()> {
        let n = matrix.ncols();
        let mut values = std::mem::take(&mut self.values);
        let supernodes = self.supernodes();
        let count = supernodes.n_supernodes();
        let (begin, end) = (supernodes.supernode_begin(), supernodes.supernode_end());
        let mut supernode_of = vec![0; n];
        for node in 0..count {
            supernode_of[begin[node]..end[node]].fill(node);
        }
        let mut entries = vec![Vec::new(); count];
        for entry in matrix.triplet_iter() {
            let (row, column) = (self.row_of(entry.row), self.row_of(entry.col));
            let (row, column) = (row.max(column), row.min(column));
            entries[supernode_of[column]].push((row, column, *entry.val));
        }
        // The supernodes that wait for a later one, and from which row of their pattern on.
        let mut waiting = vec![Vec::new(); count];
        let mut row_in_block = vec![0; n];
        let mut product = vec![0.0; n];
        for node in 0..count {
            let (start, columns) = (begin[node], end[node] - begin[node]);
            let pattern = supernodes.supernode(node).pattern();
            let rows = columns + pattern.len();
            for (place, row) in (start..end[node]).chain(pattern.iter().copied()).enumerate() {
                row_in_block[row] = place;
            }
            let (before, rest) = values.split_at_mut(supernodes.col_ptr_for_val()[node]);
            let block = &mut rest[..rows * columns];
            for (row, column, value) in &entries[node] {
                block[(column - start) * rows + row_in_block[*row]] += value;
            }
            for (other, from) in std::mem::take(&mut waiting[node]) {
                let (columns, below): (usize, &[usize]) =
                    (end[other] - begin[other], supernodes.supernode(other).pattern());
                let factor = SupernodeFactor {
                    values: &before[supernodes.col_ptr_for_val()[other]..],
                    rows: columns + below.len(),
                    columns,
                };
                let here = below[from..].partition_point(|row| *row < end[node]);
                for first in from..from + here {
                    let product = &mut product[..below.len() - first];
                    factor.product(columns + first, product);
                    let column = &mut block[(below[first] - start) * rows..][..rows];
                    for (row, value) in below[first..].iter().zip(product) {
                        column[row_in_block[*row]] -= *value;
                    }
                }
                wait(&mut waiting, &supernode_of, other, below, from + here);
            }
            factorise_block(block, rows, columns)?;
            wait(&mut waiting, &supernode_of, node, pattern, 0);
        }
        self.values = values;
        Some(())
    }

    /// The row of an unknown in what [`SparseCholesky::solve_in_place`] solves: the order of the factor.
    pub fn row_of(&self, unknown: usize) -> usize {
        self.symbolic
            .perm()
            .map_or(unknown, |permutation| permutation.arrays().1[unknown])
    }

    /// Solves A X = B in place, rows in the order of the factor: forward with L, backward with Lᵀ. Where there are many
    /// right-hand sides, 32 at a time are quickest: eight vector registers of AVX2.
    pub fn solve_in_place<const WIDTH: usize>(&self, rows: &mut [[f64; WIDTH]]) {
        let symbolic = self.supernodes();
        let factor = SupernodalLltRef::new(symbolic, &self.values);
        dense::vectorised(
            #[inline(always)]
            |fma| {
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
                            subtract(fma, &mut sum, block[(row, column)], &rows[start + column]);
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
                            subtract(fma, &mut sum, block[(row, column)], &rows[start + row]);
                        }
                        for (below, place) in node.pattern().iter().enumerate() {
                            subtract(fma, &mut sum, block[(columns + below, column)], &rows[*place]);
                        }
                        divide(&mut sum, block[(column, column)]);
                        rows[start + column] = sum;
                    }
                }
            },
        );
    }
}

/// Lets a supernode wait for the one that has its next row, at `from` in its pattern, among its columns.
fn wait(waiting: &mut [Vec<(usize, usize)>], supernode_of: &[usize], node: usize, pattern: &[usize], from: usize) {
    if let Some(row) = pattern.get(from) {
        waiting[supernode_of[*row]].push((node, from));
    }
}

/// The factor of a supernode, column by column.
struct SupernodeFactor<'a> {
    values: &'a [f64],
    rows: usize,
    columns: usize,
}

impl SupernodeFactor<'_> {
    /// The rows from `row` on times the row `row`: a column of L Lᵀ.
    fn product(&self, row: usize, out: &mut [f64]) {
        out.fill(0.0);
        dense::vectorised(
            #[inline(always)]
            |fma| self.add_columns(fma, row, 1.0, out),
        );
    }

    /// `out += factor ·` the rows from `row` on times the row `row`.
    #[inline(always)]
    fn add_columns(&self, fma: MultiplyAdd, row: usize, factor: f64, out: &mut [f64]) {
        let length = out.len();
        let column = |column: usize| &self.values[column * self.rows + row..][..length];
        let quads = self.columns - self.columns % QUAD;
        for first in (0..quads).step_by(QUAD) {
            let four = [column(first), column(first + 1), column(first + 2), column(first + 3)];
            fma.add_quad(four, four.map(|column| factor * column[0]), out);
        }
        for first in quads..self.columns {
            fma.add_multiple(column(first), factor * column(first)[0], out);
        }
    }
}

/// Replaces the columns of a supernode by those of its factor. `None` where a pivot is not positive.
fn factorise_block(block: &mut [f64], rows: usize, columns: usize) -> Option<()> {
    dense::vectorised(
        #[inline(always)]
        |fma| {
            for column in 0..columns {
                let (before, rest) = block.split_at_mut(column * rows);
                let before = SupernodeFactor {
                    values: before,
                    rows,
                    columns: column,
                };
                let out = &mut rest[column..rows];
                before.add_columns(fma, column, -1.0, out);
                let pivot = out[0];
                if pivot.is_nan() || pivot <= 0.0 {
                    return None;
                }
                let scale = 1.0 / pivot.sqrt();
                for value in out {
                    *value *= scale;
                }
            }
            Some(())
        },
    )
}

#[inline(always)]
fn subtract<const WIDTH: usize>(fma: MultiplyAdd, sum: &mut [f64; WIDTH], factor: f64, row: &[f64; WIDTH]) {
    for (sum, value) in sum.iter_mut().zip(row) {
        *sum = fma.multiply_add(-factor, *value, *sum);
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
