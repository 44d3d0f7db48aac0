"""Write what is linked into the library and into the command line as CycloneDX, from Cargo.lock and cargo's metadata.

modelDescription/licenses/THIRD-PARTY.cdx.json goes into the FMU, python/licenses/COMMAND.cdx.json with the command into
the wheel. No time and no random number is in them: the same lock file gives the same bytes.

Usage: python tools/bill_of_materials.py   (in the repository, after `cargo fetch`)
"""

import json
import subprocess
import tomllib

from third_party_licenses import OUTPUTS, REPOSITORY, linked_packages

SPECIFICATION = "1.5"


def reference(package):
    """Return how others name a package: its package URL."""
    return f"pkg:cargo/{package['name']}@{package['version']}"


def checksums():
    """Checksums of the packages' archives by name and version."""
    lock = tomllib.loads((REPOSITORY / "Cargo.lock").read_text(encoding="utf-8"))
    return {(one["name"], one["version"]): one["checksum"] for one in lock["package"] if "checksum" in one}


def component(package, checksum):
    """A package as a component."""
    found = {
        "type": "library",
        "bom-ref": reference(package),
        "name": package["name"],
        "version": package["version"],
        "hashes": [{"alg": "SHA-256", "content": checksum}],
        # The older spelling of OR in Cargo.toml.
        "licenses": [{"expression": package["license"].replace("/", " OR ")}],
        "purl": reference(package),
    }
    if package["repository"]:
        found["externalReferences"] = [{"type": "vcs", "url": package["repository"]}]
    return found


def needs(packages, features):
    """What each of the linked packages, and the crate itself, needs of them."""
    metadata = json.loads(
        subprocess.check_output(
            ["cargo", "metadata", "--locked", "--format-version", "1", "--no-default-features", "--features", features],
            cwd=REPOSITORY,
            text=True,
        )
    )
    named = {package["id"]: reference(package) for package in packages}
    crate = metadata["resolve"]["root"]
    (own,) = (package for package in metadata["packages"] if package["id"] == crate)
    named[crate] = reference(own)
    normal = {
        node["id"]: [one["pkg"] for one in node["deps"] if any(kind["kind"] is None for kind in one["dep_kinds"])]
        for node in metadata["resolve"]["nodes"]
    }
    lists = {named[one]: sorted({named[other] for other in normal[one] if other in named}) for one in named}
    return own, [{"ref": one, "dependsOn": others} for one, others in sorted(lists.items())]


def bill(what, features):
    """The bill of materials of what is built with some features."""
    packages, sums = linked_packages(features), checksums()
    own, lists = needs(packages, features)
    crate = {
        "type": "library" if what == "library" else "application",
        "bom-ref": reference(own),
        "name": own["name"],
        "version": own["version"],
        "description": own["description"],
        "licenses": [{"expression": own["license"]}],
    }
    return {
        "$schema": f"http://cyclonedx.org/schema/bom-{SPECIFICATION}.schema.json",
        "bomFormat": "CycloneDX",
        "specVersion": SPECIFICATION,
        "version": 1,
        "metadata": {"component": crate},
        "components": [component(one, sums[one["name"], one["version"]]) for one in packages],
        "dependencies": lists,
    }


def main():
    """Write each file, beside the licence texts."""
    for output, what, features in OUTPUTS:
        text = json.dumps(bill(what, features), indent=1, ensure_ascii=False)
        output.with_suffix(".cdx.json").write_text(text + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
