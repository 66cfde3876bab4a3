"""The view through a lens in a viewport: against simulated images, and projections that the test computes itself."""
import numpy as np
import pytest

import dspace
from needs import needs_module
from test_simulated_images import CENTER, FOCAL, LENSES, SIZE, add_targets
from test_target_board import SCALE, add_board

cv2 = needs_module("cv2", "python3-opencv")


@pytest.fixture
def place(session):
    """A scene with a Sun, a camera and a viewport of the lenses' size, without fill light."""
    return make(session)


def make(session):
    scene = session.scene()
    scene.lights["sun"].set(direction=(0.3, 0.5, 1.0))
    camera = scene.add_camera("eye")
    camera.attach(scene.root)
    view = scene.add_viewport(size=SIZE, camera=camera, samples=2)
    view.fill, view.shadows = 0.0, True
    return scene, camera, view


def furnish(scene, model):
    """Lit things, edges and shadows among them."""
    centers, spheres = add_targets(scene, model, 0.05)
    scene.add_plane(50, 50, position=(0, 0, 6), color=(0.6, 0.5, 0.4))
    scene.add_box((0.4, 0.4, 0.4), position=(0.8, 0.5, 2.0), color="red")
    return centers, spheres


@pytest.mark.parametrize("name", LENSES)
def test_the_picture_is_that_of_simulate_image(place, name):
    scene, camera, view = place
    model, _ = LENSES[name]
    furnish(scene, model)
    view.lens = model
    shown = view.image().astype(int)
    expected = scene.simulate_image(model, camera)["color"][..., :3].astype(int)
    assert expected.std() > 20
    difference = np.abs(shown - expected).max(axis=-1)
    # Sources of 8 bits are averaged, and those of radiance come in blocks with shadow maps of their own: at edges 1 pixel in 2000
    # may be off by more than a step.
    assert (difference > 1).mean() < 5e-4 and difference.max() < 16
    assert difference.mean() < 0.2


@pytest.mark.parametrize("name", LENSES)
def test_corners_lie_where_the_formula_puts_them(place, name):
    scene, _, view = place
    model, formula = LENSES[name]
    corners = add_board(scene, dspace.Pose.from_rpy_deg(12, -9, 35, position=(0.02, -0.01, 0.55)))
    size = tuple(SCALE * each for each in SIZE)
    view.size = size
    view.samples = 4
    view.lens = model  # of another size: scaled
    expected = SCALE * (formula(corners) + 0.5) - 0.5
    near = ((expected > 8 * SCALE) & (expected < np.array(size) - 9 * SCALE)).all(axis=1)
    assert near.sum() > 50
    shown = view.image()[..., 1] / 255.0
    light = np.where(shown <= 0.04045, shown / 12.92, ((shown + 0.055) / 1.055) ** 2.4)  # IEC 61966-2-1
    grey = cv2.GaussianBlur((255 * light).astype(np.float32), (0, 0), 1.0)
    guess = expected[near] + np.random.default_rng(1).uniform(-1.5, 1.5, (near.sum(), 2))
    found = cv2.cornerSubPix(np.clip(grey, 0, 255).astype(np.uint8), guess.astype(np.float32).reshape(-1, 1, 2), (7, 7), (-1, -1),
                             (cv2.TERM_CRITERIA_EPS + cv2.TERM_CRITERIA_MAX_ITER, 200, 1e-5)).reshape(-1, 2)
    error = found - expected[near]
    assert np.linalg.norm(error, axis=1).max() < 0.1 and np.abs(error.mean(axis=0)).max() < 0.01


@pytest.mark.parametrize("name", ["brown", "equidistant"])
def test_picks_are_of_the_pixels_own_ray(place, name):
    scene, _, view = place
    model, formula = LENSES[name]
    centers, spheres = add_targets(scene, model, 0.05)
    view.lens = model
    for sphere, center, at in zip(spheres, centers, np.round(formula(centers))):
        pick = view.pick(*at)
        assert pick.object.id == sphere.id
        _, direction = (each[0] for each in model.rays(at[None]))
        radius = 0.05 * np.linalg.norm(center)
        b = center @ direction
        near = b - np.sqrt(radius ** 2 - center @ center + b * b)  # the ray's own intersection, to the mesh's facets
        np.testing.assert_allclose(pick.in_root, near * direction, atol=0.15 * radius)
        np.testing.assert_allclose(pick.in_camera, pick.in_root, atol=1e-9)
        assert pick.depth == pytest.approx(pick.in_root[2], abs=1e-9)
    assert view.pick(2, 2) is None and view.pick(*np.round(formula(centers[:1]))[0] + (-14, 0), radius=12).object.id == spheres[0].id


def test_it_follows_the_camera_and_the_scene(place):
    scene, camera, view = place
    ball = scene.add_frame("ball", position=(0, 0, 3))
    scene.add_sphere(0.2, frame=ball, lit=False, color="white")
    view.lens = LENSES["equidistant"][0]
    assert view.image()[120, 160].min() == 255
    ball.position = (1, 0, 3)  # 80 atan(1 / 3) = 25.7 pixels to the right
    shown = view.image()
    assert shown[120, 160].max() == 0 and shown[120, 185].min() == 255
    camera.pose = dspace.Pose((1, 0, 0))
    assert view.image()[120, 160].min() == 255


