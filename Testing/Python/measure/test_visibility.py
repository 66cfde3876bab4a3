"""Contacts and power over spans of time: against python3-skyfield, and against numerical integration of its directions."""
import os
import pathlib

import numpy as np
import pytest

import dspace
import needs
from dspace.trajectories import Conic, States
from terrain_support import write_georeferenced

DATA = pathlib.Path(os.environ.get("DSPACE_DATA", "/nonexistent")) / "ephemeris"
KERNELS = DATA / "spice_test_kernels"
GOLDSTONE = dspace.BodySite("earth", -116.89, 35.4267, 970.0, geodetic=True)
LUNAR = (29.1957, -84.7906)  # longitude, latitude [deg]
START = 150_000_000.0  # 2004-10-02, within de405s


def real(*paths):
    for path in paths:
        if not path.exists():
            pytest.skip(f"real data absent: set DSPACE_DATA to the folder that has {path.relative_to(DATA.parent)}")
    return paths


@pytest.fixture
def sky(scene):
    """The scene with kernels; the same in skyfield: its planets, its time scale, and the lunar site."""
    api = needs.needs_module("skyfield.api", "python3-skyfield")
    planetary = needs.needs_module("skyfield.planetarylib", "python3-skyfield")
    kernels = real(KERNELS / "de405s_littleendian.bsp", DATA / "moon_080317.tf", DATA / "moon_pa_de421_1900-2050.bpc")
    scene.kernels.load(*kernels)
    planets = api.load_file(str(kernels[0]))
    constants = planetary.PlanetaryConstants()
    with open(kernels[1], "rb") as text:
        constants.read_text(text)
    constants.read_binary(open(kernels[2], "rb"))
    constants.variables["BODY301_RADII"] = [1737.4] * 3
    frame = constants.build_frame_named("MOON_ME_DE421")
    site = planets["moon"] + constants.build_latlon_degrees(frame, LUNAR[1], LUNAR[0])
    return scene, api, planets, api.load.timescale(builtin=True), site


def julian(timescale, seconds):
    days = np.asarray(seconds) / 86400.0
    return timescale.tdb_jd(2451545.0 + np.floor(days), days - np.floor(days))


def seconds(t):
    return (t.whole - 2451545.0) * 86400.0 + t.tdb_fraction * 86400.0


def events(timescale, api, up, start, end, step):
    """Skyfield's changes of a condition: seconds past J2000 TDB, and what holds then."""
    find_discrete = needs.needs_module("skyfield.searchlib", "python3-skyfield").find_discrete
    up.step_days = step / 86400.0
    times, values = find_discrete(julian(timescale, start), julian(timescale, end), up)
    return np.array([seconds(t) for t in times]), np.asarray(values)


def edges(contacts):
    return np.array([time for c in contacts for time, cut in ((c.rise.time, c.since_before), (c.set.time, c.until_after)) if not cut])


def test_contacts_over_the_earth_are_skyfields(sky):
    """The Moon's centre over 10 degrees at Goldstone for twenty days. The Earth's turn: skyfield takes its own table of UT1,
    Dspace what it has without kernels: 1 s of UT1 is 1 s of a rise."""
    scene, api, planets, timescale, _ = sky
    ground = planets["earth"] + api.wgs84.latlon(GOLDSTONE.latitude_deg, GOLDSTONE.longitude_deg, elevation_m=GOLDSTONE.height)
    end = START + 20 * 86400.0
    found = scene.contacts(GOLDSTONE, "moon", START, end, step=1800.0, mask=10.0)

    def up(t):
        return ground.at(t).observe(planets["moon"]).apparent().altaz()[0].degrees > 10.0
    times, values = events(timescale, api, up, START, end, 3600.0)
    assert len(found) >= 19 and found[0].target == "moon"
    assert len(edges(found)) == len(times)
    assert np.abs(edges(found) - times).max() < 1.5
    for contact in found[1:-1]:
        t = julian(timescale, contact.peak.time + np.array([-300.0, 0.0, 300.0]))
        altitude, azimuth, distance = ground.at(t).observe(planets["moon"]).apparent().altaz()
        assert altitude.degrees[1] > altitude.degrees[0] and altitude.degrees[1] > altitude.degrees[2]
        assert contact.peak.elevation_deg == pytest.approx(altitude.degrees[1], abs=0.005)
        assert contact.peak.azimuth_deg == pytest.approx(azimuth.degrees[1], abs=0.05)
        assert contact.peak.range == pytest.approx(distance.m[1], abs=2e3)


