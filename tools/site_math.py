r"""A Sphinx extension that typesets equations as MathML when the site is built, and adds a font for them.

Nothing is loaded from elsewhere when the site is read. `\tag{18, 27}` in a displayed equation gives its number, here
that of the paper.
"""

import re
import shutil
from importlib.resources import as_file, files
from pathlib import Path

from docutils.nodes import SkipNode
from latex2mathml.converter import convert

FONT = "STIXTwoMath-Regular.ttf"
TAG = re.compile(r"\\tag\{(.*?)\}")


def inline(translator, node):
    """Write a formula of the running text."""
    translator.body.append(convert(node.astext()))
    raise SkipNode


def display(translator, node):
    """Write a displayed equation, its number on the right."""
    text = node.astext()
    numbers = TAG.findall(text)
    identifier = "".join(f' id="{name}"' for name in node["ids"][:1])
    translator.body.append(f'<div class="equation"{identifier}>')
    translator.body.append(convert(TAG.sub("", text).strip(), display="block"))
    if numbers:
        translator.body.append(f'<span class="number">({numbers[0]})</span>')
    translator.body.append("</div>\n")
    raise SkipNode


def add_font(app, error):
    """Put the font of the equations beside the style sheets."""
    if error is None:
        with as_file(files("ziamath") / "fonts" / FONT) as font:
            shutil.copy(font, Path(app.outdir) / "_static" / FONT)


def setup(app):
    """Register the renderer."""
    app.connect("build-finished", add_font)
    app.add_html_math_renderer("mathml", inline_renderers=(inline, None), block_renderers=(display, None))
    return {"parallel_read_safe": True, "parallel_write_safe": True}
