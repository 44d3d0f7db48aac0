# One row for each bad call, as long as it is.
# ruff: noqa: E501
"""What a stranger may do wrong with the package, and the words that it is answered with: a table of bad calls.

None of them computes anything, and each says what was given and what to change.
"""

import re
import sys
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

REPOSITORY = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(REPOSITORY / "python"))

import wheelrail  # noqa: E402
from wheelrail import plots  # noqa: E402

TIME = {"time": [0.0, 0.5]}
TABLE = TIME | {"creepage": [0.0, 0.02]}
SPEEDS = TIME | {"vehicle_speed": [10.0, 12.0]}


def indexed(index, **columns):
    """Return a frame with an index."""
    return pd.DataFrame(columns or {"creepage": [0.0, 0.02]}, index=index)


def with_units(frame, units):
    """Return a frame that says units."""
    frame.attrs["units"] = units
    return frame


POINTS = {"friction_table.temperature": [300.0, 400.0], "friction_table.coefficient": [0.45, 0.35]}
# Table, other arguments, and what is said.
SIMULATE = {
    # Units.
    "unit of something else": (TIME | {"normal_load [mm]": [1.0, 2.0]}, {}, "the unit mm is no unit of normal_load; allowed is N, kN"),
    "unknown unit": (TIME | {"normal_load [lbf]": [1.0, 2.0]}, {}, "normal_load [lbf]: the unit lbf is not known; allowed is N, kN"),
    "unit of a wrong case": (TIME | {"normal_load [KN]": [1.0, 2.0]}, {}, "the unit KN is not known; allowed is N, kN"),
    "no unit where one is needed": (TIME | {"normal_load []": [1.0, 2.0]}, {}, "the unit - is no unit of normal_load"),
    "unit of a plain number": (TIME | {"creepage [N]": [0.0, 0.1]}, {}, "the unit N is no unit of creepage; allowed is -, %"),
    "unit of the time": ({"time [kg]": [0.0, 1.0], "creepage": [0.0, 0.1]}, {}, "time [kg]: the unit kg is not known; allowed is s, ms"),
    "unit in parentheses": (TIME | {"normal_load (kN)": [1.0, 2.0]}, {}, "a unit stands in square brackets, normal_load [kN]"),
    "heading and attrs differ": (
        with_units(pd.DataFrame(TIME | {"normal_load [kN]": [60.0, 70.0]}), {"normal_load": "MN"}),
        {},
        "normal_load: its heading says kN, attrs['units'] says MN",
    ),
    "unit of attrs": (with_units(pd.DataFrame(TABLE), {"creepage": "lbf"}), {}, "creepage [lbf]: the unit lbf is not known"),
    "attrs that are no units": (with_units(pd.DataFrame(TABLE), "SI"), {}, "attrs['units'] = 'SI': a mapping of columns"),
    "out of range in another unit": (TIME | {"creepage [%]": [0.0, 2e4]}, {}, "creepage = 200 in row 2, at 0.5 s: allowed is -0.99 to 100"),
    # Inputs that the mode does not use.
    "column of another mode": (SPEEDS, {}, "vehicle_speed is given and not used: slip_source is 'creepage'; choose slip_source='vehicle_speed'"),
    "value of another mode": (TABLE, {"vehicle_speed": 12.0}, "vehicle_speed is given and not used: slip_source is 'creepage'"),
    "the other way round": (SPEEDS, {"slip_source": "vehicle_speed", "creepage": 0.1}, "creepage is given and not used: slip_source is 'vehicle_speed'"),
    "lateral creepage": (SPEEDS | {"lateral_creepage": [0.0, 0.1]}, {"slip_source": 2, "contact_model": 2}, "lateral_creepage is given and not used"),
    "lateral speed": (TABLE, {"lateral_speed": 0.1, "contact_model": "patch"}, "lateral_speed is given and not used"),
    # Time.
    "time back": (TABLE | {"time": [1.0, 0.5]}, {}, "time goes back in row 2: 0.5 s after 1 s"),
    "time missing": ({"creepage": [0.0, 0.1]}, {}, "no column time; columns: creepage"),
    "time with a capital": ({"Time": [0.0, 1.0], "creepage": [0.0, 0.1]}, {}, "there is no variable Time; the column of the time is called time"),
    "no time in a frame": (indexed(None), {}, "its index counts rows"),
    "rows left of a frame": (indexed([3, 8]), {}, "its index counts rows"),
    "index of something else": (indexed(pd.Index([0.0, 1.0], name="distance")), {}, "its index is called distance"),
    "dates": (indexed(pd.date_range("2026-01-01", periods=2)), {}, "seconds are needed, not dates; those since the first row are (dates - dates[0])"),
    "dates in a column": (TABLE | {"time": pd.date_range("2026-01-01", periods=2)}, {}, "not dates"),
    "dates as objects": (TABLE | {"time": list(pd.date_range("2026-01-01", periods=2).to_pydatetime())}, {}, "not dates"),
    "dates as text": (TABLE | {"time": ["2026-01-01", "2026-01-02"]}, {}, "time = '2026-01-01' in row 1: a finite number is needed"),
    "durations with a unit": ({"time [ms]": pd.to_timedelta([0, 1], "s"), "creepage": [0.0, 0.1]}, {}, "durations have their unit themselves"),
    "no duration": (TABLE | {"time": pd.to_timedelta([0, None], "s")}, {}, "time = nan in row 2"),
    "levels of the index": (indexed(pd.MultiIndex.from_tuples([(0, 0), (0, 1)])), {}, "its index has more than one level"),
    # Cells.
    "not a number": (TIME | {"creepage": [0.0, float("nan")]}, {}, "creepage = nan in row 2: a finite number is needed"),
    "infinite": (TIME | {"creepage": [0.0, np.inf]}, {}, "creepage = inf in row 2"),
    "text": (TIME | {"creepage": [0.0, "much"]}, {}, "creepage = 'much' in row 2: a finite number is needed"),
    "decimal comma": (TIME | {"creepage": ["0,0", "0,1"]}, {}, "creepage = '0,0' in row 1: a finite number is needed; a decimal point is needed"),
    "None in a cell": (TIME | {"creepage": [0.0, None]}, {}, "creepage = None in row 2"),
    "truth values": (TIME | {"creepage": [True, False]}, {}, "creepage = True in row 1"),
    "complex": (TIME | {"creepage": [0.0, 1j]}, {}, "creepage = 0j in row 1"),
    "missing of pandas": (pd.DataFrame(TIME).assign(creepage=pd.array([0.1, None], dtype="Float64")), {}, "creepage = nan in row 2"),
    "masked": (
        np.ma.array([(0.0, 0.0), (1.0, 0.1)], dtype=[("time", float), ("creepage", float)], mask=[(0, 0), (0, 1)]),
        {},
        "creepage = nan in row 2",
    ),
    "two dimensions": (TIME | {"creepage": [[0.0, 0.1], [0.0, 0.1]]}, {}, "column creepage has the shape (2, 2)"),
    "lengths": (TIME | {"creepage": [0.0, 0.1, 0.2]}, {}, "column creepage has 3 values, time has 2 rows"),
    "out of range": (TIME | {"creepage": [0.0, 1e3]}, {}, "creepage = 1000 in row 2, at 0.5 s: allowed is -0.99 to 100"),
    "above largest_load": (TIME | {"normal_load": [60e3, 242e3]}, {}, "normal_load = 242000 in row 2, at 0.5 s: allowed is 0 to 100000 N; largest_load = 100000 N sets it"),
    "above by name": (TABLE, {"normal_load": 242e3}, "normal_load = 242000: allowed is 0 to 100000 N; largest_load"),
    "above the given": (TABLE, {"normal_load": 142e3, "largest_load": 120e3}, "allowed is 0 to 120000 N; largest_load = 120000 N sets it"),
    # Tables.
    "no rows": ({"time": [], "creepage": []}, {}, "the table of inputs has no rows"),
    "empty": ({}, {}, "no column time; columns: none"),
    "one row": ({"time": [1.0], "creepage": [0.1]}, {}, "a run from 1 s needs a stop_time after that"),
    "unknown column": (TABLE | {"normal_lod": 1.0}, {}, "there is no variable normal_lod; did you mean normal_load"),
    "part of a column": (TABLE | {"load": 1.0}, {}, "there is no variable load; did you mean normal_load?"),
    "time misspelt": ({"tme": [0.0, 1.0], "creepage": [0.0, 0.1]}, {}, "there is no variable tme; did you mean time?"),
    "parameter as a column": (TABLE | {"friction_hot": [0.1, 0.2]}, {}, "friction_hot is of kind parameter: it cannot be set as input; give it by name, friction_hot=…"),
    "output as a column": (TABLE | {"traction_force": [0.1, 0.2]}, {}, "traction_force is of kind output: it cannot be set as input"),
    "two of one name": (pd.DataFrame([[0.0, 0.0, 0.1], [1.0, 0.0, 0.1]], columns=["time", "creepage", "creepage"]), {}, "creepage: two columns of the table have this name"),
    "two by units": (TABLE | {"creepage [%]": [0.0, 2.0]}, {}, "creepage: two columns of the table have this name"),
    "levels of the columns": (pd.DataFrame([[0.0]], columns=pd.MultiIndex.from_tuples([("a", "time")])), {}, "names of more than one level"),
    "plain array": (np.zeros((3, 2)), {}, "an array needs named columns"),
    "series": (pd.Series([0.0, 1.0]), {}, "a Series; give a data frame"),
    "list": ([[0.0, 1.0]], {}, "this is no table of inputs but a list; give a data frame"),
    "number": (5, {}, "this is no table of inputs but a int"),
    "numbers as names": ({0: [0.0, 1.0]}, {}, "a column is called 0"),
    "given twice": (TABLE, {"creepage": 0.1}, "given in the table and as a constant: creepage"),
    # Step and end.
    "step of nothing": (TABLE, {"step": 0.0}, "step = 0.0: a positive number of seconds is needed"),
    "step back": (TABLE, {"step": -1e-3}, "step = -0.001: a positive number"),
    "step as text": (TABLE, {"step": "1e-3"}, "step = '1e-3': a finite number of seconds is needed"),
    "no step": (TABLE, {"step": None}, "step = None: a finite number of seconds is needed"),
    "step that is no number": (TABLE, {"step": float("nan")}, "step = nan: a finite number of seconds is needed"),
    "too many steps": (TABLE, {"step": 1e-12}, "step = 1e-12 s from 0 to 0.5 s is 5e+11 rows: at most 1e+08 are allowed"),
    "too much memory": (TABLE, {"step": 6e-9}, "GiB, and at most 16 are allowed; choose a longer step or fewer outputs"),
    "lost in round-off": ({"time": [1e12, 1e12 + 1.0], "creepage": 0.1}, {"step": 1e-5}, "it is lost in the round-off of the time"),
    "end as text": (TABLE, {"stop_time": "1"}, "stop_time = '1': a finite number of seconds is needed"),
    "no end": (TABLE, {"stop_time": float("inf")}, "stop_time = inf: a finite number of seconds is needed"),
    "end before the beginning": (TABLE, {"stop_time": -1.0}, "stop_time = -1 s, and a run from 0 s needs a stop_time after that"),
    "neither table nor end": (None, {}, "without a table stop_time is needed"),
    # Values by name.
    "typing error": (TABLE, {"frictio_law": 1}, "there is no variable frictio_law; did you mean friction_law"),
    "part of a name": (TABLE, {"load": 60e3}, "there is no variable load; did you mean normal_load or largest_load?"),
    "name with capitals": (TABLE, {"SLIP_SOURCE": 2}, "there is no variable SLIP_SOURCE; did you mean slip_source"),
    "choice that is none": (TABLE, {"friction_law": "piecewise"}, "friction_law = 'piecewise': choose one of constant, piecewise_linear"),
    "choice with a capital": (TABLE, {"contact_model": "Patch"}, "contact_model = 'Patch': choose one of line, patch, profiles; did you mean patch?"),
    "grid that is none": (TABLE, {"patch_grid": "fats"}, "patch_grid = 'fats': choose one of fast, default, fine; did you mean fast?"),
    "grid as a number": (TABLE, {"patch_grid": 1}, "patch_grid = 1: choose one of fast, default, fine"),
    "grid and its cells": (TABLE, {"patch_grid": "fast", "patch_nodes": 12}, "patch_grid = 'fast' sets patch_nodes, which is given as well"),
    "plain number out of range": (TABLE, {"friction_hot": 1.5}, "friction_hot = 1.5: allowed is 0 to 1"),
    "value None": (TABLE, {"friction_hot": None}, "friction_hot = None: a finite number is needed"),
    "value of a mapping": (TABLE, {"friction_hot": {}}, "friction_hot = {}: a finite number is needed"),
    "list for a single value": (TABLE, {"friction_hot": [0.1, 0.2]}, "friction_hot is a single value, not [0.1, 0.2]"),
    "empty list": (TABLE, {"parameters": {"friction_table.temperature": []}}, "at least one value is needed"),
    "too many points": (TABLE, {"parameters": {"friction_table.temperature": [300.0] * 99}}, "99 values are given, it has "),
    "points of nothing": (TABLE, {"parameters": {"friction_tabel.temperature": [300.0]}}, "there is no variable friction_tabel.temperature; did you mean friction_table.temperature"),
    "fewer points than the number": (TABLE, {"friction_table_points": 3, "parameters": POINTS}, "friction_table_points = 3, and friction_table.temperature has 2 values: as many are needed"),
    "more points than the number": (TABLE, {"friction_table_points": 2, "parameters": {name: [*of, of[-1]] for name, of in POINTS.items()}}, "friction_table_points = 2, and friction_table.temperature has 3 values"),
    "lists of two lengths": (TABLE, {"parameters": POINTS | {"friction_table.coefficient": [0.4]}}, "friction_table.temperature has 2 values, friction_table.coefficient has 1 value: as many of each are needed"),
    "one list of two": (TABLE, {"parameters": {"friction_table.coefficient": [0.4, 0.3, 0.2]}}, "friction_table.coefficient has 3 values, and friction_table.temperature is not given and has 2: give both lists"),
    "one point": (TABLE, {"parameters": {"friction_table.temperature": [300.0], "friction_table.coefficient": [0.4]}}, "friction_table.temperature has 1 value: 2 to 10 are needed"),
    "parameters that are none": (TABLE, {"parameters": ["friction_hot"]}, "parameters = ['friction_hot']: a mapping of names to values"),
    "names that are none": (TABLE, {"parameters": {1: 2}}, "parameters: 1 is no name"),
    "parameter twice": (TABLE, {"parameters": {"friction_hot": 0.1}, "friction_hot": 0.2}, "given in parameters and by name: friction_hot"),
    "preset that is none": (TABLE, {"preset": "wett"}, "preset 'wett'"),
    "preset of values": (TABLE, {"preset": {"friction_hot": 0.1}}, "the name of a preset is needed"),
    # Outputs and the rest.
    "output that is none": (TABLE, {"outputs": "peak_temperatur"}, "there is no variable peak_temperatur; did you mean peak_temperature"),
    "outputs that are no names": (TABLE, {"outputs": [1]}, "outputs: 1 is no name of an output"),
    "outputs of a number": (TABLE, {"outputs": 1}, "outputs = 1: a name or a list of names is needed"),
    "fields of FMI 3.0": (TABLE, {"outputs": ["patch.pressure"], "contact_model": 2}, "there is no variable patch.pressure in FMI 2.0: that of FMI 3.0 has patch.*, fmu=wheelrail.fmu_path('3.0'); simulate(…, fields=True) has the fields over time"),
    "profile of FMI 3.0": (TABLE, {"outputs": "rail_profile.y"}, "that of FMI 3.0 has rail_profile.*, fmu=wheelrail.fmu_path('3.0')"),
    "outputs that count": (TABLE, {"outputs": ["solver.iterations"]}, "solver.iterations is a number that counts"),
    "progress": (TABLE, {"progress": 3}, "progress = 3: True, a title or a function"),
    "instance": (TABLE, {"instance": "contact"}, "instance = 'contact': an Instance is needed"),
    "fields of a number": (TABLE, {"fields": 7}, "fields = 7: True, a name or a list of names is needed"),
    "field that is none": (TABLE, {"fields": "presure"}, "fields: there is no field presure; did you mean pressure"),
    "no fields": (TABLE, {"fields": []}, "fields = []: none is chosen"),
    "fields of the patch": (TABLE, {"fields": True, "contact_model": "patch"}, "those of the patch are in the FMU of FMI 3.0"),
    "fields of profiles": (SPEEDS, {"fields": True, "contact_model": "profiles", "slip_source": 2}, "those of profiles are in the FMU of FMI 3.0"),
    "fields_every": (TABLE, {"fields": True, "fields_every": 0}, "fields_every = 0: a whole number of at least 1"),
}  # fmt: skip


