"""Write what is linked into the library and into the command line, with the licence texts.

modelDescription/licenses/THIRD-PARTY.txt goes into the FMU, python/licenses/COMMAND.txt with the command into the
wheel.

Usage: python tools/third_party_licenses.py   (in the repository, after `cargo fetch`)
"""

import hashlib
import json
import subprocess
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parent.parent
# Platforms of a wheel with the command line. What one of them alone links is in the lists of both.
TARGETS = ("x86_64-unknown-linux-gnu", "x86_64-pc-windows-gnu")
# The files, what each is of, and the features that it is built with.
OUTPUTS = [
    (REPOSITORY / "modelDescription" / "licenses" / "THIRD-PARTY.txt", "library", "fmi"),
    (REPOSITORY / "python" / "licenses" / "COMMAND.txt", "command", "cli"),
]


def linked_packages(features):
    """Packages of the normal dependencies with some features, procedural macros and build scripts left out."""
    options = ["--no-default-features", "--features", features, "--edges", "normal,no-proc-macro", "--prefix", "none"]
    options += [word for target in TARGETS for word in ("--target", target)]
    tree = subprocess.check_output(["cargo", "tree", *options, "--format", "{p}"], cwd=REPOSITORY, text=True)
    linked = {tuple(line.split()[:2]) for line in tree.splitlines() if line.strip()}
    metadata = json.loads(
        subprocess.check_output(
            ["cargo", "metadata", "--format-version", "1", "--no-default-features", "--features", features],
            cwd=REPOSITORY,
            text=True,
        )
    )
    packages = [p for p in metadata["packages"] if (p["name"], "v" + p["version"]) in linked]
    return sorted((p for p in packages if p["source"]), key=lambda p: (p["name"], p["version"]))


def licence_texts(package):
    """The licence files that come with a package."""
    folder = Path(package["manifest_path"]).parent
    names = [
        p
        for p in folder.iterdir()
        if p.is_file() and p.name.upper().startswith(("LICENSE", "LICENCE", "COPYING", "NOTICE", "UNLICENSE"))
    ]
    return [p.read_text(encoding="utf-8", errors="replace").replace("\r\n", "\n").strip() for p in sorted(names)]


def main():
    """Write each file."""
    for output, what, features in OUTPUTS:
        write(output, what, features)


def write(output, what, features):
    """Write the list, then each text once."""
    texts = {}
    lines = [f"Software linked into the wheelrail {what}", "", "The Rust standard library: MIT OR Apache-2.0", ""]
    for package in linked_packages(features):
        numbers = []
        for text in licence_texts(package):
            key = hashlib.sha256(" ".join(text.split()).encode()).hexdigest()
            numbers.append(texts.setdefault(key, (len(texts) + 1, text))[0])
        where = ", ".join(f"[{n}]" for n in sorted(set(numbers))) or "no text in the package"
        lines.append(f"{package['name']} {package['version']}: {package['license']}  {where}")
    for number, text in texts.values():
        lines += ["", "=" * 100, f"[{number}]", "", text]
    output.parent.mkdir(exist_ok=True)
    output.write_text("\n".join(lines) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
