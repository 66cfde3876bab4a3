"""Pictures of measurements: real data."""
import io
import pathlib
import tempfile

import numpy as np
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from osgeo import gdal

import dspace
from dspace._core.files import atomic_write
from dspace.command_line import main
from pictures.paths import DATA, IMAGES


def measure_horizon():
    """The horizon where Curiosity landed in Gale crater."""
    code = main(["horizon", "--terrain", f"{DATA}/terrain/mars_gale_mola_128ppd_m.tif", "--site", "137.4417,-4.5895",
                 "--height", "2", "--azimuths", "1440", "--vertical-datum", "areoid", "--out",
                 str(IMAGES / "measure_horizon.png")])
    assert code == 0


def measure_viewshed():
    """What a camera 2 m above Curiosity's landing site sees of Gale crater, over shaded relief."""
    file = pathlib.Path(DATA) / "terrain" / "mars_gale_mola_128ppd_m.tif"
    site = (137.4417, -4.5895)
    with dspace.Session() as session, tempfile.TemporaryDirectory() as folder:
        scene = session.scene()
        ground = scene.add_terrain(file, name="gale", on_body=True, vertical_datum="areoid", vertical_scale=1.0)
        seen = scene.viewshed(ground.site(*site, 2.0), pathlib.Path(folder) / "seen.tif")
        visible = seen.read("visible")
        x0, dx, _, y0, _, dy = seen.geotransform
    heights = gdal.Open(str(file)).ReadAsArray().astype(float)
    slope_y, slope_x = np.gradient(heights, 463.0)
    extent = (x0, x0 + dx * seen.columns, y0 + dy * seen.rows, y0)
    figure = Figure(figsize=(6.2, 5.9), dpi=100, layout="constrained")
    axes = figure.subplots()
    axes.imshow(0.5 + 0.8 * (slope_x + slope_y), cmap="gray", vmin=0.0, vmax=1.0, extent=extent)
    axes.imshow(np.ma.masked_where(visible != 1.0, visible), cmap=ListedColormap(["#30d848"]), extent=extent,
                interpolation="nearest")
    axes.plot(*site, "*", color="red", markersize=11)
    axes.set(xlabel="longitude [deg]", ylabel="latitude [deg]")
    axes.set_title("Seen from 2 m above the landing site in Gale crater", fontsize=10)
    data = io.BytesIO()
    figure.savefig(data, format="png", metadata={"Software": None})
    atomic_write(IMAGES / "measure_viewshed.png", data.getvalue())
