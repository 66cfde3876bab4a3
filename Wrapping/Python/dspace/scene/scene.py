"""Scenes: frames, and everything on them."""
import numpy as np

from dspace._core import wire
from dspace._core.delegates import delegate
from dspace._core.fields import (Named, about, array_of, flag, integers, items, keywords, put, put_given, put_vector, reject,
                                 shown)
from dspace._core.strict import Strict
from dspace.cameras.camera import CHASE, POINT_AT, Camera, put_chase, put_point_at, put_projection
from dspace.cameras.images import SceneImages
from dspace.cameras.vantage import Vantage
from dspace.errors import AlreadyExists, InvalidArgument, WrongType
from dspace.frames.frame import Frame, put_ids, put_pose
from dspace.frames.poses import to_pose
from dspace.measure.best_sites import BestSites
from dspace.measure.ensembles import Ensembles
from dspace.measure.lens_ornaments import LensOrnaments
from dspace.measure.lines import Lines
from dspace.measure.lit import Lit
from dspace.measure.maps import Maps
from dspace.measure.scans import Scans
from dspace.measure.sight_contacts import SightContacts
from dspace.measure.sights import Sights
from dspace.measure.visibility import Visibility
from dspace.objects.fragments import Fragment, Light, put_light
from dspace.objects.assemblies import Assembly
from dspace.objects.factory import ObjectFactory
from dspace.objects.graphics import GraphicsObject
from dspace.objects.models import Model
from dspace.objects.plumes import PlumeFactory
from dspace.objects.robots import Robot
from dspace.objects.sensors import SensorFactory
from dspace.objects.trajectories import TrajectoryFactory
from dspace.proto import commands_pb2 as pb
from dspace.scene.bodies import BodyFactory
from dspace.scene.exports import SceneExports
from dspace.scene.membership import SceneMembership
from dspace.scene.shine import Shine
from dspace.scene.sun import Sun
from dspace.scene.viewport import SIZE, Viewport
from dspace.sky.sky import Kernels, ReferenceFrames, SceneSky
from dspace.telemetry.messages import SceneMessages
from dspace.telemetry.telemetry import Telemetry
from dspace.terrain.factory import TerrainFactory

MAIN = "main"  # the vantage that always exists


def _pose_rows(poses, about):
    """Poses as an array of rows of 8 numbers."""
    accepted = "an array (n, 8) of px py pz qw qx qy qz scale, or (n, 7) without the scale"
    array = array_of(poses, "poses", accepted, about)
    if array.size and (array.ndim not in (1, 2) or array.shape[-1] not in (7, 8)):
        raise InvalidArgument(f"{about}: the poses have shape {array.shape}; accepted: {accepted}")
    if array.size and array.shape[-1] == 7:
        array = np.concatenate((array, np.ones(array.shape[:-1] + (1,))), axis=-1)
    return array


