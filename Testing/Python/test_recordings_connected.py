"""Recordings that a simulation makes of a session in a server: session.record() of dspace.connect()."""
import gc
import os
import signal
import subprocess
import sys
import threading
import time
import warnings

import numpy
import pytest

import dspace
from dspace.command_line import main
from dspace.recording_file import RecordingFile
from dspace.session import commands_pb2 as pb
from served_support import Served

BOX = "v 0 0 0\nv 2 0 0\nv 0 2 0\nv 0 0 2\nf 1 2 3\nf 1 2 4\nf 1 3 4\nf 2 3 4\n"


def build(session, folder):
    scene = session.scene()
    rover = scene.add_frame("rover")
    scene.load(str(folder / "part.obj"), frame=rover)
    scene.add_viewport((80, 60), scene.add_camera("c", eye=(-6, -5, 4), target=(1, 0, 0)), name="view")
    scene.telemetry.add("power", unit="W").value = 3.5
    return scene, rover


def drive(scene, rover, begin, end):
    for i in range(begin, end):
        scene.time = float(i)
        rover.pose = dspace.Pose((0.3 * i, 0, 0))


def last_place(path):
    """Of the rover, where the recording ends."""
    with dspace.Playback(path) as run:
        run.step(len(run.times))
        return run.session.scene().frame("rover").pose.position[0]


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "files").mkdir()
    (tmp_path / "files/part.obj").write_text(BOX)
    return tmp_path / "files"


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
        with dspace.connect(server.address, timeout=1.0) as session:
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
            assert len(said) == 1 and "a.dspace" in said[0] and "is gone" in said[0] and "what was written stays" in said[0]
            assert "nobody answers within 1 s" in recording.failure and session.recording is None
            with pytest.raises(dspace.Io, match="is gone"):
                recording.stop()
    with RecordingFile(path) as file:
        file.check()
        assert file.lost == []
    assert last_place(path) == 0.3 * 49


def test_commands_that_never_come_are_missed(tmp_path, folder):
    """Told to be done, and then the server is gone before they were passed on: stop() says that they are missing."""
    path = tmp_path / "a.dspace"
    with Served(tmp_path, "--allow-root", folder) as server:
        with dspace.connect(server.address, timeout=1.0) as session:
            scene, rover = build(session, folder)
            recording = session.record(path)
            drive(scene, rover, 0, 3)
            recording.flush()
            session._client.sequence += 2  # as a server has it that died just then
            server.kill()
            with pytest.raises(dspace.Io, match="a.dspace.*(2 commands.*have not come|is gone)"):
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


# Between clients and a server's socket. Of all connections but the first one "cut" breaks what there is, and "hold" keeps
# what comes until "free". A process of its own: waits on a server are slices in which no other thread of Python runs.
PROXY = """
import socket, sys, threading

def end(*sockets):
    for each in sockets:
        try:
            each.shutdown(socket.SHUT_RDWR)
        except OSError:
            pass

def forward(one, other, first):
    try:
        while data := one.recv(65536):
            first or free.wait()
            other.sendall(data)
    except OSError:
        pass
    end(one, other)

def accept():
    while True:
        near, far = listener.accept()[0], socket.socket(socket.AF_UNIX)
        far.connect(sys.argv[1])
        pairs.append((near, far))
        for one, other in ((near, far), (far, near)):
            threading.Thread(target=forward, args=(one, other, len(pairs) == 1), daemon=True).start()

listener, pairs, free = socket.create_server(("127.0.0.1", 0)), [], threading.Event()
free.set()
threading.Thread(target=accept, daemon=True).start()
print(f"127.0.0.1:{listener.getsockname()[1]}", flush=True)
for line in sys.stdin:
    if line == "hold\\n":
        free.clear()
    elif line == "free\\n":
        free.set()
    else:
        for pair in pairs[1:]:
            end(*pair)
    print("done", flush=True)
"""


def through(server):
    """The PROXY of a server, and its address."""
    proxy = subprocess.Popen([sys.executable, "-c", PROXY, server.address.removeprefix("unix:")], stdin=subprocess.PIPE,
                             stdout=subprocess.PIPE, text=True)
    return proxy, proxy.stdout.readline().strip()


