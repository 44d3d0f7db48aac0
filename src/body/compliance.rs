//! The compliance of a body: factorise once, apply unit loads, keep the dense maps that a step uses (section 4.1 of the
//! paper).
//!
//! With u the surface displacement of the contact nodes and f the nodal forces on the rail,
//! u(V) = C(V) f + C_θ θ, C(V) = C(0) + ρV² Zᵀ K₁ Z, where the columns of Z are the fields of the unit loads and K₁ is
//! the convective inertia form. The error of C(V) is of order (V/c_R)⁴; C_θ is taken at V = 0, an error of order
//! (V/c_R)² in the thermal displacement alone.
//!
//! Everything is scaled: tractions by p₀, displacements by a²/r₀ of the largest load. Raw compliances of
//! 1e-11 m/N beside a 1 would wreck the row of the load constraint.

use crate::body::elasticity::{Elasticity, Fields};
use crate::body::mesh::Mesh;
use crate::parameters::Parameters;
use nalgebra::DMatrix;

/// The units in which the contact problem is solved.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scales {
    /// Hertz peak pressure p₀ at the largest load, `Pa`.
    pub pressure: f64,
    /// a²/r₀ at the largest load, `m`.
    pub displacement: f64,
}

impl Scales {
    /// Scales of the given parameters.
    pub fn new(parameters: &Parameters) -> Scales {
        let half_length = parameters.hertz_half_length(parameters.largest_load);
        Scales {
            pressure: parameters.hertz_peak_pressure(parameters.largest_load),
            displacement: half_length * half_length / parameters.wheel_radius,
        }
    }
}

/// Displacement of the n contact nodes per traction at the n contact nodes, all n × n and scaled. The first word is
/// the displacement (normal is upward), the second the traction on the rail.
#[derive(Debug, Clone)]
pub struct Compliance {
    /// C_nn.
    pub normal_normal: DMatrix<f64>,
    /// C_nt.
    pub normal_tangential: DMatrix<f64>,
    /// C_tn = C_ntᵀ.
    pub tangential_normal: DMatrix<f64>,
    /// C_tt.
    pub tangential_tangential: DMatrix<f64>,
}

/// The compliance at rest and its derivative with respect to ρV², `1/Pa`.
#[derive(Debug, Clone)]
pub struct RollingCompliance {
    /// C(0).
    pub at_rest: Compliance,
    /// dC/d(ρV²), `1/Pa`.
    pub inertia: Compliance,
}

/// Thermal displacement of the contact nodes: column `i` (along x₁) and `n + i` (along x₂), scaled, per kelvin at every
/// node of the mesh (row `node`). Nodes × 2n.
pub type ThermalDisplacement = DMatrix<f64>;

impl Compliance {
    /// Splits the 2n × 2n matrix of all displacements per force into its four blocks.
    fn from_blocks(all: &DMatrix<f64>, coupling: bool) -> Compliance {
        let n = all.nrows() / 2;
        let mixed = if coupling { 1.0 } else { 0.0 };
        Compliance {
            normal_normal: all.view((n, n), (n, n)).into_owned(),
            normal_tangential: all.view((n, 0), (n, n)).into_owned() * mixed,
            tangential_normal: all.view((0, n), (n, n)).into_owned() * mixed,
            tangential_tangential: all.view((0, 0), (n, n)).into_owned(),
        }
    }
}

/// Compliance of a body from its forms and its fields of the unit loads.
pub fn rolling_compliance(
    mesh: &Mesh,
    parameters: &Parameters,
    scales: &Scales,
    body: &Elasticity,
    fields: &Fields,
) -> RollingCompliance {
    // A nodal force is the traction times the tributary length.
    let traction = scales.pressure * mesh.contact_spacing() / scales.displacement;
    let coupling = parameters.normal_tangential_coupling;
    RollingCompliance {
        at_rest: Compliance::from_blocks(&(surface_displacement(mesh, fields) * traction), coupling),
        inertia: Compliance::from_blocks(&(inertia_form(body, fields) * traction), coupling),
    }
}

/// The fields at the contact nodes: 2n × 2n, symmetric.
fn surface_displacement(mesh: &Mesh, fields: &Fields) -> DMatrix<f64> {
    let n = mesh.contact_nodes;
    let dof = |i: usize| 2 * mesh.node(mesh.contact_column(i % n), 0) + i / n;
    // By reciprocity the two are equal but for round-off; their mean makes the matrix exactly symmetric.
    DMatrix::from_fn(2 * n, 2 * n, |i, j| 0.5 * (fields[(dof(i), j)] + fields[(dof(j), i)]))
}

/// Zᵀ K₁ Z of the fields Z: 2n × 2n, symmetric.
fn inertia_form(rail: &Elasticity, fields: &Fields) -> DMatrix<f64> {
    let n = fields.ncols() / 2;
    // Mirrored fields give mirrored entries: only the images of the left half are computed.
    let half = n.div_ceil(2);
    let left = |field: usize| field / half * n + field % half;
    let mut image = Fields::zeros(fields.nrows(), 2 * half);
    for field in 0..2 * half {
        let displacement = fields.column(left(field));
        for node in 0..fields.nrows() / 2 {
            for (other, value) in rail.inertia.row(node) {
                image[(2 * node, field)] += value * displacement[2 * other];
                image[(2 * node + 1, field)] += value * displacement[2 * other + 1];
            }
        }
    }
    let product = fields.transpose() * &image;
    let mut form: DMatrix<f64> = DMatrix::zeros(2 * n, 2 * n);
    for field in 0..2 * half {
        let (direction, j) = (field / half, field % half);
        // With j the outer one of two contact nodes: of the four entries that are equal but for their sign, one is taken.
        for (other, i) in (j..n - j).flat_map(|i| [(0, i), (1, i)]) {
            let value = product[(other * n + i, field)];
            let image = if direction == other { value } else { -value };
            form[(other * n + i, direction * n + j)] = value;
            form[(direction * n + j, other * n + i)] = value;
            form[(other * n + n - 1 - i, direction * n + n - 1 - j)] = image;
            form[(direction * n + n - 1 - j, other * n + n - 1 - i)] = image;
        }
    }
    form
}

/// Adjoint of the thermal load: the displacement at a contact node caused by a unit thermal stress at a node is the
/// work of that stress on the contact node's unit-load field. Nodes × 2n. The displacements on the right are the mirror
/// images of those on the left, u₁ with the opposite sign.
pub fn thermal_displacement(mesh: &Mesh, rail: &Elasticity, fields: &Fields) -> ThermalDisplacement {
    let (n, nodes) = (mesh.contact_nodes, mesh.nodes());
    let mut map = ThermalDisplacement::zeros(nodes, 2 * n);
    for (direction, sign) in [(0, -1.0), (1, 1.0)] {
        for i in 0..n.div_ceil(2) {
            let (left, right) = (direction * n + i, direction * n + n - 1 - i);
            let (own, rest) = map.as_mut_slice()[nodes * left..nodes * (right + 1)].split_at_mut(nodes);
            for (node, displacement) in fields.column(left).as_slice().chunks_exact(2).enumerate() {
                for (heated, load) in rail.thermal_load.row(node) {
                    own[heated] += load.x * displacement[0] + load.y * displacement[1];
                }
            }
            // The middle node is its own mirror image.
            let image = rest.rchunks_exact_mut(nodes).next().unwrap_or_default();
            for (image, own) in image.rchunks_exact_mut(mesh.rows()).zip(own.chunks_exact(mesh.rows())) {
                for (image, own) in image.iter_mut().zip(own) {
                    *image = sign * own;
                }
            }
        }
    }
    map
}
