//! Hertz's line contact: a = √(4Nr₀/(πbE*)) and p₀ = 2N/(πab) over 10–100 % of the largest load.

mod checks;

#[test]
fn half_length_and_peak_pressure_are_those_of_hertz() {
    checks::assert_rows(wheelrail::verification::hertz::rows());
}
