"""Layers of normals: Lambert's law in closed form, real relief against its own picture, turned axes against PROJ."""
import numpy as np
import pytest

import dspace
from needs import needs_module
from terrain_support import gdal, points_of, write_raster

osr = needs_module("osgeo.osr", "python3-gdal")
osr.UseExceptions()

RADIUS = 1e6
BALL = f"+proj=longlat +R={RADIUS} +no_defs"
SIZE = 100  # pixels, and metres, of pictures
# Towards the sun, unit.
SUNS = [np.array(v) / np.linalg.norm(v) for v in ((0.3, 0.2, 0.8), (-0.6, 0.1, 0.5), (0.1, -0.7, 0.4))]


def encoded(light):
    """Linear light to a byte: IEC 61966-2-1."""
    light = np.clip(light, 0, 1)
    return 255 * np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)


def linear(image):
    c = np.asarray(image, float) / 255
    return np.where(c <= 0.04045, c / 12.92, ((c + 0.055) / 1.055) ** 2.4)


def tilted(toward_deg, slope_deg):
    """The unit normal of ground that falls towards an azimuth: east, north, up."""
    a, t = np.radians(toward_deg), np.radians(slope_deg)
    return np.array((np.sin(t) * np.sin(a), np.sin(t) * np.cos(a), np.cos(t)))


def wkt(proj):
    crs = osr.SpatialReference()
    crs.ImportFromProj4(proj)
    return crs.ExportToWkt()


def write_normals(path, n, transform, type=gdal.GDT_Float32, proj=None, nodata=None):
    """n (rows, columns, 3), values or codes."""
    n = np.array(n)  # a copy: GDAL misreads one value broadcast
    data = gdal.GetDriverByName("GTiff").Create(str(path), n.shape[1], n.shape[0], n.shape[2], type)
    data.SetGeoTransform(transform)
    if proj:
        data.SetProjection(wkt(proj))
    for k in range(n.shape[2]):
        data.GetRasterBand(k + 1).WriteArray(np.ascontiguousarray(n[..., k]))
        if nodata is not None:
            data.GetRasterBand(k + 1).SetNoDataValue(nodata)
    data.FlushCache()
    return path


def constant(n, rows=64, columns=64):
    return np.broadcast_to(n, (rows, columns, len(n)))


def light_from(scene, sun):
    scene.lights["sun"].set(direction=tuple(-np.asarray(sun, float)), intensity=1.0, color=(1, 1, 1))


def look_down(scene, height=SIZE):
    scene.add_camera(eye=(0, 0, 500), target=(0, 0, 0), up=(0, 1, 0), height=height)
    view = scene.add_viewport(size=(SIZE, SIZE), samples=1)
    view.fill = 0.0
    return view


@pytest.fixture(params=["clipmap", "triangles"])
def mode(request):
    return request.param


def light_error(mode, sun):
    return 2e-4 if mode == "clipmap" else np.abs(sun).sum() / 254


def tolerance(mode, n, sun):
    """Of bytes: their rounding, and light to 2e-4 of 16 bits, or 1 / 254 in each of three numbers of 8 bits."""
    error = light_error(mode, sun)
    light = max(0.0, n @ sun)
    return 0.55 + max(abs(encoded(light + sign * error) - encoded(light)) for sign in (-1, 1))


def add_level(scene, tmp_path, mode):
    """White level ground, 256 m a side, map (0, 0) to (256, 256); and a view of its middle from above."""
    path = write_raster(tmp_path / "level.tif", np.zeros((128, 128), np.float32), 2.0)
    terrain = scene.add_terrain(path, name="ground", color=(1, 1, 1), mode=mode)
    return terrain, look_down(scene)


@pytest.fixture
def level(scene, tmp_path):
    return add_level(scene, tmp_path, "clipmap")


@pytest.fixture
def ground(scene, tmp_path, mode):
    return add_level(scene, tmp_path, mode)


ALL = (0, 4, 0, 256, 0, -4)  # 64 x 64 pixels over `level`


