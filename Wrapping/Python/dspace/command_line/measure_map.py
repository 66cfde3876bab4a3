"""What `dspace horizon --map`, `dspace viewshed` and `dspace illumination` share: the options of maps, and the files that they
write."""
import contextlib
import io
import pathlib
import shutil
import sys
import tempfile
import time
from dataclasses import dataclass

from dspace._core.files import atomic_write
from dspace.command_line import Failed, lazy
from dspace.command_line.measure_ground import figures, place_of, text_of
from dspace.command_line.terrain_rasters import gdal_modules

np = lazy("numpy")

ENDINGS = (".tif", ".png", ".json", ".csv")
MOST_CELLS = 1_000_000  # of a CSV file


@dataclass(frozen=True)
class Look:
    """How a quantity is drawn: what the colour bar says, the colour map, its ends (None: those of the values), and in how many of the
    file's units one of the picture's is. names: of the values 0, 1, ... of a quantity that has no others; whole: it counts."""
    label: str
    colours: str
    low: float | None = None
    high: float | None = None
    unit: float = 1.0
    names: tuple = ()
    whole: bool = False


def add_map(parser):
    """Adds the options of cells and of the work."""
    parser.add_argument("--extent", metavar="L,T,R,B",
                        help="left, top, right, bottom of the map in the raster's coordinates (default: the whole raster)")
    parser.add_argument("--cell-size", type=float, default=0.0, metavar="S",
                        help="spacing of the cells in map units, up to 64 posts (default: the raster's pixels)")
    parser.add_argument("--threads", type=int, default=0, metavar="N", help="of the work, 0 to 256 (default: all)")
    parser.add_argument("--replace", action="store_true", help="replace an existing output file")
    parser.add_argument("--quiet", action="store_true", help="print no progress")


def map_out(options, endings=ENDINGS):
    """The path of --out. Says what is wrong before the work starts."""
    if options.out is None:
        raise Failed(f"--out: accepted: a name with {', '.join(endings)}")
    out = pathlib.Path(options.out)
    if out.suffix.lower() not in endings:
        raise Failed(f"--out '{out}': accepted: a name with {', '.join(endings)}")
    if not out.resolve().parent.is_dir():
        raise Failed(f"--out '{out}': there is no folder {out.resolve().parent}")
    if out.exists() and not options.replace:
        raise Failed(f"--out '{out}': it exists; accepted: a new file, or --replace")
    if out.suffix.lower() == ".png":
        figures()
    return out


def extent_of(options):
    return None if options.extent is None else place_of(options.extent, "L,T,R,B", (4,), "--extent")


def common(options):
    """Arguments of the maps of a scene."""
    return {"threads": options.threads, "progress": None if options.quiet else Progress()}


class Progress:
    """Prints the progress on the error stream: on a terminal in one line, else every ten seconds."""

    def __init__(self):
        self._last = time.monotonic()
        self._shown = False

    def __call__(self, fraction, left):
        now = time.monotonic()
        terminal = sys.stderr.isatty()
        if fraction >= 1.0:
            if self._shown and terminal:
                print(file=sys.stderr)
            return
        if now - self._last < (0.5 if terminal else 10.0):
            return
        self._last, self._shown = now, True
        rest = f", {left:.0f} s left" if np.isfinite(left) and fraction > 0.0 else ""
        print(f"dspace: {100.0 * fraction:.1f} % done{rest}   ", end="\r" if terminal else "\n", file=sys.stderr, flush=True)


@contextlib.contextmanager
def written_to(out):
    """The path of the GeoTIFF to write: of --out itself, or in a folder that is removed at the end. An interrupted GeoTIFF
    of --out is continued by the same command."""
    if out.suffix.lower() == ".tif":
        yield out
        return
    folder = tempfile.mkdtemp(prefix="dspace-map-")
    try:
        yield pathlib.Path(folder) / "map.tif"
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def write_map(out, made, found, title, look, sites=None):
    """Writes a MapFile as PNG, JSON or CSV by the ending of `out`. look: of the first band. sites: map x, y (n, 2) of places to mark."""
    ending = out.suffix.lower()
    if ending == ".tif":
        return
    if ending == ".json":
        bands = []
        for name in made.bands:
            values = made.read(name)
            known = values[np.isfinite(values)]
            bands.append({"band": name, "cells": int(known.size), "least": known.min() if known.size else None,
                          "mean": known.mean(dtype=float) if known.size else None,
                          "greatest": known.max() if known.size else None})
            if name == "permanent_shadow":
                bands[-1]["area_m2"] = float(np.nansum(made.areas() * values))
        atomic_write(out, text_of({**found, "bands": bands}).encode())
    elif ending == ".csv":
        atomic_write(out, table_of(out, made))
    else:
        atomic_write(out, picture_of(made, title, look, sites))


