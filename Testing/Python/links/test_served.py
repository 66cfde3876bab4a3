"""The same script in a local session and in a server process; limits of `dspace serve`; viewers."""
import os
import pathlib
import signal
import socket
import subprocess
import sys

import numpy as np
import pytest

import dspace
from served_support import Served

DATA = pathlib.Path(os.environ.get("DSPACE_SHIPPED_DATA", pathlib.Path(__file__).parents[3] / "Data"))


def script(session, field):
    """A scene with everything in it, and everything that can be asked of it, as bytes."""
    scene = session.scene()
    terrain = scene.add_terrain(field, name="field")
    robot = scene.load(DATA / "rover" / "rover.urdf", position=(0.0, 0.0, 1.0))
    model = scene.load(DATA / "rover" / "chassis.gltf", name="model", position=(3.0, 2.0, 3.0), up="y")
    mast = scene.add_frame("mast", position=(1.0, 1.0, 2.0))
    scene.add_sphere(0.5, frame=mast, color="#d04020", name="ball")
    scene.add_label("Größe 5 µm", frame=mast)
    trail = scene.add_trail(capacity=100)
    camera = scene.add_camera("main", eye=(9.0, -9.0, 7.0), target=(0.0, 0.0, 1.0))
    viewport = scene.add_viewport((320, 240), camera, name="view")
    out = []
    for step in range(3):
        scene.time = 0.5 * step
        scene.set_poses([mast], [[1.0 + step, 1.0, 2.0, 1.0, 0.0, 0.0, 0.0]])
        trail.append([[step, 0.0, 3.0]])
        planes = viewport.capture(color=True, depth=True, label=True)
        out += [planes[name].tobytes() for name in ("color", "depth", "label")]
        out.append(scene.poses(list(scene.frames.values()), relative_to=scene.root).tobytes())
    out.append(repr(viewport.pick(160, 120)).encode())
    x = np.linspace(-5.0, 5.0, 11)
    out.append(np.asarray(terrain.height(x, x)).tobytes())
    out.append(repr((sorted(scene.objects), sorted(scene.frames), model.name, robot.name)).encode())
    with pytest.raises(dspace.NotFound) as refused:
        scene.frame("nowhere")
    out.append(str(refused.value).encode())
    planes["color"][0, 0] = 0  # a picture is one's own
    return out


def test_the_same_script_gives_the_same_bytes(tmp_path, field):
    with dspace.Session() as session:
        local = script(session, field)
    with Served(tmp_path, "--allow-root", str(DATA), "--allow-root", str(tmp_path)) as server:
        with dspace.connect(server.address) as session:
            served = script(session, field)
        assert server.process.poll() is None
    assert server.code == 0, server.log()
    assert [len(each) for each in served] == [len(each) for each in local]
    assert [i for i, (a, b) in enumerate(zip(local, served)) if a != b] == []
    assert len(set(local[0])) > 10  # a picture of something


def again(session):
    """A script that fails on a server that still has its scenes: its names are taken."""
    scene = session.scene()
    scene.load(DATA / "rover" / "rover.urdf", name="rover")
    scene.telemetry.add("rover/power", unit="W").value = 3.0
    scene.add_camera("main", eye=(9.0, -9.0, 7.0), target=(0.0, 0.0, 1.0))
    scene.add_viewport((64, 48), name="view")
    return sorted(session.scenes), sorted(session.viewports), sorted(scene.frames), sorted(scene.telemetry)


def test_a_script_runs_again_in_the_same_session():
    with dspace.Session() as session:
        session.scene("other").add_frame("left over")
        first = again(session)
        with pytest.raises(dspace.AlreadyExists):
            again(session)
        session.reset()
        assert not session.scenes and not session.viewports
        session.scene("other")
        assert again(session) == first
        session.reset()
        session.reset()  # of nothing


def test_a_script_runs_again_on_the_same_server(tmp_path):
    with Served(tmp_path, "--allow-root", str(DATA)) as server:
        with dspace.connect(server.address) as session:
            first = again(session)
        with dspace.connect(server.address) as session, pytest.raises(dspace.AlreadyExists):
            again(session)
        with dspace.watch(server.address) as watcher:
            with dspace.connect(server.address, fresh=True) as session:
                assert not session.scenes and not session.viewports
                assert again(session) == first
                sequence = session._client.sequence
            while watcher.sequence < sequence:
                assert watcher.update(20.0), watcher.error
            assert sorted(watcher.scenes) == first[0]
        with pytest.raises(dspace.Error, match="fresh"):
            dspace.connect(server.address, fresh="yes")


