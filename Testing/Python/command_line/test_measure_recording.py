"""`dspace los`, `dspace horizon`, `dspace lit` and maps in the scene of a recording at a time."""
import csv
import json

import numpy as np
import pytest

import dspace
from command_support import run, write_wall
from needs import needs_module
from terrain_support import gdal


@pytest.fixture
def recording(tmp_path):
    """A plane with a wall of 20 m along x = 100.5, in a frame 1,000 m up. A mast climbs from 2 m to 62 m above the ground, and at 10 s
    a plate of 4 m2 appears west of the wall, under a Sun in the east that is 45 degrees high."""
    wall = write_wall(tmp_path / "wall.tif", 201)
    path = tmp_path / "run.dspace"
    with dspace.Session() as session:
        scene = session.scene()
        base = scene.add_frame("base", position=(0, 0, 1000))
        ground = scene.add_terrain(wall, name="ground", frame=base)
        mast = base.add_frame("mast", position=ground.from_map([50.5, 20.5, 2.0]))
        base.add_frame("far", position=ground.from_map([150.5, 20.5, 2.0]))
        scene.sun.set(azimuth_deg=90, elevation_deg=45, radius_deg=0.01, irradiance=1000.0)
        with session.record(path):
            scene.time = 0.0
            scene.time = 10.0
            mast.position = ground.from_map([50.5, 20.5, 62.0])
            plate = scene.add_frame("plate", position=np.add(ground.from_map([95.5, 20.5, 5.0]), (0, 0, 1000)))
            scene.add_plane(2.0, 2.0, name="plate", frame=plate)
            scene.time = 20.0
    return path


def test_lines_between_frames_and_sites(capsys, recording, tmp_path):
    los = ("los", "--recording", recording, "--from", "base/mast", "--to", "base/far", "--to", "150.5,20.5,2")
    code, out, err = run(capsys, *los, "--at", 5)
    assert code == 0, err
    lines = out.splitlines()
    assert all("blocked by ground after 49.100 m at 99.6, 20.5, height 2.000 m; range 100.000 m, clearance -18.000 m" in line for line in lines)
    assert lines[0].startswith("base/mast to base/far: ") and lines[1].startswith("base/mast to 150.5,20.5,2: ")
    code, out, err = run(capsys, *los, "--json", "--out", tmp_path / "lines.csv")
    found = json.loads(out)
    assert code == 0 and [line["clear"] for line in found["lines"]] == [True, True], err
    assert found["terrain"] == "ground" and found["recording"] == str(recording)
    # Half way the line is 32 m up: 12 m over the wall.
    assert found["lines"][0]["clearance_m"] == pytest.approx(2.0, abs=1e-4)
    assert found["lines"][0]["range_m"] == pytest.approx(np.hypot(100.0, 60.0))
    rows = list(csv.DictReader(open(tmp_path / "lines.csv")))
    assert [row["to_frame"] for row in rows] == ["base/far", ""] and [row["to_map_x"] for row in rows] == ["", "150.5"]
    # What is in the way is the plate, unless it is left out.
    plate = ("los", "--recording", recording, "--from", "95.5,20.5,1", "--to", "95.5,20.5,9", "--json")
    line = json.loads(run(capsys, *plate)[1])["lines"][0]
    assert line["obstacle"] == "plate" and line["obstacle_distance_m"] == pytest.approx(4.0, abs=1e-5)
    assert json.loads(run(capsys, *plate, "--without", "plate")[1])["lines"][0]["clear"]
    assert json.loads(run(capsys, *plate, "--at", 0)[1])["lines"][0]["clear"]
    needs_module("matplotlib", "python3-matplotlib")
    assert run(capsys, *los, "--out", tmp_path / "lines.png")[0] == 0


