"""A study of a lander's site at the Moon's south pole, from terrain to one HTML report: its horizon, when the Sun shines and
for how long it does not, when the Earth's stations are in view, and the power of its panels through the longest night.

    ./dspace python Examples/polar_site/polar_site.py --out out/polar_site

The terrain is generated. With real data (DSPACE_DATA), the light at Connecting Ridge is compared with published figures, by a
horizon of the real Moon (moon_connecting_ridge_horizon.json)."""
import argparse
import json
import os
import pathlib
import sys
import time

import numpy as np

import dspace

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import polar_ground  # noqa: E402

STATIONS = {"Goldstone": dspace.BodySite("earth", -116.8900, 35.4267, 970.0, geodetic=True),
            "Madrid": dspace.BodySite("earth", -4.2480, 40.4314, 830.0, geodetic=True),
            "Canberra": dspace.BodySite("earth", 148.9813, -35.4014, 690.0, geodetic=True)}
MAST = 2.0  # [m]
PANEL = dspace.Panel(area=4.0, efficiency=0.29, tracking="vertical")
BATTERY = dspace.Battery(capacity_wh=20_000.0, load=150.0, charging=0.92)


def parse():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("out/polar_site"), help="folder (default: out/polar_site)")
    parser.add_argument("--side", type=int, default=2000, help="posts along a side of the terrain, 200 to 4000 (default: 2000)")
    parser.add_argument("--start", default="2024-01-01", help="of the span, UTC (default: 2024-01-01)")
    parser.add_argument("--end", default="2027-01-01", help="of the span, UTC (default: 2027-01-01)")
    options = parser.parse_args()
    if not 200 <= options.side <= 4000:
        parser.error(f"--side {options.side}: accepted: 200 to 4000")
    return options


def best_site(z, spacing):
    """The highest post within 10 km of the pole: map x, y [m]."""
    middle, reach = z.shape[0] // 2, int(10_000.0 / spacing)
    inner = z[middle - reach:middle + reach, middle - reach:middle + reach]
    row, column = np.unravel_index(np.argmax(inner), inner.shape)
    return (column - reach + 0.5) * spacing, (reach - row - 0.5) * spacing


def figure(draw, size=(9.0, 3.6)):
    from matplotlib.figure import Figure
    made = Figure(figsize=size, layout="constrained")
    draw(made)
    return made


def ridge(scene, report, start, end):
    """Connecting Ridge by the real Moon's horizon, against published figures."""
    path = pathlib.Path(os.environ.get("DSPACE_DATA", "")) / "terrain" / "moon_connecting_ridge_horizon.json"
    if not path.exists():
        print("no real data: set DSPACE_DATA to compare with Connecting Ridge")
        return None
    known = json.loads(path.read_text())
    place = dspace.BodySite("moon", known["longitude_deg"], known["latitude_deg"], known["terrain_m"] + known["observer_m"])
    found = scene.power_profile(place, dspace.Panel(tracking="full"), start, end, mask=known["elevation_deg"])
    section = report.section("Connecting Ridge, by the real Moon's horizon")
    section.text(f"The horizon is that of LOLA's 20 m terrain out to 100 km, {known['observer_m']:g} m above the ridge at "
                 f"{known['latitude_deg']} N, {known['longitude_deg']} E, every {known['azimuth_step_deg']} degrees, as somebody else computed it. "
                 "The Sun's disc and the ephemeris are ours.")
    section.table([
        {"what": "lit, part of the disc [%]", "here": 100.0 * found.lit_share, "published": "69.61 (1 m terrain), 88.12 (5 m terrain, worst percentile), 92.27 (2 m mast, 19 years)"},
        {"what": "longest night [d]", "here": found.longest_night / 86400.0, "published": "4.00 (5 m terrain, worst percentile)"}])
    section.text("The published figures (Barker et al. 2021; Glaeser et al. 2014) are those of better terrain, at other points of the "
                 "ridge that were chosen for their light, and over other spans. This horizon is of one point, of 20 m terrain.")
    report.inputs(connecting_ridge=path)
    return found


