//! `wheelrail simulate` and its refusals: the message names file, line, variable, value and what is allowed, the exit status
//! is 1, and no file of results is left behind.

use std::fs::{create_dir_all, read_to_string, remove_file, write};
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use wheelrail::signals::{INPUTS, InputSignal, OUTPUTS};
use wheelrail::{Body, Profile};

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
        let inputs = inputs().map(|row| (row.name, row.unit));
        let outputs = OUTPUTS.iter().filter(|row| !row.profiles_only);
        let outputs = outputs.map(|row| (row.name, row.unit));
        let all = [("time", "s")].into_iter().chain(inputs).chain(outputs);
        let headings: Vec<_> = all.map(|(name, unit)| format!("{name} [{unit}]")).collect();
        assert_eq!(lines.next().unwrap().split(',').collect::<Vec<_>>(), headings);
        let rows: Vec<Vec<f64>> = lines
            .map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect())
            .collect();
        assert_eq!(rows.iter().map(|row| row[0]).collect::<Vec<_>>(), [0.0, 1e-3, 2e-3]);
        let creepage = headings.iter().position(|name| *name == "creepage [1]").unwrap();
        assert_eq!(rows[1][creepage], 5e-4);
    }
}

/// A grid by its name sets both numbers of cells; a name that there is none of is refused with those that there are.
#[test]
fn a_grid_of_the_patch_is_chosen_by_its_name() {
    let place = Place::new("grid", GOOD);
    let table = |grid: &[&str]| {
        let output = place.simulate(&[&["--set", "contact_model=2"], grid].concat());
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        read_to_string(&place.output).unwrap()
    };
    let named = table(&["--set", "patch_grid=fast"]);
    assert_eq!(named, table(&["--set", "patch_nodes=8", "--set", "patch_strips=8"]));
    assert_ne!(named, table(&["--set", "patch_grid=fast", "--set", "patch_nodes=12"]));
    remove_file(&place.output).unwrap();
    let meant = "patch_grid = \"fats\": allowed is fast, default or fine; did you mean fast?";
    place.refused(&["--set", "patch_grid=fats"], &[meant]);
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
        let force = heading.split(',').position(|name| name == "lateral_force [N]").unwrap();
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

/// The last value of an output of a run.
fn output(place: &Place, name: &str) -> f64 {
    let table = read_to_string(&place.output).unwrap();
    let mut lines = table.lines();
    let mut headings = lines.next().unwrap().split(',');
    let column = headings
        .position(|heading| heading.split(' ').next() == Some(name))
        .unwrap();
    lines.last().unwrap().split(',').nth(column).unwrap().parse().unwrap()
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
    for (name, value) in [
        ("normal_load", sum(|row| row[2])),
        ("traction_force", -sum(|row| row[3])),
        ("lateral_force", -sum(|row| row[4])),
        ("spin_moment", -sum(|row| row[0] * row[4] - row[1] * row[3])),
    ] {
        assert!((value / output(&place, name) - 1.0).abs() < 1e-6, "{name}: {value}");
    }
    // Within Coulomb's bound, and sliding cells on it.
    assert!(rows.iter().all(|row| (0.0..1.0 + 1e-6).contains(&row[7])));
    assert!(rows.iter().any(|row| row[7] > 0.999) && rows.iter().any(|row| row[2] > 0.0 && row[7] < 0.9));
}

/// Profiles have a row for each cell of each window, with its size: the pressure adds up to the normal forces of the contacts.
#[test]
fn the_fields_of_profiles_are_those_of_their_windows() {
    let scenario = "time,normal_load,vehicle_speed,wheel_speed,lateral_displacement\n0,60e3,20,43.6,5e-3\n0.001,60e3,20,43.6,5e-3\n";
    let options =
        ["contact_model=3", "slip_source=2", "patch_nodes=14", "patch_strips=9"].map(|option| ["--set", option]);
    let place = Place::new("fields_profiles", scenario);
    let (headings, rows) = fields(&place, &options.concat());
    let expected = "window [1],arc_length [m],z [m],inclination [rad],cell_length [m],strip_breadth [m],x [m],y [m],pressure [Pa],\
                    shear_x [Pa],shear_s [Pa],slip_x [m/s],slip_s [m/s],saturation [1],temperature [K],wear_depth [m],friction_coefficient [1]";
    assert_eq!(headings.join(","), expected);
    let windows = rows.last().unwrap()[0] as usize;
    assert_eq!(rows.len(), windows * 14 * 14);
    let force = |window: usize| -> f64 {
        let own = rows.iter().filter(|row| row[0] == window as f64);
        own.map(|row| row[4] * row[5] * row[8]).sum()
    };
    for window in 1..=windows {
        let expected = output(&place, &format!("contact.normal_force[{window}]"));
        assert!((force(window) - expected).abs() <= 1e-9 * expected, "{window}");
    }
    assert!(force(1) > 0.0 && force(2) > 0.0);
}

#[test]
fn fields_that_cannot_be_written_are_refused() {
    let place = Place::new("unwritable_fields", GOOD);
    let missing = place.output.with_file_name("missing").join("fields.csv");
    place.refused(
        &["--fields", missing.to_str().unwrap()],
        &["missing/fields.csv", "the folder", "missing is not there"],
    );
}

/// What a run reads is not written over, by whatever option and name of the file; nor does one output overwrite another one. All
/// is refused before anything is written.
#[test]
fn no_file_is_written_over() {
    let place = Place::new("written_over", GOOD);
    let folder = place.output.parent().unwrap();
    let profile = folder.join("my.prw");
    let made = Command::new(env!("CARGO_BIN_EXE_wheelrail"))
        .args(["profile", "S1002", "-o", profile.to_str().unwrap()])
        .output()
        .unwrap();
    assert!(made.status.success());
    let preset = folder.join("mine.toml");
    write(
        &preset,
        "title = \"Mine\"\nsource = \"a test\"\n[parameters]\nfriction_cold = 0.4\n",
    )
    .unwrap();
    let around = folder.join(".").join("out.csv");
    let new = folder.join("new.csv");
    let [scenario, output, profile, preset, around, new] =
        [&place.scenario, &place.output, &profile, &preset, &around, &new].map(|path| path.to_str().unwrap());
    let inputs = [scenario, profile, preset].map(|path| (path, read_to_string(path).unwrap()));
    let wheel = format!("wheel_profile={profile}");
    let with_wheel = ["--set", "contact_model=3", "--set", "slip_source=2", "--set", &wheel];
    for (options, parts) in [
        (&["--fields", scenario][..], ["--fields", "the scenario"]),
        (&["--profile-wear", scenario], ["--profile-wear", "the scenario"]),
        (&["--fields", profile], ["--fields", "wheel_profile"]),
        (&["--worn-wheel", profile], ["--worn-wheel", "wheel_profile"]),
        (&["--fields", output], ["--fields", "--output is written to this file"]),
        (&["--fields", around], ["--fields", "--output is written to this file"]),
        (
            &["--profile-wear", new, "--worn-wheel", new],
            ["--worn-wheel", "--profile-wear is written to this file"],
        ),
        (
            &["--fields", new, "--worn-rail", new],
            ["--worn-rail", "--fields is written to this file"],
        ),
    ] {
        place.refused(&[&with_wheel[..], options].concat(), &parts);
        assert!(!Path::new(new).exists(), "{options:?}");
    }
    // Each input as where the outputs go.
    for (path, read_as) in [
        (scenario, "the scenario"),
        (profile, "wheel_profile"),
        (preset, "--preset"),
    ] {
        let onto = Place {
            scenario: place.scenario.clone(),
            output: PathBuf::from(path),
        };
        let done = onto.simulate(&[&with_wheel[..], &["--preset", preset]].concat());
        let message = String::from_utf8(done.stderr).unwrap();
        assert_eq!(done.status.code(), Some(1), "{message}");
        assert!(message.contains(&format!("--output {path}")), "{message}");
        assert!(message.contains(&format!("reads this file ({read_as})")), "{message}");
    }
    for (path, content) in inputs {
        assert_eq!(read_to_string(path).unwrap(), content);
    }
}

/// Other names of a file, links of both kinds, are seen through; a device is no file that could be lost.
#[cfg(unix)]
#[test]
fn links_are_seen_through() {
    let place = Place::new("links", GOOD);
    let [hard, soft] = ["hard.csv", "soft.csv"].map(|name| place.output.with_file_name(name));
    for link in [&hard, &soft] {
        let _ = remove_file(link);
    }
    std::fs::hard_link(&place.scenario, &hard).unwrap();
    std::os::unix::fs::symlink(&place.scenario, &soft).unwrap();
    for link in [hard, soft] {
        place.refused(&["--fields", link.to_str().unwrap()], &["--fields", "(the scenario)"]);
        assert_eq!(read_to_string(&place.scenario).unwrap(), GOOD);
    }
    let nowhere = Place {
        output: PathBuf::from("/dev/null"),
        ..place
    };
    assert!(nowhere.simulate(&["--fields", "/dev/null"]).status.success());
}

/// Files that are written at the end are tried at the start, and left as they were; a folder that is not there is named.
#[test]
fn files_for_worn_profiles_that_cannot_be_written_are_refused_at_once() {
    // So many steps that the test would not end if they were taken first.
    let place = Place::new("unwritable_wear", "time,normal_load\n0,60e3\n1e5,60e3\n");
    let missing = place.output.with_file_name("missing");
    let [file, folder] = [missing.join("q.prw"), missing.with_file_name("folder.prw")];
    create_dir_all(&folder).unwrap();
    let old = place.output.with_file_name("old.prw");
    write(&old, "as it was").unwrap();
    let fresh = place.output.with_file_name("fresh.prw");
    let [file, folder, old, fresh] = [&file, &folder, &old, &fresh].map(|path| path.to_str().unwrap());
    for option in ["--profile-wear", "--worn-wheel", "--worn-rail"] {
        let refusals = [
            (file, &["missing/q.prw: the folder", "missing is not there"][..]),
            (folder, &["folder.prw", "directory"]),
        ];
        for (path, parts) in refusals {
            place.refused(&[&PROFILES[..], &[option, path]].concat(), &[&[option], parts].concat());
        }
    }
    for path in [old, fresh] {
        let others = ["--worn-wheel", path, "--worn-rail", file];
        place.refused(&[&PROFILES[..], &others].concat(), &["--worn-rail"]);
    }
    assert_eq!(read_to_string(old).unwrap(), "as it was");
    assert!(!Path::new(fresh).exists());
}

/// A file for a worn profile that would be refused, or hold the new one, is refused before the first step.
#[test]
fn files_for_worn_profiles_that_would_not_be_are_refused_at_once() {
    let place = Place::new("no_wear", "time,normal_load\n0,60e3\n1e5,60e3\n");
    let path = |name: &str| place.output.with_file_name(name).to_str().unwrap().to_owned();
    let both = ["--set", "wheel_profile_wear=on", "--set", "rail_profile_wear=on"];
    let [wheel, rail] = [
        ("--worn-wheel", path("a.prr"), "wheel", "rail"),
        ("--worn-rail", path("a.whl"), "rail", "wheel"),
    ]
    .map(|(option, path, body, other)| {
        let ending = format!("holds a {other}, and the profile is that of a {body}");
        place.refused(&[&PROFILES[..], &both, &[option, &path]].concat(), &[option, &ending]);
        (option, body)
    });
    let [wheels, rails] = [".prw, .whl, .mpt, .whe, .csv", ".prr, .ban, .mpt, .rai, .csv"];
    for ((option, body), endings) in [(wheel, wheels), (rail, rails)] {
        for name in ["w.xyz", "w", "w.prw.bak", ".csv"] {
            let unknown = path(name);
            let said = format!("{option} {unknown}: the name of a file of a {body} ends in one of {endings}");
            place.refused(&[&PROFILES[..], &both, &[option, &unknown]].concat(), &[&said]);
            assert!(!Path::new(&unknown).exists());
        }
    }
    for ((option, body), wear) in [(wheel, &both[2..]), (rail, &both[..2])] {
        let said = format!("the {body} does not wear; with {body}_profile_wear = 2 (on) it does");
        let worn = path("a.csv");
        place.refused(&[&PROFILES[..], wear, &[option, &worn]].concat(), &[option, &said]);
        assert!(!Path::new(&worn).exists());
    }
}

/// The inputs that line and patch may have.
fn inputs() -> impl Iterator<Item = &'static InputSignal> {
    INPUTS.iter().filter(|signal| !signal.is_of_profiles_alone())
}

