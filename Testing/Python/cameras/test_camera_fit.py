"""Cameras that are moved to show things whole: the silhouette against the borders of the picture."""
import numpy as np
import pytest

import dspace

SIZE = (160, 120)
PROJECTIONS = {"perspective": dict(fov_deg=40.0), "wide": dict(fov_deg=100.0), "orthographic": dict(height=3.0),
               "off-axis": dict(tangents=(-0.1, 0.5, -0.4, 0.2))}


@pytest.fixture
def boxes(scene):
    """Two groups of boxes; the second one is on a frame of its own, turned and scaled."""
    left = scene.add_box((1, 2, 3), position=(-4, 1, 0), name="left")
    group = scene.add_frame("group", position=(6, 3, 2), quaternion=(0.8, 0.0, 0.6, 0.0), scale=2.0)
    below = group.add_frame("below", position=(0, 1, 0))
    right = scene.add_box((1, 1, 1), frame=group, name="right")
    deep = scene.add_box((0.5, 0.5, 4), frame=below, name="deep")
    return left, group, right, deep


def margins(viewport, ids):
    """Free pixels left, right, above and below of what shows these objects."""
    rows, columns = np.nonzero(np.isin(viewport.labels(physical_only=False), ids))
    width, height = viewport.size
    return columns.min(), width - 1 - columns.max(), rows.min(), height - 1 - rows.max()


@pytest.mark.parametrize("projection", PROJECTIONS)
def test_things_fill_the_picture(scene, boxes, projection):
    left, group, right, deep = boxes
    camera = scene.add_camera("eye", eye=(30, -40, 25), target=(35, 20, 0), **PROJECTIONS[projection])
    viewport = scene.add_viewport(SIZE, camera, samples=1)
    rotation = camera.pose_in().rotation
    for things, ids in ((left, [left.id]), (group, [right.id, deep.id]), ([left, group], [left.id, right.id, deep.id]),
                        (None, [left.id, right.id, deep.id])):
        viewport.fit(things, margin=0.0)
        free = margins(viewport, ids)
        # A tight box touches two opposite borders; corners are vertices, so that a pixel is all that may be free.
        assert min(max(free[:2]), max(free[2:])) <= 2, free
        np.testing.assert_allclose(camera.pose_in().rotation, rotation, atol=1e-12)
        viewport.fit(things, margin=0.25)  # the picture is then 1.5 times as large
        free = margins(viewport, ids)
        height, width = SIZE[1] - free[2] - free[3], SIZE[0] - free[0] - free[1]
        assert abs(max(height / SIZE[1], width / SIZE[0]) - 1 / 1.5) < 0.04, free
    assert viewport.explain().of("left").reason == "seen"


def test_a_camera_on_a_frame_stays_on_it(scene, boxes):
    group = boxes[1]
    camera = scene.add_camera("eye", frame=group, eye=(0, 0, 9), target=(0, 0, 0), up=(0, 1, 0))
    camera.fit(boxes[2])
    assert camera.frame == group and camera.pose is not None
    chasing = scene.add_camera("chase", frame=group, chase=dict(offset=(-9, 0, 3)))
    chasing.fit([boxes[2], boxes[3]])
    assert chasing.pose is not None  # it stands still now


def test_what_cannot_be_shown_is_rejected(scene, boxes):
    camera = scene.add_camera("eye", eye=(9, 9, 9), target=(0, 0, 0))
    empty = scene.add_frame("empty")
    before = camera.pose_in()
    for call, kind, text in (
            (lambda: camera.fit(empty), dspace.InvalidArgument, "there is nothing to show"),
            (lambda: camera.fit([]), dspace.InvalidArgument, "one object or frame, or more"),
            (lambda: camera.fit("left"), dspace.WrongType, "objects and frames|dspace.GraphicsObject"),
            (lambda: camera.fit([3]), dspace.WrongType, "objects, frames, robots, models and assemblies"),
            (lambda: camera.fit(margin=-1), dspace.InvalidArgument, "margin"),
            (lambda: camera.fit(margin=float("nan")), dspace.InvalidArgument, "margin"),
            (lambda: camera.fit(aspect=-2), dspace.InvalidArgument, "aspect"),
    ):
        with pytest.raises(kind, match=text):
            call()
    np.testing.assert_array_equal(camera.pose_in().position, before.position)
