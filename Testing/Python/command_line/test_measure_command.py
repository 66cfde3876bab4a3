"""`dspace los` and `dspace horizon`: values, files by their endings, and what is rejected."""
import csv
import json
import os
import subprocess
import sys

import numpy as np
import pytest

import dspace.vtk  # noqa: F401  (VTK's modules)
from dspace.command_line import main
from needs import needs_module
from terrain_support import gdal, write_raster

R = 1737400.0


def run(capsys, *arguments):
    try:
        code = main([*map(str, arguments)])
    except SystemExit as end:
        code = end.code
    out = capsys.readouterr()
    return code, out.out, out.err


@pytest.fixture
def wall(tmp_path):
    """A plane without CRS, with a wall of 20 m along x = 100.5."""
    z = np.zeros((41, 201), np.float32)
    z[:, 100] = 20.0
    return write_raster(tmp_path / "wall.tif", z)


@pytest.fixture
def moon(tmp_path):
    """Degrees of a smooth sphere about longitude 350, from 340 to 360, and latitude 0."""
    path = tmp_path / "moon.tif"
    data = gdal.GetDriverByName("GTiff").Create(str(path), 200, 200, 1, gdal.GDT_Float32)
    data.SetGeoTransform((340, 0.1, 0, 10, 0, -0.1))
    data.SetProjection(f'GEOGCS["m",DATUM["m",SPHEROID["m",{R},0]],PRIMEM["G",0],UNIT["degree",0.0174532925199433]]')
    data.SetMetadataItem("VERTICAL_DATUM", "sphere")
    data.GetRasterBand(1).WriteArray(np.zeros((200, 200), np.float32))
    return path


def test_lines_over_a_wall(capsys, wall, tmp_path):
    lines = ("--terrain", wall, "--from", "50.5,20.5,2", "--to", "150.5,20.5,2", "--to", "150.5,20.5,60")
    code, out, err = run(capsys, "los", *lines, "--wavelength", "0.125")
    assert code == 0, err
    first, second = out.splitlines()
    assert first.startswith("50.5,20.5,2 to 150.5,20.5,2: blocked after 49.100 m at 99.6, 20.5, height 2.000 m; range 100.000 m, clearance -18.000 m")
    assert second.startswith("50.5,20.5,2 to 150.5,20.5,60: clear; range") and "of the first Fresnel zone" in second
    assert "on a plane: the body's curvature is left out" in err
    code, out, err = run(capsys, "los", *lines, "--json", "--out", tmp_path / "lines.csv")
    found = json.loads(out)
    assert code == 0 and [line["clear"] for line in found["lines"]] == [False, True]
    assert found["lines"][1]["obstacle_distance_m"] is None and not found["on_body"]
    rows = list(csv.DictReader(open(tmp_path / "lines.csv")))
    assert [row["clear"] for row in rows] == ["0", "1"] and rows[1]["obstacle_distance_m"] == ""
    assert float(rows[0]["clearance_m"]) == pytest.approx(-18.0, abs=1e-4)


def test_the_moons_curvature_counts_unless_it_is_told_not_to(capsys, moon):
    ends = ("--terrain", moon, "--from", "-12,0,10", "--to", "-11.5,0,10", "--json")  # 15 km; masts see 11.8 km
    code, out, err = run(capsys, "los", *ends)
    assert code == 0, err
    line = json.loads(out)["lines"][0]
    middle = (R + 10) * np.cos(np.radians(0.25)) - R
    assert not line["clear"] and line["clearance_m"] == pytest.approx(middle, abs=2e-3)
    assert line["obstacle_lat_deg"] == pytest.approx(0.0, abs=1e-6) and -12 < line["obstacle_lon_deg"] < -11.5
    code, out, err = run(capsys, "horizon", "--terrain", moon, "--site", "-10,0", "--height", "10", "--azimuths", "8",
                         "--json")
    found = json.loads(out)
    assert code == 0 and found["on_body"]
    dip = np.degrees(np.arccos(R / (R + 10)))
    np.testing.assert_allclose([row["elevation_deg"] for row in found["horizon"]], -dip, atol=3e-5)
    code, out, err = run(capsys, "horizon", "--terrain", moon, "--plane", "--site", "-10,0", "--azimuths", "4", "--json")
    assert code == 0 and not json.loads(out)["on_body"] and "curvature is left out" in err


