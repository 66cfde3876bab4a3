"""Bodies with terrain: one scene from deep space to the ground, placed and turned by time."""
import math

import numpy as np
import pytest
from command_support import write_moon

import dspace

R = 1737400.0
STEP = 2.0  # [deg] of the grid's pixels


def relief(amplitude):
    """Of a whole Moon: waves of 40 degrees, and a mountain at 30 E 10 N."""
    longitude, latitude = np.meshgrid(np.arange(-179, 180, STEP), np.arange(89, -90, -STEP))
    z = amplitude * np.cos(np.radians(9 * longitude)) * np.cos(np.radians(9 * latitude)) * np.cos(np.radians(latitude))
    away = np.hypot((longitude - 30) * np.cos(np.radians(latitude)), latitude - 10)
    return (z + 3 * amplitude * np.exp(-(away / 6.0) ** 2)).astype(np.float32)


@pytest.fixture
def session():
    with dspace.Session() as session:
        yield session


@pytest.fixture(scope="module")
def rasters(tmp_path_factory):
    folder = tmp_path_factory.mktemp("moons")
    return {height: str(write_moon(folder / f"moon{height}.tif", relief(height), -180, 90, STEP)) for height in (0, 4000)}


@pytest.fixture(scope="module")
def texture(tmp_path_factory):
    """Light and dark quarters, whose left edge is longitude -180."""
    from terrain_support import gdal
    path = str(tmp_path_factory.mktemp("textures") / "quarters.png")
    grey = np.where(np.arange(256) // 64 % 2 == 0, 200, 90).astype(np.uint8)
    data = gdal.GetDriverByName("MEM").Create("", 256, 128, 3)
    for band in (1, 2, 3):
        data.GetRasterBand(band).WriteArray(np.tile(grey, (128, 1)))
    gdal.GetDriverByName("PNG").CreateCopy(path, data)
    return path


def look(scene, distance, size=201, fov=40.0, longitude=10.0, latitude=5.0):
    """From `distance` from the centre, over a place, the Sun 40 degrees to the side."""
    lon, lat = math.radians(longitude), math.radians(latitude)
    up = np.array([math.cos(lat) * math.cos(lon), math.cos(lat) * math.sin(lon), math.sin(lat)])
    scene.sun.direction = (math.cos(lon + 0.7), math.sin(lon + 0.7), 0.1)
    scene.add_camera(eye=tuple(distance * up), target=(0, 0, 0), up=(0, 0, 1), fov_deg=fov)
    view = scene.add_viewport((size, size), samples=2)
    view.set(fill=0.0)
    return view


def distance_for(radius, size=201, fov=40.0):
    """At which a disc has this radius [pixels]."""
    return R * size / (2 * math.tan(math.radians(fov / 2)) * radius)


def test_far_away_it_is_the_ellipsoid_and_near_the_terrain(session, rasters):
    scene = session.scene()
    moon = scene.add_body("moon", terrain=rasters[4000])
    ground = scene.terrains["moon terrain"]
    assert ground.frame == moon.frame and ground.on_body
    for radius, label in ((11.5, moon), (12.5, ground.object), (60.0, ground.object)):
        view = look(scene, distance_for(radius))
        labels = view.labels()
        assert set(np.unique(labels)) == {0, label.id}, radius
        view.remove()
    plain = session.scene("plain")
    plain.add_body("moon")
    pictures = []
    for each in (scene, plain):
        pictures.append(look(each, distance_for(11.0)).radiance())
    assert np.array_equal(*pictures)  # the terrain is not drawn at all


def test_level_ground_looks_as_the_ellipsoid_does(session, rasters, texture):
    for settings in ({}, {"texture": texture, "albedo": 0.12}, {"reflectance": "lommel-seeliger", "color": (0.6, 0.5, 0.4)}):
        pictures = []
        for name, terrain in (("plain", {}), ("ground", {"terrain": rasters[0]})):
            scene = session.scene(f"{name} {len(settings)} {'color' in settings}")
            scene.add_body("moon", **settings, **terrain)
            pictures.append(look(scene, distance_for(80.0)).radiance()[:, :, 1])
        plain, ground = pictures
        middle = np.hypot(*np.meshgrid(np.arange(201) - 100, np.arange(201) - 100)) < 70
        edge = np.abs(np.gradient(plain, axis=1)) > 0.02 * plain.max()  # of texels, which tiles smooth in their own way
        inner = middle & ~edge & ~np.roll(edge, 1, 1) & ~np.roll(edge, -1, 1)
        np.testing.assert_allclose(ground[inner], plain[inner], rtol=0.03, atol=0.01 * plain.max())
        assert ground.sum() == pytest.approx(plain.sum(), rel=0.01)


def test_nothing_jumps_where_the_terrain_takes_over(session, rasters):
    """The light of the whole disc, times the distance squared: waves of 4 km on both sides of 12 pixels."""
    scene = session.scene()
    scene.add_body("moon", terrain=rasters[4000], albedo=0.12)
    light = []
    for radius in (11.6, 11.9, 12.1, 12.4):
        view = look(scene, distance_for(radius))
        light.append(view.radiance()[:, :, 1].sum() / radius ** 2)
        view.remove()
    assert max(light) < 1.02 * min(light), light


def test_one_scene_goes_down_to_the_ground(session, rasters):
    """Each picture of a descent has ground in its middle, at the depth that the height over it says."""
    scene = session.scene()
    scene.add_body("moon", terrain=rasters[4000])
    ground = scene.terrains["moon terrain"]
    height = float(ground.height(20.0, 5.0, map=True))
    assert abs(height) > 100.0
    before = None
    for above in 2.0 * 10.0 ** np.arange(8.0, -0.1, -0.5):
        view = look(scene, R + height + above, size=101, fov=60.0, longitude=20.0)
        depth, light = view.depth()[50, 50], view.radiance()[:, :, 1]
        if above > distance_for(13.0, 101, 60.0):
            assert depth == pytest.approx(above, rel=0.02)
        else:
            assert depth == pytest.approx(above, rel=2e-3, abs=20.0 if above > 1e3 else 0.02)
        shown = light[50, 50]
        assert shown > 0.0 and (before is None or shown == pytest.approx(before, rel=0.25))
        before = shown
        view.remove()


def test_it_is_placed_and_turned_by_time(session, rasters):
    scene = session.scene()
    scene.time = scene.tdb("2026-11-01T00:00:00")
    moon = scene.add_body("moon", center="earth", terrain=rasters[4000])
    for text in ("2026-11-01T00:00:00", "2026-11-09T06:00:00"):
        scene.time = scene.tdb(text)
        place = scene.ephemeris("moon", "earth", scene.time).position
        turn = scene.reference_frames.rotation("MOON_ME", "J2000", scene.time)
        mountain = scene.terrains["moon terrain"].from_map([30.0, 10.0, 0.0])
        at = moon.frame.world_pose.matrix @ [*mountain, 1.0]
        np.testing.assert_allclose(at[:3], place + turn @ mountain, atol=1.0)
        # Seen from above it, the mountain is in the middle and nearer than what is around it.
        up = turn @ (mountain / np.linalg.norm(mountain))
        scene.add_camera("over", eye=tuple(place + 3 * R * up), target=tuple(place), fov_deg=20)
        depth = scene.add_viewport((101, 101), "over").depth()
        row, column = np.unravel_index(np.argmin(depth), depth.shape)
        assert abs(row - 50) <= 3 and abs(column - 50) <= 3


def test_a_recording_and_a_snapshot_have_both(session, rasters, tmp_path):
    scene = session.scene()
    with session.record(tmp_path / "a.dspace"):
        moon = scene.add_body("moon", terrain={"path": rasters[4000], "name": "ldem"}, albedo=0.1)
        view = look(scene, distance_for(60.0))
        before = view.image()
        scene.time = 1.0
    with session.record(tmp_path / "b.dspace"):  # begins with a snapshot
        scene.time = 2.0
    for name, time in (("a", 1.0), ("b", 2.0)):
        with dspace.Playback(tmp_path / f"{name}.dspace") as run:
            run.seek(time)
            np.testing.assert_array_equal(next(iter(run.session.viewports.values())).image(), before)
    scene.terrains["ldem"].remove()
    assert set(np.unique(view.labels())) == {0, moon.id}  # the ellipsoid is back
    with session.record(tmp_path / "c.dspace"):
        scene.time = 3.0
    with dspace.Playback(tmp_path / "c.dspace") as run:
        run.seek(3.0)
        assert np.array_equal(next(iter(run.session.viewports.values())).image(), view.image())


def test_air_lies_over_ground_below_the_ellipsoid(session, tmp_path):
    """As in Gale: the sky over a camera 4,500 m below the datum is lit."""
    from terrain_support import gdal
    mars = 3396190.0
    z = np.full((90, 180), -4500.0, np.float32)
    data = gdal.GetDriverByName("GTiff").Create(str(tmp_path / "mars.tif"), 180, 90, 1, gdal.GDT_Float32)
    data.SetGeoTransform((-180, 2, 0, 90, 0, -2))
    data.SetProjection(f'GEOGCS["Mars",DATUM["Mars",SPHEROID["Mars",{mars},0]],PRIMEM["G",0],UNIT["degree",0.0174532925199433]]')
    data.GetRasterBand(1).WriteArray(z)
    data = None
    scene = session.scene()
    scene.add_body("mars", terrain={"path": str(tmp_path / "mars.tif"), "vertical_datum": f"sphere:{mars:.0f}"})
    scene.sun.direction = (1, 0.5, 0.3)
    scene.add_camera(eye=(mars - 4490.0, 0, 0), target=(mars - 4490.0, 100.0, 40.0), up=(1, 0, 0), fov_deg=40)
    view = scene.add_viewport((64, 48))
    light = view.radiance()[:, :, 1]
    assert (light[:20] > 1.0).all()  # [W/m^2/sr]: a sky
    assert set(np.unique(view.labels()[40:])) == {scene.terrains["mars terrain"].object.id}


def test_what_is_wrong_leaves_nothing(session, rasters, texture, tmp_path):
    scene = session.scene()
    wrong = [
        (dict(body="mars", terrain=rasters[0]), dspace.InvalidArgument, "1737400.*accepted: within 2 %"),
        (dict(body="moon", terrain=rasters[0], position=(1, 0, 0)), dspace.InvalidArgument, "none of them with terrain"),
        (dict(body="moon", terrain={"name": "x"}), dspace.InvalidArgument, "a dict that has a path"),
        (dict(body="moon", terrain={"path": rasters[0], "mode": "triangles"}), dspace.InvalidArgument, "mode of the terrain"),
        (dict(body="moon", terrain=str(tmp_path / "absent.tif")), dspace.Error, "absent.tif"),
        (dict(body="moon", terrain=rasters[0], texture=str(tmp_path / "absent.png")), dspace.Error, "absent.png"),
        (dict(body="moon", terrain=rasters[0], center="vulcan"), dspace.Error, "vulcan"),
        (dict(body="moon", axes="MOON_PA"), dspace.InvalidArgument, "with center"),
        (dict(body="vulcan", center="vulcan"), dspace.Error, "VULCAN|vulcan"),
        (dict(radii=1e6, center="moon"), dspace.InvalidArgument, "name of the body"),
        (dict(body="moon", terrain=rasters[0], albedo=11.0), dspace.InvalidArgument, "albedo")]
    for settings, kind, text in wrong:
        with pytest.raises(kind, match=text):
            scene.add_body(**settings)
        assert not scene.objects and not scene.terrains and not scene.frames, settings
