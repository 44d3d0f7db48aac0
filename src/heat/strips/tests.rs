//! Tests of the strips against the march of one, and of the balance of the whole.

mod tangent;

use super::*;
use crate::body::mesh::Mesh;
use crate::friction::FrictionState;
use crate::friction::coulomb::Sliding;
use crate::heat::step::{DecayRate, ModeStep, Transit};
use crate::heat::surface::{CommonChange, ExchangeChange, ExchangeTangent};
use crate::numerics::dense::MultiplyAdd;
use crate::parameters::{FrictionLaw, Parameters};
use crate::settings::HeatSettings;
use crate::transport::Upwind;
use proptest::prelude::*;

const CELLS: usize = 12;
const STRIPS: usize = 10;
const BREADTH: f64 = 1e-3;

struct Rail {
    mesh: Mesh,
    basis: DepthBasis,
    incoming: Incoming,
    strips: Strips,
}

fn rail_of(cells: usize, strips: usize, outer: usize, depth: usize) -> Rail {
    let mesh = Mesh::graded(6e-3, cells, 0.5, outer, 0.2, depth, 10e-6);
    let basis = DepthBasis::new(&mesh.depth).unwrap();
    Rail {
        incoming: Incoming::new(&mesh.depth, &basis, 5e-3),
        strips: Strips::new(&mesh.x, mesh.first_contact..mesh.first_contact + cells, strips, BREADTH),
        basis,
        mesh,
    }
}

fn rail() -> Rail {
    rail_of(CELLS, STRIPS, 6, 16)
}

fn parameters() -> Parameters {
    Parameters {
        contact_thermal_resistance: 1000.0,
        wear_coefficient: 1e-11,
        ..Parameters::default()
    }
}

impl Rail {
    fn march<'a>(&'a self, parameters: &'a Parameters, speed: f64, duration: f64) -> StripHeatMarch<'a> {
        StripHeatMarch {
            basis: &self.basis,
            incoming: &self.incoming,
            strips: &self.strips,
            speed,
            duration,
            surface: condition(parameters),
        }
    }

    fn cold(&self) -> StripTemperature {
        StripTemperature::new(&self.strips, self.basis.len())
    }

    /// B a_beside + Σ b (a_j − a_beside) of a column of the strips as heat content, `K m²`.
    fn column_heat(&self, march: &StripHeatMarch, field: &StripTemperature, column: usize) -> Vec<f64> {
        (0..self.basis.len())
            .map(|mode| {
                field.breadth
                    * self
                        .strips
                        .mean(field.breadth, |strip| field.window[march.place(strip, column, mode)])
            })
            .collect()
    }
}

fn condition(parameters: &Parameters) -> SurfaceCondition<'_> {
    SurfaceCondition {
        friction: FrictionState {
            parameters,
            ambient: 293.15,
            scale: 0.9,
        },
        settings: HeatSettings::default(),
    }
}

/// Exchange at the cells: friction in some strips, where `loads` (strips × cells) is positive.
fn exchange(parameters: &Parameters, loads: &[f64], wheel_rise: f64) -> Vec<SurfaceExchange> {
    loads
        .iter()
        .map(|&load| {
            SurfaceExchange::new(
                parameters,
                1e9 * load.max(0.0),
                Sliding::new(0.3 + load, 0.9),
                wheel_rise,
            )
        })
        .collect()
}

fn step(
    march: &StripHeatMarch,
    before: &StripTemperature,
    exchange: &[SurfaceExchange],
    rise: f64,
    breadth: f64,
    scratch: &mut StripHeatScratch,
) -> StripTemperature {
    let mut after = before.clone();
    march.start(before, rise, &mut after, scratch).unwrap();
    march.heat(exchange, &mut after, scratch).unwrap();
    march.finalise(before, breadth, &mut after, scratch).unwrap();
    after
}

