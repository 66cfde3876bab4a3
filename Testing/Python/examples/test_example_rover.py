"""The reference simulation: its wheels stand on the ground and roll on it, and its scene is made of its model."""
import pathlib
import subprocess
import sys

import numpy as np
import pytest

import dspace

EXAMPLE = pathlib.Path(__file__).resolve().parents[3] / "Examples" / "rover_mobility"
sys.path.insert(0, str(EXAMPLE))

from mobility import Hills, Mobility, Plane, attitude, attitude_quaternion  # noqa: E402  (of the example)
from model import RoverModel  # noqa: E402
from rover_mobility import STEP, Simulation, command  # noqa: E402

RADIUS = RoverModel.wheel_radius


@pytest.fixture
def ahead(session, tmp_path):
    """A simulation a second after its start, rolling at 0.4 m/s, and what was noted on the way."""
    simulation = Simulation(session, folder=tmp_path)
    mobility, wheels = simulation.mobility, simulation.frames[simulation.model.wheels]
    poses, contacts = [simulation.scene.poses(wheels, relative_to=simulation.scene.root)], [mobility.contacts]
    for _ in range(1000):
        simulation.step()
        poses.append(simulation.scene.poses(wheels, relative_to=simulation.scene.root))
        contacts.append(mobility.contacts)
    return simulation, np.array(poses), np.array(contacts)


def turned(q):
    """Rotation matrices (..., 3, 3) of quaternions."""
    w, x, y, z = np.moveaxis(q, -1, 0)
    rows = [[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]]
    return np.stack([np.stack(row, -1) for row in rows], -2)


def test_a_second_on_hills(ahead):
    """A thousand steps: what the scene's own frames say, against the ground's formula."""
    simulation, poses, contacts = ahead
    ground, terrain = Hills(), simulation.terrain
    assert simulation.mobility.time == pytest.approx(1.0, abs=1e-12) and simulation.scene.time == pytest.approx(1.0)
    # Contacts lie on the ground to a hundredth of a micrometre, at each step.
    assert np.abs(contacts[..., 2] - ground.heights(contacts[..., 0], contacts[..., 1])).max() < 1e-8
    # So do the wheels that are drawn: of 1,440 points of a rim the lowest above the ground touches it.
    angle = np.radians(np.arange(0, 360, 0.25))
    rim = RADIUS * np.column_stack((np.sin(angle), 0 * angle, -np.cos(angle)))
    for step in range(0, 1001, 100):
        for position, R in zip(poses[step, :, :3], turned(poses[step, :, 3:7])):
            points = position + rim @ R.T
            least = (points[:, 2] - ground.heights(points[:, 0], points[:, 1])).min()
            assert -1e-8 < least < 2e-6  # 0.125 degrees beside it: r (1 - cos)
    # The ground that is drawn is straight between posts 0.1 m apart: within h^2 / 8 of its curvature.
    last = contacts[-1]
    assert np.abs(terrain.undisturbed.height(last[:, 0], last[:, 1]) - last[:, 2]).max() < 1e-3
    # The wheels leave tracks: six as long as the way, with a rim beside.
    assert terrain.tracks["length"] == pytest.approx(simulation.mobility.rolled.sum(), rel=0.01)
    middle = contacts[500, 0]
    across = np.linspace(-0.15, 0.15, 61)
    heading = contacts[550, 0] - contacts[450, 0]
    beside = middle[:2] + across[:, None] * np.array((-heading[1], heading[0])) / np.hypot(*heading[:2])
    change = terrain.height(*beside.T) - terrain.undisturbed.height(*beside.T)
    assert change.max() > 0.004 and np.abs(change[np.abs(across) > 0.14]).max() < 1e-3
    assert np.ptp(last[:, 2]) > 0.05  # hills they are


def test_wheels_roll_without_slipping(ahead):
    """The rim's material at a contact does not move along the wheel; turning is distance over radius."""
    simulation, poses, contacts = ahead
    R = turned(poses[..., 3:7])
    centres = poses[..., :3]
    at_rest = np.einsum("swji,swj->swi", R[:-1], contacts[:-1] - centres[:-1])  # in the wheel's axes
    moved = centres[1:] + np.einsum("swij,swj->swi", R[1:], at_rest) - contacts[:-1]
    axle = R[:-1, :, :, 1]
    forward = np.cross(axle, centres[:-1] - contacts[:-1])
    forward /= np.linalg.norm(forward, axis=-1)[..., None]
    way = np.einsum("swi,swi->sw", centres[1:] - centres[:-1], forward)
    slip = np.einsum("swi,swi->sw", moved, forward)
    assert np.abs(slip).max() < 1e-3 * way.max()
    assert np.abs(slip.sum(0)).max() < 1e-4 * way.sum(0).min()
    # The scene's frames alone: length of the middles' way, over the radius.
    length = np.linalg.norm(np.diff(centres, axis=0), axis=-1).sum(0)
    np.testing.assert_allclose(simulation.mobility.turned, length / RADIUS, rtol=2e-3)  # it slips sideways a little
    assert (length > 0.15).all()


