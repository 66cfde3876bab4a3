"""Telemetry, events and questions: in a session, over the wire, in tables over pictures."""
import math

import numpy as np
import pytest

import dspace
from dspace.proto import commands_pb2 as pb
from served_support import Served


def test_channels_hold_values_with_units_and_limits(scene):
    power = scene.telemetry.add("rover/power", unit="W", description="of the bus", warning_low=20, alarm_low=5)
    mode = scene.telemetry.add("rover/mode", labels=["idle", "drive"])
    note = scene.telemetry.add("note", kind="text")
    assert math.isnan(power.value) and mode.value is None and note.value is None and power.time is None
    scene.time = 4.0
    scene.telemetry.set({"rover/power": 12.5, mode: "drive", "note": "all well"})
    assert (power.value, power.unit, power.description, power.time, power.state) == (
        12.5, "W", "of the bus", 4.0, "warning")
    assert scene.telemetry.read() == {"note": "all well", "rover/mode": "drive", "rover/power": 12.5}
    assert scene.telemetry.read("rover") == {"rover/mode": "drive", "rover/power": 12.5}
    assert list(scene.telemetry) == ["note", "rover/mode", "rover/power"] and len(scene.telemetry) == 3
    assert scene.telemetry["rover/power"] == power and "x" not in scene.telemetry
    assert [each.name for each in scene.telemetry.below("rover")] == ["rover/mode", "rover/power"]
    assert (mode.kind, mode.labels, power.limits) == ("choice", {0: "idle", 1: "drive"},
                                                      {"alarm_low": 5.0, "warning_low": 20.0})
    power.set_limits(alarm_high=10.0)
    assert power.state == "alarm" and power.limits == {"alarm_high": 10.0}
    scene.time = 5.0
    power.value = 12.5
    assert power.time == 4.0  # it has not changed
    power.value = math.nan
    mode.value = None
    assert (power.state, mode.state, power.time) == ("no value", "no value", 5.0)
    scene.telemetry.set([power, "rover/mode"], np.array([3.0, 0.0]))
    assert (power.value, mode.value) == (3.0, "idle")
    scene.telemetry.set(np.array([mode.id, power.id]), np.array([1.0, 4.0]))
    assert (power.value, mode.value) == (4.0, "drive")
    power.remove()
    assert "rover/power" not in scene.telemetry
    assert scene.telemetry.add("rover/power").id > note.id
    with pytest.raises(dspace.NotFound, match="no such channel"):
        power.value = 1.0


def test_what_is_refused_changes_nothing(scene):
    scene.telemetry.add("a", value=1.0)
    scene.telemetry.add("mode", labels={3: "on"})
    for kind, text, call in (
            (dspace.InvalidArgument, "inf", lambda: scene.telemetry.set({"a": 2.0, "mode": math.inf})),
            (dspace.NotFound, "'b'", lambda: scene.telemetry.set({"a": 2.0, "b": 3.0})),
            (dspace.WrongType, "'a'", lambda: scene.telemetry.set({"a": "2"})),
            (dspace.InvalidArgument, "'on'", lambda: scene.telemetry.set({"a": 2.0, "mode": "off"})),
            (dspace.InvalidArgument, "shape", lambda: scene.telemetry.set(["a"], [2.0, 3.0])),
            (dspace.InvalidArgument, "an id", lambda: scene.telemetry.set(np.array([-1]), [2.0])),
            (dspace.NotFound, "99", lambda: scene.telemetry.set(np.array([1, 99]), [2.0, 3.0])),
            (dspace.WrongType, "a dict", lambda: scene.telemetry.set(3.0)),
            (dspace.AlreadyExists, "'a'", lambda: scene.telemetry.add("a")),
            (dspace.InvalidArgument, "kind", lambda: scene.telemetry.add("b", kind="number?")),
            (dspace.InvalidArgument, "part of its name", lambda: scene.telemetry.add("b//c")),
            (dspace.InvalidArgument, "alarm_low", lambda: scene.telemetry.add("b", alarm_low=math.nan)),
            (dspace.InvalidArgument, "below", lambda: scene.telemetry.add("b", alarm_low=2, alarm_high=1))):
        with pytest.raises(kind, match=text):
            call()
        assert scene.telemetry.read() == {"a": 1.0, "mode": None}


def test_a_scene_made_anew_is_not_taken_for_the_old_one(session):
    scene = session.scene("one")
    scene.telemetry.add("first")
    scene.telemetry.set({"first": 1.0})
    scene.remove()
    scene = session.scene("one")
    scene.telemetry.add("second")
    with pytest.raises(dspace.NotFound):
        scene.telemetry.set({"first": 2.0})
    assert math.isnan(scene.telemetry["second"].value)


