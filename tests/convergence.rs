//! Manufactured solutions: each field approaches its exact one at the order of its scheme.

mod common;

#[test]
fn each_field_converges_at_its_order() {
    common::assert_rows(wheelrail::verification::convergence::rows());
}
