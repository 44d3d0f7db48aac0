//! The discrete heat balance closes to 1e-10 in transients, at speed, slowly, and on the spot.

mod checks;

#[test]
fn heat_stored_carried_out_and_given_off_is_the_heat_of_friction() {
    checks::assert_rows(wheelrail::verification::energy::rows());
}
