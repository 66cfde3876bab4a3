"""Shadows of terrain in pictures, by lit_fraction, against rays of the terrain to points of the Sun's disc."""
from dataclasses import dataclass

import numpy as np
import pytest

import dspace
from shadow_support import RADIUS_DEG, crater, disc, lit_by_rays, near_edges, on_ground
from terrain_support import FIELD, gdal, points_of, real, write_raster

FOV = 60.0
WHITE = (1, 1, 1)


@dataclass
class Against:
    """A picture against rays: shares of all its pixels, but `away` is of those away from edges."""
    pixels: int
    shaded: float  # rays say that less than a tenth of the disc is seen
    lit: float  # more than nine tenths
    wrong: float  # off by more than 0.25
    edge: float  # rays say something else within two posts
    wrong_away: float  # off by more than 0.25, and no edge near
    away: float  # mean difference where no edge is near


def compare(view, terrain, eye, target, post, lift=1e-3, stride=2, fov=FOV, within=np.inf):
    """`post` [m]: between posts of what is drawn. `lift` [m]: of a ray's start over the ground. `within` [m]: of the
    camera's place, seen from above."""
    to_sun = view.scene.sun.direction
    planes = view.capture(False, depth=True, lit_fraction=True, physical_only=True)
    points, _ = points_of(planes["depth"], eye, target, fov)
    points, lit = points[::stride, ::stride].reshape(-1, 3), planes["lit_fraction"][::stride, ::stride].ravel()
    there = np.isfinite(points[:, 2])
    assert np.isnan(lit[~there]).all() and not np.isnan(lit[there]).any()
    there &= np.hypot(*(points - eye)[:, :2].T) < within
    points, lit = points[there], lit[there]
    there = np.isfinite(terrain.heights(points[:, :2]))
    points, lit = on_ground(terrain, points[there]), lit[there]
    exact = lit_by_rays(terrain, points, to_sun, lift=lift)
    away = ~near_edges(terrain, points, exact, to_sun, 2 * post, lift=lift)
    off = np.abs(lit - exact)
    outcome = Against(len(points), (exact < 0.1).mean(), (exact > 0.9).mean(), (off > 0.25).mean(), 1 - away.mean(),
                      (away & (off > 0.25)).mean(), off[away].mean())
    return outcome


def seen_from(scene, eye, target, size=(96, 72)):
    scene.add_camera("eye", eye=tuple(eye), target=tuple(target), fov_deg=FOV, near=0.1)
    view = scene.add_viewport(size, "eye", samples=1)
    view.shadows = True
    return view


# Fewer than 0.5 % of the pixels of real and made ground are wrong, and none away from edges, where the ground is drawn by its
# own posts. A ray starts `lift` over the ground: a pixel so near an edge that this lifts it over the edge is no error of the
# picture, so that the lift is a small part of a post's rise.
@pytest.mark.parametrize("azimuth, elevation", [(100, 4), (230, 10), (35, 25)])
def test_a_crater(scene, tmp_path, azimuth, elevation):
    terrain = scene.add_terrain(write_raster(tmp_path / "crater.tif", crater(post=1.0), 1.0), mode="clipmap", level_size=252,
                                color=WHITE)
    scene.sun.set(azimuth_deg=azimuth, elevation_deg=elevation, terrain=terrain)
    eye, target = np.array((3.0, -4.0, 75.0)), (0.0, 0.0, -5.0)
    outcome = compare(seen_from(scene, eye, target), terrain, eye, target, 1.0, lift=1e-4)
    assert outcome.pixels > 1500 and outcome.shaded > 0.05 and outcome.lit > 0.3
    assert outcome.wrong < 0.005 and outcome.wrong_away == 0
    assert outcome.away < 0.01


# Posts of 0.5 m are half as wide as pixels: every second one is drawn, and rays see all of them.
@pytest.mark.parametrize("azimuth, elevation, wrong", [(100, 4, 0.03), (230, 10, 0.025), (35, 25, 0.015)])
def test_a_crater_by_every_second_post(scene, tmp_path, azimuth, elevation, wrong):
    terrain = scene.add_terrain(write_raster(tmp_path / "crater.tif", crater(), 0.5), mode="clipmap", level_size=252,
                                color=WHITE)
    scene.sun.set(azimuth_deg=azimuth, elevation_deg=elevation, terrain=terrain)
    eye, target = np.array((3.0, -4.0, 75.0)), (0.0, 0.0, -5.0)
    outcome = compare(seen_from(scene, eye, target), terrain, eye, target, 0.5)
    assert outcome.pixels > 1500 and outcome.shaded > 0.05 and outcome.lit > 0.3
    assert outcome.wrong < wrong
    assert outcome.wrong_away < 0.005 and outcome.away < 0.01


