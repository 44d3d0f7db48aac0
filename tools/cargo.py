"""Build the FMU's shared library and say where it lies, in target/library.path.

On x86-64 Linux the library is linked by zig against the symbols of an old glibc, so that it loads on every
distribution of the last ten years. Where that is not possible it is built for this machine alone, with a warning.
"""

import argparse
import importlib.util
import os
import platform
import shutil
import subprocess
import sys
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parent.parent
TARGET = Path(os.environ.get("CARGO_TARGET_DIR", REPOSITORY / "target"))
OPTIONS = ["--release", "--lib", "--no-default-features", "--features", "fmi"]


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


def library_name():
    """What cargo calls the library on this platform."""
    return {"win32": "wheelrail.dll", "darwin": "libwheelrail.dylib"}.get(sys.platform, "libwheelrail.so")


def main():
    """Build the library one way or the other."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--target", default="x86_64-unknown-linux-gnu", help="the portable build's target")
    parser.add_argument("--glibc", default="2.17", help="the oldest glibc that it should load on")
    parser.add_argument("--native", action="store_true", help="for this machine alone")
    arguments = parser.parse_args()

    # cargo finds cargo-zigbuild, and cargo-zigbuild finds zig, in this Python's environment.
    os.environ["PATH"] = os.pathsep.join([str(Path(sys.executable).parent), os.environ["PATH"]])
    reason = "--native was given" if arguments.native else why_not_portable(arguments.target)
    folder = TARGET / "release"
    if reason is None:
        command = ["cargo", "zigbuild", *OPTIONS, "--target", f"{arguments.target}.{arguments.glibc}"]
        if subprocess.run(command, cwd=REPOSITORY).returncode == 0:
            folder = TARGET / arguments.target / "release"
        else:
            reason = "cargo zigbuild failed, see above"
    if reason is not None:
        print(f"WARNING: not the portable build: {reason}.", file=sys.stderr)
        print("WARNING: this library loads only where the C library is as new as here.", file=sys.stderr)
        subprocess.run(["cargo", "build", *OPTIONS], cwd=REPOSITORY, check=True)
    library = folder / library_name()
    (TARGET / "library.path").write_text(f"{library}\n")
    (TARGET / "library.portable").write_text(f"{reason is None}\n")
    print(f"{library} ({library.stat().st_size / 1e6:.1f} MB)")


if __name__ == "__main__":
    main()
