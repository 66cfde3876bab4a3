"""`dspace sky`: the sky over a site as a picture, and the direction of a body."""
import argparse
import json
import math
import pathlib
import sys
import warnings

from dspace.command_line import Failed
from dspace.command_line import terrain as values

BODIES = ("sun", "moon", "mercury", "venus", "earth", "mars", "jupiter", "saturn", "uranus", "neptune")
POINTS = ("mercury", "venus", "mars", "jupiter", "saturn", "uranus", "neptune")  # drawn as stars are, while they are points
STAR_GAIN = 3e5  # shows stars beside lit bodies at exposure 1
STAR_SPREAD = 0.9  # [pixels]
EYE_HEIGHT = 2.0  # [m] above the site: a body is drawn from a metre above its ground on


def add_arguments(parser):
    parser.add_argument("--time", required=True, metavar="UTC",
                        help="UTC in ISO 8601, or with ' TDB', ' TT' or ' TAI' behind it")
    parser.add_argument("--body", default="earth", metavar="BODY", help="the body that the site is on (default: earth)")
    parser.add_argument("--site", type=site_of, required=True, metavar="LON,LAT[,H]",
                        help="longitude (east) and planetocentric latitude [deg], height above the ellipsoid [m] "
                        "(default: 0)")
    look = parser.add_mutually_exclusive_group(required=True)
    look.add_argument("--look-at", metavar="BODY", help="the body in the middle of the picture; its place is printed")
    look.add_argument("--azimuth", type=float, metavar="DEG", help="of the camera, clockwise from north")
    parser.add_argument("--elevation", type=float, metavar="DEG", help="of the camera, -90 to 90 (default: 0)")
    parser.add_argument("--fov", type=float, default=45.0, metavar="DEG",
                        help="height of the picture, 0.001 to 170 (default: 45)")
    parser.add_argument("--size", type=values.size, default=(1280, 720), metavar="WxH", help="pixels (default: 1280x720)")
    parser.add_argument("--exposure", type=float, default=1.0, metavar="X",
                        help="a factor, 1e-12 to 1e12: 1 suits sunlit ground (default: 1)")
    parser.add_argument("--catalogue", metavar="CSV", help="stars with columns ra_deg, dec_deg, magnitude, color_index "
                        "(default: the Bright Star Catalogue)")
    parser.add_argument("--kernel", action="append", nargs="+", default=[], metavar="FILE",
                        help="SPICE kernels; later ones are asked first")
    parser.add_argument("--grid", choices=("horizon", "equatorial", "ecliptic"), help="meridians and parallels over the picture")
    parser.add_argument("--constellations", metavar="JSON", help="figures and names of constellations: a GeoJSON file of "
                        "lines, such as d3-celestial's")
    parser.add_argument("--json", action="store_true", help="print JSON")
    parser.add_argument("--out", metavar="PNG", help="the picture; without it, none is drawn")
    parser.set_defaults(run=run)


def run(options):
    import dspace
    site, size = options.site, options.size
    if options.elevation is not None and options.azimuth is None:
        raise Failed("--elevation: accepted: with --azimuth")
    check("--azimuth", options.azimuth, -360.0, 360.0)
    check("--elevation", options.elevation, -90.0, 90.0)
    check("--fov", options.fov, 1e-3, 170.0)
    check("--exposure", options.exposure, 1e-12, 1e12)
    if options.out is not None:
        out = pathlib.Path(options.out)
        if out.suffix.lower() != ".png":
            raise Failed(f"--out '{out}': accepted: a name with .png")
        if not out.resolve().parent.is_dir():
            raise Failed(f"--out '{out}': there is no folder {out.resolve().parent}")
    with dspace.Session() as session:
        scene = session.scene()
        for kernel in (each for group in options.kernel for each in group):
            scene.kernels.load(kernel)
        scene.time = scene.tdb(options.time)
        target = None
        if options.look_at is not None:
            target = scene.sky(options.look_at, body=options.body, site=site)[options.look_at]
            azimuth, elevation = target.azimuth_deg, target.elevation_deg
        else:
            scene.sky("sun", body=options.body, site=site)  # body and time are known
            azimuth, elevation = options.azimuth, options.elevation or 0.0
        if options.out is not None:
            with warnings.catch_warnings():  # a barycentre is off by less than a pixel
                warnings.filterwarnings("ignore", message=".*barycentre of its system")
                draw(scene, options, site, size, azimuth, elevation)
        tell(options, scene.utc(), target, azimuth, elevation)
    if options.out is not None and not options.json:
        print(f"{out}: {size[0]} x {size[1]} pixels")


