"""Cones, footprints, ground tracks and links against closed forms."""
import math

import numpy as np
import pytest

import dspace
from dspace.objects.sensors import field_of_view, on_ellipsoid, sub_points
from dspace.trajectories import States

MOON = 1737.4e3


@pytest.fixture
def scene():
    with dspace.Session() as session:
        yield session.scene("sensors")


def looking_down(scene, height, name="camera"):
    """A frame above longitude 0 on the equator whose Z points to the centre."""
    half = math.radians(-90) / 2
    return scene.add_frame(name, position=(MOON + height, 0, 0), quaternion=(math.cos(half), 0, math.sin(half), 0))


def angle_from(point, axis=(1, 0, 0)):
    return np.degrees(np.arccos(np.clip(point @ np.array(axis, float) / np.linalg.norm(point, axis=-1), -1, 1)))


def test_a_cone_on_a_sphere_has_the_radius_of_the_triangle(scene):
    height = 100e3
    marks = scene.add_footprints(radii=MOON)
    outline = marks.add(looking_down(scene, height), half_angle_deg=20)
    assert np.allclose(np.linalg.norm(outline, axis=1), MOON, atol=1e-6)
    # Law of sines in the triangle of centre, instrument and edge: sin(n + c) = (R + h) / R sin(n).
    central = math.degrees(math.asin((MOON + height) / MOON * math.sin(math.radians(20)))) - 20
    assert np.allclose(angle_from(outline), central, atol=1e-9)
    assert len(marks) == 1 and marks.mesh.ornamental


def test_a_wide_cone_ends_at_the_limb(scene):
    height = 100e3
    outline = scene.add_footprints(radii=MOON).add(looking_down(scene, height), half_angle_deg=85)
    assert np.allclose(angle_from(outline), math.degrees(math.acos(MOON / (MOON + height))), atol=1e-6)


def test_a_cone_that_misses_has_no_footprint(scene):
    away = scene.add_frame("away", position=(MOON + 1e5, 0, 0))  # its Z is along the surface
    marks = scene.add_footprints(radii=MOON)
    assert marks.add(away, half_angle_deg=5) is None
    assert marks.add(away, half_angle_deg=5, axis=(1, 0, 0)) is None
    assert len(marks) == 0 and marks.mesh is None
    inside = scene.add_frame("inside", position=(MOON / 2, 0, 0))
    with pytest.raises(dspace.InvalidArgument, match="inside of the body"):
        marks.add(inside, half_angle_deg=5)


def test_rays_meet_an_ellipsoid(scene):
    radii = np.array((6378137.0, 6378137.0, 6356752.3))
    origin = np.array((7e6, 1e6, 3e6))
    targets = np.array(((6.3e6, 1e5, 2e4), (5.9e6, 1.2e6, 1.6e6), (0, 9e6, 9e6)))
    points, hit = on_ellipsoid(origin, targets - origin, radii)
    assert hit.tolist() == [True, True, False]
    assert np.allclose(np.sum((points / radii)**2, axis=1), 1.0, atol=1e-12)
    for p, target in zip(points[:2], targets[:2]):
        assert np.linalg.norm(np.cross((p - origin) / np.linalg.norm(p - origin),
                                       (target - origin) / np.linalg.norm(target - origin))) < 1e-12
        assert np.dot(p / radii**2, origin - p) > 0  # the near side
    # At the limb the ray is tangent, in the plane of the ray and the centre.
    assert abs(np.dot(points[2] / radii**2, origin - points[2])) < 1e-9
    assert abs(np.dot(points[2], np.cross(origin, targets[2]))) / 1e20 < 1e-6


def test_corners_make_a_pyramid():
    edge = field_of_view(corners=((1, 1, 2), (-1, 1, 2), (-1, -1, 2), (1, -1, 2)), count=8)
    assert edge.shape == (8, 3)
    assert np.allclose(np.linalg.norm(edge, axis=1), 1)
    assert np.allclose(edge[0], np.array((1, 1, 2)) / math.sqrt(6))
    for arguments in ({}, {"half_angle_deg": 90}, {"half_angle_deg": 5, "corners": np.eye(3)},
                      {"corners": np.eye(3)[:2]}, {"corners": np.zeros((3, 3))}, {"half_angle_deg": 5, "axis": (0, 0, 0)}):
        with pytest.raises(dspace.Error):
            field_of_view(**arguments)


