//! One warm step of the braking manoeuvre, at default settings and with about 100 and 200 nodes in contact.

// criterion's macro makes a public function without documentation.
#![allow(missing_docs)]

mod braking;

use braking::Braking;
use criterion::{Criterion, criterion_group, criterion_main};

fn step(c: &mut Criterion) {
    let mut group = c.benchmark_group("step");
    for (name, contact_nodes) in [("default", 61), ("100_in_contact", 165), ("200_in_contact", 331)] {
        let mut run = Braking::new(contact_nodes);
        group.bench_function(name, |b| b.iter(|| run.step()));
    }
    group.finish();
}

criterion_group!(benches, step);
criterion_main!(benches);
