"""Range sensors through Python: closed forms, every triangle by numpy, a march over a body, files."""
import struct

import numpy as np
import pytest

import dspace
from dspace.measure import scans
from terrain_support import between_posts, gdal, real, write_raster

R = 3396190.0  # [m] of the sphere of Mars's heights
MM = 1e-3


def moller(origin, direction, a, b, c):
    """The least t of the triangles that the ray crosses; infinity: none."""
    with np.errstate(divide="ignore", invalid="ignore"):
        ab, ac = b - a, c - a
        p = np.cross(direction, ac)
        det = np.einsum("ni,ni->n", ab, p)
        s = origin - a
        u = np.einsum("ni,ni->n", s, p) / det
        q = np.cross(s, ab)
        v = np.einsum("i,ni->n", direction, q) / det
        t = np.einsum("ni,ni->n", ac, q) / det
    t = t[(u >= -1e-12) & (v >= -1e-12) & (u + v <= 1 + 1e-12) & (t > 0)]
    return t.min() if t.size else np.inf


def random_directions(count, low, high, seed=3):
    """Unit vectors with elevations from low to high [deg]."""
    random = np.random.default_rng(seed)
    azimuth, elevation = random.uniform(0, 2 * np.pi, count), np.radians(random.uniform(low, high, count))
    return np.column_stack((np.sin(azimuth) * np.cos(elevation), np.cos(azimuth) * np.cos(elevation), np.sin(elevation)))


def ball(radius, steps=256):
    """Vertices and triangles of a sphere: facets are up to radius * (pi / steps)**2 / 2 inside it."""
    u, v = np.meshgrid(np.linspace(0, 2 * np.pi, 2 * steps + 1), np.linspace(0, np.pi, steps + 1))
    points = radius * np.stack((np.sin(v) * np.cos(u), np.sin(v) * np.sin(u), np.cos(v)), axis=-1).reshape(-1, 3)
    i = (np.arange(steps)[:, None] * (2 * steps + 1) + np.arange(2 * steps)).ravel()
    j = i + 2 * steps + 1
    return points, np.concatenate((np.column_stack((i, j, i + 1)), np.column_stack((i + 1, j, j + 1))))


def test_a_grid_of_beams_in_a_room_in_a_turned_frame(scene):
    """Azimuths are clockwise from the frame's Y, elevations towards its Z; walls of a box, in closed form."""
    turn = np.radians(30.0)
    frame = scene.add_frame("mast", position=(100.0, 200.0, 50.0), quaternion=(np.cos(turn / 2), 0.0, 0.0, np.sin(turn / 2)))
    for axis, sign in ((0, 1), (0, -1), (1, 1), (1, -1), (2, 1), (2, -1)):  # walls at 5, 6 and 2 m along X, Y, Z
        half = np.array((5.0, 6.0, 2.0))
        center, size = np.zeros(3), 2 * half + 2
        center[axis], size[axis] = sign * (half[axis] + 0.5), 1.0
        scene.add_box(size, frame=frame, position=center, name=f"wall {'xyz'[axis]}{sign:+d}")
    azimuth, elevation = np.arange(-180.0, 180.0, 7.0), np.array((-60.0, -10.0, 0.0, 33.0, 90.0))
    scan = scene.scan(dspace.Lidar(azimuth, elevation), frame="mast")
    assert scan.range.shape == (5, azimuth.size) and scan.point.shape == (5, azimuth.size, 3)
    a, e = np.radians(azimuth), np.radians(elevation)[:, None]
    local = np.stack(np.broadcast_arrays(np.sin(a) * np.cos(e), np.cos(a) * np.cos(e), np.sin(e)), axis=-1)
    with np.errstate(divide="ignore"):
        to_walls = np.array((5.0, 6.0, 2.0)) / np.abs(local)
    np.testing.assert_allclose(scan.range, to_walls.min(axis=-1), atol=1e-9)
    np.testing.assert_array_equal(scan.range, scan.true_range)
    np.testing.assert_allclose(scan.local_point, local * to_walls.min(axis=-1)[..., None], atol=1e-9)
    axis = to_walls.argmin(axis=-1)
    expected = np.take_along_axis(np.abs(local), axis[..., None], -1)[..., 0]
    np.testing.assert_allclose(np.cos(np.radians(scan.incidence_deg)), expected, atol=1e-9)
    names = np.array([["xyz"[k] for k in row] for row in axis])
    seen = np.array([[scan.names[id][5] for id in row] for row in scan.object])
    assert (names == seen)[:4].all()
    np.testing.assert_allclose(np.sum(scan.normal * scan.direction, axis=-1), -expected, atol=1e-9)
    np.testing.assert_allclose(scan.position, (100.0, 200.0, 50.0))
    assert len(scan) == scan.range.size and set(scan.fragments.values()) == {"physical"}


