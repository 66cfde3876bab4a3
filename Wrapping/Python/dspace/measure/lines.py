"""Distances, profiles, areas and angles between points of a scene."""
import numpy as np

from dspace._core.fields import array_of, integer, reject
from dspace.errors import InvalidArgument, Unsupported, WrongType
from dspace.measure.results import MeasuredArea, MeasuredLine, Profile
from dspace.terrain.terrain import Terrain

MOST_POINTS = 10_000
MOST_SAMPLES = 1_000_000


class Lines:
    """Measures distances, profiles, areas and angles for a Scene, which delegates to it."""

    def __init__(self, scene):
        self._scene = scene

    def measure_line(self, points, terrain=None, *, frame=None, samples=1024):
        """Measures the line through points. Returns a MeasuredLine.

        points: an array (n, 3) [m] in `frame` (default: the root), n of 2 to 10,000. terrain: a Terrain, or its name: the
        line is also measured along its ground, below and above the points along the local vertical. Points are then also
        (n, 2): map x and y, on the ground. On a degree grid the legs are geodesics of its ellipsoid; on any other map they
        are straight in the map, and are measured on the ellipsoid where the CRS has one. samples: of the profile in all, n to
        a million; they are spread over the legs by their lengths, and each point is one.

        Raises dspace.InvalidArgument for points that are not finite or a leg without length."""
        about = "measured line"
        terrain = self._terrain_of(terrain, about)
        if not 2 <= integer(samples, "samples", about) <= MOST_SAMPLES:
            reject(about, "samples", samples, f"2 to {MOST_SAMPLES}")
        points, map_ = self._points(points, terrain, frame, about, 2)
        legs = np.linalg.norm(np.diff(points, axis=0), axis=1)
        if terrain is None:
            _require_legs(legs, about)
            return MeasuredLine(points, legs)
        ground = _Ground(terrain)
        distance, azimuth = ground.between(map_[:-1], map_[1:])
        _require_legs(distance, about)
        counts = np.maximum(1, np.round(distance / distance.sum() * (samples - 1)).astype(int))
        along = [ground.along(map_[i], map_[i + 1], distance[i], azimuth[i], counts[i]) for i in range(len(counts))]
        places = np.concatenate([each[:-1] for each in along] + [map_[-1:, :2]])
        steps = ground.between(places[:-1], places[1:])[0]
        height, slope = (np.atleast_1d(query(places[:, 0], places[:, 1], map=True))
                         for query in (terrain.height, terrain.slope_deg))
        on_ground = np.column_stack((places, height))
        known = np.isfinite(height)
        root = np.full_like(on_ground, np.nan)
        if known.any():
            root[known] = terrain.locate(on_ground[known], map=True).root
        ends = np.concatenate(([0], np.cumsum(counts)))
        along_map = np.concatenate(([0.0], np.cumsum(steps)))
        profile = Profile(along_map, height, slope, on_ground, root)
        return MeasuredLine(points, legs, terrain.name, np.diff(along_map[ends]), azimuth, np.diff(height[ends]), profile)

    def measure_area(self, points, terrain=None, *, frame=None, samples=10_000):
        """Measures the polygon with corners at points, in either order. Returns a MeasuredArea.

        points, terrain, frame: as for measure_line(), with n of 3 to 10,000. Without a terrain the points must lie in one
        plane to 1e-6 of their extent. With one the area is that on the ellipsoid with geodesics as edges, or in the map
        where its CRS has none; `samples` places (100 to a million) of a grid within it give heights and slopes.

        Raises dspace.InvalidArgument for edges that cross, for corners on one line, and for corners that lie in no plane."""
        about = "measured area"
        terrain = self._terrain_of(terrain, about)
        if not 100 <= integer(samples, "samples", about) <= MOST_SAMPLES:
            reject(about, "samples", samples, f"100 to {MOST_SAMPLES}")
        points, map_ = self._points(points, terrain, frame, about, 3)
        edges = np.linalg.norm(points - np.roll(points, -1, axis=0), axis=1)
        if terrain is None:
            flat = _in_plane(points, about)
            _require_simple(flat, about)
            return MeasuredArea(points, _shoelace(flat), edges.sum())
        ground = _Ground(terrain)
        corners = ground.unrolled(map_[:, :2])
        _require_simple(corners, about)
        area, perimeter = ground.polygon(corners)
        places, weights = ground.inside(corners, samples)
        height, slope = (np.atleast_1d(query(places[:, 0], places[:, 1], map=True))
                         for query in (terrain.height, terrain.slope_deg))
        return MeasuredArea(points, area, perimeter, terrain.name, *_statistics(area, height, slope, weights))

    def measure_angle(self, a, b, c, *, frame=None):
        """Returns the angle [deg] at b between the directions to a and to c, 0 to 180: points (3,) [m] in `frame` (default:
        the root), Frames, or paths of frames (their origins). Raises dspace.InvalidArgument where two are at one place."""
        about = "measured angle"
        a, b, c = (self._place(each, name, frame, about) for each, name in ((a, "a"), (b, "b"), (c, "c")))
        first, second = a - b, c - b
        for way, name in ((first, "a"), (second, "c")):
            if not np.linalg.norm(way) > 0:
                raise InvalidArgument(f"{about}: b and {name} are at one place; accepted: three places", about)
        # Accurate for small and for flat angles (W. Kahan, "How futile are mindless assessments of roundoff", 2006).
        first, second = first / np.linalg.norm(first), second / np.linalg.norm(second)
        return float(np.degrees(2 * np.arctan2(np.linalg.norm(first - second), np.linalg.norm(first + second))))

    # --- Arguments -----------------------------------------------------------------------------

    def _terrain_of(self, terrain, about):
        if terrain is None or isinstance(terrain, Terrain):
            if terrain is not None:
                self._scene._require_own(terrain, f"terrain {terrain.name!r}", about)
            return terrain
        if not isinstance(terrain, str):
            reject(about, "the terrain", terrain, "a Terrain, or the name of one", WrongType)
        return self._scene.terrains[terrain]

    def _points(self, points, terrain, frame, about, least):
        """Points in the root, and (x, y, height) in the terrain's map (None without one)."""
        accepted = "an array (n, 3) [m]" + ("" if terrain is None else ", or (n, 2) of map x and y")
        given = array_of(points, "the points", accepted, about)
        widths = (3,) if terrain is None else (2, 3)
        if given.ndim != 2 or given.shape[1] not in widths or not least <= len(given) <= MOST_POINTS:
            raise InvalidArgument(f"{about}: the points have the shape {given.shape}; accepted: {accepted}, n of {least} to "
                                  f"{MOST_POINTS}", about)
        if not np.isfinite(given).all():
            wrong = int(np.flatnonzero(~np.isfinite(given).all(axis=1))[0])
            raise InvalidArgument(f"{about}: point {wrong} is {given[wrong].tolist()}; accepted: finite numbers", about)
        if given.shape[1] == 2:
            height = np.atleast_1d(terrain.height(given[:, 0], given[:, 1], map=True))
            if not np.isfinite(height).all():
                wrong = int(np.flatnonzero(~np.isfinite(height))[0])
                raise InvalidArgument(f"{about}: point {wrong} at map {given[wrong].tolist()} is not on data of terrain "
                                      f"{terrain.name!r}; accepted: places with data", about)
            map_ = np.column_stack((given, height))
            return terrain.locate(map_, map=True).root, map_
        root = self._scene.root
        at = root if frame is None else self._scene._frame_of(self._scene._frame_id(frame))
        points = at.world_pose.apply(given)
        if terrain is None:
            return points, None
        return points, terrain.to_map(terrain.frame.world_pose.inverse().apply(points))

    def _place(self, place, name, frame, about):
        if isinstance(place, (list, tuple, np.ndarray)):
            return self._points(np.reshape(array_of(place, name, "a point (3,) [m]", about), (1, -1)), None, frame, about, 1)[0][0]
        return self._scene._frame_of(self._scene._frame_id(place)).world_pose.position


