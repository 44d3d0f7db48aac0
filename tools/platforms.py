"""Build the component for platforms beside linux64 and run each under an emulator, for `make fmu` to pack.

    make platforms                       and pack what was built
    make platforms PLATFORMS=--twice     build in a second folder too and compare the bytes

What cannot be built or run here is skipped with the reason. Exit status 1: a library that was built is not as it should
be; it is not packed, and the archive of linux64 is as it would be without it. tools/toolchains.py says where
compilers come from, tools/manoeuvre.py what is run and how results are compared.
"""

import argparse
import hashlib
import os
import shutil
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass, field
from pathlib import Path

import binaries
import manoeuvre
import toolchains
from cargo import REPOSITORY, TARGET, write_origin
from toolchains import AARCH64, PLATFORMS, WIN64, MissingError

# What the shared library is made of; the same as in the archive of linux64.
LIBRARY = ("--locked", "--release", "--lib", "--no-default-features", "--features", "fmi")
HOST = manoeuvre.HOST
# The command line, with all features, as on linux64.
COMMAND = ("--locked", "--release", "--bin", "wheelrail")
SHIM = HOST.with_name("bcryptprimitives.c")
WARNINGS = ("-std=c11", "-O2", "-Wall", "-Wextra", "-Werror")
# What the command line is tried by: it has to print the lines that it prints on linux64.
COMMAND_TRIED = (["--version"], ["describe", "--xml", "--fmi", "3"], ["profile", "S1002", "--measures"])
# Beside a library, and a command, that is as it should be: a digest of the sources that it was built from.
PASSED = "passed"
COMMAND_PASSED = "command.passed"
# The platforms' names in the archive of each version of FMI: 2.0 has none for aarch64.
NAMES = {"fmi2": {"win64": "win64"}, "fmi3": {"win64": "x86_64-windows", "aarch64-linux": "aarch64-linux"}}


@dataclass
class Report:
    """What became of each platform, for the last lines."""

    built: dict = field(default_factory=dict)
    skipped: list = field(default_factory=list)
    wrong: list = field(default_factory=list)

    def skip(self, what, reason):
        """Note what was left out and why."""
        self.skipped.append(f"{what}: {reason}")
        print(f"SKIPPED {self.skipped[-1]}", flush=True)

    def fail(self, what, reasons):
        """Note what is wrong."""
        for reason in reasons:
            self.wrong.append(f"{what}: {reason}")
            print(f"WRONG {self.wrong[-1]}", flush=True)


def say(text):
    """Print a heading, as the Makefile does."""
    print(f"\n== {text}", flush=True)


def digest_of_sources(with_command=False):
    """Return a SHA-256 of what libraries are compiled from, or the command line."""
    digest = hashlib.sha256()
    command = REPOSITORY / "src" / "bin"
    paths = [path for path in (REPOSITORY / "src").rglob("*.rs") if with_command or not path.is_relative_to(command)]
    for path in sorted([*paths, REPOSITORY / "Cargo.toml", REPOSITORY / "Cargo.lock"]):
        digest.update(f"{path.relative_to(REPOSITORY)}\0".encode() + path.read_bytes())
    return digest.hexdigest()


def passed(name):
    """Whether a library was built from the sources as they are, and is as it should be."""
    mark = PLATFORMS / name / PASSED
    return mark.exists() and mark.read_text() == digest_of_sources()


def print_binaries(version):
    """Print the options of `wheelrail pack` for the platforms that passed."""
    for platform, _, _ in BUILDS:
        if platform.name in NAMES[version] and passed(platform.name):
            path = os.path.relpath(PLATFORMS / platform.name / platform.library, REPOSITORY)
            print(f"--binary={NAMES[version][platform.name]}={path}")


def print_command(name):
    """Print the path of a platform's command line, if it passed."""
    (platform,) = (platform for platform, _, _ in BUILDS if platform.name == name)
    folder = PLATFORMS / name
    mark = folder / COMMAND_PASSED
    if mark.exists() and mark.read_text() == digest_of_sources(with_command=True):
        print(folder / platform.command)


def reference_library():
    """Return the library of linux64 that `make fmu` left."""
    path = TARGET / "library.path"
    if not path.exists():
        sys.exit("there is no library of linux64: run `make fmu` first")
    return Path(path.read_text().strip())


def compile_library(platform, chain):
    """Compile the library of a platform; return a copy that no other build writes to."""
    chain.call(chain.build, *LIBRARY)
    built = PLATFORMS / "build" / platform.target / "release" / platform.library
    copy = PLATFORMS / platform.name / platform.library
    copy.parent.mkdir(parents=True, exist_ok=True)
    (copy.parent / PASSED).unlink(missing_ok=True)
    shutil.copy2(built, copy)
    write_origin(copy, chain.compiler, platform.linker)
    return copy


def compile_command(platform, chain):
    """Compile the command line of a platform; return a copy that no other build writes to."""
    chain.call(chain.build, *COMMAND)
    built = PLATFORMS / "build" / platform.target / "release" / platform.command
    copy = PLATFORMS / platform.name / platform.command
    (copy.parent / COMMAND_PASSED).unlink(missing_ok=True)
    shutil.copy2(built, copy)
    return copy


