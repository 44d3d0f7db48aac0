//! `wheelrail geometry` and `wheelrail profile`: tables of the contact geometry, and profiles that go through files.

use std::fs::{self, create_dir_all};
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

fn wheelrail(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_wheelrail"))
        .args(arguments)
        .output()
        .unwrap()
}

fn file(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("geometry");
    create_dir_all(&folder).unwrap();
    folder.join(name)
}

/// Runs the command; what it writes to its standard output and beside.
fn said(arguments: &[&str]) -> (String, String) {
    let done = wheelrail(arguments);
    let [out, beside] = [done.stdout, done.stderr].map(|bytes| String::from_utf8(bytes).unwrap());
    assert!(done.status.success(), "{arguments:?}: {beside}");
    (out, beside)
}

/// Column of a table, empty cells as what is not a number.
fn column(table: &str, name: &str) -> Vec<f64> {
    let mut lines = table.lines();
    let place = lines.next().unwrap().split(',').position(|head| head == name);
    let place = place.unwrap_or_else(|| panic!("no column {name}"));
    let cell = |line: &str| line.split(',').nth(place).unwrap().parse().unwrap_or(f64::NAN);
    lines.map(cell).collect()
}

/// S1002 on 60E1 as the documentation has it: the conicity at 3 mm in the table and beside it, and the jumps in their file.
#[test]
fn the_table_has_contacts_and_conicities() {
    let (jumps, outlines) = (file("jumps.csv"), file("outlines.csv"));
    let files = [&jumps, &outlines].map(|path| path.to_str().unwrap());
    let (table, beside) = said(&[
        "geometry",
        "--step",
        "5e-4",
        "--jumps",
        files[0],
        "--outlines",
        files[1],
    ]);
    let lateral = column(&table, "lateral_displacement [m]");
    assert_eq!(lateral.len(), 33);
    let at = lateral.iter().position(|&y| (y - 3e-3).abs() < 1e-9).unwrap();
    let conicity = column(&table, "equivalent_conicity [1]");
    assert!((conicity[at] - 0.177).abs() < 3e-3, "{}", conicity[at]);
    assert!(conicity[16].is_nan(), "there is no amplitude at 0");
    assert!(beside.contains("equivalent conicity at 3 mm: 0.17"), "{beside}");
    let [left, right] = ["left", "right"].map(|side| column(&table, &format!("{side}_rolling_radius [m]")));
    for k in 0..33 {
        assert!((left[k] - right[32 - k]).abs() < 1e-12);
    }
    let jumps = fs::read_to_string(jumps).unwrap();
    assert!(jumps.lines().any(|line| line.starts_with("left,0.00499")), "{jumps}");
    let outlines = fs::read_to_string(outlines).unwrap();
    for begin in ["left,rail,", "left,wheel,", "right,rail,", "right,wheel,"] {
        assert!(outlines.lines().filter(|line| line.starts_with(begin)).count() > 200);
    }
}

/// The table begins at `--from`, also between multiples of a step that is longer than the way to `--to`, and goes on in steps from there.
#[test]
fn the_table_begins_where_it_is_asked_to() {
    for (range, expected) in [
        (["0.0051", "0.0053", "0.001"], &[5.1][..]),
        (["-4e-3", "4e-3", "3e-3"], &[-4.0, -1.0, 2.0]),
    ] {
        let [from, to, step] = range;
        let (table, _) = said(&["geometry", "--from", from, "--to", to, "--step", step]);
        let lateral = column(&table, "lateral_displacement [m]");
        assert_eq!(lateral.len(), expected.len(), "{table}");
        for (lateral, expected) in lateral.iter().zip(expected) {
            assert!((lateral - 1e-3 * expected).abs() < 1e-15, "{table}");
        }
    }
}

