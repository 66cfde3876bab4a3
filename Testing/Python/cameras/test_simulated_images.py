"""Pictures through lenses against projections that the test computes itself."""
import os
import pathlib

import numpy as np
import pytest

import dspace

SIZE = (320, 240)
# Of the targets [rad], 1.3 pixels and more: the middle of a sphere's image is off its centre's by about f tan(t) R² / cos²(t)
# through a pinhole, 0.05 pixels here, and by less through a fish-eye.
RADIUS = {"pinhole": 0.009, "brown": 0.009, "equidistant": 0.02, "double_sphere": 0.016, "cahvore": 0.015,
          "orthographic": 0.014}
FOCAL, CENTER = np.array((150.0, 150.0)), np.array((159.5, 119.5))


# --- Projections, written apart from the library ---------------------------------------------------

def pinhole(p):
    return FOCAL * p[:, :2] / p[:, 2:] + CENTER


def brown(p):
    n = p[:, :2] / p[:, 2:]
    r2 = (n ** 2).sum(axis=1, keepdims=True)
    x, y = n[:, :1], n[:, 1:]
    d = n * (1 - 0.15 * r2 + 0.02 * r2 ** 2) + np.hstack((2e-3 * x * y - 1e-3 * (r2 + 2 * x * x),
                                                           1e-3 * (r2 + 2 * y * y) - 2e-3 * x * y))
    return FOCAL * d + CENTER


def equidistant(p, focal=80.0):
    side = np.linalg.norm(p[:, :2], axis=1, keepdims=True)
    return focal * np.arctan2(side, p[:, 2:]) * p[:, :2] / side + CENTER


def double_sphere(p, xi=-0.2, alpha=0.57):
    z = xi * np.linalg.norm(p, axis=1, keepdims=True) + p[:, 2:]
    d = np.sqrt((p[:, :2] ** 2).sum(axis=1, keepdims=True) + z ** 2)
    return 110.0 * p[:, :2] / (alpha * d + (1 - alpha) * z) + CENTER


def orthographic(p):
    return 110.0 * p[:, :2] + CENTER


E = (0.0, 0.0, 0.0)  # TestSourceViews tests a pupil that moves


def cahvore(p):
    """By search along the axis: the pupil's place from which the point is seen under the angle that belongs to it."""
    out = []
    for x, y, z in p:
        side = np.hypot(x, y)
        low, high = 1e-9, 3.0
        for _ in range(100):
            t = 0.5 * (low + high)
            shift = (t / np.sin(t) - 1) * (E[0] + E[1] * t * t)
            # Beyond the true angle the ray from there passes above the point.
            low, high = (t, high) if np.arctan2(side, z - shift) > t else (low, t)
        out.append(110.0 * t * (1 - 0.02 * t * t) * np.array((x, y)) / side + CENTER)
    return np.array(out)


LENSES = {
    "pinhole": (dspace.CameraModel("pinhole", size=SIZE, focal=FOCAL, center=CENTER), pinhole),
    "brown": (dspace.CameraModel("brown", size=SIZE, focal=FOCAL, center=CENTER, radial=(-0.15, 0.02),
                                 tangential=(1e-3, -1e-3)), brown),
    "equidistant": (dspace.CameraModel("equidistant", size=SIZE, focal=(80, 80), center=CENTER), equidistant),
    "double_sphere": (dspace.CameraModel("double_sphere", size=SIZE, focal=(110, 110), center=CENTER, xi=-0.2, alpha=0.57),
                      double_sphere),
    "cahvore": (dspace.CameraModel("cahvore", size=SIZE, C=(0, 0, 0), A=(0, 0, 1), H=(110, 0, CENTER[0]),
                                   V=(0, 110, CENTER[1]), O=(0, 0, 1), R=(0, -0.02, 0), E=E, linearity=0), cahvore),
    "orthographic": (dspace.CameraModel("orthographic", size=SIZE, scale=(110, 110), center=CENTER), orthographic),
}


def add_targets(scene, model, radius=0.01):
    """Small white spheres over the image, 1 to 3 m away, and their centres in the camera's axes."""
    u, v = np.meshgrid(np.linspace(24, SIZE[0] - 25, 6), np.linspace(20, SIZE[1] - 21, 5))
    origins, directions = model.rays(np.column_stack((u.ravel(), v.ravel())))
    distances = np.linspace(1.0, 3.0, len(directions))[:, None]
    centers = origins + distances * directions
    spheres = [scene.add_sphere(radius * d, position=p, color="white", lit=False) for d, p in zip(distances[:, 0], centers)]
    return centers, spheres


