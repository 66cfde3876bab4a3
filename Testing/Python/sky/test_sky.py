"""Kernels, reference frames, frames that follow the time, and the sky, from Python: against skyfield and Horizons."""
import os
import pathlib

import numpy as np
import pytest

import dspace
import needs

DATA = pathlib.Path(os.environ.get("DSPACE_DATA", "/nonexistent")) / "ephemeris"


def real(*names):
    """Paths of real data files; skips where they are absent."""
    for name in names:
        if not (DATA / name).exists():
            pytest.skip(f"real data absent: set DSPACE_DATA to the folder that has ephemeris/{name}")
    return [DATA / name for name in names]


@pytest.fixture
def scene():
    with dspace.Session() as session:
        yield session.scene()


def angles(a, b):
    """Angles [rad] between rotations, exact for small ones."""
    d = a @ np.swapaxes(b, -1, -2)
    v = np.stack([d[..., 1, 2] - d[..., 2, 1], d[..., 2, 0] - d[..., 0, 2], d[..., 0, 1] - d[..., 1, 0]], -1)
    return np.linalg.norm(v, axis=-1) / 2


def test_the_moons_axes_are_skyfields(scene):
    api = needs.needs_module("skyfield.api", "python3-skyfield")
    planetary = needs.needs_module("skyfield.planetarylib", "python3-skyfield")
    files = real("moon_080317.tf", "moon_pa_de421_1900-2050.bpc")
    constants = planetary.PlanetaryConstants()
    with open(files[0], "rb") as text:
        constants.read_text(text)
    constants.read_binary(open(files[1], "rb"))
    timescale = api.load.timescale(builtin=True)
    times = np.random.default_rng(15).uniform(-3.1e9, 1.57e9, 10_000)  # 1901 to 2049
    scene.kernels.load(*files)
    for name in ("MOON_PA", "MOON_ME"):
        theirs = constants.build_frame_named(f"{name}_DE421")
        # skyfield takes one float for the TDB Julian date: 40 us, in which the Moon turns by 1e-10 rad. Whole and part
        # are given apart.
        whole = np.floor(times / 86400.0)
        expected = np.moveaxis(theirs.rotation_at(timescale.tdb_jd(2451545.0 + whole, (times / 86400.0) - whole)), -1, 0)
        rotation = scene.reference_frames.rotation("J2000", name, times)
        assert rotation.shape == (10_000, 3, 3)
        assert angles(rotation, expected).max() < 1e-10


def test_the_sun_at_the_lunar_site_is_horizons(scene):
    """sky_checks.json: Sun azimuth and elevation at 29.1957 E, 84.7906 S."""
    scene.kernels.load(*real("naif0012.tls", "moon_080317.tf", "moon_pa_de421_1900-2050.bpc"))
    rows = {846763269.184: (255.862499, 0.186534), 846781269.184: (253.337795, -0.033378)}  # 00:00 and 05:00 UTC
    for time, (azimuth, elevation) in rows.items():
        sun = scene.sky(body="moon", site=(29.1957, -84.7906), time=time)["sun"]
        assert abs(sun.azimuth_deg - azimuth) < 1e-4
        assert abs(sun.elevation_deg - elevation) < 1e-4
    moon = scene.add_celestial_frame("moon", "moon", axes="MOON_ME", center="earth")
    site = scene.add_celestial_frame("site", "moon", site=(29.1957, -84.7906), parent=moon)
    scene.sun.follow(frame=site)
    scene.time = 846763269.184
    on_frame = scene.sky(["sun", "earth"], frame=site)
    assert abs(on_frame["sun"].azimuth_deg - 255.862499) < 1e-4
    assert abs(on_frame["earth"].elevation_deg) < 13
    assert abs(scene.sun.distance_au - on_frame["sun"].range / 149597870700.0) < 1e-12


