"""Stereo pairs: rectification against OpenCV and closed forms, disparities against surfaces and the range plane."""
import numpy as np
import pytest

import dspace
from dspace.cameras.matching import METHODS, match
from needs import needs_module

SIZE = (320, 240)
CENTER = (159.5, 119.5)
BROWN = dict(size=SIZE, focal=(260, 262), center=CENTER, radial=(-0.12, 0.03), tangential=(1e-3, -5e-4))


def turned(x=0.0, y=0.0, z=0.0):
    return dspace.Pose.from_rpy_deg(x, y, z).quaternion


def toed_in():
    """Two cameras that are turned, rolled and set apart in all directions."""
    left = dspace.CameraModel("brown", name="L", frame="mast", position=(0.1, 0.2, 0.3), quaternion=turned(1, 3, -1), **BROWN)
    right = dspace.CameraModel("brown", name="R", frame="mast", position=(0.5, 0.22, 0.32), quaternion=turned(-1, -2, 1.5), **BROWN)
    return dspace.StereoPair(left, right)


# --- Rectification ---------------------------------------------------------------------------------

def test_a_parallel_pair_of_pinholes_is_rectified_already():
    left = dspace.CameraModel("pinhole", size=SIZE, focal=(250, 250), center=(150, 110))
    pair = dspace.StereoPair(left, baseline=0.4)
    assert pair.baseline == pytest.approx(0.4) and pair.calibration["rectified"]["size"] == list(SIZE)
    assert pair.calibration["rectified"]["focal"] == pytest.approx(250, rel=1e-9)
    np.testing.assert_allclose(pair.calibration["rectified"]["center"], (150, 110), atol=1e-9)
    np.testing.assert_allclose(pair.calibration["rectified"]["rotation"], np.eye(3), atol=1e-12)
    image = np.random.default_rng(1).random((240, 320)).astype(np.float32)
    for out in pair.rectify(image, image):
        np.testing.assert_allclose(out, image, atol=1e-5)
    point = np.array((0.3, -0.2, 4.0))
    u, v = 250 * point[:2] / 4 + (150, 110)
    np.testing.assert_allclose(pair.left.project(point), (u, v), atol=1e-9)
    np.testing.assert_allclose(pair.right.project(point), (u - 250 * 0.4 / 4, v), atol=1e-9)


def test_a_thing_is_in_one_row_and_its_disparity_tells_its_depth():
    pair = toed_in()
    rectified = pair.rectified
    rng = np.random.default_rng(2)
    points = pair.left.position + rng.uniform((-1, -1, 3), (1, 1, 9), (200, 3))
    left, right = rectified.left.project(points), rectified.right.project(points)
    np.testing.assert_allclose(left[:, 1], right[:, 1], atol=1e-9)
    # From the places and the axes alone.
    x = np.array((0.4, 0.02, 0.02))
    baseline = np.linalg.norm(x)
    x /= baseline
    z = sum(model.rotation[:, 2] for model in (pair.left, pair.right))
    z -= (z @ x) * x
    z /= np.linalg.norm(z)
    depth = (points - pair.left.position) @ z
    focal = pair.calibration["rectified"]["focal"]
    np.testing.assert_allclose(left[:, 0] - right[:, 0], focal * baseline / depth, atol=1e-9)
    np.testing.assert_allclose(pair.depth(left[:, 0] - right[:, 0]), depth, rtol=1e-9)
    np.testing.assert_allclose(pair.disparity(depth), left[:, 0] - right[:, 0], atol=1e-9)
    # Q of OpenCV: X, Y, Z, W of (u, v, d, 1).
    u, v = left.T
    homogeneous = np.array(pair.calibration["rectified"]["Q"]) @ np.stack((u, v, left[:, 0] - right[:, 0], np.ones(len(u))))
    in_left = (points - pair.left.position) @ np.array(pair.calibration["rectified"]["rotation"])
    np.testing.assert_allclose((homogeneous[:3] / homogeneous[3]).T, in_left, atol=1e-8)


