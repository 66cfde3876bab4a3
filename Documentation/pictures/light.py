"""Pictures of light and photometry."""
import numpy as np

import dspace
from dspace._core.png import png
from pictures.paths import IMAGES

MODELS = (("Lambert", "lambert"), ("Lommel-Seeliger", "lommel-seeliger"), ("lunar-Lambert", "lunar-lambert"),
          ("Hapke", "hapke"))


def moon(title, reflectance, phase_deg):
    """One sphere under the Sun at a phase angle, exposed automatically."""
    with dspace.Session() as session:
        scene = session.scene()
        scene.add_sphere(1.0, color="#b0a89c", reflectance=reflectance, resolution=256)
        away = np.radians(phase_deg)
        scene.sun.set(direction=(np.sin(away), -np.cos(away), 0.0), irradiance=1361)
        camera = scene.add_camera(eye=(0, -20, 0), target=(0, 0, -0.12), up=(0, 0, 1), height=2.65)
        view = scene.add_viewport((200, 210), camera, samples=4)
        view.set_background((0, 0, 0))
        view.set(fill=0.0, automatic_exposure=True)
        scene.add_label(f"{title}, {phase_deg}\N{DEGREE SIGN}", font_size=12, position=(-0.7, -1, -1.33))
        return view.image()


def photometry():
    """A sphere by four photometric models, at phase angles of 5 and 70 degrees."""
    rows = [np.concatenate([moon(title, model, phase) for title, model in MODELS], axis=1) for phase in (5, 70)]
    (IMAGES / "photometry.png").write_bytes(png(np.concatenate(rows)))
