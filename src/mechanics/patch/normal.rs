//! The normal problem of a patch: pressure and penetration for a given gap, under a load or a penetration.
//!
//! Minimise ½ pᵀ(A + D)p + gᵀp over p ≥ 0 with Σp given, or ½ pᵀ(A + D)p + (g − δ)ᵀp: A is the normal influence of the cells on one
//! another, D the wear compliance, by which the wear of the step opens the gap of a cell. On a set of cells under pressure this is a linear system, solved
//! by conjugate gradients from the pressure of the step before, with each cell's neighbours as [preconditioner]; then cells that pull
//! leave the set, cells that overlap join it, until none does.

mod gradients;
mod preconditioner;
pub mod response;
mod tangent;

use super::contact::{Contact, work_of_product};
use crate::body::grid::Grid;
use crate::body::influence::{self, ScalarTables, Transform, Window};
use crate::error::{Error, Result};
use crate::mechanics::normal::normal_problem::Constraint;
use crate::numerics::dense;
use crate::settings::PatchSettings;
use preconditioner::{Field, Neighbours};
use std::ops::Range;

/// Normal influence of the cells on one another, with the preconditioner.
#[derive(Debug, Clone)]
pub struct NormalInfluence {
    /// A.
    pub tables: ScalarTables<f64>,
    /// A in single precision.
    single: ScalarTables<f32>,
    /// Diagonal of A: influence of a cell on itself.
    pub diagonal: f64,
    neighbours: Neighbours,
}

impl NormalInfluence {
    /// Normal influence from the influence as a function of the lag.
    pub fn new(grid: &Grid, transform: &Transform, influence: impl Fn((isize, isize)) -> f64) -> NormalInfluence {
        let tables = transform.scalar_tables(&influence);
        NormalInfluence {
            diagonal: influence((0, 0)),
            neighbours: Neighbours::new(grid, &influence),
            single: tables.single(),
            tables,
        }
    }
}

/// Normal influence for loads on a part of the strips: a product costs as much as it serves strips.
#[derive(Debug, Clone)]
pub struct NarrowInfluence {
    /// Transform of the tables.
    transform: Transform,
    /// A.
    tables: ScalarTables<f64>,
    /// A in single precision.
    single: ScalarTables<f32>,
}

impl NarrowInfluence {
    /// Normal influence for a transform, as a function of the lag.
    pub fn new(transform: Transform, influence: impl Fn((isize, isize)) -> f64) -> NarrowInfluence {
        let tables = transform.scalar_tables(influence);
        NarrowInfluence {
            single: tables.single(),
            tables,
            transform,
        }
    }
}

/// Data of one normal problem.
#[derive(Clone, Copy)]
pub struct PatchNormalProblem<'a> {
    /// The grid.
    pub grid: &'a Grid,
    /// The transform of the tables.
    pub transform: &'a Transform,
    /// A.
    pub normal_influence: &'a NormalInfluence,
    /// Normal influence for fewer strips, ascending: where a penetration is given, contact is only where the
    /// undeformed bodies overlap, and nothing else need be looked at. None looks at the whole grid.
    pub narrow: &'a [NarrowInfluence],
    /// g on the grid.
    pub gap: &'a [f64],
    /// D on the grid.
    pub wear_compliance: &'a [f64],
    /// Load or penetration.
    pub constraint: Constraint,
    /// Error of the pressure to be reached.
    pub tolerance: f64,
}

/// Transform and tables for a product, and the part of the grid that it reads.
struct Frame<'p> {
    transform: &'p Transform,
    tables: &'p ScalarTables<f64>,
    single: &'p ScalarTables<f32>,
    window: Window,
}

