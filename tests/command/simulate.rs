//! `wheelrail simulate` and its refusals: the message names file, line, variable, value and what is allowed, the exit status
//! is 1, and no file of results is left behind.

use std::fs::{create_dir_all, read_to_string, remove_file, write};
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use wheelrail::signals::{INPUTS, OUTPUTS};

const GOOD: &str = "time,normal_load,creepage\n0,60e3,0\n0.002,60e3,0.001\n";

/// A folder of its own for each test, with a scenario in it.
struct Place {
    scenario: PathBuf,
    output: PathBuf,
}

impl Place {
    fn new(name: &str, scenario: &str) -> Place {
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("cli").join(name);
        create_dir_all(&folder).unwrap();
        let place = Place {
            scenario: folder.join("scenario.csv"),
            output: folder.join("out.csv"),
        };
        write(&place.scenario, scenario).unwrap();
        let _ = remove_file(&place.output);
        place
    }

    fn simulate(&self, options: &[&str]) -> Output {
        Command::new(env!("CARGO_BIN_EXE_wheelrail"))
            .arg("simulate")
            .arg(&self.scenario)
            .arg("--output")
            .arg(&self.output)
            // A coarse mesh: the physics is tested elsewhere.
            .args(["--set", "contact_nodes=17", "--set", "depth_nodes=11"])
            .args(options)
            .output()
            .unwrap()
    }

    /// Expects a refusal whose message has all `parts`.
    #[track_caller]
    fn refused(&self, options: &[&str], parts: &[&str]) {
        let output = self.simulate(options);
        let message = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(1), "{message}");
        assert!(message.starts_with("wheelrail: "), "{message}");
        for part in parts {
            assert!(message.contains(part), "{message} lacks {part}");
        }
        assert!(!self.output.exists(), "a file of results was left behind: {message}");
        assert_eq!(output.stdout, b"");
    }
}

/// Options that make a coarse patch.
const PATCH: [&str; 6] = [
    "--set",
    "contact_model=2",
    "--set",
    "patch_nodes=14",
    "--set",
    "patch_strips=9",
];

#[test]
fn a_scenario_becomes_a_table_of_inputs_and_outputs() {
    for (name, options) in [("good", &[][..]), ("good_patch", &PATCH)] {
        let place = Place::new(name, GOOD);
        let output = place.simulate(options);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let table = read_to_string(&place.output).unwrap();
        let mut lines = table.lines();
        let inputs = INPUTS.iter().map(|row| row.name);
        let outputs = OUTPUTS.iter().map(|row| row.name);
        let headings: Vec<&str> = ["time"].into_iter().chain(inputs).chain(outputs).collect();
        assert_eq!(lines.next().unwrap().split(',').collect::<Vec<_>>(), headings);
        let rows: Vec<Vec<f64>> = lines
            .map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect())
            .collect();
        assert_eq!(rows.iter().map(|row| row[0]).collect::<Vec<_>>(), [0.0, 1e-3, 2e-3]);
        let creepage = headings.iter().position(|name| *name == "creepage").unwrap();
        assert_eq!(rows[1][creepage], 5e-4);
    }
}

/// Lateral and spin motion moves a patch, and is refused by a line, at the line of the scenario where it is.
#[test]
fn a_line_takes_no_lateral_and_no_spin_motion() {
    for (column, options) in [
        ("lateral_creepage", &[][..]),
        ("spin_creepage", &[]),
        ("lateral_speed", &["--set", "slip_source=2"]),
        ("spin_rate", &["--set", "slip_source=2"]),
    ] {
        let place = Place::new(column, &format!("time,{column}\n0,0\n0.001,0.002\n"));
        let named = format!("{column} = 0.002");
        place.refused(
            options,
            &["line 3", &named, "contact_model = 1 (line)", "contact_model = 2"],
        );
        let output = place.simulate(&[options, &PATCH].concat());
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let table = read_to_string(&place.output).unwrap();
        let heading = table.lines().next().unwrap();
        let force = heading.split(',').position(|name| name == "lateral_force").unwrap();
        let last = table.lines().last().unwrap().split(',').nth(force).unwrap();
        assert_ne!(last.parse::<f64>().unwrap(), 0.0);
    }
    let place = Place::new("sideways_infinite", "time,spin_rate\n0,0\n1,inf\n");
    place.refused(&PATCH, &["line 3", "spin_rate = inf", "allowed is -1000 to 1000 rad/s"]);
}

