"""One terrain in several viewports: styles of viewports, layers that one of them hides, legends, marks of filled ground."""
import numpy as np
import pytest

import dspace
from terrain_support import write_raster

SIDE, SIZE = 128, (120, 90)
MAP = ("#301060", "#20a0a0", "#f0e020")
HOLE = slice(50, 80)


@pytest.fixture
def ground(tmp_path):
    y, x = np.mgrid[0:SIDE, 0:SIDE].astype(float)
    z = 5 * np.sin(x / 11) * np.cos(y / 9)
    z[HOLE, HOLE] = np.nan
    return write_raster(tmp_path / "ground.tif", z)


@pytest.fixture
def stage(scene, ground):
    """A terrain, and two viewports that look at it from above."""
    terrain = scene.add_terrain(ground, mode="clipmap", level_size=28, name="ground", color=(0.6, 0.5, 0.4))
    scene.add_camera("above", eye=(0, 0, 100), target=(0, 0, 0), up=(0, 1, 0), height=100, near=1)
    views = [scene.add_viewport(SIZE, "above", name=name, samples=1) for name in ("map", "natural")]
    for view in views:
        view.fill = 0.0  # which is no ornament, but not in pictures without ornaments
    return terrain, *views


def test_a_viewport_has_a_style_of_its_own(stage, scene):
    terrain, view, other = stage
    plain = view.image()
    loads = terrain.tiles["loads"]
    terrain.set_style(color_by="height", colors=MAP, contours=1, viewport=view)
    colored = view.image()
    assert (colored != plain).any(-1).mean() > 0.5
    np.testing.assert_array_equal(other.image(), plain)
    assert terrain.style == {} and terrain.style_in(other) == {}
    assert terrain.style_in("map")["color_by"] == "height" and terrain.style_in(view)["fragment"] == "ornamental"
    assert terrain.tiles["loads"] == loads  # no second copy of the data
    # The same picture as with a style of the terrain, and then the other has that one.
    terrain.set_style(color_by="height", colors=MAP, contours=1)
    np.testing.assert_array_equal(other.image(), colored)
    terrain.set_style(viewport=view)  # no style, in this viewport
    np.testing.assert_array_equal(view.image(), plain)
    assert terrain.style_in(view) == {}
    terrain.remove_style(view)  # the terrain's again
    np.testing.assert_array_equal(view.image(), colored)
    terrain.remove_style(view)
    np.testing.assert_array_equal(view.image(physical_only=True), plain)


def test_details_and_noise_are_those_of_the_terrain(stage, scene):
    terrain, view, other = stage
    terrain.set_style(noise=dict(wavelength=2, amplitude=0.5))
    depth = view.depth()
    terrain.set_style(color_by="slope", viewport=view)
    np.testing.assert_array_equal(view.depth(), depth)
    for given in (dict(noise=dict(wavelength=2, amplitude=0.5)), dict(details=[dict(image=__file__, size=1)])):
        with pytest.raises(dspace.InvalidArgument, match="'ground' in viewport 'map'.*same in all viewports"):
            terrain.set_style(viewport=view, **given)
    assert terrain.style_in(view)["color_by"] == "slope"


def test_a_style_goes_with_its_viewport_and_its_terrain(stage, scene, ground):
    terrain, view, other = stage
    plain = view.image()
    fragment = scene.add_fragment("own", ornamental=True)
    terrain.set_style(contours=1, fragment=fragment, viewport=view)
    assert fragment.members == ["contours in viewport 'map' of object 'ground'"]
    view.remove()
    assert fragment.members == []
    fragment.remove()
    view = scene.add_viewport(SIZE, "above", name="map", samples=1)
    view.fill = 0.0
    np.testing.assert_array_equal(view.image(), plain)
    terrain.set_style(contours=1, viewport=view)
    terrain.remove()
    scene.add_terrain(ground, mode="clipmap", level_size=28, name="ground", color=(0.6, 0.5, 0.4))
    np.testing.assert_array_equal(view.image(), plain)


def test_bad_viewports_are_refused(stage, scene, session, ground):
    terrain, view, other = stage
    with pytest.raises(dspace.NotFound, match="viewport 'no'"):
        terrain.set_style(contours=1, viewport="no")
    with pytest.raises(dspace.NotFound, match="viewport 'no'"):
        terrain.style_in("no")
    with pytest.raises(dspace.WrongType, match="viewport"):
        terrain.set_style(contours=1, viewport=3)
    with pytest.raises(dspace.InvalidArgument, match="more than 0"):
        terrain.set_style(contours=-1, viewport=view)
    with pytest.raises(dspace.NotFound, match="fragment 'no'"):
        terrain.set_style(contours=1, fragment="no", viewport=view)
    with pytest.raises(dspace.WrongType, match="ornamental"):
        terrain.set_style(contours=dict(interval=1, ornamental="yes"))
    second = session.scene("second")
    second.add_camera("above", eye=(0, 0, 100), target=(0, 0, 0), up=(0, 1, 0))
    elsewhere = second.add_viewport(SIZE, "above", name="elsewhere")
    with pytest.raises(dspace.InvalidArgument, match="viewport 'elsewhere' is in another scene"):
        terrain.set_style(contours=1, viewport=elsewhere)
    triangles = scene.add_terrain(ground, mode="triangles", name="triangles")
    with pytest.raises(dspace.Unsupported, match="'triangles'.*clipmap"):
        triangles.set_style(contours=1, viewport=view)
    assert terrain.style_in(view) == {}


