"""Recordings: bad input is rejected with a message that names it, and leaves no files."""
import contextlib
import os
import re
import sqlite3
import subprocess
import sys
import threading
import time
import types

import numpy as np
import pytest

import dspace
from dspace.playback import playback
from dspace.command_line import main
from dspace.recording.assets import RecordedFiles
from dspace.playback.spans import spans_of, when
from dspace.recording.file import RecordingFile
from movies_support import pixels
from recording_support import Asset, put_assets


def record(path, steps=6):
    """A viewport from the beginning on, and a step each 0.1 s."""
    with dspace.Session() as session:
        scene = session.scene()
        frame = scene.add_frame("rover")
        scene.add_box((1, 1, 1), frame=frame)
        scene.add_camera(eye=(3, -3, 2), target=(0, 0, 0))
        scene.add_viewport((32, 24), name="view")
        with session.record(path):
            for number in range(steps):
                scene.time = number / 10
                frame.position = (number / 5, 0, 0)
    return str(path)


# --- dspace play -----------------------------------------------------------------------------------

@pytest.fixture
def late(tmp_path):
    live = {}
    path = str(tmp_path / "late.dspace")
    with dspace.Session() as session, session.record(path):
        scene = session.scene("field")
        for time in range(6):
            scene.time = float(time)
            if time == 0:
                box = scene.add_box((1, 1, 1), color="red")
            if time == 1:
                scene.add_camera("eye", eye=(3, -3, 2), target=(0, 0, 0))
            if time in (1, 4):
                first = scene.add_viewport((32, 24), "eye", name="first")
            if time == 3:
                first.remove()
            if time == 5:
                scene.add_viewport((32, 24), "eye", name="second")
                box.visible = False
            if time in (1, 2, 4, 5):
                live[time] = first.image()
    return path, live


def test_play_passes_over_steps_without_the_viewport(late, tmp_path, capsys):
    path, live = late
    assert main(["play", path, "--out", str(tmp_path / "out"), "--viewport", "first"]) == 0
    said = capsys.readouterr()
    drawn = sorted((tmp_path / "out").iterdir())
    assert [each.name for each in drawn] == ["000000.png", "000001.png", "000002.png", "000003.png"]
    assert said.out.splitlines() == list(map(str, drawn))
    assert ("3 of 7 steps are skipped, without viewport 'first', which exists from 1 to 2 s, from 4 s on"
            in said.err)
    for file, image in zip(drawn, live.values()):
        assert np.array_equal(pixels(file), image.ravel())
    back = ["--out", str(tmp_path / "back"), "--viewport", "first", "--reverse", "--every", "2"]
    assert main(["play", path, *back]) == 0
    back = [(tmp_path / "back" / name).read_bytes() for name in ("000000.png", "000001.png")]
    assert back == [drawn[3].read_bytes(), drawn[1].read_bytes()]  # 5 s, and 2 s of those at least 2 s before


def test_play_says_which_viewports_there_are_and_when(late, tmp_path, capsys):
    path, _ = late
    assert main(["play", path]) == 0
    assert "viewports: 'first' (from 1 to 2 s, from 4 s on), 'second' (from 5 s on)" in capsys.readouterr().out
    assert main(["play", record(tmp_path / "a.dspace")]) == 0
    assert capsys.readouterr().out == "7 steps, 0 to 0.5 s; viewports: 'view'\n"
    # Nothing is made before it is known that there is something to draw.
    out = tmp_path / "out"
    for words, says in (([], "the viewport is not stated.*'first' .from 1 to 2 s"),
                        (["--viewport", "third"], "no viewport 'third'.*'first' .from 1 to 2 s"),
                        (["--viewport", "first", "--at", "3"], "at 3 s there is no viewport 'first'.*from 1 to 2 s")):
        assert main(["play", path, "--out", str(out), *words]) == 1
        assert re.search(says, capsys.readouterr().err), says
        assert not out.exists()
    with dspace.Session() as session, session.record(tmp_path / "none.dspace"):
        session.scene().time = 1.0
    assert main(["play", str(tmp_path / "none.dspace"), "--out", str(out)]) == 1
    assert "it has no viewport at any step" in capsys.readouterr().err and not out.exists()


