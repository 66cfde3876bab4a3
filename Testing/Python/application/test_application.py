"""What the menus of DspaceQt do, with a stand-in for its windows."""
import json
import os
import pathlib

import numpy as np
import pytest

import dspace
from dspace import vtk
from dspace.application import App
from dspace.application.demo import Drive
from dspace.application.link import LinkClient
from dspace.proto.service_pb2 import ViewerEvent


class Host:
    """The part of the program that Python calls."""

    def __init__(self):
        self.made = vtk.vtkDspaceSession()
        self.shown, self.messages, self.timers, self.asked, self.tasks = [], [], {}, [], {}
        self.extended, self.activated, self.breaths = [], None, 0

    def session(self):
        return self.made

    def execute(self, command):
        return self.made.Execute(command)

    def breathe(self):
        self.breaths += 1
        return True

    def show(self, shown, name, title):
        session = shown.GetSession() if hasattr(shown, "GetSession") else shown
        assert session.GetViewport(name) is not None
        self.shown.append((name, title))

    def close(self, session, name):
        self.shown = [shown for shown in self.shown if shown[0] != name]

    def follow(self, shown, title):
        pass

    def extend(self, request):
        self.extended.append(json.loads(request))
        return "{}"

    def active(self):
        return self.activated or (self.made, "scene")

    def task(self, number, text, done, cancel):
        self.tasks[number] = text

    def forget(self, shown):
        self.shown = []

    def clock(self, shown, what, a, b):
        self.asked.append((what, a, b))

    def message(self, text):
        self.messages.append(text)

    def every(self, milliseconds, function):
        self.timers[len(self.timers) + 1] = (milliseconds, function)
        return len(self.timers)

    def cancel(self, number):
        self.timers.pop(number, None)


@pytest.fixture
def app():
    app = App(Host())
    yield app
    app.close()


@pytest.fixture
def data():
    return pathlib.Path(os.environ.get("DSPACE_SHIPPED_DATA") or pathlib.Path(__file__).resolve().parents[3] / "Data")


def lit(view):
    """The share of the picture's pixels that show something."""
    view.size = (160, 100)
    return float(np.mean(view.image().max(axis=2) > 20))


def test_a_model_is_opened_and_fills_a_view(app, data):
    robot = app.open(data / "rover" / "rover.urdf")
    assert app.open(data / "rover" / "rover.urdf").name == "rover 2"  # beside the first, as in the demo's scene
    assert app.open(data / "rover" / "rover.urdf").name == "rover 3"
    assert isinstance(robot, dspace.Robot)
    assert app._host.shown == [("view 1", "view 1")]
    assert lit(app.view) > 0.1
    app.open(data / "rover" / "arm_turret.glb")
    assert len(app.views) == 1  # the same view


