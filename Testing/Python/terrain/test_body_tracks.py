"""Wheel tracks on bodies: ruts have their width and depth in metres anywhere, in queries, rays and depth images."""
import numpy as np
import pytest

import dspace
from dspace.errors import InvalidArgument
from served_support import Served

RADIUS = 1000.0
SITES = {"equator": (12.0, 0.0), "sixty": (-77.0, 60.0), "pole": (40.0, 89.99), "south": (100.0, -89.0),
         "seam": (180.0, -20.0)}


@pytest.fixture
def ground(tmp_path):
    """A level sphere: 3.75 degrees a pixel."""
    path = tmp_path / "ball.asc"
    path.write_text("ncols 96\nnrows 48\nxllcorner -180\nyllcorner -90\ncellsize 3.75\n" + ("0 " * 96 + "\n") * 48)
    return path


def add(scene, path):
    """Posts at most 3.2 cm apart."""
    return scene.add_terrain(path, name="ball", on_body=True, subdivisions=11, vertical_datum="sphere:1000",
                             vertical_scale=1.0, crs="+proj=longlat +R=1000 +no_defs")


def axes(site):
    """East, north and up at a site."""
    lon, lat = np.radians(SITES[site])
    up = np.array((np.cos(lat) * np.cos(lon), np.cos(lat) * np.sin(lon), np.sin(lat)))
    east = np.array((-np.sin(lon), np.cos(lon), 0.0))
    return east, np.cross(up, east), up


def place(site, e, n):
    """Points of the sphere e and n metres from a site along great circles."""
    east, north, up = axes(site)
    d = np.hypot(e, n) / RADIUS
    way = (np.multiply.outer(e, east) + np.multiply.outer(n, north)) / np.maximum(np.hypot(e, n), 1e-300)[..., None]
    return RADIUS * (np.cos(d)[..., None] * up + np.sin(d)[..., None] * way)


def drive(terrain, site):
    """Along a straight line towards 30 degrees, 0.4 m wide and 0.1 deep, from -3 to 3 m."""
    s = np.linspace(-3, 3, 13)
    terrain.track({"wheel": place(site, 0.5 * s, 0.75 ** 0.5 * s)}, width=0.4, wall=0.2, sinkage=0.1, begin=True)


def across(site, aside):
    return place(site, 0.75 ** 0.5 * aside, -0.5 * aside)


def closed(aside):
    return 0.1 * np.clip(1 - (np.abs(aside) - 0.2) / 0.2, 0, 1)


@pytest.mark.parametrize("site", SITES)
def test_a_rut_is_as_wide_and_deep_as_on_a_plane(scene, ground, site):
    terrain = add(scene, ground)
    terrain.track({"anchor": place(site, np.array([700.0]), np.array([300.0]))}, width=0.4)  # the scale is not 1
    drive(terrain, site)
    aside = np.arange(-0.6, 0.6, 0.02)
    points = across(site, aside)
    heights = terrain.height(*points.T)
    # Between posts the bends at a wall's ends are cut: by a slope of 0.5 times a quarter of a cell's diagonal.
    np.testing.assert_allclose(-heights, closed(aside), atol=0.006)
    assert np.abs(terrain.undisturbed.height(*points.T)).max() == 0
    hits = terrain.intersect(1.002 * points, -points)
    np.testing.assert_allclose(hits, 2.0 - heights, atol=2e-3)
    assert terrain.tracks["length"] == pytest.approx(6.0, abs=1e-3)
    # What is drawn: depths of pixels against rays.
    east, north, up = axes(site)
    eye, target = 1.003 * RADIUS * up - 1.0 * north, RADIUS * up
    scene.add_camera("eye", eye=eye, target=target, up=up, fov_deg=30, near=0.05)
    view = scene.add_viewport((120, 120), "eye", samples=1)
    depth = view.depth()
    forward = (target - eye) / np.linalg.norm(target - eye)
    right = np.cross(forward, up) / np.linalg.norm(np.cross(forward, up))
    down = np.cross(forward, right)
    offset = (np.arange(120) - 59.5) * 2 * np.tan(np.radians(15)) / 120
    rays = forward + offset[None, :, None] * right + offset[:, None, None] * down
    lengths = np.linalg.norm(rays, axis=-1)
    distances = terrain.intersect(np.tile(eye, (14400, 1)), rays.reshape(-1, 3)).reshape(120, 120)
    error = np.abs(depth * lengths - distances)
    assert np.quantile(error, 0.98) < 0.004 and error.max() < 0.04
    terrain.clear_tracks()
    assert np.abs(terrain.height(*points.T)).max() == 0
    assert (np.abs(view.depth() - depth) > 0.05).mean() > 0.05  # the rut was drawn


def test_viewers_recordings_and_files_have_the_same_ruts(tmp_path, ground):
    aside = np.linspace(-0.6, 0.6, 200)

    def ask(terrain):
        return (terrain.height(*across("seam", aside).T).tobytes(), terrain.normal(*across("seam", aside).T).tobytes(),
                tuple(sorted(terrain.tracks.items())))

    run = tmp_path / "run.dspace"
    with Served(tmp_path, "--allow-root", str(tmp_path)) as server, \
            dspace.connect(server.address, timeout=20.0) as session:
        scene = session.scene()
        terrain = add(scene, ground)
        bare = ask(terrain)
        with session.record(run):
            drive(terrain, "seam")
            scene.time = 1.0
            wanted = ask(terrain)
            with dspace.watch(server.address) as watcher:
                while watcher.scenes["scene"].time != 1.0:
                    assert watcher.update(20.0), watcher.error
                assert ask(watcher.scenes["scene"].terrains["ball"]) == wanted != bare
            scene.time = 1.5
            terrain.save_tracks(tmp_path / "tracks.geojson")
            terrain.clear_tracks()
            assert ask(terrain) == bare
            terrain.load_tracks(tmp_path / "tracks.geojson")
            scene.time = 2.0
            np.testing.assert_allclose(np.frombuffer(ask(terrain)[0]), np.frombuffer(wanted[0]), atol=1e-5)
            loaded = ask(terrain)
    (tmp_path / "tracks.geojson").unlink()
    with dspace.Playback(run) as playback:
        for time, ruts in ((1.0, wanted), (2.0, loaded)):
            playback.seek(time)
            assert ask(playback.session.scenes["scene"].terrains["ball"]) == ruts


def test_what_is_refused_changes_nothing(scene, ground):
    terrain = add(scene, ground)
    drive(terrain, "equator")
    kept = terrain.tracks
    with pytest.raises(InvalidArgument, match=r"\(x, y, z\)"):
        terrain.track({"wheel": (1.0, 2.0)}, width=0.4)
    with pytest.raises(InvalidArgument, match="up to 120"):
        terrain.track({"far": -place("equator", np.array([1.0]), np.array([1.0]))}, width=0.4)
    with pytest.raises(InvalidArgument, match="'middle'.*centre"):
        terrain.track({"middle": (0, 0, 0)}, width=0.4)
    with pytest.raises(InvalidArgument, match="subdivisions"):
        scene.add_terrain(ground, on_body=True, subdivisions=25, vertical_datum="sphere:1000", vertical_scale=1.0,
                          crs="+proj=longlat +R=1000 +no_defs")
    assert terrain.tracks == kept
