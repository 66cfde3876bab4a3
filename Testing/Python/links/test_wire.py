"""Clients made of the .proto files alone, in two languages, against `dspace serve`: an independent path for
the wire. What they make is compared with closed forms and with what the package makes."""
import math
import os
import pathlib
import subprocess
import sys

import numpy as np
import pytest

import dspace
from needs import lacks, needs_module, needs_program
from served_support import Served

SOURCE = pathlib.Path(__file__).parents[3]
EXAMPLE = SOURCE / "Examples" / "wire_client"
PROTOS = SOURCE / "Libraries" / "Session"
END, RADIUS, RATE, WHEEL = 5.0, 3.0, 0.2, 0.2
CORNERS = {11: (0.5, 0.45), 12: (0.5, -0.45), 13: (-0.5, 0.45), 14: (-0.5, -0.45)}


def make_stubs(folder, language):
    """The protocol's messages and calls in a language, by protoc."""
    plugin = needs_program(f"grpc_{language}_plugin", "protobuf-compiler-grpc")
    protoc = needs_program("protoc", "protobuf-compiler")
    folder.mkdir()
    subprocess.run([protoc, f"-I{PROTOS}", f"--{language}_out={folder}", f"--grpc_out={folder}",
                    f"--plugin=protoc-gen-grpc={plugin}",
                    *sorted(str(path) for path in (PROTOS / "dspace" / "proto").glob("*.proto"))], check=True)
    return folder


@pytest.fixture(scope="module")
def stubs(tmp_path_factory):
    needs_module("grpc", "python3-grpcio")
    return make_stubs(tmp_path_factory.mktemp("wire") / "python", "python")


def run_python(stubs, script, *arguments, **options):
    """A script of the example's that sees the stubs, and of Dspace nothing."""
    return subprocess.run([sys.executable, str(EXAMPLE / script), *map(str, arguments)], text=True, timeout=300,
                          stdout=subprocess.PIPE, env={**os.environ, "PYTHONPATH": str(stubs)}, check=True, **options)


def read_ppm(path):
    data = path.read_bytes()
    head, _, pixels = data.partition(b"\n")
    width, height = (int(word) for word in head.split()[1:3])
    return np.frombuffer(pixels, np.uint8).reshape(height, width, 3)


def rows_of(output):
    """Poses in the root, as the client printed them, by frame."""
    lines = [line.split() for line in output.splitlines() if line[:3].strip().isdigit() and line.count(" ") == 8]
    return {int(line[0]): np.array([float(word) for word in line[1:]]) for line in lines}


def check_poses(rows):
    """Against the circle itself, in closed form, and rotations by the two turns' matrices."""
    assert sorted(rows) == [10, 11, 12, 13, 14]
    along = RATE * END
    c, s = math.cos(along), math.sin(along)
    place, heading = np.array([RADIUS * s, RADIUS * (1 - c), WHEEL]), np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
    assert np.abs(rows[10][:3] - place).max() < 1e-14
    for frame, row in rows.items():
        assert row[7] == 1.0
        wanted = heading
        if frame in CORNERS:
            x, y = CORNERS[frame]
            assert np.abs(row[:3] - (place + heading @ (x, y, 0))).max() < 1e-14
            turn = along * (RADIUS - y) / WHEEL
            a, b = math.cos(turn), math.sin(turn)
            wanted = heading @ np.array([[a, 0, b], [0, 1, 0], [-b, 0, a]])
        assert np.abs(matrix(row[3:7]) - wanted).max() < 1e-13


def matrix(q):
    w, x, y, z = q
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                     [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                     [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])


def package_picture():
    """The same scene by the package, in this process."""
    with dspace.Session() as session:
        scene = session.scene()
        rover = scene.add_frame("rover")
        wheels = [scene.add_frame(f"wheel_{number}", rover) for number in CORNERS]
        quarter = (math.sqrt(0.5), math.sqrt(0.5), 0.0, 0.0)
        for wheel, number in zip(wheels, CORNERS):
            scene.add_cylinder(WHEEL, 0.15, frame=wheel, quaternion=quarter, color=(0.15, 0.15, 0.16),
                               name=f"wheel {number}")
        scene.add_box((1.2, 0.7, 0.25), frame=rover, color=(0.85, 0.65, 0.25), name="body 10")
        scene.add_plane(20.0, 20.0, color=(0.62, 0.48, 0.38), name="ground 0")
        camera = scene.add_camera("main", eye=(7.0, -3.0, 4.0), target=(1.0, 2.5, 0.0), fov_deg=40.0)
        scene.time = END
        along = RATE * END
        rows = [[RADIUS * math.sin(along), RADIUS * (1.0 - math.cos(along)), WHEEL,
                 math.cos(along / 2), 0.0, 0.0, math.sin(along / 2)]]
        for x, y in CORNERS.values():
            turned = along * (RADIUS - y) / WHEEL
            rows.append([x, y, 0.0, math.cos(turned / 2), 0.0, math.sin(turned / 2), 0.0])
        scene.set_poses([rover, *wheels], rows)
        return scene.add_viewport((320, 240), camera).image()


