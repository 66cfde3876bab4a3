"""`dspace horizon --map`, `dspace viewshed` and `dspace illumination`: files by their endings, and what is rejected."""
import json

import numpy as np
import pytest

import dspace
import dspace.vtk  # noqa: F401  (VTK's modules)
from command_support import run, write_moon, write_wall
from dspace.command_line.measure_map import frame_of
from needs import needs_module
from terrain_support import gdal


@pytest.fixture
def wall(tmp_path):
    """A plane without CRS, with a wall of 20 m along x = 40.5."""
    return write_wall(tmp_path / "wall.tif", 81)


@pytest.fixture
def moon(tmp_path):
    """Degrees of the Moon's south, with a ridge."""
    z = np.zeros((20, 30), np.float32)
    z[3] = 2500.0
    return write_moon(tmp_path / "moon.tif", z, 10, -84, 0.05)


def test_a_horizon_map(capsys, wall, tmp_path):
    out = tmp_path / "map.tif"
    command = ("horizon", "--terrain", wall, "--map", "--height", 2, "--azimuths", 8, "--cell-size", 2, "--out", out)
    code, text, err = run(capsys, *command)
    assert code == 0 and f"{out}: 41 x 21 cells, 2 map units a cell, 8 bands" in text, err
    data = gdal.Open(str(out))
    assert data.RasterCount == 8 and data.GetRasterBand(3).GetDescription() == "azimuth 90 deg"
    east = data.GetRasterBand(3).ReadAsArray()
    # The wall's middle is a post: its crest, 18 m above the eye, stands at its distance.
    assert east[10, 0] == pytest.approx(np.degrees(np.arctan2(18.0, 40.0)), abs=1e-4)
    assert east[10, 21] < 0.0
    code, _, err = run(capsys, *command)
    assert code == 1 and "it exists; accepted: a new file, or --replace" in err
    code, text, _ = run(capsys, *command, "--replace", "--json")
    assert code == 0 and json.loads(text)["azimuths"] == 8


def test_viewsheds(capsys, wall, tmp_path):
    needs_module("matplotlib", "python3-matplotlib")
    see = ("viewshed", "--terrain", wall, "--site", "10.5,20.5", "--height", 2, "--quantity", "visible", "--quantity",
           "least_height")
    code, text, err = run(capsys, *see, "--out", tmp_path / "view.tif")
    assert code == 0 and "81 x 41 cells" in text, err
    visible, least = gdal.Open(str(tmp_path / "view.tif")).ReadAsArray()
    assert visible[20, :41].all() and not visible[:, 41:].any()
    assert least[20, 70] == pytest.approx(2.0 + 18.0 / 30.0 * 60.0, abs=1e-4)
    assert run(capsys, *see, "--out", tmp_path / "view.json")[0] == 0
    found = json.loads((tmp_path / "view.json").read_text())
    assert found["bands"][0]["mean"] == pytest.approx(visible.mean(), abs=1e-6) and found["columns"] == 81
    assert run(capsys, *see, "--out", tmp_path / "view.csv")[0] == 0
    rows = (tmp_path / "view.csv").read_text().splitlines()
    assert rows[0] == "x,y,visible,least_height" and len(rows) == 1 + 81 * 41
    assert [float(value) for value in rows[1 + 20 * 81 + 70].split(",")] == pytest.approx([70.5, 20.5, 0.0, 38.0], abs=1e-4)
    assert run(capsys, *see, "--out", tmp_path / "view.png")[0] == 0
    assert (tmp_path / "view.png").read_bytes().startswith(b"\x89PNG")


def test_illumination(capsys, moon, tmp_path):
    span = ("--from", "2026-01-03", "--to", "2026-02-01", "--step", 21600, "--quantity", "lit_fraction", "--quantity",
            "longest_night")
    code, text, err = run(capsys, "illumination", "--terrain", moon, *span, "--azimuths", 36, "--extent", "10.2,-84.3,10.6,-84.8",
                          "--out", tmp_path / "lit.json")
    assert code == 0 and "2 bands" in text, err
    lit = json.loads((tmp_path / "lit.json").read_text())["bands"]
    assert 0.2 < lit[0]["mean"] < 0.7 and lit[1]["greatest"] > 86400.0
    horizons = tmp_path / "horizons.tif"
    assert run(capsys, "horizon", "--terrain", moon, "--map", "--azimuths", 36, "--extent", "10.2,-84.3,10.6,-84.8", "--height",
               0, "--out", horizons)[0] == 0
    assert run(capsys, "illumination", "--terrain", moon, "--horizons", horizons, *span, "--out", tmp_path / "lit.tif")[0] == 0
    values = gdal.Open(str(tmp_path / "lit.tif")).ReadAsArray()
    assert values[0].mean() == pytest.approx(lit[0]["mean"], abs=1e-6)
    # A degree of longitude is drawn as wide as it is there.
    edges, aspect, names = frame_of(dspace.MapFile.open(tmp_path / "lit.tif"))
    assert names == ("longitude [deg]", "latitude [deg]")
    assert aspect == pytest.approx(1.0 / np.cos(np.radians(0.5 * (edges[2] + edges[3])))) and 9.5 < aspect < 11.0


