"""Whatever a user of the Python package calls may be refused, with an error that is documented; none ends the process.

Each seed is a sequence of calls with good and bad arguments, on instances of both contact models through both versions
of FMI. The sequences run in processes of their own, which say each seed before it begins: of one that ends the process,
or hangs, the seed is known. From the root of the repository:

    python python_tests/test_random_calls.py --seeds 0 1000      what the test does, in this process
    python python_tests/test_random_calls.py --replay 137        one sequence, each call with its answer
    python python_tests/test_random_calls.py --soak 3600         new seeds for so many seconds, from 1000 on

Exit status 1: a call raised what the package does not document, changed something though it was refused, or left an
instance that nothing leads out of.
"""

import argparse
import copy
import faulthandler
import math
import pickle
import random
import subprocess
import sys
import tempfile
import threading
import time
from itertools import pairwise
from pathlib import Path

import numpy as np
from fmpy.fmi1 import FMICallException

REPOSITORY = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(REPOSITORY / "python"))

import wheelrail  # noqa: E402
from wheelrail import Instance, SavedState, SimulationError  # noqa: E402

FMUS = [REPOSITORY / "target" / name for name in ("WheelRailContact.fmu", "WheelRailContact-fmi3.fmu")]
# What the package documents.
REFUSALS = (SimulationError, ValueError, TypeError, OSError)
SEEDS, BATCHES = 1000, 2
# s; a hundred times what a batch takes: only a hang is that long.
LIMIT = 900.0
COARSE = {"contact_nodes": 25, "depth_nodes": 17, "patch_nodes": 10, "patch_strips": 5}
INPUTS = ("wheel_speed", "normal_load", "creepage", "vehicle_speed", "friction_scale", "incoming_temperature")
OUTPUTS = ("traction_force", "friction_torque", "peak_temperature", "penetration", "wear_depth")
OTHERS = ("contact_model", "solver.iterations", "solver.residual", "profile.pressure", "patch.pressure", "patch_nodes")
PARAMETERS = (
    "friction_cold",
    "wheel_radius",
    "contact_nodes",
    "patch_nodes",
    "friction_law",
    "friction_table.temperature",
    "rail_profile",
)
NO_NAMES = ("traction_forc", "", "time", "profile.pressure[0]", "\0", "é", 5, None, b"creepage", ("creepage",), 1.5)
NO_NUMBERS = (
    math.nan,
    math.inf,
    -math.inf,
    -1.0,
    1e308,
    10**400,
    "abc",
    "1e-3",
    "",
    None,
    {},
    [],
    [1.0, 2.0],
    object(),
)
NO_NUMBERS += (np.array([1.0, 2.0]), np.array("a"), b"1", 1j, True, np.bool_(True), {1.0}, "line", -(10**30), 2**63)
GOOD = {
    "wheel_speed": (0.0, 21.7, 40.0, np.float64(30.0), 25),
    "normal_load": (10e3, 60e3, 120e3, np.float32(5e4)),
    "creepage": (-0.02, 0.0, 1e-3, 0.05),
    "vehicle_speed": (0.0, 10.0, 30.0),
    "friction_scale": (0.5, 1.0),
    "incoming_temperature": (293.15, 400.0),
    "friction_cold": (0.45, 0.5),
    "wheel_radius": (0.4, 0.46),
    "contact_nodes": (25, 31.0),
    "patch_nodes": (10, 12),
    "friction_law": ("constant", 1, "piecewise_linear"),
    "friction_table.temperature": ([300.0, 400.0], np.array([300.0, 500.0])),
    "rail_profile": ("60E1", Path("worn.prr")),
}


