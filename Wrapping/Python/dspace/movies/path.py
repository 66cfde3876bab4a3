"""The path of a camera through key frames, as a function of movie time. Plain numpy.

Positions lie on a centripetal Catmull-Rom spline (Yuksel, Schaefer and Keyser 2011). The speed along it is
separate: the arc length is a monotone cubic of time (Fritsch and Butland 1984), so the speed has no jumps, and a
constant speed stays constant for any distances between keys. Rotations are cubic curves (Kim, Kim and Shin 1995) whose
angular rate at a key is the mean of both sides, weighted by time. Fields of view are a monotone cubic in the
logarithm of tan(fov / 2), heights of orthographic pictures in the logarithm of the height, and each tangent of an
off-axis picture is a monotone cubic. The path meets the keys exactly. The camera stands still before the first key and after the
last.
"""
import numpy as np

from dspace.frames.poses import multiply

_X, _W = np.polynomial.legendre.leggauss(16)
_PARTS = 8  # parts of a spline piece, each integrated with 16 points
# Limit of angle [rad]: a third of a span at this angle over its time is a quarter turn, so that both ends and the
# chord together stay under two pi.
_QUARTER = 1.5 * np.pi


def monotone_slopes(times, values):
    """Returns the slope at each time of a cubic that never overshoots. Linear data has a constant slope.

    times: (n,) rising; values: (n,)."""
    if len(times) == 1:
        return np.zeros(1)
    h = np.diff(times)
    d = np.diff(values) / h
    slopes = np.empty(len(times))
    slopes[0], slopes[-1] = d[0], d[-1]
    for k in range(1, len(d)):
        a, b = d[k - 1], d[k]
        weight = (h[k - 1] + 2 * h[k]) / (3 * (h[k - 1] + h[k]))
        slopes[k] = a * b / (weight * b + (1 - weight) * a) if a * b > 0 else 0.0
    return slopes


def _piece(times, time):
    """Returns the index of the piece that contains `time`, and the position within it, 0 to 1."""
    k = int(np.clip(np.searchsorted(times, time, side="right") - 1, 0, len(times) - 2))
    return k, float(np.clip((time - times[k]) / (times[k + 1] - times[k]), 0.0, 1.0))


class MonotonePath:
    """A number as a function of time."""

    def __init__(self, times, values, rests):
        self.times, self.values = np.asarray(times, float), np.asarray(values, float)
        self.slopes = np.where(rests, 0.0, monotone_slopes(self.times, self.values))

    def at(self, time):
        if len(self.times) == 1:
            return float(self.values[0])
        k, x = _piece(self.times, time)
        if x in (0.0, 1.0):  # exact at keys
            return float(self.values[k + int(x)])
        h = self.times[k + 1] - self.times[k]
        (a, b), (m, n) = self.values[k:k + 2], self.slopes[k:k + 2]
        y = 1 - x
        return float(a * y * y * (1 + 2 * x) + b * x * x * (3 - 2 * x) + h * x * y * (m * y - n * x))


