"""Making a movie: which pictures are still missing, who draws them, and the file of all.

Every picture is a PNG in a work folder, under its final name only when it is whole, so that what was
drawn before an end of any kind is not drawn again; the folder knows by a hash which movie of which run it
is of. All ways of sharing the work give the same pictures.
"""
import fcntl
import hashlib
import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time as clock

import dspace
from dspace._fields import integers, refuse
from dspace.errors import Error, InvalidArgument, Io, Resource
from dspace.movies_draw import Stage, is_whole, open_run, png
from dspace.movies_encode import codec_of, encode

FRAME = "frame_%06d.png"
_SCRIPT, _STATE, _LOCK = "movie.toml", "movie.json", "movie.lock"


def make(movie, run, out, jobs=1, scheduler=None, work=None, keep=False, progress=None):
    """Draws a Movie of a run into `out`: .mp4 (H.264), .webm (VP9), or a folder of PNGs.

    run: a recording's path, "FILE.py:NAME", or what dspace.movies_draw.open_run takes else (then jobs is 1).
    jobs: processes that share the pictures; scheduler: a Dask scheduler's address ("tcp://..."), whose
    workers do, where `run` has the same path on their machines. work: the folder for pictures (default: `out`
    with ".work", removed at the end unless `keep`; of a folder of PNGs `out` itself). An earlier make() of
    the same movie that was ended is gone on with. progress: called with (done, all, seconds so far, drawn
    in them). Returns the number of pictures drawn now."""
    total = movie.check()
    codec = codec_of(out, movie.size)
    jobs = integers((jobs,), 1, "jobs", "movie", "an integer from 1 to 64")[0]
    if not 1 <= jobs <= 64:
        refuse("movie", "jobs", jobs, "an integer from 1 to 64")
    out = os.fspath(out)
    work = os.fspath(work) if work is not None else (out if codec is None else out + ".work")
    if not isinstance(run, (str, os.PathLike)) and (jobs > 1 or scheduler):
        refuse("movie", "the run", run, "a recording's path or FILE.py:NAME, where several processes share it")
    with _Folder(work, movie, run) as folder:
        missing = folder.missing(total)
        began = clock.monotonic()

        def tell(left):
            if progress:
                progress(total - left, total, clock.monotonic() - began, len(missing) - left)

        tell(len(missing))
        if missing and scheduler:
            from dspace.movies_dask import share
            share(scheduler, movie.text, os.fspath(run), missing, folder, tell)
        elif missing and jobs > 1:
            _share(os.fspath(run), missing, min(jobs, len(missing)), folder, tell)
        elif missing:
            draw(movie, run, missing, folder.path, tell)
        if codec is not None:
            encode(folder.path(FRAME), out, movie.size, movie.rate)
        elif os.path.abspath(work) != os.path.abspath(out):
            os.makedirs(out, exist_ok=True)
            for number in range(total):
                shutil.copyfile(folder.path(FRAME % number), os.path.join(out, FRAME % number))
    if codec is not None and not keep:
        folder.remove()
    return len(missing)


def draw(movie, run, numbers, path, tell=lambda left: None):
    """Draws the pictures `numbers`, rising, into files path(name), in this process."""
    source = open_run(run)
    try:
        stage = Stage(movie, source)
        for count, number in enumerate(numbers, 1):
            put(path(FRAME % number), png(stage.picture(number)))
            tell(len(numbers) - count)
    finally:
        if source is not run:  # who hands in a Source closes it
            source.close()


def put(path, data):
    """A file that is there as a whole or not at all."""
    part = f"{path}.{os.getpid()}.part"
    try:
        with open(part, "wb") as file:
            file.write(data)
        os.replace(part, path)
    except OSError as error:
        if os.path.exists(part):
            os.unlink(part)
        raise Io(f"file {path!r}: {error.strerror}; accepted: a folder with room, that may be written",
                 path) from None


def identity(movie, run):
    """What tells one movie of one run from all others: a hash of its text, its size and the run's file."""
    state = {"movie": movie.text, "size": movie.size, "samples": movie.samples, "rate": movie.rate,
             "frames": movie.frames, "dspace": dspace.__version__}
    if isinstance(run, (str, os.PathLike)):
        name = os.fspath(run)
        file, function = file_of(name)
        try:
            status = os.stat(file)
        except OSError as error:
            raise Io(f"run {name!r}: {error.strerror}; accepted: a file that can be read", name) from None
        state["run"] = [os.path.abspath(file), function, status.st_size, status.st_mtime_ns]
    return hashlib.sha256(json.dumps(state, sort_keys=True).encode()).hexdigest()


