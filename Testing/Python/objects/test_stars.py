"""Stars: catalogues against published places, drawn stars through a known camera, recordings, bad input."""
import math
import pathlib

import numpy as np
import pytest
from needs import lacks

import dspace
from dspace.stars import StarCatalog, bright_stars, read_kstars, read_stars, read_stellarium
from dspace.stars.kstars import KSTARS_PATH
from dspace.stars.stellarium import STELLARIUM_PATH

# ICRS places of the epoch and equinox J2000 and V magnitudes (SIMBAD, CDS Strasbourg).
PUBLISHED = {"Sirius": (101.287155, -16.716116, -1.46), "Vega": (279.234735, 38.783689, 0.03),
             "Polaris": (37.954561, 89.264109, 2.02), "Betelgeuse": (88.792939, 7.407064, 0.42),
             "Acrux": (186.649563, -63.099093, 1.3)}


def direction(ra, dec):
    ra, dec = math.radians(ra), math.radians(dec)
    return np.array([math.cos(dec) * math.cos(ra), math.cos(dec) * math.sin(ra), math.sin(dec)])


def arcseconds(a, b):
    return math.degrees(math.atan2(np.linalg.norm(np.cross(a, b)), np.dot(a, b))) * 3600.0


def test_the_shipped_catalogue_has_the_published_places():
    stars = bright_stars()
    assert len(stars) == 9096
    for name, (ra, dec, magnitude) in PUBLISHED.items():
        star = stars.named(name)
        assert arcseconds(star.directions()[0], direction(ra, dec)) < 3.0, name
        assert star.magnitude[0] == pytest.approx(magnitude, abs=0.1)
    # To magnitude 6.5 the sky has about 8,400 stars (Yale's own count: 9,110 in the whole catalogue).
    assert 8000 < len(stars.brighter_than(6.5)) < 9000


def test_stars_move_and_have_parallax():
    star = StarCatalog([269.452], [4.693], [9.5], pm_ra=[-0.80], pm_dec=[10.36], parallax=[0.547])  # Barnard's
    now, later = star.directions()[0], star.directions(2100.0)[0]
    assert arcseconds(now, later) == pytest.approx(100.0 * math.hypot(0.80, 10.36), rel=1e-4)
    assert later[2] > now[2]
    # A baseline of 1 au across the line of sight moves it by its parallax, away from the observer.
    across = np.cross(now, [0.0, 0.0, 1.0])
    across /= np.linalg.norm(across)
    seen = star.directions(observer=across)[0]
    assert arcseconds(now, seen) == pytest.approx(0.547, rel=1e-4)
    assert np.dot(seen - now, across) < 0.0


def write_stellarium(path, kind, level, zone, records):
    """A catalogue of Stellarium whose stars are all in one zone."""
    sizes = np.zeros(20 * 4 ** level, "<u4")
    sizes[zone] = len(records)
    head = np.array([0x835F040A, kind, 0, 0, level], "<u4").tobytes() + np.array([6000, 12800, 256], "<i4").tobytes()
    path.write_bytes(head + sizes.tobytes() + b"".join(records))


