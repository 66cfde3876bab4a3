"""What the tests of the command line share."""
import numpy as np

from dspace.command_line import main
from terrain_support import gdal, write_raster

R = 1737400.0  # [m] of the Moon


def run(capsys, *arguments):
    """The exit code of a command, and what it wrote to its output and error streams."""
    try:
        code = main([*map(str, arguments)])
    except SystemExit as end:
        code = end.code
    out = capsys.readouterr()
    return code, out.out, out.err


def write_wall(path, columns):
    """A plane of 41 rows without CRS, with a wall of 20 m along its middle column."""
    z = np.zeros((41, columns), np.float32)
    z[:, columns // 2] = 20.0
    return write_raster(path, z)


def write_moon(path, z, west, north, step):
    """Heights on a degree grid of the Moon's sphere, from its corner (west, north), by pixels of `step` degrees."""
    data = gdal.GetDriverByName("GTiff").Create(str(path), z.shape[1], z.shape[0], 1, gdal.GDT_Float32)
    data.SetGeoTransform((west, step, 0, north, 0, -step))
    data.SetProjection(f'GEOGCS["Moon",DATUM["Moon",SPHEROID["Moon",{R},0]],PRIMEM["G",0],UNIT["degree",0.0174532925199433]]')
    data.SetMetadataItem("VERTICAL_DATUM", "sphere")
    data.GetRasterBand(1).WriteArray(z)
    return path
