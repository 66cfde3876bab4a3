"""The umbra of 2017 August 21 on the drawn Earth, pixel by pixel, against its Besselian elements and our own cones."""
import math

import numpy as np
import pytest

import dspace
from besselian_support import EQUATOR, L2, MOON, POLE, SUN, TAN_F2, X, Y, axes_of_elements, power

PIXEL, SIZE = 3000.0, 241  # [m] across the camera's axis


def dark_by_elements(ground, t):
    """Where the umbra is, of points (n, 3)."""
    xi, eta, zeta = axes_of_elements(t) @ ground.T / EQUATOR
    return np.hypot(power(X, t) - xi, power(Y, t) - eta) < zeta * TAN_F2 - power(L2, t)


def dark_by_cone(ground, sun, moon):
    """The same by the cone about the Sun and the Moon: the angle between their centres, and their radii."""
    to_sun, to_moon = sun - ground, moon - ground
    away, near = np.linalg.norm(to_sun, axis=1), np.linalg.norm(to_moon, axis=1)
    between = np.arctan2(np.linalg.norm(np.cross(to_sun, to_moon), axis=1), (to_sun * to_moon).sum(axis=1))
    return between < np.arcsin(MOON / near) - np.arcsin(SUN / away)


def ground_of(eye, ahead, up):
    """The ellipsoid's points (SIZE, SIZE, 3) that the pixels of a parallel camera see."""
    right = np.cross(ahead, up)
    right /= np.linalg.norm(right)
    down = np.cross(ahead, right)
    at = (np.arange(SIZE) - (SIZE - 1) / 2) * PIXEL
    origin = eye + at[None, :, None] * right + at[:, None, None] * down
    radii = np.array([EQUATOR, EQUATOR, POLE])
    o, d = origin / radii, ahead / radii
    b, c = (o * d).sum(axis=2), (o * o).sum(axis=2) - 1.0
    return origin + ((-b - np.sqrt(b * b - (d @ d) * c)) / (d @ d))[:, :, None] * ahead


def middle(mask):
    rows, columns = np.nonzero(mask)
    return np.array([columns.mean(), rows.mean()])


@pytest.mark.parametrize("t", [-0.9, -0.4, 0.0, 0.4414, 0.9, 1.5])
def test_the_drawn_umbra_is_where_the_elements_have_it(t):
    with dspace.Session() as session:
        scene = session.scene()
        fixed = dict(center="earth", center_axes="ITRF93")
        scene.time = scene.tdb("2017-08-21T18:00:00 TT") + 3600.0 * t
        scene.add_body("earth", atmosphere=False, **fixed)
        scene.add_body("moon", radii=MOON, correction="LT", **fixed)
        scene.add_body("sun", radii=SUN, correction="LT", **fixed)
        sun, moon = (scene.ephemeris(body, "earth", scene.time, axes="ITRF93", correction="LT").position
                     for body in ("sun", "moon"))
        if "DE405" not in str(scene.ephemeris("moon", "earth", scene.time).sources):
            pytest.skip("casacore-data-jpl-de405 is not installed: ERFA's Moon is 32 km off")
        # About where the axis meets the ground, seen along the local vertical.
        along = (moon - sun) / np.linalg.norm(moon - sun)
        b = moon @ along
        place = moon + (-b - math.sqrt(b * b - moon @ moon + (EQUATOR - 8e3) ** 2)) * along
        up = place / np.linalg.norm(place)
        eye = place + 1e6 * up
        scene.add_camera(eye=tuple(eye), target=tuple(place), up=(0, 0, 1), height=SIZE * PIXEL)
        view = scene.add_viewport((SIZE, SIZE))
        light, lit = view.radiance()[:, :, 1], view.lit_fraction()
        ground = ground_of(eye, -up, np.array([0.0, 0.0, 1.0]))
        flat = ground.reshape(-1, 3)
        drawn = light < 1e-4 * light.max()
        elements = dark_by_elements(flat, t).reshape(SIZE, SIZE)
        cone = dark_by_cone(flat, sun, moon).reshape(SIZE, SIZE)
        assert 400 < drawn.sum() < 8000
        assert ((lit < 1e-4 * lit.max()) ^ drawn).sum() <= 0.05 * drawn.sum() and 0.0 < np.median(lit) < 1.0  # the same shadow
        assert not (drawn[0].any() or drawn[-1].any() or drawn[:, 0].any() or drawn[:, -1].any())
        assert np.linalg.norm(middle(drawn) - middle(cone)) < 0.2
        assert np.linalg.norm(middle(drawn) - middle(elements)) < 1.0
        # And its edge: pixels that differ lie along it, less than a pixel wide.
        edge = elements ^ (np.roll(elements, 1, 0) & np.roll(elements, -1, 0) & np.roll(elements, 1, 1)
                           & np.roll(elements, -1, 1) & elements)
        assert (drawn ^ cone).sum() < 0.25 * edge.sum()
        assert (drawn ^ elements).sum() < 1.0 * edge.sum()
