"""Wheel tracks: ruts that are drawn, answered, saved and cleared."""
import json
import pathlib

import numpy as np
import pytest

import dspace
from dspace.errors import InvalidArgument, NotFound, WrongType
from dspace.rover import Path, load_vehicle

DATA = pathlib.Path(__file__).resolve().parents[3] / "Data"
X, Y = -4.0, 3.0


@pytest.fixture
def terrain(scene, field):
    """z = x / 2, posts 1/32 m apart."""
    return scene.add_terrain(field, subdivisions=5)


def lengthwise(n=21):
    """Contacts from (X, Y), a metre along X."""
    return np.column_stack([np.linspace(X, X + 1, n), np.full(n, Y)])


def test_queries_see_ruts_and_undisturbed_does_not(terrain):
    x = np.linspace(X, X + 1, 50)
    before = terrain.height(x, Y)
    terrain.track({"wheel": lengthwise()}, width=0.2, sinkage=0.05)
    assert np.allclose(terrain.height(x, Y), before - 0.05, atol=1e-6)
    assert np.array_equal(terrain.undisturbed.height(x, Y), before)
    assert np.array_equal(terrain.undisturbed.heights(np.column_stack([x, x * 0 + Y])), before)
    slope = terrain.undisturbed.slope_deg(X + 0.5, Y + 0.11)
    assert terrain.slope_deg(X + 0.5, Y + 0.11) > slope + 10  # its wall
    terrain.clear_tracks()
    assert np.array_equal(terrain.height(x, Y), before)
    assert terrain.tracks == {"length": 0, "contacts": 0, "bytes": 0}


def test_a_track_goes_on_where_it_was(terrain):
    before = terrain.height(X + 0.5, Y)
    terrain.track({"a": (X, Y), "b": (X, Y + 1)}, width=0.2, sinkage={"a": 0.03, "b": 0.06})
    terrain.track({"a": (X + 1, Y), "b": (X + 1, Y + 1)}, width=0.2, sinkage={"a": 0.03, "b": 0.06})
    assert terrain.height(X + 0.5, Y) == pytest.approx(before - 0.03, abs=1e-6)
    assert terrain.tracks["length"] == pytest.approx(2.0)
    depth = terrain.undisturbed.height(X + 0.5, Y + 1) - terrain.height(X + 0.5, Y + 1)
    assert depth == pytest.approx(0.06, abs=1e-6)
    terrain.track({"a": (X + 3, Y)}, width=0.2, sinkage=0.03, begin=True)  # carried there
    assert terrain.height(X + 2, Y) == terrain.undisturbed.height(X + 2, Y)


def test_the_tread_follows_the_distance_rolled(terrain):
    terrain.track({"wheel": [(X, Y), (X + 1, Y)]}, width=0.2, sinkage=0.05, rolled=[0.0, 2.0],
                  tread_pitch=0.4, tread_depth=0.02)  # it slips: 0.2 m of ground a bar
    x = X + np.arange(6, 26) / 32  # posts
    depth = terrain.undisturbed.height(x, Y) - terrain.height(x, Y)
    expected = 0.05 + 0.02 * 0.5 * (1 - np.cos(2 * np.pi * (x - X) * 2.0 / 0.4))
    assert np.allclose(depth, expected, atol=2e-6)


def test_depth_images_show_the_sinkage(scene, terrain):
    """At each pixel on the floor, to a millimetre and what placing vertices to 1/256 pixel costs; from
    near, where all posts are drawn."""
    terrain.track({"wheel": [(X - 1, Y), (X + 1, Y)]}, width=0.4, sinkage=0.07)
    eye, target = np.array((X, Y - 0.5, X / 2 + 0.8)), np.array((X, Y, X / 2))
    scene.add_camera("eye", eye=eye, target=target, fov_deg=40, near=0.05)
    view = scene.add_viewport((240, 180), "eye", samples=1)
    forward = (target - eye) / np.linalg.norm(target - eye)
    right = np.cross(forward, (0, 0, 1)) / np.linalg.norm(np.cross(forward, (0, 0, 1)))
    down = np.cross(forward, right)
    pixel = 2 * np.tan(np.radians(20)) / 180
    x, y = (np.arange(240) - 119.5) * pixel, (np.arange(180) - 89.5) * pixel
    rays = forward + x[None, :, None] * right + y[:, None, None] * down
    for sinkage in (0.07, 0.0):
        depth = view.depth()
        p = eye + rays * depth[..., None]
        floor = (np.abs(p[..., 1] - Y) < 0.2 - 0.05) & (np.abs(p[..., 0] - X) < 0.5)
        assert floor.sum() > 2000
        tolerance = 1e-3 + 2 * np.sqrt(2) / 512 * pixel * depth[floor]
        assert (np.abs(p[..., 2] - (p[..., 0] / 2 - sinkage))[floor] <= tolerance).all()
        terrain.clear_tracks()


