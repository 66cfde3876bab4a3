"""Movies: their files, what their pictures show, and that every way of making them makes the same."""
import json
import os
import signal
import subprocess
import sys
import time

import numpy as np
import pytest

import dspace
from dspace.movies_draw import Source, Stage, fill, is_whole, png
from dspace.movies_encode import Encoder
from dspace.movies_make import FRAME, identity
from dspace.poses import quaternion_of_axis

SIZE = (96, 64)

# A run that any process can do again: a cube goes 1 m a second along X, and turns.
RUN = '''
import dspace
from dspace.poses import quaternion_of_axis

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


# --- The file --------------------------------------------------------------------------------------

def test_a_movie_and_its_file_are_one(tmp_path):
    movie = flight(duration=2.5, start=4.0, speed=0.5)
    movie.add_view("side", rectangle=(0.5, 0, 0.5, 0.5), camera="fixed", hide=("helpers",), ornaments=False)
    movie.add_overlay('Quotes " \\ and \u00e4, \u2192', view="side", anchor="bottom right", font_size=12)
    path = tmp_path / "a.toml"
    movie.save(path)
    again = dspace.Movie.load(path)
    assert again.text == movie.text == path.read_text()
    assert again.views == movie.views and again.overlays == movie.overlays
    assert (again.size, again.rate, again.samples, again.duration) == (SIZE, 10, 1, 2.5)
    assert dspace.Movie.load(path, size=(20, 10), rate=5).size == (20, 10)
    assert not list(tmp_path.glob("*.part"))
    shuffled = dspace.Movie.of_text(movie.text.replace("fov_deg = 30.0", "fov_deg=30 # by hand"))
    assert shuffled.text == movie.text


@pytest.mark.parametrize("change, says", [
    (("rate = 10.0", "rat = 10"), "unknown 'rat'; accepted: size, rate"),
    (("rate = 10.0", "rate = 0"), "the rate is 0"),
    (("size = [96, 64]", "size = [96]"), "the size is"),
    (("fov_deg = 30.0", "fov = 30"), "key 2: unknown 'fov'; accepted: time, position"),
    (("fov_deg = 30.0", "fov_deg = 400"), "key 2: the key at 0.6 s: fov_deg is 400"),
    (("time = 0.6", "tim = 0.6"), "key 2"),
    (("time = 0.6", "time = 0.0"), "two keys at 0 s"),
    (("[[overlay]]", "[[overlays]]"), "unknown 'overlays'"),
    (("[[overlay]]", "[[overlay]]\nview = 'x'"), "there is no view 'x'"),
    (("[[view]]", "[[view]]\ncamera = 'c'"), "a camera and keys"),
    (("[[view]]", "[[view]]\nrectangle = [0, 0, 2, 1]"), "the rectangle is"),
    (("size = ", "size = = "), "accepted: TOML"),
])
def test_a_bad_file_says_where(tmp_path, change, says):
    text = flight().text
    assert change[0] in text
    path = tmp_path / "bad.toml"
    path.write_text(text.replace(*change))
    with pytest.raises(dspace.Error) as error:
        dspace.Movie.load(path)
    assert says in str(error.value) and str(path) in str(error.value)


def test_keys_come_from_viewports(session, scene):
    """What a key has makes the picture that the viewport shows, to the byte."""
    carrier = scene.add_frame("carrier", position=(5, 2, 1), quaternion=quaternion_of_axis("z", 70))
    scene.add_box((1, 1, 1), color=(1, 0, 0))
    scene.add_box((0.5, 1, 2), position=(1, 2, 0), color=(0, 1, 0))
    scene.add_camera("c", frame=carrier, fov_deg=33, pose=dspace.Pose((1, 0, 0), (0.5, -0.5, 0.5, -0.5)))
    scene.cameras["c"].look_at((1, 0, 2), (-4, 5, 0), frame=carrier)
    view = scene.add_viewport(SIZE, "c", samples=1)
    movie = dspace.Movie(size=SIZE, samples=1)
    key = movie.add_key(view, 0.0)
    assert key.frame == "carrier" and key.fov_deg == 33
    other = movie.add_key(view, 1.0, frame=scene.root, easing="rest")
    assert other.frame == ""
    np.testing.assert_allclose(carrier.world_pose.apply(key.position), other.position, atol=1e-12)
    picture = Stage(movie, Source(session)).picture(0)
    np.testing.assert_array_equal(picture, view.image())
    assert len(np.unique(picture.reshape(-1, 3), axis=0)) > 3


def test_keys_come_from_cameras_that_chase(scene):
    carrier = scene.add_frame("carrier", position=(5, 2, 1), quaternion=quaternion_of_axis("z", 90))
    scene.add_camera("c", frame=carrier, chase=dict(offset=(-4, 0, 0), target=(0, 0, 0)))
    view = scene.add_viewport(SIZE, "c", samples=1)
    key = dspace.Movie().add_key(view, 0.0)
    np.testing.assert_allclose(key.position, (5, -2, 1), atol=1e-12)  # 4 m behind; it heads along Y
    forward = dspace.Pose(quaternion=key.quaternion).rotation[:, 2]
    np.testing.assert_allclose(forward, (0, 1, 0), atol=1e-12)
    with pytest.raises(dspace.InvalidArgument, match="it chases"):
        dspace.Movie().add_key(scene.cameras["c"], 0.0)
    scene.add_camera("flat", eye=(0, 0, 1), target=(0, 0, 0), up=(0, 1, 0), height=3)
    with pytest.raises(dspace.InvalidArgument, match="a perspective camera"):
        dspace.Movie().add_key(scene.cameras["flat"], 0.0)


# --- Pictures --------------------------------------------------------------------------------------

def test_pictures_show_the_run_where_the_keys_say(run, tmp_path):
    """Against captures through a camera put by hand where the key is."""
    movie = flight()
    movie.overlays.clear()
    assert movie.make(run, tmp_path / "pictures") == 12
    with dspace.Session() as session:
        scene = session.scene()
        frame = scene.add_frame("cube")
        scene.add_box((1, 1, 1), frame=frame, color=(1, 0.2, 0.1))
        scene.add_plane(40, 40, position=(0, 0, -1), color=(0.3, 0.5, 0.3))
        frame.pose = dspace.Pose((1, 0, 0), quaternion_of_axis("z", 30))
        scene.time = 1.0
        scene.add_camera("c", eye=(6, -4, 3), target=(1, 0, 0), fov_deg=30)
        view = scene.add_viewport(SIZE, "c", samples=1)
        view.set_background((0.1, 0.1, 0.3))
        expected = view.image()
    shown = pixels(tmp_path / "pictures" / (FRAME % 6)).reshape(64, 96, 3)  # the key at 0.6 s
    assert np.abs(shown.astype(int) - expected).max() <= 1 and shown.std() > 20
    # The run stands still from 0.6 s on, the camera does not.
    assert (tmp_path / "pictures" / (FRAME % 7)).read_bytes() != (tmp_path / "pictures" / (FRAME % 6)).read_bytes()


def test_views_lie_where_their_rectangles_are(session, scene):
    scene.add_camera("c", eye=(0, -5, 0), target=(0, 0, 0))
    movie = dspace.Movie(size=(100, 60), samples=1, duration=1)
    movie.add_view("left", rectangle=(0, 0, 0.5, 1), camera="c", background="red")
    movie.add_view("inset", rectangle=(0.75, 0.5, 0.25, 0.5), camera="c", background=(0, 0, 1))
    picture = Stage(movie, Source(session)).picture(0)
    expected = np.zeros((60, 100, 3), np.uint8)
    expected[:, :50] = (255, 0, 0)
    expected[30:, 75:] = (0, 0, 255)
    np.testing.assert_array_equal(picture, expected)


def test_overlays_come_and_go_with_their_values(session, scene):
    scene.add_frame("rover", position=(12.5, 0, 0))
    scene.add_camera("c", eye=(0, -5, 0), target=(0, 0, 0))
    movie = dspace.Movie(size=SIZE, samples=1, rate=2, duration=2)
    movie.add_view(camera="c")
    movie.add_overlay("", [("x", "{rover.x:.1f} m"), ("t", "{movie:.1f}"), ("v", "{volts} V")], since=0.5, until=1.5)
    told = []
    stage = Stage(movie, Source(session, told.append, lambda: {"volts": 28}))
    pictures = [stage.picture(n) for n in range(4)]
    assert told == [0, 0.5, 1, 1.5]
    np.testing.assert_array_equal(pictures[0], pictures[3])
    assert (pictures[1] != pictures[0]).any() and (pictures[2] != pictures[1]).any()
    viewport = session.viewports["movie main"]
    viewport.set_table("by hand", [("x", "12.5 m"), ("t", "0.5"), ("v", "28 V")], font_size=8)
    np.testing.assert_array_equal(viewport.image(), pictures[1])
    assert fill("{a:>5}|{b}", {"a": "x", "b": 1.5}.get) == "    x|1.5"
    for value, says in (("{nobody}", "no value 'nobody'; accepted: movie, run"), ("{run:zz}", "cannot be written"),
                        ("{ghost.x}", "ghost")):
        movie.overlays.clear()
        movie.add_overlay("t", [("a", value)])
        with pytest.raises(dspace.Error, match=says):
            stage.picture(0)


def test_png_files_hold_what_was_given(tmp_path):
    picture = np.random.default_rng(0).integers(0, 256, (13, 7, 3), np.uint8)
    path = tmp_path / "a.png"
    data = png(picture)
    path.write_bytes(data)
    np.testing.assert_array_equal(pixels(path), picture.ravel())
    assert is_whole(path) and not is_whole(tmp_path / "none")
    for bad in (data[:-1], data[:40], data[:60] + bytes([data[60] ^ 1]) + data[61:], b"", data + b"x"):
        path.write_bytes(bad)
        assert not is_whole(path)


# --- Making ----------------------------------------------------------------------------------------

def test_one_process_two_processes_and_a_resumed_one_make_the_same(run, tmp_path):
    movie = flight()
    told = []
    assert movie.make(run, tmp_path / "one", progress=lambda *now: told.append(now)) == 12
    assert [now[0] for now in told] == list(range(13)) and {now[1] for now in told} == {12}
    assert movie.make(run, tmp_path / "two", jobs=2) == 12
    expected = files(tmp_path / "one", 12)
    assert files(tmp_path / "two", 12) == expected and len(set(expected)) == 12
    # Some pictures are gone, one is cut, one is damaged: these four are drawn again, from the middle of the run.
    three = tmp_path / "two"
    for number in (3, 7):
        (three / (FRAME % number)).unlink()
    (three / (FRAME % 8)).write_bytes(expected[8][:200])
    (three / (FRAME % 9)).write_bytes(expected[9][:99] + b"\0" + expected[9][100:])
    assert movie.make(run, three) == 4
    assert files(three, 12) == expected
    assert movie.make(run, three) == 0
    # Another movie, or another run, begins anew.
    movie.add_key(time=1.3, position=(6, 4, 9), target=(0, 0, 0), target_frame="cube")
    assert movie.make(run, three) == 13


@pytest.mark.parametrize("jobs", (1, 2))
def test_a_killed_movie_goes_on_where_it_was(run, tmp_path, jobs):
    script, out = tmp_path / "a.toml", tmp_path / "pictures"
    flight(rate=20).save(script)
    words = [sys.executable, "-W", "ignore", "-m", "dspace", "movie", str(script), "--run", run, "--out", str(out),
             "--jobs", str(jobs)]
    process = subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    end = time.monotonic() + 120
    while not (out / (FRAME % 4)).exists() and process.poll() is None and time.monotonic() < end:
        time.sleep(0.01)
    process.send_signal(signal.SIGKILL)
    process.wait()
    before = {name: os.stat(out / name).st_mtime_ns for name in os.listdir(out) if name.endswith(".png")}
    done = subprocess.run(words, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert "24 pictures of 96 x 64, 1.2 s" in done.stdout
    kept = [name for name, when in before.items() if os.stat(out / name).st_mtime_ns == when]
    assert len(kept) == len(before) >= 5
    flight(rate=20).make(run, tmp_path / "whole")
    assert files(out, 24) == files(tmp_path / "whole", 24)


@pytest.mark.parametrize("ending, codec", [(".mp4", "h264"), (".webm", "vp9")])
def test_movie_files(run, tmp_path, ending, codec):
    out = tmp_path / f"a 100% {ending}"
    movie = flight()
    assert movie.make(run, out, keep=True) == 12
    probe = subprocess.run(["ffprobe", "-v", "error", "-count_frames", "-show_entries",
                            "stream=codec_name,width,height,nb_read_frames,r_frame_rate,color_space", "-of", "json",
                            str(out)], capture_output=True, check=True)
    stream = json.loads(probe.stdout)["streams"][0]
    assert (stream["codec_name"], stream["width"], stream["height"], stream["nb_read_frames"],
            stream["r_frame_rate"], stream["color_space"]) == (codec, 96, 64, "12", "10/1", "bt709")
    work = tmp_path / (out.name + ".work")
    shown = subprocess.run(["ffmpeg", "-loglevel", "error", "-i", str(out), "-vf", "scale=in_color_matrix=bt709", "-f",
                            "rawvideo", "-pix_fmt", "rgb24", "-"], capture_output=True, check=True).stdout
    shown = np.frombuffer(shown, np.uint8).reshape(12, -1).astype(int)
    drawn = np.array([pixels(work / (FRAME % n)) for n in range(12)])
    assert np.abs(shown - drawn).mean() < 6  # chroma is halved about every edge
    for n in range(0, 12, 3):  # each picture is nearest to its own
        others = [np.abs(shown[n] - each.astype(int)).mean() for each in drawn]
        assert int(np.argmin(others)) == n
    # Nothing is drawn again, and without `keep` nothing is left but the movie.
    assert movie.make(run, out) == 0
    assert sorted(path.name for path in tmp_path.iterdir() if path.is_dir() and "pycache" not in path.name) == []


def test_a_recording_makes_the_movie_of_the_live_run(run, tmp_path):
    """Its run begins at 100 s; that is where the movie begins if nothing is said."""
    if not hasattr(dspace, "Playback"):
        pytest.skip("this build plays no recordings back")
    made = {}
    exec(RUN, made)
    session, advance, _ = made["run"]()
    path = tmp_path / "run.dspace"
    with session, session.record(path):
        for number in range(13):
            advance(100 + number / 10)
    movie = dspace.Movie(size=SIZE, rate=10, samples=1)
    movie.add_view(background=(0.1, 0.1, 0.3))
    movie.add_key(time=0.0, position=(103, -6, 3), target=(0, 0, 0), target_frame="cube")
    movie.add_key(time=1.2, position=(106, -4, 3), target=(0, 0, 0), target_frame="cube")
    movie.add_overlay("", [("run", "{run:.2f} s"), ("x", "{cube.x:.3f} m")])
    assert movie.make(path, tmp_path / "played", jobs=2) == 12
    movie.start = 100.0
    movie.make(run, tmp_path / "live")
    assert files(tmp_path / "played", 12) == files(tmp_path / "live", 12)
    movie.start = None
    assert movie.make(path, tmp_path / "played") == 0  # reading does not change it
    # And backwards: a playback seeks.
    movie.start, movie.speed = 101.1, -1.0  # 100.9 and others are not what the run's times are, to a rounding
    movie.overlays[0].rows = (("x", "{cube.x:.3f} m"),)
    movie.views["main"].keys = movie.views["main"].keys[:1] + [movie.views["main"].keys[0].__class__(
        1.2, (103, -6, 3), target=(0, 0, 0), target_frame="cube")]
    movie.make(path, tmp_path / "back")
    movie.start, movie.speed = 100.0, 1.0
    movie.make(path, tmp_path / "forth")
    assert files(tmp_path / "back", 12) == files(tmp_path / "forth", 12)[::-1]


def test_dask_workers_make_the_same(run, tmp_path):
    distributed = pytest.importorskip("distributed", reason="python3-distributed is not installed")
    movie = flight()
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, processes=False, protocol="tcp://",
                                  dashboard_address=None) as cluster:
        assert movie.make(run, tmp_path / "dask", scheduler=cluster.scheduler_address) == 12
    movie.make(run, tmp_path / "one")
    assert files(tmp_path / "dask", 12) == files(tmp_path / "one", 12)
    from dspace.movies_dask import fingerprint, pictures
    before = fingerprint(run)
    with open(run[:-4], "a") as file:
        file.write("# another\n")
    with pytest.raises(dspace.InvalidArgument, match="another file"):
        pictures(movie.text, run, [0], before)


def test_what_cannot_be_made_is_refused(run, tmp_path, session):
    movie = flight()
    for out, options, says in (("a.avi", {}, "its ending is '.avi'; accepted: .mp4, .webm, or a folder"),
                               ("a.mp4", {"jobs": 0}, "jobs is 0")):
        with pytest.raises(dspace.InvalidArgument, match=says):
            movie.make(run, tmp_path / out, **options)
    with pytest.raises(dspace.InvalidArgument, match="accepted: even numbers"):
        flight(size=(97, 64)).make(run, tmp_path / "a.mp4")
    with pytest.raises(dspace.InvalidArgument, match="several processes"):
        movie.make(session, tmp_path / "b", jobs=2)
    with pytest.raises(dspace.Error, match="no.such"):
        movie.make(str(tmp_path / "no-such.dspace"), tmp_path / "c")
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "thesis.txt").write_text("years")
    with pytest.raises(dspace.InvalidArgument, match="thesis.txt"):
        movie.make(run, tmp_path / "mine")
    assert (tmp_path / "mine" / "thesis.txt").read_text() == "years"
    with pytest.raises(dspace.Error, match="run.py.*no function"):
        movie.make(run[:-3] + "nobody", tmp_path / "d")
    broken = tmp_path / "broken.py"
    broken.write_text("def run():\n    raise OSError('the disc is gone')\n")
    with pytest.raises(dspace.Io, match="the disc is gone"):
        movie.make(f"{broken}:run", tmp_path / "e", jobs=2)


def test_a_process_that_says_much_is_heard_to_its_end(run, tmp_path):
    """More than a pipe holds, on its error stream."""
    path = tmp_path / "talks.py"
    path.write_text(RUN.replace("    session = dspace.Session()", "    import sys\n    sys.stderr.write('word ' * 60000)\n"
                                "    session = dspace.Session()"))
    assert flight().make(f"{path}:run", tmp_path / "pictures", jobs=2) == 12


def test_the_hash_tells_movies_and_runs_apart(run, tmp_path):
    movie = flight()
    first = identity(movie, run)
    assert identity(flight(), run) == first != identity(flight(size=(98, 64)), run)
    assert identity(flight(samples=2), run) != first != identity(flight(rate=11), run)
    path = run[:-4]
    os.utime(path, ns=(1, 1))
    assert identity(movie, run) != first


@pytest.mark.parametrize("name, quick", [("a.mp4", False), ("a.mp4", True), ("a.webm", True)])
def test_encoder_takes_pictures_one_by_one(tmp_path, name, quick):
    path = tmp_path / name
    with Encoder(path, SIZE, 25, quick=quick) as movie:
        for shade in range(5):
            movie.add(np.full((64, 96, 3), 40 * shade, np.uint8))
        with pytest.raises(dspace.InvalidArgument, match="accepted:"):
            movie.add(np.zeros((3, 3, 3), np.uint8))
    assert path.stat().st_size > 500
    with pytest.raises(ZeroDivisionError):
        with Encoder(tmp_path / "b.mp4", SIZE, 25) as movie:
            movie.add(np.zeros((64, 96, 3), np.uint8))
            1 / 0
    assert sorted(each.name for each in tmp_path.iterdir()) == [name]


def test_the_command_says_what_is_wrong_in_one_line(tmp_path, run):
    script = tmp_path / "a.toml"
    script.write_text(flight().text.replace("fov_deg", "fov"))
    for words in (["movie", str(script), "--run", run, "--out", str(tmp_path / "x")],
                  ["movie", str(tmp_path / "none.toml"), "--run", run, "--out", "x.mp4"]):
        done = subprocess.run([sys.executable, "-m", "dspace", *words], capture_output=True, text=True)
        assert done.returncode == 1 and len(done.stderr.strip().splitlines()) == 1, done.stderr
        assert "accepted" in done.stderr
    from dspace.command_line.movie import left_words
    assert left_words(10, 100, 20, 10) == "3:00 left" and left_words(1, 3601, 1, 1) == "1:00:00 left"
    assert left_words(5, 10, 0, 0) == "time left unknown" and left_words(10, 10, 5, 5) == "all drawn"