def file_of(run):
    """The file of a run, and the function's name where it is FILE.py:NAME."""
    script, _, function = run.rpartition(":")
    return (script, function) if script.endswith(".py") and function.isidentifier() else (run, "")


class _Folder:
    """The work folder, used by one make() at a time."""

    def __init__(self, folder, movie, run):
        self.folder, self.movie, self.run = folder, movie, run

    def path(self, name):
        return os.path.join(self.folder, name)

    def __enter__(self):
        try:
            os.makedirs(self.folder, exist_ok=True)
            names = [name for name in os.listdir(self.folder) if name != _LOCK]
            if names and _STATE not in names:
                raise InvalidArgument(f"folder {self.folder!r}: it holds {names[0]!r} and is of no movie; accepted: "
                                      "an empty folder, a new one, or a movie's", self.folder)
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
        self._begin()
        return self

    def _begin(self):
        # What no one can state as a file is told apart by nobody: its pictures are always drawn anew.
        lasting = isinstance(self.run, (str, os.PathLike))
        now = identity(self.movie, self.run) if lasting else None
        try:
            with open(self.path(_STATE)) as file:
                before = json.load(file)["hash"]
        except (OSError, ValueError, KeyError, TypeError):
            before = None
        if now is None or before != now:
            for name in os.listdir(self.folder):
                if name.startswith("frame_"):
                    os.unlink(self.path(name))
            put(self.path(_SCRIPT), self.movie.text.encode())
            put(self.path(_STATE), json.dumps({"hash": now}).encode())
        for name in os.listdir(self.folder):
            if name.endswith(".part"):  # of a process that was ended
                os.unlink(self.path(name))

    def __exit__(self, *exception):
        self._lock.close()

    def missing(self, total):
        return [number for number in range(total) if not is_whole(self.path(FRAME % number))]

    def remove(self):
        for name in os.listdir(self.folder):
            if name.startswith("frame_") or name in (_SCRIPT, _STATE, _LOCK):
                os.unlink(self.path(name))
        try:
            os.rmdir(self.folder)
        except OSError:  # somebody keeps something there
            pass


# --- Processes -------------------------------------------------------------------------------------

def worker(script, run, folder, numbers):
    """A process that draws pictures of a movie's file into a folder; see main()."""
    said = tempfile.TemporaryFile()  # a pipe that nobody reads would stop it
    process = subprocess.Popen(
        [sys.executable, "-c", "from dspace.movies_make import main; main()", script, run, folder,
         str(os.getpid())],
        stdin=subprocess.PIPE, stdout=subprocess.DEVNULL, stderr=said,
        env={**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path))})
    process.said = said
    try:  # however many they are
        process.stdin.write(json.dumps(numbers).encode())
        process.stdin.close()
    except BrokenPipeError:  # it has ended; finish() says why
        pass
    return process


def main():
    """python -c "..." SCRIPT RUN FOLDER PARENT, and the pictures' numbers on the input stream."""
    from dspace.movies import Movie
    script, run, folder, parent = sys.argv[1:]
    numbers = json.load(sys.stdin)

    def tell(left):
        if os.getppid() != int(parent):  # nobody waits for the rest
            os.kill(os.getpid(), signal.SIGTERM)

    try:
        draw(Movie.load(script), run, numbers, lambda name: os.path.join(folder, name),
             tell)
    except (Error, OSError) as error:
        sys.exit(f"{error}")


def finish(process):
    """Waits for a worker; raises what it said."""
    process.wait()
    process.said.seek(0)
    message = process.said.read().decode(errors="replace").strip()
    process.said.close()
    if process.returncode != 0:
        words = message.splitlines()[-1] if message else "it said nothing"
        raise Io(f"a process that drew pictures ended with {process.returncode}: {words}")


def _share(run, missing, jobs, folder, tell):
    """Each process draws pictures that follow each other, for a run goes forward."""
    edges = [len(missing) * k // jobs for k in range(jobs + 1)]
    processes = [worker(folder.path(_SCRIPT), run, folder.folder, missing[a:b])
                 for a, b in zip(edges, edges[1:])]
    try:
        left = set(missing)
        while any(process.poll() is None for process in processes):
            if any(process.poll() for process in processes):
                break  # one has failed
            left = {number for number in left if not os.path.exists(folder.path(FRAME % number))}
            tell(len(left))
            clock.sleep(0.2)
        for process in sorted(processes, key=lambda each: not each.poll()):  # those that failed first
            finish(process)
    finally:
        for process in processes:
            if process.poll() is None:
                process.kill()
                process.wait()
    tell(0)
