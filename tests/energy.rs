//! The discrete heat balance closes to 1e-10 in transients, at speed, slowly, and on the spot.

mod common;

#[test]
fn heat_stored_carried_out_and_given_off_is_the_heat_of_friction() {
    common::assert_rows(wheelrail::verification::energy::rows());
}
