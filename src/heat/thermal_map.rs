//! Thermal displacement of the contact nodes from the temperature field, compressed.
//!
//! The exact map is dense: 2n rows by all nodes of the mesh, memory-bound in a step. Two compressions make it small:
//!
//! 1. Over the depth. The displacement is smooth in the depth of its cause, so that per column a few weighted integrals
//!    ("moments") carry it. The weights are common to all columns: the leading right singular vectors of the map over the
//!    profiles that a heated surface can make ([`super::compression`]).
//! 2. Along the rail. The displacement is smooth also in the place of its cause, but for the nodes next to it. Columns are
//!    taken in blocks of √n; far from a block, a few combinations of its moments ("far moments") carry the response to it.
//!    Next to the block what these leave is added from the moments themselves.

use super::basis::DepthBasis;
use super::compression::{Moments, block_responses};
use crate::body::compliance::ThermalDisplacement;
use crate::body::mesh::Mesh;
use crate::numerics::dense::{self, LANES, MultiplyAdd};
use crate::numerics::single::rounded;
use nalgebra::DMatrix;
use std::ops::Range;

/// Error of the compressed map relative to the largest displacement of a heated profile.
pub const TOLERANCE: f64 = 1e-4;

/// Maps modal amplitudes (columns × modes) to the 2n scaled displacements, along x₁ first.
#[derive(Debug, Clone)]
pub struct ThermalMap {
    modes: usize,
    /// Number of moments of a column, a multiple of [`LANES`]: the partial sums of a product.
    moments: usize,
    /// Number of far moments of all blocks, padded to [`LANES`].
    far_moments: usize,
    /// Weights of the moments: per [`LANES`] moments and mode the weights of those moments.
    weights: Vec<[f64; LANES]>,
    blocks: Vec<ColumnBlock>,
    /// Displacement per far moment, row by row, 2n × far moments. Responses are in single precision: 6e-8 is far below the
    /// tolerance, and it halves the memory that an application streams through.
    far_response: Vec<f32>,
}

/// Neighbouring columns and what their temperature does.
#[derive(Debug, Clone)]
struct ColumnBlock {
    columns: Range<usize>,
    /// Range of the block's far moments among those of all blocks.
    far_moments: Range<usize>,
    /// Far moments per moment of the columns, row by row.
    combinations: Vec<f32>,
    /// Contact nodes next to the block.
    near: Range<usize>,
    /// Displacement of the near nodes per moment of the columns, less that by the far moments; along x₁,
    /// then along x₂, row by row.
    near_response: Vec<f32>,
}

