"""The folder of a batch's pieces, which identifies the batch and the run."""
import fcntl
import hashlib
import json
import os
import re

from dspace import __version__
from dspace._core.files import atomic_write
from dspace.batches.runs import absolute, assets_of, file_of, files_of, states_of
from dspace.errors import Error, InvalidArgument, Io, Resource

_PART = r"\.[0-9a-f]{16}\.part"


def identity(batch, run):
    """Returns a hash that identifies a Batch of a run: of its text, its settings and the run's files."""
    state = {batch.kind.noun: batch.text, **batch.settings, "dspace": __version__}
    if isinstance(run, (str, os.PathLike)):
        name = os.fspath(run)
        try:
            os.stat(file_of(name)[0])
        except OSError as error:
            raise Io(f"run {name!r}: {error.strerror}; accepted: a file that can be read", name) from None
        name = absolute(name)
        state["run"] = [name, states_of(files_of(name)), states_of(assets_of(name))]
    return hashlib.sha256(json.dumps(state, sort_keys=True, default=str).encode(errors="replace")).hexdigest()


class Folder:
    """The folder of a Batch. One process at a time can use it. redraw: makes all pieces again."""

    def __init__(self, folder, batch, run, redraw=False):
        self.folder, self.batch, self.run, self.redraw = folder, batch, run, redraw
        self.kind = kind = batch.kind
        noun, script = re.escape(kind.noun), re.escape(kind.script)
        files = re.escape(kind.prefix).replace("%06d", r"\d{6,}") + kind.endings
        self._pieces = re.compile(files)
        self._of_piece = re.compile(rf"({files}|{script}|{noun}\.json)|"
                                    rf"\.({files}|{script}|{noun}\.json){_PART}|{noun}\.lock")
        # Left by a process that was killed as it started.
        self._begun = re.compile(rf"\.{noun}\.json{_PART}|{noun}\.lock")

    @property
    def _mark(self):
        return f"pictures of a dspace {self.kind.noun}"

    def path(self, name):
        return os.path.join(self.folder, name)

    def __enter__(self):
        try:
            os.makedirs(self.folder, exist_ok=True)
            names = sorted(os.listdir(self.folder))
            other = [name for name in names if not self._begun.fullmatch(name)]
            if other and self._state() is None:
                raise InvalidArgument(f"folder {self.folder!r}: it holds {other[0]!r} and belongs to no {self.kind.noun}; "
                                      f"accepted: an empty folder, a new one, or a {self.kind.noun}'s", self.folder)
            self._lock = open(self.path(f"{self.kind.noun}.lock"), "w")
            fcntl.flock(self._lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise Resource(f"folder {self.folder!r}: another process makes a {self.kind.noun} in it; accepted: another "
                           "folder, or to wait", self.folder) from None
        except OSError as error:
            if isinstance(error, Error):
                raise
            raise Io(f"folder {self.folder!r}: {error.strerror}; accepted: one that may be written",
                     self.folder) from None
        try:
            self._begin()
        except BaseException:
            self._lock.close()
            raise
        return self

    def _state(self):
        """Returns the contents of its state file, or None if the folder belongs to no such batch."""
        try:
            with open(self.path(f"{self.kind.noun}.json"), encoding="utf-8") as file:
                state = json.load(file)
        except (OSError, ValueError):
            return None
        return state if isinstance(state, dict) and state.get("kind") == self._mark and "hash" in state else None

    def _begin(self):
        # A run that is not a file has no identity that lasts, so its pieces are always made again.
        lasting = isinstance(self.run, (str, os.PathLike))
        now = identity(self.batch, self.run) if lasting else None
        before = self._state()
        if self.redraw or now is None or before is None or before["hash"] != now:
            self._say(None)
            for name in self._ours():
                if self._pieces.fullmatch(name):
                    os.unlink(self.path(name))
            atomic_write(self.path(self.kind.script), self.batch.text.encode())
            self._say(now)
        for name in self._ours():
            if name.endswith(".part"):  # left by a process that was killed
                os.unlink(self.path(name))

    def _say(self, state):
        atomic_write(self.path(f"{self.kind.noun}.json"), json.dumps({"kind": self._mark, "hash": state}).encode())

    def _ours(self):
        return [name for name in os.listdir(self.folder) if self._of_piece.fullmatch(name)]

    def __exit__(self, *exception):
        self._lock.close()

    def missing(self, total):
        return [number for number in range(total) if not self.kind.whole(self.folder, number)]

    def files(self, number):
        """The names of the files of a piece, in the order in which they are written."""
        prefix = self.kind.prefix % number
        return sorted((name for name in os.listdir(self.folder)
                       if name.startswith(prefix) and self._pieces.fullmatch(name)),
                      key=lambda name: (name == self.kind.last(number), name))

    def remove(self):
        for name in self._ours():
            os.unlink(self.path(name))
        try:
            os.rmdir(self.folder)
        except OSError:  # it holds other files
            pass
