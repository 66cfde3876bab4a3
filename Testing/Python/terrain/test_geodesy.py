"""Geodesics, grid references and geoid heights through Python: against published values, PROJ's geodesics and OSR."""
import ctypes
import ctypes.util
import os

import numpy as np
import pytest

import dspace
from needs import lacks
from served_support import Served
from terrain_support import gdal, write_raster

from osgeo import osr  # noqa: E402 (terrain_support skips without it)

# Latitude, longitude, azimuth at both ends [deg], distance [m]: C. F. F. Karney, geodesictest.c of GeographicLib.
KARNEY = np.array([
    (35.60777, -139.44815, 111.098748429560326, -11.17491, -69.95921, 129.289270889708762, 8935244.5604818305),
    (55.52454, 106.05087, 22.020059880982801, 77.03196, 197.18234, 109.112041110671519, 4105086.1713924406),
    (-21.97856, 142.59065, -32.44456876433189, 41.84138, 98.56635, -41.84359951440466, 8394328.894657671),
    (-66.99028, 112.2363, 173.73491240878403, -12.70631, 285.90344, 2.512956620913668, 11150344.2312080241)])
A, B = KARNEY[:, (1, 0)], KARNEY[:, (4, 3)]


def write(path, wkt, size=4, corner=(10, 51)):
    data = gdal.GetDriverByName("GTiff").Create(str(path), size, size, 1, gdal.GDT_Float64)
    data.SetGeoTransform((corner[0], 0.1, 0, corner[1], 0, -0.1))
    srs = osr.SpatialReference()
    srs.SetFromUserInput(wkt)
    data.SetProjection(srs.ExportToWkt())
    data.GetRasterBand(1).WriteArray(np.zeros((size, size)))
    return str(path)


def apart(a, b):
    return np.abs((np.asarray(a) - b + 180) % 360 - 180)


def test_karneys_lines(scene):
    earth = scene.geodesy()
    lines = earth.inverse(A, B)
    np.testing.assert_allclose(lines.distance, KARNEY[:, 6], atol=1e-7)
    assert apart(lines.azimuth_deg, KARNEY[:, 2]).max() < 1e-12
    assert apart(lines.end_azimuth_deg, KARNEY[:, 5]).max() < 1e-12
    ends = earth.direct(A, KARNEY[:, 2], KARNEY[:, 6])
    assert apart(ends.place[:, 0], B[:, 0]).max() < 1e-12 and np.abs(ends.place[:, 1] - B[:, 1]).max() < 1e-12
    assert apart(ends.azimuth_deg, KARNEY[:, 5]).max() < 1e-12
    one = earth.inverse(A[0], B[0])
    assert isinstance(one.distance, float) and one.distance == pytest.approx(8935244.5604818305, abs=1e-7)
    assert earth.inverse(A[0], B).distance.shape == (4,) and earth.inverse(A[:, None], B).distance.shape == (4, 4)
    fan = earth.direct((10, 20), np.arange(6).reshape(2, 3), 1000)
    assert fan.place.shape == (2, 3, 2) and fan.azimuth_deg.shape == (2, 3)
    np.testing.assert_allclose(earth.inverse((10, 20), fan.place).distance, 1000, atol=1e-7)
    assert earth.inverse(np.empty((0, 2)), np.empty((0, 2))).distance.shape == (0,)


class ProjGeodesic(ctypes.Structure):
    _fields_ = [("values", ctypes.c_double * 64)]  # more than struct geod_geodesic has