def test_a_plane_and_a_sphere_to_a_millimetre(scene):
    points, triangles = ball(2.0)
    sphere = scene.add_mesh(points, triangles, name="ball", position=(3.0, 10.0, -1.0), color="#808080")
    plane = scene.add_plane(4000.0, 4000.0, position=(0, 0, -5.0), name="floor", color="white")
    aimed = np.array((3.0, 10.0, -1.0)) + np.random.default_rng(0).uniform(-2.6, 2.6, (400, 3))
    directions = np.concatenate((aimed, random_directions(300, -80, 20)))
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    scan = scene.scan(dspace.Lidar.of_directions(directions, maximum_range=1000.0))
    b = directions @ (3.0, 10.0, -1.0)
    inside = b * b - 110.0 + 4.0
    with np.errstate(invalid="ignore", divide="ignore"):
        to_ball = np.where((inside > 0) & (b > 0), b - np.sqrt(inside), np.inf)
        to_floor = np.where(directions[:, 2] < 0, -5.0 / directions[:, 2], np.inf)
    expected = np.minimum(to_ball, to_floor)
    clear = np.abs(inside) > 0.05  # rays that graze the sphere may miss its facets
    found = np.where(scan.outcome == 0, scan.range, np.inf)
    expected[expected > 1000.0] = np.inf
    assert clear.sum() > 600 and np.isinf(expected[clear]).any()
    np.testing.assert_allclose(found[clear], expected[clear], atol=MM)
    on_ball = clear & (to_ball < to_floor)
    assert on_ball.sum() > 100 and (scan.object[on_ball] == sphere.id).all()
    assert (scan.object[clear & (expected == to_floor) & np.isfinite(expected)] == plane.id).all()
    normal = (scan.point[on_ball] - (3.0, 10.0, -1.0)) / 2.0
    np.testing.assert_allclose(scan.normal[on_ball], normal, atol=0.02)
    # Intensity: albedo cos / r^2; '#808080' is 0.2158605 in linear light.
    cosine = np.abs(np.sum(scan.normal * scan.direction, axis=-1))
    albedo = np.where(scan.object == sphere.id, 0.21586050, 1.0)
    hit = scan.outcome == 0
    np.testing.assert_allclose(scan.intensity[hit], (albedo * cosine / scan.range**2)[hit], rtol=1e-6)
    assert np.isnan(scan.intensity[~hit]).all() and (scan.object[~hit] == 0).all()


