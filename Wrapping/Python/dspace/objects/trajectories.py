"""Trajectories of a scene: their lines, their states, and the frames that move along them."""
import numpy as np

from dspace._core.fields import array_of, color as color_of, keywords, number, put, put_color, put_given, put_vector, \
    reject, word
from dspace.errors import InvalidArgument, WrongType
from dspace.objects.arrays import map_scalars
from dspace.objects.graphics import GraphicsObject, put_settings
from dspace.proto.trajectories_pb2 import TrajectoryPath
from dspace.trajectories.axes import Axes, Pointing, turning
from dspace.trajectories.states import States, pack, put_path

LOOK = ("color", "opacity", "before", "after", "ahead", "fade", "tick_size", "tick_labels", "font_size")
CLOCKS = {"utc": 0, "seconds": 1}


def _put_look(message, about, color=None, before=None, after=None, **look):
    if color is not None:
        put_color(message.color, color, "the colour", about)
    put_given(message, about, before_s=before, after_s=after, **look)


def _phases(phases, about):
    """Times and colors of phases: (begin, color) pairs, each until the next."""
    try:
        pairs = [(number(begin, "the begin of a phase", about), color_of(color, "the colour of a phase", about))
                 for begin, color in phases]
    except (TypeError, ValueError) as error:
        if isinstance(error, InvalidArgument):
            raise
        reject(about, "the phases", phases, "a list of (time, color) pairs", WrongType)
    times, colors = [], []
    for i, (begin, color) in enumerate(pairs):
        if i:  # the color changes within the least time that doubles tell apart
            times.append(np.nextafter(begin, -np.inf))
            colors.append(pairs[i - 1][1])
        times.append(begin)
        colors.append(color)
    rgb = np.round(255 * np.array(colors, float).reshape(-1, 3)).astype(np.uint8)
    return np.array(times), np.concatenate((rgb, np.full((len(rgb), 1), 255, np.uint8)), axis=1)