/// The table of inputs of a run: the rows up to the column of the last input.
fn inputs_of(place: &Place) -> String {
    let table = read_to_string(&place.output).unwrap();
    let inputs = table.lines().map(|line| {
        let cells: Vec<_> = line.split(',').take(1 + inputs().count()).collect();
        cells.join(",") + "\n"
    });
    inputs.collect()
}

/// The table of results in the scenario's own words.
fn results(name: &str, scenario: &str, options: &[&str]) -> String {
    let place = Place::new(name, scenario);
    let output = place.simulate(options);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    read_to_string(&place.output).unwrap()
}

#[test]
fn headings_have_units() {
    let si =
        "time,normal_load,creepage,ambient_temperature,spin_creepage\n0,60e3,0,293.15,0\n0.002,61e3,0.001,295.15,0.5\n";
    let expected = results("units_si", si, &PATCH);
    for (name, headings, rows) in [
        (
            "units",
            "time [s],normal_load [N],creepage [1],ambient_temperature [K],spin_creepage [1/m]",
            "0,60e3,0,293.15,0\n0.002,61e3,0.001,295.15,0.5\n",
        ),
        (
            "units_other",
            "time [ms],normal_load [kN],creepage [%],ambient_temperature [degC],spin_creepage [1/km]",
            "0,60,0,20,0\n2,61,0.1,22,500\n",
        ),
        (
            "units_spelled",
            "time[ µs ], normal_load[MN], creepage [-], ambient_temperature [°C], spin_creepage [1/mm]",
            "0,0.06,0,20,0\n2000,0.061,0.001,22,5e-4\n",
        ),
        // As a spreadsheet writes it: the mark of UTF-8 first, lines that end as in Windows, cells in quotation marks.
        (
            "units_spreadsheet",
            "\u{feff}time,\"normal_load [kN]\",creepage,ambient_temperature [K],spin_creepage\r",
            "0,60,0,293.15,0\r\n0.002,\"61\",0.001,295.15,0.5\r\n",
        ),
    ] {
        let table = results(name, &format!("{headings}\n{rows}"), &PATCH);
        assert_eq!(table, expected, "{headings}");
    }
}

