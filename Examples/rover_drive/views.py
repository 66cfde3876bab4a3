"""The four viewports of the demo."""
import numpy as np

from dspace import Pose
from dspace.shipped.field import LIGHT, SUN

SKY = (0.03, 0.035, 0.05)
HAZE = (0.16, 0.15, 0.14)
BLACK = (0.0, 0.0, 0.0)  # without air


class Views:
    """Chase; mast camera (physical objects only); overhead map; free view with read-outs."""

    def __init__(self, scene, placed, terrain, size, goal, route, ground, in_detail):
        self.scene = scene
        self.placed = placed
        self.terrain = terrain
        self.ground = ground
        length = placed.length
        half = (size[0] // 2, size[1] // 2)
        towards, sun, fill = (SUN, *LIGHT) if in_detail else ((-0.75, -0.45, 0.5), 1.5, 0.08)
        scene.sun.set(direction=towards, irradiance=sun * 1361)

        chase = scene.add_camera("chase", frame=placed.frame, fov_deg=38, near=0.02 * length, chase=dict(
            offset=(-1.6 * length, -0.95 * length, 0.68 * length), target=(0.2 * length, -0.05 * length, 0.15 * length),
            axes="heading", smoothing_s=0.5))
        mast = self._mast_camera(scene, placed)
        x, y = route.min(axis=0), route.max(axis=0)
        span = max((y - x)[1] * 1.3, (y - x)[0] * 1.3 * half[1] / half[0], 6 * length)
        # Low, for a clipmap shows what is far from a camera with fewer posts.
        top = float(np.nanmax(ground.heights(route))) + 3 * length
        middle = 0.5 * (x + y)
        overhead = scene.add_camera("overhead", eye=(*middle, top), target=(*middle, top - 1),
                                    up=(0, 1, 0), height=float(span), near=1.0, far=100.0 * length)
        free = scene.add_camera("free", frame=placed.frame, fov_deg=40, near=0.02 * length, chase=dict(
            offset=(1.2 * length, -2.7 * length, 1.2 * length), target=(0, 0, 0.35 * length),
            axes="parent", smoothing_s=1.0))

        self.views = {name: scene.add_viewport(size=half, camera=camera, name=name, samples=1)
                      for name, camera in (("chase", chase), ("mast", mast), ("overhead", overhead),
                                           ("free", free))}
        for view in self.views.values():
            view.set_background(*((BLACK,) if in_detail else (HAZE, SKY)))
            view.fill = fill
            view.shadows = True
        self.views["mast"].ornaments = False
        self.views["chase"].hide(self._helpers(scene, placed, goal, route, ground))
        self.views["free"].corner_axes = True

    @staticmethod
    def _mast_camera(scene, placed):
        """On the vehicle's mast camera, or on its mast's head, or where a driver would sit."""
        robot = placed.described.robot
        if robot is not None and "mast_camera" in robot.links:
            return scene.add_camera("mast", frame=robot.links["mast_camera"], fov_deg=45, near=0.05)
        head = placed.head
        if robot is not None and head in robot.links:
            # The head's X axis looks; its Z axis may be up or down.
            up = robot.links[head].world_pose.rotation[2, 2] > 0
            turn = (0.5, -0.5, 0.5, -0.5) if up else (0.5, 0.5, 0.5, 0.5)
            return scene.add_camera("mast", frame=robot.links[head], fov_deg=45, near=0.05,
                                    pose=Pose(position=(0.35, 0, 0), quaternion=turn))
        length = placed.length
        return scene.add_camera("mast", frame=placed.frame, fov_deg=55, near=0.05 * length,
                                eye=(0.6 * length, 0, 0.6 * length), target=(2.5 * length, 0, 0))

    def _helpers(self, scene, placed, goal, route, ground):
        """Ornaments that the chase view leaves out, as a fragment."""
        helpers = scene.add_fragment("helpers", ornamental=True)
        length = placed.length
        z = lambda xy: ground.heights(np.atleast_2d(xy))
        scene.add_axes(0.4 * length, frame=placed.frame, name="vehicle axes", fragment=helpers,
                       position=(0, 0, 0.75 * length))
        goal_frame = scene.add_frame("goal", position=(*goal, float(z(goal)[0])))
        scene.add_goal(1.2 * length, frame=goal_frame, name="goal", fragment=helpers)
        self.tilt = scene.add_tilt_marker(0.25 * length, warn_deg=8, limit_deg=20, frame=placed.frame,
                                          name="tilt", fragment=helpers, position=(0, 0, 0.85 * length))
        scene.add_lines(np.column_stack((route, z(route) + 0.1 * length)), name="planned route",
                        color=(0.35, 0.75, 1.0), line_width=1.5, fragment=helpers)
        self.trail = scene.add_trail(capacity=5000, minimum_spacing=0.02 * length, name="trail",
                                     color=(1.0, 0.75, 0.1), line_width=2.5, fragment=helpers)
        scene.add_label("rover", frame=placed.frame, name="label", fragment=helpers, font_size=14,
                        position=(0, 0, 1.25 * length))
        return helpers

    def update(self, state):
        length = self.placed.length
        on_ground = (np.mean(list(state.contacts.values()), axis=0) if state.contacts
                     else np.asarray(state.position))
        self.trail.append([on_ground + (0, 0, 0.12 * length)])
        self.tilt.set(state.tilt_deg)
        rows = [("time", f"{state.time:7.2f} s"),
                ("x, y", f"{on_ground[0]:8.2f} {on_ground[1]:8.2f} m"),
                ("height", f"{on_ground[2]:8.3f} m"),
                ("heading", f"{(90 - state.heading_deg) % 360:7.1f} deg"),
                ("pitch, roll", f"{state.pitch_deg:6.1f} {state.roll_deg:6.1f} deg"),
                ("tilt", f"{state.tilt_deg:6.1f} deg")]
        rows += [(name.replace("wheel_", "").replace("_", " "), f"{height:8.3f} m")
                 for name, height in state.wheel_heights.items()]
        self.views["free"].set_table("state", rows, title="ROVER",
                                     font_size=max(round(self.views["free"].size[1] * 0.031), 6))

    def pictures(self):
        return [view.image(physical_only=name == "mast") for name, view in self.views.items()]

    def save(self, folder):
        for name, view in self.views.items():
            view.samples = 3  # a still may take its time
            view.save(folder / f"{name}.png", physical_only=name == "mast")
            view.samples = 1

    def triangles(self, session):
        """Those of each view, and how many of all are the terrain's."""
        def count():
            counts = {}
            for name, view in self.views.items():
                view.capture()
                counts[name] = session.statistics["triangles_drawn"]
            return counts

        self.terrain.object.visible = False
        others = count()
        self.terrain.object.visible = True  # what did not change would not be drawn again, nor counted
        counts = count()
        return counts, sum(counts.values()) - sum(others.values())

    def screen_error(self, state):
        """How far the ground that is drawn lies above or below the height query, in pixels: the median
        and the 99th percentile of a view from behind the vehicle towards the horizon."""
        length, size, fov_deg = self.placed.length, self.views["free"].size, 45.0
        here = np.mean(list(state.contacts.values()), axis=0) if state.contacts else np.array(state.position)
        heading = np.radians(state.heading_deg)
        forward = np.array([np.cos(heading), np.sin(heading), -0.2])
        forward /= np.linalg.norm(forward)
        eye = here - 2.0 * length * forward + (0, 0, 0.5 * length)
        eye[2] = max(eye[2], self.ground.heights(eye[None, :2])[0] + 0.5 * length)
        self.scene.add_camera("measured", eye=eye, target=eye + forward, near=0.02 * length, fov_deg=fov_deg)
        view = self.scene.add_viewport(size, "measured", samples=1)
        planes = view.capture(color=False, depth=True, label=True, physical_only=True)
        view.remove()
        right = np.cross(forward, (0, 0, 1))
        right /= np.linalg.norm(right)
        down = np.cross(forward, right)
        rows, columns = np.nonzero(planes["label"] == self.terrain.object.id)
        depth = planes["depth"][rows, columns].astype(float)
        pixel = 2 * np.tan(np.radians(fov_deg) / 2) / size[1]
        rays = (forward + ((columns + 0.5 - size[0] / 2) * pixel)[:, None] * right
                + ((rows + 0.5 - size[1] / 2) * pixel)[:, None] * down)
        points = eye + depth[:, None] * rays
        error = np.abs(points[:, 2] - self.ground.heights(points[:, :2])) / (depth * pixel)
        error = error[np.isfinite(error)]
        return tuple(np.percentile(error, (50, 99))) if len(error) else (np.nan, np.nan)
