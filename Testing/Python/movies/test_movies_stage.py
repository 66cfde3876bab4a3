"""What a movie does in a session: viewports of its own, views that meet, and what is refused before it is drawn."""
import bisect
import warnings

import numpy as np
import pytest

import dspace
from dspace.movies.draw import Source, Stage, open_run
from dspace.playback.steps import StepTimes
from dspace.movies.folder import FRAME
from dspace.movies.views import Overlay, View
from movies_support import SIZE, pixels


def colored(color, size=SIZE, title=""):
    movie = dspace.Movie(size=size, rate=10, samples=1, duration=0.2)
    movie.add_view(background=color)
    movie.add_key(time=0.0, position=(0, -5, 0), target=(0, 0, 0))
    if title:
        movie.add_overlay(title)
    return movie


def state(session):
    return (sorted(session.viewports), {name: sorted(vantage.cameras) for name, vantage in
                                        session.scene().vantages.items()}, session.scene().vantages["main"].active)


# --- The session -----------------------------------------------------------------------------------

def test_movies_of_one_session_know_nothing_of_each_other(session, scene, tmp_path):
    before = state(session)
    colored("red", title="RED").make(session, tmp_path / "red")
    assert state(session) == before
    colored("blue").make(session, tmp_path / "blue")
    colored("lime", size=(34, 20)).make(session, tmp_path / "lime")
    assert state(session) == before
    for name, size, color in (("blue", SIZE, (0, 0, 255)), ("lime", (34, 20), (0, 255, 0))):
        shown = pixels(tmp_path / name / (FRAME % 1)).reshape(size[1], size[0], 3)
        assert (shown == color).all()
    # Also of viewports of that name that somebody else made, and of two movies at once.
    scene.add_camera("c", eye=(0, -5, 0), target=(0, 0, 0))
    scene.add_viewport((10, 10), "c", name="movie main").set_background("yellow")
    red, blue = (Stage(colored(color), Source(session)) for color in ("red", "blue"))
    for _ in range(2):
        assert (red.picture(0) == (255, 0, 0)).all() and (blue.picture(0) == (0, 0, 255)).all()
    red.close()
    assert (blue.picture(1) == (0, 0, 255)).all()
    blue.close()
    assert sorted(session.viewports) == ["movie main"]


def test_a_movie_that_fails_leaves_nothing_behind(session, scene, tmp_path):
    before = state(session)
    movie = colored("red")
    movie.add_overlay("t", [("a", "{nobody}")])
    with pytest.raises(dspace.InvalidArgument, match="nobody"):
        movie.make(session, tmp_path / "a")
    assert state(session) == before


def test_a_recording_of_a_movie_being_made_is_a_run(tmp_path):
    """It holds that movie's viewports, which come while this one is drawn."""
    path = tmp_path / "run.dspace"
    with dspace.Session() as session:
        scene = session.scene()
        with session.record(path):
            for number in range(6):
                scene.time = number / 10
                if number == 3:
                    colored("red", title="RED").make(session, tmp_path / "red")
                    scene.add_camera("c", eye=(0, -5, 0), target=(0, 0, 0))
                    scene.add_viewport((10, 10), "c", name="movie main").set_background("yellow")
    movie = colored("blue")
    movie._duration = 0.6
    for speed, start in ((1.0, 0.0), (-1.0, 0.5)):
        movie.speed, movie.start = speed, start
        source = open_run(path)
        try:
            stage = Stage(movie, source)
            for number in range(6):
                assert (stage.picture(number) == (0, 0, 255)).all()
        finally:
            source.close()


def test_fragments_that_come_later_are_hidden_when_they_come(session, scene):
    movie = colored("blue")
    movie.views["main"].hide = ("late",)
    stage = Stage(movie, Source(session))
    assert (stage.picture(0) == (0, 0, 255)).all()
    fragment = scene.add_fragment("late")
    box = scene.add_box((1, 1, 1), fragment=fragment, color="red")
    assert (stage.picture(1) == (0, 0, 255)).all()
    box.remove()
    fragment.remove()
    assert (stage.picture(1) == (0, 0, 255)).all()
    scene.add_box((1, 1, 1), fragment=scene.add_fragment("late"), color="red")
    assert (stage.picture(1) == (0, 0, 255)).all()
    movie.views["main"].hide = ()
    assert (stage.picture(1) != (0, 0, 255)).any()
    movie.views["main"].hide = ("lait",)
    with pytest.warns(UserWarning, match="hide names 'lait', but no picture"):
        stage.close()
    movie.views["main"].hide = ("late",)
    stage = Stage(movie, Source(session))
    stage.picture(0)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        stage.close()


# --- The run's time --------------------------------------------------------------------------------

