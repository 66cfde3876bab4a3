"""Camera paths: keys are met, rates have no jumps, and where a closed form exists it is followed."""
import numpy as np
import pytest

import dspace
from dspace.movies.keys import CameraPath, Key, RunTime
from dspace.movies.path import FovPath, PlacePath, TurnPath, exponential, logarithm, looking, monotone_slopes
from dspace.frames.poses import matrix_of_quaternion, multiply, quaternion_of_axis

NO = lambda n: [False] * n
TIMES = np.array([0.0, 1.0, 1.5, 4.0, 4.25, 7.0])


def uneven(seed=3, count=6):
    """Keys at uneven times and distances, with large and small turns."""
    random = np.random.default_rng(seed)
    points = np.cumsum(random.normal(size=(count, 3)) * random.uniform(0.2, 9.0, (count, 1)), axis=0)
    turns = random.normal(size=(count, 4))
    return points, turns / np.linalg.norm(turns, axis=1)[:, None]


def sides(at, time, h=1e-5):
    """The derivatives from both sides, to second order."""
    return ((3 * at(time) - 4 * at(time - h) + at(time - 2 * h)) / (2 * h),
            (-3 * at(time) + 4 * at(time + h) - at(time + 2 * h)) / (2 * h))


def rate_sides(path, time, h=1e-5):
    """Angular rates [rad/s] from both sides, in the camera's axes, to second order."""
    q = path.at(time)
    turned = lambda dt: logarithm(multiply(q * (1, -1, -1, -1), path.at(time + dt)))
    return ((-4 * turned(-h) + turned(-2 * h)) / (2 * h), (4 * turned(h) - turned(2 * h)) / (2 * h))


def same_rotation(a, b, tolerance=1e-12):
    assert min(np.abs(a - b).max(), np.abs(a + b).max()) <= tolerance


@pytest.mark.parametrize("seed", range(5))
def test_keys_are_met_and_velocity_has_no_jump(seed):
    points, _ = uneven(seed)
    path = PlacePath(TIMES, points, NO(6))
    for time, point in zip(TIMES, points):
        np.testing.assert_array_equal(path.at(time), point)
        np.testing.assert_allclose(path.at(time + 1e-12), point, atol=1e-9)
        np.testing.assert_allclose(path.at(time - 1e-12), point, atol=1e-9)
    for time in TIMES[1:-1]:
        before, after = sides(path.at, time)
        np.testing.assert_allclose(before, after, atol=2e-4 * max(1, np.linalg.norm(before)))
        assert np.linalg.norm(before) > 1e-3 or np.linalg.norm(after) < 1e-2
    # Between keys too, and everywhere finite.
    t = np.linspace(0, 7, 1401)
    way = np.array([path.at(each) for each in t])
    speed = np.linalg.norm(np.diff(way, axis=0), axis=1) * 200
    assert np.isfinite(way).all() and np.abs(np.diff(speed)).max() < 0.15 * speed.max()


def test_the_spline_is_the_centripetal_one():
    """Against Barry and Goldman's pyramid, another way to compute it."""
    points, _ = uneven(11, 4)
    path = PlacePath([0, 1, 2, 3], points, NO(4))
    knots = np.concatenate(([0], np.cumsum(np.sqrt(np.linalg.norm(np.diff(points, axis=0), axis=1)))))

    def pyramid(u):
        level = [points[k] for k in range(4)]
        for step in (1, 2):
            spans = [(knots[k], knots[k + step]) for k in range(4 - step)]
            level = [((b - u) * level[k] + (u - a) * level[k + 1]) / (b - a) for k, (a, b) in enumerate(spans)]
        return ((knots[2] - u) * level[0] + (u - knots[1]) * level[1]) / (knots[2] - knots[1])

    for x in (0.1, 0.37, 0.5, 0.9):
        expected = pyramid(knots[1] + x * (knots[2] - knots[1]))
        np.testing.assert_allclose(path._place(1, x), expected, atol=1e-12)