@pytest.mark.parametrize("mode", ["triangles", "clipmap"])
def test_real_ground_on_a_plane_against_every_triangle(scene, tmp_path, mode):
    """A window of Gale as a plane of posts 463 m apart."""
    z = gdal.Open(str(real("mars_gale_mola_128ppd_m.tif"))).ReadAsArray()[300:420, 380:520].astype(np.float32)
    pixel = 463.0
    ground = scene.add_terrain(write_raster(tmp_path / "gale.tif", z, pixel), name="gale", mode=mode, pixel_size=pixel)
    site = ground.site(70.3 * pixel, 60.8 * pixel, 500.0)
    directions = random_directions(150, -12, 4)
    scan = scene.scan(dspace.Lidar.of_directions(directions), site=site)
    rows, columns = z.shape
    c, r = np.meshgrid(np.arange(columns), np.arange(rows))
    p = np.stack((pixel * (c + 0.5), pixel * (rows - r - 0.5), z.astype(float)), axis=-1)
    nw, ne, sw, se = p[:-1, :-1], p[:-1, 1:], p[1:, :-1], p[1:, 1:]
    a, b, c = (np.concatenate(pair).reshape(-1, 3) for pair in ((nw, nw), (sw, se), (se, ne)))
    eye = np.array((70.3 * pixel, 60.8 * pixel, ground.height(70.3 * pixel, 60.8 * pixel, map=True) + 500.0))
    hits = 0
    for direction, found, outcome, label in zip(directions, scan.range, scan.outcome, scan.object):
        expected = moller(eye, direction, a, b, c)
        assert (outcome == 0) == np.isfinite(expected)
        if outcome == 0:
            hits += 1
            assert found == pytest.approx(expected, abs=MM) and scan.names[label] == "gale"
    assert 40 < hits < 150


def test_real_ground_on_its_body_against_a_march(scene):
    """Gale on the sphere of Mars: the heights along each ray from GDAL's array, bisected."""
    path = real("mars_gale_mola_128ppd_m.tif")
    data = gdal.Open(str(path))
    z = data.ReadAsArray().astype(float)
    x0, dx, _, y0, _, dy = data.GetGeoTransform()
    ground = scene.add_terrain(path, name="gale", on_body=True, vertical_datum="areoid", vertical_scale=1.0)
    scan = scene.scan(dspace.Lidar(np.arange(0.0, 360.0, 15.0), (-6.0, -1.5, 2.5)), site=ground.site(137.4417, -4.5895, 100.0))

    def above(direction, t):
        p = scan.position + np.multiply.outer(t, direction)
        r = np.linalg.norm(p, axis=-1)
        column = (np.degrees(np.arctan2(p[..., 1], p[..., 0])) % 360.0 - x0) / dx - 0.5
        row = (np.degrees(np.arcsin(p[..., 2] / r)) - y0) / dy - 0.5
        off = (column < 0) | (row < 0) | (column > z.shape[1] - 1) | (row > z.shape[0] - 1)
        return np.where(off, np.inf, r - R - between_posts(z, column, row))

    hits = 0
    for direction, found in zip(scan.direction.reshape(-1, 3), scan.range.ravel()):
        t = np.arange(0.0, 250e3, 20.0)
        below = np.nonzero(above(direction, t) < 0)[0]
        if not below.size:
            assert np.isnan(found)
            continue
        low, high = t[below[0] - 1], t[below[0]]
        while high - low > 1e-5:
            middle = 0.5 * (low + high)
            low, high = (low, middle) if above(direction, middle) < 0 else (middle, high)
        hits += 1
        assert found == pytest.approx(high, abs=MM)
    assert 40 < hits < 72
    # At a site, azimuth 0 is north and elevations are over the local horizontal.
    up = scan.position / np.linalg.norm(scan.position)
    assert np.degrees(np.arcsin(scan.direction[0, 0] @ up)) == pytest.approx(-6.0, abs=1e-6)
    assert scan.direction[0, 0, 2] > 0.98


def test_a_rut_is_seen(scene, field):
    ground = scene.add_terrain(field, subdivisions=5)  # z = x / 2
    x = np.linspace(-3.9, -3.1, 41)
    target = np.column_stack((x, np.full(41, 3.0), x / 2))
    scene.add_frame("lidar", position=(-3.5, 3.0, 4.0))
    lidar = dspace.Lidar.of_directions(target - (-3.5, 3.0, 4.0))
    before = scene.scan(lidar, frame="lidar")
    np.testing.assert_allclose(before.point, target, atol=1e-6)
    ground.track({"wheel": [(-4.0, 3.0), (-3.0, 3.0)]}, width=0.2, sinkage=0.05)
    scan = scene.scan(lidar, frame="lidar")
    # The rut's bottom is the plane z = x / 2 - 0.05, in closed form.
    d = scan.direction
    expected = (4.0 - (-3.5) / 2 + 0.05) / (d[:, 0] / 2 - d[:, 2])
    np.testing.assert_allclose(scan.range, expected, atol=MM)
    assert (scan.range - before.range > 0.03).all()
    assert set(scan.names.values()) == {ground.name}


