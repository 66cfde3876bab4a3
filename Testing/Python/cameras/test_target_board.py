"""A target board through every type of lens but the line scan: its corners in the picture, found by OpenCV, lie where formulas written apart put them."""
import numpy as np
import pytest

import dspace
from needs import needs_module
from test_simulated_images import CENTER, LENSES, SIZE

cv2 = needs_module("cv2", "python3-opencv")
SQUARE, COLUMNS, ROWS = 0.08, 10, 8  # [m], and squares
SCALE = 3  # of the lenses' images


# --- Projections of the other types, written apart from the library ---------------------------------

def kannala_brandt(p, radial=(-0.02, 0.004, -0.001, 0.0002)):
    side = np.linalg.norm(p[:, :2], axis=1, keepdims=True)
    t = np.arctan2(side, p[:, 2:])
    return 85.0 * t * (1 + sum(k * t ** (2 * i + 2) for i, k in enumerate(radial))) * p[:, :2] / side + CENTER


def eucm(p, alpha=0.6, beta=1.1):
    d = np.sqrt(beta * (p[:, :2] ** 2).sum(axis=1, keepdims=True) + p[:, 2:] ** 2)
    return 120.0 * p[:, :2] / (alpha * d + (1 - alpha) * p[:, 2:]) + CENTER


MATRIX = np.array(((11.0, 0.3), (-0.2, 11.2)))  # [pixels/mm]


def owen(p):
    x, y = (12.0 * p[:, :2] / p[:, 2:]).T
    r = np.hypot(x, y)
    swell = -2e-4 * r ** 2 + 1e-7 * r ** 4 + 3e-4 * y - 2e-4 * x
    turn = 4e-4 * r + 1e-6 * r ** 3
    return np.column_stack((x + swell * x - turn * y, y + swell * y + turn * x)) @ MATRIX.T + CENTER


def usgs(p):
    """By search: the place in the focal plane whose straightened radius is that of the direction."""
    n = 12.0 * p[:, :2] / p[:, 2:]
    straight = np.linalg.norm(n, axis=1)
    low, high = np.zeros(len(p)), 2 * straight
    for _ in range(100):
        r = 0.5 * (low + high)
        beyond = r * (1 - 0.01 - 2e-4 * r ** 2 - 1e-7 * r ** 4) > straight
        low, high = np.where(beyond, low, r), np.where(beyond, r, high)
    return (n * (r / straight)[:, None]) @ MATRIX.T + CENTER


H, V, O = np.array((140.0, 0.0, 150.0)), np.array((-1.0, 141.0, 125.0)), np.array((0.02, -0.01, 1.0)) / np.sqrt(1.0005)


def cahv(p):
    return np.column_stack((p @ H, p @ V)) / p[:, 2:]


def cahvor(p):
    along = p @ O
    across = p - along[:, None] * O
    tau = (across ** 2).sum(axis=1) / along ** 2
    return cahv(p + (1e-3 - 0.05 * tau + 0.01 * tau ** 2)[:, None] * across)


RATIONAL = (-0.2, 0.06, 1e-3, -5e-4, 0.01, 0.02, 0.01, 1e-3, 2e-3, -1e-3, 1e-3, 5e-4, 0.01, -0.02)  # in OpenCV's order


def rational(p):
    matrix = np.array(((150.0, 0, CENTER[0]), (0, 150.0, CENTER[1]), (0, 0, 1)))
    return cv2.projectPoints(p, np.zeros(3), np.zeros(3), matrix, np.array(RATIONAL))[0].reshape(-1, 2)


