//! Roots of a function of one variable.

/// Place at which a function that changes its sign between two does so, to round-off: by secants that keep it between their ends (the Illinois method).
pub fn crossing([mut low, mut high]: [f64; 2], function: impl Fn(f64) -> f64) -> f64 {
    /// Round-off of a place, `m`.
    const CLOSE: f64 = 1e-17;
    let (mut at_low, mut at_high) = (function(low), function(high));
    if at_low == 0.0 || at_high == 0.0 {
        return if at_low == 0.0 { low } else { high };
    }
    // Whether the last place became the lower end: an end that stays twice counts half.
    let (mut found, mut was_low) = (0.5 * (low + high), None);
    for _ in 0..60 {
        let secant = (low * at_high - high * at_low) / (at_high - at_low);
        // Beyond its ends it is where the function does not change its sign.
        let next = if low < secant && secant < high {
            secant
        } else {
            0.5 * (low + high)
        };
        let value = function(next);
        let step = next - found;
        found = next;
        if value == 0.0 || step.abs() <= CLOSE {
            break;
        }
        let is_low = (value < 0.0) == (at_low < 0.0);
        let twice = was_low == Some(is_low);
        if is_low {
            (low, at_low) = (next, value);
            at_high *= if twice { 0.5 } else { 1.0 };
        } else {
            (high, at_high) = (next, value);
            at_low *= if twice { 0.5 } else { 1.0 };
        }
        was_low = Some(is_low);
    }
    found
}
