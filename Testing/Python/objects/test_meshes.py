"""Objects made of arrays: what is drawn, precision, parts, levels, recordings, the wire; bad input by name."""
import re
import sqlite3
import subprocess
import sys

import numpy as np
import pytest

import dspace
from served_support import Served

QUAD = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], float)
TWO = np.array([[0, 1, 2], [0, 2, 3]])


@pytest.fixture
def view(scene):
    camera = scene.add_camera(eye=(0, 0, 5), target=(0, 0, 0), up=(0, 1, 0), height=4)
    view = scene.add_viewport((200, 200), camera, samples=1)
    view.set_background((0, 0, 0))
    return view


def at(view, x, y):
    """The color at a point of the plane z = 0."""
    return view.image()[int(100 - 50 * y), int(100 + 50 * x), :3].astype(int)


def test_colors_of_points_and_of_triangles(scene, view):
    mesh = scene.add_mesh(QUAD, TWO, colors=np.array([[0, 0, 255], [255, 0, 0], [0, 255, 0], [0, 0, 0]], np.uint8),
                          lit=False)
    assert np.abs(at(view, -0.99, -0.99) - (0, 0, 255)).max() <= 4
    middle = at(view, 0.1, -0.9)  # in the first triangle: interpolated in display values, as VTK does
    w = np.array([(1 - 0.11) / 2, 0.5, 0.05])
    assert np.abs(middle - 255 * np.array([w[1], w[2], w[0]])).max() <= 4
    mesh.update(colors=[[1.0, 0, 0], [0, 1.0, 0]])
    assert at(view, 0.5, -0.5).tolist() == [255, 0, 0] and at(view, -0.5, 0.5).tolist() == [0, 255, 0]
    assert mesh.triangles == 2


def test_scalars_take_the_colormap_and_nan_is_grey(scene, view):
    mesh = scene.add_mesh(QUAD, TWO, scalars=[10.0, 20.0], colormap=["black", "white"], low=0, high=40, lit=False)
    assert np.abs(at(view, 0.5, -0.5) - 64).max() <= 1 and np.abs(at(view, -0.5, 0.5) - 128).max() <= 1
    mesh.update(scalars=[np.nan, 40.0])
    assert at(view, 0.5, -0.5).tolist() == [128] * 3 and at(view, -0.5, 0.5).tolist() == [255] * 3


def test_points_and_lines(scene, view):
    scene.add_mesh([[0.5, 0.5, 0]], point_size=11, color="red", lit=False)
    scene.add_mesh([[-1, 0, 0], [1, 0, 0]], lines=[[0, 1]], line_width=5, color="blue")
    assert at(view, 0.5, 0.5).tolist() == [255, 0, 0] and at(view, -0.5, 0).tolist() == [0, 0, 255]
    assert at(view, 0.5, 0.3).tolist() == [0, 0, 0]


def test_far_points_keep_their_precision(scene):
    origin = np.array([1.5e11, -2e10, 3e9])
    frame = scene.add_frame("far", position=-origin)
    mesh = scene.add_mesh(QUAD * 0.001 + origin, TWO, frame=frame)
    got = mesh.to_polydata()
    from vtkmodules.util.numpy_support import vtk_to_numpy
    points = vtk_to_numpy(got.GetPoints().GetData())
    # A double of 1.5e11 has a spacing of 3e-5 m; single precision would have 16 km.
    assert np.abs(points - (QUAD * 0.001 + origin)).max() <= 4e-5
    camera = scene.add_camera(eye=(0, 0, 5), target=(0, 0, 0), up=(0, 1, 0), height=0.004)
    view = scene.add_viewport((200, 200), camera, samples=1)
    mesh.set_material(color="white", lit=False)
    white = (view.image()[..., 0] == 255).sum()
    assert abs(white - 100 * 100) <= 200


def test_equal_arrays_are_one_mesh_on_the_gpu(session, scene, view):
    view.image()
    points = np.random.default_rng(1).normal(size=(3000, 3))
    triangles = np.arange(3000).reshape(-1, 3)
    scene.add_mesh(points, triangles, name="first")
    view.image()
    before = session.statistics
    scene.add_mesh(points, triangles, name="second", position=(1, 0, 0), color="red")
    view.image()
    after = session.statistics
    key = next(key for key in after if "byte" in key and "upload" in key or key == "uploaded_bytes")
    assert after[key] - before[key] < 36000 / 4  # instances, not the mesh of 36,000 bytes of positions