@pytest.fixture
def camera(session):
    scene = session.scene()
    camera = scene.add_camera("eye")
    camera.attach(scene.root)
    return camera


def centroid(picture, at, reach=7):
    x, y = (int(round(each)) for each in at)
    rows = slice(max(y - reach, 0), y + reach + 1)
    columns = slice(max(x - reach, 0), x + reach + 1)
    part = picture[rows, columns]
    v, u = np.mgrid[rows, columns][:, :part.shape[0], :part.shape[1]]
    return np.array(((u * part).sum(), (v * part).sum())) / part.sum()


@pytest.mark.parametrize("name", LENSES)
def test_points_lie_where_the_formula_puts_them(session, camera, name):
    scene = session.scene()
    model, formula = LENSES[name]
    centers, spheres = add_targets(scene, model, RADIUS[name])
    expected = formula(centers)
    np.testing.assert_allclose(model.project(centers), expected, atol=1e-6)
    np.testing.assert_allclose(scene.project_points(centers, model, camera), expected, atol=1e-6)
    planes = scene.simulate_image(model, camera, radiance=True, range=True, depth=True, label=True, samples=4)
    light = planes["radiance"][..., 1]
    found = np.array([centroid(light, at) for at in expected])
    assert np.abs(found - expected).max() < 0.1
    ids = {sphere.id for sphere in spheres}
    assert set(np.unique(planes["label"])) == ids | {0}  # never blended
    for sphere, center, (x, y) in zip(spheres, centers, np.round(expected).astype(int)):
        assert planes["label"][y, x] == sphere.id
        origin, direction = (each[0] for each in model.rays(np.array([(x, y)], float)))
        # The ray's own intersection with the sphere, to the facets of its mesh and a pixel of the source.
        b = (center - origin) @ direction
        radius = RADIUS[name] * np.linalg.norm(center - model.rays(np.array([(x, y)], float))[0][0])
        near = b - np.sqrt(max(radius ** 2 - (center - origin) @ (center - origin) + b * b, 0))
        assert planes["range"][y, x] == pytest.approx(near, abs=0.4 * radius)
        assert planes["depth"][y, x] == pytest.approx(near * direction[2] + origin[2], abs=0.4 * radius)
    lens = planes["lens"]
    assert lens.without_ray == 0 and lens.source_views >= 1
    assert lens.pupil_shift == 0 and lens.pupil_beyond == 0


@pytest.mark.parametrize("name", ["brown", "equidistant", "cahvore", "orthographic"])
def test_tiles_make_the_same_bytes(session, camera, name):
    scene = session.scene()
    model, _ = LENSES[name]
    add_targets(scene, model)
    scene.add_plane(50, 50, position=(0, 0, 6), color="gray")
    wanted = dict(radiance=True, range=True, label=True, incidence=True, lit_fraction=True)
    whole = scene.simulate_image(model, camera, **wanted)
    done = []
    tiled = scene.simulate_image(model, camera, tile=100, progress=done.append, **wanted)
    for plane in whole:
        if plane != "lens":
            np.testing.assert_array_equal(whole[plane], tiled[plane])
    assert done == sorted(done) and done[-1] == 1.0 and len(done) == 12


def test_ranges_are_those_of_the_rays(session, camera):
    scene = session.scene()
    model, _ = LENSES["equidistant"]
    scene.add_box((8, 8, 8))  # around the camera: a wall in every direction
    planes = scene.simulate_image(model, camera, range=True, depth=True, emission=True)
    u, v = np.meshgrid(np.arange(SIZE[0]), np.arange(SIZE[1]))
    _, d = scene.pixel_rays(np.stack((u, v), axis=-1), model, camera)
    expected = 4.0 / np.abs(d).max(axis=-1)
    # Walls are parallel to the source views. At the room's edges the nearest source pixel may show the other wall.
    for found, exact in ((planes["range"], expected), (planes["depth"], expected * d[..., 2])):
        assert (np.abs(found - exact) < 2e-5 * expected).mean() > 0.99
        assert (np.abs(found - exact) < 5e-3 * expected).all()
    assert np.isfinite(planes["range"]).all()  # full field, into the corners
    assert np.degrees(np.arccos(d[..., 2].min())) > 130  # of 143 degrees to the corners


