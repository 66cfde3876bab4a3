"""Cached overviews of rasters that have none: built by `dspace terrain cache`, read by clipmaps."""
import os
import signal
import subprocess
import sys
import time
import warnings

import numpy as np
import pytest

import dspace
from terrain_support import gdal, write_raster

SIDE = 2304  # pixels
HIGH, LOW = 90.0, 0.0


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """The user's cache folder, which nothing has made yet."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    return tmp_path / "cache/dspace/terrain"


def stripes(path, overviews=False, noise=0.0):
    """Columns by turns 0 and 90 m: their mean is 45 m, whereas every n-th has one of the two."""
    z = np.zeros((SIDE, SIDE), np.float32)
    z[:, 1::2] = HIGH
    z += noise * np.random.default_rng(1).random(z.shape, np.float32)
    write_raster(path, z)
    if overviews:
        gdal.Open(str(path), gdal.GA_Update).BuildOverviews("AVERAGE", [2, 4, 8])
    return path


def run(*arguments, **given):
    return subprocess.run([sys.executable, "-m", "dspace", "terrain", "cache", *map(str, arguments)],
                          capture_output=True, text=True, **given)


def built(path, *arguments):
    done = run(path, *arguments)
    assert done.returncode == 0, done.stderr
    return done.stdout


def opened(scene, path, **given):
    """The terrain and what was warned of overviews."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        terrain = scene.add_terrain(path, **{"mode": "clipmap", "build_overviews": False, **given})
    return terrain, [text for text in (str(warning.message) for warning in caught) if "overviews" in text]


def far_height(scene, terrain):
    """Of the ground in the middle of a picture from so high that a pixel is 24 posts: from the depths
    of an orthographic camera straight above."""
    eye = scene.add_camera("far", eye=(0, 0, 1000), target=(0, 0, 0), up=(0, 1, 0), height=24 * 60,
                           near=500, far=1500)
    view = scene.add_viewport((60, 60), eye, samples=1)
    depth = view.depth()
    view.remove()
    return 1000 - depth[20:40, 20:40]


# --- Read ------------------------------------------------------------------------------------------

def test_far_ground_is_the_mean_of_all_pixels_with_the_cache(scene, folder, tmp_path):
    path = stripes(tmp_path / "stripes.tif")
    plain, warned = opened(scene, path)
    assert len(warned) == 1 and f"`dspace terrain cache '{path}'`" in warned[0] and "2304 x 2304" in warned[0]
    assert not folder.exists()
    one = far_height(scene, plain)
    assert np.isin(np.round(one, 3), (LOW, HIGH)).all()
    near = plain.height([0.5, 1.5, 2.5], [0.5, 0.5, 0.5])
    plain.remove()

    built(path)
    assert [each.suffix for each in folder.iterdir()] == [".overviews"]
    assert sorted(each.name for each in tmp_path.iterdir()) == ["cache", "stripes.tif"]  # nothing beside it
    cached, warned = opened(scene, path)
    assert warned == []
    np.testing.assert_allclose(far_height(scene, cached), 45, atol=0.01)
    np.testing.assert_array_equal(cached.height([0.5, 1.5, 2.5], [0.5, 0.5, 0.5]), near)  # full resolution
    cached.remove()

    off, warned = opened(scene, path, cache=False)
    assert warned == []  # chosen
    np.testing.assert_array_equal(far_height(scene, off), one)


def awaited(terrain):
    """What its overviews say once nothing is under way any more."""
    while terrain.overviews["build"] == "building":
        time.sleep(0.01)
    return terrain.overviews


def test_overviews_are_built_in_the_background(scene, folder, tmp_path):
    path = stripes(tmp_path / "stripes.tif")
    terrain, warned = opened(scene, path, build_overviews=True)
    assert len(warned) == 1 and "until the background build completes" in warned[0]
    near = terrain.height([0.5, 1.5, 2.5], [0.5, 0.5, 0.5])
    assert awaited(terrain) == {"levels": 4, "cached": True, "build": "built", "progress": 1.0, "failure": ""}
    np.testing.assert_allclose(far_height(scene, terrain), 45, atol=0.01)
    np.testing.assert_array_equal(terrain.height([0.5, 1.5, 2.5], [0.5, 0.5, 0.5]), near)
    assert [each.suffix for each in folder.iterdir()] == [".overviews"]
    terrain.remove()
    again, warned = opened(scene, path, build_overviews=True)
    assert warned == [] and again.overviews["build"] is None and again.overviews["levels"] == 4


