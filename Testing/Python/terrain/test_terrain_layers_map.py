"""Colour layers through Python where maps differ: other projections, whole bodies across the date line
and at the poles, images finer than any texture, and real data."""
import json

import numpy as np
import pytest

import dspace
from needs import needs_module
from terrain_support import gdal, real, write_raster
from test_terrain_layers import write

osr = needs_module("osgeo.osr", "python3-gdal")
osr.UseExceptions()

RADIUS = 3396190.0
DEGREES = osr.SpatialReference()
DEGREES.ImportFromProj4(f"+proj=longlat +R={RADIUS} +no_defs")
LOCAL = osr.SpatialReference()
LOCAL.ImportFromProj4(f"+proj=tmerc +lat_0=18 +lon_0=77 +R={RADIUS} +units=m +no_defs")
for crs in (DEGREES, LOCAL):
    crs.SetAxisMappingStrategy(osr.OAMS_TRADITIONAL_GIS_ORDER)
SIZE = 160  # pixels of pictures
RANDOM = np.random.default_rng(11)
BLOCKS = RANDOM.integers(0, 256, (12, 24, 3), np.uint8)  # of 15 degrees
GROUND = (0.5, 0.5, 0.5)


def degrees_raster(path, bands, west, step, type=gdal.GDT_Byte):
    return write(path, bands, (west, step, 0, 90, 0, -step), DEGREES.ExportToWkt(), type=type)


@pytest.fixture
def body(scene, tmp_path):
    """A smooth sphere, its raster from longitude 0 to 360; 1 pixel a degree."""
    path = degrees_raster(tmp_path / "body.tif", np.ones((1, 180, 360)), 0, 1, gdal.GDT_Float32)
    return scene.add_terrain(path, name="body", on_body=True, vertical_datum=f"sphere:{RADIUS:.0f}",
                             color=GROUND, lit=False)


def view_of(scene, toward, up, height):
    """A picture straight down on a part of the sphere, and longitude and latitude of its pixels."""
    toward = np.asarray(toward, float) / np.linalg.norm(toward)
    scene.add_camera("orbit", eye=tuple(1.5 * RADIUS * toward), target=(0, 0, 0), up=up, height=height,
                     near=1e4, far=2 * RADIUS)
    view = scene.add_viewport((SIZE, SIZE), "orbit", samples=1)
    right = np.cross(up, toward)
    right /= np.linalg.norm(right)
    above = np.cross(toward, right)
    offset = height / SIZE * (np.arange(SIZE) + 0.5 - SIZE / 2)
    u, v = offset[None, :, None], -offset[:, None, None]
    place = u * right + v * above + np.sqrt(RADIUS**2 - u**2 - v**2) * toward
    longitude = np.degrees(np.arctan2(place[..., 1], place[..., 0]))
    latitude = np.degrees(np.arcsin(place[..., 2] / RADIUS))
    return view.image(), longitude, latitude


def blocks_at(longitude, latitude, margin):
    """Colours of BLOCKS there, and where they are told: `margin` degrees on the ground from borders."""
    column, row = ((longitude + 180) % 360) / 15, (90 - latitude) / 15
    across = np.abs(column - np.round(column)) * 15 * np.cos(np.radians(latitude))
    told = np.minimum(across, np.abs(row - np.round(row)) * 15) > margin
    return BLOCKS[np.minimum(row.astype(int), 11), column.astype(int) % 24], told


@pytest.mark.parametrize("toward, up", [((-1, 0.1, 0.1), (0, 0, 1)), ((1, 0.05, 0.1), (0, 0, 1)),
                                        ((0.02, 0.01, 1), (1, 0, 0)), ((0.02, 0.01, -1), (1, 0, 0))],
                         ids=["date line", "grid's edge", "north pole", "south pole"])
@pytest.mark.parametrize("west", [-180, 0])
def test_an_image_goes_around_a_body(scene, body, tmp_path, toward, up, west):
    image = np.moveaxis(np.roll(BLOCKS, 0 if west else 12, axis=1).repeat(60, axis=0).repeat(60, axis=1), -1, 0)
    body.add_image(degrees_raster(tmp_path / "around.tif", image, west, 0.25))
    picture, longitude, latitude = view_of(scene, toward, up, 0.7 * RADIUS)
    expected, told = blocks_at(longitude, latitude, 0.8)  # a pixel is 0.25 degrees or more
    assert told.mean() > 0.4
    difference = np.abs(picture.astype(float) - expected).max(axis=-1)
    assert difference[told].max() <= 2, np.argwhere(told & (difference > 2))[:5]


