"""Viewports: where a vantage is drawn, captured and picked in."""
from dataclasses import dataclass

import numpy as np

from dspace._core.delegates import delegate
from dspace._core.fields import file_path, flag, integers, items, put, put_color, put_given, reject, word
from dspace._core.replies import to_reply, warn
from dspace._core.traits import SIDE
from dspace.cameras.camera import Camera
from dspace.errors import Internal, NotFound, WrongType
from dspace.objects.fragments import Fragment
from dspace.proto import commands_pb2 as pb
from dspace.proto import service_pb2
from dspace.scene.legends import ViewportLegends, put_value
from dspace.scene.lens import ViewportLens
from dspace.scene.look import ViewportLook
from dspace.scene.navigation import ViewportNavigation
from dspace.terrain.coordinates import coordinates_of

ANCHORS = {"top left": 0, "top right": 1, "bottom left": 2, "bottom right": 3}
PLANES = {"color": 0, "depth": 1, "range": 3, "label": 2, "radiance": 4, "lit_fraction": 5, "incidence": 6, "emission": 7, "phase": 8}
SIZE = f"(width, height), two integers from {SIDE[0]} to {SIDE[1]}"
EVENTS = {"move": 0, "press": 1, "release": 2, "wheel": 3, "key": 4, "double click": 5}
BUTTONS = {None: 0, "left": 1, "middle": 2, "right": 3}
TYPES = {0: np.uint8, 1: np.uint32, 2: np.float32}


def _point(message):
    return np.array([message.x, message.y, message.z])


@dataclass(frozen=True)
class Pick:
    """What lies under a pixel. Points in metres."""
    object: object  # GraphicsObject
    frame: object  # the frame that it hangs on
    depth: float  # along the camera's Z
    in_camera: np.ndarray  # in the camera's axes: X right, Y down, Z forward
    in_frame: np.ndarray  # in `frame`
    in_root: np.ndarray
    in_given: object = None  # in the frame that was asked for
    terrain: object = None  # Terrain, where one was hit
    map: object = None  # its map x, y and height
    part: str = ""  # the name of the object's part; may be empty
    coordinates: object = None  # Coordinates, on terrain with a CRS that has longitude and latitude
    fields: object = None  # on terrain: the values of its fields, a dict by name; NaN: no data


