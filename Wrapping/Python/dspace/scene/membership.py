"""Checks that arguments of a scene's methods belong to the scene."""
import numpy as np

from dspace._core.fields import named, reject, text
from dspace.cameras.vantage import Vantage
from dspace.errors import InvalidArgument, WrongType
from dspace.frames.frame import Frame
from dspace.objects.assemblies import Assembly
from dspace.objects.fragments import Fragment
from dspace.objects.robots import Robot
from dspace.scene.viewport import Viewport


class SceneMembership:
    """Checks for a Scene, which delegates to it, that an argument belongs to it and not to another scene or session."""

    def __init__(self, scene):
        self._scene = scene

    def require_own(self, thing, what, about=None):
        """Rejects a thing of another scene, also of a scene of the same name in another session."""
        other = thing.scene if isinstance(thing, Viewport) else thing._scene
        if other != self._scene:
            where = "" if other._client is self._scene._client else " of another session"
            raise InvalidArgument(named(about, f"{what} is in another scene, {other.name!r}{where}; "
                                               f"accepted: one of scene {self._scene.name!r}"),
                                  f"scene {self._scene.name!r}")

    def frame_id(self, frame):
        if frame is None:
            return 1
        if isinstance(frame, Frame):
            if frame._scene is not self._scene:
                self.require_own(frame, frame._label())
            return frame.id
        if isinstance(frame, Robot):
            self.require_own(frame, f"robot {frame.name!r}")
            return frame._base
        if isinstance(frame, Assembly):
            return self.frame_id(frame.frame)
        if isinstance(frame, str):
            return self._scene._ask("find_frame", path=frame).frame.frame
        if isinstance(frame, (int, np.integer)) and not isinstance(frame, bool):
            if 0 < frame < 2**63:
                return int(frame)
            reject(f"scene {self._scene.name!r}", "the frame's id", frame, "an id, from 1 to 2^63 - 1")
        reject(f"scene {self._scene.name!r}", "the frame", frame, "a Frame, a Robot, an Assembly, a path or an id",
               WrongType)

    def name_of(self, thing, kind, what, about=None):
        """The name of a thing of this scene. `thing` is the thing, its name, or None, which gives ""."""
        if thing is None:
            return ""
        if isinstance(thing, str):
            return text(thing, f"the {what}", about or f"scene {self._scene.name!r}", "a name")
        if not isinstance(thing, kind):
            reject(about or f"scene {self._scene.name!r}", f"the {what}", thing,
                   f"a dspace.{kind.__name__} of scene {self._scene.name!r} or its name", WrongType)
        self.require_own(thing, f"{what} {thing.name!r}", about)
        return thing.name

    def fragment_name(self, fragment, default=""):
        if fragment is None and default is None:
            reject(f"scene {self._scene.name!r}", "the fragment", None, "a dspace.Fragment or its name",
                   WrongType)
        return self.name_of(fragment, Fragment, "fragment")

    def viewport_name(self, viewport, about=None):
        if viewport is None:
            reject(about or f"scene {self._scene.name!r}", "the viewport", None, "a dspace.Viewport or its name",
                   WrongType)
        return self.name_of(viewport, Viewport, "viewport", about)

    def vantage_name(self, vantage, about=None):
        return self.name_of(vantage, Vantage, "vantage", about)
