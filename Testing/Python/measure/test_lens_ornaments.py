"""Frustums and footprints of lenses against closed forms."""
import numpy as np
import pytest

import dspace

PINHOLE = dspace.CameraModel("pinhole", size=(80, 60), focal=(60, 60), center=(39.5, 29.5), position=(0.1, 0.2, 0.3))
FISHEYE = dspace.CameraModel("equidistant", size=(360, 360), focal=(60, 60), center=(179.5, 179.5))


def corners(points):
    return points[:: len(points) // 4]


def test_the_footprint_of_a_pinhole_on_a_plane(scene):
    """The model's pose in a frame that stands 10 m above ground at z = 0, looking down: X right, Y down in the picture."""
    body = scene.add_frame("body", position=(5.0, 6.0, 10.3), quaternion=(0, 1, 0, 0))  # about X: Z is down
    floor = scene.add_plane(1000, 1000)
    footprint = scene.add_lens_footprint(PINHOLE, body, color="yellow")
    h = 10.0  # of the camera: 10.3 - 0.3
    expected = [(5.1 + sx * 40 / 60 * h, 5.8 - sy * 30 / 60 * h, 0.0) for sx, sy in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    np.testing.assert_allclose(corners(footprint.points), expected, atol=1e-9)
    assert len(footprint.points) == 128 and footprint.object.ornamental
    # An object in the way, and another height.
    body.position = (5.0, 6.0, 20.3)
    footprint.update()
    np.testing.assert_allclose(corners(footprint.points)[0], (5.1 - 40 / 3, 5.8 + 10.0, 0.0), atol=1e-9)
    box = scene.add_box((1, 1, 1), position=corners(footprint.points)[0])
    footprint.update()
    assert corners(footprint.points)[0][2] > 0.1
    again = scene.add_lens_footprint(PINHOLE, body, without=box)
    assert corners(again.points)[0][2] == pytest.approx(0.0, abs=1e-9)
    floor.remove()
    again.update()
    assert again.object is None and np.isnan(again.points).all()
    footprint.remove()
    assert footprint.object is None


def test_the_footprint_of_a_camera_of_the_scene(scene):
    scene.add_plane(1000, 1000)
    camera = scene.add_camera("eye", eye=(0, 0, 9), target=(0, 0, 0), up=(0, 1, 0))
    footprint = scene.add_lens_footprint(PINHOLE, camera=camera, steps=2)
    np.testing.assert_allclose(corners(footprint.points), [(-6, 4.5, 0), (6, 4.5, 0), (6, -4.5, 0), (-6, -4.5, 0)], atol=1e-9)


def test_the_line_is_seen_and_above_the_ground(scene):
    scene.add_plane(1000, 1000, color="gray", lit=False)
    camera = scene.add_camera("eye", eye=(0, 0, 9), target=(0, 0, 0), up=(0, 1, 0), fov_deg=70)
    scene.add_lens_footprint(PINHOLE, camera=camera, color="red", lit=False, line_width=3)
    picture = scene.add_viewport((160, 120), camera).image()
    red = (picture[..., 0] > 200) & (picture[..., 1] < 60)
    v, u = np.nonzero(red)
    f = 60 / np.tan(np.radians(35))  # pixels
    assert u.min() == pytest.approx(79.5 - f * 40 / 60, abs=3) and v.max() == pytest.approx(59.5 + f * 30 / 60, abs=3)
    assert not red[50:70, 60:100].any()


def test_a_frustum_through_a_lens(scene):
    body = scene.add_frame("body", position=(1.0, 2.0, 3.0))
    frustum = scene.add_lens_frustum(PINHOLE, 2.0, body, steps=4)
    info = frustum._info()
    # The border is farthest to the sides at the middle of the edges: 40 and 30 pixels of 60.
    x, y = 2.0 * (40 / 60) / np.hypot(1.0, 40 / 60), 2.0 * 0.5 / np.hypot(1.0, 0.5)
    np.testing.assert_allclose((info.box_minimum.x, info.box_minimum.y), (0.1 - x, 0.2 - y), atol=1e-6)
    np.testing.assert_allclose((info.box_maximum.x, info.box_maximum.y), (0.1 + x, 0.2 + y), atol=1e-6)
    assert frustum.to_polydata().GetNumberOfLines() == 4 + 4 * 4  # along the corners, and around
    # A fish-eye's corners, beyond 180 degrees from the axis, have no ray.
    assert scene.add_lens_frustum(FISHEYE, 1.0, body).ornamental


def test_rejected(scene, refused):
    with refused(dspace.WrongType, "the model is 3; accepted: a dspace.CameraModel"):
        scene.add_lens_frustum(3, 1.0)
    with refused(dspace.InvalidArgument, "the length is 0; accepted: above 0 m"):
        scene.add_lens_frustum(PINHOLE, 0)
    with refused(dspace.InvalidArgument, "steps is 0; accepted: 1 to 1000"):
        scene.add_lens_footprint(PINHOLE, steps=0)
    with refused(dspace.InvalidArgument, "the lift is -1; accepted: 0 m or more"):
        scene.add_lens_footprint(PINHOLE, lift=-1)
    everywhere = dspace.CameraModel("equidistant", size=(400, 400), focal=(60, 60), center=(199.5, 199.5))
    for make in (lambda: scene.add_lens_frustum(everywhere, 1.0), lambda: scene.add_lens_footprint(everywhere)):
        with refused(dspace.InvalidArgument, "the lens has no ray at the image's border"):
            make()