class TrajectoryFactory:
    """Makes the trajectories of a Scene, which delegates to it."""

    def __init__(self, scene):
        self._scene = scene

    def add_trajectory(self, path, relative_to=None, begin=None, end=None, values=None, colormap=None, low=None, high=None,
                       phases=None, color=None, opacity=1.0, before=None, after=None, ahead=1.0, fade=False,
                       tick_interval=0.0, clock=None, tick_size=5.0, tick_labels=True, font_size=12,
                       osculating=False, mu=None, farthest=None, flatness=None, most_points=None, ornamental=True,
                       **settings):
        """Adds the line of a trajectory in `frame`. Returns a Trajectory.

        path: dspace.trajectories.States or a Conic, an OEM file or an .xyzv file, or another Trajectory: states about a
        centre in axes that do not turn. Times are those of scene.time: TDB seconds past J2000 for files.
        relative_to: dspace.trajectories.rotating(...), local(...), turning(...), about_body(...): the axes in which it is
        drawn; `frame` stands for them. None: as it is given.
        begin, end [s]: what is drawn; default: all that is known. A conic needs both.
        values: (times, values), mapped to colors as in Scene.add_mesh (colormap, low, high). phases: a list of (time,
        color), each color until the next time. color: of all; or it multiplies those.
        before, after: how much before and after scene.time is drawn [s]; default: all. ahead: factor on the opacity of
        what is later than scene.time. fade: the opacity falls to 0 at the ends of the window, or of the line.
        tick_interval [s]: marks at whole multiples of it, with labels that leave room to each other. clock: "utc" (default
        for files) or "seconds" (default for others). tick_size and font_size [pixels].
        osculating: the conic about the centre on which it would go on from scene.time; mu: GM of the centre [m^3/s^2];
        farthest [m]: how far an open conic is drawn, default ten times the distance.
        flatness: the largest distance of the path from a chord of the line, as a share of the chord; default 1/256.
        most_points: default 20000. The line runs exactly through the place at scene.time; elsewhere it has the chords."""
        command = self._scene._command()
        message = command.create_trajectory
        label = put_settings(self._scene, message.object, "trajectory", ornamental=ornamental, **settings)
        put_path(message.path, path, label)
        if relative_to is not None:
            if not isinstance(relative_to, Axes):
                reject(label, "relative_to", relative_to, "what dspace.trajectories.rotating, local, turning or about_body "
                       "return", WrongType)
            relative_to._put(message.axes, label)
        put_given(message, label, begin_s=begin, end_s=end, flatness=flatness, most_points=most_points, farthest=farthest)
        put(message, label, osculating=osculating, tick_interval_s=tick_interval)
        if osculating and mu is None:
            raise InvalidArgument(f"{label}: an osculating orbit needs GM of the centre; accepted: mu=... [m^3/s^2], "
                                  "3.986004418e14 for the Earth", label)
        if mu is not None:
            put(message, label, mu=mu)
        if values is not None and phases is not None:
            raise InvalidArgument(f"{label}: values and phases are given; accepted: one of them", label)
        if values is not None:
            if not isinstance(values, (tuple, list)) or len(values) != 2:
                reject(label, "values", values, "(times, values)", WrongType)
            times = array_of(values[0], "the times of its values", "an array (n,)", label)
            message.color_time = pack(times)
            message.color_at = map_scalars(values[1], (len(times),), colormap, low, high, label).tobytes()
        elif phases is not None:
            times, colors = _phases(phases, label)
            message.color_time, message.color_at = pack(times), colors.tobytes()
        if clock is None:
            clock = "utc" if message.path.WhichOneof("kind") in ("oem", "xyzv") else "seconds"
        message.clock = word(clock, CLOCKS, "the clock", label)
        _put_look(message.look, label, color, before, after, opacity=opacity, ahead=ahead, fade=fade, tick_size=tick_size,
                  tick_labels=tick_labels, font_size=font_size)
        reply = self._scene._execute(command)
        return Trajectory(self._scene, reply.object.object, message.path)

    def orbit(self, position, velocity, mu):
        """The conic of a state about a centre, as an Orbit. position [m], velocity [m/s]; mu: GM [m^3/s^2]."""
        command = self._scene._command()
        put_vector(command.get_orbit.position, position, "the position", "orbit")
        put_vector(command.get_orbit.velocity, velocity, "the velocity", "orbit")
        put(command.get_orbit, "orbit", mu=mu)
        return Orbit(self._scene._execute(command).orbit)


    def body_path(self, body, center, begin, end, step=3600.0, tolerance=1.0, axes="J2000"):
        """The path of a body or spacecraft about another one from the scene's ephemeris (loaded SPKs, DE405, ERFA), as
        dspace.trajectories.States: for add_trajectory, and for moving axes.

        begin, end [s past J2000 TDB]. step [s] is halved until Hermite's interpolation errs by at most `tolerance` [m]
        midway between the states, up to a million of them. axes: an inertial reference frame."""
        about = f"path of {body!r}"
        times = _times(begin, end, step, about)
        tolerance = number(tolerance, "the tolerance", about)
        if not tolerance > 0:
            reject(about, "the tolerance", tolerance, "a positive number of metres")
        while True:
            found = self._scene.ephemeris(body, center, times, axes)
            states = States(times, found.position, found.velocity)
            middle = 0.5 * (times[1:] + times[:-1])
            truth = self._scene.ephemeris(body, center, middle, axes).position
            worst = np.linalg.norm(midway(states) - truth, axis=1).max()
            if worst <= tolerance:
                return states
            if 2 * len(times) > 1_000_000:
                raise InvalidArgument(f"{about}: with {len(times)} states it errs by {worst:.3g} m; accepted: a tolerance of more, "
                                      "or a shorter time", about)
            times = np.sort(np.concatenate((times, middle)))

    def turning_axes(self, frame, begin, end, step=600.0, origin=None):
        """The axes of a reference frame ("IAU_MARS", "MOON_ME", a frame of loaded kernels) as `relative_to` of
        add_trajectory, for paths in J2000. begin, end [s past J2000 TDB]; step [s]: between two rotations of the table, over
        which they turn at constant rate. origin: the path of the body; None: the centre."""
        times, quaternions = self.attitude(frame, begin, end, step)
        return turning(times, quaternions, origin)

    def attitude(self, frame, begin, end, step=10.0):
        """The attitude of a reference frame, of a CK for one, as (times, quaternions) for Trajectory.move: each takes
        components in the frame to J2000. begin, end [s past J2000 TDB], step [s]."""
        times = _times(begin, end, step, f"frame {frame!r}")
        return times, quaternions_of(self._scene.reference_frames.rotation(frame, "J2000", times))