def test_a_horizon_and_its_files(capsys, wall, tmp_path):
    arguments = ("horizon", "--terrain", wall, "--site", "50.5,20.5", "--azimuths", "8")
    code, out, err = run(capsys, *arguments, "--out", tmp_path / "horizon.json")
    assert code == 0, err
    elevation = np.degrees(np.arctan2(18.0, 50.0))
    assert f"to {elevation:.5f} deg (azimuth 90, " in out
    saved = json.loads((tmp_path / "horizon.json").read_text())["horizon"]
    assert saved[2]["elevation_deg"] == pytest.approx(elevation, abs=2e-6) and saved[2]["lon_deg"] == pytest.approx(100.5)
    code, out, err = run(capsys, *arguments, "--out", tmp_path / "horizon.csv")
    rows = list(csv.DictReader(open(tmp_path / "horizon.csv")))
    assert code == 0 and len(rows) == 8 and float(rows[2]["azimuth_deg"]) == 90.0


def test_plots(capsys, wall, tmp_path):
    needs_module("matplotlib", "python3-matplotlib")
    for name, arguments in (("h", ("horizon", "--site", "50.5,20.5")),
                            ("l", ("los", "--from", "50.5,20.5,2", "--to", "150.5,20.5,2", "--to", "150.5,20.5,60"))):
        path = tmp_path / f"{name}.png"
        code, out, err = run(capsys, *arguments, "--terrain", wall, "--out", path)
        assert code == 0, err
        picture = gdal.Open(str(path)).ReadAsArray()
        assert picture.shape[1] > 300 and picture.shape[2] == 900
        assert len(np.unique(picture[:3].reshape(3, -1).T, axis=0)) > 20  # lines, areas, letters


@pytest.mark.parametrize("arguments, text", [
    (("los", "--from", "1,2", "--to", "3,4,5"), "--from '1,2': accepted: LON,LAT,H, finite numbers"),
    (("los", "--from", "1,2,3", "--from", "2,2,3", "--to", "3,4,5", "--to", "3,5,5", "--to", "3,6,5"),
     "--from is given 2 times and --to 3 times; accepted: equal numbers, or one of either"),
    (("los", "--from", "20,20,2", "--to", "20,20,2"), "its start and its end are the same point"),
    (("los", "--from", "20,20,2", "--to", "30,20,-2"), "its height above the ground is -2; accepted: 0 to 1e12 m"),
    (("los", "--from", "20,20,2", "--to", "900,20,2"), "it is off the terrain's data"),
    (("horizon", "--site", "20"), "--site '20': accepted: LON,LAT, finite numbers"),
    (("horizon", "--site", "900,20"), "site (900, 20) of terrain 'terrain': it is off the terrain's data"),
    (("horizon", "--site", "20,20", "--azimuths", "0"), "--azimuths 0: accepted: 1 to 1000000"),
    (("horizon", "--site", "20,20", "--out", "a.xls"), "--out 'a.xls': accepted: a name with .json, .csv, .png"),
    (("horizon", "--site", "20,20", "--out", "/nowhere/a.csv"), "there is no folder /nowhere"),
])
def test_rejected(capsys, wall, arguments, text):
    code, out, err = run(capsys, arguments[0], "--terrain", wall, *arguments[1:])
    assert code == 1 and text in err and out == ""


def test_the_command_line_itself_may_be_wrong(capsys, wall):
    assert run(capsys, "los", "--terrain", wall)[0] == 2
    assert run(capsys, "horizon", "--terrain", wall)[0] == 2
    code, out, _ = run(capsys, "horizon", "--help")
    assert code == 0 and "--azimuths" in out


def test_as_a_process(wall):
    done = subprocess.run([sys.executable, "-m", "dspace", "los", "--terrain", str(wall), "--from", "50.5,20.5,2", "--to",
                           "150.5,20.5,60"], capture_output=True, text=True, env=os.environ)
    assert done.returncode == 0 and ": clear; range" in done.stdout, done.stderr
