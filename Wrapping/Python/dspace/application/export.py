"""Movies that are made in the background, while the windows live."""
import os

from dspace._core.fields import integer, path as path_of, reject
from dspace.application.key_frames import KeyFrames
from dspace.errors import WrongType
from dspace.movies.apart import Making
from dspace.movies.encode import codec_of
from dspace.movies.movie import Movie

LOOK = 0.1  # [s] between looks at its progress


class Export:
    """A movie that is being made in a process of its own; App.export_movie() returns it.

    state: "working", "done", "cancelled" or "failed". failure: why. done: from 0 to 1. text: what it does and the time
    left."""

    def __init__(self, app, movie, run, out, jobs, then=None):
        self._app, self._then = app, then
        self.out, self.state, self.failure = out, "working", ""
        self._making = Making(movie, run, out, jobs)
        self._task = app._add_task(self.cancel)
        self._timer = app._host.every(round(1000 * LOOK), self._look)
        self._tell()

    @property
    def done(self):
        return self._making.done

    @property
    def text(self):
        return self._making.text

    def cancel(self):
        """Ends it. Pictures that are there stay in OUT.work, and the same export goes on from there."""
        if self.state == "working":
            self._making.cancel()
            self._tell()

    def _tell(self):
        name = os.path.basename(self.out.rstrip(os.sep))
        self._app._host.task(self._task, f"{name}: {self.text}", self.done,
                             "" if self._making.cancelled else "Cancel")

    def _look(self):
        if self._making.poll():
            self._tell()
            return
        self._end()

    def _end(self):
        if self.state != "working":
            return
        making = self._making
        self.failure = making.failure
        self.state = "failed" if making.failure else "cancelled" if making.cancelled else "done"
        self._app._host.cancel(self._timer)
        self._app._host.task(self._task, "", -1.0, "")
        self._app._tasks.pop(self._task, None)
        words = {"failed": f"{self.out} failed: {making.failure}", "done": f"Saved {self.out}: {making.frames} pictures",
                 "cancelled": f"{self.out} is cancelled; the same export goes on from the pictures that are there"}
        self._app._host.message(words[self.state])
        if self.state == "failed":
            raise RuntimeError(making.failure)  # into the Python dock, once

    def close(self):
        """Cancels it and waits, at the end of the program."""
        if self.state == "working":
            self._making.cancel()
            self._making.wait(10)
            self.state = "cancelled"

    def __repr__(self):
        return f"<dspace export of {self.out!r}, {self.state}, {100 * self.done:.0f} %>"


def begin(app, out, movie=None, size=None, rate=None, samples=None, jobs=1):
    """See App.export_movie()."""
    about = "export"
    out = os.path.abspath(path_of(out, "the file", about)) + (os.sep if os.fspath(out).endswith(os.sep) else "")
    jobs = integer(jobs, "jobs", about, "an integer from 1 to 64")
    if not 1 <= jobs <= 64:
        reject(about, "jobs", jobs, "an integer from 1 to 64")
    frames = app.movie if movie is None else movie
    if not isinstance(frames, KeyFrames):
        reject(about, "the movie", movie, "the movie of a Run", WrongType)
    if any(each.state == "working" and each.out == out for each in app.exports):
        reject(about, "the file", out, "one that no other export writes")
    made = Movie.of_text(frames.movie.text)
    given = {name: value for name, value in (("size", size), ("rate", rate), ("samples", samples)) if value is not None}
    checked = Movie(**{**made.settings(), **given})
    made.size, made.rate, made.samples = checked.size, checked.rate, checked.samples
    made.check()
    codec_of(out, made.size)  # errors before a process
    return Export(app, made, frames._run.file.path, out, jobs)
