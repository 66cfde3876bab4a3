"""Camera key frames of a recording in DspaceQt: what they make of the movie's file, and what a view shows of them."""
import gc
import os
import pathlib
import subprocess
import sys

import numpy as np
import pytest

import dspace
from dspace.application import App
from test_application import Host


@pytest.fixture
def app():
    app = App(Host())
    yield app
    app.close()


@pytest.fixture
def path(tmp_path):
    """A cart that goes 1 m a second along X, from 100 s to 110 s."""
    path = tmp_path / "cart.dspace"
    with dspace.Session() as session, session.record(path):
        scene = session.scene()
        cart = scene.add_frame("cart")
        scene.add_box((1, 1, 1), frame=cart, color=(1, 0.2, 0.1))
        scene.add_viewport((64, 48), scene.add_camera(eye=(5, -14, 3), target=(5, 0, 0)), name="main")
        for i in range(41):
            scene.time = 100 + 0.25 * i
            cart.pose = dspace.Pose((0.25 * i, 0, 0))
    return path


@pytest.fixture
def run(app, path):
    run = app.open(path)
    app._host.activated = (run._player, "scene")
    return run


def place(view, eye, target=(5, 0, 0)):
    """Moves the view's own camera."""
    from dspace.application.views import own_camera
    own_camera(view).look_at(eye, target)


def three_keys(app, run):
    view = app.views["viewer:main"]
    for time, eye in ((101.0, (0, -10, 2)), (105.0, (5, -10, 2)), (109.0, (10, -10, 2))):
        place(view, eye)
        app.movie.add_key(view, time)
    app.movie.flush()
    return view


def track(app):
    """What the timeline was last told."""
    return [told for told in app._host.extended if told["do"] == "keys"][-1]


def test_keys_are_kept_in_the_file_of_a_movie(app, run, path):
    view = three_keys(app, run)
    side = pathlib.Path(f"{path}.movie.toml")
    movie = dspace.Movie.load(side)  # as `dspace movie` reads it
    keys = movie.views["main"].keys
    assert [(key.time, key.run) for key in keys] == [(0, 101), (4, 105), (8, 109)]
    assert np.allclose([key.position for key in keys], [(0, -10, 2), (5, -10, 2), (10, -10, 2)])
    assert keys[0].fov_deg == pytest.approx(45) and movie.duration == 8
    assert [key["run"] for key in track(app)["keys"]] == [101, 105, 109]
    assert track(app)["of"] == run._player.GetAddressAsString("vtkObject") and track(app)["file"] == str(side)
    # Moved, frozen, edited, erased.
    app.movie.move_key(1, 103.0)
    app.movie.freeze(1, 2.0)
    app.movie.edit_key(0, easing="rest")
    app.movie.flush()
    keys = dspace.Movie.load(side).views["main"].keys
    assert [(key.time, key.run) for key in keys] == [(0, 101), (2, 103), (4, 103), (10, 109)]
    assert keys[0].easing == "rest"
    place(view, (3, -5, 8))
    app.movie.take_view(3, view)
    app.movie.delete_key(0)
    app.movie.flush()
    keys = dspace.Movie.load(side).views["main"].keys
    assert [(key.time, key.run) for key in keys] == [(0, 103), (2, 103), (8, 109)]
    assert np.allclose(keys[2].position, (3, -5, 8))
    # The next start of the application has them.
    run.close()
    again = app.open(path)
    assert [(key.time, key.run) for key in again.movie.keys] == [(0, 103), (2, 103), (8, 109)]


def test_no_garbage_is_collected_while_the_file_is_written(app, run, path):
    """It would be in the thread that writes, and may hold a session whose OpenGL is of another one."""
    view = app.views["viewer:main"]
    for time in (101.0, 103.0):
        place(view, (0, -10, time - 100))
        app.movie.add_key(view, time)
        assert not gc.isenabled()
    app.movie.flush()
    assert gc.isenabled() and len(app.movie.keys) == 2
    app.movie.add_key(view, 105.0)
    app.close()
    assert gc.isenabled()


def test_a_movie_of_one_key_is_a_still_and_of_none_has_no_file(app, run, path):
    side = pathlib.Path(f"{path}.movie.toml")
    app.movie.add_key(app.views["viewer:main"])
    app.movie.flush()
    assert dspace.Movie.load(side).duration == 1.0
    app.movie.add_key(app.views["viewer:main"], 110.0)
    app.movie.flush()
    assert dspace.Movie.load(side).duration == 10.0
    app.movie.clear()
    app.movie.flush()
    assert not side.exists() and app.movie.keys == []


def test_the_file_may_hold_more_and_keeps_it(app, path):
    movie = dspace.Movie(size=(320, 200), rate=12, start=102.0)
    movie.add_view("main", hide=["ornamental"])
    for time, x in ((0.0, 0.0), (3.0, 6.0)):
        movie.add_key(time=time, position=(x, -9, 2), target=(0, 0, 0), target_frame="cart", view="main")
    movie.add_overlay("CART", [("run", "{run:.1f} s")])
    side = f"{path}.movie.toml"
    movie.save(side)
    run = app.open(path)
    app._host.activated = (run._player, "scene")
    assert [key.run for key in run.movie.keys] == [102, 105]
    run.movie.move_key(1, 108.0)
    run.movie.flush()
    kept = dspace.Movie.load(side)
    assert kept.size == (320, 200) and kept.rate == 12 and kept.overlays[0].title == "CART"
    run.movie.clear()
    run.movie.flush()
    assert dspace.Movie.load(side).overlays[0].title == "CART"  # no valid movie is left, and the file stays
    assert kept.views["main"].hide == ("ornamental",) and kept.views["main"].keys[1].target_frame == "cart"


