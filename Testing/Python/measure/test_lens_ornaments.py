"""Frustums of lenses against closed forms."""
import numpy as np

import dspace

PINHOLE = dspace.CameraModel("pinhole", size=(80, 60), focal=(60, 60), center=(39.5, 29.5), position=(0.1, 0.2, 0.3))
FISHEYE = dspace.CameraModel("equidistant", size=(360, 360), focal=(60, 60), center=(179.5, 179.5))


def test_a_frustum_through_a_lens(scene):
    body = scene.add_frame("body", position=(1.0, 2.0, 3.0))
    frustum = scene.add_lens_frustum(PINHOLE, 2.0, body, steps=4)
    info = frustum._info()
    # The border is farthest to the sides at the middle of the edges: 40 and 30 pixels of 60.
    x, y = 2.0 * (40 / 60) / np.hypot(1.0, 40 / 60), 2.0 * 0.5 / np.hypot(1.0, 0.5)
    np.testing.assert_allclose((info.box_minimum.x, info.box_minimum.y), (0.1 - x, 0.2 - y), atol=1e-6)
    np.testing.assert_allclose((info.box_maximum.x, info.box_maximum.y), (0.1 + x, 0.2 + y), atol=1e-6)
    # A fish-eye's corners, beyond 180 degrees from the axis, have no ray.
    assert scene.add_lens_frustum(FISHEYE, 1.0, body).ornamental


def test_rejected(scene, refused):
    with refused(dspace.WrongType, "the model is 3; accepted: a dspace.CameraModel"):
        scene.add_lens_frustum(3, 1.0)
    with refused(dspace.InvalidArgument, "the length is 0; accepted: above 0 m"):
        scene.add_lens_frustum(PINHOLE, 0)
    with refused(dspace.InvalidArgument, "steps is 0; accepted: 1 to 1000"):
        scene.add_lens_frustum(PINHOLE, 1.0, steps=0)
    with refused(dspace.InvalidArgument, "one with the size of its image"):
        scene.add_lens_frustum(dspace.CameraModel("pinhole", focal=(60, 60), center=(39.5, 29.5)), 1.0)
    everywhere = dspace.CameraModel("equidistant", size=(400, 400), focal=(60, 60), center=(199.5, 199.5))
    with refused(dspace.InvalidArgument, "the lens has no ray at the image's border"):
        scene.add_lens_frustum(everywhere, 1.0)