@pytest.mark.parametrize("radius, flattening", [(1737400, 0), (6378137, 1 / 298.257223563), (3396190, 1 / 169.894)])
def test_proj_agrees(scene, radius, flattening):
    name = ctypes.util.find_library("proj")
    if not name:
        lacks("libproj-dev")
    proj, body, double = ctypes.CDLL(name), ProjGeodesic(), ctypes.c_double
    proj.geod_init(ctypes.byref(body), double(radius), double(flattening))
    random = np.random.default_rng(2)
    a, b = (np.column_stack((random.uniform(-180, 180, 200), random.uniform(-90, 90, 200))) for _ in range(2))
    found = scene.geodesy((radius, flattening)).inverse(a, b)
    for i, ((lon1, lat1), (lon2, lat2)) in enumerate(zip(a, b)):
        distance, azimuth, end = double(), double(), double()
        proj.geod_inverse(ctypes.byref(body), double(lat1), double(lon1), double(lat2), double(lon2),
                          ctypes.byref(distance), ctypes.byref(azimuth), ctypes.byref(end))
        assert found.distance[i] == pytest.approx(distance.value, abs=1e-6)
        assert apart(found.azimuth_deg[i], azimuth.value) < 1e-9 and apart(found.end_azimuth_deg[i], end.value) < 1e-9


def test_a_terrain_knows_its_ellipsoid(scene, tmp_path):
    """Along the equator a geodesic has the length a * angle; places of the terrain come from locate()."""
    moon = scene.add_terrain(write(tmp_path / "moon.tif", "+proj=longlat +R=1737400"), name="moon")
    assert moon.geodesy.inverse((0, 0), (90, 0)).distance == pytest.approx(1737400 * np.pi / 2, abs=1e-6)
    mars = scene.add_terrain(write(tmp_path / "mars.tif", "+proj=eqc +a=3396190 +b=3376200", corner=(0, 0)), name="mars")
    assert mars.geodesy.inverse((0, 0), (90, 0)).distance == pytest.approx(3396190 * np.pi / 2, abs=1e-6)
    earth = scene.add_terrain(write(tmp_path / "earth.tif", "EPSG:4326"), name="earth")
    ends = earth.locate([(10.1, 50.9, 0), (10.3, 50.7, 0)], map=True)
    places = np.column_stack((ends.longitude, ends.latitude))
    assert earth.geodesy.inverse(*places).distance == pytest.approx(scene.geodesy().inverse(*places).distance, abs=1e-9)
    assert repr(earth.geodesy) == "<dspace.Geodesy of terrain 'earth'>"
    with pytest.raises(dspace.Unsupported, match="1737400 m"):
        moon.geodesy.utm((3, 0))
    with pytest.raises(dspace.Unsupported, match="3396190 m"):
        mars.geodesy.mgrs((3, 0))
    with pytest.raises(dspace.Unsupported, match="terrain 'moon'.*WGS 84"):
        moon.geodesy.geoid_height((3, 0))
    with pytest.raises(dspace.Unsupported, match="WGS 84"):
        scene.geodesy((6378206.4, 1 / 294.978698214)).from_mgrs("38SMB4488")
    plain = scene.add_terrain(write_raster(tmp_path / "plain.tif", np.zeros((4, 4))), name="plain")
    with pytest.raises(dspace.Unsupported, match="terrain 'plain'.*has no ellipsoid"):
        plain.geodesy.inverse((0, 0), (1, 1))


def test_utm_is_that_of_osr(scene):
    random = np.random.default_rng(8)
    places = np.column_stack((random.uniform(-180, 180, 300), random.uniform(-79.9, 83.9, 300)))
    earth = scene.geodesy("WGS 84")
    utm = earth.utm(places.reshape(20, 15, 2))
    assert utm.zone.shape == (20, 15) and utm.north.dtype == bool
    degrees = osr.SpatialReference()
    degrees.ImportFromEPSG(4326)
    degrees.SetAxisMappingStrategy(osr.OAMS_TRADITIONAL_GIS_ORDER)
    for place, zone, north, easting, northing in zip(places, utm.zone.flat, utm.north.flat, utm.easting.flat,
                                                     utm.northing.flat):
        grid = osr.SpatialReference()
        grid.ImportFromEPSG((32600 if north else 32700) + int(zone))
        x, y, _ = osr.CoordinateTransformation(degrees, grid).TransformPoint(*place)
        assert (easting, northing) == pytest.approx((x, y), abs=1e-6)
    back = earth.from_utm(utm.zone, utm.north, utm.easting, utm.northing)
    assert back.shape == (20, 15, 2) and np.abs(back.reshape(-1, 2) - places).max() < 1e-9
    assert earth.utm((5, 60)).zone == 32 and earth.utm((5, 60), zone=31).zone == 31  # Norway
    assert earth.utm((5, 60), zone=31).easting == pytest.approx(
        osr_point(degrees, 32631, (5, 60)), abs=1e-6)
    pole = earth.utm((20, -90))
    assert (pole.zone, pole.north) == (0, False) and pole.easting == pytest.approx(2e6, abs=1e-6)