@pytest.mark.parametrize("toward, slope", [(0, 10), (90, 25), (215, 40), (300, 60)])
def test_lambert_in_closed_form(scene, ground, mode, tmp_path, toward, slope):
    terrain, view = ground
    n = tilted(toward, slope)
    layer = terrain.add_normals(write_normals(tmp_path / "n.tif", constant(n), ALL))
    assert (layer.name, layer.kind, layer.ornamental, layer.fragment) == ("normals", "normals", False, "physical")
    assert layer.pixel_size == pytest.approx(4)
    for sun in SUNS:
        light_from(scene, sun)
        # Linear light, before it becomes bytes: llvmpipe's own encoding as sRGB is off by 0.1 of a byte on some processors.
        light = view.radiance() * (np.pi / 1361.0)
        np.testing.assert_allclose(light, np.full(light.shape, max(0.0, n @ sun)), atol=light_error(mode, sun) + 1e-5)


@pytest.mark.parametrize("type, most", [(gdal.GDT_Byte, 255), (gdal.GDT_UInt16, 65535)])
def test_coded_values(scene, level, tmp_path, type, most):
    terrain, view = level
    codes = np.round((tilted(120, 35) + 1) / 2 * most)
    n = 2 * codes / most - 1
    n /= np.linalg.norm(n)
    terrain.add_normals(write_normals(tmp_path / "n.tif", constant(codes), ALL, type))
    light_from(scene, SUNS[0])
    np.testing.assert_allclose(view.image(), np.full((SIZE, SIZE, 3), encoded(n @ SUNS[0])), atol=0.7)


def relief(size):
    """Heights with a metre between, and their normals by numpy's gradients."""
    x, y = np.meshgrid(np.arange(float(size)), -np.arange(float(size)))
    z = 6 * np.sin(x / 13) * np.cos(y / 17) + 2 * np.cos((x + 2 * y) / 19)
    toward_south, east = np.gradient(z)
    n = np.stack([-east, toward_south, np.ones_like(z)], -1)
    return z, n / np.linalg.norm(n, axis=-1, keepdims=True)


def test_gradients_of_a_relief_on_level_ground_shade_as_the_relief(session, mode, tmp_path):
    z, n = relief(200)
    transform = (0, 1, 0, 200, 0, -1)
    pictures = []
    for heights, normals in ((z, None), (np.zeros_like(z), n)):
        scene = session.scene(f"scene {len(pictures)}")
        terrain = scene.add_terrain(write_raster(tmp_path / f"{len(pictures)}.tif", heights.astype(np.float32)),
                                    color=(1, 1, 1), mode=mode)
        light_from(scene, SUNS[1])
        view = look_down(scene)
        if normals is not None:
            flat = view.image()
            terrain.add_normals(write_normals(tmp_path / "n.tif", normals, transform))
        pictures.append(linear(view.image())[..., 0])
    real, shaded = pictures
    assert real.std() > 0.1 and linear(flat).std() < 1e-3  # there is something to compare
    # Both are of central differences; between posts one interpolates slopes and the other unit normals, which differ
    # by the square of their change from post to post (0.05). Triangles: 8 bits.
    most = 0.01 if mode == "clipmap" else 0.017
    assert np.abs(real - shaded).max() < most, np.abs(real - shaded).max()


def test_without_data_the_ground_has_its_own_normal(scene, ground, mode, tmp_path):
    terrain, view = ground
    light_from(scene, SUNS[0])
    plain = view.image()
    n = np.array(constant(tilted(270, 40)), np.float32)
    n[:, 32:] = -9  # east of the middle
    layer = terrain.add_normals(write_normals(tmp_path / "n.tif", n, ALL, nodata=-9))
    image = view.image()
    np.testing.assert_array_equal(image[:, 55:], plain[:, 55:])
    np.testing.assert_allclose(image[:, :45], encoded(max(0.0, tilted(270, 40) @ SUNS[0])),
                               atol=tolerance(mode, tilted(270, 40), SUNS[0]))
    n[:, 32:] = np.nan
    layer.remove()
    terrain.add_normals(write_normals(tmp_path / "nan.tif", n, ALL))
    np.testing.assert_array_equal(view.image()[:, 55:], plain[:, 55:])


