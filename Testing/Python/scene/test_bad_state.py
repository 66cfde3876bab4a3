"""States that nothing may come into: poses, lights, joints, terrain, time, and callbacks without end."""
import numpy as np
import pytest

import dspace

SIZE = (64, 48)
NAN = float("nan")
ARM = """<robot name="arm"><link name="base"/><link name="wheel"/>
<joint name="axle" type="continuous"><parent link="base"/><child link="wheel"/>
<axis xyz="0 0 1"/></joint></robot>"""


@pytest.fixture
def arm(scene, tmp_path):
    path = tmp_path / "arm.urdf"
    path.write_text(ARM)
    return scene.load(path)


# --- Poses -------------------------------------------------------------------------------------


def test_poses_are_checked_when_they_are_made():
    for text, values in (("the position is (nan, 0, 0); accepted: 3 finite numbers", dict(position=(NAN, 0, 0))),
                         ("the position is 'here'", dict(position="here")),
                         ("the quaternion is (2, 0, 0, 0); accepted: w, x, y, z of length 1 within 1e-6; "
                          "its length is 2", dict(quaternion=(2, 0, 0, 0))),
                         ("the quaternion is (nan, 0, 0, 0)", dict(quaternion=(NAN, 0, 0, 0))),
                         ("the quaternion is (1, 0, 0)", dict(quaternion=(1, 0, 0))),
                         ("the scale is -1.0; accepted: from 1e-12 to 1e12", dict(scale=-1)),
                         ("the scale is 'big'", dict(scale="big"))):
        with pytest.raises(dspace.InvalidArgument) as caught:
            dspace.Pose(**values)
        assert text in str(caught.value)
    assert dspace.Pose(quaternion=(1 + 9e-7, 0, 0, 0))
    for bad in (lambda: dspace.Pose.from_axis_deg((NAN, 0, 0), 3), lambda: dspace.Pose.from_axis_deg("z", NAN),
                lambda: dspace.Pose.from_row([1, 2, 3]), lambda: dspace.Pose.from_rpy_deg(0, NAN, 0)):
        with pytest.raises(dspace.InvalidArgument):
            bad()


def test_what_is_computed_from_poses_may_leave_the_range_of_what_is_set(scene):
    small = dspace.Pose(position=(1e18, 0, 0), scale=1e-12)
    assert small.inverse().position[0] == pytest.approx(-1e30)
    assert (small @ small).scale == pytest.approx(1e-24)
    frame = scene.add_frame("far", position=(1e18, 0, 0)).add_frame("farther", position=(1e18, 0, 0))
    assert frame.world_pose.position[0] == 2e18


def test_matrices_are_shown_as_they_were_given():
    sheared = np.diag([2.0, 2.0, 3.0, 1.0])
    for bad in (sheared, np.diag([1.0, 1, -1, 1]), np.diag([1.0, 1, 1, 2]), np.full((4, 4), NAN)):
        with pytest.raises(dspace.InvalidArgument) as caught:
            dspace.Pose.from_matrix(bad)
        assert str(bad) in str(caught.value)
    X = dspace.Pose.from_axis_deg("x", 30, (1, 2, 3), 2.5)
    np.testing.assert_allclose(dspace.Pose.from_matrix(X.matrix).row, X.row, atol=1e-12)


def test_poses_of_frames(scene, refused):
    frame = scene.add_frame("f")
    frame.pose = [1, 2, 3, 1, 0, 0, 0]
    assert frame.position.tolist() == [1, 2, 3] and frame.scale == 1
    for text, use in (
            ("frame 'f': the pose is [1, 2, 3]; accepted: a dspace.Pose, a 4 x 4 matrix, or 8 numbers",
             lambda: setattr(frame, "pose", [1, 2, 3])),
            ("frame 'f': rpy_deg is (1, 2); accepted: 3 numbers", lambda: setattr(frame, "rpy_deg", (1, 2))),
            ("frame 'f': the axis is 'k'", lambda: frame.rotate("k", 3)),
            ("frame 'new': the quaternion is (1, 0, 0)", lambda: scene.add_frame("new", quaternion=(1, 0, 0))),
            ("in scene 'scene': the poses have shape (2, 3)", lambda: scene.set_poses([frame], np.zeros((2, 3)))),
            ("scene 'scene': frames is 'f'", lambda: scene.set_poses("f", np.zeros((1, 8)))),
            ("frame 'f': it is given twice, in rows 0 and 1; accepted: each frame once",
             lambda: scene.set_poses([frame, "f"], [[0, 0, 0, 1, 0, 0, 0]] * 2))):
        with refused(dspace.InvalidArgument, text):
            use()
    with pytest.raises(dspace.InvalidArgument) as caught:
        frame.position = (NAN, 0, 0)
    assert str(caught.value) == ("frame 'f': the position is (nan, 0, 0); accepted: 3 finite numbers within "
                                 "1e18 m")


def test_names_of_frames(scene, refused):
    for name in ("", ".", "..", "a/b", "n" * 256, "\u00e9" * 128, "x" * 10**6):
        with refused(dspace.InvalidArgument, "1 to 255 bytes of UTF-8, be neither '.' nor '..'"):
            scene.add_frame(name)
    try:
        scene.add_frame("x" * 10**6)
    except dspace.Error as error:
        assert len(str(error)) < 1000 and len(error.object) < 1000
    assert scene.add_frame("\u00e9" * 127).name == "\u00e9" * 127


# --- Lights, joints, terrain, time -------------------------------------------------------------


