//! What friction that falls with slip, and its memory, add to a step of the braking manoeuvre: the median time of a step with the laws over
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
        let [without, falling, remembering] = side_by_side([&without, &falling, &remembering]);
        println!(
            "{name}: a step by temperature alone {without:.1} µs, with the law of slip {:.3} times that, with memory {:.3} times",
            falling / without,
            remembering / without
        );
    }
}

/// Median time of a step of each, `µs`.
fn side_by_side(parameters: [&Parameters; 3]) -> [f64; 3] {
    let mut runs = parameters.map(|parameters| Braking::through(parameters, braking::manoeuvre()));
    let mut times = [(); 3].map(|()| Vec::with_capacity(STEPS));
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
