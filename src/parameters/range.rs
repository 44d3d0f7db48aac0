//! Check of a value against its range.

use crate::error::{Error, Result};

/// Refuses a value that is not finite or outside `minimum..=maximum`. `because` says which parameters set these limits and is
/// empty where none does.
///
/// # Errors
/// [`Error::OutOfRange`].
pub fn check_range(
    name: &'static str,
    value: f64,
    minimum: f64,
    maximum: f64,
    unit: &'static str,
    because: &'static str,
) -> Result<()> {
    if value >= minimum && value <= maximum {
        Ok(())
    } else {
        Err(Error::OutOfRange {
            name,
            value,
            minimum,
            maximum,
            unit,
            because,
        })
    }
}