def test_what_beams_do_not_meet(scene):
    parts = scene.add_fragment("parts")
    near = scene.add_box((1, 1, 1), position=(0, 3, 0), name="near", fragment=parts)
    scene.add_box((1, 1, 1), position=(0, 6, 0), name="mark", ornamental=True)
    far = scene.add_box((1, 1, 1), position=(0, 9, 0), name="far")
    lidar = dspace.Lidar(0.0)
    scan = scene.scan(lidar)
    assert scan.range[0, 0] == pytest.approx(2.5) and scan.names == {near.id: "near"} and scan.fragments == {near.id: "parts"}
    for change in (dict(without="near"), dict(without=[near]), dict(hide=[parts]), dict(hide="parts")):
        scan = scene.scan(lidar, **change)
        assert scan.range[0, 0] == pytest.approx(8.5) and scan.object[0, 0] == far.id
    scan = scene.scan(lidar, objects=False)
    assert scan.outcome[0, 0] == 1 and np.isnan(scan.range[0, 0]) and np.isnan(scan.point).all() and scan.names == {}
    scan = scene.scan(dspace.Lidar(0.0, minimum_range=3.0))
    assert scan.OUTCOMES[scan.outcome[0, 0]] == "too near"
    scan = scene.scan(dspace.Lidar(0.0, minimum_range=3.0), without=near)
    assert scan.range[0, 0] == pytest.approx(8.5)


LENSES = {
    "pinhole": dict(type="pinhole", focal=(40, 42), center=(15.5, 11.5)),
    "equidistant": dict(type="equidistant", focal=(12, 12), center=(15.5, 11.5)),
    "cahvore": dict(type="cahvore", C=(0, 0, 0), A=(0, 0, 1), H=(30, 0, 15.5), V=(0, 30, 11.5), O=(0, 0, 1), R=(0, 0, 0),
                    E=(0.01, 0, 0), linearity=0),
}


@pytest.mark.parametrize("name", LENSES)
def test_a_flash_lidar_through_a_lens(scene, name):
    """A wall 6 m ahead: from each pixel's own pupil, where the lens puts the ray."""
    model = dspace.CameraModel(size=(32, 24), **LENSES[name])
    scene.add_plane(1000, 1000, position=(0, 0, 6.0))
    camera = scene.add_camera("eye")
    camera.attach(scene.root)
    origins, directions = model.rays(np.stack(np.meshgrid(np.arange(32.0), np.arange(24.0)), axis=-1), in_camera=True)
    expected = (6.0 - origins[..., 2]) / directions[..., 2]
    ahead = np.where(expected > 0, expected, np.nan)
    for scan in (scene.scan(dspace.Lidar.flash(model), camera=camera), scene.scan(dspace.Lidar.flash(model), frame=scene.root)):
        assert scan.range.shape == (24, 32)
        far = ahead < 400
        np.testing.assert_allclose(scan.range[far], ahead[far], atol=1e-9)
        np.testing.assert_allclose(scan.direction, directions, atol=1e-12)
        np.testing.assert_allclose(scan.local_point[far], (origins + ahead[..., None] * directions)[far], atol=1e-9)
    grid = scene.scan(dspace.Lidar((0.0, 30.0), (0.0, -20.0)), camera=camera)  # azimuth 0 is ahead, 90 to the right
    up, right = np.radians(-20.0), np.radians(30.0)
    np.testing.assert_allclose(grid.direction[1, 1], (np.sin(right) * np.cos(up), -np.sin(up), np.cos(right) * np.cos(up)),
                               atol=1e-12)
    np.testing.assert_allclose(grid.range[0], (6.0, 6.0 / np.cos(right)), atol=1e-9)


