"""`dspace terrain`: run as a command, its numbers and pictures against GDAL."""
import json
import os
import pathlib
import subprocess
import sys

import numpy as np
import pytest

from needs import needs_module

gdal = needs_module("osgeo.gdal", "python3-gdal")
gdal.UseExceptions()
ROOT = pathlib.Path(__file__).resolve().parents[3]
FIELD = ROOT / "Data/field/field.tif"
DATA = pathlib.Path(os.environ.get("DSPACE_DATA") or "/nonexistent") / "terrain"


def real(name):
    if not (DATA / name).exists():
        pytest.skip(f"real data absent: set DSPACE_DATA to the folder that has terrain/{name}")
    return DATA / name


def run(*arguments):
    return subprocess.run([sys.executable, "-m", "dspace", *map(str, arguments)], capture_output=True,
                          text=True)


def info(*arguments):
    done = run("terrain", "info", "--json", *arguments)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def render(path, *arguments):
    done = run("terrain", "render", *arguments, "--out", path)
    assert done.returncode == 0, done.stderr
    return np.moveaxis(gdal.Open(str(path)).ReadAsArray(), 0, -1), done.stdout


# --- info ------------------------------------------------------------------------------------------

def test_info_of_the_field():
    found, = info(FIELD)
    z = gdal.Open(str(FIELD)).ReadAsArray().astype(float)
    assert (found["driver"], found["columns"], found["rows"], found["type"]) == ("GTiff", 1001, 1001, "Float32")
    assert found["map"]["x"] == pytest.approx([-100.1, 100.1]) == found["map"]["y"]
    assert found["pixel_width"] == pytest.approx(0.2) and found["map_unit"] == "metre"
    assert found["vertical_datum"] == "sphere:1737400" and found["vertical_scale"] == 1
    statistics = found["statistics"]
    assert (statistics["of"], statistics["holes"]) == ("all pixels", 0)
    assert [statistics[key] for key in ("minimum_m", "mean_m", "maximum_m")] == pytest.approx(
        [z.min(), z.mean(), z.max()], abs=1e-9)
    assert found["plane"]["levels"][0] == {"posts": [1001, 1001], "spacing": pytest.approx(0.2)}
    assert found["plane"]["levels"][1]["posts"] == [501, 501]
    assert found["auto_mode"] == "triangles" and found["warnings"] == []
    text = run("terrain", "info", FIELD)
    assert text.returncode == 0 and text.stderr == ""
    for part in (str(FIELD), "1001 x 1001 pixels of Float32", "sphere:1737400", "no holes", "level  1: 501 x 501",
                 "triangles, unless"):
        assert part in text.stdout


def write_raster(path, z, no_data=None, scale=None, overviews=()):
    data = gdal.GetDriverByName("GTiff").Create(str(path), z.shape[1], z.shape[0], 1, gdal.GDT_Int16,
                                                ["TILED=YES", "COMPRESS=DEFLATE"])
    data.SetGeoTransform((100, 2, 0, 500, 0, -2))
    band = data.GetRasterBand(1)
    band.SetUnitType("m")
    if no_data is not None:
        band.SetNoDataValue(no_data)
    if scale is not None:
        band.SetScale(scale[0])
        band.SetOffset(scale[1])
    band.WriteArray(z)
    if overviews:
        data.BuildOverviews("AVERAGE", list(overviews))
    return path


def test_holes_scale_and_offset_are_heeded(tmp_path):
    z = np.arange(60 * 40).reshape(40, 60)
    z[3:5, 10:20] = -999
    found, = info(write_raster(tmp_path / "holes.tif", z, -999, (0.5, -10)))
    statistics = found["statistics"]
    assert statistics["holes"] == 20 and statistics["hole_fraction"] == pytest.approx(20 / 2400)
    seen = z[z != -999] * 0.5 - 10
    assert statistics["mean_m"] == pytest.approx(seen.mean())
    assert statistics["minimum_m"] == seen.min() and statistics["maximum_m"] == seen.max()
    assert found["no_data"] == -999 and found["crs"] is None and found["longitude"] is None
    assert "refused" in found["body"]
    assert not (tmp_path / "holes.tif.aux.xml").exists()
    by_hand, = info(tmp_path / "holes.tif", "--vertical-scale", "2")
    assert by_hand["statistics"]["maximum_m"] == 2 * z.max()
    empty = run("terrain", "info", write_raster(tmp_path / "empty.tif", np.full((30, 30), -999), -999))
    assert empty.returncode == 1 and "without data" in empty.stderr