def test_shapes_cross_the_date_line_and_contain_a_pole(scene, body, tmp_path):
    cap = [[lon, 75] for lon in range(-180, 180, 5)] + [[180, 75], [180, 90], [-180, 90], [-180, 75]]
    path = tmp_path / "shapes.geojson"
    path.write_text(json.dumps({"type": "FeatureCollection", "features": [
        {"type": "Feature", "properties": {}, "geometry": {"type": "MultiPolygon", "coordinates": [
            [[[175, -4], [180, -4], [180, 4], [175, 4], [175, -4]]],
            [[[-180, -4], [-175, -4], [-175, 4], [-180, 4], [-180, -4]]]]}},
        {"type": "Feature", "properties": {}, "geometry": {"type": "Polygon", "coordinates": [cap]}}]}))
    body.add_shapes(path, crs=DEGREES.ExportToWkt(), line=None, pixels=0, fill="lime")
    ground = np.array([127.5] * 3)
    for toward, up, height, inside_of in (
            ((-1, 0, 0), (0, 0, 1), 0.3,
             lambda lon, lat: np.minimum(5 - np.abs(180 - lon % 360), 4 - np.abs(lat))),
            ((0.01, 0, 1), (1, 0, 0), 0.7, lambda lon, lat: lat - 75)):
        picture, longitude, latitude = view_of(scene, toward, up, height * RADIUS)
        inside = inside_of(longitude, latitude)
        expected = np.where((inside > 0)[..., None], (0, 255, 0), ground)
        told = np.abs(inside) > 0.8
        assert (inside[told] > 0).mean() > 0.1
        assert np.abs(picture - expected)[told].max() <= 2


def test_shapes_in_degrees_on_a_projected_terrain(scene, tmp_path):
    path = write(tmp_path / "local.tif", np.ones((1, 256, 256)), (-256, 2, 0, 256, 0, -2),
                 LOCAL.ExportToWkt(), type=gdal.GDT_Float32)
    terrain = scene.add_terrain(path, mode="clipmap", color=GROUND, lit=False)
    corners = np.array([(-60, -40), (70, -50), (40, 60), (-50, 30)], float)
    to_degrees = osr.CoordinateTransformation(LOCAL, DEGREES)
    ring = [list(to_degrees.TransformPoint(x, y)[:2]) for x, y in (*corners, corners[0])]
    assert abs(ring[0][0] - 77) < 0.01 and abs(ring[0][1] - 18) < 0.01
    (tmp_path / "field.geojson").write_text(json.dumps(
        {"type": "Feature", "properties": {}, "geometry": {"type": "Polygon", "coordinates": [ring]}}))
    with pytest.warns(dspace.DspaceWarning, match="longitude and latitude"):  # GeoJSON's are the Earth's
        terrain.add_shapes(tmp_path / "field.geojson", line=None, pixels=0, fill="blue")
    scene.add_camera(eye=(0, 0, 500), target=(0, 0, 0), up=(0, 1, 0), height=200)
    picture = scene.add_viewport((SIZE, SIZE), samples=1).image()
    offset = 200 / SIZE * (np.arange(SIZE) + 0.5 - SIZE / 2)
    x, y = np.meshgrid(offset, -offset)
    inside = np.full(x.shape, np.inf)  # metres from its edges; a few metres of a body are a plane
    for (x0, y0), (x1, y1) in zip(corners, np.roll(corners, -1, axis=0)):
        inside = np.minimum(inside, ((x1 - x0) * (y - y0) - (y1 - y0) * (x - x0)) / np.hypot(x1 - x0, y1 - y0))
    expected = np.where((inside > 0)[..., None], (0, 0, 255), (127.5,) * 3)
    told = np.abs(inside) > 2.5
    assert (inside[told] > 0).mean() > 0.2
    assert np.abs(picture - expected)[told].max() <= 2


def test_an_image_in_degrees_on_a_projected_terrain(scene, tmp_path):
    path = write(tmp_path / "local.tif", np.ones((1, 256, 256)), (-2560, 20, 0, 2560, 0, -20),
                 LOCAL.ExportToWkt(), type=gdal.GDT_Float32)
    terrain = scene.add_terrain(path, mode="clipmap", color=GROUND, lit=False)
    # Blocks of 0.005 degrees (296 and 282 m) about the terrain's middle.
    image = np.moveaxis(BLOCKS[:, :12].repeat(40, axis=0).repeat(40, axis=1), -1, 0)
    step = 0.005 / 40
    terrain.add_image(write(tmp_path / "degrees.tif", image, (76.97, step, 0, 18.03, 0, -step),
                            DEGREES.ExportToWkt()))
    scene.add_camera(eye=(0, 0, 3000), target=(0, 0, 0), up=(0, 1, 0), height=1600)
    picture = scene.add_viewport((SIZE, SIZE), samples=1).image()
    offset = 1600 / SIZE * (np.arange(SIZE) + 0.5 - SIZE / 2)
    x, y = np.meshgrid(offset, -offset)
    lon, lat, _ = np.array(osr.CoordinateTransformation(LOCAL, DEGREES).TransformPoints(
        np.stack((x.ravel(), y.ravel()), axis=1).tolist())).T.reshape(3, SIZE, SIZE)
    column, row = (lon - 76.97) / 0.005, (18.03 - lat) / 0.005
    expected = BLOCKS[row.astype(int), column.astype(int)]
    told = np.minimum(np.abs(column - np.round(column)), np.abs(row - np.round(row))) * 280 > 25
    assert told.mean() > 0.5
    assert np.abs(picture.astype(float) - expected)[told].max() <= 2