def test_stellariums_files(tmp_path):
    """A zone's centre is that of a face of the icosahedron: a vertex of the dodecahedron."""
    precise = np.array([(1, 0, 0, 32, 64, 0, 1000, -2000, 54700)], np.dtype("<u4,<i4,<i4,u1,u1,<u2,<i4,<i4,<i4")).tobytes()
    write_stellarium(tmp_path / "stars_0_0v0_8.cat", 0, 0, 6, [precise])
    star = read_stellarium(tmp_path)
    # (+-1, +-1, +-1) and (0, +-1/g, +-g), cyclic, over the root of 3; g is the golden ratio.
    golden = (1 + 5 ** 0.5) / 2
    centre = np.sort(np.abs(star.directions()[0])) * 3 ** 0.5
    assert np.allclose(centre, (1, 1, 1), atol=1e-6) or np.allclose(centre, (0, 1 / golden, golden), atol=1e-6)
    assert star.magnitude[0] == pytest.approx(6.0 + 64 * 12.8 / 256) and star.color_index[0] == pytest.approx(32 * 4 / 127 - 0.5)
    assert (star.pm_ra[0], star.pm_dec[0], star.parallax[0]) == pytest.approx((0.1, -0.2, 0.547))
    bits = (-5 & 0xFFFFF) | 7 << 20 | (-3 & 0x3FFF) << 40 | 9 << 54 | 100 << 68 | 31 << 75
    write_stellarium(tmp_path / "stars_3_1v0_4.cat", 1, 1, 0, [bits.to_bytes(10, "little")] * 2)
    both = read_stellarium(tmp_path)
    assert len(both) == 3 and both.magnitude[2] == pytest.approx(6.0 + 31 * 12.8 / 256)
    assert both.pm_ra[2] == pytest.approx(-3e-4, rel=1e-3) and both.pm_dec[2] == pytest.approx(9e-4, rel=1e-3)
    for name, data, text in (("stars_1_0v0_8.cat", b"short", "5 bytes"), ("stars_1_0v0_8.cat", bytes(200), "no star catalogue"),
                             ("stars_1_0v0_8.cat", (tmp_path / "stars_0_0v0_8.cat").read_bytes()[:-1], "27 bytes follow"),
                             ("stars_1_0v0_8.cat", (tmp_path / "stars_0_0v0_8.cat").read_bytes()[:60], "within its head")):
        (tmp_path / name).write_bytes(data)
        with pytest.raises(dspace.Corrupt, match=text):
            read_stellarium(tmp_path)
    with pytest.raises(dspace.NotFound, match="stellarium-data"):
        read_stellarium(tmp_path / "absent")


def test_stellariums_stars_are_those_of_other_catalogues():
    if not pathlib.Path(STELLARIUM_PATH).is_dir():
        pytest.skip("the optional package stellarium-data is not installed")
    stars = read_stellarium()
    assert len(stars) > 600000
    # Of 1,000 bright stars each is there, of the same magnitude; with motions, also in 2200.
    bright = bright_stars().brighter_than(4.6)
    for epoch, most in ((2000.0, 2.0), (2200.0, 4.0)):
        cosine = bright.directions(epoch) @ stars.brighter_than(6.0).directions(epoch).T
        nearest = cosine.argmax(axis=1)
        apart = [arcseconds(a, b) for a, b in zip(bright.directions(epoch), stars.brighter_than(6.0).directions(epoch)[nearest])]
        assert np.quantile(apart, 0.9) < most, epoch
    difference = stars.brighter_than(6.0).magnitude[nearest] - bright.magnitude
    assert abs(np.median(difference)) < 0.05 and np.quantile(np.abs(difference), 0.9) < 0.2


def test_apparent_places_have_aberration_and_refraction():
    """Aberration: 20.5 arcsec for the Earth's 29.8 km/s across. Refraction: 58.3 arcsec times the tangent at 45 degrees
    of zenith distance and 1010 hPa, 10 C (C. W. Allen, Astrophysical Quantities)."""
    star = StarCatalog([0.0], [0.0], [1.0], [0.5], names=["star"])
    seen = star.apparent(velocity=(0.0, 29.785e3, 0.0))
    assert 3600.0 * seen.ra_deg[0] == pytest.approx(20.49, abs=0.01) and seen.names == ["star"]
    assert star.apparent().ra_deg[0] == 0.0
    zenith = np.array([math.cos(math.pi / 4), math.sin(math.pi / 4), 0.0])
    lift = arcseconds(star.apparent(zenith=zenith).directions()[0], (1.0, 0.0, 0.0))
    assert lift == pytest.approx(58.3, abs=6.0)  # the formula states 0.1 arcmin
    assert star.apparent(zenith=zenith).ra_deg[0] > 0.0  # upwards
    thin = arcseconds(star.apparent(zenith=zenith, pressure=50500.0, temperature=283.0).directions()[0], (1.0, 0.0, 0.0))
    assert thin == pytest.approx(0.5 * lift, rel=1e-3)
    at_horizon = arcseconds(star.apparent(zenith=(0.0, 0.0, 1.0)).directions()[0], (1.0, 0.0, 0.0))
    assert at_horizon / 60.0 == pytest.approx(29.0, abs=1.0)  # of true height 0; 34.5 seen at 0
    assert arcseconds(star.apparent(zenith=(-0.2, 1.0, 0.0)).directions()[0], (1.0, 0.0, 0.0)) < 1e-6  # 11 degrees below
    np.testing.assert_allclose(star.apparent(zenith=(1.0, 0.0, 0.0)).directions()[0], (1.0, 0.0, 0.0), atol=1e-9)
    with pytest.raises(dspace.InvalidArgument, match="zenith"):
        star.apparent(zenith=(0.0, 0.0, 0.0))
    with pytest.raises(dspace.InvalidArgument, match="temperature"):
        star.apparent(zenith=zenith, temperature=-3.0)


