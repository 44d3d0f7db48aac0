//! From nothing to the first output: mesh, compliance, thermal map, first contact; with a rigid wheel, an elastic one of the rail's
//! material, and one of another.

// criterion's macro makes a public function without documentation.
#![allow(missing_docs)]

mod braking;

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use wheelrail::{Model, Parameters, Wheel};

fn cold_start(c: &mut Criterion) {
    let inputs = braking::manoeuvre()[0];
    let mut group = c.benchmark_group("cold_start");
    group.sample_size(10);
    let mut start = |name: BenchmarkId, parameters: &Parameters| {
        group.bench_function(name, |b| {
            b.iter(|| {
                let model = Model::new(parameters.clone()).expect("a model");
                let mut workspace = model.workspace();
                model.initial_state(&mut workspace, &inputs).expect("a state").outputs
            });
        });
    };
    for nodes in [25, 50, 61, 100, 200] {
        start(BenchmarkId::from_parameter(nodes), &braking::parameters(nodes));
    }
    let like = Parameters {
        wheel: Wheel::Elastic,
        ..braking::parameters(61)
    };
    start(BenchmarkId::new("like wheel", 61), &like);
    let other = Parameters {
        wheel_shear_modulus: 0.5 * like.wheel_shear_modulus,
        ..like
    };
    start(BenchmarkId::new("softer wheel", 61), &other);
    group.finish();
}

criterion_group!(benches, cold_start);
criterion_main!(benches);
