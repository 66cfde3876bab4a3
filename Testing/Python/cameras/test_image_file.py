"""Files of images: what they hold, in bounded memory, and what an interruption leaves."""
import json
import os
import signal
import subprocess
import sys
import time

import numpy as np
import pytest

import dspace
from dspace.cameras.image_file import ImageFile, read_image, read_metadata, write_image
from needs import needs_module

needs_module("OpenImageIO", "python3-openimageio")
SIZE = (300, 200)
MODEL = dspace.CameraModel("brown", name="left", frame="mast", size=SIZE, focal=(250, 250), center=(149.5, 99.5), radial=(-0.1, 0.02),
                           position=(0.1, 0.2, 0.3), quaternion=(0.5, -0.5, 0.5, -0.5))
RNG = np.random.default_rng(1)
IMAGES = {"uint8": RNG.integers(0, 256, (40, 50, 3), np.uint8), "uint16": RNG.integers(0, 65536, (40, 50), np.uint16),
          "uint32": RNG.integers(0, 2**32, (40, 50), np.uint32),
          "float32": np.where(RNG.random((40, 50, 3)) < 0.1, np.float32("inf"), RNG.normal(size=(40, 50, 3)).astype(np.float32))}


@pytest.mark.parametrize("ending, kind", [("png", "uint8"), ("png", "uint16"), ("tif", "uint8"), ("tif", "uint16"),
                                          ("tiff", "uint32"), ("tif", "float32"), ("exr", "uint32"), ("exr", "float32")])
def test_what_is_written_is_read(tmp_path, ending, kind):
    told = {"plane": "radiance", "camera": json.loads(MODEL.json), "time_s": 1.25, "note": 'é "quoted"\n'}
    for name in ("a", "b"):
        write_image(tmp_path / f"{name}.{ending}", IMAGES[kind], told)
        time.sleep(1.1 if name == "a" else 0)  # formats that note the time of writing do so to a second
    np.testing.assert_array_equal(read_image(tmp_path / f"a.{ending}"), IMAGES[kind])
    assert read_image(tmp_path / f"a.{ending}").dtype == kind and read_metadata(tmp_path / f"a.{ending}") == told
    assert (tmp_path / f"a.{ending}").read_bytes() == (tmp_path / f"b.{ending}").read_bytes()


def test_others_read_them(tmp_path):
    gdal, cv2 = needs_module("osgeo.gdal", "python3-gdal"), needs_module("cv2", "python3-opencv")
    gdal.UseExceptions()
    for ending, kind in (("tif", "float32"), ("tif", "uint32"), ("png", "uint16")):
        write_image(tmp_path / f"a.{ending}", IMAGES[kind], {})
        data = gdal.Open(str(tmp_path / f"a.{ending}")).ReadAsArray()
        np.testing.assert_array_equal(np.moveaxis(data, 0, -1) if data.ndim == 3 else data, IMAGES[kind])
    np.testing.assert_array_equal(cv2.imread(str(tmp_path / "a.png"), cv2.IMREAD_UNCHANGED), IMAGES["uint16"])


def scene_of(session):
    scene = session.scene("site")
    rng = np.random.default_rng(2)
    for k in range(12):
        scene.add_sphere(0.3, position=(3 + rng.random(), *rng.uniform(-1.5, 1.5, 2)), color=rng.random(3), name=f"ball {k}")
    rover = scene.add_frame("rover", position=(0, 0, -0.3), quaternion=(np.cos(0.1), 0, 0, np.sin(0.1)))
    scene.time = 12.5
    return scene, rover


@pytest.mark.parametrize("plane, ending", [("color", "png"), ("color", "tif"), ("radiance", "exr"), ("range", "tif"), ("label", "tif"),
                                           ("label", "exr")])
def test_a_plane_is_that_of_the_simulated_image(anywhere, tmp_path, plane, ending):
    scene, rover = scene_of(anywhere)
    path = tmp_path / f"a.{ending}"
    done = []
    lens = scene.save_image(path, MODEL, frame=rover, plane=plane, tile=64, progress=done.append)
    planes = scene.simulate_image(MODEL, frame=rover, **{"color": False, plane: True})
    expected = planes[plane][..., :3] if plane == "color" else planes[plane]
    np.testing.assert_array_equal(read_image(path), expected)
    assert lens.without_ray == planes["lens"].without_ray and done[-1] == 1.0 and len(done) == 20
    told = read_metadata(path)
    assert told["plane"] == plane and told["scene"] == "site" and told["time_s"] == 12.5
    assert dspace.CameraModel.from_json(json.dumps(told["camera"])) == MODEL
    pose = dspace.Pose(told["pose"]["position"], told["pose"]["quaternion"])
    # By the angle of the rover alone: 0.2 rad about Z; the camera looks along its X.
    c, s = np.cos(0.2), np.sin(0.2)
    np.testing.assert_allclose(pose.position, (0.1 * c - 0.2 * s, 0.1 * s + 0.2 * c, 0.0), atol=1e-12)
    np.testing.assert_allclose(pose.rotation[:, 2], (c, s, 0), atol=1e-12)


