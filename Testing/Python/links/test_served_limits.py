"""What `dspace serve` refuses and survives, and how the processes of a link end."""
import os
import pathlib
import resource
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time

import numpy as np
import pytest

import dspace
from dspace.links.serving import ServerProcess
from dspace.proto import commands_pb2 as pb
from served_support import Served, socket_folder


def within(seconds, done):
    end = time.monotonic() + seconds
    while not done():
        if time.monotonic() > end:
            return False
        time.sleep(0.02)
    return True


def test_a_document_in_the_place_of_a_name_reads_nothing(tmp_path):
    root = tmp_path / "root"
    root.mkdir()
    (tmp_path / "secret.txt").write_bytes(b"TOP SECRET PASSWORD " * 10)
    document = ('<VRTDataset rasterXSize="10" rasterYSize="10"><GeoTransform>0, 1, 0, 0, 0, -1</GeoTransform>'
                '<VRTRasterBand dataType="Byte" band="1" subClass="VRTRawRasterBand">'
                f'<SourceFilename relativetoVRT="0">{tmp_path}/secret.txt</SourceFilename>'
                '<PixelOffset>1</PixelOffset><LineOffset>10</LineOffset></VRTRasterBand></VRTDataset>')
    commands = []
    for name in (document, f"{root}/{document}"):
        for patch in (False, True):
            command = pb.Command()
            command.open_terrain.path = "here" if patch else name
            if patch:
                command.open_terrain.patch.add().path = name
            commands.append((command, "outside of the folders|contains '<' or '>'|no existing file"))
        command = pb.Command()
        command.add_terrain_layer.image.path = name
        commands.append((command, "outside of the folders|contains '<' or '>'"))
    command = pb.Command()
    command.open_terrain.path = str(root / "absent.tif")
    commands.append((command, "names no existing file"))
    with Served(tmp_path, "--allow-root", str(root)) as server, dspace.connect(server.address) as session:
        session.scene()
        for command, refusal in commands:
            with pytest.raises(dspace.Error, match=refusal):
                session._client.execute(command)


def flood(address, count):
    host, port = address.rsplit(":", 1)
    sockets = []
    for _ in range(count):
        plain = socket.socket()
        plain.settimeout(5.0)
        try:
            plain.connect((host, int(port)))
        except OSError:
            plain.close()
            break
        sockets.append(plain)
    return sockets


def test_a_flood_of_idle_connections_holds_nobody_up_for_long(tmp_path):
    with Served(tmp_path, "--max-connections", "4", listen="127.0.0.1:0") as server:
        descriptors = f"/proc/{server.process.pid}/fd"
        before = len(os.listdir(descriptors))
        sockets = flood(server.address, 200)
        try:
            time.sleep(0.5)
            assert len(os.listdir(descriptors)) - before < 4 * 4 + 32 + 20
            # They are all still there, and have said nothing.
            with dspace.connect(server.address, timeout=60.0) as session:
                session.scene()
        finally:
            for each in sockets:
                each.close()


def test_a_server_without_descriptors_goes_on_once_it_has_some(tmp_path):
    with Served(tmp_path, listen="127.0.0.1:0") as server:
        with dspace.connect(server.address) as session:
            session.scene()
            used = len(os.listdir(f"/proc/{server.process.pid}/fd"))
            hard = resource.prlimit(server.process.pid, resource.RLIMIT_NOFILE)[1]
            resource.prlimit(server.process.pid, resource.RLIMIT_NOFILE, (used + 10, hard))
            sockets = flood(server.address, 100)
            time.sleep(0.5)
            session.scene().add_frame("meanwhile")
        for each in sockets:
            each.close()
        with dspace.connect(server.address, timeout=60.0) as session:
            assert list(session.scene().frames) == ["meanwhile"]


def test_a_server_process_where_the_temporary_folder_has_a_long_path(tmp_path, monkeypatch):
    """Longer than a socket's may be."""
    folder = tmp_path / ("long" * 30)
    folder.mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(folder))
    with ServerProcess([tmp_path]) as server:
        with dspace.connect(server.address) as session:
            session.scene()
        used = os.path.dirname(server.address[len("unix:"):])
        assert os.stat(used).st_mode & 0o777 == 0o700  # nobody else's
    assert not os.path.exists(used)


