"""Measurements by pictures against rays: wherever the rays' margin exceeds an angle of a pixel, they agree."""
import os
import pathlib

import numpy as np
import pytest

import dspace
from terrain_support import write_raster

GALE = pathlib.Path(os.environ.get("DSPACE_DATA", "/nonexistent")) / "terrain" / "mars_gale_mola_128ppd_m.tif"
LONG = bool(os.environ.get("DSPACE_LONG"))


@pytest.fixture
def gale(scene):
    if not GALE.exists():
        pytest.skip(f"real data absent: set DSPACE_DATA to the folder that has terrain/{GALE.name}")
    # Pictures draw ground beyond half a level's posts more coarsely than rays see it: with 252 posts that is 58 km away.
    return scene.add_terrain(GALE, name="gale", on_body=True, level_size=252)


def random_sites(terrain, count, seed, height):
    left, bottom, right, top = terrain.map_extent
    random = np.random.default_rng(seed)
    inner = 0.3
    x = random.uniform(left + inner, right - inner, count)
    y = random.uniform(min(bottom, top) + inner, max(bottom, top) - inner, count)
    return x, y, np.full(count, height)


def test_lines_over_gale(scene, gale):
    count = 1000 if LONG else 120
    x0, y0, h0 = random_sites(gale, count, 5, 3.0)
    random = np.random.default_rng(6)
    turn, far = random.uniform(0, 2 * np.pi, count), random.uniform(0.01, 0.25, count)  # 0.6 to 15 km
    lines = scene.line_of_sight(gale.site(x0, y0, h0), gale.site(x0 + far * np.cos(turn), y0 + far * np.sin(turn), h0 + 2.0),
                                method="both")
    assert 0.2 < lines.clear.mean() < 0.8
    sure = np.abs(lines.clearance_deg) > lines.image_pixel_deg
    assert sure.sum() > 0.7 * count
    wrong = np.flatnonzero(sure & (lines.clear != lines.image_clear))
    assert [bool(text) for text in lines.difference] == list(lines.clear != lines.image_clear)
    assert all("less than a pixel" in text for text in lines.difference if text)
    assert not wrong.size, [(i, lines.clear[i], lines.range[i], lines.clearance_deg[i], lines.distance[i]) for i in wrong]


def test_horizons_over_gale(scene, gale):
    """A column of pixels shows an azimuth up to half a pixel beside: the picture's horizon lies between the rays' around it."""
    x, y, h = random_sites(gale, 100 if LONG else 3, 7, 3.0)
    for site in zip(x, y, h):
        horizon = scene.horizon(gale.site(*site), 2880, method="both", resolution=1024)
        around = np.stack([np.roll(horizon.elevation_deg, i) for i in (-1, 0, 1)])
        pixel = horizon.image_pixel_deg
        low, high = around.min(axis=0) - horizon.image_elevation_deg, horizon.image_elevation_deg - around.max(axis=0)
        near = np.stack([np.roll(horizon.distance, i) for i in (-1, 0, 1)]).max(axis=0) < 48_000.0  # little of a coarser level shows
        assert near.mean() > 0.3
        assert low[near].max() < 0.75 * pixel and high[near].max() < 0.75 * pixel
        assert low.max() < 0.3 and high.max() < 0.3  # coarser levels
        seen = horizon.elevation_deg > -90.0
        np.testing.assert_allclose(horizon.image_difference_deg[seen], (horizon.image_elevation_deg - horizon.elevation_deg)[seen])
        alone = scene.horizon(gale.site(*site), 2880, method="image", resolution=1024)
        assert alone.image_difference_deg is None
        assert np.array_equal(alone.elevation_deg, horizon.image_elevation_deg) and np.array_equal(alone.distance, horizon.image_distance)
        assert alone.method == "image" and horizon.method == "both"


def test_a_post_half_a_metre_high_flips_both(scene, tmp_path):
    z = np.zeros((101, 101), np.float32)
    flat = scene.add_terrain(write_raster(tmp_path / "flat.tif", z), name="flat", mode="triangles")
    line = scene.line_of_sight(flat.site(30.5, 50.5, 0.4), flat.site(70.5, 50.5, 0.4), method="both")
    assert line.clear and line.image_clear
    flat.remove()
    z[50, 50] = 0.5
    post = scene.add_terrain(write_raster(tmp_path / "post.tif", z), name="post", mode="triangles")
    line = scene.line_of_sight(post.site(30.5, 50.5, 0.4), post.site(70.5, 50.5, 0.4), method="both")
    assert not line.clear and not line.image_clear and line.difference == ""
    alone = scene.line_of_sight(post.site(30.5, 50.5, 0.4), post.site(70.5, 50.5, 0.4), method="image")
    assert not alone.clear and alone.distance == pytest.approx(line.distance, abs=1e-3)
    assert alone.point == pytest.approx(line.point, abs=1e-3) and np.isnan(alone.clearance_deg)
    assert alone.difference is None and "None" not in repr(alone) and "blocked after" in repr(alone)


@pytest.mark.parametrize("clearance_deg, text", [(-0.01, "by 0.0100 deg, less than a pixel (0.0500 deg)"),
                                                 (0.2, "by 0.2000 deg, more than a pixel (0.0500 deg): distant ground")])
