"""Movies made in the background: progress, cancel, a full disk, and files that stay whole."""
import resource
import time

import pytest

import dspace
import needs
from dspace.application import App
from dspace.movies.apart import Making
from movies_support import flight, run  # noqa: F401 (a fixture)
from test_application import Host

PATIENCE = 120  # [s]


@pytest.fixture
def app():
    app = App(Host())
    yield app
    app.close()


def recording(path, seconds=4):
    with dspace.Session() as session, session.record(path):
        scene = session.scene()
        frame = scene.add_frame("cart")
        scene.add_box((1, 1, 1), frame=frame)
        scene.add_viewport((64, 48), scene.add_camera(eye=(3, -9, 3), target=(2, 0, 0)), name="main")
        for i in range(10 * seconds + 1):
            scene.time = 0.1 * i
            frame.pose = dspace.Pose((0.1 * i, 0, 0))
    return path


def ended(export, app, until=lambda: False):
    """Lets the timers of the windows run until an export has ended."""
    began, texts = time.monotonic(), []
    while export.state == "working" and not until():
        assert time.monotonic() - began < PATIENCE
        for _, function in list(app._host.timers.values()):
            try:
                function()
            except RuntimeError:  # its failure, for the Python dock
                pass
        texts.append(export.text)
        time.sleep(0.02)
    return texts


@pytest.fixture
def opened(app, tmp_path):
    opened = app.open(recording(tmp_path / "cart.dspace"))
    app._host.activated = (opened._player, "scene")
    view = app.views["viewer:main"]
    for at in (0.0, 4.0):
        app.movie.add_key(view, at)
    app.movie.set(size=(64, 48), rate=10, samples=1)
    return opened


def test_an_export_tells_its_progress_and_holds_nothing(app, opened, tmp_path):
    needs.needs_program("ffmpeg", "ffmpeg")
    out = tmp_path / "cart.mp4"
    out.write_bytes(b"an earlier movie")
    began = time.monotonic()
    export = app.export_movie(out, jobs=2)
    assert time.monotonic() - began < 1.0  # it returns at once
    assert export.state == "working" and out.read_bytes() == b"an earlier movie"
    texts = ended(export, app)
    assert export.state == "done" and export.done == 1.0, export.failure
    assert any("left" in text and " of 40" in text for text in texts)
    assert out.stat().st_size > 1000 and not (tmp_path / "cart.mp4.work").exists()
    assert app._host.tasks[export._task] == ""
    assert f"Saved {out}: 40 pictures" in app._host.messages
    assert not any(milliseconds == 100 for milliseconds, _ in app._host.timers.values())


def test_a_cancelled_export_keeps_the_earlier_file_and_goes_on_later(app, opened, tmp_path):
    app.movie.set(rate=200)
    out = tmp_path / "cart.mp4"
    needs.needs_program("ffmpeg", "ffmpeg")
    out.write_bytes(b"an earlier movie")
    export = app.export_movie(out)
    ended(export, app, lambda: "of 800" in export.text and export.done > 0.02)
    with pytest.raises(dspace.InvalidArgument, match="no other export"):
        app.export_movie(out)
    app._cancelled(export._task)  # the button
    ended(export, app)
    assert export.state == "cancelled" and export.failure == ""
    assert out.read_bytes() == b"an earlier movie"
    there = len(list((tmp_path / "cart.mp4.work").glob("frame_*.png")))
    assert 0 < there < 800
    again = app.export_movie(out)
    ended(again, app)
    assert again.state == "done", again.failure
    assert again._making.drawn <= 800 - there


def test_a_full_disk_is_an_error_that_leaves_the_earlier_file(app, opened, tmp_path):
    needs.needs_program("ffmpeg", "ffmpeg")
    out = tmp_path / "cart.mp4"
    out.write_bytes(b"an earlier movie")
    export = app.export_movie(out, size=(256, 160))
    pid = export._making.pid
    before = resource.prlimit(pid, resource.RLIMIT_FSIZE)
    resource.prlimit(pid, resource.RLIMIT_FSIZE, (600, before[1]))  # no picture fits
    ended(export, app)
    assert export.state == "failed" and ("large" in export.failure or "space" in export.failure), export.failure
    assert out.read_bytes() == b"an earlier movie"
    assert any(str(out) in message and "failed" in message for message in app._host.messages)
    assert not list(tmp_path.glob(".cart.mp4*.part"))


def test_bad_requests_are_rejected_before_a_process(app, opened, tmp_path):
    for values, words in (({"size": (63, 48)}, "even numbers"), ({"jobs": 0}, "1 to 64"), ({"rate": -1}, "rate"),
                          ({"movie": 3}, "the movie of a Run")):
        with pytest.raises(dspace.Error, match=words):
            app.export_movie(tmp_path / "x.mp4", **values)
    with pytest.raises(dspace.Error, match="its ending"):
        app.export_movie(tmp_path / "x.avi")
    app.movie.clear()
    with pytest.raises(dspace.Error):
        app.export_movie(tmp_path / "x.mp4")
    assert app.exports == []


def test_the_process_ends_with_the_one_that_asked(run, tmp_path):  # noqa: F811
    making = Making(flight(rate=300), run, tmp_path / "pictures")
    began = time.monotonic()
    while making.poll() and making.done < 0.01:
        assert time.monotonic() - began < PATIENCE
        time.sleep(0.02)
    assert not making._words  # all was asked
    making._process.stdin.close()  # as the end of this process closes it
    assert making._process.wait(PATIENCE) == 130
    making.poll()


def test_an_error_of_the_movie_is_told(tmp_path):
    making = Making(flight(), str(tmp_path / "nothing.dspace"), tmp_path / "pictures")
    with pytest.raises(dspace.Io, match="nothing.dspace"):
        making.wait()
