"""Where cameras are: Camera.pose_in(), in a local session and in a served one, against closed forms."""
import math

import numpy as np
import pytest

import dspace
from dspace.frames.poses import quaternion_of_axis


@pytest.fixture
def anywhere(anywhere):
    """A scene in a session of this process, then in a server."""
    return anywhere.scene()


def turn(axis, angle_deg):
    """A rotation matrix, from its definition."""
    c, s = math.cos(math.radians(angle_deg)), math.sin(math.radians(angle_deg))
    return np.array({"z": [[c, -s, 0], [s, c, 0], [0, 0, 1]], "y": [[c, 0, s], [0, 1, 0], [-s, 0, c]]}[axis])


def check(pose, position, rotation):
    np.testing.assert_allclose(pose.position, position, atol=1e-12)
    np.testing.assert_allclose(pose.rotation, rotation, atol=1e-12)
    assert pose.scale == 1.0


def axes(forward, up=(0.0, 0.0, 1.0)):
    """The axes of a camera that looks along `forward`, as columns: right, down, forward."""
    forward = np.array(forward) / np.linalg.norm(forward)
    right = np.cross(forward, up)
    right /= np.linalg.norm(right)
    return np.column_stack((right, np.cross(forward, right), forward))


def test_looking_straight_down_needs_no_up(anywhere):
    scene = anywhere
    camera = scene.add_camera("down", eye=(1, 2, 9), target=(1, 2, 0))
    check(camera.pose_in(), (1, 2, 9), axes((0, 0, -1), (0, 1, 0)))
    camera.look_at((0, 0, 0), (0, 0, 5))
    check(camera.pose_in(), (0, 0, 0), axes((0, 0, 1), (0, 1, 0)))
    camera.look_at((0, 0, 9), (0.1, 0, 0))
    check(camera.pose_in(), (0, 0, 9), axes((0.1, 0, -9)))
    frame = scene.add_frame("flyer", position=(0, 0, 2))
    camera.chase(frame, offset=(0, 0, 5))
    check(camera.pose_in(), (0, 0, 7), axes((0, 0, -1), (0, 1, 0)))
    with pytest.raises(dspace.InvalidArgument, match="up .* is along the line of sight"):
        camera.look_at((0, 0, 9), (0, 0, 0), up=(0, 0, 1))


def test_a_chase_camera_keeps_the_local_vertical(anywhere):
    """Over a body's equator at longitude 90, heading north: up is Y."""
    scene = anywhere
    moon = scene.add_frame("moon", position=(5e8, 0, 0))
    rover = moon.add_frame("rover", position=(0, 1737400, 0),
                            quaternion=(0.5, -0.5, -0.5, -0.5))  # X north, Y west, Z up
    camera = scene.add_camera("chase", frame=rover, chase={"offset": (-5, 0, 2), "target": (0, 0, 2), "vertical": moon})
    check(camera.pose_in(moon), (0, 1737402, -5), axes((0, 0, 1), (0, 1, 0)))
    camera.chase(rover, offset=(-5, 0, 2), target=(0, 0, 2), vertical="moon")
    check(camera.pose_in(moon), (0, 1737402, -5), axes((0, 0, 1), (0, 1, 0)))
    with pytest.raises(dspace.Error, match="vertical"):
        moon.remove()
    with pytest.raises(dspace.InvalidArgument, match="up is .*None where a vertical"):
        camera.chase(rover, up=(0, 1, 0), vertical=moon)
    with pytest.raises(dspace.WrongType, match="a Terrain, or the Frame of a body"):
        camera.chase(rover, vertical=3.0)


def test_a_chase_camera_takes_the_vertical_of_a_terrain(scene):
    leaning = scene.add_frame("leaning", quaternion=quaternion_of_axis("y", 30))
    from terrain_support import FIELD
    ground = scene.add_terrain(FIELD, frame=leaning, mode="clipmap")
    rover = scene.add_frame("rover", position=(1, 2, 3))
    camera = scene.add_camera("chase", frame=rover, chase={"offset": (-5, 0, 2), "target": (0, 0, 2), "vertical": ground})
    z = turn("y", 30) @ (0, 0, 1)
    x = np.array((1, 0, 0)) - z[0] * z
    x /= np.linalg.norm(x)
    check(camera.pose_in(), (1, 2, 3) - 5 * x + 2 * z, axes(x, z))


def test_an_attached_camera_is_where_its_frame_takes_it(anywhere):
    scene = anywhere
    rover = scene.add_frame("rover", position=(5, 2, 1), quaternion=quaternion_of_axis("z", 90))
    mast = rover.add_frame("mast", position=(0, 0, 2), quaternion=quaternion_of_axis("y", 30))
    camera = scene.add_camera("eye", frame=mast, pose=dspace.Pose((1, 0, 0), quaternion_of_axis("z", 20)))
    rotation = turn("z", 90) @ turn("y", 30) @ turn("z", 20)
    position = np.array((5, 2, 1)) + turn("z", 90) @ (np.array((0, 0, 2)) + turn("y", 30) @ (1, 0, 0))
    check(camera.pose_in(), position, rotation)
    check(camera.pose_in(scene.root), position, rotation)
    check(camera.pose_in(rover), np.array((0, 0, 2)) + turn("y", 30) @ (1, 0, 0), turn("y", 30) @ turn("z", 20))
    check(camera.pose_in(mast), (1, 0, 0), turn("z", 20))
    rover.position = (50, 2, 1)
    check(camera.pose_in(), position + (45, 0, 0), rotation)


def test_a_camera_that_looks_at_something_has_the_axes_of_its_line_of_sight(anywhere):
    camera = anywhere.add_camera("eye", eye=(6, -7, 5), target=(0, 0, 1))
    check(camera.pose_in(), (6, -7, 5), axes((-6, 7, -4)))


def test_a_camera_that_chases_is_where_its_offset_and_lag_put_it(anywhere):
    scene = anywhere
    carrier = scene.add_frame("carrier", position=(5, 2, 1), quaternion=quaternion_of_axis("z", 90))
    camera = scene.add_camera("chase", frame=carrier, chase=dict(offset=(-4, 0, 2), target=(0, 0, 0)))
    assert camera.pose is None
    check(camera.pose_in(), (5, -2, 3), axes((0, 4, -2)))  # it heads along Y: 4 m behind is at y = -2
    # With a lag: exp(-dt / smoothing) of the way is left, and the camera looks at the carrier all the same.
    scene.time = 0.0
    camera.chase(carrier, offset=(-4, 0, 2), target=(0, 0, 0), axes="parent", smoothing_s=2.0)
    check(camera.pose_in(), (1, 2, 3), axes((4, 0, -2)))
    carrier.position = (15, 2, 1)
    scene.time = 1.0
    x = 11 - 10 * math.exp(-1.0 / 2.0)
    check(camera.pose_in(), (x, 2, 3), axes((15 - x, 0, -2)))
    check(camera.pose_in(carrier), turn("z", -90) @ (x - 15, 0, 2), turn("z", -90) @ axes((15 - x, 0, -2)))


def test_what_is_not_there_is_rejected(anywhere):
    scene = anywhere
    camera = scene.add_camera("eye", eye=(6, -7, 5), target=(0, 0, 1))
    with pytest.raises(dspace.NotFound, match="nowhere"):
        camera.pose_in("nowhere")
    camera.remove()
    with pytest.raises(dspace.NotFound, match="eye"):
        camera.pose_in()
