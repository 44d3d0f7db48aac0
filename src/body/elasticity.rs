//! P1 plane-strain elasticity (26)–(27): stiffness, convective inertia, thermal load, and the factorised solve.
//!
//! Weak form: ∫ σ(u):ε(v) − ρV² ∫ u,₁·v,₁ = α(3λ+2γ) ∫ θ div v + ∫_Γ F·v, u = 0 on Γ₀. The three bilinear forms are
//! assembled apart, because a step changes V and θ but never factorises.

use crate::body::mesh::Mesh;
use crate::error::{Error, Result};
use crate::numerics::sparse_cholesky::{SparseCholesky, WIDTH};
use faer::sparse::{SparseColMat, SymbolicSparseColMat};
use nalgebra::{DMatrix, Vector2};
use std::ops::AddAssign;

/// Displacement fields, one to a column: entry `(2 * node + direction, field)` in `m` (0 along x₁, 1 along x₂).
pub type Fields = DMatrix<f64>;

/// A sparse matrix between nodes (or unknowns), by rows.
#[derive(Debug, Clone)]
pub struct NodeMatrix<T> {
    starts: Vec<usize>,
    columns: Vec<usize>,
    values: Vec<T>,
}

/// The sums of element contributions to a [`NodeMatrix`], row by row.
struct Sums<T>(Vec<Vec<(usize, T)>>);

impl<T: Copy + AddAssign> Sums<T> {
    fn new(rows: usize) -> Sums<T> {
        // A node of the mesh has up to eight neighbours.
        Sums((0..rows).map(|_| Vec::with_capacity(9)).collect())
    }

    fn add(&mut self, row: usize, column: usize, value: T) {
        let row = &mut self.0[row];
        match row.iter_mut().find(|(c, _)| *c == column) {
            Some((_, sum)) => *sum += value,
            None => row.push((column, value)),
        }
    }

    /// Rows in ascending order of their columns.
    fn compressed(self) -> NodeMatrix<T> {
        let count = self.0.iter().map(Vec::len).sum();
        let mut matrix = NodeMatrix {
            starts: vec![0],
            columns: Vec::with_capacity(count),
            values: Vec::with_capacity(count),
        };
        for mut row in self.0 {
            row.sort_unstable_by_key(|(column, _)| *column);
            matrix.columns.extend(row.iter().map(|(c, _)| c));
            matrix.values.extend(row.iter().map(|(_, v)| v));
            matrix.starts.push(matrix.columns.len());
        }
        matrix
    }
}

impl<T: Copy> NodeMatrix<T> {
    /// Non-zero entries `(column, value)` of a row.
    pub fn row(&self, row: usize) -> impl Iterator<Item = (usize, T)> + '_ {
        let range = self.starts[row]..self.starts[row + 1];
        range.map(move |k| (self.columns[k], self.values[k]))
    }
}

