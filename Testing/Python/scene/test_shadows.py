"""Shadows of the Sun in pictures: stillness on flights and through days, viewports, odd views, servers and recordings."""
import numpy as np
import pytest

import dspace
from served_support import Served
from shadow_support import crater, towards
from terrain_support import points_of, write_raster

WHITE = (1, 1, 1)


@pytest.fixture
def ground(tmp_path):
    return write_raster(tmp_path / "crater.tif", crater(side=257, post=0.25, radius=12.0, depth=5.0, rim=1.0), 0.25)


def add_site(scene, ground, mode="clipmap"):
    """A crater, and on its flank a vehicle of boxes with a mast, and a ball."""
    terrain = scene.add_terrain(ground, name="ground", mode=mode, level_size=252, color=WHITE)
    x, y = 16.0, -6.0
    z = terrain.height(x, y)
    vehicle = scene.add_frame("vehicle", position=(x, y, z))
    scene.add_box((1.6, 1.0, 0.4), frame=vehicle, position=(0, 0, 0.7), color=WHITE)
    scene.add_box((0.2, 0.2, 1.4), frame=vehicle, position=(0.5, 0, 1.4), color=WHITE)
    for wx in (-0.6, 0.6):
        for wy in (-0.6, 0.6):
            scene.add_cylinder(0.3, 0.2, frame=vehicle, position=(wx, wy, 0.3), quaternion=(np.sqrt(0.5), np.sqrt(0.5), 0, 0),
                               color=WHITE)
    scene.add_sphere(0.5, position=(x - 2.5, y + 1.5, terrain.height(x - 2.5, y + 1.5) + 0.3), color=WHITE)
    return terrain, np.array((x, y, z))


# --- Stillness -------------------------------------------------------------------------------------

@pytest.mark.parametrize("mode", ["clipmap", "triangles"])
def test_a_place_keeps_its_light_while_a_camera_flies_over_it(scene, ground, mode):
    """An orthographic camera moves by whole pixels in 200 steps: each place of the ground is at a pixel's centre again,
    and its light is that of the picture before."""
    terrain, middle = add_site(scene, ground, mode)
    scene.sun.set(azimuth_deg=250, elevation_deg=12, terrain=terrain)
    size, pixel = (120, 90), 0.07
    camera = scene.add_camera("down", eye=(0, 0, 30), target=(0, 0, 0), up=(0, 1, 0), height=size[1] * pixel, near=1)
    view = scene.add_viewport(size, "down", samples=1)
    view.shadows = True
    walk = np.random.default_rng(11).integers(-2, 3, (200, 2))
    at, before = np.zeros(2, int), None
    compared = moved = 0
    shaded = []
    for step in walk:
        at = np.clip(at + step, -40, 40)
        step = at - (before[0] if before else at)
        eye = middle + np.array([*(at * pixel), 30.0])
        camera.look_at(eye=tuple(eye), target=tuple(eye - (0, 0, 30.0)), up=(0, 1, 0))
        lit = view.lit_fraction()
        if before:
            dx, dy = step[0], -step[1]  # columns to the right, rows down
            h, w = lit.shape
            now = lit[max(0, -dy):h - max(0, dy), max(0, -dx):w - max(0, dx)]
            then = before[1][max(0, dy):h - max(0, -dy), max(0, dx):w - max(0, -dx)]
            off = np.abs(now - then)
            compared += off.size
            moved += (off > 0.1).sum()
        shaded.append((lit < 0.1).mean())
        before = at.copy(), lit
    assert compared > 1e6 and 0.03 < np.mean(shaded) < 0.7
    assert moved < 1e-5 * compared


def flickers(series, much=0.5):
    """How many pixels of three pictures in a row go and come back."""
    a, b, c = series
    return (np.abs(b - a) > much) & (np.abs(b - c) > much) & (np.abs(c - a) < 0.5 * much)