def test_a_server_process_in_a_folder_with_spaces(monkeypatch):
    folder = tempfile.mkdtemp(prefix="a b ", dir="/tmp")
    monkeypatch.setattr(tempfile, "tempdir", folder)
    try:
        with ServerProcess([folder]) as server:
            assert server.address.startswith(f"unix:{folder}/") and server.address.endswith("/socket")
            with dspace.connect(server.address) as session:
                session.scene()
        assert os.listdir(folder) == []
        with pytest.raises(dspace.DeadlineExceeded, match="did not start within 0.001 s"):
            ServerProcess([folder], timeout=0.001).__enter__()
        assert os.listdir(folder) == []
        for wrong in (0, -1, float("nan")):
            with pytest.raises(dspace.InvalidArgument, match="timeout"):
                ServerProcess([folder], timeout=wrong)
    finally:
        shutil.rmtree(folder)


def has_ended(pid):
    try:
        return pathlib.Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()[0] in "ZX"
    except OSError:
        return True


def test_a_server_process_ends_with_a_parent_that_is_killed(tmp_path):
    script = ("import sys, time\n"
              "from dspace.links.serving import ServerProcess\n"
              "with ServerProcess([sys.argv[1]]) as server:\n"
              "    print(server.pid, flush=True)\n"
              "    time.sleep(600)\n")
    with subprocess.Popen([sys.executable, "-c", script, tmp_path], stdout=subprocess.PIPE, text=True,
                          env={**os.environ, "TMPDIR": str(socket_folder(tmp_path))}) as parent:  # where something stays
        server = int(parent.stdout.readline())
        assert not has_ended(server)
        parent.kill()
    try:
        assert within(30.0, lambda: has_ended(server))
    finally:
        if not has_ended(server):
            os.kill(server, signal.SIGKILL)


def test_a_child_process_may_close_what_its_parent_opened(tmp_path):
    with Served(tmp_path) as server, dspace.connect(server.address) as session, \
            dspace.watch(server.address) as watcher:
        scene = session.scene()
        child = os.fork()
        if child == 0:
            code = 1
            try:
                with pytest.raises(dspace.Unsupported, match="this one is its child"):
                    session.scene().add_frame("mine")
                session.close()
                watcher.close()
                code = 0
            finally:
                os._exit(code)
        codes = []
        ended = within(30.0, lambda: codes.append(os.waitpid(child, os.WNOHANG)) or codes[-1][0] == child)
        if not ended:
            os.kill(child, signal.SIGKILL)
            os.waitpid(child, 0)
        assert ended and codes[-1][1] == 0
        scene.add_frame("ours")
        assert list(session.scene().frames) == ["ours"]


def test_other_threads_run_while_a_viewer_waits(tmp_path):
    with Served(tmp_path) as server, dspace.watch(server.address) as watcher:
        while watcher.update(0.0):
            pass
        done, ticks = threading.Event(), []

        def tick():
            while not done.is_set():
                ticks.append(time.monotonic())
                time.sleep(0.01)

        other = threading.Thread(target=tick)
        other.start()
        try:
            counts = []
            while max(counts, default=0) < 5 and len(counts) < 20:  # the processors may be another's for a while
                before = len(ticks)
                watcher.update(1.5)
                counts.append(len(ticks) - before)
            assert max(counts) >= 5, counts
        finally:
            done.set()
            other.join()


VIEWER = """
import sys, time
import dspace
with dspace.watch(sys.argv[1]) as watcher:
    print("watching", flush=True)
    time.sleep(600)
"""


@pytest.mark.parametrize("frozen", [True, False])
def test_a_server_ends_whoever_does_not_read(tmp_path, frozen):
    """Something is being written to a viewer: one whose process stands still, or that only takes nothing."""
    with Served(tmp_path, "--allow-root", str(tmp_path)) as server:
        viewer = subprocess.Popen([sys.executable, "-W", "ignore", "-c", VIEWER, server.address],
                                  stdout=subprocess.PIPE, text=True)
        try:
            with dspace.connect(server.address, timeout=60.0) as session:
                scene = session.scene()
                frames = [scene.add_frame(f"f{i}") for i in range(1000)]
                assert viewer.stdout.readline() == "watching\n"
                if frozen:
                    viewer.send_signal(signal.SIGSTOP)
                session.wait = False
                poses = np.zeros((1000, 8))
                poses[:, 3] = poses[:, 7] = 1
                for step in range(2000):  # 144 MB
                    poses[:, 0] = step
                    scene.set_poses(frames, poses)
                session.flush()
                server.process.send_signal(signal.SIGTERM)
                assert server.process.wait(timeout=60) == 0, server.log()
        finally:
            viewer.kill()
            viewer.wait()
            viewer.stdout.close()
    assert not os.path.exists(server.listen[len("unix:"):])
