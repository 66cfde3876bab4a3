"""Telemetry, events and questions: in a session, over the wire, in tables, recordings and their snapshots."""
import csv
import math
import sqlite3
import subprocess
import sys

import numpy as np
import pytest

import dspace
from dspace.session import commands_pb2 as pb
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
                        assert watcher.update(20.0), watcher.trouble
                    seen = watcher.scenes["scene"]
                    assert seen.telemetry.read() == {"rover/power": 9.0}
                    assert (seen.telemetry["rover/power"].time, seen.telemetry["rover/power"].unit) == (9.0, "W")
                    assert [(e.number, e.kind, e.text, e.data) for e in seen.events()] == [
                        (1, "staging", "second stage", {"mass": 3.5})]
                    assert np.array_equal(watcher.viewports["view"].image(), wanted)
                    assert watcher.trouble == ""
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


# --- Recordings ------------------------------------------------------------------------------------

@pytest.fixture
def run(tmp_path):
    """A recording of ten seconds, begun after the first value."""
    path = tmp_path / "run.dspace"
    with dspace.Session() as session:
        scene = session.scene()
        camera = scene.add_camera("main", eye=(3, 3, 3), target=(0, 0, 0))
        power = scene.telemetry.add("rover/power", unit="W")
        mode = scene.telemetry.add("rover/mode", labels={0: "idle", 7: "drive"})
        note = scene.telemetry.add("note", kind="text")
        viewport = scene.add_viewport((200, 60), camera, name="view")
        viewport.set_table("t", [("power", (power, 1)), ("mode", mode)])
        scene.time = -1.0
        power.value = 100.0
        scene.log_event("mode", "before it was recorded")
        pictures = {}
        with session.record(path):
            for i in range(10):
                scene.time = float(i)
                scene.telemetry.set({power: i * i, mode: "drive" if i > 4 else "idle"})
                if i == 3:
                    scene.log_event("contact", "two\nlines", frame=scene.root, data={"force": (2.5, "N")})
                if i == 7:
                    note.value = "seven"
                if i == 8:
                    note.remove()
                pictures[i] = viewport.image()
    return path, pictures


def test_a_playback_has_series_and_events(run):
    path, pictures = run
    with dspace.Playback(path) as playback:
        times, values = playback.telemetry("rover/power")
        assert times.tolist() == [-1.0, *range(10)] and values.tolist() == [100.0, *(i * i for i in range(10))]
        power = playback.telemetry("rover/power")
        assert (power.unit, power.at(3.5), power.at(-0.5)) == ("W", 9.0, 100.0) and math.isnan(power.at(-2.0))
        mode = playback.telemetry("rover/mode")
        assert mode.labels == {0: "idle", 7: "drive"} and mode.values.tolist() == [0.0] * 5 + [7.0] * 5
        note = playback.telemetry("note")
        assert note.times.tolist() == [7.0, 8.0] and note.values.tolist() == ["seven", None]
        assert sorted(playback.telemetry()) == ["note", "rover/mode", "rover/power"]
        assert [(e.number, e.time, e.kind, e.data) for e in playback.events()] == [
            (1, -1.0, "mode", {}), (2, 3.0, "contact", {"force": 2.5})]
        with pytest.raises(dspace.NotFound, match="'rover/power'"):
            playback.telemetry("power")
        for at in (9, 2, 5):  # the live table too, to the byte
            playback.seek(at)
            scene = playback.session.scenes["scene"]
            assert scene.telemetry["rover/power"].value == at * at
            assert np.array_equal(playback.session.viewports["view"].image(), pictures[at])


def test_a_channel_that_changes_its_unit_is_no_series(tmp_path):
    path = tmp_path / "run.dspace"
    with dspace.Session() as session:
        scene = session.scene()
        with session.record(path):
            for unit in ("W", "W", "kW"):
                channel = scene.telemetry.add("power", unit=unit, value=1.0)
                channel.remove()
    with dspace.Playback(path) as playback, pytest.raises(dspace.Unsupported, match="'W', then 'kW'"):
        playback.telemetry("power")


def log(*arguments):
    return subprocess.run([sys.executable, "-W", "ignore", "-m", "dspace", "log", *map(str, arguments)],
                          capture_output=True, text=True)


def test_tables_of_a_recording(run, tmp_path):
    path, _ = run
    said = log("telemetry", path).stdout.splitlines()
    assert [line.split()[0] for line in said] == ["note", "rover/mode", "rover/power"]
    assert " ".join(said[2].split()) == "rover/power [W] 11 values, -1 to 9 s, 0 to 100"
    out = tmp_path / "out.csv"
    assert log("telemetry", path, "--name", "rover", "--csv", out).returncode == 0
    rows = list(csv.DictReader(open(out, newline="")))
    assert len(rows) == 21 and rows[0] == {"time_s": "-1.0", "name": "rover/power", "value": "100.0", "unit": "W"}
    assert [row["value"] for row in rows if row["name"] == "rover/mode"] == ["idle"] * 5 + ["drive"] * 5
    assert [float(row["time_s"]) for row in rows] == sorted(float(row["time_s"]) for row in rows)
    again = log("telemetry", path, "--csv", out)
    assert again.returncode == 1 and str(out) in again.stderr and len(again.stderr.splitlines()) == 1
    missing = log("telemetry", path, "--name", "rove")
    assert missing.returncode == 1 and "'rover/power'" in missing.stderr
    events = log("events", path).stdout.splitlines()
    assert len(events) == 2 and "two / lines  (/; force=2.5 N)" in events[1]
    table = list(csv.reader(log("events", path, "--kind", "contact", "--csv", "-").stdout.splitlines(keepends=True)))
    assert table[1] == ["2", "3.0", "info", "contact", "two\nlines", "/", "force=2.5 N"]


