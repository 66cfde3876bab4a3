"""Vehicles that consist of one model for each part: the frames of a frames.json, each with a model."""
import os

import numpy as np

from dspace._core.fields import Named, reject
from dspace.errors import WrongType
from dspace.kinematics.frames_file import FILE_NAME, path_of, read_frames_file
from dspace.kinematics.rotations import to_quaternion
from dspace.objects.placed import Placed


class Assembly(Placed):
    """A vehicle of a frames.json: a frame a part, at rest until its frames are moved."""

    def __init__(self, scene, name, frame, frames, objects):
        self._scene = scene
        self._name = name
        self._frame = frame
        self._frames = frames
        self._objects = objects

    @property
    def name(self):
        return self._name

    @property
    def frame(self):
        """The base frame, by which the whole vehicle is placed."""
        return self._frame

    @property
    def frames(self):
        """The frame of each part, by its name in the file."""
        return Named("frame", self._frames)

    @property
    def objects(self):
        """All its graphics objects."""
        return list(self._objects)

    def place(self, state):
        """Applies the state of a vehicle of dspace.rover that was solved on terrain: its base and all frames."""
        for each in ("position", "quaternion", "frames"):
            if not hasattr(state, each):
                reject(f"vehicle {self._name!r}", "the state", state,
                       "what dspace.rover's solve() returned", WrongType)
        rows = [np.concatenate((state.position, state.quaternion, (self.pose.scale,)))]
        rows += [np.concatenate((position, quaternion, (1.0,)))
                 for position, quaternion in state.frames.values()]
        frames = self.frames
        self._scene.set_poses([self._frame, *(frames[name] for name in state.frames)], np.array(rows))

    def remove(self):
        """Removes the base frame with everything attached to it."""
        self._frame.remove()

    def __repr__(self):
        return f"<dspace.Assembly {self._name!r}, {len(self._frames)} frames>"


def is_assembly(path):
    """Whether it is a folder or a frames.json."""
    return os.path.basename(path) == FILE_NAME or os.path.isdir(path)


def load_assembly(scene, path, base, frame=None, name=None, ornamental=False, fragment=None,
                  strict=False):
    """Loads the vehicle of a frames.json or its folder, with its base frame at the Pose `base` in `frame`. If
    anything is rejected, the scene is unchanged."""
    _, parts = read_frames_file(path)
    name = name or path_of(path).resolve().parent.name or "vehicle"
    root = scene.add_frame(name, frame, pose=base)
    try:
        frames, objects = {}, []
        for part in parts:
            parent = frames.get(part.parent, root)
            frames[part.name] = parent.add_frame(part.name, position=part.translation)
            if part.mesh is not None:
                position, quaternion, stretch = offset_of(part.matrix)
                objects.append(scene.load(part.mesh, frame=frames[part.name], ornamental=ornamental,
                                          fragment=fragment, strict=strict, up="z", position=position,
                                          quaternion=quaternion, stretch=stretch))
    except BaseException:
        root.remove()
        raise
    return Assembly(scene, name, root, frames, objects)


def offset_of(matrix):
    """Returns position, quaternion and stretch of a 4 x 4 matrix with orthogonal columns. A mirror becomes a negative
    stretch along X."""
    stretch = np.linalg.norm(matrix[:3, :3], axis=0)
    if np.linalg.det(matrix[:3, :3]) < 0:
        stretch[0] = -stretch[0]
    return matrix[:3, 3], to_quaternion(matrix[:3, :3] / stretch), stretch
