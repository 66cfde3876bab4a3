"""Recordings that a simulation makes of a session in a server: session.record() of dspace.connect()."""
import os
import subprocess
import sys
import time
import warnings

import numpy
import pytest

import dspace
from connected_support import build, drive, folder, last_place  # noqa: F401 (a fixture)
from dspace.command_line import main
from dspace.recording.file import RecordingFile
from dspace.proto import commands_pb2 as pb
from served_support import Served


@pytest.mark.parametrize("wait", (True, False))
def test_it_is_the_servers_recording_and_shows_the_same(tmp_path, folder, wait, capsys):
    mine, theirs = tmp_path / "mine.dspace", tmp_path / "theirs.dspace"
    live = {}
    with Served(tmp_path, "--allow-root", folder, "--record", theirs) as server:
        with dspace.connect(server.address) as session, session.record(mine, commit_every=0.01) as recording:
            assert session.recording is recording and recording.active
            scene, rover = build(session, folder)
            session.wait = wait
            for number in range(0, 30, 10):
                drive(scene, rover, number, number + 10)
                live[float(number + 9)] = session.viewports["view"].image()
        assert not recording.active and recording.counts["written"] == recording.counts["accepted"] > 60
    assert main(["log", "diff", str(mine), str(theirs)]) == 0
    assert f"the same: {recording.counts['written']} commands" in capsys.readouterr().out
    with dspace.Playback(mine) as run:
        assert run.gaps == []
        for at, image in live.items():
            assert run.seek(at) == at
            assert numpy.array_equal(run.session.viewports["view"].image(), image)
        assert not numpy.array_equal(live[9.0], live[29.0])


def test_it_begins_with_what_is_there(tmp_path, folder):
    path = tmp_path / "a.dspace"
    with Served(tmp_path, "--allow-root", folder) as server, dspace.connect(server.address) as session:
        scene, rover = build(session, folder)
        session.wait = False
        drive(scene, rover, 0, 500)  # which has to be done before
        recording = session.record(path, pack=True)
        drive(scene, rover, 500, 503)
        live = session.viewports["view"].image()
        recording.stop()
        recording.stop()
        drive(scene, rover, 503, 505)  # no longer recorded
        assert session.recording is None
        other = session.record(tmp_path / "b.dspace")  # another one may follow
        session.close()
        session.close()
        assert not other.active
    assert last_place(tmp_path / "b.dspace") == 0.3 * 504
    (folder / "part.obj").unlink()  # it is packed
    with dspace.Playback(path) as run:
        assert run.times == [499.0, 500.0, 501.0, 502.0]
        run.seek(502.0)
        assert numpy.array_equal(run.session.viewports["view"].image(), live)
        assert run.session.scene().telemetry["power"].value == 3.5


@pytest.mark.parametrize("end", ("stop", "with", "close", "connect", "flush"))
def test_its_end_waits_for_the_last_command(tmp_path, folder, end):
    """With nothing waited for before: what is on its way then is far more than what has been recorded."""
    path, steps = tmp_path / "a.dspace", 5000
    with Served(tmp_path, "--allow-root", folder) as server:
        session = dspace.connect(server.address)
        scene = session.scene()
        rover = scene.add_frame("rover")
        session.wait = False

        def run():
            for i in range(1, steps + 1):
                rover.pose = dspace.Pose((i, 0, 0))

        if end == "with":
            with session.record(path):
                run()
        elif end == "connect":
            with session:
                session.record(path)
                run()
        else:
            recording = session.record(path)
            run()
            getattr(session if end == "close" else recording, end)()
            if end == "flush":
                assert recording.counts["written"] == steps and recording.active
                with RecordingFile(path) as file:
                    assert file.last == steps
        session.close()
    assert last_place(path) == steps


def test_what_was_refused_is_told_and_the_rest_is_there(tmp_path, folder):
    path = tmp_path / "a.dspace"
    bad = pb.Command()
    bad.set_poses.frame.append(12345)
    bad.set_poses.pose.extend((0, 0, 0, 1, 0, 0, 0, 1))
    with Served(tmp_path, "--allow-root", folder) as server, dspace.connect(server.address) as session:
        scene, rover = build(session, folder)
        session.wait = False
        recording = session.record(path)
        for i in range(100):
            rover.pose = dspace.Pose((i, 0, 0))
        session.execute(bad)
        with pytest.raises(dspace.NotFound, match="12345"):
            recording.stop()
    assert last_place(path) == 99


def test_what_another_simulation_does_belongs_to_it(tmp_path, folder):
    path = tmp_path / "a.dspace"
    with Served(tmp_path, "--allow-root", folder) as server, dspace.connect(server.address) as session:
        scene, rover = build(session, folder)
        recording = session.record(path)
        with dspace.connect(server.address, name="other", take_over=True) as other:
            other.scene().frame("rover").pose = dspace.Pose((7, 0, 0))
            end = time.monotonic() + 60
            while recording.counts["accepted"] < 1:
                assert time.monotonic() < end
                time.sleep(0.02)
        with pytest.raises(dspace.Error, match="taken over"):
            scene.time = 1.0
        recording.stop()
    assert last_place(path) == 7