def test_unknown_fields_are_recorded(session, scene, tmp_path):
    path = tmp_path / "run.dspace"
    command = pb.Command()
    command.log_event.kind = "note"
    later = command.SerializeToString() + b"\xfa\x7c\x05later"  # field 1999, text
    with session.record(path):
        session.execute(pb.Command.FromString(later))
    with dspace.RecordingFile(path) as file:
        (row,) = file.rows()
    assert row.payload.endswith(b"\xfa\x7c\x05later") or b"\xfa\x7c\x05later" in row.payload


def test_requests_of_later_versions_say_so(session):
    for fill in (lambda c: c.viewshed.SetInParent(), lambda c: c.line_of_sight.pair.add(),
                 lambda c: c.ephemeris.SetInParent()):
        command = pb.Command()
        fill(command)
        with pytest.raises(dspace.Unimplemented, match=f"command {command.WhichOneof('command')}") as refused:
            session.execute(command)
        assert isinstance(refused.value, (dspace.Unsupported, dspace.Error, NotImplementedError))


def test_movies_write_telemetry(run, tmp_path):
    """An overlay of a recording's values is the picture of a table that says them."""
    from dspace.movies_draw import Stage, open_run
    path, _ = run
    with dspace.Session() as session:
        scene = session.scene()
        camera = scene.add_camera("main", eye=(3, 3, 3), target=(0, 0, 0))
        viewport = scene.add_viewport((200, 80), camera, name="view")
        viewport.set_table("t", [("power", "64.00 W"), ("mode", "drive"), ("note", "–|–"), ("at", "8")], font_size=12)
        wanted = viewport.image()
    movie = dspace.Movie(size=(200, 80), rate=1, start=0.0, duration=9)
    movie.add_view("main", camera="main")
    movie.add_overlay(rows=[("power", "{rover/power:.2f} {rover/power.unit}"), ("mode", "{rover/mode}"),
                            ("note", "–|–"), ("at", "{run:.0f}")], font_size=12)
    source = open_run(path)
    try:
        stage = Stage(movie, source)
        for viewport in source.session.viewports.values():
            viewport.remove_table("t")
        picture = stage.picture(8)
        assert np.array_equal(picture, wanted)
        assert not np.array_equal(stage.picture(7), wanted)
        movie.add_overlay(rows=[("x", "{rover/watts:.2f}")])
        with pytest.raises(dspace.InvalidArgument, match="'rover/watts'.*'rover/power'"):
            Stage(movie, source).picture(3)
    finally:
        source.close()


def test_overlays_of_what_has_no_value(scene):
    from dspace.movies_draw import fill
    from dspace.telemetry import overlay_value
    scene.telemetry.add("a", unit="m")
    scene.telemetry.add("b", value=2.0)
    assert fill("{a:.2f} {a.unit} {b:.1f}", lambda key: overlay_value(scene, key)) == "– m 2.0"
    assert overlay_value(scene, "c") is None


def test_no_value_is_taken_across_lost_commands(tmp_path):
    """A salvaged recording: two of ten seconds are lost, and a snapshot goes on."""
    from dspace.recording_file import write_recording
    with dspace.Session() as session:
        scene = session.scene()
        power, still = scene.telemetry.add("power", unit="W"), scene.telemetry.add("still", value=5.0)

        def drive(seconds):
            for i in seconds:
                scene.time = float(i)
                power.value = 10.0 * i
                if i in (3, 5, 7):
                    scene.log_event("note", str(i))

        with session.record(tmp_path / "before.dspace"):
            drive(range(4))
        drive((4, 5))
        with session.record(tmp_path / "after.dspace"):
            drive(range(6, 10))
    with dspace.RecordingFile(tmp_path / "before.dspace") as one, dspace.RecordingFile(tmp_path / "after.dspace") as two:
        rows, first = list(one.rows()), one.snapshot(0)
        lost = (len(rows) + 1, len(rows) + 4)
        rows += [row._replace(seq=row.seq + lost[1]) for row in two.rows()]
        snapshots = [first, two.snapshot(0)._replace(seq=lost[1])]
    path = tmp_path / "salvaged.dspace"
    write_recording(str(path), rows, snapshots)
    database = sqlite3.connect(path)
    with database:
        database.execute("INSERT INTO meta VALUES('lost', ?)", (f"{lost[0]}-{lost[1]}",))
    database.close()
    with pytest.warns(dspace.DspaceWarning, match="lost"), dspace.Playback(path) as run:
        times, values = run.telemetry("power")
        assert times.tolist() == [0, 1, 2, 3, 3, 5, 6, 7, 8, 9]
        assert np.array_equal(values, [0, 10, 20, 30, np.nan, 50, 60, 70, 80, 90], equal_nan=True)
        still = run.telemetry("still")  # of the snapshot it is known from its time on, not from its own
        assert still.times.tolist() == [0, 3, 5] and still.values[[0, 2]].tolist() == [5, 5]
        assert math.isnan(still.at(4.0)) and still.at(5.0) == 5.0
        assert [event.text for event in run.events()] == ["3", "5", "7"]  # the snapshot keeps events
