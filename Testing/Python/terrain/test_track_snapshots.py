"""Wheel tracks in snapshots: who comes late, and who plays a recording, has the same ruts to the byte, whatever
has become of the file that they were loaded from."""
import numpy as np
import pytest

import dspace
from served_support import Served

SIZE = (160, 120)


def build(session, field):
    scene = session.scene()
    terrain = scene.add_terrain(field, subdivisions=5, name="ground")
    scene.add_camera("eye", eye=(-4.0, 0.5, 1.0), target=(-3.0, 3.0, -1.6), fov_deg=40, near=0.05)
    scene.add_viewport(SIZE, "eye", name="view", samples=1)
    return scene, terrain


def roll(terrain, begin, end):
    """Two wheels of a rover that turns, a few millimetres a step: most contacts are left out again."""
    for i in range(begin, end):
        a = 0.002 * i
        x, y = -4.0 + 2.0 * np.sin(a), 4.5 - 2.0 * np.cos(a)
        terrain.track({"left": (x, y), "right": (x + 0.8 * np.sin(a), y - 0.8 * np.cos(a))}, width=0.2,
                      sinkage=0.04 + 0.00002 * i, tread_pitch=0.1, tread_depth=0.01, rim_width=0.05,
                      rim_height=0.02)


def trample(terrain):
    """Three wheels anywhere: every contact is kept, 144 kB of them in a snapshot."""
    places = np.random.default_rng(7).uniform((-2.0, 1.0), (-1.0, 2.0), (3, 1500, 2))
    for wheel, xy in enumerate(places):
        terrain.track({f"foot {wheel}": xy}, width=0.1, sinkage=0.01)


def ask(terrain):
    """Thousands of heights, slopes and normals, and what is kept."""
    xy = np.random.default_rng(2).uniform((-6.0, 0.0), (-1.0, 5.0), (5000, 2))
    return (terrain.heights(xy).tobytes(), terrain.slope_deg(xy[:500, 0], xy[:500, 1]).tobytes(),
            terrain.normal(xy[:500, 0], xy[:500, 1]).tobytes(), tuple(sorted(terrain.tracks.items())))


def follow(watcher, session, wanted):
    """Until the viewer has the time that is set now."""
    session.scene().time = wanted
    while watcher.scenes["scene"].time != wanted:
        assert watcher.update(20.0), watcher.error
    assert watcher.error == ""


@pytest.mark.parametrize("limit", ["90000", "67108864"])
def test_a_viewer_that_comes_late_has_the_same_ruts(tmp_path, field, limit):
    tracks = tmp_path / "tracks.geojson"
    with Served(tmp_path, "--allow-root", str(tmp_path), "--max-message", limit) as server, \
            dspace.connect(server.address, timeout=20.0) as session:
        scene, terrain = build(session, field)
        trample(terrain)
        bare, plain = ask(terrain), session.viewports["view"].image()
        roll(terrain, 0, 300)
        terrain.save_tracks(tracks)
        terrain.clear_tracks()
        terrain.load_tracks(tracks)
        assert terrain.tracks["contacts"] > 4500
        roll(terrain, 300, 900)
        terrain.save_tracks(tracks)  # another content from here on
        with dspace.watch(server.address) as watcher:
            follow(watcher, session, 1.0)
            seen = watcher.scenes["scene"].terrains["ground"]
            assert ask(seen) == ask(terrain) != bare
            before = session.viewports["view"].image()
            assert np.array_equal(watcher.viewports["view"].image(), before)
            assert not np.array_equal(before, plain)
            roll(terrain, 900, 1000)
            tracks.unlink()
            follow(watcher, session, 2.0)
            assert ask(seen) == ask(terrain)
            after = session.viewports["view"].image()
            assert np.array_equal(watcher.viewports["view"].image(), after) and not np.array_equal(after, before)


def test_a_recording_has_the_ruts_and_needs_no_file_of_tracks(tmp_path, field):
    tracks, run = tmp_path / "tracks.geojson", tmp_path / "run.dspace"
    with dspace.Session() as session:
        scene, terrain = build(session, field)
        roll(terrain, 0, 200)
        terrain.save_tracks(tracks)
        terrain.clear_tracks()
        scene.time = 0.0
        with session.record(run):
            roll(terrain, 200, 400)
            scene.time = 1.0
            terrain.load_tracks(tracks)
            scene.time = 2.0
            roll(terrain, 400, 500)
            scene.time = 3.0
        wanted, image = ask(terrain), session.viewports["view"].image()
    tracks.write_text("not what it was")
    with dspace.Playback(run) as playback:
        playback.seek(3.0)
        assert ask(playback.session.scenes["scene"].terrains["ground"]) == wanted
        assert np.array_equal(playback.session.viewports["view"].image(), image)
