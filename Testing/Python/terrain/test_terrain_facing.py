"""False colour by aspect and by normal, against what queries answer at the pixels."""
import numpy as np
import pytest

import dspace
from terrain_support import gdal, points_of, write_raster

RADIUS = 1e6


def degrees_between(a, b):
    return np.abs((a - b + 180) % 360 - 180)


def shown_aspects(image):
    """Of a ramp from black to white over 0 to 360: a byte is 1.4 degrees."""
    return image[..., 0].astype(float) * 360 / 255


@pytest.fixture
def hills(scene, tmp_path):
    x, y = np.meshgrid(np.arange(300.0), np.arange(300.0))
    z = 12 * np.sin(x / 21) * np.cos(y / 27) + 5 * np.cos((x + 2 * y) / 40)
    ground = scene.add_terrain(write_raster(tmp_path / "hills.tif", z.astype(np.float32), pixel=2.0),
                               mode="clipmap", color="red", lit=False)
    scene.add_camera(eye=(0, 0, 300), target=(0, 0, 0), up=(0, 1, 0), height=200)
    view = scene.add_viewport(size=(100, 100), samples=1)
    x, y = np.meshgrid(2 * (np.arange(100) + 0.5) - 100, 100 - 2 * (np.arange(100) + 0.5))
    return ground, view, x, y


@pytest.mark.parametrize("azimuth", [3, 45, 90, 135, 180, 250, 270, 357])
def test_slopes_to_all_sides(scene, tmp_path, azimuth):
    """Ground that falls towards an azimuth, by hand."""
    x, y = np.meshgrid(np.arange(64.0), -np.arange(64.0))
    toward = np.radians(azimuth)
    z = -0.3 * (x * np.sin(toward) + y * np.cos(toward))
    ground = scene.add_terrain(write_raster(tmp_path / "tilted.tif", z.astype(np.float32)), mode="clipmap",
                               lit=False)
    scene.add_camera(eye=(0, 0, 200), target=(0, 0, 0), up=(0, 1, 0), height=20)
    view = scene.add_viewport(size=(20, 20), samples=1)
    ground.set_style(color_by="aspect", colors=["black", "white"])
    assert degrees_between(shown_aspects(view.image()), azimuth).max() < 1.0  # half a byte: 0.7
    ground.set_style(color_by="normal")
    n = np.array([0.3 * np.sin(toward), 0.3 * np.cos(toward), 1]) / np.hypot(0.3, 1)
    np.testing.assert_allclose(view.image(), np.broadcast_to(255 * (0.5 + 0.5 * n), (20, 20, 3)), atol=0.8)


def test_hills_show_their_aspects_and_normals(hills):
    ground, view, x, y = hills
    # Queries are of the triangles, pictures interpolate between the posts' normals, which bend by
    # up to 0.03 from post to post here.
    ground.set_style(color_by="normal")
    normal = ground.normal(x, y)
    assert np.abs(view.image() / 255.0 - (0.5 + 0.5 * normal)).max() < 0.02
    ground.set_style(color_by="aspect", colors=["black", "white"])
    aspect, steep = ground.aspect_deg(x, y), ground.slope_deg(x, y) > 6
    error = degrees_between(shown_aspects(view.image()), aspect)
    assert steep.mean() > 0.7 and error[steep].max() < 12 and error[steep].mean() < 2


def test_by_default_aspects_go_around_a_circle_of_colours(hills):
    ground, view, x, y = hills
    ground.set_style(color_by="aspect")
    # North blue, east green, south yellow, west red.
    circle = 255 * np.array([(0.23, 0.40, 0.85), (0.25, 0.65, 0.40), (0.95, 0.85, 0.30), (0.80, 0.28, 0.30)])
    aspect, steep, image = ground.aspect_deg(x, y), ground.slope_deg(x, y) > 6, view.image().astype(float)
    for k, color in enumerate(circle):
        there = steep & (degrees_between(aspect, 90 * k) < 4)
        assert there.sum() > 20
        assert np.abs(image[there] - color).max() < 40  # neighbours on the circle are 100 and more apart
    # No seam where 360 becomes 0.
    north = steep & (degrees_between(aspect, 0) < 8)
    assert np.abs(image[north] - circle[0]).max() < 50


