"""Compilers and emulators for the platforms beside linux64: those of this machine, else Debian's packages.

Where the installed Rust has a target's standard library (`rustup target add TARGET`), it compiles. Otherwise it is
Debian's Rust for web browsers, which is new enough: for Windows it compiles the standard library itself, for aarch64
Debian has it compiled. Packages are installed where apt-get is and one is root; nobody else's toolchain is.
"""

import os
import re
import shutil
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

from cargo import REPOSITORY, TARGET, add_flags, said, without_folders

# All that is compiled, downloaded and unpacked for other platforms.
PLATFORMS = TARGET / "platforms"
DEBIAN_RUST = ("rustc-web", "cargo-web")
DEBIAN_BIN = Path("/usr/bin")
MINGW = "x86_64-w64-mingw32-gcc"
QEMU = "qemu-aarch64-static"


class MissingError(Exception):
    """What is missing for a platform, and how to get it."""


@dataclass(frozen=True)
class Platform:
    """A platform that the component is built for."""

    name: str
    target: str  # rustc's
    library: str  # cargo's name of the shared library
    linker: str  # in words
    command: str = ""  # cargo's name of the command line, where a wheel takes it along


WIN64 = Platform("win64", "x86_64-pc-windows-gnu", "wheelrail.dll", "MinGW", "wheelrail.exe")
AARCH64 = Platform("aarch64-linux", "aarch64-unknown-linux-gnu", "libwheelrail.so", "zig for glibc 2.17")


@dataclass
class Toolchain:
    """How cargo is called for a platform."""

    program: str  # cargo, or what stands for it
    build: str  # its name of cargo's command `build`
    options: list  # of any command
    environment: dict
    compiler: str  # in words

    def call(self, command, *options):
        """Run a command of cargo; raise CalledProcessError where it fails."""
        environment = self.environment | {"CARGO_TARGET_DIR": str(PLATFORMS / "build")}
        subprocess.run([self.program, command, *self.options, *options], cwd=REPOSITORY, env=environment, check=True)


# ---- Debian's packages ----------------------------------------------------------------------------------------------


def version_of(package):
    """Return the version of an installed package of Debian, or None."""
    if shutil.which("dpkg-query") is None:
        return None
    command = ["dpkg-query", "-W", "-f", "${db:Status-Abbrev}${Version}", package]
    answer = subprocess.run(command, capture_output=True, text=True).stdout
    return answer[3:] if answer.startswith("ii ") else None


def install(*packages, allowed=True):
    """Install packages of Debian that are not there; raise MissingError where that may not be."""
    missing = [package for package in packages if version_of(package) is None]
    if not missing:
        return
    advice = "apt-get install --no-install-recommends " + " ".join(missing)
    if shutil.which("apt-get") is None:
        raise MissingError(f"this is not Debian, whose packages would be {' '.join(missing)}")
    if os.geteuid() != 0 or not allowed:
        raise MissingError(f"packages are missing: {advice}")
    print(f"{advice} ...", flush=True)
    # The lists of packages may be missing or old.
    quiet("apt-get", "update")
    environment = os.environ | {"DEBIAN_FRONTEND": "noninteractive"}
    command = ["apt-get", "install", "--yes", "--no-install-recommends", *missing]
    done = subprocess.run(command, capture_output=True, text=True, env=environment)
    if done.returncode != 0:
        raise MissingError(f"`{advice}` failed: {(done.stderr or done.stdout).strip().splitlines()[-1]}")


def quiet(*command, **options):
    """Run a command without its output; return whether it succeeded."""
    return subprocess.run([str(word) for word in command], capture_output=True, **options).returncode == 0


def unpacked(name, architecture, *packages):
    """Return a folder with packages of another architecture, NAME or NAME=VERSION; nothing is installed.

    The lists of packages are kept in a folder of their own, so that the system's stay those of this machine.
    """
    folder = PLATFORMS / name
    stamp = folder / "ready"
    wanted = " ".join(packages)
    if stamp.exists() and stamp.read_text() == wanted:
        return folder / "root"
    if shutil.which("apt-get") is None or shutil.which("dpkg-deb") is None:
        raise MissingError(f"this is not Debian, whose packages for {architecture} would be {wanted}")
    shutil.rmtree(folder, ignore_errors=True)
    for part in ("lists/partial", "archives/partial"):
        (folder / part).mkdir(parents=True)
    options = [
        f"-oAPT::Architectures::={architecture}",
        "-oAPT::Sandbox::User=",
        f"-oDir::State::Lists={folder / 'lists'}",
        f"-oDir::Cache={folder}",
    ]
    names = [re.sub(r"(=|$)", rf":{architecture}\1", package, count=1) for package in packages]
    print(f"apt-get download {' '.join(names)} ...", flush=True)
    quiet("apt-get", *options, "update")
    if not quiet("apt-get", *options, "download", *names, cwd=folder):
        raise MissingError(f"`apt-get download {' '.join(names)}` failed")
    for package in folder.glob("*.deb"):
        subprocess.run(["dpkg-deb", "-x", package, folder / "root"], check=True)
        package.unlink()
    shutil.rmtree(folder / "lists")
    stamp.write_text(wanted)
    return folder / "root"


# ---- compilers ------------------------------------------------------------------------------------------------------


def has_standard_library(target):
    """Whether the installed Rust has a target's standard library."""
    try:
        return Path(said("rustc", "--print", "target-libdir", "--target", target)).is_dir()
    except (OSError, subprocess.CalledProcessError):
        return False


