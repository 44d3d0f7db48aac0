//! One compared quantity, and what makes it pass.

/// One compared quantity.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// Quantity that is compared, with the conditions.
    pub quantity: String,
    /// Unit of reference and computed value.
    pub unit: &'static str,
    /// Value that it should have; of a bound, the bound.
    pub reference: f64,
    /// Value that the model gives.
    pub computed: f64,
    /// Distance of the two as the kind of row measures it: relative, absolute, or beyond a bound.
    pub deviation: f64,
    /// Largest deviation that passes.
    pub tolerance: f64,
    /// Whether the deviation is a number not above the tolerance.
    pub pass: bool,
    /// Source of the reference.
    pub source: &'static str,
}

impl Row {
    fn new(
        quantity: impl Into<String>,
        unit: &'static str,
        [reference, computed, deviation, tolerance]: [f64; 4],
        source: &'static str,
    ) -> Row {
        Row {
            quantity: quantity.into(),
            unit,
            reference,
            computed,
            deviation,
            tolerance,
            pass: deviation <= tolerance,
            source,
        }
    }

    /// Deviation relative to the reference.
    pub fn relative(
        quantity: impl Into<String>,
        unit: &'static str,
        reference: f64,
        computed: f64,
        tolerance: f64,
        source: &'static str,
    ) -> Row {
        let deviation = ((computed - reference) / reference).abs();
        Row::new(quantity, unit, [reference, computed, deviation, tolerance], source)
    }

    /// Deviation in the unit of the quantity.
    pub fn absolute(
        quantity: impl Into<String>,
        unit: &'static str,
        reference: f64,
        computed: f64,
        tolerance: f64,
        source: &'static str,
    ) -> Row {
        let deviation = (computed - reference).abs();
        Row::new(quantity, unit, [reference, computed, deviation, tolerance], source)
    }

    /// A claim of size: the computed value does not exceed `bound`.
    pub fn at_most(
        quantity: impl Into<String>,
        unit: &'static str,
        bound: f64,
        computed: f64,
        source: &'static str,
    ) -> Row {
        // Not `max`, which would turn NaN into 0.
        let deviation = if computed <= bound { 0.0 } else { computed - bound };
        Row::new(quantity, unit, [bound, computed, deviation, 0.0], source)
    }

    /// A claim of size: the computed value is no less than `bound`.
    pub fn at_least(
        quantity: impl Into<String>,
        unit: &'static str,
        bound: f64,
        computed: f64,
        source: &'static str,
    ) -> Row {
        let deviation = if computed >= bound { 0.0 } else { bound - computed };
        Row::new(quantity, unit, [bound, computed, deviation, 0.0], source)
    }
}

/// The larger of two deviations. NaN is larger than any number, so that a check whose model gives none fails.
pub fn larger(largest: f64, deviation: f64) -> f64 {
    if deviation <= largest { largest } else { deviation }
}

/// The largest difference within pairs, relative to the largest first value.
pub fn largest_difference(pairs: &mut dyn Iterator<Item = (f64, f64)>) -> f64 {
    let (mut difference, mut size) = (0.0_f64, 0.0_f64);
    for (a, b) in pairs {
        size = size.max(a.abs());
        difference = larger(difference, (a - b).abs());
    }
    difference / size
}
