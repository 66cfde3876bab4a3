"""Long measurements: progress, cancelling, and a server that keeps serving its viewers."""
import numpy as np
import pytest

import dspace
from served_support import Served
from terrain_support import write_raster


@pytest.fixture
def scene(tmp_path):
    with dspace.Session() as session:
        yield hills_in(session.scene(), tmp_path)


def hills_in(scene, folder):
    rows, columns = np.mgrid[:200, :200]
    write_raster(folder / "hills.tif", 20.0 * np.sin(0.11 * columns) * np.cos(0.07 * rows), 2.0)
    scene.add_terrain(folder / "hills.tif", name="hills")
    return scene


class Stop(Exception):
    pass


def stop(fraction, left):
    raise Stop


def long_ones(scene):
    """Measurements of minutes."""
    site = scene.terrains["hills"].site(200.0, 200.0, 2.0)
    many = scene.terrains["hills"].site(np.linspace(4.0, 396.0, 100_000), 150.0, 2.0)
    place = dspace.BodySite("moon", 29.0, -84.0)
    plate = scene.add_plane(1.0, 1.0, name="plate", frame=scene.add_frame("plate", position=(0, 0, 40)))
    scene.sun.set(azimuth_deg=90, elevation_deg=5)
    year = ("2025-01-01", "2026-01-01")
    times = scene.tdb(year)
    return [lambda **more: scene.horizon(site, 1_000_000, **more),
            lambda **more: scene.line_of_sight(site, many, **more),
            lambda **more: scene.lit_area([plate] * 100, samples=100_000, **more),
            lambda **more: scene.contacts(place, "earth", *year, step=30.0, **more),
            lambda **more: scene.sky_track(place, "earth", np.linspace(*times, 2_000_000), **more),
            lambda **more: scene.power_profile(place, dspace.Panel(1.0), *year, step=30.0, **more)]


def test_progress_grows_and_what_it_raises_ends_the_work(scene):
    for measure in long_ones(scene):
        with pytest.raises(Stop):
            measure(progress=stop)
        told = []

        def watch(fraction, left):
            told.append((fraction, left))
            if len(told) > 3 and fraction > 0.0:
                raise Stop
        with pytest.raises(Stop):
            measure(progress=watch)
        fractions = [fraction for fraction, _ in told]
        assert fractions == sorted(fractions) and 0.0 < fractions[-1] < 1.0 and told[-1][1] > 0.0
    with pytest.raises(dspace.WrongType, match="progress is 3"):
        scene.horizon(scene.terrains["hills"].site(200.0, 200.0), progress=3)


def test_results_are_those_of_the_session_s_thread(scene):
    """By the command without wait_s."""
    site = scene.terrains["hills"].site(200.0, 200.0, 2.0)
    command = scene._command()
    command.horizon.site.terrain = "hills"
    command.horizon.site.map_x = command.horizon.site.map_y = 200.0
    command.horizon.site.height = 2.0
    command.horizon.azimuths = 20_000
    assert scene.horizon(site, 20_000).elevation_deg.tolist() == list(scene._execute(command).horizon.elevation_deg)
    ends = scene.terrains["hills"].site(np.linspace(4.0, 396.0, 5000), 150.0, 2.0)
    lines = scene.line_of_sight(site, ends)
    few = [scene.line_of_sight(site, scene.terrains["hills"].site(ends.x[k], 150.0, 2.0)) for k in range(0, 5000, 500)]
    assert lines.clear[::500].tolist() == [line.clear for line in few]
    assert lines.clearance[::500].tolist() == [line.clearance for line in few]
    with pytest.raises(dspace.DeadlineExceeded, match="deadline of 0.2 s"):
        scene.horizon(site, 1_000_000, deadline=0.2)


def test_a_server_serves_others_meanwhile(tmp_path):
    hills_in(dspace.Session().scene(), tmp_path)
    with Served(tmp_path, "--allow-root", str(tmp_path)) as server:
        with dspace.connect(server.address) as session, dspace.watch(server.address) as watcher:
            scene = hills_in(session.scene(), tmp_path)
            for measure in long_ones(scene):
                asked = []

                def step(fraction, left):
                    """A step of the simulation, until the viewer has it."""
                    scene.time = time = scene.time + 1.0
                    while "scene" not in watcher.scenes or watcher.scenes["scene"].time != time:
                        assert watcher.update(20.0), watcher.error
                    asked.append(fraction)
                    if len(asked) > 3 and fraction > 0.0:
                        raise Stop
                with pytest.raises(Stop):
                    measure(progress=step)
                assert asked[-1] < 1.0  # it was still at work when the others were served
            # Removed while it is measured: the result is that of the terrain as it was.
            site = scene.terrains["hills"].site(200.0, 200.0, 2.0)
            expected = scene.horizon(site, 100_000).elevation_deg
            removed = []

            def remove(fraction, left):
                if not removed:
                    scene.terrains["hills"].remove()
                    removed.append(fraction)
            assert (scene.horizon(site, 100_000, progress=remove).elevation_deg == expected).all()
            assert removed and not scene.terrains
