"""A release: one version everywhere, and lists of what is linked in that agree with the lock file and the licences."""

import json
import re
import sys
import tomllib
import zipfile
from pathlib import Path

import pytest

REPOSITORY = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(REPOSITORY / "tools"))

import bill_of_materials  # noqa: E402
import third_party_licenses  # noqa: E402

CARGO = tomllib.loads((REPOSITORY / "Cargo.toml").read_text())["package"]
LISTS = [(output, output.with_suffix(".cdx.json"), features) for output, _, features in third_party_licenses.OUTPUTS]


def test_version_is_that_of_the_crate():
    """Citation, changelog, lock files, model descriptions and bills of materials have Cargo.toml's version."""
    version = CARGO["version"]
    citation = (REPOSITORY / "CITATION.cff").read_text()
    assert re.findall(r"^version: (.+)$", citation, re.MULTILINE) == [version]
    headings = re.findall(r"^## \[([^\]]+)\]", (REPOSITORY / "CHANGELOG.md").read_text(), re.MULTILINE)
    assert version == next(heading for heading in headings if heading != "Unreleased")
    for lock in (REPOSITORY / "Cargo.lock", REPOSITORY / "fuzz" / "Cargo.lock"):
        (own,) = (one for one in tomllib.loads(lock.read_text())["package"] if one["name"] == "wheelrail")
        assert own["version"] == version, lock
    for xml in (REPOSITORY / "modelDescription").rglob("modelDescription.xml"):
        assert f' version="{version}"' in xml.read_text(), xml
    for _, bill, _ in LISTS:
        assert json.loads(bill.read_text())["metadata"]["component"]["version"] == version, bill


def test_citation_is_what_the_format_asks_for():
    """What CFF 1.2.0 requires is there, with the licences of Cargo.toml."""
    text = (REPOSITORY / "CITATION.cff").read_text()
    keys = set(re.findall(r"^([a-z-]+):", text, re.MULTILINE))
    assert {"cff-version", "message", "title", "authors"} <= keys
    assert re.findall(r"^  - (MIT|Apache-2.0)$", text, re.MULTILINE) == CARGO["license"].split(" OR ")


@pytest.mark.parametrize(("texts", "bill", "features"), LISTS, ids=lambda value: str(value).rpartition("/")[2])
def test_bill_of_materials(texts, bill, features):
    """It has the crates whose licence texts are shipped, each with the lock file's checksum, and is not stale."""
    found = json.loads(bill.read_text())
    assert (found["bomFormat"], found["specVersion"]) == ("CycloneDX", "1.5")
    listed = re.findall(r"^([\w-]+) (\d\S*): ", texts.read_text(), re.MULTILINE)
    assert [(one["name"], one["version"]) for one in found["components"]] == listed
    sums = bill_of_materials.checksums()
    for one in found["components"]:
        assert one["hashes"][0]["content"] == sums[one["name"], one["version"]]
    # Each reference leads somewhere, and each crate is needed by another.
    references = {one["bom-ref"] for one in found["components"]} | {found["metadata"]["component"]["bom-ref"]}
    assert {one["ref"] for one in found["dependencies"]} == references
    needed = {other for one in found["dependencies"] for other in one["dependsOn"]}
    assert needed == references - {found["metadata"]["component"]["bom-ref"]}
    what = "library" if "MODEL" in str(bill).upper() else "command"
    fresh = json.dumps(bill_of_materials.bill(what, features), indent=1, ensure_ascii=False) + "\n"
    assert fresh == bill.read_text(), "run `python tools/bill_of_materials.py` and commit what it changes"


def test_licences_are_allowed():
    """Each linked crate offers a licence that deny.toml allows."""
    allowed = set(tomllib.loads((REPOSITORY / "deny.toml").read_text())["licenses"]["allow"])
    for _, bill, _ in LISTS:
        for one in json.loads(bill.read_text())["components"]:
            (licence,) = one["licenses"]
            choices = re.sub(r"[()]", "", licence["expression"]).split(" OR ")
            assert any(set(choice.split(" AND ")) <= allowed for choice in choices), one["name"]


def test_archives_have_it(fmu):
    """Both archives have the bill of materials as it is checked in."""
    own = (REPOSITORY / "modelDescription" / "licenses" / "THIRD-PARTY.cdx.json").read_bytes()
    for path in (fmu, REPOSITORY / "target" / "WheelRailContact-fmi3.fmu"):
        with zipfile.ZipFile(path) as archive:
            assert archive.read("documentation/licenses/THIRD-PARTY.cdx.json") == own
