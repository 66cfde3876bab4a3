"""The planes of a picture: levels of detail are the same in all of them, ranges and depths follow closed forms, and near
and far planes follow what is drawn."""
import pathlib

import numpy as np
import pytest

import dspace
from needs import needs_module

RED, BLUE = (255, 0, 0), (0, 0, 255)


def write_box(path, half, half_z):
    """An OBJ file of a box, centred on the origin."""
    corners = [(x, y, z) for x in (-half, half) for y in (-half, half) for z in (-half_z, half_z)]
    faces = [(1, 2, 4, 3), (5, 7, 8, 6), (1, 5, 6, 2), (3, 4, 8, 7), (1, 3, 7, 5), (2, 6, 8, 4)]
    path.write_text("".join("v %r %r %r\n" % corner for corner in corners)
                    + "".join("f %d %d %d %d\n" % face for face in faces))
    return str(path)


# --- Levels of detail ------------------------------------------------------------------------------

@pytest.fixture
def leveled(tmp_path, scene):
    """An object with a fine level, a plate of 2 m x 2 m, and a coarse one, a plate of 1 m x 1 m, from 5 pixels on. The
    threshold is given in pixels of diameter: the diameter is that of the fine level's bounding sphere."""
    fine = write_box(tmp_path / "fine.obj", 1.0, 0.1)
    coarse = write_box(tmp_path / "coarse.obj", 0.5, 0.1)
    diameter = 2 * np.sqrt(1 + 1 + 0.01)

    def load(threshold):
        return scene.load((fine, threshold), levels=[(coarse, 5.0)], color=(1, 0, 0), lit=False)
    return load, diameter


def shown(viewport, thing):
    """The widths in pixels at which the middle row shows the object, by plane: colour, depth, range, label, picks."""
    planes = viewport.capture(depth=True, label=True, range=True)
    row = viewport.size[1] // 2
    color = planes["color"][row].astype(int)
    picks = sum(viewport.pick(x, row) is not None for x in range(viewport.size[0]))
    return {"color": int((color[:, 0] > 127).sum()), "depth": int(np.isfinite(planes["depth"][row]).sum()),
            "range": int(np.isfinite(planes["range"][row]).sum()), "label": int((planes["label"][row] == thing.id).sum()),
            "pick": picks}


@pytest.mark.parametrize("samples", [1, 2, 4])
@pytest.mark.parametrize("perspective", [False, True])
def test_all_planes_show_the_same_level(leveled, scene, samples, perspective):
    load, diameter = leveled
    # 100 rows show 10 m at the depth of the object: 10 pixels a metre.
    view = {"fov_deg": float(np.degrees(2 * np.arctan(0.25)))} if perspective else {"height": 10.0}
    scene.add_camera("down", eye=(0, 0, 20), target=(0, 0, 0), up=(0, 1, 0), **view)
    viewport = scene.add_viewport((120, 100), samples=samples)
    wide, narrow = 20, 10  # pixels of the fine and the coarse plate
    near = 1 if perspective else 0  # the plate's upper face is nearer than its centre
    for threshold, expected in ((10 * diameter - 0.5, wide), (10 * diameter + 0.5, narrow),
                                (4 * 10 * diameter - 0.5, narrow), (2 * 10 * diameter - 0.5, narrow)):
        thing = load(threshold)
        for plane, width in shown(viewport, thing).items():
            assert abs(width - expected) <= near, (threshold, plane, width)
        thing.remove()


def write_robot(path, mesh, origin="0 0 0", links=("plate",)):
    """A URDF of links at the origin that show the mesh `origin` away; None: no visual."""
    visual = mesh and f'<visual><origin xyz="{origin}"/><geometry><mesh filename="{mesh}"/></geometry></visual>'
    text = "".join(f'<link name="{link}">{visual or ""}</link>' for link in links)
    joints = "".join(f'<joint name="to_{link}" type="fixed"><parent link="{links[0]}"/><child link="{link}"/></joint>'
                     for link in links[1:])
    path.write_text(f'<robot name="plates">{text}{joints}</robot>')
    return str(path)