def test_footprints_accumulate_and_are_seen(scene):
    scene.add_sphere(MOON, color="black", lit=False)
    frames = [looking_down(scene, 100e3, f"at {i}") for i in range(3)]
    for i, frame in enumerate(frames):
        a = math.radians(10.0 * i)
        half = (math.radians(-90) - 0) / 2
        frame.pose = dspace.Pose((MOON + 1e5) * np.array((math.cos(a), math.sin(a), 0)),
                                 quaternion=compose((math.cos(a / 2), 0, 0, math.sin(a / 2)),
                                                    (math.cos(half), 0, math.sin(half), 0)))
    camera = scene.add_camera("far", eye=(6e6, 0, 0), target=(0, 0, 0), fov_deg=40)
    view = scene.add_viewport((301, 301), camera)
    marks = scene.add_footprints(radii=MOON, fill=True, opacity=1.0, color="white", name="marks")
    areas = []
    for frame in frames:
        marks.add(frame, half_angle_deg=45)
        areas.append((view.image()[..., 0] > 128).sum())
    assert areas[0] > 100 and areas[1] > 1.5 * areas[0] and areas[2] > 2.2 * areas[0]
    last = scene.add_footprints(radii=MOON, accumulate=False)
    for frame in frames:
        last.add(frame, half_angle_deg=5)
    assert len(last) == 1
    marks.clear()
    assert (view.image()[..., 0] > 128).sum() < 300  # the outline of the last one is left


def compose(a, b):
    w, x, y, z = a
    return (w * b[0] - x * b[1] - y * b[2] - z * b[3], w * b[1] + x * b[0] + y * b[3] - z * b[2],
            w * b[2] - x * b[3] + y * b[0] + z * b[1], w * b[3] + x * b[2] - y * b[1] + z * b[0])


def test_ground_tracks_lie_below(scene):
    times = 60.0 * np.arange(30)
    positions = 2e6 * np.stack((np.cos(times / 1000), np.sin(times / 1000), 0.2 + 0 * times), axis=1)
    craft = scene.add_trajectory(States(times, positions))
    track = scene.add_ground_track(craft, MOON, lift=0.0, before=600.0)
    p = track.states(times)[0]
    assert np.allclose(np.linalg.norm(p, axis=1), MOON, atol=1e-6)
    assert np.allclose(p / MOON, positions / np.linalg.norm(positions, axis=1, keepdims=True), atol=1e-9)
    # Geodetic: the ellipsoid's normal at the point leads to the craft.
    radii = np.array((6378137.0, 6378137.0, 6356752.3))
    above = np.array(((7e6, 2e6, 4e6), (1e6, -2e6, -8e6), (9e6, 0, 0)))
    below = sub_points(above, radii, geodetic=True)
    assert np.allclose(np.sum((below / radii)**2, axis=1), 1, atol=1e-12)
    normal = below / radii**2
    assert np.linalg.norm(np.cross(normal / np.linalg.norm(normal, axis=1, keepdims=True), above - below), axis=1).max() < 1e-3
    with pytest.raises(dspace.InvalidArgument, match="step"):
        scene.add_ground_track(craft, MOON, step=0.0)


def test_links_follow_their_frames_and_show_their_state(scene):
    a = scene.add_frame("a", position=(0, -2, 0))
    b = scene.add_frame("b", position=(0, 2, 0))
    link = scene.add_link(a, b, line_width=5)
    camera = scene.add_camera("camera", eye=(10, 0, 0), target=(0, 0, 0))
    view = scene.add_viewport((101, 101), camera)
    assert link.length == pytest.approx(4.0)
    assert view.image()[50, 50].tolist() == [0x40, 0xd0, 0x60]
    link.update("lost")
    assert view.image()[50, 50].tolist() == [0xe0, 0x40, 0x40]
    b.position = (0, 2, 3)
    link.update()
    assert view.image()[50, 50].max() == 0 and link.length == pytest.approx(5.0)
    with pytest.raises(dspace.InvalidArgument, match="'good', 'weak', 'lost'"):
        link.state = "fine"


def test_a_sensor_cone_is_translucent(scene):
    scene.add_box((1, 100, 100), position=(-5, 0, 0), color="white", lit=False)
    cone = scene.add_sensor_cone(scene.root, 4.0, half_angle_deg=30, color="red", opacity=0.5)
    view = scene.add_viewport((101, 101), scene.add_camera("camera", eye=(20, 0, 2), target=(0, 0, 2)))
    red, green, _ = (int(v) for v in view.image()[50, 50])
    assert red > 200 and 90 < green < 200 and cone.ornamental
    with pytest.raises(dspace.InvalidArgument, match="length"):
        scene.add_sensor_cone(scene.root, -1.0, half_angle_deg=30)
