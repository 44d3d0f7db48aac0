//! Divergence on demand, for the tests that a step which cannot be solved changes nothing. Only the feature
//! `divergence-injection` does anything; without it every solver's [`passes`] is a constant.

use crate::error::{Error, Result};

/// The solvers of a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Solver {
    /// [`crate::mechanics::normal`], active set.
    ActiveSet,
    /// [`crate::mechanics::normal`], linearisation.
    Pschenichnyj,
    /// [`crate::mechanics::tangential`].
    Tangential,
    /// [`crate::mechanics`].
    Mechanics,
    /// [`crate::contact::line::split`].
    Split,
    /// [`crate::heat`].
    SurfaceHeat,
    /// [`crate::contact::rim`].
    WheelHeat,
}

impl Solver {
    /// All of them.
    pub const ALL: [Solver; 7] = [
        Solver::ActiveSet,
        Solver::Pschenichnyj,
        Solver::Tangential,
        Solver::Mechanics,
        Solver::Split,
        Solver::SurfaceHeat,
        Solver::WheelHeat,
    ];

    /// What the solver says where it does not converge.
    pub fn divergence(self) -> Error {
        let (iterations, residual, tolerance) = (0, f64::INFINITY, 0.0);
        let normal = |solver| Error::NormalNotConverged {
            solver,
            iterations,
            residual,
            tolerance,
        };
        match self {
            Solver::ActiveSet => normal("active set"),
            Solver::Pschenichnyj => normal("Pschenichnyj"),
            Solver::Tangential => Error::TangentialNotConverged {
                iterations,
                residual,
                tolerance,
            },
            Solver::Mechanics => Error::MechanicsNotConverged {
                iterations,
                residual,
                tolerance,
            },
            Solver::Split => Error::SplitNotConverged {
                iterations,
                residual,
                tolerance,
            },
            Solver::SurfaceHeat => Error::SurfaceHeatNotConverged {
                position: 0.0,
                iterations,
                residual,
            },
            Solver::WheelHeat => Error::WheelHeatNotConverged { iterations, residual },
        }
    }
}

/// Called by a solver that has converged, with everything it writes already written.
///
/// # Errors
/// [`Solver::divergence`], where `diverge` asked for it.
#[inline(always)]
pub fn passes(solver: Solver) -> Result<()> {
    #[cfg(feature = "divergence-injection")]
    return injected::passes(solver);
    #[cfg(not(feature = "divergence-injection"))]
    {
        let _ = solver;
        Ok(())
    }
}

#[cfg(feature = "divergence-injection")]
pub use injected::diverge;

#[cfg(feature = "divergence-injection")]
mod injected {
    use super::{Result, Solver};
    use std::cell::Cell;

    /// What is asked for.
    #[derive(Clone, Copy)]
    struct Request {
        solver: Solver,
        after: usize,
        times: usize,
    }

    thread_local! {
        static REQUEST: Cell<Option<Request>> = const { Cell::new(None) };
    }

    /// Lets a solver converge `after` more times in this thread and then not, for so many `times`. Replaces what was asked
    /// for before.
    pub fn diverge(solver: Solver, after: usize, times: usize) {
        REQUEST.set(Some(Request { solver, after, times }));
    }

    pub fn passes(solver: Solver) -> Result<()> {
        let Some(mut request) = REQUEST.get().filter(|request| request.solver == solver) else {
            return Ok(());
        };
        let result = match (request.after, request.times) {
            (0, 0) => Ok(()),
            (0, _) => {
                request.times -= 1;
                Err(solver.divergence())
            }
            _ => {
                request.after -= 1;
                Ok(())
            }
        };
        REQUEST.set(Some(request));
        result
    }
}
