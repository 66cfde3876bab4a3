"""What measurements return."""
from dataclasses import dataclass

import numpy as np

from dspace._core.fields import array_of


@dataclass(frozen=True)
class LinesOfSight:
    """The answer for one line (bools, numbers, arrays (3,)) or for many (arrays of the shape that start and end broadcast
    to). Points are in the scene's root [m].

    clear: nothing is in the way. terrain: the name of the terrain that blocks the line first, else "". object: the
    GraphicsObject that blocks it first, else None. point, distance: where [m], and how far from the start [m]; NaN and
    infinity of a clear line. range: between the two places [m].

    clearance [m]: least height of the line above the ground along the local vertical, its ends included, or the least
    distance from an object if that is less; negative: greatest depth below the ground; 0: only an object blocks; infinity:
    nothing is near. clearance_deg: the angle by which the line can be turned down about its start until it meets ground before
    the end's vertical; negative: must be turned up until it is clear. Both are NaN with clearance=False.

    fresnel_free: least height above the ground over the radius of the first Fresnel zone: 1 or more is free, 0 or less
    blocked; None without a wavelength.

    image_clear: what pictures show (method "image" or "both"); else None. image_pixel_deg: the angle of their pixels."""
    clear: object
    terrain: object
    object: object
    point: np.ndarray
    distance: object
    range: object
    clearance: object
    clearance_deg: object
    fresnel_free: object
    image_clear: object = None
    image_pixel_deg: object = None

    def __repr__(self):
        clear = np.asarray(self.clear)
        if clear.shape:
            return f"<dspace.LinesOfSight {int(clear.sum())} of {clear.size} clear>"
        by = f"terrain {self.terrain!r}" if self.terrain else f"object {getattr(self.object, 'name', None)!r}"
        return (f"<dspace.LinesOfSight {'clear' if clear else f'blocked by {by} after {self.distance:.6g} m'}, "
                f"range {self.range:.6g} m, clearance {self.clearance:.6g} m>")


@dataclass(frozen=True)
class Horizon:
    """The horizon around a place.

    azimuth_deg (n,): clockwise from north, from 0 on. elevation_deg (n,): the greatest elevation at which a ray meets an
    obstacle, over the plane that is normal to the local vertical; -90 where there is none. distance (n,): along that ray
    [m]; infinity where there is none. point (n, 3): where it meets the obstacle, in the scene's root [m]; NaN where there is
    none. object (n,): the GraphicsObject that makes the horizon; None: terrain, or nothing. place (3,): in the root [m].

    first_deg: the azimuth of the first from the meridian's north [deg]: 0 on a body, that of the map's Y axis on a plane; None
    where no terrain with longitudes and latitudes is below the place.

    image_elevation_deg (n,): by pictures (method "image" or "both"), the upper edge of the highest pixel; NaN: above the pictures,
    which end 35 to 45 degrees high; else None. image_pixel_deg: the largest angle of a pixel. With "image" elevation_deg is the
    same, distance and point are NaN."""
    azimuth_deg: np.ndarray
    elevation_deg: np.ndarray
    distance: np.ndarray
    point: np.ndarray
    object: np.ndarray
    place: np.ndarray
    first_deg: object = None
    image_elevation_deg: object = None
    image_pixel_deg: object = None

    def elevation_at(self, azimuth_deg):
        """Returns the elevation [deg] at azimuths (a number or an array) [deg], linear between the horizon's own."""
        azimuth = array_of(azimuth_deg, "the azimuth", "a number or an array of numbers", "horizon")
        found = np.interp(azimuth, self.azimuth_deg, self.elevation_deg, period=360.0)
        return float(found) if azimuth.shape == () else found

    def __repr__(self):
        return (f"<dspace.Horizon {len(self.azimuth_deg)} azimuths, elevation {self.elevation_deg.min():.6g} to "
                f"{self.elevation_deg.max():.6g} deg>")


@dataclass(frozen=True)
class LitArea:
    """The sunlit area of one object (numbers) or of several (arrays (n,)).

    object: the GraphicsObject, or a list of them. area [m^2]: of the faces that count. lit_area [m^2]: their sunlit part,
    weighted by the part of the Sun's disc that each place sees. projected_area [m^2]: projected towards the Sun.
    power [W]: projected area times irradiance times efficiency. irradiance [W/m^2]: on a surface that faces the Sun.
    sun (3,): unit vector towards the Sun, in the scene's root.

    image_projected_area [m^2]: by a picture from the Sun (method "image" or "both"), which takes the Sun as a point, and both sides
    of faces; image_pixel_area [m^2]: of its pixels; else None. With "image" projected_area is the same, lit_area is NaN."""
    object: object
    area: object
    lit_area: object
    projected_area: object
    power: object
    irradiance: float
    sun: np.ndarray
    image_projected_area: object = None
    image_pixel_area: object = None

    @property
    def fraction(self):
        """The lit part of the area, 0 to 1."""
        return self.lit_area / self.area

    def __repr__(self):
        return (f"<dspace.LitArea {np.sum(self.lit_area):.6g} of {np.sum(self.area):.6g} m^2 lit, "
                f"{np.sum(self.power):.6g} W>")


@dataclass(frozen=True)
class SkyTrack:
    """Directions of a target over a place: numbers for one time, arrays (n,) for several. time: seconds past J2000 TDB.
    azimuth_deg: clockwise from the meridian's north. elevation_deg: of its centre. range [m]."""
    target: object
    time: object
    azimuth_deg: object
    elevation_deg: object
    range: object


@dataclass(frozen=True)
class Moment:
    """A moment of a contact. time: seconds past J2000 TDB; azimuth_deg: clockwise from the meridian's north; range [m]."""
    time: float
    azimuth_deg: float
    elevation_deg: float
    range: float


@dataclass(frozen=True)
class Contact:
    """A target above the horizon of a place. rise, set: Moments; peak: that of the greatest elevation. since_before: it has
    begun before the span, and rise is the span's start; until_after: it ends after the span, and set is the span's end."""
    target: object
    rise: Moment
    set: Moment
    peak: Moment
    since_before: bool
    until_after: bool

    @property
    def duration(self):
        """[s]"""
        return self.set.time - self.rise.time


@dataclass(frozen=True)
class PowerProfile:
    """The power of panels over a span.

    Arrays (n,), with both ends of the span: time (seconds past J2000 TDB), sun_azimuth_deg (clockwise from the meridian's
    north), sun_elevation_deg (of the disc's centre), lit (part of the disc above the horizon, 0 to 1), power [W] of all
    panels, charge of the battery (0 to 1; None without one).

    lit_share: mean of `lit` over the span. energy_wh [W h] of all panels. longest_night [s]: longest time without any of the
    disc; night_start: when it begins (seconds past J2000 TDB; NaN: there is none). least_charge: 0 to 1. empty [s]: the
    time in which the battery is empty and the panels do not supply the load, which lacks missing_wh [W h]."""
    time: np.ndarray
    sun_azimuth_deg: np.ndarray
    sun_elevation_deg: np.ndarray
    lit: np.ndarray
    power: np.ndarray
    charge: object
    lit_share: float
    energy_wh: float
    longest_night: float
    night_start: float
    least_charge: object
    empty: float
    missing_wh: float

    def __repr__(self):
        return (f"<dspace.PowerProfile {len(self.time)} samples, lit {100.0 * self.lit_share:.6g} %, "
                f"{self.energy_wh:.6g} W h, longest night {self.longest_night / 3600.0:.6g} h>")
