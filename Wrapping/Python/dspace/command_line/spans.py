"""What `dspace contacts` and `dspace power` share: a site, its horizon, and a span of time."""
import csv
import json
import pathlib

from dspace.command_line import Failed, lazy
from dspace.command_line.measure_ground import MeasuredGround, add_ground, place_of, source_of

np = lazy("numpy")

AZIMUTHS = 1440  # of a horizon that is measured


def add_span(parser, file_help, step):
    """Adds the options of a site, its horizon and a span."""
    add_ground(parser, file_help, required=False)
    parser.add_argument("--site", required=True, metavar="LON,LAT", help="longitude (east) and latitude [deg]")
    parser.add_argument("--height", type=float, default=2.0, metavar="H",
                        help="above the ground [m], 0 or more; without --terrain above the body's ellipsoid (default: 2)")
    parser.add_argument("--body", metavar="BODY", help="that the site is on (default: the one that the terrain's CRS names)")
    parser.add_argument("--mask", metavar="E|FILE",
                        help="the horizon: one elevation [deg], or a .json or .csv file of `dspace horizon` (default: with "
                        "--terrain it is measured at the site, without it is 0)")
    parser.add_argument("--time", required=True, metavar="T0,T1[,STEP]",
                        help="UTC in ISO 8601, or with ' TDB', ' TT' or ' TAI' behind it, and the step in seconds "
                        f"(default: {step:g})")
    parser.add_argument("--kernel", action="append", default=[], metavar="FILE",
                        help="a SPICE kernel; may be given several times, later ones are asked first")


class Span:
    """The place, the horizon and the times of the command in a scene."""

    def __init__(self, scene, options, step):
        import dspace
        if options.kernel:
            scene.kernels.load(*options.kernel)
        parts = options.time.split(",")
        if len(parts) not in (2, 3):
            raise Failed(f"--time {options.time!r}: accepted: T0,T1[,STEP]")
        self.start, self.end = (float(time) for time in scene.tdb(parts[:2]))
        if not self.start < self.end:
            raise Failed(f"--time {options.time!r}: the end is not after the start; accepted: T0,T1[,STEP], T0 before T1")
        try:
            self.step = float(parts[2]) if len(parts) == 3 else step
        except ValueError:
            raise Failed(f"--time {options.time!r}: the step is {parts[2]!r}; accepted: seconds") from None
        longitude, latitude = place_of(options.site, "LON,LAT", (2,), "--site")
        self.body = options.body
        has_ground = options.terrain is not None or options.recording is not None
        if has_ground:
            ground = MeasuredGround(scene, options)
            self.place = ground.site((longitude, latitude, options.height))
        elif options.body is None:
            raise Failed("--terrain, --body: accepted: one of them, or both")
        else:
            self.place, self.body = dspace.BodySite(options.body, longitude, latitude, options.height), None
        if options.mask is not None:
            self.mask = mask_of(options.mask)
        elif has_ground:
            self.mask = scene.horizon(self.place, AZIMUTHS)
        else:
            self.mask = 0.0
        self.found = {**(source_of(options, ground) if has_ground else {"terrain": None}), "body": options.body, "lon_deg": longitude,
                      "lat_deg": latitude, "height_m": options.height,
                      "horizon": "measured" if options.mask is None and has_ground else options.mask or "0",
                      "start": scene.utc(self.start), "end": scene.utc(self.end), "step_s": self.step}


def mask_of(text):
    """The mask of "E" or of a file of `dspace horizon`."""
    try:
        return float(text)
    except ValueError:
        path = pathlib.Path(text)
    try:
        if path.suffix.lower() == ".json":
            rows = json.loads(path.read_text())["horizon"]
        else:
            rows = list(csv.DictReader(path.read_text().splitlines()))
        azimuths, elevations = (np.array([float(row[name]) for row in rows]) for name in ("azimuth_deg", "elevation_deg"))
        first = float(rows[0]["true_azimuth_deg"] or 0.0)  # without longitudes and latitudes it is not known
    except (IndexError, KeyError, TypeError, ValueError):
        raise Failed(f"--mask '{path}': accepted: an elevation [deg], or a .json or .csv file of `dspace horizon`") from None
    count = len(azimuths)
    if np.abs(azimuths - np.arange(count) * (360.0 / count)).max() > 1e-6:
        raise Failed(f"--mask '{path}': its azimuths are not evenly spaced from 0 on; accepted: a file of `dspace horizon`")
    # As a Horizon whose first azimuth is known; the mask needs nothing else of it.
    from dspace.measure.results import Horizon
    none = np.full(count, np.nan)
    return Horizon(azimuths, elevations, none, np.full((count, 3), np.nan), np.full(count, None), np.full(3, np.nan), first)
