"""Eclipses on meshes and on terrain, pixel by pixel, against published elements and the lens of two circles."""
import math

import numpy as np
import pytest
from besselian_support import EQUATOR, MOON, SUN, left_by_elements
from command_support import write_moon

import dspace

CASPER_DEG, CASPER_HEIGHT = (-106.325, 42.85), 1560.0
MOON_RADIUS, SUN_RADIUS, EARTH_FLATTENING = 1737400.0, 6.957e8, 1 / 298.257223563


def needs_de405(scene):
    if "DE405" not in str(scene.ephemeris("moon", "earth", scene.time).sources):
        pytest.skip("casacore-data-jpl-de405 is not installed: ERFA's Moon is 32 km off")


def lens(sun, body, between):
    """The part of a disc that another leaves, by their angular radii and the angle between their centres."""
    if between >= sun + body:
        return 1.0
    if between <= body - sun:
        return 0.0
    a = math.acos((between ** 2 + sun ** 2 - body ** 2) / (2 * between * sun))
    b = math.acos((between ** 2 + body ** 2 - sun ** 2) / (2 * between * body))
    hidden = a - 0.5 * math.sin(2 * a) + (body / sun) ** 2 * (b - 0.5 * math.sin(2 * b))
    return 1.0 - hidden / math.pi


def test_a_mesh_has_the_light_that_the_moon_leaves(scene):
    """2017 August 21 at Casper, by the Besselian elements: through totality and out of it."""
    start = scene.time = scene.tdb("2017-08-21T18:00:00 TT")
    needs_de405(scene)
    fixed = dict(center="earth", center_axes="ITRF93")
    scene.add_body("earth", atmosphere=False, **fixed)
    scene.add_body("moon", radii=MOON, correction="LT", **fixed)
    scene.add_body("sun", radii=SUN, correction="LT", **fixed)
    longitude, latitude = np.radians(CASPER_DEG)
    up = np.array([math.cos(latitude) * math.cos(longitude), math.cos(latitude) * math.sin(longitude), math.sin(latitude)])
    e2 = EARTH_FLATTENING * (2 - EARTH_FLATTENING)
    n = EQUATOR / math.sqrt(1 - e2 * math.sin(latitude) ** 2)
    place = up * (n + CASPER_HEIGHT) - np.array([0, 0, e2 * n * math.sin(latitude)])
    scene.add_sphere(1.0, position=tuple(place + 3 * up))
    scene.add_camera(eye=tuple(place + 30 * up), target=tuple(place), up=(0, 0, 1), fov_deg=2)
    view = scene.add_viewport((32, 32), samples=1)
    view.set(fill=0.0)
    full = None
    for hours in (1.5, -1.0, -0.5, -0.25, -0.2, 0.1, 0.5):
        scene.time = start + 3600 * hours
        left = left_by_elements(place, hours)
        lit = view.lit_fraction()
        np.testing.assert_allclose(lit, left, atol=2e-3)
        light = view.radiance()[16, 16, 1] / math.cos(math.radians(view.incidence()[16, 16]))
        full = full or light
        assert light == pytest.approx(full * left, abs=3e-3 * full)
    assert full > 100