def say(proxy, word):
    proxy.stdin.write(word + "\n")
    proxy.stdin.flush()
    assert proxy.stdout.readline() == "done\n"


def test_its_end_waits_for_what_is_late(tmp_path):
    """All was done long ago, and nothing of it has come yet."""
    path = tmp_path / "a.dspace"
    with Served(tmp_path) as server:
        proxy, address = through(server)
        with proxy, dspace.connect(address) as session:
            rover = session.scene().add_frame("rover")
            with session.record(path) as recording:
                rover.pose = dspace.Pose((1, 0, 0))
                recording.flush()
                say(proxy, "hold")
                for i in range(2, 5):
                    rover.pose = dspace.Pose((i, 0, 0))
                later = threading.Timer(1.0, say, (proxy, "free"))
                later.start()
            later.join()
    assert last_place(path) == 4


def test_what_cannot_be_done_here_is_recorded_all_the_same(tmp_path, folder):
    """A model that the server has read, and that is gone when it is this process's turn."""
    path, late = tmp_path / "a.dspace", folder / "late.obj"
    with Served(tmp_path, "--allow-root", folder) as server:
        proxy, address = through(server)
        with proxy, dspace.connect(address) as session:
            scene, rover = build(session, folder)
            recording = session.record(path)
            say(proxy, "hold")
            late.write_text(BOX.replace("v 0 2 0", "v 0 3 0"))
            scene.load(str(late), frame=rover)
            late.unlink()
            say(proxy, "free")
            with warnings.catch_warnings(record=True) as told:
                warnings.simplefilter("always")
                end, number = time.monotonic() + 60, 0
                while not told:
                    assert time.monotonic() < end
                    drive(scene, rover, number, number + 1)
                    number += 1
                drive(scene, rover, number, number + 5)
            live = session.viewports["view"].image()
            recording.stop()
    assert len(told) == 1 and "cannot be done here" in str(told[0].message) and "late.obj" in str(told[0].message)
    late.write_text(BOX.replace("v 0 2 0", "v 0 3 0"))
    with dspace.Playback(path, check_assets=False) as run:
        run.seek(number + 4.0)
        assert run.time == number + 4.0 and run.gaps == []
        assert numpy.array_equal(run.session.viewports["view"].image(), live)


def test_it_has_the_sessions_certificates(tmp_path):
    subprocess.run([sys.executable, "-m", "dspace", "serve", "--make-test-certificates", tmp_path / "tls"], check=True)
    tls = {name: str(tmp_path / "tls" / name) for name in ("server.pem", "server.key", "client.pem", "client.key", "ca.pem")}
    with Served(tmp_path, "--cert", tls["server.pem"], "--key", tls["server.key"], "--ca", tls["ca.pem"],
                listen="127.0.0.1:0") as server:
        with dspace.connect(server.address, tls["client.pem"], tls["client.key"], tls["ca.pem"]) as session:
            with session.record(tmp_path / "a.dspace"):
                session.scene().add_frame("rover").pose = dspace.Pose((3, 0, 0))
    assert last_place(tmp_path / "a.dspace") == 3


def test_where_it_is_cut_off_there_is_a_gap(tmp_path, folder):
    path = tmp_path / "a.dspace"
    with Served(tmp_path, "--allow-root", folder) as server:
        proxy, address = through(server)
        with proxy, dspace.connect(address) as session:
            scene, rover = build(session, folder)
            with session.record(path) as recording:
                drive(scene, rover, 0, 10)
                recording.flush()
                say(proxy, "cut")  # all but the simulation's
                with warnings.catch_warnings(record=True) as told:
                    warnings.simplefilter("always")
                    end, number = time.monotonic() + 60, 10
                    while not told:
                        assert time.monotonic() < end
                        drive(scene, rover, number, number + 1)
                        number += 1
                drive(scene, rover, number, number + 10)
                live = session.viewports["view"].image()
    assert "a.dspace" in str(told[0].message) and "has a gap" in str(told[0].message)
    with RecordingFile(path) as file:
        file.check()
        assert len(file.lost) == 1
    with dspace.Playback(path) as run:
        assert len(run.gaps) == 1 and run.gaps[0].before == 10 and run.gaps[0].begin == 9.0
        run.seek(number + 9.0)
        assert run.time == number + 9.0
        assert numpy.array_equal(run.session.viewports["view"].image(), live)


