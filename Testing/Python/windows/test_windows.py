"""Windows of scripts: opened, drawn, driven by keys, closed; what is missing is said."""
import os
import subprocess
import sys

import pytest

import dspace

SCRIPT = """
import numpy as np
import dspace
with dspace.Session() as session:
    scene = session.scene()
    scene.add_box((1, 1, 1))
    scene.add_camera(eye=(3, -4, 2), target=(0, 0, 0))
    views = [scene.add_viewport((320, 200), name=name) for name in ("left", "right")]
    keys = []
    views[0].on_key(lambda given: keys.append((given.viewport.name, given.key)))
    for view in views:
        view.show(title="View " + view.name, size=(300, 180))
    assert dspace.process_events(0.2) == 2
    assert views[0].shown and views[1].shown
    dspace.run(0.5)
    # The viewport follows its window, and the window shows its picture.
    assert views[0].size == (300, 180), views[0].size
    assert np.ptp(views[0].image()[..., :3]) > 0
    views[1].close()
    assert not views[1].shown and dspace.process_events() == 1
    views[1].show()
    assert dspace.process_events(0.1) == 2
    views[0].remove()
    assert dspace.process_events(0.1) == 1
try:
    dspace.run()
except dspace.Closed as error:
    assert "no window is open" in str(error)
else:
    raise AssertionError("the session's end left a window")
print("done")
"""


@pytest.fixture
def display():
    """The command that starts others on a display of their own."""
    path = os.path.join(os.path.dirname(__file__), "..", "..", "Tools", "with_display")
    return [os.path.abspath(path)]


def test_windows_open_draw_and_close(display):
    done = subprocess.run([*display, sys.executable, "-c", SCRIPT], capture_output=True, text=True, timeout=300)
    assert done.stdout.strip() == "done", done.stderr


def test_a_display_that_does_not_answer_is_an_error():
    """Qt would end the process."""
    script = ("import dspace\nv = dspace.Session().scene().add_viewport((60, 40))\ntry:\n    v.show()\n"
              "except dspace.Resource as error:\n    print(error)\n")
    environment = {**os.environ, "DISPLAY": ":4711"}
    environment.pop("WAYLAND_DISPLAY", None)
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=120, env=environment)
    assert done.returncode == 0 and "the display ':4711' (DISPLAY) cannot be reached" in done.stdout, done.stderr


def test_without_a_display_the_error_says_so(scene):
    scene.add_camera(eye=(3, -4, 2), target=(0, 0, 0))
    view = scene.add_viewport((32, 20))
    with pytest.raises(dspace.Resource, match="no window can be opened: there is no display: neither DISPLAY"):
        view.show()
    assert not view.shown
    view.close()  # nothing to close


def test_bad_input(scene):
    scene.add_camera(eye=(3, -4, 2), target=(0, 0, 0))
    view = scene.add_viewport((32, 20), name="map")
    with pytest.raises(dspace.InvalidArgument, match="viewport 'map'.*size"):
        view.show(size=(0, 20))
    with pytest.raises(dspace.WrongType, match="viewport 'map'.*title"):
        view.show(title=3)
    with pytest.raises(dspace.InvalidArgument, match="wait"):
        dspace.process_events(-1)
    with pytest.raises(dspace.InvalidArgument, match="seconds"):
        dspace.run(float("inf"))
    with pytest.raises(dspace.Closed, match="no window is open"):
        dspace.run()
