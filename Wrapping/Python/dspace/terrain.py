"""Terrain: what is drawn of a raster, and what it answers."""
import numpy as np

from dspace import _wire
from dspace._fields import (Named, array_of, flag, keywords, numbers, put, put_color, put_given,
                            put_vector, refuse, shown)
from dspace._strict import Strict
from dspace.errors import InvalidArgument, WrongType
from dspace.objects import file_path


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

    def _label(self):
        return f"terrain {self._name!r}"

    def _query(self, x, y, what, map):
        x, y = (array_of(value, name, "a number or an array of numbers", self._label)
                for name, value in (("x", x), ("y", y)))
        try:
            x, y = np.broadcast_arrays(x, y)
        except ValueError:
            raise InvalidArgument(f"{self._label()}: x and y have the shapes {x.shape} and {y.shape}; "
                                  "accepted: shapes that broadcast", self._label()) from None
        command = self._scene._command()
        message = command.query_terrain
        message.terrain = self._name
        message.map = flag(map, "map", self._label)
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

    def _xy(self, points):
        array = array_of(points, "the points", "an array (n, 2)", self._label)
        if array.shape[-1:] != (2,):
            raise InvalidArgument(f"{self._label()}: the points have shape {array.shape}; accepted: "
                                  "(n, 2)", self._label())
        return array

    def heights(self, xy):
        """z of points (n, 2) in its frame; with normals() what dspace.rover stands vehicles on."""
        xy = self._xy(xy)
        return self.height(xy[..., 0], xy[..., 1])

    def normals(self, xy):
        """Unit normals (n, 3) at points (n, 2)."""
        xy = self._xy(xy)
        return self.normal(xy[..., 0], xy[..., 1])

    def slope_deg(self, x, y, map=False):
        """Degrees from level."""
        shape, values = self._query(x, y, "slope", map)
        return _unpack(values, "slope_deg", shape)

    def _convert(self, points, to_map):
        points = array_of(points, "the points", "an array (..., 3)", self._label)
        if points.shape[-1:] != (3,):
            raise InvalidArgument(f"{self._label()}: the points have shape {points.shape}; accepted: "
                                  "(..., 3)", self._label())
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
        points = np.empty((0, 2)) if isinstance(points, (list, tuple)) and not points else self._xy(points)
        command = self._scene._command()
        put(command.focus_terrain, self._label, terrain=self._name, radius=radius)
        _wire.put_array(command.focus_terrain, "point", points)
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


class TerrainMaking:
    """The part of Scene that opens terrain."""

    def add_terrain(self, path, name=None, frame=None, image=None, color=None, relief=None,
                    origin=None, triangles=None, fragment=None, lit=True, image_crs=None,
                    image_extent=None, band=None, crs=None, vertical_datum=None,
                    vertical_scale=None, vertical_offset=None, pixel_size=None):
        """A raster of heights (anything that GDAL opens) as a physical object.

        image: a file to drape over it, with image_crs and image_extent (left, top, right, bottom in
        map coordinates) where the file does not say; color: one colour; relief: shaded relief (the
        default), a dict of sun_azimuth_deg, sun_elevation_deg, color_by_height. lit: whether the
        scene's lights shade it as well. origin: map x, y[, height] that become the frame's origin,
        by default the raster's middle at height 0. triangles: the budget (200000).
        band, crs, vertical_datum ("ellipsoid", "sphere:R", "areoid", ...), vertical_scale and
        vertical_offset [m], pixel_size (map units): what the file does not say, or says wrongly."""
        path = file_path(path, "the path", "terrain")
        label = f"terrain {shown(path if name is None else name)}"
        if sum(value is not None for value in (image, color, relief)) > 1:
            raise InvalidArgument(f"{label}: several of image, color and relief are given; accepted: one "
                                  "of them", label)
        command = self._command()
        message = command.open_terrain
        put(message, label, path=path, name="" if name is None else name, frame=self._frame_id(frame))
        if image is not None:
            put(message.drape, label, path=file_path(image, "the image", label))
            put_given(message.drape, label, crs=image_crs)
            if image_extent is not None:
                message.drape.extent.extend(numbers(image_extent, 4, "image_extent", label,
                                                    "left, top, right, bottom"))
        elif color is not None:
            put_color(message.color, color, "the colour", label)
        elif relief is not None:
            message.relief.SetInParent()
            known = [field.name for field in message.relief.DESCRIPTOR.fields]
            if not isinstance(relief, dict):
                refuse(label, "relief", relief, f"a dict of {', '.join(known)}", WrongType)
            keywords(relief, known, f"{label}, relief")
            put(message.relief, label, **relief)
        if origin is not None:
            values = array_of(origin, "the origin", "map x, y[, height]", label).ravel()
            if len(values) not in (2, 3):
                refuse(label, "the origin", origin, "map x, y[, height]", WrongType)
            put_vector(message.map_origin, [*values, 0.0][:3], "the origin", label)
        message.fragment = self._fragment_name(fragment)
        message.unlit = not flag(lit, "lit", label)
        put_given(message, label, triangle_budget=triangles, band=band, crs=crs,
                  vertical_datum=vertical_datum, vertical_scale=vertical_scale,
                  vertical_offset=vertical_offset, pixel_size=pixel_size)
        return Terrain(self, self._execute(command).terrain.name)

    @property
    def terrains(self):
        """All terrains, by name."""
        return Named("terrain", {name: Terrain(self, name)
                                 for name in self._ask("list_terrains").terrains.name})
