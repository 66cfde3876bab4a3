"""Fields of terrain through Python, against GDAL's and OSR's own."""
import numpy as np
import pytest

import dspace
from terrain_support import gdal, real, write_raster

FLAT = np.zeros((40, 60))


def write(path, values, transform, wkt="", nodata=None, unit="", type=gdal.GDT_Float64, scale=None, offset=None):
    data = gdal.GetDriverByName("GTiff").Create(str(path), values.shape[1], values.shape[0], 1, type)
    data.SetGeoTransform(transform)
    data.SetProjection(wkt)
    band = data.GetRasterBand(1)
    if nodata is not None:
        band.SetNoDataValue(nodata)
    if scale is not None:
        band.SetScale(scale)
        band.SetOffset(offset)
    band.SetUnitType(unit)
    band.WriteArray(values)
    return path


def bilinear(values, x, y):
    """At pixel coordinates, (0.5, 0.5) the first pixel's centre."""
    c = np.clip(np.asarray(x) - 0.5, 0, values.shape[1] - 1)
    r = np.clip(np.asarray(y) - 0.5, 0, values.shape[0] - 1)
    i, j = np.minimum(c.astype(int), values.shape[1] - 2), np.minimum(r.astype(int), values.shape[0] - 2)
    u, v = c - i, r - j
    return ((1 - v) * ((1 - u) * values[j, i] + u * values[j, i + 1])
            + v * ((1 - u) * values[j + 1, i] + u * values[j + 1, i + 1]))


@pytest.fixture(params=["triangles", "clipmap"])
def ground(request, session, tmp_path):
    path = write_raster(tmp_path / "flat.tif", FLAT)
    return session.scene().add_terrain(path, name="ground", mode=request.param)


def test_values_of_points_and_arrays(ground, tmp_path):
    random = np.random.default_rng(1)
    soil = random.normal(size=(20, 30))
    path = write(tmp_path / "soil.tif", soil, (0, 2, 0, 40, 0, -2), unit="kPa")
    field = ground.add_field("soil", path)
    x, y = random.uniform(0, 60, (3, 50)), random.uniform(0, 40, (3, 50))  # map
    expected = bilinear(soil, x / 2, (40 - y) / 2)
    np.testing.assert_allclose(ground.value("soil", x, y, map=True), expected, atol=1e-12)
    points = ground.from_map(np.stack([x, y, np.zeros_like(x)], axis=-1))
    np.testing.assert_allclose(ground.value("soil", points[..., 0], points[..., 1]), expected, atol=1e-9)
    value = ground.value("soil", x[0, 0], y[0, 0], map=True)
    assert isinstance(value, float) and value == pytest.approx(expected[0, 0], abs=1e-12)
    assert np.isnan(ground.value("soil", -1, 5, map=True))
    assert (field.units, field.nearest, field.path) == ("kPa", False, str(path))
    assert field.pixel_size == 2 and field.size == (30, 20) and field.band == 1
    assert repr(field) == "<dspace.TerrainField 'soil' of kPa, 30 x 20 pixels of 2 m>"
    assert repr(ground).endswith("fields 'soil'>")
    nearest = ground.add_field("class", path, units="class", nearest=True)
    assert list(ground.fields) == ["soil", "class"] and nearest.units == "class"
    several = ground.value(["class", "soil"], x, y, map=True)
    np.testing.assert_array_equal(several["class"],
                                  soil[np.floor((40 - y) / 2).astype(int), np.floor(x / 2).astype(int)])
    np.testing.assert_allclose(several["soil"], expected, atol=1e-12)
    nearest.remove()
    assert list(ground.fields) == ["soil"]
    with pytest.raises(dspace.NotFound, match="no field 'class'; there are: 'soil'"):
        ground.value("class", 0, 0)


def test_real_values_across_projections(session):
    """An equidistant cylindrical cube of radii on a degree grid of the Moon: OSR gives the pixels of places, GDAL the
    values."""
    cube = real("moon_ulcn2005_spole_250.cub")
    terrain = session.scene().add_terrain(real("moon_lola_global_4ppd_km.tif"), name="moon", mode="clipmap",
                                          vertical_scale=1000, vertical_datum="sphere")
    terrain.add_field("radius", cube, nearest=False)
    data = gdal.Open(str(cube))
    band = data.GetRasterBand(1)
    values = band.ReadAsArray().astype(float) * band.GetScale() + band.GetOffset()
    from osgeo import osr
    moon = osr.SpatialReference()
    moon.ImportFromWkt(terrain.crs)
    moon.SetAxisMappingStrategy(osr.OAMS_TRADITIONAL_GIS_ORDER)
    to_cube = osr.CoordinateTransformation(moon, data.GetSpatialRef())
    random = np.random.default_rng(2)
    lon, lat = random.uniform(-11, 4, 500), random.uniform(-89, -75, 500)
    g = data.GetGeoTransform()
    map = np.array([to_cube.TransformPoint(*place)[:2] for place in zip(lon, lat)])
    x, y = (map[:, 0] - g[0]) / g[1], (map[:, 1] - g[3]) / g[5]
    turn = 2 * np.pi * 1737400 / g[1]  # the cube lies across the edge of its own projection
    x -= turn * np.round((x - 125) / turn)
    inside = (x > 0) & (x < 250) & (y > 0) & (y < 250)
    assert inside.sum() > 400
    got = terrain.value("radius", lon, lat, map=True)
    np.testing.assert_allclose(got[inside], bilinear(values, x[inside], y[inside]), atol=1e-3)
    assert np.isnan(got[~inside]).all()


