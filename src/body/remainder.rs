//! Remainder of the strip over the half-plane (singularity subtraction).
//!
//! The displacement by a force on the strip's surface is that on the half-plane ([`super::half_plane`]) and a remainder, which
//! has no load on the surface, and on Γ₀ the half-plane's displacement with the opposite sign. It is as smooth as Γ₀ is
//! far away: a coarse mesh of its own, the same whatever the contact's, has it to a thousandth of the displacement, and of that
//! nearly all is a rigid shift, which moves the penetration alone. Over the contact window a parabola through three places
//! is enough, in the place of the force as in that of the displacement: the error is of the order of the third power of the
//! window's share of the distance to Γ₀. So is a force in place of a uniform traction on a cell.

use super::compliance::symmetrised;
use super::elasticity::Elasticity;
use super::forms;
use super::half_plane::HalfPlane;
use super::mesh::Mesh;
use crate::error::Result;
use crate::numerics::interpolation::between;
use crate::parameters::Parameters;
use nalgebra::DMatrix;

/// Cells of the remainder's mesh on each side of its window, and in depth.
const OUTER_CELLS: usize = 24;
const DEPTH_CELLS: usize = 20;
/// First cell of the mesh under the surface, and the least half-width of its window, over the height of the strip.
const FIRST_CELL: f64 = 0.02;
const HALF_WIDTH: f64 = 0.01;

/// The remainders of a body for forces at three places: the left end of its window, the middle, and the right end.
pub struct Remainder {
    mesh: Mesh,
    /// Displacement at the three places per force there, along x₁ first, 6 × 6.
    surface: DMatrix<f64>,
    /// div u at the nodes of its mesh, for the three forces along x₁, then for those along x₂. Nodes × 6.
    dilatation: DMatrix<f64>,
}

impl Remainder {
    /// Remainder of a strip of the given material, λ and γ in `Pa`.
    ///
    /// # Errors
    /// [`crate::error::Error::StiffnessNotPositiveDefinite`].
    pub fn new(parameters: &Parameters, lambda: f64, shear: f64) -> Result<Remainder> {
        Remainder::on(strip_mesh(parameters, 1), lambda, shear)
    }

    fn on(mesh: Mesh, lambda: f64, shear: f64) -> Result<Remainder> {
        let body = Elasticity::new(&mesh, lambda, shear, 0.0)?;
        let material = HalfPlane::new(lambda, shear);
        let end = mesh.window_half_width();
        let solved = body.fields_by_boundary(&mesh, |[x, y]| {
            [(0.0, 0), (end, 0), (0.0, 1), (end, 1)]
                .map(|(force, direction)| material.displacement(direction, [x - force, y]).map(|u| -u))
        });
        let solved_dilatation = forms::dilatation(&mesh, &solved);
        // The field of a force at the left end is the mirror image of that at the right end, and that of a force along x₁
        // its opposite.
        let surface = DMatrix::from_fn(6, 6, |i, j| {
            let ((displaced, node), (direction, force)) = ((i / 3, i % 3), (j / 3, j % 3));
            let at = |node, field| solved[(2 * mesh.node(mesh.contact_column(node), 0) + displaced, field)];
            let sign = if displaced == direction { 1.0 } else { -1.0 };
            match force {
                0 => sign * at(2 - node, 2 * direction + 1),
                _ => at(node, 2 * direction + force - 1),
            }
        });
        let dilatation = DMatrix::from_fn(mesh.nodes(), 6, |node, j| {
            let (direction, force) = (j / 3, j % 3);
            let opposite = mesh.node(mesh.columns() - 1 - node / mesh.rows(), node % mesh.rows());
            let sign = if direction == 0 { -1.0 } else { 1.0 };
            match force {
                0 => sign * solved_dilatation[(opposite, 2 * direction + 1)],
                _ => solved_dilatation[(node, 2 * direction + force - 1)],
            }
        });
        Ok(Remainder {
            surface: symmetrised(&surface),
            dilatation,
            mesh,
        })
    }

    /// Displacement of the contact nodes of a mesh per force at them, 2n × 2n, along x₁ first, `m/N` per metre of width.
    pub fn surface_displacement(&self, mesh: &Mesh) -> DMatrix<f64> {
        let n = mesh.contact_nodes;
        let mut shares = DMatrix::zeros(2 * n, 6);
        for i in 0..n {
            for (place, share) in self.shares(mesh.contact_position(i)).into_iter().enumerate() {
                shares[(i, place)] = share;
                shares[(n + i, 3 + place)] = share;
            }
        }
        &shares * &self.surface * shares.transpose()
    }

    /// Values of the parabolas that are 1 at one of the three places and 0 at the others.
    pub fn shares(&self, position: f64) -> [f64; 3] {
        let place = position / self.mesh.window_half_width();
        [
            0.5 * place * (place - 1.0),
            1.0 - place * place,
            0.5 * place * (place + 1.0),
        ]
    }

    /// div u at the nodes of another mesh of the strip, for the three forces along x₁, then for those along x₂: nodes × 6,
    /// bilinear between the nodes of its own.
    pub fn dilatation(&self, mesh: &Mesh) -> DMatrix<f64> {
        let (across, down): (Vec<_>, Vec<_>) = (
            mesh.x.iter().map(|&x| between(&self.mesh.x, x)).collect(),
            mesh.depth.iter().map(|&z| between(&self.mesh.depth, z)).collect(),
        );
        DMatrix::from_fn(mesh.nodes(), 6, |node, force| {
            let ((column, right), (row, below)) = (across[node / mesh.rows()], down[node % mesh.rows()]);
            let at = |column, row| self.dilatation[(self.mesh.node(column, row), force)];
            let depth = |column| at(column, row) * (1.0 - below) + at(column, row + 1) * below;
            depth(column) * (1.0 - right) + depth(column + 1) * right
        })
    }
}

