"""Star catalogues as arrays, and the directions of their stars at an epoch."""
import csv
import os
import pathlib

import numpy as np

from dspace._core.fields import array_of, number, numbers, reject, text
from dspace._core.replies import warn
from dspace.errors import InvalidArgument, Io, NotFound

COLUMNS = ("ra_deg", "dec_deg", "magnitude", "color_index", "pm_ra", "pm_dec", "parallax", "name")
NEEDED = COLUMNS[:3]
ARCSECOND = np.pi / 648000.0
SPEED_OF_LIGHT = 299792458.0  # [m/s]


class StarCatalog:
    """Stars of the epoch J2000 (Julian year 2000.0) in equatorial coordinates (ICRS or FK5), as arrays of equal length.

    ra_deg, dec_deg: right ascension and declination [deg]. magnitude: apparent, V. color_index: B-V; NaN: unknown.
    pm_ra, pm_dec: proper motion [arcsec/yr], pm_ra as an arc on the sky (with cos dec). parallax [arcsec].
    names: texts, empty for most stars. Unknown motion and parallax are 0."""

    def __init__(self, ra_deg, dec_deg, magnitude, color_index=None, pm_ra=None, pm_dec=None, parallax=None, names=None):
        about = "star catalogue"
        self.ra_deg = _column(ra_deg, "ra_deg", about)
        n = len(self.ra_deg)
        self.dec_deg = _column(dec_deg, "dec_deg", about, n)
        self.magnitude = _column(magnitude, "magnitude", about, n)
        self.color_index = _column(color_index, "color_index", about, n, np.nan)
        self.pm_ra = _column(pm_ra, "pm_ra", about, n, 0.0)
        self.pm_dec = _column(pm_dec, "pm_dec", about, n, 0.0)
        self.parallax = _column(parallax, "parallax", about, n, 0.0)
        self.names = [""] * n if names is None else [text(name, "a name", about) for name in names]
        if len(self.names) != n:
            raise InvalidArgument(f"{about}: there are {len(self.names)} names; accepted: {n}, one a star")
        for what, low, high in (("dec_deg", -90.0, 90.0), ("magnitude", -30.0, 40.0)):
            bad = np.flatnonzero(~((getattr(self, what) >= low) & (getattr(self, what) <= high)))
            if len(bad):
                reject(f"{about}: star {bad[0]}", what, getattr(self, what)[bad[0]], f"{low:g} to {high:g}")
        if not np.all(np.isfinite(self.ra_deg)):
            reject(about, "ra_deg", "not finite", "finite numbers of degrees")

    def __len__(self):
        return len(self.ra_deg)

    def __repr__(self):
        return f"<StarCatalog of {len(self)} stars>"

    def brighter_than(self, magnitude):
        """The stars up to a magnitude, as a StarCatalog."""
        return self._of(np.flatnonzero(self.magnitude <= number(magnitude, "the magnitude", "star catalogue")))

    def named(self, name):
        """The star of that name, as a StarCatalog of one."""
        if name not in self.names:
            raise NotFound(f"star catalogue: there is no star {name!r}; named are: {', '.join(sorted(set(self.names) - {''}))[:200]}",
                           "star catalogue")
        return self._of(np.array([self.names.index(name)]))

    def _of(self, rows):
        columns = (getattr(self, c)[rows] for c in ("ra_deg", "dec_deg", "magnitude", "color_index", "pm_ra", "pm_dec",
                                                    "parallax"))
        return StarCatalog(*columns, names=[self.names[i] for i in rows])

    def directions(self, epoch=2000.0, observer=(0.0, 0.0, 0.0)):
        """Unit vectors (n, 3) towards the stars: X to right ascension 0, Z to the celestial north pole.

        epoch: Julian year, 1000 to 3000. observer: its position from the solar system's barycentre [au], same axes, for
        the parallax. Stars move in straight lines across the line of sight, as their proper motions say (the motion
        along it is left out: under 0.1 arcsec in a century for all but the very nearest stars)."""
        years = number(epoch, "the epoch", "directions") - 2000.0
        if not -1000.0 <= years <= 1000.0:
            reject("directions", "the epoch", epoch, "Julian years, 1000 to 3000")
        place = np.array(numbers(observer, 3, "the observer", "directions"))
        ra, dec = np.radians(self.ra_deg), np.radians(self.dec_deg)
        toward = np.stack([np.cos(dec) * np.cos(ra), np.cos(dec) * np.sin(ra), np.sin(dec)], 1)
        east = np.stack([-np.sin(ra), np.cos(ra), np.zeros_like(ra)], 1)
        north = np.cross(toward, east)
        moved = toward + years * ARCSECOND * (self.pm_ra[:, None] * east + self.pm_dec[:, None] * north)
        moved = moved - ARCSECOND * self.parallax[:, None] * place
        return moved / np.linalg.norm(moved, axis=1, keepdims=True)

    def apparent(self, epoch=2000.0, observer=(0.0, 0.0, 0.0), velocity=(0.0, 0.0, 0.0), zenith=None, pressure=101000.0,
                 temperature=283.0):
        """The stars where an observer sees them at an epoch, as a StarCatalog without motions: for pictures that are
        compared with photographs.

        epoch, observer: as for directions(). velocity: the observer's from the solar system's barycentre [m/s], in the
        same axes, for aberration (to first order: 1e-8 rad remain for the Earth's velocity). zenith: the direction of the
        vertical at the site, in the same axes; stars above it are then lifted by the air of `pressure` [Pa] and
        `temperature` [K] there, as T. Saemundsson has it (Sky & Telescope 72 (1986) 70), to 0.1 arcmin; those
        more than a degree below the horizon stay."""
        about = "apparent places"
        seen = self.directions(epoch, observer) + np.array(numbers(velocity, 3, "the velocity", about)) / SPEED_OF_LIGHT
        seen /= np.linalg.norm(seen, axis=1, keepdims=True)
        if zenith is not None:
            up = np.array(numbers(zenith, 3, "the zenith", about))
            if not np.linalg.norm(up) > 0.0:
                reject(about, "the zenith", zenith, "a vector that is not 0")
            air = number(pressure, "the pressure", about) / 101000.0 * 283.0 / number(temperature, "the temperature", about)
            if not 0.0 <= air <= 1000.0:
                reject(about, "pressure and temperature", (pressure, temperature), "0 Pa or more, above 0 K")
            seen = _lifted(seen, up / np.linalg.norm(up), air)
        return StarCatalog(np.degrees(np.arctan2(seen[:, 1], seen[:, 0])) % 360.0,
                           np.degrees(np.arcsin(np.clip(seen[:, 2], -1.0, 1.0))), self.magnitude, self.color_index,
                           names=self.names)


