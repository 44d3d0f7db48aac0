"""Draw frames and signs of profiles: wheelset and track, and contacts: docs/profiles_axes.png (`make docs`)."""

import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.patches import FancyArrowPatch

REPOSITORY = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(REPOSITORY / "python"))

import wheelrail  # noqa: E402

PICTURE = REPOSITORY / "docs" / "profiles_axes.png"
BLACK, BLUE, RED, GREY = "#000000", "#0072B2", "#D55E00", "#777777"
LATERAL = 6.2e-3  # m
HALF_GAUGE = 717.5  # mm


def arrow(axes, start, end, colour, bend=0.0):
    """An arrow from one place to another; with a bend above 0 it turns anticlockwise on the page."""
    style = {"connectionstyle": f"arc3,rad={bend}", "arrowstyle": "-|>", "mutation_scale": 11, "linewidth": 1.3}
    axes.add_patch(FancyArrowPatch(start, end, shrinkA=0, shrinkB=0, color=colour, **style))


def outlines():
    """Outlines of rails and wheels in the track's frame [mm], by side and body."""
    table = wheelrail.contact_geometry("60E1", "S1002", lateral=(0.0, 8e-3), outlines_at=LATERAL)
    points = pd.DataFrame(table.attrs["outlines"])
    return {key: 1e3 * part[["y", "z"]].to_numpy() for key, part in points.groupby(["side", "body"])}


def draw_track(axes, shapes):
    """Wheelset and track from behind, not to scale: the middle of the track is drawn shorter."""
    height, shift = 150.0, 560.0

    def shown(y):
        return y - np.sign(y) * shift

    for side in ("left", "right"):
        for body, colour in (("rail", BLACK), ("wheel", BLUE)):
            y, z = shapes[side, body].T
            axes.plot(shown(y), z, color=colour, linewidth=1.2)
    arrow(axes, (0, 0), (75, 0), BLACK)
    arrow(axes, (0, 0), (0, 75), BLACK)
    axes.annotate("$y$", (88, -4))
    axes.annotate("$z$", (-5, 70))
    words = "$x$ forward, into the page;\nmiddle of the track, at the rails' tops"
    axes.annotate(words, (0, -8), ha="center", va="top", fontsize=7)
    centre = (1e3 * LATERAL * 4, height)
    axes.plot([205, -205], [height, height], color=BLUE, linewidth=3, alpha=0.35)
    axes.plot(*centre, "o", color=BLUE, markersize=5)
    arrow(axes, (0, height - 28), (centre[0], height - 28), BLUE)
    axes.plot([0, 0], [80, height], color=GREY, linewidth=0.7, linestyle=":")
    axes.annotate("lateral_displacement", (-4, height - 31), color=BLUE, fontsize=7, ha="left")
    # The left wheel rises: on the left of the page, upward.
    arrow(axes, (120, height - 24), (120, height + 24), BLUE, bend=-0.5)
    axes.annotate("roll_angle", (150, height + 32), color=BLUE, fontsize=7, ha="center")
    arrow(axes, centre, (centre[0], height + 55), RED)
    arrow(axes, centre, (centre[0] + 62, height), RED)
    axes.annotate("force_z", (centre[0] - 4, height + 46), color=RED, fontsize=7)
    axes.annotate("force_y", (centre[0] + 74, height + 8), color=RED, fontsize=7)
    for side in (1, -1):
        inner = shown(side * HALF_GAUGE)
        axes.plot([inner, inner], [-14, -48], color=GREY, linewidth=0.7)
    reach = shown(HALF_GAUGE)
    arrow(axes, (reach, -46), (-reach, -46), GREY)
    arrow(axes, (-reach, -46), (reach, -46), GREY)
    axes.annotate("gauge, at gauge_depth", (0, -58), color=GREY, fontsize=7, ha="center")
    axes.annotate("side 1", (shown(740), 40), color=GREY, fontsize=7, ha="center")
    axes.annotate("side 2", (shown(-740), 40), color=GREY, fontsize=7, ha="center")
    axes.set(title="Seen in the direction of travel", xlim=(265, -265), ylim=(-66, 225), aspect="equal")


def draw_contact(axes, shapes):
    """The left rail and wheel: arc length, normals, inclination, forces of the contacts on the wheel."""
    rail, wheel = shapes["left", "rail"], shapes["left", "wheel"]
    axes.plot(*rail.T, color=BLACK, linewidth=1.3)
    axes.plot(*wheel.T, color=BLUE, linewidth=1.3)
    rail = rail[np.argsort(rail[:, 0])]
    keep = rail[:, 1] > -13.9
    rail = rail[keep]
    tangent = np.gradient(rail, axis=0)
    tangent /= np.linalg.norm(tangent, axis=1)[:, None]
    normal = np.column_stack([-tangent[:, 1], tangent[:, 0]])
    for y in np.linspace(rail[2, 0], 775.0, 15):
        at = np.argmin(np.abs(rail[:, 0] - y))
        axes.plot(*np.array([rail[at], rail[at] + 2.2 * normal[at]]).T, color=GREY, linewidth=0.7)
    inner = rail - 3.0 * normal
    part = (inner[:, 0] > 724) & (inner[:, 0] < 768)
    axes.plot(*inner[part].T, color=GREY, linewidth=0.9)
    last = inner[part][-1]
    arrow(axes, last, last + np.array([3.0, -0.2]), GREY)
    words = "$s$: from the gauge face\nto the field side"
    axes.annotate(words, (776, -6.5), color=GREY, fontsize=7, va="top")
    axes.annotate("$n(s)$", (764, 3.4), color=GREY, fontsize=8)
    for y in (721.6, 752.0):
        at = np.argmin(np.abs(rail[:, 0] - y))
        place, across = rail[at], tangent[at]
        arrow(axes, place, place + 10 * normal[at], RED)
        arrow(axes, place, place + 6.5 * across, RED)
    axes.annotate("normal_force", (712.5, 2.2), color=RED, fontsize=7, ha="left")
    axes.annotate("lateral_force, to the left", (741, 8), color=RED, fontsize=7, ha="left")
    axes.plot([729, 727.5], [6.5, -1.2], color=RED, linewidth=0.5)
    at = np.argmin(np.abs(rail[:, 0] - 721.6))
    place, across = rail[at], tangent[at]
    axes.plot([place[0], place[0] + 15], [place[1], place[1]], color=GREY, linewidth=0.7, linestyle="--")
    axes.annotate(r"inclination $\delta>0$", (740, place[1] - 1.5), color=GREY, fontsize=7, ha="left", va="top")
    axes.annotate("wheel", (706, -22), color=BLUE, fontsize=8)
    axes.annotate("rail", (788, -1), fontsize=8)
    axes.set(title="Contacts on the left, on the wheel", xlim=(792, 697), ylim=(-31, 17), aspect="equal")


def main():
    """Draw."""
    figure, (track, contact) = plt.subplots(1, 2, figsize=(10.4, 3.3), layout="constrained", width_ratios=[1.1, 1])
    shapes = outlines()
    draw_track(track, shapes)
    draw_contact(contact, shapes)
    for axes in (track, contact):
        axes.title.set(fontsize=10, ha="left", x=0.0)
        axes.axis("off")
    figure.savefig(PICTURE, dpi=120)


if __name__ == "__main__":
    main()
