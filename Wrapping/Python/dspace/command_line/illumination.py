"""`dspace illumination`: the time that ground is lit by the Sun, from horizons of its cells and the ephemeris."""
import contextlib
import pathlib
import sys
import tempfile

from dspace.command_line import Failed
from dspace.command_line.measure_ground import MeasuredGround, add_ground, text_of
from dspace.command_line.measure_map import (add_map, common, extent_of, map_out, require_gdal, told, write_map,
                                             written_to)

LOOKS = {"lit_fraction": ("lit fraction of the time", "inferno", 0.0, 1.0),
         "longest_night": ("longest night [s]", "magma_r", 0.0, None),
         "earth_fraction": ("fraction of the time with the Earth in sight", "viridis", 0.0, 1.0),
         "permanent_shadow": ("permanent shadow", "gray_r", 0.0, 1.0)}


def add_arguments(parser):
    add_ground(parser, "the map: .tif (GeoTIFF), .png (the first quantity), .csv (a row a cell) or .json (a summary)")
    parser.add_argument("--horizons", metavar="FILE",
                        help="the horizon map of `dspace horizon --map` of this terrain (default: one is computed and removed)")
    parser.add_argument("--height", type=float, default=0.0, metavar="H",
                        help="without --horizons: above the ground [m], 0 to 1e6 (default: 0)")
    parser.add_argument("--azimuths", type=int, default=360, metavar="N",
                        help="without --horizons: of the horizons, 1 to 3600 (default: 360)")
    parser.add_argument("--from", dest="start", required=True, metavar="UTC",
                        help="the first time: UTC in ISO 8601, or with ' TDB', ' TT' or ' TAI' behind it")
    parser.add_argument("--to", dest="end", required=True, metavar="UTC", help="the end, which is no step itself")
    parser.add_argument("--step", type=float, default=3600.0, metavar="S", help="[s] (default: 3600)")
    parser.add_argument("--body", metavar="BODY", help="that the terrain lies on (default: the one that its CRS names)")
    parser.add_argument("--quantity", action="append", choices=tuple(LOOKS),
                        help="may be given several times (default: lit_fraction). longest_night is in seconds")
    add_map(parser)
    parser.set_defaults(run=run)


def run(options):
    import dspace
    out = map_out(options)
    if not options.step > 0.0:
        raise Failed(f"--step {options.step}: accepted: more than 0 s")
    if options.horizons is not None and (options.extent is not None or options.cell_size):
        raise Failed("--extent, --cell-size: accepted: without --horizons, whose cells count")
    if out.suffix.lower() != ".tif":
        require_gdal()
    quantities = tuple(options.quantity or ("lit_fraction",))
    with contextlib.ExitStack() as stack:
        ground = MeasuredGround(stack.enter_context(dspace.Session()).scene(), options)
        horizons = options.horizons
        if horizons is None:
            folder = stack.enter_context(tempfile.TemporaryDirectory(prefix="dspace-horizons-"))
            horizons = ground.scene.horizon_map(ground.terrain, pathlib.Path(folder) / "horizons.tif", height=options.height,
                                                azimuths=options.azimuths, extent=extent_of(options),
                                                cell_size=options.cell_size, **common(options))
        path = stack.enter_context(written_to(out))
        made = ground.scene.illumination_map(horizons, path, start=options.start, end=options.end, step=options.step,
                                             quantities=quantities, terrain=ground.terrain, body=options.body,
                                             replace=options.replace, **common(options))
        found = {"terrain": str(options.terrain), "on_body": ground.on_body, "from": options.start, "to": options.end,
                 "step_s": options.step, "columns": made.columns, "rows": made.rows}
        write_map(out, made, found, f"{options.start} to {options.end}, every {options.step:g} s",
                  LOOKS[quantities[0]])
    if options.json:
        sys.stdout.write(text_of(found))
        return
    print(told(out, made))
