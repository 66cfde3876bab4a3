"""Maps of horizons, viewsheds and illumination: against single measurements and against the sky, and what is rejected."""
import pathlib

import numpy as np
import pytest

import dspace
from terrain_support import gdal, write_georeferenced, write_raster

R = 1737400.0
SUN_RADIUS = 695700e3


def hills(rows=120, columns=130):
    y, x = np.mgrid[0:rows, 0:columns]
    return (6 * np.sin(0.13 * x) * np.cos(0.09 * y) + 2 * np.sin(0.5 * x + 0.4 * y) + 0.2 * ((7 * x + 3 * y) % 5)).astype(np.float32)


@pytest.fixture
def ground(scene, tmp_path):
    return scene.add_terrain(write_raster(tmp_path / "ground.tif", hills()), name="ground", pixel_size=1.0)


def test_horizons_of_cells(scene, ground, tmp_path):
    seen = []
    made = scene.horizon_map(ground, tmp_path / "map.tif", height=1.5, azimuths=16, extent=(20, 80, 60.5, 30), cell_size=2.0,
                             progress=lambda fraction, left: seen.append(fraction))
    assert (made.cell_size, len(made.bands), made.bands[1]) == (2.0, 16, "azimuth 22.5 deg") and seen[-1] == 1.0
    x0, dx, _, y0, _, dy = made.geotransform
    for column, row in ((0, 0), (3, 7), (made.columns - 1, made.rows - 1)):
        x, y = x0 + dx * (column + 0.5), y0 + dy * (row + 0.5)
        exact = scene.horizon(ground.site(x, y, 1.5), 16).elevation_deg
        assert made.horizon(column, row) == pytest.approx(exact, abs=1e-3)
        assert made.read(5)[row, column] == pytest.approx(exact[5], abs=1e-3)
    assert made.metadata["DSPACE_HEIGHT_M"] == "1.5" and made.metadata["DSPACE_TERRAIN_HASH"]


def test_interrupted_maps_continue(scene, ground, tmp_path):
    whole = scene.horizon_map(ground, tmp_path / "whole.tif", azimuths=240, threads=1)

    class Stop(Exception):
        pass

    def stop(fraction, left):
        raise Stop

    path = tmp_path / "map.tif"
    with pytest.raises(Stop):
        scene.horizon_map(ground, path, azimuths=240, threads=1, progress=stop)
    assert not path.exists()
    with pytest.raises(dspace.DeadlineExceeded, match="the same call continues it"):
        scene.horizon_map(ground, tmp_path / "late.tif", azimuths=3600, threads=1, deadline=0.01)
    if pathlib.Path(f"{path}.part").exists():
        with pytest.raises(dspace.AlreadyExists, match="other inputs"):
            scene.horizon_map(ground, path, azimuths=240, height=1.0)
    made = scene.horizon_map(ground, path, azimuths=240)
    assert pathlib.Path(made.path).read_bytes() == pathlib.Path(whole.path).read_bytes()
    with pytest.raises(dspace.AlreadyExists, match="it exists"):
        scene.horizon_map(ground, path, azimuths=240)
    assert len(scene.horizon_map(ground, path, azimuths=3, replace=True).bands) == 3
    assert [file.name for file in tmp_path.iterdir() if ".part" in file.name and "late" not in file.name] == []


def test_viewsheds_and_lines(scene, ground, tmp_path):
    sites = ground.site([31.2, 100.5], [40.7, 90.5], [2.0, 5.0])
    made = scene.viewshed(sites, tmp_path / "view.tif", target_height=0.5, quantities=("count", "least_height"))
    count, least = made.read("count"), made.read("least_height")
    rows, columns = np.mgrid[0:120:5, 0:130:5]
    x, y = columns + 0.5, 120 - rows - 0.5
    clear = sum(scene.line_of_sight(ground.site(*site), ground.site(x, y, 0.5), clearance=False).clear.astype(int)
                for site in ((31.2, 40.7, 2.0), (100.5, 90.5, 5.0)))
    sure = np.abs(least[rows, columns] - 0.5) > 1e-3
    # Where the lowest of two targets is far from the height, so is the other where none or one sees it.
    differ = (count[rows, columns] != clear) & sure
    assert differ.sum() <= 1 and (clear == 0).sum() > 20 and (clear > 0).sum() > 20
    near = scene.viewshed(ground.site(60.5, 60.5, 2.0), tmp_path / "near.tif", radius=10.0).read()
    assert np.isfinite(near).sum() == sum(1 for i in range(-10, 11) for j in range(-10, 11) if i * i + j * j <= 100)
    painted = scene.add_terrain(tmp_path / "ground.tif", name="painted", mode="clipmap")
    layer = painted.add_false_color(tmp_path / "near.tif", colors=[(0, 0, 0), (0, 1, 0)], low=0.0, high=1.0)
    assert layer.name


