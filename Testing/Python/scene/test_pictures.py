"""Pictures through Python: what is drawn where, saved, picked; and bad input to viewports."""
import numpy as np
import pytest

import dspace
from conftest import picture_of
from needs import needs_module

RED, SIZE = (1, 0, 0), (160, 120)


@pytest.fixture
def view(scene):
    """A red unlit cube of 2 m at the origin, seen from 10 m above by an orthographic camera whose
    120 rows span 12 m: a pixel is 0.1 m."""
    cube = scene.add_box((2, 2, 2), name="cube", color=RED, lit=False)
    camera = scene.add_camera("down", eye=(0, 0, 10), target=(0, 0, 0), up=(0, 1, 0), height=12)
    return scene.add_viewport(SIZE, camera), cube


def test_what_is_drawn_where(view):
    viewport, cube = view
    planes = viewport.capture(depth=True, label=True)
    assert planes["color"].shape == (120, 160, 4) and planes["color"].dtype == np.uint8
    inside = np.zeros((120, 160), bool)
    inside[50:70, 70:90] = True  # 20 pixels about the middle
    np.testing.assert_array_equal(planes["label"] == cube.id, inside)
    np.testing.assert_allclose(planes["depth"][inside], 9, atol=1e-3)
    assert np.isinf(planes["depth"][~inside]).all()
    assert (viewport.image()[55:65, 75:85] == (255, 0, 0)).all()
    assert (planes["color"][..., 3] == 255).all()


def test_planes_outlive_the_next_capture_and_the_session():
    with dspace.Session() as session:
        scene = session.scene()
        scene.add_box((2, 2, 2), color=RED, lit=False)
        viewport = scene.add_viewport(SIZE, scene.add_camera(eye=(9, 0, 0), target=(0, 0, 0)))
        first = viewport.image()
        copy = first.copy()
        viewport.set_background((0, 0, 1))
        assert not np.array_equal(viewport.image(), first)
    np.testing.assert_array_equal(first, copy)


def test_ornaments_and_fragments_are_left_out(scene, view):
    viewport, cube = view
    bare = viewport.image()
    axes = scene.add_axes(3)
    scene.add_trail(5).append([(-4, -4, 0), (4, 4, 0)])
    scene.add_label("hello", position=(3, 3, 0))
    viewport.set_table("t", {"time": 1.5, "mode": "drive"}, title="State")
    assert not np.array_equal(viewport.image(), bare)
    np.testing.assert_array_equal(viewport.image(physical_only=True), bare)
    assert not (viewport.labels() == axes.id).any()
    viewport.hide("physical")
    assert not (viewport.labels() == cube.id).any()
    viewport.show("physical")
    assert not (viewport.labels(hide=["physical"]) == cube.id).any()
    assert (viewport.labels() == cube.id).any()
    viewport.remove_table("t")
    viewport.ornaments = False
    np.testing.assert_array_equal(viewport.image(), bare)


def test_nothing_is_drawn_twice(session, scene, view):
    viewport, cube = view
    assert viewport.render() and not viewport.render()
    cube.frame = scene.add_frame("f")
    scene["f"].position = (1, 0, 0)
    assert session.render() == 1 and session.render() == 0
    viewport.visible = False
    scene["f"].position = (2, 0, 0)
    assert session.render() == 0
    assert session.statistics["frames_drawn"] >= 2


def test_pick(scene, view, field):
    viewport, cube = view
    other = scene.add_frame("other", position=(0, 0, 5))
    hit = viewport.pick(82, 56, frame=other)
    assert hit.object == cube and hit.frame == scene.root
    np.testing.assert_allclose(hit.in_root, (0.25, 0.35, 1), atol=1e-3)
    np.testing.assert_allclose(hit.in_camera, (0.25, -0.35, 9), atol=1e-3)
    np.testing.assert_allclose(hit.in_given, (0.25, 0.35, -4), atol=1e-3)
    assert hit.terrain is None and viewport.pick(2, 2) is None
    assert viewport.pick(92, 60, radius=5).object == cube
    terrain = scene.add_terrain(field, origin=(116, 216))
    hit = viewport.pick(110, 59)
    assert hit.terrain.name == terrain.name
    np.testing.assert_allclose(hit.map, (119.05, 216.05, 1.525), atol=2e-3)


def test_saved_files(view, tmp_path):
    OIIO = needs_module("osgeo.gdal", "python3-gdal")  # an independent reader
    viewport, cube = view
    image, depth = viewport.image(), viewport.depth()
    for name in ("a.png", "a.tif"):
        viewport.save(tmp_path / name)
        read = OIIO.Open(str(tmp_path / name)).ReadAsArray()
        np.testing.assert_array_equal(np.moveaxis(read, 0, -1), image)
    viewport.save(tmp_path / "a.jpg", quality=95)
    read = np.moveaxis(OIIO.Open(str(tmp_path / "a.jpg")).ReadAsArray(), 0, -1).astype(int)
    assert np.abs(read - image).mean() < 3
    viewport.save(tmp_path / "d.tif", plane="depth")
    np.testing.assert_array_equal(OIIO.Open(str(tmp_path / "d.tif")).ReadAsArray(), depth)
    viewport.save(tmp_path / "l.png", plane="label")
    np.testing.assert_array_equal(OIIO.Open(str(tmp_path / "l.png")).ReadAsArray(),
                                  viewport.labels())
    viewport.save(tmp_path / "a.exr")
    viewport.save(tmp_path / "d.exr", plane="depth")
    assert (tmp_path / "a.exr").read_bytes()[:4] == b"\x76\x2f\x31\x01"
    again = tmp_path / "again.png"
    viewport.save(again)
    assert again.read_bytes() == (tmp_path / "a.png").read_bytes()
    assert sorted(p.suffix for p in tmp_path.iterdir()) == sorted(
        [".png", ".tif", ".jpg", ".tif", ".png", ".exr", ".exr", ".png"])  # no drafts are left