def osr_point(degrees, code, place):
    grid = osr.SpatialReference()
    grid.ImportFromEPSG(code)
    return osr.CoordinateTransformation(degrees, grid).TransformPoint(*place)[0]


def test_mgrs(scene):
    """GeographicLib's manual page of GeoConvert: 38SMB4488 is at 33.33424, 44.40363; the equator at 3 degrees east and
    the pole by hand."""
    earth = scene.geodesy()
    np.testing.assert_allclose(earth.from_mgrs("38SMB4488"), (44.40363, 33.33424), atol=5e-6)
    assert earth.mgrs((44.4, 33 + 1 / 3), 2) == "38SMB4488" and earth.mgrs((44.4, 33 + 1 / 3), precision=1) == "38SMB48"
    references = earth.mgrs([[(3, 0), (0, 90)]])
    assert references.tolist() == [["31NEA0000000000", "ZAH0000000000"]]
    places = earth.from_mgrs(references)
    assert places.shape == (1, 2, 2) and np.abs(places[0, 0] - (3, 0)).max() < 1e-5  # half a metre off
    assert earth.from_mgrs(["38SMB4488", "31NEA"]).shape == (2, 2)


def test_geoid_heights(scene, tmp_path):
    """NGA's test values of EGM96 (F477, OUTPUT.DAT), and the grid as GDAL reads it, bilinear by hand."""
    earth = scene.geodesy()
    nga = np.array([(269.779155, 38.628155, -31.628), (305.021114, -14.621217, -2.969), (102.448729, 46.874319, -43.575),
                    (133.874712, -23.617446, 15.871), (359.9995, 38.625473, 50.066), (0.0023, -0.466744, 17.329)])
    np.testing.assert_allclose(earth.geoid_height(nga[:, :2]), nga[:, 2], atol=0.15)
    assert earth.geoid_height((0, 90)) == pytest.approx(13.606, abs=1e-3)
    path = "/usr/share/proj/egm96_15.gtx"
    if not os.path.exists(path):
        lacks("proj-data")
    grid = gdal.Open(path)
    west, step, _, top, _, down = grid.GetGeoTransform()
    values = grid.ReadAsArray()
    random = np.random.default_rng(4)
    places = np.column_stack((random.uniform(-179, 179, 50), random.uniform(-89, 89, 50)))
    x, y = (places[:, 0] - west) / step - 0.5, (places[:, 1] - top) / down - 0.5
    i, j = np.floor(x).astype(int), np.floor(y).astype(int)
    u, v = x - i, y - j
    by_hand = ((values[j, i] * (1 - u) + values[j, i + 1] * u) * (1 - v)
               + (values[j + 1, i] * (1 - u) + values[j + 1, i + 1] * u) * v)
    np.testing.assert_allclose(earth.geoid_height(places, geoid="egm96_15.gtx"), by_hand, atol=2e-4)