def test_the_camera_of_a_scene_gives_its_pose(session, tmp_path):
    scene, _ = scene_of(session)
    scene.add_camera("eye", eye=(0, 0, 1), target=(5, 0, 1))
    scene.save_image(tmp_path / "a.png", camera="eye", size=SIZE)
    told = read_metadata(tmp_path / "a.png")
    np.testing.assert_allclose(told["pose"]["position"], (0, 0, 1), atol=1e-12)
    assert "camera" not in told and told["plane"] == "color"


def test_counts_tell_their_sensor(session, tmp_path):
    scene, rover = scene_of(session)
    sensor = dspace.Sensor(exposure_s=0.02, bands_nm=[(600, 700)], gain=5)
    counts = sensor.expose(scene.simulate_image(MODEL, frame=rover, radiance=True, color=False)["radiance"], MODEL, seed=3)
    write_image(tmp_path / "a.png", counts, scene.image_metadata("counts", MODEL, frame=rover, sensor=sensor))
    told = read_metadata(tmp_path / "a.png")
    assert told["sensor"]["gain"] == 5 and told["sensor"]["exposure_s"] == 0.02 and told["unit"] == "counts"
    assert dspace.Sensor(**told["sensor"]).settings == sensor.settings
    np.testing.assert_array_equal(read_image(tmp_path / "a.png"), counts)


@pytest.mark.parametrize("settings", [
    dict(bands_nm=[(600, 700)], point_spread=0.8, falloff=4), dict(bayer="RGGB", point_spread=2.5),
    dict(read_noise=9, falloff=1), dict(bands_nm=[(500, 600)], dark_current=200, photon_noise=False)],
    ids=lambda settings: "-".join(settings))
def test_counts_by_tiles_are_those_of_the_whole_image(session, tmp_path, settings):
    scene, rover = scene_of(session)
    sensor = dspace.Sensor(exposure_s=0.004, full_well=9000, **settings)
    radiance = scene.simulate_image(MODEL, frame=rover, radiance=True, color=False)["radiance"]
    expected = sensor.expose(radiance, MODEL, seed=5, frame=9)
    assert expected.std() > 10
    for tile in (64, 512):
        scene.save_image(tmp_path / "a.png", MODEL, frame=rover, plane="counts", sensor=sensor, seed=5, number=9, tile=tile)
        np.testing.assert_array_equal(read_image(tmp_path / "a.png"), expected)
    told = read_metadata(tmp_path / "a.png")
    assert told["seed"] == 5 and told["number"] == 9 and dspace.Sensor(**told["sensor"]).settings == sensor.settings
    with pytest.raises(dspace.WrongType, match="the sensor is None"):
        scene.save_image(tmp_path / "b.png", MODEL, frame=rover, plane="counts")
    with pytest.raises(dspace.InvalidArgument, match="the seed is -1"):
        scene.save_image(tmp_path / "b.png", MODEL, frame=rover, plane="counts", sensor=sensor, seed=-1)
    assert not (tmp_path / "b.png").exists()


def test_what_is_wrong_is_rejected_before_anything_is_drawn(session, tmp_path):
    scene, rover = scene_of(session)
    for path, plane, kind, message in (
            ("a.jpg", "color", dspace.InvalidArgument, "its ending is '.jpg'; accepted: .png, .tif"),
            ("a.png", "range", dspace.InvalidArgument, "'float32'; accepted: uint8, uint16; it fits .tif, .tiff, .exr"),
            ("a.exr", "color", dspace.InvalidArgument, "uint8"), ("a.png", "colour", dspace.InvalidArgument, "the plane is 'colour'"),
            ("none/a.png", "color", dspace.Io, "there is no folder")):
        with pytest.raises(kind, match=message):
            scene.save_image(tmp_path / path, MODEL, frame=rover, plane=plane)
    assert list(tmp_path.iterdir()) == []
    (tmp_path / "short.png").write_bytes(b"\x89PNG\r\n\x1a\n")
    for read in (read_image, read_metadata):
        with pytest.raises(dspace.Corrupt, match="damaged"):
            read(tmp_path / "short.png")
        with pytest.raises(dspace.NotFound, match="no such file"):
            read(tmp_path / "none.png")
    file = ImageFile(tmp_path / "rows.png", (4, 3), 1, np.uint8)
    with pytest.raises(dspace.WrongType, match="3 rows at most"):
        file.write_rows(np.zeros((4, 4), np.uint8))
    with pytest.raises(dspace.InvalidArgument, match="the number of rows is 0; accepted: all 3"):
        file.commit()
    file.close()
    assert not (tmp_path / "rows.png").exists()