AXES = dict(size=SIZE, C=(0, 0, 0), A=(0, 0, 1), H=H, V=V)
PLATE = dict(size=SIZE, focal_length=12.0, matrix=tuple(MATRIX.ravel()), center=CENTER)
BOARDS = {
    **LENSES,
    "rational brown, tilted": (dspace.CameraModel("brown", size=SIZE, focal=(150, 150), center=CENTER,
                                                  radial=RATIONAL[:2] + RATIONAL[4:8], tangential=RATIONAL[2:4],
                                                  prism=RATIONAL[8:12], tilt_deg=tuple(np.degrees(RATIONAL[12:]))), rational),
    "kannala_brandt": (dspace.CameraModel("kannala_brandt", size=SIZE, focal=(85, 85), center=CENTER,
                                          radial=(-0.02, 0.004, -0.001, 0.0002)), kannala_brandt),
    "ucm": (dspace.CameraModel("ucm", size=SIZE, focal=(120, 120), center=CENTER, alpha=0.6), lambda p: eucm(p, beta=1.0)),
    "eucm": (dspace.CameraModel("eucm", size=SIZE, focal=(120, 120), center=CENTER, alpha=0.6, beta=1.1), eucm),
    "owen": (dspace.CameraModel("owen", **PLATE, radial=(-2e-4, 1e-7), tangential=(3e-4, -2e-4), pinwheel=(4e-4, 1e-6)), owen),
    "usgs": (dspace.CameraModel("usgs", **PLATE, radial=(0.01, 2e-4, 1e-7)), usgs),
    "cahv": (dspace.CameraModel("cahv", **AXES), cahv),
    "cahvor": (dspace.CameraModel("cahvor", **AXES, O=O, R=(1e-3, -0.05, 0.01)), cahvor),
    "orthographic": (dspace.CameraModel("orthographic", size=SIZE, scale=(330, 330), center=CENTER),
                     lambda p: 330.0 * p[:, :2] + CENTER),
}


def add_board(scene, pose):
    """Black and white squares on a frame, whose X and Y axes they lie along."""
    frame = scene.add_frame("board", pose=pose)
    k, l = np.meshgrid(np.arange(COLUMNS), np.arange(ROWS))
    corner = SQUARE * np.stack((k.ravel() - COLUMNS / 2, l.ravel() - ROWS / 2, np.zeros(k.size)), axis=-1)
    points = (corner[:, None] + SQUARE * np.array(((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)))).reshape(-1, 3)
    first = 4 * np.arange(k.size)
    triangles = np.concatenate([np.column_stack((first + a, first + b, first + c)) for a, b, c in ((0, 2, 1), (0, 3, 2))])
    shade = np.where((k + l).ravel() % 2, 0.95, 0.02)
    scene.add_mesh(points, triangles, colors=np.repeat(np.tile(shade, 2)[:, None], 3, axis=1), frame=frame, lit=False)
    k, l = np.meshgrid(np.arange(1, COLUMNS), np.arange(1, ROWS))  # corners with squares all around
    inner = SQUARE * np.stack((k.ravel() - COLUMNS / 2, l.ravel() - ROWS / 2, np.zeros(k.size)), axis=-1)
    return pose.position + inner @ pose.rotation.T


@pytest.mark.parametrize("name", BOARDS)
def test_corners_lie_where_the_formula_puts_them(session, name):
    scene = session.scene()
    camera = scene.add_camera("eye")
    camera.attach(scene.root)
    model, formula = BOARDS[name]
    # Turned, so that no edge runs along rows of pixels: there interpolation shifts a whole edge by up to a tenth of a pixel.
    corners = add_board(scene, dspace.Pose.from_rpy_deg(12, -9, 35, position=(0.02, -0.01, 0.55)))
    np.testing.assert_allclose(model.project(corners), formula(corners), atol=1e-6)
    size = tuple(SCALE * each for each in SIZE)
    expected = SCALE * (formula(corners) + 0.5) - 0.5
    near = ((expected > 8 * SCALE) & (expected < np.array(size) - 9 * SCALE)).all(axis=1)
    assert near.sum() > 40
    light = camera.capture(model.scaled(size), radiance=True, color=False, samples=4)["radiance"][..., 1]
    grey = cv2.GaussianBlur((255 * light / light.max()).astype(np.float32), (0, 0), 1.0)
    # OpenCV looks for a corner's place near a guess, which is up to 1.5 pixels off in each axis.
    guess = expected[near] + np.random.default_rng(1).uniform(-1.5, 1.5, (near.sum(), 2))
    found = cv2.cornerSubPix(np.clip(grey, 0, 255).astype(np.uint8), guess.astype(np.float32).reshape(-1, 1, 2), (7, 7), (-1, -1),
                             (cv2.TERM_CRITERIA_EPS + cv2.TERM_CRITERIA_MAX_ITER, 200, 1e-5)).reshape(-1, 2)
    error = found - expected[near]
    assert np.linalg.norm(error, axis=1).max() < 0.1 and np.abs(error.mean(axis=0)).max() < 0.01
