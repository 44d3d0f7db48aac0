//! A rigid wheel on an elastic rail pulls at creepage 0 and rolls freely at −0.16 %.

mod checks;

#[test]
fn the_wheel_pulls_at_creepage_zero_and_rolls_freely_at_a_negative_one() {
    checks::assert_rows(wheelrail::verification::rigid_wheel::rows());
}
