"""Write the generated parts of README.md and of the documentation, between their markers (`make docs`).

- the tables of variables, from `wheelrail describe`: all of them, and for README those to begin with;
- the figures of the paper's cases, from results/paper_cases.csv, which studies/paper_cases writes;
- the accuracy of the patch, from results/patch_accuracy.csv, which studies/patch_creep_curves writes;
- the Manchester benchmark, from results/verification/manchester.csv, which tools/verification_figures.py writes;
- the figures of the verification, from target/verification.txt, which `make verify` writes.

With the argument `couplings` (`make couplings-docs`) the tables of the pages in docs/couplings/, with `measurements`
(`make measurements-docs`) those of docs/measurements.md, from those in results/.
"""

import csv
import html
import re
import subprocess
import sys
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parent.parent
WHEELRAIL = REPOSITORY / "target" / "release" / "wheelrail"
README = REPOSITORY / "README.md"
VARIABLES = REPOSITORY / "docs" / "variables.md"
INDEX = REPOSITORY / "docs" / "index.md"
PAGE = REPOSITORY / "modelDescription" / "documentation" / "index.html"
VERIFICATION = REPOSITORY / "target" / "verification.txt"
STIFF, *_ = COUPLING_PAGES = tuple(
    REPOSITORY / "docs" / "couplings" / f"{name}.md"
    for name in ("stiff", "hunting", "adhesion", "maintenance", "height", "curve", "mileage")
)
MEASUREMENTS = REPOSITORY / "docs" / "measurements.md"
MEASURED = ("measurements_eurosprinter.md", "measurements_twin_disc.md")
PAPER_CASES = REPOSITORY / "results" / "paper_cases.csv"
PATCH = REPOSITORY / "docs" / "patch.md"
PATCH_ACCURACY = REPOSITORY / "results" / "patch_accuracy.csv"
PROFILES = REPOSITORY / "docs" / "profiles.md"
MANCHESTER = REPOSITORY / "results" / "verification" / "manchester.csv"

# What one sets and reads first.
FIRST = ["wheel_speed", "creepage", "vehicle_speed", "normal_load", "lateral_creepage", "spin_creepage"]
FIRST += ["contact_model", "slip_source", "friction_law"]
FIRST += ["traction_force", "friction_torque", "lateral_force", "spin_moment"]
FIRST += ["peak_temperature", "friction_coefficient", "worn_volume"]


def variables():
    """Return (title, rows) of each group; of repeated variables only the first."""
    text = subprocess.check_output([WHEELRAIL, "describe", "--markdown"], text=True).replace(", this is number 1", "")
    groups = []
    for block in text.split("### ")[1:]:
        title, *lines = block.splitlines()
        rows = [[cell.strip() for cell in line.strip("|").split(" | ")] for line in lines if line.startswith("| `")]
        rows = [row for row in rows if not re.search(r"\[(?!1\])\d+\]", row[0])]
        groups.append((title, [[row[0].strip("| `"), *(cell.strip(" |") for cell in row[1:])] for row in rows]))
    return groups


def repeats(name):
    """Return a name as people write it: [1] stands for all points."""
    return name.replace("[1]", "[i]")


def variables_markdown():
    """Return the tables of variables in Markdown."""
    lines = []
    for title, rows in variables():
        lines += [f"## {title}", "", "| name | unit | start | range | description |", "|---|---|---|---|---|"]
        for name, *cells in rows:
            name, *tunable = name.split()
            shown = f"`{repeats(name)}`" + "".join(f" {mark}" for mark in tunable)
            lines.append(f"| {shown} | {' | '.join(cells)} |")
        lines.append("")
    return "\n".join(lines)


def first_variables_markdown():
    """Return the table of the variables to begin with in Markdown."""
    kinds = {"Inputs": "input", "Outputs": "output"}
    rows = {row[0].split()[0]: (kinds.get(title, "parameter"), row) for title, group in variables() for row in group}
    lines = ["| | name | unit | start | description |", "|---|---|---|---|---|"]
    for name in FIRST:
        kind, (_, unit, start, _, description) = rows[name]
        lines.append(f"| {kind} | `{name}` | {unit} | {start} | {description} |")
    return "\n".join(lines)


def variables_html():
    """Return the tables of variables in HTML."""
    lines = []
    for title, rows in variables():
        lines += [f"<h3>{title}</h3>", "<table>", "<tr><th>name<th>unit<th>start<th>range<th>description"]
        for name, *cells in rows:
            name, *tunable = name.split()
            shown = f"<code>{repeats(name)}</code>" + "".join(f" {mark}" for mark in tunable)
            lines.append("<tr>" + "".join(f"<td>{cell}" for cell in (shown, *map(html.escape, cells))))
        lines.append("</table>")
    return "\n".join(lines)


def paper_cases_markdown():
    """Return the figures of the paper's cases as a Markdown table."""
    with PAPER_CASES.open(newline="") as file:
        rows = list(csv.DictReader(file))
    lines = ["| case | peak temperature | lower than constant μ by | mean friction coefficient | traction |"]
    lines.append("|---|---|---|---|---|")
    for row in rows:
        lines.append(
            f"| {row['case']} | {float(row['peak_temperature [K]']) - 273.15:.1f} °C"
            f" | {float(row['lower [K]']):.1f} K | {float(row['friction_coefficient [1]']):.3f}"
            f" | {float(row['traction_force [N]']) / 1e3:.1f} kN |"
        )
    return "\n".join(lines) + "\n"


