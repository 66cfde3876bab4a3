"""Makes the pieces of a batch on the workers of a Dask scheduler (Debian: python3-distributed)."""
import contextlib
import functools
import hashlib
import os
import re
import socket
import subprocess
import tempfile
import time as clock

from dspace import __version__
from dspace._core.files import atomic_write
from dspace._core.fields import reject, text
from dspace.batches.kinds import Batch, kind_of
from dspace.batches.folder import Folder
from dspace.batches.processes import finish, worker
from dspace.batches.runs import files_of, states_of
from dspace.errors import Error, Internal, InvalidArgument, Io, NotFound

_AT_ONCE = 24  # largest number of pieces in one request to a worker
_TO_CONNECT = 30.0  # seconds
_PATIENCE = 30.0  # seconds without a scheduler or a worker


def require_address(scheduler, about):
    """Raises dspace.InvalidArgument for a malformed address; Dask would wait for such a scheduler until its timeout."""
    address = re.fullmatch(r"(tcp|tls)://(\[[0-9A-Fa-f:.]+\]|[^\s:/\[\]]+):([0-9]{1,5})",
                           text(scheduler, "the scheduler", about))
    if not address or not 1 <= int(address[3]) <= 65535:
        reject(about, "the scheduler", scheduler, "tcp://HOST:PORT or tls://HOST:PORT, of a Dask scheduler")


def share(scheduler, run, missing, folder, tell):
    """Lets the workers of the scheduler at that address make the pieces `missing` of a Folder's batch. Raises dspace.Io if no
    scheduler answers, or if it has no worker, for 30 s."""
    words, module = folder.batch.text, folder.kind.module
    try:
        from distributed import Client
    except ImportError:
        raise NotFound("Dask is not installed; accepted: Debian's package python3-distributed",
                       "python3-distributed") from None
    _require_listener(scheduler)
    try:
        client = Client(scheduler, timeout=_TO_CONNECT, set_as_default=False)
    except (OSError, ValueError, TimeoutError) as error:
        raise Io(f"scheduler {scheduler!r}: {error}; accepted: the address of a Dask scheduler, tcp://HOST:PORT",
                 scheduler) from None
    with client:
        end = clock.monotonic() + _PATIENCE
        while not _workers(client):
            if clock.monotonic() > end:
                raise _without_workers(scheduler)
            clock.sleep(0.1)
        size = max(1, min(_AT_ONCE, -(-len(missing) // max(1, _workers(client)))))
        parts = [missing[k:k + size] for k in range(0, len(missing), size)]
        expected = fingerprint(run)
        waiting = [client.submit(pictures, words, run, part, expected, module, pure=False) for part in parts]
        try:
            left = len(missing)
            for drawn in _finished(client, scheduler, waiting):
                for number, files in drawn:
                    for name, data in files:
                        atomic_write(folder.path(name), data)
                    if not folder.kind.whole(folder.folder, number):
                        raise Internal(f"picture {number} from the scheduler {scheduler!r} is damaged")
                left -= len(drawn)
                tell(left)
        finally:
            with contextlib.suppress(OSError, RuntimeError):  # the scheduler has stopped
                client.cancel(waiting)


def _require_listener(scheduler):
    """Waits until the address accepts a connection, for up to 30 s. A Dask client that never connected prints several
    lines when it ends; this check avoids them."""
    host, _, port = scheduler.partition("://")[2].rpartition(":")
    end = clock.monotonic() + _TO_CONNECT
    while True:
        try:
            socket.create_connection((host.strip("[]"), int(port)), timeout=_TO_CONNECT).close()
            return
        except OSError as error:
            if clock.monotonic() > end or isinstance(error, socket.gaierror):
                raise Io(f"scheduler {scheduler!r}: {error}; accepted: the address of a Dask scheduler, "
                         "tcp://HOST:PORT", scheduler) from None
            clock.sleep(0.1)


def _workers(client):
    try:
        return len(client.scheduler_info()["workers"]) if client.status == "running" else 0
    except (OSError, RuntimeError):  # the scheduler has stopped
        return 0


def _without_workers(scheduler):
    return Io(f"scheduler {scheduler!r}: it has had no worker for {_PATIENCE:g} s, or has stopped; accepted: one with "
              "a worker (dask worker ADDRESS)", scheduler)


def _finished(client, scheduler, waiting):
    """Yields the results in the order of completion. Each is removed from `waiting`, so that no worker keeps it."""
    from distributed import CancelledError
    seen = clock.monotonic()  # the last time at which there was a worker
    while waiting:
        done = [future for future in waiting if future.done()]
        for future in done:
            try:
                drawn = future.result(timeout=4 * _PATIENCE)
            except TimeoutError:  # its worker died before it sent the result; another worker draws it again
                continue
            except Error:
                raise
            except CancelledError:  # the scheduler has stopped
                raise _without_workers(scheduler) from None
            except Exception as error:  # an error inside Dask
                raise Io(f"scheduler {scheduler!r}: {type(error).__name__}: {error}", scheduler) from None
            waiting.remove(future)
            future.release()
            del future
            yield drawn
            del drawn
        if not done:
            clock.sleep(0.1)
        if _workers(client):
            seen = clock.monotonic()
        elif clock.monotonic() - seen > _PATIENCE:
            raise _without_workers(scheduler)


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


def pictures(words, run, numbers, expected, module):
    """Runs on a worker. Returns [(number, [(name, the file's bytes)])] of pieces of the kind of a module. A separate process
    draws, because a graphics context can be used from one thread only."""
    if fingerprint(run) != expected:
        raise InvalidArgument(f"run {run!r}: the worker {socket.gethostname()!r} has another file at this path, or "
                              f"another version of Dspace than {expected[0]}; accepted: the same on each machine, "
                              "and no recording that is still written", run)
    kind = kind_of(module)
    with tempfile.TemporaryDirectory(prefix="dspace-batch-") as folder:
        made = Folder(folder, Batch(kind, words), run)
        script = made.path(kind.script)
        atomic_write(script, words.encode())
        process = worker(kind, script, run, folder, numbers)
        try:
            finish(process)
        except subprocess.SubprocessError:
            process.kill()
            raise
        return [(number, [(name, _bytes(made.path(name))) for name in made.files(number)]) for number in numbers]


def _bytes(path):
    with open(path, "rb") as file:
        return file.read()
