"""Lines of the sky: grids and the figures of constellations, as points on a far sphere."""
import json

import numpy as np

from dspace._core.fields import file_path, number, reject, word
from dspace.errors import Corrupt, Io, NotFound
from dspace.stars.constellation_names import NAMES

RADIUS = 1e17  # [m]: a step of one astronomical unit moves the lines by 0.3 arcsec
OBLIQUITY = np.radians(84381.448 / 3600.0)  # of the ecliptic of J2000 (IAU 1976), as ECLIPJ2000 has it
GRID_COLORS = {"equatorial": (0.25, 0.35, 0.6), "ecliptic": (0.4, 0.33, 0.16), "horizon": (0.25, 0.5, 0.35)}
GRIDS = tuple(GRID_COLORS)
_STEP = np.radians(2.0)  # of the pieces of curves


def directions(longitude_deg, latitude_deg):
    """Unit vectors (n, 3): X to longitude 0, Z to the pole."""
    lon, lat = np.radians(longitude_deg), np.radians(latitude_deg)
    return np.stack(np.broadcast_arrays(np.cos(lat) * np.cos(lon), np.cos(lat) * np.sin(lon), np.sin(lat)), -1)


def great_arc(a, b):
    """Unit vectors from a to b along the shorter arc, at most 2 degrees apart."""
    angle = np.arctan2(np.linalg.norm(np.cross(a, b)), np.dot(a, b))
    count = max(1, int(np.ceil(angle / _STEP)))
    t = np.linspace(0.0, 1.0, count + 1)[:, None]
    if angle < 1e-9:
        return np.stack([a, b])
    return (np.sin((1.0 - t) * angle) * a + np.sin(t * angle) * b) / np.sin(angle)


def joined(curves):
    """Points (n, 3) [m] and pairs of their indices (k, 2) of curves of unit vectors."""
    points, lines, first = [], [], 0
    for curve in curves:
        points.append(RADIUS * np.asarray(curve))
        index = np.arange(first, first + len(curve) - 1)
        lines.append(np.stack([index, index + 1], 1))
        first += len(curve)
    return np.concatenate(points), np.concatenate(lines)


def grid(kind, step_deg, about):
    """Meridians and parallels every `step_deg`: of right ascension and declination, of ecliptic longitude and latitude in
    equatorial axes, or of azimuth and elevation in axes X east, Y north, Z up. Points and lines as joined() has them."""
    word(kind, {name: i for i, name in enumerate(GRIDS)}, "kind", about)
    step = number(step_deg, "step_deg", about)
    if not 1.0 <= step <= 90.0 or abs(90.0 / step - round(90.0 / step)) > 1e-9:
        reject(about, "step_deg", step_deg, "1 to 90 degrees, a whole part of 90")
    curves = []
    for longitude in np.arange(0.0, 360.0 - 1e-9, step):
        whole = longitude % 90.0 == 0.0  # the others end before the poles, where they would crowd
        curves.append(directions(longitude, np.linspace(-1.0, 1.0, 91) * (90.0 if whole else max(90.0 - step, step))))
    for latitude in np.arange(-90.0 + step, 90.0 - 1e-9, step):
        curves.append(directions(np.linspace(0.0, 360.0, 181), latitude))
    points, lines = joined(curves)
    if kind == "ecliptic":
        c, s = np.cos(OBLIQUITY), np.sin(OBLIQUITY)
        points = points @ np.array([[1, 0, 0], [0, c, -s], [0, s, c]]).T
    return points, lines


def figures(path):
    """The figures of a GeoJSON file whose longitudes are right ascensions and whose latitudes are declinations [deg], such
    as constellations.lines.json of d3-celestial (O. Frohn, BSD-3): of each its id and arrays of unit vectors, a line each."""
    path = file_path(path, "the path", "constellations")
    label = f"file {path!r}"
    found = []
    try:
        with open(path, encoding="utf-8") as file:
            given = json.load(file)
        for name, geometry in [(feature.get("id", "?"), feature["geometry"]) for feature in given["features"]]:
            if geometry["type"] not in ("LineString", "MultiLineString"):
                raise Corrupt(f"{label}: the geometry of {name!r} is a {geometry['type']}; accepted: LineString, "
                              f"MultiLineString", label)
            rows = [geometry["coordinates"]] if geometry["type"] == "LineString" else geometry["coordinates"]
            found.append((str(name), []))
            for row in rows:
                at = np.array(row, float)
                if at.ndim != 2 or at.shape[1] < 2 or len(at) < 2 or not np.all(np.abs(at[:, 1]) <= 90.0):
                    raise Corrupt(f"{label}: a line of {name!r} has no two places of right ascension and declination", label)
                found[-1][1].append(directions(at[:, 0], at[:, 1]))
    except Corrupt:
        raise
    except FileNotFoundError:
        raise NotFound(f"{label}: it does not exist", label) from None
    except OSError as error:
        raise Io(f"{label}: {error.strerror}", label) from None
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        raise Corrupt(f"{label}: it is no GeoJSON of lines ({error})", label) from None
    if not any(lines for _, lines in found):
        raise Corrupt(f"{label}: it has no lines; accepted: one or more", label)
    return found


def constellations(path):
    """The lines of figures(), as arcs of great circles. Points and lines as joined() has them."""
    return joined([great_arc(a, b) for _, lines in figures(path) for ends in lines for a, b in zip(ends[:-1], ends[1:])])


def constellation_names(path):
    """Of each of figures(): the constellation's Latin name, or its id where that is no IAU abbreviation, and a unit vector
    to the middle of its places, each counted once."""
    places = []
    for name, lines in figures(path):
        if lines:
            middle = np.unique(np.concatenate(lines).round(9), axis=0).mean(axis=0)
            places.append((NAMES.get(name, name), middle / np.linalg.norm(middle)))
    return places
