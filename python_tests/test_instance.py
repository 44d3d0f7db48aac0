"""An instance of the Python package: its end, its refusals, which change nothing, its states in other processes."""

import copy
import os
import pickle
import re
import subprocess
import sys
import threading
import weakref
import zipfile
from pathlib import Path

import numpy as np
import pytest

REPOSITORY = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(REPOSITORY / "python"))

import wheelrail  # noqa: E402
from wheelrail import Instance, InstanceClosedError, SavedState, SimulationError, SimulationWarning  # noqa: E402

MOVING = {"creepage": 0.01, "wheel_speed": 40.0}
READ = ("traction_force", "peak_temperature", "wear_depth", *MOVING)


@pytest.fixture(params=["2.0", "3.0"])
def either(request, fmu, fmu3):
    """Return the path of the FMU of each version."""
    return fmu if request.param == "2.0" else fmu3


@pytest.fixture
def running(either):
    """Return a line contact that runs."""
    instance = Instance(either, **MOVING).start()
    instance.step(0.01)
    yield instance
    instance.close()


def in_a_process(program, *arguments):
    """Run a program in a process of its own; return what it prints."""
    command = [sys.executable, "-c", program, *map(str, arguments)]
    environment = os.environ | {"PYTHONPATH": str(REPOSITORY / "python")}
    done = subprocess.run(command, capture_output=True, text=True, timeout=300, env=environment)
    assert done.returncode == 0, f"exit status {done.returncode}: {done.stdout[-2000:]}{done.stderr[-2000:]}"
    return done.stdout


POINTS = "friction_table_points"

# ---- the end ---------------------------------------------------------------------------------------------------------

AFTER_THE_END = {
    "start": lambda instance: instance.start(),
    "get": lambda instance: instance.get("traction_force"),
    "get nothing": lambda instance: instance.get(5),
    "set": lambda instance: instance.set(creepage=0.0),
    "step": lambda instance: instance.step("x"),
    "follow": lambda instance: instance.follow(["creepage"], [0.0], [0.1], 1e-3),
    "steady": lambda instance: instance.steady([]),
    "derivative": lambda instance: instance.derivative("traction_force", "creepage"),
    "fields": lambda instance: instance.fields(),
    "parameters": lambda instance: instance.parameters(),
    "save": lambda instance: instance.save(),
    "restore": lambda instance: instance.restore(b""),
    "forget": lambda instance: instance.forget(None),
    "reset": lambda instance: instance.reset(),
    "with": lambda instance: instance.__enter__(),
    "pickle": lambda instance: pickle.dumps(instance),
    "simulate": lambda instance: wheelrail.simulate({"time": [0.0, 1.0]}, instance=instance),
    "FMPy": lambda instance: instance.slave.getFMUState(),
}


@pytest.mark.parametrize("call", AFTER_THE_END.values(), ids=AFTER_THE_END)
@pytest.mark.parametrize("end", ["close", "with", "FMPy's freeInstance"])
def test_after_the_end(running, call, end):
    """Every call says that the instance is closed, but a second close."""
    saved = running.save()
    if end == "close":
        running.close()
    elif end == "with":
        with running:
            pass
    else:
        running.slave.freeInstance()
    running.close()
    with pytest.raises(InstanceClosedError, match="the instance is closed: make a new one"):
        call(running)
    with pytest.raises(InstanceClosedError, match="closed"):
        saved.to_bytes()
    assert repr(running).endswith(": closed>")


def test_memory_of_what_is_dropped():
    """Patches and states that nobody closes or forgets are freed: more of them take no more than the first ones."""
    program = """
import gc, os, sys
from pathlib import Path
from wheelrail import Instance
def resident():
    gc.collect()
    return int(Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE") / 1e6
def make(number):
    for _ in range(number):
        instance = Instance(sys.argv[1], contact_model="patch").start()
        instance.circle = instance
        del instance
        gc.collect()
def save(number):
    kept = Instance(sys.argv[1], contact_model="patch").start()
    before = resident()
    for _ in range(number):
        kept.save()
    return resident() - before
make(3)
before = resident()
make(12)
print(resident() - before, save(60))
"""
    for path in ("WheelRailContact.fmu", "WheelRailContact-fmi3.fmu"):
        instances, states = map(float, in_a_process(program, REPOSITORY / "target" / path).split())
        # MB; 12 patches held 38 when nothing freed them, 60 states hold 30.
        assert instances < 15.0
        assert states < 15.0


