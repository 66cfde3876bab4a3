"""Contacts by lines of sight: against closed forms of uniform motion past a wall, and directions on a sphere."""
import numpy as np
import pytest

import dspace
from dspace.trajectories import States
from terrain_support import gdal

R = 1737400.0  # [m] of the sphere


def passing(scene, rise=0.0):
    """A mast at the origin, a wall 50 m east of it from y = -5 to 5, and a craft that passes 100 m east of it along +Y with 1 m/s,
    from y = -50 at 0 s to 50 at 100 s; it climbs `rise` m/s."""
    mast = scene.add_frame("mast")
    wall = scene.add_frame("wall", position=(50.0, 0.0, 0.0))
    scene.add_box((0.01, 10.0, 100.0), name="wall", frame=wall)
    states = States([0.0, 100.0], [[100.0, -50.0, 0.0], [100.0, 50.0, 100.0 * rise]], [[0.0, 1.0, rise]] * 2)
    path = scene.add_trajectory(states, name="path")
    return mast, path.add_frame("craft")


def test_a_craft_behind_a_wall(scene):
    """The line crosses the wall's plane at half of the craft's y: it is blocked from y = -10 to 10, from 40 s to 60 s."""
    mast, craft = passing(scene)
    scene.time = 7.0
    found = scene.sight_contacts(mast, craft, 0.0, 100.0, step=7.0, precision=1e-4)
    assert scene.time == 7.0
    assert [(c.since_before, c.until_after) for c in found] == [(True, False), (False, True)]
    # The wall is 0.01 m thick: its eastern face counts at y / 2 = 5 (50.005 / 100 of the way).
    edge = 5.0 / 0.50005
    times = [found[0].rise.time, found[0].set.time, found[1].rise.time, found[1].set.time]
    assert times == pytest.approx([0.0, 50.0 - edge, 50.0 + edge, 100.0], abs=2e-4) or times == pytest.approx(
        [0.0, 40.0, 60.0, 100.0], abs=3e-3)
    assert found[0].set.azimuth_deg == pytest.approx(np.degrees(np.arctan2(100.0, -10.0)), abs=2e-3)
    assert found[0].set.range == pytest.approx(np.hypot(100.0, 10.0), abs=1e-3)
    assert found[0].target is craft and found[0].set.elevation_deg == pytest.approx(0.0, abs=1e-9)
    # Without the wall it is clear throughout.
    [whole] = scene.sight_contacts("mast", ["craft"], 0.0, 100.0, step=10.0, objects=False)
    assert whole.since_before and whole.until_after and whole.duration == 100.0 and whole.target == "craft"


def test_a_mask_and_the_peak(scene):
    """A craft that climbs 0.5 m/s while it passes: its elevation is that of t / 2 over hypot(100, t - 50)."""
    mast, craft = passing(scene, rise=0.5)
    t = np.linspace(0.0, 100.0, 1_000_001)
    elevation = np.degrees(np.arctan2(0.5 * t, np.hypot(100.0, t - 50.0)))
    [contact] = scene.sight_contacts(mast, craft, 0.0, 80.0, step=9.0, precision=1e-4, mask=10.0, objects=False)
    assert contact.rise.time == pytest.approx(t[np.argmax(elevation >= 10.0)], abs=3e-4)
    assert contact.rise.elevation_deg >= 10.0 and contact.until_after
    inside = elevation[t <= 80.0]
    assert contact.peak.elevation_deg == pytest.approx(inside.max(), abs=1e-6)
    # A mask by azimuth: 20 degrees south of east, nothing north of it.
    azimuths = np.arange(360.0)
    none = np.full(360, np.nan)
    line = dspace.Horizon(azimuths, np.where((azimuths > 90.0) & (azimuths < 180.0), 80.0, -80.0), none, np.full((360, 3), np.nan),
                          np.full(360, None), np.zeros(3), 0.0)
    [contact] = scene.sight_contacts(mast, craft, 0.0, 100.0, step=9.0, precision=1e-4, mask=line, objects=False)
    # Linear from 80 at 91 degrees to -80 at 90.
    azimuth = np.degrees(np.arctan2(100.0, t - 50.0)) % 360.0
    rise = t[np.argmax(elevation >= np.interp(azimuth, [90.0, 91.0], [-80.0, 80.0]))]
    assert contact.rise.time == pytest.approx(rise, abs=3e-4) and contact.until_after and 48.5 < rise < 49.5


