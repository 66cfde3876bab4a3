"""Distances, profiles, areas and angles: closed forms, and the pixels of a real raster."""
import csv

import numpy as np
import pytest

import dspace
from terrain_support import gdal, real, write_raster

from osgeo import osr  # noqa: E402 (terrain_support skips without it)

MOON = 1737400.0


def write_moon(path, projection, transform, z):
    data = gdal.GetDriverByName("GTiff").Create(str(path), z.shape[1], z.shape[0], 1, gdal.GDT_Float32)
    data.SetGeoTransform(transform)
    data.SetMetadataItem("VERTICAL_DATUM", "sphere")
    srs = osr.SpatialReference()
    srs.ImportFromProj4(projection + f" +R={MOON} +no_defs")
    data.SetProjection(srs.ExportToWkt())
    data.GetRasterBand(1).WriteArray(z)
    return path


@pytest.fixture
def ramp(scene, tmp_path):
    """A plane that rises by 0.5 m a metre to the east, 2 m posts."""
    z = np.tile(0.5 * (2.0 * np.arange(60) + 1.0), (50, 1)).astype(np.float32)
    return scene.add_terrain(write_raster(tmp_path / "ramp.tif", z, 2.0), name="ramp")


def sphere(places):
    lon, lat = np.radians(places).T
    return np.column_stack((np.cos(lat) * np.cos(lon), np.cos(lat) * np.sin(lon), np.sin(lat)))


def test_lines_angles_and_polygons_in_space(scene):
    line = scene.measure_line([(0, 0, 0), (3, 4, 0), (3, 4, 12)])
    assert line.lengths == pytest.approx([5, 12]) and line.length == pytest.approx(17)
    assert line.terrain is None and line.distance is None and line.profile is None and line.climb is None
    arm = scene.add_frame("arm", position=(10, 0, 0), quaternion=(np.sqrt(0.5), 0, 0, np.sqrt(0.5)))
    assert scene.measure_line([(1, 0, 0), (2, 0, 0)], frame=arm).points == pytest.approx(np.array([(10, 1, 0), (10, 2, 0)]))
    assert scene.measure_angle((1, 0, 0), (0, 0, 0), (0, 2, 0)) == pytest.approx(90, abs=1e-12)
    assert scene.measure_angle((1, 0, 0), (0, 0, 0), (1, 1e-9, 0)) == pytest.approx(np.degrees(1e-9), rel=1e-12)
    assert scene.measure_angle((10, 5, 0), "arm", scene.root) == pytest.approx(90, abs=1e-12)
    # A rectangle of 3 x 4 m, tilted by 30 degrees about X.
    c, s = np.cos(np.pi / 6), np.sin(np.pi / 6)
    corners = [(0, 0, 5), (3, 0, 5), (3, 4 * c, 5 + 4 * s), (0, 4 * c, 5 + 4 * s)]
    area = scene.measure_area(corners)
    assert area.area == pytest.approx(12) and area.perimeter == pytest.approx(14) and area.surface_area is None
    assert scene.measure_area(corners[::-1]).area == pytest.approx(12)


def test_a_ramp_is_measured_as_its_plane(scene, ramp):
    line = scene.measure_line([(10, 20), (70, 20), (70, 60)], ramp, samples=500)
    assert line.distances == pytest.approx([60, 40]) and line.azimuth_deg == pytest.approx([90, 0])
    assert line.rises == pytest.approx([30, 0], abs=1e-4)
    assert line.slope_deg == pytest.approx([np.degrees(np.arctan(0.5)), 0], abs=1e-4)
    assert line.lengths == pytest.approx([60 * np.sqrt(1.25), 40], rel=1e-6)
    assert line.ground_length == pytest.approx(60 * np.sqrt(1.25) + 40, rel=1e-6)
    assert line.climb == pytest.approx(30, abs=1e-3) and line.descent == pytest.approx(0, abs=1e-3)
    profile = line.profile
    assert abs(len(profile.distance) - 500) <= 2 and profile.distance[0] == 0 and profile.distance[-1] == pytest.approx(100)
    assert np.all(np.diff(profile.distance) > 0)
    assert profile.height == pytest.approx(np.minimum(profile.distance, 60) * 0.5 + 5, abs=1e-4)
    assert profile.slope_deg == pytest.approx(np.degrees(np.arctan(0.5)), abs=1e-3)
    assert profile.point[:, 2] == pytest.approx(profile.height, abs=1e-9)
    # Points over the ground are measured on it, too: the name of the terrain is enough.
    above = scene.measure_line(ramp.from_map([(10, 20, 90), (70, 20, 90)]), "ramp")
    assert above.length == pytest.approx(60) and above.rises == pytest.approx([30], abs=1e-4)
    area = scene.measure_area([(10, 20), (70, 20), (70, 60), (10, 60)], ramp)
    assert area.area == pytest.approx(2400) and area.perimeter == pytest.approx(200)
    assert area.surface_area == pytest.approx(2400 * np.sqrt(1.25), rel=1e-6) and area.covered == pytest.approx(1)
    assert area.mean_height == pytest.approx(20, abs=1e-3) and area.mean_slope_deg == pytest.approx(26.565051, abs=1e-4)
    assert 5 <= area.least_height < 5.4 and 34.6 < area.greatest_height <= 35


