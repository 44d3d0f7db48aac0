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

/// Error of the compressed map relative to the largest displacement of a heated profile.
pub const TOLERANCE: f64 = 1e-3;

/// Moments that are summed together, one vector register of AVX2.
const LANES: usize = 4;

/// Maps modal amplitudes (columns × modes) to the 2n scaled displacements, along x₁ first.
#[derive(Debug, Clone)]
pub struct ThermalMap {
    modes: usize,
    /// Number of moments of a column, padded to [`LANES`].
    moments: usize,
    /// Weights of the moments: per [`LANES`] moments and mode the weights of those moments.
    weights: Vec<[f64; LANES]>,
    /// Gains row by row, 2n × (columns × moments). Single precision, 6e-8, is far below the tolerance, and halves the
    /// memory that an application streams through.
    gains: Vec<f32>,
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

        let images: Vec<DMatrix<f64>> = weighted.iter().map(|block| block * &vectors).collect();
        let matters = |&moment: &usize| images.iter().any(|image| image.column(moment).amax() > tolerance);
        let used = (0..m).rev().find(matters).map_or(0, |last| last + 1);
        let moments = used.next_multiple_of(LANES);
        // Padding has no weight and no gain.
        let entry =
            |matrix: &DMatrix<f64>, row: usize, moment: usize| if moment < used { matrix[(row, moment)] } else { 0.0 };
        let mut packed = Vec::with_capacity(m * moments / LANES);
        for first in (0..moments).step_by(LANES) {
            packed.extend((0..m).map(|mode| std::array::from_fn(|lane| entry(&weights, mode, first + lane))));
        }
        let mut gains = Vec::with_capacity(2 * n * images.len() * moments);
        for row in 0..2 * n {
            for image in &images {
                gains.extend((0..moments).map(|moment| entry(image, row, moment) as f32));
            }
        }
        ThermalMap {
            modes: m,
            moments,
            weights: packed,
            gains,
        }
    }

    /// Numbers of moments a column and of gains.
    pub fn size(&self) -> (usize, usize) {
        (self.moments, self.gains.len())
    }

    /// The displacement of the field into `displacement` (2n), by way of the moments of its columns (columns × moments).
    pub fn apply(&self, amplitudes: &[f64], moments: &mut [f64], displacement: &mut [f64]) {
        // A rail that does not expand.
        if self.moments == 0 {
            displacement.fill(0.0);
            return;
        }
        // Upstream, the rail has not been heated since it entered.
        let warm = |column: &[f64]| column[0] != 0.0;
        let mut columns = amplitudes.chunks_exact(self.modes);
        let count = columns.len();
        let (Some(first), Some(last)) = (columns.clone().position(warm), columns.rposition(warm)) else {
            displacement.fill(0.0);
            return;
        };
        let moments = &mut moments[..(last + 1 - first) * self.moments];
        dense::vectorised(
            #[inline(always)]
            || {
                for (column, moments) in amplitudes[first * self.modes..]
                    .chunks_exact(self.modes)
                    .zip(moments.chunks_exact_mut(self.moments))
                {
                    self.column_moments(column, moments);
                }
                let row = count * self.moments;
                for (rows, displacement) in self.gains.chunks_exact(2 * row).zip(displacement.chunks_exact_mut(2)) {
                    let (one, two) = rows.split_at(row);
                    let (one, two) = (&one[first * self.moments..], &two[first * self.moments..]);
                    displacement.copy_from_slice(&dot_pair(one, two, moments));
                }
            },
        );
    }

    /// Values that [`ThermalMap::apply`] needs for the moments of so many columns.
    pub fn scratch_len(&self, columns: usize) -> usize {
        columns * self.moments
    }

    #[inline(always)]
    fn column_moments(&self, column: &[f64], moments: &mut [f64]) {
        for (moments, weights) in moments
            .chunks_exact_mut(LANES)
            .zip(self.weights.chunks_exact(self.modes))
        {
            let mut sums = [0.0; LANES];
            for (amplitude, weights) in column.iter().zip(weights) {
                for lane in 0..LANES {
                    sums[lane] += amplitude * weights[lane];
                }
            }
            moments.copy_from_slice(&sums);
        }
    }
}

/// Σ x z and Σ y z as [`dense::dot`], with x and y in single precision: z is loaded once for two rows.
#[inline(always)]
fn dot_pair(x: &[f32], y: &[f32], z: &[f64]) -> [f64; 2] {
    const SUMS: usize = 8;
    let (mut x_sums, mut y_sums) = ([0.0; SUMS], [0.0; SUMS]);
    let whole = z.len() - z.len() % SUMS;
    for ((x, y), z) in x[..whole]
        .chunks_exact(SUMS)
        .zip(y[..whole].chunks_exact(SUMS))
        .zip(z[..whole].chunks_exact(SUMS))
    {
        for lane in 0..SUMS {
            x_sums[lane] += f64::from(x[lane]) * z[lane];
            y_sums[lane] += f64::from(y[lane]) * z[lane];
        }
    }
    let finish = |sums: [f64; SUMS], x: &[f32]| {
        let tail: f64 = x[whole..].iter().zip(&z[whole..]).map(|(x, z)| f64::from(*x) * z).sum();
        tail + sums.iter().sum::<f64>()
    };
    [finish(x_sums, x), finish(y_sums, y)]
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
