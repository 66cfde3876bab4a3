"""Bodies: radii, phases, textures, replay, and what is rejected."""
import math

import numpy as np
import pytest

import dspace

SUN_AT_1_AU = 1361.0


@pytest.fixture
def session():
    with dspace.Session() as session:
        yield session


def look(scene, eye, target, fov_deg, size=101):
    scene.add_camera(eye=eye, target=target, fov_deg=fov_deg)
    return scene.add_viewport(size=(size, size))


def irradiance(view, fov_deg, size=101):
    edge = 2.0 * math.tan(math.radians(0.5 * fov_deg)) / size
    grid = (np.arange(size) - 0.5 * (size - 1)) * edge
    cosine = 1.0 / np.sqrt(1.0 + grid[:, None] ** 2 + grid[None, :] ** 2)
    return (view.radiance()[:, :, 1] * edge ** 2 * cosine ** 3).sum()


def test_the_full_moon_is_as_bright_as_its_geometric_albedo_says(session):
    scene = session.scene()
    distance = 384.4e6
    scene.sun.direction = (-1, 0, 0)  # behind the camera
    scene.add_body("moon", position=(distance, 0, 0))
    for fov in (1.0, 30.0):  # a disc of 50 pixels, and one of 1.7
        view = look(scene, (0, 0, 0), (1, 0, 0), fov)
        expected = SUN_AT_1_AU * 0.12 * (1737.4e3 / distance) ** 2
        assert irradiance(view, fov) == pytest.approx(expected, rel=0.03)


def test_picks_labels_and_depth_name_the_body(session):
    scene = session.scene()
    moon = scene.add_body("moon", position=(4e6, 0, 0))
    view = look(scene, (0, 0, 0), (1, 0, 0), 60.0)
    hit = view.pick(50, 50)
    assert hit.object.name == moon.name == "moon"
    assert hit.in_root[0] == pytest.approx(4e6 - 1737.4e3, abs=1.0)
    assert view.depth()[50, 50] == pytest.approx(4e6 - 1737.4e3, rel=1e-6)


def test_a_recording_has_all_that_the_table_gave(session, tmp_path):
    path = tmp_path / "bodies.dspace"
    scene = session.scene()
    with session.record(path):
        scene.add_body("saturn", position=(4e8, 0, 0), quaternion=(0.94, 0.0, 0.342, 0.0) / np.linalg.norm((0.94, 0.342)))
        scene.sun.direction = (-1, 0.4, 0.3)
        view = look(scene, (0, 0, 0), (1, 0, 0), 50.0)
        scene.time = 1.0
        before = view.image()
    assert before.max() > 60
    with dspace.Playback(path) as run:
        run.seek(1.0)
        np.testing.assert_array_equal(next(iter(run.session.viewports.values())).image(), before)


def test_what_is_wrong_is_rejected_by_name(session):
    scene = session.scene()
    with pytest.raises(dspace.NotFound, match="vulcan.*mercury"):
        scene.add_body("vulcan")
    with pytest.raises(dspace.InvalidArgument, match="neither body nor radii"):
        scene.add_body()
    with pytest.raises(dspace.InvalidArgument, match="a radius is 0"):
        scene.add_body(radii=0.0)
    with pytest.raises(dspace.InvalidArgument, match="shape"):
        scene.add_body(radii=(1.0, 2.0))
    with pytest.raises(dspace.InvalidArgument, match="inner radius of a ring is 1"):
        scene.add_body("saturn", rings=[(1.0, 2.0, 1.0)])
    with pytest.raises(dspace.InvalidArgument, match="height"):
        scene.add_body("earth", atmosphere={"rayleigh": 1e-6, "rayleigh_height": 0.0})
    with pytest.raises(dspace.WrongType):
        scene.add_body("earth", atmosphere={"colour": 1})
    assert not [each for each in scene.objects if "vulcan" in each]
