"""What a user's session may run into: no lights, letters beyond ASCII, things of a closed session."""
import inspect

import numpy as np
import pytest

import dspace

SIZE = (64, 48)


@pytest.fixture
def view(scene):
    camera = scene.add_camera(eye=(0, 0, 5), target=(0, 0, 0), up=(0, 1, 0))
    return scene.add_viewport(SIZE, camera)


@pytest.mark.parametrize("material", [{}, {"metallic": 1.0, "roughness": 0.3}, {"opacity": 0.5}])
def test_without_lights_a_lit_surface_is_black(scene, view, material):
    cube = scene.add_box((2, 2, 2), color=(1, 1, 1), **material)
    seen = view.labels() == cube.id
    scene.lights["sun"].enabled = False
    sky = scene.add_light("sky", kind="ambient", intensity=0.25)
    assert view.image()[seen].any()  # what the sky leaves
    sky.enabled = False
    assert seen.any() and not view.image()[seen].any()


def test_outlined_letters_are_not_left_out_silently(scene, refused):
    with refused(dspace.InvalidArgument, "U+4E2D"):
        scene.add_text("café 中", 1)
    text = scene.add_text("café\nЖ", 1)
    with refused(dspace.InvalidArgument, "U+56FD"):
        text.set("3° 国")


def test_points_have_three_numbers_each(scene, refused):
    for add in (scene.add_points, scene.add_lines):
        for shape in ((3, 2), (6,), (2, 3, 1)):
            with refused(ValueError, "shape"):
                add(np.zeros(shape))


def test_ids_are_integers(scene, refused):
    frame = scene.add_frame("f")
    with refused(ValueError, "integers"):
        scene.poses(np.array([frame.id + 0.7]))


def test_bad_words_and_names(session, scene, field, refused):
    frame = scene.add_frame("f")
    with refused(ValueError, "axis"):
        frame.rotate("k", 10)
    with refused(ValueError, "sun_azimuth_deg"):
        scene.add_terrain(field, relief={"azimuth": 3})
    with refused(ValueError, "tangents"):
        scene.add_camera(tangents=(-1, 1, 1))
    with refused(ValueError, "empty"):
        session.scene("")


def test_a_closed_session_says_so():
    with dspace.Session() as session:
        scene = session.scene()
        frame = scene.add_frame("f")
        viewport = scene.add_viewport(SIZE, scene.add_camera(eye=(5, 0, 0), target=(0, 0, 0)))
    for use in (lambda: scene.vtk, lambda: frame.vtk, lambda: viewport.vtk, viewport.image,
                lambda: viewport.run(lambda window, renderer: None), session.scene):
        with pytest.raises(RuntimeError, match="closed"):
            use()
    assert "not in the scene" in repr(frame) and repr(session) and repr(scene) and repr(viewport)


def test_a_joint_of_a_removed_robot_has_a_repr(scene, tmp_path):
    path = tmp_path / "r.urdf"
    path.write_text('<robot name="r"><link name="a"/><link name="b"/><joint name="j" '
                    'type="continuous"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/>'
                    '</joint></robot>')
    robot = scene.load(path)
    joint = robot.joints["j"]
    assert "continuous" in repr(joint)
    robot.remove()
    assert "not in the scene" in repr(joint)


def label_size(scene, view, text):
    """Columns and rows of a label's red ground in the picture."""
    label = scene.add_label(text, position=(-2, 0, 0), font_size=10, color=(1, 0, 0),
                            background=(1, 0, 0), background_opacity=1)
    rows, columns = np.nonzero(view.image()[..., 0] > 127)
    label.remove()
    return np.ptp(columns) + 1, np.ptp(rows) + 1


def test_a_label_has_its_pixels_at_any_number_of_samples(scene, view):
    view.samples = 1
    size = label_size(scene, view, "abc")
    for view.samples in (2, 4):
        assert label_size(scene, view, "abc") == pytest.approx(size, abs=1)
    assert label_size(scene, view, "abc\u00e9")[0] > size[0] + 3  # letters beyond ASCII are drawn