def test_opacity_order_visibility_and_fragments(scene, level, tmp_path):
    terrain, view = level
    light_from(scene, SUNS[0])
    up, plain = np.array((0, 0, 1.0)), view.image()
    a, b = tilted(90, 40), tilted(200, 30)
    one = terrain.add_normals(write_normals(tmp_path / "a.tif", constant(a), ALL), opacity=0.5)
    two = terrain.add_normals(write_normals(tmp_path / "b.tif", constant(b), ALL), name="second", opacity=0.25,
                              fragment=scene.add_fragment("details"))

    def expect(*layers):
        """Bottom first: the layers' sum weighted by opacity, 1 long, then with the ground's by what they cover."""
        total, cover = np.zeros(3), 0.0
        for n, opacity in layers:
            total, cover = (1 - opacity) * total + opacity * n, (1 - opacity) * cover + opacity
        n = (1 - cover) * up + cover * total / np.linalg.norm(total)
        n /= np.linalg.norm(n)
        np.testing.assert_allclose(view.image(), np.full((SIZE, SIZE, 3), encoded(n @ SUNS[0])), atol=0.8)

    expect((a, 0.5), (b, 0.25))
    two.position = 0
    assert [layer.name for layer in terrain.layers] == ["second", "normals"]
    expect((b, 0.25), (a, 0.5))
    one.opacity = 1
    expect((a, 1))
    one.visible = False
    expect((b, 0.25))
    scene.fragments["details"].visible = False
    np.testing.assert_array_equal(view.image(), plain)
    scene.fragments["details"].visible = True
    two.remove()
    one.visible = True
    expect((a, 1))
    one.opacity = 0
    np.testing.assert_array_equal(view.image(), plain)


def test_triangles_have_layers_of_normals_for_all_viewports(scene, tmp_path, refused):
    terrain, view = add_level(scene, tmp_path, "triangles")
    light_from(scene, SUNS[0])
    plain = view.image()
    planes = [view.depth(), view.labels()]
    a, b = tilted(90, 40), tilted(200, 30)
    one = terrain.add_normals(write_normals(tmp_path / "a.tif", constant(a), ALL))
    two = terrain.add_normals(write_normals(tmp_path / "b.tif", constant(b), ALL), opacity=0.25)
    for before, now in zip(planes, (view.depth(), view.labels())):
        np.testing.assert_array_equal(before, now)

    def expect(n):
        n = n / np.linalg.norm(n)
        np.testing.assert_allclose(view.image(), np.full((SIZE, SIZE, 3), encoded(n @ SUNS[0])),
                                   atol=tolerance("triangles", n, SUNS[0]))

    assert [layer.name for layer in terrain.layers] == ["normals", "normals 2"]
    assert terrain.layer_tiles["bytes"] > 0
    expect(0.75 * a + 0.25 * b)
    two.position = 0
    expect(a)
    one.visible = False
    m = np.array((0, 0, 0.75)) + 0.25 * b
    expect(m)
    terrain.focus([(0, 0)], 20.0)
    expect(m)
    fragment = scene.add_fragment("details")
    with refused(dspace.Unsupported, "accepted: no fragment, or mode clipmap"):
        two.fragment = fragment
    with refused(dspace.Unsupported, "physical layers without a fragment of their own, or mode clipmap"):
        terrain.add_normals(tmp_path / "a.tif", ornamental=True)
    with refused(dspace.InvalidArgument, "position 7"):
        terrain.add_normals(tmp_path / "a.tif", position=7)
    with refused(dspace.InvalidArgument, "opacity"):
        two.opacity = -1
    expect(m)
    two.remove()
    one.remove()
    np.testing.assert_array_equal(view.image(), plain)


def test_only_shading_changes(scene, level, tmp_path):
    terrain, view = level
    light_from(scene, SUNS[0])
    colors = np.zeros((64, 64, 3))
    colors[::2] = 200
    terrain.add_image(write_normals(tmp_path / "stripes.tif", colors, ALL, gdal.GDT_Byte))
    before = [view.depth(), view.labels()]
    layer = terrain.add_normals(write_normals(tmp_path / "n.tif", constant(tilted(270, 40)), (96, 1, 0, 160, 0, -1)))
    for plane, same in zip(before, (view.depth(), view.labels())):
        np.testing.assert_array_equal(plane, same)
    layer.visible = False
    plain = view.image()
    layer.visible = True
    assert np.abs(view.image().astype(int) - plain).max() > 20
    # Unlit ground has no shading: layers of colours show just what they did.
    terrain.remove()
    other = scene.add_terrain(tmp_path / "level.tif", name="unlit", color=(1, 1, 1), mode="clipmap", lit=False)
    other.add_image(tmp_path / "stripes.tif")
    plain = view.image()
    other.add_normals(tmp_path / "n.tif")
    np.testing.assert_array_equal(view.image(), plain)
    assert other.height(3, 4) == 0 and tuple(other.normal(3, 4)) == (0, 0, 1)


