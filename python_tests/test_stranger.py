"""A stranger's first hour: README from its first command to its last, in order, in a fresh folder and environment.

Every block of code is run as it is written, by one shell. Only what compiles is answered with what this session has
built: `make` puts it where it would have, and `cargo run` leaves the lines of Rust to the documentation test of
src/lib.rs. A command that nothing here or elsewhere runs fails the test.
"""

import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import matplotlib.image
import numpy as np
import pytest

REPOSITORY = Path(__file__).resolve().parent.parent
README = REPOSITORY / "README.md"
INTERFACE = REPOSITORY / "docs" / "fmi.md"
PICTURE = "docs/braking.png"
STALE = f"{PICTURE} is not what README's lines draw: run `make docs` and commit what it changes"
UNKNOWN = "README shows a command that no test runs"
BLOCK = re.compile(r"^```(\w*)\n(.*?)^```", re.MULTILINE | re.DOTALL)
# Of the clone, what a stranger's commands read; examples and studies are copied, as they write beside themselves.
LINKED = ("Cargo.toml", "Cargo.lock", "benches", "modelDescription", "presets", "python", "src", "tests")

# The stand-ins for what compiles: what `make` is asked for is made by this test, with the same commands.
SHELL = """set -euo pipefail
make() {
  for target; do
    case $target in
      wheel) mkdir dist; cp "$BUILT_WHEEL" dist/ ;;
      command) cp "$BUILT/release/wheelrail" target/release/ ;;
      demo) cp "$BUILT/WheelRailContact.fmu" target/; "$TESTING" studies braking_demo
            cp target/WheelRailContact.fmu results/ ;;
      *) echo "UNKNOWN: make $target"; exit 1 ;;
    esac
  done
}
pip() {
  # The packages that a wheel needs are fetched by uv, in a fifth of pip's time. uv installs the wheel as well, which is
  # taken off again: pip installs it, and all that uv could not.
  case $2 in *.whl)
    uv() { "$TESTING" -m uv pip "$@" --quiet --python environment; }
    if uv install "$2"; then uv uninstall wheelrail; fi ;;
  esac
  command pip "$@"
}
cargo() {
  case $1 in
    run) grep -q 'include_str!("../README.md")' ../wheelrail/src/lib.rs ;;
    *) command cargo "$@" ;;
  esac
}
""".replace("UNKNOWN", UNKNOWN)

# Commands in the running text that are more than `make` and a target, and what runs them.
ELSEWHERE = {
    "cargo bench --bench patch": ("Cargo.toml", 'name = "patch"'),
    "cargo bench --bench rough_track": ("Cargo.toml", 'name = "rough_track"'),
    "cargo doc --open": ("Makefile", "$(CARGO) doc"),
    "cargo run --release": ("src/lib.rs", 'include_str!("../README.md")'),
    "pip install dist/wheelrail-*linux*.whl": ("README.md", "pip install dist/wheelrail-*linux*.whl"),
}


def script(*documents):
    """Return the blocks of documents as one script for a shell, and how many there are in each language."""
    pieces, counts = [SHELL], {}
    for document in documents:
        for language, code in BLOCK.findall(document.read_text()):
            counts[language] = counts.get(language, 0) + 1
            pieces.append(f"echo '== {document.name}, {language} {counts[language]}'")
            if language == "sh":
                pieces.append(code)
            elif language == "python":
                pieces.append(f"python <<'END OF PYTHON'\n{code}END OF PYTHON")
            else:
                # Compiled and run by `cargo test --doc`.
                assert language == "rust" and document == README, f"{UNKNOWN}: a block of {language or 'no language'}"
    return "\n".join(pieces), counts


@pytest.fixture(scope="module")
def clone(fmu, wheelrail, tmp_path_factory):
    """Return a folder that has of a fresh clone what README's commands read, nothing built."""
    folder = tmp_path_factory.mktemp("stranger") / "wheelrail"
    (folder / "target" / "release").mkdir(parents=True)
    for name in ("examples", "studies"):
        shutil.copytree(REPOSITORY / name, folder / name)
    for name in LINKED:
        (folder / name).symlink_to(REPOSITORY / name)
    return folder