LARGE = '''
import resource, signal, sys, tracemalloc, dspace
signal.signal(signal.SIGINT, signal.default_int_handler)  # also where the tests run in the background, which ignores it
side, tile = map(int, sys.argv[2:])
with dspace.Session() as session:
    scene = session.scene()
    scene.add_box((8, 8, 8))
    scene.add_camera("eye").attach(scene.root)
    def model(side):
        return dspace.CameraModel("brown", size=(side, side), focal=(0.8 * side,) * 2, center=((side - 1) / 2,) * 2, radial=(-0.05,))
    scene.simulate_image(model(1024), samples=1)
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    told = []
    def tell(done):
        if not told:
            print("drawing", flush=True)
        told.append(done)
    tracemalloc.start()
    scene.save_image(sys.argv[1], model(side), samples=1, tile=tile, progress=tell)
    after = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    print(tracemalloc.get_traced_memory()[1] // 1024, (after - before) // 1024, len(told))
'''
SIDE, TILE = (16384, 512) if os.environ.get("DSPACE_LONG") else (2048, 128)
KEPT = 448  # MiB of source blocks and maps that Dspace keeps for the next tiles (LensPictures.cxx)


def test_a_large_image_takes_the_memory_of_a_band_of_tiles(tmp_path):
    path = tmp_path / "large.png"
    done = subprocess.run([sys.executable, "-W", "ignore", "-c", LARGE, path, str(SIDE), str(TILE)], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    arrays, megabytes, tiles = map(int, done.stdout.split()[1:])
    assert tiles == (SIDE // TILE) ** 2
    band, whole = 3 * SIDE * TILE / 2**10, 3 * SIDE**2 / 2**10  # KiB
    assert arrays < 3 * band + 2048 < 0.7 * whole
    assert megabytes < KEPT + 4 * band / 1024 + 60
    assert read_metadata(path)["camera"]["model"]["width"] == SIDE


def test_ctrl_c_leaves_what_was_there(tmp_path):
    """It ends within a tile, and the earlier file stays."""
    path = tmp_path / "large.png"
    path.write_bytes(b"earlier")
    process = subprocess.Popen([sys.executable, "-W", "ignore", "-c", LARGE, path, "16384", "512"], stdout=subprocess.PIPE,
                               stderr=subprocess.PIPE, text=True)
    assert process.stdout.readline() == "drawing\n"  # the first tile is done
    process.send_signal(signal.SIGINT)
    _, errors = process.communicate(timeout=60)
    assert process.returncode != 0 and "KeyboardInterrupt" in errors
    assert path.read_bytes() == b"earlier" and [each.name for each in tmp_path.iterdir()] == ["large.png"]


FULL = """
import resource, signal, sys
import numpy as np
import dspace
from dspace.cameras.image_file import write_image
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
resource.setrlimit(resource.RLIMIT_FSIZE, (int(sys.argv[3]), resource.RLIM_INFINITY))
try:
    write_image(sys.argv[1], np.random.default_rng(1).integers(0, 200, (200, 300, 3)).astype(sys.argv[2]))
except dspace.Io as error:
    print(error)
"""


@pytest.mark.parametrize("room", [0, 4096, 100_000, -1, -9, -13])
@pytest.mark.parametrize("name, kind", [("a.png", "uint8"), ("a.tif", "uint16"), ("a.exr", "float32")])
def test_a_file_that_cannot_grow_leaves_the_one_before(tmp_path, name, kind, room):
    """The system writes no more than `room` bytes, as on a full disk; less than 0: than the whole file has."""
    path = tmp_path / name
    if room < 0:
        subprocess.run([sys.executable, "-W", "ignore", "-c", FULL, str(path), kind, str(1 << 30)], check=True)
        room += path.stat().st_size
    before = np.arange(12, dtype=kind).reshape(3, 4)
    write_image(path, before)
    done = subprocess.run([sys.executable, "-W", "ignore", "-c", FULL, str(path), kind, str(room)], capture_output=True, text=True)
    assert "cannot be written" in done.stdout, done.stdout + done.stderr
    np.testing.assert_array_equal(read_image(path), before)
    assert [each.name for each in tmp_path.iterdir()] == [name]
