"""`dspace los`, `dspace horizon` and `dspace lit`: values, files by their endings, and what is rejected."""
import csv
import json
import os
import subprocess
import sys

import numpy as np
import pytest

import dspace.vtk  # noqa: F401  (VTK's modules)
from command_support import R, run, write_moon, write_wall
from needs import needs_module
from terrain_support import gdal, write_raster


@pytest.fixture
def wall(tmp_path):
    """A plane without CRS, with a wall of 20 m along x = 100.5."""
    return write_wall(tmp_path / "wall.tif", 201)


@pytest.fixture
def moon(tmp_path):
    """Degrees of a smooth sphere about longitude 350, from 340 to 360, and latitude 0."""
    return write_moon(tmp_path / "moon.tif", np.zeros((200, 200), np.float32), 340, 10, 0.1)


def test_lines_over_a_wall(capsys, wall, tmp_path):
    lines = ("--terrain", wall, "--from", "50.5,20.5,2", "--to", "150.5,20.5,2", "--to", "150.5,20.5,60")
    code, out, err = run(capsys, "los", *lines, "--wavelength", "0.125")
    assert code == 0, err
    first, second = out.splitlines()
    assert first.startswith("50.5,20.5,2 to 150.5,20.5,2: blocked after 49.100 m at 99.6, 20.5, height 2.000 m; range 100.000 m, clearance -18.000 m")
    assert second.startswith("50.5,20.5,2 to 150.5,20.5,60: clear; range") and "of the first Fresnel zone" in second
    assert "on a plane: the body's curvature is left out" in err
    code, out, err = run(capsys, "los", *lines, "--method", "both")
    assert code == 0 and all(line.endswith("; the same in the picture") for line in out.splitlines()), err
    code, out, err = run(capsys, "los", *lines, "--method", "image")
    first, second = out.splitlines()
    assert first.endswith("; in the picture blocked") and "clearance" not in first and second.endswith("; in the picture clear")
    code, out, err = run(capsys, "los", *lines, "--json", "--out", tmp_path / "lines.csv")
    found = json.loads(out)
    assert code == 0 and [line["clear"] for line in found["lines"]] == [False, True]
    assert found["lines"][1]["obstacle_distance_m"] is None and not found["on_body"]
    rows = list(csv.DictReader(open(tmp_path / "lines.csv")))
    assert [row["clear"] for row in rows] == ["0", "1"] and rows[1]["obstacle_distance_m"] == ""
    assert float(rows[0]["clearance_m"]) == pytest.approx(-18.0, abs=1e-4)


def test_a_line_over_a_hole_says_so(capsys, tmp_path):
    z = np.zeros((41, 201), np.float32)
    z[:, 80:120] = np.nan
    hole = write_raster(tmp_path / "hole.tif", z)
    lines = ("--terrain", hole, "--from", "50.5,20.5,2", "--to", "150.5,20.5,2", "--to", "70.5,20.5,2")
    code, out, err = run(capsys, "los", *lines)
    assert code == 0, err
    first, second = out.splitlines()
    assert "clear" in first and "% of it has no ground below it, where nothing can hide it" in first and "no ground" not in second
    code, out, err = run(capsys, "los", *lines, "--json")
    # Posts are 1 m apart: from 79.5 to 120.5 of 100 m.
    assert [line["no_ground_fraction"] for line in json.loads(out)["lines"]] == [pytest.approx(0.41, abs=0.002), 0.0]


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
    assert saved[2]["elevation_deg"] == pytest.approx(elevation, abs=2e-6) and saved[2]["map_x"] == pytest.approx(100.5)
    code, out, err = run(capsys, *arguments, "--out", tmp_path / "horizon.csv")
    rows = list(csv.DictReader(open(tmp_path / "horizon.csv")))
    assert code == 0 and len(rows) == 8 and float(rows[2]["azimuth_deg"]) == 90.0


