"""Curiosity's descent: the path of msl-edl.xyzv, what was flown, and where both end.

The .xyzv's header names predicted trajectories (od008 to od167 of the cruise). It ends 2.24 km west of where Curiosity landed,
on the middle of the landing ellipse (NASA: "2.4 km from the centre"). The flown path from the entry interface to the parachute
shows where that difference arises: both are within 250 m until 55 s after the interface, and within 1.2 km across when the
parachute opens. The rest, of the parachute and the powered descent, is the wind's and the file's.

Vertical datum: positions are from Mars's centre. The path ends at a radius of 3,391,150 m, 5,040 m below the sphere of 3,396,190 m
to which MOLA's grids refer; MOLA has the site 4,503 m below the areoid."""
import math
import os
import pathlib

import numpy as np
import pytest

import dspace

DATA = pathlib.Path(os.environ.get("DSPACE_DATA", "/nonexistent")) / "ephemeris"
PATH, FLOWN = DATA / "msl-edl.xyzv", DATA / "msl_edl_entry_to_chute_position_J2000.csv"
CONSTANTS = DATA / "spice_test_kernels/pck00010.tpc"  # by which the .xyzv's IAU_MARS turns, as its header says
ENTRY, LANDING = "2012-08-06T05:10:46", (137.4417, -4.5895)  # sky_checks.json


def across(place, other):
    """The distance across the vertical of a place [m]."""
    up = place / np.linalg.norm(place, axis=-1, keepdims=True)
    way = other - place
    return np.linalg.norm(way - (way * up).sum(axis=-1, keepdims=True) * up, axis=-1)


def test_the_descent_leaves_the_flown_one_under_the_parachute():
    for path in (PATH, FLOWN, CONSTANTS):
        if not path.exists():
            pytest.skip(f"real data absent: set DSPACE_DATA to the folder that has ephemeris/{path.name}")
    flown = np.loadtxt(FLOWN, delimiter=",", skiprows=1)[::20]  # each second
    with dspace.Session() as session:
        scene = session.scene()
        scene.kernels.load(CONSTANTS)
        planned = scene.add_trajectory(PATH)
        _, end = planned.span
        early = flown[:, 0] < 55.0
        found = []
        for shift in np.arange(-0.5, 0.5, 0.02):  # [s]: the interface is known to the second, in which it moves 5.8 km
            times = scene.tdb(ENTRY) + shift + flown[:, 0]
            fixed = np.einsum("tij,tj->ti", scene.reference_frames.rotation("J2000", "IAU_MARS", times), flown[:, 1:])
            found.append(across(np.asarray(planned.states(times)[0]), fixed))
        last, speed = planned.states(end)
    apart = min(found, key=lambda each: each[early].max())
    assert apart[early].max() < 250.0
    assert apart.max() < 2000.0
    assert apart[-1] < 1200.0 and flown[-1, 0] > 250.0
    last = np.asarray(last)
    assert np.linalg.norm(last) == pytest.approx(3391150.0, abs=5.0) and np.linalg.norm(speed) < 1e-3
    longitude, latitude = np.radians(LANDING)
    landed = np.linalg.norm(last) * np.array([math.cos(latitude) * math.cos(longitude), math.cos(latitude) * math.sin(longitude),
                                              math.sin(latitude)])
    assert across(last, landed) == pytest.approx(2240.0, abs=100.0)
