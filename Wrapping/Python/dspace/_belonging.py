"""What may be handed to a scene: things of its own, or their names."""
import numpy as np

from dspace._fields import named, reject, text
from dspace.assemblies import Assembly
from dspace.cameras import Vantage
from dspace.errors import InvalidArgument, WrongType
from dspace.fragments import Fragment
from dspace.frames import Frame
from dspace.robots import Robot


class Belonging:
    """The part of Scene that tells its own things from those of other scenes and sessions."""

    def _require_own(self, thing, what, about=None):
        """Refuses what belongs to another scene, or to one of this name in another session."""
        other = thing._scene
        if other != self:
            where = "" if other._client is self._client else " of another session"
            raise InvalidArgument(named(about, f"{what} is in another scene, {other.name!r}{where}; "
                                               f"accepted: one of scene {self._name_!r}"),
                                  f"scene {self._name_!r}")

    def _frame_id(self, frame):
        if frame is None:
            return 1
        if isinstance(frame, Frame):
            if frame._scene is not self:
                self._require_own(frame, frame._label())
            return frame.id
        if isinstance(frame, Robot):
            self._require_own(frame, f"robot {frame.name!r}")
            return frame._base
        if isinstance(frame, Assembly):
            return self._frame_id(frame.frame)
        if isinstance(frame, str):
            return self._ask("find_frame", path=frame).frame.frame
        if isinstance(frame, (int, np.integer)) and not isinstance(frame, bool):
            if 0 < frame < 2**63:
                return int(frame)
            reject(f"scene {self._name_!r}", "the frame's id", frame, "an id, from 1 to 2^63 - 1")
        reject(f"scene {self._name_!r}", "the frame", frame, "a Frame, a Robot, an Assembly, a path or an id",
               WrongType)

    def _name_of(self, thing, kind, what, about=None):
        """The name of a thing of this scene, given itself or by its name; "" for None."""
        if thing is None:
            return ""
        if isinstance(thing, str):
            return text(thing, f"the {what}", about or f"scene {self._name_!r}", "a name")
        if not isinstance(thing, kind):
            reject(about or f"scene {self._name_!r}", f"the {what}", thing,
                   f"a dspace.{kind.__name__} of scene {self._name_!r} or its name", WrongType)
        self._require_own(thing, f"{what} {thing.name!r}", about)
        return thing.name

    def _fragment_name(self, fragment, default=""):
        if fragment is None and default is None:
            reject(f"scene {self._name_!r}", "the fragment", None, "a dspace.Fragment or its name",
                   WrongType)
        return self._name_of(fragment, Fragment, "fragment")

    def _vantage_name(self, vantage, about=None):
        return self._name_of(vantage, Vantage, "vantage", about)
