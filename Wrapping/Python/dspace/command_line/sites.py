"""`dspace sites`: the best-lit sites around a point, for masts of given heights."""
import contextlib
import json
import pathlib
import sys
import tempfile

from dspace._core.files import atomic_write
from dspace.command_line import Failed, lazy
from dspace.command_line.measure_ground import (MeasuredGround, add_ground, opened, out_of, place_of, source_of, text_of, unit_of,
                                                 write)
from dspace.command_line.measure_map import Progress, frame_of, require_gdal

np = lazy("numpy")


def add_arguments(parser):
    add_ground(parser, "a file of the sites: .json, .csv, .html (a report), or .png (a map with the sites)")
    parser.add_argument("--site", required=True, metavar="LON,LAT",
                        help="the middle: longitude (east) and latitude [deg]; map x and y without a CRS")
    parser.add_argument("--radius", type=float, required=True, metavar="R", help="of the search along the ground [m]")
    parser.add_argument("--mast", type=float, action="append", metavar="H",
                        help="height above the ground [m], 0 to 1e6; may be given several times (default: 2)")
    parser.add_argument("--from", dest="start", required=True, metavar="UTC",
                        help="the first time: UTC in ISO 8601, or with ' TDB', ' TT' or ' TAI' behind it")
    parser.add_argument("--to", dest="end", required=True, metavar="UTC", help="the end, which is no step itself")
    parser.add_argument("--step", type=float, default=3600.0, metavar="S", help="[s] (default: 3600)")
    parser.add_argument("--fast", action="store_true",
                        help="horizons to some half a degree, in about two thirds of the time (default: to 0.01 degrees)")
    parser.add_argument("--azimuths", type=int, default=360, metavar="N", help="of the horizons, 1 to 3600 (default: 360)")
    parser.add_argument("--cell-size", type=float, default=0.0, metavar="S",
                        help="spacing of the cells in map units, up to 64 posts (default: the raster's pixels)")
    parser.add_argument("--count", type=int, default=10, metavar="N", help="the most sites of a mast, 1 to 10000 (default: 10)")
    parser.add_argument("--apart", type=float, default=0.0, metavar="D", help="the least distance between two sites [m] (default: 0)")
    parser.add_argument("--most-slope", type=float, metavar="DEG", help="of the ground over two cells (default: no limit)")
    parser.add_argument("--order", choices=("lit_fraction", "longest_night"), default="lit_fraction",
                        help="what makes a site better (default: lit_fraction)")
    parser.add_argument("--body", metavar="BODY", help="that the terrain lies on (default: the one that its CRS names)")
    parser.add_argument("--maps", metavar="DIR", help="keep the horizon and illumination maps in this folder; the same command continues "
                        "maps that were interrupted, and uses those that are there; other options of the horizons are rejected; the folder must "
                        "exist (default: the maps are removed)")
    parser.add_argument("--threads", type=int, default=0, metavar="N", help="of the work, 0 to 256 (default: all)")
    parser.add_argument("--quiet", action="store_true", help="print no progress")
    parser.set_defaults(run=run)


def run(options):
    from dspace.measure.best_sites import extent_around
    out = out_of(options)
    middle = place_of(options.site, "LON,LAT", (2,), "--site")
    masts = list(dict.fromkeys(options.mast or (2.0,)))
    if not options.step > 0.0:
        raise Failed(f"--step {options.step}: accepted: more than 0 s")
    if not options.radius > 0.0:
        raise Failed(f"--radius {options.radius}: accepted: more than 0 m")
    if options.maps is not None and not pathlib.Path(options.maps).is_dir():
        raise Failed(f"--maps '{options.maps}': accepted: a folder that exists")
    require_gdal()
    with contextlib.ExitStack() as stack:
        ground = MeasuredGround(stack.enter_context(opened(options)), options)
        site = ground.site((*middle, 0.0))
        center = float(site.x), float(site.y)
        folder = pathlib.Path(options.maps or stack.enter_context(tempfile.TemporaryDirectory(prefix="dspace-sites-")))
        made = [maps_of(ground, folder, mast, extent_around(ground.terrain, center, options.radius), options) for mast in masts]
        sites = ground.scene.best_sites(ground.terrain, made, center=center, radius=options.radius, apart=options.apart,
                                        count=options.count, most_slope=options.most_slope, order=options.order)
        rows = rows_of(ground, sites)
        found = {**source_of(options, ground), "from": options.start, "to": options.end,
                 "step_s": options.step, "lon_deg": middle[0], "lat_deg": middle[1], "radius_m": options.radius,
                 "apart_m": options.apart, "most_slope_deg": options.most_slope, "order": options.order, "sites": rows}
        if out is not None and rows:
            write(out, found, rows, lambda figure: draw(figure, made, sites, masts))
    if not rows:
        raise Failed("no cell satisfies the limits; accepted: a greater --most-slope or --radius")
    if options.json:
        sys.stdout.write(text_of(found))
        return
    for row in rows:
        print(told(row))
    if out is not None:
        print(f"{out}: {len(rows)} sites")


