//! Thermal displacement of the contact nodes: the adjoint of the compliance.
//!
//! The displacement at a contact node by a thermal stress σ_θ = α(3λ+2γ)θ is the work ∫ σ_θ div Z that it does on the field Z
//! of a unit force there. Z is the half-plane's field and a remainder ([`super::remainder`]), which hardly changes over
//! a cell. The dilatation of the half-plane has a closed form, div Z_c = D x_c/r² with D = −(1−2ν)/(πγ), and is singular at the
//! contact node: its integral over a heated node's share of the temperature is taken in closed form as well. The temperature is linear
//! along x₁ between columns and the mean of two rows between these. With t the distance from the contact node along x₁
//! and z the depth, and the functions
//!
//! F₁ = −½ (t² − z²) arctan(t/z) + ½ z t ln(t² + z²),  F₂ = −¼ (t² − z²) ln(t² + z²) − t z arctan(t/z),
//!
//! ∂²F₁/∂t² = const(t) − arctan(t/z) and ∂²F₂/∂t² = const − ½ ln(t² + z²), whose difference between two depths is the
//! integral of t/r² and of −z/r² over the depth between. The integral over t with a hat function is the difference
//! between the slopes of F on both sides of the column.

use super::compliance::ThermalDisplacement;
use super::half_plane::HalfPlane;
use super::mesh::Mesh;
use super::remainder::Remainder;
use crate::numerics::arctangent::arctangent;
use crate::numerics::dense;
use nalgebra::DMatrix;

/// Displacement of the contact nodes per thermal stress at the nodes of the mesh, nodes × 2n, `m/Pa`. Those on the right are
/// the mirror images of those on the left, u₁ with the opposite sign.
pub fn displacement(mesh: &Mesh, material: &HalfPlane, remainder: &Remainder) -> ThermalDisplacement {
    let (n, nodes, rows) = (mesh.contact_nodes, mesh.nodes(), mesh.rows());
    let mut map = ThermalDisplacement::zeros(nodes, 2 * n);
    let remainders = remainder_work(mesh, remainder);
    let window = WindowTable::new(mesh);
    let mut functions = [vec![0.0; nodes], vec![0.0; nodes]];
    let mut bends = Bends::new(rows);
    for i in 0..n.div_ceil(2) {
        let position = mesh.contact_position(i);
        window.functions(mesh, i, &mut functions);
        for (direction, sign) in [(0, -1.0), (1, 1.0)] {
            let (left, right) = (direction * n + i, direction * n + n - 1 - i);
            let (own, rest) = map.as_mut_slice()[nodes * left..nodes * (right + 1)].split_at_mut(nodes);
            for (place, share) in remainder.shares(position).into_iter().enumerate() {
                dense::add_multiple(remainders.column(3 * direction + place).as_slice(), share, own);
            }
            bends.add_work(
                mesh,
                &functions[direction],
                position,
                direction,
                material.dilatation(),
                own,
            );
            // The middle node is its own mirror image.
            let image = rest.rchunks_exact_mut(nodes).next().unwrap_or_default();
            for (image, own) in image.rchunks_exact_mut(rows).zip(own.chunks_exact(rows)) {
                for (image, own) in image.iter_mut().zip(own) {
                    *image = sign * own;
                }
            }
        }
    }
    map
}

/// Work ∫ N_j div u on the fields of the remainder's forces for each node j: nodes × 6.
fn remainder_work(mesh: &Mesh, remainder: &Remainder) -> DMatrix<f64> {
    let share = |points: &[f64], i: usize| 0.5 * (points[(i + 1).min(points.len() - 1)] - points[i.saturating_sub(1)]);
    let mut work = remainder.dilatation(mesh);
    for mut force in work.column_iter_mut() {
        for (column, nodes) in force.as_mut_slice().chunks_exact_mut(mesh.rows()).enumerate() {
            let width = share(&mesh.x, column);
            for (row, value) in nodes.iter_mut().enumerate() {
                *value *= width * share(&mesh.depth, row);
            }
        }
    }
    work
}

