"""`dspace los`: lines of sight over terrain."""
import sys

from dspace.command_line import Failed, lazy
from dspace.command_line.measure_ground import (MeasuredGround, add_ground, opened, out_of, place_of, source_of, text_of, unit_of,
                                                 write)
from dspace.command_line.recorded import recorded_playback

np = lazy("numpy")

STEP = 1.0  # [s] of --time
SAMPLES = 1001  # of the profiles in plots
MOST_PROFILES = 6


def add_arguments(parser):
    add_ground(parser, "a file of the lines: .json, .csv, .html (a report), or .png (profiles; at most the first six lines)")
    parser.add_argument("--from", dest="starts", action="append", required=True, metavar="LON,LAT,H",
                        help="longitude (east), latitude [deg], height above the ground [m]; map x, y in place of degrees "
                        "without a CRS; with --recording also the path of a frame, whose origin counts; may be given several times")
    parser.add_argument("--to", dest="ends", action="append", required=True, metavar="LON,LAT,H",
                        help="where the line ends; as many as --from, or one of either for all of the other")
    parser.add_argument("--wavelength", type=float, metavar="M",
                        help="of radio waves [m]: tells the free part of the first Fresnel zone")
    parser.add_argument("--without", action="append", default=[], metavar="NAME",
                        help="of --recording: an object that is no obstacle, such as an antenna; may be given several times")
    parser.add_argument("--method", choices=("exact", "image", "both"), default="exact",
                        help="exact: rays in double precision; image: a picture from the line's start; both: also what the picture shows, "
                        "and whether it differs (default: exact)")
    parser.add_argument("--time", metavar="T0,T1[,STEP]",
                        help=f"of --recording: print when the lines are clear between two times [s], by samples STEP apart (default: {STEP:g} s) "
                        "and bisection")
    parser.add_argument("--mask", type=float, metavar="E", help="with --time: least elevation of the end over the start's horizontal [deg]")
    parser.set_defaults(run=run)


def run(options):
    out = out_of(options)
    starts = [end_of(text, "--from", options) for text in options.starts]
    ends = [end_of(text, "--to", options) for text in options.ends]
    if options.without and options.recording is None:
        raise Failed("--without: accepted: with --recording")
    if len(starts) != len(ends) and 1 not in (len(starts), len(ends)):
        raise Failed(f"--from is given {len(starts)} times and --to {len(ends)} times; accepted: equal numbers, or one of "
                     "either")
    count = max(len(starts), len(ends))
    starts, ends = (places * count if len(places) == 1 else places for places in (starts, ends))
    if options.time is not None:
        run_span(options, out, starts, ends)
        return
    if options.mask is not None:
        raise Failed("--mask: accepted: with --time")
    with opened(options) as scene:
        ground = MeasuredGround(scene, options)
        if out is not None and out.suffix.lower() in (".png", ".html") and ground.terrain is None:
            raise Failed(f"--out '{out}': the scene has no terrain for profiles; accepted: .json, .csv")
        lines = measure(ground, starts, ends, options)
        rows = rows_of(ground, starts, ends, lines, options.recording is not None)
        found = {**source_of(options, ground), "lines": rows}
        if out is not None:
            points = [[point_of(ground, place) for place in pair] for pair in list(zip(starts, ends))[:MOST_PROFILES]]
            write(out, found, rows, lambda figure: draw(figure, ground, points, lines, rows, options.wavelength))
    if options.json:
        sys.stdout.write(text_of(found))
        return
    for row in rows:
        print(told(row))
    if out is not None:
        print(f"{out}: {count} line{'s' if count != 1 else ''}")


