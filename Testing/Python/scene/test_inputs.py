"""Keys and clicks that the camera does not use reach callbacks: in this process, connected, and from a viewer."""
import time

import numpy as np
import pytest

import dspace
from served_support import Served

SIZE = (160, 120)


def click(view, x, y, button="left", **modifiers):
    view.event("press", x, y, button=button, **modifiers)
    return view.event("release", x, y, button=button, **modifiers)


def fill(scene):
    cube = scene.add_box((2, 2, 2), name="cube")
    camera = scene.add_camera("eye", eye=(9, 0, 0), target=(0, 0, 0))
    return cube, camera, scene.add_viewport(SIZE, camera, name="view")


def test_unused_keys_and_clicks_reach_callbacks(anywhere):
    cube, camera, view = fill(anywhere.scene())
    heard = []
    view.on_key(heard.append)
    view.on_click(heard.append)
    before = camera.pose_in().position
    view.event("key", 30, 40, key="space", control=True)
    assert [(each.key, each.button, each.x, each.y, each.control, each.shift, each.pick) for each in heard] == [
        ("space", None, 30, 40, True, False, None)]
    assert heard.pop().viewport == view
    assert click(view, 80, 60).object == cube.id  # as before
    click(view, 80, 60, button="right", alt=True)
    click(view, 5, 5, button="middle")
    click(view, 80, 60, shift=True)
    assert [(each.key, each.button, each.pick and each.pick.object, each.alt) for each in heard] == [
        ("", "left", cube.id, False), ("", "right", cube.id, True), ("", "middle", None, False),
        ("", "left", cube.id, False)]
    np.testing.assert_array_equal(camera.pose_in().position, before)
    heard.clear()
    # What the camera uses does not reach them: its keys, and drags.
    for key in ("Left", "Right", "Up", "Down", "+", "-", "f", "r"):
        view.event("key", 80, 60, key=key)
    view.event("wheel", 80, 60, wheel=1)
    for button in ("left", "middle", "right"):
        view.event("press", 80, 60, button=button)
        view.event("move", 100, 70)
        view.event("release", 100, 70, button=button)
    assert heard == []


def test_callbacks_are_those_of_one_viewport(anywhere):
    scene = anywhere.scene()
    cube, camera, view = fill(scene)
    other = scene.add_viewport(SIZE, camera, name="other")
    heard = []
    view.on_key(lambda each: heard.append(("view", each.key)))
    other.on_key(lambda each: heard.append(("other", each.key)))
    view.event("key", key="a")
    other.event("key", key="b")
    assert heard == [("view", "a"), ("other", "b")]
    view.remove()
    again = scene.add_viewport(SIZE, camera, name="view")
    again.event("key", key="c")
    assert len(heard) == 2
    with pytest.raises(dspace.WrongType, match="callback is 3"):
        again.on_click(3)

    def fail(each):
        raise RuntimeError("of the callback")
    again.on_key(fail)
    with pytest.raises(RuntimeError, match="of the callback"):
        again.event("key", key="d")


def test_a_viewer_sends_them_to_the_simulation(tmp_path):
    with Served(tmp_path) as served, dspace.connect(served.address) as session:
        cube, camera, view = fill(session.scene())
        heard, own = [], []
        session.on_event(heard.append, kind="input")
        with dspace.watch(served.address, name="ann") as watcher:
            mine = watcher.add_view("mine", size=SIZE, eye=(9, 0, 0), target=(0, 0, 0))
            mine.on_key(own.append)
            mine.event("key", 1, 2, key="space")
            click(mine, 80, 60, button="right")
            end = time.monotonic() + 30
            while len(heard) < 2 and time.monotonic() < end:
                session.process_events(0.2)
        assert [each.key for each in own] == ["space"]
        assert [(getattr(each, "from"), each.input.scene, each.input.viewport, each.input.input.key,
                 each.input.input.button, each.input.input.pick.object) for each in heard] == [
            ("ann", "scene", "viewer:mine", "space", 0, 0), ("ann", "scene", "viewer:mine", "", 3, cube.id)]
