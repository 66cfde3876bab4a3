"""`dspace movie`: a movie of a recorded run, from a text file of camera key frames."""
import argparse
import os
import sys

from dspace._core.traits import SAMPLES
from dspace.command_line import confinement, terrain as values
from dspace.movies.progress import left_words


def add_arguments(parser):
    parser.add_argument("file", metavar="FILE.toml", help="the movie: see Documentation/Movies.md")
    parser.add_argument("--run", metavar="RUN", dest="source", required=True,
                        help="a recording, or FILE.py:NAME, a function that returns the source of the pictures")
    parser.add_argument("--out", required=True, metavar="X", help="X.mp4 (H.264), X.webm (VP9), or a folder of PNGs: "
                                                           "X without a dot, or with a slash at its end")
    parser.add_argument("--size", type=values.size, metavar="WxH", help="pixels (default: the file's)")
    parser.add_argument("--rate", type=float, help="pictures a second (default: the file's)")
    parser.add_argument("--samples", type=int, metavar="N",
                        help=f"N x N samples a pixel, {SAMPLES[0]} to {SAMPLES[1]} (default: the file's)")
    parser.add_argument("--jobs", type=jobs, default=1, metavar="N", help="number of processes that draw, 1 to 64 (1)")
    parser.add_argument("--scheduler", metavar="ADDRESS",
                        help="a Dask scheduler whose workers draw: tcp://HOST:PORT or tls://...")
    parser.add_argument("--work", metavar="DIR", help="folder for the pictures (default: X.work)")
    parser.add_argument("--keep", action="store_true", help="keep the work folder after the movie is complete")
    parser.add_argument("--redraw", action="store_true",
                        help="draw all pictures, also those that an interrupted command left")
    parser.add_argument("--allow-network", action="store_true",
                        help="allow connections, for a recording whose rasters are on servers")
    confinement.add_argument(parser, "the recording")
    parser.set_defaults(run=run)


def jobs(text):
    if not text.isdigit() or not 1 <= int(text) <= 64:
        raise argparse.ArgumentTypeError(f"'{text}'; accepted: 1 to 64")
    return int(text)


def rules_of(options):
    """What drawing and encoding may do: read the movie's file, the recording and the files that it names, write where the
    movie and its pictures are made."""
    rules = confinement.Rules(connect=options.allow_network)
    rules.add("read", options.file)
    rules.add_played(options.source)
    for place in filter(None, (options.out, options.work)):
        folder = place if os.path.isdir(place) else os.path.dirname(os.path.abspath(place))
        try:
            os.makedirs(folder, exist_ok=True)
        except OSError:
            continue  # making the movie says so
        rules.add("write", folder)
    return rules


def run(options):
    from dspace.batches.runs import file_of
    _, function = file_of(options.source)
    if not function and not options.scheduler:  # a function is the user's own code, and a scheduler draws elsewhere
        confinement.confine(options, lambda: rules_of(options))
    from dspace.movies.movie import Movie
    given = {name: getattr(options, name) for name in ("size", "rate", "samples") if getattr(options, name) is not None}
    movie = Movie.load(options.file, **given)
    bar = Bar(sys.stderr)
    try:
        with confinement.explaining(options):
            drawn = movie.make(options.source, options.out, jobs=options.jobs, scheduler=options.scheduler,
                               work=options.work, keep=options.keep, progress=bar.show, encoding=bar.encoding,
                               redraw=options.redraw)
    except KeyboardInterrupt:
        bar.end()
        print("dspace: interrupted; run the same command again to continue", file=sys.stderr)
        return 130
    bar.end()
    before = movie.frames - drawn
    print(f"{options.out}: {movie.frames} pictures of {movie.size[0]} x {movie.size[1]}, "
          f"{movie.frames / movie.rate:g} s" + (f"; {before} were there" if before else ""))


class Bar:
    """Shows progress and the time left: as a bar on a terminal, otherwise as one line for each tenth."""

    def __init__(self, stream):
        self.stream, self.terminal, self.tenth = stream, stream.isatty(), None

    def show(self, done, total, seconds, drawn):
        self._put(f"{done} of {total}, {left_words(done, total, seconds, drawn)}", done, total, "drawing")

    def encoding(self, done, total, seconds):
        left = "all written" if done >= total else left_words(done, total, seconds, done)
        self._put(f"encoding: {done} of {total}, {left}", done, total, "encoding")

    def _put(self, words, done, total, what):
        if self.terminal:
            width = max(10, min(40, os.get_terminal_size(self.stream.fileno()).columns - len(words) - 6))
            full = width * done // total
            print(f"\r  [{'=' * full}{' ' * (width - full)}] {words}\x1b[K", end="", file=self.stream, flush=True)
        elif (what, 10 * done // total) != self.tenth:
            self.tenth = what, 10 * done // total
            print(f"dspace: {words}", file=self.stream, flush=True)

    def end(self):
        if self.terminal:
            print("\r\x1b[K", end="", file=self.stream, flush=True)