def test_a_server_can_begin_anew_with_each_driver(tmp_path):
    run = tmp_path / "run.dspace"
    with Served(tmp_path, "--allow-root", str(DATA), "--fresh-on-connect", "--record", str(run)) as server:
        with dspace.connect(server.address) as session:
            first = again(session)
        with dspace.connect(server.address) as session:
            assert again(session) == first
            with pytest.raises(dspace.AlreadyExists):  # its own scenes stay while it drives
                again(session)
    with dspace.Playback(str(run)) as playback:  # the recording has the removal
        playback.seek(playback.duration)
        assert sorted(playback.session.scenes) == ["scene"]


def test_a_viewer_draws_the_same_picture(tmp_path):
    with Served(tmp_path) as server, dspace.connect(server.address, name="drive") as session:
        scene = session.scene()
        ball = scene.add_frame("ball")
        scene.add_sphere(1.0, frame=ball, color="#20a040")
        camera = scene.add_camera("main", eye=(6.0, 0.0, 2.0), target=(0.0, 0.0, 0.0))
        viewport = scene.add_viewport((160, 120), camera, name="view")
        with dspace.watch(server.address) as early:
            session.wait = False
            for step in range(50):
                scene.set_poses([ball], [[0.0, 0.02 * step, 0.0, 1.0, 0.0, 0.0, 0.0]])
            session.flush()
            wanted = viewport.image()
            with dspace.watch(server.address) as late:
                for watcher in (late, early):
                    while watcher.sequence < late.sequence or watcher.sequence < 55:
                        assert watcher.update(20.0), (watcher.sequence, watcher.error)
                    assert watcher.error == ""
                    assert watcher.simulation == "drive"
                    assert np.array_equal(watcher.viewports["view"].image(), wanted)
            # It looks from elsewhere, and changes nothing.
            with pytest.raises(dspace.Unsupported, match="a viewer cannot change the scene"):
                early.scenes["scene"].add_frame("mine")
            mine = early.scenes["scene"].add_viewport((80, 60), camera="main")
            assert mine.name == "viewer:1" and mine.image().shape == (60, 80, 3)
            # The other way.
            heard = []
            session.on_event(heard.append)
            early.answer("deploy?", "go")
            assert len(session.process_events(wait=20.0)) == 1
            assert heard[0].answer.answer == "go"


def test_who_was_taken_over_from_is_told(tmp_path):
    with Served(tmp_path) as server, dspace.connect(server.address, name="first") as first:
        first.scene()
        with dspace.connect(server.address, name="second", take_over=True) as second:
            second.scene()  # one that there is
            with pytest.raises(dspace.AlreadyExists, match="'second' has taken over"):
                first.scene()


def test_a_simulations_death_leaves_the_last_picture(tmp_path):
    drive = ("import dspace, sys, time\n"
             "session = dspace.connect(sys.argv[1], name='doomed')\n"
             "scene = session.scene()\n"
             "scene.add_box((1, 1, 1), color='#ff0000')\n"
             "camera = scene.add_camera('main', eye=(4, 0, 1), target=(0, 0, 0))\n"
             "scene.add_viewport((320, 120), camera, name='view')\n"
             "print('ready', flush=True)\n"
             "time.sleep(600)\n")
    with Served(tmp_path) as server:
        simulation = subprocess.Popen([sys.executable, "-c", drive, server.address],
                                      stdout=subprocess.PIPE, text=True)
        try:
            assert simulation.stdout.readline() == "ready\n"
            with dspace.watch(server.address) as watcher:
                before = watcher.viewports["view"].image()
                assert watcher.simulation == "doomed"
                simulation.kill()
                simulation.wait()
                while watcher.simulation is not None:
                    watcher.update(5.0)
                after = watcher.viewports["view"].image()
                assert np.array_equal(after[:60], before[:60]) and (before != before[0, 0]).any()
                assert not np.array_equal(after, before)  # says so in its lower corner
                bare = watcher.viewports["view"].image(physical_only=True)
                # The next one goes on where it was.
                with dspace.connect(server.address, name="next", timeout=10.0) as session:
                    assert list(session.scene().objects)
                    while watcher.simulation != "next":
                        assert watcher.update(20.0)
                    assert np.array_equal(watcher.viewports["view"].image(), before)
                    # And so it does when the server dies.
                    server.kill()
                    with pytest.raises(dspace.Error):
                        session.scene().add_frame("late")
                while watcher.connected:
                    watcher.update(0.2)
                assert np.array_equal(watcher.viewports["view"].image(physical_only=True), bare)
        finally:
            simulation.kill()
            simulation.wait()
            simulation.stdout.close()


def test_files_outside_of_the_roots_are_refused(tmp_path):
    root = tmp_path / "root"
    root.mkdir()
    with Served(tmp_path, "--allow-root", str(root)) as server, \
            dspace.connect(server.address) as session:
        scene = session.scene()
        scene.add_camera("main", eye=(4, 0, 1), target=(0, 0, 0))
        viewport = scene.add_viewport((32, 32), name="view")
        viewport.save(root / "picture.png")
        assert (root / "picture.png").exists()
        for path in (tmp_path / "picture.png", root / ".." / "picture.png", "/etc/passwd"):
            with pytest.raises(dspace.InvalidArgument, match="outside of the folders that the server allows"):
                viewport.save(path)
        with pytest.raises(dspace.InvalidArgument, match="outside of the folders that the server allows"):
            scene.load(DATA / "rover" / "rover.urdf")
        assert not (tmp_path / "picture.png").exists()