def test_lines_over_a_span(capsys, recording, tmp_path):
    """The mast is behind the wall until 10 s; then it looks over it. Its elevation from the far frame is 31 degrees."""
    los = ("los", "--recording", recording, "--from", "base/far", "--to", "base/mast", "--to", "150.5,20.5,9", "--time", "0,20,3")
    code, out, err = run(capsys, *los)
    assert code == 0, err
    assert "base/far to base/mast: clear from 10.0" in out and "still at 20.000 s" in out
    assert "base/far to base/mast: clear 9.99" in out and "base/far to 150.5,20.5,9: clear 20.000 s, 100.00 % of the time" in out
    found = json.loads(run(capsys, *los, "--mask", 20, "--out", tmp_path / "span.csv", "--json")[1])
    assert [row["to_frame"] for row in found["contacts"]] == ["base/mast", None]
    assert found["contacts"][0]["set_elevation_deg"] == pytest.approx(np.degrees(np.arctan2(60.0, 100.0)), abs=1e-6)
    assert found["contacts"][0]["set_azimuth_deg"] == pytest.approx(270.0, abs=1e-6)
    assert [float(row["duration_s"]) for row in csv.DictReader(open(tmp_path / "span.csv"))] == pytest.approx([10.0, 20.0], abs=0.011)
    for wrong, text in ((("--time", "0,40"), "runs from 0 to 20 s"), (("--time", "0,20", "--at", "3"), "without --at"),
                        (("--time", "x"), "accepted: T0,T1"), (("--time", "0,20", "--wavelength", "1"), "without --wavelength"),
                        (("--mask", "5"), "accepted: with --time")):
        code, _, err = run(capsys, *los[:-2], *wrong)
        assert code != 0 and text in err, wrong
    needs_module("matplotlib", "python3-matplotlib")
    assert run(capsys, *los, "--out", tmp_path / "span.png")[0] == 0


def test_horizons_of_frames(capsys, recording, tmp_path):
    for at, height in ((0, 2.0), (20, 62.0)):
        code, out, err = run(capsys, "horizon", "--recording", recording, "--at", at, "--frame", "base/mast", "--azimuths", 4, "--json")
        assert code == 0, err
        found = json.loads(out)
        east = found["horizon"][1]
        if height < 20.0:
            assert east["elevation_deg"] == pytest.approx(np.degrees(np.arctan2(20.0 - height, 50.0)), abs=1e-5)
            assert east["map_x"] == pytest.approx(100.5, abs=1e-6) and found["frame"] == "base/mast"
        else:  # the last post is the edge of the plane
            assert east["elevation_deg"] == pytest.approx(-np.degrees(np.arctan2(height, 150.0)), abs=1e-5)
    site = run(capsys, "horizon", "--recording", recording, "--at", 0, "--site", "50.5,20.5", "--height", 2, "--azimuths", 4, "--json")[1]
    frame = run(capsys, "horizon", "--recording", recording, "--at", 0, "--frame", "base/mast", "--azimuths", 4, "--json")[1]
    assert [row["elevation_deg"] for row in json.loads(site)["horizon"]] == pytest.approx(
        [row["elevation_deg"] for row in json.loads(frame)["horizon"]], abs=1e-5)


def test_objects_in_the_recorded_sun(capsys, recording, tmp_path):
    lit = ("lit", "--recording", recording, "--object", "plate", "--efficiency", 0.25)
    code, out, err = run(capsys, *lit, "--json", "--out", tmp_path / "lit.csv")
    assert code == 0, err
    found = json.loads(out)["objects"][0]
    # The wall's shadow reaches 15 m above the ground there: the plate at 5 m is dark.
    assert found["area_m2"] == pytest.approx(4.0) and found["lit_area_m2"] == 0.0
    with dspace.Playback(recording) as playback:
        playback.seek(20.0)
        scene = playback.session.scenes["scene"]
        scene.frame("plate").position = scene.frame("plate").position + np.array([-10.0, 0.0, 30.0])
        with playback.session.record(tmp_path / "above.dspace"):
            scene.time = 30.0
    code, out, err = run(capsys, "lit", "--recording", tmp_path / "above.dspace", "--object", "plate", "--efficiency", 0.25)
    assert code == 0 and out.startswith("plate: 4 of 4 m^2 lit (100.00 %), projected area 2.82843 m^2, power 707.107 W; 1000 W/m^2"), out + err
    # A panel at a site, in the shadow of the plate: the shadow's edge is 4 m / tan(75) from x = 94.5.
    panel = ("lit", "--recording", recording, "--site", "93.5,20.5", "--height", 1, "--sun", "90,75", "--json")
    code, out, err = run(capsys, *panel)
    assert code == 0 and json.loads(out)["lit_percent"] == pytest.approx(100.0 * (1.5 - 4.0 / np.tan(np.radians(75.0))), abs=1.0), err
    assert json.loads(run(capsys, *panel, "--at", 0)[1])["lit_percent"] > 99.0


