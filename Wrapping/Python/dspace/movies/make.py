"""Makes a movie: finds the missing pictures, shares their drawing, and encodes the file.

Every picture is a PNG in a work folder. It gets its final name when it is complete, so an interrupted movie
continues without drawing a picture twice. A hash in the folder identifies the movie and the run. All ways of
sharing the work give the same pictures.
"""
import contextlib
import json
import os
import re
import signal
import subprocess
import sys
import tempfile
import time as clock

from dspace._core.fields import integer, path as path_of, reject, text
from dspace._core.files import AtomicFile, atomic_write
from dspace._core.png import png
from dspace.errors import Error, Io
from dspace.movies.draw import Stage, open_run, require_run
from dspace.movies.encode import codec_of, encode, programs
from dspace.movies.folder import FRAME, SCRIPT, Folder, absolute


def make(movie, run, out, jobs=1, scheduler=None, work=None, keep=False, progress=None, encoding=None, redraw=False):
    """Draws a Movie of a run into `out`: .mp4 (H.264), .webm (VP9), or a folder of PNGs (a name without a dot, a name
    with a slash at its end, or an existing folder).

    run: a recording's path, "FILE.py:NAME", or another run that dspace.movies.draw.open_run accepts (then jobs must
    be 1). jobs: number of processes that share the pictures, 1 to 64. scheduler: the address of a Dask scheduler
    (tcp://HOST:PORT, tls://...) whose workers draw the pictures; `run` must have the same path on their machines.
    work: the folder for pictures (default: `out` with ".work", or `out` itself for a folder of PNGs). make() removes
    it after encoding unless `keep`. make() continues an interrupted make() of the same movie; redraw: draws all
    pictures again. progress: called with (pictures done, total, seconds so far, pictures drawn in them). encoding:
    called while the file is written with (pictures in the file, total, seconds so far). Returns the number of
    pictures that this call drew. Raises dspace.Error."""
    total = movie.check()
    codec = codec_of(out, movie.size)
    jobs = integer(jobs, "jobs", "movie", "an integer from 1 to 64")
    if not 1 <= jobs <= 64:
        reject("movie", "jobs", jobs, "an integer from 1 to 64")
    require_run(run)
    if scheduler is not None:
        require_address(scheduler)
    out = os.fspath(out)
    work = path_of(work, "the work folder", "movie") if work is not None else (out if codec is None else out + ".work")
    if isinstance(run, (str, os.PathLike)):
        path_of(run, "the run", "movie", "a recording's path or FILE.py:NAME")
        run = absolute(run)  # workers may have another current folder
    elif jobs > 1 or scheduler:
        reject("movie", "the run", run, "a recording's path or FILE.py:NAME, where several processes share it")
    if codec is not None:  # report a missing program or an unwritable folder before any drawing
        programs()
        _check_place(out)
    with contextlib.ExitStack() as stack:
        folder = stack.enter_context(Folder(work, movie, run, redraw))
        shown = folder
        if codec is None and os.path.realpath(work) != os.path.realpath(out):
            shown = stack.enter_context(Folder(out, movie, run, redraw))
        missing = folder.missing(total)
        began = clock.monotonic()

        def tell(left):
            if progress:
                progress(total - left, total, clock.monotonic() - began, len(missing) - left)

        tell(len(missing))
        with _in_file(movie.label):
            if missing and scheduler:
                from dspace.movies.dask_workers import share
                share(scheduler, movie.text, run, missing, folder, tell)
            elif missing and jobs > 1:
                _share(run, missing, min(jobs, len(missing)), folder, tell)
            elif missing:
                draw(movie, run, missing, folder.path, tell)
        if codec is not None:
            began = clock.monotonic()
            encode(folder.path(FRAME), out, movie.size, movie.rate, total,
                   lambda done: encoding and encoding(done, total, clock.monotonic() - began))
        elif shown is not folder:
            for number in range(total):
                with open(folder.path(FRAME % number), "rb") as file:
                    atomic_write(shown.path(FRAME % number), file.read())
    if codec is not None and not keep:
        folder.remove()
    return len(missing)