def test_a_flash_lidar_of_a_scenes_camera(scene):
    scene.add_plane(1000, 1000)
    camera = scene.add_camera("eye", eye=(0, 0, 9), target=(0, 0, 0), up=(0, 1, 0), fov_deg=30)
    scan = scene.scan(dspace.Lidar.flash(size=(8, 6)), camera=camera)
    y = (np.arange(6) - 2.5) * 2 * np.tan(np.radians(15)) / 6
    x = (np.arange(8) - 3.5) * 2 * np.tan(np.radians(15)) / 6
    np.testing.assert_allclose(scan.range, 9.0 * np.sqrt(1 + x[None, :]**2 + y[:, None]**2), atol=1e-9)


def test_an_altimeter_over_a_slope(scene, tmp_path):
    """A plane that rises by 20 degrees: the least range in a cone of half angle a is h cos(20) / cos(20 - a)."""
    x = 2.0 * (np.arange(200) + 0.5)
    z = np.broadcast_to(np.tan(np.radians(20.0)) * x, (200, 200)).astype(np.float32)
    ground = scene.add_terrain(write_raster(tmp_path / "slope.tif", z, 2.0), pixel_size=2.0)
    site = ground.site(200.0, 200.0, 50.0)
    for width in (0.0, 4.0, 20.0, 60.0):
        off = max(20.0 - width / 2, 0.0)
        scan = scene.scan(dspace.Altimeter(width), site=site)
        assert isinstance(float(scan.range), float) and np.shape(scan.range) == ()
        assert scan.range == pytest.approx(50.0 * np.cos(np.radians(20)) / np.cos(np.radians(off)), abs=MM), width
    assert "beam of 4 deg" in repr(dspace.Altimeter(4.0))


def test_one_beam_on_two_surfaces(scene):
    scene.add_box((10, 1, 10), position=(5, 10.5, 0), name="near")  # its edge is on the beam's axis
    scene.add_box((40, 1, 40), position=(0, 20.5, 0), name="far")
    found = {report: scene.scan(dspace.Lidar(0.0, divergence_deg=1.0, rays=500, report=report))
             for report in ("first", "last", "mean")}
    first, last, mean = (found[report].range[0, 0] for report in ("first", "last", "mean"))
    assert first == pytest.approx(10.0, abs=2 * MM) and last == pytest.approx(20.0, abs=2 * MM)
    assert mean == pytest.approx((10 / 100 + 20 / 400) / (1 / 100 + 1 / 400), abs=0.05)  # of light that falls with 1 / r^2
    assert [list(found[r].names.values()) for r in ("first", "last")] == [["near"], ["far"]]


def test_noise_is_the_same_for_a_seed_whatever_the_parts(scene, monkeypatch):
    scene.add_plane(1000, 1000)
    scene.add_frame("lidar", position=(0, 0, 10))
    directions = np.broadcast_to((0.0, 0.0, -1.0), (20000, 3))
    lidar = dspace.Lidar.of_directions(directions, noise=0.03, noise_fraction=0.004, drop_out=0.1)
    scan = scene.scan(lidar, frame="lidar", seed=11)
    error = scan.range[scan.outcome == 0] - 10.0
    assert np.isin(scan.outcome, (0, 5)).all()
    assert np.mean(scan.outcome == 5) == pytest.approx(0.1, abs=5 * 0.3 / np.sqrt(20000))
    assert error.mean() == pytest.approx(0.0, abs=5 * 0.05 / np.sqrt(error.size))
    assert error.std() == pytest.approx(0.05, rel=5 / np.sqrt(2 * error.size))
    monkeypatch.setattr(scans, "FIRST", 777)
    monkeypatch.setattr(scans, "MOST", 1001)
    done = []
    again = scene.scan(lidar, frame="lidar", seed=11, progress=done.append)
    for name in scans.WIDTHS:
        np.testing.assert_array_equal(getattr(scan, name), getattr(again, name))
    assert len(done) > 15 and done == sorted(done) and done[-1] == 1.0
    for other in (dict(seed=12), dict(seed=11, number=1)):
        both = np.stack((scene.scan(lidar, frame="lidar", **other).range, scan.range))
        known = np.isfinite(both).all(axis=0)
        assert known.mean() == pytest.approx(0.81, abs=0.02) and (both[0] != both[1])[known].mean() > 0.99
    grid = dspace.Lidar(np.zeros(100), np.full(100, -90.0), noise=0.05)
    whole = scene.scan(grid, frame="lidar").range
    monkeypatch.setattr(scans, "FIRST", 10000)
    monkeypatch.setattr(scans, "MOST", 10000)
    np.testing.assert_array_equal(whole, scene.scan(grid, frame="lidar").range)