def test_a_clone_says_how_its_fmus_are_built():
    """The package as it is in a clone has no FMU in it: the error has the commands, and where they put them."""
    for version, file in (("2.0", "WheelRailContact.fmu"), ("3.0", "WheelRailContact-fmi3.fmu")):
        with pytest.raises(
            FileNotFoundError, match="`make wheel` builds the package with them, `make fmu fmu3`"
        ) as said:
            wheelrail.fmu_path(version)
        assert str(said.value).endswith(f"for fmu={str(REPOSITORY / 'target' / file)!r}")


@pytest.mark.parametrize("case", SIMULATE)
def test_simulate(case, fmu):
    """What is wrong is said with the name, the value, the place and the way out."""
    table, values, words = SIMULATE[case]
    # The base of all that the package documents; a preset that is not there was a FileNotFoundError once.
    with pytest.raises((ValueError, TypeError, FileNotFoundError), match=re.escape(words)) as error:
        wheelrail.simulate(table, fmu=fmu, **values)
    # No unit is called 1.
    assert not re.search(r"\d 1($|[;,:])", str(error.value))


FILES = {
    "nothing": ("", "has no heading"),
    "comments alone": ("# nothing\n\n", "has no heading"),
    "no rows": ("time,creepage\n", "the table of inputs has no rows"),
    "too few cells": ("time,creepage\n0,0\n1\n", "creepage = nan in row 2"),
    "too many cells": ("time,creepage\n0,0\n1,2,3\n", "the rows have not as many cells as the heading, 2"),
    "too many cells throughout": ("time,creepage\n0,0,7\n1,2,3\n", "the rows have not as many cells as the heading, 2"),
    "text": ("time,creepage\n0,0\n1,low\n", "creepage = 'low' in row 2"),
    "text in another unit": ("time,creepage [%]\n0,0\n1,low\n", "creepage = 'low' in row 2"),
    "two of one name": ("time,creepage,creepage [%]\n0,0,0\n1,2,3\n", "two columns are called creepage"),
    "unknown unit": ("time [ms],normal_load [lbf]\n0,0\n1,1\n", "normal_load [lbf]: the unit lbf is not known"),
    "no time": ("creepage\n0\n1\n", "no column time; columns: creepage"),
    "decimal commas between commas": ("time,creepage\n0,0\n1,\"0,5\"\n", "a decimal point is needed"),
}  # fmt: skip