def test_a_painted_viewshed_shows_what_is_seen(scene, tmp_path):
    """Two sites west and east of a wall: what neither, one or both see by the closed form of its shadow, in a picture from above."""
    z = np.zeros((60, 90), np.float32)
    z[:, 45] = 10.0
    ground = scene.add_terrain(write_raster(tmp_path / "wall.tif", z), name="wall", mode="clipmap", origin=(0.0, 0.0))
    sites = ground.site([10.5, 69.5], [30.5, 30.5], [2.0, 18.0])
    seen = scene.viewshed(sites, tmp_path / "seen.tif", quantities=("count", "least_height"))
    ground.add_false_color(seen.path, colors=[(1, 0, 0), (0, 1, 0), (0, 0, 1)], low=0.0, high=2.0)
    camera = scene.add_camera(eye=(45.0, 30.0, 200.0), target=(45.0, 30.0, 0.0), up=(0, 1, 0), height=60.0)
    picture = scene.add_viewport(size=(900, 600), camera=camera).image()
    # The eastern site is 24 m from the crest and 8 m above it: beyond, 10 m below it, the ground is hidden for 30 m.
    count = np.zeros(90)
    count[:45] += 1  # the western site sees up to the wall
    count[46:] += 1
    count[:15] += 1  # 45 - 30
    for column in (5, 12, 18, 30, 40, 52, 80):
        assert (seen.read("count")[20:40, column] == count[column]).all()
        shown = picture[300, 10 * column + 5].astype(int)
        assert shown.argmax() == count[column] and shown.max() > 200 and np.sort(shown)[1] < 60, (column, shown)
    # A target 25 m west of the crest would be seen over it at 10 - 8 / 24 * 25 m; the western site sees all of it.
    alone = scene.viewshed(ground.site(69.5, 30.5, 18.0), tmp_path / "alone.tif", quantities="least_height").read()
    assert alone[29, 20] == pytest.approx(10.0 - 8.0 / 24.0 * 25.0, abs=0.01)


def seen_part(above, radius):
    x = np.clip(above / radius, -1.0, 1.0)
    return 1.0 - (np.arccos(x) - x * np.sqrt(1.0 - x * x)) / np.pi


def lit_by_hand(terrain, x, y, horizon, start, steps, step, turn=0.0):
    """Lit fraction, longest night and Earth's fraction of a cell, from Terrain.sky at every time."""
    parts, earth = [], []
    azimuths = np.arange(len(horizon)) * 360.0 / len(horizon)
    for k in range(steps):
        sky = terrain.sky(x, y, ["sun", "earth"], time=start + k * step)
        for name in ("sun", "earth"):
            azimuth = (sky[name].azimuth_deg + turn) % 360.0
            low, high = (np.interp((azimuth + d) % 360.0, azimuths, np.maximum(horizon, -90), period=360.0) for d in (-0.5, 0.5))
            floor = np.interp(azimuth, azimuths, horizon, period=360.0)
            slope = (high - low) / np.cos(np.radians(sky[name].elevation_deg))
            above = np.radians(sky[name].elevation_deg - floor) / np.hypot(1.0, slope)
            (parts.append(seen_part(above, np.radians(sky[name].radius_deg))) if name == "sun" else earth.append(above >= 0.0))
    night = longest = 0
    for part in parts:
        night = 0 if part > 0.0 else night + 1
        longest = max(longest, night)
    return np.mean(parts), longest * step, np.mean(earth)