def main():
    options = parse()
    options.out.mkdir(parents=True, exist_ok=True)
    begun = time.monotonic()
    spacing = 40_000.0 / options.side
    ground_file = options.out / "ground.tif"
    z = polar_ground.write(ground_file, options.side, spacing)
    report = dspace.Report("A lander at the Moon's south pole")
    with dspace.Session() as session:
        scene = session.scene()
        start, end = scene.tdb([options.start, options.end])
        terrain = scene.add_terrain(ground_file, name="ground", on_body=True)
        x, y = best_site(z, spacing)
        site = terrain.site(x, y, MAST)
        horizon = scene.horizon(site, 1440)
        where = terrain.locate(horizon.place[None])
        print(f"site {float(where.latitude[0]):.4f} N, {float(where.longitude[0]):.4f} E")

        section = report.section("Site and horizon")
        section.text("The ground is generated. It stands on the Moon's sphere, whose curvature hides what is far away.")
        section.values({"latitude [deg]": float(where.latitude[0]), "longitude [deg]": float(where.longitude[0]), "mast [m]": MAST,
                        "least elevation of the horizon [deg]": horizon.elevation_deg.min(),
                        "greatest elevation [deg]": horizon.elevation_deg.max()})
        sun = scene.sky_track(site, "sun", np.linspace(start, start + 365.25 * 86400.0, 2000))
        earth = scene.sky_track(site, "earth", np.linspace(start, start + 365.25 * 86400.0, 2000))
        section.figure(figure(lambda f: draw_horizon(f, horizon, sun, earth)),
                       "The horizon, with the paths of the Sun's and the Earth's centres over a year.")

        profile = scene.power_profile(site, PANEL, start, end, mask=horizon, battery=BATTERY)
        section = report.section("Light and power")
        section.values({"span": f"{options.start} to {options.end}, hourly", "lit, part of the disc [%]": 100.0 * profile.lit_share,
                        "longest night [h]": profile.longest_night / 3600.0, "it begins": scene.utc(profile.night_start) if np.isfinite(profile.night_start) else "there is none",
                        "energy [kW h]": profile.energy_wh / 1000.0, "least charge [%]": 100.0 * profile.least_charge,
                        "battery empty [h]": profile.empty / 3600.0, "missing [W h]": profile.missing_wh})
        section.figure(figure(lambda f: draw_power(f, profile), (9.0, 5.0)), "Part of the disc over the horizon, and charge of the battery.")
        print(f"lit {100.0 * profile.lit_share:.2f} %, longest night {profile.longest_night / 3600.0:.2f} h, least charge "
              f"{100.0 * profile.least_charge:.1f} %")

        noon = float(profile.time[np.argmax(profile.power)])
        lit = lit_area(scene, terrain, site, horizon, noon)
        section.text(f"At {scene.utc(noon)} UTC rays to the Sun's disc find {lit.lit_area:.3f} of {lit.area:.3f} m² of the panel lit, "
                     f"shadows of the terrain included: {lit.power:.1f} W.")

        section = report.section("Direct to Earth")
        month = (start, start + 30 * 86400.0)
        contacts = scene.contacts(site, list(STATIONS.values()), *month, step=600.0, mask=horizon, station_mask=10.0)
        names = {station: name for name, station in STATIONS.items()}
        section.text("Contacts of the first thirty days: the station over the site's horizon, and the site 10 degrees over the station's.")
        section.figure(figure(lambda f: draw_contacts(f, contacts, names, month)), "")
        section.table([{"station": name, "contacts": sum(c.target is station for c in contacts),
                        "time [%]": 100.0 * sum(c.duration for c in contacts if c.target is station) / (month[1] - month[0])}
                       for name, station in STATIONS.items()])

        section = report.section("Light around the site")
        section.text("A lunation by steps of two hours, two metres above the ground; obstacles are the generated terrain.")
        section.figure(figure(lambda f: draw_maps(f, maps(scene, terrain, options.out, start, spacing), (x, y)), (9.0, 3.4)),
                       "Mean part of the Sun's disc, longest night, and time in sight of a station at which the pole stands 10 degrees or more above the "
                       "horizon. The cross is the site.")

        found = ridge(scene, report, start, end)
        if found:
            print(f"Connecting Ridge: lit {100.0 * found.lit_share:.2f} %, longest night {found.longest_night / 86400.0:.2f} d")
    report.inputs(terrain=ground_file, panel=str(PANEL), battery=str(BATTERY))
    report.write(options.out / "polar_site.html")
    print(f"{options.out / 'polar_site.html'}: {time.monotonic() - begun:.1f} s")