def run_span(options, out, starts, ends):
    """Prints the contacts of lines over a span of the recording's time."""
    if options.recording is None or options.at is not None:
        raise Failed("--time: accepted: with --recording and without --at; `dspace contacts` finds contacts from a site with bodies, "
                     "stations and orbits")
    if options.method != "exact" or options.wavelength is not None:
        raise Failed("--time: accepted: without --wavelength, and with --method exact")
    try:
        times = [float(part) for part in options.time.split(",")]
    except ValueError:
        times = []
    if len(times) not in (2, 3) or not np.isfinite(times).all():
        raise Failed(f"--time {options.time!r}: accepted: T0,T1[,STEP], seconds of the recording")
    begin, finish, step = times if len(times) == 3 else (*times, STEP)
    rows = []
    with recorded_playback(options) as (playback, scene):
        first, last = playback.times[0], playback.times[-1]
        if not (first <= begin < finish <= last):
            raise Failed(f"--time {options.time!r}: {options.recording} runs from {first:g} to {last:g} s; accepted: T0 before T1 within it")
        ground = MeasuredGround(scene, options)
        for start, end in zip(starts, ends):
            start_place, end_place = (place if isinstance(place, str) else ground.site(place) for place in (start, end))
            head = {**end_row(ground, "from", start, True), **end_row(ground, "to", end, True)}
            for contact in scene.sight_contacts(start_place, end_place, begin, finish, step=step, mask=options.mask, playback=playback,
                                                without=options.without):
                rows.append({**head, **contact_row(contact)})
        found = {**source_of(options, ground), "begin_s": begin, "end_s": finish, "step_s": step, "mask_deg": options.mask, "contacts": rows}
        names = [span_name(end_row(ground, "from", start, True), end_row(ground, "to", end, True)) for start, end in zip(starts, ends)]
        if out is not None:
            write(out, found, rows or [dict.fromkeys([*end_row(ground, "from", starts[0], True), *end_row(ground, "to", ends[0], True), *contact_row(None)])],
                  lambda figure: draw_span(figure, begin, finish, names, rows))
    if options.json:
        sys.stdout.write(text_of(found))
        return
    for row in rows:
        print(f"{span_name(row)}: {'already clear at' if row['since_before'] else 'clear from'} {row['rise_s']:.3f} s (azimuth "
              f"{row['rise_azimuth_deg']:.3f}, elevation {row['rise_elevation_deg']:.3f} deg) {'still at' if row['until_after'] else 'to'} "
              f"{row['set_s']:.3f} s (azimuth {row['set_azimuth_deg']:.3f}, elevation {row['set_elevation_deg']:.3f} deg), peak "
              f"{row['peak_elevation_deg']:.3f} deg at {row['peak_s']:.3f} s, range there {row['peak_range_m']:.3f} m")
    for name in names:
        total = sum(row["duration_s"] for row in rows if span_name(row) == name)
        print(f"{name}: clear {total:.3f} s, {100.0 * total / (finish - begin):.2f} % of the time")
    if out is not None:
        print(f"{out}: {len(rows)} contact{'s' if len(rows) != 1 else ''}")


def contact_row(contact):
    """A contact as values of a row; of None their names."""
    row = {}
    for name in ("rise", "peak", "set"):
        at = getattr(contact, name, None)
        row.update({f"{name}_{word}": getattr(at, value, None) for word, value in (
            ("s", "time"), ("azimuth_deg", "azimuth_deg"), ("elevation_deg", "elevation_deg"), ("range_m", "range"))})
    return {**row, **{f"{word}{unit}": getattr(contact, word, None) for word, unit in (
        ("duration", "_s"), ("since_before", ""), ("until_after", ""))}}


def span_name(*rows):
    row = {name: value for each in rows for name, value in each.items()}
    return f"{place_text(row, 'from')} to {place_text(row, 'to')}"


def draw_span(figure, begin, finish, names, rows):
    figure.set_size_inches(9.0, 1.6 + 0.5 * len(names))
    axes = figure.subplots()
    for i, name in enumerate(names):
        axes.broken_barh([(row["rise_s"], row["duration_s"]) for row in rows if span_name(row) == name], (i - 0.35, 0.7), color="#2c7a3f")
    axes.set_yticks(range(len(names)), names)
    axes.set_ylim(len(names) - 0.4, -0.6)
    axes.set_xlim(begin, finish)
    axes.set_xlabel("time of the recording [s]")
    axes.set_title("Clear lines of sight", fontsize=10)
    axes.grid(axis="x", linewidth=0.4)


def end_of(text, option, options):
    """An end of a line: longitude, latitude and height, or the path of a frame of a recording."""
    if options.recording is not None and not all(part.strip().lstrip("+-")[:1].isdigit() for part in text.split(",")):
        return text
    return place_of(text, "LON,LAT,H", (3,), option)


def point_of(ground, place):
    """An end of a line in the terrain's frame [m]; without terrain in the root."""
    if isinstance(place, str):
        return ground.in_terrain(ground.placed(ground.scene.frame(place))[:3, 3])
    site = ground.site(place)
    x, y = float(site.x), float(site.y)
    return ground.terrain.from_map([x, y, ground.terrain.height(x, y, map=True) + float(site.height)])


def measure(ground, starts, ends, options):
    """The lines, in one request where all ends are of one kind."""
    more = {"wavelength": options.wavelength, "without": options.without, "method": options.method}
    if options.recording is None:
        sites = [tuple(map(ground.site, pair)) for pair in zip(starts, ends)]
        x0, y0, h0, x1, y1, h1 = (np.array([float(getattr(pair[k], name)) for pair in sites])
                                  for k in (0, 1) for name in ("x", "y", "height"))
        return ground.scene.line_of_sight(ground.terrain.site(x0, y0, h0), ground.terrain.site(x1, y1, h1), **more)
    # A line each: a Site holds the checks of its terrain, and a frame none.
    ends_of = [[place if isinstance(place, str) else ground.site(place) for place in places] for places in (starts, ends)]
    return joined([ground.scene.line_of_sight(start, end, **more) for start, end in zip(*ends_of)])


def joined(lines):
    """Lines that were measured one by one, as arrays."""
    from dspace.measure.results import LinesOfSight

    def array(name):
        values = [getattr(line, name) for line in lines]
        if name in ("terrain", "object"):
            return np.array([*values, None], dtype=object)[:-1]  # of things that numpy does not look into
        return None if values[0] is None else np.array(values)
    return LinesOfSight(**{name: array(name) for name in LinesOfSight.__dataclass_fields__})