class Sequence:
    """A sequence of calls: what it draws from, and the instances, states and bytes that it has made."""

    def __init__(self, seed, folder, say=lambda text: None):
        """Of a seed; files go into a folder."""
        self.draw, self.folder, self.say = random.Random(seed), folder, say
        self.instances, self.states, self.bytes = [], [], [b"", b"wheelrail state 1 00000000\n{}"]

    # ---- arguments, mostly good ones ---------------------------------------------------------------------------------

    def bad(self):
        """Whether the next argument is a bad one."""
        return self.draw.random() < 0.1

    def name(self, *kinds):
        """Name of a variable of some kinds, or what is none."""
        return self.draw.choice(NO_NAMES if self.bad() else [name for kind in kinds for name in kind])

    def number(self, *good):
        """A number, or what is none."""
        return self.draw.choice(NO_NUMBERS if self.bad() else good)

    def values(self, *kinds):
        """Values by name, of which one may be bad: keywords are texts."""
        names = [str(self.name(*kinds)) for _ in range(self.draw.randrange(4))]
        return {name: self.number(*GOOD.get(name, (1.0,))) for name in names}

    def seconds(self):
        """The length of a step, or what is none."""
        return self.number(*[1e-3, 0.01, 1] * 5, 5.0, 1e-9, 1e5, 1e300, 5e-324, 0, 0.0, -1e-3)

    def names(self, *kinds):
        """Names of variables of some kinds in some form, or what is none."""
        names = [self.name(*kinds) for _ in range(self.draw.randrange(4))]
        forms = [names, tuple(names), "traction_force", np.array(["penetration"])]
        return self.draw.choice([None, 5, {"a": 1}, b"a"] if self.bad() else forms)

    def instance(self):
        """An instance, in any phase or closed; one that runs most often."""
        if not self.instances:
            return Instance(FMUS[0], **COARSE)
        going = [instance for instance in self.instances if instance.slave.phase.name == "RUNNING"]
        return self.draw.choice(going if going and self.draw.random() < 0.8 else self.instances)

    def state(self):
        """A saved state of some instance, bytes or a file, or what is none."""
        found = [*self.states, *self.bytes, self.folder / "state", self.folder / "nowhere", None, 5, (1, 2)]
        return self.states[-1] if self.states and not self.bad() else self.draw.choice(found)

    # ---- calls -------------------------------------------------------------------------------------------------------

    def make(self):
        """A new instance, which is started or not."""
        fmu = self.draw.choice(FMUS)
        if self.draw.random() < 0.1:
            fmu = self.draw.choice([REPOSITORY / "Makefile", REPOSITORY, "nowhere.fmu", 5, b"x", ""])
        model = self.draw.choice(["line", "patch"])
        extra = self.values(INPUTS, PARAMETERS) if self.draw.random() < 0.3 else {}
        start = self.draw.choice([0.0, 1.0, -5]) if self.draw.random() < 0.9 else self.seconds()
        made = Instance(fmu, self.draw.choice(["a", "é\0", "b"]), start, **{"contact_model": model} | COARSE | extra)
        self.instances.append(made)
        if self.draw.random() < 0.9:
            made.start()

    def start(self):
        """Start, again or not."""
        self.instance().start()

    def get(self):
        """Read variables, one by one or as a list."""
        self.instance().get(*[self.name(OUTPUTS, INPUTS, PARAMETERS, OTHERS) for _ in range(self.draw.randrange(4))])
        self.instance().get(self.names(OUTPUTS, OTHERS))

    def set(self):
        """Set inputs and parameters."""
        self.instance().set(**self.values(INPUTS, PARAMETERS))

    def step(self):
        """Step on."""
        self.instance().step(self.seconds())

    def follow(self):
        """Step on with inputs that move, of other numbers than names sometimes."""
        names = [self.name(INPUTS) for _ in range(self.draw.randrange(3))]
        ends = [[self.number(*GOOD.get(name, (1.0,))) for name in names] for _ in range(2)]
        if self.bad():
            ends[0] = self.draw.choice([None, 5, "abc", [1.0] * 5, {}])
        self.instance().follow(names, *ends, self.seconds())

    def steady(self):
        """Step until variables rest."""
        self.instance().steady(
            self.names(OUTPUTS), self.seconds(), self.number(1e-3, 0.0), self.number(0.0), self.number(2, 3)
        )

    def derivative(self):
        """Derivatives, also with respect to what is no input."""
        self.instance().derivative(self.names(OUTPUTS), self.name(INPUTS, PARAMETERS if self.bad() else INPUTS))

    def fields(self):
        """Fields of a patch."""
        self.instance().fields()

    def parameters(self):
        """All parameters."""
        self.instance().parameters()

    def save(self):
        """Save the state."""
        self.states.append(self.instance().save())

    def restore(self):
        """Go back to a state, of this instance or of another one."""
        instance, state = self.instance(), self.state()
        own = [kept for kept in self.states if kept._instance is instance]
        instance.restore(self.draw.choice(own) if own and self.draw.random() < 0.5 else state)

    def forget(self):
        """Free a state, once or twice, or lose it."""
        state = self.state()
        self.instance().forget(state)
        if self.draw.random() < 0.5 and state in self.states:
            self.states.remove(state)

    def lose(self):
        """Refer no more to a state or an instance, or to all of them."""
        kept = self.draw.choice([self.states, self.instances])
        if kept:
            del kept[self.draw.randrange(len(kept)) :]

    def serialise(self):
        """The bytes of a state, whole or damaged; in a file, too."""
        if self.states:
            state = self.draw.choice(self.states)
            data = state.to_bytes()
            state.write(self.draw.choice([self.folder / "state", self.folder / "state", self.folder]))
            if self.bad():
                at = self.draw.randrange(len(data))
                data = self.draw.choice([data[:at], data[:at] + bytes([data[at] ^ 1]) + data[at + 1 :], data + b"x"])
            self.bytes.append(data)

    def load(self):
        """An instance of a state."""
        self.instances.append(Instance.load(self.state(), self.draw.choice(FMUS)))

    def duplicate(self):
        """Copy or pickle an instance or a state."""
        thing = self.state() if self.draw.random() < 0.3 else self.instance()
        made = self.draw.choice([copy.copy, copy.deepcopy, lambda thing: pickle.loads(pickle.dumps(thing))])(thing)
        if isinstance(made, Instance):
            self.instances.append(made)
        elif isinstance(made, SavedState):
            self.states.append(made)

    def show(self):
        """What a debugger shows."""
        for thing in (*self.instances, *self.states):
            assert repr(thing)

    def reset(self):
        """Back to before the start."""
        self.instance().reset()

    def close(self):
        """Close, once or twice."""
        self.instance().close()

    def within(self):
        """Use in a `with`, and after it."""
        with self.instance() as instance:
            instance.step(self.seconds())
        instance.get("traction_force")

    def move(self):
        """Set the time."""
        self.instance().time = self.number(0.0, 1.0)

    def beside(self):
        """Use by two threads at once."""
        instance, errors = self.instance(), []

        def work():
            try:
                for _ in range(3):
                    instance.step(1e-3)
                    instance.get(*OUTPUTS)
            except REFUSALS:
                pass
            except BaseException as error:
                errors.append(error)

        threads = [threading.Thread(target=work) for _ in range(2)]
        for thread in threads:
            thread.start()
        if self.bad():
            instance.close()
        for thread in threads:
            thread.join()
        for error in errors:
            raise error

    def low_level(self):
        """FMPy's methods on what lies below."""
        slave = self.instance().slave
        call = self.draw.choice(["reset", "terminate", "freeInstance", "exitInitializationMode", "getFMUState"])
        try:
            getattr(slave, call)()
        except FMICallException as error:
            # FMPy's own.
            raise SimulationError(str(error)) from error

    def module(self):
        """What the package has beside instances."""
        fmu = self.draw.choice([*FMUS, REPOSITORY / "Makefile", "nowhere.fmu"])
        call = self.draw.randrange(6)
        if call == 0:
            wheelrail.preset(self.draw.choice(["wet", "wett", "", "../wet", None, 5]), friction_cold=0.2)
        elif call == 1:
            wheelrail.fmu_path(self.draw.choice(["2.0", "3.0", "4.0", 2.0, None]))
        elif call == 2:
            wheelrail.example(self.draw.choice(["braking", "brakin", "", None]))
        elif call == 3:
            wheelrail.variables(fmu)
        elif call == 4:
            table = {"time": [0.0, 0.01], self.draw.choice(INPUTS): [self.number(1.0), 1.0]}
            wheelrail.simulate(table, step=5e-3, fmu=fmu, **COARSE | self.values(PARAMETERS))
        else:
            wheelrail.simulate({"time": [0.0, 10.0]}, step=1.0, instance=self.instance())

    CALLS = ("make", "start", "get", "set", "set", "step", "step", "step", "follow", "follow", "steady", "derivative")
    CALLS += ("fields", "parameters", "save", "save", "restore", "restore", "forget", "lose", "serialise", "load")
    CALLS += ("duplicate", "show", "reset", "close", "within", "move", "beside", "low_level", "module")
    # These go on by themselves until something is refused; or it is the others' calls that change something.
    PARTIAL = ("make", "get", "steady", "within", "beside", "low_level", "module", "close", "lose", "load", "move")

    def run(self):
        """All calls, and what must hold after each."""
        self.attempt("make")
        for _ in range(self.draw.randrange(4, 13)):
            self.attempt(self.draw.choice(self.CALLS))
        for instance in self.draw.sample(self.instances, min(1, len(self.instances))):
            if instance.slave.gone is None:
                lead_out(instance)

    def attempt(self, name):
        """One call: refused with an error of the package, it has changed nothing."""
        before = [seen(instance) for instance in self.instances]
        kept = list(self.instances)
        try:
            getattr(self, name)()
            self.say(f"{name}")
        except REFUSALS as error:
            self.say(f"{name}: {type(error).__name__}: {error}")
            assert not isinstance(error, OSError) or name in (
                "make",
                "module",
                "serialise",
                "restore",
                "load",
                "forget",
            )
            # Not a refusal of the interpreter's, for one of those that the package should have made.
            assert "argument 2" not in str(error), error
            if name not in self.PARTIAL:
                for instance, was in zip(kept, before, strict=True):
                    assert seen(instance) == was, f"{name} was refused, and changed {was} to {seen(instance)}"