def test_values_on_a_body_and_in_picks(session):
    path = real("moon_lola_global_4ppd_km.tif")
    scene = session.scene()
    moon = scene.add_terrain(path, name="moon", on_body=True, vertical_scale=1000, vertical_datum="sphere")
    moon.add_field("height", path, units="km")
    values = gdal.Open(str(path)).ReadAsArray()
    lon, lat = -20.1, 41.3
    expected = bilinear(values, (lon + 180) * 4, (90 - lat) * 4)
    assert moon.value("height", lon, lat, map=True) == pytest.approx(expected, abs=1e-6)
    up = np.array([np.cos(np.radians(lat)) * np.cos(np.radians(lon)),
                   np.cos(np.radians(lat)) * np.sin(np.radians(lon)), np.sin(np.radians(lat))])
    assert moon.value("height", *(1.8e6 * up)) == pytest.approx(expected, abs=1e-6)
    assert moon.value("height", lon + 360, lat, map=True) == pytest.approx(expected, abs=1e-6)
    view = scene.add_viewport((65, 49), scene.add_camera("orbit", eye=2.0e6 * up, target=(0, 0, 0)))
    pick = view.pick(32, 24)
    assert pick.terrain.name == "moon"
    assert pick.coordinates.longitude == pytest.approx(lon, abs=2e-3)
    assert pick.coordinates.latitude == pytest.approx(lat, abs=2e-3)
    np.testing.assert_allclose(pick.coordinates.body_fixed, pick.in_root, atol=1e-3)
    np.testing.assert_allclose(pick.coordinates.root, pick.in_root, atol=1e-6)
    assert pick.coordinates.height == pytest.approx(np.linalg.norm(pick.in_root) - 1737400, abs=1e-3)
    assert pick.fields == {"height": pytest.approx(moon.value("height", *pick.map[:2], map=True), abs=1e-9)}


def test_a_field_as_a_layer(session, tmp_path):
    terrain = session.scene().add_terrain(write_raster(tmp_path / "flat.tif", FLAT), mode="clipmap", color=(1, 1, 1))
    halves = np.where(np.arange(60) < 30, 1.0, 5.0) * np.ones((40, 1))
    terrain.add_field("halves", write(tmp_path / "halves.tif", halves, (0, 1, 0, 40, 0, -1)), units="W")
    layer = terrain.add_false_color(field="halves", colors=["black", "white"])
    assert (layer.field, layer.unit, layer.range) == ("halves", "W", (1, 5))
    with pytest.raises(dspace.InvalidArgument, match="layer 'false color' shows field 'halves'"):
        terrain.fields["halves"].remove()
    with pytest.raises(dspace.InvalidArgument, match="one of both"):
        terrain.add_false_color()
    with pytest.raises(dspace.InvalidArgument, match="which has its own"):
        terrain.add_false_color(field="halves", band=1)
    with pytest.raises(dspace.NotFound, match="no field 'soil'"):
        terrain.add_false_color(field="soil")
    layer.remove()
    terrain.fields["halves"].remove()
    assert not terrain.fields


def test_bad_fields_change_nothing(ground, tmp_path):
    good = write(tmp_path / "good.tif", np.ones((4, 4)), (0, 1, 0, 40, 0, -1))
    far = write(tmp_path / "far.tif", np.ones((4, 4)), (1000, 1, 0, 40, 0, -1))
    ground.add_field("good", good)
    bad = [(dict(name="far", path=far), dspace.InvalidArgument, "field 'far'.*does not overlap"),
           (dict(name="good", path=good), dspace.AlreadyExists, "field 'good' already"),
           (dict(name="", path=good), dspace.InvalidArgument, "field"),
           (dict(name="b", path=good, band=2), dspace.InvalidArgument, "band 2 .*accepted are 1 to 1"),
           (dict(name="b", path=good, band=0), dspace.InvalidArgument, "band"),
           (dict(name="b", path=good, extent=(0, 0, 0, 0)), dspace.InvalidArgument, "extent"),
           (dict(name="b", path=tmp_path / "absent.tif"), dspace.NotFound, "absent.tif"),
           (dict(name="b", path=good, crs="EPSG:nowhere"), dspace.InvalidArgument, "nowhere"),
           (dict(name="b", path=good, nearest="yes"), dspace.WrongType, "nearest")]
    for arguments, error, message in bad:
        with pytest.raises(error, match=message):
            ground.add_field(**arguments)
    assert list(ground.fields) == ["good"]
    for arguments in (("good", [0, np.nan], 0), ("good", np.ones(2), np.ones(3)), ([], 0, 0), (3, 0, 0)):
        with pytest.raises(dspace.Error):
            ground.value(*arguments)


def test_a_recording_notes_the_file_and_restores_fields(session, tmp_path):
    terrain = session.scene().add_terrain(write_raster(tmp_path / "flat.tif", FLAT), name="ground", mode="clipmap")
    path = write(tmp_path / "soil.tif", np.arange(2400.0).reshape(40, 60), (0, 1, 0, 40, 0, -1))
    terrain.add_field("soil", path, units="kPa")
    terrain.add_false_color(field="soil", name="shown")
    with session.record(tmp_path / "run.dspace", pack=True):
        pass
    path.unlink()
    with dspace.Playback(tmp_path / "run.dspace") as run:
        run.step(1000)
        again = run.session.scene().terrains["ground"]
        assert again.fields["soil"].units == "kPa" and again.layer("shown").field == "soil"
        assert again.value("soil", 10.5, 20.5, map=True) == 19 * 60 + 10
