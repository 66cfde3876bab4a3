"""Graphics objects: drawn geometry on frames."""
import numpy as np

from dspace._core import wire
from dspace._core.fields import array_of, file_path, flag, keywords, numbers, put, put_color, put_given, put_vector
from dspace._core.strict import Strict
from dspace.errors import Error, InvalidArgument

UP = {"z": 0, "y": 1, "x": 2, "-z": 3}
MATERIAL = ("color", "opacity", "metallic", "roughness", "texture", "lit", "wireframe")
SETTINGS = ("frame", "name", "ornamental", "fragment", "position", "quaternion", "stretch",
            "visible", "pickable", "line_width", "point_size") + MATERIAL


def put_material(message, values, about=None):
    """Writes the given ones of MATERIAL into a Material message."""
    for key, value in values.items():
        if key == "color":
            put_color(message.color, value, "the colour", about)
        elif key == "texture":
            none = isinstance(value, str) and value == ""
            message.texture = "" if none else file_path(value, "texture", about)
        else:
            put(message, about, **{key: value})


def put_rotation(message, quaternion, what="the quaternion", about=None):
    """Writes four numbers into a Quaternion."""
    q = numbers(quaternion, 4, what, about, "4 numbers w, x, y, z")
    message.w, message.x, message.y, message.z = q


def put_offset(message, position=None, quaternion=None, stretch=None, about=None):
    """Writes an object's place in its frame into an Offset message."""
    if position is not None:
        put_vector(message.position, position, "the position", about)
    if quaternion is not None:
        put_rotation(message.rotation, quaternion, about=about)
    if stretch is not None:
        accepted = "a number, or 3 numbers"
        s = array_of(stretch, "the stretch", accepted, about)
        put_vector(message.scale, np.broadcast_to(s, 3) if s.ndim == 0 else s, "the stretch", about)


def put_settings(scene, message, about=None, frame=None, name=None, ornamental=False, fragment=None,
                 position=None, quaternion=None, stretch=None, visible=True, pickable=True,
                 line_width=None, point_size=None, **material):
    """Writes the settings that every object has into an ObjectSettings message. about: the kind of the new object."""
    if isinstance(name, str) and name:
        about = f"{about or 'object'} {name!r}"
    if set(material) - set(MATERIAL):
        keywords(material, SETTINGS, about)
    put(message, about, frame=scene._frame_id(frame), name="" if name is None else name,
        fragment=scene._fragment_name(fragment))
    message.nature = 1 if flag(ornamental, "ornamental", about) else 0
    if position is not None or quaternion is not None or stretch is not None:
        put_offset(message.offset, position, quaternion, stretch, about)
    put_material(message.material, {k: v for k, v in material.items() if v is not None}, about)
    message.hidden = not flag(visible, "visible", about)
    message.unpickable = not flag(pickable, "pickable", about)
    put_given(message, about, line_width=line_width, point_size=point_size)
    return about


def _material_property(key, text):
    def get(self):
        material = self._info().material
        if not material.HasField(key):
            return None
        value = getattr(material, key)
        return (value.r, value.g, value.b) if key == "color" else value

    def set(self, value):
        self.set_material(**{key: value})

    return property(get, set, doc=text + " None: the value of the object's own material.")