def test_paths_over_a_horizon_and_the_pictures_cameras(capsys, moon, wall, tmp_path):
    """The Sun over a smooth Moon: rows of the path are those of Scene.sky, and above_deg is over the dip of the horizon."""
    code, out, err = run(capsys, "horizon", "--terrain", moon, "--site", "-10,0", "--height", "10", "--azimuths", "8", "--json",
                         "--time", "2026-01-01,2026-01-05,43200", "--target", "sun", "--body", "moon")
    assert code == 0, err
    paths = json.loads(out)["paths"]
    assert len(paths) == 9 and {row["target"] for row in paths} == {"sun"} and paths[0]["utc"].startswith("2026-01-01T00:00:00")
    dip = np.degrees(np.arccos(R / (R + 10)))
    with dspace.Session() as session:
        sun = session.scene().sky("sun", body="moon", site=(-10.0, 0.0, 10.0), time="2026-01-03")["sun"]
    assert paths[4]["elevation_deg"] == pytest.approx(sun.elevation_deg, abs=1e-4)
    assert paths[4]["above_deg"] == pytest.approx(sun.elevation_deg + dip, abs=1e-3)
    code, out, err = run(capsys, "horizon", "--terrain", wall, "--site", "50.5,20.5", "--azimuths", "4", "--method", "both", "--json")
    found = json.loads(out)
    assert code == 0 and found["method"] == "both" and len(found["cameras"]) == 4, err
    east = found["horizon"][1]  # pictures draw the wall's single posts more coarsely
    assert east["image_difference_deg"] == pytest.approx(east["image_elevation_deg"] - east["elevation_deg"])
    assert 5.0 < east["image_elevation_deg"] <= east["elevation_deg"] + found["image_pixel_deg"]
    for wrong, text in ((("--target", "sun"), "accepted: with --time"), (("--time", "2026-01-01"), "accepted: T0,T1"),
                        (("--time", "2026-01-02,2026-01-01"), "accepted: an end after the start"),
                        (("--time", "2026-01-01,2026-01-02"), "no longitudes and latitudes")):
        code, _, err = run(capsys, "horizon", "--terrain", wall, "--site", "50.5,20.5", *wrong)
        assert code != 0 and text in err, (wrong, err)


LIT = ("lit", "--site", "50.5,20.5")


def test_lit_panels_on_level_ground(capsys, wall, tmp_path):
    code, out, err = run(capsys, *LIT, "--terrain", wall, "--panel", "2,3", "--sun", "-90,30", "--efficiency", "0.3", "--json",
                         "--out", tmp_path / "lit.csv")
    assert code == 0, err
    found = json.loads(out)
    assert found["area_m2"] == pytest.approx(6.0) and found["lit_percent"] == pytest.approx(100.0, abs=1e-3)
    assert found["projected_area_m2"] == pytest.approx(3.0, rel=1e-3)
    assert found["power_w"] == pytest.approx(1361 * 0.5 * 6 * 0.3, rel=1e-3)
    assert found["sun_azimuth_deg"] == pytest.approx(270.0) and found["sun_elevation_deg"] == pytest.approx(30.0)
    assert found["sun_radius_deg"] == pytest.approx(0.2666) and not found["on_body"]
    rows = list(csv.DictReader(open(tmp_path / "lit.csv")))
    assert len(rows) == 1 and {name: float(value) for name, value in rows[0].items()} == {name: found[name] for name in rows[0]}
    # The cosine between the panel's normal and the Sun, and the Sun from 2 au.
    for facing, cosine in (("-90,30", 1.0), ("270,-15", np.sqrt(0.5)), ("0,30", 0.25), ("90,10", 0.0)):
        code, out, err = run(capsys, *LIT, "--terrain", wall, "--facing", facing, "--sun", "-90,30", "--distance-au", "2",
                             "--radius-deg", "0", "--out", tmp_path / "lit.json")
        assert code == 0, err
        found = json.loads((tmp_path / "lit.json").read_text())
        assert found["power_w"] == pytest.approx(1361 / 4 * cosine, abs=1e-6), facing
        assert out.startswith(f"50.5,20.5: {found['lit_area_m2']:.6g} of 1 m^2 lit (")


