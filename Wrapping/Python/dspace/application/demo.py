"""The scene of the first start: a rover that drives round and round on the shipped field."""
import math
import os
import pathlib
import time

from dspace import Pose, errors, rover

STEP = 1 / 20  # [s] between poses
LONGEST = 0.5  # [s] that a step may take
RADIUS = 9.0  # [m] of the circle
SPEED = 0.6  # [m/s]


def shipped_data():
    """The folder Data of the source tree, or of the installed one."""
    given = os.environ.get("DSPACE_SHIPPED_DATA")
    above = pathlib.Path(__file__).resolve().parents[4:7]
    folders = [pathlib.Path(given)] if given else [each / end for each in above for end in ("Data", "share/dspace/Data")]
    for folder in folders:
        if (folder / "field" / "field.tif").exists():
            return folder
    raise errors.NotFound("the data of the demo are not there; accepted: a source tree, an installed one, or its folder Data "
                          "named by DSPACE_SHIPPED_DATA", f"folder {str(folders[0])!r}")


class Drive:
    """Two views of a rover that follows a circle in real time; stop() ends it."""

    def __init__(self, app):
        data = shipped_data()
        self._app, scene = app, app.scene
        self.terrain = scene.add_terrain(data / "field" / "field.tif", mode="clipmap",
                                         image=data / "field" / "field_color.tif")
        self.terrain.focus([(0, 0)], radius=2 * RADIUS)
        self.vehicle = rover.load_vehicle(data / "rover" / "rover.urdf")
        self.rover = scene.load(data / "rover" / "rover.urdf")
        self._follow = scene.add_frame("follow")
        scene.sun.set(direction=(-0.35, 0.80, 0.48))
        chase = scene.add_camera("chase", frame=self._follow, eye=(-4.6, -2.8, 2.2), target=(0.6, 0, 0.4), fov_deg=40)
        mast = scene.add_camera("mast", frame=self._follow, eye=(0.6, 0, 1.5), target=(3.5, 0, 0.2), fov_deg=60)
        for name, camera in (("chase", chase), ("mast", mast)):
            view = scene.add_viewport((640, 400), camera, name=name)
            view.set(shadows=True, fill=0.05)
            app.show(view)
        telemetry = scene.telemetry
        telemetry.add("rover/speed", unit="m/s", description="over ground")
        telemetry.add("rover/heading", unit="deg", description="from the map's X, counter-clockwise")
        telemetry.add("rover/tilt", unit="deg", description="of the deck from upright", warning_high=5.0, alarm_high=8.0)
        telemetry.add("rover/roll", unit="deg")
        telemetry.add("rover/pitch", unit="deg")
        telemetry.add("rover/height", unit="m", description="of the ground below its centre")
        telemetry.add("rover/odometer", unit="m")
        self._time, self._last = 0.0, time.monotonic()
        self.step()
        self._timer = app.every(STEP, self.step)

    def step(self):
        """Moves the rover to where it is now."""
        angle = SPEED * self._time / RADIUS
        x, y = RADIUS * math.cos(angle), RADIUS * math.sin(angle)
        heading = angle + 0.5 * math.pi
        self._app.scene.time = self._time
        driven = SPEED * self._time
        state = self.vehicle.solve((x, y, math.degrees(heading), 1.0 / RADIUS, driven), self.terrain)
        self.rover.place(state)
        height = self.terrain.height(x, y)
        self._app.scene.telemetry.set({
            "rover/speed": SPEED, "rover/heading": math.degrees(heading) % 360.0, "rover/tilt": state.tilt_deg,
            "rover/roll": state.roll_deg, "rover/pitch": state.pitch_deg, "rover/height": height,
            "rover/odometer": driven})
        self._follow.pose = Pose(position=(x, y, height),
                                 quaternion=(math.cos(heading / 2), 0.0, 0.0, math.sin(heading / 2)))
        now = time.monotonic()
        self._time += min(now - self._last, LONGEST)  # in real time, however slow the pictures are
        self._last = now

    def stop(self):
        self._app.cancel(self._timer)
