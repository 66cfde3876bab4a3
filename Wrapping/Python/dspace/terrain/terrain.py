"""Terrain: a raster of heights, and queries of it."""
import numpy as np

from dspace._core import wire
from dspace._core.delegates import delegate
from dspace._core.fields import array_of, flag, put, put_given
from dspace._core.strict import Strict
from dspace.errors import InvalidArgument
from dspace.terrain.layers import TerrainLayers
from dspace.terrain.style import TerrainStyle
from dspace.terrain.tracks import TerrainTracks

MODES = ("auto", "triangles", "clipmap")  # in the order of OpenTerrain.Mode


class Terrain(Strict):
    """A raster of heights in a frame S: X east, Y north, Z up from its origin [m]; on its body, the
    body-fixed frame (Z to the north pole, X to longitude 0).

    Queries are answered from the full-resolution posts, in double precision, on the same triangles
    between them that are drawn near the camera (of a clipmap) or the focus. Those of a clipmap read
    the tiles that they need.
    """

    def __init__(self, scene, name, undisturbed=False):
        self._scene = scene
        self._name = name
        self._undisturbed = undisturbed  # queries leave wheel tracks out

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
        """The vertical datum of the heights."""
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
        """The number of triangles of mode "triangles". 0 of a clipmap, whose triangles depend on the view
        (session.statistics counts them)."""
        return self._info().triangles

    @property
    def mode(self):
        """"triangles" or "clipmap"."""
        return MODES[self._info().mode]

    @property
    def on_body(self):
        """Whether it stands on its body, else on a plane."""
        return self._info().on_body

    @property
    def tiles(self):
        """Of a clipmap: a dict of levels, subdivisions (halvings of a pixel's side between its
        posts), bytes (in memory), loads, failures and last_failure (a message, or "")."""
        info = self._info()
        return {"levels": info.levels, "subdivisions": info.subdivisions, "bytes": info.tile_bytes,
                "loads": info.tile_loads, "failures": info.tile_failures,
                "last_failure": info.last_failure}

    @property
    def overviews(self):
        """Of a clipmap, a dict: levels (that it reads), cached (else they are the file's own), build
        (of those that are missing, in the background: None, "building", "built", "failed"), progress
        (0 to 1) and failure (why; drawing goes on without)."""
        info = self._info()
        return {"levels": info.overviews, "cached": info.overviews_are_cached,
                "build": (None, "building", "built", "failed")[info.overview_build],
                "progress": info.overview_progress, "failure": info.overview_failure}

    @property
    def resampling(self):
        """Of a clipmap on its body whose raster's columns do not halve often enough, a dict: columns
        (around the body instead of the raster's); rms_error and greatest_error [m] of the surface
        against the raster's pixels, measured at `posts` of them taken at random. Else None."""
        info = self._info()
        return {"columns": info.resampled_columns, "posts": info.resampling_posts,
                "rms_error": info.resampling_rms_error,
                "greatest_error": info.resampling_greatest_error} if info.resampled_columns else None

    @property
    def patches(self):
        """Of a clipmap, a dict for each patch: name; used (else it adds nothing, as a warning said);
        pixel_size and margin [m]; added [m] to its heights for its vertical datum; height_range [m];
        rms_error and greatest_error [m] of the surface against the patch's own posts (what resampling
        costs), measured at `posts` of them taken at random where nothing is blended."""
        return [{"name": patch.name, "used": patch.used, "pixel_size": patch.pixel_size,
                 "margin": patch.margin, "added": patch.added,
                 "height_range": (patch.minimum_height, patch.maximum_height), "posts": patch.posts,
                 "rms_error": patch.rms_error, "greatest_error": patch.greatest_error}
                for patch in self._info().patch]

    @property
    def undisturbed(self):
        """The same terrain without wheel tracks: its height(), normal(), ... ignore ruts."""
        return type(self)(self._scene, self._name, undisturbed=True)

    # --- Layers, style and tracks --------------------------------------------------------------

    add_image = delegate(TerrainLayers, "add_image")
    add_false_color = delegate(TerrainLayers, "add_false_color")
    add_shapes = delegate(TerrainLayers, "add_shapes")
    add_noise = delegate(TerrainLayers, "add_noise")
    layers = delegate(TerrainLayers, "layers")
    layer = delegate(TerrainLayers, "layer")
    layer_tiles = delegate(TerrainLayers, "layer_tiles")
    set_style = delegate(TerrainStyle, "set_style")
    style = delegate(TerrainStyle, "style")
    track = delegate(TerrainTracks, "track")
    clear_tracks = delegate(TerrainTracks, "clear_tracks")
    save_tracks = delegate(TerrainTracks, "save_tracks")
    load_tracks = delegate(TerrainTracks, "load_tracks")
    tracks = delegate(TerrainTracks, "tracks")

    # --- Queries -------------------------------------------------------------------------------

    def _label(self):
        return f"terrain {self._name!r}"

    def _query(self, x, y, what, map, z=None, asked=True):
        given = [("x", x), ("y", y)] + ([] if z is None else [("z", z)])
        given = [array_of(value, name, "a number or an array of numbers", self._label)
                 for name, value in given]
        try:
            given = np.broadcast_arrays(*given)
        except ValueError:
            names = "x and y" if z is None else "x, y and z"
            shapes = " and ".join(str(array.shape) for array in given)
            raise InvalidArgument(f"{self._label()}: {names} have the shapes {shapes}; accepted: "
                                  "shapes that broadcast", self._label()) from None
        command = self._scene._command()
        message = command.query_terrain
        message.terrain = self._name
        message.map = flag(map, "map", self._label)
        message.undisturbed = self._undisturbed
        put(message, self._label, **{what: asked})
        message.spatial = z is not None
        wire.put_array(message, "point", np.stack(given, axis=-1))
        return given[0].shape, self._scene._execute(command).terrain_values

    def height(self, x, y, z=None, map=False):
        """z of the surface [m] at x, y (numbers or arrays, shapes broadcast); NaN without data.

        With the ruts of wheels; terrain.undisturbed.height() is without.
        In the terrain's frame; with map=True, x and y are map coordinates and the result is the
        height above the vertical datum. On a body give map=True (longitude and latitude, for a
        degree grid) or x, y and z, through which the local vertical goes: heights above the datum."""
        shape, values = self._query(x, y, "height", map, z)
        return _unpack(values, "height", shape)

    def normal(self, x, y, z=None, map=False):
        """Unit normals (..., 3) in the terrain's frame, of the surface at x, y as for height()."""
        shape, values = self._query(x, y, "normal", map, z)
        return _unpack(values, "normal", shape + (3,))

    def filled(self, x, y, z=None, map=False):
        """Whether the ground at x, y (as for height()) is made up by add_terrain's fill_holes: True or
        False, or an array; False as well where there is no ground. Clipmaps only."""
        shape, values = self._query(x, y, "filled", map, z)
        made = wire.get_array(values, "filled").reshape(shape) == 1.0
        return bool(made) if shape == () else made

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

    def slope_deg(self, x, y, z=None, map=False):
        """Degrees from level at x, y as for height()."""
        shape, values = self._query(x, y, "slope", map, z)
        return _unpack(values, "slope_deg", shape)

    def aspect_deg(self, x, y, z=None, map=False):
        """Azimuth of steepest descent at x, y as for height(): degrees clockwise from north, 0 to 360;
        NaN on level ground."""
        shape, values = self._query(x, y, "aspect", map, z)
        return _unpack(values, "aspect_deg", shape)

    def roughness(self, x, y, radius, z=None, map=False):
        """Root mean square [m] of the heights of the raster's pixels within `radius` metres of x, y (as
        for height()) about the plane that fits them best; NaN where they span none. Clipmaps only."""
        shape, values = self._query(x, y, "roughness_radius", map, z, radius)
        return _unpack(values, "roughness", shape)

    def intersect(self, origins, directions, maximum=None):
        """Distances [m] at which rays first meet the surface, from above or from below; infinity where
        they meet nothing within `maximum` metres (default: no limit).

        origins and directions (..., 3) in the terrain's frame, of shapes that broadcast; directions
        need not be unit. The point met is origin + distance * direction / |direction|."""
        given = [array_of(value, name, "an array (..., 3)", self._label)
                 for value, name in ((origins, "the origins"), (directions, "the directions"))]
        try:
            given = np.broadcast_arrays(*given)
        except ValueError:
            given = [np.empty(0)]
        if given[0].shape[-1:] != (3,):
            raise InvalidArgument(f"{self._label()}: origins and directions have the shapes "
                                  f"{np.shape(origins)} and {np.shape(directions)}; accepted: (..., 3), "
                                  "of shapes that broadcast", self._label())
        command = self._scene._command()
        message = command.intersect_terrain
        put(message, self._label, terrain=self._name)
        put_given(message, self._label, maximum=maximum)
        message.undisturbed = self._undisturbed
        wire.put_array(message, "ray", np.concatenate(given, axis=-1))
        return _unpack(self._scene._execute(command).terrain_rays, "distance", given[0].shape[:-1])

    def _convert(self, points, to_map):
        points = array_of(points, "the points", "an array (..., 3)", self._label)
        if points.shape[-1:] != (3,):
            raise InvalidArgument(f"{self._label()}: the points have shape {points.shape}; accepted: "
                                  "(..., 3)", self._label())
        command = self._scene._command()
        command.convert_terrain.terrain = self._name
        command.convert_terrain.to_map = to_map
        wire.put_array(command.convert_terrain, "point", points)
        reply = self._scene._execute(command).terrain_points
        return wire.get_array(reply, "point").reshape(points.shape)

    def to_map(self, points):
        """Map x, y and height above the datum of points (..., 3) in the terrain's frame."""
        return self._convert(points, True)

    def from_map(self, points):
        """Points (..., 3) in the terrain's frame of map x, y and height above the datum."""
        return self._convert(points, False)

    def focus(self, points, radius=20.0):
        """Where every post is drawn: within `radius` metres of x, y points (n, 2) in its frame.

        Replaces the earlier ones; only tiles that change are sent to the GPU. A clipmap draws every
        post near each camera by itself."""
        points = np.empty((0, 2)) if isinstance(points, (list, tuple)) and not points else self._xy(points)
        command = self._scene._command()
        put(command.focus_terrain, self._label, terrain=self._name, radius=radius)
        wire.put_array(command.focus_terrain, "point", points)
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
    array = wire.get_array(values, field).reshape(shape)
    return float(array) if shape == () else array
