"""Run a study by its name, with its options; without a name, say which there are.

.venv/bin/python studies hunting
"""

import ast
import runpy
import sys

from folders import folders, studies


def main():
    """Run the study that is named."""
    programs = studies()
    if len(sys.argv) < 2 or sys.argv[1] not in programs:
        for name, program in programs.items():
            print(f"{name:20} {documentation(program).splitlines()[0]}")
        sys.exit(0 if len(sys.argv) < 2 else f"there is no study {sys.argv[1]}")
    name = sys.argv.pop(1)
    # Most have no options: such a one would not look at what it is given, and begin to compute.
    if len(sys.argv) > 1 and "ArgumentParser" not in programs[name].read_text():
        if sys.argv[1] in ("-h", "--help"):
            print(documentation(programs[name]))
            sys.exit()
        sys.exit(f"{name} has no options: {' '.join(sys.argv[1:])}")
    # A study sees its own name and options; the processes that it starts take over the path.
    sys.path[:0] = folders()
    program = str(programs[name])
    sys.argv[0] = program
    runpy.run_path(program, run_name="__main__")


def documentation(program):
    """What a study says of itself."""
    return ast.get_docstring(ast.parse(program.read_text()))


if __name__ == "__main__":
    main()