def test_data_that_are_missing_are_not_measured(scene, tmp_path):
    z = np.ones((40, 40), np.float32)
    z[:, 20:] = np.nan
    path = write_raster(tmp_path / "half.tif", z)
    terrain = scene.add_terrain(path, name="half", mode="clipmap")
    line = scene.measure_line(terrain.from_map([(5, 20, 3), (35, 20, 3)]), terrain)
    assert np.isnan(line.ground_length) and np.isnan(line.rises).all() and line.distance == pytest.approx(30)
    assert np.isfinite(line.profile.height[0]) and np.isnan(line.profile.height[-1])
    line.profile.save(tmp_path / "profile.csv")
    rows = list(csv.DictReader((tmp_path / "profile.csv").open()))
    assert float(rows[0]["height_m"]) == 1 and rows[-1]["height_m"] == "" and float(rows[-1]["distance_m"]) == pytest.approx(30)
    area = scene.measure_area(terrain.from_map([(5, 5, 1), (35, 5, 1), (35, 35, 1), (5, 35, 1)]), terrain)
    assert area.area == pytest.approx(900) and area.covered == pytest.approx(0.48, abs=0.02)
    with pytest.raises(dspace.InvalidArgument, match=r"point 1 at map \[35.0, 20.0\] is not on data of terrain 'half'"):
        scene.measure_line([(5, 20), (35, 20)], terrain)


@pytest.mark.filterwarnings("ignore:a relief of")
def test_degree_grids_are_measured_along_geodesics(scene, tmp_path):
    z = np.full((91, 181), 1000.0, np.float32)
    path = write_moon(tmp_path / "degrees.tif", "+proj=longlat", (-90.5, 1, 0, 90.5, 0, -1), z)
    moon = scene.add_terrain(path, name="moon", mode="clipmap", on_body=True)
    places = np.array([(-45.0, 60.0), (45.0, 60.0)])
    line = scene.measure_line(places, moon, samples=201)
    a, b = sphere(places)
    assert line.distance == pytest.approx(MOON * np.arccos(a @ b), rel=1e-9)
    assert line.profile.height == pytest.approx(1000, abs=1e-3)
    # The great circle's highest latitude, and the arc 1,000 m higher; a chord of 1/200 of the arc is shorter by its sagitta.
    assert line.profile.map[100, :2] == pytest.approx([0, np.degrees(np.arctan(np.tan(np.pi / 3) / np.cos(np.pi / 4)))], abs=1e-6)
    assert line.ground_length == pytest.approx((MOON + 1000) * np.arccos(a @ b), rel=1e-5)
    assert line.azimuth_deg[0] == pytest.approx(np.degrees(np.arctan2(1, np.sin(np.pi / 3))), abs=1e-9)
    # Girard: the triangle's excess over 180 degrees.
    corners = np.array([(-30.0, 0.0), (40.0, 10.0), (0.0, 70.0)])
    p = sphere(corners)

    def corner(i):
        out = [np.cross(p[i], p[j]) for j in ((i + 1) % 3, (i + 2) % 3)]
        return np.arccos(out[0] @ out[1] / np.linalg.norm(out[0]) / np.linalg.norm(out[1]))
    area = scene.measure_area(corners, moon)
    assert area.area == pytest.approx(MOON ** 2 * (sum(map(corner, range(3))) - np.pi), rel=1e-9)
    assert area.surface_area == pytest.approx(area.area, rel=1e-3) and area.mean_height == pytest.approx(1000, abs=1e-3)


def test_projected_maps_are_measured_on_the_ellipsoid(scene, tmp_path):
    z = np.zeros((80, 80), np.float32)
    path = write_moon(tmp_path / "pole.tif", "+proj=stere +lat_0=-90", (-400e3, 10e3, 0, 400e3, 0, -10e3), z)
    pole = scene.add_terrain(path, name="pole", mode="clipmap")
    line = scene.measure_line([(0, 0), (0, 300e3)], pole)
    # rho = 2 R tan(c / 2) of the colatitude c (Snyder 1987, 21-33): the meridian's arc is R c.
    assert line.distance == pytest.approx(2 * MOON * np.arctan(300e3 / (2 * MOON)), rel=1e-9)
    # A circle of 100 corners about the pole: a cap, less the sagittas of great circles.
    angle = np.linspace(0, 2 * np.pi, 720, endpoint=False)
    area = scene.measure_area(300e3 * np.column_stack((np.cos(angle), np.sin(angle))), pole)
    c = 2 * np.arctan(300e3 / (2 * MOON))
    assert area.area == pytest.approx(2 * np.pi * MOON ** 2 * (1 - np.cos(c)), rel=5e-5)


