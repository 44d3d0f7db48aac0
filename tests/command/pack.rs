//! `wheelrail pack`: the archive's content, several platforms in one archive, and the same bytes from the same sources.

use super::images::{darwin, functions, windows};
use std::fs::{File, copy, read, write};
use std::io::Read;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use wheelrail::Profile;
use wheelrail::fmi2::GUID;
use zip::{CompressionMethod, DateTime, ZipArchive};

/// A folder of its own for each test.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

/// What passes for a library of this build for win64: it carries the GUID.
fn windows_library(path: &Path, content: &str) {
    write(path, windows(&functions(), &format!("{content}{GUID}"))).unwrap();
}

/// The same for darwin64.
fn darwin_library(path: &Path) {
    write(path, darwin(&functions(), GUID)).unwrap();
}

fn pack(folder: &Path, arguments: &[&str]) -> Output {
    // A copy, without what may say beside the library what compiled it.
    let library = folder.join("own.so");
    copy(super::library_path(), &library).unwrap();
    Command::new(env!("CARGO_BIN_EXE_wheelrail"))
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .arg("pack")
        .arg("--library")
        .arg(library)
        .args(arguments)
        .output()
        .unwrap()
}

#[track_caller]
fn packed(folder: &Path, name: &str, arguments: &[&str]) -> PathBuf {
    let path = folder.join(name);
    let output = pack(folder, &[arguments, &["--output", path.to_str().unwrap()]].concat());
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    path
}

/// The message of a refusal.
#[track_caller]
fn refused(folder: &Path, arguments: &[&str]) -> String {
    let path = folder.join("refused.fmu");
    let output = pack(folder, &[arguments, &["--output", path.to_str().unwrap()]].concat());
    assert_eq!(output.status.code(), Some(1));
    assert!(!path.exists());
    String::from_utf8(output.stderr).unwrap()
}

fn binaries(path: &Path) -> Vec<String> {
    let archive = ZipArchive::new(File::open(path).unwrap()).unwrap();
    let names = archive
        .file_names()
        .filter_map(|name| name.ok()?.strip_prefix("binaries/").map(str::to_owned));
    let mut names: Vec<_> = names.collect();
    names.sort();
    names
}

/// The folder of this platform's library and its name.
fn own() -> String {
    let (system, extension) = match std::env::consts::OS {
        "windows" => ("win", "dll"),
        "macos" => ("darwin", "dylib"),
        system => (system, "so"),
    };
    format!("{system}{}/wheelrail.{extension}", usize::BITS)
}

#[test]
fn the_archive_is_as_the_standard_wants_it() {
    let folder = folder("content");
    let path = packed(&folder, "a.fmu", &[]);
    let mut archive = ZipArchive::new(File::open(path).unwrap()).unwrap();
    let mut names = Vec::new();
    for index in 0..archive.len() {
        let mut entry = archive.by_index(index).unwrap();
        let name = entry.name().unwrap().into_owned();
        assert!(entry.is_file() && !entry.is_symlink(), "{name}");
        assert!(
            [CompressionMethod::Stored, CompressionMethod::Deflated].contains(&entry.compression()),
            "{name}"
        );
        assert_eq!(entry.last_modified(), Some(DateTime::default()), "{name}");
        let mut content = Vec::new();
        entry.read_to_end(&mut content).unwrap();
        // The licences in the archive are those of the repository, whole.
        let own = match &*name {
            "modelDescription.xml" => Some("modelDescription/modelDescription.xml"),
            "documentation/licenses/LICENSE-APACHE" => Some("LICENSE-APACHE"),
            "documentation/licenses/LICENSE-MIT" => Some("LICENSE-MIT"),
            _ => None,
        };
        if let Some(path) = own {
            assert_eq!(content, read(path).unwrap(), "{name}");
        }
        names.push(name);
    }
    for name in ["modelDescription.xml", "model.png", "documentation/index.html"] {
        assert!(names.iter().any(|n| n == name), "{name}");
    }
    // Where the folder is there, the standard asks for license.txt as the way in.
    for name in ["license.txt", "LICENSE-APACHE", "LICENSE-MIT", "THIRD-PARTY.txt"] {
        assert!(names.contains(&format!("documentation/licenses/{name}")), "{name}");
    }
    assert!(names.contains(&format!("binaries/{}", own())));
}

#[test]
fn the_same_sources_give_the_same_bytes() {
    let folder = folder("same");
    let other = folder.join("other.dll");
    windows_library(&other, "another platform");
    let binary = format!("win64={}", other.display());
    let first = packed(&folder, "first.fmu", &["--binary", &binary]);
    // The dates of the files are other ones.
    windows_library(&other, "another platform");
    let second = packed(&folder, "second.fmu", &["--binary", &binary]);
    assert_eq!(read(first).unwrap(), read(second).unwrap());
}

