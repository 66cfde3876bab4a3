"""Lines of sight and horizons that are rejected: the error names the object, the value and what is accepted."""
import numpy as np
import pytest

import dspace
from terrain_support import write_raster


@pytest.fixture
def ground(scene, tmp_path):
    """40 x 40 posts at height 5 with a hole about (10, 10)."""
    z = np.full((40, 40), 5.0, np.float32)
    z[27:32, 8:13] = np.nan
    return scene.add_terrain(write_raster(tmp_path / "ground.tif", z), name="ground", pixel_size=1.0)


def test_sites_without_ground(scene, ground, refused):
    good = ground.site(20.0, 20.0, 1.0)
    with refused(dspace.InvalidArgument, "the start of line 0, site (99, 20) of terrain 'ground': it is off the terrain's "
                 "data; accepted: map x 0.5 to 39.5, y 0.5 to 39.5"):
        scene.line_of_sight(ground.site(99.0, 20.0), good)
    with refused(dspace.InvalidArgument, "the end of line 1, site (10, 10) of terrain 'ground': the terrain has no data "
                 "there"):
        scene.line_of_sight(good, ground.site([30.0, 10.0], 10.0, 1.0))
    with refused(dspace.InvalidArgument, "the place, site (10, 10)"):
        scene.horizon(ground.site(10.0, 10.0))
    with refused(dspace.InvalidArgument, "its height above the ground is -1; accepted: 0 to 1e12 m"):
        scene.horizon(ground.site(20.0, 20.0, -1.0))
    with refused(dspace.InvalidArgument, "its height above the ground is nan"):
        scene.line_of_sight(good, ground.site(21.0, 20.0, np.nan))


def test_places_below_the_ground(scene, ground, refused):
    below = ground.from_map([[15.0, 20.0, 2.5]])[0]
    with refused(dspace.InvalidArgument, "it is 2.5 m below the ground of terrain 'ground'; accepted: places on or above"):
        scene.line_of_sight(ground.site(20.0, 20.0, 1.0), below)
    with refused(dspace.InvalidArgument, "the place, "):
        scene.horizon(below)
    assert scene.line_of_sight(ground.site(20.0, 20.0, 1.0), below, terrain=False).clear


def test_points_that_are_the_same(scene, ground, refused):
    with refused(dspace.InvalidArgument, "line 1: its start and its end are the same point, ("):
        scene.line_of_sight(ground.site([20.0, 21.0], 20.0, 1.0), ground.site(21.0, 20.0, 1.0))


@pytest.mark.parametrize("change, kind, text", [
    ({"wavelength": 0.0}, dspace.InvalidArgument, "wavelength is 0; accepted: 1e-09 to 1000000000"),
    ({"wavelength": "x"}, dspace.WrongType, "line of sight: wavelength is 'x'"),
    ({"deadline": 0.0}, dspace.InvalidArgument, "deadline_s is 0; accepted: 0.001 on"),
    ({"hide": ["nowhere"]}, dspace.NotFound, "nowhere"),
    ({"without": ["nothing"]}, dspace.NotFound, "nothing"),
    ({"without": [3]}, dspace.WrongType, "the object is 3; accepted: a dspace.GraphicsObject or its name"),
    ({"terrain": None}, dspace.WrongType, "terrain is None; accepted: True or False"),
    ({"method": "guess"}, dspace.InvalidArgument, "the method is 'guess'; accepted: 'exact', 'image', 'both'"),
    ({"end": (1.0, 2.0)}, dspace.InvalidArgument, "the end has the shape (2,); accepted: a Site, a Frame, a path, or an "
     "array (..., 3) of points [m]"),
    ({"end": np.zeros((0, 3))}, dspace.InvalidArgument, "the number of lines is 0; accepted: 1 to 1000000"),
    ({"end": (np.nan, 0.0, 9.0)}, dspace.InvalidArgument, "the end of line 0, (nan, 0, 9) in the root"),
    ({"end": None}, dspace.WrongType, "the end is None"),
    ({"end": "no/frame"}, dspace.NotFound, "no"),
    ({"start": np.zeros((2, 3)), "end": np.ones((3, 3))}, dspace.InvalidArgument, "the shapes (2,) and (3,); accepted: "
     "shapes that broadcast"),
])
def test_arguments(scene, refused, change, kind, text):
    with refused(kind, text):
        scene.line_of_sight(**{"start": (0.0, 0.0, 0.0), "end": (1.0, 0.0, 0.0), **change})


@pytest.mark.parametrize("change, kind, text", [
    ({"azimuths": 0}, dspace.InvalidArgument, "horizon: azimuths is 0; accepted: 1 to 1000000"),
    ({"azimuths": 1_000_001}, dspace.InvalidArgument, "azimuths is 1000001"),
    ({"azimuths": 3.5}, dspace.WrongType, "azimuths is 3.5"),
    ({"place": np.zeros((2, 3))}, dspace.InvalidArgument, "the place has the shape (2,); accepted: one place"),
])
def test_arguments_of_horizons(scene, refused, change, kind, text):
    with refused(kind, text):
        scene.horizon(**{"place": (0.0, 0.0, 0.0), **change})


def test_sites_of_shapes_that_do_not_fit_and_of_another_scene(session, scene, ground):
    with pytest.raises(dspace.InvalidArgument, match=r"x, y and height have the shapes \(2,\), \(3,\), \(\)"):
        ground.site([1, 2], [1, 2, 3])
    other = session.scene("other")
    with pytest.raises(dspace.InvalidArgument, match="terrain 'ground' is in another scene"):
        other.horizon(ground.site(20.0, 20.0))
    assert repr(ground.site(20.0, 20.0, 2.0)) == "<dspace.Site (20, 20) of terrain 'ground', 2 m above the ground>"


def test_a_deadline_ends_the_measurement(scene, ground, refused):
    start = ground.site(np.linspace(5.0, 35.0, 20000), 30.0, 1.0)
    with refused(dspace.DeadlineExceeded, "command line_of_sight: it takes longer than its deadline of 0.001 s"):
        scene.line_of_sight(start, ground.site(20.0, 20.0, 1.0), deadline=0.001)
