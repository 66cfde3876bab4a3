"""Turns of a movie's camera: no span goes round the other way, whatever its neighbours do."""
import numpy as np
import pytest

from dspace.movies.path import TurnPath, exponential, logarithm
from dspace.frames.poses import multiply, quaternion_of_axis

NO = lambda n: [False] * n


def between(a, b):
    """The rotation vector from one unit quaternion to another, in the axes of the first [rad]."""
    return logarithm(multiply(a * (1, -1, -1, -1), b))


def turned(path, start, end, steps=100):
    """Rotation vectors of small parts of the way, and the way as quaternions without jumps of sign."""
    way = [path.at(t) for t in np.linspace(start, end, steps + 1)]
    for k in range(1, len(way)):
        if way[k] @ way[k - 1] < 0:
            way[k] = -way[k]
    return np.array([between(a, b) for a, b in zip(way, way[1:])]), np.array(way)


def rates_about(path, time, h=1e-5):
    """Angular rates [rad/s] before and after a time, to second order."""
    q = path.at(time)
    step = lambda dt: between(q, path.at(time + dt))
    return (-4 * step(-h) + step(-2 * h)) / (2 * h), (4 * step(h) - step(2 * h)) / (2 * h)


@pytest.mark.parametrize("yaws", [(30, 0, 70, 40), (17, 0, 170, 153), (10, 0, 179, 170), (-30, 0, -70, -40)])
def test_a_span_between_turns_back_goes_the_short_way(yaws):
    """The neighbours are short and go the other way, so that their rates point against the chord."""
    times = np.array([0, 0.1, 1.1, 1.2])
    path = TurnPath(times, [quaternion_of_axis("z", yaw) for yaw in yaws], NO(4))
    parts, _ = turned(path, 0.1, 1.1)
    assert np.degrees(parts.sum(0)) == pytest.approx((0, 0, yaws[2] - yaws[1]), abs=1e-9)
    # Both keys are full reversals, where it halts: between them the way is 3 x^2 - 2 x^3, which nowhere goes back.
    for x in (0.2, 0.5, 0.7):
        assert np.degrees(between(path.at(0.1), path.at(0.1 + x))[2]) == pytest.approx(
            (yaws[2] - yaws[1]) * x * x * (3 - 2 * x), abs=1e-9)
    for time in (0.1, 1.1):
        for rate in rates_about(path, time):
            np.testing.assert_allclose(rate, 0, atol=2e-2)  # of 300 degrees in 0.1 s


def keys(seed, largest):
    """Keys at uneven times, up to 148 times as far from each other as others, that turn by up to `largest` degrees."""
    random = np.random.default_rng(seed)
    q = [np.array([1.0, 0, 0, 0])]
    for _ in range(5):
        vector = random.normal(size=3)
        q.append(multiply(q[-1], exponential(vector / np.linalg.norm(vector)
                                             * np.radians(random.uniform(1, largest)))))
    return np.cumsum(np.exp(random.uniform(-3, 2, 6))), q


@pytest.mark.parametrize("largest", (40, 120, 179))
def test_random_turns_never_go_round_the_other_way(largest):
    for seed in range(50):
        times, q = keys(seed, largest)
        path = TurnPath(times, q, NO(6))
        for k in range(5):
            chord = between(q[k], q[k + 1])
            parts, way = turned(path, times[k], times[k + 1], 32)
            # Followed without a jump, it ends at what the chord alone leads to, and not at minus that: a way round
            # the other side of the rotations is a full turn off.
            expected = multiply(way[0], exponential(chord))
            np.testing.assert_allclose(way[-1], expected, atol=1e-9)
            assert np.linalg.norm(parts, axis=1).sum() < 2 * np.linalg.norm(chord)


def test_rates_at_keys_are_bounded_and_have_no_jump():
    halts = 0
    for seed in range(100):
        times, q = keys(seed, 179)
        path = TurnPath(times, q, NO(6))
        h = np.diff(times)
        mean = [between(a, b) / step for a, b, step in zip(q, q[1:], h)]
        for k in range(1, 5):
            size = [np.linalg.norm(rate) for rate in mean[k - 1:k + 1]]
            before, after = rates_about(path, times[k], 1e-5 * min(h[k - 1:k + 1]))
            np.testing.assert_allclose(before, after, atol=1e-3 * max(size))
            rate = np.linalg.norm(after)
            back = np.clip(1 + mean[k - 1] @ mean[k] / np.prod(size), 0, 1)
            assert rate <= min(3 * min(size), 1.5 * np.pi / max(h[k - 1:k + 1])) * back + 1e-3 * max(size)
            halts += back < 0.2
    assert halts > 20