def test_the_maps_are_those_of_opencv():
    cv2 = needs_module("cv2", "python3-opencv")
    pair = toed_in()
    shape = pair.calibration["rectified"]
    P = np.array(((shape["focal"], 0, shape["center"][0]), (0, shape["focal"], shape["center"][1]), (0, 0, 1)))
    K = np.array(((260, 0, CENTER[0]), (0, 262, CENTER[1]), (0, 0, 1.0)))
    columns = np.dstack(np.meshgrid(np.arange(SIZE[0]), np.arange(SIZE[1]))).astype(np.float32)
    images = [np.dstack((columns, columns[..., :1])).astype(np.float32)] * 2  # the value of a pixel is its place
    for out, model in zip(pair.rectify(*images), (pair.left, pair.right)):
        turn = np.array(shape["rotation"]).T @ model.rotation  # R_RC
        x, y = cv2.initUndistortRectifyMap(K, np.array((-0.12, 0.03, 1e-3, -5e-4, 0)), turn, P, SIZE, cv2.CV_32FC1)
        inside = (x >= 0) & (x <= SIZE[0] - 1) & (y >= 0) & (y <= SIZE[1] - 1)
        assert inside.mean() > 0.7
        np.testing.assert_allclose(out[inside][:, :2], np.stack((x, y), axis=-1)[inside], atol=2e-4)
        outside = (x < -0.51) | (x > SIZE[0] - 0.49) | (y < -0.51) | (y > SIZE[1] - 0.49)
        assert np.isnan(out[outside]).all()


@pytest.mark.parametrize("values", [
    dict(type="equidistant", focal=(120, 120), center=CENTER),
    dict(type="double_sphere", focal=(110, 110), center=CENTER, xi=-0.2, alpha=0.57),
    dict(type="cahvore", A=(0, 0, 1), H=(150, 0, CENTER[0]), V=(0, 150, CENTER[1]), O=(0, 0, 1), R=(0, -0.02, 0),
         E=(0, 0, 0), linearity=0, C=(0, 0, 0))], ids=lambda values: values["type"])
def test_wide_lenses_are_rectified(values):
    """The value of a pixel is the direction of its ray; that of a rectified pixel is the rectified pinhole's."""
    left = dspace.CameraModel(size=SIZE, **values)
    right = left.moved(dspace.Pose((0.3, 0.01, -0.02), turned(0.5, -2, 1)))
    pair = dspace.StereoPair(left, right)
    pixels = np.dstack(np.meshgrid(np.arange(SIZE[0]), np.arange(SIZE[1]))).astype(float)
    images = [model.rays(pixels)[1] for model in (left, right)]
    for out, model in zip(pair.rectify(*images), (pair.rectified.left, pair.rectified.right)):
        _, expected = model.rays(pixels)
        found = np.isfinite(out).all(axis=-1)
        assert found.mean() > 0.7
        np.testing.assert_allclose(out[found], expected[found], atol=3e-5)  # between pixels


def test_labels_are_not_blended():
    pair = toed_in()
    labels = np.random.default_rng(3).integers(1, 2**32, (240, 320), dtype=np.uint32)
    for out in pair.rectify(labels, labels, nearest=True):
        assert out.dtype == np.uint32 and set(np.unique(out)) <= set(labels.ravel()) | {0}


def test_a_model_is_moved():
    navcam = dspace.CameraModel("cahvor", size=SIZE, C=(1, 2, 3), A=(0, 0, 1), H=(150, 0, 159.5), V=(0, 150, 119.5), O=(0, 0, 1),
                                R=(0, 0.1, 0))
    brown = dspace.CameraModel("brown", position=(1, 2, 3), quaternion=turned(10, 20, 30), **BROWN)
    pose = dspace.Pose((5, -3, 1), turned(40, -20, 110))
    points = np.random.default_rng(4).uniform((-2, -2, 4), (2, 2, 9), (50, 3))
    for model in (navcam, brown):
        at = model.position + points @ model.rotation.T
        moved = model.moved(pose, "map")
        assert moved.frame == "map"
        np.testing.assert_allclose(moved.project(pose.position + at @ pose.rotation.T), model.project(at), atol=1e-8)
        np.testing.assert_allclose(model.project(at), model.project(points, in_camera=True), atol=1e-8)
    with pytest.raises(dspace.InvalidArgument, match="the pose's scale is 2"):
        brown.moved(dspace.Pose(scale=2.0))


# --- Matching --------------------------------------------------------------------------------------

