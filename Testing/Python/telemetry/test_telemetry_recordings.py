"""Telemetry and events of recordings: series, tables, movies, what is lost; fields of later versions."""
import csv
import math
import sqlite3
import subprocess
import sys

import numpy as np
import pytest

import dspace
from dspace.proto import commands_pb2 as pb


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


def test_movies_write_telemetry(run, tmp_path):
    """An overlay of a recording's values is the picture of a table that says them."""
    from dspace.movies.draw import Stage, open_run
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
    from dspace.movies.draw import fill
    from dspace.telemetry.telemetry import overlay_value
    scene.telemetry.add("a", unit="m")
    scene.telemetry.add("b", value=2.0)
    assert fill("{a:.2f} {a.unit} {b:.1f}", lambda key: overlay_value(scene, key)) == "– m 2.0"
    assert overlay_value(scene, "c") is None


def test_no_value_is_taken_across_lost_commands(tmp_path):
    """A salvaged recording: two of ten seconds are lost, and a snapshot goes on."""
    from recording_support import write_recording
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


def salvaged(path, rows, snapshots, lost):
    from recording_support import write_recording
    write_recording(str(path), rows, snapshots)
    database = sqlite3.connect(path)
    with database:
        database.execute("INSERT INTO meta VALUES('lost', ?)", (lost,))
    database.close()


def test_values_end_at_a_gap_that_no_snapshot_follows(tmp_path):
    with dspace.Session() as session:
        scene = session.scene()
        power, note = scene.telemetry.add("power"), scene.telemetry.add("note", kind="text", value="a")
        with session.record(tmp_path / "a.dspace"):
            for i in range(6):
                scene.time = float(i)
                power.value = 10.0 * i
    with dspace.RecordingFile(tmp_path / "a.dspace") as file:
        rows, first = list(file.rows()), file.snapshot(0)
    assert len(rows) == 12
    # After 2 s one is lost, then two that the rest follows, or nothing.
    for name, kept, lost in (("b", rows[:6] + rows[8:], "7-8"), ("c", rows[:6], "7-12")):
        salvaged(tmp_path / name, kept, [first], lost)
        with pytest.warns(dspace.DspaceWarning, match="lost"), dspace.Playback(tmp_path / name) as run:
            assert [run.telemetry("power").at(t) for t in (0, 1)] == [0, 10]
            assert math.isnan(run.telemetry("power").at(4.5)) and run.telemetry("note").at(4.5) is None


def two_parts(tmp_path, before, between, after):
    """A recording of what `before` and `after` do, whose four commands between are lost, and a snapshot goes on."""
    with dspace.Session() as session:
        with session.record(tmp_path / "one.dspace"):
            before(session)
        between(session)
        with session.record(tmp_path / "two.dspace"):
            after(session)
    with dspace.RecordingFile(tmp_path / "one.dspace") as one, dspace.RecordingFile(tmp_path / "two.dspace") as two:
        rows, first = list(one.rows()), one.snapshot(0)
        end = len(rows) + 4
        lost = f"{len(rows) + 1}-{end}"
        rows += [row._replace(seq=row.seq + end) for row in two.rows()]
        salvaged(tmp_path / "run.dspace", rows, [first, two.snapshot(0)._replace(seq=end)], lost)
    return tmp_path / "run.dspace"


def test_after_a_gap_values_hold_from_their_own_scenes_time_on(tmp_path):
    def before(session):
        for name, time in (("a", 10.0), ("b", 100.0)):
            scene = session.scene(name)
            scene.time = time
            scene.telemetry.add("x", value=time)
            scene.telemetry.add("t", kind="text", value=name)

    def between(session):
        session.scenes["a"].time = 2.0  # it was reset
        session.scenes["b"].time = 101.0

    def after(session):
        session.scenes["a"].time = 3.0
        session.scenes["a"].telemetry["x"].value = 33.0

    path = two_parts(tmp_path, before, between, after)
    with pytest.warns(dspace.DspaceWarning, match="lost"), dspace.Playback(path) as run:
        x, t = run.telemetry("x", scene="a"), run.telemetry("t", scene="a")
        assert x.times.tolist() == [10, 10, 2, 3] and t.times.tolist() == [10, 10, 2]
        assert np.array_equal(x.values, [10, np.nan, 10, 33], equal_nan=True) and t.values.tolist() == ["a", None, "a"]
        assert run.telemetry("x", scene="b").times.tolist() == [100, 100, 101]


@pytest.mark.parametrize("texts", (["n"], ["n", "o", "p", "q"], []))
def test_after_a_gap_events_of_a_scene_that_was_made_anew_are_told(tmp_path, texts):
    def before(session):
        scene = session.scene("a")
        frame = session.scene("b").add_frame("f")
        for i in range(3):
            scene.log_event("note", f"old {i}")
        session.scenes["b"].log_event("note", "stays", frame=frame)

    def between(session):
        session.scenes["a"].remove()
        session.scenes["b"].frame("f").remove()  # which the snapshot then leaves out of the event
        scene = session.scene("a")
        for each in texts:
            scene.log_event("note", each)

    def after(session):
        session.scenes["a"].log_event("note", "last")

    path = two_parts(tmp_path, before, between, after)
    with pytest.warns(dspace.DspaceWarning, match="lost"), dspace.Playback(path) as run:
        assert [event.text for event in run.events("a")] == ["old 0", "old 1", "old 2", *texts, "last"]
        assert [event.text for event in run.events("b")] == ["stays"]


@pytest.mark.parametrize("kind", ("set_telemetry", "log_event"))
def test_a_damaged_kind_hides_nothing(run, kind):
    path, _ = run
    database = sqlite3.connect(path)
    with database:
        changed = database.execute("UPDATE command SET kind = 24 WHERE seq = (SELECT max(seq) FROM command WHERE kind = ?)",
                                   (pb.Command.DESCRIPTOR.fields_by_name[kind].number,)).rowcount
    database.close()
    assert changed == 1
    with dspace.Playback(path) as playback:
        for read in (playback.telemetry, playback.events):
            with pytest.raises(dspace.Corrupt, match="is damaged"):
                read()
