"""`dspace camera`: what it prints and writes, and what is rejected."""
import json

import numpy as np
import pytest

import dspace
from dspace.command_line import main


def run(capsys, *arguments):
    try:
        code = main(["camera", *map(str, arguments)])
    except SystemExit as end:
        code = end.code
    out = capsys.readouterr()
    return code, out.out, out.err


@pytest.fixture
def model(tmp_path):
    made = dspace.CameraModel("brown", name="left", frame="mast", size=(640, 480), focal=(500, 500), center=(320, 240),
                              radial=(-0.1, 0.02), position=(1, 2, 3), quaternion=(0.5, -0.5, 0.5, -0.5))
    made.save(tmp_path / "left.json")
    return tmp_path / "left.json"


def test_points_and_pixels(capsys, model):
    # The camera at (1, 2, 3) looks along X; Y is to its left, Z up.
    r2 = 0.1 ** 2 + 0.05 ** 2
    g = 500 * (1 - 0.1 * r2 + 0.02 * r2 ** 2)
    code, out, err = run(capsys, "project", model, "--point", "11,1,2.5", "--point", "-9,2,3", "--pixel", "320,240", "--json")
    found = json.loads(out)
    assert code == 0 and not err and found["name"] == "left" and found["frame"] == "mast"
    np.testing.assert_allclose(found["points"][0]["pixel"], (320 + 0.1 * g, 240 + 0.05 * g), atol=1e-9)
    assert found["points"][1]["pixel"] is None  # behind
    np.testing.assert_allclose(found["pixels"][0]["origin"], (1, 2, 3), atol=1e-12)
    np.testing.assert_allclose(found["pixels"][0]["direction"], (1, 0, 0), atol=1e-12)
    code, out, err = run(capsys, "project", model, "--camera-axes", "--point", "0.1,0.05,1", "--pixel", "0,0")
    assert code == 0 and out.startswith(f"0.1,0.05,1: {320 + 0.1 * g:.9f} {240 + 0.05 * g:.9f}\n0,0: 0.000000000 ")


def test_info_and_check(capsys, model, tmp_path):
    code, out, err = run(capsys, "info", model)
    assert code == 0 and out.startswith("left: brown, 640 x 480, up to ") and "in mast at (1, 2, 3) m" in out
    code, out, err = run(capsys, "info", model, "--json")
    assert json.loads(out)[0]["model"]["type"] == "brown"
    code, out, err = run(capsys, "check", model, "--json")
    assert code == 0 and json.loads(out)["without_ray"] == 0
    dspace.CameraModel("brown", size=(640, 480), focal=(200, 200), center=(320, 240), radial=(-0.3,)).save(tmp_path / "f.json")
    code, out, err = run(capsys, "check", tmp_path / "f.json")
    # The fold is at r = 1 / sqrt(0.9): 46.508 deg.
    assert code == 1 and f"one to one within {np.degrees(np.arctan(1 / np.sqrt(0.9))):.4f} deg of the axis, up to a fold" in out


def test_convert(capsys, model, tmp_path):
    code, out, err = run(capsys, "convert", model, "--type", "cahvor", "--out", tmp_path / "left.cahvor")
    assert code == 0 and "cahvor, residual " in out and "over 100.00 % of the image" in out
    found = dspace.CameraModel.read(tmp_path / "left.cahvor")
    np.testing.assert_allclose(found.position, (1, 2, 3), atol=1e-12)
    p = np.array((11, 1, 2.5))
    np.testing.assert_allclose(found.project(p), dspace.CameraModel.read(model).project(p), atol=0.05)
    code, out, err = run(capsys, "convert", model, "--scaled", "320x240", "--out", tmp_path / "half.json")
    assert code == 0 and dspace.CameraModel.read(tmp_path / "half.json").size == (320, 240)
    code, out, err = run(capsys, "convert", model, "--out", tmp_path / "left.yaml")
    assert code == 1 and "cannot hold" in err and not (tmp_path / "left.yaml").exists()


def test_render_a_recording(capsys, model, tmp_path):
    with dspace.Session() as session:
        scene = session.scene()
        mast = scene.add_frame("mast")
        ball = scene.add_sphere(0.1, frame=mast, position=(6, 2, 3), lit=False)
        with session.record(tmp_path / "run.dspace"):
            scene.time = 1.0
            mast.position = (100, 0, 0)
            scene.time = 2.0
        identity = ball.id
    code, out, err = run(capsys, "render", model, "--recording", tmp_path / "run.dspace", "--frame", "mast",
                         "--plane", "label", "--plane", "range", "--samples", 1, "--out", tmp_path / "a.npz")
    assert code == 0, err
    assert "640 x 480 pixels from" in out and "0 pixels see nothing" in out
    planes = np.load(tmp_path / "a.npz")
    v, u = np.nonzero(planes["label"] == identity)
    # Labels are the nearest source pixel's, which may lie half a pixel to one side over the whole ball.
    np.testing.assert_allclose((u.mean(), v.mean()), (320, 240), atol=0.55)
    assert planes["range"][240, 320] == pytest.approx(4.9, abs=0.01)
    code, out, err = run(capsys, "render", model, "--recording", tmp_path / "run.dspace", "--frame", "mast", "--scaled",
                         "320x240", "--out", tmp_path / "a.png")
    assert code == 0 and (tmp_path / "a.png").read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize("arguments, code, message", [
    (("project", "MODEL"), 1, "neither --point nor --pixel is given"),
    (("project", "MODEL", "--point", "1,2"), 2, "'1,2'; accepted: X,Y,Z"),
    (("project", "none.json", "--point", "1,2,3"), 1, "there is no such file"),
    (("project", "MODEL", "--camera", "right", "--point", "1,2,3"), 1, "accepted: one of left"),
    (("check", "MODEL", "--size", "1x1"), 1, "the size is (1, 1)"),
    (("convert", "MODEL", "--type", "spiral", "--out", "x.json"), 1, "'spiral' cannot be fitted"),
    (("render", "MODEL", "--recording", "r", "--frame", "mast", "--plane", "range", "--out", "x.png"), 1, "accepted: .png for"),
    (("render", "MODEL", "--recording", "r", "--out", "x.png"), 1, "one of --frame PATH and --through"),
    (("render", "MODEL", "--recording", "r", "--frame", "mast", "--jobs", "2", "--out", "x.png"), 1, "--jobs is given without a JOB.toml"),
])
def test_rejected(capsys, model, arguments, code, message):
    found, out, err = run(capsys, *(model if each == "MODEL" else each for each in arguments))
    assert found == code and message in err and len(err.splitlines()) == 1 and not out
