"""Key frames of a movie's camera, shots between cuts, and run time as a function of movie time."""
from dataclasses import dataclass

import numpy as np

from dspace._core.fields import flag, number, numbers, reject, text
from dspace.errors import InvalidArgument
from dspace.frames.poses import Pose
from dspace.movies.path import FovPath, HeightPath, PlacePath, TangentPath, TurnPath, looking

EASINGS = ("through", "rest")


@dataclass(frozen=True)
class Key:
    """The pose of a camera at one time of a movie. Lengths in metres, angles in degrees.

    time: of the movie [s], from 0. run: time of the run [s]; None: see Movie. frame: path of the frame in which
    position, quaternion, target and up are given ("": the root). Give either quaternion (X right, Y down, Z forward)
    or target; target_frame: another frame for the target. up: the direction of the picture's top, used with a
    target. fov_deg: full vertical angle, 1e-6 to 179 (default: 45); or height: metres from top to bottom of an
    orthographic camera, 1e-9 to 1e18; or tangents: those of the edges of an off-axis camera (left, right, top, bottom;
    see Camera.set_projection). Keys between two cuts have the same one of these. easing: "through" passes the key at an even rate, "rest" stops
    at it. cut: a new shot begins at this key, which may have the same time as the key before it. Raises
    dspace.InvalidArgument for other values.
    """
    time: float
    position: tuple
    quaternion: tuple = None
    target: tuple = None
    target_frame: str = None
    up: tuple = (0.0, 0.0, 1.0)
    fov_deg: float = 45.0
    frame: str = ""
    run: float = None
    easing: str = "through"
    cut: bool = False
    height: float = None
    tangents: tuple = None

    @property
    def lens(self):
        """Which of "fov_deg", "height" and "tangents" it has."""
        return "height" if self.height is not None else "tangents" if self.tangents is not None else "fov_deg"

    def __post_init__(self):
        about = f"the key at {self.time!r} s"
        put = lambda name, value: object.__setattr__(self, name, value)
        put("time", _finite(self.time, "time", about, low=0.0))
        if self.run is not None:
            put("run", _finite(self.run, "run", about))
        self._check_lens(about, put)
        if (self.quaternion is None) == (self.target is None):
            reject(about, "what it looks at", (self.quaternion, self.target), "one of quaternion and target")
        if self.easing not in EASINGS:
            reject(about, "easing", self.easing, " or ".join(map(repr, EASINGS)))
        put("cut", flag(self.cut, "cut", about))
        put("frame", text(self.frame, "frame", about, "a frame's path"))
        if self.target_frame is not None:
            put("target_frame", text(self.target_frame, "target_frame", about, "a frame's path"))
            if self.target is None:
                reject(about, "target_frame", self.target_frame, "none without a target")
        put("position", _triple(self.position, "position", about))
        put("up", _triple(self.up, "up", about))
        try:
            if self.quaternion is not None:
                put("quaternion", tuple(map(float, Pose(self.position, self.quaternion).quaternion)))
            else:
                Pose(self.position)
                put("target", _triple(self.target, "target", about))
        except InvalidArgument as error:
            raise type(error)(f"{about}: {error}", about) from None
        if self.target is not None and self.target_frame in (None, self.frame):
            if looking(self.position, self.target, self.up) is None:
                reject(about, "the target", self.target, f"another place than {self.position}, and not along "
                       f"up, {self.up}")


    def _check_lens(self, about, put):
        others = {name: getattr(self, name) for name in ("height", "tangents") if getattr(self, name) is not None}
        if len(others) > 1 or others and self.fov_deg not in (None, Key.fov_deg):
            reject(about, "its projection", {**others, "fov_deg": self.fov_deg}, "one of fov_deg, height and tangents")
        if others:
            put("fov_deg", None)
        else:
            put("fov_deg", _finite(self.fov_deg, "fov_deg", about))
            if not 1e-6 <= self.fov_deg <= 179:
                reject(about, "fov_deg", self.fov_deg, "1e-6 to 179 degrees")
        if self.height is not None:
            put("height", _finite(self.height, "height", about))
            if not 1e-9 <= self.height <= 1e18:
                reject(about, "height", self.height, "1e-9 to 1e18 metres")
        if self.tangents is not None:
            accepted = "left, right, top, bottom, -1e6 to 1e6, left < right and top < bottom by 1e-9 and more"
            tangents = tuple(map(float, numbers(self.tangents, 4, "tangents", about, accepted)))
            left, right, top, bottom = tangents
            if not (all(abs(each) <= 1e6 for each in tangents) and right - left >= 1e-9 and bottom - top >= 1e-9):
                reject(about, "tangents", self.tangents, accepted)
            put("tangents", tangents)


def _finite(value, what, about, low=-np.inf):
    value = number(value, what, about)
    if not np.isfinite(value) or value < low:
        reject(about, what, value, "a finite number" + (f" of {low:g} or more" if np.isfinite(low) else ""))
    return value


def _triple(value, what, about):
    array = numbers(value, 3, what, about)
    if not np.isfinite(array).all():
        reject(about, what, value, "3 finite numbers")
    return tuple(map(float, array))


def in_order(keys, about):
    """Returns the keys sorted by time. Two keys may have the same time only if the second one cuts."""
    keys = sorted(keys, key=lambda key: (key.time, key.cut))
    for a, b in zip(keys, keys[1:]):
        if a.time == b.time and not (b.cut and not a.cut):
            raise InvalidArgument(f"{about}: two keys at {a.time:g} s; accepted: one, or a second one with cut",
                                  about)
    return keys


