"""dspace.Sensor: light to counts. The statistics of the noise are tested in C++ (TestSensor)."""
import numpy as np
import pytest

import dspace

LIGHT = np.full((64, 80, 3), 50.0, np.float32)


def test_counts_follow_the_light():
    sensor = dspace.Sensor(bands_nm=[(500, 600)], photon_noise=False, gain=1.0, bits=16, full_well=1e6, exposure_s=1e-4)
    assert sensor.response.shape == (1,)
    counts = sensor.expose(LIGHT)
    assert counts.shape == (64, 80) and counts.dtype == np.uint16
    assert (counts == round(50.0 * sensor.response[0])).all() and counts[0, 0] > 10
    double = dspace.Sensor(**{**sensor.settings, "exposure_s": 2e-4})
    assert double.response[0] == pytest.approx(2 * sensor.response[0])
    stopped = dspace.Sensor(**{**sensor.settings, "f_number": 8.0})
    assert stopped.response[0] == pytest.approx(sensor.response[0] / 4)


def test_seeds_and_frames():
    sensor = dspace.Sensor(read_noise=5.0, exposure_s=1e-5, gain=0.5, offset=100)
    one = sensor.expose(LIGHT, seed=2**64 - 1)
    assert one.shape == (64, 80, 3)
    np.testing.assert_array_equal(one, sensor.expose(LIGHT, seed=2**64 - 1))
    for other in (sensor.expose(LIGHT, seed=1), sensor.expose(LIGHT, seed=2**64 - 1, frame=1)):
        assert (one != other).mean() > 0.8
    mono = dspace.Sensor(bayer="RGGB", exposure_s=1e-5).expose(LIGHT)
    assert mono.shape == (64, 80)


def test_falloff_is_the_cosine():
    model = dspace.CameraModel("pinhole", size=(80, 64), focal=(60, 60), center=(39.5, 31.5))
    sensor = dspace.Sensor(bands_nm=[(500, 600)], falloff=4)
    flat = dspace.Sensor(bands_nm=[(500, 600)]).electrons(LIGHT)
    u, v = np.meshgrid(np.arange(80) - 39.5, np.arange(64) - 31.5)
    cosine = 60 / np.sqrt(u * u + v * v + 3600)
    np.testing.assert_allclose(sensor.electrons(LIGHT, model)[..., 0] / flat[..., 0], cosine ** 4, rtol=1e-5)
    with pytest.raises(dspace.WrongType, match="for the falloff"):
        sensor.electrons(LIGHT)
    with pytest.raises(dspace.InvalidArgument, match="that of the model"):
        sensor.electrons(LIGHT[:10], model)


@pytest.mark.parametrize("wrong, message", [
    (dict(exposure_s=0), "exposure is 0"), (dict(bits=0), "number of bits is 0; accepted: 8 to 16"),
    (dict(bits=2**40), "bits"), (dict(gain=float("nan")), "gain is nan"), (dict(bayer="RGBG"), "accepted: RGGB"),
    (dict(bands_nm=[(600, 500)]), "600 to 500 nm"), (dict(bands_nm=[(1, 2, 3)]), "pairs"), (dict(falloff=-1), "0 to 20"),
    (dict(point_spread=100), "0 to 50"),
])
def test_rejected(wrong, message):
    with pytest.raises(dspace.InvalidArgument, match=message):
        dspace.Sensor(**wrong)


def test_wrong_light():
    sensor = dspace.Sensor()
    for radiance in (np.zeros((3, 3)), np.zeros((0, 4, 3)), "bright"):
        with pytest.raises(dspace.InvalidArgument, match="the radiance"):
            sensor.expose(radiance)
    with pytest.raises(dspace.InvalidArgument, match="the seed"):
        sensor.expose(LIGHT, seed=-1)
    assert not sensor.electrons(np.full((2, 2, 3), np.nan)).any()
