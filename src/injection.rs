//! Divergence on demand, for the tests that a step which cannot be solved changes nothing. Only the feature
//! `divergence-injection` does anything; without it every solver's [`passes`] is a constant.

use crate::error::{Error, Result};

/// The solvers of a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Solver {
    /// [`crate::normal`], active set.
    ActiveSet,
    /// [`crate::normal`], linearisation.
    Pschenichnyj,
    /// [`crate::tangential`].
    Tangential,
    /// [`crate::mechanics`].
    Mechanics,
    /// [`crate::contact`].
    Split,
    /// [`crate::heat`].
    SurfaceHeat,
}

impl Solver {
    /// All of them.
    pub const ALL: [Solver; 6] = [
        Solver::ActiveSet,
        Solver::Pschenichnyj,
        Solver::Tangential,
        Solver::Mechanics,
        Solver::Split,
        Solver::SurfaceHeat,
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
        }
    }
}

/// Called by a solver that has converged, with everything it writes already written.
///
/// # Errors
/// [`Solver::divergence`], once, where `diverge` asked for it.
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

    thread_local! {
        static NEXT: Cell<Option<(Solver, usize)>> = const { Cell::new(None) };
    }

    /// Lets a solver converge `after` more times in this thread and then, once, not.
    pub fn diverge(solver: Solver, after: usize) {
        NEXT.set(Some((solver, after)));
    }

    pub fn passes(solver: Solver) -> Result<()> {
        match NEXT.get() {
            Some((chosen, 0)) if chosen == solver => {
                NEXT.set(None);
                Err(solver.divergence())
            }
            Some((chosen, after)) if chosen == solver => {
                NEXT.set(Some((chosen, after - 1)));
                Ok(())
            }
            _ => Ok(()),
        }
    }
}
