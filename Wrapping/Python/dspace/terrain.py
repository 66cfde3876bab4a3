"""Terrain: what is drawn of a raster, and what it answers."""
import numpy as np

from dspace._strict import Strict
from dspace import _wire


class Terrain(Strict):
    """A raster of heights in a frame S: X east, Y north, Z up from its origin [m].

    Queries are answered from the full-resolution grid, in double precision, on the same triangles
    between posts that are drawn where the focus is.
    """

    def __init__(self, scene, name):
        self._scene = scene
        self._name = name

    def _info(self):
        return self._scene._ask("describe_terrain", terrain=self._name).terrain

    @property
    def name(self):
        return self._name

    @property
    def object(self):
        """The graphics object that shows it."""
        return self._scene._object(self._info().object)

    @property
    def frame(self):
        return self._scene._frame_of(self._info().frame)

    @property
    def size(self):
        """(columns, rows) of posts."""
        info = self._info()
        return (info.columns, info.rows)

    @property
    def crs(self):
        """WKT; "" without one."""
        return self._info().crs

    @property
    def vertical_datum(self):
        """What heights are above."""
        return self._info().vertical_datum

    @property
    def extent(self):
        """(west, east, south, north) in its frame [m]."""
        info = self._info()
        return (info.west, info.east, info.south, info.north)

    @property
    def height_range(self):
        """Least and greatest height above the vertical datum [m]."""
        info = self._info()
        return (info.minimum_height, info.maximum_height)

    @property
    def triangles(self):
        """Drawn now."""
        return self._info().triangles

    def _query(self, x, y, what, map):
        x, y = np.broadcast_arrays(np.asarray(x, dtype=float), np.asarray(y, dtype=float))
        command = self._scene._command()
        message = command.query_terrain
        message.terrain = self._name
        message.map = map
        setattr(message, what, True)
        _wire.put_array(message, "point", np.stack((x, y), axis=-1))
        return x.shape, self._scene._execute(command).terrain_values

    def height(self, x, y, map=False):
        """z of the surface [m] at x, y (numbers or arrays, shapes broadcast); NaN without data.

        In the terrain's frame; with map=True, x and y are map coordinates and z is the height above
        the vertical datum."""
        shape, values = self._query(x, y, "height", map)
        return _unpack(values, "height", shape)

    def normal(self, x, y, map=False):
        """Unit normals (..., 3) in the terrain's frame, of the triangle at x, y."""
        shape, values = self._query(x, y, "normal", map)
        return _unpack(values, "normal", shape + (3,))

    def slope_deg(self, x, y, map=False):
        """Degrees from level."""
        shape, values = self._query(x, y, "slope", map)
        return _unpack(values, "slope_deg", shape)

    def _convert(self, points, to_map):
        points = np.asarray(points, dtype=float)
        if points.shape[-1:] != (3,):
            raise ValueError(f"the points have shape {points.shape}; accepted: (..., 3)")
        command = self._scene._command()
        command.convert_terrain.terrain = self._name
        command.convert_terrain.to_map = to_map
        _wire.put_array(command.convert_terrain, "point", points)
        reply = self._scene._execute(command).terrain_points
        return _wire.get_array(reply, "point").reshape(points.shape)

    def to_map(self, points):
        """Map x, y and height above the datum of points (..., 3) in the terrain's frame."""
        return self._convert(points, True)

    def from_map(self, points):
        """The other way."""
        return self._convert(points, False)

    def focus(self, points, radius=20.0):
        """Where every post is drawn: within `radius` metres of x, y points (n, 2) in its frame.

        Replaces the earlier ones; only tiles that change are sent to the GPU."""
        command = self._scene._command()
        command.focus_terrain.terrain = self._name
        command.focus_terrain.radius = radius
        _wire.put_array(command.focus_terrain, "point", np.asarray(points, dtype=float))
        self._scene._execute(command)

    def remove(self):
        self._scene._do("remove_terrain", terrain=self._name)

    def __repr__(self):
        try:
            info = self._info()
            return (f"<dspace.Terrain {self._name!r}, {info.columns} x {info.rows} posts, "
                    f"{info.minimum_height:g} to {info.maximum_height:g} m>")
        except Exception:  # a repr never raises
            return f"<dspace.Terrain {self._name!r}, removed>"


def _unpack(values, field, shape):
    array = _wire.get_array(values, field).reshape(shape)
    return float(array) if shape == () else array
