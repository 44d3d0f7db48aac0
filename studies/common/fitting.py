"""What the comparisons with measurements share: their tables, steady points of the component, and least squares.

Tables are in studies/measurements/, each with a heading that says what it is and where it comes from.
"""

import csv
from dataclasses import dataclass

import numpy as np
from helpers import FMU, REPOSITORY, Instance
from scipy.optimize import least_squares

MEASUREMENTS = REPOSITORY / "studies" / "measurements"
# A step that is long against the rail's passage through the model, so that a few of them are the steady state, and the
# largest change over a step that counts as none: a step of the patch is solved to 1e-6.
STEP, STEADY = 5.0, 1e-6
# Change of a parameter for the derivative, over its scale: its square and STEADY over it are both below 1e-2 of a
# derivative.
DIFFERENCE = 1e-3


def read_measured(name):
    """Return the columns of a table by name without unit: arrays, or lists of words."""
    with (MEASUREMENTS / name).open(newline="") as file:
        head, *rows = csv.reader(line for line in file if not line.startswith("#"))
    columns = {}
    for title, cells in zip(head, zip(*rows, strict=True), strict=True):
        try:
            values = np.array(cells, dtype=float)
        except ValueError:
            values = list(cells)
        columns[title.partition(" [")[0]] = values
    return columns


def steady_points(creepages, speed, outputs, absolute=0.0, **start_values):
    """Steady outputs of the component at creepages and a speed [m/s]: a row for each output.

    `absolute` is a change over a step that counts as none, beside STEADY.
    """
    radius = start_values["wheel_radius"]
    instance = Instance(FMU, **start_values).start()
    points = []
    try:
        for creepage in creepages:
            instance.set(creepage=float(creepage), wheel_speed=speed * (1.0 + creepage) / radius)
            points.append(instance.steady(outputs, STEP, STEADY, absolute))
    finally:
        instance.close()
    return np.transpose(points)


@dataclass
class Fit:
    """Parameters that make the weighted squares of the residuals least."""

    values: dict  # by name, in the units of the parameter
    deviations: dict  # standard deviations, from the covariance (J^T J)^-1 of weighted residuals
    correlation: np.ndarray
    residuals: np.ndarray  # (computed - measured)/deviation
    evaluations: int

    @property
    def chi_squared(self):
        """Sum of the squares of the weighted residuals."""
        return float(self.residuals @ self.residuals)

    @property
    def freedom(self):
        """Points less parameters."""
        return len(self.residuals) - len(self.values)


def fit(curve, measured, deviation, start, bounds):
    """Fit parameters by name.

    Parameters
    ----------
    curve
        Function of parameters by name that returns what was measured.
    measured, deviation
        Measured values and their standard deviations.
    start
        Parameters by name, not 0: they are scaled by these.
    bounds
        Least and largest value of each.
    """
    names = list(start)
    scale = np.array([abs(start[name]) for name in names])
    limits = np.transpose([bounds[name] for name in names]) / scale
    count = 0

    def residuals(scaled):
        nonlocal count
        count += 1
        return (curve(**dict(zip(names, scaled * scale, strict=True))) - measured) / deviation

    begin = np.array([start[name] for name in names]) / scale
    # To a hundredth of a standard deviation and better.
    found = least_squares(residuals, begin, bounds=limits, diff_step=DIFFERENCE, xtol=1e-4, ftol=1e-4)
    jacobian = derivative(residuals, found.x, found.fun, limits)
    covariance = np.linalg.inv(jacobian.T @ jacobian)
    deviations = np.sqrt(np.diag(covariance))
    return Fit(
        dict(zip(names, found.x * scale, strict=True)),
        dict(zip(names, deviations * scale, strict=True)),
        covariance / np.outer(deviations, deviations),
        found.fun,
        count,
    )


def derivative(residuals, scaled, there, limits):
    """Differences of the residuals by each scaled parameter, away from the bounds.

    Those of the minimisation are relative to a parameter, and nothing but noise where it has gone to a bound of 0.
    """
    columns = []
    for number, value in enumerate(scaled):
        change = DIFFERENCE if value + DIFFERENCE <= limits[1][number] else -DIFFERENCE
        beside = scaled.copy()
        beside[number] += change
        columns.append((residuals(beside) - there) / change)
    return np.transpose(columns)