#[test]
fn units_that_are_none_of_the_variable_are_refused() {
    for (name, heading, parts) in [
        ("unit_other", "normal_load [mm]", ["\"mm\"", "normal_load", "N, kN, MN"]),
        (
            "unit_unknown",
            "creepage [percent]",
            ["\"percent\"", "creepage", "1, %, ‰"],
        ),
        (
            "unit_case",
            "wheel_speed [RPM]",
            ["\"RPM\"", "wheel_speed", "rad/s, rpm"],
        ),
    ] {
        let named = format!("column {heading:?}");
        let parts = [&[named.as_str()], &parts[..]].concat();
        Place::new(name, &format!("time,{heading}\n0,0\n1,0\n")).refused(&[], &parts);
    }
    Place::new("unit_time", "time [d]\n0\n1\n").refused(&[], &["column \"time [d]\"", "\"d\"", "s, ms, µs, min, h"]);
    Place::new("unit_bracket", "time,normal_load (kN)\n0,60\n1,60\n")
        .refused(&[], &["\"normal_load (kN)\"", "square brackets, normal_load [kN]"]);
    // The value as it is used, beside the heading with the unit in which it was given.
    Place::new("unit_value", "time [ms],normal_load [kN]\n0,60\n1,600\n").refused(
        &[],
        &[
            "line 3",
            "\"normal_load [kN]\"",
            "normal_load = 600000",
            "0 to 100000 N",
            "largest_load",
        ],
    );
    // Without digits of round-off: 2.01 / 1000 is 0.0020099999999999996.
    Place::new("unit_digits", "time [ms]\n0\n5\n2.01\n").refused(&[], &[": 0.00201 s is not after 0.005 s"]);
    Place::new("unit_backwards", "time [ms]\n0\n5\n4\n")
        .refused(&[], &["line 4", "\"time [ms]\"", "0.004 s is not after 0.005 s"]);
}

