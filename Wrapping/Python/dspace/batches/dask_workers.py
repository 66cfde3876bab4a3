"""Makes the pieces of a batch on the workers of a Dask scheduler (Debian: python3-distributed)."""
import contextlib
import functools
import hashlib
import os
import re
import socket
import subprocess
import tempfile

from dspace import __version__
from dspace._core import dask_client
from dspace._core.files import atomic_write
from dspace._core.fields import reject, text
from dspace.batches.kinds import Batch, kind_of
from dspace.batches.folder import Folder
from dspace.batches.processes import finish, worker
from dspace.batches.runs import files_of, states_of
from dspace.errors import Internal, InvalidArgument

_AT_ONCE = 24  # largest number of pieces in one request to a worker


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
    with dask_client.connected(scheduler) as client:
        size = max(1, min(_AT_ONCE, -(-len(missing) // max(1, dask_client.workers(client)))))
        parts = [missing[k:k + size] for k in range(0, len(missing), size)]
        expected = fingerprint(run)
        left = len(missing)
        calls = [(words, run, part, expected, module) for part in parts]
        with contextlib.closing(dask_client.results(client, scheduler, pictures, calls)) as drawings:
            for drawn in drawings:
                for number, files in drawn:
                    for name, data in files:
                        atomic_write(folder.path(name), data)
                    if not folder.kind.whole(folder.folder, number):
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
