"""Rasters in polar stereographic projections on their body: against PROJ's places, brute-force rays and pictures."""
import numpy as np
import pytest

import dspace
from needs import needs_module
from terrain_support import between_posts, gdal, points_of, real

osr = needs_module("osgeo.osr", "python3-gdal")
osr.UseExceptions()
MOON = 1737400.0
PIXEL, SIZE = 500.0, 401

# South pole or not, the projection's longitude and scale, and the raster's middle [m].
PLACES = {"south": (True, 0, 1, (0, 0)), "north": (False, 0, 1, (0, 0)),
          "turned south": (True, 37, 0.97, (20000, -30000)),
          "beside north": (False, -120, 0.97, (150000, -130000))}


class Polar:
    """A raster of hills of some 1000 m, and its places by PROJ."""

    def __init__(self, path, south, longitude, scale, middle):
        self.path = path
        self.srs = osr.SpatialReference()
        self.srs.ImportFromProj4(f"+proj=stere +lat_0={-90 if south else 90} +lon_0={longitude} +k={scale} "
                                 f"+x_0=1000 +y_0=-2000 +R={MOON} +units=m +no_defs")
        degrees = self.srs.CloneGeogCS()
        for each in (self.srs, degrees):
            each.SetAxisMappingStrategy(osr.OAMS_TRADITIONAL_GIS_ORDER)
        self._to_degrees = osr.CoordinateTransformation(self.srs, degrees)
        self._to_map = osr.CoordinateTransformation(degrees, self.srs)
        self.middle = np.array(middle, float)
        self.corner = self.middle + (-0.5 * SIZE * PIXEL, 0.5 * SIZE * PIXEL)
        column, row = np.meshgrid(np.arange(SIZE), np.arange(SIZE))
        self.z = (1000 * np.sin(column / 19) * np.cos(row / 13) + 300 * np.sin(row * column / 900)).astype("f4")
        data = gdal.GetDriverByName("GTiff").Create(str(path), SIZE, SIZE, 1, gdal.GDT_Float32)
        data.SetProjection(self.srs.ExportToWkt())
        data.SetGeoTransform((self.corner[0], PIXEL, 0, self.corner[1], 0, -PIXEL))
        data.SetMetadataItem("VERTICAL_DATUM", f"sphere:{MOON:.0f}")
        data.GetRasterBand(1).SetUnitType("m")
        data.GetRasterBand(1).WriteArray(self.z)

    def random(self, n, seed, reach=0.49):
        return self.middle + np.random.default_rng(seed).uniform(-reach, reach, (n, 2)) * SIZE * PIXEL

    def heights(self, map):
        pixel = (map - self.corner) / (PIXEL, -PIXEL) - 0.5
        inside = ((pixel >= 0) & (pixel <= SIZE - 1)).all(axis=1)
        return np.where(inside, between_posts(self.z.astype(float), *np.where(inside[:, None], pixel, 0).T), np.nan)

    def points(self, map, heights):
        longitude, latitude = np.radians(np.array(self._to_degrees.TransformPoints(map))[:, :2].T)
        up = np.column_stack((np.cos(latitude) * np.cos(longitude), np.cos(latitude) * np.sin(longitude),
                              np.sin(latitude)))
        return (MOON + np.asarray(heights))[:, None] * up

    def map(self, points):
        longitude = np.degrees(np.arctan2(points[:, 1], points[:, 0]))
        latitude = np.degrees(np.arctan2(points[:, 2], np.hypot(points[:, 0], points[:, 1])))
        return np.array(self._to_map.TransformPoints(np.column_stack((longitude, latitude))))[:, :2]

    def above(self, points):
        """How far points are above the ground [m]; NaN off the raster."""
        return np.linalg.norm(points, axis=1) - MOON - self.heights(self.map(points))


@pytest.fixture(params=PLACES.values(), ids=PLACES.keys())
def polar(request, tmp_path):
    return Polar(tmp_path / "polar.tif", *request.param)