@pytest.mark.parametrize("azimuth, elevation", [(70, 6), (285, 12)])
def test_the_shipped_field(scene, azimuth, elevation):
    terrain = scene.add_terrain(FIELD, mode="clipmap", level_size=252, color=WHITE)
    scene.sun.set(azimuth_deg=azimuth, elevation_deg=elevation, terrain=terrain)
    x, y = 20.0, -30.0
    ground = terrain.height(x, y)
    eye, target = np.array((x, y - 2.0, ground + 10.0)), (x, y, ground)
    outcome = compare(seen_from(scene, eye, target), terrain, eye, target, 0.2, lift=3e-5)
    assert outcome.pixels > 1500 and outcome.shaded > 0.01 and outcome.lit > 0.3
    assert outcome.wrong < 0.005 and outcome.wrong_away == 0
    assert outcome.away < 0.01


@pytest.mark.parametrize("azimuth", [95, 262])
def test_the_apollo_15_site(scene, azimuth):
    terrain = scene.add_terrain(real("moon_apollo15_nac_dtm_257.png"), mode="clipmap", level_size=252, color=WHITE,
                                pixel_size=2.0, vertical_scale=49 / 255, vertical_offset=0.0, vertical_datum="relative")
    scene.sun.set(azimuth_deg=azimuth, elevation_deg=4, terrain=terrain)
    ground = terrain.height(0.0, 0.0)
    eye, target = np.array((0.0, -4.0, ground + 90.0)), (0.0, 0.0, ground)  # higher, coarser posts would be mixed in
    outcome = compare(seen_from(scene, eye, target), terrain, eye, target, 2.0, lift=1e-5)
    assert outcome.pixels > 1500 and outcome.shaded > 0.1 and outcome.lit > 0.2
    # Heights of 49 m in 256 steps: two thirds of all pixels are near an edge.
    assert outcome.wrong < 0.005 and outcome.wrong_away == 0
    assert outcome.away < 0.01


@pytest.mark.parametrize("place", [(137.4, -4.0), (138.3, -5.3)], ids=["rim", "mount"])
def test_gale(scene, place):
    terrain = scene.add_terrain(real("mars_gale_mola_128ppd_m.tif"), mode="clipmap", level_size=252, color=WHITE,
                                vertical_datum="areoid")
    scene.sun.set(azimuth_deg=85, elevation_deg=6, terrain=terrain)
    x, y, _ = terrain.from_map([[*place, 0.0]])[0]
    ground = terrain.height(x, y)
    eye, target = np.array((x, y - 1e3, ground + 24e3)), (x, y, ground)
    outcome = compare(seen_from(scene, eye, target), terrain, eye, target, 463.0, lift=0.005)
    assert outcome.pixels > 1500 and outcome.shaded > 0.05 and outcome.lit > 0.3
    assert outcome.wrong < 0.005 and outcome.wrong_away == 0
    assert outcome.away < 0.01


# Triangles are in the shadow maps alone. A texel across the rays is 1 / sin(elevation) as long on the ground, so that
# edges move by more than two posts where the Sun is low (Documentation/Views.md).
@pytest.mark.parametrize("azimuth, elevation, wrong", [(100, 10, 0.02), (35, 25, 0.005), (190, 45, 0.005)])
def test_a_crater_of_triangles(scene, tmp_path, azimuth, elevation, wrong):
    terrain = scene.add_terrain(write_raster(tmp_path / "crater.tif", crater(depth=22.0), 0.5), mode="triangles",
                                color=WHITE)
    scene.sun.set(azimuth_deg=azimuth, elevation_deg=elevation, terrain=terrain)
    eye, target = np.array((3.0, -4.0, 75.0)), (0.0, 0.0, -5.0)
    outcome = compare(seen_from(scene, eye, target), terrain, eye, target, 0.5)
    assert outcome.pixels > 1500 and outcome.shaded > 0.005 and outcome.lit > 0.3
    assert outcome.wrong < wrong
    assert outcome.away < 0.01


