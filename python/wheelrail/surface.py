"""Where the fields of each contact are: of a line and a patch; of profiles, cells of windows on the unrolled rail."""

from collections.abc import Iterable, Mapping, Sequence

import numpy as np

# Prefix in the component's names, prefix in the fields' names, places. A line has profiles along the rail and into the
# depth; a patch has cells.
LINE = (("profile.", "", ("x",)), ("depth.", "depth_", ("z",)))
PATCH = (("patch.", "", ("y", "x")),)
PREFIX = "surface."
# Contacts in their order first, then windows that carry nothing.
WINDOWS = 4
# Places of the cells and their sizes, with what each stretches over; all other names are fields of the cells.
PLACES: dict[str, tuple[str, ...]] = {
    "cell_length": ("window",),
    "strip_breadth": ("window",),
    "x": ("window", "cell"),
    "arc_length": ("window", "strip"),
    "y": ("window", "strip"),
    "z": ("window", "strip"),
    "inclination": ("window", "strip"),
}
CELLS = ("window", "strip", "cell")
# Wheel and rail as they stand in the track.
OUTLINES = {f"{body}_{axis}": f"{body}_profile.{axis}" for body in ("wheel", "rail") for axis in "yz"}


def sources(variables: Iterable[str]) -> dict[str, tuple[str, tuple[str, ...]]]:
    """Fields by name, each with the variable of FMI 3.0 that holds it and what it stretches over; none in FMI 2.0."""
    known = list(variables)
    own = [name for name in known if name.startswith(PREFIX)]
    found = {name.removeprefix(PREFIX): (name, PLACES.get(name.removeprefix(PREFIX), CELLS)) for name in own}
    return found | {short: (name, ("place",)) for short, name in OUTLINES.items() if found and name in known}


def sizes(lengths: Mapping[str, int]) -> dict[str, int]:
    """How many windows, strips, cells along a strip and places of a profile there are, from structural parameters."""
    strips = (3 * lengths["patch_strips"] + 1) // 2
    return {
        "window": WINDOWS,
        "strip": strips,
        "cell": lengths["patch_nodes"],
        "place": lengths["profile_wear_points"],
    }


def formed(values: Sequence[float], over: Sequence[str], lengths: Mapping[str, int]) -> np.ndarray:
    """The elements of a variable as an array over windows, strips and cells; it has room for more strips."""
    size = sizes(lengths)
    room = [2 * lengths["patch_strips"] if place == "strip" else size[place] for place in over]
    return np.reshape(values, room)[tuple(slice(size[place]) for place in over)]
