"""Hold the order of the modules: which file in src/ may use which other one (`make lint`).

Each path in a file is followed to the file that defines what it names: paths that begin with `crate`, `super`, `self`
or one of the module's own children, and names that another module passes on with `pub use`. Modules of tests are left
out: a test may use whatever it likes.
"""

import re
import sys
from pathlib import Path

# What may stand in src/ beside the folders.
FILES = {"lib", "damage", "error", "settings", "signals", "transport", "wear", "wheel_rail", "simulation"}
PHYSICS = [
    *(
        "numerics",
        "geometry",
        "body",
        "friction",
        "mechanics",
        "heat",
        "wear",
        "damage",
        "transport",
        "contact",
        "wheel_rail",
    ),
    *("simulation", "parameters", "signals", "error", "settings"),
]
# Neither of the two uses the other.
APART = {
    ("body", "friction"): "the bodies and the friction law do not know each other",
    ("mechanics", "heat"): "mechanics and heat meet in the contact",
    ("contact::line", "contact::patch"): "the engines do not know each other",
    ("fmi2", "fmi3"): "the versions of the standard do not know each other",
}
# The first does not use the second; the second may use the first.
BELOW = {
    **{(physics, fmi): "the physics knows no FMI" for physics in PHYSICS for fmi in ("fmi", "fmi2", "fmi3")},
    **{("fmi", version): "what the versions share knows none of them" for version in ("fmi2", "fmi3")},
}
# The only modules that these use.
ONLY = {"numerics": {"numerics", "error"}, "geometry": {"geometry", "numerics", "error"}}

# Exceptions that are to go: (file, the file that it uses), and files beside the folders. One without need is an error.
KNOWN_IMPORTS: set[tuple[str, str]] = set()
KNOWN_FILES: set[str] = set()


def code(text):
    """Return a file's text without comments, strings and modules of tests."""
    text = re.sub(r'//[^\n]*|/\*.*?\*/|b?"(?:\\.|[^"\\])*"', " ", text, flags=re.DOTALL)
    while found := re.search(r"#\[cfg\(test\)\]\s*(?:pub\s+)?mod\s+\w+\s*(\{|;)", text):
        end = found.end()
        depth = found[1] == "{"
        while depth:
            depth += {"{": 1, "}": -1}.get(text[end], 0)
            end += 1
        text = text[: found.start()] + text[end:]
    return text


def leaves(tree):
    """Return the paths of a use tree, each as (list of names, the name that it gets here)."""
    head, brace, rest = tree.partition("{")
    head = [name for name in re.sub(r"\s", "", head if brace else tree.partition(" as ")[0]).split("::") if name]
    if not brace:
        alias = tree.partition(" as ")[2].strip() or head[-1]
        return [(head, alias)]
    parts, depth = [""], 0
    for letter in rest[: rest.rindex("}")]:
        depth += {"{": 1, "}": -1}.get(letter, 0)
        parts = [*parts, ""] if letter == "," and not depth else [*parts[:-1], parts[-1] + letter]
    inner = [leaf for part in parts if part.strip() for leaf in leaves(part.strip())]
    return [([*head, *path], head[-1] if alias == "self" else alias) for path, alias in inner]


class Crate:
    """The modules of a crate and what they use."""

    def __init__(self, source):
        """Read all files but those of the command line."""
        self.text, self.passed_on, tests = {}, {}, set()
        for path in sorted(source.rglob("*.rs")):
            names = path.relative_to(source).with_suffix("").parts
            if names[0] not in ("bin", "main"):
                module = () if names == ("lib",) else names[: -1 if names[-1] == "mod" else None]
                self.text[module] = code(path.read_text())
                declared = re.findall(r"#\[cfg\(test\)\]\s*(?:pub\s+)?mod\s+(\w+)\s*;", path.read_text())
                tests.update((*module, name) for name in declared)
        for module in [module for module in self.text if any(module[: len(test)] == test for test in tests)]:
            del self.text[module]
        self.uses = {module: list(self.paths(module)) for module in self.text}

    def paths(self, module):
        """Yield what a file names, from the root of the crate."""
        text = self.text[module]
        children = {name[-1] for name in self.text if name[:-1] == module and name}
        statement = re.compile(r"(\bpub\b(?:\([^)]*\))?\s+)?\buse\s+([^;]+);")
        for public, tree in statement.findall(text):
            for path, alias in leaves(tree):
                if (full := self.full(module, path, children)) is not None:
                    if public:
                        self.passed_on[(*module, alias)] = full
                    yield full
        for found in re.findall(r"(?<![\w:])\w+(?:\s*::\s*\w+)+", statement.sub(" ", text)):
            full = self.full(module, re.split(r"\s*::\s*", found), children)
            if full is not None:
                yield full

    def full(self, module, path, children):
        """Return a path from the root of the crate, or None where it leads to another crate."""
        if path[0] == "crate":
            return tuple(path[1:])
        if path[0] in ("self", "super"):
            here = list(module)
            while path and path[0] in ("self", "super"):
                here = here[:-1] if path[0] == "super" else here
                path = path[1:]
            return (*here, *path)
        return (*module, *path) if path[0] in children else None

    def file_of(self, path, seen=()):
        """Return the module whose file defines a path, through what others pass on."""
        for length in range(len(path), 0, -1):
            passed = self.passed_on.get(path[:length])
            if passed is not None and path[:length] not in seen:
                return self.file_of((*passed, *path[length:]), (*seen, path[:length]))
            if path[:length] in self.text:
                return path[:length]
        return ()

    def imports(self):
        """Return for each file the files that it uses."""
        graph = {}
        for module, paths in self.uses.items():
            graph[module] = {self.file_of(path) for path in paths} - {module, ()}
        return graph