def test_events_move_the_camera(scene, view):
    viewport, cube = view
    assert viewport.event("press", 80, 60, "left") is None
    pick = viewport.event("release", 80, 60, "left")  # a click
    assert pick.object == cube.id
    before = viewport.camera.projection["height"]
    viewport.event("wheel", 80, 60, wheel=1)
    assert viewport.camera.projection["height"] < before
    position = viewport.camera.pose.position
    viewport.event("press", 80, 60, "middle")
    viewport.event("move", 100, 60)
    viewport.event("release", 100, 60, "middle")
    assert viewport.camera.pose.position[0] < position[0]  # the ground follows the pointer


def test_own_vtk_code(view):
    viewport, _ = view
    seen = viewport.run(lambda window, renderer: (window.GetClassName(), renderer.GetClassName()))
    assert seen[0] == "vtkDspaceHubWindow" and "Renderer" in seen[1]
    with pytest.raises(ZeroDivisionError):
        viewport.run(lambda window, renderer: 1 / 0)
    assert viewport.vtk.GetWidth() == 160


def test_views_come_and_go(session, scene, view):
    viewport, _ = view
    second = scene.add_viewport((64, 64), "down", name="second", samples=1)
    assert set(session.viewports) == {viewport.name, "second"}
    second.size = (32, 48)
    assert second.size == (32, 48) and second.image().shape == (48, 32, 3)
    second.position = (10, 20)
    assert second.position == (10, 20)
    second.corner_axes = True
    scene.add_vantage("side")
    with pytest.raises(dspace.Error):
        scene.remove()
    second.remove()
    with pytest.raises(dspace.NotFound, match="second"):
        second.image()
    viewport.camera = None
    with pytest.raises(dspace.InvalidArgument, match="'down'"):
        viewport.camera = "down"
        scene.cameras["down"].remove()


def test_bad_input(scene, view, refused, tmp_path):
    viewport, _ = view
    for size in ((0, 0), (100000, 100000), (16385, 10)):
        with refused(dspace.InvalidArgument, "viewport"):
            scene.add_viewport(size, "down")
        with refused(dspace.InvalidArgument, viewport.name):
            viewport.size = size
    assert viewport.size == SIZE
    with refused(dspace.NotFound, "absent"):
        scene.add_viewport(SIZE, "absent")
    with refused(dspace.AlreadyExists, viewport.name):
        scene.add_viewport(SIZE, "down", name=viewport.name)
    with refused(dspace.InvalidArgument, "9"):
        viewport.samples = 9
    with refused(dspace.InvalidArgument, "2"):
        viewport.set_background((2, 0, 0))
    with refused(dspace.NotFound, "absent"):
        viewport.hide("absent")
    with refused(dspace.NotFound, "absent"):
        viewport.image(hide=["absent"])
    with refused(dspace.InvalidArgument, "font"):
        viewport.set_table("t", {}, font_size=1)
    with refused(dspace.InvalidArgument, ".gif"):
        viewport.save(tmp_path / "a.gif")
    with refused(OSError, "no folder"):
        viewport.save(tmp_path / "absent" / "a.png")
    with refused(dspace.InvalidArgument, ".png"):
        viewport.save(tmp_path / "a.png", plane="depth")
    with refused(dspace.InvalidArgument, "quality"):
        viewport.save(tmp_path / "a.jpg", quality=0)
    assert list(tmp_path.iterdir()) == []
    with refused(ValueError, "'top'"):
        viewport.set_table("t", {}, anchor="top")
    with refused(dspace.InvalidArgument):
        viewport.pick(np.nan, 0)


def test_both_import_orders_work(tmp_path):
    """Messages before the compiled part, and after: both pools know the same files."""
    import subprocess
    import sys
    for first in ("from dspace.proto import commands_pb2", "import dspace.vtk"):
        code = f"{first}\nimport dspace\nwith dspace.Session() as s: print(s.scene().add_frame('a'))"
        done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
        assert done.returncode == 0 and "'a'" in done.stdout, done.stderr


def test_a_first_picture_in_ten_lines(tmp_path, field):
    data = __import__("pathlib").Path(__file__).resolve().parents[3] / "Data"
    # --- the ten lines of the README
    with dspace.Session() as session:
        scene = session.scene()
        terrain = scene.add_terrain(data / "field" / "field.tif")
        rover = scene.load(data / "rover" / "rover.urdf")
        rover.frame.position = (0, 0, terrain.height(0, 0) + 0.55)
        camera = scene.add_camera(frame=rover, eye=(4, -4, 2), target=(0, 0, 0.3))
        scene.add_viewport(size=(320, 180), camera=camera).save(tmp_path / "first.png")
        # --- and what must be in it
        labels = session.viewports["viewport"].labels()
        ids = {o.id for o in rover.objects}
        assert (labels == terrain.object.id).mean() > 0.3
        assert 0.02 < np.isin(labels, list(ids)).mean() < 0.5
        assert picture_of(scene)
    assert (tmp_path / "first.png").stat().st_size > 5000
