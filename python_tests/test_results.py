"""What comes back from a run: its memory, its points, fields over time; progress; pictures, also in a notebook."""

import io
import re
import sys
import tracemalloc
from itertools import pairwise
from pathlib import Path

import matplotlib as mpl
import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
import pytest

REPOSITORY = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(REPOSITORY / "python"))

import wheelrail  # noqa: E402
from wheelrail import plots  # noqa: E402
from wheelrail.progress import reporter  # noqa: E402
from wheelrail.stepping import points  # noqa: E402

# A wheelset that moves from the tread to where flange's root and tread carry.
PROFILES = {"contact_model": "profiles", "slip_source": "vehicle_speed", "patch_nodes": 14, "patch_strips": 9}
PROFILES |= {"step": 5e-4, "vehicle_speed": 20.0, "wheel_speed": 43.6}
MOVING = {"time": [0.0, 2e-3], "lateral_displacement [mm]": [3.0, 5.1]}
PATCH = {"contact_model": "patch", "lateral_creepage": 1e-3, "creepage": 1e-3, "step": 0.02}


def test_window_follows_the_loads(fmu):
    """A table or a curve under a locomotive's load has the window of a twentieth more; others have the default."""
    run = {"fmu": fmu, "step": 1e-2, "outputs": "traction_force", "creepage": 0.01}
    table = {"time": [0.0, 0.1], "normal_load [kN]": [60.0, 112.5]}
    pd.testing.assert_frame_equal(
        wheelrail.simulate(table, **run), wheelrail.simulate(table, **run, largest_load=1.05 * 112.5e3)
    )
    light = {"stop_time": 0.1, "normal_load": 60e3}
    pd.testing.assert_frame_equal(
        wheelrail.simulate(**light, **run), wheelrail.simulate(**light, **run, largest_load=100e3)
    )
    curve = {"driven": "longitudinal", "creepages": [0.002], "load": 112.5e3, "contact_model": "line", "fmu": fmu}
    pd.testing.assert_frame_equal(
        wheelrail.creep_curves(**curve), wheelrail.creep_curves(**curve, largest_load=1.05 * 112.5e3)
    )


def test_memory_of_a_result(fmu):
    """At its peak a run takes little more than its result: the points while they are made, and a look ahead.

    The points are made beside copies of them, 3 columns of the 32 of the result, before it is made; the look ahead is
    1024 rows of Python's numbers. Rows in lists took eight times the result.
    """
    table = pd.DataFrame({"time": [0.0, 5.0], "creepage": [0.0, 0.02], "normal_load": [60e3, 80e3]})
    settings = {"fmu": fmu, "wheel_speed": 40.0}
    # What is made once, for all runs, is no part of it.
    wheelrail.simulate(table, step=0.1, **settings)
    tracemalloc.start()
    result = wheelrail.simulate(table, step=1e-3, **settings)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    size = result.to_numpy().nbytes
    assert size == 5_001 * result.shape[1] * 8
    assert peak < 1.2 * size + 6e5, peak / size
    # One block, which is no copy.
    assert np.shares_memory(result["time"].to_numpy(), result["wear_depth"].to_numpy().base)


@pytest.mark.parametrize(
    ("start", "end", "step", "table", "expected"),
    [
        (0.0, 1.0, 0.25, [0.0, 1.0], [0.0, 0.25, 0.5, 0.75, 1.0]),
        # The end is a point, and the last step is what is left.
        (0.0, 1.0, 0.4, [0.0, 1.0], [0.0, 0.4, 0.8, 1.0]),
        (0.0, 0.1, 0.5, [0.0, 0.1], [0.0, 0.1]),
        # So are the jumps, those that are on the way; a jump that is a point but for round-off is that one.
        (0.0, 1.0, 0.5, [0.0, 0.3, 0.3, 1.0], [0.0, 0.3, 0.5, 1.0]),
        (0.0, 0.3, 0.1, [0.0, 0.2, 0.2, 0.2, 0.3], [0.0, 0.1, 0.2, 0.3]),
        (0.1, 0.4, 0.1, [0.0, 0.3, 0.3, 0.4], [0.1, 0.2, 0.3, 0.4]),
        (0.0, 1.0, 0.5, [0.0, 0.0, 1.0, 1.0, 2.0], [0.0, 0.5, 1.0]),
        (0.0, 0.6, 0.2, [0.0, 0.1, 0.1, 0.11, 0.11, 0.6], [0.0, 0.1, 0.11, 0.2, 0.4, 0.6]),
    ],
)
def test_communication_points(start, end, step, table, expected):
    """Every step, the jumps, the end; jumps and end are met exactly."""
    found = points(start, end, step, np.array(table), 1)
    assert found.tolist() == pytest.approx(expected, abs=1e-12)
    assert found[-1] == end
    assert np.all(np.diff(found) > 1e-9 * step)
    jumps = [now for now, then in pairwise(table) if now == then and start < now < end]
    assert set(jumps) <= set(found.tolist())