def test_sub_solar_points_of_the_moon_are_skyfields(scene):
    """skyfield, with its own light time and the same ephemeris and orientation."""
    api = needs.needs_module("skyfield.api", "python3-skyfield")
    planetary = needs.needs_module("skyfield.planetarylib", "python3-skyfield")
    tf, bpc, bsp = real("moon_080317.tf", "moon_pa_de421_1900-2050.bpc", "de430_excerpt_2015-03-02.bsp")
    constants = planetary.PlanetaryConstants()
    with open(tf, "rb") as text:
        constants.read_text(text)
    constants.read_binary(open(bpc, "rb"))
    frame = constants.build_frame_named("MOON_ME_DE421")
    planets = api.load_file(str(bsp))
    scene.kernels.load(tf, bpc, bsp)
    time = api.load.timescale(builtin=True).tdb_jd(2457083.6)
    tdb = (2457083.6 - 2451545.0) * 86400.0
    apparent = planets["moon"].at(time).observe(planets["sun"])
    sun = frame.rotation_at(time) @ apparent.position.au
    point = scene.reference_frames.sub_solar_point("moon", tdb)
    # Aberration by the Moon's velocity of 30 km/s, up to 20.5 arcsec, is not in `observe`: it is added here.
    v = planets["moon"].at(time).velocity.km_per_s / 299792.458
    u = apparent.position.au / np.linalg.norm(apparent.position.au)
    sun = frame.rotation_at(time) @ (u + v - u * (u @ v))
    assert abs(point.longitude_deg - np.degrees(np.arctan2(sun[1], sun[0]))) < 1e-4
    assert abs(point.latitude_deg - np.degrees(np.arcsin(sun[2] / np.linalg.norm(sun)))) < 1e-4
    assert point.frame == "MOON_ME"


def test_cassinis_kernels_are_described(scene):
    folder = "spice_test_kernels/"
    scene.kernels.load(*real("naif0012.tls", *(folder + name for name in (
        "13056_13057ra.bc", "cas00167.tsc", "cas_v40.tf", "cas_iss_v10.ti"))))
    kernels = scene.kernels
    assert len(kernels.files) == 5
    frames = {frame.name: frame for frame in kernels.frames}
    assert frames["CASSINI_SC_COORD"].kind == "CK" and frames["CASSINI_ISS_NAC"].kind == "TK"
    assert [clock.id for clock in kernels.clocks] == [-82]
    camera = kernels.instruments[-82360]
    assert camera.shape == "RECTANGLE" and camera.frame == "CASSINI_ISS_NAC"
    assert np.allclose(np.degrees(np.arctan(np.abs(camera.boundary[:, :2] / camera.boundary[:, 2:]))), 0.175, atol=1e-12)
    steps = scene.reference_frames.explain("J2000", "CASSINI_ISS_NAC", 415065000.0)
    assert steps[0].source.startswith("CK ") and "cas_v40.tf" in steps[1].source
    with pytest.raises(dspace.InvalidArgument, match="the CKs cover 2013-02-2"):
        scene.reference_frames.rotation("J2000", "CASSINI_SC_COORD", 0.0)


def test_bad_input_names_object_value_and_what_is_accepted(scene, tmp_path):
    with pytest.raises(dspace.NotFound, match="IAU_MOON"):
        scene.reference_frames.rotation("J2000", "IAU_MOOON", 0.0)
    with pytest.raises(dspace.InvalidArgument, match="no times"):
        scene.reference_frames.rotation("J2000", "IAU_MOON", [])
    with pytest.raises(dspace.InvalidArgument, match="one dimension"):
        scene.reference_frames.rotation("J2000", "IAU_MOON", [[0.0]])
    with pytest.raises(dspace.WrongType):
        scene.reference_frames.rotation(1, "IAU_MOON", 0.0)
    bad = tmp_path / "bad.tf"
    bad.write_text("KPL/FK\n\\begindata\nFRAME_X = ( 1\n")
    with pytest.raises(dspace.Corrupt, match=r"bad\.tf.*line 3"):
        scene.kernels.load(bad)
    assert scene.kernels.paths == []
    with pytest.raises(dspace.NotFound, match="vulcan"):
        scene.add_celestial_frame("vulcan", "vulcan", center="sun")
    assert "vulcan" not in scene.frames  # nothing is left of it
    with pytest.raises(dspace.InvalidArgument, match="one of them"):
        scene.sky("sun")
    with pytest.raises(dspace.NotFound):
        scene.sky("vulcan", body="moon", site=(0, 0))