HANGS = """
import os, signal, sys, time
import dspace
session = dspace.connect(sys.argv[1], timeout=600.0)
rover = session.scene().add_frame("rover")
recording = session.record(sys.argv[2])
session.wait = False
os.kill(int(sys.argv[3]), signal.SIGSTOP)
rover.pose = dspace.Pose((1, 0, 0))
if sys.argv[4] == "exit":
    sys.exit(0)
print("waiting", flush=True)
if sys.argv[4] == "stop":
    recording.stop()
else:
    with recording:
        while True:
            time.sleep(0.01)
"""


@pytest.mark.parametrize("how", ("stop", "with", "exit"))
def test_neither_ctrl_c_nor_the_end_of_the_program_hangs(tmp_path, how):
    """The server does not answer, and ten minutes are the timeout."""
    with Served(tmp_path) as server:
        simulation = subprocess.Popen([sys.executable, "-W", "ignore", "-c", HANGS, server.address, tmp_path / "a.dspace",
                                       str(server.process.pid), how], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                      text=True)
        try:
            if how != "exit":
                assert simulation.stdout.readline() == "waiting\n"
                time.sleep(0.3)
                simulation.send_signal(signal.SIGINT)
            _, said = simulation.communicate(timeout=120)
        finally:
            server.process.send_signal(signal.SIGCONT)
            simulation.kill()
            simulation.wait()
        assert ("KeyboardInterrupt" in said) == (how != "exit"), said
    with RecordingFile(tmp_path / "a.dspace") as file:
        file.check()


@pytest.mark.parametrize("wait", (True, False))
def test_a_program_that_just_ends_leaves_all_of_it(tmp_path, wait):
    with Served(tmp_path) as server:
        subprocess.run([sys.executable, "-c", f"""
import dspace
session = dspace.connect({server.address!r})
rover = session.scene().add_frame("rover")
recording = session.record({str(tmp_path / "a.dspace")!r}, commit_every=60)
session.wait = {wait}
for i in range(2000):
    rover.pose = dspace.Pose((i, 0, 0))
"""], check=True, timeout=300)
    assert last_place(tmp_path / "a.dspace") == 1999


def test_a_session_that_is_forgotten_ends_its_recording(tmp_path):
    with Served(tmp_path, "--max-connections", "2") as server:
        session = dspace.connect(server.address)
        session.scene().add_frame("rover")
        session.record(tmp_path / "a.dspace").flush()
        del session
        gc.collect()
        end = time.monotonic() + 60
        while True:  # its places are free again
            try:
                dspace.watch(server.address).close()
                break
            except dspace.Resource:
                assert time.monotonic() < end
    with RecordingFile(tmp_path / "a.dspace") as file:
        file.check()


def test_a_child_process_is_refused(tmp_path):
    path = tmp_path / "a.dspace"
    with Served(tmp_path) as server, dspace.connect(server.address) as session:
        rover = session.scene().add_frame("rover")
        recording = session.record(path)
        rover.pose = dspace.Pose((1, 0, 0))
        child = os.fork()
        if child == 0:
            code = 1
            try:
                for call in (recording.stop, recording.flush, lambda: recording.counts, lambda: recording.failure):
                    try:
                        call()
                    except dspace.Unsupported:
                        code += 1
                code = 0 if code == 5 and not recording.active and session.recording is None else code
                session.close()
                del recording, session
                gc.collect()
            finally:
                os._exit(code)
        assert os.waitpid(child, 0)[1] == 0
        rover.pose = dspace.Pose((2, 0, 0))
        recording.stop()
    assert last_place(path) == 2
