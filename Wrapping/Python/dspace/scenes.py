"""Scenes: frames and all that hangs on them."""
import os

import numpy as np

from dspace import _wire
from dspace.cameras import Camera, Vantage, put_chase, put_projection
from dspace.fragments import Fragment, Light, put_light
from dspace.frames import Frame, put_ids, put_pose
from dspace.objects import (UP, GraphicsObject, Primitive, Text, TiltMarker, Trail, put_settings)
from dspace.poses import Pose, quaternion_of_axis, to_pose, vector
from dspace.robots import Robot
from dspace.session import commands_pb2 as pb
from dspace.terrain import Terrain
from dspace.viewports import Viewport

MAIN = "main"  # the vantage that always exists


# What takes a file's axis to Z.
_TURNS = {"z": (1, 0, 0, 0), "y": tuple(quaternion_of_axis("x", 90)),
          "x": tuple(quaternion_of_axis("y", -90)), "-z": (0, 1, 0, 0)}


def _points(points):
    array = np.asarray(points, dtype=float)
    if array.size and (array.ndim != 2 or array.shape[1] != 3):
        raise ValueError(f"the points have shape {array.shape}; accepted: (n, 3)")
    return array


class Scene:
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

    def load(self, path, frame=None, ornamental=False, scale=1.0, up="z", rotation=None,
             levels=(), strict=False, point_cloud=False, **settings):
        """A model file (glTF, GLB, VRML, OBJ, STL, PLY) as a GraphicsObject, or a URDF as a Robot.

        scale: metres a unit of the file. up: the file's axis that becomes Z ("z", "y", "x", "-z");
        rotation: a quaternion that turns it further. levels: coarser files as (path, pixels) pairs,
        each drawn while the object is seen larger than `pixels`; the last one should have 0, and
        `path` then needs its own number: (path, pixels) too.
        strict: a missing texture or mesh raises; else it is a warning (and, in a URDF, a stand-in).
        point_cloud: a file of points is shown, `point_size` pixels large; else no faces, no object.
        A URDF takes position, quaternion, name, fragment, and `pose` of its base frame only."""
        if up not in UP:
            raise ValueError(f"up is {up!r}; accepted: {', '.join(UP)}")
        first, pixels = path if isinstance(path, tuple) else (path, 0.0)
        if os.fspath(first).lower().endswith(".urdf"):
            return self._load_robot(first, frame, ornamental, strict, scale, up, rotation, **settings)
        command = self._command()
        message = command.import_object
        put_settings(self, message.object, frame=frame, ornamental=ornamental, **settings)
        message.level.add(path=os.fspath(first), minimum_pixels=pixels)
        for other, minimum in levels:
            message.level.add(path=os.fspath(other), minimum_pixels=minimum)
        message.scale = scale
        message.up = UP[up]
        if rotation is not None:
            q = message.rotation
            q.w, q.x, q.y, q.z = (float(v) for v in rotation)
        message.strict = strict
        message.point_cloud = point_cloud
        return GraphicsObject(self, self._execute(command).object.object)

    def _load_robot(self, path, frame, ornamental, strict, scale, up, rotation, name=None,
                    fragment=None, position=None, quaternion=None, pose=None):
        base = to_pose(position, quaternion, None, pose)
        if up != "z" or rotation is not None or scale != 1.0:
            turn = Pose(quaternion=_TURNS[up], scale=scale)
            base = base @ (turn if rotation is None else Pose(quaternion=rotation) @ turn)
        command = self._command()
        message = command.load_robot
        message.path = os.fspath(path)
        message.name = name or ""
        message.frame = self._frame_id(frame)
        put_pose(message.pose, base)
        message.nature = 1 if ornamental else 0
        message.fragment = self._name(fragment)
        message.strict = strict
        return Robot(self, self._execute(command).robot)

    def _primitive(self, settings, shape, **fields):
        command = self._command()
        put_settings(self, command.create_primitive.object, **settings)
        message = getattr(command.create_primitive, shape)
        message.SetInParent()
        for field, value in fields.items():
            if value is not None:
                setattr(message, field, value)
        return command

    def _make(self, command, kind=Primitive):
        return kind(self, self._execute(command).object.object)

    def add_box(self, size, **settings):
        """size: three edges [m]; centred."""
        command = self._primitive(settings, "box")
        s = command.create_primitive.box.size
        s.x, s.y, s.z = vector(size, "the size")
        return self._make(command)

    def add_sphere(self, radius, resolution=None, **settings):
        """Centred, poles on Z [m]."""
        return self._make(self._primitive(settings, "sphere", radius=radius, resolution=resolution))

    def add_cylinder(self, radius, height, resolution=None, **settings):
        """Centred, along Z [m]."""
        return self._make(self._primitive(settings, "cylinder", radius=radius, height=height,
                                          resolution=resolution))

    def add_cone(self, radius, height, resolution=None, **settings):
        """Along Z, the apex at +height / 2 [m]."""
        return self._make(self._primitive(settings, "cone", radius=radius, height=height,
                                          resolution=resolution))

    def add_plane(self, width, height, **settings):
        """Centred, in XY, facing +Z [m]."""
        return self._make(self._primitive(settings, "plane", width=width, height=height))

    def add_disc(self, radius, resolution=None, **settings):
        """Centred, in XY, facing +Z [m]."""
        return self._make(self._primitive(settings, "disc", radius=radius, resolution=resolution))

    def add_torus(self, radius, tube, resolution=None, **settings):
        """About Z; radius to the middle of the tube [m]."""
        return self._make(self._primitive(settings, "torus", radius=radius, tube=tube,
                                          resolution=resolution))

    def add_arrow(self, length, ornamental=True, **settings):
        """From the origin along +X [m]."""
        return self._make(self._primitive({**settings, "ornamental": ornamental}, "arrow",
                                          length=length))

    def add_axes(self, length, ornamental=True, **settings):
        """X red, Y green, Z blue, from the origin [m]."""
        return self._make(self._primitive({**settings, "ornamental": ornamental}, "axes",
                                          length=length))

    def add_lines(self, points, closed=False, ornamental=True, **settings):
        """One polyline through an array (n, 3), or a list of several such [m]."""
        several = isinstance(points, (list, tuple)) and len(points) and np.ndim(points[0]) == 2
        lines = [_points(line) for line in (points if several else [points])]
        command = self._primitive({**settings, "ornamental": ornamental}, "lines", closed=closed)
        message = command.create_primitive.lines
        _wire.put_array(message, "point", np.concatenate([line.ravel() for line in lines]))
        if several:
            message.count.extend(len(line) for line in lines)
        return self._make(command)

    def add_points(self, points, ornamental=True, **settings):
        """Points of an array (n, 3) [m], `point_size` pixels large."""
        command = self._primitive({**settings, "ornamental": ornamental}, "points")
        _wire.put_array(command.create_primitive.points, "point", _points(points))
        return self._make(command)

    def add_frustum(self, length, size, fov_deg=None, height=None, tangents=None, near=None,
                    ornamental=True, **settings):
        """What a camera (X right, Y down, Z forward) with an image of `size` (width, height) pixels
        sees up to `length` along Z [m]; the projection as in Camera.set_projection."""
        command = self._primitive({**settings, "ornamental": ornamental}, "frustum", length=length,
                                  width=size[0], height=size[1])
        put_projection(command.create_primitive.frustum.projection, fov_deg, height, tangents, near)
        return self._make(command)

    def add_goal(self, height, ornamental=True, **settings):
        """A pole along Z with a flag and a ring on the ground [m]."""
        return self._make(self._primitive({**settings, "ornamental": ornamental}, "goal",
                                          height=height))

    def add_tilt_marker(self, radius, tilt_deg=0.0, warn_deg=None, limit_deg=None, ornamental=True,
                        **settings):
        """A ring with a needle: green upright, yellow at warn_deg (15), red from limit_deg (30)."""
        command = self._primitive({**settings, "ornamental": ornamental}, "tilt", radius=radius,
                                  tilt_deg=tilt_deg, warn_deg=warn_deg, limit_deg=limit_deg)
        return self._make(command, TiltMarker)

    def add_text(self, text, height, ornamental=True, **settings):
        """Flat letters in XY, readable from +Z; a capital letter is `height` metres high."""
        command = self._command()
        put_settings(self, command.create_text.object, ornamental=ornamental, **settings)
        command.create_text.text = text
        command.create_text.solid.height = height
        return self._make(command, Text)

    def add_label(self, text, font_size=None, color=None, background=None, background_opacity=None,
                  offset=None, ornamental=True, **settings):
        """A label that faces the camera; font_size and offset (right, up) in pixels."""
        command = self._command()
        put_settings(self, command.create_text.object, ornamental=ornamental, **settings)
        command.create_text.text = text
        label = command.create_text.label
        label.SetInParent()
        for field, value in (("color", color), ("background", background)):
            if value is not None:
                c = getattr(label, field)
                c.r, c.g, c.b = vector(value, field)
        if font_size is not None:
            label.font_size = font_size
        if background_opacity is not None:
            label.background_opacity = background_opacity
        if offset is not None:
            label.offset_x, label.offset_y = offset
        return self._make(command, Text)

    def add_trail(self, capacity=10000, minimum_spacing=0.0, fade=False, ornamental=True,
                  **settings):
        """A line through the last `capacity` points that Trail.append was given, each at least
        `minimum_spacing` [m] from the one before; fade: older points are fainter."""
        command = self._command()
        message = command.create_trail
        put_settings(self, message.object, ornamental=ornamental, **settings)
        message.capacity = capacity
        message.minimum_spacing = minimum_spacing
        message.fade = fade
        return self._make(command, Trail)

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
