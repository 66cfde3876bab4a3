"""The Sun of a scene: directions against vectors made with numpy, irradiance, bad input, recordings and servers."""
import numpy as np
import pytest

import dspace
from dspace.proto import commands_pb2 as pb
from dspace.recording.file import commands_of
from served_support import Served
from terrain_support import gdal, write_raster

EQUATORIAL, POLAR = 6378137.0, 6356752.314245


def along(azimuth_deg, elevation_deg, east, north, up):
    a, e = np.radians(azimuth_deg), np.radians(elevation_deg)
    return np.cos(e) * (np.sin(a) * np.asarray(east) + np.cos(a) * np.asarray(north)) + np.sin(e) * np.asarray(up)


def write_body(path, ellipsoid):
    from osgeo import osr
    data = gdal.GetDriverByName("GTiff").Create(str(path), 180, 90, 1, gdal.GDT_Float32)
    data.SetGeoTransform((-180, 2, 0, 90, 0, -2))
    reference = osr.SpatialReference()
    if ellipsoid:
        reference.ImportFromEPSG(4326)
    else:
        reference.ImportFromProj4("+proj=longlat +R=1737400 +no_defs")
    data.SetProjection(reference.ExportToWkt())
    data.GetRasterBand(1).SetUnitType("m")
    data.GetRasterBand(1).WriteArray(np.full((90, 180), 500.0))
    return str(path)


def test_a_new_scene_has_the_light_sun_alone(scene):
    assert set(scene.lights) == {"sun"}
    np.testing.assert_allclose(scene.sun.direction, (-0.5, 0.5, np.sqrt(0.5)), atol=1e-15)
    assert scene.sun.angles() == (315.0, 45.0)
    assert (scene.sun.irradiance, scene.sun.distance_au, scene.sun.radius_deg) == (1361.0, 1.0, 0.2666)
    assert scene.lights["sun"].intensity == 1.0 and scene.lights["sun"].radius_deg == 0.2666
    assert "azimuth 315" in repr(scene.sun)


def test_a_direction_in_any_frame(scene):
    frame = scene.add_frame("craft", quaternion=(np.cos(0.35), 0, np.sin(0.35), 0))
    v = np.array((1.0, -2.0, 0.5))
    scene.sun.set(direction=v, frame=frame)
    c, s = np.cos(0.7), np.sin(0.7)
    turned = np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]]) @ v / np.linalg.norm(v)
    np.testing.assert_allclose(scene.sun.direction, turned, atol=1e-15)
    scene.sun.direction = (0, 0, 5)
    np.testing.assert_array_equal(scene.sun.direction, (0, 0, 1))
    scene.sun.set(azimuth_deg=120, elevation_deg=-5, frame="craft")
    np.testing.assert_allclose(scene.sun.direction, np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]])
                               @ along(120, -5, (1, 0, 0), (0, 1, 0), (0, 0, 1)), atol=1e-15)


def test_azimuth_and_elevation_on_a_plane(scene, field):
    frame = scene.add_frame("site", position=(9, 9, 9), quaternion=(np.sqrt(0.5), 0, 0, np.sqrt(0.5)))
    terrain = scene.add_terrain(field, frame=frame)
    for azimuth, elevation in ((0, 0), (75, 10), (200, -20), (-30, 89)):
        scene.sun.set(azimuth_deg=azimuth, elevation_deg=elevation, terrain=terrain)
        # The frame's X is the root's Y, and its Y the root's -X.
        np.testing.assert_allclose(scene.sun.direction, along(azimuth, elevation, (0, 1, 0), (-1, 0, 0), (0, 0, 1)),
                                   atol=1e-14)
        np.testing.assert_allclose(scene.sun.angles(terrain.name), (azimuth % 360, elevation), atol=1e-10)