@pytest.fixture(scope="module")
def wheel(fmu, wheelrail, tmp_path_factory):
    """Build the wheel as `make wheel` does; return its path."""
    folder = tmp_path_factory.mktemp("dist")
    build = [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", folder]
    subprocess.run(build, check=True, capture_output=True, cwd=REPOSITORY)
    return next(folder.glob("*.whl"))


@pytest.fixture(scope="module")
def printed(clone, wheel):
    """Run README, then the masters of docs/fmi.md; return what each block printed, by document and block."""
    text, counts = script(README)
    assert counts["sh"] >= 4 and counts["python"] >= 1 and counts["rust"] == 1
    # The FMU alone again, after README: `cd` has led elsewhere.
    masters, _ = script(INTERFACE)
    text += f"\ncd {clone}\npip install libcosimpy\n" + masters.removeprefix(SHELL)
    environment = {name: value for name, value in os.environ.items() if name not in ("PYTHONPATH", "VIRTUAL_ENV")}
    environment |= {
        "BUILT": str(REPOSITORY / "target"),
        "BUILT_WHEEL": str(wheel),
        "TESTING": sys.executable,
        "MPLBACKEND": "Agg",
        # The pinned versions; compiling all of them would take longer than the test.
        "PIP_CONSTRAINT": str(REPOSITORY / "requirements.txt"),
        "UV_CONSTRAINT": str(REPOSITORY / "requirements.txt"),
        "PIP_NO_COMPILE": "1",
        "PIP_DISABLE_PIP_VERSION_CHECK": "1",
        "PIP_QUIET": "1",
        # `pip` and `python` are those of the environment that README makes, or none.
        "PATH": os.pathsep.join(
            place for place in os.environ["PATH"].split(os.pathsep) if Path(place) != Path(sys.executable).parent
        ),
    }
    done = subprocess.run(["bash", "-c", text], capture_output=True, text=True, cwd=clone, env=environment)
    if "from versions: none" in done.stderr:
        pytest.skip(f"pip reaches no index: {done.stderr.splitlines()[-1]}")
    assert done.returncode == 0, done.stdout[-3000:] + done.stderr[-3000:]
    return dict(re.findall(r"^== (.*?)\n(.*?)(?=^== |\Z)", done.stdout, re.MULTILINE | re.DOTALL))


def test_python_says_what_a_person_wants(printed):
    """README's first lines of Python end with a sentence of a few numbers, of the size that the manoeuvre has."""
    said = printed["README.md, python 1"]
    assert len(said.splitlines()) <= 4 and "{" not in said
    degrees, second, friction, worn = map(float, re.findall(r"[\d.]+(?= |,)", said.replace(" then", "")))
    # Between 8.8 s and 9.6 s the slide protection holds the wheel; where the rail is hot, friction nears friction_hot.
    assert 300 < degrees < 450 and 8.8 < second < 9.7
    assert 0.25 <= friction < 0.3 and worn > 50


def test_readme_gives_the_picture_that_it_shows(printed, clone):
    """README's lines, the demo and docs/braking.png are the same picture."""
    files = (clone / "braking.png", clone / "results" / "braking.png", REPOSITORY / PICTURE)
    own, demo, shown = map(matplotlib.image.imread, files)
    assert own.shape == demo.shape and np.array_equal(own, demo)
    assert own.shape == shown.shape, STALE
    # On another machine round-off may move a line's edge from one pixel to its neighbour.
    assert np.mean(np.any(np.abs(own - shown) > 0.1, axis=2)) < 1e-3, STALE


def test_command_line_and_fmpy_write_tables(printed, clone):
    """The tables that README's commands name are there: the whole manoeuvre, hot where the wheel slides."""
    for name, column in (("out.csv", "peak_temperature"), ("braking.csv", "peak_temperature")):
        lines = [line for line in (clone / name).read_text().splitlines() if not line.startswith("#")]
        heads = [head.split(" ")[0].strip('"') for head in lines[0].split(",")]
        rows = np.array([line.split(",") for line in lines[1:]], dtype=float)
        assert rows[-1, heads.index("time")] >= 20.0
        assert rows[:, heads.index(column)].max() > 600.0
    assert "wheel_speed" in printed["README.md, sh 2"] and "contact_model" in printed["README.md, sh 2"]


def test_master_drives_the_fmu(printed):
    """The lines of libcosim in docs/fmi.md print the traction force and the temperature."""
    traction, temperature = json.loads(printed["fmi.md, python 1"].splitlines()[-1])
    assert 20e3 < traction < 27.1e3
    assert temperature > 300.0


def commands(document):
    """Return the commands in the running text."""
    text = BLOCK.sub("", document.read_text())
    shown = [" ".join(code.split()) for code in re.findall(r"`([^`]+)`", text)]
    programs = ("make", "cargo", "pip", "python", "python3", "wheelrail", "fmpy", "target/release/wheelrail")
    return {code.removeprefix("time ") for code in shown if code.removeprefix("time ").partition(" ")[0] in programs}


def test_commands_in_the_text():
    """What README names between its blocks is a target of the Makefile, a name, or run by what is said here."""
    for command in sorted(commands(README)):
        program, _, rest = command.partition(" ")
        if program == "make" and rest and "…" not in rest:
            done = subprocess.run(["make", "-n", *rest.split()], capture_output=True, text=True, cwd=REPOSITORY)
            assert done.returncode == 0, f"{UNKNOWN}: {command}: {done.stderr}"
        elif rest and "…" not in rest:
            assert command in ELSEWHERE, f"{UNKNOWN}: {command}"
            file, what = ELSEWHERE[command]
            assert what in (REPOSITORY / file).read_text(), f"{UNKNOWN}: {command} was run by {file}"
