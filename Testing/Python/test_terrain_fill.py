"""Holes that are filled, and degree grids that are resampled, through the package."""
import numpy as np
import pytest

import dspace
from terrain_support import write_raster


def plane_with_hole(path):
    y, x = np.mgrid[0:201, 0:201]
    z = (0.2 * x + 0.1 * y).astype(np.float32)
    z[80:121, 80:121] = np.nan
    return write_raster(path, z)


def test_a_hole_is_filled_and_told(scene, tmp_path):
    path = plane_with_hole(tmp_path / "hole.tif")
    plain = scene.add_terrain(path, mode="clipmap")
    assert np.isnan(plain.height(0, 0)) and not plain.filled(0, 0) and not plain.filled(60, 0)
    filled = scene.add_terrain(path, fill_holes=True)
    assert filled.mode == "clipmap"
    # 100, 100 is the middle; the fill leans by at most a fifteenth of 4 pixels.
    assert filled.height(0, 0) == pytest.approx(30.0, abs=0.1)
    assert filled.filled(0, 0) is True and filled.filled(60, 0) is False
    x = np.array([0.0, 60.0, 19.0, 22.0])
    np.testing.assert_array_equal(filled.filled(x, 0.0), [True, False, True, False])
    np.testing.assert_array_equal(filled.height([60.0], [0.0]), plain.height([60.0], [0.0]))
    near = scene.add_terrain(path, fill_holes=5)
    assert np.isnan(near.height(0, 0)) and near.filled(18, 0)


def test_bad_fills_are_refused(scene, tmp_path):
    path = plane_with_hole(tmp_path / "hole.tif")
    for bad in (0, -1.0, float("nan")):
        with pytest.raises(dspace.Error):
            scene.add_terrain(path, fill_holes=bad)
    with pytest.raises(dspace.Error, match="triangles keep their holes"):
        scene.add_terrain(path, fill_holes=True, mode="triangles")