def test_on_a_plane_the_closed_forms_hold():
    """Straight on, level and uphill; and a circle, whose wheels go about one centre at radii of their own."""
    level = Mobility(RoverModel(), Plane(), heading=0.3)
    for _ in range(500):
        level.step(STEP, 0.4, 0.0)
    np.testing.assert_allclose(level.turned, 0.2 / RADIUS, rtol=1e-12)
    np.testing.assert_allclose(level.angles[level.wheels], 0.2 / RADIUS, rtol=1e-9)
    uphill = Mobility(RoverModel(), Plane(gx=0.2))
    for _ in range(500):
        uphill.step(STEP, 0.4, 0.0)
    np.testing.assert_allclose(uphill.turned, 0.2 * np.hypot(1, 0.2) / RADIUS, rtol=1e-9)
    np.testing.assert_allclose(uphill.contacts[:, 2], 0.2 * uphill.contacts[:, 0], atol=1e-9)
    circle = Mobility(RoverModel(), Plane())
    for _ in range(1000):
        circle.step(STEP, 0.4, 0.5)
    model = RoverModel()
    x = np.array([0.5, 0, -0.5] * 2) * model.wheelbase  # front, middle, rear; left, then right
    y = np.repeat((0.5, -0.5), 3) * model.track
    np.testing.assert_allclose(circle.turned, 0.4 * 0.5 * np.hypot(x, 2 - y) / RADIUS, rtol=1e-4)  # its first step steers
    np.testing.assert_allclose(circle.origins[0][:2], 2 * np.array((np.sin(0.2), 1 - np.cos(0.2))), atol=1e-12)


def test_bodies_hang_together(ahead):
    simulation, _, _ = ahead
    frames, mobility = simulation.scene.frames, simulation.mobility
    for number, body in enumerate(simulation.model.bodies):
        path = body.name
        parent = body
        while parent.parent:
            parent = simulation.model.bodies[simulation.model.number(parent.parent)]
            path = f"{parent.name}/{path}"
        world = frames[path].world_pose
        np.testing.assert_allclose(world.position, mobility.origins[number], atol=1e-12)
        if body.joint != "wheel":  # whose turning the kinematics leave out
            np.testing.assert_allclose(world.rotation, mobility.rotations[number], atol=1e-12)
    rockers = [mobility.angles[simulation.model.number(f"rocker_{side}")] for side in ("left", "right")]
    assert rockers[0] == -rockers[1] != 0  # the differential
    q = attitude_quaternion(0.7, -0.2, 0.3)
    np.testing.assert_allclose(turned(q), attitude(0.7, np.array([-0.2]), np.array([0.3]))[0], atol=1e-15)


def test_a_step_is_one_message_of_poses(session, tmp_path):
    simulation = Simulation(session, folder=tmp_path)
    sent, execute = [], session._client.execute
    session._client.execute = lambda command: (sent.append(command), execute(command))[1]
    try:
        simulation.step()
    finally:
        session._client.execute = execute
    with pytest.raises(ValueError, match="forward only"):
        simulation.advance(0.0)
    assert [command.WhichOneof("command") for command in sent] == ["set_time", "set_poses"]
    assert len(sent[1].set_poses.frame) == len(simulation.model.bodies)
    assert len(sent[1].set_poses.pose) == 8 * len(simulation.model.bodies)


