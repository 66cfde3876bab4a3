"""The best-lit sites: against every cell by brute force, with exact horizons, and what is rejected."""
import dataclasses
import math

import numpy as np
import pytest

import dspace
from command_support import R, write_moon
from dspace.measure.best_sites import extent_around
from needs import needs_module
from terrain_support import gdal, write_raster

SUN = 1.496e11
DISC = 695700e3


def hills(rows, columns, seed=3):
    random = np.random.default_rng(seed)
    y, x = np.mgrid[0:rows, 0:columns]
    z = sum(a * np.sin(2 * np.pi * (x * u + y * v) + p) for a, u, v, p in zip(
        (6, 4, 2, 1.5), random.uniform(0.01, 0.12, 4), random.uniform(-0.12, 0.12, 4), random.uniform(0, 6, 4)))
    return z.astype(np.float32)


def suns(count=48):
    """A Sun that goes around low, in steps that meet no azimuth of a map."""
    azimuth = np.radians(np.arange(count) * 360.0 / count + 1.3)
    elevation = np.radians(3.0 + 4.0 * np.sin(3.0 * azimuth))
    return SUN * np.column_stack((np.sin(azimuth) * np.cos(elevation), np.cos(azimuth) * np.cos(elevation), np.sin(elevation)))


def lit_by_hand(horizon, places):
    """Lit fraction and longest run of dark steps, of a disc over a horizon by azimuth."""
    azimuths = np.arange(len(horizon)) * 360.0 / len(horizon)
    parts = []
    for east, north, up in places:
        azimuth = np.degrees(np.arctan2(east, north)) % 360.0
        floor = np.interp(azimuth, azimuths, np.maximum(horizon, 0.0), period=360.0)
        radius = np.arcsin(DISC / SUN)
        above = np.radians(np.degrees(np.arctan2(up, np.hypot(east, north))) - floor)
        step = 360.0 / len(horizon)
        low, high = (np.interp(side, azimuths, np.maximum(horizon, 0.0), period=360.0)
                     for side in (azimuth // step * step, (azimuth // step + 1) * step % 360.0))
        above /= np.hypot(1.0, np.radians(high - low) / np.radians(step) / np.cos(np.arctan2(up, np.hypot(east, north))))
        x = np.clip(above / radius, -1.0, 1.0)
        parts.append(1.0 - (np.arccos(x) - x * np.sqrt(1.0 - x * x)) / np.pi)
    run = longest = 0
    for part in parts:
        run = 0 if part > 0.0 else run + 1
        longest = max(longest, run)
    return np.mean(parts), longest


@pytest.fixture
def maps(scene, tmp_path):
    """Maps of two masts over hills."""
    ground = scene.add_terrain(write_raster(tmp_path / "ground.tif", hills(40, 44), 10.0), name="ground")
    made = []
    for mast in (2.0, 8.0):
        horizons = scene.horizon_map(ground, tmp_path / f"horizons_{mast:g}.tif", height=mast, azimuths=72)
        made.append(scene.illumination_map(horizons, tmp_path / f"lit_{mast:g}.tif", sun=suns(), step=600.0,
                                           quantities=("lit_fraction", "longest_night")))
    return ground, made


def test_against_exact_horizons_of_every_cell(scene, maps):
    """Single horizons by rays, light by hand, and a greedy choice in plain Python."""
    ground, made = maps
    center, radius, apart = (221.0, 204.0), 72.0, 35.0
    cells = []
    for column in range(44):
        for row in range(40):
            x, y = 10.0 * column + 5.0, 400.0 - 10.0 * row - 5.0
            if math.hypot(x - center[0], y - center[1]) <= radius:
                horizon = scene.horizon(ground.site(x, y, 8.0), 72).elevation_deg
                cells.append((*lit_by_hand(horizon, suns()), x, y))
    assert 120 < len(cells) < 200
    found = scene.best_sites(ground, made[1], center=center, radius=radius, apart=apart, count=6)
    left = sorted(cells, key=lambda cell: -cell[0])
    for site in found:
        best = left[0]
        mine = next(cell for cell in cells if cell[2:] == pytest.approx((site.x, site.y)))
        # Of two that are equal within the accuracy of maps either may be first.
        assert mine[0] == pytest.approx(best[0], abs=2e-3) and mine in left
        assert site.lit_fraction == pytest.approx(mine[0], abs=2e-3)
        assert site.longest_night == pytest.approx(600.0 * mine[1], abs=600.0)
        assert site.distance == pytest.approx(math.hypot(site.x - center[0], site.y - center[1]))
        left = [cell for cell in left if math.hypot(cell[2] - site.x, cell[3] - site.y) >= apart]
    assert [site.rank for site in found] == [1, 2, 3, 4, 5, 6][:len(found)] and len(found) >= 4
    assert found[0].lit_fraction > np.mean([cell[0] for cell in cells]) + 0.05


def test_a_greedy_choice_has_its_properties(scene, maps):
    """No cell that is better than a taken one is far from all that were taken before it; limits hold; masts come in turn."""
    ground, made = maps
    limits = dict(center=(200.0, 220.0), radius=150.0, apart=42.0, most_slope=12.0)
    found = scene.best_sites("ground", [each.path for each in made], count=50, **limits)
    heights = ground.height(*np.meshgrid(np.arange(44) * 10.0 + 5.0, 395.0 - np.arange(40) * 10.0), map=True)
    slope = np.full(heights.shape, np.nan)
    slope[1:-1, 1:-1] = np.degrees(np.arctan(np.hypot((heights[1:-1, 2:] - heights[1:-1, :-2]) / 20.0,
                                                      (heights[2:, 1:-1] - heights[:-2, 1:-1]) / 20.0)))
    for mast, each in zip((2.0, 8.0), made):
        mine = [site for site in found if site.mast == mast]
        lit, night = each.read("lit_fraction"), each.read("longest_night")
        assert len(mine) > 5 and [site.rank for site in mine] == list(range(1, len(mine) + 1))
        for a in mine:
            row, column = round((395.0 - a.y) / 10.0), round((a.x - 5.0) / 10.0)
            assert (a.lit_fraction, a.longest_night) == (lit[row, column], night[row, column])
            assert a.slope_deg == pytest.approx(slope[row, column], abs=1e-4) and a.slope_deg <= 12.0
            assert a.ground == pytest.approx(heights[row, column])
        for row in range(1, 39):
            for column in range(1, 43):
                x, y = 10.0 * column + 5.0, 395.0 - 10.0 * row
                if math.hypot(x - 200.0, y - 220.0) > 150.0 or slope[row, column] > 12.0:
                    continue
                key = (-lit[row, column], night[row, column])
                near = [site for site in mine if math.hypot(site.x - x, site.y - y) < 42.0]
                assert near and min((-site.lit_fraction, site.longest_night) for site in near) <= key
        assert min(math.dist((a.x, a.y), (b.x, b.y)) for a in mine for b in mine if a is not b) >= 42.0
    assert [site.mast for site in found] == sorted(site.mast for site in found)
    by_night = scene.best_sites(ground, made[0], order="longest_night", count=50, **limits)
    assert [site.longest_night for site in by_night] == sorted(site.longest_night for site in by_night)
    assert by_night != [site for site in found if site.mast == 2.0]
    few = scene.best_sites(ground, made[0], center=(200.0, 220.0), radius=150.0, least_lit=found[0].lit_fraction, count=50)
    assert few and all(site.lit_fraction >= found[0].lit_fraction for site in few)


def test_on_a_body_distances_run_around_it(scene, tmp_path):
    z = np.zeros((24, 40), np.float32)
    z[12, 30] = 800.0
    ground = scene.add_terrain(write_moon(tmp_path / "moon.tif", z, 10.0, -80.0, 0.05), name="moon", on_body=True)
    horizons = scene.horizon_map(ground, tmp_path / "horizons.tif", height=2.0, azimuths=36)
    sun = SUN * np.array([[math.cos(a) * 0.99, math.sin(a) * 0.99, -0.141] for a in np.radians(np.arange(0.0, 360.0, 10.0))])
    made = scene.illumination_map(horizons, tmp_path / "lit.tif", sun=sun)
    found = scene.best_sites(ground, made, center=(11.5, -80.6), radius=4000.0)
    assert (found[0].x, found[0].y) == pytest.approx((11.525, -80.625)) and found[0].ground == pytest.approx(800.0)
    assert found[0].longest_night is None
    a, b = (np.array([math.cos(lat) * math.cos(lon), math.cos(lat) * math.sin(lon), math.sin(lat)])
            for lon, lat in np.radians([(11.525, -80.625), (11.5, -80.6)]))
    assert found[0].distance == pytest.approx(R * math.acos(a @ b), rel=1e-6)
    # The eastern neighbour's differences span 0.1 degrees of longitude.
    east = [site for site in scene.best_sites(ground, made, center=(11.575, -80.625), radius=10.0)]
    assert len(east) == 1
    across = 0.1 * math.pi / 180.0 * R * math.cos(math.radians(80.625))
    assert east[0].slope_deg == pytest.approx(math.degrees(math.atan(800.0 / across)), rel=1e-5)


@pytest.mark.parametrize("projection, transform, center", [
    ("+proj=stere +lat_0=-90 +lon_0=25", (-8000, 200, 0, 9000, 0, -200), (1200.0, -900.0)),
    ("+proj=stere +lat_0=90 +k=0.9", (200000, 200, 0, -150000, 0, -200), (208000.0, -158000.0)),
    ("+proj=eqc +lat_ts=60", (100000, 200, 0, 1800000, 0, -200), (108000.0, 1791000.0)),
    ("+proj=longlat", (10, 0.01, 0, 60, 0, -0.01), (10.4, 59.6))], ids=("south", "north", "equidistant", "degrees"))
def test_the_extent_of_a_circle_on_a_body(scene, tmp_path, projection, transform, center):
    """Against map places at the radius from the middle, by PROJ."""
    osr = needs_module("osgeo.osr", "python3-gdal")
    srs = osr.SpatialReference()
    srs.ImportFromProj4(f"{projection} +R={R} +no_defs")
    path = write_raster(tmp_path / "body.tif", np.zeros((80, 80), np.float32))
    data = gdal.Open(str(path), gdal.GA_Update)
    data.SetProjection(srs.ExportToWkt())
    data.SetGeoTransform(transform)
    data.SetMetadataItem("VERTICAL_DATUM", "sphere")
    data = None
    terrain = scene.add_terrain(path, on_body=True)
    radius = 3000.0
    left, top, right, bottom = extent_around(terrain, center, radius)
    degrees = srs.CloneGeogCS()
    for each in (srs, degrees):
        each.SetAxisMappingStrategy(osr.OAMS_TRADITIONAL_GIS_ORDER)
    x, y = np.meshgrid(*(c + np.linspace(-1.2, 1.2, 601) * h for c, h in zip(center, (0.5 * (right - left), 0.5 * (top - bottom)))))
    places = np.column_stack((x.ravel(), y.ravel()))
    lon, lat = np.radians(np.array(osr.CoordinateTransformation(srs, degrees).TransformPoints(places))[:, :2].T)
    lon0, lat0, _ = np.radians(osr.CoordinateTransformation(srs, degrees).TransformPoint(*center))
    away = 2.0 * R * np.arcsin(np.sqrt(np.sin(0.5 * (lat - lat0)) ** 2 + np.cos(lat) * np.cos(lat0) * np.sin(0.5 * (lon - lon0)) ** 2))
    inside = places[away <= radius]
    for given, exact, half in ((left, inside[:, 0].min(), left - center[0]), (right, inside[:, 0].max(), right - center[0]),
                               (bottom, inside[:, 1].min(), bottom - center[1]), (top, inside[:, 1].max(), top - center[1])):
        assert 0.98 < (exact - given) / half + 1.0 <= 1.0 + 1e-9


def test_rejected(scene, maps, tmp_path, refused):
    ground, made = maps
    good = dict(terrain=ground, maps=made[0], center=(200.0, 200.0), radius=50.0)
    for change, kind, text in (
            ({"radius": 0.0}, dspace.InvalidArgument, "radius is 0.0; accepted: a finite number of metres, above 0"),
            ({"apart": -1.0}, dspace.InvalidArgument, "apart is -1"),
            ({"count": 0}, dspace.InvalidArgument, "count is 0; accepted: 1 to 10000"),
            ({"center": (1.0,)}, dspace.InvalidArgument, "the center is"),
            ({"center": (5000.0, 5000.0)}, dspace.InvalidArgument, "no cell with ground within 50 m of 5000, 5000"),
            ({"order": "best"}, dspace.InvalidArgument, "the order is 'best'; accepted: 'lit_fraction', 'longest_night'"),
            ({"terrain": "none"}, dspace.NotFound, "terrain 'none'"),
            ({"maps": []}, dspace.InvalidArgument, "accepted: one or more"),
            ({"maps": tmp_path / "none.tif"}, dspace.NotFound, "there is no such file"),
            ({"maps": tmp_path / "ground.tif"}, dspace.Corrupt, "no map of Dspace"),
            ({"maps": tmp_path / "horizons_2.tif"}, dspace.InvalidArgument, "'horizon map'; accepted: an illumination map")):
        with refused(kind, text):
            scene.best_sites(**{**good, **change})
    lit = scene.illumination_map(tmp_path / "horizons_2.tif", tmp_path / "part.tif", sun=suns(), quantities="lit_fraction")
    with refused(dspace.InvalidArgument, "lacks the quantity 'longest_night'"):
        scene.best_sites(**{**good, "maps": lit, "most_night": 3600.0})
    assert dataclasses.asdict(scene.best_sites(**{**good, "maps": lit})[0])["longest_night"] is None


def test_the_command(capsys, tmp_path):
    import json
    from command_support import run
    needs_module("matplotlib", "python3-matplotlib")
    z = (600.0 * np.random.default_rng(4).random((20, 30))).astype(np.float32)
    moon = write_moon(tmp_path / "moon.tif", z, 10, -84, 0.05)
    (tmp_path / "maps").mkdir()
    command = ("sites", "--terrain", moon, "--site", "10.7,-84.5", "--radius", 6000, "--mast", 2, "--mast", 20, "--from", "2026-01-03",
               "--to", "2026-02-01", "--step", 21600, "--azimuths", 36, "--apart", 2000, "--count", 4, "--maps", tmp_path / "maps", "--quiet")
    code, text, err = run(capsys, *command, "--out", tmp_path / "sites.csv", "--json")
    assert code == 0, err
    sites = json.loads(text)["sites"]
    assert [site["mast_m"] for site in sites].count(2.0) == 4 and sites[0]["rank"] == 1
    assert max(site["distance_m"] for site in sites) <= 6000.0
    with dspace.Session() as session:
        scene = session.scene()
        ground = scene.add_terrain(moon, on_body=True, mode="clipmap")
        found = scene.best_sites(ground, [tmp_path / "maps" / f"lit_{mast}m.tif" for mast in (2, 20)], center=(10.7, -84.5), radius=6000.0,
                                 apart=2000.0, count=4)
    assert [(site["lon_deg"], site["lat_deg"], site["lit_fraction"]) for site in sites] == [
        pytest.approx((site.x, site.y, site.lit_fraction)) for site in found]
    lines = (tmp_path / "sites.csv").read_text().splitlines()
    assert lines[0].startswith("mast_m,rank,lon_deg,lat_deg") and len(lines) == 1 + len(sites)
    before = {path.name: path.stat().st_mtime_ns for path in (tmp_path / "maps").glob("horizons*")}
    code, text, err = run(capsys, *command, "--out", tmp_path / "sites.png")  # with the maps that are there
    assert code == 0 and "mast 20 m, 1: " in text, err
    assert before == {path.name: path.stat().st_mtime_ns for path in (tmp_path / "maps").glob("horizons*")} and len(before) == 2
    assert (tmp_path / "sites.png").read_bytes().startswith(b"\x89PNG")
    (tmp_path / "maps" / "options.json").rename(tmp_path / "options.json")
    code, _, err = run(capsys, *command)  # as maps of a version that did not keep them
    assert code == 1 and "options.json, which tells how its maps were made, is not there" in err, err
    (tmp_path / "options.json").rename(tmp_path / "maps" / "options.json")
    for words, text in ((("--radius", 0), "--radius 0.0"), (("--maps", tmp_path / "none"), "accepted: a folder that exists"),
                        (("--azimuths", 12), "--azimuths is 12, and its maps were made with 36"), (("--cell-size", 0.1), "--cell-size is 0.1"),
                        (("--site", "10.8,-84.5"), "the extent of --site and --radius is"), (("--fast",), "--fast is True"),
                        (("--most-slope", -1), "no cell satisfies the limits"), (("--out", "a.tif"), "accepted: a name with .json")):
        code, _, err = run(capsys, *command, *words)
        assert code == 1 and text in err, err
