"""Wheel tracks on terrain of triangles: what is answered and drawn, and what a clipmap of the same posts shows."""
import numpy as np
import pytest

import dspace
from dspace.errors import Error
from served_support import Served

SPACING, SIDE = 0.05, 241  # 12 m
CRS = 'LOCAL_CS["ground",UNIT["metre",1]]'


@pytest.fixture
def ground(tmp_path):
    """z = x / 2 + 0.2 sin 3 y at posts; (0, 0) is one."""
    line = SPACING * (np.arange(SIDE) - SIDE // 2)
    x, y = np.meshgrid(line, -line)
    path, edge = tmp_path / "ground.asc", line[0] - SPACING / 2
    path.write_text(f"ncols {SIDE}\nnrows {SIDE}\nxllcorner {edge}\nyllcorner {edge}\ncellsize {SPACING}\n"
                    + "\n".join(" ".join(f"{v:.6f}" for v in row) for row in x / 2 + 0.2 * np.sin(3 * y)))
    return path


def add(scene, path, **settings):
    return scene.add_terrain(path, vertical_datum="relative", crs=CRS, vertical_scale=1.0,
                             **{"mode": "triangles", "name": "ground", **settings})


def roll(terrain, begin=0, end=60):
    """A rover's two wheels in a curve."""
    for i in range(begin, end):
        a = 0.05 * i
        terrain.track({"left": (2 * np.sin(a), 2 * np.cos(a)), "right": (1.2 * np.sin(a), 1.2 * np.cos(a))},
                      width=0.2, wall=0.1, sinkage=0.06, rim_width=0.1, rim_height=0.03)


def ask(terrain):
    xy = np.random.default_rng(3).uniform(-3, 3, (3000, 2))
    rays = np.column_stack([xy[:500], np.full(500, 4.0)])
    return (terrain.heights(xy).tobytes(), terrain.normals(xy).tobytes(),
            terrain.intersect(rays, np.tile((0.1, 0.2, -1.0), (500, 1))).tobytes(), tuple(sorted(terrain.tracks.items())))


def test_queries_at_posts_have_the_closed_form(scene, ground):
    terrain = add(scene, ground)
    terrain.track({"wheel": [(-2, 1), (2, 1)]}, width=0.2, wall=0.1, sinkage=0.08)
    k = np.arange(-8, 9)
    before = terrain.undisturbed.height(0.5 + 0 * k, 1 + SPACING * k)
    np.testing.assert_allclose(before, 0.25 + 0.2 * np.sin(3 * (1 + SPACING * k)), atol=1e-6)
    depth = 0.08 * np.clip(1 - (np.abs(SPACING * k) - 0.1) / 0.1, 0, 1)
    np.testing.assert_allclose(before - terrain.height(0.5 + 0 * k, 1 + SPACING * k), depth, atol=1e-7)
    assert terrain.mode == "triangles" and terrain.tracks["length"] == 4.0
    terrain.clear_tracks()
    assert np.array_equal(terrain.height(0.5 + 0 * k, 1 + SPACING * k), before)


def test_pictures_and_depth_are_those_of_a_clipmap_of_the_same_posts(scene, ground):
    """From near, where a clipmap draws all posts: depth to 0.1 mm and what placing vertices to 1/256 pixel costs at
    silhouettes; colours, in one light, to two levels."""
    scene.lights["sun"].set(direction=(0.9, 0.2, -0.35))
    planes = {}
    scene.add_camera("eye", eye=(0.8, 0.2, 1.6), target=(1.0, 1.4, 0.3), fov_deg=40, near=0.05)
    view = scene.add_viewport((240, 180), "eye", samples=1)
    for mode in ("triangles", "clipmap"):
        terrain = add(scene, ground, mode=mode, color=(0.8, 0.7, 0.6))
        bare = view.image().astype(int), view.depth()
        roll(terrain)
        planes[mode] = view.image().astype(int), view.depth(), *bare
        x, y = 120, 90
        hit = view.pick(x, y)
        assert hit.object.name.startswith("ground")
        assert hit.in_frame[2] == pytest.approx(terrain.height(*hit.in_frame[:2]), abs=2e-4)
        terrain.remove()
    (image, depth, plain, flat), (image2, depth2, _, _) = planes["triangles"], planes["clipmap"]
    assert np.isfinite(depth).all() and np.isfinite(depth2).all()
    near = depth < 1.7  # farther, a clipmap of 124 cells draws fewer posts
    assert near.mean() > 0.4
    assert np.quantile(np.abs(depth - depth2)[near], 0.99) < 1e-4
    assert (np.abs(depth - flat) > 0.03).mean() > 0.05  # ruts are there
    assert np.quantile(np.abs(image - image2).max(axis=-1)[near], 0.97) <= 2
    assert (np.abs(image - plain).max(axis=-1) > 20).mean() > 0.1


def test_a_decimated_ground_is_fine_where_wheels_rolled(scene, ground):
    """The budget is a hundredth of the posts: a rut is drawn by all of its posts, and a millimetre true."""
    terrain = add(scene, ground, triangles=1500)
    before = terrain.triangles
    assert before <= 1500
    roll(terrain)
    assert terrain.triangles > before + 3000
    scene.add_camera("above", eye=(0, 1.6, 9), target=(0, 1.6001, 0), height=2.0)
    view = scene.add_viewport((400, 400), "above", samples=1)
    z = 9 - view.depth()
    column, row = np.meshgrid(np.arange(400), np.arange(400))
    x, y = (column - 199.5) * 0.005, 1.6 - (row - 199.5) * 0.005
    rut = terrain.undisturbed.height(x, y) - terrain.height(x, y) > 0.055  # floors
    assert rut.sum() > 10000
    assert np.quantile(np.abs(z - terrain.height(x, y))[rut], 0.98) < 1e-3
    terrain.clear_tracks()
    assert terrain.triangles == before


def test_saved_loaded_and_limited(scene, ground, tmp_path):
    terrain = add(scene, ground, track_budget=65536)
    roll(terrain)
    wanted = ask(terrain)
    terrain.save_tracks(tmp_path / "tracks.geojson")
    terrain.clear_tracks()
    terrain.load_tracks(tmp_path / "tracks.geojson")
    assert np.allclose(np.frombuffer(ask(terrain)[0]), np.frombuffer(wanted[0]), atol=1e-6)
    kept = ask(terrain)
    with pytest.raises(Error, match="65536"):
        for i in range(1000):
            kept = ask(terrain)
            terrain.track({"a": np.random.default_rng(i).uniform(-5, 5, (20, 2))}, width=0.2)
    assert ask(terrain) == kept


def test_a_late_viewer_and_a_recording_have_the_same_ruts(tmp_path, ground):
    run = tmp_path / "run.dspace"
    with Served(tmp_path, "--allow-root", str(tmp_path)) as server, \
            dspace.connect(server.address, timeout=20.0) as session:
        scene = session.scene()
        terrain = add(scene, ground)
        scene.add_camera("eye", eye=(0.8, 0.2, 1.6), target=(1.0, 1.4, 0.3), fov_deg=40, near=0.05)
        view = scene.add_viewport((160, 120), "eye", name="view", samples=1)
        plain = view.image()
        roll(terrain, 0, 30)
        with dspace.watch(server.address) as watcher:
            for time, (begin, end) in ((1.0, (0, 0)), (2.0, (30, 60))):
                roll(terrain, begin, end)
                scene.time = time
                while watcher.scenes["scene"].time != time:
                    assert watcher.update(20.0), watcher.error
                assert ask(watcher.scenes["scene"].terrains["ground"]) == ask(terrain)
                picture = view.image()
                assert np.array_equal(watcher.viewports["view"].image(), picture) and not np.array_equal(picture, plain)
    with dspace.Session() as session:
        scene = session.scene()
        terrain = add(scene, ground)
        scene.add_camera("eye", eye=(0.8, 0.2, 1.6), target=(1.0, 1.4, 0.3), fov_deg=40, near=0.05)
        view = scene.add_viewport((160, 120), "eye", name="view", samples=1)
        roll(terrain, 0, 20)
        with session.record(run):
            roll(terrain, 20, 60)
            scene.time = 1.0
            ruts, image = ask(terrain), view.image()
            scene.time = 1.5
            terrain.clear_tracks()
            scene.time = 2.0
    assert np.array_equal(image, picture)
    with dspace.Playback(run) as playback:
        for time in (1.0, 2.0):
            playback.seek(time)
            seen = playback.session.scenes["scene"].terrains["ground"]
            if time == 1.0:
                assert ask(seen) == ruts and np.array_equal(playback.session.viewports["view"].image(), image)
            else:
                assert seen.tracks["contacts"] == 0
                assert np.array_equal(playback.session.viewports["view"].image(), plain)