def test_dropped_at_once(either):
    """Freed when the last reference goes, without a collection of garbage."""
    instance = Instance(either).start()
    slave = weakref.ref(instance.slave)
    saved = instance.save()
    del instance
    assert slave() is not None
    assert saved.to_bytes()
    del saved
    assert slave() is None


# ---- refusals --------------------------------------------------------------------------------------------------------

REFUSED = {
    "no step": (lambda i: i.step(0), ValueError, "step = 0: a positive finite number of seconds"),
    "back": (lambda i: i.step(-1e-3), ValueError, "step = -0.001: a positive"),
    "text": (lambda i: i.step("1e-3"), TypeError, "step = '1e-3': a positive finite number of seconds is needed"),
    "nan": (lambda i: i.step(np.nan), ValueError, "step = nan"),
    "huge integer": (lambda i: i.step(10**400), ValueError, "too large"),
    "second start": (
        lambda i: i.start(),
        SimulationError,
        "start(): the instance was started before: go on",
    ),
    "unknown": (lambda i: i.get("traction_forc"), ValueError, "no variable traction_forc; did you mean traction_force"),
    "no name": (lambda i: i.get(["traction_force", 5]), TypeError, "the name of a variable is a text, not 5"),
    "range": (
        lambda i: i.set(creepage=0.02, normal_load=-1.0),
        ValueError,
        "normal_load = -1.0: allowed is 0 to 1e+07",
    ),
    "limit": (lambda i: i.set(creepage=0.02, normal_load=2e5), SimulationError, "= 200000: allowed is 0 to 100000 N"),
    "not finite": (lambda i: i.set(creepage=np.inf), ValueError, "creepage = inf: a finite number is needed"),
    "no number": (lambda i: i.set(creepage=None), TypeError, "creepage = None: a number, the name of a choice, or"),
    "sequence": (lambda i: i.set(creepage=[0.1]), ValueError, "creepage is a single value"),
    "fixed text": (lambda i: i.set(rail_profile="54E1"), ValueError, "rail_profile is fixed from start() on"),
    "no number to get": (
        lambda i: i.get("rail_profile"),
        ValueError,
        "rail_profile is no number, but of the type String; parameters() has it",
    ),
    "fixed": (lambda i: i.set(wheel_radius=0.4), ValueError, "wheel_radius is fixed from start() on"),
    "output": (lambda i: i.set(traction_force=0.0), ValueError, "traction_force is of kind output"),
    "misspelt": (lambda i: i.set(crepage=0.0), ValueError, "there is no variable crepage; did you mean creepage"),
    "lengths": (
        lambda i: i.follow(["creepage"], [0.0, 1.0], [0.1], 1.0),
        ValueError,
        "before has 2 values for 1 name",
    ),
    "followed": (lambda i: i.follow(["wheel_radius"], [0.0], [0.1], 1.0), ValueError, "a real input is needed"),
    "half-way": (
        lambda i: i.follow(["creepage", "normal_load"], [0.0, 6e4], [0.1, 2e5], 1.0),
        SimulationError,
        "200000: allowed is 0 to 100000 N",
    ),
    "nothing": (lambda i: i.steady([]), ValueError, "at least one variable is needed"),
    "one step": (lambda i: i.steady("traction_force", most=1), ValueError, "at least 2 steps"),
    "tolerance": (lambda i: i.steady("traction_force", relative=-1.0), ValueError, "relative = -1.0"),
    "no input": (
        lambda i: i.derivative("traction_force", "friction_cold"),
        ValueError,
        "the name of an input is needed",
    ),
    "no output": (lambda i: i.derivative(["creepage"], "creepage"), ValueError, "the name of an output is needed"),
    "no state": (lambda i: i.restore((1, 2)), TypeError, "a saved state, its bytes or the path of its file is needed"),
    "no bytes": (lambda i: i.restore(b"wheel"), ValueError, "not a saved state of wheelrail"),
    "no file": (lambda i: i.restore("nowhere.state"), FileNotFoundError, "nowhere.state"),
    "time": (lambda i: setattr(i, "time", "now"), TypeError, "time = 'now'"),
    "another time": (lambda i: setattr(i, "time", 5.0), ValueError, "time = 5.0: the instance is at t = 0.01 s"),
}


