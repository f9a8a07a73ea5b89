"""Settings of the documentation; `scripts/docs` builds it, without network, into output/docs."""

import sys
from pathlib import Path

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE))  # generated


import limitblocks  # noqa: E402

project = "limitblocks"
author = "limitblocks developers"
project_copyright = author
release = version = limitblocks.__version__

extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.autosummary",
    "sphinx.ext.napoleon",
    "generated",
]
exclude_patterns = ["_build"]
default_role = "code"

myst_enable_extensions = ["dollarmath", "amsmath"]
myst_heading_anchors = 3
suppress_warnings = ["misc.highlighting_failure", "myst.header"]  # excerpts of JSON; pages of two titles

autosummary_generate = False  # everything is on one page
autodoc_member_order = "bysource"
autodoc_typehints = "none"  # the docstrings say types, shapes and units
napoleon_google_docstring = False
napoleon_use_ivar = False
python_use_unqualified_type_names = True
toc_object_entries = False

nitpicky = True  # a reference in a docstring that leads nowhere is a fault
nitpick_ignore_regex = [("py:class", r"(?!limitblocks\.).*")]  # napoleon takes the words of a type for names

html_theme = "furo"
html_title = f"limitblocks {release}"
html_math_renderer = "mathml"  # of generated: no script, no font, no network
html_static_path = ["_static"]
html_css_files = ["wide.css"]
html_show_sphinx = False
html_copy_source = False
