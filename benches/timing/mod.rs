//! Times that a thread has computed: what else runs on the machine is not in them.

// Each benchmark uses a part of this.
#![allow(dead_code)]

use crate::braking::Braking;

/// Time this thread has computed, `s`.
#[allow(unsafe_code)]
pub fn thread_time() -> f64 {
    let mut time = libc::timespec { tv_sec: 0, tv_nsec: 0 };
    // SAFETY: the kernel writes one timespec.
    unsafe { libc::clock_gettime(libc::CLOCK_THREAD_CPUTIME_ID, &mut time) };
    time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64
}

/// Time that a function takes, `ms`: the median of three calls.
pub fn median_of_three(mut timed: impl FnMut()) -> f64 {
    let mut times = [(); 3].map(|()| {
        let start = thread_time();
        timed();
        1e3 * (thread_time() - start)
    });
    times.sort_by(f64::total_cmp);
    times[1]
}

/// What the steps of one mesh or grid took.
pub struct Steps {
    /// Nodes or cells under pressure, on average.
    pub in_contact: f64,
    /// Of the split, on average.
    pub iterations: f64,
    /// Ascending, `µs`.
    times: Vec<f64>,
}

impl Steps {
    /// Of so many steps.
    pub fn measure(mut run: Braking, count: usize) -> Steps {
        let (mut times, mut in_contact, mut iterations) = (Vec::with_capacity(count), 0, 0);
        for _ in 0..count {
            let start = thread_time();
            run.step();
            times.push(1e6 * (thread_time() - start));
            in_contact += run.nodes_in_contact();
            iterations += run.simulation.state.convergence.iterations;
        }
        times.sort_by(f64::total_cmp);
        Steps {
            in_contact: in_contact as f64 / count as f64,
            iterations: iterations as f64 / count as f64,
            times,
        }
    }

    /// The time that a share of the steps does not exceed, `µs`.
    pub fn quantile(&self, share: f64) -> f64 {
        self.times[((self.times.len() - 1) as f64 * share) as usize]
    }
}

/// A measured value beside its target; `most` says that it is not to be exceeded.
pub fn target(what: &str, value: f64, bound: f64, most: bool, unit: &str) {
    let met = if most { value <= bound } else { value >= bound };
    let (relation, verdict) = (if most { "<=" } else { ">=" }, if met { "met" } else { "NOT met" });
    println!("{what:<58} {value:>8.2} {unit:<3} target {relation} {bound} {unit:<3} {verdict}");
}