@pytest.mark.parametrize("ellipsoid", [False, True], ids=["sphere", "WGS 84"])
def test_azimuth_and_elevation_on_a_body(scene, tmp_path, ellipsoid):
    body = scene.add_terrain(write_body(tmp_path / "body.tif", ellipsoid), name="body", on_body=True,
                             vertical_datum="ellipsoid" if ellipsoid else "sphere:1737400")
    for longitude, latitude in ((0.3, 0.2), (-77.5, 61.0), (179.7, -45.0), (30.0, -89.2)):
        lon, lat = np.radians(longitude), np.radians(latitude)  # geodetic: its normal is up
        up = (np.cos(lat) * np.cos(lon), np.cos(lat) * np.sin(lon), np.sin(lat))
        east = (-np.sin(lon), np.cos(lon), 0)
        north = np.cross(up, east)
        for azimuth, elevation in ((0, 0), (91.25, 1.5), (250, 45), (10, -30)):
            scene.sun.set(azimuth_deg=azimuth, elevation_deg=elevation, terrain="body", at=(longitude, latitude))
            np.testing.assert_allclose(scene.sun.direction, along(azimuth, elevation, east, north, up), atol=1e-9)
            np.testing.assert_allclose(scene.sun.angles(body, (longitude, latitude)), (azimuth, elevation), atol=1e-7)
    # Without a place: the middle of the raster, longitude and latitude 0.
    scene.sun.set(azimuth_deg=90, elevation_deg=60, terrain=body)
    np.testing.assert_allclose(scene.sun.direction, (np.sin(np.radians(60)), 0.5, 0), atol=1e-9)
    # A quarter round the body the same Sun is elsewhere.
    np.testing.assert_allclose(scene.sun.angles(body, (90, 0)), (270, 30), atol=1e-7)


def test_the_sun_turns_with_the_terrains_frame(scene, field):
    frame = scene.add_frame("planet")
    scene.sun.set(azimuth_deg=0, elevation_deg=0, terrain=scene.add_terrain(field, frame=frame))
    frame.quaternion = (np.sqrt(0.5), 0, 0, np.sqrt(0.5))
    np.testing.assert_allclose(scene.sun.direction, (-1, 0, 0), atol=1e-15)


def test_irradiance_and_distance(scene):
    scene.sun.distance_au = 1.5237  # Mars
    assert scene.sun.irradiance == pytest.approx(1361 / 1.5237**2, rel=1e-15)
    assert scene.sun.irradiance == pytest.approx(586.2, abs=0.05)  # NASA's fact sheet of Mars
    scene.sun.irradiance = 3.69  # at Neptune
    assert scene.sun.distance_au == pytest.approx(np.sqrt(1361 / 3.69), rel=1e-15)
    scene.sun.radius_deg = 0.0089
    assert scene.sun.radius_deg == 0.0089 and scene.sun.irradiance == pytest.approx(3.69, rel=1e-15)
    scene.lights["sun"].set(radius_deg=0.3, color=(1, 0, 0))
    assert scene.sun.radius_deg == 0.3
    scene.sun.irradiance = 100
    assert scene.lights["sun"].color == (1, 1, 1)


def test_a_white_surface_that_faces_it_at_one_au_shows_one(scene):
    """And by the square of the distance less, in linear light."""
    scene.add_plane(100, 100, color=(1, 1, 1), roughness=1.0, metallic=0.0)
    scene.add_camera(eye=(0, 0, 10), target=(0, 0, 0), up=(0, 1, 0))
    view = scene.add_viewport((8, 8), samples=1)
    view.fill = 0.0
    scene.sun.direction = (0, 0, 1)
    assert (view.image() == 255).all()
    for distance, cosine in ((2.0, 1.0), (1.5237, 0.5)):
        scene.sun.set(distance_au=distance, direction=(0, np.sqrt(1 - cosine**2), cosine))
        linear = cosine / distance**2
        shown = 255 * (1.055 * linear ** (1 / 2.4) - 0.055)
        assert np.abs(view.image() - shown).max() <= 0.75  # of bytes, and half floats
    scene.sun.set(azimuth_deg=90, elevation_deg=-10)  # night is drawn; planes have two sides, but no light comes through
    assert view.image().shape == (8, 8, 3)


