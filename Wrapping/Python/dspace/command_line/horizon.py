"""`dspace horizon`: the horizon around a site on terrain, or of every cell of a map."""
import shutil
import sys

from dspace.command_line import Failed, lazy
from dspace.command_line.measure_ground import (MeasuredGround, add_ground, opened, out_of, place_of, source_of, text_of, unit_of,
                                                 write)
from dspace.command_line.measure_map import add_map, common, extent_of, map_out, told

np = lazy("numpy")


def add_arguments(parser):
    add_ground(parser, "a file of the horizon: .json, .csv, .html (a report), or .png (a plot); of --map: .tif")
    place = parser.add_mutually_exclusive_group(required=True)
    place.add_argument("--site", metavar="LON,LAT",
                        help="longitude (east) and latitude [deg]; map x and y without a CRS")
    place.add_argument("--frame", metavar="PATH", help="of --recording, in place of --site: the frame whose origin is the place")
    place.add_argument("--map", action="store_true",
                        help="in place of --site: of every cell of the terrain, to a GeoTIFF with a band per azimuth. The same "
                        "command continues a map that was interrupted")
    parser.add_argument("--height", type=float, metavar="H", help="above the ground [m], 0 or more (default: 2); not with --frame")
    parser.add_argument("--azimuths", type=int, default=360, metavar="N",
                        help="evenly spaced, clockwise from north, 1 to 1000000 (default: 360)")
    parser.add_argument("--scheduler", metavar="ADDRESS",
                        help="of --map: the workers of this Dask scheduler (tcp://HOST:PORT) compute the map; they find the terrain at the "
                        "same path. The same command continues, and the file is that of one process (Debian: python3-distributed)")
    add_map(parser)
    parser.set_defaults(run=run)


def run(options):
    if options.frame is not None and options.height is not None:
        raise Failed("--height: accepted: with --site or --map; a frame has its own height")
    options.height = 2.0 if options.height is None else options.height
    if options.map:
        run_map(options)
        return
    if options.scheduler:
        raise Failed("--scheduler: accepted: with --map")
    out = out_of(options)
    if options.frame is not None and options.recording is None:
        raise Failed("--frame: accepted: with --recording")
    site = place_of(options.site, "LON,LAT", (2,), "--site") if options.frame is None else None
    if not 1 <= options.azimuths <= 1_000_000:
        raise Failed(f"--azimuths {options.azimuths}: accepted: 1 to 1000000")
    with opened(options) as scene:
        ground = MeasuredGround(scene, options)
        horizon = scene.horizon(options.frame if site is None else ground.site((*site, options.height)), options.azimuths)
        where = ground.degrees_of(horizon.point)
        found = source_of(options, ground)
    turn = np.nan if horizon.first_deg is None else horizon.first_deg
    rows = [{"azimuth_deg": azimuth, "true_azimuth_deg": (azimuth + turn) % 360.0, "elevation_deg": elevation,
             "distance_m": distance, "lon_deg": point[0], "lat_deg": point[1], "height_m": point[2]}
            for azimuth, elevation, distance, point in zip(horizon.azimuth_deg, horizon.elevation_deg, horizon.distance, where)]
    if site is None:
        found.update(frame=options.frame, horizon=rows)
    else:
        found.update(lon_deg=site[0], lat_deg=site[1], height_m=options.height, horizon=rows)
    if out is not None:
        write(out, found, rows, lambda figure: draw(figure, horizon, options.frame or f"{site[0]:g}, {site[1]:g}, {options.height:g} "
                                                    "m above the ground"))
    if options.json:
        sys.stdout.write(text_of(found))
        return
    low, high = (int(find(horizon.elevation_deg)) for find in (np.argmin, np.argmax))
    print(f"{len(rows)} azimuths: elevation {horizon.elevation_deg[low]:.5f} (azimuth {horizon.azimuth_deg[low]:g}) to "
          f"{horizon.elevation_deg[high]:.5f} deg (azimuth {horizon.azimuth_deg[high]:g}, {horizon.distance[high]:.1f} m away)")
    if out is not None:
        print(f"{out}: {len(rows)} azimuths")


def run_map(options):
    import dspace
    out = map_out(options, (".tif",))
    with opened(options) as scene:
        ground = MeasuredGround(scene, options)
        parts = None
        if options.scheduler:
            from dspace.command_line.map_workers import share
            parts = share(options, ground, out)
        if options.scheduler and parts is None:
            made = dspace.MapFile.open(out)
        else:
            made = ground.scene.horizon_map(ground.terrain, out, height=options.height, azimuths=options.azimuths,
                                            extent=extent_of(options), cell_size=options.cell_size, replace=options.replace,
                                            **common(options))
        if parts is not None:
            shutil.rmtree(parts)
        found = source_of(options, ground)
    if options.json:
        sys.stdout.write(text_of({**found, "height_m": options.height, "path": made.path, "columns": made.columns,
                                  "rows": made.rows, "azimuths": len(made.bands), "cell_size": made.cell_size}))
        return
    print(told(out, made))


def draw(figure, horizon, title):
    """The elevation over the azimuth, and the distance below it."""
    above, below = figure.subplots(2, 1, sharex=True, height_ratios=(2, 1))
    azimuth = np.append(horizon.azimuth_deg, 360.0)
    elevation = np.where(np.isfinite(horizon.distance), horizon.elevation_deg, np.nan)
    elevation, distance = (np.append(values, values[0]) for values in (elevation, horizon.distance))
    known = elevation[np.isfinite(elevation)]
    foot = (known.min() - 0.05 * max(np.ptp(known), 1e-3)) if known.size else -90.0
    above.fill_between(azimuth, elevation, foot, color="#b9b1a6", linewidth=0)
    above.plot(azimuth, elevation, color="#5c5348", linewidth=1.0)
    above.set_ylim(bottom=foot)
    above.axhline(0.0, color="#808080", linewidth=0.6)
    above.set_ylabel("elevation [deg]")
    above.set_title(f"Horizon at {title}", fontsize=10)
    unit, name = unit_of(distance)
    below.plot(azimuth, np.where(np.isfinite(distance), distance, np.nan) / unit, color="#2c56c8", linewidth=1.0)
    below.set_ylim(bottom=0.0)
    below.set_ylabel(f"distance [{name}]")
    below.set_xlabel("azimuth [deg], clockwise from north")
    below.set_xlim(0.0, 360.0)
    below.set_xticks(np.arange(0, 361, 45), ("N", "NE", "E", "SE", "S", "SW", "W", "NW", "N"))