impl ThermalMap {
    /// Compresses the exact map to the given tolerance. A map that cannot be compressed is kept whole.
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
        let block_responses = if moments == 0 {
            Vec::new()
        } else {
            block_responses(mesh, &column_moments, tolerance)
        };
        let mut blocks = Vec::with_capacity(block_responses.len());
        // Displacement per far moment, one far moment after the other.
        let (mut far_moments, mut far_response) = (0, Vec::new());
        for response in block_responses {
            let own = response.far_response.len() / (2 * n);
            far_response.extend(response.far_response);
            blocks.push(ColumnBlock {
                columns: response.columns,
                far_moments: far_moments..far_moments + own,
                combinations: rounded(&response.combinations),
                near: response.near,
                near_response: rounded(&response.near_response),
            });
            far_moments += own;
        }
        let far_response = DMatrix::from_vec(2 * n, far_moments, far_response).transpose();
        far_moments = far_moments.next_multiple_of(LANES);
        ThermalMap {
            modes,
            moments,
            far_moments,
            weights,
            blocks,
            far_response: rounded(far_response.resize_vertically(far_moments, 0.0).as_slice()),
        }
    }

    /// Numbers of moments a column, of far moments and of the values of all responses.
    pub fn size(&self) -> (usize, usize, usize) {
        let near = self
            .blocks
            .iter()
            .map(|block| block.combinations.len() + block.near_response.len());
        (
            self.moments,
            self.far_moments,
            self.far_response.len() + near.sum::<usize>(),
        )
    }

    /// Values that [`ThermalMap::apply`] needs for moments and far moments.
    pub fn scratch_len(&self) -> usize {
        let columns = self.blocks.last().map_or(0, |block| block.columns.end);
        columns * self.moments + self.far_moments
    }

    /// The displacement of the field into `displacement` (2n); `scratch` holds [`ThermalMap::scratch_len`] values.
    pub fn apply(&self, amplitudes: &[f64], scratch: &mut [f64], displacement: &mut [f64]) {
        dense::vectorised(
            #[inline(always)]
            |fma| self.apply_kernel(fma, amplitudes, scratch, displacement),
        )
    }

    #[inline(always)]
    fn apply_kernel(&self, fma: MultiplyAdd, amplitudes: &[f64], scratch: &mut [f64], displacement: &mut [f64]) {
        displacement.fill(0.0);
        // Columns upstream of the contact hold no heat unless rail came in warm: their blocks are left out.
        let is_warm = |block: &&ColumnBlock| {
            let columns = &amplitudes[block.columns.start * self.modes..block.columns.end * self.modes];
            columns.chunks_exact(self.modes).any(|column| column[0] != 0.0)
        };
        // Without thermal expansion there are no moments, and no displacement.
        let (Some(first), Some(last)) = (
            self.blocks.iter().position(|block| self.moments > 0 && is_warm(&block)),
            self.blocks.iter().rposition(|block| is_warm(&block)),
        ) else {
            return;
        };
        let warm = &self.blocks[first..=last];
        let (far_moments, all_moments) = scratch.split_at_mut(self.far_moments);
        far_moments.fill(0.0);
        let (shifts, lifts) = displacement.split_at_mut(displacement.len() / 2);
        for block in warm {
            let columns = block.columns.clone();
            let moments = &mut all_moments[columns.start * self.moments..columns.end * self.moments];
            for (column, moments) in amplitudes[columns.start * self.modes..columns.end * self.modes]
                .chunks_exact(self.modes)
                .zip(moments.chunks_exact_mut(self.moments))
            {
                self.column_moments(fma, column, moments);
            }
            multiply_add(
                fma,
                &block.combinations,
                moments,
                &mut far_moments[block.far_moments.clone()],
            );
            let (along, upward) = block.near_response.split_at(block.near_response.len() / 2);
            multiply_add(fma, along, moments, &mut shifts[block.near.clone()]);
            multiply_add(fma, upward, moments, &mut lifts[block.near.clone()]);
        }
        let end = warm[warm.len() - 1].far_moments.end;
        let range = warm[0].far_moments.start / LANES * LANES..end.next_multiple_of(LANES);
        for (row, displacement) in self.far_response.chunks_exact(self.far_moments).zip(displacement) {
            *displacement += dot(fma, &row[range.clone()], &far_moments[range.clone()]);
        }
    }

    #[inline(always)]
    fn column_moments(&self, fma: MultiplyAdd, column: &[f64], moments: &mut [f64]) {
        for (moments, weights) in moments
            .chunks_exact_mut(LANES)
            .zip(self.weights.chunks_exact(self.modes))
        {
            // Even and odd modes have sums of their own, so that each addition waits for every other one only.
            let (mut even, mut odd) = ([0.0; LANES], [0.0; LANES]);
            for (amplitudes, weights) in column.chunks(2).zip(weights.chunks(2)) {
                for lane in 0..LANES {
                    even[lane] = fma.multiply_add(amplitudes[0], weights[0][lane], even[lane]);
                }
                if let ([_, amplitude], [_, weights]) = (amplitudes, weights) {
                    for lane in 0..LANES {
                        odd[lane] = fma.multiply_add(*amplitude, weights[lane], odd[lane]);
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
fn multiply_add(fma: MultiplyAdd, rows: &[f32], x: &[f64], out: &mut [f64]) {
    for (row, out) in rows.chunks_exact(x.len()).zip(out) {
        *out += dot(fma, row, x);
    }
}

/// Σ response · x of a multiple of [`LANES`] values.
#[inline(always)]
fn dot(fma: MultiplyAdd, response: &[f32], x: &[f64]) -> f64 {
    let mut sums = [0.0; LANES];
    for (response, x) in response.chunks_exact(LANES).zip(x.chunks_exact(LANES)) {
        for lane in 0..LANES {
            sums[lane] = fma.multiply_add(f64::from(response[lane]), x[lane], sums[lane]);
        }
    }
    // One after the other: summed in pairs, the compiler chose vector registers of half the width for the whole loop.
    sums.iter().sum()
}

/// Compressed map on fields that the heat march makes under random fluxes, speeds and times.
#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::compliance::Scales;
    use crate::body::pair;
    use crate::friction::FrictionState;
    use crate::heat::Heat;
    use crate::heat::factors::CellFactors;
    use crate::heat::incoming::Incoming;
    use crate::heat::march::{HeatMarch, Heated};
    use crate::heat::surface::{SurfaceCondition, SurfaceExchange};
    use crate::parameters::{FrictionLaw, Parameters};
    use crate::settings::HeatSettings;
    use crate::transport::Upwind;
    use nalgebra::DVector;
    use proptest::prelude::*;
    use std::sync::OnceLock;

    /// The displacement of the field by the exact map: 2n values.
    fn exact_displacement(
        mesh: &Mesh,
        basis: &DepthBasis,
        exact: &ThermalDisplacement,
        amplitudes: &[f64],
    ) -> Vec<f64> {
        let mut temperature = vec![0.0; mesh.nodes()];
        for (column, a) in amplitudes.chunks_exact(basis.len()).enumerate() {
            for row in 0..mesh.rows() {
                temperature[mesh.node(column, row)] = basis.value(a.iter().copied(), row);
            }
        }
        exact.tr_mul(&DVector::from_vec(temperature)).as_slice().to_vec()
    }

    fn parameters() -> Parameters {
        Parameters {
            friction_law: FrictionLaw::Constant,
            friction_cold: 1.0,
            ..Parameters::default()
        }
    }

    struct Rail {
        mesh: Mesh,
        heat: Heat,
        exact: ThermalDisplacement,
    }

    fn rail() -> &'static Rail {
        static RAIL: OnceLock<Rail> = OnceLock::new();
        RAIL.get_or_init(|| {
            let parameters = parameters();
            let mesh = Mesh::new(&parameters);
            let (_, exact) = pair::build(&mesh, &parameters, &Scales::new(&parameters)).unwrap();
            let heat = Heat::new(&mesh, &exact, &parameters).unwrap();
            Rail { mesh, heat, exact }
        })
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(40))]
        #[test]
        fn the_compressed_map_is_the_exact_one_within_its_tolerance(
            flux in prop::collection::vec(0.0..1e9, 61),
            contact in 5_usize..30,
            log_speed in -1.5..2.1,
            backward in any::<bool>(),
            log_step in -4.0..1.0,
            steps in 1_usize..6,
        ) {
            let rail = rail();
            let parameters = parameters();
            let speed = 10.0_f64.powf(log_speed) * if backward { -1.0 } else { 1.0 };
            let exchange: Vec<SurfaceExchange> = flux
                .iter()
                .enumerate()
                .map(|(node, &friction)| SurfaceExchange {
                    friction: if node.abs_diff(30) < contact { friction } else { 0.0 },
                    debris: 0.0,
                    conduction: 0.0,
                    wheel: 0.0,
                    ..SurfaceExchange::default()
                })
                .collect();
            let march = HeatMarch {
                basis: &rail.heat.basis,
                transport: Upwind::new(&rail.mesh.x, speed),
                first_contact: rail.mesh.first_contact,
                duration: 10.0_f64.powf(log_step),
                surface: SurfaceCondition {
                    friction: FrictionState { parameters: &parameters, ambient: 293.15, scale: 1.0 },
                    settings: HeatSettings::default(),
                },
            };
            let size = rail.mesh.columns() * rail.heat.basis.len();
            let (mut before, mut after) = (vec![0.0; size], vec![0.0; size]);
            for _ in 0..steps {
                march.advance(
                    &before,
                    &exchange,
                    &mut Heated {
                        amplitudes: &mut after,
                        surface: &mut vec![0.0; rail.mesh.columns()],
                        flux: &mut vec![0.0; 61],
                    },
                    &mut CellFactors::new(&rail.heat.basis, &rail.mesh.x),
                ).unwrap();
                std::mem::swap(&mut before, &mut after);
            }
            let expected = exact_displacement(&rail.mesh, &rail.heat.basis, &rail.exact, &before);
            let mut computed = vec![0.0; expected.len()];
            rail.heat.displacement.apply(&before, &mut vec![0.0; rail.heat.displacement.scratch_len()], &mut computed);
            // Each moment of each column keeps its responses down to TOLERANCE of the largest displacement that a unit of it
            // makes in the middle of the window; what the columns drop adds up with random signs.
            let error = dense::largest_change(&expected, &computed) / dense::largest(&expected);
            prop_assert!(error <= 10.0 * TOLERANCE, "{error:e}");
        }
    }

    /// Rail that comes in hot is hot in all columns, whose dropped responses add up.
    #[test]
    fn the_compressed_map_holds_for_rail_that_comes_in_hot() {
        let rail = rail();
        let m = rail.heat.basis.len();
        for skin_depth in [1e-3, 5e-3, 2e-2] {
            let incoming = Incoming::new(&rail.mesh.depth, &rail.heat.basis, skin_depth);
            let mut amplitudes = vec![0.0; rail.mesh.columns() * m];
            // All of the strip, and a front in the middle of it.
            for from in [0, rail.mesh.columns() / 2] {
                amplitudes.fill(0.0);
                for column in amplitudes.chunks_exact_mut(m).skip(from) {
                    incoming.enter(50.0, column, &mut 0.0);
                }
                let expected = exact_displacement(&rail.mesh, &rail.heat.basis, &rail.exact, &amplitudes);
                let mut computed = vec![0.0; expected.len()];
                rail.heat.displacement.apply(
                    &amplitudes,
                    &mut vec![0.0; rail.heat.displacement.scratch_len()],
                    &mut computed,
                );
                let error = dense::largest_change(&expected, &computed) / dense::largest(&expected);
                println!("{skin_depth} {from}: {error:e}");
                assert!(error <= 10.0 * TOLERANCE, "{skin_depth} {from}: {error:e}");
            }
        }
    }
}