/// What a run writes of its inputs is a scenario, with the columns without effect, which are at their start values.
#[test]
fn the_inputs_that_are_written_can_be_read_back() {
    for (name, scenario, options) in [
        ("again", GOOD, &[][..]),
        (
            "again_by_speed",
            "time,wheel_speed [rpm],vehicle_speed [km/h]\n0,200,36\n0.002,210,36.5\n",
            &["--set", "slip_source=2"],
        ),
    ] {
        let place = Place::new(name, scenario);
        assert!(place.simulate(options).status.success());
        let first = read_to_string(&place.output).unwrap();
        write(&place.scenario, inputs_of(&place)).unwrap();
        let output = place.simulate(options);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        assert_eq!(read_to_string(&place.output).unwrap(), first);
    }
    let place = Place::new("again_whole", GOOD);
    assert!(place.simulate(&[]).status.success());
    let whole = read_to_string(&place.output).unwrap();
    let place = Place::new("again_whole", &whole);
    place.refused(&[], &["\"traction_force [N]\" is not an input but an output"]);
}

#[test]
fn columns_without_effect_are_refused() {
    let by_speed = ["--set", "slip_source=2"];
    for (column, value, options) in [
        ("vehicle_speed", "20", &[][..]),
        ("lateral_speed", "0.1", &PATCH),
        ("spin_rate", "0.1", &PATCH),
        ("creepage", "0.01", &by_speed),
        ("lateral_creepage", "0.01", &[&PATCH[..], &by_speed].concat()),
        ("spin_creepage", "0.01", &[&PATCH[..], &by_speed].concat()),
    ] {
        let signal = INPUTS.iter().find(|signal| signal.name == column).unwrap();
        let (name, start) = (format!("unused_{column}"), signal.default);
        let place = Place::new(&name, &format!("time,{column}\n0,{start}\n0.001,{value}\n"));
        let (chosen, other) = if options.contains(&"slip_source=2") {
            (2, 1)
        } else {
            (1, 2)
        };
        place.refused(
            options,
            &[
                "line 3",
                &format!("column {column:?}"),
                &format!("{column} = {value} has no effect with slip_source = {chosen}"),
                &format!("--set slip_source={other}"),
            ],
        );
        // At its start value it says nothing.
        let place = Place::new(&name, &format!("time,{column}\n0,{start}\n0.001,{start}\n"));
        let output = place.simulate(options);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    }
}

