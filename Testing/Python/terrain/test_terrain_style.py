"""What a style lays over a clipmap, through Python: colours where arithmetic puts them, and refusals."""
import numpy as np
import pytest

import dspace
from terrain_support import FIELD, write_raster

RISE = 0.1  # metres a metre, to the east


@pytest.fixture
def slope(scene, tmp_path):
    """Ground that rises to the east by RISE, seen from straight above, 2 metres a pixel."""
    z = np.tile(np.arange(256.0) * 2 * RISE, (256, 1)).astype(np.float32)
    ground = scene.add_terrain(write_raster(tmp_path / "slope.tif", z, pixel=2.0), mode="clipmap",
                               color=(0.5, 0.5, 0.5), lit=False)
    scene.add_camera(eye=(0, 0, 500), target=(0, 0, 0), up=(0, 1, 0), height=200)
    view = scene.add_viewport(size=(100, 100), samples=1)
    x = 2 * (np.arange(100) + 0.5) - 100
    return ground, view, x


def test_a_ramp_shows_heights(slope):
    ground, view, x = slope
    heights = ground.height(x, 0 * x)
    low, high = heights[0] - 2, heights[-1] + 2
    ground.set_style(color_by="height", range=(low, high), colors=["black", "white"])
    row = view.image()[50, :, 0].astype(float)
    # Eight bits in the ramp, in its smaller images and in the picture.
    np.testing.assert_allclose(row, 255 * (heights - low) / (high - low), atol=3)
    ground.set_style(color_by="slope", range=(0, 20), colors=["black", "white"])
    expected = 255 * np.degrees(np.arctan(RISE)) / 20
    np.testing.assert_allclose(view.image()[..., 0], expected, atol=2)


def test_false_colour_has_the_colours_of_its_legend_whatever_the_light(scene, tmp_path):
    z = np.tile(np.arange(256.0) * 2 * RISE, (256, 1)).astype(np.float32)
    ground = scene.add_terrain(write_raster(tmp_path / "slope.tif", z, pixel=2.0), mode="clipmap", color="#808080")
    scene.add_camera(eye=(0, 0, 500), target=(0, 0, 0), height=200)
    view = scene.add_viewport(size=(100, 100), samples=1)
    x = 2 * (np.arange(100) + 0.5) - 100
    heights = ground.height(x, 0 * x)
    low, high = heights[0] - 2, heights[-1] + 2
    expected = 255 * (heights - low) / (high - low)
    look = dict(color_by="height", range=(low, high), colors=["black", "white"])
    for elevation in (80, 5):
        scene.sun.set(azimuth_deg=90, elevation_deg=elevation, terrain=ground)
        ground.set_style(**look)
        np.testing.assert_allclose(view.image()[50, :, 0], expected, atol=3)
        view.set(exposure=3.0)
        np.testing.assert_allclose(view.image()[50, :, 0], expected, atol=3)  # no light, no exposure
        view.set(exposure=1.0)
        ground.set_style(**look, contours={"interval": 4, "color": "red"})
        red = view.image()[50]
        assert red[red[:, 0] > red[:, 1] + 60].max() == 255  # lines over it keep their colour, too
    ground.set_style(**look, shaded=True)
    assert ground.style["shaded"] and (view.image()[50, 20:, 0] < 0.7 * expected[20:]).all()
    ground.change_style(shaded=False)
    np.testing.assert_allclose(view.image()[50, :, 0], expected, atol=3)
    # Half of it: the ground below is shaded, the ramp is not.
    ground.set_style(**{**look, "opacity": 0.5})
    half = view.image()[50, :, 0].astype(float)
    ground.set_style()
    ground_alone = view.image()[50, :, 0].astype(float)
    linear = lambda c: np.where(c / 255 <= 0.04045, c / 255 / 12.92, ((c / 255 + 0.055) / 1.055) ** 2.4)
    np.testing.assert_allclose(linear(half), 0.5 * linear(expected) + 0.5 * linear(ground_alone), atol=0.02)
    # Nor is it exposed: only the ground below is, which has one shade.
    scene.sun.set(azimuth_deg=90, elevation_deg=60, terrain=ground)
    for exposed in ({"exposure": 0.5, "tone": "filmic"}, {"exposure": 0.2, "automatic_exposure": True}):
        view.set(**exposed)
        ground.set_style(**{**look, "opacity": 0.5})
        below = linear(view.image()[50, :, 0].astype(float)) - 0.5 * linear(expected)
        assert np.ptp(below) < 0.02 and below.min() > 0.005
    view.set(exposure=0.5, automatic_exposure=False)
    below = linear(view.image()[50, :, 0].astype(float)) - 0.5 * linear(expected)
    ground.set_style()
    np.testing.assert_allclose(below, 0.5 * linear(view.image()[50, :, 0].astype(float)), atol=0.02)
    with pytest.raises(dspace.Error, match="shaded"):
        ground.set_style(**look, shaded=2)
    with pytest.raises(dspace.Error, match="shaded"):
        ground.change_style(color_by="height", shaded=2)