def test_contacts_of_a_lunar_site_with_a_station_are_skyfields(sky):
    """Goldstone from the Moon's south: over a mask there, and the site 15 degrees over the station's horizontal. Ten days."""
    scene, api, planets, timescale, site = sky
    station = planets["earth"] + api.wgs84.latlon(GOLDSTONE.latitude_deg, GOLDSTONE.longitude_deg, elevation_m=GOLDSTONE.height)
    place = dspace.BodySite("moon", *LUNAR)
    end = START + 20 * 86400.0
    found = scene.contacts(place, [GOLDSTONE, "earth"], START, end, step=1800.0, mask=4.0, station_mask=15.0)

    def over_mask(t):
        return site.at(t).observe(station).apparent().altaz()[0].degrees > 4.0

    def both(t):
        return over_mask(t) & (station.at(t).observe(site).apparent().altaz()[0].degrees > 15.0)
    times, _ = events(timescale, api, both, START, end, 3600.0)
    assert len(times) > 10
    mine = edges([c for c in found if c.target is GOLDSTONE])
    # The station sees the site's light of 1.3 s before, in which the Earth turns.
    assert len(mine) == len(times) and np.abs(mine - times).max() < 4.0
    assert {c.target for c in found} == {GOLDSTONE, "earth"}
    track = scene.sky_track(place, GOLDSTONE, np.linspace(START, end, 50))
    altitude, azimuth, distance = site.at(julian(timescale, track.time)).observe(station).apparent().altaz()
    assert np.abs(track.elevation_deg - altitude.degrees).max() < 2e-4
    assert np.abs((track.azimuth_deg - azimuth.degrees + 180.0) % 360.0 - 180.0).max() < 2e-4
    assert np.abs(track.range - distance.m).max() < 1000.0