@pytest.mark.parametrize("overviews", [(), (2, 4, 8)])
def test_statistics_of_large_rasters_are_estimates_and_say_so(tmp_path, overviews):
    x = np.arange(3000)
    z = (1000 * np.sin(x / 300)[None, :] * np.cos(x[:2000] / 200)[:, None]).astype(int)
    path = write_raster(tmp_path / "large.tif", z, overviews=overviews)
    found, = info(path)
    statistics = found["statistics"]
    assert statistics["every"] == 2 and statistics["of"] == "a sample"
    assert statistics["from_overviews"] == bool(overviews)
    assert statistics["mean_m"] == pytest.approx(z.mean(), abs=2)
    assert statistics["maximum_m"] == pytest.approx(z.max(), abs=20)
    assert found["auto_mode"] == "clipmap" and len(found["overviews"]) == len(overviews)
    text = run("terrain", "info", path).stdout
    assert "estimated from one value for 2 x 2 pixels" in text
    assert ("from its overviews" in text) == bool(overviews)


def test_info_of_real_rasters():
    mars, = info(real("mars_mola_megt90n000cb_4ppd_m.tif"))
    assert mars["longitude"] == [0, 360] and mars["latitude"] == [-90, 90]
    assert mars["body"]["closed"] and mars["body"]["subdivisions"] == 7
    assert mars["body"]["levels"][7]["posts"][0] == 1440
    assert (mars["statistics"]["minimum_m"], mars["statistics"]["maximum_m"]) == (-8068, 21134)
    assert len(mars["warnings"]) == 2
    moon, = info(real("moon_lola_global_4ppd_km.tif"), "--vertical-scale", 1000)
    assert moon["statistics"]["maximum_m"] == pytest.approx(10504, abs=1)
    cube, = info(real("moon_lola_ldem4_reduced.cub"))
    assert cube["driver"] == "ISIS3" and abs(cube["statistics"]["mean_m"]) < 2000
    pole, = info(real("moon_npole_stereo_33.tif"))
    assert pole["latitude"][0] == pytest.approx(87.56, abs=0.01) and not pole["body"]["closed"]
    assert pole["body"]["levels"][0]["posts"] == [33, 33]
    everything = info(*sorted(DATA.glob("*.tif")))
    assert [pathlib.Path(found["path"]).suffix for found in everything] == [".tif"] * len(everything)


# --- render ----------------------------------------------------------------------------------------

def told_by_height(picture, z):
    """The share of a picture's variance that heights explain: colours against those of like height."""
    rank = np.searchsorted(np.quantile(z, np.linspace(0, 1, 101)[1:-1]), z.ravel())
    colors = picture.reshape(-1, 3).astype(float)
    means = np.stack([np.bincount(rank, colors[:, k]) / np.bincount(rank) for k in range(3)], -1)
    return 1 - ((colors - means[rank]) ** 2).sum() / ((colors - colors.mean(axis=0)) ** 2).sum()


def test_a_map_shows_every_post_where_it_is(tmp_path):
    """False colour under a sun in the zenith, put together from many pictures, against GDAL's heights."""
    picture, told = render(tmp_path / "map.png", FIELD, "--color-by-height", "--size", "500x500",
                           "--sun", "0,90")
    assert picture.shape == (500, 500, 3) and "a pixel is 0.4 m" in told and "x -100 to 100" in told
    z = gdal.Open(str(FIELD)).ReadAsArray().astype(float)
    # Pixel n shows from 2 n to 2 n + 2 posts.
    z = 0.25 * (z[:-1:2, :-1:2] + z[1::2, :-1:2] + z[:-1:2, 1::2] + z[1::2, 1::2])
    inner = slice(8, -8)
    here = told_by_height(picture[inner, inner], z[inner, inner])
    assert here > 0.97
    for dx, dy in ((2, 0), (-2, 0), (0, 2), (0, -2)):
        there = np.roll(picture, (dy, dx), (0, 1))
        assert told_by_height(there[inner, inner], z[inner, inner]) < here - 0.003


