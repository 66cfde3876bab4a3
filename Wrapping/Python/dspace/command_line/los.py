"""`dspace los`: lines of sight over terrain."""
import sys

from dspace.command_line import Failed, lazy
from dspace.command_line.measure_ground import MeasuredGround, add_ground, out_of, place_of, text_of, unit_of, write

np = lazy("numpy")

SAMPLES = 1001  # of the profiles in plots
MOST_PROFILES = 6


def add_arguments(parser):
    add_ground(parser, "a file of the lines: .json, .csv, .html (a report), or .png (profiles; at most the first six lines)")
    parser.add_argument("--from", dest="starts", action="append", required=True, metavar="LON,LAT,H",
                        help="longitude (east), latitude [deg], height above the ground [m]; map x, y in place of degrees "
                        "without a CRS; may be given several times")
    parser.add_argument("--to", dest="ends", action="append", required=True, metavar="LON,LAT,H",
                        help="where the line ends; as many as --from, or one of either for all of the other")
    parser.add_argument("--wavelength", type=float, metavar="M",
                        help="of radio waves [m]: tells the free part of the first Fresnel zone")
    parser.set_defaults(run=run)


def run(options):
    import dspace
    out = out_of(options)
    starts = [place_of(text, "LON,LAT,H", (3,), "--from") for text in options.starts]
    ends = [place_of(text, "LON,LAT,H", (3,), "--to") for text in options.ends]
    if len(starts) != len(ends) and 1 not in (len(starts), len(ends)):
        raise Failed(f"--from is given {len(starts)} times and --to {len(ends)} times; accepted: equal numbers, or one of "
                     "either")
    count = max(len(starts), len(ends))
    starts, ends = (places * count if len(places) == 1 else places for places in (starts, ends))
    with dspace.Session() as session:
        ground = MeasuredGround(session.scene(), options)
        sites = [tuple(map(ground.site, pair)) for pair in zip(starts, ends)]
        x0, y0, h0, x1, y1, h1 = (np.array([float(getattr(pair[k], name)) for pair in sites])
                                  for k in (0, 1) for name in ("x", "y", "height"))
        lines = ground.scene.line_of_sight(ground.terrain.site(x0, y0, h0), ground.terrain.site(x1, y1, h1),
                                           wavelength=options.wavelength)
        rows = rows_of(ground, starts, ends, lines)
        if out is not None:
            write(out, {"terrain": str(options.terrain), "on_body": ground.on_body, "lines": rows}, rows,
                  lambda figure: draw(figure, ground, sites, lines, rows, options.wavelength))
    if options.json:
        sys.stdout.write(text_of({"terrain": str(options.terrain), "on_body": ground.on_body, "lines": rows}))
        return
    for row in rows:
        print(told(row))
    if out is not None:
        print(f"{out}: {count} line{'s' if count != 1 else ''}")


def rows_of(ground, starts, ends, lines):
    where = ground.degrees_of(lines.point)
    rows = []
    for i, (start, end) in enumerate(zip(starts, ends)):
        row = {"from_lon_deg": start[0], "from_lat_deg": start[1], "from_height_m": start[2], "to_lon_deg": end[0],
               "to_lat_deg": end[1], "to_height_m": end[2], "clear": bool(lines.clear[i]), "range_m": lines.range[i],
               "clearance_m": lines.clearance[i], "clearance_deg": lines.clearance_deg[i],
               "obstacle_distance_m": lines.distance[i], "obstacle_lon_deg": where[i, 0], "obstacle_lat_deg": where[i, 1],
               "obstacle_height_m": where[i, 2]}
        if lines.fresnel_free is not None:
            row["fresnel_free"] = lines.fresnel_free[i]
        rows.append(row)
    return rows


def place_text(row, end):
    return ",".join(f"{row[f'{end}_{name}']:.9g}" for name in ("lon_deg", "lat_deg", "height_m"))


def told(row):
    text = f"{place_text(row, 'from')} to {place_text(row, 'to')}: " + ("clear" if row["clear"] else (
        f"blocked after {row['obstacle_distance_m']:.3f} m at {row['obstacle_lon_deg']:.7g}, "
        f"{row['obstacle_lat_deg']:.7g}, height {row['obstacle_height_m']:.3f} m"))
    text += f"; range {row['range_m']:.3f} m, clearance {row['clearance_m']:.3f} m, {row['clearance_deg']:.5f} deg"
    if "fresnel_free" in row:
        text += f", {row['fresnel_free']:.3f} of the first Fresnel zone"
    return text


def profile(ground, start, end):
    """Distances along a line [m], and heights of the line over the ground [m] along the local vertical."""
    places = np.stack([ground.terrain.height(float(site.x), float(site.y), map=True) + float(site.height)
                       for site in (start, end)])
    ends = ground.terrain.from_map([[float(site.x), float(site.y), place] for site, place in zip((start, end), places)])
    share = np.linspace(0.0, 1.0, SAMPLES)
    points = ground.terrain.to_map(ends[0] + share[:, None] * (ends[1] - ends[0]))
    return (share * np.linalg.norm(ends[1] - ends[0]),
            points[:, 2] - ground.terrain.height(points[:, 0], points[:, 1], map=True))


def draw(figure, ground, sites, lines, rows, wavelength):
    count = min(len(sites), MOST_PROFILES)
    down = -(-count // 2)
    figure.set_size_inches(9.0, 4.5 if down == 1 else 2.8 * down)
    for i in range(count):
        axes = figure.add_subplot(down, 1 if count == 1 else 2, i + 1)
        distance, height = profile(ground, *sites[i])
        unit, name = unit_of(distance)
        shown = [-height]
        clear = bool(lines.clear[i])
        axes.plot(distance[[0, -1]] / unit, [0, 0], color="#2c7a3f" if clear else "#b3261e", linewidth=1.5)
        if wavelength:
            shown.append(-np.sqrt(wavelength * distance * (distance[-1] - distance) / distance[-1]))
            axes.plot(distance / unit, shown[1], color="#2c56c8", linewidth=0.8, linestyle="--")
        low, high = np.nanmin(shown), max(np.nanmax(shown), 0.0)
        foot = low - 0.05 * max(high - low, 1e-3)
        axes.fill_between(distance / unit, -height, foot, color="#b9b1a6", linewidth=0)
        axes.plot(distance / unit, -height, color="#5c5348", linewidth=1.0)
        axes.set_ylim(bottom=foot)
        if not clear:
            axes.plot([lines.distance[i] / unit], [0], "o", color="#b3261e", markersize=5)
        axes.set_title(f"{place_text(rows[i], 'from')} to {place_text(rows[i], 'to')}\n{'clear' if clear else 'blocked'}, "
                       f"clearance {lines.clearance[i]:.3g} m", fontsize=9)
        axes.set_xlabel(f"distance along the line [{name}]")
        axes.set_ylabel("ground from the line [m]")
        axes.margins(x=0)
