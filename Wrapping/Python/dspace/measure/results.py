"""What measurements return."""
from dataclasses import dataclass

import numpy as np

from dspace._core.fields import array_of
from dspace._core.files import atomic_write


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
        by = f" by terrain {self.terrain!r}" if self.terrain else f" by object {self.object.name!r}" if self.object else ""
        least = f", clearance {self.clearance:.6g} m" if np.isfinite(self.clearance) else ""  # pictures know none
        return (f"<dspace.LinesOfSight {'clear' if clear else f'blocked{by} after {self.distance:.6g} m'}, "
                f"range {self.range:.6g} m{least}>")

    @property
    def difference(self):
        """Why pictures show something else than the exact results say (method "both"): a str, "" where they agree; an array of
        them for several lines. A line that passes the ground by less than a pixel's angle may differ; one that differs by more
        does so because distant ground is drawn by coarser posts. None where there are not both."""
        if self.image_clear is None or not np.isfinite(np.asarray(self.clearance_deg, float)).any():
            return None

        def why(clear, image, clearance, pixel):
            if clear == image:
                return ""
            near = abs(clearance) <= pixel
            return (f"in the picture it is {'clear' if image else 'blocked'}: the line passes the ground by {abs(clearance):.4f} deg, "
                    + (f"less than a pixel ({pixel:.4f} deg)" if near else
                       f"more than a pixel ({pixel:.4f} deg): distant ground is drawn by coarser posts"))
        found = np.vectorize(why, otypes=[object])(self.clear, self.image_clear, self.clearance_deg, self.image_pixel_deg)
        return found if np.shape(self.clear) else found.item()


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
    which end 35 to 45 degrees high; else None. image_pixel_deg: the largest angle of a pixel. image_distance (n,), image_point
    (n, 3): of that pixel's ray, as distance and point. image_cameras: the Poses of the four pictures (90 degrees wide and high,
    towards azimuths 0, 90, 180 and 270) in the root: X right, Y down, Z forward. method: that it was measured by; with "image"
    elevation_deg, distance and point are those of the pictures."""
    azimuth_deg: np.ndarray
    elevation_deg: np.ndarray
    distance: np.ndarray
    point: np.ndarray
    object: np.ndarray
    place: np.ndarray
    first_deg: object = None
    image_elevation_deg: object = None
    image_pixel_deg: object = None
    image_distance: object = None
    image_point: object = None
    image_cameras: object = None
    method: str = "exact"

    @property
    def image_difference_deg(self):
        """By how much pictures show the horizon higher than rays find it [deg], (n,), NaN above the pictures; None unless the
        method was "both". Up to image_pixel_deg is a pixel; more is distant ground that is drawn by coarser posts (a larger
        level_size of the terrain makes it less)."""
        if self.method != "both":
            return None
        return np.where(self.elevation_deg > -90.0, self.image_elevation_deg - self.elevation_deg, np.nan)

    def elevation_at(self, azimuth_deg):
        """Returns the elevation [deg] at azimuths (a number or an array) [deg], linear between the horizon's own."""
        azimuth = array_of(azimuth_deg, "the azimuth", "a number or an array of numbers", "horizon")
        found = np.interp(azimuth, self.azimuth_deg, self.elevation_deg, period=360.0)
        return float(found) if azimuth.shape == () else found

    def __repr__(self):
        return (f"<dspace.Horizon {len(self.azimuth_deg)} azimuths, elevation {self.elevation_deg.min():.6g} to "
                f"{self.elevation_deg.max():.6g} deg>")


@dataclass(frozen=True)
class Profile:
    """The ground below a line, at n places. distance (n,): from the start along the line on the ellipsoid, or in the map [m].
    height (n,): above the terrain's vertical datum [m]. slope_deg (n,): of the ground, in its steepest direction. map (n, 3):
    map x, y and height. point (n, 3): in the scene's root [m]. NaN where there are no data."""
    distance: np.ndarray
    height: np.ndarray
    slope_deg: np.ndarray
    map: np.ndarray
    point: np.ndarray

    def save(self, path):
        """Writes a table as CSV: distance_m, height_m, slope_deg, map_x, map_y; empty where there are no data."""
        rows = ["distance_m,height_m,slope_deg,map_x,map_y"]
        for row in zip(self.distance, self.height, self.slope_deg, self.map[:, 0], self.map[:, 1]):
            rows.append(",".join("" if value != value else f"{value:.12g}" for value in row))
        atomic_write(path, ("\n".join(rows) + "\n").encode())

    def __repr__(self):
        return (f"<dspace.Profile {len(self.distance)} places, {self.distance[-1]:.6g} m, height {np.nanmin(self.height):.6g} to "
                f"{np.nanmax(self.height):.6g} m>" if np.isfinite(self.height).any() else
                f"<dspace.Profile {len(self.distance)} places without data>")