def test_absent_geoids_are_named(scene, monkeypatch, tmp_path):
    earth = scene.geodesy()
    monkeypatch.setenv("GEOGRAPHICLIB_GEOID_PATH", str(tmp_path))
    with pytest.raises(dspace.NotFound) as error:
        earth.geoid_height((0, 0), "egm96-5")
    assert str(tmp_path / "egm96-5.pgm") in str(error.value) and "geographiclib-tools" in str(error.value)
    (tmp_path / "egm96-5.pgm").write_bytes(b"P5\nno grid")
    with pytest.raises(dspace.Corrupt, match="egm96-5.pgm"):
        earth.geoid_height((0, 0), "egm96-5")
    with pytest.raises(dspace.NotFound, match="'other.gtx' in .*proj"):
        earth.geoid_height((0, 0), "other.gtx")
    for name in ("", "../egm96-5", "/etc/passwd", "a\0b"):
        with pytest.raises(dspace.InvalidArgument, match="geoid"):
            earth.geoid_height((0, 0), name)


def test_bad_input(scene, refused):
    earth = scene.geodesy()
    with refused(dspace.InvalidArgument, "latitude 90.1"):
        earth.inverse((0, 90.1), (0, 0))
    with refused(dspace.InvalidArgument, "end 1: "):
        earth.inverse((0, 0), [(0, 1), (0, -91)])
    with refused(dspace.InvalidArgument, "nan"):
        earth.utm((np.nan, 0))
    with refused(dspace.InvalidArgument, "inf"):
        earth.geoid_height((np.inf, 0))
    with refused(dspace.InvalidArgument, "(3,)"):
        earth.inverse((0, 1, 2), (0, 0))
    with refused(dspace.InvalidArgument, "a (2, 2), b (3, 2)"):
        earth.inverse(np.zeros((2, 2)), np.zeros((3, 2)))
    with refused(dspace.WrongType, "longitude and latitude"):
        earth.mgrs("here")
    with refused(dspace.InvalidArgument, "azimuth"):
        earth.direct((0, 0), np.nan, 1)
    with refused(dspace.InvalidArgument, "0 to 60"):
        earth.utm((3, 0), zone=61)
    with refused(dspace.InvalidArgument, "near the zone"):
        earth.utm((3, 0), zone=12)
    with refused(dspace.InvalidArgument, "zone is 61"):
        earth.from_utm(61, True, 5e5, 0)
    with refused(dspace.WrongType, "zone"):
        earth.from_utm(31.5, True, 5e5, 0)
    with refused(dspace.WrongType, "north"):
        earth.from_utm(31, 1, 5e5, 0)
    with refused(dspace.InvalidArgument, "zone 31 north"):
        earth.from_utm(31, True, 5e9, 0)
    with refused(dspace.InvalidArgument, "0 to 11"):
        earth.mgrs((3, 0), precision=12)
    with refused(dspace.InvalidArgument, "'38XXX'"):
        earth.from_mgrs(["38SMB4488", "38XXX"])
    with refused(dspace.WrongType, "MGRS"):
        earth.from_mgrs(5.0)
    with refused(dspace.InvalidArgument, "'GRS80'"):
        scene.geodesy("GRS80")
    with refused(dspace.InvalidArgument, "flattening is 0.7"):
        scene.geodesy((1e6, 0.7))
    with refused(dspace.InvalidArgument, "equatorial radius is -1"):
        scene.geodesy((-1, 0))
    with refused(dspace.WrongType, "ellipsoid"):
        scene.geodesy((1, 2, 3))


def test_over_the_link(scene, tmp_path):
    """A connected session asks its server."""
    expected = scene.geodesy().inverse(A, B).distance
    with Served(tmp_path) as served, dspace.connect(served.address) as remote:
        earth = remote.scene().geodesy()
        np.testing.assert_array_equal(earth.inverse(A, B).distance, expected)
        assert earth.mgrs((3, 0)) == "31NEA0000000000"
        with pytest.raises(dspace.NotFound, match="absent.gtx"):
            earth.geoid_height((0, 0), "absent.gtx")
