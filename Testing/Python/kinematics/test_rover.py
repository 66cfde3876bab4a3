"""Rover kinematics against closed forms, and against a URDF walked by other code."""
import os
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path as File

import numpy as np
import pytest

from needs import needs_module

ROOT = File(__file__).resolve().parents[3]
sys.path.append(str(ROOT / "Wrapping" / "Python"))

from dspace.errors import InvalidArgument, NotFound, WrongType  # noqa: E402
from dspace.kinematics.rotations import packed  # noqa: E402
from dspace.rover import (CarriedModel, GridTerrain, IndependentSuspension, Path,  # noqa: E402
                          RockerBogie, load_vehicle)

URDF = ROOT / "Data" / "rover" / "rover.urdf"
FIELD = ROOT / "Data" / "field" / "field.tif"
REAL = File(os.environ.get("DSPACE_DATA", ROOT.parent / "shared" / "data"))
WHEELS = [f"wheel_{p}_{s}" for s in ("left", "right") for p in ("front", "middle", "rear")]
RADIUS, BASE = 0.20, 0.82  # of the shipped rover: wheel radius, distance between wheels [m]
real_data = pytest.mark.skipif(not (REAL / "models").is_dir(), reason="DSPACE_DATA is not there")


def level(xy):
    return np.zeros(len(xy))


@pytest.fixture(scope="module")
def rover():
    return load_vehicle(URDF)


@pytest.fixture(scope="module")
def field():
    needs_module("osgeo.gdal", "python3-gdal")
    return GridTerrain.from_file(FIELD)


@pytest.fixture(scope="module")
def drive(rover, field):
    path = Path([(-20, -10), (-5, 0), (8, -4), (20, 8)], speed=0.8, ramp=1.0)
    times = np.linspace(0, path.duration, 240)
    return path, times, rover.drive(path, times, field)


def matrix(quaternion):
    w, x, y, z = quaternion
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                     [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                     [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])