def test_parts_are_set_and_picked_by_name(scene, view):
    mesh = scene.add_mesh(QUAD, {"right": [[0, 1, 2]], "left": [[0, 2, 3]]}, lit=False, color="white")
    assert mesh.parts == ["right", "left"]
    mesh.part("right").set(color="red")
    mesh.part("left").set(emissive="lime", color="black", lit=False)
    assert at(view, 0.5, -0.5).tolist() == [255, 0, 0]
    assert view.pick(125, 125).part == "right" and view.pick(75, 75).part == "left"
    assert view.pick(125, 125).object == mesh
    mesh.part("left").visible = False
    assert at(view, -0.5, 0.5).tolist() == [0, 0, 0] and view.pick(75, 75) is None
    assert mesh.part("left").visible is False
    mesh.part("right").set(color=None)
    assert at(view, 0.5, -0.5).tolist() == [255, 255, 255] and mesh.part("right").material == {}
    with pytest.raises(dspace.NotFound, match="part 'wing': no part has this name; accepted: 'right', 'left'"):
        mesh.part("wing")
    # Another mesh keeps the overrides of names that stay, and drops the others.
    mesh.part("right").set(color="blue")
    mesh.update(triangles={"right": [[0, 1, 2]], "top": [[0, 2, 3]]})
    assert mesh.part("right").material == {"color": (0, 0, 1)} and mesh.part("top").visible
    mesh.update(triangles={"right": [[0, 1, 2]], "left": [[0, 2, 3]]})
    assert mesh.part("left").visible


def test_a_coarser_level_is_drawn_from_afar(scene):
    camera = scene.add_camera(eye=(0, 0, 5), target=(0, 0, 0), up=(0, 1, 0), height=4)
    view = scene.add_viewport((200, 200), camera, samples=1)
    scene.add_mesh(QUAD, TWO, colors=np.tile([[255, 0, 0]], (4, 1)).astype(np.uint8), lit=False, pixels=100,
                   levels=[({"points": QUAD, "triangles": TWO,
                             "colors": np.tile([[0, 0, 255]], (4, 1)).astype(np.uint8)}, 0)])
    assert view.image()[100, 100, :3].tolist() == [255, 0, 0]
    camera.set_projection(height=40)
    assert view.image()[100, 100, :3].tolist() == [0, 0, 255]


def test_recorded_once_and_replayed_to_the_byte(session, scene, view, tmp_path):
    rng = np.random.default_rng(2)
    points, triangles = rng.uniform(-1, 1, (30000, 3)), rng.integers(0, 30000, (50000, 3))
    colors = rng.integers(0, 256, (30000, 3), np.uint8)
    path = tmp_path / "run.dspace"
    pictures = []
    mesh = scene.add_mesh(points, triangles, colors=colors, frame=scene.add_frame("body"))
    size = 30000 * 16 + 50000 * 12
    with session.record(path):
        for step in range(20):
            scene.time = step
            mesh.update(points=points if step < 19 else points * 0.5)  # equal arrays but for the last
            scene.frame("body").pose = dspace.Pose(position=(0.01 * step, 0, 0))
            pictures.append(view.image())
    assert path.stat().st_size < 2.5 * size  # two different meshes; twenty would be 20
    with dspace.Playback(path) as run:
        for step in (0, 7, 19, 3):
            run.seek(step)
            assert np.array_equal(run.session.viewports[view.name].image(), pictures[step])
    # A part of it, a packed copy and what is salvaged play like the whole.
    cut, packed, salvaged = (tmp_path / f"{name}.dspace" for name in ("cut", "packed", "salvaged"))
    for arguments in (["log", "cut", path, "--from", "5", "--to", "19", "--out", cut], ["log", "pack", path, "--out", packed],
                      ["log", "salvage", path, "--out", salvaged], ["log", "info", path]):
        subprocess.run([sys.executable, "-m", "dspace", *map(str, arguments)], check=True)
    for copy in (cut, packed, salvaged):
        with dspace.Playback(copy) as run:
            run.seek(19)
            assert np.array_equal(run.session.viewports[view.name].image(), pictures[19])


def test_damaged_arrays_are_named(session, scene, tmp_path):
    path = tmp_path / "run.dspace"
    scene.add_mesh(QUAD, TWO)
    session.record(path).stop()
    with sqlite3.connect(path) as file:
        assert file.execute("SELECT count(*) FROM asset WHERE state = 'arrays'").fetchone() == (1,)
        file.execute("DELETE FROM content")
    with pytest.raises(dspace.Corrupt, match="arrays"):
        dspace.Playback(path)


