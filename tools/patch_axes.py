"""Draw the axes of the patch in plan view, with what is positive: docs/patch_axes.png (`make docs`)."""

from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.patches import Ellipse, FancyArrowPatch

PICTURE = Path(__file__).resolve().parent.parent / "docs" / "patch_axes.png"
BLACK, BLUE, RED, GREY = "#000000", "#0072B2", "#D55E00", "#777777"


def arrow(axes, start, end, colour, bend=0.0):
    """An arrow from one place to another; with a bend above 0 it turns anticlockwise."""
    style = {"connectionstyle": f"arc3,rad={bend}", "arrowstyle": "-|>", "mutation_scale": 12, "linewidth": 1.3}
    axes.add_patch(FancyArrowPatch(start, end, shrinkA=0, shrinkB=0, color=colour, **style))


def plan(axes, title):
    """The contact with its axes."""
    axes.add_patch(Ellipse((0, 0), 3.0, 2.2, facecolor="#eef3f8", edgecolor=GREY))
    arrow(axes, (0, 0), (2.3, 0), BLACK)
    arrow(axes, (0, 0), (0, 1.75), BLACK)
    axes.annotate("$x$", (2.36, -0.06))
    axes.annotate("$y$", (0.08, 1.62))
    axes.set(title=title, xlim=(-2.5, 2.9), ylim=(-1.5, 1.95), aspect="equal")
    axes.title.set(fontsize=10, ha="left", x=0.0)
    axes.axis("off")


def main():
    """Draw."""
    figure, (motion, forces) = plt.subplots(1, 2, figsize=(7.6, 2.7), layout="constrained")
    plan(motion, "The wheel's motion over the rail")
    arrow(motion, (-2.1, -0.6), (-2.1, 0.6), BLUE)
    motion.annotate(r"$v_y=\eta V$", (-2.4, 0.75), color=BLUE)
    arrow(motion, (0.55, -0.45), (0.55, 0.45), BLUE, bend=0.9)
    motion.annotate(r"$\omega_z=\varphi V$", (-1.2, 0.3), color=BLUE)
    arrow(motion, (-0.3, -1.3), (-1.5, -1.3), BLUE)
    motion.annotate(r"tread at the contact: $\omega r_0-V=\xi V$ backward", (-0.2, -1.38), color=BLUE, fontsize=8)
    motion.annotate("leading edge", (1.5, -0.4), color=GREY, fontsize=8)
    arrow(motion, (1.3, 1.6), (2.3, 1.6), GREY)
    motion.annotate("travel, $V$", (1.25, 1.72), color=GREY, fontsize=9)

    plan(forces, "Forces on the wheel")
    arrow(forces, (0, 0), (1.1, 0), RED)
    arrow(forces, (0, 0), (0, 0.85), RED)
    forces.annotate("$F_x$", (0.75, -0.32), color=RED)
    forces.annotate("$F_y$", (-0.42, 0.6), color=RED)
    arrow(forces, (-0.35, -0.45), (0.45, -0.35), RED, bend=0.8)
    forces.annotate("$M_z$", (-0.1, -0.6), color=RED)
    figure.savefig(PICTURE, dpi=110)


if __name__ == "__main__":
    main()
