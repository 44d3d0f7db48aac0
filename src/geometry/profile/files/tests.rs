use super::*;

fn built_in(name: &str) -> Profile {
    Profile::built_in(name).unwrap()
}

fn wheel(text: &str, format: Format) -> Result<Profile, ProfileError> {
    let options = ReadOptions {
        body: Some(Body::Wheel),
        ..ReadOptions::default()
    };
    Profile::parse(text, "a file", format, &options)
}

fn rail(text: &str, format: Format) -> Result<Profile, ProfileError> {
    let options = ReadOptions {
        body: Some(Body::Rail),
        ..ReadOptions::default()
    };
    Profile::parse(text, "a file", format, &options)
}

/// Rows of a profile's points in `mm`, with signs and an order.
fn rows(profile: &Profile, signs: [f64; 2], reversed: bool) -> String {
    let mut points = profile.points();
    if reversed {
        points.reverse();
    }
    let row = |[y, z]: [f64; 2]| format!("{} {}\n", 1e3 * signs[0] * y, 1e3 * signs[1] * z);
    points.into_iter().map(row).collect()
}

/// Holds a profile that was read against the one that was written. The jumps of the curvature between points are rounded off.
fn assert_same(found: &Profile, expected: &Profile) {
    let (found, expected) = (found.height_function().unwrap(), expected.height_function().unwrap());
    let ([a, b], [c, d]) = (found.range(), expected.range());
    let (first, last) = (a.max(c) + 1e-3, b.min(d) - 1e-3);
    assert!(last - first > 60e-3);
    for place in 0..=1000 {
        let y = first + (last - first) * f64::from(place) / 1e3;
        let [z, other] = [&found, &expected].map(|height| height.value_slope_curvature(y)[0]);
        assert!((z - other).abs() < 1e-6, "{y}: {z} {other}");
    }
}

#[test]
fn what_is_written_is_read_back() {
    for name in ["S1002", "60E1", "60E2", "54E1", "49E1", "UIC60"] {
        let profile = built_in(name);
        for format in [Format::Simpack, Format::MiniProf, Format::Columns, Format::Vampire] {
            let options = ReadOptions {
                body: Some(profile.body()),
                ..ReadOptions::default()
            };
            let found = Profile::parse(&profile.text(format), name, format, &options).unwrap();
            assert_same(&found, &profile);
        }
    }
}

/// A rail twice as large as 60E1, whose head is 133 mm broad within 14 mm of its top, and a cylinder 210 mm broad are refused, by what is too broad about them;
/// a cylinder of 190 mm is a wheel. A rail with a groove beside its head is no broader than the head.
#[test]
fn what_is_broader_than_any_rail_or_wheel_is_refused() {
    let twice: String = (built_in("60E1").points().into_iter())
        .map(|[y, z]| format!("{} {}\n", 2e3 * y, 2e3 * z))
        .collect();
    let said = rail(&twice, Format::Columns).unwrap_err().to_string();
    assert!(
        said.contains("its head, down to 14 mm below its top, is 133.0 mm broad: allowed is up to 120 mm; unit says"),
        "{said}"
    );
    let cylinder = |half: f64| {
        let rows: String = (-10..=10)
            .map(|k| format!("{} 0\n", 0.1 * half * f64::from(k)))
            .collect();
        let options = ReadOptions {
            body: Some(Body::Wheel),
            y_to: Some(Lateral::ToField),
            z_up: Some(true),
            ..ReadOptions::default()
        };
        Profile::parse(&rows, "a file", Format::Columns, &options)
    };
    let said = cylinder(105.0).unwrap_err().to_string();
    assert!(
        said.contains("the wheel is 210.0 mm broad: allowed is up to 200 mm"),
        "{said}"
    );
    assert!(cylinder(95.0).is_ok());
    let grooved = "-30 -40\n-30 -20\n-28 -5\n-20 -1\n-10 -0.2\n0 0\n10 -0.2\n20 -1\n28 -5\n30 -16\n38 -40\n50 -40\n58 -16\n60 -3\n80 -3\n100 -3\n100 -40\n";
    let options = ReadOptions {
        body: Some(Body::Rail),
        unit: Some(LengthUnit::Millimetre),
        y_to: Some(Lateral::ToField),
        z_up: Some(true),
        ..ReadOptions::default()
    };
    let grooved = Profile::parse(grooved, "a file", Format::Columns, &options);
    assert!(grooved.is_ok(), "{grooved:?}");
}

