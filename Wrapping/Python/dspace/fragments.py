"""Fragments, which are shown or hidden as one, and lights, which light all of them."""
from dspace._strict import Strict
from dspace.poses import vector

KINDS = {"directional": 0, "point": 1, "spot": 2, "head": 3, "ambient": 4}


class Fragment(Strict):
    """A named group of objects."""

    def __init__(self, scene, name):
        self._scene = scene
        self._name = name

    def _info(self):
        for fragment in self._scene._ask("list_fragments").fragments.fragment:
            if fragment.name == self._name:
                return fragment
        raise LookupError(f"there is no fragment {self._name!r} any more")

    @property
    def name(self):
        return self._name

    @property
    def ornamental(self):
        return self._info().nature == 1

    @property
    def visible(self):
        """Everywhere; a viewport hides it for itself with Viewport.hide."""
        return self._info().visible

    @visible.setter
    def visible(self, visible):
        self._scene._do("set_fragment_visible", name=self._name, visible=bool(visible))

    @property
    def objects(self):
        return [self._scene._object(id) for id in self._info().object]

    def remove(self):
        """It must be empty."""
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
        raise LookupError(f"there is no light {self._name!r} any more")

    @property
    def name(self):
        return self._name

    def set(self, **values):
        """Of: kind, frame, direction, position, cone_deg, color, intensity, attenuation, enabled."""
        command = self._scene._command()
        command.set_light.CopyFrom(self._info())
        put_light(self._scene, command.set_light, **values)
        self._scene._execute(command)

    @property
    def kind(self):
        """"directional", "point", "spot", "head" or "ambient"."""
        return list(KINDS)[self._info().kind]

    @property
    def direction(self):
        """The way the light travels, in its frame."""
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
    def enabled(self):
        return not self._info().disabled

    @enabled.setter
    def enabled(self, enabled):
        self.set(enabled=enabled)

    def remove(self):
        self._scene._do("remove_light", name=self._name)

    def __repr__(self):
        return f"<dspace.Light {self._name!r}>"


def put_light(scene, message, kind=None, frame=None, direction=None, position=None, cone_deg=None,
              color=None, intensity=None, attenuation=None, enabled=None):
    """Writes what is given into a SetLight message."""
    if kind is not None:
        if kind not in KINDS:
            raise ValueError(f"kind is {kind!r}; accepted: {', '.join(KINDS)}")
        message.kind = KINDS[kind]
    if frame is not None:
        message.frame = scene._frame_id(frame)
    for field, value in (("direction", direction), ("position", position),
                         ("attenuation", attenuation)):
        if value is not None:
            out = getattr(message, field)
            out.x, out.y, out.z = vector(value, field)
    if color is not None:
        message.color.r, message.color.g, message.color.b = vector(color, "the colour")
    if cone_deg is not None:
        message.cone_deg = cone_deg
    if intensity is not None:
        message.intensity = intensity
    if enabled is not None:
        message.disabled = not enabled