def shots_of(keys):
    """Returns the lists of keys between cuts."""
    shots = []
    for key in keys:
        if key.cut or not shots:
            shots.append([])
        shots[-1].append(key)
    return shots


class Shot:
    """A camera between two cuts, in the frame of its first key."""

    def __init__(self, keys):
        self.keys = keys
        self.frame = keys[0].frame
        self.times = [key.time for key in keys]
        self.rests = [key.easing == "rest" for key in keys]
        self.follows = all(key.target is not None for key in keys)
        # A path through keys in other frames changes whenever those frames move.
        self.moves = any(key.frame != self.frame or key.target_frame not in (None, self.frame)
                         for key in keys)
        lens = keys[0].lens
        for key in keys:
            if key.lens != lens:
                reject(f"the key at {key.time:g} s", "its projection", key.lens, f"{lens}, as of the key at "
                       f"{keys[0].time:g} s, or a cut between them")
        self._lens, kind = lens, {"fov_deg": FovPath, "height": HeightPath, "tangents": TangentPath}[lens]
        self._lenses = kind(self.times, [getattr(key, lens) for key in keys], self.rests)
        self._paths = None

    def at(self, time, relative):
        """(position, quaternion, projection) in `frame`; relative(frame, base): a Pose, X_base_frame."""
        if self._paths is None or self.moves:
            self._paths = self._build(relative)
        places, turns, targets, ups = self._paths
        position = places.at(time)
        if turns is not None:
            return position, turns.at(time), self._projection(time)
        quaternion = looking(position, targets.at(time), ups.at(time))
        if quaternion is None:
            raise InvalidArgument(f"at {time:g} s of the movie the camera is at its target or looks along up; "
                                  "accepted: keys with another target or up, or with quaternions")
        return position, quaternion, self._projection(time)

    def _projection(self, time):
        return {self._lens: self._lenses.at(time)}

    def _build(self, relative):
        known = {self.frame: Pose()}

        def to_base(frame):
            if frame not in known:
                known[frame] = relative(frame, self.frame)
            return known[frame]

        positions, quaternions, targets, ups = [], [], [], []
        for key in self.keys:
            X_BF = to_base(key.frame)
            position = X_BF.apply(key.position) if key.frame != self.frame else np.array(key.position)
            up = X_BF.rotation @ key.up
            positions.append(position)
            ups.append(up / np.linalg.norm(up))
            if key.target is None:
                quaternions.append((X_BF @ Pose(quaternion=key.quaternion)).quaternion
                                   if key.frame != self.frame else key.quaternion)
                continue
            frame = key.frame if key.target_frame is None else key.target_frame
            target = to_base(frame).apply(key.target) if frame != self.frame else np.array(key.target)
            targets.append(target)
            if not self.follows:
                q = looking(position, target, up)
                if q is None:
                    reject(f"the key at {key.time:g} s", "the target", key.target, "another place than the "
                           "camera's, and not along up")
                quaternions.append(q)
        places = PlacePath(self.times, positions, self.rests)
        if self.follows:
            return (places, None, PlacePath(self.times, targets, self.rests),
                    PlacePath(self.times, ups, self.rests))
        return places, TurnPath(self.times, quaternions, self.rests), None, None


class CameraPath:
    """The path of a camera through all of its keys."""

    def __init__(self, keys, about="the keys"):
        if not keys:
            raise InvalidArgument(f"{about}: there are none; accepted: one or more", about)
        self.keys = in_order(keys, about)
        self.shots = [Shot(keys) for keys in shots_of(self.keys)]

    def at(self, time, relative=None):
        """(frame, position, quaternion, projection) at a time of the movie [s]; projection: a dict of one of fov_deg,
        height and tangents, as Camera.set_projection takes it.

        relative(frame, base): the Pose of a frame in another one, now; needed for keys on several."""
        shot = self.shots[0]
        for each in self.shots[1:]:
            if each.times[0] <= time:
                shot = each
        return (shot.frame, *shot.at(time, relative))


class RunTime:
    """The time of the run as a function of the movie's time: linear between keys that state it, at `speed` elsewhere.

    Two keys with equal run times freeze the run while the camera keeps moving."""

    def __init__(self, keys, start=0.0, speed=1.0):
        self.parts = []  # (from, [(time, run)])
        at, run = 0.0, start
        for shot in shots_of(keys):
            knots = [(key.time, key.run) for key in shot if key.run is not None]
            begin = shot[0].time if self.parts else 0.0
            run += speed * (begin - at)
            # The run approaches the first key that states a run time at `speed`.
            knots = knots or [(begin, run)]
            self.parts.append((begin, knots))
            at, run = knots[-1]
        if not self.parts:
            self.parts = [(0.0, [(0.0, start)])]
        self.speed = speed

    def at(self, time):
        knots = [knots for begin, knots in self.parts if begin <= time or begin == self.parts[0][0]][-1]
        times, runs = np.array(knots).T
        if time in times:
            return float(runs[np.flatnonzero(times == time)[0]])
        if time < times[0]:
            return float(runs[0] + self.speed * (time - times[0]))
        if time > times[-1]:
            return float(runs[-1] + self.speed * (time - times[-1]))
        return float(np.interp(time, times, runs))
