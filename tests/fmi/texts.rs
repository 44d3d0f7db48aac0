//! Texts: what is set is read again, saved and restored, and what cannot be a text is refused.

use super::importer::{Api, Client, DISCARD, ERROR, Fmi2, Fmi3, Line, OK, with_each_standard};
use std::ffi::{CStr, CString, c_char};
use std::ptr::{null, null_mut};
use wheelrail::error::LONGEST_TEXT;

/// The last message names the function and has the reason in it.
#[track_caller]
fn expect_refused(client: &Client, function: &str, reason: &str) {
    let message = client.last_message();
    let function = client.api.standard.function(function);
    let told = message.starts_with(&format!("{function}: ")) && message.contains(reason);
    assert!(told, "{message} lacks {reason}");
}

#[test]
fn texts_are_read_as_they_were_set_and_go_back_with_a_reset() {
    with_each_standard(|api| {
        let client = Client::initializing(api, Line);
        assert_eq!(client.get_text("rail_profile").as_c_str(), c"60E1");
        assert_eq!(client.get_text("wheel_profile").as_c_str(), c"S1002");
        let longest = CString::new("a".repeat(LONGEST_TEXT)).unwrap();
        for text in [c"/tracks/räil 60.prr", c"%s%n#", &longest, c"file:///a%20b.prr"] {
            client.expect(OK, client.set_text("rail_profile", text));
            assert_eq!(client.get_text("rail_profile").as_c_str(), text);
            assert_eq!(client.get_text("wheel_profile").as_c_str(), c"S1002");
        }
        client.expect(OK, client.exit());
        client.expect(OK, client.reset());
        client.make_coarse();
        client.start();
        assert_eq!(client.get_text("rail_profile").as_c_str(), c"60E1");
    });
}

/// Two in one call, and one of them twice: the last value counts.
#[test]
fn texts_are_set_together_or_not_at_all() {
    with_each_standard(|api| {
        let client = Client::initializing(api, Line);
        let [rail, wheel] = ["rail_profile", "wheel_profile"].map(|name| api.reference(name));
        let c = client.component;
        // SAFETY: as many elements as are counted, each a string.
        unsafe {
            let values = [c"49E1".as_ptr(), c"cone40".as_ptr(), c"54E1".as_ptr()];
            let status = api.set_string(c, [rail, wheel, rail].as_ptr(), 3, values.as_ptr());
            client.expect(OK, status);
            let mut read = [null(); 4];
            let status = api.get_string(c, [wheel, rail, wheel, rail].as_ptr(), 4, read.as_mut_ptr());
            client.expect(OK, status);
            let read = read.map(|text| CStr::from_ptr(text).to_owned());
            let read = read.each_ref().map(|text| text.as_c_str());
            assert_eq!(read, [c"cone40", c"54E1", c"cone40", c"54E1"]);
            let values = [c"60E2".as_ptr(), c" ".as_ptr()];
            client.expect(DISCARD, api.set_string(c, [rail, wheel].as_ptr(), 2, values.as_ptr()));
        }
        let words = "wheel_profile is blank; allowed is UTF-8 of 1 to 4096 bytes";
        expect_refused(&client, "SetString", words);
        assert_eq!(client.get_text("rail_profile").as_c_str(), c"54E1");
        assert_eq!(client.get_text("wheel_profile").as_c_str(), c"cone40");
    });
}

#[test]
fn what_cannot_be_a_text_is_discarded() {
    with_each_standard(|api| {
        let client = Client::initializing(api, Line);
        client.expect(OK, client.set_text("wheel_profile", c"cone20"));
        for (text, reason) in [
            (b"".to_vec(), "is blank"),
            (b" \t".to_vec(), "is blank"),
            (vec![b'a'; LONGEST_TEXT + 1], "is too long"),
            ("é".repeat(LONGEST_TEXT).into_bytes(), "is too long"),
            (b"S\xff".to_vec(), "is not UTF-8 behind its first 1 bytes"),
            (b"\xc3".to_vec(), "is not UTF-8 behind its first 0 bytes"),
        ] {
            let text = CString::new(text).unwrap();
            client.expect(DISCARD, client.set_text("wheel_profile", &text));
            expect_refused(
                &client,
                "SetString",
                &format!("wheel_profile {reason}; allowed is UTF-8"),
            );
            assert_eq!(client.get_text("wheel_profile").as_c_str(), c"cone20");
        }
        client.expect(OK, client.exit());
        client.expect(OK, client.step(0.0, 1e-3));
    });
}

