//! Thermal displacement of the contact nodes from the temperature field, compressed.
//!
//! The exact map is dense: 2n rows by all nodes of the mesh, memory-bound in a step. Two compressions make it small:
//!
//! 1. Over the depth. The displacement is smooth in the depth of its cause, so that per column a few weighted integrals
//!    ("moments") carry it. The weights are common to all columns: the leading right singular vectors of the map over the
//!    profiles that a heated surface can make (`heated_profiles`).
//! 2. Along the rail. The displacement is smooth also in the place of its cause, but for the nodes next to it. Columns are
//!    taken in blocks of √n; far from a block, a few combinations of its moments carry their effect ("effects"). Next to
//!    the block what these leave is added from the moments themselves.

use crate::body::compliance::ThermalDisplacement;
use crate::body::mesh::Mesh;
use crate::heat::basis::DepthBasis;
use crate::numerics::dense::{self, Arithmetic, LANES};
use nalgebra::{Cholesky, DMatrix, DVector, SymmetricEigen};
use std::ops::Range;

/// Error of the compressed map relative to the largest displacement of a heated profile.
pub const TOLERANCE: f64 = 1e-4;

/// Nodes within so many node spacings of a block are next to it.
const NEAR: f64 = 4.0;

/// Maps modal amplitudes (columns × modes) to the 2n scaled displacements, along x₁ first.
#[derive(Debug, Clone)]
pub struct ThermalMap {
    modes: usize,
    /// Number of moments of a column, a multiple of [`LANES`]: the partial sums of a product.
    moments: usize,
    /// Number of effects of all blocks, padded to [`LANES`].
    effects: usize,
    /// Weights of the moments: per [`LANES`] moments and mode the weights of those moments.
    weights: Vec<[f64; LANES]>,
    blocks: Vec<Block>,
    /// Displacement per effect, row by row, 2n × effects. Gains are in single precision: 6e-8 is far below the tolerance,
    /// and it halves the memory that an application streams through.
    far: Vec<f32>,
}

/// Neighbouring columns and what their temperature does.
#[derive(Debug, Clone)]
struct Block {
    columns: Range<usize>,
    /// Its effects among all.
    effects: Range<usize>,
    /// Effects per moment of the columns, row by row.
    combinations: Vec<f32>,
    /// Contact nodes next to the block.
    near: Range<usize>,
    /// Their displacement per moment of the columns, less that of the effects; along x₁, then along x₂, row by row.
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

/// Moments of a column and the displacement that they make.
struct Moments {
    /// Modes × moments.
    weights: DMatrix<f64>,
    /// Per column, 2n × moments.
    images: Vec<DMatrix<f64>>,
}

impl Moments {
    fn new(mesh: &Mesh, basis: &DepthBasis, exact: &ThermalDisplacement, diffusivity: f64, tolerance: f64) -> Moments {
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
        // Padding has no weight and no gain.
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

/// Takes from the `rows` (each of `inputs` values) their parts along a few orthonormal combinations, until what is left of
/// those in question is below the tolerance: Gram and Schmidt's method on the row that is largest. Returns the
/// combinations and, one after the other, the parts of all rows along them.
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
            |arithmetic| {
                for row in rows.chunks_exact_mut(inputs) {
                    let part = arithmetic.dot(row, &direction);
                    arithmetic.add_multiple(&direction, -part, row);
                    parts.push(part);
                }
            },
        );
        combinations.extend(direction);
    }
    (combinations, parts)
}

fn single(values: &[f64]) -> Vec<f32> {
    values.iter().map(|&value| value as f32).collect()
}

/// What becomes a [`Block`].
struct Piece {
    columns: Range<usize>,
    near: Range<usize>,
    /// Effects per moment, row by row.
    combinations: Vec<f64>,
    /// Displacement per effect, effect by effect, 2n each.
    parts: Vec<f64>,
    /// As those of [`Block`].
    gains: Vec<f64>,
}

