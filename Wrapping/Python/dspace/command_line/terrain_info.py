"""`dspace terrain info`."""
import json
import math
import sys
import warnings

import numpy as np

from dspace.command_line import Failed, tell
from dspace.command_line.terrain_layers import file_and_band
from dspace.command_line.terrain_rasters import add, check, degrees, gdal_modules, lines, mebibytes, open_raster

MESH_PIXELS = 4_000_000  # the largest raster that mode "auto" draws as triangles
STATISTICS_PIXELS = 4_000_000  # the largest number of pixels that statistics read
TILE = 128
PROBES = 65  # places along a side of the terrain where fields are asked for values


def run(options):
    import dspace
    check(options)
    failed = 0
    found = []
    with dspace.Session() as session:
        for number, path in enumerate(options.files):
            try:
                found.append(describe(session.scene(f"scene {number}"), path, options))
            except (dspace.Error, Failed, RuntimeError) as error:  # RuntimeError: GDAL's
                failed = tell(error if str(path) in str(error) else f"'{path}': {error}")
                continue
            if not options.json:
                print(("\n" if len(found) > 1 else "") + as_text(found[-1]))
    if options.json:
        json.dump(finite(found), sys.stdout, indent=2, ensure_ascii=False, allow_nan=False)
        print()
    return failed