def test_a_raster_is_opened_as_terrain_before_the_camera(app, data):
    terrain = app.open(data / "field" / "field.tif")
    assert isinstance(terrain, dspace.Terrain)
    pick = app.view.pick(*(side // 2 for side in app.view.size))
    assert pick.object.name == terrain.name
    assert lit(app.view) > 0.3


def test_a_recording_is_opened_with_its_views(app, tmp_path):
    path = tmp_path / "run.dspace"
    with dspace.Session() as session:
        with session.record(path):
            scene = session.scene()
            scene.add_box((1, 1, 1))
            scene.add_viewport((64, 48), scene.add_camera(eye=(3, 3, 3), target=(0, 0, 0)), name="recorded")
            scene.time = 1.0
            for i in range(2, 8):
                scene.time = float(i)
    run = app.open(path)
    assert isinstance(run, dspace.Playback)
    assert app._host.shown == [("viewer:recorded", "run.dspace: recorded")]
    view = app.views["viewer:recorded"]
    assert np.array_equal(view.image(), run.session.viewports["recorded"].image())
    # A camera of one's own stays when the recording moves back.
    view.event("wheel", 32, 24, wheel=3)
    moved = view.camera.pose
    assert not np.allclose(moved.position, (3, 3, 3))
    assert run.seek(6.5) == 6.0 and run.time == 6.0 and run.index == run.times.index(6.0)
    assert run.seek(2.0) == 2.0
    assert np.array_equal(view.camera.pose.position, moved.position)
    assert run.step(2) == 2 and run.time == 4.0
    assert run.session.scenes["scene"].time == 4.0
    with dspace.Playback(path) as plain:
        assert plain.seek(4.0) == 4.0 and plain.times == run.times
        assert np.array_equal(plain.session.viewports["recorded"].image(), run.session.viewports["recorded"].image())
    run.play(-2.0)
    run.loop(2, 3)
    assert app._host.asked == [("speed", -2.0, 0.0), ("play", 1.0, 0.0), ("loop", 2.0, 3.0)]
    with pytest.raises(dspace.Unsupported, match="App.every"):
        run.play(until=3.0)
    run.close()
    assert app.views == {} and app.runs == [] and app.view is None
    run.close()
    with pytest.raises(dspace.Unsupported, match="not a recording"):
        odd = tmp_path / "odd.dspace"
        odd.write_text("nothing")
        app.open(odd)
    assert app.runs == []


def test_new_views_look_as_the_latest_one_does(app):
    app.scene.add_box((1, 1, 1))
    first = app.new_view()
    first.camera.look_at(eye=(2, 3, 4), target=(0, 0, 0))
    second = app.new_view(title="again")
    assert app._host.shown == [("view 1", "view 1"), ("view 2", "again")]
    assert np.allclose(second.camera.pose.position, (2, 3, 4))
    app.close_view(second)
    assert app.view == first and "view 2" not in app.session.viewports


def test_what_cannot_be_opened_is_said(app, tmp_path):
    with pytest.raises(dspace.NotFound, match="there is no such file"):
        app.open(tmp_path / "nothing.glb")
    odd = tmp_path / "odd.qqq"
    odd.write_text("")
    with pytest.raises(dspace.Unsupported, match="its name says no format"):
        app.open(odd)
    with pytest.raises(dspace.InvalidArgument, match="seconds"):
        app.every(0.0, lambda: None)
    with pytest.raises(dspace.WrongType, match="one without arguments"):
        app.every(1.0, 3)
    assert app._host.shown == [] and app._host.timers == {}


def wheel_places(drive, time):
    """x, y of the wheels' centres at a time of the drive."""
    state = drive.vehicle.solve(drive.way.pose(time), drive._floor)
    return [centre[:2] for centre in state.wheel_centers.values()]


def test_the_demo_drives_on_the_ground(app, data, monkeypatch):
    clock = iter(np.arange(1000) * 0.05)
    monkeypatch.setattr("dspace.application.demo.time.monotonic", lambda: float(next(clock)))
    drive = app.demo()
    assert isinstance(drive, Drive) and [name for name, _ in app._host.shown] == ["chase", "mast"]
    milliseconds, step = app._host.timers[1]
    assert milliseconds == 50
    for _ in range(20):
        step()
    assert app.scene.time == pytest.approx(1.0)
    telemetry = app.scene.telemetry
    assert telemetry["rover/odometer"].value == pytest.approx(0.3)  # 1 s, in which it comes to speed
    assert 0.0 < telemetry["rover/tilt"].value < 20.0
    # It drives forwards: its own X axis is along the route.
    here, ahead = drive.way.pose(1.0), drive.way.pose(1.5)
    w, x, y, z = app.scene.robots["dspace_rover"].pose.quaternion
    forward = np.array([1 - 2 * (y * y + z * z), 2 * (x * y + w * z)])
    along = np.array([ahead.x - here.x, ahead.y - here.y])
    assert forward @ along / np.linalg.norm(along) == pytest.approx(1.0, abs=0.05)
    position = app.scene.frames["follow"].pose.position
    assert np.hypot(position[0] - here.x, position[1] - here.y) < 0.2
    assert position[2] == pytest.approx(drive.terrain.height(*position[:2]), abs=1e-3)
    # Its wheels leave ruts; it begins anew at the end, on ground without them.
    for _ in range(40):
        step()
    depths = [drive.terrain.undisturbed.height(*p) - drive.terrain.height(*p) for p in wheel_places(drive, 2.8)]
    assert min(depths) > 0.03  # the sinkage is 0.04 m
    drive._time = drive.way.duration + 1.0
    step()
    assert telemetry["rover/odometer"].value == 0.0
    assert app.scene.time == pytest.approx(drive.way.duration + 1.0)
    depths = [drive.terrain.undisturbed.height(*p) - drive.terrain.height(*p) for p in wheel_places(drive, 2.8)]
    assert max(depths) < 1e-3
    assert lit(app.views["chase"]) > 0.3
    drive.stop()
    assert app._host.timers == {}


def test_questions_are_answered_and_points_are_sent_as_goals(app, tmp_path):
    asked = app.scene.ask("go", "Deploy?", choices=["yes", "no"])
    app.answer("go", "no")
    assert asked.answer == "no"
    heard = []
    app.session.on_event(lambda event: heard.append(event.dragged), "dragged")
    app.send_goal((1, 2, 3))
    app.send_goal((0, 0, 4), goal="tool")
    assert [(each.scene, each.goal, each.done) for each in heard] == [("scene", "goal", True), ("scene", "tool", True)]
    assert (heard[0].pose.position.x, heard[0].pose.position.y, heard[0].pose.position.z) == (1, 2, 3)
    with pytest.raises(dspace.Error):
        app.send_goal("here")
    path = tmp_path / "asked.dspace"
    with dspace.Session() as session, session.record(path):
        scene = session.scene()
        scene.ask("go", "Deploy?")
        scene.time = 1.0
    run = app.open(path)
    app._host.activated = (run._player, "scene")
    for send in (lambda: app.answer("go", "yes"), lambda: app.send_goal((0, 0, 0))):
        with pytest.raises(dspace.Unsupported, match="recording"):
            send()


def test_an_event_that_nobody_takes_is_rejected_at_once():
    watcher = vtk.vtkDspaceWatcher()
    client = LinkClient(watcher)
    event = ViewerEvent()
    event.answer.question = "go"
    with pytest.raises(dspace.Unsupported, match="SetInBackground"):
        client.send_event(event)
    watcher.SetInBackground(True)
    with pytest.raises(dspace.NotFound, match="no driver"):
        client.send_event(event)
    client.close()
