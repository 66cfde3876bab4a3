"""Cones of sensors, their footprints on bodies and terrain, ground tracks, and lines between frames."""
import numpy as np

from dspace._core.fields import array_of, color as color_of, flag, number, numbers, reject
from dspace.errors import InvalidArgument, WrongType
from dspace.kinematics.rotations import packed
from dspace.objects.factory import ObjectFactory
from dspace.trajectories.states import States

STATES = {"good": "#40d060", "weak": "#e0c030", "lost": "#e04040"}


def _positive(value, what, about, most=np.inf):
    value = number(value, what, about)
    if not 0 < value < most:
        reject(about, what, value, "a positive number" if most == np.inf else f"above 0 and below {most:g}")
    return value


def field_of_view(half_angle_deg=None, corners=None, axis=(0, 0, 1), count=64, about="field of view"):
    """The edge of a field of view as unit vectors (n, 3) in the instrument's axes, in order around it.

    A cone of a half angle [deg] about `axis`; or `corners` (m, 3), between which the edge follows great circles."""
    if (half_angle_deg is None) == (corners is None):
        raise InvalidArgument(f"{about}: a half angle and corners are both given, or none is; accepted: one of them", about)
    if corners is not None:
        corners = array_of(corners, "the corners", "an array (m, 3)", about)
        if corners.ndim != 2 or corners.shape[1] != 3 or len(corners) < 3:
            reject(about, "the shape of the corners", corners.shape, "(m, 3), m >= 3")
        lengths = np.linalg.norm(corners, axis=1, keepdims=True)
        if not (np.all(np.isfinite(corners)) and np.all(lengths > 0)):
            raise InvalidArgument(f"{about}: a corner is zero or not finite; accepted: directions of any length but 0", about)
        corners = corners / lengths
        each = max(1, int(np.ceil(count / len(corners))))
        share = np.arange(each)[:, None] / each
        sides = [a + share * (b - a) for a, b in zip(corners, np.roll(corners, -1, axis=0))]
        edge = np.concatenate(sides)
    else:
        half = np.radians(_positive(half_angle_deg, "the half angle", about, 90.0))
        z = numbers(axis, 3, "the axis", about)
        length = np.linalg.norm(z)
        if not length > 0:
            reject(about, "the axis", axis, "a direction of any length but 0")
        z = z / length
        x = np.cross(z, np.eye(3)[np.argmin(np.abs(z))])
        x /= np.linalg.norm(x)
        turn = 2 * np.pi * np.arange(count)[:, None] / count
        edge = np.cos(half) * z + np.sin(half) * (np.cos(turn) * x + np.sin(turn) * np.cross(z, x))
    return edge / np.linalg.norm(edge, axis=1, keepdims=True)


def on_ellipsoid(origin, directions, radii):
    """Where rays (n, 3) from `origin` meet an ellipsoid about the frame's origin first, and which of them do.

    A ray that passes it gives the point of the limb in the plane of the ray and the centre. origin outside."""
    o = np.asarray(origin, float) / radii  # the ellipsoid becomes a unit sphere, and limbs stay limbs
    d = np.asarray(directions, float) / radii
    d = d / np.linalg.norm(d, axis=1, keepdims=True)
    along = -d @ o
    off = np.maximum(0.0, o @ o - along**2)  # square of the distance of the ray from the centre
    hit = (along > 0) & (off <= 1.0)
    points = o + (along - np.sqrt(np.maximum(0.0, 1.0 - off)))[:, None] * d
    # Of the limb: at 1 / |o| along the direction to the observer, the rest across it, on the ray's side.
    across = d - np.outer(d @ o, o) / (o @ o)
    length = np.linalg.norm(across, axis=1, keepdims=True)
    across = across / np.where(length > 0, length, 1.0)
    limb = o / (o @ o) + np.sqrt(max(0.0, 1.0 - 1.0 / (o @ o))) * across
    return np.where(hit[:, None], points, limb) * radii, hit


