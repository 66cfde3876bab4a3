"""Scenes: frames and all that hangs on them."""
import os

import numpy as np

from dspace._strict import Strict
from dspace import _wire
from dspace._making import ObjectMaking
from dspace.cameras import Camera, Vantage, put_chase, put_projection
from dspace.fragments import Fragment, Light, put_light
from dspace.frames import Frame, put_ids, put_pose
from dspace.objects import GraphicsObject
from dspace.poses import to_pose, vector
from dspace.robots import Robot
from dspace.session import commands_pb2 as pb
from dspace.terrain import Terrain
from dspace.viewports import Viewport

MAIN = "main"  # the vantage that always exists


class Scene(ObjectMaking, Strict):
    """One scene of a session.

    Functions that make an object take, besides their own arguments: frame (a Frame, a path; default
    the root), name, ornamental, fragment; position [m], quaternion and stretch of the object in its
    frame; visible, pickable; line_width and point_size [pixels]; and the material: color (sRGB, 0 to
    1), opacity, metallic, roughness, texture (an image file), lit, wireframe.
    """

    def __init__(self, client, name):
        self._client = client
        self._name_ = name

    # --- Commands ------------------------------------------------------------------------------

    def _command(self):
        return pb.Command(scene=self._name_)

    def _execute(self, command):
        return self._client.execute(command)

    def _do(self, kind, **fields):
        command = pb.Command(scene=self._name_)
        message = getattr(command, kind)
        message.SetInParent()
        for field, value in fields.items():
            setattr(message, field, value)
        return self._client.execute(command)

    _ask = _do

    def _frame_id(self, frame):
        if frame is None:
            return 1
        if isinstance(frame, Frame):
            if frame.scene != self:
                raise ValueError(f"{frame!r} is in another scene; accepted: one of {self!r}")
            return frame.id
        if isinstance(frame, Robot):
            return self._frame_id(frame.frame)
        if isinstance(frame, str):
            return self._ask("find_frame", path=frame).frame.frame
        return int(frame)

    def _frame_of(self, id):
        return Frame(self, id)

    def _object(self, id):
        return GraphicsObject(self, id)

    @staticmethod
    def _name(thing):
        return "" if thing is None else thing if isinstance(thing, str) else thing.name

    @property
    def name(self):
        return self._name_

    def remove(self):
        """Refused while a viewport shows it."""
        self._do("remove_scene")

    @property
    def time(self):
        """Simulation time [s]; what is smoothed depends on it. Set it before the poses of a step."""
        return self._ask("get_time").time.time_s

    @time.setter
    def time(self, time_s):
        self._do("set_time", time_s=time_s)

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
        return {info.path: Frame(self, info.id) for info in infos if info.id != 1}

    def set_poses(self, frames, poses):
        """One step: the local poses of many frames in one command, all checked before any is set.

        frames: Frames, paths, or an integer array of ids; poses: an array (n, 8) of
        px py pz qw qx qy qz scale, or (n, 7) without the scale, which then is 1."""
        array = np.asarray(poses, dtype=float)
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
        noted."""
        if not callable(callback):
            raise TypeError(f"the callback is {callback!r}; accepted: a function of one FrameEvent")
        self._do("follow_frames")
        return self._client.frame_listeners.add(self, callback)

    def remove_listener(self, token):
        """Ends what on_frame_change began. False when there is no such listener (any more)."""
        listeners = self._client.frame_listeners
        if not listeners.remove(self, token):
            return False
        if not listeners.follows(self):
            self._do("follow_frames", stop=True)
        return True

    # --- Objects -------------------------------------------------------------------------------

    def object(self, name):
        """The object of that name."""
        return GraphicsObject(self, self._ask("find_object", name=name).object.object)

    @property
    def objects(self):
        """All objects, by name."""
        infos = self._ask("list_objects").objects.object
        return {info.name: GraphicsObject(self, info.id) for info in infos}

    @property
    def robots(self):
        """All robots, by name."""
        return {name: Robot(self, self._ask("describe_robot", robot=name).robot)
                for name in self._ask("list_robots").robots.name}

    # --- Fragments and lights ------------------------------------------------------------------

    def add_fragment(self, name, ornamental=False):
        self._do("create_fragment", name=name, nature=1 if ornamental else 0)
        return Fragment(self, name)

    @property
    def fragments(self):
        """All fragments, by name; "physical" and "ornamental" always exist."""
        infos = self._ask("list_fragments").fragments.fragment
        return {info.name: Fragment(self, info.name) for info in infos}

    def add_light(self, name, kind="directional", **values):
        """kind: "directional", "point", "spot", "head" or "ambient"; values: see Light.set."""
        command = self._command()
        command.set_light.name = name
        put_light(self, command.set_light, kind=kind, **values)
        self._execute(command)
        return Light(self, name)

    @property
    def lights(self):
        """All lights, by name. A new scene has "sun" and "sky"."""
        return {info.name: Light(self, info.name)
                for info in self._ask("list_lights").lights.light}

    # --- Views ---------------------------------------------------------------------------------

    def add_vantage(self, name):
        self._do("create_vantage", name=name)
        return Vantage(self, name)

    @property
    def vantages(self):
        """All vantages, by name; "main" always exists."""
        infos = self._ask("list_vantages").vantages.vantage
        return {info.name: Vantage(self, info.name) for info in infos}

    def add_camera(self, name="camera", frame=None, eye=None, target=None, up=(0, 0, 1), pose=None,
                   chase=None, fov_deg=None, height=None, tangents=None, near=None, far=None,
                   vantage=MAIN):
        """A camera, or a new setting of the one of that name.

        It stands on `frame` (default: root) at `eye` looking at `target`, or at `pose`; or it chases
        `frame`, with chase a dict of what Camera.chase takes. The projection is as in
        Camera.set_projection; the default is perspective, 45 degrees. All is one command."""
        if sum(value is not None for value in (eye, pose, chase)) > 1:
            raise ValueError("accepted: one of eye, pose and chase")
        if (eye is None) != (target is None):
            raise ValueError("accepted: both eye and target, or none of them")
        vantage = self._name(vantage)
        command = self._command()
        message = command.set_camera
        message.vantage = vantage
        message.name = name
        put_projection(message.projection, fov_deg, height, tangents, near, far)
        mount = message.mount
        mount.frame = self._frame_id(frame)
        if eye is not None:
            look = mount.look_at
            look.eye.x, look.eye.y, look.eye.z = vector(eye, "the eye")
            look.target.x, look.target.y, look.target.z = vector(target, "the target")
            look.up.x, look.up.y, look.up.z = vector(up, "up")
        elif chase is not None:
            put_chase(mount.chase, **chase)
        else:
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
        command = self._command()
        message = command.create_viewport
        message.name = name or ""
        if isinstance(camera, Camera) and vantage is None:
            vantage = camera.vantage
        message.vantage = self._name(vantage)
        message.camera = self._name(camera)
        message.width, message.height = size
        if samples is not None:
            message.samples = samples
        message.hidden = not visible
        return Viewport(self._client, self._execute(command).viewport.name)

    # --- Terrain -------------------------------------------------------------------------------

    def add_terrain(self, path, name=None, frame=None, image=None, color=None, relief=None,
                    origin=None, triangles=None, fragment=None, lit=True, image_crs=None,
                    image_extent=None, band=None, crs=None, vertical_datum=None,
                    vertical_scale=None, vertical_offset=None, pixel_size=None):
        """A raster of heights (anything that GDAL opens) as a physical object.

        image: a file to drape over it, with image_crs and image_extent (left, top, right, bottom in
        map coordinates) where the file does not say; color: one colour; relief: shaded relief (the
        default), a dict of sun_azimuth_deg, sun_elevation_deg, color_by_height. lit: whether the
        scene's lights shade it as well. origin: map x, y[, height] that become the frame's origin,
        by default the raster's middle at height 0. triangles: the budget (200000).
        band, crs, vertical_datum ("ellipsoid", "sphere:R", "areoid", ...), vertical_scale and
        vertical_offset [m], pixel_size (map units): what the file does not say, or says wrongly."""
        if sum(value is not None for value in (image, color, relief)) > 1:
            raise ValueError("accepted: one of image, color and relief")
        command = self._command()
        message = command.open_terrain
        message.path = os.fspath(path)
        message.name = name or ""
        message.frame = self._frame_id(frame)
        if image is not None:
            message.drape.path = os.fspath(image)
            message.drape.crs = image_crs or ""
            message.drape.extent.extend(() if image_extent is None else image_extent)
        elif color is not None:
            message.color.r, message.color.g, message.color.b = vector(color, "the colour")
        elif relief is not None:
            message.relief.SetInParent()
            known = [field.name for field in message.relief.DESCRIPTOR.fields]
            for field, value in relief.items():
                if field not in known:
                    raise ValueError(f"relief has {field!r}; accepted: {', '.join(known)}")
                setattr(message.relief, field, value)
        if origin is not None:
            values = tuple(origin) + (0.0,) * (3 - len(tuple(origin)))
            message.map_origin.x, message.map_origin.y, message.map_origin.z = values
        message.fragment = self._name(fragment)
        message.unlit = not lit
        for field, value in (("triangle_budget", triangles), ("band", band), ("crs", crs),
                             ("vertical_datum", vertical_datum), ("vertical_scale", vertical_scale),
                             ("vertical_offset", vertical_offset), ("pixel_size", pixel_size)):
            if value is not None:
                setattr(message, field, value)
        return Terrain(self, self._execute(command).terrain.name)

    @property
    def terrains(self):
        """All terrains, by name."""
        return {name: Terrain(self, name) for name in self._ask("list_terrains").terrains.name}

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
