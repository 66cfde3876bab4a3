"""`dspace watch` saves pictures of a simulation that runs, and says when it has gone."""
import os
import signal
import subprocess
import sys
import threading
import time

import pytest

import dspace
from dspace.command_line.watch import Presence
from served_support import Served, socket_folder

RUN = [sys.executable, "-W", "ignore", "-m", "dspace", "watch"]


class Watched:
    """The command, as a process whose lines are read."""

    def __init__(self, *arguments):
        self.process = subprocess.Popen([*RUN, *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                        text=True)

    def line(self):
        return self.process.stdout.readline().strip()

    def __enter__(self):
        return self

    def __exit__(self, *exception):
        self.process.kill()
        self.process.communicate()


def build(session, step=0):
    scene = session.scene()
    scene.add_sphere(1.0, frame=scene.add_frame("ball"), color="#e02020")
    scene.add_camera("main", eye=(6.0, 0.0, 2.0), target=(0.0, 0.0, 0.0))
    scene.add_viewport((160, 120), "main", name="view")
    return scene


def test_pictures_of_a_run_until_it_ends(tmp_path):
    out, reference = tmp_path / "out", tmp_path / "reference.png"
    with Served(tmp_path, "--allow-root", str(tmp_path)) as server, \
            dspace.connect(server.address, name="drive") as session:
        with Watched(server.address, "--out", out, "--every", "0.01") as watch:
            scene = build(session)  # it waits for a viewport
            while not os.path.exists(out / "000000.png"):
                assert watch.process.poll() is None
                time.sleep(0.01)
            for step in range(1, 4):
                scene.set_poses(["ball"], [[0.0, 0.3 * step, 0.0, 1.0, 0.0, 0.0, 0.0]])
                scene.time = step  # the last that changes
                while not watch.line().endswith(f": {step:.3f} s"):
                    assert watch.process.poll() is None
            session.viewports["view"].save(reference)
            last = sorted(os.listdir(out))[-1]
            assert (out / last).read_bytes() == reference.read_bytes()
            session.close()
            lines = watch.process.stdout.read().splitlines()
            count = len(os.listdir(out))
            assert lines[-1] == f"dspace watch: simulation 'drive' has gone; {count} pictures in {out}"
            assert watch.process.wait(timeout=60) == 0
            assert sorted(os.listdir(out))[-1] != last  # one with the banner


def test_a_view_of_ones_own_and_the_ways_to_end(tmp_path):
    with Served(tmp_path) as server, dspace.connect(server.address, name="drive") as session:
        build(session)
        own = ("--eye", "-6,1,2", "--target", "0,0,0", "--frame", "ball", "--fov", "30", "--size", "80x60")
        run = subprocess.run([*RUN, server.address, "--out", tmp_path / "own", *own, "--count", "1"], check=True,
                             stdout=subprocess.PIPE, text=True, timeout=120)
        assert run.stdout.splitlines()[-1] == f"dspace watch: ended; 1 pictures in {tmp_path / 'own'}"
        with dspace.Session() as local:
            scene = build(local)
            camera = scene.add_camera("own", frame="ball", eye=(-6.0, 1.0, 2.0), target=(0.0, 0.0, 0.0), fov_deg=30.0)
            scene.add_viewport((80, 60), camera).save(tmp_path / "wanted.png")
        assert (tmp_path / "own" / "000000.png").read_bytes() == (tmp_path / "wanted.png").read_bytes()
        with Watched(server.address, "--out", tmp_path / "ended") as watch:
            assert watch.line().endswith("000000.png: 0.000 s")
            watch.process.send_signal(signal.SIGINT)
            assert watch.process.wait(timeout=60) == 0 and "ended; 1 pictures" in watch.line()
        with Watched(server.address, "--out", tmp_path / "lost") as watch:
            assert watch.line().endswith("000000.png: 0.000 s")
            server.kill()
            lines = watch.process.stdout.read().splitlines()
            assert lines[-1] == f"dspace watch: the server has gone; 2 pictures in {tmp_path / 'lost'}"


def test_it_stays_for_the_next_simulation(tmp_path):
    with Served(tmp_path) as server:
        with dspace.connect(server.address, name="first") as session:
            build(session)
            watch = Watched(server.address, "--out", tmp_path / "out", "--every", "0.01", "--stay")
            assert watch.line().endswith("000000.png: 0.000 s")
        with watch:
            while watch.line() != "dspace watch: simulation 'first' has gone; waiting":
                assert watch.process.poll() is None
            with dspace.connect(server.address, name="second", timeout=20.0) as session:
                session.scene().time = 7.0
                while not watch.line().endswith(": 7.000 s"):
                    assert watch.process.poll() is None
            while watch.line() != "dspace watch: simulation 'second' has gone; waiting":
                assert watch.process.poll() is None
            server.kill()  # while nobody drives
            while watch.line() != "dspace watch: the server has gone; waiting":
                assert watch.process.poll() is None
            with Served(tmp_path), dspace.connect(server.address, name="third", timeout=20.0) as session:
                build(session).time = 8.0
                while not watch.line().endswith(": 8.000 s"):
                    assert watch.process.poll() is None


def noted(watch, text):
    """Reads on until this is said on the error stream, for up to a minute; what was said before."""
    said, late = [], threading.Timer(60.0, watch.process.kill)
    late.start()
    try:
        for line in watch.process.stderr:
            said.append(line.strip())
            if said[-1] == f"dspace: note: {text}":
                return said[:-1]
    finally:
        late.cancel()
    raise AssertionError(said)


def test_it_says_what_it_waits_for_and_ends_without_it(tmp_path):
    own = ("--eye", "1,2,3", "--target", "0,0,0")
    with Served(tmp_path) as server:
        with Watched(server.address, "--out", tmp_path / "first", "--viewport", "vieport") as watch:
            noted(watch, "no simulation has begun; waiting for viewport 'vieport'; there are: none")
            with dspace.connect(server.address, name="drive") as session:
                build(session)
                noted(watch, "waiting for viewport 'vieport'; there are: 'view'")
                session.scene().add_viewport((8, 8), "main", name="wide")
                noted(watch, "waiting for viewport 'vieport'; there are: 'view', 'wide'")
                session.scene().time = 1.0
                time.sleep(3.0)  # what is as it was is not told again
                session.viewports["wide"].remove()
                assert noted(watch, "waiting for viewport 'vieport'; there are: 'view'") == []
                with Watched(server.address, "--out", tmp_path / "a", *own, "--scene", "field") as other:
                    noted(other, "waiting for scene 'field'; there are: 'scene'")
                with Watched(server.address, "--out", tmp_path / "b", *own, "--frame", "bal") as other:
                    noted(other, "waiting for frame 'bal'; there are: 'ball'")
            assert watch.process.wait(timeout=60) == 1
            assert watch.process.stderr.read() == ("dspace: simulation 'drive' has gone; there was no viewport "
                                                   "'vieport'; there are: 'view'\n")
        # It had gone before.
        run = lambda *words: subprocess.run([*RUN, server.address, *words], stdout=subprocess.PIPE,
                                            stderr=subprocess.PIPE, text=True, timeout=120)
        for words, lacks in ((("--viewport", "vieport"), "viewport 'vieport'; there are: 'view'"),
                             ((*own, "--scene", "field"), "scene 'field'; there are: 'scene'")):
            ended = run("--out", tmp_path / "none", *words)
            assert ended.returncode == 1
            assert ended.stderr == f"dspace: the simulation had gone before; there was no {lacks}\n"
        ended = run("--out", tmp_path / "last")
        assert ended.returncode == 0 and os.listdir(tmp_path / "last") == ["000000.png"]
        assert "the simulation had gone before; 1 pictures" in ended.stdout
        with Watched(server.address, "--out", tmp_path / "stays", "--viewport", "vieport", "--stay") as watch:
            noted(watch, "the simulation has gone; waiting for viewport 'vieport'; there are: 'view'")
        # A folder that cannot be one, and one that has pictures.
        for folder, says in ((__file__, "accepted: a folder that may be made and written"),
                             (tmp_path / "last", "it holds '000000.png'; accepted: a new folder")):
            ended = run("--out", folder)
            assert ended.returncode == 1 and f"--out {str(folder)!r}: " in ended.stderr and says in ended.stderr


class Changing:
    """A watcher whose link is as each of the given answers says, one a look: the driver's name, "" for none, or None
    without a server."""

    def __init__(self, *answers):
        self.answers = list(answers)

    def _next(self):
        return self.answers.pop(0) if len(self.answers) > 1 else self.answers[0]

    @property
    def simulation(self):
        return self._next() or None

    @property
    def connected(self):
        return self._next() is not None


def test_whatever_goes_between_two_looks_is_told():
    # At first, then who drives and whether there is a server, in turns.
    presence = Presence(Changing("drive", "drive", "drive", "drive", None))
    assert presence.disconnected() is None
    assert presence.disconnected() == "the server has gone"  # between the two
    assert [presence.disconnected() for _ in range(3)] == [None] * 3  # told once
    for first in ("drive", ""):
        presence = Presence(Changing(first, first, first, None))
        assert [presence.disconnected() for _ in range(3)] == [None, "the server has gone", None]
    presence = Presence(Changing("drive", "", "", "", "", "next", "next", ""))
    assert [presence.disconnected() for _ in range(5)] == [
        "simulation 'drive' has gone", None, None, "simulation 'next' has gone", None]


@pytest.mark.parametrize("number", (signal.SIGINT, signal.SIGTERM))
def test_it_can_be_ended_while_it_connects(tmp_path, number):
    with Watched(f"unix:{socket_folder(tmp_path)}/nobody", "--out", tmp_path / "out") as watch:
        pid, others, caught = watch.process.pid, [], 0
        while not others or not caught & 1 << signal.SIGTERM - 1:  # it connects, and hears
            assert watch.process.poll() is None
            others = [int(each) for each in os.listdir(f"/proc/{pid}/task") if int(each) != pid]
            with open(f"/proc/{pid}/status") as status:
                caught = int(next(line for line in status if line.startswith("SigCgt")).split()[1], 16)
        watch.process.send_signal(number)
        assert watch.line() == f"dspace watch: ended while it was connecting; 0 pictures in {tmp_path / 'out'}"
        assert watch.process.wait(timeout=60) == 0


@pytest.mark.parametrize("arguments, text", [
    (("--every", "0"), "--every 0; accepted: more than 0 s"),
    (("--count", "0"), "--count 0; accepted: 1 and more"),
    (("--eye", "1,2,3"), "accepted: both"),
    (("--fov", "30"), "--fov belongs to a separate view"),
    (("--eye", "1,2,3", "--target", "0,0,0", "--viewport", "view"), "one or the other")])
def test_what_is_wrong_is_said(tmp_path, arguments, text):
    run = subprocess.run([*RUN, f"unix:{socket_folder(tmp_path)}/nobody", "--out", tmp_path / "out", *arguments],
                         stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, timeout=120)
    assert run.returncode == 1 and text in run.stderr and len(run.stderr.splitlines()) == 1
    assert not (tmp_path / "out").exists()


def test_of_several_viewports_one_is_named(tmp_path):
    with Served(tmp_path) as server, dspace.connect(server.address) as session:
        build(session).add_viewport((80, 60), "main", name="other")
        run = subprocess.run([*RUN, server.address, "--out", tmp_path / "out"], stdout=subprocess.PIPE,
                             stderr=subprocess.PIPE, text=True, timeout=120)
        assert run.returncode == 1 and "'other', 'view'" in run.stderr and "--viewport" in run.stderr
        subprocess.run([*RUN, server.address, "--out", tmp_path / "out", "--viewport", "other", "--count", "1"],
                       check=True, stdout=subprocess.DEVNULL, timeout=120)
        assert (tmp_path / "out" / "000000.png").exists()