def test_a_panels_lunar_day_is_the_integral(sky):
    """Power of two panels behind a horizon of known shape over a lunar day, against Simpson's rule on skyfield's directions at a
    sixth of the step, with the disc as 20,000 points."""
    scene, _, planets, timescale, site = sky
    end = START + 29.53 * 86400.0
    line = 1.5 * np.sin(np.radians(2.0 * np.arange(720) * 0.5))  # elevation: 1.5 sin(2 azimuth)
    panels = [dspace.Panel(2.0, 0.3, azimuth_deg=30.0, elevation_deg=10.0), dspace.Panel(1.0, 0.25, tracking="vertical")]
    place = dspace.BodySite("moon", *LUNAR)
    profile = scene.power_profile(place, panels, START, end, step=3600.0, mask=line)
    times = np.linspace(START, end, 6 * 708 + 1)
    sun, earth = (site.at(julian(timescale, times)).observe(planets[body]).apparent() for body in ("sun", "earth"))
    altitude, azimuth, distance = sun.altaz()
    altitude, azimuth, au = altitude.degrees, azimuth.degrees, distance.au
    turn, r = np.meshgrid(np.linspace(0, 2 * np.pi, 400, endpoint=False), np.sqrt((np.arange(50) + 0.5) / 50))
    radius = np.degrees(np.arcsin(695700.0 / (149597870.7 * au)))
    lit = np.empty(len(times))
    for i, (a, z) in enumerate(zip(altitude, azimuth)):
        if abs(a) > 3.0:
            lit[i] = a > 0
            continue
        x, y = radius[i] * (r * np.cos(turn)).ravel(), radius[i] * (r * np.sin(turn)).ravel()
        lit[i] = np.mean(a + y > 1.5 * np.sin(np.radians(2.0 * (z + x / np.cos(np.radians(a))))))
    # The eclipse of 2004 October 28.
    apart, limb = sun.separation_from(earth).degrees, np.degrees(np.arcsin(6378.137 / earth.distance().km))
    left = np.ones(len(times))
    for i in np.flatnonzero(apart < limb + radius):
        x, y = radius[i] * (r * np.cos(turn)).ravel(), radius[i] * (r * np.sin(turn)).ravel()
        left[i] = np.mean(np.hypot(x - apart[i], y) > limb[i])
    assert left.min() == 0.0
    light = lit * left
    unit = np.column_stack((np.cos(np.radians(altitude)) * np.sin(np.radians(azimuth)),
                            np.cos(np.radians(altitude)) * np.cos(np.radians(azimuth)), np.sin(np.radians(altitude))))
    facing = 2.0 * 0.3 * np.maximum(unit @ panels[0].normal, 0.0) + 0.25 * np.hypot(unit[:, 0], unit[:, 1])
    power = 1361.0 / au**2 * light * facing
    weights = np.full(len(times), 2.0)
    weights[1::2], weights[[0, -1]] = 4.0, 1.0
    weights /= weights.sum()
    assert 0.2 < profile.lit_share < 0.8  # day and night
    assert profile.lit_share == pytest.approx(weights @ light, abs=5e-4)
    assert profile.energy_wh == pytest.approx(weights @ power * (end - START) / 3600.0, rel=2e-3)
    straight = (apart > limb + radius + 1.2)[::6]  # in two hours about an eclipse the light is no line from hour to hour
    assert np.interp(times[::6], profile.time, profile.power)[straight] == pytest.approx(power[::6][straight], abs=5.0)
    assert straight.sum() > 690
    # The longest night: the longest run without any of the disc above the horizon.
    dark = np.flatnonzero(np.diff(np.concatenate(([0], (lit == 0).astype(int), [0]))))
    longest = (np.diff(dark)[::2]).max() * (times[1] - times[0])
    assert profile.longest_night == pytest.approx(longest, abs=2.5 * (times[1] - times[0]))


def test_a_battery_through_the_night(sky):
    """A load of 10 W: what the battery loses in the night is 10 W times the night, between samples of any step."""
    scene = sky[0]
    place, span = dspace.BodySite("moon", 0.0, 0.0), (START, START + 60 * 86400.0)
    panel = dspace.Panel(5.0, 0.3, tracking="full")
    night = scene.power_profile(place, panel, *span).longest_night
    assert 14.5 * 86400 < night < 14.9 * 86400  # half of 29.53 days less the disc's half degree an end
    profile = scene.power_profile(place, panel, *span, battery=dspace.Battery(10_000.0, load=10.0), step=600.0)
    assert profile.least_charge == pytest.approx(1.0 - night * 10.0 / 3600.0 / 10_000.0, abs=2e-3)
    assert profile.empty == 0.0 and profile.missing_wh == 0.0 and profile.charge[-1] <= 1.0
    short = scene.power_profile(place, panel, *span, battery=dspace.Battery(1_000.0, load=10.0), step=600.0)
    assert short.least_charge == 0.0
    assert short.empty / 2 == pytest.approx(night - 100.0 * 3600.0, rel=0.01)  # two nights in 60 days


