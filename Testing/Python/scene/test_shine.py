"""Light of planets and of the sky: on planes, against closed forms; recordings; bad input."""
import math

import numpy as np
import pytest

import dspace


@pytest.fixture
def session():
    with dspace.Session() as made:
        yield made


def plane(scene, slope_deg=0.0):
    """The radiance of a white Lambertian plane of this slope, seen from its normal."""
    a = math.radians(slope_deg)
    normal = np.array([math.sin(a), 0.0, math.cos(a)])
    plane = scene.add_plane(10, 10, color=(1, 1, 1), reflectance="lambert",
                            quaternion=(math.cos(a / 2), 0.0, math.sin(a / 2), 0.0))
    camera = scene.add_camera(eye=tuple(5.0 * normal), target=(0, 0, 0), up=(0, 1, 0), fov_deg=10)
    view = scene.add_viewport((9, 9), camera)
    radiance = view.radiance()[4, 4]
    view.remove()
    plane.remove()
    return radiance


@pytest.mark.parametrize("slope", [0.0, 30.0, 90.0, 140.0])
def test_a_sky_shines_on_what_faces_it(session, slope):
    scene = session.scene()
    scene.lights["sun"].remove()
    scene.add_sky(120.0, color=(1.0, 0.8, 0.6))
    expected = 120.0 / math.pi * 0.5 * (1.0 + math.cos(math.radians(slope)))
    linear = [1.0, ((0.8 + 0.055) / 1.055) ** 2.4, ((0.6 + 0.055) / 1.055) ** 2.4]
    np.testing.assert_allclose(plane(scene, slope), expected * np.array(linear), rtol=1e-3)


def test_full_and_half_earth_over_the_moon(session):
    scene = session.scene()
    scene.lights["sun"].remove()
    light = scene.add_planetshine(direction=(0.0, 0.0, 2.0), body="earth", distance=384.4e6)
    # 1361 * 0.434 * (6371 / 384400)^2
    assert light.intensity * 1361.0 == pytest.approx(0.16225, rel=1e-3)
    assert light.radius_deg == pytest.approx(0.9496, abs=1e-3)
    assert plane(scene)[1] == pytest.approx(0.16225 / math.pi, rel=1e-3)
    light.remove()
    half = scene.add_planetshine(direction=(0.0, 0.0, 2.0), body="earth", distance=384.4e6, phase_deg=90)
    assert half.intensity * 1361.0 == pytest.approx(0.16225 / math.pi, rel=1e-3)
    half.remove()
    new = scene.add_planetshine(direction=(0, 0, 1), radius=1e6, albedo=1.0, distance=1e7, phase_deg=180)
    assert new.intensity == pytest.approx(0.0, abs=1e-12)


def test_the_phase_function_is_the_integral_over_the_lit_part_of_a_sphere():
    from dspace.scene.shine import lambert_phase
    z, azimuth = np.meshgrid((np.arange(800) + 0.5) / 400 - 1, (np.arange(800) + 0.5) / 400 * np.pi)
    r = np.sqrt(1 - z * z)
    normals = np.stack([r * np.cos(azimuth), r * np.sin(azimuth), z])
    for phase in (0.0, 35.0, 90.0, 150.0):
        sun = (math.cos(math.radians(phase)), math.sin(math.radians(phase)), 0.0)
        seen = np.maximum(normals[0], 0) * np.maximum(np.tensordot(sun, normals, 1), 0)
        full = np.maximum(normals[0], 0) ** 2
        assert lambert_phase(phase) == pytest.approx(seen.sum() / full.sum(), abs=1e-3)


def test_recordings_show_the_same(session, tmp_path):
    scene = session.scene()
    with session.record(tmp_path / "shine.dspace"):
        scene.add_sphere(1.0)
        scene.add_sky(400.0, up=(0.2, 0, 1))
        scene.add_planetshine(direction=(1, 0, 0.2), body="mars", distance=9.4e6, irradiance=589.0)
        view = scene.add_viewport((64, 64), scene.add_camera(eye=(4, 0, 1), target=(0, 0, 0)))
        scene.time = 1.0
        live = view.image()
    with dspace.Playback(tmp_path / "shine.dspace") as run:
        run.seek(1.0)
        np.testing.assert_array_equal(next(iter(run.session.viewports.values())).image(), live)


def test_bad_input_changes_nothing(session):
    scene = session.scene()
    for call, message in ((lambda: scene.add_sky(-1.0), "0 to 1.361e15"),
                          (lambda: scene.add_sky(1.0, up=(0, 0, 0)), "direction"),
                          (lambda: scene.add_planetshine((0, 0, 1), body="vulcan", distance=1e9), "earth, jupiter"),
                          (lambda: scene.add_planetshine((0, 0, 1), body="earth"), "distance is 'not given'"),
                          (lambda: scene.add_planetshine((0, 0, 1), body="earth", distance=6e6), "more than the radius"),
                          (lambda: scene.add_planetshine((0, 0, 1), body="earth", distance=4e8, phase_deg=200), "0 .full. to 180"),
                          (lambda: scene.add_planetshine((0, 0, 0), body="earth", distance=4e8), "direction")):
        with pytest.raises(dspace.InvalidArgument, match=message):
            call()
    assert list(scene.lights) == ["sun"]
