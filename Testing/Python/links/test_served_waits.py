"""Waits on a server: Ctrl-C ends them, and a pace holds simulation time back."""
import signal
import subprocess
import sys
import time

import pytest

import dspace
from served_support import Served, socket_folder, stand_still

WAITS = """
import sys
import dspace

def interrupted(work):
    try:
        print("waiting", flush=True)
        work()
    except KeyboardInterrupt:
        print("interrupted", flush=True)
    else:
        print("it came to its end", flush=True)
    sys.stdin.readline()

session = dspace.connect(sys.argv[1], timeout=600.0)
scene = session.scene()
interrupted(lambda: session.process_events(wait=600.0))
interrupted(lambda: scene.add_frame("first"))  # while the server is stopped
session.wait = False
scene.time = 0.0
interrupted(session.flush)
session.wait = True
scene.add_frame("second")
session.pace = 0.01
scene.time = 1.0
interrupted(lambda: setattr(scene, "time", 10.0))
session.pace = None
scene.time = 2.0
print("second" in scene.frames, scene.time, flush=True)
interrupted(lambda: dspace.connect(sys.argv[2], timeout=600.0))
interrupted(lambda: dspace.watch(sys.argv[2], timeout=600.0))
watcher = dspace.watch(sys.argv[1], timeout=600.0)
print("watching", flush=True)
sys.stdin.readline()
interrupted(lambda: watcher.answer("land", "yes"))  # while the server is stopped
watcher.answer("land", "no")
told = []
while "no" not in told:  # the first one may have come or not, and later too
    told += [event.answer.answer for event in session.process_events(wait=600.0)]
print("told", flush=True)
"""


def test_ctrl_c_ends_every_wait(tmp_path):
    with Served(tmp_path) as server:
        simulation = subprocess.Popen([sys.executable, "-W", "ignore", "-c", WAITS, server.address,
                                       f"unix:{socket_folder(tmp_path)}/nobody"], stdin=subprocess.PIPE,
                                      stdout=subprocess.PIPE, text=True)

        def interrupt(limit=60.0):
            assert simulation.stdout.readline() == "waiting\n"
            time.sleep(0.3)
            simulation.send_signal(signal.SIGINT)
            began = time.monotonic()
            assert simulation.stdout.readline() == "interrupted\n"
            assert time.monotonic() - began < limit  # of the ten minutes that it would have waited

        def go_on():
            simulation.stdin.write("\n")
            simulation.stdin.flush()

        try:
            interrupt()  # of process_events
            stand_still(server.process.pid)
            go_on()
            interrupt()  # of a reply
            go_on()
            interrupt()  # of flush
            server.process.send_signal(signal.SIGCONT)
            go_on()
            interrupt()  # of a pace
            go_on()
            assert simulation.stdout.readline() == "True 2.0\n"  # the session is as good as ever
            for _ in range(2):
                interrupt()  # of a connection, and of a viewer's
                go_on()
            assert simulation.stdout.readline() == "watching\n"
            stand_still(server.process.pid)
            go_on()
            interrupt(20.0)  # of what a viewer says; after 30 s its connection counts as lost
            server.process.send_signal(signal.SIGCONT)
            go_on()
            assert simulation.stdout.readline() == "told\n"
            assert simulation.wait(timeout=60) == 0
        finally:
            server.process.send_signal(signal.SIGCONT)
            simulation.kill()
            simulation.wait()
            simulation.stdin.close()
            simulation.stdout.close()


def test_a_wait_for_events_ends_with_the_link(tmp_path):
    with Served(tmp_path) as server, dspace.connect(server.address, name="first") as first:
        with dspace.connect(server.address, name="second", take_over=True):
            began = time.monotonic()
            with pytest.raises(dspace.Error, match="'second' has taken over"):
                first.process_events(wait=600.0)
            assert time.monotonic() - began < 60.0
            assert first.process_events() == []


@pytest.mark.parametrize("wait", (True, False))
def test_a_pace_is_never_early(tmp_path, wait):
    with Served(tmp_path) as server, dspace.connect(server.address) as session:
        scene = session.scene()
        session.wait = wait
        session.pace = 10.0  # simulation seconds a wall second
        assert session.pace == 10.0
        began = time.monotonic()
        for step in range(31):
            scene.time = 5.0 + 0.1 * step
            assert time.monotonic() - began >= 0.01 * step - 1e-6, step
        began = time.monotonic()
        scene.time = 0.0  # back: counted from here
        scene.time = 2.0
        assert time.monotonic() - began >= 0.2 - 1e-6
        session.flush()
        assert scene.time == 2.0
        session.pace = None
        began = time.monotonic()
        scene.time = 1e9  # thirty years at once
        assert scene.time == 1e9
        for bad in (0.0, -1.0, float("nan"), float("inf")):
            with pytest.raises(dspace.InvalidArgument, match="pace"):
                session.pace = bad
        assert session.pace is None