def test_another_shape_of_viewport_holds_the_whole_image(place):
    scene, _, view = place
    scene.add_box((8, 8, 8), lit=False, color="white")
    view.lens = LENSES["equidistant"][0]
    view.size = (640, 240)  # the image in its middle
    bright = view.image()[..., 0] == 255
    assert bright[:, 160:480].all() and not bright[:, :160].any() and not bright[:, 480:].any()
    view.size = (160, 240)
    bright = view.image()[..., 0] == 255
    assert bright[60:180].all() and not bright[:60].any() and not bright[180:].any()


def test_pixels_beyond_a_fold_are_black(place):
    scene, camera, view = place
    scene.add_box((8, 8, 8), lit=False, color="white")
    model = dspace.CameraModel("brown", size=SIZE, focal=(100, 100), center=CENTER, radial=(-0.3,))
    view.lens = model
    u, v = np.meshgrid(np.arange(SIZE[0]), np.arange(SIZE[1]))
    radius = 100 / np.sqrt(0.9) * (1 - 0.3 / 0.9)  # r (1 - 0.3 r²) turns at r² = 1 / 0.9
    inside = np.hypot(u - CENTER[0], v - CENTER[1]) < radius
    np.testing.assert_array_equal(view.image()[..., 0] == 255, inside)
    assert not view.image()[~inside].any()
    assert view.pick(0, 0) is None


def test_no_lens_is_as_before(place):
    scene, camera, view = place
    model, _ = LENSES["brown"]
    furnish(scene, model)
    before = view.image()
    assert view.lens is None
    view.lens = model
    assert view.lens.json == model.json
    assert (view.image() != before).any()
    view.lens = None
    assert view.lens is None
    np.testing.assert_array_equal(view.image(), before)
    assert np.isfinite(view.capture(depth=True)["depth"]).all()


def test_automatic_exposure_has_no_seams(place):
    scene, _, view = place
    scene.add_box((8, 8, 8), color=(0.2, 0.2, 0.2), lit=False)
    scene.add_sphere(0.5, position=(0, 0, 3.0), color=(0.02, 0.02, 0.02))
    view.automatic_exposure = True
    view.lens = LENSES["equidistant"][0]
    edge = view.image()[:, 240:].astype(int)  # sources meet at 80 pi / 4 = 63 pixels from the middle
    assert np.ptp(edge[..., 0]) <= 1 and edge.min() > 0


def test_a_server_and_a_playback_show_the_same(session, tmp_path):
    from served_support import Served
    model, _ = LENSES["double_sphere"]

    def draw(scene, view):
        furnish(scene, model)
        view.lens = model
        return view.image()
    scene, _, view = make(session)
    with session.record(tmp_path / "run.dspace"):
        expected = draw(scene, view)
        scene.time = 1.0
    with session.record(tmp_path / "later.dspace"):  # the lens is in its first snapshot
        scene.time = 2.0
    for name in ("run", "later"):
        with dspace.Playback(tmp_path / f"{name}.dspace") as playback:
            playback.seek(playback.times[-1])
            found = playback.session.viewports[view.name]
            assert found.lens.json == model.json
            np.testing.assert_array_equal(found.image(), expected)
    with Served(tmp_path) as served, dspace.connect(served.address) as remote:
        scene, _, view = make(remote)
        np.testing.assert_array_equal(draw(scene, view), expected)


def test_bad_lenses_are_rejected_and_change_nothing(place):
    scene, _, view = place
    model, _ = LENSES["pinhole"]
    view.lens = model
    lines = dspace.CameraModel("line_scan", size=(8, 2), focal_length=1.0, matrix=(100, 0, 0, 100), center=(3.5, 0), row=0.0,
                               line=(0, 1), positions=(0, 0, 0, 0, 1, 0), rotations=(1, 0, 0, 0, 1, 0, 0, 0))
    sizeless = dspace.CameraModel("pinhole", focal=FOCAL, center=CENTER)
    beyond = dspace.CameraModel("brown", size=(8, 8), focal=(100, 100), center=(1000, 1000), radial=(-0.3,))
    for lens, kind, message in ((lines, dspace.Unsupported, "its row of pixels moves"),
                                (sizeless, dspace.InvalidArgument, "for which size of image"),
                                (beyond, dspace.InvalidArgument, "no pixel of its image has a ray"),
                                ("brown", dspace.WrongType, "a dspace.CameraModel, or None")):
        with pytest.raises(kind, match=message):
            view.lens = lens
        assert view.lens.json == model.json
    for wanted in ("depth", "label", "range", "radiance", "phase"):
        with pytest.raises(dspace.Unsupported, match="through a lens is rejected; accepted: its colour, a pick"):
            view.capture(color=False, **{wanted: True})
    with pytest.raises(dspace.Unsupported, match="an explanation of a view through a lens"):
        view.explain()
    with pytest.raises(dspace.InvalidArgument, match="samples"):
        view.samples = 9
    assert view.image().shape == (SIZE[1], SIZE[0], 3)
