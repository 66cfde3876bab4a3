"""Moving a camera near the ground: it stays above, level, and walks; recordings and bad input."""
import math
import os
import pathlib

import numpy as np
import pytest

import dspace

FIELD = pathlib.Path(os.environ.get("DSPACE_SHIPPED_DATA", pathlib.Path(__file__).parents[3] / "Data")) / "field" / "field.tif"


@pytest.fixture
def field():
    with dspace.Session() as session:
        scene = session.scene()
        ground = scene.add_terrain(FIELD, mode="clipmap")
        camera = scene.add_camera(eye=(0, -20, ground.height(0, -20) + 8), target=(0, 0, ground.height(0, 0)))
        yield scene, ground, camera, scene.add_viewport((200, 150), camera)


def height(ground, camera):
    x, y, z = camera.pose.position
    return z - ground.height(x, y)


def roll(camera):
    """The vertical part of the camera's X axis."""
    w, x, y, z = camera.pose.quaternion
    return 2 * (x * z - w * y)


def test_the_eye_never_goes_under_the_ground(field):
    scene, ground, camera, view = field
    random = np.random.default_rng(3)
    near = 0
    for _ in range(120):
        x, y = random.uniform(0, 199), random.uniform(60, 149)
        if random.random() < 0.5:
            view.event("wheel", x, y, wheel=random.uniform(-1, 4))
        else:
            view.event("press", x, y, "left")
            view.event("move", x + random.uniform(-60, 60), y + random.uniform(-90, 90))
            view.event("release", x, y, "left")
        assert height(ground, camera) >= 0.0999
        assert roll(camera) == pytest.approx(0.0, abs=1e-6)
        near += height(ground, camera) < 0.5
        if np.linalg.norm(camera.pose.position[:2]) > 60 or height(ground, camera) > 60:
            camera.look_at(eye=(0, -20, ground.height(0, -20) + 8), target=(0, 0, ground.height(0, 0)))
    assert near > 3  # the ground was there to stop it


def test_a_walk_is_at_eye_height(field):
    scene, ground, camera, view = field
    view.navigation, view.eye_height, view.walk_speed = "walk", 1.7, 1.5
    assert (view.navigation, view.eye_height, view.walk_speed) == ("walk", 1.7, 1.5)
    view.event("key", 100, 75, key="w", seconds=0.1)
    before = camera.pose.position
    assert height(ground, camera) == pytest.approx(1.7, abs=1e-3)
    for _ in range(10):
        view.event("key", 100, 75, key="w", seconds=0.5)
        assert height(ground, camera) == pytest.approx(1.7, abs=1e-3)
    walked = np.array(camera.pose.position) - before
    assert math.hypot(*walked[:2]) == pytest.approx(7.5, rel=0.02)  # 5 s at 1.5 m/s
    assert walked[1] > 7.0  # the way that it looks
    before = camera.pose.position
    view.event("key", 100, 75, key="d", seconds=1.0, shift=True)
    walked = np.array(camera.pose.position) - before
    assert math.hypot(*walked[:2]) == pytest.approx(6.0, rel=0.02) and walked[0] > 5.0
    # A drag looks around and goes nowhere.
    before = camera.pose
    view.event("press", 100, 75, "left")
    view.event("move", 150, 70)
    view.event("release", 150, 70, "left")
    np.testing.assert_allclose(camera.pose.position, before.position, atol=1e-9)
    assert not np.allclose(camera.pose.quaternion, before.quaternion)


def test_a_double_click_turns_to_the_point_and_escape_cancels(field):
    scene, ground, camera, view = field
    point = view.pick(40, 120).in_root
    view.event("double click", 40, 120, "left")
    after = view.pick(100, 75).in_root
    np.testing.assert_allclose(after, point, atol=0.3)
    before = camera.pose
    view.event("press", 60, 90, "left")
    view.event("move", 120, 110)
    assert not np.allclose(camera.pose.quaternion, before.quaternion)
    view.event("key", key="Escape")
    np.testing.assert_allclose(camera.pose.position, before.position, atol=1e-9)
    np.testing.assert_allclose(camera.pose.quaternion, before.quaternion, atol=1e-9)


def test_settings_are_recorded_and_bad_ones_rejected(tmp_path):
    with dspace.Session() as session:
        scene = session.scene()
        with session.record(tmp_path / "walk.dspace"):
            view = scene.add_viewport((64, 48), scene.add_camera(eye=(5, 0, 1), target=(0, 0, 0)))
            view.navigation, view.eye_height = "map", 0.4
            scene.time = 1.0
        for name, value in (("navigation", "fly"), ("eye_height", 0.0), ("walk_speed", -1.0), ("walk_speed", math.nan)):
            with pytest.raises(dspace.InvalidArgument, match="accepted"):
                setattr(view, name, value)
        assert (view.navigation, view.eye_height) == ("map", 0.4)
    with dspace.Playback(tmp_path / "walk.dspace") as run:
        run.seek(1.0)
        shown = next(iter(run.session.viewports.values()))
        assert (shown.navigation, shown.eye_height, shown.walk_speed) == ("map", 0.4, 1.5)
