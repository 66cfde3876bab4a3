"""Lines of sight and horizons through Python: closed forms, and every triangle by numpy."""
import numpy as np
import pytest

import dspace
from terrain_support import gdal, write_raster

R = 6371000.0  # [m] of the sphere of the ring wall


def walls(path, arc):
    """Walls of 1,000 m along two parallels of a sphere, `arc` metres along the ground north and south of the equator."""
    step = np.degrees(arc / R) / 2
    z = np.zeros((7, 41), np.float32)
    z[[1, 5]] = 1000.0
    data = gdal.GetDriverByName("GTiff").Create(str(path), 41, 7, 1, gdal.GDT_Float32)
    data.SetGeoTransform((-20.5 * step, step, 0, 3.5 * step, 0, -step))
    data.SetProjection(f'GEOGCS["ring",DATUM["ring",SPHEROID["ring",{R},0]],PRIMEM["Greenwich",0],UNIT["degree",'
                       "0.0174532925199433]]")
    data.SetMetadataItem("VERTICAL_DATUM", "sphere")
    data.GetRasterBand(1).WriteArray(z)
    return path


def moller(origin, direction, a, b, c):
    """t of every triangle that the ray crosses, infinity of the others."""
    with np.errstate(divide="ignore", invalid="ignore"):
        ab, ac = b - a, c - a
        p = np.cross(direction, ac)
        det = np.einsum("ni,ni->n", ab, p)
        s = origin - a
        u = np.einsum("ni,ni->n", s, p) / det
        q = np.cross(s, ab)
        v = np.einsum("i,ni->n", direction, q) / det
        t = np.einsum("ni,ni->n", ac, q) / det
    return np.where((u >= -1e-12) & (v >= -1e-12) & (u + v <= 1 + 1e-12), t, np.inf)


def triangles_of(z, pixel):
    """The triangles between the posts of write_raster: the diagonal runs from the north-west to the south-east post."""
    rows, columns = z.shape
    c, r = np.meshgrid(np.arange(columns), np.arange(rows))
    p = np.stack((pixel * (c + 0.5), pixel * (rows - r - 0.5), z.astype(float)), axis=-1)
    nw, ne, sw, se = (p[:-1, :-1], p[:-1, 1:], p[1:, :-1], p[1:, 1:])
    return [np.concatenate(pair).reshape(-1, 3) for pair in ((nw, nw), (sw, se), (se, ne))]


@pytest.fixture(params=["triangles", "clipmap"])
def rough(request, scene, tmp_path):
    """Rough ground of 40 x 30 posts, 2 m apart, in a frame that is turned; its heights; a function to its frame."""
    z = np.random.default_rng(8).normal(0.0, 1.5, (30, 40)).astype(np.float32)
    frame = scene.add_frame("site", position=(100.0, -20.0, 7.0), quaternion=(np.cos(0.4), 0.0, 0.0, np.sin(0.4)))
    terrain = scene.add_terrain(write_raster(tmp_path / "rough.tif", z, 2.0), name="rough", mode=request.param, frame=frame,
                                pixel_size=2.0)
    return terrain, z


def test_random_lines_over_rough_ground_agree_with_every_triangle(scene, rough):
    terrain, z = rough
    a, b, c = triangles_of(z, 2.0)
    random = np.random.default_rng(1)
    n = 300
    start, end = (terrain.site(random.uniform(2, 78, n), random.uniform(2, 58, n), random.uniform(0.05, 3.0, n)) for _ in "ab")
    lines = scene.line_of_sight(start, end)
    assert lines.clear.shape == (n,) and 30 < lines.clear.sum() < n - 30
    ground = [terrain.height(site.x, site.y, map=True) for site in (start, end)]
    p, q = (np.column_stack((site.x, site.y, h + site.height)) for site, h in zip((start, end), ground))
    np.testing.assert_allclose(lines.range, np.linalg.norm(q - p, axis=1), rtol=1e-9)
    to_map = terrain.to_map(np.nan_to_num(scene_to_frame(terrain, lines.point)))
    for i in range(n):
        t = moller(p[i], q[i] - p[i], a, b, c)
        t = t[(t >= 0) & (t <= 1)]
        assert lines.clear[i] == (t.size == 0), i
        if t.size:
            assert lines.terrain[i] == "rough" and lines.object[i] is None
            assert lines.distance[i] == pytest.approx(t.min() * lines.range[i], abs=1e-5)
            np.testing.assert_allclose(to_map[i], p[i] + t.min() * (q[i] - p[i]), atol=1e-5)
        # Heights of the line over its own ground, where the line crosses lines between posts or between them.
        share = np.linspace(0.0, 1.0, 4001)
        along = p[i] + share[:, None] * (q[i] - p[i])
        least = (along[:, 2] - terrain.height(along[:, 0], along[:, 1], map=True)).min() if i < 40 else None
        if least is not None:
            assert lines.clearance[i] == pytest.approx(least, abs=0.02), i
        assert (lines.clearance[i] < 0) == (lines.clearance_deg[i] < 0) == (not lines.clear[i])


