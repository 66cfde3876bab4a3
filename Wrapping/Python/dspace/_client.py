"""Where commands go, and what comes back: replies, warnings, exceptions."""
import sys
import threading
import warnings
import weakref

from dspace import vtk as _vtk
from dspace._traits import scene_name
from dspace._wire import decode, encode
from dspace.errors import KINDS, Closed, DspaceWarning, Internal, WrongThread
from dspace.events import EventQueue, FrameListeners
from dspace.proto import commands_pb2 as pb


def make_error(error):
    """The exception of an Error message."""
    return KINDS.get(error.kind, Internal)(error.message, error.object)


def warn(message):
    # Points at the first caller outside this package, however deep it was called.
    level = 1
    frame = sys._getframe()
    while frame is not None and frame.f_globals.get("__name__", "").split(".")[0] == "dspace":
        frame = frame.f_back
        level += 1
    warnings.warn(message, DspaceWarning, stacklevel=level)


def to_bytes(answer):
    """VTK makes a str of bytes that happen to be UTF-8."""
    return answer.encode() if isinstance(answer, str) else answer


def to_reply(answer):
    return decode(pb.Reply, to_bytes(answer), "reply", Internal)


class LocalClient:
    """Hands commands to an interpreter in this process."""

    def __init__(self):
        self._thread = threading.get_ident()
        self.vtk = _vtk.vtkDspaceSession()
        self._background = weakref.finalize(self, self.vtk.EndBackgroundWork)
        self.frame_listeners = FrameListeners()
        self.events = EventQueue()
        self.recording = None  # the last one that was begun
        self.telemetry = {}  # by scene: {name: (id, kind)} of the channels that are known

    def _end_background_work_by(self, end):
        """Called when the client is closed or gone, and at the latest as the program ends: GDAL, which
        the session may read with in the background, is taken down then."""
        self._background.detach()
        self._background = weakref.finalize(self, end)

    def local(self):
        """The vtkDspaceSession; raises when it is closed."""
        if self.vtk is None:
            raise Closed("the session is closed; accepted: a new dspace.Session()", "session")
        self._require_thread()
        return self.vtk

    def _require_thread(self):
        # Its graphics context is current in one thread; elsewhere drawing would crash or go nowhere.
        if threading.get_ident() != self._thread:
            raise WrongThread(f"the session is used in thread {threading.current_thread().name!r}; "
                              "accepted: the thread that made it", "session")

    def execute(self, command):
        """The Reply to a Command; raises what its error says, or, with the change made, what a
        callback raised that heard of it."""
        return self._finish(command, self._carry(command))

    def _carry(self, command):
        return to_reply(self.local().Execute(encode(command)))

    def _finish(self, command, reply):
        if reply.HasField("error"):
            raise make_error(reply.error)
        if command.HasField("remove_scene"):
            self.telemetry.pop(scene_name(command), None)
        listeners = self.frame_listeners
        if listeners and command.HasField("remove_scene"):
            listeners.forget_scene(scene_name(command))
        listeners.put(reply.frame_event)
        try:
            for warning in reply.warning:
                warn(warning)
        finally:  # a warning may be turned into an exception
            listeners.deliver()
        return reply

    def send_event(self, event):
        """A ViewerEvent for who drives: in a session of one's own, for oneself."""
        self.local()
        self.events.put(event)

    def take_event(self, wait):
        """The next ViewerEvent, or None; nothing comes meanwhile."""
        self.local()
        return self.events.take()

    def close(self):
        if self.vtk is not None:
            self._require_thread()
        self._background()
        self.vtk = None
        self.frame_listeners.clear()
        self.events.clear()
