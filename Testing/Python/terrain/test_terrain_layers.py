"""Colour layers through Python: closed-form colours where the map puts them, their mixing and order,
and refusals. Ground is unlit, so that a picture shows a layer's own bytes."""
import json

import numpy as np
import pytest

import dspace
from terrain_support import FIELD, gdal, write_raster

GROUND = (0.5, 0.25, 0.75)
COLORS = np.array([[(250, 20, 20), (20, 240, 30), (30, 40, 230), (240, 230, 10)],
                   [(0, 0, 0), (255, 255, 255), (128, 128, 128), (70, 10, 130)],
                   [(10, 200, 210), (200, 100, 0), (90, 60, 30), (1, 2, 3)]], np.uint8)
SIZE, PIXEL = 100, 2.0  # of pictures; metres


def linear(srgb):
    """IEC 61966-2-1."""
    srgb = np.asarray(srgb, float)
    return np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)


def encoded(light):
    light = np.asarray(light, float)
    return np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)


def over(*layers):
    """Bottom first: (sRGB 0 to 255, opacity); mixed in linear light."""
    light = linear(GROUND)
    for color, opacity in layers:
        light = (1 - opacity) * light + opacity * linear(np.asarray(color) / 255)
    return 255 * encoded(light)


def write(path, bands, transform, wkt="", nodata=None, type=gdal.GDT_Byte, **more):
    """bands (n, rows, columns)."""
    bands = np.asarray(bands)
    data = gdal.GetDriverByName("GTiff").Create(str(path), bands.shape[2], bands.shape[1], len(bands), type)
    data.SetGeoTransform(transform)
    data.SetProjection(wkt)
    for i, values in enumerate(bands):
        band = data.GetRasterBand(i + 1)
        band.WriteArray(values)
        if nodata is not None:
            band.SetNoDataValue(nodata)
        if more:
            band.SetScale(more["scale"])
            band.SetOffset(more["offset"])
            band.SetUnitType(more["unit"])
    return path


def blocks(colors, side):
    """(3, rows, columns): each colour `side` pixels wide and high."""
    return np.moveaxis(colors.repeat(side, axis=0).repeat(side, axis=1), -1, 0)


@pytest.fixture
def ground(scene, tmp_path):
    """Level ground of 512 m a side, map (0, 0) to (512, 512), and a view of 200 m about its middle."""
    terrain = scene.add_terrain(write_raster(tmp_path / "ground.tif", np.zeros((256, 256), np.float32), 2.0),
                                mode="clipmap", color=GROUND, lit=False)
    look_at(scene, 0)
    return terrain, scene.add_viewport(size=(SIZE, SIZE), samples=1)


def look_at(scene, y):
    scene.add_camera("above", eye=(0, y, 500), target=(0, y, 0), up=(0, 1, 0), height=SIZE * PIXEL)


def map_of_pixels():
    """Map x, y of the middles of the picture's pixels, by the camera alone."""
    offset = PIXEL * (np.arange(SIZE) + 0.5 - SIZE / 2)
    return 256 + np.broadcast_to(offset, (SIZE, SIZE)), 256 - np.broadcast_to(offset[:, None], (SIZE, SIZE))


# An image of 3 x 4 blocks of 40 m, in pixels of 1 m, that covers a part of the picture.
LEFT, TOP, BLOCK = 171.0, 326.0, 40


@pytest.fixture
def image(tmp_path):
    return write(tmp_path / "blocks.tif", blocks(COLORS, BLOCK), (LEFT, 1, 0, TOP, 0, -1))


def expected_blocks(beside=255 * np.array(GROUND), colors=COLORS):
    """The picture of `image` on the ground, and where it is not told: a pixel and a half from borders."""
    x, y = map_of_pixels()
    column, row = (x - LEFT) / BLOCK, (TOP - y) / BLOCK
    rows, columns = colors.shape[:2]
    inside = (column >= 0) & (column < columns) & (row >= 0) & (row < rows)
    picture = np.where(inside[..., None], colors[np.clip(row.astype(int), 0, rows - 1),
                                                 np.clip(column.astype(int), 0, columns - 1)], beside)
    near = np.minimum(np.abs(column - np.round(column)), np.abs(row - np.round(row))) * BLOCK < 1.5 * PIXEL
    return picture, ~near


def assert_shows(picture, expected, told, atol=2):
    difference = np.abs(picture.astype(float) - expected).max(axis=-1)
    assert told.mean() > 0.5
    assert difference[told].max() <= atol, (difference[told].max(), np.argwhere(told & (difference > atol))[:5])


