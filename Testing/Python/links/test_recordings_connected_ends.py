"""How recordings of sessions in a server end: late and cut links, what cannot be done, and programs that end."""
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
from connected_support import BOX, build, drive, folder, last_place  # noqa: F401 (a fixture)
from dspace.recording.file import RecordingFile
from served_support import Served, stand_still


# Between clients and a server's socket. Of all connections but the first one "hold" keeps what comes until "free", and
# "cut" breaks what there is and holds. A process of its own: waits on a server are slices in which no other thread of Python runs.
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
        free.clear()
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
    assert len(told) == 1 and "a command of the server failed here" in str(told[0].message) and "late.obj" in str(told[0].message)
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
                    drive(scene, rover, 10, 13)  # before anybody watches again
                    assert not told
                    say(proxy, "free")
                    end, number = time.monotonic() + 60, 13
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
import sys, time
import dspace
session = dspace.connect(sys.argv[1], timeout=600.0)
rover = session.scene().add_frame("rover")
recording = session.record(sys.argv[2])
session.wait = False
print("recording", flush=True)
sys.stdin.readline()
rover.pose = dspace.Pose((1, 0, 0))
if sys.argv[3] == "exit":
    sys.exit(0)
print("waiting", flush=True)
if sys.argv[3] == "stop":
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
                                       how], stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                      text=True)
        try:
            assert simulation.stdout.readline() == "recording\n"
            stand_still(server.process.pid)
            simulation.stdin.write("\n")
            simulation.stdin.flush()
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