/// A strip as the march of the line contact sees it: all its columns, those outside the window as they are for all strips.
struct Single {
    amplitudes: Vec<f64>,
    surface: Vec<f64>,
    flux: Vec<f64>,
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(30))]
    /// Two steps, of which the second may go the other way.
    #[test]
    fn each_strip_is_the_march_of_one(
        loads in prop::collection::vec(-1.0..1.0, STRIPS * CELLS),
        log_speed in -2.0..2.0,
        signs in prop::array::uniform2(any::<bool>()),
        stands in any::<bool>(),
        log_duration in -5.0..1.0,
        rise in prop_oneof![Just(0.0), 0.0..50.0],
    ) {
        let (rail, parameters) = (rail(), parameters());
        let (strips, m) = (&rail.strips, rail.basis.len());
        let mut before = rail.cold();
        let mut scratch = StripHeatScratch::new(&rail.basis, strips);
        let mut cells = CellFactors::new(&rail.basis, &rail.mesh.x);
        let duration = 10.0_f64.powf(log_duration);
        // Standstill counts as forward.
        let directions = [signs[0], signs[1] || stands];
        for (number, forward) in directions.into_iter().enumerate() {
            let size = if stands && number == 1 { 0.0 } else { 10.0_f64.powf(log_speed) };
            let speed = if forward { size } else { -size };
            let march = rail.march(&parameters, speed, duration);
            let exchange = exchange(&parameters, &loads, 20.0);
            // Another exchange before it leaves nothing behind.
            let mut after = rail.cold();
            march.start(&before, rise, &mut after, &mut scratch).unwrap();
            let mut other = exchange.clone();
            other.reverse();
            march.heat(&other, &mut after, &mut scratch).unwrap();
            march.heat(&exchange, &mut after, &mut scratch).unwrap();
            march.finalise(&before, 5e-3, &mut after, &mut scratch).unwrap();
            for strip in 0..=STRIPS {
                let (ahead, _) = strips.ends(speed);
                let mut line = vec![0.0; rail.mesh.columns() * m];
                let outer = match ahead {
                    Side::Left => 0..(rail.mesh.first_contact - 1) * m,
                    Side::Right => (rail.mesh.first_contact + CELLS + 1) * m..rail.mesh.columns() * m,
                };
                let far = match ahead {
                    Side::Left => &before.outer[0][..outer.len()],
                    Side::Right => &before.outer[1][m..],
                };
                line[outer].copy_from_slice(far);
                for column in 0..strips.columns() {
                    for mode in 0..m {
                        line[(rail.mesh.first_contact - 1 + column) * m + mode] =
                            before.window[march.place(strip, column, mode)];
                    }
                }
                let heat_march = HeatMarch {
                    basis: &rail.basis,
                    transport: Upwind::new(&rail.mesh.x, speed),
                    first_contact: rail.mesh.first_contact,
                    duration,
                    surface: condition(&parameters),
                };
                let mut single = Single {
                    amplitudes: vec![0.0; line.len()],
                    surface: vec![0.0; rail.mesh.columns()],
                    flux: vec![0.0; CELLS],
                };
                let inflow = heat_march.transport.inflow();
                rail.incoming.enter(rise, &mut single.amplitudes[inflow * m..][..m], &mut 0.0);
                // After a turn a strip's own heat stands where rail enters, and the mean ahead of it: what enters is that of the
                // patch then.
                let turned = number == 1 && directions[0] != directions[1];
                let none = vec![SurfaceExchange::default(); CELLS];
                let own = exchange.chunks_exact(CELLS).nth(strip).unwrap_or(&none);
                let mut field = Heated {
                    amplitudes: &mut single.amplitudes,
                    surface: &mut single.surface,
                    flux: &mut single.flux,
                };
                if turned {
                    let window = strips.window(speed);
                    let entering = match ahead {
                        Side::Left => 0..m,
                        Side::Right => (CELLS + 1) * m..(CELLS + 2) * m,
                    };
                    let offset = (rail.mesh.first_contact - 1) * m;
                    let columns = offset..offset + strips.columns() * m;
                    for mode in 0..m {
                        field.amplitudes[offset + entering.start + mode] =
                            after.window[march.place(strip, window.inflow(), mode)];
                    }
                    let march = HeatMarch { transport: window, first_contact: 1, ..heat_march };
                    let mut field = Heated {
                        amplitudes: &mut field.amplitudes[columns.clone()],
                        surface: &mut field.surface[rail.mesh.first_contact - 1..],
                        flux: field.flux,
                    };
                    let mut cells = CellFactors::new(&rail.basis, window.positions());
                    march.advance(&line[columns], own, &mut field, &mut cells).unwrap();
                } else {
                    heat_march.advance(&line, own, &mut field, &mut cells).unwrap();
                }
                // The flux is what conduction leaves of the heat, with the round-off of the whole.
                let loss = own.iter().map(|exchange| exchange.debris + exchange.conduction).fold(0.0, f64::max);
                let tolerance = 1e-13 * (1.0 + 0.5 * scratch.responses.surface[0] * loss);
                let size = dense::largest(&single.amplitudes);
                for column in 0..strips.columns() {
                    for mode in 0..m {
                        let (found, expected) = (
                            after.window[march.place(strip, column, mode)],
                            single.amplitudes[(rail.mesh.first_contact - 1 + column) * m + mode],
                        );
                        prop_assert!((found - expected).abs() <= tolerance * size, "{strip} {column} {mode}: {found:e} {expected:e}");
                    }
                }
                if strip == STRIPS {
                    continue;
                }
                // Round-off of the sums over the modes.
                let sum = |weights: &[f64]| {
                    let columns = single.amplitudes.chunks_exact(m);
                    let sums = columns.map(|column| column.iter().zip(weights).map(|(a, w)| (a * w).abs()).sum());
                    sums.fold(0.0, |most: f64, sum: f64| most.max(sum))
                };
                let (surface, content) = (sum(&rail.basis.surface), sum(&rail.basis.integral));
                let flux = dense::largest(&single.flux);
                for cell in 0..CELLS {
                    let place = strip * CELLS + cell;
                    let column = rail.mesh.first_contact + cell;
                    for (found, expected, size) in [
                        (after.surface[place], single.surface[column], surface),
                        (after.flux[place], single.flux[cell], flux),
                        (after.content[place], rail.basis.content(single.amplitudes[column * m..][..m].iter().copied()), content),
                    ] {
                        prop_assert!((found - expected).abs() <= tolerance * size, "{strip} {cell}: {found:e} {expected:e}");
                    }
                }
            }
            before = after;
        }
    }

    /// Balance of every mode: all cells store, lose and hand on what the flux supplies, over several steps of a contact of one breadth,
    /// with rail that comes in warm.
    #[test]
    fn the_heat_of_each_mode_is_balanced(
        loads in prop::collection::vec(-1.0..1.0, STRIPS * CELLS),
        speeds in prop::array::uniform4(-20.0..20.0_f64),
        log_duration in -4.0..-1.0,
        rise in 0.0..50.0,
    ) {
        let (rail, parameters) = (rail(), parameters());
        let (strips, m) = (&rail.strips, rail.basis.len());
        let mut before = rail.cold();
        before.breadth = 5e-3;
        let mut scratch = StripHeatScratch::new(&rail.basis, strips);
        let duration = 10.0_f64.powf(log_duration);
        for speed in speeds {
            let march = rail.march(&parameters, speed, duration);
            let exchange = exchange(&parameters, &loads, 0.0);
            let after = step(&march, &before, &exchange, rise, 5e-3, &mut scratch);
            // What the columns hold and take over the breadth B, by mode.
            let columns = |field: &StripTemperature, column: usize| -> Vec<f64> {
                let first = rail.mesh.first_contact - 1;
                let outer = |side: Side, at: usize| -> Vec<f64> {
                    let amplitudes = &field.outer[side as usize][at * m..][..m];
                    amplitudes.iter().map(|a| a * field.breadth).collect()
                };
                match column {
                    c if c < first => outer(Side::Left, c),
                    c if c < first + strips.columns() => rail.column_heat(&march, field, c - first),
                    c => outer(Side::Right, c - first - strips.columns() + 1),
                }
            };
            let source = |column: usize| -> f64 {
                let cell = column.wrapping_sub(rail.mesh.first_contact);
                if cell >= CELLS {
                    return 0.0;
                }
                (0..STRIPS).map(|strip| BREADTH * after.flux[strip * CELLS + cell]).sum::<f64>()
                    / parameters.volumetric_heat_capacity()
            };
            let transport = Upwind::new(&rail.mesh.x, speed);
            let mut scales = vec![0.0_f64; m];
            let mut balance = vec![0.0; m];
            for column in transport.columns() {
                let [own, upstream] = [column.index, column.upstream].map(|c| (columns(&after, c), columns(&before, c)));
                for mode in 0..m {
                    let rate = parameters.thermal_diffusivity * rail.basis.eigenvalues[mode];
                    let transit = Transit::new(column.spacing, speed.abs());
                    let cell = ModeStep::at(MultiplyAdd::SEPARATE, DecayRate::new(rate), 1.0 / duration, transit);
                    let source_weight = cell.source_upstream / (cell.source_upstream + cell.source);
                    let storage_weight = cell.old_upstream / (cell.old_upstream + cell.old);
                    let mean = |share: f64, up: f64, own: f64| share * up + (1.0 - share) * own;
                    let phi = rail.basis.surface[mode];
                    let terms = [
                        column.spacing / duration * mean(storage_weight, upstream.0[mode] - upstream.1[mode], own.0[mode] - own.1[mode]),
                        speed.abs() * (own.0[mode] - upstream.0[mode]),
                        column.spacing * rate * mean(source_weight, upstream.0[mode], own.0[mode]),
                        -column.spacing * phi * mean(source_weight, source(column.upstream), source(column.index)),
                    ];
                    balance[mode] += terms.iter().sum::<f64>();
                    scales[mode] = terms.iter().fold(scales[mode], |s, t| s.max(t.abs()));
                }
            }
            for mode in 0..m {
                // Lengths of cells are the same but for the round-off of positions.
                prop_assert!(balance[mode].abs() <= 1e-11 * scales[mode], "{mode}: {:e} {:e}", balance[mode], scales[mode]);
            }
            before = after;
        }
    }
}

/// Rail that comes in warm leaves as warm as it came, but for conduction: however few of the strips are in contact.
#[test]
fn what_enters_leaves() {
    let (rail, parameters) = (rail(), parameters());
    let march = rail.march(&parameters, 10.0, f64::INFINITY);
    let mut scratch = StripHeatScratch::new(&rail.basis, &rail.strips);
    let none = vec![SurfaceExchange::default(); STRIPS * CELLS];
    for breadth in [0.0, 1e-3, 5e-3] {
        let after = step(&march, &rail.cold(), &none, 40.0, breadth, &mut scratch);
        let leaving = rail.incoming.equivalent_rise(&rail.basis, march.leaving(&after));
        assert!((leaving / 40.0 - 1.0).abs() < 1e-3, "{leaving}");
    }
}
