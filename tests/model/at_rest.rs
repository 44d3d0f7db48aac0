//! A wheel at rest under a load that varies: nothing slips, and all that heat and wear see is round-off.

use crate::by_speeds::{inputs, wheels};
use wheelrail::parameters::Parameters;
use wheelrail::signals::Inputs;
use wheelrail::simulation::Simulation as Run;
use wheelrail::torture::random::Random;

/// Steps of a scenario.
const STEPS: usize = 1500;

/// The load as a random walk; the rail as warm as the air, and warmer: then the heat that stands beside the contact lifts it.
#[test]
fn a_wheel_rests_under_a_load_that_varies() {
    for (scenario, parameters) in wheels().into_iter().enumerate() {
        for (variant, rise) in [(0, 0.0), (1, 0.0), (2, 130.0)] {
            let parameters = match variant {
                // A layer that shear strains, and friction that remembers.
                1 => Parameters {
                    layer_compliance: 5e-14,
                    friction_memory_distance: 3e-6,
                    ..parameters.clone()
                },
                _ => parameters.clone(),
            };
            let mut random = Random::new(11, (3 * scenario + variant) as u64);
            let mut standing = inputs(0.0, 0.0, 30e3);
            standing.incoming_temperature += rise;
            let mut run = Run::new(&parameters, &standing).unwrap();
            if rise > 0.0 {
                // Warm rail comes in, but not as far as the contact.
                let creeping = Inputs {
                    incoming_temperature: standing.incoming_temperature,
                    ..inputs(1.0, 1.0, 30e3)
                };
                run.hold(&creeping, 1e-3, 5).unwrap();
            }
            for step in 0..STEPS {
                standing.normal_load = (standing.normal_load + random.between(-2e3, 2e3)).clamp(5e3, 80e3);
                let duration = random.decades(1e-4, 1e-2);
                if let Err(interrupted) = run.hold(&standing, duration, 1) {
                    panic!("wheel {scenario}, variant {variant}, step {step}: {interrupted}");
                }
            }
            // Of a load of some 10 kN; elastic displacements slip by next to nothing.
            assert!(run.state.outputs.friction_power < 1.0);
        }
    }
}
