//! Thermal displacement of the contact nodes from the temperature field, compressed.
//!
//! The exact map is dense: 2n rows by all nodes of the mesh, memory-bound in a step. But the displacement is smooth in
//! the depth of its cause, so that per column a few weighted integrals over the depth ("moments") carry it, and all
//! but the first of them act close to their column only. The weights are common to all columns: the leading right
//! singular vectors of the map over the profiles that a heated surface can make (`heated_profiles`). Of every
//! moment of a column only the rows are kept where it matters.

use crate::compliance::ThermalDisplacement;
use crate::dense;
use crate::heat::DepthBasis;
use crate::mesh::Mesh;
use nalgebra::{Cholesky, DMatrix, SymmetricEigen};
use std::ops::Range;

/// Error of the compressed map relative to the largest displacement of a heated profile.
pub const TOLERANCE: f64 = 1e-4;

/// One moment of one column: the rows on which it acts and where their gains are stored.
#[derive(Debug, Clone)]
struct Block {
    rows: Range<usize>,
    start: usize,
}

/// Maps modal amplitudes (columns × modes) to the 2n scaled displacements, along x₁ first.
#[derive(Debug, Clone)]
pub struct ThermalMap {
    /// Weights of the moments, moment by moment, moments × modes.
    weights: Vec<f64>,
    modes: usize,
    /// Per column and moment the rows along x₁ and along x₂ on which it acts.
    columns: Vec<Vec<[Block; 2]>>,
    gains: Vec<f64>,
}

/// Modal amplitudes under a surface flux that lasts for 1/rate: φ(0)/(rate + κλ), over all rates from seconds to
/// microseconds that contacts between walking pace and 150 m/s make, and slower ones for rests. Modes × profiles.
fn heated_profiles(basis: &DepthBasis, diffusivity: f64) -> DMatrix<f64> {
    const PER_DECADE: usize = 4;
    const DECADES: usize = 10;
    DMatrix::from_fn(basis.len(), PER_DECADE * DECADES + 1, |mode, profile| {
        let rate = 1e-4 * 10.0_f64.powf(profile as f64 / PER_DECADE as f64);
        basis.surface[mode] / (rate + diffusivity * basis.eigenvalues[mode])
    })
}

impl ThermalMap {
    /// Compresses the exact map to the given tolerance.
    ///
    /// # Errors
    /// None; a map that cannot be compressed is kept whole.
    pub fn new(
        mesh: &Mesh,
        basis: &DepthBasis,
        exact: &ThermalDisplacement,
        diffusivity: f64,
        tolerance: f64,
    ) -> ThermalMap {
        let (rows, m, n) = (mesh.rows(), basis.len(), exact.nrows() / 2);
        let per_column: Vec<DMatrix<f64>> = (0..mesh.columns())
            .map(|column| exact.columns(column * rows, rows) * &basis.modes)
            .collect();
        // Each profile counts by the displacement that it makes in the middle of the window.
        let middle = &per_column[mesh.contact_column(mesh.contact_nodes / 2)];
        let mut profiles = heated_profiles(basis, diffusivity);
        for mut profile in profiles.column_iter_mut() {
            let size = (middle * &profile).amax();
            profile /= if size > 0.0 { size } else { 1.0 };
        }
        // S Sᵀ = profiles · profilesᵀ, with a floor that keeps every mode.
        let mut gram = &profiles * profiles.transpose();
        for mode in 0..m {
            gram[(mode, mode)] *= 1.0 + 1e-12;
        }
        let root = match Cholesky::new(gram) {
            Some(cholesky) => cholesky.l(),
            None => DMatrix::identity(m, m),
        };
        let weighted: Vec<DMatrix<f64>> = per_column.iter().map(|block| block * &root).collect();
        let mut gram = DMatrix::zeros(m, m);
        for block in &weighted {
            gram.gemm_tr(1.0, block, block, 1.0);
        }
        let eigen = SymmetricEigen::new(gram);
        let mut order: Vec<usize> = (0..m).collect();
        order.sort_by(|&a, &b| eigen.eigenvalues[b].total_cmp(&eigen.eigenvalues[a]));
        let vectors = DMatrix::from_fn(m, m, |i, k| eigen.eigenvectors[(i, order[k])]);
        // Moments are wᵀ a with w = S⁻ᵀ v: of unit size over the profiles.
        let weights = root
            .transpose()
            .solve_upper_triangular(&vectors)
            .unwrap_or_else(|| vectors.clone());

        let mut map = ThermalMap {
            weights: weights.as_slice().to_vec(),
            modes: m,
            columns: Vec::with_capacity(mesh.columns()),
            gains: Vec::new(),
        };
        for block in &weighted {
            let image = block * &vectors;
            let mut moments = Vec::new();
            let mut last = 0;
            for k in 0..m {
                let column = image.column(k);
                let mut keep = |offset: usize| {
                    let values = &column.as_slice()[offset..offset + n];
                    let matters = |v: &f64| v.abs() > tolerance;
                    let first = values.iter().position(matters);
                    let end = values.iter().rposition(matters);
                    let range = match (first, end) {
                        (Some(first), Some(end)) => first..end + 1,
                        _ => 0..0,
                    };
                    let start = map.gains.len();
                    map.gains.extend_from_slice(&values[range.clone()]);
                    Block {
                        rows: offset + range.start..offset + range.end,
                        start,
                    }
                };
                let blocks = [keep(0), keep(n)];
                if blocks.iter().any(|b| !b.rows.is_empty()) {
                    last = k + 1;
                }
                moments.push(blocks);
            }
            moments.truncate(last);
            map.columns.push(moments);
        }
        let moments = map.columns.iter().map(Vec::len).max().unwrap_or(0);
        map.weights.truncate(moments * m);
        map
    }

    /// Number of moments over all columns, and of gains.
    pub fn size(&self) -> (usize, usize) {
        (self.columns.iter().map(Vec::len).sum(), self.gains.len())
    }

    /// The displacement of the field into `displacement` (2n).
    pub fn apply(&self, amplitudes: &[f64], displacement: &mut [f64]) {
        dense::vectorised(
            #[inline(always)]
            || {
                displacement.fill(0.0);
                for (column, moments) in amplitudes.chunks_exact(self.modes).zip(&self.columns) {
                    // Rail that has not been heated since it entered.
                    if column[0] == 0.0 {
                        continue;
                    }
                    for (blocks, weights) in moments.iter().zip(self.weights.chunks_exact(self.modes)) {
                        let moment = dense::dot(column, weights);
                        for Block { rows, start } in blocks {
                            let gains = &self.gains[*start..start + rows.len()];
                            dense::add_multiple(gains, moment, &mut displacement[rows.clone()]);
                        }
                    }
                }
            },
        );
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
