"""Makes a movie in a process of its own, so that the process that asks for it never waits."""
import json
import os
import signal
import subprocess
import sys
import threading

from dspace.errors import Io
from dspace.movies.progress import left_words

GRACE = 10  # [s] for workers and ffmpeg to end


class Making:
    """A process that makes a movie; it begins at once.

    movie: a dspace.Movie. run: a recording's path, or "FILE.py:NAME". out, jobs, keep, redraw: as of
    dspace.movies.make.make, whose rules hold: earlier files stay whole until the new one is complete, and pictures
    that an interrupted process left are used again. Look at it with poll(). Where this process ends, it ends too."""

    def __init__(self, movie, run, out, jobs=1, keep=False, redraw=False):
        self.out, self.frames = os.fspath(out), movie.check()
        self.done, self.text, self.failure, self.cancelled, self.drawn = 0.0, "starting", "", False, None
        self._data = b""
        # Its own process session: Ctrl-C at the terminal reaches only this process, which then ends the other.
        self._process = subprocess.Popen(
            [sys.executable, "-c", "from dspace.movies.apart import main; main()"], stdin=subprocess.PIPE,
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, start_new_session=True,
            env={**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path))})
        for pipe in (self._process.stdout, self._process.stderr):
            os.set_blocking(pipe.fileno(), False)
        self._errors = b""
        asked = {"movie": movie.text, "label": movie.label, "run": os.fspath(run), "out": self.out, "jobs": jobs,
                 "keep": keep, "redraw": redraw}
        # A pipe takes 64 KiB, and a movie may have more keys: poll() writes what is left. No thread does: Python's collector of
        # garbage could run in it and destroy a window's session there.
        os.set_blocking(self._process.stdin.fileno(), False)
        self._words = json.dumps(asked).encode() + b"\n"
        self._ask()

    def _ask(self):
        try:
            while self._words:
                self._words = self._words[os.write(self._process.stdin.fileno(), self._words):]
        except BlockingIOError:
            pass
        except (BrokenPipeError, ValueError):  # it has ended; poll() says why
            self._words = b""

    @property
    def pid(self):
        """Of the process."""
        return self._process.pid

    def poll(self):
        """Takes what it has told so far: `done` (0 to 1), `text` (with the time left). Returns True while it works. At the
        end `failure` says what went wrong ("": nothing), `cancelled` whether cancel() ended it, and `drawn` how many
        pictures were drawn."""
        if self._process is None:
            return False
        self._ask()
        ended = self._process.poll() is not None  # before what it wrote is read, so that nothing is missed
        self._data += self._process.stdout.read() or b""
        self._errors += self._process.stderr.read() or b""
        *lines, self._data = self._data.split(b"\n")
        for line in lines:
            self._take(json.loads(line))
        if not ended:
            return True
        code = self._process.returncode
        if code != 0 and not self.cancelled:
            words = self._errors.decode(errors="replace").strip().splitlines()
            self.failure = self.failure or (words[-1] if words else f"the process that makes it ended with {code}")
        self._close()
        return False

    def _take(self, told):
        if "error" in told:
            self.failure = told["error"]
        elif "drawn_in_all" in told:
            self.drawn, self.done, self.text = told["drawn_in_all"], 1.0, "complete"
        else:
            done, total, seconds, drawn = told["at"]
            words = left_words(done, total, seconds, drawn)
            encoding = told["doing"] == "encoding"
            # Encoding takes some tenth of the time of drawing.
            self.done = (0.9 + 0.1 * done / total) if encoding else 0.9 * done / total
            self.text = f"{'encoding' if encoding else 'picture'} {done} of {total}, " + (
                "all written" if encoding and done >= total else words)

    def cancel(self):
        """Asks it to end, and returns at once. Its pictures stay, and the same movie goes on from there."""
        if self._process is not None and not self.cancelled:
            self.cancelled = True
            self.text = "cancelling"
            if self._process.poll() is None:
                self._process.send_signal(signal.SIGINT)

    def end(self):
        """Cancels it and waits until it has ended, at most 10 s; then it is killed."""
        self.cancel()
        self.wait(GRACE)

    def wait(self, timeout=None):
        """Waits until it ends. Raises dspace.Io with its failure."""
        while self._process is not None and self.poll():
            try:
                self._process.wait(0.05 if timeout is None else timeout)
            except subprocess.TimeoutExpired:
                if timeout is not None:
                    self._process.kill()
                    self._process.wait()
        if self.failure:
            raise Io(self.failure, self.out)

    def _close(self):
        for pipe in (self._process.stdin, self._process.stdout, self._process.stderr):
            try:
                pipe.close()
            except BrokenPipeError:
                pass
        self._process = None


def main():
    """Entry point of the process: reads a line of JSON, makes the movie, and tells JSON, a line each."""
    from dspace.errors import Error
    from dspace.movies.movie import Movie
    signal.signal(signal.SIGINT, signal.default_int_handler)  # also where the parent ignores it
    out = os.fdopen(os.dup(1), "w", buffering=1)
    os.dup2(2, 1)  # what libraries print

    def tell(**words):
        print(json.dumps(words), file=out, flush=True)

    def watch():  # the end of the input: the other process has ended
        while sys.stdin.buffer.readline():
            pass
        os.kill(os.getpid(), signal.SIGINT)

    try:
        asked = json.loads(sys.stdin.buffer.readline())
        threading.Thread(target=watch, daemon=True).start()
        movie = Movie.of_text(asked["movie"])
        movie.label = asked["label"]
        drawn = movie.make(asked["run"], asked["out"], jobs=asked["jobs"], keep=asked["keep"], redraw=asked["redraw"],
                           progress=lambda *at: tell(doing="drawing", at=at),
                           encoding=lambda done, total, seconds: tell(doing="encoding", at=(done, total, seconds, done)))
        tell(drawn_in_all=drawn)
    except KeyboardInterrupt:
        os._exit(130)
    except (Error, OSError) as error:
        tell(error=f"{error}")
        os._exit(1)
    out.flush()
    os._exit(0)  # the thread that reads the input does not hold it
