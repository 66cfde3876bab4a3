"""Horizon maps that the workers of a Dask scheduler share (Debian: python3-distributed)."""
import contextlib
import os
import pathlib
import subprocess
import sys
import tempfile

from dspace._core import dask_client
from dspace._core.files import atomic_write
from dspace.command_line.measure_map import Progress, extent_of
from dspace.errors import AlreadyExists, Io

SIDE = 64  # cells of a tile of a map, which one part has as a whole (TileFile::Side)
TILES = 16  # of a part


class _Begun(Exception):
    pass


def share(options, ground, out):
    """Lets workers compute parts of the map, each with the same command for a part of the extent. Returns the folder "OUT.parts", from
    which the map takes the cells when it is computed next; None if the map is complete. Parts that are there are not computed
    again."""
    folder = pathlib.Path(f"{out}.parts")
    if out.exists() and not options.replace:
        raise AlreadyExists(f"file '{out}': it exists; accepted: a new file, or --replace", str(out))
    with dask_client.connected(options.scheduler) as client:
        cells = begin(options, ground, out)
        if cells is None:
            return None
        rectangles = parts_of(*cells)
        folder.mkdir(exist_ok=True)
        missing = {name: extent for name, extent in rectangles.items() if not (folder / name).exists()}
        progress = None if options.quiet else Progress()
        calls = [(options.words, name, extent, os.getcwd()) for name, extent in missing.items()]
        left = len(calls)
        with contextlib.closing(dask_client.results(client, options.scheduler, compute, calls)) as results:
            for name, data in results:
                atomic_write(folder / name, data)
                left -= 1
                if progress is not None:
                    progress(0.999 * (1.0 - left / len(rectangles)), float("inf"))
                del data
    return folder


def begin(options, ground, out):
    """Creates the file of the map, which tells its cells: columns, rows, and GDAL's geotransform. None where the map is so small that
    it is complete at once."""
    from osgeo import gdal
    part = f"{out}.part"

    def stop(fraction, left):
        if os.path.exists(f"{part}.done"):
            raise _Begun

    with contextlib.suppress(_Begun):
        ground.scene.horizon_map(ground.terrain, out, height=options.height, azimuths=options.azimuths, fast=options.fast, extent=extent_of(options),
                                 cell_size=options.cell_size, replace=options.replace, threads=1, progress=stop)
    if not os.path.exists(part):
        return None
    data = gdal.Open(part)
    return data.RasterXSize, data.RasterYSize, data.GetGeoTransform()


def parts_of(columns, rows, geotransform):
    """Rectangles of whole tiles: {file name: (left, top, right, bottom) in map coordinates}, around the centres of their cells."""
    x0, dx, bx, y0, by, dy = geotransform
    if bx != 0.0 or by != 0.0:
        raise Io("--scheduler: the raster is turned against its map coordinates; accepted: one whose rows run along map x", "--scheduler")
    found = {}
    for row in range(0, rows, SIDE):
        for column in range(0, columns, SIDE * TILES):
            right, bottom = min(column + SIDE * TILES, columns), min(row + SIDE, rows)
            x, y = sorted((x0 + dx * (column + 0.25), x0 + dx * (right - 0.25))), sorted((y0 + dy * (row + 0.25), y0 + dy * (bottom - 0.25)))
            found[f"cells_{column}_{row}.tif"] = (x[0], y[1], x[1], y[0])
    return found


def compute(words, name, extent, folder):
    """Runs on a worker. Returns the name and the bytes of the map of a part. A process of its own computes it: a session belongs to one
    thread, and workers have many."""
    with tempfile.TemporaryDirectory(prefix="dspace-map-part-") as scratch:
        out = os.path.join(scratch, name)
        command = [sys.executable, "-m", "dspace", *words, "--scheduler", "", "--quiet", "--extent", ",".join(map(repr, extent)), "--out", out]
        done = subprocess.run(command, cwd=folder if os.path.isdir(folder) else None, capture_output=True, text=True,
                              env={**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path))})
        if done.returncode != 0:
            said = done.stderr.strip().splitlines()
            raise Io(f"a worker's part of the map: {said[-1] if said else f'it ended with {done.returncode}'}", name)
        with open(out, "rb") as file:
            return name, file.read()
