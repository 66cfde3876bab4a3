"""A lidar's scan of a rover among rocks on ground of Gale crater: real data."""
import pathlib

import numpy as np

import dspace
from dspace._core.files import atomic_write
from dspace._core.png import png
from pictures.paths import DATA, IMAGES, ROOT

SIZE = (900, 380)
RELIEF = 30.0  # [m] of the patch: its file has heights without a scale
COLORS = ("#30123b", "#4662d7", "#36aaf9", "#1ae4b6", "#72fe5e", "#c8ef34", "#faba39", "#f66b19", "#ca2a04", "#7a0403")


def rock(random, size, steps=20):
    """A closed surface about the origin: a sphere with bumps. Points and triangles."""
    u, v = np.meshgrid(np.linspace(0, 2 * np.pi, 2 * steps + 1), np.linspace(0, np.pi, steps + 1))
    n = np.stack((np.sin(v) * np.cos(u), np.sin(v) * np.sin(u), np.cos(v)), axis=-1)
    radius = np.ones(u.shape)
    for _ in range(7):
        k = random.normal(size=3) * 2.2
        radius += 0.09 * np.sin(n @ k + random.uniform(0, 6))
    i = (np.arange(steps)[:, None] * (2 * steps + 1) + np.arange(2 * steps)).ravel()
    j = i + 2 * steps + 1
    shape = random.uniform((0.7, 0.7, 0.45), (1.3, 1.1, 0.8))
    return (size * shape * radius[..., None] * n).reshape(-1, 3), np.concatenate((np.column_stack((i, j, i + 1)),
                                                                                  np.column_stack((i + 1, j, j + 1))))


def lidar():
    """Above: what a camera sees. Below: the echoes of a lidar that stands 2 m above the ground, coloured by range."""
    random = np.random.default_rng(5)
    file = pathlib.Path(DATA) / "terrain" / "mars_gale_hirise_DTEEC_009650_5m_relative_u16.tif"
    with dspace.Session() as session:
        scene = session.scene()
        ground = scene.add_terrain(file, name="gale", vertical_scale=RELIEF / 65535.0, vertical_datum="relative", mode="clipmap",
                                   subdivisions=6, color=(0.62, 0.45, 0.33))
        x, y = 60.0, -40.0
        scene.sun.set(azimuth_deg=250, elevation_deg=32)
        drive = np.column_stack((np.linspace(x - 9.0, x, 200), y + 1.2 * np.sin(np.linspace(-2.2, 0.0, 200))))
        rover = scene.load(ROOT / "Data/rover/rover.urdf")
        heading = np.degrees(np.arctan2(*(drive[-1] - drive[-2])[::-1]))
        rover.place(dspace.rover.load_vehicle(ROOT / "Data/rover/rover.urdf").solve((x, y, np.radians(heading)), ground))
        side = np.array((-np.sin(np.radians(heading)), np.cos(np.radians(heading))))
        ground.track({"left": drive + 0.55 * side, "right": drive - 0.55 * side}, width=0.35, sinkage=0.1)
        for k in range(70):
            at = np.array((x, y)) + random.uniform((-14, -10), (14, 14))
            if np.abs(drive - at).max(axis=1).min() > 1.6:
                points, triangles = rock(random, 0.12 + 0.5 * random.beta(1, 4))
                scene.add_mesh(points, triangles, position=(*at, float(ground.height(*at))), color=(0.42, 0.33, 0.28),
                               name=f"rock {k}")
        place = np.array((x + 1.5, y - 6.0))
        scene.add_frame("lidar", position=(*place, float(ground.height(*place)) + 2.0))
        sensor = dspace.Lidar(np.arange(0.0, 360.0, 0.2), np.linspace(-40.0, 8.0, 160), maximum_range=40.0, noise=0.004,
                              greatest_incidence_deg=89.0)
        scan = scene.scan(sensor, frame="lidar", seed=1)
        eye = np.array((x + 2.0, y - 12.0))
        camera = dict(eye=(*eye, float(ground.height(*eye)) + 5.0), target=(x - 1.5, y, float(ground.height(x, y))), fov_deg=27)
        above = scene.add_viewport(SIZE, scene.add_camera(**camera), samples=3).image()
        scene = session.scene("cloud")
        seen = scan.outcome == 0
        scene.add_mesh(scan.point[seen], scalars=scan.range[seen], colormap=COLORS, low=2.0, high=18.0, lit=False, point_size=2)
        view = scene.add_viewport(SIZE, scene.add_camera(**camera), samples=2)
        view.set_background((0.03, 0.03, 0.05))
        below = view.image()
    gap = np.full((6, SIZE[0], above.shape[2]), 255, np.uint8)
    atomic_write(IMAGES / "lidar.png", png(np.vstack((above, gap, below))))
