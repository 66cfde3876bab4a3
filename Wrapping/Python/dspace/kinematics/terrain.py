"""What wheels stand on: any callable heights(xy) -> z, and a triangulated grid of our own."""
import numpy as np

from dspace.errors import InvalidArgument, WrongType


def as_terrain(terrain):
    """(heights, gradients): two functions of xy (n, 2) in metres, giving z (n,) and dz/dx, dz/dy
    (n, 2). `terrain` is a callable, or an object with heights(xy) and, if it can, gradients(xy) or
    normals(xy). Without either, central differences over 2 mm. A height that is not finite (a hole,
    or beyond the data) is a dspace.InvalidArgument that names the place."""
    source = getattr(terrain, "heights", None) or terrain
    if not callable(source):
        raise WrongType(f"terrain: expected a callable or an object with heights(xy), got {terrain!r}")

    def heights(xy):
        z = np.asarray(source(xy), float)
        if z.shape != (len(xy),):
            raise InvalidArgument(f"terrain: heights of shape {z.shape} for {len(xy)} points; expected ({len(xy)},)")
        if not np.isfinite(z).all():
            x, y = xy[np.argmin(np.isfinite(z))]
            raise InvalidArgument(f"terrain: no height at ({x:.3f}, {y:.3f}); accepted: places where it has data")
        return z

    if hasattr(terrain, "gradients"):
        return heights, terrain.gradients
    if hasattr(terrain, "normals"):
        def from_normals(xy):
            n = np.asarray(terrain.normals(xy))
            return -n[:, :2] / n[:, 2:]
        return heights, from_normals

    def differences(xy, step=0.002):
        n = len(xy)
        at = np.vstack([xy + [step, 0], xy - [step, 0], xy + [0, step], xy - [0, step]])
        z = heights(at)
        return np.column_stack([z[:n] - z[n:2 * n], z[2 * n:3 * n] - z[3 * n:]]) / (2 * step)

    return heights, differences


class GridTerrain:
    """Posts of a grid joined by two triangles a cell, as drawn.

    z (rows, columns) [m], row 0 northernmost (largest y); `west`, `north` the coordinates of post
    (0, 0); `spacing` > 0 [m]. `diagonal` is the edge that splits each cell: "nw-se" or "sw-ne".
    Beyond the edges the surface continues flat from the nearest edge point."""

    def __init__(self, z, west, north, spacing, diagonal="nw-se"):
        self.z = np.ascontiguousarray(z, float)
        if self.z.ndim != 2 or min(self.z.shape) < 2 or not np.isfinite(self.z).all():
            raise InvalidArgument(f"GridTerrain: heights of shape {self.z.shape}; expected finite, at least 2 x 2")
        if not spacing > 0:
            raise InvalidArgument(f"GridTerrain: spacing {spacing}; expected > 0")
        if diagonal not in ("nw-se", "sw-ne"):
            raise InvalidArgument(f"GridTerrain: diagonal '{diagonal}'; expected 'nw-se' or 'sw-ne'")
        self.west, self.north, self.spacing, self.diagonal = float(west), float(north), float(spacing), diagonal

    @classmethod
    def from_file(cls, path, diagonal="nw-se"):
        """Band 1 of a north-up raster with square pixels; posts are at the pixels' centres."""
        from osgeo import gdal
        data = gdal.Open(str(path))
        if data is None:
            raise InvalidArgument(f"{path}: not a raster that GDAL opens")
        g = data.GetGeoTransform()
        if g[2] or g[4] or abs(g[1] + g[5]) > 1e-9 * abs(g[1]):
            raise InvalidArgument(f"{path}: geotransform {g}; expected north-up with square pixels")
        return cls(data.GetRasterBand(1).ReadAsArray(), g[0] + g[1] / 2, g[3] + g[5] / 2, g[1], diagonal)

    def _cell(self, xy):
        """North-west post's flat index, and the fractions east and south in the cell."""
        rows, columns = self.z.shape
        u = np.clip((xy[:, 0] - self.west) / self.spacing, 0, columns - 1)
        v = np.clip((self.north - xy[:, 1]) / self.spacing, 0, rows - 1)
        i = np.minimum(u.astype(np.int64), columns - 2)
        j = np.minimum(v.astype(np.int64), rows - 2)
        return j * columns + i, u - i, v - j

    def _slopes(self, k, u, v):
        """Height at the north-west end of the triangle's plane, and its rises east and south."""
        z, c = self.z.ravel(), self.z.shape[1]
        nw, ne, sw, se = z[k], z[k + 1], z[k + c], z[k + c + 1]
        if self.diagonal == "nw-se":
            upper = u >= v  # the north-eastern triangle
            return nw, np.where(upper, ne - nw, se - sw), np.where(upper, se - ne, sw - nw)
        upper = u + v <= 1.0  # the north-western triangle
        east = np.where(upper, ne - nw, se - sw)
        south = np.where(upper, sw - nw, se - ne)
        return np.where(upper, nw, sw + ne - se), east, south

    def heights(self, xy):
        """Heights [m] at xy (n, 2)."""
        k, u, v = self._cell(np.asarray(xy, float))
        z, east, south = self._slopes(k, u, v)
        return z + u * east + v * south

    __call__ = heights

    def gradients(self, xy):
        """dz/dx and dz/dy (n, 2) of the triangle under each point."""
        _, east, south = self._slopes(*self._cell(np.asarray(xy, float)))
        return np.column_stack([east, -south]) / self.spacing

    def normals(self, xy):
        """Unit normals (n, 3), upwards."""
        g = self.gradients(xy)
        n = np.column_stack([-g, np.ones(len(g))])
        return n / np.linalg.norm(n, axis=1, keepdims=True)