def test_no_pixel_flickers_on_a_flight(scene, ground):
    terrain, middle = add_site(scene, ground)
    scene.sun.set(azimuth_deg=250, elevation_deg=12, terrain=terrain)
    camera = scene.add_camera("eye", eye=(0, -1, 30), target=(0, 0, 0), fov_deg=50, near=0.1)
    view = scene.add_viewport((160, 120), "eye", samples=1)
    view.shadows = True
    last, labels, pixels, flicker, shaded = [], [], 0, 0, []
    for step in range(200):
        eye = middle + np.array([4.5 - 0.021 * step, -5.0 + 0.017 * step, 2.5 + 0.004 * step])
        camera.look_at(eye=tuple(eye), target=tuple(middle + (0, 0, 0.5)))
        planes = view.capture(False, lit_fraction=True, label=True, physical_only=True)
        last, labels = last[-2:] + [planes["lit_fraction"]], labels[-2:] + [planes["label"]]
        shaded.append((last[-1] < 0.1).mean())
        if len(last) == 3:  # where an object's outline passes, another surface is seen
            same = (labels[0] == labels[1]) & (labels[1] == labels[2]) & (labels[0] != 0)
            pixels += same.sum()
            flicker += (flickers(last) & same).sum()
    assert 0.03 < np.mean(shaded) < 0.7
    assert flicker < 2e-4 * pixels


def test_a_day(scene, ground):
    """The Sun goes over the sky in 500 steps, from night to night."""
    terrain, middle = add_site(scene, ground)
    eye = middle + (-9.0, -9.0, 9.0)
    scene.add_camera("eye", eye=tuple(eye), target=tuple(middle + (-2.0, 0.0, 0.0)), fov_deg=60, near=0.1)
    view = scene.add_viewport((96, 72), "eye", samples=1)
    view.set(shadows=True, fill=0.0)
    labels = view.labels()
    there, soil = labels != 0, labels == terrain.object.id
    means, last, flicker, pixels, nights, leaks = [], [], 0, 0, 0, 0
    for step in range(500):
        hour = np.pi * (step - 25) / 450
        elevation = 60 * np.sin(hour)
        scene.sun.set(azimuth_deg=80 + 200 * step / 500, elevation_deg=elevation, terrain=terrain)
        planes = view.capture(lit_fraction=True, label=True, physical_only=True)
        lit = planes["lit_fraction"][there]
        assert np.isfinite(lit).all() and lit.min() >= 0 and lit.max() <= 1
        means.append(lit.mean())
        last = last[-2:] + [lit]
        if len(last) == 3:
            flicker += flickers(last).sum()
            pixels += lit.size
        if elevation < -0.3:  # below the horizon of level ground, with its disc
            nights += 1
            np.testing.assert_array_equal(planes["label"], labels)
            assert not planes["color"][soil][:, :3].any() and not planes["lit_fraction"][soil].any()
            # Ground has no side: at the raster's edge light from below passes under it, and reaches the vehicle.
            leaks = max(leaks, (lit > 0).sum())
            assert leaks <= 0.002 * lit.size
            assert elevation > -8 or not (lit > 0).any(), (lit > 0).sum()
    means = np.array(means)
    jump = np.abs(np.diff(means))
    high = 60 * np.sin(np.pi * (np.arange(499) - 24.5) / 450)
    away = np.abs(high) > 4.0  # at sunrise a step is nearly as long as the disc is wide, and level ground turns light
    assert nights > 20 and means[0] == means[-1] == 0 and means.max() > 0.9
    assert jump[away].max() < 0.05
    assert flicker < 2e-4 * pixels


# --- Viewports, sizes, and the Sun anywhere ----------------------------------------------------------

def test_two_viewports_of_a_scene_have_their_own_settings(scene, ground):
    """Pictures taken by turns are those of each alone, to the byte."""
    terrain, middle = add_site(scene, ground)
    scene.sun.set(azimuth_deg=250, elevation_deg=12, terrain=terrain)
    scene.add_camera("eye", eye=tuple(middle + (4, -6, 3)), target=tuple(middle), fov_deg=50, near=0.1)
    settings = [dict(shadows=False), dict(shadows=True), dict(shadows=True, shadow_cascades=2, shadow_map_size=512),
                dict(shadows=True, shadow_distance=5.0, cascade_colors=True)]

    def view_with(values, size=(121, 83)):
        view = scene.add_viewport(size, "eye", samples=1)
        view.set(**values)
        return view

    alone = []
    for values in settings:
        view = view_with(values)
        alone.append(view.image().copy())
        view.remove()
    for i in range(len(alone)):
        for j in range(i):
            assert (alone[i] != alone[j]).any(axis=2).mean() > 0.003, (i, j)
    views = [view_with(values) for values in settings]
    for order in ((0, 1, 2, 3), (3, 2, 1, 0), (1, 3, 0, 2)):
        for i in order:
            np.testing.assert_array_equal(views[i].image(), alone[i])
    views[1].shadows = False
    np.testing.assert_array_equal(views[1].image(), alone[0])