def test_spans_are_what_playback_shows(late, tmp_path):
    """Of scenes, cameras and viewports that come and go, against the session at each step; also after a cut."""
    path, _ = late
    assert main(["log", "cut", path, "--from", "2", "--to", "4", "--out", str(tmp_path / "cut.dspace")]) == 0
    twice = [str(tmp_path / "cut.dspace"), "--from", "4", "--out", str(tmp_path / "cut2.dspace")]
    assert main(["log", "cut", *twice]) == 0
    with dspace.Session() as session:
        names = ("a", "b", "c")
        with session.record(tmp_path / "many.dspace"):
            generator = np.random.default_rng(4)
            for time in range(60):
                scene = session.scene(names[generator.integers(3)])
                scene.time = float(time)
                for what in generator.integers(0, 9, 3):
                    if what < 3:
                        scene.add_camera(names[what], eye=(1, 1, 1), target=(0, 0, 0))
                    elif what < 5 and scene.vantages["main"].cameras:
                        scene.add_viewport((8, 8), next(iter(scene.vantages["main"].cameras)))
                    elif what < 8 and session.viewports:
                        list(session.viewports.values())[-1].remove()
                    elif what == 8 and not session.viewports:
                        scene.remove()
                        break
    count = 0
    for name in ("late", "cut", "cut2", "many"):
        with dspace.Playback(tmp_path / f"{name}.dspace") as run:
            spans = spans_of(run)
            for index in range(len(run.times)):
                run.step(index - run.index)
                there = {("viewport", each) for each in run.session.viewports}
                for scene in run.session.scenes.values():
                    there |= {("scene", scene.name)} | {("camera", scene.name, "main", each)
                                                        for each in scene.vantages["main"].cameras}
                found = {key for key, ranges in spans.items() for a, b in ranges if a <= index < b}
                assert found == there, (name, index)
                count += len(there)
            assert all(a < b for ranges in spans.values() for a, b in ranges)
            assert when(run, [(0, len(run.times))]) == f"from {run.times[0]:g} s on"
    assert count > 100


def test_play_writes_over_nothing(tmp_path, capsys):
    path, out = record(tmp_path / "a.dspace"), tmp_path / "out"
    out.mkdir()
    (out / "000001.png").write_text("mine")
    assert main(["play", path, "--out", str(out)]) == 1
    assert "it holds '000001.png'; accepted: a new folder" in capsys.readouterr().err
    assert [each.name for each in out.iterdir()] == ["000001.png"] and (out / "000001.png").read_text() == "mine"
    (out / "000001.png").rename(out / "notes.txt")
    assert main(["play", path, "--out", str(out), "--at", "0.2"]) == 0
    assert main(["play", path, "--out", path]) == 1
    assert "accepted: a folder that may be made and written" in capsys.readouterr().err


@pytest.mark.parametrize("words, says", [
    (["--at", "0.2", "--every", "1", "--out", "OUT"], "--at and --every are given; accepted: one or the other"),
    (["--at", "0.2", "--reverse", "--out", "OUT"], "--at and --reverse are given; accepted: one or the other"),
    (["--every", "1"], "--every applies to pictures; accepted: with --out"),
    (["--reverse"], "--reverse applies to pictures; accepted: with --out"),
    (["--viewport", "view", "--at", "0.2"], "--viewport applies to pictures; accepted: with --out")])
def test_play_leaves_no_option_out(tmp_path, capsys, words, says):
    out = tmp_path / "out"
    assert main(["play", record(tmp_path / "a.dspace"), *(str(out) if word == "OUT" else word for word in words)]) == 1
    said = capsys.readouterr()
    assert said.err == f"dspace: {says}\n" and said.out == "" and not out.exists()


def test_a_pack_lacks_no_file_that_was_read(tmp_path, capsys):
    path, out, names = tmp_path / "a.dspace", tmp_path / "b.dspace", [tmp_path / f"{each}.obj" for each in "xyz"]
    with dspace.Session() as session, session.record(path):
        for each in names:
            each.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
            session.scene().load(str(each))
    before, content = path.read_bytes(), names[1].read_bytes()
    for gone, more in ((names[1:2], ""), (names[1:], ", and so is 1 other")):
        for each in gone:
            each.unlink()
        for words in (["--out", str(out)], []):
            assert main(["log", "pack", str(path), *words]) == 1
            assert f"its file '{names[1]}' is missing{more}; accepted: " in capsys.readouterr().err
            assert sorted(os.listdir(tmp_path)) == sorted(["a.dspace", *(each.name for each in names if each.exists())])
            assert path.read_bytes() == before
        for each in gone:
            each.write_bytes(content)
    # One that could not be read when it was recorded is needed by nothing.
    with contextlib.closing(sqlite3.connect(path)) as database, database:
        put_assets(database, [Asset(100, "/some/folder", "unreadable", 0, b"", False)])
    assert main(["log", "pack", str(path), "--out", str(out)]) == 1
    assert capsys.readouterr().out.splitlines()[-1] == "not packed: /some/folder"
    for each in names:
        each.unlink()
    with dspace.Playback(out) as run:
        run.step(1000)
        assert len(run.session.scene().objects) == 3
    with RecordingFile(out) as file:
        assert {asset.path: asset.packed for asset in file.assets if asset.state != "absent"} == {
            **{str(each): True for each in names}, "/some/folder": False}