def test_the_horizon_of_terrain_is_the_mask(session, scene, tmp_path):
    """A ring wall on a polar map: azimuths of the mask are turned from the map's Y axis to the meridian's north."""
    from terrain_support import gdal
    path, n = tmp_path / "pole.tif", 201
    z = np.zeros((n, n), np.float32)
    z[:, -1] = 5000.0  # a wall in the map's east
    data = gdal.GetDriverByName("GTiff").Create(str(path), n, n, 1, gdal.GDT_Float32)
    data.SetGeoTransform((-n * 500.0, 1000.0, 0, n * 500.0, 0, -1000.0))
    data.SetProjection('PROJCS["south pole",GEOGCS["moon",DATUM["Moon",SPHEROID["Moon",1737400,0]],PRIMEM["G",0],UNIT["degree",'
                       '0.0174532925199433]],PROJECTION["Polar_Stereographic"],PARAMETER["latitude_of_origin",-90],'
                       'PARAMETER["central_meridian",0],PARAMETER["scale_factor",1],UNIT["metre",1]]')
    data.GetRasterBand(1).WriteArray(z)
    del data
    terrain = scene.add_terrain(path, name="pole", vertical_datum="sphere:1737400")
    site = terrain.site(30_000.0, 40_000.0, height=2.0)
    horizon = scene.horizon(site, 720)
    # At the south pole the map's Y axis points along longitude 0, away from the pole: x is sin(longitude). North is away from
    # the pole, at the site's longitude atan2(30, 40). The wall is in the map's east, 90 degrees from the Y axis.
    longitude = np.degrees(np.arctan2(30.0, 40.0))
    assert horizon.first_deg == pytest.approx(-longitude, abs=1e-3)
    wall = (horizon.azimuth_deg[np.argmax(horizon.elevation_deg)] + horizon.first_deg) % 360.0
    assert wall == pytest.approx(90.0 - longitude, abs=1.0)
    # The Sun along the map's Y axis is the Sun in azimuth -longitude: `sky` says so too.
    sky = terrain.sky(30_000.0, 40_000.0, "sun", time=START, body="moon")["sun"]
    scene.sun.set(azimuth_deg=(sky.azimuth_deg - horizon.first_deg) % 360.0, elevation_deg=sky.elevation_deg, terrain=terrain,
                  at=(30_000.0, 40_000.0))
    at_pole = terrain.sky(1.0, 1.0, "sun", time=START, body="moon")["sun"]  # longitude 45
    east, north = np.array(scene.sun.direction)[:2]
    # The verticals differ by 1.65 degrees, and the Sun is 1.5 degrees high at most: azimuths differ by 0.05 degrees.
    # From the pole, the Sun at azimuth a (from the meridian of longitude 45) stands over longitude 45 + a.
    assert np.degrees(np.arctan2(east, north)) % 360.0 == pytest.approx((45.0 + at_pole.azimuth_deg) % 360.0, abs=0.06)
    assert scene.horizon(scene.add_frame("free", position=(9e6, 0.0, 0.0)), 4).first_deg is None


