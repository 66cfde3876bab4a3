"""Sessions in a server process. They have the methods of dspace.Session."""
import os
import time

from dspace import vtk as _vtk
from dspace._core.fields import flag, number, reject, text
from dspace._core.replies import make_error, to_bytes, to_reply, warn
from dspace._core.signals import SLICE, check_signals
from dspace._core.traits import UNAWAITED
from dspace._core.wire import decode, encode
from dspace.clients.local import LocalClient
from dspace.clients.session import Session
from dspace.errors import Closed, DeadlineExceeded, Internal, Unsupported
from dspace.links.connection import make_connection, prepare
from dspace.links.recordings import ServedRecording
from dspace.proto import commands_pb2 as pb
from dspace.proto import service_pb2


class RemoteClient(LocalClient):
    """Sends commands to a server."""

    def __init__(self, link, address, name, timeout, prepared):
        super().__init__()
        self._background()
        self.vtk = None
        self.link = link
        self.address = address
        self.name = name
        self.timeout = timeout
        self.prepared = prepared  # applies the settings of this link to another one
        self.process = os.getpid()
        self.wait = True
        self.pace = None
        self.sequence = 0  # the number of the last command that is known to be executed
        self.later = False  # whether later commands may have been executed

    def local(self):
        raise Unsupported(f"the session is in the server at {self.address}: its VTK objects are there; "
                          "accepted: commands, or a local dspace.Session()", "session")

    def _open(self):
        if self.link is None:
            raise Closed("the session is closed; accepted: a new dspace.connect()", "session")
        if os.getpid() != self.process:
            raise Unsupported(f"process {self.process} connected it, and this one is its child; accepted: "
                              "a dspace.connect() of its own", "session")
        self._require_thread()
        return self.link

    @property
    def thread(self):
        """The only thread that may use the session."""
        return self._thread

    def require_thread(self):
        self._require_thread()

    def _carry(self, command):
        link = self._open()
        asks = self.wait or command.WhichOneof("command") not in UNAWAITED
        self.later = self.later or not asks
        link.Begin(encode(command), asks)
        reply = self._take(link, asks)
        for warning in self.recording.take_warnings() if self.recording is not None else ():
            warn(warning) if reply.HasField("error") else reply.warning.append(warning)
        return reply

    def _take(self, link, asks=False, end=None):
        """Waits for the reply to a request that was begun, until the time `end` at the latest. asks: the request is a
        command that waits for its reply."""
        try:
            while not link.Wait(SLICE):
                check_signals()
                if end is not None and time.monotonic() > end:
                    raise DeadlineExceeded(f"server {self.address!r}: no answer in time", "server")
        except BaseException:
            self.later = True  # the server may still execute it
            link.Abandon()
            raise
        reply = to_reply(link.TakeReply())
        self.sequence = max(self.sequence, reply.sequence)
        if asks and not reply.HasField("error"):  # an error may belong to an earlier command
            self.later = False
        return reply

    def settle(self, end):
        """Waits until the results of all commands are known, at most until the time `end`. Raises the first error."""
        if self.later:
            link = self._open()
            link.BeginFlush()
            sent = self._take(link, end=end)
            command = pb.Command()
            command.list_scenes.SetInParent()
            link.Begin(encode(command), True)
            last = self._take(link, True, end)
            self.finish(pb.Command(), sent)
            self.finish(command, last)

    def broken(self):
        """Whether the connection is broken and cannot be restored."""
        return to_reply(self._open().GetBroken()).HasField("error")

    def send_event(self, event):
        self._open()
        self.events.put(event)

    def take_event(self, wait):
        link = self._open()
        event = self.events.take()
        if event is None:
            end = time.monotonic() + wait
            data = to_bytes(link.TakeEvent(min(wait, SLICE)))
            while not data and time.monotonic() < end:
                broken = to_reply(link.GetBroken())  # no more events will arrive
                if broken.HasField("error"):
                    raise make_error(broken.error)
                check_signals()
                data = to_bytes(link.TakeEvent(min(SLICE, max(0.0, end - time.monotonic()))))
            event = decode(service_pb2.ViewerEvent, data, "event", Internal) if data else None
        return event

    def flush(self):
        link = self._open()
        link.BeginFlush()
        self.finish(pb.Command(), self._take(link))

    def close(self):
        if self.link is not None:
            self._require_thread()
            try:
                if self.recording is not None:
                    self.recording.finish()
            finally:
                self.link.Close()
                self.link = None
        self.pipelines.clear()
        self.frame_listeners.clear()
        self.events.clear()


