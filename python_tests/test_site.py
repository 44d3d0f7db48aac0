"""The documentation site: it builds without a warning, its links lead somewhere, and reading it needs no network."""

import json
import re
import shutil
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
        self.before_tables, self.last_opened = [], None
        self.feed(path.read_text())

    def handle_starttag(self, tag, attributes):
        """Collect."""
        attributes = dict(attributes)
        self.names.add(attributes.get("id"))
        self.formulas += tag == "math"
        if tag == "table":
            self.before_tables.append(self.last_opened)
        self.last_opened = (tag, (attributes.get("class") or "").split())
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


def in_chromium(page, folder, seconds=20):
    """Return the elements of a page of this machine as Chromium has them after some seconds of its own clock."""
    browser = shutil.which("chromium")
    if browser is None:
        pytest.skip("no chromium (Debian: chromium)")
    options = ["--headless", "--no-sandbox", "--disable-gpu", "--no-first-run", "--disable-background-networking"]
    options += ["--disable-component-update", "--disable-sync", "--disable-quic", "--window-size=800,1000"]
    # The frame below is another file, which is looked into; pages that fetch other files still may not.
    options += ["--allow-file-access-from-files"] if page.startswith("file:") and "?" not in page else []
    options += [f"--user-data-dir={folder}", f"--virtual-time-budget={1000 * seconds}", "--dump-dom", page]
    done = subprocess.run([browser, *options], capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_search_knows_the_text_of_every_page(pages):
    """What search shows of a page comes along as a script: each page, and each heading that it can lead to."""
    site = next(path.parent for path in pages if path.name == "search.html")
    assert "_static/page_texts.js" in {target.partition("?")[0] for target in pages[site / "search.html"].loaded}
    script = (site / "_static" / "page_texts.js").read_text()
    texts = json.loads(re.search(r"const pages = (\{.*\});$", script, re.MULTILINE)[1])
    index = json.loads(re.search(r"Search.setIndex\((.*)\)", (site / "searchindex.js").read_text())[1])
    assert set(texts) == {f"{name}.html" for name in index["docnames"]}
    for title, places in index["alltitles"].items():
        for number, anchor in places:
            page = texts[f"{index['docnames'][number]}.html"]
            assert anchor is None or f'<div id="{anchor}">' in page, title
            assert page.count("<div") == page.count("</div>"), title
    assert "A suspension damps that up to a critical speed" in texts["couplings/hunting.html"]


def test_search_shows_excerpts_of_files(pages, tmp_path):
    """Each result of a search has a piece of its page, without a server."""
    site = next(path.parent for path in pages if path.name == "search.html")
    found = in_chromium(f"{(site / 'search.html').as_uri()}?q=flange", tmp_path)
    results = re.findall(r'<li class="kind-.*?</li>', found, re.DOTALL)
    assert len(results) >= 2
    for result in results:
        excerpt = re.search(r'<p class="context">(.*?)</p>', result, re.DOTALL)
        assert excerpt and "flange" in excerpt[1].lower(), result


PHONE = """<!doctype html><pre id="seen"></pre>
<iframe id="frame" style="width: 390px; height: 844px; border: 0"></iframe>
<script>
async function look() {
  const frame = document.getElementById("frame"), seen = {};
  for (const page of %s) {
    await new Promise((done) => { frame.onload = done; frame.src = page; });
    const inside = frame.contentDocument;
    seen[page] = {
      width: inside.documentElement.scrollWidth,
      tables: [...inside.querySelectorAll("table")].map((table) => ({
        width: table.offsetWidth, room: table.parentElement.clientWidth,
        overflow: getComputedStyle(table.parentElement).overflowX,
        narrowest: Math.min(...[...table.querySelectorAll("td")].filter((cell) => cell.textContent.length > 40)
          .map((cell) => cell.offsetWidth)),
      })),
    };
  }
  document.getElementById("seen").textContent = JSON.stringify(seen);
}
look();
</script>"""


def test_tables_can_scroll(pages):
    """Each table lies in an element that scrolls."""
    before = [opened for page in pages.values() for opened in page.before_tables]
    assert len(before) > 50
    assert all(tag == "div" and "table-wrapper" in classes for tag, classes in before)


def test_wide_tables_scroll_on_a_phone(pages, tmp_path):
    """At 390 points across no page is wider than the phone; a table that is scrolls, its text in readable columns."""
    view = tmp_path / "phone.html"
    view.write_text(PHONE % json.dumps([path.as_uri() for path in pages]))
    text = re.search(r'<pre id="seen">(.*?)</pre>', in_chromium(view.as_uri(), tmp_path / "user", 60), re.DOTALL)[1]
    seen = json.loads(text)
    assert len(seen) == len(pages)
    tables = [table for page in seen.values() for table in page["tables"]]
    assert all(page["width"] <= 390 for page in seen.values())
    wide = [table for table in tables if table["width"] > table["room"]]
    assert len(wide) > 20
    assert all(table["overflow"] == "auto" for table in wide)
    # Forty letters in at most three lines: where columns are pressed together it were a word a line.
    assert all(table["narrowest"] is None or table["narrowest"] > 120 for table in tables)


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