def test_a_panel_on_a_frame(capsys, recording, tmp_path):
    """50 m before the wall of 20 m, whose shadow is 20 m long."""
    lit = ("lit", "--recording", recording, "--frame", "/base/mast", "--panel", "2,3", "--facing", "90,45", "--efficiency", 0.5)
    code, out, err = run(capsys, *lit, "--json", "--out", tmp_path / "lit.csv")
    assert code == 0, err
    found = json.loads(out)["frames"][0]
    assert found["frame"] == "/base/mast" and found["area_m2"] == pytest.approx(6.0)
    assert found["projected_area_m2"] == pytest.approx(6.0, rel=1e-4) and found["power_w"] == pytest.approx(3000.0, rel=1e-4)
    # Facing west and 45 degrees up it is edge-on to the Sun: half of the disc lights it, whose mean height is 4 r / 3 pi. Facing
    # up, the cosine of 45 degrees is left.
    for facing, power in (("270,45", 3000.0 * 2.0 / (3.0 * np.pi) * np.radians(0.01)), ("0,90", 3000.0 * np.sqrt(0.5))):
        turned = json.loads(run(capsys, *lit[:7], "--facing", facing, "--efficiency", 0.5, "--json")[1])["frames"][0]
        assert turned["power_w"] == pytest.approx(power, rel=0.01)
    for wrong, text in ((("--sun", "1,2"), "--sun: accepted: without --frame"), (("--panel", "0,1"), "each above 0"),
                        (("--facing", "0,91"), "EL -90 to 90")):
        code, _, err = run(capsys, *lit, *wrong)
        assert code == 1 and text in err
    assert "accepted: with --recording" in run(capsys, "lit", "--terrain", "a.tif", "--frame", "x")[2]
    needs_module("matplotlib", "python3-matplotlib")
    for ending in (".png", ".html"):
        assert run(capsys, *lit, "--out", tmp_path / f"lit{ending}")[0] == 0
        assert run(capsys, "lit", "--recording", recording, "--site", "93.5,20.5", "--sun", "90,75", "--out", tmp_path / f"site{ending}")[0] == 0


def test_a_viewshed_of_frames(capsys, recording, tmp_path):
    """A mast at 2 m sees what a site of 2 m sees; at 62 m also beyond the wall, from where its line over the edge meets the ground."""
    view = ("viewshed", "--recording", recording, "--json")
    for at, height in ((0, 2), (20, 62)):
        code, out, err = run(capsys, *view, "--at", at, "--frame", "base/mast", "--out", tmp_path / f"frame{at}.tif")
        assert code == 0, err
        assert json.loads(out)["sites"] == [{"frame": "base/mast", "map_x": pytest.approx(50.5), "map_y": pytest.approx(20.5),
                                             "height_m": pytest.approx(height, abs=1e-6)}]
        assert run(capsys, *view, "--at", at, "--site", "50.5,20.5", "--height", height, "--out", tmp_path / f"site{at}.tif")[0] == 0
        frame, site = (gdal.Open(str(tmp_path / f"{name}{at}.tif")).ReadAsArray() for name in ("frame", "site"))
        assert (frame == site).all()
    assert not gdal.Open(str(tmp_path / "frame0.tif")).ReadAsArray()[20, 102:].any()
    # Over the wall's edge, 50 m away and 42 m below, the line falls the last 20 m in 23.8 m.
    row = gdal.Open(str(tmp_path / "frame20.tif")).ReadAsArray()[20]
    assert not row[102:123].any() and row[126:].all()
    both = run(capsys, *view, "--at", 20, "--frame", "base/mast", "--frame", "base/far", "--quantity", "count", "--out",
               tmp_path / "both.tif")
    assert both[0] == 0, both[2]
    assert gdal.Open(str(tmp_path / "both.tif")).ReadAsArray()[20, 150] == 2
    for frame, text in (("base", "--frame base: it is 20 m below the ground"), ("plate", None), ("x", "x")):
        code, _, err = run(capsys, *view, "--frame", frame, "--out", tmp_path / "x.tif")
        assert (code == 0) == (text is None) and (text is None or text in err)
    assert "neither is given" in run(capsys, *view, "--out", tmp_path / "y.tif")[2]
    assert "accepted: with --recording" in run(capsys, "viewshed", "--terrain", tmp_path / "wall.tif", "--frame", "x", "--out",
                                               tmp_path / "y.tif")[2]