def test_fields_of_the_patch(fmu3):
    """Each field over time and cells, the same as those of an instance; the pressure sums to the load at each time."""
    table = {"time": [0.0, 0.1], "normal_load [kN]": [60.0, 80.0]}
    result, fields = wheelrail.simulate(table, fields=True, fmu=fmu3, patch_nodes=30, patch_strips=17, **PATCH)
    assert fields.sizes == {"time": 6, "y": 17, "x": 30}
    assert fields["time"].values.tolist() == result["time"].tolist()
    assert fields["pressure"].attrs["units"] == "Pa"
    assert (fields["x"].attrs["units"], fields["time"].attrs["units"]) == ("m", "s")
    cell = float(np.diff(fields["x"][:2])[0] * np.diff(fields["y"][:2])[0])
    # Before the first step there is no contact yet.
    sums = fields["pressure"].sum(["x", "y"]).values[1:] * cell
    assert sums == pytest.approx(result["normal_load"].to_numpy()[1:], rel=1e-6)
    start = {name: value for name, value in PATCH.items() if name != "step"}
    instance = wheelrail.Instance(fmu3, patch_nodes=30, patch_strips=17, **start).start()
    some = wheelrail.simulate(table, fields=["temperature", "slip_x"], fields_every=4, instance=instance, step=0.02)[1]
    own = instance.fields()
    instance.close()
    assert list(some.data_vars) == ["temperature", "slip_x"]
    # Every fourth, and the last.
    assert some["time"].values.tolist() == pytest.approx([0.0, 0.08, 0.1])
    for name in some.data_vars:
        assert np.array_equal(some[name].isel(time=-1), own[name]), name
        assert np.array_equal(some[name].isel(time=-1), fields[name].isel(time=-1)), name
    assert np.array_equal(fields["x"], own["x"][0])
    assert np.array_equal(fields["y"], own["y"][:, 0])


@pytest.mark.parametrize("version", ["fmu", "fmu3"])
def test_fields_of_a_line(version, request):
    """Those of an instance are those of `simulate`, by the same names, in either version of FMI."""
    fmu = request.getfixturevalue(version)
    table = {"time": [0.0, 0.02], "creepage": [0.0, 0.01]}
    with wheelrail.Instance(fmu).start() as instance:
        _, fields = wheelrail.simulate(table, fields=True, instance=instance, step=0.01)
        own = instance.fields()
    assert set(own) == set(fields.variables) - {"time"} == {*fields.data_vars, "x", "z"}
    for name, values in own.items():
        assert np.array_equal(values, fields[name].isel(time=-1) if "time" in fields[name].dims else fields[name]), name
    assert own["pressure"].max() > 1e8
    assert own["depth_temperature"].shape == own["z"].shape


def test_fields_of_profiles(fmu3):
    """Each field over time, windows, strips and cells; the pressure adds up to the normal forces at each time."""
    result, fields = wheelrail.simulate(MOVING, fields=True, fmu=fmu3, outputs="contact.normal_force", **PROFILES)
    assert dict(fields.sizes) == {"time": 5, "window": 4, "strip": 14, "cell": 14, "place": 1500}
    assert fields["pressure"].dims == ("time", "window", "strip", "cell")
    assert (fields["arc_length"].attrs["units"], fields["slip_s"].attrs["units"]) == ("m", "m/s")
    forces = (fields["pressure"].sum(["strip", "cell"]) * fields["cell_length"] * fields["strip_breadth"]).values
    expected = result[[f"contact.normal_force[{number}]" for number in range(1, 5)]].to_numpy()
    # Before the first step there is no contact yet.
    assert forces[1:] == pytest.approx(expected[1:], rel=1e-9, abs=1e-6)
    assert np.count_nonzero(expected[1]) == 1
    assert np.count_nonzero(expected[-1]) == 2
    # Cells under pressure stand between the ends of the rail's profile, where it is.
    carrying = fields["pressure"].isel(time=-1).values > 0.0
    window, strip, _ = np.nonzero(carrying)
    last = fields.isel(time=-1)
    y, z = (last[axis].values[window, strip] for axis in "yz")
    order = np.argsort(last["rail_y"].values)
    on_rail = np.interp(y, last["rail_y"].values[order], last["rail_z"].values[order])
    assert z == pytest.approx(on_rail, abs=2e-6)
    start = {name: value for name, value in PROFILES.items() if name != "step"}
    with wheelrail.Instance(fmu3, lateral_displacement=3e-3, **start).start() as instance:
        some = wheelrail.simulate(MOVING, fields="temperature", instance=instance, step=5e-4)[1]
        own = instance.fields()
    assert list(some.data_vars) == ["temperature"]
    assert np.array_equal(some["temperature"].isel(time=-1), own["temperature"])
    for name in ("x", "arc_length", "cell_length"):
        assert np.array_equal(some[name].isel(time=-1), own[name]), name