BAD = [
    (dict(points=None), "no points are given"),
    (dict(points=np.zeros((0, 3))), "it has no points; accepted: 1 or more"),
    (dict(points=np.zeros((4, 2))), r"the points have shape \(4, 2\); accepted: \(n, 3\)"),
    (dict(points="abc"), "points is 'abc'"),
    (dict(points=np.full((4, 3), np.nan)), r"point 0 is \[nan, nan, nan\]; accepted: finite numbers"),
    (dict(points=np.full((4, 3), 1e30)), "accepted"),
    (dict(triangles=[[0, 1, 4]]), r"row 0 of the triangles is \[0, 1, 4\]; accepted: indices from 0 to 3"),
    (dict(triangles=[[0, 1, -1]]), r"row 0 of the triangles is \[0, 1, -1\]"),
    (dict(triangles=[[0.0, 1, 2]]), "the triangles are of type float64; accepted: integers"),
    (dict(triangles=[[0, 1]]), r"the triangles have shape \(1, 2\); accepted: \(m, 3\)"),
    (dict(triangles=[[0, 1, 2], [0, 1]]), "triangles"),
    (dict(triangles=np.zeros((0, 3), int)), "it has no triangles and no lines"),
    (dict(triangles={"wing": [[0, 1, 9]]}), "part 'wing': row 0 of the triangles"),
    (dict(triangles={3: [[0, 1, 2]]}), "the name of a part is 3; accepted: a str"),
    (dict(normals=np.zeros((4, 3))), "the normal of vertex 0 has length 0; accepted: 1 within 0.01"),
    (dict(normals=np.zeros((3, 3))), r"the normals have shape \(3, 3\); accepted: \(4, 3\)"),
    (dict(tcoords=np.zeros((4, 3))), r"the tcoords have shape \(4, 3\); accepted: \(4, 2\)"),
    (dict(tcoords=np.full((4, 2), np.inf)), "row 0 of the tcoords"),
    (dict(colors=np.zeros((5, 3))), r"the colors have shape \(5, 3\)"),
    (dict(colors=np.full((4, 3), 2.0)), r"color 0 is \[2.0, 2.0, 2.0\]; accepted: numbers from 0 to 1"),
    (dict(colors=np.zeros((4, 3), int)), "the colors are of type int64; accepted: uint8, or floats"),
    (dict(scalars=np.zeros(5)), r"the scalars have shape \(5,\)"),
    (dict(scalars=np.zeros(4), low=2, high=1), "low is 2 and high 1"),
    (dict(scalars=np.zeros(4), colormap=["red"]), "accepted: 2 or more colors"),
    (dict(scalars=np.zeros(4), colormap=["red", "nocolor"]), "a color of the colormap is 'nocolor'"),
    (dict(scalars=np.zeros(4), colors=np.zeros((4, 3))), "colors and scalars are given"),
    (dict(low=1), "colormap, low or high is given without scalars"),
    (dict(levels=[QUAD]), "a level is"),
    (dict(levels=[({"points": QUAD}, 5)]), "minimumPixels"),
    (dict(levels=[({"pints": QUAD}, 5)]), "unknown keyword 'pints'"),
    (dict(wings=1), "unknown keyword 'wings'"),
]


@pytest.mark.parametrize("given, text", BAD, ids=[text[:40] for _, text in BAD])
def test_bad_input_is_refused_by_name(scene, refused, given, text):
    mesh = scene.add_mesh(QUAD, TWO, name="sheet")
    arguments = {"points": QUAD, "triangles": TWO, "name": "bad", **given}
    with refused(dspace.InvalidArgument, ""):
        try:
            scene.add_mesh(**arguments)
        except dspace.InvalidArgument as error:
            import re
            assert "bad" in str(error) and re.search(text, str(error)), str(error)
            raise
    if set(given) <= {"points", "triangles", "normals", "tcoords", "colors", "scalars", "low", "colormap", "high"}:
        with refused(dspace.InvalidArgument, ""):
            mesh.update(**given)


def test_update_of_another_object_is_refused(scene, refused):
    box = scene.add_box((1, 1, 1))
    other = dspace.Mesh(scene, box.id, {"points": QUAD, "triangles": TWO})
    with refused(dspace.InvalidArgument, "it is not made of arrays; accepted: objects of create_mesh"):
        other.update()


def test_a_viewer_sees_it_and_a_served_recording_stores_it_once(tmp_path):
    rng = np.random.default_rng(3)
    points, triangles = rng.uniform(-1, 1, (20000, 3)), rng.integers(0, 20000, (30000, 3))
    record, here = tmp_path / "served.dspace", tmp_path / "here.dspace"
    with Served(tmp_path, "--record", str(record), "--max-message", "1500000") as server:
        with dspace.connect(server.address) as session, session.record(here):
            scene = session.scene()
            mesh = scene.add_mesh(points, triangles)
            scene.add_camera(eye=(3, -4, 3), target=(0, 0, 0))
            for step in range(8):
                scene.time = step
                mesh.update()
            expected = scene.add_viewport((160, 120), name="main", samples=1).image()
            with dspace.watch(server.address) as watcher:
                watcher.update()
                view = watcher.scenes["scene"].add_viewport((160, 120), name="viewer:mine", samples=1)
                assert np.array_equal(view.image(), expected)
            with pytest.raises(dspace.Resource, match="bytes; accepted: up to 1500000"):
                scene.add_mesh(np.tile(points, (6, 1)), np.arange(120000).reshape(-1, 3), name="large")
            assert "large" not in scene.objects
    size = 20000 * 12 + 30000 * 12
    for path in (record, here):
        assert path.stat().st_size < 1.7 * size
        with dspace.Playback(path) as run:
            run.seek(7)
            assert np.array_equal(run.session.viewports["main"].image(), expected)
