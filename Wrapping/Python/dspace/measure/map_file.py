"""The GeoTIFF file of a map."""
from dataclasses import dataclass

import numpy as np

from dspace.errors import InvalidArgument, NotFound, Unsupported


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

    def read(self, band=0):
        """Returns a band as an array (rows, columns) of float32, NaN without data. band: its name, or its place from 0 on.
        Reads the file with GDAL's Python package (Debian: python3-gdal)."""
        if isinstance(band, str):
            if band not in self.bands:
                raise NotFound(f"map {self.path!r}: the band is {band!r}; accepted: {', '.join(self.bands)}", self.path)
            band = self.bands.index(band)
        if not -len(self.bands) <= band < len(self.bands):
            raise InvalidArgument(f"map {self.path!r}: the band is {band}; accepted: 0 to {len(self.bands) - 1}", self.path)
        data = self._dataset()  # a band does not keep it alive
        return data.GetRasterBand(band % len(self.bands) + 1).ReadAsArray()

    def horizon(self, column, row):
        """Returns the values of all bands at a cell, an array (bands,): of a horizon map the horizon of the cell [deg]."""
        if not (0 <= column < self.columns and 0 <= row < self.rows):
            raise InvalidArgument(f"map {self.path!r}: the cell is {column}, {row}; accepted: columns 0 to {self.columns - 1} and "
                                  f"rows 0 to {self.rows - 1}", self.path)
        return np.asarray(self._dataset().ReadAsArray(column, row, 1, 1)).reshape(-1)

    @property
    def metadata(self):
        """What the file records of its inputs, by the kind of map: terrain, version, heights, hashes (horizon map). A dict."""
        return {key: value for key, value in self._dataset().GetMetadata().items() if key.startswith("DSPACE_")}

    @property
    def geotransform(self):
        """GDAL's six numbers from (column, row) of cells' corners to map coordinates."""
        return self._dataset().GetGeoTransform()

    def _dataset(self):
        try:
            from osgeo import gdal
        except ImportError:
            raise Unsupported("GDAL's Python package, which reads maps, is not installed (Debian: python3-gdal)", self.path) from None
        gdal.UseExceptions()
        return gdal.Open(self.path)

    def __repr__(self):
        return f"<dspace.MapFile {self.path!r}, {self.columns} x {self.rows} cells, {len(self.bands)} bands>"