def test_level_ground_has_no_aspect(scene, tmp_path):
    ground = scene.add_terrain(write_raster(tmp_path / "level.tif", np.full((64, 64), 7, np.float32)),
                               mode="clipmap", color="red", lit=False)
    scene.add_camera(eye=(0, 0, 200), target=(0, 0, 0), up=(0, 1, 0), height=20)
    view = scene.add_viewport(size=(20, 20), samples=1)
    plain = view.image()
    ground.set_style(color_by="aspect")
    np.testing.assert_array_equal(view.image(), plain)
    ground.set_style(color_by="normal")
    np.testing.assert_allclose(view.image(), np.broadcast_to((127.5, 127.5, 255), (20, 20, 3)), atol=0.6)


@pytest.fixture
def globe(scene, tmp_path):
    """Long waves on a sphere, over the poles too."""
    longitude, latitude = np.meshgrid(np.radians(np.arange(0.25, 360, 0.5)), np.radians(90 - np.arange(0.25, 180, 0.5)))
    x, y, z = (np.cos(latitude) * np.cos(longitude), np.cos(latitude) * np.sin(longitude), np.sin(latitude))
    height = 20000 * np.sin(5 * x + 1) * np.cos(4 * y) + 15000 * np.sin(6 * z + x)
    data = gdal.GetDriverByName("GTiff").Create(str(tmp_path / "globe.tif"), 720, 360, 1, gdal.GDT_Float32)
    data.SetGeoTransform((0, 0.5, 0, 90, 0, -0.5))
    data.SetProjection(f'GEOGCS["ball",DATUM["ball",SPHEROID["ball",{RADIUS},0]],PRIMEM["zero",0],'
                       'UNIT["degree",0.0174532925199433]]')
    data.GetRasterBand(1).SetUnitType("m")
    data.GetRasterBand(1).WriteArray(height)
    data = None
    return scene.add_terrain(tmp_path / "globe.tif", on_body=True, vertical_datum=f"sphere:{RADIUS}", lit=False)


@pytest.mark.parametrize("toward", [(1, 0.3, 0.2), (-1, 0, 0.1), (0.2, 0.3, 1), (0.1, -0.2, -1), (0.02, -0.01, 1)],
                         ids=["equator", "date line", "north", "south", "the pole itself"])
def test_a_body_shows_aspects_and_normals_of_each_place(scene, globe, toward):
    eye = 1.5e6 * np.array(toward) / np.linalg.norm(toward)
    scene.add_camera("orbit", eye=eye, target=(0, 0, 0), fov_deg=40, near=1e3, far=1e8)
    view = scene.add_viewport((80, 80), "orbit", samples=1)
    points, _ = points_of(view.depth(), eye, (0, 0, 0), 40)
    up = points / np.linalg.norm(points, axis=-1)[..., None]
    east = np.cross((0, 0, 1), up)
    east /= np.linalg.norm(east, axis=-1)[..., None]
    normal = globe.normal(*np.moveaxis(points, -1, 0))
    local = np.stack([(normal * axis).sum(-1) for axis in (east, np.cross(up, east), up)], -1)
    globe.set_style(color_by="normal")
    # A pixel is up to 20 km of ground at the picture's edge, and far levels' posts are 9 to 18 km
    # apart; the ground bends by 0.1 in 100 km.
    from_pole = np.degrees(np.arccos(np.abs(up[..., 2])))
    there = from_pole > 1.5
    error = np.abs(view.image() / 255.0 - (0.5 + 0.5 * local))[there]
    assert error.max() < 0.03 and error.mean() < 0.006
    globe.set_style(color_by="aspect", colors=["black", "white"])
    aspect = globe.aspect_deg(*np.moveaxis(points, -1, 0))
    steep = there & (globe.slope_deg(*np.moveaxis(points, -1, 0)) > 2)
    error = degrees_between(shown_aspects(view.image()), aspect)[steep]
    assert steep.mean() > 0.5 and error.mean() < 3 and np.quantile(error, 0.99) < 15


@pytest.mark.parametrize("style, told", [(dict(color_by="normal", range=(0, 1)), "no range"),
                                         (dict(color_by="normal", colors=["red"]), "no colours"),
                                         (dict(color_by="azimuth"), "'aspect', 'normal'")])
def test_what_a_style_by_normal_has_not_is_refused(hills, style, told):
    with pytest.raises(dspace.Error, match=told):
        hills[0].set_style(**style)
