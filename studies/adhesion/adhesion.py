"""A locomotive at the adhesion limit: what a slip controller gains on wet rail, and what the heat of slip takes.

    .venv/bin/python studies adhesion           (after `make fmu`; or `make coupling-adhesion`)

A Bo'Bo' locomotive pulls a heavy train up a gradient from 10 m/s on wet rail, over a place with leaves. Four slip
controllers, slip_control.py, drive the same locomotive, locomotive.py; then the same with friction
that does not know temperature, and with a rail that is cold under each wheelset. docs/couplings/adhesion.md, whose
tables and picture this writes.
"""

import time

import adhesion_pictures
import numpy as np
from adhesion_runs import (
    AS_IT_IS,
    COLD,
    COMPARED,
    CONSTANT,
    CONTROLLERS,
    CREEPAGES,
    NOISE,
    NOISY,
    all_runs,
    creepage,
    during,
    effort,
    hauled,
    in_leaves,
    most,
    steady_curves,
    summary,
)
from helpers import markdown_table, write_csv, write_tables
from locomotive import AXLES, STOP


def celsius(temperature):
    """A temperature as people read it."""
    return f"{temperature - 273.15:.0f} °C"


def gains(plain, limit):
    """What each controller pulls."""
    head = ["controller", "on wet rail", "of the limit", "the search has more by", "in the leaves", "from 4 s to 16 s"]
    best = summary(plain["search"], during(plain["search"]))["effort"]
    rows = []
    for name, table in plain.items():
        wet, leaves, all_of_it = (
            1e-3 * summary(table, part)["effort"] for part in (during(table), in_leaves(table), during(table, end=STOP))
        )
        more = f"{1e-3 * best - wet:.1f} kN ({100.0 * (1e-3 * best / wet - 1.0):.1f} %)" if name != "search" else ""
        share = f"{100.0 * 1e3 * wet / limit:.1f} %"
        rows.append([name, f"{wet:.1f} kN", share, more, f"{leaves:.1f} kN", f"{all_of_it:.1f} kN"])
    return markdown_table([*head, "hauls on wet rail"], [
        [*row, f"{1e-3 * hauled(summary(table, during(table))['effort']):.0f} t"]
        for row, table in zip(rows, plain.values(), strict=True)
    ])  # fmt: skip


def prices(plain):
    """What each controller spends."""
    rows = []
    for name, table in plain.items():
        wet, leaves = summary(table, during(table)), summary(table, in_leaves(table))
        spent = [f"{1e-3 * wet['energy']:.1f} MJ/km", f"{1e9 * wet['wear']:.1f} cm³/km"]
        rows.append([name, f"{100.0 * wet['creepage']:.2f} %", *spent, celsius(wet["peak"]), celsius(leaves["peak"])])
    head = ["controller", "mean creepage", "slip energy", "worn off the rails", "hottest", "hottest at the leaves"]
    return markdown_table(head, rows)


def heat(results):
    """What temperature takes of the effort."""
    rows = []
    for name in COMPARED:
        tables = (results[name, variant][0] for variant in (AS_IT_IS, CONSTANT, COLD))
        own, constant, cold = (summary(table, during(table))["effort"] for table in tables)
        shares = f"{100.0 * (own / constant - 1.0):.1f} %", f"{100.0 * (own / cold - 1.0):.2f} %"
        efforts = [f"{1e-3 * force:.1f} kN" for force in (own, constant, cold)]
        rows.append([name, *efforts[:2], shares[0], efforts[2], shares[1]])
    head = ["controller", "effort", CONSTANT, "the heat of slip changes", COLD, "rail warmed by those in front changes"]
    return markdown_table(head, rows)


def wheelsets(plain):
    """The four wheelsets under the search, and the rail that they find where all slip at 10 %."""
    search, sliding = plain["search"], plain["constant 10 %"]
    rows = []
    for axle in range(len(AXLES)):
        load, force, arrives, peak = (
            search[name][during(search), axle].mean()
            for name in ("normal_load", "traction_force", "incoming_temperature", "peak_temperature")
        )
        slips = 100.0 * creepage(search)[during(search), axle].mean()
        there = sliding["incoming_temperature"][during(sliding), axle].mean()
        forces = [f"{2e-3 * load:.1f} kN", f"{2e-3 * force:.1f} kN", f"{force / load:.3f}"]
        temperatures = [f"{arrives - 273.15:.1f} °C", celsius(peak), f"{there - 273.15:.1f} °C"]
        rows.append([f"{axle + 1}", *forces, f"{slips:.2f} %", *temperatures])
    head = [
        "wheelset",
        "load",
        "force",
        "adhesion",
        "creepage",
        "rail comes in at",
        "hottest",
        "at 10 % rail comes in at",
    ]
    return markdown_table(head, rows)


def curve(curves):
    """Adhesion in steady rolling with and without temperature."""
    rows = []
    for place in np.flatnonzero(np.isin(CREEPAGES, (0.005, 0.01, 0.02, 0.05, 0.10, 0.20))):
        own, constant, fine = (curves[variant][0, place] for variant in (AS_IT_IS, CONSTANT, "fine"))
        changes = [f"{100.0 * (own / constant - 1.0):.1f} %", celsius(curves[AS_IT_IS][1, place])]
        rows.append([f"{100.0 * CREEPAGES[place]:g} %", f"{own:.3f}", f"{constant:.3f}", *changes, f"{fine:.3f}"])
    return markdown_table(["creepage", "adhesion", CONSTANT, "the heat changes", "hottest", "on 34 by 21 cells"], rows)


def noise(results):
    """The search, and the same with speeds that are not quite right."""
    rows = []
    for variant, deviation in ((AS_IT_IS, 0.0), (NOISY, NOISE)):
        wet = summary(results["search", variant][0], during(results["search", variant][0]))
        rows.append([f"{1e3 * deviation:g} mm/s", f"{1e-3 * wet['effort']:.1f} kN", f"{100.0 * wet['creepage']:.2f} %"])
    return markdown_table(["noise of the wheels' speeds", "effort", "mean creepage"], rows)


def energies(books):
    """Where the work of the motors goes."""
    rows = [[name, f"{1e-3 * value:.2f} kJ"] for name, value in books.items()]
    return markdown_table(["the search, 16 s", ""], rows)


def main():
    """Run, report, draw, write."""
    began = time.perf_counter()
    results, curves = all_runs(), steady_curves()
    print(f"  {len(results)} runs and {len(curves)} curves: {time.perf_counter() - began:.0f} s")
    plain = {name: results[name, AS_IT_IS][0] for name in CONTROLLERS}
    tables = {
        "gains": gains(plain, most(curves[AS_IT_IS])),
        "prices": prices(plain),
        "noise": noise(results),
        "heat": heat(results),
        "curve": curve(curves),
        "wheelsets": wheelsets(plain),
        "energies": energies(results["search", AS_IT_IS][1]["energies"]),
    }
    write_tables("adhesion.md", tables)
    # All runs take the same control periods.
    columns = {"time": plain["search"]["time"]}
    for name, table in plain.items():
        columns[f"effort {name}"] = effort(table)
        columns |= {f"creepage_{axle + 1} {name}": creepage(table)[:, axle] for axle in range(len(AXLES))}
    write_csv("adhesion.csv", columns)
    adhesion_pictures.draw(results, curves)


if __name__ == "__main__":
    main()
