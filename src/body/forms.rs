//! The bilinear forms of (27), element by element: gradients of the hat functions, convective inertia, thermal load.

use super::mesh::Mesh;
use nalgebra::DMatrix;

/// Displacement fields, one to a column: entry `(2 * node + direction, field)` in `m` (0 along x₁, 1 along x₂).
pub type Fields = DMatrix<f64>;

/// A triangle with its three hat functions.
#[derive(Debug, Clone, Copy)]
pub struct Element {
    /// Nodes of the triangle, anticlockwise.
    pub nodes: [usize; 3],
    /// Gradients of their hat functions, `1/m`.
    pub gradients: [[f64; 2]; 3],
    /// Area of the triangle times its weight, `m²`.
    pub measure: f64,
}

impl Element {
    fn new(nodes: [usize; 3], weight: f64, points: [[f64; 2]; 3]) -> Element {
        let [p, q, r] = points;
        let twice_area = (q[0] - p[0]) * (r[1] - p[1]) - (r[0] - p[0]) * (q[1] - p[1]);
        let side = |a: [f64; 2], b: [f64; 2]| [(a[1] - b[1]) / twice_area, (b[0] - a[0]) / twice_area];
        Element {
            nodes,
            gradients: [side(q, r), side(r, p), side(p, q)],
            measure: 0.5 * twice_area * weight,
        }
    }

    /// The terms of ∫ θ div v: load along x₁ and x₂ at each of the nodes of a unit thermal stress at any one of them.
    pub fn thermal_loads(&self) -> [[f64; 2]; 3] {
        self.gradients
            .map(|gradient| gradient.map(|g| g * (self.measure / 3.0)))
    }
}

/// The elements of a mesh.
pub fn elements(mesh: &Mesh) -> impl Iterator<Item = Element> + '_ {
    mesh.triangles().into_iter().map(|triangle| {
        Element::new(
            triangle.nodes,
            triangle.weight,
            triangle.nodes.map(|n| mesh.coordinates(n)),
        )
    })
}

/// K₁ Z of the fields Z: ∫ N_i,₁ u,₁, the loads of the convective inertia, which is −ρV² times this.
pub fn convective_inertia(mesh: &Mesh, fields: &Fields) -> Fields {
    let mut loads = Fields::zeros(fields.nrows(), fields.ncols());
    for element in elements(mesh) {
        for (displacement, mut load) in fields.column_iter().zip(loads.column_iter_mut()) {
            for direction in 0..2 {
                let slope: f64 = (0..3)
                    .map(|i| element.gradients[i][0] * displacement[2 * element.nodes[i] + direction])
                    .sum();
                for (node, gradient) in element.nodes.iter().zip(element.gradients) {
                    load[2 * node + direction] += element.measure * gradient[0] * slope;
                }
            }
        }
    }
    loads
}

/// Work ∫ N_i div u for each node i (row) and field: that of a unit thermal stress at the node on the field.
pub fn thermal_work(mesh: &Mesh, fields: &Fields) -> DMatrix<f64> {
    let mut work = DMatrix::zeros(mesh.nodes(), fields.ncols());
    for element in elements(mesh) {
        let loads = element.thermal_loads();
        for (displacement, mut work) in fields.column_iter().zip(work.column_iter_mut()) {
            let own: f64 = (0..3)
                .map(|i| {
                    let [along, upward] = [0, 1].map(|direction| displacement[2 * element.nodes[i] + direction]);
                    loads[i][0] * along + loads[i][1] * upward
                })
                .sum();
            for node in element.nodes {
                work[node] += own;
            }
        }
    }
    work
}

/// div u at the nodes, the mean over the triangles about each by their areas: nodes × fields.
pub fn dilatation(mesh: &Mesh, fields: &Fields) -> DMatrix<f64> {
    let mut areas = vec![0.0; mesh.nodes()];
    for element in elements(mesh) {
        for node in element.nodes {
            areas[node] += element.measure / 3.0;
        }
    }
    let mut dilatation = thermal_work(mesh, fields);
    for mut field in dilatation.column_iter_mut() {
        for (value, area) in field.iter_mut().zip(&areas) {
            *value /= area;
        }
    }
    dilatation
}
