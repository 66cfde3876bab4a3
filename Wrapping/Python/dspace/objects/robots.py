"""Articulated models: joints that move frames."""
from collections.abc import Mapping

from dspace._core.fields import Named, flag, number, reject, text
from dspace._core.strict import Strict
from dspace.errors import WrongType
from dspace.frames.poses import Pose
from dspace.objects.placed import Placed

TYPES = ("fixed", "revolute", "continuous", "prismatic", "floating", "planar")


class Joint(Strict):
    """One joint of a robot. Positions are degrees, or metres for prismatic ones."""

    def __init__(self, robot, index, info):
        self._robot = robot
        self._index = index
        self._info = info

    @property
    def name(self):
        return self._info.name

    @property
    def type(self):
        """"fixed", "revolute", "continuous", "prismatic", "floating" or "planar"."""
        return TYPES[self._info.type]

    @property
    def axis(self):
        """Unit, in the joint's frame."""
        axis = self._info.axis
        return (axis.x, axis.y, axis.z)

    @property
    def limits(self):
        """(lower, upper) in degrees or metres; None without limits."""
        if not self._info.HasField("lower"):
            return None
        return (self._info.lower, self._info.upper)

    @property
    def mimics(self):
        """The joint that it mimics, or None."""
        if not self._info.HasField("mimic"):
            return None
        return self._robot.joints[self._robot._joint_names[self._info.mimic]]

    @property
    def frame(self):
        """The frame of the link that it moves."""
        return self._robot._link_frame(self._info.child_link)

    @property
    def position(self):
        """The position in degrees or metres. A value beyond the limits, or beyond 1e12 degrees without limits, raises
        an error."""
        return self._robot._describe().joint[self._index].position

    @position.setter
    def position(self, position):
        self._robot._set({self.name: position}, False)

    def __repr__(self):
        try:
            position = f"{self.position:g}"
        except Exception:  # a repr never raises
            return f"<dspace.Joint {self.name!r}, not in the scene any more>"
        limits = "" if self.limits is None else f" in {self.limits[0]:g} to {self.limits[1]:g}"
        unit = " m" if self.type == "prismatic" else " deg"
        return f"<dspace.Joint {self.name!r}, {self.type}, at {position}{limits}{unit}>"


class Joints(Mapping):
    """The joints of a robot by name."""

    def __init__(self, joints):
        self._joints = joints

    def __getitem__(self, name):
        return self._joints[name]

    def __iter__(self):
        return iter(self._joints)

    def __len__(self):
        return len(self._joints)

    def __repr__(self):
        return f"<dspace.Joints {list(self._joints)}>"


class Robot(Placed):
    """A robot of a scene: a frame a link, moved by joints."""

    _own = ("joints",)

    def __init__(self, scene, info):
        self._scene = scene
        self._name = info.name
        self._base = info.base
        self._links = {link.name: link for link in info.link}
        self._link_list = list(info.link)
        self._joint_names = [joint.name for joint in info.joint]
        self._joint_index = {name: i for i, name in enumerate(self._joint_names)}
        self.joints = Joints(Named("joint", {joint.name: Joint(self, i, joint)
                                             for i, joint in enumerate(info.joint)}))

    def _describe(self):
        return self._scene._ask("describe_robot", robot=self._name).robot

    def _link_frame(self, index):
        return self._scene._frame_of(self._link_list[index].frame)

    def _label(self):
        return f"robot {self._name!r}"

    def _set(self, positions, clamp):
        command = self._scene._command()
        command.set_joints.robot = self._name
        command.set_joints.joint.extend(self.joints[name]._index for name in positions)
        command.set_joints.position.extend(
            number(position, "the position", f"joint {name!r} of robot {self._name!r}")
            for name, position in positions.items())
        command.set_joints.clamp = flag(clamp, "clamp", self._label)
        self._scene._execute(command)

    @property
    def name(self):
        return self._name

    @property
    def links(self):
        """The frame of each link, by name."""
        return Named("link", {name: self._scene._frame_of(link.frame)
                              for name, link in self._links.items()})

    @property
    def original_names(self):
        """The name of each link in the file, by the name of its frame. They differ where the file's name has a slash or
        another character that a path of frames cannot hold."""
        return {name: link.original_name for name, link in self._links.items()}

    @property
    def objects(self):
        """All its graphics objects."""
        return [self._scene._object(id) for link in self._link_list for id in link.object]

    def set_joints(self, positions, clamp=False):
        """Sets many joints at once, {name: degrees or metres}. All values are checked before any joint moves.

        clamp: limits a value beyond a limit; otherwise such a value raises an error."""
        if not hasattr(positions, "items"):
            reject(self._label, "positions", positions, "a dict {name: degrees or metres}", WrongType)
        self._set(positions, clamp)

    def place(self, state):
        """Applies the state of a vehicle of dspace.rover that was solved on terrain: its base and all joints.

            vehicle = dspace.rover.load_vehicle("rover.urdf")
            rover.place(vehicle.solve((x, y, heading_deg), ground))

        The terrain's frame must be the parent of the robot's base frame."""
        for each in ("position", "quaternion", "joints"):
            if not hasattr(state, each):
                reject(self._label, "the state", state, "what dspace.rover's solve() returned", WrongType)
        pose = Pose(state.position, state.quaternion, self.pose.scale)
        self.set_joints(state.joints, clamp=True)  # rejects the state of another vehicle before anything moves
        self.pose = pose

    def joint_positions(self):
        """{name: degrees or metres} of all joints."""
        return {joint.name: joint.position for joint in self._describe().joint}

    def link_pose(self, link):
        """X_BL of a link in the base frame."""
        text(link, "the link", self._label, "the name of a link")
        return Pose._of_row(self._scene.poses([self.links[link]], relative_to=self.frame)[0])

    def remove(self):
        self._scene._do("remove_robot", robot=self._name)

    def __repr__(self):
        return (f"<dspace.Robot {self._name!r}, {len(self._links)} links, "
                f"{len(self._joint_names)} joints>")
