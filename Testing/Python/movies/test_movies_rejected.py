"""Movies: bad input is rejected with a message that names the file and the key."""
import json
import os
import subprocess
import sys

import pytest

import dspace
from dspace.command_line import main
from dspace.movies.draw import fill
from dspace.movies.folder import FRAME
from movies_support import SIZE, run  # noqa: F401  (run: a fixture)
from needs import needs_module


def raised(kind, call):
    with pytest.raises(dspace.Error) as found:
        call()
    assert type(found.value) is kind, repr(found.value)
    return str(found.value)


@pytest.fixture
def script(tmp_path):
    """script(text): the path of a file of two pictures, with this after its settings."""
    def write(text, **settings):
        settings = {"size": [32, 24], "rate": 10.0, "duration": 0.2, **settings}
        path = tmp_path / "a.toml"
        path.write_text("".join(f"{name} = {json.dumps(value)}\n" for name, value in settings.items()) + text)
        return path
    return write


KEYS = """[[view]]
[[view.key]]
time = 0.0
position = [3, -3, 2]
target = [0, 0, 0]
"""


@pytest.fixture
def late(tmp_path):
    """A scene and its camera are there from 2 to 3 s, and another time from 5 s on."""
    path = tmp_path / "late.dspace"
    with dspace.Session() as session, session.record(path):
        other = session.scene("other")
        for time in range(7):
            other.time = float(time)
            if time in (2, 5):
                scene = session.scene("field")
                scene.add_box((1, 1, 1), color="red")
                scene.add_camera("eye", eye=(3, -3, 2), target=(0, 0, 0))
            if time == 4:
                scene.remove()
    return path


@pytest.mark.parametrize("view, what", [('scene = "field"\ncamera = "eye"', "scene"),
                                        (f'scene = "field"\n{KEYS[9:]}', "scene")])
def test_a_scene_that_comes_later_is_told_with_its_times(late, script, tmp_path, view, what):
    for start, there in ((0.0, False), (2.0, True), (4.0, False), (6.0, True)):
        movie = dspace.Movie.load(script(f"[[view]]\n{view}", start=start))
        make = lambda: movie.make(late, tmp_path / f"out{start:g}")
        if there:
            assert make() == 2
        else:
            said = raised(dspace.NotFound, make)
            assert said.startswith(f"movie {str(tmp_path / 'a.toml')!r}: view 'main', {what}: at {start:g} s of the "
                                   "run there is no scene 'field', which is there from 2 to 3 s, from 5 s on; ")


def test_what_a_view_shows_may_go_and_come_again(late, script, tmp_path):
    """The recording removes a scene that the movie's view stands in."""
    path = script('[[view]]\nscene = "field"\ncamera = "eye"', start=2.0, speed=10.0, duration=0.4)
    assert main(["movie", str(path), "--run", str(late), "--out", str(tmp_path / "out")]) == 1
    assert sorted(os.listdir(tmp_path / "out"))[:2] == [FRAME % 0, FRAME % 1]  # at 2 and 3 s
    # From 3 to 6 s, over the removal and what came again.
    path = script('[[view]]\nscene = "field"\ncamera = "eye"', start=3.0, speed=30.0)
    assert main(["movie", str(path), "--run", str(late), "--out", str(tmp_path / "over")]) == 0


