"""Arrays of points, triangles and colors as MeshData messages."""
import numpy as np

from dspace._core.fields import array_of, color, named, number, put, reject
from dspace.errors import InvalidArgument, WrongType
from dspace.proto import objects_pb2 as pb

TRIANGLES, LINES, POINTS = (pb.MeshData.TRIANGLES, pb.MeshData.LINES, pb.MeshData.POINTS)
_CORNERS = {TRIANGLES: 3, LINES: 2, POINTS: 1}
# Evenly spaced colors of the colormap that is used if none is given: viridis, at nine places.
VIRIDIS = ("#440154", "#472d7b", "#3b528b", "#2c728e", "#21918c", "#28ae80", "#5ec962", "#addc30", "#fde725")
NO_DATA = (128, 128, 128, 255)  # the color of scalars that are NaN


def _wrong(about, what, array, accepted):
    raise InvalidArgument(named(about, f"{what} have shape {np.shape(array)}; accepted: {accepted}"), about)


def _require_finite(array, named, about):
    finite = np.isfinite(array)
    if not finite.all():
        row = np.flatnonzero(~finite.all(axis=1))[0]
        reject(about, named.format(row), array[row].tolist(), "finite numbers")


def points_of(points, about):
    """The points as an array of doubles (n, 3)."""
    array = array_of(points, "points", "an array (n, 3)", about)
    if array.ndim != 2 or array.shape[1] != 3:
        _wrong(about, "the points", array, "(n, 3)")
    if len(array) == 0:
        raise InvalidArgument(f"{about}: it has no points; accepted: 1 or more", about)
    _require_finite(array, "point {}", about)
    return array


def vectors_of(values, count, columns, what, about):
    """An array (count, columns) of finite numbers."""
    array = array_of(values, what, f"an array ({count}, {columns})", about)
    if array.shape != (count, columns):
        _wrong(about, f"the {what}", array, f"({count}, {columns}), a row for each point")
    _require_finite(array, f"row {{}} of the {what}", about)
    return array


def indices_of(values, corners, count, what, about):
    """An array (m, corners) of indices of `count` points."""
    try:
        array = np.asarray(values)
    except (TypeError, ValueError):
        array = np.asarray(None)
    if array.dtype.kind not in "iu" and array.size:
        raise WrongType(f"{about}: the {what} are of type {array.dtype}; accepted: integers", about)
    if array.size == 0:
        array = array.reshape(-1, corners).astype(np.int64)
    if array.ndim != 2 or array.shape[1] != corners:
        _wrong(about, f"the {what}", array, f"(m, {corners})")
    if array.size and (array.min() < 0 or array.max() >= count):
        row = np.flatnonzero(((array < 0) | (array >= count)).any(axis=1))[0]
        reject(about, f"row {row} of the {what}", array[row].tolist(), f"indices from 0 to {count - 1}, of the points")
    return array


def colors_of(values, rows, about):
    """Colors as an array (n, 4) of bytes, for one of the accepted numbers of rows."""
    try:
        array = np.asarray(values)
    except (TypeError, ValueError):
        array = np.asarray(None)
    if array.dtype.kind not in "uif" or array.ndim != 2 or array.shape[1] not in (3, 4):
        _wrong(about, "the colors", array, "(n, 3) or (n, 4), bytes, or numbers from 0 to 1")
    if len(array) not in rows:
        _wrong(about, "the colors", array, " or ".join(f"({n}, 3 or 4)" for n in rows))
    if array.dtype != np.uint8:
        if array.dtype.kind != "f":
            raise WrongType(f"{about}: the colors are of type {array.dtype}; accepted: uint8, or floats from 0 to 1",
                            about)
        bad = np.flatnonzero(~((array >= 0) & (array <= 1)).all(axis=1))
        if len(bad):
            reject(about, f"color {bad[0]}", array[bad[0]].tolist(), "numbers from 0 to 1")
        array = np.round(255 * array).astype(np.uint8)
    if array.shape[1] == 3:
        array = np.concatenate((array, np.full((len(array), 1), 255, np.uint8)), axis=1)
    return array


