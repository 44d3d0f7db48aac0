"""Steady forces over creepage."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd

from .archive import AnyPath, description, fmu_path
from .instance import Instance
from .simulation import Progress, reporter
from .variables import by_name, choices, near, outputs_named, start_values, units

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


def along(kind: str, creepages: Sequence[float] | Mapping[str, Sequence[float]] | None) -> Sequence[float]:
    """Values along the curve of one kind of creepage."""
    if creepages is None:
        return [float(value) for value in CREEPAGES[kind]]
    if not isinstance(creepages, Mapping):
        return creepages
    if kind not in creepages:
        raise ValueError(f"creepages: {kind} is missing")
    return creepages[kind]


def creep_curves(
    driven: str | Sequence[str] = tuple(DRIVEN),
    creepages: Sequence[float] | Mapping[str, Sequence[float]] | None = None,
    *,
    load: float = 60e3,
    speed: float = 20.0,
    outputs: Sequence[str] = OUTPUTS,
    progress: Progress = False,
    fmu: AnyPath | None = None,
    **values: Any,
) -> pd.DataFrame:
    """Steady forces at creepages, one curve for each kind of creepage.

    Parameters
    ----------
    driven
        Which creepages to drive: "longitudinal", "lateral", "spin". With `contact_model="line"` longitudinal alone.
    creepages
        Values along a curve, or a mapping with those of each kind; longitudinal and lateral [1], spin [1/m].
    load
        Normal load [N].
    speed
        Speed of the axle [m/s].
    outputs
        Names of outputs that become steady.
    progress
        As that of `simulate`.
    fmu
        Another FMU than the package's own, of FMI 2.0.
    **values
        Parameters and constant inputs by name, the other creepages among them. `contact_model` is "patch" by default.

    Returns
    -------
    pandas.DataFrame
        A row for each point: `driven`, the three creepages, the outputs; units in `attrs["units"]`, load and speed in
        `attrs["normal_load"]` and `attrs["speed"]`.

    Raises
    ------
    ValueError
        An unknown name or kind of creepage, a value out of range.
    SimulationError
        The component refused a combination, or a point does not become steady.

    Examples
    --------
    >>> curves = creep_curves("lateral", load=80e3, friction_law="constant", friction_cold=0.3)
    >>> wheelrail.plots.creep_curves(curves).savefig("creep.png")
    """
    fmu = fmu or fmu_path()
    kinds = (driven,) if isinstance(driven, str) else tuple(driven)
    for kind in kinds:
        if kind not in DRIVEN:
            raise ValueError(f"driven = {kind!r}: choose from {', '.join(DRIVEN)}{near(str(kind), DRIVEN)}")
    checked = start_values(fmu, {"contact_model": "patch", "normal_load": load, **values})
    names = outputs_named(fmu, outputs)
    fixed = {name: checked.pop(name, 0.0) for name in DRIVEN.values()}
    line = checked["contact_model"] == choices(by_name(str(fmu))["contact_model"])["line"]
    if line and (kinds != ("longitudinal",) or fixed["lateral_creepage"] or fixed["spin_creepage"]):
        raise ValueError("contact_model = 'line' has longitudinal creepage alone; 'patch' has them all")
    radius = checked.get("wheel_radius", float(by_name(str(fmu))["wheel_radius"].start))
    curves = {kind: along(kind, creepages) for kind in kinds}
    count = sum(len(curve) for curve in curves.values())
    report = reporter(progress, 0.0, float(count))
    rows: list[dict[str, Any]] = []
    for kind, curve in curves.items():
        instance = Instance(fmu, "creep_curves", **checked).start()
        try:
            for value in curve:
                now = fixed | {DRIVEN[kind]: float(value)}
                moving = {"creepage": now["creepage"]} if line else now
                instance.set(wheel_speed=speed * (1.0 + now["creepage"]) / radius, **moving)
                instance.steady(STEADY, STEP, RELATIVE, ABSOLUTE * load)
                rows.append({"driven": kind, **now, **dict(zip(names, instance.get(*names), strict=True))})
                report(float(len(rows)))
        finally:
            instance.close()
    result = pd.DataFrame(rows)
    of_model = units(description(fmu))
    result.attrs.update(
        units={name: of_model.get(name, "") for name in result.columns}, normal_load=float(load), speed=float(speed)
    )
    return result
