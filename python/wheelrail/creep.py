"""Steady forces over creepage."""

import math
import numbers
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd

from .archive import AnyPath, description
from .arguments import finite
from .inputs import check_inputs, parameters_of, with_window
from .instance import Instance, SimulationError
from .progress import Progress, reporter
from .simulation import fmu_of, given_values
from .variables import by_name, choices, lengths_of, near, number, outputs_named, several, start_values, units

# The input of each creepage, and by default what it is driven to, to where the contact slides.
DRIVEN = {"longitudinal": "creepage", "lateral": "lateral_creepage", "spin": "spin_creepage"}
CREEPAGES = {
    "longitudinal": np.linspace(0.0, 0.006, 25),
    "lateral": np.linspace(0.0, 0.006, 25),
    "spin": np.linspace(0.0, 1.5, 25),
}
OUTPUTS = (
    "traction_force",
    "lateral_force",
    "spin_moment",
    "traction_coefficient",
    "friction_coefficient",
    "peak_temperature",
    "peak_pressure",
    "stick_fraction",
    "friction_power",
    "wear_rate",
    "contact_length",
    "contact_breadth",
)
# A step that is long against the rail's passage through the model, so that a few of them are the steady state: what
# rests then (counts of cells may go to and fro by one), and its largest change over a step. A step of the patch is
# solved to 1e-6.
STEP = 5.0  # s
STEADY = ("traction_force", "lateral_force", "spin_moment", "peak_temperature")
RELATIVE, ABSOLUTE = 1e-6, 1e-8  # of the value, of the load


Values = float | Sequence[float] | np.ndarray


def along(fmu: AnyPath, kind: str, creepages: Values | Mapping[str, Values] | None) -> list[float]:
    """Values along the curve of one kind of creepage.

    Raises
    ------
    ValueError
        There are none, or one is no number or out of the input's range.
    """
    given: Any = CREEPAGES[kind] if creepages is None else creepages
    if isinstance(given, Mapping):
        if kind not in given:
            raise ValueError(f"creepages: {kind} is missing; it has {', '.join(map(str, given)) or 'none'}")
        given = given[kind]
    elements = several(given)
    if elements is not None and not elements:
        raise ValueError(f"creepages: there is none for {kind}; at least one value is needed")
    variable = by_name(str(fmu))[DRIVEN[kind]]
    return [float(number(variable, value)) for value in ([given] if elements is None else elements)]


def kinds_of(driven: str | Sequence[str] | None, line: bool) -> tuple[str, ...]:
    """The creepages to drive: all that the contact has, where none is chosen.

    Raises
    ------
    ValueError
        There is no such kind, or none is chosen.
    """
    if driven is None:
        return ("longitudinal",) if line else tuple(DRIVEN)
    chosen = (driven,) if isinstance(driven, str) else several(driven)
    if not chosen:
        raise ValueError(f"driven = {driven!r}: choose from {', '.join(DRIVEN)}")
    for kind in chosen:
        if kind not in DRIVEN:
            raise ValueError(f"driven = {kind!r}: choose from {', '.join(DRIVEN)}{near(str(kind), DRIVEN)}")
    return tuple(dict.fromkeys(chosen))


