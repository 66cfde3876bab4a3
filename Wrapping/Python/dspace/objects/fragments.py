"""Fragments, whose objects are shown or hidden together, and lights, which light all fragments."""
from dspace._core.fields import flag, keywords, put_color, put_given, put_vector, word
from dspace._core.strict import Strict
from dspace.errors import NotFound

KINDS = {"directional": 0, "point": 1, "spot": 2, "head": 3, "ambient": 4}

LIGHT = ("kind", "frame", "direction", "position", "cone_deg", "color", "intensity", "attenuation",
         "enabled", "radius_deg")


class Fragment(Strict):
    """A named group of objects, and of elements of styles and layers of terrain."""

    def __init__(self, scene, name):
        self._scene = scene
        self._name = name

    def _info(self):
        for fragment in self._scene._ask("list_fragments").fragments.fragment:
            if fragment.name == self._name:
                return fragment
        raise NotFound(f"fragment {self._name!r}: it is in scene {self._scene.name!r} no more",
                       f"fragment {self._name!r}")

    @property
    def name(self):
        return self._name

    @property
    def ornamental(self):
        return self._info().nature == 1

    @property
    def visible(self):
        """Whether all viewports draw it. Viewport.hide hides it in one viewport."""
        return self._info().visible

    @visible.setter
    def visible(self, visible):
        self._scene._do("set_fragment_visible", f"fragment {self._name!r}", name=self._name,
                        visible=visible)

    @property
    def objects(self):
        return [self._scene._object(id) for id in self._info().object]

    @property
    def members(self):
        """Elements of styles and layers of terrain in it, as texts: "contours of object 'gale'"."""
        return list(self._info().member)

    def to_actors(self, triangle_budget=200_000):
        """vtkActors of its visible objects, which follow their frames: see Scene.to_vtk. SceneActors.actors is the
        vtkActorCollection."""
        return self._scene.to_actors(self._name, triangle_budget)

    def remove(self):
        """Removes the fragment, which must be empty: without objects and members."""
        self._scene._do("remove_fragment", name=self._name)

    def __repr__(self):
        return f"<dspace.Fragment {self._name!r}>"


class Light(Strict):
    """A light of a scene. Its properties are read and set; set() changes several at once."""

    def __init__(self, scene, name):
        self._scene = scene
        self._name = name

    def _info(self):
        for light in self._scene._ask("list_lights").lights.light:
            if light.name == self._name:
                return light
        raise NotFound(f"light {self._name!r}: it is in scene {self._scene.name!r} no more",
                       f"light {self._name!r}")

    @property
    def name(self):
        return self._name

    def set(self, **values):
        """Changes any of kind, frame, direction, position, cone_deg, color, intensity, attenuation, enabled and
        radius_deg."""
        command = self._scene._command()
        command.set_light.CopyFrom(self._info())
        put_light(self._scene, command.set_light, values)
        self._scene._execute(command)

    @property
    def kind(self):
        """"directional", "point", "spot", "head" or "ambient"."""
        return list(KINDS)[self._info().kind]

    @property
    def direction(self):
        """The direction in which the light travels, in its frame."""
        v = self._info().direction
        return (v.x, v.y, v.z)

    @direction.setter
    def direction(self, direction):
        self.set(direction=direction)

    @property
    def intensity(self):
        """>= 0, multiplies the colour."""
        return self._info().intensity

    @intensity.setter
    def intensity(self, intensity):
        self.set(intensity=intensity)

    @property
    def color(self):
        """sRGB, 0 to 1."""
        c = self._info().color
        return (c.r, c.g, c.b)

    @color.setter
    def color(self, color):
        self.set(color=color)

    @property
    def radius_deg(self):
        """Of a directional light: the angular radius of its disc, 0 (a point) to 90."""
        return self._info().radius_deg

    @radius_deg.setter
    def radius_deg(self, radius_deg):
        self.set(radius_deg=radius_deg)

    @property
    def enabled(self):
        return not self._info().disabled

    @enabled.setter
    def enabled(self, enabled):
        self.set(enabled=enabled)

    def remove(self):
        self._scene._do("remove_light", name=self._name)

    def __repr__(self):
        return f"<dspace.Light {self._name!r}>"


def put_light(scene, message, values):
    """Writes the given values into a SetLight message of that name."""
    about = f"light {message.name!r}"
    keywords(values, LIGHT, about)
    values = {key: value for key, value in values.items() if value is not None}
    if "kind" in values:
        message.kind = word(values["kind"], KINDS, "kind", about)
    if "frame" in values:
        message.frame = scene._frame_id(values["frame"])
    for key in ("direction", "position", "attenuation"):
        if key in values:
            put_vector(getattr(message, key), values[key], key, about)
    if "color" in values:
        put_color(message.color, values["color"], "the colour", about)
    put_given(message, about, cone_deg=values.get("cone_deg"), intensity=values.get("intensity"),
              radius_deg=values.get("radius_deg"))
    if "enabled" in values:
        message.disabled = not flag(values["enabled"], "enabled", about)
