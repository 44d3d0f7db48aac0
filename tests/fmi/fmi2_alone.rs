//! What only FMI 2.0 has: rates of change of inputs (their effect is in input_derivatives.rs) and queries of a status.

use super::abi::{expect_error, expect_null};
use super::importer::{Api, Client, DISCARD, Fmi2, Line, OK};
use std::ffi::c_int;
use std::ptr::{null, null_mut};

#[test]
fn null_pointers_are_errors() {
    let api = &Api::load(Fmi2);
    let vr = [api.reference("normal_load")];
    let (order, value) = ([1], [1.0]);
    let (vr, order, value) = (vr.as_ptr(), order.as_ptr(), value.as_ptr());
    // SAFETY: null or valid pointers.
    unsafe {
        expect_null(api, "vr", |c| {
            (api.fmi2.fmi2SetRealInputDerivatives)(c.component, null(), 1, order, value)
        });
        expect_null(api, "order", |c| {
            (api.fmi2.fmi2SetRealInputDerivatives)(c.component, vr, 1, null(), value)
        });
        expect_null(api, "value", |c| {
            (api.fmi2.fmi2SetRealInputDerivatives)(c.component, vr, 1, order, null())
        });
        expect_null(api, "value", |c| (api.fmi2.fmi2GetStatus)(c.component, 0, null_mut()));
        expect_null(api, "value", |c| {
            (api.fmi2.fmi2GetRealStatus)(c.component, 2, null_mut())
        });
        expect_null(api, "value", |c| {
            (api.fmi2.fmi2GetIntegerStatus)(c.component, 0, null_mut())
        });
        expect_null(api, "value", |c| {
            (api.fmi2.fmi2GetBooleanStatus)(c.component, 3, null_mut())
        });
        expect_null(api, "value", |c| {
            (api.fmi2.fmi2GetStringStatus)(c.component, 1, null_mut())
        });
    }
}

#[test]
fn unknown_value_references_are_errors() {
    let api = &Api::load(Fmi2);
    let (parameter, output) = (api.reference("control"), api.reference("traction_force"));
    let set = api.fmi2.fmi2SetRealInputDerivatives;
    // SAFETY: one element each, or none.
    unsafe {
        for unknown in [u32::MAX, 999, 1999, 1 << 31, parameter] {
            let reason = format!("value reference {unknown}");
            expect_error(api, &reason, |c| set(c.component, &unknown, 1, &1, &0.0));
        }
        // Inputs are no outputs.
        expect_error(api, "an input", |c| set(c.component, &output, 1, &1, &0.0));
        let client = Client::running(api, Line, &[]);
        client.expect(OK, set(client.component, null(), 0, null(), null()));
    }
}

#[test]
fn status_queries_answer_what_there_is_and_discard_the_rest() {
    let api = &Api::load(Fmi2);
    let client = Client::running(api, Line, &[]);
    client.expect(OK, client.step(0.0, 0.01));
    let c = client.component;
    let (mut real, mut integer, mut string) = (0.0, 7, null());
    // SAFETY: valid places.
    unsafe {
        client.expect(OK, (api.fmi2.fmi2GetRealStatus)(c, 2, &mut real));
        assert_eq!(real, 0.01);
        client.expect(OK, (api.fmi2.fmi2GetBooleanStatus)(c, 3, &mut integer));
        assert_eq!(integer, 0);
        for kind in [-1, 0, 1, 2, 3, 4, c_int::MAX] {
            client.expect(DISCARD, (api.fmi2.fmi2GetStatus)(c, kind, &mut integer));
            client.expect(DISCARD, (api.fmi2.fmi2GetIntegerStatus)(c, kind, &mut integer));
            client.expect(DISCARD, (api.fmi2.fmi2GetStringStatus)(c, kind, &mut string));
            if kind != 2 {
                client.expect(DISCARD, (api.fmi2.fmi2GetRealStatus)(c, kind, &mut real));
            }
            if kind != 3 {
                client.expect(DISCARD, (api.fmi2.fmi2GetBooleanStatus)(c, kind, &mut integer));
            }
        }
    }
    assert!(client.last_message().contains("status kind"));
    client.expect(OK, client.step(0.01, 0.01));
}
