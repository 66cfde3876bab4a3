"""The values of grid lines over the picture: where projection by hand puts them, and what they say."""
import re

import numpy as np
import pytest

import dspace
from terrain_support import gdal, write_raster

RADIUS = 1e6


def captions(view):
    """(text, x, y) of all that is written, pixels."""
    view.image()
    props = view.vtk.GetOverlayRenderer().GetViewProps()
    found = []
    for index in range(props.GetNumberOfItems()):
        actor = props.GetItemAsObject(index)
        x, y = actor.GetPosition()
        found.append((actor.GetInput().strip(), x - 0.5, view.size[1] - 0.5 - y))
    return found


def said(text):
    """0 for x or longitude, 1 for y or latitude; the value."""
    match = re.fullmatch(r"(-?[\d,.]+)(°?)( ?)([EWNS]?)", text)
    assert match, text
    value = float(match[1].replace(",", ""))
    return "NS".find(match[4] or "?") >= 0, -value if match[4] in ("W", "S") else value


class Lens:
    """A perspective camera by hand: up is Z."""

    def __init__(self, eye, target, fov_deg, size):
        self.eye, self.size = np.asarray(eye, float), size
        self.forward = np.asarray(target, float) - eye
        self.forward /= np.linalg.norm(self.forward)
        self.right = np.cross(self.forward, (0, 0, 1))
        self.right /= np.linalg.norm(self.right)
        self.down = np.cross(self.forward, self.right)
        self.pixel = 2 * np.tan(np.radians(fov_deg) / 2) / size[1]

    def pixels(self, points):
        d = points - self.eye
        z = d @ self.forward
        return np.stack((d @ self.right / z / self.pixel + self.size[0] / 2 - 0.5,
                         d @ self.down / z / self.pixel + self.size[1] / 2 - 0.5), -1)

    def point(self, x, y, depth):
        ray = (self.forward + (x + 0.5 - self.size[0] / 2) * self.pixel * self.right
               + (y + 0.5 - self.size[1] / 2) * self.pixel * self.down)
        return self.eye + depth * ray


def check_places(ground, view, lens, around):
    """Each text stands on its line, within 1.5 pixels; returns texts by direction."""
    labels = captions(view)
    depth = view.depth()
    texts = ([], [])
    for text, x, y in labels:
        family, value = said(text)
        d = depth[int(round(y)), int(round(x))]
        assert np.isfinite(d), text
        map_x, map_y, _ = ground.to_map(lens.point(round(x), round(y), d)[None])[0]
        # The ground on that line beside what the picture shows here, along the line.
        other = np.linspace(-1, 1, 401) * 8 * d * lens.pixel
        if around:
            other = np.degrees(other / RADIUS) / (max(np.cos(np.radians(map_y)), 0.02) if family else 1)
        line = (np.stack((map_x + other, np.full(401, value)), -1) if family
                else np.stack((np.full(401, value), map_y + other), -1))
        line[:, 1] = np.clip(line[:, 1], -89.9, 89.9) if around else line[:, 1]
        points = ground.from_map(np.column_stack((line, ground.height(*line.T, map=True))))
        away = np.linalg.norm(lens.pixels(points) - (x, y), axis=1)
        assert np.nanmin(away) < 1.5, (text, x, y, np.nanmin(away))
        texts[family].append((text, value))
    boxes = [(x, y, (len(text) + 2) * 0.3 * 13) for text, x, y in labels]
    for i, (x, y, half) in enumerate(boxes):
        assert half - 1 <= x <= view.size[0] - half and 5 <= y <= view.size[1] - 6
        for u, v, other in boxes[:i]:
            assert abs(x - u) > half + other - 2 or abs(y - v) > 13, labels
    for family in texts:
        assert len({text for text, _ in family}) == len(family) <= 20
    return texts


@pytest.fixture
def globe(scene, tmp_path):
    longitude, latitude = np.meshgrid(np.radians(np.arange(0.5, 360)), np.radians(90 - np.arange(0.5, 180)))
    height = 8000 * np.sin(3 * longitude) * np.cos(latitude) ** 2 + 5000 * np.sin(4 * latitude)
    data = gdal.GetDriverByName("GTiff").Create(str(tmp_path / "globe.tif"), 360, 180, 1, gdal.GDT_Float32)
    data.SetGeoTransform((0, 1, 0, 90, 0, -1))
    data.SetProjection(f'GEOGCS["ball",DATUM["ball",SPHEROID["ball",{RADIUS},0]],PRIMEM["zero",0],'
                       'UNIT["degree",0.0174532925199433]]')
    data.GetRasterBand(1).SetUnitType("m")
    data.GetRasterBand(1).WriteArray(height)
    data = None
    return scene.add_terrain(tmp_path / "globe.tif", on_body=True, vertical_datum=f"sphere:{RADIUS}",
                             color=(0.4, 0.4, 0.4))


def look(scene, eye, target, fov_deg, size=(480, 400), samples=2):
    scene.add_camera("eye", eye=eye, target=target, fov_deg=fov_deg, near=1, far=1e8)
    return scene.add_viewport(size, "eye", samples=samples), Lens(eye, target, fov_deg, size)


@pytest.mark.parametrize("samples", [1, 3])
def test_a_globe_has_the_values_of_the_side_that_is_seen(scene, globe, samples):
    view, lens = look(scene, (3.5e6 * np.cos(2), 3.5e6 * np.sin(2), 0), (0, 0, 0), 40, samples=samples)
    globe.set_style(grid=15, grid_labels=True)
    meridians, parallels = check_places(globe, view, lens, True)
    middle = np.degrees(2)
    assert len(meridians) >= 8 and len(parallels) >= 7
    for _, value in meridians:
        assert abs((value - middle + 180) % 360 - 180) < 90 and value % 15 == 0
    names = [text for text, _ in meridians + parallels]
    # Where two would touch one is left out, which of them is of no matter.
    assert {"120°E", "0°N"} <= set(names) and sum(name.endswith("°S") for name in names) >= 2