@pytest.fixture
def sky():
    with dspace.Session() as session:
        yield session.scene("sky")


def looking(scene, ra, dec, size=(401, 301), fov=20.0):
    camera = scene.add_camera("camera", eye=(0, 0, 0), target=tuple(1000.0 * direction(ra, dec)), fov_deg=fov)
    return scene.add_viewport(size, camera)


def test_named_stars_are_in_their_pixels(sky):
    """Orion through a pinhole camera: the nine brightest to a tenth of a pixel."""
    stars = bright_stars()
    sky.add_stars(stars, gain=3e5)
    view = looking(sky, 84.0, 1.0, (801, 601), fov=25.0)
    radiance = view.radiance().sum(axis=2)
    pose = view.camera.pose
    w, x, y, z = pose.quaternion
    turn = np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                     [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                     [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])
    focal = 300.5 / math.tan(math.radians(12.5))
    for name in ("Betelgeuse", "Rigel", "Bellatrix", "Mintaka", "Alnilam", "Alnitak", "Saiph"):
        d = turn.T @ stars.named(name).directions()[0]
        u, v = 400.0 + focal * d[0] / d[2], 300.0 + focal * d[1] / d[2]
        x0, y0 = int(round(u)) - 3, int(round(v)) - 3
        part = radiance[y0:y0 + 7, x0:x0 + 7]
        rows, columns = np.mgrid[y0:y0 + 7, x0:x0 + 7]
        assert (columns * part).sum() / part.sum() == pytest.approx(u, abs=0.1), name
        assert (rows * part).sum() / part.sum() == pytest.approx(v, abs=0.1), name


def test_gain_shows_stars_to_the_eye_and_not_in_physical_pictures(sky):
    stars = sky.add_stars()
    view = looking(sky, 84.0, 1.0)
    assert view.image().max() == 0
    stars.gain = 1e5
    shown = view.image()
    assert shown.max() > 100
    assert view.capture(physical_only=True)["color"][..., :3].max() == 0
    many = int((shown.max(axis=2) > 0).sum())
    stars.faintest = 2.5
    assert 0 < (view.image().max(axis=2) > 0).sum() < many
    assert (stars.gain, stars.faintest, stars.spread) == (1e5, 2.5, pytest.approx(0.6))
    stars.visible = False
    assert view.image().max() == 0


def test_colors_are_those_of_the_stars(sky):
    sky.add_stars(gain=1e4)
    view = looking(sky, 88.79, 7.41, fov=2.0)
    red = view.radiance().reshape(-1, 3).sum(axis=0)
    assert red[0] > 1.5 * red[2]  # Betelgeuse
    view.camera.look_at(eye=(0, 0, 0), target=tuple(1000.0 * direction(78.634, -8.2017)))
    blue = view.radiance().reshape(-1, 3).sum(axis=0)
    assert blue[2] > 1.3 * blue[0]  # Rigel


