"""Where the modules of the studies are: in a folder for each study, and one for what they share.

Each has a name of its own, so that one study can take from another what it needs: `from stiff import iterating`.
"""

from pathlib import Path

STUDIES = Path(__file__).resolve().parent


def folders():
    """Return the folders, for Python's path."""
    return [str(folder) for folder in sorted(STUDIES.iterdir()) if any(folder.glob("*.py"))]


def studies():
    """Return the program of each study by its name: NAME/NAME.py."""
    programs = ((folder.name, folder / f"{folder.name}.py") for folder in sorted(STUDIES.iterdir()))
    return {name: program for name, program in programs if program.exists()}
