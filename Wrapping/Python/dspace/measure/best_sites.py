"""The best-lit places around a point, from illumination maps."""
from dataclasses import dataclass

import numpy as np

from dspace._core.fields import array_of, integer, items, number, put, real, reject, text, word
from dspace.errors import InvalidArgument
from dspace.measure.map_file import MapFile
from dspace.terrain.site import Site
from dspace.terrain.terrain import Terrain

MOST_SITES = 10_000
ROWS = 256  # of a map that are read at once
# The quantity that ranks, and whether more of it is better; the other one decides between equals.
ORDERS = {"lit_fraction": (("lit_fraction", True), ("longest_night", False)),
          "longest_night": (("longest_night", False), ("lit_fraction", True))}
READ = ("lit_fraction", "longest_night", "earth_fraction")


@dataclass(frozen=True)
class BestSite:
    """A cell of an illumination map that is lit well.

    rank: from 1 on, among the sites of its mast. mast: its height above the ground [m], that of the map. x, y: map coordinates.
    ground: height of the ground above the datum [m]. slope_deg: of the ground over two cells. distance: from the centre along the
    ground [m]. lit_fraction (0 to 1), longest_night [s], earth_fraction (0 to 1): of the map; None where it lacks the quantity."""
    rank: int
    mast: float
    x: float
    y: float
    ground: float
    slope_deg: float
    distance: float
    lit_fraction: float | None
    longest_night: float | None
    earth_fraction: float | None


class BestSites:
    """Finds the best sites for a Scene, which delegates to it."""

    def __init__(self, scene):
        self._scene = scene

    def best_sites(self, terrain, maps, *, center, radius, apart=0.0, count=10, most_slope=None, least_lit=None,
                   most_night=None, order="lit_fraction"):
        """Ranks the cells of illumination maps within a radius. Returns a list of BestSite, for one mast height after the other, the
        best first.

        terrain: a Terrain or its name, on which the maps were made. maps: an illumination map (MapFile, or its path), or several of
        different mast heights: a map's height is that of its horizon map. center: map x, y (longitude and latitude of a degree
        grid). radius: [m], along the ground. apart: the least distance between two sites of a mast [m], 0 or more. count: the most
        sites of a mast, 1 to 10,000. most_slope [deg], least_lit (0 to 1), most_night [s]: what cells must satisfy; None: no limit.
        order: "lit_fraction" (greatest first, among equals the shortest night) or "longest_night" (shortest first, among equals the
        best lit).

        The best cell is taken, then the best of those that are far enough from all that were taken, and so on. Distances are those
        of places at height 0 of the datum, on a body around its sphere. Raises dspace.InvalidArgument where no cell lies within the
        radius; dspace.NotFound and dspace.Corrupt for a file that is no map."""
        about = "best sites"
        terrain = self._terrain(terrain, about)
        found = [maps] if isinstance(maps, (MapFile, str)) or hasattr(maps, "__fspath__") else items(
            maps, "the maps", about, "illumination maps, or their paths")
        if not found:
            reject(about, "the maps", maps, "one or more")
        center = array_of(center, "the center", "map x, y", about)
        if center.shape != (2,) or not np.isfinite(center).all():
            reject(about, "the center", center.tolist(), "map x, y, finite numbers")
        for name, value in (("radius", radius), ("apart", apart)):
            if not 0.0 <= real(value, name, about) < np.inf or name == "radius" and value == 0.0:
                reject(about, name, value, "a finite number of metres, " + ("above 0" if name == "radius" else "0 or more"))
        if not 1 <= integer(count, "count", about) <= MOST_SITES:
            reject(about, "count", count, f"1 to {MOST_SITES}")
        limits = {name: None if value is None else number(value, name, about)
                  for name, value in (("most_slope", most_slope), ("least_lit", least_lit), ("most_night", most_night))}
        ranks = word(order, ORDERS, "the order", about)
        sites = []
        for each in found:
            made = each if isinstance(each, MapFile) else MapFile.open(each)
            sites += _best_of(terrain, made, center, float(radius), float(apart), count, limits, ranks, about)
        return sites

    def _terrain(self, terrain, about):
        if not isinstance(terrain, Terrain):
            terrain = self._scene.terrains[text(terrain, "the terrain", about, "a dspace.Terrain or its name")]
        self._scene._require_own(terrain, f"terrain {terrain.name!r}", about)
        return terrain


def _best_of(terrain, made, center, radius, apart, count, limits, ranks, about):
    metadata = made.metadata
    if metadata.get("DSPACE_KIND") != "illumination map":
        raise InvalidArgument(f"{about}: map {made.path!r} is {metadata.get('DSPACE_KIND', 'no map of Dspace')!r}; accepted: an illumination "
                              "map", made.path)
    names = made.bands
    needed = [ranks[0][0]] + [name for name, limit in (("lit_fraction", limits["least_lit"]), ("longest_night", limits["most_night"]))
                              if limit is not None]
    for name in needed:
        if name not in names:
            raise InvalidArgument(f"{about}: map {made.path!r} lacks the quantity {name!r}; it has {', '.join(names)}", made.path)
    ground = Ground(terrain, center)
    kept = [part for first in range(0, made.rows, ROWS) for part in _cells(ground, made, first, radius, limits)]
    if not kept:
        raise InvalidArgument(f"{about}: map {made.path!r} has no cell with ground within {radius:g} m of {center[0]:g}, {center[1]:g}; "
                              "accepted: a center and a radius that meet the map", made.path)
    cells = {name: np.concatenate([part[name] for part in kept]) for name in kept[0]}
    able = cells["able"]
    keys = []
    for name, more in reversed(ranks):
        if name in names:
            keys.append(-cells[name] if more else cells[name])
    # What is equal in all that counts comes in the order of the map.
    best = np.lexsort([np.arange(len(able)), *keys])
    best = best[able[best]]
    chosen, sites = [], []
    free = np.ones(len(best), bool)
    for k in range(count):
        left = np.flatnonzero(free)
        if not left.size:
            break
        at = best[left[0]]
        chosen.append(at)
        free[left[0]] = False
        if apart > 0.0:
            others = best[left]
            free[left[ground.between(cells["place"][at], cells["place"][others]) < apart]] = False
        values = {name: float(cells[name][at]) if name in names else None for name in READ}
        sites.append(BestSite(k + 1, float(metadata["DSPACE_HEIGHT_M"]), *(float(cells[name][at]) for name in (
            "x", "y", "ground", "slope", "distance")), **values))
    return sites


