"""What the tests of movies share: a run, a flight around it, and what its pictures hold."""
import subprocess

import numpy as np
import pytest

import dspace
from dspace.movies.folder import FRAME

SIZE = (96, 64)

# A run that any process can do again: a cube goes 1 m a second along X, and turns.
RUN = '''
import dspace
from dspace.frames.poses import quaternion_of_axis

def run():
    session = dspace.Session()
    scene = session.scene()
    frame = scene.add_frame("cube")
    scene.add_box((1, 1, 1), frame=frame, color=(1, 0.2, 0.1))
    scene.add_plane(40, 40, position=(0, 0, -1), color=(0.3, 0.5, 0.3))

    def advance(time):
        scene.time = time
        frame.pose = dspace.Pose((time, 0, 0), quaternion_of_axis("z", 30 * time))
    return session, advance, lambda: {"charge": 80 - time_of(scene)}

def time_of(scene):
    return scene.time
'''


@pytest.fixture
def run(tmp_path):
    path = tmp_path / "run.py"
    path.write_text(RUN)
    return f"{path}:run"


def flight(**settings):
    movie = dspace.Movie(**{"size": SIZE, "rate": 10, "samples": 1, **settings})
    movie.add_view("main", background=(0.1, 0.1, 0.3))
    movie.add_key(time=0.0, position=(3, -6, 3), target=(0, 0, 0), run=0.0, target_frame="cube")
    movie.add_key(time=0.6, position=(6, -4, 3), target=(0, 0, 0), run=1.0, target_frame="cube", fov_deg=30)
    movie.add_key(time=1.2, position=(6, 4, 3), target=(0, 0, 0), run=1.0, target_frame="cube", easing="rest")
    movie.add_overlay("A title", [("run", "{run:.2f} s"), ("x", "{cube.x:.3f} m")], until=0.8)
    return movie


def files(folder, count):
    return [(folder / (FRAME % number)).read_bytes() for number in range(count)]


def pixels(path):
    """A PNG's pixels, by another program."""
    out = subprocess.run(["ffmpeg", "-loglevel", "error", "-i", str(path), "-f", "rawvideo", "-pix_fmt", "rgb24", "-"],
                         capture_output=True, check=True).stdout
    return np.frombuffer(out, np.uint8)
