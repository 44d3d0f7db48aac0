//! `wheelrail presets` and `--preset`: each set that is shipped can be set, and does what it says.

use std::fs::{self, create_dir_all};
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn wheelrail(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_wheelrail"))
        .args(arguments)
        .output()
        .unwrap()
}

fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("presets").join(name);
    create_dir_all(&folder).unwrap();
    folder
}

/// T/N of a patch that rolls steadily with this creepage.
fn traction_coefficient(name: &str, creepage: &str, options: &[&str]) -> f64 {
    let folder = folder(name);
    let [scenario, output] = ["scenario.csv", "out.csv"].map(|file| folder.join(file));
    fs::write(&scenario, format!("time,creepage\n0,{creepage}\n0.001,{creepage}\n")).unwrap();
    let [scenario, output] = [&scenario, &output].map(|path| path.to_str().unwrap());
    let mut arguments = vec!["simulate", scenario, "--output", output, "--set", "contact_model=patch"];
    arguments.extend(options);
    let done = wheelrail(&arguments);
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    let text = fs::read_to_string(output).unwrap();
    let mut lines = text.lines().filter(|line| !line.starts_with('#'));
    let column = lines
        .next()
        .unwrap()
        .split(',')
        .position(|name| name == "traction_coefficient [1]");
    lines
        .next()
        .unwrap()
        .split(',')
        .nth(column.unwrap())
        .unwrap()
        .parse()
        .unwrap()
}

/// The names that the command line knows.
fn names() -> Vec<String> {
    let listed = wheelrail(&["presets"]);
    let text = String::from_utf8(listed.stdout).unwrap();
    text.lines()
        .map(|line| line.split_whitespace().next().unwrap().to_owned())
        .collect()
}

#[test]
fn every_file_is_listed_and_printed() {
    let mut files: Vec<_> = fs::read_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/presets"))
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .collect();
    files.sort();
    let mut names = names();
    names.sort();
    let stems: Vec<_> = files
        .iter()
        .map(|file| file.file_stem().unwrap().to_str().unwrap())
        .collect();
    assert_eq!(stems, names);
    for file in &files {
        let printed = wheelrail(&["presets", file.file_stem().unwrap().to_str().unwrap()]);
        assert_eq!(printed.stdout, fs::read(file).unwrap());
    }
}

/// Polach's k_A 0.3 of wet rail: the creep curve's slope at creepage 0 over that without a layer. The value has two digits.
#[test]
fn the_layer_of_wet_rail_leaves_the_share_of_the_slope_that_it_is_for() {
    let [with, without] = [
        ("with", &["--preset", "wet"][..]),
        ("without", &["--preset", "wet", "--set", "layer_compliance=0"]),
    ]
    .map(|(name, options)| traction_coefficient(name, "1e-5", options));
    assert!((with / without - 0.3).abs() < 0.005, "{with} {without}");
}

/// At a creepage of 10 % all slides: μ₀ (A + (1 − A) exp(−B s)) at s = 10 m/s · 0.1/1.1, but for the slip that varies a little over the
/// contact and the way of the memory.
#[test]
fn a_sliding_wheel_has_the_friction_of_the_set() {
    for (name, friction, share, decay) in [
        ("dry", 0.55, 0.4, 0.6),
        ("wet", 0.3, 0.4, 0.2),
        ("contaminated", 0.1375, 1.0, 0.0),
    ] {
        let expected = friction * (share + (1.0 - share) * f64::exp(-decay * 10.0 * 0.1 / 1.1));
        let computed = traction_coefficient(name, "0.1", &["--preset", name]);
        assert!(
            (computed / expected - 1.0).abs() < 0.005,
            "{name}: {computed} {expected}"
        );
    }
}

#[test]
fn a_file_serves_as_well_and_what_does_not_is_refused() {
    let folder = folder("refused");
    let path = folder.join("own.toml");
    let refused = |text: &str, parts: &[&str]| {
        fs::write(&path, text).unwrap();
        let given = path.to_str().unwrap();
        let output = wheelrail(&["simulate", "none.csv", "-o", "out.csv", "--preset", given]);
        let message = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(1), "{message}");
        for part in [given].iter().chain(parts) {
            assert!(message.contains(part), "{message} lacks {part}");
        }
    };
    let head = "title = \"t\"\nsource = \"s\"\n[parameters]\n";
    refused(&format!("{head}mass = 1"), &["\"mass\""]);
    refused(&format!("{head}density = -1.0"), &["density = -1", "allowed is"]);
    refused(
        &format!("{head}wheel = \"round\""),
        &["wheel = \"round\"", "not an integer"],
    );
    refused(&format!("{head}density = [1.0]"), &["density", "array"]);
    refused("[parameters]\n", &["title"]);
    refused(head.replace("source", "origin").as_str(), &["origin"]);
    refused("density", &["line 1"]);
    let output = wheelrail(&["simulate", "none.csv", "-o", "out.csv", "--preset", "icy"]);
    let message = String::from_utf8(output.stderr).unwrap();
    assert!(
        message.contains("\"icy\"") && message.contains("dry, wet, contaminated, eurosprinter"),
        "{message}"
    );
    let output = wheelrail(&["simulate", "none.csv", "-o", "out.csv", "--preset", "contaminatd"]);
    let message = String::from_utf8(output.stderr).unwrap();
    assert!(message.contains("did you mean contaminated?"), "{message}");
    refused(
        &format!("{head}friction_colt = 0.3"),
        &["\"friction_colt\"", "did you mean friction_cold?"],
    );
    // Choices by name; what the command line sets goes before.
    fs::write(
        &path,
        format!("{head}friction_law = \"constant\"\nfriction_cold = 0.2\nwheel_heating = \"off\""),
    )
    .unwrap();
    let own = path.to_str().unwrap();
    let computed = traction_coefficient(
        "own",
        "0.1",
        &["--preset", "dry", "--preset", own, "--set", "friction_slip_share=1"],
    );
    assert!((computed / 0.2 - 1.0).abs() < 0.005, "{computed}");
}