def test_the_ground_is_darker_where_wheels_rolled(scene, field):
    """Unlit, so that the ground's own colour shows: linear light times 0.65, or another colour."""
    terrain = scene.add_terrain(field, subdivisions=5, color=(0.8, 0.8, 0.8), lit=False)
    scene.add_camera("eye", eye=(X, Y, X / 2 + 0.9), target=(X + 0.05, Y, X / 2), fov_deg=40, near=0.05)
    view = scene.add_viewport((160, 120), "eye", samples=1)
    middle, beside = (60, 80), (5, 80)  # on the floor, and 0.3 m from it
    before = view.image()
    terrain.track({"wheel": [(X, Y - 2), (X, Y + 2)]}, width=0.2)
    dark = view.image()
    linear = ((0.8 + 0.055) / 1.055) ** 2.4
    expected = 1.055 * (0.65 * linear) ** (1 / 2.4) - 0.055
    assert np.abs(before[middle] / 255 - 0.8).max() < 0.004
    assert np.abs(dark[middle] / 255 - expected).max() < 0.004
    assert (dark[beside] == before[beside]).all()
    terrain.set_style(tracks="red")
    red = view.image()
    assert tuple(red[middle]) == (255, 0, 0) and (red[beside] == before[beside]).all()
    terrain.clear_tracks()
    assert (view.image() == before).all()
    with pytest.raises(InvalidArgument, match="opacity"):
        terrain.set_style(tracks={"color": "red", "opacity": 2.0})


def test_saved_and_loaded(terrain, tmp_path):
    path = tmp_path / "tracks.geojson"
    terrain.track({"left": lengthwise(), "right": lengthwise() + (0.0, 1.0)}, width=0.2, sinkage=0.05,
                  tread_pitch=0.1, tread_depth=0.01, heading_deg=0.0)
    xy = np.random.default_rng(1).uniform((X, Y - 0.3), (X + 1, Y + 1.3), (500, 2))
    ruts = terrain.heights(xy)
    terrain.save_tracks(path)
    file = json.loads(path.read_text())
    assert [f["properties"]["wheel"] for f in file["features"]] == ["left", "right"]
    assert file["features"][0]["properties"]["tread_pitch"] == 0.1
    line = np.array(file["features"][1]["geometry"]["coordinates"])
    expected = terrain.to_map(np.array([[X, Y + 1, 0.0], [X + 1, Y + 1, 0.0]]))[:, :2]
    assert np.allclose(line[[0, -1], :2], expected, atol=1e-9)
    terrain.clear_tracks()
    terrain.load_tracks(path)
    assert np.allclose(terrain.heights(xy), ruts, atol=1e-6)
    terrain.track({"left": (X + 2, Y)}, width=0.2, sinkage=0.05, wall=0.02, tread_pitch=0.1,
                  tread_depth=0.01, heading_deg=0.0)  # goes on
    assert terrain.height(X + 1.5, Y) < terrain.undisturbed.height(X + 1.5, Y) - 0.04


def test_a_vehicle_leaves_ruts_and_does_not_sink_twice(scene):
    terrain = scene.add_terrain(DATA / "field/field.tif", subdivisions=3)
    vehicle = load_vehicle(DATA / "rover/rover.urdf")
    path = Path([(0, 0), (2, 0.5), (4, 0)], speed=0.5)
    for time in np.arange(0.0, 4.0, 0.25):
        state = vehicle.solve(path.pose(time), terrain.undisturbed)
        terrain.track(state, width=0.15, sinkage=0.03)
    assert terrain.tracks["length"] > 0.9 * len(state.wheel_centers) * 3.75 * 0.5
    again = vehicle.solve(path.pose(3.75), terrain.undisturbed)
    np.testing.assert_array_equal(again.position, state.position)
    for point in state.wheel_centers.values():
        before = terrain.undisturbed.height(*point[:2])
        assert terrain.height(*point[:2]) <= before - 0.03 + 1e-6


def test_what_is_refused_changes_nothing(scene, terrain, field, tmp_path):
    with pytest.raises(WrongType, match="wheels"):
        terrain.track([(0, 0)], width=0.2)
    with pytest.raises(InvalidArgument, match="'a'.*shape"):
        terrain.track({"a": [1.0, 2.0, 3.0, 4.0]}, width=0.2)
    with pytest.raises(InvalidArgument, match="width"):
        terrain.track({"a": (X, Y)}, width=0.0)
    with pytest.raises(InvalidArgument, match="sinkage"):
        terrain.track({"a": (X, Y), "b": (X, Y)}, width=0.2, sinkage={"a": 0.1, "b": -0.1})
    with pytest.raises(InvalidArgument, match="'c'"):
        terrain.track({"a": (X, Y)}, width=0.2, sinkage={"c": 0.1})
    with pytest.raises(InvalidArgument, match="rolled.*shape"):
        terrain.track({"a": lengthwise()}, width=0.2, rolled=[1.0, 2.0])
    with pytest.raises(NotFound, match="absent"):
        terrain.load_tracks(tmp_path / "absent.geojson")
    assert terrain.tracks["contacts"] == 0
    with pytest.raises(InvalidArgument, match="subdivisions"):
        scene.add_terrain(field, subdivisions=13)
    with pytest.raises(InvalidArgument, match="subdivisions"):
        scene.add_terrain(field, subdivisions=13, mode="triangles")


def test_a_full_budget_is_an_error(scene, field):
    terrain = scene.add_terrain(field, track_budget=65536, mode="clipmap")
    with pytest.raises(dspace.Error, match="65536"):
        for i in range(1000):
            terrain.track({"a": np.random.default_rng(i).uniform(-9, 9, (20, 2))}, width=0.2)
    assert 0 < terrain.tracks["bytes"] <= 65536