def scene_to_frame(terrain, points):
    position, (w, _, _, s) = np.array((100.0, -20.0, 7.0)), (np.cos(0.4), 0, 0, np.sin(0.4))
    turn = np.array([[w * w - s * s, 2 * w * s, 0], [-2 * w * s, w * w - s * s, 0], [0, 0, 1]])
    return (np.asarray(points) - position) @ turn.T


def test_horizons_on_rough_ground_agree_with_the_edges_of_every_triangle(scene, rough):
    terrain, z = rough
    site = terrain.site(41.3, 27.7, 0.7)
    horizon = scene.horizon(site, 64)
    np.testing.assert_allclose(horizon.azimuth_deg, np.arange(64) * 5.625)
    eye = np.array((41.3, 27.7, terrain.height(41.3, 27.7, map=True) + 0.7))
    a, b, c = triangles_of(z, 2.0)
    for azimuth, elevation in zip(np.radians(horizon.azimuth_deg), horizon.elevation_deg):
        # Where the vertical half-plane of the azimuth cuts the edges: the greatest elevation is at one of them.
        best = -90.0
        for p, q in ((a, b), (b, c), (c, a)):
            sp, sq = ((e[:, 0] - eye[0]) * np.cos(azimuth) - (e[:, 1] - eye[1]) * np.sin(azimuth) for e in (p, q))
            with np.errstate(divide="ignore", invalid="ignore"):
                cut = p + (sp / (sp - sq))[:, None] * (q - p)
            out = (cut[:, 0] - eye[0]) * np.sin(azimuth) + (cut[:, 1] - eye[1]) * np.cos(azimuth)
            good = (sp * sq <= 0) & (sp != sq) & (out > 0)
            best = max(best, np.degrees(np.arctan2(cut[good, 2] - eye[2], out[good])).max())
        assert elevation == pytest.approx(best, abs=1e-5)


@pytest.mark.parametrize("arc, radians", [(R * np.arcsin(5000.04 / (R + 1000)), 0.197017), (5000.0, 0.196988)])
def test_a_wall_on_a_sphere(scene, tmp_path, arc, radians):
    """At a distance of 5,000.04 m in the tangent plane, dropped by d^2 / 2R; and at 5 km along the ground."""
    wall = scene.add_terrain(walls(tmp_path / "wall.tif", arc), name="wall", on_body=True)
    site = wall.site(0.0, 0.0)
    horizon = scene.horizon(site, 24)
    np.testing.assert_allclose(np.radians(horizon.elevation_deg[[0, 12]]), radians, atol=1e-6)
    d = (R + 1000) * np.sin(arc / R)
    assert np.arctan((1000 - d * d / (2 * R)) / d) == pytest.approx(radians, abs=1e-6)
    np.testing.assert_allclose(horizon.distance[[0, 12]], np.hypot(d, 1000 - d * d / 2 / R), atol=0.02)
    assert horizon.elevation_at(360.0) == horizon.elevation_deg[0]
    assert horizon.elevation_at([-7.5, 7.5]) == pytest.approx(horizon.elevation_deg[[0, 0]] / 2
                                                              + horizon.elevation_deg[[-1, 1]] / 2)
    # A target behind the wall rises over it at the elevation of the crest.
    for above, clear in ((-1e-4, False), (1e-4, True)):
        distance = 1.4 * d
        height = np.tan(radians + above) * distance
        target = np.array((R + height, 0.0, distance))
        line = scene.line_of_sight(site, target)
        assert line.clear is clear and line.clearance_deg == pytest.approx(np.degrees(above), abs=1e-4)
    assert horizon.place == pytest.approx((R, 0.0, 0.0), abs=1e-6)