def test_bad_input(scene):
    place = dspace.BodySite("moon", 0.0, 0.0)
    with pytest.raises(dspace.InvalidArgument, match="accepted: an end after the start"):
        scene.contacts(place, "sun", 0.0, 0.0)
    with pytest.raises(dspace.InvalidArgument, match="the step"):
        scene.contacts(place, "sun", 0.0, 1e9, step=1.0)
    with pytest.raises(dspace.NotFound, match="nowhere"):
        scene.contacts(place, "nowhere", 0.0, 1e5)
    with pytest.raises(dspace.InvalidArgument, match="elevation is 95"):
        scene.contacts(place, "sun", 0.0, 1e5, mask=[0.0, 95.0])
    with pytest.raises(dspace.InvalidArgument, match="body of the site"):
        scene.contacts(place, "moon", 0.0, 1e5)
    with pytest.raises(dspace.InvalidArgument, match="the place is on the same body"):
        scene.contacts(place, dspace.BodySite("moon", 1.0, 1.0), 0.0, 1e5)
    with pytest.raises(dspace.InvalidArgument, match="follows no body"):
        scene.contacts("/", "sun", 0.0, 1e5)
    with pytest.raises(dspace.InvalidArgument, match="its area is 0"):
        scene.power_profile(place, dspace.Panel(0.0), 0.0, 1e5)
    with pytest.raises(dspace.InvalidArgument, match="elevation_deg is 99.*-90 to 90"):
        scene.power_profile(place, dspace.Panel(elevation_deg=99.0), 0.0, 1e5)
    with pytest.raises(dspace.InvalidArgument, match="power profile: there is no panel"):
        scene.power_profile(place, [], 0.0, 1e5)
    with pytest.raises(dspace.InvalidArgument, match="power profile: the span runs from .* accepted: an end after the start"):
        scene.power_profile(place, dspace.Panel(), 1e5, 1e5)
    with pytest.raises(dspace.WrongType, match="accepted: a dspace.Panel"):
        scene.power_profile(place, [1.0], 0.0, 1e5)
    with pytest.raises(dspace.InvalidArgument, match="its capacity is 0"):
        scene.power_profile(place, dspace.Panel(), 0.0, 1e5, battery=dspace.Battery(0.0))
    with pytest.raises(dspace.DeadlineExceeded, match="longer than its deadline"):
        scene.contacts(place, "sun", 0.0, 1e8, step=60.0, deadline=0.05)


MOON_MU = 4.9028e12  # [m^3/s^2]
ORBIT = 1837400.0  # [m] radius


def circular(t):
    """A circular orbit about the Moon near its poles, J2000: positions and velocities."""
    rate = np.sqrt(MOON_MU / ORBIT**3)
    a, b = np.array([1.0, 0.0, 0.0]), np.array([0.0, -0.39, 0.92]) / np.hypot(0.39, 0.92)
    turn = rate * (np.asarray(t)[..., None] - START)
    return ORBIT * (a * np.cos(turn) + b * np.sin(turn)), ORBIT * rate * (b * np.cos(turn) - a * np.sin(turn))


def write_oem(path, times, utc):
    lines = ["CCSDS_OEM_VERS = 2.0", "CREATION_DATE = 2026-01-01T00:00:00", "ORIGINATOR = TEST", "META_START", "OBJECT_NAME = CRAFT",
             "OBJECT_ID = 2026-001A", "CENTER_NAME = MOON", "REF_FRAME = EME2000", "TIME_SYSTEM = TDB", f"START_TIME = {utc[0]}",
             f"STOP_TIME = {utc[-1]}", "INTERPOLATION = HERMITE", "INTERPOLATION_DEGREE = 7", "META_STOP"]
    for at, p, v in zip(utc, *circular(times)):
        lines.append(" ".join([at, *(f"{x / 1000.0:.12f}" for x in (*p, *v))]))
    path.write_text("\n".join(lines) + "\n")
    return path