def test_a_lit_panel_behind_a_wall(capsys, wall):
    """The wall's edge is 19 m over the panels' centre. Panels 81.5 - 1 to 81.5 + 1 m are half lit at 45 degrees."""
    for x, elevation, lit in (("90.5", "45", 0.0), ("90.5", "80", 4.0), ("81.5", "45", 2.0), ("70.5", "45", 4.0)):
        code, out, err = run(capsys, "lit", "--terrain", wall, "--site", f"{x},20.5", "--panel", "2,2", "--sun",
                             f"90,{elevation}", "--radius-deg", "0", "--irradiance", "1000", "--json")
        assert code == 0, err
        found = json.loads(out)
        assert found["lit_area_m2"] == pytest.approx(lit, abs=0.02)
        assert found["power_w"] == pytest.approx(1000 * lit * np.sin(np.radians(float(elevation))), abs=20)
    # The width is level: of a panel that faces up, it runs across the azimuth.
    for site, panel, facing, percent in (("79.5,20.5", "8,0.02", "0,90", 75.0), ("79.5,20.5", "8,0.02", "90,90", 100.0),
                                         ("79.5,20.5", "0.02,8", "90,90", 75.0), ("150.5,20.5", "1,2", "90,0", 75.0)):
        code, out, err = run(capsys, "lit", "--terrain", wall, "--site", site, "--height", "1" if facing != "90,0" else "0.5",
                             "--panel", panel, "--facing", facing, "--sun", "90,45", "--radius-deg", "0", "--json")
        assert code == 0, err  # the last is upright, and a quarter of it is below the ground
        assert json.loads(out)["lit_percent"] == pytest.approx(percent, abs=1.0), (site, panel, facing)


def test_a_lit_panel_on_the_moons_body(capsys, moon):
    """A panel of 1 m, 10 m over the sphere, faces the horizon, which is 0.194 degrees below it."""
    for site in ("-17,8", "-10,0", "-3,-8"):
        for elevation, lit in (("-0.15", 1.0), ("-0.25", 0.0)):
            for azimuth in ("0", "250"):
                code, out, err = run(capsys, "lit", "--terrain", moon, "--site", site, "--height", "10", "--facing",
                                     f"{azimuth},0", "--sun", f"{azimuth},{elevation}", "--radius-deg", "0", "--json")
                assert code == 0, err
                assert json.loads(out)["projected_area_m2"] == pytest.approx(lit, abs=1e-4), (site, azimuth, elevation)


def below_the_sun(time):
    """The point of the Moon below the Sun: longitude, latitude [deg]."""
    import dspace
    with dspace.Session() as session:
        scene = session.scene()
        point = scene.reference_frames.sub_solar_point("moon", scene.tdb(time))
    return point.longitude_deg, point.latitude_deg


def test_a_lit_panel_at_a_time(capsys, moon):
    """The Sun's elevation is 90 degrees less the arc to the point below it, within the parallax of 7e-4 degrees."""
    time = "2026-11-24T12:00"
    longitude, latitude = np.radians(below_the_sun(time))
    code, out, err = run(capsys, "lit", "--terrain", moon, "--site", "-12,5", "--time", time, "--json")
    assert code == 0, err
    found = json.loads(out)
    there = np.radians((-12, 5))
    height = (np.sin(there[1]) * np.sin(latitude) + np.cos(there[1]) * np.cos(latitude) * np.cos(there[0] - longitude))
    assert found["time"] == time and found["sun_elevation_deg"] == pytest.approx(np.degrees(np.arcsin(height)), abs=0.01)
    assert 1361 / 1.02**2 < found["irradiance_w_m2"] < 1361 / 0.98**2
    assert found["sun_radius_deg"] == pytest.approx(0.2666 * np.sqrt(found["irradiance_w_m2"] / 1361), rel=1e-3)
    assert found["projected_area_m2"] == pytest.approx(max(height, 0.0), abs=1e-3)
    code, out, err = run(capsys, "lit", "--terrain", moon, "--site", "-12,5", "--time", time, "--body", "nowhere")
    assert code == 1 and "nowhere" in err and out == ""