@pytest.mark.parametrize(("call", "kind", "message"), REFUSED.values(), ids=REFUSED)
def test_a_refusal_changes_nothing(running, call, kind, message):
    """The error names what was wrong; time, inputs and outputs stay, and the instance goes on as without it."""
    beside = copy.copy(running)
    with pytest.raises(kind, match=re.escape(message)):
        call(running)
    assert (running.time, running.get(*READ)) == (beside.time, beside.get(*READ))
    for instance in (running, beside):
        instance.step(0.01)
    assert running.get(*READ) == beside.get(*READ)


# On the tread and in the flange's root.
TWO_CONTACTS = {"contact_model": "profiles", "slip_source": "vehicle_speed", "vehicle_speed": 20.0, "wheel_speed": 43.5}
TWO_CONTACTS |= {"patch_grid": "fast", "normal_load": 30e3, "lateral_displacement": 5e-3}


def test_derivatives_of_arrays(fmu, fmu3):
    """An array stands for its elements in either version of FMI, each element for itself; absent contacts have 0."""
    arrays = ["contact.normal_force", "contact.peak_pressure"]
    elements = [f"{array}[{index}]" for array in arrays for index in (1, 2, 3, 4)]
    found = []
    for path in (fmu, fmu3):
        with Instance(path, **TWO_CONTACTS).start() as instance:
            instance.step(0.01)
            assert instance.get("contacts") == [2.0]
            found.append(instance.derivative(elements, "normal_load"))
            assert instance.derivative(arrays, "normal_load") == found[-1]
            some = instance.derivative([elements[1], "force_y", elements[4]], "normal_load")
            assert [some[0], some[2]] == [found[-1][1], found[-1][4]]
            for wrong in ("contact.normal_force[5]", "contact.normal_force[0]", "force_y[1]"):
                with pytest.raises(ValueError, match=re.escape(f"there is no variable {wrong}")):
                    instance.derivative([wrong], "normal_load")
            assert found[-1][2:4] == [0.0, 0.0]
            every = [name for name in instance.variables if re.fullmatch(r"contact\.\w+(\[1\])?", name)]
            absent = [instance.get(name.removesuffix("[1]"))[2:] for name in every]
            assert absent == [[0.0, 0.0]] * 21
    assert found[0] == found[1]
    assert min(found[0][:2]) > 0.0


def test_before_the_start(either):
    """What needs a start says so; parameters that do not go together can be mended."""
    instance = Instance(either, friction_hot=0.5, **MOVING)
    for call in (
        lambda: instance.step(1e-3),
        lambda: instance.follow([], [], [], 1.0),
        lambda: instance.steady("time"),
    ):
        with pytest.raises(SimulationError, match=r"\(\): call start\(\) first"):
            call()
    for call in (instance.start, lambda: instance.get("traction_force"), instance.start):
        with pytest.raises(SimulationError, match=r"friction_hot = 0\.5 and friction_cold = 0\.45: .*as it was before"):
            call()
    instance.set(friction_hot=0.2)
    instance.start().step(1e-3)
    assert instance.time == 1e-3


def test_a_step_that_fails_can_be_taken_anew(fmu):
    """What the component cannot do leads to its words, and back to before the step."""
    instance = Instance(fmu, **MOVING).start()
    instance.step(0.01)
    before = instance.get(*READ)
    # Through FMPy, a load that rises beyond what the model is made for within the step.
    rising = [instance.variables["normal_load"].valueReference], [1]
    instance.slave.setRealInputDerivatives(*rising, [1e8])
    with pytest.raises(
        SimulationError, match=r"allowed is 0 to 100000 N; .* the instance is as it was before step\(\)"
    ):
        instance.step(0.01)
    assert (instance.time, instance.get(*READ)) == (0.01, before)
    instance.slave.setRealInputDerivatives(*rising, [0.0])
    instance.step(0.01)


def test_a_contact_that_fills_its_window_is_told_of_once(either):
    """Curvatures of the inputs make the contact broader than the parameters' window: a warning says what sizes it."""
    broad = {"contact_model": "patch", "patch_geometry": "inputs", "transverse_curvature": 0.3}
    with Instance(either, **broad, patch_nodes=14, patch_strips=9) as instance:
        instance.start()
        with pytest.warns(SimulationWarning, match="fills its window.*largest_load, wheel_radius") as told:
            for _ in range(3):
                instance.step(1e-3)
    assert len(told) == 1


