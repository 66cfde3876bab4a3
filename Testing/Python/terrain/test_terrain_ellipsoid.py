"""Clipmaps on an ellipsoid through Python: places against PROJ, pictures against the closed form."""
import numpy as np
import pytest

import dspace
from terrain_support import gdal

EQUATORIAL, POLAR = 6378137.0, 6356752.314245
DISTANCE = 2e7


def write_earth(path, height=None, crs=4326):
    """A whole Earth of 720 x 360 pixels; height: a function of longitude and latitude [rad]."""
    from osgeo import osr
    step = 0.5
    longitude, latitude = np.meshgrid(np.radians(step * (np.arange(720) + 0.5) - 180),
                                      np.radians(90 - step * (np.arange(360) + 0.5)))
    data = gdal.GetDriverByName("GTiff").Create(str(path), 720, 360, 1, gdal.GDT_Float32)
    data.SetGeoTransform((-180, step, 0, 90, 0, -step))
    reference = osr.SpatialReference()
    reference.ImportFromEPSG(crs)
    data.SetProjection(reference.ExportToWkt())
    data.GetRasterBand(1).SetUnitType("m")
    data.GetRasterBand(1).WriteArray(np.zeros((360, 720)) if height is None else height(longitude, latitude))
    return str(path)


def open_earth(scene, path):
    return scene.add_terrain(path, name="earth", on_body=True, vertical_datum="ellipsoid")


def place(longitude, latitude, height):
    """Degrees and metres to the body's axes (NIMA TR8350.2, 4-14)."""
    longitude, latitude = np.radians(longitude), np.radians(latitude)
    squash = 1 - (POLAR / EQUATORIAL) ** 2
    east = EQUATORIAL / np.sqrt(1 - squash * np.sin(latitude) ** 2)
    return np.stack(((east + height) * np.cos(latitude) * np.cos(longitude),
                     (east + height) * np.cos(latitude) * np.sin(longitude),
                     ((1 - squash) * east + height) * np.sin(latitude)), -1)


def sag(cell_deg):
    """Greatest height of the body over the diagonal of a cell of its posts [m]."""
    return EQUATORIAL ** 2 / POLAR * (1 - np.cos(np.radians(cell_deg) * np.sqrt(0.5)))  # the pole's radius of curvature


def test_places_on_wgs84(scene, tmp_path):
    earth = open_earth(scene, write_earth(tmp_path / "earth.tif", lambda lon, lat: 3000 * np.sin(4 * lon) * np.cos(lat)))
    random = np.random.default_rng(4)
    longitude, latitude = random.uniform(-179.9, 179.9, 2000), random.uniform(-89.7, 89.7, 2000)
    heights = earth.height(longitude, latitude, map=True)
    points = place(longitude, latitude, heights)
    np.testing.assert_allclose(earth.from_map(np.column_stack((longitude, latitude, heights))), points, atol=1e-6)
    back = earth.to_map(points)
    np.testing.assert_allclose(back[:, :2], np.column_stack((longitude, latitude)), atol=1e-9)
    np.testing.assert_allclose(back[:, 2], heights, atol=1e-6)
    np.testing.assert_allclose(earth.height(*points.T), heights, atol=2e-3)


@pytest.mark.parametrize("toward, up, tall", [((1, 0, 0), (0, 0, 1), POLAR), ((0, 0, 1), (1, 0, 0), EQUATORIAL),
                                              ((0, 1, 0), (0, 0, 1), POLAR)], ids=["equator", "pole", "east"])
