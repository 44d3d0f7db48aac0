"""Call cargo so that the library of the FMU, the command line and the tests share everything that is compiled.

    tools/cargo.py library              the shared library and the command line; with --tests the tests beside them
    tools/cargo.py test --no-fail-fast  any other command of cargo, with its options

On x86-64 Linux all is linked by zig against the symbols of an old glibc, so that the library loads on every
distribution of the last ten years. Where that is not possible it is built for this machine alone, with a warning.
`library` says where the library lies, in target/library.path, and puts the command line into target/release. The
same compiler gives the same bytes in any folder; what compiled it is written beside the library for `wheelrail pack`.
"""

import argparse
import importlib.metadata
import importlib.util
import os
import platform
import re
import shutil
import subprocess
import sys
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parent.parent
TARGET = Path(os.environ.get("CARGO_TARGET_DIR", REPOSITORY / "target"))
# Commands that cargo-zigbuild has under other names than cargo.
ZIG = {"build": "zigbuild"}


def why_not_portable(target):
    """What stands in the way of the portable build, or None."""
    if sys.platform != "linux" or platform.machine() != "x86_64":
        return f"this is {platform.system()} on {platform.machine()}, not Linux on x86_64"
    if importlib.util.find_spec("ziglang") is None:
        return "the Python package ziglang is not installed"
    if shutil.which("cargo-zigbuild") is None:
        return "the Python package cargo-zigbuild is not installed"
    sysroot = subprocess.check_output(["rustc", "--print", "sysroot"], text=True).strip()
    if not (Path(sysroot) / "lib" / "rustlib" / target / "lib").is_dir():
        return f"rustc has no standard library for {target} (rustup target add {target})"
    return None


def file_names():
    """What cargo calls the library and the command on this platform."""
    library = {"win32": "wheelrail.dll", "darwin": "libwheelrail.dylib"}.get(sys.platform, "libwheelrail.so")
    return library, "wheelrail.exe" if sys.platform == "win32" else "wheelrail"


def said(*command):
    """Return what a command prints."""
    return subprocess.check_output([str(word) for word in command], text=True).strip()


def without_folders(rustc="rustc"):
    """Return the flags for rustc that leave this machine's folders out of what it compiles."""
    home = Path(os.environ.get("CARGO_HOME", Path.home() / ".cargo"))
    sources = Path(said(rustc, "--print", "sysroot")) / "lib" / "rustlib" / "src" / "rust"
    commit = re.search(r"commit-hash: (\w+)", said(rustc, "-vV"))[1]
    # The standard library's own name for its sources, which rustc replaces where it finds them installed.
    virtual = f"/rustc/{commit}"
    # A later one comes first.
    names = {REPOSITORY: "/wheelrail", home: "/cargo", sources.resolve(): virtual, sources: virtual}
    return [f"--remap-path-prefix={folder}={name}" for folder, name in names.items()]


def add_flags(environment, flags):
    """Add flags for rustc to those that an environment has."""
    encoded = environment.get("CARGO_ENCODED_RUSTFLAGS", "").split("\x1f")
    given = encoded if encoded != [""] else environment.get("RUSTFLAGS", "").split()
    environment["CARGO_ENCODED_RUSTFLAGS"] = "\x1f".join([*given, *flags])


def write_origin(library, compiler, linker):
    """Write beside a library what `wheelrail pack` puts into documentation/build.txt."""
    Path(f"{library}.build.txt").write_text(f"{compiler}; linked by {linker}\n")


def call(command, options, portable, target, glibc):
    """Return cargo's exit status."""
    if portable:
        add_flags(os.environ, without_folders())
    flags = ["--release", "--locked", *(["--target", f"{target}.{glibc}"] if portable else [])]
    line = ["cargo-zigbuild", ZIG.get(command, command)] if portable else ["cargo", command]
    return subprocess.run([*line, *flags, *options], cwd=REPOSITORY).returncode


def library(options, portable, target, glibc):
    """Build the library and the command line, and what the options add; return cargo's exit status."""
    code = call("build", ["--lib", "--bin", "wheelrail", *options], portable, target, glibc)
    if code == 0:
        folder = TARGET / target / "release" if portable else TARGET / "release"
        # Copies that no other build writes to; replaced, not written into: they may be in use.
        built, command = TARGET / "library" / file_names()[0], TARGET / "release" / file_names()[1]
        for copy in (built, command):
            copy.parent.mkdir(parents=True, exist_ok=True)
            part = copy.with_suffix(".part")
            shutil.copy2(folder / copy.name, part)
            part.replace(copy)
        zig = f"zig {importlib.metadata.version('ziglang')} for glibc {glibc}" if portable else "this machine's linker"
        write_origin(built, said("rustc", "--version"), zig)
        (TARGET / "library.path").write_text(f"{built}\n")
        (TARGET / "library.portable").write_text(f"{portable}\n")
        print(f"{built} ({built.stat().st_size / 1e6:.1f} MB)")
    return code


def main():
    """Choose the linker, call cargo."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--target", default="x86_64-unknown-linux-gnu", help="the portable build's target")
    parser.add_argument("--glibc", default="2.17", help="the oldest glibc that it should load on")
    parser.add_argument("--native", action="store_true", help="for this machine alone")
    parser.add_argument("command", help="`library`, or a command of cargo")
    parser.add_argument("options", nargs=argparse.REMAINDER, help="of cargo")
    given = parser.parse_args()

    # cargo finds cargo-zigbuild, and cargo-zigbuild finds zig, in this Python's environment.
    os.environ["PATH"] = os.pathsep.join([str(Path(sys.executable).parent), os.environ["PATH"]])
    # cargo would look for make's jobserver, whose files Python does not hand on.
    for name in ("MAKEFLAGS", "MFLAGS", "CARGO_MAKEFLAGS"):
        os.environ.pop(name, None)
    reason = "--native was given" if given.native else why_not_portable(given.target)
    if reason is not None and given.command == "library":
        print(f"WARNING: not the portable build: {reason}.", file=sys.stderr)
        print("WARNING: this library loads only where the C library is as new as here.", file=sys.stderr)
    where = (reason is None, given.target, given.glibc)
    code = library(given.options, *where) if given.command == "library" else call(given.command, given.options, *where)
    sys.exit(code)


if __name__ == "__main__":
    main()