@pytest.fixture
def terrain(scene, polar):
    return scene.add_terrain(polar.path, name="polar", on_body=True)


def test_places_heights_and_normals(polar, terrain):
    assert terrain.on_body and terrain.mode == "clipmap"
    map = polar.random(2000, 1)
    heights = terrain.height(*map.T, map=True)
    np.testing.assert_allclose(heights, polar.heights(map), rtol=0, atol=2e-3)  # floats of posts
    points = polar.points(map, heights)
    np.testing.assert_allclose(terrain.from_map(np.column_stack((map, heights))), points, rtol=0, atol=2e-6)
    np.testing.assert_allclose(terrain.to_map(points), np.column_stack((map, heights)), rtol=0, atol=1e-5)
    np.testing.assert_allclose(terrain.height(*(1.001 * points).T), heights, rtol=0, atol=2e-3)
    located = terrain.locate(points)
    np.testing.assert_allclose(polar.map(points), map, rtol=0, atol=1e-5)
    np.testing.assert_allclose(located.body_fixed, points, rtol=0, atol=1e-6)
    x, y, z = points.T
    longitude, latitude = np.degrees(np.arctan2(y, x)), np.degrees(np.arctan2(z, np.hypot(x, y)))
    named = terrain.locate(np.column_stack((longitude + 360.0, latitude, heights)), degrees=True)
    np.testing.assert_allclose(named.map, np.column_stack((map, heights)), rtol=0, atol=1e-5)
    np.testing.assert_allclose(named.body_fixed, points, rtol=0, atol=1e-6)
    site = terrain.site(longitude.reshape(2, -1), latitude.reshape(2, -1), 2.0, degrees=True)
    np.testing.assert_allclose(np.column_stack((site.x.ravel(), site.y.ravel())), map, rtol=0, atol=1e-5)
    assert site.shape == (2, 1000) and (site.height == 2.0).all()
    with pytest.raises(dspace.InvalidArgument, match="a latitude is 146.31; accepted: -90 to 90 degrees"):
        terrain.site(-89.9, 146.31, degrees=True)
    with pytest.raises(dspace.InvalidArgument, match="map and degrees are both set"):
        terrain.locate([[0, 0, 0]], map=True, degrees=True)
    # Two directions along the facets, by differences of the independent places.
    inside = np.hypot(*((map - polar.corner) / PIXEL % 1 - 0.5).T) > 0.1
    steps = [polar.points(map + d, polar.heights(map + d)) - points for d in ((0.5, 0), (0, 0.5))]
    cross = np.cross(*steps)
    cross *= np.sign(np.einsum("ni,ni->n", cross, points))[:, None]
    expected = cross / np.linalg.norm(cross, axis=1)[:, None]
    normals = terrain.normal(*map.T, map=True)
    off = np.degrees(np.linalg.norm(np.cross(normals, expected), axis=1))
    assert np.median(off) < 1e-3 and np.quantile(off[inside], 0.97) < 0.02  # a step may cross an edge
    up = points / np.linalg.norm(points, axis=1)[:, None]
    lean = np.degrees(np.arccos(np.clip(np.einsum("ni,ni->n", up, normals), -1, 1)))
    np.testing.assert_allclose(terrain.slope_deg(*map.T, map=True), lean, rtol=0, atol=1e-5)
    # Aspect: where the normal leans, clockwise from true north.
    east = np.cross((0, 0, 1), up)
    east /= np.linalg.norm(east, axis=1)[:, None]
    north = np.cross(up, east)
    aspect = np.degrees(np.arctan2(np.einsum("ni,ni->n", normals, east), np.einsum("ni,ni->n", normals, north)))
    difference = (terrain.aspect_deg(*map.T, map=True) - aspect + 180) % 360 - 180
    assert np.abs(difference[lean > 0.5]).max() < 1e-4


