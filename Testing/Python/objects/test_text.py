"""Letters of any alphabet in labels and tables; those that cannot be drawn are refused by name."""
import numpy as np
import pytest

import dspace

LETTERS = {"greek": "Δλ", "cyrillic": "мж", "signs": "≥→"}


@pytest.fixture
def view(scene):
    camera = scene.add_camera(eye=(0, 0, 5), target=(0, 0, 0), up=(0, 1, 0))
    view = scene.add_viewport((400, 120), camera, samples=1)
    view.set_background((0, 0, 0))
    return view


def ink(view):
    return (view.image()[..., :3] > 127).any(axis=2)


@pytest.mark.parametrize("kind", ("label", "solid"))
@pytest.mark.parametrize("letters", LETTERS.values(), ids=LETTERS)
def test_letters_are_drawn_in_the_scene(scene, view, letters, kind):
    def drawn(text):
        if kind == "label":
            label = scene.add_label(text, position=(-2, 0, 0), font_size=40, background_opacity=0)
        else:
            label = scene.add_text(text, 1, position=(-2, -0.5, 0), color=(1, 1, 1), lit=False)
        image = ink(view)
        label.remove()
        return image

    one, other = (drawn("a" + letter) for letter in letters)
    alone = drawn("a")
    assert one.sum() > alone.sum() + 50 and other.sum() > alone.sum() + 50
    assert (one != other).sum() > 50


@pytest.mark.parametrize("letters", LETTERS.values(), ids=LETTERS)
def test_letters_are_drawn_in_tables(view, letters):
    def drawn(key, value):
        view.set_table("t", {key: value}, font_size=30, background_opacity=1)
        return ink(view)

    one, other, none = drawn(letters[0], "1"), drawn(letters[1], "1"), drawn(" ", "1")
    assert one.sum() > none.sum() + 50 and other.sum() > none.sum() + 50
    assert (one != other).sum() > 50
    key = drawn("a", letters[0])
    assert (key != drawn("a", letters[1])).sum() > 50


def test_letters_that_the_font_lacks_are_refused(scene, view, refused):
    label = scene.add_label("Δv", position=(-2, 0, 0))
    view.set_table("t", {"a": "b"})
    before = view.image()
    for bad, code in (("go 中", "U+4E2D"), ("\U0001f680", "U+1F680"), ("שלום", "U+05E9"),
                      ("a\tb", "U+0009")):
        for use in (scene.add_label, label.set, lambda text: scene.add_text(text, 1), lambda text: view.set_table("t", {text: 1}),
                    lambda text: view.set_table("t", {"value": text}),
                    lambda text: view.set_table("t", {}, title=text)):
            with refused(dspace.InvalidArgument, code):
                use(bad)
    for bad in ("two\nlines", "a\tb"):
        with refused(dspace.InvalidArgument, "the value of 'mode'"):
            view.set_table("t", {"mode": bad})
    np.testing.assert_array_equal(view.image(), before)


def test_sizes_that_cannot_be_drawn_are_refused_when_asked_for(scene, view, refused):
    for samples in (None, 8):
        with refused(dspace.InvalidArgument, "samples=1"):
            scene.add_viewport((16384, 16384), view.camera, name="large", samples=samples)
    view.samples = 8
    with refused(dspace.InvalidArgument, "samples=1"):
        view.size = (16384, 16384)
    assert view.size == (400, 120)
    view.samples = 1
    view.size = (16384, 8)
    for samples in (0, 9):
        with refused(dspace.InvalidArgument, "1 to 8"):
            view.samples = samples
    assert view.samples == 1 and view.image().shape[:2] == (8, 16384)
    scene.add_viewport((16384, 8), view.camera, name="large", samples=1)  # the name is still free


@pytest.mark.parametrize("height", (None, 9.0), ids=("perspective", "orthographic"))
def test_a_label_is_not_cut_by_the_object_that_it_names(scene, height):
    craft = scene.add_frame("craft", position=(0, 0, 1))
    arm = craft.add_frame("arm", position=(0.5, 0, 0))
    hull = scene.add_box((2, 2, 2), frame=craft, color="black", lit=False)
    tip = scene.add_sphere(0.7, frame=arm, color="black", lit=False)
    label = scene.add_label("CRAFT", frame=craft, font_size=40, background_opacity=0)
    camera = scene.add_camera(eye=(6, -9, 4), target=(0, 0, 1), height=height)
    view = scene.add_viewport((300, 200), camera, samples=1)
    view.set_background((0, 0, 0))
    cut = ink(view)
    hull.visible = tip.visible = False
    free = ink(view)
    assert free.sum() > 300
    np.testing.assert_array_equal(cut, free)
    # What is in front of both hides it, and so does what is on no frame of its own.
    wall = scene.add_box((0.1, 30, 30), position=(5, -6, 3), color="black", lit=False)
    assert ink(view).sum() == 0
    wall.visible = False
    hull.visible = True
    label.frame = scene.root
    label.set_offset(position=(0, 0, 1))
    assert ink(view).sum() < free.sum()  # as far as the hull reaches
