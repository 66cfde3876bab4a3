"""Coordinates of places, windows of rasters, and rasters whose ends nearly meet, through Python, against OSR's own."""
import numpy as np
import pytest

import dspace
from terrain_support import between_posts, gdal, real, write_raster

from osgeo import osr  # noqa: E402 (terrain_support skips without it)

MOON = 1737400.0


def write(path, values, transform, wkt, nodata=None):
    data = gdal.GetDriverByName("GTiff").Create(str(path), values.shape[1], values.shape[0], 1, gdal.GDT_Float64)
    data.SetGeoTransform(transform)
    srs = osr.SpatialReference()
    srs.SetFromUserInput(wkt)
    data.SetProjection(srs.ExportToWkt())
    data.SetMetadataItem("VERTICAL_DATUM", "ellipsoid" if "EPSG" in wkt else "sphere")
    data.GetRasterBand(1).SetUnitType("m")
    data.GetRasterBand(1).WriteArray(values)
    return path


def test_coordinates_of_a_projected_raster(scene, tmp_path):
    """UTM: longitude, latitude and geocentric coordinates to a millimetre, of points in a frame that is somewhere."""
    path = write(tmp_path / "utm.tif", np.zeros((20, 20)), (500000, 100, 0, 5500000, 0, -100), "EPSG:32633")
    frame = scene.add_frame("site", position=(7, 8, 9), quaternion=(np.sqrt(0.5), 0, 0, np.sqrt(0.5)))
    terrain = scene.add_terrain(path, frame=frame)
    random = np.random.default_rng(3)
    map = np.column_stack((random.uniform(500000, 502000, 40), random.uniform(5498000, 5500000, 40),
                           random.uniform(-100, 3000, 40)))
    places = terrain.locate(map.reshape(8, 5, 3), map=True)
    assert places.longitude.shape == (8, 5) and places.root.shape == (8, 5, 3)
    utm, degrees, centre = osr.SpatialReference(), osr.SpatialReference(), osr.SpatialReference()
    for system, code in ((utm, 32633), (degrees, 4326), (centre, 4978)):
        system.ImportFromEPSG(code)
        system.SetAxisMappingStrategy(osr.OAMS_TRADITIONAL_GIS_ORDER)
    lonlat = np.array(osr.CoordinateTransformation(utm, degrees).TransformPoints(map.tolist()))
    np.testing.assert_allclose(places.longitude.ravel(), lonlat[:, 0], atol=1e-9)
    np.testing.assert_allclose(places.latitude.ravel(), lonlat[:, 1], atol=1e-9)
    np.testing.assert_allclose(places.height.ravel(), map[:, 2], atol=1e-9)
    degrees3 = osr.SpatialReference()
    degrees3.ImportFromEPSG(4979)
    degrees3.SetAxisMappingStrategy(osr.OAMS_TRADITIONAL_GIS_ORDER)
    lonlat[:, 2] = map[:, 2]
    xyz = np.array(osr.CoordinateTransformation(degrees3, centre).TransformPoints(lonlat.tolist()))
    np.testing.assert_allclose(places.body_fixed.reshape(-1, 3), xyz, atol=1e-3)
    in_frame = terrain.from_map(map)
    turned = np.column_stack((-in_frame[:, 1], in_frame[:, 0], in_frame[:, 2])) + (7, 8, 9)
    np.testing.assert_allclose(places.root.reshape(-1, 3), turned, atol=1e-6)
    one = terrain.locate(in_frame[0])
    assert isinstance(one.longitude, float) and one.map == pytest.approx(map[0], abs=1e-6)
    with pytest.raises(dspace.InvalidArgument, match="shape"):
        terrain.locate([1, 2])
    with pytest.raises(dspace.InvalidArgument, match="finite"):
        terrain.locate([1, 2, np.nan])