def map_scalars(scalars, rows, colormap, low, high, about):
    """The colors (n, 4), bytes, of scalars (n,)."""
    values = array_of(scalars, "scalars", "an array (n,) of numbers", about)
    if values.ndim != 1 or len(values) not in rows:
        _wrong(about, "the scalars", values, " or ".join(f"({n},)" for n in rows))
    known = values[np.isfinite(values)]
    low = (known.min() if len(known) else 0.0) if low is None else number(low, "low", about)
    high = (known.max() if len(known) else 1.0) if high is None else number(high, "high", about)
    if not (np.isfinite(low) and np.isfinite(high) and low <= high):
        raise InvalidArgument(f"{about}: low is {low:g} and high {high:g}; accepted: two finite numbers, low <= high",
                              about)
    try:
        words = list(VIRIDIS if colormap is None else colormap)
    except TypeError:
        reject(about, "the colormap", colormap, "a list of colors, evenly spaced from low to high", WrongType)
    if len(words) < 2:
        reject(about, "the colormap", colormap, "2 or more colors")
    table = np.array([color(each, "a color of the colormap", about) for each in words])
    with np.errstate(invalid="ignore", divide="ignore"):
        place = np.where(values <= low, 0.0, np.clip((values - low) / (high - low), 0, 1))
    place *= len(table) - 1
    out = np.empty((len(values), 4), np.uint8)
    valid = ~np.isnan(values)
    for c in range(3):
        out[:, c] = np.round(255 * np.interp(np.nan_to_num(place), np.arange(len(table)), table[:, c]))
    out[:, 3] = 255
    out[~valid] = NO_DATA
    return out


def fill(data, points, primitive, cells=None, part="", normals=None, tcoords=None, colors=None, cell_colors=None,
         cell_normals=None, about=None):
    """Writes a mesh into a MeshData message.

    points: doubles (n, 3); an origin is subtracted from points that are farther from zero than they are from each
    other, so that single precision keeps their shape. cells: indices (m, 3, 2 or 1). Points that no cell uses are left
    out. normals, tcoords, colors: for each point. cell_colors, cell_normals: for each cell, which then has points of
    its own."""
    if cells is None:
        cells = np.arange(len(points)).reshape(-1, 1)
    rows = cells.ravel()
    if cell_colors is not None or cell_normals is not None:
        index, count = None, len(rows)
        each = np.repeat(np.arange(len(cells)), cells.shape[1])
    else:
        used = np.zeros(len(points), bool)
        used[rows] = True
        if used.all():
            index, rows = rows, slice(None)
        else:
            places = np.cumsum(used) - 1
            index, rows = places[rows], np.flatnonzero(used)
    points = points[rows]
    columns = np.ascontiguousarray(points.T)  # faster than along the first axis
    least, most = columns.min(axis=1), columns.max(axis=1)
    center = 0.5 * (least + most)
    if np.linalg.norm(center) > np.linalg.norm(most - least):
        data.origin.x, data.origin.y, data.origin.z = center
        points = points - center
    with np.errstate(over="ignore"):
        data.position = points.astype("<f4").tobytes()
    data.primitive = primitive
    put(data, about, part=part)
    if cell_normals is not None:
        data.normal = cell_normals[each].astype("<f4").tobytes()
    elif normals is not None:
        data.normal = normals[rows].astype("<f4").tobytes()
    if tcoords is not None:
        data.tcoord = tcoords[rows].astype("<f4").tobytes()
    if cell_colors is not None:
        data.color = cell_colors[each].tobytes()
    elif colors is not None:
        data.color = np.ascontiguousarray(colors[rows]).tobytes()
    if index is not None:
        data.index = index.astype("<u4").tobytes()
    if data.color:  # they multiply the material
        data.material.color.r = data.material.color.g = data.material.color.b = 1.0


def to_arrays(data):
    """The arrays of a MeshData message as a dict: points (n, 3) in doubles, cells (m, 3, 2 or 1), normals, tcoords and
    colors (n, ...) or None."""
    def array(data, kind, columns):
        return np.frombuffer(data, kind).reshape(-1, columns) if data else None

    points = array(data.position, "<f4", 3).astype(float)
    if data.HasField("origin"):
        points = points + (data.origin.x, data.origin.y, data.origin.z)
    corners = _CORNERS[data.primitive]
    cells = array(data.index, "<u4", corners)
    return {"points": points, "cells": np.arange(len(points)).reshape(-1, corners) if cells is None else cells,
            "normals": array(data.normal, "<f4", 3), "tcoords": array(data.tcoord, "<f4", 2),
            "colors": array(data.color, np.uint8, 4)}