def east_of(proj, x, y):
    """Unit directions (east, north) of a step along map x, and along map y: by PROJ and a sphere's geometry."""
    crs, degrees = osr.SpatialReference(), osr.SpatialReference()
    crs.ImportFromProj4(proj)
    degrees.ImportFromProj4(f"+proj=longlat +R={RADIUS} +no_defs")
    for each in (crs, degrees):
        each.SetAxisMappingStrategy(osr.OAMS_TRADITIONAL_GIS_ORDER)
    to = osr.CoordinateTransformation(crs, degrees)
    here = np.array(to.TransformPoint(x, y)[:2])
    axes = []
    for step in ((10, 0), (0, 10)):
        there = np.array(to.TransformPoint(x + step[0], y + step[1])[:2])
        d = (there - here) * (np.cos(np.radians(here[1])), 1)
        axes.append(d / np.linalg.norm(d))
    return np.array(axes), here


TERRAIN = f"+proj=tmerc +lon_0=0 +lat_0=0 +R={RADIUS}"


@pytest.fixture
def northern(scene, tmp_path):
    """Level ground of 256 m in a transverse Mercator, where map north is 17 degrees from north."""
    degrees = osr.SpatialReference()
    degrees.ImportFromProj4(BALL)
    crs = osr.SpatialReference()
    crs.ImportFromProj4(TERRAIN)
    for each in (crs, degrees):
        each.SetAxisMappingStrategy(osr.OAMS_TRADITIONAL_GIS_ORDER)
    x, y = osr.CoordinateTransformation(degrees, crs).TransformPoint(20.0, 58.0)[:2]
    x, y = round(x), round(y)
    path = write_raster(tmp_path / "north.tif", np.zeros((128, 128), np.float32), 2.0)
    data = gdal.Open(str(path), gdal.GA_Update)
    data.SetGeoTransform((x - 128, 2, 0, y + 128, 0, -2))
    data.SetProjection(wkt(TERRAIN))
    data = None
    terrain = scene.add_terrain(path, color=(1, 1, 1), mode="clipmap", vertical_datum=f"sphere:{RADIUS}")
    return terrain, look_down(scene), (x, y)


@pytest.mark.parametrize("axes", ["map", "local"])
@pytest.mark.parametrize("proj", [TERRAIN, BALL, f"+proj=stere +lat_0=90 +lon_0=0 +R={RADIUS}",
                                  f"+proj=tmerc +lon_0=40 +lat_0=0 +R={RADIUS}"],
                         ids=["the terrain's", "degrees", "polar", "another tmerc"])
def test_vectors_are_turned_with_the_map(scene, northern, tmp_path, proj, axes):
    terrain, view, (x, y) = northern
    ground, place = east_of(TERRAIN, x, y)
    assert abs(np.degrees(np.arctan2(ground[1][0], ground[1][1]))) > 15  # it is turned
    degrees = osr.SpatialReference()
    degrees.ImportFromProj4(BALL)
    crs = osr.SpatialReference()
    crs.ImportFromProj4(proj)
    for each in (crs, degrees):
        each.SetAxisMappingStrategy(osr.OAMS_TRADITIONAL_GIS_ORDER)
    u, v = osr.CoordinateTransformation(degrees, crs).TransformPoint(*place)[:2] if proj != BALL else place
    n = tilted(75, 35)
    if axes == "local":
        horizontal = n[:2]
    elif proj == BALL:
        horizontal = n[:2]
    else:
        along = east_of(proj, u, v)[0]
        horizontal = n[0] * along[0] + n[1] * along[1]
    expected = np.array((horizontal @ ground[0], horizontal @ ground[1], n[2]))
    pixel = 10.0 if proj != BALL else 10.0 / RADIUS * 180 / np.pi
    transform = (u - 60 * pixel, pixel, 0, v + 60 * pixel, 0, -pixel)
    terrain.add_normals(write_normals(tmp_path / "n.tif", constant(n, 120, 120), transform, proj=proj), axes=axes)
    for sun in SUNS:
        light_from(scene, sun)
        image = view.image()
        # The map's north turns by 0.005 degrees over the picture.
        np.testing.assert_allclose(image, np.full(image.shape, encoded(max(0.0, expected @ sun))), atol=0.8)


