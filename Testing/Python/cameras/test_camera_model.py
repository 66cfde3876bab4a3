"""dspace.CameraModel: numpy in and out, files, conversion, and errors, without a session."""
import json
import os
import pathlib

import numpy as np
import pytest

import dspace
from needs import needs_module

DATA = pathlib.Path(os.environ.get("DSPACE_DATA", "/nonexistent")) / "cameras"


def data(name):
    if not (DATA / name).exists():
        pytest.skip(f"real data absent: set DSPACE_DATA to the folder that has cameras/{name}")
    return DATA / name


BROWN = dict(focal=(800, 790), center=(319.5, 240), radial=(-0.2, 0.05, 0.01, 0.02, 0.01, 0.0), tangential=(1e-3, -2e-3),
             prism=(1e-3, -5e-4, 7e-4, 3e-4), tilt_deg=(1.5, -2.0))


def points(count=200, spread=0.35):
    random = np.random.default_rng(1)
    return np.column_stack((random.uniform(-spread, spread, (count, 2)), np.ones(count))) * random.uniform(0.5, 9, (count, 1))


def test_arrays_of_any_shape():
    model = dspace.CameraModel("pinhole", size=(640, 480), focal=(500, 400), center=(320, 240))
    p = points(6).reshape(2, 3, 3)
    pixels, slopes = model.project(p, derivatives=True)
    np.testing.assert_allclose(pixels, p[..., :2] / p[..., 2:] * (500, 400) + (320, 240), atol=1e-10)
    assert slopes.shape == (2, 3, 2, 3)
    np.testing.assert_allclose(slopes[..., 0, 0], 500 / p[..., 2], rtol=1e-12)
    origins, directions = model.rays(pixels)
    np.testing.assert_allclose(np.cross(directions, p), 0, atol=1e-12)
    assert not origins.any() and model.project((0.0, 0, -1)).shape == (2,) and np.isnan(model.project((0, 0, -1))).all()
    assert model.type == "pinhole" and model.size == (640, 480) and model.values["focal"] == [500, 400]


def test_a_pose_places_the_camera():
    turn = (np.cos(0.25), 0, np.sin(0.25), 0)
    model = dspace.CameraModel("pinhole", focal=(500, 500), center=(0, 0), position=(1, 2, 3), quaternion=turn)
    c, s = np.cos(0.5), np.sin(0.5)
    R = np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]])  # about Y
    p_C = points(20)
    p_M = p_C @ R.T + (1, 2, 3)
    np.testing.assert_allclose(model.project(p_M), model.project(p_C, in_camera=True), atol=1e-9)
    origins, directions = model.rays(model.project(p_M))
    np.testing.assert_allclose(origins, np.tile((1, 2, 3), (20, 1)), atol=1e-12)
    np.testing.assert_allclose(np.cross(directions, p_M - origins), 0, atol=1e-10)


def test_brown_is_opencvs():
    cv2 = needs_module("cv2", "python3-opencv")
    model = dspace.CameraModel("brown", **BROWN)
    k, p, s, t = (np.array(BROWN[name], float) for name in ("radial", "tangential", "prism", "tilt_deg"))
    d = np.concatenate((k[:2], p, k[2:], s, np.radians(t)))
    matrix = np.array([[800, 0, 319.5], [0, 790, 240], [0, 0, 1]], float)
    theirs = cv2.projectPoints(points(), np.zeros(3), np.zeros(3), matrix, d)[0].reshape(-1, 2)
    np.testing.assert_allclose(model.project(points()), theirs, atol=1e-9)


def test_kannala_brandt_is_opencvs_fisheye():
    cv2 = needs_module("cv2", "python3-opencv")
    radial = (0.05, -0.01, 0.002, -0.0003)
    model = dspace.CameraModel("kannala_brandt", focal=(300, 310), center=(320, 240), radial=radial)
    matrix = np.array([[300, 0, 320], [0, 310, 240], [0, 0, 1]], float)
    wide = points(spread=2.0)
    theirs = cv2.fisheye.projectPoints(wide[:, None], np.zeros(3), np.zeros(3), matrix, np.array(radial))[0].reshape(-1, 2)
    np.testing.assert_allclose(model.project(wide), theirs, atol=1e-9)


@pytest.mark.parametrize("linearity", [0.0, 0.5, 1.0])
def test_cahvore_is_mrcals(linearity):
    mrcal = needs_module("mrcal", "python3-mrcal")
    R, E = (0.01, -0.03, 0.01), (0.006, 0.002, -0.001)
    model = dspace.CameraModel("cahvore", size=(1000, 750), C=(0, 0, 0), A=(0, 0, 1), H=(800, 0, 500), V=(0, 790, 375), O=(0, 0, 1), R=R,
                               E=E, linearity=linearity)
    seen = points()
    seen /= np.linalg.norm(seen, axis=1, keepdims=True)  # mrcal takes all points at a distance of 1
    theirs = mrcal.project(seen, f"LENSMODEL_CAHVORE_linearity={linearity:.2f}", np.array((800, 790, 500, 375, 0, 0, *R, *E), float))
    np.testing.assert_allclose(model.project(seen), theirs, atol=1e-9)


