//! Operators of a patch: everything that is computed once, at initialisation.

use super::expansion::Expansion;
use super::kernels::Kernels;
use crate::body::compliance::Scales;
use crate::body::grid::Grid;
use crate::body::half_space::HalfSpaces;
use crate::body::influence::{Tables, Transform};
use crate::body::mesh::Mesh;
use crate::error::Result;
use crate::geometry::gap;
use crate::heat::basis::DepthBasis;
use crate::heat::incoming::Incoming;
use crate::mechanics::leading_edge::LAYER_STRAIN;
use crate::mechanics::patch::normal::{NarrowInfluence, NormalInfluence};
use crate::parameters::Parameters;
use crate::transport::strips::Strips;
use std::f64::consts::PI;

/// Columns outside the window on each side at 61 cells, as on the line's mesh.
const OUTER_COLUMNS: f64 = 24.0;
/// First cell under the surface at 41 depth nodes, `m`, as on the line's mesh.
const FIRST_DEPTH: f64 = 10e-6;
/// Fractions of the strips for which there are transforms of their own: the contact at the default load has 0.7 of the strips.
const NARROW: [f64; 3] = [0.35, 0.55, 0.76];
/// ℓ over the product of compliance and creep stiffness: chosen, as the best of 0.36, 0.48, 0.6, 0.75 and 0.96 for jumps of the creepage along and
/// across, in steps of any length against short ones. The verification's "Patch: jump of the creepage" has the error that it leaves; with a
/// quarter more or less the force is off by half as much again or more.
const RELAXATION_FACTOR: f64 = 0.6;

/// The rail and the wheel's profile, built at initialisation.
pub struct PatchOperators {
    /// The cells.
    pub grid: Grid,
    /// Units of the contact problem.
    pub scales: Scales,
    /// Products on the grid.
    pub transform: Transform,
    /// NormalInfluence by pressure, scaled.
    pub normal_influence: NormalInfluence,
    /// Displacement u by shear, scaled.
    pub displacement: Tables<f64>,
    /// Transforms that serve fewer strips, ascending, with the tables of u by shear for them: a product costs as much as it serves
    /// strips.
    pub narrow: Vec<(Transform, Tables<f64>)>,
    /// Normal influence for fewer strips, ascending, for windows whose contact is known to be within a part of them; none else.
    pub narrow_normal: Vec<NarrowInfluence>,
    /// The kernels of u_x by τ_x and of u_y by τ_y of a strip on itself, by the lag along x, as the tables have it.
    pub strip_kernels: [Vec<f64>; 2],
    /// Displacement u by pressure, and with the same tables the upward displacement by shear, scaled; none where the bodies are alike.
    pub coupling: Option<Tables<f64>>,
    /// Displacement by heat.
    pub expansion: Expansion,
    /// Factors of the leading-edge correction along x and y: jump of u out of the contact over that of the gap, per τ/p.
    pub edge_factors: [f64; 2],
    /// Undeformed gap of the cells, scaled, on the grid.
    pub gap: Vec<f64>,
    /// The marches across columns.
    pub strips: Strips,
    /// Depths of the rows, `m`.
    pub depth: Vec<f64>,
    /// Eigenbasis of the depth operator.
    pub basis: DepthBasis,
    /// Profile of the temperature that enters.
    pub incoming: Incoming,
    /// ℓ at the largest load, `m`.
    pub relaxation_length: f64,
}

impl PatchOperators {
    /// Computes grid, influence and depth modes.
    ///
    /// # Errors
    /// [`crate::error::Error::DepthBasis`].
    pub fn build(parameters: &Parameters) -> Result<PatchOperators> {
        let (half_length, half_breadth) = parameters.patch_window();
        let grid = Grid::new(
            parameters.patch_nodes,
            parameters.patch_strips,
            half_length,
            half_breadth,
        );
        PatchOperators::on_grid(parameters, grid, &[])
    }

