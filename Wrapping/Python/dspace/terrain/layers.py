"""Layers of terrain: images, false color, shapes and noise, and normals."""
from dspace._core.fields import color, file_path, flag, items, numbers, put, put_color, put_given, reject, shown
from dspace._core.strict import Strict
from dspace.errors import NotFound, WrongType
from dspace.terrain.members import put_member

KINDS = ("image", "false_color", "shapes", "noise", "filled", "normals")  # in the order of TerrainLayerReply.Kind
AXES = ("map", "local")  # in the order of AddTerrainLayer.Normals.Axes
_SHADE = "a colour, or red, green, blue and opacity from 0 to 1, or None"


class TerrainLayer(Strict):
    """One of a terrain's layers. Its opacity, visible and position may be set at any time."""

    def __init__(self, terrain, name):
        self._terrain = terrain
        self._scene = terrain._scene
        self._name = name

    def _label(self):
        return f"layer {self._name!r} of {self._terrain._label()}"

    def _info(self):
        for layer in TerrainLayers(self._terrain).info().layer:
            if layer.name == self._name:
                return layer
        raise NotFound(f"{self._label()}: it was removed", self._label())

    def _set(self, **values):
        command = self._scene._command()
        put(command.change_terrain_layer, self._label, terrain=self._terrain.name, name=self._name,
            **values)
        self._scene._execute(command)

    @property
    def name(self):
        return self._name

    @property
    def terrain(self):
        """The Terrain that it lies on."""
        return self._terrain

    @property
    def kind(self):
        """"image", "false_color", "shapes", "noise", "normals" or "filled" (add_terrain's fill_holes)."""
        return KINDS[self._info().kind]

    @property
    def path(self):
        """The path of its file; "" for noise."""
        return self._info().path

    @property
    def opacity(self):
        """The opacity, 0 to 1. Colors are blended with those below in linear light, normals with those below as
        vectors."""
        return self._info().opacity

    @opacity.setter
    def opacity(self, opacity):
        self._set(opacity=opacity)

    @property
    def visible(self):
        return self._info().visible

    @visible.setter
    def visible(self, visible):
        self._set(visible=visible)

    @property
    def position(self):
        """The index of the layer in terrain.layers: 0 is the bottom."""
        return self._info().position

    @position.setter
    def position(self, position):
        self._set(position=position)

    @property
    def ornamental(self):
        """Whether it is an ornament, which physical pictures leave out."""
        return self._info().nature == 1

    @property
    def fragment(self):
        """The name of the fragment with which it is shown and hidden. Set it to a Fragment of the layer's nature or to
        a name."""
        return self._info().fragment

    @fragment.setter
    def fragment(self, fragment):
        self._set(fragment=self._scene._fragment_name(fragment, None))

    @property
    def pixel_size(self):
        """The size on the ground of its finest detail [m]; infinity if it has no finest detail."""
        return self._info().pixel_size

    @property
    def range(self):
        """(low, high), the values of the first and the last color of a false color layer; otherwise None."""
        info = self._info()
        return (info.low, info.high) if KINDS[info.kind] == "false_color" else None

    @property
    def colors(self):
        """The colors (r, g, b) of a false color layer, evenly spaced over `range`; otherwise None."""
        info = self._info()
        if KINDS[info.kind] != "false_color":
            return None
        return [(color.r, color.g, color.b) for color in info.color]

    @property
    def unit(self):
        """The unit of the values of a false color layer ("" if the file states none); otherwise None."""
        info = self._info()
        return info.unit if KINDS[info.kind] == "false_color" else None

    @property
    def field(self):
        """The name of the terrain's field that it shows; None: it shows a file of its own, or none."""
        return self._info().field or None

    def remove(self):
        self._scene._do("remove_terrain_layer", terrain=self._terrain.name, name=self._name)

    def __repr__(self):
        try:
            info = self._info()
            hidden = "" if info.visible else ", hidden"
            return (f"<dspace.TerrainLayer {self._name!r}, {KINDS[info.kind]}, opacity "
                    f"{info.opacity:g}{hidden}>")
        except Exception:  # a repr never raises
            return f"<dspace.TerrainLayer {self._name!r}, removed>"


