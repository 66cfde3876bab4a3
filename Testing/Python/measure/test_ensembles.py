"""Ensembles over perturbed terrains: the variogram of the errors, light whose probability has a closed form, and resumption."""
import math
import os
import pathlib
import signal
import subprocess
import sys

import numpy as np
import pytest

import dspace
from command_support import R, run, write_moon
from terrain_support import gdal, write_raster

SUN = 1.496e11


def variogram_of(fields, spacing, lag):
    """By pairs of posts `lag` = (rows, columns) apart, over fields (n, rows, columns): the distance and the mean of half the squared
    differences of each field."""
    j, i = lag
    a, b = fields[:, j:, i:], fields[:, :fields.shape[1] - j, :fields.shape[2] - i]
    return math.hypot(j * spacing[0], i * spacing[1]), 0.5 * ((a - b) ** 2).mean(axis=(1, 2))


@pytest.mark.parametrize("model, nugget", [("exponential", 0.0), ("exponential", 0.4), ("gaussian", 0.0)])
def test_fields_have_the_stated_variogram(model, nugget):
    variogram = dspace.Variogram(1.5, 60.0, model, nugget)
    spacing = (10.0, 14.0)
    fields = np.stack([variogram.field((90, 70), spacing, np.random.default_rng([7, k])) for k in range(300)])
    for lag in ((1, 0), (0, 1), (3, 2), (6, 0), (0, 8), (20, 20), (80, 5)):
        distance, found = variogram_of(fields, spacing, lag)
        correlation = math.exp(-distance / 60.0) if model == "exponential" else math.exp(-(distance / 60.0) ** 2)
        stated = nugget ** 2 + 1.5 ** 2 * (1.0 - correlation)
        assert variogram(distance) == pytest.approx(stated)
        # The fields are independent: the mean of theirs scatters by their scatter / sqrt(n).
        assert abs(found.mean() - stated) < 4.5 * found.std() / math.sqrt(300) + 2e-4 * 1.5 ** 2
        assert found.std() / math.sqrt(300) < 0.05 * stated + 1e-3
    assert variogram(0.0) == 0.0 and repr(dspace.Variogram(2, 60)) == repr(dspace.Variogram(2.0, 60.0))
    values = fields[:, 45, 35]
    assert values.std() == pytest.approx(math.hypot(1.5, nugget), rel=0.2) and abs(values.mean()) < 0.35
    # Normally distributed: the fourth moment of independent fields, whose scatter is sqrt(96 / n).
    assert (values ** 4).mean() / (values ** 2).mean() ** 2 == pytest.approx(3.0, abs=4.0 * math.sqrt(96 / 300))


def test_neither_ends_nor_wraps_are_correlated():
    fields = np.stack([dspace.Variogram(1.0, 30.0).field((40, 40), (5.0, 5.0), np.random.default_rng(k)) for k in range(400)])
    for other in (fields[:, 0, 39], fields[:, 39, 0], fields[:, 39, 39]):
        lag = 195.0 if other is not fields[:, 39, 39] else 195.0 * math.sqrt(2.0)
        assert np.mean(fields[:, 0, 0] * other) == pytest.approx(math.exp(-lag / 30.0), abs=4.5 / math.sqrt(400))


@pytest.mark.parametrize("model", ["exponential", "gaussian"])
def test_fields_on_a_body_have_the_stated_variogram(model):
    """Places 200 m apart around a pole; distances are straight ones."""
    variogram = dspace.Variogram(2.0, 900.0, model)
    lat, lon = np.radians(np.stack(np.meshgrid(np.linspace(-89.9, -90.0, 12), np.arange(0.0, 360.0, 30.0), indexing="ij")))
    points = R * np.stack((np.cos(lat) * np.cos(lon), np.cos(lat) * np.sin(lon), np.sin(lat)), axis=-1)
    fields = np.stack([variogram.field_at(points, np.random.default_rng([3, k])) for k in range(600)]).reshape(600, -1)
    flat = points.reshape(-1, 3)
    for a, b in ((0, 1), (0, 6), (0, 12), (13, 60), (30, 36), (100, 5)):
        distance = np.linalg.norm(flat[a] - flat[b])
        stated = 4.0 * (1.0 - (math.exp(-distance / 900.0) if model == "exponential" else math.exp(-(distance / 900.0) ** 2)))
        squares = 0.5 * (fields[:, a] - fields[:, b]) ** 2
        assert abs(squares.mean() - stated) < 4.5 * squares.std() / math.sqrt(600)
    assert np.abs(fields[:, 132:] - fields[:, 132:133]).max() < 1e-6  # the pole is one place


