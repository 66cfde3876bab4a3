"""The scene of the first start: a rover that drives through the shipped field, again and again."""
import json
import time

import numpy as np

from dspace import Pose, rover
from dspace.shipped.data import shipped_data
from dspace.shipped.field import LIGHT, SUN, add_ground, floor_of_ruts, roll

STEP = 1 / 20  # [s] between poses
LONGEST = 0.5  # [s] that a step may take
SPEED = 0.6  # [m/s]


class Drive:
    """Two views of a rover that drives the route of the shipped field in real time and leaves ruts; at its end it begins
    anew. stop() ends it. Rocks are those of the ground's heights: meshes of them would halve the rate of pictures of a
    software renderer."""

    def __init__(self, app):
        data = shipped_data()
        self._app, scene = app, app.scene
        self.terrain = add_ground(scene, data / "field")
        self.way = rover.Path(json.loads((data / "field" / "route.json").read_text())["way_points_m"], speed=SPEED, ramp=1.0)
        line = np.column_stack(self.way.sample(np.linspace(0.0, self.way.length, 200))[:2])
        self.terrain.focus(line[::8], radius=5.0)
        self.vehicle = rover.load_vehicle(data / "rover" / "rover.urdf")
        self._floor = floor_of_ruts(self.terrain, line, reach=4.0)
        self.rover = scene.load(data / "rover" / "rover.urdf")
        self._follow = scene.add_frame("follow")
        irradiance, fill = LIGHT
        scene.sun.set(direction=SUN, irradiance=irradiance * 1361)
        chase = scene.add_camera("chase", frame=self._follow, eye=(-4.6, -2.8, 2.2), target=(0.6, 0, 0.4), fov_deg=40)
        mast = scene.add_camera("mast", frame=self._follow, eye=(0.6, 0, 1.5), target=(3.5, 0, 0.2), fov_deg=60)
        for name, camera in (("chase", chase), ("mast", mast)):
            view = scene.add_viewport((640, 400), camera, name=name)
            view.set(shadows=True, fill=fill)
            app.show(view)
        telemetry = scene.telemetry
        telemetry.add("rover/speed", unit="m/s", description="over ground")
        telemetry.add("rover/heading", unit="deg", description="from the map's X, counter-clockwise")
        telemetry.add("rover/tilt", unit="deg", description="of the deck from upright", warning_high=5.0, alarm_high=8.0)
        telemetry.add("rover/roll", unit="deg")
        telemetry.add("rover/pitch", unit="deg")
        telemetry.add("rover/height", unit="m", description="of the ground below its centre")
        telemetry.add("rover/odometer", unit="m")
        self._time, self._begun, self._last = 0.0, 0.0, time.monotonic()
        self.step()
        self._timer = app.every(STEP, self.step)

    def step(self):
        """Moves the rover to where it is now."""
        if self._time - self._begun > self.way.duration:
            self._begun = self._time
            self.terrain.clear_tracks()
        place = self.way.pose(self._time - self._begun)
        self._app.scene.time = self._time
        state = self.vehicle.solve(place, self._floor)
        self.rover.place(state)
        roll(self.terrain, self.vehicle, [state])
        x, y = state.position[:2]
        height = self.terrain.height(x, y)
        heading = np.radians(state.heading_deg)
        self._app.scene.telemetry.set({
            "rover/speed": place.speed, "rover/heading": state.heading_deg % 360.0, "rover/tilt": state.tilt_deg,
            "rover/roll": state.roll_deg, "rover/pitch": state.pitch_deg, "rover/height": height,
            "rover/odometer": place.distance})
        self._follow.pose = Pose(position=(x, y, height),
                                 quaternion=(np.cos(heading / 2), 0.0, 0.0, np.sin(heading / 2)))
        now = time.monotonic()
        self._time += min(now - self._last, LONGEST)  # in real time, however slow the pictures are
        self._last = now

    def stop(self):
        self._app.cancel(self._timer)
