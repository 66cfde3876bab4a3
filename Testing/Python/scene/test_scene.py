"""Objects, robots, cameras and terrain through Python."""
import warnings
from pathlib import Path

import numpy as np
import pytest

import dspace

DATA = Path(__file__).resolve().parents[3] / "Data"
TRIANGLE = "v 0 0 0\nv 0 2 0\nv 0 0 4\nf 1 2 3\n"


@pytest.fixture
def triangle(tmp_path):
    path = tmp_path / "triangle.obj"
    path.write_text(TRIANGLE)
    return path


def test_loaded_objects(scene, triangle):
    frame = scene.add_frame("f")
    one = scene.load(triangle, frame=frame, scale=10, up="y", color=(1, 0, 0))
    two = scene.load(triangle, ornamental=True)
    assert (one.name, two.name) == ("triangle", "triangle 2")
    assert one.frame == frame and one.fragment == "physical" and two.ornamental
    assert one.triangles == 1
    center, radius = one.bounds
    np.testing.assert_allclose(center, (0, -20, 10), atol=1e-5)
    assert radius == pytest.approx(np.hypot(20, 10), rel=1e-6)
    assert set(scene.objects) == {"triangle", "triangle 2"}
    assert scene.object("triangle") == one
    two.remove()
    assert "not in the scene" in repr(two)


def test_material(scene):
    box = scene.add_box((1, 2, 3), name="box", opacity=0.5)
    assert box.color is None and box.opacity == 0.5
    box.color = (1, 0.5, 0)
    box.set_material(metallic=1, roughness=0.25, lit=False)
    assert (box.color, box.opacity, box.metallic, box.roughness, box.lit) == (
        (1, 0.5, 0), 0.5, 1, 0.25, False)
    box.color = None
    assert box.color is None and box.metallic == 1
    box.visible = False
    assert not box.visible


def test_offset(scene):
    box = scene.add_box((1, 1, 1), position=(1, 2, 3))
    np.testing.assert_array_equal(box.offset[:3, 3], (1, 2, 3))
    box.set_offset(quaternion=(0, 0, 0, 1), stretch=(2, 3, 4))
    np.testing.assert_allclose(box.offset, np.diag([-2, -3, 4, 1]), atol=1e-15)


def test_ornaments(scene):
    for made in (scene.add_axes(1), scene.add_arrow(1), scene.add_goal(2), scene.add_tilt_marker(1),
                 scene.add_lines([(0, 0, 0), (1, 1, 1)]), scene.add_points([(0, 0, 0)]),
                 scene.add_frustum(2, (640, 480), fov_deg=40), scene.add_trail(10),
                 scene.add_text("Dspace", 1), scene.add_label("Dspace")):
        assert made.ornamental
    several = scene.add_lines([np.zeros((2, 3)), np.ones((3, 3)) * np.arange(3)[:, None]])
    assert several.bounds[1] > 0
    tilt = scene.add_tilt_marker(1, tilt_deg=0)
    green = tilt.color
    tilt.set(60)
    assert tilt.color[0] > green[0] and tilt.color[1] < green[1]
    trail = scene.add_trail(3)
    trail.append([(0, 0, 0), (4, 0, 0), (8, 0, 0)])
    trail.append((8, 6, 0))
    np.testing.assert_allclose(trail.bounds[0], (6, 3, 0), atol=1e-6)


def test_robot(scene):
    robot = scene.load(DATA / "rover" / "rover.urdf", name="rover", position=(1, 2, 3))
    assert scene.robots["rover"].frame == robot.frame == scene["rover"]
    np.testing.assert_array_equal(robot.pose.position, (1, 2, 3))
    pan = robot.joints["mast_pan"]
    before = pan.frame.pose
    pan.position = 30
    turned = before.inverse() @ pan.frame.pose
    np.testing.assert_allclose(turned.rotation,
                               dspace.Pose.from_axis_deg(pan.axis, 30).rotation, atol=1e-12)
    robot.set_joints({"rocker_left": 4.0, "bogie_left": -2.0})
    assert robot.joint_positions()["bogie_left"] == -2
    low, high = robot.joints["rocker_left"].limits
    robot.set_joints({"rocker_left": high + 50}, clamp=True)
    assert robot.joints["rocker_left"].position == high
    assert "mast_pan" in robot.joints and "revolute" in repr(robot.joints["rocker_left"])
    assert len(robot.objects) > 10
    robot.remove()
    assert scene.frames == {} and scene.objects == {} and scene.robots == {}


