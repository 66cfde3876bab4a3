"""The control of a recording of a session."""
import os

from dspace._core.fields import flag, number
from dspace._core.replies import warn
from dspace.errors import AlreadyExists, InvalidArgument, Io, NotFound
from dspace.recording.file import path_of

COUNTS = ("accepted", "written", "bytes", "snapshots")


def new_file(path):
    """The absolute path of a new recording. Raises an error if the file exists or its folder does not."""
    path = path_of(path)
    if os.path.lexists(path):
        raise AlreadyExists(f"recording {path!r}: there is such a file; accepted: a new one", "recording")
    if not os.path.isdir(os.path.dirname(path)):
        raise NotFound(f"recording {path!r}: there is no such folder", "recording")
    return path


def checked_time(commit_every, path):
    every = number(commit_every, "the time from commit to commit", "recording")
    if not 0.001 <= every <= 60:
        raise InvalidArgument(f"recording {path!r}: commit_every is {every!r} s; accepted: 0.001 to 60", "recording")
    return every


class Recording:
    """A recording in progress, returned by Session.record(). `counts` has its size."""

    def __init__(self, client, path, commit_every, pack=False):
        self._client = client
        client.local()
        self._last = None
        if client.recording is not None and client.recording.active:
            raise AlreadyExists(f"recording {path_of(path)!r}: the session records into {client.recording.path!r}; "
                                "accepted: one recording at a time", "recording")
        self.path = path = new_file(path)
        every = checked_time(commit_every, path)
        client.pipelines.update()
        self._raise(client.local().Record(path, every, flag(pack, "pack", "recording")))
        client.recording = self
        for warning in filter(None, client.local().GetRecordingLeftOut().split("\n")):
            warn(warning)

    def _raise(self, problem):
        if problem:
            name = f"recording {self.path!r}"
            raise Io(problem if problem.startswith("recording ") else f"{name}: {problem}", name)

    def __enter__(self):
        return self

    def __exit__(self, *exception):
        if os.getpid() == self._client.process:  # a child of a fork leaves the file to its parent
            self.stop()

    @property
    def active(self):
        """Whether commands are still recorded: not after stop() or a failure."""
        return self._last is None and self._client.vtk is not None and not self.failure

    @property
    def counts(self):
        """A dict: accepted commands, written commands (they survive the death of this process), their bytes, snapshots."""
        if self._last is not None:
            return dict(self._last)
        return {name: self._client.local().GetRecordingCount(name) for name in COUNTS}

    @property
    def failure(self):
        """Why the recording failed; empty if it did not."""
        return self._client.vtk.GetRecordingFailure() if self._last is None and self._client.vtk else ""

    def flush(self):
        """Waits until all accepted commands are written."""
        if self._last is None:
            self._raise(self._client.local().FlushRecording())

    def stop(self):
        """Writes the remaining commands and closes the file. A second call does nothing."""
        if self._last is not None or self._client.vtk is None:
            return
        try:
            self._client.pipelines.update()
        finally:
            self._end()

    def _end(self):
        problem = self._client.local().StopRecording()
        self._last = {name: self._client.local().GetRecordingCount(name) for name in COUNTS}
        missing = self._client.local().GetRecordingMissing()
        if missing:
            warn(f"recording {self.path!r}: files that could not be packed: " + ", ".join(missing.split("\n")))
        self._raise(problem)

    def __repr__(self):
        return f"<dspace.Recording {self.path!r}>"
