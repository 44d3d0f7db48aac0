"""The Python package: its wheel where there is pip alone, and its functions against the native simulation."""

import json
import os
import re
import shutil
import subprocess
import sys
import sysconfig
import tomllib
import zipfile
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

REPOSITORY = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(REPOSITORY / "python"))

sys.path.insert(0, str(REPOSITORY / "tools"))

import binaries  # noqa: E402
import wheelrail  # noqa: E402

TABLE = {"time": [0.0, 0.5], "creepage": [0.0, 0.02], "normal_load": [60e3, 80e3]}
CHOSEN = {"wheel_speed": 40.0, "friction_law": "piecewise_linear", "friction_hot": 0.2}
THIRD = REPOSITORY / "target" / "WheelRailContact-fmi3.fmu"
# What a wheel with the command line is for: what loads with glibc 2.17, of 2014, or this machine.
PORTABLE = REPOSITORY / "target" / "library.portable"
OLD_GLIBC = PORTABLE.exists() and PORTABLE.read_text().strip() == "True"
PLATFORM = "manylinux2014_x86_64" if OLD_GLIBC else re.sub(r"\W", "_", sysconfig.get_platform())
# What the environment says of itself, after what the documentation has.
ASK = """
import json
print(json.dumps({
    "package": wheelrail.__file__,
    "version": wheelrail.__version__,
    "fmu": str(wheelrail.fmu_path()),
    "rows": len(manoeuvre),
    "force": list(curves[curves.driven == "longitudinal"].traction_force),
    "friction": [float(limit) for table in (curves, spinning) for limit in table.friction_coefficient],
}))
"""