const PROFILES: [&str; 4] = ["--set", "contact_model=profiles", "--set", "slip_source=2"];

#[test]
fn profiles_take_the_wheelset_and_their_names_are_checked() {
    let place = Place::new("profiles", GOOD);
    let with = |name: &str, more: &[&str], expected: &[&str], scenario: &str| {
        Place::new(&format!("profiles_{name}"), scenario).refused(&[&PROFILES[..], more].concat(), expected);
    };
    let rolling = "time,vehicle_speed,lateral_displacement [mm],yaw_angle [mrad]\n0,10,0,0\n0.001,10,3,1.5\n";
    let rolled = Place::new("profiles_rolling", rolling);
    let output = rolled.simulate(&PROFILES);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let table = read_to_string(&rolled.output).unwrap();
    let heading = table.lines().next().unwrap();
    let vertical = heading.split(',').position(|name| name == "force_z [N]").unwrap();
    let carried: f64 = table
        .lines()
        .last()
        .unwrap()
        .split(',')
        .nth(vertical)
        .unwrap()
        .parse()
        .unwrap();
    // The default load, to the tolerance of a step.
    assert!((carried / 60e3 - 1.0).abs() < 1e-5, "{carried}");
    let files = ["--set", "rail_profile=a b.prr", "--set", "side=right"];
    let words = "rail_profile = \"a b.prr\": there is no file a b.prr in the working directory, ";
    let known = "; built-in rails are 60E1, 60E2, 54E1, 49E1, UIC60\n";
    with("files", &files, &[words, known], rolling);
    let blank = ["--set", "wheel_profile= "];
    with("blank", &blank, &["wheel_profile is blank", "1 to 4096 bytes"], rolling);
    let unknown = ["--set", "rail_profil=60E1"];
    with("unknown", &unknown, &["did you mean rail_profile?"], rolling);
    place.refused(&PROFILES, &["column \"creepage\"", "no effect with slip_source = 2"]);
    let height = "time,vertical_displacement\n0,0\n0.001,-1e-4\n";
    let words = [
        "vertical_displacement = -0.0001 has no effect with control = 1 (load)",
        "say --set control=3",
    ];
    with("height", &[], &words, height);
    let creeping = "time,spin_creepage\n0,0\n0.001,0.1\n";
    let words = ["must be 0 with contact_model = 3 (profiles); contact_model = 2 (patch) takes it"];
    with("creeping", &[], &words, creeping);
    let line = Place::new("yawing", "time,yaw_angle\n0,0\n0.001,1e-3\n");
    let words = "must be 0 with contact_model = 1 (line); contact_model = 3 (profiles) takes it";
    line.refused(&[], &["line 3", "column \"yaw_angle\"", words]);
    line.refused(
        &["--set", "contact_model=3"],
        &["slip_source must be 2 (vehicle_speed)"],
    );
}

