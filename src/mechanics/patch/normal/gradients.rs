//! Conjugate gradients for the pressure on a set of cells.

use super::{Frame, Normal, PatchNormalProblem};
use crate::mechanics::normal::normal_problem::Constraint;
use crate::mechanics::patch::contact::{Contact, work_of_product};
use crate::numerics::dense;

/// Conjugate gradients on a set of cells, and how far they have come.
pub struct Gradients {
    /// Penetration that is given, or 0 under a load.
    given: f64,
    /// Sum of the preconditioned ones under a load, else nothing.
    weight: Option<f64>,
    /// Part of the residual that the cells have had in common.
    level: f64,
    /// Product of the last residual with itself, preconditioned; 0 before the first iteration.
    last: f64,
    /// Error of the pressure at the beginning.
    pub first_error: f64,
    /// Error of the pressure that is left.
    pub error: f64,
    /// Whether products are in single precision.
    in_single: bool,
}

impl Gradients {
    /// Penetration that belongs to the pressure.
    pub fn penetration(&self) -> f64 {
        match self.weight {
            Some(_) => -self.level,
            None => self.given,
        }
    }
}

impl Normal {
    /// Conjugate gradients on a set of cells, to a tolerance. Returns penetration and the error of the pressure that is left.
    pub fn solve_on(
        &mut self,
        problem: &PatchNormalProblem,
        contact: &Contact,
        pressure: &mut [f64],
        tolerance: f64,
    ) -> (f64, f64) {
        let mut gradients = self.begin_on(problem, contact, pressure);
        self.go_on(problem, contact, &mut gradients, pressure, tolerance);
        (gradients.penetration(), gradients.error)
    }

    /// Begins conjugate gradients on a set of cells.
    pub fn begin_on(&mut self, problem: &PatchNormalProblem, contact: &Contact, pressure: &[f64]) -> Gradients {
        let (grid, n) = (problem.grid, contact.cells());
        self.displace(problem, contact, pressure);
        self.displaced = self.frame(problem, contact).window;
        contact.gather(grid, pressure, &mut self.pressure);
        contact.gather(grid, problem.wear_compliance, &mut self.wear_compliance);
        contact.gather(grid, problem.gap, &mut self.residual);
        contact.gather(grid, &self.displacement, &mut self.image);
        let given = match problem.constraint {
            Constraint::Total(_) => 0.0,
            Constraint::Penetration(penetration) => penetration,
        };
        let residual = &mut self.residual[..n];
        let (image, compliance, own) = (&self.image[..n], &self.wear_compliance[..n], &self.pressure[..n]);
        dense::vectorised(
            #[inline(always)]
            |_| {
                for i in 0..n {
                    residual[i] = given - residual[i] - image[i] - compliance[i] * own[i];
                }
            },
        );
        self.direction[..n].fill(0.0);
        self.around.clear();
        let weight = matches!(problem.constraint, Constraint::Total(_)).then(|| {
            self.ones[..n].fill(1.0);
            let neighbours = &problem.normal_influence.neighbours;
            neighbours.apply(contact, &mut self.ones, &mut self.around);
            dense::sum(&self.ones[..n])
        });
        let mut gradients = Gradients {
            given,
            weight,
            level: 0.0,
            last: 0.0,
            first_error: 0.0,
            error: 0.0,
            in_single: false,
        };
        self.measure(problem, contact, &mut gradients);
        gradients.first_error = gradients.error;
        // What single precision leaves out of the change is far below the tolerance.
        gradients.in_single = problem.tolerance >= self.settings.single_tolerance * gradients.error;
        if gradients.in_single {
            self.single[0].fill(0.0);
        } else {
            self.direction_grid.fill(0.0);
        }
        gradients
    }

