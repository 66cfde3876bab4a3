"""Recordings: written, read, damaged, salvaged, played back."""
import random
import shutil
import sqlite3
import subprocess
import sys
import warnings

import numpy
import pytest

import dspace
from dspace.command_line import main
from dspace.recording.file import RecordingFile
from dspace.proto import commands_pb2 as pb
from recording_support import Row, checksum, gaps, salvaged_rows, write_recording
from served_support import socket_folder


PAGE = 65536


def drive(session, steps, begin=0, size=(96, 64)):
    """A rover, made and driven: all that moves in a picture, seen by a camera that lags behind."""
    scene = session.scene()
    if begin == 0:
        rover = scene.add_frame("rover")
        scene.add_box((1, 2, 0.5), frame=rover, color=(0.8, 0.2, 0.1))
        scene.add_sphere(0.4, frame=rover.add_frame("head", position=(0, 0, 0.6)), name="head")
        scene.add_trail(50, name="trail")
        scene.add_label("rover", frame=rover)
        camera = scene.add_camera("chase", frame=rover, chase={"smoothing_s": 0.7})
        scene.add_viewport(size, camera, name="view")
    for i in range(begin, begin + steps):
        scene.time = 0.5 * i
        position = (0.2 * i, 0.05 * i * i, 0.1)
        scene.frame("rover").pose = dspace.Pose(position, (numpy.cos(0.05 * i), 0, 0, numpy.sin(0.05 * i)))
        append = pb.Command()
        append.append_trail.object = scene.object("trail").id
        append.append_trail.point.extend(position)
        session.execute(append)
        scene.object("head").visible = i % 3 != 0
        session.viewports["view"].set_table("state", {"step": str(i)})
        if i % 4 == 1:
            event = pb.Command()
            event.viewport_event.viewport = "view"
            event.viewport_event.type = 3  # WHEEL
            event.viewport_event.wheel = 1
            session.execute(event)
    return scene


