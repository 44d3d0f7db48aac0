"""studies/mileage: results of another plan under a name are kept, and those of a shorter one gone on from."""

import sys
from contextlib import nullcontext
from dataclasses import replace

import mileage
import numpy as np
import pytest
from dask_runs import read_component
from helpers import FMU3, wheelrail
from mileage_line import BadInputError, Curve
from mileage_march import march, read_state, state_file
from mileage_plan import OtherPlanError, differences, plan_file, read_plan
from mileage_wheels import NewWheel

# The plan of the command line with these options.
OPTIONS = ["--small", "--distance", "2", "--samples", "1", "--samples-straight", "1", "--name", "mine"]
PLAN = mileage.small_plan(distance=2e3, samples=1, samples_straight=1)


@pytest.fixture(scope="module")
def component():
    """Return the component and its digest."""
    return read_component(FMU3)


@pytest.fixture
def work(component, tmp_path, monkeypatch):
    """Return the folder in which the command line has a run of that plan."""
    monkeypatch.setattr(mileage, "WORK", tmp_path)
    assert march(None, PLAN, tmp_path / "mine", component) == 1
    return tmp_path


class ReachedError(Exception):
    """The command line begins to compute."""


def refused(monkeypatch, options):
    """What the command line says that refuses options before it has workers."""

    def reached(*_):
        raise ReachedError

    monkeypatch.setattr(mileage, "client_for", reached)
    monkeypatch.setattr(sys, "argv", ["mileage", *options])
    with pytest.raises(SystemExit) as caught:
        mileage.main()
    return caught.value.code


def contents(folder):
    """All files with what is in them."""
    return {path.name: path.read_bytes() for path in folder.iterdir()}


def test_results_of_another_plan_are_kept(component, work, monkeypatch):
    """Name, folder, what differs and the ways out are said, and all files stay as they are."""
    folder = work / "mine"
    before = contents(folder)
    ways = "; another --name keeps them, --fresh forgets them"
    there = f"mileage: --name mine: {folder} has results of another plan: "
    for options, words in (
        (["--distance", "1"], "distance = 2 km there, 1 km here"),
        (["--largest-depth", "0.1"], "largest_depth = 0.04 mm there, 0.1 mm here"),
        (["--wear-law", "archard"], "parameters: wear_law = energy there, archard here"),
        (["--set", "gauge=1.43"], "parameters: gauge = nothing there, 1.43 here"),
        (["--distance", "3", "--samples", "2"], "distance = 2 km there, 3 km here; samples = 1 there, 2 here"),
    ):
        assert refused(monkeypatch, OPTIONS + options) == there + words + ways
    # From Python likewise.
    faster = replace(PLAN, vehicle=replace(PLAN.vehicle, half_wheelbase=1.3))
    with pytest.raises(OtherPlanError, match=r"vehicle: half_wheelbase = 1\.28 there, 1\.3 here$"):
        march(None, faster, folder, component)
    assert contents(folder) == before
    # The same plan and --fresh begin to compute, and so does another name.
    for options in (
        [],
        ["--set", "patch_nodes=10"],
        ["--fresh", "--distance", "1"],
        ["--distance", "1", "--name", "b"],
    ):
        with pytest.raises(ReachedError):
            refused(monkeypatch, OPTIONS + options)
    # As versions left it that did not keep the plan.
    plan_file(folder).unlink()
    assert "has results of another plan: it does not say which; another --name" in refused(monkeypatch, OPTIONS)


