"""Change events of frames through Python: what is told, in which order, and to whom."""
import gc
import weakref

import numpy as np
import pytest

import dspace
from dspace.proto import commands_pb2 as pb

ARM = """<robot name="arm"><link name="base"/><link name="upper"/>
<joint name="shoulder" type="revolute"><parent link="base"/><child link="upper"/>
<axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint></robot>"""


class Recorder(list):
    """Notes (type, ids) of every event."""

    def __call__(self, event):
        self.append((event.type, event.ids.tolist()))

    def take(self):
        events = list(self)
        self.clear()
        return events


@pytest.fixture
def heard(scene):
    recorder = Recorder()
    recorder.token = scene.on_frame_change(recorder)
    return recorder


def test_every_change_is_told_once(scene, heard):
    a = scene.add_frame("a")
    b = a.add_frame("b")
    assert heard.take() == [("created", [a.id]), ("created", [b.id])]
    b.name = "c"
    b.position = (1, 2, 3)
    b.position = (1, 2, 3)  # no change
    b.reparent(scene.root, keep="world")
    assert heard.take() == [("renamed", [b.id]), ("poses_changed", [b.id]), ("reparented", [b.id])]
    b.reparent(a)
    a.add_frame("d")
    heard.clear()
    with pytest.raises(dspace.InvalidArgument):
        a.reparent(b)
    scene.time = 3
    assert heard == []  # refused; not about frames
    d = a["d"]
    a.remove()
    [(kind, ids)] = heard.take()
    assert kind == "removed" and ids[-1] == a.id and set(ids) == {a.id, b.id, d.id}


def test_events_say_what_they_are(scene):
    events = []
    scene.on_frame_change(events.append)
    a = scene.add_frame("a")
    a.remove()
    created, removed = events
    assert created.type == "created" and created.frames == [a] and created.scene == scene
    assert removed.type == "removed" and removed.frames == [a.id]
    assert removed.revision > created.revision > 0
    assert created.ids.dtype == np.uint64
    assert repr(created) == (f"<dspace.FrameEvent created, frame {a.id} of scene 'scene', "
                             f"revision {created.revision}>")


def test_the_change_is_made_when_it_is_told(scene):
    seen = []
    scene.on_frame_change(lambda event: seen.append(event.frames[0].path))
    a = scene.add_frame("a")
    a.name = "b"
    assert seen == ["a", "b"]


def test_thousands_of_poses_are_one_event(scene, heard):
    frames = [scene.add_frame(f"f{i}") for i in range(2000)]
    heard.clear()
    rows = np.zeros((2000, 8))
    rows[:, (0, 3, 7)] = 1
    scene.set_poses(frames, rows)
    assert heard.take() == [("poses_changed", [frame.id for frame in frames])]
    rows[7, 0] = 2
    scene.set_poses(frames, rows)
    assert heard.take() == [("poses_changed", [frames[7].id])]


def test_robots_and_joints_are_told(scene, heard, tmp_path):
    path = tmp_path / "arm.urdf"
    path.write_text(ARM)
    arm = scene.load(path)
    links = arm.links
    created = [ids for kind, ids in heard.take() if kind == "created"]
    assert created == [[arm.frame.id], [links["base"].id], [links["upper"].id]]
    arm.joints["shoulder"].position = 20
    assert heard.take() == [("poses_changed", [links["upper"].id])]
    arm.remove()
    assert heard.take() == [("removed", [links["upper"].id, links["base"].id, arm.frame.id])]


def test_commands_given_as_messages_are_told(session, scene, heard):
    command = pb.Command(scene="scene")
    command.create_frame.name = "raw"
    reply = session.execute(command)
    assert heard.take() == [("created", [reply.frame.frame])]
    assert [list(event.frame) for event in reply.frame_event] == [[reply.frame.frame]]


def test_replies_are_bare_without_listeners(session, scene):
    def events_of_a_reply(name):
        command = pb.Command(scene="scene")
        command.create_frame.name = name
        return len(session.execute(command).frame_event)

    assert events_of_a_reply("a") == 0
    first, second = scene.on_frame_change(print), scene.on_frame_change(print)
    assert scene.remove_listener(first)
    assert events_of_a_reply("b") == 1  # the second still listens
    assert scene.remove_listener(second)
    assert events_of_a_reply("c") == 0


