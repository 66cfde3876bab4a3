"""States of bodies from Python and from the command line: against python3-jplephem and python3-skyfield."""
import csv
import io
import json
import os
import pathlib
import subprocess
import sys

import numpy as np
import pytest

import dspace
import needs

DATA = pathlib.Path(os.environ.get("DSPACE_DATA", "/nonexistent")) / "ephemeris"
KERNELS = DATA / "spice_test_kernels"


def real(path):
    if not path.exists():
        pytest.skip(f"real data absent: set DSPACE_DATA to the folder that has ephemeris/{path.name}")
    return path


@pytest.fixture
def scene():
    with dspace.Session() as session:
        yield session.scene()


@pytest.mark.parametrize("name", ["spice_test_kernels/de405s_bigendian.bsp", "spice_test_kernels/mar022-1.bsp",
                                  "jup310_excerpt_2053-10-08.bsp"])
def test_every_chebyshev_segment_is_jplephems(scene, name):
    spk = needs.needs_module("jplephem.spk", "python3-jplephem")
    path = real(DATA / name)
    scene.kernels.load(path)
    random = np.random.default_rng(15)
    segments = [s for s in spk.SPK.open(str(path)).segments if s.target < 100 or s.frame == 1 or s.target > 400]
    assert segments
    for segment in segments:
        times = random.uniform(segment.start_second, segment.end_second, 400)
        # jplephem takes days in two parts: whole ones, and the rest.
        whole = np.floor(times / 86400.0)
        if segment.data_type == 2:
            position, velocity = segment.compute_and_differentiate(2451545.0 + whole, times / 86400.0 - whole)
            velocity = velocity / 86400.0
        else:
            both = segment.compute(2451545.0 + whole, times / 86400.0 - whole)
            position, velocity = both[:3], both[3:]
        axes = {1: "J2000", 4: "DE-118", 11: "DE-125"}[segment.frame]
        states = scene.ephemeris(segment.target, segment.center, times, axes=axes)
        # jplephem keeps the begin of a segment as a Julian date, whose float resolves 40 us. Those of DE405 are whole.
        late = 0.0 if "de405" in name else 4e-5
        speed, distance = 1e3 * np.linalg.norm(velocity, axis=0).max(), 1e3 * np.linalg.norm(position, axis=0).max()
        assert np.abs(states.position - 1e3 * position.T).max() <= 2e-3 + 1e-14 * distance + late * speed
        assert np.abs(states.velocity - 1e3 * velocity.T).max() <= 1e-8 + late  # accelerations are below 1 m/s^2
        assert [s.source for s in states.sources] == [f"kernel '{path}'"]


def test_apparent_positions_are_skyfields(scene):
    """Light time of the Moon, Venus and Jupiter's system: skyfield iterates in days to 1e-12."""
    api = needs.needs_module("skyfield.api", "python3-skyfield")
    path = real(KERNELS / "de405s_littleendian.bsp")
    scene.kernels.load(path)
    theirs = api.load_file(str(path))
    timescale = api.load.timescale(builtin=True)
    times = np.linspace(-9e7, 3e8, 60)
    t = timescale.tdb_jd(2451545.0 + np.floor(times / 86400.0), times / 86400.0 - np.floor(times / 86400.0))
    for target, name in (("moon", "moon"), ("venus", "venus"), ("jupiter barycenter", "jupiter barycenter")):
        seen = theirs["earth"].at(t).observe(theirs[name])
        states = scene.ephemeris(target, "earth", times, correction="CN")
        assert np.linalg.norm(states.position - seen.position.m.T, axis=1).max() < 0.01
        assert np.abs(states.light_time - seen.light_time * 86400.0).max() < 1e-10


def test_one_time_and_many_times_agree(scene):
    times = np.array([0.0, 1e6, -2e8])
    many = scene.ephemeris("mars", "earth", times, axes="ECLIPJ2000", correction="LT+S")
    assert many.position.shape == (3, 3) and many.light_time.shape == (3,)
    for i, time in enumerate(times):
        one = scene.ephemeris("mars", "earth", time, axes="ECLIPJ2000", correction="LT+S")
        assert np.array_equal(one.position, many.position[i]) and np.array_equal(one.velocity, many.velocity[i])
        assert one.light_time == many.light_time[i]
    many.position[0] = 0.0  # the caller's own


def test_which_source_won_is_said(scene):
    little, big = real(KERNELS / "de405s_littleendian.bsp"), real(KERNELS / "de405s_bigendian.bsp")
    scene.kernels.load(little)
    scene.kernels.load(big)
    source = scene.ephemeris("moon", "earth", 0.0).sources[0]
    assert source.source == f"kernel '{big}'"
    assert source.hidden[0] == f"kernel '{little}'" and source.hidden[-1] == "ERFA"


def test_bad_input(scene):
    with pytest.raises(dspace.NotFound, match="nowhere.*accepted"):
        scene.ephemeris("nowhere", "earth", 0.0)
    with pytest.raises(dspace.InvalidArgument, match="outside of what the loaded sources cover; accepted: .* UTC"):
        scene.ephemeris("moon", "earth", 1e10)
    with pytest.raises(dspace.InvalidArgument, match="NONE.*LT"):
        scene.ephemeris("moon", "earth", 0.0, correction="XLT")
    with pytest.raises(dspace.InvalidArgument):
        scene.ephemeris("moon", "earth", float("nan"))
    with pytest.raises(dspace.NotFound):
        scene.ephemeris("moon", "earth", 0.0, axes="NO_FRAME")


def run(*words):
    return subprocess.run([sys.executable, "-m", "dspace", "ephemeris", *words], capture_output=True, text=True)


def test_the_command_line_is_spices():
    """spice_checks.json: Mars from the Earth, LT+S."""
    kernel = real(KERNELS / "de405s_bigendian.bsp")
    words = ("mars", "--observer", "earth", "--time", "2003-07-04T19:00:00", "--correction", "LT+S", "--kernel", str(kernel))
    done = run(*words, "--json")
    assert done.returncode == 0, done.stderr
    state = json.loads(done.stdout)["states"][0]
    assert state["x_m"] == pytest.approx(73822235.3105354905128e3, abs=1e-2)
    assert state["vz_m_s"] == pytest.approx(3.00129849265935222391e3, abs=1e-6)
    assert state["light_time_s"] == pytest.approx(269.6898813661505, abs=1e-10)
    words = ("mars", "--time", "2003-07-04T19:00:00,2003-07-04T20:00:00,600", "--csv", "--kernel", str(kernel))
    rows = list(csv.DictReader(io.StringIO(run(*words).stdout)))
    assert [row["utc"][11:16] for row in rows] == ["19:00", "19:10", "19:20", "19:30", "19:40", "19:50", "20:00"]
    assert float(rows[0]["x_m"]) == pytest.approx(73826216.4145559966564e3, abs=1e-2)
    wrong = run("nowhere", "--time", "2003-07-04")
    assert wrong.returncode != 0 and "nowhere" in wrong.stderr and "Traceback" not in wrong.stderr
