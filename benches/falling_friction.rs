//! What friction that falls with slip, its memory, and a layer add to a step of the braking manoeuvre: the median time of a step with the laws over
//! that without them, the runs side by side.

mod braking;
mod timing;

use braking::Braking;
use timing::thread_time;
use wheelrail::Parameters;

/// Steps of each run.
const STEPS: usize = 2_000;
/// Steps that one run takes before the next one has its turn: short beside the drift of the machine, long beside what a change of the run
/// costs in the caches.
const TURN: usize = 10;

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
        let layered = Parameters {
            layer_compliance: 1e-13,
            ..without.clone()
        };
        // Below the peak of the friction bound, so that it flows.
        let flowing = Parameters {
            layer_yield_stress: 100e6,
            layer_hardening: 1e12,
            ..layered.clone()
        };
        let [without, falling, remembering, layered, flowing] =
            side_by_side([&without, &falling, &remembering, &layered, &flowing]);
        println!(
            "{name}: a step by temperature alone {without:.1} µs; with the law of slip {:.3} times that, with memory {:.3}; with an elastic \
             layer {:.3}, with one that flows {:.3}",
            falling / without,
            remembering / without,
            layered / without,
            flowing / without
        );
    }
}

/// Median time of a step of each, `µs`.
fn side_by_side<const N: usize>(parameters: [&Parameters; N]) -> [f64; N] {
    let mut runs = parameters.map(|parameters| Braking::through(parameters, braking::manoeuvre()));
    let mut times = [(); N].map(|()| Vec::with_capacity(STEPS));
    for turn in 0..STEPS / TURN {
        for place in 0..runs.len() {
            let next = (turn + place) % runs.len();
            for _ in 0..TURN {
                let start = thread_time();
                runs[next].step();
                times[next].push(1e6 * (thread_time() - start));
            }
        }
    }
    times.map(|mut times| {
        times.sort_by(f64::total_cmp);
        times[times.len() / 2]
    })
}