def test_the_disc_is_the_closed_form(scene, tmp_path, toward, up, tall):
    open_earth(scene, write_earth(tmp_path / "earth.tif"))
    toward = np.array(toward, float)
    deep = POLAR if toward[2] else EQUATORIAL
    size, height = 512, 1.3e7
    scene.add_camera("orbit", eye=DISTANCE * toward, target=(0, 0, 0), up=up, height=height, near=1.3e7, far=2.1e7)
    view = scene.add_viewport((size, size), "orbit", samples=1)
    depth = view.capture(depth=True)["depth"]
    x, y = np.meshgrid(*2 * [(np.arange(size) - 0.5 * (size - 1)) * height / size])
    rim = np.hypot(x / EQUATORIAL, y / tall)  # 1 on the limb
    margin = 1.5 * height / size / POLAR
    assert np.isfinite(depth[rim < 1 - margin]).all() and np.isinf(depth[rim > 1 + margin]).all()
    # Rows of the limb: the polar radius is 21,385 m less, 0.84 of a pixel.
    inside = rim < 0.9
    expected = DISTANCE - deep * np.sqrt(1 - rim[inside] ** 2)
    # The triangles are chords of cells of 2 degrees, 4 times those of the raster.
    slant = np.sqrt(1 - rim[inside] ** 2)
    assert (np.abs(depth[inside] - expected) * slant).max() < sag(2.0)
    middle = DISTANCE - depth[size // 2 - 1:size // 2 + 1, size // 2 - 1:size // 2 + 1]
    assert abs(middle.mean() - deep) < sag(2.0)
    assert abs(middle.mean() - (POLAR + EQUATORIAL - deep)) > 20000


def test_pictures_are_what_rays_meet(scene, tmp_path):
    earth = open_earth(scene, write_earth(
        tmp_path / "earth.tif", lambda lon, lat: 9e3 * np.sin(40 * lon) * np.cos(30 * lat) * np.cos(lat)))
    random = np.random.default_rng(2)
    for latitude in (45.0, -8.0, 87.0):
        eye = place(10.0, latitude, 60e3)
        up = place(10.0, latitude, 1.0) - place(10.0, latitude, 0.0)
        north = np.cross(np.cross(up, (0.0, 0.0, 1.0)), up)
        north /= np.linalg.norm(north)
        target = eye + 1e5 * (north - 0.5 * up)
        scene.add_camera("low", eye=eye, target=target, up=up, fov_deg=40, near=100, far=3e6)
        view = scene.add_viewport((200, 200), "low", samples=1)
        depth = view.capture(depth=True)["depth"]
        forward = (target - eye) / np.linalg.norm(target - eye)
        right = np.cross(forward, up)
        right /= np.linalg.norm(right)
        above = np.cross(right, forward)
        for column, row in random.integers(5, 195, (40, 2)):
            scale = np.tan(np.radians(20)) / 100
            ray = forward + (column - 99.5) * scale * right - (row - 99.5) * scale * above
            away = earth.intersect(eye, ray)
            seen = depth[row, column]
            if not np.isfinite(away) or away > 4e5:
                continue
            expected = away / np.linalg.norm(ray)
            assert seen == pytest.approx(expected, rel=2e-2)
        view.remove()
        scene.cameras["low"].remove()


def test_a_patch_around_the_pole(scene, tmp_path):
    """Its heights are linear in the metres of its projection, so that interpolation between its pixels is exact."""
    from osgeo import osr
    cells, step = 200, 2000.0
    east, north = np.meshgrid(step * (np.arange(cells) + 0.5 - cells / 2), -step * (np.arange(cells) + 0.5 - cells / 2))
    polar, degrees = osr.SpatialReference(), osr.SpatialReference()
    polar.ImportFromEPSG(3413)
    degrees.ImportFromEPSG(4326)
    degrees.SetAxisMappingStrategy(osr.OAMS_TRADITIONAL_GIS_ORDER)
    polar.SetAxisMappingStrategy(osr.OAMS_TRADITIONAL_GIS_ORDER)
    data = gdal.GetDriverByName("GTiff").Create(str(tmp_path / "pole.tif"), cells, cells, 1, gdal.GDT_Float64)
    data.SetGeoTransform((-cells / 2 * step, step, 0, cells / 2 * step, 0, -step))
    data.SetProjection(polar.ExportToWkt())
    data.GetRasterBand(1).SetUnitType("m")
    data.GetRasterBand(1).WriteArray(2000 + 0.004 * east - 0.002 * north)
    data = None
    earth = scene.add_terrain(write_earth(tmp_path / "earth.tif"), name="earth", on_body=True,
                              vertical_datum="ellipsoid", patches=[{"path": str(tmp_path / "pole.tif"), "margin": 20e3}])
    random = np.random.default_rng(7)
    metres = np.vstack((random.uniform(-150e3, 150e3, (200, 2)), [[0, 0], [1, 0], [-3, 2], [0, 149e3]]))
    places = np.array(osr.CoordinateTransformation(polar, degrees).TransformPoints(metres.tolist()))
    expected = 2000 + 0.004 * metres[:, 0] - 0.002 * metres[:, 1]
    points = place(places[:, 0], places[:, 1], expected)
    # A post's place in the patch is exact within 5/1000 of a pixel, 10 m, in which heights change by 45 mm.
    np.testing.assert_allclose(earth.height(places[:, 0], places[:, 1], map=True), expected, atol=0.045)
    np.testing.assert_allclose(earth.height(*points.T), expected, atol=0.045)
    for point, height in list(zip(points, expected))[::10]:
        down = -point / np.linalg.norm(point)
        # A chord of 2 km lies 0.08 m below the ellipsoid; the ray falls 0.19 degrees off the vertical at most.
        assert abs(earth.intersect(point - 5e4 * down, down) - 5e4) < 0.2, height


def test_another_body_is_rejected(scene, tmp_path):
    path = write_earth(tmp_path / "moon.tif")
    data = gdal.Open(path, gdal.GA_Update)
    from osgeo import osr
    moon = osr.SpatialReference()
    moon.ImportFromProj4("+proj=longlat +R=1737400 +no_defs")
    data.SetProjection(moon.ExportToWkt())
    data = None
    with pytest.raises(dspace.Error, match="WGS 84.*1737400"):
        scene.add_terrain(path, on_body=True, crs="EPSG:4326")