def test_orbiters_rise_by_the_closed_form(sky, tmp_path):
    """A circular polar orbit over a lunar site for a day: skyfield has the site, the formula the craft. Geometric directions differ
    by the craft's velocity over that of light, 0.0003 degrees. As a Conic, an OEM, a frame that moves along a trajectory, and a
    frame that hangs on it."""
    scene, _, planets, timescale, site = sky
    place = dspace.BodySite("moon", *LUNAR)
    end = START + 86400.0

    def elevation(seconds):
        at = (site - planets["moon"]).at(julian(timescale, seconds)).position.m.T
        away = circular(seconds)[0] - at
        return np.degrees(np.arcsin(np.einsum("ni,ni->n", at, away) / np.linalg.norm(at, axis=1) / np.linalg.norm(away, axis=1)))
    coarse = np.arange(START, end + 1.0, 10.0)
    up = elevation(coarse) > 5.0
    expected = []
    for i in np.flatnonzero(up[1:] != up[:-1]):
        fine = np.linspace(coarse[i], coarse[i + 1], 1001)
        expected.append(fine[np.flatnonzero(np.diff(elevation(fine) > 5.0))[0]])
    assert len(expected) >= 20
    conic = Conic(circular(START)[0], circular(START)[1], MOON_MU, START)
    times = np.arange(START, end + 1.0, 60.0)
    texts = [scene.time_text(t, scale="TDB", decimals=6).replace(" TDB", "") for t in times]
    moon = scene.add_celestial_frame("moon", "moon", center="earth")
    inertial = scene.add_celestial_frame("inertial", "moon", axes="J2000", parent=moon)
    path = scene.add_trajectory(States(times, *circular(times)), frame=inertial, name="path")
    craft = path.add_frame("craft")
    antenna = craft.add_frame("antenna", position=(0.0, 0.0, 1.0))
    targets = [dspace.Orbiter(conic, "moon"), dspace.Orbiter(write_oem(tmp_path / "craft.oem", times, texts)), craft, antenna.path,
               dspace.Orbiter(path, 301, "J2000")]
    found = scene.contacts(place, targets, START, end, step=60.0, mask=5.0)
    for target in targets:
        mine = edges([c for c in found if c.target is target])
        assert len(mine) == len(expected) and np.abs(mine - expected).max() < 0.05, target
    track = scene.sky_track(place, targets[1], times[5:-5])
    assert np.abs(track.elevation_deg - elevation(times[5:-5])).max() < 1e-3
    # From the craft the site is as far as the craft from the site, but for what the craft moves while the light is on its way.
    ground = scene.add_celestial_frame("ground", "moon", site=LUNAR, parent=moon)
    there, back = scene.sky_track(ground, craft, times[5:-5]), scene.sky_track(craft, ground, times[5:-5])
    assert np.abs(there.elevation_deg - track.elevation_deg).max() < 1e-6
    assert 0.1 < np.abs(back.range - there.range).max() < 30.0


def test_orbiters_and_frames_that_do_not_suit_are_rejected(scene):
    place = dspace.BodySite("moon", 0.0, 0.0)
    states = States([0.0, 60.0, 120.0], [[2e6, 0, 0], [2e6, 1e5, 0], [2e6, 2e5, 0]])
    with pytest.raises(dspace.InvalidArgument, match="neither it nor its path names the body"):
        scene.contacts(place, dspace.Orbiter(states), 0.0, 60.0)
    with pytest.raises(dspace.NotFound, match="NO_AXES"):
        scene.contacts(place, dspace.Orbiter(states, "moon", "NO_AXES"), 0.0, 60.0)
    with pytest.raises(dspace.InvalidArgument, match="no state is known at .* accepted: times from 0 to 120 s"):
        scene.contacts(place, dspace.Orbiter(states, "moon"), 0.0, 600.0)
    assert 2e6 - 1737400.0 < scene.sky_track(place, dspace.Orbiter(states, "moon"), 0.0).range < 2e6 + 1737400.0  # light of before 0 s
    scene.add_frame("loose")
    with pytest.raises(dspace.InvalidArgument, match="it follows no body"):
        scene.contacts(place, "/loose", 0.0, 60.0)
    moon = scene.add_celestial_frame("moon", "moon", center="moon")
    path = scene.add_trajectory(states, frame=moon, name="path")
    craft = path.add_frame("craft")
    with pytest.raises(dspace.InvalidArgument, match="its place moves along a trajectory"):
        scene.power_profile(craft, dspace.Panel(), 0.0, 60.0, step=10.0)
    with pytest.raises(dspace.InvalidArgument, match="the distance between the place and the target"):
        scene.contacts(craft, craft, 0.0, 60.0)


