"""The detail of the shipped field: as its generator makes it, of the stated laws, and driven on by the demo."""
import json
import sys
from pathlib import Path

import numpy as np
import pytest

from needs import needs_module

ROOT = Path(__file__).resolve().parents[3]
FIELD = ROOT / "Data" / "field"
sys.path[:0] = [str(ROOT / "Data" / "generators"), str(ROOT / "Examples" / "rover_drive")]

import make_field  # noqa: E402
import make_site  # noqa: E402
from make_site import Hills, Site  # noqa: E402

gdal = needs_module("osgeo.gdal", "python3-gdal")


@pytest.fixture(scope="module")
def field_heights():
    return gdal.Open(str(FIELD / "field.tif")).ReadAsArray()


@pytest.fixture(scope="module")
def heights():
    data = gdal.Open(str(FIELD / "site.tif"))
    assert data.GetRasterBand(1).GetScale() == Site.quantum
    return data.ReadAsArray() * Site.quantum


@pytest.fixture(scope="module")
def rocks():
    return np.load(FIELD / "rocks.npy").astype(float)


def at(heights, x, y):
    """The nearest post's height."""
    return heights[np.round((Site.north - y) / Site.spacing).astype(int), np.round((x - Site.west) / Site.spacing).astype(int)]


def within(rows):
    return (rows[:, 0] > Site.west) & (rows[:, 0] < Site.east) & (rows[:, 1] > Site.south) & (rows[:, 1] < Site.north)


# --- files ---------------------------------------------------------------------------------------

def test_the_site_is_as_generated(field_heights, heights, rocks):
    line = make_site.route_line(make_site.way_points(FIELD))
    counts, made = make_site.site(field_heights, line)
    off = np.abs(counts - heights / Site.quantum)
    assert off.max() <= 1 and (off > 0).mean() < 1e-4  # rounding of the FFT may move a height by one step
    assert np.abs(made - rocks).max() <= 1.1e-3  # and a rock's ground by a millimetre
    colors = gdal.Open(str(FIELD / "site_color.tif")).ReadAsArray()
    assert (colors != make_site.colours(counts * Site.quantum, field_heights, line)).mean() < 1e-3
    hills = gdal.Open(str(FIELD / "hills.tif")).ReadAsArray().astype(int)
    assert np.abs(hills - make_site.hills()).max() <= 1
    assert sum(path.stat().st_size for path in FIELD.iterdir()) < 4_000_000


def test_other_seeds_make_other_ground():
    other = type("Other", (Site,), {"seed": Site.seed + 1})
    assert len(make_site.site_craters(other)) != len(make_site.site_craters())
    assert np.abs(make_site.fine_relief(other) - make_site.fine_relief()).max() > 0.003


def test_places_are_those_of_the_field(field_heights, heights):
    for name, spacing, west, north in (("site.tif", Site.spacing, Site.west, Site.north),
                                       ("hills.tif", Hills.spacing, -1024.0, 1024.0)):
        data = gdal.Open(str(FIELD / name))
        assert np.allclose(data.GetGeoTransform(),
                           (west - spacing / 2, spacing, 0, north + spacing / 2, 0, -spacing), atol=1e-9)
        assert data.GetSpatialRef().IsSame(gdal.Open(str(FIELD / "field.tif")).GetSpatialRef())
        assert data.GetMetadataItem("VERTICAL_DATUM") == "sphere:1737400"
    # The site is the field's ground with detail: where posts of both are, they differ by decimetres at most, and on
    # average by millimetres.
    x, y = (np.arange(low, high, 0.2) for low, high in ((-30.0, 30.0), (-20.0, 22.0)))
    x, y = np.meshgrid(x, y)
    of_field = field_heights[np.round((100 - y) / 0.2).astype(int), np.round((x + 100) / 0.2).astype(int)]
    off = at(heights, x, y) - of_field
    assert abs(off.mean()) < 0.005 and np.percentile(np.abs(off), 99) < 0.1


# --- size-frequency distributions ----------------------------------------------------------------

def expected_rocks(low, high):
    """Golombek and Rapp (1997): rocks of diameter >= D cover k exp(-q D) of the ground, q = 1.79 + 0.152 / k. A square
    metre's rocks between two diameters, by sums over narrow classes of the area covered over the area of a rock."""
    k = 0.03
    q = 1.79 + 0.152 / k
    edges = np.linspace(low, high, 20001)
    covered = k * (np.exp(-q * edges[:-1]) - np.exp(-q * edges[1:]))
    middle = 0.5 * (edges[:-1] + edges[1:])
    return (covered / (np.pi * middle ** 2 / 4)).sum()


@pytest.mark.parametrize("low, high", [(0.05, 0.07), (0.07, 0.1), (0.1, 0.15), (0.15, 0.2), (0.2, 0.3), (0.3, 0.5),
                                       (0.5, 1.2)])
def test_rocks_of_each_size_are_as_many_as_stated(rocks, low, high):
    inside = within(rocks)
    area = (Site.east - Site.west) * (Site.north - Site.south)
    classes = [(inside, area)]
    if low >= Site.rock_smallest_around:
        classes.append((~inside, 200.0 ** 2 - area))
    for where, ground in classes:
        expected = expected_rocks(low, high) * ground
        count = ((rocks[:, 3] >= low) & (rocks[:, 3] < high) & where).sum()
        assert abs(count - expected) < 3 * np.sqrt(expected), (count, expected)