class RemoteSession(Session):
    """A Session whose scenes are in a server process, returned by connect().

    Closing it leaves the scenes in the server. Relative paths of files are relative to this process's working
    folder. The server must be able to read the files, and its allowed roots must include them.
    """

    def __init__(self, client):
        self._client = client

    @property
    def wait(self):
        """Whether every command waits for its reply (default: True). With a capture or render() at each step, pictures
        and simulation are then in lockstep. False: poses, time, joints, trails, texts and similar commands are sent
        without waiting. If the server rejects one of them, the next command that waits raises its error and is not
        executed."""
        return self._client.wait

    @wait.setter
    def wait(self, wait):
        self._client.wait = flag(wait, "wait", "session")

    def flush(self):
        """Waits until the server has executed everything that was sent. Raises the first error."""
        self._client.flush()

    def record(self, path, commit_every=0.1, pack=False):
        """Records as Session.record() does, into a file on this process's machine: the state of the server, and then
        every command that the server accepts from any client. A separate connection, that of a viewer, receives the
        commands, and a separate thread writes them.

        recording.stop(), the end of its `with` block and session.close() wait until every command that the server has
        confirmed to this session is in the file. The session's next command reports a failure (a full disk, a server
        that has stopped) once, as a warning; the data written so far stays. If the connection broke and was restored,
        the recording has a gap (Playback.gaps).

        This process executes every command as well, without drawing, and reads the files that commands name at the
        server's paths. A file that cannot be read gives a warning, and its command is still recorded. If the present
        state needs such a file, record() raises dspace.Io. `dspace serve --record` records in the server instead, and
        continues after this process ends.
        """
        return ServedRecording(self._client, path, commit_every, pack)

    @property
    def pace(self):
        """Simulation seconds per second of wall time: a finite number above 0, or None (the default) for no waits.
        Setting a scene's time waits until that time is due, counted from the first time set after this property, and
        again from a time that goes back. A late simulation catches up."""
        return self._client.pace

    @pace.setter
    def pace(self, rate):
        if rate is not None:
            rate = number(rate, "the pace", "session")
            if not 0 < rate < float("inf"):
                reject("session", "the pace", rate, "None, or a finite number above 0")
        self._client._open().SetPace(0.0 if rate is None else rate)
        self._client.pace = rate

    @property
    def poses_left_out(self):
        """The number of poses that were not sent because the server already had them."""
        return self._client._open().GetPosesLeftOut()

    @property
    def vtk(self):
        """The vtkDspaceRemoteSession behind it."""
        return self._client.link

    def __repr__(self):
        state = "closed" if self._client.link is None else f"served at {self._client.address}"
        return f"<dspace.RemoteSession, {state}>"


def connect(address, certificate=None, key=None, authority=None, insecure=False, timeout=30.0,
            name="simulation", take_over=False, only_changes=True, fresh=False):
    """Drives the session of a `dspace serve` process at "host:port" or "unix:PATH".

    certificate, key, authority: PEM files for mutual TLS, all three together. Without them only an address of this
    machine is accepted, unless `insecure` is True. timeout: limit of each wait, above 0 to 1e6 s. name: the client's
    name, shown to viewers. take_over: replaces the client that drives the server; without it a second driver is
    rejected. only_changes: does not send poses that the server already has. fresh: begins with reset(), which removes
    the viewports and scenes of earlier drivers; without it the session goes on with them. Returns a RemoteSession.
    Raises dspace.Error.
    """
    label = f"server {address!r}"
    link = _vtk.vtkDspaceRemoteSession()
    prepared = prepare(link, address, certificate, key, authority, insecure, timeout, label)
    text(name, "the name", label)
    link.SetTakeOver(flag(take_over, "take_over", label))
    link.SetOnlyChanges(flag(only_changes, "only_changes", label))
    flag(fresh, "fresh", label)
    make_connection(link, address, name)
    session = RemoteSession(RemoteClient(link, address, name, float(timeout), prepared))
    if fresh:
        try:
            session.reset()
        except BaseException:
            session.close()
            raise
    return session