# --- What is no damage -----------------------------------------------------------------------------

def raised(kind, call):
    with pytest.raises(dspace.Error) as found:
        call()
    assert type(found.value) is kind, found.value
    return str(found.value)


def test_what_is_no_damage_is_told_as_what_it_is(tmp_path):
    path = record(tmp_path / "a.dspace")
    file = RecordingFile(path)
    said = []
    thread = threading.Thread(target=lambda: said.append(raised(dspace.WrongThread, lambda: file.last)))
    thread.start()
    thread.join()
    assert "accepted: the one that opened it" in said[0]
    file.close()
    for call in (lambda: file.last, lambda: list(file.rows()), file.check):
        assert "it is closed" in raised(dspace.Closed, call)
    with contextlib.closing(sqlite3.connect(path)) as other, RecordingFile(path) as file:
        other.execute("PRAGMA journal_mode=DELETE")
        other.execute("BEGIN EXCLUSIVE")
        file._vtk.SetTimeout(0.01)
        said = raised(dspace.Io, lambda: file.last)
        assert "locked" in said and "salvage" not in said


def test_what_is_no_recording_is_told_so(tmp_path):
    empty, text, database = (tmp_path / name for name in ("empty.dspace", "text.dspace", "database.dspace"))
    empty.touch()
    text.write_text("time_s,name,value\n" * 100)
    with contextlib.closing(sqlite3.connect(database)) as made, made:
        made.execute("CREATE TABLE other(a)")
    for path, says in ((empty, "it is empty"), (text, "its first bytes are 'time_s,name,valu'"),
                       (database, "without a recording's tables")):
        for call in (lambda: dspace.Playback(path), lambda: RecordingFile(path)):
            said = raised(dspace.Unsupported, call)
            assert "it is not a recording" in said and says in said and "accepted: a .dspace file" in said
    # One that is damaged is still told to be.
    path = record(tmp_path / "a.dspace")
    data = bytearray(open(path, "rb").read())
    for at in (16, 21):  # the size of its pages, and the fraction of one that a row may take
        damaged = bytearray(data)
        damaged[at] ^= 255
        (tmp_path / "damaged.dspace").write_bytes(damaged)
        assert "log salvage" in raised(dspace.Corrupt, lambda: RecordingFile(tmp_path / "damaged.dspace"))


def test_a_newer_format_is_not_taken_for_this_one(tmp_path, capsys):
    path, out = record(tmp_path / "a.dspace"), tmp_path / "out.dspace"
    with contextlib.closing(sqlite3.connect(path)) as database, database:
        database.execute("UPDATE meta SET value = 2 WHERE key = 'format'")
    assert main(["log", "info", path]) == 1
    said = "its format is 2, a newer Dspace wrote it; accepted: 1"
    assert said in capsys.readouterr().err
    assert said in raised(dspace.Unsupported, lambda: RecordedFiles(types.SimpleNamespace(path=path)))  # C++'s reader
    assert main(["log", "salvage", path, "--out", str(out)]) == 1
    assert "a newer Dspace wrote it" in capsys.readouterr().err and not out.exists()
    with contextlib.closing(sqlite3.connect(path)) as database, database:
        database.execute("UPDATE meta SET value = 'damaged' WHERE key = 'format'")
    assert main(["log", "salvage", path, "--out", str(out)]) == 0


# --- dspace log ------------------------------------------------------------------------------------

@pytest.mark.parametrize("words", (["cut"], ["salvage"], ["pack"]))
def test_log_refuses_places_that_there_are_not(tmp_path, capsys, words):
    path = record(tmp_path / "a.dspace")
    for out, says in (("/nonexist/x.dspace", "no folder '/nonexist'"), ("/proc/x.dspace", "accepted"),
                      (path, "there is such a file")):
        before = open(path, "rb").read()
        assert main(["log", *words, path, "--out", out]) == 1
        said = capsys.readouterr().err
        assert says in said and "accepted" in said and said.count("\n") == 1, said
        assert open(path, "rb").read() == before
    assert sorted(each.name for each in tmp_path.iterdir() if each.suffix == ".dspace") == ["a.dspace"]


