//! From nothing to the first output: mesh, factorisation, unit loads, thermal map, first contact.

// criterion's macro makes a public function without documentation.
#![allow(missing_docs)]

mod braking;

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use wheelrail::Model;

fn cold_start(c: &mut Criterion) {
    let inputs = braking::manoeuvre()[0];
    let mut group = c.benchmark_group("cold_start");
    group.sample_size(10);
    for contact_nodes in [25, 50, 61, 100, 200] {
        group.bench_with_input(
            BenchmarkId::from_parameter(contact_nodes),
            &contact_nodes,
            |b, &nodes| {
                b.iter(|| {
                    let model = Model::new(braking::parameters(nodes)).expect("a model");
                    let mut workspace = model.workspace();
                    model.initial_state(&mut workspace, &inputs).expect("a state").outputs
                });
            },
        );
    }
    group.finish();
}

criterion_group!(benches, cold_start);
criterion_main!(benches);