#[test]
fn libraries_of_other_platforms_are_added_and_merged() {
    let folder = folder("merged");
    let (windows, mac) = (folder.join("w.dll"), folder.join("m.dylib"));
    windows_library(&windows, "windows");
    darwin_library(&mac);
    let win = format!("win64={}", windows.display());
    let darwin = format!("darwin64={}", mac.display());
    let both = packed(&folder, "both.fmu", &["--binary", &win, "--binary", &darwin]);
    let mut expected = vec![
        "darwin64/wheelrail.dylib".to_owned(),
        own(),
        "win64/wheelrail.dll".to_owned(),
    ];
    expected.sort();
    assert_eq!(binaries(&both), expected);
    // Merged from archives, in any order, it is the same archive.
    let first = packed(&folder, "first.fmu", &["--binary", &win]);
    let second = packed(&folder, "second.fmu", &["--binary", &darwin]);
    for order in [[&first, &second], [&second, &first]] {
        let [a, b] = order.map(|path| path.to_str().unwrap());
        let merged = packed(&folder, "merged.fmu", &["--merge", a, "--merge", b]);
        assert_eq!(read(&merged).unwrap(), read(&both).unwrap());
    }
}

/// Profiles lie among the resources under the names of their files.
#[test]
fn profiles_are_put_among_the_resources() {
    let folder = folder("profiles");
    let other = folder.join("other");
    std::fs::create_dir_all(&other).unwrap();
    let [rail, wheel, twin, known] = [
        folder.join("worn räil.prr"),
        folder.join("wheel.prw"),
        other.join("wheel.prw"),
        other.join("60e1"),
    ];
    let new = Profile::built_in("S1002").unwrap();
    let depths = [[0.075, 0.0], [0.085, 2e-3], [0.105, 2e-3], [0.115, 0.0]];
    Profile::built_in("49E1").unwrap().write(&rail).unwrap();
    new.write(&wheel).unwrap();
    new.worn_by(&depths).unwrap().write(&twin).unwrap();
    copy(&rail, &known).unwrap();
    let contents = [&rail, &wheel].map(|path| read(path).unwrap());
    let [rail, wheel, twin, known] = [&rail, &wheel, &twin, &known].map(|path| path.to_str().unwrap());
    for standard in ["2", "3"] {
        let options = ["--fmi", standard, "--rail-profile", rail, "--wheel-profile", wheel];
        let archive = packed(&folder, "profiles.fmu", &options);
        let mut archive = ZipArchive::new(File::open(archive).unwrap()).unwrap();
        for (name, expected) in ["resources/worn räil.prr", "resources/wheel.prw"].iter().zip(&contents) {
            let mut content = Vec::new();
            archive.by_name(name).unwrap().read_to_end(&mut content).unwrap();
            assert_eq!(content, *expected);
        }
    }
    let message = refused(&folder, &["--wheel-profile", wheel, "--wheel-profile", twin]);
    assert!(
        message.contains("another profile has a file of the same name"),
        "{message}"
    );
    let message = refused(&folder, &["--rail-profile", known]);
    assert!(
        message.contains("the profile 60E1 that is built in would go before it"),
        "{message}"
    );
    let message = refused(&folder, &["--rail-profile", "nowhere.prr"]);
    assert!(message.contains("nowhere.prr"), "{message}");
}

/// A file that the unit could not read as the profile of its body is refused with the words of `wheelrail profile`, and no archive is written.
#[test]
fn profiles_that_are_none_of_their_body_are_refused() {
    let folder = folder("no_profiles");
    let [wheel, text, unsaid, short] =
        ["wheel.prw", "text.prr", "unsaid.csv", "short.csv"].map(|name| folder.join(name));
    Profile::built_in("S1002").unwrap().write(&wheel).unwrap();
    write(&text, "a rail").unwrap();
    write(&unsaid, "y,z\n0,0\n2,1\n4,1\n6,1\n9,0\n").unwrap();
    write(&short, "y [mm],z [mm]\n10,0\n20,1\n30,2\n40,3\n50,4\n").unwrap();
    for (option, path, body, words) in [
        (
            "--rail-profile",
            &wheel,
            "rail",
            "wheel.prw is the profile of a wheel; a rail is needed",
        ),
        ("--rail-profile", &text, "rail", "text.prr, SIMPACK"),
        (
            "--rail-profile",
            &unsaid,
            "rail",
            "`wheelrail profile FILE --unit m|mm|in`",
        ),
        (
            "--wheel-profile",
            &short,
            "wheel",
            "this is no wheel with y to the field side and z upward",
        ),
    ] {
        let path = path.to_str().unwrap();
        let message = refused(&folder, &[option, path]);
        let output = Command::new(env!("CARGO_BIN_EXE_wheelrail"))
            .args(["profile", path, "--body", body])
            .output()
            .unwrap();
        let same = String::from_utf8(output.stderr).unwrap();
        let reason = same.strip_prefix("wheelrail: ").unwrap();
        assert!(reason.contains(words), "{reason}");
        assert_eq!(message, format!("wheelrail: {option} {path}: {reason}"));
    }
}