def test_cameras(scene):
    mast = scene.add_frame("mast")
    camera = scene.add_camera("left", frame=mast, eye=(0, 0, 5), target=(0, 0, 0), up=(0, 1, 0))
    assert camera.active and camera.frame == mast and camera.fov_deg == 45
    np.testing.assert_allclose(camera.pose.rotation, np.diag([1, -1, -1]), atol=1e-15)
    camera.fov_deg = 60
    camera.near = 0.5
    assert camera.projection == {"fov_deg": 60, "near": 0.5, "far": None}  # None: automatic
    camera.set_projection(height=20)
    assert camera.projection["height"] == 20 and camera.fov_deg is None
    camera.chase(mast, offset=(-3, 0, 1), axes="parent", smoothing_s=1)
    assert camera.pose is None
    second = scene.add_camera("right", tangents=(-0.1, 0.3, -0.2, 0.2))
    second.activate()
    assert not camera.active and scene.vantages["main"].active == second
    assert set(scene.cameras) == {"left", "right"}


def test_fragments_and_lights(scene):
    arm = scene.add_fragment("arm")
    box = scene.add_box((1, 1, 1), fragment=arm)
    assert arm.objects == [box] and set(scene.fragments) == {"physical", "ornamental", "arm"}
    arm.visible = False
    assert not arm.visible
    sun = scene.lights["sun"]
    sun.direction = (1, 0, -1)
    sun.intensity = 2
    assert sun.direction == (1, 0, -1) and sun.intensity == 2 and sun.kind == "directional"
    lamp = scene.add_light("lamp", kind="spot", position=(0, 0, 3), cone_deg=20)
    assert lamp.kind == "spot"
    lamp.remove()
    assert set(scene.lights) == {"sun"}
    assert scene._client is not None and scene.time == 0
    scene.time = 12.5
    assert scene.time == 12.5


def test_a_rover_stands_on_the_ground_that_is_drawn(scene, tmp_path):
    ground = scene.add_terrain(DATA / "field" / "field.tif")
    ground.focus([(3, -2)])
    rover = scene.load(DATA / "rover" / "rover.urdf")
    vehicle = dspace.rover.load_vehicle(DATA / "rover" / "rover.urdf")
    state = vehicle.solve((3, -2, 25), ground)
    rover.place(state)
    radius = {wheel.name: wheel.radius for wheel in vehicle.suspension.wheels}
    for thing in rover.objects:
        thing.visible = False
    scene.add_camera(eye=(3, -2, 10), target=(3, -2, 0), up=(0, 1, 0), height=4, near=1, far=100)
    depth = scene.add_viewport((800, 800)).depth()
    assert len(state.contacts) == 6
    for name, contact in state.contacts.items():
        hub = rover.links[name].world_pose
        axis = hub.rotation[:, 1]
        off_axis = np.cross(contact - hub.position, axis)
        assert np.linalg.norm(off_axis) == pytest.approx(radius[name], abs=1e-5)
        column, row = 399.5 + (contact[0] - 3) * 200, 399.5 - (contact[1] + 2) * 200
        assert 10 - depth[round(row), round(column)] == pytest.approx(contact[2], abs=2e-3)
    with pytest.raises(dspace.WrongType, match="accepted: what dspace.rover's solve"):
        rover.place((0, 0, 0))


def test_the_readmes_first_picture(tmp_path, monkeypatch):
    readme = (DATA.parent / "README.md").read_text(encoding="utf-8")
    code = readme.split("```python\n")[1].split("```")[0]
    assert len([line for line in code.splitlines() if line]) <= 10
    monkeypatch.chdir(tmp_path)
    (tmp_path / "Data").symlink_to(DATA)
    exec(compile(code, "README.md", "exec"), {})
    assert (tmp_path / "first.png").stat().st_size > 50000


def test_terrain(scene, field):
    terrain = scene.add_terrain(field, origin=(116, 216))
    assert terrain.size == (33, 33)
    x, y = np.meshgrid(np.linspace(-16, 16, 7), np.linspace(-16, 16, 5))
    np.testing.assert_allclose(terrain.height(x, y), x / 2, atol=1e-12)
    assert terrain.height(0.5, 3) == pytest.approx(0.25)
    assert np.isnan(terrain.height(100, 0))
    np.testing.assert_allclose(terrain.normal(0.3, 0.4), np.array([-0.5, 0, 1]) / np.sqrt(1.25),
                               atol=1e-12)
    assert terrain.slope_deg(0, 0) == pytest.approx(np.degrees(np.arctan(0.5)))
    assert terrain.height(117, 216, map=True) == pytest.approx(0.5)
    np.testing.assert_allclose(terrain.to_map([(1, 2, 3)]), [(117, 218, 3)], atol=1e-9)
    np.testing.assert_allclose(terrain.from_map(terrain.to_map([(1, 2, 3)])), [(1, 2, 3)])
    assert terrain.height_range == (-8, 8)
    terrain.focus([(0, 0), (3, 4)], radius=2)
    assert scene.terrains["terrain"].object == terrain.object
    terrain.remove()
    assert scene.objects == {}