def test_contours_lie_at_their_heights(slope):
    ground, view, x = slope
    plain = view.image()
    ground.set_style(contours=dict(interval=4.0, width=2, color="red"))
    image = view.image()
    red = (image[..., 0] > 150) & (image[..., 1] < 100)
    from_line = np.abs(np.remainder(ground.height(x, 0 * x) + 2, 4.0) - 2) / RISE / 2  # pixels
    assert red[50, from_line < 0.4].all() and (from_line < 0.4).sum() >= 3
    assert not red[:, from_line > 2].any()
    ground.set_style()
    np.testing.assert_array_equal(view.image(), plain)


def test_noise_is_drawn_and_not_measured(scene, tmp_path):
    z = np.tile(np.arange(128.0) * 2 * RISE, (128, 1)).astype(np.float32)
    ground = scene.add_terrain(write_raster(tmp_path / "slope.tif", z, pixel=2.0), mode="clipmap",
                               subdivisions=4, color=(0.5, 0.5, 0.5))  # posts of 12.5 cm
    scene.add_camera(eye=(3.0, 1.0, 22.0), target=(3.0, 1.0, 0), up=(0, 1, 0), height=8)
    view = scene.add_viewport(size=(200, 200), samples=1)
    x, y = np.meshgrid(np.linspace(-20, 20, 41), np.linspace(-20, 20, 41))
    plain, depth, heights = view.image(), view.depth(), ground.height(x, y)
    noise = dict(wavelength=4.0, amplitude=0.2, octaves=3, gain=0.5, seed=7)
    ground.set_style(noise=noise)
    change = view.depth() - depth
    most = 0.2 * (1 + 0.5 + 0.25)
    # Seen from straight above a pixel's depth changes as its ground's height does.
    assert np.abs(change).max() <= most
    assert np.abs(change).max() > 0.1 * most and change.std() > 0.03 * most
    np.testing.assert_array_equal(ground.height(x, y), heights)
    assert (view.image() != plain).any(axis=-1).mean() > 0.5  # its normals follow
    ground.set_style(noise=dict(noise, seed=8))
    assert np.abs(view.depth() - depth - change).max() > 0.1 * most
    ground.set_style(noise=noise)
    np.testing.assert_array_equal(view.depth() - depth, change)
    ground.set_style(noise=None)
    np.testing.assert_array_equal(view.image(), plain)
    np.testing.assert_array_equal(view.depth(), depth)
    # Two pixels of the data a wavelength: posts that are no closer do not resolve it.
    coarse = scene.add_terrain(write_raster(tmp_path / "coarse.tif", z, pixel=2.0), mode="clipmap",
                               color=(0.5, 0.5, 0.5))
    ground.remove()
    depth = view.depth()
    coarse.set_style(noise=noise)
    np.testing.assert_array_equal(view.depth(), depth)


@pytest.mark.parametrize("style, told", [
    (dict(noise=0.1), "dict"),
    (dict(noise=dict(wavelength=1.0)), "amplitude"),
    (dict(noise=dict(wavelength=1.0, amplitude=0.1, lacunarity=2)), "lacunarity"),
    (dict(noise=dict(wavelength=0.0, amplitude=0.1)), "1e-3 to 1e7"),
    (dict(noise=dict(wavelength=1.0, amplitude=-0.1)), "amplitude"),
    (dict(noise=dict(wavelength=1.0, amplitude=0.1, octaves=17)), "1 to 16"),
    (dict(noise=dict(wavelength=1.0, amplitude=0.1, gain=0)), "gain"),
    (dict(noise=dict(wavelength=1.0, amplitude=0.1, seed=-1)), "seed"),
    (dict(color_by="depth"), "'height', 'slope'"),
    (dict(range=(0, 1)), "color_by"),
    (dict(color_by="height", range=(3, 3)), "differ"),
    (dict(color_by="height", colors=["nocolour"]), "CSS"),
    (dict(color_by="height", opacity=2), "0 to 1"),
    (dict(color_by="height", colors=3), "colors is 3; accepted: a list"),
    (dict(levels=-0.1), "0 to 1"),
    (dict(contours=0), "more than 0"),
    (dict(contours=dict(width=1)), "interval"),
    (dict(grid=dict(interval=1, colour="red")), "colour"),
    (dict(details=[dict(image="nowhere.png", size=1)]), "nowhere.png"),
    (dict(details=[3]), "dict"),
])
def test_a_style_is_refused_whole(slope, style, told):
    ground, view, _ = slope
    ground.set_style(contours=4.0)
    before = view.image()
    with pytest.raises(dspace.Error, match=told):
        ground.set_style(**style)
    np.testing.assert_array_equal(view.image(), before)


