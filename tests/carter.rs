//! Carter's creep curve T/(μN) = 1 − (1 − ξr₀/(μa))² and his stick zone at the leading edge.

mod checks;

#[test]
fn creep_curve_and_stick_zone_are_those_of_carter() {
    checks::assert_rows(wheelrail::verification::carter::rows());
}