def group_of(scene, tmp_path):
    """A crater in a patch of posts 2 m apart, on level ground of posts 20 m apart."""
    base = write_raster(tmp_path / "base.tif", np.full((96, 96), 20.0), 20.0)
    data = 20.0 + crater(side=201, post=2.0, radius=100.0, depth=40.0, rim=18.0)
    fine = write_raster(tmp_path / "fine.tif", data, 2.0)
    gdal.Open(str(fine), gdal.GA_Update).SetGeoTransform((760.0, 2.0, 0, 1160.0, 0, -2.0))
    return scene.add_terrain(base, patches=[dict(path=fine, name="crater", margin=30.0)], level_size=252, color=WHITE)


def test_a_group_of_rasters(scene, tmp_path):
    """A crater of a patch throws its shadow within the patch, and over its edge on the coarse raster around it."""
    terrain = group_of(scene, tmp_path)
    assert terrain.patches[0]["used"] and terrain.height_range[0] < -10
    scene.sun.set(azimuth_deg=80, elevation_deg=5, terrain=terrain)
    for x, y, above in ((0.0, 0.0, 200.0), (-290.0, -30.0, 120.0)):
        ground = terrain.height(x, y)
        eye, target = np.array((x, y - 0.05 * above, ground + above)), (x, y, ground)
        view = seen_from(scene, eye, target)
        outcome = compare(view, terrain, eye, target, 20 / 2**terrain.tiles["subdivisions"], stride=3)
        assert outcome.pixels > 700 and outcome.shaded > 0.02 and outcome.lit > 0.15
        assert outcome.wrong < 0.01
        assert outcome.wrong_away < 0.005 and outcome.away < 0.01


@pytest.mark.parametrize("mode", ["clipmap", "triangles"])
def test_wheel_tracks(scene, tmp_path, mode):
    """The wall of a rut shades its floor."""
    side = 33 if mode == "clipmap" else 9
    terrain = scene.add_terrain(write_raster(tmp_path / "level.tif", np.zeros((side, side))), mode=mode, level_size=252,
                                subdivisions=5, color=WHITE)
    scene.sun.set(azimuth_deg=80, elevation_deg=15, terrain=terrain)
    eye, target = np.array((0.3, -0.4, 3.5)), (0.3, 0.0, 0.0)
    view = seen_from(scene, eye, target)
    assert (view.lit_fraction() == 1).all()
    terrain.track({"left": [(0.0, -3.0), (0.05, 0.0), (-0.1, 3.0)]}, 0.4, sinkage=0.12, wall=0.04)
    outcome = compare(view, terrain, eye, target, 2.0**-5, stride=1)
    assert outcome.shaded > 0.03 and outcome.lit > 0.5
    assert outcome.wrong < 0.05
    assert outcome.wrong_away < 0.005 and outcome.away < 0.01
    terrain.clear_tracks()
    assert (view.lit_fraction() == 1).all()


# --- Shadow maps -------------------------------------------------------------------------------------

