"""Exposures of moving scenes against closed forms: the blur of a bar, and its slant under a rolling shutter."""
import numpy as np
import pytest

import dspace

MODEL = dspace.CameraModel("pinhole", size=(80, 60), focal=(60, 60), center=(39.5, 29.5))
SLACK = 0.5 / 8 + 0.03  # [pixels] of an upright edge: half of one of 8 samples, and the interpolation of source pixels


@pytest.fixture
def bar(scene):
    """A function of a time [s] that moves a bar of 20 x 100 pixels by 10 pixels a second; its radiance is 1 a pixel."""
    scene.sun.set(direction=(0, 0, -1))
    moving = scene.add_frame("moving")
    scene.add_frame("body")
    scene.add_plane(2.0, 10.0, frame=moving, position=(0, 0, 6.0), color=(1, 1, 1))
    calls = []

    def at(time):
        calls.append(time)
        moving.pose = dspace.Pose(position=(time, 0.0, 0.0))

    at.calls = calls
    return at


def expose(scene, at, shutter, **settings):
    settings = {"color": False, "radiance": True, **settings}
    return scene.simulate_exposure(shutter, at, MODEL, frame="body", **settings)


def edge(x, blur):
    """How much of a pixel, x pixels behind an edge that moves by `blur` pixels, is covered in the mean."""
    s = lambda v: 0.5 * np.maximum(v, 0.0) ** 2
    a = 0.5 * blur
    return (s(x + a + 0.5) - s(x + a - 0.5) - s(x - a + 0.5) + s(x - a - 0.5)) / blur


def test_a_moving_bar_is_a_trapezoid(scene, bar):
    still = scene.simulate_image(MODEL, frame="body", color=False, radiance=True)["radiance"][..., 0]
    full = still[30, 40]
    blurred = expose(scene, bar, dspace.Shutter(0.8, samples=64))["radiance"][..., 0]
    u = np.arange(80) - 39.5
    expected = edge(u + 10.0, 8.0) - edge(u - 10.0, 8.0)
    assert expected.max() == 1.0 and 7 < ((expected > 0.05) & (expected < 0.95)).sum() / 2 < 9
    # A pixel of the still bar's border is off by some hundredths, and an instant is an eighth of a pixel.
    np.testing.assert_allclose(blurred[30] / full, expected, atol=0.02)
    assert np.abs(still[30] / full - expected).max() > 0.3
    assert blurred.sum() == pytest.approx(still.sum(), rel=1e-3)  # light is kept
    times = np.array(bar.calls)
    assert len(times) == 65 and times[-1] == 0.0
    np.testing.assert_allclose(times[:-1], 0.8 * ((np.arange(64) + 0.5) / 64 - 0.5))


@pytest.mark.parametrize("direction, sign", [("down", 1.0), ("up", -1.0)])
def test_a_rolling_shutter_slants_the_bar(scene, bar, direction, sign):
    planes = expose(scene, bar, dspace.Shutter(1e-6, 0.9, direction, samples=1, bands=60), label=True, samples=8)
    light = planes["radiance"][..., 0].astype(float)
    places = (light * np.arange(80)).sum(axis=1) / light.sum(axis=1)
    rows = np.arange(60)
    np.testing.assert_allclose(places, 39.5 + sign * 9.0 * (rows - 29.5) / 59, atol=SLACK)
    seen = planes["label"] > 0
    middles = (seen * np.arange(80)).sum(axis=1) / seen.sum(axis=1)
    np.testing.assert_allclose(middles, places, atol=0.5 + SLACK)  # labels are of their row's time


