"""Horizon maps against r.horizon of GRASS GIS (Debian: grass-core), which is run as a program: the same raster, all cells, on one thread
each, in turn; what counts is the processor's time. r.horizon counts the curvature of a sphere of 6,371 km; Dspace's map is on a plane, and as degrees on that sphere."""
import pathlib
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

import dspace
import numpy as np
from osgeo import gdal

ROUNDS = 3
SIDE = 512  # cells
PIXEL = 20.0  # [m]
AZIMUTHS = 16
RADIUS = 6_371_000.0  # [m] of r.horizon
GOAL = 50.0
# A module of GRASS runs within a session; its own time is what counts, without that of the session.
RUN = """
r.in.gdal -o input={raster} output=ground --quiet
g.region raster=ground
for round in $(seq {rounds}); do
  read ready
  TIMEFORMAT="took %U"
  time r.horizon elevation=ground direction=0 step={step} output=horizon --overwrite --quiet 2> /dev/null
done
"""


def heights():
    y, x = np.mgrid[0:SIDE, 0:SIDE]
    z = np.zeros((SIDE, SIDE))
    length = 3.0
    while length < SIDE:
        k = 2.0 * np.pi / length
        z += 0.008 * PIXEL * length * (np.sin(k * (x + 0.4 * y) + length) + np.cos(k * (0.3 * x - y)))
        length *= 1.7
    return z.astype(np.float32)


def write(path, geotransform, projection=""):
    data = gdal.GetDriverByName("GTiff").Create(str(path), SIDE, SIDE, 1, gdal.GDT_Float32)
    data.SetGeoTransform(geotransform)
    if projection:
        data.SetProjection(projection)
    data.SetMetadataItem("VERTICAL_DATUM", "sphere" if projection else "relative")
    data.GetRasterBand(1).SetUnitType("m")
    data.GetRasterBand(1).WriteArray(heights())
    return path


def main():
    gdal.UseExceptions()
    if shutil.which("grass") is None:
        print("grass: left out: it needs grass-core")
        return
    with tempfile.TemporaryDirectory() as name, dspace.Session() as session:
        folder = pathlib.Path(name)
        scene = session.scene()
        plane = write(folder / "plane.tif", (500_000.0, PIXEL, 0, 5_000_000.0, 0, -PIXEL))
        step = np.degrees(PIXEL / RADIUS)
        sphere = (f'GEOGCS["s",DATUM["s",SPHEROID["s",{RADIUS},0]],PRIMEM["G",0],UNIT["degree",0.0174532925199433]]')
        body = write(folder / "body.tif", (10.0, step, 0, 0.5 * SIDE * step, 0, -step), sphere)
        grounds = {"on a plane": scene.add_terrain(plane, name="plane", mode="clipmap", build_overviews=False),
                   "on the sphere": scene.add_terrain(body, name="body", on_body=True, build_overviews=False)}
        (folder / "run.sh").write_text(RUN.format(raster=plane, rounds=ROUNDS, step=360 // AZIMUTHS))
        grass = subprocess.Popen(["grass", "--tmp-location", "EPSG:32633", "--exec", "bash", folder / "run.sh"], stdin=subprocess.PIPE,
                                 stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        theirs, ours = [], {where: [] for where in grounds}
        for _ in range(ROUNDS):
            grass.stdin.write("\n")
            grass.stdin.flush()
            while not (line := grass.stdout.readline()).startswith("took"):
                if not line:
                    sys.exit("grass: it has ended before r.horizon did")
            theirs.append(float(line.split()[1]))
            for where, ground in grounds.items():
                begin = time.process_time()
                scene.horizon_map(ground, folder / "map.tif", azimuths=AZIMUTHS, threads=1, replace=True)
                ours[where].append(time.process_time() - begin)
        grass.stdin.close()
        grass.wait()
        count = SIDE * SIDE * AZIMUTHS
        for where, times in ours.items():
            ratios = [a / b for a, b in zip(theirs, times)]
            print(f"grass: horizons of {SIDE} x {SIDE} cells, {AZIMUTHS} azimuths, {where}, one thread: {count / statistics.median(times):.3g} "
                  f"cell-azimuths a second with the file against r.horizon's {count / statistics.median(theirs):.3g}: "
                  f"{statistics.median(ratios):.1f} times as fast ({min(ratios):.1f}..{max(ratios):.1f}); goal >= {GOAL:g}")


if __name__ == "__main__":
    main()