def test_a_scan_anywhere(anywhere):
    scene = anywhere.scene()
    scene.add_box((1, 1, 1), position=(0, 3, 0), name="near")
    scan = scene.scan(dspace.Lidar((-5.0, 0.0, 5.0), (0.0, 40.0), noise=0.01), seed=3)
    np.testing.assert_allclose(scan.true_range[0], 2.5 / np.cos(np.radians((-5.0, 0.0, 5.0))), atol=1e-9)
    assert (scan.outcome[1] == 1).all() and 0 < np.abs(scan.range - scan.true_range)[0].max() < 0.06
    assert repr(scan).startswith("<dspace.RangeScan 3 echoes of 6 beams, 2.")


def test_files(scene, tmp_path):
    scene.add_box((1, 1, 1), position=(0, 3, 0), name='a "near", box')
    scan = scene.scan(dspace.Lidar((-5.0, 0.0, 60.0)))
    scan.save(tmp_path / "scan.ply")
    head, _, body = (tmp_path / "scan.ply").read_bytes().partition(b"end_header\n")
    lines = head.decode().splitlines()
    assert lines[:2] == ["ply", "format binary_little_endian 1.0"] and "element vertex 2" in lines
    kinds = {"double": "d", "float": "f", "uint": "I"}
    words = [line.split()[1:] for line in lines if line.startswith("property")]
    rows = list(struct.iter_unpack("<" + "".join(kinds[kind] for kind, _ in words), body))
    assert len(rows) == 2
    for row, i in zip(rows, (0, 1)):
        values = dict(zip((name for _, name in words), row))
        np.testing.assert_array_equal([values[axis] for axis in "xyz"], scan.point[0, i])
        np.testing.assert_allclose([values[f"n{axis}"] for axis in "xyz"], (0, -1, 0), atol=1e-7)
        assert values["range"] == scan.range[0, i] and values["object"] == scan.object[0, i] and values["beam"] == i
    from vtkmodules.vtkIOPLY import vtkPLYReader  # somebody else's
    reader = vtkPLYReader()
    reader.SetFileName(str(tmp_path / "scan.ply"))
    reader.Update()
    assert reader.GetOutput().GetNumberOfPoints() == 2
    np.testing.assert_allclose(reader.GetOutput().GetPoint(1), (0, 2.5, 0), atol=1e-6)
    scan.save(tmp_path / "scan.csv")
    import csv
    with open(tmp_path / "scan.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [row["outcome"] for row in rows] == ["echo", "echo", "nothing"]
    assert float(rows[0]["range"]) == scan.range[0, 0] and rows[2]["range"] == "" and rows[2]["name"] == ""
    assert rows[1]["name"] == 'a "near", box' and rows[1]["fragment"] == "physical"
    with pytest.raises(dspace.InvalidArgument, match="accepted: a name with .ply or .csv"):
        scan.save(tmp_path / "scan.txt")
    with pytest.raises(dspace.Io):
        scan.save(tmp_path / "absent" / "scan.ply")


@pytest.mark.parametrize("make, kind, text", [
    (lambda: dspace.Lidar([]), dspace.InvalidArgument, "it has no beams"),
    (lambda: dspace.Lidar.of_directions(np.zeros((0, 3))), dspace.InvalidArgument, "it has no beams"),
    (lambda: dspace.Lidar.of_directions([(0.0, 0.0, 0.0)]), dspace.InvalidArgument, "vectors that are not zero"),
    (lambda: dspace.Lidar(361.0), dspace.InvalidArgument, "azimuth_deg is 361.0; accepted: a number or an array (n,) of angles, "
     "-360 to 360"),
    (lambda: dspace.Lidar(0.0, np.nan), dspace.InvalidArgument, "elevation_deg is nan"),
    (lambda: dspace.Lidar(0.0, rays=0), dspace.InvalidArgument, "rays is 0; accepted: 1 to 10000"),
    (lambda: dspace.Lidar(0.0, report="best"), dspace.InvalidArgument, "the report is 'best'"),
    (lambda: dspace.Lidar(0.0, noise="much"), dspace.WrongType, "noise is 'much'"),
    (lambda: dspace.Lidar.flash(), dspace.InvalidArgument, "the size is None"),
    (lambda: dspace.Lidar.flash("lens.json"), dspace.WrongType, "the model is 'lens.json'"),
    (lambda: dspace.Altimeter(4.0, direction=(0, 0, 0)), dspace.InvalidArgument, "three finite numbers that are not all 0"),
])
def test_sensors_that_are_rejected(make, kind, text):
    with pytest.raises(kind) as found:
        make()
    assert text in str(found.value)


def test_scans_that_are_rejected(scene, field, refused):
    ground = scene.add_terrain(field, name="ground")
    scene.add_frame("deep", position=(0, 0, -3))
    lidar = dspace.Lidar(0.0)
    with refused(dspace.InvalidArgument, "the greatest range is 5 m; accepted: above the least one, 10 m"):
        scene.scan(dspace.Lidar(0.0, minimum_range=10.0, maximum_range=5.0), site=ground.site(110, 210, 1))
    with refused(dspace.InvalidArgument, "m below the ground of terrain 'ground'; accepted: places on or above"):
        scene.scan(lidar, frame="deep")
    with refused(dspace.InvalidArgument, "drop_out is 2; accepted: 0 to 1"):
        scene.scan(dspace.Lidar(0.0, drop_out=2), site=ground.site(110, 210, 1))
    with refused(dspace.InvalidArgument, "noise is -1; accepted: 0 to 1000000"):
        scene.scan(dspace.Lidar(0.0, noise=-1), site=ground.site(110, 210, 1))
    with refused(dspace.NotFound, "nowhere"):
        scene.scan(lidar, frame="nowhere")
    with refused(dspace.WrongType, "the sensor is 3; accepted: a dspace.Lidar or a dspace.Altimeter"):
        scene.scan(3)
    with refused(dspace.InvalidArgument, "the seed is -1; accepted: 0 to 2**64 - 1"):
        scene.scan(lidar, seed=-1)
    with refused(dspace.InvalidArgument, "accepted: a frame, a site or a camera"):
        scene.scan(lidar, frame="deep", site=ground.site(110, 210, 1))
    with refused(dspace.DeadlineExceeded, "scan_ranges"):
        scene.scan(dspace.Lidar(np.zeros(1000), np.zeros(900) - 20), site=ground.site(110, 210, 1), deadline=0.01)
    with refused(dspace.InvalidArgument, "deadline_s is 0; accepted: 0.001 on"):
        scene.scan(lidar, site=ground.site(110, 210, 1), deadline=0.0)


def test_a_site_below_which_beams_are_free(scene, field):
    """A sensor on the ground is lifted by a micrometre: level beams over a slope."""
    ground = scene.add_terrain(field, name="ground")
    scan = scene.scan(dspace.Lidar((90.0, 270.0)), site=ground.site(115.5, 216.0, 0.0))
    assert scan.range[0, 0] == pytest.approx(0.0, abs=1e-3)  # uphill
    assert np.isnan(scan.range[0, 1])