class GraphicsObject(Strict):
    """Geometry on a frame. Physical objects are those that a real camera would see; the others are ornamental."""

    def __init__(self, scene, id):
        self._scene = scene
        self._id = int(id)

    def _info(self):
        return self._scene._ask("describe_object", object=self._id).object_info

    def _label(self):
        try:
            return f"object {self.name!r}"
        except Error:
            return f"object {self._id}"

    @property
    def scene(self):
        return self._scene

    @property
    def id(self):
        """The number that identifies it in commands and in label planes."""
        return self._id

    @property
    def name(self):
        return self._info().name

    @property
    def ornamental(self):
        return self._info().nature == 1

    @property
    def frame(self):
        """The frame to which it is attached; may be set."""
        return self._scene._frame_of(self._info().frame)

    @frame.setter
    def frame(self, frame):
        self._scene._do("attach_object", object=self._id, frame=self._scene._frame_id(frame))

    @property
    def fragment(self):
        """The name of its fragment; may be set to another one of the same nature."""
        return self._info().fragment

    @fragment.setter
    def fragment(self, fragment):
        self._scene._do("move_to_fragment", object=self._id,
                        fragment=self._scene._fragment_name(fragment))

    @property
    def visible(self):
        return self._info().visible

    @visible.setter
    def visible(self, visible):
        self._scene._do("set_object_visible", self._label, object=self._id, visible=visible)

    color = _material_property("color", "sRGB, three numbers from 0 to 1; set also to '#rrggbb' or a CSS name.")
    opacity = _material_property("opacity", "0 to 1.")
    metallic = _material_property("metallic", "0 to 1.")
    roughness = _material_property("roughness", "0 to 1.")
    texture = _material_property("texture", "Path of an image; '' for no texture.")
    lit = _material_property("lit", "Whether lights shade it.")
    wireframe = _material_property("wireframe", "Whether only edges are drawn.")

    def set_material(self, **values):
        """Changes several material properties at once; None restores a property."""
        keywords(values, MATERIAL, self._label)
        command = self._scene._command()
        change = command.set_material
        change.object = self._id
        if any(value is None for value in values.values()):
            change.material.CopyFrom(self._info().material)
            change.replace = True
            for key, value in values.items():
                if value is None:
                    change.material.ClearField(key)
        put_material(change.material, {k: v for k, v in values.items() if v is not None}, self._label)
        self._scene._execute(command)

    @property
    def offset(self):
        """X_FO, the pose of the object's own axes in its frame, as a 4 x 4 matrix; see set_offset."""
        matrix = np.eye(4)
        matrix[:3] = np.reshape(self._info().offset, (3, 4))
        return matrix

    def set_offset(self, position=None, quaternion=None, stretch=None):
        """Places it in its frame. Values that are not given return to their defaults.

        stretch: one factor, or one for each axis (negative factors mirror)."""
        command = self._scene._command()
        command.set_object_offset.object = self._id
        put_offset(command.set_object_offset.offset, position, quaternion, stretch, self._label)
        self._scene._execute(command)

    @property
    def triangles(self):
        """Of the finest level."""
        return self._info().triangles

    @property
    def bounds(self):
        """The center (3 numbers) and radius of a bounding sphere, in its own axes [m]."""
        info = self._info()
        c = info.bounds_center
        return np.array([c.x, c.y, c.z]), info.bounds_radius

    @property
    def box(self):
        """The least and greatest corner of its bounding box along its own axes [m], an array (2, 3)."""
        info = self._info()
        return np.array([[c.x, c.y, c.z] for c in (info.box_minimum, info.box_maximum)])

    def remove(self):
        self._scene._do("remove_object", object=self._id)

    def __eq__(self, other):
        return (isinstance(other, GraphicsObject)
                and (self._scene, self._id) == (other._scene, other._id))

    def __hash__(self):
        return hash((self._scene, self._id))

    def __repr__(self):
        kind = type(self).__name__
        try:
            info = self._info()
            nature = "ornamental" if info.nature else "physical"
            return f"<dspace.{kind} {info.name!r}, {nature}, {info.triangles} triangles>"
        except Exception:  # a repr never raises
            return f"<dspace.{kind} id {self._id}, not in the scene any more>"


class Primitive(GraphicsObject):
    """An object made at run time."""


class Text(GraphicsObject):
    """Text or a label in the scene."""

    def set(self, text):
        """Changes the text and keeps its style."""
        self._scene._do("set_text", self._label, object=self._id, text=text)


class TiltMarker(GraphicsObject):
    """A ring with a needle that reddens with the tilt."""

    def set(self, tilt_deg):
        """The tilt that it shows, from upright, 0 to 180 degrees."""
        self._scene._do("set_tilt", self._label, object=self._id, tilt_deg=tilt_deg)


class Trail(GraphicsObject):
    """The path that something has traveled."""

    def append(self, points):
        """Appends points p_F in its frame [m]: 3 numbers or an array (n, 3).

        Points do not depend on the scene's time; clear() removes them."""
        array = np.atleast_2d(array_of(points, "the points", "(3,) or (n, 3)", self._label))
        if array.ndim != 2 or array.shape[1] != 3:
            raise InvalidArgument(f"{self._label()}: the points have shape {np.shape(points)}; "
                                  "accepted: (3,) or (n, 3)")
        command = self._scene._command()
        command.append_trail.object = self._id
        wire.put_array(command.append_trail, "point", array)
        self._scene._execute(command)

    def clear(self):
        self._scene._do("clear_trail", object=self._id)
