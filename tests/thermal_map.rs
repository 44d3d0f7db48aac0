//! The compressed map from temperature to displacement against the exact one, on fields that the heat march makes under
//! random fluxes, speeds and times.

mod checks;

use checks::largest_difference;
use proptest::prelude::*;
use std::sync::OnceLock;
use wheelrail::body::compliance::{self, Scales, ThermalDisplacement};
use wheelrail::contact::line::rail::Rail;
use wheelrail::friction::FrictionState;
use wheelrail::heat::incoming::Incoming;
use wheelrail::heat::march::{HeatMarch, Heated};
use wheelrail::heat::surface::{SurfaceCondition, SurfaceExchange};
use wheelrail::heat::thermal_map::{TOLERANCE, exact_displacement};
use wheelrail::parameters::{FrictionLaw, Parameters};
use wheelrail::settings::HeatSettings;
use wheelrail::transport::Upwind;

fn parameters() -> Parameters {
    Parameters {
        friction_law: FrictionLaw::Constant,
        friction_cold: 1.0,
        ..Parameters::default()
    }
}

fn rail() -> &'static (Rail, ThermalDisplacement) {
    static RAIL: OnceLock<(Rail, ThermalDisplacement)> = OnceLock::new();
    RAIL.get_or_init(|| {
        let parameters = parameters();
        let rail = Rail::new(&parameters).unwrap();
        let (_, exact) = compliance::build(&rail.mesh, &parameters, &Scales::new(&parameters)).unwrap();
        (rail, exact)
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]
    #[test]
    fn the_compressed_map_is_the_exact_one_within_its_tolerance(
        flux in prop::collection::vec(0.0..1e9, 61),
        contact in 5_usize..30,
        log_speed in -1.5..2.1,
        backward in any::<bool>(),
        log_step in -4.0..1.0,
        steps in 1_usize..6,
    ) {
        let (rail, exact) = rail();
        let parameters = parameters();
        let speed = 10.0_f64.powf(log_speed) * if backward { -1.0 } else { 1.0 };
        let exchange: Vec<SurfaceExchange> = flux
            .iter()
            .enumerate()
            .map(|(node, &friction)| SurfaceExchange {
                friction: if node.abs_diff(30) < contact { friction } else { 0.0 },
                debris: 0.0,
                conduction: 0.0,
                wheel: 0.0,
            })
            .collect();
        let march = HeatMarch {
            basis: &rail.heat.basis,
            transport: Upwind::new(&rail.mesh.x, speed),
            first_contact: rail.mesh.first_contact,
            duration: 10.0_f64.powf(log_step),
            surface: SurfaceCondition {
                friction: FrictionState { parameters: &parameters, ambient: 293.15, scale: 1.0 },
                settings: HeatSettings::default(),
            },
        };
        let size = rail.mesh.columns() * rail.heat.basis.len();
        let (mut before, mut after) = (vec![0.0; size], vec![0.0; size]);
        for _ in 0..steps {
            march.advance(
                &before,
                &exchange,
                &mut Heated {
                    temperature: &mut after,
                    surface: &mut vec![0.0; rail.mesh.columns()],
                    flux: &mut vec![0.0; 61],
                },
                &mut vec![0.0; HeatMarch::scratch_len(&rail.heat.basis)],
            ).unwrap();
            std::mem::swap(&mut before, &mut after);
        }
        let expected = exact_displacement(&rail.mesh, &rail.heat.basis, exact, &before);
        let mut computed = vec![0.0; expected.len()];
        rail.heat.displacement.apply(&before, &mut vec![0.0; rail.heat.displacement.scratch_len()], &mut computed);
        // Each moment of each column keeps its gains down to TOLERANCE of the largest displacement that a unit of it
        // makes in the middle of the window; what the columns drop adds up with random signs.
        let error = largest_difference(&expected, &computed);
        prop_assert!(error <= 10.0 * TOLERANCE, "{error:e}");
    }
}

/// Rail that comes in hot is hot in all columns, whose dropped gains add up.
#[test]
fn the_compressed_map_holds_for_rail_that_comes_in_hot() {
    let (rail, exact) = rail();
    let m = rail.heat.basis.len();
    for skin_depth in [1e-3, 5e-3, 2e-2] {
        let incoming = Incoming::new(&rail.mesh.depth, &rail.heat.basis, skin_depth);
        let mut amplitudes = vec![0.0; rail.mesh.columns() * m];
        // All of the strip, and a front in the middle of it.
        for from in [0, rail.mesh.columns() / 2] {
            amplitudes.fill(0.0);
            for column in amplitudes.chunks_exact_mut(m).skip(from) {
                incoming.enter(50.0, column, &mut 0.0);
            }
            let expected = exact_displacement(&rail.mesh, &rail.heat.basis, exact, &amplitudes);
            let mut computed = vec![0.0; expected.len()];
            rail.heat.displacement.apply(
                &amplitudes,
                &mut vec![0.0; rail.heat.displacement.scratch_len()],
                &mut computed,
            );
            let error = largest_difference(&expected, &computed);
            println!("{skin_depth} {from}: {error:e}");
            assert!(error <= 10.0 * TOLERANCE, "{skin_depth} {from}: {error:e}");
        }
    }
}