def test_roughness_is_that_of_pixels_about_a_plane(polar, terrain):
    map = polar.random(20, 2, reach=0.4)
    radius = 2300.0
    column, row = np.meshgrid(np.arange(SIZE), np.arange(SIZE))
    pixels = polar.corner + np.column_stack((column.ravel() + 0.5, -row.ravel() - 0.5)) * PIXEL
    stand = polar.points(pixels, np.zeros(pixels.shape[0])) / MOON
    expected = []
    for here in polar.points(map, np.zeros(20)) / MOON:
        away = 2 * np.arcsin(0.5 * np.linalg.norm(stand - here, axis=1)) * MOON
        near = away <= radius
        north = np.array((0, 0, 1)) - here[2] * here
        axes = np.stack((np.cross(north, here), north)) / np.linalg.norm(north)
        flat = stand[near] @ axes.T * MOON
        design = np.column_stack((flat, np.ones(near.sum())))
        z = polar.z.ravel()[near].astype(float)
        expected.append(np.sqrt(np.mean((z - design @ np.linalg.lstsq(design, z, rcond=None)[0]) ** 2)))
    np.testing.assert_allclose(terrain.roughness(*map.T, radius, map=True), expected, rtol=1e-3)


def test_bounds_hold_the_ground_tightly(polar, terrain):
    column, row = np.meshgrid(*2 * [np.linspace(0.5, SIZE - 0.5, 101)])
    map = polar.corner + np.column_stack((column.ravel(), -row.ravel())) * PIXEL
    both = np.vstack([polar.points(map, np.full(len(map), height)) for height in terrain.height_range])
    low, high = np.reshape(terrain.extent, (2, 2)).T
    gaps = np.concatenate((both[:, :2].min(axis=0) - low, high - both[:, :2].max(axis=0)))
    assert gaps.min() > -1e-6 and gaps.max() < 0.2 * PIXEL  # between places of the sample


def rays_over(polar, seed, n):
    """Rays from low over the ground to far places in all directions, also across the pole."""
    random = np.random.default_rng(seed)
    eyes_map, ends_map = polar.random(n, seed, 0.48), polar.random(n, seed + 1, 0.48)
    eyes = polar.points(eyes_map, polar.heights(eyes_map) + random.uniform(5, 3000, n))
    ends = polar.points(ends_map, polar.heights(ends_map) + random.uniform(-200, 1500, n))
    ways = ends - eyes
    return eyes, ways / np.linalg.norm(ways, axis=1)[:, None]


def test_rays_against_a_march(polar, terrain):
    n, step, far = 300, 20.0, 150000.0
    eyes, ways = rays_over(polar, 5, n)
    distances = terrain.intersect(eyes, ways, maximum=far)
    t = np.arange(0.0, far, step)
    missed = 0
    for eye, way, distance in zip(eyes, ways, distances):
        above = polar.above(eye + t[:, None] * way)
        with np.errstate(invalid="ignore"):
            crossing = np.flatnonzero((above[:-1] > 0) & (above[1:] <= 0) | (above[:-1] <= 0) & (above[1:] > 0))
        if np.isfinite(distance):
            # A march may step over a ridge that the ray grazes, and nothing before the hit is under ground.
            assert abs(polar.above((eye + distance * way)[None])[0]) < 5e-3
            assert crossing.size == 0 or distance < t[crossing[0] + 1] + 1e-3
            if crossing.size == 0 or distance < t[crossing[0]] - 1e-3:
                missed += 1
                assert abs(np.nanmin(above[t < distance + step])) < 3.0
        else:
            assert crossing.size == 0
    hits = np.isfinite(distances).sum()
    assert hits > n // 3 and n - hits > n // 20 and missed < n // 30


