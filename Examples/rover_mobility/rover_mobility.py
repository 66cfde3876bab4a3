"""A rover mobility simulation that drives a scene: its own model makes the scene's frames and shapes, and a
thousand times a second its poses are sent, all in one message.

    ./dspace python Examples/rover_mobility/rover_mobility.py --seconds 10 --out rover.png
    ./dspace python Examples/rover_mobility/rover_mobility.py --connect HOST:PORT --real-time
    ./dspace python Examples/rover_mobility/rover_mobility.py --seconds 8 --record run.dspace
    ./dspace movie Examples/rover_mobility/flight.toml --run Examples/rover_mobility/rover_mobility.py:run --out rover.mp4
"""
import argparse
import contextlib
import pathlib
import sys
import tempfile
import time

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))

import dspace  # noqa: E402
from mobility import Hills, Mobility  # noqa: E402
from model import RoverModel  # noqa: E402
from skeleton import build  # noqa: E402

STEP = 1e-3  # s
PRINT = 50  # steps from one contact of the tracks to the next: 2 cm at full speed
POSTS, SPACING = 241, 0.1  # of the ground that is drawn, about the start [m]


def command(at):
    """Speed [m/s] and curvature [1/m] at a time [s]: it sets off within a second and winds on."""
    x = min(at, 1.0)
    return 0.4 * x * x * (3 - 2 * x), 0.3 * np.sin(0.5 * at)


class Simulation:
    """A rover in a scene of a session, local or connected."""

    def __init__(self, session, model=None, ground=None, folder=None):
        self.session, self.model = session, model or RoverModel()
        self.mobility = Mobility(self.model, ground or Hills())
        self.scene = session.scene()
        self.frames = build(self.scene, self.model)
        self.terrain = self._terrain(folder)
        self.scene.sun.set(direction=(-0.75, -0.45, 0.5), irradiance=1.5 * 1361)
        self.steps = 0
        self.send()
        self.print()

    def _terrain(self, folder):
        """The ground as a raster: its heights at posts, straight between."""
        reach = 0.5 * (POSTS - 1) * SPACING
        line = np.linspace(-reach, reach, POSTS)
        x, y = np.meshgrid(line, -line)  # its first row is the northern one
        z = self.mobility.ground.heights(x, y)
        self._folder = tempfile.TemporaryDirectory(prefix="dspace-rover-") if folder is None else None
        path = pathlib.Path(folder or self._folder.name) / "ground.asc"
        edge = -reach - 0.5 * SPACING
        text = (f"ncols {POSTS}\nnrows {POSTS}\nxllcorner {edge}\nyllcorner {edge}\ncellsize {SPACING}\n"
                + "\n".join(" ".join(f"{v:.6f}" for v in row) for row in z) + "\n")
        if not path.is_file() or path.read_text() != text:  # one that a server or a recording knows stays what it is
            path.write_text(text)
        return self.scene.add_terrain(path, name="ground", mode="clipmap", vertical_datum="relative",
                                      crs='LOCAL_CS["ground",UNIT["metre",1]]', vertical_scale=1.0,
                                      color=(0.62, 0.48, 0.38), subdivisions=3)

    def print(self):
        """The wheels leave their tread and a rim on the ground; the floor of a track is where a wheel rolls."""
        names = [self.model.bodies[k].name for k in self.model.wheels]
        self.terrain.track({name: contact[:2] for name, contact in zip(names, self.mobility.contacts)},
                           width=self.model.wheel_width, rim_width=0.04, rim_height=0.012, tread_pitch=0.08,
                           tread_depth=0.008)

    def send(self):
        """The whole rover's poses: one message."""
        self.scene.time = self.mobility.time
        self.scene.set_poses(self.frames, self.mobility.rows())

    def step(self):
        self.mobility.step(STEP, *command(self.mobility.time))
        self.steps += 1
        self.send()
        if self.steps % PRINT == 0:
            self.print()

    def advance(self, at):
        """Steps until a time [s], to a millisecond."""
        ahead = round(at / STEP) - self.steps
        if ahead < 0:
            raise ValueError(f"the simulation is asked for {at:g} s at {self.mobility.time:g} s; accepted: later times, "
                             "for it goes forward only")
        for _ in range(ahead):
            self.step()

    def telemetry(self):
        """Numbers for tables and movies."""
        speed, curvature = command(self.mobility.time)
        return {"speed": speed, "rolled": float(self.mobility.rolled.mean()), "steps": self.steps}


def clear(session):
    """Takes away what an earlier run has left in a server."""
    for viewport in session.viewports.values():
        viewport.remove()
    for scene in session.scenes.values():
        scene.remove()


def run():
    """What `dspace movie` draws."""
    simulation = Simulation(dspace.Session())
    return simulation


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seconds", type=float, default=5.0, help="of the simulation (5)")
    parser.add_argument("--connect", metavar="ADDRESS", help="of a server; else the scene is in this process")
    parser.add_argument("--real-time", action="store_true", help="no faster than the clock")
    parser.add_argument("--wheelbase", type=float, default=RoverModel.wheelbase, help="metres (1.1)")
    parser.add_argument("--folder", type=pathlib.Path,
                        help="where the ground's raster is written; with --connect the server must allow it, and it "
                             "stays (there the working folder, else a temporary one)")
    parser.add_argument("--record", type=pathlib.Path, metavar="FILE", help="records the run; the ground beside it")
    parser.add_argument("--out", type=pathlib.Path, help="a picture at the end")
    options = parser.parse_args()
    session = dspace.connect(options.connect, name="rover mobility") if options.connect else dspace.Session()
    folder = options.folder
    if options.record and folder is None:
        folder = options.record.resolve().parent  # a recording names the ground's file
    elif options.connect and folder is None:
        folder = pathlib.Path.cwd()  # what `dspace serve` allows that was begun here, for viewers that come later, too
    with session, session.record(options.record) if options.record else contextlib.nullcontext():
        if options.connect:
            clear(session)
        simulation = Simulation(session, RoverModel(wheelbase=options.wheelbase), folder=folder)
        if options.connect:
            session.wait = False  # do not wait for replies; a later command reports rejected ones
        began = time.perf_counter()
        while simulation.mobility.time < options.seconds - STEP / 2:
            simulation.step()
            ahead = simulation.mobility.time - (time.perf_counter() - began)
            if options.real_time and ahead > 0:
                time.sleep(ahead)
        if options.connect:
            session.wait = True
            session.flush()
        taken = time.perf_counter() - began
        print(f"{simulation.steps} steps of 1 ms in {taken:.2f} s, {simulation.steps / taken:.0f} a second; rolled "
              f"{simulation.mobility.rolled.mean():.3f} m; wheels turned "
              + ", ".join(f"{turn:.2f}" for turn in np.degrees(simulation.mobility.turned)) + " deg")
        if options.out:
            scene = simulation.scene
            scene.add_camera("side", frame="rover", eye=(1.6, -2.6, 1.1), target=(0, 0, 0), fov_deg=38)
            view = scene.add_viewport((1280, 720), "side")
            view.set_background((0.75, 0.6, 0.5), top=(0.45, 0.4, 0.4))
            view.save(options.out)


if __name__ == "__main__":
    try:
        main()
    except (dspace.Error, ValueError, OSError) as error:
        sys.exit(f"rover_mobility: {error}")