/// Functions `[F₁, F₂]` at a distance along x₁ and a depth.
fn functions(t: f64, z: f64) -> [f64; 2] {
    let square = t * t + z * z;
    if square == 0.0 {
        return [0.0; 2];
    }
    let (logarithm, angle) = (square.ln(), arctangent(t / z));
    let difference = 0.5 * (t * t - z * z);
    [
        -difference * angle + 0.5 * z * t * logarithm,
        -0.5 * difference * logarithm - t * z * angle,
    ]
}

/// Slopes `[∂F₁/∂t, ∂F₂/∂t]` of the functions.
fn slopes(t: f64, z: f64) -> [f64; 2] {
    let (logarithm, angle) = ((t * t + z * z).ln(), arctangent(t / z));
    [
        -t * angle + 0.5 * z * (logarithm + 1.0),
        -0.5 * t * (logarithm + 1.0) - z * angle,
    ]
}

/// F₁ and F₂ at the distances of 0, 1, … n − 1 nodes of the window, where all contact nodes share them; row by row of the
/// mesh for each distance.
struct WindowTable(Vec<[f64; 2]>);

impl WindowTable {
    fn new(mesh: &Mesh) -> WindowTable {
        let spacing = mesh.contact_spacing();
        let distances = (0..mesh.contact_nodes).map(|cells| cells as f64 * spacing);
        WindowTable(
            distances
                .flat_map(|t| mesh.depth.iter().map(move |&z| functions(t, z)))
                .collect(),
        )
    }

    /// F₁ and F₂ at all nodes of the mesh, from a contact node.
    fn functions(&self, mesh: &Mesh, contact_node: usize, [first, second]: &mut [Vec<f64>; 2]) {
        let rows = mesh.rows();
        let position = mesh.contact_position(contact_node);
        let columns = first.chunks_exact_mut(rows).zip(second.chunks_exact_mut(rows));
        for (column, (first, second)) in columns.enumerate() {
            let values = first.iter_mut().zip(second);
            if mesh.window().contains(&column) {
                let node = column - mesh.first_contact;
                let cells = node.abs_diff(contact_node);
                // F₁ is odd in t, F₂ even.
                let sign = if node < contact_node { -1.0 } else { 1.0 };
                for ((first, second), table) in values.zip(&self.0[cells * rows..(cells + 1) * rows]) {
                    (*first, *second) = (sign * table[0], table[1]);
                }
            } else {
                for ((first, second), z) in values.zip(&mesh.depth) {
                    [*first, *second] = functions(mesh.x[column] - position, *z);
                }
            }
        }
    }
}

/// Slopes ∂F/∂t on the left and on the right of a column, row by row, and their difference.
struct Bends {
    left: Vec<f64>,
    right: Vec<f64>,
    bend: Vec<f64>,
}

impl Bends {
    fn new(rows: usize) -> Bends {
        Bends {
            left: vec![0.0; rows],
            right: vec![0.0; rows],
            bend: vec![0.0; rows],
        }
    }

