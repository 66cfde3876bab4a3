"""Why objects are seen in a viewport's picture, or not."""
from dataclasses import dataclass

from dspace.proto import viewports_pb2

REASONS = {number: name.lower().replace("_", " ")
           for name, number in viewports_pb2.ExplanationReply.Reason.items()}


@dataclass(frozen=True)
class Seen:
    """Why one object is seen or not.

    reason: "seen", "hidden", "fragment hidden", "ornaments hidden", "behind" (the camera), "outside" (the picture),
    "before near", "beyond far", "too small", "occluded", "empty" or "transparent". text: a sentence with the
    numbers. pixels: how many show it."""
    object: object  # GraphicsObject
    name: str
    reason: str
    text: str
    pixels: int


@dataclass(frozen=True)
class Explanation:
    """Why the objects of a scene are seen in a viewport's picture, or not.

    objects: a Seen for each object, by id. remarks: sentences on the whole picture."""
    objects: tuple
    remarks: tuple

    def of(self, thing):
        """The Seen of an object, or of an object's name; None if the scene has none."""
        for each in self.objects:
            if thing in (each.object, each.name):
                return each
        return None

    def __str__(self):
        return "\n".join([*self.remarks, *(f"{each.name}: {each.reason}. {each.text}" for each in self.objects)])


def explanation_of(viewport, reply):
    """The Explanation of an ExplanationReply about a viewport."""
    scene = viewport.scene
    return Explanation(tuple(Seen(scene._object(each.object), each.name, REASONS[each.reason], each.text, each.pixels)
                             for each in reply.object), tuple(reply.remark))
