"""The Moon as Orion's navigation camera photographed it (art001e000403), from the flown trajectory.

Facts of the photograph: the name that its metadata keep, cmaopnav_20221122032830, has the time; 2592 x 2048 pixels. From the
trajectory the Moon's limb then has a radius of 2.820 degrees. Measured in the photograph: the limb's centre and radius, hence
the focal length (20.3 by 16.1 degrees: a lens of 35 mm over pixels of 4.8 um has 20.2), and the direction of the light, hence
the roll. The face of the Moon, the phase and their sizes are then Dspace's."""
import math
import os
import pathlib

import numpy as np
import pytest
from needs import needs_module

import dspace
from dspace.frames.poses import quaternion_of_matrix

DATA = pathlib.Path(os.environ.get("DSPACE_DATA", "/nonexistent"))
PHOTO = DATA / "ephemeris/artemis1_art001e000403_photo.jpg"
OEM = DATA / "ephemeris/artemis1_orion_asflown_20221213_OEM.asc"
TEXTURE = DATA / "textures/moon_lroc_color_poles_2k.tif"
UTC = "2022-11-22T03:28:30"
WIDTH, HEIGHT = 2592, 2048
MOON = 1737.4e3


def photograph():
    """In linear light, 0 to 1."""
    from osgeo import gdal
    grey = gdal.Open(str(PHOTO)).ReadAsArray().astype(float)
    return (grey.mean(axis=0) if grey.ndim == 3 else grey) / 255.0


def limb(grey):
    """Centre and radius of the bright limb, by least squares from the last bright pixel of each fourth row."""
    rows = [row for row in range(0, HEIGHT, 4) if (grey[row] > 0.35).any()]
    places = np.array([(np.flatnonzero(grey[row] > 0.35)[-1], row) for row in rows], float)
    for _ in range(10):
        x, y, c = np.linalg.lstsq(np.column_stack([2 * places, np.ones(len(places))]), (places ** 2).sum(axis=1), rcond=None)[0]
        radius = math.sqrt(c + x * x + y * y)
        rest = np.hypot(*(places - (x, y)).T) - radius
        places = places[np.abs(rest) < max(2 * rest.std(), 1.0)]
    assert len(places) > 100 and rest.std() < 1.0
    return x, y, radius


def axes(first, second):
    """Orthonormal columns: along the first vector, across both, and across these."""
    x = first / np.linalg.norm(first)
    y = np.cross(x, second)
    y /= np.linalg.norm(y)
    return np.stack([x, y, np.cross(x, y)], 1)


def drawn(utc, x, y, radius, roll):
    """What the camera sees in green radiance, of the photograph's size."""
    with dspace.Session() as session:
        scene = session.scene()
        scene.time = scene.tdb(utc)
        orion = scene.add_trajectory(OEM, visible=False)
        craft = np.array(orion.states(scene.time)[0])
        moon, sun = (scene.ephemeris(body, "earth", scene.time).position for body in ("moon", "sun"))
        way = moon - craft
        angle = math.asin(MOON / np.linalg.norm(way))
        focal = radius / math.tan(angle)
        scene.add_body("moon", center="moon", texture=TEXTURE, albedo=0.12)
        scene.sun.set(direction=tuple(sun - moon))
        place = np.array([(x - WIDTH / 2 + 0.5) / focal, (y - HEIGHT / 2 + 0.5) / focal, 1.0])
        turn = axes(way, sun - moon) @ axes(place, np.array([math.cos(roll), math.sin(roll), 0.0])).T
        pose = dspace.Pose(position=tuple(-way), quaternion=tuple(quaternion_of_matrix(turn)))
        camera = scene.add_camera(pose=pose, fov_deg=2 * math.degrees(math.atan(HEIGHT / 2 / focal)))
        view = scene.add_viewport((WIDTH, HEIGHT), camera, samples=1)
        view.set(fill=0.0)
        return view.radiance()[:, :, 1].astype(float), math.degrees(angle), focal


def likeness(photo, picture):
    """The correlation of square roots of light, where one of both is lit."""
    lit = (photo > 0.01) | (picture > 0.01 * picture.max())
    return np.corrcoef(np.sqrt(photo[lit]), np.sqrt(picture[lit]))[0, 1]


def test_the_moon_is_as_in_the_flight_photograph():
    for path in (PHOTO, OEM, TEXTURE):
        if not path.exists():
            pytest.skip(f"real data absent: set DSPACE_DATA to the folder that has {path.name}")
    needs_module("osgeo.gdal", "python3-gdal")
    grey = photograph()
    x, y, radius = limb(grey)
    rows, columns = np.nonzero(grey > 0.35)
    light = grey[rows, columns]
    roll = math.atan2((light * rows).sum() / light.sum() - y, (light * columns).sum() / light.sum() - x)
    photo = grey ** 2.2
    picture, angle, focal = drawn(UTC, x, y, radius, roll)
    assert angle == pytest.approx(2.820, abs=0.005)
    assert 2 * math.degrees(math.atan(WIDTH / 2 / focal)) == pytest.approx(20.2, abs=0.2)
    found = likeness(photo, picture)
    assert found > 0.92, found
    # The same lens and roll six hours before, from where Orion then was: another face at another phase.
    assert likeness(photo, drawn("2022-11-21T21:28:30", x, y, radius, roll)[0]) < found - 0.03
    # Limb to limb: the lit area's box, within 4 pixels on the side of the limb.
    seen, shown = photo > 0.05, picture > 0.05 * np.quantile(picture[picture > 0], 0.99)
    for axis, side in ((0, -1), (1, 0)):  # right and top
        edges = [np.flatnonzero(each.any(axis=axis))[side] for each in (seen, shown)]
        assert abs(edges[0] - edges[1]) < 4, edges
