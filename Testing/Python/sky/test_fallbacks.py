"""Warnings where data of lower accuracy stand in for those that are loaded or installed."""
import warnings

import numpy as np
import pytest

import dspace
from test_sky import real, scene  # noqa: F401  (a fixture)

KERNELS = "spice_test_kernels/"


def told(run):
    """The texts of the warnings of a call."""
    with warnings.catch_warnings(record=True) as found:
        warnings.simplefilter("always")
        run()
    return [str(each.message) for each in found if issubclass(each.category, dspace.DspaceWarning)]


@pytest.mark.parametrize("correction", ["NONE", "LT+S", "CN"])
def test_every_time_of_a_request_is_looked_at(scene, correction):  # noqa: F811
    """The kernel ends in 2010, DE405 in 2060."""
    scene.kernels.load(*real(KERNELS + "de405s_littleendian.bsp"))
    inside = scene.tdb("2005-01-01") + np.arange(4) * 86400.0
    assert told(lambda: scene.ephemeris("moon", "earth", inside, correction=correction)) == []
    outside = np.append(inside, scene.tdb("2070-01-01 TDB") + np.arange(2) * 86400.0)
    found = told(lambda: scene.ephemeris("moon", "earth", outside, correction=correction))
    moon = [text for text in found if "body MOON is taken from ERFA's series, up to 32 km off" in text]
    assert len(moon) == 1 and "(at 2 of 6 times: 20" in moon[0]


def test_itrf93_outside_of_its_kernel(scene):  # noqa: F811
    scene.kernels.load(*real("naif0012.tls", KERNELS + "earth_031228_231229_predict.bpc"))
    inside, outside = scene.tdb("2010-01-01"), scene.tdb("2026-11-01")
    assert told(lambda: scene.reference_frames.rotation("J2000", "ITRF93", [inside, inside + 60.0])) == []
    found = told(lambda: scene.reference_frames.rotation("J2000", "ITRF93", [inside, outside]))
    assert len(found) == 1 and "ITRF93" in found[0] and "14 arcsec" in found[0] and "at 1 of 2 times" in found[0]
    found = told(lambda: scene.ephemeris("moon", "earth", [inside, outside], axes="ITRF93"))
    assert any("ITRF93" in text for text in found)


def test_the_moons_axes_after_the_end_of_their_kernel(scene):  # noqa: F811
    """The PCK ends in 2050. DE405's libration stands in, which is within 0.28 arcsec of it before."""
    scene.kernels.load(*real("moon_080317.tf", "moon_pa_de421_1900-2050.bpc"))
    inside, outside = scene.tdb("2049-06-01"), scene.tdb("2055-01-01")
    frames = scene.reference_frames
    assert told(lambda: frames.rotation("J2000", "MOON_ME", inside)) == []
    found = told(lambda: frames.rotation("J2000", "MOON_ME", [inside, outside]))
    assert len(found) == 1 and "MOON_PA_DE421" in found[0] and "0.28 arcsec" in found[0] and "1 of 2 times" in found[0]
    me, pa = frames.rotation("J2000", "MOON_ME", outside), frames.rotation("J2000", "MOON_PA", outside)
    apart = frames.rotation("MOON_PA", "MOON_ME", inside)  # the kernel's own turn
    assert np.abs(apart @ pa - me).max() < 1e-14
    turn = frames.turn("J2000", "MOON_ME", outside)[1]
    around = frames.rotation("J2000", "MOON_ME", [outside - 10.0, outside + 10.0])
    assert np.abs(turn - (around[1] - around[0]) / 20.0).max() < 1e-13  # a double of the time resolves 2e-7 s
    scene.kernels.unload()
    assert np.abs(frames.rotation("J2000", "MOON_ME", outside) - me).max() < 1e-12


def test_an_old_lsk_says_what_it_lacks(scene):  # noqa: F811
    """naif0011.tls ends before the leap second of 2017-01-01."""
    old, new = real("naif0011.tls", "naif0012.tls")
    found = told(lambda: scene.kernels.load(old))
    assert len(found) == 1 and "2017-01-01" in found[0] and "1 s" in found[0]
    assert told(lambda: scene.tdb("2016-12-31T23:00:00")) == []
    found = told(lambda: scene.tdb("2020-01-01"))
    assert len(found) == 1 and "naif0011.tls" in found[0] and "newer LSK" in found[0]
    assert told(lambda: scene.kernels.load(new)) == []
    assert told(lambda: scene.tdb("2020-01-01")) == []


@pytest.mark.parametrize("planet, distance", [("jupiter", "230"), ("saturn", "320"), ("uranus", "50"), ("neptune", "80"), ("pluto", "2,200")])
def test_planets_of_which_barycentres_are_known(scene, planet, distance):  # noqa: F811
    time = scene.tdb("2026-11-28")
    found = told(lambda: scene.ephemeris(planet, "sun", time))
    notes = [text for text in found if "barycentre of its system" in text]
    assert len(notes) == 1 and f"up to {distance} km off" in notes[0] and planet.upper() in notes[0]
    states = [scene.ephemeris(name, "sun", time) for name in (planet, planet + " barycenter")]
    assert np.array_equal(states[0].position, states[1].position)
    assert states[0].sources[0].accuracy == f"up to {distance} km off"
    seen = scene.sky(planet, body="earth", site=(0.0, 50.0), time=time)[planet]
    assert seen.radius_deg > 1e-5 and seen.lit_fraction > 0.98


def test_jupiters_own_kernel_replaces_the_barycentre(scene):  # noqa: F811
    scene.kernels.load(*real("jup310_excerpt_2053-10-08.bsp"))
    segment = next(s for s in scene.kernels.segments if s.body == 599)
    time = 0.5 * (segment.begin_s + segment.end_s)
    state = scene.ephemeris("jupiter", "jupiter barycenter", time)
    assert told(lambda: scene.ephemeris("jupiter", "jupiter barycenter", time)) == []
    assert 1e3 < np.linalg.norm(state.position) < 230e3
    assert any("barycentre of its system" in text for text in told(
        lambda: scene.ephemeris("jupiter", "jupiter barycenter", segment.end_s + 9e7)))
