"""Graphics objects: what hangs on frames and is drawn."""
import os

import numpy as np

from dspace._strict import Strict
from dspace import _wire
from dspace.poses import vector

UP = {"z": 0, "y": 1, "x": 2, "-z": 3}
MATERIAL = ("color", "opacity", "metallic", "roughness", "texture", "lit", "wireframe")
SETTINGS = ("frame", "name", "ornamental", "fragment", "position", "quaternion", "stretch",
            "visible", "pickable", "line_width", "point_size") + MATERIAL


def put_material(message, values):
    """Writes the given ones of MATERIAL into a Material message."""
    for key, value in values.items():
        if key == "color":
            message.color.r, message.color.g, message.color.b = vector(value, "the colour")
        elif key == "texture":
            message.texture = os.fspath(value) if value else ""
        else:
            setattr(message, key, value)


def put_offset(message, position=None, quaternion=None, stretch=None):
    """Writes an object's place in its frame into an Offset message."""
    if position is not None:
        p = vector(position, "the position")
        message.position.x, message.position.y, message.position.z = p
    if quaternion is not None:
        q = message.rotation
        q.w, q.x, q.y, q.z = (float(v) for v in quaternion)
    if stretch is not None:
        s = vector(np.broadcast_to(stretch, 3), "the stretch")
        message.scale.x, message.scale.y, message.scale.z = s


def put_settings(scene, message, frame=None, name=None, ornamental=False, fragment=None,
                 position=None, quaternion=None, stretch=None, visible=True, pickable=True,
                 line_width=None, point_size=None, **material):
    """Writes what every object has into an ObjectSettings message."""
    unknown = set(material) - set(MATERIAL)
    if unknown:
        raise TypeError(f"unknown keyword {sorted(unknown)}; accepted: {', '.join(SETTINGS)}")
    message.frame = scene._frame_id(frame)
    message.name = name or ""
    message.nature = 1 if ornamental else 0
    message.fragment = scene._name(fragment)
    if position is not None or quaternion is not None or stretch is not None:
        put_offset(message.offset, position, quaternion, stretch)
    put_material(message.material, {k: v for k, v in material.items() if v is not None})
    message.hidden = not visible
    message.unpickable = not pickable
    if line_width is not None:
        message.line_width = line_width
    if point_size is not None:
        message.point_size = point_size


def _material_property(key, text):
    def get(self):
        material = self._info().material
        if not material.HasField(key):
            return None
        value = getattr(material, key)
        return (value.r, value.g, value.b) if key == "color" else value

    def set(self, value):
        self.set_material(**{key: value})

    return property(get, set, doc=text + " None: as the object came with it.")


class GraphicsObject(Strict):
    """Geometry on a frame. Physical: what a real camera would see; else ornamental."""

    def __init__(self, scene, id):
        self._scene = scene
        self._id = int(id)

    def _info(self):
        return self._scene._ask("describe_object", object=self._id).object_info

    @property
    def scene(self):
        return self._scene

    @property
    def id(self):
        """The number that names it in commands and in label planes."""
        return self._id

    @property
    def name(self):
        return self._info().name

    @property
    def ornamental(self):
        return self._info().nature == 1

    @property
    def frame(self):
        """The frame it hangs on; may be set."""
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
        self._scene._do("move_to_fragment", object=self._id, fragment=self._scene._name(fragment))

    @property
    def visible(self):
        return self._info().visible

    @visible.setter
    def visible(self, visible):
        self._scene._do("set_object_visible", object=self._id, visible=bool(visible))

    color = _material_property("color", "sRGB, three numbers from 0 to 1.")
    opacity = _material_property("opacity", "0 to 1.")
    metallic = _material_property("metallic", "0 to 1.")
    roughness = _material_property("roughness", "0 to 1.")
    texture = _material_property("texture", "Path of an image; '' for no texture.")
    lit = _material_property("lit", "Whether lights shade it.")
    wireframe = _material_property("wireframe", "Whether only edges are drawn.")

    def set_material(self, **values):
        """Several at once; None takes a change back."""
        unknown = set(values) - set(MATERIAL)
        if unknown:
            raise TypeError(f"unknown keyword {sorted(unknown)}; accepted: {', '.join(MATERIAL)}")
        command = self._scene._command()
        change = command.set_material
        change.object = self._id
        if any(value is None for value in values.values()):
            change.material.CopyFrom(self._info().material)
            change.replace = True
            for key, value in values.items():
                if value is None:
                    change.material.ClearField(key)
        put_material(change.material, {k: v for k, v in values.items() if v is not None})
        self._scene._execute(command)

    @property
    def offset(self):
        """X_FO, where its own axes lie in its frame, as a 4 x 4 matrix; see set_offset."""
        matrix = np.eye(4)
        matrix[:3] = np.reshape(self._info().offset, (3, 4))
        return matrix

    def set_offset(self, position=None, quaternion=None, stretch=None):
        """Places it in its frame; what is not given is as if it had never been set.

        stretch: one factor, or one an axis (negative ones mirror)."""
        command = self._scene._command()
        command.set_object_offset.object = self._id
        put_offset(command.set_object_offset.offset, position, quaternion, stretch)
        self._scene._execute(command)

    @property
    def triangles(self):
        """Of the finest level."""
        return self._info().triangles

    @property
    def bounds(self):
        """Centre (3 numbers) and radius of a sphere about it, in its own axes [m]."""
        info = self._info()
        c = info.bounds_center
        return np.array([c.x, c.y, c.z]), info.bounds_radius

    @property
    def box(self):
        """Least and greatest corner of the box along its own axes [m], an array (2, 3)."""
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
    """Letters or a label in the scene."""

    def set(self, text):
        """Other words in the same style."""
        self._scene._do("set_text", object=self._id, text=text)


class TiltMarker(GraphicsObject):
    """A ring with a needle that reddens with the tilt."""

    def set(self, tilt_deg):
        """The tilt that it shows, from upright, 0 to 180 degrees."""
        self._scene._do("set_tilt", object=self._id, tilt_deg=tilt_deg)


class Trail(GraphicsObject):
    """The path that something has come."""

    def append(self, points):
        """Points p_F in the frame that it hangs on [m]: 3 numbers or an array (n, 3)."""
        array = np.atleast_2d(np.asarray(points, dtype=float))
        if array.ndim != 2 or array.shape[1] != 3:
            raise ValueError(f"the points have shape {np.shape(points)}; accepted: (3,) or (n, 3)")
        command = self._scene._command()
        command.append_trail.object = self._id
        _wire.put_array(command.append_trail, "point", array)
        self._scene._execute(command)

    def clear(self):
        self._scene._do("clear_trail", object=self._id)