/// The fields of a run: headings, and rows of numbers.
fn fields(place: &Place, options: &[&str]) -> (Vec<String>, Vec<Vec<f64>>) {
    let path = place.output.with_file_name("fields.csv");
    let output = place.simulate(&[&["--fields", path.to_str().unwrap()], options].concat());
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let table = read_to_string(path).unwrap();
    let mut lines = table.lines().map(|line| line.split(','));
    let headings = lines.next().unwrap().map(str::to_owned).collect();
    let rows = lines.map(|cells| cells.map(|cell| cell.parse().unwrap()).collect());
    (headings, rows.collect())
}

/// A line has a row for each node; its pressure along the rail carries the load on a contact of the given width.
#[test]
fn the_fields_of_a_line_are_those_of_its_nodes() {
    let (headings, rows) = fields(&Place::new("fields_line", GOOD), &["--set", "contact_width=0.01"]);
    let expected = "x [m],y [m],pressure [Pa],shear_x [Pa],shear_y [Pa],slip_x [m/s],slip_y [m/s],saturation [1],\
                    temperature [K],wear_depth [m]";
    assert_eq!(headings.join(","), expected);
    assert_eq!(rows.len(), 17);
    let spacing = rows[1][0] - rows[0][0];
    let load: f64 = rows.iter().map(|row| 0.01 * spacing * row[2]).sum();
    assert!((load / 60e3 - 1.0).abs() < 1e-6, "{load}");
    assert!(
        rows.iter()
            .all(|row| [row[1], row[4], row[6]] == [0.0; 3] && row[8] >= 293.15)
    );
}

/// A patch has a row for each cell. Its fields sum up to the outputs: load, both forces and the spin moment on the wheel.
#[test]
fn the_fields_of_a_patch_sum_up_to_its_outputs() {
    let scenario =
        "time,normal_load,creepage,lateral_creepage,spin_creepage\n0,60e3,1e-3,1e-3,0.2\n0.001,60e3,1e-3,1e-3,0.2\n";
    let place = Place::new("fields_patch", scenario);
    let (_, rows) = fields(&place, &PATCH);
    assert_eq!(rows.len(), 14 * 9);
    let area = (rows[1][0] - rows[0][0]) * (rows[14][1] - rows[0][1]);
    let sum = |value: fn(&[f64]) -> f64| area * rows.iter().map(|row| value(row)).sum::<f64>();
    let table = read_to_string(&place.output).unwrap();
    let mut lines = table.lines();
    let headings: Vec<&str> = lines.next().unwrap().split(',').collect();
    let last: Vec<f64> = lines
        .last()
        .unwrap()
        .split(',')
        .map(|cell| cell.parse().unwrap())
        .collect();
    let output = |name: &str| last[headings.iter().position(|heading| *heading == name).unwrap()];
    for (name, value) in [
        ("normal_load", sum(|row| row[2])),
        ("traction_force", -sum(|row| row[3])),
        ("lateral_force", -sum(|row| row[4])),
        ("spin_moment", -sum(|row| row[0] * row[4] - row[1] * row[3])),
    ] {
        assert!((value / output(name) - 1.0).abs() < 1e-6, "{name}: {value}");
    }
    // Within Coulomb's bound, and sliding cells on it.
    assert!(rows.iter().all(|row| (0.0..1.0 + 1e-6).contains(&row[7])));
    assert!(rows.iter().any(|row| row[7] > 0.999) && rows.iter().any(|row| row[2] > 0.0 && row[7] < 0.9));
}

#[test]
fn fields_that_cannot_be_written_are_refused() {
    let place = Place::new("unwritable_fields", GOOD);
    let missing = place.output.with_file_name("missing").join("fields.csv");
    place.refused(
        &["--fields", missing.to_str().unwrap()],
        &["missing/fields.csv", "No such file"],
    );
    place.refused(
        &["--fields", place.output.to_str().unwrap()],
        &["--fields", "where the outputs go"],
    );
}

#[test]
fn files_that_cannot_be_read_are_refused() {
    let mut place = Place::new("unreadable", GOOD);
    let folder = place.scenario.parent().unwrap().to_owned();
    place.scenario = folder.join("missing.csv");
    place.refused(&[], &["missing.csv", "No such file"]);
    // A folder opens, but does not read.
    place.scenario = folder;
    place.refused(&[], &["unreadable", "directory"]);
}

#[test]
fn a_table_of_results_that_cannot_be_written_is_refused() {
    let mut place = Place::new("unwritable", GOOD);
    place.output = place.output.with_file_name("missing").join("out.csv");
    place.refused(&[], &["missing/out.csv", "No such file"]);
}

