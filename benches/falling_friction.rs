//! What friction that falls with slip, and its memory, add to a step of the braking manoeuvre: the median of each with the laws over that
//! without them, in turn in one run.

mod braking;
mod timing;

use braking::Braking;
use timing::Steps;
use wheelrail::Parameters;

/// Steps measured, and rounds of which the least median counts.
const STEPS: usize = 2_000;
const ROUNDS: usize = 5;

fn main() {
    let line = braking::parameters(Parameters::default().contact_nodes);
    let patch = braking::patch_parameters(Parameters::default().patch_nodes, Parameters::default().patch_strips);
    for (name, without) in [("line", line), ("patch", patch)] {
        let falling = Parameters {
            friction_slip_share: 0.38,
            friction_slip_decay: 0.7,
            ..without.clone()
        };
        let remembering = Parameters {
            friction_memory_distance: 3e-6,
            ..falling.clone()
        };
        let mut least = [f64::INFINITY; 3];
        for _ in 0..ROUNDS {
            for (least, parameters) in least.iter_mut().zip([&without, &falling, &remembering]) {
                let run = Braking::through(parameters, braking::manoeuvre());
                *least = least.min(Steps::measure(run, STEPS).quantile(0.5));
            }
        }
        let [without, falling, remembering] = least;
        println!(
            "{name}: a step by temperature alone {without:.1} µs, with the law of slip {:.3} times that, with memory {:.3} times",
            falling / without,
            remembering / without
        );
    }
}