class _Ground:
    """Distances on the map of a terrain: on its ellipsoid, or in the plane of a map without one."""

    def __init__(self, terrain):
        self._terrain = terrain
        in_degrees = terrain._map_is_in_degrees()
        self._has_degrees, self.is_degree_grid = in_degrees is not None, bool(in_degrees)

    def _degrees(self, places):
        if self.is_degree_grid:
            return np.array(places[:, :2])
        located = self._terrain.locate(np.column_stack((places[:, :2], np.zeros(len(places)))), map=True)
        return np.column_stack((located.longitude, located.latitude))

    def between(self, starts, ends):
        """Lengths [m] and azimuths at the starts [deg] of lines between map places."""
        if self._has_degrees:
            lines = self._terrain.geodesy.inverse(self._degrees(starts), self._degrees(ends))
            return np.atleast_1d(lines.distance), np.atleast_1d(lines.azimuth_deg)
        way = ends[:, :2] - starts[:, :2]
        return np.hypot(way[:, 0], way[:, 1]), np.degrees(np.arctan2(way[:, 0], way[:, 1])) % 360

    def along(self, start, end, distance, azimuth, count):
        """Map places (count + 1, 2) from the start to the end."""
        share = np.linspace(0.0, 1.0, count + 1)
        if not self.is_degree_grid:
            return start[:2] + share[:, None] * (end[:2] - start[:2])
        places = self._terrain.geodesy.direct(start[:2], azimuth, share * distance).place
        places[:, 0] += start[0] - places[0, 0]  # the turn of the start
        return np.column_stack((np.unwrap(places[:, 0], period=360), places[:, 1]))

    def unrolled(self, corners):
        """Corners on one turn of longitude, so that neighbours are within 180 degrees."""
        if not self.is_degree_grid:
            return corners
        x = np.unwrap(np.append(corners[:, 0], corners[0, 0]), period=360)
        if abs(x[-1] - x[0]) > 180:
            raise Unsupported("the polygon goes around a pole of a degree grid; accepted: terrain.geodesy.polygon(places) "
                              "for its area", "measured area")
        return np.column_stack((x[:-1], corners[:, 1]))

    def polygon(self, corners):
        """Area [m^2] and perimeter [m]."""
        if self._has_degrees:
            polygon = self._terrain.geodesy.polygon(self._degrees(corners))
            return polygon.area, polygon.perimeter
        return _shoelace(corners), np.linalg.norm(corners - np.roll(corners, -1, axis=0), axis=1).sum()

    def inside(self, corners, samples):
        """Some `samples` places of a grid within the polygon, and the share of the area that each stands for."""
        low, high = corners.min(axis=0), corners.max(axis=0)
        part = max(_shoelace(corners) / np.prod(high - low), 1e-3)
        side = np.sqrt(np.prod(high - low) * part / samples)
        counts = np.clip(np.ceil((high - low) / side), 1, 4 * MOST_SAMPLES ** 0.5).astype(int)
        x, y = (low[k] + (np.arange(counts[k]) + 0.5) * (high[k] - low[k]) / counts[k] for k in (0, 1))
        places = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
        places = places[_within(places, corners)]
        if not len(places):
            places = corners.mean(axis=0)[None]
        if self.is_degree_grid:
            weights = np.cos(np.radians(places[:, 1]))
        elif self._has_degrees:  # what a map's cell covers of the body
            a, b = (self._body(places + step) - self._body(places - step) for step in 0.01 * np.diag(high - low) / counts)
            weights = np.linalg.norm(np.cross(a, b), axis=1)
        else:
            weights = np.ones(len(places))
        return places, weights / weights.sum()

    def _body(self, places):
        return self._terrain.locate(np.column_stack((places, np.zeros(len(places)))), map=True).body_fixed