@pytest.mark.parametrize("field", ["pressure", "shear", "slip", "friction_coefficient", "temperature", "wear_depth"])
def test_fields_of_profiles_are_drawn(fmu3, field):
    """A panel for each contact, whose largest value is that of the data set; any field."""
    _, fields = wheelrail.simulate(MOVING, fields=True, fmu=fmu3, **PROFILES)
    figure = plots.surface_fields(fields.isel(time=-1), field)
    panels = [axes for axes in figure.axes if axes.get_title(loc="left").startswith("contact")]
    assert [axes.get_title(loc="left")[:9] for axes in panels] == ["contact 1", "contact 2"]
    if field == "pressure":
        drawn = max(np.nanmax(axes.collections[0].get_array()) for axes in panels)
        assert drawn == pytest.approx(fields["pressure"].isel(time=-1).max().item() / 1e6)
        with pytest.raises(ValueError, match="fields of several times"):
            plots.surface_fields(fields)
        lifted = fields.isel(time=-1).assign(pressure=0.0 * fields["pressure"].isel(time=-1))
        with pytest.raises(ValueError, match="no cell is in contact"):
            plots.surface_fields(lifted)


@pytest.mark.parametrize("version", ["fmu", "fmu3"])
def test_fields_of_the_line(version, request):
    """Profiles along the rail and into the depth, from either version: those of the outputs."""
    path = request.getfixturevalue(version)
    settings = {"stop_time": 0.1, "step": 0.01, "creepage": 0.02, "fmu": path}
    result, fields = wheelrail.simulate(
        fields=True, outputs=["profile.x", "profile.shear", "depth.temperature"], **settings
    )
    assert fields["shear"].dims == ("time", "x")
    assert fields["depth_temperature"].dims == ("time", "z")
    assert fields["shear"].attrs == {"units": "Pa", "long_name": "Shear traction on the rail"}
    for name, profile in (("shear", "profile.shear"), ("depth_temperature", "depth.temperature")):
        columns = [column for column in result if column.startswith(f"{profile}[")]
        assert np.array_equal(fields[name], result[columns]), name
    # Places stay where they are.
    places = result[[column for column in result if column.startswith("profile.x[")]].to_numpy()
    assert np.all(places == fields["x"].values)


def test_what_there_was_before_a_failure(fmu):
    """Rows and fields up to the step that could not be completed."""
    table = {"time": [0.0, 0.5], "vehicle_speed": [10.0, 500.0]}
    with pytest.raises(wheelrail.SimulationError) as error:
        wheelrail.simulate(table, fmu=fmu, slip_source="vehicle_speed", fields="pressure", step=0.01, fields_every=2)
    rows, fields = error.value.table, error.value.fields
    assert 5 < len(rows) < 50
    assert fields["time"].values.tolist() == rows["time"].tolist()[::2]
    assert fields["pressure"].isel(time=-1).max() > 1e8


def test_without_xarray(fmu, monkeypatch):
    """What to install is said before anything is computed; all else works."""
    monkeypatch.setitem(sys.modules, "xarray", None)
    with pytest.raises(ImportError, match="pip install xarray"):
        wheelrail.simulate(stop_time=0.1, fields=True, fmu=fmu)
    assert len(wheelrail.simulate(stop_time=0.02, step=0.01, fmu=fmu)) == 3


class Stream(io.StringIO):
    """A stream that is a terminal, or none."""

    def __init__(self, terminal):
        """A terminal, or not."""
        super().__init__()
        self.terminal = terminal

    def isatty(self):
        """Whether it is one."""
        return self.terminal