class Ground:
    """Distances along the ground of a terrain."""

    def __init__(self, terrain, center):
        self._terrain = terrain
        self.center = terrain.from_map([*center, 0.0])
        self._radius = np.linalg.norm(self.center) if terrain.on_body else None

    def places(self, x, y):
        """Of map coordinates, at height 0 of the datum."""
        return self._terrain.from_map(np.stack((x, y, np.zeros(np.shape(x))), axis=-1))

    def heights(self, x, y):
        return self._terrain.height(x, y, map=True)

    def between(self, a, b):
        straight = np.linalg.norm(a - b, axis=-1)
        if self._radius is None:
            return straight
        return 2.0 * self._radius * np.arcsin(np.minimum(0.5 * straight / self._radius, 1.0))


def _cells(ground, made, first, radius, limits):
    """The cells within the radius of some rows of a map, as a dict of arrays; nothing where there are none."""
    rows = min(ROWS, made.rows - first)
    x0, dx, bx, y0, by, dy = made.geotransform
    # One more cell all around, for slopes.
    c, r = np.meshgrid(np.arange(-1, made.columns + 1) + 0.5, np.arange(first - 1, first + rows + 1) + 0.5)
    x, y = x0 + dx * c + bx * r, y0 + by * c + dy * r
    place = ground.places(x, y)
    distance = ground.between(ground.center, place)[1:-1, 1:-1]
    within = distance <= radius
    if not within.any():
        return
    height = ground.heights(x, y)
    known = within & np.isfinite(height[1:-1, 1:-1])
    if not known.any():
        return
    slope = _slope(place, height)
    cells = {"place": place[1:-1, 1:-1][known], "x": x[1:-1, 1:-1][known], "y": y[1:-1, 1:-1][known], "slope": slope[known],
             "ground": height[1:-1, 1:-1][known], "distance": distance[known]}
    able = np.ones(known.sum(), bool)
    for name in READ:
        if name in made.bands:
            cells[name] = made.read(name, rows=(first, rows))[known].astype(float)
            able &= np.isfinite(cells[name])
    for name, limit, more in (("slope", limits["most_slope"], False), ("lit_fraction", limits["least_lit"], True),
                              ("longest_night", limits["most_night"], False)):
        if limit is not None:
            able &= cells[name] >= limit if more else cells[name] <= limit
    cells["able"] = able
    yield cells


def _slope(place, height):
    """Of the inner cells [deg]: differences over two cells, or over one beside ground without data."""
    def rise(axis):
        def part(values, shift):
            return np.roll(values, -shift, axis=axis)[1:-1, 1:-1]
        low = np.where(np.isnan(part(height, -1)), 0, -1)
        high = np.where(np.isnan(part(height, 1)), 0, 1)

        def pick(values, which, shift):
            chosen = which == shift
            return np.where(chosen if values.ndim == 2 else chosen[..., None], part(values, shift), values[1:-1, 1:-1])
        across = np.linalg.norm(pick(place, high, 1) - pick(place, low, -1), axis=-1)
        return (pick(height, high, 1) - pick(height, low, -1)) / np.where(across > 0.0, across, np.nan)
    return np.degrees(np.arctan(np.hypot(rise(0), rise(1))))


def extent_around(terrain, center, radius):
    """Map coordinates (left, top, right, bottom) around all that is within a radius [m] of a map point, for horizon_map(). What lies
    beyond the terrain is left out by the map itself."""
    about = f"terrain {terrain.name!r}"
    if not 0.0 < real(radius, "the radius", about) < np.inf:
        reject(about, "the radius", radius, "a finite number of metres above 0")
    x, y = center
    middle = terrain.from_map([x, y, 0.0])
    if not (terrain.on_body and terrain._map_is_in_degrees()):
        turn = np.radians(np.arange(0.0, 360.0, 1.0))
        level = np.column_stack((np.cos(turn), np.sin(turn), 0.0 * turn))
        reach = radius / np.cos(np.radians(0.5))
        if terrain.on_body:  # along great circles
            away = np.linalg.norm(middle)
            up = middle / away
            side = np.cross(up, np.eye(3)[np.argmin(np.abs(up))])
            side /= np.linalg.norm(side)
            level = level @ (side, np.cross(up, side), up)
            ring = away * (np.cos(reach / away) * up + np.sin(reach / away) * level)
        else:
            ring = middle + reach * level
        edge = terrain.to_map(ring)
        return edge[:, 0].min(), edge[:, 1].max(), edge[:, 0].max(), edge[:, 1].min()
    angle = np.degrees(radius / np.linalg.norm(middle)) * 1.01  # the ellipsoid's flattening is less
    left, _, right, _ = terrain.map_extent
    top, bottom = y + angle, y - angle
    if top < 90.0 and bottom > -90.0:
        wide = np.degrees(np.arcsin(min(1.0, np.sin(np.radians(angle)) / np.cos(np.radians(y)))))
        left, right = x - wide, x + wide
    return left, min(top, 90.0), right, max(bottom, -90.0)