def test_a_camera_that_there_never_is(late, script, tmp_path):
    movie = dspace.Movie.load(script('[[view]]\nscene = "field"\ncamera = "nose"', start=2.0))
    said = raised(dspace.NotFound, lambda: movie.make(late, tmp_path / "out"))
    assert "view 'main', camera: at 2 s of the run there is no camera 'nose', nor at any other time; " in said
    assert said.endswith("there are: 'eye'")
    # A movie's own cameras are none that may be named, of this movie and of another one that was recorded.
    with dspace.Session() as session, session.record(tmp_path / "of_movie.dspace"):
        scene = session.scene("field")
        scene.add_camera("movie eye", eye=(3, -3, 2), target=(0, 0, 0))
        scene.add_camera("movie far 0123abcd", eye=(3, -3, 2), target=(0, 0, 0))
        scene.time = 2.0
    text = KEYS.replace("[[view]]", '[[view]]\nname = "first"\nscene = "field"')
    movie = dspace.Movie.load(script(text + '[[view]]\nscene = "field"\ncamera = "nose"', start=2.0))
    said = raised(dspace.NotFound, lambda: movie.make(tmp_path / "of_movie.dspace", tmp_path / "out"))
    assert said.endswith("; there are: 'movie eye'")


@pytest.mark.parametrize("jobs", (1, 2))
def test_mistakes_are_told_with_file_and_key(run, script, tmp_path, jobs):  # noqa: F811
    second = KEYS[KEYS.index("[[view.key]]"):].replace("0.0", "0.1") + 'target_frame = "nobody"\n'
    for text, says in ((KEYS + 'frame = "nobody"\n', "view 'main', key 1, frame: at 0(.1)? s of the run: .*'nobody'"),
                       (KEYS + second, "view 'main', key 2, target_frame: at 0.*'nobody'"),
                       (KEYS + '[[overlay]]\ntitle = "T"\nrows = [["a", "{nothing:.1f}"]]',
                        "overlay 1 'T': .*'nothing'"),
                       (KEYS + '[[overlay]]\nrows = [["a", "{movie}"]]\n[[overlay]]\nrows = [["a", "{charge:s}"]]',
                        "overlay 2: {charge:s} cannot format ")):
        movie = dspace.Movie.load(script(text))
        with pytest.raises(dspace.Error, match=f"^movie '{tmp_path}/a.toml': (a process .*: )?({says})"):
            movie.make(run, tmp_path / "out", jobs=jobs, redraw=True)


def test_formats_are_looked_at_before_anything_is_drawn(script):
    for form in ("{run:999999999}", "{run:.999999999f}", "{run:100}", "{cube.x:0>2000000000}", "{run:zz}", "{movie:s}"):
        with pytest.raises(dspace.InvalidArgument, match="a.toml', overlay 1: .*accepted: one such as {run:.2f}, of"):
            dspace.Movie.load(script(KEYS + f'[[overlay]]\nrows = [["a", "{form}"]]'))
    rows = '[["a", "{run:99.20f}"], ["b", "{charge:>9s}{x:+.1%}"]]'
    movie = dspace.Movie.load(script(KEYS + f"[[overlay]]\nrows = {rows}"))
    assert len(movie.overlays[0].rows) == 2


def test_a_brace_without_its_other_is_refused(script):
    for value in ("{run s", "run} s", "{", "}", "{{run}", "{run}}", "{run:{movie}}", "{run} {", "}} {", "{run:>{3}"):
        text = KEYS + f'[[overlay]]\ntitle = "T"\n[[overlay]]\nrows = [["a", "{{run}} s"], ["b", "{value}"]]'
        said = raised(dspace.InvalidArgument, lambda: dspace.Movie.load(script(text)))
        assert "a.toml', overlay 2: " in said and f"the value of row 2 is {value!r}; accepted: each brace with" in said
        assert said.endswith("{{ or }} for a brace that is drawn")
        assert "row 1 is" in raised(dspace.InvalidArgument, lambda: dspace.Movie().add_overlay("T", [("b", value)]))
    movie = dspace.Movie.load(script(KEYS + '[[overlay]]\nrows = [["a {b", "{{ {run:.1f}}} {{run}} }}{{"]]'))
    (label, value), = movie.overlays[0].rows
    assert label == "a {b"  # no value
    assert fill(value, {"run": 2.0}.__getitem__) == value.format(run=2.0) == "{ 2.0} {run} }{"


