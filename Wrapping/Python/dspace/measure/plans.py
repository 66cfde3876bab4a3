"""What measurements over time are about: places on bodies, panels, batteries."""
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class BodySite:
    """A place on a body (a name or NAIF id): longitude (east), latitude [deg], height [m] above the ellipsoid of its radii.
    geodetic=True: the latitude, and what is vertical there, are of the ellipsoid's normal (as maps of the Earth have it);
    False: of the direction from the body's centre."""
    body: object
    longitude_deg: float
    latitude_deg: float
    height: float = 0.0
    geodetic: bool = False


@dataclass(frozen=True)
class Orbiter:
    """A craft on a path about a body: a target of contacts. path: an OEM or .xyzv file, States, a Conic, or a Trajectory of a
    scene; in `axes` about the centre of `body` (a name or NAIF id). axes: a reference frame such as "J2000" or "MOON_ME". What
    is None is what the file names; axes that no file names are J2000. Times of States are seconds past J2000 TDB."""
    path: object
    body: object = None
    axes: object = None


@dataclass(frozen=True)
class Panel:
    """A flat solar panel. area [m^2]; efficiency of the cells, 0 to 1. Its normal points to azimuth_deg (clockwise from
    north) and elevation_deg (default: up). tracking: "fixed", "vertical" (it turns about the vertical, its normal level) or
    "full" (it faces the Sun)."""
    area: float = 1.0
    efficiency: float = 1.0
    azimuth_deg: float = 0.0
    elevation_deg: float = 90.0
    tracking: str = "fixed"

    @property
    def normal(self):
        """Unit: east, north, up."""
        azimuth, elevation = np.radians((self.azimuth_deg, self.elevation_deg))
        return np.array((np.cos(elevation) * np.sin(azimuth), np.cos(elevation) * np.cos(azimuth), np.sin(elevation)))


@dataclass(frozen=True)
class ProjectedAreas:
    """The area of solar cells that the Sun lights, projected towards each direction, with the shadows of what stands beside them: a
    panel of Scene.power_profile() that knows its own vehicle. Scene.projected_areas() measures it.

    area (rows, azimuths) [m^2]: rows at evenly spaced elevations from lowest_deg to highest_deg, columns at evenly spaced azimuths
    clockwise from the meridian's north; linear in between, and beyond the rows that of the nearest one. efficiency of the cells, 0 to
    1."""
    area: np.ndarray
    lowest_deg: float
    highest_deg: float
    efficiency: float = 1.0


@dataclass(frozen=True)
class Battery:
    """A battery that panels charge. capacity_wh [W h]; load [W] that panels and battery supply; charge at the start, 0 to 1
    of the capacity; charging: the part of the energy that arrives when it charges, 0 to 1."""
    capacity_wh: float
    load: float = 0.0
    charge: float = 1.0
    charging: float = 1.0
