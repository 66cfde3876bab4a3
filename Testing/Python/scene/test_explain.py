"""Viewport.explain(): every reason why an object is seen or not, with its numbers, and the remarks."""
import numpy as np
import pytest

from terrain_support import FIELD

SIZE = (160, 120)


@pytest.fixture
def view(scene):
    """A camera at 10 m before the origin looking along -X, 160 x 120 pixels."""
    scene.add_camera("eye", eye=(10, 0, 0), target=(0, 0, 0), fov_deg=60)
    return scene.add_viewport(SIZE)


def reason(view, thing):
    found = view.explain().of(thing)
    assert found.text.endswith("."), found
    return found.reason, found.text


def test_what_is_seen(scene, view):
    cube = scene.add_box((2, 2, 2), name="cube")
    found = view.explain()
    pixels = int((view.labels() == cube.id).sum())
    seen = found.of(cube)
    assert (seen.reason, seen.pixels, seen.object, seen.name) == ("seen", pixels, cube, "cube")
    assert seen.text == f"{pixels} pixels show it."
    assert found.remarks == () and found.of("nothing") is None
    assert str(found) == f"cube: seen. {pixels} pixels show it."


def test_what_is_switched_off(scene, view):
    cube = scene.add_box((2, 2, 2), name="cube")
    axes = scene.add_axes(2, name="axes")
    arm = scene.add_fragment("arm")
    part = scene.add_box((1, 1, 1), name="part", fragment=arm)
    cube.visible = False
    assert reason(view, cube) == ("hidden", "The object itself is hidden.")
    cube.visible = True
    view.hide(arm)
    assert reason(view, part) == ("fragment hidden", "Its fragment 'arm' is hidden in this viewport.")
    view.show(arm)
    arm.visible = False
    assert reason(view, part) == ("fragment hidden", "Its fragment 'arm' is hidden in all viewports.")
    view.ornaments = False
    assert reason(view, axes)[0] == "ornaments hidden"
    assert "Everything ornamental is hidden: 1 object." in view.explain().remarks
    cube.opacity = 0.0
    assert reason(view, cube) == ("transparent", "Its opacity is 0.")
    trail = scene.add_trail(5, name="trail")
    view.ornaments = True
    assert reason(view, trail) == ("empty", "It has nothing to draw.")


def test_what_is_outside_the_view(scene, view):
    behind = scene.add_box((1, 1, 1), position=(20, 0, 0), name="behind")
    assert reason(view, behind) == ("behind", "It is behind the camera: it reaches from -10.5 to -9.5 m along the "
                                              "camera's Z.")
    left = scene.add_box((1, 1, 1), position=(0, -20, 0), name="left")
    word, text = reason(view, left)
    assert word == "outside" and "beyond the left border" in text and "of 160 x 120 pixels" in text
    # The closed form: 20 m to the left at a depth of 10 m; 120 rows span 2 x 10 x tan 30 deg.
    column = 79.5 - 20 / (2 * 10 * np.tan(np.radians(30)) / 120)
    assert f"({column:.4g}, " in text
    for name, position in (("right", (0, 20, 0)), ("top", (0, 0, 20)), ("bottom", (0, 0, -20))):
        thing = scene.add_box((1, 1, 1), position=position, name=name)
        assert f"beyond the {name} border" in reason(view, thing)[1]
    cube = scene.add_box((2, 2, 2), name="cube")
    scene.cameras["eye"].near = 30.0
    assert reason(view, cube) == ("before near", "It is before the near plane at 30 m: it reaches from 9 to 11 m along "
                                                 "the camera's Z.")
    scene.cameras["eye"].set_projection(fov_deg=60, near=1.0, far=5.0)
    assert reason(view, cube)[0] == "beyond far" and "at 5 m" in reason(view, cube)[1]
    assert "No pixel shows an object." in view.explain().remarks


def test_what_is_too_small_or_occluded(scene, view, tmp_path):
    speck = scene.add_box((1e-3, 1e-3, 1e-3), position=(0, 0.033, 0.033), name="speck")
    word, text = reason(view, speck)
    assert word == "too small" and "its diameter is 0.018 pixels" in text, text
    wall = scene.add_box((0.1, 4, 4), position=(5, 0, 0), name="wall")
    cube = scene.add_box((1, 1, 1), position=(-5, 0, 0), name="cube")
    word, text = reason(view, cube)
    assert word == "occluded" and "by 'wall'" in text and "at 15 m" in text, text
    wall.visible = False
    assert reason(view, cube)[0] == "seen"
    (tmp_path / "plate.obj").write_text("v -1 -1 0\nv 1 -1 0\nv 0 1 0\nf 1 2 3\n")
    plate = scene.load((str(tmp_path / "plate.obj"), 400), name="plate")
    assert reason(view, plate)[0] == "too small" and "from 400 pixels on" in reason(view, plate)[1]


def test_remarks(session, scene, view):
    assert view.explain().remarks == ("The scene has no object.",)
    cube = scene.add_box((30, 30, 30), name="cube")
    assert "The camera is inside the box around object 'cube'." in view.explain().remarks
    cube.remove()
    for light in list(scene.lights.values()):
        light.remove()
    scene.add_box((1, 1, 1), name="box")
    assert view.explain().remarks == ("No light is on: lit surfaces are black.",)


def test_a_camera_below_the_ground_is_remarked(scene, view):
    ground = scene.add_terrain(FIELD, name="ground")
    x, y = 3.0, -4.0
    height = ground.height(x, y)
    eye = scene.add_camera("low", eye=(x, y, height - 3.0), target=(x + 10, y, height - 3))
    view.camera = eye
    remarks = [each for each in view.explain().remarks if "below the ground" in each]
    assert len(remarks) == 1 and "'ground'" in remarks[0]
    depth = float(remarks[0].split("is ")[1].split(" m")[0])
    assert depth == pytest.approx(3.0, abs=1e-6)
    eye.look_at((x, y, height + 3.0), (x + 10, y, height))
    assert not [each for each in view.explain().remarks if "below the ground" in each]