@pytest.mark.parametrize("on_body", (True, False), ids=("body", "plane"))
def test_direct_to_earth_maps_are_skyfields(sky, tmp_path, on_body):
    """The time that one of three stations has a cell in sight, over a horizon that the map measured: directions by skyfield, ten days
    of hours. The sum of the stations', and the Earth without stations, would be others."""
    scene, api, planets, timescale, site = sky
    lat, lon = np.mgrid[LUNAR[1] + 0.1:LUNAR[1] - 0.1:-0.005, LUNAR[0] - 1.0:LUNAR[0] + 1.0:0.05]
    z = 15.0 * np.sin(9.0 * lon + 150.0 * lat)
    moon = 'GEOGCS["Moon",DATUM["Moon",SPHEROID["Moon",1737400,0]],PRIMEM["Reference",0],UNIT["degree",0.0174532925199433]]'
    path = write_georeferenced(tmp_path / "moon.tif", z.astype(np.float32), (LUNAR[0] - 1.025, 0.05, 0, LUNAR[1] + 0.1025, 0, -0.005), moon)
    terrain = scene.add_terrain(path, name="moon", on_body=on_body)
    horizons = scene.horizon_map(terrain, tmp_path / "horizons.tif", height=2.0, azimuths=240)
    places = ((-116.89, 35.4267, 970.0), (148.98, -35.4, 690.0), (-4.25, 40.43, 830.0))
    stations = [dspace.BodySite("earth", *place, geodetic=True) for place in places]
    steps = 240
    made = scene.illumination_map(horizons, tmp_path / "link.tif", start=START, end=START + (steps - 0.5) * 3600.0, step=3600.0,
                                  quantities=("station_fraction", "earth_fraction"), stations=stations, station_mask=25.0)
    column, row = made.columns // 2, made.rows // 2
    t = julian(timescale, START + 3600.0 * np.arange(steps))
    line = horizons.horizon(column, row).astype(float)
    line = line if on_body else np.maximum(line, 0.0)
    linked, each = np.zeros(steps, bool), []
    for longitude, latitude, height in places:
        station = planets["earth"] + api.wgs84.latlon(latitude, longitude, elevation_m=height)
        altitude, azimuth, _ = site.at(t).observe(station).apparent().altaz()
        floor = np.interp(azimuth.degrees, 1.5 * np.arange(240), line, period=360.0)
        each.append((altitude.degrees >= floor) & (station.at(t).observe(site).apparent().altaz()[0].degrees >= 25.0))
        linked |= each[-1]
    got = made.read("station_fraction")
    assert got[row, column] == pytest.approx(linked.mean(), abs=2.1 / steps)
    assert 0.1 < linked.mean() < 0.9 and np.sum([e.mean() for e in each]) > linked.mean() + 0.02
    assert made.read("earth_fraction")[row, column] > linked.mean() + 0.02
    with pytest.raises(dspace.InvalidArgument, match="it has 0 stations; accepted: 1 to 100"):
        scene.illumination_map(horizons, tmp_path / "no.tif", start=START, end=START + 3600.0, quantities="station_fraction")
    with pytest.raises(dspace.InvalidArgument, match="accepted: none without STATION_FRACTION"):
        scene.illumination_map(horizons, tmp_path / "no.tif", start=START, end=START + 3600.0, stations=stations)
    with pytest.raises(dspace.WrongType, match="a dspace.BodySite on the Earth"):
        scene.illumination_map(horizons, tmp_path / "no.tif", start=START, end=START + 3600.0, stations=["earth"])