def _radii(radii, about):
    radii = array_of(radii, "the radii", "one number of metres, or 3", about)
    radii = numbers(np.broadcast_to(radii, 3) if radii.ndim == 0 else radii, 3, "the radii", about)
    if not (np.all(np.isfinite(radii)) and np.all(radii > 0)):
        reject(about, "the radii", radii.tolist(), "3 positive numbers of metres")
    return radii


class Footprints:
    """Footprints of instruments on a body or on terrain (Scene.add_footprints)."""

    def __init__(self, scene, body, radii, terrain, lift, mesh_settings, accumulate, fill):
        self._scene, self._body, self._radii, self._terrain = scene, body, radii, terrain
        self._lift, self._settings, self._accumulate, self._fill = lift, mesh_settings, accumulate, fill
        self._outlines = []
        self.mesh = None

    def __len__(self):
        return len(self._outlines)

    @property
    def outlines(self):
        """The outlines, each (n, 3) [m] in the frame of the body or of the terrain, the oldest first."""
        return list(self._outlines)

    def add(self, instrument, half_angle_deg=None, corners=None, axis=(0, 0, 1), count=64):
        """The footprint of a field of view as it is now; returns its outline (n, 3) in the body's frame, or None where it
        misses. instrument: the frame in whose axes the half angle about `axis`, or the corners, are. On a body, rays that
        pass it follow its limb. On terrain, a footprint with a ray that meets nothing within the terrain is left out."""
        about = "footprints"
        edge = field_of_view(half_angle_deg, corners, axis, count, about)
        pose = self._scene.poses([instrument], relative_to=self._body)[0]
        w, u = pose[3], pose[4:7]
        rays = edge + 2 * np.cross(u, np.cross(u, edge) + w * edge)
        eye = pose[:3]
        if self._terrain is not None:
            distances = self._terrain.intersect(eye, rays)
            outline = eye + distances[:, None] * rays if np.all(np.isfinite(distances)) else None
        else:
            if np.sum((eye / self._radii)**2) <= 1.0:
                raise InvalidArgument(f"{about}: the instrument is inside of the body; accepted: outside", about)
            outline, hit = on_ellipsoid(eye, rays, self._radii)
            outline = outline if hit.any() or self._sees_all(eye, edge, rays) else None
        if outline is None:
            return None
        if not self._accumulate:
            self._outlines.clear()
        self._outlines.append(outline)
        self._draw()
        return outline

    def _sees_all(self, eye, edge, rays):
        """Whether the whole body is within the field of view: the centre lies inside of its edge."""
        middle = rays.mean(axis=0)
        return np.dot(middle, -eye) > 0 and np.min(rays @ middle) <= np.dot(middle, -eye) / np.linalg.norm(eye)

    def clear(self):
        """Removes all footprints."""
        self._outlines.clear()
        if self.mesh is not None:
            self.mesh.remove()
            self.mesh = None

    def _draw(self):
        points, lines, triangles = [], [], []
        first = 0
        for outline in self._outlines:
            n = len(outline)
            lifted = outline * (1.0 + self._lift / np.linalg.norm(outline, axis=1, keepdims=True)) if self._terrain is None \
                else outline + self._up(outline)
            points.append(lifted)
            ring = first + np.arange(n)
            lines.append(np.stack((ring, np.roll(ring, -1)), axis=1))
            if self._fill:
                middle = lifted.mean(axis=0)
                if self._terrain is None:  # on the surface, not on the chord plane
                    middle = middle / np.sqrt(np.sum((middle / self._radii)**2))
                    middle *= 1.0 + self._lift / np.linalg.norm(middle)
                points.append(middle[None])
                triangles.append(np.stack((ring, np.roll(ring, -1), np.full(n, first + n)), axis=1))
                first += 1
            first += n
        given = {"points": np.concatenate(points)}
        if self._fill:
            given["triangles"] = np.concatenate(triangles)
        else:
            given["lines"] = np.concatenate(lines)
        if self.mesh is None:
            self.mesh = ObjectFactory(self._scene).add_mesh(frame=self._body, **given, **self._settings)
        else:
            self.mesh.update(**given)

    def _up(self, points):
        return np.array((0.0, 0.0, self._lift))


