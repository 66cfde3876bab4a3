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
    moon = [text for text in found if "body 301 is taken from ERFA's series, up to 32 km off" in text]
    assert len(moon) == 1 and "(at 2 of 6 times: 20" in moon[0]


def test_itrf93_outside_of_its_kernel(scene):  # noqa: F811
    scene.kernels.load(*real("naif0012.tls", KERNELS + "earth_031228_231229_predict.bpc"))
    inside, outside = scene.tdb("2010-01-01"), scene.tdb("2026-11-01")
    assert told(lambda: scene.reference_frames.rotation("J2000", "ITRF93", [inside, inside + 60.0])) == []
    found = told(lambda: scene.reference_frames.rotation("J2000", "ITRF93", [inside, outside]))
    assert len(found) == 1 and "ITRF93" in found[0] and "14 arcsec" in found[0] and "at 1 of 2 times" in found[0]
    found = told(lambda: scene.ephemeris("moon", "earth", [inside, outside], axes="ITRF93"))
    assert any("ITRF93" in text for text in found)