/// The picture has both sides, a line for each body, and panels for radii, conicity and contacts.
#[test]
fn the_picture_shows_contacts_and_conicity() {
    let picture = file("picture.svg");
    let path = picture.to_str().unwrap();
    said(&["geometry", "--step", "5e-4", "--picture", path, "--outlines-at", "5e-3"]);
    let drawn = fs::read_to_string(&picture).unwrap();
    assert!(drawn.starts_with("<svg") && drawn.trim_end().ends_with("</svg>"));
    for text in [
        "left, 5.00 mm to the left",
        "right, 5.00 mm to the left",
        "equivalent conicity [1]",
        "difference of rolling radii [mm]",
        "right wheel",
    ] {
        assert!(drawn.contains(text), "{text}");
    }
    // Two bodies a side, radii, conicity, and four places in pieces between three jumps a side.
    assert!(drawn.matches("<polyline").count() >= 2 * 2 + 2 + 4 * 4);
    let refused = wheelrail(&["geometry", "--picture", path, "--output", path]);
    assert!(!refused.status.success());
    let refused = wheelrail(&["geometry", "--outlines-at", "5e-3"]);
    assert!(!refused.status.success());
    let other = file("picture.png");
    let refused = wheelrail(&["geometry", "--picture", other.to_str().unwrap()]);
    let said = String::from_utf8(refused.stderr).unwrap();
    assert!(said.contains("picture.png: the picture is SVG"), "{said}");
    assert!(!refused.status.success() && !other.exists());
    assert_eq!(fs::read_to_string(&picture).unwrap(), drawn);
}

/// A profile that is written and read again gives the same contacts.
#[test]
fn profiles_go_through_files() {
    let (rail, wheel) = (file("rail.prr"), file("wheel.csv"));
    let [rail, wheel] = [&rail, &wheel].map(|path| path.to_str().unwrap());
    said(&["profile", "60E1", "--inclination", "0.025", "-o", rail]);
    said(&["profile", "S1002", "-o", wheel]);
    let range = ["--from", "-0.002", "--to", "0.002", "--step", "1e-3"];
    let (own, _) = said(&[&["geometry"][..], &range].concat());
    let files = ["geometry", "--rail", rail, "--rail-inclination", "0", "--wheel", wheel];
    let (read, _) = said(&[&files[..], &range].concat());
    for name in ["left_on_wheel [m]", "right_on_rail [m]", "roll_angle [rad]"] {
        for (own, read) in column(&own, name).into_iter().zip(column(&read, name)) {
            // Splines round the jumps of the curvature off, over 0.25 mm.
            assert!((own - read).abs() < 5e-5, "{name}: {own} {read}");
        }
    }
    let (table, beside) = said(&["profile", wheel, "--body", "wheel"]);
    assert!(table.starts_with("y [m],z [m],arc_length [m],inclination [rad],curvature [1/m]"));
    assert!(
        beside.contains("wheel, columns file wheel.csv, y to the field side by its shape"),
        "{beside}"
    );
    let (list, _) = said(&["profile"]);
    assert!(list.lines().any(|line| line.starts_with("49E1    rail")), "{list}");
}

/// S1002 as EN 13715 has it, to be read and as CSV, and worn by 2 mm on the tread: the flange becomes as much higher.
#[test]
fn wheels_wear_and_are_measured() {
    let (text, _) = said(&["profile", "S1002", "--measures"]);
    for line in [
        "flange height Sh                  28.000 mm",
        "flange thickness Sd               32.500 mm",
        "flange gradient qR                10.794 mm",
        "hollow of the tread                0.000 mm",
    ] {
        assert!(text.lines().any(|found| found == line), "{text}");
    }
    let (text, _) = said(&["profile", "S1002", "--measures", "--back", "0.0722"]);
    for line in [
        "flange height Sh                  28.000 mm",
        "flange thickness Sd               34.700 mm",
    ] {
        assert!(text.lines().any(|found| found == line), "{text}");
    }
    let depths = file("depths.csv");
    fs::write(&depths, "arc_length [mm],depth [mm]\n75,0\n85,2\n105,2\n115,0\n").unwrap();
    let (worn, measures) = (file("worn.prw"), file("measures.csv"));
    let [depths, worn, measures] = [&depths, &worn, &measures].map(|path| path.to_str().unwrap());
    let (_, beside) = said(&["profile", "S1002", "--worn-by", depths, "-o", worn]);
    assert!(beside.contains("S1002: wheel, EN 13715, worn"), "{beside}");
    said(&["profile", worn, "--measures", "--against", "S1002", "-o", measures]);
    let table = fs::read_to_string(measures).unwrap();
    let only = |name: &str| column(&table, name)[0];
    for (name, expected, allowed) in [
        ("flange_height [m]", 30e-3, 1e-5),
        ("tread_depth [m]", 2e-3, 1e-5),
        ("largest_depth [m]", 2e-3, 1e-5),
        // A monotone cubic over 10 mm rises by 2 mm, and falls again.
        ("worn_area [m2]", 60e-6, 1e-6),
    ] {
        assert!((only(name) - expected).abs() < allowed, "{name}: {}", only(name));
    }
    let (text, _) = said(&["profile", worn, "--measures", "--against", "S1002"]);
    assert!(text.contains("worn area                         60."), "{text}");
    assert!(text.contains("mm²"), "{text}");
    let (text, _) = said(&["profile", "S1002", "--measures", "--against", "s1002"]);
    assert!(text.contains("worn area                          0.000 mm²"), "{text}");
}