def texture(x, y):
    rng = np.random.default_rng(5)
    return sum(np.sin(a * x + b * y + c) for a, b, c in zip(*rng.normal(size=(2, 60)) * 0.8, rng.uniform(0, 6.28, 60)))


@pytest.mark.parametrize("method", METHODS)
def test_disparities_of_a_curved_surface(method):
    if method == "sgbm":
        needs_module("cv2", "python3-opencv")
    u, v = np.meshgrid(np.arange(320.0), np.arange(240.0))
    expected = 5 + 0.05 * u + 3 * np.sin(v / 40)
    left, right = texture(u, v), texture((u + 5 + 3 * np.sin(v / 40)) / 0.95, v)
    found = match(left, right, (0, 40), method=method)
    good = np.isfinite(found)
    assert good.mean() > 0.9
    error = np.abs(found - expected)[good]
    assert (error < 1).mean() > 0.995 and np.median(error) < 0.15  # parts of a pixel
    assert found.dtype == np.float32 and np.array_equal(found, match(left, right, (0, 40), method=method), equal_nan=True)
    # The first columns show what the right picture does not: little is found there by chance.
    assert good[:, :2].mean() < 0.25
    # Of unlike pictures nothing is found, or little.
    noise = np.random.default_rng(6).random((2, 240, 320))
    assert np.isfinite(match(*noise, (0, 40), method=method)).mean() < 0.3


def test_disparities_may_be_negative():
    u, v = np.meshgrid(np.arange(160.0), np.arange(64.0))
    for method in METHODS:
        if method == "sgbm":
            needs_module("cv2", "python3-opencv")
        found = match(texture(u, v), texture(u - 6, v), (-20, 12), method=method)
        assert np.nanmedian(found) == pytest.approx(-6, abs=0.1) and np.isfinite(found).mean() > 0.8


