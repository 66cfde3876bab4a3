"""Vehicles that follow a path over terrain: rovers whose wheels rest on it, and carried models."""
from dataclasses import dataclass, field
from pathlib import Path as FilePath

import numpy as np

from dspace.errors import InvalidArgument, NotFound
from . import meshes
from .contact import forward, rest_on
from .description import read_frames, read_urdf
from .mast import find_mast
from .path import as_pose
from .rotations import about_axis, packed, to_quaternion
from .suspension import find
from .terrain import as_terrain


@dataclass
class VehicleState:
    """A vehicle at one moment. Positions in metres in the terrain's axes (X, Y of the map, Z up),
    angles in degrees, quaternions unit and scalar first."""
    time: float
    position: np.ndarray  # of the model's root (its own origin), p_WM
    quaternion: np.ndarray  # model's root axes to world, q_WM (w, x, y, z)
    heading_deg: float  # counter-clockwise from +X
    roll_deg: float  # about the vehicle's forward axis, right side down positive
    pitch_deg: float  # about its left axis, nose down positive
    tilt_deg: float  # between the chassis' up and the vertical
    joints: dict = field(default_factory=dict)  # URDF joints that may be set: name -> degrees
    mimic_joints: dict = field(default_factory=dict)  # name -> degrees; follow others by themselves
    frames: dict = field(default_factory=dict)  # frames.json: name -> (position, quaternion) in parent
    contacts: dict = field(default_factory=dict)  # wheel -> point where it rests (3,)
    wheel_centers: dict = field(default_factory=dict)  # wheel -> (3,)
    wheel_heights: dict = field(default_factory=dict)  # wheel -> z of its contact point
    clearances: dict = field(default_factory=dict)  # wheel -> remaining gap [m], negative inside
    residual: float = 0.0  # largest absolute clearance [m]
    slip: float = 0.0  # wheels roll without slipping
    beyond_limits: list = field(default_factory=list)  # joints outside their limits


class CarriedModel:
    """A model without wheels that moves along the path. The bottom of its bounds is parallel to the mean plane of the
    terrain below its footprint and touches the highest point.

    bounds: (minimum (3,), maximum (3,)) in the file's coordinates. `scale` multiplies them to
    metres. `up` is the file's axis that points up, "y" or "z" (forward is then +Z or +X)."""

    kind = "carried"

    def __init__(self, bounds, scale=1.0, up="z", name="model"):
        low, high = (np.asarray(b, float).reshape(3) for b in bounds)
        if not (np.isfinite(low).all() and np.isfinite(high).all() and (low <= high).all()):
            raise InvalidArgument(f"{name}: bounds {bounds}; expected finite (minimum, maximum)")
        if not scale > 0 or up not in ("y", "z"):
            raise InvalidArgument(f"{name}: scale {scale}, up '{up}'; expected scale > 0, up 'y' or 'z'")
        self.name, self.scale, self.up, self.parts = name, float(scale), up, []
        # Columns: the rover's forward, left and up axes in the file's.
        self.X_MR = np.eye(3) if up == "z" else np.array([[0, 1, 0], [0, 0, 1], [1, 0, 0]], float)
        corners = np.array([low, high]) @ self.X_MR * self.scale
        self.low, self.high = corners.min(axis=0), corners.max(axis=0)
        self.size = self.high - self.low

    def __repr__(self):
        return f"CarriedModel({self.name!r}, {' x '.join(f'{s:.2f}' for s in self.size)} m)"

    def solve(self, pose, terrain):
        """VehicleState at a PathPose or (x, y, heading_deg): the footprint's centre is on the path."""
        pose = as_pose(pose)
        heights, _ = as_terrain(terrain)
        heading = np.radians(pose.heading_deg)
        g = np.linspace(-0.5, 0.5, 11)
        local = np.column_stack([v.ravel() for v in np.meshgrid(g, g)]) * self.size[:2]
        c, s = np.cos(heading), np.sin(heading)
        z = heights(np.array([pose.x, pose.y]) + local @ np.array([[c, s], [-s, c]]))
        fit = np.linalg.lstsq(np.column_stack([np.ones(len(z)), local]), z, rcond=None)[0]
        if (self.size[:2] < 1e-9).any():
            fit = np.array([z.max(), 0.0, 0.0])
        forward_axis = np.array([1.0, 0, fit[1]]) / np.hypot(1.0, fit[1])
        normal = np.array([-fit[1], -fit[2], 1.0])
        normal /= np.linalg.norm(normal)
        r = about_axis((0, 0, 1), np.array([heading]))[0] @ np.column_stack(
            [forward_axis, np.cross(normal, forward_axis), normal])
        lift = (z - fit[0] - local @ fit[1:]).max()  # the mean plane, raised to its highest ground
        bottom = np.array([*(self.low + self.high)[:2] / 2, self.low[2]])
        position = np.array([pose.x, pose.y, fit[0] + lift]) - r @ bottom
        tilt = np.degrees(np.arccos(np.clip(r[2, 2], -1, 1)))
        return VehicleState(pose.time, position, to_quaternion(r @ self.X_MR.T), pose.heading_deg,
                            float(np.degrees(np.arctan2(r[2, 1], r[2, 2]))),
                            float(-np.degrees(np.arcsin(r[2, 0]))), float(tilt))

    def drive(self, path, times, terrain):
        """VehicleStates at the times [s]."""
        return [self.solve(p, terrain) for p in path.poses(times)]