    /// Computes influence and depth modes for a grid, with transforms of the normal influence for so many strips, ascending.
    ///
    /// # Errors
    /// [`crate::error::Error::DepthBasis`].
    pub fn on_grid(parameters: &Parameters, grid: Grid, narrow_normal: &[usize]) -> Result<PatchOperators> {
        let ellipse = parameters.hertz_ellipse(parameters.largest_load);
        let scales = Scales {
            pressure: ellipse.peak_pressure,
            displacement: ellipse.approach,
        };
        let pair = HalfSpaces::of_pair(parameters);
        let transform = Transform::new(&grid, grid.strips);
        let unit = scales.compliance(1.0);
        let layer = unit * parameters.layer_compliance;
        let kernels = Kernels::new(&pair, &grid, &transform, unit, layer);
        let mesh = graded_mesh(parameters, &grid);
        let basis = DepthBasis::new(&mesh.depth)?;
        Ok(PatchOperators {
            normal_influence: NormalInfluence::new(&grid, &transform, |lag| kernels.normal(lag)),
            displacement: shear_tables(&kernels, &transform),
            narrow: NARROW
                .map(|share| Transform::new(&grid, (share * grid.strips as f64).ceil() as usize))
                .into_iter()
                .filter(|narrow| narrow.strips() < transform.strips())
                .map(|narrow| {
                    let tables = shear_tables(&kernels, &narrow);
                    (narrow, tables)
                })
                .collect(),
            narrow_normal: narrow_normal
                .iter()
                .map(|&strips| NarrowInfluence::new(Transform::new(&grid, strips), |lag| kernels.normal(lag)))
                .collect(),
            strip_kernels: strip_kernels(&kernels, &grid),
            coupling: kernels.coupling(&transform),
            expansion: Expansion::new(
                parameters,
                &grid,
                &transform,
                parameters.strip_half_length,
                scales.displacement,
            ),
            edge_factors: edge_factors(&pair, layer / (unit * grid.length)),
            gap: {
                let mut gap = vec![0.0; grid.len()];
                gap_of_curvatures(&grid, &scales, parameters.gap_curvatures(), &mut gap);
                gap
            },
            strips: Strips::new(&mesh.x, mesh.window(), grid.strips, grid.breadth),
            incoming: Incoming::new(&mesh.depth, &basis, parameters.skin_depth),
            depth: mesh.depth,
            basis,
            relaxation_length: relaxation_length(&pair, parameters.layer_compliance, (ellipse.along, ellipse.across)),
            transform,
            grid,
            scales,
        })
    }

    /// Transform and tables of u by shear for a contact on so many strips.
    pub fn transform_for(&self, strips: usize) -> (&Transform, &Tables<f64>) {
        let narrow = self.narrow.iter().find(|(transform, _)| transform.strips() >= strips);
        narrow.map_or((&self.transform, &self.displacement), |(transform, tables)| {
            (transform, tables)
        })
    }

    /// Force of a scaled traction of 1 on a cell, `N`.
    pub fn unit_force(&self) -> f64 {
        self.grid.cell_area() * self.scales.pressure
    }
}

/// Tables of u by shear.
fn shear_tables(kernels: &Kernels, transform: &Transform) -> Tables<f64> {
    transform.tables(
        |lag| kernels.along(lag),
        |lag| kernels.mixed(lag),
        |lag| kernels.across(lag),
    )
}

/// Kernels of u_x by τ_x and of u_y by τ_y of a strip on itself, by the lag along x, as long as the rows of the tables.
fn strip_kernels(kernels: &Kernels, grid: &Grid) -> [Vec<f64>; 2] {
    let stride = grid.stride() as isize;
    let lags = || (0..2 * stride + 8).map(|place| (place - stride, 0));
    [
        lags().map(|lag| kernels.along(lag)).collect(),
        lags().map(|lag| kernels.across(lag)).collect(),
    ]
}

/// Factors of the leading-edge correction. The edges of the strips are nearly straight: the pressure of a cell displaces half-planes by
/// 2Δ/E*, 1/E* = π normal. `layer` is the compliance of the layer over the length of a cell, `1/Pa`.
fn edge_factors(pair: &HalfSpaces, layer: f64) -> [f64; 2] {
    let edge = LAYER_STRAIN * layer / (2.0 * PI * pair.normal());
    [1.0 + edge, pair.direct / pair.normal() + edge]
}

/// Computes the undeformed gap A x² + B y² of the cells, or its change with that of the curvatures, scaled, on the grid.
pub fn gap_of_curvatures(grid: &Grid, scales: &Scales, (along, across): (f64, f64), gap: &mut [f64]) {
    for strip in 0..grid.strips {
        for (cell, gap) in gap[grid.row(strip)].iter_mut().enumerate() {
            *gap = gap::of_curvatures((along, across), [grid.x(cell), grid.y(strip)]) / scales.displacement;
        }
    }
}

