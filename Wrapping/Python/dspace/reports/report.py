"""A study on one HTML page."""
import datetime
import hashlib
import io
import math
import os
import pathlib
import platform
import re
import sys

from dspace._core.fields import file_path, items, reject, text
from dspace._core.files import atomic_write
from dspace._core.strict import Strict
from dspace.errors import Unsupported, WrongType

MOST_ROWS = 500  # of a table; a note counts the others

PAGE = """<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<title>{{ title }}</title>
<style>
body { font: 15px/1.5 "DejaVu Sans", Arial, sans-serif; color: #1d1f21; max-width: 62rem; margin: 2rem auto; padding: 0 1rem; }
h1 { font-size: 1.7rem; margin-bottom: 0.2rem; } h2 { font-size: 1.2rem; margin-top: 2.2rem; border-bottom: 1px solid #c8ccd0; }
table { border-collapse: collapse; font-size: 0.85rem; margin: 0.6rem 0; } .wide { overflow-x: auto; }
th, td { border: 1px solid #d4d8dc; padding: 0.2rem 0.6rem; text-align: right; white-space: nowrap; }
th { background: #f0f2f4; } td:first-child, th:first-child { text-align: left; } td.words { text-align: left; white-space: normal; }
figure { margin: 0.8rem 0; } figure svg, figure img { max-width: 100%; height: auto; } figcaption, .note { color: #5c6268; font-size: 0.85rem; }
</style>
</head>
<body>
<h1>{{ title }}</h1>
<p class="note">{{ made }}</p>
{% for section in sections %}
<h2>{{ section.title }}</h2>
{% for part in section.parts %}
{% if part.kind == "text" %}<p>{{ part.text }}</p>
{% elif part.kind == "values" %}<table>{% for name, value in part.rows %}<tr><td>{{ name }}</td><td{% if value is string %} class="words"{% endif %}>{{ value }}</td></tr>
{% endfor %}</table>
{% elif part.kind == "table" %}<div class="wide"><table><tr>{% for name in part.head %}<th>{{ name }}</th>{% endfor %}</tr>
{% for row in part.rows %}<tr>{% for value in row %}<td>{{ value }}</td>{% endfor %}</tr>
{% endfor %}</table></div>{% if part.more %}<p class="note">{{ part.more }} more rows.</p>{% endif %}
{% else %}<figure>{{ part.picture|safe }}{% if part.caption %}<figcaption>{{ part.caption }}</figcaption>{% endif %}</figure>
{% endif %}{% endfor %}{% endfor %}
</body>
</html>
"""


class Report(Strict):
    """Collects sections and writes them as one HTML page that needs no other file.

        report = dspace.Report("Lander at the ridge")
        section = report.section("Light")
        section.text("Hourly, 2024 to 2026.")
        section.values({"lit [%]": 88.1})
        section.figure(figure, "Power over time")     # of matplotlib
        report.inputs(terrain="ridge.tif", height_m=2.0)
        report.write("ridge.html")

    The page ends with the inputs (files with their size and SHA-256) and the versions of the programs. It needs jinja2, and
    matplotlib for figures (Debian: python3-jinja2, python3-matplotlib): dspace.Unsupported names what is missing."""

    def __init__(self, title):
        self._title = text(title, "the title", "report")
        self._sections = []
        self._inputs = {}

    def section(self, title):
        """Adds a section. Returns it."""
        self._sections.append(Section(text(title, "the title", "report")))
        return self._sections[-1]

    def inputs(self, **values):
        """Adds inputs by name: numbers, texts, and paths of files (os.PathLike) that exist."""
        self._inputs.update(values)

    def write(self, path):
        """Writes the page. An existing file is replaced by the whole new one, or stays."""
        path = file_path(path, "the path", "report")
        try:
            import jinja2
        except ImportError:
            raise Unsupported("report: jinja2 is not installed; accepted: with it (Debian: python3-jinja2)", "report") from None
        sections = [*self._sections]
        if self._inputs:
            sections.append(Section("Inputs"))
            sections[-1].values({name: described(value) for name, value in self._inputs.items()})
        sections.append(Section("Versions"))
        sections[-1].values(versions())
        environment = jinja2.Environment(autoescape=True, undefined=jinja2.StrictUndefined)
        made = datetime.datetime.now(datetime.timezone.utc).strftime("Written %Y-%m-%d %H:%M UTC by Dspace.")
        page = environment.from_string(PAGE).render(
            title=self._title, made=made, sections=[{"title": s._title, "parts": s._parts}
                                                    for s in sections])
        atomic_write(pathlib.Path(path), page.encode())


