//! Derivatives of the corrections at the leading edge against dual numbers: the equations of the heading of [`super`] as they stand there.

use super::tests::EDGE;
use super::*;
use num_dual::{Dual64, DualNum};
use proptest::prelude::*;

/// Corrections of the slip of both nodes, from the heading.
fn of_the_equations(
    front: &LeadingEdge,
    pressure: [Dual64; 3],
    shear: [Dual64; 3],
    friction: Dual64,
    gap: Dual64,
) -> [Dual64; 2] {
    let NearField {
        direct,
        coupling,
        layer,
    } = front.near_field;
    let [p, p1, p2] = pressure;
    // w/p, and γ = w E*/(2 Δx p).
    let separation = gap / p;
    let gamma = separation / direct;
    let held = if gamma.re < 1.0 { gamma } else { Dual64::from(1.0) };
    // w τ/p, and the layer's, which goes with γ.
    let strain = (separation + held * layer * direct) * shear[0];
    // The slip at an edge is against the shear there, which is that of a rail softer than the wheel along +x₁, and turned otherwise.
    let sign = coupling.signum() * if front.forward { 1.0 } else { -1.0 };
    let omega = gamma / (gamma + 1.0);
    let rest = -omega + 1.0;
    let next = rest * p1 + omega * p2;
    let ratio = rest * shear[1] / p1 + omega * shear[2] / p2;
    let k = coupling.abs() / (std::f64::consts::PI * direct);
    let exponent = (ratio * sign - friction) / k;
    let decay = if exponent.re < 0.0 {
        exponent.exp()
    } else {
        Dual64::from(1.0)
    };
    let hidden = (omega * rest * 0.57 + 0.21) * next * decay * (sign * coupling.abs());
    [
        (strain + rest * hidden) * front.strain_speed,
        omega * hidden * front.strain_speed,
    ]
}

proptest! {
    /// Partial derivatives at edges that stick and that slip, ahead of and behind the axle, with the layer's part held and not, on rails
    /// softer and harder than the wheel.
    #[test]
    fn the_partial_derivatives_are_those_of_the_equations(
        pressure in prop::array::uniform3(0.05..0.5_f64),
        ratio in prop::array::uniform3(-0.4..0.4_f64),
        gap in 1e-4..0.05_f64,
        change in prop::array::uniform8(-1.0..1.0_f64),
        forward in any::<bool>(),
        soft_rail in any::<bool>(),
    ) {
        let mut front = LeadingEdge { forward, ..EDGE };
        if !soft_rail {
            front.near_field.coupling *= -1.0;
        }
        let shear: [f64; 3] = std::array::from_fn(|k| ratio[k] * pressure[k]);
        let edge = EdgeValues { pressure, shear, friction: 0.3, gap };
        let [a, b, c, d, e, f, friction, gap_change] = change;
        let change = EdgeValues { pressure: [a, b, c], shear: [d, e, f], friction, gap: gap_change };
        let expected = of_the_equations(
            &front,
            std::array::from_fn(|k| Dual64::new(pressure[k], change.pressure[k])),
            std::array::from_fn(|k| Dual64::new(shear[k], change.shear[k])),
            Dual64::new(0.3, friction),
            Dual64::new(gap, gap_change),
        );
        for (row, (added, expected)) in front.corrections(&edge).iter().zip(expected).enumerate() {
            let tangent = added.change(&change);
            prop_assert!((added.slip - expected.re).abs() < 1e-13 * (1.0 + expected.re.abs()), "{row}: {} {expected}", added.slip);
            prop_assert!((tangent - expected.eps).abs() < 1e-12 * (1.0 + expected.eps.abs()), "{row}: {tangent} {expected}");
        }
    }
}
