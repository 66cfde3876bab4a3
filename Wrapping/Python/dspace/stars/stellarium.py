"""Stars of the package stellarium-data: some 600,000 of the Hipparcos and Tycho-2 catalogues."""
import os
import pathlib

import numpy as np

from dspace.errors import Corrupt, Io, NotFound
from dspace.stars.catalog import StarCatalog

STELLARIUM_PATH = "/usr/share/stellarium/stars/default"
_MAGIC = 0x835F040A
_PRECISE = np.dtype([("hip", "<u4"), ("x0", "<i4"), ("x1", "<i4"), ("color", "u1"), ("magnitude", "u1"), ("type", "<u2"),
                     ("dx0", "<i4"), ("dx1", "<i4"), ("parallax", "<i4")])  # 28 bytes
_SHORT = (("x0", 20, True), ("x1", 20, True), ("dx0", 14, True), ("dx1", 14, True), ("color", 7, False),
          ("magnitude", 5, False))  # bits of 10 bytes
_SHORT_BYTES = 10
_MOST_LEVELS = 7
_MOTION = 1e-4  # [arcsec/yr] of dx0, dx1
_PARALLAX = 1e-5  # [arcsec]


def _zones(level):
    """Corners (20 * 4^level, 3, 3) of the triangles of an icosahedron, each divided into four at the middles of its sides,
    in the order of the catalogue."""
    golden = 0.5 * (1.0 + 5.0 ** 0.5)
    b = 1.0 / (1.0 + golden * golden) ** 0.5
    a = b * golden
    corner = np.array([[a, -b, 0], [a, b, 0], [-a, b, 0], [-a, -b, 0], [0, a, -b], [0, a, b], [0, -a, b], [0, -a, -b],
                       [-b, 0, a], [b, 0, a], [b, 0, -a], [-b, 0, -a]])
    faces = ((1, 0, 10), (0, 1, 9), (0, 9, 6), (9, 8, 6), (0, 7, 10), (6, 7, 0), (7, 6, 3), (6, 8, 3), (11, 10, 7), (7, 3, 11),
             (3, 2, 11), (2, 3, 8), (10, 11, 4), (2, 4, 11), (5, 4, 2), (2, 8, 5), (4, 1, 10), (4, 5, 1), (5, 9, 1), (8, 9, 5))
    triangles = corner[np.array(faces)]
    for _ in range(level):
        first, second, third = triangles[:, 0], triangles[:, 1], triangles[:, 2]
        opposite = [each / np.linalg.norm(each, axis=1, keepdims=True)
                    for each in (second + third, third + first, first + second)]
        parts = ((first, opposite[2], opposite[1]), (opposite[2], second, opposite[0]), (opposite[1], opposite[0], third),
                 opposite)
        triangles = np.stack([np.stack(part, 1) for part in parts], 1).reshape(-1, 3, 3)
    return triangles


def _axes(triangles):
    """Of each zone its centre, the directions to the east and to the north of it; and the largest reach of a corner along
    one of them, where the corners are seen from the middle of the sphere."""
    centre = triangles.sum(axis=1)
    centre /= np.linalg.norm(centre, axis=1, keepdims=True)
    east = np.cross((0.0, 0.0, 1.0), centre)
    east /= np.linalg.norm(east, axis=1, keepdims=True)
    north = np.cross(centre, east)
    along = [np.einsum("zck,zk->zc", triangles, axis) for axis in (east, north)]
    ahead = np.sqrt(1.0 - along[0] ** 2 - along[1] ** 2)
    return centre, east, north, max(np.abs(along[0] / ahead).max(), np.abs(along[1] / ahead).max())


