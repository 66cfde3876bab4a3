"""Pictures of a movie that are there: used again only for the same movie of the same run, in folders of movies."""
import json
import os

import numpy as np
import pytest

import dspace
from dspace.movies.folder import FRAME
from movies_support import RUN, SIZE, files, flight, run  # noqa: F401  (run: a fixture)


def still(count=2, camera="c", **settings):
    movie = dspace.Movie(size=SIZE, rate=10, samples=1, duration=count / 10, **settings)
    movie.add_view(camera=camera)
    return movie


def boxes(session):
    """A scene that a camera looks at; a box stands at x = the scene's time."""
    scene = session.scene()
    frame = scene.add_frame("box")
    scene.add_box((1, 1, 1), frame=frame, color="red")
    scene.add_camera("c", eye=(0, -9, 2), target=(0, 0, 0))

    def advance(time):
        scene.time = time
        frame.position = (time, 0, 0)
    return scene, advance


def test_a_recording_that_goes_on_is_another_run(tmp_path):
    """Its commands stand in its log; the size and date of the file itself do not change."""
    path, out = tmp_path / "run.dspace", tmp_path / "pictures"
    movie = still(20)
    with dspace.Session() as session:
        _, advance = boxes(session)
        with session.record(path, commit_every=0.01) as recording:
            advance(0.0)
            recording.flush()
            assert movie.make(path, out) == 20
            before, size = files(out, 20), path.stat().st_size
            for number in range(1, 20):
                advance(number / 10)
            recording.flush()
            assert path.stat().st_size == size  # all is in the log
            assert movie.make(path, out) == 20
            assert files(out, 20)[0] == before[0] and files(out, 20)[10] != before[10]
        closed = movie.make(path, out)  # whatever closing it did to the file
        assert closed in (0, 20) and movie.make(path, out) == 0


def test_modules_beside_a_program_are_the_run(tmp_path):
    (tmp_path / "sizes.py").write_text("SIDE = 1.0\n")
    (tmp_path / "parts").mkdir()
    (tmp_path / "parts" / "__init__.py").write_text("COLOR = 'red'\n")
    program = tmp_path / "run.py"
    program.write_text("import os, sys\nsys.path.insert(0, os.path.dirname(__file__))\n"
                       "sys.dont_write_bytecode = True\n" + RUN.replace(
                           "(1, 1, 1), frame=frame, color=(1, 0.2, 0.1)", "3 * [sizes.SIDE], frame=frame, "
                           "color=parts.COLOR").replace("import dspace\n", "import dspace, sizes, parts\n", 1))
    movie, out = flight(), tmp_path / "pictures"
    make = lambda: movie.make(f"{program}:run", out, jobs=2)  # in processes that know no earlier module
    assert make() == 12 and make() == 0
    before = files(out, 12)
    for path, text in (("sizes.py", "SIDE = 2.5\n"), ("parts/__init__.py", "COLOR = 'blue'\n")):
        (tmp_path / path).write_text(text)
        assert make() == 12 and make() == 0
        assert files(out, 12) != before
        before = files(out, 12)
    assert movie.make(f"{program}:run", out, jobs=2, redraw=True) == 12 and files(out, 12) == before


def test_files_that_a_recording_names_are_the_run(tmp_path, field):
    path, out = tmp_path / "run.dspace", tmp_path / "pictures"
    with dspace.Session() as session:
        scene = session.scene()
        with session.record(path):
            scene.add_terrain(field)
            scene.add_camera("c", eye=(0, -50, 40), target=(0, 0, 0))
            scene.time = 1.0
    movie = still()
    assert movie.make(path, out) == 2 and movie.make(path, out) == 0
    field.write_text(field.read_text().replace("-8.0", "-4.0"))
    with pytest.raises(dspace.Corrupt, match="has changed since it was recorded"):
        movie.make(path, out)


@pytest.mark.parametrize("theirs", ('{"scene": 1}', '{"hash": "abc"}', "[]", "no JSON", '"hash"'))
def test_pictures_of_other_programs_stay(run, tmp_path, theirs):
    mine = tmp_path / "mine"
    mine.mkdir()
    (mine / "movie.json").write_text(theirs)
    (mine / (FRAME % 0)).write_bytes(b"mine")
    for out, options in ((mine, {}), (tmp_path / "other", {"work": mine}), (mine, {"work": tmp_path / "work"})):
        with pytest.raises(dspace.InvalidArgument, match="belongs to no movie"):
            flight().make(run, out, **options)
        assert (mine / (FRAME % 0)).read_bytes() == b"mine" and (mine / "movie.json").read_text() == theirs
        assert sorted(os.listdir(mine)) == [FRAME % 0, "movie.json"]


def test_what_somebody_keeps_beside_the_pictures_stays(run, tmp_path):
    out, notes = tmp_path / "pictures", ("frame_notes.txt", "a.part", "frame_000001.png.txt")
    flight().make(run, out)
    for name in notes:
        (out / name).write_text("years")
    assert flight(rate=20).make(run, out) == 24
    assert all((out / name).read_text() == "years" for name in notes)


def test_pictures_of_a_longer_movie_are_gone(run, tmp_path):
    """Also where the pictures are drawn in another folder."""
    out, work = tmp_path / "pictures", tmp_path / "work"
    for options in ({}, {"work": work}):
        assert flight(rate=20).make(run, out, **options) == 24
        assert flight().make(run, out, **options) == 12
        assert sorted(each.name for each in out.glob("frame_*")) == [FRAME % number for number in range(12)]
    assert files(out, 12) == files(work, 12)
    assert flight().make(run, out) == 0  # the folder knows what it holds


def test_a_folder_that_was_only_begun_is_taken(run, tmp_path):
    """A process that was ended before it could say whose the folder is."""
    out = tmp_path / "pictures"
    out.mkdir()
    (out / ".movie.json.0123456789abcdef.part").write_text("")
    (out / "movie.lock").write_text("")
    assert flight().make(run, out) == 12
    assert json.loads((out / "movie.json").read_text())["kind"] and not list(out.glob("*.part"))


def test_run_times_beyond_a_recording_stand_and_say_so(tmp_path):
    """The number that an overlay shows is that of the picture."""
    path = tmp_path / "run.dspace"
    with dspace.Session() as session:
        _, advance = boxes(session)
        with session.record(path):
            for number in range(11):
                advance(100 + number / 10)
    shown = []
    from dspace.movies.draw import Stage, open_run
    movie = still(30, start=98.9999999, speed=1.0)
    movie.rate = 10.0
    source = open_run(path)
    try:
        stage = Stage(movie, source)
        value = stage._value
        stage._value = lambda key, *rest: shown.append(value(key, *rest)) or shown[-1]
        movie.add_overlay("", [("run", "{run:.3f}"), ("x", "{box.x:.3f}")])
        stage = stage.picture
        for number in range(30):
            stage(number)
    finally:
        source.close()
    runs, places = np.array(shown[::2]), np.array(shown[1::2])
    expected = np.clip(98.9999999 + np.arange(30) / 10, 100, 101)
    np.testing.assert_allclose(runs, expected, atol=1e-9)
    np.testing.assert_allclose(places, np.floor(np.round(runs * 10, 3)) / 10, atol=1e-9)
