"""Data sets: what is in them, the same bytes however they are made, and jobs that are rejected."""
import json
import os
import subprocess
import sys
import time

import numpy as np
import pytest

import dspace
from dspace.cameras.image_file import read_image, read_metadata
from dspace.command_line import main
from dspace.datasets.job import Job
from dspace.datasets.labels import annotations, run_lengths
from dspace.datasets.make import make
from needs import needs_module

needs_module("OpenImageIO", "python3-openimageio")

JOB = '''# A test.
run = "run.dspace"
times = {first = 0.0, last = 1.5, step = 0.5}
planes = ["color", "range", "label", "counts"]
samples = 1

[[camera]]
name = "left"
model = "left.json"
frame = "rover"

[[camera]]
name = "mast"
model = "left.json"
size = [48, 36]
through = "eye"

[sensor]
seed = 7
exposure_s = 0.004
f_number = 8
bands_nm = [[600, 700]]
read_noise = 5

[[category]]
name = "rock"
objects = ["rock *"]

[[category]]
name = "marker"
objects = ["flag"]
'''
SIZE = (64, 48)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A job and its run: a rover goes 1 m a second along X towards rocks."""
    folder = tmp_path_factory.mktemp("job")
    model = dspace.CameraModel("brown", name="left", frame="rover", size=SIZE, focal=(50, 50), center=(31.5, 23.5), radial=(-0.1, 0.02),
                               position=(0.2, 0, 1), quaternion=(0.5, -0.5, 0.5, -0.5))
    model.save(folder / "left.json")
    with dspace.Session() as session:
        scene = session.scene("site")
        scene.add_plane(60, 60, color="gray")
        scene.add_box((1, 1, 1), position=(9, 1, 0.5), name="rock 1", color="brown")
        scene.add_sphere(0.6, position=(7, -1.5, 0.5), name="rock 2", color="tan")
        scene.add_cone(0.2, 1.5, position=(6, 0.2, 0.7), name="flag", color="red")
        rover = scene.add_frame("rover")
        scene.add_camera("eye", eye=(0, 0, 8), target=(8, 0, 0))
        with session.record(folder / "run.dspace"):
            for step in range(16):
                scene.time = 0.1 * step
                rover.position = (0.1 * step, 0, 0)
    (folder / "job.toml").write_text(JOB)
    return folder


@pytest.fixture(scope="module")
def whole(folder, tmp_path_factory):
    out = tmp_path_factory.mktemp("whole") / "set"
    assert make(folder / "job.toml", out) == 8
    return out


def content(out):
    return {path.name: path.read_bytes() for path in sorted(out.iterdir()) if path.name != "dataset.lock"}


def test_the_images_are_those_of_the_run(folder, whole):
    manifest = json.loads((whole / "manifest.json").read_text())
    assert [each["name"] for each in manifest["cameras"]] == ["left", "mast"] and len(manifest["images"]) == 8
    with dspace.Playback(folder / "run.dspace") as run:
        for image in manifest["images"]:
            run.seek(image["time_s"] + 0.01)
            scene = run.session.scene("site")
            camera = next(each for each in manifest["cameras"] if each["name"] == image["camera"])
            model = dspace.CameraModel.from_json(json.dumps(camera["calibration"]))
            assert list(model.size) == image["size"] == ([64, 48] if image["camera"] == "left" else [48, 36])
            place = {"frame": "rover"} if image["camera"] == "left" else {"camera": "eye"}
            planes = scene.simulate_image(model, samples=1, range=True, label=True, radiance=True, **place)
            files = {plane: whole / each["name"] for plane, each in image["files"].items()}
            np.testing.assert_array_equal(read_image(files["color"]), planes["color"][..., :3])
            np.testing.assert_array_equal(read_image(files["range"]), planes["range"])
            np.testing.assert_array_equal(read_image(files["label"]), planes["label"])
            counts = read_image(files["counts"])
            sensor = dspace.Sensor(exposure_s=0.004, f_number=8, bands_nm=[(600, 700)], read_noise=5)
            np.testing.assert_array_equal(counts, sensor.expose(planes["radiance"], model, seed=7, frame=image["number"]))
            assert counts.dtype == np.uint16
            told = read_metadata(files["counts"])
            assert told["sensor"]["f_number"] == 8 and told["time_s"] == pytest.approx(image["time_s"], abs=1e-9)
            if image["camera"] == "left":  # a metre a second, looking along X
                assert image["pose"]["position"] == pytest.approx((0.2 + image["time_s"], 0, 1), abs=1e-9)
                assert told["pose"] == image["pose"]


def test_labels_are_those_of_coco(folder, whole):
    coco = json.loads((whole / "coco.json").read_text())
    assert [(each["id"], each["name"]) for each in coco["categories"]] == [(1, "rock"), (2, "marker")]
    assert [each["id"] for each in coco["annotations"]] == list(range(1, len(coco["annotations"]) + 1))
    images = {each["id"]: each for each in coco["images"]}
    with dspace.Playback(folder / "run.dspace") as run:
        run.seek(0.0)
        ids = {name: thing.id for name, thing in run.session.scene("site").objects.items()}
    seen = set()
    for each in coco["annotations"]:
        image = images[each["image_id"]]
        labels = read_image(whole / image["file_name"].replace("color.png", "label.tif"))
        # Decoded as the format says: runs of 0 and 1, columns first.
        height, width = each["segmentation"]["size"]
        values = np.arange(len(each["segmentation"]["counts"])) % 2
        mask = np.repeat(values, each["segmentation"]["counts"]).reshape(width, height).T.astype(bool)
        np.testing.assert_array_equal(mask, labels == ids[each["object"]])
        rows, columns = np.nonzero(mask)
        assert each["bbox"] == [columns.min(), rows.min(), np.ptp(columns) + 1, np.ptp(rows) + 1] and each["area"] == len(rows)
        assert (each["category_id"] == 1) == each["object"].startswith("rock")
        seen.add((image["camera"], each["object"]))
    assert seen == {(camera, name) for camera in ("left", "mast") for name in ("rock 1", "rock 2", "flag")}


def test_run_lengths():
    assert run_lengths([[0, 1], [1, 1]]) == [1, 3] and run_lengths([[1, 0], [1, 0]]) == [0, 2, 2]
    assert run_lengths(np.zeros((2, 3))) == [6] and run_lengths(np.ones((2, 3))) == [0, 6]
    found = annotations(np.array([[5, 5, 0], [0, 5, 9]]), [(1, {9: "b", 5: "a", 7: "c"})])
    assert [(each["object"], each["bbox"], each["area"]) for each in found] == [("a", [0, 0, 2, 2], 3), ("b", [2, 1, 1, 1], 1)]


def test_processes_make_the_same(folder, whole, tmp_path):
    assert make(folder / "job.toml", tmp_path / "set", jobs=3) == 8
    assert content(tmp_path / "set") == content(whole)
    assert make(folder / "job.toml", tmp_path / "set", jobs=2) == 0 and content(tmp_path / "set") == content(whole)


def test_dask_workers_make_the_same(folder, whole, tmp_path):
    distributed = needs_module("distributed", "python3-distributed")
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, processes=False, protocol="tcp://", dashboard_address=None,
                                  local_directory=str(tmp_path / "workers")) as cluster:
        assert make(folder / "job.toml", tmp_path / "set", scheduler=cluster.scheduler_address) == 8
    assert content(tmp_path / "set") == content(whole)


def test_a_killed_one_is_continued(folder, whole, tmp_path):
    out = tmp_path / "set"
    process = subprocess.Popen([sys.executable, "-W", "ignore", "-m", "dspace", "camera", "render", folder / "job.toml", "--out", out],
                               stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    end = time.monotonic() + 120
    while not (out / "image_000002.json").exists() and time.monotonic() < end:
        time.sleep(0.002)
    process.kill()
    process.communicate()
    # Files that a crash of the machine left short count as missing, and what was half written is gone.
    (out / "image_000000_left_range.tif").write_bytes(b"II")
    (out / ".image_000005.json.0123456789abcdef.part").write_bytes(b"{")
    drawn = make(folder / "job.toml", out)
    assert 1 <= drawn <= 6 and content(out) == content(whole)


def test_another_job_draws_again(folder, whole, tmp_path):
    out = tmp_path / "set"
    job = tmp_path / "job.toml"
    words = JOB.replace('"run.dspace"', f'"{folder}/run.dspace"').replace('"left.json"', f'"{folder}/left.json"')
    job.write_text(words)
    assert make(job, out) == 8
    images = {name: data for name, data in content(out).items() if name.startswith("image_")}
    assert images == {name: data for name, data in content(whole).items() if name.startswith("image_")}
    job.write_text(words.replace("f_number = 8", "f_number = 4").replace("last = 1.5", "last = 0.5"))
    assert make(job, out) == 4
    assert sorted(path.name for path in out.glob("image_*.json")) == [f"image_{n:06d}.json" for n in range(4)]
    assert make(job, out, redraw=True) == 4


def test_poses_of_a_job(folder, tmp_path):
    job = tmp_path / "job.toml"
    dspace.CameraModel("pinhole", size=(32, 24), focal=(30, 30), center=(15.5, 11.5)).save(tmp_path / "eye.json")
    job.write_text(f'''run = "{folder}/run.dspace"
times = [0.0, 1.0]
planes = ["range"]
floats = "exr"

[[camera]]
name = "eye"
model = "eye.json"

[[pose]]
eye = [0, 0, 5]
target = [0, 0, 0]
up = [1, 0, 0]

[[pose]]
position = [0, 0, 9]
quaternion = [0, 1, 0, 0]
''')
    assert make(job, tmp_path / "set") == 4
    for number, height in enumerate((5, 9, 5, 9)):  # of one time all poses; they look straight down
        image = read_image(tmp_path / "set" / f"image_{number:06d}_eye_range.exr")
        assert image[11:13, 15:17] == pytest.approx(height, rel=2e-3)
    assert not (tmp_path / "set" / "coco.json").exists()


def test_the_command(folder, whole, tmp_path, capsys):
    assert main(["camera", "render", str(folder / "job.toml"), "--jobs", "2", "--out", str(tmp_path / "set")]) == 0
    out, err = capsys.readouterr()
    assert out == f"{tmp_path / 'set'}: 8 images of 2 cameras, each of color, range, label, counts\n" and "8 of 8" in err
    assert content(tmp_path / "set") == content(whole)
    assert main(["camera", "info", str(whole / "image_000000_left_counts.png")]) == 0
    out = capsys.readouterr().out
    assert "counts [counts] of scene 'site' at 0 s" in out and "left: brown, 64 x 48" in out and "position (0.2, 0, 1) m" in out
    assert "f_number 8" in out
    assert main(["camera", "info", str(whole / "image_000000_left_range.tif"), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["unit"] == "m"
    assert main(["camera", "render", str(folder / "job.toml"), "--at", "1", "--out", str(tmp_path / "x")]) == 1
    assert "--at is given with a job" in capsys.readouterr().err


@pytest.mark.parametrize("old, new, line, message", [
    ('run = "run.dspace"\n', "", 1, "there is no run"),
    ('"run.dspace"', '"none.dspace"', 2, "there is no such file"),
    ('step = 0.5', 'step = 0', 3, "a step above 0"),
    ('last = 1.5', 'last = 9', 3, "the time 2 s is outside of the run, 0 to 1.5 s"),
    ('"range"', '"rangs"', 4, "the plane 'rangs' is unknown; accepted: color"),
    ('samples = 1', 'samples = 9', 5, "samples is 9; accepted: 1 to 8"),
    ('samples = 1', 'sample = 1', 5, "unknown 'sample'; accepted: run, scene"),
    ('samples = 1', 'exposure = "x"', 5, "exposure is 'x'; accepted: a whole number or a number"),
    ('samples = 1', 'scene = "moon"', 5, "the scene is 'moon'; accepted: one of 'site'"),
    ('name = "mast"', 'name = "left"', 13, "there is another camera 'left'"),
    ('name = "mast"', 'name = "a/b"', 13, "as in names of files"),
    ('model = "left.json"\nsize', 'model = "none.json"\nsize', 14, "none.json"),
    ('size = [48, 36]', 'size = [48, 48]', 15, "same shape"),
    ('through = "eye"', 'through = "nose"', 16, "no camera 'nose'; accepted: one of 'eye'"),
    ('frame = "rover"', 'frame = "arm"', 10, "'arm'"),
    ('read_noise = 5', 'read_noise = -5', 18, "read noise is -5"),
    ('read_noise = 5', 'noise = 5', 23, "unknown 'noise'; accepted: seed, exposure_s"),
    ('seed = 7', 'seed = -7', 19, "seed is -7"),
    ('objects = ["flag"]', 'objects = []', 31, "patterns of names"),
    ('samples = 1', 'samples = [', 7, "accepted: TOML"),
])
def test_bad_jobs_are_rejected_before_drawing(folder, tmp_path, old, new, line, message):
    assert old in JOB
    path = folder / f"bad_{os.getpid()}.toml"
    path.write_text(JOB.replace(old, new, 1))
    try:
        with pytest.raises(dspace.Error) as error:
            make(path, tmp_path / "set")
    finally:
        path.unlink()
    assert message in str(error.value) and str(path) in str(error.value)
    assert f"line {line}" in str(error.value) and not (tmp_path / "set").exists()


def test_other_arguments_are_checked(folder, tmp_path):
    job = Job.load(folder / "job.toml")
    for arguments, message in ((dict(jobs=0), "jobs is 0"), (dict(jobs=65), "1 to 64"), (dict(scheduler="here"), "tcp://HOST:PORT")):
        with pytest.raises(dspace.InvalidArgument, match=message):
            make(job, tmp_path / "set", **arguments)
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "thesis.txt").write_text("years")
    with pytest.raises(dspace.InvalidArgument, match="belongs to no dataset"):
        make(job, tmp_path / "mine")
    with pytest.raises(dspace.Error, match="there is no such file|No such file"):
        make(tmp_path / "none.toml", tmp_path / "set")
