"""The demo: its files, its linkage, and wheels that stand on the ground that is drawn."""
import json
import os
import pathlib
import re
import subprocess
import sys

import numpy as np
import pytest

import dspace
from needs import needs_module
from dspace.rover import Path

ROOT = pathlib.Path(__file__).resolve().parents[3]
DEMO = ROOT / "Examples" / "rover_drive"
DATA_SHIPPED = ROOT / "Data"
DATA = pathlib.Path(os.environ.get("DSPACE_DATA") or "/nonexistent")
sys.path.insert(0, str(DEMO))

from vehicle import Described, Ground, PlacedVehicle  # noqa: E402  (of the demo)

REAL = {
    "m2020_gale": ("models/m2020_rover/m2020.urdf", "terrain/mars_gale_mola_128ppd_m.tif", []),
    "rocky7_apollo15": ("models/rocky7_vrml", "terrain/moon_apollo15_nac_dtm_257.png",
                        ["--vertical-scale", "0.19216", "--pixel-size", "2"]),
    "viper_north_pole": ("models/viper_obj", "terrain/moon_npole_stereo_33.tif", []),
    "iss_carried": ("models/spacecraft_glb/iss.glb", None, ["--scale", "0.1"]),
}


def run(folder, *arguments):
    return subprocess.run([sys.executable, DEMO / "rover_drive.py", "--out", folder, "--seconds", "0.2",
                           "--size", "192x128", *map(str, arguments)], capture_output=True, text=True)


def check_files(folder):
    for name in ("chase", "mast", "overhead", "free", "contact_sheet"):
        assert (folder / f"{name}.png").stat().st_size > 500
    probe = subprocess.run(["ffprobe", "-v", "error", "-count_frames", "-show_entries",
                            "stream=width,height,nb_read_frames", "-of", "json", folder / "demo.mp4"],
                           capture_output=True, text=True, check=True)
    stream = json.loads(probe.stdout)["streams"][0]
    assert (stream["width"], stream["height"], int(stream["nb_read_frames"])) == (192, 128, 7)
    assert "renderer" in (folder / "report.txt").read_text()


def test_the_shipped_demo_makes_its_files(tmp_path):
    done = run(tmp_path)
    assert done.returncode == 0, done.stderr
    assert "note:" not in done.stderr  # what ships gives no warning
    check_files(tmp_path)
    for name in ("demo.mp4", "chase.png", "report.txt"):
        assert str(tmp_path / name) in done.stdout
    report = (tmp_path / "report.txt").read_text()
    assert "a clipmap of" in report and "pixels of the height query" in report
    assert all(int(count) > 1000 for count in re.search(
        r"triangles +chase (\d+), mast (\d+), overhead (\d+), free (\d+); .* (\d+)", report).groups())


def test_the_demo_draws_triangles_where_asked(tmp_path):
    done = run(tmp_path, "--mode", "triangles")
    assert done.returncode == 0, done.stderr
    assert "triangles of the terrain, every post about the route" in (tmp_path / "report.txt").read_text()


@pytest.mark.parametrize("name", REAL)
def test_the_demo_runs_on_real_data(name, tmp_path):
    model, terrain, more = REAL[name]
    for path in filter(None, (model, terrain)):
        if not (DATA / path).exists():
            pytest.skip(f"real data absent: set DSPACE_DATA to the folder that has {path}")
    done = run(tmp_path, "--model", DATA / model, *(("--terrain", DATA / terrain) if terrain else ()),
               *more)
    assert done.returncode == 0, done.stderr
    check_files(tmp_path)
    if name == "rocky7_apollo15":  # 2 m a pixel, given by hand: nothing is left to assume
        assert "no georeference" not in done.stderr
    if name == "m2020_gale":  # absent there, and said so
        assert "CHASSIS" in done.stderr and "Turret" in done.stderr


@pytest.mark.parametrize("arguments, message", [
    (["--terrain", "no_such.tif"], "no_such.tif"),
    (["--model", "no_such.urdf"], "no_such.urdf"),
    (["--size", "0x0"], "0x0"),
    (["--seconds", "-1"], "-1"),
    (["--mode", "planes"], "planes"),
])
def test_bad_arguments_are_named(arguments, message, tmp_path):
    done = run(tmp_path, *arguments)
    assert done.returncode != 0 and message in done.stderr
    assert "Traceback" not in done.stderr


def raster(path, heights, pixel):
    gdal = needs_module("osgeo.gdal", "python3-gdal")
    data = gdal.GetDriverByName("GTiff").Create(str(path), heights.shape[1], heights.shape[0], 1, gdal.GDT_Float32)
    data.SetGeoTransform((0, pixel, 0, 0, 0, -pixel))
    data.SetProjection('LOCAL_CS["site",UNIT["metre",1]]')
    data.GetRasterBand(1).SetNoDataValue(-1)
    data.GetRasterBand(1).WriteArray(heights)
    return path


