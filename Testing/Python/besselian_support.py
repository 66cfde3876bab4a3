"""The eclipse of 2017 August 21 by its Besselian elements: F. Espenak (NASA), ../shared's sky_checks.json has them, too."""
import math

import numpy as np

EQUATOR, POLE = 6378137.0, 6356752.3142
MOON, SUN = 0.272281 * EQUATOR, 696000e3  # k2 of the elements, and their Sun
DELTA_T = 69.184  # [s] by which ITRF93 turns the Earth where UTC stands for UT1
# Lengths in radii of the equator; t [h] from 18h TDT.
X, Y = (-0.129571, 0.5406426, -2.94e-05, -8.1e-06), (0.485416, -0.14164, -9.05e-05, 2e-06)
D, MU = (11.8669596, -0.013622, -2e-06), (89.24543, 15.00394)
L1, TAN_F1 = (0.542093, 0.0001241, -1.18e-05), 0.0046222
L2, TAN_F2 = (-0.004025, 0.0001234, -1.17e-05), 0.0045992


def power(c, t):
    return sum(each * t ** i for i, each in enumerate(c))


def axes_of_elements(t):
    """Bessel's axes (rows: x east, y north, z to the Sun) in those of the Earth."""
    d = math.radians(power(D, t))
    # East longitude of the axis: minus its hour angle at Greenwich, which the elements have for delta-T = 0.
    a = -math.radians(power(MU, t) - 0.00417807 * DELTA_T)
    z = np.array([math.cos(d) * math.cos(a), math.cos(d) * math.sin(a), math.sin(d)])
    x = np.array([-math.sin(a), math.cos(a), 0.0])
    return np.array([x, np.cross(z, x), z])


def left_by_elements(place, t):
    """The part of the Sun's disc that is seen from a place, earth-fixed [m]: local circumstances (Explanatory Supplement 1992, 8.3),
    and the lens of two circles."""
    xi, eta, zeta = axes_of_elements(t) @ place / EQUATOR
    m = math.hypot(power(X, t) - xi, power(Y, t) - eta)
    penumbra, umbra = power(L1, t) - zeta * TAN_F1, power(L2, t) - zeta * TAN_F2
    if m >= penumbra:
        return 1.0
    if m <= -umbra:
        return 0.0
    moon = (penumbra - umbra) / (penumbra + umbra)  # its radius in those of the Sun
    d = 1.0 + moon - 2.0 * (penumbra - m) / (penumbra + umbra)
    sun_half = math.acos(max(-1.0, min(1.0, (d * d + 1.0 - moon * moon) / (2.0 * d))))
    moon_half = math.acos(max(-1.0, min(1.0, (d * d + moon * moon - 1.0) / (2.0 * d * moon))))
    lens = (sun_half - 0.5 * math.sin(2.0 * sun_half)) + moon * moon * (moon_half - 0.5 * math.sin(2.0 * moon_half))
    return 1.0 - lens / math.pi
