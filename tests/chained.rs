//! Wheels chained by what the rail carries from one to the next: wear and heat are conserved, and the temperature is that of a
//! wake of its age.

mod checks;

#[test]
fn the_rail_carries_heat_and_wear_from_wheel_to_wheel() {
    checks::assert_rows(wheelrail::verification::chained::rows());
}
