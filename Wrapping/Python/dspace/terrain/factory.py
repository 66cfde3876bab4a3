"""Opens the terrain of a scene."""
from dspace._core.fields import (Named, array_of, file_path, flag, items, keywords, numbers, put, put_color, put_given,
                                 put_vector, reject, shown, word)
from dspace._core.reflectance import put_reflectance
from dspace.errors import InvalidArgument, WrongType
from dspace.terrain.geodesy import Geodesy
from dspace.terrain.terrain import MODES, Terrain


def _put_patches(message, label, patches):
    """Writes the dicts of add_terrain's `patches` into its command."""
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


class TerrainFactory:
    """Opens the terrain of a Scene, which delegates to it."""

    def __init__(self, scene):
        self._scene = scene

    def add_terrain(self, path, name=None, frame=None, image=None, color=None, relief=None,
                    origin=None, triangles=None, fragment=None, lit=True, image_crs=None,
                    image_extent=None, band=None, crs=None, vertical_datum=None,
                    vertical_scale=None, vertical_offset=None, pixel_size=None, mode="auto",
                    on_body=False, level_size=None, byte_budget=None, deadline=None, patches=(),
                    subdivisions=None, track_budget=None, cache=None, build_overviews=True, fill_holes=False,
                    window=None, reflectance=None, no_data=None):
        """Opens a raster of heights (any format that GDAL reads) as a physical object. Returns the Terrain.

        Appearance: give at most one of image, color and relief; without one the ground is plain grey. image: a file to
        drape over the terrain (on a clipmap the layer "drape" in full resolution, see add_image()); image_crs and
        image_extent (left, top, right, bottom in map coordinates) replace what the file lacks. color: one color. relief:
        shading that is painted on (give lit=False, too: else the lights shade it a second time), a dict of
        sun_azimuth_deg, sun_elevation_deg (both of triangles only; default: Scene.sun as it is now, if it is above the
        horizon, else 315 and 45), color_by_height. lit: whether the scene's lights also shade the terrain.
        reflectance: how the ground reflects their light, such as "lunar-lambert" (see GraphicsObject.reflectance;
        default: Lambert's law).

        Geometry: origin: map x, y[, height] of the frame's origin (default: the raster's middle at height 0).
        triangles: the budget (200000). mode: "triangles" (completely in memory, within the budget), "clipmap" (any
        size; tiles are read as needed and triangles follow each camera) or "auto" (triangles for up to four million
        pixels on a plane). on_body: places the terrain on its body instead of on a plane, for degree grids of a
        sphere or an ellipsoid (WGS 84) and for equidistant cylindrical and polar stereographic projections of a sphere;
        its frame is body-fixed (Z to the north pole, X to longitude 0, the center at the origin). level_size: cells along
        a side of a clipmap level (124; 252 is finer and slower). byte_budget: bytes of tiles in memory
        (256 MiB). deadline: seconds that images and queries wait for tiles (60). subdivisions: how many times the
        cells between pixels are halved (0 to 12; on a body to 24, at least as often as its size asks); wheel tracks
        (track()) need posts some centimetres apart. Triangles keep all posts in memory, 100 million at most; "auto"
        chooses a clipmap. track_budget: bytes for wheel tracks (64 MiB).

        window: opens only the pixels that meet this part of the map (left, top, right, bottom in map coordinates). It
        is widened to whole pixels and cut at the raster's edge, with a warning; Terrain.map_extent is the result.

        Overviews: cache: the folder of averaged overviews that a clipmap reads if a raster has none (default: the
        user's cache folder, which `dspace terrain cache FILE` fills); False: do not read any. build_overviews: builds
        missing overviews of a local raster of more than four million pixels there, in the background. Distant ground
        changes once when they are complete; Terrain.overviews reports the progress.

        Data: fill_holes (clipmaps only): True fills pixels without data smoothly from the ground around them; a number
        fills only within that many pixels of data. Pictures and queries include the filled ground, Terrain.filled
        reports it, and the layer "filled" marks it in pictures. band, crs, vertical_datum ("ellipsoid", "sphere:R",
        "areoid", ...), vertical_scale, vertical_offset [m] and pixel_size (map units) replace properties that the file
        lacks or states wrongly. no_data: pixels of this value, as the file stores it (-32768, -9999, ...), have no data,
        besides those that the file states; overviews in the file are then not used, since they may be means of such
        pixels and others. A warning names a value that looks like one.

        patches (clipmaps only): rasters of higher resolution on this one, each in its own CRS, later ones on top. Each
        is a dict of path and, as above, name, band, crs, vertical_datum, vertical_scale, vertical_offset, pixel_size,
        no_data, and margin: the width [m] over which it is blended into the terrain below (a tenth of its shorter side).
        Terrain.patches reports how each is used. Raises dspace.Error."""
        path = file_path(path, "the path", "terrain")
        label = f"terrain {shown(path if name is None else name)}"
        if sum(value is not None for value in (image, color, relief)) > 1:
            raise InvalidArgument(f"{label}: several of image, color and relief are given; accepted: one "
                                  "of them", label)
        command = self._scene._command()
        message = command.open_terrain
        put(message, label, path=path, name="" if name is None else name, frame=self._scene._frame_id(frame))
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
        message.fragment = self._scene._fragment_name(fragment)
        message.unlit = not flag(lit, "lit", label)
        if reflectance is not None:
            put_reflectance(message.reflectance, reflectance, label)
        message.mode = word(mode, {known: i for i, known in enumerate(MODES)}, "the mode", label)
        message.on_body = flag(on_body, "on_body", label)
        put_given(message, label, triangle_budget=triangles, band=band, crs=crs,
                  vertical_datum=vertical_datum, no_data=no_data, vertical_scale=vertical_scale,
                  vertical_offset=vertical_offset, pixel_size=pixel_size,
                  level_size=level_size, byte_budget=byte_budget, deadline=deadline,
                  subdivisions=subdivisions, track_byte_budget=track_budget)
        if window is not None:
            message.window.extend(numbers(window, 4, "the window", label, "left, top, right, bottom"))
        if cache is not None:
            message.overview_cache = "" if cache is False else _folder(cache, label)
        if fill_holes is not False:
            put(message, label, fill_holes=float("inf") if fill_holes is True else fill_holes)
        message.build_overviews = flag(build_overviews, "build_overviews", label)
        _put_patches(message, label, patches)
        return Terrain(self._scene, self._scene._execute(command).terrain.name)

    @property
    def terrains(self):
        """All terrains, by name."""
        return Named("terrain", {name: Terrain(self._scene, name)
                                 for name in self._scene._ask("list_terrains").terrains.name})

    def geodesy(self, ellipsoid="WGS84"):
        """Distances, grid references and geoid heights on an ellipsoid: a Geodesy. ellipsoid: "WGS84", or the equatorial
        radius [m] and the flattening (0 to 0.5; 0: a sphere). terrain.geodesy is that of a terrain's CRS."""
        return Geodesy(self._scene, ellipsoid)