def test_a_load_above_the_largest_is_told_of_once(either):
    """A wheel that is set too low carries more than the windows are made for."""
    low = {"contact_model": "profiles", "control": "height", "vertical_displacement": -0.4e-3}
    rolling = {"slip_source": "vehicle_speed", "vehicle_speed": 20.0, "wheel_speed": 43.5}
    told = pytest.warns(SimulationWarning, match="carries more than largest_load = 100000 N")
    with Instance(either, **low, **rolling) as instance, told as warnings:
        instance.start()
        for _ in range(3):
            instance.step(1e-3)
    assert len(warnings) == 1


def test_what_has_no_effect_is_told_of(either):
    """Parameters of profiles where the contact is a line, and a load where the penetration is given."""
    with Instance(either, gauge=1.43, control="penetration", normal_load=50e3) as instance:
        with pytest.warns(SimulationWarning, match="gauge = 1.43 has no effect with contact_model = 1") as told:
            instance.start()
        assert len(told) == 1
        with pytest.warns(SimulationWarning, match="normal_load = 50000 has no effect with control = 2") as told:
            for _ in range(3):
                instance.step(1e-3)
    assert len(told) == 1


def test_a_warning_stands_at_the_callers_line(either):
    """Whatever of the package is called, and however far below the component speaks, the line is that of the call."""
    gauge = {"gauge": 1.43}
    table = {"time": [0.0, 2e-3], "creepage": 0.0}
    curve = {"driven": "longitudinal", "creepages": [0.01], "contact_model": "line"}
    calls = [
        lambda: wheelrail.simulate(table, **gauge, fmu=either),
        lambda: wheelrail.creep_curves(**curve, **gauge, fmu=either),
        lambda: Instance(either, **gauge).start(),
    ]
    for call in calls:
        with pytest.warns(SimulationWarning, match="gauge = 1.43") as told:
            call()
        assert [(one.filename, one.lineno) for one in told] == [(__file__, call.__code__.co_firstlineno)]
    with Instance(either, control="penetration", normal_load=50e3).start() as instance:
        with pytest.warns(SimulationWarning, match="normal_load = 50000") as told:
            wheelrail.simulate(stop_time=2e-3, instance=instance)
        assert [one.filename for one in told] == [__file__]


def test_more_contacts_than_windows_are_told_of_once(either, tmp_path):
    """A hollow wheel on a rail with crests 11 mm apart, of which five touch: one warning, by the first such step."""
    y = np.linspace(-34.0, 34.0, 681)
    waves = 0.05 * np.cos(2.0 * np.pi * y / 11.0)
    files = []
    for kind, (name, radius, height) in enumerate((("rail.prr", 300.0, waves), ("wheel.prw", 300.1, 0.0))):
        # SIMPACK's z points down.
        points = zip(y, radius - np.sqrt(radius**2 - y**2) - height, strict=True)
        rows = "".join(f"{across} {down}\n" for across, down in points)
        files.append(tmp_path / name)
        head = f"header.begin\nversion = 1\ntype = {kind}\nheader.end\n"
        files[-1].write_text(f"{head}spline.begin\npoint.begin\n{rows}point.end\nspline.end\n")
    bodies = {"rail_profile": str(files[0]), "wheel_profile": str(files[1]), "contact_model": "profiles"}
    # The rail's top stands over the running circle.
    place = {"rail_inclination": 0.0, "gauge": 1.451, "gauge_depth": 0.001, "patch_strips": 13}
    rolling = {"slip_source": "vehicle_speed", "vehicle_speed": 20.0, "wheel_speed": 43.478, "normal_load": 10e3}
    with Instance(either, **bodies, **place, **rolling) as instance:
        instance.start()
        instance.step(1e-3)
        instance.set(normal_load=75e3)
        with pytest.warns(SimulationWarning, match="touch in more than four places: those next to each other") as told:
            for _ in range(3):
                instance.step(1e-3)
    assert len(told) == 1


def test_reset_leads_out(running):
    """Terminated through FMPy, an instance says what leads on; reset begins with the start values."""
    running.slave.terminate()
    with pytest.raises(SimulationError, match=r"terminated: restore\(\) a saved state, reset\(\) it, or"):
        running.step(1e-3)
    running.reset().start().step(0.01)
    fresh = Instance(running.fmu, **MOVING).start()
    fresh.step(0.01)
    assert running.get(*READ) == fresh.get(*READ)