def test_a_frames_json_without_a_suspension_is_carried(tmp_path):
    import shutil
    shutil.copy(DATA_SHIPPED / "rover" / "wheel.glb", tmp_path)
    (tmp_path / "frames.json").write_text(json.dumps({"vehicle": "probe", "frames": [
        {"name": "body", "parent": None, "translation_m": [0, 0, 0.3], "mesh": "wheel.glb"},
        {"name": "head", "parent": "body", "translation_m": [0.2, 0, 0.5], "mesh": "wheel.glb"}]}))
    with dspace.Session() as session:
        scene = session.scene()
        described = Described(scene, tmp_path, 1.0, None)
        assert not described.wheeled
        low, high = described.objects[0].box
        assert described.vehicle.size[2] == pytest.approx(high[2] - low[2] + 0.5, abs=1e-6)  # the two, one above the other
    done = run(tmp_path / "out", "--model", tmp_path)
    assert done.returncode == 0, done.stderr
    assert "on the ground under its footprint" in (tmp_path / "out" / "report.txt").read_text()


def test_a_drive_begins_where_there_is_ground(tmp_path):
    heights = np.full((120, 120), 5.0)
    heights[:, 30:90] = -1  # the middle has no data
    done = run(tmp_path, "--terrain", raster(tmp_path / "holed.tif", heights, 1.0))
    assert done.returncode == 0, done.stderr
    heights[:] = -1
    heights[::12] = 5.0
    done = run(tmp_path, "--terrain", raster(tmp_path / "stripes.tif", heights, 1.0))
    assert done.returncode == 1 and "no place has data under a route" in done.stderr and "Traceback" not in done.stderr


def test_coarse_ground_is_reported_and_shown(tmp_path):
    heights = np.add.outer(np.linspace(0, 300, 60), np.linspace(0, 200, 60))
    done = run(tmp_path, "--terrain", raster(tmp_path / "coarse.tif", heights, 100.0))
    assert done.returncode == 0, done.stderr
    assert "100 m apart" in done.stderr and "contours show" in done.stderr


@pytest.fixture(scope="module")
def drive():
    with dspace.Session() as session:
        scene = session.scene()
        terrain = scene.add_terrain(ROOT / "Data/field/field.tif", triangles=60000)
        with open(ROOT / "Data/field/route.json") as file:
            way = Path(json.load(file)["way_points_m"], speed=1.0, ramp=1.0)
        terrain.focus(np.column_stack(way.sample(np.linspace(0, way.length, 50))[:2]), radius=4)
        described = Described(scene, ROOT / "Data/rover/rover.urdf", 1.0, None)
        states = described.vehicle.drive(way, np.linspace(5, way.duration - 5, 12), Ground(terrain))
        yield scene, terrain, described, PlacedVehicle(scene, described), states


def test_rods_keep_their_length_and_the_differential_its_constraint(drive):
    scene, _, described, placed, states = drive
    links = described.robot.links
    rods = [("rocker_left", "bogie_left"), ("rocker_right", "bogie_right"),
            ("bogie_left", "wheel_middle_left"), ("bogie_right", "wheel_middle_right"),
            ("rocker_left", "steer_front_left"), ("bogie_right", "steer_rear_right")]
    lengths = []
    for state in states:
        placed.move(state, pan_deg=10.0)
        position = {name: links[name].world_pose.position for rod in rods for name in rod}
        lengths.append([np.linalg.norm(position[a] - position[b]) for a, b in rods])
        joints = described.robot.joint_positions()
        assert joints["rocker_right"] == pytest.approx(-joints["rocker_left"], abs=1e-9)
    assert np.ptp(np.array(lengths), axis=0).max() < 1e-9
    assert np.ptp([s.joints["rocker_left"] for s in states]) > 1.0  # it did move


def test_wheels_stand_on_the_ground_that_is_drawn(drive):
    """From below the wheels' frames alone: the lowest point of each wheel against the depth of a
    picture of the terrain seen from straight above, within a centimetre."""
    scene, terrain, described, placed, states = drive
    for state in states[::3]:
        placed.move(state, pan_deg=0.0)
        for name, contact in state.contacts.items():
            # The wheel's rim passes through the contact: its distance from the axle, in the link's
            # own plane, is the radius.
            link = described.robot.links[name]
            local = link.world_pose.inverse().apply(contact)
            assert np.hypot(local[0], local[2]) == pytest.approx(0.20, abs=2e-3)
            assert abs(local[1]) < 0.13
        for o in described.robot.objects:
            o.visible = False
        for contact in state.contacts.values():
            x, y, z = contact
            scene.add_camera("above", eye=(x, y, z + 5.0), target=(x, y, z), up=(0, 1, 0), height=0.2,
                             near=1.0, far=20.0)
            view = scene.add_viewport(size=(21, 21), camera="above", samples=1)
            assert 5.0 - view.depth()[10, 10] == pytest.approx(0.0, abs=0.01)
            assert terrain.height(x, y) == pytest.approx(z, abs=1e-3)
            view.remove()
        for o in described.robot.objects:
            o.visible = True