class Section(Strict):
    """A section of a Report: texts, values, tables and figures in the order in which they are added."""

    def __init__(self, title):
        self._title = title
        self._parts = []

    def text(self, words):
        """Adds a paragraph."""
        self._parts.append({"kind": "text", "text": text(words, "the text", "report")})

    def values(self, values):
        """Adds a table of names and values, from a dict."""
        if not isinstance(values, dict):
            reject("report", "the values", values, "a dict", WrongType)
        self._parts.append({"kind": "values", "rows": [(str(name), shown(value)) for name, value in values.items()]})

    def table(self, rows):
        """Adds a table from a list of dicts with the same keys. The page has the first 500 rows, and counts the others."""
        rows = items(rows, "the rows", "report", "dicts with the same keys")
        head = list(rows[0]) if rows else []
        for row in rows:
            if not isinstance(row, dict) or list(row) != head:
                reject("report", "a row", row, f"a dict with the keys {', '.join(map(str, head))}", WrongType)
        self._parts.append({"kind": "table", "head": head, "more": max(0, len(rows) - MOST_ROWS),
                            "rows": [[shown(value) for value in row.values()] for row in rows[:MOST_ROWS]]})

    def figure(self, figure, caption=""):
        """Adds a matplotlib Figure (as SVG), or the path of a PNG file."""
        if hasattr(figure, "savefig"):
            picture = svg_of(figure)
        else:
            import base64
            path = pathlib.Path(file_path(figure, "the figure", "report"))
            data = base64.b64encode(path.read_bytes()).decode()
            picture = f'<img alt="" src="data:image/png;base64,{data}">'
        self._parts.append({"kind": "figure", "picture": picture, "caption": text(caption, "the caption", "report")})


def svg_of(figure):
    """The figure as an element of HTML. Its ids begin with a text of its own: those of two figures may be the same."""
    import matplotlib
    data = io.StringIO()
    with matplotlib.rc_context({"svg.hashsalt": "dspace"}):
        figure.savefig(data, format="svg", metadata={"Date": None, "Creator": None})
    picture = data.getvalue()
    picture = picture[picture.index("<svg"):]
    prefix = "f" + hashlib.sha256(picture.encode()).hexdigest()[:8] + "-"
    return re.sub(r'(\bid="|url\(#|href="#)', lambda found: found.group(1) + prefix, picture)


def shown(value):
    """A value as a table shows it."""
    if value is None:
        return ""
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, str):
        return value
    try:
        number = float(value)
    except (TypeError, ValueError):
        return str(value)
    if not math.isfinite(number):
        return "none" if math.isnan(number) else "infinity" if number > 0 else "-infinity"
    return str(value) if isinstance(value, int) else f"{number:.9g}"


def described(value):
    """An input as the page shows it."""
    if isinstance(value, os.PathLike):
        path = pathlib.Path(value)
        digest = hashlib.sha256()
        with path.open("rb") as file:
            for block in iter(lambda: file.read(1 << 20), b""):
                digest.update(block)
        return f"{path} ({path.stat().st_size} bytes, SHA-256 {digest.hexdigest()})"
    return shown(value)


def versions():
    """Versions of the programs that numbers depend on."""
    import numpy
    from vtkmodules.vtkCommonCore import vtkVersion
    found = {"Dspace": sys.modules["dspace"].__version__, "VTK": vtkVersion.GetVTKVersion(), "numpy": numpy.__version__,
             "Python": platform.python_version(), "system": platform.platform()}
    try:
        from osgeo import gdal
        found["GDAL"] = gdal.__version__
    except ImportError:
        pass
    return found