def native_host():
    """Compile the host for this machine, by zig."""
    host = PLATFORMS / "host"
    PLATFORMS.mkdir(parents=True, exist_ok=True)
    subprocess.run([*toolchains.zig("x86_64-linux-gnu.2.17", *WARNINGS), HOST, "-o", host, "-ldl"], check=True)
    return [host]


def windows_host(folder, allowed):
    """Compile the host for Windows; return the command that runs it, and its environment."""
    command, environment = toolchains.wine(allowed)
    host = folder / "host.exe"
    subprocess.run([toolchains.MINGW, *WARNINGS, HOST, "-o", host], check=True)
    shim = folder / "bcryptprimitives.dll"
    shim.unlink(missing_ok=True)
    if toolchains.wine_lacks(shim.name, environment):
        print(f"wine lacks {shim.name}: the test has one of its own", flush=True)
        subprocess.run([toolchains.MINGW, *WARNINGS, "-shared", SHIM, "-ladvapi32", "-o", shim], check=True)
    return [*command, host], environment


def aarch64_host(folder, allowed):
    """Compile the host for aarch64; return the command that runs it, and its environment."""
    command = toolchains.qemu(allowed)
    host = folder / "host"
    subprocess.run([*toolchains.zig("aarch64-linux-gnu.2.17", *WARNINGS), HOST, "-o", host, "-ldl"], check=True)
    return [*command, host], None


BUILDS = ((WIN64, toolchains.windows, windows_host), (AARCH64, toolchains.aarch64, aarch64_host))


class Reference:
    """What linux64 prints, and what round-off makes of it: run once, where it is first asked for."""

    def __init__(self, library):
        """Take the library of linux64."""
        self.library = library
        self.printed = None

    def compare(self, printed):
        """Return `compared` of what another platform has printed."""
        if self.printed is None:
            host, folder = native_host(), PLATFORMS
            self.printed = manoeuvre.drive(host, self.library, folder)
            self.round_off = manoeuvre.of_round_off(host, self.library, folder, self.printed)
        return manoeuvre.compared(self.printed, printed, self.round_off)


def build(platform, toolchain, report, given):
    """Build a platform's library."""
    started = time.monotonic()
    say(platform.name)
    try:
        chain = toolchain(given.install)
        print(f"{chain.compiler}, linked by {platform.linker}", flush=True)
        library = compile_library(platform, chain)
    except MissingError as missing:
        return report.skip(platform.name, missing)
    except subprocess.CalledProcessError as error:
        return report.fail(platform.name, [f"cargo ended with status {error.returncode}"])
    print(f"{library} ({library.stat().st_size / 1e6:.1f} MB, {time.monotonic() - started:.0f} s)", flush=True)
    report.built[platform.name] = library
    return chain


def inspect(name, reference, report):
    """Look at what a library exports and needs."""
    library = report.built[name]
    if shutil.which("objdump") is None:
        return report.skip(f"{name}, its exports and imports", "no objdump: Debian's package binutils has it")
    report.fail(name, binaries.complaints(name, library, binaries.exports(reference)))
    glibc = "" if binaries.is_windows(library) else ", glibc {}.{}".format(*binaries.newest_glibc(library))
    print(f"{len(binaries.exports(library))} functions; needs {', '.join(sorted(binaries.needs(library)))}{glibc}")


def run(name, host, reference, report, given):
    """Drive a library by the host and compare with linux64."""
    started, library = time.monotonic(), report.built[name]
    try:
        command, environment = host(library.parent, given.install)
        # Under a host whose floating-point exceptions raise signals.
        printed = manoeuvre.drive(command, library, library.parent, unmask=True, environment=environment)
    except MissingError as missing:
        return report.skip(f"{name} was built but not run", missing)
    except (RuntimeError, subprocess.SubprocessError) as error:
        return report.fail(name, [str(error)])
    lines, wrong = reference.compare(printed)
    print("\n".join(lines), f"run in {time.monotonic() - started:.0f} s", sep="\n", flush=True)
    report.fail(name, wrong)


def command_line(platform, chain, host, report, given):
    """Build the command line of a platform for its wheel, and run it: it has to print what that of linux64 does."""
    started, name = time.monotonic(), f"{platform.name}, command line"
    say(name)
    try:
        command = compile_command(platform, chain)
        run, environment = host(command.parent, given.install)
    except MissingError as missing:
        return report.skip(name, missing)
    except subprocess.CalledProcessError as error:
        return report.fail(name, [f"cargo ended with status {error.returncode}"])
    surplus = binaries.needs(command) - binaries.NEEDED[platform.name] - binaries.COMMAND_NEEDED[platform.name]
    wrong = [f"needs {sorted(surplus)}"] if surplus else []
    # What runs the host runs any program.
    run = [*run[:-1], command]
    for options in COMMAND_TRIED:
        own = subprocess.run([*run, *options], capture_output=True, text=True, env=environment)
        other = subprocess.run([TARGET / "release" / "wheelrail", *options], capture_output=True, text=True)
        called = f"`wheelrail {' '.join(options)}`"
        if own.returncode != 0:
            wrong.append(f"{called} ended with status {own.returncode}: {own.stderr}")
        elif own.stdout.splitlines() != other.stdout.splitlines():
            wrong.append(f"{called} prints other lines than on linux64")
        print(called, flush=True)
    report.fail(name, wrong)
    size = command.stat().st_size / 1e6
    print(f"{command} ({size:.1f} MB), built and run in {time.monotonic() - started:.0f} s", flush=True)
    if not wrong:
        (command.parent / COMMAND_PASSED).write_text(digest_of_sources(with_command=True))