def test_light_of_independent_errors(scene, tmp_path):
    """A level plane with independent errors z of every post, a point-like Sun in the east at elevation e: a cell is lit if no post
    to its east, k posts away, is higher than k d tan(e) + z of its own. The probability is the integral over z of the product of
    the normal distributions of those posts."""
    sigma, d, side = 1.0, 10.0, 40
    rise = 0.6  # [m] a post
    raster = write_raster(tmp_path / "plane.tif", np.zeros((side, side), np.float32), d)
    made = scene.illumination_ensemble(raster, tmp_path / "lit.tif", dspace.Variogram(0.0, 1.0, nugget=sigma), members=12, seed=5,
                                       quantities=("lit_fraction", "permanent_shadow"), azimuths=4, percentiles=(0.0, 100.0),
                                       sun=[(1e14 * d, 0.0, 1e14 * rise)])
    assert made.bands == ("lit_fraction mean", "lit_fraction percentile 0", "lit_fraction percentile 100", "permanent_shadow mean",
                          "permanent_shadow percentile 0", "permanent_shadow percentile 100")
    mean = made.read(0)
    z = np.linspace(-6.0, 6.0, 4001)
    density = np.exp(-0.5 * z * z) / math.sqrt(2.0 * math.pi) * (z[1] - z[0])
    normal = np.vectorize(lambda x: 0.5 * (1.0 + math.erf(x / math.sqrt(2.0))))
    product = np.ones_like(z)
    stated = []
    for k in range(0, side):
        stated.append((density * product).sum())
        product = product * normal(z + (k + 1) * rise / sigma)
    assert 0.2 < stated[20] < 0.6 < stated[1] < stated[0] == pytest.approx(1.0)
    for column in (39, 38, 37, 36, 30):
        share = stated[39 - column]
        assert mean[:, column].mean() == pytest.approx(share, abs=4.0 * math.sqrt(share * (1.0 - share) / (12 * side)) + 1e-6)
    inner = mean[:, :25].mean()
    assert inner == pytest.approx(stated[30], abs=0.03)
    assert set(np.unique(made.read(1))) <= {0.0, 1.0} and (made.read(2) >= made.read(1)).all()
    assert made.read(3) == pytest.approx(1.0 - mean)
    assert not scene.terrains and sorted(path.name for path in tmp_path.iterdir()) == ["lit.tif", "plane.tif"]
    assert made.metadata["DSPACE_MEMBERS"] == "12" and "nugget=1.0" in made.metadata["DSPACE_VARIOGRAM"]


def hills():
    y, x = np.mgrid[0:30, 0:36]
    return (4 * np.sin(0.4 * x) * np.cos(0.3 * y)).astype(np.float32)


SUNS = [(SUN * math.sin(a), SUN * math.cos(a), 0.06 * SUN) for a in np.radians(np.arange(3.0, 363.0, 24.0))]
GOOD = dict(variogram=dspace.Variogram(0.8, 30.0), members=4, seed=11, azimuths=24, sun=SUNS, threads=1)


def test_statistics_are_those_of_the_members(scene, tmp_path):
    raster = write_raster(tmp_path / "hills.tif", hills(), 10.0)
    made = scene.illumination_ensemble(raster, tmp_path / "lit.tif", keep=True, percentiles=(25.0, 50.0), **GOOD)
    members = [dspace.MapFile.open(path) for path in sorted((tmp_path / "lit.tif.members").glob("member_*.tif"))]
    assert len(members) == 4
    for quantity in ("lit_fraction", "longest_night"):
        values = np.stack([member.read(quantity) for member in members]).astype(float)
        low, below, above, high = np.sort(values, axis=0)
        assert made.read(f"{quantity} mean") == pytest.approx(values.mean(axis=0), rel=1e-6)
        assert made.read(f"{quantity} percentile 50") == pytest.approx(0.5 * (below + above), rel=1e-6)
        assert made.read(f"{quantity} percentile 25") == pytest.approx(low + 0.75 * (below - low), rel=1e-6)
        assert np.ptp(values, axis=0).max() > 0.0
    # A member is the map of the raster with that field on it.
    field = GOOD["variogram"].field((30, 36), (10.0, 10.0), np.random.default_rng([11, 2]))
    ground = scene.add_terrain(write_raster(tmp_path / "two.tif", hills() + field, 10.0), name="two", mode="clipmap")
    horizons = scene.horizon_map(ground, tmp_path / "horizons.tif", azimuths=24)
    alone = scene.illumination_map(horizons, tmp_path / "alone.tif", sun=SUNS)
    assert members[2].read("lit_fraction") == pytest.approx(alone.read(), abs=1e-6)
    # More members of the same seed use those that are there.
    more = scene.illumination_ensemble(raster, tmp_path / "lit.tif", keep=True, replace=True, **{**GOOD, "members": 5})
    assert more.metadata["DSPACE_MEMBERS"] == "5"
    assert all(dspace.MapFile.open(member.path).read() == pytest.approx(member.read()) for member in members)