def test_speed_is_that_of_the_arc_length():
    points, _ = uneven(2)
    path = PlacePath(TIMES, points, NO(6))
    fine = np.array([path.at(t) for t in np.linspace(1.0, 1.5, 20001)])
    length = np.linalg.norm(np.diff(fine, axis=0), axis=1).sum()
    assert length == pytest.approx(path.lengths[2] - path.lengths[1], rel=1e-7)


def test_even_speed_on_a_line_stays_even_whatever_the_keys_times():
    times = np.array([0, 0.2, 3, 3.1, 8])
    path = PlacePath(times, np.outer(times, (3.0, -4.0, 12.0)) + (7, 8, 9), NO(5))
    for t in np.linspace(0, 8, 57):
        np.testing.assert_allclose(path.at(t), (3 * t + 7, -4 * t + 8, 12 * t + 9), atol=1e-12 * 100)


def test_a_circle_of_even_keys():
    """Eight keys a turn: halfway between keys the radius is (9 cos(a/2) - cos(3 a/2)) / 8, a = 45 degrees;
    the speed is that of the arcs, even all round, and the tangents at keys are the circle's."""
    count, radius = 25, 10.0
    angle = np.radians(45) * np.arange(count)
    points = radius * np.column_stack((np.cos(angle), np.sin(angle), 0 * angle))
    path = PlacePath(np.arange(count), points, NO(count))
    half = np.radians(22.5)
    expected = radius * (9 * np.cos(half) - np.cos(3 * half)) / 8
    speeds = []
    for k in range(3, 20):
        assert np.linalg.norm(path.at(k + 0.5)) == pytest.approx(expected, rel=1e-12)
        velocity = (path.at(k + 1e-5) - path.at(k - 1e-5)) / 2e-5
        np.testing.assert_allclose(velocity / np.linalg.norm(velocity), (-np.sin(angle[k]), np.cos(angle[k]), 0),
                                   atol=1e-8)
        speeds.append(np.linalg.norm(velocity))
    np.testing.assert_allclose(speeds, speeds[0], rtol=1e-8)
    assert speeds[0] == pytest.approx(radius * np.radians(45), rel=0.01)  # what eight keys a turn miss


def test_even_turning_stays_even_whatever_the_keys_times():
    axis = np.array([1.0, 2.0, -2.0]) / 3
    times = np.array([0, 0.2, 3, 3.1, 8])
    rate = 40.0  # degrees a second: up to 196 between keys
    times = times[:4]
    keys = [quaternion_of_axis(axis, rate * t) * (-1) ** k for k, t in enumerate(times)]  # signs do not count
    path = TurnPath(times, keys, NO(4))
    for t in np.linspace(0, 3.1, 41):
        same_rotation(path.at(t), quaternion_of_axis(axis, rate * t), 1e-14 * 100)


@pytest.mark.parametrize("seed", range(5))
def test_turns_are_met_and_angular_rate_has_no_jump(seed):
    _, turns = uneven(seed)
    path = TurnPath(TIMES, turns, NO(6))
    for time, turn in zip(TIMES, turns):
        same_rotation(path.at(time), turn, 1e-15 * 4)
    for time in TIMES[1:-1]:
        before, after = rate_sides(path, time)
        np.testing.assert_allclose(before, after, atol=2e-4 * max(1, np.linalg.norm(before)))
    t = np.linspace(0, 7, 1401)
    q = [path.at(each) for each in t]
    rates = np.array([np.linalg.norm(logarithm(multiply(a * (1, -1, -1, -1), b))) for a, b in zip(q, q[1:])]) * 200
    assert np.abs(np.diff(rates)).max() < 0.15 * rates.max()
    np.testing.assert_allclose(np.linalg.norm(q, axis=1), 1, atol=1e-14)


