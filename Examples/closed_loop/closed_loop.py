"""A rover drives by its own eyes: stereo images make the disparity, the disparity a map of hazards, and the map the steering.

    ./dspace python Examples/closed_loop/closed_loop.py --out out/closed_loop

Nothing but the images and the rover's own pose (its odometry, here exact) reaches the steering. Whether the rover touched a rock
is judged apart, by the triangles of the rocks that the scene draws. The ground is a HiRISE model of Gale crater where DSPACE_DATA
names the reference data, whose heights have no published scale and are given one here; else the shipped field.
"""
import argparse
import os
import pathlib
import sys
import tempfile
import time

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))

import dspace  # noqa: E402
from contact import Body  # noqa: E402
from hazard_map import HazardMap  # noqa: E402
from sheet import disparity_picture, map_picture, save, sheet  # noqa: E402
from steering import costs, next_move, way  # noqa: E402
from stones import make, scatter  # noqa: E402

DATA = pathlib.Path(__file__).resolve().parents[2] / "Data"
GALE = "terrain/mars_gale_hirise_DTEEC_009650_5m_relative_u16.tif"
RELIEF = 40.0  # metres between the least and the greatest height of the Gale model: it has no scale of its own
NEAREST = 1.2  # [m]: what is nearer is not matched
REACH, LEAST = 8.0, 9.0  # metres, and pixels of disparity: what is farther, or shifted less, is too uncertain for the map
DRIVE, STEP = 0.5, 0.05  # metres from one look to the next, and of a step of the simulation
TURN_STEP = np.radians(5)
SPEED = 0.1  # m/s
SUN, SKY, EXPOSURE = 400.0, 180.0, 2.2  # W/m^2 on Mars' ground, from the Sun and its dusty sky, and what makes a picture of it
TILT_DEG = 24.0  # of the mast's head, downwards
ARRIVED = 0.6  # [m] from the goal


def add_ground(scene, folder, real=True):
    """The terrain and whether it is the real one. folder: where its detail is written."""
    path = pathlib.Path(os.environ.get("DSPACE_DATA", ""), GALE)
    if real and os.environ.get("DSPACE_DATA") and path.is_file():
        ground = scene.add_terrain(path, name="ground", mode="clipmap", vertical_scale=RELIEF / 65535, color=(0.62, 0.45, 0.33),
                                   vertical_datum="relative")
        real = True
    else:
        ground = scene.add_terrain(DATA / "field" / "field.tif", name="ground", mode="clipmap", color=(0.62, 0.45, 0.33))
        real = False
    # Gravel finer than the heights: without something to see, nothing is matched.
    save(pathlib.Path(folder) / "gravel.png", gravel(np.random.default_rng(7)))
    ground.set_style(details=[dict(image=pathlib.Path(folder) / "gravel.png", size=size, opacity=0.6) for size in (2.9, 7.3)])
    return ground, real


def level_place(ground, length):
    """The start (x, y) of a way of `length` metres to the east whose ground is the most level, about the terrain's middle."""
    west, east, south, north = ground.extent
    steps = np.linspace(-0.3, 0.3, 13)
    starts = np.array([(0.5 * (west + east) + u * (east - west) - 0.5 * length, 0.5 * (south + north) + v * (north - south))
                       for u in steps for v in steps])
    x, y = np.meshgrid(np.linspace(-2, length + 2, 25), np.linspace(-6, 6, 13))
    slopes = ground.slope_deg(starts[:, :1] + x.ravel(), starts[:, 1:] + y.ravel()).max(axis=1)
    return starts[np.argmin(slopes)]


def gravel(rng, size=512):
    """A tile of grey spots of all sizes, whose edges fit."""
    frequency = np.hypot(*np.meshgrid(np.fft.fftfreq(size) * size, np.fft.fftfreq(size) * size))
    waves = np.fft.fft2(rng.normal(size=(size, size))) / np.maximum(frequency, 4.0) ** 0.7
    grey = np.fft.ifft2(waves).real
    grey = np.clip(127 + 45 * grey / grey.std(), 0, 255).astype(np.uint8)
    return np.repeat(grey[..., None], 3, axis=2)


