"""Curiosity's right Navcam: known points of a scene lie in the picture where the model of a real image's label projects them."""
import os
import pathlib
import re

import numpy as np
import pytest

import dspace

LABEL = pathlib.Path(os.environ.get("DSPACE_DATA") or "/nonexistent") / "cameras" / "msl_navcam_right_NRB_701383954RAS_cahvor.IMG"
RADIUS = 0.003  # of the targets [rad]: the middle of a sphere's image is off its centre's by f tan(t) R^2 / cos^2(t), 0.01 pixels


@pytest.fixture(scope="module")
def vectors():
    """C, A, H, V, O, R of the label, read here: in the rover's navigation frame."""
    if not LABEL.exists():
        pytest.skip(f"real data absent: set DSPACE_DATA to the folder that has cameras/{LABEL.name}")
    text = LABEL.read_bytes()[:60000].decode("latin-1")
    group = text[text.index("GROUP                             = GEOMETRIC_CAMERA_MODEL"):]
    found = re.findall(r"MODEL_COMPONENT_(\d)\s*=\s*\(([^)]*)\)", group[:group.index("END_GROUP")])
    assert [int(number) for number, _ in found] == [1, 2, 3, 4, 5, 6]
    return [np.array([float(each) for each in values.split(",")]) for _, values in found]


def project(points, C, A, H, V, O, R):  # noqa: E741
    """CAHVOR (Yakimovsky and Cunningham 1978; Di and Li 2004, equations 5 to 8): column and row."""
    d = points - C
    along = d @ O
    aside = d - along[:, None] * O
    tau = (aside ** 2).sum(axis=1) / along ** 2
    moved = d + (R[0] + R[1] * tau + R[2] * tau ** 2)[:, None] * aside
    return np.stack((moved @ H / (moved @ A), moved @ V / (moved @ A)), axis=-1)


def test_known_points_lie_where_the_label_projects_them(scene, vectors):
    C, A, H, V, _, _ = vectors
    right, down = (each - (each @ A) * A for each in (H, V))
    right, down = right / np.linalg.norm(right), down / np.linalg.norm(down)
    a, b = (each.ravel() for each in np.meshgrid(np.linspace(-0.36, 0.36, 5), np.linspace(-0.36, 0.36, 5)))
    distances = 4.0 + 2.0 * np.arange(25) % 17
    points = C + distances[:, None] * (A + a[:, None] * right + b[:, None] * down)
    expected = project(points, *vectors)
    assert expected.min() > 30 and expected.max() < 994
    # The rover stands somewhere and is turned.
    rover = scene.add_frame("rover", pose=dspace.Pose(position=(120.0, -40.0, 3.0), quaternion=(0.8, 0.36, -0.48, 0.0)))
    spheres = [scene.add_sphere(RADIUS * np.linalg.norm(point - C), frame=rover, position=point, color="white", lit=False)
               for point in points]
    model = dspace.CameraModel.read(LABEL)
    assert model.size == (1024, 1024)
    planes = scene.simulate_image(model, frame=rover, color=False, radiance=True, label=True, samples=3)
    light = planes["radiance"][..., 1]
    for sphere, at in zip(spheres, expected):
        x, y = (int(round(each)) for each in at)
        assert planes["label"][y, x] == sphere.id
        v, u = np.mgrid[y - 9:y + 10, x - 9:x + 10]
        part = light[y - 9:y + 10, x - 9:x + 10]
        middle = np.array(((u * part).sum(), (v * part).sum())) / part.sum()
        assert np.abs(middle - at).max() < 0.1
