"""Pictures of measurements: real data."""
import contextlib
import io
import pathlib
import sys
import tempfile

import numpy as np
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from osgeo import gdal

import dspace
from dspace._core.files import atomic_write
from dspace.command_line import main
from pictures.paths import DATA, IMAGES

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "Examples" / "polar_site"))
import polar_ground  # noqa: E402


def measure_horizon():
    """The horizon where Curiosity landed in Gale crater."""
    code = main(["horizon", "--terrain", f"{DATA}/terrain/mars_gale_mola_128ppd_m.tif", "--site", "137.4417,-4.5895",
                 "--height", "2", "--azimuths", "1440", "--vertical-datum", "areoid", "--out",
                 str(IMAGES / "measure_horizon.png")])
    assert code == 0


def measure_lit():
    """The Sun over the horizon of a panel where Curiosity landed."""
    code = main(["lit", "--terrain", f"{DATA}/terrain/mars_gale_mola_128ppd_m.tif", "--site", "137.4417,-4.5895", "--vertical-datum",
                 "areoid", "--panel", "2,1", "--facing", "120,30", "--sun", "112,8.5", "--distance-au", "1.52", "--efficiency", "0.3",
                 "--out", str(IMAGES / "measure_lit.png")])
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


@contextlib.contextmanager
def polar_terrain():
    """The generated ground at the Moon's south pole, 40 km wide, 50 m a post."""
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "ground.tif"
        polar_ground.write(path, 800, 50.0)
        yield path


def measure_link():
    """Where generated ground at the Moon's south pole sees a station of the Deep Space Network, and the paths of the Sun and the Earth over
    the horizon of one site, for a lunation."""
    with polar_terrain() as ground:
        stations = [word for place in ("-116.89,35.4267,970", "-4.248,40.4314,830", "148.9813,-35.4014,690") for word in ("--station", place)]
        assert main(["illumination", "--terrain", str(ground), "--from", "2026-01-01", "--to", "2026-01-30T12:00", "--step", "7200",
                     "--azimuths", "180", "--cell-size", "400", "--height", "2", "--quantity", "station_fraction", *stations,
                     "--station-mask", "10", "--replace", "--out", str(IMAGES / "measure_link.png")]) == 0
        assert main(["horizon", "--terrain", str(ground), "--site", "222.7,-89.45", "--height", "2", "--azimuths", "1440", "--time",
                     "2026-01-01,2026-01-30T12:00,3600", "--out", str(IMAGES / "measure_paths.png")]) == 0


def measure_sites():
    """The best-lit sites within 4 km of the ridge's middle, for two masts, over three lunations."""
    with polar_terrain() as ground:
        code = main(["sites", "--terrain", str(ground), "--site", "0,-90", "--radius", "4000", "--mast", "2", "--mast", "20", "--from",
                     "2026-09-01", "--to", "2026-11-28", "--step", "7200", "--azimuths", "180", "--count", "6", "--apart", "800",
                     "--most-slope", "15", "--quiet", "--out", str(IMAGES / "measure_sites.png")])
    assert code == 0


def measure_ensemble():
    """How much the light depends on errors of the heights of 5 m that are correlated over 500 m."""
    with polar_terrain() as ground, dspace.Session() as session:
        made = session.scene().illumination_ensemble(
            ground, ground.parent / "lit.tif", dspace.Variogram(5.0, 500.0), members=20, seed=1, height=2.0, azimuths=120,
            extent=(-4000.0, 4000.0, 4000.0, -4000.0), cell_size=100.0, terrain={"on_body": True}, start="2026-09-01", end="2026-11-28",
            step=14400.0)
        low, middle, high = (100.0 * made.read(f"lit_fraction percentile {share}") for share in (5, 50, 95))
    figure = Figure(figsize=(9.4, 3.7), dpi=100, layout="constrained")
    for axes, values, title, colors in zip(figure.subplots(1, 2), (middle, high - low), ("median of 20 terrains", "95th less 5th percentile"),
                                           ("inferno", "viridis")):
        shown = axes.imshow(values, extent=(-4, 4, -4, 4), cmap=colors)
        axes.set(xlabel="map x [km]", ylabel="map y [km]", title=title)
        figure.colorbar(shown, ax=axes, label="lit [% of the time]")
    data = io.BytesIO()
    figure.savefig(data, format="png", metadata={"Software": None})
    atomic_write(IMAGES / "measure_ensemble.png", data.getvalue())