# --- Anything for anything ---------------------------------------------------------------------

JUNK = [None, 5, -1, 1.5, float("nan"), float("inf"), 10**400, "", "zzz", "\ud800", "a\0b", b"x", [], [1],
        (1, 2, 3), {}, {"a": 1}, object(), np.zeros((2, 3)), np.zeros(()), np.array(["a"]), True,
        [[1, 2], [3]], lambda: 1, 1e300, "x" * 100000]
# What takes no value, ends the session or the thing, or is the user's own code.
LEFT_OUT = ("close", "remove", "execute", "run", "vtk", "process_events")


def uses(thing, given):
    """Every (name, call) that hands junk to a settable property or an argument of a method."""
    for name in dir(type(thing)):
        if name.startswith("_") or name in LEFT_OUT:
            continue
        member = inspect.getattr_static(type(thing), name)
        if isinstance(member, property):
            if member.fset:
                for junk in JUNK:
                    yield name, lambda: setattr(thing, name, junk)
            continue
        method = getattr(thing, name)
        parameters = inspect.signature(method).parameters.values() if callable(method) else ()
        needed = {p.name: given.get(p.name) for p in parameters
                  if p.default is p.empty and p.kind in (p.POSITIONAL_OR_KEYWORD, p.KEYWORD_ONLY)}
        keys = [p.name for p in parameters if p.kind in (p.POSITIONAL_OR_KEYWORD, p.KEYWORD_ONLY)]
        if name.startswith("add_") and any(p.kind is p.VAR_KEYWORD for p in parameters):
            keys += ["name", "frame", "fragment", "position", "quaternion", "stretch", "visible",
                     "color", "texture", "opacity", "lit", "line_width"]
        for key in keys:
            for junk in JUNK:
                yield f"{name}({key})", lambda: method(**{**needed, key: junk})


def test_anything_for_anything_is_accepted_or_a_dspace_error(session, scene, field, tmp_path,
                                                             monkeypatch):
    monkeypatch.chdir(tmp_path)  # "zzz" is a path, too
    (tmp_path / "r.urdf").write_text(
        '<robot name="r"><link name="a"/><link name="b"/><joint name="j" type="continuous">'
        '<parent link="a"/><child link="b"/><axis xyz="0 0 1"/></joint></robot>')
    frame, robot = scene.add_frame("f"), scene.load("r.urdf")
    camera = scene.add_camera("c", eye=(5, 0, 0), target=(0, 0, 0))
    given = dict(path="r.urdf", name="n", size=(64, 48), frames=[frame], poses=[[0, 0, 0, 1, 0, 0, 0, 1]],
                 points=[(0, 0, 0), (1, 1, 1)], x=1, y=1, xy=[(0, 0)], text="a", height=1.0, radius=1.0,
                 length=1.0, tube=0.1, width=1.0, eye=(1, 0, 0), target=(0, 0, 0), frame=frame,
                 parent=scene.root, axis="x", angle_deg=3, other=scene.root, callback=len, token=0,
                 rows={"a": 1}, fragment="physical", color=(1, 0, 0), positions={"j": 1}, link="a",
                 type="move", tilt_deg=3, kind="note", values={}, goal="g", question="q", answer="a", objects=[])
    calls = 0
    for thing in (session, scene, frame, camera, scene.add_viewport(SIZE, camera), scene.add_box((1, 1, 1)),
                  scene.telemetry, scene.telemetry.add("value"), scene.telemetry.add("words", kind="text"),
                  scene.fragments["physical"], scene.lights["sun"], scene.add_trail(), robot,
                  scene.add_text("a", 1), scene.add_tilt_marker(1), robot.joints["j"],
                  scene.add_terrain(field), scene.vantages["main"]):
        for name, use in uses(thing, given):
            calls += 1
            try:
                use()
            except dspace.Error as error:
                assert len(str(error)) < 3000 and str(error), (thing, name)
            except Exception as error:
                pytest.fail(f"{type(thing).__name__}.{name}: {error!r}")
    assert calls > 5000