def test_a_lit_panel_in_an_eclipse(capsys, moon):
    """2022 November 8 at 12 degrees west: the panel has the part of the Sun that the map of illumination and the sky have there
    (test_eclipsed_ground.py has these against two discs)."""
    panel = ("lit", "--terrain", moon, "--site", "-12,5", "--height", "5", "--json", "--time")
    before, partial, total = (json.loads(run(capsys, *panel, f"2022-11-08T{time} TT")[1]) for time in ("08:00", "09:14", "10:00"))
    assert before["sun_left"] == 1.0 and before["lit_percent"] == 100.0 and 0.02 < partial["sun_left"] < 0.98
    assert total["sun_left"] == total["lit_area_m2"] == total["power_w"] == 0.0
    assert partial["lit_percent"] == pytest.approx(100.0 * partial["sun_left"], rel=1e-9)
    assert partial["power_w"] == pytest.approx(before["power_w"] * partial["sun_left"], rel=0.02)  # the Sun moves by 0.6 degrees
    code, out, err = run(capsys, *panel[:-2], "--time", "2022-11-08T09:14 TT")
    assert code == 0 and f"an eclipse leaves {100.0 * partial['sun_left']:.6g} % of the Sun's disc" in out


def test_a_lit_panel_at_a_time_on_a_projected_map(capsys, tmp_path):
    """Near the south pole of a polar map, places are in degrees, and the Sun's azimuth, clockwise from the map's Y axis, is the longitude below it; on the body,
    clockwise from true north, that longitude less the site's."""
    path = tmp_path / "pole.tif"
    data = gdal.GetDriverByName("GTiff").Create(str(path), 100, 100, 1, gdal.GDT_Float32)
    data.SetGeoTransform((-1000, 20, 0, 1000, 0, -20))
    data.SetProjection(f'PROJCS["p",GEOGCS["m",DATUM["m",SPHEROID["m",{R},0]],PRIMEM["G",0],UNIT["degree",0.0174532925199433]],'
                       'PROJECTION["Polar_Stereographic"],PARAMETER["latitude_of_origin",-90],PARAMETER["central_meridian",0],'
                       'PARAMETER["scale_factor",1],PARAMETER["false_easting",0],PARAMETER["false_northing",0],UNIT["metre",1]]')
    data.SetMetadataItem("VERTICAL_DATUM", "sphere")
    data.GetRasterBand(1).WriteArray(np.zeros((100, 100), np.float32))
    data = None
    time = "2026-11-24T12:00"
    longitude, _ = below_the_sun(time)
    for east, south in ((50, -89.99), (-120, -89.98), (0, -90)):
        for plane in ((), ("--plane",)):
            code, out, err = run(capsys, "lit", "--terrain", path, "--site", f"{east},{south}", "--time", time, "--json", *plane)
            assert code == 0, err
            found = json.loads(out)
            assert found["on_body"] == (not plane)
            off = (found["sun_azimuth_deg"] - longitude + (0.0 if plane else east) + 180.0) % 360.0 - 180.0
            assert off == pytest.approx(0.0, abs=0.05), (east, south, plane)
    for site, says in (("-89.99,50", "place -89.99,50 (LON,LAT) is off the terrain: it lies at map x -"), ("2000,-3000", "accepted: LON,LAT, longitude"),
                       ("-89.99,146", "accepted: LON,LAT, longitude (east) -360 to 360 and latitude -90 to 90")):
        for word, option, more in (("horizon", "--site", ()), ("viewshed", "--site", ("--out", tmp_path / "v.tif")), ("sites", "--site", ("--radius", "100", "--from",
                                   "2026-01-01", "--to", "2026-02-01"))):
            code, _, err = run(capsys, word, "--terrain", path, option, site, *more)
            assert code == 1 and says in err, (word, site, err)
    code, _, err = run(capsys, "power", "--terrain", path, "--site", "50,-89.99", "--panel", "1", "--time", "2026-02-01,2026-01-01")
    assert code == 1 and "--time '2026-02-01,2026-01-01': the end is not after the start" in err


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
    ((*LIT,), "--sun AZ,EL, --time UTC: neither is given; accepted: one of them"),
    ((*LIT, "--sun", "0,30", "--time", "2026-11-24"), "--sun AZ,EL, --time UTC: both are given; accepted: one of them"),
    ((*LIT, "--time", "2026-11-24"), "wall.tif has no CRS; accepted: a terrain with longitudes and latitudes"),
    ((*LIT, "--sun", "0,30", "--body", "moon"), "--body: accepted: with --time"),
    ((*LIT, "--sun", "0,91"), "--sun '0,91': accepted: AZ,EL, with AZ -360 to 360 and EL -90 to 90 deg"),
    ((*LIT, "--sun", "0"), "--sun '0': accepted: AZ,EL, finite numbers"),
    ((*LIT, "--sun", "0,30", "--facing", "400,0"), "--facing '400,0': accepted: AZ,EL, with AZ -360 to 360"),
    ((*LIT, "--sun", "0,30", "--panel", "0,1"), "--panel '0,1': accepted: W,H, each above 0 to 1e6 m"),
    ((*LIT, "--sun", "0,30", "--efficiency", "2"), "--efficiency 2: accepted: 0 to 1"),
    ((*LIT, "--sun", "0,30", "--samples", "0"), "--samples 0: accepted: 1 to 1000000"),
    ((*LIT, "--sun", "0,30", "--radius-deg", "nan"), "--radius-deg nan: accepted: 0 to 90"),
    ((*LIT, "--sun", "0,30", "--irradiance", "1", "--distance-au", "1"), "--irradiance, --distance-au: accepted: at most one"),
    ((*LIT, "--sun", "0,30", "--distance-au", "0"), "--distance-au 0: accepted: 1e-06 to 1e+06"),
    ((*LIT, "--sun", "0,30", "--height", "-1"), "its height above the ground is -1; accepted: 0 to 1e12 m"),
    ((*LIT, "--sun", "0,30", "--out", "a.tif"), "--out 'a.tif': accepted: a name with .json, .csv, .html, .png"),
    (("lit", "--site", "900,20", "--sun", "0,30"), "site (900, 20) of terrain 'terrain': it is off the terrain's data"),
])
def test_rejected(capsys, wall, arguments, text):
    code, out, err = run(capsys, arguments[0], "--terrain", wall, *arguments[1:])
    assert code == 1 and text in err and out == ""


