"""tools/bits.py: a record is the same in every process, and a comparison notices a last bit."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

TOOLS = Path(__file__).resolve().parent.parent / "tools"
sys.path.insert(0, str(TOOLS))

import bits  # noqa: E402
from bits_scenarios import scenarios  # noqa: E402

# Scenarios of both contacts, restored, lifted, with a step that is refused.
CHOSEN = ("memory, layer", "restarted", "refused")


@pytest.fixture(scope="module")
def records(fmu, tmp_path_factory):
    """Two records of the chosen scenarios, each from a process of its own."""
    paths = [tmp_path_factory.mktemp("bits") / f"{number}.npz" for number in range(2)]
    chosen = [option for words in CHOSEN for option in ("--only", words)]
    for path in paths:
        subprocess.run([sys.executable, TOOLS / "bits.py", "record", fmu, path, *chosen], check=True, timeout=300)
    return paths


def test_two_processes_record_the_same_bits(records):
    """Nothing of a record hangs on where the memory lies, the time of day, or the instance before."""
    assert bits.compare(*records)
    with np.load(records[0]) as record:
        names = {key.partition(":")[0] for key in record if not key.startswith("names: ")}
        chosen = [scenario for scenario in scenarios() if any(words in scenario.name for words in CHOSEN)]
        assert names == {scenario.name for scenario in chosen}
        assert {scenario.name.split(",")[0] for scenario in chosen} == {"line", "patch"}
        for scenario in chosen:
            steps, refused = len(record[f"{scenario.name}: outputs"]), "refused" in scenario.name
            assert steps == (10 if refused else len(scenario.steps)), scenario.name


@pytest.mark.parametrize("quantity", bits.QUANTITIES)
@pytest.mark.parametrize("contact", ["line", "patch"])
def test_a_changed_last_bit_is_noticed(records, tmp_path, capsys, contact, quantity):
    """One bit of one value is a difference, and the scenario is named; unless its quantity is left out."""
    key = f"{contact}, everything, restarted: {quantity}"
    with np.load(records[0]) as record:
        changed = {name: record[name].copy() for name in record}
    flat = changed[key].reshape(-1).view(np.uint8)
    flat[flat.size // 2 // 8 * 8] ^= 1
    path = tmp_path / "changed.npz"
    np.savez(path, **changed)
    assert not bits.compare(records[1], path)
    said = capsys.readouterr().out
    assert said.startswith(key + ": "), said
    assert len(said.splitlines()) == 2, said
    assert bits.compare(records[1], path, left_out=[quantity])


def test_a_step_less_and_a_scenario_less_are_noticed(records, tmp_path, capsys):
    """A step that fails where it did not, and records of other scenarios, are differences."""
    with np.load(records[0]) as record:
        whole = {name: record[name] for name in record}
    key = "patch, everything, restarted: outputs"
    path = tmp_path / "less.npz"
    np.savez(path, **(whole | {key: whole[key][:-1]}))
    assert not bits.compare(records[1], path)
    steps, outputs = whole[key].shape
    assert f"({steps}, {outputs}) against ({steps - 1}, {outputs})" in capsys.readouterr().out
    del whole[key]
    np.savez(path, **whole)
    assert not bits.compare(path, records[1])


def test_a_state_that_is_not_restored_is_noticed(unpacked, description, monkeypatch):
    """A second instance that goes on from its own start ends the recording, by the scenario's name."""
    scenario = next(s for s in scenarios() if s.name == "patch, everything, restarted")
    monkeypatch.setattr(bits.Component, "restore", lambda *_: None)
    with pytest.raises(SystemExit, match="patch, everything, restarted: restoring the state changes outputs: "):
        bits.results_of(str(unpacked), description, scenario)