class WheeledVehicle:
    """A rover with a suspension that keeps every wheel on the ground.

    Built by `load_vehicle` or from a Description and its Suspension. The path runs below
    `reference` (rover axes: X forward, Y left, Z up from the model root's origin), the middle of the
    unsteered wheels' axle, or of all wheels where all are steered."""

    def __init__(self, description, suspension):
        self.description, self.suspension = description, suspension
        self.kind, self.name, self.parts = suspension.kind, description.name, description.parts
        self.wheels = [w.name for w in suspension.wheels]
        self.mast_joints = find_mast(description, suspension.X_MR)
        self.scale = 1.0

    def __repr__(self):
        w = self.suspension.wheels[0]
        return (f"{type(self).__name__}({self.name!r}, {self.kind}, {len(self.wheels)} wheels of radius "
                f"{w.radius:.3f} m, wheel base {self.wheel_base:.3f} m)")

    @property
    def reference(self):
        return self.suspension.reference

    @property
    def wheel_base(self):
        """Returns the distance from the rearmost to the foremost wheel center [m]."""
        return float(np.ptp([w.centre[0] for w in self.suspension.wheels]))

    def steering_angles(self, curvature):
        """Wheel name -> steering angle [deg] to the left, so that each steered wheel's axle passes
        through the turn's centre, 1 / curvature to the left of the reference point (Ackermann)."""
        out = {}
        for w in self.suspension.wheels:
            if w.steering >= 0:
                dx, dy = w.centre[0] - self.reference[0], w.centre[1]
                out[w.name] = float(np.degrees(np.arctan2(curvature * dx, 1.0 - curvature * dy)))
        return out

    def _steering(self, curvature):
        """(n, nodes) joint angles [rad] of the steering nodes, in their own senses."""
        curvature = np.asarray(curvature, float)
        a = np.zeros((len(curvature), len(self.suspension.nodes)))
        for w in self.suspension.wheels:
            if w.steering >= 0:
                dx, dy = w.centre[0] - self.reference[0], w.centre[1]
                a[:, w.steering] = np.sign(self.suspension.nodes[w.steering].axis[2]) \
                    * np.arctan2(curvature * dx, 1.0 - curvature * dy)
        return a

    def solve(self, pose, terrain):
        """VehicleState at a PathPose or (x, y, heading_deg[, curvature[, distance]]).

        Wheels turn by the length of their paths seen from above (from the pose's path, or all by `distance`). `drive`
        also includes the distance up and down hills."""
        pose = as_pose(pose)
        return self._states([pose], terrain, None)[0]

    def drive(self, path, times, terrain):
        """Returns VehicleStates along a Path at ascending times [s], solved together. Each wheel turns by the distance
        that its center has moved in space since the first time, which is rolling without slip."""
        times = np.atleast_1d(np.asarray(times, float))
        if (np.diff(times) < 0).any():
            raise InvalidArgument(f"{self.name}: times must ascend")
        return self._states(path.poses(times), terrain, True)

    def _states(self, poses, terrain, in_space):
        s = self.suspension
        curvature = np.array([p.curvature for p in poses])
        heading = np.radians([p.heading_deg for p in poses])
        steering = self._steering(curvature)
        rest = rest_on(s, as_terrain(terrain), np.array([[p.x, p.y] for p in poses]), heading, steering)
        angles = steering.copy()
        for k, node in enumerate(s.nodes):
            if node.role == "passive":
                angles[:, k] = rest.free @ node.coefficients
        for i, w in enumerate(s.wheels):
            angles[:, w.spin] = self._spin(w, rest, rest.centres[:, i], poses, in_space)
        frames = forward(s, angles)
        return [self._state(i, pose, rest, angles, frames) for i, pose in enumerate(poses)]

    def _spin(self, wheel, rest, centres, poses, in_space):
        """Spin angle [rad] in the joint's own sense. The wheel's turn against the world is path over
        radius; the joint turns by that less the pitch of what carries it."""
        first = poses[0]
        dx, dy = wheel.centre[0] - self.reference[0], wheel.centre[1]
        run = np.array([p.path.travel(dx, dy, p.distance) if p.path is not None else p.distance
                        for p in poses])
        if in_space and first.path is not None:
            run = run[0] + np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(centres, axis=0), axis=1))])
        ahead = np.einsum("nij,nj->ni", rest.rotation, rest.frames[wheel.carrier][0][:, :, 0])
        pitch = -np.arcsin(np.clip(packed(ahead[:, 2]), -1, 1))
        return np.sign(self.suspension.nodes[wheel.spin].axis[1]) * (run / wheel.radius - pitch)

    def _state(self, i, pose, rest, angles, frames):
        s = self.suspension
        r = rest.rotation[i]
        state = VehicleState(
            pose.time, rest.position[i].copy(), to_quaternion(r @ s.X_MR.T), pose.heading_deg,
            float(np.degrees(rest.roll[i])), float(np.degrees(rest.pitch[i])),
            float(np.degrees(np.arccos(np.clip(r[2, 2], -1, 1)))),
            residual=float(np.abs(rest.clearance[i]).max()))
        for k, node in enumerate(s.nodes):
            if node.joint is not None:
                self._report(state, node.joint, float(np.degrees(angles[i, k])))
        for name, (free, factor) in s.extras.items():
            joint = next(j for j in self.description.joints if j.name == name)
            self._report(state, joint, float(np.degrees(factor * rest.free[i, free])))
        for k, w in enumerate(s.wheels):
            state.contacts[w.name] = rest.contacts[i, k].copy()
            state.wheel_centers[w.name] = rest.centres[i, k].copy()
            state.wheel_heights[w.name] = float(rest.contacts[i, k, 2])
            state.clearances[w.name] = float(rest.clearance[i, k])
        if self.parts:
            self._place_frames(state, i, frames)
        return state

    @staticmethod
    def _report(state, joint, angle_deg):
        (state.mimic_joints if joint.mimic else state.joints)[joint.name] = angle_deg
        if not joint.lower - 1e-9 <= angle_deg <= joint.upper + 1e-9:
            state.beyond_limits.append(joint.name)

    def _place_frames(self, state, i, frames):
        """Poses of a frames.json vehicle's frames in their parents."""
        placed = {self.description.root: (np.eye(3), np.zeros(3))}
        for node, (r, p) in zip(self.suspension.nodes, frames):
            placed[node.name] = (r[i], p[i])
        for joint in self.description.joints:
            r0, p0 = placed[joint.parent]
            if joint.child not in placed:
                placed[joint.child] = (r0, p0 + r0 @ joint.translation)
            r, p = placed[joint.child]
            state.frames[joint.child] = (r0.T @ (p - p0), to_quaternion(r0.T @ r))

    def look(self, left_deg, down_deg):
        """Mast joints (name -> degrees) that turn the head from straight ahead to the left and down;
        empty when the vehicle has no mast that is known."""
        return self.mast_joints.look(left_deg, down_deg) if self.mast_joints else {}


