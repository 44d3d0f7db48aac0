"""How far a computation is, told while it goes on."""

import sys
from collections.abc import Callable
from typing import TypeAlias

Progress: TypeAlias = bool | str | Callable[[float], object] | None


def reporter(progress: Progress, start: float, end: float, title: str, unit: str) -> Callable[[float], None]:
    """What is called with the place that has been reached, between a start and an end that are told in a unit.

    Raises
    ------
    TypeError
        It is neither a truth value nor a title nor a function.
    """
    if progress is None or progress is False:
        return lambda place: None
    if callable(progress):
        call = progress
        return lambda place: void(call((place - start) / (end - start)))
    if not isinstance(progress, (bool, str)):
        raise TypeError(f"progress = {progress!r}: True, a title or a function of the share that is done is needed")
    told = progress if isinstance(progress, str) else title
    shown = 0

    def show(place: float) -> None:
        nonlocal shown
        percent = int(100.0 * (place - start) / (end - start) + 1e-6)
        here = in_place()
        # A terminal or a notebook shows each percent in place, a log file each half.
        if percent > shown and (here or percent // 50 > shown // 50):
            mark = "\r" if here and percent < 100 else "\n"
            print(f"  {told}: {place:6.2f} of {end:.2f} {unit}, {percent:3d} %", end=mark, file=sys.stderr, flush=True)
            shown = percent

    return show


def in_place() -> bool:
    """Whether a line that is written again replaces the one before: on a terminal, and below a notebook's cell."""
    # The stream of a Jupyter kernel is no terminal, and returns to the beginning of a line all the same.
    return sys.stderr.isatty() or type(sys.stderr).__module__.startswith("ipykernel.")


def void(_: object) -> None:
    """Drop a value."""