def test_what_limits_is_set_first(either):
    """Start values in any order, though one narrows another's range; so with set."""
    for values in ({"normal_load": 120e3, "largest_load": 150e3}, {"largest_load": 150e3, "normal_load": 120e3}):
        instance = Instance(either, **values).start()
        assert instance.get("normal_load", "largest_load") == [120e3, 150e3]
        later = Instance(either)
        later.set(**values)
        assert later.start().get("normal_load") == [120e3]


def test_values_and_names(running, either):
    """Lists of names, arrays under their name in either version, choices and counts, numbers of numpy."""
    assert running.get(["traction_force", "creepage"]) == running.get("traction_force", "creepage")
    assert running.get() == running.get([]) == []
    assert len(running.get("profile.pressure")) == 61
    assert running.get("contact_model", "creepage", "solver.iterations")[:2] == [1, 0.01]
    running.set(creepage=np.float32(0.5), wheel_speed=np.int64(30), normal_load=np.array(5e4))
    assert running.get("creepage", "wheel_speed", "normal_load") == [0.5, 30.0, 5e4]
    table = {"friction_table.temperature": [300.0, 500.0], "friction_table.coefficient": (0.5, 0.3)}
    made = Instance(either, friction_law="table", friction_table_points=2, **table)
    assert made.get("friction_table.temperature")[:2] == [300.0, 500.0]
    assert made.parameters()["friction_table.coefficient"][:2] == [0.5, 0.3]
    with pytest.raises(ValueError, match=r"friction_table"):
        Instance(either, **{"friction_table.temperature": [300.0] * 50})


def test_points_of_the_friction_table(either):
    """Their lists say how many are used, where it is not given; what an instance has makes another one."""
    table = {"friction_table.temperature": [300.0, 400.0, 600.0], "friction_table.coefficient": [0.45, 0.35, 0.2]}
    law = {"friction_law": "table", "creepage": 0.2, "wheel_speed": 60.0, "step": 0.01, "stop_time": 0.1, "fmu": either}
    said, counted = (wheelrail.simulate(parameters=table | points, **law) for points in ({}, {POINTS: 3}))
    assert said["traction_force"].tolist() == counted["traction_force"].tolist()
    fewer = wheelrail.simulate(parameters={name: of[:2] for name, of in table.items()}, **law)
    assert fewer["traction_force"].iloc[-1] > 1.2 * said["traction_force"].iloc[-1]
    made = Instance(either, friction_law="table", **table)
    assert made.get(POINTS) == [3]
    assert Instance(either, **made.parameters()).parameters() == made.parameters()
    # Later one of them may be given alone, if it has as many.
    made.set(**{"friction_table.temperature": [310.0, 400.0, 600.0]})
    with pytest.raises(ValueError, match=r"has 2 values, and friction_table\.coefficient is not given and has 3"):
        made.set(**{"friction_table.temperature": [310.0, 400.0]})
    made.set(**{name: of[:2] for name, of in table.items()})
    assert made.get(POINTS) == [2]


def test_grids_of_a_patch_by_name(either):
    """A grid sets cells and strips where the instance is made, later where the version allows it; none is half set."""
    grids = {name: Instance(either, contact_model="patch", patch_grid=name) for name in ("fast", "default", "fine")}
    cells = {name: instance.get("patch_nodes", "patch_strips") for name, instance in grids.items()}
    assert cells["default"] == Instance(either).get("patch_nodes", "patch_strips")
    assert cells["fast"] == [8, 8]
    assert cells["fine"] > cells["default"] > cells["fast"]
    instance = grids["default"]
    if either.endswith("Contact.fmu"):
        instance.set(patch_grid="fast")
        assert instance.get("patch_nodes", "patch_strips") == [8, 8]
    else:
        with pytest.raises(ValueError, match="length of arrays"):
            instance.set(patch_grid="fast")
    before = instance.get("patch_nodes", "patch_strips")
    with pytest.raises(ValueError, match="patch_grid = 'fat': choose one of fast, default, fine; did you mean"):
        instance.set(patch_grid="fat")
    assert instance.get("patch_nodes", "patch_strips") == before


def test_parameters_make_the_same_instance(running):
    """What `parameters` returns is what an instance is made with."""
    again = Instance(running.fmu, **running.parameters())
    assert again.parameters() == running.parameters()
    assert again.parameters()["friction_law"] == "piecewise_linear"