class PlacePath:
    """A point as a function of time, which meets the points (n, 3) at `times`."""

    def __init__(self, times, points, rests):
        times, points = np.asarray(times, float), np.asarray(points, float)
        chords = np.linalg.norm(np.diff(points, axis=0), axis=1)
        moves = np.concatenate(([True], chords > 0))
        self.points = points[moves]  # without repeated points, at which the path waits
        self.exact = points
        chords = chords[chords > 0]
        knots = np.concatenate(([0.0], np.cumsum(np.sqrt(chords))))
        self._shape(knots)
        lengths = np.concatenate(([0.0], np.cumsum([self._length(k, 1.0) for k in range(len(chords))])))
        self.lengths = lengths
        self.number = np.cumsum(moves) - 1  # of each key's point
        slopes_to = lengths[self.number]
        self.along = MonotonePath(times, slopes_to, rests)
        self.along.slopes = self.along.slopes * self._slowing()[self.number]

    def _shape(self, knots):
        """Computes the derivatives at the points with respect to the knots."""
        p, h = self.points, np.diff(knots)
        self.steps = h
        if len(p) == 1:
            return
        d = np.diff(p, axis=0) / h[:, None]
        tangents = np.empty_like(p)
        # The points are mirrored beyond the ends, so the end tangent is the chord.
        tangents[0], tangents[-1] = d[0], d[-1]
        if len(p) > 2:
            # d01 - d02 + d12 of Catmull-Rom by knots, as a weighted mean of the two chords.
            weight = (h[1:] / (h[:-1] + h[1:]))[:, None]
            tangents[1:-1] = weight * d[:-1] + (1 - weight) * d[1:]
        self.tangents = tangents

    def _slowing(self):
        """Returns a factor for each point: 1, less where the path turns by more than a right angle, 0 at a full
        reversal."""
        out = np.ones(len(self.points))
        if len(self.points) > 2:
            d = np.diff(self.points, axis=0)
            d /= np.linalg.norm(d, axis=1)[:, None]
            out[1:-1] = np.clip(1 + np.einsum("ij,ij->i", d[:-1], d[1:]), 0.0, 1.0)
        return out

    def _place(self, k, x):
        (a, b), (m, n) = self.points[k:k + 2], self.tangents[k:k + 2]
        y = 1 - x
        # Relative to the start of the piece, so that large coordinates do not lose digits.
        return (a + (b - a) * (x * x * (3 - 2 * x)) + self.steps[k] * x * y * (m * y - n * x))

    def _speed(self, k, x):
        """Returns |dp/dx| for an array x."""
        (a, b), (m, n) = self.points[k:k + 2], self.tangents[k:k + 2] * self.steps[k]
        x = np.asarray(x)[..., None]
        return np.linalg.norm(6 * x * (1 - x) * (b - a) + m * (1 - x) * (1 - 3 * x)
                              + n * x * (3 * x - 2), axis=-1)

    def _length(self, k, end):
        """Returns the arc length of a piece from 0 to `end`."""
        edges = np.linspace(0.0, end, _PARTS + 1)
        half = end / (2 * _PARTS)
        x = (edges[:-1, None] + half) + half * _X
        return float(half * np.sum(self._speed(k, x) * _W))

    def _where(self, k, length):
        """Returns x at a length along a piece: Newton's method within bounds."""
        total = self.lengths[k + 1] - self.lengths[k]
        low, high, x = 0.0, 1.0, length / total
        for _ in range(60):
            miss = self._length(k, x) - length
            low, high = (low, x) if miss > 0 else (x, high)
            if abs(miss) <= 1e-14 * total or high - low < 1e-16:
                break
            speed = float(self._speed(k, x))
            step = x - miss / speed if speed > 0 else -1.0
            x = step if low < step < high else 0.5 * (low + high)
        return x

    def at(self, time):
        times = self.along.times
        exact = np.flatnonzero(times == np.clip(time, times[0], times[-1]))
        if len(exact):
            return self.exact[exact[0]].copy()
        k = int(np.searchsorted(times, time, side="right") - 1)
        first = self.number[k]
        if self.number[k + 1] == first:
            return self.exact[k].copy()
        length = self.along.at(time) - self.lengths[first]
        return self._place(first, self._where(first, length))


# --- Rotations -------------------------------------------------------------------------------------

def exponential(vector):
    """Returns the unit quaternion of a rotation vector [rad]."""
    half = 0.5 * np.linalg.norm(vector)
    return np.concatenate(([np.cos(half)], 0.5 * np.sinc(half / np.pi) * np.asarray(vector)))


def logarithm(q):
    """Returns the rotation vector [rad], of length up to pi, of a unit quaternion. q and -q have the same one."""
    q = -q if q[0] < 0 else q
    sine = np.linalg.norm(q[1:])
    if sine < 1e-12:
        return 2 * q[1:]
    return 2 * np.arctan2(sine, q[0]) / sine * q[1:]


def _long_logarithm(q):
    """Returns the rotation vector [rad], of length less than two pi, of a unit quaternion. That of -q turns the other
    way."""
    sine = np.linalg.norm(q[1:])
    if sine < 1e-12:
        return 2 * q[1:]
    return 2 * np.arctan2(sine, q[0]) / sine * q[1:]


def _inverse(q):
    return q * (1, -1, -1, -1)


