"""Horizon maps that are killed and continued, and those that Dask's workers share: the bytes of one process."""
import os
import pathlib
import signal
import subprocess
import sys

import numpy as np
import pytest

import dspace
from command_support import R, run
from dspace.command_line import map_workers
from dspace.measure import maps
from needs import needs_module
from terrain_support import gdal

ASKED = []  # names of the parts that workers were asked for
COMPUTE = map_workers.compute
POLAR = (f'PROJCS["p",GEOGCS["Moon",DATUM["Moon",SPHEROID["Moon",{R},0]],PRIMEM["Reference",0],UNIT["degree",0.0174532925199433]],'
         'PROJECTION["Polar_Stereographic"],PARAMETER["latitude_of_origin",-90],PARAMETER["central_meridian",0],'
         'PARAMETER["false_easting",0],PARAMETER["false_northing",0],UNIT["metre",1]]')


@pytest.fixture
def polar(tmp_path):
    """A raster in a polar projection, off its pole: 20 x 3 tiles."""
    y, x = np.mgrid[0:150, 0:1230]
    z = (40 * np.sin(0.11 * x) * np.cos(0.13 * y) + 9 * np.sin(0.5 * x + 0.4 * y)).astype(np.float32)
    data = gdal.GetDriverByName("GTiff").Create(str(tmp_path / "polar.tif"), 1230, 150, 1, gdal.GDT_Float32)
    data.SetGeoTransform((30000, 20, 0, 15000, 0, -20))
    data.SetProjection(POLAR)
    data.SetMetadataItem("VERTICAL_DATUM", "sphere")
    data.GetRasterBand(1).SetUnitType("m")
    data.GetRasterBand(1).WriteArray(z)
    return tmp_path / "polar.tif"


def map_of(polar, out, *more):
    return ("horizon", "--terrain", polar, "--map", "--height", 2, "--azimuths", 24, "--quiet", "--out", out, *more)


KILLED = """
import os, signal, sys
from dspace.command_line import main, measure_map
from dspace.measure import maps
maps.WAIT_S = 0.01
class Progress:
    def __call__(self, fraction, left):
        if os.path.exists(sys.argv[-1] + ".part.done") and os.path.getsize(sys.argv[-1] + ".part.done") > 40 and fraction > 0.02:
            os.kill(os.getpid(), signal.SIGKILL)
measure_map.Progress = Progress
main([word for word in sys.argv[1:] if word != "--quiet"])
"""


def test_a_killed_map_continues(capsys, polar, tmp_path):
    whole, out = tmp_path / "whole.tif", tmp_path / "map.tif"
    assert run(capsys, *map_of(polar, whole))[0] == 0
    words = [str(word) for word in map_of(polar, out) if word not in ("--out", out)] + ["--threads", "1", "--out", str(out)]
    done = subprocess.run([sys.executable, "-c", KILLED, *words], capture_output=True, text=True, timeout=300,
                          env={**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path))})
    assert done.returncode == -signal.SIGKILL, done.stderr
    assert not out.exists() and pathlib.Path(f"{out}.part").exists()
    code, text, err = run(capsys, *map_of(polar, out))
    assert code == 0 and out.read_bytes() == whole.read_bytes(), err
    assert not list(tmp_path.glob("map.tif.*"))


def third_fails(words, name, extent, folder):
    """In the place of map_workers.compute, by the threads of this process."""
    ASKED.append(name)
    if len(ASKED) == 3:
        raise dspace.Io("the disk is full", name)
    return COMPUTE(words, name, extent, folder)


@pytest.fixture
def cluster(tmp_path, monkeypatch):
    distributed = needs_module("distributed", "python3-distributed")
    monkeypatch.setattr(maps, "WAIT_S", 0.0)  # so that not even a small map is complete before it is shared
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, processes=False, protocol="tcp://", dashboard_address=None,
                                  local_directory=str(tmp_path / "workers")) as cluster:
        yield cluster.scheduler_address


def test_workers_make_the_map_of_one_process(capsys, polar, tmp_path, cluster, monkeypatch):
    whole, out = tmp_path / "whole.tif", tmp_path / "map.tif"
    assert run(capsys, *map_of(polar, whole, "--extent", "30100,14900,54500,12300"))[0] == 0
    ASKED.clear()
    monkeypatch.setattr(map_workers, "compute", third_fails)
    shared = map_of(polar, out, "--extent", "30100,14900,54500,12300", "--scheduler", cluster)
    code, _, err = run(capsys, *shared)
    assert code == 1 and "the disk is full" in err and not out.exists()
    there = sorted(path.name for path in (tmp_path / "map.tif.parts").iterdir())
    assert set(there) < {f"cells_{column}_{row}.tif" for column in (0, 1024) for row in (0, 64, 128)}
    ASKED[:] = [""] * 3
    code, text, err = run(capsys, *shared)
    assert code == 0 and "1220 x 130 cells" in text, err
    assert sorted(ASKED[3:] + there) == sorted(f"cells_{column}_{row}.tif" for column in (0, 1024) for row in (0, 64, 128))
    assert out.read_bytes() == whole.read_bytes()
    assert not list(tmp_path.glob("map.tif.*"))


def test_what_a_worker_says_is_told(capsys, polar, tmp_path, cluster, monkeypatch):
    parts_of = map_workers.parts_of
    monkeypatch.setattr(map_workers, "parts_of", lambda *cells: {name: (1e6, 1e6, 2e6, 0.0) for name in parts_of(*cells)})
    code, _, err = run(capsys, *map_of(polar, tmp_path / "map.tif", "--scheduler", cluster))
    assert code == 1 and "a worker's part of the map: dspace: terrain" in err and "no cell of the map lies on its data" in err


def test_parts_of_another_map_are_rejected(capsys, polar, tmp_path):
    out = tmp_path / "map.tif"
    (tmp_path / "map.tif.parts").mkdir()
    assert run(capsys, *map_of(polar, tmp_path / "map.tif.parts" / "a.tif", "--height", 3))[0] == 0
    code, _, err = run(capsys, *map_of(polar, out))
    assert code == 1 and "it is a part of another horizon map" in err and not list(tmp_path.glob("map.tif.part"))
    code, _, err = run(capsys, "horizon", "--terrain", polar, "--site", "1,-89", "--scheduler", "tcp://127.0.0.1:1")
    assert code == 1 and "--scheduler: accepted: with --map" in err
