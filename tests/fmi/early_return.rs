//! FMI 3.0: a step that comes only part of its way. An importer that can handle it is told to go on from there; any other has an
//! error.

use super::importer::{
    Answer, Api, Arguments, Client, ContactModel, DISCARD, ERROR, Fmi3, OK, RIGHT, WARNING, with_each_contact_model,
};
use super::steps::{stops, swell};

/// In *instantiated*, of an importer that can handle an early return.
fn returning_early(api: &Api, contact: ContactModel) -> Client<'_> {
    let mut client = Client::given(
        api,
        Arguments {
            early_return: true,
            ..RIGHT
        },
    );
    client.hear_refusals();
    client.contact = contact;
    client.make_coarse();
    client
}

fn answer(early_return: bool, last_successful_time: f64) -> Answer {
    Answer {
        event_handling_needed: 0,
        terminate_simulation: 0,
        early_return: early_return.into(),
        last_successful_time,
    }
}

#[test]
fn a_step_that_comes_part_of_its_way_returns_early_where_that_is_allowed_and_is_an_error_where_not() {
    with_each_contact_model(&Api::load(Fmi3), |api, contact| {
        let (mut early, mut failed, mut went_on) = (0, 0, 0);
        for (penetration, creepage) in stops(contact) {
            let [allowed, not] = [returning_early(api, contact), Client::coarse(api, contact)];
            let [status, other] = [&allowed, &not].map(|client| {
                swell(client, penetration, creepage);
                client.step(1e-3, 10.0)
            });
            let reached = allowed.last_successful_time();
            assert_eq!(not.last_successful_time().to_bits(), reached.to_bits());
            match status {
                OK => {
                    assert_eq!(other, OK);
                    assert_eq!(
                        (allowed.answer.get(), not.answer.get()),
                        (answer(false, 10.001), answer(false, 10.001))
                    );
                }
                // Nothing was committed: discarded, whether or not early returns are allowed.
                DISCARD => {
                    failed += 1;
                    assert_eq!(other, DISCARD);
                    assert_eq!(
                        (allowed.answer.get(), not.answer.get()),
                        (answer(false, 1e-3), answer(false, 1e-3))
                    );
                    allowed.expect(OK, allowed.set(&[("creepage", 0.0)]));
                    allowed.expect(OK, allowed.step(1e-3, 1e-3));
                }
                status => {
                    early += 1;
                    assert_eq!((status, other), (WARNING, ERROR));
                    assert!(reached > 1e-3 && reached < 10.001, "{reached}");
                    assert_eq!(
                        (allowed.answer.get(), not.answer.get()),
                        (answer(true, reached), answer(false, reached))
                    );
                    let told = allowed.last_message();
                    assert!(
                        told.starts_with(&format!("fmi3DoStep: the step returned early at t = {reached} s")),
                        "{told}"
                    );
                    assert!(not.last_message().contains("the last committed state stands: "));
                    // Both have the same values there; one goes on, the other may only look.
                    assert_eq!((allowed.get("time"), not.get("time")), (reached, reached));
                    assert_eq!(allowed.outputs(), not.outputs());
                    not.expect(ERROR, not.step(reached, 1e-3));
                    // On a cold rail the load falls again; where it does not, another step stops.
                    let cold = [("creepage", 0.0), ("incoming_temperature", 200.0)];
                    allowed.expect(OK, allowed.set(&cold));
                    let status = allowed.step(reached, 1e-3);
                    assert!(
                        [OK, WARNING, DISCARD].contains(&status),
                        "{status}: {}",
                        allowed.last_message()
                    );
                    if status == OK {
                        went_on += 1;
                        assert_eq!(allowed.answer.get(), answer(false, reached + 1e-3));
                    }
                }
            }
        }
        println!("{early} steps returned early, {went_on} of them went on, {failed} failed at once");
        assert!(early > 0 && failed > 0 && went_on > 0);
    });
}

/// A step that is complete does not return early, whoever asks.
#[test]
fn a_complete_step_does_not_return_early() {
    with_each_contact_model(&Api::load(Fmi3), |api, contact| {
        let client = returning_early(api, contact);
        client.start();
        for step in 0..5 {
            client.expect(OK, client.step(0.01 * f64::from(step), 0.01));
            assert_eq!(client.answer.get().early_return, 0);
        }
    });
}
