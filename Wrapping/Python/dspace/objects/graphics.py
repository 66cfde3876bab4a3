"""Graphics objects: drawn geometry on frames."""
import numpy as np

from dspace._core import wire
from dspace._core.fields import (array_of, file_path, flag, keywords, numbers, put, put_color, put_given, put_vector,
                                 reject)
from dspace._core.reflectance import put_reflectance, reflectance_of
from dspace._core.strict import Strict
from dspace.errors import Error, InvalidArgument
from dspace.objects.shaders import put_shader, put_uniform, read_shader

UP = {"z": 0, "y": 1, "x": 2, "-z": 3}
MATERIAL = ("color", "opacity", "metallic", "roughness", "texture", "lit", "wireframe", "emissive", "reflectance")
SETTINGS = ("frame", "name", "ornamental", "fragment", "position", "quaternion", "stretch",
            "visible", "pickable", "line_width", "point_size") + MATERIAL


def put_material(message, values, about=None):
    """Writes the given ones of MATERIAL into a Material message."""
    for key, value in values.items():
        if key in ("color", "emissive"):
            put_color(getattr(message, key), value, "the colour" if key == "color" else key, about)
        elif key == "texture":
            none = isinstance(value, str) and value == ""
            message.texture = "" if none else file_path(value, "texture", about)
        elif key == "reflectance":
            put_reflectance(message.reflectance, value, about)
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


def material_of(message):
    """The properties that a Material message has, as a dict."""
    found = {}
    for key in MATERIAL:
        if message.HasField(key):
            value = getattr(message, key)
            if key in ("color", "emissive"):
                value = (value.r, value.g, value.b)
            found[key] = reflectance_of(value) if key == "reflectance" else value
    return found


def _material_property(key, text):
    def get(self):
        return material_of(self._info().material).get(key)

    def set(self, value):
        self.set_material(**{key: value})

    return property(get, set, doc=text + " None: the value of the object's own material.")


class GraphicsObject(Strict):
    """Geometry on a frame. Physical objects are those that a real camera would see; the others are ornamental."""
    _instead = dict.fromkeys(("pose", "position", "quaternion"), "objects move with their frame: make it on one of its own, "
                             "frame=scene.add_frame(name), and move that")

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
    emissive = _material_property("emissive", "sRGB light that the surface adds to what it reflects, as color.")
    reflectance = _material_property("reflectance", """How it reflects light: a model's name, or a dict with "model" and its
        parameters. Reads as a dict; None: metallic-roughness.

        "metallic-roughness" (glTF 2.0), "lambert", "lommel-seeliger"; "lunar-lambert" (McEwen 1991) with lunar_weight,
        0 to 1 (default: that of the Moon by the phase angle, McEwen 1996); "hapke" (Hapke 1993, 2012) with
        single_scattering_albedo w (0 to 1, default 0.3), phase_asymmetry b (0 to 0.99, default 0.24) and
        phase_partition c (-1 to 1, default 0.3; 1: all backwards) of two Henyey-Greenstein lobes, opposition_amplitude
        B0 (0 to 100, default 1.8), opposition_width h (1e-6 to 100, default 0.07) and roughness_deg, the mean slope
        theta bar (0 to 60, default 23.4). The colour is the normal albedo; with "hapke" it multiplies the model.
        Documentation/Conventions.md states the formulas' normalisation.""")

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
    def shader(self):
        """Code in its surface shader; None: none. May be set.

        A dict: "vertex" and "fragment" have replacements at the tags of VTK's shaders, either a dict of code by tag
        ("//VTK::Color::Impl", "//VTK::Normal::Impl", "//VTK::PositionVC::Impl", ...) or a list of dicts with tag, code,
        after (default False: before the shader's own code goes in) and first_only (default False). "uniforms" has
        values by name: an int, a float, 2 to 4 numbers, a 3 x 3 or 4 x 4 matrix, or an array of one of them.
        Documentation/VTK.md lists the tags and the variables. Code that the driver rejects raises
        dspace.InvalidArgument with the driver's messages, and the object keeps its earlier code."""
        info = self._info()
        return read_shader(info.shader) if info.HasField("shader") else None

    @shader.setter
    def shader(self, shader):
        self.set_shader(shader)

    def set_shader(self, shader):
        """Sets the code of a vtkShaderProperty (a copy of its replacements and uniforms, in the session's process), or
        what the property `shader` accepts. None removes it."""
        command = self._scene._command()
        command.set_shader.object = self._id
        put_shader(command.set_shader, shader, self._label, self._scene._client.local)
        self._scene._execute(command)

    def set_uniform(self, name, value):
        """Sets one uniform of its shader, and adds it if there is none of this name."""
        command = self._scene._command()
        info = self._info()
        command.set_shader.CopyFrom(info.shader)
        command.set_shader.object = self._id
        for index, each in enumerate(info.shader.uniform):
            if each.name == name:
                del command.set_shader.uniform[index]
                break
        put_uniform(command.set_shader.uniform.add(), name, value, self._label)
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

    @property
    def parts(self):
        """The names of its parts, as in its file or in Scene.add_mesh, each once."""
        return list(self._info().part)

    def part(self, name):
        """The Part of that name: `rover.part("solar_left").set(color="blue")`. Several parts may share one name."""
        from dspace.objects.parts import part_of
        return part_of(self, name)

    def to_polydata(self, triangles=None):
        """Returns its finest level as a vtkPolyData in its own axes [m]: points in double precision, normals, texture
        coordinates, colors as the point scalars "Colors", and, if parts have names, their names as the cell array
        "Part". Triangles that had no normals when it was made have computed ones.

        Of a terrain: its ground, in the terrain's frame, in at most `triangles` triangles (200000). Those of a clipmap
        are between the posts of the finest level that is within it, which are those of queries where that is level 0;
        the coarsest level may exceed it. Holes stay. Waits for the data. Other objects ignore `triangles`."""
        from dspace.objects.polydata import polydata_of
        command = self._scene._command()
        command.get_mesh.object = self._id
        put_given(command.get_mesh, self._label, triangle_budget=triangles)
        if triangles is not None and command.get_mesh.triangle_budget == 0:
            reject(self._label, "triangles", triangles, "an integer from 1 on")
        return polydata_of(self._scene._execute(command).mesh.mesh)

    @property
    def drawer(self):
        """What draws it, for an object of Scene.add_prop ("vtk:CLASS") or Scene.add_drawn; "" for others."""
        return self._info().drawer

    @property
    def left_out(self):
        """Whether nothing of it is drawn, because this process lacks its drawer: in a playback or a viewer."""
        return self._info().left_out

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


class Stars(GraphicsObject):
    """Stars behind everything else (Scene.add_stars)."""

    def set(self, **look):
        """Sets gain, spread and faintest as in Scene.add_stars; those that are not given stay."""
        keywords(look, ("gain", "spread", "faintest"), self._label)
        command = self._scene._command()
        command.set_stars.object = self._id
        put(command.set_stars.look, self._label, **look)
        self._scene._execute(command)

    @property
    def gain(self):
        """The factor on their light in pictures for the eye; may be set."""
        return self._info().stars.gain

    @gain.setter
    def gain(self, value):
        self.set(gain=value)

    @property
    def spread(self):
        """The standard deviation of the Gaussian of each [pixels]; may be set."""
        return self._info().stars.spread

    @spread.setter
    def spread(self, value):
        self.set(spread=value)

    @property
    def faintest(self):
        """The V magnitude of the faintest that is drawn; may be set."""
        return self._info().stars.faintest

    @faintest.setter
    def faintest(self, value):
        self.set(faintest=value)


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