def test_levels_of_a_urdf(tmp_path, scene):
    fine = write_robot(tmp_path / "fine.urdf", write_box(tmp_path / "fine.obj", 1.0, 0.1), "0.5 0 0")
    coarse = write_robot(tmp_path / "coarse.urdf", write_box(tmp_path / "coarse.obj", 0.5, 0.1), "1 0 0")
    diameter = 2 * np.sqrt(1 + 1 + 0.01)
    scene.add_camera("down", eye=(0, 0, 20), target=(0, 0, 0), up=(0, 1, 0), height=10.0)
    viewport = scene.add_viewport((120, 100), samples=1)  # 10 pixels a metre
    for threshold, left, width in ((10 * diameter - 0.5, -0.5, 20), (10 * diameter + 0.5, 0.5, 10)):
        robot = scene.load((fine, threshold), levels=[(coarse, 5.0)])
        plate, = robot.objects
        assert set(shown(viewport, plate).values()) - {width} <= {0}  # 0: this material is not red
        labels = viewport.labels()[50]
        assert np.flatnonzero(labels == plate.id)[0] == round(60 + 10 * left)  # each in its own place
        robot.remove()
    none = write_robot(tmp_path / "none.urdf", None)
    robot = scene.load((fine, 10 * diameter + 0.5), levels=[(none, 0)])
    plate, = robot.objects
    assert shown(viewport, plate)["label"] == 0  # too small for its one level
    robot.remove()


def test_levels_of_another_urdf_are_rejected(tmp_path, scene):
    mesh = write_box(tmp_path / "fine.obj", 1.0, 0.1)
    fine = write_robot(tmp_path / "fine.urdf", mesh)
    more = write_robot(tmp_path / "more.urdf", mesh, links=("plate", "arm"))
    before = len(scene.objects), len(scene.frames)
    with pytest.raises(dspace.InvalidArgument, match="more.urdf.*'arm'.*fine.urdf"):
        scene.load((fine, 10), levels=[(more, 0)])
    twice = tmp_path / "twice.urdf"
    text = pathlib.Path(fine).read_text()
    visual = text[text.index("<visual>"):text.index("</link>")]
    twice.write_text(text.replace(visual, 2 * visual))
    with pytest.raises(dspace.InvalidArgument, match="twice.urdf.*'plate' has 2 visuals.*accepted"):
        scene.load((fine, 10), levels=[(twice, 0)])
    with pytest.raises(dspace.InvalidArgument, match="minimumPixels"):
        scene.load((fine, 10), levels=[(fine, 20)])
    with pytest.raises(dspace.NotFound, match="absent.urdf"):
        scene.load((fine, 10), levels=[(str(tmp_path / "absent.urdf"), 0)])
    assert (len(scene.objects), len(scene.frames)) == before
    scene.load((more, 10), levels=[(fine, 0)])  # the arm, which the level lacks, stays as it is


@pytest.mark.parametrize("samples", [1, 4])
def test_no_plane_shows_what_is_too_small_for_the_coarsest_level(leveled, scene, samples):
    load, diameter = leveled
    scene.add_camera("down", eye=(0, 0, 20), target=(0, 0, 0), up=(0, 1, 0), height=100 * diameter / 4.9)
    viewport = scene.add_viewport((120, 100), samples=samples)  # 4.9 pixels, and the coarse level wants 5
    thing = load(20.0)
    assert set(shown(viewport, thing).values()) == {0}
    scene.cameras["down"].set_projection(height=100 * diameter / 5.1)
    widths = shown(viewport, thing)
    assert all(1 <= width <= 3 for width in widths.values()), widths


# --- Ranges ----------------------------------------------------------------------------------------

VIEWS = {
    "perspective": dict(fov_deg=70.0),
    "off-axis": dict(tangents=(-0.2, 0.9, -0.5, 0.3)),
}


