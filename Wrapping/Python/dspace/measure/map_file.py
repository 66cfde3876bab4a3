"""The GeoTIFF file of a map."""
import os
from dataclasses import dataclass

import numpy as np

from dspace._core.fields import file_path
from dspace.errors import Corrupt, InvalidArgument, NotFound, Unsupported

# Names of quantities by the descriptions of bands in files.
BANDS = {"lit fraction of the time": "lit_fraction", "longest night [s]": "longest_night",
         "fraction of the time with the Earth in sight": "earth_fraction",
         "fraction of the time with a station in sight": "station_fraction", "permanent shadow": "permanent_shadow",
         "least height [m]": "least_height", "observers": "count"}


@dataclass(frozen=True)
class MapFile:
    """A map that was written.

    path: of the GeoTIFF; with a RemoteSession on the server's disk. columns, rows: cells. bands: what each band holds.
    cell_size: spacing of the cells in map units; 0 of an illumination map, which has the horizon map's cells."""
    path: str
    columns: int
    rows: int
    bands: tuple
    cell_size: float

    @classmethod
    def open(cls, path):
        """Returns the MapFile of a file that a map was written to. Raises dspace.NotFound and dspace.Corrupt."""
        path = file_path(path, "the path", "map")
        if not os.path.isfile(path):
            raise NotFound(f"map {path!r}: there is no such file; accepted: a file that a map was written to", path)
        try:
            data = cls(path, 0, 0, (), 0.0)._dataset()
        except RuntimeError as error:
            raise Corrupt(f"map {path!r}: {error}; accepted: a file that a map was written to", path) from None
        if "DSPACE_KIND" not in data.GetMetadata():
            raise Corrupt(f"map {path!r}: it is no map of Dspace; accepted: a file that a map was written to", path)
        described = [data.GetRasterBand(k + 1).GetDescription() for k in range(data.RasterCount)]
        bands = tuple(BANDS.get(name, name) for name in described)
        return cls(path, data.RasterXSize, data.RasterYSize, bands, abs(data.GetGeoTransform()[1]))

    def read(self, band=0, rows=None):
        """Returns a band as an array (rows, columns) of float32, NaN without data. band: its name, or its place from 0 on. rows: (the
        first, how many) to read; default: all. Reads the file with GDAL's Python package (Debian: python3-gdal)."""
        if isinstance(band, str):
            if band not in self.bands:
                raise NotFound(f"map {self.path!r}: the band is {band!r}; accepted: {', '.join(self.bands)}", self.path)
            band = self.bands.index(band)
        if not -len(self.bands) <= band < len(self.bands):
            raise InvalidArgument(f"map {self.path!r}: the band is {band}; accepted: 0 to {len(self.bands) - 1}", self.path)
        data = self._dataset()  # a band does not keep it alive
        first, count = (0, self.rows) if rows is None else rows
        return data.GetRasterBand(band % len(self.bands) + 1).ReadAsArray(0, int(first), self.columns, int(count))

    def horizon(self, column, row):
        """Returns the values of all bands at a cell, an array (bands,): of a horizon map the horizon of the cell [deg]. Azimuths of
        a map on a plane and of one in a polar projection count from the map's Y axis, which first_deg() turns to true north."""
        self._require_cell(column, row)
        return np.asarray(self._dataset().ReadAsArray(column, row, 1, 1)).reshape(-1)

    def first_deg(self, column, row):
        """Returns the direction from which a horizon map's azimuths count at a cell, clockwise from true north [deg], 0 to 360:
        azimuths from true north are the map's plus this. It is the map's Y axis, and of a polar raster on its body the direction
        against its rows. 0 where the map is in longitude and latitude; arbitrary at a pole itself. Raises dspace.Unsupported for a
        map without longitudes and latitudes."""
        self._require_cell(column, row)
        from osgeo import osr
        srs = self._dataset().GetSpatialRef()
        if srs is None or not (srs.IsGeographic() or srs.IsProjected()):
            raise Unsupported(f"map {self.path!r}: it has no longitudes and latitudes; accepted: a map with a CRS on a body", self.path)
        degrees = srs.CloneGeogCS()
        for each in (srs, degrees):
            each.SetAxisMappingStrategy(osr.OAMS_TRADITIONAL_GIS_ORDER)
        x0, dx, xy, y0, yx, dy = self.geotransform
        x, y = x0 + dx * (column + 0.5) + xy * (row + 0.5), y0 + yx * (column + 0.5) + dy * (row + 0.5)
        longitude, latitude, _ = osr.CoordinateTransformation(srs, degrees).TransformPoint(x, y)
        away = -1e-5 if latitude > 0.0 else 1e-5  # from the nearer pole [deg]
        there = osr.CoordinateTransformation(degrees, srs).TransformPoint(longitude, latitude + away)
        north = np.arctan2((there[0] - x) / away, (there[1] - y) / away)
        rows = np.arctan2(-xy, -dy) if self.metadata.get("DSPACE_PLACEMENT", "").startswith("pole") else 0.0
        return float(np.degrees(rows - north) % 360.0)

    def areas(self):
        """Returns the ground's area of each cell at the datum [m^2], an array (rows, columns): on the CRS's ellipsoid by the map's
        scale at every cell, to a share of 1e-4; in map units squared where the CRS has no longitudes and latitudes. The area in permanent
        shadow is numpy.nansum(lit.areas() * lit.read("permanent_shadow"))."""
        from osgeo import osr
        x0, dx, xy, y0, yx, dy = self.geotransform
        cell = abs(dx * dy - xy * yx)
        srs = self._dataset().GetSpatialRef()
        if srs is None or not (srs.IsGeographic() or srs.IsProjected()):
            return np.full((self.rows, self.columns), cell)
        # Enough nodes for the scale between them to be linear to 1e-4, also near a pole of the projection.
        nodes = [np.unique(np.linspace(0.0, count, min(count + 1, 257))) for count in (self.columns, self.rows)]
        c, r = np.meshgrid(*nodes)
        x, y = x0 + dx * c + xy * r, y0 + yx * c + dy * r
        a, b = srs.GetSemiMajor(), srs.GetSemiMinor()
        if srs.IsGeographic():
            latitude = np.radians(np.clip(y, -90.0, 90.0))
            turn = np.radians(1.0) ** 2
        else:
            degrees = srs.CloneGeogCS()
            for each in (srs, degrees):
                each.SetAxisMappingStrategy(osr.OAMS_TRADITIONAL_GIS_ORDER)
            to_degrees = osr.CoordinateTransformation(srs, degrees)
            step = max(1.0, 1e-4 * np.sqrt(cell))  # [m]

            def unit(px, py):
                at = np.radians(np.array(to_degrees.TransformPoints(np.column_stack((px.ravel(), py.ravel()))))[:, :2])
                return np.stack((np.cos(at[:, 1]) * np.cos(at[:, 0]), np.cos(at[:, 1]) * np.sin(at[:, 0]), np.sin(at[:, 1])), axis=-1)
            along_x, along_y = ((unit(x + e * step, y + (1 - e) * step) - unit(x - e * step, y - (1 - e) * step)) / (2.0 * step)
                                for e in (1, 0))
            # Of the sphere of directions of the ellipsoid's normals: it has no pole that would spoil the differences.
            turn = np.linalg.norm(np.cross(along_x, along_y), axis=-1).reshape(x.shape)
            latitude = np.arcsin(np.clip(unit(x, y)[:, 2], -1.0, 1.0)).reshape(x.shape)
        square = (a * a - b * b) / (a * a)
        bent = 1.0 - square * np.sin(latitude) ** 2
        ground = a * a * (1.0 - square) / bent**2 * turn  # the product of the radii of curvature
        if srs.IsGeographic():
            ground = ground * np.cos(latitude)
        across = np.stack([np.interp(np.arange(self.columns) + 0.5, nodes[0], row) for row in ground])
        return cell * np.stack([np.interp(np.arange(self.rows) + 0.5, nodes[1], column) for column in across.T], axis=-1)

    def _require_cell(self, column, row):
        if not (0 <= column < self.columns and 0 <= row < self.rows):
            raise InvalidArgument(f"map {self.path!r}: the cell is {column}, {row}; accepted: columns 0 to {self.columns - 1} and "
                                  f"rows 0 to {self.rows - 1}", self.path)

    @property
    def metadata(self):
        """What the file records of its inputs, by the kind of map: terrain, version, heights, hashes (horizon map). A dict."""
        return {key: value for key, value in self._dataset().GetMetadata().items() if key.startswith("DSPACE_")}

    @property
    def geotransform(self):
        """GDAL's six numbers from (column, row) of cells' corners to map coordinates."""
        return self._dataset().GetGeoTransform()

    @property
    def in_degrees(self):
        """Whether map coordinates are longitude and latitude [deg]."""
        srs = self._dataset().GetSpatialRef()
        return srs is not None and bool(srs.IsGeographic())

    @property
    def unit(self):
        """Of map coordinates: "deg", "m" (or the CRS's name of another one); "" where the file has no CRS."""
        srs = self._dataset().GetSpatialRef()
        if srs is None or not (srs.IsGeographic() or srs.IsProjected()):
            return ""
        return "deg" if srs.IsGeographic() else "m" if srs.GetLinearUnits() == 1.0 else srs.GetLinearUnitsName()

    def _dataset(self):
        try:
            from osgeo import gdal
        except ImportError:
            raise Unsupported("GDAL's Python package, which reads maps, is not installed (Debian: python3-gdal)", self.path) from None
        gdal.UseExceptions()
        return gdal.Open(self.path)

    def __repr__(self):
        return f"<dspace.MapFile {self.path!r}, {self.columns} x {self.rows} cells, {len(self.bands)} bands>"
