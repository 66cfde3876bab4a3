"""`dspace illumination`: the time that ground is lit by the Sun, from horizons of its cells and the ephemeris."""
import contextlib
import dataclasses
import pathlib
import sys
import tempfile

from dspace.command_line import Failed
from dspace.command_line.measure_ground import MeasuredGround, add_ground, opened, place_of, source_of, text_of
from dspace.command_line.measure_map import (Look, add_map, common, extent_of, map_out, require_gdal, told, write_map,
                                             written_to)

LOOKS = {"lit_fraction": Look("lit fraction of the time", "inferno", 0.0, 1.0),
         "longest_night": Look("longest night [h]", "magma_r", 0.0, unit=3600.0),
         "earth_fraction": Look("fraction of the time with the Earth in sight", "viridis", 0.0, 1.0),
         "station_fraction": Look("fraction of the time with a station in sight", "viridis", 0.0, 1.0),
         "permanent_shadow": Look("permanent shadow", "gray_r", 0.0, 1.0, names=("no", "yes"))}
HEIGHT, AZIMUTHS = 0.0, 360  # of horizons


def add_arguments(parser):
    add_ground(parser, "the map: .tif (GeoTIFF), .png (the first quantity), .csv (a row a cell) or .json (a summary)")
    parser.add_argument("--horizons", metavar="FILE",
                        help="the horizon map of `dspace horizon --map` of this terrain (default: one is computed and removed)")
    parser.add_argument("--height", type=float, metavar="H",
                        help=f"without --horizons: above the ground [m], 0 to 1e6 (default: {HEIGHT:g})")
    parser.add_argument("--fast", action="store_true",
                        help="horizons to some half a degree, in about two thirds of the time (default: to 0.01 degrees)")
    parser.add_argument("--azimuths", type=int, metavar="N",
                        help=f"without --horizons: of the horizons, 1 to 3600 (default: {AZIMUTHS})")
    parser.add_argument("--from", dest="start", required=True, metavar="UTC",
                        help="the first time: UTC in ISO 8601, or with ' TDB', ' TT' or ' TAI' behind it")
    parser.add_argument("--to", dest="end", required=True, metavar="UTC", help="the end, which is no step itself")
    parser.add_argument("--step", type=float, default=3600.0, metavar="S", help="[s] (default: 3600)")
    parser.add_argument("--body", metavar="BODY", help="that the terrain lies on (default: the one that its CRS names)")
    parser.add_argument("--quantity", action="append", choices=tuple(LOOKS),
                        help="may be given several times (default: lit_fraction). longest_night is in seconds")
    parser.add_argument("--station", action="append", default=[], metavar="LON,LAT[,H]",
                        help="of station_fraction: a station on the Earth: longitude (east), geodetic latitude [deg], height [m]; may be given "
                        "several times")
    parser.add_argument("--station-mask", type=float, default=0.0, metavar="E",
                        help="least elevation of the map's middle over a station's horizontal [deg] (default: 0)")
    parser.add_argument("--no-eclipses", dest="eclipses", action="store_false",
                        help="leave out that the Earth eclipses the Sun over the Moon, and the Moon over the Earth")
    parser.add_argument("--ensemble", type=int, metavar="N",
                        help="map the mean and percentiles over N terrains, 2 to 10000, whose heights differ by random errors. Finished "
                        "members are kept in OUT.members until all are done, and the same command continues")
    parser.add_argument("--variogram", metavar="MODEL:SIGMA,LENGTH[,NUGGET]",
                        help="of --ensemble: exponential or gaussian; standard deviation and length of the correlated errors, and the standard "
                        "deviation of independent ones [m]")
    parser.add_argument("--seed", type=int, default=0, metavar="S", help="of --ensemble, 0 or more (default: 0)")
    parser.add_argument("--percentile", type=float, action="append", metavar="P",
                        help="of --ensemble, 0 to 100; may be given several times (default: 5, 50 and 95)")
    add_map(parser)
    parser.set_defaults(run=run)


