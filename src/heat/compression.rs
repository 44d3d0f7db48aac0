//! Compression of the map from temperature to displacement: the two steps that [`super::thermal_map`] describes.

use super::basis::DepthBasis;
use crate::body::compliance::ThermalDisplacement;
use crate::body::mesh::Mesh;
use crate::numerics::dense::{self, LANES};
use nalgebra::{Cholesky, DMatrix, SymmetricEigen};
use std::ops::Range;

/// Nodes within so many node spacings of a block are next to it.
const NEAR: f64 = 4.0;

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

/// Moments of a column and the displacement that they make.
pub struct Moments {
    /// Modes × moments.
    pub weights: DMatrix<f64>,
    /// Per column, 2n × moments.
    pub images: Vec<DMatrix<f64>>,
}

impl Moments {
    /// The moments of the exact map that matter at the given tolerance.
    pub fn new(
        mesh: &Mesh,
        basis: &DepthBasis,
        exact: &ThermalDisplacement,
        diffusivity: f64,
        tolerance: f64,
    ) -> Moments {
        let (rows, m) = (mesh.rows(), basis.len());
        let of_column = |column: usize| exact.rows(column * rows, rows).transpose();
        // Each profile counts by the displacement that it makes in the middle of the window.
        let middle = of_column(mesh.contact_column(mesh.contact_nodes / 2)) * &basis.modes;
        let mut profiles = heated_profiles(basis, diffusivity);
        for mut profile in profiles.column_iter_mut() {
            let size = (&middle * &profile).amax();
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
        // Singular vectors of the map after modes · S: all columns of the mesh one above the other.
        let mut gram = DMatrix::zeros(rows, rows);
        for column in 0..mesh.columns() {
            let block = of_column(column);
            gram.gemm(1.0, &block.transpose(), &block, 1.0);
        }
        let scaled = &basis.modes * &root;
        let eigen = SymmetricEigen::new(scaled.transpose() * gram * &scaled);
        let mut order: Vec<usize> = (0..m).collect();
        order.sort_by(|&a, &b| eigen.eigenvalues[b].total_cmp(&eigen.eigenvalues[a]));
        // A singular value bounds every displacement of its vector.
        let candidates = order
            .iter()
            .filter(|&&k| eigen.eigenvalues[k] > tolerance * tolerance)
            .count();
        let vectors = DMatrix::from_fn(m, candidates, |i, k| eigen.eigenvectors[(i, order[k])]);
        // Moments are wᵀ a with w = S⁻ᵀ v: of unit size over the profiles.
        let weights = root
            .transpose()
            .solve_upper_triangular(&vectors)
            .unwrap_or_else(|| vectors.clone());
        let per_moment = scaled * &vectors;
        let images: Vec<DMatrix<f64>> = (0..mesh.columns())
            .map(|column| of_column(column) * &per_moment)
            .collect();
        let matters = |&moment: &usize| images.iter().any(|image| image.column(moment).amax() > tolerance);
        let used = (0..candidates).rev().find(matters).map_or(0, |last| last + 1);
        // The moments are padded with zeros to a multiple of LANES.
        let padded = used.next_multiple_of(LANES);
        let pad = |matrix: DMatrix<f64>| matrix.resize_horizontally(used, 0.0).resize_horizontally(padded, 0.0);
        Moments {
            weights: pad(weights),
            images: images.into_iter().map(pad).collect(),
        }
    }

    /// The displacement that the columns' moments make, row by row: 2n × (columns · moments).
    fn rows(&self, columns: Range<usize>) -> Vec<f64> {
        let (displacements, moments) = self.images[0].shape();
        let mut rows = Vec::with_capacity(displacements * columns.len() * moments);
        for row in 0..displacements {
            for image in &self.images[columns.clone()] {
                rows.extend(image.row(row).iter());
            }
        }
        rows
    }
}

/// Splits off from the `rows` (each of `inputs` values) their components along a few orthonormal combinations, until the
/// remainder of the rows that are `far` is below the tolerance: Gram and Schmidt's method, pivoting on the largest row.
/// Returns the combinations and, one after the other, the components of all rows along them.
fn split_off(rows: &mut [f64], inputs: usize, far: impl Fn(usize) -> bool, tolerance: f64) -> (Vec<f64>, Vec<f64>) {
    let (mut combinations, mut parts) = (Vec::new(), Vec::new());
    for _ in 0..inputs {
        let far_rows = || {
            rows.chunks_exact(inputs)
                .enumerate()
                .filter(|(row, _)| far(*row))
                .map(|(_, r)| r)
        };
        if far_rows().all(|row| dense::largest(row) <= tolerance) {
            break;
        }
        let pivot = far_rows().max_by(|a, b| dense::dot(a, a).total_cmp(&dense::dot(b, b)));
        let mut direction = pivot.unwrap_or_default().to_vec();
        let length = dense::dot(&direction, &direction).sqrt();
        direction.iter_mut().for_each(|value| *value /= length);
        dense::vectorised(
            #[inline(always)]
            |fma| {
                for row in rows.chunks_exact_mut(inputs) {
                    let part = fma.dot(row, &direction);
                    fma.add_multiple(&direction, -part, row);
                    parts.push(part);
                }
            },
        );
        combinations.extend(direction);
    }
    (combinations, parts)
}

/// Response to a block of neighbouring columns: its part of the map.
pub struct BlockResponse {
    /// The columns.
    pub columns: Range<usize>,
    /// Contact nodes next to it.
    pub near: Range<usize>,
    /// Far moments per moment of the columns, row by row.
    pub combinations: Vec<f64>,
    /// Displacement per far moment, one far moment after the other, 2n each.
    pub far_response: Vec<f64>,
    /// Displacement of the near nodes per moment, less that by the far moments; along x₁, then along x₂, row by row.
    pub near_response: Vec<f64>,
}

impl BlockResponse {
    fn new(moments: &Moments, columns: Range<usize>, near: Range<usize>, tolerance: f64) -> BlockResponse {
        let (n, inputs) = (moments.images[0].nrows() / 2, columns.len() * moments.images[0].ncols());
        let mut rows = moments.rows(columns.clone());
        let (combinations, far_response) = split_off(&mut rows, inputs, |row| !near.contains(&(row % n)), tolerance);
        let next_to = |first: usize| &rows[(first + near.start) * inputs..(first + near.end) * inputs];
        let near_response = [next_to(0), next_to(n)].concat();
        BlockResponse {
            columns,
            near,
            combinations,
            far_response,
            near_response,
        }
    }