def add_yard(scene):
    """Textured ground, and blocks that stand on it, before a camera at (0, 0, 0) that looks along Z; Y is down."""
    rng = np.random.default_rng(7)

    def grid(points, name):
        rows, columns = points.shape[:2]
        k = np.arange(rows * columns).reshape(rows, columns)
        a, b, c, d = (each.ravel() for each in (k[:-1, :-1], k[:-1, 1:], k[1:, 1:], k[1:, :-1]))
        triangles = np.concatenate((np.column_stack((a, b, c)), np.column_stack((a, c, d))))
        shade = rng.uniform(0.1, 0.9, len(triangles) // 2)
        scene.add_mesh(points.reshape(-1, 3), triangles, colors=np.repeat(np.tile(shade, 2)[:, None], 3, axis=1), name=name, lit=False)

    x, z = np.meshgrid(np.arange(-6, 6, 0.05), np.geomspace(1.5, 12, 220))
    grid(np.stack((x, 1.0 + 0.1 * np.sin(2 * x) * np.cos(z), z), axis=-1), "ground")
    for k, (cx, cz, size) in enumerate(((-1.0, 4.0, 0.8), (0.9, 5.5, 1.0), (0.2, 3.0, 0.4), (2.0, 8.0, 1.5))):
        x, y = np.meshgrid(np.linspace(cx - size / 2, cx + size / 2, 60), np.linspace(1.1 - size, 1.1, 60))
        grid(np.stack((x, y, np.full(x.shape, cz)), axis=-1), f"block {k}")
    x, y = np.meshgrid(np.arange(-8, 8, 0.1), np.arange(-6, 3, 0.1))
    grid(np.stack((x, y, np.full(x.shape, 12.0)), axis=-1), "wall")


@pytest.mark.parametrize("method", METHODS)
def test_disparities_of_a_scene_are_those_of_its_range_plane(session, method):
    if method == "sgbm":
        needs_module("cv2", "python3-opencv")
    scene = session.scene()
    add_yard(scene)
    mast = scene.add_frame("mast", position=(0, 0, 0))
    left = dspace.CameraModel("brown", quaternion=turned(0, 1, 0.5), **BROWN)
    right = dspace.CameraModel("brown", position=(0.25, 0.0, 0.0), quaternion=turned(0, -1, -0.5), **BROWN)
    pair = dspace.StereoPair(left, right)
    pictures = pair.rectify(*(planes["color"] for planes in pair.capture(scene, frame=mast, samples=2)))
    found = pair.match(*pictures, nearest=1.2, method=method)
    # The range along each ray from the left camera, drawn through the rectified pinhole itself.
    range_ = scene.simulate_image(pair.rectified.left, frame=mast, color=False, range=True)["range"]
    rays = pair.rectified.left.rays(np.dstack(np.meshgrid(np.arange(SIZE[0]), np.arange(SIZE[1]))).astype(float), in_camera=True)[1]
    expected = pair.calibration["rectified"]["focal"] * pair.baseline / (range_ * rays[..., 2])
    valid = np.isfinite(found) & np.isfinite(range_)
    assert valid.mean() > 0.7
    assert (np.abs(found - expected)[valid] < 1).mean() > 0.9
    # Ranges and points, by the same disparity.
    near = valid & (np.abs(found - expected) < 0.5) & (range_ < 5)
    np.testing.assert_allclose(pair.range(found)[near], range_[near], rtol=0.06)
    np.testing.assert_allclose(np.linalg.norm(pair.points(found)[near] - left.position, axis=-1), pair.range(found)[near], rtol=1e-9)


def test_a_pair_on_a_camera_sees_what_it_sees_on_a_frame(session):
    scene = session.scene()
    add_yard(scene)
    pair = toed_in()
    # The camera stands where the left one is, so that M lies on the root.
    camera = scene.add_camera("eye", frame=scene.root, pose=pair.left.pose)
    for one, other in zip(pair.capture(scene, camera=camera), pair.capture(scene, frame=scene.root)):
        assert np.abs(one["color"].astype(int) - other["color"]).mean() < 0.1
        assert one["color"].std() > 10
    with pytest.raises(dspace.InvalidArgument, match="one of them"):
        pair.capture(scene)


def test_anaglyph():
    left, right = np.zeros((20, 20, 3), np.uint8), np.full((20, 20, 4), 90, np.uint8)
    left[..., 0] = 30
    picture = dspace.StereoPair.anaglyph(left, right)
    assert picture.shape == (20, 20, 3) and picture.dtype == np.uint8 and (picture == (10, 90, 90)).all()


@pytest.mark.parametrize("arguments, kind, message", [
    (dict(), dspace.InvalidArgument, "one of them"),
    (dict(baseline=0.0), dspace.InvalidArgument, "the baseline is 0"),
    (dict(baseline=-0.3), dspace.InvalidArgument, "above 0"),
    (dict(baseline=0.3, focal=0), dspace.InvalidArgument, "focal length is 0"),
    (dict(baseline=0.3, size=(8, 8)), dspace.InvalidArgument, "16 to 32768"),
    (dict(right="model"), dspace.WrongType, "the right camera is 'model'; accepted: a dspace.CameraModel"),
    (dict(right=dspace.CameraModel("brown", **BROWN)), dspace.InvalidArgument, "another than the left one's"),
    (dict(right=dspace.CameraModel("brown", position=(-1, 0, 0), **BROWN)), dspace.InvalidArgument, "180.0 deg.*to the right"),
    (dict(right=dspace.CameraModel("brown", position=(0, 0, 1), **BROWN)), dspace.InvalidArgument, "90.0 deg"),
    (dict(right=dspace.CameraModel("brown", frame="arm", position=(1, 0, 0), **BROWN)), dspace.InvalidArgument, "'arm'"),
])
def test_pairs_that_are_none_are_rejected(arguments, kind, message):
    with pytest.raises(kind, match=message):
        dspace.StereoPair(dspace.CameraModel("brown", **BROWN), **arguments)


@pytest.mark.parametrize("change, message", [
    (dict(right=np.zeros((32, 33))), "that of the left one"), (dict(left=np.zeros((8, 8))), "at least 16 x 16"),
    (dict(disparities=(5, 5)), "most above least"), (dict(disparities=7), "disparities is 7"),
    (dict(window=4), "an odd number from 3 to 31"), (dict(method="best"), "'sgbm', 'census'")])
def test_matches_that_are_none_are_rejected(change, message):
    with pytest.raises(dspace.InvalidArgument, match=message):
        match(**{**dict(left=np.zeros((32, 32)), right=np.zeros((32, 32)), disparities=(0, 16)), **change})
