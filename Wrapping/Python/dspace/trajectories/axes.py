"""The moving axes in which a trajectory is drawn, and rules by which a craft points."""
import numpy as np

from dspace._core.fields import array_of, number, numbers, reject
from dspace.trajectories.states import pack, put_path

KINDS = {"reference": 0, "rotating": 1, "lvlh": 2, "rtn": 3, "velocity": 4, "table": 5}
DIRECTIONS = {"nadir": 0, "velocity": 1, "orbit normal": 2}


class Axes:
    """What scene.add_trajectory accepts as `relative_to`; made by the functions beside it."""

    def __init__(self, kind, origin=None, other=None, share=0.0, times=None, rotations=None):
        self._kind, self._origin, self._other = kind, origin, other
        self._share, self._times, self._rotations = share, times, rotations

    def _put(self, message, about):
        message.kind = KINDS[self._kind]
        message.share = self._share
        if self._origin is not None:
            put_path(message.origin, self._origin, f"{about}, the origin of its axes")
        if self._other is not None:
            put_path(message.other, self._other, f"{about}, the other body of its axes")
        if self._times is not None:
            message.time = pack(self._times)
            message.rotation = pack(self._rotations)


def about_body(origin):
    """The axes F about another body: `origin` is its path about the same centre."""
    return Axes("reference", origin)


def rotating(first, second, share=0.0):
    """Axes that turn with two bodies: X from the first to the second, Z along the angular momentum of the second about
    the first. first, second: their paths, or None for the centre. share: where the origin is between them, 0 (the first)
    to 1; for the barycentre the second's share of the mass (Moon: 0.0121506 of Earth and Moon)."""
    share = number(share, "the share", "rotating axes")
    if not 0.0 <= share <= 1.0:
        reject("rotating axes", "the share", share, "0 to 1")
    return Axes("rotating", first, second, share)


def local(craft, axes="lvlh"):
    """Axes of the local vertical of a craft, whose path is given. axes: "lvlh" (Z down, Y against the angular momentum, X
    forward), "rtn" (X up, Z along the angular momentum, Y forward) or "velocity" (X along the velocity, Z along the
    angular momentum)."""
    if axes not in ("lvlh", "rtn", "velocity"):
        reject("local axes", "the axes", axes, "'lvlh', 'rtn', 'velocity'")
    return Axes(axes, craft)


def turning(times, rotations, origin=None):
    """Axes that turn as a table says: those of a body. times: (n,) [s]; rotations: (n, 4), w x y z, of unit length: each
    takes components in these axes to those in F; turns between two of them are less than half a revolution. origin: the
    path of the body; None: the centre."""
    times = array_of(times, "the times", "an array (n,)", "turning axes")
    rotations = array_of(rotations, "the rotations", "an array (n, 4)", "turning axes")
    if times.ndim != 1 or rotations.shape != (len(times), 4):
        reject("turning axes", "the shape of the rotations", rotations.shape, "(n, 4) for n times")
    return Axes("table", origin, times=times, rotations=rotations)


class Pointing:
    """A rule of two directions: `axis` of the craft points exactly along `direction`, `second_axis` as nearly along
    `second_direction` as that lets it.

    Directions are "nadir" (to the centre), "velocity", "orbit normal", or a path of what to point to: of the Sun or
    a station about the same centre, at most one. The default is nadir along Z and velocity along X."""

    def __init__(self, axis=(0, 0, 1), direction="nadir", second_axis=(1, 0, 0), second_direction="velocity"):
        self.axis = numbers(axis, 3, "the axis", "pointing")
        self.second_axis = numbers(second_axis, 3, "the second axis", "pointing")
        self.direction, self.second_direction = direction, second_direction

    def _put(self, message, about):
        for field, values in ((message.axis, self.axis), (message.second_axis, self.second_axis)):
            field.x, field.y, field.z = (float(v) for v in np.asarray(values))
        for name, direction in (("direction", self.direction), ("second_direction", self.second_direction)):
            if isinstance(direction, str) and direction in DIRECTIONS:
                setattr(message, name, DIRECTIONS[direction])
                continue
            if message.HasField("towards"):
                reject(about, "the second direction", direction, "one path to point to, not two")
            if isinstance(direction, str):
                reject(about, "a direction", direction, "'nadir', 'velocity', 'orbit normal', or a path")
            setattr(message, name, 3)
            put_path(message.towards, direction, f"{about}, what it points to")
