"""Recordings: times of minus zero, damage to what is beside the rows, the pace of playback, and what the log says."""
import contextlib
import hashlib
import math
import shutil
import sqlite3
import struct
import subprocess
import sys

import pytest

import dspace
from dspace.playback import playback
from dspace.command_line import main
from dspace.recording.file import RecordingFile
from recording_support import (Asset, Content, Row, create_recording, put_assets, put_contents, put_rows,
                               write_recording)


def record(path, steps=100, step=0.01, **options):
    """A frame that goes a metre a step, each of two commands."""
    with dspace.Session() as session:
        scene = session.scene()
        frame = scene.add_frame("f")
        with session.record(path, **options):
            for number in range(steps):
                scene.time = number * step
                frame.position = (number, 0, 0)


def command(*words):
    done = subprocess.run([sys.executable, "-W", "ignore", "-m", "dspace", "log", *map(str, words)],
                          capture_output=True, text=True)
    return done.returncode, done.stdout + done.stderr


def place(run):
    return run.session.scene().frame("f").position[0]


def test_minus_zero_is_a_time(tmp_path):
    """SQLite keeps it as 0, so that its sign may not be in the checksum."""
    path = tmp_path / "a.dspace"
    with dspace.Session() as session:
        scene = session.scene()
        scene.time = -0.0
        with session.record(path):
            scene.add_frame("f")
            scene.time = 1.0
            scene.time = -0.0
            scene["f"].position = (3, 0, 0)
    with RecordingFile(path) as file:
        file.check()
        assert all(math.copysign(1, row.time) == 1 for row in file.rows())
    with dspace.Playback(path) as run:
        run.step(len(run.times))
        assert run.time == 0 and place(run) == 3


# --- Damage ----------------------------------------------------------------------------------------

def test_a_damaged_index_of_steps_shows_no_wrong_instant(tmp_path):
    """Its entries hold times and commands' numbers, and no checksum."""
    path, other = tmp_path / "a.dspace", tmp_path / "b.dspace"
    record(path, 60)
    data = path.read_bytes()
    found = 0
    for asked in (3, 30, 58):
        pattern, at = struct.pack(">d", asked * 0.01), -1
        while (at := data.find(pattern, at + 1)) >= 0:
            for byte, bit in ((1, 1), (2, 64), (7, 1), (8, 1), (8, 2)):  # of the time, and of the number after it
                damaged = bytearray(data)
                damaged[at + byte] ^= bit
                other.write_bytes(damaged)
                with contextlib.suppress(dspace.Corrupt):
                    with dspace.Playback(other) as run:
                        for number in range(60):
                            run.seek(number * 0.01)
                            assert run.session.scene().time == run.time
                            assert (place(run), run.time) == (number, number * 0.01), (asked, at, byte, bit)
                    continue
                found += 1
    assert found > 20


@pytest.fixture(scope="module")
def killed(tmp_path_factory):
    """A recording whose process was killed: its log holds all of it."""
    folder = tmp_path_factory.mktemp("killed")
    subprocess.run([sys.executable, "-W", "ignore", "-c", f"""
import dspace, os
session = dspace.Session()
scene = session.scene()
frame = scene.add_frame("f")
recording = session.record({str(folder / "a.dspace")!r}, commit_every=0.01)
for number in range(300):
    scene.time = number * 0.01
    frame.position = (number, 0, 0)
recording.flush()
os.kill(os.getpid(), 9)
"""], check=False)
    assert (folder / "a.dspace-wal").stat().st_size > 100_000
    return folder / "a.dspace"


@pytest.mark.parametrize("byte, bit", [(18, 0), (0, 3), (9, 7), (31, 0)])
def test_damage_to_a_logs_head_loses_nothing(killed, tmp_path, byte, bit):
    shutil.copy(killed, tmp_path / "a.dspace")
    log = bytearray((killed.parent / "a.dspace-wal").read_bytes())
    log[byte] ^= 1 << bit
    (tmp_path / "a.dspace-wal").write_bytes(log)
    code, said = command("salvage", tmp_path / "a.dspace", "--out", tmp_path / "b.dspace")
    assert code == 0 and "600 commands, 1 snapshots" in said
    with dspace.Playback(tmp_path / "b.dspace") as run:
        run.seek(2.0)
        assert place(run) == 200


def test_a_recording_whose_first_state_is_lost_is_said_to_be(tmp_path):
    """Its commands are all there, but there is nothing that they could be carried out on."""
    path = tmp_path / "a.dspace"
    record(path, 20)
    database = sqlite3.connect(path)
    with database:
        database.execute("UPDATE snapshot SET payload = x'00'")
    database.close()
    code, said = command("salvage", path, "--out", tmp_path / "b.dspace")
    assert code == 1 and "40 commands, 0 snapshots" in said and "lost: the state before command 1" in said


