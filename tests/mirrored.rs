//! Mirrored motion gives mirrored fields to 1e-10.

mod checks;

#[test]
fn mirrored_motion_gives_mirrored_fields() {
    checks::assert_rows(wheelrail::verification::mirrored::rows());
}