def _statistics(area, height, slope, weights):
    known = np.isfinite(height) & np.isfinite(slope)
    covered = min(1.0, float(weights[known].sum()))
    if not covered > 0:
        return (0.0,) + (np.nan,) * 5
    share = weights[known] / covered
    return (covered, area * float(np.sum(share / np.cos(np.radians(slope[known])))), float(height[known].min()),
            float(np.sum(share * height[known])), float(height[known].max()), float(np.sum(share * slope[known])))


def _require_legs(lengths, about):
    if not (lengths > 0).all():
        wrong = int(np.flatnonzero(~(lengths > 0))[0])
        raise InvalidArgument(f"{about}: points {wrong} and {wrong + 1} are at one place; accepted: legs with a length", about)


def _in_plane(points, about):
    """The corners in axes of the plane through them."""
    middle = points.mean(axis=0)
    _, sizes, axes = np.linalg.svd(points - middle)
    if not sizes[1] > 1e-12 * sizes[0]:
        raise InvalidArgument(f"{about}: the corners lie on one line; accepted: corners of a polygon", about)
    if sizes[2] > 1e-6 * sizes[0]:
        raise InvalidArgument(f"{about}: the corners lie in no plane (they are {sizes[2]:.6g} m off the nearest one, root of the "
                              "sum of squares); accepted: corners in one plane, or a terrain", about)
    return (points - middle) @ axes[:2].T


def _shoelace(corners):
    x, y = (corners - corners[0]).T
    return float(abs(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1))) / 2)


def _side(a, b, c):
    """The sign of the turn from a over b to c; arrays broadcast."""
    return np.sign((b[..., 0] - a[..., 0]) * (c[..., 1] - a[..., 1]) - (b[..., 1] - a[..., 1]) * (c[..., 0] - a[..., 0]))


def _require_simple(corners, about):
    """Edges must not cross, and corners not lie on one line."""
    if not _shoelace(corners) > 0:
        raise InvalidArgument(f"{about}: the corners enclose no area; accepted: corners of a polygon", about)
    count = len(corners)
    ends = np.roll(corners, -1, axis=0)
    for i in range(count - 2):
        others = np.arange(i + 2, count - (i == 0))
        a, b, c, d = corners[i], ends[i], corners[others], ends[others]
        crossed = (_side(a, b, c) * _side(a, b, d) < 0) & (_side(c, d, a) * _side(c, d, b) < 0)
        if crossed.any():
            other = int(others[np.flatnonzero(crossed)[0]])
            raise InvalidArgument(f"{about}: the edges after points {i} and {other} cross; accepted: a polygon whose edges do "
                                  "not cross", about)


def _within(places, corners):
    """Whether places are within a polygon: an odd number of edges is crossed by a ray to the right."""
    inside = np.zeros(len(places), bool)
    x, y = places.T
    for (ax, ay), (bx, by) in zip(corners, np.roll(corners, -1, axis=0)):
        if ay != by:
            inside ^= ((ay > y) != (by > y)) & (x < ax + (y - ay) * (bx - ax) / (by - ay))
    return inside
