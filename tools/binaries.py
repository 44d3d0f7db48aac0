"""What a shared library exports and what it needs, as binutils read it, for ELF and for Windows."""

import re
import subprocess
from pathlib import Path

# glibc 2.17 keeps dl, pthread and rt in libraries of their own.
C_LIBRARY = {"libc.so.6", "libm.so.6", "libgcc_s.so.1", "libdl.so.2", "libpthread.so.0", "librt.so.1"}
NEEDED = {
    "linux64": C_LIBRARY | {"ld-linux-x86-64.so.2"},
    "aarch64-linux": C_LIBRARY | {"ld-linux-aarch64.so.1"},
    # Those of Windows itself; file names there know no case.
    "win64": {
        "api-ms-win-core-synch-l1-2-0.dll",
        "bcryptprimitives.dll",
        "kernel32.dll",
        "msvcrt.dll",
        "ntdll.dll",
        "userenv.dll",
        "ws2_32.dll",
    },
}
# What a command line needs besides.
COMMAND_NEEDED = {"win64": {"advapi32.dll"}}
OLDEST_GLIBC = (2, 17)


def read(*command):
    """Return what a tool of binutils prints."""
    return subprocess.check_output([str(word) for word in command], text=True)


def is_windows(library):
    """Whether a library is one of Windows."""
    return Path(library).read_bytes()[:2] == b"MZ"


def exports(library):
    """Return the names of what a library exports."""
    if is_windows(library):
        table = read("objdump", "-p", library).split("[Ordinal/Name Pointer] Table")[1].split("\n\n")[0]
        return set(re.findall(r"^\s*\[\s*\d+\].*?(\S+)$", table, re.MULTILINE))
    return {line.split()[-1].split("@")[0] for line in read("nm", "-D", "--defined-only", library).splitlines()}


def needs(library):
    """Return the names of the libraries that a library asks for; those of Windows in lower case."""
    if is_windows(library):
        return {name.lower() for name in re.findall(r"DLL Name: (\S+)", read("objdump", "-p", library))}
    return set(re.findall(r"\(NEEDED\).*\[(.+)\]", read("readelf", "-d", library)))


def newest_glibc(library):
    """Return the newest version of glibc that a library asks for, of the form (2, 17)."""
    versions = re.findall(r"GLIBC_(\d+)\.(\d+)", read("objdump", "-T", library))
    return max(((int(major), int(minor)) for major, minor in versions), default=(0, 0))


def complaints(platform, library, expected):
    """Return what is wrong with a library that should export what is expected."""
    exported, needed = exports(library), needs(library)
    wrong = []
    if exported != expected:
        wrong.append(f"exports: {sorted(expected - exported)} missing, {sorted(exported - expected)} beyond linux64's")
    if needed - NEEDED[platform]:
        wrong.append(f"needs {sorted(needed - NEEDED[platform])}")
    if not is_windows(library) and newest_glibc(library) > OLDEST_GLIBC:
        wrong.append(f"needs glibc {newest_glibc(library)}, newer than {OLDEST_GLIBC}")
    return wrong