def test_signs_of_quaternions_do_not_count():
    _, turns = uneven()
    random = np.random.default_rng(0)
    plain = TurnPath(TIMES, turns, NO(6))
    for _ in range(8):
        other = TurnPath(TIMES, turns * random.choice((-1, 1), (6, 1)), NO(6))
        for t in np.linspace(0, 7, 29):
            same_rotation(other.at(t), plain.at(t), 1e-13)


def test_logarithm_and_exponential():
    random = np.random.default_rng(1)
    for size in (0, 1e-14, 1e-9, 1e-4, 1.0, 3.0, np.pi):
        v = random.normal(size=3)
        v *= size / np.linalg.norm(v)
        np.testing.assert_allclose(logarithm(exponential(v)), v, atol=1e-13)
        np.testing.assert_allclose(exponential(v), quaternion_of_axis(v, np.degrees(size)) if size else (1, 0, 0, 0),
                                   atol=1e-15)


def test_equal_keys_wait_and_one_key_stays():
    points = np.array([[0, 0, 0], [4, 0, 0], [4, 0, 0], [4, 3, 0]], float)
    path = PlacePath([0, 1, 2, 3], points, NO(4))
    for t in np.linspace(1, 2, 11):
        np.testing.assert_array_equal(path.at(t), (4, 0, 0))
    for time in (1, 2):  # comes to rest and sets off without a jump
        for side in sides(path.at, time):
            np.testing.assert_allclose(side, 0, atol=1e-3)
    quarter = quaternion_of_axis("z", 90)
    turns = TurnPath([0, 1, 2, 3], [(1, 0, 0, 0), quarter, -quarter, quaternion_of_axis("x", 30)], NO(4))
    for t in np.linspace(1, 2, 11):
        same_rotation(turns.at(t), quarter, 1e-15)
    one = CameraPath([Key(time=5.0, position=(1, 2, 3), quaternion=(0, 1, 0, 0), fov_deg=20)])
    for t in (0, 5, 9):
        frame, position, quaternion, projection = one.at(t)
        assert (frame, tuple(position), tuple(quaternion), projection) == (
            "", (1, 2, 3), (0, 1, 0, 0), {"fov_deg": 20})
    two = CameraPath([Key(0.0, (1, 2, 3), (0, 1, 0, 0)), Key(2.0, (1, 2, 3), (0, -1, 0, 0))])
    assert tuple(two.at(1.0)[1]) == (1, 2, 3)
    same_rotation(two.at(1.0)[2], np.array([0, 1, 0, 0]))


def test_a_path_that_turns_back_stops_there():
    path = PlacePath([0, 1, 2], [(0, 0, 0), (5, 0, 0), (0, 0, 0)], NO(3))
    before, after = sides(path.at, 1.0, 1e-4)
    np.testing.assert_allclose(before, 0, atol=1e-2)
    np.testing.assert_allclose(after, 0, atol=1e-2)
    way = np.array([path.at(t)[0] for t in np.linspace(0, 2, 101)])
    assert (np.diff(way[:51]) > -1e-12).all() and (np.diff(way[50:]) < 1e-12).all()


def test_rest_comes_to_a_halt():
    points, turns = uneven()
    rests = [True, False, False, True, False, True]
    places, rotations = PlacePath(TIMES, points, rests), TurnPath(TIMES, turns, rests)
    for time in (4.0,):
        for side in (*sides(places.at, time), *rate_sides(rotations, time)):
            np.testing.assert_allclose(side, 0, atol=2e-3)
    # Of two keys that rest the way is 3 x^2 - 2 x^3.
    two = PlacePath([0, 2], [(0, 0, 0), (8, 0, 0)], [True, True])
    turn = TurnPath([0, 2], [(1, 0, 0, 0), quaternion_of_axis("y", 120)], [True, True])
    for x in (0.1, 0.25, 0.5, 0.8):
        part = x * x * (3 - 2 * x)
        assert two.at(2 * x)[0] == pytest.approx(8 * part, abs=1e-12)
        same_rotation(turn.at(2 * x), quaternion_of_axis("y", 120 * part), 1e-14)


