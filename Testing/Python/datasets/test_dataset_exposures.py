"""Jobs of data sets with a shutter and with line scans: against pictures that the test draws at each instant itself."""
import json
import os

import numpy as np
import pytest

import dspace
from dspace.cameras.image_file import read_image
from dspace.datasets.labels import annotations, compressed, run_lengths
from dspace.datasets.make import make
from needs import needs_module

needs_module("OpenImageIO", "python3-openimageio")

JOB = '''run = "run.dspace"
times = [0.3, 0.5]
planes = ["radiance", "label", "counts"]
samples = 1
masks = "compressed"

[[camera]]
name = "eye"
model = "eye.json"

[shutter]
exposure_s = 0.08
readout_s = 0.1
samples = 4
bands = 3

[sensor]
exposure_s = 0.08

[[category]]
name = "bar"
objects = ["bar"]
'''
SCAN = '''run = "run.dspace"
times = [0.1, 0.4]
planes = ["range", "label"]
samples = 1

[[camera]]
name = "row"
model = "row.json"
line_s = 0.02
'''
LINES = 16


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A run of one second in steps of 10 ms: a bar goes along X by 4 m a second, in front of a wall."""
    folder = tmp_path_factory.mktemp("job")
    dspace.CameraModel("brown", size=(40, 30), focal=(30, 30), center=(19.5, 14.5), radial=(-0.1,)).save(folder / "eye.json")
    lines = np.array([0.0, LINES - 1.0])
    dspace.CameraModel("line_scan", size=(40, LINES), focal_length=1.0, matrix=(30, 0, 0, 30), center=(19.5, 0.0), row=0.0, line=lines,
                       positions=np.column_stack((0 * lines, 0.1 * lines - 0.75, 0 * lines)).ravel(),
                       rotations=[1, 0, 0, 0, 1, 0, 0, 0]).save(folder / "row.json")
    with dspace.Session() as session:
        scene = session.scene("site")
        scene.sun.set(direction=(0.1, 0.2, -1))
        scene.add_plane(60, 60, position=(0, 0, 8), color="gray")
        bar = scene.add_frame("moving", position=(-2, 0, 5))
        scene.add_box((0.6, 8, 0.2), frame=bar, name="bar", color="white")
        with session.record(folder / "run.dspace"):
            for step in range(101):
                scene.time = 0.01 * step
                bar.position = (0.04 * step - 2, 0, 5)
    (folder / "job.toml").write_text(JOB)
    (folder / "scan.toml").write_text(SCAN)
    return folder


def at(run, time):
    run.seek(time + 1e-6)
    return run.session.scene("site")


def content(out):
    return {path.name: path.read_bytes() for path in sorted(out.iterdir()) if path.name != "dataset.lock"}


@pytest.fixture(scope="module")
def exposed(folder, tmp_path_factory):
    out = tmp_path_factory.mktemp("exposed") / "set"
    assert make(folder / "job.toml", out) == 2
    return out


def test_a_job_exposes_as_its_shutter_says(folder, exposed):
    model = dspace.CameraModel.read(folder / "eye.json")
    with dspace.Playback(folder / "run.dspace") as run:
        for number, time in enumerate((0.3, 0.5)):
            expected, labels = np.zeros((30, 40, 3)), np.zeros((30, 40), np.uint32)
            for first, last in ((0, 10), (10, 20), (20, 30)):
                middle = 0.1 / 29 * (0.5 * (first + last - 1) - 14.5)
                for k in range(4):
                    scene = at(run, time + middle + 0.02 * k - 0.03)
                    planes = scene.simulate_image(model, frame=scene.root, color=False, radiance=True, samples=1)
                    expected[first:last] += planes["radiance"][first:last] / 4
                scene = at(run, time + middle)
                labels[first:last] = scene.simulate_image(model, frame=scene.root, color=False, label=True, samples=1)["label"][first:last]
            still = at(run, time).simulate_image(model, frame=scene.root, color=False, radiance=True, samples=1)["radiance"]
            found = read_image(exposed / f"image_{number:06d}_eye_radiance.tif")
            np.testing.assert_allclose(found, expected, rtol=1e-6, atol=1e-6)
            assert np.abs(still - expected).max() > 0.2 * still.max()  # blurred, and slanted
            np.testing.assert_array_equal(read_image(exposed / f"image_{number:06d}_eye_label.tif"), labels)
            counts = dspace.Sensor(exposure_s=0.08).expose(found, model, seed=0, frame=number)
            np.testing.assert_array_equal(read_image(exposed / f"image_{number:06d}_eye_counts.png"), counts)
    manifest = json.loads((exposed / "manifest.json").read_text())
    assert manifest["shutter"] == dict(exposure_s=0.08, readout_s=0.1, direction="down", samples=4, bands=3)


def test_masks_are_compressed(exposed):
    coco = json.loads((exposed / "coco.json").read_text())
    assert len(coco["annotations"]) == 2
    for each in coco["annotations"]:
        label = read_image(exposed / f"image_{each['image_id'] - 1:06d}_eye_label.tif")
        height, width = each["segmentation"]["size"]
        lengths = decoded(each["segmentation"]["counts"])
        mask = np.repeat(np.arange(len(lengths)) % 2, lengths).reshape(width, height).T
        assert mask.sum() == each["area"] > 20
        np.testing.assert_array_equal(mask == 1, label == np.unique(label[mask == 1])[0])


def decoded(words):
    """Run lengths of COCO's compressed RLE, by its description: 5 bits a character, the lowest first, bit 6 where more follow, the
    highest bit of the last the sign; from the fourth on differences from the one two before."""
    lengths, value, shift = [], 0, 0
    for character in words.encode():
        group = character - 48
        assert 0 <= group < 64
        value |= (group % 32) << shift
        shift += 5
        if group < 32:
            value -= (1 << shift) if group & 16 else 0
            lengths.append(value + (lengths[-2] if len(lengths) > 2 else 0))
            value, shift = 0, 0
    return lengths


def test_compressed_masks():
    # By hand: 0 and 15 are one character; 16 has the sign's bit, so another follows: 16 + 32 + 48 = '`' and '0'.
    assert compressed([0, 15]) == "0?" and compressed([16]) == "`0" and compressed([6, 1, 40, 4, 5, 4, 5, 4, 21]) == "61X13mN000`0"
    random = np.random.default_rng(3)
    for density in (0.0, 0.02, 0.5, 0.98, 1.0):
        lengths = run_lengths(random.random((70, 90)) < density)
        assert decoded(compressed(lengths)) == lengths
    long = [0, 5_000_000, 1, 3_000_000, 2, 1]
    assert decoded(compressed(long)) == long
    found = annotations(np.array([[5, 0], [5, 5]]), [(1, {5: "a"})], True)
    assert found[0]["segmentation"] == {"size": [2, 2], "counts": compressed([0, 2, 1, 1])}


def test_lines_are_of_their_own_times(folder, tmp_path):
    out = tmp_path / "set"
    assert make(folder / "scan.toml", out) == 2
    model = dspace.CameraModel.read(folder / "row.json")
    with dspace.Playback(folder / "run.dspace") as run:
        for number, time in enumerate((0.1, 0.4)):
            label = read_image(out / f"image_{number:06d}_row_label.tif")
            ids = {name: thing.id for name, thing in at(run, time).objects.items()}
            for line in range(LINES):
                # The bar's front is at Z = 4.9, its middle at X; the row's rays lie in the plane of X and Z.
                x = 4 * (time + 0.02 * line) - 2
                left, right = (19.5 + 30 * (x + side) / 4.9 for side in (-0.3, 0.3))
                u = np.arange(40)
                inside, outside = (u > left + 0.8) & (u < right - 0.8), (u < left - 0.8) | (u > right + 0.8)
                assert (label[line][inside] == ids["bar"]).all() and not (label[line][outside] == ids["bar"]).any(), (time, line)
            scene = at(run, time)
            still = scene.simulate_lines(model, scene.root, color=False, label=True, samples=1)["label"]
            assert (still[0] == label[0]).all() and (still[-1] != label[-1]).any()


@pytest.mark.parametrize("name", ["job", "scan"])
def test_processes_make_the_same(folder, tmp_path, name):
    assert make(folder / f"{name}.toml", tmp_path / "one") == make(folder / f"{name}.toml", tmp_path / "two", jobs=2) == 2
    assert content(tmp_path / "one") == content(tmp_path / "two")


@pytest.mark.parametrize("job, old, new, line, message", [
    (JOB, "readout_s = 0.1", "readout = 0.1", 13, "unknown 'readout'; accepted: exposure_s, readout_s"),
    (JOB, "readout_s = 0.1", "readout_s = -0.1", 11, "readout_s"),
    (JOB, "exposure_s = 0.08", "exposure_s = 0.0", 11, "exposure_s"),
    (JOB, "exposure_s = 0.08", "exposure_s = 0.05", 12, "accepted: the sensor's, 0.08"),
    (JOB, "times = [0.3, 0.5]", "times = [0.05, 0.5]", 2, "at 0.05 s camera 'eye' is exposed from -0.04 to 0.14 s, and the run is from 0"),
    (JOB, '"compressed"', '"zip"', 5, "masks is 'zip'; accepted: 'lists', 'compressed'"),
    (JOB, 'model = "eye.json"', 'model = "eye.json"\nline_s = 1.0', 10, "line_s is 1; accepted: seconds from line to line"),
    (SCAN, "line_s = 0.02", "line_s = -0.02", 9, "line_s is -0.02"),
    (SCAN, "line_s = 0.02", "line_s = 0.05", 2, "exposed from 0.4 to 1.15 s"),
    (SCAN, "line_s = 0.02", "[shutter]\nexposure_s = 0.01", 6, "is a line scan, and the job has [shutter]"),
    (SCAN, "line_s = 0.02", 'through = "eye"', 6, "is a line scan, and the job has through"),
    (SCAN, '"run.dspace"', '"run.py:run"', 1, "which goes forward alone"),
])
def test_bad_jobs_are_rejected(folder, tmp_path, job, old, new, line, message):
    assert old in job
    (folder / "run.py").write_text("def run():\n    raise AssertionError\n")
    path = folder / f"bad_{os.getpid()}.toml"
    path.write_text(job.replace(old, new, 1))
    with pytest.raises(dspace.Error) as error:
        make(path, tmp_path / "set")
    assert f"line {line}: " in str(error.value) and message in str(error.value)
    assert not (tmp_path / "set").exists()