def seen(instance):
    """What an instance shows: its phase, time, and where it runs its inputs and outputs."""
    if instance.slave.gone is not None:
        return "closed"
    phase = instance.slave.phase.name
    return phase, instance.time, instance.get(*INPUTS, *OUTPUTS) if phase == "RUNNING" else None


def lead_out(instance):
    """From wherever it is, an instance begins anew with parameters that make a model."""
    instance.reset()
    good = {
        "friction_cold": 0.45,
        "friction_hot": 0.1,
        "friction_law": "constant",
        "creepage": 0.0,
        "normal_load": 60e3,
    }
    instance.set(**good)
    instance.start().step(1e-3)


def run(seeds, say=lambda text: None, until=math.inf):
    """Run sequences; return the messages of those that went wrong."""
    wrong = []
    with tempfile.TemporaryDirectory() as folder:
        for seed in seeds:
            if time.monotonic() > until:
                break
            print(seed, flush=True)
            try:
                Sequence(seed, Path(folder), say).run()
            except Exception as error:
                wrong.append(f"seed {seed}: {type(error).__name__}: {error}")
                if say is print:
                    raise
    return wrong


def main():
    """Run from the command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", nargs=2, type=int, metavar=("FIRST", "END"))
    parser.add_argument("--replay", type=int, metavar="SEED")
    parser.add_argument("--soak", type=float, metavar="SECONDS")
    chosen = parser.parse_args()
    faulthandler.enable()
    if chosen.replay is not None:
        wrong = run([chosen.replay], print)
    elif chosen.soak is not None:
        wrong = run(iter(range(SEEDS, sys.maxsize)), until=time.monotonic() + chosen.soak)
    else:
        wrong = run(range(*(chosen.seeds or (0, SEEDS))))
    print("\n".join(wrong) or "nothing wrong", file=sys.stderr)
    sys.exit(bool(wrong))


def test_random_calls():
    """A thousand sequences, in processes of their own."""
    ends = [round(SEEDS * part / BATCHES) for part in range(BATCHES + 1)]
    ranges = [[str(first), str(end)] for first, end in pairwise(ends)]
    command = [sys.executable, __file__, "--seeds"]
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True}
    batches = [subprocess.Popen([*command, *seeds], **pipes) for seeds in ranges]
    try:
        for batch, (_, end) in zip(batches, ranges, strict=True):
            printed, errors = batch.communicate(timeout=LIMIT)
            last = printed.split()[-1] if printed else "none"
            assert batch.returncode == 0, f"exit status {batch.returncode} after seed {last}: {errors[-3000:]}"
            assert last == str(int(end) - 1)
    finally:
        for batch in batches:
            batch.kill()


if __name__ == "__main__":
    main()