def test_pictures_show_the_ground_where_it_is(scene, polar, terrain):
    scene.add_light("sky", kind="ambient", intensity=0.3)
    target_map = polar.middle + (3000.0, 5000.0)
    target = polar.points(target_map[None], [0.0])[0]
    up = target / np.linalg.norm(target)
    random = np.random.default_rng(3)
    for distance in (12000.0, 30000.0):
        side = np.cross(up, random.normal(size=3))
        eye = target + distance * (0.8 * up + 0.6 * side / np.linalg.norm(side))
        north = np.cross(up, np.cross((0.3, 0.2, 0.9), up))
        scene.add_camera("eye", eye=eye, target=target, up=north, fov_deg=40, near=10, far=2e6)
        view = scene.add_viewport((161, 121), "eye", samples=1)
        view.set_background((1, 0, 1))
        points = points_of(view.capture(depth=True)["depth"], eye, target, 40, up=north)[0].reshape(-1, 3)
        seen = np.isfinite(points).all(axis=1)
        assert seen.mean() > 0.95
        above = polar.above(points[seen])
        pixel = 2 * np.tan(np.radians(20)) / 121 * distance
        inside = np.isfinite(above)
        assert inside.mean() > 0.8 and np.abs(above[inside]).max() < 0.5 * pixel + 1.0
        assert np.median(np.abs(above[inside])) < 0.05 * pixel


@pytest.mark.parametrize("pixel, middle, turn, unit", [(1000.0, (8e5, 9e5), 0, 1), (4000.0, (1.2e6, -1.1e6), 0, 1),
                                                       (1000 / 3, (3000, -2000), 35, 1), (120.0, (3e5, 3e5), 90, 1000)])
def test_horizon_maps_against_rays(scene, tmp_path, pixel, middle, turn, unit):
    """Also on rotated rasters and in kilometres, whose sphere of heights is another one."""
    n, datum = 150 if pixel < 500.0 else 40, MOON + 500.0
    srs = osr.SpatialReference()
    srs.ImportFromProj4(f"+proj=stere +lat_0=-90 +lon_0=20 +R={MOON} +units={'m' if unit == 1 else 'km'} +no_defs")
    y, x = np.mgrid[0:n, 0:n]
    z = pixel * (1.5 * np.sin(x / 9) * np.cos(y / 7) + np.sin((x + y) / 23))
    c, s = np.cos(np.radians(turn)) * pixel / unit, np.sin(np.radians(turn)) * pixel / unit
    corner = np.array(middle) / unit - 0.5 * n * np.array((c + s, s - c))
    data = gdal.GetDriverByName("GTiff").Create(str(tmp_path / "wide.tif"), n, n, 1, gdal.GDT_Float32)
    data.SetProjection(srs.ExportToWkt())
    data.SetGeoTransform((corner[0], c, s, corner[1], s, -c))
    data.SetMetadataItem("VERTICAL_DATUM", f"sphere:{datum:.0f}")
    data.GetRasterBand(1).SetUnitType("m")
    data.GetRasterBand(1).WriteArray(z.astype("f4"))
    data = None
    terrain = scene.add_terrain(tmp_path / "wide.tif", name="wide", on_body=True)
    made = scene.horizon_map(terrain, tmp_path / "horizons.tif", azimuths=12, height=2.0)
    assert (made.columns, made.rows) == (n, n)
    g, random, off = made.geotransform, np.random.default_rng(5), []
    for column, row in random.integers(12, n - 12, (25, 2)):
        place = g[0] + g[1] * (column + 0.5) + g[2] * (row + 0.5), g[3] + g[4] * (column + 0.5) + g[5] * (row + 0.5)
        height = float(terrain.height(*place, map=True))
        assert height == pytest.approx(z[row, column], abs=2e-3)
        eye = terrain.from_map([[*place, height + 2.0]])[0]
        assert np.linalg.norm(eye) == pytest.approx(datum + height + 2.0, abs=1e-3)
        up = eye / np.linalg.norm(eye)
        east = np.cross((0, 0, 1), up) / np.hypot(*up[:2])
        azimuth = np.radians(np.arange(12) * 30.0 + made.first_deg(int(column), int(row)))
        level = np.sin(azimuth)[:, None] * east + np.cos(azimuth)[:, None] * np.cross(up, east)
        low, high = np.full(12, -20.0), np.full(12, 70.0)
        for _ in range(24):
            middle_deg = 0.5 * (low + high)
            e = np.radians(middle_deg)[:, None]
            hit = np.isfinite(terrain.intersect(np.tile(eye, (12, 1)), np.cos(e) * level + np.sin(e) * up))
            low, high = np.where(hit, middle_deg, low), np.where(hit, high, middle_deg)
        found = made.horizon(int(column), int(row))
        seen = (found > -80) & (low > -19)  # else nothing of the raster stands there
        off.extend(np.abs(found - low)[seen])
    assert len(off) > 250 and np.median(off) < 0.001 and np.quantile(off, 0.99) < 0.005 and np.max(off) < 0.01, (np.median(off), np.quantile(off, 0.99), np.max(off))


