"""Makes a movie: finds the missing pictures, shares their drawing, and encodes the file.

Every picture is a PNG in a work folder. It gets its final name when it is complete, so an interrupted movie
continues without drawing a picture twice. A hash in the folder identifies the movie and the run. All ways of
sharing the work give the same pictures.
"""
import contextlib
import os
import re
import time as clock

from dspace._core.fields import integer, path as path_of, reject
from dspace._core.files import AtomicFile, atomic_write
from dspace._core.png import png
from dspace.batches.folder import Folder
from dspace.batches.processes import share
from dspace.batches.runs import absolute
from dspace.errors import Error, Io
from dspace.movies.draw import Stage, open_run, require_run
from dspace.movies.encode import codec_of, encode, programs
from dspace.movies.folder import FRAME, KIND, batch_of  # noqa: F401  (KIND: see dspace.batches.kinds)


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
        from dspace.batches import dask_workers
        dask_workers.require_address(scheduler, "movie")
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
    batch = batch_of(movie)
    with contextlib.ExitStack() as stack:
        folder = stack.enter_context(Folder(work, batch, run, redraw))
        shown = folder
        if codec is None and os.path.realpath(work) != os.path.realpath(out):
            shown = stack.enter_context(Folder(out, batch, run, redraw))
        missing = folder.missing(total)
        began = clock.monotonic()

        def tell(left):
            if progress:
                progress(total - left, total, clock.monotonic() - began, len(missing) - left)

        tell(len(missing))
        with _in_file(movie.label):
            if missing and scheduler:
                dask_workers.share(scheduler, run, missing, folder, tell)
            elif missing and jobs > 1:
                share(run, missing, min(jobs, len(missing)), folder, tell)
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


def draw_pieces(words, run, numbers, folder, tell):
    """Draws pictures of a movie's text into a folder; see dspace.batches.kinds.Kind."""
    from dspace.movies.movie import Movie
    draw(Movie.of_text(words), run, numbers, lambda name: os.path.join(folder, name), tell)