def add_table(scene):
    """A plate 2 m by 1.2 m on one foot, 1 m above a plane."""
    scene.add_plane(60, 60, color=WHITE, name="floor")
    scene.add_box((2.0, 1.2, 0.1), position=(0, 0, 1.05), color=WHITE, name="plate")
    scene.add_box((0.1, 0.1, 1.0), position=(0, 0, 0.5), color=WHITE, name="foot")
    return scene.objects["floor"].id


def table_lit(points, to_sun, count=60):
    """The part of the disc that places on the floor (n, 3) see past the table, by rays to points of it."""
    from shadow_support import disc
    lit = np.ones((len(points), count), bool)
    rays = disc(to_sun, count)
    with np.errstate(divide="ignore", invalid="ignore"):
        for low, high in (((-1.0, -0.6, 1.0), (1.0, 0.6, 1.1)), ((-0.05, -0.05, 0.0), (0.05, 0.05, 1.0))):
            a = (np.array(low) - points)[:, None] / rays[None]
            b = (np.array(high) - points)[:, None] / rays[None]
            first, last = np.minimum(a, b).max(axis=2), np.maximum(a, b).min(axis=2)
            lit &= ~((first < last) & (last > 1e-9))
    return lit.mean(axis=1)


@pytest.mark.parametrize("size", [(1, 1), (3, 211), (161, 91), (319, 7), (97, 201)])
def test_odd_sizes(scene, size):
    floor = add_table(scene)
    to_sun = towards(200, 35)
    scene.sun.set(direction=to_sun)
    eye, target = (-3.0, 4.0, 2.5), (0.3, 0.8, 0.0)  # its middle is in the plate's shadow
    scene.add_camera("eye", eye=eye, target=target, fov_deg=50, near=0.1)
    view = scene.add_viewport(size, "eye", samples=1)
    planes = view.capture(False, depth=True, label=True, lit_fraction=True, physical_only=True)
    assert planes["lit_fraction"].shape == (size[1], size[0])
    points, _ = points_of(planes["depth"], eye, target, 50)
    seen = planes["label"] == floor
    exact = table_lit(points[seen], to_sun)
    off = np.abs(planes["lit_fraction"][seen] - exact)
    assert (off > 0.25).sum() <= 0.005 * off.size + 1
    assert off.mean() < 0.01
    if min(size) > 50:
        assert (exact < 0.1).mean() > 0.02


@pytest.mark.parametrize("height", [None, 6.0], ids=["perspective", "parallel"])
def test_the_sun_along_the_camera_at_the_zenith_and_at_the_nadir(scene, height):
    floor = add_table(scene)
    eye = np.array((-3.0, -2.0, 4.0))
    scene.add_camera("eye", eye=tuple(eye), target=(0, 0, 0), near=0.1, **({"fov_deg": 50} if height is None else {"height": height}))
    view = scene.add_viewport((160, 120), "eye", samples=1)
    view.set(shadows=True, fill=0.0)

    def pictures():
        planes = view.capture(label=True, lit_fraction=True, physical_only=True)
        return planes["color"][..., :3], planes["lit_fraction"], planes["label"]

    scene.sun.set(direction=eye)  # behind the camera: every shadow is hidden, but for the disc's width and perspective
    color, lit, label = pictures()
    assert (lit[label == floor] < 0.25).mean() < (0.1 if height is None else 0.005)
    scene.sun.set(direction=-eye + (0, 0, 2 * eye[2]))  # and before it, as high: a shadow towards the camera
    color, lit, label = pictures()
    assert 0.02 < (lit[label == floor] < 0.25).mean() < 0.5
    scene.sun.set(direction=(0, 0, 1))
    color, lit, label = pictures()
    place = dict(zip(("y", "x"), np.nonzero(label == floor)))
    points = np.array([np.append(on_floor(eye, x, y, height), 0.0) for x, y in zip(place["x"][::7], place["y"][::7])])
    exact = table_lit(points, np.array((0, 0, 1.0)))
    off = np.abs(lit[place["y"], place["x"]][::7] - exact)
    assert (exact == 0).sum() > 20 and (off > 0.25).mean() < 0.005 and off.mean() < 0.01
    scene.sun.set(direction=(0, 0, -1))
    color, lit, label = pictures()
    assert (label == floor).mean() > 0.5  # night is drawn
    assert not lit[label == floor].any() and not color[label == floor].any()


