"""What the bars of views do: cameras of their own, chases, copies, and maps in step."""
import math
import pathlib
import os

import numpy as np
import pytest

import dspace
from dspace.application import App
from test_application import Host


@pytest.fixture
def app():
    app = App(Host())
    yield app
    app.close()


@pytest.fixture
def data():
    return pathlib.Path(os.environ.get("DSPACE_SHIPPED_DATA") or pathlib.Path(__file__).resolve().parents[3] / "Data")


def told(app, what):
    return [each for each in app._host.extended if each["do"] == "views" and each["what"] == what]


def test_a_split_view_looks_the_same_and_moves_alone(app):
    app.scene.add_box((1, 1, 1), fragment=app.scene.add_fragment("hardware"))
    first = app.new_view()
    first.camera.look_at(eye=(2, 3, 4), target=(0, 0, 0))
    first.set(shadows=True, exposure=2.0)
    first.samples, first.navigation, first.ornaments = 3, "walk", False
    first.hide("hardware")
    second = app.split_view(first, "below")
    assert second.name == "view 2" and app.views["view 2"] == second
    assert told(app, "split") == [{"do": "views", "what": "split", "view": "view 2", "beside": "view 1", "side": "below"}]
    assert (second.samples, second.navigation, second.ornaments, second.shadows, second.exposure) == (3, "walk", False,
                                                                                                        True, 2.0)
    assert second.hidden_fragments == ["hardware"]
    assert second.camera != first.camera and second.camera.pose_in().position == pytest.approx((2, 3, 4))
    second.camera.look_at(eye=(9, 9, 9), target=(0, 0, 0))
    assert first.camera.pose_in().position == pytest.approx((2, 3, 4))


def test_a_view_of_a_recording_gets_its_own_camera(app, tmp_path):
    path = tmp_path / "run.dspace"
    with dspace.Session() as session, session.record(path):
        scene = session.scene()
        scene.add_box((1, 1, 1))
        scene.add_viewport((64, 48), scene.add_camera("fixed", eye=(3, 3, 3), target=(0, 0, 0)), name="main")
        scene.time = 1.0
        scene.time = 2.0
    run = app.open(path)
    view = app.views["viewer:main"]
    app.fit(view)
    assert view.camera.vantage == "viewer:main"
    recorded = run.session.scenes["scene"].vantages["main"].cameras["fixed"]
    assert recorded.pose_in().position == pytest.approx((3, 3, 3))
    assert not np.allclose(view.camera.pose_in().position, (3, 3, 3))
    run.seek(2.0)
    run.seek(1.0)
    assert view.camera.vantage == "viewer:main"
    other = app.split_view(view)
    assert other.name.startswith("viewer:") and other.camera.vantage == other.name


def test_a_chase_is_as_far_away_as_the_thing_is_large(app):
    frame = app.scene.add_frame("rover", position=(10, 0, 0))
    app.scene.add_sphere(2.0, frame=frame)
    view = app.new_view()
    app.chase(view, "rover")
    away = np.linalg.norm(np.array(view.camera.pose_in().position) - (10, 0, 0))
    assert 4.0 < away < 12.0  # a sphere of 2 m fills 45 degrees from 5.2 m
    frame.pose = dspace.Pose((20, 0, 0))
    moved = np.linalg.norm(np.array(view.camera.pose_in().position) - (20, 0, 0))
    assert moved == pytest.approx(away)
    app.chase(view, None)
    before = view.camera.pose_in()
    frame.pose = dspace.Pose((30, 0, 0))
    assert view.camera.pose_in() == before
    with pytest.raises(dspace.NotFound):
        app.chase(view, "no/such/frame")


