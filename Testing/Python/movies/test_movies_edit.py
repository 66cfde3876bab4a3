"""Edits of key frames by the times of the run: what becomes of the movie's times, against times worked out by hand."""
import numpy as np
import pytest

import dspace
from dspace.movies.edit import KeyEditor
from dspace.movies.keys import Key


def editor(*keys, **settings):
    """An editor of keys (movie time, run time) along X = run time."""
    movie = dspace.Movie(**settings)
    view = movie.add_view("main")
    for time, run, *more in keys:
        movie.add_key(time=time, run=run, position=(run or 0.0, time, 0.0), quaternion=(1, 0, 0, 0), view="main",
                      **(more[0] if more else {}))
    return KeyEditor(movie, view, beginning=100.0)


def key_at(x):
    return lambda time: Key(time=time, position=(x, 0, 0), quaternion=(1, 0, 0, 0))


def times(edit):
    return [(key.time, key.run) for key in edit.keys]


def test_keys_without_a_run_time_get_the_one_that_they_show():
    movie = dspace.Movie(start=50.0, speed=2.0)
    view = movie.add_view("main")
    for time, run, cut in ((0.0, None, False), (2.0, 60.0, False), (3.0, None, False), (5.0, 70.0, False),
                           (5.0, None, True), (8.0, None, False)):
        movie.add_key(time=time, run=run, position=(0, 0, 0), quaternion=(1, 0, 0, 0), view="main", cut=cut)
    before = movie.run_time()
    moments = np.linspace(0, 10, 401)
    runs = [before.at(moment) for moment in moments]
    KeyEditor(movie, view)
    assert all(key.run is not None for key in view.keys)
    after = movie.run_time()
    assert np.allclose([after.at(moment) for moment in moments], runs, atol=1e-12)
    assert view.keys[2].run == pytest.approx(60 + 10 / 3)  # linear from 60 at 2 s to 70 at 5 s


def test_a_new_key_comes_where_the_run_is_at_that_time():
    edit = editor((0.0, 100.0), (4.0, 110.0))  # 2.5 s of the run a second
    assert edit.add(105.0, key_at(1)) == 1
    assert times(edit) == [(0, 100), (2, 105), (4, 110)]
    assert edit.add(113.0, key_at(2)) == 3  # after the last, at the movie's speed of 1
    assert times(edit)[3] == (7, 113)
    assert edit.add(98.0, key_at(3)) == 0  # before the first: the others come 2 s later
    assert times(edit) == [(0, 98), (2, 100), (4, 105), (6, 110), (9, 113)]
    assert edit.keys[0].position == (3, 0, 0)
    with pytest.raises(dspace.InvalidArgument, match="one without a key"):
        edit.add(105.0, key_at(4))
    assert len(edit.keys) == 5


def test_the_speed_of_new_spans_is_the_movies():
    edit = editor(speed=4.0)
    edit.add(100.0, key_at(0))
    edit.add(108.0, key_at(1))
    edit.add(96.0, key_at(2))
    assert times(edit) == [(0, 96), (1, 100), (3, 108)]
    backwards = editor(speed=-2.0)
    backwards.add(100.0, key_at(0))
    backwards.add(90.0, key_at(1))
    backwards.add(104.0, key_at(2))
    assert times(backwards) == [(0, 104), (2, 100), (7, 90)]


def test_a_moved_key_keeps_the_rates_of_its_spans():
    edit = editor((0.0, 100.0), (2.0, 104.0), (5.0, 107.0), (6.0, 108.0))  # 2, 1, 1 s of the run a second
    edit.move(1, 102.0)  # 2 s of the run at 2, then 5 s at 1
    assert times(edit) == [(0, 100), (1, 102), (6, 107), (7, 108)]
    with pytest.raises(dspace.InvalidArgument, match="more than 100, less than 107"):
        edit.move(1, 107.0)
    edit.move(3, 120.0)
    assert times(edit)[3] == (19, 120)
    edit.move(0, 90.0)
    assert times(edit)[0] == (0, 90)
    assert times(edit)[1] == (6, 102)  # 12 s at 2


