"""Frames of the kinematic tree."""
import numpy as np

from dspace._core import wire
from dspace._core.fields import about, items, put, reject, shown, word
from dspace._core.strict import Strict
from dspace.errors import Error, InvalidArgument, WrongType
from dspace.frames.poses import Pose, multiply, quaternion_of_axis, quaternion_of_matrix, to_pose, vector


def put_pose(message, pose):
    """Writes a Pose into a Pose message."""
    message.position.x, message.position.y, message.position.z = pose.position
    q = message.rotation
    q.w, q.x, q.y, q.z = pose.quaternion
    message.scale = pose.scale


def _locked(array):
    array = np.array(array, dtype=float)
    array.setflags(write=False)  # frame.position[0] = 1 would be lost: let it fail
    return array


class Frame(Strict):
    """A frame F of a scene, with its pose in its parent P: X_PF.

    position [m, within 1e18], quaternion (unit, w x y z) and scale (1e-12 to 1e12) are read and set
    as a whole. Names have up to 255 bytes, hold no '/' and are neither "." nor "..".
    """

    def __init__(self, scene, id):
        self._scene = scene
        self._id = int(id)

    # --- Structure ---------------------------------------------------------------------------

    @property
    def scene(self):
        return self._scene

    @property
    def id(self):
        """The number that identifies it in commands."""
        return self._id

    def _label(self):
        try:
            return f"frame {self.path!r}"
        except Error:
            return f"frame {self._id}"

    def _info(self):
        return self._scene._ask("list_frames", below=self._id, shallow=True).frames.frame[0]

    @property
    def name(self):
        return self._info().name

    @name.setter
    def name(self, name):
        self._scene._do("rename_frame", self._label, frame=self._id, name=name)

    @property
    def path(self):
        """Names from below the root, joined by '/'."""
        return self._info().path

    @property
    def parent(self):
        """None for the root."""
        parent = self._info().parent
        return Frame(self._scene, parent) if parent else None

    @property
    def children(self):
        return [Frame(self._scene, child) for child in self._info().child]

    def add_frame(self, name, position=None, quaternion=None, scale=None, pose=None):
        """A new child. The pose in this frame is given whole or by its parts."""
        command = self._scene._command()
        put(command.create_frame, lambda: f"new frame in {self._label()}", parent=self._id, name=name)
        with about(f"frame {shown(name)}"):
            put_pose(command.create_frame.pose, to_pose(position, quaternion, scale, pose))
        return Frame(self._scene, self._scene._execute(command).frame.frame)

    def frame(self, path):
        """The frame at `path` below this one."""
        return Frame(self._scene,
                     self._scene._ask("find_frame", "a frame", path=path,
                                      base=self._id).frame.frame)

    __getitem__ = frame

    def remove(self):
        """Removes it with its subtree and all objects and lights on it.

        An error while a camera stands on or follows a frame of it."""
        self._scene._do("remove_frame", frame=self._id)

    def reparent(self, parent, keep="local"):
        """Hangs it under `parent` (scene.root for none), keeping its "local" or its "world" pose."""
        keep_world_pose = word(keep, {"local": False, "world": True}, "keep", self._label)
        if parent is None:
            reject(self._label, "the parent", parent, "a frame of its scene; scene.root is the root",
                   WrongType)
        self._scene._do("reparent_frame", frame=self._id, parent=self._scene._frame_id(parent),
                        keep_world_pose=keep_world_pose)

    # --- Pose --------------------------------------------------------------------------------

    @property
    def pose(self):
        """X_PF in its parent. May be set to a Pose, a 4 x 4 matrix, or a row of 8 or 7 numbers."""
        return Pose._of_row(self._scene.poses([self])[0])

    @pose.setter
    def pose(self, pose):
        with about(self._label):
            row = to_pose(pose=pose).row
        self._scene.set_poses([self], row)

    def set_pose(self, position=None, quaternion=None, scale=None):
        """Sets the parts that are given and keeps the others."""
        old = self.pose
        with about(self._label):
            self.pose = Pose(old.position if position is None else position,
                             old.quaternion if quaternion is None else quaternion,
                             old.scale if scale is None else scale)

    @property
    def position(self):
        """p_PF in the parent's axes [m]."""
        return _locked(self.pose.position)

    @position.setter
    def position(self, position):
        self.set_pose(position=position)

    @property
    def quaternion(self):
        """q_PF, unit, (w, x, y, z)."""
        return _locked(self.pose.quaternion)

    @quaternion.setter
    def quaternion(self, quaternion):
        self.set_pose(quaternion=quaternion)

    @property
    def rotation(self):
        """R_PF as a 3 x 3 matrix."""
        return _locked(self.pose.rotation)

    @rotation.setter
    def rotation(self, matrix):
        with about(self._label):
            quaternion = quaternion_of_matrix(matrix)
        self.set_pose(quaternion=quaternion)

    @property
    def rpy_deg(self):
        """Roll, pitch, yaw about the parent's fixed X, Y, Z axes [degrees]."""
        return _locked(self.pose.rpy_deg)

    @rpy_deg.setter
    def rpy_deg(self, angles):
        with about(self._label):
            quaternion = Pose.from_rpy_deg(*vector(angles, "rpy_deg")).quaternion
        self.set_pose(quaternion=quaternion)

    @property
    def scale(self):
        return self.pose.scale

    @scale.setter
    def scale(self, scale):
        self.set_pose(scale=scale)

    def rotate(self, axis, angle_deg):
        """Rotates it by an angle about one of its own axes ("x", "y", "z" or a vector)."""
        with about(self._label):
            turn = quaternion_of_axis(axis, angle_deg)
        q = multiply(self.pose.quaternion, turn)
        self.set_pose(quaternion=q / np.linalg.norm(q))

    def pose_in(self, other):
        """X_OF in another frame O of the scene, through their nearest common ancestor."""
        return Pose._of_row(self._scene.poses([self], relative_to=other)[0])

    @property
    def world_pose(self):
        """X_WF in the root."""
        return self.pose_in(self._scene.root)

    @property
    def vtk(self):
        """A vtkTransform that follows it (frame to root); for reading only."""
        return self._scene.vtk.GetFrame(self._id).GetTransform()

    def __eq__(self, other):
        return isinstance(other, Frame) and (self._scene, self._id) == (other._scene, other._id)

    def __hash__(self):
        return hash((self._scene, self._id))

    def __repr__(self):
        try:
            return f"<dspace.Frame {self.path!r}, {self.pose!r}>"
        except Exception:  # a repr never raises
            return f"<dspace.Frame id {self._id}, not in the scene any more>"


def put_ids(message, field, scene, frames):
    """Writes the ids of frames (Frames, paths, ids or an integer array) into a fixed64 field."""
    if isinstance(frames, np.ndarray):
        if frames.size and not np.issubdtype(frames.dtype, np.integer):
            raise WrongType(f"the ids are of type {frames.dtype}; accepted: integers")
        if frames.size and frames.min() < 0:
            raise InvalidArgument(f"an id is {frames.min()}; accepted: ids of frames, from 1 on")
        ids = frames.astype(np.uint64).ravel()
    else:
        each = items(frames, "frames", f"scene {scene.name!r}",
                     "a list of frames or paths, or an array of ids")
        ids = np.fromiter((scene._frame_id(frame) for frame in each), dtype=np.uint64)
    wire.put_array(message, field, ids)
    return len(ids)