def walk(urdf, state):
    """World (R, p) of every link from the state's root pose and joint angles: Rodrigues' formula on
    the URDF's own numbers, sharing no code with the solver."""
    robot = ElementTree.parse(urdf).getroot()
    waiting = robot.findall("joint")
    children = {j.find("child").get("link") for j in waiting}
    root = next(e.get("name") for e in robot.findall("link") if e.get("name") not in children)
    out = {root: (matrix(state.quaternion), np.array(state.position))}
    angles = {**state.joints, **state.mimic_joints}
    while waiting:
        for j in [j for j in waiting if j.find("parent").get("link") in out]:
            waiting.remove(j)
            r, p = out[j.find("parent").get("link")]
            o = j.find("origin")
            xyz = np.array([float(v) for v in o.get("xyz").split()])
            roll, pitch, yaw = (float(v) for v in o.get("rpy", "0 0 0").split())
            (cr, sr), (cp, sp), (cy, sy) = ((np.cos(a), np.sin(a)) for a in (roll, pitch, yaw))
            r0 = np.array([[cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
                           [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
                           [-sp, cp * sr, cp * cr]])
            turn = np.eye(3)
            if j.find("axis") is not None:
                a = np.array([float(v) for v in j.find("axis").get("xyz").split()])
                t = np.radians(angles.get(j.get("name"), 0.0))
                k = np.array([[0, -a[2], a[1]], [a[2], 0, -a[0]], [-a[1], a[0], 0]])
                turn = np.eye(3) + np.sin(t) * k + (1 - np.cos(t)) * k @ k
            out[j.find("child").get("link")] = (r @ r0 @ turn, p + r @ xyz)
    return out


# --- recognition ---------------------------------------------------------------------------------

def test_dimensions_come_from_the_urdf(rover):
    assert isinstance(rover, RockerBogie) and sorted(rover.wheels) == sorted(WHEELS)
    wheel = rover.suspension.wheels[0]
    assert wheel.radius == 0.2 and wheel.width == 0.24
    assert rover.wheel_base == pytest.approx(2 * BASE, abs=1e-12)
    assert np.allclose(rover.reference, 0, atol=1e-12)


def test_a_changed_urdf_changes_the_vehicle(tmp_path):
    text = URDF.read_text().replace('radius="0.2"', 'radius="0.25"').replace("<mesh", "<!--").replace(
        "/></geometry></visual>", "--></geometry></visual>")
    (tmp_path / "r.urdf").write_text(text)
    changed = load_vehicle(tmp_path / "r.urdf")
    state = changed.solve((0, 0, 0), level)
    assert state.position[2] == pytest.approx(0.05, abs=1e-9)


# --- closed forms --------------------------------------------------------------------------------

@pytest.mark.parametrize("heading", [0.0, 37.0, -120.0])
def test_level_ground_leaves_every_angle_zero(rover, heading):
    s = rover.solve((3.0, -2.0, heading), lambda xy: np.full(len(xy), 1.5))
    assert np.allclose(s.position, [3, -2, 1.5], atol=1e-9)
    half = np.radians(heading) / 2
    assert np.allclose(s.quaternion, [np.cos(half), 0, 0, np.sin(half)], atol=1e-9)
    assert max(abs(a) for a in {**s.joints, **s.mimic_joints}.values()) < 1e-7
    assert s.tilt_deg < 1e-6 and s.residual < 1e-9 and not s.beyond_limits
    for wheel, point in s.contacts.items():  # below the middle of the tread
        assert np.allclose(point, s.wheel_centers[wheel] - [0, 0, RADIUS], atol=1e-7)


@pytest.mark.parametrize("slope_deg,direction_deg", [(10, 0), (15, 60), (12, 90), (20, 200)])
def test_plane_tilts_the_chassis_alone(rover, slope_deg, direction_deg):
    g = np.tan(np.radians(slope_deg))
    a = np.radians(direction_deg)
    s = rover.solve((1, 2, 25), lambda xy: g * (xy @ [np.cos(a), np.sin(a)]))
    assert s.tilt_deg == pytest.approx(slope_deg, abs=1e-4)
    assert max(abs(s.joints[j]) for j in ("rocker_left", "bogie_left", "bogie_right")) < 1e-4
    up = matrix(s.quaternion)[:, 2]
    assert np.allclose(up, np.array([-g * np.cos(a), -g * np.sin(a), 1]) / np.hypot(g, 1), atol=1e-6)


@pytest.mark.parametrize("height", [0.03, 0.10, -0.06])
def test_both_middle_wheels_on_a_step(rover, height):
    """The bogies turn until sin(a) = height / distance between wheels; the rockers, equal on both
    sides, turn with the chassis alone until the front wheels touch. Exact at any size."""
    s = rover.solve((0, 0, 0), lambda xy: np.where(np.abs(xy[:, 0]) < 0.35, height, 0.0))
    a = np.arcsin(height / BASE)  # bogie nose up against the world
    along, down = 1.23, 0.16  # from the bogie's pivot to the front wheel's centre
    theta = np.arcsin((height / 2 + down * np.cos(a)) / np.hypot(along, down)) - np.arctan2(down, along)
    assert s.pitch_deg == pytest.approx(np.degrees(theta), abs=1e-3)
    assert s.joints["rocker_left"] == pytest.approx(0, abs=1e-6)
    for side in ("left", "right"):
        assert s.joints[f"bogie_{side}"] == pytest.approx(np.degrees(-a - theta), abs=2e-3)
    # Nothing has been driven: no wheel has turned against the world, whatever carries it has.
    assert abs(s.joints["wheel_middle_left"]) > 1
    for wheel in WHEELS:
        assert np.allclose(walk(URDF, s)[wheel][0], np.eye(3), atol=1e-5)


def test_one_middle_wheel_on_a_small_step(rover):
    """By hand, to first order in the height h: the left bogie's pivot rises by h/2 and its rocker
    turns nose down by h / (2 1.23); the chassis takes the mean of both rockers, the differential the
    half difference; the chassis rolls by the rise of the left track at the rocker pivot, h/3."""
    errors = []
    for h in (0.008, 0.004):
        s = rover.solve((0, 0, 0), lambda xy: np.where((np.abs(xy[:, 0]) < 0.35) & (xy[:, 1] > 0), h, 0.0))
        rocker = h / 1.23 / 4
        expected = {"pitch": rocker, "roll": h / 3 / 1.24, "rocker": rocker,
                    "left": -h / BASE - h / 1.23 / 2, "right": 0.0}
        found = {"pitch": s.pitch_deg, "roll": s.roll_deg, "rocker": s.joints["rocker_left"],
                 "left": s.joints["bogie_left"], "right": s.joints["bogie_right"]}
        off = [abs(np.radians(found[k]) - expected[k]) for k in expected]
        assert max(off) < 4 * h * h
        assert s.mimic_joints["rocker_right"] == pytest.approx(-s.joints["rocker_left"], abs=1e-12)
        errors.append(max(off))
    assert errors[0] / errors[1] == pytest.approx(4, rel=0.2)  # what is left is of second order


@pytest.mark.parametrize("curvature", [0.3, -0.3, 0.05])
def test_ackermann_axles_meet_at_the_turn_centre(rover, curvature):
    s = rover.solve((1, 2, 30, curvature), level)
    links = walk(URDF, s)
    a = np.radians(30)
    centre = np.array([1, 2]) + np.array([-np.sin(a), np.cos(a)]) / curvature
    for wheel in WHEELS:
        r, p = links[wheel]
        axle = r[:2, 1] / np.linalg.norm(r[:2, 1])
        d = centre - p[:2]
        assert abs(axle[0] * d[1] - axle[1] * d[0]) < 1e-6
    angle = np.arctan2(curvature * BASE, 1 - curvature * 0.62)
    assert s.joints["steer_front_left"] == pytest.approx(np.degrees(angle), abs=1e-9)
    assert s.joints["steer_rear_left"] == pytest.approx(-np.degrees(angle), abs=1e-9)


def test_wheels_turn_by_the_way_they_run(rover):
    path = Path([(0, 0), (6, 0)], speed=1.0)
    last = rover.drive(path, np.linspace(0, 6, 61), level)[-1]
    for wheel in WHEELS:
        assert last.joints[wheel] == pytest.approx(np.degrees(6 / RADIUS), abs=1e-6)
    # On a slope the way is longer by 1 / cos.
    up = rover.drive(path, np.linspace(0, 6, 61), lambda xy: 0.2 * xy[:, 0])
    turned = up[-1].joints[WHEELS[0]] - up[0].joints[WHEELS[0]]
    assert turned == pytest.approx(np.degrees(6 * np.hypot(1, 0.2) / RADIUS), rel=1e-5)


def test_outer_wheels_run_further_in_a_turn(rover):
    radius = 8.0
    a = np.linspace(0, np.pi, 41)
    path = Path(np.column_stack([radius * np.sin(a), radius * (1 - np.cos(a))]), speed=1.0)
    s = rover.solve(path.pose(path.duration), level)
    for wheel in rover.suspension.wheels:
        run = np.pi * np.hypot(radius - wheel.centre[1], wheel.centre[0])
        assert s.joints[wheel.name] == pytest.approx(np.degrees(run / RADIUS), rel=2e-3)


# --- the shipped field ---------------------------------------------------------------------------

def test_every_wheel_rests_on_the_field(rover, field, drive):
    """Rims sampled densely from the URDF's own link poses, against the terrain's triangles."""
    phi = np.radians(np.arange(-80, 80.01, 0.25))
    side = np.linspace(-0.12, 0.12, 13)
    for s in drive[2][::6]:
        assert s.residual < 1e-3
        links = walk(URDF, s)
        for wheel in WHEELS:
            r, p = links[wheel]
            axle = r[:, 1]
            up = np.array([0, 0, 1]) - axle[2] * axle
            up /= np.linalg.norm(up)
            ahead = np.cross(axle, up)
            rim = p + RADIUS * (np.sin(phi)[:, None, None] * ahead - np.cos(phi)[:, None, None] * up) \
                + side[None, :, None] * axle
            rim = rim.reshape(-1, 3)
            gap = rim[:, 2] - field.heights(rim[:, :2])
            assert abs(gap.min()) < 1e-3
            assert np.abs(s.wheel_centers[wheel] - p).max() < 1e-9
            contact = s.contacts[wheel]
            assert abs(contact[2] - field.heights(contact[None, :2])[0]) < 1e-3


def test_rods_keep_their_lengths_and_the_differential_holds(drive):
    pivot = np.array([-0.41, 0.46, 0.36])
    for s in drive[2]:
        assert s.joints["rocker_left"] == pytest.approx(-s.mimic_joints["rocker_right"], abs=1e-12)
        c = s.wheel_centers
        for side in ("left", "right"):
            middle, rear = c[f"wheel_middle_{side}"], c[f"wheel_rear_{side}"]
            assert np.linalg.norm(middle - rear) == pytest.approx(BASE, abs=1e-9)
        links = walk(URDF, s)
        rod = links["steer_front_left"][1] - links["bogie_left"][1]
        assert np.linalg.norm(rod) == pytest.approx(np.linalg.norm(np.array([0.82, 0.62, 0.5]) - pivot), abs=1e-9)


def test_drive_and_solve_agree(rover, field, drive):
    path, times, states = drive
    one = rover.solve(path.pose(times[77]), field)
    assert np.allclose(one.position, states[77].position, atol=1e-4)
    assert one.joints["bogie_left"] == pytest.approx(states[77].joints["bogie_left"], abs=0.02)


def test_motion_is_smooth_at_sixty_steps_a_second(rover, field, drive):
    """No jumps: in a step of 13 mm no part moves by more than a steep crater wall demands."""
    times = drive[1][90] + np.arange(180) / 60
    states = rover.drive(drive[0], times, field)
    p = np.array([s.position for s in states])
    assert np.linalg.norm(np.diff(p, axis=0), axis=1).max() < 1.5 * 0.8 / 60
    for joint in ("rocker_left", "bogie_left", "bogie_right"):
        assert np.abs(np.diff([s.joints[joint] for s in states])).max() < 2.0


# --- terrain and path ----------------------------------------------------------------------------

@pytest.mark.parametrize("diagonal,middle", [("nw-se", 0.0), ("sw-ne", 0.5)])
def test_grid_triangles(diagonal, middle):
    t = GridTerrain([[0, 1], [0, 0]], 0, 10, 2.0, diagonal)
    assert t(np.array([[0, 10], [2, 10], [0, 8], [2, 8]])) == pytest.approx([0, 1, 0, 0])
    assert t(np.array([[1.0, 9.0]]))[0] == pytest.approx(middle)
    at, step = np.array([[0.4, 9.5], [1.7, 9.4], [1.6, 8.2], [0.2, 8.3]]), 1e-6
    for k in range(2):
        move = step * np.eye(2)[k]
        assert t.gradients(at)[:, k] == pytest.approx((t(at + move) - t(at - move)) / (2 * step), abs=1e-6)


def test_path_arc_length_and_motion():
    path = Path([(0, 0), (3, 4), (9, -1), (12, 2)], speed=0.7, ramp=2.0)
    s = np.linspace(0, path.length, 20001)
    x, y, heading, curvature = path.sample(s)
    step = np.hypot(np.diff(x), np.diff(y))
    assert step == pytest.approx(np.diff(s), rel=1e-6)  # unit speed over arc length
    assert np.gradient(np.unwrap(heading), s)[5:-5] == pytest.approx(curvature[5:-5], abs=2e-4)
    for p in path.way_points:
        assert np.hypot(x - p[0], y - p[1]).min() < 1e-3
    t = np.linspace(0, path.duration, 4001)
    v = np.gradient(path.distance(t), t)
    assert v.max() == pytest.approx(0.7, abs=1e-6)
    assert v[2:-2] == pytest.approx([p.speed for p in path.poses(t[2:-2])], abs=1e-3)
    assert path.distance(path.duration) == pytest.approx(path.length, abs=1e-12)


# --- other models --------------------------------------------------------------------------------

def test_carried_model_lies_on_the_slope():
    box = CarriedModel(((-1, -0.5, 0.2), (3, 0.5, 1.2)), scale=2.0)
    s = box.solve((5, 5, 0), lambda xy: 0.25 * xy[:, 0] - 0.1 * xy[:, 1])
    up = np.array([-0.25, 0.1, 1]) / np.linalg.norm([0.25, 0.1, 1])
    r = matrix(s.quaternion)
    assert np.allclose(r[:, 2], up, atol=1e-9)
    assert s.tilt_deg == pytest.approx(np.degrees(np.arccos(up[2])), abs=1e-6)
    bottom = s.position + r @ (2.0 * np.array([1, 0, 0.2]))
    assert np.allclose(bottom, [5, 5, 0.25 * 5 - 0.5], atol=1e-9)


def test_carried_model_with_y_up_stands_upright():
    s = CarriedModel(((-1, 0, -2), (1, 3, 2)), up="y").solve((0, 0, 90), level)
    r = matrix(s.quaternion)
    assert np.allclose(r[:, 1], [0, 0, 1], atol=1e-9) and np.allclose(r[:, 2], [0, 1, 0], atol=1e-9)


def test_mast_looks_where_told(rover):
    assert rover.look(0, 0) == pytest.approx({"mast_pan": 0, "mast_tilt": 0}, abs=1e-6)
    assert rover.look(30, 10) == pytest.approx({"mast_pan": 30, "mast_tilt": 10}, abs=1e-6)


def test_bad_input_is_named(rover, tmp_path):
    with pytest.raises(NotFound, match="no_such"):
        load_vehicle(tmp_path / "no_such.urdf")
    (tmp_path / "bad.urdf").write_text("<robot><link")
    with pytest.raises(ValueError, match="bad.urdf"):
        load_vehicle(tmp_path / "bad.urdf")
    cart = "".join(f'<link name="wheel{k}"><visual><geometry><cylinder radius="0.2" length="0.1"/></geometry></visual></link>'
                   f'<joint name="wheel{k}" type="continuous"><parent link="base"/><child link="wheel{k}"/><axis xyz="0 1 0"/>'
                   f'<origin xyz="{x} {y} 0"/></joint>' for k, (x, y) in enumerate(((1, 1), (1, -1), (-1, 1), (-1, -1))))
    (tmp_path / "cart.urdf").write_text(f'<robot name="cart"><link name="base"/>{cart}</robot>')
    with pytest.raises(InvalidArgument, match="no suspension is recognised; accepted: six wheels on two rockers and two bogies, or four"):
        load_vehicle(tmp_path / "cart.urdf")
    text = URDF.read_text().replace('<visual><geometry><mesh filename="wheel.glb"/></geometry></visual>', "")
    (tmp_path / "shown.urdf").write_text(text.replace("collision>", "visual>"))
    assert [(wheel.radius, wheel.width) for wheel in load_vehicle(tmp_path / "shown.urdf").suspension.wheels] == 6 * [(RADIUS, 0.24)]
    (tmp_path / "frames.json").write_text("{}")
    with pytest.raises(ValueError, match="frames"):
        load_vehicle(tmp_path)
    with pytest.raises(ValueError, match="coincide"):
        Path([(0, 0), (0, 0)])
    with pytest.raises(ValueError, match="ascend"):
        rover.drive(Path([(0, 0), (1, 0)]), [1.0, 0.5], level)
    for pose in ((0, 0), "here", 3, (0, 0, np.nan), (0, 0, "east")):
        with pytest.raises(WrongType, match="the pose is .*accepted: a PathPose, or 3 to 5 finite numbers"):
            rover.solve(pose, level)
    with pytest.raises(TypeError, match="terrain"):
        rover.solve((0, 0, 0), 3)
    with pytest.raises(InvalidArgument, match="no height at .*accepted: places where it has data"):
        rover.solve((0, 0, 0), lambda xy: np.where(xy[:, 0] > 0.5, np.nan, 0.0))


@real_data
def test_perseverance_with_z_down():
    needs_module("osgeo.gdal", "python3-gdal")
    urdf = REAL / "models" / "m2020_rover" / "m2020.urdf"
    v = load_vehicle(urdf)
    assert isinstance(v, RockerBogie)
    s = v.solve((0, 0, 0), level)
    assert np.allclose(matrix(s.quaternion), np.diag([1, -1, -1]), atol=1e-5)
    assert 0.24 < v.suspension.wheels[0].radius < 0.28 and s.residual < 1e-3
    links = walk(urdf, v.solve((0, 0, 0, 0.1), level))
    for w in v.suspension.wheels:
        r, p = links[w.link]
        axle = r[:2, 1] / np.linalg.norm(r[:2, 1])
        d = np.array([0, 10]) - p[:2]
        assert abs(axle[0] * d[1] - axle[1] * d[0]) < 1e-3  # wheels lie a little off their axles
    states = v.drive(Path([(-15, -5), (0, 0), (15, 3)], 1.0), np.linspace(0, 30, 60), GridTerrain.from_file(FIELD))
    assert max(s.residual for s in states) < 1e-3
    left = v.look(90, 0)
    s.joints.update(left)
    assert walk(urdf, s)["Body_RSM_EL"][0][:, 0] == pytest.approx([0, 1, 0], abs=1e-4)


@real_data
@pytest.mark.parametrize("folder,kind,wheels", [("rocky7_vrml", RockerBogie, 6), ("viper_obj", IndependentSuspension, 4)])
def test_vehicles_from_frames(folder, kind, wheels):
    needs_module("osgeo.gdal", "python3-gdal")
    v = load_vehicle(REAL / "models" / folder)
    assert isinstance(v, kind) and len(v.wheels) == wheels
    assert {p.frame for p in v.parts} == {v.description.root} | {j.child for j in v.description.joints}
    assert all(p.path.exists() for p in v.parts)
    rest = v.solve((0, 0, 0), level)
    for j in v.description.joints:  # at rest each frame is where the file puts it
        assert np.allclose(rest.frames[j.child][0], j.translation, atol=2e-5)
    states = v.drive(Path([(-6, -5), (0, 0), (6, 3)], 0.5), np.linspace(0, 24, 60), GridTerrain.from_file(FIELD))
    assert max(s.residual for s in states) < 1e-3
    # Wheel centres through the frames' own chain.
    for s in states[::20]:
        for w in v.suspension.wheels:
            r, p = matrix(s.quaternion), s.position
            chain = [j.child for j in v.description.chain(w.link)]
            for name in chain:
                p = p + r @ s.frames[name][0]
                r = r @ matrix(s.frames[name][1])
            assert np.allclose(p, s.wheel_centers[w.name], atol=1e-9)


@real_data
def test_space_station_is_carried():
    v = load_vehicle(REAL / "models" / "spacecraft_glb" / "iss.glb", scale=0.1)
    assert isinstance(v, CarriedModel) and v.size.max() < 20
    s = v.solve((1, 2, 0), level)
    assert s.joints == {} and s.tilt_deg == 0.0


SOLVED = """
import hashlib, random
import numpy as np
from dspace.rover import GridTerrain, Path, load_vehicle
memory = [bytearray(random.randrange(1, 5000)) for _ in range(random.randrange(1000))]  # other addresses each time
ground = GridTerrain(np.cumsum(np.random.default_rng(1).normal(size=(150, 150)), axis=0) * 0.02, -15, 15, 0.2)
vehicle = load_vehicle(%r)
path = Path([(0, 0), (4, 2), (8, 0)], speed=0.5)
found = hashlib.sha256()
for state in [vehicle.solve(path.pose(t), ground) for t in range(6)] + vehicle.drive(path, np.linspace(0, 8, 9), ground):
    for values in (state.position, state.quaternion, sorted(state.joints.items())):
        found.update(values.tobytes() if hasattr(values, "tobytes") else repr(values).encode())
print(found.hexdigest())
"""


def test_the_same_drive_has_the_same_bits_in_every_process():
    code = SOLVED % str(File(__file__).resolve().parents[3] / "Data/rover/rover.urdf")
    found = {subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True,
                            env={**os.environ, "PYTHONHASHSEED": seed}).stdout for seed in ("1", "2", "random")}
    assert len(found) == 1 and len(found.pop()) == 65


def test_the_same_pose_has_the_same_bits_wherever_its_numbers_lie(rover):
    """numpy 1.24 takes sin, cos, arctan, ... of a column in another way where its gaps touch the result's memory."""
    def waves(xy):
        at = xy * [0.7, 1.3]
        return 0.3 * np.sin(at[:, 0].copy()) + 0.2 * np.cos(at[:, 1].copy())

    rng, kept = np.random.default_rng(0), []
    for x in (1.0, 3.0):
        found = set()
        for _ in range(150):
            kept += [np.empty(int(rng.integers(1, 64))) for _ in range(40)]
            while len(kept) > 200:
                kept.pop(int(rng.integers(len(kept))))
            state = rover.solve((x, 2.0, 40.0), waves)
            found.add((state.position.tobytes(), state.quaternion.tobytes(), *state.joints.items()))
        assert len(found) == 1


@pytest.mark.parametrize("rows", (1, 2, 7))
def test_packed_columns_have_no_gaps(rows):
    table = np.arange(6.0 * rows).reshape(rows, 6)
    column = packed(table[:, 4])
    assert column.strides == (8,) and not np.shares_memory(column, table)
    assert column.tolist() == [6 * k + 4 for k in range(rows)]