def test_a_client_of_the_proto_files_alone(tmp_path, stubs):
    out, record = tmp_path / "rover.ppm", tmp_path / "run.dspace"
    with Served(tmp_path, "--record", str(record)) as server:
        run = run_python(stubs, "rover.py", server.address, "--out", out)
    assert server.code == 0, server.log()
    check_poses(rows_of(run.stdout))
    picture = read_ppm(out)
    assert np.array_equal(picture, package_picture()) and len(np.unique(picture.reshape(-1, 3), axis=0)) > 20
    times = list(dspace.Playback(record).times)
    assert np.array_equal(times[-500:], [step * 0.01 for step in range(1, 501)])


def test_a_broken_connection_loses_and_repeats_nothing(tmp_path, stubs):
    out, record = tmp_path / "rover.ppm", tmp_path / "run.dspace"
    with Served(tmp_path, "--record", str(record)) as server:
        run_python(stubs, "rover.py", server.address, "--out", tmp_path / "first.ppm")
        run = run_python(stubs, "rover.py", server.address, "--out", out, "--break-at", 250)
    assert " 1 times made again" in run.stdout
    check_poses(rows_of(run.stdout))
    assert np.array_equal(read_ppm(out), package_picture())
    with dspace.Playback(record) as playback:
        assert np.array_equal(playback.times[-500:], [step * 0.01 for step in range(1, 501)])


def test_the_same_in_ruby(tmp_path):
    ruby = needs_program("ruby", "ruby-grpc")
    if subprocess.run([ruby, "-e", "require 'grpc'"], stderr=subprocess.DEVNULL).returncode:
        lacks("ruby-grpc")
    stubs, out = make_stubs(tmp_path / "ruby", "ruby"), tmp_path / "rover.ppm"
    with Served(tmp_path) as server:
        for _ in range(2):  # again in the same server
            run = subprocess.run([ruby, "-I", str(stubs), str(EXAMPLE / "rover.rb"), server.address, str(out)],
                                 check=True, stdout=subprocess.PIPE, text=True, timeout=300)
    check_poses(rows_of(run.stdout))
    assert np.array_equal(read_ppm(out), package_picture())


def test_a_viewer_of_the_proto_files_alone(tmp_path, stubs):
    with Served(tmp_path) as server, dspace.connect(server.address, name="drive") as session:
        scene = session.scene()
        rover = scene.add_frame("rover", position=(1.0, 2.0, 3.0))
        scene.add_frame("other", position=(7.0, 7.0, 7.0))
        follow = subprocess.Popen([sys.executable, str(EXAMPLE / "follow.py"), server.address, "rover"], text=True,
                                  stdout=subprocess.PIPE, env={**os.environ, "PYTHONPATH": str(stubs)})
        try:
            lines = [follow.stdout.readline() for _ in range(2)]  # the snapshot has come
            assert lines == ["0.000 s: rover at 1.0 2.0 3.0\n", "simulation 'drive' drives\n"]
            x = [0.1 * step for step in range(1, 101)]
            session.wait = False
            for step, at in enumerate(x, 1):
                scene.time = 0.01 * step
                scene.set_poses([rover], [[at, 0.0, 0.5, 1.0, 0.0, 0.0, 0.0]])
            session.flush()
            rover.remove()
            session.close()
            lines = follow.communicate(timeout=60)[0].splitlines()
        finally:
            follow.kill()
            follow.wait()
        assert lines == [f"{0.01 * step:.3f} s: rover at {at!r} 0.0 0.5" for step, at in enumerate(x, 1)] + [
            "simulation 'drive' has gone"]
        assert follow.returncode == 0