def test_the_command_line_itself_may_be_wrong(capsys, wall):
    assert run(capsys, "los", "--terrain", wall)[0] == 2
    assert run(capsys, "horizon", "--terrain", wall)[0] == 2
    assert run(capsys, "lit", "--terrain", wall, "--sun", "0,30")[0] == 2
    code, out, _ = run(capsys, "horizon", "--help")
    assert code == 0 and "--azimuths" in out


def test_as_a_process(wall):
    done = subprocess.run([sys.executable, "-m", "dspace", "los", "--terrain", str(wall), "--from", "50.5,20.5,2", "--to",
                           "150.5,20.5,60"], capture_output=True, text=True, env=os.environ)
    assert done.returncode == 0 and ": clear; range" in done.stdout, done.stderr


def test_help_of_no_command_loads_numpy():
    """`--help` answers at once: modules that take time are loaded when a command works."""
    script = """
import argparse, importlib, sys
from dspace.command_line import WORDS
for word in WORDS:
    importlib.import_module(f"dspace.command_line.{word}").add_arguments(argparse.ArgumentParser())
    slow = sorted({"numpy.core", "osgeo", "matplotlib", "vtkmodules"} & set(sys.modules))
    assert not slow, (word, slow)
"""
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


def test_a_page_has_names_and_units(capsys, wall, tmp_path):
    needs_module("jinja2", "python3-jinja2")
    needs_module("matplotlib", "python3-matplotlib")
    from dspace.command_line.measure_page import columns_of
    assert columns_of([{"from_lon_deg": 2.8e-8, "range_m": 2.13726417e11, "clear": True, "frame": None, "peak_utc": "2026-01-01"},
                       {"from_lon_deg": -1e-9, "range_m": np.float64(1.0), "clear": False, "frame": None, "peak_utc": "2026-01-02"}]) == [
        ("from lon [deg]", [0.0, 0.0]), ("range [km]", [213726417.0, 0.001]), ("clear", [True, False]),
        ("peak [UTC]", ["2026-01-01", "2026-01-02"])]
    out = tmp_path / "los.html"
    code, _, err = run(capsys, "los", "--terrain", wall, "--from", "50.5,20.5,2", "--to", "150.5,20.5,2", "--out", out)
    page = out.read_text()
    assert code == 0 and "<th>obstacle distance [m]</th>" in page and "<td>49.1</td>" in page, err
    assert "on body</td>" in page and "_m<" not in page and "wall.tif (" in page  # the file with its size