def test_illumination_on_the_moon(scene, tmp_path):
    lat, lon = np.mgrid[-84.975:-86.0:-0.05, 10.025:12.0:0.05]
    z = (900 * np.sin(9 * np.radians(lon) * 12) * np.cos(11 * np.radians(lat) * 20)).astype(np.float32)
    moon = f'GEOGCS["Moon",DATUM["Moon",SPHEROID["Moon",{R},0]],PRIMEM["Reference",0],UNIT["degree",0.0174532925199433]]'
    path = write_georeferenced(tmp_path / "moon.tif", z, (10, 0.05, 0, -84.95, 0, -0.05), moon)
    terrain = scene.add_terrain(path, name="moon", on_body=True)
    horizons = scene.horizon_map(terrain, tmp_path / "horizons.tif", height=2.0, azimuths=120,
                                 extent=(10.5, -85.2, 10.9, -85.5))
    start, step, steps = scene.tdb("2026-01-03T00:00"), 6 * 3600.0, 110
    made = scene.illumination_map(horizons, tmp_path / "lit.tif", start=start, end=start + steps * step - 1.0, step=step,
                                  quantities=("lit_fraction", "longest_night", "earth_fraction", "permanent_shadow"),
                                  terrain=terrain)
    lit, night, earth, dark = (made.read(name) for name in made.bands)
    x0, dx, _, y0, _, dy = made.geotransform
    for column, row in ((0, 0), (4, 3), (made.columns - 1, made.rows - 1)):
        horizon = horizons.horizon(column, row).astype(float)
        mean, longest, seen = lit_by_hand(terrain, x0 + dx * (column + 0.5), y0 + dy * (row + 0.5), horizon, start, steps, step)
        assert 0.02 < mean < 0.98
        # The slope of a horizon between two azimuths, and its corner at one, are what differs.
        assert lit[row, column] == pytest.approx(mean, abs=2.0 / steps * 0.2)
        assert night[row, column] == pytest.approx(longest, abs=step)
        assert earth[row, column] == pytest.approx(seen, abs=1.1 / steps)
        assert dark[row, column] == 0.0
    assert lit.max() > lit.min() + 0.05
    with pytest.raises(dspace.InvalidArgument, match="other ground"):
        other = scene.add_terrain(write_georeferenced(tmp_path / "other.tif", z + 1, (10, 0.05, 0, -84.95, 0, -0.05), moon),
                                  name="other", on_body=True)
        scene.illumination_map(horizons, tmp_path / "no.tif", start=start, end=start + step, step=step, terrain=other)


def test_the_end_is_no_step_and_another_body_is_rejected(scene, tmp_path, refused):
    """Whole hours between two texts: TDB differs from them by microseconds. Places in the sky are warned of a body that the CRS does not
    tell."""
    moon = f'GEOGCS["Moon",DATUM["Moon",SPHEROID["Moon",{R},0]],PRIMEM["Reference",0],UNIT["degree",0.0174532925199433]]'
    path = write_georeferenced(tmp_path / "moon.tif", np.zeros((30, 30), np.float32), (170, 0.05, 0, 0.5, 0, -0.05), moon)
    terrain = scene.add_terrain(path, name="moon", on_body=True)
    horizons = scene.horizon_map(terrain, tmp_path / "horizons.tif", azimuths=4)
    night = scene.illumination_map(horizons, tmp_path / "night.tif", start="2022-11-08T08:00", end="2022-11-08T14:00",
                                   quantities=("longest_night",), terrain=terrain)
    assert night.metadata["DSPACE_STEPS"] == "6" and night.metadata["DSPACE_ECLIPSES"] == "yes"
    assert (night.read("longest_night") == 6 * 3600.0).all()  # the far side at full moon
    with refused(dspace.InvalidArgument, "it is a horizon map of body 'MOON', and the command names 'mars'"):
        scene.illumination_map(horizons, tmp_path / "mars.tif", start="2022-11-08T08:00", end="2022-11-08T10:00", body="mars")
    with pytest.warns(dspace.DspaceWarning, match="names body 'mars', and its CRS tells 'MOON'"):
        terrain.sky(170.5, 0.2, "sun", body="mars")
    sky = scene.sky("sun", body="moon", site=(170.5, 0.2), time="2022-11-08T08:00")["sun"]
    assert sky.elevation_deg < -60.0
    assert sky == scene.sky("sun", body="moon", site=(170.5, 0.2, 0.0), time=scene.tdb("2022-11-08T08:00"))["sun"]