#[test]
fn scenarios_that_are_none_are_refused() {
    let range = ["allowed is", " to "];
    let cases: &[(&str, &str, &[&str])] = &[
        ("empty", "", &["there is no column \"time\""]),
        (
            "missing_column",
            "normal_load\n1\n2\n",
            &["there is no column \"time\""],
        ),
        (
            "unknown_column",
            "time,mass\n0,1\n1,1\n",
            &["column \"mass\" is not an input", "normal_load", "wheel_speed"],
        ),
        (
            "two_columns",
            "time,creepage,creepage\n0,0,0\n1,0,0\n",
            &["column \"creepage\" is there twice"],
        ),
        (
            "words",
            "time,creepage\n0,0\n1,fast\n",
            &["line 3", "column \"creepage\"", "\"fast\" is not a number"],
        ),
        (
            "ragged",
            "time,creepage\n0,0\n1\n",
            &["scenario.csv", "record", "fields"],
        ),
        (
            "one_row",
            "time,creepage\n0,0\n",
            &["at least two rows, this one has 1"],
        ),
        (
            "backwards",
            "time\n0\n1\n0.5\n",
            &["line 4", "column \"time\"", "0.5 is not after 1"],
        ),
        ("twice", "time\n0\n0\n", &["line 3", "0 is not after 0"]),
        ("endless", "time\n0\ninf\n", &["line 3", "inf is not after 0"]),
        ("no_time", "time\nnan\n1\n", &["line 2", "NaN is not after"]),
        (
            "heavy",
            "time,normal_load\n0,6e4\n1,1e9\n",
            &[&["line 3", "normal_load = 1000000000", " N"], &range[..]].concat(),
        ),
        (
            "negative",
            "time,normal_load\n0,-1\n1,6e4\n",
            &[&["line 2", "normal_load = -1"], &range[..]].concat(),
        ),
        (
            "not_a_number",
            "time,creepage\n0,NaN\n1,0\n",
            &[&["line 2", "creepage = NaN"], &range[..]].concat(),
        ),
        (
            "infinite",
            "time,wheel_speed\n0,-inf\n1,0\n",
            &[&["line 2", "wheel_speed = -inf", "rad/s"], &range[..]].concat(),
        ),
    ];
    for (name, scenario, parts) in cases {
        Place::new(name, scenario).refused(&[], parts);
    }
    let bytes = Place::new("bytes", "");
    write(&bytes.scenario, b"time,creepage\n0,\xff\xfe\n1,0\n").unwrap();
    bytes.refused(&[], &["scenario.csv", "UTF-8"]);
}

#[test]
fn parameters_that_cannot_be_are_refused() {
    let place = Place::new("parameters", GOOD);
    place.refused(&["--set", "mass=1"], &["\"mass\"", "wheelrail describe"]);
    place.refused(&["--set", "density"], &["--set \"density\"", "name=value"]);
    place.refused(
        &["--set", "density=heavy"],
        &["density = \"heavy\"", "not a real number"],
    );
    place.refused(
        &["--set", "contact_nodes=61.5"],
        &["contact_nodes = \"61.5\"", "not an integer"],
    );
    place.refused(&["--set", "density=-1"], &["density = -1", "allowed is", "kg/m3"]);
    place.refused(
        &["--set", "wheel_radius=NaN"],
        &["wheel_radius = NaN", "allowed is", " to ", "m"],
    );
    place.refused(&["--set", "contact_nodes=0"], &["contact_nodes = 0", "allowed is"]);
    place.refused(
        &["--set", "patch_strips=2"],
        &["patch_strips = 2", "allowed is 3 to 101"],
    );
    place.refused(
        &["--set", "rail_transverse_curvature=NaN"],
        &["rail_transverse_curvature = NaN", "allowed is -1000 to 1000 1/m"],
    );
    place.refused(
        &[&PATCH[..], &["--set", "wheel_transverse_curvature=-5"]].concat(),
        &["wheel_transverse_curvature = -5", "rail_transverse_curvature = 3.33"],
    );
    place.refused(
        &["--set", "friction_hot=0.5"],
        &["friction_hot = 0.5", "friction_cold = 0.45", "must not exceed"],
    );
    // A load that is allowed, but not under this parameter.
    place.refused(
        &["--set", "largest_load=5e4"],
        &["line 2", "normal_load = 60000", "50000"],
    );
}

#[test]
fn steps_that_cannot_be_are_refused() {
    let place = Place::new("steps", GOOD);
    for step in ["0", "-1e-3", "NaN", "inf"] {
        place.refused(&[&format!("--step={step}")], &["--step", "positive, finite"]);
    }
}

/// What the command line itself cannot read is answered with status 2 and the usage.
#[test]
fn wrong_usage_is_answered_with_the_usage() {
    let place = Place::new("usage", GOOD);
    for options in [&["--step", "long"][..], &["--speed", "1"], &["--set"]] {
        let output = place.simulate(options);
        assert_eq!(output.status.code(), Some(2), "{options:?}");
        assert!(!output.stderr.is_empty() && !place.output.exists());
    }
}