def test_shaded_relief_follows_lamberts_law(tmp_path):
    """A ramp to the east, lit from the west and from the east; the whole of it one shade."""
    path = write_raster(tmp_path / "ramp.tif", np.tile(np.arange(300), (300, 1)))  # rises 1 in 2 m
    shades = {}
    for azimuth in (90, 270):
        picture, _ = render(tmp_path / "r.png", path, "--size", "120x120", "--sun", f"{azimuth},45",
                            "--no-color-by-height")
        picture = picture[4:-4, 4:-4]  # boxes of coarser posts are cut at the raster's edge
        assert np.ptp(picture.reshape(-1, 3).astype(int), axis=0).max() <= 1
        shades[azimuth] = picture.mean()
    assert shades[270] > 1.5 * shades[90]


def test_relief_that_true_light_does_not_show_is_exaggerated(tmp_path):
    """Shades of a roof of 0.1 degrees against Lambert's law for a roof exaggerated by the printed factor."""
    east = np.arange(300)
    roof = np.minimum(east, 299 - east)  # times 4 mm, 2 m a pixel: a slope of 0.002
    path = write_raster(tmp_path / "roof.tif", np.tile(roof, (300, 1)), scale=(0.004, 0.0))
    picture, told = render(tmp_path / "r.png", path, "--size", "120x120", "--sun", "90,45", "--no-color-by-height")
    factor = float(told.split("exaggerated ")[1].split()[0])
    assert factor == pytest.approx(np.tan(np.radians(20)) / 0.002, rel=0.05)
    linear = (np.array([0.72, 0.69, 0.65]) + 0.055) / 1.055
    for columns, rise in ((slice(10, 50), 0.002), (slice(70, 110), -0.002)):
        normal = np.array([-factor * rise, 0, 1])
        light = 1.3 * (0.046 + normal @ (np.sqrt(0.5), 0, np.sqrt(0.5)) / np.linalg.norm(normal))
        expected = 255 * (1.055 * np.clip(linear ** 2.4 * light, 0, 1) ** (1 / 2.4) - 0.055)
        shade = picture[10:110, columns].reshape(-1, 3)
        np.testing.assert_allclose(np.median(shade, axis=0), expected, atol=2)
        assert np.abs(shade - expected).max() < 6  # posts are float32
    flat, told = render(tmp_path / "t.png", path, "--size", "120x120", "--sun", "90,45", "--exaggeration", "1",
                        "--no-color-by-height")
    assert "exaggerated" not in told and abs(flat[60, 20].astype(int) - flat[60, 100]).max() <= 1
    colored, _ = render(tmp_path / "c.png", path, "--size", "120x120")  # a map is coloured by height
    assert np.ptp(colored[60, 5:60].astype(int), axis=1).max() > 40
    _, told = render(tmp_path / "steep.png", FIELD, "--size", "200x200")
    assert "exaggerated" not in told


def test_the_factor_of_relief_has_bounds():
    """Slopes in closed form: ramps of 0.01, ramps with steps, levels with the rounding of depths, a tilted surface."""
    from dspace.command_line import terrain_relief
    up = np.broadcast_to((0.0, 0.0, 1.0), (100, 100, 3))
    ramp = np.tile(0.02 * np.arange(100.0), (100, 1))  # pixels of 2 m
    shown = np.tan(np.radians(20))
    assert terrain_relief.automatic(ramp, up, 2.0) == pytest.approx(shown / 0.01, rel=0.02)
    hole = np.where(np.arange(100) < 30, np.nan, ramp)
    assert terrain_relief.automatic(hole, up, 2.0) == pytest.approx(shown / 0.01, rel=0.02)
    steps = ramp + 4.0 * (np.arange(100) >= 50)  # 2 of 98 columns rise by 1 in 1
    assert terrain_relief.automatic(steps, up, 2.0) == pytest.approx(np.tan(np.radians(60)) / 1.01, rel=0.03)
    assert terrain_relief.automatic(10 * steps, up, 2.0) == 1.0  # light shows such walls
    assert terrain_relief.automatic(10 * ramp, up, 2.0) == 1.0  # and a slope of 0.1
    assert terrain_relief.automatic(1e-4 * ramp, up, 2.0) == 1.0
    assert terrain_relief.automatic(np.full((100, 100), np.nan), up, 2.0) == 1.0
    assert terrain_relief.automatic(ramp[:1], up[:1], 2.0) == pytest.approx(shown / 0.01, rel=0.02)
    # A surface seen at 60 degrees: its rise of 0.01 along itself is one of 0.02 across the picture.
    tilted = np.broadcast_to((np.sin(np.pi / 3), 0.0, 0.5), up.shape)
    assert terrain_relief.automatic(2 * ramp, tilted, 2.0) == pytest.approx(shown / 0.01, rel=0.02)


