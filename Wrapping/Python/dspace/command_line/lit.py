"""`dspace lit`: the sunlit area of a flat panel over terrain, and the power of its solar cells."""
import pathlib
import sys

from dspace.command_line import Failed, lazy
from dspace.command_line.horizon import draw
from dspace.command_line.measure_ground import MeasuredGround, add_ground, opened, out_of, place_of, source_of, text_of, write
from dspace.command_line.sky import check

np = lazy("numpy")

AU = 149597870700.0
SUN_RADIUS_DEG = 0.2666  # at 1 au
MOST_SAMPLES = 1_000_000
ENDINGS = (".json", ".csv", ".html", ".png")
PLOTS = (".html", ".png")
PLOTTED_AZIMUTHS = 720


def add_arguments(parser):
    add_ground(parser, "a file of the result: .json, .csv, .html or .png (a plot)")
    place = parser.add_mutually_exclusive_group(required=True)
    place.add_argument("--site", metavar="LON,LAT", help="longitude (east) and latitude [deg]; map x and y without a CRS")
    place.add_argument("--object", action="append", metavar="NAME",
                       help="of --recording, in place of a panel at --site: an object of the scene, by the recorded Sun; may be given "
                       "several times")
    place.add_argument("--frame", metavar="PATH",
                       help="of --recording: a panel at the origin of a frame, by the recorded Sun; --facing is relative to the frame: AZ "
                       "clockwise from its Y axis, EL above its X-Y plane")
    parser.add_argument("--height", type=float, default=1.0, metavar="H",
                        help="of the panel's centre above the ground [m], 0 or more (default: 1)")
    parser.add_argument("--panel", default="1,1", metavar="W,H",
                        help="width (level) and height (along the slope of the panel) [m] (default: 1,1)")
    parser.add_argument("--facing", default="0,90", metavar="AZ,EL",
                        help="azimuth, clockwise from north, and elevation of the panel's normal [deg] (default: 0,90, up)")
    parser.add_argument("--sun", metavar="AZ,EL", help="azimuth and elevation of the Sun at the site [deg]")
    parser.add_argument("--time", metavar="UTC",
                        help="in place of --sun: UTC in ISO 8601, or with ' TDB', ' TT' or ' TAI' behind it; needs a terrain "
                        "with longitudes and latitudes on a known body")
    parser.add_argument("--body", metavar="BODY", help="the body of --time (default: the one that the terrain's CRS names)")
    parser.add_argument("--radius-deg", type=float, metavar="R",
                        help="angular radius of the Sun's disc, 0 to 90 (default: that of --time, or 0.2666 divided by "
                        "--distance-au)")
    parser.add_argument("--irradiance", type=float, metavar="W",
                        help="on a surface that faces the Sun [W/m^2] (default: that of the distance)")
    parser.add_argument("--distance-au", type=float, metavar="D",
                        help="from the Sun [au]: the irradiance is 1361 / D^2 (default: that of --time, or 1)")
    parser.add_argument("--efficiency", type=float, default=1.0, metavar="E", help="of the cells, 0 to 1 (default: 1)")
    parser.add_argument("--samples", type=int, default=4096, metavar="N",
                        help="places of the panel that are tested, 1 to 1000000 (default: 4096)")
    parser.set_defaults(run=run)


def run(options):
    if options.out is not None and pathlib.Path(options.out).suffix.lower() not in ENDINGS:
        raise Failed(f"--out '{options.out}': accepted: a name with {', '.join(ENDINGS)}")
    out = out_of(options)
    if options.object or options.frame is not None:
        run_recorded(options, out)
        return
    place = place_of(options.site, "LON,LAT", (2,), "--site")
    size = size_of(options.panel)
    facing = angles_of(options.facing, "--facing")
    check_sun(options)
    check("--efficiency", options.efficiency, 0.0, 1.0)
    if not 1 <= options.samples <= MOST_SAMPLES:
        raise Failed(f"--samples {options.samples}: accepted: 1 to {MOST_SAMPLES}")
    with opened(options) as scene:
        ground = MeasuredGround(scene, options)
        site = ground.site((*place, options.height))
        panel = add_panel(ground.scene, site, size, facing)
        sun = sun_of(ground, site, options)
        left = sun.pop("left")
        put_sun(ground.scene, site, sun.pop("angles"), **sun)
        lit = ground.scene.lit_area(panel, efficiency=options.efficiency, samples=options.samples)
        azimuth, elevation = ground.scene.sun.angles(site.terrain, (float(site.x), float(site.y)))
        radius = ground.scene.sun.radius_deg
        horizon = ground.scene.horizon(site, PLOTTED_AZIMUTHS, without=panel) if out is not None and out.suffix.lower() in PLOTS else None
        source, names = source_of(options, ground), ground.place_names()
    row = {names[0]: place[0], names[1]: place[1], "height_m": options.height, "width_m": size[0], "panel_height_m": size[1],
           "facing_azimuth_deg": facing[0], "facing_elevation_deg": facing[1], "sun_azimuth_deg": azimuth,
           "sun_elevation_deg": elevation, "sun_radius_deg": radius, "irradiance_w_m2": lit.irradiance,
           "efficiency": options.efficiency, "sun_left": left, "area_m2": lit.area, "lit_area_m2": left * lit.lit_area,
           "lit_percent": 100.0 * left * lit.fraction, "projected_area_m2": left * lit.projected_area, "power_w": left * lit.power}
    found = {**source, **row}
    if options.time is not None:
        found["time"] = options.time
    if out is not None:
        write(out, found, [row], horizon and (lambda figure: draw_sun(figure, horizon, row)))
    if options.json:
        sys.stdout.write(text_of(found))
        return
    print(told(row))
    if out is not None:
        print(f"{out}: 1 panel")