def _lifted(directions, up, air):
    """Unit vectors turned towards the zenith by refraction; air: its density by that of 101 kPa and 10 C."""
    sine = directions @ up
    level = directions - sine[:, None] * up
    length = np.linalg.norm(level, axis=1, keepdims=True)
    height = np.degrees(np.arctan2(sine, length[:, 0]))
    above = np.maximum(height, -1.0)
    lift = np.where(height > -1.0, air * 1.02 / 60.0 / np.tan(np.radians(above + 10.3 / (above + 5.11))), 0.0)
    angle = np.radians(np.minimum(height + np.maximum(lift, 0.0), 90.0))[:, None]
    level = np.divide(level, length, out=np.zeros_like(level), where=length > 1e-12)
    return np.cos(angle) * level + np.sin(angle) * up


def _column(values, what, about, count=None, absent=None):
    if values is None:
        return np.full(count, absent)
    array = array_of(values, what, "an array of numbers", about)
    if array.ndim != 1 or (count is not None and len(array) != count):
        raise InvalidArgument(f"{about}: {what} has shape {array.shape}; accepted: ({'n' if count is None else count},)")
    return array


def bright_stars():
    """The Yale Bright Star Catalogue, 5th edition (D. Hoffleit, W. H. Warren 1991; public domain): 9,096 stars to about
    magnitude 6.5, complete. Positions to about an arcsecond."""
    return read_stars(pathlib.Path(__file__).parent / "bsc5.csv")


def read_stars(path, columns=None):
    """A CSV file whose first line names its columns, as a StarCatalog.

    columns: which of the file's columns stands for which of ra_deg, dec_deg, magnitude (all three needed), color_index,
    pm_ra, pm_dec, parallax, name; by default their own names. Rows in which one of the needed is empty are left out with
    a warning; a number that cannot be read is an error that names its line."""
    path = os.fspath(path)
    wanted = {name: name for name in COLUMNS}
    for name, column in (columns or {}).items():
        if name not in wanted:
            reject(f"file {path!r}", "columns", name, ", ".join(COLUMNS))
        wanted[name] = text(column, f"the column of {name}", f"file {path!r}")
    try:
        with open(path, newline="", encoding="utf-8", errors="replace") as file:
            return _read(path, csv.DictReader(file), wanted)
    except OSError as error:
        raise (NotFound if isinstance(error, FileNotFoundError) else Io)(f"file {path!r}: {error.strerror}",
                                                                         f"file {path!r}") from None


def _read(path, rows, wanted):
    there = rows.fieldnames or []
    for name in NEEDED:
        if wanted[name] not in there:
            reject(f"file {path!r}", f"its columns do not include {wanted[name]!r}; they", ", ".join(there)[:300] or "none",
                   f"{', '.join(NEEDED)}, or their names by columns=")
    values = {name: [] for name in COLUMNS}
    left_out = 0
    for row in rows:
        if any(not (row[wanted[name]] or "").strip() for name in NEEDED):
            left_out += 1
            continue
        for name in COLUMNS:
            given = (row.get(wanted[name]) or "").strip()
            if name == "name":
                values[name].append(given)
                continue
            try:
                values[name].append(float(given) if given else (np.nan if name == "color_index" else 0.0))
            except ValueError:
                reject(f"file {path!r}, line {rows.line_num}", wanted[name], given, "a number")
    if left_out:
        warn(f"file {path!r}: {left_out} stars without position or magnitude are left out")
    if not values["name"]:
        raise InvalidArgument(f"file {path!r}: it has no star; accepted: one or more", f"file {path!r}")
    return StarCatalog(*(values[name] for name in COLUMNS[:-1]), names=values["name"])