/// S1002 with a point each sixteenth of a millimetre and noise of a size, `mm`, of a fixed seed.
fn noise(size: f64) -> String {
    let mut state = 0x9e37_79b9_7f4a_7c15u64;
    let mut draw = || {
        // Marsaglia's xorshift.
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        size * ((state >> 11) as f64 / (1u64 << 52) as f64 - 1.0)
    };
    let points = wheelrail::Profile::built_in("S1002").unwrap().points();
    let between = points.windows(2).flat_map(|pair| {
        let at = |part: u8| [0, 1].map(|k| pair[0][k] + (pair[1][k] - pair[0][k]) * 0.25 * f64::from(part));
        (0..4).map(at).collect::<Vec<_>>()
    });
    let rows: String = between
        .map(|[y, z]| format!("{},{}\n", 1e3 * y + draw(), 1e3 * z + draw()))
        .collect();
    format!("y [mm],z [mm]\n{rows}")
}

/// Noise that leaves a table is remarked on beside it, by the name of its file; smoothed, and of a profile without noise, there is nothing to remark.
#[test]
fn noise_is_remarked_on() {
    let slight = file("slight.csv");
    fs::write(&slight, noise(0.005)).unwrap();
    let wheel = ["geometry", "--step", "4e-3", "--wheel", slight.to_str().unwrap()];
    let (_, beside) = said(&wheel);
    assert_eq!(
        beside
            .matches("remark: slight.csv: its direction turns to and fro, as noise does")
            .count(),
        1,
        "{beside}"
    );
    let smoothed = [&wheel[..], &["--smoothing", "2e-3"]].concat();
    for arguments in [&smoothed[..], &["geometry", "--step", "4e-3"]] {
        let (_, beside) = said(arguments);
        assert!(!beside.contains("remark"), "{beside}");
    }
}

