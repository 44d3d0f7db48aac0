//! P1 plane-strain elasticity (26)–(27): the stiffness, factorised, and what is solved with it.
//!
//! Weak form: ∫ σ(u):ε(v) − ρV² ∫ u,₁·v,₁ = α(3λ+2γ) ∫ θ div v + ∫_Γ F·v, u given on Γ₀: zero but for [`super::remainder`].
//! Inertia and thermal load stand in [`super::forms`], because a step changes V and θ but never factorises.

use super::forms::{Fields, elements};
use super::mesh::Mesh;
use crate::error::{Error, Result};
use crate::numerics::band_cholesky::Band;

/// Fields that are solved for together where there are many.
const MANY: usize = 32;

/// One entry of the stiffness between a free and a clamped displacement.
struct StiffnessEntry {
    /// Index `2 * node + direction` of the displacement.
    free: usize,
    /// Index `2 * node + direction` of the displacement.
    clamped: usize,
    stiffness: f64,
}

/// The factorised body.
pub struct Elasticity {
    factor: Band,
    /// The row in `factor` of each `2 * node + direction`, `None` where clamped.
    rows: Vec<Option<usize>>,
    unknowns: usize,
    boundary: Vec<StiffnessEntry>,
}

impl Elasticity {
    /// Assembles and factorises. `rho_v2` = ρV² enters the factorised matrix itself; the model uses 0 and carries
    /// V² to first order ([`crate::body::compliance`]), the tests use the whole form to bound that error.
    ///
    /// # Errors
    /// [`Error::StiffnessNotPositiveDefinite`]: above the Rayleigh speed the form is not coercive.
    pub fn new(mesh: &Mesh, lambda: f64, shear: f64, rho_v2: f64) -> Result<Elasticity> {
        let nodes = mesh.nodes();
        let mut rows = vec![None; 2 * nodes];
        let mut unknowns = 0;
        for node in (0..nodes).filter(|&n| !mesh.is_clamped(n)) {
            for direction in 0..2 {
                rows[2 * node + direction] = Some(unknowns);
                unknowns += 1;
            }
        }

        // Nodes are numbered column by column: none is coupled further than to the next column's.
        let mut stiffness = Band::new(unknowns, 2 * (mesh.rows() + 1) + 1);
        let mut boundary = Vec::new();
        for element in elements(mesh) {
            let grad = element.gradients;
            for (i, node_i) in element.nodes.into_iter().enumerate() {
                for (j, node_j) in element.nodes.into_iter().enumerate() {
                    for (a, b) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                        let (place, other) = (2 * node_i + a, 2 * node_j + b);
                        let Some(row) = rows[place] else {
                            continue;
                        };
                        // The lower triangle is enough.
                        if rows[other].is_some_and(|column| row < column) {
                            continue;
                        }
                        // σ(u):ε(v) = λ div u div v + 2γ ε(u):ε(v)
                        let mut value = lambda * grad[i][a] * grad[j][b] + shear * grad[i][b] * grad[j][a];
                        if a == b {
                            value += shear * (grad[i][0] * grad[j][0] + grad[i][1] * grad[j][1])
                                - rho_v2 * grad[i][0] * grad[j][0];
                        }
                        value *= element.measure;
                        match rows[other] {
                            Some(column) => stiffness.add(row, column, value),
                            None => boundary.push(StiffnessEntry {
                                free: place,
                                clamped: other,
                                stiffness: value,
                            }),
                        }
                    }
                }
            }
        }
        let failed = Error::StiffnessNotPositiveDefinite { unknowns };
        Ok(Elasticity {
            factor: stiffness.factorised().ok_or(failed)?,
            rows,
            unknowns,
            boundary,
        })
    }

    /// Displacements under nodal loads, [N/m per metre of width]: `loads` and result are [`Fields`].
    #[cfg(any(test, feature = "verification"))]
    pub fn solve(&self, loads: &Fields) -> Fields {
        let mut displacements = Fields::zeros(loads.nrows(), loads.ncols());
        self.solve_each::<MANY, _>(
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
        self.solve_each::<MANY, _>(
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

    /// Fields without load whose displacement on Γ₀ is given by position, one field after the other.
    pub fn fields_by_boundary<const FIELDS: usize>(
        &self,
        mesh: &Mesh,
        displacement: impl Fn([f64; 2]) -> [[f64; 2]; FIELDS],
    ) -> Fields {
        let mut fields = Fields::zeros(2 * mesh.nodes(), FIELDS);
        for node in (0..mesh.nodes()).filter(|&node| mesh.is_clamped(node)) {
            for (field, value) in displacement(mesh.coordinates(node)).into_iter().enumerate() {
                fields[(2 * node, field)] = value[0];
                fields[(2 * node + 1, field)] = value[1];
            }
        }
        // K_ff u_f = −K_fc u_c.
        let given = fields.clone();
        self.solve_each::<FIELDS, _>(
            FIELDS,
            |field| {
                let given = given.column(field);
                self.boundary
                    .iter()
                    .map(move |entry| (entry.free, -entry.stiffness * given[entry.clamped]))
            },
            |place, first, values| {
                for (lane, value) in values.iter().enumerate() {
                    fields[(place, first + lane)] = *value;
                }
            },
        );
        fields
    }

    /// Solves for so many fields, `WIDTH` of them at a time: `load` gives the places `2 * node + direction` that a field
    /// loads and their loads, which add up; `take` receives a place, the first of some fields, and the displacements there
    /// in these.
    fn solve_each<const WIDTH: usize, L: IntoIterator<Item = (usize, f64)>>(
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
                        solution[row][field - first] += value;
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

    /// A linear displacement has constant stress: in the strip below a free surface it is the solution where it leaves the
    /// surface free, ε₂₂ = −λ/(λ+2γ) ε₁₁ without shear. Linear triangles have it exactly.
    #[test]
    fn given_displacements_of_the_boundary_stretch_the_strip() {
        let parameters = Parameters {
            contact_nodes: 20,
            depth_nodes: 21,
            ..Parameters::default()
        };
        let mesh = Mesh::new(&parameters);
        let (lambda, shear) = (parameters.lame_lambda, parameters.shear_modulus);
        let body = Elasticity::new(&mesh, lambda, shear, 0.0).unwrap();
        let stretched = |[x, y]: [f64; 2]| [x, -lambda / (lambda + 2.0 * shear) * y];
        // The second is a rotation by a small angle.
        let turned = |[x, y]: [f64; 2]| [-y, x];
        let fields = body.fields_by_boundary(&mesh, |point| [stretched(point), turned(point)]);
        for node in 0..mesh.nodes() {
            for (field, exact) in [stretched(mesh.coordinates(node)), turned(mesh.coordinates(node))]
                .iter()
                .enumerate()
            {
                for (direction, exact) in exact.iter().enumerate() {
                    let error = fields[(2 * node + direction, field)] - exact;
                    assert!(error.abs() < 1e-10, "{node} {field} {direction}: {error:e}");
                }
            }
        }
    }
}