def test_a_freeze_stays_as_long_as_it_is_and_moves_as_a_whole():
    edit = editor((0.0, 100.0), (10.0, 110.0), (20.0, 120.0))
    edit.freeze(1, 3.0)
    assert times(edit) == [(0, 100), (10, 110), (13, 110), (23, 120)]
    assert edit.keys[1].position == edit.keys[2].position
    runs = edit.movie.run_time()
    assert [runs.at(moment) for moment in (9.0, 10.5, 12.9, 14.0)] == pytest.approx([109, 110, 110, 111])
    edit.move(2, 105.0)
    assert times(edit) == [(0, 100), (5, 105), (8, 105), (23, 120)]
    edit.freeze(1, 1.0)
    assert times(edit) == [(0, 100), (5, 105), (6, 105), (21, 120)]
    edit.add_frozen(105.0, 2.0, key_at(7))  # the camera moves while the run stands
    assert times(edit) == [(0, 100), (5, 105), (6, 105), (8, 105), (23, 120)]
    edit.freeze(2, 6.0)
    assert times(edit) == [(0, 100), (5, 105), (7, 105), (11, 105), (26, 120)]
    edit.erase(3)
    assert times(edit) == [(0, 100), (5, 105), (7, 105), (22, 120)]
    edit.freeze(1, 0.0)
    assert times(edit) == [(0, 100), (5, 105), (20, 120)]
    with pytest.raises(dspace.InvalidArgument, match="that of a key"):
        edit.add_frozen(111.0, 2.0, key_at(7))


def test_spans_take_the_time_that_is_asked_for():
    edit = editor((0.0, 100.0), (10.0, 110.0), (20.0, 120.0), duration=25.0)
    edit.set_span(0, 40.0)
    assert times(edit) == [(0, 100), (40, 110), (50, 120)]
    assert edit.movie.duration == 55.0  # what comes after the last key stays
    with pytest.raises(dspace.InvalidArgument, match="a key before the last"):
        edit.set_span(2, 1.0)
    with pytest.raises(dspace.InvalidArgument, match="seconds"):
        edit.set_span(0, 0.0)


def test_erasing_keeps_cuts_and_begins_at_zero():
    edit = editor((0.0, 100.0), (4.0, 104.0), (4.0, 110.0, {"cut": True}), (8.0, 114.0))
    edit.erase(2)
    assert times(edit) == [(0, 100), (4, 104), (8, 114)] and edit.keys[2].cut
    edit.erase(0)
    assert times(edit) == [(0, 104), (4, 114)]
    edit.erase(0)
    edit.erase(0)
    assert edit.keys == []
    with pytest.raises(dspace.NotFound, match="there is no key 0"):
        edit.erase(0)


def test_a_key_at_the_end_of_a_shot_moves_the_next_shot():
    edit = editor((0.0, 100.0), (4.0, 104.0), (4.0, 110.0, {"cut": True}), (8.0, 114.0))
    edit.add(106.0, key_at(1))
    assert times(edit) == [(0, 100), (4, 104), (6, 106), (6, 110), (10, 114)]
    assert [key.cut for key in edit.keys] == [False, False, False, True, False]


def test_other_values_change_and_bad_ones_change_nothing():
    edit = editor((0.0, 100.0), (4.0, 104.0))
    edit.change(1, easing="rest", fov_deg=20)
    assert edit.keys[1].easing == "rest" and edit.keys[1].fov_deg == 20
    edit.change(1, target=(9, 9, 9))
    assert edit.keys[1].quaternion is None and edit.keys[1].target == (9, 9, 9)
    before = list(edit.keys)
    for values, words in (({"height": 3.0}, "its projection"), ({"easing": "soft"}, "easing"), ({"time": 3}, "move"),
                          ({"fov_deg": 500}, "fov_deg")):
        with pytest.raises(dspace.Error, match=words):
            edit.change(1, **values)
        assert edit.keys == before
    edit.change(1, height=3.0, cut=True)  # after a cut another projection
    assert edit.keys[1].lens == "height"


def test_a_view_of_a_camera_has_no_keys():
    movie = dspace.Movie()
    with pytest.raises(dspace.InvalidArgument, match="it shows the camera"):
        KeyEditor(movie, movie.add_view("main", camera="mast"))