def test_files(tmp_path):
    model = dspace.CameraModel("brown", size=(640, 480), name="left", frame="mast", **BROWN)
    model.save(tmp_path / "a.json")
    assert dspace.CameraModel.read(tmp_path / "a.json") == model
    assert json.loads(model.json)["frame"] == "mast"
    model.save(tmp_path / "a.yaml")
    again = dspace.CameraModel.read(tmp_path / "a.yaml")
    np.testing.assert_allclose(again.project(points()), model.project(points()), atol=1e-9)
    with pytest.raises(dspace.Unsupported, match="accepted for JPL's text|accepted: CAHVOR"):
        model.save(tmp_path / "a.cahvor")
    with pytest.raises(dspace.NotFound, match="there is no such file"):
        dspace.CameraModel.read(tmp_path / "none.json")
    (tmp_path / "cut.json").write_text(model.json[:90])
    with pytest.raises(dspace.Corrupt, match="it is not JSON"):
        dspace.CameraModel.read(tmp_path / "cut.json")


def test_every_perseverance_camera():
    models = dspace.CameraModel.read_all(data("m2020_cahvore_cameras.json"))
    assert len(models) == 27 and len({m.name for m in models}) == 27
    with pytest.raises(dspace.NotFound, match="it holds 27 cameras; accepted: one of HAZFLA"):
        dspace.CameraModel.read(DATA / "m2020_cahvore_cameras.json")
    hazcam = dspace.CameraModel.read(DATA / "m2020_cahvore_cameras.json", "HAZFLA")
    check = hazcam.check()
    assert hazcam.size == (5120, 3840) and check.without_ray == 0 and check.round_trip < 1e-6
    assert 60 < check.half_angle_deg < 90 and 0 < check.pupil_shift < 0.05
    u, v = np.meshgrid(np.linspace(0, 5119, 9), np.linspace(0, 3839, 9))
    pixels = np.stack((u, v), axis=-1)
    origins, directions = hazcam.rays(pixels)
    np.testing.assert_allclose(hazcam.project(origins + 3.0 * directions), pixels, atol=1e-6)


def test_conversion_states_its_residual():
    model = dspace.CameraModel("brown", size=(640, 480), focal=(500, 500), center=(320, 240), radial=(-0.1, 0.02))
    to = model.convert("cahvor")
    assert to.model.type == "cahvor" and to.covered == 1.0 and to.rms <= to.greatest < 0.05
    u, v = np.meshgrid(np.linspace(0, 639, 41), np.linspace(0, 479, 41))
    pixels = np.stack((u, v), axis=-1)
    apart = np.linalg.norm(to.model.project(model.rays(pixels)[1]) - pixels, axis=-1)
    assert apart.max() == pytest.approx(to.greatest, rel=1e-6)
    assert np.sqrt((apart ** 2).mean()) == pytest.approx(to.rms, rel=1e-6)
    half = model.scaled((320, 240))
    np.testing.assert_allclose(half.project(points()), (model.project(points()) + 0.5) / 2 - 0.5, atol=1e-9)


@pytest.mark.parametrize("make, kind, message", [
    (lambda: dspace.CameraModel("lens", focal=(1, 1)), dspace.Unsupported, "its type is 'lens'; accepted: brown"),
    (lambda: dspace.CameraModel("pinhole", focal=(1, 1)), dspace.InvalidArgument, "'center' has 0 numbers"),
    (lambda: dspace.CameraModel("pinhole", focal=(1, float("nan")), center=(0, 0)), dspace.InvalidArgument, "finite"),
    (lambda: dspace.CameraModel("pinhole", focal="wide", center=(0, 0)), dspace.WrongType, "focal is 'wide'"),
    (lambda: dspace.CameraModel("pinhole", focal=(0, 1), center=(0, 0)), dspace.InvalidArgument, "focal length is 0"),
    (lambda: dspace.CameraModel("brown", focal=(1, 1), center=(0, 0), radial=(1,) * 7), dspace.InvalidArgument, "1 to 6"),
    (lambda: dspace.CameraModel("ucm", focal=(1, 1), center=(0, 0), alpha=2), dspace.InvalidArgument, "alpha is 2"),
    (lambda: dspace.CameraModel("cahv", C=(0, 0, 0), A=(0, 0, 1), H=(9, 0, 0), V=(0, 9, 0), position=(1, 2, 3)),
     dspace.InvalidArgument, "'position' is unknown"),
    (lambda: dspace.CameraModel("pinhole", focal=(1, 1), center=(0, 0), C=(1, 2, 3)), dspace.InvalidArgument, "'C' is unknown"),
    (lambda: dspace.CameraModel("pinhole", size=(0, 5), focal=(1, 1), center=(0, 0)), dspace.InvalidArgument, "1 to 1000000"),
    (lambda: dspace.CameraModel(3), dspace.WrongType, "the type is 3"),
])
def test_no_lens(make, kind, message):
    with pytest.raises(kind, match=message):
        make()


def test_wrong_arguments():
    model = dspace.CameraModel("pinhole", size=(640, 480), focal=(500, 500), center=(320, 240))
    for points in ((1, 2), "abc", [[1, 2, float("inf")]], 3.0):
        with pytest.raises(dspace.InvalidArgument, match="the points"):
            model.project(points)
    with pytest.raises(dspace.InvalidArgument, match="same shape"):
        model.scaled((640, 640))
    with pytest.raises(dspace.InvalidArgument, match="the size"):
        model.with_size((1, 1))
    with pytest.raises(dspace.Unsupported, match="accepted: brown"):
        model.convert("orthographic")
    with pytest.raises(AttributeError):
        model.name = "other"
    with pytest.raises(dspace.InvalidArgument, match="for which size"):
        dspace.CameraModel("pinhole", focal=(1, 1), center=(0, 0)).check()