/// The mesh of the remainder, its cells halved `1/refinement` times along both axes.
fn strip_mesh(parameters: &Parameters, refinement: usize) -> Mesh {
    let (length, height) = (parameters.strip_half_length, parameters.strip_height);
    let half_width = parameters.window_half_width().max(HALF_WIDTH * height);
    // The cells beside the window are as wide as half of it, and grow.
    let room = ((length - half_width) / half_width) as usize;
    Mesh::graded(
        half_width,
        3,
        length,
        refinement * OUTER_CELLS.min(room),
        height,
        refinement * DEPTH_CELLS,
        FIRST_CELL * height / refinement as f64,
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    fn remainder(parameters: &Parameters, refinement: usize) -> Remainder {
        let mesh = strip_mesh(parameters, refinement);
        Remainder::on(mesh, parameters.lame_lambda, parameters.shear_modulus).unwrap()
    }

    /// Displacement (1−ν)/(πγ) that a factor e in the distance is worth.
    fn unit(parameters: &Parameters) -> f64 {
        let material = HalfPlane::new(parameters.lame_lambda, parameters.shear_modulus);
        (1.0 - material.poisson_ratio) / (PI * material.shear_modulus)
    }

    /// Remainder against that on twice and four times as fine a mesh, in the strip of the default and in a shallow and
    /// a long one.
    #[test]
    fn the_coarse_mesh_has_the_remainder_to_a_thousandth_of_the_displacement() {
        for (strip_half_length, strip_height) in [(2.0, 1.0), (2.0, 0.3), (10.0, 1.0)] {
            let parameters = Parameters {
                strip_half_length,
                strip_height,
                ..Parameters::default()
            };
            let [coarse, middle, fine] = [1, 2, 4].map(|refinement| remainder(&parameters, refinement).surface);
            let unit = unit(&parameters);
            // The displacement at the contact is ln(1 m/1 mm) ≈ 7 units.
            let error = (&coarse - &fine).amax() / unit;
            assert!(error < 7e-3, "{strip_height}: {error:e}");
            let next = (&middle - &fine).amax() / unit;
            // Order 2: (4² − 1)/(2² − 1) = 5.
            assert!(
                (4.0..6.5).contains(&(error / next)),
                "{strip_height}: {error:e} {next:e}"
            );
            // But for a rigid shift it is exact: what differs over half of the window.
            let change = |surface: &DMatrix<f64>, i: usize, j: usize| (surface[(i + 1, j)] - surface[(i, j)]) / unit;
            for j in 0..6 {
                for i in [0, 1, 3, 4] {
                    let error = change(&coarse, i, j) - change(&fine, i, j);
                    assert!(error.abs() < 2e-4, "{strip_height} {i} {j}: {error:e}");
                }
            }
        }
    }

    /// Growth by ln s: in a strip s times as large the displacement at s times the distance is the same but for it.
    #[test]
    fn the_remainder_grows_with_the_logarithm_of_the_strip() {
        let small = Parameters::default();
        let large = Parameters {
            strip_half_length: 3.0 * small.strip_half_length,
            strip_height: 3.0 * small.strip_height,
            ..Parameters::default()
        };
        let growth = (remainder(&large, 1).surface - remainder(&small, 1).surface) / unit(&small);
        for i in 0..6 {
            for j in 0..6 {
                let expected = if i / 3 == j / 3 { 3.0_f64.ln() } else { 0.0 };
                // Round-off times the condition of the strip.
                assert!((growth[(i, j)] - expected).abs() < 1e-8, "{i} {j}: {}", growth[(i, j)]);
            }
        }
    }

    /// The parabola between the three places, against forces between them on the same mesh.
    #[test]
    fn three_places_are_enough() {
        let parameters = Parameters::default();
        let half_width = strip_mesh(&parameters, 1).window_half_width();
        let material = HalfPlane::new(parameters.lame_lambda, parameters.shear_modulus);
        let lame = (parameters.lame_lambda, parameters.shear_modulus);
        // The same columns, and one between each of them and the next.
        let (length, height) = (parameters.strip_half_length, parameters.strip_height);
        let mesh = Mesh::graded(half_width, 5, length, 48, height, 40, FIRST_CELL * height);
        let body = Elasticity::new(&mesh, lame.0, lame.1, 0.0).unwrap();
        let force = 0.5 * half_width;
        let fields = body.fields_by_boundary(&mesh, |[x, y]| {
            [0, 1].map(|direction| material.displacement(direction, [x - force, y]).map(|u| -u))
        });
        let remainder = Remainder::on(
            Mesh::graded(half_width, 3, length, 48, height, 40, FIRST_CELL * height),
            lame.0,
            lame.1,
        )
        .unwrap();
        let computed = remainder.surface_displacement(&mesh);
        for direction in 0..2 {
            for i in 0..10 {
                let exact = fields[(2 * mesh.node(mesh.contact_column(i % 5), 0) + i / 5, direction)];
                let error = (computed[(i, 5 * direction + 3)] - exact) / unit(&parameters);
                // A constant is the difference between two meshes; the share of the window in the distance to Γ₀ is 0.01.
                let constant = (computed[(5 * (i / 5) + 2, 5 * direction + 3)]
                    - fields[(2 * mesh.node(mesh.contact_column(2), 0) + i / 5, direction)])
                    / unit(&parameters);
                assert!(constant.abs() < 1e-3, "{direction} {i}: {constant:e}");
                assert!(
                    (error - constant).abs() < 2e-5,
                    "{direction} {i}: {error:e} {constant:e}"
                );
            }
        }
    }
}
