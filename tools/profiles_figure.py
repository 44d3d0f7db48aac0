"""Draw the contact geometry of S1002 on 60E1: docs/profiles_geometry.png (`make docs`)."""

import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")

REPOSITORY = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(REPOSITORY / "python"))

import wheelrail  # noqa: E402

if __name__ == "__main__":
    table = wheelrail.contact_geometry("60E1", "S1002", outlines_at=5e-3)
    figure = wheelrail.plots.contact_geometry(table, title="S1002 on 60E1, moved to the left by 5 mm")
    figure.savefig(REPOSITORY / "docs" / "profiles_geometry.png")