def test_texts(either, running, tmp_path):
    """Texts and paths, before the start; they are among the parameters, and so in saved states."""
    worn = tmp_path / "räil 1.prr"
    instance = Instance(either, rail_profile=worn, **MOVING)
    instance.set(wheel_profile="cone40", creepage=0.0)
    texts = {"rail_profile": str(worn), "wheel_profile": "cone40"}
    assert texts.items() <= instance.parameters().items()
    instance.start().step(1e-3)
    assert texts.items() <= instance.parameters().items()
    again = Instance.load(instance.save().to_bytes(), either)
    assert texts.items() <= again.parameters().items()
    assert running.parameters()["rail_profile"] == wheelrail.variables(either)["start"]["rail_profile"] == "60E1"
    with pytest.raises(ValueError, match=r"rail_profile = '60E1', in the state '.*1\.prr'"):
        running.restore(instance.save().to_bytes())
    for wrong, kind, message in (
        (5, TypeError, "rail_profile = 5: a text is needed"),
        (b"60E1", TypeError, "a text is needed"),
        (["60E1"], TypeError, "a text is needed"),
        (" ", ValueError, "not blank"),
        ("a\0b", ValueError, "no zero"),
        ("\ud800", ValueError, "surrogates not allowed"),
    ):
        with pytest.raises(kind, match=re.escape(message)):
            Instance(either, rail_profile=wrong)
    with pytest.raises(SimulationError, match=r"rail_profile is too long; allowed is UTF-8 of 1 to 4096 bytes"):
        Instance(either, rail_profile="x" * 5000)


def test_shown(running):
    """A line with the model, the time, the main inputs and outputs; a short one where there is nothing more."""
    text = repr(running)
    for part in ("WheelRailContact", "running, t = 0.01 s", "contact_model = line", "creepage = 0.01", "rad/s"):
        assert part in text
    assert re.search(r"traction_force = [\d.]+ N", text)
    assert repr(running.save()) == "<wheelrail.SavedState of t = 0.01 s, of 'instance'>"


# What is set, and which of these inputs a line about the instance then has.
GIVEN = ("normal_load", "prescribed_penetration", "vertical_displacement", "contact_penetration")
MOTION = ("vehicle_speed", "wheel_speed", "creepage")
USED = {
    "load": ({}, ["normal_load", "wheel_speed", "creepage"]),
    "penetration": ({"control": "penetration"}, ["prescribed_penetration", "wheel_speed", "creepage"]),
    "height of a patch": (
        {"control": "height", "contact_model": "patch", "contact_penetration": 1e-4, "slip_source": "vehicle_speed"},
        ["contact_penetration", "vehicle_speed", "wheel_speed"],
    ),
    "height of a wheel": (
        {"control": "height", "contact_model": "profiles", "slip_source": "vehicle_speed"},
        ["vertical_displacement", "vehicle_speed", "wheel_speed"],
    ),
}


@pytest.mark.parametrize("case", USED)
def test_shown_is_what_is_used(either, case):
    """Load, penetration or height, speed or creepage: what the choices that are made leave unused is not shown."""
    values, used = USED[case]
    with Instance(either, **values).start() as instance:
        assert [name for name in (*GIVEN, *MOTION) if f"{name} = " in repr(instance)] == used


# ---- states ----------------------------------------------------------------------------------------------------------


def test_state_in_another_process(running, fmu, fmu3, tmp_path):
    """A file leads to the same bits in another process, under either version of FMI, with all parameters."""
    running.set(friction_cold=0.4)
    state = tmp_path / "contact.state"
    running.save().write(state)
    running.step(0.01)
    program = """
import sys
from wheelrail import Instance, SavedState
made = Instance.load(sys.argv[1], sys.argv[2])
made.step(0.01)
# And in one that was made for it, whose tunable parameters may differ.
other = Instance(sys.argv[2]).start()
other.restore(SavedState.read(sys.argv[1]))
other.step(0.01)
print([made.time, *made.get(*sys.argv[3:])] == [other.time, *other.get(*sys.argv[3:])], made.get(*sys.argv[3:]))
"""
    for path in (fmu, fmu3):
        assert in_a_process(program, state, path, *READ) == f"True {running.get(*READ)}\n"