def require_address(scheduler):
    """Raises dspace.InvalidArgument for a malformed address; Dask would wait for such a scheduler until its timeout."""
    address = re.fullmatch(r"(tcp|tls)://(\[[0-9A-Fa-f:.]+\]|[^\s:/\[\]]+):([0-9]{1,5})",
                           text(scheduler, "the scheduler", "movie"))
    if not address or not 1 <= int(address[3]) <= 65535:
        reject("movie", "the scheduler", scheduler, "tcp://HOST:PORT or tls://HOST:PORT, of a Dask scheduler")


@contextlib.contextmanager
def _in_file(label):
    """In a `with` statement: adds the movie's file to the errors of views and overlays."""
    try:
        yield
    except Error as error:
        if not label or not re.search(r"(^|: )(view|overlay) ", str(error)):
            raise
        raise type(error)(f"{label}: {error}", label) from None


def _check_place(out):
    """Creates the folder of `out`. Raises dspace.Io if the file cannot be written there."""
    try:
        os.makedirs(os.path.dirname(os.path.abspath(out)), exist_ok=True)
    except OSError as error:
        raise Io(f"movie {out!r}: {error.strerror}; accepted: a folder that may be written", out) from None
    AtomicFile(out, f"movie {out!r}").close()


def draw(movie, run, numbers, path, tell=lambda left: None):
    """Draws the pictures `numbers`, in rising order, into files path(name), in this process."""
    source = open_run(run)
    try:
        stage = Stage(movie, source)
        try:
            for count, number in enumerate(numbers, 1):
                atomic_write(path(FRAME % number), png(stage.picture(number)))
                tell(len(numbers) - count)
        finally:
            stage.close()
    finally:
        if source is not run:  # the caller closes a Source that it passed in
            source.close()


# --- Processes -------------------------------------------------------------------------------------

def worker(script, run, folder, numbers):
    """Starts a process that draws pictures of a movie's file into a folder; see main()."""
    output = tempfile.TemporaryFile()  # a file: the process would block on a pipe that is not read
    process = subprocess.Popen(
        [sys.executable, "-c", "from dspace.movies.make import main; main()", script, run, folder,
         str(os.getpid())],
        stdin=subprocess.PIPE, stdout=subprocess.DEVNULL, stderr=output,
        env={**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path))})
    process.output = output
    try:  # through a pipe: the list may be too long for an argument
        process.stdin.write(json.dumps(numbers).encode())
        process.stdin.close()
    except BrokenPipeError:  # it has ended; finish() reports why
        pass
    return process


def main():
    """Entry point of a worker process: python -c "..." SCRIPT RUN FOLDER PARENT. It reads the numbers of the pictures
    from the standard input as JSON."""
    from dspace.movies.movie import Movie
    script, run, folder, parent = sys.argv[1:]
    numbers = json.load(sys.stdin)

    def tell(left):
        if os.getppid() != int(parent):  # the parent has ended
            os.kill(os.getpid(), signal.SIGTERM)

    try:
        draw(Movie.load(script), run, numbers, lambda name: os.path.join(folder, name),
             tell)
    except (Error, OSError) as error:
        sys.exit(f"{error}")


def finish(process):
    """Waits for a worker. Raises dspace.Io with its last line of output if it failed."""
    process.wait()
    process.output.seek(0)
    message = process.output.read().decode(errors="replace").strip()
    process.output.close()
    if process.returncode != 0:
        words = message.splitlines()[-1] if message else "no message"
        raise Io(f"a process that drew pictures ended with {process.returncode}: {words}")


def _share(run, missing, jobs, folder, tell):
    """Shares the pictures among processes. Each draws consecutive pictures, because a run only moves forward."""
    edges = [len(missing) * k // jobs for k in range(jobs + 1)]
    processes = []
    try:
        for a, b in zip(edges, edges[1:]):
            processes.append(worker(folder.path(SCRIPT), run, folder.folder, missing[a:b]))
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