def test_values_of_settings(script, tmp_path):
    with pytest.raises(dspace.InvalidArgument, match=r"size is \[1000000000.0, 48\]; .* whole numbers from 1 to 16384"):
        dspace.Movie.load(script(KEYS, size=[1e9, 48]))
    assert "samples is 1.5; accepted" in raised(dspace.WrongType, lambda: dspace.Movie(samples=1.5))
    movie = dspace.Movie.load(script(KEYS))
    for call in (lambda: movie.make("run.dspace", tmp_path / "out", jobs="2"), lambda: movie.make(5, tmp_path / "out"),
                 lambda: movie.make("run.dspace", 5), lambda: movie.make("run.dspace", tmp_path / "out", work=5),
                 lambda: dspace.Movie.load(5), lambda: dspace.Movie.load(b"a.toml"), lambda: movie.save(5)):
        assert "accepted" in raised(dspace.WrongType, call)
    assert "jobs is '2'" in raised(dspace.WrongType, lambda: movie.make("run.dspace", tmp_path / "out", jobs="2"))
    raised(dspace.InvalidArgument, lambda: movie.make("", tmp_path / "out"))
    assert "accepted: a file in a folder" in raised(dspace.Io, lambda: movie.save("/nonexist/x.toml"))
    assert not (tmp_path / "out").exists()


def test_a_key_that_is_refused_leaves_no_view(scene):
    camera = scene.add_camera(eye=(3, -3, 2), target=(0, 0, 0))
    viewport = scene.add_viewport(SIZE, camera)
    movie = dspace.Movie()
    for seen, at, kind in ((5, 0, dspace.WrongType), ("view", 0, dspace.WrongType),
                           (viewport, -1, dspace.InvalidArgument)):
        raised(kind, lambda: movie.add_key(seen, at))
        assert not movie.views
    movie.add_key(viewport, 0)
    assert list(movie.views) == ["main"]


def test_where_it_is_made(run, script, tmp_path, monkeypatch, capsys):  # noqa: F811
    monkeypatch.chdir(tmp_path)
    path = str(script(KEYS))
    assert main(["movie", path, "--run", run, "--out", "out.d"]) == 1
    said = capsys.readouterr().err
    assert "its ending is '.d'; accepted: .mp4, .webm, or a folder: a name without a dot, a name with a slash" in said
    assert not (tmp_path / "out.d").exists()
    for out in ("out.d/", "out.d", "out"):
        assert main(["movie", path, "--run", run, "--out", out]) == 0
        assert (tmp_path / out / (FRAME % 1)).exists()


def test_schedulers_addresses(run, script, tmp_path, monkeypatch, capsys):  # noqa: F811
    path, out = str(script(KEYS)), tmp_path / "out"
    for address in ("foo", "", "foo:8786", "tcp://foo", "tcp://:1", "tcp://foo:x", "tcp://foo:99999", "http://foo:1",
                    "tcp://foo:1/x", "tcp://a b:1"):
        assert main(["movie", path, "--run", run, "--out", str(out), "--scheduler", address]) == 1
        said = capsys.readouterr().err
        assert f"the scheduler is {address!r}; accepted: tcp://HOST:PORT or tls://HOST:PORT" in said
    assert not out.exists()
    needs_module("distributed", "python3-distributed")
    # Nobody listens: one line, from a process that ends.
    done = subprocess.run([sys.executable, "-W", "ignore", "-c", "import sys\nfrom dspace._core import dask_client\n"
                           "dask_client.TO_CONNECT = 0.3\nfrom dspace.command_line import main\n"
                           "sys.exit(main(sys.argv[1:]))", "movie", path, "--run", run, "--out", str(out),
                           "--scheduler", "tcp://127.0.0.1:1"], capture_output=True, text=True, timeout=120)
    lines = [line for line in done.stderr.splitlines() if "time left" not in line]
    assert done.returncode == 1 and len(lines) == 1 and "scheduler 'tcp://127.0.0.1:1'" in lines[0], done.stderr
