"""`dspace terrain`: info, render, cache."""
import argparse
import math

from dspace.command_line import later, terrain_cache, terrain_layers

# The type of each key of a patch.
PATCH = {"band": int, "crs": str, "vertical_datum": str, "vertical_scale": float, "vertical_offset": float,
         "pixel_size": float, "margin": float, "no_data": float}


def add_arguments(parser):
    commands = parser.add_subparsers(dest="what", metavar="WHAT", required=True)
    info = commands.add_parser("info",
                               help="describe a raster: its properties, statistics, pyramid, and how it is drawn",
                               description="Describes a raster: its properties, statistics, pyramid, and how it is "
                               "drawn.")
    add_raster(info)
    info.add_argument("--json", action="store_true", help="print JSON: a list with one entry for each file")
    info.add_argument("--field", type=field, action="append", dest="fields", metavar="NAME=FILE[:BAND]",
                      help="a raster of values that lies on FILE: what it holds, and how much of FILE it covers; may be "
                      "given several times")
    info.set_defaults(run=later("terrain_info"))

    render = commands.add_parser(
        "render", help="draw a picture: a map, or a perspective view",
        description="Draws a picture of one raster, or of several with the same CRS, lit by a sun: from straight "
        "above with the rasters' extent, or in perspective; on a plane, or on the body.")
    add_raster(render)
    render.add_argument("--out", required=True, metavar="PNG", help="the picture: .png, .jpg or .tif")
    render.add_argument("--size", type=size, metavar="WxH", help="pixels (default: 1024 on the longer side)")
    render.add_argument("--view", choices=("map", "perspective"), default="map")
    render.add_argument("--on-body", action="store_true", help="place the terrain on its body (default: on a plane)")
    terrain_layers.add_arguments(render)
    render.add_argument("--color-by-height", action=argparse.BooleanOptionalAction, default=None,
                        help="color the terrain by height (default: on maps without --image, --false-color and --shapes)")
    render.add_argument("--exaggeration", type=exaggeration, metavar="E",
                        help="factor on the heights by which a map is shaded; 1: true light (default: 1, or more where "
                        "pixels are so large that true light shows no relief; the factor is printed)")
    render.add_argument("--image-crs", metavar="CRS", help="CRS of the image, if its file does not state one")
    render.add_argument("--image-extent", type=numbers(4, "LEFT,TOP,RIGHT,BOTTOM"), metavar="L,T,R,B",
                        help="extent of the image in map coordinates, if its file does not state one")
    render.add_argument("--sun", type=sun, default=(315.0, 45.0), metavar="AZ,EL",
                        help="degrees clockwise from north and above the horizon, at the target or the middle (315,45)")
    render.add_argument("--shadows", action="store_true", help="draw the shadows that the sun casts")
    render.add_argument("--eye", type=numbers(3, "LON,LAT,HEIGHT"), metavar="LON,LAT,HEIGHT",
                        help="position of the camera of a perspective view; height in metres above the vertical "
                        "datum; map x,y,height without a CRS")
    render.add_argument("--target", type=numbers(3, "LON,LAT,HEIGHT"), metavar="LON,LAT,HEIGHT",
                        help="the point that a perspective view looks at")
    render.add_argument("--fov", type=fov, default=35.0, metavar="DEG",
                        help="vertical angle of a perspective view (default 35)")
    render.set_defaults(run=later("terrain_render"))

    terrain_cache.add_arguments(commands.add_parser(
        "cache", help="build overviews of large rasters that have none", description=terrain_cache.ABOUT))


def add_raster(parser):
    """Adds the raster files, and options for properties that the files lack or state wrongly."""
    parser.add_argument("files", nargs="+", metavar="FILE", help="any raster that GDAL opens")
    add_raster_options(parser)