def test_an_image_is_where_the_map_says(ground, image):
    terrain, view = ground
    layer = terrain.add_image(image)
    assert (layer.name, layer.kind, layer.path, layer.opacity, layer.visible, layer.position) == \
        ("image", "image", str(image), 1.0, True, 0)
    assert layer.range is layer.colors is layer.unit is None
    assert layer.pixel_size == pytest.approx(1.0)
    assert_shows(view.image(), *expected_blocks())
    assert [each.name for each in terrain.layers] == ["image"]
    tiles = terrain.layer_tiles
    assert tiles["bytes"] > 0 and tiles["reads"] > 0 and tiles["failures"] == 0 and tiles["last_failure"] == ""


def test_no_data_and_an_images_own_opacity_let_through(ground, tmp_path):
    terrain, view = ground
    alpha = np.array([[0, 64, 128, 255]] * 3, np.uint8)
    rgba = np.concatenate((blocks(COLORS, BLOCK), blocks(alpha[..., None], BLOCK)))
    terrain.add_image(write(tmp_path / "rgba.tif", rgba, (LEFT, 1, 0, TOP, 0, -1)), name="own")
    colors = np.array([[over((COLORS[r, c], alpha[r, c] / 255)) for c in range(4)] for r in range(3)])
    assert_shows(view.image(), *expected_blocks(colors=colors))
    terrain.layer("own").remove()
    grey = np.where(np.arange(160) < 80, 7, 200).astype(np.uint8)[None, None].repeat(120, axis=1)
    terrain.add_image(write(tmp_path / "grey.tif", grey, (LEFT, 1, 0, TOP, 0, -1), nodata=7))
    colors = np.array([[255 * np.array(GROUND)] * 2 + [(200, 200, 200)] * 2] * 3)
    assert_shows(view.image(), *expected_blocks(colors=colors))


def test_opacities_mix_in_linear_light(ground, image, tmp_path):
    terrain, view = ground
    low = terrain.add_image(image, name="low", opacity=0.6)
    white = write(tmp_path / "white.tif", np.full((3, 4, 4), 255, np.uint8), (0, 128, 0, 512, 0, -128))
    high = terrain.add_image(white, name="high", opacity=0.25)

    def mixed(a, b):
        colors = np.array([[over((c, a), ((255,) * 3, b)) for c in row] for row in COLORS])
        return expected_blocks(over(((255,) * 3, b)), colors)

    assert_shows(view.image(), *mixed(0.6, 0.25))
    low.opacity, high.opacity = 0.1, 0.8
    assert (low.opacity, high.opacity) == (0.1, 0.8)
    assert_shows(view.image(), *mixed(0.1, 0.8))


def test_order_visibility_and_removal(ground, image, tmp_path):
    terrain, view = ground
    bare = view.image()
    first = terrain.add_image(image, name="first")
    with_first = view.image()
    assert (with_first != bare).any()
    second = terrain.add_noise(wavelength=50, contrast=0.5, seed=3, visible=False, name="second")
    np.testing.assert_array_equal(view.image(), with_first)
    second.visible = True
    noisy = view.image()
    assert (noisy != with_first).any()
    below = terrain.add_image(write(tmp_path / "white.tif", np.full((3, 4, 4), 255, np.uint8),
                                    (0, 128, 0, 512, 0, -128)), name="below", position=0)
    assert [layer.name for layer in terrain.layers] == ["below", "first", "second"]
    second.visible = False
    assert_shows(view.image(), *expected_blocks((255, 255, 255)))
    below.position = 2
    assert [layer.name for layer in terrain.layers] == ["first", "second", "below"] and below.position == 2
    np.testing.assert_allclose(view.image(), 255, atol=2)
    below.opacity = 0
    np.testing.assert_array_equal(view.image(), with_first)
    below.remove()
    second.visible = True
    np.testing.assert_array_equal(view.image(), noisy)
    second.remove()
    first.visible = False
    np.testing.assert_array_equal(view.image(), bare)
    first.remove()
    np.testing.assert_array_equal(view.image(), bare)
    assert terrain.layers == []
    with pytest.raises(dspace.NotFound, match="it was removed"):
        first.opacity
    assert "removed" in repr(first)


