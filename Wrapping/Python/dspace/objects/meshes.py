"""Objects made of arrays."""
import numpy as np

from dspace._core.fields import array_of, items, keywords, put, reject, text
from dspace.errors import InvalidArgument, WrongType
from dspace.objects import arrays
from dspace.objects.arrays import LINES, POINTS, TRIANGLES
from dspace.objects.graphics import GraphicsObject

ARRAYS = ("points", "triangles", "lines", "normals", "colors", "scalars", "colormap", "low", "high", "tcoords")


def _by_part(values, corners, count, what, about):
    """{name of the part: indices} of an array, or of a dict of arrays."""
    if values is None:
        return {}
    if not isinstance(values, dict):
        return {"": arrays.indices_of(values, corners, count, what, about)}
    return {text(part, "the name of a part", about): arrays.indices_of(each, corners, count, what,
                                                                      f"{about}, part {part!r}")
            for part, each in values.items()}


def put_level(level, about, points=None, triangles=None, lines=None, normals=None, colors=None, scalars=None,
              colormap=None, low=None, high=None, tcoords=None):
    """Writes the arrays of Scene.add_mesh into a MeshLevel message."""
    if points is None:
        raise InvalidArgument(f"{about}: no points are given; accepted: an array (n, 3)", about)
    points = arrays.points_of(points, about)
    count = len(points)
    if normals is not None:
        normals = arrays.vectors_of(normals, count, 3, "normals", about)
    if tcoords is not None:
        tcoords = arrays.vectors_of(tcoords, count, 2, "tcoords", about)
    parts = [(TRIANGLES, part, cells) for part, cells in _by_part(triangles, 3, count, "triangles", about).items()]
    parts += [(LINES, part, cells) for part, cells in _by_part(lines, 2, count, "lines", about).items()]
    if triangles is None and lines is None:
        parts = [(POINTS, "", None)]
    parts = [each for each in parts if each[2] is None or len(each[2])]
    if not parts:
        raise InvalidArgument(f"{about}: it has no triangles and no lines; accepted: 1 or more, or neither argument for "
                              "points", about)
    rows = [count] + ([sum(len(cells) for _, _, cells in parts)] if parts[0][2] is not None else [])
    if scalars is not None and colors is not None:
        raise InvalidArgument(f"{about}: colors and scalars are given; accepted: one of them", about)
    if scalars is not None:
        colors = arrays.map_scalars(scalars, rows, colormap, low, high, about)
    elif colormap is not None or low is not None or high is not None:
        raise InvalidArgument(f"{about}: colormap, low or high is given without scalars; accepted: with scalars", about)
    elif colors is not None:
        colors = arrays.colors_of(colors, rows, about)
    of_cells = colors is not None and len(colors) != count
    at = 0
    for primitive, part, cells in parts:
        here = None
        if of_cells:
            here = colors[at:at + len(cells)]
            at += len(cells)
        arrays.fill(level.mesh.add(), points, primitive, cells, part, normals if primitive == TRIANGLES else None, tcoords,
                    None if of_cells else colors, here, about=about)


def levels_of(levels, about, accepted):
    """[(content, pixels)] of coarser levels of detail."""
    found = []
    for each in items(levels, "levels", about, accepted):
        if not isinstance(each, (tuple, list)) or len(each) != 2:
            reject(about, "a level", each, accepted, WrongType)
        found.append(tuple(each))
    return found


def put_mesh_levels(message, about, given, pixels, levels):
    """Writes the arrays `given` and those of the coarser levels into a CreateMesh or SetMesh message."""
    finest = message.level.add()
    put(finest, about, minimum_pixels=pixels)
    put_level(finest, about, **given)
    for content, minimum in levels_of(levels, about, "(dict of points, triangles, ..., pixels)"):
        if not isinstance(content, dict):
            reject(about, "a level", content, f"a dict of {', '.join(ARRAYS)}", WrongType)
        keywords(content, ARRAYS, f"{about}, a level")
        level = message.level.add()
        put(level, about, minimum_pixels=minimum)
        put_level(level, f"{about}, level {len(message.level) - 1}", **content)


class Mesh(GraphicsObject):
    """An object made of arrays, from Scene.add_mesh."""

    def __init__(self, scene, id, given=None, pixels=0.0, levels=()):
        super().__init__(scene, id)
        self._given, self._pixels, self._levels = dict(given or {}), pixels, levels

    def update(self, levels=None, **given):
        """Replaces arrays. Arguments are the arrays of Scene.add_mesh; what is not given stays as it was, None removes an
        array. Arrays that were changed in place are read again: `points[:] = ...; mesh.update()`. The name, the frame,
        the material and overrides of parts stay.

        All is checked before anything changes. Equal arrays are stored once, in memory, on the GPU and in recordings."""
        about = self._label()
        keywords(given, ARRAYS, about)
        command = self._scene._command()
        command.set_mesh.object = self._id
        now = {**self._given, **given}
        coarser = self._levels if levels is None else levels
        put_mesh_levels(command.set_mesh, about, now, self._pixels, coarser)
        self._scene._execute(command)
        self._given, self._levels = now, coarser