def test_without_a_sun(scene):
    scene.lights["sun"].remove()
    with pytest.raises(dspace.NotFound, match="has no Sun"):
        scene.sun.direction
    assert repr(scene.sun) == "<dspace.Sun, none>"
    scene.sun.irradiance = 700
    np.testing.assert_allclose(scene.sun.direction, (-0.5, 0.5, np.sqrt(0.5)), atol=1e-15)
    scene.lights["sun"].set(kind="point")
    with pytest.raises(dspace.InvalidArgument, match="not directional.*give it the kind directional"):
        scene.sun.irradiance = 1


def test_bad_input(scene, field, refused, tmp_path):
    terrain = scene.add_terrain(field, name="field")
    with dspace.Session() as session:
        other = session.scene().add_terrain(field)
        with refused(dspace.InvalidArgument, "terrain is in another scene"):
            scene.sun.set(azimuth_deg=0, elevation_deg=0, terrain=other)
    for values, text in (
            (dict(direction=(0, 0, 0)), "the direction towards the Sun is (0, 0, 0); accepted: finite numbers"),
            (dict(direction=(0, np.nan, 1)), "nan"),
            (dict(direction=(np.inf, 0, 1)), "inf"),
            (dict(direction=(0, 1)), "3 numbers"),
            (dict(direction="up"), "3 numbers"),
            (dict(direction=(0, 0, 1), azimuth_deg=3, elevation_deg=3), "one of them"),
            (dict(azimuth_deg=3), "azimuth_deg is given alone"),
            (dict(elevation_deg=3), "elevation_deg is given alone"),
            (dict(azimuth_deg=3, elevation_deg=90.5), "elevation_deg is 90.5; accepted: -90 to 90"),
            (dict(azimuth_deg=3, elevation_deg=-91), "accepted: -90 to 90"),
            (dict(azimuth_deg=np.nan, elevation_deg=3), "accepted: -360 to 360"),
            (dict(azimuth_deg=3, elevation_deg=3, terrain=terrain, at=(0, 0)), "the place 0, 0 is off its data; "
             "accepted: map x, y from 100, 200 to 132, 232"),
            (dict(azimuth_deg=3, elevation_deg=3, at=(110, 210)), "a terrain with them"),
            (dict(azimuth_deg=3, elevation_deg=3, terrain="gale"), "no such terrain"),
            (dict(azimuth_deg=3, elevation_deg=3, terrain=7), "a dspace.Terrain or its name"),
            (dict(azimuth_deg=3, elevation_deg=3, terrain=terrain, at=5), "map x, y"),
            (dict(azimuth_deg=3, elevation_deg=3, terrain=terrain, frame=scene.add_frame("f")), "one of them"),
            (dict(terrain=terrain), "without angles"),
            (dict(frame="f"), "without a direction"),
            (dict(radius_deg=-1), "accepted: 0 to 90"),
            (dict(radius_deg=91), "accepted: 0 to 90"),
            (dict(irradiance=-1), "its irradiance is -1; accepted: 0 to 1.361e15 W/m^2"),
            (dict(irradiance=np.inf), "accepted: 0 to 1.361e15"),
            (dict(distance_au=0), "its distance is 0; accepted: 1e-6 to 1e12 au"),
            (dict(distance_au=-1), "accepted: 1e-6 to 1e12 au"),
            (dict(distance_au=1, irradiance=1361), "one of them"),
            (dict(irradiance="bright"), "a number"),
            (dict(brightness=1), "unknown keyword 'brightness'; accepted: direction, "),
            (dict(direction=(1, 0, 0), radius_deg=2, distance_au=-1), "accepted: 1e-6 to 1e12 au")):
        with refused(dspace.Error, text):
            scene.sun.set(**values)
    with pytest.raises(AttributeError, match="accepted: direction, distance_au, irradiance, radius_deg"):
        scene.sun.azimuth = 3