def test_changes_that_fail_change_nothing(app, run, path):
    three_keys(app, run)
    before, words = app.movie.keys, pathlib.Path(f"{path}.movie.toml").read_text()
    eye = app.scene.add_camera("eye", eye=(6, -8, 5), target=(0, 0, 0))
    for change, text in ((lambda: app.movie.move_key(1, 120.0), "less than 109"),
                         (lambda: app.movie.add_key(app.view, 99.0), "100 to 110"),
                         (lambda: app.movie.add_key(app.view, 105.0), "without a key"),
                         (lambda: app.movie.edit_key(0, fov_deg=500), "fov_deg"),
                         (lambda: app.movie.edit_key(7, easing="rest"), "there is no key 7"),
                         (lambda: app.movie.set(rate=-1), "rate"),
                         (lambda: app.movie.add_key(app.scene.add_viewport((64, 48), eye), 104.0), "one of the same recording")):
        with pytest.raises(dspace.Error, match=text):
            change()
        assert app.movie.keys == before
    app.movie.flush()
    assert pathlib.Path(f"{path}.movie.toml").read_text() == words
    app._host.activated = None
    with pytest.raises(dspace.NotFound, match="is no recording"):
        app.movie


def test_a_file_that_is_not_a_movie_stays_as_it_is(app, path):
    side = pathlib.Path(f"{path}.movie.toml")
    side.write_text("not [a movie")
    run = app.open(path)
    assert any("cart.dspace.movie.toml" in message for message in app._host.messages)
    run.movie.add_key(app.views["viewer:main"])
    run.movie.flush()
    assert side.read_text() == "not [a movie"
    with pytest.raises(dspace.Error, match="could not be read"):
        run.movie.save()


def test_a_file_that_another_program_changed_is_not_overwritten(app, run, path):
    three_keys(app, run)
    side = pathlib.Path(f"{path}.movie.toml")
    edited = side.read_text().replace("easing", "easing").replace("fov_deg = 45.0", "fov_deg = 40.0") + "\n# by hand\n"
    side.write_text(edited)
    with pytest.raises(dspace.InvalidArgument, match="another program changed"):
        app.movie.delete_key(0)
    assert side.read_text() == edited and len(app.movie.keys) == 3
    app.movie.load()
    app.movie.delete_key(0)
    app.movie.flush()
    assert len(dspace.Movie.load(side).views["main"].keys) == 2


def test_a_view_follows_the_keys_and_gets_its_camera_back(app, run):
    view = three_keys(app, run)
    place(view, (1, 2, 30))
    before = view.camera
    app.movie.follow(view)
    for time, x in ((101.0, 0.0), (103.0, 2.5), (107.0, 7.5), (109.0, 10.0), (110.0, 10.0)):
        run.seek(time)
        app._moved()
        position = view.camera.pose_in().position
        assert position == pytest.approx((x, -10, 2), abs=1e-9)  # evenly along a line
    app.movie.stop()
    assert view.camera == before
    assert view.camera.pose_in().position == pytest.approx((1, 2, 30))


def test_a_preview_plays_the_movie(app, run, monkeypatch):
    view = three_keys(app, run)
    app.movie.freeze(1, 2.0)
    now = [50.0]
    monkeypatch.setattr("dspace.application.key_frames.clock.monotonic", lambda: now[0])
    app.movie.preview(view, 1.0)
    step = next(function for milliseconds, function in app._host.timers.values() if milliseconds == 33)
    for moment, time, x in ((50.0, 102.0, 1.25), (53.0, 105.0, 5.0), (54.5, 105.0, 5.0), (56.0, 106.0, None)):
        now[0] = moment
        step()
        assert run.time == time
        if x is not None:
            assert view.camera.pose_in().position[0] == pytest.approx(x, abs=0.35)  # it slows down to the freeze
    now[0] = 70.0
    step()
    assert not any(milliseconds == 33 for milliseconds, _ in app._host.timers.values())
    assert not track(app)["preview"]


def test_the_path_is_drawn_and_comes_back(app, run):
    view = three_keys(app, run)
    app.movie.show_path()
    scene = run.session.scenes["scene"]
    names = [name for name in scene.objects if name.startswith("movie path")]
    assert sorted(names) == ["movie path 0", "movie path 0 key 0", "movie path 0 key 1", "movie path 0 key 2"]
    assert all(scene.objects[name].ornamental for name in names)
    run.seek(109.0)
    run.seek(100.0)  # back: additions are lost
    app._moved()
    scene = run.session.scenes["scene"]
    assert "movie path 0" in scene.objects
    app.movie.show_path(False)
    assert not any(name.startswith("movie path") for name in scene.objects)
    assert view.scene.name == "scene"


def test_the_command_makes_the_movie_of_the_file(app, run, path, tmp_path):
    three_keys(app, run)
    app.movie.set(size=(64, 48), rate=1, samples=1)
    app.movie.flush()
    out = tmp_path / "pictures"
    done = subprocess.run([sys.executable, "-m", "dspace", "movie", f"{path}.movie.toml", "--run", str(path), "--out",
                           str(out)], capture_output=True, text=True, env={**os.environ})
    assert done.returncode == 0, done.stderr
    assert len(list(out.glob("frame_*.png"))) == 8
