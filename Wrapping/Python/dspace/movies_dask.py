"""Pictures of a movie drawn by the workers of a Dask scheduler (Debian: python3-distributed)."""
import hashlib
import os
import socket
import subprocess
import tempfile

import dspace
from dspace.errors import Internal, InvalidArgument, Io, NotFound
from dspace.movies_draw import is_whole
from dspace.movies_make import FRAME, file_of, finish, put, worker

_AT_ONCE = 24  # pictures that a worker draws of one request
_END = 1 << 20  # bytes of either end of a run's file that are compared


def share(scheduler, words, run, missing, folder, tell):
    """Has the pictures `missing` drawn by the workers of the scheduler at that address."""
    try:
        from distributed import Client, as_completed
    except ImportError:
        raise NotFound("Dask is not installed; accepted: Debian's package python3-distributed",
                       "python3-distributed") from None
    try:
        client = Client(scheduler, timeout=30, set_as_default=False)
    except (OSError, ValueError, TimeoutError) as error:
        raise Io(f"scheduler {scheduler!r}: {error}; accepted: the address of a Dask scheduler, tcp://HOST:PORT",
                 scheduler) from None
    with client:
        workers = max(1, len(client.scheduler_info()["workers"]))
        size = max(1, min(_AT_ONCE, -(-len(missing) // workers)))
        parts = [missing[k:k + size] for k in range(0, len(missing), size)]
        expected = fingerprint(run)
        futures = [client.submit(pictures, words, run, part, expected, pure=False) for part in parts]
        left = len(missing)
        try:
            for _, drawn in as_completed(futures, loop=client.loop, with_results=True):
                for number, data in drawn:
                    path = folder.path(FRAME % number)
                    put(path, data)
                    if not is_whole(path):
                        raise Internal(f"picture {number} came damaged from the scheduler {scheduler!r}")
                left -= len(drawn)
                tell(left)
        finally:
            client.cancel(futures)


def fingerprint(run):
    """What tells a run's file from another one of its path: Dspace's version, its size, its ends."""
    path, _ = file_of(run)
    with open(path, "rb") as file:
        size = file.seek(0, os.SEEK_END)
        ends = hashlib.sha256()
        for at in (0, max(0, size - _END)):
            file.seek(at)
            ends.update(file.read(_END))
    return dspace.__version__, size, ends.hexdigest()


def pictures(words, run, numbers, expected):
    """[(number, the bytes of its PNG)], on a worker; in a process of its own, since a graphics context
    serves one thread."""
    if fingerprint(run) != expected:
        raise InvalidArgument(f"run {run!r}: on the worker {socket.gethostname()!r} it is another file, or Dspace "
                              f"another version than {expected[0]}; accepted: the same on each machine", run)
    with tempfile.TemporaryDirectory(prefix="dspace-movie-") as folder:
        script = os.path.join(folder, "movie.toml")
        with open(script, "w", encoding="utf-8") as file:
            file.write(words)
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
