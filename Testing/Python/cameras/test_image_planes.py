"""Planes of pictures through lenses: normals, points, ground coordinates and motion against closed forms."""
import numpy as np
import pytest

import dspace
from terrain_support import gdal, write_raster

MODELS = {
    "pinhole": dspace.CameraModel("pinhole", size=(80, 60), focal=(60, 60), center=(39.5, 29.5)),
    "equidistant": dspace.CameraModel("equidistant", size=(80, 60), focal=(25, 25), center=(39.5, 29.5)),
    "cahvore": dspace.CameraModel("cahvore", size=(80, 60), C=(0, 0, 0), A=(0, 0, 1), H=(60, 0, 39.5), V=(0, 60, 29.5),
                                  O=(0, 0, 1), R=(0, 0, 0), E=(0.004, 0, 0), linearity=0),
}
TURN = np.radians(35.0)
Q = (np.cos(TURN / 2), np.sin(TURN / 2), 0.0, 0.0)  # of the body in the root, about X


def turned(vectors, angle, axis=0):
    c, s = np.cos(angle), np.sin(angle)
    i, j = (axis + 1) % 3, (axis + 2) % 3
    out = np.array(vectors, dtype=float)
    out[..., i], out[..., j] = c * vectors[..., i] - s * vectors[..., j], s * vectors[..., i] + c * vectors[..., j]
    return out


def grid(model):
    return np.stack(np.meshgrid(np.arange(model.size[0]), np.arange(model.size[1])), axis=-1).astype(float)


@pytest.mark.parametrize("name", MODELS)
def test_normals_and_points_of_a_wall_and_a_ball(scene, name):
    """In a frame that is turned and far from the root: the wall at Z = 6 and a ball before it."""
    model = MODELS[name]
    place = np.array((2e5, -3e5, 1e5))
    body = scene.add_frame("body", position=place, quaternion=Q)
    wall = scene.add_plane(400, 400, frame=body, position=(0, 0, 6.0))
    ball = scene.add_sphere(1.0, frame=body, position=(0.3, 0.2, 4.0))
    planes = scene.simulate_image(model, frame=body, color=False, label=True, normal=True, point=True)
    assert set(planes) == {"label", "normal", "point", "lens"} and planes["point"].dtype == np.float64
    origins, directions = model.rays(grid(model))
    on_wall, on_ball = planes["label"] == wall.id, planes["label"] == ball.id
    assert on_wall.sum() > 1000 and on_ball.sum() > 100
    toward = turned(np.array((0.0, 0.0, -1.0)), TURN)
    np.testing.assert_allclose(planes["normal"][on_wall], np.broadcast_to(toward, (on_wall.sum(), 3)), atol=2e-6)
    expected = place + turned(origins + ((6.0 - origins[..., 2]) / directions[..., 2])[..., None] * directions, TURN)
    near = on_wall & (directions[..., 2] > 0.75)  # within the first source view: the wall's depth is the same in all of it
    np.testing.assert_allclose(planes["point"][near], expected[near], atol=2e-4)
    from_center = turned(planes["point"][on_ball] - place, -TURN) - (0.3, 0.2, 4.0)
    inner = np.linalg.norm(from_center, axis=-1) < 1.02  # rays of whose own pixel the source shows the ball
    assert inner.sum() > 80
    normals = turned(planes["normal"][on_ball].astype(float), -TURN)[inner]
    np.testing.assert_allclose(np.linalg.norm(normals, axis=-1), 1.0, atol=1e-5)
    # A source pixel is at most one of the picture: half of its angle away, and the ball's facets.
    np.testing.assert_allclose(normals, from_center[inner], atol=0.12)
    assert np.abs(normals - from_center[inner]).mean() < 0.02
    nothing = planes["label"] == 0
    assert np.isnan(planes["normal"][nothing]).all() and np.isnan(planes["point"][nothing]).all()


def test_normals_in_tiles_are_the_same_bytes(scene):
    scene.add_sphere(1.0, position=(0, 0, 4.0))
    scene.add_plane(50, 50, position=(0, 0, 6.0))
    whole, tiled = (scene.simulate_image(MODELS["equidistant"], frame=scene.root, normal=True, point=True, tile=tile)
                    for tile in (512, 64))
    for plane in ("normal", "point"):
        np.testing.assert_array_equal(whole[plane], tiled[plane])


