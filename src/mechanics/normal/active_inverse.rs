//! The inverse of the compliance on the active nodes, kept and brought up to date as nodes come and go.

use crate::error::{Error, Result};
use crate::numerics::dense;
use nalgebra::DMatrix;
use std::cmp::Ordering;

/// Nodes that the inverse follows before it is computed anew: round-off grows with each.
const LARGEST_FOLLOWED: usize = 32;

/// Least pivot by which a row is divided, relative to what it is the difference of.
const LEAST_PIVOT: f64 = 1e-8;

/// Multiplications and additions of an inverse on `nodes` nodes.
pub fn work(nodes: usize) -> usize {
    4 * nodes.pow(3) / 3
}

/// Inverse C_AA⁻¹ of the compliance on the active nodes A. It stays as long as they do; where one of them comes or goes, it follows at the cost of
/// some products of a matrix with a vector.
#[derive(Debug, Clone)]
pub struct ActiveInverse {
    /// The nodes that it belongs to, m of them, ascending.
    nodes: Vec<usize>,
    /// C_AA⁻¹, m × m.
    values: Vec<f64>,
    factor: Vec<f64>,
    pivots: Vec<usize>,
    /// C_AA⁻¹ 1.
    unit: Vec<f64>,
    /// Column and row by which the inverse changes with one node, m.
    column: Vec<f64>,
    row: Vec<f64>,
    gathered: Vec<f64>,
    /// Nodes that it has followed since it was computed.
    followed: usize,
}

impl ActiveInverse {
    /// Inverse on no nodes, with room for `nodes`.
    pub fn new(nodes: usize) -> ActiveInverse {
        ActiveInverse {
            nodes: Vec::with_capacity(nodes),
            values: vec![0.0; nodes * nodes],
            factor: vec![0.0; nodes * nodes],
            pivots: vec![0; nodes],
            unit: vec![0.0; nodes],
            column: vec![0.0; nodes],
            row: vec![0.0; nodes],
            gathered: vec![0.0; nodes],
            followed: 0,
        }
    }

    /// Forgets the inverse: the compliance is another one from now on.
    pub fn forget(&mut self) {
        self.nodes.clear();
    }

    /// The nodes that it belongs to, ascending.
    pub fn nodes(&self) -> &[usize] {
        &self.nodes
    }

    /// C_AA⁻¹, m × m.
    pub fn values(&self) -> &[f64] {
        let m = self.nodes.len();
        &self.values[..m * m]
    }

    /// C_AA⁻¹ 1, m.
    pub fn unit(&self) -> &[f64] {
        &self.unit[..self.nodes.len()]
    }

    /// Nodes that it has followed since it was computed.
    pub fn followed(&self) -> usize {
        self.followed
    }

    /// Makes the inverse that of the `active` nodes, ascending: from that before one of them came or went, or anew. Returns the multiplications
    /// and additions that it took.
    ///
    /// # Errors
    /// [`Error::SingularContactMatrix`].
    pub fn follow(&mut self, compliance: &DMatrix<f64>, active: &[usize]) -> Result<usize> {
        let (m, before) = (active.len(), self.nodes.len());
        let differs = active.iter().zip(&self.nodes).position(|(a, b)| a != b);
        let place = differs.unwrap_or(m.min(before));
        let follows = self.followed < LARGEST_FOLLOWED
            && if m == before + 1 {
                active[place + 1..] == self.nodes[place..] && self.insert(compliance, active[place], place)
            } else if before == m + 1 {
                active[place..] == self.nodes[place + 1..] && self.remove(place)
            } else {
                m == before && differs.is_none()
            };
        if follows {
            return Ok(4 * m * m);
        }
        self.compute(compliance, active)?;
        Ok(work(m))
    }

    /// Takes a node into the inverse, by the Schur complement of its row. False where that is too small to divide by.
    fn insert(&mut self, compliance: &DMatrix<f64>, node: usize, place: usize) -> bool {
        let k = self.nodes.len();
        for (gathered, &i) in self.gathered.iter_mut().zip(&self.nodes) {
            *gathered = compliance[(i, node)];
        }
        // C_AA⁻¹ times the column, and the row times C_AA⁻¹.
        dense::multiply(&self.values, k, &self.gathered, &mut self.column);
        let (mut complement, mut size) = (compliance[(node, node)], compliance[(node, node)].abs());
        for (column, &i) in self.column[..k].iter().zip(&self.nodes) {
            complement -= compliance[(node, i)] * column;
            size += (compliance[(node, i)] * column).abs();
        }
        for (gathered, &i) in self.gathered.iter_mut().zip(&self.nodes) {
            *gathered = compliance[(node, i)];
        }
        for (row, column) in self.row.iter_mut().zip(self.values[..k * k].chunks_exact(k.max(1))) {
            *row = dense::dot(&self.gathered[..k], column);
        }
        if complement.abs() <= LEAST_PIVOT * size {
            return false;
        }
        // From the last column on, so that nothing is overwritten that is still needed.
        for new in (0..=k).rev() {
            let old = match new.cmp(&place) {
                Ordering::Less => Some(new),
                Ordering::Equal => None,
                Ordering::Greater => Some(new - 1),
            };
            let by_row = old.map_or(-1.0, |old| self.row[old]) / complement;
            for new_row in (0..=k).rev() {
                let old_row = match new_row.cmp(&place) {
                    Ordering::Less => Some(new_row),
                    Ordering::Equal => None,
                    Ordering::Greater => Some(new_row - 1),
                };
                let kept = match (old, old_row) {
                    (Some(old), Some(old_row)) => self.values[old * k + old_row],
                    _ => 0.0,
                };
                let by_column = old_row.map_or(-1.0, |old_row| self.column[old_row]);
                self.values[new * (k + 1) + new_row] = kept + by_column * by_row;
            }
        }
        self.end_following(place, Some(node));
        true
    }

