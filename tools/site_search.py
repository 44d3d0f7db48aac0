"""A Sphinx extension that lets search show excerpts where the site is opened as files.

Sphinx's search fetches each page that it found, to show a piece of it. From `file://` browsers fetch nothing. So the
pages' text comes along as a script, which the page of the search loads and answers those requests from.
"""

import html
import json
from html.parser import HTMLParser
from pathlib import Path

SCRIPT = "page_texts.js"
# What search removes from a page, or a reader does not see.
LEFT_OUT = {"script", "style", "annotation"}
# What flows with the text around it; between all else are spaces.
INLINE = {"a", "abbr", "b", "cite", "code", "em", "i", "span", "strong", "sub", "sup", "wbr"}
# A function, so that a page that opens another frame meets no second definition.
ANSWER = """(() => {{
  const pages = {pages};
  const fetched = window.fetch;
  window.fetch = (request, ...options) => {{
    const name = String(request).replace(/^(\\.\\/)+/, "");
    return Object.hasOwn(pages, name) ? Promise.resolve(new Response(pages[name])) : fetched(request, ...options);
  }};
}})();
"""


class Reduced(HTMLParser):
    """The text of a page, and of its elements only those that a link can lead to."""

    def __init__(self, body):
        """Read the HTML of a page's body."""
        super().__init__()
        self.pieces, self.open, self.skipped, self.in_math = [], [], 0, 0
        self.feed(body)

    def left_out(self, tag, attributes):
        """Whether search does not show an element."""
        return tag in LEFT_OUT or "headerlink" in (attributes.get("class") or "").split()

    def handle_starttag(self, tag, attributes):
        """Keep what a link can lead to."""
        if tag in ("br", "img", "input", "hr", "link", "meta", "wbr", "col", "source"):
            self.pieces.append(" ")
            return
        attributes = dict(attributes)
        skipped = bool(self.skipped) or self.left_out(tag, attributes)
        named = attributes.get("id") if not skipped else None
        self.open.append((tag, skipped, named))
        self.skipped += skipped
        self.in_math += tag == "math"
        if named:
            self.pieces.append(f'<div id="{html.escape(named)}">')
        elif tag not in INLINE and not self.in_math:
            self.pieces.append(" ")

    def handle_endtag(self, tag):
        """Close what is open up to the element."""
        while any(tag == other for other, _, _ in self.open):
            last, skipped, named = self.open.pop()
            self.skipped -= skipped
            if named:
                self.pieces.append("</div>")
            elif last not in INLINE and not self.in_math:
                self.pieces.append(" ")
            self.in_math -= last == "math"
            if last == tag:
                break

    def handle_data(self, data):
        """Keep the text."""
        if not self.skipped:
            self.pieces.append(html.escape(data, quote=False))

    def text(self):
        """Return the page as search reads it, without the spaces that are too many."""
        return f'<div role="main">{" ".join("".join(self.pieces).split())}</div>'


def keep(app, pagename, templatename, context, doctree):
    """Keep a page's text; the page of the search loads all of them."""
    if pagename == "search":
        app.add_js_file(SCRIPT)
    elif doctree is not None:
        page = pagename + app.builder.out_suffix
        app.page_texts[page] = Reduced(context["body"]).text()


def write(app, error):
    """Write the script that answers."""
    if error is None:
        pages = json.dumps(dict(sorted(app.page_texts.items())), ensure_ascii=False)
        # In a script, too, where it might be put into a page.
        script = ANSWER.format(pages=pages.replace("</script", "<\\/script"))
        (Path(app.outdir) / "_static" / SCRIPT).write_text(script, encoding="utf-8")


def setup(app):
    """Register what keeps and what writes."""
    app.page_texts = {}
    app.connect("html-page-context", keep)
    app.connect("build-finished", write)
    return {"parallel_read_safe": True, "parallel_write_safe": False}
