"""A vehicle of dspace.rover in a scene: its geometry on frames, moved by the states of a drive."""
import warnings

import numpy as np

from dspace import Pose
from dspace.rover import CarriedModel, load_vehicle


class Ground:
    """The terrain that is drawn, as dspace.rover asks for it."""

    def __init__(self, terrain):
        self._terrain = terrain

    def heights(self, xy):
        return self._terrain.height(xy[:, 0], xy[:, 1])

    def normals(self, xy):
        return self._terrain.normal(xy[:, 0], xy[:, 1])


class Described:
    """The model in a file: loaded into the scene, and what dspace.rover makes of it."""

    def __init__(self, scene, path, scale, up):
        self.robot = None
        self.objects = []
        self.frames = {}
        self.base = scene.add_frame("model")
        suffix = path.suffix.lower()
        if suffix == ".urdf":
            self.robot = scene.load(path, frame=self.base, name="vehicle")
            try:
                self.vehicle = load_vehicle(path)
            except ValueError:
                # No suspension: carried by the bounds of what is drawn.
                self.vehicle = load_vehicle(path, bounds=self._bounds(self.robot.objects, self.robot.frame))
        elif suffix == ".json" or path.is_dir():
            assembly = scene.load(path, frame=self.base)
            self.frames, self.objects = assembly.frames, assembly.objects
            try:
                self.vehicle = load_vehicle(path)
            except ValueError:
                if not self.objects:
                    raise ValueError(f"{path}: none of its frames has a mesh; accepted: a frames.json with one") from None
                # No suspension: carried by the bounds of what is drawn.
                self.vehicle = load_vehicle(path, bounds=self._bounds(self.objects, assembly.frame))
        else:
            vehicle_up = up or ("y" if suffix in (".gltf", ".glb", ".wrl", ".wrz") else "z")
            # In the file's own axes: CarriedModel turns and scales.
            carried = scene.load(path, frame=self.base, name="carried", scale=scale, up="z")
            self.objects.append(carried)
            low, high = carried.box
            self.vehicle = load_vehicle(path, bounds=(low / scale, high / scale), scale=scale,
                                        up=vehicle_up)
            size = float(max(self.vehicle.size))
            if not 0.05 <= size <= 200.0:
                warnings.warn(f"{path.name} is {size:.3g} m long with --scale {scale}: is that right?")
        self.wheeled = not isinstance(self.vehicle, CarriedModel)
        self.length = (1.7 * float(self.vehicle.wheel_base) if self.wheeled
                       else float(max(self.vehicle.size)))

    def _bounds(self, objects, base):
        """Of a robot or an assembly at rest, in its base frame."""
        corners = []
        for thing in objects:
            X_BO = thing.frame.pose_in(base).matrix @ thing.offset
            low, high = thing.box
            for mask in np.ndindex(2, 2, 2):
                corners.append((X_BO @ [*np.where(mask, high, low), 1.0])[:3])
        return np.min(corners, axis=0), np.max(corners, axis=0)


class PlacedVehicle:
    """Moves a Described vehicle; `frame` is the vehicle's own, X forward, Z up, on the ground."""

    def __init__(self, scene, described):
        self.scene = scene
        self.described = described
        self.vehicle = described.vehicle
        self.length = described.length
        self.frame = scene.add_frame("vehicle")
        mast = getattr(self.vehicle, "mast_joints", None)
        self.head = mast.tilt.child if mast else None

    def move(self, state, pan_deg):
        described = self.described
        paths = [described.base, self.frame]
        rows = [np.concatenate((state.position, state.quaternion, (1.0,))),
                np.concatenate((self._on_ground(state), attitude(state), (1.0,)))]
        for name, (position, quaternion) in state.frames.items():
            paths.append(described.frames[name])
            rows.append(np.concatenate((position, quaternion, (1.0,))))
        self.scene.set_poses(paths, np.array(rows))
        if described.robot is not None:
            joints = dict(state.joints)
            if described.wheeled:
                joints.update(self.vehicle.look(pan_deg, 14.0))
            described.robot.set_joints(joints, clamp=True)

    def _on_ground(self, state):
        if not state.contacts:
            return state.position
        return np.mean(list(state.contacts.values()), axis=0)


def attitude(state):
    """Vehicle axes (X forward, Y left, Z up) to world, as a quaternion (w, x, y, z)."""
    turned = (Pose(quaternion=_about(2, state.heading_deg)) @ Pose(quaternion=_about(1, state.pitch_deg))
              @ Pose(quaternion=_about(0, state.roll_deg)))
    return np.asarray(turned.quaternion)


def _about(axis, angle_deg):
    half = np.radians(angle_deg) / 2
    quaternion = np.zeros(4)
    quaternion[0] = np.cos(half)
    quaternion[1 + axis] = np.sin(half)
    return quaternion