class KernelStream(Stream):
    """A stream as Jupyter's kernels have it."""

    __module__ = "ipykernel.iostream"


@pytest.mark.parametrize(
    ("stream", "lines"),
    [(Stream(True), 4), (KernelStream(False), 4), (Stream(False), 2)],
    ids=["terminal", "notebook", "file"],
)
def test_progress(stream, lines, monkeypatch):
    """A terminal and a notebook see each percent in place; a file a line for each half."""
    monkeypatch.setattr(sys, "stderr", stream)
    show = reporter(True, 0.0, 8.0, "creep_curves", "points")
    for place in (2.0, 4.0, 6.0, 8.0):
        show(place)
    text = stream.getvalue()
    assert text.count("creep_curves:") == lines
    assert text.endswith("  creep_curves:   8.00 of 8.00 points, 100 %\n")
    assert text.count("\r") == (3 if lines == 4 else 0)


@pytest.fixture(scope="module")
def curves(fmu):
    """Return creep curves of all directions with few points."""
    values = {"longitudinal": [0.0, 2e-3], "lateral": [0.0, 2e-3], "spin": [0.0, 1.0]}
    return wheelrail.creep_curves(None, values, fmu=fmu, load=80e3, speed=25.0)


@pytest.mark.parametrize(("driven", "panels"), [(["longitudinal"], 1), (["lateral"], 2), (["lateral", "spin"], 4)])
def test_curves_fill_their_canvas(curves, driven, panels):
    """No panel is left empty where the directions are few, and load and speed are said."""
    figure = plots.creep_curves(curves[curves["driven"].isin(driven)], title="Dry")
    assert len(figure.axes) == panels
    assert all(axes.axison for axes in figure.axes)
    assert figure.get_suptitle() == "Dry: 80 kN, 25 m/s"
    figure.draw_without_rendering()
    boxes = [axes.get_tightbbox().transformed(figure.transFigure.inverted()) for axes in figure.axes]
    assert min(box.x0 for box in boxes) < 0.05
    assert max(box.x1 for box in boxes) > 0.95
    assert min(box.y0 for box in boxes) < 0.05


def test_curves_of_several_loads(curves):
    """Where loads differ the legend says them, in the panel that is left."""
    other = curves.copy()
    other.attrs["normal_load"] = 60e3
    figure = plots.creep_curves({"worn": curves, "new": other})
    legend = figure.axes[5].get_legend()
    assert [text.get_text() for text in legend.get_texts()] == ["worn: 80 kN, 25 m/s", "new: 60 kN, 25 m/s"]


def test_over_time(fmu):
    """A panel for each name in the unit in which people read it, or in that which is asked for."""
    result = wheelrail.simulate(stop_time=0.05, step=0.01, creepage=0.02, fmu=fmu)
    names = ["traction_force", "peak_temperature", "friction_coefficient", "slip_creepage"]
    figure = plots.over_time(result, names, units={"slip_creepage": "%"}, title="Rolling")
    labels = ["traction force [kN]", "peak temperature [°C]", "friction coefficient", "slip creepage [%]"]
    assert [axes.get_ylabel() for axes in figure.axes] == labels
    assert figure.axes[-1].get_xlabel() == "time [s]"
    for axes, name, factor, offset in zip(
        figure.axes, names, (1e-3, 1.0, 1.0, 1e2), (0.0, -273.15, 0.0, 0.0), strict=True
    ):
        x, y = axes.get_lines()[0].get_data()
        assert np.array_equal(x, result["time"])
        assert y == pytest.approx(factor * result[name].to_numpy() + offset, rel=1e-14)
    assert len(plots.over_time(result, "traction_force").axes) == 1