/// Columns and depths of the strips: the cells in the window, graded outside of it and downwards.
fn graded_mesh(parameters: &Parameters, grid: &Grid) -> Mesh {
    let outer = (OUTER_COLUMNS * (grid.cells as f64 / 61.0).sqrt()).round().max(2.0) as usize;
    let depths = parameters.depth_nodes - 1;
    Mesh::graded(
        grid.x(grid.cells - 1),
        grid.cells,
        parameters.strip_half_length,
        outer,
        parameters.strip_height,
        depths,
        FIRST_DEPTH * 40.0 / depths as f64,
    )
}

/// Relaxation length of a patch with the given semi-axes along and across, `m`: the distance of rolling on which a change of its shear force F decays. With C the displacement
/// per force and K the force per creepage of steady rolling, a contact of one displacement C F has C dF/dt + |V| F/K = |V| ξ: a change
/// decays within C K. The displacement is not uniform, but grows from the leading edge to the trailing one, and slip changes it: ℓ is
/// [`RELAXATION_FACTOR`] C K. K = G a b C₁₁, C₁₁ = 3.3 (1 + a/(4b)), which is within a few per cent of Kalker's table. A layer of
/// compliance c adds c/(π a b) to C and 3c/(8a²b), that of a brush, to 1/K.
pub fn relaxation_length(pair: &HalfSpaces, layer: f64, (a, b): (f64, f64)) -> f64 {
    let stiffness = a * b * 3.3 * (1.0 + 0.25 * a / b) / (PI * pair.direct);
    let displacement = compliance(pair, (a * b).sqrt());
    if layer == 0.0 {
        return RELAXATION_FACTOR * displacement * stiffness;
    }
    let with_layer = displacement + layer / (PI * a * b);
    RELAXATION_FACTOR * with_layer / (1.0 / stiffness + 0.375 * layer / (a * a * b))
}

/// Mean displacement of a circle along an elliptic shear τ ∝ √(1 − r²/c²) on it, per force, `m/N`. Of one half-space u_x =
/// π τ₀/(32 G c) (4(2−ν) c² − (4−3ν) x² − (4−ν) y²) under F = ⅔π c² τ₀ (Johnson, Contact Mechanics, 3.7); x² and y² are c²/4 in
/// the mean, so that u_x/F = 9(2−ν)/(64 G c). The bodies add up.
fn compliance(pair: &HalfSpaces, c: f64) -> f64 {
    9.0 / 16.0 * PI * (pair.direct - 0.5 * pair.lateral) / c
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::half_space::{Rectangle, XX_OVER_R3, YY_OVER_R3};

    /// Compares the closed form with the sum over small squares that the tables are made of.
    #[test]
    fn compliance_of_a_circle_is_that_of_its_cells() {
        let pair = HalfSpaces::of_pair(&Parameters::default());
        let (c, cells) = (5e-3, 32);
        let size = 2.0 * c / f64::from(cells);
        let square = Rectangle {
            half_length: 0.5 * size,
            half_breadth: 0.5 * size,
        };
        let centre = |i: i32| (f64::from(i) + 0.5) * size - c;
        let points: Vec<(f64, f64)> = (0..cells * cells)
            .map(|i| (centre(i % cells), centre(i / cells)))
            .filter(|(x, y)| x.hypot(*y) < c)
            .collect();
        let shear = |(x, y): (f64, f64)| (1.0 - (x * x + y * y) / (c * c)).sqrt();
        let force = size * size * points.iter().copied().map(shear).sum::<f64>();
        let mut sum = 0.0;
        for &(x, y) in &points {
            for &(from_x, from_y) in &points {
                let (x, y) = (x - from_x, y - from_y);
                let [xx, yy] = [XX_OVER_R3, YY_OVER_R3].map(|kernel| square.integral(&kernel, x, y));
                let kernel = pair.normal() * (xx + yy) + pair.lateral * xx;
                sum += kernel * shear((from_x, from_y));
            }
        }
        let computed = sum / points.len() as f64 / force;
        let exact = compliance(&pair, c);
        // The rim of the circle is one of squares.
        assert!((computed / exact - 1.0).abs() < 5e-3, "{computed:e} {exact:e}");
    }
}