def copy_sources(folder):
    """Copy what git knows, or would, to another folder."""
    command = ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"]
    for name in filter(None, subprocess.check_output(command, cwd=REPOSITORY, text=True).split("\0")):
        if (REPOSITORY / name).exists():
            copy = folder / name
            copy.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(REPOSITORY / name, copy)


def compare_elsewhere(reference, report):
    """Build all libraries again in another folder, with another folder for cargo, and compare the bytes."""
    say("The same in another folder")
    with tempfile.TemporaryDirectory(prefix="wheelrail-elsewhere-") as folder:
        sources, home = Path(folder) / "sources", Path(folder) / "home-of-cargo"
        copy_sources(sources)
        home.mkdir()
        # What cargo has downloaded is the same; where it lies differs.
        own = Path(os.environ.get("CARGO_HOME", Path.home() / ".cargo"))
        for name in ("registry", "config.toml"):
            if (own / name).exists():
                (home / name).symlink_to(own / name)
        target = sources / "target"
        environment = os.environ | {"CARGO_HOME": str(home), "CARGO_TARGET_DIR": str(target)}
        for command in (["cargo.py", "library"], ["platforms.py", "--build-only"]):
            script = sources / "tools" / command[0]
            subprocess.run([sys.executable, script, *command[1:]], env=environment, check=True)
        second = {"linux64": target / "library" / reference.name}
        second |= {name: target / "platforms" / name / path.name for name, path in report.built.items()}
        for name, path in second.items():
            digests = [hashlib.sha256(p.read_bytes()).hexdigest() for p in (report.built.get(name, reference), path)]
            print(f"{name}: SHA-256 {digests[0]}, in the other folder {digests[1]}", flush=True)
            if digests[0] != digests[1]:
                report.fail(name, ["other bytes in another folder"])


def abi_tests(report, given):
    """Run the tests of the exported functions with wine as cargo's runner."""
    say("win64: cargo test --test fmi")
    try:
        chain = toolchains.windows(given.install)
        command, environment = toolchains.wine(given.install)
    except MissingError as missing:
        return report.skip("the tests of the exported functions on win64", missing)
    chain.environment |= environment
    chain.environment["CARGO_TARGET_X86_64_PC_WINDOWS_GNU_RUNNER"] = " ".join(command)
    try:
        chain.call("test", "--locked", "--release", "--test", "fmi")
    except subprocess.CalledProcessError as error:
        report.fail("win64, tests of the exported functions", [f"cargo ended with status {error.returncode}"])


def main():
    """Build, run, and say what was left out."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--no-install", dest="install", action="store_false", help="install no packages of Debian")
    parser.add_argument("--build-only", action="store_true", help="neither run nor pack what was built")
    parser.add_argument("--twice", action="store_true", help="build in a second folder too; compare the bytes")
    parser.add_argument("--abi-tests", action="store_true", help="run `cargo test --test fmi` under wine as well")
    parser.add_argument("--binaries", choices=NAMES, help="print `wheelrail pack`'s options for what was built before")
    parser.add_argument("--require", action="store_true", help="what is skipped is an error")
    parser.add_argument(
        "--command", choices=[WIN64.name], help="print the path of the command line that was built before"
    )
    given = parser.parse_args()
    if given.command:
        return print_command(given.command)
    if given.binaries:
        return print_binaries(given.binaries)
    started, report = time.monotonic(), Report()
    library = None if given.build_only else reference_library()
    reference = Reference(library)
    sources = digest_of_sources()
    for platform, toolchain, host in BUILDS:
        chain = build(platform, toolchain, report, given)
        if platform.name in report.built and not given.build_only:
            inspect(platform.name, library, report)
            run(platform.name, host, reference, report, given)
            if not any(line.startswith(platform.name) for line in report.wrong):
                (PLATFORMS / platform.name / PASSED).write_text(sources)
                if platform.command:
                    command_line(platform, chain, host, report, given)
    if given.abi_tests:
        abi_tests(report, given)
    if given.twice:
        compare_elsewhere(library, report)
    say(f"Platforms: {time.monotonic() - started:.0f} s")
    for line in (
        *(f"built    {name}: {path}" for name, path in report.built.items()),
        *(f"skipped  {line}" for line in report.skipped),
        *(f"wrong    {line}" for line in report.wrong),
    ):
        print(line)
    sys.exit(1 if report.wrong or (given.require and report.skipped) else 0)


if __name__ == "__main__":
    main()