def test_a_map_reads_no_posts_much_finer_than_its_pixels(tmp_path, monkeypatch):
    """A raster of 6000 x 6000 pixels, its overviews in the file, on 150 x 150 pixels: the finest level alone has 529
    tiles."""
    from dspace.command_line import main, terrain_render
    east, north = np.meshgrid(np.linspace(0, 20, 6000), np.linspace(0, 30, 6000))
    path = write_raster(tmp_path / "large.tif", np.round(900 * np.sin(east) * np.cos(north)).astype(np.int16),
                        overviews=(2, 4, 8, 16, 32))
    loads = []

    class Counted(terrain_render.Ground):
        def __init__(self, *arguments):
            super().__init__(*arguments)
            save = terrain_render.save
            monkeypatch.setattr(terrain_render, "save", lambda *done: (
                loads.extend(terrain._info().tile_loads for terrain in self.terrains), save(*done)))

    monkeypatch.setattr(terrain_render, "Ground", Counted)
    assert main(["terrain", "render", str(path), "--size", "150x150", "--out", str(tmp_path / "map.png")]) == 0
    assert len(loads) == 1 and 0 < loads[0] < 60


def test_a_whole_body_shows_its_relief(tmp_path):
    path = real("mars_mola_megt90n000cb_4ppd_m.tif")
    plain = ("--size", "400x200", "--no-color-by-height")
    picture, told = render(tmp_path / "map.png", path, *plain)
    true, _ = render(tmp_path / "true.png", path, *plain, "--exaggeration", "1")  # one grey
    assert "relief exaggerated" in told and picture[40:160, 150:250, 1].std() > 4 * true[40:160, 150:250, 1].std()
    _, told = render(tmp_path / "disc.png", path, *plain, "--on-body")
    assert "relief exaggerated" in told


def test_a_picture_of_another_shape_has_background_beside(tmp_path):
    picture, told = render(tmp_path / "wide.png", FIELD, "--size", "300x150")
    assert (picture[:, :70] == 255).all() and (picture[:, -70:] == 255).all()
    assert (picture[:, 80:220] < 250).any(axis=2).all()
    assert "x -200 to 200, y -100 to 100" in told


def test_a_turned_raster_has_its_own_pixels(tmp_path):
    """Turned by 30 degrees: posts stay 2 m apart, though the raster's box on the map is wider than its rows are long."""
    z = np.tile(np.arange(128) * 3, (128, 1)).astype(np.int16)
    path = write_raster(tmp_path / "turned.tif", z)
    c, s = 2 * np.cos(np.pi / 6), 2 * np.sin(np.pi / 6)
    data = gdal.Open(str(path), gdal.GA_Update)
    data.SetGeoTransform((100, c, s, 500, s, -c))
    del data
    picture, told = render(tmp_path / "turned.png", path, "--size", "300x300")
    assert "posts of level 0 every 2 m" in told
    assert (picture[:20, :20] == 255).all() and (picture[150, 150] < 250).any()  # the box's corners have no ground


def test_perspective_and_image(tmp_path):
    picture, told = render(tmp_path / "p.jpg", FIELD, "--view", "perspective", "--size", "240x160", "--image",
                           ROOT / "Data/field/field_color.tif")
    assert picture.shape == (160, 240, 3) and "triangles" in told
    assert (picture[:8] == 0).mean() > 0.9 and picture[60:120, 60:180].std() > 3
    found, = info(FIELD)
    longitude, latitude = (sum(found[axis]) / 2 for axis in ("longitude", "latitude"))
    near, told = render(tmp_path / "n.png", FIELD, "--view", "perspective", "--size", "240x160",
                        "--eye", f"{longitude:.9f},{latitude:.9f},3",
                        "--target", f"{longitude:.9f},{latitude + 0.001:.9f},0")
    assert "height 3 m" in told and near[-20:].min() > 0
    away = run("terrain", "render", FIELD, "--out", tmp_path / "a.png", "--view", "perspective", "--size", "60x40", "--eye",
               f"{longitude:.9f},{latitude:.9f},300", "--target", f"{longitude:.9f},{latitude:.9f},900")
    assert "0 triangles" in away.stdout and "no ground is in view" in away.stderr