def test_without_errors_every_member_is_the_map(scene, tmp_path):
    z = (900 * np.random.default_rng(1).random((12, 16))).astype(np.float32)
    z[2, 3] = np.nan
    raster = write_moon(tmp_path / "moon.tif", z, 10, -84, 0.05)
    span = dict(start="2026-01-03", end="2026-02-01", step=43200.0)
    made = scene.illumination_ensemble(raster, tmp_path / "lit.tif", dspace.Variogram(0.0, 500.0), members=2, azimuths=24,
                                       terrain=dict(on_body=True), percentiles=50.0, **span)
    ground = scene.add_terrain(raster, name="moon", on_body=True, mode="clipmap")
    horizons = scene.horizon_map(ground, tmp_path / "horizons.tif", azimuths=24)
    alone = scene.illumination_map(horizons, tmp_path / "alone.tif", **span)
    for name in ("lit_fraction mean", "lit_fraction percentile 50"):
        assert made.read(name) == pytest.approx(alone.read(), abs=1e-6, nan_ok=True)
    assert np.isnan(made.read()[2, 3]) and np.isfinite(made.read()).sum() == 12 * 16 - 1


def test_scaled_values_get_errors_in_metres(scene, tmp_path):
    """Values of 16 bits in steps of 0.5 m."""
    data = gdal.GetDriverByName("GTiff").Create(str(tmp_path / "steps.tif"), 36, 30, 1, gdal.GDT_UInt16)
    data.SetGeoTransform((0, 10, 0, 300, 0, -10))
    steps = np.round(2.0 * hills() + 100.0)
    data.GetRasterBand(1).WriteArray(steps.astype(np.uint16))
    data.GetRasterBand(1).SetScale(0.5)
    data.GetRasterBand(1).SetOffset(7.0)
    data = None
    good = {**GOOD, "members": 2, "percentiles": 50.0, "keep": True}
    scene.illumination_ensemble(tmp_path / "steps.tif", tmp_path / "a.tif", **good)
    plain = write_raster(tmp_path / "plain.tif", (0.5 * steps + 7.0).astype(np.float32), 10.0)
    scene.illumination_ensemble(plain, tmp_path / "b.tif", **good)
    a, b = (dspace.MapFile.open(tmp_path / f"{name}.tif.members" / "member_0001.tif").read() for name in "ab")
    assert a == pytest.approx(b, abs=1e-4)


KILLED = """
import sys
sys.path.insert(0, {folder!r})
import dspace
from test_ensembles import GOOD
import os, signal
def progress(fraction, left):
    print(fraction, flush=True)
    if fraction > 0.4:
        os.kill(os.getpid(), signal.SIGKILL)
with dspace.Session() as session:
    session.scene().illumination_ensemble({raster!r}, {path!r}, progress=progress, **GOOD)
"""


def test_a_killed_ensemble_continues(scene, tmp_path, refused):
    raster = str(write_raster(tmp_path / "hills.tif", hills(), 10.0))
    whole = scene.illumination_ensemble(raster, tmp_path / "whole.tif", **GOOD)
    path = str(tmp_path / "lit.tif")
    here = str(pathlib.Path(__file__).parent)
    done = subprocess.run([sys.executable, "-c", KILLED.format(folder=here, raster=raster, path=path)], capture_output=True, text=True,
                          env={**os.environ, "PYTHONPATH": os.pathsep.join([here, str(pathlib.Path(here).parent), *sys.path])}, timeout=300)
    assert done.returncode == -signal.SIGKILL, done.stderr
    members = list((tmp_path / "lit.tif.members").glob("member_*.tif"))
    assert 1 <= len(members) < 4 and not os.path.exists(path)
    with refused(dspace.AlreadyExists, "it has members of other inputs"):
        scene.illumination_ensemble(raster, path, **{**GOOD, "seed": 12})
    begun = []
    made = scene.illumination_ensemble(raster, path, progress=lambda fraction, left: begun.append(fraction), **GOOD)
    assert pathlib.Path(made.path).read_bytes() == pathlib.Path(whole.path).read_bytes()
    assert begun[-1] == pytest.approx(1.0) and begun == sorted(begun)
    other = scene.illumination_ensemble(raster, tmp_path / "other.tif", **{**GOOD, "seed": 12})
    assert (other.read() != made.read()).any()


