"""Geodesics, grid references and geoid heights."""
from dataclasses import dataclass

import numpy as np

from dspace._core import wire
from dspace._core.fields import array_of, items, put, put_given, reject, shown, text
from dspace._core.strict import Strict
from dspace.errors import InvalidArgument, WrongType

_ELLIPSOID = "'WGS84', or the equatorial radius [m] and the flattening"


@dataclass(frozen=True)
class Geodesic:
    """The shortest line between two places (numbers), or several lines (arrays)."""
    distance: object  # along the ellipsoid [m]
    azimuth_deg: object  # at the first place, clockwise from north, 0 to 360
    end_azimuth_deg: object  # of the same line at the second place


@dataclass(frozen=True)
class GeodesicEnd:
    """Where a geodesic ends (an array (2,) and a number), or several (arrays (..., 2) and (...))."""
    place: np.ndarray  # longitude (-180 to 180), latitude [deg]
    azimuth_deg: object  # of the line there, clockwise from north, 0 to 360


@dataclass(frozen=True)
class GeodesicPolygon:
    """A polygon of geodesics on the ellipsoid. area [m^2]: of the side that is no larger than half of it. perimeter [m]."""
    area: float
    perimeter: float


@dataclass(frozen=True)
class Utm:
    """UTM coordinates of one place (numbers), or of several (arrays)."""
    zone: object  # 1 to 60; 0: UPS, beyond latitudes -80 and 84
    north: object  # whether on the northern hemisphere
    easting: object  # [m]
    northing: object  # [m], in the south with the false northing of 10,000 km