def test_layers_in_the_order_given(tmp_path):
    """A map of flat ground with a white sun above: colours of the layers are told apart."""
    ground = write_raster(tmp_path / "ground.tif", np.full((64, 64), 5.0), -999)
    g = gdal.Open(str(ground)).GetGeoTransform()

    def image(name, color, columns):
        """Over the left `columns` of the ground."""
        data = gdal.GetDriverByName("GTiff").Create(str(tmp_path / name), columns, 64, 3)
        data.SetGeoTransform(g)
        data.SetProjection(gdal.Open(str(ground)).GetProjection())
        for band, value in enumerate(color):
            data.GetRasterBand(band + 1).WriteArray(np.full((64, columns), value, np.uint8))
        return tmp_path / name

    red, blue = image("red.tif", (255, 0, 0), 48), image("blue.tif", (0, 0, 255), 24)
    x, y = g[0] + g[1] * 36, g[3] + g[5] * 32
    (tmp_path / "point.geojson").write_text(json.dumps({"type": "Feature", "properties": {"marker-color": "#00ff00"},
                                                        "geometry": {"type": "Point", "coordinates": [x, y]}}))
    shown = {}
    for order in ((red, blue), (blue, red)):
        picture, _ = render(tmp_path / "map.png", ground, "--size", "128x128", "--sun", "0,90", "--false-color",
                            f"{red}:1", "--image", order[0], "--image", order[1], "--shapes",
                            tmp_path / "point.geojson")
        # In both a point on the right part of the red one, and beside both the ground.
        assert picture[64, 72].argmax() == 1 and picture[64, 72, 0] < 60
        assert picture[20, 80].argmax() == 0 and picture[20, 80, 2] < 60
        assert np.ptp(picture[64, 115].astype(int)) < 40
        shown[order[1]] = picture[30, 20].argmax()
    assert shown == {red: 0, blue: 2}


def test_the_body_is_a_disc_without_gaps(tmp_path):
    path = real("mars_mola_megt90n000cb_4ppd_m.tif")
    picture, told = render(tmp_path / "mars.png", path, "--on-body", "--size", "300x300", "--sun", "0,90",
                           "--color-by-height")
    away = np.hypot(*np.meshgrid(*2 * [np.arange(300) - 149.5])) * 2 * 1.02 / 300
    assert (picture[away > 1.01] == 0).all()
    assert (picture[away < 0.97].max(axis=1) > 10).all()
    picture, _ = render(tmp_path / "from.png", path, "--on-body", "--view", "perspective", "--size", "160x90",
                        "--eye", "-60,-10,3000000", "--target", "-60,-10,0", "--sun", "0,80")
    assert picture[40:50, 70:90].min() > 80  # the sun's angles are those at the target


def test_patches_lie_on_it(tmp_path):
    """A level patch 7 m above level ground: two colours, and between them the margin's."""
    base = write_raster(tmp_path / "base.tif", np.ones((100, 100), int))
    fine = gdal.GetDriverByName("GTiff").Create(str(tmp_path / "fine.tif"), 100, 100, 1, gdal.GDT_Int16)
    fine.SetGeoTransform((160, 0.5, 0, 420, 0, -0.5))
    fine.GetRasterBand(1).WriteArray(np.full((100, 100), 4))
    del fine  # writes it
    given = f"{tmp_path / 'fine.tif'},vertical_scale=2,margin=5"
    found, = info(base, "--patch", given)
    assert found["patches"][0]["used"] and found["patches"][0]["height_range"] == [8, 8]
    assert found["auto_mode"] == "clipmap" and found["statistics"]["maximum_m"] == 1
    picture, _ = render(tmp_path / "p.png", base, "--patch", given, "--color-by-height", "--size", "198x198",
                        "--sun", "0,90")
    # The picture's columns are metres from x = 101 on.
    inside, outside = picture[90:110, 75:95].astype(int), picture[90:110, 5:45].astype(int)
    assert np.ptp(inside, axis=(0, 1)).max() <= 1 and np.ptp(outside, axis=(0, 1)).max() <= 1
    assert np.abs(inside[0, 0] - outside[0, 0]).max() > 50


