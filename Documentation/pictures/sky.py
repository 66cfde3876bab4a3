"""Pictures of the sky."""
import math

import dspace

from pictures.paths import IMAGES


def stars():
    """Orion and Sirius as the Bright Star Catalogue has them."""
    with dspace.Session() as session:
        scene = session.scene()
        scene.add_stars(gain=6e5, spread=0.9)
        ra, dec = math.radians(88.0), math.radians(-3.0)
        target = (math.cos(dec) * math.cos(ra), math.cos(dec) * math.sin(ra), math.sin(dec))
        camera = scene.add_camera(eye=(0, 0, 0), target=target, fov_deg=38)
        scene.add_viewport((960, 540), camera, samples=2).save(IMAGES / "stars.png")