@pytest.mark.parametrize("case", FILES)
def test_files(case, fmu, tmp_path):
    """A file that is no table of inputs."""
    text, words = FILES[case]
    path = tmp_path / "table.csv"
    path.write_text(text)
    with pytest.raises(ValueError, match=re.escape(words)):
        wheelrail.simulate(path, fmu=fmu)


def test_paths(fmu, tmp_path):
    """A path that is not there, a folder, and bytes that are no text."""
    with pytest.raises(FileNotFoundError, match=r"none\.csv is not there"):
        wheelrail.simulate(tmp_path / "none.csv", fmu=fmu)
    with pytest.raises(ValueError, match="is a folder: the path of a CSV file is needed"):
        wheelrail.read_table(tmp_path)
    (tmp_path / "excel.csv").write_bytes("time,peak_temperature [°C]\n".encode("cp1252"))
    with pytest.raises(ValueError, match="is no text in UTF-8"):
        wheelrail.read_table(tmp_path / "excel.csv")
    with pytest.raises(TypeError, match="the path of an FMU is needed"):
        wheelrail.simulate(TABLE, fmu=5)


# Positional arguments, others, and what is said.
CURVES = {
    "kind that is none": (("laterl",), {}, "driven = 'laterl': choose from longitudinal, lateral, spin; did you mean lateral"),
    "no kind": (([],), {}, "driven = []: choose from longitudinal"),
    "number": ((3,), {}, "driven = 3: choose from longitudinal"),
    "no values": (("lateral", []), {}, "creepages: there is none for lateral"),
    "kind that is missing": ((None, {"lateral": [0.1]}), {}, "creepages: longitudinal is missing; it has lateral"),
    "kind that is not driven": (("lateral", {"lateral": [0.1], "spin": [0.1]}), {}, "creepages: spin is not driven; driven: lateral"),
    "value that is no number": (("lateral", [0.0, float("nan")]), {}, "lateral_creepage = nan: a finite number is needed"),
    "text": (("lateral", "0.01"), {}, "lateral_creepage = '0.01': a finite number is needed"),
    "out of range": (("longitudinal", [-2.0]), {}, "creepage = -2.0: allowed is -0.99 to 100"),
    "load": (("lateral",), {"load": -1.0}, "normal_load = -1.0: allowed is 0 to 1e+07 N"),
    "no load": (("lateral",), {"load": 0.0}, "load = 0.0: a positive number of newtons is needed"),
    "above largest_load": (("lateral",), {"load": 250e3}, "normal_load = 250000: allowed is 0 to 100000 N; largest_load = 100000 N sets it"),
    "load twice": (("lateral",), {"normal_load": 70e3}, "normal_load = 70000.0: creep curves take it from load"),
    "speed": (("lateral",), {"speed": 0.0}, "speed = 0.0: a positive number"),
    "speed as text": (("lateral",), {"speed": "20"}, "speed = '20': a number of metres per second"),
    "speed of the wheel": (("lateral",), {"wheel_speed": 40.0}, "wheel_speed = 40.0: creep curves take it from speed"),
    "too fast": (("lateral",), {"speed": 1e4}, "allowed is -10000 to 10000 rad/s"),
    "driven and given": (("lateral",), {"lateral_creepage": 0.1}, "lateral_creepage is what is driven"),
    "mode": (("lateral",), {"slip_source": "vehicle_speed"}, "slip_source = 'vehicle_speed': creep curves are over creepage at a load"),
    "control": (("lateral",), {"control": "penetration"}, "control = 'penetration': creep curves are over creepage at a load"),
    "input of another mode": (("lateral",), {"vehicle_speed": 20.0}, "vehicle_speed is given and not used"),
    "line": (("lateral",), {"contact_model": "line"}, "contact_model = 'line' has longitudinal creepage alone"),
    "profiles": ((), {"contact_model": "profiles"}, "contact_model = 'profiles': creep curves are of 'line' and 'patch'; forces of profiles come from simulate("),
    "profiles by number": ((), {"contact_model": 3, "slip_source": 2}, "contact_model = 3: creep curves are of 'line' and 'patch'"),
    "outputs": (("lateral",), {"outputs": "lateral_forc"}, "did you mean lateral_force"),
    "preset": (("lateral",), {"preset": "wett"}, "preset 'wett'"),
}  # fmt: skip


