"""Windows on the screen that show viewports."""
import threading
import time
import weakref

from dspace._core.fields import integers, real, reject, text
from dspace._core.replies import to_reply, warn
from dspace._core.traits import SIDE
from dspace.errors import Closed, Resource, Unsupported, WrongThread
from dspace.proto import commands_pb2 as pb

SIZE = f"(width, height), two integers from {SIDE[0]} to {SIDE[1]}"
WAIT = 0.05  # [s] between looks at the windows
_clients = weakref.WeakSet()  # those that have opened windows


class ViewWindows:
    """The windows of one client's viewports."""

    def __init__(self, client):
        self._client = client
        self._vtk = None  # vtkDspaceWindows; Qt is loaded with the first window
        self._thread = None
        self._viewports = {}  # by name

    def _load(self, label):
        if self._vtk is None:
            try:
                from dspace.vtk.vtkDspaceWidgets import vtkDspaceWindows
            except ImportError as error:
                raise Unsupported(f"windows need Qt 6, and this build of Dspace has none ({error}); accepted: a build "
                                  "where Debian's package qt6-base-dev is installed", label) from None
            self._vtk = vtkDspaceWindows()
            self._thread = threading.get_ident()
            _clients.add(self)
        self._require_thread(label)
        return self._vtk

    def _require_thread(self, label):
        if self._thread is not None and threading.get_ident() != self._thread:
            raise WrongThread("windows belong to the thread that opened the first one; accepted: that thread", label)

    def show(self, viewport, title=None, size=None):
        label = f"viewport {viewport.name!r}"
        if title is not None:
            text(title, "title", label)
        width, height = (0, 0) if size is None else integers(size, 2, "size", label, SIZE)
        if size is not None and not all(SIDE[0] <= side <= SIDE[1] for side in (width, height)):
            reject(label, "size", size, SIZE)
        session = self._client.local()
        windows = self._load(label)
        why = windows.Show(session, viewport.name, viewport.name if title is None else title, width, height)
        if why:
            raise Resource(f"no window can be opened: {why}", label)
        self._viewports[viewport.name] = viewport

    def close(self, name):
        if self._vtk is not None:
            self._vtk.Close(self._client.local(), name)

    def shows(self, name):
        return self._vtk is not None and self._vtk.IsShown(self._client.local(), name)

    def end(self, session):
        """Closes all windows, before the session ends."""
        if self._vtk is not None:
            self._vtk.CloseAll(session)
        self._vtk = None
        self._viewports.clear()

    def count(self):
        return self._vtk.GetCount() if self._vtk is not None else 0

    def process(self, wait):
        """Lets the windows draw and take mouse and keyboard, and calls the callbacks of what came."""
        if self._vtk is None:
            return
        self._require_thread("windows")
        self._vtk.ProcessEvents(round(1e3 * wait))
        while message := self._vtk.TakeEvent():
            event = pb.Command().viewport_event
            event.ParseFromString(message)
            reply = self._client.finish(pb.Command(viewport_event=event), to_reply(self._vtk.TakeReply()))
            if event.viewport in self._viewports:
                self._client.inputs.tell(self._viewports[event.viewport], event, reply)
        for line in self._vtk.TakeFailures().splitlines():
            warn(line)


def _seconds(value, what, about, most):
    value = real(value, what, about)
    if not 0.0 <= value <= most:
        reject(about, what, value, f"0 to {most:g} s")
    return value


def _open_clients():
    return [windows for windows in list(_clients) if windows.count()]


def process_events(wait=0.0):
    """Lets all windows draw what has changed and take mouse and keyboard: a step for a loop of one's own.

    wait: how long to wait for events if there are none, 0 to 3600 s. Returns the number of open windows. Callbacks of
    Viewport.on_key and on_click run in here; what they raise is raised here."""
    wait = _seconds(wait, "wait", "process_events", 3600)
    for windows in _open_clients():
        windows.process(wait)
        wait = 0.0  # of all clients together
    return sum(windows.count() for windows in _open_clients())


def run(seconds=None):
    """Processes events until all windows are closed, or for `seconds` (0 to 1e9) at the most.

    Raises dspace.Closed if no window is open. Ctrl+C ends it with KeyboardInterrupt."""
    if seconds is not None:
        seconds = _seconds(seconds, "seconds", "run", 1e9)
    if not _open_clients():
        raise Closed("no window is open; accepted: a call after Viewport.show()", "run")
    end = None if seconds is None else time.monotonic() + seconds
    while end is None or time.monotonic() < end:
        if not process_events(WAIT if end is None else max(0.0, min(WAIT, end - time.monotonic()))):
            return