def test_recordings_restore_styles_of_viewports(stage, scene, session, tmp_path):
    terrain, view, other = stage
    fragment = scene.add_fragment("own", ornamental=True)
    layer = terrain.add_noise(wavelength=9, contrast=0.9, fragment="own")
    layer.fragment = "ornamental"
    layer.fragment = fragment
    terrain.set_style(color_by="slope", contours=dict(interval=1, fragment="own"), grid=20)
    terrain.set_style(color_by="height", colors=MAP, viewport=view)
    view.legend_of(terrain, length=40)
    other.legend_of(terrain, length=40)
    other.hide("own")
    expected = [each.image() for each in (view, other)]
    with session.record(tmp_path / "run.dspace"):
        scene.time = 1.0
    with dspace.Playback(tmp_path / "run.dspace") as playback:
        playback.seek(1.0)
        for name, image in zip(("map", "natural"), expected):
            np.testing.assert_array_equal(playback.session.viewports[name].image(), image)


def test_two_viewports_of_different_layers_do_not_disturb_each_other(stage, scene, ground):
    terrain, view, other = stage
    terrain.add_noise(wavelength=9, contrast=0.9, ornamental=False)
    bare = view.image()
    terrain.add_false_color(ground, colors=MAP, opacity=0.7, low=-5, high=5)
    other.ornaments = False
    colored = view.image()
    assert (colored != bare).any(-1).mean() > 0.5
    np.testing.assert_array_equal(other.image(), bare)
    counted = terrain.layer_tiles
    for k in range(4):  # alternately, each time with something new in the scene
        scene.time = k + 1.0
        np.testing.assert_array_equal(view.image(), colored)
        np.testing.assert_array_equal(other.image(), bare)
        np.testing.assert_array_equal(view.image(physical_only=True), bare)
    assert terrain.layer_tiles["compositions"] == counted["compositions"]
    assert terrain.layer_tiles["reads"] == counted["reads"]
    scene.add_fragment("elsewhere")
    other.hide("elsewhere")  # holds no layer: nothing is composed again
    np.testing.assert_array_equal(other.image(), bare)
    assert terrain.layer_tiles["compositions"] == counted["compositions"]


def test_a_switch_of_layers_uploads_nothing_again(stage, scene, session, ground):
    terrain, view, _ = stage
    terrain.add_noise(wavelength=9, contrast=0.9, ornamental=False)
    terrain.add_false_color(ground, colors=MAP, opacity=0.7)
    view.image(), view.image(physical_only=True)
    before = session.statistics["texture_bytes_uploaded"]
    view.image(), view.image(physical_only=True)
    assert session.statistics["texture_bytes_uploaded"] == before


def test_a_legend_is_hidden_with_what_it_explains(stage, scene, ground):
    terrain, view, other = stage
    fragment = scene.add_fragment("own", ornamental=True)
    bare = other.image()
    terrain.set_style(color_by="height", colors=MAP, fragment=fragment)
    ramp = view.image()
    view.legend_of(terrain, length=40)
    both = view.image()
    assert (both != ramp).any()
    for hide, show in ((lambda: view.hide("own"), lambda: view.show("own")),
                       (lambda: setattr(fragment, "visible", False), lambda: setattr(fragment, "visible", True)),
                       (lambda: setattr(view, "ornaments", False), lambda: setattr(view, "ornaments", True)),
                       (lambda: terrain.set_style(viewport=view), lambda: terrain.remove_style(view))):
        hide()
        np.testing.assert_array_equal(view.image(), bare)
        show()
        np.testing.assert_array_equal(view.image(), both)
    np.testing.assert_array_equal(view.image(hide="own"), bare)
    np.testing.assert_array_equal(view.image(), both)
    terrain.object.visible = False
    assert (view.image() == 0).all()
    terrain.object.visible = True
    terrain.set_style()
    np.testing.assert_array_equal(view.image(), bare)
    layer = terrain.add_false_color(ground, colors=MAP, name="values")
    view.remove_color_bar("ground")
    layered = view.image()
    view.legend_of(layer, length=40)
    assert (view.image() != layered).any()
    layer.visible = False
    np.testing.assert_array_equal(view.image(), bare)
    layer.visible = True
    assert (view.image() != layered).any()
    layer.remove()
    np.testing.assert_array_equal(view.image(), bare)
    terrain.remove()
    assert (view.image() == 0).all()
    with pytest.raises(dspace.InvalidArgument, match="colour bar 'x'.*layer 'values' of no terrain"):
        view.set_color_bar("x", ["red", "blue"], 0, 1, layer="values")