def test_what_is_not_made_whole_does_not_stay(tmp_path, capsys):
    """Where the disk is full: here, where no file may grow beyond 100 kB."""
    path, out = record(tmp_path / "a.dspace"), tmp_path / "out.dspace"
    for words in ("cut", "salvage", "pack"):
        done = subprocess.run([sys.executable, "-W", "ignore", "-c", "import resource, signal, sys\n"
                               "signal.signal(signal.SIGXFSZ, signal.SIG_IGN)\n"
                               "resource.setrlimit(resource.RLIMIT_FSIZE, (100000, 100000))\n"
                               "from dspace.command_line import main\nsys.exit(main(sys.argv[1:]))", "log", words, path,
                               "--out", str(out)], capture_output=True, text=True)
        assert done.returncode == 1 and done.stderr.count("\n") == 1 and "accepted" in done.stderr, (words, done.stderr)
        assert not [each for each in tmp_path.iterdir() if "out" in each.name], words


def test_cut_stays_within_the_recording(tmp_path, capsys):
    path, out = record(tmp_path / "a.dspace"), tmp_path / "out.dspace"
    for words, says in ((["--to", "-50"], "--to -50.0"), (["--from", "50"], "--from 50.0"),
                        (["--from", "0.51", "--to", "9"], "--from 0.51")):
        assert main(["log", "cut", path, *words, "--out", str(out)]) == 1
        said = capsys.readouterr().err
        assert says in said and "0.0 to 0.5 s" in said and not out.exists()
    assert main(["log", "cut", path, "--from", "-1", "--to", "0.5", "--out", str(out)]) == 0
    with dspace.Playback(out) as run:
        assert run.times[-1] == 0.5


def test_tables_are_written_over_nothing(tmp_path, capsys):
    path, out = record(tmp_path / "a.dspace"), tmp_path / "a.csv"
    out.write_text("mine")
    for words in ("telemetry", "events"):
        for place in (str(out), "/nonexist/a.csv"):
            assert main(["log", words, path, "--csv", place]) == 1
            said = capsys.readouterr().err
            assert f"--csv {place!r}" in said and "accepted: a new file" in said
    assert out.read_text() == "mine"


# --- Python ----------------------------------------------------------------------------------------

def test_playback_refuses_by_name(tmp_path, monkeypatch):
    path = record(tmp_path / "a.dspace")
    for words, kind in (({"check_assets": "no"}, dspace.WrongType), ({"scene": 5}, dspace.WrongType),
                        ({"scene": "zzz"}, dspace.NotFound)):
        raised(kind, lambda: dspace.Playback(path, **words))
    with dspace.Playback(path, scene="scene") as run:
        run.seek(0.2)
        for call, kind in ((lambda: run.play(until="x"), dspace.WrongType),
                           (lambda: run.play(until=True), dspace.WrongType),
                           (lambda: run.play(until=float("nan")), dspace.InvalidArgument),
                           (lambda: run.play(0, on_step=5), dspace.WrongType),
                           (lambda: run.step("x"), dspace.WrongType),
                           (lambda: run.step(None), dspace.WrongType), (lambda: run.step(1.5), dspace.WrongType),
                           (lambda: run.session.execute(5), dspace.WrongType)):
            said = raised(kind, call)
            assert "accepted" in said
            assert run.time == 0.2

        class Slow:
            """A clock that lets five waits pass."""
            waits = []

            @staticmethod
            def monotonic():
                return 0.0

            @classmethod
            def sleep(cls, seconds):
                cls.waits.append(seconds)
                time.sleep(0 if seconds < 1e9 else seconds)  # which the system would reject
                if len(cls.waits) == 5:
                    raise KeyboardInterrupt

        monkeypatch.setattr(playback, "time", Slow)
        with pytest.raises(KeyboardInterrupt):
            run.play(1e-300)
        assert len(Slow.waits) == 5 and run.time == 0.2


def test_no_number_is_no_time_to_wait_and_no_bound(session, scene):
    question = scene.ask("go", "Go?", choices=["yes", "no"])
    nan = float("nan")
    for call in (lambda: question.wait(timeout=nan), lambda: session.process_events(nan),
                 lambda: scene.events(since=nan), lambda: scene.events(until=nan)):
        assert "nan; accepted" in raised(dspace.InvalidArgument, call)
    raised(dspace.WrongType, lambda: session.execute(5))
