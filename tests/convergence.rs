//! Manufactured solutions: each field approaches its exact one at the order of its scheme.

mod checks;

#[test]
fn each_field_converges_at_its_order() {
    checks::assert_rows(wheelrail::verification::convergence::rows());
}