def test_triangles_have_no_style(scene):
    ground = scene.add_terrain(FIELD, mode="triangles")
    with pytest.raises(dspace.Unsupported, match="clipmap"):
        ground.set_style(levels=1)


def given(ground):
    """The terrain's own style as the session keeps it."""
    return ground._scene._ask("describe_terrain_style", terrain=ground.name, viewport="").terrain_style.given


def test_a_change_keeps_the_rest(scene, slope):
    ground, view, _ = slope
    scene.add_fragment("lines")
    ground.set_style(color_by="height", range=(0, 40), colors=["black", "white"], opacity=0.5, ornamental=False,
                     contours=dict(interval=4.0, width=3, color="red", fragment="lines"), grid=10.0, grid_labels=True,
                     levels=dict(opacity=0.3, fragment="lines"))
    before, plain = given(ground), view.image()
    ground.change_style()
    assert given(ground) == before
    np.testing.assert_array_equal(view.image(), plain)
    ground.change_style(range=(0, 30))
    after = given(ground)
    assert (after.ramp.low, after.ramp.high, after.ramp.opacity) == (0, 30, 0.5)
    after.ramp.high = 40
    assert after == before
    assert (view.image() != plain).any()
    ground.change_style(opacity=1.0, range=(0, 40), contours={"interval": 2.0}, grid=5)
    after = given(ground)
    assert (after.ramp.opacity, after.contours.interval, after.grid.interval) == (1.0, 2.0, 5.0)
    after.ramp.opacity, after.contours.interval, after.grid.interval = 0.5, 4.0, 10.0
    assert after == before
    # Another false color has the defaults of its own, and is seen as the one before.
    ground.change_style(color_by="slope", levels=None)
    assert ground.style["range"] == (0.0, 45.0) and len(ground.style["colors"]) > 2 and not ground.style["ornamental"]
    assert not given(ground).HasField("levels") and not given(ground).HasField("levels_member")
    ground.change_style(range=None, colors=["blue", "red"])
    assert ground.style["range"] == (0.0, 45.0) and ground.style["colors"] == [(0, 0, 1), (1, 0, 0)]
    ground.change_style(color_by="normal")
    ground.change_style(color_by=None, grid=None, contours=None)
    assert ground.style == {} and given(ground) == type(before)(terrain=ground.name)


def test_a_change_keeps_the_false_color_that_a_terrain_has_from_the_start(scene):
    ground = scene.add_terrain(FIELD, mode="clipmap", relief=dict(color_by_height=True))
    before = ground.style
    assert before["color_by"] == "height"
    ground.change_style(grid=20.0)
    assert ground.style == before and given(ground).grid.interval == 20.0
    assert before["shaded"]
    ground.change_style(color_by="slope")  # has the defaults of its own: the colours of its legend
    assert not ground.style["shaded"]


def test_what_a_change_refuses_changes_nothing(scene, slope):
    ground, view, _ = slope
    ground.set_style(color_by="height", range=(0, 40), contours=4.0)
    before = given(ground)
    for bad in (dict(range=(40, 40)), dict(opacity=2.0), dict(color_by="size"), dict(contours={"interval": -1}),
                dict(color_by=None, range=(0, 1)), dict(color_by=None, opacity=0.5)):
        with pytest.raises(dspace.InvalidArgument, match=ground.name):
            ground.change_style(**bad)
        assert given(ground) == before
    for bad in ("red", {"thickness": 1}):
        with pytest.raises(dspace.WrongType):
            ground.change_style(contours=bad)
    with pytest.raises(dspace.Unsupported, match="clipmap"):
        scene.add_terrain(FIELD, mode="triangles").change_style(grid=1.0)