def run_recorded(options, out):
    """Objects of a recorded scene, or a panel at a frame of it."""
    option = "--object" if options.object else "--frame"
    if options.recording is None:
        raise Failed(f"{option}: accepted: with --recording")
    for name in ("sun", "time", "radius_deg", "irradiance", "distance_au"):
        if getattr(options, name) is not None:
            raise Failed(f"--{name.replace('_', '-')}: accepted: without {option}, since the recorded Sun gives the light")
    check("--efficiency", options.efficiency, 0.0, 1.0)
    with opened(options) as scene:
        objects = options.object or [_panel_on(scene, options)]
        lit = scene.lit_area(objects, efficiency=options.efficiency, samples=options.samples)
        source = {"recording": str(options.recording), "at_s": options.at}
    kind, names = ("object", options.object) if options.object else ("frame", [options.frame])
    rows = [{kind: name, "irradiance_w_m2": float(lit.irradiance), "efficiency": options.efficiency, "sun_left": float(lit.sun_left[k]),
             "area_m2": float(lit.area[k]), "lit_area_m2": float(lit.lit_area[k]), "lit_percent": 100.0 * float(lit.fraction[k]),
             "projected_area_m2": float(lit.projected_area[k]), "power_w": float(lit.power[k])}
            for k, name in enumerate(names)]
    found = {**source, f"{kind}s": rows}
    if out is not None:
        write(out, found, rows, lambda figure: draw_areas(figure, names, rows))
    if options.json:
        sys.stdout.write(text_of(found))
        return
    for row in rows:
        print(f"{row[kind]}: {row['lit_area_m2']:.6g} of {row['area_m2']:.6g} m^2 lit ({row['lit_percent']:.2f} %), projected area "
              f"{row['projected_area_m2']:.6g} m^2, power {row['power_w']:.6g} W; {row['irradiance_w_m2']:.6g} W/m^2"
              f"{eclipse_of(row)}")
    if out is not None:
        print(f"{out}: {len(rows)} {kind}s")


def _panel_on(scene, options):
    """A panel at the origin of a frame."""
    size, facing = size_of(options.panel), angles_of(options.facing, "--facing")
    pose = np.eye(4)
    pose[:3, :3] = np.transpose(panel_axes(facing))
    return scene.add_plane(*size, name="panel of the measurement",
                           frame=scene.add_frame("panel of the measurement", parent=options.frame.lstrip("/"), pose=pose))


def size_of(text):
    size = place_of(text, "W,H", (2,), "--panel")
    if not all(0.0 < side <= 1e6 for side in size):
        raise Failed(f"--panel {text!r}: accepted: W,H, each above 0 to 1e6 m")
    return size


def panel_axes(facing):
    """The axes of a panel, as rows, in axes X east, Y north, Z up: along its width, up its slope, and its normal."""
    azimuth, elevation = np.radians(facing)
    normal = (np.cos(elevation) * np.sin(azimuth), np.cos(elevation) * np.cos(azimuth), np.sin(elevation))
    slope = (-np.sin(elevation) * np.sin(azimuth), -np.sin(elevation) * np.cos(azimuth), np.cos(elevation))
    return np.cross(slope, normal), slope, normal


def angles_of(text, option):
    """Azimuth and elevation [deg] of "AZ,EL"."""
    azimuth, elevation = place_of(text, "AZ,EL", (2,), option)
    if not (abs(azimuth) <= 360.0 and abs(elevation) <= 90.0):
        raise Failed(f"{option} {text!r}: accepted: AZ,EL, with AZ -360 to 360 and EL -90 to 90 deg")
    return azimuth, elevation


def check_sun(options):
    """Rejects wrong options of the Sun."""
    if (options.sun is None) == (options.time is None):
        raise Failed("--sun AZ,EL, --time UTC: " + ("both are" if options.sun else "neither is") + " given; accepted: one of them")
    if options.sun is not None:
        angles_of(options.sun, "--sun")
    if options.body is not None and options.time is None:
        raise Failed("--body: accepted: with --time")
    if options.irradiance is not None and options.distance_au is not None:
        raise Failed("--irradiance, --distance-au: accepted: at most one of them")
    check("--radius-deg", options.radius_deg, 0.0, 90.0)
    check("--irradiance", options.irradiance, 0.0, 1.361e15)
    check("--distance-au", options.distance_au, 1e-6, 1e6)


