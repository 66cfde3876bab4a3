"""Sessions in a server process: the same script as with dspace.Session(), one line changed."""
import os
import time

from dspace import vtk as _vtk
from dspace._client import LocalClient, make_error, to_bytes, to_reply, warn
from dspace._fields import flag, number, refuse, text
from dspace.errors import Closed, Unsupported, WrongType
from dspace.session import commands_pb2 as pb
from dspace.session import service_pb2
from dspace.sessions import Session

# Commands whose replies say nothing but whether they were done.
SILENT = {"set_time", "set_poses", "append_trail", "set_joints", "set_tilt", "set_text", "set_text_table",
          "set_object_visible", "set_material", "set_object_offset", "set_light", "track_wheels", "set_telemetry",
          "set_telemetry_texts"}

SLICE = 0.1  # [s] of a wait without hearing signals


def hear_signals():
    """Between two slices of a wait. CPython 3.11 does not notice a signal that another thread than the main one has
    caught, such as gRPC's, until its lock has been let go, which this does."""
    time.sleep(0)


class RemoteClient(LocalClient):
    """Hands commands to a server."""

    def __init__(self, link, address):
        super().__init__()
        self.vtk = None
        self.link = link
        self.address = address
        self.process = os.getpid()
        self.wait = True
        self.pace = None

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

    def _carry(self, command):
        link = self._open()
        link.Begin(command.SerializeToString(), self.wait or command.WhichOneof("command") not in SILENT)
        return self._take(link)

    @staticmethod
    def _take(link):
        try:
            while not link.Wait(SLICE):
                hear_signals()
        except BaseException:
            link.Abandon()
            raise
        return to_reply(link.TakeReply())

    def tell(self, event):
        self._open()
        self.events.put(event)

    def take_event(self, wait):
        link = self._open()
        event = self.events.take()
        if event is None:
            end = time.monotonic() + wait
            data = to_bytes(link.TakeEvent(min(wait, SLICE)))
            while not data and time.monotonic() < end:
                broken = to_reply(link.GetBroken())  # then nothing comes any more
                if broken.HasField("error"):
                    raise make_error(broken.error)
                hear_signals()
                data = to_bytes(link.TakeEvent(min(SLICE, max(0.0, end - time.monotonic()))))
            event = service_pb2.ViewerEvent.FromString(data) if data else None
        return event

    def flush(self):
        link = self._open()
        link.BeginFlush()
        self._finish(pb.Command(), self._take(link))

    def close(self):
        if self.link is not None:
            self._require_thread()
            self.link.Close()
        self.link = None
        self.frame_listeners.clear()
        self.events.clear()


class RemoteSession(Session):
    """What connect() returns: a Session whose scenes are in a server process.

    Closing it leaves the scenes there. Paths of files that are relative are those of this process's
    working folder; the server must allow and have them.
    """

    def __init__(self, client):
        self._client = client

    @property
    def wait(self):
        """Whether every command waits for its reply: then, with a capture or render() each step, picture
        and simulation are in lockstep. False: poses, time, joints, trails, texts and the like are sent
        without waiting; when one of them is refused, the next command that waits raises what it says,
        and is not carried out itself."""
        return self._client.wait

    @wait.setter
    def wait(self, wait):
        self._client.wait = flag(wait, "wait", "session")

    def flush(self):
        """Waits until everything that was sent is done; raises what of it was refused first."""
        self._client.flush()

    @property
    def pace(self):
        """Simulation seconds a wall second: setting a scene's time then waits until it is due, counted
        from the first time that is set after this, and anew from one that goes back. It never goes on
        early; a simulation that was late catches up. None (the default): as fast as it goes."""
        return self._client.pace

    @pace.setter
    def pace(self, rate):
        if rate is not None:
            rate = number(rate, "the pace", "session")
            if not 0 < rate < float("inf"):
                refuse("session", "the pace", rate, "None, or a finite number above 0")
        self._client._open().SetPace(0.0 if rate is None else rate)
        self._client.pace = rate

    @property
    def poses_left_out(self):
        """How many poses were not sent because the server had them already."""
        return self._client._open().GetPosesLeftOut()

    @property
    def vtk(self):
        """The vtkDspaceRemoteSession behind it."""
        return self._client.link

    def __repr__(self):
        state = "closed" if self._client.link is None else f"served at {self._client.address}"
        return f"<dspace.RemoteSession, {state}>"


def prepare(link, address, certificate, key, authority, insecure, timeout, label):
    """What connect() and watch() share: checks, and sets what both kinds of links take."""
    text(address, "the address", label)
    files = []
    for value, what in ((certificate, "certificate"), (key, "key"), (authority, "authority")):
        if value is not None and not isinstance(value, (str, os.PathLike)):
            refuse(label, what, value, "the path of a PEM file", WrongType)
        files.append("" if value is None else os.path.abspath(os.fspath(value)))
    link.SetCertificates(*files)
    link.SetInsecure(flag(insecure, "insecure", label))
    if insecure:
        warn(f"{label}: nothing is encrypted, and nobody knows who is there")
    link.SetTimeout(number(timeout, "the timeout", label))


def make_connection(link, address, name):
    """Of both kinds of links; raises why there is none."""
    reply = to_reply(link.ConnectLater(address, name))
    state = -1 if reply.HasField("error") else 0
    while state == 0:
        state = link.WaitToConnect(SLICE)
        hear_signals()
        if state < 0:
            reply = to_reply(link.TakeReply())
    if reply.HasField("error"):
        raise make_error(reply.error)


def connect(address, certificate=None, key=None, authority=None, insecure=False, timeout=30.0,
            name="simulation", take_over=False, only_changes=True):
    """Drives the session of a `dspace serve` process at "host:port" or "unix:PATH".

    certificate, key, authority: PEM files for mutual TLS, all three; without them only an address of
    this machine is accepted, unless `insecure` is spelled out. timeout: seconds of every wait. One
    simulation drives a server: a second is refused, unless it says take_over=True. only_changes: poses
    that the server has already are not sent again.
    """
    label = f"server {address!r}"
    link = _vtk.vtkDspaceRemoteSession()
    prepare(link, address, certificate, key, authority, insecure, timeout, label)
    text(name, "the name", label)
    link.SetTakeOver(flag(take_over, "take_over", label))
    link.SetOnlyChanges(flag(only_changes, "only_changes", label))
    make_connection(link, address, name)
    return RemoteSession(RemoteClient(link, address))