/// A run that nobody waits for ends quietly, and no run is too short to show all of it.
#[test]
fn output_that_nobody_reads_is_no_failure() {
    for arguments in [
        &["describe"][..],
        &["describe", "--xml"],
        &["describe", "--terminals"],
        &["describe", "--markdown", "--all"],
        &["presets"],
        &["presets", "dry"],
        &["verify", "--only", "kalker"],
    ] {
        let mut child = Command::new(env!("CARGO_BIN_EXE_wheelrail"))
            .args(arguments)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        // Before it has written anything, or while it writes.
        drop(child.stdout.take());
        let output = child.wait_with_output().unwrap();
        let message = String::from_utf8(output.stderr).unwrap();
        assert_eq!((output.status.code(), message.as_str()), (Some(0), ""), "{arguments:?}");
    }
}

#[test]
fn help_says_that_set_wins_over_preset() {
    let output = Command::new(env!("CARGO_BIN_EXE_wheelrail"))
        .args(["simulate", "--help"])
        .output()
        .unwrap();
    let help = String::from_utf8(output.stdout).unwrap();
    let words: Vec<_> = help.split_whitespace().collect();
    assert!(words.join(" ").contains("wins over every --preset"), "{help}");
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
    place.refused(&[], &["missing/out.csv", "the folder", "missing is not there"]);
}

