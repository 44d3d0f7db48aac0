"""What `make platforms` says and does where something is missing, and how it compares two platforms."""

import math
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest

REPOSITORY = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(REPOSITORY / "tools"))

import manoeuvre  # noqa: E402
import platforms  # noqa: E402
import toolchains  # noqa: E402


def test_missing_packages_are_named(monkeypatch):
    """One who is not root reads which packages are missing; nothing is installed."""
    monkeypatch.setattr(toolchains, "version_of", lambda package: None)
    monkeypatch.setattr(toolchains.os, "geteuid", lambda: 1000)
    monkeypatch.setattr(toolchains.shutil, "which", lambda *_, **__: "/usr/bin/apt-get")
    monkeypatch.setattr(toolchains.subprocess, "run", lambda *_, **__: pytest.fail("something was run"))
    with pytest.raises(toolchains.MissingError, match=r"apt-get install .* rustc-web cargo-web rust-web-src"):
        toolchains.install("rustc-web", "cargo-web", "rust-web-src")
    monkeypatch.setattr(toolchains.shutil, "which", lambda *_, **__: None)
    with pytest.raises(toolchains.MissingError, match="not Debian"):
        toolchains.install("wine64")


def test_what_is_missing_is_skipped():
    """A platform without a compiler is no failure, unless `--require` asks for all."""

    def toolchain(allowed):
        raise toolchains.MissingError("no compiler")

    report = platforms.Report()
    platforms.build(toolchains.WIN64, toolchain, report, SimpleNamespace(install=False))
    assert report.skipped == ["win64: no compiler"]
    assert not report.wrong
    assert not report.built


def test_only_what_passed_with_these_sources_is_packed(monkeypatch, tmp_path, capsys):
    """A library of other sources, or one that was wrong, does not get into an archive."""
    monkeypatch.setattr(platforms, "PLATFORMS", tmp_path)
    mark = tmp_path / "win64" / platforms.PASSED
    mark.parent.mkdir()
    for content, printed in ((None, False), ("other sources", False), (platforms.digest_of_sources(), True)):
        if content:
            mark.write_text(content)
        platforms.print_binaries("fmi2")
        assert ("--binary=win64=" in capsys.readouterr().out) == printed


def test_the_manoeuvre_is_compared_series_by_series():
    """Round-off passes, a defect, a value that is not finite and one that should be 0 do not."""
    force, slope = "traction_force", "traction_force by normal_load"
    series = {"line": {force: [1.0, -100.0], slope: [2.0, 4.0], "lateral_force": [0.0, 0.0]}}
    round_off = {("line", force): 1e-16, ("line", slope): 1e-9, ("line", "lateral_force"): 0.0}

    def wrong(changed):
        lines, wrong = manoeuvre.compared(series, {"line": series["line"] | changed}, round_off)
        # Of outputs and of derivatives, of the forces, and the largest ratio.
        assert len(lines) == 4
        return [line.split(" differs")[0] for line in wrong]

    assert wrong({}) == []
    assert wrong({force: [1.0, -100.0 * (1 + 5e-13)], slope: [2.0, 4.0 * (1 + 9e-8)]}) == []
    assert wrong({force: [1.0 + 1e-9, -100.0]}) == [f"line: {force}"]
    assert wrong({slope: [2.0, 4.0 * (1 + 2e-7)]}) == [f"line: {slope}"]
    assert wrong({force: [math.nan, -100.0]}) == [f"line: {force}"]
    assert wrong({"lateral_force": [0.0, 1e-300]}) == ["line: lateral_force"]