@pytest.mark.parametrize("contact_model", ["line", "patch"])
@pytest.mark.parametrize("by", [copy.copy, copy.deepcopy, lambda thing: pickle.loads(pickle.dumps(thing))])
def test_copies(either, by, contact_model):
    """Copied or pickled, an instance goes on by itself, with what a derived class holds; a state is one as before."""
    instance = Named(either, contact_model=contact_model, patch_nodes=14, patch_strips=7, **MOVING).start()
    instance.step(0.01)
    instance.label = ["a"]
    saved = instance.save()
    twin = by(instance)
    assert (type(twin), twin.label, twin.time) == (Named, ["a"], 0.01)
    results = []
    for stepped in (instance, twin):
        stepped.step(0.01)
        results.append(stepped.get(*READ))
    twin.restore(by(saved))
    assert twin.time == 0.01
    twin.step(0.01)
    assert [*results, twin.get(*READ)] == [results[0]] * 3
    # Before its start, too.
    early = by(Instance(either, **MOVING)).start()
    assert early.time == 0.0


class Named(Instance):
    """A class of somebody's own."""

    label: list


def test_state_of_another_instance(running):
    """It leads on where the fixed parameters are the same; where not, the first one that differs is named."""
    saved = running.save()
    other = Instance(running.fmu).start()
    other.restore(saved)
    assert other.get(*READ) == running.get(*READ)
    with pytest.raises(ValueError, match="kept by another instance: forget it there"):
        other.forget(saved)
    finer = Instance(running.fmu, contact_nodes=81).start()
    with pytest.raises(ValueError, match=r"contact_nodes = 81, in the state 51: Instance\.load makes"):
        finer.restore(saved)
    finer.step(1e-3)


def test_forgotten_and_damaged(running, tmp_path):
    """A state that was forgotten, or whose bytes are not what they were, is refused."""
    saved = running.save()
    data = saved.to_bytes()
    running.forget(saved)
    running.forget(saved)
    for call in (lambda: running.restore(saved), saved.to_bytes):
        with pytest.raises(ValueError, match=r"the state of t = 0\.01 s was forgotten: save another one"):
            call()
    for at in (0, 25, 100, len(data) - 1):
        damaged = data[:at] + bytes([data[at] ^ 1]) + data[at + 1 :]
        (tmp_path / "damaged").write_bytes(damaged)
        for given in (damaged, data[:at], tmp_path / "damaged"):
            with pytest.raises(ValueError, match="state"):
                running.restore(given)
    running.restore(SavedState.from_bytes(data))


# ---- threads and processes -------------------------------------------------------------------------------------------