@pytest.mark.parametrize("case", CURVES)
def test_creep_curves(case, fmu):
    """Creep curves refuse what they cannot draw, and what they would set over."""
    arguments, values, words = CURVES[case]
    with pytest.raises((ValueError, TypeError, FileNotFoundError), match=re.escape(words)):
        wheelrail.creep_curves(*arguments, fmu=fmu, **values)


RESULT = pd.DataFrame(TIME | {"traction_force": [0.0, 1.0], "text": ["a", "b"]})
CREEP = pd.DataFrame({name: [0.0] for name in ("creepage", "lateral_creepage", "spin_creepage")})
CREEP = CREEP.assign(driven="lateral", traction_force=0.0, lateral_force=0.0, spin_moment=0.0)
CELLS = {name: np.zeros((3, 4)) for name in ("x", "y", "shear_x", "shear_y", "slip_x", "slip_y", "temperature")}
PLOTS = {
    "braking of something else": (plots.braking, (RESULT,), "braking needs wheel_speed, slip_creepage"),
    "braking of curves": (plots.braking, (CREEP,), "braking needs time, wheel_speed"),
    "braking of a path": (plots.braking, ("braking.csv",), "braking: a table is needed"),
    "curves of something else": (plots.creep_curves, (RESULT,), "creep_curves needs driven, creepage"),
    "curves without a load": (plots.creep_curves, (CREEP,), "attrs of the table lack normal_load and speed"),
    "no curves": (plots.creep_curves, ({},), "there is no table to draw"),
    "curves of a list": (plots.creep_curves, ([CREEP],), "a data frame of wheelrail.creep_curves is needed, not a list"),
    "fields of something else": (plots.patch_fields, (RESULT,), "patch_fields needs x, y, pressure"),
    "fields of nothing": (plots.patch_fields, (CELLS | {"pressure": np.zeros((3, 4))},), "no cell is in contact"),
    "fields of a number": (plots.patch_fields, (3,), "patch_fields: a table is needed"),
    "fields of a patch for profiles": (plots.surface_fields, (CELLS | {"pressure": np.ones((3, 4))},), "surface_fields needs cell_length"),
    "field of profiles that is none": (plots.surface_fields, (CELLS, "presure"), "there is no field presure; did you mean pressure"),
    "fields of times": (plots.patch_fields, (CELLS | {"pressure": np.ones((2, 3, 4))},), "choose one, fields.isel(time=-1)"),
    "cells that are no patch": (plots.patch_fields, ({name: np.arange(5.0) // 2 for name in [*CELLS, "pressure"]},), "5 cells in 3 strips are no patch"),
    "column that is none": (plots.over_time, (RESULT, "traction_forc"), "over_time needs traction_forc, which the table has not; simulate returns them; did you mean traction_force"),
    "no time": (plots.over_time, (CREEP, "creepage"), "over_time needs time"),
    "no names": (plots.over_time, (RESULT, []), "names = []: the names of columns are needed"),
    "names that are none": (plots.over_time, (RESULT, [3]), "names = [3]: the names of columns are needed"),
    "column of texts": (plots.over_time, (RESULT, "text"), "the column text is no numbers"),
}  # fmt: skip


@pytest.mark.parametrize("case", PLOTS)
def test_plots(case):
    """A picture of another result says what is missing."""
    draw, arguments, words = PLOTS[case]
    with pytest.raises((ValueError, TypeError), match=re.escape(words)):
        draw(*arguments)


def test_units_of_a_picture():
    """A unit of something else, or of a column that is not drawn."""
    with pytest.raises(ValueError, match=re.escape("traction_force [K]: the unit K is no unit of traction_force")):
        plots.over_time(RESULT, "traction_force", units={"traction_force": "K"})
    with pytest.raises(ValueError, match="units: traction_forc is not drawn; did you mean traction_force"):
        plots.over_time(RESULT, "traction_force", units={"traction_forc": "kN"})


def test_numbers_too_large_for_any_quantity(fmu):
    """A whole number of four hundred digits is refused wherever a number goes, by the name of where it went."""
    huge = 10**400
    for call, name in (
        (lambda: wheelrail.simulate(TABLE, fmu=fmu, normal_load=huge), "normal_load"),
        (lambda: wheelrail.simulate(TIME | {"creepage": [0.0, huge]}, fmu=fmu), "creepage"),
        (lambda: wheelrail.simulate(TABLE, fmu=fmu, contact_nodes=huge), "contact_nodes"),
        (lambda: wheelrail.simulate(TABLE, fmu=fmu, step=huge), "step"),
        (lambda: wheelrail.simulate(TABLE, fmu=fmu, stop_time=huge), "stop_time"),
        (lambda: wheelrail.creep_curves("lateral", fmu=fmu, load=huge), "load"),
        (lambda: wheelrail.creep_curves("lateral", fmu=fmu, speed=huge), "speed"),
        (lambda: wheelrail.creep_curves("lateral", [huge], fmu=fmu), "creepage"),
    ):
        with pytest.raises(ValueError, match=name):
            call()


def test_instance_is_left_as_it_was(fmu):
    """A refused run changes neither the time nor an input of the instance that it was to go on with."""
    instance = wheelrail.Instance(fmu, slip_source="vehicle_speed", normal_load=70e3).start()
    before = instance.get("normal_load", "traction_force"), instance.time
    for table, values, words in (
        (TABLE, {"normal_load": 50e3}, "creepage is given and not used: slip_source is 'vehicle_speed'"),
        (SPEEDS, {"normal_load": 150e3}, "largest_load = 100000 N sets it"),
        (SPEEDS, {"friction_hot": 0.2}, "parameters of an instance are set when it is made: friction_hot"),
        (SPEEDS, {"preset": "wet"}, "parameters of an instance are set when it is made"),
        (SPEEDS, {"normal_load": 50e3, "outputs": "no"}, "there is no variable no"),
        (SPEEDS, {"normal_load": 50e3, "fields": "no"}, "there is no field no"),
        (SPEEDS, {"fmu": "other.fmu"}, "leave fmu out"),
    ):
        with pytest.raises(ValueError, match=re.escape(words)):
            wheelrail.simulate(table, instance=instance, **values)
    assert (instance.get("normal_load", "traction_force"), instance.time) == before
    instance.close()