def test_info_of_a_field(tmp_path):
    """Values of a byte raster with a scale, on the west half of the ground, against numpy."""
    base = write_raster(tmp_path / "base.tif", np.ones((100, 100), int))
    to_map = gdal.Open(str(base)).GetGeoTransform()
    values = np.random.default_rng(4).choice([1, 2, 5], (100, 50)).astype(np.uint8)
    values[:10] = 255
    data = gdal.GetDriverByName("GTiff").Create(str(tmp_path / "soil.tif"), 50, 100, 2, gdal.GDT_Byte)
    data.SetGeoTransform(to_map)
    band = data.GetRasterBand(2)
    band.SetNoDataValue(255)
    band.SetScale(0.5)
    band.SetOffset(3)
    band.SetUnitType("kPa")
    band.SetDescription("bearing strength")
    band.WriteArray(values)
    del band, data  # writes it
    given = f"soil={tmp_path / 'soil.tif'}:2"
    field, = info(base, "--field", given)[0]["fields"]
    good = values[10:] * 0.5 + 3.0
    assert (field["name"], field["band"], field["bands"], field["type"]) == ("soil", 2, 2, "Byte")
    assert (field["columns"], field["rows"], field["units"], field["no_data"]) == (50, 100, "kPa", 255)
    assert field["statistics"]["minimum"] == good.min() and field["statistics"]["maximum"] == good.max()
    assert field["statistics"]["mean"] == pytest.approx(good.mean(), abs=1e-9)
    assert field["statistics"]["holes"] == 500 and field["different_values"] == 3
    assert field["covered_fraction"] == pytest.approx(0.45, abs=0.02)  # half the columns, 90 of 100 rows
    text = run("terrain", "info", base, "--field", given, "--field", f"again={tmp_path / 'soil.tif'}").stdout
    for part in ("soil: ", "bearing strength", "3.5 to 5.5 kPa", "500 holes", "% of the terrain", "again: "):
        assert part in text, text


@pytest.mark.parametrize("view", ["map", "perspective"])
def test_shadows_darken_what_the_sun_does_not_reach(tmp_path, view):
    """A pit 12 m deep, its wall 4 m wide, in level ground; the Sun 20 degrees high in the west. The wall's shadow is 33 m
    long: beside it, pictures with and without shadows are the same."""
    x = np.arange(128) - 63.5  # posts 2 m apart
    away = np.maximum(np.abs(x[None, :]), np.abs(x[:, None])) * 2
    path = write_raster(tmp_path / "pit.tif", np.clip((away - 60) * 3, -12, 0).astype(np.int16))
    arguments = (path, "--view", view, "--sun", "270,20")
    if view == "map":
        arguments += ("--size", "256x256", "--no-color-by-height")  # pixels of a metre
    else:
        arguments += ("--size", "160x120")
    plain, _ = render(tmp_path / "plain.png", *arguments)
    shadowed, _ = render(tmp_path / "shadowed.png", *arguments, "--shadows")
    drop = plain.astype(int).mean(axis=2) - shadowed.astype(int).mean(axis=2)
    assert drop.min() >= -1
    if view == "perspective":
        assert 0.01 < (drop > 25).mean() < 0.1
        return
    # Column 128 is x = 0. The pit's edge is at column 68, and its shadow ends 12 m / tan(20 degrees) = 33 m to the east.
    rows = slice(84, 172)
    assert (drop[rows, 75:98] > 25).all() and (shadowed[rows, 75:98] > 0).all()  # the fill light is left
    for beside in (drop[rows, 104:], drop[:, :64], drop[:64], drop[192:]):
        assert np.abs(beside).max() <= 1


# --- What is refused -------------------------------------------------------------------------------

