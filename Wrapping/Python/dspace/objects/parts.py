"""Parts of objects: their material and visibility by name."""
from dspace._core.fields import flag, keywords
from dspace._core.strict import Strict
from dspace.errors import NotFound
from dspace.objects import graphics


class Part(Strict):
    """The parts of one name of a GraphicsObject, from GraphicsObject.part."""

    def __init__(self, object, name):
        self._object = object
        self._name = name

    @property
    def object(self):
        """The GraphicsObject."""
        return self._object

    @property
    def name(self):
        return self._name

    def _override(self):
        for override in self._object._info().part_override:
            if override.part == self._name:
                return override
        return None

    def _label(self):
        return f"{self._object._label()}, part {self._name!r}"

    @property
    def visible(self):
        """Whether it is drawn where its object is; may be set."""
        override = self._override()
        return override is None or override.visible

    @visible.setter
    def visible(self, visible):
        self.set(visible=visible)

    @property
    def material(self):
        """A dict of its overrides, which go over those of the object."""
        override = self._override()
        return {} if override is None else graphics.material_of(override.material)

    def set(self, visible=None, **material):
        """Shows or hides it, and overrides its material: color, opacity, metallic, roughness, texture, lit, wireframe,
        emissive, reflectance. None restores a property."""
        about = self._label
        keywords(material, graphics.MATERIAL, about)
        command = self._object.scene._command()
        change = command.set_part
        change.object = self._object.id
        change.part = self._name
        if any(value is None for value in material.values()):
            override = self._override()
            if override is not None:
                change.material.CopyFrom(override.material)
            change.replace = True
            for key, value in material.items():
                if value is None:
                    change.material.ClearField(key)
        graphics.put_material(change.material, {k: v for k, v in material.items() if v is not None}, about)
        if visible is not None:
            change.visible = flag(visible, "visible", about)
        self._object.scene._execute(command)

    def __eq__(self, other):
        return isinstance(other, Part) and (self._object, self._name) == (other._object, other._name)

    def __hash__(self):
        return hash((self._object, self._name))

    def __repr__(self):
        return f"<dspace.Part {self._name!r} of {self._object!r}>"


def part_of(object, name):
    """The parts of that name. Raises dspace.NotFound, which lists the names."""
    names = object.parts
    if name not in names:
        about = object._label()
        raise NotFound(f"{about}, part {name!r}: no part has this name; accepted: "
                       + (", ".join(map(repr, names)) or "the object has no named part"), about)
    return Part(object, name)