# On this rail a contact fills its window, which is told; what wears is of no interest here.
@pytest.mark.filterwarnings("ignore:.*fills its window:wheelrail.SimulationWarning")
def test_another_file_of_the_rail(component, tmp_path):
    """Of a rail from a file name and points count, and not its folder; a plan keeps those that it has read."""
    new, digest, path = NewWheel.of(PLAN.wheel), component[1], tmp_path / "rail.prr"

    def planned(rail):
        return replace(PLAN, parameters=PLAN.parameters | {"rail_profile": str(rail)})

    def parameters(plan):
        return plan.described(digest, new)["parameters"]

    wheelrail.Profile("54E1").write(path)
    (tmp_path / "other").mkdir()
    (tmp_path / "other" / "rail.prr").write_bytes(path.read_bytes())
    plan = planned(path)
    assert parameters(plan)["rail_profile"].startswith("rail.prr (")
    assert planned(tmp_path / "other" / "rail.prr").stamp(digest, new) == plan.stamp(digest, new)
    folder = tmp_path / "run"
    assert march(None, plan, folder, component) == 1
    wheelrail.Profile("60E1").write(path)
    with pytest.raises(OtherPlanError, match=r"parameters: rail_profile = rail\.prr \(.*there, rail\.prr \(.*here$"):
        march(None, planned(path), folder, component)
    assert march(None, plan, folder, component) == 1
    # Of one that is built in the name is enough.
    assert parameters(planned("54E1"))["rail_profile"] == "54E1"
    assert "rail_profile" not in parameters(PLAN)


def test_fresh_study_keeps_other_runs(work, monkeypatch):
    """Without options it forgets what is its own."""
    (work / "hills").mkdir()
    before = contents(work / "mine")
    monkeypatch.setattr(mileage, "client_for", lambda *_: nullcontext())
    monkeypatch.setattr(mileage, "study", lambda *_: None)
    monkeypatch.setattr(sys, "argv", ["mileage", "--fresh"])
    mileage.main()
    assert not (work / "hills").exists()
    assert contents(work / "mine") == before


def test_runs_of_the_study_have_their_names(component, tmp_path, monkeypatch):
    """No run of the user's own can be called as one of them is."""
    monkeypatch.setattr(mileage, "WORK", tmp_path)
    monkeypatch.setattr(mileage, "first_rates", lambda *_: (np.ones((4, 1)), {}))
    named = []

    def marched(_client, _plan, folder, _component):
        named.append(folder.name)
        if len(named) == len(mileage.STUDY) - 1:
            raise ReachedError

    monkeypatch.setattr(mileage, "march", marched)
    with pytest.raises(ReachedError):
        mileage.study(None, component)
    assert {*named, "new_wheels"} == set(mileage.STUDY)


def test_longer_run_goes_on(component, work, monkeypatch):
    """A larger distance alone goes on behind the last step, which stays as it is; then the shorter one is refused."""
    folder = work / "mine"
    first, said = state_file(folder, 1).read_bytes(), []
    with pytest.raises(ReachedError):
        refused(monkeypatch, [*OPTIONS, "--distance", "3"])
    assert march(None, replace(PLAN, distance=3e3), folder, component, said.append) == 2
    assert said[0] == "  1 steps, 2 km, are there from before"
    assert state_file(folder, 1).read_bytes() == first
    assert read_state(state_file(folder, 2)).distance == 3e3
    assert read_plan(folder)["distance"] == 3e3
    assert "distance = 3 km there, 2 km here" in refused(monkeypatch, OPTIONS)


def test_run_without_a_step_is_no_result(component, work, monkeypatch):
    """What failed in its first step has nothing to keep."""
    state_file(work / "mine", 1).unlink()
    with pytest.raises(ReachedError):
        refused(monkeypatch, [*OPTIONS, "--samples", "2"])


def test_differences_of_lines():
    """Classes that one line lacks, and values in the units of a line's table; of many the first ones are said."""
    curve = Curve(-500.0, 0.11, 85.0 / 3.6, 0.3)
    line = {"R 500 right": vars(curve)}
    other = {"R 500 right": vars(replace(curve, speed=80.0 / 3.6, cant=0.1)), "straight": {"share": 0.7}}
    error = OtherPlanError("there", differences({"line": line}, {"line": other}))
    words = "cant = 110 mm there, 100 mm here; line: R 500 right: speed = 85 km/h there, 80 km/h here"
    straight = "line: straight = nothing there, 70 % of the line here"
    assert str(error) == f"there has results of another plan: line: R 500 right: {words}; {straight}"
    assert isinstance(error, BadInputError)
    many = differences({}, {"vehicle": 1.0, "a": 1.0, "b": 1.0, "c": 1.0, "d": 1.0, "e": 1.0})
    assert str(OtherPlanError("there", many)).endswith("c = nothing there, 1 here; 2 more")
