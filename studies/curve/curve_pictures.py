"""The pictures of studies/curve: forces, places, temperatures and wear along the way, and the bogie from above."""

import matplotlib.pyplot as plt
import numpy as np
from curve_vehicle import AXLES, HALF_WHEELBASE, SIDES, WHEELS
from helpers import BLACK, BLUE, GREEN, ORANGE, RED, SKY, save

LOOK = {
    ("leading", "left"): (RED, "leading, outer"),
    ("leading", "right"): (BLUE, "leading, inner"),
    ("trailing", "left"): (ORANGE, "trailing, outer"),
    ("trailing", "right"): (SKY, "trailing, inner"),
}
GREY = "#777777"
WIDE = 8.6


def draw_way(found):
    """Draw everything over the place of each wheelset, with the equilibrium in the curve."""
    figure, panels = plt.subplots(
        8, 1, figsize=(WIDE, 14.5), sharex=True, layout="constrained", height_ratios=[0.8, 1, 1.2, 1, 1, 1.2, 1, 1]
    )
    way, marks = found.way, found.layout.marks
    layout, poses, vertical, lateral, ratio, places, heat, wear = panels
    along = np.linspace(0.0, marks[-1], 800)
    at = np.array([found.even.at(place)[3:] for place in along])
    layout.plot(along, 1e3 * np.abs(at[:, 0]), color=BLACK, label="curvature, to the right [1/km]")
    layout.plot(along, 1e3 * np.sin(at[:, 1]) * 1.5 / 30.0, color=GREY, linestyle="--", label="cant [30 mm]")
    rail = np.array([found.rough.uneven(1, place) for place in along])
    layout.plot(along, 1e3 * rail[:, 0], color=GREEN, linewidth=0.8, label="left rail across [mm]")
    layout.plot(along, 1e3 * rail[:, 1], color=ORANGE, linewidth=0.8, label="left rail up [mm]")
    layout.set(ylabel="track", ylim=(None, 8.0))
    layout.legend(loc="upper left", ncols=4, fontsize=7)
    for axle, colour in zip(AXLES, (RED, BLUE), strict=True):
        poses.plot(way[f"place_{axle}"], 1e3 * way[f"y_{axle}"], color=colour, linewidth=0.9, label=f"{axle} [mm]")
        yaw = 1e3 * way[f"yaw_{axle}"]
        poses.plot(way[f"place_{axle}"], yaw, color=colour, linewidth=0.9, linestyle=":", label=f"{axle}, yaw [mrad]")
        steady(poses, found, 1e3 * found.steady[f"y_{axle}"])
    poses.set(ylabel="wheelset outwards\n[mm], its yaw [mrad]", ylim=(None, 14.5))
    poses.legend(loc="upper left", ncols=4, fontsize=7)
    for (axle, side), (colour, label) in LOOK.items():
        name, place = f"{axle}_{side}", way[f"place_{axle}"]
        for axes, values, expected in (
            (vertical, way[f"Q_{name}"] / 1e3, found.steady[f"Q_{name}"] / 1e3),
            (lateral, way[f"Y_{name}"] / 1e3, found.steady[f"Y_{name}"] / 1e3),
            (ratio, way[f"Y_{name}"] / way[f"Q_{name}"], found.steady[f"Y_{name}"] / found.steady[f"Q_{name}"]),
            (heat, way[f"peak_temperature_{name}"] - 273.15, found.steady[f"peak_temperature_{name}"] - 273.15),
            (wear, way[f"wear_number_{name}"], found.steady[f"wear_number_{name}"]),
        ):
            axes.plot(place, values, color=colour, linewidth=0.8, label=label)
            steady(axes, found, expected)
        if axle == "leading":
            for number in (1, 2, 3):
                there = way[f"contacts_{name}"] >= number
                spot = 1e3 * way[f"contact.rail_position[{number}]_{name}"][there]
                load = way[f"contact.normal_force[{number}]_{name}"][there] / 1e3
                places.scatter(place[there], spot, s=0.06 * load, color=colour, linewidth=0)
    vertical.set(ylabel="Q, load\nof a wheel [kN]")
    vertical.legend(loc="upper left", ncols=4, fontsize=7)
    vertical.margins(y=0.18)
    lateral.set(ylabel="Y, on the rail,\noutwards [kN]")
    ratio.set(ylabel="Y/Q")
    places.set(ylabel="contacts of the leading\nwheels, from the rail's\ntop to the field side [mm]")
    heat.set(ylabel="peak temperature\nof the rail [°C]")
    wear.set(ylabel="Tγ [N]", xlabel="place along the track [m]", xlim=(way["place"][0], marks[-1]))
    for axes in panels:
        for mark in marks[:4]:
            axes.axvline(mark, color="#bbbbbb", linewidth=0.7, zorder=0)
    for start, end, words in zip(
        (0.0, *marks[:4]), marks, ("straight", "transition", "curve, 300 m", "transition", "straight"), strict=True
    ):
        layout.annotate(
            words, (0.5 * (max(start, way["place"][0]) + end), 1.02), xycoords=("data", "axes fraction"), ha="center"
        )
    figure.align_ylabels(panels)
    save(figure, "curve.png")