class Scene(Strict):
    """One scene of a session.

    Functions that make an object take, besides their own arguments: frame (a Frame, a path; default
    the root), name, ornamental, fragment; position [m], quaternion and stretch of the object in its
    frame; visible, pickable; line_width and point_size [pixels]; and the material: color (sRGB, 0 to
    1, or '#rrggbb', or a CSS name), opacity, metallic, roughness, texture (an image file), lit, wireframe,
    emissive, reflectance (a photometric model, see GraphicsObject.reflectance).
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

    _require_own = delegate(SceneMembership, "require_own")
    _frame_id = delegate(SceneMembership, "frame_id")
    _name_of = delegate(SceneMembership, "name_of")
    _fragment_name = delegate(SceneMembership, "fragment_name")
    _vantage_name = delegate(SceneMembership, "vantage_name")
    _viewport_name = delegate(SceneMembership, "viewport_name")

    def _frame_of(self, id):
        return Frame(self, id)

    def _object(self, id):
        return GraphicsObject(self, id)

    @property
    def name(self):
        return self._name_

    def remove(self):
        """Removes the scene. Raises an error while a viewport shows it."""
        self._do("remove_scene")

    @property
    def time(self):
        """Simulation time [s]. Smoothed cameras depend on it. Set it before the poses of a step. A text is taken as a time
        (see tdb), and sets seconds past J2000 TDB.

        It may be set back, as a playback does when it jumps. Chase cameras with smoothing_s then restart
        without lag; trails keep their points (see Trail.clear)."""
        return self._ask("get_time").time.time_s

    @time.setter
    def time(self, time_s):
        seconds = self.tdb(time_s) if isinstance(time_s, str) else time_s
        self._do("set_time", f"scene {self._name_!r}", time_s=seconds)

    # --- Frames --------------------------------------------------------------------------------

    @property
    def root(self):
        """The root frame, whose axes are the world's."""
        return Frame(self, 1)

    def add_frame(self, name, parent=None, position=None, quaternion=None, scale=None, pose=None):
        """A new frame in `parent` (default: root); see Frame.add_frame."""
        parent = Frame(self, self._frame_id(parent))
        return parent.add_frame(name, position, quaternion, scale, pose)

    def add_frames(self, names, parent=None, poses=None):
        """Many new frames in one command, all or none. Returns their ids as an integer array, in the order of the names;
        set_poses and poses take it.

        names: of each frame. parent: one frame of all (default: root), or one each, as a list or an integer array of
        ids. poses: as for set_poses; default: identity."""
        label = f"add_frames in scene {self._name_!r}"
        names = items(names, "names", label, "a list of names")
        command = self._command()
        command.create_frames.SetInParent()
        try:
            command.create_frames.name.extend(names)
        except (TypeError, ValueError) as error:
            wrong = next((each for each in names if not isinstance(each, str)), None)
            if wrong is None:  # surrogates, of a file's name
                raise InvalidArgument(f"{label}: a name is not text of whole characters: {error}") from None
            reject(label, "a name", wrong, "a str", WrongType)
        if parent is None or isinstance(parent, (str, Frame)):
            put_ids(command.create_frames, "parent", self, [] if parent is None else [parent])
        else:
            put_ids(command.create_frames, "parent", self, parent)
        if poses is not None:
            wire.put_array(command.create_frames, "pose", _pose_rows(poses, label))
        first = self._execute(command).frame.frame
        return np.arange(first, first + len(names), dtype=np.uint64)

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
        array = _pose_rows(poses, f"set_poses in scene {self._name_!r}")
        command = self._command()
        command.set_poses.SetInParent()
        put_ids(command.set_poses, "frame", self, frames)
        wire.put_array(command.set_poses, "pose", array)
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
        return wire.get_array(self._execute(command).poses, "pose").reshape(-1, 8)

    def on_frame_change(self, callback):
        """Calls `callback` with a FrameEvent for every later change of the frames; returns a token
        for remove_listener.

        Every change of the frame tree causes an event: frames made, moved and removed, robots loaded,
        joints set. Callbacks run in the thread that executed the command, after the command succeeded,
        in the order of registration. A callback may execute commands: they take effect at once, and
        their events follow after all callbacks have got the present one. If a callback raises, the
        change stays made, the other callbacks run, and the command's caller gets the first exception.
        Changes that C++ code makes on the scene itself are reported with the next command. Commands
        executed through `session.vtk` keep their events in their own replies. Removing the scene or
        closing the session removes the callbacks. Without callbacks no events are collected.

        A callback whose commands call it again without end is stopped after 100 rounds (or 100,000
        changes): it gets no more events, and dspace.Resource names it. Up to a thousand events of
        changes by C++ code wait for the next command; further changes of poses are merged into one
        event, which lists each frame once."""
        if not callable(callback):
            reject(f"scene {self._name_!r}", "the callback", callback, "a function of one FrameEvent",
                   WrongType)
        self._do("follow_frames")
        return self._client.frame_listeners.add(self, callback)

    def remove_listener(self, token):
        """Removes a callback of on_frame_change. Returns False if there is none of that token."""
        if not isinstance(token, int):
            reject(f"scene {self._name_!r}", "the token", token, "what on_frame_change returned",
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

    log_event = delegate(SceneMessages, "log_event")
    events = delegate(SceneMessages, "events")
    ask = delegate(SceneMessages, "ask")
    questions = delegate(SceneMessages, "questions")

    # --- Sky -----------------------------------------------------------------------------------

    @property
    def kernels(self):
        """Its SPICE kernels: see dspace.Kernels."""
        return Kernels(self)

    @property
    def reference_frames(self):
        """Rotations between reference frames: see dspace.ReferenceFrames."""
        return ReferenceFrames(self)

    simulate_image = delegate(SceneImages, "simulate_image")
    save_image = delegate(SceneImages, "save_image")
    simulate_lines = delegate(SceneImages, "simulate_lines")
    simulate_exposure = delegate(SceneImages, "simulate_exposure")
    image_state = delegate(SceneImages, "image_state")
    image_metadata = delegate(SceneImages, "image_metadata")
    project_points = delegate(SceneImages, "project_points")
    pixel_rays = delegate(SceneImages, "pixel_rays")

    sky = delegate(SceneSky, "sky")
    ephemeris = delegate(SceneSky, "ephemeris")
    tdb = delegate(SceneSky, "tdb")
    utc = delegate(SceneSky, "utc")
    time_text = delegate(SceneSky, "time_text")
    add_celestial_frame = delegate(SceneSky, "add_celestial_frame")
    stop_motion = delegate(SceneSky, "stop_motion")

    # --- Objects -------------------------------------------------------------------------------

    load = delegate(ObjectFactory, "load")
    add_box = delegate(ObjectFactory, "add_box")
    add_sphere = delegate(ObjectFactory, "add_sphere")
    add_cylinder = delegate(ObjectFactory, "add_cylinder")
    add_cone = delegate(ObjectFactory, "add_cone")
    add_plane = delegate(ObjectFactory, "add_plane")
    add_disc = delegate(ObjectFactory, "add_disc")
    add_torus = delegate(ObjectFactory, "add_torus")
    add_arrow = delegate(ObjectFactory, "add_arrow")
    add_axes = delegate(ObjectFactory, "add_axes")
    add_lines = delegate(ObjectFactory, "add_lines")
    add_points = delegate(ObjectFactory, "add_points")
    add_frustum = delegate(ObjectFactory, "add_frustum")
    add_goal = delegate(ObjectFactory, "add_goal")
    add_tilt_marker = delegate(ObjectFactory, "add_tilt_marker")
    add_text = delegate(ObjectFactory, "add_text")
    add_label = delegate(ObjectFactory, "add_label")
    add_trail = delegate(ObjectFactory, "add_trail")
    add_body = delegate(BodyFactory, "add_body")
    add_stars = delegate(ObjectFactory, "add_stars")
    add_sky_grid = delegate(ObjectFactory, "add_sky_grid")
    add_constellations = delegate(ObjectFactory, "add_constellations")
    add_constellation_names = delegate(ObjectFactory, "add_constellation_names")
    add_trajectory = delegate(TrajectoryFactory, "add_trajectory")
    orbit = delegate(TrajectoryFactory, "orbit")
    body_path = delegate(TrajectoryFactory, "body_path")
    turning_axes = delegate(TrajectoryFactory, "turning_axes")
    attitude = delegate(TrajectoryFactory, "attitude")
    add_plume = delegate(PlumeFactory, "add_plume")
    add_sensor_cone = delegate(SensorFactory, "add_sensor_cone")
    add_footprints = delegate(SensorFactory, "add_footprints")
    add_ground_track = delegate(SensorFactory, "add_ground_track")
    add_link = delegate(SensorFactory, "add_link")
    add_mesh = delegate(ObjectFactory, "add_mesh")
    add_polydata = delegate(ObjectFactory, "add_polydata")
    add_prop = delegate(ObjectFactory, "add_prop")
    add_drawn = delegate(ObjectFactory, "add_drawn")

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

    # --- Terrain -------------------------------------------------------------------------------

    add_terrain = delegate(TerrainFactory, "add_terrain")
    terrains = delegate(TerrainFactory, "terrains")
    geodesy = delegate(TerrainFactory, "geodesy")

    # --- Measurements --------------------------------------------------------------------------

    line_of_sight = delegate(Sights, "line_of_sight")
    horizon = delegate(Sights, "horizon")
    measure_line = delegate(Lines, "measure_line")
    measure_area = delegate(Lines, "measure_area")
    measure_angle = delegate(Lines, "measure_angle")
    lit_area = delegate(Lit, "lit_area")
    projected_areas = delegate(Lit, "projected_areas")
    scan = delegate(Scans, "scan")
    add_lens_frustum = delegate(LensOrnaments, "add_lens_frustum")
    add_lens_footprint = delegate(LensOrnaments, "add_lens_footprint")
    sky_track = delegate(Visibility, "sky_track")
    contacts = delegate(Visibility, "contacts")
    sight_contacts = delegate(SightContacts, "sight_contacts")
    power_profile = delegate(Visibility, "power_profile")
    horizon_map = delegate(Maps, "horizon_map")
    viewshed = delegate(Maps, "viewshed")
    illumination_map = delegate(Maps, "illumination_map")
    illumination_ensemble = delegate(Ensembles, "illumination_ensemble")
    best_sites = delegate(BestSites, "best_sites")

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

        To change an existing light, also "sun", use scene.lights[name].set(...)."""
        command = self._command()
        put(command.set_light, "new light", name=name)
        put_light(self, command.set_light, {"kind": kind, **values})
        if name in self.lights:
            raise AlreadyExists(f"light {name!r}: there is a light of this name in scene "
                                f"{self._name_!r}; accepted: another name, or scene.lights[{name!r}]"
                                ".set(...) to change it", f"light {name!r}")
        self._execute(command)
        return Light(self, name)

    add_sky = delegate(Shine, "add_sky")
    add_planetshine = delegate(Shine, "add_planetshine")

    @property
    def lights(self):
        """All lights, by name. A new scene has "sun", which `sun` also changes."""
        return Named("light", {info.name: Light(self, info.name)
                               for info in self._ask("list_lights").lights.light})

    @property
    def sun(self):
        """The Sun of the scene: Sun.set takes a direction, or azimuth and elevation on a terrain, irradiance or
        distance, and the size of its disc."""
        return Sun(self)

    # --- Views ---------------------------------------------------------------------------------

    def add_vantage(self, name):
        self._do("create_vantage", "new vantage", name=name)
        return Vantage(self, name)

    @property
    def vantages(self):
        """All vantages, by name; "main" always exists."""
        infos = self._ask("list_vantages").vantages.vantage
        return Named("vantage", {info.name: Vantage(self, info.name) for info in infos})

    def add_camera(self, name="camera", frame=None, eye=None, target=None, up=None, pose=None,
                   chase=None, fov_deg=None, height=None, tangents=None, near=None, far=None,
                   vantage=MAIN, point_at=None):
        """A camera, or a new setting of the one of that name.

        It stands on `frame` (default: root) at `eye` looking at `target` with `up` at the picture's top (default: Z, or Y
        where it looks straight up or down), or at `pose`; or it chases
        `frame`, with chase a dict of what Camera.chase takes; or it points at a frame, with point_at a dict of what
        Camera.point_at takes (aim, eye, target, up, smoothing_s). The projection is as in
        Camera.set_projection; the default is perspective, 45 degrees. All is one command."""
        label = f"camera {shown(name)}"
        given = [word for word, value in (("eye", eye), ("pose", pose), ("chase", chase),
                                            ("point_at", point_at))
                 if value is not None]
        if len(given) > 1:
            raise InvalidArgument(f"{label}: {' and '.join(given)} are given; accepted: one of eye, pose, "
                                  "chase and point_at", label)
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
            if up is not None:
                put_vector(look.up, up, "up", label)
        elif chase is not None:
            if not isinstance(chase, dict):
                reject(label, "chase", chase, f"a dict of {', '.join(CHASE)}", WrongType)
            keywords(chase, CHASE, f"{label}, chase")
            put_chase(mount.chase, **chase, about=label, scene=self)
        elif point_at is not None:
            if not isinstance(point_at, dict) or "aim" not in point_at:
                reject(label, "point_at", point_at, f"a dict of {', '.join(POINT_AT)}, with aim", WrongType)
            keywords(point_at, POINT_AT, f"{label}, point_at")
            put_point_at(mount.pointing, self, **point_at, about=label)
        else:
            with about(label):
                put_pose(mount.pose, to_pose(pose=pose) if pose is not None else to_pose())
        self._execute(command)
        return Camera(self, vantage, name)

    def _put_things(self, message, things, about):
        """Writes objects and frames, one or several, into a message that takes both; None: neither. Robots, models and
        assemblies count as their base frames."""
        bases = (Robot, Model, Assembly)
        if isinstance(things, (Frame, GraphicsObject, *bases)):
            things = [things]
        for each in items(() if things is None else things, "what it is to show", about, "objects and frames"):
            if isinstance(each, GraphicsObject):
                message.object.append(each.id)
            elif isinstance(each, (Frame, *bases)):
                message.frame.append(self._frame_id(each if isinstance(each, Frame) else each.frame))
            else:
                reject(about, "what it is to show", each, "objects, frames, robots, models and assemblies", WrongType)
        if things is not None and not message.frame and not message.object:
            reject(about, "what it is to show", things, "one object or frame, or more")

    @property
    def cameras(self):
        """The cameras of the main vantage, by name."""
        return Vantage(self, MAIN).cameras

    def add_viewport(self, size=(1280, 720), camera=None, name=None, vantage=None, samples=None,
                     visible=True):
        """A view of this scene, `size` (width, height) pixels; camera: None for the active one."""
        label = "new viewport" if name is None else f"viewport {shown(name)}"
        command = self._command()
        message = command.create_viewport
        width, height = integers(size, 2, "the size", label, SIZE)  # before the camera: add_viewport(640, 480) is told so
        put(message, label, name="" if name is None else name,
            camera=self._name_of(camera, Camera, "camera", label),
            vantage=self._vantage_name(vantage, label))
        if isinstance(camera, Camera):
            if vantage is not None and message.vantage != camera.vantage:
                raise InvalidArgument(f"{label}: camera {camera.name!r} is of vantage "
                                      f"{camera.vantage!r}; accepted: one of {message.vantage!r}", label)
            message.vantage = camera.vantage
        put(message, label, width=width, height=height)
        put_given(message, label, samples=samples)
        message.hidden = not flag(visible, "visible", label)
        return Viewport(self._client, self._execute(command).viewport.name)

    # --- Other programs ------------------------------------------------------------------------

    export = delegate(SceneExports, "export")
    to_vtk = delegate(SceneExports, "to_vtk")
    to_actors = delegate(SceneExports, "to_actors")

    @property
    def vtk(self):
        """The vtkDspaceScene of this scene."""
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