@pytest.mark.parametrize("mode", ["triangles", "clipmap"])
def test_ground_coordinates_of_a_slope(scene, tmp_path, mode):
    """z = 0.2 x in a terrain frame that is turned: map x and y by hand, heights by the raster's plane."""
    x = 0.5 * (np.arange(400) + 0.5)
    z = np.broadcast_to(0.2 * x, (300, 400)).astype(np.float32)
    frame = scene.add_frame("site", position=(500.0, 70.0, -20.0), quaternion=(np.cos(0.3), 0.0, 0.0, np.sin(0.3)))
    ground = scene.add_terrain(write_raster(tmp_path / "slope.tif", z, 0.5), mode=mode, frame=frame, pixel_size=0.5)
    middle = ground.from_map([[100.0, 75.0, 0.2 * 100.0]])[0]
    camera = scene.add_camera("down", eye=middle + (0, 0, 12.0), target=middle, up=(0, 1, 0), frame=frame)
    model = MODELS["pinhole"]
    planes = scene.simulate_image(model, camera, color=False, normal=True, ground=ground)
    assert set(planes) == {"normal", "ground", "lens"}
    # Rays of a camera 12 m above (100, 75), X east, Y south, against the plane z = 0.2 x.
    d = (grid(model) - (39.5, 29.5)) / 60.0
    t = 12.0 / (1.0 + 0.2 * d[..., 0])
    expected = np.stack((100.0 + t * d[..., 0], 75.0 - t * d[..., 1], 32.0 - t), axis=-1)
    pixel = 12.0 / 60.0  # a source pixel is at most as wide; on a slope of 0.2 its half moves the range by a fiftieth of a metre
    np.testing.assert_allclose(planes["ground"], expected, atol=0.2 * pixel * 0.5 + 1e-3)
    np.testing.assert_allclose(planes["ground"][..., 2], 0.2 * planes["ground"][..., 0], atol=0.2 * pixel * 0.5 + 1e-3)
    a = 0.6  # the frame's turn about Z
    normal = np.array((-0.2, 0.0, 1.0)) / np.sqrt(1.04)
    np.testing.assert_allclose(planes["normal"], np.broadcast_to(turned(normal, a, 2), planes["normal"].shape), atol=1e-3)
    # The raster has no longitudes and latitudes.
    assert np.isnan(scene.simulate_image(model, camera, geographic=ground)["geographic"][..., :2]).all()


def test_geographic_coordinates_on_a_sphere(scene, tmp_path):
    """Level ground 250 m above the Moon's sphere: longitude, latitude and height of each point by hand."""
    R = 1737400.0
    path = tmp_path / "moon.tif"
    data = gdal.GetDriverByName("GTiff").Create(str(path), 64, 48, 1, gdal.GDT_Float32)
    data.SetGeoTransform((30.0, 0.01, 0, -20.0, 0, -0.01))
    data.SetProjection(f'GEOGCS["Moon",DATUM["Moon",SPHEROID["Moon",{R},0]],PRIMEM["G",0],UNIT["degree",0.0174532925199433]]')
    data.SetMetadataItem("VERTICAL_DATUM", "sphere")
    data.GetRasterBand(1).WriteArray(np.full((48, 64), 250.0, np.float32))
    del data
    ground = scene.add_terrain(path, name="moon", on_body=True)
    lon, lat = np.radians((30.32, -20.24))
    up = np.array((np.cos(lat) * np.cos(lon), np.cos(lat) * np.sin(lon), np.sin(lat)))
    camera = scene.add_camera("down", eye=(R + 2250.0) * up, target=R * up, up=(0, 0, 1))
    planes = scene.simulate_image(MODELS["pinhole"], camera, geographic=ground, point=True, color=False)
    found = planes["geographic"]
    known = np.isfinite(found).all(axis=-1)
    assert known.all()
    np.testing.assert_allclose(found[..., 2], 250.0, atol=0.3)  # half a source pixel at the nadir, and floats of range
    p = planes["point"]
    r = np.linalg.norm(p, axis=-1)
    np.testing.assert_allclose(found[..., 0], np.degrees(np.arctan2(p[..., 1], p[..., 0])), atol=1e-9)
    np.testing.assert_allclose(found[..., 1], np.degrees(np.arcsin(p[..., 2] / r)), atol=1e-9)
    np.testing.assert_allclose(found[..., 2], r - R, atol=1e-6)
    # The middle of the picture is the point below the camera; north is up in it.
    np.testing.assert_allclose(found[29:31, 39:41, :2].mean(axis=(0, 1)), (30.32, -20.24), atol=1e-6)
    assert (np.diff(found[:, 40, 1]) < 0).all() and (np.diff(found[30, :, 0]) > 0).all()