#[test]
fn what_cannot_be_is_refused() {
    let bare = file("bare.csv");
    fs::write(&bare, "arc_length,depth\n0.01,1\n").unwrap();
    let bare = bare.to_str().unwrap();
    let rough = file("rough.csv");
    fs::write(&rough, "y [mm],z [mm]\n-70,-20\n-60,-28\n").unwrap();
    let rough = rough.to_str().unwrap();
    let two = file("two.csv");
    fs::write(&two, "y [mm],z [mm]\n-36,-14\n0,0\n36,-14\n").unwrap();
    let two = two.to_str().unwrap();
    let thrice = file("thrice.csv");
    let rows = wheelrail::Profile::built_in("60E1").unwrap().points().into_iter();
    let rows: String = rows.map(|[y, z]| format!("{},{}\n", 3.0 * y, 3.0 * z)).collect();
    fs::write(&thrice, format!("y [m],z [m]\n{rows}")).unwrap();
    let thrice = thrice.to_str().unwrap();
    let [smooth, noisy, noisier] = ["smooth.prw", "noisy.csv", "noisier.csv"].map(file);
    let [smooth, noisy, noisier] = [&smooth, &noisy, &noisier].map(|path| path.to_str().unwrap());
    said(&["profile", "S1002", "-o", smooth]);
    fs::write(noisy, noise(0.05)).unwrap();
    fs::write(noisier, noise(0.07)).unwrap();
    for (arguments, words) in [
        (&["geometry", "--rail", "61E1"][..], "did you mean 60E1"),
        (
            &["geometry", "--rail", "S1002"],
            "S1002 is the profile of a wheel; a rail is needed",
        ),
        (&["geometry", "--wheel", "missing.whl"], "missing.whl"),
        (&["geometry", "--wheel", rough], "rough.csv"),
        (&["geometry", "--from", "0.05", "--to", "0.05"], "beside its rail"),
        (&["geometry", "--to", "0.05"], "the left wheel stands on its flange"),
        (&["geometry", "--gauge", "1.3"], "stands on its flange"),
        (
            &["geometry", "--rail", thrice],
            "thrice.csv: its head, down to 14 mm below its top, is 185.7 mm broad: allowed is up to 120 mm; unit says in which unit the file is; as an option: \
             `wheelrail profile FILE --unit m|mm|in`",
        ),
        (&["geometry", "--gauge", "5"], "gauge = 5"),
        (&["geometry", "--step", "0"], "step = 0"),
        (&["geometry", "--step", "-1"], "step = -1: allowed is"),
        (
            &["geometry", "--wheel-radius", "-0.46"],
            "= -0.46: allowed is 0.05 to 5 m",
        ),
        (
            &["geometry", "--wheel", smooth, "--smoothing", "-1e-3"],
            "smoothing = -0.001: allowed is 0 to 0.1 m",
        ),
        (
            &["geometry", "--rail-inclination", "40"],
            "rail_inclination = 40: allowed is -0.2 to 0.2 as a slope",
        ),
        (
            &["profile", "60E1", "--inclination", "-0.3"],
            "rail_inclination = -0.3: allowed is -0.2 to 0.2 as a slope",
        ),
        (
            &["geometry", "--wheel", noisy],
            "lateral position; its direction turns to and fro, as noise does, which smoothing takes off (--smoothing)",
        ),
        (
            &["geometry", "--wheel", noisier],
            "no contact can be found beyond; its direction turns to and fro, as noise does, which smoothing takes off (--smoothing)",
        ),
        (
            &["geometry", "--from", "0.004", "--to", "-4e-3"],
            "last displacement = -0.004: allowed is 0.004 to 0.2 m",
        ),
        (&["profile", rough], "--body"),
        (&["profile", "S1002", "--inclination", "0.025"], "a rail is needed"),
        (
            &["profile", "S1002", "--unit", "mm"],
            "S1002: unit has no use: the profile is built in",
        ),
        (&["profile", "60e1", "--smoothing", "0.002"], "smoothing has no use"),
        (&["profile", "--smoothing", "0.002"], "required"),
        (
            &["profile", two, "--body", "rail", "--part", "1"],
            "part has no use: the file holds one profile",
        ),
        (
            &["profile", two, "--body", "rail", "--flange-back-position", "0.07"],
            "flange_back_position has no use: a rail has no flange",
        ),
        (&["geometry", "--smoothing", "0.002"], "all profiles are built in"),
        (&["geometry", "--outlines-at", "0.002"], "--outlines"),
        (&["profile", "60E1", "--measures"], "a wheel is needed"),
        (&["profile", "cone20", "--measures"], "it has no flange of 12 mm"),
        (&["profile", "S1002", "--against", "S1002"], "--measures"),
        (&["profile", "S1002", "--back", "0.07"], "--measures"),
        (
            &["profile", "S1002", "--measures", "--back", "0.3"],
            "flange_back_position = 0.3: allowed is 0.01 to 0.2 m",
        ),
        (
            &["profile", "S1002", "--measures", "--against", "S1003"],
            "did you mean S1002",
        ),
        (
            &["profile", "S1002", "--measures", "--against", "60E1"],
            "a wheel is needed",
        ),
        (
            &["profile", "S1002", "--worn-by", bare],
            "bare.csv, columns, line 1: its headings have no unit",
        ),
        (&["profile", "S1002", "--worn-by", "missing.csv"], "missing.csv"),
        (&["profile", "S1002", "--at", "0.1,top"], "a finite number of metres"),
        (&["profile", "S1002", "--at", "0.1", "--measures"], "--measures"),
        (
            &["profile", "S1002", "--at", "0.1", "-o", "at.prw"],
            "at.prw: --at is of the CSV",
        ),
    ] {
        let done = wheelrail(arguments);
        let beside = String::from_utf8_lossy(&done.stderr).into_owned();
        assert!(
            !done.status.success() && beside.contains(words),
            "{arguments:?}: {beside}"
        );
        assert!(done.stdout.is_empty());
    }
}

/// Between the points of a profile: the radius of the rail's crown, and beyond the end the straight line that begins there.
#[test]
fn a_profile_at_given_places() {
    let (own, _) = said(&["profile", "60E1"]);
    let arcs = column(&own, "arc_length [m]");
    let (middle, end) = (0.5 * arcs[arcs.len() - 1], arcs[arcs.len() - 1]);
    let beyond = end + 0.01;
    let (table, _) = said(&["profile", "60E1", "--at", &format!("{beyond},{middle},{end},-1e-3")]);
    assert_eq!(column(&table, "arc_length [m]"), [beyond, middle, end, -1e-3]);
    let [y, z, curvature] = ["y [m]", "z [m]", "curvature [1/m]"].map(|name| column(&table, name));
    assert!(y[1].abs() < 1e-9 && z[1].abs() < 1e-9, "{} {}", y[1], z[1]);
    assert!((curvature[1] + 1.0 / 0.3).abs() < 1e-6, "{}", curvature[1]);
    assert!(((y[0] - y[2]).hypot(z[0] - z[2]) - 0.01).abs() < 1e-9);
    assert_eq!(curvature[0], 0.0);
}