@pytest.mark.parametrize("on_body", (False, True), ids=("plane", "body"))
def test_means_over_a_polar_map_are_those_of_the_sphere(scene, tmp_path, on_body):
    """A cap of 44 degrees whose height is the distance from the pole in the map: the mean over the sphere, not over the map."""
    step, side = 20e3, 160
    at = (np.arange(side) - 0.5 * (side - 1)) * step
    rho = np.hypot(at[None, :], at[:, None])
    path = write_moon(tmp_path / "cap.tif", "+proj=stere +lat_0=90", (at[0] - 0.5 * step, step, 0, -at[0] + 0.5 * step, 0, -step),
                      (rho * 1e-3).astype(np.float32))
    cap = scene.add_terrain(path, name="cap", mode="clipmap", on_body=on_body)
    edge = 2 * MOON * np.tan(np.radians(44) / 2)
    angle = np.linspace(0, 2 * np.pi, 720, endpoint=False)
    found = scene.measure_area(edge * np.column_stack((np.cos(angle), np.sin(angle))), cap)
    c = np.linspace(0, np.radians(44), 200001)
    weight = np.sin(c)
    expected = np.trapz(weight * 2e-3 * MOON * np.tan(c / 2), c) / np.trapz(weight, c)
    assert found.mean_height == pytest.approx(expected, rel=2e-3)


def test_a_profile_has_the_pixels_of_a_real_raster(scene):
    path = real("mars_gale_mola_128ppd_m.tif")
    data = gdal.Open(str(path))
    left, step_x, _, top, _, step_y = data.GetGeoTransform()
    column, first, last = data.RasterXSize // 2, 10, 60
    pixels = data.ReadAsArray(column, first, 1, last - first + 1)[:, 0].astype(float)
    terrain = scene.add_terrain(path, mode="clipmap", on_body=True)
    x = left + (column + 0.5) * step_x  # a meridian is a geodesic, and its arcs of latitude are nearly even
    line = scene.measure_line([(x, top + (row + 0.5) * step_y) for row in range(first, last + 1)], terrain, samples=5001)
    ends = np.searchsorted(line.profile.distance, np.concatenate(([0], np.cumsum(line.distances))) - 1e-3)
    assert line.profile.height[ends] == pytest.approx(pixels, abs=1e-2)
    assert line.rises == pytest.approx(np.diff(pixels), abs=2e-2)
    assert line.climb == pytest.approx(np.maximum(np.diff(pixels), 0).sum(), rel=0.02)


@pytest.mark.parametrize("call, message", [
    (lambda s, t: s.measure_line([(0, 0, 0)]), r"measured line: the points have the shape \(1, 3\); accepted: an array \(n, 3\)"),
    (lambda s, t: s.measure_line([(0, 0), (1, 1)]), r"the shape \(2, 2\); accepted: an array \(n, 3\) \[m\], n of 2"),
    (lambda s, t: s.measure_line([(0, 0, 0), (0, 0, 0), (1, 0, 0)]), "points 0 and 1 are at one place"),
    (lambda s, t: s.measure_line([(10, 20, 0), (10, 20, 5)], t), "points 0 and 1 are at one place"),
    (lambda s, t: s.measure_line([(0, 0, 0), (np.nan, 0, 0)]), "point 1 is"),
    (lambda s, t: s.measure_line([(10, 20), (20, 20)], t, samples=1), "samples is 1; accepted: 2 to 1000000"),
    (lambda s, t: s.measure_area([(0, 0, 0), (1, 0, 0)]), "n of 3 to 10000"),
    (lambda s, t: s.measure_area([(0, 0, 0), (1, 1, 1), (2, 2, 2)]), "the corners lie on one line"),
    (lambda s, t: s.measure_area([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0.1)]), "the corners lie in no plane"),
    (lambda s, t: s.measure_area([(10, 10), (20, 20), (20, 10), (10, 20)], t), "the edges after points 0 and 2 cross|no area"),
    (lambda s, t: s.measure_area([(0, 0, 0), (3, 3, 0), (3, 0, 0), (0, 4, 0)]), "the edges after points 0 and 2 cross"),
    (lambda s, t: s.measure_angle((0, 0, 0), (0, 0, 0), (1, 0, 0)), "b and a are at one place")])
def test_what_cannot_be_measured_is_rejected(scene, ramp, call, message):
    with pytest.raises(dspace.InvalidArgument, match=message):
        call(scene, ramp)


def test_wrong_types_and_unknown_terrains_are_rejected(scene, ramp):
    with pytest.raises(dspace.WrongType, match="accepted: a Terrain, or the name of one"):
        scene.measure_line([(0, 0, 0), (1, 0, 0)], 7)
    with pytest.raises(dspace.NotFound, match="'nowhere'"):
        scene.measure_line([(0, 0, 0), (1, 0, 0)], "nowhere")
