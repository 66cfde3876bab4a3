"""Objects whose VTK pipelines are kept up to date."""
from dspace._core.traits import scene_name
from dspace.errors import NotFound

# Commands before which pipelines are updated: those that show or copy geometry, and the one that begins a new step.
_BEFORE = {"set_time", "capture", "simulate_image", "save_image", "render", "pick", "explain_viewport", "get_mesh", "export_scene"}


class Pipelines:
    """The live objects of a client. An object stays here although no variable names it."""

    def __init__(self):
        self._objects = {}  # the stamp by object
        self._busy = False

    def __len__(self):
        return len(self._objects)

    def __contains__(self, object):
        return object in self._objects

    def add(self, object, stamp):
        self._objects[object] = stamp

    def remove(self, object):
        self._objects.pop(object, None)

    def clear(self):
        self._objects.clear()

    def before(self, command):
        """Brings all objects up to date if the command shows the scene or begins a step."""
        kind = command.WhichOneof("command")
        if kind == "remove_scene":
            gone = scene_name(command)
            self._objects = {each: stamp for each, stamp in self._objects.items() if each.scene.name != gone}
        elif kind in _BEFORE:
            self.update()

    def update(self):
        """Updates the pipelines that have changed since the last time, and sends what they make. A pipeline that fails
        raises its error once, after the other objects were updated."""
        if self._busy:  # a pipeline's own code uses the session
            return
        self._busy = True
        failure = None
        try:
            for each, before in list(self._objects.items()):
                try:
                    stamp = each.stamp()
                    if stamp == before:
                        continue
                    self._objects[each] = stamp
                    each.refresh()
                    self._objects[each] = each.stamp()  # its update may have touched it
                except NotFound:
                    self.remove(each)  # the object was removed
                except Exception as error:
                    self._objects[each] = each.stamp()
                    failure = failure or error
        finally:
            self._busy = False
        if failure is not None:
            raise failure