def test_false_colour_is_linear_between_its_colours(ground, tmp_path):
    terrain, view = ground
    values = np.broadcast_to(np.arange(256.0), (256, 256)).copy()  # 2 m a pixel over all of the ground
    values[:64] = -999
    path = write(tmp_path / "values.tif", values[None], (0, 2, 0, 512, 0, -2), nodata=-999,
                 type=gdal.GDT_Float32, scale=0.5, offset=10.0, unit="mK")
    whole = terrain.add_false_color(path)
    assert whole.name == "false color" and whole.kind == "false_color" and whole.unit == "mK"
    assert whole.range == pytest.approx((10, 137.5)) and len(whole.colors) >= 3
    whole.remove()
    low, high = 60.0, 90.0
    ramp = np.array([(0.1, 0.2, 0.9), (0.9, 0.8, 0.1), (0.9, 0.1, 0.1)])
    layer = terrain.add_false_color(path, colors=[tuple(c) for c in ramp], low=low, high=high)
    np.testing.assert_allclose(layer.colors, ramp)
    assert layer.range == (low, high)
    x, y = map_of_pixels()
    value = 10 + 0.5 * (x / 2 - 0.5)
    at = np.clip((value - low) / (high - low), 0, 1) * 2
    expected = 255 * np.stack([np.interp(at, (0, 1, 2), ramp[:, k]) for k in range(3)], axis=-1)
    # A texel and a half from where a ramp has a corner, which bilinear texels round off.
    corner = np.min([np.abs(value - v) for v in (low, 0.5 * (low + high), high)], axis=0) < 1.5
    assert_shows(view.image(), expected, ~corner)
    # Where there is no data the ground shows.
    look_at(terrain._scene, 150)  # map y 306 to 506
    picture = view.image()[:50].reshape(-1, 3)
    np.testing.assert_allclose(picture, np.broadcast_to(255 * np.array(GROUND), picture.shape), atol=1)


def test_shapes_lie_on_the_map(ground, tmp_path):
    terrain, view = ground
    hole = [[200, 210], [240, 210], [240, 250], [200, 250], [200, 210]]
    features = [("Polygon", [[[180, 190], [300, 190], [300, 300], [180, 300], [180, 190]], hole], {}),
                ("LineString", [[170, 320], [340, 320]], {"stroke": "#0000ff"}),
                ("Point", [320, 200], {"marker-color": "#00ff00"})]
    path = tmp_path / "shapes.geojson"
    path.write_text(json.dumps({"type": "FeatureCollection", "features": [
        {"type": "Feature", "properties": more, "geometry": {"type": kind, "coordinates": at}}
        for kind, at, more in features]}))
    layer = terrain.add_shapes(path, line="red", fill=(0, 1, 1, 0.5), width=8, point=2)
    assert (layer.name, layer.kind, layer.path) == ("shapes", "shapes", str(path))
    x, y = map_of_pixels()

    def from_box(x0, x1, y0, y1):  # metres inside, negative: outside
        return np.minimum.reduce([x - x0, x1 - x, y - y0, y1 - y])

    outer, inner = from_box(180, 300, 190, 300), from_box(200, 240, 210, 250)
    expected = np.broadcast_to(255 * np.array(GROUND), x.shape + (3,)).copy()
    expected[(outer > 0) & (inner < 0)] = over(((0, 255, 255), 0.5))
    edge = np.minimum(np.abs(outer), np.abs(inner))
    expected[edge < 4] = (255, 0, 0)
    line = np.where((x > 170) & (x < 340), np.abs(y - 320), np.hypot(np.maximum(170 - x, x - 340), y - 320))
    expected[line < 4] = (0, 0, 255)
    point = np.hypot(x - 320, y - 200)
    expected[point < 8] = (0, 255, 0)
    told = (np.abs(edge - 4) > 3) & (np.abs(line - 4) > 3) & (np.abs(point - 8) > 3) & (line > -1)
    corner = (np.abs(outer) < 12) & (from_box(192, 288, 190, 300) < 0) & (from_box(180, 300, 202, 288) < 0)
    assert_shows(view.image(), expected, told & ~corner)  # how corners are joined is not stated


def test_noise_is_the_same_for_the_same_seed(ground):
    terrain, view = ground
    bare = view.image()
    noise = terrain.add_noise(wavelength=40, octaves=3, gain=0.5, seed=7, contrast=0.6)
    assert (noise.name, noise.kind, noise.path) == ("noise", "noise", "")
    picture = view.image()
    assert noise.pixel_size == pytest.approx(10 / 4)  # of the shortest wavelength
    change = picture.astype(int) - bare
    assert change.min() < -20 and change.max() > 20
    # Its contrast bounds it: black or white of that opacity.
    assert (picture >= over(((0, 0, 0), 0.6)) - 2).all() and (picture <= over(((255,) * 3, 0.6)) + 2).all()
    noise.remove()
    terrain.add_noise(wavelength=40, octaves=3, gain=0.5, seed=7, contrast=0.6)
    np.testing.assert_array_equal(view.image(), picture)
    terrain.layer("noise").remove()
    terrain.add_noise(wavelength=40, octaves=3, gain=0.5, seed=8, contrast=0.6)
    assert (view.image() != picture).mean() > 0.5


