//! Flash temperature of a sliding semi-elliptic source, θ = 1/(ρc√(πκ)) ∫ q(t′)/√(t − t′) dt′.

mod common;

#[test]
fn the_march_gives_the_flash_temperature_of_the_integral() {
    common::assert_rows(wheelrail::verification::flash_temperature::rows());
}