impl Piece {
    fn new(moments: &Moments, columns: Range<usize>, near: Range<usize>, tolerance: f64) -> Piece {
        let (n, inputs) = (moments.images[0].nrows() / 2, columns.len() * moments.images[0].ncols());
        let mut rows = moments.rows(columns.clone());
        let (combinations, parts) = split_off(&mut rows, inputs, |row| !near.contains(&(row % n)), tolerance);
        let next_to = |first: usize| &rows[(first + near.start) * inputs..(first + near.end) * inputs];
        let gains = [next_to(0), next_to(n)].concat();
        Piece {
            columns,
            near,
            combinations,
            parts,
            gains,
        }
    }

    /// The mirror image in x₁ = 0 on a mesh of so many columns, with n contact nodes and so many moments a column: u₁
    /// changes its sign.
    fn mirrored(&self, mesh_columns: usize, n: usize, moments: usize) -> Piece {
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
        Piece {
            columns: opposite(&self.columns, mesh_columns),
            near: opposite(&self.near, n),
            combinations: opposite_inputs(&self.combinations),
            parts: self
                .parts
                .chunks_exact(2 * n)
                .flat_map(|part| opposite_nodes(part, 1))
                .collect(),
            gains: opposite_nodes(&opposite_inputs(&self.gains), inputs),
        }
    }
}