def rays(kind, width, height, right=0.0, down=0.0):
    """Unit directions of the pixels' centres in the camera's axes, from the definition of the projection; or of the places
    so many pixels right of them and down."""
    x, y = np.meshgrid((np.arange(width) + 0.5 + right) / width, (np.arange(height) + 0.5 + down) / height)
    if kind == "perspective":
        top = np.tan(np.radians(35.0))
        u, v = (2 * x - 1) * top * width / height, (2 * y - 1) * top
    else:
        u, v = -0.2 + 1.1 * x, -0.5 + 0.8 * y
    direction = np.stack((u, v, np.ones_like(u)), -1)
    return direction / np.linalg.norm(direction, axis=-1, keepdims=True)


@pytest.mark.parametrize("kind", VIEWS)
def test_ranges_to_a_plane_follow_their_closed_form(scene, session, kind):
    scene.add_box((400, 400, 2.0), position=(0, 0, -1), name="ground")
    scene.add_camera("eye", eye=(0, 0, 7.0), target=(30, 0, -7), **VIEWS[kind])
    viewport = scene.add_viewport((96, 64))
    X = scene.cameras["eye"].pose_in()

    def ranges(**beside):
        down = -(rays(kind, 96, 64, **beside) @ X.rotation.T)[..., 2]
        return 7.0 / np.where(down > 0.0, down, np.nan)
    expected = ranges()
    # A GPU places vertices on a grid of 1/256 of a pixel (GL_SUBPIXEL_BITS is 8 or more).
    software = "llvmpipe" in session.statistics["renderer"]
    step = 0.0 if software else np.abs(expected - ranges(down=1 / 256)) + np.abs(expected - ranges(right=1 / 256))
    found = viewport.range()
    hit = np.isfinite(found)
    assert hit[-1, 0] and hit[-1, -1]  # corners
    assert (np.abs(found - expected) <= 1e-5 * expected + step)[hit].all()
    depth = expected * rays(kind, 96, 64)[..., 2]
    assert (np.abs(viewport.depth() - depth) <= 1e-5 * depth + step)[hit].all()
    pick = viewport.pick(0, 63)
    assert np.linalg.norm(pick.in_camera) == pytest.approx(float(found[63, 0]), rel=1e-6)


@pytest.mark.parametrize("kind", VIEWS)
def test_ranges_inside_a_sphere_are_its_radius(scene, kind):
    scene.add_sphere(50.0, name="shell")
    scene.add_camera("eye", eye=(0, 0, 0), target=(1, 0.3, 0.2), **VIEWS[kind])
    found = scene.add_viewport((96, 64)).range()
    # The sphere is a polyhedron whose faces cut in; no corner is farther than its radius.
    assert found.max() <= 50.0 * (1 + 1e-6) and found.min() > 49.0, (found.min(), found.max())
    assert abs(found[0, 0] - found[32, 48]) < 0.6  # a depth plane would differ by tens of metres


def test_ranges_of_an_orthographic_camera_are_depths(scene):
    scene.add_box((1, 1, 1), name="cube")
    scene.add_camera("eye", eye=(9, 2, 3), target=(0, 0, 0), height=2.0)
    planes = scene.add_viewport((64, 48)).capture(color=False, depth=True, range=True)
    assert np.isfinite(planes["range"]).any()
    np.testing.assert_array_equal(planes["range"], planes["depth"])


def test_ranges_are_saved(scene, tmp_path):
    gdal = needs_module("osgeo.gdal", "python3-gdal")  # an independent reader
    scene.add_box((1, 1, 1), name="cube")
    scene.add_camera("eye", eye=(9, 2, 3), target=(0, 0, 0))
    viewport = scene.add_viewport((64, 48))
    viewport.save(tmp_path / "range.tif", plane="range")
    np.testing.assert_array_equal(gdal.Open(str(tmp_path / "range.tif")).ReadAsArray(), viewport.range())
    with pytest.raises(dspace.InvalidArgument, match="accepted for range: .tif .tiff .exr"):
        viewport.save(tmp_path / "range.png", plane="range")


