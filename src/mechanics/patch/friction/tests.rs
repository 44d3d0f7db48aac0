//! The law at every cell, its slip summed over the whole matrix.

use super::*;
use crate::body::half_space::{Rectangle, XX_OVER_R3, XY_OVER_R3, YY_OVER_R3};
use crate::settings::Settings;
use std::f64::consts::FRAC_2_PI;

const CELLS: usize = 14;
const STRIPS: usize = 7;

/// Lag of the cell ahead, as V counts.
fn ahead(forward: bool) -> isize {
    if forward { 1 } else { -1 }
}

/// A circle of radius 1 on a grid, half-spaces of 1/(πG) = 1 and ν = 0.3 that roll over it.
struct Case {
    grid: Grid,
    transform: Transform,
    contact: Contact,
    response: SlipResponse,
    edge: Vec<Vector>,
    off_middle: Vec<Vector>,
    bound: Vec<f64>,
    free_slip: [Vec<f64>; 2],
    /// Slip of a cell per its own shear.
    own: f64,
}

/// Slip per shear at a lag: weights of the displacement of the cell and of that ahead, [[xx, xy], [yx, yy]].
fn slip_kernel(grid: &Grid, forward: bool, (along, across): (isize, isize)) -> [[f64; 2]; 2] {
    let rectangle = Rectangle {
        half_length: 0.5 * grid.length,
        half_breadth: 0.5 * grid.breadth,
    };
    let displacement = |along: isize| {
        let (x, y) = (along as f64 * grid.length, across as f64 * grid.breadth);
        let [xx, xy, yy] = [XX_OVER_R3, XY_OVER_R3, YY_OVER_R3].map(|kernel| rectangle.integral(&kernel, x, y));
        [[xx + 0.7 * yy, 0.3 * xy], [0.3 * xy, yy + 0.7 * xx]]
    };
    let (here, next) = (displacement(along), displacement(along + ahead(forward)));
    [0, 1].map(|i: usize| [0, 1].map(|j: usize| 1.2 * here[i][j] - next[i][j]))
}

impl Case {
    /// Case with a creepage and a spin, in units of the slip by which a cell responds to its own shear of 1; stiff without any response.
    fn new(stiff: bool, forward: bool, creepage: Vector, spin: f64) -> Case {
        let grid = Grid::new(CELLS, STRIPS, 1.15, 1.2);
        let transform = Transform::new(&grid, STRIPS);
        let radius = |place: usize| {
            let (strip, cell) = (place / grid.stride(), place % grid.stride());
            grid.x(cell).hypot(grid.y(strip))
        };
        let mut contact = Contact::new(&grid);
        contact.list(&grid, |place| radius(place) < 1.0);
        let compliance = if stiff { 0.0 } else { 1.0 };
        let kernel = |lag| slip_kernel(&grid, forward, lag).map(|row: Vector| row.map(|value| compliance * value));
        let double = transform.tables(
            |lag| kernel(lag)[0][0],
            |lag| kernel(lag)[0][1],
            |lag| kernel(lag)[1][1],
        );
        let table = |component: usize| -> Vec<f32> {
            (0..2 * grid.stride() as isize + 8)
                .map(|lag| kernel((lag - grid.stride() as isize, 0))[component][component] as f32)
                .collect()
        };
        let own = if stiff { 1.0 } else { kernel((0, 0))[0][0] };
        let bound: Vec<f64> = contact
            .places(&grid)
            .map(|place| 0.3 * (1.0 - radius(place).powi(2)).sqrt())
            .collect();
        // The leading cell of each strip is stiffer.
        let mut edge = vec![[0.0; 2]; contact.cells()];
        for run in contact.runs() {
            let leading = if forward {
                run.indices().end - 1
            } else {
                run.indices().start
            };
            edge[leading] = [0.4 * own, 0.3 * own];
        }
        // The load of a strip stands off its middle by a sixth of the way to the middle of the contact.
        let off_middle = contact.runs().iter().flat_map(|run| {
            let slip = own * spin * grid.y(run.strip) / 6.0;
            std::iter::repeat_n([slip, 0.0], run.cells)
        });
        let off_middle = off_middle.collect();
        let mut free_slip = [vec![0.0; grid.len()], vec![0.0; grid.len()]];
        for strip in 0..STRIPS {
            for (cell, place) in grid.row(strip).enumerate() {
                free_slip[0][place] = own * (creepage[0] - spin * grid.y(strip));
                free_slip[1][place] = own * (creepage[1] + spin * grid.x(cell));
            }
        }
        let response = SlipResponse {
            single: double.single(),
            double,
            strip_kernels: [table(0), table(1)],
            origin: grid.stride(),
            forward,
        };
        Case {
            grid,
            transform,
            contact,
            response,
            edge,
            off_middle,
            bound,
            free_slip,
            own,
        }
    }