@pytest.mark.parametrize("step", (0.01, 0.001, 0.1))
def test_steps_that_are_added_up_are_met(step):
    """Every time n x step finds step n, however late the sum is by then."""
    count = 400_000
    times = [0.0]
    for _ in range(count):
        times.append(times[-1] + step)
    late = max(abs(times[n] - n * step) for n in range(0, count, 97))
    assert late > 1e-9 or step == 0.001
    steps = StepTimes(times)
    for n in range(1, count, 97):
        asked = n * step
        assert bisect.bisect_right(times, steps.step_at(asked)) - 1 == n
        assert steps.step_at(asked - 0.01 * step) == asked - 0.01 * step  # before it is before it


def test_no_step_is_shown_before_its_time():
    assert StepTimes([0.0, 1000.0]).step_at(999.9) == 999.9 and StepTimes([0.0, 1000.0]).step_at(1000 - 1e-5) == 1000
    assert StepTimes([5.0, 6.0]).step_at(4.9998) == 4.9998 and StepTimes([5.0, 6.0]).step_at(7.0) == 7.0
    assert StepTimes([5.0, 6.0]).step_at(4.9999999) == 5.0  # the first of all may be late, too
    assert StepTimes([1.0, 1.0, 2.0]).step_at(1.0) == 1.0 and StepTimes([]).step_at(1.0) == 1.0
    # Of a simulation that was reset the later run counts, whose steps are not the earlier one's.
    times = [0.0, 1.0, 2.0, 0.0, 1.00005, 2.0, 3.0]
    assert StepTimes(times).step_at(1.0) == 1.00005 and StepTimes(times).step_at(1.99) == 1.99
    assert StepTimes(times).step_at(2.0) == 2.0 and StepTimes(times).step_at(-1.0) == -1.0


# --- What is refused at once -----------------------------------------------------------------------

def test_views_that_share_an_edge_meet():
    """A view's right edge is its neighbour's left one, at every width."""
    for a, b in ((0.02, 0.68), (0.1, 0.6), (0.3, 0.4), (0.15, 0.55), (0.1, 0.2)):
        edge = float(f"{a + b:.3f}")
        left = View("a", (a, 0.0, b, 1.0))
        right = View("b", (edge, 0.0, 1 - edge, 1.0))
        top, bottom = View("c", (0.0, a, 1.0, b)), View("d", (0.0, edge, 1.0, 1 - edge))
        for pixels_ in range(100, 3000):
            assert left.pixels((pixels_, 50))[2] == right.pixels((pixels_, 50))[0]
            assert top.pixels((50, pixels_))[3] == bottom.pixels((50, pixels_))[1]
        assert right.pixels((1285, 50))[2] == 1285


@pytest.mark.parametrize("change, says", [
    ({"near": -5}, "near is -5; accepted: 1e-9 to 1e18 metres"), ({"near": 0}, "near is 0"),
    ({"near": 2, "far": 1}, "far is 1; accepted: more than near"), ({"far": 0.01}, "far is 0.01"),
    ({"far": float("nan")}, "far is nan"), ({"near": "x"}, "near is 'x'"),
    ({"background": "nocolour"}, "background is 'nocolour'"), ({"background": (0, 0, 2)}, "background is"),
    ({"background": "red", "background_top": "#12345g"}, "background_top is '#12345g'"),
    ({"background_top": "red"}, "none without a background"),
])
def test_bad_views_are_refused(change, says):
    with pytest.raises(dspace.Error, match="view 'main'") as error:
        dspace.Movie().add_view(camera="c", **change)
    assert says in str(error.value)


@pytest.mark.parametrize("change, says", [
    ({"font_size": 3}, "font_size is 3; accepted: 0 or 4 to 200"), ({"font_size": 201}, "font_size is 201"),
    ({"since": 2.0, "until": 2.0}, "until is 2.0; accepted: after since (2 s)"), ({"until": -1}, "until is -1"),
    ({"since": float("nan")}, "since is nan"),
])
def test_bad_overlays_are_refused(change, says):
    with pytest.raises(dspace.Error, match="overlay 'A'") as error:
        dspace.Movie().add_overlay("A", **change)
    assert says in str(error.value)


def test_what_was_changed_later_is_looked_at_again():
    for change in (lambda movie: setattr(movie.overlays[0], "font_size", 3),
                   lambda movie: setattr(movie.views["main"], "near", -5)):
        movie = colored("red", title="A")
        movie.check()
        change(movie)
        with pytest.raises(dspace.InvalidArgument, match="accepted"):
            movie.check()


def test_letters_of_the_highest_movies_are_as_large_as_letters_may_be(session, scene):
    assert [Overlay("A").pixels((10, height)) for height in (40, 720, 4320, 8000, 8020, 16384)] == [
        8, 18, 108, 200, 200, 200]
    movie = colored("blue", size=(150, 8100), title="A")
    stage = Stage(movie, Source(session))
    picture = stage.picture(0)
    stage.close()
    rows = np.flatnonzero((picture != (0, 0, 255)).any((1, 2)))
    assert 100 < np.ptp(rows) < 500