/// Solver of the normal problem and its buffers.
pub struct Normal {
    settings: PatchSettings,
    /// Pressure on the grid that `displacement` belongs to.
    displaced_by: Vec<f64>,
    displacement: Vec<f64>,
    /// Direction of the search on the grid, and its displacement.
    direction_grid: Vec<f64>,
    direction_image: Vec<f64>,
    scratch: influence::ProductScratch<f64>,
    /// Direction and its displacement in single precision.
    single: [Vec<f32>; 2],
    scratch_single: influence::ProductScratch<f32>,
    /// Residual of the cells; values of the cells are the following ones as well.
    residual: Vec<f64>,
    direction: Vec<f64>,
    corrected: Vec<f64>,
    ones: Vec<f64>,
    around: Field,
    image: Vec<f64>,
    pressure: Vec<f64>,
    wear_compliance: Vec<f64>,
    /// Separation w of all cells.
    pub separation: Vec<f64>,
    /// Part of the grid that is looked at.
    window: Window,
    /// Part of the grid on which the displacement is known.
    displaced: Window,
    /// Multiplications and additions in this step.
    work_done: u64,
    /// Conjugate gradients since the solver was made.
    iterations: u64,
}

impl Normal {
    /// Solver for a grid.
    pub fn new(grid: &Grid, transform: &Transform, settings: PatchSettings) -> Normal {
        let on_grid = || vec![0.0; grid.len()];
        Normal {
            settings,
            displaced_by: on_grid(),
            displacement: on_grid(),
            direction_grid: on_grid(),
            direction_image: on_grid(),
            scratch: transform.scratch(),
            single: std::array::from_fn(|_| vec![0.0; grid.len()]),
            scratch_single: transform.scratch(),
            residual: on_grid(),
            direction: on_grid(),
            corrected: on_grid(),
            ones: on_grid(),
            around: Field::new(grid),
            image: on_grid(),
            pressure: on_grid(),
            wear_compliance: on_grid(),
            separation: on_grid(),
            window: Window::whole(grid),
            displaced: Window::whole(grid),
            work_done: 0,
            iterations: 0,
        }
    }

    /// Forgets the displacement of the step before: a step follows from its state alone.
    pub fn start_step(&mut self) {
        self.displaced_by.fill(f64::NAN);
        self.work_done = 0;
    }

    /// Multiplications and additions in this step, about: a measure of time that is the same on every machine.
    pub fn work(&self) -> u64 {
        self.work_done
    }

    /// Conjugate gradients since the solver was made.
    pub fn iterations(&self) -> u64 {
        self.iterations
    }

    /// Solves from the given pressure on the grid, whose cells become `contact`. Returns the penetration.
    ///
    /// # Errors
    /// [`Error::NormalNotConverged`].
    pub fn solve(&mut self, problem: &PatchNormalProblem, contact: &mut Contact, pressure: &mut [f64]) -> Result<f64> {
        let grid = problem.grid;
        self.look_at(problem);
        start(problem, &self.settings, pressure);
        let mut gradients = None;
        let mut left = f64::INFINITY;
        let mut least = problem.tolerance;
        for pass in 0..self.settings.normal_passes {
            // Where the cells have stayed, conjugate gradients go on from where they were.
            let settled = gradients.is_some();
            let tolerance = if settled {
                least
            } else {
                self.settings.set_tolerance.max(least)
            };
            let mut own = gradients.take().unwrap_or_else(|| {
                contact.list(grid, |place| pressure[place] > 0.0);
                // Cells have joined and left; conjugate gradients keep the sum that they start from.
                if let Constraint::Total(load) = problem.constraint {
                    let sum = dense::sum(pressure);
                    if sum != load && sum > 0.0 {
                        pressure.iter_mut().for_each(|p| *p *= load / sum);
                    }
                }
                self.begin_on(problem, contact, pressure)
            });
            self.go_on(problem, contact, &mut own, pressure, tolerance);
            let penetration = own.penetration();
            left = own.error;
            if pass == 0 {
                // As roughly as the friction law after a first guess that is far off.
                let roughly = (self.settings.reduction * own.first_error).min(self.settings.slack * least);
                least = least.max(roughly);
            }
            self.separate(problem, contact, pressure, penetration);
            let one_at_a_time = pass >= self.settings.normal_passes / 2;
            let changed = self.exchange(problem, pressure, one_at_a_time);
            if !changed && left <= least {
                return Ok(penetration);
            }
            gradients = (!changed).then_some(own);
        }
        Err(Error::NormalNotConverged {
            solver: "active set of the patch",
            iterations: self.settings.normal_passes,
            residual: left,
            tolerance: problem.tolerance,
        })
    }