    fn problem(&self, regularisation: f64) -> FrictionProblem<'_> {
        FrictionProblem {
            grid: &self.grid,
            transform: &self.transform,
            contact: &self.contact,
            response: &self.response,
            edge: &self.edge,
            off_middle: &self.off_middle,
            free_slip: [&self.free_slip[0], &self.free_slip[1]],
            bound: &self.bound,
            path: None,
            scale: 1.0 / self.own,
            noise: self.noise(),
            regularisation,
            tolerance: 1e-11,
            accepted: 0.0,
            work: u64::MAX,
        }
    }

    fn noise(&self) -> f64 {
        1e-4 * self.own
    }

    fn solve(&self, regularisation: f64) -> [Vec<f64>; 2] {
        let mut shear = [vec![0.0; self.grid.len()], vec![0.0; self.grid.len()]];
        let mut friction = Friction::new(&self.grid, &self.transform, Settings::default().patch);
        friction.solve(&self.problem(regularisation), &mut shear).unwrap();
        shear
    }

    /// S₀ + T τ at a cell of the grid of compliant bodies, summed over all cells one by one.
    fn slip(&self, shear: &[Vec<f64>; 2], strip: usize, cell: isize) -> Vector {
        let place = self.grid.place(strip, 0).wrapping_add_signed(cell);
        let mut slip = [self.free_slip[0][place], self.free_slip[1][place]];
        for other in 0..STRIPS {
            for load in 0..CELLS {
                let lag = (cell - load as isize, strip as isize - other as isize);
                let kernel = slip_kernel(&self.grid, self.response.forward, lag);
                let loaded = self.grid.place(other, load);
                for component in 0..2 {
                    slip[component] +=
                        kernel[component][0] * shear[0][loaded] + kernel[component][1] * shear[1][loaded];
                }
            }
        }
        slip
    }

    /// Shear τ, slip of the law, and bound μp of each cell.
    fn states(&self, shear: &[Vec<f64>; 2]) -> Vec<(Vector, Vector, f64)> {
        let mut states = Vec::new();
        for run in self.contact.runs() {
            for (index, cell) in run.indices().zip(run.first..) {
                let place = self.grid.place(run.strip, cell);
                let tau = [shear[0][place], shear[1][place]];
                let mut s = self.slip(shear, run.strip, cell as isize);
                let b = self.slip(shear, run.strip, cell as isize - ahead(self.response.forward));
                for component in 0..2 {
                    s[component] += self.edge[index][component] * tau[component];
                }
                // s = S − q d, d = ½(S − B) − c, q = |S|²/(|S|² + 2|d|² + w²).
                let c = self.off_middle[index];
                let d = [0.5 * (s[0] - b[0]) - c[0], 0.5 * (s[1] - b[1]) - c[1]];
                let square = s[0] * s[0] + s[1] * s[1];
                let q = square / (square + 2.0 * (d[0] * d[0] + d[1] * d[1]) + self.noise().powi(2));
                states.push((tau, [s[0] - q * d[0], s[1] - q * d[1]], self.bound[index]));
            }
        }
        states
    }
}

