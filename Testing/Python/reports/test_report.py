"""Reports: what the page says, that nothing on it is taken as markup, and that it needs no other file."""
import html.parser
import re
import sys

import numpy as np
import pytest

import dspace
from needs import needs_module


class Page(html.parser.HTMLParser):
    """The words, the tags, the ids and what refers to them."""

    def __init__(self, text):
        super().__init__()
        self.words, self.tags, self.ids, self.open = [], [], [], []
        self.feed(text)
        self.references = re.findall(r'url\(#([^)]+)\)|href="#([^"]+)"', text)

    def handle_starttag(self, tag, attributes):
        self.tags.append(tag)
        self.ids += [value for name, value in attributes if name == "id"]
        for name, value in attributes:
            assert not (name in ("src", "href") and value and not value.startswith(("data:", "#"))), value

    def handle_data(self, data):
        self.words.append(data)


@pytest.fixture
def report():
    needs_module("jinja2", "python3-jinja2")
    return dspace.Report("Lander <b>& site")


def test_the_page_has_everything_and_stands_alone(report, tmp_path):
    figures = needs_module("matplotlib.figure", "python3-matplotlib")
    ground = tmp_path / "ground.txt"
    ground.write_bytes(b"abc")
    section = report.section("Light")
    section.text("a < b & <script>alert(1)</script>")
    section.values({"lit [%]": 88.123456789012, "none": None, "clear": True, "angle": np.nan, "count": 7, "name": "<i>"})
    section.table([{"x": i, "y": 0.5 * i} for i in range(600)])
    for _ in range(2):
        figure = figures.Figure()
        axes = figure.add_subplot()
        axes.plot([0, 1], [0, 1], clip_on=True)
        section.figure(figure, "A <line>")
    report.inputs(ground=ground, height=2.0)
    report.write(tmp_path / "page.html")
    text = (tmp_path / "page.html").read_text()
    page = Page(text)
    words = " ".join(page.words)
    for said in ("Lander <b>& site", "a < b & <script>alert(1)</script>", "88.1234568", "yes", "<i>", "100 more rows", "A <line>",
                 "Inputs", "3 bytes", "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad", "Versions", "VTK", "numpy"):
        assert said in words, said
    assert "script" not in page.tags and page.tags.count("svg") == 2 and page.tags.count("tr") > 500
    assert {a or b for a, b in page.references} <= set(page.ids)  # clips and markers are found


def test_a_picture_file_and_the_old_page(report, tmp_path):
    with dspace.Session() as session:
        picture = tmp_path / "view.png"
        scene = session.scene()
        scene.add_viewport(size=(8, 8), camera=scene.add_camera(eye=(4, -4, 3), target=(0, 0, 0))).save(picture)
    report.section("Views").figure(picture, "From above")
    report.write(tmp_path / "page.html")
    assert "data:image/png;base64,iVBOR" in (tmp_path / "page.html").read_text()
    before = (tmp_path / "page.html").read_bytes()
    report.inputs(missing=tmp_path / "missing.tif")
    with pytest.raises(OSError):
        report.write(tmp_path / "page.html")
    assert (tmp_path / "page.html").read_bytes() == before


def test_bad_input(report, monkeypatch, tmp_path):
    section = report.section("Numbers")
    with pytest.raises(dspace.WrongType, match="accepted: a dict with the keys x, y"):
        section.table([{"x": 1, "y": 2}, {"x": 1}])
    with pytest.raises(dspace.WrongType, match="accepted: a dict"):
        section.values([1, 2])
    monkeypatch.setitem(sys.modules, "jinja2", None)
    with pytest.raises(dspace.Unsupported, match="python3-jinja2"):
        report.write(tmp_path / "page.html")
    assert not (tmp_path / "page.html").exists()
