"""Terrain: what is drawn of a raster, and what it answers."""
import numpy as np

from dspace import _wire
from dspace._fields import (Named, array_of, flag, items, keywords, numbers, put, put_color, put_given,
                            put_vector, reject, shown, word)
from dspace._strict import Strict
from dspace.errors import InvalidArgument, WrongType
from dspace.layers import LayerMaking
from dspace.objects import file_path
from dspace.terrain_styles import StyleMaking
from dspace.tracks import TrackMaking

_MODES = ("auto", "triangles", "clipmap")  # in the order of OpenTerrain.Mode


class Terrain(LayerMaking, StyleMaking, TrackMaking, Strict):
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
        """Drawn now, of mode "triangles"; 0 of a clipmap, whose triangles differ from view to view
        (session.statistics counts them)."""
        return self._info().triangles

    @property
    def mode(self):
        """"triangles" or "clipmap"."""
        return _MODES[self._info().mode]

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
        _wire.put_array(message, "point", np.stack(given, axis=-1))
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
        made = _wire.get_array(values, "filled").reshape(shape) == 1.0
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
        _wire.put_array(message, "ray", np.concatenate(given, axis=-1))
        return _unpack(self._scene._execute(command).terrain_rays, "distance", given[0].shape[:-1])

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

        Replaces the earlier ones; only tiles that change are sent to the GPU. A clipmap draws every
        post near each camera by itself."""
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


def _put_patches(message, label, patches):
    """The dicts of add_terrain's `patches` into its command."""
    accepted = "a list of dicts of path and options"
    for index, patch in enumerate(items(patches, "patches", label, accepted)):
        what = f"patch {index}"
        if not isinstance(patch, dict):
            reject(label, what, patch, "a dict of path and options", WrongType)
        sent = message.patch.add()
        known = [field.name for field in sent.DESCRIPTOR.fields]
        keywords(patch, known, f"{label}, {what}")
        if "path" not in patch:
            reject(label, what, patch, "a dict that has a path")
        given = dict(patch, path=file_path(patch["path"], "the path", f"{label}, {what}"))
        put_given(sent, f"{label}, {what}", **given)


def _folder(value, label):
    folder = "" if isinstance(value, bool) else file_path(value, "the cache", label)
    return folder or reject(label, "the cache", value, "a folder, False or None", WrongType)


class TerrainMaking:
    """The part of Scene that opens terrain."""

    def add_terrain(self, path, name=None, frame=None, image=None, color=None, relief=None,
                    origin=None, triangles=None, fragment=None, lit=True, image_crs=None,
                    image_extent=None, band=None, crs=None, vertical_datum=None,
                    vertical_scale=None, vertical_offset=None, pixel_size=None, mode="auto",
                    on_body=False, level_size=None, byte_budget=None, deadline=None, patches=(),
                    subdivisions=None, track_budget=None, cache=None, build_overviews=True, fill_holes=False):
        """A raster of heights (anything that GDAL opens) as a physical object.

        image: a file to drape over it (of a clipmap the layer "drape", see add_image(): in full
        resolution), with image_crs and image_extent (left, top, right, bottom in map coordinates)
        where the file does not say; color: one colour; relief: shaded relief (the
        default), a dict of sun_azimuth_deg, sun_elevation_deg, color_by_height. lit: whether the
        scene's lights shade it as well. origin: map x, y[, height] that become the frame's origin,
        by default the raster's middle at height 0. triangles: the budget (200000).
        mode: "triangles" (all of it in memory, within the budget), "clipmap" (any size: tiles are
        read as they are needed and triangles follow each camera) or "auto": triangles for up to
        four million pixels on a plane. on_body: its frame is the body-fixed one (Z to the north
        pole, X to longitude 0; centre at the frame's origin) instead of a plane, for degree grids of
        a sphere. level_size: cells a side of a clipmap's levels (124; 252 is finer and slower);
        byte_budget: of its tiles (256 MiB); deadline: seconds that images and queries wait for them
        (60).
        cache: the folder of averaged overviews that a clipmap reads where a raster has none (the user's
        cache folder, which `dspace terrain cache FILE` fills); False: none are read.
        build_overviews: a local raster of over four million pixels that has none gets them there, in
        the background; far ground changes once when they are there (Terrain.overviews tells).
        fill_holes: True fills what has no data smoothly from the ground around it, a number only
        within so many pixels of data (clipmaps only): drawn and answered alike, Terrain.filled tells,
        and the layer "filled" marks it in pictures.
        subdivisions: on a plane, how often a clipmap's cells between pixels are halved: wheel tracks
        (track()) need posts some centimetres apart. track_budget: bytes for them (64 MiB).
        band, crs, vertical_datum ("ellipsoid", "sphere:R", "areoid", ...), vertical_scale and
        vertical_offset [m], pixel_size (map units): what the file does not say, or says wrongly.
        patches: rasters of higher resolution on this one, each in its own CRS, later ones on top
        (clipmaps only): dicts of path and, as above, name, band, crs, vertical_datum, vertical_scale,
        vertical_offset, pixel_size; margin [m] is what each is blended over into what lies under it
        (a tenth of its shorter side). Terrain.patches tells what became of them."""
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
                reject(label, "relief", relief, f"a dict of {', '.join(known)}", WrongType)
            keywords(relief, known, f"{label}, relief")
            put(message.relief, label, **relief)
        if origin is not None:
            values = array_of(origin, "the origin", "map x, y[, height]", label).ravel()
            if len(values) not in (2, 3):
                reject(label, "the origin", origin, "map x, y[, height]", WrongType)
            put_vector(message.map_origin, [*values, 0.0][:3], "the origin", label)
        message.fragment = self._fragment_name(fragment)
        message.unlit = not flag(lit, "lit", label)
        message.mode = word(mode, {known: i for i, known in enumerate(_MODES)}, "the mode", label)
        message.on_body = flag(on_body, "on_body", label)
        put_given(message, label, triangle_budget=triangles, band=band, crs=crs,
                  vertical_datum=vertical_datum, vertical_scale=vertical_scale,
                  vertical_offset=vertical_offset, pixel_size=pixel_size,
                  level_size=level_size, byte_budget=byte_budget, deadline=deadline,
                  subdivisions=subdivisions, track_byte_budget=track_budget)
        if cache is not None:
            message.overview_cache = "" if cache is False else _folder(cache, label)
        if fill_holes is not False:
            put(message, label, fill_holes=float("inf") if fill_holes is True else fill_holes)
        message.build_overviews = flag(build_overviews, "build_overviews", label)
        _put_patches(message, label, patches)
        return Terrain(self, self._execute(command).terrain.name)

    @property
    def terrains(self):
        """All terrains, by name."""
        return Named("terrain", {name: Terrain(self, name)
                                 for name in self._ask("list_terrains").terrains.name})
