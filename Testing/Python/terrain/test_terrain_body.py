"""Clipmaps on a body through Python: heights against GDAL's, date line and poles, pictures without gaps."""
import numpy as np
import pytest

import dspace
from terrain_support import between_posts, gdal, points_of, real, write_raster

MARS = "mars_mola_megt90n000cb_4ppd_m.tif"
MARS_RADIUS = 3396190.0


@pytest.fixture
def mars(scene):
    return scene.add_terrain(real(MARS), name="mars", on_body=True, vertical_datum="sphere:3396190")


def on_sphere(longitude, latitude, radius):
    longitude, latitude = np.radians(longitude), np.radians(latitude)
    return np.stack((radius * np.cos(latitude) * np.cos(longitude),
                     radius * np.cos(latitude) * np.sin(longitude), radius * np.sin(latitude)), -1)


def test_heights_on_a_body(mars):
    assert mars.on_body and mars.mode == "clipmap"
    random = np.random.default_rng(4)
    longitude, latitude = random.uniform(0.2, 359.8, 10000), random.uniform(-89.8, 89.8, 10000)
    z = gdal.Open(str(real(MARS))).ReadAsArray().astype(float)
    heights = mars.height(longitude, latitude, map=True)
    expected = between_posts(z, longitude * 4 - 0.5, (90 - latitude) * 4 - 0.5)
    np.testing.assert_allclose(heights, expected, rtol=0, atol=2e-3)  # floats of posts
    points = on_sphere(longitude, latitude, MARS_RADIUS + heights)
    np.testing.assert_allclose(mars.from_map(np.column_stack((longitude, latitude, heights))), points,
                               atol=1e-6)
    # Whatever their own height, the points stand above the same places.
    np.testing.assert_allclose(mars.height(*(1.01 * points).T), heights, rtol=0, atol=2e-3)
    back = mars.to_map(points)
    np.testing.assert_allclose(back[:, 2], heights, atol=1e-6)
    np.testing.assert_allclose((back[:, 0] - longitude + 180) % 360, 180, atol=1e-9)
    # The normal leans from the vertical by the slope.
    up = points[:100] / np.linalg.norm(points[:100], axis=1)[:, None]
    normal = mars.normal(longitude[:100], latitude[:100], map=True)
    lean = np.degrees(np.arccos(np.einsum("ni,ni->n", up, normal)))
    np.testing.assert_allclose(lean, mars.slope_deg(longitude[:100], latitude[:100], map=True),
                               atol=1e-6)


def test_a_body_is_closed_at_the_date_line_and_the_poles(mars):
    latitude = np.linspace(-89, 89, 50)
    for longitude in (-0.05, 0.05, 120.0):
        np.testing.assert_array_equal(mars.height(longitude, latitude, map=True),
                                      mars.height(longitude + 360, latitude, map=True))
    west, east = (mars.height(longitude, latitude, map=True) for longitude in (-1e-6, 1e-6))
    assert np.abs(west - east).max() < 0.01  # the seam of this grid
    z = gdal.Open(str(real(MARS))).ReadAsArray().astype(float)
    for pole, row in ((90, z[0]), (-90, z[-1])):
        heights = mars.height(np.arange(0, 360, 30.0), pole, map=True)
        assert np.ptp(heights) == 0 and heights[0] == pytest.approx(row.mean(), abs=1e-3)


@pytest.mark.parametrize("toward, up", [((-1, 0.02, 0.1), (0, 0, 1)), ((1, 0.001, 0), (0, 0, 1)),
                                        ((0, 0.001, 1), (1, 0, 0)), ((0.001, 0, -1), (1, 0, 0))],
                         ids=["date line", "grid's edge", "north pole", "south pole"])
def test_no_background_shows_through_the_disc(scene, mars, toward, up):
    low, high = (MARS_RADIUS + height for height in mars.height_range)
    toward = np.array(toward) / np.linalg.norm(toward)
    scene.add_light("sky", kind="ambient", intensity=0.3)
    for distance, height in ((1e7, 7.2e6), (4e6, 4e5)):  # all of it, and a part near its middle
        scene.add_camera("orbit", eye=distance * toward, target=(0, 0, 0), up=up, height=height,
                         near=1e4, far=2e7)
        view = scene.add_viewport((240, 240), "orbit", samples=1)
        view.set_background((1, 0, 1))
        off_axis = np.hypot(*np.meshgrid(*2 * [(np.arange(240) - 119.5) * height / 240]))
        planes = view.capture(depth=True)
        # Chords of far levels cut the limb by less than a pixel.
        inside, outside = off_axis < low - height / 240, off_axis > high + height / 240
        assert np.isfinite(planes["depth"][inside]).all()
        assert np.isinf(planes["depth"][outside]).all()
        assert not (planes["color"][inside][:, :3] == (255, 0, 255)).all(axis=1).any()
        # The surface is where it belongs.
        radius = np.hypot(off_axis, distance - planes["depth"])[off_axis < 0.7 * low]
        assert low - 500 < radius.min() and radius.max() < high + 500
        view.remove()


@pytest.mark.parametrize("longitude, latitude", [(10, 0.1), (0, 20), (179.99, -50), (275.3, -13.2), (359.99, 55)])
def test_the_ground_near_a_camera_is_what_is_answered(scene, mars, longitude, latitude):
    """To two millimetres, and what OpenGL's grid of 1/256 pixel moves a sloping surface across a ray."""
    ground = mars.height(longitude, latitude, map=True)
    for above in (5, 300):
        eye, below, north = mars.from_map([[longitude, latitude, ground + above], [longitude, latitude, ground],
                                           [longitude, latitude + 0.01, ground]])
        target = below + 0.5 * above * (north - below) / np.linalg.norm(north - below)
        scene.add_camera("eye", eye=tuple(eye), target=tuple(target), fov_deg=60, near=0.5)
        view = scene.add_viewport((160, 120), "eye", samples=1)
        points, pixel = points_of(view.depth(), eye, target, 60)
        view.remove()
        points = points.reshape(-1, 3)
        drawn = mars.to_map(points)[:, 2]  # nothing of the sky is in the picture
        slope = np.radians(mars.slope_deg(longitude, latitude, map=True))
        moved = np.sqrt(2) / 512 * pixel.max() / np.cos(slope)
        np.testing.assert_allclose(drawn, mars.height(*points.T), rtol=0, atol=2e-3 + moved)


def test_heights_above_a_sphere_are_rejected_on_an_ellipsoid(scene, refused, tmp_path):
    degrees = write_raster(tmp_path / "degrees.tif", np.zeros((40, 40), np.float32), pixel=0.1)
    with refused(dspace.Unsupported, "ellipsoid"):
        scene.add_terrain(degrees, on_body=True, crs="EPSG:4326", vertical_datum="sphere:6371000")
    assert scene.add_terrain(degrees, mode="clipmap", crs="EPSG:4326").height(0, 0) == 0


def test_queries_on_a_body_need_the_map_or_space(mars):
    with pytest.raises(dspace.InvalidArgument, match="x, y and z"):
        mars.height(0, 0)
    with pytest.raises(dspace.InvalidArgument):
        mars.height(0, 0, 0, map=True)
