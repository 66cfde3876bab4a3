"""Sunlit areas through Python: closed forms, on objects and on terrain."""
import numpy as np
import pytest

import dspace
from terrain_support import write_raster


def test_a_box_over_nothing(anywhere):
    scene = anywhere.scene()
    box = scene.add_box((2, 3, 4), name="box")
    scene.sun.set(azimuth_deg=90, elevation_deg=90, irradiance=1000.0, radius_deg=0)
    lit = scene.lit_area(box, efficiency=0.3)
    assert lit.area == pytest.approx(2 * (2 * 3 + 3 * 4 + 2 * 4), rel=1e-6)
    assert lit.lit_area == pytest.approx(6, rel=1e-6) and lit.projected_area == pytest.approx(6, rel=1e-6)
    assert lit.power == pytest.approx(6 * 1000 * 0.3, rel=1e-6) and lit.irradiance == pytest.approx(1000)
    np.testing.assert_allclose(lit.sun, (0, 0, 1), atol=1e-9)
    assert lit.fraction == pytest.approx(6 / 52, rel=1e-6)
    # Another Sun than the scene's: from the east, 30 degrees high, the projections of two faces.
    low = scene.lit_area(["box"], sun=dict(azimuth_deg=90, elevation_deg=30, radius_deg=0))
    assert low.area.shape == (1,) and low.object == [box]
    assert low.projected_area[0] == pytest.approx(12 * np.cos(np.radians(30)) + 6 * 0.5, rel=1e-6)
    np.testing.assert_allclose(scene.sun.direction, (0, 0, 1), atol=1e-9)


def test_a_box_shades_a_panel_and_stands_on_it(scene):
    """A cube of 1 m at the middle of a panel of 4 m x 4 m, Sun at 45 degrees: 1 m x 1 m of shadow and the cube's base."""
    panel = scene.add_plane(4, 4, name="panel", color=(1, 1, 1))
    scene.add_box((1, 1, 1), name="cube", position=(0, 0, 0.5))
    scene.sun.set(azimuth_deg=90, elevation_deg=45, radius_deg=0)
    lit = scene.lit_area(panel, samples=40_000)
    assert lit.area == pytest.approx(16)
    assert lit.lit_area == pytest.approx(14, abs=0.03)
    assert lit.projected_area == pytest.approx(14 * np.sqrt(0.5), abs=0.03)
    assert scene.lit_area(panel, without="cube").lit_area == pytest.approx(16)
    assert scene.lit_area(panel, obstacles=False).lit_area == pytest.approx(16)
    assert scene.lit_area(panel, both_sides=True, obstacles=False).area == pytest.approx(32)


@pytest.mark.parametrize("mode", ["triangles", "clipmap"])
def test_a_ridge_of_terrain_shades_a_panel(scene, tmp_path, mode):
    """A ridge 10 m high along x = 60 m; the Sun is 45 degrees over the east."""
    z = np.zeros((41, 101), np.float32)
    z[:, 60] = 10.0
    ground = scene.add_terrain(write_raster(tmp_path / "ridge.tif", z, 1.0), name="ridge", mode=mode)
    where = scene.add_frame("where", position=(0, 0, 0))
    panel = scene.add_plane(2, 2, frame=where, name="panel")
    scene.sun.set(azimuth_deg=90, elevation_deg=45, radius_deg=0)
    origin = ground.from_map((60.5, 20.5, 0.0))
    for offset, expected in ((-15.0, 4.0), (-5.0, 0.0), (-10.0, 2.0)):
        where.position = tuple(origin + (offset, 0, 0.001))
        assert scene.lit_area(panel, samples=10_000).lit_area == pytest.approx(expected, abs=0.02), offset
        assert scene.lit_area(panel, terrain=False).lit_area == pytest.approx(4.0)
    where.position = tuple(origin + (-15.0, 0, -0.5))
    assert scene.lit_area(panel).lit_area == 0.0


def test_what_is_rejected(scene, tmp_path):
    ground = scene.add_terrain(write_raster(tmp_path / "level.tif", np.zeros((5, 5), np.float32), 1.0), name="level")
    box = scene.add_box((1, 1, 1), name="box", position=(0, 0, 3))
    hidden = scene.add_box((1, 1, 1), name="hidden", visible=False)
    flat = scene.add_plane(1, 1, name="flat", position=(0, 0, 9))
    for objects, settings, words in (
            (ground.object, {}, "terrain"), ([], {}, "the number of objects is 0"), (hidden, {}, "object 'hidden'"), (box, dict(efficiency=1.5), "1.5"),
            (box, dict(samples=0), "samples"), (box, dict(samples=-3), "-3"), (box, dict(sun=3), "Sun.set"), (box, dict(sun=dict(elevation_deg=3)), "alone"),
            (box, dict(sun=dict(direction=(0, 0, 0))), "direction"), (box, dict(parts=[3]), "name"), (3, {}, "GraphicsObject"), (box, dict(method="guess"), "guess")):
        with pytest.raises(dspace.Error) as told:
            pytest.fail(f"{objects} {settings}: {scene.lit_area(objects, **settings)}")
        assert words in str(told.value), told.value
    with pytest.raises(dspace.NotFound, match="part 'cells'"):
        scene.lit_area([box, flat], parts="cells")
    assert scene.lit_area(box).lit_area > 1


def test_what_is_below_the_ground_is_told(scene, tmp_path):
    """A wall of 2 m by 4 m that faces the Sun, with 1 m of its 4 m below level ground."""
    ground = scene.add_terrain(write_raster(tmp_path / "level.tif", np.zeros((41, 41), np.float32), 1.0), name="level")
    pose = np.eye(4)
    pose[:3, :3] = np.column_stack(((0, 1, 0), (0, 0, 1), (1, 0, 0)))
    pose[:3, 3] = ground.from_map([20.0, 20.0, 1.0])
    wall = scene.add_plane(2.0, 4.0, name="wall", frame=scene.add_frame("wall", pose=pose))
    sun = dict(direction=(1.0, 0.0, 0.0), radius_deg=0.0)
    with pytest.warns(dspace.DspaceWarning, match="object 'wall': 2[45].* % of its area face the Sun and are below the ground"):
        lit = scene.lit_area(wall, sun=sun)
    assert lit.area == pytest.approx(8.0) and lit.lit_area == pytest.approx(6.0, abs=0.05)
    assert scene.lit_area(wall, sun=sun, terrain=False).lit_area == pytest.approx(8.0)