class Geodesy(Strict):
    """Distances and grid references on one ellipsoid: scene.geodesy() and terrain.geodesy.

    Places are longitude and latitude [deg], (2,) or arrays (..., 2); east and north positive, latitude geodetic.
    Terrain.locate() gives those of points. Raises dspace.InvalidArgument for latitudes beyond 90 degrees and for values
    that are not finite, before anything is computed.

    Grid references and geoids are of WGS 84: dspace.Unsupported for other ellipsoids, such as another body's. GRS 80
    (NAD 83, ETRS 89) counts as WGS 84, from which it differs by 0.1 mm.
    """

    def __init__(self, scene, ellipsoid="WGS84", terrain=None):
        self._scene = scene
        self._terrain = terrain
        self._axes = None
        if terrain is None and not (isinstance(ellipsoid, str) and ellipsoid.upper().replace(" ", "") == "WGS84"):
            given = None if isinstance(ellipsoid, str) else array_of(ellipsoid, "the ellipsoid", _ELLIPSOID, "geodesy")
            if given is None or given.shape != (2,):
                reject("geodesy", "the ellipsoid", ellipsoid, _ELLIPSOID,
                       InvalidArgument if isinstance(ellipsoid, str) else WrongType)
            radius, flattening = given.tolist()
            if not 0 < radius <= 1e12:
                reject("geodesy", "the equatorial radius", radius, "above 0 to 1e12 m")
            if not 0 <= flattening <= 0.5:
                reject("geodesy", "the flattening", flattening, "0 (a sphere) to 0.5")
            self._axes = (radius, flattening)

    def _label(self):
        return "geodesy" if self._terrain is None else f"geodesy of terrain {self._terrain!r}"

    def _begin(self, kind):
        command = self._scene._command()
        message = getattr(command, kind)
        message.SetInParent()
        if self._terrain is not None:
            message.ellipsoid.terrain = self._terrain
        elif self._axes is not None:
            message.ellipsoid.axes.equatorial_radius, message.ellipsoid.axes.flattening = self._axes
        return command, message

    def _places(self, given, what):
        places = array_of(given, what, "longitude and latitude, an array (..., 2)", self._label)
        if places.shape[-1:] != (2,):
            raise InvalidArgument(f"{self._label()}: {what} has the shape {places.shape}; accepted: (..., 2), longitude "
                                  "and latitude", self._label())
        return places

    def _together(self, *named):
        try:
            return np.broadcast_arrays(*(array for _, array in named))
        except ValueError:
            shapes = ", ".join(f"{name} {array.shape}" for name, array in named)
            raise InvalidArgument(f"{self._label()}: the shapes do not fit: {shapes}; accepted: shapes that broadcast",
                                  self._label()) from None

    def inverse(self, a, b):
        """Returns the Geodesic from places a to places b, (..., 2), whose shapes broadcast: distance [m], azimuth and
        end azimuth. At opposite points, where several lines are equally short, one of them."""
        a, b = self._together(("a", self._places(a, "a")), ("b", self._places(b, "b")))
        command, message = self._begin("measure_geodesics")
        wire.put_array(message, "start", a)
        wire.put_array(message, "end", b)
        reply = self._scene._execute(command).geodesics
        return Geodesic(*(_shaped(getattr(reply, name), a.shape[:-1])
                          for name in ("distance", "azimuth_deg", "end_azimuth_deg")))

    def direct(self, a, azimuth_deg, distance):
        """Returns the GeodesicEnd of lines that start at places a, (..., 2), with azimuths [deg], clockwise from north,
        and distances [m], (...); the shapes broadcast. A negative distance goes backwards."""
        a = self._places(a, "a")
        azimuth, length = (array_of(value, name, "a number or an array of numbers", self._label)
                           for value, name in ((azimuth_deg, "azimuth_deg"), (distance, "distance")))
        longitude, latitude, azimuth, length = self._together(
            ("a", a[..., 0]), ("a", a[..., 1]), ("azimuth_deg", azimuth), ("distance", length))
        command, message = self._begin("follow_geodesics")
        wire.put_array(message, "start", np.stack((longitude, latitude), axis=-1))
        wire.put_array(message, "azimuth_deg", azimuth)
        wire.put_array(message, "distance", length)
        reply = self._scene._execute(command).geodesics
        return GeodesicEnd(np.array(reply.end).reshape(azimuth.shape + (2,)),
                           _shaped(reply.end_azimuth_deg, azimuth.shape))

    def polygon(self, places):
        """Returns the GeodesicPolygon with corners at places (n, 2), n of 3 or more, in either order, whose edges are
        geodesics; it may hold a pole. Edges that cross are not detected."""
        command, message = self._begin("measure_polygon")
        corners = self._places(places, "the corners")
        if corners.ndim != 2:
            raise InvalidArgument(f"{self._label()}: the corners have the shape {corners.shape}; accepted: (n, 2)",
                                  self._label())
        wire.put_array(message, "place", corners)
        reply = self._scene._execute(command).polygon
        return GeodesicPolygon(reply.area, reply.perimeter)

    def utm(self, places, zone=None):
        """Returns the Utm coordinates of places (..., 2): in their standard zones, with the exceptions of Norway and
        Svalbard, and UPS beyond latitudes -80 and 84; or in a given zone (0: UPS), near which they must lie."""
        places = self._places(places, "the places")
        command, message = self._begin("get_grid_references")
        wire.put_array(message, "place", places)
        put_given(message, self._label, zone=zone)
        reply = self._scene._execute(command).grid_references
        shape = places.shape[:-1]
        return Utm(_shaped(reply.zone, shape, int), _shaped(reply.north, shape, bool), _shaped(reply.easting, shape),
                   _shaped(reply.northing, shape))

    def from_utm(self, zone, north, easting, northing):
        """Returns the places (..., 2) of UTM coordinates (numbers or arrays whose shapes broadcast): zone 1 to 60, or 0
        for UPS; north: whether on the northern hemisphere; easting and northing [m]."""
        given = [("zone", np.asarray(zone)), ("north", np.asarray(north))]
        if given[0][1].dtype.kind not in "iu":
            reject(self._label, "zone", zone, "an integer, or an array of integers", WrongType)
        if given[1][1].dtype.kind != "b":
            reject(self._label, "north", north, "True or False, or an array of them", WrongType)
        given += [(name, array_of(value, name, "a number or an array of numbers", self._label))
                  for name, value in (("easting", easting), ("northing", northing))]
        zones, norths, eastings, northings = self._together(*given)
        if zones.size and not (0 <= zones.min() and zones.max() <= 60):
            wrong = zones[(zones < 0) | (zones > 60)].flat[0]
            reject(self._label, "zone", int(wrong), "1 to 60, or 0 for UPS about the poles")
        command, message = self._begin("find_grid_references")
        message.zone.extend(zones.ravel().tolist())
        message.north.extend(norths.ravel().tolist())
        wire.put_array(message, "easting", eastings)
        wire.put_array(message, "northing", northings)
        reply = self._scene._execute(command).geodetic_places
        return np.array(reply.place).reshape(zones.shape + (2,))

    def mgrs(self, places, precision=5):
        """Returns the MGRS references of places (..., 2): a str such as '38SMB4414084706', or an array of them.
        precision: digits of easting and of northing, 0 to 11; 5 is a metre."""
        places = self._places(places, "the places")
        command, message = self._begin("get_grid_references")
        wire.put_array(message, "place", places)
        put(message, self._label, mgrs_precision=precision)
        references = self._scene._execute(command).grid_references.mgrs
        return references[0] if places.ndim == 1 else np.array(references, dtype=str).reshape(places.shape[:-1])

    def from_mgrs(self, references):
        """Returns the places of the centres of MGRS squares: (2,) of a str, (..., 2) of an array or list of them."""
        accepted = "an MGRS reference such as '38SMB4488', or an array of them"
        shape = () if isinstance(references, str) else np.shape(references)
        if isinstance(references, str):
            references = [references]
        else:
            references = items(np.ravel(np.asarray(references, dtype=object)), "references", self._label, accepted)
        command, message = self._begin("find_grid_references")
        message.mgrs.extend(text(str(each) if isinstance(each, np.str_) else each, "a reference", self._label, accepted)
                            for each in references)
        return np.array(self._scene._execute(command).geodetic_places.place).reshape(shape + (2,))

    def geoid_height(self, places, geoid=None):
        """Returns the heights [m] of a geoid above WGS 84 at places (..., 2); NaN outside of its grid. The height above
        the geoid is the height above the ellipsoid less this.

        geoid: the file of a grid in PROJ's folders (".gtx" or ".tif"), interpolated bilinearly; default:
        "egm96_15.gtx", EGM96 every 15 minutes, which comes with PROJ and is within 1.2 m of EGM96, 4 cm on average. Or
        the name of data of GeographicLib, interpolated by cubics: "egm96-5", "egm2008-1", ..., which
        geographiclib-get-geoids installs. Raises dspace.NotFound, which names the file and the folders, for data that
        are absent."""
        places = self._places(places, "the places")
        command, message = self._begin("get_geoid_heights")
        wire.put_array(message, "place", places)
        if geoid is not None:
            put(message, self._label, geoid=geoid)
            if not geoid:
                reject(self._label, "geoid", geoid, "a name that is not empty")
        return _shaped(self._scene._execute(command).geoid_heights.height, places.shape[:-1])

    def __repr__(self):
        of = ("WGS 84" if self._axes is None else shown(self._axes)) if self._terrain is None else \
            f"terrain {self._terrain!r}"
        return f"<dspace.Geodesy of {of}>"


def _shaped(values, shape, kind=float):
    array = np.array(values, dtype=kind).reshape(shape)
    return kind(array) if shape == () else array
