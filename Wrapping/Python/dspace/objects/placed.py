"""The base class of models, robots and assemblies."""
from dspace._core.strict import Strict


class Placed(Strict):
    """Something that a base frame places as a whole. A derived class sets `_scene` and the frame's id `_base`, or
    overrides `frame`."""

    @property
    def scene(self):
        return self._scene

    @property
    def frame(self):
        """The base frame. It holds all the others, and its pose places the whole."""
        return self._scene._frame_of(self._base)

    @property
    def pose(self):
        """The pose of the base frame in its parent; may be set."""
        return self.frame.pose

    @pose.setter
    def pose(self, pose):
        self.frame.pose = pose