def test_a_difference_says_why(clearance_deg, text):
    clear = clearance_deg > 0
    line = dspace.LinesOfSight(clear, "", None, np.full(3, np.nan), np.inf, 10.0, 1.0, clearance_deg, None, not clear, 0.05)
    assert text in line.difference and line.difference.startswith(f"in the picture it is {'blocked' if clear else 'clear'}")


def test_objects_count_and_what_is_left_out_does_not(scene):
    box = scene.add_box((1.0, 1.0, 1.0), name="box", frame=scene.add_frame("box", position=(5.0, 0.0, 0.0)))
    ornament = scene.add_box((1.0, 1.0, 1.0), name="ornament", frame=scene.add_frame("ornament", position=(2.0, 0.0, 0.0)),
                             ornamental=True)
    ends = ((0.0, 0.0, 0.0), (10.0, 0.0, 0.0))
    line = scene.line_of_sight(*ends, method="image")
    assert not line.clear and line.distance == pytest.approx(4.5, abs=1e-4)
    assert scene.line_of_sight(*ends, method="image", without=[box]).clear
    assert scene.line_of_sight(*ends, method="image", objects=False).clear
    assert box.visible and ornament.visible  # as before
    assert list(scene.vantages) == ["main"]
    horizon = scene.horizon((0.0, 0.0, 0.0), 4, method="both", resolution=1024)
    assert horizon.elevation_deg[1] == pytest.approx(np.degrees(np.arctan2(0.5, 4.5)), abs=1e-6)
    assert horizon.image_elevation_deg[1] == pytest.approx(horizon.elevation_deg[1], abs=horizon.image_pixel_deg)
    assert list(horizon.image_elevation_deg[[0, 2, 3]]) == [-90.0] * 3
    # Where the pictures were taken from and towards: north, east, south, west, with Z forward and Y down. The box's upper edge
    # is 4.5 m east and 0.5 m up, and is seen by the middle of a pixel below it.
    forward = [pose.matrix[:3, 2].tolist() for pose in horizon.image_cameras]
    np.testing.assert_allclose(forward, [(0, 1, 0), (1, 0, 0), (0, -1, 0), (-1, 0, 0)], atol=1e-12)
    np.testing.assert_allclose([pose.matrix[:3, 1] for pose in horizon.image_cameras], [(0, 0, -1)] * 4, atol=1e-12)
    assert max(np.abs(pose.position).max() for pose in horizon.image_cameras) < 1e-5
    np.testing.assert_allclose(horizon.image_point[1], (4.5, 0.0, 0.5), atol=0.012)
    assert horizon.image_distance[1] == pytest.approx(np.hypot(4.5, 0.5), abs=2e-3)
    assert np.isinf(horizon.image_distance[[0, 2, 3]]).all() and np.isnan(horizon.image_point[[0, 2, 3]]).all()


def test_the_projected_area_of_a_cube(scene):
    """A unit cube along its diagonal has sqrt(3); behind a wall that hides half of it, half."""
    cube = scene.add_box((1.0, 1.0, 1.0), name="cube")
    sun = dict(direction=(1.0, 1.0, 1.0), radius_deg=0.0)
    lit = scene.lit_area(cube, sun=sun, method="both", resolution=1024)
    assert lit.image_projected_area == pytest.approx(np.sqrt(3.0), rel=3e-3)  # the outline's pixels
    assert lit.image_projected_area == pytest.approx(lit.projected_area, rel=3e-3)
    alone = scene.lit_area(cube, sun=sun, method="image", resolution=1024)
    assert alone.projected_area == lit.image_projected_area and np.isnan(alone.lit_area)
    bare = scene.lit_area(cube, sun=sun, method="image", resolution=1024, obstacles=False)
    assert bare.image_projected_area == lit.image_projected_area  # it is drawn although it is no obstacle
    side = np.array((1.0, -1.0, 0.0)) / np.sqrt(2.0)
    far = np.array((1.0, 1.0, 1.0)) / np.sqrt(3.0)
    pose = np.eye(4)
    pose[:3, :3] = np.column_stack((side, np.cross(far, side), far))
    pose[:3, 3] = 30_000.0 * far + 5.0 * side
    scene.add_plane(10.0, 10.0, name="wall", frame=scene.add_frame("wall", pose=pose))
    lit = scene.lit_area(cube, sun=sun, method="both", resolution=1024)
    assert lit.image_projected_area == pytest.approx(np.sqrt(3.0) / 2.0, rel=5e-3)
    assert lit.projected_area == pytest.approx(np.sqrt(3.0) / 2.0, rel=2e-2)


def test_bad_input(scene):
    scene.add_box((1.0, 1.0, 1.0), name="box")
    with pytest.raises(dspace.InvalidArgument, match="accepted: 16 to 16,384 pixels"):
        scene.line_of_sight((2.0, 0, 0), (3.0, 0, 0), method="image", resolution=8)
    with pytest.raises(dspace.InvalidArgument, match="image.*both"):
        scene.line_of_sight((2.0, 0, 0), (3.0, 0, 0), resolution=512)
    with pytest.raises(dspace.InvalidArgument, match="whole objects"):
        scene.lit_area("box", parts="box", method="image")
