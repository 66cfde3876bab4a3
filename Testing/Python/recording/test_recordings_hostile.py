"""Recordings from anywhere: structures that are not Dspace's, text that is not UTF-8, files that unpack to much more than
they are, and processes that were killed."""
import contextlib
import os
import pathlib
import signal
import sqlite3
import subprocess
import sys
import time
import warnings
import zlib

import pytest

import dspace
from dspace.command_line import main
from dspace.proto import commands_pb2 as pb
from dspace.recording.file import RecordingFile
from recording_support import Asset, Content, PART, Row, create_recording, put_assets, put_contents, put_rows

ENDLESS = "WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n) SELECT i"


def row(seq, time_s, **fields):
    command = pb.Command(**fields)
    return Row(seq, time_s, 1e9, command.ListFields()[-1][0].number, command.SerializeToString())


def rows(name="rover"):
    return [row(1, 0.0, create_scene={}), row(2, 0.0, create_frame={"id": 2, "name": name}),
            row(3, 1.0, set_time={"time_s": 1.0}), row(4, 2.0, set_time={"time_s": 2.0})]


def write(path, commands, assets=(), contents=()):
    with contextlib.closing(create_recording(str(path))) as database, database:
        put_rows(database, "snapshot", [Row(0, 0.0, 1e9, 0, b"")])
        put_rows(database, "command", commands)
        put_assets(database, assets)
        put_contents(database, contents)
    return str(path)


# --- Structures ------------------------------------------------------------------------------------

@pytest.mark.parametrize("change", [
    f"DROP TABLE content; CREATE VIEW content AS {ENDLESS} AS id, 1 AS asset, i AS place, 1 AS size, x'00' AS data, "
    "x'' AS checksum FROM n",
    f"DROP TABLE snapshot; CREATE VIEW snapshot AS {ENDLESS} AS seq, 0.0 AS time, 0.0 AS wall, 0 AS kind, x'' AS "
    "payload, x'' AS checksum FROM n",
    "CREATE TRIGGER t AFTER INSERT ON asset BEGIN DELETE FROM command; END"])
def test_a_view_in_the_place_of_a_table_is_not_asked(tmp_path, capsys, change):
    path = write(tmp_path / "a.dspace", rows())
    with contextlib.closing(sqlite3.connect(path)) as database:
        database.executescript(change)
    for words in (["log", "info"], ["log", "cat"], ["log", "pack"], ["play"]):
        assert main([*words, path]) == 1
        assert "is not as in a recording" in capsys.readouterr().err
    main(["log", "salvage", path, "--out", str(tmp_path / "b.dspace")])
    with RecordingFile(tmp_path / "b.dspace") as file:
        assert file.last == 4 and not file.lost


def test_a_list_of_lost_commands_without_end(tmp_path, capsys):
    path = write(tmp_path / "a.dspace", rows())
    with contextlib.closing(sqlite3.connect(path)) as database, database:
        lost = " ".join(f"{i}-{i}" for i in range(1, 3_000_000, 2))
        database.execute("INSERT INTO meta VALUES('lost', ?)", (lost,))
    for words in (["log", "info"], ["play"]):
        assert main([*words, path]) == 1
        assert "more ranges than there are commands and snapshots" in capsys.readouterr().err


# --- Text ------------------------------------------------------------------------------------------

def test_text_that_is_not_utf8_plays_on(tmp_path, capsys):
    """As an earlier version recorded it. The checksums hold."""
    commands = [each._replace(payload=each.payload.replace(b"Maest", b"M\xe4st!")) for each in rows("Maest")]
    path = write(tmp_path / "a.dspace", commands)
    with pytest.raises(Exception, match="Error parsing|invalid|DecodeError|UTF-8"):
        pb.Command.FromString(commands[1].payload)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        with dspace.Playback(path) as run:
            for at in (2.0, 0.0, 2.0):
                run.seek(at)
            assert list(run.session.scenes["scene"].frames) == ["Mäst!"]
    told = [str(each.message) for each in caught if "not UTF-8" in str(each.message)]
    assert len(told) == 1 and "command 2 holds" in told[0] and "a.dspace" in told[0]
    for words in (["log", "info", path], ["log", "salvage", path, "--out", str(tmp_path / "b.dspace")]):
        assert main(words) == 0
        assert "text that is not UTF-8: in command 2; playback reads it as Windows-1252" in capsys.readouterr().out
    assert main(["log", "cat", path]) == 0
    assert 'name: "M\\303\\244st!"' in capsys.readouterr().out
    assert main(["log", "diff", path, str(tmp_path / "b.dspace")]) == 0
    assert main(["play", path]) == 0
    assert "not UTF-8" in capsys.readouterr().err


# --- What unpacks to much more ---------------------------------------------------------------------

def bomb(path, parts):
    """A file of zeros, in `parts` parts of 4 MiB, each of a few kilobytes in the recording."""
    data = zlib.compress(bytes(PART), 9)
    asset = Asset(1, "/zeros", "read", parts * PART, bytes(32), True)
    return write(path, rows(), [asset], [Content(i + 1, 1, i * PART, PART, data) for i in range(parts)])


@pytest.fixture
def scratch(tmp_path, monkeypatch):
    folder = tmp_path / "scratch"
    folder.mkdir()
    monkeypatch.setenv("TMPDIR", str(folder))
    return folder