def test_fields_of_view_go_evenly_in_what_is_seen():
    path = FovPath([0, 1, 3], np.degrees(2 * np.arctan(np.array([0.8, 0.4, 0.1]))), NO(3))
    assert path.at(1.0) == np.degrees(2 * np.arctan(0.4))
    # Halved each second: constant rate, so that the closed form holds.
    for t in np.linspace(0, 3, 13):
        assert np.tan(np.radians(path.at(t)) / 2) == pytest.approx(0.8 * 0.5**t, rel=1e-13)
    bend = FovPath([0, 1, 2, 3], [60, 5, 5, 90], NO(4))
    values = np.array([bend.at(t) for t in np.linspace(0, 3, 301)])
    assert values.min() >= 5 - 1e-9 and values.max() <= 90 + 1e-9  # no overshoot


def test_slopes_of_even_data_are_even():
    t = np.array([0, 0.1, 3, 4])
    np.testing.assert_allclose(monotone_slopes(t, 5 * t), 5, rtol=1e-14)
    assert monotone_slopes(np.arange(3.0), np.array([0.0, 1, 0]))[1] == 0


def test_places_far_away_lose_no_digits():
    """About the Sun, 1.5e11 m away: steps of a metre are right to what doubles hold there."""
    far = np.array([1.5e11, 0, 0])
    path = PlacePath([0, 1, 2], far + [(0, 0, 0), (0, 1, 0), (0, 2, 0)], NO(3))
    for t in np.linspace(0, 2, 9):
        np.testing.assert_allclose(path.at(t) - far, (0, t, 0), atol=1e-9)


# --- Keys, shots, frames ---------------------------------------------------------------------------

def test_cuts_jump_and_shots_know_nothing_of_each_other():
    a = [Key(0.0, (0, 0, 0), (1, 0, 0, 0)), Key(2.0, (2, 0, 0), (1, 0, 0, 0))]
    b = [Key(2.0, (9, 9, 9), (0, 1, 0, 0), cut=True), Key(3.0, (9, 9, 10), (0, 1, 0, 0))]
    path = CameraPath(b + a)  # their order does not count
    np.testing.assert_allclose(path.at(2.0 - 1e-9)[1], (2, 0, 0), atol=1e-8)
    np.testing.assert_array_equal(path.at(2.0)[1], (9, 9, 9))
    for t in (0.3, 1.0, 1.9):
        np.testing.assert_allclose(path.at(t)[1], (t, 0, 0), atol=1e-12)
        np.testing.assert_array_equal(path.at(t)[1], CameraPath(a).at(t)[1])
    assert CameraPath([a[0], Key(1.0, (5, 5, 5), (1, 0, 0, 0), cut=True)]).at(0.9)[1][0] == 0  # waits for the cut


def test_targets_are_looked_at_all_the_way():
    keys = [Key(0.0, (10, 0, 2), target=(0, 0, 0)), Key(1.0, (0, 10, 3), target=(0, 1, 0)),
            Key(3.0, (-10, 0, 5), target=(0, 2, 1))]
    path = CameraPath(keys)
    targets = PlacePath([0, 1, 3], [key.target for key in keys], NO(3))
    for t in np.linspace(0, 3, 31):
        _, position, quaternion, _ = path.at(t)
        axes = matrix_of_quaternion(quaternion)
        towards = targets.at(t) - position
        np.testing.assert_allclose(axes[:, 2], towards / np.linalg.norm(towards), atol=1e-12)
        assert abs(axes[2, 0]) < 1e-12 and axes[2, 1] < 0  # level, upright
    mixed = CameraPath([keys[0], Key(1.0, (0, 10, 3), quaternion=(1, 0, 0, 0))])
    same_rotation(mixed.at(0)[2], looking((10, 0, 2), (0, 0, 0), (0, 0, 1)))