def test_a_build_ends_with_its_terrain(scene, folder, tmp_path):
    path = tmp_path / "endless.vrt"
    path.write_text('<VRTDataset rasterXSize="100000" rasterYSize="100000"><GeoTransform>0, 1, 0, 0, 0, -1'
                    '</GeoTransform><VRTRasterBand dataType="Int16" band="1"><NoDataValue>-1</NoDataValue>'
                    '</VRTRasterBand></VRTDataset>')
    terrain, _ = opened(scene, path, build_overviews=True)
    while terrain.overviews["progress"] == 0:  # until it is under way
        time.sleep(0.01)
    assert terrain.overviews["build"] == "building"
    terrain.remove()
    assert list(folder.iterdir()) == []  # nothing half-made
    with dspace.Session() as other:  # ends while it builds
        opened(other.scene(), path, build_overviews=True)
    assert not folder.exists() or list(folder.iterdir()) == []


def test_a_process_that_ends_without_a_word_ends_its_builds(folder, tmp_path):
    test_path = tmp_path / "endless.vrt"
    test_path.write_text('<VRTDataset rasterXSize="100000" rasterYSize="100000"><VRTRasterBand '
                         'dataType="Int16" band="1"><NoDataValue>-1</NoDataValue></VRTRasterBand></VRTDataset>')
    code = ("import dspace, time, warnings; warnings.simplefilter('ignore'); session = dspace.Session()\n"
            f"terrain = session.scene().add_terrain({str(test_path)!r}, mode='clipmap')\n"
            "while terrain.overviews['progress'] == 0: time.sleep(0.01)\n")
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    assert list(folder.iterdir()) == []


def test_overviews_that_cannot_be_built_are_told_of(scene, folder, tmp_path):
    path = stripes(tmp_path / "stripes.tif")
    terrain, _ = opened(scene, path, cache=path / "in a file", build_overviews=True)
    found = awaited(terrain)
    assert found["build"] == "failed" and "in a file" in found["failure"] and found["levels"] == 0
    assert np.isin(np.round(far_height(scene, terrain), 3), (LOW, HIGH)).all()
    terrain.remove()
    off, _ = opened(scene, path, cache=False, build_overviews=True)
    assert off.overviews["build"] is None
    assert not folder.exists()


def test_a_folder_of_ones_own(scene, folder, tmp_path):
    path, own = stripes(tmp_path / "stripes.tif"), tmp_path / "own"
    terrain, warned = opened(scene, path, cache=own)
    assert len(warned) == 1 and f"--folder '{own}'" in warned[0]
    terrain.remove()
    built(path, "--folder", own)
    assert len(list(own.iterdir())) == 1 and not folder.exists()
    terrain, warned = opened(scene, path, cache=own)
    assert warned == []
    np.testing.assert_allclose(far_height(scene, terrain), 45, atol=0.01)
    terrain.remove()
    _, warned = opened(scene, path)
    assert len(warned) == 1


def test_a_raster_that_has_overviews_or_is_small_needs_none(scene, folder, tmp_path):
    own = stripes(tmp_path / "own.tif", overviews=True)
    small = write_raster(tmp_path / "small.tif", np.ones((900, 900), np.float32))
    for path in (own, small):
        assert opened(scene, path)[1] == []
    assert "none are built" in built(own) and not folder.exists()


def test_overviews_of_an_older_raster_are_not_read(scene, folder, tmp_path):
    path = stripes(tmp_path / "stripes.tif")
    built(path)
    was = path.stat()
    write_raster(path, np.ones((SIDE, SIDE), np.float32))
    os.utime(path, ns=(was.st_atime_ns, was.st_mtime_ns + 3_000_000_000))  # also where files' times are whole seconds
    assert path.stat().st_size == was.st_size
    terrain, warned = opened(scene, path)
    assert len(warned) == 1
    np.testing.assert_allclose(far_height(scene, terrain), 1, atol=1e-3)
    terrain.remove()
    built(path)
    assert opened(scene, path)[1] == []


def test_damaged_overviews_are_warned_of_and_removed(scene, folder, tmp_path):
    """All tiles are; their index, some kilobytes at the file's end, is not. Noise is not compressed."""
    path = stripes(tmp_path / "stripes.tif", noise=1.0)
    built(path)
    file, = folder.iterdir()
    content = np.frombuffer(file.read_bytes(), np.uint8).copy()
    content[64:-16384] ^= 1
    file.write_bytes(content)
    terrain, warned = opened(scene, path)
    assert len(warned) == 2 and str(file) in warned[0] and "`dspace terrain cache" in warned[1]
    assert not file.exists()
    far = far_height(scene, terrain)
    assert ((far < LOW + 1.5) | (far > HIGH - 0.5)).all()


