"""Sphinx: the documentation as a site. `make site` builds it through tools/build_site.py."""

import sys
import tomllib
from pathlib import Path

REPOSITORY = next(folder for folder in Path(__file__).resolve().parents if (folder / "Cargo.toml").exists())
sys.path.insert(0, str(REPOSITORY / "tools"))

project = "wheelrail"
author = "the authors of wheelrail"
version = release = tomllib.loads((REPOSITORY / "Cargo.toml").read_text())["package"]["version"]

extensions = ["myst_parser", "site_math", "site_search"]
myst_enable_extensions = ["dollarmath"]
myst_dmath_double_inline = True
myst_heading_anchors = 3
root_doc = "index"
exclude_patterns = ["generated"]  # parts of pages

html_theme = "furo"
html_title = f"wheelrail {version}"
html_math_renderer = "mathml"
html_static_path = ["site.css"]
html_css_files = ["site.css"]
html_show_sourcelink = False
html_copy_source = False
html_show_copyright = False
# Code without a language is a formula or a command.
highlight_language = "none"