def test_inertial_coordinates_follow_the_rotation_of_the_body(scene, tmp_path):
    """The Earth by its rotation angle (IAU 2000 resolution B1.8; UT1 is TT - 63.829 s at J2000), Venus by its rotation elements
    (Archinal et al. 2018), which have no periodic terms, an unknown sphere not at all."""
    path = write(tmp_path / "utm.tif", np.zeros((20, 20)), (500000, 100, 0, 5500000, 0, -100), "EPSG:32633")
    earth = scene.add_terrain(path, name="earth")
    for time in (0.0, 21600.0):
        scene.time = time
        place = earth.locate([501000, 5499000, 0], map=True)
        days = (time - 63.829) / 86400.0
        angle = 360.0 * (0.7790572732640 + 1.00273781191135448 * days)
        x, y, z = place.inertial
        assert (np.degrees(np.arctan2(y, x)) - place.longitude - angle + 180.0) % 360.0 - 180.0 == pytest.approx(0.0, abs=0.01)
        assert z == pytest.approx(place.body_fixed[2], abs=700.0)  # nutation
        assert np.linalg.norm(place.inertial) == pytest.approx(np.linalg.norm(place.body_fixed), rel=1e-12)
    venus = scene.add_terrain(write(tmp_path / "venus.tif", np.zeros((20, 20)), (10, 0.1, 0, 5, 0, -0.1),
                                    "+proj=longlat +R=6051800 +no_defs"), name="venus", on_body=True)
    scene.time = 10 * 86400.0
    place = venus.locate([11.0, 4.0, 0], map=True)
    ra, dec, w = np.radians((272.76, 67.16, 160.20 - 1.4813688 * 10))
    node = np.array((-np.sin(ra), np.cos(ra), 0.0))
    pole = np.array((np.cos(dec) * np.cos(ra), np.cos(dec) * np.sin(ra), np.sin(dec)))
    prime = np.cos(w) * node + np.sin(w) * np.cross(pole, node)
    axes = np.column_stack((prime, np.cross(pole, prime), pole))
    np.testing.assert_allclose(place.inertial, axes @ place.body_fixed, atol=0.1)
    strange = scene.add_terrain(write(tmp_path / "strange.tif", np.zeros((20, 20)), (10, 0.1, 0, 5, 0, -0.1),
                                      "+proj=longlat +R=123456 +no_defs"), name="strange", on_body=True)
    assert np.isnan(strange.locate([11.0, 4.0, 0], map=True).inertial).all()


def test_a_map_without_longitudes(scene, tmp_path):
    terrain = scene.add_terrain(write_raster(tmp_path / "plain.tif", np.zeros((4, 4))))
    place = terrain.locate((1, 2, 3))
    assert np.isnan([place.longitude, place.latitude, place.height]).all() and np.isnan(place.body_fixed).all()
    np.testing.assert_array_equal(place.map, (3, 4, 3))
    np.testing.assert_array_equal(place.root, (1, 2, 3))


def bumps(lon, lat):
    return 3000 * np.cos(np.radians(lat)) * np.sin(np.radians(2 * lon + 30)) + 500 * np.sin(np.radians(3 * lat))


def rounded(tmp_path, columns, rows, pixel, radius=MOON, top=None, name="globe.tif"):
    """A plate carree of a whole sphere in pixels of a rounded size, from longitude -180 on."""
    degree = np.pi * radius / 180
    lon = -180 + (np.arange(columns) + 0.5) * pixel / degree
    top = 0.5 * rows * pixel if top is None else top
    lat = (top - (np.arange(rows) + 0.5) * pixel) / degree
    z = bumps(lon[None, :], lat[:, None])
    return z, write(tmp_path / name, z, (-180 * degree, pixel, 0, top, 0, -pixel),
                    f"+proj=eqc +R={radius} +units=m +no_defs")


# Columns, rows, pixel [m], radius [m]. WAC GLD100 in 853 columns of 12,800 m; a radius map of Vesta as Dawn's maps
# have it; a gap; 0.8 of a column twice.
GLOBES = [(853, 370, 12800.0, MOON, 0.156), (1440, 720, 1112.0, 255000.0, -0.8384),
          (852, 370, 12800.0, MOON, -0.844), (721, 360, 15153.0, MOON, 0.5878)]


