"""What wheels leave on the rail for those behind them: heat and wear against the position on the track."""

import numpy as np


class Trail:
    """What a unit leaves on the track: heat and wear against position, both summed up from the start of the trail."""

    def __init__(self, start):
        """Begin at a position; the rail ahead of it is untouched so far, and so is that behind."""
        self.position, self.heat, self.wear = [start], [0.0], [0.0]
        self.at = 0

    def leave(self, length, heat, wear):
        """Continue by a length [m] with a heat, over rho c and per area [K.m], and a depth of wear [m]."""
        self.position.append(self.position[-1] + length)
        self.heat.append(self.heat[-1] + length * heat)
        self.wear.append(self.wear[-1] + length * wear)

    def until(self, place):
        """Heat and wear up to a place; places are to be asked for in ascending order."""
        if place <= self.position[0]:
            return 0.0, 0.0
        if place > self.position[-1] + 1e-9:
            raise ValueError("the unit behind is longer than the distance to the unit in front")
        while self.position[self.at + 1] < place and self.at + 2 < len(self.position):
            self.at += 1
        low, high = self.at, self.at + 1
        share = (place - self.position[low]) / (self.position[high] - self.position[low])
        return tuple(values[low] + share * (values[high] - values[low]) for values in (self.heat, self.wear))


def skin_depths(axles, half_length, speed, diffusivity):
    """Skin depth of the unit at each axle, so that the temperature that enters is that of the surface.

    Heat put in at the surface a time t before is spread over d = sqrt(pi kappa t). Here it comes from all the wheels in
    front, about as much from each: 1/d is the mean of theirs. The first gets fresh rail; its own depth is that of its
    wake where it leaves.
    """
    depths = [np.sqrt(np.pi * diffusivity * half_length / speed)]
    for axle in range(1, len(axles)):
        ages = (axles[:axle] - axles[axle] - half_length) / speed
        depths.append(1.0 / np.mean(1.0 / np.sqrt(np.pi * diffusivity * ages)))
    return np.array(depths)
