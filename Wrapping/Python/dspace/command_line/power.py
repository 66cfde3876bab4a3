"""`dspace power`: the power of solar panels at a site over a span of time."""
import sys

from dspace.command_line import Failed, lazy
from dspace.command_line.measure_ground import opened, out_of, place_of, text_of, write
from dspace.command_line.spans import Span, add_span

np = lazy("numpy")

STEP = 3600.0  # [s]


def add_arguments(parser):
    add_span(parser, "a file of the profile: .json, .csv, .html (a report), or .png (a plot)", STEP)
    parser.add_argument("--panel", action="append", default=[], metavar="AREA[,AZ,EL]",
                        help="area [m^2], and where the normal points: azimuth, clockwise from north, and elevation [deg] "
                        "(default: up); may be given several times (default: one of 1 m^2)")
    parser.add_argument("--object", action="append", default=[], metavar="NAME",
                        help="of --recording, in place of --panel: an object whose lit faces are cells, with the shadows that the objects of "
                        "the scene throw on it; may be given several times")
    parser.add_argument("--part", action="append", default=[], metavar="NAME", help="of --object: a part that counts (default: all)")
    parser.add_argument("--tracking", choices=("fixed", "vertical", "full"), default="fixed",
                        help="vertical: all panels turn about the vertical, their normals level; full: they face the Sun")
    parser.add_argument("--efficiency", type=float, default=1.0, metavar="E", help="of the cells, 0 to 1 (default: 1)")
    parser.add_argument("--battery", type=float, metavar="WH", help="capacity of a battery [W h]")
    parser.add_argument("--load", type=float, default=0.0, metavar="W", help="that panels and battery supply [W] (default: 0)")
    parser.add_argument("--charge", type=float, default=1.0, metavar="C", help="of the battery at the start, 0 to 1 (default: 1)")
    parser.add_argument("--charging", type=float, default=1.0, metavar="C",
                        help="part of the energy that arrives when the battery charges, 0 to 1 (default: 1)")
    parser.set_defaults(run=run)


def run(options):
    import dspace
    out = out_of(options)
    if options.battery is None and options.load:
        raise Failed("--load: accepted: with --battery")
    if options.object and (options.recording is None or options.panel or options.tracking != "fixed"):
        raise Failed("--object: accepted: with --recording, without --panel and --tracking")
    if options.part and not options.object:
        raise Failed("--part: accepted: with --object")
    panels = []
    for text in () if options.object else options.panel or ["1"]:
        area, azimuth, elevation = (*place_of(text, "AREA[,AZ,EL]", (1, 3), "--panel"), 0.0, 90.0)[:3]
        panels.append(dspace.Panel(area, options.efficiency, azimuth, elevation, options.tracking))
    battery = options.battery and dspace.Battery(options.battery, options.load, options.charge, options.charging)
    with opened(options) as scene:
        span = Span(scene, options, STEP)
        if options.object:
            panels = [scene.projected_areas(options.object, span.place, parts=options.part, efficiency=options.efficiency)]
        profile = scene.power_profile(span.place, panels, span.start, span.end, step=span.step, mask=span.mask, battery=battery,
                                      body=span.body)
        utc = scene.utc(profile.time)
        night = scene.utc(profile.night_start) if np.isfinite(profile.night_start) else None
    columns = {"utc": utc, "tdb_s": profile.time.tolist(), "sun_azimuth_deg": profile.sun_azimuth_deg.tolist(),
               "sun_elevation_deg": profile.sun_elevation_deg.tolist(), "lit": profile.lit.tolist(),
               "power_w": profile.power.tolist()}
    if battery:
        columns["charge"] = profile.charge.tolist()
    rows = [dict(zip(columns, values)) for values in zip(*columns.values())]
    totals = {"lit_percent": 100.0 * profile.lit_share, "energy_wh": profile.energy_wh, "longest_night_s": profile.longest_night,
              "night_start": night}
    if battery:
        totals.update(least_charge=profile.least_charge, empty_s=profile.empty, missing_wh=profile.missing_wh)
    found = {**span.found, **totals, "samples": rows}
    if out is not None:
        write(out, found, rows, lambda figure: draw(figure, span, profile))
    if options.json:
        sys.stdout.write(text_of(found))
        return
    print(f"lit {totals['lit_percent']:.3f} % of the time, {profile.energy_wh:.6g} W h, longest night "
          f"{profile.longest_night / 3600.0:.4f} h" + (f" from {night}" if night else ""))
    if battery:
        print(f"battery: least charge {100.0 * profile.least_charge:.2f} %, empty for {profile.empty / 3600.0:.4f} h, "
              f"{profile.missing_wh:.6g} W h missing")
    if out is not None:
        print(f"{out}: {len(rows)} samples")


def draw(figure, span, profile):
    """Power, charge and the Sun over time."""
    count = 2 if profile.charge is None else 3
    plots = figure.subplots(count, 1, sharex=True)
    figure.set_size_inches(9.0, 2.0 * count + 0.5)
    day = 86400.0 if span.end - span.start > 2 * 86400.0 else 3600.0
    time = (profile.time - profile.time[0]) / day
    plots[0].fill_between(time, profile.power, color="#e0b040", linewidth=0)
    plots[0].set_ylabel("power [W]")
    plots[0].set_ylim(bottom=0.0)
    plots[0].set_title(f"Panels at {span.found['lon_deg']:g}, {span.found['lat_deg']:g}: lit {100.0 * profile.lit_share:.2f} % of the "
                       f"time, longest night {profile.longest_night / 3600.0:.1f} h", fontsize=10)
    if profile.charge is not None:
        plots[1].plot(time, 100.0 * profile.charge, color="#2c7a3f", linewidth=1.0)
        plots[1].set_ylabel("charge [%]")
        plots[1].set_ylim(-3.0, 103.0)
    plots[-1].plot(time, profile.sun_elevation_deg, color="#5c5348", linewidth=0.8)
    plots[-1].axhline(0.0, color="#808080", linewidth=0.6)
    plots[-1].set_ylabel("Sun's elevation [deg]")
    plots[-1].set_xlabel(f"{'days' if day == 86400.0 else 'hours'} after {span.found['start']} UTC")
    plots[-1].set_xlim(0.0, time[-1])