    /// Sets the part of the grid that is looked at: where the undeformed bodies overlap, as there is no contact elsewhere, and two
    /// cells around.
    fn look_at(&mut self, problem: &PatchNormalProblem) {
        const AROUND: usize = 2;
        let grid = problem.grid;
        self.window = Window::whole(grid);
        let Constraint::Penetration(penetration) = problem.constraint else {
            return;
        };
        if problem.narrow.is_empty() {
            return;
        }
        let (mut strips, mut cells) = (grid.strips..0, grid.cells..0);
        for strip in 0..grid.strips {
            let row = &problem.gap[grid.row(strip)];
            let overlaps = |gap: &f64| *gap < penetration;
            if let (Some(first), Some(last)) = (row.iter().position(overlaps), row.iter().rposition(overlaps)) {
                strips = strips.start.min(strip)..strip + 1;
                cells = cells.start.min(first)..cells.end.max(last + 1);
            }
        }
        if strips.start < strips.end {
            let around = |range: &Range<usize>, count: usize| {
                range.start.saturating_sub(AROUND)..(range.end + AROUND).min(count)
            };
            self.window.strips = around(&strips, grid.strips);
            self.window.read = around(&cells, grid.cells);
        }
    }

    /// Part of the grid that a product reads for loads on the contact, with the transform and the tables that serve it.
    fn frame<'p>(&self, problem: &PatchNormalProblem<'p>, contact: &Contact) -> Frame<'p> {
        let loaded = contact.window(problem.grid, 0);
        let hull = |a: &Range<usize>, b: &Range<usize>| {
            if b.is_empty() {
                a.clone()
            } else {
                a.start.min(b.start)..a.end.max(b.end)
            }
        };
        let window = Window {
            strips: hull(&self.window.strips, &loaded.strips),
            read: hull(&self.window.read, &loaded.loaded),
            loaded: loaded.loaded,
        };
        let serves = |narrow: &&NarrowInfluence| narrow.transform.strips() >= window.strips.len();
        match problem.narrow.iter().find(serves) {
            Some(narrow) => Frame {
                transform: &narrow.transform,
                tables: &narrow.tables,
                single: &narrow.single,
                window,
            },
            None => Frame {
                transform: problem.transform,
                tables: &problem.normal_influence.tables,
                single: &problem.normal_influence.single,
                window,
            },
        }
    }

    /// The displacement by a pressure, unless it is known.
    fn displace(&mut self, problem: &PatchNormalProblem, contact: &Contact, pressure: &[f64]) {
        let Frame {
            transform,
            tables,
            window,
            ..
        } = self.frame(problem, contact);
        let holds = |outer: &Range<usize>, inner: &Range<usize>| outer.start <= inner.start && inner.end <= outer.end;
        let known = holds(&self.displaced.strips, &window.strips) && holds(&self.displaced.read, &window.read);
        if known && dense::same(&self.displaced_by, pressure) {
            return;
        }
        self.displaced_by.copy_from_slice(pressure);
        self.displaced = window.clone();
        self.work_done += work_of_product(transform, &window, 1);
        transform.apply(tables, &window, pressure, &mut self.displacement, &mut self.scratch);
    }

    /// The separation of all cells.
    fn separate(&mut self, problem: &PatchNormalProblem, contact: &Contact, pressure: &[f64], penetration: f64) {
        self.displace(problem, contact, pressure);
        let grid = problem.grid;
        let Window { strips, read, .. } = &self.displaced;
        dense::vectorised(
            #[inline(always)]
            |_| {
                for strip in 0..grid.strips {
                    let row = grid.row(strip);
                    // Without the displacement, which opens it further.
                    for (separation, gap) in self.separation[row.clone()].iter_mut().zip(&problem.gap[row.clone()]) {
                        *separation = gap - penetration;
                    }
                    if strips.contains(&strip) {
                        let known = row.start + read.start..row.start + read.end;
                        let surfaces = self.displacement[known.clone()].iter();
                        let surfaces = surfaces.zip(&problem.wear_compliance[known.clone()]);
                        let surfaces = surfaces.zip(&pressure[known.clone()]).zip(&problem.gap[known.clone()]);
                        for (separation, (((displacement, compliance), pressure), gap)) in
                            self.separation[known].iter_mut().zip(surfaces)
                        {
                            *separation = displacement + compliance * pressure + gap - penetration;
                        }
                    }
                }
            },
        );
    }

    /// Whether any cell pulls or overlaps, those at the ends of the strips among them: without a branch for each cell.
    fn may_change(&self, grid: &Grid, pressure: &[f64]) -> bool {
        let overlap = -self.settings.overlap;
        dense::vectorised(
            #[inline(always)]
            |_| {
                (0..grid.strips).map(|strip| grid.row(strip)).any(|row| {
                    let cells = pressure[row.clone()].iter().zip(&self.separation[row]);
                    cells.fold(false, |any, (&pressure, &separation)| {
                        any | (pressure < 0.0) | ((pressure == 0.0) & (separation < overlap))
                    })
                })
            },
        )
    }

    /// Cells that pull leave, cells that overlap join with a trace of pressure; in the order of `one_at_a_time` only the worst.
    /// Whether any did.
    fn exchange(&self, problem: &PatchNormalProblem, pressure: &mut [f64], one_at_a_time: bool) -> bool {
        let grid = problem.grid;
        if !self.may_change(grid, pressure) {
            return false;
        }
        let largest = pressure.iter().fold(0.0, |m: f64, p| p.max(m));
        // Where every cell pulls: the pressure by which one cell presses the deepest overlap away.
        let of_overlap = || {
            let places = (0..grid.strips).flat_map(|strip| grid.row(strip));
            let least = places.fold(0.0, |m: f64, place| m.min(self.separation[place]));
            -least / problem.normal_influence.diagonal
        };
        let trace = self.settings.trace * if largest > 0.0 { largest } else { of_overlap() };
        let mut worst = (0.0, None);
        let mut changed = false;
        for place in (0..grid.strips).flat_map(|strip| grid.row(strip)) {
            let joins =
                pressure[place] == 0.0 && self.separation[place] < -self.settings.overlap && is_free(grid, place);
            let leaves = pressure[place] < 0.0;
            if !joins && !leaves {
                continue;
            }
            changed = true;
            let violation = if leaves {
                -pressure[place]
            } else {
                -self.separation[place] / problem.normal_influence.diagonal
            };
            if violation > worst.0 {
                worst = (violation, Some((place, joins)));
            }
            if !one_at_a_time || leaves {
                pressure[place] = if joins { trace } else { 0.0 };
            }
        }
        if let (true, Some((place, true))) = (one_at_a_time, worst.1) {
            pressure[place] = trace;
        }
        changed
    }
}