# --- The log ---------------------------------------------------------------------------------------

def test_the_same_commands_of_other_files_are_not_the_same(tmp_path, field):
    def run(name):
        with dspace.Session() as session:
            scene = session.scene()
            with session.record(tmp_path / name):
                scene.add_terrain(field)
                scene.time = 1.0
        return tmp_path / name

    one, two = run("a.dspace"), run("b.dspace")
    code, said = command("diff", one, two)
    assert code == 0 and said.startswith("the same")
    field.write_text(field.read_text().replace("-8.0", "-7.0"))
    code, said = command("diff", one, run("c.dspace"))
    assert code == 1 and str(field) in said and "the same:" not in said


def test_a_cut_ends_after_it_begins(tmp_path):
    path = tmp_path / "a.dspace"
    record(path)
    code, said = command("cut", path, "--from", 0.6, "--to", 0.3, "--out", tmp_path / "b.dspace")
    assert code == 1 and "--to 0.3; accepted: 0.6 and later" in said and not (tmp_path / "b.dspace").exists()
    assert command("cut", path, "--from", 0.3, "--to", 0.3, "--out", tmp_path / "c.dspace")[0] == 0
    assert command("cut", path, "--from", "nan", "--out", tmp_path / "d.dspace")[0] != 0


def test_a_sound_cut_has_lost_nothing(tmp_path):
    """It begins with a later snapshot; of a whole recording that lacks as much, all of it is lost."""
    path, cut = tmp_path / "a.dspace", tmp_path / "b.dspace"
    record(path, 15_000, 1e-3)
    code, said = command("cut", path, "--from", 14.5, "--out", cut)
    assert code == 0
    with RecordingFile(cut) as file:
        begin = file.first
    assert begin > 1
    code, said = command("salvage", cut, "--out", tmp_path / "c.dspace")
    assert code == 0 and "lost:" not in said and f"{30_000 - begin + 1} commands" in said
    with dspace.Playback(tmp_path / "c.dspace") as run:
        assert not run.gaps and run.seek(14.9) == pytest.approx(14.9) and place(run) == 14_900
    for file, lost in ((cut, (begin, begin + 4)), (path, (1, begin - 1))):
        database = sqlite3.connect(file)
        with database:
            database.execute("DELETE FROM command WHERE seq BETWEEN ? AND ?", lost)
            if file == path:
                database.execute("DELETE FROM snapshot WHERE seq < ?", (begin - 1,))
            database.execute("PRAGMA secure_delete=1")
        database.execute("VACUUM")
        database.close()
        out = tmp_path / f"d{lost[0]}.dspace"
        code, said = command("salvage", file, "--out", out)
        assert code == 1 and f"lost: commands {lost[0]} to {lost[1]}" in said


# --- Playback --------------------------------------------------------------------------------------

class Clock:
    """In the place of `time`: it goes when somebody waits, or says that a step took time."""

    def __init__(self):
        self.now, self.slept = 100.0, 0.0

    def monotonic(self):
        return self.now

    def sleep(self, seconds):
        self.now += seconds
        self.slept += seconds


@pytest.fixture
def clock(monkeypatch):
    made = Clock()
    monkeypatch.setattr(playback, "time", made)
    return made


@pytest.mark.parametrize("speed, begin, end", [(1.0, 0.0, 0.3), (2.0, 0.1, 0.5), (-1.0, 0.9, 0.6)])
def test_playing_keeps_its_pace(tmp_path, clock, speed, begin, end):
    """Of a run at 1 kHz, with 20 ms to draw a step: steps are left out, never time."""
    path = tmp_path / "a.dspace"
    record(path, 1000, 1e-3)
    with dspace.Playback(path) as run:
        run.seek(begin + 1e-9)
        began, shown = clock.now, []

        def draw(run):
            shown.append((clock.now, run.time, place(run)))
            clock.now += 0.02

        run.play(speed, draw, until=end)
        for now, at, where in shown:
            due = begin + speed * (now - began)
            assert -1e-3 - 1e-9 <= (due - at) * (1 if speed > 0 else -1) <= 1e-3 + 1e-9  # the last that is due
            assert where == round(at * 1000)
        assert len(shown) == pytest.approx(abs(end - begin) / abs(speed) / 0.02, abs=2)
        assert run.time == pytest.approx(end)
        assert clock.now - began == pytest.approx(abs((end - begin) / speed), abs=0.041)


