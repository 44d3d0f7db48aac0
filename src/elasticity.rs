//! P1 plane-strain elasticity (26)–(27): stiffness, convective inertia, thermal load, and the factorised solve.
//!
//! Weak form: ∫ σ(u):ε(v) − ρV² ∫ u,₁·v,₁ = α(3λ+2γ) ∫ θ div v + ∫_Γ F·v, u = 0 on Γ₀. The three bilinear forms are
//! assembled apart, because a step changes V and θ but never factorises.

use crate::error::{Error, Result};
use crate::mesh::Mesh;
use crate::sparse_cholesky::SparseCholesky;
use faer::sparse::{SparseColMat, SymbolicSparseColMat};
use faer::Mat;

/// Displacement fields, one to a column: entry `(2 * node + direction, field)` in `m` (0 along x₁, 1 along x₂).
pub type Fields = Mat<f64>;

/// A sparse matrix between nodes (or unknowns), by rows.
#[derive(Debug, Clone)]
pub struct NodeMatrix {
    starts: Vec<usize>,
    columns: Vec<usize>,
    values: Vec<f64>,
}

impl NodeMatrix {
    /// Sums element contributions `(row, column, value)`; rows are in ascending order of their columns.
    fn assemble(rows: usize, entries: &[(usize, usize, f64)]) -> NodeMatrix {
        let mut per_row = vec![Vec::<(usize, f64)>::with_capacity(18); rows];
        for &(row, column, value) in entries {
            let row = &mut per_row[row];
            match row.iter_mut().find(|(c, _)| *c == column) {
                Some((_, sum)) => *sum += value,
                None => row.push((column, value)),
            }
        }
        let mut matrix = NodeMatrix {
            starts: vec![0],
            columns: Vec::new(),
            values: Vec::new(),
        };
        for mut row in per_row {
            row.sort_unstable_by_key(|(column, _)| *column);
            matrix.columns.extend(row.iter().map(|(c, _)| c));
            matrix.values.extend(row.iter().map(|(_, v)| v));
            matrix.starts.push(matrix.columns.len());
        }
        matrix
    }

    /// Non-zero entries `(column, value)` of a row.
    pub fn row(&self, row: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let range = self.starts[row]..self.starts[row + 1];
        range.map(move |k| (self.columns[k], self.values[k]))
    }
}

/// The assembled forms of the rail.
pub struct Elasticity {
    /// ∫ N_i,₁ N_j,₁: the convective inertia is −ρV² times this, the same for both directions.
    pub inertia: NodeMatrix,
    /// ∫ N_i,₁ N_j: load along x₁ at node i of a unit thermal stress at node j.
    pub thermal_load_x: NodeMatrix,
    /// ∫ N_i,₂ N_j: the same along x₂.
    pub thermal_load_y: NodeMatrix,
    factor: SparseCholesky,
    /// Free unknown of each `2 * node + direction`, `usize::MAX` where clamped.
    unknown: Vec<usize>,
    unknowns: usize,
}

/// Gradients of the three hat functions of a triangle, `1/m`, and its area, `m²`.
fn gradients(points: [[f64; 2]; 3]) -> ([[f64; 2]; 3], f64) {
    let [p, q, r] = points;
    let twice_area = (q[0] - p[0]) * (r[1] - p[1]) - (r[0] - p[0]) * (q[1] - p[1]);
    let side = |a: [f64; 2], b: [f64; 2]| [(a[1] - b[1]) / twice_area, (b[0] - a[0]) / twice_area];
    ([side(q, r), side(r, p), side(p, q)], 0.5 * twice_area)
}

impl Elasticity {
    /// Assembles and factorises. `rho_v2` = ρV² enters the factorised matrix itself; the model uses 0 and carries
    /// V² to first order ([`crate::compliance`]), the tests use the whole form to bound that error.
    ///
    /// # Errors
    /// [`Error::StiffnessNotPositiveDefinite`]: above the Rayleigh speed the form is not coercive.
    pub fn new(mesh: &Mesh, lambda: f64, shear: f64, rho_v2: f64) -> Result<Elasticity> {
        let nodes = mesh.nodes();
        let mut unknown = vec![usize::MAX; 2 * nodes];
        let mut unknowns = 0;
        for node in (0..nodes).filter(|&n| !mesh.is_clamped(n)) {
            for direction in 0..2 {
                unknown[2 * node + direction] = unknowns;
                unknowns += 1;
            }
        }

        let triangles = mesh.triangles();
        let mut stiffness = Vec::with_capacity(21 * triangles.len());
        let mut inertia = Vec::with_capacity(9 * triangles.len());
        let mut load_x = Vec::with_capacity(9 * triangles.len());
        let mut load_y = Vec::with_capacity(9 * triangles.len());
        for triangle in &triangles {
            let (grad, area) = gradients(triangle.nodes.map(|n| mesh.coordinates(n)));
            let measure = area * triangle.weight;
            for (i, &node_i) in triangle.nodes.iter().enumerate() {
                for (j, &node_j) in triangle.nodes.iter().enumerate() {
                    inertia.push((node_i, node_j, measure * grad[i][0] * grad[j][0]));
                    load_x.push((node_i, node_j, measure / 3.0 * grad[i][0]));
                    load_y.push((node_i, node_j, measure / 3.0 * grad[i][1]));
                    for a in 0..2 {
                        for b in 0..2 {
                            let (row, column) = (unknown[2 * node_i + a], unknown[2 * node_j + b]);
                            // The upper triangle by rows is the lower one by columns.
                            if row == usize::MAX || column == usize::MAX || column < row {
                                continue;
                            }
                            // σ(u):ε(v) = λ div u div v + 2γ ε(u):ε(v)
                            let mut value = lambda * grad[i][a] * grad[j][b] + shear * grad[i][b] * grad[j][a];
                            if a == b {
                                value += shear * (grad[i][0] * grad[j][0] + grad[i][1] * grad[j][1])
                                    - rho_v2 * grad[i][0] * grad[j][0];
                            }
                            stiffness.push((row, column, measure * value));
                        }
                    }
                }
            }
        }
        let failed = Error::StiffnessNotPositiveDefinite { unknowns };
        let NodeMatrix {
            starts,
            columns,
            values,
        } = NodeMatrix::assemble(unknowns, &stiffness);
        let pattern = SymbolicSparseColMat::new_checked(unknowns, unknowns, starts, None, columns);
        let matrix = SparseColMat::new(pattern, values);
        let factor = SparseCholesky::new(&matrix).ok_or(failed)?;
        Ok(Elasticity {
            inertia: NodeMatrix::assemble(nodes, &inertia),
            thermal_load_x: NodeMatrix::assemble(nodes, &load_x),
            thermal_load_y: NodeMatrix::assemble(nodes, &load_y),
            factor,
            unknown,
            unknowns,
        })
    }

