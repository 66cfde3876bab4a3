"""Pictures of models in several formats: real data."""
import numpy as np

import dspace
from dspace._core.png import png
from pictures.paths import DATA, IMAGES

MODELS = ( # file, settings, direction from which it is seen
    ("m2020_rover/m2020.urdf", {"up": "-z"}, (1.0, -1.0, 0.5)),
    ("rocky7_vrml", {}, (1.0, -1.0, 0.6)),
    ("viper_obj", {}, (1.0, -1.2, 0.6)),
    ("pathfinder_vrml/lander2.wrl", {}, (1.0, -1.0, 0.6)),
    ("spacecraft_glb/iss.glb", {}, (1.0, -0.5, 0.5)),
    ("vrml97_samples/HelloWorld.wrl", {"up": "y"}, (0.2, -1.0, 0.3)),
)


def still(path, settings, toward):
    with dspace.Session() as session:
        scene = session.scene()
        loaded = scene.load(f"{DATA}/models/{path}", **settings)
        scene.sun.set(direction=(0.3, -0.8, 0.6), irradiance=1.3 * 1361)
        camera = scene.add_camera(eye=tuple(np.multiply(toward, 10.0)), target=(0, 0, 0), fov_deg=30)
        view = scene.add_viewport((320, 240), camera, samples=3)
        view.set_background((0.16, 0.17, 0.2), top=(0.3, 0.32, 0.36))
        view.fit(loaded, margin=0.05)
        return view.image()


def formats():
    """Six files of four formats in one picture."""
    stills = [still(*model) for model in MODELS]
    rows = [np.concatenate(stills[i:i + 3], axis=1) for i in (0, 3)]
    (IMAGES / "formats.png").write_bytes(png(np.concatenate(rows)))