@dataclass(frozen=True)
class MeasuredLine:
    """A line through n points; arrays (n - 1,) have a value for each leg.

    points (n, 3): in the scene's root [m]. lengths: straight through space [m]. With a terrain (its name): distances: along the
    ellipsoid, or in the map where its CRS has none [m]; azimuth_deg: at the start of a leg, clockwise from north; rises: of the
    ground [m]; profile: the Profile of the ground. Else None."""
    points: np.ndarray
    lengths: np.ndarray
    terrain: object = None
    distances: object = None
    azimuth_deg: object = None
    rises: object = None
    profile: object = None

    @property
    def length(self):
        """The sum of the lengths [m]."""
        return float(self.lengths.sum())

    @property
    def distance(self):
        """The sum of the distances [m]; None without a terrain."""
        return None if self.terrain is None else float(self.distances.sum())

    @property
    def slope_deg(self):
        """The slope of each leg from its start to its end on the ground; None without a terrain."""
        return None if self.terrain is None else np.degrees(np.arctan2(self.rises, self.distances))

    @property
    def ground_length(self):
        """The length of the profile over the ground [m], which grows with the number of samples; NaN where data are missing;
        None without a terrain."""
        if self.terrain is None:
            return None
        return float(np.linalg.norm(np.diff(self.profile.point, axis=0), axis=1).sum())

    @property
    def climb(self):
        """The sum of all ascents of the profile [m]; NaN where data are missing; None without a terrain."""
        return None if self.terrain is None else float(np.maximum(np.diff(self.profile.height), 0).sum())

    @property
    def descent(self):
        """The sum of all descents of the profile [m], positive; NaN where data are missing; None without a terrain."""
        return None if self.terrain is None else float(np.maximum(-np.diff(self.profile.height), 0).sum())

    def __repr__(self):
        on = "" if self.terrain is None else f", {self.distance:.6g} m on terrain {self.terrain!r}"
        return f"<dspace.MeasuredLine {len(self.points)} points, {self.length:.6g} m{on}>"


@dataclass(frozen=True)
class MeasuredArea:
    """A polygon. points (n, 3): its corners in the scene's root [m]. area [m^2], perimeter [m]: in its plane; with a terrain
    (its name) on the ellipsoid, or in the map where its CRS has none.

    With a terrain, of a grid of places within it: covered: the share of the area that has data; surface_area [m^2]: of the
    sloping ground (the area times the mean of 1 / cos slope); least_height, mean_height, greatest_height [m]; mean_slope_deg. Else
    None."""
    points: np.ndarray
    area: float
    perimeter: float
    terrain: object = None
    covered: object = None
    surface_area: object = None
    least_height: object = None
    mean_height: object = None
    greatest_height: object = None
    mean_slope_deg: object = None

    def __repr__(self):
        on = "" if self.terrain is None else f" on terrain {self.terrain!r}"
        return f"<dspace.MeasuredArea {len(self.points)} corners, {self.area:.6g} m^2{on}>"


@dataclass(frozen=True)
class LitArea:
    """The sunlit area of one object (numbers) or of several (arrays (n,)).

    object: the GraphicsObject, or a list of them. area [m^2]: of the faces that count. lit_area [m^2]: their sunlit part,
    weighted by the part of the Sun's disc that each place sees. projected_area [m^2]: projected towards the Sun.
    power [W]: projected area times irradiance times efficiency. irradiance [W/m^2]: on a surface that faces the Sun, outside
    eclipses. sun (3,): unit vector towards the Sun, in the scene's root. Where a body of the scene is the Sun, it stands as each
    object sees it: its place, its disc, and the light's irradiance times (1 au / its distance)^2; `irradiance` and `sun` are then
    those of the first object.

    image_projected_area [m^2]: by a picture from the Sun (method "image" or "both"), which takes the Sun as a point, and both sides
    of faces; image_pixel_area [m^2]: of its pixels; else None. With "image" projected_area is the same, lit_area is NaN.

    sun_left, 0 to 1: the part of the Sun's disc that other bodies of the scene leave at the middle of the object (eclipses); it
    is a factor of all sunlit areas and of the power."""
    object: object
    area: object
    lit_area: object
    projected_area: object
    power: object
    irradiance: float
    sun: np.ndarray
    image_projected_area: object = None
    image_pixel_area: object = None
    sun_left: object = 1.0

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
    north), sun_elevation_deg (of the disc's centre), lit (part of the disc that is seen, 0 to 1), power [W] of all
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