def put_sun(scene, site, angles, **more):
    """Sets the Sun by azimuth and elevation [deg] at the site."""
    scene.sun.set(azimuth_deg=angles[0], elevation_deg=angles[1], terrain=site.terrain, at=(float(site.x), float(site.y)),
                  **more)


def add_panel(scene, site, size, facing):
    """Adds the panel. Sets the Sun to find the local axes in the root."""
    centre = scene.horizon(site, 1).place  # rejects sites off the data
    axes = []  # east, north, up
    for angles in ((90.0, 0.0), (0.0, 0.0), (0.0, 90.0)):
        put_sun(scene, site, angles)
        axes.append(scene.sun.direction)
    pose = np.eye(4)
    pose[:3, :3] = np.transpose(axes) @ np.transpose(panel_axes(facing))
    pose[:3, 3] = centre
    return scene.add_plane(*size, name="panel", frame=scene.add_frame("panel", pose=pose))


def sun_of(ground, site, options):
    """The angles at the site, the radius, and the irradiance or the distance of the Sun: arguments of put_sun(); and
    `left`, the part of its disc that an eclipse leaves."""
    distance, radius, left = options.distance_au, options.radius_deg, 1.0
    if options.time is None:
        angles = angles_of(options.sun, "--sun")
        if radius is None:
            radius = min(SUN_RADIUS_DEG / (distance or 1.0), 90.0)
    else:
        if not ground.crs:
            raise Failed(f"--time {options.time!r}: {options.terrain} has no CRS; accepted: a terrain with longitudes and "
                         "latitudes on a known body, or --sun AZ,EL")
        time = ground.scene.tdb(options.time)
        sky = ground.terrain.sky(float(site.x), float(site.y), "sun", float(site.height), body=options.body, time=time)["sun"]
        # The sky counts azimuths from the meridian's north, and the Sun of the scene from the terrain's.
        north = ground.scene.horizon(site, 1).first_deg
        angles = ((sky.azimuth_deg - north) % 360.0, sky.elevation_deg)
        distance = distance or sky.range / AU
        radius = sky.radius_deg if radius is None else radius
        left = sky.lit_fraction
    if options.irradiance is not None:
        return {"angles": angles, "radius_deg": radius, "irradiance": options.irradiance, "left": left}
    return {"angles": angles, "radius_deg": radius, "distance_au": distance or 1.0, "left": left}


def draw_sun(figure, horizon, row):
    """The horizon of the panel with the Sun's disc over it."""
    draw(figure, horizon, f"the panel: {row['lit_percent']:.2f} % lit, power {row['power_w']:.6g} W")
    above = figure.axes[0]
    angle = np.linspace(0.0, 2.0 * np.pi, 73)
    radius, elevation = row["sun_radius_deg"], row["sun_elevation_deg"]
    wide = radius / max(np.cos(np.radians(elevation)), 0.01)
    above.fill(row["sun_azimuth_deg"] % 360.0 + wide * np.cos(angle), elevation + radius * np.sin(angle), color="#d98200", zorder=1)
    above.plot(row["sun_azimuth_deg"] % 360.0, elevation, "+", color="#d98200", markersize=14, zorder=3, label="Sun")
    above.legend(fontsize=8, loc="upper right")
    bottom, top = above.get_ylim()
    above.set_ylim(min(bottom, elevation - radius - 1.0), max(top, elevation + radius + max(1.0, 0.06 * (elevation - bottom))))


def draw_areas(figure, names, rows):
    """The areas of each object."""
    axes = figure.subplots()
    place = np.arange(len(rows))
    for k, (key, label, colour) in enumerate((("area_m2", "area", "#b9b1a6"), ("lit_area_m2", "sunlit", "#d98200"),
                                              ("projected_area_m2", "projected towards the Sun", "#2c56c8"))):
        bars = axes.bar(place + 0.27 * (k - 1), [row[key] for row in rows], 0.25, color=colour, label=label)
        axes.bar_label(bars, fmt="%.4g", fontsize=8)
    axes.set_xticks(place, [f"{name}\n{row['lit_percent']:.2f} % lit, {row['power_w']:.6g} W" for name, row in zip(names, rows)])
    axes.set_ylabel("area [m$^2$]")
    axes.margins(x=0.3 / len(rows), y=0.15)
    axes.legend(fontsize=8)


def told(row):
    x, y = list(row.values())[:2]  # of the site
    return (f"{x:.9g},{y:.9g}: {row['lit_area_m2']:.6g} of {row['area_m2']:.6g} m^2 lit "
            f"({row['lit_percent']:.2f} %), projected area {row['projected_area_m2']:.6g} m^2, power {row['power_w']:.6g} W; Sun "
            f"azimuth {row['sun_azimuth_deg']:.5f}, elevation {row['sun_elevation_deg']:.5f} deg, "
            f"{row['irradiance_w_m2']:.6g} W/m^2{eclipse_of(row)}")


def eclipse_of(row):
    """The words for an eclipse; empty: there is none, or it is night."""
    if row["sun_left"] >= 1.0 or row.get("sun_elevation_deg", 90.0) < -1.0:
        return ""
    return f"; an eclipse leaves {100.0 * row['sun_left']:.6g} % of the Sun's disc"
