"""Functions on rasters that several `dspace terrain` commands share."""
import warnings

from dspace.command_line import Failed

RASTER = ("band", "crs", "vertical_datum", "vertical_scale", "vertical_offset", "pixel_size", "level_size",
          "byte_budget", "deadline", "patches", "no_data")


def gdal_modules():
    try:
        from osgeo import gdal, osr
    except ImportError:
        raise Failed("GDAL's Python package is not installed (Debian: python3-gdal)") from None
    gdal.UseExceptions()
    osr.UseExceptions()
    return gdal, osr


def open_raster(gdal, path, options):
    """Returns GDAL's dataset of a raster and its geotransform, or a default one if the file has none."""
    name = str(path)
    if name.startswith(("http://", "https://")):  # read in parts, as the terrain does
        name = "/vsicurl/" + name
        for key, seconds in (("CONNECTTIMEOUT", 10), ("LOW_SPEED_TIME", 10), ("LOW_SPEED_LIMIT", 1)):
            gdal.SetConfigOption(f"GDAL_HTTP_{key}", str(seconds))
    data = gdal.Open(name)
    side = options.pixel_size or 1.0
    return data, (data.GetGeoTransform(can_return_null=True)
                  or (0, side, 0, data.RasterYSize * side, 0, -side))


def mebibytes(count):
    return f"{count / 2**20:.3g} MiB"


def check(options):
    """Rejects wrong combinations of arguments."""
    if options.patches and len(options.files) > 1:
        raise Failed(f"--patch is given with {len(options.files)} files; accepted: patches on one")
    if getattr(options, "fields", None) and len(options.files) > 1:
        raise Failed(f"--field is given with {len(options.files)} files; accepted: fields on one")


def given(options):
    """Arguments of add_terrain."""
    return {name: getattr(options, name) for name in RASTER if getattr(options, name) is not None}


def add(scene, path, options, **more):
    """Adds the terrain of a file as a clipmap. Returns it and the texts of its warnings."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        terrain = scene.add_terrain(path, mode="clipmap", build_overviews=False, **{**given(options), **more})
    return terrain, [str(warning.message) for warning in caught]


def degrees(osr, wkt):
    """Returns the horizontal CRS and the geographic CRS of its body, or None without a CRS."""
    if not wkt:
        return None
    crs = osr.SpatialReference()
    crs.ImportFromWkt(wkt)
    crs = crs if not crs.IsCompound() else _horizontal(crs)
    geographic = crs.CloneGeogCS()
    for each in (crs, geographic):
        each.SetAxisMappingStrategy(osr.OAMS_TRADITIONAL_GIS_ORDER)
    return crs, geographic


def _horizontal(crs):
    crs = crs.Clone()
    crs.StripVertical()
    return crs


def lines(title, rows):
    """Returns a table of labels and values as text."""
    text = [title]
    for label, value in rows:
        value = value if isinstance(value, list) else [value]
        text.append(f"  {label:<12}{value[0]}")
        text.extend(f"  {'':<12}{line}" for line in value[1:])
    return "\n".join(text)