def test_what_is_refused_changes_nothing(ground, image, tmp_path):
    terrain, view = ground
    terrain.add_image(image, name="one", opacity=0.5)
    (tmp_path / "text.tif").write_text("this is no raster")
    (tmp_path / "empty.geojson").write_text('{"type": "FeatureCollection", "features": []}')
    mars = 'GEOGCS["Mars",DATUM["Mars",SPHEROID["Mars",3396190,0]],PRIMEM["R",0],UNIT["degree",0.0174532925199433]]'
    moon = mars.replace("Mars", "Moon").replace("3396190", "1737400")
    flat = write(tmp_path / "flat.tif", np.zeros((1, 64, 64)), (0, 0.1, 0, 0, 0, -0.1), moon)
    other = write(tmp_path / "mars.tif", np.zeros((3, 8, 8)), (0, 0.1, 0, 0, 0, -0.1), mars)
    far = write(tmp_path / "far.tif", np.zeros((3, 8, 8)), (9e5, 1, 0, 9e5, 0, -1))
    five = write(tmp_path / "five.tif", np.zeros((5, 8, 8)), (0, 1, 0, 99, 0, -1))
    on_moon = terrain._scene.add_terrain(flat, name="moon", mode="clipmap")
    before = view.image()
    for add, kind, told in (
            (lambda: terrain.add_image("/no/such.png"), dspace.NotFound, "/no/such.png"),
            (lambda: terrain.add_image(tmp_path / "text.tif"), dspace.Error, "text.tif"),
            (lambda: terrain.add_image(image, name="one"), dspace.AlreadyExists, "'one'"),
            (lambda: terrain.add_image(image, name=""), dspace.InvalidArgument, "empty"),
            (lambda: terrain.add_image(image, opacity=1.01), dspace.InvalidArgument, "1.01"),
            (lambda: terrain.add_image(image, opacity=float("nan")), dspace.InvalidArgument, "0 to 1"),
            (lambda: terrain.add_image(image, opacity="half"), dspace.WrongType, "half"),
            (lambda: terrain.add_image(image, position=2), dspace.InvalidArgument, "0 .*1"),
            (lambda: terrain.add_image(image, position=-1), dspace.InvalidArgument, "-1"),
            (lambda: terrain.add_image(image, visible="no"), dspace.WrongType, "True or False"),
            (lambda: terrain.add_image(image, extent=(1, 2, 3)), dspace.WrongType, "left, top, right, bottom"),
            (lambda: terrain.add_image(image, extent=(1, 2, 1, 5)), dspace.InvalidArgument, "extent"),
            (lambda: terrain.add_image(far), dspace.InvalidArgument, "overlap"),
            (lambda: terrain.add_image(five), dspace.Unsupported, "5 bands"),
            (lambda: on_moon.add_image(other), dspace.Unsupported, "Mars"),
            (lambda: terrain.add_false_color(image, band=4), dspace.InvalidArgument, "4"),
            (lambda: terrain.add_false_color(image, band=0), dspace.InvalidArgument, "0"),
            (lambda: terrain.add_false_color(image, low=3, high=3), dspace.InvalidArgument, "3"),
            (lambda: terrain.add_false_color(image, colors=["nocolour"]), dspace.InvalidArgument, "CSS"),
            (lambda: terrain.add_false_color(image, colors=[]), dspace.InvalidArgument, "one colour"),
            (lambda: terrain.add_shapes("/no/such.geojson"), dspace.NotFound, "/no/such.geojson"),
            (lambda: terrain.add_shapes(tmp_path / "empty.geojson"), dspace.InvalidArgument, "empty.geojson"),
            (lambda: terrain.add_shapes(image, line=(1, 2)), dspace.WrongType, "opacity"),
            (lambda: terrain.add_noise(wavelength=0), dspace.InvalidArgument, "wavelength"),
            (lambda: terrain.add_noise(octaves=0), dspace.InvalidArgument, "octaves"),
            (lambda: terrain.add_noise(gain=1.5), dspace.InvalidArgument, "gain"),
            (lambda: terrain.add_noise(contrast=-0.1), dspace.InvalidArgument, "contrast"),
            (lambda: terrain.add_noise(seed=-1), dspace.InvalidArgument, "seed"),
            (lambda: setattr(terrain.layer("one"), "opacity", 2), dspace.InvalidArgument, "2"),
            (lambda: setattr(terrain.layer("one"), "position", 1), dspace.InvalidArgument, "1"),
            (lambda: setattr(terrain.layer("one"), "opaque", 1), AttributeError, "opacity, position, visible"),
            (lambda: terrain.layer("two"), dspace.NotFound, "'one'")):
        with pytest.raises(kind, match=told):
            add()
        assert [(layer.name, layer.opacity) for layer in terrain.layers] == [("one", 0.5)], told
    np.testing.assert_array_equal(view.image(), before)


def test_triangles_take_no_layers_of_colours(scene, image):
    terrain = scene.add_terrain(FIELD, mode="triangles")
    assert terrain.layers == []
    for add in (lambda: terrain.add_image(image), terrain.add_noise):
        with pytest.raises(dspace.Unsupported, match="mode clipmap"):
            add()