def test_rocks_cover_the_stated_share_of_the_ground(rocks):
    here = rocks[within(rocks)]
    q = 1.79 + 0.152 / 0.03
    share = lambda d: 0.03 * (np.exp(-q * d) - np.exp(-q * 1.2))
    area = (Site.east - Site.west) * (Site.north - Site.south)
    for least in (0.05, 0.1, 0.2):
        some = here[here[:, 3] >= least, 3]
        covered = (np.pi * some ** 2 / 4).sum() / area
        error = np.sqrt(((np.pi * some ** 2 / 4) ** 2).sum()) / area  # of a Poisson process
        assert abs(covered - share(least)) < 3 * error


def test_the_heights_hold_every_rock_from_a_decimetre_on(heights, rocks):
    here = rocks[within(rocks) & (rocks[:, 3] >= 0.15)]
    assert len(here) > 500
    x, y, ground, diameter, height = here[:, :5].T
    post = np.hypot(np.round(x / 0.05) * 0.05 - x, np.round(y / 0.05) * 0.05 - y)
    top = ground + height * np.sqrt(1 - (2 * post / diameter) ** 2)
    assert (at(heights, x, y) - top).min() > -0.003  # where rocks touch, the higher one shows
    assert np.median(np.abs(at(heights, x, y) - top)) < 0.001


def test_small_craters_follow_the_law_of_the_fields(heights):
    craters = make_site.site_craters()
    inside = within(craters)
    area = (Site.east - Site.west) * (Site.north - Site.south)
    for low, high in ((0.2, 0.25), (0.25, 0.35), (0.35, 0.5), (0.5, 0.8)):
        expected = 0.060 * (low ** -2.0 - high ** -2.0) * area
        count = (inside & (craters[:, 2] >= low) & (craters[:, 2] < high)).sum()
        assert abs(count - expected) < 3 * np.sqrt(expected)
    # The shipped heights have them: fresh ones are lower in the middle than on their rims by at least a third of a
    # fresh crater's depth of a fifth of the diameter, but where rocks or other craters lie in them.
    young = craters[inside & (craters[:, 2] > 0.4) & (craters[:, 3] < 0.03)]
    young = young[(np.abs(young[:, 0]) < 32) & (young[:, 1] > -22) & (young[:, 1] < 24)]
    assert len(young) > 50
    turn = np.linspace(0, 2 * np.pi, 16, endpoint=False)
    x, y, radius = young[:, 0, None], young[:, 1, None], 0.5 * young[:, 2, None]
    rim = at(heights, x + radius * np.cos(turn), y + radius * np.sin(turn)).mean(axis=1)
    assert (rim - at(heights, young[:, 0], young[:, 1]) > 0.33 * 0.2 * young[:, 2]).mean() > 0.9


# --- the demo's drive ----------------------------------------------------------------------------

@pytest.fixture(scope="module")
def drive():
    import dspace
    from dspace.rover import Path as Route, load_vehicle
    from dspace.shipped.field import add_field, floor_of_ruts
    with dspace.Session() as session:
        terrain = add_field(session.scene(), FIELD)
        way = Route(json.loads((FIELD / "route.json").read_text())["way_points_m"], speed=1.5, ramp=1.0)
        vehicle = load_vehicle(ROOT / "Data" / "rover" / "rover.urdf")
        line = np.column_stack(way.sample(np.linspace(0, way.length, 400))[:2])
        states = vehicle.drive(way, np.arange(0.0, 20.0, 1 / 15), floor_of_ruts(terrain, line, 4.0))
        yield terrain, vehicle, states, line


def test_no_rock_lies_in_the_lane(drive, rocks):
    line = drive[3]
    off = make_site.distance_to(line, rocks[:, :2]) - rocks[:, 3] / 2
    assert off.min() > Site.lane - 0.1  # the generator's curve is within a decimetre of the path


def test_wheels_stand_in_their_ruts_to_a_centimetre(drive):
    from dspace.shipped.field import SINKAGE, TREAD, roll
    terrain, vehicle, states, _ = drive
    terrain.clear_tracks()
    worst = 0.0
    for number, state in enumerate(states):
        roll(terrain, vehicle, [state])
        if number % 10 == 0:
            contacts = np.array(list(state.contacts.values()))
            x, y, z = contacts.T
            worst = max(worst, np.abs(z - terrain.height(x, y)).max())
            assert np.abs(z - terrain.undisturbed.height(x, y) + SINKAGE).max() < 0.01
    assert worst < 0.01
    assert max(state.residual for state in states) < 0.005 and not any(state.beyond_limits for state in states)
    # The ruts stay: on the way of the middle wheels, seconds ago, and not two metres beside it.
    for state in states[60:150:15]:
        for name in ("wheel_middle_left", "wheel_middle_right"):
            x, y = state.wheel_centers[name][:2]
            depth = terrain.undisturbed.height(x, y) - terrain.height(x, y)
            assert SINKAGE - 1e-3 < depth < SINKAGE + TREAD + 1e-3
        heading = np.radians(state.heading_deg)
        x, y = np.array(state.position[:2]) + 2.0 * np.array((-np.sin(heading), np.cos(heading)))
        assert terrain.undisturbed.height(x, y) == terrain.height(x, y)