@pytest.mark.parametrize("wheelbase", (1.1, 1.6))
def test_another_wheelbase_is_another_tree_and_picture(session, tmp_path, wheelbase):
    """Nothing but the model is told; on level ground, seen from the side, a pixel is a centimetre."""
    simulation = Simulation(session, RoverModel(wheelbase=wheelbase), Plane(), tmp_path)
    scene = simulation.scene
    front, middle, rear = (scene.frame(path).pose_in("rover").position for path in (
        "rover/rocker_left/steering_front_left/wheel_front_left", "rover/rocker_left/bogie_left/wheel_middle_left",
        "rover/rocker_left/bogie_left/steering_rear_left/wheel_rear_left"))
    assert front[0] - rear[0] == pytest.approx(wheelbase, abs=1e-12)
    assert middle[0] == pytest.approx(0.5 * (front[0] + rear[0]), abs=1e-12)
    assert front[2] == pytest.approx(rear[2], abs=1e-12)
    scene.add_camera("side", eye=(0, -9, 0.3), target=(0, 0, 0.3), height=1.2)
    view = scene.add_viewport((320, 120), "side", samples=1)
    simulation.terrain.object.visible = False
    labels = view.labels()
    columns = {}
    for name in ("front", "rear"):
        wheel = scene.object(f"wheel_{name}_right 0").id
        rows, found = np.nonzero(labels == wheel)
        columns[name] = 0.5 * (found.min() + found.max())
        assert np.ptp(found) == pytest.approx(2 * RADIUS * 100, abs=1.5)
        assert rows.max() == pytest.approx(59.5 + 30, abs=1.5)  # on the ground, 0.3 m below the middle
    assert columns["front"] - columns["rear"] == pytest.approx(100 * wheelbase, abs=1.5)


def test_sizes_that_are_none_are_refused():
    with pytest.raises(ValueError, match="wheelbase is -1.*accepted: 0.01 to 10 m"):
        RoverModel(wheelbase=-1)
    steep = Plane(gx=0.1)
    steep.heights = lambda x, y: np.where(x > 0.3, 9.0, 0.0)  # a wall
    with pytest.raises(ValueError, match="does not stand with all wheels"):
        Mobility(RoverModel(), steep)
    assert command(0) == (0, 0) and command(5)[0] == 0.4


def test_the_script_runs_by_itself(tmp_path):
    done = subprocess.run([sys.executable, EXAMPLE / "rover_mobility.py", "--seconds", "0.2", "--wheelbase", "1.3",
                           "--out", tmp_path / "rover.png"], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert "200 steps of 1 ms" in done.stdout and (tmp_path / "rover.png").stat().st_size > 10000


def test_in_its_own_process_over_the_wire(tmp_path):
    """The server's frames are those of a run in this process, its picture that of a local one, to the byte."""
    from served_support import Served
    words = [sys.executable, "-W", "ignore", EXAMPLE / "rover_mobility.py", "--seconds", "0.3", "--folder", tmp_path]
    with Served(tmp_path, "--allow-root", str(tmp_path)) as server:
        done = subprocess.run([*words, "--connect", server.address, "--out", tmp_path / "served.png"],
                              capture_output=True, text=True)
        assert done.returncode == 0 and "300 steps of 1 ms" in done.stdout, done.stderr
        with dspace.connect(server.address) as session:
            scene = session.scene()
            poses = scene.poses(list(scene.frames["rover"].children) + [scene["rover"]])
            names = [frame.name for frame in scene["rover"].children] + ["rover"]
            assert scene.time == pytest.approx(0.3, abs=1e-12)
    alone = Mobility(RoverModel(), Hills())
    for _ in range(300):
        alone.step(STEP, *command(alone.time))
    numbers = [alone.model.number(name) for name in names]
    np.testing.assert_array_equal(poses[:, :3], alone.rows()[numbers][:, :3])
    np.testing.assert_allclose(poses[:, 3:7], alone.rows()[numbers][:, 3:], rtol=0, atol=1e-15)  # normalized
    done = subprocess.run([*words, "--out", tmp_path / "local.png"], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "served.png").read_bytes() == (tmp_path / "local.png").read_bytes()


def test_its_recording_is_the_run(tmp_path):
    done = subprocess.run([sys.executable, "-W", "ignore", EXAMPLE / "rover_mobility.py", "--seconds", "0.3", "--record",
                           tmp_path / "run.dspace"], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    alone = Mobility(RoverModel(), Hills())
    with dspace.Playback(tmp_path / "run.dspace") as run:
        assert run.duration == pytest.approx(0.3, abs=1e-12)
        for at in (0.1, 0.3):
            while alone.time < at - STEP / 2:
                alone.step(STEP, *command(alone.time))
            run.seek(at + STEP / 2)
            np.testing.assert_array_equal(run.session.scene()["rover"].position, alone.origins[0])


def test_its_movie(tmp_path):
    movie = dspace.Movie.load(EXAMPLE / "flight.toml", size=(64, 36), rate=4, samples=1, duration=0.5)
    assert movie.make(f"{EXAMPLE / 'rover_mobility.py'}:run", tmp_path / "pictures") == 2
    one, two = ((tmp_path / "pictures" / f"frame_00000{n}.png").read_bytes() for n in (0, 1))
    assert one != two and len(one) > 1000