def test_four_gigabytes_of_four_megabytes(tmp_path, scratch, capsys):
    path = bomb(tmp_path / "a.dspace", 1024)
    assert os.path.getsize(path) < 12 << 20
    with pytest.raises(dspace.Resource, match="has 4294967296 bytes unpacked; accepted: up to .*the unpack limit"):
        dspace.Playback(path)
    for words in (["play", path], ["log", "info", path],
                  ["log", "salvage", path, "--out", str(tmp_path / "b.dspace")]):
        assert main(words) == 1
        assert "--unpack-limit" in capsys.readouterr().err
    assert not list(scratch.iterdir()) and not (tmp_path / "b.dspace").exists()


def test_the_limit_is_set(tmp_path, scratch, capsys):
    path = bomb(tmp_path / "a.dspace", 2)
    size = str(2 * PART)
    with pytest.raises(dspace.Resource, match=f"accepted: up to {2 * PART - 1}, the unpack limit"):
        dspace.Playback(path, unpack_limit=2 * PART - 1)
    with pytest.raises(dspace.Corrupt, match="'/zeros' has changed"):  # it is unpacked; its sum is another
        dspace.Playback(path, unpack_limit=2 * PART)
    assert main(["log", "info", path, "--unpack-limit", size]) == 0
    assert main(["log", "info", path, "--unpack-limit", "1000"]) == 1
    assert main(["play", path, "--unpack-limit", size]) == 1 and "has changed" in capsys.readouterr().err
    for wrong in (0, -1, 2 ** 63, 1.5, "1", True):
        with pytest.raises((dspace.InvalidArgument, dspace.WrongType), match="unpack_limit"):
            dspace.Playback(path, unpack_limit=wrong)
    assert not list(scratch.iterdir())


def wait_for(condition):
    end = time.monotonic() + 60
    while not condition():
        assert time.monotonic() < end
        time.sleep(0.002)


def there(folder, start):
    """Whether a file or folder below `folder` has a name with this start. Folders that another process removes during the search are
    skipped: a confined process's own folder goes after its end, and rglob() fails then."""
    return any(name.startswith(start) for _, folders, files in os.walk(folder) for name in folders + files)


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
def test_a_signal_while_files_are_unpacked_leaves_none(tmp_path, scratch, number):
    path = bomb(tmp_path / "a.dspace", 250)  # a gigabyte
    process = subprocess.Popen([sys.executable, "-m", "dspace", "play", path], stdout=subprocess.DEVNULL,
                               stderr=subprocess.PIPE)
    try:
        wait_for(lambda: there(scratch, "zeros") or process.poll() is not None)
        process.send_signal(number)
        errors = process.communicate(timeout=60)[1].decode()
    finally:
        process.kill()
    assert process.returncode == 143 if number == signal.SIGTERM else process.returncode != 0, errors
    assert not there(scratch, "dspace-unpacked-")


def test_what_a_killed_process_left_goes_with_the_next_playback(tmp_path, scratch):
    path = bomb(tmp_path / "a.dspace", 250)
    words = "import sys, dspace; dspace.Playback(sys.argv[1])"
    process = subprocess.Popen([sys.executable, "-c", words, path], stderr=subprocess.DEVNULL)
    try:
        wait_for(lambda: there(scratch, "zeros"))
    finally:
        process.kill()
        process.wait()
    left, = scratch.iterdir()
    os.utime(left, (0, 0))
    with pytest.raises(dspace.Corrupt, match="'/zeros' has changed"):
        dspace.Playback(bomb(tmp_path / "b.dspace", 1))
    assert not list(scratch.iterdir())


# --- Killed at once --------------------------------------------------------------------------------

RECORD = """
import sys
import dspace
with dspace.Session() as session:
    scene = session.scene()
    print("go", flush=True)
    sys.stdin.readline()
    recording = session.record(sys.argv[1], commit_every=0.001)
    for i in range(10 ** 9):
        scene.time = float(i)
"""


def test_a_recording_killed_in_its_first_moments(tmp_path, capsys):
    """Whatever is there is a beginning, or is said to hold nothing yet, and never to be damaged."""
    seen = set()
    for number in range(12):
        path = tmp_path / f"{number}.dspace"
        process = subprocess.Popen([sys.executable, "-c", RECORD, str(path)], stdin=subprocess.PIPE,
                                   stdout=subprocess.PIPE)
        try:
            assert process.stdout.readline() == b"go\n"
            process.stdin.write(b"\n")
            process.stdin.flush()
            if number % 3:
                wait_for(lambda: path.exists() and (number % 3 == 1 or path.with_name(path.name + "-wal").exists()))
            time.sleep(number // 3 * 0.0015)
        finally:
            process.kill()
            process.communicate()
        if not path.exists():
            seen.add("nothing")
            continue
        try:
            with dspace.Playback(path) as run:
                assert run.times
            seen.add("steps")
        except (dspace.NotFound, dspace.Unsupported) as error:
            assert "no steps yet" in str(error) or "first moments" in str(error), error
            seen.add("begun")
        code = main(["log", "info", str(path)])
        said = capsys.readouterr()
        assert code == 0 or "first moments" in said.err, said.err
    assert seen & {"begun", "steps"}


def test_a_recording_that_holds_nothing_yet(tmp_path, capsys):
    path = str(tmp_path / "a.dspace")
    create_recording(path).close()
    with pytest.raises(dspace.NotFound, match="it holds no steps yet: no command and no state"):
        dspace.Playback(path)
    assert main(["log", "info", path]) == 0
    assert "it holds no steps yet" in capsys.readouterr().out
    assert main(["play", path]) == 1
    assert "it holds no steps yet" in capsys.readouterr().err
    pathlib.Path(path).write_bytes(b"")
    with pytest.raises(dspace.Unsupported, match="it is empty, as a process leaves it that is killed"):
        RecordingFile(path)