def _times(begin, end, step, about):
    begin, end = number(begin, "the begin", about), number(end, "the end", about)
    step = number(step, "the step", about)
    if not (np.isfinite(begin) and np.isfinite(end) and begin < end):
        raise InvalidArgument(f"{about}: it is from {begin:g} to {end:g} s; accepted: finite times, the begin before the end",
                              about)
    if not 0 < step < np.inf or (end - begin) / step > 1_000_000:
        reject(about, "the step", step, "a positive number of seconds, at most a million times")
    return np.linspace(begin, end, max(9, int(np.ceil((end - begin) / step)) + 1))


def midway(states):
    """Positions midway between the states of a table, by Hermite's interpolation of the two beside each (degree 3): an upper
    bound of the error of degree 7."""
    h = np.diff(states.times)[:, None]
    p, v = states.positions, states.velocities
    return 0.5 * (p[1:] + p[:-1]) + h / 8.0 * (v[:-1] - v[1:])


def quaternions_of(rotations):
    """Unit quaternions (n, 4), w x y z, of rotation matrices (n, 3, 3)."""
    r = np.asarray(rotations, float).reshape(-1, 3, 3)
    # The largest of the four squares is at least a quarter: no digits are lost (S. Shepperd, 1978).
    squares = np.stack((1 + r[:, 0, 0] + r[:, 1, 1] + r[:, 2, 2], 1 + r[:, 0, 0] - r[:, 1, 1] - r[:, 2, 2],
                        1 - r[:, 0, 0] + r[:, 1, 1] - r[:, 2, 2], 1 - r[:, 0, 0] - r[:, 1, 1] + r[:, 2, 2]), axis=1)
    x, y, z = r[:, 2, 1] - r[:, 1, 2], r[:, 0, 2] - r[:, 2, 0], r[:, 1, 0] - r[:, 0, 1]
    xy, xz, yz = r[:, 0, 1] + r[:, 1, 0], r[:, 0, 2] + r[:, 2, 0], r[:, 1, 2] + r[:, 2, 1]
    forms = np.stack((np.stack((squares[:, 0], x, y, z), axis=1), np.stack((x, squares[:, 1], xy, xz), axis=1),
                      np.stack((y, xy, squares[:, 2], yz), axis=1), np.stack((z, xz, yz, squares[:, 3]), axis=1)), axis=1)
    q = forms[np.arange(len(r)), np.argmax(squares, axis=1)]
    return q / np.linalg.norm(q, axis=1, keepdims=True)


class Orbit:
    """Osculating elements, in the axes of the state. Lengths [m], angles [deg], period [s].

    semi_major_axis is negative for a hyperbola and infinite for a parabola; period_s and apoapsis_radius are infinite for
    both. Angles that the conic does not have are 0."""

    NAMES = ("semi_latus_rectum", "eccentricity", "inclination_deg", "ascending_node_deg", "periapsis_argument_deg",
             "true_anomaly_deg", "semi_major_axis", "period_s", "periapsis_radius", "apoapsis_radius", "mean_anomaly_deg")

    def __init__(self, message):
        for name in self.NAMES:
            setattr(self, name, getattr(message, name))

    def __repr__(self):
        return (f"<Orbit, periapsis {self.periapsis_radius:.6g} m, e = {self.eccentricity:.6g}, "
                f"i = {self.inclination_deg:.6g} deg>")


