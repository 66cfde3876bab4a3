"""Input that is finite and yet beyond what can be shown: refused before anything changes."""
import numpy as np
import pytest

import dspace
from needs import needs_module


HEADER = ("ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
          "property float z\n")
VERTICES = "0 0 0\n1 0 0\n0 1 0\n"


def test_a_file_without_faces_is_a_point_cloud_only_when_asked_for(scene, refused, tmp_path):
    faces = "element face 1\nproperty list uchar int vertex_indices\n"
    gltf = ('{"asset": {"version": "2.0"}, "meshes": [{"name": "shell"%s}], '
            '"nodes": [{"mesh": 0}], "scenes": [{"nodes": [0]}]}')
    for name, content, text in (
            ("p.ply", HEADER + "end_header\n" + VERTICES, "has 3 vertices and no faces"),
            ("none.ply", HEADER + faces.replace("face 1", "face 0") + "end_header\n" + VERTICES,
             "has 3 vertices and no faces"),
            ("v.obj", "v 0 0 0\nv 1 0 0\n", "has 2 vertices and no faces"),
            ("no.stl", "solid a\nendsolid a\n", "has no triangles"),
            ("no.wrl", "#VRML V2.0 utf8\nGroup { }\n", "no faces"),
            ("point.wrl", "#VRML V2.0 utf8\nShape { geometry PointSet { coord Coordinate { "
             "point [ 0 0 0, 1 0 0 ] } } }\n", "has 2 vertices and no faces"),
            ("no.gltf", gltf % "", "'shell' has no primitives"),
            ("empty.gltf", gltf % ', "primitives": []', "'shell' has no primitives")):
        path = tmp_path / name
        path.write_text(content)
        with refused(dspace.Corrupt, text):
            scene.load(path)
        with refused(dspace.Corrupt, name):
            scene.load(path)
    with refused(dspace.Corrupt, "point_cloud=True"):
        scene.load(tmp_path / "p.ply")
    cloud = scene.load(tmp_path / "p.ply", point_cloud=True, point_size=5)
    assert cloud.triangles == 0
    # What was read as a cloud is not kept for those who did not ask for one.
    with refused(dspace.Corrupt, "p.ply"):
        scene.load(tmp_path / "p.ply")
    whole = tmp_path / "whole.ply"
    whole.write_text(HEADER + faces + "end_header\n" + VERTICES + "3 0 1 2\n")
    assert scene.load(whole, point_cloud=True).triangles == 1
    frames_only = tmp_path / "frames.urdf"
    frames_only.write_text('<robot name="r"><link name="a"/></robot>')
    assert scene.load(frames_only).objects == []


def test_long_texts(scene, refused):
    view = scene.add_viewport((64, 48))
    scene.add_camera("camera", eye=(5, 0, 0), target=(0, 0, 0))
    label = scene.add_label("short")
    for make in (lambda text: scene.add_text(text, 1), scene.add_label):
        with refused(dspace.InvalidArgument, "has 200000 characters; accepted: up to 4096"):
            make("x" * 200000)
    with refused(dspace.InvalidArgument, "4097 characters"):
        label.set("x" * 4097)
    with refused(dspace.InvalidArgument, "pixels large"):  # one line of a hundred thousand pixels
        scene.add_label("W" * 4096, font_size=200)
    with refused(dspace.InvalidArgument, "text table 'values': the value of 'a' has 200000 characters"):
        view.set_table("values", {"a": "x" * 200000})
    with refused(dspace.InvalidArgument, "text table 'values': it has 1002 cells"):
        view.set_table("values", [("a", "b")] * 501)
    with refused(dspace.InvalidArgument, "pixels large"):
        view.set_table("values", {"a": "x" * 4096}, font_size=200)
    # The greatest of each is drawn.
    scene.add_text("\n".join(["x" * 63] * 64), 0.01)
    scene.add_label("\n".join(["\u00e4" * 63] * 64), font_size=10)
    view.set_table("values", [("a", "b")] * 500)
    assert view.image().shape == (48, 64, 3)


