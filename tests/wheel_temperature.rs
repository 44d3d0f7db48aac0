//! The rim warms and cools as one heat capacity does, and the wheel wears what it slides off.

mod checks;

#[test]
fn the_rim_is_one_heat_capacity() {
    checks::assert_rows(wheelrail::verification::wheel_temperature::rows());
}