/// Blocks of √n columns from the middle to the left, their mirror images, and between them the middle column, if there is
/// one: mirrored motion is to give mirrored fields to round-off.
fn pieces(mesh: &Mesh, moments: &Moments, tolerance: f64) -> Vec<Piece> {
    let (n, columns) = (mesh.contact_nodes, mesh.columns());
    let width = (n as f64).sqrt().round() as usize;
    let half = columns / 2;
    let mut left: Vec<Piece> = (0..half)
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
            Piece::new(moments, own, near, tolerance)
        })
        .collect();
    let right: Vec<Piece> = left
        .iter()
        .map(|piece| piece.mirrored(columns, n, moments.images[0].ncols()))
        .collect();
    left.reverse();
    // Its own mirror image: all nodes are next to it.
    let middle = (columns % 2 == 1).then(|| Piece::new(moments, half..half + 1, 0..n, tolerance));
    left.into_iter().chain(middle).chain(right).collect()
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
        let n = mesh.contact_nodes;
        let column_moments = Moments::new(mesh, basis, exact, diffusivity, tolerance);
        let (modes, moments) = column_moments.weights.shape();
        let mut weights = Vec::with_capacity(modes * moments / LANES);
        for first in (0..moments).step_by(LANES) {
            weights.extend(
                (0..modes).map(|mode| std::array::from_fn(|lane| column_moments.weights[(mode, first + lane)])),
            );
        }
        let pieces = if moments == 0 {
            Vec::new()
        } else {
            pieces(mesh, &column_moments, tolerance)
        };
        let mut blocks = Vec::with_capacity(pieces.len());
        // Displacement per effect, effect by effect.
        let (mut effects, mut far) = (0, Vec::new());
        for piece in pieces {
            let own = piece.parts.len() / (2 * n);
            far.extend(piece.parts);
            blocks.push(Block {
                columns: piece.columns,
                effects: effects..effects + own,
                combinations: single(&piece.combinations),
                near: piece.near,
                gains: single(&piece.gains),
            });
            effects += own;
        }
        let far = DMatrix::from_vec(2 * n, effects, far).transpose();
        effects = effects.next_multiple_of(LANES);
        ThermalMap {
            modes,
            moments,
            effects,
            weights,
            blocks,
            far: single(far.resize_vertically(effects, 0.0).as_slice()),
        }
    }

    /// Numbers of moments a column, of effects and of gains.
    pub fn size(&self) -> (usize, usize, usize) {
        let near = self
            .blocks
            .iter()
            .map(|block| block.combinations.len() + block.gains.len());
        (self.moments, self.effects, self.far.len() + near.sum::<usize>())
    }

    /// Values that [`ThermalMap::apply`] needs for moments and effects.
    pub fn scratch_len(&self) -> usize {
        let columns = self.blocks.last().map_or(0, |block| block.columns.end);
        columns * self.moments + self.effects
    }

    /// The displacement of the field into `displacement` (2n); `scratch` holds [`ThermalMap::scratch_len`] values.
    pub fn apply(&self, amplitudes: &[f64], scratch: &mut [f64], displacement: &mut [f64]) {
        dense::vectorised(
            #[inline(always)]
            |arithmetic| self.apply_kernel(arithmetic, amplitudes, scratch, displacement),
        )
    }

    #[inline(always)]
    fn apply_kernel(&self, arithmetic: Arithmetic, amplitudes: &[f64], scratch: &mut [f64], displacement: &mut [f64]) {
        displacement.fill(0.0);
        // Upstream, the rail has not been heated since it entered.
        let is_warm = |block: &&Block| {
            let columns = &amplitudes[block.columns.start * self.modes..block.columns.end * self.modes];
            columns.chunks_exact(self.modes).any(|column| column[0] != 0.0)
        };
        // A rail that does not expand has no moments.
        let (Some(first), Some(last)) = (
            self.blocks.iter().position(|block| self.moments > 0 && is_warm(&block)),
            self.blocks.iter().rposition(|block| is_warm(&block)),
        ) else {
            return;
        };
        let warm = &self.blocks[first..=last];
        let (effects, all_moments) = scratch.split_at_mut(self.effects);
        effects.fill(0.0);
        let (shifts, lifts) = displacement.split_at_mut(displacement.len() / 2);
        for block in warm {
            let columns = block.columns.clone();
            let moments = &mut all_moments[columns.start * self.moments..columns.end * self.moments];
            for (column, moments) in amplitudes[columns.start * self.modes..columns.end * self.modes]
                .chunks_exact(self.modes)
                .zip(moments.chunks_exact_mut(self.moments))
            {
                self.column_moments(arithmetic, column, moments);
            }
            multiply_add(
                arithmetic,
                &block.combinations,
                moments,
                &mut effects[block.effects.clone()],
            );
            let (along, upward) = block.gains.split_at(block.gains.len() / 2);
            multiply_add(arithmetic, along, moments, &mut shifts[block.near.clone()]);
            multiply_add(arithmetic, upward, moments, &mut lifts[block.near.clone()]);
        }
        let end = warm[warm.len() - 1].effects.end;
        let range = warm[0].effects.start / LANES * LANES..end.next_multiple_of(LANES);
        for (row, displacement) in self.far.chunks_exact(self.effects).zip(displacement) {
            *displacement += dot(arithmetic, &row[range.clone()], &effects[range.clone()]);
        }
    }

    #[inline(always)]
    fn column_moments(&self, arithmetic: Arithmetic, column: &[f64], moments: &mut [f64]) {
        for (moments, weights) in moments
            .chunks_exact_mut(LANES)
            .zip(self.weights.chunks_exact(self.modes))
        {
            // Even and odd modes apart: twice the sums that do not wait for each other.
            let (mut even, mut odd) = ([0.0; LANES], [0.0; LANES]);
            for (amplitudes, weights) in column.chunks(2).zip(weights.chunks(2)) {
                for lane in 0..LANES {
                    even[lane] = arithmetic.multiply_add(amplitudes[0], weights[0][lane], even[lane]);
                }
                if let ([_, amplitude], [_, weights]) = (amplitudes, weights) {
                    for lane in 0..LANES {
                        odd[lane] = arithmetic.multiply_add(*amplitude, weights[lane], odd[lane]);
                    }
                }
            }
            for lane in 0..LANES {
                moments[lane] = even[lane] + odd[lane];
            }
        }
    }
}

/// `out += rows · x`.
#[inline(always)]
fn multiply_add(arithmetic: Arithmetic, rows: &[f32], x: &[f64], out: &mut [f64]) {
    for (row, out) in rows.chunks_exact(x.len()).zip(out) {
        *out += dot(arithmetic, row, x);
    }
}

/// Σ gains · x of a multiple of [`LANES`] values.
#[inline(always)]
fn dot(arithmetic: Arithmetic, gains: &[f32], x: &[f64]) -> f64 {
    let mut sums = [0.0; LANES];
    for (gains, x) in gains.chunks_exact(LANES).zip(x.chunks_exact(LANES)) {
        for lane in 0..LANES {
            sums[lane] = arithmetic.multiply_add(f64::from(gains[lane]), x[lane], sums[lane]);
        }
    }
    // Not in pairs: the compiler then takes registers of half the width.
    sums.iter().sum()
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
    exact.tr_mul(&DVector::from_vec(temperature)).as_slice().to_vec()
}
