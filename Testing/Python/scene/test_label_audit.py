"""The label audit: whatever ornaments a scene has, its physical pictures are those of a scene that never had them."""
import json

import numpy as np
import pytest

import dspace
from terrain_support import gdal, write_raster

SIDE = 96  # pixels of a metre
SIZE = (160, 120)
MAP = ("#301060", "#20a0a0", "#f0e020")


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    """A raster with a hole, an image on half of it, shapes."""
    folder = tmp_path_factory.mktemp("audit")
    y, x = np.mgrid[0:SIDE, 0:SIDE].astype(float)
    z = 4 * np.sin(x / 9) * np.cos(y / 7) + 0.05 * x
    holed = z.copy()
    holed[40:54, 42:58] = np.nan
    shapes = folder / "shapes.geojson"
    shapes.write_text(json.dumps({"type": "Polygon", "coordinates": [[[20, 20], [70, 24], [60, 70], [20, 20]]]}))
    return {"ground": write_raster(folder / "ground.tif", holed), "values": write_raster(folder / "values.tif", z),
            "image": image(folder / "image.tif", 127 + 100 * np.sin(x / 3)), "shapes": shapes}


def image(path, values):
    """A grey image that lies on the raster."""
    write_raster(path.with_suffix(".float.tif"), values)
    gdal.Translate(str(path), str(path.with_suffix(".float.tif")), outputType=gdal.GDT_Byte)
    return path


class Stage:
    """Physical ground and things, seen from above."""

    def __init__(self, session, files):
        self.files = files
        self.session = session
        self.scene = session.scene("audit")
        self.terrain = self.open()
        self.terrain.layer("filled").remove()
        self.box = self.scene.add_box((4, 4, 4), position=(10, -10, 8), color="#c04020", name="box")
        self.scene.add_camera("above", eye=(-14, -60, 52), target=(0, 0, 0))
        self.view = self.scene.add_viewport(SIZE, "above", name="view", samples=2)
        self.view.fill = 0.0  # which is no ornament, but not in physical pictures

    def open(self):
        terrain = self.scene.add_terrain(self.files["ground"], mode="clipmap", fill_holes=True, level_size=28,
                                         name="ground", color=(0.6, 0.5, 0.4))
        terrain.add_image(self.files["image"], name="photograph", opacity=0.5)
        terrain.track({"wheel": [(-20, 10), (20, 12)]}, width=2.0, sinkage=0.2, wall=0.5)
        return terrain

    def planes(self, **options):
        return self.view.capture(depth=True, label=True, **options)


# Each kind of ornament: a function that adds it to a stage.
def objects(stage):
    stage.scene.add_axes(10)
    stage.scene.add_arrow(9, position=(-12, 0, 6))
    stage.scene.add_sphere(3, ornamental=True, position=(0, -14, 8))
    stage.scene.add_lines([(-20, -20, 9), (20, 20, 9)])
    stage.scene.add_points([(5, 5, 9), (6, 5, 9)])


def labels(stage):
    stage.scene.add_label("here", position=(-5, -5, 9))


def letters(stage):
    stage.scene.add_text("NORTH", 4, position=(-10, -20, 9))


def trails(stage):
    stage.scene.add_trail(5).append([(-20, 0, 9), (0, 0, 11), (20, 0, 9)])


def contours(stage):
    stage.terrain.set_style(contours=0.5)


def grid(stage):
    stage.terrain.set_style(grid=10, grid_labels=True)


def ramp(stage):
    stage.terrain.set_style(color_by="height", colors=MAP)


def normals(stage):
    stage.terrain.set_style(color_by="normal", opacity=0.7)


def levels(stage):
    stage.terrain.set_style(levels=0.6)


def tracks(stage):
    stage.terrain.set_style(tracks={"color": "red", "opacity": 1, "ornamental": True})


def everything_of_a_style(stage):
    stage.terrain.set_style(color_by="slope", opacity=0.5, levels=0.3, contours=1, grid=20, grid_labels=True,
                            tracks={"color": "red", "opacity": 1, "ornamental": True})


def style_in_the_viewport(stage):
    stage.terrain.set_style(color_by="aspect", contours=1, grid=16, grid_labels=True, viewport=stage.view)


def false_color(stage):
    stage.terrain.add_false_color(stage.files["values"], colors=MAP, name="values")


def drawing(stage):
    stage.terrain.add_image(stage.files["image"], name="drawing", opacity=0.8, ornamental=True)


def shapes(stage):
    stage.terrain.add_shapes(stage.files["shapes"], line="red", crs=None)


def noise(stage):
    stage.terrain.add_noise(wavelength=6, contrast=0.9)


def legend(stage):
    stage.view.set_color_bar("bar", ["red", "blue"], 0, 1, length=40)


def table(stage):
    stage.view.set_table("table", {"time": 1})


def corner_axes(stage):
    stage.view.corner_axes = True


def mark_of_filled_ground(stage):
    """fill_holes adds it; the bare stage has removed it."""
    stage.terrain.remove()
    stage.terrain = stage.open()


KINDS = (mark_of_filled_ground, objects, labels, letters, trails, contours, grid, ramp, normals, levels, tracks,
         style_in_the_viewport, false_color, drawing, shapes, noise, everything_of_a_style, legend, table, corner_axes)
WITHOUT_TINT = (tracks, everything_of_a_style)  # the standard tint of tracks is physical, and replaced by an ornament


@pytest.fixture(scope="module")
def bare(files):
    with dspace.Session() as session:
        stage = Stage(session, files)
        planes = stage.planes()
        expect_equal(stage.planes(physical_only=True), planes)  # nothing here is an ornament
        stage.terrain.set_style(tracks={"opacity": 0})
        untinted = stage.planes()
        assert (untinted["color"] != planes["color"]).any()
        return {"standard": planes, "untinted": untinted}