def finite(value):
    """Returns the value with None in place of numbers that JSON cannot hold."""
    if isinstance(value, dict):
        return {key: finite(each) for key, each in value.items()}
    if isinstance(value, (list, tuple)):
        return [finite(each) for each in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def describe(scene, path, options):
    """Returns all properties of a raster and its terrain as a dict for JSON."""
    import dspace
    gdal, osr = gdal_modules()
    terrain, warned = add(scene, path, options, name="plane")
    info = terrain._info()
    data, to_map = open_raster(gdal, path, options)
    fields = [describe_field(gdal, terrain, name, path, warned) for name, path in options.fields or ()]
    band = data.GetRasterBand(options.band or 1)
    crs = degrees(osr, info.crs)
    to_map = np.array(to_map)
    found = {
        "path": str(path),
        "driver": data.GetDriver().ShortName,
        "columns": data.RasterXSize, "rows": data.RasterYSize,
        "type": gdal.GetDataTypeName(band.DataType), "band": options.band or 1, "bands": data.RasterCount,
        "crs": crs[0].GetName() if crs else None, "crs_wkt": info.crs or None,
        "map_unit": map_unit(crs),
        "pixel_width": info.pixel_width, "pixel_height": info.pixel_height,
        "pixel_width_m": (terrain.extent[1] - terrain.extent[0]) / max(data.RasterXSize - 1, 1),
        "vertical_datum": info.vertical_datum,
        "unit": band.GetUnitType() or None,
        "vertical_scale": info.vertical_scale, "vertical_offset_m": info.vertical_offset,
        "no_data": number_or_none(band.GetNoDataValue()),
        "overviews": [[level.XSize, level.YSize] for level in map(band.GetOverview, range(band.GetOverviewCount()))],
        "cached_overviews": info.overviews if info.overviews_are_cached else 0,
        **bounds(osr, crs, to_map, data.RasterXSize, data.RasterYSize),
        "statistics": statistics(data, band, info),
        "plane": pyramid(info, options),
        "body": on_body(dspace, scene, path, options),
        "patches": terrain.patches,
        "fields": fields,
        "auto_mode": ("triangles" if data.RasterXSize * data.RasterYSize <= MESH_PIXELS and not options.patches
                      else "clipmap"),
        "warnings": warned,
    }
    return found


def number_or_none(value):
    return None if value is None or not math.isfinite(value) else value


def map_unit(crs):
    if not crs:
        return "unit"
    return "degree" if crs[0].IsGeographic() else crs[0].GetLinearUnitsName()


# --- Where it is -----------------------------------------------------------------------------------

def bounds(osr, crs, to_map, columns, rows):
    """Returns the bounds of the outer pixel edges, in map coordinates and in longitude and latitude."""
    u, v = (np.linspace(0, n, 65) for n in (columns, rows))
    edge = np.concatenate([np.column_stack((u, 0 * u)), np.column_stack((0 * v + columns, v)),
                           np.column_stack((u[::-1], 0 * u + rows)), np.column_stack((0 * v, v[::-1]))])
    x = to_map[0] + edge @ to_map[1:3]
    y = to_map[3] + edge @ to_map[4:6]
    found = {"map": {"x": [x.min(), x.max()], "y": [y.min(), y.max()]}, "longitude": None, "latitude": None}
    if not crs:
        return found
    if crs[0].IsGeographic():
        longitude, latitude = x, y
    else:
        try:
            there = osr.CoordinateTransformation(*crs)
            points = np.array(there.TransformPoints(np.column_stack((x, y)).tolist()))[:, :2]
        except RuntimeError:  # outside the domain of the projection
            return found
        if not np.isfinite(points).all():
            return found
        # An edge that crosses the date line continues beyond 180 degrees.
        longitude, latitude = np.degrees(np.unwrap(np.radians(points[:, 0]))), points[:, 1]
        if abs(longitude[-1] - longitude[0]) > 180:  # around a pole
            found["longitude"] = [-180.0, 180.0]
            pole = 90.0 if latitude.mean() > 0 else -90.0
            found["latitude"] = sorted([pole, latitude.min() if pole > 0 else latitude.max()])
            return found
    found["longitude"] = [longitude.min(), longitude.max()]
    found["latitude"] = [max(latitude.min(), -90.0), min(latitude.max(), 90.0)]
    return found


# --- What it holds ---------------------------------------------------------------------------------

def sample(data, band):
    """Returns values of a band, and how they were taken, as a dict. Values without data are left out."""
    columns, rows = data.RasterXSize, data.RasterYSize
    shrink = max(1, math.ceil(math.sqrt(columns * rows / STATISTICS_PIXELS)))
    size = (math.ceil(columns / shrink), math.ceil(rows / shrink))
    values = band.ReadAsArray(buf_xsize=size[0], buf_ysize=size[1]).astype(float)
    seen = band.GetMaskBand().ReadAsArray(buf_xsize=size[0], buf_ysize=size[1]) != 0
    seen &= np.isfinite(values)
    return values[seen], {
        "of": "all pixels" if shrink == 1 else "a sample", "pixels": int(seen.size), "every": shrink,
        "from_overviews": shrink > 1 and band.GetOverviewCount() > 0, "holes": int(seen.size - seen.sum()),
        "hole_fraction": float(1.0 - seen.mean())}


def statistics(data, band, info):
    """Returns statistics of the heights, in metres above the vertical datum."""
    values, found = sample(data, band)
    heights = values * info.vertical_scale + info.vertical_offset
    datum = info.vertical_datum.split(":")
    if datum[0] == "radius" and len(datum) > 1:
        heights = heights - float(datum[1])
    found.update(minimum_m=None, maximum_m=None, mean_m=None)
    if len(heights):
        found.update(minimum_m=float(heights.min()), maximum_m=float(heights.max()),
                     mean_m=float(heights.mean()))
    return found


def describe_field(gdal, terrain, name, given, warned):
    """Adds a field to the terrain. Returns what its raster holds, and how much of the terrain it covers, as a dict."""
    path, band_number = file_and_band(given)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        field = terrain.add_field(name, path, band=band_number)
    warned.extend(str(warning.message) for warning in caught)
    data = gdal.Open(field.path)
    band = data.GetRasterBand(field.band)
    values, statistic = sample(data, band)
    scale, offset = band.GetScale(), band.GetOffset()
    values = values * (1.0 if scale is None else scale) + (offset or 0.0)
    classes = np.unique(values[:: max(1, len(values) // STATISTICS_PIXELS)]) if band.DataType == gdal.GDT_Byte else ()
    left, top, right, bottom = terrain.map_extent
    inside = (np.arange(PROBES) + 0.5) / PROBES
    x, y = np.meshgrid(left + inside * (right - left), top + inside * (bottom - top))
    there = terrain.value(name, x, y, map=True)
    return {
        "name": name, "path": field.path, "driver": data.GetDriver().ShortName,
        "columns": field.size[0], "rows": field.size[1], "type": gdal.GetDataTypeName(band.DataType),
        "band": field.band, "bands": data.RasterCount, "units": field.units or None, "crs_wkt": field.crs or None,
        "pixel_size_m": field.pixel_size, "no_data": number_or_none(band.GetNoDataValue()),
        "description": band.GetDescription() or None, "different_values": len(classes) or None,
        "statistics": {**statistic, **{key: float(find(values)) if len(values) else None for key, find in (
            ("minimum", np.min), ("maximum", np.max), ("mean", np.mean))}},
        "covered_fraction": float(np.isfinite(there).mean()),
    }


# --- How it is drawn -------------------------------------------------------------------------------

def pyramid(info, options, periodic=False):
    cells = options.level_size or 124
    levels = []
    for level in range(info.levels):
        step = 1 << level
        wide = (info.post_columns >> level if periodic else -(-(info.post_columns - 1) // step) + 1)
        high = -(-(info.post_rows - 1) // step) + 1
        levels.append({"posts": [wide, high], "spacing": info.pixel_width * step / (1 << info.subdivisions)})
    resampled = None if not info.resampled_columns else {
        "columns": info.resampled_columns, "posts": info.resampling_posts,
        "rms_error_m": info.resampling_rms_error, "greatest_error_m": info.resampling_greatest_error}
    return {"subdivisions": info.subdivisions, "closed": bool(periodic), "levels": levels,
            "resampled": resampled,
            "level_size": cells, "triangles_at_most": 2 * cells * cells + (info.levels - 1) * 3 * cells * cells // 2,
            "bytes_of_all_tiles": 4 * info.columns * info.rows,
            "byte_budget": options.byte_budget or 256 << 20}


def on_body(dspace, scene, path, options):
    """Returns the pyramid of the terrain on its body, or the reason why it cannot be placed there."""
    try:
        terrain, _ = add(scene, path, options, name="body", on_body=True)
    except dspace.Error as error:
        return {"refused": str(error)}
    left, top, right, bottom = terrain.map_extent
    edges = terrain.from_map([[x, 0.5 * (top + bottom), 0.0] for x in (left, right)])
    return pyramid(terrain._info(), options, periodic=np.linalg.norm(edges[1] - edges[0]) < 1e-6 * np.linalg.norm(edges[0]))


# --- As text ---------------------------------------------------------------------------------------

def as_text(found):
    statistic = found["statistics"]
    heights = "no data at all" if statistic["mean_m"] is None else (
        f"{statistic['minimum_m']:.6g} to {statistic['maximum_m']:.6g} m, mean {statistic['mean_m']:.6g} m")
    if statistic["every"] == 1:
        source = "of all pixels"
    else:
        how = "from its overviews" if statistic["from_overviews"] else "it has no overviews"
        source = f"estimated from one value for {statistic['every']} x {statistic['every']} pixels ({how})"
    place = [span(found["map"]["x"], "x") + ", " + span(found["map"]["y"], "y")]
    if found["longitude"]:
        place.append(span(found["longitude"], "longitude") + ", " + span(found["latitude"], "latitude"))
    scale = f"metres = value * {found['vertical_scale']:.9g}"
    if found["vertical_offset_m"]:
        scale += f" + {found['vertical_offset_m']:.9g}"
    if found["vertical_datum"].startswith("radius:"):
        scale += " less the radius"
    rows = [
        ("raster", f"{found['driver']}, {found['columns']} x {found['rows']} pixels of {found['type']}, "
                   f"band {found['band']} of {found['bands']}"),
        ("CRS", found["crs"] or "none"),
        ("pixel", f"{found['pixel_width']:.9g} x {found['pixel_height']:.9g} {found['map_unit']}s"
                  + (f" ({found['pixel_width_m']:.6g} m wide in its middle)" if found["map_unit"] == "degree" else "")),
        ("extent", place),
        ("heights", f"{scale} (unit {'not stated' if found['unit'] is None else repr(found['unit'])}), "
                    f"vertical datum {found['vertical_datum']}"),
        ("no-data", "none stated" if found["no_data"] is None else f"{found['no_data']:.9g}"),
        ("overviews", (", ".join(f"{w} x {h}" for w, h in found["overviews"]) or "none")
         + (f" of its own, {found['cached_overviews']} levels in the cache" if found["cached_overviews"] else "")),
        ("statistics", [heights + "; " + (f"{statistic['holes']} holes ({100 * statistic['hole_fraction']:.3g} %)"
                                          if statistic["holes"] else "no holes"), source]),
        ("drawn", f"{found['auto_mode']}, unless the mode is chosen (triangles up to {MESH_PIXELS} pixels)"),
        ("on a plane", pyramid_text(found["plane"], found["map_unit"])),
        ("on its body", "no: " + found["body"]["refused"] if "refused" in found["body"]
         else pyramid_text(found["body"], found["map_unit"])),
        ("tiles", f"{TILE} x {TILE} posts of 4 bytes; all pixels {mebibytes(found['plane']['bytes_of_all_tiles'])}, "
                  f"at most {mebibytes(found['plane']['byte_budget'])} of them in memory"),
    ]
    rows += [("patch", patch_text(patch)) for patch in found["patches"]]
    rows += [("field", field_text(field)) for field in found["fields"]]
    rows += [("warning", warning) for warning in found["warnings"]]
    return lines(found["path"], rows)


def patch_text(patch):
    low, high = patch["height_range"]
    return [f"{patch['name']}: a pixel is {patch['pixel_size']:.6g} m, {low:.6g} to {high:.6g} m, blended over "
            f"{patch['margin']:.6g} m" if patch["used"] else f"{patch['name']}: adds nothing",
            f"drawn within {patch['greatest_error']:.3g} m of its own posts (rms {patch['rms_error']:.3g} m)"]


def field_text(field):
    statistic = field["statistics"]
    units = f" {field['units']}" if field["units"] else " (no units stated)"
    values = "no data at all" if statistic["mean"] is None else (
        f"{statistic['minimum']:.6g} to {statistic['maximum']:.6g}{units}, mean {statistic['mean']:.6g}")
    if field["different_values"]:
        values += f"; {field['different_values']} different values"
    values += f"; {statistic['holes']} holes ({100 * statistic['hole_fraction']:.3g} %)" if statistic["holes"] else ""
    no_data = "none stated" if field["no_data"] is None else f"{field['no_data']:.9g}"
    return [f"{field['name']}: {field['path']}" + (f", {field['description']}" if field["description"] else ""),
            f"{field['driver']}, {field['columns']} x {field['rows']} pixels of {field['type']}, band {field['band']} of "
            f"{field['bands']}, a pixel is {field['pixel_size_m']:.6g} m, no-data {no_data}",
            values + ("" if statistic["every"] == 1 else f" (one value for {statistic['every']} x {statistic['every']} "
                      "pixels)"),
            f"covers {100 * field['covered_fraction']:.3g} % of the terrain"]


def span(pair, name):
    return f"{name} {pair[0]:.9g} to {pair[1]:.9g}"


def pyramid_text(made, unit):
    divided = (f", a pixel's side halved {made['subdivisions']} times" if made["subdivisions"] else "")
    text = [f"a clipmap of {len(made['levels'])} levels of {made['level_size']} x {made['level_size']} cells"
            f"{divided}{', closed around the body' if made['closed'] else ''}: at most "
            f"{made['triangles_at_most']} triangles a view"]
    if made["resampled"]:
        cost = made["resampled"]
        text.append(f"resampled to {cost['columns']} columns, which halve: within {cost['greatest_error_m']:.3g} m "
                    f"of its pixels (rms {cost['rms_error_m']:.3g} m, at {cost['posts']} of them)")
    for level, row in enumerate(made["levels"]):
        text.append(f"level {level:>2}: {row['posts'][0]} x {row['posts'][1]} posts, one every "
                    f"{row['spacing']:.6g} {unit}s")
    return text