def test_stations_and_permanent_shadow(capsys, moon, tmp_path):
    span = ("--from", "2026-01-03", "--to", "2026-01-08", "--step", "7200")
    area = ("--azimuths", 36, "--extent", "10.2,-84.3,10.6,-84.8")
    code, out, err = run(capsys, "illumination", "--terrain", moon, *span, *area, "--quantity", "station_fraction", "--quantity",
                         "permanent_shadow", "--station", "-116.89,35.43,970", "--station-mask", 10, "--out", tmp_path / "link.json")
    assert code == 0, err
    link, dark = json.loads((tmp_path / "link.json").read_text())["bands"]
    assert 0.0 <= link["least"] <= link["greatest"] < 0.6 and link["greatest"] > 0.0  # one station of three
    cells = 1e6 * 0.5 * np.pi / 180 * 1737.4 * 0.4 * np.pi / 180 * 1737.4 * np.cos(np.radians(84.55))
    assert dark["area_m2"] == pytest.approx(dark["mean"] * cells, rel=0.2)
    code, out, err = run(capsys, "illumination", "--terrain", moon, *span, *area, "--quantity", "permanent_shadow", "--out", tmp_path / "dark.tif")
    assert code == 0 and "permanent shadow" in out and "km2" in out, err
    for wrong in (("--station", "0,0"), ("--quantity", "station_fraction"), ("--station", "x", "--quantity", "station_fraction")):
        code, _, err = run(capsys, "illumination", "--terrain", moon, *span, *wrong, "--out", tmp_path / "no.tif")
        assert code != 0 and "--station" in err, wrong



@pytest.mark.parametrize("arguments, text", [
    (("horizon", "--map"), "--out: accepted: a name with .tif"),
    (("horizon", "--map", "--out", "a.png"), "accepted: a name with .tif"),
    (("horizon", "--map", "--out", "none/a.tif"), "there is no folder"),
    (("viewshed", "--site", "1,2", "--out", "a.xyz"), "accepted: a name with .tif, .png, .json, .csv"),
    (("viewshed", "--site", "900,20.5", "--out", "a.tif"), "no data there"),
    (("viewshed", "--site", "1", "--out", "a.tif"), "--site '1': accepted: LON,LAT"),
    (("viewshed", "--site", "10.5,20.5", "--radius", "0", "--out", "a.tif"), "--radius 0.0: accepted: more than 0 m"),
    (("viewshed", "--site", "10.5,20.5", "--height", "-1", "--out", "a.tif"), "height"),
    (("illumination", "--from", "2026-01-01", "--to", "2026-01-01", "--out", "a.tif"), "the span from the start to the end is 0"),
    (("illumination", "--from", "2026-01-01", "--to", "2026-01-02", "--out", "a.tif"), "wall.tif': it has no longitudes and latitudes, so"),
    (("illumination", "--from", "2026-01-01", "--to", "2026-01-02", "--step", "0", "--out", "a.tif"), "--step 0.0"),
    (("illumination", "--from", "2026-01-01", "--to", "2026-01-02", "--horizons", "none.tif", "--height", "0", "--out", "a.tif"),
     "--fast, --height, --azimuths: accepted: without --horizons"),
    (("illumination", "--from", "2026-01-01", "--to", "2026-01-02", "--horizons", "none.tif", "--out", "a.tif"),
     "there is no such file"),
])
def test_rejected(capsys, monkeypatch, wall, tmp_path, arguments, text):
    monkeypatch.chdir(tmp_path)
    code, _, err = run(capsys, arguments[0], "--terrain", wall, *arguments[1:])
    assert code == 1 and text in err, err
    assert not (tmp_path / "a.tif").exists()


def test_a_horizon_is_of_a_site_or_a_map(capsys, tmp_path):
    for words in (("--out", "a.tif"), ("--map", "--site", "1,2", "--out", "a.tif")):
        code, out, err = run(capsys, "horizon", "--terrain", tmp_path / "none.tif", *words)
        assert code == 2 and "--site" in err and "--map" in err and out == ""
