"""Terrain groups through Python: patches on rasters, what they answer, draw and reject."""
import os
import pathlib

import numpy as np
import pytest

import dspace
from needs import needs_module

gdal = needs_module("osgeo.gdal", "python3-gdal")  # an independent writer and reader
gdal.UseExceptions()
RADIUS = 1737400.0
PLANE = f"+proj=eqc +lon_0=20 +R={RADIUS} +no_defs"
DEGREES = f"+proj=longlat +R={RADIUS} +no_defs"
DATUM = "sphere:1737400"


def write(path, z, crs, left, top, pixel, no_data=None):
    from osgeo import osr
    rows, columns = z.shape
    data = gdal.GetDriverByName("GTiff").Create(str(path), columns, rows, 1, gdal.GDT_Float32)
    data.SetGeoTransform((left, pixel, 0, top, 0, -pixel))
    reference = osr.SpatialReference()
    reference.SetFromUserInput(crs)
    data.SetProjection(reference.ExportToWkt())
    band = data.GetRasterBand(1)
    band.SetUnitType("m")
    if no_data is not None:
        band.SetNoDataValue(no_data)
    band.WriteArray(z.astype(np.float32))
    return path


@pytest.fixture
def base(tmp_path):
    """64 x 64 posts of 100 m, level at 50 m, from (0, 0) to the north-east."""
    return write(tmp_path / "base.tif", np.full((64, 64), 50.0), PLANE, 0, 6400, 100)


def patch_of(path, z, **given):
    """A patch in degrees, `z` (square) about the middle of the base; pixels of 10 m."""
    metre = 1 / (RADIUS * np.radians(1))
    half = len(z) * 5 * metre
    path = write(path, np.asarray(z), DEGREES, 20 + 3200 * metre - half, 3200 * metre + half,
                 10 * metre, no_data=-9999)
    return dict(path=path, vertical_datum=DATUM, **given)


def test_heights_and_what_is_told(scene, base, tmp_path):
    column = np.arange(120.0)
    patch = patch_of(tmp_path / "patch.tif", np.tile(column, (120, 1)), name="site", margin=200,
                     vertical_scale=0.5, vertical_offset=100)
    terrain = scene.add_terrain(base, vertical_datum=DATUM, patches=[patch])
    assert terrain.mode == "clipmap"
    assert terrain.tiles["subdivisions"] == 4  # 100 m / 2^4 < 10 m
    told, = terrain.patches
    assert told["name"] == "site" and told["used"] and told["margin"] == 200
    assert told["pixel_size"] == pytest.approx(10, rel=1e-3) and told["added"] == 0
    assert told["height_range"] == (100, 159.5) and terrain.height_range == (50, 159.5)
    assert told["posts"] > 50 and told["greatest_error"] < 1e-3  # a plane costs nothing
    x = np.linspace(2900, 3500, 50)
    inside = 100 + 0.5 * ((x - 2600) / 10 - 0.5)
    np.testing.assert_allclose(terrain.height(x, 3200, map=True), inside, atol=5e-3)
    assert terrain.height(1000, 1000, map=True) == 50


def test_weights_along_the_margin(scene, base, tmp_path):
    """3 s^2 - 2 s^3 of the distance from the edge, less three pixels."""
    patch = patch_of(tmp_path / "patch.tif", np.full((120, 120), 150.0), margin=200)
    terrain = scene.add_terrain(base, vertical_datum=DATUM, patches=[patch])
    x = np.arange(2605, 3200, 10.0)  # its pixels' centres, from its edge at 2600
    s = np.clip((x - 2595 - 30) / 200, 0, 1)
    np.testing.assert_allclose(terrain.height(x, 3200, map=True), 50 + 100 * (3 * s**2 - 2 * s**3),
                               atol=0.6)
    walk = terrain.height(np.arange(2500, 3200, 0.1), 3200, map=True)
    assert np.abs(np.diff(walk)).max() <= 0.1 * 1.5 * np.sqrt(2) / 200 * 100
    assert np.ptp(walk) == pytest.approx(100, abs=1e-3)


def test_the_picture_shows_it(scene, base, tmp_path):
    patch = patch_of(tmp_path / "patch.tif", np.full((120, 120), 150.0), margin=200)
    terrain = scene.add_terrain(base, vertical_datum=DATUM, patches=[patch], color=(1, 1, 1))
    scene.add_camera("down", eye=(0, 0, 1000), target=(0, 0, 0), up=(0, 1, 0), fov_deg=60, near=1)
    view = scene.add_viewport((96, 96), "down", samples=1)
    depth = view.depth()
    assert depth[48, 48] == pytest.approx(850, abs=0.01)
    pixel = 2 * np.tan(np.radians(30)) / 96
    place = (np.arange(96) + 0.5 - 48) * pixel * depth[48]
    heights = terrain.height(place, np.full(96, -0.5 * pixel * depth[48]))
    np.testing.assert_allclose(1000 - depth[48], heights, atol=3)  # far posts are coarser