def test_fewer_bands_are_steps(scene, bar):
    shutter = dspace.Shutter(1e-6, 0.9, samples=1, bands=6)
    assert [(first, last) for first, last, _ in shutter.rows(60)] == [(10 * i, 10 * i + 10) for i in range(6)]
    light = expose(scene, bar, shutter, samples=8)["radiance"][..., 0].astype(float)
    places = (light * np.arange(80)).sum(axis=1) / light.sum(axis=1)
    np.testing.assert_allclose(places, np.repeat(39.5 + 9.0 * (10 * np.arange(6) + 4.5 - 29.5) / 59, 10), atol=SLACK)
    assert len(dspace.Shutter(1.0, 1.0, bands=64).rows(7)) == 7 and len(dspace.Shutter(1.0).rows(7)) == 1


def test_without_motion_it_is_the_picture(scene, bar):
    shutter = dspace.Shutter(0.5, 0.2, samples=3, bands=7)
    still = scene.simulate_image(MODEL, frame="body", radiance=True, depth=True, label=True, normal=True)
    planes = expose(scene, lambda time: None, shutter, color=True, depth=True, label=True, normal=True)
    assert set(planes) == set(still)
    for name in ("radiance", "depth", "label", "normal"):
        assert planes[name].tobytes() == still[name].tobytes(), name
    assert np.abs(planes["color"].astype(int) - still["color"]).max() <= 1
    assert planes["color"].shape == (60, 80, 4)
    only = expose(scene, lambda time: None, shutter, radiance=False, depth=True)
    assert set(only) == {"depth", "lens"}


def test_the_same_bytes_again_and_in_tiles(scene, bar):
    shutter = dspace.Shutter(0.3, 0.1, samples=4, bands=5)
    first = expose(scene, bar, shutter, color=True)
    for tile in (64, 512):
        again = expose(scene, bar, shutter, color=True, tile=tile)
        assert all(first[name].tobytes() == again[name].tobytes() for name in ("radiance", "color"))


def test_electrons_of_a_blurred_bar(scene, bar):
    """A detector counts what the mean radiance makes."""
    sensor = dspace.Sensor(exposure_s=0.01, bands_nm=[(600, 700)], photon_noise=False)
    planes = expose(scene, bar, dspace.Shutter(0.4, samples=16))
    electrons = sensor.electrons(planes["radiance"])
    np.testing.assert_allclose(electrons[..., 0], planes["radiance"].mean(axis=-1) * sensor.response[0], rtol=1e-5)


def test_the_scene_is_put_back_after_errors(scene, bar):
    class Stop(Exception):
        pass

    def failing(time):
        bar(time)
        if len(bar.calls) == 3:
            raise Stop

    with pytest.raises(Stop):
        expose(scene, failing, dspace.Shutter(1.0, samples=8))
    assert len(bar.calls) == 4 and bar.calls[-1] == 0.0
    done = []
    expose(scene, bar, dspace.Shutter(1.0, samples=4), label=True, progress=done.append)
    np.testing.assert_allclose(done, [0.2, 0.4, 0.6, 0.8, 1.0])


@pytest.mark.parametrize("settings", [
    {"exposure_s": 0.0}, {"exposure_s": -1.0}, {"exposure_s": float("nan")}, {"exposure_s": float("inf")}, {"exposure_s": "x"},
    {"readout_s": -0.1}, {"readout_s": float("nan")}, {"direction": "left"}, {"direction": 3}, {"samples": 0}, {"samples": 5000},
    {"samples": 1.5}, {"bands": 0}, {"bands": None}])
def test_bad_shutters(settings):
    with pytest.raises((dspace.InvalidArgument, dspace.WrongType), match="shutter: .*accepted"):
        dspace.Shutter(**{"exposure_s": 0.1, **settings})


def test_bad_exposures(scene, bar, refused):
    shutter = dspace.Shutter(0.1)
    with refused(dspace.WrongType, "the shutter is"):
        expose(scene, bar, 0.1)
    with refused(dspace.WrongType, "at is"):
        expose(scene, 3, shutter)
    with refused(dspace.InvalidArgument, "the size"):
        scene.simulate_exposure(shutter, bar)
    with refused(dspace.WrongType, "label is"):
        expose(scene, bar, shutter, label="yes")
    assert bar.calls == []  # rejected before anything was drawn