def test_a_light_is_not_overwritten(scene, refused):
    with refused(dspace.AlreadyExists, "scene.lights['sun'].set(...) to change it"):
        scene.add_light("sun", intensity=3)
    scene.lights["sun"].set(intensity=3)
    assert scene.lights["sun"].intensity == 3
    scene.lights["sun"].remove()
    assert scene.add_light("sun", intensity=2).intensity == 2


def test_joints_without_limits_have_some(scene, arm, refused):
    arm.joints["axle"].position = 1e12
    for bad in (1e20, -1.1e12):
        with refused(dspace.InvalidArgument, "joint 'axle' of robot 'arm': the position is"):
            arm.joints["axle"].position = bad
    with refused(dspace.InvalidArgument, "joint 'axle' of robot 'arm': the position is 'up'"):
        arm.joints["axle"].position = "up"
    with refused(dspace.WrongType, "robot 'arm': positions is 5"):
        arm.set_joints(5)


def test_terrain_is_named(scene, field, refused):
    ground = scene.add_terrain(field, name="ground")
    for text, use in (
            ("terrain 'ground': point 0 is (nan, 0); accepted: finite numbers", lambda: ground.height(NAN, 0)),
            ("terrain 'ground': point 1 is (inf, 3)", lambda: ground.normal([1, np.inf], 3)),
            ("terrain 'ground': point 0 is (nan, 2)", lambda: ground.focus([(NAN, 2)])),
            ("terrain 'ground': the radius is -1", lambda: ground.focus([(1, 2)], radius=-1)),
            ("terrain 'ground': the radius is nan", lambda: ground.focus([(1, 2)], radius=NAN)),
            ("terrain 'ground': radius is 'far'", lambda: ground.focus([(1, 2)], radius="far")),
            ("terrain 'ground': the points have shape (1, 3); accepted: (n, 2)",
             lambda: ground.focus([(1, 2, 3)])),
            ("terrain 'ground': the points have shape (2,); accepted: (..., 3)", lambda: ground.to_map((1, 2))),
            ("terrain 'ground': the points is 'here'", lambda: ground.to_map("here")),
            ("terrain 'ground': point 0 is (1, nan, 3)", lambda: ground.from_map((1, NAN, 3))),
            ("terrain 'ground': x and y have the shapes (2,) and (3,)",
             lambda: ground.height([1, 2], [1, 2, 3])),
            ("relief: unknown keyword 'sun'; accepted: ", lambda: scene.add_terrain(field, relief={"sun": 3})),
            ("triangle_budget is -1; accepted: an integer from 1 on",
             lambda: scene.add_terrain(field, triangles=-1)),
            ("the origin is (1,); accepted: map x, y[, height]", lambda: scene.add_terrain(field, origin=(1,)))):
        with refused(dspace.InvalidArgument, text):
            use()


def test_time_may_go_back(scene):
    """A chase camera is in place at once then, as a playback that jumps needs it."""
    frame = scene.add_frame("f")
    scene.add_camera("chase", frame=frame, chase=dict(offset=(0, 0, 10), up=(0, 1, 0), smoothing_s=5))
    view = scene.add_viewport(SIZE, scene.cameras["chase"])
    ball = scene.add_sphere(1, frame=frame)
    trail = scene.add_trail()
    trail.append([(0, 0, 0), (1, 0, 0)])

    def distance():
        assert (view.labels() == ball.id).any()
        return view.depth().min()

    assert distance() == pytest.approx(9, abs=0.05)
    for scene.time in (100, 100.1):
        pass
    frame.position = (0, 0, -5)
    assert distance() > 13  # the camera lags
    scene.time = 50
    assert distance() == pytest.approx(9, abs=0.05) and scene.time == 50
    assert np.ptp(trail.box, axis=0)[0] == pytest.approx(1)


# --- Callbacks ---------------------------------------------------------------------------------


def test_a_callback_that_moves_its_own_frame_is_stopped(scene):
    frame = scene.add_frame("f")
    calls, others = [], []

    def restless(event):
        calls.append(event)
        frame.position = (len(calls), 0, 0)

    scene.on_frame_change(restless)
    scene.on_frame_change(others.append)
    with pytest.raises(dspace.Resource, match="restless.*round 101.*accepted: up to 100 rounds"):
        frame.position = (-1, 0, 0)
    assert len(calls) == 101 and len(others) == 102  # who causes nothing hears everything
    assert frame.position[0] == 101
    with pytest.raises(dspace.Resource):  # and is heard again by the next change
        frame.position = (-1, 0, 0)
    assert len(calls) == 202


def test_callbacks_that_double_their_events_are_stopped(scene, monkeypatch):
    monkeypatch.setattr("dspace.clients.listeners.MAXIMUM_CAUSED", 500)
    frame = scene.add_frame("f")
    calls = []

    def move(event):
        calls.append(event)
        frame.position = (len(calls), 0, 0)

    scene.on_frame_change(move)
    scene.on_frame_change(lambda event: move(event))
    with pytest.raises(dspace.Resource, match="500 changes"):
        frame.position = (-1, 0, 0)
    assert 500 < len(calls) < 2000


def test_a_state_of_another_vehicle_moves_nothing(arm):
    """A robot's place() is its base and its joints, or neither."""
    class State:
        position, quaternion, joints = (5.0, 0.0, 0.0), (1.0, 0.0, 0.0, 0.0), {"no such joint": 1.0}
    before = arm.pose
    with pytest.raises(dspace.NotFound, match="no such joint"):
        arm.place(State())
    assert arm.pose == before
