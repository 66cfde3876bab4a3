"""Fields of terrain: rasters of values that lie on it."""
from dspace._core import wire
from dspace._core.fields import Named, file_path, flag, items, numbers, put, put_given, reject
from dspace._core.strict import Strict
from dspace.errors import NotFound


class TerrainField(Strict):
    """A raster of values on a terrain: soil, thermal inertia, slope hazard."""

    def __init__(self, terrain, name):
        self._terrain = terrain
        self._name = name

    def _label(self):
        return f"field {self._name!r} of {self._terrain._label()}"

    def _info(self):
        for field in TerrainFields(self._terrain).info():
            if field.name == self._name:
                return field
        raise NotFound(f"{self._label()}: it was removed", self._label())

    @property
    def name(self):
        return self._name

    @property
    def path(self):
        """The path of its file."""
        return self._info().path

    @property
    def units(self):
        """The units of its values: those given to add_field(), or else the file's; "" if neither states any."""
        return self._info().units

    @property
    def crs(self):
        """Its CRS as WKT; "" without one."""
        return self._info().crs

    @property
    def pixel_size(self):
        """The size of its pixels on the ground [m]."""
        return self._info().pixel_size

    @property
    def size(self):
        """(columns, rows) of its pixels."""
        info = self._info()
        return (info.columns, info.rows)

    @property
    def band(self):
        """The band of its file, counted from 1."""
        return self._info().band

    @property
    def nearest(self):
        """Whether values are those of the nearest pixel. Otherwise they are interpolated."""
        return self._info().nearest

    def value(self, x, y, z=None, map=False):
        """Returns its values at x, y: terrain.value() of this field."""
        return TerrainFields(self._terrain).value(self._name, x, y, z, map)

    def remove(self):
        """Removes it. Raises dspace.InvalidArgument while a layer shows it."""
        self._terrain._scene._do("remove_terrain_field", terrain=self._terrain.name, name=self._name)

    def __repr__(self):
        try:
            info = self._info()
            units = f" of {info.units}" if info.units else ""
            return (f"<dspace.TerrainField {self._name!r}{units}, {info.columns} x {info.rows} pixels of "
                    f"{info.pixel_size:g} m>")
        except Exception:  # a repr never raises
            return f"<dspace.TerrainField {self._name!r}, removed>"


class TerrainFields:
    """The fields of a Terrain, which delegates to it."""

    def __init__(self, terrain):
        self._terrain, self._scene, self._name = terrain, terrain._scene, terrain.name

    def add_field(self, name, path, units=None, nearest=False, crs=None, band=None, extent=None):
        """Adds a raster of values that lies on the terrain (soil, thermal inertia, hazard), and returns its
        TerrainField. Only the header is read now; pixels are read where values are requested.

        path: any raster that GDAL reads, in any CRS of the same body. units: replaces the file's. nearest: True:
        values of the nearest pixel, which classes need; False: bilinear between the centres of pixels. crs, extent
        (left, top, right, bottom in map coordinates of that CRS): replace what the file lacks or states wrongly.
        band: counted from 1 (default: the first). The band's scale and offset are applied. Raises dspace.NotFound for
        an absent file, dspace.Corrupt for a damaged one, dspace.Unsupported for one of another body, and
        dspace.InvalidArgument for one that does not overlap the terrain."""
        label = self._terrain._label()
        command = self._scene._command()
        message = command.add_terrain_field
        put(message, label, terrain=self._name, name=name, path=file_path(path, "the path", label),
            nearest=flag(nearest, "nearest", label))
        put_given(message, label, units=units, crs=crs, band=band)
        if band is not None and message.band == 0:
            reject(label, "band", band, "an integer from 1 on")
        if extent is not None:
            message.extent.extend(numbers(extent, 4, "the extent", label, "left, top, right, bottom"))
        self._scene._execute(command)
        return TerrainField(self._terrain, name)

    @property
    def fields(self):
        """The fields as a dict of TerrainField by name, in the order of their creation."""
        return Named("field", {field.name: TerrainField(self._terrain, field.name) for field in self.info()})

    def value(self, name, x, y, z=None, map=False):
        """Returns values of a field, or of each of a list of fields as a dict by name, at x, y (numbers or arrays as
        for height()); NaN without data. On a body, give map=True (longitude and latitude for a degree grid), or x, y
        and z.

        Bilinear values leave pixels without data out: the other weights are divided by their sum. Where the pixel that
        contains the point has no data, the value is NaN."""
        several = not isinstance(name, str)
        names = items(name, "the field", self._terrain._label(), "a name or a list of names") if several else [name]
        if not names:
            reject(self._terrain._label(), "the field", name, "a name, or one name or more in a list")
        shape, values = self._terrain._query(x, y, "field", map, z, names)
        array = wire.get_array(values, "field").reshape((len(names),) + shape)
        if several:
            return {each: _plain(array[i]) for i, each in enumerate(names)}
        return _plain(array[0])

    def info(self):
        """Returns the fields' descriptions, a list of TerrainFieldList.Field."""
        return self._scene._ask("list_terrain_fields", terrain=self._name).terrain_fields.field


def _plain(array):
    return float(array) if array.shape == () else array