@pytest.mark.parametrize("arguments, code, text", [
    ([], 2, "COMMAND"),
    (["terain"], 2, "terain"),
    (["terrain"], 2, "WHAT"),
    (["terrain", "info"], 2, "FILE"),
    (["terrain", "info", "/no/such.tif"], 1, "/no/such.tif"),
    (["terrain", "info", __file__], 1, pathlib.Path(__file__).name),
    (["terrain", "info", FIELD, "--vertical-scale", "x"], 2, "x"),
    (["terrain", "info", FIELD, "--vertical-scale", "0"], 1, "scale"),
    (["terrain", "info", FIELD, "--crs", "nonsense"], 1, "nonsense"),
    (["terrain", "info", FIELD, "--band", "2"], 1, "band"),
    (["terrain", "info", FIELD, "--patch", ",margin=3"], 2, "names no file"),
    (["terrain", "info", FIELD, "--field", "soil"], 2, "NAME=FILE"),
    (["terrain", "info", FIELD, "--field", "soil=/no/such.tif"], 1, "/no/such.tif"),
    (["terrain", "info", FIELD, FIELD, "--field", f"soil={FIELD}"], 1, "--field"),
    (["terrain", "info", FIELD, "--patch", "a.tif,margin=x"], 2, "margin"),
    (["terrain", "info", FIELD, "--patch", "/no/such.tif"], 1, "/no/such.tif"),
    (["terrain", "info", FIELD, FIELD, "--patch", "a.tif"], 1, "--patch"),
    (["terrain", "render", FIELD], 2, "--out"),
    (["terrain", "render", FIELD, "--out", "/no/such/a.png"], 1, "/no/such"),
    (["terrain", "render", FIELD, "--out", "a.bmp"], 1, "a.bmp"),
    (["terrain", "render", FIELD, "--out", "a.png", "--size", "0x9"], 2, "0x9"),
    (["terrain", "render", FIELD, "--out", "a.png", "--sun", "1"], 2, "AZ,EL"),
    (["terrain", "render", FIELD, "--out", "a.png", "--sun", "1,nan"], 2, "nan"),
    (["terrain", "render", FIELD, "--out", "a.png", "--exaggeration", "0"], 2, "0.1 to 10000"),
    (["terrain", "render", FIELD, "--out", "a.png", "--exaggeration", "2", "--shadows"], 1, "without --shadows"),
    (["terrain", "render", FIELD, "--out", "a.png", "--eye", "1,2"], 2, "LON,LAT,HEIGHT"),
    (["terrain", "render", FIELD, "--out", "a.png", "--eye", "0,0,3"], 1, "perspective"),
    (["terrain", "render", FIELD, "--out", "a.png", "--image", "/no/such.png"], 1, "/no/such.png"),
    (["terrain", "render", FIELD, "--out", "a.png", "--image", "a", "--color-by-height"], 2, "--image"),
    (["terrain", "render", FIELD, "--out", "a.png", "--shapes", "a", "--color-by-height"], 2, "--shapes"),
    (["terrain", "render", FIELD, "--out", "a.png", "--image", "a", "--image", "b", "--image-crs", "c"], 2, "2 images"),
    (["terrain", "render", FIELD, "--out", "a.png", "--false-color", f"{FIELD}:7"], 1, "7"),
    (["terrain", "render", FIELD, "--out", "a.png", "--shapes", "/no/such.geojson"], 1, "/no/such.geojson"),
    (["terrain", "render", FIELD, "--out", "a.png", "--level-size", "13"], 1, "13"),
])
def test_what_is_refused_is_told_in_one_line(arguments, code, text, tmp_path):
    done = subprocess.run([sys.executable, "-m", "dspace", *map(str, arguments)], capture_output=True, text=True,
                          cwd=tmp_path)
    assert (done.returncode, done.stdout) == (code, ""), done
    assert text in done.stderr and len(done.stderr.strip().splitlines()) == 1, done.stderr
    assert list(tmp_path.iterdir()) == []


def test_the_entry_script_knows_the_words_of_the_command():
    script = ROOT / "dspace"
    for word in ("tset", "terrain_map", "__init__", "../terrain"):
        done = subprocess.run([script, word], capture_output=True, text=True)
        assert done.returncode == 2 and f"no command '{word}'" in done.stderr
    from dspace.command_line import WORDS
    modules = ROOT / "Wrapping/Python/dspace/command_line"
    assert all((modules / f"{word}.py").exists() for word in WORDS)


def test_a_bad_file_among_good_ones_stops_nothing():
    done = run("terrain", "info", "/no/such.tif", FIELD)
    assert done.returncode == 1 and "/no/such.tif" in done.stderr and "1001 x 1001" in done.stdout