    /// The mirror image in x₁ = 0 on a mesh of so many columns, with n contact nodes and so many moments a column: u₁
    /// changes its sign.
    fn mirrored(&self, mesh_columns: usize, n: usize, moments: usize) -> BlockResponse {
        let opposite = |range: &Range<usize>, count: usize| count - range.end..count - range.start;
        // Values at nodes or columns, `size` each, in opposite order.
        let reversed =
            |values: &[f64], size: usize| values.rchunks_exact(size).flatten().copied().collect::<Vec<f64>>();
        let inputs = self.columns.len() * moments;
        let opposite_inputs = |rows: &[f64]| -> Vec<f64> {
            rows.chunks_exact(inputs)
                .flat_map(|row| reversed(row, moments))
                .collect()
        };
        let opposite_nodes = |along_and_upward: &[f64], size: usize| -> Vec<f64> {
            let (along, upward) = along_and_upward.split_at(along_and_upward.len() / 2);
            let along: Vec<f64> = along.iter().map(|value| -value).collect();
            [reversed(&along, size), reversed(upward, size)].concat()
        };
        BlockResponse {
            columns: opposite(&self.columns, mesh_columns),
            near: opposite(&self.near, n),
            combinations: opposite_inputs(&self.combinations),
            far_response: self
                .far_response
                .chunks_exact(2 * n)
                .flat_map(|part| opposite_nodes(part, 1))
                .collect(),
            near_response: opposite_nodes(&opposite_inputs(&self.near_response), inputs),
        }
    }
}

/// Blocks of √n columns from the middle to the left, their mirror images, and between them the middle column, if there is
/// one: mirrored motion is to give mirrored fields to round-off.
pub fn block_responses(mesh: &Mesh, moments: &Moments, tolerance: f64) -> Vec<BlockResponse> {
    let (n, columns) = (mesh.contact_nodes, mesh.columns());
    let width = (n as f64).sqrt().round() as usize;
    let half = columns / 2;
    let mut left: Vec<BlockResponse> = (0..half)
        .step_by(width)
        .map(|distance| {
            let own = half.saturating_sub(distance + width)..half - distance;
            let reach = NEAR * mesh.contact_spacing();
            let (from, to) = (mesh.x[own.start] - reach, mesh.x[own.end - 1] + reach);
            let is_near = |node: &usize| (from..=to).contains(&mesh.contact_position(*node));
            let near = match ((0..n).find(is_near), (0..n).rfind(is_near)) {
                (Some(first), Some(last)) => first..last + 1,
                _ => 0..0,
            };
            BlockResponse::new(moments, own, near, tolerance)
        })
        .collect();
    let right: Vec<BlockResponse> = left
        .iter()
        .map(|block| block.mirrored(columns, n, moments.images[0].ncols()))
        .collect();
    left.reverse();
    // The middle column is its own mirror image; it is one column, so all its responses are kept (all nodes count as near).
    let middle = (columns % 2 == 1).then(|| BlockResponse::new(moments, half..half + 1, 0..n, tolerance));
    left.into_iter().chain(middle).chain(right).collect()
}
