"""Models whose nodes are frames, so that their parts can be moved and their animations shown."""
from dspace._core.fields import Named, number, reject
from dspace._core.strict import Strict
from dspace.errors import WrongType
from dspace.objects.placed import Placed


class Animation(Strict):
    """An animation of a model's file."""

    def __init__(self, name, duration_s):
        self._name = name
        self._duration_s = duration_s

    @property
    def name(self):
        """In the file; may be empty."""
        return self._name

    @property
    def duration_s(self):
        """The time of its last key [s]."""
        return self._duration_s

    def __repr__(self):
        return f"<dspace.Animation {self._name!r}, {self._duration_s:g} s>"


class Model(Placed):
    """A model of scene.load(..., frames=True): a frame for each node of the file.

    A frame stands and turns as its node does, and has scale 1: scales of the file are in the objects. A part is turned by
    its frame's pose:

        model = scene.load("station.glb", frames=True)
        array = model.frames["array"]
        array.pose = array.pose @ dspace.Pose(quaternion=turn)
    """

    def __init__(self, scene, reply):
        self._scene = scene
        self._base = reply.base
        self._nodes = list(reply.node)
        self._animations = [Animation(each.name, each.duration_s) for each in reply.animation]
        self._lights = [light.name for light in reply.light]
        self._paths = []
        taken = set()
        for node in self._nodes:
            name, n = node.frame_name, 2
            while name in taken:
                name, n = f"{node.frame_name} {n}", n + 1
            taken.add(name)
            self._paths.append(name)

    def _label(self):
        return f"model {self.name!r}"

    @property
    def name(self):
        return self.frame.name

    @property
    def frames(self):
        """The frame of each node, by the node's name. Slashes and the like in names are "_"; a name that occurs again
        gets a number."""
        return Named("node", {name: self._scene._frame_of(node.frame)
                              for name, node in zip(self._paths, self._nodes)})

    @property
    def objects(self):
        """The object of each node that has geometry, by the node's name as in `frames`."""
        return Named("node with geometry", {name: self._scene._object(node.object)
                                            for name, node in zip(self._paths, self._nodes) if node.object})

    @property
    def original_names(self):
        """The name of each node in the file, by the name in `frames`."""
        return {name: node.name for name, node in zip(self._paths, self._nodes)}

    @property
    def animations(self):
        """The animations of the file, in its order."""
        return list(self._animations)

    @property
    def lights(self):
        """The names of the lights that were made, for scene.lights."""
        return list(self._lights)

    def pose_at(self, time_s, animation=None):
        """Shows the model as an animation has it at a time [s].

        animation: an Animation or its name; None: the first. Before the first key and after the last one that key holds.
        Only the nodes that the animation moves change. A scale that differs between the axes is shown as its mean."""
        if isinstance(animation, Animation):
            animation = animation.name
        if animation is not None and not isinstance(animation, str):
            reject(self._label, "animation", animation, "an Animation, its name, or None", WrongType)
        self._scene._do("pose_nodes", base=self._base, animation=animation or "",
                        time_s=number(time_s, "the time", self._label))

    def remove(self):
        """Removes the model with everything that is attached to its frames."""
        self.frame.remove()

    def __repr__(self):
        return f"<dspace.Model, {len(self._nodes)} nodes, {len(self._animations)} animations>"
