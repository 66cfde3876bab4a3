"""Watching a simulation that another process drives, through a server."""
from dspace import vtk as _vtk
from dspace._client import LocalClient, make_error, to_reply
from dspace._fields import number, text
from dspace.errors import Closed
from dspace.remote import prepare
from dspace.session import service_pb2
from dspace.sessions import Session


class WatchClient(LocalClient):
    """Hands requests to a session that follows a server's."""

    def __init__(self, watcher):
        super().__init__()
        self._watcher = watcher
        self.vtk = watcher.GetSession()

    def watcher(self):
        if self._watcher is None:
            raise Closed("the watcher is closed; accepted: a new dspace.watch()", "watcher")
        self._require_thread()
        return self._watcher

    def local(self):
        self.vtk = self.watcher().GetSession()  # another one after a snapshot
        return self.vtk

    def _carry(self, command):
        self.local()  # whose planes a capture is read from
        return to_reply(self.watcher().Execute(command.SerializeToString()))

    def close(self):
        super().close()
        if self._watcher is not None:
            self._watcher.Close()
        self._watcher = None


class Watcher(Session):
    """What watch() returns: a read-only Session that is what the server's was at the last update().

    It draws for itself. Nothing changes between two calls of update(). Viewports of one's own may be
    made, named "viewer:..."; everything else that would change the scene raises dspace.Unsupported.
    """

    def __init__(self, client):
        self._client = client

    def update(self, wait=0.0):
        """Applies all that the server has accepted since; waits up to `wait` seconds for something.
        Returns how many messages came. Where the simulation or the server is gone the state stays,
        viewports say so, and the link is made again by itself."""
        return self._client.watcher().Update(number(wait, "the wait", "watcher"))

    @property
    def sequence(self):
        """The number of the last command that is in the state; a server counts from 0."""
        return self._client.watcher().GetSequence()

    @property
    def connected(self):
        """Whether the server is there."""
        return bool(self._client.watcher().GetConnected())

    @property
    def simulation(self):
        """The name of who drives, None when nobody does (any more)."""
        watcher = self._client.watcher()
        return watcher.GetWriterName() if watcher.GetWriterConnected() else None

    @property
    def trouble(self):
        """What could not be applied since the last snapshot; empty: nothing."""
        return self._client.watcher().GetTrouble()

    def tell(self, event):
        """Sends a dspace.session.service_pb2.ViewerEvent to the simulation; dspace.NotFound when nobody
        drives."""
        reply = to_reply(self._client.watcher().Tell(event.SerializeToString()))
        if reply.HasField("error"):
            raise make_error(reply.error)

    def answer(self, question, answer):
        """Answers a question of the simulation."""
        event = service_pb2.ViewerEvent()
        event.answer.question = text(question, "the question", "watcher")
        event.answer.answer = text(answer, "the answer", "watcher")
        self.tell(event)

    def edited(self, name, value, unit=""):
        """Tells the simulation a value that a person has entered."""
        event = service_pb2.ViewerEvent()
        event.edited.name = text(name, "the name", "watcher")
        event.edited.value = number(value, "the value", "watcher")
        event.edited.unit = text(unit, "the unit", "watcher")
        self.tell(event)

    def select(self, objects):
        """Tells the simulation which objects of a scene are selected."""
        event = service_pb2.ViewerEvent()
        objects = list(objects)
        event.selection.scene = objects[0].scene.name if objects else ""
        event.selection.object.extend(each.id for each in objects)
        self.tell(event)

    def __repr__(self):
        return "<dspace.Watcher>"


def watch(address, certificate=None, key=None, authority=None, insecure=False, timeout=30.0,
          name="viewer"):
    """Watches the session of a server; the arguments are those of dspace.connect. Returns a Watcher,
    with the state of now in it."""
    label = f"server {address!r}"
    watcher = _vtk.vtkDspaceWatcher()
    prepare(watcher, address, certificate, key, authority, insecure, timeout, label)
    reply = to_reply(watcher.Connect(address, text(name, "the name", label)))
    if reply.HasField("error"):
        raise make_error(reply.error)
    client = WatchClient(watcher)
    watcher.Update(number(timeout, "the timeout", label))
    return Watcher(client)