def test_a_post_of_half_a_metre_flips_the_answer(scene, tmp_path):
    z = np.zeros((21, 201), np.float32)
    flat = scene.add_terrain(write_raster(tmp_path / "flat.tif", z), name="flat", pixel_size=1.0)
    start, end = flat.site(0.5, 10.5, 0.4), flat.site(200.5, 10.5, 0.4)
    clear = scene.line_of_sight(start, end)
    assert clear.clear is True and clear.terrain == "" and clear.distance == np.inf and np.isnan(clear.point).all()
    assert clear.clearance == pytest.approx(0.4, abs=1e-6)
    assert scene.horizon(start, 4).elevation_deg[1] < 0
    flat.remove()
    z[10, 100] = 0.5
    post = scene.add_terrain(write_raster(tmp_path / "post.tif", z), name="post", pixel_size=1.0)
    start, end = post.site(0.5, 10.5, 0.4), post.site(200.5, 10.5, 0.4)
    blocked = scene.line_of_sight(start, end, wavelength=0.125)
    assert blocked.clear is False and blocked.terrain == "post"
    assert blocked.distance == pytest.approx(99.8, abs=1e-6)  # 0.4 m of a flank that rises 0.5 m in a metre
    assert blocked.clearance == pytest.approx(-0.1, abs=2e-6)
    assert blocked.clearance_deg == pytest.approx(-np.degrees(np.arctan2(0.2, 200.0)), abs=1e-6)
    assert blocked.fresnel_free == pytest.approx(-0.1 / (0.5 * np.sqrt(0.125 * 200)), rel=2e-3)
    horizon = scene.horizon(start, 4)
    assert horizon.elevation_deg[1] == pytest.approx(np.degrees(np.arctan2(0.1, 100.0)), abs=2e-6)
    # The terrain can be left out in three ways.
    assert scene.line_of_sight(start, end, terrain=False).clear
    scene.add_fragment("ground")
    post.object.fragment = "ground"
    assert scene.line_of_sight(start, end, hide="ground").clear
    assert scene.line_of_sight(start, end, hide=[scene.fragments["ground"]]).clearance == np.inf
    post.object.visible = False
    assert scene.line_of_sight(start, end).clear


def test_objects_block_and_limit_lines_and_make_horizons(scene):
    mast = scene.add_frame("mast", position=(0.0, 0.0, 1.0))
    box = scene.add_box((2.0, 2.0, 4.0), name="box", position=(10.0, 0.0, 0.0))  # to z = 2
    ends = np.array([(20.0, 0.0, 1.0), (20.0, 0.0, 9.0), (5.0, 0.0, 1.0)])
    lines = scene.line_of_sight("mast", ends)
    assert lines.clear.tolist() == [False, True, True]
    assert lines.object[0] == box and lines.object[1] is None and lines.terrain.tolist() == ["", "", ""]
    np.testing.assert_allclose(lines.point[0], (9.0, 0.0, 1.0), atol=1e-12)
    assert lines.distance[0] == pytest.approx(9.0) and lines.clearance[0] == 0.0
    # The upper edge at x = 9 and the line that rises by 0.4: nearest where the perpendicular meets it.
    assert lines.clearance[1] == pytest.approx(abs(0.4 * 9 + 1 - 2) / np.hypot(1, 0.4), abs=1e-9)
    assert lines.clearance[2] == pytest.approx(4.0, abs=1e-9)
    assert scene.line_of_sight(mast, ends[0], without=box).clear
    assert scene.line_of_sight(mast, ends[0], without=["box"]).clear
    assert scene.line_of_sight(mast, ends[0], objects=False).clear
    assert scene.line_of_sight((0.0, 0.0, 0.0), (20.0, 0.0, 0.0), frame=mast).object == box
    fast = scene.line_of_sight(mast, ends, clearance=False)
    assert np.isnan(fast.clearance).all() and fast.clear.tolist() == lines.clear.tolist()
    horizon = scene.horizon(mast, 360)
    assert horizon.elevation_deg[90] == pytest.approx(np.degrees(np.arctan2(1.0, 9.0)), abs=1e-9)
    assert horizon.object[90] == box and horizon.object[0] is None
    assert horizon.elevation_deg[270] == -90 and horizon.distance[270] == np.inf
    across = int(np.degrees(np.arctan2(1.0, 9.0)))  # the corners of the near face
    assert [k for k in range(360) if horizon.object[k] is not None] == list(range(90 - across, 91 + across))
    scene.add_sphere(0.5, name="ball", position=(0.0, 5.0, 1.0), ornamental=True)
    assert scene.horizon(mast, 4).object[0] is None  # ornaments hide nothing