def table_of(out, made):
    """The cells as CSV: map x and y of the centre, and the bands."""
    if made.columns * made.rows > MOST_CELLS:
        raise Failed(f"--out '{out}': {made.columns * made.rows} cells; accepted: up to {MOST_CELLS} in a CSV file")
    x0, dx, bx, y0, by, dy = made.geotransform
    c, r = np.meshgrid(np.arange(made.columns) + 0.5, np.arange(made.rows) + 0.5)
    columns = [x0 + dx * c + bx * r, y0 + by * c + dy * r] + [made.read(name) for name in made.bands]
    lines = [",".join(["x", "y", *(f'"{name}"' if "," in name else name for name in made.bands)])]
    for row in zip(*(column.reshape(-1).tolist() for column in columns)):
        lines.append(",".join("" if not np.isfinite(value) else repr(value) for value in row))
    return ("\n".join(lines) + "\n").encode()


def picture_of(made, title, look, sites=None):
    """The first band as a PNG over map coordinates."""
    from matplotlib import colormaps
    from matplotlib.ticker import MaxNLocator
    values = made.read(0) / look.unit
    extent, aspect, names = frame_of(made)
    ratio = aspect * (extent[3] - extent[2]) / (extent[1] - extent[0])
    wide = np.clip(14.0 / ratio, 5.0, 8.0)
    tall = np.clip(wide * ratio, 3.0, 14.0) + 0.8
    figure = figures()(figsize=(wide, tall), dpi=110, layout="constrained")
    axes = figure.subplots()
    low, high, colours = look.low, look.high, look.colours
    if look.names:
        low, high, colours = -0.5, len(look.names) - 0.5, colormaps[colours].resampled(len(look.names))
    elif look.whole:
        high = max(float(np.nanmax(values, initial=0.0)), 1.0)
    image = axes.imshow(np.ma.masked_invalid(values), extent=extent, cmap=colours, vmin=low, vmax=high, interpolation="nearest",
                        aspect=aspect)
    if sites is not None:
        axes.plot(*np.asarray(sites).T, "*", markersize=13, markerfacecolor="#ff3020", markeredgecolor="white", linestyle="none")
        axes.set(xlim=extent[:2], ylim=extent[2:])
    axes.set_facecolor("#d0d0d0")
    axes.ticklabel_format(useOffset=False)
    axes.locator_params(axis="x", nbins=6)
    axes.set(xlabel=names[0], ylabel=names[1])
    axes.set_title(title, fontsize=10)
    # As tall as the map.
    bar = figure.colorbar(image, ax=axes, label=look.label, fraction=0.046 * max(ratio, 0.4), aspect=20.0, pad=0.03,
                          ticks=range(len(look.names)) if look.names else MaxNLocator(integer=True) if look.whole else None)
    if look.names:
        bar.ax.set_yticklabels(look.names)
    data = io.BytesIO()
    figure.savefig(data, format="png", metadata={"Software": None})
    return data.getvalue()


def frame_of(made):
    """How a map is drawn: (left, right, bottom, top), how much taller than wide a unit is, and the names of the axes. Degrees are as
    wide as at the middle latitude, up to 89."""
    x0, dx, _, y0, _, dy = made.geotransform
    edges = np.array([x0, x0 + dx * made.columns, y0 + dy * made.rows, y0])
    if made.in_degrees:
        middle = min(abs(0.5 * (edges[2] + edges[3])), 89.0)
        return edges, 1.0 / np.cos(np.radians(middle)), ("longitude [deg]", "latitude [deg]")
    return edges, 1.0, (f"map x{made.unit and f' [{made.unit}]'}", f"map y{made.unit and f' [{made.unit}]'}")


def told(out, made):
    cell = f", {made.cell_size:.9g} map units a cell" if made.cell_size else ""
    text = f"{out}: {made.columns} x {made.rows} cells{cell}, {len(made.bands)} band{'s' if len(made.bands) > 1 else ''}"
    if "permanent_shadow" in made.bands and pathlib.Path(made.path).exists():
        dark, areas = made.read("permanent_shadow"), made.areas()
        whole = np.sum(areas[np.isfinite(dark)])
        text += f"; permanent shadow {np.nansum(areas * dark) / 1e6:.6g} km2, {100.0 * np.nansum(areas * dark) / whole:.3f} %" if whole else ""
    return text


def require_gdal():
    gdal_modules()  # says what is missing before the work starts

