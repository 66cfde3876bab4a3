"""What `dspace terrain render` paints on terrain: --image, --false-color, --shapes, in the order given."""
import argparse
import pathlib
import sys
import warnings

from dspace.errors import InvalidArgument


class Layer(argparse.Action):
    """Adds (kind, file) to the layers."""

    def __call__(self, parser, options, value, option=None):
        setattr(options, self.dest, (getattr(options, self.dest) or []) + [(option.strip("-"), value)])


def add_arguments(parser):
    parser.add_argument("--image", dest="layers", action=Layer, metavar="FILE",
                        help="an image that lies on it; this and the next two may be given several times, "
                        "later ones on top")
    parser.add_argument("--false-color", dest="layers", action=Layer, metavar="FILE[:BAND]",
                        help="a band's values from green over ochre to white, least to greatest")
    parser.add_argument("--shapes", dest="layers", action=Layer, metavar="FILE",
                        help="polygons, lines and points: GeoJSON, GeoPackage, Shapefile, ...")
    parser.set_defaults(reject=parser.error)


def check(options):
    """What argparse does not see, in its way."""
    layers = options.layers or []
    if layers and options.color_by_height:
        options.reject(f"argument --color-by-height: not allowed with argument --{layers[0][0]}")
    images = sum(kind == "image" for kind, _ in layers)
    for name, given in (("--image-crs", options.image_crs), ("--image-extent", options.image_extent)):
        if given is not None and images != 1:
            options.reject(f"argument {name}: {images} images are given; accepted: one")


def paint(terrains, options):
    """Each layer on the terrains that it lies on: on one at least."""
    for kind, path in options.layers or ():
        painted, missed = 0, None
        for terrain in terrains:
            try:
                with warnings.catch_warnings(record=True) as caught:
                    warnings.simplefilter("always")
                    add(terrain, kind, path, options)
            except InvalidArgument as error:
                if "overlap" not in str(error):
                    raise
                missed = error
                continue
            painted += 1
            for warning in caught:
                print(f"dspace: note: {path}: {warning.message}", file=sys.stderr)
        if not painted:
            raise missed


def add(terrain, kind, path, options):
    if kind == "image":
        terrain.add_image(path, crs=options.image_crs, extent=options.image_extent)
    elif kind == "false-color":
        terrain.add_false_color(*file_and_band(path))
    else:
        terrain.add_shapes(path)


def file_and_band(given):
    """FILE[:BAND]; a file may have a colon in its name."""
    path, colon, band = given.rpartition(":")
    if colon and band.isdecimal() and not pathlib.Path(given).exists():
        return path, int(band)
    return given, 1