def test_terrain_has_the_light_that_the_earth_leaves(scene, tmp_path):
    """2022 November 8 at the middle of the Moon's near side: the Earth's shadow comes and goes."""
    raster = write_moon(tmp_path / "moon.tif", 1000.0 * np.ones((90, 180), np.float32), -180, 90, 2.0)
    start = scene.time = scene.tdb("2022-11-08T08:00:00 TT")
    needs_de405(scene)
    centered = dict(center="moon", center_axes="J2000")
    with pytest.warns(dspace.DspaceWarning):
        scene.add_body("moon", terrain=str(raster), **centered)
    scene.add_body("earth", atmosphere=False, correction="LT", **centered)
    scene.add_body("sun", correction="LT", **centered)
    camera = scene.add_camera("c", eye=(2e6, 0, 0), target=(0, 0, 0), up=(0, 0, 1), fov_deg=2)
    view = scene.add_viewport((32, 32), "c")
    seen = []
    for minutes in (1, 40, 60, 75, 120, 180, 240, 280, 350):
        scene.time = start + 60 * minutes
        earth, sun = (scene.ephemeris(body, "moon", scene.time, axes="J2000", correction="LT").position.ravel()
                      for body in ("earth", "sun"))
        up = earth / np.linalg.norm(earth)
        camera.look_at(eye=tuple(up * (MOON_RADIUS + 2e4)), target=(0, 0, 0))
        place = up * (MOON_RADIUS + 1000.0)
        earth, sun = earth - place, sun - place
        # The Earth's limb towards the Sun: its radius there, to the square of the flattening.
        aside = sun - earth * (sun @ earth) / (earth @ earth)
        radius = EQUATOR * (1 - EARTH_FLATTENING * (aside[2] / np.linalg.norm(aside)) ** 2)
        between = math.atan2(np.linalg.norm(np.cross(sun, earth)), sun @ earth)
        left = lens(math.asin(SUN_RADIUS / np.linalg.norm(sun)), math.asin(radius / np.linalg.norm(earth)), between)
        lit = view.lit_fraction()
        assert lit[15:17, 15:17].mean() == pytest.approx(left, abs=1e-3)
        seen.append(left)
    assert seen[0] == seen[-1] == 1.0 and seen[5] == 0.0 and 0.2 < seen[3] < 0.6


def test_power_falls_while_the_earth_stands_before_the_sun(scene):
    """2022 November 8, at 5 degrees east and 3 south on the Moon."""
    start = scene.time = scene.tdb("2022-11-08T08:00:00 TT")
    needs_de405(scene)
    panel = dspace.Panel(2.0, 0.3, tracking="full")
    profile = scene.power_profile(dspace.BodySite("moon", 5.0, -3.0), panel, start, start + 6.5 * 3600, step=600.0)
    longitude, latitude = math.radians(5.0), math.radians(-3.0)
    level = math.cos(latitude)
    place = MOON_RADIUS * np.array([level * math.cos(longitude), level * math.sin(longitude), math.sin(latitude)])
    lefts = []
    for time, lit, power in zip(profile.time, profile.lit, profile.power):
        earth, sun = (scene.ephemeris(body, "moon", time, axes="MOON_ME", correction="LT").position.ravel() - place
                      for body in ("earth", "sun"))
        between = math.atan2(np.linalg.norm(np.cross(sun, earth)), sun @ earth)
        left = lens(math.asin(SUN_RADIUS / np.linalg.norm(sun)), math.asin(EQUATOR / np.linalg.norm(earth)), between)
        assert lit == pytest.approx(left, abs=2e-3)
        assert power == pytest.approx(2.0 * 0.3 * 1361.0 * lit * (149597870700.0 / np.linalg.norm(sun)) ** 2, rel=1e-4, abs=1e-9)
        lefts.append(left)
    assert max(lefts) == 1.0 and lefts.count(0.0) >= 5 and profile.longest_night == 0.0  # an eclipse is no night


