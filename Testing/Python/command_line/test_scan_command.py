"""`dspace scan`: over terrain and in a recording."""
import csv
import json

import numpy as np
import pytest

import dspace
from command_support import run, write_wall


@pytest.fixture
def wall(tmp_path):
    return write_wall(tmp_path / "wall.tif", 101)


def test_a_lidar_before_a_wall(capsys, wall, tmp_path):
    """Level ground with a wall of 20 m that rises from x = 49.5 to 50.5."""
    arguments = ("scan", "--terrain", wall, "--site", "30.5,20.5", "--height", "1", "--azimuths", "90,90,1")
    code, out, err = run(capsys, *arguments, "--elevations", "0,0,1", "--json")
    assert code == 0, err
    found = json.loads(out)
    assert found["beams"] == 1 and found["outcomes"] == {"echo": 1} and found["objects"] == {"terrain": 1}
    assert found["least_range_m"] == pytest.approx(19.0 + 0.05, abs=1e-6)  # at 1 m of 20 the wall is a twentieth in
    code, out, err = run(capsys, *arguments, "--elevations", "-10,45,12", "--noise", "0.01", "--seed", "4", "--out",
                         tmp_path / "scan.csv")
    assert code == 0, err
    assert "12 beams: " in out and "12 rows" in out and "on terrain (" in out
    with open(tmp_path / "scan.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    assert {row["outcome"] for row in rows} == {"echo", "nothing"} and len(rows) == 12
    assert float(rows[0]["true_range"]) == pytest.approx(1.0 / np.sin(np.radians(10)), abs=1e-6)
    assert 0 < abs(float(rows[0]["range"]) - float(rows[0]["true_range"])) < 0.06
    code, out, err = run(capsys, *arguments, "--out", tmp_path / "scan.ply")
    assert code == 0 and (tmp_path / "scan.ply").read_bytes().startswith(b"ply\n"), err


def test_an_altimeter(capsys, wall):
    code, out, err = run(capsys, "scan", "--terrain", wall, "--site", "20.5,20.5", "--height", "7", "--altimeter", "5", "--json")
    assert code == 0, err
    assert json.loads(out)["least_range_m"] == pytest.approx(7.0, abs=1e-3)


def test_in_a_recording(capsys, tmp_path):
    path = tmp_path / "run.dspace"
    with dspace.Session() as session:
        with session.record(path):
            scene = session.scene()
            scene.add_box((1, 1, 1), position=(0, 3, 0), name="rock")
            frame = scene.add_frame("mast")
            scene.add_camera("eye", eye=(0, 0, 0), target=(0, 1, 0), up=(0, 0, 1), frame=frame)
            scene.time = 5.0
            frame.position = (0, 1, 0)
            scene.time = 6.0
    ahead = ("scan", "--recording", path, "--azimuths", "0,0,1", "--elevations", "0,0,1", "--json")
    for more, expected in ((("--frame", "mast"), 1.5), (("--frame", "mast", "--at", "4"), 2.5), (("--through", "eye"), 1.5)):
        code, out, err = run(capsys, *ahead, *more)
        assert code == 0, err
        assert json.loads(out)["least_range_m"] == pytest.approx(expected, abs=1e-9)
        assert json.loads(out)["objects"] == {"rock": 1}
    code, out, err = run(capsys, *ahead, "--frame", "mast", "--without", "rock")
    assert code == 0 and json.loads(out)["outcomes"] == {"nothing": 1}, err
    model = dspace.CameraModel("pinhole", size=(9, 7), focal=(20, 20), center=(4, 3))
    model.save(tmp_path / "lens.json")
    code, out, err = run(capsys, *ahead, "--model", tmp_path / "lens.json", "--through", "eye")
    assert code == 0 and json.loads(out)["beams"] == 63, err


@pytest.mark.parametrize("arguments, text", [
    (("--terrain", "WALL"), "--terrain: accepted: with --site"),
    (("--terrain", "WALL", "--site", "20.5,20.5", "--azimuths", "0,90"), "--azimuths '0,90': accepted: FIRST,LAST,N"),
    (("--terrain", "WALL", "--site", "20.5,20.5", "--azimuths", "0,90,0"), "with an N of 1 to 1000000"),
    (("--terrain", "WALL", "--site", "20.5,20.5", "--range", "5,1"), "the greatest range is 1 m"),
    (("--terrain", "WALL", "--site", "20.5,20.5", "--out", "x.txt"), "accepted: a name with .ply, .csv"),
    (("--terrain", "WALL", "--site", "20.5,20.5", "--frame", "mast"), "--frame: accepted: with --recording"),
    (("--terrain", "WALL", "--site", "220.5,20.5"), "it is off the terrain's data"),
    (("--recording", "absent.dspace"), "--frame and --through: accepted: one of them"),
    (("--recording", "absent.dspace", "--frame", "mast"), "absent.dspace"),
])
def test_rejected(capsys, wall, arguments, text):
    code, out, err = run(capsys, "scan", *(str(wall) if each == "WALL" else each for each in arguments))
    assert code == 1 and err.strip().splitlines()[-1].startswith("dspace: ") and text in err, err


@pytest.mark.parametrize("arguments", [(), ("--terrain", "a.tif", "--recording", "b.dspace")])
def test_a_terrain_or_a_recording_is_needed(capsys, arguments):
    code, out, err = run(capsys, "scan", *arguments)
    assert code == 2 and "--terrain" in err and "--recording" in err