@pytest.mark.parametrize("cache", [True, 3, ""])
def test_what_is_no_folder_is_refused(scene, refused, tmp_path, cache):
    path = write_raster(tmp_path / "small.tif", np.ones((9, 9), np.float32))
    with refused(dspace.WrongType, "cache"):
        scene.add_terrain(path, cache=cache)


# --- The command -----------------------------------------------------------------------------------

def test_listed_verified_and_cleared(folder, tmp_path):
    first, second = (stripes(tmp_path / f"{name}.tif") for name in "ab")
    assert "0 rasters" in run("--list").stdout and "0 rasters" in run("--clear").stdout
    text = built(first, second)
    files = sorted(folder.iterdir())
    assert all(str(part) in text for part in (first, second, *files)) and len(files) == 2
    listed = run("--list")
    assert listed.returncode == 0
    assert all(str(part) in listed.stdout for part in (first, second, *files, "2 rasters"))
    assert run("--verify").returncode == 0
    info = subprocess.run([sys.executable, "-m", "dspace", "terrain", "info", str(first)], capture_output=True,
                          text=True).stdout
    assert "none of its own, 4 levels in the cache" in info  # 1152 to 144 cells a side
    assert run("--list", "--folder", tmp_path / "none").stdout.startswith("0 rasters")

    damaged = files[0]
    content = bytearray(damaged.read_bytes())
    content[len(content) // 4] ^= 1
    damaged.write_bytes(content)
    verified = run("--verify")
    assert verified.returncode == 1 and str(damaged) in verified.stderr and str(files[1]) not in verified.stderr
    built(first, second)
    assert run("--verify").returncode == 0

    other = folder / "somebody's.txt"
    other.write_text("stays")
    first.unlink()  # the raster need not be there
    assert run("--clear", first).returncode == 0
    assert len(list(folder.glob("*.overviews"))) == 1 and str(second) in run("--list").stdout
    again = run("--clear", first)
    assert again.returncode == 1 and str(first) in again.stderr
    (folder / ".0.overviews.0123456789abcdef.part").write_bytes(b"killed")
    assert run("--clear").returncode == 0 and list(folder.iterdir()) == [other]


def test_what_cannot_be_built_is_named_and_the_rest_is(folder, tmp_path):
    path = stripes(tmp_path / "stripes.tif")
    (tmp_path / "text.tif").write_text("no raster")
    done = run(tmp_path / "absent.tif", tmp_path / "text.tif", path)
    assert done.returncode == 1
    assert len(done.stderr.splitlines()) == 2
    assert "absent.tif" in done.stderr and "text.tif" in done.stderr and str(path) in done.stdout
    (tmp_path / "file").write_text("")
    done = run(path, "--folder", tmp_path / "file")
    assert done.returncode == 1 and str(tmp_path / "file") in done.stderr
    for wrong in ((), ("--list", path), ("--verify", path), (path, "--folder", "")):
        done = run(*wrong)
        assert done.returncode == 1 and len(done.stderr.splitlines()) == 1, wrong
    assert run("--list", "--clear").returncode == 2


@pytest.mark.parametrize("how", [signal.SIGINT, signal.SIGTERM])
def test_a_cancelled_build_leaves_nothing(folder, tmp_path, how):
    """Ended as soon as it has begun to write; overviews of the raster before stay."""
    path = tmp_path / "large.tif"
    # Blocks that are left out are filled with no-data values: a large file of no size.
    data = gdal.GetDriverByName("GTiff").Create(str(path), 60000, 60000, 1, gdal.GDT_Float32,
                                                ["TILED=YES", "SPARSE_OK=TRUE"])
    data.SetGeoTransform((0, 1, 0, 0, 0, -1))
    data = None
    command = subprocess.Popen([sys.executable, "-m", "dspace", "terrain", "cache", str(path)],
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                               start_new_session=True)
    while command.poll() is None and not list(folder.glob(".*.overviews.*.part")):
        time.sleep(0.01)
    (os.killpg if how == signal.SIGINT else os.kill)(command.pid, how)
    out, err = command.communicate()
    assert command.returncode == 130 and "cancelled" in err and out == ""
    assert list(folder.iterdir()) == []
    assert sorted(each.name for each in tmp_path.iterdir()) == ["cache", "large.tif"]