def test_relief_follows_the_sun_when_it_is_opened(scene, tmp_path):
    x, y = np.meshgrid(np.arange(40.0), np.arange(40.0))
    path = write_raster(tmp_path / "hills.tif", 3 * np.sin(x / 4) * np.cos(y / 5))

    def picture(**relief):
        terrain = scene.add_terrain(path, name="hills", relief=relief, lit=False)
        view = scene.add_viewport((60, 60), "above", samples=1)
        image = view.image().copy()
        view.remove()
        terrain.remove()
        return image

    scene.add_camera("above", eye=(0, 0, 100), target=(0, 0, 0), up=(0, 1, 0), height=36)
    plain = picture(sun_azimuth_deg=315, sun_elevation_deg=45)
    np.testing.assert_array_equal(picture(), plain)  # the default Sun, to the bit
    scene.sun.set(azimuth_deg=100, elevation_deg=20)
    low = picture(sun_azimuth_deg=100, sun_elevation_deg=20)
    assert np.abs(low.astype(int) - plain).max() > 40
    assert np.abs(picture().astype(int) - low).max() <= 1  # angles of a vector, to a rounding
    scene.sun.set(azimuth_deg=100, elevation_deg=-1)
    np.testing.assert_array_equal(picture(), plain)  # night
    scene.sun.set(azimuth_deg=100, elevation_deg=20)
    scene.lights["sun"].enabled = False
    np.testing.assert_array_equal(picture(), plain)


def drive(session, field):
    """A Sun that goes through a day. Returns what can be asked of it, and pictures, as bytes."""
    scene = session.scene()
    terrain = scene.add_terrain(field, name="field", color=(0.8, 0.7, 0.6))
    scene.add_camera(eye=(0, -30, 20), target=(0, 0, 0))
    view = scene.add_viewport((40, 30), name="view", samples=1)
    view.set(fill=0.1, exposure=1.5, tone="filmic", shadow_cascades=2, shadow_map_size=512, shadow_distance=40.0)
    out = []
    for step, elevation in enumerate((-10, 2, 40, 70)):
        scene.time = float(step)
        scene.sun.set(azimuth_deg=60 + 30 * step, elevation_deg=elevation, terrain=terrain, distance_au=1.38 + 0.1 * step)
        out += [repr((scene.sun.direction.tolist(), scene.sun.angles(terrain), scene.sun.irradiance)).encode(),
                view.image().tobytes()]
    return out


def test_recorded_and_served(tmp_path, field):
    path = tmp_path / "day.dspace"
    with dspace.Session() as session:
        with session.record(path):
            local = drive(session, field)
        assert len(set(local)) == len(local)
    with Served(tmp_path, "--allow-root", str(tmp_path)) as server:
        with dspace.connect(server.address) as session:
            assert drive(session, field) == local
    with dspace.Playback(path) as playback:
        for step in range(4):
            playback.seek(float(step))
            scene = playback.session.scenes["scene"]
            terrain = scene.terrains["field"]
            assert repr((scene.sun.direction.tolist(), scene.sun.angles(terrain),
                         scene.sun.irradiance)).encode() == local[2 * step]
            view = playback.session.viewports["view"]
            assert view.image().tobytes() == local[2 * step + 1]
            assert view.tone == "filmic"


def test_snapshots_of_before_that_set_or_removed_the_light_sky(session):
    for text in ("set_light { name: 'sky' kind: AMBIENT intensity: 0.25 }", "remove_light { name: 'sky' }"):
        from google.protobuf import text_format
        session.execute(text_format.Parse("create_scene {}", pb.Command(scene="old")))
        with pytest.warns(UserWarning, match="new scenes have no such light") if "remove" in text else _nothing():
            session.execute(text_format.Parse(text, pb.Command(scene="old")))
        scene = session.scene("old")
        assert set(scene.lights) == ({"sun"} if "remove" in text else {"sun", "sky"})
        scene.remove()


def _nothing():
    import contextlib
    return contextlib.nullcontext()