def hole_of(view, camera_height=100):
    """Pixels of the picture that show filled ground, but for its rim, and those that show none."""
    width, height = SIZE
    pixel = camera_height / height
    x = (np.arange(width) + 0.5 - width / 2) * pixel + SIDE / 2
    y = (np.arange(height) + 0.5 - height / 2) * pixel + SIDE / 2
    inside = [(c > HOLE.start + 2) & (c < HOLE.stop - 2) for c in (x, y)]
    outside = [(c < HOLE.start - 2) | (c > HOLE.stop + 2) for c in (x, y)]
    ground = [(c > 1) & (c < SIDE - 1) for c in (x, y)]
    return inside[1][:, None] & inside[0], (outside[1][:, None] | outside[0]) & ground[1][:, None] & ground[0]


STYLES = (dict(color_by="height"), dict(color_by="slope", colors=["black", "white"]), dict(color_by="normal"),
          dict(levels=1), dict(contours=0.2), dict(grid=4, grid_labels=False), dict(color_by="aspect", contours=1, grid=10))


@pytest.mark.parametrize("style", STYLES, ids=lambda style: ",".join(style))
def test_filled_ground_is_marked_over_every_style(scene, ground, style):
    terrain = scene.add_terrain(ground, mode="clipmap", level_size=28, fill_holes=True, lit=False)
    scene.add_camera("above", eye=(0, 0, 100), target=(0, 0, 0), up=(0, 1, 0), height=100, near=1)
    view = scene.add_viewport(SIZE, "above", samples=1)
    terrain.layer("filled").opacity = 1.0
    terrain.set_style(**style)
    image = view.image().astype(int)
    hole, data = hole_of(view)
    assert (np.abs(image[hole] - (255, 0, 255)) <= 1).all()
    assert not (np.abs(image[data] - (255, 0, 255)) <= 1).all(-1).any()
    terrain.add_false_color(ground, colors=MAP, name="values", position=1)  # above it in the list
    image = view.image().astype(int)
    assert (np.abs(image[hole] - (255, 0, 255)) <= 1).all()
    terrain.layer("filled").visible = False
    assert not (np.abs(view.image()[hole].astype(int) - (255, 0, 255)) <= 1).all(-1).any()


def test_the_mark_is_mixed_with_the_style(scene, ground):
    terrain = scene.add_terrain(ground, mode="clipmap", level_size=28, fill_holes=True, lit=False)
    scene.add_camera("above", eye=(0, 0, 100), target=(0, 0, 0), up=(0, 1, 0), height=100, near=1)
    view = scene.add_viewport(SIZE, "above", samples=1)
    terrain.set_style(color_by="height", colors=["#204080", "#204080"])
    image, (hole, data) = view.image().astype(int), hole_of(view)

    def linear(c):
        c = np.asarray(c) / 255
        return np.where(c <= 0.04045, c / 12.92, ((c + 0.055) / 1.055) ** 2.4)

    mixed = 0.6 * linear((0x20, 0x40, 0x80)) + 0.4 * linear((255, 0, 255))
    expected = 255 * np.where(mixed <= 0.0031308, 12.92 * mixed, 1.055 * mixed ** (1 / 2.4) - 0.055)
    assert np.abs(image[hole] - expected).max() <= 2
    assert np.abs(image[data] - (0x20, 0x40, 0x80)).max() <= 1
    # A camera does not see the mark.
    assert np.abs(view.image(physical_only=True)[hole].astype(int) - expected).max() > 50


def test_statistics_leave_filled_ground_out(scene, tmp_path):
    """A hole beside a steep slope is filled with heights that are none of the data's."""
    y, x = np.mgrid[0:96, 0:96].astype(float)
    z = np.where(x < 30, -2.0 * x, np.where(x > 66, 2.0 * (x - 95), np.nan)) + 0 * y
    path = write_raster(tmp_path / "valley.tif", 0.2 * z)
    terrain = scene.add_terrain(path, mode="clipmap", fill_holes=True)
    z = np.float32(0.2 * z)
    assert terrain.height_range == (np.nanmin(z), np.nanmax(z))
    terrain.set_style(color_by="height")
    assert terrain.style["range"] == terrain.height_range