@pytest.mark.parametrize("columns, rows, pixel, radius, overlap", GLOBES)
def test_columns_that_overlap_or_leave_a_gap(scene, tmp_path, columns, rows, pixel, radius, overlap):
    assert columns - 2 * np.pi * radius / pixel == pytest.approx(overlap, abs=1e-3)
    z, path = rounded(tmp_path, columns, rows, pixel, radius)
    with pytest.warns(dspace.DspaceWarning, match="go around the body with (an overlap|a gap) of"):
        terrain = scene.add_terrain(path, on_body=True, vertical_datum=f"sphere:{radius}")
    kept = columns - 1 if overlap > 0.5 else columns
    assert terrain.overlap_columns == pytest.approx(overlap - (columns - kept), abs=1e-3)
    # The pixels' own values where the stretched columns stand, and no hole at the seam.
    step = 360 / kept
    west = -180 + 0.5 * kept * pixel / (np.pi * radius / 180) - 180
    row = rows // 2
    lat = (0.5 * rows - row - 0.5) * pixel / (np.pi * radius / 180)
    lat = lat * terrain_rows(rows, pixel, radius)
    for column in (0, 1, kept // 2, kept - 2, kept - 1):
        lon = west + (column + 0.5) * step
        # The columns are resampled: 1 m of 3 km.
        assert terrain.height(*terrain_point(lon, lat, radius)) == pytest.approx(z[row, column], abs=1.0)
    seam = np.linspace(west - step, west + step, 41)
    heights = np.array([terrain.height(*terrain_point(lon, lat, radius)) for lon in seam])
    assert np.isfinite(heights).all()
    below, above = min(z[row, 0], z[row, kept - 1]), max(z[row, 0], z[row, kept - 1])
    middle = heights[(seam > west - 0.49 * step) & (seam < west + 0.49 * step)]
    assert (middle > below - 1).all() and (middle < above + 1).all()


def terrain_rows(rows, pixel, radius):
    """How much rows are stretched."""
    exact = np.pi * radius / rows
    return exact / pixel if abs(rows - np.pi * radius / pixel) < 0.99 else 1.0


def terrain_point(lon, lat, radius):
    lon, lat = np.radians(lon), np.radians(lat)
    return radius * np.array((np.cos(lat) * np.cos(lon), np.cos(lat) * np.sin(lon), np.sin(lat)))


def test_a_globe_of_rounded_pixels_has_no_gap_in_a_picture(scene, tmp_path):
    _, path = rounded(tmp_path, 853, 427, 12800.0)
    with pytest.warns(dspace.DspaceWarning, match="they are taken to go from pole to pole"):
        scene.add_terrain(path, on_body=True, color=(1, 1, 1), lit=False)
    for toward in ((-1, 0.0005, 0.1), (1, 0.001, 0), (0.001, 0, 1), (0, 0.001, -1)):  # seam, meridian, poles
        eye = 1.9e6 * np.array(toward) / np.linalg.norm(toward)
        camera = scene.add_camera(f"eye {toward}", eye=eye, target=(0, 0, 0), fov_deg=20)
        depth = scene.add_viewport((200, 200), camera, samples=1).depth()
        assert np.isfinite(depth).all(), toward


def test_more_than_a_column_too_much_is_rejected(scene, tmp_path):
    _, path = rounded(tmp_path, 858, 370, 12800.0)
    with pytest.raises(dspace.InvalidArgument, match="go around the body more than once; give a window"):
        scene.add_terrain(path, on_body=True)
    degree = np.pi * MOON / 180
    with pytest.warns(dspace.DspaceWarning, match="widened to whole pixels"):
        terrain = scene.add_terrain(path, on_body=True, window=(-90 * degree, 40 * degree, 30 * degree, -20 * degree))
    assert terrain.size[0] == pytest.approx(120 * degree / 12800, abs=1.1)


@pytest.mark.parametrize("mode", ["triangles", "clipmap"])
def test_a_window_of_a_real_raster(scene, mode):
    path = real("mars_gale_mola_128ppd_m.tif")
    z = gdal.Open(str(path)).ReadAsArray().astype(float)
    g = gdal.Open(str(path)).GetGeoTransform()
    window = (g[0] + 100.3 * g[1], g[3] + 200.4 * g[5], g[0] + 300.6 * g[1], g[3] + 350.5 * g[5])
    with pytest.warns(dspace.DspaceWarning, match="widened to whole pixels: 201 x 151 pixels from \\(100, 200\\)"):
        terrain = scene.add_terrain(path, mode=mode, window=window, vertical_datum="areoid")
    assert terrain.size == (201, 151)
    np.testing.assert_allclose(terrain.map_extent, (g[0] + 100 * g[1], g[3] + 200 * g[5], g[0] + 301 * g[1],
                                                    g[3] + 351 * g[5]), atol=1e-9)
    random = np.random.default_rng(5)
    c, r = random.uniform(100.6, 300.4, 500), random.uniform(200.6, 350.4, 500)
    heights = terrain.height(g[0] + c * g[1], g[3] + r * g[5], map=True)
    np.testing.assert_allclose(heights, between_posts(z, c - 0.5, r - 0.5), atol=2e-3)
    assert np.isnan(terrain.height(g[0] + 90 * g[1], g[3] + 250 * g[5], map=True))
    for bad, message in (((0, 1, 0, 2), "with an area"), ((0, np.nan, 1, 2), "finite"), ((0, 1, 1), "4|left, top"),
                         ((10, 80, 20, 70), "does not meet it; accepted is a part of")):
        with pytest.raises(dspace.Error, match=message):
            scene.add_terrain(path, mode=mode, window=bad)


def test_a_window_of_longitudes_of_another_turn(scene):
    path = real("mars_mola_megt90n000cb_4ppd_m.tif")  # from 0 to 360
    terrain = scene.add_terrain(path, window=(-40, 20, -20, 10), vertical_datum="areoid")
    assert terrain.map_extent == pytest.approx((320, 20, 340, 10))
    z = gdal.Open(str(path)).ReadAsArray().astype(float)
    assert terrain.height(329.875, 15.125, map=True) == pytest.approx(z[299, 1319], abs=1e-6)