class Drive:
    """A rover, its ground and its rocks in a session, and the loop. size: of its images; length: metres to the goal."""

    def __init__(self, session, size=(512, 384), length=24.0, rocks=12, seed=1, real=True, method=None):
        self.scene = scene = session.scene()
        self.folder = tempfile.TemporaryDirectory(prefix="dspace-loop-")
        self.ground, self.real = add_ground(scene, self.folder.name, real)
        self.method, self.rng = method, np.random.default_rng(seed)
        self.start = level_place(self.ground, length)
        self.goal = self.start + (length, 0.0)
        self.stones = [make(x, y, float(self.ground.height(x, y)), radius, self.rng)
                       for x, y, radius in scatter(self.start, self.goal, rocks, self.rng)]
        for number, stone in enumerate(self.stones):
            scene.add_mesh(stone.points, stone.triangles, colors=stone.colors, name=f"rock {number}", roughness=1.0)
        scene.sun.set(azimuth_deg=200, elevation_deg=38, terrain=self.ground, irradiance=SUN)
        scene.add_sky(SKY)
        self.rover = scene.load(DATA / "rover" / "rover.urdf", name="rover")
        self.vehicle = dspace.rover.load_vehicle(DATA / "rover" / "rover.urdf")
        self.body = Body()
        self.time, self.place, self.heading, self.turned = 0.0, self.start.copy(), 0.0, 0.0
        width, height = size
        eye = dspace.CameraModel("brown", name="left", frame="mast_camera_left", size=size, focal=(0.8 * width, 0.8 * width),
                                 center=((width - 1) / 2, (height - 1) / 2), radial=(-0.12, 0.02))
        self.pair = dspace.StereoPair(eye, baseline=0.23)
        margin = 5.0
        self.hazards = HazardMap(self.start - (margin, 8.0), self.goal + (margin, 8.0))
        self.track, self.contacts, self.looks, self.route = [], [], 0, None
        self.move(0.0, 0.0)

    # --- The simulation: what happens ----------------------------------------------------------

    def move(self, distance, curvature, turn=0.0):
        """A step of the rover over the ground."""
        self.heading += distance * curvature + turn
        self.place = self.place + distance * np.array((np.cos(self.heading), np.sin(self.heading)))
        self.time += abs(distance) / SPEED + abs(turn) / 0.2
        state = self.vehicle.solve((*self.place, np.degrees(self.heading)), self.ground)
        state.joints.update(self.vehicle.look(0.0, TILT_DEG))
        self.scene.time = self.time
        self.rover.place(state)
        self.track.append(self.place.copy())
        touched = self.touched()
        if touched:
            self.contacts.append((self.time, tuple(self.place), len(touched)))

    def touched(self):
        """The rocks that the rover's box touches, by the scene's pose of the rover and the rocks' triangles."""
        pose = self.rover.frame.world_pose
        return self.body.touched(pose.position, pose.rotation, self.stones)

    # --- The loop: what the rover knows --------------------------------------------------------

    def look(self):
        """The rectified pictures, the disparity, and the points in the scene's root."""
        eye = self.rover.links["mast_camera_left"]
        left, right = self.pair.capture(self.scene, frame=eye, samples=1, exposure=EXPOSURE)
        pictures = self.pair.rectify(left["color"], right["color"])
        disparity = self.pair.match(*pictures, nearest=NEAREST, method=self.method)
        pose = eye.world_pose
        points = self.pair.points(disparity) @ pose.rotation.T + pose.position
        self.hazards.add(points, pose.position, min(REACH, float(self.pair.depth(LEAST))))
        self.looks += 1
        return pictures, disparity

    def plan(self):
        self.route = way(self.hazards, costs(self.hazards, self.body.radius), self.place, self.goal)
        return next_move(self.route, self.place, self.heading)

    def run(self, most=150, shown=lambda drive, pictures, disparity: None):
        """Looks, plans and moves until the goal is reached or `most` looks are over. Returns whether it is reached."""
        while np.linalg.norm(self.goal - self.place) > ARRIVED and self.looks < most:
            pictures, disparity = self.look()
            kind, value = self.plan()
            shown(self, pictures, disparity)
            if kind == "turn":
                count = max(1, int(np.ceil(abs(value) / TURN_STEP)))
                for _ in range(count):
                    self.move(0.0, 0.0, value / count)
            else:
                for _ in range(round(DRIVE / STEP)):
                    self.move(STEP, value)
        return bool(np.linalg.norm(self.goal - self.place) <= ARRIVED)

    def blind(self):
        """The rocks that the rover's box would touch on the straight way to the goal."""
        found = []
        for share in np.linspace(0, 1, 200):
            x, y = self.start + share * (self.goal - self.start)
            state = self.vehicle.solve((x, y, 0.0), self.ground)
            pose = dspace.Pose(state.position, state.quaternion)
            found += [stone for stone in self.body.touched(pose.position, pose.rotation, self.stones) if stone not in found]
        return found


