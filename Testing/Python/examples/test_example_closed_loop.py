"""The closed loop: by its own stereo images a rover passes rocks that its straight way would touch."""
import pathlib
import subprocess
import sys

import numpy as np
import pytest

EXAMPLE = pathlib.Path(__file__).resolve().parents[3] / "Examples" / "closed_loop"
sys.path.insert(0, str(EXAMPLE))

from closed_loop import Drive  # noqa: E402  (of the example)
from contact import Body, touches  # noqa: E402
from hazard_map import HazardMap  # noqa: E402
from steering import costs, next_move, way  # noqa: E402
from stones import make  # noqa: E402


def test_the_rover_reaches_its_goal_without_contact(session):
    drive = Drive(session, size=(256, 192), length=11.0, rocks=5, seed=3, real=False)
    assert drive.blind(), "the straight way is free: the test shows nothing"
    errors = []

    def shown(drive, pictures, disparity):
        if drive.looks % 5 == 1:
            depth = drive.scene.simulate_image(drive.pair.rectified.left, frame=drive.rover.links["mast_camera_left"], color=False,
                                               depth=True, samples=1)["depth"]
            valid = np.isfinite(disparity) & np.isfinite(depth)
            assert valid.mean() > 0.3
            errors.append((np.abs(disparity - drive.pair.disparity(depth))[valid] < 1).mean())

    assert drive.run(most=80, shown=shown), f"at {drive.place} after {drive.looks} looks"
    assert drive.contacts == []
    assert len(errors) >= 3 and min(errors) > 0.9  # within a pixel of the range plane
    # Its steps are those of a rover: no jump, and the scene's rover is where it says.
    track = np.array(drive.track)
    assert np.linalg.norm(np.diff(track, axis=0), axis=1).max() < 0.06
    np.testing.assert_allclose(drive.rover.frame.world_pose.position[:2], track[-1], atol=0.1)


def test_contacts_are_judged_by_triangles():
    body = Body(low=(-1, -0.5, 0), high=(1, 0.5, 1))
    stone = make(3.0, 0.0, 0.0, 0.5, np.random.default_rng(1))
    reach = stone.points[:, 0].min() - 1.0  # the stone's westernmost point, in the box's height range or not
    west = stone.points[np.argmin(stone.points[:, 0])]
    assert 0 < west[2] < 1
    eye = np.eye(3)
    assert body.touched(np.array((reach + 1e-6, west[1], 0)), eye, [stone]) == [stone]
    assert body.touched(np.array((reach - 1e-6, west[1], 0)), eye, [stone]) == []
    # A triangle that crosses the box with no corner in it, and one that passes its edge.
    across = np.array([[(-5, 0, 0.5), (5, 0, 0.5), (0, 0, 9)], [(-5, 6.01, 0.5), (6.01, -5, 0.5), (9, 9, 0.5)]], float)
    for middle, expected in (((0, 0, 0), [True, False]), ((0.004, 0.004, 0), [True, False]), ((0.006, 0.006, 0), [True, True])):
        assert touches(across, middle, eye, (0.5, 0.5, 1)).tolist() == expected
    # Against points: a box turned about Z, and random triangles with a corner in it.
    angle = np.radians(30)
    turn = np.array(((np.cos(angle), -np.sin(angle), 0), (np.sin(angle), np.cos(angle), 0), (0, 0, 1)))
    rng = np.random.default_rng(2)
    corners = rng.uniform(-3, 3, (500, 3, 3))
    weights = rng.dirichlet((1, 1, 1), (500, 400))
    inside = (np.abs(np.einsum("nkc,ncd->nkd", weights, corners) @ turn) < (0.8, 0.5, 0.6)).all(axis=-1).any(axis=-1)
    found = touches(corners, np.zeros(3), turn, (0.8, 0.5, 0.6))
    assert inside.any() and not inside.all() and found[inside].all()
    assert found.sum() < 1.3 * inside.sum()


def test_a_step_is_a_hazard_and_a_slope_is_none():
    x, y = np.meshgrid(np.arange(0, 6, 0.02), np.arange(-3, 3, 0.02))
    z = 0.3 * x + np.where(np.hypot(x - 3, y) < 0.4, 0.4, 0.0)  # 17 degrees, and a block
    hazards = HazardMap((0, -3), (6, 3))
    hazards.add(np.stack((x, y, z), axis=-1), (0, 0, 1.5))
    hazardous = hazards.evidence > 0
    radius = np.linalg.norm(hazards.middles() - (3, 0), axis=-1)
    assert hazardous[np.abs(radius - 0.4) < 0.1].all()
    assert not hazardous[radius > 0.4 + 0.35].any()
    free = hazards.clearance()
    assert free[hazards.shape[0] // 2, 0] == pytest.approx(3 - 0.4 - 0.15, abs=0.25)


def test_the_way_leads_around_a_wall():
    hazards = HazardMap((0, 0), (10, 10), cell=0.25)
    hazards.seen[:] = True
    middles = hazards.middles()
    hazards.evidence[(np.abs(middles[..., 0] - 5) < 0.3) & (middles[..., 1] < 7)] = 1.0
    points = way(hazards, costs(hazards, radius=1.0), (1, 2), (9, 2))
    assert np.linalg.norm(points[-1] - (9, 2)) < 1e-9
    over = points[np.abs(points[:, 0] - 5) < 0.3, 1]
    assert len(over) and over.min() > 7.9
    kind, angle = next_move(points, np.array((1.0, 2.0)), np.radians(-90))
    assert kind == "turn" and angle == pytest.approx(np.radians(30))
    kind, curvature = next_move(np.array(((0, 0), (4, 0.0))), np.zeros(2), 0.1)
    assert kind == "drive" and curvature == pytest.approx(2 * np.sin(-0.1) / 4)


def test_the_script_runs_by_itself(tmp_path):
    done = subprocess.run([sys.executable, "-W", "ignore", EXAMPLE / "closed_loop.py", "--shipped", "--length", "5", "--rocks", "0",
                           "--out", tmp_path], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr + done.stdout
    assert "reached the goal on the shipped field" in done.stdout and "0 contacts" in done.stdout
    assert (tmp_path / "closed_loop.png").stat().st_size > 50000 and (tmp_path / "anaglyph.png").is_file()
