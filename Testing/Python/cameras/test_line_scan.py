"""Pictures of push-broom cameras against the exact rays of their pixels and the projections of their models."""
import numpy as np
import pytest

import dspace

LINES = np.array([0.0, 20.0, 40.0, 59.0])


def turn(angle):  # about Z
    return [np.cos(angle / 2), 0.0, 0.0, np.sin(angle / 2)]


def scanner(lines=LINES, height=60):
    """A row of 64 pixels that looks along Z, moves along Y by 0.1 m a line, and turns about Z by 0.2 degrees a line."""
    positions = np.column_stack([0.02 * lines, 0.1 * lines - 3.0, 0.0 * lines])
    rotations = [turn(np.radians(0.2 * line)) for line in lines]
    return dspace.CameraModel("line_scan", size=(64, height), focal_length=1.0, matrix=(60, 0, 0, 60), center=(31.5, 4.0),
                              radial=(0.0, 0.01, 0.0), row=2.0, line=lines, positions=positions.ravel(),
                              rotations=np.ravel(rotations))


@pytest.fixture
def things(scene):
    scene.sun.set(direction=(0.2, 0.1, -1))
    body = scene.add_frame("body", position=(10, 20, 30), quaternion=turn(0.7))
    wall = scene.add_plane(100, 100, frame=body, position=(0, 0, 6.0))
    balls = [scene.add_sphere(0.4, frame=body, position=place) for place in ((0.0, 0.0, 5.0), (-0.8, 0.8, 4.8), (0.9, -1.0, 5.5))]
    return body, wall, balls


def test_ranges_are_those_of_exact_rays(scene, things):
    body, wall, balls = things
    model = scanner()
    planes = scene.simulate_lines(model, body, color=False, range=True, label=True, samples=4)
    assert set(planes) == {"range", "label"} and planes["range"].shape == (60, 64)
    origins, directions = model.rays(np.stack(np.meshgrid(np.arange(64.0), np.arange(60.0)), axis=-1))
    expected = (6.0 - origins[..., 2]) / directions[..., 2]
    on_wall = planes["label"] == wall.id
    assert on_wall.mean() > 0.7
    # A source pixel is at most one of the picture: half of its angle aside on the slanted rays of a wall.
    np.testing.assert_allclose(planes["range"][on_wall], expected[on_wall], atol=0.06)
    assert np.abs(planes["range"][on_wall] - expected[on_wall]).mean() < 0.015
    # Which ball a pixel shows: where its ray comes within the radius, but for the borders.
    for ball, center in zip(balls, ((0.0, 0.0, 5.0), (-0.8, 0.8, 4.8), (0.9, -1.0, 5.5))):
        away = np.linalg.norm(np.cross(np.subtract(center, origins), directions), axis=-1)
        seen = planes["label"] == ball.id
        assert seen[away < 0.34].all() and not seen[away > 0.46].any() and (away < 0.34).sum() > 20


def test_balls_are_where_the_model_projects_them(scene, things):
    body, _, balls = things
    model = scanner()
    label = scene.simulate_lines(model, body, color=False, label=True)["label"]
    rows, columns = np.indices(label.shape)
    for ball, center in zip(balls, ((0.0, 0.0, 5.0), (-0.8, 0.8, 4.8), (0.9, -1.0, 5.5))):
        seen = label == ball.id
        middle = np.array((columns[seen].mean(), rows[seen].mean()))
        np.testing.assert_allclose(middle, model.project([center])[0], atol=0.6)  # an ellipse's middle is not its centre's place


def test_the_scene_moves_from_line_to_line(scene, things):
    body, wall, _ = things
    model = scanner()
    lines = []

    def at(line):
        lines.append(line)
        wall.visible = line < 30

    label = scene.simulate_lines(model, body, at, color=False, label=True)["label"]
    assert lines == list(range(60))
    assert (label[:30] == wall.id).any(axis=1).all() and not (label[30:] == wall.id).any()


def test_lines_without_poses_are_empty(scene, things):
    body, wall, _ = things
    planes = scene.simulate_lines(scanner(LINES[1:3]), body, radiance=True, depth=True, normal=True, label=True)
    some = np.zeros(60, bool)
    some[20:41] = True
    assert (planes["label"][some] > 0).all() and not planes["label"][~some].any()
    assert np.isinf(planes["depth"][~some]).all() and np.isfinite(planes["depth"][some]).all()
    assert np.isnan(planes["normal"][~some]).all() and not planes["radiance"][~some].any() and not planes["color"][~some].any()


def test_bad_scans(scene, things, refused):
    body = things[0]
    pinhole = dspace.CameraModel("pinhole", size=(8, 8), focal=(8, 8), center=(4, 4))
    for model in (pinhole, None, "x"):
        with refused(dspace.WrongType, "the model"):
            scene.simulate_lines(model, body)
    with refused(dspace.InvalidArgument, "the frame"):
        scene.simulate_lines(scanner(), None)
    with refused(dspace.WrongType, "at is"):
        scene.simulate_lines(scanner(), body, 5)
    with refused(dspace.WrongType, "depth is"):
        scene.simulate_lines(scanner(), body, depth=1)