def check(name, value, least, most):
    if value is not None and not least <= value <= most:  # NaN too
        raise Failed(f"{name} {value:g}: accepted: {least:g} to {most:g}")


def site_of(text):
    """Longitude, latitude [deg], height [m] of "LON,LAT[,H]"."""
    accepted = "accepted: LON,LAT[,H], with LON -360 to 360, LAT -90 to 90 deg, H in m"
    try:
        numbers = [float(part) for part in text.split(",")]
    except ValueError:
        numbers = []
    if len(numbers) not in (2, 3) or not all(map(math.isfinite, numbers)):
        raise argparse.ArgumentTypeError(f"{text!r}; {accepted}")
    longitude, latitude, height = (*numbers, 0.0)[:3]
    if not (abs(longitude) <= 360.0 and abs(latitude) <= 90.0):
        raise argparse.ArgumentTypeError(f"{text!r}; {accepted}")
    return longitude, latitude, height


def draw(scene, options, site, size, azimuth, elevation):
    """Writes the picture. The scene's root is the centre of the site's body with J2000's axes, which the stars have.
    Bodies are at their apparent places from that centre, with light time and aberration: within 0.4 arcsec of the
    printed place, because a site on the Earth moves about the centre at up to 0.47 km/s."""
    from dspace.sky.places import axes_of
    from dspace.stars import read_stars
    place = scene.add_celestial_frame("site", options.body, site=site, center=options.body)
    columns = {name: name for name in ("ra_deg", "dec_deg", "magnitude", "color_index")}
    scene.add_stars(None if options.catalogue is None else read_stars(options.catalogue, columns), gain=STAR_GAIN,
                    spread=STAR_SPREAD)
    for name in BODIES:
        here = name == options.body.lower()
        frame = scene.add_celestial_frame(name, name, axes=axes_of(name), center=options.body,
                                          correction="NONE" if here else "CN+S")
        point = {"point_gain": STAR_GAIN, "point_spread": STAR_SPREAD} if name in POINTS else {}
        scene.add_body(name, frame=frame, **point)
    if options.grid == "horizon":
        scene.add_sky_grid("horizon", frame=place)
    elif options.grid is not None:
        scene.add_sky_grid(options.grid)
    if options.constellations is not None:
        scene.add_constellations(options.constellations)
        scene.add_constellation_names(options.constellations)
    a, e = math.radians(azimuth), math.radians(elevation)
    ahead = (math.cos(e) * math.sin(a), math.cos(e) * math.cos(a), math.sin(e))
    up = (0.0, 0.0, 1.0) if abs(elevation) < 89.999 else (math.sin(a), math.cos(a), 0.0)
    eye = (0.0, 0.0, EYE_HEIGHT + max(0.0, -site[2]))  # never inside the ellipsoid
    camera = scene.add_camera("sky", frame=place, eye=eye, target=tuple(p + q for p, q in zip(eye, ahead)), up=up,
                              fov_deg=options.fov)
    view = scene.add_viewport(size, camera, samples=2)
    view.set(exposure=options.exposure, fill=0.0)  # the night is dark
    view.save(options.out)


def tell(options, utc, target, azimuth, elevation):
    """Prints the target, or the camera's direction where there is none."""
    found = {"utc": utc, "body": options.body, "azimuth_deg": azimuth, "elevation_deg": elevation}
    if target is not None:
        found.update(target=options.look_at, range_m=target.range, diameter_deg=2.0 * target.radius_deg,
                     lit_fraction=target.lit_fraction)
    if options.json:
        json.dump(found, sys.stdout, indent=2, allow_nan=False)
        print()
    elif target is None:
        print(f"{utc}  camera azimuth {azimuth:.6f} elevation {elevation:.6f} deg")
    else:
        print(f"{utc}  {options.look_at}  azimuth {azimuth:.6f} elevation {elevation:.6f} deg  range "
              f"{target.range / 1e3:.3f} km  diameter {2.0 * target.radius_deg:.6f} deg")