def axes_of(longitude, latitude):
    """East, north and up of places in degrees."""
    l, p = np.radians(longitude), np.radians(latitude)
    up = np.stack([np.cos(p) * np.cos(l), np.cos(p) * np.sin(l), np.sin(p)], -1)
    east = np.stack([-np.sin(l), np.cos(l), np.zeros_like(l)], -1)
    return east, np.cross(up, east), up


def field(up):
    """Unit normals, smooth everywhere on a body."""
    n = up + np.array((0.5, 0.2, 0.1))
    return n / np.linalg.norm(n, axis=-1, keepdims=True)


@pytest.fixture
def ball(scene, tmp_path):
    data = gdal.GetDriverByName("GTiff").Create(str(tmp_path / "ball.tif"), 360, 180, 1, gdal.GDT_Float32)
    data.SetGeoTransform((-180, 1, 0, 90, 0, -1))
    data.SetProjection(wkt(BALL))
    data.GetRasterBand(1).SetUnitType("m")
    data.GetRasterBand(1).WriteArray(np.zeros((180, 360), np.float32))
    data = None
    return scene.add_terrain(tmp_path / "ball.tif", on_body=True, vertical_datum=f"sphere:{RADIUS}", color=(1, 1, 1))


def assert_shows_the_field(scene, toward, least_z=-1.0):
    eye = np.asarray(toward) * 2.6e6 / np.linalg.norm(toward)
    sun = np.array((0.6, 0.3, 0.7)) if toward[2] >= 0 else np.array((0.3, 0.3, -0.9))
    sun /= np.linalg.norm(sun)
    light_from(scene, sun)
    scene.add_camera("orbit", eye=eye, target=(0, 0, 0), fov_deg=40, near=1e3, far=1e8)
    view = scene.add_viewport((200, 200), "orbit", samples=1)
    view.fill = 0.0
    points, _ = points_of(view.depth(), eye, (0, 0, 0), 40)
    up = points / np.linalg.norm(points, axis=-1, keepdims=True)
    expected = encoded(np.clip((field(up) * sun).sum(-1), 0, 1))
    told = ((up * eye).sum(-1) > 0.55 * np.linalg.norm(eye)) & (up[..., 2] > least_z)  # without the disc's rim
    assert told.sum() > 10000
    # Bytes; east turns within a texel at a pole: 2 there.
    error = np.abs(view.image()[..., 0] - expected)[told]
    assert error.max() < 2.0 and np.percentile(error, 95) < 1.0


@pytest.mark.parametrize("toward", [(1, 0.3, 0.2), (-1, 0.01, 0.1), (0.0004, 0, 1), (0.3, 0.3, 1), (0.0004, 0, -1)],
                         ids=["equator", "date line", "north", "aslant", "south"])
def test_on_a_body_east_and_north_are_those_of_each_place(scene, ball, tmp_path, toward):
    east, north, up = axes_of(*np.meshgrid(np.arange(-179.5, 180), np.arange(89.5, -90, -1)))
    n = np.stack([(field(up) * axis).sum(-1) for axis in (east, north, up)], -1)
    ball.add_normals(write_normals(tmp_path / "n.tif", n, (-180, 1, 0, 90, 0, -1), proj=BALL))
    assert_shows_the_field(scene, toward)


def test_on_a_body_the_axes_of_a_polar_map_are_turned(scene, ball, tmp_path):
    pixel, side = 10e3, 120
    x, y = np.meshgrid(pixel * (np.arange(side) - side / 2 + 0.5), -pixel * (np.arange(side) - side / 2 + 0.5))
    # Snyder (1987), 21-15 to 21-18: x = rho sin l, y = -rho cos l.
    latitude = 90 - 2 * np.degrees(np.arctan(np.hypot(x, y) / (2 * RADIUS)))
    longitude = np.degrees(np.arctan2(x, -y))
    east, north, up = axes_of(longitude, latitude)
    l = np.radians(longitude)[..., None]
    along_x, along_y = np.cos(l) * east - np.sin(l) * north, np.sin(l) * east + np.cos(l) * north
    n = np.stack([(field(up) * axis).sum(-1) for axis in (along_x, along_y, up)], -1)
    path = write_normals(tmp_path / "n.tif", n, (-side / 2 * pixel, pixel, 0, side / 2 * pixel, 0, -pixel),
                         proj=f"+proj=stere +lat_0=90 +lon_0=0 +R={RADIUS}")
    ball.add_normals(path)
    assert_shows_the_field(scene, (0.3, 0.2, 1), np.cos(np.radians(32)))  # the map ends at 33 degrees from the pole