def run(options):
    from dspace.measure.plans import BodySite
    out = map_out(options)
    if not options.step > 0.0:
        raise Failed(f"--step {options.step}: accepted: more than 0 s")
    if options.horizons is not None and (options.extent is not None or options.cell_size):
        raise Failed("--extent, --cell-size: accepted: without --horizons, whose cells count")
    made = options.horizons is not None and options.ensemble is None
    if made and (options.fast or options.height is not None or options.azimuths is not None):
        raise Failed("--fast, --height, --azimuths: accepted: without --horizons, which are made already")
    options.height = HEIGHT if options.height is None else options.height
    options.azimuths = AZIMUTHS if options.azimuths is None else options.azimuths
    if out.suffix.lower() != ".tif":
        require_gdal()
    quantities = tuple(options.quantity or ("lit_fraction",))
    if ("station_fraction" in quantities) != bool(options.station):
        raise Failed("--station: accepted: with --quantity station_fraction, and that with --station")
    if options.station and options.ensemble is not None:
        raise Failed("--station: accepted: without --ensemble")
    stations = [BodySite("earth", *place_of(text, "LON,LAT[,H]", (2, 3), "--station"), geodetic=True) for text in options.station]
    if options.ensemble is not None:
        run_ensemble(options, out, quantities)
        return
    if options.variogram is not None or options.percentile:
        raise Failed("--variogram, --percentile: accepted: with --ensemble")
    with contextlib.ExitStack() as stack:
        ground = MeasuredGround(stack.enter_context(opened(options)), options)
        horizons = options.horizons
        if horizons is None:
            check_before(ground, options)
            folder = stack.enter_context(tempfile.TemporaryDirectory(prefix="dspace-horizons-"))
            horizons = ground.scene.horizon_map(ground.terrain, pathlib.Path(folder) / "horizons.tif", height=options.height,
                                                azimuths=options.azimuths, fast=options.fast, extent=extent_of(options),
                                                cell_size=options.cell_size, **common(options))
        path = stack.enter_context(written_to(out))
        made = ground.scene.illumination_map(horizons, path, start=options.start, end=options.end, step=options.step,
                                             quantities=quantities, terrain=ground.terrain, body=options.body,
                                             stations=stations, station_mask=options.station_mask,
                                             eclipses=options.eclipses, replace=options.replace, **common(options))
        found = {**source_of(options, ground), "from": options.start, "to": options.end,
                 "step_s": options.step, "eclipses": made.metadata.get("DSPACE_ECLIPSES") == "yes",
                 "columns": made.columns, "rows": made.rows}
        write_map(out, made, found, f"{options.start} to {options.end}, every {options.step:g} s",
                  LOOKS[quantities[0]])
    if options.json:
        sys.stdout.write(text_of(found))
        return
    print(told(out, made))


def check_before(ground, options):
    """Says before the work on horizons what the light over them would be rejected for."""
    start, end = (float(time) for time in ground.scene.tdb([options.start, options.end]))
    if not start < end:
        raise Failed(f"--from {options.start}, --to {options.end}: the span from the start to the end is {end - start:g} s; accepted: more than 0")
    if not ground.crs:
        raise Failed(f"terrain '{options.terrain or options.recording}': it has no longitudes and latitudes, so the Sun's direction is not known; accepted: a "
                     "raster with a CRS, or --crs")


def run_ensemble(options, out, quantities):
    variogram = variogram_of(options.variogram)
    if options.recording is not None:
        raise Failed("--recording: accepted: without --ensemble, which perturbs a raster")
    if options.horizons is not None:
        raise Failed("--horizons: accepted: without --ensemble, whose members have horizons of their own")
    # The members of an interrupted ensemble are beside the output.
    whole = out if out.suffix.lower() == ".tif" else out.with_name(out.name + ".tif")
    with contextlib.ExitStack() as stack:
        ground = MeasuredGround(stack.enter_context(opened(options)), options)
        check_before(ground, options)
        ground.terrain.remove()
        made = ground.scene.illumination_ensemble(
            options.terrain, whole, variogram, members=options.ensemble, seed=options.seed,
            percentiles=tuple(options.percentile or (5.0, 50.0, 95.0)), quantities=quantities, height=options.height,
            azimuths=options.azimuths, fast=options.fast, extent=extent_of(options), cell_size=options.cell_size, start=options.start, end=options.end,
            step=options.step, body=options.body, eclipses=options.eclipses, terrain=ground.arguments, replace=options.replace, **common(options))
        found = {**source_of(options, ground), "from": options.start, "to": options.end,
                 "step_s": options.step, "members": options.ensemble, "seed": options.seed, "variogram": repr(variogram),
                 "columns": made.columns, "rows": made.rows}
        look = LOOKS[quantities[0]]
        # A mean of yes and no is a fraction.
        mean = dataclasses.replace(look, label=f"mean {look.label}", names=())
        write_map(out, made, found, f"{options.start} to {options.end}, {options.ensemble} terrains", mean)
        if whole != out:
            whole.unlink()
    if options.json:
        sys.stdout.write(text_of(found))
        return
    print(told(out, made))


def variogram_of(words):
    import dspace
    if words is None:
        raise Failed("--variogram: accepted: MODEL:SIGMA,LENGTH[,NUGGET], with --ensemble")
    model, _, numbers = words.partition(":")
    sigma, length, *nugget = place_of(numbers, "MODEL:SIGMA,LENGTH[,NUGGET]", (2, 3), "--variogram")
    return dspace.Variogram(sigma, length, model, *nugget)
