"""Cameras: their mounts, chases and projections."""
from dspace._core.fields import about, number, numbers, put, put_given, put_vector, reject, word
from dspace._core.strict import Strict
from dspace.errors import WrongType
from dspace.frames.frame import Frame, put_pose
from dspace.frames.poses import Pose, to_pose

AXES = {"heading": 0, "followed": 1, "parent": 2}
CHASE = ("offset", "target", "axes", "up", "smoothing_s", "vertical")
POINT_AT = ("aim", "eye", "target", "up", "smoothing_s")


class Camera(Strict):
    """A camera of a vantage. Its axes C are X right, Y down, Z forward."""

    def __init__(self, scene, vantage, name):
        self._scene = scene
        self._vantage = vantage
        self._name = name

    def _info(self):
        return self._scene._ask("describe_camera", vantage=self._vantage, name=self._name).camera

    def _label(self):
        return f"camera {self._name!r}"

    def _command(self):
        command = self._scene._command()
        command.set_camera.vantage = self._vantage
        command.set_camera.name = self._name
        return command

    @property
    def name(self):
        return self._name

    @property
    def vantage(self):
        """The name of its vantage."""
        return self._vantage

    # --- Where it stands -----------------------------------------------------------------------

    def look_at(self, eye, target, up=None, frame=None):
        """Places the camera at `eye`, looking at `target`, both in `frame` (default: root) [m].

        up: the direction of the picture's top; None: Z, or Y where the camera looks straight up or down."""
        command = self._command()
        mount = command.set_camera.mount
        mount.frame = self._scene._frame_id(frame)
        put_vector(mount.look_at.eye, eye, "the eye", self._label)
        put_vector(mount.look_at.target, target, "the target", self._label)
        if up is not None:
            put_vector(mount.look_at.up, up, "up", self._label)
        self._scene._execute(command)

    def attach(self, frame, pose=None, position=None, quaternion=None):
        """Stands on `frame` at X_FC, by default at its origin, Z forward and Y down."""
        command = self._command()
        command.set_camera.mount.frame = self._scene._frame_id(frame)
        with about(self._label):
            put_pose(command.set_camera.mount.pose, to_pose(position, quaternion, None, pose))
        self._scene._execute(command)

    def chase(self, frame, offset=(-5, 0, 2), target=(0, 0, 0), axes="heading", up=None,
              smoothing_s=0.0, vertical=None):
        """Follows `frame` from `offset` and looks at `target` [m].

        Both are in axes that turn with the frame's "heading" only, with the "followed" frame, or
        not at all ("parent"). up: the direction of the picture's top, in the parent's axes (default: Z, or Y where
        offset and target are above each other). vertical: what is upright in place of the parent's Z and of `up`: a
        Terrain (its vertical where `frame` is), or the Frame of a body (away from its origin, the centre). smoothing_s:
        time constant of the lag, in simulation time; when that goes back (a playback that jumps), the camera is in place
        at once."""
        command = self._command()
        command.set_camera.mount.frame = self._scene._frame_id(frame)
        put_chase(command.set_camera.mount.chase, offset, target, axes, up, smoothing_s, self._label, vertical, self._scene)
        self._scene._execute(command)

    def point_at(self, aim, frame=None, eye=(0, 0, 0), target=(0, 0, 0), up=(0, 0, 1), smoothing_s=0.0):
        """Stands at `eye` on `frame` (default: root) and keeps pointing at `target` on the frame `aim` [m].

        up: the direction of the picture's top, in `frame`. smoothing_s: time constant of the lag of the direction in
        `frame`, in simulation time; when that goes back, the camera points at its target at once."""
        command = self._command()
        command.set_camera.mount.frame = self._scene._frame_id(frame)
        put_point_at(command.set_camera.mount.pointing, self._scene, aim, eye, target, up, smoothing_s, self._label)
        self._scene._execute(command)

    def fit(self, things=None, margin=0.1, aspect=16 / 9):
        """Moves the camera, without turning it, so that `things` are whole in its picture and fill it.

        things: a GraphicsObject, Frame, Robot, Model or Assembly, or several; a frame means the visible objects on it
        and below. None: all visible objects. margin: free space on each side, as a fraction of their size, 0 to 10.
        aspect: width / height of the picture. An orthographic camera gets another height. A camera that chased or
        pointed stands still after this, in the frame that it was in."""
        command = self._scene._command()
        message = command.fit_camera
        put(message, self._label, vantage=self._vantage, name=self._name, margin=margin, aspect=aspect)
        self._scene._put_things(message, things, self._label)
        found = self._scene._execute(command).camera
        command = self._command()
        command.set_camera.projection.CopyFrom(found.projection)
        command.set_camera.mount.CopyFrom(found.mount)
        self._scene._execute(command)

    @property
    def frame(self):
        """The frame that it stands on or follows."""
        return self._scene._frame_of(self._info().mount.frame)

    @property
    def pose(self):
        """X_FC on its frame, which may be set; None for a camera that chases or points (see pose_in())."""
        mount = self._info().mount
        if not mount.HasField("pose"):
            return None
        p, q = mount.pose.position, mount.pose.rotation
        return Pose._computed((p.x, p.y, p.z), (q.w, q.x, q.y, q.z), 1.0)

    @pose.setter
    def pose(self, pose):
        self.attach(self.frame, pose)

    def pose_in(self, frame=None):
        """X_GC now, in `frame` G (default: the root), also of a camera that chases or points: with the lag that it has at
        the scene's time. Its scale is 1."""
        reply = self._scene._ask("get_camera_pose", vantage=self._vantage, name=self._name,
                                 relative_to=self._scene._frame_id(frame))
        p, q = reply.camera_pose.pose.position, reply.camera_pose.pose.rotation
        return Pose._computed((p.x, p.y, p.z), (q.w, q.x, q.y, q.z), 1.0)

    def capture(self, model=None, size=None, **planes):
        """The image that it takes through a lens: Scene.simulate_image with this camera.

            image = camera.capture(dspace.CameraModel.read("lens.json"), range=True)"""
        return self._scene.simulate_image(model, camera=self, size=size, **planes)

    # --- What it sees --------------------------------------------------------------------------

    def set_projection(self, fov_deg=None, height=None, tangents=None, near=None, far=None):
        """One of: fov_deg, the vertical full angle (perspective); height, metres from top to bottom
        (orthographic); tangents X / Z and Y / Z of the edges (left, right, top, bottom), left and
        top negative about the axis since Y is down (off-axis frustum).
        near and far: metres along Z. None: automatic, they follow what is drawn, so that nothing in view is cut.
        For perspective and off-axis cameras, whose depth is resolved to a ten-millionth of itself at any distance,
        that is 0.05, or less where an object begins nearer, and infinity. For orthographic ones it is the
        extent of what is drawn from Z = 0 on; depth is resolved to a ten-millionth of far - near, so set them for a
        finer one. near may be negative for orthographic cameras, which then see what is behind them."""
        command = self._command()
        put_projection(command.set_camera.projection, fov_deg, height, tangents, near, far, self._label)
        self._scene._execute(command)

    @property
    def projection(self):
        """A dict of what set_projection takes; near and far are None where they are automatic."""
        p = self._info().projection
        out = {name: getattr(p, name) if p.HasField(name) else None for name in ("near", "far")}
        kind = p.WhichOneof("kind")
        if kind == "orthographic":
            out["height"] = p.orthographic.height
        elif kind == "frustum":
            out["tangents"] = (p.frustum.left, p.frustum.right, p.frustum.top, p.frustum.bottom)
        else:
            out["fov_deg"] = p.perspective.vertical_fov_deg
        return out

    def _change_projection(self, **change):
        self.set_projection(**{**self.projection, **change})

    @property
    def fov_deg(self):
        """Vertical full angle [degrees]; None when it is not perspective. Setting it makes it so."""
        return self.projection.get("fov_deg")

    @fov_deg.setter
    def fov_deg(self, fov_deg):
        self._change_projection(fov_deg=fov_deg, height=None, tangents=None)

    @property
    def near(self):
        """Metres along Z; None: automatic (see set_projection)."""
        return self.projection["near"]

    @near.setter
    def near(self, near):
        self._change_projection(near=near)

    @property
    def far(self):
        """Metres along Z; may be infinite. None: automatic (see set_projection)."""
        return self.projection["far"]

    @far.setter
    def far(self, far):
        self._change_projection(far=far)

    def activate(self):
        """Makes it the active camera of its vantage."""
        self._scene._do("set_active_camera", vantage=self._vantage, name=self._name)

    @property
    def active(self):
        return self._info().active

    def remove(self):
        self._scene._do("remove_camera", vantage=self._vantage, name=self._name)

    def __eq__(self, other):
        return (isinstance(other, Camera) and (self._scene, self._vantage, self._name)
                == (other._scene, other._vantage, other._name))

    def __hash__(self):
        return hash((self._scene, self._vantage, self._name))

    def __repr__(self):
        try:
            p = self.projection
            kind = (f"{p['fov_deg']:g} deg" if "fov_deg" in p else
                    f"orthographic, {p['height']:g} m" if "height" in p else "frustum")
            return f"<dspace.Camera {self._name!r}, {kind}, on {self.frame.path!r}>"
        except Exception:  # a repr never raises
            return f"<dspace.Camera {self._name!r}, not in the scene any more>"