def test_directions_on_a_sphere_are_from_the_meridians_north(scene, tmp_path):
    """Sites 0.05 degrees north and east of one on a smooth sphere that is turned in the scene: azimuths 0 and 90 (less half of the
    convergence), elevations by the chord below the horizontal."""
    path = tmp_path / "smooth.tif"
    data = gdal.GetDriverByName("GTiff").Create(str(path), 101, 101, 1, gdal.GDT_Float32)
    data.SetGeoTransform((9.0, 0.02, 0, 41.0, 0, -0.02))
    data.SetProjection(f'GEOGCS["moon",DATUM["moon",SPHEROID["moon",{R},0]],PRIMEM["Reference",0],UNIT["degree",0.0174532925199433]]')
    data.SetMetadataItem("VERTICAL_DATUM", "sphere")
    data.FlushCache()
    del data
    frame = scene.add_frame("moon", quaternion=(np.cos(0.7), 0.0, np.sin(0.7), 0.0), position=(1000.0, 2.0, 3.0))
    ground = scene.add_terrain(path, name="ground", frame=frame, on_body=True)
    start = ground.site(10.0, 40.0, height=100.0)
    ends = [ground.site(10.0, 40.05, height=100.0), ground.site(10.05, 40.0, height=100.0)]
    north, east = scene.sight_contacts(start, ends, 0.0, 10.0)
    dip = 0.05 / 2.0
    assert north.rise.azimuth_deg == pytest.approx(0.0, abs=1e-5) or north.rise.azimuth_deg == pytest.approx(360.0, abs=1e-5)
    assert north.rise.elevation_deg == pytest.approx(-dip, abs=1e-6)
    assert north.rise.range == pytest.approx(2.0 * (R + 100.0) * np.sin(np.radians(dip)), abs=1e-3)
    half = 0.025 * np.sin(np.radians(40.0))
    assert east.rise.azimuth_deg == pytest.approx(90.0 - half, abs=1e-5)
    assert east.rise.elevation_deg == pytest.approx(-dip * np.cos(np.radians(40.0)), abs=1e-6)


def test_a_recording_is_searched_from_step_to_step(scene, session, tmp_path):
    """What the simulation moved is where its steps have it: the craft is behind the wall from the step at 41 s to that at 59 s."""
    mast = scene.add_frame("mast")
    wall = scene.add_frame("wall", position=(50.0, 0.0, 0.0))
    scene.add_box((0.01, 10.0, 100.0), name="wall", frame=wall)
    craft = scene.add_frame("craft")
    with session.record(tmp_path / "run.dspace"):
        for t in np.arange(101.0):
            scene.time = t
            craft.position = (100.0, t - 49.5, 0.0)
    with dspace.Playback(tmp_path / "run.dspace") as playback:
        playback.seek(3.0)
        [played] = playback.session.scenes.values()
        found = played.sight_contacts("mast", "craft", 0.0, 100.0, step=7.0, playback=playback)
        assert playback.time == 3.0
        edges = [found[0].set.time, found[1].rise.time]
        assert edges == pytest.approx([40.0, 60.0], abs=0.02) and len(found) == 2
    assert mast.path == "mast"


def test_bad_spans_and_places_are_rejected(scene):
    mast, craft = passing(scene)
    scene.time = 3.0
    with pytest.raises(dspace.InvalidArgument, match="the span runs from 5.0 to 5.0 s; accepted: an end after the start"):
        scene.sight_contacts(mast, craft, 5.0, 5.0)
    with pytest.raises(dspace.InvalidArgument, match="the step is 0"):
        scene.sight_contacts(mast, craft, 0.0, 10.0, step=0.0)
    with pytest.raises(dspace.InvalidArgument, match="the step is 1e-06; accepted: above 0 s, and at most 100,000 steps"):
        scene.sight_contacts(mast, craft, 0.0, 10.0, step=1e-6)
    with pytest.raises(dspace.InvalidArgument, match="the mask is 91"):
        scene.sight_contacts(mast, craft, 0.0, 10.0, mask=91.0)
    with pytest.raises(dspace.NotFound, match="nothing"):
        scene.sight_contacts(mast, "nothing", 0.0, 10.0)
    with pytest.raises(dspace.Error, match="the start is"):
        scene.sight_contacts(None, craft, 0.0, 10.0)
    assert scene.time == 3.0