def made(path, n=400):
    """A recording of n commands of all sizes, whose content follows from their numbers, and its rows."""
    rows = []
    for i in range(1, n + 1):
        command = pb.Command()
        if i % 5 == 0:
            command.set_time.time_s = i / 5
        else:
            command.create_frame.name = f"{i} " * (30 * (i % 7) + (30000 if i % 31 == 0 else 0))
        kind = command.ListFields()[0][0].number
        rows.append(Row(i, float(i // 5) if i >= 5 else 0.0, 1e9 + i / 3, kind, command.SerializeToString()))
    snapshots = [Row(0, 0.0, 1e9, 0, b""), Row(60, 12.0, 1e9, 0, b"")]
    write_recording(str(path), rows, snapshots)
    return {row.seq: row for row in rows}


def damaged(path):
    """What a reader says of it: True where it reports damage, else the rows."""
    try:
        with RecordingFile(path) as file:
            file.check()
            return {row.seq: row for row in file.rows()}
    except dspace.Error:
        return True


def test_every_row_is_what_was_written(tmp_path):
    rows = made(tmp_path / "a.dspace")
    assert damaged(tmp_path / "a.dspace") == rows
    found, snapshots = salvaged_rows(str(tmp_path / "a.dspace"))
    assert found == rows and set(snapshots) == {0, 60}


def survivors(path, rows):
    """Salvages; what comes back must be what was written. Returns the numbers."""
    commands, snapshots = salvaged_rows(str(path))
    for seq, row in commands.items():
        assert rows[seq] == row
    assert set(snapshots) <= {0, 60}
    return set(commands)


def test_cut_anywhere_it_reports_and_salvages(tmp_path):
    whole = tmp_path / "a.dspace"
    rows = made(whole)
    data = whole.read_bytes()
    chance = random.Random(1)
    ends = [*range(0, len(data), PAGE), *range(0, len(data), 9 * 4096), *(chance.randrange(len(data)) | 1 for _ in range(40))]
    part = tmp_path / "part.dspace"
    before = set()
    for end in sorted(ends):
        part.write_bytes(data[:end])
        assert damaged(part) is True, end
        got = survivors(part, rows) if end else set()
        assert got >= before, end  # what a longer part has more can only add
        before = got
    assert 100 < len(before) < len(rows)


def test_flipped_bits_are_reported_and_no_wrong_command_comes_back(tmp_path):
    whole = tmp_path / "a.dspace"
    rows = made(whole)
    data = whole.read_bytes()
    chance = random.Random(2)
    bad = tmp_path / "bad.dspace"
    reported = 0
    for _ in range(120):
        flipped = bytearray(data)
        for _ in range(chance.choice((1, 1, 3, 30))):
            flipped[chance.randrange(len(data))] ^= 1 << chance.randrange(8)
        bad.write_bytes(flipped)
        said = damaged(bad)
        # In bytes that nothing uses a flip changes nothing.
        assert said is True or said == rows
        reported += said is True
        survivors(bad, rows)
    assert reported > 80


def test_a_zeroed_page_loses_only_its_own(tmp_path, capsys):
    whole = tmp_path / "a.dspace"
    rows = made(whole)
    data = whole.read_bytes()
    lost_most = 0
    for page in range(1, len(data) // PAGE):
        bad = tmp_path / "bad.dspace"
        bad.write_bytes(data[:PAGE * page] + bytes(PAGE) + data[PAGE * (page + 1):])
        got = survivors(bad, rows)
        lost_most = max(lost_most, len(rows) - len(got))
    assert 0 < lost_most < 0.7 * len(rows)  # the rows of one leaf
    # The command says what is lost.
    assert main(["log", "salvage", str(bad), "--out", str(tmp_path / "new.dspace")]) in (0, 1)
    missing = gaps(sorted(got), max(rows))
    said = capsys.readouterr().out
    for first, last in missing:
        if last < max(got):
            assert f"lost: commands {first} to {last}" in said
    with sqlite3.connect(tmp_path / "new.dspace") as new:
        assert {seq for seq, in new.execute("SELECT seq FROM command")} == got


def test_a_row_of_the_other_table_is_no_command(tmp_path):
    made(tmp_path / "a.dspace")
    row = Row(1, 0.0, 0.0, 0, b"")
    assert checksum(row, "command") != checksum(row, "snapshot")
    with sqlite3.connect(tmp_path / "a.dspace") as file:
        file.execute("UPDATE command SET payload = ? WHERE seq = 30", (b"other",))
    with pytest.raises(dspace.Corrupt, match="command 30"), RecordingFile(tmp_path / "a.dspace") as file:
        list(file.rows())


def test_missing_commands_are_no_playback(tmp_path):
    made(tmp_path / "a.dspace")
    with sqlite3.connect(tmp_path / "a.dspace") as file:
        file.execute("DELETE FROM command WHERE seq BETWEEN 30 AND 33")
    with pytest.raises(dspace.Corrupt, match="30 to 33"), RecordingFile(tmp_path / "a.dspace") as file:
        list(file.rows())


def test_playback_equals_live_to_the_byte(tmp_path):
    path = tmp_path / "run.dspace"
    live = {}
    with dspace.Session() as session:
        drive(session, 3)  # a recording begins with what is there
        with session.record(path) as recording:
            assert session.recording is recording
            for i in range(3, 15):
                scene = drive(session, 1, i)
                live[scene.time] = session.viewports["view"].image()
            recording.flush()
            assert recording.counts["written"] == recording.counts["accepted"] > 30
            with RecordingFile(path) as file:  # while it is being written
                file.check()
                assert file.last == recording.counts["written"]
        assert session.recording is None
        drive(session, 1, 15)  # no longer recorded
    with dspace.Playback(path) as run:
        assert run.times[1:] == sorted(live) and run.duration == pytest.approx(6.0)
        chance = random.Random(3)
        for at in [*live, *chance.sample(sorted(live), 12)]:  # on, and either way
            assert run.seek(at) == at
            assert numpy.array_equal(run.session.viewports["view"].image(), live[at]), at
        seen = []
        run.play(-1e9, lambda each: seen.append(each.time))
        assert seen == sorted(seen, reverse=True) and run.index == 0
        assert run.step(2) == 2 and run.step(-5) == -2 and run.step(1000) == len(run.times) - 1
        assert numpy.array_equal(run.session.viewports["view"].image(), live[max(live)])
        with pytest.raises(dspace.InvalidArgument, match="accepted"):
            run.seek(-1.0)


def test_an_asset_that_changed_is_named(tmp_path):
    model = tmp_path / "tetra.obj"
    model.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\nf 1 3 4\nf 2 3 4\n")
    with dspace.Session() as session, session.record(tmp_path / "run.dspace"):
        session.scene().load(str(model))
    with dspace.Playback(tmp_path / "run.dspace") as run:
        run.step(10)
        assert len(run.session.scene().objects) == 1
    shutil.copy(model, tmp_path / "kept")
    model.write_text(model.read_text().replace("v 0 0 1", "v 0 0 2"))
    with pytest.raises(dspace.Corrupt, match="tetra.obj.*changed"):
        dspace.Playback(tmp_path / "run.dspace")
    model.unlink()
    with pytest.raises(dspace.NotFound, match="tetra.obj"):
        dspace.Playback(tmp_path / "run.dspace")


def test_bad_recordings_are_refused(tmp_path):
    with dspace.Session() as session:
        (tmp_path / "there").write_text("")
        with pytest.raises(dspace.AlreadyExists, match="there"):
            session.record(tmp_path / "there")
        with pytest.raises(dspace.NotFound, match="folder"):
            session.record(tmp_path / "no" / "run.dspace")
        with pytest.raises(dspace.InvalidArgument, match="0.001 to 60"):
            session.record(tmp_path / "run.dspace", commit_every=0)
        with session.record(tmp_path / "run.dspace"), pytest.raises(dspace.AlreadyExists, match="run.dspace"):
            session.record(tmp_path / "other.dspace")
    with pytest.raises(dspace.NotFound):
        dspace.Playback(tmp_path / "none.dspace")
    (tmp_path / "text.dspace").write_text("not a database" * 100)
    with pytest.raises(dspace.Unsupported, match="not a recording"):
        dspace.Playback(tmp_path / "text.dspace")


def test_log_and_play_commands(tmp_path, capsys):
    for name, shift in (("a", 0.0), ("b", 0.0), ("c", 1e-4)):
        with dspace.Session() as session, session.record(tmp_path / f"{name}.dspace"):
            scene = drive(session, 6)
            scene.frame("rover").pose = dspace.Pose((2 + shift, 0, 0))
    a, b, c = (str(tmp_path / f"{name}.dspace") for name in "abc")
    assert main(["log", "info", a]) == 0
    assert "set_poses" in capsys.readouterr().out
    assert main(["log", "cat", a, "--last", "3"]) == 0
    assert capsys.readouterr().out.count("\n") == 3
    assert main(["log", "diff", a, b]) == 0
    assert main(["log", "diff", a, c]) == 1
    said = capsys.readouterr().out
    with RecordingFile(a) as file:
        assert f"command {file.last}" in said and "0.0001" in said
    assert main(["log", "diff", a, c, "--tolerance", "0.001"]) == 0
    assert main(["log", "cut", a, "--from", "1", "--to", "2", "--out", str(tmp_path / "cut.dspace")]) == 0
    with dspace.Playback(tmp_path / "cut.dspace") as cut, dspace.Playback(a) as run:
        assert max(cut.times) == 2.0
        for at in (1.0, 2.0):
            assert cut.seek(at) == run.seek(at) == at
            assert numpy.array_equal(cut.session.viewports["view"].image(), run.session.viewports["view"].image())
    with warnings.catch_warnings():
        assert main(["play", a, "--at", "1.5", "--out", str(tmp_path / "one")]) == 0
        assert main(["play", a, "--every", "1", "--out", str(tmp_path / "some"), "--reverse"]) == 0
    assert len(list((tmp_path / "one").iterdir())) == 1
    assert len(list((tmp_path / "some").iterdir())) == 3
    assert main(["play", a, "--at", "-3"]) == 1
    assert main(["play", a, "--viewport", "no such", "--out", str(tmp_path / "two")]) == 1


def test_a_full_disk_is_told_once_and_the_session_goes_on(tmp_path):
    script = tmp_path / "full.py"
    script.write_text(f"""
import resource, signal, warnings
import dspace
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
warnings.simplefilter("always")
with dspace.Session() as session, warnings.catch_warnings(record=True) as told:
    frame = session.scene().add_frame("rover")
    recording = session.record({str(tmp_path / "run.dspace")!r}, commit_every=0.001)
    recording.flush()
    resource.setrlimit(resource.RLIMIT_FSIZE, (8 << 20, 8 << 20))
    i = 0
    while recording.active and i < 200000:
        frame.pose = dspace.Pose((i, 0, 0))
        i += 1
        if i == 200:
            recording.flush()
    frame.pose = dspace.Pose((-1, 0, 0))
    assert frame.pose.position[0] == -1
    assert len(told) == 1 and "run.dspace" in str(told[0].message), [str(w.message) for w in told]
    assert recording.failure and not recording.active and session.recording is None
    try:
        recording.stop()
    except dspace.Io:
        pass
    assert 100 < recording.counts["written"] < i
    print(recording.counts["written"])
""")
    done = subprocess.run([sys.executable, script], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    with RecordingFile(tmp_path / "run.dspace") as file:
        file.check()
        assert file.last == int(done.stdout)
    with dspace.Playback(tmp_path / "run.dspace") as run:
        run.step(10)
        assert run.session.scene().frame("rover").pose.position[0] == int(done.stdout) - 1


def test_a_served_session_is_recorded(tmp_path):
    path, address = tmp_path / "served.dspace", f"unix:{socket_folder(tmp_path)}/socket"
    command = [sys.executable, "-m", "dspace", "serve", "--listen", address, "--record", path]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as server:
        try:
            assert "listening" in server.stdout.readline()
            with dspace.connect(address) as session:
                drive(session, 4)
                live = session.viewports["view"].image()
        finally:
            server.terminate()
            server.wait(timeout=60)
    with dspace.Playback(path) as run:
        run.step(100)
        assert run.time == 1.5
        assert numpy.array_equal(run.session.viewports["view"].image(), live)