@pytest.mark.parametrize("value", [1e30, -1e300])
def test_places(scene, refused, value):
    frame = scene.add_frame("far", position=(1e18, -1e18, 0))
    with refused(dspace.InvalidArgument, "within 1e18 m"):
        frame.position = (0, value, 0)
    with refused(dspace.InvalidArgument, "frame 'far' (row 0)"):
        scene.set_poses([frame], [[value, 0, 0, 1, 0, 0, 0, 1]])
    with refused(dspace.InvalidArgument, "within 1e18 m"):
        scene.add_frame("farther", position=(value, 0, 0))
    with refused(dspace.InvalidArgument, "within 1e18 m"):
        scene.add_box((1, 1, 1), position=(0, 0, value))
    with refused(dspace.InvalidArgument, "within 1e15 m"):
        scene.add_points([(0, 0, 0), (value, 0, 0)])
    trail = scene.add_trail()
    with refused(dspace.InvalidArgument, "within 1e18 m"):
        trail.append([(0, 0, 0), (0, value, 0)])
    np.testing.assert_array_equal(frame.position, (1e18, -1e18, 0))


@pytest.mark.parametrize("scale", [0, 1e-300, 1e300, float("nan")])
def test_scales(scene, refused, tmp_path, scale):
    frame = scene.add_frame("frame")
    with refused(dspace.InvalidArgument, "from 1e-12 to 1e12"):
        frame.scale = scale
    with refused(dspace.InvalidArgument, "accepted: 1e-12 to 1e12"):
        scene.add_box((1, 1, 1), stretch=(1, scale, 1))
    path = tmp_path / "one.obj"
    path.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    with refused(dspace.InvalidArgument, "accepted: 1e-12 to 1e12"):
        scene.load(path, scale=scale)


def test_sizes(scene, refused):
    for size in (0, 1e300, 1e-300):
        for make in (lambda s: scene.add_box((1, 1, s)), scene.add_sphere, scene.add_arrow,
                     scene.add_axes, scene.add_goal, scene.add_tilt_marker, scene.add_disc,
                     lambda s: scene.add_cylinder(1, s), lambda s: scene.add_cone(s, 1),
                     lambda s: scene.add_plane(1, s), lambda s: scene.add_torus(1, s),
                     lambda s: scene.add_frustum(s, (4, 3)), lambda s: scene.add_text("a", s)):
            with refused(dspace.InvalidArgument, "1e-9 to 1e15 metres"):
                make(size)


def test_cameras(scene, refused):
    eye = dict(eye=(5, 0, 0), target=(0, 0, 0))
    camera = scene.add_camera("camera", **eye)
    for values, text in ((dict(near=1e300), "near distance is 1e+300; accepted: 1e-9 to 1e18"),
                         (dict(near=1e-300), "near distance is 1e-300"),
                         (dict(far=1e300), "far distance is 1e+300; accepted: up to 1e18"),
                         (dict(height=1e300), "height is 1e+300; accepted: 1e-9 to 1e18"),
                         (dict(fov_deg=1e-300), "vertical fov is 1e-300"),
                         (dict(tangents=(-1e300, 1, -1, 1)), "left is -1e+300")):
        with refused(dspace.InvalidArgument, "camera 'camera': " + text):
            scene.add_camera("camera", **eye, **values)
    with refused(dspace.InvalidArgument, "eye is (1e+300, 0, 0); accepted: within 1e18 metres"):
        scene.add_camera("camera", eye=(1e300, 0, 0), target=(0, 0, 0))
    with refused(dspace.InvalidArgument, "camera 'camera'"):
        camera.set_projection(fov_deg=40, near=1e300)


def test_heights(scene, refused, tmp_path):
    gdal = needs_module("osgeo.gdal", "python3-gdal")
    heights = np.zeros((4, 5))
    heights[2, 3] = 1e30
    path = str(tmp_path / "high.tif")
    dataset = gdal.GetDriverByName("GTiff").Create(path, 5, 4, 1, gdal.GDT_Float64)
    dataset.GetRasterBand(1).WriteArray(heights)
    dataset = None
    with refused(dspace.InvalidArgument, "column 3, row 2 has the height 1e+30 m; accepted are"):
        scene.add_terrain(path)
    with refused(dspace.InvalidArgument, "high.tif"):
        scene.add_terrain(path)