def test_a_frame_turns_them_and_recordings_show_the_same(tmp_path):
    with dspace.Session() as session:
        live = record(session, session.scene("sky"), tmp_path)
    assert live.max() > 100
    with dspace.Playback(tmp_path / "sky.dspace") as run:
        run.seek(1.0)
        again = next(iter(run.session.viewports.values())).image()
        np.testing.assert_array_equal(live, again)


def record(session, sky, tmp_path):
    frame = sky.add_frame("equator", quaternion=(math.cos(0.3), 0.0, 0.0, math.sin(0.3)))
    with session.record(tmp_path / "sky.dspace"):
        stars = sky.add_stars(bright_stars().brighter_than(3.0), frame=frame, gain=2e5)
        view = looking(sky, 84.0 + math.degrees(0.6), 1.0)
        stars.spread = 0.9
        sky.time = 1.0
        return view.image()


def test_fits_leave_stars_out(sky):
    sky.add_box((1, 1, 1), position=(100, 0, 0))
    view = looking(sky, 0.0, 0.0)
    view.fit()
    before = view.camera.pose.position
    sky.add_stars()
    view.fit()
    np.testing.assert_allclose(view.camera.pose.position, before, atol=1e-9)


def test_csv_files(tmp_path, sky):
    path = tmp_path / "stars.csv"
    path.write_text("id,RA,DE,V,BV\n1,10.5,-20.25,4.5,0.6\n2,,1.0,2.0,\n3,200,80,6.25,\n", encoding="utf-8")
    with pytest.warns(dspace.DspaceWarning, match="1 stars without position"):
        stars = read_stars(path, {"ra_deg": "RA", "dec_deg": "DE", "magnitude": "V", "color_index": "BV"})
    assert len(stars) == 2
    assert stars.ra_deg.tolist() == [10.5, 200.0] and math.isnan(stars.color_index[1])
    with pytest.raises(dspace.InvalidArgument, match="do not include 'ra_deg'.*id, RA, DE, V, BV"):
        read_stars(path)
    path.write_text("ra_deg,dec_deg,magnitude\n1,2,3\n1,x,3\n", encoding="utf-8")
    with pytest.raises(dspace.InvalidArgument, match="line 3.*dec_deg is 'x'"):
        read_stars(path)
    with pytest.raises(dspace.NotFound, match="missing.csv"):
        read_stars(tmp_path / "missing.csv")
    with pytest.raises(dspace.InvalidArgument, match="dec_deg is 95.*-90 to 90"):
        StarCatalog([0.0], [95.0], [1.0])
    for bad, message in (({"gain": -1}, "gain is -1"), ({"spread": 0.1}, "spread is 0.1"), ({"epoch": 9999}, "1000 to 3000")):
        with pytest.raises(dspace.InvalidArgument, match=message):
            sky.add_stars(**bad)
    with pytest.raises(dspace.WrongType, match="StarCatalog"):
        sky.add_stars(stars=[1, 2, 3])
    assert not sky.objects


def test_the_catalogue_of_kstars_agrees_with_the_shipped_one(tmp_path):
    if not pathlib.Path(KSTARS_PATH).exists():
        lacks("kstars-data")
    stars = read_kstars()
    assert len(stars) == 125982
    bright = bright_stars()
    for name in ("Sirius", "Vega", "Arcturus", "Procyon", "Rigel", "Capella", "Antares", "Pollux"):  # fast ones among them
        apart = np.linalg.norm(stars.named(name).directions() - bright.named(name).directions())
        assert np.degrees(apart) * 3600.0 < 1.0, name  # the shipped one has whole arcseconds
        assert abs(stars.named(name).magnitude[0] - bright.named(name).magnitude[0]) < 0.15
    with pytest.raises(dspace.NotFound, match="kstars-data"):
        read_kstars(tmp_path / "missing.dat")
    path = tmp_path / "stars.dat"
    path.write_text("# nothing\nabc\n", encoding="utf-8")
    with pytest.raises(dspace.Corrupt, match="no line of it has a star"):
        read_kstars(path)