def _records(data, count, kind, label):
    """Columns of the stars' records, and the greatest value of x0 and x1."""
    size = _PRECISE.itemsize if kind == 0 else _SHORT_BYTES
    if len(data) != count * size:
        raise Corrupt(f"{label}: {len(data)} bytes follow its head; accepted: {count * size}, {size} for each of its {count} "
                      "stars", label)
    if kind == 0:
        found = np.frombuffer(data, _PRECISE)
        return {name: found[name].astype(float) for name in ("x0", "x1", "color", "magnitude", "dx0", "dx1", "parallax")}, 2**31 - 1
    bits = np.unpackbits(np.frombuffer(data, np.uint8).reshape(count, size), axis=1, bitorder="little")
    found, at = {"parallax": np.zeros(count)}, 0
    for name, width, signed in _SHORT:
        value = bits[:, at:at + width] @ (1 << np.arange(width))
        found[name] = (value - (signed * bits[:, at + width - 1].astype(np.int64) << width)).astype(float)
        at += width
    return found, 2**19 - 1


def _read(path):
    """Columns of one file: right ascension, declination [deg], V, B-V, proper motions and parallax [arcsec]."""
    label = f"file {str(path)!r}"
    data = path.read_bytes()
    if len(data) < 32:
        raise Corrupt(f"{label}: it has {len(data)} bytes; accepted: a star catalogue of Stellarium, of 32 and more", label)
    magic, kind, _, _, level = (int(each) for each in np.frombuffer(data, "<u4", 5))
    least, span, steps = (int(each) for each in np.frombuffer(data, "<i4", 3, 20))
    if magic != _MAGIC or kind not in (0, 1) or level > _MOST_LEVELS or span <= 0 or steps <= 0:
        raise Corrupt(f"{label}: it is no star catalogue of Stellarium of kind 0 or 1", label)
    zones = 20 * 4 ** level
    head = 32 + 4 * zones
    if len(data) < head:
        raise Corrupt(f"{label}: it ends within its head of {head} bytes", label)
    sizes = np.frombuffer(data, "<u4", zones, 32).astype(np.int64)
    found, most = _records(data[head:], int(sizes.sum()), kind, label)
    centre, east, north, reach = _axes(_zones(level))
    zone = np.repeat(np.arange(zones), sizes)
    x, y = (reach / most * found[name] for name in ("x0", "x1"))
    place = centre[zone] + x[:, None] * east[zone] + y[:, None] * north[zone]
    length = np.linalg.norm(place, axis=1)
    place /= length[:, None]
    # The motion of the place in the zone's plane, as the catalogue has it: (m + x (x . m)) times the length, of the proper
    # motion m. Found by comparison with Hipparcos' motions, which it gives back to a milliarcsecond a year.
    along = (x * found["dx0"] + y * found["dx1"]) / length ** 2
    magnitude = 1e-3 * (least + found["magnitude"] * span / steps)
    return np.stack([np.degrees(np.arctan2(place[:, 1], place[:, 0])) % 360.0,
                     np.degrees(np.arcsin(np.clip(place[:, 2], -1.0, 1.0))), magnitude, found["color"] * 4.0 / 127.0 - 0.5,
                     _MOTION * (found["dx0"] - x * along) / length, _MOTION * (found["dx1"] - y * along) / length,
                     np.maximum(_PARALLAX * found["parallax"], 0.0)])


def read_stellarium(path=STELLARIUM_PATH):
    """The star catalogues that the Debian package stellarium-data installs, as a StarCatalog of the epoch J2000: 603,000
    stars to about magnitude 10.5. The package is optional (246 MB) and read where it is, never copied.

    path: the folder. Its files stars_*.cat of the kinds 0 and 1 are read (Hipparcos; Tycho-2 to 0.05 magnitudes), those of
    fainter stars that Stellarium downloads are left out. Positions are within an arcsecond. Stars have no names."""
    folder = pathlib.Path(os.fspath(path))
    label = f"folder {str(folder)!r}"
    try:
        files = sorted(each for each in folder.glob("stars_[0-9]*_[01]v*.cat"))
        if not files:
            raise NotFound(f"{label}: it has no stars_*.cat; accepted: that of the package stellarium-data (apt-get install "
                           f"stellarium-data)", label)
        columns = np.concatenate([_read(each) for each in files], axis=1)
    except OSError as error:
        raise Io(f"{label}: {error.strerror}", label) from None
    return StarCatalog(*columns)
