"""Movies: every way of making them makes the same."""
import json
import os
import signal
import subprocess
import sys
import time

import numpy as np
import pytest

import dspace
from dspace.movies.encode import Encoder
from dspace.movies.folder import FRAME, identity
from movies_support import RUN, SIZE, files, flight, pixels, run  # noqa: F401  (run: a fixture)
from needs import needs_module


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
    # Another movie, or another run, starts from the beginning.
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
    distributed = needs_module("distributed", "python3-distributed")
    movie = flight()
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, processes=False, protocol="tcp://",
                                  dashboard_address=None, local_directory=str(tmp_path / "workers")) as cluster:
        assert movie.make(run, tmp_path / "dask", scheduler=cluster.scheduler_address) == 12
    movie.make(run, tmp_path / "one")
    assert files(tmp_path / "dask", 12) == files(tmp_path / "one", 12)
    from dspace.batches.dask_workers import fingerprint, pictures
    before = fingerprint(run)
    with open(run[:-4], "a") as file:
        file.write("# another\n")
    with pytest.raises(dspace.InvalidArgument, match="another file"):
        pictures(movie.text, run, [0], before, "dspace.movies.make")


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
    from dspace.movies.progress import left_words
    assert left_words(10, 100, 20, 10) == "3:00 left" and left_words(1, 3601, 1, 1) == "1:00:00 left"
    assert left_words(5, 10, 0, 0) == "time left unknown" and left_words(10, 10, 5, 5) == "all drawn"
