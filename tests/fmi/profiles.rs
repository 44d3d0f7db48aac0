//! Profiles through the interface: by place and motion of the wheelset, with texts as parameters.

use super::importer::{Api, Arguments, Client, ERROR, Fmi2, Fmi3, OK, Profiles, RIGHT, coarse, with_each_standard};
use std::ffi::CString;
use std::fs;
use std::path::Path;
use std::ptr::null_mut;
use wheelrail::Profile;
use wheelrail::signals::OUTPUTS;

/// A right wheel on UIC60, ready to step.
fn running(api: &Api) -> Client<'_> {
    let client = initializing(api);
    client.expect(OK, client.exit());
    client
}

fn initializing(api: &Api) -> Client<'_> {
    let mut client = Client::new(api);
    client.contact = Profiles;
    begin(&client);
    client
}

fn begin(client: &Client) {
    client.expect(OK, client.set_integers(coarse(Profiles)));
    client.expect(OK, client.set_integers(&[("side", 2), ("wheel_heating", 2)]));
    client.expect(OK, client.set_text("rail_profile", c"UIC60"));
    client.expect(OK, client.set(&pose(0)));
    client.expect(OK, client.begin(0.0, Some(10.0)));
}

/// Takes the wheel's profile from a file.
fn take_wheel(client: &Client, file: &Path) {
    let path = CString::new(file.to_str().unwrap()).unwrap();
    client.expect(OK, client.set_text("wheel_profile", &path));
}

/// A wheelset that moves towards the flange, with a lift-off on the way.
fn pose(step: u32) -> [(&'static str, f64); 6] {
    let displacement = 3e-3 + 2e-4 * f64::from(step);
    [
        ("vehicle_speed", 20.0),
        ("wheel_speed", 20.1 / 0.46),
        (
            "normal_load",
            if step == 7 { 0.0 } else { 20e3 + 1e3 * f64::from(step) },
        ),
        ("lateral_displacement", -displacement),
        ("yaw_angle", 1e-3),
        ("roll_angle", -0.07 * displacement),
    ]
}

/// Steps of a millisecond; the outputs after each as bits.
fn drive(client: &Client, steps: std::ops::Range<u32>) -> Vec<Vec<u64>> {
    steps
        .map(|step| {
            client.expect(OK, client.set(&pose(step)));
            client.expect(OK, client.step(1e-3 * f64::from(step), 1e-3));
            client.outputs()
        })
        .collect()
}

#[test]
fn both_standards_give_the_same_bits_and_bytes() {
    let [two, three] = [Fmi2, Fmi3].map(Api::load);
    let [a, b] = [&two, &three].map(running);
    assert_eq!(drive(&a, 0..16), drive(&b, 0..16));
    assert_eq!(a.serialize(a.save()), b.serialize(b.save()));
    assert!(a.get("contacts") >= 1.0);
    // The last load, carried by the wheelset as a whole.
    assert!((a.get("force_z") / 35e3 - 1.0).abs() < 1e-4, "{}", a.get("force_z"));
}

/// A state goes on as the run did that it was saved in, across a lift-off and windows that come and go.
#[test]
fn a_restored_state_repeats_the_bits() {
    with_each_standard(|api| {
        let client = running(api);
        drive(&client, 0..4);
        let saved = client.save();
        let bytes = client.serialize(saved);
        let first = drive(&client, 4..14);
        client.expect(OK, client.restore(saved));
        assert_eq!(first, drive(&client, 4..14));
        let other = running(api);
        let mut handle = null_mut();
        other.expect(OK, other.deserialize(&bytes, &mut handle));
        other.expect(OK, other.restore(handle));
        assert_eq!(first, drive(&other, 4..14));
    });
}

/// A saved state goes on with the profile that it was saved with, after the file has become another one, and when it is gone. What begins anew
/// reads the file.
#[test]
fn a_saved_state_keeps_the_profile_of_its_file() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("kept_profile");
    fs::create_dir_all(&folder).unwrap();
    let file = folder.join("wheel.prw");
    let new = Profile::built_in("S1002").unwrap();
    let depths = [[0.075, 0.0], [0.085, 2e-3], [0.105, 2e-3], [0.115, 0.0]];
    let worn = new.worn_by(&depths).unwrap();
    with_each_standard(|api| {
        let with_wheel = || {
            let client = initializing(api);
            take_wheel(&client, &file);
            client.expect(OK, client.exit());
            client
        };
        new.write(&file).unwrap();
        let client = with_wheel();
        let start = drive(&client, 0..4);
        let saved = client.save();
        let bytes = client.serialize(saved);
        let rest = drive(&client, 4..8);

        worn.write(&file).unwrap();
        let [other, alike] = [with_wheel(), with_wheel()];
        let worn_start = drive(&other, 0..4);
        assert_ne!(start, worn_start);
        // Bytes that are read change nothing before they are restored.
        drive(&alike, 0..4);
        let mut handle = null_mut();
        other.expect(OK, other.deserialize(&bytes, &mut handle));
        assert_eq!(drive(&other, 4..6), drive(&alike, 4..6));
        other.expect(OK, other.restore(handle));
        assert_eq!(rest, drive(&other, 4..8));
        // A tunable parameter makes no other wheel of it.
        let tuned = [(&client, saved), (&other, handle)].map(|(client, saved)| {
            client.expect(OK, client.restore(saved));
            client.expect(OK, client.set(&[("friction_cold", 0.4)]));
            drive(client, 4..8)
        });
        assert_eq!(tuned[0], tuned[1]);
        assert_ne!(tuned[0], rest);
        // Another start reads the file as it is; the saved state leads back.
        client.expect(OK, client.reset());
        begin(&client);
        take_wheel(&client, &file);
        client.expect(OK, client.exit());
        assert_eq!(worn_start, drive(&client, 0..4));
        client.expect(OK, client.restore(saved));
        assert_eq!(rest, drive(&client, 4..8));

        // An initialisation reads it once, whatever inputs it tries.
        let trying = initializing(api);
        take_wheel(&trying, &file);
        trying.get("force_x");
        fs::remove_file(&file).unwrap();
        trying.expect(OK, trying.set(&[("normal_load", 30e3)]));
        assert!((trying.get("force_z") / 30e3 - 1.0).abs() < 1e-3);

        let elsewhere = initializing(api);
        take_wheel(&elsewhere, &file);
        let mut handle = null_mut();
        elsewhere.expect(OK, elsewhere.deserialize(&bytes, &mut handle));
        elsewhere.expect(OK, elsewhere.restore(handle));
        assert_eq!(rest, drive(&elsewhere, 4..8));
    });
}

