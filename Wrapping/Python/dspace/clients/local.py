"""The client that executes the commands of a session in this process."""
import os
import threading
import weakref

from dspace import vtk as _vtk
from dspace._core.replies import make_error, to_reply, warn
from dspace._core.traits import scene_name
from dspace._core.wire import encode
from dspace.clients.listeners import EventQueue, FrameListeners
from dspace.clients.pipelines import Pipelines
from dspace.clients.windows import ViewWindows
from dspace.errors import Closed, Unsupported, WrongThread
from dspace.scene.inputs import ViewportInputs


class LocalClient:
    """Executes commands with an interpreter in this process."""

    def __init__(self, session=None):
        """session: the vtkDspaceSession that it drives; None: a new one."""
        self._thread = threading.get_ident()
        self.process = os.getpid()
        self.vtk = _vtk.vtkDspaceSession() if session is None else session
        self._background = weakref.finalize(self, self.vtk.EndBackgroundWork)
        self.frame_listeners = FrameListeners()
        self.events = EventQueue()
        self.inputs = ViewportInputs()
        self.windows = ViewWindows(self)
        self.recording = None  # the latest one
        self.pipelines = Pipelines()
        self.telemetry = {}  # by scene: {name: (id, kind)} of the known channels

    def _end_background_work_by(self, end):
        """Calls `end` when the client is closed or collected, and at the latest when the program ends: GDAL is
        shut down then, and the session may still read with it in the background."""
        self._background.detach()
        self._background = weakref.finalize(self, end)

    def local(self):
        """The vtkDspaceSession; raises when it is closed."""
        if self.vtk is None:
            raise Closed("the session is closed; accepted: a new dspace.Session()", "session")
        self._require_process()
        self._require_thread()
        return self.vtk

    def shown(self):
        """What the windows of an application show views of."""
        return self.local()

    def _require_process(self):
        # A child of a fork has none of the session's threads, and the graphics context is the parent's.
        if os.getpid() != self.process:
            raise Unsupported(f"process {self.process} made the session, and this one is its child; accepted: a process "
                              "that is started anew (multiprocessing.get_context('spawn')) with a session of its own",
                              "session")

    def _require_thread(self):
        # Its graphics context is current in one thread only; drawing in another one would fail or crash.
        if threading.get_ident() != self._thread:
            raise WrongThread(f"the session is used in thread {threading.current_thread().name!r}; "
                              "accepted: the thread that made it", "session")

    def execute(self, command):
        """Returns the Reply to a Command. Raises the error of the reply. If a callback raises, its exception is
        raised, and the change stays made."""
        if self.pipelines:
            self.pipelines.before(command)
        return self.finish(command, self._carry(command))

    def _carry(self, command):
        return to_reply(self.local().Execute(encode(command)))

    def finish(self, command, reply):
        """What is to do after a command: raises the reply's error, warns, and calls the callbacks that it concerns."""
        if reply.HasField("error"):
            raise make_error(reply.error)
        if command.HasField("remove_viewport"):
            self.inputs.forget(command.remove_viewport.viewport)
            self.windows.close(command.remove_viewport.viewport)
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
        """Sends a ViewerEvent to the driver. A local session is its own driver, so the event is queued here."""
        self.local()
        self.events.put(event)

    def take_event(self, wait):
        """Returns the next queued ViewerEvent, or None. Does not wait, because no other process sends events."""
        self.local()
        return self.events.take()

    def close(self):
        if self.vtk is not None and os.getpid() == self.process:
            self._require_thread()
            self.windows.end(self.vtk)
        self._background()
        self.vtk = None
        self.pipelines.clear()
        self.frame_listeners.clear()
        self.events.clear()