def test_keys_on_several_frames_meet_in_the_first_one(scene):
    scene.add_frame("a", position=(100, 0, 0), quaternion=quaternion_of_axis("z", 90))
    b = scene.add_frame("b", position=(0, 50, 0))
    path = CameraPath([Key(0.0, (1, 0, 0), (1, 0, 0, 0), frame="a"), Key(1.0, (0, 0, 4), (0, 1, 0, 0), frame="b"),
                       Key(2.0, (0, 0, 0), target=(0, 0, -7), up=(1, 0, 0), target_frame="b", frame="a")])
    relative = lambda frame, base: scene[frame].pose_in(scene[base])
    for _ in range(2):
        frame, position, quaternion, _ = path.at(1.0, relative)
        assert frame == "a"
        world = scene["a"].world_pose @ dspace.Pose(position, quaternion)
        expected = b.world_pose @ dspace.Pose((0, 0, 4), (0, 1, 0, 0))
        np.testing.assert_allclose(world.position, expected.position, atol=1e-12)
        same_rotation(world.quaternion, expected.quaternion)
        towards = scene["a"].world_pose.inverse().apply(b.world_pose.apply((0, 0, -7)))
        np.testing.assert_allclose(matrix_of_quaternion(path.at(2.0, relative)[2])[:, 2],
                                   towards / np.linalg.norm(towards), atol=1e-12)
        b.position = (0, 60, 5)  # and when it has moved


def test_run_time_freezes_slows_and_cuts():
    at = lambda time, run=None, cut=False: Key(time, (0, 0, 0), (1, 0, 0, 0), run=run, cut=cut)
    clock = RunTime([at(0.0, 10), at(2.0, 12), at(4.0, 12), at(6.0, 12.5), at(7.0), at(8.0, 100, cut=True)])
    for time, run in ((0, 10), (1, 11), (2, 12), (3, 12), (3.99, 12), (5, 12.25), (6, 12.5), (7.5, 14), (8, 100),
                      (9.5, 101.5)):
        assert clock.at(time) == run, time
    assert [RunTime([], 5.0, 0.5).at(t) for t in (0, 2)] == [5, 6]
    late = RunTime([at(0.0), at(3.0, 20)], 1.0)
    assert [late.at(t) for t in (0, 1, 3, 4)] == [17, 18, 20, 21]
    shots = RunTime([at(0.0, 4), at(2.0, cut=True), at(3.0)])
    assert [shots.at(t) for t in (1.5, 2, 3)] == [5.5, 6, 7]  # a cut without a run time goes on


def test_bad_keys_are_refused():
    good = dict(time=1.0, position=(0, 0, 0), quaternion=(1, 0, 0, 0))
    for change, says in (({"time": -1}, "time is -1"), ({"time": np.nan}, "time"), ({"fov_deg": 180}, "fov_deg is 180"),
                         ({"quaternion": (1, 1, 0, 0)}, "quaternion"), ({"easing": "slow"}, "'through' or 'rest'"),
                         ({"quaternion": None}, "one of quaternion and target"), ({"target": (0, 0, 1)}, "one of"),
                         ({"position": (0, 0)}, "position"), ({"run": np.inf}, "run"), ({"cut": 1}, "True or False"),
                         ({"target_frame": "a"}, "none without a target"), ({"position": (0, np.nan, 0)}, "finite"),
                         ({"quaternion": None, "target": (0, 0, 5)}, "not along up"),
                         ({"quaternion": None, "target": (0, 0, 0)}, "another place")):
        with pytest.raises(dspace.InvalidArgument, match="the key at") as error:
            Key(**{**good, **change})
        assert says in str(error.value)
    for keys in ([], [Key(**good), Key(**good)], [Key(**good, cut=True), Key(**good, cut=True)]):
        with pytest.raises(dspace.InvalidArgument, match="accepted: one"):
            CameraPath(keys)