def test_rasters_that_cannot_stand_there(scene, tmp_path):
    polar = Polar(tmp_path / "polar.tif", *PLACES["south"])

    def rejected(error, match, srs=None, transform=None):
        data = gdal.Open(str(polar.path), gdal.GA_Update)
        data.SetProjection((srs or polar.srs).ExportToWkt())
        data.SetGeoTransform(transform or (polar.corner[0], PIXEL, 0, polar.corner[1], 0, -PIXEL))
        data = None
        with pytest.raises(error, match=match):
            scene.add_terrain(polar.path, name="polar", on_body=True)
        assert not scene.terrains

    rejected(dspace.errors.Unsupported, "mirrored", transform=(-100000, PIXEL, 0, -100000, 0, PIXEL))
    rejected(dspace.errors.Unsupported, "no squares", transform=(-100000, PIXEL, 0, 100000, 0, -PIXEL - 1))
    rejected(dspace.errors.Unsupported, "125", transform=(-1e7, 50000, 0, 1e7, 0, -50000))
    for text, match in (("+proj=stere +lat_0=-80 +R=1737400", "another kind"),
                        ("+proj=stere +lat_0=-90 +a=3396190 +b=3376200", "ellipsoid"),
                        ("+proj=laea +lat_0=-90 +R=1737400", "another kind")):
        srs = osr.SpatialReference()
        srs.ImportFromProj4(text)
        rejected(dspace.errors.Unsupported, match, srs=srs)


def test_a_raster_that_states_no_place(scene, tmp_path):
    path = tmp_path / "plain.tif"
    data = gdal.GetDriverByName("GTiff").Create(str(path), 20, 20, 1, gdal.GDT_Float32)
    data.GetRasterBand(1).WriteArray(np.zeros((20, 20), np.float32))
    data = None
    with pytest.raises(dspace.errors.Unsupported, match="does not state where its pixels lie.*gdal_translate -a_srs"):
        scene.add_terrain(path, on_body=True, crs=f"+proj=stere +lat_0=-90 +R={MOON}", pixel_size=100)


def test_a_real_raster_near_the_north_pole(scene):
    path = real("moon_npole_stereo_33.tif")
    terrain = scene.add_terrain(path, name="north", on_body=True)
    data = gdal.Open(str(path))
    transform = np.array(data.GetGeoTransform()).reshape(2, 3)
    middle = transform @ (1, 16.5, 16.5)
    located = terrain.locate([[*middle, 0.0]], map=True)
    assert located.latitude[0] == pytest.approx(87.556, abs=2e-3)
    assert located.longitude[0] % 360 == pytest.approx(360 - 46.4, abs=0.05)
    np.testing.assert_allclose(terrain.height(*middle, map=True), data.ReadAsArray()[16, 16], rtol=0, atol=1e-3)