def test_an_image_is_shown_in_full_resolution(scene, tmp_path):
    """20000 columns, of which every second one is white: any coarser image would be grey."""
    columns = 20000
    stripes = np.tile(np.array([0, 255], np.uint8), columns // 2)[None, None].repeat(16, axis=1)
    image = write(tmp_path / "stripes.tif", stripes, (0, 512 / columns, 0, 512, 0, -512 / 16))
    ground = write_raster(tmp_path / "ground.tif", np.zeros((256, 256), np.float32), 2.0)
    for name, given in (("drape", {"image": image}), ("layer", {"color": (0.2, 0.4, 0.6)})):
        terrain = scene.add_terrain(ground, name=name, mode="clipmap", lit=False, **given)
        if name == "layer":
            terrain.add_image(image)
        assert [layer.name for layer in terrain.layers] == ["drape" if name == "drape" else "image"]
        assert terrain.layers[0].path == str(image) and terrain.layers[0].kind == "image"
        width = 512 / columns  # of a stripe; 16 pixels
        scene.add_camera(name, eye=(0, 0, 5), target=(0, 0, 0), up=(0, 1, 0), height=10 * width)
        view = scene.add_viewport((SIZE, SIZE), name, samples=1)
        picture = view.image()
        x = 256 + width / 16 * (np.arange(SIZE) + 0.5 - SIZE / 2)
        at = x / width
        middle = np.abs(at % 1 - 0.5) < 0.2  # of a stripe: bilinear between their middles
        expected = np.where(at.astype(int) % 2, 255, 0)
        # Texels are no larger than a stripe; where one lies across a border it is grey.
        dark, light = (picture[:, middle & (expected == value)].mean() for value in (0, 255))
        assert dark < 60 and light > 195, (dark, light)
        terrain.remove()


def test_an_image_that_cannot_be_read_is_told_and_drawn_again_without(scene, tmp_path):
    ground = write_raster(tmp_path / "ground.tif", np.zeros((256, 256), np.float32), 2.0)
    terrain = scene.add_terrain(ground, mode="clipmap", lit=False, color=GROUND)
    scene.add_camera(eye=(0, 0, 500), target=(0, 0, 0), up=(0, 1, 0), height=200)
    view = scene.add_viewport((SIZE, SIZE), samples=1)
    bare = view.image()
    path = write(tmp_path / "cut.tif", RANDOM.integers(0, 255, (3, 512, 512), np.uint8), (0, 1, 0, 512, 0, -1))
    path.write_bytes(path.read_bytes()[:400_000])  # its header is whole
    layer = terrain.add_image(path, name="cut")
    with pytest.raises(dspace.Error, match="cut.tif"):
        view.image()
    assert terrain.layer_tiles["failures"] > 0 and "cut.tif" in terrain.layer_tiles["last_failure"]
    layer.visible = False
    np.testing.assert_array_equal(view.image(), bare)


def test_viking_on_mola(scene):
    """The whole of Mars: the picture's colours against GDAL's pixels at the same places."""
    terrain = scene.add_terrain(real("mars_mola_megt90n000cb_4ppd_m.tif"), on_body=True, lit=False,
                                vertical_datum="areoid", vertical_scale=1e-6)  # a sphere: places are exact
    file = real("../textures/mars_viking_mdim21_color_2880.jpg")
    layer = terrain.add_image(file, crs="IAU_2015:49900", extent=(-180, 90, 180, -90))
    assert layer.pixel_size == pytest.approx(np.radians(RADIUS) / 8, rel=0.01)
    pixels = np.moveaxis(gdal.Open(str(file)).ReadAsArray().astype(float), 0, -1)
    for toward, up in (((-1, 0.2, 0.1), (0, 0, 1)), ((0.3, 1, -0.4), (0, 0, 1)), ((0.02, 0.01, 1), (1, 0, 0))):
        picture, longitude, latitude = view_of(scene, toward, up, 0.7 * RADIUS)
        column = ((longitude + 180) % 360 * 8).astype(int) % 2880
        row = np.clip(((90 - latitude) * 8).astype(int), 0, 1439)
        # Means of 10 x 10 pixels: what resampling differs in is all but gone, what is misplaced is not.
        here, there, shifted = (a.reshape(SIZE // 10, 10, SIZE // 10, 10, 3).mean(axis=(1, 3)) for a in (
            picture, pixels[row, column], pixels[np.minimum(row + 8, 1439), column]))
        difference, of_a_degree = np.abs(here - there), np.abs(here - shifted)
        assert difference.max() < 8 and np.median(difference) < 1, (difference.max(), np.median(difference))
        assert np.median(of_a_degree) > 2 * np.median(difference) and of_a_degree.max() > 8