#[test]
fn calls_that_cannot_be_are_errors() {
    with_each_standard(|api| {
        let [text, real] = ["rail_profile", "normal_load"].map(|name| api.reference(name));
        let expect = |function: &str, reason: &str, call: &dyn Fn(&Client) -> i32| {
            let client = Client::initializing(api, Line);
            let anchor = client.save();
            client.expect(ERROR, call(&client));
            expect_refused(&client, function, reason);
            client.expect(OK, client.restore(anchor));
            assert_eq!(client.get_text("rail_profile").as_c_str(), c"60E1");
        };
        let good = c"49E1".as_ptr();
        // SAFETY: as many elements as are counted.
        unsafe {
            for unknown in [real, text + 2, text - 1, u32::MAX, 18_999, 8_999] {
                let reason = format!("value reference {unknown} is not that of a String variable");
                expect("GetString", &reason, &|client| {
                    let references = [text, unknown];
                    api.get_string(client.component, references.as_ptr(), 2, [null(); 2].as_mut_ptr())
                });
                expect("SetString", &reason, &|client| {
                    api.set_string(client.component, [text, unknown].as_ptr(), 2, [good; 2].as_ptr())
                });
            }
            let argument = if api.standard == Fmi2 { "value" } else { "values" };
            let element = format!("argument {argument}[i] is a null pointer");
            expect("SetString", &element, &|client| {
                api.set_string(client.component, [text; 2].as_ptr(), 2, [good, null()].as_ptr())
            });
            let argument = format!("argument {argument} is a null pointer");
            expect("SetString", &argument, &|client| {
                api.set_string(client.component, &text, 1, null())
            });
            expect("GetString", &argument, &|client| {
                api.get_string(client.component, &text, 1, null_mut())
            });
        }
    });
}

/// FMI 3.0: each text is one value.
#[test]
fn there_are_as_many_values_as_texts() {
    let api = &Api::load(Fmi3);
    let text = api.reference("rail_profile");
    let client = Client::initializing(api, Line);
    let anchor = client.save();
    let mut read: [*const c_char; 2] = [null(); 2];
    let values = [c"60E2".as_ptr(); 2];
    // SAFETY: as many elements as are counted.
    unsafe {
        let status = (api.fmi3.fmi3GetString)(client.component, &text, 1, read.as_mut_ptr(), 2);
        client.expect(ERROR, status);
        expect_refused(&client, "GetString", "nValues = 2");
        client.expect(OK, client.restore(anchor));
        let status = (api.fmi3.fmi3SetString)(client.component, &text, 1, values.as_ptr(), 2);
        client.expect(ERROR, status);
        expect_refused(&client, "SetString", "nValues = 2");
    }
    client.expect(OK, client.restore(anchor));
    assert_eq!(client.get_text("rail_profile").as_c_str(), c"60E1");
}

/// Fixed parameters: not set after the initialisation, a part of saved states, and of what an instance must have to take one.
#[test]
fn texts_are_fixed_and_saved() {
    with_each_standard(|api| {
        let client = Client::initializing(api, Line);
        client.expect(OK, client.set_text("rail_profile", c"54E1"));
        client.expect(OK, client.exit());
        client.expect(OK, client.step(0.0, 1e-3));
        let saved = client.save();
        let bytes = client.serialize(saved);
        client.expect(ERROR, client.set_text("rail_profile", c"60E2"));
        client.expect(OK, client.restore(saved));
        assert_eq!(client.get_text("rail_profile").as_c_str(), c"54E1");

        client.expect(OK, client.reset());
        client.make_coarse();
        client.start();
        assert_eq!(client.get_text("rail_profile").as_c_str(), c"60E1");
        client.expect(OK, client.restore(saved));
        assert_eq!(client.get_text("rail_profile").as_c_str(), c"54E1");

        let other = Client::initializing(api, Line);
        let mut handle = null_mut();
        other.expect(ERROR, other.deserialize(&bytes, &mut handle));
        assert!(other.last_message().contains("other fixed parameters"));
        let same = Client::initializing(api, Line);
        same.expect(OK, same.set_text("rail_profile", c"54E1"));
        same.expect(OK, same.deserialize(&bytes, &mut handle));
        same.expect(OK, same.restore(handle));
        assert_eq!(same.get_text("rail_profile").as_c_str(), c"54E1");
        for client in [&client, &same] {
            client.expect(OK, client.step(1e-3, 1e-3));
        }
        assert_eq!(client.outputs(), same.outputs());
    });
}