def from_above(scene, polar, terrain, pixels, height=240000.0):
    """A view of the raster, by default of all of it, and the longitude and latitude [deg] of its pixels, NaN beside the ground."""
    scene.add_light("sky", kind="ambient", intensity=0.6)
    target, eye, upwards = terrain.from_map([[*polar.middle, 0.0], [*polar.middle, height], [*polar.middle + (0, 100), 0.0]])
    up = (upwards - target) / np.linalg.norm(upwards - target)
    scene.add_camera("above", eye=eye, target=target, up=up, fov_deg=50)
    view = scene.add_viewport((pixels, pixels), "above", samples=1)
    x, y, z = points_of(view.depth(), eye, target, 50, up=up)[0].transpose(2, 0, 1)
    return view, np.degrees(np.arctan2(y, x)), np.degrees(np.arctan2(z, np.hypot(x, y)))


def test_grid_lines_are_meridians_and_parallels(scene, polar, terrain):
    view, longitude, latitude = from_above(scene, polar, terrain, 500)
    plain = view.image()[..., :3].astype(float).mean(axis=2)
    terrain.set_style(grid={"interval": 10.0, "width": 2.0, "color": (0, 0, 0)})
    lines = view.image()[..., :3].astype(float).mean(axis=2) < 0.5 * plain
    pixel = 240000 * np.tan(np.radians(25)) / 250 / MOON * 180 / np.pi  # on the ground
    off = np.abs((longitude + 5) % 10 - 5) * np.cos(np.radians(latitude))
    off = np.minimum(off, np.abs((latitude + 5) % 10 - 5))
    away = 90 - np.abs(latitude) > 0.5
    assert lines[away].sum() > 1000
    assert off[lines & away].max() < 3 * pixel  # hills hide it
    assert lines[away & (off < 0.4 * pixel)].mean() > 0.97


def test_an_image_in_degrees_lies_where_it_belongs(scene, polar, terrain, tmp_path):
    south = polar.points(polar.middle[None], [0.0])[0, 2] < 0
    top = -70 if south else 90
    image = np.full((3, 200, 3600), 128, np.uint8)
    image[0] = np.rint(90 + np.arange(3600)[None, :] / 3600 * 160)
    image[1] = np.rint(90 + np.arange(200)[:, None] / 200 * 160)
    data = gdal.GetDriverByName("GTiff").Create(str(tmp_path / "image.tif"), 3600, 200, 3, gdal.GDT_Byte)
    data.SetProjection(polar.srs.CloneGeogCS().ExportToWkt())
    data.SetGeoTransform((-180, 0.1, 0, top, 0, -0.1))
    data.WriteArray(image)
    data = None
    view, longitude, latitude = from_above(scene, polar, terrain, 200)
    terrain.add_image(tmp_path / "image.tif")
    linear = view.radiance()
    expected = np.stack((90 + (longitude + 180) / 360 * 160, 90 + (top - latitude) / 20 * 160, np.full_like(latitude, 128)), -1) / 255
    expected = ((expected + 0.055) / 1.055) ** 2.4
    inside = np.isfinite(latitude) & (np.abs(latitude) < 89.5) & (np.abs(longitude) < 175)
    ratio = linear[inside] / expected[inside]
    ratio /= ratio[:, 2:]
    np.testing.assert_allclose(ratio, 1.0, rtol=0, atol=0.04)  # two roundings to 8 bits


