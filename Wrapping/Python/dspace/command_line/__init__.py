"""The `dspace` command. Each subcommand has a module, which defines its arguments and executes it.

Exit code: 0 on success. 2 when the command line itself is wrong: unknown, missing or contradicting options, and values
that have not the form that the help states. 1 when it was understood and something failed or was rejected (a name, a time,
a file, a value out of range), with one line on the error stream that names it; also for the answers "they differ" (log
diff) and "not all" (camera check, log pack, log salvage). 130 when it was interrupted.
"""
import argparse
import contextlib
import importlib
import importlib.util
import os
import re
import signal
import sys
import threading
import warnings

from dspace.errors import Error

WORDS = {"camera": "project, check and convert camera models, and draw through them",
         "contacts": "find when bodies, spacecraft and stations stand above the horizon of a site",
         "ephemeris": "print states of bodies and spacecraft",
         "horizon": "measure the horizon around a site on terrain",
         "illumination": "map the time that ground is lit by the Sun",
         "kernels": "describe SPICE kernels",
         "lit": "measure the sunlit area and the power of a panel on terrain",
         "log": "show, compare, cut, pack and salvage recordings",
         "los": "test lines of sight over terrain",
         "movie": "make a movie of a run from a text file of camera key frames",
         "play": "draw pictures of a recording, without a simulation",
         "power": "profile the power of solar panels at a site over a span of time",
         "scan": "measure ranges with a lidar or an altimeter on terrain or in a recording",
         "serve": "serve a session to simulations and viewers in other processes",
         "sites": "rank the best-lit sites around a point, for masts of given heights",
         "sky": "draw the sky over a site, and print the direction of a body",
         "terrain": "describe and draw rasters of heights",
         "viewshed": "map the ground that is seen from sites on terrain",
         "watch": "draw pictures of a running simulation through its server"}


class Failed(Exception):
    """A failure that the command reports in one line."""


def later(module, function="run"):
    """The function of a module that is imported when the command runs, so that help does not wait for it."""
    def run(options):
        return getattr(importlib.import_module(f"{__name__}.{module}"), function)(options)
    return run


def set_limits(given):
    """Sets dspace.limits from options such as "image_pixels=400000000"."""
    import dspace
    for text in given:
        name, _, value = text.partition("=")
        if not re.fullmatch(r"[0-9]{1,18}", value):
            raise Failed(f"--limit {text!r}; accepted: NAME=VALUE with a whole number, such as image_pixels=400000000")
        dspace.limits.set(**{name: int(value)})


def lazy(name):
    """A module that is loaded when something of it is used."""
    if name in sys.modules:
        return sys.modules[name]
    found = importlib.util.find_spec(name)
    found.loader = importlib.util.LazyLoader(found.loader)
    module = sys.modules[name] = importlib.util.module_from_spec(found)
    found.loader.exec_module(module)
    return module


class Parser(argparse.ArgumentParser):
    """An ArgumentParser that prints errors in one line and accepts values such as "-60,10"."""

    def __init__(self, *arguments, **named):
        super().__init__(*arguments, **named)
        self._negative_number_matcher = re.compile(r"^-[0-9.][0-9.,eE+-]*$")

    def error(self, message):
        self.exit(2, f"{self.prog}: {' '.join(message.split())}; see {self.prog} --help\n")


def main(arguments=None):
    """Executes a command line and returns the exit code. Without arguments, that of this process."""
    is_process = arguments is None
    arguments = sys.argv[1:] if arguments is None else list(arguments)
    parser = Parser(prog="dspace", description="Measures and draws what simulations do.")
    commands = parser.add_subparsers(dest="command", metavar="COMMAND", required=True)
    asked = next((a for a in arguments if not a.startswith("-")), None)
    for word, purpose in WORDS.items():
        command = commands.add_parser(word, help=purpose, description=purpose)
        if word == asked:  # the modules of other commands are not imported
            importlib.import_module(f"{__name__}.{word}").add_arguments(command)
    options = parser.parse_args(arguments)
    options.is_process = is_process
    options.words = arguments
    warnings.showwarning = lambda message, *_: print(f"dspace: note: {message}", file=sys.stderr)
    try:
        done = options.run(options) or 0
        sys.stdout.flush()
        return done
    except BrokenPipeError:  # the reader, such as `| head`, has ended
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 1
    except (Failed, Error, OSError, RuntimeError) as error:  # RuntimeError: GDAL's
        return tell(error)


@contextlib.contextmanager
def tidy_end():
    """In a `with` statement: SIGTERM ends the command as an error does, so that temporary files go. Exit code 143."""
    def end(*_):
        raise SystemExit(128 + signal.SIGTERM)
    if threading.current_thread() is not threading.main_thread():  # Python sets handlers there only
        yield
        return
    before = signal.signal(signal.SIGTERM, end)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)


def tell(error):
    """Prints an error in one line on the error stream. Returns the exit code of a failure."""
    print("dspace: " + " ".join(str(error).split()), file=sys.stderr)
    return 1

