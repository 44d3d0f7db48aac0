//! The paper's cases: peaks, their drops in a, b, c, and what section 5 says of the fields.

mod checks;

#[test]
fn peaks_and_fields_are_those_of_the_paper() {
    checks::assert_rows(wheelrail::verification::paper_cases::rows());
}
