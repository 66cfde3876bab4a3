"""Finds a vehicle's suspension in its tree of joints and lays it out in rover axes.

Rover axes: origin at the model's root link, X forward, Y left, Z up, whatever the model's own axes
are. A `Suspension` is a list of nodes (moving bodies); each turns about one axis by an angle that is
a fixed linear combination of the suspension's free coordinates, or by its steering or spin angle.
"""
import re
from dataclasses import dataclass, field

import numpy as np

from dspace.errors import InvalidArgument


@dataclass
class Node:
    """A body that turns about an axis fixed in its parent body. Rover axes at position zero."""
    name: str  # the joint's (URDF) or frame's name
    parent: int  # node index, or -1 for the chassis
    origin: np.ndarray  # a point of the axis at position zero, rover axes [m]
    axis: np.ndarray  # unit, rover axes
    role: str  # "passive", "steering" or "spin"
    coefficients: np.ndarray = None  # passive: angle [rad] = coefficients @ free coordinates
    joint: object = None  # the Joint to report, or None for an inner one


@dataclass
class Wheel:
    """A wheel: its spin node, the node that carries it, its steering node (-1: none)."""
    name: str
    link: str
    spin: int
    carrier: int
    steering: int
    centre: np.ndarray  # at position zero, rover axes [m]
    radius: float
    width: float


@dataclass
class Suspension:
    kind: str  # "rocker-bogie" or "independent"
    X_MR: np.ndarray  # 3 × 3: rover axes' components to the model root's
    nodes: list
    wheels: list
    free: list  # names of the free coordinates
    reference: np.ndarray = None  # point of the chassis that follows the path, rover axes [m]
    extras: dict = field(default_factory=dict)  # joint -> (free coordinate, factor): differential bar


_WHEEL = re.compile(r"wheel|tire|tyre|drive", re.I)
_REAR = re.compile(r"rear|back|(^|_)[lr][rb](_|$)", re.I)
_FRONT = re.compile(r"front|(^|_)[lr]f(_|$)", re.I)


def _placed(description):
    """link -> (R, p) in the model root's axes with every joint at zero."""
    poses = {description.root: (np.eye(3), np.zeros(3))}
    waiting = list(description.joints)
    while waiting:
        rest = [j for j in waiting if j.parent not in poses]
        if len(rest) == len(waiting):
            raise InvalidArgument(f"{description.path}: joint '{rest[0].name}' hangs on link "
                             f"'{rest[0].parent}', which is not connected to '{description.root}'")
        for j in waiting:
            if j.parent in poses:
                r, p = poses[j.parent]
                poses[j.child] = (r @ j.rotation, p + r @ j.translation)
        waiting = rest
    return poses


def find(description):
    """Returns the Suspension of a Description, or None if no known suspension is recognized."""
    poses = _placed(description)
    parents = {j.parent for j in description.joints if j.kind != "fixed"}
    spins = []
    for j in description.joints:
        leaf = j.child not in parents
        wheel_like = _WHEEL.search(j.name) or _WHEEL.search(j.child) or j.child in description.cylinders
        if j.kind in ("revolute", "continuous") and leaf and wheel_like:
            spins.append(j)
    if len(spins) < 4:
        return None
    # Spin axes that agree (up to sign) are the vehicle's lateral direction.
    axes = [poses[j.child][0] @ j.axis for j in spins]
    lateral = axes[0]
    spins = [j for j, a in zip(spins, axes) if abs(a @ lateral) > 0.99]
    r_mr = _rover_axes(description, poses, spins, lateral)
    if r_mr is None:
        return None
    return _rocker_bogie(description, poses, spins, r_mr) or _wishbones(description, poses, spins, r_mr)