def maps(scene, terrain, out, start, spacing):
    """The light over a lunation within 10 km of the pole: bands of the map, and its edges [m]."""
    from osgeo import gdal
    reach = 10_000.0
    horizons = scene.horizon_map(terrain, out / "horizons.tif", height=MAST, azimuths=180, cell_size=max(5.0 * spacing, 100.0),
                                 extent=(-reach, reach, reach, -reach), replace=True)
    light = scene.illumination_map(horizons, out / "light.tif", start=start, end=start + 29.53 * 86400.0, step=7200.0,
                                   quantities=("lit_fraction", "longest_night", "station_fraction"), stations=list(STATIONS.values()),
                                   station_mask=10.0, terrain=terrain, replace=True)
    return gdal.Open(str(light.path)).ReadAsArray(), (-reach, reach, -reach, reach)


def lit_area(scene, terrain, site, horizon, tdb):
    """The lit area of the panel at a time, by rays: it stands on the mast and faces the Sun's azimuth."""
    at = (float(site.x), float(site.y))
    sun = terrain.sky(*at, "sun", float(site.height), time=tdb)["sun"]
    azimuth = sun.azimuth_deg - horizon.first_deg  # from the terrain's north
    axes = []
    for angles in ((90.0, 0.0), (0.0, 0.0), (0.0, 90.0), (azimuth, 0.0)):  # east, north, up, and the panel's normal
        scene.sun.set(azimuth_deg=angles[0], elevation_deg=angles[1], terrain=terrain, at=at)
        axes.append(np.array(scene.sun.direction))
    up, normal = axes[2], axes[3]
    pose = np.eye(4)
    pose[:3, :3] = np.column_stack((np.cross(up, normal), up, normal))
    pose[:3, 3] = horizon.place
    panel = scene.add_plane(2.0, 2.0, name="panel", frame=scene.add_frame("panel", pose=pose))
    scene.sun.set(azimuth_deg=azimuth, elevation_deg=sun.elevation_deg, terrain=terrain, at=at, radius_deg=sun.radius_deg,
                  distance_au=sun.range / 149597870700.0)
    return scene.lit_area(panel, efficiency=PANEL.efficiency)


def draw_horizon(figure, horizon, sun, earth):
    axes = figure.subplots()
    azimuth = (horizon.azimuth_deg + horizon.first_deg) % 360.0
    order = np.argsort(azimuth)
    axes.plot(sun.azimuth_deg, sun.elevation_deg, ".", color="#e0a020", markersize=1.5, label="Sun")
    axes.plot(earth.azimuth_deg, earth.elevation_deg, ".", color="#3068c0", markersize=1.5, label="Earth")
    axes.fill_between(azimuth[order], horizon.elevation_deg[order], -12.0, color="#b9b1a6", linewidth=0)
    axes.plot(azimuth[order], horizon.elevation_deg[order], color="#5c5348", linewidth=1.0)
    axes.set(xlim=(0.0, 360.0), ylim=(-8.0, 10.0), xlabel="azimuth [deg], clockwise from north", ylabel="elevation [deg]")
    axes.legend(loc="upper right", markerscale=6.0)


def draw_power(figure, profile):
    above, below = figure.subplots(2, 1, sharex=True)
    days = (profile.time - profile.time[0]) / 86400.0
    above.fill_between(days, 100.0 * profile.lit, color="#e0b040", linewidth=0)
    above.set(ylabel="disc [%]", ylim=(0.0, 102.0))
    below.plot(days, 100.0 * profile.charge, color="#2c7a3f", linewidth=0.7)
    below.set(ylabel="charge [%]", xlabel="days", ylim=(-3.0, 103.0), xlim=(0.0, days[-1]))


def draw_maps(figure, made, site):
    bands, edges = made
    for axes, values, name, colors in zip(figure.subplots(1, 3), (100.0 * bands[0], bands[1] / 3600.0, 100.0 * bands[2]),
                                          ("lit [%]", "longest night [h]", "direct to Earth [%]"), ("inferno", "viridis_r", "cividis")):
        shown = axes.imshow(values, extent=[0.001 * edge for edge in edges], cmap=colors)
        axes.plot(0.001 * site[0], 0.001 * site[1], "+", color="#30d0ff", markersize=10)
        axes.set(xlabel="map x [km]", ylabel="map y [km]", title=name)
        figure.colorbar(shown, ax=axes, shrink=0.8)


def draw_contacts(figure, contacts, names, span):
    axes = figure.subplots()
    for i, (station, name) in enumerate(names.items()):
        axes.broken_barh([((c.rise.time - span[0]) / 86400.0, c.duration / 86400.0) for c in contacts if c.target is station],
                         (i - 0.35, 0.7), color="#3068c0")
    axes.set_yticks(range(len(names)), names.values())
    axes.set(xlabel="days", xlim=(0.0, (span[1] - span[0]) / 86400.0))


if __name__ == "__main__":
    main()