def test_threads_take_turns(running):
    """While one thread is in a call another one waits; no step is lost."""
    busy, inside = threading.Event(), []
    original = type(running.slave).doStep

    def step(slave, *arguments):
        assert not inside, "two threads at once"
        inside.append(1)
        busy.wait(0.001)
        original(slave, *arguments)
        inside.pop()

    running.slave.doStep = step.__get__(running.slave)
    errors = []

    def work():
        try:
            for _ in range(50):
                running.step(1 / 1024)
                running.get(*READ)
        except BaseException as error:
            errors.append(error)

    threads = [threading.Thread(target=work) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert errors == []
    assert running.time == pytest.approx(0.01 + 200 / 1024, rel=1e-12)


needs_fork = pytest.mark.skipif(not hasattr(os, "fork"), reason="the system does not fork")


@needs_fork
def test_forked_process_has_its_own(fmu):
    """Child and parent go on from the fork, each for itself; neither takes the other's files away."""
    program = """
import os, sys
from wheelrail import Instance
contact = Instance(sys.argv[1], creepage=0.01).start()
contact.step(0.01)
child = os.fork()
contact.step(0.01)
other = Instance(sys.argv[1]).start()
print(contact.get("traction_force", "peak_temperature"), flush=True)
if not child:
    sys.exit()
assert os.waitpid(child, 0)[1] == 0
contact.step(0.01)
Instance(sys.argv[1]).start().step(0.01)
"""
    first, second = in_a_process(program, fmu).splitlines()
    assert first == second


@needs_fork
def test_nothing_unpacked_is_left_behind(fmu, tmp_path, monkeypatch):
    """What processes unpack goes at their end: the first, its forks, and those of multiprocessing."""
    program = """
import multiprocessing, os, sys
from concurrent.futures import ProcessPoolExecutor
from wheelrail import Instance
def temperature(fmu):
    return Instance(fmu).start().get("peak_temperature")
fork = multiprocessing.get_context("fork")
with ProcessPoolExecutor(2, fork) as pool:
    print(*pool.map(temperature, 2 * sys.argv[1:]))
process = fork.Process(target=temperature, args=sys.argv[1:])
process.start()
process.join()
child = os.fork()
print(temperature(sys.argv[1]), flush=True)
if child:
    os.waitpid(child, 0)
"""
    monkeypatch.setenv("TMPDIR", str(tmp_path))
    assert len(in_a_process(program, fmu).splitlines()) == 3
    assert list(tmp_path.iterdir()) == []


@needs_fork
def test_fork_during_a_call_of_another_thread(fmu):
    """What the other thread was in the midst of is no whole instance in the child, which says so instead of waiting."""
    program = """
import os, sys, threading
from wheelrail import Instance, InstanceClosedError
contact = Instance(sys.argv[1]).start()
held, done = threading.Event(), threading.Event()
def hold():
    with contact.slave.lock:
        held.set()
        done.wait()
threading.Thread(target=hold).start()
held.wait()
child = os.fork()
if not child:
    try:
        contact.step(0.01)
    except InstanceClosedError as error:
        print(error, flush=True)
    del contact
    os._exit(0)
assert os.waitpid(child, 0)[1] == 0
done.set()
contact.step(0.01)
"""
    assert "forked while another thread was in a call" in in_a_process(program, fmu)


def test_logger_of_others(fmu):
    """A simulation by FMPy in the same process, whose logger is freed after it, has no effect on what an instance says.

    FMPy's native part goes on with the logger that it was told last, freed or not (0.3.32).
    """
    program = """
import gc, sys
import fmpy, wheelrail
contact = wheelrail.Instance(sys.argv[1]).start()
fmpy.simulate_fmu(sys.argv[1], stop_time=0.01, logger=lambda *arguments: None)
gc.collect()
spoiled = [bytes(1000) for _ in range(100000)]
try:
    contact.set(normal_load=5e5)
except wheelrail.SimulationError as error:
    print(error)
"""
    assert "normal_load = 500000: allowed is 0 to 100000 N" in in_a_process(program, fmu)


# ---- the FMU ---------------------------------------------------------------------------------------------------------


def test_no_fmu(tmp_path, monkeypatch):
    """A path that leads nowhere, to something else, or is none; the folder of the process stays."""
    monkeypatch.chdir(tmp_path)
    Path("text.fmu").write_text("no archive")
    with zipfile.ZipFile("empty.fmu", "w") as archive:
        archive.writestr("readme", "no model")
    for path, kind, message in [
        ("nowhere.fmu", FileNotFoundError, "nowhere.fmu is not there"),
        ("text.fmu", ValueError, "text.fmu is no FMU: an FMU is a zip archive"),
        ("empty.fmu", ValueError, "empty.fmu is no FMU that can be read"),
        (str(tmp_path), ValueError, "is no FMU"),
        (5, TypeError, "fmu = 5: the path of an FMU is needed"),
        (b"text.fmu", TypeError, "the path of an FMU is needed"),
    ]:
        with pytest.raises(kind, match=message):
            Instance(path)
    assert Path.cwd() == tmp_path


@pytest.mark.parametrize(
    ("there", "message"),
    [
        (False, r"Cannot find shared library .* Platforms of the FMU: elsewhere"),
        # FMPy stays in the library's folder where it cannot be loaded (0.3.32).
        (True, r"Failed to load shared library .* Platforms of the FMU: elsewhere, "),
    ],
)
def test_fmu_without_this_platform(either, tmp_path, monkeypatch, there, message):
    """Without a library, or with one that cannot be loaded, the error names the platforms that there are."""
    monkeypatch.chdir(tmp_path)
    with zipfile.ZipFile(either) as whole, zipfile.ZipFile("other.fmu", "w") as other:
        for name in whole.namelist():
            if there or not name.startswith("binaries/"):
                other.writestr(name, b"nothing" if name.startswith("binaries/") else whole.read(name))
        other.writestr("binaries/elsewhere/wheelrail.so", b"nothing")
    with pytest.raises(SimulationError, match=message):
        Instance("other.fmu")
    assert Path.cwd() == tmp_path


def test_presets():
    """A set with values in place of its own; what was meant."""
    wet = wheelrail.preset("wet")
    assert wheelrail.preset("wet", friction_cold=0.2, wheel_heating="on") == wet | {
        "friction_cold": 0.2,
        "wheel_heating": "on",
    }
    with pytest.raises(ValueError, match=r"choose one of contaminated, dry, eurosprinter, wet; did you mean wet\?"):
        wheelrail.preset("wett")
    with pytest.raises(ValueError, match="there is none of this name"):
        wheelrail.preset("../presets/wet")
    with pytest.raises(TypeError, match="its name is a text"):
        wheelrail.preset(5)
