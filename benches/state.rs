//! What the interface costs: saving and restoring a state, its serialised form, and a step, each through the C functions of
//! the shared library and natively, and a directional derivative, at default settings.

#![allow(unsafe_code, missing_docs)]

mod interface;

use criterion::{Criterion, criterion_group, criterion_main};
use interface::common::{Api, Fmi2, OK};
use interface::{STEP, inputs, instance, native};
use std::hint::black_box;
use std::ptr::null_mut;
use wheelrail::State;

fn state(c: &mut Criterion) {
    let api = Api::load(Fmi2);
    let (client, _) = instance(&api);
    let component = client.component;
    let (mut handle, mut other) = (client.save(), null_mut());
    let bytes = client.serialize(handle);
    let mut buffer = bytes.clone();
    client.expect(OK, client.deserialize(&bytes, &mut other));
    println!("a serialised state has {} bytes", bytes.len());

    let mut group = c.benchmark_group("state, through the interface");
    // SAFETY: a live instance, its states, and room for the bytes.
    unsafe {
        group.bench_function("save", |b| b.iter(|| api.get_state(component, &mut handle)));
        group.bench_function("save and free", |b| {
            b.iter(|| {
                let mut fresh = null_mut();
                api.get_state(component, &mut fresh);
                api.free_state(component, &mut fresh)
            });
        });
        group.bench_function("restore", |b| b.iter(|| api.set_state(component, handle)));
        group.bench_function("serialise", |b| {
            b.iter(|| api.serialize(component, handle, buffer.as_mut_ptr().cast(), buffer.len()));
        });
        group.bench_function("deserialise", |b| b.iter(|| client.deserialize(&bytes, &mut other)));
    }
    group.finish();

    let mut run = native();
    let mut copy = run.state.clone();
    let payload = postcard::to_allocvec(&run.state).expect("bytes");
    let mut group = c.benchmark_group("state, natively");
    group.bench_function("save", |b| b.iter(|| copy = black_box(&run.state).clone()));
    group.bench_function("restore", |b| b.iter(|| run.state = black_box(&copy).clone()));
    group.bench_function("serialise", |b| b.iter(|| postcard::to_allocvec(black_box(&run.state))));
    group.bench_function("deserialise", |b| {
        b.iter(|| postcard::from_bytes::<State>(black_box(&payload)));
    });
    group.finish();
}

/// The rail goes on warming in both runs, and in the same way: they differ by the interface alone.
fn step(c: &mut Criterion) {
    let mut group = c.benchmark_group("step of 1 ms");
    let api = Api::load(Fmi2);
    let (client, start) = instance(&api);
    let mut time = start;
    group.bench_function("through the interface", |b| {
        b.iter(|| {
            client.expect(OK, client.step(time, STEP));
            time += STEP;
        });
    });
    let (force, creepage) = (api.reference("traction_force"), api.reference("creepage"));
    group.bench_function("directional derivative after it", |b| {
        let mut value = 0.0;
        // SAFETY: a live instance, one element each.
        b.iter(|| unsafe { api.directional_derivative(client.component, &force, 1, &creepage, 1, &1.0, &mut value) });
    });
    let mut run = native();
    group.bench_function("natively", |b| b.iter(|| run.step(&inputs(), STEP).expect("a step")));
    group.finish();
}

criterion_group!(benches, state, step);
criterion_main!(benches);
