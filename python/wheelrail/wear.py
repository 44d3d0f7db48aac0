"""Wear of the profiles of wheel and rail, as an instance has it."""

from pathlib import Path
from typing import NamedTuple

import numpy as np

from .geometry import Profile, built_in_names, is_inclined


class ProfileWear(NamedTuple):
    """Depths along the normal by which the profiles are worn, from the flange or gauge side to the field side [m].

    Attributes
    ----------
    wheel_position, rail_position
        Lateral positions on the new profiles in their own frames, the rail's upright.
    wheel_depth, rail_depth
        Depths there; 0 of a profile that stays new.
    wheel_arc_length, rail_arc_length
        Arc lengths of the new profiles there, for `Profile.worn_by`.
    """

    wheel_position: np.ndarray
    wheel_depth: np.ndarray
    rail_position: np.ndarray
    rail_depth: np.ndarray
    wheel_arc_length: np.ndarray
    rail_arc_length: np.ndarray


class WornProfiles(NamedTuple):
    """Profiles of wheel and rail as they are worn, the rail's upright.

    A profile's origin moves with its surface: a wheel's is its worn running circle, so that the radius of an instance
    with this profile is less by `tread_depth` of `wheel.worn_against(new)`.
    """

    wheel: Profile
    rail: Profile


def new_profile(text: str, body: str, smoothing: float, resources: Path) -> Profile:
    """The profile that a parameter names: one that is built in, a file, or one in the archive's resources."""
    if text.casefold() in map(str.casefold, built_in_names()):
        return Profile(text)
    path = Path(text.removeprefix("file://"))
    if not path.exists() and (resources / text).exists():
        path = resources / text
    profile = Profile(path, body=body, smoothing=smoothing or None)
    profile._inclined = is_inclined(text)
    return profile
