"""`dspace horizon`: the horizon around a site on terrain, or of every cell of a map."""
import shutil
import sys

from dspace.command_line import Failed, lazy
from dspace.command_line.measure_ground import (MeasuredGround, add_ground, opened, out_of, place_of, source_of, text_of, unit_of,
                                                 write)
from dspace.command_line.measure_map import add_map, common, extent_of, map_out, told

np = lazy("numpy")

HORIZON_AZIMUTHS = 1440  # below the paths of bodies
MOST_TIMES = 100_000


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
    parser.add_argument("--fast", action="store_true",
                        help="--map: horizons to some half a degree, in about two thirds of the time (default: to 0.01 degrees)")
    parser.add_argument("--azimuths", type=int, default=360, metavar="N",
                        help="evenly spaced, clockwise from north, 1 to 1000000 (default: 360)")
    parser.add_argument("--method", choices=("exact", "image", "both"), default="exact",
                        help="exact: rays in double precision; image: four pictures of 90 degrees, whose cameras are in the JSON; both: with "
                        "their difference (default: exact)")
    parser.add_argument("--time", metavar="T0,T1[,STEP]",
                        help="with --site: also the paths of bodies over the horizon: UTC, and the step in seconds (default: 3600)")
    parser.add_argument("--target", action="append", metavar="BODY",
                        help="of --time: a body or spacecraft; may be given several times (default: sun and earth)")
    parser.add_argument("--body", metavar="BODY", help="of --time: that the site is on (default: the one that the terrain's CRS names)")
    parser.add_argument("--scheduler", metavar="ADDRESS",
                        help="of --map: the workers of this Dask scheduler (tcp://HOST:PORT) compute the map; they find the terrain at the "
                        "same path. The same command continues, and the file is that of one process (Debian: python3-distributed)")
    add_map(parser)
    parser.set_defaults(run=run)


def run(options):
    if options.frame is not None and options.height is not None:
        raise Failed("--height: accepted: with --site or --map; a frame has its own height")
    options.height = 2.0 if options.height is None else options.height
    if options.time is None and (options.target or options.body):
        raise Failed("--target, --body: accepted: with --time")
    if options.time is not None and options.site is None:
        raise Failed("--time: accepted: with --site")
    if options.map:
        if options.method != "exact":
            raise Failed("--method: accepted: without --map, which rays and a sweep compute")
        run_map(options)
        return
    if options.scheduler:
        raise Failed("--scheduler: accepted: with --map")
    if options.fast:
        raise Failed("--fast: accepted: with --map")
    out = out_of(options)
    if options.frame is not None and options.recording is None:
        raise Failed("--frame: accepted: with --recording")
    site = place_of(options.site, "LON,LAT", (2,), "--site") if options.frame is None else None
    if not 1 <= options.azimuths <= 1_000_000:
        raise Failed(f"--azimuths {options.azimuths}: accepted: 1 to 1000000")
    with opened(options) as scene:
        ground = MeasuredGround(scene, options)
        place = options.frame if site is None else ground.site((*site, options.height))
        horizon = scene.horizon(place, options.azimuths, method=options.method)
        where, names = ground.degrees_of(horizon.point), ground.place_names()
        found = source_of(options, ground)
        paths = paths_of(scene, place, horizon, options) if options.time is not None else []
    turn = np.nan if horizon.first_deg is None else horizon.first_deg
    rows = [{"azimuth_deg": azimuth, "true_azimuth_deg": (azimuth + turn) % 360.0, "elevation_deg": elevation,
             "distance_m": distance, names[0]: point[0], names[1]: point[1], "height_m": point[2]}
            for azimuth, elevation, distance, point in zip(horizon.azimuth_deg, horizon.elevation_deg, horizon.distance, where)]
    if options.method == "both":
        for row, image, difference in zip(rows, horizon.image_elevation_deg, horizon.image_difference_deg):
            row.update(image_elevation_deg=image, image_difference_deg=difference)
    if options.method != "exact":
        found.update(method=options.method, image_pixel_deg=horizon.image_pixel_deg, cameras=[
            {"position_m": pose.position, "quaternion_wxyz": pose.quaternion} for pose in horizon.image_cameras])
    if paths:
        found["paths"] = [row for _, rows_ in paths for row in rows_]
    if site is None:
        found.update(frame=options.frame, horizon=rows)
    else:
        found.update({names[0]: site[0], names[1]: site[1], "height_m": options.height, "horizon": rows})
    if out is not None:
        write(out, found, rows, lambda figure: draw(figure, horizon, options.frame or f"{site[0]:g}, {site[1]:g}, {options.height:g} "
                                                    "m above the ground", paths, turn))
    if options.json:
        sys.stdout.write(text_of(found))
        return
    low, high = (int(find(horizon.elevation_deg)) for find in (np.argmin, np.argmax))
    print(f"{len(rows)} azimuths: elevation {horizon.elevation_deg[low]:.5f} (azimuth {horizon.azimuth_deg[low]:g}) to "
          f"{horizon.elevation_deg[high]:.5f} deg (azimuth {horizon.azimuth_deg[high]:g}, {horizon.distance[high]:.1f} m away)")
    for name, path in paths:
        seen = sum(row["above_deg"] > 0.0 for row in path)
        print(f"{name}: elevation {min(row['elevation_deg'] for row in path):.5f} to {max(row['elevation_deg'] for row in path):.5f} deg, above "
              f"the horizon at {seen} of {len(path)} times")
    if out is not None:
        print(f"{out}: {len(rows)} azimuths")


