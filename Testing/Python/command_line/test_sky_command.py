"""`dspace sky`: against Horizons' Sun over a lunar site, and the picture that it draws."""
import json
import os
import pathlib

import numpy as np
import pytest

import dspace.vtk  # noqa: F401  (VTK's modules)
from dspace.command_line import main

DATA = pathlib.Path(os.environ.get("DSPACE_DATA", "/nonexistent")) / "ephemeris"
SITE = ("--body", "moon", "--site", "29.1957,-84.7906")


def run(capsys, *arguments):
    code = main(["sky", *map(str, arguments)])
    out = capsys.readouterr()
    return code, out.out, out.err


def picture(path):
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOImage import vtkPNGReader
    reader = vtkPNGReader()
    reader.SetFileName(str(path))
    reader.Update()
    data = reader.GetOutput()
    width, height, _ = data.GetDimensions()
    return vtk_to_numpy(data.GetPointData().GetScalars()).reshape(height, width, -1)[::-1, :, :3].astype(float)


def test_the_sun_over_the_lunar_site_is_horizons(capsys, tmp_path):
    """sky_checks.json, to 1e-4 deg: Horizons prints 1e-6 deg, and its ephemeris and orientation are others. The site's
    Sun stands 0.19 deg above the horizon, whose dip from 2 m is 0.09 deg: the whole disc is seen."""
    names = ("naif0012.tls", "moon_080317.tf", "moon_pa_de421_1900-2050.bpc")
    for name in ("sky_checks.json", *names):
        if not (DATA / name).exists():
            pytest.skip(f"real data absent: set DSPACE_DATA to the folder that has ephemeris/{name}")
    kernels = ("--kernel", *(DATA / name for name in names))
    rows = json.loads((DATA / "sky_checks.json").read_text())["horizons_sun_azel_im2_site"]["rows"]
    for row in rows:
        code, out, err = run(capsys, "--time", row["utc"], *SITE, "--look-at", "sun", "--json", *kernels)
        assert code == 0, err
        found = json.loads(out)
        assert abs(found["azimuth_deg"] - row["azimuth_deg"]) < 1e-4
        assert abs(found["elevation_deg"] - row["elevation_deg"]) < 1e-4
    path = tmp_path / "sun.png"
    code, out, err = run(capsys, "--time", rows[0]["utc"], *SITE, "--look-at", "sun", "--fov", 2, "--size", "400x300",
                         "--out", path, *kernels)
    assert code == 0, err
    assert "azimuth 255.8624" in out and "400 x 300 pixels" in out
    rows_lit, columns_lit = np.nonzero(picture(path).min(axis=2) > 200)
    assert abs(rows_lit.mean() - 149.5) < 1 and abs(columns_lit.mean() - 199.5) < 1
    diameter = 0.5366 / 2.0 * 300  # [pixels]
    assert abs(np.ptp(columns_lit) + 1 - diameter) < 2 and abs(np.ptp(rows_lit) + 1 - diameter) < 2


def test_without_kernels_planets_and_grids_are_drawn(capsys, tmp_path):
    stars, ruled = tmp_path / "stars.png", tmp_path / "ruled.png"
    words = ("--time", "2026-01-10T04:00", "--site", "8,50,-300", "--azimuth", "180", "--elevation", "20",
             "--size", "320x200")
    code, out, err = run(capsys, *words, "--out", stars)
    assert code == 0 and "camera azimuth 180.000000" in out, err
    code, _, err = run(capsys, *words, "--grid", "equatorial", "--out", ruled)
    assert code == 0, err
    assert picture(stars).max() > 40
    assert (picture(ruled).max(axis=2) > 30).sum() > (picture(stars).max(axis=2) > 30).sum() + 200
    code, out, err = run(capsys, "--time", "2026-01-10T04:00", "--site", "8,50", "--look-at", "jupiter", "--json")
    assert code == 0 and json.loads(out)["target"] == "jupiter", err
    assert 0.008 < json.loads(out)["diameter_deg"] < 0.0141


def test_jupiter_outshines_the_stars_about_it(capsys, tmp_path):
    """2026-11-28: Jupiter (V -2.2) beside Mars (0.05 by Lambert's phases) and Regulus (1.4)."""
    path = tmp_path / "jupiter.png"
    code, _, err = run(capsys, "--time", "2026-11-28T05:00", "--site", "11,48", "--look-at", "jupiter", "--fov", "10", "--exposure", "0.005",
                       "--size", "401x401", "--out", path)
    assert code == 0 and "SATURN" not in err
    light = picture(path)[:, :, 1] / 255.0
    light = np.where(light <= 0.04045, light / 12.92, ((light + 0.055) / 1.055) ** 2.4)
    rows, columns = np.mgrid[0:401, 0:401]
    magnitudes = []
    for _ in range(3):
        row, column = np.unravel_index(light.argmax(), light.shape)
        here = np.hypot(rows - row, columns - column) < 8
        assert magnitudes or (light.max() < 0.6 and max(abs(row - 200), abs(column - 200)) <= 1)
        magnitudes.append(-2.5 * np.log10(light[here].sum()))
        light[here] = 0.0
    assert magnitudes[1] - magnitudes[0] == pytest.approx(0.05 + 2.2, abs=0.15)
    assert magnitudes[2] - magnitudes[0] == pytest.approx(1.4 + 2.2, abs=0.15)


@pytest.mark.parametrize("arguments", [
    ("--look-at", "vulcan"), ("--look-at", "moon"),
    ("--look-at", "sun", "--time", "1850-01-01 TDB"), ("--look-at", "sun", "--time", "yesterday"),
    ("--azimuth", "3", "--elevation", "91"), ("--azimuth", "nan"),
    ("--look-at", "sun", "--fov", "0"), ("--look-at", "sun", "--exposure", "0"),
    ("--look-at", "sun", "--body", "vulcan"), ("--look-at", "sun", "--out", "picture.xyz"),
    ("--look-at", "sun", "--kernel", "/nonexistent.bsp")])
def test_bad_input_is_one_line(capsys, arguments):
    code, out, err = run(capsys, "--time", "2026-11-01", *SITE, *arguments)
    assert code == 1 and out == "" and len(err.strip().splitlines()) == 1


@pytest.mark.parametrize("arguments", [
    ("--look-at", "sun", "--site", "3,95"), ("--look-at", "sun", "--site", "3"), (), ("--look-at", "sun", "--azimuth", "3"),
    ("--look-at", "sun", "--size", "3")])
def test_a_wrong_command_line_ends_with_2(capsys, arguments):
    with pytest.raises(SystemExit) as end:
        main(["sky", "--time", "2026-11-01", *SITE, *arguments])
    out = capsys.readouterr()
    assert end.value.code == 2 and out.out == "" and len(out.err.strip().splitlines()) == 1