def test_certificates_decide_who_is_let_in(tmp_path):
    for name in ("ours", "others"):
        subprocess.run([sys.executable, "-m", "dspace", "serve", "--make-test-certificates",
                        str(tmp_path / name)], check=True)
        assert not (tmp_path / name / "ca.key").exists()
        assert (tmp_path / name / "server.key").stat().st_mode & 0o077 == 0
    ours, others = tmp_path / "ours", tmp_path / "others"
    with Served(tmp_path, "--cert", str(ours / "server.pem"), "--key", str(ours / "server.key"),
                "--ca", str(ours / "ca.pem"), listen="127.0.0.1:0") as server:
        good = {"certificate": ours / "client.pem", "key": ours / "client.key",
                "authority": ours / "ca.pem"}
        with dspace.connect(server.address, **good) as session:
            session.scene().add_frame("mine")
            # Nobody else gets anything: without certificates, with another authority's, with a server's.
            for wrong in ({}, {"certificate": others / "client.pem", "key": others / "client.key",
                               "authority": ours / "ca.pem"},
                          {"certificate": others / "client.pem", "key": others / "client.key",
                           "authority": others / "ca.pem"}):
                for link in (dspace.connect, dspace.watch):
                    with pytest.raises((dspace.Io, dspace.DeadlineExceeded)):
                        link(server.address, timeout=1.0, **wrong)
            with dspace.watch(server.address, **good) as watcher:
                assert list(watcher.scenes["scene"].frames) == ["mine"]


def test_addresses_beyond_this_machine_need_certificates(tmp_path):
    run = subprocess.run([sys.executable, "-m", "dspace", "serve", "--listen", "0.0.0.0:0"],
                         stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, timeout=120)
    assert run.returncode == 1 and "insecure" in run.stderr and run.stdout == ""
    with pytest.raises(dspace.InvalidArgument, match="insecure"):
        dspace.connect("example.org:4000")
    with Served(tmp_path, "--insecure", listen="0.0.0.0:0") as server:
        port = server.address.rsplit(":", 1)[1]
        with dspace.connect(f"127.0.0.1:{port}") as session:
            session.scene()
    assert server.code == 0 and "nothing is encrypted" in server.log()


def test_what_is_no_grpc_is_survived(tmp_path):
    """Random bytes, cut and changed messages on the socket: the server goes on serving."""
    random = np.random.default_rng(5)
    preface = b"PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n"
    corpus = [b"", preface, preface + bytes(9), b"GET / HTTP/1.1\r\n\r\n",
              preface + b"\x00\x00\x00\x04\x00\x00\x00\x00\x00" + b"\xff" * 64,
              preface + b"\xff\xff\xff\x00\x00\x00\x00\x00\x01"]
    with Served(tmp_path) as server, dspace.connect(server.address) as session:
        scene = session.scene()
        for i in range(200):
            data = bytearray(corpus[i % len(corpus)] + random.bytes(random.integers(0, 2000)))
            for _ in range(random.integers(0, 8)):
                if data:
                    data[random.integers(len(data))] = random.integers(256)
            with socket.socket(socket.AF_UNIX) as plain:
                plain.connect(server.address[len("unix:"):])
                try:
                    plain.sendall(data)
                except OSError:
                    pass
            if i % 20 == 0:
                scene.add_frame(f"frame {i}")
        assert len(scene.frames) == 10


@pytest.mark.parametrize("number", (signal.SIGTERM, signal.SIGINT))
def test_it_ends_cleanly(tmp_path, number):
    with Served(tmp_path) as server, dspace.connect(server.address, timeout=10.0) as session:
        session.scene()
        server.process.send_signal(number)
        assert server.process.wait(timeout=60) == 0
        with pytest.raises((dspace.Io, dspace.DeadlineExceeded)):
            session.scene().add_frame("late")
    assert not os.path.exists(server.listen[len("unix:"):])


def test_the_demo_is_the_same_when_it_is_served(tmp_path):
    demo = pathlib.Path(__file__).parents[3] / "Examples" / "rover_drive" / "rover_drive.py"
    sheets = []
    for served in ((), ("--served",)):
        out = tmp_path / f"out{len(sheets)}"
        run = subprocess.run([sys.executable, demo, "--out", out, "--seconds", "0.1", "--size", "160x120",
                              "--mode", "triangles", *served], check=True, stdout=subprocess.PIPE, text=True)
        assert ("served by process" in run.stdout) == bool(served)
        sheets.append((out / "contact_sheet.png").read_bytes())
    assert sheets[0] == sheets[1]
