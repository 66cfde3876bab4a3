"""Scenes: frames and all that hangs on them."""
import numpy as np

from dspace import _wire
from dspace._belonging import Belonging
from dspace._fields import (Named, about, array_of, flag, integers, keywords, put, put_given, put_vector,
                            refuse, shown)
from dspace._making import ObjectMaking
from dspace._strict import Strict
from dspace.cameras import CHASE, Camera, Vantage, put_chase, put_projection
from dspace.errors import AlreadyExists, InvalidArgument, WrongType
from dspace.fragments import Fragment, Light, put_light
from dspace.frames import Frame, put_ids, put_pose
from dspace.messages import Messages
from dspace.objects import GraphicsObject
from dspace.poses import to_pose
from dspace.robots import Robot
from dspace.proto import commands_pb2 as pb
from dspace.telemetry import Telemetry
from dspace.terrain import TerrainMaking
from dspace.viewports import SIZE, Viewport

MAIN = "main"  # the vantage that always exists


class Scene(Belonging, Messages, ObjectMaking, TerrainMaking, Strict):
    """One scene of a session.

    Functions that make an object take, besides their own arguments: frame (a Frame, a path; default
    the root), name, ornamental, fragment; position [m], quaternion and stretch of the object in its
    frame; visible, pickable; line_width and point_size [pixels]; and the material: color (sRGB, 0 to
    1, or '#rrggbb', or a CSS name), opacity, metallic, roughness, texture (an image file), lit, wireframe.
    """

    def __init__(self, client, name):
        self._client = client
        self._name_ = name

    # --- Commands ------------------------------------------------------------------------------

    def _command(self):
        return pb.Command(scene=self._name_)

    def _execute(self, command):
        return self._client.execute(command)

    def _do(self, kind, about=None, /, **fields):
        command = pb.Command(scene=self._name_)
        message = getattr(command, kind)
        message.SetInParent()
        put(message, about or f"{kind} in scene {self._name_!r}", **fields)
        return self._client.execute(command)

    _ask = _do

    def _frame_of(self, id):
        return Frame(self, id)

    def _object(self, id):
        return GraphicsObject(self, id)

    @property
    def name(self):
        return self._name_

    def remove(self):
        """Rejected while a viewport shows it."""
        self._do("remove_scene")

    @property
    def time(self):
        """Simulation time [s]; what is smoothed depends on it. Set it before the poses of a step.

        It may be set back, as a playback does that jumps: chase cameras with smoothing_s are then in
        place at once, as if they had just been set; trails keep their points (see Trail.clear)."""
        return self._ask("get_time").time.time_s

    @time.setter
    def time(self, time_s):
        self._do("set_time", f"scene {self._name_!r}", time_s=time_s)

    # --- Frames --------------------------------------------------------------------------------

    @property
    def root(self):
        """The root frame, whose axes are the world's."""
        return Frame(self, 1)

    def add_frame(self, name, parent=None, position=None, quaternion=None, scale=None, pose=None):
        """A new frame in `parent` (default: root); see Frame.add_frame."""
        parent = Frame(self, self._frame_id(parent))
        return parent.add_frame(name, position, quaternion, scale, pose)

    def frame(self, path):
        """The frame at a path such as "rover/mast"."""
        return self.root.frame(path)

    __getitem__ = frame

    @property
    def frames(self):
        """All frames but the root, parents first, by path."""
        infos = self._ask("list_frames").frames.frame
        return Named("frame", {info.path: Frame(self, info.id) for info in infos if info.id != 1})

    def set_poses(self, frames, poses):
        """One step: the local poses of many frames in one command, all checked before any is set.

        frames: Frames, paths, or an integer array of ids, each once; poses: an array (n, 8) of
        px py pz qw qx qy qz scale, or (n, 7) without the scale, which then is 1."""
        accepted = "an array (n, 8) of px py pz qw qx qy qz scale, or (n, 7) without the scale"
        array = array_of(poses, "poses", accepted, f"set_poses in scene {self._name_!r}")
        if array.size and (array.ndim not in (1, 2) or array.shape[-1] not in (7, 8)):
            raise InvalidArgument(f"set_poses in scene {self._name_!r}: the poses have shape "
                                  f"{array.shape}; accepted: {accepted}")
        if array.size and array.shape[-1] == 7:
            array = np.concatenate((array, np.ones(array.shape[:-1] + (1,))), axis=-1)
        command = self._command()
        command.set_poses.SetInParent()
        put_ids(command.set_poses, "frame", self, frames)
        _wire.put_array(command.set_poses, "pose", array)
        self._execute(command)

    def poses(self, frames, relative_to=None):
        """Poses of many frames as an array (n, 8) of px py pz qw qx qy qz scale: in their parents,
        or in the frame `relative_to`."""
        command = self._command()
        put_ids(command.get_poses, "frame", self, frames)
        if relative_to is None:
            command.get_poses.local = True
        else:
            command.get_poses.relative_to = self._frame_id(relative_to)
        return _wire.get_array(self._execute(command).poses, "pose").reshape(-1, 8)

    def on_frame_change(self, callback):
        """Calls `callback` with a FrameEvent for every later change of the frames; returns a token
        for remove_listener.

        The tree itself tells of its changes, whatever causes them: frames made, moved and removed,
        robots loaded, joints set. Callbacks run in the thread that gave the command, when it has
        succeeded, in the order in which they were added. They may give commands: those take effect
        at once, and their events follow when the present one has reached everybody. When a callback
        raises, the change stays made and the others are called; the first exception is then raised
        to whoever gave the command. What C++ code changes on the scene itself comes with the next
        command, and commands given to `session.vtk` keep their events in their own replies. A scene
        that is removed and a session that is closed forget their listeners; without any, nothing is
        noted.

        A callback whose commands cause it to be called again without end is stopped after 100 rounds
        (or 100,000 changes): it hears no more of them, and dspace.Resource is raised that names it. Of
        what C++ code has changed on the scene itself up to a thousand events wait for the next command;
        poses that change beyond these come as one event, with each frame once."""
        if not callable(callback):
            refuse(f"scene {self._name_!r}", "the callback", callback, "a function of one FrameEvent",
                   WrongType)
        self._do("follow_frames")
        return self._client.frame_listeners.add(self, callback)

    def remove_listener(self, token):
        """Ends what on_frame_change began. False when there is no such listener (any more)."""
        if not isinstance(token, int):
            refuse(f"scene {self._name_!r}", "the token", token, "what on_frame_change returned",
                   WrongType)
        listeners = self._client.frame_listeners
        if not listeners.remove(self, token):
            return False
        if not listeners.follows(self):
            self._do("follow_frames", stop=True)
        return True

    @property
    def telemetry(self):
        """Named values, for tables, plots and overlays: see dspace.Telemetry."""
        return Telemetry(self)

    # --- Objects -------------------------------------------------------------------------------

    def object(self, name):
        """The object of that name."""
        return GraphicsObject(self, self._ask("find_object", "an object", name=name).object.object)

    @property
    def objects(self):
        """All objects, by name."""
        infos = self._ask("list_objects").objects.object
        return Named("object", {info.name: GraphicsObject(self, info.id) for info in infos})

    @property
    def robots(self):
        """All robots, by name."""
        return Named("robot", {name: Robot(self, self._ask("describe_robot", robot=name).robot)
                               for name in self._ask("list_robots").robots.name})

    # --- Fragments and lights ------------------------------------------------------------------

    def add_fragment(self, name, ornamental=False):
        self._do("create_fragment", "new fragment", name=name,
                 nature=1 if flag(ornamental, "ornamental", f"fragment {name!r}") else 0)
        return Fragment(self, name)

    @property
    def fragments(self):
        """All fragments, by name; "physical" and "ornamental" always exist."""
        infos = self._ask("list_fragments").fragments.fragment
        return Named("fragment", {info.name: Fragment(self, info.name) for info in infos})

    def add_light(self, name, kind="directional", **values):
        """A new light. kind: "directional", "point", "spot", "head" or "ambient"; values: see Light.set.

        One that there is, "sun" and "sky" too, is changed by scene.lights[name].set(...)."""
        command = self._command()
        put(command.set_light, "new light", name=name)
        put_light(self, command.set_light, {"kind": kind, **values})
        if name in self.lights:
            raise AlreadyExists(f"light {name!r}: there is a light of this name in scene "
                                f"{self._name_!r}; accepted: another name, or scene.lights[{name!r}]"
                                ".set(...) to change it", f"light {name!r}")
        self._execute(command)
        return Light(self, name)

    @property
    def lights(self):
        """All lights, by name. A new scene has "sun" and "sky"."""
        return Named("light", {info.name: Light(self, info.name)
                               for info in self._ask("list_lights").lights.light})

    # --- Views ---------------------------------------------------------------------------------

    def add_vantage(self, name):
        self._do("create_vantage", "new vantage", name=name)
        return Vantage(self, name)

    @property
    def vantages(self):
        """All vantages, by name; "main" always exists."""
        infos = self._ask("list_vantages").vantages.vantage
        return Named("vantage", {info.name: Vantage(self, info.name) for info in infos})

    def add_camera(self, name="camera", frame=None, eye=None, target=None, up=(0, 0, 1), pose=None,
                   chase=None, fov_deg=None, height=None, tangents=None, near=None, far=None,
                   vantage=MAIN):
        """A camera, or a new setting of the one of that name.

        It stands on `frame` (default: root) at `eye` looking at `target`, or at `pose`; or it chases
        `frame`, with chase a dict of what Camera.chase takes. The projection is as in
        Camera.set_projection; the default is perspective, 45 degrees. All is one command."""
        label = f"camera {shown(name)}"
        given = [word for word, value in (("eye", eye), ("pose", pose), ("chase", chase))
                 if value is not None]
        if len(given) > 1:
            raise InvalidArgument(f"{label}: {' and '.join(given)} are given; accepted: one of eye, pose "
                                  "and chase", label)
        if (eye is None) != (target is None):
            raise InvalidArgument(f"{label}: eye is {eye!r}, target {target!r}; accepted: both, or none "
                                  "of them", label)
        vantage = self._vantage_name(vantage, label)
        command = self._command()
        message = command.set_camera
        put(message, label, vantage=vantage, name=name)
        put_projection(message.projection, fov_deg, height, tangents, near, far, label)
        mount = message.mount
        mount.frame = self._frame_id(frame)
        if eye is not None:
            look = mount.look_at
            put_vector(look.eye, eye, "the eye", label)
            put_vector(look.target, target, "the target", label)
            put_vector(look.up, up, "up", label)
        elif chase is not None:
            if not isinstance(chase, dict):
                refuse(label, "chase", chase, f"a dict of {', '.join(CHASE)}", WrongType)
            keywords(chase, CHASE, f"{label}, chase")
            put_chase(mount.chase, **chase, about=label)
        else:
            with about(label):
                put_pose(mount.pose, to_pose(pose=pose) if pose is not None else to_pose())
        self._execute(command)
        return Camera(self, vantage, name)

    @property
    def cameras(self):
        """Those of the main vantage, by name."""
        return Vantage(self, MAIN).cameras

    def add_viewport(self, size=(1280, 720), camera=None, name=None, vantage=None, samples=None,
                     visible=True):
        """A view of this scene, `size` (width, height) pixels; camera: None for the active one."""
        label = "new viewport" if name is None else f"viewport {shown(name)}"
        command = self._command()
        message = command.create_viewport
        put(message, label, name="" if name is None else name,
            camera=self._name_of(camera, Camera, "camera", label),
            vantage=self._vantage_name(vantage, label))
        if isinstance(camera, Camera):
            if vantage is not None and message.vantage != camera.vantage:
                raise InvalidArgument(f"{label}: camera {camera.name!r} is of vantage "
                                      f"{camera.vantage!r}; accepted: one of {message.vantage!r}", label)
            message.vantage = camera.vantage
        width, height = integers(size, 2, "the size", label, SIZE)
        put(message, label, width=width, height=height)
        put_given(message, label, samples=samples)
        message.hidden = not flag(visible, "visible", label)
        return Viewport(self._client, self._execute(command).viewport.name)

    @property
    def vtk(self):
        """The vtkDspaceScene that mirrors it."""
        return self._client.local().GetScene(self._name_)

    def __eq__(self, other):
        return (isinstance(other, Scene)
                and (self._client, self._name_) == (other._client, other._name_))

    def __hash__(self):
        return hash((id(self._client), self._name_))

    def __repr__(self):
        try:
            return (f"<dspace.Scene {self._name_!r}, {len(self.frames)} frames, "
                    f"{len(self.objects)} objects>")
        except Exception:  # a repr never raises
            return f"<dspace.Scene {self._name_!r}, gone>"
