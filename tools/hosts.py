"""Prepare the simulation hosts that need more than a pinned package in .venv.

- ecos links libtbb.so.12. Where the system has none, Debian's package is unpacked into .venv/tbb, nothing is installed.
- CoFmuPy pins an older FMPy: it gets .venv-cofmupy.

What cannot be had is said and left out: python_tests/test_hosts.py skips that host with the same reason.
"""

import ctypes
import os
import shutil
import subprocess
import sys
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parent.parent
TBB = REPOSITORY / ".venv" / "tbb"
COFMUPY = REPOSITORY / ".venv-cofmupy"
# CoFmuPy asks for 78 packages, web servers and plotting included. Those that its co-simulation imports:
COFMUPY_REQUIREMENTS = REPOSITORY / "requirements-cofmupy.txt"


def run(*command, **options):
    """Run a command quietly; whether it succeeded."""
    return subprocess.run(command, capture_output=True, text=True, **options).returncode == 0


def tbb():
    """Make libtbb.so.12 available."""
    try:
        ctypes.CDLL("libtbb.so.12")
        return "libtbb.so.12 is on the system"
    except OSError:
        pass
    if list(TBB.rglob("libtbb.so.12")):
        return f"libtbb.so.12 is in {TBB}"
    if shutil.which("apt-get") is None or shutil.which("dpkg-deb") is None:
        return "no libtbb.so.12, and this is not Debian: the ecos test will be skipped"
    TBB.mkdir(parents=True, exist_ok=True)
    packages = ["libtbb12", "libtbbmalloc2"]
    if not run("apt-get", "download", *packages, cwd=TBB):
        # The lists of packages may be missing; only root can fetch them.
        if os.geteuid() == 0:
            run("apt-get", "update")
        run("apt-get", "download", *packages, cwd=TBB)
    for package in TBB.glob("*.deb"):
        run("dpkg-deb", "-x", str(package), str(TBB))
    if list(TBB.rglob("libtbb.so.12")):
        return f"libtbb.so.12 is in {TBB}"
    shutil.rmtree(TBB)
    return "libtbb12 cannot be downloaded with apt-get: the ecos test will be skipped"


def cofmupy():
    """Make CoFmuPy's environment."""
    ready = COFMUPY / "ready"
    if ready.exists() and ready.stat().st_mtime >= COFMUPY_REQUIREMENTS.stat().st_mtime:
        return f"CoFmuPy is in {COFMUPY}"
    python = COFMUPY / "bin" / "python"
    # It needs no installer of its own; uv takes a fifth of pip's time.
    made = run(sys.executable, "-m", "venv", "--without-pip", COFMUPY)
    options = ["--quiet", "--no-deps", "-r", COFMUPY_REQUIREMENTS]
    done = made and (
        run(sys.executable, "-m", "uv", "pip", "install", "--python", python, *options)
        or run(sys.executable, "-m", "pip", "--python", python, "install", *options)
    )
    if not done or not run(python, "-c", "import cofmupy"):
        shutil.rmtree(COFMUPY, ignore_errors=True)
        return "CoFmuPy cannot be installed: its test will be skipped"
    ready.touch()
    return f"CoFmuPy is in {COFMUPY}"


if __name__ == "__main__":
    print(tbb())
    print(cofmupy())
