"""Completed changes of a scene's frames."""
import numpy as np

from dspace.frames.frame import Frame

TYPES = ("unspecified", "created", "removed", "reparented", "renamed", "poses_changed")


class FrameEvent:
    """One completed change of a scene's frames, as in C++ (dspace::FrameEvent).

    type: "created", "reparented" or "renamed", of one frame; "removed", of a frame with its subtree,
    children before parents; "poses_changed", of the frames whose local pose changed, each once
    (their descendants move with them and are not listed).
    """

    def __init__(self, scene, message):
        self._scene = scene
        self._message = message

    @property
    def type(self):
        return TYPES[self._message.type]

    @property
    def scene(self):
        return self._scene

    @property
    def revision(self):
        """The frame tree's, right after the change; it grows from event to event."""
        return self._message.revision

    @property
    def ids(self):
        """The ids of the frames, as an array; Frame.id of those that one kept."""
        return np.array(self._message.frame, dtype=np.uint64)

    @property
    def frames(self):
        """The Frames; of "removed" the ids, for these are in the scene no more."""
        if self.type == "removed":
            return list(self._message.frame)
        return [Frame(self._scene, id) for id in self._message.frame]

    def __repr__(self):
        ids = self._message.frame
        what = f"frame {ids[0]}" if len(ids) == 1 else f"{len(ids)} frames"
        return (f"<dspace.FrameEvent {self.type}, {what} of scene {self._message.scene!r}, "
                f"revision {self.revision}>")