def test_what_adds_nothing_is_warned_of(scene, base, tmp_path):
    with pytest.warns(dspace.DspaceWarning, match="'empty' is wholly without data"):
        terrain = scene.add_terrain(base, vertical_datum=DATUM, patches=[
            patch_of(tmp_path / "empty.tif", np.full((40, 40), -9999.0), name="empty"),
            patch_of(tmp_path / "good.tif", np.full((120, 120), 70.0), name="good")])
    assert [(told["name"], told["used"]) for told in terrain.patches] == [("empty", False),
                                                                          ("good", True)]
    assert terrain.height(3200, 3200, map=True) == 70


def test_datums(scene, base, tmp_path):
    z = np.full((120, 120), 70.0)
    above = dict(patch_of(tmp_path / "above.tif", z), vertical_datum="sphere:1737500")
    terrain = scene.add_terrain(base, vertical_datum=DATUM, patches=[above])
    assert terrain.height(3200, 3200, map=True) == 170 and terrain.patches[0]["added"] == 100
    unknown = patch_of(tmp_path / "unknown.tif", z)
    del unknown["vertical_datum"]
    with pytest.warns(dspace.DspaceWarning, match="its vertical datum is unknown.*sphere:1737400"):
        terrain = scene.add_terrain(base, vertical_datum=DATUM, patches=[unknown])
    assert terrain.height(3200, 3200, map=True) == 70


@pytest.mark.parametrize("given, kind, text", [
    ({"patches": [{}]}, dspace.InvalidArgument, "path"),
    ({"patches": ["a.tif"]}, dspace.WrongType, "a.tif"),
    ({"patches": 3}, dspace.WrongType, "3"),
    ({"patches": [{"path": "no_such.tif"}]}, dspace.NotFound, "no_such.tif"),
    ({"patches": [{"path": "PATCH", "margins": 3}]}, dspace.WrongType, "margins"),
    ({"patches": [{"path": "PATCH", "margin": 0}]}, dspace.InvalidArgument, "margin"),
    ({"patches": [{"path": "PATCH", "margin": float("nan")}]}, dspace.InvalidArgument, "margin"),
    ({"patches": [{"path": "PATCH", "margin": "wide"}]}, dspace.WrongType, "wide"),
    ({"patches": [{"path": "PATCH", "band": 2}]}, dspace.InvalidArgument, "band"),
    ({"patches": [{"path": "PATCH", "crs": "+proj=longlat +R=3396190"}]}, dspace.InvalidArgument,
     "3396190"),
    ({"patches": [{"path": "PATCH"}], "mode": "triangles"}, dspace.InvalidArgument, "clipmap"),
])
def test_what_is_refused_changes_nothing(scene, base, tmp_path, refused, given, kind, text):
    path = patch_of(tmp_path / "patch.tif", np.full((40, 40), 70.0))["path"]
    for patch in given["patches"] if isinstance(given["patches"], list) else ():
        if isinstance(patch, dict) and patch.get("path") == "PATCH":
            patch["path"] = path
    with refused(kind, text):
        scene.add_terrain(base, **given)


def real(name):
    path = pathlib.Path(os.environ.get("DSPACE_DATA") or "/nonexistent") / "terrain" / name
    if not path.exists():
        pytest.skip(f"real data absent: set DSPACE_DATA to the folder that has terrain/{name}")
    return path


def test_whole_mars_with_gale_and_hirise_has_no_gap(scene):
    """From orbit to close by: no background through the ground, and Bradbury Landing's height."""
    radius, datum = 3396190.0, "sphere:3396190"
    terrain = scene.add_terrain(
        real("mars_mola_megt90n000cb_4ppd_m.tif"), on_body=True, vertical_datum=datum, patches=[
            dict(path=real("mars_gale_mola_128ppd_m.tif"), vertical_datum=datum),
            dict(path=real("mars_gale_hirise_DTEEC_009650_5m_relative_u16.tif"), vertical_datum=datum,
                 vertical_scale=0.00245, vertical_offset=-4029, margin=150)])
    assert terrain.height(137.4417, -4.5895, map=True) == pytest.approx(-4503, abs=1)
    assert terrain.patches[1]["rms_error"] < 0.2
    longitude, latitude = np.radians((137.3333, -4.7993))
    up = np.array([np.cos(latitude) * np.cos(longitude), np.cos(latitude) * np.sin(longitude),
                   np.sin(latitude)])
    ground = up * (radius + terrain.height(137.3333, -4.7993, map=True))
    north = np.array([0, 0, 1.0])
    north -= north.dot(up) * up
    for distance in (1e6, 1e5, 5e3, 8e2, 60):
        scene.add_camera("eye", eye=ground + distance * (0.9 * up - 0.4 * north), target=ground,
                         up=north, fov_deg=40, near=0.01 * distance)
        view = scene.add_viewport((160, 120), "eye", samples=1)
        view.set_background((1, 0, 1))
        planes = view.capture(depth=True)
        assert np.isfinite(planes["depth"]).all(), distance
        assert not (planes["color"][..., :3] == (255, 0, 255)).all(axis=-1).any()
        # The ground below the picture's middle is at its distance, to what the ring there resolves.
        assert planes["depth"][60, 80] == pytest.approx(distance * np.hypot(0.9, 0.4), rel=0.02)
        view.remove()