def test_pixels_beyond_a_fold_see_nothing(session, camera):
    scene = session.scene()
    scene.add_box((8, 8, 8), lit=False, color="white")
    model = dspace.CameraModel("brown", size=SIZE, focal=(100, 100), center=CENTER, radial=(-0.3,))
    planes = scene.simulate_image(model, camera, radiance=True, label=True, range=True)
    u, v = np.meshgrid(np.arange(SIZE[0]), np.arange(SIZE[1]))
    radius = 100 / np.sqrt(0.9) * (1 - 0.3 / 0.9)  # r (1 - 0.3 r²) turns at r² = 1 / 0.9
    inside = np.hypot(u - CENTER[0], v - CENTER[1]) < radius
    np.testing.assert_array_equal(planes["label"] != 0, inside)
    np.testing.assert_array_equal(np.isfinite(planes["range"]), inside)
    assert (planes["radiance"][inside] > 1).all() and not planes["radiance"][~inside].any()
    assert planes["lens"].without_ray == (~inside).sum() and (planes["color"][~inside, :3] == 0).all()


def test_a_model_with_its_own_pose(session):
    scene = session.scene()
    rover = scene.add_frame("rover", position=(10, 20, 1), quaternion=(np.sqrt(0.5), 0, 0, np.sqrt(0.5)))
    mast = dspace.CameraModel("pinhole", size=SIZE, focal=FOCAL, center=CENTER, position=(0.5, 0, 1),
                              quaternion=(0.5, -0.5, 0.5, -0.5))  # looks along the rover's X
    ball = scene.add_sphere(0.05, frame=rover, position=(3.5, 0.2, 1.3), lit=False)
    expected = FOCAL * (-0.2 / 3, -0.3 / 3) + CENTER  # to the left, upwards
    np.testing.assert_allclose(scene.project_points((3.5, 0.2, 1.3), mast, frame=rover, points_in=rover), expected, atol=1e-9)
    in_root = np.array((10 - 0.2, 20 + 3.5, 1 + 1.3))  # turned by 90 degrees about Z
    np.testing.assert_allclose(scene.project_points(in_root, mast, frame=rover), expected, atol=1e-9)
    planes = scene.simulate_image(mast, frame=rover, label=True)
    v, u = np.nonzero(planes["label"] == ball.id)
    np.testing.assert_allclose((u.mean(), v.mean()), expected, atol=0.3)
    _, direction = scene.pixel_rays(expected, mast, frame=rover, rays_in=rover)
    np.testing.assert_allclose(direction, np.array((3, 0.2, 0.3)) / np.linalg.norm((3, 0.2, 0.3)), atol=1e-9)


def test_without_a_model_it_is_the_viewports_picture(session, camera):
    scene = session.scene()
    add_targets(scene, LENSES["pinhole"][0])
    camera.fov_deg = 2 * np.degrees(np.arctan(120 / 150))
    view = scene.add_viewport(size=SIZE, camera=camera)
    own = view.capture(color=False, label=True, radiance=True, physical_only=True)
    planes = camera.capture(size=SIZE, label=True, radiance=True)
    assert (own["label"] != planes["label"]).mean() < 0.02  # borders of spheres, by the source's finer grid
    assert np.abs(own["radiance"].mean() / planes["radiance"].mean() - 1) < 0.02


def test_a_server_draws_the_same(anywhere):
    scene = anywhere.scene()
    scene.add_camera("eye").attach(scene.root)
    model, _ = LENSES["pinhole"]
    centers, spheres = add_targets(scene, model)
    planes = scene.simulate_image(model, label=True, range=True)
    assert set(np.unique(planes["label"])) == {sphere.id for sphere in spheres} | {0}
    pixels = scene.project_points(centers, model)
    np.testing.assert_allclose(pixels, model.project(centers), atol=1e-9)
    pixels[:] = planes["color"][:] = 7  # arrays are the caller's own


