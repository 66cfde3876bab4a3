"""Pictures of the sky."""
import math

import dspace

from pictures.paths import DATA, IMAGES


def stars():
    """Orion and Sirius as the Bright Star Catalogue has them."""
    with dspace.Session() as session:
        scene = session.scene()
        scene.add_stars(gain=6e5, spread=0.9)
        ra, dec = math.radians(88.0), math.radians(-3.0)
        target = (math.cos(dec) * math.cos(ra), math.cos(dec) * math.sin(ra), math.sin(dec))
        camera = scene.add_camera(eye=(0, 0, 0), target=target, fov_deg=38)
        scene.add_viewport((960, 540), camera, samples=2).save(IMAGES / "stars.png")


def frames():
    """The Earth over the Moon's eastern limb on 2026-10-18, all placed, turned and lit by the scene's time."""
    with dspace.Session() as session:
        scene = session.scene()
        scene.time = scene.tdb("2026-10-18T12:00")
        moon = scene.add_celestial_frame("moon", "moon", axes="MOON_ME", center="moon")
        earth = scene.add_celestial_frame("earth", "earth", axes="ITRF93", center="moon")
        orbiter = scene.add_celestial_frame("orbiter", "moon", site=(98, 8, 400e3), parent=moon)
        scene.sun.follow(frame=moon)
        scene.add_body("moon", texture=f"{DATA}/textures/moon_lroc_color_poles_2k.tif", frame=moon)
        scene.add_body("earth", texture=f"{DATA}/textures/earth_bluemarble.jpg", frame=earth)
        there = scene.sky("earth", frame=orbiter)["earth"]
        a, e = math.radians(there.azimuth_deg), math.radians(there.elevation_deg - 9.0)
        ahead = (math.cos(e) * math.sin(a), math.cos(e) * math.cos(a), math.sin(e))  # east, north, up
        camera = scene.add_camera(frame=orbiter, eye=(0, 0, 0), target=ahead, fov_deg=32)
        view = scene.add_viewport((960, 540), camera, samples=2)
        view.exposure = 3.0
        view.save(IMAGES / "frames.png")
