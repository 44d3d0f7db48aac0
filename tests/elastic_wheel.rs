//! An elastic wheel: Hertz's contact with the combined modulus, Carter's curve without any switch, free rolling.

mod checks;

#[test]
fn an_elastic_wheel_rolls_as_hertz_and_carter_have_it() {
    checks::assert_rows(wheelrail::verification::elastic_wheel::rows());
}