def test_maps_and_the_sky_have_the_eclipse_of_each_cell(scene, tmp_path):
    """2022 November 8 over 60 by 40 degrees of the Moon: the limb of the Earth crosses the cells one after the other."""
    path = write_moon(tmp_path / "moon.tif", np.zeros((16, 24), np.float32), -30, 20, 2.5)
    start = scene.time = scene.tdb("2022-11-08T08:00:00 TT")
    needs_de405(scene)
    terrain = scene.add_terrain(path, name="ground", on_body=True)
    horizons = scene.horizon_map(terrain, tmp_path / "horizons.tif", azimuths=4)
    parts = []
    for minutes in (1, 70, 75, 80, 120):
        time = start + 60.0 * minutes
        made, whole = (scene.illumination_map(horizons, tmp_path / f"{minutes}{eclipses}.tif", start=time, end=time + 1.0, step=60.0,
                                              quantities=("lit_fraction", "longest_night", "permanent_shadow"), eclipses=eclipses)
                       for eclipses in (True, False))
        assert (whole.read("lit_fraction") == 1.0).all()
        assert (made.read("longest_night") == 0.0).all() and (made.read("permanent_shadow") == 0.0).all()
        earth, sun = (scene.ephemeris(body, "moon", time, axes="MOON_ME", correction="LT").position.ravel() for body in ("earth", "sun"))
        x0, dx, _, y0, _, dy = made.geotransform
        lit = made.read("lit_fraction")
        for row in range(0, made.rows, 3):
            for column in range(0, made.columns, 3):
                longitude, latitude = x0 + dx * (column + 0.5), y0 + dy * (row + 0.5)
                level = math.cos(math.radians(latitude))
                place = MOON_RADIUS * np.array([level * math.cos(math.radians(longitude)), level * math.sin(math.radians(longitude)),
                                                math.sin(math.radians(latitude))])
                to_earth, to_sun = earth - place, sun - place
                between = math.atan2(np.linalg.norm(np.cross(to_sun, to_earth)), to_sun @ to_earth)
                left = lens(math.asin(SUN_RADIUS / np.linalg.norm(to_sun)), math.asin(EQUATOR / np.linalg.norm(to_earth)), between)
                assert lit[row, column] == pytest.approx(left, abs=2e-3)
                parts.append(left)
        x, y = x0 + dx * (made.columns // 2 + 0.5), y0 + dy * (made.rows // 2 + 0.5)
        sky = terrain.sky(x, y, "sun", time=time)["sun"]
        assert sky.lit_fraction == pytest.approx(float(lit[made.rows // 2, made.columns // 2]), abs=1e-4)
    parts = np.array(parts)
    assert parts.min() == 0.0 and parts.max() == 1.0 and ((parts > 0.05) & (parts < 0.95)).sum() > 20


# NASA's table for 2017 August 21, as newspapers printed it: contacts 1 to 4 in local time, minutes without their seconds, and hours
# from UTC to it. The longitude (east) and latitude are those of the town.
TOWNS = {"Madras": (-121.13, 44.63, -7, "09:06", "10:19", "10:21", "11:41"),
         "Idaho Falls": (-112.03, 43.49, -6, "10:15", "11:33", "11:34", "12:58"),
         "Casper": (-106.31, 42.85, -6, "10:22", "11:42", "11:45", "13:09"),
         "Lincoln": (-96.68, 40.81, -5, "11:37", "13:02", "13:04", "14:29"),
         "Jefferson City": (-92.17, 38.58, -5, "11:46", "13:13", "13:15", "14:41"),
         "Carbondale": (-89.22, 37.73, -5, "11:52", "13:20", "13:22", "14:47"),
         "Paducah": (-88.60, 37.08, -5, "11:54", "13:22", "13:24", "14:49"),
         "Nashville": (-86.78, 36.16, -5, "11:58", "13:27", "13:29", "14:54")}


@pytest.mark.parametrize("town", TOWNS)
def test_contacts_in_the_sky_are_those_of_the_table(scene, town):
    """Each contact is within the minute of the table, with 20 s about it for the place in the town, the Moon's radius and UT1."""
    longitude, latitude, zone, *contacts = TOWNS[town]
    scene.time = scene.tdb("2017-08-21T18:00:00")
    needs_de405(scene)
    def left(contact, seconds):
        hour, minute = (int(each) for each in contact.split(":"))
        time = scene.tdb(f"2017-08-21T{hour - zone:02}:{minute:02}:00") + seconds
        return scene.sky("sun", body="earth", site=(longitude, latitude, 0.0), geodetic=True, time=time)["sun"].lit_fraction

    first, second, third, fourth = contacts
    assert left(first, -20) == 1.0 and 0.9 < left(first, 80) < 1.0
    assert 0.0 < left(second, -20) < 0.1 and left(second, 80) == 0.0
    assert left(third, -20) == 0.0 and 0.0 < left(third, 80) < 0.1
    assert 0.9 < left(fourth, -20) < 1.0 and left(fourth, 80) == 1.0
