"""`dspace contacts`: when bodies, spacecraft and stations stand above the horizon of a site."""
import pathlib
import sys

from dspace.command_line import Failed
from dspace.command_line.measure_ground import opened, out_of, place_of, text_of, write
from dspace.command_line.spans import Span, add_span

STEP = 60.0  # [s]
FILES = (".oem", ".xyzv")  # whatever an existing file is called, it is one of these


def add_arguments(parser):
    add_span(parser, "a file of the contacts: .json, .csv, .html (a report), or .png (a bar for each)", STEP)
    parser.add_argument("--target", action="append", required=True, metavar="BODY[:LON,LAT[,H]]|FILE[:BODY]|FRAME",
                        help="a body or spacecraft (a name or NAIF id); a station on a body: longitude (east), geodetic "
                        "latitude [deg], height above the ellipsoid [m]; a file, an OEM or .xyzv, about BODY (default: the centre that it "
                        "names); with --recording the path of a frame (/orbiter); may be given several times")
    parser.add_argument("--station-mask", type=float, default=0.0, metavar="E",
                        help="least elevation of the site over a station's horizontal [deg] (default: 0)")
    parser.add_argument("--upper", action="store_true",
                        help="the top of a body's disc counts, as for sunrise (default: its centre)")
    parser.set_defaults(run=run)


def is_file(text):
    return text.lower().endswith(FILES) or pathlib.Path(text).is_file()


def target_of(text):
    import dspace
    head, colon, body = text.rpartition(":")
    path = head if is_file(head) else text
    if is_file(path):
        return dspace.Orbiter(path, body if path == head else None)
    body, colon, place = text.partition(":")
    if not colon:
        return body
    return dspace.BodySite(body, *place_of(place, "BODY:LON,LAT[,H]", (2, 3), "--target"), geodetic=True)


def run(options):
    import dspace
    out = out_of(options)
    targets = [target_of(text) for text in options.target]
    if not -90.0 <= options.station_mask <= 90.0:
        raise Failed(f"--station-mask {options.station_mask:g}: accepted: -90 to 90")
    with opened(options) as scene:
        span = Span(scene, options, STEP)
        contacts = scene.contacts(span.place, targets, span.start, span.end, step=span.step, mask=span.mask,
                                  station_mask=options.station_mask, upper=options.upper, body=span.body)
        names = dict(zip(targets, options.target))
        rows = [row_of(scene, names[contact.target], contact) for contact in contacts]
    found = {**span.found, "station_mask_deg": options.station_mask, "contacts": rows}
    if out is not None:
        write(out, found, rows or [dict.fromkeys(HEAD)], lambda figure: draw(figure, span, options.target, rows))
    if options.json:
        sys.stdout.write(text_of(found))
        return
    for row in rows:
        print(told(row))
    for name in options.target:
        total = sum(row["duration_s"] for row in rows if row["target"] == name)
        count = sum(row["target"] == name for row in rows)
        print(f"{name}: {count} contact{'s' if count != 1 else ''}, {total / 3600.0:.3f} h, "
              f"{100.0 * total / (span.end - span.start):.2f} % of the time")
    if out is not None:
        print(f"{out}: {len(rows)} contacts")


MOMENTS = ("rise", "peak", "set")
HEAD = ("target", *(f"{moment}_{name}" for moment in MOMENTS for name in (
    "utc", "tdb_s", "azimuth_deg", "elevation_deg", "range_m")), "duration_s", "since_before", "until_after")


def row_of(scene, name, contact):
    row = {"target": name}
    for moment in MOMENTS:
        at = getattr(contact, moment)
        row.update({f"{moment}_utc": scene.utc(at.time), f"{moment}_tdb_s": at.time, f"{moment}_azimuth_deg": at.azimuth_deg,
                    f"{moment}_elevation_deg": at.elevation_deg, f"{moment}_range_m": at.range})
    return {**row, "duration_s": contact.duration, "since_before": contact.since_before, "until_after": contact.until_after}


def told(row):
    begin = "already up at" if row["since_before"] else "rises"
    end = "still up at" if row["until_after"] else "sets"
    return (f"{row['target']}: {begin} {row['rise_utc']} (azimuth {row['rise_azimuth_deg']:.3f}, elevation "
            f"{row['rise_elevation_deg']:.3f} deg), peak {row['peak_utc']} ({row['peak_elevation_deg']:.3f} deg), {end} "
            f"{row['set_utc']} (azimuth {row['set_azimuth_deg']:.3f}, elevation {row['set_elevation_deg']:.3f} deg), "
            f"{row['duration_s'] / 3600.0:.3f} h, {row['peak_range_m'] / 1000.0:.1f} km")


def draw(figure, span, names, rows):
    axes = figure.subplots()
    day = 86400.0 if span.end - span.start > 2 * 86400.0 else 3600.0
    for i, name in enumerate(names):
        axes.broken_barh([((row["rise_tdb_s"] - span.start) / day, row["duration_s"] / day) for row in rows
                          if row["target"] == name], (i - 0.35, 0.7), color="#2c7a3f")
    axes.set_yticks(range(len(names)), names)
    axes.set_ylim(len(names) - 0.4, -0.6)
    axes.set_xlim(0.0, (span.end - span.start) / day)
    axes.set_xlabel(f"{'days' if day == 86400.0 else 'hours'} after {span.found['start']} UTC")
    axes.set_title(f"Contacts over {span.found['lon_deg']:g}, {span.found['lat_deg']:g}", fontsize=10)
    axes.grid(axis="x", linewidth=0.4)
