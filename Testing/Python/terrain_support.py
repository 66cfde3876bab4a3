"""What the tests of terrain share."""
import os
import pathlib

import numpy as np
import pytest

from needs import needs_module

gdal = needs_module("osgeo.gdal", "python3-gdal")  # an independent reader
gdal.UseExceptions()
ROOT = pathlib.Path(__file__).resolve().parents[2]
FIELD = ROOT / "Data/field/field.tif"


def real(name):
    path = pathlib.Path(os.environ.get("DSPACE_DATA") or "/nonexistent") / "terrain" / name
    if not path.exists():
        pytest.skip(f"real data absent: set DSPACE_DATA to the folder that has terrain/{name}")
    return path


def between_posts(z, c, r):
    """Heights at places (c, r) in posts: two triangles a cell, the diagonal from the north-west to
    the south-east post."""
    i = np.clip(np.floor(c).astype(int), 0, z.shape[1] - 2)
    j = np.clip(np.floor(r).astype(int), 0, z.shape[0] - 2)
    u, v = c - i, r - j
    nw, ne, sw, se = z[j, i], z[j, i + 1], z[j + 1, i], z[j + 1, i + 1]
    return np.where(u >= v, nw + u * (ne - nw) + v * (se - ne), nw + v * (sw - nw) + u * (se - sw))


def points_of(depth, eye, target, fov_deg, up=(0, 0, 1)):
    """Root coordinates of what a camera hit, and metres there a pixel; NaN where nothing."""
    height, width = depth.shape
    eye, target = np.asarray(eye, float), np.asarray(target, float)
    forward = (target - eye) / np.linalg.norm(target - eye)
    right = np.cross(forward, up)
    right /= np.linalg.norm(right)
    down = np.cross(forward, right)
    pixel = 2 * np.tan(np.radians(fov_deg) / 2) / height
    x = (np.arange(width) + 0.5 - width / 2) * pixel
    y = (np.arange(height) + 0.5 - height / 2) * pixel
    rays = forward + x[None, :, None] * right + y[:, None, None] * down
    depth = np.where(np.isfinite(depth), depth, np.nan)[..., None]
    return eye + rays * depth, depth[..., 0] * pixel


def write_raster(path, z, pixel=1.0):
    rows, columns = z.shape
    data = gdal.GetDriverByName("GTiff").Create(str(path), columns, rows, 1, gdal.GDT_Float32,
                                                ["TILED=YES"])
    data.SetGeoTransform((0, pixel, 0, rows * pixel, 0, -pixel))
    data.SetMetadataItem("VERTICAL_DATUM", "relative")
    data.GetRasterBand(1).SetUnitType("m")
    data.GetRasterBand(1).WriteArray(z)
    return path


def write_georeferenced(path, z, geotransform, projection):
    """A GeoTIFF of heights (rows from the north on) in a CRS, above its sphere."""
    data = gdal.GetDriverByName("GTiff").Create(str(path), z.shape[1], z.shape[0], 1, gdal.GDT_Float32)
    data.SetGeoTransform(geotransform)
    data.SetProjection(projection)
    data.SetMetadataItem("VERTICAL_DATUM", "sphere")
    data.GetRasterBand(1).WriteArray(z)
    return path
