"""A simulation that waits for each picture: none is lost, repeated or out of order. DSPACE_LONG=1: 10,000 of them."""
import os

import numpy as np
import pytest

import dspace

COUNT = 10_000 if os.environ.get("DSPACE_LONG") else 250
STEP = 0.01  # metres a step: 10,000 steps end at 101 m, where depths are exact to some 1e-5 m


def number_in(planes):
    """The step that a picture shows: the distance of the wall that fills it."""
    depth = planes["depth"]
    assert np.ptp(depth) < 0.1 * STEP  # one picture, of one step
    return round((float(depth.mean()) - 1.0) / STEP)


def wall_of(session):
    scene = session.scene()
    wall = scene.add_frame("wall", position=(0, 0, 1))
    scene.add_plane(1000, 1000, frame=wall, lit=False)
    camera = scene.add_camera("eye")
    camera.attach(scene.root)
    return scene, wall, camera


@pytest.mark.parametrize("lens", [False, True], ids=["ideal", "lens"])
def test_each_capture_shows_its_own_step(anywhere, lens):
    scene, wall, camera = wall_of(anywhere)
    model = dspace.CameraModel("brown", size=(16, 12), focal=(14, 14), center=(7.5, 5.5), radial=(-0.1,)) if lens else None
    size = None if lens else (16, 12)
    found, held = [], []
    for step in range(COUNT):
        scene.time = 0.1 * step
        wall.pose = dspace.Pose((0, 0, 1 + STEP * step))
        planes = camera.capture(model, size=size, depth=True, color=False, samples=1)
        found.append(number_in(planes))
        if step < 5:
            held.append(planes)
    assert found == list(range(COUNT))
    assert [number_in(planes) for planes in held] == list(range(5))  # arrays are the caller's own


def test_captures_wait_for_poses_that_were_sent_without_waiting(tmp_path):
    from served_support import Served
    with Served(tmp_path) as served, dspace.connect(served.address) as session:
        scene, wall, camera = wall_of(session)
        session.wait = False
        found = []
        for step in range(COUNT):
            for part in (0.25, 0.5, 0.75, 1.0):  # steps between pictures
                scene.time = 0.1 * (step + part)
                wall.pose = dspace.Pose((0, 0, 1 + STEP * (step - 1 + part)))
            planes = camera.capture(size=(16, 12), depth=True, color=False, samples=1)
            assert scene.time == pytest.approx(0.1 * (step + 1))
            found.append(number_in(planes))
        assert found == list(range(COUNT))


def test_captures_of_a_pair_are_of_one_step(anywhere):
    """Left and right show the same step: disparity and depth agree."""
    scene, wall, _ = wall_of(anywhere)
    pair = dspace.StereoPair(dspace.CameraModel("pinhole", size=(16, 16), focal=(14, 14), center=(7.5, 7.5)), baseline=0.2)
    for step in range(COUNT // 10):
        wall.pose = dspace.Pose((0, 0, 1 + STEP * step))
        assert [number_in(planes) for planes in pair.capture(scene, frame=scene.root, depth=True, color=False, samples=1)] == [step] * 2