@pytest.mark.parametrize("change, kind, text", [
    ({"variogram": 3.0}, dspace.WrongType, "the variogram is 3.0; accepted: a dspace.Variogram"),
    ({"members": 1}, dspace.InvalidArgument, "members is 1; accepted: 2 to 10000"),
    ({"seed": -1}, dspace.InvalidArgument, "seed is -1"),
    ({"percentiles": (5.0, 101.0)}, dspace.InvalidArgument, "percentiles is [5.0, 101.0]"),
    ({"quantities": ("light",)}, dspace.InvalidArgument, "a quantity is 'light'"),
    ({"terrain": "moon"}, dspace.WrongType, "terrain is 'moon'"),
    ({"raster": "none.tif"}, dspace.NotFound, "raster 'none.tif'"),
    ({"sun": None}, dspace.InvalidArgument, "accepted: start and end, or sun"),
    ({"variogram": dspace.Variogram(1.0, 1e6)}, dspace.Resource, "a length of 1e+06 m over 36 x 30 posts"),
])
def test_rejected(scene, tmp_path, refused, change, kind, text):
    raster = write_raster(tmp_path / "hills.tif", hills(), 10.0)
    with refused(kind, text):
        scene.illumination_ensemble(**{"raster": raster, "path": tmp_path / "lit.tif", **GOOD, **change})
    assert not (tmp_path / "lit.tif").exists()


@pytest.mark.parametrize("arguments, text", [
    ((-1.0, 10.0), "the sigma is -1.0; accepted: a finite number of metres, 0 or more"),
    ((1.0, 0.0), "the length is 0.0; accepted: a finite number of metres, above 0"),
    ((1.0, 10.0, "spherical"), "the model is 'spherical'; accepted: exponential, gaussian"),
    ((1.0, 10.0, "gaussian", math.nan), "the nugget is nan")])
def test_rejected_variograms(arguments, text):
    with pytest.raises(dspace.InvalidArgument) as error:
        dspace.Variogram(*arguments)
    assert text in str(error.value)


def test_the_command(capsys, tmp_path):
    z = (900 * np.random.default_rng(1).random((12, 16))).astype(np.float32)
    moon = write_moon(tmp_path / "moon.tif", z, 10, -84, 0.05)
    command = ("illumination", "--terrain", moon, "--from", "2026-01-03", "--to", "2026-02-01", "--step", 43200, "--azimuths", 24, "--quiet",
               "--ensemble", 3, "--variogram", "exponential:20,3000,5", "--seed", 2, "--percentile", 10)
    code, text, err = run(capsys, *command, "--out", tmp_path / "lit.tif")
    assert code == 0 and "16 x 12 cells" in text and "2 bands" in text, err
    with dspace.Session() as session:
        same = session.scene().illumination_ensemble(
            moon, tmp_path / "same.tif", dspace.Variogram(20.0, 3000.0, "exponential", 5.0), members=3, seed=2, percentiles=10.0, azimuths=24,
            quantities="lit_fraction", start="2026-01-03", end="2026-02-01", step=43200.0, terrain=dict(on_body=True))
    assert gdal.Open(str(tmp_path / "lit.tif")).ReadAsArray() == pytest.approx(np.stack([same.read(k) for k in (0, 1)]))
    code, text, err = run(capsys, *command, "--out", tmp_path / "lit.json")
    assert code == 0 and not list(tmp_path.glob("lit.json.tif*")), err
    for words, text in ((("--variogram", "exponential:20"), "accepted: MODEL:SIGMA,LENGTH[,NUGGET]"), (("--variogram", "other:1,2"), "the model is 'other'"),
                        (("--ensemble", 1), "members is 1"), (("--horizons", "a.tif"), "--horizons: accepted: without --ensemble")):
        code, _, err = run(capsys, *command, *words, "--out", tmp_path / "no.tif")
        assert code == 1 and text in err, err
