"""Movies: their files, and what their pictures show."""
import numpy as np
import pytest

import dspace
from dspace._core.png import is_whole, png
from dspace.movies.draw import Source, Stage, fill
from dspace.movies.folder import FRAME
from dspace.frames.poses import quaternion_of_axis
from movies_support import SIZE, flight, pixels, run  # noqa: F401  (run: a fixture)


# --- The file --------------------------------------------------------------------------------------

def test_a_movie_and_its_file_are_one(tmp_path):
    movie = flight(duration=2.5, start=4.0, speed=0.5)
    movie.add_view("side", rectangle=(0.5, 0, 0.5, 0.5), camera="fixed", hide=("helpers",), ornaments=False)
    movie.add_overlay('Quotes " \\ and \u00e4, \u2192', view="side", anchor="bottom right", font_size=12)
    path = tmp_path / "a.toml"
    movie.save(path)
    again = dspace.Movie.load(path)
    assert again.text == movie.text == path.read_text(encoding="utf-8")
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
    assert dspace.Movie().add_key(scene.cameras["c"], 0.0) == key  # without a viewport, too
    far = scene.add_frame("far", position=(1e12, 0, 0), quaternion=quaternion_of_axis("z", 90))
    scene.cameras["c"].chase(far, offset=(-4, 0, 0), target=(0, 0, 0))
    np.testing.assert_allclose(dspace.Movie().add_key(view, 0.0).position, (1e12, -4, 0), atol=1e-3)
    scene.add_camera("flat", eye=(0, 0, 1), target=(0, 0, 0), up=(0, 1, 0), height=3)
    assert dspace.Movie().add_key(scene.cameras["flat"], 0.0).height == 3


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
    viewport = session.viewports[stage.names["main"]]
    viewport.set_table("by hand", [("x", "12.5 m"), ("t", "0.5"), ("v", "28 V")], font_size=8)
    np.testing.assert_array_equal(viewport.image(), pictures[1])
    assert fill("{a:>5}|{b}", {"a": "x", "b": 1.5}.get) == "    x|1.5"
    for value, says in (("{nobody}", "no value 'nobody'; accepted: movie, run"), ("{run:zz}", "a value's format is"),
                        ("{ghost.x}", "ghost")):
        movie.overlays.clear()
        with pytest.raises(dspace.Error, match=says):
            movie.add_overlay("t", [("a", value)])
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
