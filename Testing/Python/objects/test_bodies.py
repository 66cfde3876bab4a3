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


def linear(image):
    """Linear light of an sRGB picture's green."""
    c = image[:, :, 1] / 255.0
    return np.where(c <= 0.04045, c / 12.92, ((c + 0.055) / 1.055) ** 2.4)


def test_a_planet_that_is_a_point_has_the_gain_and_spread_of_stars(session):
    """Venus, full, 1e11 m away, as bright as its albedo says, times the gain, in a Gaussian of the spread."""
    scene, distance, fov, gain = session.scene(), 1e11, 30.0, 1.7e5
    scene.sun.direction = (-1, 0, 0)
    scene.add_body(radii=6.05e6, albedo=0.65, position=(distance, 0.01 * distance, 0), point_gain=gain, point_spread=3.0)
    view = look(scene, (0, 0, 0), (1, 0, 0), fov)
    view.set(fill=0.0)
    light = linear(view.image())
    edge = 2.0 * math.tan(math.radians(0.5 * fov)) / 101
    expected = gain * 0.65 * math.pi * (6.05e6 / distance) ** 2 / edge ** 2  # 1: white matter that faces the Sun
    assert 0.3 < light.max() < 1.0
    assert light.sum() == pytest.approx(expected, rel=0.03)
    rows, columns = np.mgrid[0:101, 0:101]
    middle = (light * columns).sum() / light.sum()
    assert middle == pytest.approx(50.0 - 0.01 / edge, abs=0.05)
    assert (light * (columns - middle) ** 2).sum() / light.sum() == pytest.approx(9.0, rel=0.06)
    true = SUN_AT_1_AU * 0.65 * (6.05e6 / distance) ** 2  # captures of radiance have no gain
    assert irradiance(view, fov) == pytest.approx(true, rel=0.01)
    assert view.radiance()[:, :, 1].argmax() == light.argmax()


# V of r d = 1 au^2 by the phase angle a [deg]: A. Mallama, J. L. Hilton, "Computing apparent planetary magnitudes for The
# Astronomical Almanac", Astronomy and Computing 25 (2018). The tolerance is that of Lambert's phases.
MAGNITUDES = {"venus": (lambda a: -4.384 - 1.044e-3 * a + 3.687e-4 * a ** 2 - 2.814e-6 * a ** 3 + 8.938e-9 * a ** 4, 0.3),
              "mars": (lambda a: -1.601 + 2.267e-2 * a - 1.302e-4 * a ** 2, 0.6),
              "jupiter": (lambda a: -9.395 - 3.7e-4 * a + 6.16e-4 * a ** 2, 0.1), "neptune": (lambda a: -7.0, 0.1)}


@pytest.mark.parametrize("planet", MAGNITUDES)
def test_a_planet_in_the_sky_is_as_bright_as_published(session, planet):
    scene, au = session.scene(), 149597870700.0
    scene.time = "2026-11-28T05:00"
    scene.add_body("sun", center="earth")
    scene.add_body(planet, center="earth", correction="CN+S", point_gain=3e5, point_spread=0.9)
    place, from_sun = (scene.ephemeris(planet, observer, correction="LT").position for observer in ("earth", "sun"))
    away, sunward = np.linalg.norm(place), np.linalg.norm(from_sun)
    phase = math.degrees(math.acos(place @ from_sun / away / sunward))
    view = look(scene, (0, 0, 0), tuple(1e9 * place / away), 0.2)
    magnitude = -26.76 - 2.5 * math.log10(irradiance(view, 0.2) / SUN_AT_1_AU)
    expected, tolerance = MAGNITUDES[planet]
    assert magnitude == pytest.approx(expected(phase) + 5.0 * math.log10(away * sunward / au ** 2), abs=tolerance)


def test_a_disc_of_two_pixels_has_neither_gain_nor_spread(session):
    scene, fov = session.scene(), 30.0
    scene.sun.direction = (-1, 0.3, 0)
    edge = 2.0 * math.tan(math.radians(0.5 * fov)) / 101
    plain = scene.add_body("moon", name="plain", position=(1737.4e3 / (2.1 * edge), 0, 0))
    view = look(scene, (0, 0, 0), (1, 0, 0), fov)
    before = view.image()
    plain.remove()
    scene.add_body("moon", position=(1737.4e3 / (2.1 * edge), 0, 0), point_gain=3e5, point_spread=2.0)
    assert np.array_equal(view.image(), before)
    for bad in ({"point_gain": -1.0}, {"point_spread": 21.0}, {"point_gain": float("nan")}):
        with pytest.raises(dspace.InvalidArgument, match="point"):
            scene.add_body("mars", **bad)


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