def test_listeners_go(scene, heard):
    other = Recorder()
    token = scene.on_frame_change(other)
    assert token != heard.token
    a = scene.add_frame("a")
    assert scene.remove_listener(heard.token) and not scene.remove_listener(heard.token)
    a.name = "b"
    assert heard == [("created", [a.id])]
    assert other == [("created", [a.id]), ("renamed", [a.id])]
    with pytest.raises(TypeError, match="None"):
        scene.on_frame_change(None)


def test_callbacks_may_give_commands_and_events_stay_in_order(scene):
    late = Recorder()
    depth = [0]

    def adds_a_label(event):
        depth[0] += 1
        assert depth[0] == 1  # never inside itself
        if event.type == "created" and event.frames[0].name == "a":
            event.frames[0].add_frame("label")
            assert event.frames[0]["label"]  # at once
        depth[0] -= 1

    scene.on_frame_change(adds_a_label)
    scene.on_frame_change(late)
    a = scene.add_frame("a")
    assert late == [("created", [a.id]), ("created", [a["label"].id])]


def test_listeners_come_and_go_while_they_are_called(scene):
    calls, added = [], Recorder()

    def once(event):
        calls.append("once")
        event.frames[0].name = "b"
        scene.remove_listener(tokens[0])
        scene.remove_listener(tokens[1])
        scene.on_frame_change(added)

    tokens = [scene.on_frame_change(once), scene.on_frame_change(lambda event: calls.append("no"))]
    a = scene.add_frame("a")
    assert a.name == "b" and calls == ["once"]
    assert added == []  # both events are older than the listener
    a.name = "c"
    assert calls == ["once"] and added == [("renamed", [a.id])]


def test_a_callback_that_raises_harms_nobody(scene):
    def bad(event):
        raise KeyError(f"first {event.type}")

    def worse(event):
        raise OSError("second")

    after = Recorder()
    tokens = [scene.on_frame_change(bad), scene.on_frame_change(worse)]
    scene.on_frame_change(after)
    with pytest.raises(KeyError, match="first created"):
        scene.add_frame("a")
    a = scene["a"]  # it was made
    assert after == [("created", [a.id])]
    for token in tokens:
        scene.remove_listener(token)
    a.name = "b"
    assert after[-1] == ("renamed", [a.id])


def test_a_refused_command_in_a_callback_raises(scene):
    after = Recorder()
    scene.on_frame_change(lambda event: scene.root.remove())
    scene.on_frame_change(after)
    with pytest.raises(dspace.InvalidArgument, match="root"):
        scene.add_frame("a")
    assert after == [("created", [scene["a"].id])]


def test_what_was_made_and_taken_back_is_not_told(scene, heard, tmp_path):
    path = tmp_path / "arm.urdf"
    path.write_text(ARM.replace('<link name="base"/>', '<link name="base"><visual><geometry>'
                                '<box size="1 1 1"/></geometry></visual></link>'))
    with pytest.raises(dspace.NotFound):
        scene.load(path, fragment="no such fragment")
    a = scene.add_frame("a")
    assert heard == [("created", [a.id])]


def test_scenes_do_not_mix(session, scene, heard):
    other = session.scene("other")
    others = Recorder()
    token = other.on_frame_change(others)
    assert not scene.remove_listener(token)
    scene.add_frame("a")
    b = other.add_frame("b")
    assert len(heard) == 1 and others == [("created", [b.id])]
    assert session.scene("other").remove_listener(token)  # any handle to the scene will do


def test_a_removed_scene_forgets_its_listeners(session, scene, heard):
    other = session.scene("other")
    others = Recorder()
    token = other.on_frame_change(others)
    other.remove()
    assert not other.remove_listener(token)
    with pytest.raises(dspace.NotFound, match="other"):
        other.on_frame_change(others)
    session.scene("other").add_frame("a")
    a = scene.add_frame("a")
    assert others == [] and heard == [("created", [a.id])]


def test_a_closed_session_forgets_its_listeners():
    session = dspace.Session()
    scene = session.scene()
    recorder = Recorder()

    class Callback:
        def __call__(self, event):
            recorder(event)

    callback = Callback()
    gone = weakref.ref(callback)
    token = scene.on_frame_change(callback)
    del callback
    assert gone() is not None
    session.close()
    gc.collect()
    assert gone() is None
    assert not scene.remove_listener(token)
    with pytest.raises(RuntimeError, match="closed"):
        scene.on_frame_change(recorder)


def test_a_callback_may_close_the_session():
    session = dspace.Session()
    scene = session.scene()
    recorder = Recorder()
    scene.on_frame_change(lambda event: session.close())
    scene.on_frame_change(recorder)
    scene.add_frame("a")
    assert recorder == []
    assert "closed" in repr(session)