def expect_equal(planes, expected):
    assert planes.keys() == expected.keys()
    for name, plane in planes.items():
        np.testing.assert_array_equal(plane, expected[name], err_msg=name)


def without_ids(planes, stage):
    """Labels as stable numbers: terrain that is opened again has another id."""
    numbers = {0: 0, stage.terrain.object.id: 1, stage.box.id: 2}
    assert set(np.unique(planes["label"])) <= numbers.keys()  # no pixel belongs to an ornament
    return {**planes, "label": np.vectorize(numbers.get)(planes["label"])}


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.__name__)
def test_a_kind_of_ornament_leaves_no_pixel(files, bare, kind):
    expected = bare["untinted" if kind in WITHOUT_TINT else "standard"]
    with dspace.Session() as session:
        stage = Stage(session, files)
        expected = without_ids(expected, stage)
        kind(stage)
        assert (stage.view.image() != expected["color"][..., :3]).any()  # it is seen
        expect_equal(without_ids(stage.planes(physical_only=True), stage), expected)
        stage.view.ornaments = False
        if kind not in (legend, table):  # which stay: they have functions of their own
            expect_equal(without_ids(stage.planes(), stage), expected)


@pytest.mark.filterwarnings("ignore")
def test_all_ornaments_together_leave_no_pixel(files, bare):
    with dspace.Session() as session:
        stage = Stage(session, files)
        standard, untinted = (without_ids(bare[name], stage) for name in ("standard", "untinted"))
        for kind in KINDS:
            kind(stage)
        first = stage.view.image()
        expect_equal(without_ids(stage.planes(physical_only=True), stage), standard)  # the viewport's style has a tint
        np.testing.assert_array_equal(stage.view.image(), first)  # nor does the request leave anything behind
        # Ornaments that are objects have labels where they are asked for; what is painted on the ground has none.
        everything = np.unique(stage.view.labels(physical_only=False))
        assert {stage.terrain.object.id, stage.box.id} < set(everything) and len(everything) > 4
        # The terrain's own style, too, not only that of the viewport.
        stage.terrain.remove_style(stage.view)
        assert (stage.view.image() != first).any()
        expect_equal(without_ids(stage.planes(physical_only=True), stage), untinted)


FRAGMENT_KINDS = {
    "contours": lambda stage, **own: stage.terrain.set_style(contours=0.5, **own),
    "grid": lambda stage, **own: stage.terrain.set_style(grid=10, grid_labels=True, **own),
    "ramp": lambda stage, **own: stage.terrain.set_style(color_by="height", colors=MAP, **own),
    "levels": lambda stage, **own: stage.terrain.set_style(levels=0.6, **own),
    "tracks": lambda stage, **own: stage.terrain.set_style(tracks={"color": "red", "opacity": 1, **own}),
    "in viewport": lambda stage, **own: stage.terrain.set_style(color_by="slope", viewport="view", **own),
    "false color": lambda stage, **own: stage.terrain.add_false_color(stage.files["values"], colors=MAP, **own),
    "image": lambda stage, **own: stage.terrain.add_image(stage.files["image"], opacity=0.8, **own),
    "shapes": lambda stage, **own: stage.terrain.add_shapes(stage.files["shapes"], line="red", **own),
    "noise": lambda stage, **own: stage.terrain.add_noise(wavelength=6, contrast=0.9, **own),
}


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("kind", FRAGMENT_KINDS)
@pytest.mark.parametrize("ornamental", (True, False), ids=("ornamental", "physical"))
def test_elements_follow_their_fragment(files, bare, kind, ornamental):
    expected = bare["untinted" if kind == "tracks" else "standard"]["color"]
    with dspace.Session() as session:
        stage = Stage(session, files)
        fragment = stage.scene.add_fragment("own", ornamental=ornamental)
        FRAGMENT_KINDS[kind](stage, fragment=fragment, ornamental=ornamental)
        assert any("object 'ground'" in member for member in fragment.members)
        shown = stage.view.image()
        assert (shown != expected[..., :3]).any()
        if not ornamental and kind != "grid":  # whose labels are ornaments
            np.testing.assert_array_equal(stage.view.image(physical_only=True), shown)
        np.testing.assert_array_equal(stage.planes(hide="own")["color"], expected)
        np.testing.assert_array_equal(stage.view.image(), shown)
        stage.view.hide(fragment)
        np.testing.assert_array_equal(stage.planes()["color"], expected)
        other = stage.scene.add_viewport(SIZE, "above", name="other", samples=2)
        other.fill = 0.0
        if kind != "in viewport":
            np.testing.assert_array_equal(other.image(), shown)
        stage.view.show(fragment)
        fragment.visible = False
        np.testing.assert_array_equal(stage.planes()["color"], expected)
        np.testing.assert_array_equal(other.image(), expected[..., :3])
        fragment.visible = True
        np.testing.assert_array_equal(stage.view.image(), shown)
        with pytest.raises(dspace.InvalidArgument, match="fragment 'own'.*object 'ground'.*empty"):
            fragment.remove()
        wrong = stage.scene.add_fragment("wrong", ornamental=not ornamental)
        with pytest.raises(dspace.InvalidArgument, match="accepted: a fragment of its nature"):
            FRAGMENT_KINDS[kind](stage, fragment=wrong, ornamental=ornamental)
        np.testing.assert_array_equal(stage.view.image(), shown)
        wrong.remove()
        stage.terrain.set_style()
        stage.terrain.remove_style(stage.view)
        for layer in stage.terrain.layers:
            if layer.fragment == "own":
                layer.remove()
        fragment.remove()