def _rover_axes(description, poses, spins, lateral):
    """Rover axes in the model root's: up is away from the wheels, forward is +X unless names say
    that the front wheels are elsewhere."""
    centres = np.array([poses[j.child][1] for j in spins])
    lateral = np.eye(3)[np.argmax(np.abs(lateral))]
    spread = np.ptp(centres, axis=0)
    candidates = [k for k in range(3) if abs(lateral[k]) < 0.5]
    forward_axis = max(candidates, key=lambda k: spread[k])
    up_axis = next(k for k in candidates if k != forward_axis)
    above = [poses[c.parent][1][up_axis] for j in spins for c in description.chain(j.child)[1:]]
    above += [p[up_axis] for _, p in poses.values()]
    up = np.eye(3)[up_axis] * (1.0 if np.mean(above) >= centres[:, up_axis].mean() else -1.0)
    forward = np.eye(3)[forward_axis]
    front = [p[forward_axis] for j, p in zip(spins, centres) if _FRONT.search(j.name) or _FRONT.search(j.child)]
    rear = [p[forward_axis] for j, p in zip(spins, centres) if _REAR.search(j.name) or _REAR.search(j.child)]
    if front and rear and np.mean(front) < np.mean(rear):
        forward = -forward
    return np.column_stack([forward, np.cross(up, forward), up])


def _wheel_size(description, joint):
    """Returns radius and width of a wheel from its collision cylinder, its mesh, or its visual cylinder."""
    if joint.child in description.cylinders:
        return description.cylinders[joint.child]
    v = description.link_vertices(joint.child)
    if not len(v) and joint.child in description.shown_cylinders:
        return description.shown_cylinders[joint.child]
    if not len(v):
        raise InvalidArgument(f"{description.path}: wheel '{joint.child}' has neither a cylinder nor "
                         "a mesh that can be measured; one of them gives its radius")
    along = v @ joint.axis
    return (float(np.linalg.norm(v - along[:, None] * joint.axis, axis=1).max()), float(np.ptp(along)))


class _Builder:
    """Adds joints as nodes, once each."""

    def __init__(self, poses, r_mr):
        self.poses, self.r_mr, self.nodes, self.index = poses, r_mr, [], {}

    def point(self, link):
        return self.r_mr.T @ self.poses[link][1]

    def direction(self, joint):
        return self.r_mr.T @ self.poses[joint.child][0] @ joint.axis

    def add(self, joint, parent, role, coefficients=None):
        if joint.name not in self.index:
            self.index[joint.name] = len(self.nodes)
            c = None if coefficients is None else np.asarray(coefficients, float)
            self.nodes.append(Node(joint.name, parent, self.point(joint.child), self.direction(joint), role,
                                   c, joint))
        return self.index[joint.name]


def _rocker_bogie(description, poses, spins, r_mr):
    """Two rockers on the chassis, each with one wheel of its own and a bogie with two more."""
    b = _Builder(poses, r_mr)
    sides = {1: {}, -1: {}}
    chains = []
    for spin in spins:
        chain = [j for j in description.chain(spin.child) if j.kind in ("revolute", "continuous")]
        passive = [j for j in chain[:-1] if abs(b.direction(j)[1]) > 0.99]
        steering = [j for j in chain[:-1] if abs(b.direction(j)[2]) > 0.9]
        if len(passive) not in (1, 2) or len(steering) > 1 or len(passive) + len(steering) + 1 != len(chain):
            return None
        side = 1 if b.point(spin.child)[1] > 0 else -1
        sides[side].setdefault(passive[0].name, []).append(passive)
        chains.append((spin, passive, steering, side))
    for rockers in sides.values():
        if len(rockers) != 1:
            return None
        paths = next(iter(rockers.values()))
        bogies = [p[1].name for p in paths if len(p) == 2]
        if len(paths) != 3 or len(bogies) != 2 or bogies[0] != bogies[1]:
            return None
    wheels = []
    for spin, passive, steering, side in chains:
        # Free coordinates: left rocker about +Y (the right one is its opposite through the
        # differential), left bogie, right bogie.
        c = np.zeros(3)
        c[0] = side * np.sign(b.direction(passive[0])[1])
        carrier = b.add(passive[0], -1, "passive", c)
        if len(passive) == 2:
            c = np.zeros(3)
            c[1 if side > 0 else 2] = np.sign(b.direction(passive[1])[1])
            carrier = b.add(passive[1], carrier, "passive", c)
        steer = -1
        if steering:
            steer = carrier = b.add(steering[0], carrier, "steering")
        index = b.add(spin, carrier, "spin")
        radius, width = _wheel_size(description, spin)
        wheels.append(Wheel(spin.name, spin.child, index, carrier, steer, b.point(spin.child), radius, width))
    s = Suspension("rocker-bogie", r_mr, b.nodes, wheels, ["rocker", "bogie_left", "bogie_right"])
    s.reference = _reference(wheels)
    _differential_bar(description, b, s)
    return s


