"""`dspace scan`: ranges of a lidar or an altimeter over terrain, or in a recorded scene."""
import pathlib
import sys

from dspace.command_line import Failed, lazy
from dspace.command_line.measure_ground import MeasuredGround, add_ground, opened, place_of, text_of

np = lazy("numpy")

MOST_ANGLES = 1_000_000


def add_arguments(parser):
    add_ground(parser, "a file of the scan: .ply (the echoes as a point cloud) or .csv (every beam)")
    parser.add_argument("--site", metavar="LON,LAT", help="with --terrain: longitude (east) and latitude [deg] of the sensor; "
                        "map x and y without a CRS. Its axes are X east, Y north, Z up")
    parser.add_argument("--height", type=float, default=2.0, metavar="H",
                        help="with --site: above the ground [m], 0 or more (default: 2)")
    parser.add_argument("--frame", metavar="PATH", help="with --recording: the sensor's frame, with X right, Y forward, Z up; "
                        "of --model the frame in which the model's own pose is")
    parser.add_argument("--through", metavar="CAMERA", help="with --recording: the scene's camera at which the sensor is")
    parser.add_argument("--without", action="append", default=[], metavar="OBJECT",
                        help="an object that beams do not meet, such as the sensor's housing; may be given several times")

    beams = parser.add_argument_group("beams")
    beams.add_argument("--azimuths", default="0,360,360", metavar="FIRST,LAST,N",
                       help="N azimuths [deg] from FIRST to LAST, clockwise from Y; of a full circle the last is left out "
                       "(default: 0,360,360)")
    beams.add_argument("--elevations", default="-15,15,16", metavar="FIRST,LAST,N", help="N elevations [deg] (default: -15,15,16)")
    beams.add_argument("--model", metavar="FILE", help="a flash lidar in place of azimuths and elevations: a beam for each pixel "
                       "of a camera model in this file")
    beams.add_argument("--camera", metavar="NAME", help="with --model: the camera of this name, where the file has several")
    beams.add_argument("--altimeter", type=float, metavar="WIDTH", help="in place of azimuths and elevations: the least range in "
                       "a cone of this full angle [deg] about -Z")

    sensor = parser.add_argument_group("sensor")
    sensor.add_argument("--range", default=None, metavar="MIN,MAX", help="ranges that give an echo [m] (default: all)")
    sensor.add_argument("--divergence", type=float, default=0.0, metavar="DEG", help="full angle of a beam (default: 0)")
    sensor.add_argument("--rays", type=int, metavar="N", help="of a beam with a divergence, 1 to 10000 (default: 19; of an "
                        "altimeter 397)")
    sensor.add_argument("--report", choices=("first", "last", "mean", "least"), default="first",
                        help="of the surfaces in one beam (default: first)")
    sensor.add_argument("--noise", type=float, default=0.0, metavar="M", help="standard deviation of a range [m]")
    sensor.add_argument("--noise-fraction", type=float, default=0.0, metavar="X", help="the same, as a fraction of the range")
    sensor.add_argument("--drop-out", type=float, default=0.0, metavar="P", help="probability that a beam is lost")
    sensor.add_argument("--greatest-incidence", type=float, default=90.0, metavar="DEG", help="steeper surfaces give no echo")
    sensor.add_argument("--seed", type=int, default=0, metavar="N", help="of noise and drop-outs (default: 0)")
    parser.set_defaults(run=run)


def run(options):
    for name, needed in (("site", "terrain"), ("frame", "recording"), ("through", "recording")):
        if getattr(options, name) is not None and getattr(options, needed) is None:
            raise Failed(f"--{name}: accepted: with --{needed}")
    if options.terrain is not None and (options.site is None or options.model is not None):
        raise Failed("--terrain: accepted: with --site, and without --model")
    if options.recording is not None and (options.frame is None) == (options.through is None):
        raise Failed("--frame and --through: accepted: one of them")
    place = None if options.site is None else place_of(options.site, "LON,LAT", (2,), "--site")
    out = out_of(options.out)
    sensor = sensor_of(options)
    with opened(options) as scene:
        if place is not None:
            where = {"site": MeasuredGround(scene, options).site((*place, options.height))}
        else:
            where = {"frame": options.frame} if options.frame is not None else {"camera": options.through}
        scan = scene.scan(sensor, seed=options.seed, without=options.without, **where)
    if out is not None:
        scan.save(out)
    tell(options, out, scan)


def out_of(name):
    """The path of --out, or None. Says what is wrong before the work starts."""
    if name is None:
        return None
    out = pathlib.Path(name)
    if out.suffix.lower() not in (".ply", ".csv"):
        raise Failed(f"--out '{out}': accepted: a name with .ply, .csv")
    if not out.resolve().parent.is_dir():
        raise Failed(f"--out '{out}': there is no folder {out.resolve().parent}")
    return out


def sensor_of(options):
    import dspace
    least, greatest = (0.0, None) if options.range is None else place_of(options.range, "MIN,MAX", (2,), "--range")
    settings = dict(minimum_range=least, maximum_range=greatest, noise=options.noise, noise_fraction=options.noise_fraction,
                    drop_out=options.drop_out, greatest_incidence_deg=options.greatest_incidence)
    if options.rays is not None:
        settings["rays"] = options.rays
    if options.altimeter is not None:
        if options.model is not None:
            raise Failed("--altimeter and --model: accepted: one of them")
        return dspace.Altimeter(options.altimeter, **settings)
    settings.update(divergence_deg=options.divergence, report=options.report)
    if options.model is not None:
        return dspace.Lidar.flash(dspace.CameraModel.read(options.model, options.camera), **settings)
    return dspace.Lidar(angles_of(options.azimuths, "--azimuths"), angles_of(options.elevations, "--elevations"), **settings)


def angles_of(text, option):
    first, last, count = place_of(text, "FIRST,LAST,N", (3,), option)
    if not 1 <= count <= MOST_ANGLES or count != int(count):
        raise Failed(f"{option} {text!r}: accepted: FIRST,LAST,N with an N of 1 to {MOST_ANGLES}")
    return np.linspace(first, last, int(count), endpoint=abs(last - first) != 360.0)


def tell(options, out, scan):
    outcome, ranges = np.atleast_1d(scan.outcome).ravel(), np.atleast_1d(scan.range).ravel()
    echo = outcome == 0
    things = np.atleast_1d(scan.object).ravel()[echo]
    found = {"terrain": options.terrain, "recording": options.recording, "position": scan.position, "beams": outcome.size,
             "outcomes": {name: int((outcome == i).sum()) for i, name in enumerate(scan.OUTCOMES) if (outcome == i).any()},
             "least_range_m": ranges[echo].min() if echo.any() else np.nan,
             "greatest_range_m": ranges[echo].max() if echo.any() else np.nan,
             "objects": {name: int((things == id).sum()) for id, name in scan.names.items()}}
    if options.json:
        sys.stdout.write(text_of(found))
        return
    print(f"{outcome.size} beams: " + ", ".join(f"{count} {name}" for name, count in found["outcomes"].items()))
    if echo.any():
        print(f"ranges {ranges[echo].min():.4f} to {ranges[echo].max():.4f} m; on "
              + ", ".join(f"{name} ({count})" for name, count in found["objects"].items()))
    if out is not None:
        print(f"{out}: {int(echo.sum()) if out.suffix.lower() == '.ply' else outcome.size} rows")
