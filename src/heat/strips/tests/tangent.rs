//! The tangents of the three parts of a step against differences of the step.

use super::*;
use crate::numerics::differences::assert_tangent;

/// Speed, breadth, ambient, friction scale, pressure, slip, wheel and what comes in all change at once: at speed, so slow that no cell
/// is crossed in a step, after a turn, in the steady field, and, all but the speed, at standstill.
#[test]
fn the_tangent_is_the_derivative() {
    // A law without corners.
    let parameters = Parameters {
        friction_law: FrictionLaw::Table,
        friction_table_points: 2,
        friction_table_temperature: std::array::from_fn(|i| 200.0 + 4000.0 * i as f64),
        ..parameters()
    };
    let rail = rail();
    let cells = STRIPS * CELLS;
    let load = |place: usize, shift: f64| (0.4 + (1.7 * place as f64).sin() + shift).max(0.0);
    let exchange = |h: f64| -> Vec<SurfaceExchange> {
        (0..cells)
            .map(|place| match load(place, 0.0) {
                0.0 => SurfaceExchange::default(),
                load => {
                    let sliding = Sliding {
                        speed: 0.1 + 0.01 * h,
                        power: 0.09 + 0.012 * h,
                    };
                    SurfaceExchange::new(&parameters, 1e9 * load + 1e8 * h, sliding, 20.0 + 4.0 * h)
                }
            })
            .collect()
    };
    let exchange_tangent: Vec<ExchangeTangent> = (0..cells)
        .map(|place| {
            let change = ExchangeChange {
                pressure: 1e8,
                sliding: Sliding {
                    speed: 0.01,
                    power: 0.012,
                },
                wheel_rise: 4.0,
                coefficient: 0.0,
            };
            let sliding = Sliding {
                speed: 0.1,
                power: 0.09,
            };
            SurfaceExchange::tangent(&parameters, 1e9 * load(place, 0.0), sliding, 20.0, &change)
        })
        .collect();
    for (first, start, duration, speed_change, rise_change) in [
        (10.0, 10.0, 1e-3, 0.7, 3.0),
        (10.0, 10.0, 1e-3, 0.0, 3.0),
        (10.0, 10.0, 1e-3, 0.0, 0.0),
        (-10.0, -10.0, 1e-3, 0.7, 3.0),
        (0.1, 0.1, 1e-3, 0.7, 3.0),
        (10.0, -10.0, 1e-4, 0.7, 3.0),
        (10.0, 10.0, f64::INFINITY, 0.7, 3.0),
        (10.0, 0.0, 1e-3, 0.0, 3.0),
    ] {
        let mut scratch = StripHeatScratch::new(&rail.basis, &rail.strips);
        let mut before = rail.cold();
        for number in 0..4 {
            let breadth = 5e-3 + 1e-3 * f64::from(number);
            let march = rail.march(&parameters, first, 1e-3);
            before = step(
                &march,
                &before,
                &exchange(0.3 * f64::from(number)),
                12.0,
                breadth,
                &mut scratch,
            );
        }
        let march = |h: f64| {
            let mut march = rail.march(
                &parameters,
                start + speed_change * 1.0_f64.copysign(start) * h,
                duration,
            );
            march.surface.friction.ambient = 293.0 + 5.0 * h;
            march.surface.friction.scale = 0.9 + 0.1 * h;
            march
        };
        let mut scratch = StripHeatScratch::new(&rail.basis, &rail.strips);
        let mut solve = |h: f64| {
            step(
                &march(h),
                &before,
                &exchange(h),
                10.0 + rise_change * h,
                6e-3 + 1e-3 * h,
                &mut scratch,
            )
        };
        let h = 1e-5;
        let (here, ahead, behind) = (solve(0.0), solve(h), solve(-h));
        let mut tangent = rail.cold();
        let carriage = CarriageChange {
            speed: speed_change,
            rise: rise_change,
            breadth: 1e-3,
        };
        let mut change = StripHeatChange {
            common: CommonChange {
                ambient: 5.0,
                friction_scale: 0.1,
            },
            exchange: &exchange(0.0),
            exchange_tangent: &vec![ExchangeTangent::default(); cells],
        };
        let march = march(0.0);
        march.start_tangent(&here, &carriage, &mut tangent, &mut scratch);
        // Another change before it leaves nothing behind.
        march.heat_tangent(&here, &change, &mut tangent, &mut scratch).unwrap();
        march.finalise_tangent(&here, &carriage, &mut tangent, &mut scratch);
        change.exchange_tangent = &exchange_tangent;
        march.heat_tangent(&here, &change, &mut tangent, &mut scratch).unwrap();
        march.finalise_tangent(&here, &carriage, &mut tangent, &mut scratch);
        let vectors = tangent.vectors().into_iter().zip(ahead.vectors()).zip(behind.vectors());
        // Truncation h², round-off and the tolerance of the surface condition over h.
        for (number, ((exact, ahead), behind)) in vectors.enumerate().take(6) {
            let place = format!("{first} {start} {duration} {number}");
            let size = dense::largest(exact);
            assert_tangent(place, exact, [ahead, behind], 2.0 * h, 1e-6 * size);
            // Without a change there, nothing changes ahead, on the right for V > 0.
            let still_ahead = speed_change == 0.0 && rise_change == 0.0 && number == 2;
            assert_eq!(size > 0.0, !still_ahead);
        }
        assert_eq!(tangent.breadth, 1e-3);
    }
}
