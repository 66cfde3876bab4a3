"""Pictures of trajectories: Artemis I as it flew, about the Earth and in axes that turn with the Earth and the Moon."""
import math

import numpy as np

import dspace
from dspace.trajectories import States, rotating

from pictures.paths import DATA, IMAGES

OEM = f"{DATA}/ephemeris/artemis1_orion_asflown_20221213_OEM.asc"
SHARE = 4902.800118 / (398600.435507 + 4902.800118)  # the Moon's part of the mass (DE440)
PHASES = ["#60a0ff", "#ffb040", "#50d070"]


def tdb(utc):
    """TDB seconds past J2000 of a time of UTC in 2022, to 2 ms."""
    return float((np.datetime64(utc) - np.datetime64("2000-01-01T12:00")) / np.timedelta64(1, "s")) + 69.184


def moon_states(scene, begin, end, step=3600.0):
    """The Moon about the Earth in J2000 from the ephemeris of the scene, by its frame at many times."""
    frame = scene.add_celestial_frame("sampled", "moon", center="earth")
    times = np.linspace(begin, end, int(math.ceil((end - begin) / step)) + 1)
    positions = []
    for time in times:
        scene.time = time
        positions.append(frame.pose.position)
    frame.remove()
    return States(times, positions, interpolation="lagrange", degree=9)


def artemis(name, relative, camera, scale):
    with dspace.Session() as session:
        scene = session.scene("artemis")
        orion = scene.add_trajectory(OEM, visible=False)
        begin, end = orion.span
        orion.remove()
        moon = moon_states(scene, begin, end)
        axes = rotating(None, moon, SHARE) if relative else None
        outbound, away, home = begin, tdb("2022-11-21T12:57"), tdb("2022-12-05T16:42")  # flybys of the Moon
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
