"""The arguments that all measurements share: what may stand in the way."""
from dspace._core.fields import flag, items, put_given, reject, word
from dspace.errors import WrongType
from dspace.objects.graphics import GraphicsObject

METHODS = {"exact": 0, "image": 1, "both": 2}  # Measuring.Method


def put_measuring(scene, message, about, terrain, objects, hide, deadline, method, resolution=None):
    """Fills a Measuring from the arguments of a measurement."""
    message.method = word(method, METHODS, "the method", about)
    message.no_terrain = not flag(terrain, "terrain", about)
    message.no_objects = not flag(objects, "objects", about)
    hide = (hide,) if isinstance(hide, str) else items(hide, "hide", about, "fragments or their names")
    message.hidden_fragment.extend(scene._fragment_name(fragment, None) for fragment in hide)
    if resolution is not None and method == "exact":
        reject(about, "the resolution", resolution, 'it with the method "image" or "both"')
    put_given(message, about, deadline_s=deadline, resolution=resolution)


def object_ids(scene, things, about):
    """Ids of objects of the scene: objects or their names, one or several."""
    ids = []
    if isinstance(things, (str, GraphicsObject)):
        things = (things,)
    for thing in items(things, "without", about, "objects or their names"):
        if isinstance(thing, str):
            thing = scene.object(thing)
        if not isinstance(thing, GraphicsObject):
            reject(about, "the object", thing, "a dspace.GraphicsObject or its name", WrongType)
        scene._require_own(thing, f"object {thing.name!r}", about)
        ids.append(thing.id)
    return ids