def test_events_are_kept_with_time_place_and_data(scene):
    rover = scene.add_frame("rover")
    scene.time = 2.5
    event = scene.log_event("contact", "left wheel", severity="caution", frame=rover, position=(0, 1, 2),
                            data={"force": (12.0, "N"), "surface": "rock", "count": 3})
    assert (event.number, event.time, event.kind, event.text, event.severity, event.frame, event.frame_path) == (
        1, 2.5, "contact", "left wheel", "caution", rover, "rover")
    assert event.position.tolist() == [0, 1, 2]
    assert event.data == {"force": 12.0, "surface": "rock", "count": 3.0} and event.units == {"force": "N"}
    scene.time = 3.0
    scene.log_event("fault", severity="alarm")
    rover.remove()
    assert [each.kind for each in scene.events()] == ["contact", "fault"]
    assert scene.events()[0].frame is None and scene.events()[0].frame_path == "rover"
    assert [each.number for each in scene.events(after=1)] == [2]
    assert [each.number for each in scene.events(until=2.5)] == [1]
    assert [each.number for each in scene.events(kind=["contact", "x"])] == [1]
    assert [each.number for each in scene.events(severity="warning")] == [2]
    assert [each.number for each in scene.events(most=1)] == [2]
    with pytest.raises(dspace.InvalidArgument, match="severity"):
        scene.log_event("x", severity="dreadful")
    with pytest.raises(dspace.InvalidArgument, match="no frame"):
        scene.log_event("x", position=(0, 0, 0))
    assert len(scene.events()) == 2


def test_questions_of_a_session_of_ones_own(session, scene):
    question = scene.ask("go", "Go on?", choices=["yes", "no"], severity="caution")
    assert [(each.name, each.text, each.choices) for each in scene.questions] == [("go", "Go on?", ["yes", "no"])]
    with pytest.raises(dspace.DeadlineExceeded, match="'go'"):
        question.wait(0.02)
    session.answer("go", "perhaps")  # none of the choices
    session.answer("other", "yes")
    with pytest.raises(dspace.InvalidArgument, match="'yes', 'no'"):
        scene.questions[0].reply("perhaps")
    scene.questions[0].reply("no")
    assert question.wait(10) == "no" and question.answer == "no"
    assert scene.questions == []
    again = scene.ask("go", "Once more?")
    again.withdraw()
    again.withdraw()
    assert scene.questions == [] and again.answer is None