@pytest.mark.parametrize("name", ["pinhole", "equidistant"])
def test_motion_of_the_camera_and_of_an_object(scene, name):
    """The camera moves and turns, and a box before a wall moves and turns: each pixel's place by formulas written here."""
    model = MODELS[name]
    body = scene.add_frame("body")
    wall = scene.add_plane(200, 200, position=(0, 0, 8.0))
    carrier = scene.add_frame("carrier", position=(0.2, 0.1, 5.0))
    box = scene.add_box((1.5, 1.5, 0.5), frame=carrier, position=(0.1, 0, 0.3))
    before = scene.image_state(model, frame=body)
    state = scene.simulate_image(model, frame=body, color=False, motion=before, label=True)
    seen = state["label"] != 0
    np.testing.assert_allclose(state["motion"][seen], 0.0, atol=1e-3)  # nothing has moved
    turn, spin = np.radians(3.0), np.radians(10.0)
    body.set_pose(position=(0.3, -0.2, 0.5), quaternion=(np.cos(turn / 2), 0, np.sin(turn / 2), 0))
    carrier.set_pose(position=(0.5, 0.0, 4.5), quaternion=(np.cos(spin / 2), 0, 0, np.sin(spin / 2)))
    planes = scene.simulate_image(model, frame=body, color=False, motion=before, label=True, range=True)
    pixels = grid(model)
    _, directions = model.rays(pixels)
    points = np.array((0.3, -0.2, 0.5)) + turned(directions * planes["range"][..., None].astype(float), turn, 1)
    # Where the points were: the wall's are the same, the box's are carried back.
    on_box, on_wall = planes["label"] == box.id, planes["label"] == wall.id
    assert on_box.sum() > 50 and on_wall.sum() > 1000
    were = points.copy()
    were[on_box] = turned(points[on_box] - (0.5, 0.0, 4.5), -spin, 2) + (0.2, 0.1, 5.0)
    if name == "pinhole":
        expected = 60.0 * were[..., :2] / were[..., 2:] + (39.5, 29.5)
    else:
        across = np.linalg.norm(were[..., :2], axis=-1)
        expected = 25.0 * (np.arctan2(across, were[..., 2]) / across)[..., None] * were[..., :2] + (39.5, 29.5)
    for part in (on_box, on_wall):
        np.testing.assert_allclose(planes["motion"][part], (expected - pixels)[part], atol=2e-3)
        assert np.abs(planes["motion"][part]).max() > 1.0
    assert np.isnan(planes["motion"][planes["label"] == 0]).all()
    # A later state from an earlier picture: the wall moves the other way.
    later = scene.image_state(model, frame=body)
    body.set_pose(position=(0, 0, 0), quaternion=(1, 0, 0, 0))
    carrier.set_pose(position=(0.2, 0.1, 5.0))
    back = scene.simulate_image(model, frame=body, color=False, motion=later, label=True)
    middle = back["motion"][5, 40], planes["motion"][5, 40]
    assert back["label"][5, 40] == planes["label"][5, 40] == wall.id and middle[0][0] * middle[1][0] < 0


def test_motion_through_a_scenes_camera_and_of_what_was_not_there(scene):
    model = MODELS["pinhole"]
    wall = scene.add_plane(200, 200, position=(0, 0, 8.0))
    camera = scene.add_camera("eye")
    camera.attach(scene.root, dspace.Pose((0, 0, 0)))
    before = scene.image_state(model, camera)
    camera.pose = dspace.Pose((0.4, 0, 0))
    new = scene.add_box((1, 1, 1), position=(0.4, 0, 5.0))
    planes = scene.simulate_image(model, camera, color=False, motion=before, label=True)
    on_wall = planes["label"] == wall.id
    np.testing.assert_allclose(planes["motion"][on_wall], np.broadcast_to((60.0 * 0.4 / 8.0, 0.0), (on_wall.sum(), 2)), atol=1e-3)
    assert np.isnan(planes["motion"][planes["label"] == new.id]).all()


def test_rejected(session, scene, refused):
    model = MODELS["pinhole"]
    other = session.scene("other")
    state = other.image_state(model, frame=other.root)
    with refused(dspace.WrongType, "motion is <dspace.ImageState of 0 objects>; accepted: an ImageState of this scene"):
        scene.simulate_image(model, frame=scene.root, motion=state)
    with refused(dspace.WrongType, "ground is 'moon'; accepted: a dspace.Terrain"):
        scene.simulate_image(model, frame=scene.root, ground="moon")
    with refused(dspace.WrongType, "the model is None; accepted: a dspace.CameraModel"):
        scene.image_state(None, frame=scene.root)
    with refused(dspace.WrongType, "point is 1; accepted: True or False"):
        scene.simulate_image(model, frame=scene.root, point=1)
