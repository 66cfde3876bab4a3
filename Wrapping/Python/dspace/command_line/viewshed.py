"""`dspace viewshed`: the ground that is seen from sites on terrain."""
import sys

from dspace.command_line import Failed, lazy
from dspace.command_line.measure_ground import MeasuredGround, add_ground, opened, place_of, source_of, text_of
from dspace.command_line.measure_map import (Look, add_map, common, extent_of, map_out, require_gdal, told, write_map,
                                             written_to)

np = lazy("numpy")

LOOKS = {"visible": Look("seen", "viridis", names=("no", "yes")), "least_height": Look("least height that is seen [m]", "magma_r", 0.0),
         "count": Look("sites that see it", "viridis", 0.0, whole=True)}


def add_arguments(parser):
    add_ground(parser, "the map: .tif (GeoTIFF), .png (the first quantity), .csv (a row a cell) or .json (a summary)")
    parser.add_argument("--site", action="append", default=[], metavar="LON,LAT",
                        help="longitude (east) and latitude [deg]; map x and y without a CRS; may be given several times")
    parser.add_argument("--frame", action="append", default=[], metavar="PATH",
                        help="of --recording: from the origin of a frame, as high as it is; may be given several times")
    parser.add_argument("--height", type=float, default=2.0, metavar="H",
                        help="of --site above the ground [m], 0 to 1e6 (default: 2)")
    parser.add_argument("--target-height", type=float, default=0.0, metavar="H",
                        help="of what is seen above the ground of each cell [m], 0 to 1e6 (default: 0)")
    parser.add_argument("--radius", type=float, metavar="R", help="greatest distance along the ground [m] (default: no limit)")
    parser.add_argument("--quantity", action="append", choices=tuple(LOOKS),
                        help="visible, least_height (of a target that would be seen) or count (of the sites that see the "
                        "target); may be given several times (default: visible)")
    add_map(parser)
    parser.set_defaults(run=run)


def run(options):
    out = map_out(options)
    places = [place_of(site, "LON,LAT", (2,), "--site") for site in options.site]
    if options.radius is not None and not options.radius > 0.0:
        raise Failed(f"--radius {options.radius}: accepted: more than 0 m")
    if out.suffix.lower() != ".tif":
        require_gdal()
    if not places and not options.frame:
        raise Failed("--site, --frame: neither is given; accepted: one or more places")
    quantities = tuple(options.quantity or ("visible",))
    with opened(options) as scene:
        ground = MeasuredGround(scene, options)
        sites = [ground.site((*place, options.height)) for place in places] + [ground.below(frame) for frame in options.frame]
        sites = ground.terrain.site(*([float(getattr(site, name)) for site in sites] for name in ("x", "y", "height")))
        with written_to(out) as path:
            made = ground.scene.viewshed(sites, path, target_height=options.target_height, radius=options.radius,
                                         quantities=quantities, extent=extent_of(options), cell_size=options.cell_size,
                                         replace=options.replace, **common(options))
            found = {**source_of(options, ground), "sites": _places(ground, places, options),
                     "target_height_m": options.target_height, "radius_m": options.radius, "columns": made.columns,
                     "rows": made.rows, "cell_size": made.cell_size}
            where = " and ".join([*(f"{place[0]:g}, {place[1]:g}" for place in places), *options.frame][:3])
            where += f" and {len(sites.x) - 3} more" if len(sites.x) > 3 else ""
            high = f", {options.height:g} m above the ground" if places else ""
            write_map(out, made, found, f"Seen from {where}{high}", LOOKS[quantities[0]],
                      np.column_stack((sites.x, sites.y)))
    if options.json:
        sys.stdout.write(text_of(found))
        return
    print(told(out, made))


def _places(ground, places, options):
    rows = [{**dict(zip(ground.place_names(), place)), "height_m": options.height} for place in places]
    for frame in options.frame:
        site = ground.below(frame)
        rows.append({"frame": frame, "map_x": float(site.x), "map_y": float(site.y), "height_m": float(site.height)})
    return rows