@pytest.mark.parametrize("on_body", (False, True), ids=("plane", "body"))
def test_illumination_on_a_polar_map(scene, tmp_path, on_body):
    """A south polar stereographic map, whose Y axis is not north: the wall in the west of the map hides the Sun in time."""
    z = np.zeros((60, 60), np.float32)
    z[:, :5] = 3000.0
    polar = (f'PROJCS["p",GEOGCS["Moon",DATUM["Moon",SPHEROID["Moon",{R},0]],PRIMEM["Reference",0],UNIT["degree",'
             '0.0174532925199433]],PROJECTION["Polar_Stereographic"],PARAMETER["latitude_of_origin",-90],'
             'PARAMETER["central_meridian",0],PARAMETER["false_easting",0],PARAMETER["false_northing",0],UNIT["metre",1]]')
    path = write_georeferenced(tmp_path / "polar.tif", z, (90000, 500, 0, 75000, 0, -500), polar)
    terrain = scene.add_terrain(path, name="polar", on_body=on_body)
    horizons = scene.horizon_map(terrain, tmp_path / "horizons.tif", height=2.0, azimuths=360)
    start, step, steps = scene.tdb("2026-01-03T00:00"), 6 * 3600.0, 110
    made = scene.illumination_map(horizons, tmp_path / "lit.tif", start=start, end=start + (steps - 0.5) * step, step=step,
                                  quantities=("lit_fraction", "earth_fraction"))
    x, y = 90000 + 500 * 30.0, 75000 - 500 * 30.0  # the middle, between cells 29 and 30
    turn = np.degrees(np.arctan2(x, y))  # north leads away from the pole
    assert (turn + horizons.first_deg(30, 30)) % 360 == pytest.approx(360.0, abs=0.5)
    horizon = horizons.horizon(30, 30).astype(float)
    horizon = horizon if on_body else np.maximum(horizon, 0.0)
    mean, _, seen = lit_by_hand(terrain, x, y, horizon, start, steps, step, turn)
    assert 0.1 < mean < 0.9
    assert made.read(0)[30, 30] == pytest.approx(mean, abs=0.004)
    assert made.read(1)[30, 30] == pytest.approx(seen, abs=0.01)
    wrong, _, _ = lit_by_hand(terrain, x, y, horizon, start, steps, step, turn + 60.0)
    assert abs(wrong - mean) > 0.008  # the direction of the wall matters