def test_maps_of_the_recorded_terrain(capsys, recording, tmp_path):
    code, out, err = run(capsys, "viewshed", "--recording", recording, "--site", "10.5,20.5", "--height", 2, "--out", tmp_path / "view.tif")
    assert code == 0, err
    seen = gdal.Open(str(tmp_path / "view.tif")).ReadAsArray()
    assert seen[20, :100].all() and not seen[:, 102:].any()


@pytest.mark.parametrize("arguments, code, text", [
    (("los", "--from", "none", "--to", "base/far"), 1, "none"),
    (("los", "--from", "base/mast", "--to", "1,2"), 1, "--to '1,2': accepted: LON,LAT,H"),
    (("los", "--from", "base/mast", "--to", "base/far", "--on", "other"), 1, "the terrain is 'other'; accepted: --on with one of 'ground'"),
    (("los", "--from", "base/mast", "--to", "base/far", "--scene", "x"), 1, "the scene is 'x'; accepted: --scene with one of 'scene'"),
    (("los", "--from", "base/mast", "--to", "base/far", "--at", "-5"), 1, "--at -5: "),
    (("los", "--from", "base/mast", "--to", "base/far", "--at", "4000"), 1, "accepted: a time within it"),
    (("horizon", "--frame", "base/mast", "--height", "3"), 1, "--height: accepted: with --site or --map"),
    (("los", "--from", "base/mast", "--to", "base/far", "--without", "x"), 1, "object 'x'"),
    (("los", "--from", "base/mast", "--to", "base/far", "--crs", "EPSG:4326"), 1, "accepted: without options of rasters"),
    (("los", "--from", "base/mast", "--to", "base/far", "--terrain", "a.tif"), 2, "not allowed with argument"),
    (("horizon", "--azimuths", "4"), 2, "--site --frame --map"),
    (("lit", "--object", "plate", "--time", "2026-01-01"), 1, "--time: accepted: without --object"),
    (("lit", "--object", "none"), 1, "object 'none'"),
    (("illumination", "--from", "2026-01-01", "--to", "2026-01-02", "--ensemble", "2", "--variogram", "gaussian:1,2", "--out", "a.tif"), 1,
     "accepted: without --ensemble"),
])
def test_rejected(capsys, monkeypatch, recording, tmp_path, arguments, code, text):
    monkeypatch.chdir(tmp_path)
    found, _, err = run(capsys, arguments[0], "--recording", recording, *arguments[1:])
    assert found == code and text in err, err


def test_frames_need_a_recording(capsys, tmp_path):
    wall = write_wall(tmp_path / "wall.tif", 21)
    for words, text in ((("horizon", "--frame", "a"), "--frame: accepted: with --recording"),
                        (("lit", "--object", "a"), "--object: accepted: with --recording"),
                        (("los", "--from", "a", "--to", "b"), "--from 'a': accepted: LON,LAT,H"),
                        (("los", "--from", "1,2,3", "--to", "2,3,4", "--at", "3"), "--on, --at, --scene: accepted: with --recording"),
                        (("los", "--from", "1,2,3", "--to", "2,3,4", "--without", "x"), "--without: accepted: with --recording")):
        code, _, err = run(capsys, words[0], "--terrain", wall, *words[1:])
        assert code == 1 and text in err, err