def _differential_bar(description, b, s):
    """A bar that turns about the vertical on the deck, its ends led by the rockers: at height h above
    the rockers' axle and half length a, bar = -(h / a) * left rocker for small angles."""
    rocker = next(n for n in s.nodes if n.coefficients is not None and n.coefficients[0])
    used = {n.name for n in s.nodes}
    for j in description.joints:
        if j.kind in ("revolute", "continuous") and j.name not in used and "diff" in j.name.lower() \
                and abs(b.direction(j)[2]) > 0.99:
            height = b.point(j.child)[2] - rocker.origin[2]
            s.extras[j.name] = (0, -np.sign(b.direction(j)[2]) * height / abs(rocker.origin[1]))


def _reference(wheels):
    """Returns the point of the chassis that follows the path: the middle of the unsteered wheels' axles, or of all
    wheels. Every turn's center is abeam of it."""
    fixed = [w.centre for w in wheels if w.steering < 0] or [w.centre for w in wheels]
    centre = np.mean(fixed, axis=0)
    return np.array([centre[0], 0.0, centre[2] - wheels[0].radius])


def _wishbones(description, poses, spins, r_mr):
    """Four wheels on equal, parallel upper and lower arms (frames lower_arm_*, upper_arm_*,
    upright_*, wheel_*). With equal springs and no load transfer the travels sum to zero, about both
    axes too: what is left free is the warp, +, -, -, + over LF, RF, LB, RB."""
    frames = {j.name: j for j in description.joints}
    corners = [j.name.split("_", 1)[1] for j in spins if j.name.startswith("wheel_")]
    parts = ("lower_arm_", "upper_arm_", "upright_")
    if len(corners) != 4 or not all(p + c in frames for p in parts for c in corners):
        return None
    b = _Builder(poses, r_mr)
    wheels = []
    for corner in corners:
        spin, upright = frames["wheel_" + corner], frames["upright_" + corner]
        x, y, _ = b.point(spin.child)
        # Positive warp raises the front left wheel: turning about +X lifts what is on the left.
        c = [np.sign(x * y) * np.sign(y)]
        arms = [b.add(frames[p + corner], -1, "passive", c) for p in parts[:2]]
        # The frames do not give the outer pivots: the arms' meshes end at three quarters of the way
        # to the wheel's centre. The upright turns back by the arms' angle, so that it stays upright.
        inner = b.nodes[arms[0]].origin
        pivot = np.array([x, inner[1] + 0.75 * (y - inner[1]), inner[2]])
        b.nodes.append(Node("upright_level_" + corner, arms[0], pivot, np.array([1.0, 0, 0]), "passive",
                            -np.asarray(c, float)))
        steer = b.add(upright, len(b.nodes) - 1, "steering")
        index = b.add(spin, steer, "spin")
        radius, width = _wheel_size(description, spin)
        wheels.append(Wheel(spin.name, spin.child, index, steer, steer, b.point(spin.child), radius, width))
    s = Suspension("independent", r_mr, b.nodes, wheels, ["warp"])
    s.reference = _reference(wheels)
    return s