def put_chase(message, offset=(-5, 0, 2), target=(0, 0, 0), axes="heading", up=None,
              smoothing_s=0.0, about=None, vertical=None, scene=None):
    """Writes what Camera.chase takes into a Chase message."""
    message.axes = word(axes, AXES, "axes", about)
    put_vector(message.offset, offset, "the offset", about)
    put_vector(message.target, target, "the target", about)
    if up is not None:
        put_vector(message.up, up, "up", about)
    put(message, about, smoothing_s=smoothing_s)
    if vertical is not None:
        if up is not None:
            reject(about, "up", up, "None where a vertical is given")
        frame = vertical if isinstance(vertical, (Frame, str)) else getattr(vertical, "frame", None)
        if not isinstance(frame, (Frame, str)):
            reject(about, "vertical", vertical, "a Terrain, or the Frame of a body", WrongType)
        message.vertical.frame = scene._frame_id(frame)
        message.vertical.axis = getattr(vertical, "on_body", True) is False


def put_point_at(message, scene, aim, eye=(0, 0, 0), target=(0, 0, 0), up=(0, 0, 1), smoothing_s=0.0, about=None):
    """Writes what Camera.point_at takes, without the frame, into a Pointing message."""
    message.aim = scene._frame_id(aim)
    put_vector(message.eye, eye, "the eye", about)
    put_vector(message.target, target, "the target", about)
    put_vector(message.up, up, "up", about)
    put(message, about, smoothing_s=smoothing_s)


def put_projection(message, fov_deg=None, height=None, tangents=None, near=None, far=None, about=None):
    """Writes what Camera.set_projection takes into a Projection message."""
    given = {name: value for name, value in
             (("fov_deg", fov_deg), ("height", height), ("tangents", tangents)) if value is not None}
    if len(given) > 1:
        reject(about, "the projection", given, "one of fov_deg, height and tangents")
    if height is not None:
        put(message.orthographic, about, height=height)
    elif tangents is not None:
        f = message.frustum
        f.left, f.right, f.top, f.bottom = numbers(tangents, 4, "tangents", about,
                                                   "left, right, top, bottom")
    else:
        message.perspective.vertical_fov_deg = (45.0 if fov_deg is None
                                                else number(fov_deg, "fov_deg", about))
    put_given(message, about, near=near, far=far)