def test_terrain_on_the_moon_has_a_sky(scene):
    """A map point is the site of its longitude, latitude and height."""
    path, = real("../terrain/moon_lola_ldem4_reduced.cub")
    terrain = scene.add_terrain(str(path), mode="clipmap", on_body=True)
    left, top, right, bottom = terrain.map_extent
    x, y = (left + right) / 2, (top + bottom) / 2
    height = terrain.height(x, y, map=True)
    here = terrain.locate([(x, y, height + 2.0)], map=True)
    sun = terrain.sky(x, y, height=2.0, time=3e8)["sun"]
    site = (here.longitude[0], here.latitude[0], here.height[0])
    same = scene.sky(body="moon", site=site, time=3e8)["sun"]
    assert abs(sun.elevation_deg - same.elevation_deg) < 1e-9
    assert abs(sun.azimuth_deg - same.azimuth_deg) < 1e-9
    assert abs(sun.range - same.range) < 1e-3
    with pytest.raises(dspace.InvalidArgument, match="off its data"):
        terrain.sky(0, 1e9)


def test_a_recording_plays_without_its_kernels(tmp_path):
    path = tmp_path / "run.dspace"
    kernel = tmp_path / "x.tpc"
    kernel.write_text("KPL/PCK\n\\begindata\nBODY301_RADII = ( 1737.4 1737.4 1737.4 )\n")
    with dspace.Session() as session:
        scene = session.scene()
        with session.record(path):
            scene.add_celestial_frame("moon", "moon", axes="IAU_MOON", center="earth")
            for step in range(3):
                scene.time = 1e8 + 3600.0 * step
        expected = scene.poses(["moon"])[0]
    with dspace.Playback(path) as playback:
        playback.seek(1e8 + 7200.0)
        assert np.array_equal(playback.session.scene().poses(["moon"])[0], expected)


def test_a_body_that_is_the_sun_and_a_sun_that_follows_exclude_each_other(scene):
    """The distance of the Sun would count twice."""
    scene.add_body("sun", name="star", position=(0, 0, 2e11))
    before = scene.sun.irradiance
    with pytest.raises(dspace.InvalidArgument, match="object 'star' is the Sun"):
        scene.sun.follow(body="mars")
    assert scene.sun.irradiance == before
    scene.objects["star"].remove()
    scene.sun.follow(body="mars")
    assert scene.sun.irradiance < 0.6 * before
    with pytest.raises(dspace.InvalidArgument, match="object 'sun': it is the Sun, but .* follows"):
        scene.add_body("sun")
    assert "sun" not in scene.objects
    scene.add_body("moon")  # no Sun
    scene.sun.stop()
    scene.add_body("sun")


def test_the_scenes_time_as_text(scene):
    scene.time = "2026-11-28T05:00:00 TDB"
    assert scene.time == 846763200.0 + 27 * 86400.0 + 5 * 3600.0
    assert scene.time_text(decimals=0) == "2026-11-28T05:00:00"
    with pytest.raises(dspace.InvalidArgument, match="2026-13-01"):
        scene.time = "2026-13-01"
    assert scene.time_text(decimals=0) == "2026-11-28T05:00:00"


def test_corrections_of_sub_points(scene):
    """The Sun's light takes 500 s to the Earth, which moves it by 20 arcsec, and aberration by 20 arcsec back."""
    time = scene.tdb("2026-11-28")
    points = {c: scene.reference_frames.sub_solar_point("earth", time, correction=c) for c in ("NONE", "LT", "CN", "CN+S")}
    assert points["CN"][:3] == points["LT"][:3]
    assert points["CN+S"][:3] == scene.reference_frames.sub_solar_point("earth", time)[:3]
    # In axes that do not turn, the geometric Sun's direction is that of the ephemeris.
    sun = scene.ephemeris("sun", "earth", time, axes="ITRF93").position
    assert points["NONE"].longitude_deg == pytest.approx(np.degrees(np.arctan2(sun[1], sun[0])), abs=1e-9)
    shift = points["CN"].longitude_deg - points["CN+S"].longitude_deg
    assert abs(shift) * 3600 == pytest.approx(20.5, abs=2.0)
    seen = scene.ephemeris("earth", "mars", time, axes="ITRF93").position  # below Mars, without light time
    below = scene.reference_frames.sub_observer_point("earth", "mars", time, correction="NONE")
    assert below.longitude_deg == pytest.approx(np.degrees(np.arctan2(-seen[1], -seen[0])), abs=1e-9)
    with pytest.raises(dspace.InvalidArgument, match="accepted"):
        scene.reference_frames.sub_solar_point("earth", time, correction="ABERRATION")


def test_an_spk_kernel_is_no_trajectory(scene, tmp_path):
    with pytest.raises(dspace.InvalidArgument, match="body_path"):
        scene.add_trajectory("orbit.bsp")
