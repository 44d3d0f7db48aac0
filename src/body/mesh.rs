//! Graded tensor-product triangulation of the strip Ω = (−L, L) × (0, h).
//!
//! Nodes stand in columns; node `column * rows + row`, row 0 at the surface Γ_C. Columns are evenly spaced over
//! the contact window and grow geometrically outside it, rows grow geometrically with depth. The diagonals are
//! mirrored about x₁ = 0, so that mirrored motion gives mirrored fields to round-off.

use crate::parameters::{MeshKind, Parameters};

/// First cell under the surface at 41 depth nodes, `m`: a tenth of the thermal skin √(κ·2a/V) of one passage.
const FIRST_CELL: f64 = 10e-6;
/// Cells outside the window on each side at 61 contact nodes.
const OUTER_CELLS: f64 = 24.0;

/// One P1 triangle.
#[derive(Debug, Clone, Copy)]
pub struct Triangle {
    /// Nodes of the triangle, anticlockwise.
    pub nodes: [usize; 3],
    /// Weight of its integrals: 1, or ½ where both diagonals of a cell are averaged.
    pub weight: f64,
}

/// The triangulation.
#[derive(Debug, Clone)]
pub struct Mesh {
    /// Positions x₁ of the columns, ascending, `m`.
    pub x: Vec<f64>,
    /// Depths −x₂ of the rows below the surface, ascending from 0 to h, `m`.
    pub depth: Vec<f64>,
    /// First column of the contact window.
    pub first_contact: usize,
    /// Number of columns in the contact window.
    pub contact_nodes: usize,
    /// Whether the cells of the contact window take the mean of both diagonals.
    mean_diagonals: bool,
}

impl Mesh {
    /// The mesh that the parameters ask for.
    pub fn new(parameters: &Parameters) -> Mesh {
        let half_width = parameters.window_half_width();
        let (length, height) = (parameters.strip_half_length, parameters.strip_height);
        match parameters.mesh {
            MeshKind::Graded => {
                let n = parameters.contact_nodes;
                let outer = (OUTER_CELLS * (n as f64 / 61.0).sqrt()).round() as usize;
                let cells = parameters.depth_nodes - 1;
                let first = FIRST_CELL * 40.0 / cells as f64;
                Mesh::graded(half_width, n, length, outer, height, cells, first)
            }
            // Eight cells in depth make the strip too stiff: at a given penetration the load, and with it the contact, is larger
            // than on a fine mesh, and needs a wider window.
            MeshKind::Paper => Mesh {
                mean_diagonals: false,
                ..Mesh::graded(1.5 * half_width, 9, length, 2, height, 8, 2.0 * FIRST_CELL)
            },
        }
    }

    /// Mesh of `contact_nodes` evenly spaced over ±`half_width`, `outer` growing cells on each side to ±`length`, and
    /// `cells` growing cells over the `height`, the first of them `first_cell` thick (lengths in `m`).
    pub fn graded(
        half_width: f64,
        contact_nodes: usize,
        length: f64,
        outer: usize,
        height: f64,
        cells: usize,
        first_cell: f64,
    ) -> Mesh {
        let intervals = contact_nodes - 1;
        let spacing = 2.0 * half_width / intervals as f64;
        let right = geometric_partition(length - half_width, outer, spacing);
        // Written as an odd function of the column, so that the mirror image is exact.
        let window = (0..contact_nodes).map(|i| half_width * ((2 * i) as f64 - intervals as f64) / intervals as f64);
        let left = right.iter().skip(1).rev().map(|r| -(half_width + r));
        let x = left
            .chain(window)
            .chain(right.iter().skip(1).map(|r| half_width + r))
            .collect();
        Mesh {
            x,
            depth: geometric_partition(height, cells, first_cell.min(height / cells as f64)),
            first_contact: outer,
            contact_nodes,
            mean_diagonals: true,
        }
    }

    /// Number of columns.
    pub fn columns(&self) -> usize {
        self.x.len()
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.depth.len()
    }

    /// Number of nodes.
    pub fn nodes(&self) -> usize {
        self.columns() * self.rows()
    }

    /// Node in a column and row.
    pub fn node(&self, column: usize, row: usize) -> usize {
        column * self.rows() + row
    }

    /// Columns of the contact window.
    pub fn window(&self) -> std::ops::Range<usize> {
        self.first_contact..self.first_contact + self.contact_nodes
    }

    /// Column of a contact node.
    pub fn contact_column(&self, contact_node: usize) -> usize {
        self.first_contact + contact_node
    }

    /// Position x₁ of a contact node, `m`.
    pub fn contact_position(&self, contact_node: usize) -> f64 {
        self.x[self.contact_column(contact_node)]
    }

