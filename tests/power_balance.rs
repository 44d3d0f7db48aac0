//! Friction power is what wheel and vehicle supply, P = T(ωr₀ − V) + VNe/r₀, to first order in the node spacing.

mod checks;

#[test]
fn friction_power_is_the_power_supplied() {
    checks::assert_rows(wheelrail::verification::power_balance::rows());
}