#[test]
fn what_does_not_belong_together_is_refused() {
    let folder = folder("refused");
    // A library of another build.
    let stale = folder.join("stale.dll");
    write(&stale, "no GUID").unwrap();
    let message = refused(&folder, &["--binary", &format!("win64={}", stale.display())]);
    assert!(
        message.contains("was not built with this model description") && message.contains(GUID),
        "{message}"
    );
    // Two libraries for one platform.
    let (first, second) = (folder.join("1.dll"), folder.join("2.dll"));
    windows_library(&first, "one");
    windows_library(&second, "two");
    let platform = |path: &Path| format!("win64={}", path.display());
    let message = refused(
        &folder,
        &["--binary", &platform(&first), "--binary", &platform(&second)],
    );
    assert!(
        message.contains("binaries/win64/wheelrail.dll is there twice"),
        "{message}"
    );
    let archive = packed(&folder, "one.fmu", &["--binary", &platform(&first)]);
    let message = refused(
        &folder,
        &["--binary", &platform(&second), "--merge", archive.to_str().unwrap()],
    );
    assert!(message.contains("is there twice"), "{message}");
    // An archive of other sources, something that is no archive, nothing at all.
    let foreign = folder.join("foreign.fmu");
    let mut writer = zip::ZipWriter::new(File::create(&foreign).unwrap());
    let options = zip::write::SimpleFileOptions::default().compression_method(CompressionMethod::Stored);
    writer.start_file("modelDescription.xml", options).unwrap();
    writer.finish().unwrap();
    let message = refused(&folder, &["--merge", foreign.to_str().unwrap()]);
    assert!(message.contains("another modelDescription.xml"), "{message}");
    let message = refused(&folder, &["--merge", stale.to_str().unwrap()]);
    assert!(message.contains("stale.dll"), "{message}");
    let message = refused(&folder, &["--merge", folder.join("missing.fmu").to_str().unwrap()]);
    assert!(message.contains("missing.fmu"), "{message}");
}

fn copy_folder(source: &Path, to: &Path) {
    std::fs::create_dir_all(to).unwrap();
    for entry in std::fs::read_dir(source).unwrap().map(Result::unwrap) {
        let to = to.join(entry.file_name());
        if entry.file_type().unwrap().is_dir() {
            copy_folder(&entry.path(), &to);
        } else {
            std::fs::copy(entry.path(), to).unwrap();
        }
    }
}

/// Whatever goes into the archive is not written over by it.
#[test]
fn no_file_is_written_over() {
    let folder = folder("written_over");
    let rail = folder.join("rail.prr");
    Profile::built_in("60E1").unwrap().write(&rail).unwrap();
    let own = folder.join("own.so");
    let archive = packed(&folder, "first.fmu", &[]);
    let [rail, own, archive] = [&rail, &own, &archive].map(|path| path.to_str().unwrap());
    // A copy: were it written over, it would not be the project's own.
    let description = folder.join("description");
    copy_folder(
        &Path::new(env!("CARGO_MANIFEST_DIR")).join("modelDescription"),
        &description,
    );
    let [picture, notice] = ["model.png", "licenses/license.txt"].map(|name| description.join(name));
    let [picture, notice, description] = [&picture, &notice, &description].map(|path| path.to_str().unwrap());
    for (options, output, other) in [
        (&["--rail-profile", rail][..], rail, "--rail-profile"),
        (&["--merge", archive], archive, "--merge"),
        (&[], own, "--library"),
        (&["--description", description], picture, "--description"),
        (&["--description", description], notice, "--description"),
    ] {
        let path = Path::new(output);
        // The library is there from the packing above on.
        let before = read(path).unwrap();
        let done = pack(&folder, &[options, &["--output", output]].concat());
        let message = String::from_utf8(done.stderr).unwrap();
        assert_eq!(done.status.code(), Some(1), "{message}");
        let words = format!("--output {output}: the command reads this file ({other})");
        assert!(message.contains(&words), "{message}");
        assert!(read(path).unwrap() == before, "{output} has changed");
    }
}

