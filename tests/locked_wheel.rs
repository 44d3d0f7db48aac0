//! The locked wheel: less wear where friction falls with temperature, and a zone moved by thermal expansion.

mod checks;

#[test]
fn wear_and_contact_zone_change_as_in_the_paper() {
    checks::assert_rows(wheelrail::verification::locked_wheel::rows());
}
