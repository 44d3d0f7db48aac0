"""The documentation site: it builds without a warning, its links lead somewhere, and reading it needs no network."""

import subprocess
import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote

import numpy as np
import pytest

REPOSITORY = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(REPOSITORY / "tools"))

import verification_figures  # noqa: E402


class Page(HTMLParser):
    """What a page defines, links to, loads and typesets."""

    def __init__(self, path):
        """Read the page."""
        super().__init__()
        self.names, self.links, self.loaded, self.formulas = set(), [], [], 0
        self.feed(path.read_text())

    def handle_starttag(self, tag, attributes):
        """Collect."""
        attributes = dict(attributes)
        self.names.add(attributes.get("id"))
        self.formulas += tag == "math"
        if tag == "a":
            self.links.append(attributes.get("href") or "")
        elif "src" in attributes or tag == "link":
            self.loaded.append(attributes.get("src") or attributes["href"])


@pytest.fixture(scope="module")
def pages(wheelrail, tmp_path_factory):
    """Build the site; return its pages by path."""
    site = tmp_path_factory.mktemp("site")
    command = [sys.executable, REPOSITORY / "tools" / "build_site.py", "--output", site]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    return {path: Page(path) for path in site.rglob("*.html") if "_static" not in path.parts}


def test_every_page_is_there(pages):
    """One for each source, those of the couplings among them."""
    names = {path.stem for path in pages}
    assert {path.stem for path in (REPOSITORY / "docs").rglob("*.md")} | {"changelog"} <= names


def test_links_lead_somewhere(pages):
    """Every page, anchor, picture, script and style sheet that a page names within the site exists."""
    for path, page in pages.items():
        for target in page.links + page.loaded:
            if "://" in target or target.startswith(("mailto:", "data:")):
                continue
            file, _, name = unquote(target).partition("#")
            other = (path.parent / file.partition("?")[0]).resolve() if file else path
            assert other.exists(), f"{path.name}: {target}"
            if name and other in pages:
                assert name in pages[other].names, f"{path.name}: {target}"


def test_nothing_is_loaded_from_elsewhere(pages):
    """No script, style sheet, font or picture comes from the network."""
    for path, page in pages.items():
        assert not [target for target in page.loaded if "//" in target], path.name
    for path in next(iter(pages)).parent.rglob("*.css"):
        assert "url(http" not in path.read_text() and "@import" not in path.read_text(), path.name


def test_equations_are_typeset(pages):
    """The formulas of the pages are MathML, and none is left as LaTeX or in a letter that browsers do not know."""
    formulas = {path.stem: page.formulas for path, page in pages.items()}
    assert formulas["model"] > 30 and formulas["patch"] > 30
    assert formulas["method"] > 10 and formulas["verification"] > 3
    for path in pages:
        text = path.read_text()
        for left in ("\\frac", "\\tag", "\\begin", "$$", 'mathvariant="bold', "Undefined"):
            assert left not in text, f"{path.name}: {left}"


def test_curves_of_the_verification(wheelrail, tmp_path):
    """What the pictures show lies within the tolerances of the rows of `wheelrail verify`."""
    columns = verification_figures.curves(tmp_path)
    assert set(columns) == set(verification_figures.DRAW)
    load, x, pressure, hertz = columns["hertz"]
    # The pressure of a node at the end of the contact is a mean over its share.
    inside = hertz > 0.5 * np.array([hertz[load == one].max() for one in load])
    assert np.abs(pressure / np.where(inside, hertz, np.inf) - 1.0)[inside].max() < 0.01
    assert np.array_equal(np.unique(load), [20e3, 50e3, 100e3]) and np.ptp(x) > 0.01
    _, traction, carter = columns["carter"]
    assert np.abs(traction - carter).max() < 0.02
    _, rise, integral = columns["flash_temperature"]
    assert rise.max() == pytest.approx(integral.max(), rel=0.005)
    assert np.abs(rise - integral).max() < 0.02 * integral.max()