def test_elements_of_arrays(fmu, fmu3):
    """Elements have the same names and values by either version of FMI, alone and beside their array."""
    names = ["contact.rail_position[2]", "force_y", "contact.normal_force[1]", "contact.rail_position"]
    results = [wheelrail.simulate(MOVING, outputs=names, fmu=path, **PROFILES) for path in (fmu, fmu3)]
    pd.testing.assert_index_equal(*(result.columns for result in results))
    others = [f"contact.rail_position[{number}]" for number in (1, 3, 4)]
    assert list(results[0]) == ["time", "lateral_displacement", "vehicle_speed", "wheel_speed", *names[:3], *others]
    assert results[0].attrs == results[1].attrs
    result, _ = wheelrail.simulate(MOVING, outputs=names, fmu=fmu3, fields="pressure", **PROFILES)
    pd.testing.assert_frame_equal(result, results[1])
    start = {name: value for name, value in PROFILES.items() if name != "step"}
    found = []
    for path in (fmu, fmu3):
        with wheelrail.Instance(path, lateral_displacement=5.1e-3, **start).start() as instance:
            instance.step(5e-4)
            first, second, one = instance.get("force_y", "contact.rail_position[2]", "contact.rail_position[1]")
            every = instance.get("contact.rail_position", "force_y")
            assert [first, second, one] == [every[4], every[1], every[0]]
            found.append(instance.get(names))
            for wrong in ("contact.area[5]", "contact.area[0]", "contact.area[1,1]", "force_y[1]"):
                with pytest.raises(ValueError, match=re.escape(f"there is no variable {wrong}")):
                    instance.get(wrong)
                with pytest.raises(ValueError, match=re.escape(f"there is no variable {wrong}")):
                    wheelrail.simulate(instance=instance, stop_time=1.0, outputs=wrong)
    assert found[0] == found[1]


def test_elements_of_fields(fmu3):
    """A cell of a field goes by its strip and its place in it, as a column is called, also where lengths are given."""
    start = {"contact_model": "patch", "patch_nodes": 14, "patch_strips": 9, "creepage": 1e-3}
    with wheelrail.Instance(fmu3, **start).start() as instance:
        instance.step(0.01)
        cell, whole = instance.get("patch.pressure[5,7]")[0], instance.get("patch.pressure")
        assert cell == np.reshape(whole, (9, 14))[4, 6] > 1e8
        with pytest.raises(ValueError, match="there is no variable patch"):
            instance.get("patch.pressure[5,15]")
    columns = list(wheelrail.simulate(stop_time=1e-3, outputs="patch.pressure", fmu=fmu3, **start))[2:]
    assert (len(columns), columns[4 * 14 + 6]) == (9 * 14, "patch.pressure[5,7]")


def test_over_time_of_all_elements(fmu, fmu3):
    """The name of what each contact has stands for all four, which one unit goes for; one of them has its own."""
    for path in (fmu, fmu3):
        outputs = ["contact.rail_position", "contacts"]
        result = wheelrail.simulate(stop_time=2e-3, outputs=outputs, fmu=path, **PROFILES)
        units = {"contact.rail_position": "m", "contact.rail_position[2]": "mm"}
        figure = plots.over_time(result, outputs, units=units)
        labels = [f"contact.rail position[{index}] [{'mm' if index == 2 else 'm'}]" for index in (1, 2, 3, 4)]
        assert [axes.get_ylabel() for axes in figure.axes] == [*labels, "contacts"]
        assert figure.axes[0].get_lines()[0].get_ydata() == pytest.approx(result["contact.rail_position[1]"].to_numpy())
        assert len(plots.over_time(result, "contact.rail_position[1]").axes) == 1


def test_pictures_take_other_units(fmu):
    """A frame that says kilonewtons is drawn as one in newtons."""
    result = wheelrail.simulate(
        REPOSITORY / "examples" / "braking.csv", stop_time=2.0, step=0.1, fmu=fmu, slip_source=2
    )
    other = result.assign(traction_force=result["traction_force"] / 1e3)
    other.attrs["units"] = result.attrs["units"] | {"traction_force": "kN"}
    drawn = [plots.braking(table).axes[1].get_lines()[0].get_ydata() for table in (result, other)]
    assert drawn[1] == pytest.approx(drawn[0], rel=1e-14)


def test_fields_are_drawn(fmu3):
    """A time of a data set is drawn as the fields of an instance are."""
    _, fields = wheelrail.simulate(stop_time=0.04, fields=True, fmu=fmu3, **PATCH)
    figure = plots.patch_fields(fields.isel(time=-1))
    mesh = figure.axes[0].collections[0]
    assert np.nanmax(mesh.get_array()) == pytest.approx(fields["pressure"].isel(time=-1).max().item() / 1e6)
    with pytest.raises(ValueError, match="fields of several times"):
        plots.patch_fields(fields)


def test_pictures_leave_pyplot_alone(curves):
    """Nothing is left open that a notebook would show a second time, and no setting is changed."""
    before = plt.get_fignums(), dict(mpl.rcParams)
    figure = plots.creep_curves(curves)
    assert (plt.get_fignums(), dict(mpl.rcParams)) == before
    picture = io.BytesIO()
    figure.savefig(picture)
    assert len(picture.getvalue()) > 10_000
