"""Build the documentation site from docs/, warnings being errors (`make site`).

The sources are copied to target/site-source, next to what is not there as a file: the table of the verification
from `wheelrail verify`, and the changelog.
"""

import argparse
import shutil
import sys
from pathlib import Path

import update_docs
from sphinx.cmd.build import main as sphinx_build

SOURCE = update_docs.REPOSITORY / "target" / "site-source"
SITE = update_docs.REPOSITORY / "target" / "site"


PERFORMANCE = """# Performance

    make bench

measures a step, its percentiles, initialisation, and saving and restoring a state. Times depend on the machine and on
what else runs there.
"""


def verification_markdown():
    """Return the tables of the verification in Markdown."""
    lines = []
    for title, rows in update_docs.verification():
        lines += [f"### {title}", "", "| quantity | reference | computed | unit | deviation | tolerance | source |"]
        lines.append("|---|---|---|---|---|---|---|")
        for row in rows:
            cells = (
                row["quantity"],
                update_docs.figure(row["reference"]),
                update_docs.shown(row),
                row["unit"],
                f"{float(row['deviation']):.1e}",
                f"{float(row['tolerance']):.1e}",
                row["source"],
            )
            lines.append("| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |")
        lines.append("")
    return "\n".join(lines)


def main():
    """Copy, generate, build."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--output", type=Path, default=SITE, help="folder of the site")
    output = parser.parse_args().output
    for folder in (SOURCE, output):
        shutil.rmtree(folder, ignore_errors=True)
    shutil.copytree(update_docs.REPOSITORY / "docs", SOURCE)
    # Where docs/presets.md, seen from there, has them.
    shutil.copytree(update_docs.REPOSITORY / "presets", SOURCE.parent / "presets", dirs_exist_ok=True)
    if not (SOURCE / "performance.md").exists():
        (SOURCE / "performance.md").write_text(PERFORMANCE)
    generated = SOURCE / "generated"
    generated.mkdir()
    (generated / "verification.md").write_text(verification_markdown())
    shutil.copy(update_docs.REPOSITORY / "CHANGELOG.md", SOURCE / "changelog.md")
    code = sphinx_build(["-W", "--keep-going", "-q", "-E", "-d", f"{SOURCE}/.doctrees", str(SOURCE), str(output)])
    if code == 0:
        print(f"{output}/index.html")
    sys.exit(code)


if __name__ == "__main__":
    main()