/// A start from the cells that overlap, where there is no pressure to start from: the deepest one and those that come close to it.
fn start(problem: &PatchNormalProblem, settings: &PatchSettings, pressure: &mut [f64]) {
    if pressure.iter().any(|&p| p > 0.0) {
        return;
    }
    let grid = problem.grid;
    let places = || {
        let cells = (0..grid.strips).flat_map(|strip| grid.row(strip));
        cells.filter(|&place| is_free(grid, place))
    };
    let deepest = places().map(|place| problem.gap[place]).fold(f64::INFINITY, f64::min);
    let depth = match problem.constraint {
        Constraint::Penetration(penetration) => penetration - deepest,
        Constraint::Total(_) => problem.normal_influence.diagonal * settings.first_pressure,
    };
    for place in places().filter(|&place| problem.gap[place] <= deepest + depth) {
        pressure[place] = 1.0;
    }
}

/// Whether a cell may come under pressure: the slip of the outermost cells of a strip would take displacements from outside the window.
pub fn is_free(grid: &Grid, place: usize) -> bool {
    let cell = place % grid.stride();
    cell > 0 && cell + 1 < grid.cells
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::patch::operators::PatchOperators;
    use crate::parameters::{ContactModel, Parameters};
    use crate::settings::Settings;

    /// Tolerance of the pressures.
    pub const TOLERANCE: f64 = 1e-10;

    /// The rail of a patch with default parameters.
    pub fn rail() -> PatchOperators {
        let parameters = Parameters {
            contact_model: ContactModel::Patch,
            ..Parameters::default()
        };
        PatchOperators::build(&parameters).unwrap()
    }

    /// Problem of a rail that does not wear, over all of its grid.
    pub fn problem<'a>(
        rail: &'a PatchOperators,
        gap: &'a [f64],
        wear_compliance: &'a [f64],
        constraint: Constraint,
    ) -> PatchNormalProblem<'a> {
        PatchNormalProblem {
            grid: &rail.grid,
            transform: &rail.transform,
            normal_influence: &rail.normal_influence,
            narrow: &[],
            gap,
            wear_compliance,
            constraint,
            tolerance: TOLERANCE,
        }
    }

    /// Hertz's ellipse (Johnson, 4.24–4.26), from nothing and from a smaller load.
    #[test]
    fn the_pressure_is_that_of_hertz() {
        let parameters = Parameters {
            contact_model: ContactModel::Patch,
            ..Parameters::default()
        };
        let rail = rail();
        let grid = &rail.grid;
        let mut normal = Normal::new(grid, &rail.transform, Settings::default().patch);
        let mut contact = Contact::new(grid);
        let mut pressure = vec![0.0; grid.len()];
        let unworn = vec![0.0; grid.len()];
        for load in [80e3, 60e3, 95e3] {
            let problem = problem(&rail, &rail.gap, &unworn, Constraint::Total(load / rail.unit_force()));
            let penetration = normal.solve(&problem, &mut contact, &mut pressure).unwrap();
            let ellipse = parameters.hertz_ellipse(load);
            let peak = dense::largest(&pressure) * rail.scales.pressure;
            // The largest pressure is that of a cell whose centre is half a cell beside the middle.
            assert!((peak / ellipse.peak_pressure - 1.0).abs() < 2e-3, "{load}: {peak}");
            let approach = penetration * rail.scales.displacement;
            assert!((approach / ellipse.approach - 1.0).abs() < 1e-3, "{load}: {approach}");
            let sum = pressure.iter().sum::<f64>() * rail.unit_force();
            assert!((sum / load - 1.0).abs() < 1e-12, "{sum}");
            // Nothing pulls, nothing overlaps.
            for place in (0..grid.strips).flat_map(|strip| grid.row(strip)) {
                assert!(pressure[place] >= 0.0);
                let overlap = if pressure[place] > 0.0 {
                    normal.separation[place].abs()
                } else {
                    -normal.separation[place]
                };
                assert!(overlap < 1e-8, "{overlap}");
            }
        }
    }

    /// Conjugate gradients keep the load from a pressure that is far off on the very cells in contact: nothing is set right after them.
    #[test]
    fn a_load_is_kept_by_every_change_of_the_pressure() {
        let rail = rail();
        let grid = &rail.grid;
        let mut normal = Normal::new(grid, &rail.transform, Settings::default().patch);
        let mut contact = Contact::new(grid);
        let mut pressure = vec![0.0; grid.len()];
        let unworn = vec![0.0; grid.len()];
        let load = 80e3 / rail.unit_force();
        let problem = problem(&rail, &rail.gap, &unworn, Constraint::Total(load));
        normal.solve(&problem, &mut contact, &mut pressure).unwrap();
        let mean = load / contact.cells() as f64;
        contact.scatter(grid, &vec![mean; contact.cells()], &mut pressure);
        normal.solve_on(&problem, &contact, &mut pressure, TOLERANCE);
        let sum = pressure.iter().sum::<f64>();
        assert!((sum / load - 1.0).abs() < 1e-12, "{}", sum / load - 1.0);
    }

    /// A wheel that stands higher by the same everywhere sinks by as much more: what the cells have in common is not left to single precision.
    #[test]
    fn a_height_that_all_cells_have_in_common_costs_nothing() {
        let rail = rail();
        let grid = &rail.grid;
        let unworn = vec![0.0; grid.len()];
        let [low, high] = [0.0, 1e3].map(|height| {
            let mut normal = Normal::new(grid, &rail.transform, Settings::default().patch);
            let mut pressure = vec![0.0; grid.len()];
            let gap: Vec<f64> = rail.gap.iter().map(|gap| gap + height).collect();
            let problem = problem(&rail, &gap, &unworn, Constraint::Total(80e3 / rail.unit_force()));
            let penetration = normal.solve(&problem, &mut Contact::new(grid), &mut pressure).unwrap();
            (penetration - height, pressure, normal.iterations())
        });
        assert!((low.0 - high.0).abs() < 1e-9, "{} {}", low.0, high.0);
        let largest = dense::largest(&low.1);
        for (low, high) in low.1.iter().zip(&high.1) {
            assert!((low - high).abs() < 100.0 * TOLERANCE * largest, "{low} {high}");
        }
        assert_eq!(low.2, high.2);
    }

    /// A pressure to begin with where the bodies are apart, all of whose cells pull at once, and an overlap elsewhere.
    #[test]
    fn a_patch_whose_cells_all_pull_finds_the_overlap() {
        let rail = rail();
        let grid = &rail.grid;
        let (apart, overlap) = (
            grid.place(grid.strips / 2, 5),
            grid.place(grid.strips / 2, grid.cells - 6),
        );
        let mut gap = vec![1.0; grid.len()];
        gap[overlap] = -1.0;
        let unworn = vec![0.0; grid.len()];
        let problem = problem(&rail, &gap, &unworn, Constraint::Penetration(0.0));
        let mut pressure = vec![0.0; grid.len()];
        pressure[apart] = 1.0;
        let mut normal = Normal::new(grid, &rail.transform, Settings::default().patch);
        normal.solve(&problem, &mut Contact::new(grid), &mut pressure).unwrap();
        // The only cell that carries presses its own overlap away.
        let alone = 1.0 / rail.normal_influence.diagonal;
        assert!((pressure[overlap] / alone - 1.0).abs() < 1e-6, "{}", pressure[overlap]);
        assert!(pressure[apart] == 0.0);
    }

    #[test]
    fn a_limit_of_no_passes_is_an_error() {
        let rail = rail();
        let grid = &rail.grid;
        let mut settings = Settings::default().patch;
        settings.normal_passes = 0;
        let unworn = vec![0.0; grid.len()];
        let problem = problem(&rail, &rail.gap, &unworn, Constraint::Total(1.0));
        let solved = Normal::new(grid, &rail.transform, settings).solve(
            &problem,
            &mut Contact::new(grid),
            &mut vec![0.0; grid.len()],
        );
        assert!(matches!(solved, Err(Error::NormalNotConverged { iterations: 0, .. })));
    }
}