def creep_curves(
    driven: str | Sequence[str] | None = None,
    creepages: Values | Mapping[str, Values] | None = None,
    *,
    load: float = 60e3,
    speed: float = 20.0,
    outputs: str | Sequence[str] = OUTPUTS,
    preset: str | None = None,
    parameters: Mapping[str, Any] | None = None,
    progress: Progress = False,
    fmu: AnyPath | None = None,
    **values: Any,
) -> pd.DataFrame:
    """Steady forces at creepages, one curve for each kind of creepage.

    Parameters
    ----------
    driven
        Which creepages to drive: "longitudinal", "lateral", "spin", or several of them; by default all that the contact
        has: with `contact_model="line"` longitudinal alone.
    creepages
        Values along a curve, or one value, or a mapping with those of each kind; longitudinal and lateral [1], spin
        [1/m].
    load
        Normal load [N]; `largest_load` follows it as in `simulate`.
    speed
        Speed of the axle [m/s].
    outputs
        Names of outputs that become steady, or one name.
    preset
        Name of a set of parameters, "wet" for example; what is given by name goes before it.
    parameters
        Parameters and constant inputs whose names are no Python names, as in `simulate`.
    progress
        As that of `simulate`.
    fmu
        Another FMU than the package's own.
    **values
        Parameters and constant inputs by name, the other creepages among them. `contact_model` is "patch" by default;
        "line" is the other one that has creep curves.

    Returns
    -------
    pandas.DataFrame
        A row for each point: `driven`, the three creepages, the outputs; units in `attrs["units"]`, load and speed in
        `attrs["normal_load"]` and `attrs["speed"]`.

    Raises
    ------
    ValueError
        An unknown name or kind of creepage, a value out of range, an input that the curves set themselves.
    TypeError
        An argument of a wrong type.
    SimulationError
        The component refused a combination, or a point does not become steady; `table` of the error has the points
        before.

    Examples
    --------
    >>> curves = creep_curves("lateral", load=80e3, friction_law="constant", friction_cold=0.3)
    >>> wheelrail.plots.creep_curves(curves).savefig("creep.png")
    """
    fmu = fmu_of(fmu, None, "2.0")
    known = by_name(str(fmu))
    given = given_values(preset, parameters, values)
    for name, instead in (("normal_load", "load=…"), ("wheel_speed", "speed=… and the creepage")):
        if name in given:
            raise ValueError(f"{name} = {given[name]!r}: creep curves take it from {instead}")
    checked = start_values(fmu, {"contact_model": "patch", "normal_load": load, **given})
    models = choices(known["contact_model"])
    # Before what follows from it: the creepage of profiles is where the wheel stands and how fast it turns.
    if checked["contact_model"] == models.get("profiles"):
        raise ValueError(
            f"contact_model = {given['contact_model']!r}: creep curves are of 'line' and 'patch'; forces of profiles"
            " come from simulate(…, contact_model='profiles', slip_source='vehicle_speed')"
        )
    for name, only in (("slip_source", "creepage"), ("control", "load")):
        if checked.get(name, choices(known[name])[only]) != choices(known[name])[only]:
            raise ValueError(f"{name} = {given[name]!r}: creep curves are over creepage at a load, {name}={only!r}")
    checked = with_window(fmu, checked, np.atleast_1d(checked["normal_load"]))
    inputs = {name: value for name, value in checked.items() if known[name].causality == "input"}
    check_inputs(fmu, {"time": np.zeros(1)}, inputs, parameters_of(fmu, checked, None))
    if not load > 0.0:
        raise ValueError(f"load = {load!r}: a positive number of newtons is needed")
    if isinstance(speed, bool) or not isinstance(speed, numbers.Real):
        raise TypeError(f"speed = {speed!r}: a number of metres per second is needed")
    speed = finite("speed", speed)
    if not 0.0 < speed < math.inf:
        raise ValueError(f"speed = {speed!r}: a positive number of metres per second is needed")
    line = checked["contact_model"] == models["line"]
    kinds = kinds_of(driven, line)
    fixed = {name: checked.pop(name, 0.0) for name in DRIVEN.values()}
    if line and (kinds != ("longitudinal",) or fixed["lateral_creepage"] or fixed["spin_creepage"]):
        raise ValueError("contact_model = 'line' has longitudinal creepage alone; 'patch' has them all")
    if len(kinds) == 1 and fixed[DRIVEN[kinds[0]]]:
        raise ValueError(f"{DRIVEN[kinds[0]]} is what is driven: its values go into creepages")
    if isinstance(creepages, Mapping) and (others := [kind for kind in creepages if kind not in kinds]):
        raise ValueError(f"creepages: {', '.join(map(str, others))} is not driven; driven: {', '.join(kinds)}")
    names = [name for name in outputs_named(fmu, outputs, lengths_of(fmu, checked)) if name not in fixed]
    radius = checked.get("wheel_radius", float(known["wheel_radius"].start))
    curves = {kind: along(fmu, kind, creepages) for kind in kinds}
    for name, curve in ((DRIVEN[kind], curve) for kind, curve in curves.items()):
        for value in curve if name == "creepage" else (fixed["creepage"],):
            number(known["wheel_speed"], speed * (1.0 + value) / radius)
    report = reporter(progress, 0.0, float(sum(map(len, curves.values()))), "creep_curves", "points")
    rows: list[dict[str, Any]] = []

    def result() -> pd.DataFrame:
        table = pd.DataFrame(rows)
        of_model = units(description(fmu))
        table.attrs.update(
            units={name: of_model.get(name) or of_model.get(name.partition("[")[0], "") for name in table.columns},
            normal_load=float(load),
            speed=float(speed),
        )
        return table

    for kind, curve in curves.items():
        instance, place = Instance(fmu, "creep_curves", **checked), kind
        try:
            instance.start()
            for value in curve:
                place = f"{kind} creepage {value:g}"
                now = fixed | {DRIVEN[kind]: value}
                moving = {"creepage": now["creepage"]} if line else now
                instance.set(wheel_speed=speed * (1.0 + now["creepage"]) / radius, **moving)
                instance.steady(STEADY, STEP, RELATIVE, ABSOLUTE * load)
                rows.append({"driven": kind, **now, **dict(zip(names, instance.get(*names), strict=True))})
                report(float(len(rows)))
        except SimulationError as error:
            failed = SimulationError(f"{place}: {error}")
            failed.table = result()
            raise failed from error
        finally:
            instance.close()
    return result()
