//! The tangent of the march against its differences.

use super::*;
use crate::friction::FrictionState;
use crate::friction::coulomb::Sliding;
use crate::heat::surface::ExchangeChange;
use crate::numerics::differences::assert_tangent;
use crate::parameters::{FrictionLaw, Parameters};
use crate::settings::HeatSettings;

/// Columns that widen to both sides, the five in the middle in contact.
const X: [f64; 9] = [-0.1, -0.01, -0.004, -0.002, 0.0, 0.002, 0.004, 0.01, 0.1];
const FIRST: usize = 2;
const NODES: usize = 5;

struct Field {
    amplitudes: Vec<f64>,
    surface: Vec<f64>,
    flux: Vec<f64>,
}

impl Field {
    fn new(modes: usize) -> Field {
        Field {
            amplitudes: vec![0.0; X.len() * modes],
            surface: vec![0.0; X.len()],
            flux: vec![0.0; NODES],
        }
    }

    fn heated(&mut self) -> Heated<'_> {
        Heated {
            amplitudes: &mut self.amplitudes,
            surface: &mut self.surface,
            flux: &mut self.flux,
        }
    }
}

fn parameters() -> Parameters {
    Parameters {
        // A law without corners.
        friction_law: FrictionLaw::Table,
        friction_table_points: 2,
        friction_table_temperature: std::array::from_fn(|i| 200.0 + 4000.0 * i as f64),
        contact_thermal_resistance: 100.0,
        wear_coefficient: 1e-11,
        ..Parameters::default()
    }
}

/// Speed, ambient, friction scale, pressure, slip speed, wheel and what comes in all change at once: at speed, so slow that
/// no cell is crossed in a step, in the steady field, and, all but the speed, at standstill.
#[test]
fn the_tangent_is_the_derivative() {
    let parameters = parameters();
    let depth: Vec<f64> = (0..12).map(|row| 1e-5 * (1.8_f64.powi(row) - 1.0)).collect();
    let basis = DepthBasis::new(&depth).unwrap();
    let m = basis.len();
    let before: Vec<f64> = (0..X.len() * m)
        .map(|k| 0.02 * (1.0 + 0.3 * ((k / m) as f64).sin()) / (1.0 + (k % m) as f64))
        .collect();
    let entering = |h: f64| 10.0 + 3.0 * h;
    for (start, duration, speed_change) in [
        (10.0, 1e-3, 0.7),
        (-10.0, 1e-3, 0.7),
        (0.1, 1e-3, 0.7),
        (10.0, f64::INFINITY, 0.7),
        (0.0, 1e-3, 0.0),
    ] {
        let direction = 1.0_f64.copysign(start);
        let march = |h: f64| HeatMarch {
            basis: &basis,
            transport: Upwind::new(&X, start + direction * speed_change * h),
            first_contact: FIRST,
            duration,
            surface: SurfaceCondition {
                friction: FrictionState {
                    parameters: &parameters,
                    ambient: 293.0 + 5.0 * h,
                    scale: 0.9 + 0.1 * h,
                },
                settings: HeatSettings::default(),
            },
        };
        let pressure = |node: usize, h: f64| 1e9 * (1.0 + 0.1 * node as f64) + h * 1e8;
        let sliding = |node: usize, h: f64| Sliding {
            speed: 0.1 + 0.02 * node as f64 + h * 0.01,
            power: 0.09 + 0.02 * node as f64 + h * 0.012,
        };
        let exchange = |h: f64| -> Vec<SurfaceExchange> {
            (0..NODES)
                .map(|node| SurfaceExchange::new(&parameters, pressure(node, h), sliding(node, h), 20.0 + 4.0 * h))
                .collect()
        };
        let enter = |field: &mut Field, rise: f64, inflow: usize| {
            field.amplitudes[inflow * m..(inflow + 1) * m].fill(rise);
        };
        let solve = |h: f64| {
            let march = march(h);
            let mut after = Field::new(m);
            enter(&mut after, entering(h), march.transport.inflow());
            march
                .advance(
                    &before,
                    &exchange(h),
                    &mut after.heated(),
                    &mut CellFactors::new(&basis, &X),
                )
                .unwrap();
            after
        };
        let mut solution = solve(0.0);
        let exchange_tangent: Vec<ExchangeTangent> = (0..NODES)
            .map(|node| {
                let change = ExchangeChange {
                    pressure: 1e8,
                    sliding: Sliding {
                        speed: 0.01,
                        power: 0.012,
                    },
                    wheel_rise: 4.0,
                    coefficient: 0.0,
                };
                SurfaceExchange::tangent(&parameters, pressure(node, 0.0), sliding(node, 0.0), 20.0, &change)
            })
            .collect();
        let mut tangent = Field::new(m);
        enter(&mut tangent, 3.0, march(0.0).transport.inflow());
        let change = MarchChange {
            speed: speed_change,
            common: CommonChange {
                ambient: 5.0,
                friction_scale: 0.1,
            },
            exchange: &exchange(0.0),
            exchange_tangent: &exchange_tangent,
            replaced_inflow: &before[march(0.0).transport.inflow() * m..][..m],
        };
        let mut cells = CellFactors::new(&basis, &X);
        march(0.0).advance_tangent(&solution.heated(), &change, &mut tangent.heated(), &mut cells);
        let h = 1e-5;
        let (ahead, behind) = (solve(h), solve(-h));
        let outflow = march(0.0).transport.outflow();
        for (name, exact, ahead, behind) in [
            (
                "temperature",
                &tangent.amplitudes,
                &ahead.amplitudes,
                &behind.amplitudes,
            ),
            ("surface", &tangent.surface, &ahead.surface, &behind.surface),
            ("flux", &tangent.flux, &ahead.flux, &behind.flux),
        ] {
            // Truncation h², round-off and the tolerance of the surface condition over h.
            let place = format!("{start} {duration} {name}");
            let size = dense::largest(exact);
            assert_tangent(place, exact, [ahead, behind], 2.0 * h, 1e-6 * size);
            assert!(size > 0.0);
        }
        assert!(start == 0.0 || tangent.surface[outflow] != 0.0);
    }
}