def test_a_map_shows_the_ground_that_the_view_looks_at(app, data):
    terrain = app.scene.add_terrain(data / "field" / "field.tif", mode="clipmap")
    view = app.new_view()
    height = float(terrain.height(4.0, -3.0))
    view.camera.look_at(eye=(4.0, -13.0, height + 10.0), target=(4.0, -3.0, height))
    link = app.open_map(view)
    camera = link.map.camera
    # The centre's ray meets the ground where the view's does.
    pose = camera.pose_in()
    target, _, distance = link._ground()
    assert target[:2] == pytest.approx((4.0, -3.0), abs=0.3)  # another slope of the ground may come first
    assert pose.position[:2] == pytest.approx(target[:2], abs=1e-9)
    assert pose.rotation @ (0, 0, 1) == pytest.approx((0, 0, -1))  # down
    assert pose.rotation @ (0, -1, 0) == pytest.approx((0, 1, 0))  # north is up
    assert camera.projection["height"] == pytest.approx(4 * distance * math.tan(math.radians(22.5)))
    assert link.map.navigation == "map"


def test_a_map_and_its_view_move_each_other(app):
    app.scene.add_box((1, 1, 1))
    view = app.new_view()
    view.camera.look_at(eye=(0, -10, 10), target=(0, 0, 0))
    link = app.open_map(view)
    watched = {each["view"] for each in told(app, "watch") if each["on"]}
    assert watched == {view.name, link.map.name}
    assert link.map.camera.pose_in().position[:2] == pytest.approx((0, 0), abs=1e-9)
    view.camera.look_at(eye=(7, -10, 10), target=(7, 3, 0))
    app._drawn(view.name)
    assert link.map.camera.pose_in().position[:2] == pytest.approx((7, 3), abs=1e-9)
    app._drawn(link.map.name)  # its own picture changes nothing
    assert view.camera.pose_in().position == pytest.approx((7, -10, 10))
    # A pan and a zoom of the map.
    pose, turned = link.map.camera.pose_in(), view.camera.pose_in().quaternion
    link.map.camera.attach(None, dspace.Pose(np.array(pose.position) + (2.0, -5.0, 0.0), pose.quaternion))
    link.map.camera.set_projection(height=33.0)
    app._drawn(link.map.name)
    assert view.camera.pose_in().position == pytest.approx((9, -15, 10))
    assert view.camera.pose_in().quaternion == pytest.approx(turned)
    app._drawn(view.name)  # the view's own picture after it
    assert link.map.camera.pose_in().position[:2] == pytest.approx((9, -2), abs=1e-9)
    assert link.map.camera.projection["height"] == pytest.approx(33.0)
    link.close()
    assert app._watched == {} and app.map_links == []
    view.camera.look_at(eye=(0, -10, 10), target=(0, 0, 0))
    app._drawn(view.name)
    assert link.map.camera.pose_in().position[:2] == pytest.approx((9, -2), abs=1e-9)
    with pytest.raises(dspace.InvalidArgument, match="another one than the map"):
        app.link_map(view, view)


def test_a_map_of_a_body_has_north_up(app):
    """On a sphere: the map's up is the direction to the pole along the surface."""
    from dspace.application.views import MapLink

    class Body:
        on_body = True
        frame = app.scene.root

    link = MapLink.__new__(MapLink)
    link.view = type("View", (), {"scene": type("Scene", (), {"terrains": {"body": Body()}, "root": app.scene.root})()})()
    longitude, latitude = math.radians(30), math.radians(40)
    up = np.array((math.cos(latitude) * math.cos(longitude), math.cos(latitude) * math.sin(longitude),
                   math.sin(latitude)))
    north = np.array((-math.sin(latitude) * math.cos(longitude), -math.sin(latitude) * math.sin(longitude),
                      math.cos(latitude)))
    assert link._north(up) == pytest.approx(north)
    assert link._up(Body(), 1737400.0 * up) == pytest.approx(up)
    assert np.linalg.norm(link._north(np.array((0.0, 0.0, 1.0)))) == pytest.approx(1.0)  # at the pole any


def test_closing_a_view_ends_its_links(app):
    view = app.new_view()
    link = app.open_map(view)
    app.close_view(link.map)
    assert app.map_links == [] and app.views == {"view 1": view}
    with pytest.raises(dspace.WrongType, match="a dspace.Viewport"):
        app.fit("view 1")