@pytest.mark.parametrize("wrong, kind, message", [
    (dict(size=(640, 480)), dspace.InvalidArgument, "accepted: its own, 320 x 240"),
    (dict(size=(640, 640), scale=True), dspace.InvalidArgument, "same shape"),
    (dict(size=(0, 0)), dspace.InvalidArgument, r"the size is \(0, 0\); accepted: 1 to 1000000 pixels"),
    (dict(size=(-320, 240)), dspace.InvalidArgument, r"the size is \(-320, 240\)"),
    (dict(camera="none"), dspace.NotFound, "none"),
    (dict(color=False), dspace.InvalidArgument, "requests no plane"),
    (dict(samples=0), dspace.InvalidArgument, "samples"),
    (dict(exposure=0.0), dspace.InvalidArgument, "exposure is 0"),
    (dict(tile=8), dspace.InvalidArgument, "64 to 4096"),
    (dict(hide="nothing"), dspace.NotFound, "nothing"),
    (dict(tile=4097), dspace.InvalidArgument, "64 to 4096"),
    (dict(model=3), dspace.WrongType, "a dspace.CameraModel"),
    (dict(frame="none", camera=None), dspace.NotFound, "none"),
])
def test_rejected(session, camera, wrong, kind, message):
    given = {**dict(model=LENSES["pinhole"][0]), **wrong}
    with pytest.raises(kind, match=message):
        session.scene().simulate_image(**given)


def test_parallel_rays_see_what_an_orthographic_camera_sees(session, camera):
    scene = session.scene()
    scene.add_sphere(0.4, position=(0.2, -0.1, 3.0), color="orange")
    scene.add_box((0.5, 0.3, 0.4), position=(-0.5, 0.3, 2.0), color="gray")
    scene.add_plane(9, 9, position=(0, 0, 6), color="white")
    scene.sun.set(direction=(0.2, -0.3, -1))
    flat = dspace.CameraModel("orthographic", size=SIZE, scale=(100, 100), center=CENTER)
    np.testing.assert_allclose(scene.project_points((0.1, 0.2, 5), flat, camera), (CENTER[0] + 10, CENTER[1] + 20), atol=1e-12)
    wanted = dict(color=False, radiance=True, range=True, label=True, emission=True)
    planes = scene.simulate_image(flat, camera, samples=1, **wanted)
    ideal = scene.add_camera("ideal", height=2.4)
    ideal.attach(scene.root)
    view = scene.add_viewport(SIZE, "ideal", samples=1)
    view.set(shadows=True)
    for plane, array in view.capture(physical_only=True, **wanted).items():
        both = np.isfinite(array) & np.isfinite(planes[plane]) if plane != "label" else np.ones(array.shape, bool)
        assert both.mean() > 0.99
        np.testing.assert_allclose(planes[plane][both], array[both], rtol=2e-3, atol=1e-4)
    # Pixels half as many down lie between two rows of these.
    coarse = dspace.CameraModel("orthographic", size=(SIZE[0], SIZE[1] // 2), scale=(100, 50),
                                center=(CENTER[0], 0.5 * (CENTER[1] - 0.5)))
    label = scene.simulate_image(coarse, camera, label=True, samples=1)["label"]
    assert len(np.unique(label)) == 3
    for rows in (planes["label"][0::2], planes["label"][1::2]):
        assert 0.985 < (label == rows).mean()


def test_absent_sizes_are_rejected(session, camera):
    scene = session.scene()
    with pytest.raises(dspace.InvalidArgument, match="for which size"):
        scene.simulate_image(dspace.CameraModel("pinhole", focal=(1, 1), center=(0, 0)), camera)
    with pytest.raises(dspace.InvalidArgument, match="accepted: 1 to 1000000"):
        scene.simulate_image(camera=camera)


def test_a_camera_inside_the_ground_is_rejected(scene):
    field = pathlib.Path(os.environ.get("DSPACE_SHIPPED_DATA", pathlib.Path(__file__).parents[3] / "Data")) / "field" / "field.tif"
    scene.add_fragment("ground")
    ground = scene.add_terrain(field, name="field", mode="clipmap", fragment="ground")
    model = dspace.CameraModel("pinhole", size=(32, 24), focal=(30, 30), center=(15.5, 11.5))
    height = float(ground.height(3.0, 4.0))
    camera = scene.add_camera("camera", eye=(3, 4, height - 2), target=(30, 4, height - 2))
    with pytest.raises(dspace.InvalidArgument, match=r"is (2|1\.99\d*|2\.00\d*) m below the ground of terrain 'field'"):
        scene.simulate_image(model, camera)
    hidden = scene.simulate_image(model, camera, hide=("ground",), label=True)  # nothing is there then
    assert (hidden["label"] == 0).all()
    camera.look_at(eye=(3, 4, height), target=(30, 4, height))  # on it
    scene.simulate_image(model, camera)
