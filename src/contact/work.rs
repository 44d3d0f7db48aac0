//! Work of a step, and the budget that bounds it.

use crate::error::{Error, Result};

/// Iterations of a workspace since it was made: counts are the same on every machine, times are not.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Iterations {
    /// Newton steps of a patch's friction.
    pub newton: u64,
    /// Krylov iterations of their linear systems.
    pub krylov: u64,
    /// Inversions of the strips' blocks of the friction law.
    pub inversions: u64,
    /// Conjugate gradients of a patch's pressure.
    pub gradients: u64,
}

/// Work of a communication step, in multiplications and additions, about: counted, not timed, so that a step ends in the same way on
/// every machine.
#[derive(Debug, Clone, Copy)]
pub struct Work {
    spent: u64,
    limit: u64,
}

impl Work {
    /// No work yet.
    pub fn new(limit: u64) -> Work {
        Work { spent: 0, limit }
    }

    /// Forgets the work so far.
    pub fn restart(&mut self) {
        self.spent = 0;
    }

    /// Budget of a method that may take so large a share of the whole.
    pub fn share(&self, share: f64) -> Work {
        Work::new((share * self.limit as f64) as u64)
    }

    /// Work so far.
    pub fn spent(&self) -> u64 {
        self.spent
    }

    /// Adds work.
    ///
    /// # Errors
    /// [`Error::TooMuchWork`] beyond the budget.
    pub fn add(&mut self, work: u64) -> Result<()> {
        self.spent += work;
        if self.spent > self.limit {
            return Err(Error::TooMuchWork {
                work: self.spent,
                limit: self.limit,
            });
        }
        Ok(())
    }
}
