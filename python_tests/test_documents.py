"""README.md and the documentation say what the component does: tables are compared, the studies of the demo run."""

import csv
import html
import re
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

REPOSITORY = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(REPOSITORY / "tools"))

import update_docs  # noqa: E402

STALE = "run `make docs` and commit what it changes"
DRAWN = ["paper_cases", "braking_demo", "patch_fields", "profiles_contact", "wheelset_sweep"]


def block(path, marker):
    """Return what stands between a marker and its end."""
    found = re.search(rf"<!-- {marker} -->\n(.*?)<!-- end of {marker} -->", path.read_text(), re.DOTALL)
    assert found, marker
    return found[1].strip()


def cells(text):
    """Return the cells of an HTML table, row by row."""
    return [re.split(r"<t[dh](?: [^>]*)?>", row)[1:] for row in re.sub(r"\n", "", text).split("<tr>")[1:]]


@pytest.fixture(scope="module")
def studies(fmu, wheelrail, tmp_path_factory):
    """Run the studies of the demo in a copy of their folder; return what each printed, and the folder."""
    folder = tmp_path_factory.mktemp("copy")
    (folder / "target" / "release").mkdir(parents=True)
    shutil.copytree(REPOSITORY / "studies", folder / "studies")
    for linked in ("target/WheelRailContact.fmu", "target/release/wheelrail", "python", "examples"):
        (folder / linked).symlink_to(REPOSITORY / linked)
    printed = {}
    for name in DRAWN:
        command = [sys.executable, folder / "studies", name]
        done = subprocess.run(command, capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        printed[name] = done.stdout
    return printed, folder


@pytest.mark.parametrize("name", DRAWN)
def test_studies_write_what_they_say(name, studies):
    """Each study runs on its own, and every file that it names is there and not empty."""
    printed, folder = studies
    written = [line.split()[1] for line in printed[name].splitlines() if line.strip().startswith("wrote ")]
    assert {Path(name).suffix for name in written} == {".csv", ".png"}
    for path in written:
        assert (folder / path).stat().st_size > 300, path


def test_tables_of_variables():
    """The tables are those of `wheelrail describe`."""
    assert block(update_docs.VARIABLES, "wheelrail describe") == update_docs.variables_markdown().strip(), STALE
    assert block(update_docs.README, "first variables") == update_docs.first_variables_markdown().strip(), STALE
    assert block(update_docs.PAGE, "wheelrail describe") == update_docs.variables_html().strip(), STALE


def test_tables_list_every_variable(description):
    """Its page lists each variable of the model description, repeated ones by their first point, and nothing else."""
    listed = set(re.findall(r"^\| `([^`]+)`", block(update_docs.VARIABLES, "wheelrail describe"), re.MULTILINE))
    names = {re.sub(r"\[\d+\]", "[i]", variable.name) for variable in description.modelVariables}
    # `wheelrail describe` leaves out the solver's locals and the profiles' further points only.
    assert listed <= names
    assert {name for name in names if "solver." not in name} <= listed


def test_figures_of_the_paper_cases(studies):
    """The figures of the paper's cases are those of the simulation, to one unit of the last digit."""
    rows = [line.split("|")[1:-1] for line in block(update_docs.INDEX, "studies/paper_cases").splitlines()[2:]]
    shown = {row[0].strip(): [re.search(r"[\d.]+", cell)[0] for cell in row[1:]] for row in rows}
    with (studies[1] / "results" / "paper_cases.csv").open(newline="") as file:
        simulated = {row["case"]: row for row in csv.DictReader(file)}
    assert set(shown) == set(simulated)
    for case, row in simulated.items():
        values = (
            float(row["peak_temperature [K]"]) - 273.15,
            float(row["lower [K]"]),
            float(row["friction_coefficient [1]"]),
            float(row["traction_force [N]"]) / 1e3,
        )
        for text, value in zip(shown[case], values, strict=True):
            assert abs(float(text) - value) <= 10.0 ** -len(text.split(".")[1]), f"{case}: {text}, {value}; {STALE}"


def test_accuracy_of_the_patch():
    """The differences from the limits are those of the last `make demo`, if any, to one unit of the last digit."""
    if not update_docs.PATCH_ACCURACY.exists():
        pytest.skip("`make demo` writes results/patch_accuracy.csv")
    shown, fresh = (
        [[cell.strip() for cell in row.split("|")[1:-1]] for row in text.strip().splitlines()[2:]]
        for text in (block(update_docs.PATCH, "studies/patch_creep_curves"), update_docs.patch_accuracy_markdown())
    )
    assert [row[:3] for row in shown] == [row[:3] for row in fresh], STALE
    for one, other in zip(shown, fresh, strict=True):
        for text, value in zip(one[3:], other[3:], strict=True):
            assert abs(float(text) - float(value)) < 1.5e-4, f"{one}, {other}; {STALE}"


def test_table_of_the_manchester_benchmark():
    """The table is that of the last `make docs`, if any, to one unit of the last digit."""
    if not update_docs.MANCHESTER.exists():
        pytest.skip("`make docs` writes results/verification/manchester.csv")
    shown, fresh = (
        [[float(cell) for cell in row.split("|")[1:-1]] for row in text.strip().splitlines()[2:]]
        for text in (block(update_docs.PROFILES, "wheelrail verify --curves"), update_docs.manchester_markdown())
    )
    assert np.allclose(shown, fresh, rtol=1e-3, atol=1.0), STALE


def test_figures_of_the_verification():
    """The page's figures are those that `wheelrail verify` measures now, to a thousandth, or both are round-off."""
    fresh = [row for _, rows in update_docs.verification() for row in rows]
    shown = [row for row in cells(block(update_docs.PAGE, "wheelrail verify")) if len(row) == 5][1:]
    assert [row["quantity"] for row in fresh] == [html.unescape(row[0]) for row in shown], STALE
    for row, (quantity, reference, computed, unit, _) in zip(fresh, shown, strict=True):
        assert (float(reference), unit) == (pytest.approx(float(row["reference"]), rel=1e-3), row["unit"]), quantity
        scale = max(abs(float(row["reference"])), abs(float(row["computed"])), 1e-9)
        if computed.startswith("below"):
            assert abs(float(row["computed"])) < 1e-9, quantity
        else:
            assert abs(float(computed) - float(row["computed"])) <= 1e-3 * scale, f"{quantity}; {STALE}"


def test_links_of_readme():
    """Every file that README links to is in the repository."""
    targets = re.findall(r"\]\((?!http)([^)#]+)\)", update_docs.README.read_text())
    assert len(targets) >= 3
    for target in targets:
        assert (REPOSITORY / target).exists(), target


def test_named_files():
    """Every file of the repository and every Rust test that the documents name is there."""
    documents = [REPOSITORY / "README.md", REPOSITORY / "CONTRIBUTING.md", REPOSITORY / "CHANGELOG.md"]
    folders = "src|tests|python_tests|tools|examples|studies|benches|fuzz|docs|modelDescription"
    rust = {path.stem for path in (REPOSITORY / "tests").rglob("*.rs")}
    rust |= {path.stem for path in (REPOSITORY / "src").rglob("*.rs")}
    missing = []
    for document in [*documents, *(REPOSITORY / "docs").rglob("*.md")]:
        text = document.read_text()
        for name in re.findall(rf"(?<![\w/.-])(?:{folders})/[\w./-]*\w", text):
            if "NAME" not in name and not (REPOSITORY / name).exists():
                missing.append(f"{document.name}: {name}")
        for name in re.findall(r"`(test_\w+\.py)", text):
            if not (REPOSITORY / "python_tests" / name).exists():
                missing.append(f"{document.name}: {name}")
        for target, name in re.findall(r"cargo test (?:--release )?--test (\w+)(?: (\w+)::)?", text):
            path = REPOSITORY / "tests" / target
            if target != "NAME" and not (path.with_suffix(".rs").exists() or (path / "main.rs").exists()):
                missing.append(f"{document.name}: --test {target}")
            if name not in ("", "NAME") and not (path / f"{name}.rs").exists():
                missing.append(f"{document.name}: --test {target} {name}")
        # The tables of this document name Rust tests by their files, beside variables and terminals.
        if document.name == "fmi.md":
            rows = "\n".join(line for line in text.splitlines() if line.startswith("|"))
            names = set(re.findall(r"`([a-z_0-9]+)`", rows)) - {"fuzz"}
            described = (path.read_text() for path in (REPOSITORY / "modelDescription").rglob("*.xml"))
            names -= {name for text in described for name in re.findall(r' name="(\w+)"', text)}
            missing += [f"{document.name}: {name}" for name in sorted(names - rust)]
    assert not missing, missing


def test_documentation_page_is_well_formed():
    """Opened elements are closed, and the page names no file that is not in the FMU."""
    page = update_docs.PAGE.read_text()
    for tag in ("table", "ul", "h1", "h2", "h3", "div", "p", "i", "code", "cite", "sub", "sup", "b", "span"):
        opened = len(re.findall(rf"<{tag}[ >]", page))
        closed = len(re.findall(rf"</{tag}>", page))
        assert opened == closed, tag
    assert not re.findall(r'(?:src|href)="', page)
