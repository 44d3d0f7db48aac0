//! Flash temperature of a sliding semi-elliptic source, θ = 1/(ρc√(πκ)) ∫ q(t′)/√(t − t′) dt′.

mod checks;

#[test]
fn the_march_gives_the_flash_temperature_of_the_integral() {
    checks::assert_rows(wheelrail::verification::flash_temperature::rows());
}
