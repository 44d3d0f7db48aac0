//! Thermal displacement of the contact nodes from the temperature field, compressed.
//!
//! The exact map is dense: 2n rows by all nodes of the mesh, memory-bound in a step. But the displacement is smooth in
//! the depth of its cause, so that per column a few weighted integrals over the depth ("moments") carry it. The
//! weights are common to all columns: the leading eigenvectors of the map's Gram matrix in the modal basis of
//! [`DepthBasis`]. Each column keeps as many of them as the tolerance asks for.

use crate::compliance::ThermalDisplacement;
use crate::dense;
use crate::heat::DepthBasis;
use crate::mesh::Mesh;
use nalgebra::{DMatrix, SymmetricEigen};

/// Dropped share of the displacement, relative to the largest column's, for fields of bounded modal energy.
pub const TOLERANCE: f64 = 1e-9;

/// Maps modal amplitudes (columns × modes) to the 2n scaled displacements, along x₁ first.
#[derive(Debug, Clone)]
pub struct ThermalMap {
    /// Weights of the moments, modes × moments.
    weights: DMatrix<f64>,
    /// Per column: its first column in `gains` and the number of its moments.
    blocks: Vec<(usize, usize)>,
    /// Displacement per moment, 2n × (all columns' moments).
    gains: DMatrix<f64>,
}

impl ThermalMap {
    /// Compresses the exact map.
    pub fn new(mesh: &Mesh, basis: &DepthBasis, exact: &ThermalDisplacement) -> ThermalMap {
        let (rows, m) = (mesh.rows(), basis.len());
        // Amplitudes of a heated column: a surface flux excites mode k in proportion to φ_k(0) / (rate + κ λ_k), at
        // most by φ_k(0) / λ_k^½ relative to the others over all rates; the map is weighted with that.
        let size: Vec<f64> = (0..m)
            .map(|k| basis.surface[k].abs() / (basis.eigenvalues[k] + basis.eigenvalues[0]).sqrt())
            .collect();
        let per_column: Vec<DMatrix<f64>> = (0..mesh.columns())
            .map(|column| {
                let mut block = exact.columns(column * rows, rows) * &basis.modes;
                for (mode, mut values) in block.column_iter_mut().enumerate() {
                    values *= size[mode];
                }
                block
            })
            .collect();
        let mut gram = DMatrix::zeros(m, m);
        for block in &per_column {
            gram += block.transpose() * block;
        }
        let eigen = SymmetricEigen::new(gram);
        let mut order: Vec<usize> = (0..m).collect();
        order.sort_by(|&a, &b| eigen.eigenvalues[b].total_cmp(&eigen.eigenvalues[a]));
        let vectors = DMatrix::from_fn(m, m, |i, k| eigen.eigenvectors[(i, order[k])]);

        let images: Vec<DMatrix<f64>> = per_column.iter().map(|block| block * &vectors).collect();
        let largest = images.iter().map(|i| i.norm()).fold(0.0, f64::max);
        let kept: Vec<usize> = images
            .iter()
            .map(|image| {
                // Keep the moments up to the last one whose tail matters.
                let mut tail = 0.0;
                let mut kept = m;
                while kept > 0 {
                    tail += image.column(kept - 1).norm_squared();
                    if tail.sqrt() > TOLERANCE * largest {
                        break;
                    }
                    kept -= 1;
                }
                kept
            })
            .collect();
        let moments = kept.iter().copied().max().unwrap_or(0);
        let mut blocks = Vec::with_capacity(kept.len());
        let mut gains = DMatrix::zeros(exact.nrows(), kept.iter().sum());
        let mut start = 0;
        for (image, &kept) in images.iter().zip(&kept) {
            gains.columns_mut(start, kept).copy_from(&image.columns(0, kept));
            blocks.push((start, kept));
            start += kept;
        }
        ThermalMap {
            weights: DMatrix::from_fn(m, moments, |mode, k| vectors[(mode, k)] / size[mode]),
            blocks,
            gains,
        }
    }

    /// Number of moments over all columns.
    pub fn moments(&self) -> usize {
        self.gains.ncols()
    }

    /// The displacement of the field into `displacement` (2n).
    pub fn apply(&self, amplitudes: &[f64], displacement: &mut [f64]) {
        let m = self.weights.nrows();
        displacement.fill(0.0);
        for (column, &(start, kept)) in amplitudes.chunks_exact(m).zip(&self.blocks) {
            for k in 0..kept {
                let weights = &self.weights.as_slice()[k * m..(k + 1) * m];
                let moment: f64 = column.iter().zip(weights).map(|(a, w)| a * w).sum();
                if moment != 0.0 {
                    let rows = self.gains.nrows();
                    let gain = &self.gains.as_slice()[(start + k) * rows..(start + k + 1) * rows];
                    for (u, g) in displacement.iter_mut().zip(gain) {
                        *u += g * moment;
                    }
                }
            }
        }
    }
}

/// The displacement of the field by the exact map, for comparison: 2n values.
pub fn exact_displacement(
    mesh: &Mesh,
    basis: &DepthBasis,
    exact: &ThermalDisplacement,
    amplitudes: &[f64],
) -> Vec<f64> {
    let mut temperature = vec![0.0; mesh.nodes()];
    for (column, a) in amplitudes.chunks_exact(basis.len()).enumerate() {
        for row in 0..mesh.rows() {
            temperature[mesh.node(column, row)] = basis.value(a, row);
        }
    }
    let mut displacement = vec![0.0; exact.nrows()];
    dense::multiply_add(exact, &temperature, 1.0, &mut displacement);
    displacement
}
