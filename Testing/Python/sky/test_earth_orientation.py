"""UT1 and polar motion of the IERS's tables, against the tables as astropy reads them, ERFA, and JPL's binary PCK."""
import pathlib

import numpy as np
import pytest

import dspace
import needs
from test_sky import angles, real, scene  # noqa: F401  (a fixture)

ARCSECOND = np.pi / 648000.0
FINALS = """\
16 730 57599.00 I  0.214232 0.008236  0.442454 0.011701  I-0.2000000 0.0086754
16 731 57600.00 I  0.215232 0.008236  0.441454 0.011701  I-0.2020000 0.0086754
16 8 1 57601.00 P  0.216232 0.008236  0.440454 0.011701  P-0.2040000 0.0086754
16 8 2 57602.00
"""


@pytest.fixture
def iers():
    return needs.needs_module("astropy.utils.iers", "python3-astropy")


def kernel_text(tmp_path, text, name="table"):
    path = tmp_path / name
    path.write_text(text)
    return path


def test_itrf93_is_erfas_with_the_values_of_c04(scene, iers):  # noqa: F811
    erfa = needs.needs_module("erfa", "python3-erfa")
    scene.kernels.load(iers.IERS_B_FILE)
    table = iers.IERS_B.open(iers.IERS_B_FILE)
    assert scene.kernels.contents[0].items == ["UT1 and polar motion from 1962-01-01 to 2022-11-29"]
    for text in ("1975-03-04T05:06:07", "2003-07-04T19:00:00", "2016-12-31T12:00:00", "2022-05-05T00:00:00"):
        time = scene.tdb(text)
        tt1, tt2 = erfa.taitt(*erfa.utctai(*erfa.dtf2d("UTC", *(int(part) for part in text.replace("T", "-").replace(
            ":", "-").split("-")))))
        utc = erfa.taiutc(*erfa.tttai(tt1, tt2))
        ut1_utc = table.ut1_utc(*utc).to_value("s")
        pole = [each.to_value("rad") for each in table.pm_xy(*utc)]
        expected = erfa.c2t06a(tt1, tt2, *erfa.utcut1(*utc, ut1_utc), *pole)
        assert angles(scene.reference_frames.rotation("J2000", "ITRF93", time), expected) < 1e-4 * ARCSECOND
        later = scene.reference_frames.rotation("J2000", "ITRF93", [time - 1.0, time + 1.0])
        rate = scene.reference_frames.turn("J2000", "ITRF93", time)[1]
        assert np.abs(rate - (later[1] - later[0]) / 2.0).max() < 1e-11
    step = scene.reference_frames.explain("J2000", "ITRF93", scene.tdb("2010-01-01"))[0]
    assert "0.005 arcsec" in step.accuracy and "eopc04" in step.accuracy


def test_itrf93_is_that_of_jpls_kernel(scene, iers):  # noqa: F811
    """earth_031228_231229_predict.bpc has the measured orientation up to October 2003."""
    files = real("naif0012.tls", "spice_test_kernels/earth_031228_231229_predict.bpc")
    times = np.arange(9.45e7, 1.19e8, 6e5)
    scene.kernels.load(iers.IERS_B_FILE)
    ours = scene.reference_frames.rotation("J2000", "ITRF93", times)
    scene.kernels.load(*files)
    assert angles(ours, scene.reference_frames.rotation("J2000", "ITRF93", times)).max() < 0.005 * ARCSECOND


def test_times_in_ut1(scene, iers):  # noqa: F811
    with pytest.raises(dspace.NotFound, match="finals2000A"):
        scene.tdb("2010-01-01T00:00:00 UT1")
    scene.kernels.load(iers.IERS_B_FILE)
    time = scene.tdb("2010-01-01T00:00:00 UTC")
    ut1_utc = iers.IERS_B.open(iers.IERS_B_FILE).ut1_utc(2455197.5, 0.0).to_value("s")
    assert scene.tdb("2010-01-01T00:00:00 UT1") == pytest.approx(time - ut1_utc, abs=2e-6)
    assert scene.time_text(time, "UT1", decimals=5) == f"2010-01-01T00:00:00.{round(1e5 * ut1_utc):05d}"
    assert scene.time_text(time, "tai", decimals=0) == "2010-01-01T00:00:34"
    with pytest.raises(dspace.InvalidArgument, match="accepted: 1962-01-01 to 2022-11-29"):
        scene.time_text(scene.tdb("2024-01-01"), "UT1")
    with pytest.raises(dspace.InvalidArgument, match="UTC, TAI, TT, TDB, UT1"):
        scene.time_text(time, "GPS")
    # After the table, UTC stands for UT1 again.
    step = scene.reference_frames.explain("J2000", "ITRF93", scene.tdb("2024-01-01"))[0]
    assert "14 arcsec" in step.accuracy
    scene.kernels.unload()
    assert scene.kernels.contents == []


def test_finals2000a(scene, iers, tmp_path):  # noqa: F811
    name = pathlib.Path(iers.__file__).parent / "tests/data/finals2000A-2016-04-30-test"
    if name.is_file():
        scene.kernels.load(name)
        table = iers.IERS_A.open(str(name))
        half = 2457420.5 + 0.5
        expected = table.ut1_utc(half, 0.0, return_status=False).to_value("s")
        time = scene.tdb("2016-02-02T12:00:00")
        found = scene.tdb("2016-02-02T12:00:00 UT1") - time
        assert -found == pytest.approx(expected, abs=5e-5)  # Bulletin A here, B there
        scene.kernels.unload()
    path = kernel_text(tmp_path, FINALS)
    scene.kernels.load(path)
    assert scene.kernels.contents[0].kind == "EOP"
    assert scene.kernels.contents[0].items == ["UT1 and polar motion from 2016-07-30 to 2016-08-01", "predicted from 2016-08-01"]
    assert scene.time_text(scene.tdb("2016-07-30T12:00:00"), "UT1", 4) == "2016-07-30T11:59:59.7990"
    accuracy = [scene.reference_frames.explain("J2000", "ITRF93", scene.tdb(t))[0].accuracy for t in ("2016-07-30T12:00", "2016-07-31T12:00")]
    assert "0.005 arcsec" in accuracy[0] and "predicted" in accuracy[1]


def test_c04_of_the_series_20(scene, tmp_path):  # noqa: F811
    rows = "".join(f"2020   1  {day:2d}   0  {58848 + day}.00    0.076577    0.282336  -0.17715{day}0    0.000070   -0.000047"
                   "   -0.001764    0.001234  0.0005000    0.000040    0.000040   0.0000085    0.000046    0.000046\n" for day in (1, 2, 3))
    scene.kernels.load(kernel_text(tmp_path, "# EARTH ORIENTATION PARAMETER (EOP) PRODUCT CENTER\n" + rows))
    assert scene.time_text(scene.tdb("2020-01-02T00:00:00"), "UT1", 6) == "2020-01-01T23:59:59.822848"


@pytest.mark.parametrize("text, message", [
    (FINALS.replace("16 8 1 57601.00", "16 8 2 57602.00"), "line 3: its day is MJD 57602, after MJD 57600"),
    (FINALS.replace("P-0.2040000", "P-0.20x0000"), "line 3: it is no such row"),
    (FINALS.splitlines()[0] + "\n", "it has 1 rows")])
def test_damaged_tables_are_rejected_whole(scene, tmp_path, text, message):  # noqa: F811
    path = kernel_text(tmp_path, text)
    with pytest.raises(dspace.Corrupt, match=message):
        scene.kernels.load(path)
    assert scene.kernels.files == []