class Viewport(ViewportLook, ViewportNavigation, ViewportLens):
    """A picture of a scene. Pixel (0, 0) is the centre of the top-left pixel."""

    def __init__(self, client, name):
        self._client = client
        self._name = name

    def _do(self, kind, **fields):
        command = pb.Command()
        message = getattr(command, kind)
        message.viewport = self._name
        put(message, self._label, **fields)
        return self._client.execute(command)

    def _label(self):
        return f"viewport {self._name!r}"

    def _put_capture(self, message, physical_only, hide):
        """What captures and saved images have in common."""
        put(message, self._label, viewport=self._name, physical_only=physical_only)
        scene = self.scene
        hide = [hide] if isinstance(hide, (str, Fragment)) else hide
        message.hidden_fragment.extend(
            scene._fragment_name(each, None)
            for each in items(hide, "hide", self._label, "fragments or their names"))

    def _info(self):
        return self._do("describe_viewport").viewport_info

    @property
    def name(self):
        return self._name

    @property
    def scene(self):
        from dspace.scene.scene import Scene
        return Scene(self._client, self._info().scene)

    # --- Pictures ------------------------------------------------------------------------------

    def capture(self, color=True, depth=False, label=False, physical_only=False, hide=(), range=False,
                radiance=False, lit_fraction=False, incidence=False, emission=False, phase=False):
        """Planes of one picture as a dict of arrays, row 0 on top.

        "color": (h, w, 4) uint8, sRGB and alpha 255. "depth": (h, w) float32, metres along the
        camera's Z, +infinity where nothing was hit. "range": the same along each pixel's ray, see range().
        "label": (h, w) uint32, GraphicsObject.id, 0 where nothing was hit. "radiance": (h, w, 3), "lit_fraction",
        "incidence", "emission" and "phase": (h, w), all float32, see the methods of these names.
        physical_only: no ornamental object and no overlay. hide: fragments (or one) left out of this
        one."""
        command = pb.Command()
        message = command.capture
        self._put_capture(message, physical_only, hide)
        put(message, self._label, color=color, depth=depth, label=label, range=range, radiance=radiance,
            lit_fraction=lit_fraction, incidence=incidence, emission=emission, phase=phase)
        reply = self._client.execute(command).capture
        return {plane.name: self._plane(plane, reply) for plane in reply.plane}

    def _plane(self, plane, reply):
        shape = (reply.height, reply.width) + ((plane.channels,) if plane.channels > 1 else ())
        if plane.data:
            # Of one's own, as a local session's is: it may be written to.
            return np.frombuffer(bytearray(plane.data), TYPES[plane.type]).reshape(shape)
        from vtkmodules.util.numpy_support import vtk_to_numpy
        return vtk_to_numpy(self._client.vtk.GetPlane(plane.name)).reshape(shape)

    def image(self, alpha=False, physical_only=False, hide=()):
        """The picture, (h, w, 3) uint8, sRGB; with alpha (h, w, 4).

        The picture includes ornaments. depth() and labels() exclude them by default, because they measure what a real
        camera sees."""
        alpha = flag(alpha, "alpha", self._label)
        image = self.capture(physical_only=physical_only, hide=hide)["color"]
        return image if alpha else image[..., :3]

    def depth(self, physical_only=True, hide=()):
        """(h, w) float32: metres along the camera's Z, +infinity where nothing was hit.

        Of physical objects only, unlike image() and pick(); physical_only=False: of all that is drawn."""
        return self.capture(False, depth=True, physical_only=physical_only, hide=hide)["depth"]

    def range(self, physical_only=True, hide=()):
        """(h, w) float32: metres from the camera to what each pixel shows, along the ray through the pixel's centre,
        +infinity where nothing was hit. For an orthographic camera the rays start at its plane Z = 0, so that
        range and depth are equal.

        Of physical objects only, as depth()."""
        return self.capture(False, range=True, physical_only=physical_only, hide=hide)["range"]

    def labels(self, physical_only=True, hide=()):
        """(h, w) uint32: GraphicsObject.id, 0 where nothing was hit.

        Of physical objects only, unlike image() and pick(); physical_only=False: of all that is drawn."""
        return self.capture(False, label=True, physical_only=physical_only, hide=hide)["label"]

    def save(self, path, plane="color", physical_only=False, hide=(), quality=None):
        """Writes the picture to .png, .jpg, .tif or .exr; plane "label" to .png, .tif or .exr; and to .tif or .exr, as 32-bit
        floats: "depth" and "range" [m], "radiance" [W/m^2/sr], "lit_fraction", "incidence", "emission" and "phase" [deg]
        (Viewport.capture). quality: 1 to 100, JPEG."""
        command = pb.Command()
        message = command.save_image
        message.plane = word(plane, PLANES, "plane", self._label)
        message.path = file_path(path, "the path", self._label)
        self._put_capture(message, physical_only, hide)
        put_given(message, self._label, quality=quality)
        self._client.execute(command)

    def render(self):
        """Draws it if something changed; returns whether it did."""
        return bool(self._do("render").render.drawn)

    def pick(self, x, y, radius=0, frame=None, send=False):
        """Returns a Pick of the object at a pixel, or of the nearest object within `radius` (0 to 256) pixels, or None
        if nothing pickable is drawn there (the sky).

        Visible ornaments can be picked. frame: a frame in which the point is also given (Pick.in_given). send: also
        sends the pick to the simulation (Session.on_event)."""
        scene = self.scene
        in_frame = 0 if frame is None else scene._frame_id(frame)
        reply = self._do("pick", x=x, y=y, radius=radius, in_frame=in_frame).pick
        if not reply.object:
            return None
        if flag(send, "send", self._label):
            self._client.send_event(service_pb2.ViewerEvent(picked=service_pb2.ViewerEvent.Picked(
                scene=scene.name, viewport=self._name, pick=reply)))
        terrain = scene.terrains.get(reply.terrain) if reply.terrain else None
        return Pick(scene._object(reply.object), scene._frame_of(reply.frame), reply.depth,
                    _point(reply.in_camera), _point(reply.in_object_frame), _point(reply.in_root),
                    _point(reply.in_frame) if in_frame else None, terrain,
                    _point(reply.map) if terrain else None,
                    reply.part,
                    coordinates_of([reply.coordinates]) if reply.HasField("coordinates") else None,
                    {field.name: field.value for field in reply.field} if terrain else None)

    def explain(self):
        """Says why objects are seen in this picture, or not: an Explanation, which can be printed.

            print(view.explain())"""
        from dspace.scene.explanation import explanation_of
        return explanation_of(self, self._do("explain_viewport").explanation)

    def fit(self, things=None, margin=0.1):
        """Moves its camera, without turning it, so that objects or frames fill the picture; see Camera.fit."""
        width, height = self.size
        camera = self.camera or self.scene.vantages[self.vantage].active
        if camera is None:
            raise NotFound(f"{self._label()}: it looks through no camera; accepted: one with a camera", self._name)
        camera.fit(things, margin, width / height)

    # --- What it shows -------------------------------------------------------------------------

    @property
    def size(self):
        """(width, height) in pixels; may be set, 1 to 16384 a side.

        Times `samples` it must be what OpenGL can draw, and at most 2**28 in all."""
        info = self._info()
        return (info.width, info.height)

    @size.setter
    def size(self, size):
        width, height = integers(size, 2, "the size", self._label, SIZE)
        self._do("resize_viewport", width=width, height=height)

    @property
    def position(self):
        """(x, y) in a window or a sheet of several, pixels from the top left; may be set."""
        info = self._info()
        return (info.x, info.y)

    @position.setter
    def position(self, position):
        x, y = integers(position, 2, "the position", self._label, "(x, y), two integers, in pixels")
        self._do("move_viewport", x=x, y=y)

    @property
    def camera(self):
        """The camera that it looks through, of its scene; set to None for its vantage's active one.

        A Camera brings its vantage with it; a name means one of the present vantage."""
        info = self._info()
        return Camera(self.scene, info.vantage, info.camera) if info.camera else None

    @camera.setter
    def camera(self, camera):
        name = self.scene._name_of(camera, Camera, "camera", self._label)
        if isinstance(camera, Camera):
            self._do("set_viewport", camera=name, vantage=camera.vantage)
        else:
            self._do("set_viewport", camera=name)

    @property
    def vantage(self):
        """The name of its vantage; may be set."""
        return self._info().vantage

    @vantage.setter
    def vantage(self, vantage):
        if vantage is None:
            reject(self._label, "the vantage", None, "a dspace.Vantage or its name", WrongType)
        self._do("set_viewport", vantage=self.scene._vantage_name(vantage, self._label))

    @property
    def visible(self):
        """A hidden viewport costs nothing."""
        return self._info().visible

    @visible.setter
    def visible(self, visible):
        self._do("set_viewport", visible=visible)

    @property
    def samples(self):
        """The number of samples, n x n for each pixel, 1 to 8; see `size` for the limit."""
        return self._info().samples

    @samples.setter
    def samples(self, samples):
        self._do("set_viewport", samples=samples)

    @property
    def ornaments(self):
        """Whether ornamental objects, ornamental elements of terrain, and corner axes are drawn. Text tables and color
        bars stay, but for legends of what is hidden; a capture with physical_only leaves all of them out."""
        return self._info().ornaments

    @ornaments.setter
    def ornaments(self, ornaments):
        self._do("set_viewport", ornaments=ornaments)

    @property
    def corner_axes(self):
        """Whether the axes of the root are drawn in the corner."""
        return self._info().corner_axes

    @corner_axes.setter
    def corner_axes(self, corner_axes):
        self._do("set_viewport", corner_axes=corner_axes)

    def set_background(self, color, top=None):
        """sRGB, 0 to 1, '#rrggbb' or a CSS name; with `top` a vertical gradient."""
        command = pb.Command()
        message = command.set_viewport
        message.viewport = self._name
        put_color(message.background, color, "the colour", self._label)
        if top is not None:
            put_color(message.background_top, top, "the colour on top", self._label)
        self._client.execute(command)

    def hide(self, fragment):
        """Hides a fragment in this viewport only."""
        self._do("set_viewport_fragment", visible=False,
                 fragment=self.scene._fragment_name(fragment, None))

    @property
    def hidden_fragments(self):
        """The names of the fragments that are hidden in this viewport only; see hide() and show()."""
        return list(self._info().hidden_fragment)

    def set_table(self, name, rows, title="", anchor="top left", font_size=None, margin=None,
                  color=None, background=None, background_opacity=None):
        """Labels and values over the picture: rows is a dict or pairs of anything with a str.

        A value that is a dspace.Channel, or a pair of one and the digits after its decimal point, shows what
        the channel has whenever the picture is drawn, with its unit; where it has no value, "–".
        A number beyond a warning limit of its channel is amber, beyond an alarm limit red.
        Creates the table or replaces the one of that name. font_size and margin in pixels. Letters
        as for add_text, of DejaVu Sans Mono; no line breaks or tabs."""
        table = f"text table {name!r}"
        command = pb.Command()
        message = command.set_text_table
        put(message, table, viewport=self._name, name=name, title=title)
        message.anchor = word(anchor, ANCHORS, "anchor", table)
        rows = rows.items() if hasattr(rows, "items") else rows
        for row in items(rows, "rows", table, "a dict or pairs of a label and a value"):
            if not isinstance(row, (tuple, list)) or len(row) != 2:
                reject(table, "a row", row, "a label and a value", WrongType)
            put_value(message.row.add(label=str(row[0])), row[1], self, table)
        put_given(message, table, font_size=font_size, margin=margin,
                  background_opacity=background_opacity)
        for field, value in (("color", color), ("background", background)):
            if value is not None:
                put_color(getattr(message, field), value, field, table)
        self._client.execute(command)

    def remove_table(self, name):
        self._do("remove_text_table", name=name)

    set_color_bar = delegate(ViewportLegends, "set_color_bar")
    remove_color_bar = delegate(ViewportLegends, "remove_color_bar")
    legend_of = delegate(ViewportLegends, "legend_of")

    def event(self, type, x=0.0, y=0.0, button=None, wheel=0.0, key="", shift=False, control=False,
              alt=False, seconds=None):
        """What a person does: type "move", "press", "release", "wheel", "key" or "double click"; pixels. seconds: how
        long the key has been held since its last event, 0 to 1; default: 0.1.

        Drags, the wheel and keys move the camera; a left click picks and returns a Pick's numbers. Other keys and
        all clicks reach the callbacks of on_key and on_click. See ViewportEvent in viewports.proto."""
        command = pb.Command()
        message = command.viewport_event
        put(message, self._label, viewport=self._name, type=word(type, EVENTS, "type", self._label), x=x, y=y,
            button=word(button, BUTTONS, "button", self._label), wheel=wheel, key=key, shift=shift, control=control,
            alt=alt)
        put_given(message, self._label, seconds=seconds)
        reply = self._client.execute(command)
        self._client.inputs.tell(self, message, reply)
        return reply.pick if reply.HasField("pick") else None

    def on_key(self, callback):
        """Registers `callback`, which event() calls with a dspace.Input for each key that the camera does not use:
        all but the arrows, "+", "-", "f" and "r". It stays until the viewport is removed.

        A watcher's own views also send the key to the simulation, which gets it by Session.on_event(kind="input")."""
        self._client.inputs.add(self._name, "key", callback)

    def on_click(self, callback):
        """The same for each click without a drag, of any button, with what it hit (Input.pick)."""
        self._client.inputs.add(self._name, "click", callback)

    def show(self, fragment=None, *, title=None, size=None):
        """With a fragment: shows it in this viewport again, which reverses hide(). Without one: opens a window with this
        viewport, or raises the one that shows it.

            view.show()
            dspace.run()

        title: of the window; default: the viewport's name. size: of the picture on the screen, (width, height);
        default: the viewport's, which from now on follows the window. Mouse and keyboard move the camera as event()
        does, and reach the callbacks of on_key and on_click. Nothing happens in the window until dspace.run() or, in a
        loop of one's own, dspace.process_events(). Raises dspace.Unsupported in a build without Qt, dspace.Resource
        without a display."""
        if fragment is not None:
            if title is not None or size is not None:
                reject(self._label(), "a fragment with title or size", fragment, "either of them", WrongType)
            self._do("set_viewport_fragment", visible=True, fragment=self.scene._fragment_name(fragment, None))
            return
        self._client.windows.show(self, title, size)

    def close(self):
        """Closes the window that show() opened. The viewport stays."""
        self._client.windows.close(self._name)

    @property
    def shown(self):
        """Whether a window that show() opened is on the screen."""
        return self._client.windows.shows(self._name)

    def remove(self):
        self._do("remove_viewport")

    # --- VTK -----------------------------------------------------------------------------------

    @property
    def vtk(self):
        """The vtkDspaceViewport behind it."""
        return self._client.local().GetViewport(self._name)

    def run(self, function):
        """Makes it the render window's current viewport and calls function(window, renderer)."""
        result = []

        def call(*_):
            try:
                window = self._client.vtk.GetRenderContext().GetRenderWindow()
                result.append((function(window, self.vtk.GetRenderer()), None))
            except BaseException as error:  # VTK would only print the exception
                result.append((None, error))

        session = self._client.local()
        tag = session.AddObserver("UserEvent", call)
        try:
            message = session.RunInViewport(self._name)
        finally:
            session.RemoveObserver(tag)
        for warning in to_reply(session.TakeWarnings()).warning:
            warn(warning)
        if result and result[0][1] is not None:
            raise result[0][1]
        if message:
            raise Internal(message, self._name)
        return result[0][0]

    def __eq__(self, other):
        return (isinstance(other, Viewport)
                and (self._client, self._name) == (other._client, other._name))

    def __hash__(self):
        return hash((id(self._client), self._name))

    def __repr__(self):
        try:
            info = self._info()
            return (f"<dspace.Viewport {self._name!r}, {info.width} x {info.height}, of scene "
                    f"{info.scene!r}>")
        except Exception:  # a repr never raises
            return f"<dspace.Viewport {self._name!r}, removed>"
