"""The folder of a movie's pictures, which identifies the movie and the run."""
import fcntl
import hashlib
import json
import os
import re

from dspace import __version__
from dspace._core.files import atomic_write
from dspace._core.png import is_whole
from dspace.errors import Error, InvalidArgument, Io, Resource

FRAME = "frame_%06d.png"
SCRIPT = "movie.toml"
_STATE, _LOCK = "movie.json", "movie.lock"
_KIND = "pictures of a dspace movie"
_FILES, _PART = r"(frame_\d{6,}\.png|movie\.toml|movie\.json)", r"\.[0-9a-f]{16}\.part"
_OURS = re.compile(rf"{_FILES}|\.{_FILES}{_PART}|movie\.lock")
_BEGUN = re.compile(rf"\.movie\.json{_PART}|movie\.lock")  # left by a process that was killed as it started


# --- Runs ------------------------------------------------------------------------------------------

def file_of(run):
    """Returns the file of a run, and the function's name if the run is FILE.py:NAME, "" otherwise."""
    script, _, function = run.rpartition(":")
    return (script, function) if script.endswith(".py") and function.isidentifier() else (run, "")


def absolute(run):
    """Returns the run with an absolute path, for a process in another folder."""
    file, function = file_of(os.fspath(run))
    return os.path.abspath(file) + (f":{function}" if function else "")


def files_of(run):
    """Returns the files that a run consists of: a recording and its SQLite log, or a program and the modules and
    packages in its folder."""
    file, function = file_of(run)
    if not function:
        log = file + "-wal"
        return [file] + ([log] if os.path.exists(log) and os.path.getsize(log) else [])
    folder, found = os.path.dirname(os.path.abspath(file)), []
    for at, folders, names in os.walk(folder):
        folders[:] = sorted(each for each in folders if os.path.exists(os.path.join(at, each, "__init__.py")))
        found += [os.path.join(at, name) for name in sorted(names) if name.endswith(".py")]
    return found


def _assets_of(run):
    """Returns the paths of the files that a recording's commands name."""
    file, function = file_of(run)
    if function:
        return []
    from dspace.recording.file import RecordingFile
    try:
        with RecordingFile(file) as recording:
            return sorted(asset.path for asset in recording.assets)
    except Error:  # not a recording, or damaged; opening it to draw reports the error
        return []


def states_of(paths):
    """Returns [path, size, time of the last change] of each file. Each write to a file changes them."""
    out = []
    for path in paths:
        try:
            status = os.stat(path)
            out.append([path, status.st_size, status.st_mtime_ns])
        except OSError:
            out.append([path, None, None])
    return out


def identity(movie, run):
    """Returns a hash that identifies a movie of a run: of its text, its settings and the run's files."""
    state = {"movie": movie.text, "size": movie.size, "samples": movie.samples, "rate": movie.rate,
             "frames": movie.frames, "dspace": __version__}
    if isinstance(run, (str, os.PathLike)):
        name = os.fspath(run)
        try:
            os.stat(file_of(name)[0])
        except OSError as error:
            raise Io(f"run {name!r}: {error.strerror}; accepted: a file that can be read", name) from None
        name = absolute(name)
        state["run"] = [name, states_of(files_of(name)), states_of(_assets_of(name))]
    return hashlib.sha256(json.dumps(state, sort_keys=True, default=str).encode(errors="replace")).hexdigest()


# --- The folder ------------------------------------------------------------------------------------

class Folder:
    """The folder of a movie's pictures. One make() at a time can use it. redraw: draws all pictures again."""

    def __init__(self, folder, movie, run, redraw=False):
        self.folder, self.movie, self.run, self.redraw = folder, movie, run, redraw

    def path(self, name):
        return os.path.join(self.folder, name)

    def __enter__(self):
        try:
            os.makedirs(self.folder, exist_ok=True)
            names = sorted(os.listdir(self.folder))
            other = [name for name in names if not _BEGUN.fullmatch(name)]
            if other and self._state() is None:
                raise InvalidArgument(f"folder {self.folder!r}: it holds {other[0]!r} and belongs to no movie; "
                                      "accepted: an empty folder, a new one, or a movie's", self.folder)
            self._lock = open(self.path(_LOCK), "w")
            fcntl.flock(self._lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise Resource(f"folder {self.folder!r}: another process makes a movie in it; accepted: another "
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
        """Returns the contents of its state file, or None if the folder does not belong to a movie."""
        try:
            with open(self.path(_STATE), encoding="utf-8") as file:
                state = json.load(file)
        except (OSError, ValueError):
            return None
        return state if isinstance(state, dict) and state.get("kind") == _KIND and "hash" in state else None

    def _begin(self):
        # A run that is not a file has no identity that lasts, so its pictures are always drawn again.
        lasting = isinstance(self.run, (str, os.PathLike))
        now = identity(self.movie, self.run) if lasting else None
        before = self._state()
        if self.redraw or now is None or before is None or before["hash"] != now:
            self._say(None)
            for name in self._ours():
                if name.startswith("frame_"):
                    os.unlink(self.path(name))
            atomic_write(self.path(SCRIPT), self.movie.text.encode())
            self._say(now)
        for name in self._ours():
            if name.endswith(".part"):  # left by a process that was killed
                os.unlink(self.path(name))

    def _say(self, state):
        atomic_write(self.path(_STATE), json.dumps({"kind": _KIND, "hash": state}).encode())

    def _ours(self):
        return [name for name in os.listdir(self.folder) if _OURS.fullmatch(name)]

    def __exit__(self, *exception):
        self._lock.close()

    def missing(self, total):
        return [number for number in range(total) if not is_whole(self.path(FRAME % number))]

    def remove(self):
        for name in self._ours():
            os.unlink(self.path(name))
        try:
            os.rmdir(self.folder)
        except OSError:  # it holds other files
            pass