def rows_of(ground, starts, ends, lines, recorded):
    where, names = ground.degrees_of(lines.point), ground.place_names("obstacle_")
    rows = []
    for i, (start, end) in enumerate(zip(starts, ends)):
        row = {**end_row(ground, "from", start, recorded), **end_row(ground, "to", end, recorded), "clear": bool(lines.clear[i]),
               "range_m": lines.range[i],
               "clearance_m": lines.clearance[i], "clearance_deg": lines.clearance_deg[i],
               "obstacle_distance_m": lines.distance[i], names[0]: where[i, 0], names[1]: where[i, 1],
               "obstacle_height_m": where[i, 2], "no_ground_fraction": no_ground(ground, start, end)}
        if recorded:
            row["obstacle"] = lines.object[i].name if lines.object[i] is not None else lines.terrain[i] or None
        if lines.fresnel_free is not None:
            row["fresnel_free"] = lines.fresnel_free[i]
        if lines.image_clear is not None:
            row["image_clear"] = bool(lines.image_clear[i])
            row["image_pixel_deg"] = lines.image_pixel_deg[i] if np.ndim(lines.image_pixel_deg) else lines.image_pixel_deg
            if lines.difference is not None:
                row["difference"] = lines.difference[i]
        rows.append(row)
    return rows


def no_ground(ground, start, end):
    """The part of a line, 0 to 1, below which the terrain has no data: nothing there hides anything. None without terrain."""
    if ground.terrain is None:
        return None
    _, heights = profile(ground, np.array([point_of(ground, place) for place in (start, end)]))
    return float(np.mean(np.isnan(heights)))


def end_row(ground, end, place, recorded):
    """An end as values of a row; every row of a recording has the same ones."""
    frame, place = (place, (None,) * 3) if isinstance(place, str) else (None, place)
    names = ground.place_names(f"{end}_")
    row = {names[0]: place[0], names[1]: place[1], f"{end}_height_m": place[2]}
    return {f"{end}_frame": frame, **row} if recorded else row


def place_text(row, end):
    return row.get(f"{end}_frame") or ",".join(f"{row[f'{end}_{name}']:.9g}" for name in (*names_in(row, f"{end}_"), "height_m"))


def names_in(row, prefix):
    """What the two coordinates of a place of a row are called."""
    return ("lon_deg", "lat_deg") if f"{prefix}lon_deg" in row else ("map_x", "map_y")


def told(row):
    x, y = (row[f"obstacle_{name}"] for name in names_in(row, "obstacle_"))
    text = f"{place_text(row, 'from')} to {place_text(row, 'to')}: " + ("clear" if row["clear"] else (
        f"blocked{' by ' + row['obstacle'] if row.get('obstacle') else ''} after {row['obstacle_distance_m']:.3f} m at "
        f"{x:.7g}, {y:.7g}, height {row['obstacle_height_m']:.3f} m"))
    text += f"; range {row['range_m']:.3f} m"
    if np.isfinite(row["clearance_m"]):  # pictures know none
        text += f", clearance {row['clearance_m']:.3f} m, {row['clearance_deg']:.5f} deg"
    if row["no_ground_fraction"]:
        text += f"; {100.0 * row['no_ground_fraction']:.1f} % of it has no ground below it, where nothing can hide it"
    if "fresnel_free" in row:
        text += f", {row['fresnel_free']:.3f} of the first Fresnel zone"
    if "image_clear" in row:
        text += f"; {row.get('difference') or 'the same in the picture'}" if "difference" in row else (
            f"; in the picture {'clear' if row['image_clear'] else 'blocked'}")
    return text


def profile(ground, ends):
    """Distances along a line [m], and heights of the line over the ground [m] along the local vertical."""
    share = np.linspace(0.0, 1.0, SAMPLES)
    points = ground.terrain.to_map(ends[0] + share[:, None] * (ends[1] - ends[0]))
    return (share * np.linalg.norm(ends[1] - ends[0]),
            points[:, 2] - ground.terrain.height(points[:, 0], points[:, 1], map=True))


def draw(figure, ground, points, lines, rows, wavelength):
    count = len(points)
    down = -(-count // 2)
    figure.set_size_inches(9.0, 4.5 if down == 1 else 2.8 * down)
    for i in range(count):
        axes = figure.add_subplot(down, 1 if count == 1 else 2, i + 1)
        distance, height = profile(ground, np.asarray(points[i]))
        unit, name = unit_of(distance)
        shown = [-height]
        clear = bool(lines.clear[i])
        axes.plot(distance[[0, -1]] / unit, [0, 0], color="#2c7a3f" if clear else "#b3261e", linewidth=1.5)
        if wavelength:
            zone = np.sqrt(wavelength * distance * (distance[-1] - distance) / distance[-1])
            shown += [-zone, zone]
            for edge, label in ((zone, "first Fresnel zone"), (-zone, None)):
                axes.plot(distance / unit, edge, color="#2c56c8", linewidth=0.8, linestyle="--", label=label)
            axes.legend(fontsize=7)
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