/// No table takes the place of another one or of what is read, and none is begun where another one cannot be written.
#[test]
fn no_file_is_written_over() {
    let (wheel, depths) = (file("own.prw"), file("own_depths.csv"));
    let [new, missing] = ["new.csv", "missing/new.csv"].map(file);
    fs::write(&depths, "arc_length [mm],depth [mm]\n75,0\n85,2\n105,2\n115,0\n").unwrap();
    let [wheel, depths, new, missing] = [&wheel, &depths, &new, &missing].map(|path| path.to_str().unwrap());
    said(&["profile", "S1002", "-o", wheel]);
    let inputs = [wheel, depths].map(|path| (path, fs::read(path).unwrap()));
    let twice = "--output is written to this file as well";
    let read_as = |option: &str| format!("reads this file ({option})");
    for (arguments, option, words) in [
        (&["geometry", "-o", new, "--jumps", new][..], "--jumps", twice),
        (&["geometry", "-o", new, "--outlines", new], "--outlines", twice),
        (
            &["geometry", "--wheel", wheel, "-o", wheel],
            "--output",
            &read_as("--wheel"),
        ),
        (
            &["geometry", "--wheel-right", wheel, "-o", new, "--jumps", wheel],
            "--jumps",
            &read_as("--wheel-right"),
        ),
        (
            &["geometry", "-o", new, "--outlines", missing],
            "--outlines",
            "missing is not there",
        ),
        (
            &[
                "geometry",
                "-o",
                new,
                "--outlines",
                "/dev/null",
                "--outlines-at",
                "0.05",
            ],
            "",
            "beside its rail",
        ),
        (&["profile", wheel, "-o", wheel], "--output", &read_as("the profile")),
        (
            &["profile", "S1002", "--worn-by", depths, "-o", depths],
            "--output",
            &read_as("--worn-by"),
        ),
        (
            &["profile", "S1002", "--measures", "--against", wheel, "-o", wheel],
            "--output",
            &read_as("--against"),
        ),
        (&["profile", "S1002", "-o", missing], "--output", "missing is not there"),
    ] {
        let done = wheelrail(arguments);
        let beside = String::from_utf8_lossy(&done.stderr).into_owned();
        assert_eq!(done.status.code(), Some(1), "{arguments:?}: {beside}");
        assert!(
            beside.contains(option) && beside.contains(words),
            "{arguments:?}: {beside}"
        );
        assert!(!Path::new(new).exists(), "{arguments:?}");
    }
    for (path, content) in inputs {
        assert_eq!(fs::read(path).unwrap(), content);
    }
}

/// A file that does not say everything is asked for the option that says it.
#[test]
fn what_a_file_does_not_say_has_an_option() {
    let (wheel, block) = (file("unsaid.csv"), file("block.csv"));
    said(&["profile", "S1002", "-o", wheel.to_str().unwrap()]);
    fs::write(&block, "y,z\n0,0\n2,1\n4,1\n6,1\n9,0\n").unwrap();
    for (path, more, option) in [
        (&wheel, &[][..], "--body rail|wheel"),
        (&block, &["--body", "rail"], "--unit m|mm|in"),
    ] {
        let arguments = [&["profile", path.to_str().unwrap(), "--measures"], more].concat();
        let done = wheelrail(&arguments);
        let beside = String::from_utf8_lossy(&done.stderr).into_owned();
        assert!(!done.status.success());
        assert!(
            beside.contains(&format!("`wheelrail profile FILE {option}`")),
            "{beside}"
        );
        assert!(!beside.contains("--y-to"), "{beside}");
    }
}

/// Whoever reads a few lines has seen enough, as in `wheelrail profile S1002 | head`.
#[test]
fn output_that_nobody_reads_any_more_is_no_error() {
    let mut child = Command::new(env!("CARGO_BIN_EXE_wheelrail"))
        .args(["profile", "S1002"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    let done = child.wait_with_output().unwrap();
    let beside = String::from_utf8_lossy(&done.stderr).into_owned();
    assert!(done.status.success() && !beside.contains("wheelrail:"), "{beside}");
}