class Trajectory(GraphicsObject):
    """The line of a trajectory (Scene.add_trajectory), and its states."""

    def __init__(self, scene, id, path=None):
        super().__init__(scene, id)
        self._path = TrajectoryPath() if path is None else TrajectoryPath.FromString(path.SerializeToString())

    def _get(self, times=(), reference=False):
        command = self._scene._command()
        command.get_trajectory.object = self._id
        command.get_trajectory.time = pack(times)
        command.get_trajectory.reference = reference
        return self._scene._execute(command).trajectory

    def states(self, times, reference=False):
        """Positions [m] and velocities [m/s] at times [s], as two arrays (n, 3), or (3,) of one time; in the axes in which
        it is drawn, or with reference=True in those in which it is given."""
        array = array_of(times, "the times", "a number or an array (n,)", self._label)
        reply = self._get(np.atleast_1d(array), reference)
        found = [np.frombuffer(data).reshape(-1, 3) for data in (reply.position, reply.velocity)]
        return tuple(each[0] for each in found) if array.ndim == 0 else tuple(found)

    @property
    def span(self):
        """When its states are known: (begin, end) [s]."""
        reply = self._get()
        return reply.begin_s, reply.end_s

    @property
    def source(self):
        """What its file names: a dict of center, frame and object; empty texts where nothing is stated."""
        reply = self._get()
        return {"center": reply.center, "frame": reply.frame, "object": reply.object_name}

    def orbit(self, time, mu):
        """The osculating conic about the centre at a time [s], as an Orbit. mu: GM of the centre [m^3/s^2]."""
        return Orbit(self._scene._ask("get_orbit", self._label, object=self._id, time_s=time, mu=mu).orbit)

    def set(self, **look):
        """Sets color, opacity, before, after, ahead, fade, tick_size, tick_labels and font_size as in
        Scene.add_trajectory; those that are not given stay. before=math.inf draws all again."""
        keywords(look, LOOK, self._label)
        command = self._scene._command()
        command.set_trajectory.object = self._id
        _put_look(command.set_trajectory.look, self._label, **look)
        self._scene._execute(command)

    def move(self, frame, attitude=None):
        """Moves a frame along the trajectory with scene.time, and returns it. It is a child of the trajectory's frame.

        attitude: a dspace.trajectories.Pointing; (times, quaternions) of a table, (n,) and (n, 4), w x y z, each taking
        components in the frame to those in the axes in which the path is given; None: it keeps the axes in which the
        trajectory is drawn. Times without a state give a warning; the frame then is where it is at the nearest one.
        move(None) ends it: the frame goes back to where it was before."""
        command = self._scene._command()
        message = command.set_trajectory_frame
        message.object = self._id
        if frame is not None:
            message.frame = self._scene._frame_id(frame)
            if isinstance(attitude, Pointing):
                attitude._put(message.rule, self._label())
            elif attitude is not None:
                if not isinstance(attitude, (tuple, list)) or len(attitude) != 2:
                    reject(self._label, "the attitude", attitude, "a Pointing, or (times, quaternions)", WrongType)
                message.time = pack(array_of(attitude[0], "the times", "an array (n,)", self._label))
                message.rotation = pack(array_of(attitude[1], "the quaternions", "an array (n, 4)", self._label))
        self._scene._execute(command)
        return None if frame is None else self._scene._frame_of(message.frame)

    def add_frame(self, name=None, attitude=None):
        """A new frame beside the trajectory that moves along it, as `move` says; a model hangs on it."""
        parent = self.frame
        return self.move(parent.add_frame(self.name if name is None else name), attitude)
