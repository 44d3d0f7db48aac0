//! Change of pressure and penetration with the gap and the load: the same linear system on the present set of cells. An
//! infinitesimal change leaves the set as it is.

use super::{Normal, PatchNormalProblem};
use crate::body::influence::Window;
use crate::error::{Error, Result};
use crate::mechanics::normal::normal_problem::Constraint;
use crate::mechanics::patch::contact::Contact;

impl Normal {
    /// Moves `pressure`, a change of the pressure on the grid, of either sign and none outside the contact, from a first guess to the
    /// change under that of the gap and of the load or the penetration, which `problem` holds. Returns the change of the penetration;
    /// that of the separation of all cells is left in [`Normal::separation`].
    ///
    /// # Errors
    /// [`Error::NormalNotConverged`].
    pub fn tangent(&mut self, problem: &PatchNormalProblem, contact: &Contact, pressure: &mut [f64]) -> Result<f64> {
        let places = || contact.places(problem.grid);
        if let Constraint::Total(load) = problem.constraint {
            // Conjugate gradients keep the sum that they start from.
            let missing = load - places().map(|place| pressure[place]).sum::<f64>();
            let mean = missing / contact.cells() as f64;
            places().for_each(|place| pressure[place] += mean);
        }
        // The gap is a change: it does not say where the bodies overlap.
        self.window = Window::whole(problem.grid);
        let (penetration, left) = self.solve_on(problem, contact, pressure, problem.tolerance);
        if left.is_nan() || left > problem.tolerance {
            return Err(Error::NormalNotConverged {
                solver: "tangent of the patch",
                iterations: self.settings.normal_iterations,
                residual: left,
                tolerance: problem.tolerance,
            });
        }
        self.separate(problem, contact, pressure, penetration);
        Ok(penetration)
    }

    /// The separation of all cells under a solution, into [`Normal::separation`].
    pub fn separation_of(
        &mut self,
        problem: &PatchNormalProblem,
        contact: &Contact,
        pressure: &[f64],
        penetration: f64,
    ) {
        self.window = Window::whole(problem.grid);
        self.separate(problem, contact, pressure, penetration);
    }
}
