//! One warm step of the braking manoeuvre, at default settings and with about 100 and 200 nodes in contact.

// Of what criterion's macro makes.
#![allow(missing_docs)]

mod braking;

use braking::Run;
use criterion::{Criterion, criterion_group, criterion_main};

fn step(c: &mut Criterion) {
    let mut group = c.benchmark_group("step");
    for (name, contact_nodes) in [("default", 61), ("100_in_contact", 165), ("200_in_contact", 331)] {
        let mut run = Run::new(contact_nodes);
        group.bench_function(name, |b| b.iter(|| run.step()));
    }
    group.finish();
}

criterion_group!(benches, step);
criterion_main!(benches);