def test_what_is_rejected(scene, level, tmp_path, refused):
    terrain, _ = level
    n = tilted(90, 40)
    good = write_normals(tmp_path / "good.tif", constant(n), ALL)

    def bad(values, name="bad.tif", **more):
        return write_normals(tmp_path / name, np.asarray(values), more.pop("transform", ALL), **more)

    with refused(dspace.Unsupported, "it has 1 band; accepted are 3"):
        terrain.add_normals(bad(np.ones((8, 8, 1))))
    with refused(dspace.Unsupported, "it has 4 bands; accepted are 3"):
        terrain.add_normals(bad(np.ones((8, 8, 4))))
    hole = np.array(constant(n), np.float32)
    hole[40, 7] = 0
    with refused(dspace.Corrupt, "it holds the vector (0, 0, 0), which is no normal of ground"):
        terrain.add_normals(bad(hole))
    hole[40, 7] = (0, 0, 3)
    with refused(dspace.Corrupt, "it holds the vector (0, 0, 3), which is no normal"):
        terrain.add_normals(bad(hole))
    hole[40, 7] = (0.6, 0, -0.8)
    with refused(dspace.Corrupt, "z (the third band) from 0"):
        terrain.add_normals(bad(hole))
    with refused(dspace.Corrupt, "all of its values are no-data"):
        terrain.add_normals(bad(np.full((8, 8, 3), -9.0), nodata=-9))
    with refused(dspace.InvalidArgument, "it does not overlap terrain"):
        terrain.add_normals(bad(constant(n), transform=(9000, 4, 0, 9000, 0, -4)))
    with refused(dspace.InvalidArgument, "opacity"):
        terrain.add_normals(good, opacity=1.5)
    with refused(dspace.NotFound, "absent.tif"):
        terrain.add_normals(tmp_path / "absent.tif")
    with refused(dspace.InvalidArgument, '"map" or "local"'):
        terrain.add_normals(good, axes="east")
    with refused(dspace.Unsupported, "has no longitude and latitude; accepted: axes of the map"):
        terrain.add_normals(good, axes="local")
    assert terrain.layers == []


def test_axes_that_are_not_at_right_angles_are_rejected(scene, northern, tmp_path, refused):
    terrain, _, (x, y) = northern
    _, place = east_of(TERRAIN, x, y)
    sinusoidal = f"+proj=sinu +lon_0=0 +R={RADIUS}"
    u = RADIUS * np.radians(place[0]) * np.cos(np.radians(place[1]))
    v = RADIUS * np.radians(place[1])
    path = write_normals(tmp_path / "n.tif", constant((0, 0, 1.0)), (u - 320, 10, 0, v + 320, 0, -10), proj=sinusoidal)
    with refused(dspace.Unsupported, "are not at right angles on the ground"):
        terrain.add_normals(path)
    assert terrain.add_normals(path, axes="local").kind == "normals"


def test_a_recording_has_the_layer(mode, tmp_path):
    run = tmp_path / "run.dspace"
    with dspace.Session() as session:
        scene = session.scene()
        terrain, view = add_level(scene, tmp_path, mode)
        light_from(scene, SUNS[0])
        scene.time = 0.0
        terrain.add_normals(write_normals(tmp_path / "n.tif", constant(tilted(90, 40)), ALL), opacity=0.7, name="tilt")
        with session.record(run):
            scene.time = 1.0
            terrain.layer("tilt").opacity = 0.4
            scene.time = 2.0
        image = view.image()
    with dspace.Playback(run) as playback:
        playback.seek(2.0)
        again = playback.session.scenes["scene"].terrains["ground"].layer("tilt")
        assert (again.kind, again.opacity) == ("normals", 0.4)
        name = next(iter(playback.session.viewports))
        np.testing.assert_array_equal(playback.session.viewports[name].image(), image)
