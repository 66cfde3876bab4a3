"""A scene of a file in a server, which tests drive and record."""
import pytest

import dspace

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