    /// Takes a node out of the inverse. False where its pivot is too small to divide by.
    fn remove(&mut self, place: usize) -> bool {
        let k = self.nodes.len();
        let pivot = self.values[place * k + place];
        let own = &self.values[place * k..][..k];
        if pivot.abs() <= LEAST_PIVOT * dense::largest(own) {
            return false;
        }
        self.column[..k].copy_from_slice(own);
        for (row, column) in self.row.iter_mut().zip(self.values[..k * k].chunks_exact(k)) {
            *row = column[place];
        }
        let others = || (0..k).filter(move |&other| other != place);
        for (new, old) in others().enumerate() {
            for (new_row, old_row) in others().enumerate() {
                self.values[new * (k - 1) + new_row] =
                    self.values[old * k + old_row] - self.column[old_row] * self.row[old] / pivot;
            }
        }
        self.end_following(place, None);
        true
    }

    /// Brings what depends on the inverse up to date after a node has come to its place, or gone from it.
    fn end_following(&mut self, place: usize, node: Option<usize>) {
        match node {
            Some(node) => self.nodes.insert(place, node),
            None => _ = self.nodes.remove(place),
        }
        self.followed += 1;
        let m = self.nodes.len();
        self.gathered[..m].fill(1.0);
        dense::multiply(&self.values, m, &self.gathered, &mut self.unit);
    }

    /// Computes C_AA⁻¹ and C_AA⁻¹ 1 of the `active` nodes anew.
    ///
    /// The inverse itself, not only its factors: it is applied several times for each change of the active set, and in a
    /// product no row waits for another as in a triangular solve. With a condition number of about n no accuracy is lost. By LU, because the wear of the step makes the matrix unsymmetric.
    ///
    /// # Errors
    /// [`Error::SingularContactMatrix`].
    pub fn compute(&mut self, compliance: &DMatrix<f64>, active: &[usize]) -> Result<()> {
        let m = active.len();
        self.nodes.clear();
        self.followed = 0;
        for (column, &j) in active.iter().enumerate() {
            for (row, &i) in active.iter().enumerate() {
                self.factor[column * m + row] = compliance[(i, j)];
            }
        }
        if !dense::lu(&mut self.factor[..m * m], m, &mut self.pivots) {
            return Err(Error::SingularContactMatrix {
                matrix: "normal compliance",
                unknowns: m,
            });
        }
        for (column, unit) in self.values[..m * m].chunks_exact_mut(m.max(1)).enumerate() {
            unit.fill(0.0);
            unit[column] = 1.0;
            dense::lu_solve(&self.factor, m, &self.pivots, unit);
        }
        self.unit[..m].fill(1.0);
        dense::lu_solve(&self.factor, m, &self.pivots, &mut self.unit[..m]);
        self.nodes.extend_from_slice(active);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// Nodes that come and go one at a time leave the inverse of those that are there, also of a matrix that is not symmetric.
        #[test]
        fn the_inverse_follows_its_nodes(
            entries in prop::collection::vec(-1.0..1.0, 144),
            moves in prop::collection::vec(0..12_usize, 40),
        ) {
            const NODES: usize = 12;
            let compliance: DMatrix<f64> = DMatrix::from_vec(NODES, NODES, entries) + DMatrix::identity(NODES, NODES) * 12.0;
            let mut inverse = ActiveInverse::new(NODES);
            let (mut active, mut followed) = (Vec::<usize>::new(), 0);
            for node in moves {
                match active.binary_search(&node) {
                    Ok(place) => _ = active.remove(place),
                    Err(place) => active.insert(place, node),
                }
                inverse.follow(&compliance, &active).unwrap();
                followed = inverse.followed().max(followed);
                let (values, unit) = (inverse.values(), inverse.unit());
                let m = unit.len();
                prop_assert_eq!(inverse.nodes(), &active[..]);
                for (row, &i) in active.iter().enumerate() {
                    for column in 0..m {
                        let sum: f64 = (0..m).map(|k| compliance[(i, active[k])] * values[column * m + k]).sum();
                        let unity = if row == column { 1.0 } else { 0.0 };
                        // Condition numbers below 10, and round-off of 32 changes.
                        prop_assert!((sum - unity).abs() < 1e-12, "{row} {column}: {sum}");
                    }
                    let sum: f64 = (0..m).map(|k| values[k * m + row]).sum();
                    prop_assert!((sum - unit[row]).abs() < 1e-12);
                }
            }
            prop_assert_eq!(followed, LARGEST_FOLLOWED);
        }
    }
}
