"""The coordinates of places on terrain."""
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Coordinates:
    """The coordinates of one place (numbers and arrays of shape (3,)), or of several (arrays of shape (...) and
    (..., 3)). longitude to body_fixed are NaN where the terrain's CRS has no longitude and latitude, and
    inertial where it tells no known body, or how the body turns at the scene's time is not known."""
    longitude: object  # [deg] east, -180 to 180
    latitude: object  # [deg] geodetic: of the normal of the CRS's ellipsoid
    height: object  # [m] above the CRS's ellipsoid or sphere
    body_fixed: np.ndarray  # from the body's center, Z to its north pole, X to longitude 0 [m]
    map: np.ndarray  # x, y in the terrain's CRS, and height above its vertical datum [m]
    root: np.ndarray  # in the scene's root [m]
    inertial: np.ndarray  # body_fixed in the axes of J2000 at the scene's time, from the body's center [m]


def coordinates_of(points, shape=()):
    """Converts Coordinates messages."""
    def vectors(name):
        given = [getattr(point, name) if point.HasField(name) else None for point in points]
        return np.array([[v.x, v.y, v.z] if v else [np.nan] * 3 for v in given], dtype=float).reshape(shape + (3,))

    def scalars(name):
        array = np.array([getattr(point, name) for point in points], dtype=float).reshape(shape)
        return float(array) if shape == () else array
    return Coordinates(scalars("longitude_deg"), scalars("latitude_deg"), scalars("height"),
                       vectors("body_fixed"), vectors("map"), vectors("root"), vectors("inertial"))