/// The column of the interface by a position is the difference of two runs from the same state.
#[test]
fn derivatives_by_position_are_differences() {
    with_each_standard(|api| {
        let client = running(api);
        drive(&client, 0..4);
        let before = client.save();
        let run = |change: f64| {
            client.expect(OK, client.restore(before));
            let mut inputs = pose(4);
            inputs[3].1 += change;
            client.expect(OK, client.set(&inputs));
            client.expect(OK, client.step(4e-3, 1e-3));
            client.get("force_y")
        };
        let step = 1e-7;
        let difference = (run(step) - run(-step)) / (2.0 * step);
        run(0.0);
        let standard = client.api.standard;
        let [known, unknown] = ["lateral_displacement", "force_y"].map(|name| standard.find(name).0.reference);
        let mut value = [f64::NAN];
        client.expect(OK, client.directional(&[unknown], &[known], &[1.0], &mut value));
        assert!((value[0] / difference - 1.0).abs() < 5e-3, "{} {difference}", value[0]);
    });
}

#[test]
fn a_wheel_off_the_rail_is_an_error_that_names_its_place() {
    with_each_standard(|api| {
        let client = initializing(api);
        client.hear_refusals();
        client.expect(OK, client.set(&[("lateral_displacement", -0.05)]));
        client.expect(ERROR, client.exit());
        let message = client.last_message();
        assert!(
            message.contains("has left the rail") && message.contains("-0.05 m"),
            "{message}"
        );
    });
    assert!(OUTPUTS.iter().any(|output| output.profiles_only));
}

/// A file that is not there is told with the folders it was looked for in, and with the profiles that need none.
#[test]
fn a_profile_that_is_not_there_is_told_with_the_folders() {
    let folder = env!("CARGO_TARGET_TMPDIR");
    with_each_standard(|api| {
        let location = match api.standard {
            Fmi2 => format!("file://{folder}"),
            Fmi3 => folder.to_owned(),
        };
        let location = CString::new(location).unwrap();
        let location = location.as_ptr();
        let mut client = Client::given(api, Arguments { location, ..RIGHT });
        client.contact = Profiles;
        client.hear_refusals();
        begin(&client);
        client.expect(OK, client.set_text("rail_profile", c"nope.prr"));
        client.expect(ERROR, client.exit());
        let message = client.last_message();
        let words = format!("among the archive's resources, {folder}, or in the working directory, ");
        assert!(
            message.contains(&words) && message.contains("built-in rails are 60E1, "),
            "{message}"
        );
    });
}
