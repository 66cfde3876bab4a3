"""Sphinx's configuration of the site. make_site.py runs it on the folder that it fills."""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from docstrings import to_rst  # noqa: E402

project = "Dspace"
extensions = ["sphinx.ext.autodoc", "myst_parser"]
html_theme = "furo"
html_title = "Dspace"
html_copy_source = False
source_suffix = {".md": "markdown", ".rst": "restructuredtext"}
myst_heading_anchors = 6  # as the documents' links name them
suppress_warnings = ["myst.header"]
autodoc_member_order = "bysource"
autodoc_default_options = {"members": True, "undoc-members": True, "inherited-members": False}
add_module_names = False


def setup(app):
    app.connect("autodoc-process-docstring", lambda app, what, name, object, options, lines: lines.__setitem__(
        slice(None), to_rst("\n".join(lines)).splitlines()))