def ridge(side, post, height=4.0, half=2.0):
    """Heights of a ridge from west to east, without one beyond its ends, in the middle of level ground."""
    x = (np.arange(side) - side // 2) * post
    return np.where(np.abs(x[None, :]) <= 15.0, np.maximum(height * (1 - np.abs(x[:, None]) / half), 0.0), 0.0)


def mesh_of(z, post):
    """The triangles of a raster's posts that are above level ground, in the order that terrain has them."""
    x = (np.arange(z.shape[1]) - z.shape[1] // 2) * post
    points = np.stack(np.broadcast_arrays(x[None, :], -x[:, None], z), axis=-1).reshape(-1, 3)
    index = np.arange(z.size).reshape(z.shape)
    nw, ne, sw, se = index[:-1, :-1], index[:-1, 1:], index[1:, :-1], index[1:, 1:]
    triangles = np.concatenate([np.stack(c, axis=-1).reshape(-1, 3) for c in ((nw, sw, se), (nw, se, ne))])
    return points, triangles[(points[triangles][..., 2] > 0).any(axis=1)]


@pytest.mark.parametrize("elevation", [6, 10, 25])
def test_a_wall_of_a_mesh_and_one_of_terrain_throw_the_same_shadow(session, tmp_path, elevation):
    """Near shadows come from maps, far ones from horizons: their edges differ by less than the penumbra's width and a
    post, and each is where rays say."""
    post, size = 0.25, (100, 200)
    raised = ridge(401, post)
    edges = {}
    for kind in ("mesh", "terrain"):
        scene = session.scene(kind)
        terrain = scene.add_terrain(write_raster(tmp_path / f"{kind}.tif", raised if kind == "terrain" else 0 * raised, post),
                                    mode="clipmap", level_size=252, color=WHITE)
        if kind == "mesh":
            scene.add_mesh(*mesh_of(raised, post), color=WHITE)
        scene.sun.set(azimuth_deg=0, elevation_deg=elevation, terrain=terrain)
        # The shadow falls to the south: rows of the picture are 5 cm apart there.
        length = 4.0 / np.tan(np.radians(elevation))
        scene.add_camera("down", eye=(0, -length, 25.0), target=(0, -length, 0), up=(0, 1, 0), height=10.0, near=1)
        view = scene.add_viewport(size, "down", samples=1)
        lit = view.lit_fraction()
        y = -length + (size[1] / 2 - 0.5 - np.arange(size[1])) * 0.05
        # From the shadow's middle to the south: where each level of light is first reached.
        first = np.argmax(y < -length + min(2.5, length / 2 - 2.0))
        edges[kind] = {part: np.array([y[first + np.argmax(column[first:] > part)] for column in lit.T[20:-20]])
                       for part in (0.1, 0.5, 0.9)}
        assert (lit[first] < 0.1).all() and (lit[-1] == 1).all()
    # A straight edge across a disc: 0.687 of its width is between a tenth and nine tenths.
    slant = 4.0 / np.sin(np.radians(elevation))
    penumbra = 2 * slant * np.tan(np.radians(RADIUS_DEG)) / np.sin(np.radians(elevation))
    for part in (0.1, 0.5, 0.9):
        assert np.abs(edges["mesh"][part] - edges["terrain"][part]).max() < penumbra
    for kind in edges:  # half of the disc is seen past the crest
        assert np.abs(edges[kind][0.5] + length).max() < 0.05 + post, kind
        width = (edges[kind][0.1] - edges[kind][0.9]).mean()
        assert abs(width - 0.687 * penumbra) < 0.1 + 0.15 * penumbra, kind


@pytest.mark.parametrize("mode", ["clipmap", "triangles"])
def test_ground_throws_its_shadow_on_meshes_by_day_and_at_night(scene, tmp_path, mode):
    """On balls in a crater, on its rim and beside it, whose sunward sides rays of the terrain reach or not. Low light comes
    under the ground at the raster's edge, where it has no side, and at night from below."""
    raster = write_raster(tmp_path / "crater.tif", crater(post=0.25, radius=12.0, depth=5.0, rim=1.0), 0.25)
    terrain = scene.add_terrain(raster, mode=mode, level_size=252, color=WHITE)
    middles = [np.array((x, 0, terrain.height(x, 0) + 0.6)) for x in (-9.0, -5.0, 0.0, 5.0, 9.0, 20.0)]
    balls = [scene.add_sphere(0.5, position=tuple(middle), color=WHITE) for middle in middles]
    camera = scene.add_camera("eye", eye=(0, -9, 4), target=(0, 0, 0), fov_deg=12, near=0.1)
    view = scene.add_viewport((40, 30), "eye", samples=1)
    for elevation in (20, 10, 2, -3, -20, -60):
        scene.sun.set(azimuth_deg=90, elevation_deg=elevation, terrain=terrain)
        to_sun = scene.sun.direction
        pixels = wrong = shaded = 0
        for ball, middle in zip(balls, middles):
            eye = middle + (0, -9, 4)
            camera.look_at(eye=tuple(eye), target=tuple(middle))
            planes = view.capture(False, depth=True, label=True, lit_fraction=True, incidence=True)
            points, _ = points_of(planes["depth"], eye, middle, 12)
            there = (planes["label"] == ball.id) & (planes["incidence"] < 85)
            rays = disc(to_sun, 30)
            exact = np.isinf(terrain.intersect(points[there][:, None], rays[None])).mean(axis=1)
            off = np.abs(planes["lit_fraction"][there] - exact)
            pixels, wrong, shaded = pixels + off.size, wrong + (off > 0.25).sum(), shaded + (exact < 0.1).sum()
        assert pixels > 200 and shaded > 0.4 * pixels
        assert wrong <= 0.03 * pixels, elevation


def test_nothing_shows_where_the_last_shadow_map_ends(scene, tmp_path):
    """On streamed terrain, whose shadows reach as far as it does: the same picture to the byte wherever the maps end."""
    terrain = scene.add_terrain(write_raster(tmp_path / "crater.tif", crater(depth=22.0), 0.5), mode="clipmap", color=WHITE)
    scene.sun.set(azimuth_deg=250, elevation_deg=7, terrain=terrain)
    view = seen_from(scene, (0.0, -62.0, 12.0), (0.0, 0.0, -4.0), (160, 120))
    seen = view.lit_fraction()
    shaded = (seen < 0.1).mean()
    assert 0.05 < shaded < 0.7
    depth = view.depth()
    ends = np.nanpercentile(depth[np.isfinite(depth)], (5, 30, 60, 90))
    for distance in (1.0, *ends, 1e4):
        for cascades in (1, 4):
            view.set(shadow_distance=distance, shadow_cascades=cascades)
            np.testing.assert_array_equal(view.lit_fraction(), seen)
    # A box is in the maps alone: its shadow ends where they do, and nothing else changes there.
    box = scene.add_box((4, 4, 30), color=WHITE, position=(-30.0, -45.0, 10.0))
    view.set(shadow_distance=0.0, shadow_cascades=4)
    whole = view.lit_fraction()
    ground = view.labels() != box.id
    threw = ground & np.isfinite(depth) & (np.abs(whole - seen) > 0.5)
    assert threw.mean() > 0.01
    end = np.median(depth[threw])
    view.shadow_distance = end
    cut = view.lit_fraction()
    for part, expected in ((depth > 1.001 * end, seen), (depth < 0.98 * end, whole)):
        assert (threw & part).any()
        assert (np.abs(cut - expected)[ground & part] > 0.25).mean() < 0.005


# --- Separate terrains -------------------------------------------------------------------------------

def floor_and_wall(scene, tmp_path, floor_mode, wall_mode):
    """Level ground, and beside it a ridge of another terrain that rises 3 m above it, from west to east at y = 12 m."""
    post = 0.25
    floor = scene.add_terrain(write_raster(tmp_path / "floor.tif", np.zeros((161, 161)), post), name="floor", mode=floor_mode,
                              level_size=252, color=WHITE)
    place = np.array((0.0, 12.0, -1.0))
    wall = scene.add_terrain(write_raster(tmp_path / "wall.tif", ridge(161, post), post), name="wall", mode=wall_mode,
                             level_size=252, color=WHITE, frame=scene.add_frame("wall", position=tuple(place)))
    return floor, wall, place


def lit_past_wall(wall, place, points, to_sun, count=60):
    """Of the disc, by rays that the wall's terrain meets."""
    start = points[:, None] + (0, 0, 1e-3) - place
    return np.isinf(wall.intersect(start, disc(to_sun, count)[None])).mean(axis=1)


@pytest.mark.parametrize("floor_mode, wall_mode",
                         [("clipmap", "clipmap"), ("clipmap", "triangles"), ("triangles", "clipmap")])
@pytest.mark.parametrize("eye, target, elevation",
                         [((-7.0, -6.0, 6.0), (0.0, 6.0, 0.0), 20), ((0.0, 9.0, 2.0), (0.0, 0.0, 0.0), 15)],
                         ids=["both in the picture", "the wall behind the camera"])
def test_separate_terrains_shade_each_other(scene, tmp_path, floor_mode, wall_mode, eye, target, elevation):
    floor, wall, place = floor_and_wall(scene, tmp_path, floor_mode, wall_mode)
    scene.sun.set(azimuth_deg=8, elevation_deg=elevation)
    eye = np.array(eye)
    view = seen_from(scene, eye, target, (160, 120))
    planes = view.capture(False, depth=True, label=True, lit_fraction=True, physical_only=True)
    assert (planes["label"] == wall.object.id).any() == (eye[1] < 0)
    points, _ = points_of(planes["depth"], eye, target, FOV)
    seen = planes["label"] == floor.object.id
    exact = lit_past_wall(wall, place, points[seen], scene.sun.direction)
    off = np.abs(planes["lit_fraction"][seen] - exact)
    assert seen.sum() > 5000 and (exact < 0.1).mean() > 0.05 and (exact > 0.9).mean() > 0.2
    assert (off > 0.25).mean() < 0.02
    assert off.mean() < 0.02
    # It does not matter what was in the picture before.
    scene.cameras["eye"].look_at(eye=tuple(eye), target=(0.0, 14.0, 1.0) if eye[1] > 0 else (0.0, -14.0, 0.0))
    view.image()
    scene.cameras["eye"].look_at(eye=tuple(eye), target=tuple(target))
    np.testing.assert_array_equal(view.lit_fraction(), planes["lit_fraction"])


def test_separate_terrains_shade_what_stands_on_the_other(scene, tmp_path):
    floor, wall, place = floor_and_wall(scene, tmp_path, "clipmap", "clipmap")
    scene.sun.set(azimuth_deg=0, elevation_deg=20)
    shaded = scene.add_box((1, 1, 0.6), position=(0, 7, 0.3), color=WHITE)
    lit = scene.add_box((1, 1, 0.6), position=(0, -1, 0.3), color=WHITE)
    eye, target = (-4.0, 3.0, 9.0), (0.0, 3.0, 0.0)
    planes = seen_from(scene, eye, target, (160, 120)).capture(False, label=True, lit_fraction=True, incidence=True)
    for box, expected in ((shaded, 0.0), (lit, 1.0)):
        of = planes["lit_fraction"][(planes["label"] == box.id) & (planes["incidence"] < 80)]
        assert of.size > 50 and np.abs(of - expected).mean() < 0.02


def test_more_terrains_than_layers_of_maps(scene, tmp_path):
    """Five of them: each of the others shades the floor, and none of them itself where it does not."""
    floor, wall, place = floor_and_wall(scene, tmp_path, "clipmap", "clipmap")
    for i in range(3):
        scene.add_terrain(tmp_path / "wall.tif", name=f"wall {i}", mode="clipmap", level_size=252, color=WHITE,
                          frame=scene.add_frame(f"wall {i}", position=(0.0, -3.0 - 5.0 * i, -2.5)))
    scene.sun.set(azimuth_deg=0, elevation_deg=25)
    eye, target = np.array((0.0, -3.0, 30.0)), (0.0, -3.0, 0.0)
    scene.add_camera("down", eye=tuple(eye), target=target, up=(0, 1, 0), height=32.0, near=1)
    planes = scene.add_viewport((80, 160), "down", samples=1).capture(False, label=True, lit_fraction=True)
    rows = -3.0 + (79.5 - np.arange(160)) * 0.2
    lit, labels = planes["lit_fraction"][:, 40], planes["label"][:, 40]
    for crest, rise in ((12.0, 3.0), (-3.0, 1.5), (-8.0, 1.5), (-13.0, 1.5)):
        tip = crest - rise / np.tan(np.radians(25))
        for y, expected in ((tip + 0.5, 0.0), (tip - 0.5, 1.0)):
            row = np.argmin(np.abs(rows - y))
            assert labels[row] == floor.object.id and abs(lit[row] - expected) < 0.1, (crest, y, lit[row])


def test_ground_does_not_shade_the_foot_of_a_wall_beside_it(scene):
    """Boxes that stand in the ground: no ray from their sides to the Sun meets it."""
    terrain = scene.add_terrain(FIELD, mode="clipmap", color=WHITE)
    scene.sun.set(azimuth_deg=120, elevation_deg=30, terrain=terrain)
    for y in (2, 3):
        scene.add_box((0.3, 0.3, 0.3), position=(4, y, terrain.height(4, y) + 0.12), name=f"box {y}", color=WHITE)
    low = float(terrain.height(0, 0))
    scene.add_camera("eye", eye=(0.6, 0, low + 0.55), target=(4, 2.6, low + 0.1), fov_deg=14)
    view = scene.add_viewport((600, 400), "eye", samples=1)
    view.shadows = True
    planes = view.capture(False, label=True, lit_fraction=True, incidence=True)
    boxes = np.isin(planes["label"], [o.id for o in scene.objects.values() if o.name.startswith("box")])
    facing = boxes & (planes["incidence"] < 85.0)
    assert facing.sum() > 4000
    assert (planes["lit_fraction"][facing] < 0.95).mean() < 2e-3