def test_profiles_with_the_vehicles_own_shadow(scene):
    """A tilted panel alone has the profile of the same dspace.Panel. Beside a tower each sample is what lit_area() measures with the
    sample's own Sun, which no table is between."""
    moon = scene.add_celestial_frame("moon", "moon", axes="MOON_ME", center="moon", center_axes="MOON_ME")
    site = scene.add_celestial_frame("site", "moon", site=(20.0, -40.0), parent=moon)
    azimuth, elevation = np.radians((30.0, 60.0))
    normal = np.array((np.cos(elevation) * np.sin(azimuth), np.cos(elevation) * np.cos(azimuth), np.sin(elevation)))
    level = np.cross((0.0, 0.0, 1.0), normal) / np.cos(elevation)
    pose = np.eye(4)
    pose[:3, :3] = np.column_stack((level, np.cross(normal, level), normal))
    pose[:3, 3] = (0.0, 0.0, 2.0)
    cells = scene.add_plane(2.0, 1.0, name="cells", frame=site.add_frame("cells", pose=pose))
    start, end = scene.tdb("2026-01-03"), scene.tdb("2026-02-02")
    alone = scene.projected_areas(cells, site, rows=39, efficiency=0.3)
    assert alone.area.shape == (39, 72)
    table = scene.power_profile(site, alone, start, end, step=6 * 3600.0)
    plain = scene.power_profile(site, dspace.Panel(2.0, 0.3, azimuth_deg=30.0, elevation_deg=60.0), start, end, step=6 * 3600.0)
    # Where the Sun passes the panel's plane the table is linear over 5 degrees of azimuth: half of 2.5 degrees at most.
    assert np.abs(table.power - plain.power).max() < 0.02 * plain.power.max() and plain.power.max() > 500.0
    assert table.energy_wh == pytest.approx(plain.energy_wh, rel=3e-3)
    scene.add_box((1.0, 3.0, 4.0), name="tower", frame=site.add_frame("tower", position=(2.0, 1.0, 2.0)))
    shaded = scene.power_profile(site, scene.projected_areas(["cells"], "moon/site", rows=39, efficiency=0.3), start, end, step=6 * 3600.0)
    assert shaded.energy_wh < 0.93 * plain.energy_wh
    axes = site.pose_in(scene.root).matrix[:3, :3]
    differ = []
    for i in range(0, len(shaded.time), 3):
        if shaded.sun_elevation_deg[i] < 1.0:
            assert shaded.power[i] == 0.0 or shaded.sun_elevation_deg[i] > -0.3
            continue
        a, e = np.radians((shaded.sun_azimuth_deg[i], shaded.sun_elevation_deg[i]))
        towards = axes @ (np.cos(e) * np.sin(a), np.cos(e) * np.cos(a), np.sin(e))
        lit = scene.lit_area(cells, sun={"direction": towards, "radius_deg": 0.0}, efficiency=0.3)
        unblocked = 2.0 * max(normal @ axes.T @ towards, 0.0)
        differ.append(shaded.power[i] - plain.power[i] * (lit.projected_area / unblocked if unblocked > 1e-6 else 0.0))
    assert len(differ) > 15 and np.abs(differ).max() < 0.12 * plain.power.max() and np.mean(np.abs(differ)) < 0.015 * plain.power.max()
    for wrong, text in (({"rows": 1}, "rows is 1"), ({"azimuths": 0}, "azimuths is 0"), ({"lowest": 95.0}, "ascending")):
        with pytest.raises(dspace.InvalidArgument, match=text):
            scene.projected_areas(cells, site, **wrong)
    with pytest.raises(dspace.InvalidArgument, match="the areas have the shape"):
        scene.power_profile(site, dspace.ProjectedAreas(np.ones(3), 0.0, 10.0), start, end)
    with pytest.raises(dspace.InvalidArgument, match="its elevations run from 10 to 0"):
        scene.power_profile(site, dspace.ProjectedAreas(np.ones((2, 3)), 10.0, 0.0), start, end)


def test_a_target_of_the_command_is_a_file_whatever_its_name(tmp_path):
    from dspace.command_line.contacts import target_of
    path = tmp_path / "as_flown.asc"
    path.write_text("an OEM")
    assert target_of(str(path)) == dspace.Orbiter(str(path))
    assert target_of(f"{path}:moon") == dspace.Orbiter(str(path), "moon")
    assert target_of("none.oem:moon") == dspace.Orbiter("none.oem", "moon")
    assert target_of("sun") == "sun"
    assert target_of("earth:10,20").body == "earth"
