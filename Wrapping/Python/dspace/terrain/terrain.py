"""Terrain: a raster of heights, and queries of it."""
import math

import numpy as np

from dspace._core import wire
from dspace._core.delegates import delegate
from dspace._core.fields import array_of, flag, put, put_given, text
from dspace._core.strict import Strict
from dspace.errors import InvalidArgument
from dspace.sky.sky import put_targets, sky_of
from dspace.terrain.coordinates import coordinates_of
from dspace.terrain.fields import TerrainFields
from dspace.terrain.geodesy import Geodesy
from dspace.terrain.layers import TerrainLayers
from dspace.terrain.site import Site
from dspace.terrain.style import TerrainStyle
from dspace.terrain.tracks import TerrainTracks

MODES = ("auto", "triangles", "clipmap")  # in the order of OpenTerrain.Mode


class Terrain(Strict):
    """A raster of heights in a frame S: X east, Y north, Z up from its origin [m]. On its body, S is the body-fixed
    frame (Z to the north pole, X to longitude 0).

    Queries use the full-resolution posts, in double precision, and the same triangles between them that are drawn near
    the camera (of a clipmap) or the focus. Queries of a clipmap read the tiles that they need.
    """

    def __init__(self, scene, name, undisturbed=False):
        self._scene = scene
        self._name = name
        self._undisturbed = undisturbed  # queries leave wheel tracks out
        self._stands_on_body = None  # not asked yet

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
        """The CRS as WKT; "" without one."""
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
        """Whether the terrain is on its body. Otherwise it is on a plane."""
        return self._info().on_body

    @property
    def tiles(self):
        """The state of a clipmap's tiles, a dict: levels, subdivisions (how many times the side of a pixel is halved),
        bytes (in memory), loads, failures, last_failure (a message, or "")."""
        info = self._info()
        return {"levels": info.levels, "subdivisions": info.subdivisions, "bytes": info.tile_bytes,
                "loads": info.tile_loads, "failures": info.tile_failures,
                "last_failure": info.last_failure}

    @property
    def overviews(self):
        """The overviews of a clipmap, a dict: levels (the number it reads), cached (False: they are the file's own),
        build (of missing overviews in the background: None, "building", "built", "failed"), progress (0 to 1), failure
        (why the build failed; drawing continues without)."""
        info = self._info()
        return {"levels": info.overviews, "cached": info.overviews_are_cached,
                "build": (None, "building", "built", "failed")[info.overview_build],
                "progress": info.overview_progress, "failure": info.overview_failure}

    @property
    def resampling(self):
        """The resampling of a clipmap on its body whose number of columns cannot be halved often enough, a dict:
        columns (the new number around the body); rms_error and greatest_error [m] of the surface against the raster's
        pixels, measured at `posts` random pixels. None without resampling."""
        info = self._info()
        return {"columns": info.resampled_columns, "posts": info.resampling_posts,
                "rms_error": info.resampling_rms_error,
                "greatest_error": info.resampling_greatest_error} if info.resampled_columns else None

    @property
    def patches(self):
        """The patches of a clipmap, a dict for each: name; used (False: it adds nothing, and a warning was given);
        pixel_size and margin [m]; added (to its heights for its vertical datum [m]); height_range [m]; rms_error and
        greatest_error [m] of the surface against the patch's own posts due to resampling, measured at `posts` random
        posts outside the margin."""
        return [{"name": patch.name, "used": patch.used, "pixel_size": patch.pixel_size,
                 "margin": patch.margin, "added": patch.added,
                 "height_range": (patch.minimum_height, patch.maximum_height), "posts": patch.posts,
                 "rms_error": patch.rms_error, "greatest_error": patch.greatest_error}
                for patch in self._info().patch]

    @property
    def undisturbed(self):
        """The same terrain without wheel tracks: its height(), normal(), ... ignore ruts."""
        return type(self)(self._scene, self._name, undisturbed=True)

    @property
    def map_extent(self):
        """(left, top, right, bottom): map x, y of the outer corners of its pixels."""
        return tuple(self._info().map_extent)

    def _map_is_in_degrees(self):
        """Whether map coordinates are longitude (east) and latitude [deg]; None: the map has neither."""
        left, top, right, bottom = self.map_extent
        x, y = 0.5 * (left + right), 0.5 * (top + bottom)
        found = self.locate((x, y, 0.0), map=True)
        if not (math.isfinite(found.longitude) and math.isfinite(found.latitude)):
            return None
        return abs((found.longitude - x + 180) % 360 - 180) < 1e-9 and abs(found.latitude - y) < 1e-9

    @property
    def overlap_columns(self):
        """On its body, if its columns go once around: by how many columns the ends of the file overlap; negative: a
        gap. The columns are stretched so that they go around exactly. Otherwise 0."""
        return self._info().overlap_columns

    # --- Layers, style and tracks --------------------------------------------------------------

    add_image = delegate(TerrainLayers, "add_image")
    add_false_color = delegate(TerrainLayers, "add_false_color")
    add_shapes = delegate(TerrainLayers, "add_shapes")
    add_noise = delegate(TerrainLayers, "add_noise")
    add_normals = delegate(TerrainLayers, "add_normals")
    layers = delegate(TerrainLayers, "layers")
    layer = delegate(TerrainLayers, "layer")
    layer_tiles = delegate(TerrainLayers, "layer_tiles")
    add_field = delegate(TerrainFields, "add_field")
    fields = delegate(TerrainFields, "fields")
    value = delegate(TerrainFields, "value")
    set_style = delegate(TerrainStyle, "set_style")
    change_style = delegate(TerrainStyle, "change_style")
    remove_style = delegate(TerrainStyle, "remove_style")
    style = delegate(TerrainStyle, "style")
    style_in = delegate(TerrainStyle, "style_in")
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
        if what == "field":
            message.field.extend(text(name, "the field", self._label) for name in asked)
        else:
            put(message, self._label, **{what: asked})
        message.spatial = z is not None
        wire.put_array(message, "point", np.stack(given, axis=-1))
        return given[0].shape, self._scene._execute(command).terrain_values

    def height(self, x, y, z=None, map=False):
        """Returns z of the surface [m] at x, y (numbers or arrays whose shapes broadcast); NaN without data.

        The result includes the ruts of wheels; terrain.undisturbed.height() excludes them. x, y and z are in the
        terrain's frame. With map=True, x and y are map coordinates and the result is the height above the vertical
        datum. On a body, give map=True (longitude and latitude for a degree grid), or x, y and z of a point on the
        local vertical; the result is the height above the datum."""
        shape, values = self._query(x, y, "height", map, z)
        return _unpack(values, "height", shape)

    def sky(self, x, y, targets="sun", height=0.0, body=None, time=None):
        """Where bodies stand over the map point x, y (longitude and latitude for a degree grid): dspace SkyBody by name,
        as Scene.sky. height: [m] above the ground. body: a name or NAIF id; None: the one that the terrain's CRS names.
        Azimuth is from the meridian's north, elevation from the horizontal of the CRS's ellipsoid. The terrain needs a
        CRS with longitudes and latitudes."""
        command = self._scene._command()
        message = command.sky_state
        put(message.site, self._label(), terrain=self.name, map_x=x, map_y=y, height=height)
        if body is not None:
            message.body = text(str(body), "the body", self._label())
        put_targets(self._scene, message, targets, time, self._label())
        return sky_of(self._scene._execute(command))

    def site(self, x, y, height=0.0, degrees=False):
        """A Site: points at map x, y (numbers or arrays whose shapes broadcast), `height` metres above the ground, 0 or more. The
        map of a degree grid is in longitude and latitude; with degrees=True x and y are that on any map, longitude east. For
        Scene.line_of_sight() and Scene.horizon(), which raise dspace.InvalidArgument where there is no data."""
        site = Site(self, x, y, height)
        if not flag(degrees, "degrees", self._label):
            return site
        places = np.stack((site.x, site.y, np.zeros(site.shape)), axis=-1)
        found = self.locate(places, degrees=True).map
        return Site(self, found[..., 0], found[..., 1], height)

    def normal(self, x, y, z=None, map=False):
        """Returns the unit normals (..., 3) of the surface, in the terrain's frame, at x, y as for height()."""
        shape, values = self._query(x, y, "normal", map, z)
        return _unpack(values, "normal", shape + (3,))

    def filled(self, x, y, z=None, map=False):
        """Returns whether add_terrain's fill_holes filled the ground at x, y (as for height()): a bool, or an array.
        False where there is no ground. Clipmaps only."""
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
        """Returns z [m] of points (n, 2) in the terrain's frame. dspace.rover places vehicles with it and normals()."""
        xy = self._xy(xy)
        return self.height(xy[..., 0], xy[..., 1])

    def normals(self, xy):
        """Returns the unit normals (n, 3) at points (n, 2)."""
        xy = self._xy(xy)
        return self.normal(xy[..., 0], xy[..., 1])

    def slope_deg(self, x, y, z=None, map=False):
        """Returns the slope in degrees from level at x, y as for height()."""
        shape, values = self._query(x, y, "slope", map, z)
        return _unpack(values, "slope_deg", shape)

    def aspect_deg(self, x, y, z=None, map=False):
        """Returns the azimuth of steepest descent at x, y as for height(), in degrees clockwise from north, 0 to 360;
        NaN on level ground."""
        shape, values = self._query(x, y, "aspect", map, z)
        return _unpack(values, "aspect_deg", shape)

    def roughness(self, x, y, radius, z=None, map=False):
        """Returns the root mean square [m] of the heights of the raster's pixels within `radius` metres of x, y (as for
        height()) about their best-fit plane; NaN if they span no plane. Clipmaps only."""
        shape, values = self._query(x, y, "roughness_radius", map, z, radius)
        return _unpack(values, "roughness", shape)

    def intersect(self, origins, directions, maximum=None):
        """Returns the distances [m] at which rays first meet the surface, from above or from below; infinity for rays
        that meet nothing within `maximum` metres (default: no limit).

        origins and directions: (..., 3) in the terrain's frame, with shapes that broadcast; directions need not be
        unit vectors. The intersection is origin + distance * direction / |direction|."""
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

    def _xyz(self, points):
        points = array_of(points, "the points", "an array (..., 3)", self._label)
        if points.shape[-1:] != (3,):
            raise InvalidArgument(f"{self._label()}: the points have shape {points.shape}; accepted: "
                                  "(..., 3)", self._label())
        return points

    def locate(self, points, map=False, degrees=False):
        """Returns the Coordinates of points (..., 3) in the terrain's frame; with map=True of map x, y and height above the
        vertical datum; or with degrees=True of longitude (east), latitude and that height: longitude, latitude and height
        on the CRS's ellipsoid, body-fixed, map and root coordinates.

        Longitude and latitude are those of the CRS's own geographic base. Heights above a geoid or an areoid are taken
        as heights above the ellipsoid."""
        points = self._xyz(points)
        command = self._scene._command()
        command.locate_terrain.terrain = self._name
        command.locate_terrain.map = flag(map, "map", self._label)
        command.locate_terrain.degrees = flag(degrees, "degrees", self._label)
        wire.put_array(command.locate_terrain, "point", points)
        return coordinates_of(self._scene._execute(command).coordinates.point, points.shape[:-1])

    @property
    def geodesy(self):
        """Distances, grid references and geoid heights on the ellipsoid of its CRS: a Geodesy. It takes longitudes and
        latitudes: those of locate(). Its methods raise dspace.Unsupported where the CRS has no ellipsoid."""
        return Geodesy(self._scene, terrain=self._name)

    def _convert(self, points, to_map):
        points = self._xyz(points)
        command = self._scene._command()
        command.convert_terrain.terrain = self._name
        command.convert_terrain.to_map = to_map
        wire.put_array(command.convert_terrain, "point", points)
        reply = self._scene._execute(command).terrain_points
        return wire.get_array(reply, "point").reshape(points.shape)

    def to_map(self, points):
        """Converts points (..., 3) in the terrain's frame to map x, y and height above the datum."""
        return self._convert(points, True)

    def from_map(self, points):
        """Converts map x, y and height above the datum (..., 3) to points in the terrain's frame."""
        return self._convert(points, False)

    def focus(self, points, radius=20.0):
        """Draws every post within `radius` metres of the x, y points (n, 2) in the terrain's frame.

        Replaces the earlier points. Only tiles that change are sent to the GPU. A clipmap does not need it: it draws
        every post near each camera."""
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
            fields = ", ".join(map(repr, self.fields))
            return (f"<dspace.Terrain {self._name!r}, {info.columns} x {info.rows} posts, "
                    f"{info.minimum_height:g} to {info.maximum_height:g} m" + (f", fields {fields}>" if fields else ">"))
        except Exception:  # a repr never raises
            return f"<dspace.Terrain {self._name!r}, removed>"


def _unpack(values, field, shape):
    array = wire.get_array(values, field).reshape(shape)
    return float(array) if shape == () else array