def test_planes_of_light_are_saved_as_they_are_captured(scene, tmp_path):
    gdal = needs_module("osgeo.gdal", "python3-gdal")  # an independent reader
    scene.add_box((1, 1, 1), name="cube")
    scene.add_camera("eye", eye=(9, 2, 3), target=(0, 0, 0))
    scene.sun.set(direction=(1.0, 0.5, 0.7))
    viewport = scene.add_viewport((64, 48))
    for name in ("radiance", "lit_fraction", "incidence", "emission", "phase"):
        taken = viewport.capture(color=False, **{name: True})[name]
        for ending in ("tif", "exr"):
            viewport.save(tmp_path / f"{name}.{ending}", plane=name)
        found = gdal.Open(str(tmp_path / f"{name}.tif")).ReadAsArray()
        np.testing.assert_array_equal(np.moveaxis(found, 0, -1) if found.ndim == 3 else found, taken)
        assert np.isfinite(taken).any() and np.nanmax(taken) > 0.0
        with pytest.raises(dspace.InvalidArgument, match=f"accepted for {name.replace('_', ' ')}: .tif .tiff .exr"):
            viewport.save(tmp_path / "no.png", plane=name)


# --- Near and far ----------------------------------------------------------------------------------

def test_an_orthographic_camera_sees_a_scene_from_any_distance(scene):
    scene.add_box((2, 2, 2), name="cube", color="#ff0000", lit=False)
    viewport = scene.add_viewport((64, 64), scene.add_camera("far", eye=(0, 0, 2e5), target=(0, 0, 0), up=(0, 1, 0),
                                                             height=4.0))
    assert (viewport.image()[32, 32] == RED).all()
    assert viewport.depth()[32, 32] == pytest.approx(2e5 - 1, rel=1e-7)
    projection = scene.cameras["far"].projection
    assert projection["near"] is None and projection["far"] is None
    scene.cameras["far"].far = 1e4
    assert not np.isfinite(viewport.depth()).any() and not viewport.image().any()  # as it was set
    scene.cameras["far"].far = None
    assert np.isfinite(viewport.depth()[32, 32])


def test_nothing_in_view_is_cut(scene):
    """Objects from a millimetre to a thousand kilometres before a camera; each is seen, in order."""
    scene.add_camera("eye", eye=(0, 0, 0), target=(0, 0, -1), up=(0, 1, 0))
    viewport = scene.add_viewport((200, 100))
    for n, distance in enumerate((1e-3, 1.0, 1e3, 1e6)):
        size = 0.2 * distance
        scene.add_box((size, size, size), position=((n - 1.5) * 0.4 * distance, 0, -distance), name=f"box {n}")
    seen = viewport.explain()
    assert [each.reason for each in seen.objects] == ["seen"] * 4, str(seen)
    # The orthographic camera sees what is ahead of its plane, and what is behind with a near plane that is set.
    flat = scene.add_camera("flat", eye=(0, 0, 0), target=(0, 0, -1), up=(0, 1, 0), height=8.0)
    viewport.camera = flat
    scene.add_box((1, 1, 1), position=(3, 3, 5), name="behind")
    assert viewport.explain().of("behind").reason == "behind"
    flat.near = -10.0
    assert viewport.explain().of("behind").reason == "seen"
    assert viewport.pick(137, 12).object.name == "behind"


def test_surfaces_of_an_automatic_orthographic_view_do_not_fight(scene):
    """A mark 1 cm above a plate, seen from 50 km."""
    scene.add_box((100, 100, 1), position=(0, 0, -0.5), color="#0000ff", lit=False, name="plate")
    scene.add_box((80, 80, 0.02), position=(0, 0, 0), color="#ff0000", lit=False, name="mark")
    viewport = scene.add_viewport((100, 100), scene.add_camera("far", eye=(0, 0, 5e4), target=(0, 0, 0), up=(0, 1, 0),
                                                               height=100.0), samples=1)
    image = viewport.image()
    assert (image[12:88, 12:88] == RED).all() and (image[:8] == BLUE).all()