def circles(graph):
    """Return circles of imports, each once."""
    found, done = [], set()

    def visit(module, trail):
        if module in trail:
            circle = trail[trail.index(module) :]
            if not any(set(circle) == set(other) for other in found):
                found.append(circle)
            return
        if module not in done:
            for used in sorted(graph.get(module, ())):
                visit(used, [*trail, module])
            done.add(module)

    for module in sorted(graph):
        visit(module, [])
    return found


def complaints(source):
    """Return everything that breaks a rule, one line each."""
    crate = Crate(source)

    def file(module):
        path = source.joinpath(*module)
        return (path / "mod.rs" if path.is_dir() else path.with_suffix(".rs")).relative_to(source).as_posix()

    def within(module, name):
        names = tuple(name.split("::"))
        return module[: len(names)] == names

    lines, needed = [], set()
    # lib.rs declares the modules and passes names on; it is no one's business to use it.
    graph = {module: used for module, used in crate.imports().items() if module}
    for module, used_ones in graph.items():
        for used in sorted(used_ones):
            why = [why for (a, b), why in BELOW.items() if within(module, a) and within(used, b)]
            for (a, b), reason in APART.items():
                if (within(module, a) and within(used, b)) or (within(module, b) and within(used, a)):
                    why.append(reason)
            for name, allowed in ONLY.items():
                if within(module, name) and not any(within(used, other) for other in allowed):
                    why.append(f"{name} uses nothing but {' and '.join(sorted(allowed - {name}))}")
            pair = (file(module), file(used))
            if why and pair in KNOWN_IMPORTS:
                needed.add(pair)
            elif why:
                lines.append(f"src/{pair[0]} uses src/{pair[1]}: {why[0]}")
    # A folder's mod.rs may use the files of its folder, and they what it defines: that is no circle.
    inward = {module: {used for used in used_ones if used[:-1] != module} for module, used_ones in graph.items()}
    for circle in circles(inward):
        names = [file(module) for module in circle]
        pairs = set(zip(names, names[1:] + names[:1], strict=True))
        if pairs & KNOWN_IMPORTS:
            needed |= pairs & KNOWN_IMPORTS
        else:
            lines.append(f"a circle of imports: {' uses '.join(f'src/{name}' for name in [*names, names[0]])}")
    folders = {}
    for module, used_ones in graph.items():
        folders.setdefault(module[:1], set()).update(used[:1] for used in used_ones if used[:1] != module[:1])
    for circle in circles(folders):
        names = [module[0] for module in [*circle, circle[0]]]
        lines.append(f"a circle of folders: {' uses '.join(names)}")
    loose = {path.stem for path in source.glob("*.rs")}
    for name in sorted(loose - FILES - KNOWN_FILES):
        lines.append(f"src/{name}.rs: only {', '.join(sorted(FILES))} stand beside the folders of src/")
    for pair in sorted(KNOWN_IMPORTS - needed):
        lines.append(f"src/{pair[0]} no longer uses src/{pair[1]} against a rule: take it off KNOWN_IMPORTS")
    for name in sorted(KNOWN_FILES - loose):
        lines.append(f"src/{name}.rs is gone: take it off KNOWN_FILES")
    return lines


if __name__ == "__main__":
    found = complaints(Path(sys.argv[1]) if sys.argv[1:] else Path(__file__).resolve().parent.parent / "src")
    print("\n".join(found), file=sys.stderr) if found else None
    sys.exit(bool(found))