def built_wheel(folder, **environment):
    """Build a wheel as `make wheel` does; return its path."""
    build = [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", folder]
    subprocess.run(build, check=True, capture_output=True, cwd=REPOSITORY, env=os.environ | environment)
    return next(folder.glob("*.whl"))


@pytest.fixture(scope="module")
def wheel(fmu, command, tmp_path_factory):
    """Build the wheel of this platform; return its path."""
    return built_wheel(tmp_path_factory.mktemp("dist"))


@pytest.fixture(scope="module")
def command(request):
    """Return the path of the command line; its fixture has the name that the package has here."""
    return request.getfixturevalue("wheelrail")


@pytest.fixture(scope="module")
def fresh(wheel, tmp_path_factory):
    """Install the wheel into a new environment; return a function that runs a program there.

    By uv, in a fifth of pip's time; test_stranger.py installs it by pip, as README says.
    """
    folder = tmp_path_factory.mktemp("fresh")
    uv = [sys.executable, "-m", "uv"]
    subprocess.run([*uv, "venv", "--quiet", "--python", sys.executable, folder / "venv"], check=True)
    python = folder / "venv" / "bin" / "python"
    options = ["--quiet", "--python", python, "--constraint", REPOSITORY / "requirements.txt"]
    # With the one extra: the documentation shows fields over time.
    done = subprocess.run([*uv, "pip", "install", *options, f"{wheel}[fields]"], capture_output=True, text=True)
    if "Failed to fetch" in done.stderr:
        pytest.skip(f"uv reaches no index: {done.stderr.splitlines()[-1]}")
    assert done.returncode == 0, done.stderr

    def run(program):
        answer = subprocess.run([python, "-c", program], capture_output=True, text=True, cwd=folder)
        assert answer.returncode == 0, answer.stdout + answer.stderr
        return answer.stdout, folder

    return run


def blocks(path):
    """Return the blocks of Python in a document."""
    return re.findall(r"```python\n(.*?)```", path.read_text(), re.DOTALL)


def test_files_of_the_wheel(wheel, fmu):
    """Sources, the FMUs as they are built, types, licences, and the crate's version."""
    version = tomllib.loads((REPOSITORY / "Cargo.toml").read_text())["package"]["version"]
    assert wheel.name == f"wheelrail-{version}-py3-none-{PLATFORM}.whl"
    with zipfile.ZipFile(wheel) as archive:
        names = set(archive.namelist())
        sources = {path.name for path in (REPOSITORY / "python" / "wheelrail").glob("*.py")}
        assert {f"wheelrail/{name}" for name in sources | {"py.typed", "data/braking.csv"}} <= names
        for built in (REPOSITORY / "target").glob("WheelRailContact*.fmu"):
            assert archive.read(f"wheelrail/fmu/{built.name}") == built.read_bytes()
        for licence in ("LICENSE-MIT", "THIRD-PARTY.txt", "COMMAND.txt"):
            assert any(name.startswith("wheelrail-") and name.endswith(f"/{licence}") for name in names)
        # Lists of what is linked into the library and into the command.
        for bill in ("THIRD-PARTY.cdx.json", "COMMAND.cdx.json"):
            assert any(name.endswith(f".dist-info/sboms/{bill}") for name in names)


def test_command_in_the_wheel(wheel, command):
    """The command line as it was built, which needs no more than the platform's name promises."""
    with zipfile.ZipFile(wheel) as archive:
        (name,) = [name for name in archive.namelist() if ".data/scripts/" in name]
        assert name.endswith(f"/{command.name}")
        assert archive.read(name) == command.read_bytes()
        assert archive.getinfo(name).external_attr >> 16 & 0o111
        assert b"Root-Is-Purelib: false" in archive.read(name.partition(".data/")[0] + ".dist-info/WHEEL")
    if OLD_GLIBC and shutil.which("objdump"):
        # The old glibc, and no library beside it.
        assert (0, 0) < binaries.newest_glibc(command) <= binaries.OLDEST_GLIBC
        assert binaries.needs(command) <= binaries.NEEDED["linux64"]


def test_wheel_of_the_other_platforms(wheel, command, tmp_path):
    """For where there is no command line: a wheel with all of the first one, but that and what lists its parts."""
    other = built_wheel(tmp_path, WHEELRAIL_WHEEL="any")
    assert other.name == wheel.name.replace(PLATFORM, "any")
    with zipfile.ZipFile(wheel) as first, zipfile.ZipFile(other) as second:
        own = sorted(name.rpartition("/")[2] for name in set(first.namelist()) - set(second.namelist()))
        assert own == ["COMMAND.cdx.json", command.name]
        assert set(second.namelist()) < set(first.namelist())


def test_wheel_of_windows(wheel, command, tmp_path):
    """Where `make platforms` has built the command line of Windows: all of the first wheel, with that command."""
    built = REPOSITORY / "target" / "platforms" / "win64" / "wheelrail.exe"
    if not built.exists():
        pytest.skip("there is no command line of Windows: `make platforms` builds it")
    other = built_wheel(tmp_path, WHEELRAIL_WHEEL="win_amd64")
    assert other.name == wheel.name.replace(PLATFORM, "win_amd64")
    with zipfile.ZipFile(wheel) as first, zipfile.ZipFile(other) as second:
        ends = [{name.removesuffix(".exe") for name in archive.namelist()} for archive in (first, second)]
        assert ends[0] == ends[1]
        (name,) = [name for name in second.namelist() if ".data/scripts/" in name]
        assert second.read(name) == built.read_bytes()
        assert b"Tag: py3-none-win_amd64" in second.read(name.partition(".data/")[0] + ".dist-info/WHEEL")
    assert binaries.needs(built) <= binaries.NEEDED["win64"] | binaries.COMMAND_NEEDED["win64"]


def test_command_runs_where_there_is_only_pip(fresh, tmp_path):
    """It is found in the environment, and gives what the package gives, without this repository."""
    _, folder = fresh("import wheelrail")
    installed = folder / "venv" / "bin" / "wheelrail"
    version = tomllib.loads((REPOSITORY / "Cargo.toml").read_text())["package"]["version"]

    def run(*arguments):
        paths = {"PATH": str(installed.parent), "HOME": str(tmp_path)}
        done = subprocess.run(["wheelrail", *arguments], capture_output=True, text=True, cwd=tmp_path, env=paths)
        assert done.returncode == 0, done.stderr
        return done.stdout

    assert run("--version") == f"wheelrail {version}\n"
    assert "normal_load" in run("describe")
    pd.DataFrame(TABLE).to_csv(tmp_path / "table.csv", index=False)
    run("simulate", "table.csv", "-o", "out.csv", "--step", "0.01")
    native = wheelrail.read_table(tmp_path / "out.csv")
    result = wheelrail.simulate(TABLE, step=0.01, fmu=REPOSITORY / "target" / "WheelRailContact.fmu")
    assert native["traction_force"].to_numpy() == pytest.approx(result["traction_force"].to_numpy(), rel=1e-9)


@pytest.fixture(scope="module")
def documented(fresh):
    """Run the lines of docs/python.md; return what was printed, and where."""
    program = ["import matplotlib; matplotlib.use('Agg')", *blocks(REPOSITORY / "docs" / "python.md"), ASK]
    return fresh("\n".join(program))


def test_readme_of_the_package_is_the_repositorys():
    """The package's README has the lines of the repository's, which test_stranger.py runs."""
    own = blocks(REPOSITORY / "python" / "README.md")
    assert own and own == blocks(REPOSITORY / "README.md")


def test_documentation_runs_where_there_is_only_pip(documented):
    """The lines of docs/python.md run one after another, from the installed package."""
    printed, folder = documented
    answer = json.loads(printed.splitlines()[-1])
    assert "there is no variable frictio_law; did you mean friction_law" in printed
    assert Path(answer["package"]).is_relative_to(folder / "venv")
    assert Path(answer["fmu"]).is_relative_to(folder / "venv")
    assert answer["version"] == tomllib.loads((REPOSITORY / "Cargo.toml").read_text())["package"]["version"]
    assert answer["rows"] == 11001
    assert answer["force"][0] == pytest.approx(0.0, abs=1.0)
    assert answer["force"][-1] == pytest.approx(0.3 * 80e3, rel=0.01)
    # The curves that one picture compares have one law of friction.
    assert answer["friction"] == pytest.approx([0.3] * len(answer["friction"]))
    for picture in ("braking.png", "creep_curves.png", "geometry.png", "over_time.png", "patch.png"):
        assert (folder / picture).stat().st_size > 20_000


def test_simulate_is_the_native_simulation(fmu, simulate_natively, tmp_path):
    """All outputs are those of `wheelrail simulate` to 1e-12: FMPy interpolates the table with its own round-off."""
    scenario = tmp_path / "scenario.csv"
    pd.DataFrame(TABLE | {"wheel_speed": CHOSEN["wheel_speed"]}).to_csv(scenario, index=False)
    native = wheelrail.read_table(simulate_natively(scenario, 1e-3, {"friction_law": 2, "friction_hot": 0.2}))
    result = wheelrail.simulate(TABLE, fmu=fmu, **CHOSEN)
    assert len(result) == len(native) == 501
    for name in native:
        if name in result:
            scale = np.abs(native[name]).max()
            assert np.allclose(result[name], native[name], rtol=1e-12, atol=1e-12 * scale), name
    units = wheelrail.variables(fmu)["unit"]
    assert all(unit == units.get(name, "s") for name, unit in result.attrs["units"].items())
    assert {"time", "peak_temperature", "worn_volume"} <= set(native) & set(result)


@pytest.mark.parametrize(
    "form",
    [
        pd.DataFrame(TABLE),
        pd.DataFrame(TABLE).set_index("time"),
        pd.DataFrame(TABLE).to_records(index=False),
        TABLE | {"wheel_speed": 40.0},
    ],
    ids=["data frame", "by index", "records", "constant column"],
)
def test_every_form_of_table_is_the_same(fmu, form):
    """The same numbers from each, choices by number too; progress ends at 1."""
    expected = wheelrail.simulate(TABLE, step=0.05, fmu=fmu, **CHOSEN)
    shares = []
    columns = form.dtype.names if isinstance(form, np.ndarray) else list(form)
    chosen = {name: value for name, value in CHOSEN.items() if name not in columns} | {"friction_law": 2}
    result = wheelrail.simulate(form, step=0.05, fmu=fmu, progress=shares.append, **chosen)
    pd.testing.assert_frame_equal(result, expected)
    assert shares == pytest.approx(np.linspace(0.1, 1.0, 10))


def test_instance_goes_on(fmu):
    """A table in two parts through one instance gives the bits of the whole."""
    times = np.arange(9) / 64
    table = pd.DataFrame({"time": times, "creepage": np.linspace(0.0, 0.02, 9)})
    whole = wheelrail.simulate(table, step=1 / 64, fmu=fmu)
    instance = wheelrail.Instance(fmu).start()
    parts = [
        wheelrail.simulate(table, step=1 / 64, stop_time=times[4], instance=instance),
        wheelrail.simulate(table, step=1 / 64, instance=instance),
    ]
    assert instance.time == times[-1]
    instance.close()
    pd.testing.assert_frame_equal(pd.concat([parts[0], parts[1].iloc[1:]], ignore_index=True), whole)


def test_jump_and_profiles(fmu):
    """Two rows of one time are a jump; a profile's name stands for its points, with its unit."""
    table = {"time": [0.0, 0.05, 0.05, 0.1], "creepage": [0.0, 0.0, 0.02, 0.02]}
    result = wheelrail.simulate(table, step=0.01, fmu=fmu, outputs=["slip_creepage", "profile.pressure"])
    jumped = result["time"] > 0.055
    assert result["slip_creepage"][jumped].to_numpy() == pytest.approx(0.02, rel=1e-12)
    assert np.all(result["slip_creepage"][~jumped] == 0.0)
    assert result.attrs["units"]["profile.pressure[1]"] == "Pa"
    assert sum(name.startswith("profile.pressure[") for name in result) > 50


@pytest.mark.parametrize(
    ("table", "values", "message"),
    [
        (TABLE, {"frictio_law": 1}, "there is no variable frictio_law; did you mean friction_law"),
        (TABLE, {"friction_law": "piecewise"}, "friction_law = 'piecewise': choose one of constant, piecewise_linear"),
        (TABLE, {"contact_model": 4}, "contact_model = 4: choose one of line, patch, profiles"),
        (TABLE, {"contact_nodes": True}, "contact_nodes = True: a number is needed"),
        (TABLE, {"contact_nodes": 20.5}, "contact_nodes = 20.5: a whole number is needed"),
        (TABLE, {"friction_hot": 1.5}, "friction_hot = 1.5: allowed is 0 to 1"),
        (TABLE, {"friction_hot": float("nan")}, "friction_hot = nan: a finite number is needed"),
        (TABLE, {"traction_force": 1.0}, "traction_force is of kind output"),
        (TABLE, {"creepage": 0.1}, "given in the table and as a constant: creepage"),
        (TABLE, {"outputs": ["peak_temperatur"]}, "did you mean peak_temperature"),
        (TABLE, {"outputs": ["solver.iterations"]}, "solver.iterations is a number that counts"),
        (TABLE, {"step": 0.0}, "step = 0.0: a positive number of seconds is needed"),
        (None, {}, "without a table stop_time is needed"),
        (TABLE | {"normal_lod": 1.0}, {}, "there is no variable normal_lod; did you mean normal_load"),
        (TABLE | {"friction_hot": [0.1, 0.2]}, {}, "friction_hot is of kind parameter"),
        (TABLE | {"creepage": [0.0, 1e3]}, {}, "creepage = 1000 in row 2, at 0.5 s: allowed is -0.99 to 100"),
        (TABLE | {"creepage": [0.0, 0.1, 0.2]}, {}, "column creepage has 3 values, time has 2 rows"),
        (TABLE | {"time": [1.0, 0.5]}, {}, "time goes back in row 2: 0.5 s after 1 s"),
        ({"creepage": [0.0, 0.1]}, {}, "no column time"),
    ],
)
def test_what_is_refused_before(fmu, table, values, message):
    """A wrong name or value is said with the name, before anything runs."""
    with pytest.raises(ValueError, match=re.escape(message)):
        wheelrail.simulate(table, fmu=fmu, **values)


def test_what_the_component_refuses(fmu):
    """A speed that its steel does not take, half-way: its words, the time, rows before; combinations at the start."""
    table = {"time": [0.0, 0.5], "vehicle_speed": [10.0, 500.0]}
    with pytest.raises(wheelrail.SimulationError, match=r"after 0\.1\d* s: .*vehicle_speed = .*allowed is ") as error:
        wheelrail.simulate(table, fmu=fmu, slip_source="vehicle_speed")
    before = error.value.table
    assert before["vehicle_speed"].is_monotonic_increasing
    assert float(re.match(r"after ([\d.]+) s", str(error.value))[1]) == pytest.approx(before["time"].iloc[-1])
    with pytest.raises(wheelrail.SimulationError, match="the hot temperature must lie above the cold one"):
        wheelrail.simulate(TABLE, fmu=fmu, friction_temperature_hot=300.0)
    # And FMPy's own way of saying it is as it was, in the same process.
    with pytest.raises(wheelrail.SimulationError, match="lateral_creepage"):
        wheelrail.Instance(fmu, lateral_creepage=0.01).start()


def test_creep_curves(fmu):
    """Odd in the creepage that drives, mirrored in the others, saturated at the friction; units; the line alone."""
    values = [-0.02, -0.001, 0.0, 0.001, 0.02]
    curves = wheelrail.creep_curves(("longitudinal", "lateral"), values, fmu=fmu, friction_law="constant", load=70e3)
    assert curves.attrs["units"]["spin_moment"] == "N.m"
    assert (curves.attrs["normal_load"], curves.attrs["speed"]) == (70e3, 20.0)
    limit = 0.45 * 70e3
    for driven, force, sign in (("longitudinal", "traction_force", 1.0), ("lateral", "lateral_force", -1.0)):
        curve = sign * curves[curves["driven"] == driven][force].to_numpy()
        # To what a step of the patch is solved to, and longitudinally to the speed of the wheel, which is not mirrored.
        assert curve == pytest.approx(-curve[::-1], abs=2e-3 * limit)
        assert curve[-1] == pytest.approx(limit, rel=1e-3)
        assert 0.1 * limit < curve[3] < 0.6 * limit
    line = wheelrail.creep_curves("longitudinal", [0.05], fmu=fmu, contact_model="line")
    assert line["traction_force"].iloc[0] < 0.45 * 60e3
    with pytest.raises(ValueError, match="longitudinal creepage alone"):
        wheelrail.creep_curves("lateral", fmu=fmu, contact_model="line")
    with pytest.raises(ValueError, match=r"take the FMU of FMI 3\.0"):
        wheelrail.Instance(fmu, contact_model="patch").start().fields()
    with pytest.raises(ValueError, match="did you mean lateral"):
        wheelrail.creep_curves("laterl", fmu=fmu)


def test_variables(fmu):
    """Kinds, units and choices of what may be set and read."""
    table = wheelrail.variables(fmu)
    assert table.loc["normal_load", ["kind", "unit"]].tolist() == ["input", "N"]
    assert table.loc["friction_law", "choices"] == "constant, piecewise_linear, flow_stress, table"
    assert table.loc["contact_nodes", "choices"] == ""
    assert set(table["kind"]) == {"input", "output", "parameter"}


needs_third = pytest.mark.skipif(not THIRD.exists(), reason="the FMU of FMI 3.0 is not built")


@needs_third
def test_both_versions_give_the_same_bits(fmu):
    """The same inputs and parameters through FMI 2.0 and 3.0; the table's points are elements, and an array."""
    chosen = {"creepage": 0.03, "wheel_speed": 40.0, "wheel_heating": True, "friction_law": "table"}
    chosen |= {"friction_table_points": 3, "step": 0.01, "stop_time": 0.2}
    points = {"friction_table.temperature": [300.0, 400.0, 600.0], "friction_table.coefficient": [0.4, 0.3, 0.2]}
    results = [wheelrail.simulate(fmu=path, parameters=points, **chosen) for path in (fmu, THIRD)]
    assert results[0]["wheel_temperature"].iloc[-1] > 293.15
    pd.testing.assert_frame_equal(*results, check_exact=True)
    assert results[0].attrs == results[1].attrs


@needs_third
def test_fields_of_the_patch():
    """Arrays of strips by cells, with the grid that was asked for; the pressure sums to the load."""
    instance = wheelrail.Instance(THIRD, contact_model="patch", patch_nodes=40, patch_strips=25, lateral_creepage=2e-3)
    instance.start().step(5.0)
    fields = instance.fields()
    instance.close()
    assert {values.shape for values in fields.values()} == {(25, 40)}
    cell = np.diff(fields["x"][0, :2])[0] * np.diff(fields["y"][:2, 0])[0]
    assert np.sum(fields["pressure"]) * cell == pytest.approx(60e3, rel=1e-6)
    assert len(wheelrail.plots.patch_fields(fields).axes) >= 4


@needs_third
def test_what_the_component_refuses_in_words_of_its_own():
    """Through FMI 3.0 too, where nothing is said unless it is asked for."""
    with pytest.raises(wheelrail.SimulationError, match=r"vehicle_speed = .*allowed is "):
        table = {"time": [0.0, 0.5], "vehicle_speed": [10.0, 500.0]}
        wheelrail.simulate(table, fmu=THIRD, slip_source="vehicle_speed")