class RockerBogie(WheeledVehicle):
    """Six wheels on two rockers and two bogies. The differential keeps the rockers' angles about
    the left axis equal and opposite, so that the chassis pitches by their mean."""


class IndependentSuspension(WheeledVehicle):
    """Four steered wheels on equal parallel arms with equal springs: opposite corners travel alike,
    so that all four wheels rest."""


def load_vehicle(path, bounds=None, scale=1.0, up=None):
    """Returns the vehicle in a model file.

    A URDF or a frames.json (or a folder that holds one) in which a suspension is recognised gives a
    RockerBogie (six wheels on two rockers and two bogies) or an IndependentSuspension (four steered wheels on parallel
    arms of one length); everything else a CarriedModel, whose bounds are `bounds`
    (minimum, maximum) in the file's coordinates, or are read from .gltf, .glb and .obj. `scale` and
    `up` apply to carried models; `up` is by default "y" for glTF and VRML, as those formats define,
    else "z". Raises dspace.NotFound, or dspace.InvalidArgument naming the file and what is wrong."""
    path = FilePath(path)
    if path.is_dir():
        path = path / "frames.json"
    if not path.exists():
        raise NotFound(f"{path}: no such model file")
    suffix = path.suffix.lower()
    if suffix in (".urdf", ".json", ".xml"):
        description = read_frames(path) if suffix == ".json" else read_urdf(path)
        suspension = find(description)
        if suspension is not None:
            kind = RockerBogie if suspension.kind == "rocker-bogie" else IndependentSuspension
            return kind(description, suspension)
        if bounds is None:
            raise InvalidArgument(f"{path}: no suspension is recognised; accepted: six wheels on two rockers and two bogies, or four "
                                  "steered wheels on arms of one length, each wheel a revolute or continuous joint of its own; or pass "
                                  "bounds, and the model is carried without turning wheels")
        return CarriedModel(bounds, scale, up or "z", description.name)
    if bounds is None:
        v = meshes.vertices(path)
        if not len(v):
            raise InvalidArgument(f"{path}: no vertices; pass bounds to carry the model")
        bounds = (v.min(axis=0), v.max(axis=0))
    up = up or ("y" if suffix in (".gltf", ".glb", ".wrl", ".wrz") else "z")
    return CarriedModel(bounds, scale, up, path.stem)
