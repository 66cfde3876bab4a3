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


SIDE, HOLE = 256, slice(100, 156)  # pixels of 2 m; columns and rows without data
SHOWN = slice(78, 178)  # columns and rows of the raster that the picture shows, a pixel each
GROUND, MAGENTA = (0.5, 0.25, 0.75), (1.0, 0.0, 1.0)


def from_above(scene, path, **options):
    terrain = scene.add_terrain(path, mode="clipmap", color=GROUND, lit=False, **options)
    scene.add_camera("above", eye=(0, 0, 500), target=(0, 0, 0), up=(0, 1, 0), height=200)
    return terrain, scene.add_viewport(size=(100, 100), samples=1)


def mixed(below, above, opacity):
    """0 to 255, in linear light (IEC 61966-2-1)."""
    below, above = (np.where(c <= 0.04045, c / 12.92, ((c + 0.055) / 1.055) ** 2.4)
                    for c in (np.asarray(below), np.asarray(above)))
    light = (1 - opacity) * below + opacity * above
    return 255 * np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)


def test_what_is_filled_is_tinted_and_nothing_else(scene, tmp_path):
    level = np.zeros((SIDE, SIDE), np.float32)
    holed = level.copy()
    holed[HOLE, HOLE] = np.nan
    terrain, view = from_above(scene, write_raster(tmp_path / "hole.tif", holed, 2.0), fill_holes=True)
    layer = terrain.layer("filled")
    assert layer.kind == "filled" and layer.opacity == 0.4 and layer.visible and layer.pixel_size == 2.0
    picture = view.image()[..., :3].astype(int)
    hole = np.isnan(holed)[SHOWN, SHOWN]
    rim = np.zeros_like(hole)  # within a pixel of where data end
    for shift, axis in ((1, 0), (-1, 0), (1, 1), (-1, 1)):
        rim |= np.roll(hole, shift, axis) != hole
    tinted = np.abs(picture - mixed(GROUND, MAGENTA, 0.4)).max(axis=-1) <= 2
    plain = np.abs(picture - 255 * np.array(GROUND)).max(axis=-1) <= 1
    assert tinted[hole & ~rim].all() and plain[~hole & ~rim].all()
    assert np.count_nonzero(hole & ~rim) == 54 * 54
    layer.opacity = 1.0
    assert np.abs(view.image()[50, 50, :3] - 255 * np.array(MAGENTA)).max() <= 1
    layer.visible = False
    hidden = view.image()
    with dspace.Session() as session:
        whole = session.scene()
        _, other = from_above(whole, write_raster(tmp_path / "level.tif", level, 2.0))
        np.testing.assert_array_equal(hidden, other.image())


def test_the_tint_stays_on_top_and_is_a_layer_as_any(scene, tmp_path):
    path = plane_with_hole(tmp_path / "hole.tif")
    assert scene.add_terrain(path, mode="clipmap").layers == []
    terrain = scene.add_terrain(path, fill_holes=True)
    terrain.add_noise(wavelength=20)
    assert [layer.name for layer in terrain.layers] == ["noise", "filled"]
    terrain.add_noise(wavelength=20, name="above", position=2)
    assert [layer.kind for layer in terrain.layers] == ["noise", "filled", "noise"]
    terrain.layer("filled").remove()
    assert [layer.name for layer in terrain.layers] == ["noise", "above"]
    assert terrain.filled(0, 0)