/// Shear where nothing gives way: −μp s/|s| of the rigid slip.
#[test]
fn rigid_bodies_slide_against_the_rigid_slip() {
    for forward in [true, false] {
        let mut case = Case::new(true, forward, [0.3, -0.4], 0.0);
        case.edge.fill([0.0; 2]);
        let shear = case.solve(0.0);
        for (place, bound) in case.contact.places(&case.grid).zip(&case.bound) {
            assert!((shear[0][place] + 0.6 * bound).abs() < 1e-10);
            assert!((shear[1][place] - 0.8 * bound).abs() < 1e-10);
        }
    }
}

/// Coulomb's law at every cell, with the slip from the whole matrix: creepage, and creepage with spin, from nearly all stick to
/// all slip.
#[test]
fn every_cell_obeys_coulombs_law() {
    let (mut stuck, mut slid) = (0, 0);
    for forward in [true, false] {
        for (creepage, spin) in [
            ([0.02, 0.0], 0.0),
            ([0.1, 0.05], 0.0),
            ([-0.05, 0.03], 0.1),
            ([0.0, 0.0], 0.3),
            ([3.0, 1.0], 0.0),
        ] {
            let case = Case::new(false, forward, creepage, spin);
            let shear = case.solve(0.0);
            for (tau, slip, bound) in case.states(&shear) {
                let (length, speed) = (tau[0].hypot(tau[1]), slip[0].hypot(slip[1]));
                assert!(length <= bound + 1e-10, "{length} above {bound}");
                if length < bound - 1e-9 {
                    assert!(speed < 1e-9 * case.own, "slips by {speed} below the bound");
                    stuck += 1;
                } else {
                    let power = tau[0] * slip[0] + tau[1] * slip[1];
                    assert!((power + bound * speed).abs() < 1e-9 * case.own, "{tau:?} {slip:?}");
                    slid += 1;
                }
            }
        }
    }
    assert!(stuck > 100 && slid > 100, "{stuck} {slid}");
}

/// (30) at every cell.
#[test]
fn every_cell_obeys_the_regularised_law() {
    for creepage in [[0.05, 0.0], [0.1, -0.2]] {
        let case = Case::new(false, true, creepage, 0.1);
        let epsilon = 0.01 * case.own;
        for (tau, slip, bound) in case.states(&case.solve(epsilon)) {
            let speed = slip[0].hypot(slip[1]);
            let share = bound * FRAC_2_PI * (speed / epsilon).atan() / speed;
            for component in 0..2 {
                let error = tau[component] + share * slip[component];
                // The residual is bounded, and the law is steeper than its scale by up to μp/ε.
                assert!(error.abs() < 1e-8, "{tau:?} {slip:?}: {error:e}");
            }
        }
    }
}

/// A response to a correction that is a product in double precision counts as one more product, one that is a sum as none.
#[test]
fn a_product_for_the_response_to_a_correction_is_work() {
    let case = Case::new(false, true, [0.1, 0.05], 0.0);
    // Far above the rounding of single precision: either way the Newton steps are the same.
    let problem = FrictionProblem {
        tolerance: 1e-3,
        ..case.problem(0.0)
    };
    let [by_sums, by_products] = [0.0, f64::INFINITY].map(|single_round_off| {
        let settings = PatchSettings {
            single_round_off,
            ..Settings::default().patch
        };
        let mut friction = Friction::new(&case.grid, &case.transform, settings);
        let mut shear = [vec![0.0; case.grid.len()], vec![0.0; case.grid.len()]];
        friction.solve(&problem, &mut shear).unwrap();
        (friction.iterations(), friction.work())
    });
    assert_eq!(by_sums.0, by_products.0);
    let product = work_of_product(&case.transform, &case.contact.window(&case.grid, 1), 2);
    let newton_steps = by_sums.0[0];
    assert!(newton_steps > 0);
    assert_eq!(by_products.1 - by_sums.1, newton_steps * product);
}
