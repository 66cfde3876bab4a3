"""Pictures of trajectories: Artemis I as it flew, about the Earth and in axes that turn with the Earth and the Moon."""
import numpy as np

import dspace
from dspace.trajectories import rotating

from pictures.paths import DATA, IMAGES

OEM = f"{DATA}/ephemeris/artemis1_orion_asflown_20221213_OEM.asc"
SHARE = 4902.800118 / (398600.435507 + 4902.800118)  # the Moon's part of the mass (DE440)
PHASES = ["#60a0ff", "#ffb040", "#50d070"]


def artemis(name, relative, camera, scale):
    with dspace.Session() as session:
        scene = session.scene("artemis")
        orion = scene.add_trajectory(OEM, visible=False)
        begin, end = orion.span
        orion.remove()
        moon = scene.body_path("moon", "earth", begin, end, tolerance=1000.0)
        axes = rotating(None, moon, SHARE) if relative else None
        outbound, away, home = begin, scene.tdb("2022-11-21T12:57"), scene.tdb("2022-12-05T16:42")  # flybys of the Moon
        scene.add_trajectory(OEM, relative_to=axes, line_width=2, tick_interval=2 * 86400.0, font_size=13, tick_size=6,
                             phases=[(outbound, PHASES[0]), (away, PHASES[1]), (home, PHASES[2])])
        path = scene.add_trajectory(moon, relative_to=axes, color="#909090", line_width=1, clock="utc", name="moon")
        time = begin + 0.45 * (end - begin)
        scene.time = time
        p = path.states(time)[0]
        earth = (-SHARE * np.linalg.norm(moon.positions[0]), 0, 0) if relative else (0, 0, 0)
        scene.add_sphere(1.2e7 * scale, position=earth, color="#4080c0", lit=False, name="Earth", ornamental=True)
        scene.add_sphere(6e6 * scale, position=p, color="#b0b0b0", lit=False, name="Moon", ornamental=True)
        for text, at in (("Earth", np.asarray(earth)), ("Moon", p)):
            scene.add_label(text, position=at + np.array((0, -2.4e7, 0)), font_size=15, color="white")
        scene.add_camera("camera", **camera)
        scene.add_viewport((1000, 640), "camera").save(str(IMAGES / name))


def artemis_inertial():
    artemis("artemis_inertial.png", False, dict(eye=(0, -2.5e8, 1.15e9), target=(-2e7, -2e7, 0), up=(0, 1, 0), fov_deg=45), 1.0)


def artemis_rotating():
    artemis("artemis_rotating.png", True, dict(eye=(2e8, 0, 7.5e8), target=(2e8, 0, 0), up=(0, 1, 0), fov_deg=45), 1.0)