/// Each end of a name has its format, which reads back what was written.
#[test]
fn files_are_written_by_the_end_of_their_names() {
    let folder = std::env::temp_dir().join(format!("wheelrail-profiles-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let wheel = built_in("S1002");
    let options = ReadOptions {
        body: Some(Body::Wheel),
        ..ReadOptions::default()
    };
    assert_eq!(written_endings(Body::Wheel), ["prw", "whl", "mpt", "whe", "csv"]);
    for ending in ["prw", "whl", "mpt", "whe", "csv", "txt"] {
        let path = folder.join(format!("wheel.{ending}"));
        wheel.write(&path).unwrap();
        assert_same(&Profile::read(&path, &options).unwrap(), &wheel);
    }
    // What could not be read again is not written.
    for ending in ["prr", "ban", "RAI"] {
        let path = folder.join(format!("wheel.{ending}"));
        let error = wheel.write(&path).unwrap_err().to_string();
        assert_eq!(
            error,
            format!("wheel.{ending}: a file of this ending holds a rail, and the profile is that of a wheel")
        );
        assert!(!path.exists());
    }
    std::fs::remove_dir_all(&folder).unwrap();
    let error = wheel.write(&folder.join("wheel.prw")).unwrap_err().to_string();
    assert!(error.contains("wheel.prw"), "{error}");
    let error = Profile::read(&folder.join("wheel.prw"), &options)
        .unwrap_err()
        .to_string();
    assert!(error.contains("wheel.prw"), "{error}");
}

/// Flanges tell how the file of a wheel is turned; the source says what was found.
#[test]
fn a_wheel_is_turned_by_its_flange() {
    let profile = built_in("S1002");
    for (signs, said) in [
        ([1.0, 1.0], "y to the field side by its shape, z upward"),
        ([-1.0, 1.0], "y to the gauge side by its shape, z upward"),
        ([1.0, -1.0], "y to the field side by its shape, z downward"),
        ([-1.0, -1.0], "y to the gauge side by its shape, z downward"),
    ] {
        for reversed in [false, true] {
            let found = wheel(&rows(&profile, signs, reversed), Format::Columns).unwrap();
            assert_same(&found, &profile);
            assert!(found.source().contains(said), "{}", found.source());
            assert!(found.source().contains("in mm by its size"), "{}", found.source());
        }
    }
}

/// An inclined rail does not show where the track's middle is.
#[test]
fn a_rail_that_is_not_symmetric_needs_its_side() {
    let upright = built_in("60E1");
    let inclined = upright.inclined(0.025).unwrap();
    for z in [1.0, -1.0] {
        assert_same(
            &rail(&rows(&upright, [1.0, z], false), Format::Columns).unwrap(),
            &upright,
        );
        let text = rows(&inclined, [-1.0, z], true);
        let error = rail(&text, Format::Columns).unwrap_err();
        assert!(error.to_string().contains("y_to has to say it"), "{error}");
        let options = ReadOptions {
            body: Some(Body::Rail),
            y_to: Some(Lateral::ToGauge),
            ..ReadOptions::default()
        };
        assert_same(
            &Profile::parse(&text, "a file", Format::Columns, &options).unwrap(),
            &inclined,
        );
    }
}

/// Options of SIMPACK that undo what the points have: a wheel mirrored, moved and turned, in m, with rows to leave out.
#[test]
fn options_of_simpack_are_honoured() {
    let profile = built_in("S1002");
    let (sine, cosine) = 0.1f64.sin_cos();
    let mut points = String::from("   9.0e-2  0.0\n");
    for [y, z] in profile.points().into_iter().rev() {
        // Mirrored back by mirror.y; turned back by rotate; moved back by shift.
        let [y, z] = [-y, -z];
        let [y, z] = [cosine * y + sine * z, cosine * z - sine * y];
        points += &format!("   {:.12}  {:.12} 1.0 ! a point\n", y - 0.5, z + 0.25);
    }
    let text = format!(
        "! a comment\nheader.begin\n version = 1\n type = 1 ! wheel\nheader.end\nspline.begin\n comment = 'a = b'\n shift.y = 0.5\n \
         shift.z = -0.25\n rotate = 5.729577951308232\n units.ang.f = 57.29577951308232\n bound.y.min = -0.08\n bound.y.max = 0.08\n \
         bound.z.min = 1\n bound.z.max = 0\n mirror.y = 1\n mirror.z = 0\n inversion = 1\n units.len.f = 1\n \
         point.begin\n{points} point.end\nspline.end\n"
    );
    let found = Profile::parse(&text, "a.prw", Format::Simpack, &ReadOptions::default()).unwrap();
    assert_same(&found, &profile);
    assert_eq!(found.body(), Body::Wheel);
    let wrong = text.replace("mirror.y = 1", "mirror.y = 0");
    let error = Profile::parse(&wrong, "a.prw", Format::Simpack, &ReadOptions::default()).unwrap_err();
    assert!(error.to_string().contains("this is no wheel"), "{error}");
    let error = rail(&text, Format::Simpack).unwrap_err().to_string();
    assert!(error.contains("is the profile of a wheel; a rail is needed"), "{error}");
}

/// MiniProf: new files with columns in another order and dropped lines, old ones, and one of several sections.
#[test]
fn files_of_miniprof_are_read() {
    let profile = built_in("S1002");
    let rows = rows(&profile, [-1.0, 1.0], false);
    let swapped: String = rows
        .lines()
        .map(|row| row.split_once(' ').unwrap())
        .map(|(y, z)| format!("0.5 {z} {y} 7\n\" 1 2 3 4\n"))
        .collect();
    let new = format!("ProgramName=MiniProf\n\"ColumnDef=X,Y,A\"\nColumnDef=A,Y,X,N\n\n{swapped}");
    assert_same(&wheel(&new, Format::MiniProf).unwrap(), &profile);
    let old = format!("MINIPROF 101 148 1994 3 24\na.prd\nStock.......:\n\" 32.58 37.11 14.71  (Sd/Sh/qR)\n\n{rows}");
    assert_same(&wheel(&old, Format::MiniProf).unwrap(), &profile);
    let sections = format!(
        "[FileInfo]\nA=1\n[Profile1Info]\nMPD1=L 27.1 -43.5\n[Profile1Points]\n0 0\n1 1\n[Profile2Points]\n{rows}"
    );
    let error = wheel(&sections, Format::MiniProf).unwrap_err().to_string();
    assert!(error.contains("2 profiles; part has to say"), "{error}");
    let options = ReadOptions {
        body: Some(Body::Wheel),
        part: Some(2),
        ..ReadOptions::default()
    };
    assert_same(
        &Profile::parse(&sections, "a.mpt", Format::MiniProf, &options).unwrap(),
        &profile,
    );
}

/// VAMPIRE: both wheels from the track's middle, the datum 70 mm from the flange's back; a rail with z upward.
#[test]
fn files_of_vampire_are_read() {
    let (profile, head) = (built_in("S1002"), built_in("60E1").inclined(0.025).unwrap());
    let text = |profile: &Profile, heading: &str, offset: f64, up: f64| {
        let row = |[y, z]: [f64; 2]| {
            let [y, z] = [1e3 * y + offset, 1e3 * up * z];
            format!("{} {z} {y} {z}\n", -y)
        };
        format!(
            "{heading}\n{}",
            profile.points().into_iter().map(row).collect::<String>()
        )
    };
    let wheels = text(
        &profile,
        "WHEELPROFILE\na title\nTREADDATUM EUROPEAN\nFLANGEBACK 1360.0",
        750.0,
        -1.0,
    );
    let rails = text(
        &head,
        "RAILPROFILE\na title\nGAUGEPOINT EUROPEAN\nGAUGE 1435.0",
        752.0,
        1.0,
    );
    for part in [None, Some(1), Some(2)] {
        let options = ReadOptions {
            part,
            ..ReadOptions::default()
        };
        assert_same(
            &Profile::parse(&wheels, "a.whe", Format::Vampire, &options).unwrap(),
            &profile,
        );
        assert_same(
            &Profile::parse(&rails, "a.rai", Format::Vampire, &options).unwrap(),
            &head,
        );
    }
    let custom = wheels.replace("EUROPEAN", "CUSTOM 70.5");
    let moved = wheel(&custom, Format::Vampire).unwrap();
    let back = |profile: &Profile| profile.points()[0][0];
    assert!((back(&moved) - back(&profile) + 0.5e-3).abs() < 1e-5);
}

/// A wheel that is measured from the back of its flange.
#[test]
fn the_running_circle_is_asked_for_where_it_is_elsewhere() {
    let profile = built_in("S1002");
    let shifted: String = profile
        .points()
        .into_iter()
        .map(|[y, z]| format!("{},{}\n", 1e3 * y + 170.0, 1e3 * z - 3.0))
        .collect();
    let error = wheel(&shifted, Format::Columns).unwrap_err().to_string();
    assert!(error.contains("flange_back_position has to say it"), "{error}");
    let options = ReadOptions {
        body: Some(Body::Wheel),
        flange_back_position: Some(70e-3),
        ..ReadOptions::default()
    };
    assert_same(
        &Profile::parse(&shifted, "a.csv", Format::Columns, &options).unwrap(),
        &profile,
    );
    // In millimetres it would be another wheel's.
    let in_mm = ReadOptions {
        flange_back_position: Some(70.0),
        ..options
    };
    let error = Profile::parse(&shifted, "a.csv", Format::Columns, &in_mm).unwrap_err();
    assert_eq!(error.to_string(), "flange_back_position = 70: allowed is 0.01 to 0.2 m");
}

#[test]
fn tables_of_all_kinds_are_read() {
    let profile = built_in("S1002");
    let points = profile.points();
    let rows = |separator: &str, unit: f64, comma: bool| -> String {
        let number = |value: f64| {
            let text = format!("{}", unit * value);
            if comma { text.replace('.', ",") } else { text }
        };
        points
            .iter()
            .map(|[y, z]| format!("{}{separator}{}\r\n", number(*y), number(*z)))
            .collect()
    };
    for text in [
        format!("# a comment\ny [mm],z [mm]\n{}", rows(",", 1e3, false)),
        format!("\u{feff}y [m];z [m]\n{}", rows(";", 1.0, true)),
        format!("% another\n\n{}", rows("\t", 1.0, false)),
        format!("y [in]  z [in]\n{}", rows("  ", 1.0 / 25.4e-3, false)),
    ] {
        assert_same(&wheel(&text, Format::Columns).unwrap(), &profile);
    }
    let inches = rows(",", 1.0 / 25.4e-3, false);
    let error = wheel(&inches, Format::Columns).unwrap_err().to_string();
    assert!(error.contains("unit has to say it"), "{error}");
}

/// Blanks between decimal commas, in all that takes rows of numbers.
#[test]
fn decimal_commas_between_blanks_are_read() {
    let profile = built_in("S1002");
    // Whole numbers among them stay as they are.
    let comma = |text: &str| text.replace(".000000000 ", " ").replace('.', ",");
    for (format, first) in [
        (Format::Simpack, "point.begin\n"),
        (Format::Vampire, "FLANGEBACK 1360.0\n"),
    ] {
        let text = profile.text(format);
        let (head, rows) = text.split_once(first).unwrap();
        let (rows, end) = rows.split_once("  point.end").unwrap_or((rows, ""));
        let end = if end.is_empty() {
            ""
        } else {
            "  point.end\nspline.end\n"
        };
        let text = format!("{head}{first}{}{end}", comma(rows));
        assert_same(&wheel(&text, format).unwrap(), &profile);
    }
    let rows = rows(&profile, [1.0, 1.0], false);
    for separator in [" ", "\t", "  ", ";"] {
        let text = comma(&rows).replace(' ', separator);
        assert_same(&wheel(&text, Format::Columns).unwrap(), &profile);
    }
    let name = format!("wheelrail-depths-{}.csv", std::process::id());
    let path = std::env::temp_dir().join(name);
    std::fs::write(&path, "\u{feff}arc_length [mm] depth [mm]\r75,0 0,0\r85 2,5\r").unwrap();
    let depths = read_depths(&path);
    std::fs::remove_file(&path).unwrap();
    assert_eq!(depths.unwrap(), [[75e-3, 0.0], [85e-3, 2.5e-3]]);
}

/// Rows of which either may be meant, and files that have both, are refused with the line.
#[test]
fn commas_that_may_be_either_are_refused() {
    for (text, said) in [
        (
            "1.5 2.5\n3,5 4,5\n",
            "line 2: \"3,5 4,5\" has decimal commas, and line 1 has decimal points",
        ),
        (
            "1,5 2,5\n3\t4\n3.5 4.5\n",
            "line 3: \"3.5 4.5\" has decimal points, or commas between its numbers, and line 1 has",
        ),
        ("1,5 2,5\n3,4\n", "line 2"),
        (
            "1,5, 2,5\n",
            "line 1: \"1,5, 2,5\" is no row of numbers: its commas may be decimal ones or between numbers",
        ),
        ("1,5;2.5\n", "line 1: \"1,5;2.5\" is no row of numbers"),
        (
            "y [mm],z [mm]\n1,5,2,5\n",
            "line 2: \"1,5,2,5\" is 4 numbers below 2 headings: a comma is either the decimal point or between numbers",
        ),
    ] {
        let error = wheel(text, Format::Columns).unwrap_err().to_string();
        assert!(error.contains(said), "{error}");
    }
    let simpack = "spline.begin\npoint.begin\n1,5 2,5\n3.5 4.5\npoint.end\nspline.end\n";
    let error = wheel(simpack, Format::Simpack).unwrap_err().to_string();
    assert!(error.contains("SIMPACK, line 4"), "{error}");
    for (row, numbers) in [
        ("1, 2, 3", [1.0, 2.0, 3.0]),
        ("1.5,2 ,3,", [1.5, 2.0, 3.0]),
        ("-1,5 2 3,25", [-1.5, 2.0, 3.25]),
    ] {
        assert_eq!(
            numbers::Rows::default().numbers(1, row),
            Ok(Some(numbers.to_vec())),
            "{row}"
        );
    }
}

/// A mark before the text, and line ends of other systems, do not change what is read.
#[test]
fn marks_and_line_ends_of_other_systems_are_read() {
    let profile = built_in("S1002");
    for format in [Format::Simpack, Format::MiniProf, Format::Columns, Format::Vampire] {
        for end in ["\r\n", "\r"] {
            let text = format!("\u{feff}{}", profile.text(format).replace('\n', end));
            assert_same(&wheel(&text, format).unwrap(), &profile);
        }
    }
    let text = format!("\u{feff}{}", profile.text(Format::Vampire));
    assert_eq!(Format::of(Path::new("a.txt"), &text), Format::Vampire);
    let path = std::env::temp_dir().join(format!("wheelrail-utf16-{}.prw", std::process::id()));
    for mark in MARKS_OF_UTF_16 {
        std::fs::write(&path, [&mark[..], b"!\0\n\0"].concat()).unwrap();
        let error = Profile::read(&path, &ReadOptions::default()).unwrap_err().to_string();
        assert!(error.contains("it is in UTF-16: allowed is UTF-8"), "{error}");
    }
    std::fs::remove_file(&path).unwrap();
}

/// A file whose end is missing is no shorter profile.
#[test]
fn files_that_are_cut_off_are_refused() {
    let profile = built_in("S1002");
    let text = profile.text(Format::Simpack);
    let before = |end: &str| text.split_once(end).unwrap().0.to_owned();
    for (cut, said) in [
        (
            before("  point.end"),
            "it ends within the block of points, before point.end: the file is cut off",
        ),
        (
            text.lines().take(99).map(|line| format!("{line}\n")).collect(),
            "before point.end: the file is cut off",
        ),
        (
            before("spline.end"),
            "it ends within the block spline, before spline.end",
        ),
        (
            before("header.end"),
            "it ends within the block header, before header.end",
        ),
    ] {
        let error = wheel(&cut, Format::Simpack).unwrap_err().to_string();
        assert!(error.contains(said), "{error}");
    }

    let text = profile.text(Format::MiniProf);
    let count = profile.points().len();
    let cut: String = text.lines().take(count).map(|line| format!("{line}\n")).collect();
    let error = wheel(&cut, Format::MiniProf).unwrap_err().to_string();
    let said = format!(
        "XYPoints={count}, and it has {} rows of points: the file is cut off",
        count - 4
    );
    assert!(error.contains(&said), "{error}");
    // Rows that are dropped count, and a row that somebody has added does no harm.
    let (head, rows) = text.split_once("\n\n").unwrap();
    let (first, rest) = rows.split_once('\n').unwrap();
    for rows in [format!("{first}\n\" {rest}"), format!("{rows}70.5 -1.0\n")] {
        wheel(&format!("{head}\n\n{rows}"), Format::MiniProf).unwrap();
    }
    let blank = cut.replace(&format!("XYPoints={count}"), "XYPoints=");
    wheel(&blank, Format::MiniProf).unwrap();
    let error = wheel(&blank.replace("XYPoints=", "XYPoints=all"), Format::MiniProf)
        .unwrap_err()
        .to_string();
    assert!(
        error.contains("line 2: XYPoints=all: a number of rows is needed"),
        "{error}"
    );

    let sections = |said: usize| format!("[FileInfo]\n[Profile7Info]\nXYPoints={said}\n[Profile7Points]\n{rows}");
    wheel(&sections(count), Format::MiniProf).unwrap();
    let error = wheel(&sections(count + 1), Format::MiniProf).unwrap_err().to_string();
    assert!(
        error.contains(&format!("it has {count} rows of points: the file is cut off")),
        "{error}"
    );
}

#[test]
fn files_that_are_none_are_refused() {
    let (s1002, e60) = (
        rows(&built_in("S1002"), [1.0, 1.0], false),
        rows(&built_in("60E1"), [1.0, 1.0], false),
    );
    let simpack = |middle: &str| format!("header.begin\n type = 0\nheader.end\nspline.begin\n{middle}\nspline.end\n");
    for (result, said) in [
        (wheel("", Format::Columns), "no rows of two numbers"),
        (wheel("", Format::MiniProf), "no rows of points"),
        (wheel("", Format::Simpack), "no points"),
        (wheel("", Format::Vampire), "WHEELPROFILE"),
        (wheel("1 2\n3 x\n", Format::Columns), "line 2"),
        (
            wheel("y [mm],z [mm]\n1,2\n", Format::Columns),
            "too few points, 1: at least 5 show a wheel",
        ),
        (
            rail("1 2\n3 4\n5 6\n", Format::Columns),
            "too few points, 3: at least 5 show a rail",
        ),
        (wheel("y [mm],z [m]\n1,2\n", Format::Columns), "different units"),
        (wheel("y [furlong],z\n1,2\n", Format::Columns), "furlong"),
        (wheel(&e60, Format::Columns), "this is no wheel"),
        (rail(&s1002, Format::Columns), "this is no rail"),
        (wheel(&format!("{s1002}{s1002}"), Format::Columns), "two branches"),
        (wheel(&format!("{s1002}NaN 1\n"), Format::Columns), "not finite"),
        (rail(&simpack("shift.y = much"), Format::Simpack), "shift.y = much"),
        (rail(&simpack("units.len.f = 0"), Format::Simpack), "units.len.f = 0"),
        (rail(&simpack("inversion = 2"), Format::Simpack), "inversion = 2"),
        (
            rail(&simpack("point.begin\n1\npoint.end"), Format::Simpack),
            "no point y z",
        ),
        (rail("header.begin\nspline.end\n", Format::Simpack), "not begun"),
        (rail("nonsense\n", Format::Simpack), "nonsense"),
        (rail("RAILPROFILE\ntitle\nGAUGE 1435\n", Format::Vampire), "GAUGEPOINT"),
        (
            wheel("WHEELPROFILE\ntitle\nTREADDATUM MARS\n", Format::Vampire),
            "TREADDATUM",
        ),
    ] {
        let error = result.unwrap_err().to_string();
        assert!(error.contains(said), "{error}");
    }
    let unsaid = Profile::parse(&s1002, "a.csv", Format::Columns, &ReadOptions::default()).unwrap_err();
    assert!(unsaid.to_string().contains("body has to say it"), "{unsaid}");
}

/// Texts that are mangled at random, with a fixed seed: read or refused, without a panic.
#[test]
fn mangled_files_do_no_harm() {
    let mut state = 0x2545_f491_4f6c_dd1du64;
    let mut draw = move |below: usize| {
        // Marsaglia's xorshift.
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state % below.max(1) as u64) as usize
    };
    let formats = [Format::Simpack, Format::MiniProf, Format::Columns, Format::Vampire];
    let pieces = [
        "1e309",
        "-",
        "NaN",
        "=",
        "\"",
        ",",
        "\n",
        "point.end",
        "[",
        "0",
        "1e-300",
        "inf",
        ";",
        "type = 7",
        "ColumnDef=Y",
    ];
    let mut read = 0;
    for round in 0..3000 {
        let profile = built_in(["S1002", "60E1"][round % 2]);
        let format = formats[draw(formats.len())];
        let text = profile.text(format);
        // Few lines, so that a round is short.
        let mut lines: Vec<String> = text
            .lines()
            .enumerate()
            .filter(|(k, _)| *k < 12 || k % 16 == 0)
            .map(|(_, l)| l.to_owned())
            .collect();
        for _ in 0..draw(6) {
            let line = draw(lines.len());
            match draw(5) {
                0 => drop(lines.remove(line)),
                1 => lines[line] += pieces[draw(pieces.len())],
                2 => lines[line] = pieces[draw(pieces.len())].to_owned(),
                3 => lines.swap(0, line),
                _ => lines.truncate(line + 1),
            }
            if lines.is_empty() {
                lines.push(String::new());
            }
        }
        let options = ReadOptions {
            body: [None, Some(profile.body())][draw(2)],
            smoothing: [0.0, 2e-3][draw(2)],
            ..ReadOptions::default()
        };
        if let Ok(found) = Profile::parse(&lines.join("\n"), "mangled", format, &options) {
            read += 1;
            assert!(found.points().iter().flatten().all(|value| value.is_finite()));
            let _ = found.height_function();
            let _ = found.gauge_point(14e-3);
        }
    }
    assert!(read > 200, "{read}");
}