/// Without `--library` it is that beside the program, as cargo leaves it, or that in `../library`, as `make` does; of two the one
/// that was built last.
#[test]
fn the_library_is_found_where_the_build_puts_it() {
    let folder = folder("found");
    let [release, library] = ["release", "library"].map(|name| folder.join(name));
    for folder in [&release, &library] {
        let _ = std::fs::remove_dir_all(folder);
        std::fs::create_dir_all(folder).unwrap();
    }
    // A link, as a copy could not be run while another test starts a program.
    let program = release.join(format!("wheelrail{}", std::env::consts::EXE_SUFFIX));
    std::fs::hard_link(env!("CARGO_BIN_EXE_wheelrail"), &program).unwrap();
    let name = super::library_path().file_name().unwrap().to_owned();
    let [beside, made] = [&release, &library].map(|folder| folder.join(&name));
    let archive = folder.join("found.fmu");
    let pack_in = |folder: &Path| {
        let _ = std::fs::remove_file(&archive);
        let mut command = Command::new(&program);
        command.current_dir(folder).arg("pack").arg("--output").arg(&archive);
        let done = command.output().unwrap();
        assert_eq!(done.status.success(), archive.exists());
        String::from_utf8(done.stderr).unwrap()
    };
    let sources = Path::new(env!("CARGO_MANIFEST_DIR"));

    let message = pack_in(sources);
    for part in [beside.to_str().unwrap(), made.to_str().unwrap(), "--library"] {
        assert!(message.contains(part), "{message} lacks {part}");
    }
    copy(super::library_path(), &made).unwrap();
    pack_in(sources);
    assert_eq!(binaries(&archive), [own()]);
    // One of older sources beside the program, and then a newer one.
    write(&beside, "no GUID").unwrap();
    let old = File::options().write(true).open(&beside).unwrap();
    old.set_modified(std::time::UNIX_EPOCH).unwrap();
    pack_in(sources);
    assert_eq!(binaries(&archive), [own()]);
    old.set_modified(std::time::SystemTime::now() + std::time::Duration::from_secs(60))
        .unwrap();
    let message = pack_in(sources);
    assert!(message.contains(beside.to_str().unwrap()), "{message}");

    // As installed, far from the sources.
    let message = pack_in(&folder);
    for part in ["--description modelDescription", "sources", "resources/my.prr"] {
        assert!(message.contains(part), "{message} lacks {part}");
    }
}

#[test]
fn a_platform_is_named_before_its_file() {
    let folder = folder("usage");
    for (argument, status, reason) in [
        ("win64", 2, "PLATFORM=FILE"),
        ("win64=", 2, "PLATFORM=FILE"),
        ("=a.dll", 2, "PLATFORM=FILE"),
        ("../x=a.dll", 1, "a.dll: FMI 2.0 has no platform ../x"),
        (
            "aarch64-linux=a.so",
            1,
            "it has darwin64, linux32, linux64, win32, win64",
        ),
    ] {
        let output = pack(&folder, &["--binary", argument]);
        assert_eq!(output.status.code(), Some(status), "{argument}");
        let message = String::from_utf8_lossy(&output.stderr);
        assert!(message.contains(reason), "{message}");
    }
}

#[test]
fn a_library_is_of_the_platform_that_it_is_given_for() {
    let folder = folder("platform");
    let [dll, dylib, text, part] = ["a.dll", "a.dylib", "a.txt", "part.dll"].map(|name| folder.join(name));
    windows_library(&dll, "");
    darwin_library(&dylib);
    write(&text, GUID).unwrap();
    let mut some = functions();
    let missing = some.split_off(some.len() - 2);
    write(&part, windows(&some, GUID)).unwrap();
    for (platform, path, reason) in [
        ("win32", &dll, "a.dll is Pe for X86_64, which is no library of win32"),
        ("linux64", &dll, "which is no library of linux64"),
        (
            "win64",
            &dylib,
            "a.dylib is MachO for X86_64 and Aarch64, which is no library of win64",
        ),
        ("win64", &text, "a.txt cannot be read as a shared library"),
        (
            "win64",
            &part,
            &format!("part.dll does not export {}", missing.join(", ")),
        ),
    ] {
        let message = refused(&folder, &["--binary", &format!("{platform}={}", path.display())]);
        assert!(message.contains(reason), "{message}");
    }
}

#[test]
fn the_archive_says_what_compiled_each_library() {
    let folder = folder("build");
    let dll = folder.join("a.dll");
    windows_library(&dll, "");
    write(folder.join("a.dll.build.txt"), "rustc 1.89.0; linked by MinGW\n").unwrap();
    let binary = format!("win64={}", dll.display());
    let first = packed(&folder, "first.fmu", &["--binary", &binary]);
    let merged = packed(&folder, "merged.fmu", &["--merge", first.to_str().unwrap()]);
    for path in [first, merged] {
        let mut archive = ZipArchive::new(File::open(path).unwrap()).unwrap();
        let mut text = String::new();
        let mut entry = archive.by_name("documentation/build.txt").unwrap();
        entry.read_to_string(&mut text).unwrap();
        let own = own().split('/').next().unwrap().to_owned();
        assert_eq!(
            text,
            format!("{own}: not recorded\nwin64: rustc 1.89.0; linked by MinGW\n")
        );
    }
}