def test_shadows_are_those_of_rays(scene, polar, terrain):
    toward = polar.points(polar.middle[None] + 1, [0.0])[0]
    up = toward / np.linalg.norm(toward)
    side = np.cross(up, (0.3, 0.9, 0.2))
    sun = np.sin(np.radians(3)) * up + np.cos(np.radians(3)) * side / np.linalg.norm(side)
    view, longitude, latitude = from_above(scene, polar, terrain, 160, 30000.0)
    scene.sun.set(direction=sun, radius_deg=0.0)
    view.shadows = True
    lit = view.lit_fraction()
    inside = np.isfinite(latitude)
    map = polar.map(np.column_stack([f(np.radians(longitude[inside])) * np.cos(np.radians(latitude[inside])) for f in (np.cos, np.sin)]
                                    + [np.sin(np.radians(latitude[inside]))]))
    on = (np.abs(map - polar.middle) < 0.45 * SIZE * PIXEL).all(axis=1)
    assert on.mean() > 0.99
    points = polar.points(map[on], polar.heights(map[on]) + 1.0)
    free = ~np.isfinite(terrain.intersect(points, np.tile(sun, (len(points), 1))))
    facing = np.einsum("ni,i->n", terrain.normal(*map[on].T, map=True), sun) > 0.01
    drawn = lit[inside][on] > 0.5
    assert 0.15 < free[facing].mean() < 0.95
    assert (drawn[facing] == free[facing]).mean() > 0.95  # pixels of 200 m have edges in them


def test_ruts_and_patches_lie_where_they_should(scene, polar, tmp_path):
    terrain = scene.add_terrain(polar.path, name="fine", on_body=True, subdivisions=13)
    start = polar.middle + (4321.0, -1234.0)
    a, b = polar.points(np.array((start, start + (3.0, 2.0))), [0.0, 0.0])
    line = a + np.linspace(0, 1, 40)[:, None] * (b - a)
    terrain.track({"wheel": line}, sinkage=0.2, width=0.5)
    side = np.cross(a, b - a)
    side /= np.linalg.norm(side)
    for off, depth in ((0.0, 0.2), (0.2, 0.19), (-0.2, 0.19), (0.45, 0.0), (-0.45, 0.0)):
        places = line[5:-5] + off * side
        sunk = terrain.undisturbed.height(*places.T) - terrain.height(*places.T)
        np.testing.assert_allclose(sunk, depth, rtol=0, atol=0.03)
    terrain.save_tracks(tmp_path / "tracks.json")
    sunk = terrain.height(*line[5:-5].T)
    terrain.clear_tracks()
    terrain.load_tracks(tmp_path / "tracks.json")
    np.testing.assert_allclose(terrain.height(*line[5:-5].T), sunk, rtol=0, atol=1e-3)

    # A patch in degrees: its heights hold where PROJ says that it lies.
    target = polar.middle + (60000.0, 50000.0)
    point = polar.points(target[None], [0.0])[0]
    longitude, latitude = np.degrees(np.arctan2(point[1], point[0])), np.degrees(np.arctan2(point[2], np.hypot(*point[:2])))
    step = 0.0025
    wide = step / np.cos(np.radians(latitude))
    data = gdal.GetDriverByName("GTiff").Create(str(tmp_path / "patch.tif"), 200, 200, 1, gdal.GDT_Float32)
    data.SetProjection(polar.srs.CloneGeogCS().ExportToWkt())
    data.SetGeoTransform((longitude - 100 * wide, wide, 0, latitude + 100 * step, 0, -step))
    data.SetMetadataItem("VERTICAL_DATUM", f"sphere:{MOON:.0f}")
    data.GetRasterBand(1).SetUnitType("m")
    data.GetRasterBand(1).WriteArray(np.full((200, 200), 7000, np.float32))
    data = None
    group = scene.add_terrain(polar.path, name="group", on_body=True, patches=[{"path": tmp_path / "patch.tif", "margin": 100.0}])
    map = target + np.random.default_rng(8).uniform(-12000, 12000, (3000, 2))
    x, y, z = polar.points(map, np.zeros(3000)).T
    away = np.maximum(np.abs((np.degrees(np.arctan2(y, x)) - longitude + 180) % 360 - 180) / wide,
                      np.abs(np.degrees(np.arctan2(z, np.hypot(x, y))) - latitude) / step)
    heights = group.height(*map.T, map=True)
    assert (away < 92).sum() > 300
    np.testing.assert_allclose(heights[away < 92], 7000, rtol=0, atol=1e-3)
    np.testing.assert_allclose(heights[away > 110], polar.heights(map)[away > 110], rtol=0, atol=2e-3)