def on_floor(eye, x, y, height, size=(160, 120), fov_deg=50):
    """x, y where the ray of a pixel meets z = 0; the camera looks at the origin."""
    forward = -eye / np.linalg.norm(eye)
    right = np.cross(forward, (0, 0, 1))
    right /= np.linalg.norm(right)
    down = np.cross(forward, right)
    pixel = (height or 2 * np.tan(np.radians(fov_deg) / 2)) / size[1]
    aside = (x + 0.5 - size[0] / 2) * pixel * right + (y + 0.5 - size[1] / 2) * pixel * down
    start, along = (eye, forward + aside) if height is None else (eye + aside, forward)
    return (start - start[2] / along[2] * along)[:2]


# --- Servers and recordings --------------------------------------------------------------------------

def drive(session, ground):
    """A vehicle that drives under a moving Sun. Returns pictures as bytes."""
    scene = session.scene()
    terrain, middle = add_site(scene, ground)
    scene.add_camera("eye", eye=tuple(middle + (5, -6, 3)), target=tuple(middle), fov_deg=50, near=0.1)
    view = scene.add_viewport((120, 90), "eye", name="view", samples=2)
    view.set(shadows=True, shadow_map_size=1024, fill=0.05)
    out = []
    for step, elevation in enumerate((-4, 3, 20, 60)):
        scene.time = float(step)
        x, y = middle[0] + 0.3 * step, middle[1]
        scene.frames["vehicle"].position = (x, y, terrain.height(x, y))
        scene.sun.set(azimuth_deg=240 + 10 * step, elevation_deg=elevation, terrain=terrain)
        out.append(pictures_of(view))
    return out


def pictures_of(view):
    planes = view.capture(lit_fraction=True)
    return planes["color"].tobytes(), planes["lit_fraction"].tobytes()


def test_served_and_replayed_pictures_are_the_same_to_the_byte(tmp_path, ground):
    path = tmp_path / "day.dspace"
    with dspace.Session() as session:
        with session.record(path):
            local = drive(session, ground)
        view = session.viewports["view"]
        view.shadows = False
        assert view.image().tobytes() != local[-1][0]  # there are shadows
    assert len(set(local)) == 4
    with Served(tmp_path, "--allow-root", str(tmp_path)) as server:
        with dspace.connect(server.address) as session:
            assert drive(session, ground) == local
    with dspace.Playback(path) as playback:
        for step in (3, 0, 2, 1):
            playback.seek(float(step))
            view = playback.session.viewports["view"]
            assert view.shadows and view.shadow_map_size == 1024
            assert pictures_of(view) == local[step]


def test_triangles_that_graze_the_light_have_no_stripes(scene):
    """One square whose smooth normals lean 20 degrees further to the Sun than it does. While the Sun is 30 degrees above it, shadows
    change nothing; at 1 degree its smooth light would be a third of full, and it is nearly dark and even; below it, black."""
    square = np.array([(-5, -5, 0), (5, -5, 0), (5, 5, 0), (-5, 5, 0)], float)
    lean = np.radians(20.0)
    scene.add_mesh(square, [(0, 1, 2), (0, 2, 3)], normals=np.tile((np.sin(lean), 0.0, np.cos(lean)), (4, 1)), name="square")
    scene.add_camera("above", eye=(0, 0, 20), target=(0, 0, 0), up=(0, 1, 0), fov_deg=20)
    viewport = scene.add_viewport((96, 96), samples=1)

    def light(elevation, shadows):
        scene.sun.set(direction=(np.cos(np.radians(elevation)), 0.0, np.sin(np.radians(elevation))), radius_deg=0.2666, irradiance=np.pi)
        viewport.set(shadows=shadows)
        return viewport.radiance()[8:-8, 8:-8, 1].astype(float)
    full = light(30.0, False)
    assert full.min() > 0.3
    np.testing.assert_allclose(light(30.0, True), full, rtol=1e-5)
    low = light(1.0, True)
    assert light(1.0, False).min() > 0.25 * full.min()
    assert low.max() < 0.15 * light(1.0, False).min()
    assert low.max() - low.min() < 0.1 * light(1.0, False).min()
    assert light(-5.0, True).max() < 1e-6 < light(-5.0, False).min()