class Link:
    """A line between two frames, colored by its state (Scene.add_link)."""

    def __init__(self, scene, a, b, states, settings):
        self._scene, self._a, self._b, self._states, self._settings = scene, a, b, states, settings
        self._state = next(iter(states))
        self.mesh = None
        self.update()

    @property
    def state(self):
        """The state, one of `states`; may be set."""
        return self._state

    @state.setter
    def state(self, state):
        if state not in self._states:
            reject("link", "the state", state, ", ".join(repr(each) for each in self._states))
        self._state = state
        self.update()

    @property
    def length(self):
        """The distance between the two frames now [m]."""
        return float(np.linalg.norm(self._scene.poses([self._b], relative_to=self._a)[0, :3]))

    def update(self, state=None):
        """Puts the line where the frames are now, and sets its state, if one is given. Call it once in each step."""
        if state is not None:
            if state not in self._states:
                reject("link", "the state", state, ", ".join(repr(each) for each in self._states))
            self._state = state
        end = self._scene.poses([self._b], relative_to=self._a)[0, :3]
        rgb = color_of(self._states[self._state], "the color of a state", "link")
        given = {"points": np.array(((0.0, 0.0, 0.0), end)), "lines": np.array(((0, 1),)),
                 "colors": np.array((rgb, rgb), float)}
        if self.mesh is None:
            self.mesh = ObjectFactory(self._scene).add_mesh(frame=self._a, **given, **self._settings)
        else:
            self.mesh.update(**given)

    def remove(self):
        """Removes the line."""
        self.mesh.remove()