def steady(axes, found, value):
    """The equilibrium's value over the curve."""
    _, begin, end, *_ = found.layout.marks
    axes.plot([begin, end], [value, value], color=BLACK, linewidth=0.9, linestyle=(0, (5, 3)), zorder=4)


def draw_wheels(found):
    """The bogie from above in steady curving, angles and displacements enlarged, with the forces on the wheels."""
    figure, axes = plt.subplots(figsize=(WIDE, 5.0), layout="constrained")
    large, scale = 30.0, 1.0 / 30e3
    radius = abs(found.layout.radius)
    x = np.linspace(-2.6, 2.6, 200)
    # The arc's sagitta as enlarged as the angles, so that both fit.
    sagitta = -large * x**2 / (2.0 * radius)
    for side, words in ((1, "outer rail"), (-1, "inner rail")):
        axes.plot(x, sagitta + 0.75 * side, color="#999999", linewidth=5, solid_capstyle="butt", zorder=1)
        axes.annotate(words, (-2.55, sagitta[0] + 0.75 * side + 0.12), fontsize=8, color=GREY)
    for axle, along in zip(AXLES, (HALF_WHEELBASE, -HALF_WHEELBASE), strict=True):
        tangent = -large * along / radius
        angle = tangent + large * found.steady[f"yaw_{axle}"]
        middle = np.array([along, -large * along**2 / (2.0 * radius) + large * 0.3 * found.steady[f"y_{axle}"]])
        ahead, left = np.array([np.cos(angle), np.sin(angle)]), np.array([-np.sin(angle), np.cos(angle)])
        axes.plot(*zip(middle - 1.0 * left, middle + 1.0 * left, strict=True), color=BLACK, linewidth=4, zorder=2)
        for side, sign in SIDES.items():
            hub = middle + 0.75 * sign * left
            axes.plot(
                *zip(hub - 0.42 * ahead, hub + 0.42 * ahead, strict=True),
                color=LOOK[axle, side][0],
                linewidth=7,
                zorder=3,
            )
            force = np.array([found.steady[f"force_x_{axle}_{side}"], -sign * found.steady[f"Y_{axle}_{side}"]])
            axes.annotate(
                "",
                hub + scale * force,
                hub,
                arrowprops={"arrowstyle": "-|>", "linewidth": 2.0, "color": BLACK},
                zorder=5,
            )
            q, y = (found.steady[f"{name}_{axle}_{side}"] / 1e3 for name in ("Q", "Y"))
            words = f"Q {q:.1f} kN, Y {y:.1f} kN\nY/Q {y / q:.2f}"
            axes.annotate(words, hub + np.array([0.28, 0.42 * sign - 0.08]), fontsize=8)
        yaw = 1e3 * found.steady[f"yaw_{axle}"]
        place = 1e3 * found.steady[f"y_{axle}"]
        words = f"{place:+.1f} mm outwards\nyaw {yaw:+.1f} mrad"
        axes.annotate(words, middle + np.array([-0.14, -0.1]), fontsize=8, ha="right")
    axes.annotate("", (2.55, 0.0), (2.0, 0.0), arrowprops={"arrowstyle": "-|>", "linewidth": 1.2, "color": GREY})
    axes.annotate("travel", (2.0, 0.08), color=GREY, fontsize=8)
    axes.set(aspect="equal", xlim=(-2.7, 2.7), ylim=(-1.6, 1.45))
    axes.axis("off")
    axes.set_title(
        "Steady curving from above: forces of the rails on the wheels; yaw and curvature × 30, displacements × 9"
    )
    save(figure, "curve_above.png")


__all__ = ["WHEELS", "draw_way", "draw_wheels"]