def overhead(drive, size):
    """A picture of the whole drive from above, with its trail."""
    scene = drive.scene
    track = np.array(drive.track)
    heights = drive.ground.heights(track)
    trail = scene.add_lines(np.column_stack((track, heights + 0.3)), color=(1.0, 0.85, 0.1), line_width=3.0, ornamental=True)
    middle = 0.5 * (drive.start + drive.goal)
    top = float(heights.max()) + 30.0
    length = np.linalg.norm(drive.goal - drive.start) + 4.0
    scene.add_camera("overhead", eye=(*middle, top), target=(*middle, top - 1), up=(0, 1, 0), height=length * size[1] / size[0])
    view = scene.add_viewport(size, "overhead", samples=2)
    view.set(shadows=True, exposure=EXPOSURE)
    picture = view.image()
    view.remove()
    trail.remove()
    return picture


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("out/closed_loop"), help="folder of the pictures")
    parser.add_argument("--length", type=float, default=24.0, help="metres to the goal (24)")
    parser.add_argument("--rocks", type=int, default=12, help="greatest number of rocks (12)")
    parser.add_argument("--seed", type=int, default=1, help="of the rocks (1)")
    parser.add_argument("--shipped", action="store_true", help="the shipped field, also where real data are there")
    parser.add_argument("--matcher", choices=("sgbm", "census"), help="default: OpenCV's where it is installed")
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    with dspace.Session() as session:
        drive = Drive(session, length=options.length, rocks=options.rocks, seed=options.seed, real=not options.shipped,
                      method=options.matcher)
        began, kept = time.perf_counter(), []

        def shown(drive, pictures, disparity):
            ahead = np.linalg.norm(drive.goal - drive.place)
            if not kept or disparity_near(drive.pair, disparity) > disparity_near(drive.pair, kept[0][1]):
                kept[:] = [(pictures, disparity)]
            print(f"look {drive.looks:3d}: {drive.time:6.1f} s, {ahead:5.2f} m to the goal, "
                  f"{100 * np.isfinite(disparity).mean():.0f} % matched", flush=True)

        reached = drive.run(shown=shown)
        blind = len(drive.blind())
        (left, right), disparity = kept[0]
        # Two pictures of the loop above, the map and the view from above below.
        top = (left[..., :3], disparity_picture(disparity))
        map_, above = map_picture(drive), overhead(drive, (left.shape[1] * 2, left.shape[1] * 2 * 16 // 28))
        save(options.out / "closed_loop.png", sheet(top, map_, above))
        save(options.out / "anaglyph.png", drive.pair.anaglyph(left, right))
    print(f"{'reached the goal' if reached else 'did not reach the goal'} on "
          f"{'Gale' if drive.real else 'the shipped field'}: {drive.looks} looks, {len(drive.track)} steps, "
          f"{len(drive.contacts)} contacts; the straight way touches {blind} rocks; {time.perf_counter() - began:.0f} s")
    return 0 if reached and not drive.contacts else 1


def disparity_near(pair, disparity):
    """The share of a disparity image that is within 4 m."""
    return float((disparity > pair.disparity(4.0)).mean())


if __name__ == "__main__":
    sys.exit(main())
