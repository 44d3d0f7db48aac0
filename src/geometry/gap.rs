//! Undeformed gap between wheel and rail that touch at the origin.

/// Gap of a wheel of circular profile over a plane rail, r₀ − √(r₀² − x²), `m`, at the distance x along the rail, without the
/// cancellation (9).
pub fn of_circle(radius: f64, x: f64) -> f64 {
    x * x / (radius + (radius * radius - x * x).sqrt())
}

/// Gap of bodies of constant curvatures, A x² + B y², `m`: A and B are half the sums of the bodies' curvatures along and across the rail.
pub fn of_curvatures((along, across): (f64, f64), [x, y]: [f64; 2]) -> f64 {
    along * x * x + across * y * y
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Both agree to the order that the parabola leaves out, x⁴/8r³.
    #[test]
    fn a_circle_is_a_parabola_near_its_top() {
        let radius = 0.46;
        for x in [1e-5, 1e-3, 1e-2] {
            let (circle, parabola) = (of_circle(radius, x), of_curvatures((0.5 / radius, 0.0), [x, 0.3]));
            let left_out = x.powi(4) / (8.0 * radius.powi(3));
            let round_off = f64::EPSILON * parabola;
            assert!(
                (circle - parabola - left_out).abs() <= 1e-3 * left_out + round_off,
                "{x}"
            );
        }
    }
}