def test_viewers_hear_all_of_it_and_answer(tmp_path):
    with Served(tmp_path) as server, dspace.connect(server.address) as session:
        scene = session.scene()
        power = scene.telemetry.add("rover/power", unit="W", value=1.0)
        camera = scene.add_camera("main", eye=(6.0, 0.0, 2.0), target=(0.0, 0.0, 0.0))
        viewport = scene.add_viewport((160, 60), camera, name="view")
        viewport.set_table("live", [("power", (power, 2))])
        with dspace.watch(server.address, name="console") as early:
            session.wait = False
            for step in range(100):
                scene.time = 0.1 * step
                scene.telemetry.set({"rover/power": float(step // 10)})
            session.flush()
            session.wait = True
            assert power.value == 9.0 and power.time == 9.0  # it changed 90 steps in
            scene.log_event("staging", "second stage", data={"mass": (3.5, "kg")})
            question = scene.ask("go", "Land here?", ["yes", "no"])
            wanted = viewport.image()
            with dspace.watch(server.address) as late:  # from a snapshot
                for watcher in (early, late):
                    while "scene" not in watcher.scenes or not watcher.scenes["scene"].questions:
                        assert watcher.update(20.0), watcher.error
                    seen = watcher.scenes["scene"]
                    assert seen.telemetry.read() == {"rover/power": 9.0}
                    assert (seen.telemetry["rover/power"].time, seen.telemetry["rover/power"].unit) == (9.0, "W")
                    assert [(e.number, e.kind, e.text, e.data) for e in seen.events()] == [
                        (1, "staging", "second stage", {"mass": 3.5})]
                    assert np.array_equal(watcher.viewports["view"].image(), wanted)
                    assert watcher.error == ""
                    with pytest.raises(dspace.Unsupported):
                        seen.telemetry.set({"rover/power": 1.0})
                early.scenes["scene"].questions[0].reply("yes")
                assert (question.wait(30), question.who) == ("yes", "console")
                while early.scenes["scene"].questions:
                    assert early.update(20.0)


def test_values_that_the_server_has_are_not_sent_again(tmp_path):
    """Silent commands are refused later: one that was left out is not refused at all."""
    with Served(tmp_path) as server, dspace.connect(server.address) as session:
        scene = session.scene()
        channel = scene.telemetry.add("a", value=1.0)
        with dspace.watch(server.address) as watcher:
            while not watcher.sequence:
                watcher.update(20.0)
            before = watcher.sequence
            for _ in range(50):
                scene.telemetry.set({channel: 1.0})
            scene.telemetry.set({channel: 2.0})
            while watcher.scenes["scene"].telemetry["a"].value != 2.0:
                assert watcher.update(20.0)
            assert watcher.sequence - before == 1
        other = pb.Command()
        other.remove_telemetry.id.append(channel.id)
        session.execute(other)
        with pytest.raises(dspace.NotFound):  # and what was removed is not taken for being there
            scene.telemetry.set({channel: 2.0})


def test_tables_show_what_is_there_when_they_are_drawn(session, scene):
    camera = scene.add_camera(eye=(3, 3, 3), target=(0, 0, 0))
    power = scene.telemetry.add("power", unit="W")
    mode = scene.telemetry.add("mode", labels=["idle", "drive"])
    note = scene.telemetry.add("note", kind="text")
    live = scene.add_viewport((240, 100), camera, name="live")
    still = scene.add_viewport((240, 100), camera, name="still")
    live.set_table("t", [("power", (power, 1)), ("mode", mode), ("note", note), ("plain", 3)])

    def same(*values):
        still.set_table("t", list(zip(("power", "mode", "note", "plain"), (*values, 3))))
        return np.array_equal(live.image(), still.image())

    assert same("–", "–", "–") and not same("–", "–", "x")
    scene.telemetry.set({power: 12.345, mode: "drive", note: "ok"})
    assert same("12.3 W", "drive", "ok")
    drawn = session.statistics["frames_drawn"]
    scene.telemetry.set({power: 12.345})
    live.image()
    assert session.statistics["frames_drawn"] == drawn  # nothing has changed
    note.value = "漢字 is not in the font"
    assert same("12.3 W", "drive", "?? is not in the font")
    note.value = "x" * 4096
    assert same("12.3 W", "drive", "x" * 200 + "...") or same("?", "?", "?")
    note.value = "short"
    power.value = math.nan
    assert same("–", "drive", "short")
    mode.remove()
    assert same("–", "–", "short")
    live.set_table("t", [("power", 7), ("mode", 8), ("note", 9), ("plain", 3)])
    note.value = "gone"
    assert same(7, 8, 9)
    with pytest.raises(dspace.InvalidArgument, match="digits"):
        live.set_table("t", [("power", (power, 16))])


def test_numbers_beyond_their_limits_are_in_colour(session):
    scene = session.scene()
    camera = scene.add_camera("main", eye=(6.0, 0.0, 2.0), target=(0.0, 0.0, 0.0))
    power = scene.telemetry.add("power", unit="W", alarm_low=-5.0, warning_high=10.0, alarm_high=20.0)
    other = scene.telemetry.add("other", value=1.5)
    live = scene.add_viewport((420, 120), camera, name="live")
    still = scene.add_viewport((420, 120), camera, name="still")
    live.set_table("t", [("power", (power, 0)), ("other", other)], font_size=36)

    def beyond(shown):
        """Colours of the power's value where it is all ink; all else is as in a plain table."""
        still.set_table("t", [("power", shown), ("other", 1.5)], font_size=36)
        plain, picture = still.image()[..., :3].astype(int), live.image()[..., :3].astype(int)
        still.set_table("t", [("power", " " * len(shown)), ("other", 1.5)], font_size=36)
        value = np.any(plain != still.image()[..., :3], axis=2)
        assert value.sum() > 50 and abs(picture - plain)[~value].max() <= 1  # each colour is rounded apart
        return {tuple(pixel) for pixel in picture[value & (plain == 255).all(axis=2)]}

    white, amber, red = {(255, 255, 255)}, {(255, 191, 51)}, {(255, 89, 76)}
    assert beyond("–") == white  # no value lies beyond nothing
    for value, color in ((7, white), (10, white), (11, amber), (20, amber), (21, red), (-5, white), (-6, red)):
        power.value = value
        assert beyond(f"{value} W") == color
    power.set_limits(alarm_high=5.0)
    assert beyond("-6 W") == white
    power.value = 6
    assert beyond("6 W") == red


@pytest.mark.parametrize("bad", ("x" * 4097, "é" * 2049, "a\tb", "a\u0085b", "a\u200bb"), ids=range(5))
def test_a_text_that_is_refused_sets_no_number(scene, bad):
    power, note = scene.telemetry.add("power", value=2.0), scene.telemetry.add("note", kind="text", value="a")
    with pytest.raises(dspace.InvalidArgument, match="note"):
        scene.telemetry.set({power: 1.0, note: bad})
    assert (power.value, note.value) == (2.0, "a")
    scene.telemetry.set({power: 1.0, note: "é" * 2048})
    assert (power.value, note.value) == (1.0, "é" * 2048)
