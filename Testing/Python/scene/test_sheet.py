"""Sheets: several viewports in one picture, in a local session and in a connected one."""
import numpy as np
import pytest

import dspace
from needs import needs_module


@pytest.fixture
def views(anywhere):
    """Three viewports of one scene: two side by side, the third one over both."""
    scene = anywhere.scene()
    scene.add_box((2, 2, 2), name="cube", color="#c06020")
    made = []
    for name, size, position, eye in (("a", (60, 40), (0, 0), (9, 0, 2)), ("b", (50, 40), (60, 5), (0, 9, 2)),
                                      ("c", (20, 10), (50, 20), (3, 3, 9))):
        view = scene.add_viewport(size, scene.add_camera(name, eye=eye, target=(0, 0, 0)), name=name)
        view.position = position
        made.append(view)
    return made


def test_viewports_stand_at_their_positions(anywhere, views):
    a, b, c = views
    sheet = anywhere.sheet(background="#102030")
    assert sheet.shape == (45, 110, 3) and sheet.dtype == np.uint8
    np.testing.assert_array_equal(sheet[20:30, 50:70], c.image())
    np.testing.assert_array_equal(sheet[:20, :60], a.image()[:20])
    np.testing.assert_array_equal(sheet[5:20, 60:], b.image()[:15])
    assert (sheet[40:, :60] == (0x10, 0x20, 0x30)).all() and (sheet[:5, 60:] == (0x10, 0x20, 0x30)).all()
    # The order decides which one is on top.
    np.testing.assert_array_equal(anywhere.sheet([c, b, a])[:40, :60], a.image())
    c.visible = False
    np.testing.assert_array_equal(anywhere.sheet()[:40, :60], a.image())


def test_its_size_may_be_given_and_it_is_saved(anywhere, views, tmp_path):
    gdal = needs_module("osgeo.gdal", "python3-gdal")  # an independent reader
    path = tmp_path / "sheet.png"
    sheet = anywhere.sheet(views[:1], size=(100, 50), background=(1, 1, 1), path=path)
    assert sheet.shape == (50, 100, 3) and (sheet[40:] == 255).all() and (sheet[:, 60:] == 255).all()
    np.testing.assert_array_equal(np.moveaxis(gdal.Open(str(path)).ReadAsArray(), 0, -1)[..., :3], sheet)


def test_what_does_not_fit_is_rejected(anywhere, views, tmp_path):
    path = tmp_path / "sheet.png"
    views[1].position = (-1, 5)
    for call, kind, text in (
            (lambda: anywhere.sheet(path=path), dspace.InvalidArgument, "viewport 'b': its position is .-1, 5"),
            (lambda: anywhere.sheet(views[:1], size=(59, 40), path=path), dspace.InvalidArgument,
             "viewport 'a': its place .*within the sheet of 59 x 40"),
            (lambda: anywhere.sheet([], path=path), dspace.InvalidArgument, "one or more"),
            (lambda: anywhere.sheet(["a"], path=path), dspace.WrongType, "dspace.Viewport"),
            (lambda: anywhere.sheet(views[:1], size=(0, 5), path=path), dspace.InvalidArgument, "the size"),
            (lambda: anywhere.sheet(views[:1], size=(2.5, 50), path=path), dspace.WrongType, "the size"),
            (lambda: anywhere.sheet(views[:1], background=(2, 0, 0), path=path), dspace.InvalidArgument, "background"),
            (lambda: anywhere.sheet(views[:1], path=tmp_path / "sheet.bmp"), dspace.InvalidArgument, "ends with .png"),
    ):
        with pytest.raises(kind, match=text):
            call()
    views[1].position = (2**31 - 100, 0)
    with pytest.raises(dspace.InvalidArgument, match="the size is"):
        anywhere.sheet()
    assert not path.exists()
    with pytest.raises(dspace.Io, match="no folder"):
        anywhere.sheet(views[:1], path=tmp_path / "nowhere" / "sheet.png")