def record(session, path):
    """Where one viewer has just gone, whose place a server needs a moment to give to another one."""
    end = time.monotonic() + 60
    while True:
        try:
            return session.record(path)
        except dspace.Resource:
            assert time.monotonic() < end


def test_bad_recordings_are_refused(tmp_path, folder):
    with Served(tmp_path, "--allow-root", folder, "--max-connections", "2") as server:
        with dspace.connect(server.address) as session:
            scene, rover = build(session, folder)
            (tmp_path / "there").write_text("")
            with pytest.raises(dspace.AlreadyExists, match="there"):
                session.record(tmp_path / "there")
            with pytest.raises(dspace.NotFound, match="folder"):
                session.record(tmp_path / "no" / "run.dspace")
            with pytest.raises(dspace.InvalidArgument, match="0.001 to 60"):
                session.record(tmp_path / "run.dspace", commit_every=0)
            with dspace.watch(server.address):  # the only place of a viewer
                with pytest.raises(dspace.Error, match="already; accepted: no more"):
                    session.record(tmp_path / "run.dspace")
            recording = record(session, tmp_path / "run.dspace")
            with pytest.raises(dspace.AlreadyExists, match="one recording"):
                session.record(tmp_path / "other.dspace")
            recording.stop()
            (folder / "part.obj").unlink()
            with pytest.raises(dspace.Io, match="import_object.*part.obj"):
                record(session, tmp_path / "less.dspace")
            rover.pose = dspace.Pose((1, 2, 3))  # the session is as good as ever
        with pytest.raises(dspace.Closed):
            session.record(tmp_path / "late.dspace")
    assert not {"other.dspace", "less.dspace", "late.dspace"} & set(os.listdir(tmp_path))


def test_a_kill_of_the_server_leaves_a_recording_and_an_error(tmp_path, folder):
    path = tmp_path / "a.dspace"
    with Served(tmp_path, "--allow-root", folder) as server:
        with dspace.connect(server.address, timeout=5.0) as session:
            scene, rover = build(session, folder)
            recording = session.record(path)
            drive(scene, rover, 0, 50)
            recording.flush()
            server.kill()
            with warnings.catch_warnings(record=True) as told:  # by the first command that knows
                warnings.simplefilter("always")
                with pytest.raises(dspace.Error, match="server 'unix:"):
                    scene.time = 50.0
                end = time.monotonic() + 60
                while recording.active:
                    assert time.monotonic() < end
                    time.sleep(0.05)
                for _ in range(2):
                    with pytest.raises(dspace.Error):
                        scene.time = 51.0
            said = [str(each.message) for each in told]
            assert len(said) == 1 and "a.dspace" in said[0] and "has not responded" in said[0] and "what was written stays" in said[0]
            assert "has not responded for 5 s" in recording.failure and session.recording is None
            with pytest.raises(dspace.Io, match="has not responded"):
                recording.stop()
    with RecordingFile(path) as file:
        file.check()
        assert file.lost == []
    assert last_place(path) == 0.3 * 49


def test_commands_that_never_come_are_missed(tmp_path, folder):
    """Told to be done, and then the server is gone before they were passed on: stop() says that they are missing."""
    path = tmp_path / "a.dspace"
    with Served(tmp_path, "--allow-root", folder) as server:
        with dspace.connect(server.address, timeout=5.0) as session:
            scene, rover = build(session, folder)
            recording = session.record(path)
            drive(scene, rover, 0, 3)
            recording.flush()
            session._client.sequence += 2  # as a server has it that died just then
            server.kill()
            with pytest.raises(dspace.Io, match="a.dspace.*(2 commands.*have not come|has not responded)"):
                recording.stop()
    assert last_place(path) == 0.3 * 2


def test_a_full_disk_is_told_once_and_the_session_goes_on(tmp_path):
    path = tmp_path / "run.dspace"
    with Served(tmp_path) as server:
        script = f"""
import resource, signal, time, warnings
import dspace
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
warnings.simplefilter("always")
with dspace.connect({server.address!r}) as session, warnings.catch_warnings(record=True) as told:
    frame = session.scene().add_frame("rover")
    recording = session.record({str(path)!r}, commit_every=0.001)
    recording.flush()
    resource.setrlimit(resource.RLIMIT_FSIZE, (8 << 20, 8 << 20))
    session.wait = False
    i = 0
    while recording.active:
        frame.pose = dspace.Pose((i, 0, 0))
        i += 1
        if i == 200:
            recording.flush()
    session.wait = True
    frame.pose = dspace.Pose((-1, 0, 0))
    assert frame.position[0] == -1
    assert len(told) == 1 and "run.dspace" in str(told[0].message), [str(w.message) for w in told]
    assert recording.failure and session.recording is None
    try:
        recording.stop()
    except dspace.Io as error:
        assert "run.dspace" in str(error)
    else:
        raise SystemExit("no error")
    assert 100 < recording.counts["written"] < i
    print(recording.counts["written"])
"""
        done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr
    with RecordingFile(path) as file:
        file.check()
        assert file.last == int(done.stdout)
    assert last_place(path) == int(done.stdout) - 1