def add_raster_options(parser):
    """Adds options for properties that a raster file lacks or states wrongly."""
    parser.add_argument("--band", type=int)
    parser.add_argument("--crs", help="CRS of the raster: WKT, PROJ, AUTHORITY:CODE")
    parser.add_argument("--vertical-datum", metavar="DATUM", help="ellipsoid, sphere:R, areoid, relative, ...")
    parser.add_argument("--vertical-scale", type=float, metavar="S", help="metres per unit of height")
    parser.add_argument("--vertical-offset", type=float, metavar="M", help="metres added to the heights")
    parser.add_argument("--pixel-size", type=float, metavar="P",
                        help="size of a pixel in map units, if the raster has no georeference")
    parser.add_argument("--no-data", type=float, metavar="VALUE", help="pixels of this value, as the file stores it, have "
                        "no data (-32768, -9999, ...)")
    parser.add_argument("--patch", type=patch, action="append", dest="patches", metavar="PATH[,KEY=VALUE...]",
                        help="a raster of higher resolution, in its own CRS, blended into FILE over a "
                        f"margin; keys: {', '.join(PATCH)}; may be given several times")
    parser.add_argument("--level-size", type=int, metavar="N",
                        help="number of cells along a side of a clipmap level (info 124, render 252)")
    parser.add_argument("--byte-budget", type=int, metavar="BYTES",
                        help="largest size of the tiles in memory (256 MiB)")
    parser.add_argument("--deadline", type=float, metavar="S", help="seconds to wait for tiles (60)")


# --- Values ----------------------------------------------------------------------------------------

def size(text):
    from dspace._core.traits import SIDE  # slow to import
    try:
        width, height = (int(part) for part in text.lower().split("x"))
    except ValueError:
        width = height = 0
    if not all(SIDE[0] <= side <= SIDE[1] for side in (width, height)):
        raise argparse.ArgumentTypeError(f"'{text}'; accepted: WIDTHxHEIGHT, each {SIDE[0]} to {SIDE[1]}")
    return width, height


def numbers(count, names):
    def read(text):
        try:
            values = tuple(float(part) for part in text.split(","))
        except ValueError:
            values = ()
        if len(values) != count or not all(map(math.isfinite, values)):
            raise argparse.ArgumentTypeError(f"'{text}'; accepted: {names}, {count} finite numbers")
        return values
    return read


def sun(text):
    azimuth, elevation = numbers(2, "AZ,EL")(text)
    if not (abs(azimuth) <= 360 and abs(elevation) <= 90):
        raise argparse.ArgumentTypeError(f"'{text}'; accepted: an azimuth of -360 to 360 and an elevation of -90 to 90 degrees")
    return azimuth, elevation


def fov(text):
    value = numbers(1, "DEG")(text)[0]
    if not 0.001 <= value <= 170:
        raise argparse.ArgumentTypeError(f"'{text}'; accepted: 0.001 to 170 degrees")
    return value


def exaggeration(text):
    value = numbers(1, "E")(text)[0]
    if not 0.1 <= value <= 1e4:
        raise argparse.ArgumentTypeError(f"'{text}'; accepted: 0.1 to 10000")
    return value


def field(text):
    """Returns the name and the file of a field."""
    name, equals, path = text.partition("=")
    if not name or not path:
        raise argparse.ArgumentTypeError(f"'{text}'; accepted: NAME=FILE[:BAND]")
    return name, path


def patch(text):
    """Returns a dict for the `patches` of add_terrain. A comma without a key belongs to the path or CRS."""
    found = {"path": ""}
    last = "path"
    for number, part in enumerate(text.split(",")):
        key, equals, value = part.partition("=")
        if number and equals and key in PATCH:
            found[key], last = value, key
        else:
            found[last] += ("," if number else "") + part
    try:
        values = {key: PATCH.get(key, str)(value) for key, value in found.items()}
    except ValueError:
        raise argparse.ArgumentTypeError(f"'{text}'; accepted: PATH and KEY=VALUE of {', '.join(PATCH)}") from None
    if not values["path"]:
        raise argparse.ArgumentTypeError(f"'{text}' names no file; accepted: PATH[,KEY=VALUE...]")
    return values
