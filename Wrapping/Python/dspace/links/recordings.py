"""A recording, in this process, of a session in a server process."""
import atexit
import os
import sys
import threading
import time
import weakref

from dspace import vtk as _vtk
from dspace._core.fields import flag
from dspace._core.replies import warn
from dspace._core.signals import SLICE, check_signals
from dspace.errors import AlreadyExists, Error, Unsupported
from dspace.links.connection import make_connection
from dspace.recording.file import path_of
from dspace.recording.recording import COUNTS, Recording, checked_time, new_file

SOON = 5.0  # longest wait [s] at the end of the program, or of a block that Ctrl-C left

_active = weakref.WeakSet()  # the recordings that the end of the program must stop


class ServedRecording(Recording):
    """A recording returned by RemoteSession.record(). A watcher of the same server receives the commands and writes
    them in a separate thread. The session's next command reports failures as warnings."""

    def __init__(self, client, path, commit_every, pack=False):
        if client.recording is not None and client.recording.active:
            raise AlreadyExists(f"recording {path_of(path)!r}: the session records into {client.recording.path!r}; "
                                "accepted: one recording at a time", "recording")
        self.path = path = new_file(path)
        every, pack = checked_time(commit_every, path), flag(pack, "pack", "recording")
        self._client = client
        self._process = os.getpid()
        self._last = None
        self._failure, self._told, self._missing = "", False, []
        client.pipelines.update()
        client.flush()  # the recording begins with the effect of all commands sent so far
        self._recorder = client.prepared(_vtk.vtkDspaceRecorder())
        try:
            make_connection(self._recorder, client.address, client.name)
            self._recorder.BeginRecord(path, every, pack)
            while (begun := self._recorder.WaitForRecord(SLICE)) == 0:
                check_signals()
        except BaseException:
            self._recorder = None  # destroys it, which ends the recording
            raise
        if begun < 0:
            problem = self._recorder.GetRecordingFailure()
            self._recorder = None
            self._raise(problem)
        client.recording = self
        _active.add(self)

    def _open(self):
        if os.getpid() != self._process:
            raise Unsupported(f"recording {self.path!r}: process {self._process} records it, and this one is its "
                              "child; accepted: a new session in this process", "recording")
        self._client.require_thread()
        return self._recorder

    @property
    def active(self):
        """Whether commands are still recorded. False after stop() or a failure, and in a child process."""
        return self._last is None and os.getpid() == self._process and not self.failure

    @property
    def counts(self):
        """A dict: accepted commands, written commands (they survive the death of this process), their bytes,
        snapshots. The counts are at most 0.1 s old."""
        return dict(self._last) if self._last is not None else self._counts(self._open())

    @property
    def failure(self):
        """Why the recording failed; empty if it did not."""
        return self._failure if self._last is not None else self._open().GetRecordingFailure()

    def take_warnings(self):
        """Returns the texts of the warnings since the last call."""
        warnings = []
        while self._last is None and (text := self._recorder.TakeWarnings()):
            warnings.append(text)
        self._told = self._told or bool(warnings and self._recorder.GetRecordingFailure())
        return warnings

    def flush(self):
        """Waits until every command that the server has confirmed to this session is written. Raises dspace.Io."""
        if self._last is not None:
            return
        recorder = self._open()
        rejected = self._settle(None)
        problem = self._catch_up(recorder, None)
        recorder.BeginFlush()
        while not recorder.WaitForFlush(SLICE):
            check_signals()
        self._raise(recorder.GetRecordingFailure() or problem)
        if rejected is not None:
            raise rejected

    def stop(self):
        """Waits for every command that the server has confirmed to this session, writes it and closes the file. The
        wait ends when nothing arrives for the session's timeout; then some commands are missing and dspace.Io is
        raised. A second call does nothing."""
        if self._last is None:
            self._open()
            try:
                self._client.pipelines.update()
            finally:
                self._stop(None)

    def __exit__(self, kind, *exception):
        if kind is None:
            self.stop()
        else:  # keep the exception that is in flight, and wait only briefly after Ctrl-C
            self.finish(None if issubclass(kind, Exception) else SOON)

    def finish(self, limit=None):
        """Stops as stop() does, within `limit` seconds. Failures are warnings. Does nothing in a child process."""
        if self._last is not None or os.getpid() != self._process:
            return
        for warning in self.take_warnings():
            warn(warning)
        try:
            self._stop(limit)
        except Error as error:
            if not (self._failure and self._told):
                warn(str(error))

    def _stop(self, limit):
        recorder, problem, rejected = self._recorder, "", None
        end = None if limit is None else time.monotonic() + limit
        try:
            rejected = self._settle(end)
            problem = self._catch_up(recorder, end)
        finally:
            self._close(recorder)
        if self._client.sequence == 0 < recorder.GetSequence():
            warn(f"recording {self.path!r}: the server does not number what it has done (Reply.sequence), so that its "
                 "last commands may be missing")
        if self._missing:
            warn(f"recording {self.path!r}: files that could not be packed: " + ", ".join(self._missing))
        self._raise(self._failure or problem)
        if rejected is not None:
            raise rejected

    def _settle(self, end):
        """Waits until the number of the last command is known. Returns the error of an earlier command, or None."""
        try:
            self._client.settle(end)
        except Error as error:
            return None if self._client.broken() else error  # the session's next command reports a broken connection
        return None

    def _catch_up(self, recorder, end):
        """Waits for the last command. Returns which commands are missing, or ""."""
        wanted, have = self._client.sequence, -1
        while (state := recorder.WaitFor(wanted, SLICE)) == 0:
            check_signals()
            now = time.monotonic()
            if recorder.GetSequence() != have:
                have, patience = recorder.GetSequence(), now + self._client.timeout
            if now > patience or (end is not None and now > end):
                break
        if state == 1:
            return ""
        return (f"recording {self.path!r}: {wanted - recorder.GetSequence()} commands that the server had done have "
                "not come from it; what was recorded stays")

    def _close(self, recorder):
        recorder.BeginStop()
        try:
            while not recorder.WaitForStop(SLICE):
                check_signals()
        finally:
            _active.discard(self)
            self._failure = recorder.GetRecordingFailure()
            self._missing = recorder.GetRecordingMissing().splitlines()
            self._last = self._counts(recorder)

    @staticmethod
    def _counts(recorder):
        return {name: recorder.GetRecordingCount(name) for name in COUNTS}

    def _end_with_program(self):
        if self._last is not None or os.getpid() != self._process:
            return
        end = time.monotonic() + SOON
        try:
            if threading.get_ident() == self._client.thread:
                self._settle(end)
            problem = self._catch_up(self._recorder, end)
            self._close(self._recorder)
            problem = self._failure or problem
        except KeyboardInterrupt:
            problem = f"recording {self.path!r}: interrupted; what was recorded stays"
        if problem:
            print(f"dspace: {problem}", file=sys.stderr)


@atexit.register
def _end_all():
    for recording in list(_active):
        recording._end_with_program()
