//! Times of one call, over and over.

use std::hint::black_box;
use std::time::{Duration, Instant};

/// What the calls of one sample take together, so that the clock's own time is nothing beside it.
const SAMPLE: Duration = Duration::from_millis(20);
const SAMPLES: usize = 100;
/// Samples at least, and the time in which there may be more.
const FEW_SAMPLES: usize = 10;
const MOST: Duration = Duration::from_secs(3);

/// What `calls` calls take, `µs` each.
fn sample<R>(call: &mut impl FnMut() -> R, calls: usize) -> f64 {
    let start = Instant::now();
    for _ in 0..calls {
        black_box(call());
    }
    1e6 * start.elapsed().as_secs_f64() / calls as f64
}

/// Prints what a call takes: the median of its samples, and the times that a tenth and nine tenths of them do not exceed.
pub fn time<R>(name: &str, mut call: impl FnMut() -> R) {
    // To fill a sample, found on the way to a warm processor.
    let mut calls = 1;
    while sample(&mut call, calls) * (calls as f64) < 1e6 * SAMPLE.as_secs_f64() {
        calls *= 2;
    }
    let start = Instant::now();
    let mut times = Vec::with_capacity(SAMPLES);
    while times.len() < FEW_SAMPLES || times.len() < SAMPLES && start.elapsed() < MOST {
        times.push(sample(&mut call, calls));
    }
    times.sort_by(f64::total_cmp);
    let [median, least, most] = [0.5, 0.1, 0.9].map(|share| times[((times.len() - 1) as f64 * share) as usize]);
    println!("{name:<58} {median:>10.2} us  (10 to 90 %: {least:.2} to {most:.2})");
}
