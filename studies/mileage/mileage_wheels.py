"""Wheels that wear: depths over the arc length of the new profile, and the worn profile that they make.

A depth d(s) takes the new profile P(s) to the worn one, C = P + d n, n the normal into the wheel. What a mileage step
takes away is an area of the cross-section for each cell of s. A cell between two of C's normals is left by an area a
where d grows by a/((1 − κ d) Δs), κ the curvature of P towards the material: no area is lost by going from one profile
to the other.
"""

from dataclasses import dataclass
from math import erf, sqrt

import numpy as np
from helpers import wheelrail
from mileage_bogie import WornWheel

GRID = 2.5e-4  # m: spacing of the depths
# Measures have names of their own in tables.
MEASURES = ("flange_height", "flange_thickness", "flange_gradient", "hollow_depth")


@dataclass(frozen=True)
class NewWheel:
    """The new profile, in cells with a depth each."""

    profile: object
    edges: np.ndarray  # arc length of the ends of the cells [m]
    y: np.ndarray  # at these ends [m]
    z: np.ndarray
    normal: np.ndarray  # at these ends, across and up
    curvature: np.ndarray  # of the cells, towards the material [1/m]

    @classmethod
    def of(cls, profile):
        """Take a profile, a name or a path."""
        if not isinstance(profile, wheelrail.Profile):
            # A file of two columns does not say of which body it is.
            profile = wheelrail.Profile(profile, body="wheel")
        if profile.body != "wheel":
            raise ValueError(f"{profile.name} is the profile of a {profile.body}; a wheel is needed")
        table = profile.points
        arc, turn = table["arc_length"].to_numpy(), np.unwrap(table["inclination"].to_numpy())
        count = int(np.ceil(arc[-1] / GRID))
        edges = np.linspace(0.0, arc[-1], count + 1)
        at = [np.interp(edges, arc, table[name].to_numpy()) for name in ("y", "z")]
        angle = np.interp(edges, arc, turn)
        # The direction turns by −κ over the arc length where κ is positive towards the material, above the profile.
        curvature = np.diff(angle) / np.diff(edges)
        return cls(profile, edges, *at, np.stack([-np.sin(angle), np.cos(angle)]), curvature)

    @property
    def cell(self):
        """Length of a cell [m]."""
        return self.edges[1] - self.edges[0]

    @property
    def place(self):
        """Arc length of the cells' middles [m]."""
        return 0.5 * (self.edges[1:] + self.edges[:-1])

    def none(self):
        """Return the depths of a new wheel."""
        return np.zeros(len(self.place))

    def worn(self, depth):
        """Return the profile that depths make, the new one where there are none."""
        return self.profile.worn_by(self.place, depth) if depth.any() else self.profile

    def for_units(self, depth):
        """What a worker needs of a worn wheel: its profile, the depth at its running circle, and the cells on it."""
        at_ends = np.interp(self.edges, self.place, depth)
        y, z = self.y + at_ends * self.normal[0], self.z + at_ends * self.normal[1]
        # On the side of the tread: the flange's back has the same y as no other place, but for its round edge.
        tip = int(np.argmin(z))
        at_running_circle = float(np.interp(0.0, y[tip:], z[tip:]) - np.interp(0.0, self.y[tip:], self.z[tip:]))
        ends = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(y), np.diff(z)))])
        return WornWheel(self.worn(depth)._text, at_running_circle, tuple(ends.tolist()))

    def depth_of(self, area, depth):
        """Growth of the depths by areas of the cells."""
        return area / (self.cell * (1.0 - self.curvature * depth))

    def area(self, depth):
        """Area of the cross-section between the new profile and the worn one [m²]."""
        return float(np.sum(self.cell * depth * (1.0 - 0.5 * self.curvature * depth)))


def smoothed(area, cell, wavelength):
    """Spread areas of cells so that waves of a length are halved; none is lost but at the profile's ends."""
    if wavelength <= 0.0:
        return area
    # The Gaussian whose transform is a half there.
    deviation = wavelength * sqrt(2.0 * np.log(2.0)) / (2.0 * np.pi) / cell
    reach = int(np.ceil(5.0 * deviation))
    ends = np.array([erf((k - 0.5) / (deviation * sqrt(2.0))) for k in range(-reach, reach + 2)])
    kernel = np.diff(ends)
    return np.convolve(area, kernel / kernel.sum(), mode="same")
