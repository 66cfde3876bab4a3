"""Draws the pictures of a movie on the workers of a Dask scheduler (Debian: python3-distributed)."""
import contextlib
import functools
import hashlib
import os
import socket
import subprocess
import tempfile

from dspace import __version__
from dspace._core import dask_client
from dspace._core.files import atomic_write
from dspace._core.png import is_whole
from dspace.errors import Internal, InvalidArgument
from dspace.movies.folder import FRAME, SCRIPT, files_of, states_of
from dspace.movies.make import finish, worker

_AT_ONCE = 24  # largest number of pictures in one request to a worker


def share(scheduler, words, run, missing, folder, tell):
    """Lets the workers of the scheduler at that address draw the pictures `missing`. Raises dspace.Io if no scheduler
    answers, or if it has no worker, for 30 s."""
    with dask_client.connected(scheduler) as client:
        size = max(1, min(_AT_ONCE, -(-len(missing) // max(1, dask_client.workers(client)))))
        parts = [missing[k:k + size] for k in range(0, len(missing), size)]
        expected = fingerprint(run)
        left = len(missing)
        with contextlib.closing(dask_client.results(client, scheduler, pictures,
                                                    [(words, run, part, expected) for part in parts])) as drawings:
            for drawn in drawings:
                for number, data in drawn:
                    path = folder.path(FRAME % number)
                    atomic_write(path, data)
                    if not is_whole(path):
                        raise Internal(f"picture {number} from the scheduler {scheduler!r} is damaged")
                left -= len(drawn)
                tell(left)
                del drawn


def fingerprint(run):
    """Returns Dspace's version and a hash of the run's files. They differ if another machine has another run at the
    same path. Playback compares the files that a recording names; this hash leaves them out."""
    return __version__, _content(tuple(map(tuple, states_of(files_of(run)))))


@functools.lru_cache(maxsize=16)
def _content(states):
    """Returns a hash of the files' contents, cached until a file's size or time of change differs."""
    hashed = hashlib.sha256()
    for path, size, _ in states:
        hashed.update(f"{os.path.basename(path)} {size} ".encode(errors="replace"))
        with open(path, "rb") as file:
            for block in iter(lambda: file.read(1 << 20), b""):
                hashed.update(block)
    return hashed.hexdigest()


def pictures(words, run, numbers, expected):
    """Runs on a worker. Returns [(number, the bytes of its PNG)]. A separate process draws, because a graphics
    context can be used from one thread only."""
    if fingerprint(run) != expected:
        raise InvalidArgument(f"run {run!r}: the worker {socket.gethostname()!r} has another file at this path, or "
                              f"another version of Dspace than {expected[0]}; accepted: the same on each machine, "
                              "and no recording that is still written", run)
    with tempfile.TemporaryDirectory(prefix="dspace-movie-") as folder:
        script = os.path.join(folder, SCRIPT)
        atomic_write(script, words.encode())
        process = worker(script, run, folder, numbers)
        try:
            finish(process)
        except subprocess.SubprocessError:
            process.kill()
            raise
        out = []
        for number in numbers:
            with open(os.path.join(folder, FRAME % number), "rb") as file:
                out.append((number, file.read()))
        return out
