//! The laws against their formulas on every branch and blend, and their derivatives against differences.

use super::*;
use crate::numerics::differences::slope;
use proptest::prelude::*;

fn parameters(wear_law: WearLaw) -> Parameters {
    Parameters {
        wear_law,
        ..Parameters::default()
    }
}

fn rate(parameters: &Parameters, point: Rubbing, rolling_speed: f64) -> f64 {
    PointwiseLaw::new(parameters, rolling_speed).unwrap().rate(&point)
}

/// Relative to round-off of a few operations.
fn assert_is(value: f64, expected: f64) {
    assert!((value / expected - 1.0).abs() < 1e-13, "{value} {expected}");
}

#[test]
fn the_map_is_its_formula_on_every_branch_and_blend() {
    let parameters = parameters(WearLaw::ArchardMap);
    let hardness = 3e9;
    // 3t² − 2t³ in the first fifth, quarter and half of a blend.
    let smooth = |t: f64| t * t * (3.0 - 2.0 * t);
    let severe = 35e-4 - 5e-4;
    for (speed, pressure, coefficient) in [
        (0.1, 1e9, 5e-4),
        // The blends are from 0.95 to 1.05 of where the steps are.
        (0.189, 1e9, 5e-4),
        (0.194, 1e9, 5e-4 + severe * smooth(0.2)),
        (0.2, 1e9, 5e-4 + severe * 0.5),
        (0.211, 1e9, 35e-4),
        (0.4, 1e9, 35e-4),
        (0.6825, 1e9, 35e-4 - severe * smooth(0.25)),
        (0.7, 1e9, 20e-4),
        (2.0, 1e9, 5e-4),
        (0.1, 0.76 * hardness, 5e-4),
        (0.1, 0.8 * hardness, 177.5e-4),
        (0.4, 0.78 * hardness, 35e-4 + 315e-4 * smooth(0.25)),
        (0.4, 0.84 * hardness, 350e-4),
        (2.0, 0.9 * hardness, 350e-4),
    ] {
        let point = Rubbing {
            pressure,
            speed,
            power: f64::NAN,
        };
        let expected = coefficient * speed * pressure / hardness;
        let found = rate(&parameters, point, 20.0);
        assert!(
            (found / expected - 1.0).abs() < 1e-12,
            "{speed} {pressure}: {found} {expected}"
        );
    }
}

/// µg/(m mm²) over N/mm², as published, outside of the blends; in the middle of a blend an eighth of it times the change of slope.
#[test]
fn the_energy_law_is_its_formula_on_every_branch_and_blend() {
    let parameters = parameters(WearLaw::Energy);
    let at = |work: f64, rolling_speed: f64| {
        let point = Rubbing {
            pressure: 1e9,
            speed: 0.1,
            power: work * 1e6 * rolling_speed,
        };
        // m/s of depth to µg/(m mm²).
        rate(&parameters, point, rolling_speed) / rolling_speed * 7.8e3 * 1e3
    };
    for speed in [0.3, 20.0] {
        for (work, mass) in [
            (0.1, 0.53),
            (9.8, 5.3 * 9.8),
            (11.0, 55.0),
            (40.0, 55.0),
            (74.0, 55.0),
            (82.1, 61.9 * 82.1 - 4778.7),
            (300.0, 61.9 * 300.0 - 4778.7),
        ] {
            assert!(
                (at(work, speed) / mass - 1.0).abs() < 1e-12,
                "{work}: {} {mass}",
                at(work, speed)
            );
        }
        let (first, last) = (55.0 / 5.3, (55.0 + 4778.7) / 61.9);
        assert_is(at(first, speed), 55.0 - 5.3 * 0.1 * first / 8.0);
        assert_is(at(last, speed), 55.0 + 61.9 * 0.1 * last / 8.0);
        // (t + h)²/(4h) at t = h/2.
        let half = 0.05 * first;
        assert_is(
            at(first + 0.5 * half, speed),
            5.3 * (first + 0.5 * half - 2.25 * half / 4.0),
        );
    }
    // Without rolling all work is beyond the threshold.
    let point = Rubbing {
        pressure: 1e9,
        speed: 0.1,
        power: 3e7,
    };
    assert_is(rate(&parameters, point, 0.0), 61.9e-9 * 3e7 / 7.8e3);
    assert_is(rate(&parameters, point, -1e-25), 61.9e-9 * 3e7 / 7.8e3);
}