class SensorFactory:
    """Makes what shows sensors in a Scene, which delegates to it."""

    def __init__(self, scene):
        self._scene = scene

    def add_sensor_cone(self, frame, length, half_angle_deg=None, corners=None, axis=(0, 0, 1), color="#40a0ff",
                        opacity=0.25, count=64, **settings):
        """Adds a translucent cone, or pyramid, of a field of view or a keep-out zone. Returns a Mesh; ornamental.

        Its apex is at the origin of `frame`. half_angle_deg about `axis`, or corners (m, 3): directions of its edges.
        length [m]: of its edges."""
        about = "sensor cone"
        length = _positive(length, "the length", about)
        edge = length * field_of_view(half_angle_deg, corners, axis, count, about)
        n = len(edge)
        ring = np.arange(n)
        sides = np.stack((np.full(n, n), ring, np.roll(ring, -1)), axis=1)
        settings = {"ornamental": True, "lit": False, "name": None, **settings}
        return ObjectFactory(self._scene).add_mesh(np.concatenate((edge, np.zeros((1, 3)))), triangles=sides, frame=frame,
                                                   color=color, opacity=opacity, **settings)

    def add_footprints(self, body=None, radii=None, terrain=None, lift=None, fill=False, accumulate=True, color="#ffd040",
                       opacity=None, **settings):
        """Footprints of instruments, which Footprints.add takes one by one. They are outlines, or with fill=True areas.

        body: the frame at the centre of an ellipsoid of `radii` [m] (one number: a sphere) along its axes; or terrain: a
        dspace.Terrain. lift [m]: how far they are drawn above the surface; default 1e-3 of the mean radius, on terrain 1 m.
        accumulate: all are kept; False: the last one alone."""
        about = "footprints"
        if (terrain is None) == (radii is None):
            raise InvalidArgument(f"{about}: radii and a terrain are both given, or none is; accepted: one of them", about)
        if terrain is not None:
            if not hasattr(terrain, "intersect"):
                reject(about, "the terrain", terrain, "a dspace.Terrain", WrongType)
            body = terrain.frame if body is None else body
            lift = 1.0 if lift is None else number(lift, "lift", about)
        else:
            radii = _radii(radii, about)
            body = self._scene.root if body is None else body
            lift = 1e-3 * float(np.mean(radii)) if lift is None else number(lift, "lift", about)
        settings = {"ornamental": True, "lit": False, "color": color, **settings}
        opacity = (0.4 if fill else 1.0) if opacity is None else opacity
        return Footprints(self._scene, body, radii, terrain, lift, {**settings, "opacity": opacity},
                          flag(accumulate, "accumulate", about), flag(fill, "fill", about))

    def add_ground_track(self, trajectory, radii, step=60.0, begin=None, end=None, geodetic=False, lift=None, **look):
        """Adds the track of a trajectory's points on the ellipsoid below it. Returns a dspace.Trajectory.

        trajectory: a dspace.Trajectory whose axes are those of the body (relative_to=turning(...), or a file in them); the
        track is in its frame. radii [m]: of the ellipsoid along its axes; one number: a sphere. step [s] between its
        points. geodetic: the point below along the ellipsoid's normal (radii[0] == radii[1]); else along the line to the
        centre. lift [m]: how far it is drawn above the surface; default 1e-3 of the mean radius. look: as in
        Scene.add_trajectory (before, after, fade, color, ticks)."""
        about = "ground track"
        if not (hasattr(trajectory, "states") and hasattr(trajectory, "span")):
            reject(about, "the trajectory", trajectory, "a dspace.Trajectory", WrongType)
        radii = _radii(radii, about)
        first, last = trajectory.span
        first = first if begin is None else number(begin, "begin", about)
        last = last if end is None else number(end, "end", about)
        step = _positive(step, "the step", about)
        if not (np.isfinite(first) and np.isfinite(last) and first < last):
            raise InvalidArgument(f"{about}: it is from {first:g} to {last:g} s; accepted: finite times, the begin before the "
                                  "end", about)
        count = int(np.ceil((last - first) / step)) + 1
        if count > 1_000_000:
            reject(about, "the step", step, "a longer one: at most a million points")
        times = np.linspace(first, last, count)
        points = sub_points(trajectory.states(times)[0], radii, flag(geodetic, "geodetic", about))
        lift = 1e-3 * float(np.mean(radii)) if lift is None else number(lift, "lift", about)
        points *= 1.0 + lift / np.linalg.norm(points, axis=1, keepdims=True)
        look.setdefault("frame", trajectory.frame)
        look.setdefault("most_points", max(3, min(10_000_000, 4 * count)))
        return self._scene.add_trajectory(States(times, points, interpolation="linear"), **look)

    def add_link(self, a, b, states=None, **settings):
        """Adds a line from frame a to frame b. Returns a Link; its update() follows the frames.

        states: a dict of colors by the state; the first one is its state at first; default: good (green), weak (yellow),
        lost (red)."""
        states = STATES if states is None else states
        if not isinstance(states, dict) or not states:
            reject("link", "the states", states, "a dict of one and more colors by name", WrongType)
        if "frame" in settings:
            reject("link", "the frame", settings["frame"], "none: the line is on frame a")
        states = dict(states)
        for state, value in states.items():
            color_of(value, f"the color of state {state!r}", "link")
        return Link(self._scene, a, b, states, {"ornamental": True, "lit": False, **settings})


def sub_points(points, radii, geodetic=False):
    """Points (n, 3) below others on an ellipsoid about the origin: along the line to the centre; or geodetic, along the
    ellipsoid's normal (by D. Bowring's iteration, to rounding), where its first two radii are equal."""
    points = np.asarray(points, float)
    radii = np.asarray(radii, float)
    if not geodetic:
        return points / np.sqrt(np.sum((points / radii)**2, axis=1, keepdims=True))
    if radii[0] != radii[1]:
        reject("ground track", "the radii", radii.tolist(), "two equal equatorial radii for geodetic points")
    a, b = radii[0], radii[2]
    across = np.hypot(points[:, 0], points[:, 1])
    beta = np.arctan2(a * points[:, 2], b * across)  # reduced latitude
    for _ in range(12):
        latitude = np.arctan2(points[:, 2] + (a * a - b * b) / b * np.sin(beta)**3, across - (a * a - b * b) / a * np.cos(beta)**3)
        beta = np.arctan2(b * np.sin(latitude), a * np.cos(latitude))
    longitude = np.arctan2(packed(points[:, 1]), packed(points[:, 0]))
    return np.stack((a * np.cos(beta) * np.cos(longitude), a * np.cos(beta) * np.sin(longitude), b * np.sin(beta)), axis=1)
