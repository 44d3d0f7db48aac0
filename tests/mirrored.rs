//! Mirrored motion gives mirrored fields to 1e-10.

mod common;

#[test]
fn mirrored_motion_gives_mirrored_fields() {
    common::assert_rows(wheelrail::verification::mirrored::rows());
}
