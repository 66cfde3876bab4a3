"""Viewers, which follow a simulation in another process through a server."""
import time

from dspace import vtk as _vtk
from dspace._core.fields import real, reject, text
from dspace._core.replies import make_error, to_reply, warn
from dspace._core.signals import SLICE, check_signals
from dspace._core.wire import encode
from dspace.clients.local import LocalClient
from dspace.clients.session import Session
from dspace.errors import Closed, WrongType
from dspace.links.connection import make_connection, prepare
from dspace.scene.scene import Scene


OWN = "viewer:"  # the prefix of names of a watcher's own views


class WatchClient(LocalClient):
    """Executes requests on a local copy of the server's session."""

    def __init__(self, watcher):
        super().__init__()
        self._watcher = watcher
        self.vtk = watcher.GetSession()
        self._end_background_work_by(lambda: watcher.GetSession().EndBackgroundWork())

    def watcher(self):
        if self._watcher is None:
            raise Closed("the watcher is closed; accepted: a new dspace.watch()", "watcher")
        self._require_process()
        self._require_thread()
        return self._watcher

    def local(self):
        self.vtk = self.watcher().GetSession()  # another one after a snapshot
        return self.vtk

    def _carry(self, command):
        self.local()  # captures read the planes of the present session
        return to_reply(self.watcher().Execute(encode(command)))

    def update(self, wait):
        """Applies messages for up to `wait` seconds, then calls the frame listeners. Returns the number of messages."""
        watcher = self.watcher()
        end = time.monotonic() + wait
        check_signals()
        count = watcher.Update(min(wait, SLICE))
        while count == 0 and time.monotonic() < end:
            check_signals()
            count = watcher.Update(min(SLICE, max(0.0, end - time.monotonic())))
        reply = to_reply(watcher.TakeFrameEvents())
        try:
            for warning in reply.warning:  # of objects that this process cannot draw
                warn(warning)
        finally:
            if self.frame_listeners:
                self.frame_listeners.put(reply.frame_event)
                self.frame_listeners.deliver()
        return count

    def send_event(self, event):
        watcher = self.watcher()
        reply = to_reply(watcher.BeginSendEvent(encode(event, "event")))
        state = -1 if reply.HasField("error") else 0
        try:
            while state == 0:
                state = watcher.WaitForSendEvent(SLICE)
                check_signals()
                if state < 0:
                    reply = to_reply(watcher.TakeReply())
        except BaseException:
            watcher.CancelSendEvent()
            raise
        if reply.HasField("error"):
            raise make_error(reply.error)

    def take_event(self, wait):
        self.watcher()
        return None  # only the driver receives events

    def close(self):
        super().close()
        if self._watcher is not None:
            self._watcher.Close()
        self._watcher = None


class Watcher(Session):
    """A read-only Session, returned by watch(). It has the state of the server's session at the last update().

    It draws in this process. The state does not change between two calls of update(). A watcher may have its own
    views: add_view(), or viewports, vantages and cameras whose names begin with "viewer:". Other clients do not see
    them, and they survive snapshots. A camera whose frame is removed keeps its pose. Views of a scene that is removed,
    or lost with its server, return when the scene does. Every other change to the scene raises dspace.Unsupported.

    The watcher sends actions of a person to the driver: send_event(), answer(), edited(), select(), dragged(),
    Viewport.pick(send=True), and clicks and unused keys in its own viewports (Viewport.event).
    """

    def __init__(self, client):
        self._client = client

    def update(self, wait=0.0):
        """Applies all commands that the server has accepted since the last call. Waits up to `wait` seconds for the
        first one. Returns the number of messages. Callbacks of Scene.on_frame_change get the changes; a new snapshot
        is a single event. If the simulation or the server disconnects, the state stays, viewports show the
        disconnection, and the watcher reconnects automatically."""
        return self._client.update(real(wait, "the wait", "watcher", "seconds"))

    @property
    def sequence(self):
        """The number of the latest command in the state; a server counts from 0."""
        return self._client.watcher().GetSequence()

    @property
    def connected(self):
        """Whether the server is connected."""
        return bool(self._client.watcher().GetConnected())

    @property
    def simulation(self):
        """The name of the driver, or None if there is none."""
        watcher = self._client.watcher()
        return watcher.GetWriterName() if watcher.GetWriterConnected() else None

    @property
    def error(self):
        """Why the server rejects this viewer (a state too large to send, too many viewers), or which commands could
        not be applied since the last snapshot; empty: no error."""
        return self._client.watcher().GetError()

    def record(self, path, commit_every=0.1, pack=False):
        """Records as Session.record() does: the commands that each update() applies, and the watcher's own views.
        Where the watcher restarts from a snapshot (because the link broke or the watcher was too slow), the recording
        has a gap (Playback.gaps)."""
        return super().record(path, commit_every, pack)

    def add_view(self, name, scene=None, size=(1280, 720), samples=None, **camera):
        """Adds the viewport "viewer:NAME", which belongs to this watcher, and returns it.

        With arguments of Scene.add_camera (eye and target, pose, chase, frame, fov_deg, ...) it has its own camera.
        Without, it looks through the scene's active camera until Viewport.event moves it. scene: default: the server's
        only one. size: (width, height) in pixels."""
        label = f"view {text(name, 'the name', 'watcher')!r}"
        if not name:
            reject("watcher", "the view's name", name, "any that is not empty")
        if scene is None:
            scenes = self.scenes
            if len(scenes) != 1:
                reject(label, "the scene", None, "one of " + (", ".join(map(repr, scenes)) or "none yet"))
            scene = next(iter(scenes.values()))
        elif not isinstance(scene, Scene) or scene._client is not self._client:
            reject(label, "the scene", scene, "a scene of this watcher", WrongType)
        name = OWN + name
        if not camera:
            return scene.add_viewport(size, name=name, samples=samples)
        vantage = scene.add_vantage(name)
        try:
            own = scene.add_camera(vantage=vantage, **camera)
            return scene.add_viewport(size, own, name=name, samples=samples)
        except Exception:
            vantage.remove()
            raise

    def __repr__(self):
        return "<dspace.Watcher>"


def watch(address, certificate=None, key=None, authority=None, insecure=False, timeout=30.0,
          name="viewer"):
    """Watches the session of a server. The arguments are those of dspace.connect. Returns a Watcher that has the
    present state. Raises dspace.Error."""
    label = f"server {address!r}"
    watcher = _vtk.vtkDspaceWatcher()
    prepare(watcher, address, certificate, key, authority, insecure, timeout, label)
    make_connection(watcher, address, text(name, "the name", label))
    client = WatchClient(watcher)
    client.update(float(timeout))
    return Watcher(client)
