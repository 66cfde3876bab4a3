"""A smooth curve through way points, its arc length and a vehicle's motion along it."""
from dataclasses import dataclass

import numpy as np

from dspace.errors import InvalidArgument, WrongType
from .rotations import packed


@dataclass
class PathPose:
    """The pose of a vehicle's reference point on a path. Heading counter-clockwise from +X."""
    x: float  # [m]
    y: float  # [m]
    heading_deg: float
    curvature: float = 0.0  # [1/m], positive to the left
    distance: float = 0.0  # along the path [m]
    speed: float = 0.0  # [m/s]
    time: float = 0.0  # [s]
    path: object = None  # the Path it lies on, or None


def as_pose(pose):
    """A PathPose from itself or from (x, y, heading_deg[, curvature[, distance]])."""
    if isinstance(pose, PathPose):
        return pose
    try:
        numbers = [float(value) for value in pose]
    except (TypeError, ValueError):
        numbers = []
    if not 3 <= len(numbers) <= 5 or not np.isfinite(numbers).all():
        raise WrongType(f"vehicle: the pose is {pose!r}; accepted: a PathPose, or 3 to 5 finite numbers: x, y, heading_deg, "
                        "curvature, distance")
    return PathPose(*numbers)


class Path:
    """Natural cubic spline through way points (n >= 2, x and y in metres) over their cumulative
    chord length: continuous position, heading and curvature. Arc length by Gauss-Legendre
    quadrature, good to about 1e-9 of the length. Motion: from rest at constant acceleration to
    `speed` within `ramp` seconds, and to rest again at the end (ramp 0: constant speed)."""

    _NODES, _WEIGHTS = np.polynomial.legendre.leggauss(8)

    def __init__(self, way_points, speed=0.5, ramp=0.0):
        p = np.asarray(way_points, float)
        if p.ndim != 2 or p.shape[1] != 2 or len(p) < 2 or not np.isfinite(p).all():
            raise InvalidArgument(f"path: way points of shape {p.shape}; expected finite (n >= 2, 2)")
        step = np.linalg.norm(np.diff(p, axis=0), axis=1)
        if not (step > 0).all():
            raise InvalidArgument("path: two successive way points coincide")
        if not speed > 0 or ramp < 0:
            raise InvalidArgument(f"path: speed {speed}, ramp {ramp}; expected speed > 0 and ramp >= 0")
        self.way_points, self.speed = p, float(speed)
        self._u = np.concatenate([[0], np.cumsum(step)])
        self._c = self._coefficients(p, step)
        # Arc length at the ends of 32 pieces a segment.
        self._grid = np.concatenate([np.linspace(a, b, 33)[:-1] for a, b in zip(self._u, self._u[1:])]
                                    + [self._u[-1:]])
        mid, half = (self._grid[1:] + self._grid[:-1]) / 2, np.diff(self._grid) / 2
        at = mid[:, None] + half[:, None] * self._NODES
        rate = np.linalg.norm(self._derivative(at.ravel(), 1), axis=1).reshape(at.shape)
        self._arc = np.concatenate([[0], np.cumsum(half * (rate @ self._WEIGHTS))])
        self.length = float(self._arc[-1])
        # A ramp too long for the path is shortened, so that the speed is just reached.
        self.ramp = min(float(ramp), self.length / self.speed)
        self.duration = self.length / self.speed + self.ramp
        self._travel = {}

    @staticmethod
    def _coefficients(p, h):
        """Per segment, the polynomial's four coefficients in the distance from its start."""
        n = len(p)
        m = np.zeros((n, 2))  # second derivatives, zero at both ends
        if n > 2:
            a = np.diag(2 * (h[:-1] + h[1:])) + np.diag(h[1:-1], 1) + np.diag(h[1:-1], -1)
            slope = np.diff(p, axis=0) / h[:, None]
            m[1:-1] = np.linalg.solve(a, 6 * np.diff(slope, axis=0))
        h = h[:, None]
        first = np.diff(p, axis=0) / h - h * (2 * m[:-1] + m[1:]) / 6
        return np.stack([p[:-1], first, m[:-1] / 2, np.diff(m, axis=0) / (6 * h)])

    def _derivative(self, u, order):
        k = np.clip(np.searchsorted(self._u, u, side="right") - 1, 0, len(self._u) - 2)
        t = (u - self._u[k])[:, None]
        a, b, c, d = (q[k] for q in self._c)
        if order == 0:
            return a + t * (b + t * (c + t * d))
        return b + t * (2 * c + 3 * t * d) if order == 1 else 2 * c + 6 * t * d

    def _parameter(self, s):
        """Spline parameter at arc lengths s: table, then Newton on the quadrature."""
        u = np.interp(s, self._arc, self._grid)
        for _ in range(4):
            k = np.clip(np.searchsorted(self._grid, u, side="right") - 1, 0, len(self._grid) - 2)
            half = (u - self._grid[k]) / 2
            at = self._grid[k][:, None] + half[:, None] * (1 + self._NODES)
            rate = np.linalg.norm(self._derivative(at.ravel(), 1), axis=1).reshape(at.shape)
            here = self._arc[k] + half * (rate @ self._WEIGHTS)
            u = u - (here - s) / np.linalg.norm(self._derivative(u, 1), axis=1)
            u = np.clip(u, 0, self._u[-1])
        return u

    def sample(self, s):
        """(x, y, heading [rad], curvature) arrays at arc lengths s (n,) [m], clipped to the path."""
        s = np.clip(np.asarray(s, float), 0, self.length)
        u = self._parameter(s)
        p, d, dd = (self._derivative(u, k) for k in range(3))
        rate = np.linalg.norm(d, axis=1)
        return p[:, 0], p[:, 1], np.arctan2(packed(d[:, 1]), packed(d[:, 0])), (d[:, 0] * dd[:, 1] - d[:, 1] * dd[:, 0]) / rate ** 3

    def distance(self, t):
        """Arc length [m] at time t [s]; the ends are kept before and after the motion."""
        t = np.clip(np.asarray(t, float), 0, self.duration)
        r, v = self.ramp, self.speed
        if r == 0:
            return v * t
        left = self.duration - t
        return np.where(t < r, v * t * t / (2 * r),
                        np.where(left < r, self.length - v * left * left / (2 * r), v * (t - r / 2)))

    def poses(self, times):
        """PathPoses at the times [s]."""
        times = np.atleast_1d(np.asarray(times, float))
        s = self.distance(times)
        x, y, heading, curvature = self.sample(s)
        if self.ramp:
            v = self.speed * np.clip(np.minimum(times, self.duration - times) / self.ramp, 0, 1)
        else:
            v = np.where((times >= 0) & (times <= self.duration), self.speed, 0.0)
        return [PathPose(*row, path=self) for row in
                zip(x, y, np.degrees(heading), curvature, s, v, times)]

    def pose(self, time):
        """PathPose at one time [s]."""
        return self.poses([time])[0]

    @property
    def maximum_curvature(self):
        """Largest absolute curvature [1/m], sampled at 32 points a segment."""
        return float(np.abs(self.sample(self._arc)[3]).max())

    def travel(self, dx, dy, s):
        """Length [m] of the plane curve that a point fixed dx ahead and dy left of the reference
        point has run when the reference point has run s: the integral of
        sqrt((1 - k dy)^2 + (k dx)^2) ds."""
        key = (round(float(dx), 9), round(float(dy), 9))
        if key not in self._travel:
            fine = np.linspace(0, self.length, 8 * len(self._grid) + 1)
            k = self.sample(fine)[3]
            rate = np.hypot(1 - k * dy, k * dx)
            step = np.diff(fine)
            self._travel[key] = (fine, np.concatenate([[0], np.cumsum(step * (rate[1:] + rate[:-1]) / 2)]))
        return np.interp(s, *self._travel[key])