def smooth_ball(scene, tmp_path, radius):
    path = tmp_path / "ball.tif"
    data = gdal.GetDriverByName("GTiff").Create(str(path), 96, 48, 1, gdal.GDT_Float32)
    data.SetGeoTransform((-180, 3.75, 0, 90, 0, -3.75))
    data.SetProjection(f'GEOGCS["m",DATUM["m",SPHEROID["m",{radius},0]],PRIMEM["G",0],UNIT["degree",0.0174532925199433]]')
    data.SetMetadataItem("VERTICAL_DATUM", "sphere")
    data.GetRasterBand(1).WriteArray(np.zeros((48, 96), np.float32))
    data = None
    with pytest.warns(dspace.DspaceWarning, match="suspiciously small"):
        return scene.add_terrain(path, name="ball", on_body=True)


def test_masts_on_a_sphere_see_each_other_as_far_as_the_bulge_lets_them(scene, tmp_path):
    a, height = 1737400.0, 15.0
    ball = smooth_ball(scene, tmp_path, a)
    most = np.degrees(2 * np.arccos(a / (a + height)))
    share = np.array([0.3, 0.9, 0.999, 1.001, 1.2])
    lines = scene.line_of_sight(ball.site(20.0, 0.0, height), ball.site(20.0 + share * most, 0.0, height))
    assert lines.clear.tolist() == [True, True, True, False, False]
    middle = (a + height) * np.cos(np.radians(share * most / 2)) - a
    np.testing.assert_allclose(lines.clearance, middle, atol=2e-3)  # chords of posts: a millimetre
    dip = np.degrees(np.arccos(a / (a + height)))
    np.testing.assert_allclose(scene.horizon(ball.site(20.0, 0.0, height), 8).elevation_deg, -dip, atol=2e-5)


def test_a_target_as_far_as_the_earth_is_seen_down_to_the_dip(scene, tmp_path):
    a, height = 1737400.0, 100.0
    ball = smooth_ball(scene, tmp_path, a)
    site = ball.site(20.0, 0.0, height)
    place = scene.horizon(site, 1).place
    up = place / np.linalg.norm(place)
    north = np.array((0.0, 0.0, 1.0))
    dip = np.degrees(np.arccos(a / (a + height)))
    elevation = np.array([-dip - 0.01, -dip + 0.01, 0.0, 30.0])
    targets = place + 3.844e8 * (np.cos(np.radians(elevation))[:, None] * north + np.sin(np.radians(elevation))[:, None] * up)
    lines = scene.line_of_sight(site, targets, wavelength=0.036)
    assert lines.clear.tolist() == [False, True, True, True]
    np.testing.assert_allclose(lines.clearance_deg, elevation + dip, atol=2e-5)
    # The tangent touches the sphere: a line that is lower by an angle is deeper by that angle times the distance.
    assert lines.clearance[0] < 0 < lines.clearance[1] and lines.clearance[2] == pytest.approx(height, abs=2e-3)


def test_a_served_scene_answers_alike(anywhere, tmp_path):
    scene = anywhere.scene()
    scene.add_frame("mast", position=(0.0, 0.0, 1.0))
    scene.add_box((2.0, 2.0, 4.0), name="box", position=(10.0, 0.0, 0.0))
    line = scene.line_of_sight("mast", (20.0, 0.0, 1.0))
    assert not line.clear and line.object.name == "box" and "blocked by object 'box'" in repr(line)
    assert scene.horizon("mast", 4).elevation_deg[1] == pytest.approx(np.degrees(np.arctan2(1.0, 9.0)))


def test_bodies_are_left_out_with_a_warning(scene):
    scene.add_body("moon", position=(4e8, 0, 0))
    with pytest.warns(dspace.DspaceWarning, match="object 'moon': it has no triangles, so it is no obstacle"):
        assert scene.line_of_sight((0, 0, 0), (8e8, 0, 0)).clear