#[test]
fn scenarios_that_are_none_are_refused() {
    let range = ["allowed is", " to "];
    let cases: &[(&str, &str, &[&str])] = &[
        ("empty", "", &["the file is empty"]),
        ("only_comments", "# a\n# b\n", &["the file is empty"]),
        (
            "only_headings",
            "time,creepage\n",
            &["at least two rows, this one has 0"],
        ),
        (
            "semicolons",
            "time;normal_load\n0;60e3\n1;60e3\n",
            &["\"time;normal_load\"", "commas separate"],
        ),
        (
            "decimal_commas",
            "time,creepage\n0,0,001\n1,0,002\n",
            &["line 2", "3 cells under 2 headings", "a point stands before decimals"],
        ),
        (
            "misspelt",
            "time,creapage\n0,0\n1,0\n",
            &["column \"creapage\" is not an input", "did you mean creepage?"],
        ),
        (
            "parameter_column",
            "time,friction_cold\n0,0.3\n1,0.3\n",
            &[
                "\"friction_cold\" is not an input but a parameter",
                "--set friction_cold=VALUE",
            ],
        ),
        (
            "two_columns_by_unit",
            "time,creepage,creepage [%]\n0,0,0\n1,0,0\n",
            &["column \"creepage\" is there twice"],
        ),
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
            &["scenario.csv, line 3", "1 cells under 2 headings"],
        ),
        (
            "one_row",
            "time,creepage\n0,0\n",
            &["at least two rows, this one has 1"],
        ),
        (
            "backwards",
            "time\n0\n1\n0.5\n",
            &["line 4", "column \"time\"", "0.5 s is not after 1 s"],
        ),
        ("twice", "time\n0\n0\n", &["line 3", "0 s is not after 0 s"]),
        (
            "endless",
            "time\n0\ninf\n",
            &["line 3", "column \"time\"", "inf is not a time"],
        ),
        (
            "no_time",
            "time\nnan\n1\n",
            &["line 2", "column \"time\"", "NaN is not a time"],
        ),
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
            &[&["line 2", "column \"creepage\"", "creepage = NaN"], &range[..]].concat(),
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
    place.refused(
        &["--set", "friction_colt=0.3"],
        &["\"friction_colt\"", "did you mean friction_cold?"],
    );
    place.refused(
        &["--set", "friction_law=linear"],
        &[
            "\"linear\"",
            "1 (constant), 2 (piecewise_linear)",
            "did you mean piecewise_linear?",
        ],
    );
    place.refused(
        &["--set", "creepage=0.1"],
        &["\"creepage\"", "is an input, a column of the scenario"],
    );
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

/// The contact window takes the loads of the scenario, up to those that a wheel carries, unless `--set` says how large it is.
#[test]
fn the_window_follows_the_loads_of_the_scenario() {
    let scenario = |load: &str| format!("time,normal_load [kN]\n0,60\n0.002,{load}\n");
    let place = Place::new("heavy", &scenario("112.5"));
    let followed = place.simulate(&[]);
    assert!(followed.status.success());
    let message = String::from_utf8(followed.stderr).unwrap();
    assert!(
        message.contains("largest_load = 118125 N follows the loads"),
        "{message}"
    );
    let result = read_to_string(&place.output).unwrap();
    assert!(place.simulate(&["--set", "largest_load=118125"]).status.success());
    assert_eq!(result, read_to_string(&place.output).unwrap());
    let _ = remove_file(&place.output);
    place.refused(
        &["--set", "largest_load=100e3"],
        &[
            "line 3",
            "normal_load = 112500",
            "allowed is 0 to 100000 N",
            "largest_load",
        ],
    );
    let place = Place::new("too-heavy", &scenario("600"));
    place.refused(
        &[],
        &[
            "line 3",
            "normal_load = 600000",
            "allowed is 0 to 100000 N",
            "largest_load",
        ],
    );
}

#[test]
fn steps_that_cannot_be_are_refused() {
    let place = Place::new("steps", GOOD);
    for step in ["0", "-1e-3", "NaN", "inf"] {
        place.refused(&[&format!("--step={step}")], &["--step", "positive, finite"]);
    }
    place.refused(&["--step", "-1"], &["--step -1", "positive, finite"]);
    place.refused(
        &["--step=1e-12"],
        &["--step 1e-12", "0.002 s", "2e9 steps, more than 1e9"],
    );
}

/// A run tells how many steps it took: one is a step, two are steps.
#[test]
fn a_single_step_is_one() {
    let place = Place::new("one-step", GOOD);
    for (step, said) in [("2e-3", "\n1 step to 0.002 s: "), ("1e-3", "\n2 steps to 0.002 s: ")] {
        let output = place.simulate(&["--step", step]);
        let message = format!("\n{}", String::from_utf8(output.stderr).unwrap());
        assert!(message.contains(said), "{message}");
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

/// More contacts than windows are told of: a hollow wheel on a rail with crests 11 mm apart, of which five touch under the larger load.
#[test]
fn more_contacts_than_windows_are_told_of() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("cli").join("crowded");
    let file = |body: Body, name: &str, radius: f64, waves: f64| {
        let points = (-340..=340).map(|tenths| {
            let y = 1e-4 * f64::from(tenths);
            let arc = (radius * radius - y * y).sqrt() - radius;
            [y, arc + waves * (std::f64::consts::TAU * y / 11e-3).cos()]
        });
        let path = folder.join(name);
        let profile = Profile::from_points(body, name, name, &points.collect::<Vec<_>>(), 0.0).unwrap();
        profile.write(&path).unwrap();
        path.display().to_string()
    };
    for (load, crowded) in [("10e3", false), ("75e3", true)] {
        let row = format!("{load},20,43.478");
        let scenario = format!("time,normal_load,vehicle_speed,wheel_speed\n0,{row}\n0.002,{row}\n");
        let place = Place::new("crowded", &scenario);
        let rail = format!("rail_profile={}", file(Body::Rail, "crests.prr", 0.3, 5e-5));
        let wheel = format!("wheel_profile={}", file(Body::Wheel, "hollow.prw", 0.3001, 0.0));
        // The rail's top stands over the running circle.
        let options = ["--set", &rail, "--set", &wheel, "--set", "rail_inclination=0"];
        let gauge = [
            "--set",
            "gauge=1.451",
            "--set",
            "gauge_depth=0.001",
            "--set",
            "patch_strips=13",
        ];
        let output = place.simulate(&[&PROFILES[..], &options, &gauge].concat());
        let message = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.success(), "{message}");
        assert_eq!(
            message.contains("2 steps: wheel and rail touch in more than four places"),
            crowded,
            "{message}"
        );
    }
}

/// A contact that curvatures of the inputs make broader than its window is told of, with what sizes the window.
#[test]
fn a_contact_that_fills_its_window_is_told_of() {
    for (curvature, fills) in [("3.3", false), ("0.3", true)] {
        let row = format!("60e3,20,43.5,{curvature}");
        let scenario =
            format!("time,normal_load,vehicle_speed,wheel_speed,transverse_curvature\n0,{row}\n0.002,{row}\n");
        let place = Place::new("full_window", &scenario);
        let inputs = ["--set", "patch_geometry=inputs", "--set", "slip_source=vehicle_speed"];
        let output = place.simulate(&[&PATCH[..], &inputs].concat());
        let message = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.success(), "{message}");
        assert_eq!(
            message.contains("2 steps: the contact fills its window"),
            fills,
            "{message}"
        );
        assert_eq!(
            message.contains("sized by largest_load, wheel_radius,"),
            fills,
            "{message}"
        );
    }
}
