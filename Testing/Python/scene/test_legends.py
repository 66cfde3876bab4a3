"""Colour bars through Python: what they show against the ramps that they are of, and refusals."""
import numpy as np
import pytest

import dspace
from terrain_support import FIELD

SHADES = [(0.1, 0.0, 0.4), (0.9, 0.5, 0.1), (0.2, 1.0, 0.7)]


@pytest.fixture
def view(scene):
    scene.add_camera(eye=(0, 0, 100), target=(0, 0, 0), up=(0, 1, 0))
    view = scene.add_viewport(size=(300, 300), samples=1)
    view.set_background((0.3, 0.3, 0.3))
    return view


@pytest.fixture
def field(scene):
    return scene.add_terrain(FIELD, mode="clipmap")


def bar_of(image, length, thickness):
    """Left edge and lowest row of a vertical bar, by its white frame."""
    white = (image == 255).all(-1)
    rows, columns = np.nonzero(white[:, :])
    for row, column in zip(rows, columns):
        if (white[row, column:column + thickness + 2].all()
                and white[row + length + 1:row + length + 2, column:column + thickness + 2].all()
                and white[row:row + length + 2, column].all()
                and white[row + length + 1:].any() and not white[row + 1, column + 1]):
            return column + 1, row + length
    raise AssertionError("no bar")


def test_a_legend_has_the_colours_and_values_of_a_terrains_ramp(view, field):
    field.set_style(color_by="height", range=(-2, 6), colors=SHADES)
    without = view.image()
    assert field.style == {"color_by": "height", "range": (-2, 6), "colors": SHADES, "opacity": 1.0,
                           "fragment": "ornamental", "ornamental": True, "shaded": False}
    name = view.legend_of(field, background=(0, 0, 0), background_opacity=1, length=160)
    assert name == field.name
    image = view.image()
    left, bottom = bar_of(image, 160, 16)
    i = np.arange(160)
    value = -2 + 8 * (i + 0.5) / 160
    for k in range(3):
        expected = 255 * np.interp(value, (-2, 2, 6), [shade[k] for shade in SHADES])
        np.testing.assert_allclose(image[bottom - i, left + 5, k], expected, atol=1)
    marks = [v for k, v in zip(i, value) if (image[bottom - k, left + 17] == 255).all()]
    np.testing.assert_allclose(marks, [-2, 0, 2, 4, 6], atol=0.51 * 8 / 160)
    # The ground's colour is the bar's at the same value, in the same picture.
    field.object.set_material(lit=False)
    image, z = view.image().astype(int), 100 - view.depth()
    for x in range(20, 180, 11):
        row = bottom - int((z[150, x] + 2) / 8 * 160)
        # A row of the bar is 5 cm, which is up to 4 levels of a colour.
        assert np.abs(image[150, x] - image[row, left + 5]).max() <= 5
    view.remove_color_bar(name)
    field.object.set_material(lit=True)
    np.testing.assert_array_equal(view.image(), without)
    with pytest.raises(dspace.NotFound, match="no colour bar"):
        view.remove_color_bar(name)


def test_what_a_style_left_to_choose_is_told(field):
    assert field.style == {}
    field.set_style(color_by="height")
    assert field.style["range"] == field.height_range and len(field.style["colors"]) >= 3
    field.set_style(color_by="slope", opacity=0.5)
    assert field.style["range"] == (0, 45) and field.style["opacity"] == 0.5
    field.set_style(color_by="aspect")
    assert field.style["range"] == (0, 360) and field.style["colors"][0] == field.style["colors"][-1]
    field.set_style(color_by="normal")
    assert field.style["range"] is None and field.style["colors"] == []


def test_physical_pictures_have_no_legend(view, field):
    field.set_style(color_by="slope")
    without = view.image(physical_only=True)
    view.legend_of(field, "slopes", anchor="top left", horizontal=True, ticks=4)
    assert (view.image() != without).any()
    np.testing.assert_array_equal(view.image(physical_only=True), without)


def test_a_legend_is_of_what_has_a_ramp(view, field):
    with pytest.raises(dspace.InvalidArgument, match="no ramp"):
        view.legend_of(field)
    field.set_style(color_by="normal")
    with pytest.raises(dspace.InvalidArgument, match="no ramp"):
        view.legend_of(field)
    with pytest.raises(dspace.WrongType, match="Terrain"):
        view.legend_of("height")

    field.set_style()
    layer = field.add_false_color(FIELD, colors=SHADES, low=-1.0, high=4.0, name="heights")
    without = view.image()
    assert view.legend_of(layer, background=(0, 0, 0), background_opacity=1, length=100) == "heights"
    image = view.image()
    left, bottom = bar_of(image, 100, 16)
    shown = image[bottom - np.arange(100), left + 5]
    expected = 255 * np.stack([np.interp((np.arange(100) + 0.5) / 50, (0, 1, 2), part) for part in zip(*SHADES)], -1)
    np.testing.assert_allclose(shown, expected, atol=1)
    marks = [k for k in range(100) if (image[bottom - k, left + 17] == 255).all()]
    assert marks == [0, 20, 40, 60, 80, 99]  # -1 to 4
    view.remove_color_bar("heights")
    np.testing.assert_array_equal(view.image(), without)


@pytest.mark.parametrize("change, told", [
    (dict(low=3.0), "3 to 3"), (dict(high=float("nan")), "nan"), (dict(colors=[]), "0 colours"),
    (dict(colors=["nocolour"]), "CSS"), (dict(colors="red"), "colours"), (dict(ticks=101), "ticks is 101"),
    (dict(values=[5.0]), "a tick is at 5"), (dict(anchor="middle"), "'top left'"),
    (dict(length=9000), "8192"), (dict(font_size=2), "4 to 200"), (dict(title="a\nb"), "U\\+000A"),
    (dict(title="x" * 5000), "4096"), (dict(horizontal=1), "True or False"), (dict(opacity=2), "0 to 1"),
    (dict(background_opacity=-1), "0 to 1"), (dict(thickness=0), "2 to 1024"),
    (dict(colors=[(0, 0, 0)] * 1025), "1025 colours"),
])
def test_bars_that_cannot_be_are_refused_and_change_nothing(view, change, told):
    given = dict(colors=["black", "white"], low=0.0, high=3.0)
    view.set_color_bar("bar", **given)
    before = view.image()
    with pytest.raises(dspace.Error, match=told) as error:
        view.set_color_bar("bar", **dict(given, **change))
    assert "colour bar 'bar'" in str(error.value)
    np.testing.assert_array_equal(view.image(), before)
