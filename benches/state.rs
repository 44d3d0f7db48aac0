//! What the interface costs: saving and restoring a state, its serialised form, and a step, each through the C functions of
//! the shared library and natively, and a directional derivative, at default settings.

#![allow(unsafe_code)]

mod calls;
mod interface;

use calls::time;
use interface::common::{Api, Fmi2, OK};
use interface::{STEP, inputs, instance, native};
use std::hint::black_box;
use std::ptr::null_mut;
use wheelrail::State;

/// What a state costs.
fn state() {
    let api = Api::load(Fmi2);
    let (client, _) = instance(&api);
    let component = client.component;
    let (mut handle, mut other) = (client.save(), null_mut());
    let bytes = client.serialize(handle);
    let mut buffer = bytes.clone();
    client.expect(OK, client.deserialize(&bytes, &mut other));
    println!("a serialised state has {} bytes", bytes.len());

    // SAFETY: a live instance, its states, and room for the bytes.
    unsafe {
        time("state, through the interface: save", || {
            api.get_state(component, &mut handle)
        });
        time("state, through the interface: save and free", || {
            let mut fresh = null_mut();
            api.get_state(component, &mut fresh);
            api.free_state(component, &mut fresh)
        });
        time("state, through the interface: restore", || {
            api.set_state(component, handle)
        });
        time("state, through the interface: serialise", || {
            api.serialize(component, handle, buffer.as_mut_ptr().cast(), buffer.len())
        });
    }
    time("state, through the interface: deserialise", || {
        client.deserialize(&bytes, &mut other)
    });

    let mut run = native();
    let mut copy = run.state.clone();
    let payload = postcard::to_allocvec(&run.state).expect("bytes");
    time("state, natively: save", || copy = black_box(&run.state).clone());
    time("state, natively: restore", || run.state = black_box(&copy).clone());
    time("state, natively: serialise", || {
        postcard::to_allocvec(black_box(&run.state))
    });
    time("state, natively: deserialise", || {
        postcard::from_bytes::<State>(black_box(&payload))
    });
}

/// The rail goes on warming in both runs, and in the same way: they differ by the interface alone.
fn step() {
    let api = Api::load(Fmi2);
    let (client, start) = instance(&api);
    let mut now = start;
    time("step of 1 ms: through the interface", || {
        client.expect(OK, client.step(now, STEP));
        now += STEP;
    });
    let (force, creepage) = (api.reference("traction_force"), api.reference("creepage"));
    let mut value = 0.0;
    // SAFETY: a live instance, one element each.
    time("step of 1 ms: directional derivative after it", || unsafe {
        api.directional_derivative(client.component, &force, 1, &creepage, 1, &1.0, &mut value)
    });
    let mut run = native();
    time("step of 1 ms: natively", || run.step(&inputs(), STEP).expect("a step"));
}

fn main() {
    state();
    step();
}