    /// Displacements under nodal loads, [N/m per metre of width]: `loads` and result are [`Fields`].
    pub fn solve(&self, loads: &Fields) -> Fields {
        let mut reduced = Mat::zeros(self.unknowns, loads.ncols());
        for field in 0..loads.ncols() {
            let (reduced, load) = (reduced.col_as_slice_mut(field), loads.col_as_slice(field));
            for (&unknown, load) in self.unknown.iter().zip(load).filter(|(u, _)| **u != usize::MAX) {
                reduced[unknown] = *load;
            }
        }
        self.factor.solve_in_place(&mut reduced);
        let mut displacements = Mat::zeros(loads.nrows(), loads.ncols());
        for field in 0..loads.ncols() {
            let (displacement, reduced) = (displacements.col_as_slice_mut(field), reduced.col_as_slice(field));
            for (&unknown, displacement) in self.unknown.iter().zip(displacement).filter(|(u, _)| **u != usize::MAX) {
                *displacement = reduced[unknown];
            }
        }
        displacements
    }

    /// The fields of unit loads at the contact nodes, along x₁ for all of them, then along x₂. The mesh is mirrored about
    /// x₁ = 0: those on the right are the mirror images of those on the left.
    pub fn unit_load_fields(&self, mesh: &Mesh) -> Fields {
        let n = mesh.contact_nodes;
        let half = n.div_ceil(2);
        let mut loads = Mat::zeros(2 * mesh.nodes(), 2 * half);
        for (i, column) in mesh.window().enumerate().take(half) {
            let node = mesh.node(column, 0);
            loads[(2 * node, i)] = 1.0;
            loads[(2 * node + 1, half + i)] = 1.0;
        }
        let left = self.solve(&loads);
        let mut fields = Mat::zeros(2 * mesh.nodes(), 2 * n);
        let height = 2 * mesh.rows();
        for direction in 0..2 {
            for i in 0..half {
                let solved = left.col_as_slice(direction * half + i);
                fields.col_as_slice_mut(direction * n + i).copy_from_slice(solved);
                // The mirror image of a load along x₁ is its opposite.
                let sign = if direction == 0 { 1.0 } else { -1.0 };
                let image = fields.col_as_slice_mut(direction * n + n - 1 - i);
                for (image, solved) in image.rchunks_exact_mut(height).zip(solved.chunks_exact(height)) {
                    for (image, solved) in image.chunks_exact_mut(2).zip(solved.chunks_exact(2)) {
                        image[0] = sign * solved[0];
                        image[1] = -sign * solved[1];
                    }
                }
            }
        }
        fields
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parameters::Parameters;

    #[test]
    fn mirrored_fields_are_the_solutions() {
        for contact_nodes in [20, 21] {
            let parameters = Parameters {
                contact_nodes,
                depth_nodes: 21,
                ..Parameters::default()
            };
            let mesh = Mesh::new(&parameters);
            let body = Elasticity::new(&mesh, parameters.lame_lambda, parameters.shear_modulus, 0.0).unwrap();
            let fields = body.unit_load_fields(&mesh);
            let mut loads = Mat::zeros(2 * mesh.nodes(), 2 * contact_nodes);
            for (i, column) in mesh.window().enumerate() {
                let node = mesh.node(column, 0);
                loads[(2 * node, i)] = 1.0;
                loads[(2 * node + 1, contact_nodes + i)] = 1.0;
            }
            let solved = body.solve(&loads);
            for field in 0..2 * contact_nodes {
                let (mirrored, solved) = (fields.col_as_slice(field), solved.col_as_slice(field));
                let size = crate::dense::largest(solved);
                // Round-off times the condition of a strip of some thousand nodes.
                assert!(crate::dense::largest_change(mirrored, solved) < 1e-10 * size, "{field}");
            }
        }
    }
}
