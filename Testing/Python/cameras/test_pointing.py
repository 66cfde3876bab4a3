"""Cameras that keep pointing at a frame: in a local session, in a served one and in a recording, against closed forms."""
import math

import numpy as np
import pytest

import dspace
from dspace.frames.poses import quaternion_of_axis
from test_camera_pose import anywhere, axes, check, turn  # noqa: F401 (a fixture)


def test_it_points_wherever_both_frames_go(anywhere):
    scene = anywhere
    rover = scene.add_frame("rover", position=(5, 2, 1), quaternion=quaternion_of_axis("z", 90))
    lander = scene.add_frame("lander", position=(25, 12, 3))
    camera = scene.add_camera("eye", frame=rover, point_at=dict(aim=lander, eye=(0, 0, 2), target=(0, 0, 1)))
    assert camera.pose is None and camera.frame == rover
    check(camera.pose_in(), (5, 2, 3), axes((20, 10, 1)))
    lander.position = (-5, 2, 2)
    check(camera.pose_in(), (5, 2, 3), axes((-10, 0, 0)))
    rover.position = (5, -8, 1)
    check(camera.pose_in(), (5, -8, 3), axes((-10, 10, 0)))
    rover.quaternion = quaternion_of_axis("y", 40)  # `up` turns with the frame that it stands on
    up = turn("y", 40) @ (0, 0, 1)
    eye = np.array((5, -8, 1)) + 2 * up
    check(camera.pose_in(), eye, axes(np.array((-5, 2, 3)) - eye, up))
    info = camera._info().mount.pointing
    assert info.aim == lander.id and info.target.z == 1


def test_its_lag_has_a_time_constant(anywhere):
    scene = anywhere
    target = scene.add_frame("target", position=(10, 0, 0))
    scene.time = 0.0
    camera = scene.add_camera("eye")
    camera.point_at(target, eye=(0, 0, 0), up=(0, 0, 1), smoothing_s=2.0)
    check(camera.pose_in(), (0, 0, 0), axes((1, 0, 0)))
    target.position = (0, 10, 0)  # a quarter turn away
    for time in (0.5, 1.0, 3.0):
        scene.time = time
        left = 90 * math.exp(-time / 2.0)
        check(camera.pose_in(), (0, 0, 0), axes((math.sin(math.radians(left)), math.cos(math.radians(left)), 0)))
    scene.time = 0.0  # a step back restarts it
    check(camera.pose_in(), (0, 0, 0), axes((0, 1, 0)))


def test_what_cannot_be_is_rejected(anywhere):
    scene = anywhere
    post, target = scene.add_frame("post"), scene.add_frame("target", position=(3, 0, 0))
    camera = scene.add_camera("eye", point_at=dict(aim=target, eye=(0, 0, 1)))
    before = camera.pose_in()
    for call, kind, text in (
            (lambda: camera.point_at("nowhere"), dspace.NotFound, "nowhere"),
            (lambda: camera.point_at(target, smoothing_s=-1), dspace.InvalidArgument, "smoothing is -1"),
            (lambda: camera.point_at(target, up=(0, 0, 0)), dspace.InvalidArgument, "up is"),
            (lambda: camera.point_at(target, eye=(math.nan, 0, 0)), dspace.InvalidArgument, "eye"),
            (lambda: camera.point_at(target, frame=target), dspace.InvalidArgument, "points at its own eye"),
            (lambda: scene.add_camera("eye", point_at={}), dspace.WrongType, "with aim"),
            (lambda: scene.add_camera("eye", eye=(1, 1, 1), target=(0, 0, 0), point_at=dict(aim=target)),
             dspace.InvalidArgument, "one of eye, pose, chase and point_at"),
            (lambda: target.remove(), dspace.InvalidArgument, "points at frame"),
    ):
        with pytest.raises(kind, match=text):
            call()
    after = camera.pose_in()
    np.testing.assert_array_equal(np.append(after.position, after.quaternion), np.append(before.position, before.quaternion))
    camera.attach(post)
    target.remove()


def test_where_the_target_is_at_the_eye_or_overhead(anywhere):
    scene = anywhere
    target = scene.add_frame("target")
    camera = scene.add_camera("eye", point_at=dict(aim=target))
    check(camera.pose_in(), (0, 0, 0), axes((1, 0, 0)))  # along X: there is no direction
    target.position = (0, 0, 5)  # along `up`: X takes its place
    check(camera.pose_in(), (0, 0, 0), axes((0, 0, 1), (1, 0, 0)))


def test_its_lag_is_recorded(session, tmp_path):
    scene = session.scene()
    target = scene.add_frame("target", position=(10, 0, 0))
    camera = scene.add_camera("eye", point_at=dict(aim=target, smoothing_s=2.0))
    scene.time = 1.0
    target.position = (0, 10, 0)
    scene.time = 2.0
    with session.record(tmp_path / "run.dspace"):  # begins in the middle of the turn
        scene.time = 3.0
        expected = camera.pose_in()
    with dspace.Playback(tmp_path / "run.dspace") as playback:
        playback.seek(3.0)
        found = playback.session.scene().cameras["eye"].pose_in()
    check(found, expected.position, expected.rotation)
    left = 90 * math.exp(-3.0 / 2.0)  # a step ends with the poses of its end, as for chase cameras
    check(found, (0, 0, 0), axes((math.sin(math.radians(left)), math.cos(math.radians(left)), 0)))
