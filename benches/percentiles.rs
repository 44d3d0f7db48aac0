//! Prints how long single steps take.
#![allow(unsafe_code)]

mod braking;
use braking::Run;

/// Time this thread has computed, `s`: what others do on the machine does not count.
fn thread_time() -> f64 {
    let mut time = libc::timespec { tv_sec: 0, tv_nsec: 0 };
    // SAFETY: the kernel writes one timespec.
    unsafe { libc::clock_gettime(libc::CLOCK_THREAD_CPUTIME_ID, &mut time) };
    time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64
}

fn main() {
    let nodes: Vec<usize> = std::env::args().skip(1).filter_map(|a| a.parse().ok()).collect();
    let nodes = if nodes.is_empty() { vec![61, 165] } else { nodes };
    for n in nodes {
        let mut run = Run::new(n);
        let steps = run.remaining().min(if n > 200 { 2000 } else { 18000 });
        let mut times = Vec::with_capacity(steps);
        let mut iterations = 0;
        let mut contact = 0;
        for _ in 0..steps {
            let start = thread_time();
            run.step();
            times.push((thread_time() - start) * 1e6);
            iterations += run.state.convergence.iterations;
            contact += run.nodes_in_contact();
        }
        times.sort_by(f64::total_cmp);
        println!(
            "{n}: in contact {:.1} median {:.1} 90% {:.1} 99% {:.1} 99.9% {:.1} max {:.1} mean {:.1} iterations {:.2}",
            contact as f64 / steps as f64,
            times[steps / 2],
            times[steps * 9 / 10],
            times[steps * 99 / 100],
            times[steps * 999 / 1000],
            times[steps - 1],
            times.iter().sum::<f64>() / steps as f64,
            iterations as f64 / steps as f64
        );
    }
}