def test_every_step_is_shown_in_time_where_there_is_time(tmp_path, clock):
    path = tmp_path / "a.dspace"
    record(path, 50, 0.1)
    for speed, expected in ((1.0, range(11, 50)), (-4.0, range(9, -1, -1)), (0.0, range(11, 50))):
        with dspace.Playback(path) as run:
            run.seek(1.0 + 1e-9)
            shown = []
            run.play(speed, lambda run: shown.append(place(run)))
            assert shown == list(expected)
    assert clock.slept == pytest.approx(3.9 + 1.0 / 4)


def test_playing_over_a_reset_goes_on_from_it(tmp_path, clock):
    """Time goes back in the recording: the second run is played at the same pace, none of it is left out."""
    path = tmp_path / "a.dspace"
    with dspace.Session() as session:
        scene = session.scene()
        with session.record(path):
            for number in (*range(10), *range(5)):
                scene.time = float(number)
    with dspace.Playback(path) as run:
        shown = []
        run.play(1.0, lambda run: shown.append(run.time))
        assert shown == [*range(10), *range(5)]  # first what was there before time was set
        assert clock.slept == pytest.approx(9 + 4)


def test_no_number_is_no_time(tmp_path):
    path = tmp_path / "a.dspace"
    record(path, 5)
    with dspace.Playback(path) as run:
        run.seek(0.02)
        for call in (lambda: run.seek(math.nan), lambda: run.play(math.nan)):
            with pytest.raises(dspace.InvalidArgument, match="nan.*accepted"):
                call()
        assert run.time == 0.02


def salvage_of_files(tmp_path, name, assets, contents=()):
    """(exit code, file) of the salvage of a recording of one command with these rows of files."""
    path, out = str(tmp_path / f"{name}.dspace"), str(tmp_path / f"{name}-out.dspace")
    write_recording(path, [Row(1, 0.0, 1e9, 13, b"j\x00")], [Row(0, 0.0, 1e9, 0, b"")])
    with contextlib.closing(sqlite3.connect(path)) as database:
        put_assets(database, assets)
        put_contents(database, contents)
        database.commit()
    return main(["log", "salvage", path, "--out", out]), out


def test_files_of_which_nothing_is_known_are_told(tmp_path, capsys):
    assets = [Asset(i, f"/f{i}", "absent", 0, b"", False) for i in range(1, 6)]
    assert salvage_of_files(tmp_path, "whole", assets)[0] == 0
    said = capsys.readouterr().out
    assert "lost" not in said and "after the first 5" in said
    assert salvage_of_files(tmp_path, "gaps", [assets[1], assets[4]])[0] == 1
    assert "lost: what is known of 3 files" in capsys.readouterr().out
    contents = [Content(i, asset, 0, 1, b"x") for i, asset in enumerate((2, 7, 9), 1)]
    assert salvage_of_files(tmp_path, "contents", assets[:2], contents)[0] == 1
    assert "lost: what is known of 7 files" in capsys.readouterr().out
    assert salvage_of_files(tmp_path, "none", [], contents[1:])[0] == 1
    assert "lost: what is known of 9 files" in capsys.readouterr().out


@pytest.mark.parametrize("newer_first", (True, False))
def test_of_two_versions_of_a_file_the_packed_one_is_recovered(tmp_path, newer_first):
    """The older version of its row is in the file or in the log, as a process that was killed leaves both."""
    data = b"0123"
    old = Asset(1, "/f", "read", 4, hashlib.sha256(data).digest(), False)
    new = old._replace(packed=True)
    path, bad, out = (str(tmp_path / name) for name in ("a.dspace", "bad.dspace", "new.dspace"))
    with contextlib.closing(create_recording(path)) as database:
        database.execute("PRAGMA journal_mode=WAL")
        database.execute("PRAGMA wal_autocheckpoint=0")
        with database:
            put_rows(database, "command", [Row(1, 0.0, 1e9, 13, b"j\x00")])
            put_rows(database, "snapshot", [Row(0, 0.0, 1e9, 0, b"")])
            put_contents(database, [Content(1, 1, 0, 4, data)])
            put_assets(database, [old])
        if not newer_first:
            database.execute("PRAGMA wal_checkpoint(FULL)")
        with database:
            database.execute("DELETE FROM asset")
            put_assets(database, [new])
        if newer_first:
            database.execute("PRAGMA wal_checkpoint(FULL)")
        for end in ("", "-wal"):
            shutil.copy(path + end, bad + end)
    assert main(["log", "salvage", bad, "--out", out]) == 0
    with RecordingFile(out) as file:
        assert file.assets == [new]