class TurnPath:
    """A rotation as a function of time. It meets the unit quaternions (n, 4) at `times` and turns the shorter way."""

    def __init__(self, times, quaternions, rests):
        self.times = np.asarray(times, float)
        q = np.array(quaternions, float)
        q /= np.linalg.norm(q, axis=1)[:, None]
        for k in range(1, len(q)):
            if q[k] @ q[k - 1] < 0:
                q[k] = -q[k]
        self.q = q
        h = np.diff(self.times)
        chords = np.array([logarithm(multiply(_inverse(a), b)) for a, b in zip(q, q[1:])]).reshape(-1, 3)
        rates = chords / h[:, None]
        at_keys = np.zeros((len(q), 3))  # [rad/s], in the camera's axes
        if len(rates):
            at_keys[0], at_keys[-1] = rates[0], rates[-1]
        for k in range(1, len(rates)):
            rate = (h[k] * rates[k - 1] + h[k - 1] * rates[k]) / (h[k - 1] + h[k])
            before, after = np.linalg.norm(rates[k - 1]), np.linalg.norm(rates[k])
            if not before or not after:
                continue  # the rotation waits on one side, so its rate is 0 here
            # These limits keep either side from overshooting its keys: the rate falls where the turn reverses by more
            # than a right angle (to 0 at a full reversal), and contributes less than a quarter turn to each side.
            slowing = np.clip(1 + rates[k - 1] @ rates[k] / (before * after), 0.0, 1.0)
            limit = min(3 * before, 3 * after, _QUARTER / h[k - 1], _QUARTER / h[k])
            size = np.linalg.norm(rate)
            at_keys[k] = rate * (slowing * min(1.0, limit / size)) if size else 0.0
        at_keys[np.asarray(rests, bool)] = 0.0
        self.parts = []
        for k, step in enumerate(h):
            first, last = at_keys[k] * step / 3, at_keys[k + 1] * step / 3
            middle = multiply(multiply(exponential(-first), multiply(_inverse(q[k]), q[k + 1])),
                              exponential(-last))
            # The middle part may exceed half a turn where first and last turn against the chord. The shorter way
            # would then turn in the other direction, so the long logarithm is used.
            self.parts.append((first, _long_logarithm(middle), last))

    def at(self, time):
        if len(self.times) == 1:
            return self.q[0].copy()
        k, x = _piece(self.times, time)
        if x in (0.0, 1.0):
            return self.q[k + int(x)].copy()
        out = self.q[k]
        # Cumulative Bernstein polynomials of degree 3.
        for weight, part in zip((1 - (1 - x)**3, x * x * (3 - 2 * x), x**3), self.parts[k]):
            out = multiply(out, exponential(weight * part))
        return out / np.linalg.norm(out)


class FovPath:
    """A field of view [degrees] as a function of time. It interpolates log tan(fov / 2), so that a zoom looks even."""

    def __init__(self, times, fovs, rests):
        self.fovs = np.asarray(fovs, float)
        self.path = MonotonePath(times, np.log(np.tan(np.radians(self.fovs) / 2)), rests)

    def at(self, time):
        times = self.path.times
        exact = np.flatnonzero(times == np.clip(time, times[0], times[-1]))
        if len(exact):
            return float(self.fovs[exact[0]])
        return float(2 * np.degrees(np.arctan(np.exp(self.path.at(time)))))


class HeightPath:
    """A height of an orthographic picture [m] as a function of time. It interpolates the logarithm, so that a zoom
    looks even."""

    def __init__(self, times, heights, rests):
        self.heights = np.asarray(heights, float)
        self.path = MonotonePath(times, np.log(self.heights), rests)

    def at(self, time):
        times = self.path.times
        exact = np.flatnonzero(times == np.clip(time, times[0], times[-1]))
        return float(self.heights[exact[0]] if len(exact) else np.exp(self.path.at(time)))


class TangentPath:
    """The tangents of an off-axis picture (left, right, top, bottom) as a function of time."""

    def __init__(self, times, tangents, rests):
        self.paths = [MonotonePath(times, side, rests) for side in np.asarray(tangents, float).T]

    def at(self, time):
        return tuple(path.at(time) for path in self.paths)


def looking(eye, target, up):
    """Returns the unit quaternion of a camera (X right, Y down, Z forward) at `eye` that looks at `target`, with
    `up` towards the picture's top. Returns None if the eye is at the target or looks along `up`."""
    forward = np.asarray(target, float) - eye
    length = np.linalg.norm(forward)
    if not length > 0:
        return None
    forward = forward / length
    right = np.cross(forward, up)
    size = np.linalg.norm(right)
    if not size > 1e-9 * np.linalg.norm(up):
        return None
    right /= size
    from dspace.frames.poses import quaternion_of_matrix
    return quaternion_of_matrix(np.column_stack((right, np.cross(forward, right), forward)))