    /// Spacing of the contact nodes, their tributary length, `m`.
    pub fn contact_spacing(&self) -> f64 {
        let last = self.contact_nodes - 1;
        (self.contact_position(last) - self.contact_position(0)) / last as f64
    }

    /// Half-width of the contact window, `m`.
    pub fn window_half_width(&self) -> f64 {
        self.contact_position(self.contact_nodes - 1)
    }

    /// Whether a node lies on Γ₀, the clamped part of the boundary: bottom and both ends.
    pub fn is_clamped(&self, node: usize) -> bool {
        let (column, row) = (node / self.rows(), node % self.rows());
        row + 1 == self.rows() || column == 0 || column + 1 == self.columns()
    }

    /// Coordinates (x₁, x₂) of a node, x₂ = 0 at the surface and negative below, `m`.
    pub fn coordinates(&self, node: usize) -> [f64; 2] {
        [self.x[node / self.rows()], -self.depth[node % self.rows()]]
    }

    /// The triangles: two to a cell, diagonals mirrored about x₁ = 0. The cells of the contact window take the mean of
    /// both diagonals, each with half its weight: where the diagonals turn, in the middle of the contact, pressure and
    /// shear would show a dent of 1 %.
    pub fn triangles(&self) -> Vec<Triangle> {
        let mut triangles = Vec::with_capacity(2 * (self.columns() - 1) * (self.rows() - 1) + 2 * self.rows());
        for column in 0..self.columns() - 1 {
            let side = self.x[column] + self.x[column + 1];
            let window = self.first_contact..self.first_contact + self.contact_nodes - 1;
            let both = self.mean_diagonals && window.contains(&column);
            for row in 0..self.rows() - 1 {
                let upper_left = self.node(column, row);
                let lower_left = self.node(column, row + 1);
                let upper_right = self.node(column + 1, row);
                let lower_right = self.node(column + 1, row + 1);
                let weight = if both { 0.5 } else { 1.0 };
                let mut add = |nodes| triangles.push(Triangle { nodes, weight });
                if both || side < 0.0 {
                    add([upper_left, lower_left, upper_right]);
                    add([lower_left, lower_right, upper_right]);
                }
                if both || side > 0.0 {
                    add([upper_left, lower_left, lower_right]);
                    add([upper_left, lower_right, upper_right]);
                }
            }
        }
        triangles
    }
}

/// Points 0 = r₀ < r₁ < … < r_cells = `length` whose spacing starts at `first` and grows by a constant ratio.
fn geometric_partition(length: f64, cells: usize, first: f64) -> Vec<f64> {
    let sum = |ratio: f64| -> f64 { (0..cells).map(|i| first * ratio.powi(i as i32)).sum() };
    // The sum grows with the ratio: bisection to round-off.
    let (mut low, mut high) = (1.0_f64, 1.0_f64);
    for _ in 0..64 {
        if sum(high) >= length {
            break;
        }
        high *= 2.0;
    }
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if sum(middle) < length {
            low = middle;
        } else {
            high = middle;
        }
    }
    let ratio = 0.5 * (low + high);
    let mut points: Vec<f64> = Vec::with_capacity(cells + 1);
    let (mut position, mut step) = (0.0, first);
    for _ in 0..cells {
        points.push(position);
        position += step;
        step *= ratio;
    }
    points.push(length);
    points
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_paper_preset_has_192_triangles_and_13_surface_nodes() {
        let parameters = Parameters {
            mesh: MeshKind::Paper,
            ..Parameters::default()
        };
        let mesh = Mesh::new(&parameters);
        assert_eq!(mesh.triangles().len(), 192);
        assert_eq!(mesh.columns(), 13);
        assert_eq!((mesh.x[0], mesh.x[12]), (-2.0, 2.0));
    }

    #[test]
    fn triangles_tile_the_strip_and_mirror_about_the_middle() {
        for contact_nodes in [60, 61] {
            let mesh = Mesh::new(&Parameters {
                contact_nodes,
                ..Parameters::default()
            });
            let area: f64 = mesh
                .triangles()
                .iter()
                .map(|t| {
                    let [p, q, r] = t.nodes.map(|n| mesh.coordinates(n));
                    let twice = (q[0] - p[0]) * (r[1] - p[1]) - (r[0] - p[0]) * (q[1] - p[1]);
                    assert!(twice > 0.0, "anticlockwise");
                    0.5 * twice * t.weight
                })
                .sum();
            assert!((area - 4.0).abs() < 1e-12);
            let columns = mesh.columns();
            for c in 0..columns {
                assert_eq!(mesh.x[c], -mesh.x[columns - 1 - c]);
            }
            assert!(mesh.x.windows(2).all(|p| p[1] > p[0]));
            assert!(mesh.depth.windows(2).all(|p| p[1] > p[0]));
        }
    }
}
