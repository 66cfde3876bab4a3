"""Pictures of the sky."""
import math

import numpy as np

import dspace
from dspace._core.png import png
from dspace.command_line import main
from dspace.frames.poses import quaternion_of_matrix
from pictures.paths import DATA, IMAGES

MOON = {"path": f"{DATA}/terrain/moon_lola_global_4ppd_km.tif", "vertical_scale": 1000.0, "vertical_datum": "sphere:1737400"}
MARS = {"path": f"{DATA}/terrain/mars_mola_megt90n000cb_4ppd_m.tif", "vertical_datum": "sphere:3396190", "patches": [
    dict(path=f"{DATA}/terrain/mars_gale_mola_128ppd_m.tif", vertical_datum="sphere:3396190"),
    dict(path=f"{DATA}/terrain/mars_gale_hirise_DTEEC_009650_5m_relative_u16.tif", vertical_datum="sphere:3396190",
         vertical_scale=0.00245, vertical_offset=-4029, margin=150)]}


def stars():
    """Orion and Sirius as the Bright Star Catalogue has them."""
    with dspace.Session() as session:
        scene = session.scene()
        scene.add_stars(gain=6e5, spread=0.9)
        ra, dec = math.radians(88.0), math.radians(-3.0)
        target = (math.cos(dec) * math.cos(ra), math.cos(dec) * math.sin(ra), math.sin(dec))
        camera = scene.add_camera(eye=(0, 0, 0), target=target, fov_deg=38)
        scene.add_viewport((960, 540), camera, samples=2).save(IMAGES / "stars.png")


def constellations():
    """Scorpius and what is around it: figures, names, and the ecliptic's grid."""
    with dspace.Session() as session:
        scene = session.scene()
        scene.add_stars(gain=6e5, spread=0.9)
        scene.add_sky_grid("ecliptic")
        lines = f"{DATA}/stars/constellations_lines.json"
        scene.add_constellations(lines)
        scene.add_constellation_names(lines)
        ra, dec = math.radians(258.0), math.radians(-26.0)
        target = (math.cos(dec) * math.cos(ra), math.cos(dec) * math.sin(ra), math.sin(dec))
        camera = scene.add_camera(eye=(0, 0, 0), target=target, fov_deg=48)
        scene.add_viewport((960, 540), camera, samples=2).save(IMAGES / "constellations.png")


def planets():
    """Jupiter, Mars and the waning Moon in Leo over Munich, with the ecliptic's grid, by the command line."""
    main(["sky", "--time", "2026-11-28T05:00", "--site", "11.6,48.1", "--look-at", "jupiter", "--fov", "36", "--size", "960x540",
          "--grid", "ecliptic", "--constellations", f"{DATA}/stars/constellations_lines.json", "--out", str(IMAGES / "planets.png")])


def body_descent():
    """Mars from deep space to 2 m above the floor of Gale crater, in one scene."""
    size = (480, 300)
    with dspace.Session() as session:
        scene = session.scene()
        scene.add_body("mars", terrain=MARS, texture=f"{DATA}/textures/mars_viking_mdim21_color_2880.jpg")
        ground = scene.terrains["mars terrain"]

        def place(longitude, latitude, above):
            return ground.from_map([longitude, latitude, float(ground.height(longitude, latitude, map=True)) + above])

        site = place(137.3334, -4.7993, 0.0)
        up = site / np.linalg.norm(site)
        east = np.cross((0.0, 0.0, 1.0), up)
        east /= np.linalg.norm(east)
        north = np.cross(up, east)
        scene.sun.set(direction=tuple(0.75 * east + 0.15 * north + 0.6 * up), distance_au=1.52)
        views = ((1.1e7 * up - 3e6 * north, 0.0 * up, 40), (site + 2.5e5 * up - 1.2e5 * north, site, 45),
                 (place(137.3, -4.3, 3500.0), place(137.7, -5.1, 0.0), 55),
                 (place(137.3334, -4.7993, 2.0), place(137.5, -5.0, 100.0), 55))
        pictures = []
        for eye, target, fov in views:
            scene.add_camera("eye", eye=tuple(eye), target=tuple(target), up=tuple(north if fov < 50 else up), fov_deg=fov)
            view = scene.add_viewport(size, "eye", samples=2)
            view.set(fill=0.02, exposure=4.5)
            pictures.append(view.image())
            view.remove()
    rows = [np.concatenate(pictures[:2], axis=1), np.concatenate(pictures[2:], axis=1)]
    (IMAGES / "body_descent.png").write_bytes(png(np.concatenate(rows)))


def artemis_photo():
    """The Moon as Orion's navigation camera photographed it (art001e000403, NASA), and as Dspace draws it.

    The camera: the time of the file's name, the place of the flown trajectory, 2592 x 2048 pixels; its focal length from the
    limb's radius, its pointing from the limb's centre and its roll from the light, as Testing/Python/sky/test_artemis_photo.py
    measures them."""
    from osgeo import gdal
    width, height, x, y, radius, roll = 2592, 2048, 1429.75, 1049.79, 357.26, math.radians(-23.9)
    photo = gdal.Open(f"{DATA}/ephemeris/artemis1_art001e000403_photo.jpg").ReadAsArray()
    photo = photo.mean(axis=0) if photo.ndim == 3 else photo

    def axes(first, second):
        along = first / np.linalg.norm(first)
        across = np.cross(along, second)
        across /= np.linalg.norm(across)
        return np.stack([along, across, np.cross(along, across)], 1)

    with dspace.Session() as session:
        scene = session.scene()
        scene.time = scene.tdb("2022-11-22T03:28:30")
        orion = scene.add_trajectory(f"{DATA}/ephemeris/artemis1_orion_asflown_20221213_OEM.asc", visible=False)
        craft = np.array(orion.states(scene.time)[0])
        moon, sun = (scene.ephemeris(body, "earth", scene.time).position for body in ("moon", "sun"))
        way = moon - craft
        focal = radius / math.tan(math.asin(1737.4e3 / np.linalg.norm(way)))
        scene.add_body("moon", center="moon", terrain=MOON, texture=f"{DATA}/textures/moon_lroc_color_poles_2k.tif", albedo=0.12)
        scene.sun.set(direction=tuple(sun - moon))
        place = np.array([(x - width / 2 + 0.5) / focal, (y - height / 2 + 0.5) / focal, 1.0])
        turn = axes(way, sun - moon) @ axes(place, np.array([math.cos(roll), math.sin(roll), 0.0])).T
        pose = dspace.Pose(position=tuple(-way), quaternion=tuple(quaternion_of_matrix(turn)))
        camera = scene.add_camera(pose=pose, fov_deg=2 * math.degrees(math.atan(height / 2 / focal)))
        view = scene.add_viewport((width, height), camera, samples=1)
        view.set(shadows=True, fill=0.0, exposure=5.0)
        drawn = view.image()
    left, top, side = 1280, 640, 560
    pair = [np.repeat(photo[top:top + 800, left:left + side, None], 3, axis=2), drawn[top:top + 800, left:left + side]]
    (IMAGES / "artemis_photo.png").write_bytes(png(np.ascontiguousarray(np.concatenate(pair, axis=1).astype(np.uint8))))