#[test]
fn a_point_that_is_free_or_sticks_does_not_wear() {
    for law in [WearLaw::ArchardMap, WearLaw::Energy] {
        let parameters = parameters(law);
        for (pressure, speed) in [(0.0, 0.0), (0.0, 0.3), (1e9, 0.0)] {
            let point = Rubbing {
                pressure,
                speed,
                power: 0.0,
            };
            for rolling_speed in [0.0, -3.0, 20.0] {
                let law = PointwiseLaw::new(&parameters, rolling_speed).unwrap();
                assert_eq!(law.rate(&point), 0.0);
                assert_eq!(law.per_pressure(&point), 0.0);
            }
        }
    }
}

proptest! {
    /// Derivatives by pressure, slip speed, power and rolling speed, on all branches and blends.
    #[test]
    fn the_tangent_is_the_derivative(
        law in prop::sample::select(&[WearLaw::ArchardMap, WearLaw::Energy][..]),
        pressure in 2e9..3e9,
        log_speed in -1.2..0.2,
        log_work in 0.5..2.3,
        rolling_speed in 0.5..60.0,
        forward in any::<bool>(),
        blend in prop_oneof![Just(0.1), Just(1.0)],
        changes in prop::array::uniform4(-1.0..1.0_f64),
    ) {
        let parameters = Parameters { wear_blend: blend, ..parameters(law) };
        let speed = 10.0_f64.powf(log_speed);
        let point = Rubbing { pressure, speed, power: 10.0_f64.powf(log_work) * 1e6 * rolling_speed };
        let sign = if forward { 1.0 } else { -1.0 };
        let change = Rubbing {
            pressure: changes[0] * pressure,
            speed: changes[1] * speed,
            power: changes[2] * point.power,
        };
        let speed_change = changes[3] * rolling_speed;
        let at = |h: f64| {
            let moved = Rubbing {
                pressure: pressure + h * change.pressure,
                speed: speed + h * change.speed,
                power: point.power + h * change.power,
            };
            rate(&parameters, moved, sign * (rolling_speed + h * speed_change))
        };
        let law = PointwiseLaw::new(&parameters, sign * rolling_speed).unwrap();
        let exact = law.rate_tangent(&point, &change, speed_change);
        // Truncation h², round-off 1e-16/h.
        let difference = slope(at, 1e-7);
        prop_assert!((exact - difference).abs() <= 1e-6 * (exact.abs() + at(0.0)), "{exact} {difference}");
    }

    /// The rate that is taken into the normal problem is no less than the slope and no less than the mean slope.
    #[test]
    fn the_rate_per_pressure_bounds_that_of_the_law(
        law in prop::sample::select(&[WearLaw::ArchardMap, WearLaw::Energy][..]),
        pressure in 1e6..3e9,
        log_speed in -3.0..0.5,
    ) {
        let parameters = parameters(law);
        let speed = 10.0_f64.powf(log_speed);
        let at = |pressure: f64| Rubbing { pressure, speed, power: 0.4 * pressure * speed };
        let law = PointwiseLaw::new(&parameters, 20.0).unwrap();
        let taken = law.per_pressure(&at(pressure));
        let ahead = law.rate(&at(pressure * (1.0 + 1e-6)));
        prop_assert!(taken * pressure * (1.0 + 1e-12) >= law.rate(&at(pressure)));
        prop_assert!(taken * pressure * 1e-6 * 1.01 + 1e-15 * ahead >= ahead - law.rate(&at(pressure)));
    }
}
