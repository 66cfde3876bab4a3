"""Recordings of served sessions: by the server, packed, and by who watches (by who drives: test_recordings_connected)."""
import pathlib
import subprocess
import sys
import time

import numpy
import pytest

import dspace
from dspace.recording.file import RecordingFile
from dspace.links.serving import ServerProcess
from served_support import socket_folder

BOX = "v 0 0 0\nv 2 0 0\nv 0 2 0\nv 0 0 2\nf 1 2 3\nf 1 2 4\nf 1 3 4\nf 2 3 4\n"


def build(session, folder):
    scene = session.scene()
    rover = scene.add_frame("rover")
    scene.load(str(folder / "part.obj"), frame=rover)
    scene.add_viewport((80, 60), scene.add_camera("c", eye=(-6, -5, 4), target=(1, 0, 0)), name="view")
    return scene, rover


def drive(scene, rover, begin, end):
    for i in range(begin, end):
        scene.time = float(i)
        rover.pose = dspace.Pose((0.3 * i, 0, 0))


def until(watcher, holds, seconds=60):
    end = time.monotonic() + seconds
    while not holds():
        assert time.monotonic() < end, "nothing came"
        watcher.update(0.05)


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "files").mkdir()
    (tmp_path / "files/part.obj").write_text(BOX)
    return tmp_path / "files"


def test_a_server_records_and_packs(tmp_path, folder):
    path = tmp_path / "a.dspace"
    with ServerProcess([folder], record=path, pack=True) as server, dspace.connect(server.address) as session:
        scene, rover = build(session, folder)
        drive(scene, rover, 0, 6)
        live = session.viewports["view"].image()
    (folder / "part.obj").unlink()
    with dspace.Playback(path) as run:
        assert run.seek(5.0) == 5.0
        assert numpy.array_equal(run.session.viewports["view"].image(), live)


def test_who_watches_records_what_comes(tmp_path, folder):
    path = tmp_path / "a.dspace"
    with ServerProcess([folder]) as server, dspace.connect(server.address) as session:
        scene, rover = build(session, folder)
        drive(scene, rover, 0, 3)
        with dspace.watch(server.address) as watcher:
            until(watcher, lambda: "scene" in watcher.scenes and watcher.scenes["scene"].time == 2.0)
            with watcher.record(path) as recording:
                drive(scene, rover, 3, 8)
                live = session.viewports["view"].image()
                until(watcher, lambda: watcher.scenes["scene"].frame("rover").pose.position[0] == 0.3 * 7)
                assert recording.active
        drive(scene, rover, 8, 9)  # no longer recorded
    with dspace.Playback(path) as run:
        assert run.times == [2.0, 3.0, 4.0, 5.0, 6.0, 7.0] and run.gaps == []
        run.seek(7.0)
        assert numpy.array_equal(run.session.viewports["view"].image(), live)


@pytest.mark.filterwarnings("ignore::dspace.DspaceWarning")
def test_where_the_watcher_begins_anew_there_is_a_gap(tmp_path, folder):
    """The server goes, another one comes at its address: what happened meanwhile nobody has."""
    path, address = tmp_path / "a.dspace", f"unix:{socket_folder(tmp_path)}/socket"
    command = [sys.executable, "-m", "dspace", "serve", "--listen", address, "--allow-root", folder]

    def serve():
        server = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
        assert "listening" in server.stdout.readline()
        return server

    def end(server):
        server.kill()
        server.wait()
        server.stdout.close()

    server = serve()
    try:
        with dspace.connect(address) as session:
            scene, rover = build(session, folder)
            drive(scene, rover, 0, 3)
            watcher = dspace.watch(address)
            until(watcher, lambda: "scene" in watcher.scenes and watcher.scenes["scene"].time == 2.0)
            recording = watcher.record(path)
            drive(scene, rover, 3, 5)
            until(watcher, lambda: watcher.scenes["scene"].frame("rover").pose.position[0] == 0.3 * 4)
            end(server)
            until(watcher, lambda: not watcher.connected)
        server = serve()
        with dspace.connect(address) as session:
            scene, rover = build(session, folder)
            drive(scene, rover, 5, 8)
            until(watcher, lambda: watcher.connected and "scene" in watcher.scenes and watcher.scenes["scene"].time >= 5.0)
            drive(scene, rover, 8, 10)
            live = session.viewports["view"].image()
            until(watcher, lambda: watcher.scenes["scene"].frame("rover").pose.position[0] == 0.3 * 9)
            assert recording.active and not recording.failure
            recording.stop()
            watcher.close()
    finally:
        end(server)
    with RecordingFile(path) as file:
        file.check()
        assert file.lost
    with dspace.Playback(path) as run:
        # What the watcher first got of the new server depends on when it came back.
        assert run.times[:2] == [2.0, 3.0] and run.times[-1] == 9.0
        assert run.gaps[0].begin == 4.0 and run.gaps[0].end == run.times[2] and run.gaps[0].before == 2
        assert run.step(1) == 1 and run.session.scene().frame("rover").pose.position[0] == 0.3 * 3
        assert run.seek(9.0) == 9.0
        assert numpy.array_equal(run.session.viewports["view"].image(), live)


def test_the_served_demo_is_recorded(tmp_path):
    """The pictures that it saved are those of the recording, at its time of two thirds."""
    demo = pathlib.Path(__file__).parents[3] / "Examples" / "rover_drive" / "rover_drive.py"
    path, out = tmp_path / "run.dspace", tmp_path / "out"
    subprocess.run([sys.executable, demo, "--served", "--record", path, "--out", out, "--seconds", "0.3", "--size",
                    "160x120"], check=True, stdout=subprocess.PIPE)
    with dspace.Playback(path) as run:
        saved = [at for at in run.times if at <= 0.3 * 2 / 3 + 1e-9][-1]
        run.seek(saved)
        for name in ("chase", "overhead", "free"):
            view = run.session.viewports[name]
            view.samples = 3  # as the demo saves them
            view.save(tmp_path / f"{name}.png")
            assert (tmp_path / f"{name}.png").read_bytes() == (out / f"{name}.png").read_bytes()
