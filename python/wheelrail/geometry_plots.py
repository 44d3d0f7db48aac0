"""Pictures of the contact geometry; `wheelrail.plots` has them."""

from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from .drawing import BLACK, BLUE, GREEN, ORANGE, RED, SKY, columns_for, styled

NEEDED = {
    "lateral_displacement": "m",
    "rolling_radius_difference": "m",
    "equivalent_conicity": "1",
    "left_on_rail": "m",
    "left_on_wheel": "m",
    "right_on_rail": "m",
    "right_on_wheel": "m",
}


@styled
def contact_geometry(table: pd.DataFrame, *, title: str = "") -> Figure:
    """Draw the contact geometry of a wheelset: profiles in contact, rolling radii, conicity, places of the contacts.

    Parameters
    ----------
    table
        What `wheelrail.contact_geometry` returned; with `outlines_at` the profiles are drawn too.
    title
        Heading.

    Returns
    -------
    matplotlib.figure.Figure
        Panels of both sides, if there are outlines, above the difference of the rolling radii, the equivalent conicity
        over the amplitude, and the places of the contacts.

    Raises
    ------
    ValueError
        Columns are missing.

    Examples
    --------
    >>> table = wheelrail.contact_geometry("60E1", "S1002", outlines_at=5e-3)
    >>> contact_geometry(table).savefig("geometry.png")
    """
    columns = columns_for("contact_geometry", table, NEEDED, "wheelrail.contact_geometry")
    outlines = table.attrs.get("outlines")
    rows = 2 if outlines else 1
    figure = plt.figure(figsize=(9.0, 3.0 * rows), layout="constrained")
    grid = figure.add_gridspec(rows, 6)
    if outlines:
        draw_sides([figure.add_subplot(grid[0, :3]), figure.add_subplot(grid[0, 3:])], outlines)
    lateral = 1e3 * columns["lateral_displacement"]
    radii, conicity, places = (figure.add_subplot(grid[-1, at : at + 2]) for at in (0, 2, 4))
    radii.plot(lateral, 1e3 * columns["rolling_radius_difference"], color=BLACK)
    radii.set(xlabel="lateral displacement [mm]", ylabel=r"$\Delta r$ [mm]")
    ahead = lateral > 0.0
    conicity.plot(lateral[ahead], columns["equivalent_conicity"][ahead], color=BLUE)
    conicity.set(xlabel="amplitude [mm]", ylabel="equivalent conicity [1]", ylim=(0.0, None))
    for side, body, color in (
        ("left", "wheel", RED),
        ("left", "rail", ORANGE),
        ("right", "wheel", GREEN),
        ("right", "rail", SKY),
    ):
        place = 1e3 * columns[f"{side}_on_{body}"]
        # A line over a jump would be drawn where no contact is.
        broken = np.abs(np.diff(place, prepend=place[0])) > 1.0
        places.plot(lateral, np.where(broken, np.nan, place), color=color, label=f"{side} {body}")
    places.set(xlabel="lateral displacement [mm]", ylabel="contact [mm]")
    places.legend(fontsize=7)
    figure.axes[0].set_title(title)
    return figure


def draw_sides(panels: list[Axes], outlines: dict[str, list[Any]]) -> None:
    """Rails and wheels where they touch, in the track's frame seen from behind: the left side on the left."""
    points = pd.DataFrame(outlines)
    for axes, side in zip(panels, ("left", "right"), strict=True):
        for body, color in (("rail", BLACK), ("wheel", BLUE)):
            own = points[(points["side"] == side) & (points["body"] == body)]
            axes.plot(1e3 * own["y"], 1e3 * own["z"], color=color, label=body)
        axes.set(xlabel=f"{side}: y [mm]", ylabel="z [mm]", aspect="equal", ylim=(-40.0, 15.0))
        # y to the left, as it is seen in the direction of travel.
        axes.invert_xaxis()
    panels[0].legend(fontsize=7)
