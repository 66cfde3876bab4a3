"""The shipped field with its detail: hills around it, centimetres about the drive, soil, rocks, and the wheels' ruts."""
import numpy as np

from dspace.frames.poses import Pose
from dspace.rover import GridTerrain
from dspace.shipped.rocks import add_rocks

SOIL = (0.47, 0.459, 0.439)  # sRGB, the mean of the field's colours
SUN = (-0.35, 0.80, 0.48)  # towards it: to the left of the drive, 29 degrees high
LIGHT = 2.1, 0.03  # irradiance in units of the Sun's at 1 au; fill light as a fraction of it
POSTS = 0.05  # metres between the posts of site.tif
SINKAGE = 0.04  # metres
TREAD = 0.004  # metres
# A rut that the shipped rover's wheels leave in such soil [m]: wider than they are by more than a post on each side; its
# bars are as far apart as three grousers, for posts show nothing finer.
RUT = dict(width=0.32, sinkage=SINKAGE, wall=0.05, rim_width=0.12, rim_height=0.025, tread_pitch=0.157, tread_depth=TREAD)


def add_ground(scene, folder):
    """Opens the shipped ground, with centimetres about the drive, as one Terrain. folder: Data/field."""
    terrain = scene.add_terrain(folder / "field.tif", name="terrain", mode="clipmap", color=SOIL,
                                patches=[dict(path=folder / "site.tif", margin=4.0)])
    terrain.add_image(folder / "field_color.tif")
    terrain.add_image(folder / "site_color.tif")
    terrain.set_style(tracks=dict(color=(0.10, 0.095, 0.09), opacity=0.5))
    return terrain


def add_field(scene, folder):
    """Opens the shipped ground as one Terrain and adds what stands on it and around it."""
    terrain = add_ground(scene, folder)
    scene.add_terrain(folder / "hills.tif", name="hills", mode="triangles", triangles=9000, color=SOIL)
    add_rocks(scene, folder / "rocks.npy")
    return terrain


def floor_of_ruts(terrain, line, reach):
    """What the wheels stand on, about the points (n, 2) of the route to `reach` [m], as dspace.rover asks for it: the
    triangles of the finest posts without ruts, lowered by the sinkage and half of the tread."""
    west, south = np.floor((line.min(axis=0) - reach) / POSTS).astype(int)
    east, north = np.ceil((line.max(axis=0) + reach) / POSTS).astype(int)
    x, y = POSTS * np.arange(west, east + 1), POSTS * np.arange(north, south - 1, -1)
    posts = np.stack(np.meshgrid(x, y), axis=-1)
    z = terrain.undisturbed.heights(posts.reshape(-1, 2)).reshape(posts.shape[:2])
    return GridTerrain(z - SINKAGE - 0.5 * TREAD, x[0], y[0], POSTS)


def roll(terrain, vehicle, states):
    """Rolls the wheels of a vehicle through states of a drive; each leaves its rut below its middle."""
    lowest = np.array([_lowest(vehicle, state) for state in states])
    terrain.track({name: lowest[:, k] for k, name in enumerate(vehicle.wheels)}, **RUT)


def _lowest(vehicle, state):
    """x, y of the lowest points of the wheels' middle planes; a wheel leans as the chassis does."""
    across = Pose(quaternion=state.quaternion).rotation @ vehicle.suspension.X_MR[:, 1]
    up = np.array((0.0, 0.0, 1.0)) - across[2] * across
    up /= np.linalg.norm(up)
    return [(state.wheel_centers[wheel.name] - wheel.radius * up)[:2] for wheel in vehicle.suspension.wheels]