    /// Adds the work on the half-plane's field of a contact node at `position`, `factor` times the integrals of x_c/r².
    fn add_work(
        &mut self,
        mesh: &Mesh,
        values: &[f64],
        position: f64,
        direction: usize,
        factor: f64,
        work: &mut [f64],
    ) {
        let (rows, columns) = (mesh.rows(), mesh.columns());
        // The end columns have half a hat.
        let end = |column: usize, slope: &mut [f64]| {
            for (slope, &z) in slope.iter_mut().zip(&mesh.depth) {
                *slope = slopes(mesh.x[column] - position, z)[direction];
            }
        };
        end(0, &mut self.left);
        for (column, work) in work.chunks_exact_mut(rows).enumerate() {
            if column + 1 < columns {
                let inverse = 1.0 / (mesh.x[column + 1] - mesh.x[column]);
                let (own, next) = values[column * rows..(column + 2) * rows].split_at(rows);
                for ((slope, own), next) in self.right.iter_mut().zip(own).zip(next) {
                    *slope = (next - own) * inverse;
                }
            } else {
                end(column, &mut self.right);
            }
            for ((bend, left), right) in self.bend.iter_mut().zip(&self.left).zip(&self.right) {
                *bend = 0.5 * factor * (right - left);
            }
            // A node has half of the depth above it and half of that below.
            for (work, pair) in work.iter_mut().zip(self.bend.windows(2)) {
                *work += pair[1] - pair[0];
            }
            for (work, pair) in work[1..].iter_mut().zip(self.bend.windows(2)) {
                *work += pair[1] - pair[0];
            }
            std::mem::swap(&mut self.left, &mut self.right);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::elasticity::Elasticity;
    use crate::body::unit_loads;
    use crate::parameters::Parameters;

    /// Heat in a skin of a tenth of a millimetre: more and more of it towards the rear of the contact, then cooling.
    fn temperature(x: f64, z: f64) -> f64 {
        (-(x / 2e-3).powi(2) - (z / 1e-4).powi(2)).exp() * (1.0 - 200.0 * x)
    }

    /// The temperature between the nodes of the mesh: bilinear.
    fn between_nodes(mesh: &Mesh, x: f64, z: f64) -> f64 {
        let place = |points: &[f64], at: f64| {
            let first = points.partition_point(|&p| p <= at).clamp(1, points.len() - 1) - 1;
            (points[first], points[first + 1])
        };
        let ((left, right), (above, below)) = (place(&mesh.x, x), place(&mesh.depth, z));
        let (to_right, down) = ((x - left) / (right - left), (z - above) / (below - above));
        let at = |x: f64| temperature(x, above) * (1.0 - down) + temperature(x, below) * down;
        at(left) * (1.0 - to_right) + at(right) * to_right
    }

    /// D ∫ θ x_c/r² over the half-plane: with t = z sinh s, that is D ∫∫ θ (tanh s, −1/cosh s) ds dz, by the midpoint rule.
    fn on_the_half_plane(mesh: &Mesh, factor: f64, position: f64) -> [f64; 2] {
        let mut sums = [0.0; 2];
        for rows in mesh.depth.windows(2).filter(|rows| rows[0] < 6e-4) {
            let depths = 8;
            let thickness = (rows[1] - rows[0]) / f64::from(depths);
            for i in 0..depths {
                let z = rows[0] + thickness * (f64::from(i) + 0.5);
                let (points, end) = (600, (0.02_f64 / z).asinh());
                let step = 2.0 * end / f64::from(points);
                for j in 0..points {
                    let s = (f64::from(j) + 0.5) * step - end;
                    let value = between_nodes(mesh, position + z * s.sinh(), z) * step * thickness;
                    sums[0] += factor * value * s.tanh();
                    sums[1] -= factor * value / s.cosh();
                }
            }
        }
        sums
    }

    struct Case {
        mesh: Mesh,
        material: HalfPlane,
        remainder: Remainder,
        body: Elasticity,
    }

    impl Case {
        fn new(contact_nodes: usize, depth_nodes: usize) -> Case {
            let parameters = Parameters {
                contact_nodes,
                depth_nodes,
                ..Parameters::default()
            };
            let mesh = Mesh::new(&parameters);
            let (lambda, shear) = (parameters.lame_lambda, parameters.shear_modulus);
            Case {
                material: HalfPlane::new(lambda, shear),
                remainder: Remainder::new(&parameters, lambda, shear).unwrap(),
                body: Elasticity::new(&mesh, lambda, shear, 0.0).unwrap(),
                mesh,
            }
        }

        fn of(&self, map: &ThermalDisplacement, temperature: impl Fn(f64, f64) -> f64) -> Vec<f64> {
            let field = DMatrix::from_fn(self.mesh.nodes(), 1, |node, _| {
                let [x, y] = self.mesh.coordinates(node);
                temperature(x, -y)
            });
            map.tr_mul(&field).as_slice().to_vec()
        }

        fn by_finite_elements(&self) -> ThermalDisplacement {
            unit_loads::thermal_displacement(&self.mesh, &self.body.unit_load_fields(&self.mesh))
        }

        /// Largest error of a map along x₁ and upward, over the largest displacement. A rigid shift along x₁ does nothing.
        fn error(&self, map: &ThermalDisplacement) -> [f64; 2] {
            let n = self.mesh.contact_nodes;
            let places = self.of(&remainder_work(&self.mesh, &self.remainder), temperature);
            let computed = self.of(map, temperature);
            // Every sixth node of 61, the middle one in the middle.
            let nodes = (0..n).step_by((n - 1) / 10);
            let (exact, errors): (Vec<[f64; 2]>, Vec<[f64; 2]>) = nodes
                .map(|i| {
                    let position = self.mesh.contact_position(i);
                    let exact = on_the_half_plane(&self.mesh, self.material.dilatation(), position);
                    let shares = self.remainder.shares(position);
                    let error = [0, 1].map(|direction| {
                        let remainder: f64 = (0..3).map(|place| shares[place] * places[3 * direction + place]).sum();
                        computed[direction * n + i] - remainder - exact[direction]
                    });
                    (exact, error)
                })
                .unzip();
            let largest = |values: &[[f64; 2]], direction: usize, shift: f64| {
                values.iter().map(|u| (u[direction] - shift).abs()).fold(0.0, f64::max)
            };
            [
                largest(&errors, 0, errors[errors.len() / 2][0]) / largest(&exact, 0, 0.0),
                largest(&errors, 1, 0.0) / largest(&exact, 1, 0.0),
            ]
        }

        fn map(&self) -> ThermalDisplacement {
            displacement(&self.mesh, &self.material, &self.remainder)
        }
    }

    /// The field between the nodes is the linear one that the march has. Finite elements displace by a hundredth too little on
    /// the same mesh.
    #[test]
    fn the_heat_of_a_contact_displaces_as_the_integral_says() {
        let (coarse, fine) = (Case::new(61, 41), Case::new(121, 81));
        let elements = coarse.error(&coarse.by_finite_elements());
        let (coarse, fine) = (coarse.error(&coarse.map()), fine.error(&fine.map()));
        for direction in 0..2 {
            // A row's mean in place of the linear temperature: the rows are a third of the skin.
            assert!(coarse[direction] < 2e-3, "{direction}: {coarse:?}");
            assert!(5.0 * coarse[direction] < elements[direction], "{coarse:?} {elements:?}");
            let order = (coarse[direction] / fine[direction]).log2();
            assert!((order - 2.0).abs() < 0.3, "{direction}: {order}");
        }
    }

    /// A strip that is warm all along, and one that is warm from the middle on: the remainder counts as much as the half-plane.
    #[test]
    fn the_heat_of_the_strip_displaces_as_finite_elements_say() {
        let case = Case::new(61, 41);
        let n = case.mesh.contact_nodes;
        let maps = [case.map(), case.by_finite_elements()];
        for skin in [5e-3, 2e-2] {
            for front in [-10.0, 0.0] {
                let warm = |x: f64, z: f64| if x >= front { (-(z / skin).powi(2)).exp() } else { 0.0 };
                let [closed, elements] = [&maps[0], &maps[1]].map(|map| case.of(map, warm));
                // A rigid shift along x₁ does nothing.
                let shift = closed[n / 2] - elements[n / 2];
                for i in 0..n {
                    let along = closed[i] - shift - elements[i];
                    let upward = closed[n + i] - elements[n + i];
                    // What the finite elements' mesh is wrong by.
                    let size = dense::largest(&elements[n..]);
                    assert!(along.abs() < 1e-2 * size, "{skin} {front} {i}: {along:e} {size:e}");
                    assert!(upward.abs() < 1e-2 * size, "{skin} {front} {i}: {upward:e} {size:e}");
                }
            }
        }
    }
}
