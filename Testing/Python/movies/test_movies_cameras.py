"""Keys of every kind of camera: orthographic, off-axis, chasing, pointing and of a connected session."""
import numpy as np
import pytest

import dspace
from dspace.movies.draw import Source, Stage
from dspace.movies.keys import CameraPath, Key
from served_support import Served

SIZE = (96, 72)
TURN = (0.5, -0.5, 0.5, -0.5)
KINDS = {
    "perspective": (dict(eye=(9, -6, 5), target=(0, 0, 0)), dict(fov_deg=33.0)),
    "orthographic": (dict(eye=(9, -6, 5), target=(0, 0, 0)), dict(height=7.0)),
    "off-axis": (dict(eye=(9, -6, 5), target=(0, 0, 0)), dict(tangents=(-0.3, 0.5, -0.2, 0.4))),
    "chase": (dict(frame="rover", chase=dict(offset=(-8, 1, 3))), dict(fov_deg=50.0)),
    "pointing": (dict(frame="mast", point_at=dict(aim="rover", eye=(0, 0, 1))), dict(height=9.0)),
}


def fill(scene):
    rover = scene.add_frame("rover", position=(1, 0, 0))
    scene.add_frame("mast", position=(-6, -7, 2))
    scene.add_box((2, 1, 1), frame=rover, name="body", color="#a05020")
    scene.add_box((40, 40, 1), position=(0, 0, -2), name="ground")


def key_picture(session, kind):
    """The picture of a viewport, and the one of a movie with one key of its camera."""
    scene = session.scene()
    fill(scene)
    place, projection = KINDS[kind]
    view = scene.add_viewport(SIZE, scene.add_camera("eye", **place, **projection))
    movie = dspace.Movie(size=SIZE, duration=1.0, rate=1.0)
    key = movie.add_key(view, 0.0)
    name, value = next(iter(projection.items()))
    assert getattr(key, name) == value and key.lens == name
    again = dspace.Movie.of_text(movie.text)  # through its file
    assert again.views["main"].keys == movie.views["main"].keys
    stage = Stage(again, Source(session))
    picture = stage.picture(0)
    stage.close()
    return view.image(), picture


@pytest.mark.parametrize("kind", KINDS)
def test_a_key_shows_what_its_camera_showed(session, kind):
    seen, made = key_picture(session, kind)
    # The key's pose was rounded once more; a sample at an edge may fall to the other side.
    assert len(np.unique(seen.reshape(-1, 3), axis=0)) > 3
    assert (seen != made).any(axis=-1).mean() < 0.005


@pytest.mark.parametrize("kind", KINDS)
def test_so_does_one_of_a_connected_session(tmp_path, kind):
    with Served(tmp_path) as served, dspace.connect(served.address) as session:
        seen, made = key_picture(session, kind)
        assert (seen != made).any(axis=-1).mean() < 0.005


def test_heights_are_interpolated_by_their_logarithm():
    path = CameraPath([Key(time=t, position=(0, 0, t), quaternion=TURN, height=4.0 * 3.0**t) for t in (0.0, 1.0, 3.0)])
    for t in (0.0, 0.25, 1.0, 2.2, 3.0):
        assert path.at(t)[3] == {"height": pytest.approx(4.0 * 3.0**t, rel=1e-12)}


def test_tangents_are_interpolated_each_by_itself():
    side = lambda t: (-0.5 + 0.1 * t, 0.5 + 0.2 * t, -0.4 - 0.05 * t, 0.4)  # even rates stay even
    path = CameraPath([Key(time=t, position=(0, 0, t), quaternion=TURN, tangents=side(t)) for t in (0.0, 1.0, 3.0)])
    for t in (0.0, 0.25, 1.0, 2.2, 3.0):
        np.testing.assert_allclose(path.at(t)[3]["tangents"], side(t), rtol=1e-12)
    # Between monotone keys no border passes another: the picture is never empty.
    path = CameraPath([Key(time=t, position=(0, 0, t), quaternion=TURN, tangents=each) for t, each in
                       ((0.0, (-1, 1, -1, 1)), (1.0, (-0.01, 0.01, -0.01, 0.01)), (2.0, (-1, 1, -1, 1)))])
    for t in np.linspace(0, 2, 201):
        left, right, top, bottom = path.at(t)[3]["tangents"]
        assert 0.02 - 1e-12 <= right - left <= 2 and 0.02 - 1e-12 <= bottom - top <= 2


def test_a_cut_may_change_the_kind():
    keys = [Key(time=0.0, position=(0, 0, 0), quaternion=TURN), Key(time=1.0, position=(0, 0, 0), quaternion=TURN, height=3.0)]
    with pytest.raises(dspace.InvalidArgument, match="the key at 1 s: its projection is 'height'; accepted: fov_deg"):
        CameraPath(keys)
    keys[1] = Key(time=1.0, position=(0, 0, 0), quaternion=TURN, height=3.0, cut=True)
    path = CameraPath(keys)
    assert path.at(0.5)[3] == {"fov_deg": 45.0} and path.at(1.0)[3] == {"height": 3.0}


@pytest.mark.parametrize("values, says", [
    (dict(height=0.0), "height is 0"), (dict(height=float("nan")), "height is nan"), (dict(height="x"), "height is 'x'"),
    (dict(height=2.0, fov_deg=30.0), "one of fov_deg, height and tangents"),
    (dict(height=2.0, tangents=(-1, 1, -1, 1)), "one of fov_deg, height and tangents"),
    (dict(tangents=(1, -1, -1, 1)), "left < right"), (dict(tangents=(-1, 1, 0, 0)), "top < bottom"),
    (dict(tangents=(-1, 1, -1)), "tangents"), (dict(tangents=(-1e7, 1, -1, 1)), "-1e6 to 1e6"),
])
def test_other_values_are_rejected(values, says):
    with pytest.raises((dspace.InvalidArgument, dspace.WrongType), match=says):
        Key(time=0.0, position=(0, 0, 0), quaternion=TURN, **values)


def test_a_value_replaces_the_projection_of_the_camera(session):
    scene = session.scene()
    fill(scene)
    camera = scene.add_camera("eye", **KINDS["orthographic"][0], height=5.0)
    assert dspace.Movie().add_key(camera, 0.0, fov_deg=20.0).fov_deg == 20.0
    assert dspace.Movie().add_key(camera, 0.0, height=8.0).height == 8.0