def patch_accuracy_markdown():
    """Return the largest differences from the limits of fine grids as a Markdown table."""
    with PATCH_ACCURACY.open(newline="") as file:
        rows = list(csv.DictReader(file))
    lines = ["| $a/b$ | points | by | $F_x/(\\mu N)$ | $F_y/(\\mu N)$ | $M_z/(\\mu Nc)$ |", "|---|---|---|---|---|---|"]
    for row in rows:
        off = " | ".join(f"{float(row[f'{force} [1]']):.4f}" for force in ("Fx", "Fy", "Mz"))
        lines.append(f"| {row['a/b [1]']} | {row['points']} | {row['by']} | {off} |")
    return "\n".join(lines) + "\n"


def manchester_markdown():
    """Return the right wheel of the Manchester benchmark beside CONTACT's as a Markdown table."""
    with MANCHESTER.open(newline="") as file:
        rows = [[float(cell) for cell in row] for row in list(csv.reader(file))[1:]]
    lines = ["| $y$ | contacts | $F_x$ | curved | plane | $F_y$ | curved | peak | CONTACT | area | CONTACT |"]
    lines.append("|" + "---|" * 11)
    for right, lateral, contacts, *values in rows:
        if right == 1.0:
            digits = (0, 0, 0, 0, 0, 0, 0, 1, 1)
            cells = [f"{value:.{places}f}" for value, places in zip(values, digits, strict=True)]
            lines.append(f"| {lateral:g} | {contacts:.0f} | {' | '.join(cells)} |".replace("| -0 |", "| 0 |"))
    return "\n".join(lines) + "\n"


ROW = re.compile(
    r"^  (?P<quantity>\S.*?)\s{2,}(?P<reference>[-\d.e]+)\s+(?P<computed>[-\d.e]+) (?P<unit>\S+)"
    r"\s+(?P<deviation>[-\d.e]+)\s+(?P<tolerance>[-\d.e]+)\s+(?P<passed>yes|NO)\s+(?P<source>.*)$"
)


def verification():
    """Return (title, rows) of each group that `wheelrail verify` printed."""
    if not VERIFICATION.exists() or VERIFICATION.stat().st_mtime < WHEELRAIL.stat().st_mtime:
        sys.exit(f"{VERIFICATION} is not of this build: run `make verify`")
    text, groups = VERIFICATION.read_text(), []
    for line in text.splitlines()[1:]:
        if match := ROW.match(line):
            groups[-1][1].append(match.groupdict())
        elif line and not line[0].isdigit():
            groups.append((line.strip(), []))
    failed = [row["quantity"] for _, rows in groups for row in rows if row["passed"] != "yes"]
    if failed:
        sys.exit(f"`wheelrail verify` fails, so nothing is written: {', '.join(failed)}")
    return groups


def figure(text):
    """Return four significant digits."""
    return f"{float(text):.4g}"


def shown(row):
    """Return the computed figure of a row; what is nothing but round-off differs from machine to machine."""
    noise = float(row["reference"]) == 0.0 and abs(float(row["computed"])) < 1e-9
    return f"below {figure(row['tolerance'])}" if noise else figure(row["computed"])


def verification_html():
    """Return the figures of the verification in HTML."""
    lines = ["<table>", "<tr><th>quantity<th>reference<th>computed<th>unit<th>source of the reference"]
    for title, rows in verification():
        lines.append(f'<tr><th colspan="5">{html.escape(title)}')
        for row in rows:
            cells = (row["quantity"], figure(row["reference"]), shown(row), row["unit"], row["source"])
            lines.append("<tr>" + "".join(f"<td>{html.escape(cell)}" for cell in cells))
    return "\n".join([*lines, "</table>"])


def between(text, marker, content):
    """Replace what stands between a marker and its end."""
    pattern = re.compile(rf"(<!-- {marker} -->\n).*?(<!-- end of {marker} -->)", re.DOTALL)
    replaced, count = pattern.subn(lambda match: f"{match[1]}{content.rstrip()}\n{match[2]}", text)
    assert count == 1, f"marker {marker!r} is there {count} times"
    return replaced


def write(path, parts):
    """Replace the parts of a file that stand between markers."""
    text = path.read_text()
    for marker, content in parts.items():
        text = between(text, marker, content)
    path.write_text(text)


def blocks(text):
    """What stands between markers, by marker."""
    return dict(re.findall(r"<!-- (.+?) -->\n(.*?)<!-- end of \1 -->", text, re.DOTALL))


def main():
    """Write all parts."""
    if sys.argv[1:] == ["couplings"]:
        for page in COUPLING_PAGES:
            write(page, blocks((REPOSITORY / "results" / page.name).read_text()))
        return
    if sys.argv[1:] == ["measurements"]:
        for name in MEASURED:
            write(MEASUREMENTS, blocks((REPOSITORY / "results" / name).read_text()))
        return
    write(README, {"first variables": first_variables_markdown()})
    write(VARIABLES, {"wheelrail describe": variables_markdown()})
    write(INDEX, {"studies/paper_cases": paper_cases_markdown()})
    write(PATCH, {"studies/patch_creep_curves": patch_accuracy_markdown()})
    write(PROFILES, {"wheelrail verify --curves": manchester_markdown()})
    write(PAGE, {"wheelrail describe": variables_html(), "wheelrail verify": verification_html()})


if __name__ == "__main__":
    main()