def environment_of(folder=None):
    """Return this environment without flags of others, with the tools of a folder before the rest of PATH."""
    environment = dict(os.environ)
    for name in ("MAKEFLAGS", "MFLAGS", "CARGO_MAKEFLAGS", "RUSTFLAGS", "CARGO_ENCODED_RUSTFLAGS", "CARGO_TARGET_DIR"):
        environment.pop(name, None)
    # cargo-zigbuild, and the Python that has zig, come first.
    folders = [Path(sys.executable).parent, *([folder] if folder else [])]
    environment["PATH"] = os.pathsep.join([*map(str, folders), environment["PATH"]])
    if folder:
        environment |= {"RUSTC": str(folder / "rustc"), "CARGO": str(folder / "cargo")}
    return environment


def debian_rust(allowed, *packages):
    """Return rustc and version of Debian's Rust for web browsers, installed with further packages of it."""
    install(*DEBIAN_RUST, *packages, allowed=allowed)
    versions = {package: version_of(package) for package in (*DEBIAN_RUST, *packages)}
    if len(set(versions.values())) != 1:
        raise MissingError(f"the versions of {versions} are not the same: apt-get install --only-upgrade them")
    rustc = DEBIAN_BIN / "rustc"
    needed = re.search(r'rust-version = "(\d+)\.(\d+)"', (REPOSITORY / "Cargo.toml").read_text())
    found = re.search(r"rustc (\d+)\.(\d+)", said(rustc, "--version"))
    if tuple(map(int, found.groups())) < tuple(map(int, needed.groups())):
        raise MissingError(f"Debian's {found[0]} is older than {needed[1]}.{needed[2]}: add bookworm-security or newer")
    return rustc, versions[DEBIAN_RUST[0]]


def windows(allowed):
    """Return the toolchain for win64."""
    if shutil.which(MINGW) is None:
        install("gcc-mingw-w64-x86-64-win32", allowed=allowed)
    options = ["--target", WIN64.target]
    # The linker would write the time of day.
    flags = ["-Clink-arg=-Wl,--no-insert-timestamp"]
    if has_standard_library(WIN64.target):
        rustc, environment = "rustc", environment_of()
    else:
        rustc, _ = debian_rust(allowed, "rust-web-src")
        environment = environment_of(DEBIAN_BIN)
        # What builds the standard library is an option of nightly compilers.
        environment["RUSTC_BOOTSTRAP"] = "1"
        options += ["-Zbuild-std=std,panic_unwind"]
    environment["CARGO_TARGET_X86_64_PC_WINDOWS_GNU_LINKER"] = MINGW
    add_flags(environment, [*flags, *without_folders(rustc)])
    return Toolchain(environment.get("CARGO", "cargo"), "build", options, environment, said(rustc, "--version"))


def aarch64(allowed):
    """Return the toolchain for aarch64-linux: zig links, as on linux64."""
    if shutil.which("cargo-zigbuild", path=environment_of()["PATH"]) is None:
        raise MissingError("the Python packages cargo-zigbuild and ziglang are not installed")
    if has_standard_library(AARCH64.target):
        rustc, environment, flags = "rustc", environment_of(), []
    else:
        rustc, version = debian_rust(allowed)
        environment = environment_of(DEBIAN_BIN)
        standard = unpacked("aarch64-standard-library", "arm64", f"libstd-rust-web-dev={version}")
        flags = [f"--sysroot={sysroot_with(AARCH64.target, standard, rustc)}"]
    add_flags(environment, [*flags, *without_folders(rustc)])
    options = ["--target", f"{AARCH64.target}.2.17"]
    return Toolchain("cargo-zigbuild", "zigbuild", options, environment, said(rustc, "--version"))


def sysroot_with(target, debian, rustc):
    """Return a folder for rustc that has a target's standard library beside that of this machine."""
    folder = PLATFORMS / "sysroot" / "lib" / "rustlib"
    folder.mkdir(parents=True, exist_ok=True)
    host = re.search(r"host: (\S+)", said(rustc, "-vV"))[1]
    own = Path(said(rustc, "--print", "sysroot")) / "lib" / "rustlib" / host
    for name, place in ((host, own), (target, debian / "usr" / "lib" / "rustlib" / target)):
        link = folder / name
        link.unlink(missing_ok=True)
        link.symlink_to(place)
    return folder.parent.parent


def zig(target, *options):
    """Return the command of zig's C compiler for a target."""
    return [sys.executable, "-m", "ziglang", "cc", "-target", target, *options]


# ---- emulators ------------------------------------------------------------------------------------------------------


def wine(allowed):
    """Return the command that runs a program of Windows, and its environment."""
    # Debian's wine64 is not on the path.
    path = os.pathsep.join([os.environ["PATH"], "/usr/lib/wine"])
    if shutil.which("wine64", path=path) is None and shutil.which("wine") is None:
        install("wine64", allowed=allowed)
    program = shutil.which("wine64", path=path) or shutil.which("wine")
    prefix = PLATFORMS / "wine"
    # Neither messages of its own nor windows that offer to install more.
    environment = os.environ | {"WINEPREFIX": str(prefix), "WINEDEBUG": "-all", "WINEDLLOVERRIDES": "mscoree,mshtml="}
    environment.pop("DISPLAY", None)
    if not (prefix / "system.reg").exists():
        prefix.mkdir(parents=True, exist_ok=True)
        quiet(program, "wineboot", "--init", env=environment, timeout=300)
    return [program], environment


def wine_lacks(dll, environment):
    """Whether wine has no such DLL."""
    return not (Path(environment["WINEPREFIX"]) / "drive_c" / "windows" / "system32" / dll).exists()


def qemu(allowed):
    """Return the command that runs a program of aarch64 Linux."""
    if shutil.which(QEMU) is None:
        install("qemu-user-static", allowed=allowed)
    return [QEMU, "-L", unpacked("aarch64-c-library", "arm64", "libc6")]