def test_a_polar_raster_on_its_body(scene, tmp_path):
    """A plateau around the pole that begins 20 km from it: seen from 2 km beside the pole its edge stands at the elevation of its
    geometry on the sphere, over the raster itself and resampled to degrees. On a plane it does not."""
    x = (np.arange(800) - 399.5) * 100.0
    away = 2.0 * np.degrees(np.arctan(np.hypot(x[None, :], x[:, None]) / (2.0 * R)))  # from the pole
    edge = np.degrees(20_000.0 / R)
    z = np.where(away < edge, 0.0, 1500.0).astype(np.float32)
    polar = (f'PROJCS["p",GEOGCS["Moon",DATUM["Moon",SPHEROID["Moon",{R},0]],PRIMEM["Reference",0],UNIT["degree",'
             '0.0174532925199433]],PROJECTION["Polar_Stereographic"],PARAMETER["latitude_of_origin",-90],'
             'PARAMETER["central_meridian",0],PARAMETER["false_easting",0],PARAMETER["false_northing",0],UNIT["metre",1]]')
    path = write_georeferenced(tmp_path / "polar.tif", z, (-40000, 100, 0, 40000, 0, -100), polar)
    step = 0.0025
    gdal.Warp(str(tmp_path / "degrees.tif"), str(path), dstSRS=f"+proj=longlat +R={R} +no_defs", outputBounds=(-180, -90, 180, -89),
              xRes=0.5, yRes=step, resampleAlg="bilinear")
    body = scene.add_terrain(tmp_path / "degrees.tif", name="body", on_body=True, vertical_datum="sphere")
    site = np.degrees(2_000.0 / R)
    made = scene.horizon_map(body, tmp_path / "body.tif", azimuths=4, height=0.0,
                             extent=(0.0, -90.0 + site + step, 0.6, -90.0 + site - step))
    # South leads over the pole, north away from it.
    stated = []
    for azimuth, arc in ((180.0, edge + site), (0.0, edge - site)):
        t = np.radians(arc)
        stated.append((azimuth, np.degrees(np.arctan2((R + 1500.0) * np.cos(t) - R, (R + 1500.0) * np.sin(t)))))
    found = made.horizon(0, made.rows // 2)
    x0, dx, _, y0, _, dy = made.geotransform
    assert y0 + dy * (made.rows // 2 + 0.5) == pytest.approx(-90.0 + site, abs=step)
    for azimuth, elevation in stated:
        assert found[round(azimuth / 90.0)] == pytest.approx(elevation, abs=0.06)  # resampling slopes the edge over two cells, 150 m
    # The raster itself, whose Y axis leads from the pole through the site.
    itself = scene.add_terrain(path, name="itself", on_body=True)
    made = scene.horizon_map(itself, tmp_path / "itself.tif", azimuths=4, height=0.0, extent=(0.0, 2100.0, 100.0, 1900.0))
    assert (made.columns, made.rows) == (1, 2)
    assert made.first_deg(0, 0) == pytest.approx(360.0 - np.degrees(np.arctan2(50.0, 2050.0)), abs=0.01)  # north leads from the pole
    found = 0.5 * (made.horizon(0, 0) + made.horizon(0, 1))
    single = scene.horizon(itself.site(50.0, 2050.0), azimuths=360)
    for azimuth, elevation in stated:
        assert found[round(azimuth / 90.0)] == pytest.approx(elevation, abs=0.03)
        assert single.elevation_deg[round(azimuth)] == pytest.approx(elevation, abs=0.03)
    flat = scene.horizon(scene.add_terrain(path, name="plane", mode="clipmap").site(50.0, 2000.0), 4)
    assert abs(flat.elevation_deg[2] - stated[0][1]) > 0.2


def test_fast_horizon_maps(scene, ground, tmp_path, refused):
    exact = scene.horizon_map(ground, tmp_path / "exact.tif", azimuths=8, height=2.0)
    fast = scene.horizon_map(ground, tmp_path / "fast.tif", azimuths=8, height=2.0, fast=True)
    assert (exact.metadata["DSPACE_FAST"], fast.metadata["DSPACE_FAST"]) == ("no", "yes")
    errors = np.abs([exact.read(band) - fast.read(band) for band in exact.bands])
    assert np.nanmedian(errors) < 0.05 < np.nanmax(errors)  # of ground much steeper than half a degree is promised for: TestHorizonMap has that
    with refused(dspace.WrongType, "fast is 1"):
        scene.horizon_map(ground, tmp_path / "x.tif", fast=1)


@pytest.mark.parametrize("change, kind, text", [
    ({"height": -1.0}, dspace.InvalidArgument, "height is -1"),
    ({"azimuths": 0}, dspace.InvalidArgument, "azimuths is 0; accepted: 1 to 3600"),
    ({"azimuths": 4000}, dspace.InvalidArgument, "azimuths is 4000"),
    ({"path": "map.png"}, dspace.InvalidArgument, "the path is 'map.png'; accepted: a GeoTIFF"),
    ({"extent": (1.0, 2.0)}, dspace.InvalidArgument, "left, top, right, bottom"),
    ({"extent": (500.0, 600.0, 510.0, 590.0)}, dspace.InvalidArgument, "no cell of the map lies on its data"),
    ({"cell_size": 100.0}, dspace.InvalidArgument, "accepted: up to 64"),
    ({"cell_size": 0.4}, dspace.InvalidArgument, "its posts are 1 apart; accepted: that or more, or 0"),
    ({"terrain": "none"}, dspace.NotFound, "terrain 'none'"),
    ({"terrain": 3}, dspace.WrongType, "the terrain is 3"),
    ({"progress": 3}, dspace.WrongType, "progress is 3"),
    ({"deadline": 0.0}, dspace.InvalidArgument, "deadline is 0"),
    ({"threads": 257}, dspace.InvalidArgument, "threads is 257"),
    ({"replace": None}, dspace.WrongType, "replace is None"),
])
def test_rejected_horizon_maps(scene, ground, tmp_path, refused, change, kind, text):
    good = {"terrain": ground, "path": tmp_path / "map.tif", "azimuths": 4}
    with refused(kind, text):
        scene.horizon_map(**{**good, **change})
    assert not list(tmp_path.glob("map*"))


def test_other_rejected_maps(scene, ground, tmp_path, refused):
    with refused(dspace.WrongType, "sites is 'here'"):
        scene.viewshed("here", tmp_path / "view.tif")
    with refused(dspace.InvalidArgument, "the terrain has no data there"):
        scene.viewshed(ground.site(500.0, 20.0), tmp_path / "view.tif")
    with refused(dspace.InvalidArgument, "a quantity is 'seen'; accepted: visible, least_height, count"):
        scene.viewshed(ground.site(20.0, 20.0), tmp_path / "view.tif", quantities="seen")
    with refused(dspace.InvalidArgument, "radius is 0"):
        scene.viewshed(ground.site(20.0, 20.0), tmp_path / "view.tif", radius=0.0)
    with refused(dspace.NotFound, "there is no such file"):
        scene.illumination_map(tmp_path / "none.tif", tmp_path / "lit.tif", start=0.0, end=1.0)
    horizons = scene.horizon_map(ground, tmp_path / "map.tif", azimuths=4)
    with refused(dspace.InvalidArgument, "accepted: start and end, or sun"):
        scene.illumination_map(horizons, tmp_path / "lit.tif")
    with refused(dspace.InvalidArgument, "the span from the start to the end is 0"):
        scene.illumination_map(horizons, tmp_path / "lit.tif", start=1.0, end=1.0)
    with refused(dspace.Unsupported, "no longitudes and latitudes"):
        scene.illumination_map(horizons, tmp_path / "lit.tif", start=0.0, end=3600.0, body="moon")
    with refused(dspace.InvalidArgument, "the Earth has 0 places"):
        scene.illumination_map(horizons, tmp_path / "lit.tif", sun=[(1e11, 0, 0)], quantities="earth_fraction")
    with refused(dspace.InvalidArgument, "positions of the Earth without those of the Sun"):
        scene.illumination_map(horizons, tmp_path / "lit.tif", start=0.0, end=3600.0, earth=[(4e8, 0, 0)])
    with refused(dspace.Corrupt, "no horizon map"):
        scene.illumination_map(tmp_path / "ground.tif", tmp_path / "lit.tif", sun=[(1e11, 0, 0)])
    lit = scene.illumination_map(horizons, tmp_path / "lit.tif", sun=[(1e11, 0, 9e10), (0, 1e11, -1e9)])
    assert lit.read("lit_fraction") == pytest.approx(np.full((120, 130), 0.5), abs=0.5)


def test_areas_of_cells(scene, tmp_path):
    """Cells of a degree grid by the closed form of a sphere; those of a polar stereographic map by its scale at each latitude."""
    moon = f'GEOGCS["Moon",DATUM["Moon",SPHEROID["Moon",{R},0]],PRIMEM["Reference",0],UNIT["degree",0.0174532925199433]]'
    path = write_georeferenced(tmp_path / "moon.tif", np.zeros((40, 30), np.float32), (10, 0.5, 0, 85.0, 0, -0.5), moon)
    degrees = scene.horizon_map(scene.add_terrain(path, name="degrees", on_body=True), tmp_path / "degrees_h.tif", azimuths=4)
    step = -degrees.geotransform[5]
    north = np.radians(degrees.geotransform[3] - step * np.arange(degrees.rows + 1))
    bands = R**2 * np.radians(step) * -np.diff(np.sin(north))
    np.testing.assert_allclose(degrees.areas(), np.repeat(bands[:, None], degrees.columns, axis=1), rtol=1e-4)
    polar = (f'PROJCS["p",{moon},PROJECTION["Polar_Stereographic"],PARAMETER["latitude_of_origin",-90],'
             'PARAMETER["central_meridian",0],PARAMETER["false_easting",0],PARAMETER["false_northing",0],UNIT["metre",1]]')
    path = write_georeferenced(tmp_path / "polar.tif", np.zeros((60, 80), np.float32), (-30000, 1000, 0, 40000, 0, -1000), polar)
    made = scene.horizon_map(scene.add_terrain(path, name="polar", on_body=True), tmp_path / "polar_h.tif", azimuths=4)
    x0, size, _, y0, _, _ = made.geotransform
    x, y = np.meshgrid(x0 + size * (np.arange(made.columns) + 0.5), y0 - size * (np.arange(made.rows) + 0.5))
    scale = 1.0 + (x**2 + y**2) / (4.0 * R**2)  # rho = 2 R tan(c / 2): k = 1 / cos(c / 2)^2
    np.testing.assert_allclose(made.areas(), size**2 / scale**2, rtol=1e-5)
    lit = scene.illumination_map(made, tmp_path / "lit.tif", sun=[(0.0, 0.0, 1.5e11)], quantities="permanent_shadow")
    assert np.nansum(lit.areas() * lit.read(0)) == pytest.approx((size**2 / scale**2).sum(), rel=1e-5)