class TerrainLayers:
    """The layers of a Terrain, which delegates to it. A clipmap has up to 64 layers; a terrain of triangles has those
    of normals alone. Colors lie over the terrain's own color and under that of set_style(); normals shade both. A file
    is opened at once and read as pictures need it. A missing property of a file gives a warning. Raises
    dspace.NotFound for an absent file, dspace.Corrupt for a damaged one, dspace.Unsupported for one of another body or
    kind, and dspace.InvalidArgument for one that does not overlap the terrain and for values out of range."""

    def __init__(self, terrain):
        self._terrain, self._scene, self._name = terrain, terrain._scene, terrain.name

    def add_image(self, path, name=None, crs=None, extent=None, opacity=1.0, visible=True, position=None,
                  fragment=None, ornamental=None):
        """Adds an image file of any size and in any CRS, and returns its TerrainLayer. Pixels without data, and the
        image's own transparency, show the layers below.

        name: unique among the terrain's layers (default: "image", with a number if that is in use). crs, extent (left,
        top, right, bottom in map coordinates of that CRS): replace what the file lacks or states wrongly; an image
        without either is stretched over the terrain. opacity: 0 to 1. visible: whether it is drawn. position: index
        from the bottom, 0 (default: on top)."""
        label = self._terrain._label()
        command = self._adding(label, name, opacity, visible, position, fragment, ornamental)
        _put_raster(command.add_terrain_layer.image, label, path, crs, extent)
        return self._added(command)

    def add_false_color(self, path=None, band=None, colors=None, low=None, high=None, name=None, crs=None,
                        extent=None, opacity=1.0, visible=True, position=None, field=None,
                        fragment=None, ornamental=None):
        """Adds the values of a raster as colors of a ramp, and returns the TerrainLayer. Pixels without data are
        transparent.

        field: the name of a field of the terrain (add_field()) to show, in place of path, band, crs and extent. band:
        counted from 1 (default: the first). colors: evenly spaced, interpolated linearly (default: green through ochre
        to white).
        low, high: values of the first and the last color, in the band's unit after the file's own scale and offset
        (default: the least and greatest value); values beyond have the end colors. A legend needs the layer's range,
        colors and unit. The other arguments are those of add_image()."""
        label = self._terrain._label()
        command = self._adding(label, name, opacity, visible, position, fragment, ornamental)
        message = command.add_terrain_layer.false_color
        if (path is None) == (field is None):
            reject(label, "path, field", (path, field), "one of both")
        if field is None:
            _put_raster(message, label, path, crs, extent)
        else:
            given = {"crs": crs, "extent": extent, "band": band}
            for what, value in given.items():
                if value is not None:
                    reject(label, what, value, f"None with field {field!r}, which has its own")
            put(command.add_terrain_layer, label, field=field)
            message.SetInParent()
        put_given(message, label, band=band, low=low, high=high)
        if band is not None and message.band == 0:
            reject(label, "band", band, "an integer from 1 on")
        for value in () if colors is None else items(colors, "colors", label, "a list of colours"):
            put_color(message.color.add(), value, "a colour of the ramp", label)
        if colors is not None and not message.color:
            reject(label, "colors", colors, "one colour or more, or None")
        return self._added(command)

    def add_shapes(self, path, line=(1, 1, 0), fill=(1, 1, 0, 0.25), width=None, pixels=2.0, point=6.0,
                   layer=None, crs=None, name=None, opacity=1.0, visible=True, position=None,
                   fragment=None, ornamental=None):
        """Adds the polygons, lines and points of a file (GeoJSON, GeoPackage, Shapefile, ...), and returns the
        TerrainLayer.

        line, fill: a color, or red, green, blue and opacity (0 to 1), or None for none. The features' own "stroke",
        "stroke-width", "stroke-opacity", "fill", "fill-opacity" and "marker-color" (simplestyle) take precedence.
        width: of lines, in metres on the ground, above 0 to 1e7; default: about `pixels` pixels (2; 0.1 to 64, or 0:
        no lines). point: diameter of points in pixels, or in multiples of `width` if that is given (6; above 0 to
        256); points have the lines' color. layer: a layer of the file (default: all). crs: replaces the file's CRS;
        GeoJSON without one is in longitude and latitude of the terrain's body (WGS 84 for the Earth). The other
        arguments are those of add_image()."""
        label = self._terrain._label()
        command = self._adding(label, name, opacity, visible, position, fragment, ornamental)
        message = command.add_terrain_layer.shapes
        put(message, label, path=file_path(path, "the path", label))
        put_given(message, label, crs=crs, layer=layer, width=width, pixels=pixels, point=point)
        for what, value in (("line", line), ("fill", fill)):
            shade = _shade(value, what, label)
            put_color(getattr(message, what), shade[:3], what, label)
            put(message, label, **{f"{what}_opacity": shade[3]})
        return self._added(command)

    def add_noise(self, wavelength=10.0, octaves=6, gain=0.5, seed=0, contrast=0.25, name=None,
                  opacity=1.0, visible=True, position=None,
                  fragment=None, ornamental=None):
        """Adds gradient noise and returns its TerrainLayer. The noise adds visual structure finer than the data; it is
        not measured data.

        wavelength: of the longest octave [m], 1e-3 to 1e7. octaves: 1 to 16, each with half the wavelength of the one
        before. gain: amplitude of an octave relative to the one before, above 0 to 1. seed: an integer from 0 to
        2**32 - 1; equal seeds give equal noise. contrast: the largest change of brightness, 0 to 1. The other
        arguments are those of add_image()."""
        label = self._terrain._label()
        command = self._adding(label, name, opacity, visible, position, fragment, ornamental)
        put(command.add_terrain_layer.noise, label, wavelength=wavelength, octaves=octaves, gain=gain,
            seed=seed, contrast=contrast)
        return self._added(command)

    def add_normals(self, path, axes="map", name=None, crs=None, extent=None, opacity=1.0, visible=True, position=None,
                    fragment=None, ornamental=None):
        """Adds a raster of normals and returns its TerrainLayer. Light falls on these normals in place of those of the
        terrain's heights, in pictures of lit terrain. They change no color, depth, label, or query.
        Pixels without data show the normals below.

        path: three bands of one type: x, y and z (up) of unit vectors. 8 or 16 bits are coded, n = 2 v / 255 - 1 or
        2 v / 65535 - 1; other types, or with a scale or offset of the file's own, are values from -1 to 1. Lengths from
        0.5 to 1.1 are made 1; z is 0 or more, to 0.01. axes: which way x and y run: "map", along x and y of the
        raster's own CRS, or "local", east and north. Vectors are turned where the terrain's axes differ. opacity: 0 to
        1; 0.5 is the middle of the two normals. The other arguments are those of add_image()."""
        label = self._terrain._label()
        command = self._adding(label, name, opacity, visible, position, fragment, ornamental)
        message = command.add_terrain_layer.normals
        _put_raster(message, label, path, crs, extent)
        if axes not in AXES:
            reject(label, "axes", axes, '"map" or "local"')
        put(message, label, axes=AXES.index(axes))
        return self._added(command)

    @property
    def layers(self):
        """The layers, bottom first. "drape" is the layer of add_terrain's `image`."""
        return [TerrainLayer(self._terrain, layer.name) for layer in self.info().layer]

    def layer(self, name):
        """Returns the TerrainLayer of that name. Raises dspace.NotFound, which lists the existing names."""
        layers = {layer.name: layer for layer in self.layers}
        try:
            return layers[name]
        except (KeyError, TypeError):
            known = ", ".join(map(repr, layers)) or "none"
            raise NotFound(f"{self._terrain._label()}: it has no layer {shown(name)}; there are: {known}",
                           self._terrain._label()) from None

    @property
    def layer_tiles(self):
        """Counters of the layers' tiles, a dict: bytes (in memory), kept_bytes (of JPEG, PNG and other files that
        must be decoded completely), reads (of one tile of one layer), compositions (tiles combined from all layers),
        failures, last_failure (a message, or "")."""
        info = self.info()
        return {"bytes": info.bytes, "kept_bytes": info.kept_bytes, "reads": info.reads,
                "compositions": info.compositions, "failures": info.failures,
                "last_failure": info.last_failure}

    def info(self):
        """Returns the TerrainLayersReply."""
        return self._scene._ask("list_terrain_layers", terrain=self._name).terrain_layers

    def _adding(self, label, name, opacity, visible, position, fragment, ornamental):
        command = self._scene._command()
        message = command.add_terrain_layer
        put(message, label, terrain=self._name, opacity=opacity, hidden=not flag(visible, "visible", label))
        put_given(message, label, name=name, position=position)
        put_member(message, self._scene, {}, {"fragment": fragment, "ornamental": ornamental}, label)
        if name == "":
            reject(label, "the name of a layer", name, "a str that is not empty, or None")
        return command

    def _added(self, command):
        return TerrainLayer(self._terrain, self._scene._execute(command).terrain_layer.name)


def _put_raster(message, label, path, crs, extent):
    put(message, label, path=file_path(path, "the path", label))
    put_given(message, label, crs=crs)
    if extent is not None:
        message.extent.extend(numbers(extent, 4, "the extent", label, "left, top, right, bottom"))


def _shade(value, what, label):
    """Returns red, green, blue and opacity."""
    if value is None:
        return (0.0, 0.0, 0.0, 0.0)
    if isinstance(value, str):
        return (*color(value, what, label), 1.0)
    try:
        values = tuple(float(part) for part in value)
    except (TypeError, ValueError):
        values = ()
    if len(values) not in (3, 4):
        reject(label, what, value, _SHADE, WrongType)
    return (*values, 1.0)[:4]