    /// Takes what all cells have in common off the residual, and measures what is left.
    fn measure(&mut self, problem: &PatchNormalProblem, contact: &Contact, gradients: &mut Gradients) {
        let n = contact.cells();
        let residual = &mut self.residual[..n];
        if let Some(weight) = gradients.weight.filter(|_| n > 0) {
            // The penetration takes it: kept in the residual, its round-off would grow into a change of the load. It goes before preconditioning, whose single precision
            // would round it.
            let common = dense::dot(&self.ones[..n], residual) / weight;
            gradients.level += common;
            for residual in &mut *residual {
                *residual -= common;
            }
        }
        gradients.error = dense::largest(residual) / problem.normal_influence.diagonal;
    }

    /// Goes on with conjugate gradients to a tolerance.
    pub fn go_on(
        &mut self,
        problem: &PatchNormalProblem,
        contact: &Contact,
        gradients: &mut Gradients,
        pressure: &mut [f64],
        tolerance: f64,
    ) {
        let (grid, n) = (problem.grid, contact.cells());
        let neighbours = &problem.normal_influence.neighbours;
        let Frame {
            transform,
            tables,
            single,
            window,
        } = self.frame(problem, contact);
        let work = work_of_product(transform, &window, 1) + neighbours.work(contact);
        for _ in 0..self.settings.normal_iterations {
            if gradients.error <= tolerance {
                break;
            }
            self.corrected[..n].copy_from_slice(&self.residual[..n]);
            neighbours.apply(contact, &mut self.corrected, &mut self.around);
            if let Some(weight) = gradients.weight {
                // What rounding has left of a change of the load.
                let left = dense::sum(&self.corrected[..n]) / weight;
                dense::add_multiple(&self.ones[..n], -left, &mut self.corrected[..n]);
            }
            let product = dense::dot(&self.residual[..n], &self.corrected[..n]);
            let ratio = if gradients.last == 0.0 {
                0.0
            } else {
                product / gradients.last
            };
            gradients.last = product;
            let (direction, corrected) = (&mut self.direction[..n], &self.corrected[..n]);
            dense::vectorised(
                #[inline(always)]
                |_| {
                    for i in 0..n {
                        direction[i] = corrected[i] + ratio * direction[i];
                    }
                },
            );
            self.work_done += work;
            self.iterations += 1;
            // Of all cells that may come into contact: what lies beside it must be known to see whether it overlaps.
            if gradients.in_single {
                let [direction, image] = &mut self.single;
                contact.scatter_single(grid, &self.direction, direction);
                transform.apply(single, &window, direction, image, &mut self.scratch_single);
                contact.gather_single(grid, image, &mut self.image);
            } else {
                contact.scatter(grid, &self.direction, &mut self.direction_grid);
                let (direction, image) = (&self.direction_grid, &mut self.direction_image);
                transform.apply(tables, &window, direction, image, &mut self.scratch);
                contact.gather(grid, &self.direction_image, &mut self.image);
            }
            let (direction, image, compliance) =
                (&self.direction[..n], &mut self.image[..n], &self.wear_compliance[..n]);
            let curvature = dense::vectorised(
                #[inline(always)]
                |arithmetic| {
                    for i in 0..n {
                        image[i] += compliance[i] * direction[i];
                    }
                    arithmetic.dot(direction, image)
                },
            );
            if curvature.is_nan() || curvature <= 0.0 {
                break;
            }
            let step = product / curvature;
            dense::add_multiple(&self.direction[..n], step, &mut self.pressure[..n]);
            dense::add_multiple(&self.image[..n], -step, &mut self.residual[..n]);
            let (displacement, [_, single_image]) = (&mut self.displacement, &self.single);
            let (image, in_single) = (&self.direction_image, gradients.in_single);
            dense::vectorised(
                #[inline(always)]
                |arithmetic| {
                    for row in window.rows(grid) {
                        let own = &mut displacement[row.clone()];
                        if in_single {
                            arithmetic.add_multiple_of_single(&single_image[row], step, own);
                        } else {
                            arithmetic.add_multiple(&image[row], step, own);
                        }
                    }
                },
            );
            self.measure(problem, contact, gradients);
        }
        contact.scatter(grid, &self.pressure, pressure);
        self.displaced_by.copy_from_slice(pressure);
    }
}