/// The assembled forms of the rail.
pub struct Elasticity {
    /// ∫ N_i,₁ N_j,₁: the convective inertia is −ρV² times this, the same for both directions.
    pub inertia: NodeMatrix<f64>,
    /// ∫ ∇N_i N_j: load along x₁ and x₂ at node i of a unit thermal stress at node j.
    pub thermal_load: NodeMatrix<Vector2<f64>>,
    factor: SparseCholesky,
    /// The row in `factor` of each `2 * node + direction`, `None` where clamped.
    rows: Vec<Option<usize>>,
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
    /// V² to first order ([`crate::body::compliance`]), the tests use the whole form to bound that error.
    ///
    /// # Errors
    /// [`Error::StiffnessNotPositiveDefinite`]: above the Rayleigh speed the form is not coercive.
    pub fn new(mesh: &Mesh, lambda: f64, shear: f64, rho_v2: f64) -> Result<Elasticity> {
        let nodes = mesh.nodes();
        let mut unknown = vec![None; 2 * nodes];
        let mut unknowns = 0;
        for node in (0..nodes).filter(|&n| !mesh.is_clamped(n)) {
            for direction in 0..2 {
                unknown[2 * node + direction] = Some(unknowns);
                unknowns += 1;
            }
        }

        let mut stiffness = Sums::new(unknowns);
        let mut inertia = Sums::new(nodes);
        let mut thermal_load = Sums::new(nodes);
        for triangle in mesh.triangles() {
            let (grad, area) = gradients(triangle.nodes.map(|n| mesh.coordinates(n)));
            let measure = area * triangle.weight;
            for (i, &node_i) in triangle.nodes.iter().enumerate() {
                for (j, &node_j) in triangle.nodes.iter().enumerate() {
                    inertia.add(node_i, node_j, measure * grad[i][0] * grad[j][0]);
                    thermal_load.add(node_i, node_j, Vector2::from(grad[i]) * (measure / 3.0));
                    for a in 0..2 {
                        for b in 0..2 {
                            let (Some(row), Some(column)) = (unknown[2 * node_i + a], unknown[2 * node_j + b]) else {
                                continue;
                            };
                            // The upper triangle by rows is the lower one by columns.
                            if column < row {
                                continue;
                            }
                            // σ(u):ε(v) = λ div u div v + 2γ ε(u):ε(v)
                            let mut value = lambda * grad[i][a] * grad[j][b] + shear * grad[i][b] * grad[j][a];
                            if a == b {
                                value += shear * (grad[i][0] * grad[j][0] + grad[i][1] * grad[j][1])
                                    - rho_v2 * grad[i][0] * grad[j][0];
                            }
                            stiffness.add(row, column, measure * value);
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
        } = stiffness.compressed();
        let pattern = SymbolicSparseColMat::new_checked(unknowns, unknowns, starts, None, columns);
        let matrix = SparseColMat::new(pattern, values);
        let factor = SparseCholesky::new(&matrix).ok_or(failed)?;
        let rows = unknown
            .into_iter()
            .map(|unknown| unknown.map(|unknown| factor.row_of(unknown)))
            .collect();
        Ok(Elasticity {
            inertia: inertia.compressed(),
            thermal_load: thermal_load.compressed(),
            factor,
            rows,
            unknowns,
        })
    }

    /// Displacements under nodal loads, [N/m per metre of width]: `loads` and result are [`Fields`].
    #[cfg(any(test, feature = "verification"))]
    pub fn solve(&self, loads: &Fields) -> Fields {
        let mut displacements = Fields::zeros(loads.nrows(), loads.ncols());
        self.solve_each(
            loads.ncols(),
            |field| (0..loads.nrows()).map(move |place| (place, loads[(place, field)])),
            |place, first, values| {
                for (lane, value) in values.iter().enumerate() {
                    displacements[(place, first + lane)] = *value;
                }
            },
        );
        displacements
    }

    /// The fields of unit loads at the contact nodes, along x₁ for all of them, then along x₂. The mesh is mirrored about
    /// x₁ = 0: those on the right are the mirror images of those on the left.
    pub fn unit_load_fields(&self, mesh: &Mesh) -> Fields {
        let (n, rows) = (mesh.contact_nodes, mesh.rows());
        let half = n.div_ceil(2);
        let mut fields = Fields::zeros(2 * mesh.nodes(), 2 * n);
        self.solve_each(
            2 * half,
            |field| {
                let node = mesh.node(mesh.contact_column(field % half), 0);
                [(2 * node + field / half, 1.0)]
            },
            |place, first, values| {
                let (node, direction) = (place / 2, place % 2);
                let opposite = mesh.node(mesh.columns() - 1 - node / rows, node % rows);
                for (field, value) in (first..).zip(values) {
                    let (loaded, i) = (field / half, field % half);
                    // The mirror image of a load along x₁ is its opposite.
                    let sign = if loaded == direction { 1.0 } else { -1.0 };
                    fields[(2 * opposite + direction, loaded * n + n - 1 - i)] = sign * value;
                    fields[(place, loaded * n + i)] = *value;
                }
            },
        );
        fields
    }

    /// Solves for so many fields, [`WIDTH`] of them at a time: `load` gives the places `2 * node + direction` that a field
    /// loads and their loads; `take` receives a place, the first of some fields, and the displacements there in these.
    fn solve_each<L: IntoIterator<Item = (usize, f64)>>(
        &self,
        fields: usize,
        load: impl Fn(usize) -> L,
        mut take: impl FnMut(usize, usize, &[f64]),
    ) {
        let mut solution = vec![[0.0; WIDTH]; self.unknowns];
        for first in (0..fields).step_by(WIDTH) {
            let lanes = WIDTH.min(fields - first);
            solution.fill([0.0; WIDTH]);
            for field in first..first + lanes {
                for (place, value) in load(field) {
                    if let Some(row) = self.rows[place] {
                        solution[row][field - first] = value;
                    }
                }
            }
            self.factor.solve_in_place(&mut solution);
            for (place, row) in self.rows.iter().enumerate() {
                if let Some(row) = row {
                    take(place, first, &solution[*row][..lanes]);
                }
            }
        }
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
            let mut loads = Fields::zeros(2 * mesh.nodes(), 2 * contact_nodes);
            for (i, column) in mesh.window().enumerate() {
                let node = mesh.node(column, 0);
                loads[(2 * node, i)] = 1.0;
                loads[(2 * node + 1, contact_nodes + i)] = 1.0;
            }
            let solved = body.solve(&loads);
            for field in 0..2 * contact_nodes {
                let (mirrored, solved) = (fields.column(field), solved.column(field));
                let (mirrored, solved) = (mirrored.as_slice(), solved.as_slice());
                let size = crate::numerics::dense::largest(solved);
                // Round-off times the condition of a strip of some thousand nodes.
                assert!(
                    crate::numerics::dense::largest_change(mirrored, solved) < 1e-10 * size,
                    "{field}"
                );
            }
        }
    }
}