def paths_of(scene, place, horizon, options):
    """(name, rows) of each body: where it stands over the site, and how high above the horizon in its direction."""
    parts = options.time.split(",")
    if len(parts) not in (2, 3):
        raise Failed(f"--time {options.time!r}: accepted: T0,T1[,STEP]")
    start, end = (float(time) for time in scene.tdb(parts[:2]))
    try:
        step = float(parts[2]) if len(parts) == 3 else 3600.0
    except ValueError:
        step = 0.0
    if not start < end or not step > 0.0 or not (end - start) / step <= MOST_TIMES:
        raise Failed(f"--time {options.time!r}: accepted: an end after the start, a step above 0 s, at most {MOST_TIMES:,} steps")
    # TDB differs from UTC by its periodic terms: a last step of milliseconds is none.
    count = max(1, int(np.ceil((end - start - min(5e-3, 0.1 * step)) / step)))
    times = np.append(start + step * np.arange(count), end)
    texts = scene.utc(times)
    if options.method == "image" or options.azimuths < HORIZON_AZIMUTHS:
        horizon = scene.horizon(place, HORIZON_AZIMUTHS)
    if horizon.first_deg is None:
        raise Failed("--time: the terrain has no longitudes and latitudes; accepted: terrain on a body")
    paths = []
    for name in options.target or ("sun", "earth"):
        track = scene.sky_track(place, name, times, body=options.body)
        above = track.elevation_deg - horizon.elevation_at((track.azimuth_deg - horizon.first_deg) % 360.0)
        paths.append((name, [{"target": name, "utc": text, "true_azimuth_deg": azimuth, "elevation_deg": elevation, "above_deg": over}
                             for text, azimuth, elevation, over in zip(texts, track.azimuth_deg, track.elevation_deg, above)]))
    return paths


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
            made = ground.scene.horizon_map(ground.terrain, out, height=options.height, azimuths=options.azimuths, fast=options.fast,
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


def draw(figure, horizon, title, paths=(), turn=0.0):
    """The elevation over the azimuth, with the paths of bodies, and the distance below it. turn: from the horizon's azimuths to true
    ones [deg]."""
    above, below = figure.subplots(2, 1, sharex=True, height_ratios=(2, 1))
    azimuth = np.append(horizon.azimuth_deg, 360.0)
    elevation = np.where(np.isfinite(horizon.distance), horizon.elevation_deg, np.nan)
    elevation, distance = (np.append(values, values[0]) for values in (elevation, horizon.distance))
    known = elevation[np.isfinite(elevation)]
    foot = (known.min() - 0.05 * max(np.ptp(known), 1e-3)) if known.size else -90.0
    if paths:
        shown = [row["elevation_deg"] for _, path in paths for row in path]
        foot = min(foot, max(min(shown), -5.0) - 1.0)
        top = max(*shown, *known, 0.0)
        above.set_ylim(top=top + max(1.0, 0.05 * (top - foot)))
    for (name, path), colour in zip(paths, ("#d98200", "#2c56c8", "#8a2be2", "#2c7a3f", "#b3261e") * len(paths)):
        azimuths = (np.array([row["true_azimuth_deg"] for row in path]) - turn) % 360.0
        elevations = [row["elevation_deg"] for row in path]
        above.plot(azimuths, elevations, ".", color=colour, markersize=1.5, label=name, zorder=1)
        breaks = np.flatnonzero(np.abs(np.diff(azimuths)) > 30.0) + 1  # over the plot's edges, and about the zenith
        above.plot(np.insert(azimuths, breaks, np.nan), np.insert(elevations, breaks, np.nan), color=colour, linewidth=0.4, zorder=1)
    if paths:
        above.legend(fontsize=8, loc="upper right", markerscale=6.0)
    above.fill_between(azimuth, elevation, foot, color="#b9b1a6", linewidth=0, zorder=2)
    above.plot(azimuth, elevation, color="#5c5348", linewidth=1.0, zorder=2)
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
    names = ("N", "NE", "E", "SE", "S", "SW", "W", "NW", "N")
    below.set_xticks(np.arange(0, 361, 45), [f"{name}\n{45 * k}" for k, name in enumerate(names)])