@pytest.mark.parametrize("z", [1, -1], ids=["north", "south"])
def test_meridians_around_a_pole(scene, globe, z):
    view, lens = look(scene, (2e5, 1e5, z * 2.5e6), (0, 0, z * 1e6), 40)
    globe.set_style(grid=20, grid_labels=True)
    meridians, parallels = check_places(globe, view, lens, True)
    assert len(meridians) >= 14 and {"180°", "0°E"} <= {text for text, _ in meridians}
    assert parallels and all(np.sign(value) == z for _, value in parallels)


def test_the_date_line_is_no_jump(scene, globe):
    view, lens = look(scene, (-2.5e6, 1e5, 3e5), (0, 0, 0), 35)
    globe.set_style(grid=10, grid_labels=True)
    meridians, _ = check_places(globe, view, lens, True)
    names = {text for text, _ in meridians}
    assert {"180°", "170°E", "170°W"} <= names and "190°E" not in names


@pytest.fixture
def hills(scene, tmp_path):
    x, y = np.meshgrid(np.arange(600.0), np.arange(600.0))
    z = 30 * np.sin(x / 60) * np.cos(y / 50)
    return scene.add_terrain(write_raster(tmp_path / "hills.tif", z.astype(np.float32), pixel=10.0),
                             mode="clipmap", color=(0.4, 0.4, 0.4))


def test_a_map_has_its_own_numbers(scene, hills):
    view, lens = look(scene, (300, -2800, 900), (0, 0, 0), 50)
    hills.set_style(grid=500, grid_labels=True)
    east, north = check_places(hills, view, lens, False)
    assert len(east) >= 5 and len(north) >= 4
    assert all(text.endswith(" E") for text, _ in east) and all(text.endswith(" N") for text, _ in north)
    assert "3,000 E" in {text for text, _ in east}
    # Of many lines the rounder ones.
    hills.set_style(grid=50, grid_labels=True)
    east, north = check_places(hills, view, lens, False)
    assert 4 <= len(east) <= 20 and all(value % 100 == 0 for _, value in east)


def test_what_stands_before_the_ground_bears_no_value(scene, hills):
    view, lens = look(scene, (300, -2800, 900), (0, 0, 0), 50)
    hills.set_style(grid=250, grid_labels=True)
    free = captions(view)
    wall = scene.add_box((4000, 20, 700), name="wall")
    wall.set_offset(position=(0, -1500, 350))
    shown = captions(view)
    ids = view.labels()
    assert (ids == wall.id).mean() > 0.1
    for text, x, y in shown:
        assert ids[int(round(y)), int(round(x))] == hills.object.id, text
    assert any(ids[int(round(y)), int(round(x))] == wall.id for _, x, y in free)


def test_they_go_without_trace_and_are_in_no_physical_picture(scene, hills):
    view, _ = look(scene, (300, -2800, 900), (0, 0, 0), 50)
    hills.set_style(grid=500)
    without = view.image()
    physical = view.image(physical_only=True)
    hills.set_style(grid=500, grid_labels=dict(color="magenta", background="magenta", background_opacity=1))
    image = view.image()
    box = (image[..., 0] > 220) & (image[..., 1] < 35) & (image[..., 2] > 220)  # letters' edges are smooth
    for _, x, y in captions(view):  # what is written is there
        assert box[int(round(y)) - 5:int(round(y)) + 6, int(round(x)) - 12:int(round(x)) + 13].all()
    rows, columns = np.nonzero(box)
    assert len(rows) > 1000
    np.testing.assert_array_equal(view.image(physical_only=True), physical)
    np.testing.assert_array_equal(image[~(image != without).any(-1)], without[~(image != without).any(-1)])
    hills.set_style(grid=500)
    np.testing.assert_array_equal(view.image(), without)


def test_a_box_stands_about_its_place(scene, hills):
    """Its middle to 1.5 pixels, where a picture has but one."""
    view, _ = look(scene, (300, -2800, 900), (0, 0, 0), 50)
    hills.set_style(grid=4000, grid_labels=dict(color="magenta", background="magenta", background_opacity=1))
    boxes = captions(view)
    image = view.image()
    for text, x, y in boxes:
        half = int(0.31 * 13 * (len(text) + 2)) + 6
        part = (image[int(y) - 12:int(y) + 14, max(int(x) - half, 0):int(x) + half + 2] == (255, 0, 255)).all(-1)
        rows, columns = np.nonzero(part)
        assert abs((rows.min() + rows.max()) / 2 + int(y) - 12 - y) <= 1.5
        assert abs((columns.min() + columns.max()) / 2 + max(int(x) - half, 0) - x) <= 1.5
    assert boxes


@pytest.mark.parametrize("style, told", [
    (dict(grid_labels=True), "need a grid"),
    (dict(grid=5, grid_labels="yes"), "True or False"),
    (dict(grid=5, grid_labels=dict(font_size=3)), "4 to 200"),
    (dict(grid=5, grid_labels=dict(size=3)), "'size'"),
    (dict(grid=5, grid_labels=dict(color="nocolour")), "CSS"),
    (dict(grid=5, grid_labels=dict(background_opacity=2)), "0 to 1"),
])
def test_labels_that_cannot_be_are_refused(hills, style, told):
    with pytest.raises(dspace.Error, match=told):
        hills.set_style(**style)
