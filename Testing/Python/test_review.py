"""What a user's session may run into: no lights, letters beyond ASCII, things of a closed session."""
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
    assert view.image()[seen].any()  # what the sky leaves
    scene.lights["sky"].enabled = False
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
