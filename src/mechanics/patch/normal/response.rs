//! Response of the pressure to a change of the penetration: the tangent of the pressure on a set of cells, kept as a first guess for what an
//! approach that is not known yet will change.

use super::{Normal, PatchNormalProblem};
use crate::body::grid::Grid;
use crate::body::influence::Window;
use crate::mechanics::patch::contact::Contact;
use crate::numerics::dense::{add_multiple, same};
use std::mem::swap;
use std::ops::Range;

/// Change of the pressure over one of the penetration, and its displacement.
pub struct PressureResponse {
    /// Change of the pressure on the grid.
    pub pressure: Vec<f64>,
    /// Pressure on the grid that `displacement` belongs to.
    displaced_by: Vec<f64>,
    displacement: Vec<f64>,
    /// Part of the grid on which the displacement is known.
    displaced: Window,
}

impl PressureResponse {
    /// No response.
    pub fn new(grid: &Grid) -> PressureResponse {
        PressureResponse {
            pressure: vec![0.0; grid.len()],
            displaced_by: vec![0.0; grid.len()],
            displacement: vec![0.0; grid.len()],
            displaced: Window::whole(grid),
        }
    }

    /// Sets it to nothing.
    pub fn clear(&mut self, grid: &Grid) {
        self.pressure.fill(0.0);
        self.displaced_by.fill(0.0);
        self.displacement.fill(0.0);
        self.displaced = Window::whole(grid);
    }
}

impl Normal {
    /// Solves for the response on a set of cells from what it is, under the change of the gap of `problem`, to its tolerance.
    pub fn respond(&mut self, problem: &PatchNormalProblem, contact: &Contact, response: &mut PressureResponse) {
        let mut exchange = |normal: &mut Normal| {
            swap(&mut normal.displaced_by, &mut response.displaced_by);
            swap(&mut normal.displacement, &mut response.displacement);
            swap(&mut normal.displaced, &mut response.displaced);
        };
        exchange(self);
        self.solve_on(problem, contact, &mut response.pressure, problem.tolerance);
        exchange(self);
    }

    /// Changes a pressure by the response to a change of the penetration. A cell that would pull is left with nothing.
    pub fn advance(&mut self, grid: &Grid, response: &PressureResponse, change: f64, pressure: &mut [f64]) {
        let mut known = same(&self.displaced_by, pressure);
        for (pressure, response) in pressure.iter_mut().zip(&response.pressure) {
            if *pressure > 0.0 {
                let changed = *pressure + change * response;
                known &= changed > 0.0;
                *pressure = changed.max(0.0);
            } else {
                // A cell that has left the contact since does not respond.
                known &= *response == 0.0;
            }
        }
        if !known {
            return;
        }
        let both = |a: &Range<usize>, b: &Range<usize>| {
            let start = a.start.max(b.start);
            start..a.end.min(b.end).max(start)
        };
        self.displaced.strips = both(&self.displaced.strips, &response.displaced.strips);
        self.displaced.read = both(&self.displaced.read, &response.displaced.read);
        for strip in self.displaced.strips.clone() {
            let first = grid.row(strip).start;
            let row = first + self.displaced.read.start..first + self.displaced.read.end;
            add_multiple(&response.displacement[row.clone()], change, &mut self.displacement[row]);
        }
        self.displaced_by.copy_from_slice(pressure);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::patch::operators::PatchOperators;
    use crate::mechanics::normal::normal_problem::Constraint;
    use crate::mechanics::patch::normal::tests::{TOLERANCE, problem, rail};
    use crate::numerics::dense::{largest, largest_change};
    use crate::settings::Settings;

    /// Difference of two pressures by their residuals, which the smoothest pressure magnifies by the number of cells across.
    const RESIDUALS: f64 = 50.0 * TOLERANCE;

    /// Pressures of a sphere on a plane at one penetration after another, with the response on the cells under the first one.
    struct Pressing {
        rail: PatchOperators,
        normal: Normal,
        contact: Contact,
        pressure: Vec<f64>,
        response: PressureResponse,
        nothing: Vec<f64>,
    }

    impl Pressing {
        fn new() -> Pressing {
            let rail = rail();
            let (grid, settings) = (rail.grid, Settings::default().patch);
            Pressing {
                normal: Normal::new(&grid, &rail.transform, settings),
                contact: Contact::new(&grid),
                pressure: vec![0.0; grid.len()],
                response: PressureResponse::new(&grid),
                nothing: vec![0.0; grid.len()],
                rail,
            }
        }

        fn solve(&mut self, penetration: f64) {
            let problem = problem(
                &self.rail,
                &self.rail.gap,
                &self.nothing,
                Constraint::Penetration(penetration),
            );
            let solved = self.normal.solve(&problem, &mut self.contact, &mut self.pressure);
            assert_eq!(solved.unwrap(), penetration);
        }

        fn respond(&mut self) {
            let closing = vec![-1.0; self.rail.grid.len()];
            let problem = problem(&self.rail, &closing, &self.nothing, Constraint::Penetration(0.0));
            self.response.clear(&self.rail.grid);
            self.normal.respond(&problem, &self.contact, &mut self.response);
        }

        fn advance(&mut self, change: f64) {
            self.normal
                .advance(&self.rail.grid, &self.response, change, &mut self.pressure);
        }
    }

    /// The pressure is linear in the penetration while no cell joins or leaves: the response is exact.
    #[test]
    fn the_pressure_on_the_same_cells_follows_by_the_response() {
        let mut pressing = Pressing::new();
        let change = 1e-6;
        pressing.solve(0.5);
        let cells = pressing.contact.clone();
        pressing.respond();
        pressing.advance(change);
        let foretold = pressing.pressure.clone();
        pressing.solve(0.5 + change);
        assert!(pressing.contact == cells);
        assert!(largest_change(&foretold, &pressing.pressure) < RESIDUALS);
        assert!(change * largest(&pressing.response.pressure) > 1e2 * RESIDUALS);
    }

    /// A response that is older than the set of cells: the ones that have left do not come back with it, and the pressure that is solved from it is
    /// the one that is solved from nothing.
    #[test]
    fn a_response_of_more_cells_leaves_no_trace_in_the_solution() {
        let mut pressing = Pressing::new();
        pressing.solve(0.5);
        let cells = pressing.contact.cells();
        pressing.respond();
        pressing.solve(0.3);
        assert!(pressing.contact.cells() < cells);
        pressing.advance(0.01);
        pressing.solve(0.31);
        let mut anew = Pressing::new();
        anew.solve(0.31);
        let difference = largest_change(&pressing.pressure, &anew.pressure);
        assert!(difference < RESIDUALS, "{difference:e}");
    }
}