def maps_of(ground, folder, mast, extent, options):
    """The illumination map of a mast: one that is in the folder, or a new one."""
    import dspace
    horizon_file, lit_file = (folder / f"{name}_{mast:g}m.tif" for name in ("horizons", "lit"))
    require_same(folder / "options.json", {"--fast": options.fast, "--azimuths": options.azimuths, "--cell-size": options.cell_size,
                                           "the extent of --site and --radius": [float(value) for value in extent]})
    work = {"threads": options.threads, "progress": None if options.quiet else Progress()}
    if horizon_file.exists():
        horizons = dspace.MapFile.open(horizon_file)
    else:
        horizons = ground.scene.horizon_map(ground.terrain, horizon_file, height=mast, azimuths=options.azimuths, fast=options.fast, extent=extent,
                                            cell_size=options.cell_size, **work)
    # Illumination takes little time: it is made again, for the times may be others.
    return ground.scene.illumination_map(horizons, lit_file, start=options.start, end=options.end, step=options.step,
                                         quantities=("lit_fraction", "longest_night"), terrain=ground.terrain, body=options.body,
                                         replace=True, **work)


def require_same(path, options):
    """Keeps the options of the horizons beside the maps. Rejects others than those that are there; the ground is in the maps."""
    if not path.exists():
        if any(path.parent.glob("horizons_*.tif")):
            raise Failed(f"--maps '{path.parent}': {path.name}, which tells how its maps were made, is not there; accepted: another folder")
        atomic_write(path, json.dumps(options, indent=2).encode())
        return
    try:
        before = json.loads(path.read_text())
    except ValueError:
        raise Failed(f"{path}: it is damaged; accepted: another folder") from None
    for name, value in options.items():
        if before.get(name) != value:
            raise Failed(f"--maps '{path.parent}': {name} is {value}, and its maps were made with {before.get(name)}; accepted: the same, "
                         "or another folder")


def rows_of(ground, sites):
    if not sites:
        return []
    where = ground.degrees_of(ground.terrain.from_map([[site.x, site.y, site.ground] for site in sites]))
    return [{"mast_m": site.mast, "rank": site.rank, "lon_deg": place[0], "lat_deg": place[1], "ground_m": site.ground,
             "slope_deg": site.slope_deg, "distance_m": site.distance, "lit_fraction": site.lit_fraction,
             "longest_night_s": site.longest_night, "map_x": site.x, "map_y": site.y} for site, place in zip(sites, where)]


def told(row):
    return (f"mast {row['mast_m']:g} m, {row['rank']}: {row['lon_deg']:.6g}, {row['lat_deg']:.6g}, ground {row['ground_m']:.1f} m, slope "
            f"{row['slope_deg']:.1f} deg; lit {100.0 * row['lit_fraction']:.2f} %, longest night "
            f"{row['longest_night_s'] / 3600.0:.1f} h; {row['distance_m']:.0f} m from the middle")


def draw(figure, maps, sites, masts):
    """A map of the lit fraction for each mast, with its sites by rank."""
    figure.set_size_inches(1.5 + 5.0 * len(masts), 5.2)
    low = min(float(np.nanmin(made.read("lit_fraction"))) for made in maps)
    high = max(float(np.nanmax(made.read("lit_fraction"))) for made in maps)
    for k, (made, mast) in enumerate(zip(maps, masts)):
        axes = figure.add_subplot(1, len(masts), k + 1)
        edges, aspect, names = frame_of(made)
        unit = 1.0
        if made.unit == "m":
            unit, name = unit_of(np.abs(edges))
            names = [axis.replace("[m]", f"[{name}]") for axis in names]
        shown = axes.imshow(100.0 * np.ma.masked_invalid(made.read("lit_fraction")), extent=edges / unit, cmap="inferno",
                            vmin=100.0 * low, vmax=100.0 * high, aspect=aspect)
        for site in (site for site in sites if site.mast == mast):
            axes.plot(site.x / unit, site.y / unit, "o", markersize=7, markerfacecolor="#30d0ff", markeredgecolor="black")
            axes.annotate(str(site.rank), (site.x / unit, site.y / unit), textcoords="offset points", xytext=(5, 5),
                          color="black", fontsize=9, bbox={"boxstyle": "round,pad=0.15", "facecolor": "white", "alpha": 0.8, "linewidth": 0})
        axes.ticklabel_format(useOffset=False)
        axes.set(xlabel=names[0], ylabel=names[1], title=f"mast of {mast:g} m")
    figure.colorbar(shown, ax=figure.axes, label="lit [% of the time]", shrink=0.8)
