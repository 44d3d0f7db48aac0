"""Refuse doc comments that cannot be read without the line above them (`make lint`).

A doc comment begins with the noun that it documents, or with a verb: "Length of the cell upstream", not "Of the cell
upstream"; "Returns whether the node sticks", not "As the line contact does it". It names its symbol, so that it can be
read by itself, in an editor's tooltip or in a page of `cargo doc`.
"""

import re
import sys
from pathlib import Path

# Words that lean on what stands elsewhere: prepositions, pronouns, comparisons and indirect questions.
LEANING = {
    word
    for line in (
        "Above After Against Along Among And As At Because Before Behind Below Beside Besides Between Beyond",
        "But By Down During Else For From How However If In Inside Instead Into It Its Like Neither Nor Of",
        "Off On Onto Or Otherwise Out Outside Over Same She So Still Such That Their Them Then There These",
        "They This Those Though Through Thus To Together Towards Under Until Up Upon What Whatever When Where",
        "Wherever Which Whichever While Who Whoever Whom Whose Why With Within Without None Ditto Likewise",
        "Similarly Therefore Hence Here Yet",
    )
    for word in line.split()
}
LEANING_PAIRS = {"The same", "The one", "The other", "The others", "The rest", "All of", "All but"}
# Descriptions of variables of the FMU, which are written as questions on purpose: they stand in tables.
DESCRIPTIONS = ("What is prescribed", "Which inputs define", "How the contact is resolved")


def openings(text):
    """Yield line number and text of the first line of each doc comment, of items and of modules."""
    before = False
    for number, line in enumerate(text.splitlines(), 1):
        found = re.match(r"\s*//[/!] ?(.*)", line)
        if found and not before:
            yield number, found[1]
        before = found is not None


def leans(opening):
    """Return the words with which a doc comment begins, where they lean on something else, or None."""
    if opening.startswith(DESCRIPTIONS):
        return None
    words = re.findall(r"[^\W\d_]+", opening.partition("`")[0])[:2]
    if not words or not re.match(r"[^\W\d_]", opening):
        return None
    if words[0] in LEANING:
        return words[0]
    return " ".join(words) if " ".join(words) in LEANING_PAIRS else None


def complaints(source):
    """Return the doc comments that break the rule, one line each."""
    lines = []
    for path in sorted(source.rglob("*.rs")):
        for number, opening in openings(path.read_text()):
            if (word := leans(opening)) is not None:
                place = path.relative_to(source).as_posix()
                lines.append(f'src/{place}:{number}: a doc comment begins with "{word}": {opening}')
    return lines


if __name__ == "__main__":
    found = complaints(Path(__file__).resolve().parent.parent / "src")
    print("\n".join(found), file=sys.stderr) if found else None
    sys.exit(bool(found))
