"""A target board through lenses: its corners in the picture, found by OpenCV, lie where formulas written apart put them."""
import numpy as np
import pytest

import dspace
from needs import needs_module
from test_simulated_images import LENSES, SIZE

cv2 = needs_module("cv2", "python3-opencv")
SQUARE, COLUMNS, ROWS = 0.08, 10, 8  # [m], and squares
SCALE = 3  # of the lenses' images


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


@pytest.mark.parametrize("name", LENSES)
def test_corners_lie_where_the_formula_puts_them(session, name):
    scene = session.scene()
    camera = scene.add_camera("eye")
    camera.attach(scene.root)
    model, formula = LENSES[name]
    # Turned, so that no edge runs along rows of pixels: there interpolation shifts a whole edge by up to a tenth of a pixel.
    corners = add_board(scene, dspace.Pose.from_rpy_deg(12, -9, 35, position=(0.02, -0.01, 0.55)))
    size = tuple(SCALE * each for each in SIZE)
    expected = SCALE * (formula(corners) + 0.5) - 0.5
    near = ((expected > 8 * SCALE) & (expected < np.array(size) - 9 * SCALE)).all(axis=1)
    assert near.sum() > 50
    light = camera.capture(model.scaled(size), radiance=True, color=False, samples=4)["radiance"][..., 1]
    grey = cv2.GaussianBlur((255 * light / light.max()).astype(np.float32), (0, 0), 1.0)
    # OpenCV looks for a corner's place near a guess, which is up to 1.5 pixels off in each axis.
    guess = expected[near] + np.random.default_rng(1).uniform(-1.5, 1.5, (near.sum(), 2))
    found = cv2.cornerSubPix(np.clip(grey, 0, 255).astype(np.uint8), guess.astype(np.float32).reshape(-1, 1, 2), (7, 7), (-1, -1),
                             (cv2.TERM_CRITERIA_EPS + cv2.TERM_CRITERIA_MAX_ITER, 200, 1e-5)).reshape(-1, 2)
    error = found - expected[near]
    assert np.linalg.norm(error, axis=1).max() < 0.1 and np.abs(error.mean(axis=0)).max() < 0.01
