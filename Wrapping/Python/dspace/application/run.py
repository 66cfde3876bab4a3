"""A recording in the windows: its time is that of the timeline and of the views."""
import os

from dspace import vtk as _vtk
from dspace._core.fields import flag, real, reject
from dspace._core.replies import make_error, to_reply, warn
from dspace._core.wire import encode
from dspace.clients.local import LocalClient
from dspace.clients.session import Session
from dspace.errors import Resource, Unsupported
from dspace.links.watching import OWN
from dspace.playback.playback import Playback

PATIENCE = 0.02  # [s] before the windows show what is opened
SLICE = 0.01  # [s] of work at once


def require(reply):
    """Raises the error of a serialized reply, and gives its warnings."""
    reply = to_reply(reply)
    if reply.HasField("error"):
        raise make_error(reply.error)
    for each in reply.warning:
        warn(each)
    return reply


class PlayerClient(LocalClient):
    """Executes commands in the session of a vtkDspacePlayer."""

    def __init__(self, player):
        super().__init__(player.GetSession())
        self._player = player

    def shown(self):
        """What the windows show views of."""
        self._require_thread()
        return self._player

    def _carry(self, command):
        self.local()
        return to_reply(self._player.Execute(encode(command)))


class Run(Playback):
    """A dspace.Playback whose time the timeline shows and moves; App.open() returns it.

    seek() and step() return at the step; the windows live meanwhile, and the status bar has a button that cancels it
    (dspace.Resource, and the step before stays; also if the user moves the timeline). play() and follow() return at once. Views and cameras whose names begin with
    "viewer:" stay when it moves; other additions to its session are lost when it moves back. movie: its camera key
    frames, as dspace.application.key_frames.KeyFrames."""

    def __init__(self, path, app, check_assets=True):
        self.movie = None
        self._app, self._host = app, app._host
        self._player = _vtk.vtkDspacePlayer()
        self._player.ShareRenderContext(app.session.vtk)
        self._closed = False
        self._opened = False
        self._path, self._checked = os.path.abspath(os.fspath(path)), flag(check_assets, "check_assets", "recording")
        super().__init__(path, check_assets)

    # --- What the player does in place of Python ------------------------------------------------

    def _take_files(self):
        if self._opened:
            require(self._player.Update())
        else:
            self._open()
            self._opened = True

    def _open(self):
        player, name = self._player, os.path.basename(self._path)
        player.BeginOpen(os.fsencode(self._path), self._checked)
        state = player.WaitForOpen(PATIENCE)
        if state == 0:
            task = self._app._add_task(player.Close)
            self._host.task(task, f"Reading {name}", -1.0, "Cancel")
            try:
                while state == 0:
                    if not self._host.breathe():
                        player.Close()
                    state = player.WaitForOpen(SLICE)
            finally:
                self._host.task(task, "", 0.0, "")
                self._app._tasks.pop(task, None)
        reply = player.TakeReply()
        if state < 0 and not to_reply(reply).HasField("error"):
            raise Resource(f"{self.file.label}: opening it was cancelled", self.file.label)
        require(reply)

    def _make_session(self):
        made = Session.__new__(Session)
        made._client = PlayerClient(self._player)
        return made

    def _go(self, index):
        """In slices, between which the windows live."""
        player, before = self._player, self.index
        require(player.BeginGo(index))
        task, cancelled = None, []
        state = player.ContinueGo(PATIENCE)
        try:
            while state == 0:
                if task is None:
                    task = self._app._add_task(lambda: cancelled.append(True))
                    self._host.task(task, f"Moving in {os.path.basename(self._path)}", -1.0, "Cancel")
                if not self._host.breathe() or cancelled:
                    raise Resource(f"{self.file.label}: the movement was cancelled", self.file.label)
                state = player.ContinueGo(SLICE)
            require(player.TakeReply())
        except BaseException:
            if not self._closed:
                self._return_to(before)
            raise
        finally:
            if task is not None:
                self._host.task(task, "", 0.0, "")
                self._app._tasks.pop(task, None)
        if self.index != index:
            raise Resource(f"{self.file.label}: the timeline was moved meanwhile", self.file.label)

    def _return_to(self, index):
        """Half of a way may be there."""
        require(self._player.BeginGo(index))
        while self._player.ContinueGo(SLICE) == 0 and self._host.breathe():
            pass

    @property
    def index(self):
        """The present step, from 0."""
        return int(self._player.GetIndex())

    @index.setter
    def index(self, value):
        pass  # the player's

    @property
    def time(self):
        """The time of the present step [s]."""
        return self._player.GetTime()

    # --- The timeline --------------------------------------------------------------------------

    def play(self, speed=1.0, on_step=None, until=None):
        """Plays at `speed` times real time, backward if it is negative, and returns at once."""
        if on_step is not None or until is not None:
            raise Unsupported(f"{self.file.label}: on_step and until hold the windows; accepted: App.every(), which looks at the "
                              "run's time", self.file.label)
        self._host.clock(self._player, "speed", real(speed, "the speed", self.file.label), 0.0)
        self._host.clock(self._player, "play", 1.0, 0.0)

    def pause(self):
        """Stands still."""
        self._host.clock(self._player, "play", 0.0, 0.0)

    def follow(self, following=True):
        """Stays at the end of a recording that is being written."""
        self._host.clock(self._player, "follow", float(flag(following, "following", self.file.label)), 0.0)

    def loop(self, begin=None, end=None):
        """Plays the times from `begin` to `end` [s] again and again; without them, no longer."""
        if (begin is None) != (end is None):
            reject(self.file.label, "the loop", (begin, end), "two times, or none")
        if begin is None:
            self._host.clock(self._player, "unloop", 0.0, 0.0)
        else:
            self._host.clock(self._player, "loop", real(begin, "begin", self.file.label),
                             real(end, "end", self.file.label))

    # --- Views ---------------------------------------------------------------------------------

    def own_views(self, taken=()):
        """Makes a view of one's own for each viewport of the present step, which looks through the recorded camera
        until it is moved. taken: names that they must not have. Returns the viewports by the names of the recorded
        ones."""
        made = {}
        for name in self.session.viewports:
            if name.startswith(OWN):  # of the one who recorded
                made[name] = self.session.viewports[name]
                continue
            own, number = OWN + name, 1
            while own in taken:
                number += 1
                own = f"{OWN}{name} {number}"
            require(self._player.CopyViewport(name, own))
            made[name] = self.session.viewports[own]
        return made

    def close(self):
        """Closes its views and ends the playback. A second call does nothing."""
        if not self._closed:
            self._closed = True
            self._app._closed(self)
            self._host.forget(self._player)
            super().close()
            self._player.Close()
