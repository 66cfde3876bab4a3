"""The layers that `dspace terrain render` draws on terrain: --image, --false-color, --shapes, in the order given."""
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
                        help="an image to drape on the terrain; this and the next two options may be given several "
                        "times, later ones on top")
    parser.add_argument("--false-color", dest="layers", action=Layer, metavar="FILE[:BAND]",
                        help="the values of a band, colored from green (least) through ochre to white (greatest)")
    parser.add_argument("--shapes", dest="layers", action=Layer, metavar="FILE",
                        help="polygons, lines and points: GeoJSON, GeoPackage, Shapefile, ...")
    parser.set_defaults(reject=parser.error)


def check(options):
    """Rejects combinations of options that argparse cannot check, as argparse does."""
    layers = options.layers or []
    if layers and options.color_by_height:
        options.reject(f"argument --color-by-height: not allowed with argument --{layers[0][0]}")
    images = sum(kind == "image" for kind, _ in layers)
    for name, given in (("--image-crs", options.image_crs), ("--image-extent", options.image_extent)):
        if given is not None and images != 1:
            options.reject(f"argument {name}: {images} images are given; accepted: one")


def paint(terrains, options):
    """Adds each layer to the terrains that it overlaps. Raises dspace.InvalidArgument if it overlaps none."""
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
    """Returns the file and the band of FILE[:BAND]. The name of an existing file may contain a colon."""
    path, colon, band = given.rpartition(":")
    if colon and band.isdecimal() and not pathlib.Path(given).exists():
        return path, int(band)
    return given, 1