def test_bad_input(scene, refused, tmp_path, triangle, field):
    scene.add_box((1, 1, 1), name="box")
    with refused(dspace.NotFound, "absent.glb"):
        scene.load("/nowhere/absent.glb")
    for name, content in (("empty.obj", b""), ("wrong.glb", b"this is no glb"),
                          ("cut.stl", b"solid x\nfacet normal 0 0"), ("no.xyz", b"1 2 3"),
                          ("broken.urdf", b"<robot name='r'><link name='a'>")):
        path = tmp_path / name
        path.write_bytes(content)
        with refused(dspace.Error, name):
            scene.load(path)
    with refused(dspace.Error, str(tmp_path)):
        scene.load(tmp_path)
    with refused(dspace.AlreadyExists, "box"):
        scene.load(triangle, name="box")
    with refused(ValueError, "scale"):
        scene.load(triangle, scale=-1)
    with refused(ValueError, "'w'"):
        scene.load(triangle, up="w")
    with refused(TypeError, "colour"):
        scene.add_box((1, 1, 1), colour=(1, 0, 0))
    with refused(dspace.InvalidArgument, "1.5"):
        scene.add_box((1, 1, 1), opacity=1.5)
    with refused(dspace.InvalidArgument, "-1"):
        scene.add_sphere(-1)
    with refused(dspace.InvalidArgument):
        scene.add_text("", 1)
    with refused(dspace.NotFound, "absent.png"):
        scene.object("box").texture = "/nowhere/absent.png"
    with refused(dspace.InvalidArgument, "camera"):
        scene.add_camera("camera", eye=(1, 2, 3), target=(1, 2, 3))
    with refused(dspace.InvalidArgument, "camera"):
        scene.add_camera("camera", near=10, far=1)
    with refused(ValueError, "accepted: one of fov_deg"):
        scene.add_camera("camera", fov_deg=40, height=3)
    with refused(dspace.NotFound, "absent.tif"):
        scene.add_terrain("/nowhere/absent.tif")
    with refused(dspace.NotFound, "absent.png"):
        scene.add_terrain(field, image="/nowhere/absent.png")
    with refused(dspace.Error, "moonoid"):
        scene.add_terrain(field, vertical_datum="moonoid")
    robot = scene.load(DATA / "rover" / "rover.urdf")
    with refused(KeyError, "flux"):
        robot.joints["flux"]
    with refused(dspace.InvalidArgument, "rocker_left"):
        robot.joints["rocker_left"].position = 1000
    with refused(dspace.InvalidArgument, "mast_mount"):
        robot.joints["mast_mount"].position = 1


def test_a_missing_mesh_is_a_warning_and_a_stand_in(scene, refused, tmp_path):
    path = tmp_path / "r.urdf"
    path.write_text('<robot name="r"><link name="a"><visual><geometry>'
                    '<mesh filename="absent.glb"/></geometry></visual></link></robot>')
    with refused(dspace.NotFound, "absent.glb"):
        scene.load(path, strict=True)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        robot = scene.load(path)
    assert [w.category for w in caught] == [dspace.DspaceWarning]
    assert "absent.glb" in str(caught[0].message) and caught[0].filename == __file__
    assert len(robot.objects) == 1 and robot.objects[0].triangles == 12


def test_mistyped_attributes_are_refused(scene):
    box = scene.add_box((1, 1, 1))
    camera = scene.add_camera(eye=(5, 0, 0), target=(0, 0, 0))
    view = scene.add_viewport(size=(16, 9))
    rover = scene.load(DATA / "rover/rover.urdf")
    for thing, name in ((scene, "tme"), (box, "colour"), (box.frame, "postion"),
                        (camera, "fov"), (view, "ornament"), (rover, "joint"),
                        (rover.joints["mast_pan"], "positon")):
        with pytest.raises(AttributeError, match=f"'{name}' does not exist; accepted: "):
            setattr(thing, name, 1.0)
        assert not hasattr(thing, name)
    with pytest.raises(AttributeError, match="'hide' is no property"):
        view.hide = True


def test_limits_allow_the_degrees_that_their_rounded_radians_stand_for(scene):
    joint = scene.load(DATA / "rover/rover.urdf").joints["arm_yaw"]  # -1.570796 to 1.570796 rad
    joint.position = 90
    assert joint.position == joint.limits[1] == pytest.approx(np.degrees(1.570796), abs=1e-12)
    with pytest.raises(dspace.Error, match="90.0001.*accepted: -89.99"):
        joint.position = 90.0001
    assert joint.position == joint.limits[1]


def test_a_urdf_is_no_point_cloud(scene):
    with pytest.raises(ValueError, match="rover.urdf.*none of these"):
        scene.load(DATA / "rover/rover.urdf", point_cloud=True)
    assert not scene.robots
