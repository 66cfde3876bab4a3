"""Colour layers of terrain: images, false colour, shapes and noise painted on it."""
from dspace._core.fields import color, file_path, flag, items, numbers, put, put_color, put_given, reject, shown
from dspace._core.strict import Strict
from dspace.errors import NotFound, WrongType

KINDS = ("image", "false_color", "shapes", "noise", "filled")  # in the order of TerrainLayerReply.Kind
_SHADE = "a colour, or red, green, blue and opacity from 0 to 1, or None"


class TerrainLayer(Strict):
    """One of a terrain's colour layers. Its opacity, visible and position may be set at any time."""

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
        raise NotFound(f"{self._label()}: it is there no more", self._label())

    def _set(self, **values):
        command = self._scene._command()
        put(command.change_terrain_layer, self._label, terrain=self._terrain.name, name=self._name,
            **values)
        self._scene._execute(command)

    @property
    def name(self):
        return self._name

    @property
    def kind(self):
        """"image", "false_color", "shapes", "noise" or "filled" (add_terrain's fill_holes)."""
        return KINDS[self._info().kind]

    @property
    def path(self):
        """Of its file; "" of noise."""
        return self._info().path

    @property
    def opacity(self):
        """0 to 1. What is under it shows by the rest, mixed in linear light."""
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
        """Its place among terrain.layers: 0 is the bottom."""
        return self._info().position

    @position.setter
    def position(self, position):
        self._set(position=position)

    @property
    def pixel_size(self):
        """Of its finest detail [m] on the ground; infinity where any will do."""
        return self._info().pixel_size

    @property
    def range(self):
        """Of false colour: (low, high), the values of its first and last colour; else None."""
        info = self._info()
        return (info.low, info.high) if KINDS[info.kind] == "false_color" else None

    @property
    def colors(self):
        """Of false colour: its colours (r, g, b), evenly spaced over `range`; else None."""
        info = self._info()
        if KINDS[info.kind] != "false_color":
            return None
        return [(color.r, color.g, color.b) for color in info.color]

    @property
    def unit(self):
        """Of false colour: of its values, as the file states it ("" where it does not); else None."""
        info = self._info()
        return info.unit if KINDS[info.kind] == "false_color" else None

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
    """The colour layers of a Terrain, which delegates to it: of clipmaps, up to 64 layers. They lie over the terrain's
    own colour and under set_style()'s. A file is opened at once and read as pictures need it;
    what it leaves unsaid is a warning, what cannot be used is refused: a file that is absent
    (NotFound), damaged (Corrupt), of another body or kind (Unsupported), beside the terrain, or any
    value out of range (InvalidArgument)."""

    def __init__(self, terrain):
        self._terrain, self._scene, self._name = terrain, terrain._scene, terrain.name

    def add_image(self, path, name=None, crs=None, extent=None, opacity=1.0, visible=True, position=None):
        """An image file of any size and in any CRS as a TerrainLayer; no data and its own opacity let
        through what is under it.

        name: unique among the terrain's layers ("image", or with a number the first that is free).
        crs, extent (left, top, right, bottom in map coordinates of that CRS): what the file does not
        say, or says wrongly; without either it is stretched over the terrain. opacity: 0 to 1.
        visible: whether it is drawn. position: from the bottom, 0 (on top)."""
        label = self._terrain._label()
        command = self._adding(label, name, opacity, visible, position)
        _put_raster(command.add_terrain_layer.image, label, path, crs, extent)
        return self._added(command)

    def add_false_color(self, path, band=1, colors=None, low=None, high=None, name=None, crs=None,
                        extent=None, opacity=1.0, visible=True, position=None):
        """A raster's values through a ramp of colours as a TerrainLayer; no data is transparent.

        band: counted from 1. colors: evenly spaced, linear between (green over ochre to white).
        low, high: values of the first and the last, in the band's unit after the file's own scale and
        offset (its least and greatest); what is beyond has their colours. The layer's range, colors
        and unit are what a legend needs. The rest as for add_image()."""
        label = self._terrain._label()
        command = self._adding(label, name, opacity, visible, position)
        message = command.add_terrain_layer.false_color
        _put_raster(message, label, path, crs, extent)
        put_given(message, label, band=band, low=low, high=high)
        if band is not None and message.band == 0:
            reject(label, "band", band, "an integer from 1 on")
        for value in () if colors is None else items(colors, "colors", label, "a list of colours"):
            put_color(message.color.add(), value, "a colour of the ramp", label)
        if colors is not None and not message.color:
            reject(label, "colors", colors, "one colour or more, or None")
        return self._added(command)

    def add_shapes(self, path, line=(1, 1, 0), fill=(1, 1, 0, 0.25), width=None, pixels=2.0, point=6.0,
                   layer=None, crs=None, name=None, opacity=1.0, visible=True, position=None):
        """Polygons, lines and points of a file (GeoJSON, GeoPackage, Shapefile, ...) as a TerrainLayer.

        line, fill: a colour, or red, green, blue and opacity (0 to 1), or None for none; features' own
        "stroke", "stroke-width", "stroke-opacity", "fill", "fill-opacity" and "marker-color"
        (simplestyle) go before them. width: of lines, in metres on the ground, above 0 to 1e7; by default
        they are `pixels` of the picture wide, about (2; 0.1 to 64, or 0: no lines). point: diameter of
        points in pixels, or with `width` that many times it (6; above 0 to 256), in the lines' colour.
        layer: of a file with several (all). crs: replaces the file's; GeoJSON without one is in longitude
        and latitude of the terrain's body (of the Earth WGS 84's). The rest as for add_image()."""
        label = self._terrain._label()
        command = self._adding(label, name, opacity, visible, position)
        message = command.add_terrain_layer.shapes
        put(message, label, path=file_path(path, "the path", label))
        put_given(message, label, crs=crs, layer=layer, width=width, pixels=pixels, point=point)
        for what, value in (("line", line), ("fill", fill)):
            shade = _shade(value, what, label)
            put_color(getattr(message, what), shade[:3], what, label)
            put(message, label, **{f"{what}_opacity": shade[3]})
        return self._added(command)

    def add_noise(self, wavelength=10.0, octaves=6, gain=0.5, seed=0, contrast=0.25, name=None,
                  opacity=1.0, visible=True, position=None):
        """Gradient noise as a TerrainLayer: structure finer than the data, which looks like ground and
        measures nothing.

        wavelength: of its longest octave [m], 1e-3 to 1e7; octaves: each half as long as the one before,
        1 to 16; gain: amplitude of an octave over that of the one before, above 0 to 1; seed: an integer
        from 0 to 2**32 - 1, the same noise for the same one; contrast: how much it darkens and brightens
        at most, 0 to 1. The rest as for add_image()."""
        label = self._terrain._label()
        command = self._adding(label, name, opacity, visible, position)
        put(command.add_terrain_layer.noise, label, wavelength=wavelength, octaves=octaves, gain=gain,
            seed=seed, contrast=contrast)
        return self._added(command)

    @property
    def layers(self):
        """Its colour layers, bottom first; "drape" is that of add_terrain's `image`."""
        if self._terrain.mode != "clipmap":
            return []
        return [TerrainLayer(self._terrain, layer.name) for layer in self.info().layer]

    def layer(self, name):
        """The TerrainLayer of that name. Raises NotFound naming those there are."""
        layers = {layer.name: layer for layer in self.layers}
        try:
            return layers[name]
        except (KeyError, TypeError):
            known = ", ".join(map(repr, layers)) or "none"
            raise NotFound(f"{self._terrain._label()}: it has no layer {shown(name)}; there are: {known}",
                           self._terrain._label()) from None

    @property
    def layer_tiles(self):
        """Of the colour layers, a dict of bytes (in memory), kept_bytes (of JPEG, PNG and other files that
        are decoded as a whole), reads (of one tile of one layer), compositions (of tiles of all layers),
        failures and last_failure (a message, or "")."""
        info = self.info()
        return {"bytes": info.bytes, "kept_bytes": info.kept_bytes, "reads": info.reads,
                "compositions": info.compositions, "failures": info.failures,
                "last_failure": info.last_failure}

    def info(self):
        """The TerrainLayersReply."""
        return self._scene._ask("list_terrain_layers", terrain=self._name).terrain_layers

    def _adding(self, label, name, opacity, visible, position):
        command = self._scene._command()
        message = command.add_terrain_layer
        put(message, label, terrain=self._name, opacity=opacity, hidden=not flag(visible, "visible", label))
        put_given(message, label, name=name, position=position)
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
    """Red, green, blue, opacity."""
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
